"""adapt.repeat: path. The whole path of loads is computed again on the finer mesh, with nothing carried over: the last path is that of a run on its mesh from the
start; what stands where in tables and fields; restarts in the middle of any path, kills at any moment; ranks; limits; what is refused."""
import json
import math
import os
import random
import shutil
import signal
import subprocess

import pytest

from boxmesh import linspace, write
from conftest import PROGRAM, Result
from test_checkpoint import assert_same_run, exact

PATH = ("-adapt_repeat", "path", "-adapt_tolerance", 0.05)
TWO = ("-adapt_repeat", "path", "-adapt_tolerance", 1e-6, "-adapt_max_passes", 1, "-adapt_fraction", 1)  # all cells split, once


@pytest.fixture
def block(run, tmp_path):
    """block(*options, ...): half a block of metal that sticks to the plate above it, pressed until it flows, and let go."""
    def solve(*options, cells=3, status=0, **keywords):
        write(tmp_path / "block.msh", [linspace(0, 1, cells)] * 2)
        scene = {"mesh": {"file": "block.msh"}, "model": "plane_strain", "order": 2, "body": {"body": {"material": "m"}},
                 "material": {"m": {"law": "j2", "volumetric": "simo", "mu": 80, "kappa": 170, "yield": 0.4, "hardening": 10, "formulation": "mixed"}},
                 "boundary": {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "y1": {"displacement": {"x": 0, "y": "-0.02*t"}, "amplitude": [0, 0, 1, 1, 1.5, 0.9]}},
                 "load": {"step": 0.25, "end": 1.5}, "probe": {"side": {"x": 1, "y": 0.5}}}
        result = run("block.yml", *options, text=json.dumps(scene), **keywords)
        assert result.solved if status == 0 else result.returncode == status, result
        return result

    return solve


def figures(row):
    return {key: value for key, value in row.items() if key not in ("pass", "seconds", "newton_iterations") and "imbalance" not in key}


def assert_same_path(one, other, tolerance=1e-9):
    assert len(one) == len(other)
    for a, b in zip(one, other):
        scale = max((abs(value) for key, value in a.items() if key.startswith(("reaction", "probe"))), default=0)
        assert figures(a) == pytest.approx(figures(b), rel=tolerance, abs=tolerance * scale)


def test_last_path_is_that_of_its_mesh(block):
    """All cells are split once: as if they had been from the start, and not as if history had been carried over. adapt.csv has both paths, the other files the last."""
    result, fine, step = block(*TWO), block("-mesh_refine", 1, "-adapt_tolerance", 0), block("-adapt_tolerance", 0.085, "-adapt_fraction", 1, "-adapt_max_cells", 36)
    assert_same_path(result.history, fine.history)
    assert abs(step.history[-1]["plastic.work"] / fine.history[-1]["plastic.work"] - 1) > 1e-6
    assert ["refined after material had flowed" in run.stdout for run in (result, fine, step)] == [False, False, True]
    assert [(row["pass"], row["step"]) for row in result.history] == [(1, k) for k in range(1, 7)]
    assert [(row["pass"], row["step"]) for row in result.adapt] == [(p, k) for p in (0, 1) for k in range(1, 7)]
    assert all(row["accepted"] and row["cells"] == (9, 36)[int(row["pass"])] for row in result.adapt)
    assert [time for time, _ in result.states()] == [row["t"] for row in result.history]
    assert len(list(result.directory.glob("fields_*.h5"))) == len(result.history)
    s = result.summary
    assert (s["adapt_stop"], s["adapt_passes"], s["load_steps"], s["cells"]) == ("max_passes", 1, 6, 36), s
    assert "pass 1: the path again from t = 0, on 36 cells" in result.stdout and "adaptation ended: max_passes" in result.stdout


def test_every_step_is_within_the_tolerance(block):
    """Cells that any step needed are split; the one step above the tolerance is enough to go on. One mesh is for all steps of a path."""
    result = block(*PATH)
    passes = sorted({row["pass"] for row in result.adapt})
    paths = [[row for row in result.adapt if row["pass"] == p] for p in passes]
    assert len(passes) > 2 and all(len({row["cells"] for row in path}) == 1 for path in paths)
    for path in paths[:-1]:
        assert max(row["estimated_error"] for row in path) > PATH[-1]
    assert max(row["estimated_error"] for row in result.history) <= PATH[-1] and result.summary["adapt_stop"] == "tolerance", result
    assert result.summary["newton_iterations"] == sum(row["newton_iterations"] for row in result.adapt)


