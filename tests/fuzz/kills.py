#!/usr/bin/env python3
"""Runs killed at random moments (SIGKILL: the whole job, mpiexec, one rank), each of which goes on from its checkpoint: no more is lost than the load step in progress,
nothing of two runs is mixed, no process is left that goes on writing, and the end is that of a run that was never killed.

    kills.py [--program bin/mortise] [--kills 40] [--ranks 3] [--seed 0]

A case is made of its seed, number and number of ranks alone, but for the moment of the kill, which is that of the machine. Part of the tests: tests/verify/test_fuzz.py.
"""
import argparse
import contextlib
import io
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENE = ["inputs/hertz2d.yml", "-load_step", "0.1", "-order", "1", "-adapt_tolerance", "0.2"]
SECONDS = 20  # in which processes without their leader have to end


def environment(folder):
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
            "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_mpi_yield_when_idle": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "TMPDIR": str(folder)}


def command(program, directory, ranks, *more):
    return (["mpiexec", "-n", str(ranks)] if ranks > 1 else []) + [str(program), *SCENE, "-output_directory", str(directory), *more]


def processes(directory):
    """Of the program, on this directory."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else []
            if str(directory).encode() in words and b"mpiexec" not in words[0] and (entry / "stat").read_text().rsplit(")", 1)[1].split()[0] != "Z":
                found.append(int(entry.name))
        except (OSError, IndexError):
            pass
    return sorted(found)


def rows(directory):
    """Whole rows of history.csv."""
    path = directory / "history.csv"
    return max(path.read_text().count("\n") - 1, 0) if path.exists() else 0


def look(directory):
    """What stands in it, to see whether somebody goes on writing."""
    return {path.name: (path.stat().st_size, path.stat().st_mtime_ns) for path in directory.iterdir()} if directory.exists() else {}


def kill(process, directory, ranks, chance):
    """SIGKILL to the whole job, its mpiexec, one rank, or a rank and then mpiexec. What was killed."""
    ours = processes(directory)
    what = chance.choice(["job", "mpiexec", "rank", "rank and mpiexec"]) if ranks > 1 and ours else "job"
    try:
        if "rank" in what:
            os.kill(chance.choice(ours), signal.SIGKILL)
        if what == "job":
            os.killpg(process.pid, signal.SIGKILL)
        elif "mpiexec" in what:
            os.kill(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass  # it ended by itself just now
    return what


def wait(process, directory, steps, seconds):
    """Until it has so many load steps, and so long; False: it has ended by then."""
    while rows(directory) < steps and process.poll() is None:
        time.sleep(0.005)
    end = time.time() + seconds
    while time.time() < end and process.poll() is None:
        time.sleep(0.005)
    return process.poll() is None


def fault(whole, directory, ranks, program, steps, moment, chance, same):
    """What is wrong with a run that is killed so many seconds after a load step and goes on; "" if nothing. And a line on what happened."""
    environ = environment(directory.parent)
    process = subprocess.Popen(command(program, directory, ranks), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT, env=environ, start_new_session=True)
    what = kill(process, directory, ranks, chance) if wait(process, directory, steps, moment) else "nothing"
    try:
        process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        return f"no end {SECONDS} s after a kill of {what}", ""
    end = time.time() + SECONDS
    while processes(directory) and time.time() < end:
        time.sleep(0.02)
    if processes(directory):
        return f"processes that are left {SECONDS} s after a kill of {what}: {processes(directory)}", ""
    before, done = look(directory), rows(directory)
    second = subprocess.run(command(program, directory, ranks, "-restart", "auto"), capture_output=True, text=True, cwd=ROOT, env=environ, timeout=600)
    said = f"{what} {moment:.2f} s after {steps} load steps, {done} there"
    if second.returncode:
        return f"{said}: exit status {second.returncode}: {second.stderr[-300:]!r}; {sorted(before)}", said
    resumed = next((int(line.split()[5].rstrip(",")) for line in second.stdout.splitlines() if line.startswith("goes on after")), 0)
    said += f", went on after {resumed}"
    if not done - 1 <= resumed <= done: return f"{said}: lost more than the step in progress", said
    for path in directory.glob("*.tmp"):  # of a file that was being written
        path.unlink()
    try:
        same(whole, directory)
    except AssertionError as difference:
        return f"{said}: another end: {difference}", said
    return "", said


def same_run(whole, directory):
    sys.path.insert(0, str(ROOT / "tests" / "verify"))
    import test_checkpoint as checkpoint
    with contextlib.redirect_stdout(io.StringIO()):
        checkpoint.assert_same_run(*(checkpoint.Result([], 0, "", "", path) for path in (whole, directory)))


def faults(program, kills, ranks, seed=0, tell=lambda line: None):
    """Lines on what went wrong in so many kills."""
    found = []
    with tempfile.TemporaryDirectory(prefix="k") as folder:
        folder = pathlib.Path(folder)
        whole, begin = folder / "whole", time.time()
        first = subprocess.run(command(program, whole, ranks), capture_output=True, text=True, cwd=ROOT, env=environment(folder))
        if first.returncode:
            return [f"not killed: exit status {first.returncode}: {first.stderr[-300:]!r}"]
        seconds = time.time() - begin
        for k in range(kills):
            chance = random.Random(f"{seed}.{ranks}.{k}")
            steps = k * rows(whole) // kills
            wrong, said = fault(whole, folder / f"k{k}", ranks, program, steps, chance.random() * seconds / (rows(whole) + 1), chance, same_run)
            tell(f"kill {k}: {wrong or said}")
            found += [f"kill {k}: {wrong}"] if wrong else []
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "bin" / "mortise"))
    for name, default in (("kills", 40), ("ranks", 3), ("seed", 0)):
        parser.add_argument(f"--{name}", type=int, default=default)
    a = parser.parse_args()
    found = faults(pathlib.Path(a.program).resolve(), a.kills, a.ranks, a.seed, lambda line: print(line, flush=True))
    print(f"{a.kills} kills on {a.ranks} processes, {len(found)} faults")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
