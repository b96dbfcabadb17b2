"""O-102: a run that was broken off and goes on from its checkpoint ends as if nothing had happened, on any number of ranks; a kill at any moment costs no more than
the load step in progress; requests to stop leave a checkpoint and readable results; files that are no whole checkpoint of this scene are refused."""
import hashlib
import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

from boxmesh import linspace, write
from combinations import on_two
from conftest import PROGRAM, ROOT, Result, leaves
from test_hostile import block

STEPS = ("-load_step", 0.25)
TILTED = ("-load_step", 0.5, "-boundary_top_displacement_z", "-0.06*t - 0.06*t*X*Y", "-adapt_tolerance", 0.001, "-order", 2, "-adapt_max_passes", 1)
# name: scene, options, load step after which it is broken off
SCENES = {
    "adaptive": ("hertz2d", (*STEPS, "-adapt_tolerance", 0.03), 2),
    "hanging": ("hertz2d", (*STEPS, "-order", 1, "-adapt_tolerance", 0.2, "-adapt_coarsen", 0.02), 2),
    "hp": ("hertz2d", (*STEPS, "-adapt_strategy", "hp", "-adapt_tolerance", 0.02, "-adapt_max_passes", 4), 2),
    "mixed": ("rubber2d", (*STEPS, "-adapt_max_passes", 2), 2),
    "slide": ("slide2d", ("-order", 1, "-adapt_max_passes", 2), 1),
    "segments": ("hertz2d", (*STEPS, "-order", 1, "-adapt_tolerance", 0, "-output_segments", 1), 3),
    "shrinkfit": ("shrinkfit", STEPS, 2),
    "space": ("blocks3d", TILTED, 1),
    "incompressible": ("rubber2d", (*STEPS, "-adapt_max_passes", 2, "-material_rubber_nu", 0.5), 2),
    "layers": ("hertz2d", (*STEPS, "-order", 2, "-adapt_tolerance", 0, "-contact_disc_on_block_order", 1, "-contact_disc_on_block_subdivide", "auto"), 1),
    "volume": ("balloon", ("-load_step", 0.1, "-material_rubber_kappa", 100), 4),
    "flow": ("angioplasty2d", (), 10),
    "flow_adaptive": ("angioplasty2d", ("-order", 1, "-adapt_tolerance", 0.1, "-adapt_max_cells", 2500, "-load_end", 0.4), 3),
}
# counts that may differ where bodies touch all around at once: round-off decides the way, not where it leads
WAYS = ("newton_iterations", "active_set_changes", "active_set_cycles", "modifiers")
TIME = ("seconds",)  # of tables: wall time
RUN = ("time", "needs", "ranks", "peak_memory_mb", "peak_memory_rank_mb", "factorisations", "balance", "unstable_equilibria")  # of summary.json: the process; round-off; null on many


def kept(key):
    return key not in RUN and not key.endswith("imbalance")


def exact(key):
    return 0


def close(key):
    return 1e-10


def arrived(key):
    return math.inf if any(way in key for way in WAYS) else close(key)


def assert_equal(one, other, scale, tolerance=close):
    """To the tolerance of each key, relative; what is zero but for round-off to that of the scale of its kind. The largest such difference."""
    one, other = dict(one), dict(other)
    worst = 0
    assert one.keys() == other.keys()
    for key, a in one.items():
        if a is None or isinstance(a, str):
            assert other[key] == a, key
        else:
            size = scale["stress" in key or "max_pressure" in key]
            assert other[key] == pytest.approx(a, rel=tolerance(key), abs=tolerance(key) * size, nan_ok=True), key
            if not math.isnan(a) and tolerance(key) < 1:
                worst = max(worst, abs(other[key] - a) / max(abs(a), size))
    return worst


def scales(result):
    """Of forces the largest reaction or contact pressure; of stresses and pressures at single places that or the largest stress of the run: they are exact to the
    round-off of strains times the stiffness of the bodies."""
    force = max([np.abs(r).max() for r in result.summary["reaction"].values()] + [pair["max_pressure"] for pair in result.summary["contact"].values()])
    return force, max([force] + [abs(value) for row in result.history for key, value in row.items() if "stress" in key])


