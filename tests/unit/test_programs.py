"""Runs every cmocka program of tests/unit on 1 and 2 ranks, so that one closing line counts unit tests and cases alike.

By name: test_*_serial.c on one rank only, test_*_mpi.c also on 3 ranks; tests of modules that never communicate on one rank unless they say _mpi.
A program that knows the option -slow has more, slow tests behind it. Programs are built by `make units`.
"""
import functools
import os
import pathlib
import re
import subprocess
import tempfile

import pytest

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("MORTISE_BUILD", HERE.parent.parent / "build"))
PROGRAM = os.environ.get("MORTISE", str(HERE.parent.parent / "bin" / "mortise"))
POINTWISE = ("base", "contact", "element", "material")
# As src/app/start.c: one process needs no daemon, and gives way to nobody, since it waits for nobody.
ALONE = {"OMPI_MCA_mpi_yield_when_idle": "0", "OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_btl": "self", "OMPI_MCA_coll": "self,basic,libnbc", "OMPI_MCA_orte_create_session_dirs": "0"}
SECONDS = 240  # a rank that fails an assertion may leave the others waiting: that is a failure, not a hang


def runs():
    for source in sorted(HERE.glob("test_*.c")):
        name = source.stem
        alone = name.endswith("_serial") or name.split("_")[1] in POINTWISE
        ranks = (1, 2, 3) if name.endswith("_mpi") else (1,) if alone else (1, 2)
        for n in ranks:
            yield pytest.param(name, n, (), id=f"{name}-{n}")
            if '"-slow"' in source.read_text():
                yield pytest.param(name, n, ("-slow",), id=f"{name}-{n}-slow", marks=pytest.mark.slow)


@functools.lru_cache(None)
def kernels():
    """Those of OpenBLAS that the program takes (src/app/kernels.c): unit programs, which do not choose, would run those of 2004 on a processor that OpenBLAS does not know."""
    done = subprocess.run([PROGRAM, "--version"], env={**os.environ, "OPENBLAS_VERBOSE": "2"}, capture_output=True, text=True, timeout=SECONDS)
    found = re.findall(r"^Core: (\w+)$", done.stdout + done.stderr, re.M)
    return {"OPENBLAS_CORETYPE": found[-1]} if found else {}


@pytest.mark.parametrize("name,ranks,options", runs())
def test_unit(name, ranks, options, tmp_path):
    command, more = [str(BUILD / "unit" / name), *options], ALONE
    if ranks > 1:
        command, more = ["mpiexec", "-n", str(ranks)] + command, {}
    with tempfile.TemporaryDirectory(prefix="m") as own:  # for what MPI keeps: starts at the same time take it away from each other
        passed(name, ranks, command, tmp_path, {**os.environ, **kernels(), **more, "TMPDIR": own})


def passed(name, ranks, command, directory, env):
    # Own process group, so that a timeout ends the ranks too.
    process = subprocess.Popen(command, cwd=directory, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
    try:
        output, _ = process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        output, _ = process.communicate()
        pytest.fail(f"{name} on {ranks} ranks: no end after {SECONDS} s\n{output}", pytrace=False)
    if process.returncode:
        pytest.fail(f"{name} on {ranks} ranks: exit {process.returncode}\n{output}", pytrace=False)


def test_make_unit_leaves_nothing_in_the_source():
    """A program that writes files: below the build directory, however it is run."""
    source, program = HERE.parent.parent, BUILD.resolve() / "unit" / "test_forest_gmsh"
    before = sorted(os.listdir(source))
    command = ["make", "-o", str(program), "unit", f"BUILD={BUILD.resolve()}", f"UNITS={program}"]  # -o: as it is
    assert subprocess.run(command, cwd=source, capture_output=True, timeout=SECONDS).returncode == 0
    assert sorted(os.listdir(source)) == before and (BUILD / "unit" / "run" / "test.geo").exists()
