"""Damaged scenes, options, meshes, geometries and checkpoints end in exit status 0 to 3, in one sentence: never in a signal or a trace, in bounded time and memory.
tests/fuzz/run.py makes the cases and tries any number of them; MORTISE_FUZZ sets how many here (default 60); tests/unit/test_scene_parse.c tries 20 000 on the parser alone."""
import os
import pathlib
import sys

import pytest

from conftest import PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "tests" / "fuzz"))
import kills  # noqa: E402
import run as fuzz  # noqa: E402
import starts  # noqa: E402

CASES = int(os.environ.get("MORTISE_FUZZ", "60")) // len(fuzz.KINDS)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    return fuzz.Whole(PROGRAM, tmp_path_factory.mktemp("whole"))


@pytest.mark.parametrize("kind", fuzz.KINDS)
def test_damaged_input(whole, tmp_path_factory, kind):
    keep = pathlib.Path(tmp_path_factory.getbasetemp()) / "kept"
    faults = [line for line in (fuzz.case(kind, number, whole, keep) for number in range(CASES)) if line]
    assert not faults, f"{faults}; kept in {keep}"


def test_copied_starts_say_the_same(whole, tmp_path):
    """The program copied before its main (tests/tools/server.c) ends and speaks as one that is started anew."""
    copied, said = fuzz.Whole(PROGRAM, tmp_path, plain=False), []
    for k in range(12):
        for each in whole, copied:
            folder = tmp_path / f"{k}{each is copied}"
            folder.mkdir()
            arguments = fuzz.make(fuzz.KINDS[k % 4], k, whole, folder)
            status, kilobytes = each.start().wait(each.start().start(arguments, folder, fuzz.MEGABYTES << 20))
            said.append([status, kilobytes > 0, (folder / "stdout").read_text(), (folder / "stderr").read_text()])
    copied.close()
    assert said[::2] == said[1::2], said


# Found by it, and seals that hold.
@pytest.mark.parametrize("kind,number", [("sealed", number) for number in (4, 16, 30, 50, 105)] + [("options", 6006), ("options", 6050445), ("options", 20001708), ("options", 20002783), ("checkpoint", 20006427), ("msh", 6030), ("msh", 7000092), ("msh", 7000117), ("geo", 101822), ("msh", 22000001)])
def test_found_before(whole, kind, number):
    assert not fuzz.case(kind, number, whole)


def test_starts_at_the_same_time():
    """tests/fuzz/starts.py by itself: 2000 starts in four loops."""
    assert not starts.faults(PROGRAM, 24, 4)


@pytest.mark.slow
def test_kills_on_several_processes():
    """tests/fuzz/kills.py by itself: 40 kills."""
    assert not kills.faults(PROGRAM, 6, 3)
