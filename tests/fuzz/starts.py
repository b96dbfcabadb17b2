#!/usr/bin/env python3
"""Starts of the program at the same time, several loops beside each other: each one has to end with exit status 0 and say what a start alone says.

    starts.py [--program bin/mortise] [--starts 2000] [--loops 4] [--mpiexec N]

Every start checks a scene (-check, MPI and gmsh included); with --mpiexec N on N processes, with a TMPDIR for each loop, as scripts/hpc/batch gives.
Part of the tests: tests/verify/test_fuzz.py.
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def environment(folder):
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
            "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "TMPDIR": str(folder)}


def start(program, folder, ranks):
    """(exit status, stdout, stderr) of one start; None: it did not end within two minutes."""
    launch = ["mpiexec", "-n", str(ranks)] if ranks > 1 else []
    try:
        result = subprocess.run([*launch, program, ROOT / "inputs" / "patch2d.yml", "-check"], cwd=folder, env=environment(folder), capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return None
    return result.returncode, result.stdout, result.stderr


def loop(program, number, folder, ranks, alone):
    """Lines that tell of the faults of so many starts one after the other."""
    found = []
    for k in range(number):
        said = start(program, folder, ranks)
        if said != alone:
            found.append(f"start {k}: " + ("no end" if said is None else f"exit status {said[0]}: {said[2][:300]!r}"))
    return found


def faults(program, starts, loops, ranks=1):
    """What went wrong in so many starts."""
    with tempfile.TemporaryDirectory(prefix="s") as folder, concurrent.futures.ThreadPoolExecutor(loops) as pool:
        own = [pathlib.Path(folder) / str(k) if ranks > 1 else pathlib.Path(folder) for k in range(loops)]
        for path in own:
            path.mkdir(exist_ok=True)
        alone = start(program, own[0], ranks)
        if not alone or alone[0]:
            return [f"alone: {alone}"]
        share = [starts // loops + (k < starts % loops) for k in range(loops)]
        lists = list(pool.map(lambda k: loop(program, share[k], own[k], ranks, alone), range(loops)))
        left = [str(path) for path in pathlib.Path(folder).rglob("*") if path.is_file()]
    return sum(lists, []) + [f"left: {path}" for path in left]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "bin" / "mortise"))
    for name, default in (("starts", 2000), ("loops", 4), ("mpiexec", 1)):
        parser.add_argument(f"--{name}", type=int, default=default)
    a = parser.parse_args()
    found = faults(pathlib.Path(a.program).resolve(), a.starts, a.loops, a.mpiexec)
    print("\n".join([*found, f"{a.starts} starts in {a.loops} loops, {len(found)} faults"]))
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