def assert_same_run(whole, parts, tolerance=close):
    scale = scales(whole)
    worst = assert_equal(leaves(whole.summary, kept), leaves(parts.summary, kept), scale, tolerance)
    for table in ("history", "adapt"):
        a, b = getattr(whole, table), getattr(parts, table)
        assert len(a) == len(b), table
        for x, y in zip(a, b):
            assert list(x) == list(y)
            worst = max(worst, assert_equal(*[((k, v) for k, v in row.items() if k not in TIME and not k.endswith("imbalance")) for row in (x, y)], scale, tolerance))
    for grid in ("bulk", "contact", "segments"):
        a, b = whole.states(grid, passes=True), parts.states(grid, passes=True)
        assert [time for time, _ in a] == [time for time, _ in b], grid
    assert sorted(os.listdir(whole.directory)) == sorted(os.listdir(parts.directory))
    print("largest difference", worst)


def go_on(run, directory, scene, *options, restart="auto", **keywords):
    """The run goes on in a directory that is there."""
    result = run(scene, *options, "-output_directory", directory, "-restart", restart, **keywords)
    result.directory = pathlib.Path(directory)
    return result


def break_off_and_go_on(run, name, ranks, then):
    scene, options, step = SCENES[name]
    scene = f"inputs/{scene}.yml"
    first = run(scene, *options, "-load_max_steps", step, ranks=ranks)
    assert first.returncode == 2 and first.summary["load_steps"] == step, first
    second = go_on(run, first.directory, scene, *options, ranks=then)
    assert second.solved and f"goes on after load step {step}" in second.stdout, second
    return second


@pytest.mark.parametrize("name,ranks,then", [("adaptive", 1, 3), pytest.param("mixed", 2, 1, marks=pytest.mark.slow)])
def test_o102_other_ranks(run, name, ranks, then):
    whole = run(f"inputs/{SCENES[name][0]}.yml", *SCENES[name][1])
    assert whole.returncode == 0, whole
    assert_same_run(whole, break_off_and_go_on(run, name, ranks, then))


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_o102_all(run, name):
    whole = run(f"inputs/{SCENES[name][0]}.yml", *SCENES[name][1])
    assert whole.solved, whole
    for ranks, then in ((1, 1), (1, 2), (3, 1), (2, 3)):
        print(name, ranks, "->", then)
        alike = ranks == then and name != "space"  # there a factor that an earlier tangent left serves again
        assert_same_run(whole, break_off_and_go_on(run, name, ranks, then), exact if alike else arrived if name == "flow" else close)


@pytest.mark.parametrize("then,tolerance", [(1, exact), (2, arrived)])
def test_o102_flow(run, then, tolerance):
    """Contact, flow, nearly incompressible: on one process bit by bit, on others to 1e-10, stresses of the metal with the bulk modulus of 1e4 shear moduli too."""
    scene, options = "inputs/angioplasty2d.yml", ("-load_end", 0.2)
    whole = run(scene, *options)
    first = run(scene, *options, "-load_max_steps", 2)
    assert whole.returncode == 0 and first.returncode == 2, first
    assert_same_run(whole, go_on(run, first.directory, scene, *options, ranks=then), tolerance)
    for row in whole.history[1:]:
        assert row["contact.inside.active_nodes"] > 0 and row["plastic.strain"] > 0, row


@pytest.mark.parametrize("name", ["hp", pytest.param("hanging", marks=pytest.mark.slow), pytest.param("mixed", marks=pytest.mark.slow),
                                  pytest.param("segments", marks=pytest.mark.slow), pytest.param("flow_adaptive", marks=pytest.mark.slow)])
def test_o102_same_fields(run, name):
    """On one process, in the plane: the same index and all fields of all states, bit by bit."""
    whole = run(f"inputs/{SCENES[name][0]}.yml", *SCENES[name][1])
    parts = break_off_and_go_on(run, name, 1, 1)
    assert_same_run(whole, parts, exact)
    for index in ("fields.xdmf",) if name == "segments" else ("fields.xdmf", "passes.xdmf"):  # segments: no mesh adapts
        assert (whole.directory / index).read_text() == (parts.directory / index).read_text()
    for grid in ("bulk", "contact"):
        for (_, a), (_, b) in zip(whole.states(grid, passes=True), parts.states(grid, passes=True)):
            assert a.keys() == b.keys()
            for field in a:
                assert np.array_equal(a[field], b[field]), field


