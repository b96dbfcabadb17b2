"""Rigid bodies that forces and moments move (body.<name>.load): the same equilibria as under the motion that asks for these forces, forces and moments in balance."""
import json
import math
import re

import pytest

from boxmesh import linspace, write
from contactkit import is_quadratic, steps
from test_input import refused
from test_rigid import GAP, contact, pressed, roller, solve

AXES = "xyz"


def differences(result):
    """Tangent against differences of the residual, the largest of all iterates."""
    return max(float(value) for value in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+),", result.stdout))


def by_motion(scene, motion):
    scene = json.loads(json.dumps(scene))
    scene["body"]["tool"]["motion"] = motion
    return scene


def by_load(scene, load, motion=None):
    scene = json.loads(json.dumps(scene))
    scene["body"]["tool"] |= {"load": load} | ({"motion": motion} if motion else {})
    return scene


def same(a, b, tolerance=1e-8):
    for key in ("force", "moment", "max_pressure", "area"):
        assert contact(a)[key] == pytest.approx(contact(b)[key], rel=tolerance, abs=tolerance), key
    a, b = a.summary["body"]["tool"], b.summary["body"]["tool"]
    assert a["displacement"] == pytest.approx(b["displacement"], rel=tolerance, abs=tolerance)
    assert a["rotation"] == pytest.approx(b["rotation"], rel=tolerance, abs=tolerance)


@pytest.mark.parametrize("gap", [0.0, GAP])
@pytest.mark.parametrize("dim, ranks", [(2, 1), (2, 2), (3, 1)])
def test_pressed_by_a_force(run, tmp_path, dim, ranks, gap):
    """One direction: the force that a motion asks for brings the same motion about; the first step finds the body from afar."""
    scene = pressed(tmp_path, dim, 1, {"law": "rigid"})
    told = solve(run, by_motion(scene, {"y": f"-{0.08 + gap}*t"}))
    force = told.summary["body"]["tool"]["force"][1]
    assert force > 0.01
    found = solve(run, by_load(scene, {"y": -force}), ranks=ranks)
    same(found, told)
    assert found.summary["body"]["tool"]["force"][1] == pytest.approx(force, rel=1e-9)
    assert max(row["newton_iterations"] for row in found.history) <= 12


@pytest.mark.parametrize("steps, ranks", [(2, 1), (5, 1), (2, 3)])
def test_force_and_moment(run, tmp_path, steps, ranks):
    """A punch that a force presses and a moment tilts: rotation unknown, coupled with the translation."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    told = solve(run, by_motion(scene, {"y": "-0.12*t", "rotation": {"angle": "4*t"}}))
    tool = told.summary["body"]["tool"]
    assert abs(tool["moment"][0]) > 1e-3
    scene["load"]["step"] = 1 / steps
    found = solve(run, by_load(scene, {"y": -tool["force"][1], "moment_z": -tool["moment"][0]}), ranks=ranks)
    same(found, told)
    for row in found.history:
        assert row["body.tool.force.y"] == pytest.approx(row["t"] * tool["force"][1], rel=1e-8)
        assert row["body.tool.moment"] == pytest.approx(row["t"] * tool["moment"][0], rel=1e-7)
    assert found.summary["balance"]["contact_moment"] < 1e-9


@pytest.mark.parametrize("axis", "xz")
def test_space(run, tmp_path, axis):
    """Tilted about an axis in space by a moment, pressed by a force."""
    scene = pressed(tmp_path, 3, 1, {"law": "rigid"})
    scene["order"] = 1
    told = solve(run, by_motion(scene, {"y": "-0.12*t", "rotation": {"axis": axis, "angle": "3*t"}}))
    tool = told.summary["body"]["tool"]
    found = solve(run, by_load(scene, {"y": -tool["force"][1], f"moment_{axis}": -tool["moment"][AXES.index(axis)]}))
    same(found, told)


@pytest.mark.parametrize("free", [False, True])
def test_moments_about_all_axes(run, tmp_path, free):
    """Tilted about a slanted axis. Free to slide as well, on what bears no force along it, the body slides until its load stands over what bears it, and is not tilted."""
    scene = pressed(tmp_path, 3, 1, {"law": "rigid"})
    scene["order"] = 1
    load = {"y": -0.1, "moment_x": 0.004, "moment_z": -0.003} | ({"x": 0, "z": 0, "moment_y": 0} if free else {})
    found = solve(run, by_load(scene, load), "-snes_test_jacobian")
    tool = found.summary["body"]["tool"]
    assert tool["moment"][::2] == pytest.approx([-0.004, 0.003], abs=1e-9) and tool["force"][1] == pytest.approx(0.1, abs=1e-9)
    if free:
        assert max(abs(tool["rotation"][0]), abs(tool["rotation"][2])) < 1e-6 and tool["force"] == pytest.approx([0, 0.1, 0], abs=1e-9)
    else:
        assert min(abs(tool["rotation"][0]), abs(tool["rotation"][2])) > 0.1, tool
    assert differences(found) < 1e-6


def test_axisymmetric(run, tmp_path):
    """A body of revolution under a force along its axis."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene["model"] = "axisymmetric"
    text = (tmp_path / "pressed2.msh").read_text()
    head, rest = text.split("$Nodes\n")
    nodes, tail = rest.split("$EndNodes")
    lines = nodes.splitlines()
    moved = [lines[0]] + [" ".join([a, repr(float(x) + 1), *others]) for a, x, *others in (line.split() for line in lines[1:])]
    (tmp_path / "pressed2.msh").write_text(head + "$Nodes\n" + "\n".join(moved) + "\n$EndNodes" + tail)
    told = solve(run, by_motion(scene, {"y": "-0.1*t"})).summary
    found = solve(run, by_load(scene, {"y": -told["body"]["tool"]["force"][1]})).summary
    assert found["body"]["tool"]["displacement"] == pytest.approx([0, -0.1], abs=1e-8)
    assert found["contact"]["c"]["max_pressure"] == pytest.approx(told["contact"]["c"]["max_pressure"], rel=1e-8)


