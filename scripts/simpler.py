"""Simpler models of a scene: what section `needs` of summary.json suggests, applied, run and compared. Used by scripts/simplify and tests/needs/run.py."""
import copy
import json
import math
import os
import pathlib
import re
import resource
import shutil
import subprocess

import yaml

import cutmesh

ROOT = pathlib.Path(__file__).resolve().parent.parent
TREE = ROOT / "bin" / "mortise"
PROGRAM = pathlib.Path(os.environ.get("MORTISE") or (TREE if TREE.exists() else shutil.which("mortise") or TREE))


class Run:
    """One run: what it found and what it took."""

    def __init__(self, summary, seconds, text):
        self.summary, self.seconds, self.text = summary, seconds, text

    @property
    def solved(self):
        return self.summary.get("status") in ("converged", "inaccurate")

    def rows(self):
        """(part, name, row) of what could have been left out."""
        return [(part, name, row) for part, group in self.summary.get("needs", {}).items() if isinstance(group, dict) for name, row in group.items()]


def read(path):
    """A scene as text in a tree, its mesh by its whole path."""
    scene = yaml.load(pathlib.Path(path).read_text(), yaml.BaseLoader)
    scene["mesh"]["file"] = str((pathlib.Path(path).parent / scene["mesh"]["file"]).resolve())
    return scene


def write(scene, path):
    pathlib.Path(path).write_text(yaml.safe_dump(scene, sort_keys=False, width=120))


