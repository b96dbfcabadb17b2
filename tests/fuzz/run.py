#!/usr/bin/env python3
"""Damaged input of every kind: the program ends with exit status 0 to 3, in one sentence where that is not 0, within seconds and little memory; never by a signal or
with a trace.

    run.py [--program bin/mortise] [--cases 2000] [--seed 0] [--seconds S] [--kinds scene,options,msh,geo,checkpoint,sealed] [--jobs 1] [--keep FOLDER] [--plain]

Each case is made of its kind and number alone, so `--kinds msh --seed 17 --cases 1` makes it again. --keep: where the folders of cases that fail go (default: out/fuzz).
--seconds: no case begins later. Two thirds of the processor time of a case would be the start of the program and of gmsh, so the program is started once and copied before its
main for each case (tests/tools/copies.py), and a mesh that many cases ask for is made once (tests/tools/gmsh); --plain starts both anew.
Part of the tests: tests/verify/test_fuzz.py.
"""
import argparse
import concurrent.futures
import functools
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "tools"))
import copies  # noqa: E402

SECONDS, WALL, MEGABYTES = 20, 10, 1024
KINDS = ("scene", "options", "msh", "geo", "checkpoint", "sealed")
PIECES = ["{", "}", "[", "]", ": ", "\n", "  ", "\t", "&a ", "*a", "!!x ", "---\n", '"', "'", "#", "%", "|", ">", "\\", "-", ",", "nan", "1e999", "~", "\0", "é", "? ", "<<: "]
SCENES = ["hertz2d", "slide2d", "cube", "tube", "cook", "patch2d", "rubber2d", "blocks3d", "hertz3d"]
MESHED = {"patch2d": ("-2", "1"), "blocks3d": ("-3", "1"), "tube": ("-2", "2")}
FORMATS = ["msh22", "msh41", "msh22b", "msh41b"]
NUMBERS = [0, 1, -1, 2, 3, 7, 8, 9, 127, -128, 1e3, 1e6, 2**31 - 1, -2**31, 2**31, 2**32, 2**40, 2**62, 1e-300, 1e300, float("nan"), float("inf"), -float("inf")]
WORDS = ["0", "-1", "1e999", "nan", "", "true", "2147483648", "99999999999999999999", "1e-320", "auto", "full", "xyz", "normal", "t", "X/0", "sqrt(-X)", "[0,0,1,1]", "[1]",
         "x" * 500, "a.b.c", "-", "{", "\n", "é", "%s%s%n", "/dev/null", "../..", "."]
GEO = ["For i In {1:3}", "EndFor", "If (1)", "EndIf", "Extrude {0,0,1} {Surface{1};}", "Include \"g.geo\";", "Merge \"none.msh\";", "Mesh 2;", "Delete {Surface{1};}", "Coherence;",
       "Printf(\"%g\", 1);", "x = 1/0;", "Mesh.RecombineAll = 1;", "Physical Surface(\"a\") = {1:9};", "/*", "*/", "'", "\"", "SetFactory(\"OpenCASCADE\");", "Mesh.ElementOrder = 3;"]


def damage(text, chance, pieces=PIECES):
    for _ in range(chance.randint(1, 6)):
        at, kind = chance.randrange(len(text) + 1), chance.random()
        if kind < 0.25:
            text = text[:at] + chr(chance.randrange(256)) + text[at + 1:]
        elif kind < 0.5:
            text = text[:at] + text[at + chance.randrange(20):]
        elif kind < 0.75:
            text = text[:at] + chance.choice(pieces) + text[at:]
        else:
            start = chance.randrange(len(text) + 1)
            text = text[:at] + text[start:start + chance.randrange(40)] + text[at:]
    return text


def damage_bytes(data, chance):
    data = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        at, kind = chance.randrange(len(data)), chance.random()
        if kind < 0.4:
            data[at] = chance.choice(b"0123456789. -e$\n") if kind < 0.3 else chance.randrange(256)
        elif kind < 0.5:  # a number of four or eight bytes
            size = chance.choice([4, 8])
            data[at:at + size] = chance.choice([0, 1, 2, 1 << 20, (1 << 31) - 1, 1 << 31, (1 << 32) - 1, (1 << 63) - 1, (1 << 64) - 1]).to_bytes(8, "little")[:size]
        elif kind < 0.65:
            del data[at:at + chance.randint(1, 12)]
        elif kind < 0.85:
            data[at:at] = bytes(chance.choice(b"0123456789. -") for _ in range(chance.randint(1, 6)))
        else:
            start = chance.randrange(len(data))
            data[at:at] = data[start:start + chance.randrange(60)]
    return bytes(data)