def test_small(run, tmp_path):
    """Small kinematics: a force."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene["kinematics"] = "small"
    scene["material"]["elastic"] = {"law": "linear", "E": 1, "nu": 0.3}
    told = solve(run, by_motion(scene, {"y": "-0.1*t"})).summary
    found = solve(run, by_load(scene, {"y": -told["body"]["tool"]["force"][1]})).summary
    assert found["body"]["tool"]["displacement"] == pytest.approx([0, -0.1], abs=1e-8)


def test_load_and_motion_of_one_body(run, tmp_path):
    """Pushed along by a motion, held down by a force: over the rim the body sinks or rises as its load asks."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene["load"] = {"end": 2, "step": 0.5}
    found = solve(run, by_load(scene, {"y": "-0.05*min(t,1)"}, {"x": "0.3*max(t-1,0)"}))
    for row in found.history:
        assert row["body.tool.force.y"] == pytest.approx(0.05 * min(row["t"], 1), rel=1e-8)
        assert row["body.tool.displacement.x"] == pytest.approx(0.3 * max(row["t"] - 1, 0), abs=1e-12)


def test_disc_under_its_load_is_free_to_turn(run, tmp_path):
    """A round body pressed by a force, free to turn about its centre, under a small moment that nothing resists but its facets: it turns, and its load stays."""
    scene = roller(tmp_path)
    scene["load"] = {"step": 0.5}
    told = json.loads(json.dumps(scene))
    told["body"]["disc"]["motion"] = {"y": "-0.1*t"}
    force = solve(run, told).summary["body"]["disc"]["force"][1]
    scene["body"]["disc"]["load"] = {"y": -force}
    found = solve(run, scene).summary
    assert found["body"]["disc"]["displacement"] == pytest.approx([0, -0.1], abs=1e-8)


