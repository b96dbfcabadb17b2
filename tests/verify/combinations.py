"""Which of many combinations the quick run takes."""
import itertools

import pytest


def half(names, *lists, slow=()):
    """Every second one of all combinations, like the squares of one colour of a board: all values, of two lists each with every second one
    of the other. The rest is slow, and so is what has a value of slow."""
    rows = list(itertools.product(*(list(enumerate(values)) for values in lists)))
    return pytest.mark.parametrize(names, [pytest.param(*(value for _, value in row), marks=pytest.mark.slow if sum(k for k, _ in row) % 2 or any(value in slow for _, value in row) else ())
                                           for row in rows])


def on_two(names, rows, also):
    """Rows on one process, those numbered in also on two; the others on two are slow: what is refused there is told by the same lines, and a start on two costs
    four on one."""
    def row(values, ranks, quick):
        return pytest.param(*(values if isinstance(values, tuple) else (values,)), ranks, marks=() if quick else pytest.mark.slow)

    return pytest.mark.parametrize(f"{names},ranks", [row(values, ranks, ranks == 1 or k in also) for ranks in (1, 2) for k, values in enumerate(rows)])