@pytest.mark.parametrize("options, stop", [((), "max_cells"), (("-adapt_strategy", "p", "-adapt_max_order", 2), "nothing left to refine")])
def test_limits(block, options, stop):
    result = block(*PATH[:2], "-adapt_tolerance", 0.02, "-adapt_max_cells", 40, *options)
    assert result.summary["adapt_stop"] == stop and result.summary["cells"] <= 55, result


@pytest.mark.parametrize("ranks, limits", [((2,), ("-adapt_max_passes", 1, "-load_end", 0.75)), pytest.param((2, 3), (), marks=pytest.mark.slow)])
def test_ranks(block, ranks, limits):
    one, *others = [block(*PATH, *limits, ranks=n) for n in (1, *ranks)]
    for other in others:
        assert_same_path(one.adapt, other.adapt)
        assert_same_path(one.history, other.history)


@pytest.mark.parametrize("strategy", ["h", pytest.param("hp", marks=pytest.mark.slow)])
@pytest.mark.parametrize("ranks, then", [(1, 1), pytest.param(1, 2, marks=pytest.mark.slow), pytest.param(3, 1, marks=pytest.mark.slow)])
def test_broken_off(block, strategy, ranks, then):
    """Broken off in the middle of the first path, at its end, and in the middle of the second; each time it goes on as if nothing had happened."""
    options = (*PATH, "-adapt_strategy", strategy, "-adapt_max_order", 3)
    whole = block(*options)
    first = block(*options, "-load_max_steps", 4, status=2, ranks=ranks)
    again = ("-output_directory", first.directory, "-restart", "auto")
    ended = block(*options, *again, "-adapt_max_passes", 0, ranks=then)
    assert "goes on after load step 4" in ended.stdout and "adaptation ended: max_passes" in ended.stdout
    ended.directory = first.directory
    ended_history = ended.history
    middle = block(*options, *again, "-load_max_steps", 3, ranks=ranks, status=2)
    middle.directory = first.directory
    assert [(row["pass"], row["step"]) for row in middle.history] == [(1, k) for k in (1, 2, 3)] and middle.summary["status"] == "failed"
    assert [time for time, _ in middle.states()] == [row["t"] for row in middle.history]
    earlier = aside(middle)
    assert_same_path(earlier.history, ended_history)
    assert [time for time, _ in earlier.states()] == [row["t"] for row in earlier.history] and (earlier.summary["status"], earlier.summary["cells"]) == ("inaccurate", 9)
    assert f"note: the path on the mesh before came to its end; its results are in {first.directory}/earlier_path" in middle.stdout
    last = block(*options, *again, ranks=then)
    last.directory = first.directory
    assert "goes on after load step 3" in last.stdout and not earlier.directory.exists() and "note: the path on" not in last.stdout
    assert_same_run(whole, last, exact if ranks == then == 1 else lambda key: 1e-9)


def aside(result):
    return Result(result.command, result.returncode, "", "", result.directory / "earlier_path")


def test_put_aside(block):
    """The finer path fails in its first step: the results of the one before are there, whole. Broken off while they were moved, moving goes on; a fresh run removes
    them."""
    whole = block(*TWO, "-adapt_max_passes", 0)
    first = block(*TWO, "-adapt_max_passes", 0)
    again = ("-output_directory", first.directory, "-restart", "auto")
    failed = block(*TWO, *again, "-boundary_y1_displacement_y", "t < 1.4 ? sqrt(0-t) : -0.02*t", status=2)
    earlier = aside(first)

    def assert_whole():
        assert_same_path(earlier.history, whole.history)
        assert earlier.summary["t"] == 1.5 and earlier.summary["energy"] == pytest.approx(whole.summary["energy"], rel=1e-9)
        assert len(list(earlier.directory.glob("fields_*.h5"))) == len(earlier.states()) == 6

    assert_whole()
    assert f"its results are in {earlier.directory}\n" in failed.stdout and not first.history and not first.states()
    for name in ("fields_0005.h5", "fields.xdmf", "summary.json", "history.csv"):
        (earlier.directory / name).replace(first.directory / name)
    block(*TWO, *again, "-load_max_steps", 2, status=2)
    assert_whole()
    assert [row["pass"] for row in first.history] == [1, 1] and len(first.states()) == 2
    block(*TWO, "-adapt_max_passes", 0, "-output_directory", first.directory)
    assert not earlier.directory.exists() and len(first.history) == 6


