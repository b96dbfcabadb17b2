"""What goes wrong on the way ends in order: one sentence and exit status 1 where the input is the cause, else the last good state stays and is told of."""
import json
import math
import os
import shutil
import subprocess
import time

import pytest

from boxmesh import linspace, ring, write
from conftest import PROGRAM, ROOT


def refused(result, *words):
    """Exit status 1, one sentence with these words, nothing written."""
    assert result.returncode == 1 and not result.directory.exists(), result
    said = [line for line in result.stderr.splitlines() if line.strip() and "MPI_" not in line]
    assert len([line for line in said if line.startswith("mortise: ")]) == 1 and "PETSC ERROR" not in result.stderr, result
    for word in words:
        assert word in result.stderr, result


# ---- inverted cells of the reference mesh -----------------------------------------------------------------------------------------------


def thin_ring(path, layers=2, thick=0.06, **scene):
    """A sixth of a thin ring in a few long curved cells. Where cells of one layer are split, their new nodes on the next one's straight sides lie a thirtieth of the
    radius inside the circle: further than the first row of children is wide."""
    write(path / "ring.msh", [linspace(1, 1 + thick, layers), linspace(0, math.pi / 3, 2)], ring, order=2)
    return json.dumps({"mesh": {"file": "ring.msh"}, "model": "plane_strain", "body": {"body": {"material": "m"}}, "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}},
                       "boundary": {"y0": {"fix": "xy"}, "y1": {"fix": "xy"}, "x0": {"pressure": 0.001}}, "load": {"step": 1}} | scene)


@pytest.mark.parametrize("ranks", [1, 2])
def test_refined_at_the_start(run, tmp_path, ranks):
    near = {"refine": {"bore": {"boundary": "x0"}}}
    refused(run("ring.yml", text=thin_ring(tmp_path, **near), ranks=ranks), "order 1", "inverted", "mesh")
    if ranks > 1: return  # what follows needs no second process
    refused(run("ring.yml", "-check", text=thin_ring(tmp_path, **near)), "order 1", "inverted", "mesh")
    assert run("ring.yml", "-order", 2, text=thin_ring(tmp_path, **near)).returncode == 0


@pytest.mark.parametrize("ranks", [1, 2])
def test_adaptation_splits_what_it_would_invert(run, tmp_path, ranks):
    """The cells at one end alone are to be refined; where that inverts one, it and its coarser neighbours are split too."""
    adapt = {"adapt": {"tolerance": 1e-6, "max_passes": 3, "fraction": 0.01}}
    result = run("ring.yml", text=thin_ring(tmp_path, **adapt), ranks=ranks)
    assert result.solved and result.summary["adapt_stop"] == "max_passes" and "note: refinement would invert" not in result.stdout, result
    cells = [row["cells"] for row in result.adapt]
    assert cells[0] < cells[1] < cells[2] < cells[3] and result.history[-1]["t"] == 1


def test_adaptation_keeps_the_coarser_mesh(run, tmp_path):
    """With room for no cell more there is no mesh to go on with."""
    adapt = {"adapt": {"tolerance": 1e-6, "max_passes": 3, "fraction": 0.01, "max_cells": 10}}
    result = run("ring.yml", text=thin_ring(tmp_path, **adapt))
    assert result.returncode == 2 and result.summary["status"] == "inaccurate" and "tolerance 1e-06 was not reached" in result.summary["reason"], result
    assert "inverts a curved cell" in result.summary["adapt_stop"] and "note: refinement would invert" in result.stdout, result
    assert result.summary["cells"] == result.adapt[-1]["cells"] and result.history[-1]["t"] == 1


def strip(path, top, **scene):
    """Four cells held below, pressed by `top` above."""
    write(path / "strip.msh", [linspace(0, 1, 2)] * 2)
    return json.dumps({"mesh": {"file": "strip.msh"}, "model": "plane_strain", "body": {"body": {"material": "m"}}, "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}},
                       "boundary": {"y0": {"fix": "xy"}, "y1": {"displacement": {"x": 0, "y": top}}}, "adapt": {"tolerance": 0.01, "fraction": 1}} | scene)


WAVE = "-t*(0.1 + 3*sin(2*pi*X)^2)"  # smooth to the nodes there are; those of a finer mesh are to go through the floor


def test_no_equilibrium_on_a_finer_mesh(run, tmp_path):
    """The run ends with the coarse mesh, and neither its exit status nor a word of it says that it has what was asked for."""
    result = run("strip.yml", text=strip(tmp_path, WAVE, load={"step": 1}))
    s = result.summary
    assert result.returncode == 2 and s["status"] == "inaccurate" and s["adapt_stop"] == "no equilibrium found on a finer mesh", result
    words = f"adapt.tolerance 0.01 was not reached ({s['adapt_stop']}), the estimated error is up to {100 * s['estimated_error']:.3g} %"
    assert s["reason"] == words and f"inaccurate, {words}: 1 load step to t = 1 of 1" in result.stdout and "converged" not in result.stdout, result
    assert s["cells"] <= 10 and s["t"] == 1 and 0.2 < s["estimated_error"] < 0.3 and s["energy"] > 0 and len(result.history) == 1


