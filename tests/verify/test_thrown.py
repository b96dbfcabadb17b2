"""Solutions for which a body that nothing holds moved farther than its own size and all that is held are none (src/diagnose/thrown.c)."""
import json
import pathlib

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUIET = ("-output_fields", "false")
RING = ("tests/gauntlet/oring_roll.yml", "-order", 1, "-load_step", 1, "-mesh_parameter_s", 0.12, "-contact_c_friction", 0.3, "-contact_d_friction", 0.3, *QUIET)
THROWN = (*RING, "-newton_frozen_normals", "off", "-path_descent", "off")  # as it is nothing is thrown


def test_out_of_the_gap(run):
    """An O-ring between shaft and bore, all of the interference at once. Not asked, it is thrown out of the gap, and all is well without a force. Asked, the steps are those in
    which it stays."""
    told, without, stays = (run(*words) for words in (THROWN, (*THROWN, "-path_thrown", "off"), (*RING, "-load_step", 0.5)))
    force = [result.summary["contact"]["c"]["force"][0] for result in (told, without, stays)]
    assert stays.returncode == 0 and stays.summary["thrown_off"] == 0 and force[2] > 0.3, stays
    assert told.returncode == 0 and told.summary["thrown_off"] >= 1 and force[0] == pytest.approx(force[2], rel=0.006), told
    assert without.returncode == 0 and without.summary["thrown_off"] == 0 and force[1] == 0, without


def test_ranks(run):
    one, *more = (run(*THROWN, ranks=ranks).summary for ranks in (1, 2, 3))
    for other in more: assert other["thrown_off"] >= 1 and other["energy"] == pytest.approx(one["energy"], rel=1e-8)


def test_pulled_away(run):
    """A block that a dead load takes away from another one has no equilibrium; so far off that forces are less than the round-off of displacements one would be found."""
    content = yaml.safe_load((ROOT / "inputs/patch2d.yml").read_text())
    content["mesh"]["file"] = str(ROOT / "inputs/patch2d.geo")
    content["boundary"]["top"] = {"traction": {"y": 0.01}}
    told, without = (run("s.yml", *QUIET, "-path_thrown", mode, text=json.dumps(content)) for mode in ("auto", "off"))
    assert told.returncode == 2 and told.summary["thrown_off"] >= 1, told
    assert without.returncode == 0, without
