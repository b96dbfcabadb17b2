"""Run scenes from Python: one, or one for each value of a key.

    run = mortise.run("press.yml", {"material.rubber.E": 2})
    runs = mortise.sweep("press.yml", "material.rubber.E", [2, 5, 10], jobs=2)
    mortise.compare(runs.values(), ["status", "contact.punch_on_block.max_pressure"])
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

from .reading import Run


class WrongInput(ValueError):
    """Exit status 1: the sentence of the program."""


def find_program():
    """$MORTISE, else mortise in PATH, else bin/mortise of the source tree."""
    tree = pathlib.Path(__file__).resolve().parents[2] / "bin" / "mortise"
    found = os.environ.get("MORTISE") or shutil.which("mortise") or (str(tree) if tree.exists() else None)
    if not found:
        raise FileNotFoundError("no program mortise: neither $MORTISE nor in PATH")
    return found


def word(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def run(scene, keys=None, directory=None, ranks=1, log=None, program=None):
    """Run a scene with keys {"material.rubber.E": 2} set over it; its results, also of a run that gave up (summary["status"] tells).

    directory: output.directory; default: the scene's own. ranks: processes. log: file for what it says; default: run.log in the results.
    Wrong input raises WrongInput with the program's sentence.
    """
    keys = dict(keys or {})
    if directory is not None:
        keys["output.directory"] = str(directory)
    command = ["mpiexec", "-n", str(ranks)] if ranks > 1 else []
    command += [program or find_program(), str(scene)]
    for key, value in keys.items():
        text = word(value)
        command += ["-" + key.replace(".", "_"), " " * bool(re.match("--?[A-Za-z]", text)) + text]  # else a value "-t" would be an option
    with tempfile.TemporaryDirectory(prefix="m") as own:  # of MPI: starts at the same time disturb each other in one
        done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "TMPDIR": own, "OMP_NUM_THREADS": "1"})
    if done.returncode == 1:
        raise WrongInput(done.stderr.strip())
    if done.returncode not in (0, 2, 3):
        raise RuntimeError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr[-2000:]}")
    found = [line.partition(": ")[0][len("results in "):] for line in done.stdout.splitlines() if line.startswith("results in ")]
    result = Run(found[-1] if found else keys.get("output.directory", pathlib.Path("out") / pathlib.Path(scene).stem))
    pathlib.Path(log or result.directory / "run.log").write_text(done.stdout + done.stderr)
    return result


def sweep(scene, key, values, directory=None, jobs=1, **options):
    """{value: results} of the scene with key set to each value, in directories of their own below `directory` (default: out/<scene>_<key>); jobs at a time."""
    below = pathlib.Path(directory or pathlib.Path("out") / f"{pathlib.Path(scene).stem}_{key}")
    keys = options.pop("keys", None) or {}
    names = {value: word(value).replace("/", "_").replace("..", "_") for value in values}
    if len(set(names.values())) < len(names):
        names = {value: f"{name}_{place}" for place, (value, name) in enumerate(names.items())}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = {value: pool.submit(run, scene, {**keys, key: value}, below / names[value], **options) for value in values}
        return {value: future.result() for value, future in futures.items()}


def figure(summary, name):
    """A figure of a summary by its path: contact.punch.force.1 is the second number of that list."""
    for part in name.split("."):
        summary = summary[int(part)] if isinstance(summary, list) else summary[part]
    return summary


def compare(runs, figures):
    """[[directory, figure, ...]] of runs (or their directories): figures of summary.json by path."""
    runs = [run if isinstance(run, Run) else Run(run) for run in runs]
    return [[str(run.directory), *(figure(run.summary, name) for name in figures)] for run in runs]