def test_it_is_not_forgotten(run, tmp_path):
    """A later load step that is within the tolerance, in a run that goes on from a checkpoint, does not make the first one better."""
    text = strip(tmp_path, f"t <= 0.5 ? {WAVE} : -(1 - t)*(0.1 + 3*sin(2*pi*X)^2) - 0.05*(t - 0.5)", load={"step": 0.5})
    first = run("strip.yml", "-load_max_steps", 1, text=text)
    assert first.summary["status"] == "failed" and first.summary["load_steps"] == 1, first
    result = run("strip.yml", "-adapt_tolerance", 0.2, "-restart", first.directory / "checkpoint.h5", text=text)
    assert result.returncode == 2 and result.summary["status"] == "inaccurate" and result.summary["adapt_stop"] == "tolerance" and result.summary["load_steps"] == 2, result
    assert "(no equilibrium found on a finer mesh at t = 0.5), the estimated error is up to" in result.summary["reason"], result


def test_judged_by_the_load_to_come(run, tmp_path):
    """Half of the way has 1/16 of the load: an error above the tolerance there is none against the load at the end. The other way round it is one."""
    limits = ("-adapt_max_passes", 2, "-adapt_tolerance", 0.1)
    rising, falling = (run("strip.yml", *limits, text=strip(tmp_path, top, load={"step": 0.5})) for top in ("-0.1*t^4*(1 + X)", "-0.1*(1.0625 - t^4)*(1 + X)"))
    for result in rising, falling:
        errors = [row["estimated_error"] for row in result.history]
        assert errors[0] > 0.1 > errors[1], result
    assert rising.returncode == 0 and rising.summary["reason"] == "", rising
    assert falling.returncode == 2 and "(max_passes at t = 0.5)" in falling.summary["reason"], falling


@pytest.mark.parametrize("dimension", [2, 3])
def test_rigid_motion_converges(run, tmp_path, dimension):
    """Far away and turned half round a body is free of stress, and what is left is round-off."""
    write(tmp_path / "box.msh", [linspace(0, 1, 2)] * dimension)
    turn = {"x": "1000*t + X*(cos(pi*t) - 1) - Y*sin(pi*t)", "y": "X*sin(pi*t) + Y*(cos(pi*t) - 1)"} | ({"z": "5*t"} if dimension == 3 else {})
    scene = {"mesh": {"file": "box.msh"}, "model": "plane_strain" if dimension == 2 else "3d", "order": 2, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "neo_hookean", "E": 2e11, "nu": 0.3}}, "boundary": {"y0": {"displacement": turn}}, "load": {"step": 0.125}}
    result = run("box.yml", "-output_fields", "false", text=json.dumps(scene))
    assert result.returncode == 0 and result.summary["step_cuts"] == 0 and result.summary["energy"] < 1e-15 * 2e11, result


@pytest.mark.parametrize("limit,value", [("max_passes", 1), ("max_cells", 5)])
def test_limits_are_told(run, tmp_path, limit, value):
    """Limits are the user's, but a tolerance that they leave out of reach is not met. Within it there is nothing to say."""
    text = strip(tmp_path, "-0.2*t*X", load={"step": 1})
    result = run("strip.yml", f"-adapt_{limit}", value, text=text)
    assert result.returncode == 2 and result.solved, result
    assert f"inaccurate, adapt.tolerance 0.01 was not reached ({limit}), the estimated error is up to" in result.stdout, result
    enough = run("strip.yml", "-adapt_tolerance", 0.5, text=text)
    assert enough.returncode == 0 and enough.summary["reason"] == "" and "converged: 1 load step" in enough.stdout, enough


