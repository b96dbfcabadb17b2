"""What the cases lean on: run a scene with bin/mortise and read what it left.

    def test_patch(run):
        result = run("inputs/patch.yml", "-order", 2, ranks=2)
        assert result.returncode == 0 and result.summary["status"] == "converged"
"""
import atexit
import csv
import functools
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "tools"))
import copies  # noqa: E402

PROGRAM = pathlib.Path(os.environ.get("MORTISE", ROOT / "bin" / "mortise"))


class Result:
    """One run: exit status, screen output, and the files of its output directory, read when asked for."""

    def __init__(self, command, returncode, stdout, stderr, directory):
        self.command, self.returncode, self.stdout, self.stderr, self.directory = command, returncode, stdout, stderr, directory

    def __repr__(self):  # what pytest shows when an assertion on a result fails
        return f"<{' '.join(self.command)}: exit {self.returncode}\n{self.stdout[-3000:]}\n{self.stderr[-3000:]}>"

    @property
    def solved(self):
        """All load steps are done, on meshes as fine as asked for or as the limits allow that a test sets."""
        told = re.search(r"^(converged: |inaccurate, .* was not reached \((max_passes|max_cells|nothing left to refine)\b)", self.stdout, re.MULTILINE)
        return self.returncode in (0, 2) and told is not None and (self.returncode == 0) == told[0].startswith("converged")

    @property
    def summary(self):
        """summary.json as a dict."""
        return json.loads((self.directory / "summary.json").read_text())

    def table(self, name):
        """A csv table as a list of {column: float}; nan: the field is empty."""
        with open(self.directory / name, newline="") as file:
            return [{key: float(value or "nan") for key, value in row.items()} for row in csv.DictReader(file)]

    @property
    def adapt(self):
        return self.table("adapt.csv")

    @property
    def history(self):
        return self.table("history.csv")

    def states(self, grid="bulk", passes=False):
        """(time, {name: array}) for each state of a grid that fields.xdmf lists, the last of each load step; passes: every one, its number for its time. X are the
        points, cells their numbers."""
        import h5py

        out = []
        several = passes and (self.directory / "passes.xdmf").exists()
        root = xml.etree.ElementTree.parse(self.directory / ("passes.xdmf" if several else "fields.xdmf")).getroot()
        for state in root.findall(f"Domain/Grid[@Name='{grid}']/Grid"):
            data = {}
            for item in state.iter("DataItem"):
                file, path = item.text.strip().split(":")
                with h5py.File(self.directory / file) as h5:
                    data[path.rsplit("/", 1)[1]] = h5[path][...]
            out.append((float(state.find("Time").get("Value")), data))
        return out


def module(name, path):
    """A script as a module of this name: several are called run.py."""
    spec = importlib.util.spec_from_file_location(name, path)
    loaded = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def leaves(value, kept, name=""):
    """Every number and word of a document with its path, without what is below keys that are not kept(key)."""
    if isinstance(value, dict):
        for key, v in value.items():
            if kept(key):
                yield from leaves(v, kept, f"{name}.{key}")
    elif isinstance(value, list):
        for i, v in enumerate(value):
            yield from leaves(v, kept, f"{name}[{i}]")
    else:
        yield name, value


def execute(command, timeout=600, env=None):
    """Run a command in its own process group; a timeout ends all its ranks and fails the test. A directory of its own for what MPI keeps: starts at the same time
    take it away from each other. mpiexec need not wait for processes that are at their end too (a second, whenever the status is not 0). The program by itself is
    a copy of one that is loaded: half of the processor time of a small run."""
    with tempfile.TemporaryDirectory(prefix="m") as own:
        alone = command[0] == str(PROGRAM)  # it waits for nobody, and need not give way where it asks whether to
        more = {"TMPDIR": own, "OMPI_MCA_odls_base_sigkill_timeout": "0", **({"OMPI_MCA_mpi_yield_when_idle": "0"} if alone else {}), **(env or {})}
        loaded = server() if alone and not env else None
        process, late = (Copy(loaded, command[1:], own, more) if loaded else Start(command, more)), False
        try:
            stdout, stderr = process.communicate(timeout)
        except subprocess.TimeoutExpired:
            late = True
            os.killpg(process.pid, 9)
            stdout, stderr = process.communicate()
    if late: pytest.fail(f"{' '.join(command)}: no end after {timeout} s\n{stdout[-3000:]}\n{stderr[-3000:]}", pytrace=False)
    return process.returncode, stdout, stderr


def Start(command, more):
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True, cwd=ROOT, env={**os.environ, **more})


class Copy:
    """As a process of subprocess.Popen."""

    def __init__(self, loaded, arguments, folder, more):
        self.loaded, self.files = loaded, [pathlib.Path(folder) / name for name in ("stdout", "stderr")]
        self.pid = loaded.start(arguments, ROOT, *self.files, environment={**os.environ, **more})

    def communicate(self, timeout=None):
        if not self.loaded.ended(timeout): raise subprocess.TimeoutExpired("", timeout)
        self.returncode = os.waitstatus_to_exitcode(self.loaded.wait()[0])
        return [file.read_text() for file in self.files]


@functools.lru_cache(None)
def loaded_program():
    """The program, and what it inherited."""
    library = os.environ.get("MORTISE_TEST_COPIES")
    if not library or copies.sanitized(PROGRAM): return None, None
    loaded = copies.Server(PROGRAM, library, dict(os.environ))
    atexit.register(loaded.close)
    return loaded, inherited()


def inherited():
    """What a process started now has from this one: environment (that pytest keeps its own place in), limits, umask, signals."""
    status = re.findall(r"^(?:Umask|SigBlk|SigIgn):.*", pathlib.Path("/proc/self/status").read_text(), re.M)
    return {key: value for key, value in os.environ.items() if key != "PYTEST_CURRENT_TEST"}, pathlib.Path("/proc/self/limits").read_text(), status


def server():
    """None: the program is started anew, as where a test has set what it inherits."""
    loaded, had = loaded_program()
    return loaded if loaded and inherited() == had else None


@pytest.fixture
def run(tmp_path):
    """run(scene, *options, ranks=1, timeout=600, text=None) -> Result.

    scene: path (relative: to the repository), or with text= the name under which that YAML text is written to the test's
    own directory first. Options are passed as they are. Each run of a test gets its own output directory.
    """
    count = 0

    def start(scene, *options, ranks=1, timeout=600, text=None, env=None):
        nonlocal count
        count += 1
        if text is not None:
            path = tmp_path / scene
            path.write_text(text)
        else:
            path = ROOT / scene
            assert path.exists(), f"no scene {path}"
        directory = tmp_path / f"out{count}"
        command = [str(PROGRAM), str(path), "-output_directory", str(directory)] + [str(option) for option in options]
        if ranks > 1:
            command = ["mpiexec", "-n", str(ranks)] + command
        return Result(command, *execute(command, timeout, env), directory)

    return start
