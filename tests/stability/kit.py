"""What the rows of docs/stability.md lean on. A row is a test with a decorator that says how a method fails, and a call that hands over the figures:

    @way("Newton's method overshoots", "Newton iterations", "as it is", "-newton_line_search off", kind="iterations")
    def test_row(run, told):
        ours, naive = ...
        told(ours, naive)
        assert ours < naive / 2

run.py runs all of them, writes the table and draws a picture of each row (picture.py): of the first and the last run of the test, or of those that `show` counts.
What is not passed is an expected failure with its reason."""
import importlib.util
import os
import pathlib
import re
import sys

import pytest

# A conftest.py here would hide the one of tests/verify from its cases when both are collected: its fixture is taken by path.
_spec = importlib.util.spec_from_file_location("verify_conftest", pathlib.Path(__file__).resolve().parent.parent / "verify" / "conftest.py")
_verify = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_verify)
plain, ROOT = _verify.run, _verify.ROOT  # a test module imports `plain`, too: `run` leans on it
PICTURES = "MORTISE_STABILITY_PICTURES"  # where they go; not set: none are drawn
sys.path.insert(0, str(pathlib.Path(_spec.origin).parent))


def way(title, figure, ours, naive, **picture):
    """A way in which methods fail; what is compared; what is done here and what is not, in the words of keys and switches; kind, field, show: of the picture."""
    def mark(test):
        test.way = {"title": title, "figure": figure, "ours": ours, "naive": naive, "picture": picture}
        return test
    return mark


def text(value):
    return value if isinstance(value, str) else f"{value:.4g}" if isinstance(value, float) else str(value)


@pytest.fixture
def run(plain, request):
    """As for the cases of tests/verify; where pictures are drawn all runs write fields, and are kept in their order."""
    request.node.runs = []

    def start(*words, **keys):
        result = plain(*words, *(("-output_fields", "true") if PICTURES in os.environ else ()), **keys)
        request.node.runs.append(result)
        return result
    return start


def name_of(node):
    """A row's own file name."""
    return re.sub(r"\W+", "_", node.name.removeprefix("test_")).strip("_") + ".png"


@pytest.fixture
def told(request, record_property):
    """told(ours, naive): the figures of a row, numbers or words; told(ours, naive, **words) says title, figure, ours or naive anew; picture={...}: what it shows."""
    rows = []

    def tell(ours, naive, /, **words):
        known = getattr(request.function, "way", {})
        rows.append({**known, **words, "picture": {**known.get("picture", {}), **words.get("picture", {})}, "values": [text(ours), text(naive)], "drawn": name_of(request.node)})
        print({key: value for key, value in rows[-1].items() if key != "picture"})
        record_property("stability", {key: value for key, value in rows[-1].items() if key != "picture"})
    yield tell
    runs = getattr(request.node, "runs", [])
    if PICTURES in os.environ and rows:
        import picture
        what = rows[-1]["picture"]
        picture.draw(pathlib.Path(os.environ[PICTURES]) / rows[-1]["drawn"], [runs[k] for k in what.get("show", (0, -1))] if runs else [], what)


def end(result):
    """How a run ended, in words."""
    if result.returncode == 0: return "converged"
    s = result.summary
    return f"gives up at t = {s['t']:.3g} after {s['newton_iterations']} iterations"
