"""Scenes as somebody who means no good would write them: one sentence, the exit status of the contract, and no half of a file under a name that promises a whole one."""
import json
import resource

import pytest

from boxmesh import linspace, write
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


@pytest.mark.parametrize("value", ["0/0*t", "sqrt(-X)", "log(Y-2)", "1e308*10*t"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_not_finite_at_the_start(run, tmp_path, value, ranks):
    refused(run("s.yml", text=block(tmp_path, **pulled(value)), ranks=ranks), "boundary.y1.displacement.y", "not finite at X")


@pytest.mark.parametrize("value,key", [("t<0.6?-0.01*t:sqrt(-X-1)", "displacement"), ("t<0.6?0:sqrt(-X-1)", "pressure")])
@pytest.mark.parametrize("ranks", [1, 2])
def test_not_finite_later(run, tmp_path, value, key, ranks):
    """The step is cut, and given up where the last good time is."""
    result = run("s.yml", "-load_step", 0.25, text=block(tmp_path, **pulled(value, key)), ranks=ranks)
    gave_up(result, f"boundary.y1.{key}", "not finite at X")
    assert 0.5 <= result.summary["t"] < 0.6


@pytest.mark.parametrize("E", [1e200, 1e308])
def test_beyond_numbers(run, tmp_path, E):
    gave_up(run("s.yml", text=block(tmp_path, material={"m": MATERIAL | {"E": E}})))


def test_the_same_pair_twice(run, tmp_path):
    sides = {"nonmortar": "y0_u", "mortar": "y1_l"}
    refused(run("s.yml", text=blocks(tmp_path, one=sides, two=sides)), "contact.two", "the sides of pair 'one' already")


def test_names_that_files_cannot_bear(run, tmp_path):
    refused(run("s.yml", text=blocks(tmp_path, **{"../p": {"nonmortar": "y0_u", "mortar": "y1_l"}})), "contact.../p", "no '/'")
    refused(run("s.yml", text=block(tmp_path, probe={"a,b": {"x": 0.5, "y": 0.5}})), "comma")


@pytest.mark.parametrize("name", ["history.csv", "fields.xdmf", "fields_0000.h5", "summary.json", "checkpoint.h5"])
def test_a_directory_in_the_way(run, tmp_path, name):
    (tmp_path / "out1" / name).mkdir(parents=True)
    result = run("s.yml", text=block(tmp_path))
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1 and result.stderr.startswith("mortise: "), result


@pytest.mark.parametrize("kilobytes", [1, 4, 40])
def test_full_disk(run, tmp_path, kilobytes):
    """What was written before stays readable: no row or state without its end."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    text = block(tmp_path, mesh={"file": "block.msh", "refine": 3})
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024 * kilobytes, before[1]))
    try:
        result = run("s.yml", text=text)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1 and result.stderr.startswith("mortise: "), result
    assert "File too large" in result.stderr, result
    assert not (result.directory / "checkpoint.h5").exists() and len(result.states()) == len(result.history), result


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


@pytest.mark.parametrize("name", ["a b ü ☃.yml"])
def test_names_of_files(run, tmp_path, name):
    assert run(name, text=block(tmp_path)).returncode == 0