@pytest.mark.parametrize("ranks,then", [(1, 1), pytest.param(1, 3, marks=pytest.mark.slow), pytest.param(3, 2, marks=pytest.mark.slow)])
def test_o102_plastic(run, tmp_path, ranks, then):
    """Law j2: a bore driven out and let go, broken off while the material flows, so that what it remembers decides the rest; mixed cells."""
    write(tmp_path / "tube.msh", [linspace(1, 1.15, 4), linspace(0, 1, 2)], lambda *x: x, order=2)
    scene = {"mesh": {"file": "tube.msh"}, "model": "axisymmetric", "order": 2, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "j2", "volumetric": "simo", "mu": 80e3, "kappa": 170e3, "yield": 205, "hardening": 1000, "formulation": "mixed"}},
             "boundary": {"x0": {"displacement": {"x": "0.1*min(t,1)-0.005*max(t-1,0)"}}, "y0": {"fix": "y"}, "y1": {"fix": "y"}},
             "load": {"step": 0.125, "end": 1.25}, "probe": {"bore": {"x": 1, "y": 0.5}}}
    whole = run("tube.yml", text=json.dumps(scene))
    assert whole.returncode == 0, whole
    first = run("tube.yml", "-load_max_steps", 6, text=json.dumps(scene), ranks=ranks)
    assert first.returncode == 2, first
    second = go_on(run, first.directory, "tube.yml", text=json.dumps(scene), ranks=then)
    assert second.returncode == 0, second
    assert_same_run(whole, second)


@pytest.mark.parametrize("ranks,then", [(1, 1), pytest.param(1, 2, marks=pytest.mark.slow), pytest.param(3, 1, marks=pytest.mark.slow)])
def test_o102_path(run, tmp_path, ranks, then):
    """A shallow arch that snaps through, broken off on the way between its limit points, where the load falls."""
    def arc(x, y):
        return (99.5 + y) * math.sin(0.25 * x), (99.5 + y) * math.cos(0.25 * x) - 100

    write(tmp_path / "arch.msh", [linspace(0, 1, 8), linspace(0, 1, 1)], arc, order=2)
    scene = {"mesh": {"file": "arch.msh"}, "model": "plane_strain", "order": 3, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "neo_hookean", "E": 1e4, "nu": 0.3}}, "boundary": {"x0": {"fix": "x"}, "x1": {"fix": "xy"}, "y1": {"traction": {"y": -3}}},
             "load": {"step": 0.02, "step_max": 0.2, "control": "arc_length"}, "probe": {"top": {"x": 0, "y": 0}}}
    whole = run("arch.yml", text=json.dumps(scene))
    assert whole.returncode == 0, whole
    t = [row["t"] for row in whole.history]
    step = next(k for k in range(2, len(t)) if t[k - 1] < t[k - 2])  # the first accepted step that went down
    first = run("arch.yml", "-load_max_steps", step, text=json.dumps(scene), ranks=ranks)
    assert first.returncode == 2 and first.history[-1]["t"] < first.history[-2]["t"], first
    second = go_on(run, first.directory, "arch.yml", text=json.dumps(scene), ranks=then)
    assert second.returncode == 0, second
    assert_same_run(whole, second)


def test_o102_nothing_left_to_do(run):
    """A run that has ended goes on to the same summary, also under a new tolerance or into a new directory."""
    scene, options, _ = SCENES["adaptive"]
    whole = run(f"inputs/{scene}.yml", *options)
    again = go_on(run, shutil.copytree(whole.directory, whole.directory.with_name("again")), f"inputs/{scene}.yml", *options)
    assert again.returncode == 0, again
    assert_same_run(whole, again)
    moved = run(f"inputs/{scene}.yml", *options, "-restart", whole.directory / "checkpoint.h5", "-load_end", 1.25)
    assert moved.returncode == 0 and [row["step"] for row in moved.history] == [5], moved
    assert [time for time, _ in moved.states()] == pytest.approx([1.25], abs=1e-4)


