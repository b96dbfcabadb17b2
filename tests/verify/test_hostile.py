"""Scenes as somebody who means no good would write them: one sentence, the exit status of the contract, and no half of a file under a name that promises a whole one."""
import contextlib
import json
import os
import pathlib
import re
import resource
import subprocess

import pytest

from boxmesh import linspace, write
from combinations import on_two
from conftest import PROGRAM, ROOT
from test_orderly import refused

MATERIAL = {"law": "neo_hookean", "E": 1, "nu": 0.3}


def block(path, **keys):
    write(path / "block.msh", [linspace(0, 1, 2)] * 2)
    return json.dumps({"mesh": {"file": "block.msh"}, "model": "plane_strain", "body": {"body": {"material": "m"}}, "material": {"m": MATERIAL}, "load": {"step": 0.5},
                       "boundary": {"y0": {"fix": "xy"}, "y1": {"displacement": {"y": -0.05}}}} | keys)


def blocks(path, **contact):
    """Two blocks a little apart."""
    def up(x, y):
        return x, y + 1.001

    write(path / "blocks.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (x, y), up], side=lambda name, centre, b: f"{name}_{'lu'[b]}", body=lambda centre, b: "lu"[b])
    return block(path, mesh={"file": "blocks.msh"}, body={"l": {"material": "m"}, "u": {"material": "m"}}, contact=contact,
                 boundary={"y0_l": {"fix": "xy"}, "y1_u": {"displacement": {"x": 0, "y": -0.05}}})


def gave_up(result, *words):
    """Exit status 2, everything up to the last accepted step is there, and why."""
    assert result.returncode == 2 and result.summary["status"] == "failed" and "ERROR" not in result.stderr, result
    assert len(result.history) == result.summary["load_steps"], result
    for word in words:
        assert word in result.summary["reason"], result.summary


def pulled(value, key="displacement"):
    return {"boundary": {"y0": {"fix": "xy"}, "y1": {key: {"y": value} if key == "displacement" else value}}}


@on_two("value", ["0/0*t", "sqrt(-X)", "log(Y-2)", "1e308*10*t"], also=[1])  # everywhere but at X = 0
def test_not_finite_at_the_start(run, tmp_path, value, ranks):
    refused(run("s.yml", text=block(tmp_path, **pulled(value)), ranks=ranks), "boundary.y1.displacement.y", "not finite at X")


@on_two("value,key", [("t<0.6?-0.01*t:sqrt(-X-1)", "displacement"), ("t<0.6?0:sqrt(-X-1)", "pressure")], also=[1])
def test_not_finite_later(run, tmp_path, value, key, ranks):
    """The step is cut, and given up where the last good time is."""
    result = run("s.yml", "-load_step", 0.25, text=block(tmp_path, **pulled(value, key)), ranks=ranks)
    gave_up(result, f"boundary.y1.{key}", "not finite at X")
    assert 0.5 <= result.summary["t"] < 0.6


@pytest.mark.parametrize("moves", ["boundary", "rigid"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_not_finite_where_recoveries_are(run, tmp_path, moves, ranks):
    """No recovery puts in a motion that is no number (a descent took it for nothing left to put in)."""
    way = "-0.05*t*(t > 0.9 ? 0/0 : 1)"
    support = {"y1_u": {"displacement": {"x": 0, "y": way}}} if moves == "boundary" else {}
    upper = {"material": "m"} if moves == "boundary" else {"material": "tool", "motion": {"y": way}}
    scene = json.loads(blocks(tmp_path, touch={"nonmortar": "y1_l", "mortar": "y0_u"}))
    text = json.dumps(scene | {"body": {"l": {"material": "m"}, "u": upper}, "material": {"m": MATERIAL} | ({} if support else {"tool": {"law": "rigid"}}),
                               "boundary": {"y0_l": {"fix": "xy"}, **support}})
    result = run("s.yml", "-load_step", 0.25, text=text, ranks=ranks)
    gave_up(result, "not finite at", "t = ")
    assert 0.75 <= result.summary["t"] <= 0.9


@pytest.mark.parametrize("E", [1e200, 1e308])
def test_beyond_numbers(run, tmp_path, E):
    gave_up(run("s.yml", text=block(tmp_path, material={"m": MATERIAL | {"E": E}})))


@pytest.mark.parametrize("unit", [1e160, 1e-170])
def test_forces_whose_squares_are_no_numbers(run, tmp_path, unit):
    """Zero displacements were taken for the solution: the norm of the residual and what it is judged by were both infinite, or both zero."""
    loads = {"y0": {"fix": "xy"}, "y1": {"traction": {"y": -0.1 * unit}}}
    gave_up(run("s.yml", text=block(tmp_path, material={"m": MATERIAL | {"E": unit}}, boundary=loads)), "squares")


def test_loads_of_zero(run, tmp_path):
    """No forces at all are in balance."""
    result = run("s.yml", text=block(tmp_path, material={"m": MATERIAL | {"E": 1e-170}}, boundary={"y0": {"fix": "xy"}, "y1": {"traction": {"y": 0}}}))
    assert result.returncode == 0 and result.summary["status"] == "converged", result


@pytest.mark.parametrize("turned", [False, True])
def test_the_same_pair_twice(run, tmp_path, turned):
    sides = ["y0_u", "y1_l"]
    one, two = ({"nonmortar": a, "mortar": b} for a, b in (sides, sides[::-1] if turned else sides))
    refused(run("s.yml", text=blocks(tmp_path, one=one, two=two)), "contact.two", "the sides of pair 'one' already", "other way round" if turned else "")


@pytest.mark.parametrize("one,two,good", [
    (("low_l", "y1_l"), ("low", "y1_l"), False),  # parts of both, under other names
    (("low_l", "y1_l"), ("y1_l", "low"), False),  # the other way round
    (("low_l", "y1_l"), ("low_r", "y1_l"), True),  # two halves of one side
    (("low", "y1_l"), ("low_l", "x0_l"), True),  # one side against two
])
def test_pairs_that_share_facets(run, tmp_path, one, two, good):
    """The lower side of the upper block is one group and, by halves, two more."""
    def up(x, y):
        return x, y + 1.001

    text = blocks(tmp_path, one=dict(zip(("nonmortar", "mortar"), one)), two=dict(zip(("nonmortar", "mortar"), two)))
    write(tmp_path / "blocks.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (x, y), up], body=lambda centre, b: "lu"[b],
          side=lambda name, centre, b: [f"{name}_{'lu'[b]}"] if (name, b) != ("y0", 1) else ["low", "low_l" if centre[0] < 0.5 else "low_r"])
    result = run("s.yml", text=text)
    if good:
        alone = run("s.yml", text=json.dumps(json.loads(text) | {"contact": {"whole": {"nonmortar": "low", "mortar": "y1_l"}}}))
        assert result.summary["reaction"]["y1_u"] == pytest.approx(alone.summary["reaction"]["y1_u"], abs=1e-9) and result.summary["reaction"]["y1_u"][1] < -0.02, result
    else:
        refused(result, "contact.two", "facets in common", "pair 'one'")


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("overlap", [0.3, 0.8, 0.9])
def test_deep_overlaps_are_pressed_apart(run, tmp_path, dim, swap, overlap):
    """Overlaps in the mesh of up to what half of both bodies measures."""
    sides = ["y0_u", "y1_l"][::-1 if swap else 1]
    text = json.loads(blocks(tmp_path, pair=dict(zip(("nonmortar", "mortar"), sides))))
    text["boundary"] |= {"y1_u": {"fix": "y"}, "x0_l": {"fix": "x"}, "x0_u": {"fix": "x"}, "y0_l": {"fix": "y"}}
    if dim == 3:
        text["boundary"] |= {name: {"fix": "z"} for name in ("z0_l", "z0_u", "z1_l", "z1_u")}
        text["model"] = "3d"
    write(tmp_path / "blocks.msh", [linspace(0, 1, 2)] * 2 + [linspace(0, 1, 1)] * (dim - 2), [lambda *x: x, lambda x, y, *z: (x + 1e-6, y + 1 - overlap, *z)],
          side=lambda name, centre, b: f"{name}_{'lu'[b]}", body=lambda centre, b: "lu"[b])
    result = run("s.yml", text=json.dumps(text))
    assert result.returncode == 0 and result.summary["contact"]["pair"]["active_nodes"] > 0, result


def test_a_pair_of_a_surface_and_its_part(run, tmp_path):
    text = blocks(tmp_path, pair={"nonmortar": "low", "mortar": "low_l"})
    write(tmp_path / "blocks.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (x, y), lambda x, y: (x, y + 1.001)], body=lambda centre, b: "lu"[b],
          side=lambda name, centre, b: [f"{name}_{'lu'[b]}", "low", "low_l"])
    refused(run("s.yml", text=text), "'low' and 'low_l' share cell 0 at (0.25, 0.25, 0), and have facets in common")


@pytest.mark.parametrize("load,words", [({"step": 1e-300}, ["load.step is 1e-300", "1e-08"]), ({"step": 0.1, "step_min": 1e-20}, ["load.step_min is 1e-20"]),
                                        ({"step": 1e-7}, ["1000000 steps", "1e-07", "load.step_max"]),
                                        ({"step": 1e-7, "step_max": 0.1}, None), ({"step": 1e-7, "stop_displacement": 1e-9}, None)])
def test_steps_without_end(run, tmp_path, load, words):
    """Refused where t could not tell them apart, or the end cannot be reached."""
    result = run("s.yml", "-check", text=block(tmp_path, load=load))
    if words:
        refused(result, *words)
    else:
        assert result.returncode == 0, result


def test_too_fine_a_mesh(run, tmp_path):
    """Before memory is asked for."""
    refused(run("s.yml", "-mesh_refine", 12, text=block(tmp_path)), "mesh.refine is 12", "67108864 cells")


# ---- supports that meet -----------------------------------------------------------------------------------------------------------------


def held(**boundary):
    return {"boundary": {"y0": {"fix": "xy"}} | boundary}


@pytest.mark.parametrize("keys,words", [
    (held(x0={"displacement": {"x": 0.1}}), ["boundary.y0 and boundary.x0", "(0, 0, 0)", "in x: 0 and 0.05 at t = 0.5"]),
    (held(x1={"displacement": {"y": "t < 0.6 ? 0 : 0.02"}}), ["boundary.y0 and boundary.x1", "(1, 0, 0)", "in y: 0 and 0.02 at t = 1"]),
    (held(x1={"displacement": {"y": 0.02}, "amplitude": [0, 0, 0.3, 1, 0.4, 0]}), ["in y: 0 and 0.02 at t = 0.3"]),
    (held(y1={"rotation": {"angle": 90, "point": {"x": 0, "y": 1}}}, x1={"fix": "y"}), ["boundary.y1 and boundary.x1", "(1, 1, 0)", "in y: 0.707107 and 0 at t = 0.5"]),
    (held(y1={"rotation": {"angle": 90, "point": {"x": 0, "y": 1}}}, x0={"fix": "y"}), None),  # about the corner they share
    (held(x0={"displacement": {"x": "1e-14*t"}}), None),  # round-off
    (held(x1={"displacement": {"y": "t < 0.6 ? 0 : sqrt(X-2)"}}), None),  # not finite: told when the run comes there
    (held(x0={"fix": "normal"}, y1={"displacement": {"x": 0.1}}), ["boundary.x0 and boundary.y1", "(0, 1, 0)"]),
])
def test_supports_that_contradict(run, tmp_path, keys, words):
    """Two that hold a point of the mesh must move it alike, at any time of the run."""
    result = run("s.yml", "-check", text=block(tmp_path, **keys))
    if words:
        refused(result, *words)
    else:
        assert result.returncode == 0, result


def test_supports_that_contradict_on_two_processes(run, tmp_path):
    """The process that has the point tells the others; without -check too."""
    refused(run("s.yml", text=block(tmp_path, **held(x1={"displacement": {"x": 0.1}})), ranks=2), "boundary.y0 and boundary.x1", "(1, 0, 0)")


def test_check_says_what_moves(run, tmp_path):
    die = {"body": {"body": {"material": "steel", "motion": {"y": "-0.1*t"}}}, "material": {"steel": {"law": "rigid"}}, "boundary": {}}
    said = run("s.yml", "-check", text=block(tmp_path, **die)).stdout
    assert "body body: order 1, material steel (rigid) motion_y = -0.1*t\n" in said and "  0 unknowns at t = 0\n" in said, said


@pytest.mark.parametrize("boundary,words", [
    ({"y0": {"fix": "normal"}, "y1": {"traction": {"x": 0.01}}}, "no support holds body body along x:"),
    ({"y0": {"fix": "normal"}, "x0": {"fix": "normal"}}, ""),
    ({"x0": {"fix": "yz"}, "y0": {"fix": "x"}, "x1": {"traction": {"y": 0.01}}}, "the supports of body body let it turn:"),
    ({"x0": {"fix": "yz"}, "x1": {"traction": {"z": 0.01}}}, "no support holds body body along x:"),
])
def test_what_no_support_holds(run, tmp_path, boundary, words):
    """It is told before the first step, and a body that loads carry away ends no run well: far from where it was, any force is small against the noise."""
    text = block(tmp_path, boundary=boundary, **({"model": "3d"} if "z" in str(boundary) else {}))
    if "z" in str(boundary):
        write(tmp_path / "block.msh", [linspace(0, 1, 2)] * 3)
    result = run("s.yml", text=text)
    assert ("takes contact" in result.stdout) == bool(words) and words in run("s.yml", "-check", text=text).stdout, result
    if words:
        gave_up(result)
    else:
        assert result.returncode == 0, result


@pytest.mark.parametrize("load", [{"traction": {"y": -0.01}}, {"pressure": 0.01}])
def test_loads_between_cells(run, tmp_path, load):
    """On the line where two bodies hang together: a traction would act on the cells of both."""
    text = block(tmp_path, body={"l": {"material": "m"}, "u": {"material": "m"}}, boundary={"y0": {"fix": "xy"}, "joint": load})
    write(tmp_path / "block.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (x, y), lambda x, y: (x, 1 + y)], body=lambda centre, b: "lu"[b],
          side=lambda name, centre, b: {("y1", 0): "joint", ("y0", 1): None}.get((name, b), name))
    refused(run("s.yml", "-check", text=text), "boundary.joint", "between two cells")


def test_a_rigid_body_and_its_support(run, tmp_path):
    die = {"body": {"body": {"material": "steel", "motion": {"y": -0.1}}}, "material": {"steel": {"law": "rigid"}}}
    refused(run("s.yml", "-check", text=block(tmp_path, **die, **held())), "body.body.motion and boundary.y0", "in y: -0.05 and 0")


@pytest.mark.parametrize("first", ["floor", "side"])
def test_supports_at_an_angle(run, tmp_path, first):
    """A floor that rises at 45 degrees, along which a side is pushed by 0.1 in x: the block moves by (0.1, 0.1) as a whole, the corner that both hold too. And with its
    weight on the floor and at the side: each bears along its normal alone, also at that corner, whichever comes first in the scene."""
    def supports(side):
        return dict([("y0", {"fix": "normal"}), ("x0", side)][::1 if first == "floor" else -1])

    text = block(tmp_path, boundary=supports({"displacement": {"x": 0.1}}), probe={"corner": {"x": 0, "y": 0}})
    write(tmp_path / "block.msh", [linspace(0, 1, 2)] * 2, lambda x, y: (x, y + x))
    result = run("s.yml", text=text)
    assert result.returncode == 0, result
    assert result.summary["probe"]["corner"]["displacement"] == pytest.approx([0.1, 0.1], abs=1e-9) and result.summary["energy"] < 1e-15, result
    reaction = run("s.yml", text=json.dumps(json.loads(text) | {"boundary": supports({"fix": "x"}), "body": {"body": {"material": "m", "force": {"y": -0.01}}}})).summary["reaction"]
    assert reaction["y0"] == pytest.approx([-0.01, 0.01], rel=1e-9) and reaction["x0"] == pytest.approx([0.01, 0], abs=1e-11), reaction


def test_more_bodies_than_a_byte_counts(run, tmp_path):
    """The last of 144 is rigid, and told as what holds its corner."""
    text = block(tmp_path, body={f"b{i}": {"material": "steel" if i == 143 else "m"} for i in range(144)}, material={"m": MATERIAL, "steel": {"law": "rigid"}},
                 boundary={"y0": {"fix": "xy"}})
    write(tmp_path / "block.msh", [linspace(0, 1, 12)] * 2, body=lambda centre, b: f"b{int(12 * centre[0]) * 12 + int(12 * centre[1])}")
    result = run("s.yml", "-body_b143_motion_y", -0.01, text=text)
    assert result.returncode == 0 and result.summary["body"]["b143"]["force"][1] == pytest.approx(result.summary["reaction"]["y0"][1], rel=1e-9), result


def test_names_that_files_cannot_bear(run, tmp_path):
    refused(run("s.yml", text=blocks(tmp_path, **{"../p": {"nonmortar": "y0_u", "mortar": "y1_l"}})), "contact.../p", "no '/'")
    refused(run("s.yml", text=block(tmp_path, probe={"a,b": {"x": 0.5, "y": 0.5}})), "comma")


@pytest.mark.parametrize("name", ["history.csv", "fields.xdmf", "fields_0000.h5", "summary.json", "checkpoint.h5"])
def test_a_directory_in_the_way(run, tmp_path, name):
    (tmp_path / "out1" / name).mkdir(parents=True)
    result = run("s.yml", text=block(tmp_path))
    assert result.returncode == 1 and len(result.stderr.splitlines()) == 1 and f"{name} in it is no file of a run" in result.stderr, result
    result = run("s.yml", "-output_directory", tmp_path / "out1", "-output_overwrite", "true", text=block(tmp_path))
    assert result.returncode == 1 and len(result.stderr.splitlines()) == 1 and f"{name} in it is a directory" in result.stderr, result
    assert os.listdir(tmp_path / "out1") == [name] and "accepted" not in result.stdout


@contextlib.contextmanager
def limited(what, kilobytes):
    before = resource.getrlimit(what)
    resource.setrlimit(what, (1024 * kilobytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(what, before)


@pytest.mark.parametrize("megabytes,words", [(600, "for 1048576 cells (mesh.refine: 9)"), (450, "out of memory"), (350, "(ulimit -v, ulimit -d)"), (200, "(ulimit -v, ulimit -d)")])
def test_out_of_memory(run, tmp_path, megabytes, words):
    """One sentence that says for what."""
    text = block(tmp_path)
    with limited(resource.RLIMIT_AS, 1024 * megabytes):
        result = run("s.yml", "-mesh_refine", 9, text=text)
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1 and result.stderr.startswith("mortise: out of memory") and words in result.stderr, result


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("megabytes", range(260, 500, 20))
def test_hardly_any_memory(tmp_path, megabytes, threads):
    """A run or one sentence. With more threads, which take their buffers when they come to it, MPI may speak; one that waits for its own keeps no run from its end."""
    (tmp_path / "s.yml").write_text(block(tmp_path))
    environ = {**{key: value for key, value in os.environ.items() if key != "OMP_NUM_THREADS"}, "OPENBLAS_NUM_THREADS": str(threads)}
    with limited(resource.RLIMIT_AS, 1024 * megabytes):
        done = subprocess.run([PROGRAM, "s.yml"], cwd=tmp_path, env=environ, capture_output=True, text=True, timeout=300)
    assert threads > 1 or (done.returncode == 0 and not done.stderr) or (done.returncode == 2 and done.stderr.startswith("mortise: out of memory") and done.stderr.count("\n") == 1), done


def test_kernels_of_a_processor_that_openblas_does_not_know(tmp_path):
    """Not those of 2004 where the processor can do more; what the user names stands."""
    (tmp_path / "s.yml").write_text(block(tmp_path))
    cores = {}
    for name in ("", "Prescott"):
        environ = {**os.environ, "OPENBLAS_VERBOSE": "2", **({"OPENBLAS_CORETYPE": name} if name else {})}
        done = subprocess.run([PROGRAM, "s.yml", "-check"], cwd=tmp_path, env=environ, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done
        cores[name] = re.findall(r"Core: (\w+)", done.stdout + done.stderr)
    if "avx2" in pathlib.Path("/proc/cpuinfo").read_text().split():
        assert cores[""][-1] != "Prescott"
    assert set(cores["Prescott"]) <= {"Prescott"}


def test_hardly_any_data(run, tmp_path):
    """ulimit -d, which leaves OpenBLAS no room by its first call: it would ask for ever."""
    text = block(tmp_path)
    with limited(resource.RLIMIT_DATA, 400000):
        result = run("s.yml", "-mesh_refine", 8, text=text, timeout=300)
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1 and result.stderr.startswith("mortise: out of memory for 262144 cells"), result
    with limited(resource.RLIMIT_DATA, 100000):
        result = run("s.yml", text=text, timeout=300)
    assert result.returncode == 2 and result.stderr == "mortise: out of memory: fewer than 240 MB are left to begin with (ulimit -v, ulimit -d)\n", result


@contextlib.contextmanager
def small_disk(path, kilobytes):
    path.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "none", path], capture_output=True).returncode: pytest.skip("no file system can be mounted here")
    try:
        yield path
    finally:
        subprocess.run(["umount", "--lazy", path])  # a process of mpiexec may still be ending


@on_two("fields,kilobytes", [(True, 64), (True, 200), (False, 8), (False, 20)], also=[0, 3])
def test_full_file_system(run, tmp_path, fields, kilobytes, ranks):
    """One sentence; no process waits for one that found no room."""
    with small_disk(tmp_path / "small", kilobytes) as small:
        result = run("s.yml", "-mesh_refine", 4, "-output_fields", str(fields).lower(), "-output_directory", small / "out1", text=block(tmp_path), ranks=ranks)
        said = [line for line in result.stderr.splitlines() if line.startswith("mortise: ")]
        assert result.returncode in (1, 2) and len(said) == 1 and "No space left on device" in said[0] and "PETSC ERROR" not in result.stderr, result


def test_processes_that_do_not_share_a_directory(tmp_path):
    (tmp_path / "s.yml").write_text(block(tmp_path))
    parts = [["-n", "1", "--wdir", tmp_path / name, PROGRAM, tmp_path / "s.yml", "-output_directory", "out"] for name in "ab"]
    for name in "ab": (tmp_path / name).mkdir()
    done = subprocess.run(["mpiexec", *parts[0], ":", *parts[1]], capture_output=True, text=True, timeout=300)
    assert done.returncode == 1 and "mortise: output.directory out: not all processes see it" in done.stderr, done


@pytest.mark.parametrize("order", [1, 2])
def test_processes_with_different_arguments(tmp_path, order):
    (tmp_path / "s.yml").write_text(block(tmp_path))
    done = subprocess.run(["mpiexec", "-n", "1", PROGRAM, "s.yml", "-order", "1", ":", "-n", "1", PROGRAM, "s.yml", "-order", str(order)], cwd=tmp_path, capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == (order != 1) and ("mortise: the processes of this job were started with different arguments" in done.stderr) == (order != 1), done


@pytest.mark.parametrize("kilobytes", [1, 4, 40])
def test_full_disk(run, tmp_path, kilobytes):
    """What was written before stays readable: no row or state without its end."""
    text = block(tmp_path, mesh={"file": "block.msh", "refine": 3})
    with limited(resource.RLIMIT_FSIZE, kilobytes):
        result = run("s.yml", text=text)
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1 and result.stderr.startswith("mortise: "), result
    assert "File too large" in result.stderr, result
    assert not (result.directory / "checkpoint.h5").exists() and len(result.states()) == len(result.history), result
    assert len(list(result.directory.glob("fields_*.h5"))) == len(result.states()), result


def test_unconnected_nodes(run, tmp_path):
    """They are left out."""
    text = block(tmp_path)
    lines = (tmp_path / "block.msh").read_text().splitlines()
    at = lines.index("$Nodes") + 1
    num = int(lines[at])
    lines[at] = str(num + 1)
    lines.insert(at + 1 + num, f"{num + 1} 5 5 0")
    (tmp_path / "block.msh").write_text("\n".join(lines) + "\n")
    result = run("s.yml", text=text)
    assert result.returncode == 0 and result.summary["cells"] == 4, result


@pytest.mark.parametrize("old,new,words", [
    ("\n1 0 0 0\n", "\n1 nan 0 0\n", ["no finite number"]),
    ("\n2 ", "\n1 ", ["two nodes have one number"]),
    ("\n1 0 0 0\n", "\n2000000000 0 0 0\n", ["one that is not there"]),
    ("\n1 0 0 0\n", "\n2000000000 7 7 0\n1 0 0 0\n", ["numbers of its nodes go up to 2000000000", "from 1 on"]),
    ('"body"', '"\033[31mbody"', ["?[31mbody", "control character"]),
    ('"body"', '"b\u009b31mody"', ["control character"]),
])
def test_meshes_of_ill_will(run, tmp_path, old, new, words):
    text = block(tmp_path)
    mesh = (tmp_path / "block.msh").read_text()
    at = mesh.index("$Nodes") if old[0] == "\n" else 0
    mesh = mesh[:at] + mesh[at:].replace(old, new, 1)
    if words[0].startswith("numbers"):
        num = mesh[at:].splitlines()[1]
        mesh = mesh.replace(f"$Nodes\n{num}\n", f"$Nodes\n{int(num) + 1}\n")
    (tmp_path / "block.msh").write_text(mesh)
    result = run("s.yml", text=text)
    refused(result, *words)
    assert "\033" not in result.stderr and "\u009b" not in result.stderr, result


def test_words_for_the_terminal(run, tmp_path):
    refused(run("s.yml", text=block(tmp_path).replace('"model"', '"title": "\\u001b[31m", "model"')), "control character in a text")


GEO = """Point(1) = {0, 0, 0}; Line(1) = {1, 1}; // SystemCall "a comment";
/* System "another"; */ Printf("SystemCall on the screen");
"""


@pytest.mark.parametrize("line,words", [
    ('SystemCall "touch here";', ["s.geo:3: SystemCall calls a program"]), ('System "touch here";', ["s.geo:3: System calls"]),
    ('Printf("%g, (", 1) >> "here";', ["s.geo:3: Printf writes a file"]), ('Include "more.geo";', ["more.geo:2: SystemCall calls a program"]),
    ("", ["no cells of dimension 2"]),
])
def test_a_geo_is_no_program(run, tmp_path, line, words):
    (tmp_path / "s.geo").write_text(GEO + line + "\n")
    (tmp_path / "more.geo").write_text("// of another file\nSystemCall StrCat('touch ', 'here');\n")
    refused(run("s.yml", text=block(tmp_path, mesh={"file": "s.geo"})), *words)


def test_a_geo_whose_last_line_is_not_ended(run, tmp_path):
    """gmsh drops it: the groups named there would be missing, and no sentence about them would help."""
    geo = (ROOT / "inputs/patch2d.geo").read_text()
    (tmp_path / "s.geo").write_text(geo.rstrip("\n"))
    refused(run("s.yml", text=block(tmp_path, mesh={"file": "s.geo"})), "mesh.file", "last line", "line break")
    (tmp_path / "s.geo").write_text(geo + "  // a remark")
    assert "line break" not in run("s.yml", text=block(tmp_path, mesh={"file": "s.geo"})).stderr


def test_a_geo_without_end(run, tmp_path):
    """gmsh is ended with the run, and its directory goes."""
    (tmp_path / "s.geo").write_text("For i In {1:2000000000}\nx = i;\nEndFor\n")
    (tmp_path / "tmp").mkdir()
    result = run("s.yml", "-max_seconds", 0.5, text=block(tmp_path, mesh={"file": "s.geo"}), timeout=300, env={"TMPDIR": str(tmp_path / "tmp")})
    assert result.returncode == 3 and "gmsh had not come to an end" in result.stderr and "(-max_seconds)" in result.stderr and not result.directory.exists(), result
    assert not list((tmp_path / "tmp").glob("mortise-*"))


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_geo_without_measure(run, tmp_path, ranks):
    """A coordinate that is no number makes gmsh ask for memory without end: it gets a quarter of the machine's, or what ulimit -d allows."""
    geo = (ROOT / "inputs/patch2d.geo").read_text()
    (tmp_path / "s.geo").write_text(geo.replace("Point(6) = {1,", "Point(6) = {1e300*1e300,"))
    assert (tmp_path / "s.geo").read_text() != geo
    text = block(tmp_path, mesh={"file": "s.geo"}, body={"lower": {"material": "m"}, "upper": {"material": "m"}})
    with limited(resource.RLIMIT_DATA, 300000):
        refused(run("s.yml", text=text, ranks=ranks), "gmsh asks for more than 292 MB of memory", "ulimit -d")


@pytest.mark.parametrize("name", ["a b ü ☃.yml"])
def test_names_of_files(run, tmp_path, name):
    assert run(name, text=block(tmp_path)).returncode == 0
