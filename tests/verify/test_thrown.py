"""Solutions for which a body that nothing holds moved farther than its own size and all that is held are none (src/diagnose/thrown.c)."""
import json
import pathlib

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUIET = ("-output_fields", "false")
JAWS = ("tests/gauntlet/jaws.yml", "-order", 1, "-solve_active_set_passes", 3, "-solve_single_switches", "no", *QUIET)  # as it is nothing is thrown


def test_out_of_the_jaws(run):
    """Not asked, the disc is thrown out by ten times its radius, and all is well without a force. Asked, the steps are those in which it stays."""
    told, without, stays = (run(*JAWS, *options) for options in ((), ("-path_thrown", "off"), ("-path_thrown", "off", "-solve_active_set_passes", 10, "-solve_single_switches", "yes")))
    assert stays.returncode == 0 and stays.summary["contact"]["u"]["force"][1] == pytest.approx(-1.3556, rel=0.006), stays
    assert told.returncode == 0 and told.summary["thrown_off"] >= 1, told
    assert abs(told.summary["contact"]["u"]["force"][1]) == pytest.approx(1.3556, rel=0.006)
    assert without.returncode == 0 and without.summary["thrown_off"] == 0 and without.summary["contact"]["u"]["force"][1] == 0, without


def test_ranks(run):
    one, *more = (run(*JAWS, ranks=ranks).summary for ranks in (1, 2, 3))
    for other in more: assert other["thrown_off"] == one["thrown_off"] and other["energy"] == pytest.approx(one["energy"], rel=1e-8)


def test_pulled_away(run):
    """A block that a dead load takes away from another one has no equilibrium; so far off that forces are less than the round-off of displacements one would be found."""
    content = yaml.safe_load((ROOT / "inputs/patch2d.yml").read_text())
    content["mesh"]["file"] = str(ROOT / "inputs/patch2d.geo")
    content["boundary"]["top"] = {"traction": {"y": 0.01}}
    told, without = (run("s.yml", *QUIET, "-path_thrown", mode, text=json.dumps(content)) for mode in ("auto", "off"))
    assert told.returncode == 2 and told.summary["thrown_off"] >= 1, told
    assert without.returncode == 0, without