@pytest.mark.parametrize("step, times", [(0.05, [0.125, 0.2375]), (0.1, [0.15, 0.3]), (0.02, [0.07, 0.1])])
def test_another_load_step(run, step, times):
    """Steps go on as they were, grown by half after an easy one, or in the length that is asked for now, a longer one, too."""
    options = ("-order", 1, "-adapt_tolerance", 0, "-load_step_max", 0.2, "-output_fields", "false")
    first = run("inputs/hertz2d.yml", *options, "-load_step", 0.05, "-load_max_steps", 1, "-load_end", 0.1)
    second = run("inputs/hertz2d.yml", *options, "-load_step", step, "-load_max_steps", 3, "-restart", first.directory / "checkpoint.h5")
    assert [row["t"] for row in second.history] == pytest.approx(times)


@pytest.mark.parametrize("options", [("-order", 1), ("-order", 1, "-adapt_tolerance", 0), ("-order", 3)])
def test_another_order(run, options):
    """Cells keep the orders of the checkpoint, in fields as well: one that is lower in the scene ended the run with a signal."""
    first = run("inputs/hertz2d.yml", "-load_step", 0.5, "-load_end", 0.5, "-order", 2, "-adapt_tolerance", 0.1)
    second = run("inputs/hertz2d.yml", "-load_step", 0.5, *options, "-restart", first.directory / "checkpoint.h5")
    assert second.returncode == 0 and len(second.states()) >= 1 and not second.stderr, second


# ---- kills ----------------------------------------------------------------------------------------------------------------------------

LONG = ("inputs/hertz2d.yml", ("-load_step", 0.1, "-order", 1, "-adapt_tolerance", 0.2))


def start(scene, options, directory, ranks=1):
    command = [str(PROGRAM), str(ROOT / scene), "-output_directory", str(directory), *map(str, options)]
    if ranks > 1:
        command = ["mpiexec", "-n", str(ranks)] + command
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT, start_new_session=True)


def rows(directory):
    """Whole rows of history.csv."""
    path = pathlib.Path(directory) / "history.csv"
    return max(path.read_text().count("\n") - 1, 0) if path.exists() else 0


def kill_and_go_on(run, whole, directory, seconds):
    process = start(*LONG, directory)
    try:
        process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    done = rows(directory)
    second = go_on(run, directory, LONG[0], *LONG[1])
    assert second.returncode == 0, second
    # a row is there a moment before its checkpoint: that step is still in progress
    resumed = next((int(line.split()[5].rstrip(",")) for line in second.stdout.splitlines() if line.startswith("goes on after")), 0)
    assert done - 1 <= resumed <= done, (done, resumed)
    leftovers = set(os.listdir(directory)) - set(os.listdir(whole.directory))
    for name in leftovers:  # of a file that was being written
        assert name.endswith(".tmp")
        (pathlib.Path(directory) / name).unlink()
    assert_same_run(whole, second)
    return resumed


@pytest.mark.parametrize("kills", [3, pytest.param(20, marks=pytest.mark.slow)])
def test_o102_kills(run, tmp_path, kills):
    begin = time.time()
    whole = run(LONG[0], *LONG[1])
    seconds = time.time() - begin
    moments = random.Random(kills)
    resumed = [kill_and_go_on(run, whole, tmp_path / f"kill{k}", seconds * (k + moments.random()) / kills) for k in range(kills)]
    print("went on after steps", resumed)
    assert max(resumed) > 0


# ---- requests to stop -------------------------------------------------------------------------------------------------------------------

UNASKED = (LONG[0], (*LONG[1], "-output_checkpoint", 0))


def assert_stopped(result, reason):
    assert result.summary["status"] == "stopped" and result.summary["reason"].startswith(reason), result.summary
    assert result.summary["load_steps"] == rows(result.directory) and (result.directory / "checkpoint.h5").exists()
    for grid in ("bulk", "contact"):
        for _, fields in result.states(grid):
            assert all(np.isfinite(value).all() for value in fields.values())


