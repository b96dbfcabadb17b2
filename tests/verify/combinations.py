"""Which of many combinations the quick run takes."""
import itertools

import pytest


def half(names, *lists, slow=()):
    """Every second one of all combinations, like the squares of one colour of a board: all values, of two lists each with every second one
    of the other. The rest is slow, and so is what has a value of slow."""
    rows = list(itertools.product(*(list(enumerate(values)) for values in lists)))
    return pytest.mark.parametrize(names, [pytest.param(*(value for _, value in row), marks=pytest.mark.slow if sum(k for k, _ in row) % 2 or any(value in slow for _, value in row) else ())
                                           for row in rows])
