"""CalculiX: C3D8, C3D8I, C3D8R or C3D20R, a scene of the plane as a slab of one cell; face-to-face penalty contact, automatic increments."""
import pathlib
import re
import subprocess
import tempfile

import numpy as np

import meshes
from scenes import SCENES, options, report

args = options(__doc__, cell="C3D8", n=8, grade=0.0, penalty=1e4, stick=0.0, steps=1)
scene = SCENES[args.scene]
order = 2 if args.cell.startswith("C3D20") else 1
THICK = 0.1  # of a slab
points, cells = meshes.generate(scene, args.n, order, args.grade)
nodes = {name: meshes.corners(c) if order == 1 else meshes.serendipity(c) for name, c in cells.items()}
tests = {"upper": meshes.on_arc, "lower": meshes.on_face}
contact = {name: meshes.faces(cells[name], points, tests[name]) for name in cells}
if scene.dim == 2:
    count = len(points)
    layers = (0, THICK) if order == 1 else (0, THICK / 2, THICK)
    points = np.concatenate([np.column_stack([points, np.full(count, z)]) for z in layers])
    back = (len(layers) - 1) * count
    for name, c in nodes.items():
        parts = [c, c + back] if order == 1 else [c[:, :4], c[:, :4] + back, c[:, 4:], c[:, 4:] + back, c[:, :4] + count]
        nodes[name] = np.concatenate(parts, 1)
upright = scene.dim - 1
used = {name: np.unique(c) for name, c in nodes.items()}
flat = {"upper": 1, "lower": -scene.height}
held = {name: used[name][abs(points[used[name], upright] - flat[name]) < 1e-9] for name in nodes}
loose = np.setdiff1d(np.concatenate(list(used.values())), np.concatenate(list(held.values())))

deck = ["*NODE,NSET=ALL"] + [f"{k + 1}," + ",".join(f"{v:.12g}" for v in points[k]) for k in np.concatenate(list(used.values()))]
first = 1
for name, c in nodes.items():
    deck.append(f"*ELEMENT,TYPE={args.cell},ELSET={name}")
    for k, cell in enumerate(c + 1):
        words = [str(v) for v in (first + k, *cell)]
        deck += [",".join(words[:16]) + ("," if len(words) > 16 else "")] + ([",".join(words[16:])] if len(words) > 16 else [])
    deck.append(f"*SURFACE,NAME=S{name},TYPE=ELEMENT")
    deck += [f"{first + cell},S{face + (3 if scene.dim == 2 else 1)}" for cell, face, _ in contact[name]]
    first += len(c)
sets = {"top": held["upper"], "bottom": held["lower"]}
if scene.half:
    sets.update({f"axis{axis}": loose[abs(points[loose, axis]) < 1e-9] for axis in range(scene.dim - 1)})
if scene.dim == 2:
    sets["loose"] = loose
for name, members in sets.items():
    deck += [f"*NSET,NSET={name}"] + [f"{k + 1}," for k in members]
law = ["*FRICTION", f"{scene.friction:g},{args.stick or args.penalty / 10:g}"] if scene.friction else []
deck += ["*MATERIAL,NAME=m", "*HYPERELASTIC,NEO HOOKE", f"{scene.mu / 2:.15g},{2 / scene.kappa:.15g}", "*SOLID SECTION,ELSET=upper,MATERIAL=m", "*SOLID SECTION,ELSET=lower,MATERIAL=m",
         "*SURFACE INTERACTION,NAME=pair", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{args.penalty:g},{1e-6 * args.penalty:g}", *law,
         "*CONTACT PAIR,INTERACTION=pair,TYPE=SURFACE TO SURFACE", "Supper,Slower"]
for slide, press in [(0, scene.press)] + ([(scene.slide, scene.press)] if scene.slide else []):
    deck += ["*STEP,NLGEOM,INC=1000", "*STATIC", f"{1 / args.steps:g},1.,1e-4,{1 / args.steps:g}", "*BOUNDARY", "bottom,1,3", f"top,1,1,{slide:g}", f"top,{upright + 1},{upright + 1},{-press:g}"]
    deck += [f"axis{axis},{axis + 1},{axis + 1}" for axis in range(scene.dim - 1) if scene.half]
    deck += ["loose,3,3", "top,3,3"] if scene.dim == 2 else ["top,2,2"]
    deck += ["*NODE PRINT,NSET=top,TOTALS=ONLY,FREQUENCY=1", "RF", "*END STEP"]
with tempfile.TemporaryDirectory() as scratch:
    job = pathlib.Path(scratch) / "job"
    job.with_suffix(".inp").write_text("\n".join(deck) + "\n")
    done = subprocess.run(["ccx", "job"], cwd=scratch, capture_output=True, text=True)
    totals = re.findall(r"time\s+(\S+)\s*\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", job.with_suffix(".dat").read_text())
    status = [line.split() for line in job.with_suffix(".sta").read_text().splitlines()[2:]]
if done.returncode or not totals or abs(float(totals[-1][0]) - (2 if scene.slide else 1)) > 1e-9:
    raise SystemExit("no equilibrium: " + " ".join(done.stdout.split())[-200:])
force = float(totals[-1][1 + (0 if scene.friction else upright)])
report(abs(force) * scene.fold / (THICK if scene.dim == 2 else 1), sum(len(u) * 3 if scene.dim == 3 else (u < count).sum() * 2 for u in used.values()),
       sum(int(s[3].rstrip("U")) for s in status if len(s) > 3), len(status))