@pytest.mark.parametrize("number,ranks", [(signal.SIGTERM, 1), pytest.param(signal.SIGUSR1, 2, marks=pytest.mark.slow), pytest.param(signal.SIGINT, 1, marks=pytest.mark.slow)])
def test_signal_stops(run, tmp_path, number, ranks):
    process = start(*UNASKED, tmp_path / "stop", ranks)
    while rows(tmp_path / "stop") < 2 and process.poll() is None:
        time.sleep(0.01)
    os.kill(process.pid, number)  # of several ranks: mpiexec hands SIGUSR1 on
    output, _ = process.communicate(timeout=300)
    assert process.returncode == 3, output
    assert_stopped(Result([], 3, output, "", tmp_path / "stop"), number.name)
    second = go_on(run, tmp_path / "stop", UNASKED[0], *UNASKED[1])
    assert second.returncode == 0, second
    whole = run(UNASKED[0], *UNASKED[1])
    (second.directory / "checkpoint.h5").unlink()
    assert_same_run(whole, second)


def test_time_limit_stops(run):
    """Each part takes up to the limit; the parts together are the whole run. A limit that is over at once leaves the state at rest."""
    whole = run(UNASKED[0], *UNASKED[1])
    part = run(UNASKED[0], *UNASKED[1], "-max_seconds", 1e-6)
    assert part.returncode == 3 and part.summary["t"] == 0 and part.summary["load_steps"] == 0, part
    assert_stopped(part, "-max_seconds")
    limit = 0.3 * whole.summary["time"]["total"]
    while part.returncode == 3:
        before, limit = part.summary["load_steps"], 2 * limit  # the machine may have become too busy for a step within the first
        part = go_on(run, part.directory, UNASKED[0], *UNASKED[1], "-max_seconds", limit)
        assert part.returncode == 0 or part.summary["load_steps"] >= before, part
    assert part.returncode == 0, part
    (part.directory / "checkpoint.h5").unlink()
    assert_same_run(whole, part)


# ---- what is refused --------------------------------------------------------------------------------------------------------------------

SMALL = ("inputs/hertz2d.yml", ("-order", 1, "-load_step", 0.5, "-adapt_tolerance", 0))


@pytest.fixture(scope="module")
def broken_off(tmp_path_factory):
    """Directory of a run that ended after half its load."""
    directory = tmp_path_factory.mktemp("broken") / "out"
    process = start(*SMALL, directory)
    process.communicate()
    process = start(SMALL[0], (*SMALL[1], "-load_max_steps", 1), directory)
    process.communicate()
    assert process.returncode == 2
    return directory


def contents(directory):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in pathlib.Path(directory).iterdir()}


def assert_refused(run, directory, restart, *options, words):
    before = contents(directory)
    result = go_on(run, directory, SMALL[0], *SMALL[1], *options, restart=restart)
    assert result.returncode == 1, result
    lines = result.stderr.strip().splitlines()
    assert len(lines) == 1 and lines[0].startswith("mortise: ") and words in lines[0], result
    assert contents(directory) == before


@pytest.mark.parametrize("options,words", [
    (("-material_rubber_E", 2), "'body.disc: E 1', the scene has 'body.disc: E 2'"),
    (("-material_rubber_formulation", "mixed"), "displacement"),
    (("-contact_disc_on_block_order", 1), "order full"),
    (("-contact_disc_on_block_nonmortar", "block_top", "-contact_disc_on_block_mortar", "disc_surface"), "nonmortar"),
    (("-material_rubber_volumetric", "log"), "volumetric quadratic"),
    (("-mesh_order", 2), "another mesh"),
    (("-boundary_top_displacement_y", "-0.06"), "other displacements"),
    (("-boundary_bottom_fix", "x"), "'boundary.bottom: xy', the scene has 'boundary.bottom: x'"),
    (("-load_end", 0.4, "-load_step", 0.1), "beyond load.end"),
    (("-probe_p_y", 0.5), "other columns"),
])
def test_other_scene_is_refused(run, broken_off, options, words):
    assert_refused(run, broken_off, "auto", *options, words=words)
    assert_refused(run, broken_off, "auto", *options, "-check", words=words)


