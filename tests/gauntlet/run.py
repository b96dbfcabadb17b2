#!/usr/bin/env python3
"""Run the contact scenes of a folder in all their variants and judge each run by figures known beforehand.

    run.py [--program bin/mortise] [--scenes FOLDER] [--only NAME] [--quick] [--jobs N] [--settings "-contact_{pair}_order full"] [--friction 0.2]
           [--csv FILE]

docs/gauntlet.md describes scenes and figures; rows() below says what a scene of scenes.json holds. Verdicts:
  ok          exit 0, the tolerance asked for reached and every figure within its own; or refused in one sentence (exit 1), where the scene allows it
  WRONG       exit 0, but a figure is off
  short       exit 0, but the tolerance of adaptation was not reached
  inaccurate  exit 2, all load steps done
  failed      exit 2 before the end, or any other exit
  slow        more processor time than the scene allows
Exit status: 0 where every run is ok.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
WALL = 10  # wall time a run may take, in multiples of its processor time: other work may share the cores
SHOWN = {"scene": 14, "variant": 26, "verdict": 10, "t": 6, "steps": 5, "newton": 6, "cuts": 4, "cells": 6, "error": 8, "seconds": 7}


def rows(folder, only="", quick=False, settings=""):
    """(scene, variant, options) of each run that scenes.json asks for.

    A scene: name, class, file, pairs {name: [nonmortar, mortar]}, variants {name: options, with the word "swap" for exchanged sides}, figures [[label, expression, value, relative
    tolerance]], source (of the figures), friction (labels of the figures that hold with friction, too), selves (pairs of one surface with itself), seconds (of processor time), tolerance (of adaptation), told (refusal in one sentence is right), quick (variants that `make test` runs).
    """
    for scene in json.loads((folder / "scenes.json").read_text()):
        pairs = scene.get("pairs", {})
        for variant, text in scene.get("variants", {"": ""}).items():
            if only not in scene["name"] or (quick and variant not in scene.get("quick", [])):
                continue
            options = [word for word in text.split() if word != "swap"]
            for pair, sides in {**pairs, **dict.fromkeys(scene.get("selves", []))}.items():
                if "swap" in text.split() and sides:
                    nonmortar, mortar = sides
                    options += [f"-contact_{pair}_nonmortar", mortar, f"-contact_{pair}_mortar", nonmortar]
                options += settings.format(pair=pair).split()
            yield scene, variant, options


def execute(program, scene_file, options, directory, seconds):
    """Exit status (None: out of time), what it said on stderr, seconds of processor time of the run and of the mesher it calls. MPI keeps its session below TMPDIR, which runs side by
    side must not share."""
    limited = ["sh", "-c", f'ulimit -t {int(seconds) + 1}; exec "$0" "$@"', program, str(scene_file), "-output_directory", directory, "-output_fields", "false", *options]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        process = subprocess.run(limited, capture_output=True, text=True, timeout=WALL * seconds, env={**os.environ, "TMPDIR": directory, "OMPI_MCA_mpi_yield_when_idle": "0", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
        code, said = process.returncode, process.stderr
    except subprocess.TimeoutExpired:
        code, said = None, ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (None if used > seconds or code in (-signal.SIGKILL, -signal.SIGXCPU) else code), said, used


def read(directory):
    """summary.json and the rows of history.csv; empty where a run left none."""
    try:
        summary = json.loads(pathlib.Path(directory, "summary.json").read_text())
    except (OSError, ValueError):
        summary = {}
    try:
        with open(pathlib.Path(directory, "history.csv"), newline="") as file:
            history = [{key: number(value) for key, value in row.items()} for row in csv.DictReader(file)]
    except OSError:
        history = []
    return summary, history


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text


def misses(figures, summary, history):
    """One phrase for each figure that is not within its tolerance, relative to its value (absolute where that is 0)."""
    found = []
    for label, expression, expected, tolerance in figures:
        try:
            value = eval(expression, {"s": summary, "h": history})
        except (LookupError, TypeError, ValueError, ZeroDivisionError) as error:
            found.append(f"{label}: {error!r}")
            continue
        if not abs(value - expected) <= tolerance * (abs(expected) or 1):  # a NaN misses
            found.append(f"{label} {value:.6g} for {expected:.6g}")
    return found


def judge(scene, options, code, said, summary, history, friction=0):
    """Verdict and why."""
    asked = summary.get("adapt_tolerance") or scene.get("tolerance", 0)
    if "-adapt_tolerance" in options:
        asked = float(options[options.index("-adapt_tolerance") + 1])
    if code is None:
        return "slow", ""
    if code == 0:
        figures = [figure for figure in scene.get("figures", []) if not friction or figure[0] in scene.get("friction", [])]
        wrong = misses(figures, summary, history)
        short = asked and (summary.get("estimated_error") or 0) > asked
        return ("WRONG" if wrong else "short" if short else "ok"), "; ".join(wrong)
    if code == 1 and scene.get("told") and said.strip().count("\n") == 0:
        return "ok", said.strip()
    return ("inaccurate" if summary.get("status") == "inaccurate" else "failed"), summary.get("reason") or said.strip().split("\n")[0]


def solve(program, folder, scene, variant, options, friction=0):
    """One row of the table."""
    with tempfile.TemporaryDirectory() as directory:
        code, said, used = execute(program, folder / scene["file"], options, directory, scene.get("seconds", 15))
        s, h = read(directory)
    verdict, why = judge(scene, options, code, said, s, h, friction)
    return {"class": scene.get("class", ""), "scene": scene["name"], "variant": variant, "verdict": verdict, "exit": code, "t": s.get("t"), "steps": s.get("load_steps"),
            "newton": s.get("newton_iterations"), "cuts": s.get("step_cuts"), "cells": s.get("cells"), "error": s.get("estimated_error"), "seconds": round(used, 2), "why": why}


def line(row):
    """A row for the screen."""
    def cell(value):
        return "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)

    return " ".join(cell(row[key]).ljust(width) for key, width in SHOWN.items()) + " " + row["why"]


def save(path, table):
    """The table as CSV, where there is a path and a row."""
    if path and table:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, table[0])
            writer.writeheader()
            writer.writerows(table)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=os.environ.get("MORTISE", "bin/mortise"))
    parser.add_argument("--scenes", default=HERE, type=pathlib.Path, help="folder with scenes.json")
    parser.add_argument("--only", default="", help="scenes whose name contains this")
    parser.add_argument("--quick", action="store_true", help="only the variants that scenes.json lists as quick")
    parser.add_argument("--settings", default="", help="options for every pair; {pair} stands for its name")
    parser.add_argument("--friction", type=float, default=0, help="coefficient of friction of every pair; scenes say which of their figures hold then")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    parser.add_argument("--csv", type=pathlib.Path, help="file to write the table to")
    a = parser.parse_args()
    program, folder, table = os.path.abspath(a.program), a.scenes.resolve(), []
    settings = a.settings + (f" -contact_{{pair}}_friction {a.friction}" if a.friction else "")
    if not os.access(program, os.X_OK):
        parser.error(f"no program {program}")
    print(" ".join(key.ljust(width) for key, width in SHOWN.items()))
    with concurrent.futures.ProcessPoolExecutor(a.jobs) as pool:  # processes, so that each knows the processor time of its own runs
        runs = [pool.submit(solve, program, folder, *row, a.friction) for row in rows(folder, a.only, a.quick, settings)]
        for run in runs:
            table.append(run.result())
            print(line(table[-1]), flush=True)
    save(a.csv, table)
    count = collections.Counter(row["verdict"] for row in table)
    others = ", ".join(f"{n} {verdict}" for verdict, n in count.most_common() if verdict != "ok")
    print(f"{count['ok']} ok of {len(table)} in {sum(row['seconds'] for row in table):.0f} s of processor time" + (f": {others}" if others else ""))
    return 0 if count["ok"] == len(table) else 1


if __name__ == "__main__":
    sys.exit(main())
