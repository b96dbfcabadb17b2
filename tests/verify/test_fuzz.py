"""Damaged scenes end in exit status 0 or 1 under -check, never in a crash. MORTISE_FUZZ sets how many are tried (default 60);
tests/unit/test_scene_parse.c tries 20 000 on the parser alone."""
import os
import random

import pytest

from conftest import ROOT

PIECES = ["{", "}", "[", "]", ": ", "\n", "  ", "\t", "&a ", "*a", "!!x ", "---\n", '"', "'", "#", "%", "|", ">", "\\", "-", ",", "nan", "1e999", "~", "\0", "é", "? ", "<<: "]
SCENES = ["hertz2d", "slide2d", "cube", "tube", "cook", "patch2d", "rubber2d"]


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
