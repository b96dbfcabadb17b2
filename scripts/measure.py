"""Runs of the program and what they cost: used by scripts/chart, scripts/bench and scripts/gallery."""
import csv
import json
import os
import pathlib
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = pathlib.Path(os.environ.get("MORTISE", ROOT / "bin" / "mortise"))


def seconds_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(scene, *options, directory=None):
    """(summary, rows of adapt.csv, processor seconds of the whole process: user + system, gmsh included) of one run of inputs/<scene>.yml."""
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(directory or scratch)
        command = [str(PROGRAM), str(ROOT / "inputs" / f"{scene}.yml"), "-output_directory", str(out), *map(str, options)]
        before = seconds_of_children()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        spent = seconds_of_children() - before
        if done.returncode:
            raise SystemExit(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout[-2000:]}")
        summary = json.loads((out / "summary.json").read_text())
        with open(out / "adapt.csv", newline="") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return summary, rows, spent