def seal(data):
    """The first 512 bytes of a checkpoint as src/output/seal.c makes them."""
    value = 0xcbf29ce484222325
    for byte in data[512:]:
        value = (value ^ byte) * 0x100000001b3 & (1 << 64) - 1
    return f"mortise checkpoint, format 1\n{len(data)} bytes\nchecksum {value:016x}\n".encode().ljust(512, b"\0") + data[512:]


# ---- what is damaged, made once ---------------------------------------------------------------------------------------------------------------


class Whole:
    """Scenes, meshes and checkpoints that are whole, in a folder."""

    def __init__(self, program, folder, plain=True):
        self.program, self.folder, self.lock = pathlib.Path(program).resolve(), pathlib.Path(folder), threading.Lock()
        self.library, self.own, self.servers = None, threading.local(), []
        self.sanitized = copies.sanitized(self.program)
        if plain: return
        self.library = self.folder / "server.so"
        copies.build(self.library)

    def start(self):
        """What starts the program: of this thread alone."""
        if not hasattr(self.own, "start"):
            self.own.start = Copies(self.program, self.library) if self.library else Plain(self.program)
            if self.library: self.servers.append(self.own.start)
        return self.own.start

    def close(self):
        for server in self.servers:
            server.close()

    @functools.lru_cache(None)
    def help(self):
        return subprocess.run([self.program, "-help"], capture_output=True, text=True, env=environment()).stdout.split()

    @functools.lru_cache(None)
    def scene(self, name):
        return (ROOT / "inputs" / f"{name}.yml").read_text()

    @functools.lru_cache(None)
    def mesh(self, name, form):
        with self.lock:
            (dim, order), file = MESHED[name], self.folder / f"{name}_{form}.msh"
            command = ["gmsh", dim, "-order", order, "-format", form.rstrip("b"), "-o", str(file), str(ROOT / "inputs" / f"{name}.geo")]
            subprocess.run(command + (["-bin"] if form.endswith("b") else []), check=True, capture_output=True)
            return file.read_bytes()

    def on_mesh(self, name, file):
        """The scene on a file of its mesh."""
        text = self.scene(name).replace(f"file: {name}.geo", f"file: {file}").replace("  order: 1\n", "", 1)
        return "".join(line for line in text.splitlines(True) if not line.startswith("  parameter:"))

    @functools.lru_cache(None)
    def checkpoint(self, name):
        """(mesh, checkpoint) of a run that was given up after a step."""
        mesh = self.mesh(name, "msh41")
        with self.lock:
            folder = self.folder / f"run_{name}"
            folder.mkdir()
            (folder / "m.msh").write_bytes(mesh)
            (folder / "s.yml").write_text(self.on_mesh(name, "m.msh"))
            subprocess.run([self.program, "s.yml", "-load_step", "0.5", "-load_max_steps", "1", "-output_directory", "out", "-output_fields", "0"], cwd=folder, capture_output=True)
            return mesh, (folder / "out" / "checkpoint.h5").read_bytes()


def hurt_checkpoint(path, chance):
    """Whole HDF5 with other contents."""
    import h5py
    import numpy as np
    with h5py.File(path, "r+") as file, np.errstate(all="ignore"):
        places = []
        file.visititems(lambda name, item: places.append(name) if isinstance(item, h5py.Dataset) else None)
        for _ in range(chance.randint(1, 3)):
            if chance.random() < 0.3:
                item = file[chance.choice(["/", "numbers"])]
                name = chance.choice(sorted(item.attrs))
                if chance.random() < 0.2:
                    del item.attrs[name]
                    break
                item.attrs.modify(name, np.array(chance.choice(NUMBERS)).astype(item.attrs[name].dtype))
                continue
            name = chance.choice(places)
            if name not in file: continue
            values, kind = file[name][()], chance.random()
            if isinstance(values, bytes):
                del file[name]
                file[name] = np.bytes_(damage(values.decode("latin1"), chance).encode("latin1", "replace")) if kind < 0.8 else 3.5
                continue
            if values.ndim != 1: continue
            if kind < 0.5 and values.size:
                for _ in range(chance.randint(1, 4)):
                    values[chance.randrange(values.size)] = np.array(chance.choice(NUMBERS)).astype(values.dtype)
                file[name][...] = values
                continue
            del file[name]
            if kind < 0.65:
                file[name] = values[:chance.randrange(values.size + 1)]
            elif kind < 0.8:
                file[name] = np.append(values, values[:1].repeat(chance.randint(1, 50)))
            elif kind < 0.85:
                file[name] = values.reshape(1, -1)
            elif kind < 0.9:
                file[name] = b"a text"
            elif kind < 0.95:
                file.create_dataset(name, shape=(1 << 40,), dtype=values.dtype, chunks=(1024,))  # of no bytes
                break
    path.write_bytes(seal(path.read_bytes()))