@pytest.mark.slow
def test_killed(block):
    """At any moment, also where one path ends and the next begins: what the files hold is of one path, and the run goes on to the same end."""
    options = (*PATH, "-output_checkpoint", 2)
    whole = block(*options)
    seconds = whole.summary["time"]["total"]
    scene = whole.command[1]
    dice, passes = random.Random(1), set()
    for number in range(12):
        directory = whole.directory.with_name(f"killed{number}")
        command = [str(PROGRAM), scene, *map(str, options), "-output_directory", str(directory)]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        try:
            process.wait(dice.uniform(0.1, 1) * seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        second = block(*options, "-output_directory", directory, "-restart", "auto")
        second.directory = directory
        passes |= {row["pass"] for row in second.adapt}
        for name in set(os.listdir(directory)) - set(os.listdir(whole.directory)):  # of a file that was being written
            assert name.endswith(".tmp")
            (directory / name).unlink()
        assert_same_run(whole, second, exact)
    assert len(passes) > 2


def test_what_is_refused(block, run):
    result = block(*PATH, "-adapt_coarsen", 0.1, status=1)
    assert "adapt.coarsen is 0.1, but with adapt.repeat: path" in result.stderr and "allowed with it: 0" in result.stderr, result
    result = run("inputs/hertz2d.yml", *PATH, "-adapt_history", "none")
    assert result.returncode == 1 and "adapt.history cannot act with adapt.repeat: path, which carries nothing over; allowed with it: carried" in result.stderr, result
    first = block(*PATH, "-load_max_steps", 2, status=2)
    for options, was, has in ((("-adapt_repeat", "step"), "path", "step"), (("-adapt_tolerance", 0.04), "tolerance 0.05", "tolerance 0.04")):
        result = block(*PATH, *options, "-restart", first.directory / "checkpoint.h5", status=1)
        assert f"it was written with 'adapt.repeat: {was}', the scene has 'adapt.repeat: {has}'" in result.stderr, result


def test_arc_length(run, tmp_path):
    """Steps along a path of equilibria, a shallow arch that snaps through: on the mesh of the second pass as on that mesh from the start."""
    def arc(x, y):
        return (99.5 + y) * math.sin(0.25 * x), (99.5 + y) * math.cos(0.25 * x) - 100

    write(tmp_path / "arch.msh", [linspace(0, 1, 4), linspace(0, 1, 1)], arc, order=2)
    scene = {"mesh": {"file": "arch.msh"}, "model": "plane_strain", "order": 2, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "neo_hookean", "E": 1e4, "nu": 0.3}}, "boundary": {"x0": {"fix": "x"}, "x1": {"fix": "xy"}, "y1": {"traction": {"y": -3}}},
             "load": {"step": 0.02, "step_max": 0.2, "control": "arc_length"}, "output": {"fields": False}, "probe": {"top": {"x": 0, "y": 0}}}
    two, fine = (run("arch.yml", *options, text=json.dumps(scene)) for options in (TWO, ("-mesh_refine", 1)))
    assert two.solved and fine.solved and {row["cells"] for row in two.adapt} == {4, 16}, (two, fine)
    t = [row["t"] for row in fine.history]
    assert any(b < a for a, b in zip(t, t[1:]))
    assert_same_path(two.history, fine.history, 1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("ranks", [1, 2])
def test_layers(run, ranks):
    """contact.<pair>.subdivide: auto asks of the whole path how often: as of one load step where there is one."""
    options = ("-order", 2, "-adapt_tolerance", 0, "-contact_disc_on_block_order", 1, "-contact_disc_on_block_subdivide", "auto", "-load_step", 1)
    step, path = run("inputs/hertz2d.yml", *options), run("inputs/hertz2d.yml", *options, "-adapt_repeat", "path", ranks=ranks)
    assert step.summary["adapt_stop"] == path.summary["adapt_stop"] == "contact faces fine enough", (step, path)
    assert step.summary["cells"] == path.summary["cells"] and step.summary["adapt_passes"] == path.summary["adapt_passes"] > 0
    assert path.history[-1]["contact_force"] == pytest.approx(step.history[-1]["contact_force"], rel=1e-8)


def test_elastic_cells_do_not_know_the_mesh_before(block):
    """All cells of metal that has not flowed are split behind the third of four steps: with what was carried over and with nothing the state is the same
    but for what polynomials miss of elastic strains, 1.2e-6. With their volume settled as where there was flow it was 2e-4 off."""
    elastic = ("-material_m_yield", 1e6, "-material_m_kappa", 1e5, "-boundary_y1_displacement_y", "-0.2*t", "-load_end", 1, "-output_fields", "false")
    first = block(*elastic, "-adapt_tolerance", 0.9, "-load_max_steps", 3, status=2)
    split = ("-adapt_tolerance", 1e-3, "-adapt_max_passes", 1, "-adapt_fraction", 1, "-restart", first.directory / "checkpoint.h5")
    carried, none = (block(*elastic, *split, "-adapt_history", word, status=2).summary for word in ("carried", "none"))
    assert carried["cells"] == none["cells"] > 30 and carried["energy"] == pytest.approx(none["energy"], rel=1e-5)