@pytest.mark.parametrize("boundary,words", [
    ({"y0": {"fix": "xy"}, "x0": {"fix": "x"}, "y1": {"displacement": {"y": -0.05}}}, None),  # in another order, and put otherwise
    ({"x0": {"displacement": {"x": 0}}, "y0": {"displacement": {"x": 0, "y": 0}}, "y1": {"displacement": {"y": -0.05}}}, None),
    ({"x0": {"fix": "x"}, "y0": {"fix": "xy"}}, "'boundary.y1: y', the scene has 'boundary.y1: free'"),
    ({"y0": {"fix": "xy"}, "y1": {"displacement": {"y": -0.05}}}, "'boundary.x0: x', the scene has 'boundary.x0: free'"),
    ({"x0": {"fix": "x"}, "x1": {"fix": "x"}, "y0": {"fix": "xy"}, "y1": {"displacement": {"y": -0.05}}}, "'boundary.x1: free', the scene has 'boundary.x1: x'"),
    ({"x0": {"fix": "normal"}, "y0": {"fix": "xy"}, "y1": {"displacement": {"y": -0.05}}}, "'boundary.x0: x', the scene has 'boundary.x0: normal'"),
])
def test_supports_of_another_scene(run, tmp_path, boundary, words):
    """Told even where the state has none of the files that go on with it."""
    first = run("s.yml", "-load_max_steps", 1, text=block(tmp_path, boundary={"x0": {"fix": "x"}, "y0": {"fix": "xy"}, "y1": {"displacement": {"y": -0.05}}}))
    assert first.returncode == 2, first
    result = run("s.yml", "-restart", first.directory / "checkpoint.h5", text=block(tmp_path, boundary=boundary))
    if words:
        assert result.returncode == 1 and words in result.stderr and len(result.stderr.splitlines()) == 1 and not result.directory.exists(), result
    else:
        assert result.returncode == 0, result


def test_file_is_refused(run, broken_off, tmp_path):
    whole = (broken_off / "checkpoint.h5").read_bytes()
    choose, hurt = random.Random(1), tmp_path / "hurt.h5"
    for _ in range(4):
        hurt.write_bytes(whole[:choose.randrange(1, len(whole))])
        assert_refused(run, broken_off, hurt, words="cut short")
        at = choose.randrange(len(whole))
        hurt.write_bytes(whole[:at] + bytes([whole[at] ^ 1 << choose.randrange(8)]) + whole[at + 1:])
        assert_refused(run, broken_off, hurt, words="checkpoint")
    hurt.write_bytes(b"")
    assert_refused(run, broken_off, hurt, words="no checkpoint")
    hurt.write_bytes(whole.replace(b"format 1\n", b"format 9\n", 1))
    assert_refused(run, broken_off, hurt, words="format 9")
    with open(hurt, "wb") as file:
        file.write(whole)
        file.truncate(1 << 40)  # of no blocks
    assert_refused(run, broken_off, hurt, words="damaged")
    os.mkfifo(tmp_path / "pipe")
    for foreign in (broken_off / "fields_0000.h5", ROOT / SMALL[0], tmp_path / "pipe"):
        assert_refused(run, broken_off, foreign, words="no checkpoint")
    assert_refused(run, broken_off, tmp_path / "none.h5", words="No such file")


def seal(path):
    """The seal of src/output/seal.c on a file that was changed."""
    data, value = path.read_bytes(), 0xcbf29ce484222325
    for byte in data[512:]:
        value = (value ^ byte) * 0x100000001b3 & (1 << 64) - 1
    path.write_bytes(f"mortise checkpoint, format 1\n{len(data)} bytes\nchecksum {value:016x}\n".encode().ljust(512, b"\0") + data[512:])


def resized(path, name, change):
    with h5py.File(path, "r+") as file:
        values = file[name][...]
        del file[name]
        file[name] = change(values)