def run(scene, folder, name, options=(), times=1, limit=600):
    """Run a tree, or a file; seconds: of all processes, the least of so many runs; one that takes longer than the limit is not solved."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.yml"
    if isinstance(scene, dict): write(scene, path)
    else: path = pathlib.Path(scene)
    command = [str(PROGRAM), str(path), "-output_directory", str(folder / name), "-output_fields", "false", "-output_checkpoint", "0", *map(str, options)]
    least, summary, text = float("inf"), {}, ""
    for _ in range(times):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (int(limit) + 1, int(limit) + 1)))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        least = min(least, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        text = done.stdout + done.stderr
        if done.returncode not in (0, 2) or not (folder / name / "summary.json").exists(): return Run({}, least, text)
        summary = json.loads((folder / name / "summary.json").read_text())
    return Run(summary, least, text)


# ---- applying what was suggested ------------------------------------------------------------------------------------------------------


def put(scene, key, value):
    """Set a key, given with dots; None: without it. What it leads to may be missing."""
    *path, last = key.split(".")
    for word in path: scene = scene.setdefault(word, {})
    if value is None: scene.pop(last, None)
    elif isinstance(value, dict) and isinstance(scene.get(last), dict) and path == ["body"]: scene[last].update(copy.deepcopy(value))
    else: scene[last] = copy.deepcopy(value) if isinstance(value, dict) else f"{value}"


def text(value):
    return {k: text(v) for k, v in value.items()} if isinstance(value, dict) else value if value is None else repr(value) if isinstance(value, float) else str(value)


def cut(scene, axis, at, folder, name):
    """Half of the scene: its mesh is cut, groups that are gone go, probes go over to the half that is left."""
    dim, mesh, letter = 3 if scene["model"] == "3d" else 2, scene["mesh"], "xyz"[axis]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    cutmesh.make(mesh["file"], dim, mesh.get("order", 2), mesh.get("parameter", {}), folder / f"{name}_whole.msh")
    groups = cutmesh.half(folder / f"{name}_whole.msh", folder / f"{name}.msh", dim, axis, at, f"cut_{letter}")
    scene["mesh"] = {"file": str((folder / f"{name}.msh").resolve()), **{k: v for k, v in mesh.items() if k not in ("file", "order", "parameter", "trust")}}
    for boundary in list(scene.get("boundary") or {}):
        if boundary not in groups: del scene["boundary"][boundary]
    scene.setdefault("boundary", {})[f"cut_{letter}"] = {"fix": letter}
    for probe in (scene.get("probe") or {}).values():
        if float(probe.get(letter, 0)) < at: probe[letter] = repr(2 * at - float(probe.get(letter, 0)))


def turned(value, axis):
    """A place in a part of a scene, in a plane through the axis of a body of revolution: x is the radius, y along the axis."""
    if not isinstance(value, dict): return value
    if not any(letter in value for letter in "xyz"): return {k: turned(v, axis) for k, v in value.items()}
    rest = {k: v for k, v in value.items() if k not in "xyz"}
    return {**rest, "x": repr(sum(float(value.get(letter, 0)) ** 2 for letter in "xyz" if letter != axis) ** 0.5), "y": value.get(axis, "0")}


def revolved(scene, axis, folder, name):
    """The axisymmetric scene of a body of revolution."""
    mesh = scene["mesh"]
    folder = pathlib.Path(folder)
    cutmesh.make(mesh["file"], 3, mesh.get("order", 2), mesh.get("parameter", {}), folder / f"{name}_whole.msh")
    _, groups = cutmesh.section(folder / f"{name}_whole.msh", folder / f"{name}.msh", "xyz".index(axis), around=True)
    for key in ("probe", "point", "refine"):
        if key in scene: scene[key] = {k: turned(v, axis) for k, v in scene[key].items()}
    for boundary, value in list(scene.get("boundary", {}).items()):
        if boundary not in groups:
            del scene["boundary"][boundary]
            continue
        for key in ("displacement", "traction"):
            if key in value: value[key] = {"y": value[key][axis]}
        if "fix" in value and value["fix"] != "normal": value["fix"] = ("x" if set(value["fix"]) - {axis} else "") + ("y" if axis in value["fix"] else "")
    scene["mesh"] = {"file": str((folder / f"{name}.msh").resolve()), **{k: v for k, v in mesh.items() if k not in ("file", "order", "parameter", "trust")}}
    scene["model"] = "axisymmetric"


def flat(value, letters):
    """A part of a scene in the plane: letters of axes go over to x and y, the third one goes, and with it rotations about others than that."""
    if isinstance(value, dict):
        about = value.get("rotation", {}).get("axis", "z")
        value = {k: v for k, v in value.items() if (k not in ("x", "y", "z") or k in letters) and (k != "rotation" or about not in letters) and k != "axis"}
        return {letters.get(k, k): flat(v, letters) for k, v in value.items()}
    if isinstance(value, list): return [flat(v, letters) for v in value]
    return re.sub(r"\b[XYZ]\b", lambda m: letters.get(m[0].lower(), "0").upper(), value)


def section(scene, axis, folder, name):
    """The scene of a section across an axis, in plane strain."""
    letters = {"xyz"[("xyz".index(axis) + 1 + i) % 3]: "xy"[i] for i in range(2)}  # turns keep their sense
    mesh = scene["mesh"]
    folder = pathlib.Path(folder)
    cutmesh.make(mesh["file"], 3, mesh.get("order", 2), mesh.get("parameter", {}), folder / f"{name}_whole.msh")
    length, groups = cutmesh.section(folder / f"{name}_whole.msh", folder / f"{name}.msh", "xyz".index(axis))
    for key in ("body", "boundary", "contact", "probe", "point", "refine"):
        if key in scene: scene[key] = {k: flat(v, letters) for k, v in scene[key].items()}
    for boundary, value in list(scene.get("boundary", {}).items()):
        if "fix" in value and value["fix"] != "normal": value["fix"] = "".join(letters[c] for c in value["fix"] if c in letters)
        if boundary not in groups or value.get("fix") == "" and len(value) == 1: del scene["boundary"][boundary]
    scene["mesh"] = {"file": str((folder / f"{name}.msh").resolve()), **{k: v for k, v in mesh.items() if k not in ("file", "order", "parameter", "trust")}}
    scene["model"] = "plane_strain"
    return length


def apply(scene, row, folder, name):
    """The scene without what the row says."""
    scene = copy.deepcopy(scene)
    for key, value in row["set"].items():
        if key == "plane":
            for letter, at in value.items(): cut(scene, "xyz".index(letter), at, folder, name)
        elif key == "section": section(scene, value, folder, name)
        elif key == "revolve": revolved(scene, value, folder, name)
        else: put(scene, key, text(value))
    if not scene.get("contact", True): del scene["contact"]
    return scene


def meshed(scene, folder, name):
    """The scene with its mesh made beforehand, so that runs are compared without gmsh."""
    scene, mesh = copy.deepcopy(scene), scene["mesh"]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if mesh["file"].endswith(".geo"):
        cutmesh.make(mesh["file"], 3 if scene["model"] == "3d" else 2, mesh.get("order", 2), mesh.get("parameter", {}), folder / f"{name}.msh")
        scene["mesh"] = {"file": str((folder / f"{name}.msh").resolve()), **{k: v for k, v in mesh.items() if k not in ("file", "order", "parameter", "trust")}}
    return scene


# ---- comparing ------------------------------------------------------------------------------------------------------------------------


def size(vector):
    return sum(v * v for v in vector) ** 0.5


class Share:
    """What of the whole model a simpler one is. part: so much of it, half, one unit of its length, or (more than 1) the full turn; letters: axes of the whole along which its own x, y, z
    run, None: no single one; cut: those that planes of symmetry cut, along which the cut bears forces of its own."""

    def __init__(self, part=1, letters=("x", "y", "z"), cut=""):
        self.part, self.letters, self.cut = part, letters, cut

    def of(self, row, folder, name):
        """The share of what the row makes of this model."""
        if "plane" in row["set"]:
            return Share(self.part / 2 ** len(row["set"]["plane"]), self.letters, self.cut + "".join(self.letters["xyz".index(c)] for c in row["set"]["plane"]))
        key = next((k for k in ("section", "revolve") if k in row["set"]), None)
        if not key: return self
        axis, whole = "xyz".index(row["set"][key]), pathlib.Path(folder) / f"{name}_whole.msh"
        if key == "revolve":
            angle, _ = cutmesh.section(whole, pathlib.Path(folder) / f"{name}_section.msh", axis, around=True)
            return Share(self.part * 2 * math.pi / angle, [None, self.letters[axis]], self.cut)
        along = [x[axis] for x in cutmesh.read(whole)[1].values()]
        return Share(self.part / (max(along) - min(along)), [self.letters[(axis + i) % 3] for i in (1, 2)], self.cut)

    def off(self, x, y):
        """How far a force of the simpler model is from the whole one's. A support may be as large a part as the model, or lie on one side of some of its planes."""
        def by(part): return size([x["xyz".index(c)] - v / part for c, v in zip(self.letters, y) if c and not (c in self.cut and part < 1)])

        return min(by(self.part * 2**k) for k in range(len(self.cut) + 1))


