"""What the rows of docs/stability.md lean on. A row is a test with a decorator that says how a method fails, and a call that hands over the figures:

    @way("Newton's method overshoots", "Newton iterations", "as it is", "-newton_line_search off")
    def test_row(run, told):
        ours, naive = ...
        told(ours, naive)
        assert ours < naive / 2

run.py runs all of them and writes the table. What is not passed is an expected failure with its reason."""
import importlib.util
import pathlib
import sys

import pytest

# A conftest.py here would hide the one of tests/verify from its cases when both are collected: its fixture is taken by path.
_spec = importlib.util.spec_from_file_location("verify_conftest", pathlib.Path(__file__).resolve().parent.parent / "verify" / "conftest.py")
_verify = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_verify)
run, ROOT = _verify.run, _verify.ROOT
sys.path.insert(0, str(pathlib.Path(_spec.origin).parent))


def way(title, figure, ours, naive):
    """A way in which methods fail; what is compared; what is done here and what is not, in the words of keys and switches."""
    def mark(test):
        test.way = {"title": title, "figure": figure, "ours": ours, "naive": naive}
        return test
    return mark


def text(value):
    return value if isinstance(value, str) else f"{value:.4g}" if isinstance(value, float) else str(value)


@pytest.fixture
def told(request, record_property):
    """told(ours, naive): the figures of a row, numbers or words; told(ours, naive, **words) says title, figure, ours or naive anew."""
    def tell(ours, naive, /, **words):
        row = {**getattr(request.function, "way", {}), **words, "values": [text(ours), text(naive)]}
        print(row)
        record_property("stability", row)
    return tell


def end(result):
    """How a run ended, in words."""
    if result.returncode == 0: return "converged"
    s = result.summary
    return f"gives up at t = {s['t']:.3g} after {s['newton_iterations']} iterations"