def test_adapted_and_gone_on(run, tmp_path):
    """Unknowns of the body are carried over to finer meshes, and through a checkpoint."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene |= {"adapt": {"tolerance": 0.1, "max_passes": 3}}
    scene["load"]["step"] = 0.5
    scene = by_load(scene, {"y": -0.05, "moment_z": 0.002})
    whole = run("scene.yml", text=json.dumps(scene))
    assert whole.solved, whole
    first = run("scene.yml", "-load_max_steps", 1, text=json.dumps(scene))
    rest = run("scene.yml", "-restart", first.directory / "checkpoint.h5", text=json.dumps(scene), ranks=2)
    assert rest.solved, rest
    same(rest, whole)
    for row in whole.history:
        assert row["body.tool.force.y"] == pytest.approx(0.05 * row["t"], rel=1e-8)


@pytest.mark.parametrize("dim, load", [(2, {"y": -0.1, "moment_z": 0.01}), (3, {"x": 0, "y": -0.1, "moment_x": 0.003})])
def test_tangent_is_exact(run, tmp_path, dim, load):
    """Against differences at every iterate; the end of the step is quadratic, and the equilibrium stable."""
    scene = by_load(pressed(tmp_path, dim, 1, tool={"law": "rigid"}), load)
    scene["order"] = 2 if dim == 2 else 1
    result = solve(run, scene, "-snes_test_jacobian", "-snes_monitor")
    norms = steps(result)[-1]
    assert len(norms) <= 10 and differences(result) < 1e-6
    assert is_quadratic(norms), norms
    assert dim == 3 or result.summary["unstable_equilibria"] == 0  # in space inertia is not counted where a factor serves again


# ---- with friction --------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("dim, ranks", [(2, 1), (2, 3), (3, 1)])
def test_friction(run, tmp_path, dim, ranks):
    """Pressed, then moved along and turned while part of it slips: the forces and the moment that this takes bring the same about."""
    scene = pressed(tmp_path, dim, 1, {"law": "rigid"})
    scene["order"], scene["load"] = 4 - dim, {"end": 2, "step": 1}
    scene["contact"]["c"]["friction"] = 0.1
    told = solve(run, by_motion(scene, {"x": "0.03*max(t-1,0)", "y": "-0.1*min(t,1)", "rotation": {"angle": "-1*max(t-1,0)"}}), "-mesh_refine", 3 - dim)
    tool = told.summary["body"]["tool"]
    first = {k: told.history[0][f"body.tool.{k}"] for k in ("force.x", "force.y", "moment" if dim == 2 else "moment.z")}
    final = dict(zip(first, (*tool["force"][:2], tool["moment"][-1])))
    assert told.history[-1]["contact.c.dissipation"] > 0 and abs(final["force.x"]) > 0.05 * final["force.y"]
    path = {key: f"{-first[key]!r}*min(t,1)+({first[key] - final[key]!r})*max(t-1,0)" for key in first}
    found = solve(run, by_load(scene, dict(zip(("x", "y", "moment_z"), path.values()))), "-snes_monitor", "-mesh_refine", 3 - dim, ranks=ranks)
    same(found, told)
    assert contact(found)["dissipation"] == pytest.approx(contact(told)["dissipation"], rel=1e-7)
    assert is_quadratic(steps(found)[-1])


@pytest.mark.parametrize("mu", [0.3, 1])
@pytest.mark.parametrize("dim, order, refine", [(2, 2, 0), (2, 2, 1), (2, 2, 3), (3, 1, 0), (3, 2, 0), (3, 1, 1)])
def test_sharp_punch(run, tmp_path, dim, order, refine, mu):
    """A rigid punch with corners, pressed, drawn along and tilted. Facets under its corners are covered in part, some by slivers: tractions there stay those
    of the facet."""
    scene = pressed(tmp_path, dim, 1, {"law": "rigid"}) if dim == 3 else pressed(tmp_path, tool={"law": "rigid"})
    scene["order"], scene["load"] = order, {"end": 2, "step": 1}
    scene["contact"]["c"]["friction"] = mu
    result = solve(run, by_motion(scene, {"x": "0.02*max(t-1,0)", "y": "-0.1*min(t,1)", "rotation": {"angle": "-1*max(t-1,0)"}}), "-mesh_refine", refine)
    print(dim, order, refine, mu, [row["newton_iterations"] for row in result.history])
    assert result.summary["step_cuts"] == 0 and max(row["newton_iterations"] for row in result.history) <= 12
    force = contact(result)["force"]
    assert 0.09 < -force[1] < 0.15 and abs(force[0]) < 0.1 * -force[1]


def test_a_roller_rolls(run, tmp_path):
    """A rigid disc that a force presses, drawn along and free to turn, rolls without a force; by how far each turn carries it depends on how deep it lies."""
    scene = roller(tmp_path)
    scene["contact"]["c"]["friction"] = 0.5
    scene["load"] = {"end": 2, "step": 0.25}
    scene["body"]["disc"] |= {"motion": {"x": "0.2*max(t-1,0)"}, "load": {"y": "-0.02*min(t,1)", "moment_z": 0}}
    result = solve(run, scene)
    disc = result.summary["body"]["disc"]
    assert disc["force"][1] == pytest.approx(0.02, abs=1e-9) and abs(disc["moment"][0]) < 1e-9
    assert abs(disc["force"][0]) < 0.02 * disc["force"][1]
    rolled = -math.radians(disc["rotation"][0]) / 0.2  # turns by this much for each unit of length
    assert 0.8 < rolled * 0.5 < 1.2, rolled


def test_glued_to_what_bends(run):
    """A slender strip holds a body through a tied pair: no stiffness is added to the body's motion (the strip's own is 40 times smaller than that would be), no
    step is shortened; half a circle in eight steps takes 74 iterations (1073 with them)."""
    result = run("tests/gauntlet/cap.yml", "-load_step", 0.125, "-output_fields", "false")
    assert result.returncode == 0, result
    assert result.summary["body"]["cap"]["rotation"][0] == pytest.approx(180, rel=1e-3)
    modifiers = result.summary["modifiers"]
    assert modifiers["proximal_shift"] == modifiers["line_search"] == 0, modifiers
    assert result.summary["newton_iterations"] <= 100 and "note: " not in result.stdout.split("step pass")[0], result


def test_work_of_a_motion_that_is_found(run):
    """How far a step goes too far is judged by the work along it, that of the rigid body's own motion with it: without, the beam slid down to another state."""
    result = run("tests/gauntlet/seesaw.yml", "-order", 3, "-output_fields", "false")
    assert result.returncode == 0, result
    assert result.summary["body"]["beam"]["rotation"][0] == pytest.approx(23.45, rel=0.015)


