"""Overlaps that come in step by step: contact.<pair>.interference as an expression in t, initial_gap: ramp."""
import json

import pytest

from boxmesh import linspace, write
from test_input import refused

FIGURES = ("force", "moment", "max_pressure", "area", "min_gap")


def blocks(tmp_path, dim=2, overlap=0.0, tilt=0.0, cells=3):
    """A block [0, 1] under one as wide that reaches into it, linearly more by `tilt` over the width."""
    def lower(x, y, *z):
        return (x, y, *z)

    def upper(x, y, *z):
        return (0.1 + 0.8 * x, 1 + y - (1 - y) * (overlap + tilt * x), *(0.1 + 0.8 * c for c in z))

    name = ("lower", "upper")
    mesh = write(tmp_path / "blocks.msh", [linspace(0, 1, cells)] * dim, [lower, upper], side=lambda side, centre, block: f"{name[block]}_{side}",
                 body=lambda centre, block: name[block])
    return {"mesh": {"file": str(mesh)}, "model": "plane_strain" if dim == 2 else "3d", "order": 2 if dim == 2 else 1,
            "body": {"lower": {"material": "m"}, "upper": {"material": "m"}}, "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}},
            "boundary": {"lower_y0": {"fix": "xyz"[:dim]}, "upper_y1": {"fix": "xyz"[:dim]}},
            "contact": {"c": {"nonmortar": "upper_y0", "mortar": "lower_y1", "roles": "given"}}, "load": {"step": 1}}


def solve(run, scene, *options, **keywords):
    result = run("scene.yml", *options, text=json.dumps(scene), **keywords)
    assert result.returncode == 0, result
    return result


def same(a, b):
    a, b = (result.summary["contact"]["c"] for result in (a, b))
    assert a["max_pressure"] > 1e-3
    for key in FIGURES:
        assert a[key] == pytest.approx(b[key], rel=1e-8, abs=1e-10), key


@pytest.mark.parametrize("dim, ranks", [(2, 1), (2, 2), (3, 1)])
def test_interference_in_steps(run, tmp_path, dim, ranks):
    """At each load as if the overlap had been there from the start: half of it at t = 0.5, gone again at t = 2."""
    scene = blocks(tmp_path, dim, overlap=0.001)
    scene["contact"]["c"]["interference"] = "0.05*t*(2-t)"
    scene["load"] = {"end": 2, "step": 0.25}
    rows = {round(row["t"], 9): row for row in solve(run, scene, ranks=ranks).history}
    for t in (0.5, 1):
        scene["contact"]["c"]["interference"] = 0.05 * t * (2 - t)
        scene["load"] = {"step": 1}
        once = solve(run, scene).history[-1]
        for column in ("contact.c.force.y", "contact.c.max_pressure", "energy"):
            assert once[column] == pytest.approx(rows[t][column], rel=1e-8), (t, column)
    assert rows[1]["contact.c.force.y"] > 10 * rows[2]["contact.c.force.y"]


@pytest.mark.parametrize("tilt, steps", [(0, 1), (0, 5), (0.06, 4)])
def test_ramped_overlap(run, tmp_path, tilt, steps):
    """Bodies that the mesh draws into each other end where they do at once, by steps of any size; what they bear grows from 0."""
    scene = blocks(tmp_path, overlap=0.04, tilt=tilt)
    at_once = solve(run, scene)
    scene["contact"]["c"]["initial_gap"] = "ramp"
    scene["load"]["step"] = 1 / steps
    ramped = solve(run, scene)
    same(ramped, at_once)
    force = [row["contact.c.force.y"] for row in ramped.history]
    assert len(force) == steps and all(0 < a < b for a, b in zip(force, force[1:]))
    assert tilt or force[0] == pytest.approx(force[-1] / steps, rel=0.02)