@pytest.mark.parametrize("name,words", [("owner", "no owner"), ("fields", "no fields"), ("@revision", "no revision"), ("numbers@speed", "no number speed"), ("numbers@t", "no number t"),
                                        ("fields/scalars", "no field scalars"), ("fields/pattern.disc_on_block", "no field pattern.disc_on_block"),
                                        ("fields/displacement", "no field displacement")])
def test_other_version_is_refused(run, broken_off, tmp_path, name, words):
    """Whole files that lack what this version reads."""
    old = tmp_path / "old.h5"
    shutil.copy(broken_off / "checkpoint.h5", old)
    seal(old)
    assert old.read_bytes() == (broken_off / "checkpoint.h5").read_bytes()
    with h5py.File(old, "r+") as file:
        place, _, attribute = name.partition("@")
        if attribute:
            del file[place or "/"].attrs[attribute]
        else:
            del file[place]
    seal(old)
    assert_refused(run, broken_off, old, words=words)


@pytest.mark.parametrize("name", ["displacement", "multiplier.disc_on_block", "pattern.disc_on_block", "history"])
@pytest.mark.parametrize("change", [lambda values: values[:-1] if len(values) else np.ones(3), lambda values: np.append(values, 1.0), lambda values: values[:5]],
                         ids=["less", "more", "few"])
def test_other_size_is_refused(run, broken_off, tmp_path, name, change):
    old = tmp_path / "old.h5"
    shutil.copy(broken_off / "checkpoint.h5", old)
    resized(old, "fields/" + name, change)
    seal(old)
    with h5py.File(old) as file, h5py.File(broken_off / "checkpoint.h5") as whole:
        if len(file["fields"][name]) == len(whole["fields"][name]):
            pytest.skip("nothing to leave out")
    assert_refused(run, broken_off, old, words="another version of mortise")


def test_tables_of_another_run_are_refused(run, broken_off, tmp_path):
    """Nothing is mixed: the checkpoint of one run, tables or fields of another."""
    other = shutil.copytree(broken_off, tmp_path / "other")
    text = (other / "history.csv").read_text()
    (other / "history.csv").write_text(text.replace("\n1,0.5,", "\n1,0.4,"))
    assert_refused(run, other, broken_off / "checkpoint.h5", words="no row of step 1")
    (other / "history.csv").write_text(text)
    (other / "fields.xdmf").write_text((other / "fields.xdmf").read_text().replace("fields_0000", "fields_0003"))
    assert_refused(run, other, broken_off / "checkpoint.h5", words="fields.xdmf")


@pytest.mark.parametrize("option,words", [(("-max_seconds", 0), "-max_seconds is '0'; allowed: a number above 0"), (("-max_seconds", "soon"), "-max_seconds is 'soon'"),
                                          (("-output_checkpoint", -1), "output.checkpoint is -1"), (("-restart",), "-restart needs a file, or auto")])
def test_options(run, option, words):
    result = run(SMALL[0], *SMALL[1], *option)
    assert result.returncode == 1 and words in result.stderr and not result.directory.exists(), result


def test_checkpoint_often_as_asked(run):
    scene, options = SMALL
    for every, there in ((0, False), (1, True), (7, True)):  # 7: at the end
        result = run(scene, *options, "-output_checkpoint", every)
        assert result.returncode == 0 and (result.directory / "checkpoint.h5").exists() == there, result
    fresh = go_on(run, result.directory.with_name("none"), scene, *options, "-output_checkpoint", 0)  # auto without a file: from the start
    assert fresh.returncode == 0 and len(fresh.history) == 2, fresh
    again = run(scene, *options, "-output_directory", result.directory, "-output_checkpoint", 0)  # a fresh run leaves nothing of the one before
    assert again.returncode == 0 and not (result.directory / "checkpoint.h5").exists(), again


# ---- the batch job ------------------------------------------------------------------------------------------------------------------------