@pytest.mark.parametrize("shift,fine", [(0.24, True), (0.27, False)])
def test_inverted_between_samples(run, tmp_path, shift, fine):
    """The middle node of a cell of nine moved aside by `shift`: the determinant 1 + 16 shift (1 - 2 x) y (1 - y) is least, 1 - 4 shift, in the middle of a side, and
    still positive at thirds of it."""
    write(tmp_path / "cell.msh", [linspace(0, 1, 1)] * 2, lambda x, y: (x + (shift if x == y == 0.5 else 0), y), order=2)
    scene = {"mesh": {"file": "cell.msh"}, "model": "plane_strain", "order": 2, "body": {"body": {"material": "m"}}, "boundary": {"y0": {"fix": "xy"}},
             "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "load": {"step": 1}}
    result = run("cell.yml", text=json.dumps(scene))
    if fine:
        assert result.returncode == 0, result
    else:
        refused(result, "mesh cell 1 of 1", "inverted")


# ---- a direct solver that fails -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ranks", [1, 2])
def test_mumps_fails_in_the_solve(run, ranks):
    """ICNTL(31) = 1 makes MUMPS throw its factors away: it factorises, and cannot solve (INFOG(1) = -44). Steps are cut and given up like others that fail."""
    result = run("inputs/patch2d.yml", "-mat_mumps_icntl_31", 1, "-load_step_min", 0.01, ranks=ranks)
    s = result.summary
    assert result.returncode == 2 and s["status"] == "failed" and s["reason"] and s["t"] == 0 and s["step_cuts"] > 5, result
    assert "PETSC ERROR" not in result.stderr and "MPI_ABORT" not in result.stderr, result
    assert f", {s['step_cuts']} step cuts, " in result.stdout and f", {s['newton_iterations']} Newton iterations, " in result.stdout, result


def test_batch(tmp_path):
    """Several scenes in a row: each its log, the worst exit status; two of one name would write to the same files."""
    bad = tmp_path / "bad.yml"
    bad.write_text("title: no mesh\n")
    command, env = [str(ROOT / "scripts/hpc/batch"), str(ROOT / "inputs/cube.yml"), str(bad)], {**os.environ, "MORTISE": str(PROGRAM)}
    done = subprocess.run([*command, "--", "-output_directory", str(tmp_path / "out")], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 1 and [line.split("(")[0].split() for line in done.stdout.splitlines()] == [["cube", "converged"], ["bad", "wrong", "input"]], done
    assert "converged" in (tmp_path / "cube.log").read_text() and "mesh.file" in (tmp_path / "bad.log").read_text()
    done = subprocess.run([*command, str(ROOT / "inputs/cube.yml")], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 1 and "two scenes are called cube" in done.stderr and not done.stdout, done


@pytest.mark.parametrize("words,said", [(["-n"], "-n is ''; allowed: an integer, 1 or more"), (["-n", "two", "cube.yml"], "-n is 'two'"), (["-h"], "'-h' is no scene"),
                                        (["log.yml"], "log.log cannot be written"), (["cube.yml"], "no temporary directory can be made"), (["-n", "2", "cube.yml"], "needs mpiexec")])
def test_batch_refuses(tmp_path, words, said):
    (tmp_path / "log.log").mkdir()
    place = "TMPDIR" if "temporary" in said else "PATH" if "mpiexec" in said else "NOTHING"
    if place == "PATH":
        for name in "bash", "dirname": (tmp_path / name).symlink_to(shutil.which(name))
    env = {**os.environ, "MORTISE": str(PROGRAM), place: str(tmp_path / "none" if place == "TMPDIR" else tmp_path)}
    done = subprocess.run(["/bin/bash", ROOT / "scripts/hpc/batch", *words], cwd=tmp_path, env=env, capture_output=True, text=True)
    assert done.returncode == 1 and said in done.stderr and done.stderr.count("\n") == 1 and not done.stdout, done


def test_batch_stops(tmp_path):
    """The run with it, with a checkpoint, and no other is begun."""
    scene = json.dumps(json.loads(strip(tmp_path, "-0.1*t", load={"step": 0.000005, "max_steps": 200000}, output={"fields": False}, adapt={})))
    for name in "ab": (tmp_path / f"{name}.yml").write_text(scene)
    process = subprocess.Popen([ROOT / "scripts/hpc/batch", "a.yml", "b.yml"], cwd=tmp_path, env={**os.environ, "MORTISE": str(PROGRAM)}, stdout=subprocess.PIPE, text=True)
    while not (tmp_path / "out/a/checkpoint.h5").exists() and process.poll() is None: time.sleep(0.01)
    process.terminate()
    said = process.communicate(timeout=300)[0]
    assert process.returncode == 3 and said.split("(")[0].split() == ["a", "stopped"] and not (tmp_path / "out/b").exists() and not (tmp_path / "out/a/lock").exists(), said


def test_recoveries_are_switched(run):
    """Each row of the table of recoveries: off, auto, on; anything else is refused. summary.json counts them."""
    done = run("inputs/patch2d.yml", "-path_viscous", "off", "-path_cut", "on", "-output_fields", "false")
    recoveries = done.summary["recoveries"]
    assert done.returncode == 0 and {"overlap", "cut", "viscous"} <= set(recoveries) and all(row == {"tried": 0, "succeeded": 0} for row in recoveries.values()), done
    refused(run("inputs/patch2d.yml", "-path_viscous", "maybe"), "-path_viscous is 'maybe'", "auto|on|off")
    refused(run("inputs/patch2d.yml", "-path_viscos", "on"), "-path_viscos", "-path_viscous")
    refused(run("inputs/patch2d.yml", "-load_relax", "false"), "-path_viscous")
