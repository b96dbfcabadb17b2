#!/usr/bin/env python3
"""This program and other open codes on the same scenes, run in turn in one session:

    scripts/peers/run.py [--only SCENE,...] [--codes CODE,...] [--quick] [--rounds 3] [--seconds 40] [--references]

Every row of sweep.py is run once; those by which a code reaches an error of the tables are run again, all codes taking turns, and the median counts. Seconds are user + system
time of the whole process with all it starts (imports, mesh generator), memory its largest peak; each runs on one thread. Rows go to docs/charts/peers.csv (those of other scenes
and codes stay), failures too; figures.py makes charts and tables of them. --quick: the coarsest row of each series once, to out/peers.csv. --references: recomputes docs/references.json's
values and prints them. PEERS: where scripts/peers/install has put the codes."""
import argparse
import datetime
import json
import os
import pathlib
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import figures  # noqa: E402
import sweep  # noqa: E402

ROOT = HERE.parent.parent
PROGRAM = os.environ.get("MORTISE", str(ROOT / "bin" / "mortise"))
PEERS = pathlib.Path(os.environ.get("PEERS") or pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "mortise-peers")
OWN, SYSTEM = str(PEERS / "venv" / "bin" / "python"), "/usr/bin/python3"
PYTHON = {"ngsolve": OWN, "kratos": OWN, "calculix": OWN, "getfem": SYSTEM}
THREADS = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NGS_NUM_THREADS", "CCX_NPROC_STIFFNESS", "CCX_NPROC_EQUATION_SOLVER"), "1")
WORTH_AGAIN = 10  # seconds: what takes longer is not repeated
WALL = 8  # of the limit on processor seconds: other processes may have the machine
MORTISE_VALUE = {  # of summary.json
    "hertz2d": lambda s: 2 * abs(s["reaction"]["top"][1]),
    "rubber2d": lambda s: (2 if "cut" in s["reaction"] else 1) * abs(s["reaction"]["top"][1]),  # half or whole
    "hertz3d": lambda s: 4 * abs(s["reaction"]["top"][2]),
    "slide2d": lambda s: abs(s["reaction"]["top"][1]),
    "friction2d": lambda s: abs(s["reaction"]["top"][0]),
    "mindlin": lambda s: abs(s["reaction"]["top"][0]),
    "cylinder": lambda s: 2e-3 * abs(s["reaction"]["middle"][1]),
    "cook": lambda s: s["probe"]["tip"]["displacement"][1],
}