def change(whole, simple, share=Share()):
    """Largest relative change of the energy norm, of the supports' forces and of the pairs' forces; about an axis of revolution of the largest pressures, too."""
    a, b = whole.summary, simple.summary
    changes = [abs((b["energy"] / share.part / a["energy"]) ** 0.5 - 1)] if a["energy"] > 0 else []
    both = [(a["reaction"][k], b["reaction"][k]) for k in a["reaction"] if k in b["reaction"]]
    both += [(a["contact"][k]["force"], b["contact"][k]["force"]) for k in a["contact"] if k in b["contact"]]
    both = [(x, y) for x, y in both if any(x) and any(y)] # the support of a rigid body has no reaction of its own
    largest = max((size(x) for x, _ in both), default=0)
    if None in share.letters:
        changes += [abs(b["contact"][k]["max_pressure"] / a["contact"][k]["max_pressure"] - 1) for k in a["contact"] if k in b["contact"] and a["contact"][k]["max_pressure"] > 0]
    if largest > 0: changes.append(max(share.off(x, y) for x, y in both) / largest)
    return max(changes, default=0)


def start(times=5):
    """Processor seconds of a process that does nothing: starting MPI."""
    least = float("inf")
    for _ in range(times):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([str(PROGRAM), "--version"], capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        least = min(least, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return least


def settled(seconds, within):
    """Was the least of these times met twice?"""
    return len(seconds) > 1 and sorted(seconds)[1] - min(seconds) <= within


def check(scene, base, part, row, folder, name, times=1, idle=0):
    """(real change, real share of the time saved) of one promise; None, None: the simpler model was not solved. times: so many runs of both in turn at most, until the least
    processor time of each, which counts, was met twice, to a quarter of what is told to be saved; idle: seconds of it that no model takes."""
    simple, whole = run(apply(scene, row, folder, name), folder, name, limit=10 * base.seconds + 5), [base.seconds]
    if not simple.solved: return None, None, simple
    seconds = [simple.seconds]
    while len(whole) < times and not all(settled(s, 0.25 * row["saves"] * (min(whole) - idle)) for s in (whole, seconds)):
        whole.append(run(scene, folder, "again", limit=10 * base.seconds + 5).seconds)
        seconds.append(run(pathlib.Path(folder) / f"{name}.yml", folder, name, limit=10 * base.seconds + 5).seconds)
    simple.seconds = min(seconds)
    saved = 1 - (simple.seconds - idle) / (min(whole) - idle)
    if part in ("cells", "order"): return simple.summary["estimated_error"], saved, simple
    return change(base, simple, Share().of(row, folder, name)), saved, simple
