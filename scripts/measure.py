"""Runs of the program and what they cost: used by scripts/chart, scripts/bench and scripts/gallery. References of scenes."""
import csv
import json
import os
import pathlib
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = pathlib.Path(os.environ.get("MORTISE", ROOT / "bin" / "mortise"))


def reference(scene, variant=None):
    """Value of docs/references.json, or of a variant of the scene: another geometry or load."""
    entry = json.loads((ROOT / "docs" / "references.json").read_text())[scene]
    return entry["variants"][variant] if variant else entry["value"]


def seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def plain_seconds(axes):
    """A logarithmic axis of seconds with plain numbers."""
    low, high = axes.get_xlim()
    ticks = [t for t in (0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10, 20, 50) if low <= t <= high]
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.set_xticks([], minor=True)


def run(scene, *options, directory=None):
    """(summary, rows of adapt.csv, processor seconds of the whole process: user + system, gmsh included) of one run of inputs/<scene>.yml."""
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(directory or scratch)
        command = [str(PROGRAM), str(ROOT / "inputs" / f"{scene}.yml"), "-output_directory", str(out), *map(str, options)]
        before = seconds_of_children()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        spent = seconds_of_children() - before
        if done.returncode and "\ninaccurate, " not in done.stdout: # a limit that was set may leave the tolerance out of reach
            raise SystemExit(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout[-2000:]}")
        summary = json.loads((out / "summary.json").read_text())
        with open(out / "adapt.csv", newline="") as file:
            rows = [{key: float(value or "nan") for key, value in row.items()} for row in csv.DictReader(file)]
    return summary, rows, spent