# ---- cases --------------------------------------------------------------------------------------------------------------------------------------


def make(kind, number, whole, folder):
    """The files of a case; the arguments of the program."""
    chance = random.Random(f"{kind}.{number}")
    if kind == "scene":
        text = whole.scene(chance.choice(SCENES))
        for name in re.findall(r"file: (\w+\.geo)", text):
            shutil.copy(ROOT / "inputs" / name, folder)
        (folder / "s.yml").write_text(damage(text, chance))
        return ["s.yml", "-check"]
    if kind == "options":
        name = chance.choice(sorted(MESHED))
        (folder / "m.msh").write_bytes(whole.mesh(name, "msh41"))
        (folder / "s.yml").write_text(whole.on_mesh(name, "m.msh"))
        known = whole.help()
        keys = [word for word in known if "." in word and word[0].islower() and word[-1] not in ".,;:"] + [word for word in known if word.startswith("-") and len(word) > 3]
        arguments = ["s.yml", "-check"]
        for _ in range(chance.randint(1, 4)):
            key = chance.choice(keys).lstrip("-").replace(".", "_").replace("<x|y|z>", chance.choice("xyz"))
            for name in "<name>", "<pair>", "<parameter>", "<family>", "<constant>":
                key = key.replace(name, chance.choice(["rubber", "lower", "top", "upper_on_lower", "E", "new", "x" * 70]))
            key = "".join(c for c in (damage(key, chance, ["_", "-", "."]) if chance.random() < 0.2 else key) if c != "\0")
            arguments += ["-" + key] + ([chance.choice(WORDS)] if chance.random() < 0.9 else [])
        return [argument for argument in arguments if not argument.startswith(("-debug", "-malloc", "-on_error", "-start", "-stop", "-x_"))]
    if kind == "msh":
        name, form = chance.choice(sorted(MESHED)), chance.choice(FORMATS)
        (folder / "m.msh").write_bytes(damage_bytes(whole.mesh(name, form), chance))
        text = whole.on_mesh(name, "m.msh")
        (folder / "s.yml").write_text(damage(text, chance) if chance.random() < 0.2 else text)
        return ["s.yml"] + (["-check"] if chance.random() < 0.7 else ["-output_fields", "0", "-load_step", "0.5", "-load_max_steps", "2", "-max_seconds", "5"])
    if kind == "geo":
        name = chance.choice(sorted(MESHED))
        (folder / "g.geo").write_text(damage((ROOT / "inputs" / f"{name}.geo").read_text(), chance, PIECES + GEO), errors="replace")
        (folder / "s.yml").write_text(whole.scene(name).replace(f"{name}.geo", "g.geo"))
        return ["s.yml", "-check", "-max_seconds", "5"]
    name = chance.choice(sorted(MESHED))
    mesh, checkpoint = whole.checkpoint(name)
    (folder / "m.msh").write_bytes(mesh)
    (folder / "s.yml").write_text(whole.on_mesh(name, "m.msh"))
    path = folder / "c.h5"
    if kind == "checkpoint":
        data = bytearray(damage_bytes(checkpoint, chance))
        path.write_bytes(seal(bytes(data)) if len(data) > 512 and chance.random() < 0.7 else data)
    else:
        path.write_bytes(checkpoint)
        hurt_checkpoint(path, chance)
    return ["s.yml", "-restart", "c.h5", "-load_step", "0.5"] + (["-check"] if chance.random() < 0.7 else ["-output_fields", "0", "-load_max_steps", "3", "-max_seconds", "5"])


def environment():
    return {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1",
            "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1:verify_asan_link_order=0"}


class Copies:
    """The program, loaded once and copied for each start."""

    def __init__(self, program, library):
        self.server = copies.Server(program, library, environment())

    def start(self, arguments, folder, memory):
        return self.server.start(arguments, folder, folder / "stdout", folder / "stderr", memory)

    def wait(self, pid):
        return self.server.wait()

    def close(self):
        self.server.close()