@pytest.mark.slow
def test_batch_job_goes_on_until_done(run, tmp_path):
    """scripts/hpc/slurm.sh between commands of Slurm that do what it needs of them: srun runs the program, scontrol takes a note to queue the job again."""
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "srun").write_text('#!/bin/bash\nshift\nexec "$@" >/dev/null\n')
    (tools / "scontrol").write_text(f'#!/bin/bash\necho "$@" >>{tmp_path}/queued\n')
    for tool in tools.iterdir():
        tool.chmod(0o755)
    whole = run(UNASKED[0], *UNASKED[1])
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "MORTISE": str(PROGRAM), "SLURM_SUBMIT_DIR": str(ROOT), "SLURM_JOB_ID": "17"}
    command = ["scripts/hpc/slurm.sh", UNASKED[0], *map(str, UNASKED[1]), "-output_directory", str(tmp_path / "out"), "-max_seconds"]

    def jobs_of(limit):
        shutil.rmtree(tmp_path / "out", True)
        jobs = 0
        while jobs == 0 or (tmp_path / "queued").exists():
            (tmp_path / "queued").unlink(missing_ok=True)
            job = subprocess.run([*command, str(limit * 1.2**jobs)], cwd=ROOT, env={**environment, "SLURM_RESTART_COUNT": str(jobs)}, capture_output=True, text=True)
            assert job.returncode == 0, job
            jobs += 1
        return jobs

    limit = whole.summary["time"]["total"]
    for _ in range(10):  # the machine may have been busier while it ran as a whole; and later, so that limits grow
        limit *= 0.7
        if jobs_of(limit) > 1: break
    else: pytest.fail("no job stopped at its limit")
    (tmp_path / "out" / "checkpoint.h5").unlink()
    assert_same_run(whole, Result(command, 0, "", "", tmp_path / "out"))
    last = subprocess.run([*command, "1"], cwd=ROOT, env={**environment, "SLURM_RESTART_COUNT": "1", "MORTISE_JOBS": "1", "MORTISE": "false"}, capture_output=True, text=True)
    assert last.returncode == 1 and not (tmp_path / "queued").exists()


@on_two("name,at,value", [("fields/displacement", 0, math.nan), ("fields/displacement", -1, math.inf), ("split", 0, 3), ("owner", 0, 7), ("fields/pattern.disc_on_block", -1, 1e6)],
        also=[1])  # what the last process alone reads
def test_forged_contents_are_refused(run, broken_off, tmp_path, name, at, value, ranks):
    """Of a size and a seal as they should be: every rank ends, with one sentence."""
    forged = tmp_path / "forged.h5"
    shutil.copy(broken_off / "checkpoint.h5", forged)
    with h5py.File(forged, "r+") as file:
        file[name][at] = value
    seal(forged)
    result = go_on(run, broken_off, SMALL[0], *SMALL[1], "-check", restart=forged, ranks=ranks)
    assert result.returncode == 1 and len([line for line in result.stderr.splitlines() if line.startswith("mortise: -restart")]) == 1, result


@pytest.mark.parametrize("lose,words", [(("fields_0001.h5",), "fields_0001.h5 of the steps"), (("fields_0000.h5", "fields_0001.h5", "history.csv"), "fields_0000.h5 and others"),
                                        (("history.csv",), "history.csv of the steps"), ((), None)])
def test_results_that_are_gone_are_told(run, tmp_path, lose, words):
    text, out = block(tmp_path), ("-output_directory", tmp_path / "out", "-load_step", 0.25)
    assert run("s.yml", *out, "-load_end", 0.5, text=text).returncode == 0
    for name in lose:
        path = tmp_path / "out" / name
        data = path.read_bytes()
        path.write_bytes(data[:1000]) if name.endswith("1.h5") else path.unlink()
    result = run("s.yml", *out, "-restart", "auto", text=text)
    warned = [line for line in result.stdout.splitlines() if line.startswith("warning: -restart")]
    assert result.returncode == 0 and (len(warned) == 1 and words in warned[0] if words else not warned), result


def test_flow_error_where_nothing_was_left_to_do(run):
    """It is relative to the energy of the accepted state, which a run that goes on from the end has not computed."""
    result = run("tests/gauntlet/forge.yml", "-output_fields", "false")
    again = run("tests/gauntlet/forge.yml", "-output_fields", "false", "-restart", result.directory / "checkpoint.h5")
    assert again.returncode == 0 and again.summary["flow_error"] == result.summary["flow_error"] > 0, again