def test_forces_without_a_support(run):
    """No boundary of the scene is named: forces on rigid bodies are told all the same, and friction of the last step."""
    result = run("tests/gauntlet/lever.yml", "-output_fields", "false")
    assert result.returncode == 0, result
    body, pair, last = result.summary["body"], result.summary["contact"]["c"], result.history[-1]
    assert body["drum"]["force"] == pytest.approx(pair["mortar_force"], rel=1e-9) and pair["force"][1] > 0.09
    assert body["lever"]["moment"][0] == pytest.approx(0.2, rel=1e-9)
    assert pair["slipping_nodes"] == last["contact.c.slipping_nodes"] > 0
    assert pair["dissipation"] > 0 and pair["dissipation"] == pytest.approx(last["contact.c.dissipation"], rel=1e-9)


# ---- refused -----------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("edit, words", [
    (lambda s: s["body"]["tool"].update(load={"y": -1}, motion={"y": -1}), ["body.tool.load.y", "motion in y is prescribed"]),
    (lambda s: s["body"]["tool"].update(load={"moment_z": 1}, motion={"rotation": {"angle": 1}}), ["body.tool.load", "motion.rotation or a moment"]),
    (lambda s: s["body"]["tool"].update(load={"moment_x": 1}), ["body.tool.load.moment_x", "about z only"]),
    (lambda s: s["body"]["tool"].update(load={"y": "X"}), ["body.tool.load.y", "in t alone"]),
    (lambda s: s["body"]["tool"].update(load={"y": "log(t-2)"}), ["body.tool.load.y", "log", "not finite"]),
    (lambda s: s["body"]["tool"].update(load={"q": 1}), ["body.tool.load.q is not a key"]),
    (lambda s: s["body"]["strip"].update(load={"y": 1}), ["body.strip.load", "only a rigid body", "neo_hookean"]),
    (lambda s: s["body"]["tool"].update(force={"y": 1}), ["body.tool.force", "load"]),
    (lambda s: s["body"]["tool"].update(load={"y": 1}) or s["boundary"].update(tool_y1={"fix": "x"}), ["boundary.tool_y1 holds body 'tool'", "body.tool.load"]),
    (lambda s: s["body"]["tool"].update(load={"y": 1}) or s["load"].update(control="arc_length"), ["body.tool.load", "arc_length"]),
    (lambda s: s["body"]["tool"].update(load={"y": 1}) or s.pop("contact"), ["body.tool.load", "no contact pair"]),
])
def test_refused(run, tmp_path, edit, words):
    scene = pressed(tmp_path, tool={"law": "rigid"})
    edit(scene)
    refused(run("scene.yml", text=json.dumps(scene)), *words)


@pytest.mark.parametrize("dim", [2, 3])
def test_refused_where_a_corner_is_shared(run, tmp_path, dim):
    """A strap that hangs together with the tool at a corner (an edge) holds it by no contact."""
    scene = pressed(tmp_path, dim, 1, {"law": "rigid"})
    scene["body"] |= {"tool": {"material": "tool", "load": {"y": -0.01}}, "strap": {"material": "elastic"}}
    maps = [lambda x, y, *z: (x, y, *z), lambda x, y, *z: (x, 1.1 + y, *z), lambda x, y, *z: (1 + x, 2.1 + y, *z)]
    name = ("strip", "tool", "strap")
    write(scene["mesh"]["file"], [linspace(0, 1, 1)] * dim, maps, side=lambda side, centre, block: f"{name[block]}_{side}", body=lambda centre, block: name[block])
    scene["boundary"]["strap_x1"] = {"fix": "xyz"[:dim]}
    refused(run("scene.yml", text=json.dumps(scene)), "body.tool.load", "joined to body 'strap'", "contact alone")