def run(command, limit):
    """(output, seconds, megabytes, exit status) of a process and all it starts, ended after `limit` processor seconds."""
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT, env={**os.environ, **THREADS, "PYTHONPATH": str(HERE)}, start_new_session=True,
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit) + 1)))
        signal.signal(signal.SIGALRM, lambda *_: os.killpg(process.pid, signal.SIGKILL))
        signal.alarm(int(WALL * limit))
        _, status, used = os.wait4(process.pid, 0)
        signal.alarm(0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return output.read().decode(errors="replace"), used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, process.returncode


def lshape_error(options):
    """True error of a run of the L-shape: from a second run, with fields, whose time does not count."""
    sys.path.insert(0, str(ROOT / "tests" / "verify"))
    import conftest
    import test_adapt_lshape as lshape

    with tempfile.TemporaryDirectory() as scratch:
        run([PROGRAM, *options, "-output_directory", scratch], 600)
        return lshape.errors(conftest.Result([], 0, "", "", pathlib.Path(scratch)))[0][-1] / (2 * lshape.ENERGY) ** 0.5


def once(scene, code, options, limit, need_value=True):
    """One run: what it found and what it cost."""
    with tempfile.TemporaryDirectory() as scratch:
        load = os.getloadavg()[0]
        if code == "mortise":
            options = [str(ROOT / options[0]), *map(str, options[1:])]
            output, seconds, memory, status = run([PROGRAM, *options, "-output_directory", scratch, "-output_fields", "false"], limit)
            found = {}
            if status == 0 or "\ninaccurate, " in output:
                summary = json.loads((pathlib.Path(scratch) / "summary.json").read_text())
                found = {"unknowns": summary["dofs"], "iterations": summary["newton_iterations"], "steps": summary["load_steps"]}
                if need_value:
                    found["value"] = lshape_error(options) if scene == "lshape" else MORTISE_VALUE[scene](summary)
        else:
            script = "solve_lshape.py" if scene == "lshape" else f"solve_{code}.py"
            output, seconds, memory, status = run([PYTHON[code], "-B", str(HERE / script), "--scene", scene, *options], limit)
            lines = [line for line in output.splitlines() if line.startswith("RESULT ")]
            found = json.loads(lines[-1][7:]) if lines and not status else {}
    if not found:
        found["status"] = "out of time" if status in (-signal.SIGXCPU, -signal.SIGKILL) or seconds > limit else "no answer"
    return {**found, "seconds": seconds, "memory": memory, "load": load}


def versions():
    """Version of each code that is there."""
    def says(*command):
        try:
            return subprocess.run(command, capture_output=True, text=True).stdout.strip().splitlines()
        except FileNotFoundError:
            return []

    asked = {
        "mortise": [line.split()[-1] for line in says(PROGRAM, "--version")[:1]] + says("git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"),
        "ngsolve": says(OWN, "-c", "import ngsolve; print(ngsolve.__version__)"),
        "kratos": says(OWN, "-c", "from importlib.metadata import version; print(version('KratosMultiphysics'))"),
        "getfem": says("dpkg-query", "-Wf", "${Version}", "python3-getfem"),
        "calculix": says("dpkg-query", "-Wf", "${Version}", "calculix-ccx"),
    }
    return {code: " ".join(lines) for code, lines in asked.items() if lines}


def measure(scene, there, arguments):
    """Rows of a scene."""
    codes = set(arguments.codes.split(",")) & set(there)
    series = {key: runs[:1] if arguments.quick else runs for key, runs in sweep.SCENES[scene].items() if key[0] in codes}
    plan = [(k, code, name, runs[k]) for (code, name), runs in series.items() for k in range(len(runs))]
    plan.sort(key=lambda p: p[0])  # codes in turn, coarse before fine; stable
    rows, gone = [], set()
    for k, code, name, options in plan:
        if (code, name) in gone:
            continue
        found = once(scene, code, options, arguments.seconds)
        row = {"scene": scene, "code": code, "series": name, "options": " ".join(map(str, options)), "status": "ok", **found, "runs": [found["seconds"]]}
        row["error"] = figures.error(scene, code, row["value"]) if "value" in row else ""
        if row["status"] == "out of time":
            gone.add((code, name))
        rows.append(row)
        print(f"{scene:10} {code:8} {name:32} {row.get('unknowns', ''):>7} {row['seconds']:7.2f} s  {row['error'] if row['error'] == '' else format(row['error'], '.2e')} {row['status']}", flush=True)
    for _ in range(0 if arguments.quick else arguments.rounds - 1):
        for row in sorted(figures.decisive(rows, scene), key=lambda row: row["seconds"]):
            if row["seconds"] < WORTH_AGAIN:
                options = next(o for _, code, name, o in plan if (code, name, " ".join(map(str, o))) == (row["code"], row["series"], row["options"]))
                row["runs"].append(once(scene, row["code"], options, arguments.seconds, need_value=False)["seconds"])
    date = datetime.date.today().isoformat()
    for row in rows:
        row.update(seconds=f"{statistics.median(row['runs']):.3f}", runs=len(row["runs"]), memory=f"{row['memory']:.0f}", load=f"{row['load']:.1f}", version=there[row["code"]], date=date,
                   value=f"{row['value']:.9g}" if "value" in row else "", error=f"{row['error']:.3g}" if row["error"] != "" else "")
    order = list(series)
    return sorted(rows, key=lambda row: order.index((row["code"], row["series"])))


def limit(values):
    """Of one value, itself; of two, whose penalties are 1 : 10, what is left without the error that falls as their inverse; of three on meshes of 2 : 3 : 4 cells, without the
    error that falls as a power of them."""
    if len(values) == 1:
        return values[0]
    if len(values) == 2:
        return (10 * values[1] - values[0]) / 9
    ratio, low, high = (values[0] - values[1]) / (values[1] - values[2]), 0.1, 6
    for _ in range(60):
        rate = (low + high) / 2
        falls = [n**-rate for n in (2, 3, 4)]
        low, high = (rate, high) if (falls[0] - falls[1]) / (falls[1] - falls[2]) < ratio else (low, rate)
    return values[2] - (values[1] - values[2]) / (falls[1] - falls[2]) * falls[2]


def references(scenes):
    """Compute every value of docs/references.json that names its settings again."""
    for scene in scenes:
        for way in figures.REFERENCES[scene]["ways"]:
            if "settings" in way:
                value = limit([once(scene, way["code"], list(map(str, options)), 1200)["value"] for options in way["settings"]])
                print(f"{scene:10} {way['code']:8} {value:.9g}  recorded {way['value']}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default=",".join(sweep.SCENES))
    parser.add_argument("--codes", default=",".join(figures.NAMES))
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=int, default=40)
    parser.add_argument("--references", action="store_true")
    arguments = parser.parse_args()
    scenes = arguments.only.split(",")
    for name, given, known in (("only", scenes, sweep.SCENES), ("codes", arguments.codes.split(","), figures.NAMES)):
        if set(given) - set(known):
            raise SystemExit(f"run.py: --{name}: one or several of {', '.join(known)}")
    if arguments.references:
        return references(scenes)
    there, began = versions(), time.time()
    path = ROOT / "out" / "peers.csv" if arguments.quick else figures.CSV
    path.parent.mkdir(exist_ok=True)
    for scene in scenes:
        rows = measure(scene, there, arguments)
        figures.write(path, [row for row in figures.read(path) if row["scene"] != scene or row["code"] not in arguments.codes.split(",")] + rows)
    print(f"{path}: {time.time() - began:.0f} s; {', '.join(f'{code} {version}' for code, version in there.items())}")
    if not arguments.quick:
        figures.main()


if __name__ == "__main__":
    main()
