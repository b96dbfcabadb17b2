"""Damaged scenes end in exit status 0 or 1 under -check, damaged scenes and meshes that are solved in 0, 1 or 2: never in a signal, within a time limit.
MORTISE_FUZZ sets how many of each are tried (default 60); tests/unit/test_scene_parse.c tries 20 000 on the parser alone."""
import os
import random
import subprocess

import pytest

from conftest import ROOT

PIECES = ["{", "}", "[", "]", ": ", "\n", "  ", "\t", "&a ", "*a", "!!x ", "---\n", '"', "'", "#", "%", "|", ">", "\\", "-", ",", "nan", "1e999", "~", "\0", "é", "? ", "<<: "]
SCENES = ["hertz2d", "slide2d", "cube", "tube", "cook", "patch2d", "rubber2d", "blocks3d", "hertz3d"]


def damage(text, chance):
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(len(text) + 1)
        kind = chance.random()
        if kind < 0.25:
            text = text[:at] + chr(chance.randrange(256)) + text[at + 1:]
        elif kind < 0.5:
            text = text[:at] + text[at + chance.randrange(20):]
        elif kind < 0.75:
            text = text[:at] + chance.choice(PIECES) + text[at:]
        else:
            start = chance.randrange(len(text) + 1)
            text = text[:at] + text[start:start + chance.randrange(40)] + text[at:]
    return text


@pytest.mark.parametrize("part", range(4))
def test_damaged_scene(run, tmp_path, part):
    chance = random.Random(part)
    for file in (ROOT / "inputs").glob("*.geo"):
        (tmp_path / file.name).write_text(file.read_text())
    for _ in range(int(os.environ.get("MORTISE_FUZZ", "60")) // 4):
        text = damage((ROOT / "inputs" / f"{chance.choice(SCENES)}.yml").read_text(), chance)
        result = run("damaged.yml", "-check", text=text, timeout=60, env={"OMPI_MCA_ess_singleton_isolated": "1"})
        assert result.returncode in (0, 1), f"{result}\n{text}"
        assert "PETSC ERROR" not in result.stderr, f"{result}\n{text}"
        assert result.returncode == 0 or "mortise: " in result.stderr, f"{result}\n{text}"
        assert not result.directory.exists()


FORMATS = ["msh22", "msh41", "msh22b", "msh41b"]
MESHED = {"patch2d": "-2", "blocks3d": "-3"}


@pytest.fixture(scope="module")
def meshes(tmp_path_factory):
    """Contact of two blocks in the plane and in space, each in three formats, as bytes."""
    folder, found = tmp_path_factory.mktemp("meshes"), {}
    for scene, dim in MESHED.items():
        for name in FORMATS:
            file = folder / f"{scene}_{name}.msh"
            command = ["gmsh", dim, "-order", "1", "-format", name.rstrip("b"), "-o", str(file), str(ROOT / "inputs" / f"{scene}.geo")]
            subprocess.run(command + (["-bin"] if name.endswith("b") else []), check=True, capture_output=True)
            found[scene, name] = file.read_bytes()
    return found


def damage_bytes(data, chance):
    data = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        at, kind = chance.randrange(len(data)), chance.random()
        if kind < 0.4:
            data[at] = chance.choice(b"0123456789. -e$\n") if kind < 0.3 else chance.randrange(256)
        elif kind < 0.6:
            del data[at:at + chance.randint(1, 12)]
        elif kind < 0.8:
            data[at:at] = bytes(chance.choice(b"0123456789. -") for _ in range(chance.randint(1, 6)))
        else:
            start = chance.randrange(len(data))
            data[at:at] = data[start:start + chance.randrange(60)]
    return bytes(data)


@pytest.mark.parametrize("part", range(4))
def test_damaged_mesh_is_solved_or_refused(run, tmp_path, meshes, part):
    chance = random.Random(100 + part)
    scenes = {}
    for name in MESHED:
        text = (ROOT / "inputs" / f"{name}.yml").read_text().replace(f"file: {name}.geo", "file: d.msh").replace("  order: 1\n", "", 1)
        scenes[name] = "".join(line for line in text.splitlines(True) if not line.startswith("  parameter:"))
    for _ in range(int(os.environ.get("MORTISE_FUZZ", "60")) // 4):
        kind = (chance.choice(list(MESHED)), chance.choice(FORMATS))
        data, scene = damage_bytes(meshes[kind], chance), scenes[kind[0]]
        (tmp_path / "d.msh").write_bytes(data)
        text = damage(scene, chance) if chance.random() < 0.3 else scene
        result = run("damaged.yml", "-output_fields", "0", text=text, timeout=60, env={"OMPI_MCA_ess_singleton_isolated": "1"})
        where = tmp_path / "damaged.msh"
        where.write_bytes(data)
        assert result.returncode in (0, 1, 2), f"{kind} kept in {where}\n{result}\n{text}"
        assert "PETSC ERROR" not in result.stderr, f"{kind} kept in {where}\n{result}\n{text}"