class Plain:
    """The program, started anew."""

    def __init__(self, program):
        self.program = program

    def start(self, arguments, folder, memory):
        def limit():
            if memory: resource.setrlimit(resource.RLIMIT_DATA, (memory, resource.getrlimit(resource.RLIMIT_DATA)[1]))

        with open(folder / "stdout", "wb") as out, open(folder / "stderr", "wb") as err:
            self.process = subprocess.Popen([self.program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err, env=environment(), start_new_session=True,
                                            preexec_fn=limit)
        return self.process.pid

    def wait(self, pid):
        _, status, usage = os.wait4(pid, 0)
        self.process.returncode = os.waitstatus_to_exitcode(status)
        return status, usage.ru_maxrss


def processor_time(pid):
    """Seconds that a process has used so far."""
    try:
        return sum(map(int, pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13])) / os.sysconf("SC_CLK_TCK")
    except OSError:
        return 0.0


def end_when_late(pid, late, ended):
    """After SECONDS of processor time, or WALL times that: other work may share the cores."""
    for _ in range(WALL):
        if ended.wait(SECONDS): return
        if processor_time(pid) > SECONDS: break
    late.set()
    os.killpg(pid, 9)


def fault(start, arguments, folder, limit=True):
    """What is wrong with how the program takes them; "" if nothing."""
    # gmsh may have as much memory as the program; where a .geo is without end it takes a quarter of the machine's
    pid = start.start(arguments, folder, MEGABYTES << 20 if limit and (folder / "g.geo").exists() else 0)
    late, ended = threading.Event(), threading.Event()
    watch = threading.Thread(target=end_when_late, args=(pid, late, ended))
    watch.start()
    status, kilobytes = start.wait(pid)
    ended.set()
    watch.join()
    code, said = os.waitstatus_to_exitcode(status), (folder / "stderr").read_text(errors="replace")
    if late.is_set(): return f"no end after {SECONDS} s"
    if code not in (0, 1, 2, 3): return f"exit status {code}"
    for word in "PETSC ERROR", "ERROR: AddressSanitizer", "runtime error:", "MPI_ABORT":
        if word in said: return word
    told = code in (0, 3) or "mortise: " in said or (code == 2 and any(folder.rglob("summary.json")))
    if not told: return f"exit status {code} without a word"
    if any(ord(c) < 32 and c not in "\n\t" for c in said): return "a control character"
    if kilobytes > 1024 * MEGABYTES: return f"{kilobytes // 1024} MB"
    if "-check" in arguments and any((folder / name).exists() for name in ("out", "summary.json")): return "-check writes"
    return ""


def case(kind, number, whole, keep=None):
    """"" or a line that tells of the fault."""
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        folder = pathlib.Path(folder)
        arguments = make(kind, number, whole, folder)
        found = fault(whole.start(), arguments, folder, not whole.sanitized)
        if found and keep:
            shutil.copytree(folder, pathlib.Path(keep) / f"{kind}.{number}", dirs_exist_ok=True)
        return f"{kind} {number}: {found}: {' '.join(arguments)[:300]!r}" if found else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("program", str(ROOT / "bin" / "mortise")), ("cases", 2000), ("seed", 0), ("kinds", ",".join(KINDS)), ("jobs", 1), ("keep", str(ROOT / "out" / "fuzz"))):
        parser.add_argument(f"--{name}", type=type(default), default=default)
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--plain", action="store_true")
    a = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    kinds, faults, tried, end = a.kinds.split(","), 0, 0, time.time() + a.seconds
    with tempfile.TemporaryDirectory(prefix="whole") as folder, concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        whole = Whole(a.program, folder, a.plain)
        if not a.plain and shutil.which("gmsh"):
            os.environ.update(MORTISE_TEST_GMSH=shutil.which("gmsh"), MORTISE_TEST_MESHES=folder, PATH=f"{ROOT / 'tests' / 'tools'}:{os.environ['PATH']}")
        for line in pool.map(lambda i: case(kinds[i % len(kinds)], a.seed + i // len(kinds), whole, a.keep) if time.time() < end else None, range(a.cases)):
            tried += line is not None
            faults += bool(line)
            if line: print(line, flush=True)
        whole.close()
    print(f"{tried} cases, {faults} faults")
    return faults > 0


if __name__ == "__main__":
    sys.exit(main())
