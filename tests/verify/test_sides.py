"""Sides of a contact pair that are lists of groups: bottom and flank of a block, named apart, in the corner of floor and wall."""
import json

import pytest

from boxmesh import linspace, write
from test_hostile import MATERIAL
from test_orderly import refused


def corner(path, **keys):
    """sole and flank of the block, floor and wall of the corner, each by itself and (both, seat) together."""
    names = {(3, "y0"): ["sole", "both"], (3, "x1"): ["flank", "both"], (0, "y1"): ["floor", "seat"], (2, "x0"): ["wall", "seat"], (3, "y1"): "top", (0, "y0"): "base",
             (1, "y0"): "base"}
    write(path / "corner.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (2 * x, y - 1), lambda x, y: (2 + x, y - 1), lambda x, y: (2 + x, y), lambda x, y: (0.4 + 1.599 * x, 0.001 + y)],
          side=lambda name, centre, b: names.get((b, name)), body=lambda centre, b: "block" if b == 3 else "corner")
    return json.dumps({"mesh": {"file": "corner.msh"}, "model": "plane_strain", "body": {"block": {"material": "m"}, "corner": {"material": "m"}}, "material": {"m": MATERIAL},
                       "boundary": {"base": {"fix": "xy"}, "top": {"displacement": {"x": 0.05, "y": -0.05}}}, "load": {"step": 0.5}} | keys)


def pair(nonmortar, mortar):
    return {"contact": {"seat": {"nonmortar": nonmortar, "mortar": mortar, "roles": "given"}}}


APART = pair(["sole", "flank"], ["floor", "wall"])


@pytest.mark.parametrize("options,ranks", [((), 1), (("-mesh_refine", 1), 2), (("-order", 2, "-adapt_tolerance", 0.1, "-adapt_max_passes", 2), 1)])
def test_as_one_group(run, tmp_path, options, ranks):
    apart, one = (run("s.yml", *options, ranks=ranks, text=corner(tmp_path, **sides)) for sides in (APART, pair("both", "seat")))
    assert apart.returncode == one.returncode and "sole + flank" in apart.stdout + run("s.yml", "-check", text=corner(tmp_path, **APART)).stdout, (apart, one)
    assert min(abs(f) for f in one.summary["contact"]["seat"]["force"]) > 0.01  # floor and wall both bear
    for key in "energy", "cells", "newton_iterations":
        assert apart.summary[key] == pytest.approx(one.summary[key], rel=1e-12), key
    assert apart.summary["contact"]["seat"]["force"] == pytest.approx(one.summary["contact"]["seat"]["force"], rel=1e-10)
    if not options:  # one group of each side alone lets the block go into the other
        alone = run("s.yml", text=corner(tmp_path, **pair("sole", "floor")))
        assert abs(alone.summary["contact"]["seat"]["force"][0]) < 1e-3, alone


def test_on_the_command_line(run, tmp_path):
    options = ("-contact_seat_nonmortar", "[sole, flank]", "-contact_seat_mortar", "[floor,wall]")
    listed, given = run("s.yml", *options, text=corner(tmp_path, **pair("both", "seat"))), run("s.yml", text=corner(tmp_path, **APART))
    assert listed.summary["contact"]["seat"]["force"] == given.summary["contact"]["seat"]["force"]
    assert "sole + flank" in listed.stdout + run("s.yml", "-check", *options, text=corner(tmp_path, **pair("both", "seat"))).stdout


def test_one_surface(run, tmp_path):
    """What may meet itself, of two bodies."""
    apart, one = (run("s.yml", text=corner(tmp_path, contact={"all": {"surface": surface}})) for surface in (["both", "floor", "wall"], ["sole", "flank", "seat"]))
    assert apart.returncode == 0 and apart.summary["contact"]["all"]["force"] == one.summary["contact"]["all"]["force"] and apart.summary["contact"]["all"]["active_nodes"], apart


@pytest.mark.parametrize("sides,words", [
    (pair(["sole", "flnk"], "seat"), ["contact.seat.nonmortar", "no boundary group 'flnk'", "it has: "]),
    (pair("sole + flank", "seat"), ["no boundary group 'sole + flank'"]),
    (pair(["sole", "block"], "seat"), ["'block' is a body"]),
    (pair([], "seat"), ["contact.seat.nonmortar", "a list without a name"]),
    (pair(["sole", "sole"], "seat"), ["'sole' is there twice"]),
    (pair(["sole", ["flank"]], "seat"), ["contact.seat.nonmortar", "one of them is a list"]),
    (pair(["sole", ""], "seat"), ["names stand in the list"]),
    (pair({"a": "sole"}, "seat"), ["must be a name or a list of names [a, b], it is a map of keys"]),
    (pair(["sole", "floor"], ["floor", "wall"]), ["'sole + floor' and 'floor + wall' share cell"]),
    (pair(["sole", "x" * 2000], "seat"), ["is longer than"]),
    ({"boundary": {"base": {"fix": "xy"}, "top": {"displacement": {"y": -0.05}}, "sole + flank": {"fix": "x"}}} | APART, ["no boundary group 'sole + flank'"]),
])
def test_one_sentence(run, tmp_path, sides, words):
    refused(run("s.yml", "-check", text=corner(tmp_path, **sides)), *words)


def test_restart(run, tmp_path):
    """Other groups are another pair, another order of them is not."""
    first = run("s.yml", "-load_max_steps", 1, text=corner(tmp_path, **APART))
    assert first.returncode == 2, first
    for sides, good in (pair(["flank", "sole"], ["wall", "floor"]), True), (pair(["sole", "flank"], "floor"), False):
        result = run("s.yml", "-restart", first.directory / "checkpoint.h5", text=corner(tmp_path, **sides))
        if good:
            assert result.returncode == 0, result
        else:
            refused(result, "'contact.seat: mortar floor + wall', the scene has 'contact.seat: mortar floor'")
