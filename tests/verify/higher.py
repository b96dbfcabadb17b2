"""The tests of other files with cells of order 2 and 4 and with both kinds of contact face (contact.<pair>.order): `higher` is the fixture `run` with these options added to every run.

    @faces("2-full")
    def test_o96_zero_load(higher):
        robust.test_o96_zero_load(higher, "upper_bottom", "lower_top")
"""
import re

import pytest

from conftest import ROOT

KINDS = {f"{order}-{face}": (order, face) for order in (2, 4) for face in (1, "full")}


def faces(*quick, kinds=KINDS):
    """Kinds of face by name, order of the cells - order of the faces; those not named as quick are slow."""
    assert set(quick) <= set(kinds)
    return pytest.mark.parametrize("kind", [pytest.param(kind, marks=() if kind in quick else pytest.mark.slow) for kind in kinds])


@pytest.fixture
def higher(run, kind):
    order, face = (int(part) if part.isdigit() else part for part in kind.split("-"))

    def start(scene, *options, text=None, **keys):
        names = re.findall(r"(\w+):\s*\{?\s*nonmortar:", text or (ROOT / scene).read_text())
        assert names
        more = [part for name in names for part in (f"-contact_{name}_order", face)]
        return run(scene, *options, "-order", order, *more, text=text, **keys)

    return start