@pytest.mark.parametrize("kinematics, tilt, ranks", [("small", 0.06, 1), ("finite", 0.06, 1), ("finite", 0.15, 1), ("finite", 0.15, 2), ("finite", 0.15, 3)])
def test_on_the_way(run, tmp_path, kinematics, tilt, ranks):
    """At half of the ramp forces and estimate are those of bodies drawn with half of the deepest overlap less."""
    law = {"law": "neo_hookean" if kinematics == "finite" else "linear", "E": 1, "nu": 0.3}
    scene = blocks(tmp_path, overlap=0.02, tilt=tilt, cells=12) | {"kinematics": kinematics, "material": {"m": law}, "adapt": {"tolerance": 0.9}}
    scene["contact"]["c"]["initial_gap"] = "ramp"
    scene["load"]["step"] = 0.5
    half = solve(run, scene, ranks=ranks).history[0]
    drawn = blocks(tmp_path, overlap=0.02 - 0.5 * (0.02 + tilt), tilt=tilt, cells=12) | {"kinematics": kinematics, "material": {"m": law}, "adapt": {"tolerance": 0.9}}
    less = solve(run, drawn).history[-1]
    assert half["contact.c.force.y"] == pytest.approx(less["contact.c.force.y"], rel=0.12)
    assert half["estimated_error"] == pytest.approx(less["estimated_error"], rel=0.1)


def test_ramp_leaves_gaps(run, tmp_path):
    """What is apart at the start is none of it: blocks 0.02 apart, pushed by 0.05, do as with initial_gap: keep."""
    scene = blocks(tmp_path, overlap=-0.02)
    scene["boundary"]["upper_y1"] = {"fix": "x", "displacement": {"y": "-0.05*t"}}
    scene["load"]["step"] = 0.5
    kept = solve(run, scene)
    scene["contact"]["c"]["initial_gap"] = "ramp"
    same(solve(run, scene), kept)


def test_half_way_on_other_ranks(run, tmp_path):
    """Stopped in the middle of the ramp and gone on from the checkpoint on two processes."""
    scene = blocks(tmp_path, overlap=0.04)
    scene["contact"]["c"]["initial_gap"] = "ramp"
    scene["load"]["step"] = 0.25
    whole = solve(run, scene)
    first = run("scene.yml", "-load_max_steps", 2, text=json.dumps(scene))
    assert first.returncode == 2, first
    same(solve(run, scene, "-restart", first.directory / "checkpoint.h5", ranks=2), whole)


@pytest.mark.parametrize("tilt", [0, 0.15])
def test_adapted_on_the_way(run, tmp_path, tilt):
    """The estimate knows how much of an overlap counts: blocks that overlap alike are as accurate in the middle of the ramp as at its end; on any ranks."""
    scene = blocks(tmp_path, overlap=0.04 if tilt < 0.1 else 0.02, tilt=tilt, cells=6)
    scene |= {"adapt": {"tolerance": 0.5}, "contact": {"c": scene["contact"]["c"] | {"initial_gap": "ramp"}}}
    scene["load"]["step"] = 0.25
    errors, *others = ([row["estimated_error"] for row in solve(run, scene, ranks=ranks).history] for ranks in (1, 2, 3))
    assert tilt or max(errors) < 1.3 * errors[-1], errors
    for other in others:
        assert other == pytest.approx(errors, rel=1e-8)


@pytest.mark.parametrize("edit, words", [
    (lambda s: s["contact"]["c"].update(interference="0.01*X"), ["contact.c.interference is .0.01.X.", "in t alone"]),
    (lambda s: s["contact"]["c"].update(interference="0.01*q"), ["contact.c.interference", "0.01.q"]),
    (lambda s: s["contact"]["c"].update(initial_gap="ramped"), ["contact.c.initial_gap is 'ramped'", "ramp"]),
    (lambda s: s.update(load={"control": "arc_length"}) or s["contact"]["c"].update(initial_gap="ramp"), ["contact.c.initial_gap is ramp", "arc_length"]),
    (lambda s: s.update(load={"control": "arc_length"}) or s["contact"]["c"].update(interference="0.01*t"), ["contact.c.interference", "arc_length", "a number"]),
])
def test_refused(run, tmp_path, edit, words):
    scene = blocks(tmp_path)
    edit(scene)
    refused(run("scene.yml", text=json.dumps(scene)), *words)
