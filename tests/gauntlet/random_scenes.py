#!/usr/bin/env python3
"""Contact scenes drawn at random: one body is pressed on another, then slid, in the plane, round the axis or in space, with no contact setting.

    random_scenes.py [--space] [--adapt TOLERANCE] [--as-drawn] [--program bin/mortise] [--first SEED] [--number N] [--jobs N] [--seconds S] [--csv FILE] [--keep FOLDER]

Nobody can tune a program to them: another seed is another scene. Shapes, places, sizes of cells, orders, materials (rubber, metal, rigid), friction, depth, slide and steps are drawn; each is run as it is, with
its sides swapped and in half steps. What is judged holds for all of them:
  ok          exit 0; without friction and plastic flow the force in half steps is that in whole steps, or it was told that another state may be found
  WRONG       exit 0, but another force in half steps, and nothing said so
  failed, inaccurate, slow (more processor time than --seconds, 60): as in run.py
Exit status: 0 where every run is ok.
"""
import argparse
import collections
import concurrent.futures
import math
import os
import pathlib
import random
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import run as gauntlet  # noqa: E402

SAME = 1e-6  # of the largest force of the run: what different ways to one state may leave of it
TOLD = ("unstable", "recovery", "another")  # words of what says that there may be another state
VARIANTS = {"": "", "swapped": "swap", "half steps": "half"}


def lower(draw, axis):
    """The body below: its name, points, {edge: centre} of arcs, edges of its foot, of its top and on the axis (None: none)."""
    kind = draw.choice(["block", "hump", "dent", "step", "slope", "chamfer"])
    w, h = draw.uniform(1, 2), draw.uniform(0.4, 1)
    left = 0 if axis else -w
    if kind == "chamfer":
        r = draw.uniform(0.1, 0.3)
        points, arcs, top = [(left, -h), (w, -h), (w, -r), (w - r, 0), (left, 0)], {2: (w - r, -r)}, [1, 2, 3]
    elif kind == "step":
        s, m = draw.uniform(0.05, 0.2), draw.uniform(0.2, 0.8) * w
        points, arcs, top = [(left, -h), (w, -h), (w, -s), (m, -s), (m - 0.1 * s, 0), (left, 0)], {}, [2, 3, 4]
    elif kind in ("hump", "dent"):
        r, up = draw.uniform(2, 6), 1 if kind == "hump" else -1
        b = min(w, 0.9 * r)
        y = r - math.sqrt(r * r - b * b)
        points, arcs, top = [(0 if axis else -b, -h - y), (b, -h - y), (b, -up * y), (0, 0)], {2: (0, -up * r)}, [2]
        if not axis:
            points, arcs, top = points + [(-b, -up * y)], {2: (0, -up * r), 3: (0, -up * r)}, [2, 3]
    else:
        fall = draw.uniform(0.1, 0.4) if kind == "slope" else 0
        points, arcs, top = [(left, -h), (w, -h), (w, -fall * w), (left, -fall * left)], {}, [2]
    return kind, points, arcs, 0, top, len(points) - 1 if axis else None


def upper(draw, axis):
    """The body above, its lowest point at y = 0: as lower(), with the edge of its head and those of its skin."""
    kind = draw.choice(["block", "disc", "round", "wedge", "trapeze"])
    b, h = draw.uniform(0.3, 0.8), draw.uniform(0.4, 0.9)
    arcs = {}
    if kind == "disc":
        half, arcs = [(0, 0), (b, b)], {0: (0, b)}
    elif kind == "round":
        r = draw.uniform(0.05, 0.25)
        half, arcs = [(0, 0), (b - r, 0), (b, r), (b, h)], {1: (b - r, r)}
    elif kind == "wedge":
        s = draw.uniform(0.15, 1)
        half = [(0, 0), (b, s * b), (b, s * b + h)]
    else:
        half = [(0, 0), (b, 0), (b + (h * draw.uniform(-0.2, 0.3) if kind == "trapeze" else 0), h)]
    n = len(half)
    if axis:
        return kind, half + [(0, half[-1][1])], arcs, n - 1, list(range(n - 1)), n
    points = half + [(-x, y) for x, y in half[:0:-1]]
    arcs = {**arcs, **{2 * n - 2 - edge: (-x, y) for edge, (x, y) in arcs.items()}}
    return kind, points, arcs, n - 1, list(range(n - 1)) + list(range(n, 2 * n - 1)), None


def outline(points, arcs, edges):
    """Points along edges, so close that where bodies touch can be read from them."""
    found = []
    for edge in edges:
        (x1, y1), (x2, y2) = points[edge], points[(edge + 1) % len(points)]
        for s in (i / 200 for i in range(201)):
            x, y = x1 + s * (x2 - x1), y1 + s * (y2 - y1)
            if edge in arcs:  # shorter than half a turn
                cx, cy = arcs[edge]
                scale = math.hypot(x1 - cx, y1 - cy) / math.hypot(x - cx, y - cy)
                x, y = cx + scale * (x - cx), cy + scale * (y - cy)
            found.append((x, y))
    return found


def above(profile, x):
    """Height of a profile, points sorted by x, over x; far below beside it."""
    heights = [max(y1, y2) if x2 - x1 < 1e-9 else y1 + (y2 - y1) * (x - x1) / (x2 - x1) for (x1, y1), (x2, y2) in zip(profile, profile[1:]) if x1 <= x <= x2]
    return max(heights, default=-9)


def geometry(first, surface, points, arcs, size, place=lambda x, y: (x, y, 0)):
    """A surface of gmsh, placed in space; its edge i is curve first + i."""
    lines, n = [], len(points)
    for i, point in enumerate(points):
        lines.append(f"Point({first + i}) = {{{', '.join(f'{c:.12g}' for c in place(*point))}, {size}}};")
    for i in range(n):
        ends = first + i, first + (i + 1) % n
        if i in arcs:
            lines.append(f"Point({first + n + i}) = {{{', '.join(f'{c:.12g}' for c in place(*arcs[i]))}}}; Circle({first + i}) = {{{ends[0]}, {first + n + i}, {ends[1]}}};")
        else:
            lines.append(f"Line({first + i}) = {{{ends[0]}, {ends[1]}}};")
    return lines + [f"Curve Loop({surface}) = {{{first}:{first + n - 1}}}; Plane Surface({surface}) = {{{surface}}}; Recombine Surface {{{surface}}};"]


def prism(first, surface, points, arcs, size, turn, length):
    """A volume of gmsh: an outline in x and z drawn out along y by `length`, its middle at y = 0, then turned about z. Faces are side<surface>[2 + edge]."""
    c, s, layers = math.cos(turn), math.sin(turn), max(1, round(length / size))
    lines = geometry(first, surface, points, arcs, size, lambda x, z: (x * c + length / 2 * s, x * s - length / 2 * c, z))
    along = f"{-length * s:.12g}, {length * c:.12g}, 0"
    return ["Mesh.RecombinationAlgorithm = 2; // quads only"] + lines + [f"side{surface}[] = Extrude{{{along}}} {{ Surface{{{surface}}}; Layers{{{layers}}}; Recombine; }};"]


def material(draw):
    E = 10 ** draw.choice([0, 0, 0, 1, 2, 3, 5])
    kind = draw.random()
    if kind < 0.75:
        return f"law: neo_hookean, E: {E}, nu: {draw.choice([0, 0.3, 0.3, 0.4, 0.45, 0.49, 0.499])}"
    if kind < 0.85:
        return f"law: mooney_rivlin, c1: {0.15 * E:g}, c2: {0.05 * E:g}, kappa: {E * draw.choice([1, 10, 100])}"
    return f"law: j2, E: {E}, nu: 0.3, yield: {E * draw.choice([0.005, 0.01, 0.05]):g}, hardening: {E * draw.choice([0.01, 0.05]):g}"


def flat(draw):
    """Two bodies in the plane or round the axis: texts of gmsh, groups, the gap, what they are, the model."""
    axis = draw.random() < 0.3
    below, points, arcs, foot, top, side = lower(draw, axis)
    over, upoints, uarcs, head, skin, uside = upper(draw, axis)
    gap, shift = draw.choice([0, 0, 0.01, 0.03]), 0 if axis else draw.uniform(-0.4, 0.4)
    profile = sorted(outline(points, arcs, top))
    lift = gap - min(y - above(profile, x + shift) for x, y in outline(upoints, uarcs, skin))
    upoints, uarcs = [(x + shift, y + lift) for x, y in upoints], {edge: (x + shift, y + lift) for edge, (x, y) in uarcs.items()}
    geo = geometry(1, 1, points, arcs, draw.choice([0.08, 0.12, 0.2])) + geometry(101, 2, upoints, uarcs, draw.choice([0.08, 0.12, 0.2]))
    groups = {"foot": [1 + foot], "top": [1 + i for i in top], "head": [101 + head], "skin": [101 + i for i in skin], **({"axis": [1 + side, 101 + uside]} if axis else {})}
    geo += ['Physical Surface("low") = {1}; Physical Surface("up") = {2};'] + [f'Physical Curve("{name}") = {{{", ".join(map(str, curves))}}};' for name, curves in groups.items()]
    return geo, gap, f"{over} on {below}{', axisymmetric' if axis else ''}", "axisymmetric" if axis else "plane_strain"


def space(draw):
    """The same in space: outlines drawn out, the upper body turned about z and perhaps over the edge of the lower one."""
    below, points, arcs, foot, top, _ = lower(draw, False)
    over, upoints, uarcs, head, skin, _ = upper(draw, False)
    gap, shift, turn = draw.choice([0, 0, 0.01, 0.03]), draw.uniform(-0.4, 0.4), draw.choice([0, 0, math.pi / 2, draw.uniform(-1, 1)])
    width, length = draw.uniform(0.4, 1.6), draw.uniform(0.4, 1.2)
    profile = sorted(outline(points, arcs, top))
    ends = [(x * math.cos(turn) + sign * length / 2 * math.sin(turn) + shift, y) for x, y in outline(upoints, uarcs, skin) for sign in (-1, 0, 1)]
    lift = gap - min(y - above(profile, x) for x, y in ends)
    upoints, uarcs = [(x, y + lift) for x, y in upoints], {edge: (x, y + lift) for edge, (x, y) in uarcs.items()}
    geo = prism(1, 1, points, arcs, draw.choice([0.4, 0.6]), 0, width) + prism(101, 2, upoints, uarcs, draw.choice([0.4, 0.6]), turn, length)
    geo += [f"Translate{{{shift:.12g}, 0, 0}} {{ Volume{{side2[1]}}; }}", 'Physical Volume("low") = {side1[1]}; Physical Volume("up") = {side2[1]};']
    groups = {"foot": (1, [foot]), "top": (1, top), "head": (2, [head]), "skin": (2, skin)}
    geo += [f'Physical Surface("{name}") = {{{", ".join(f"side{body}[{2 + edge}]" for edge in edges)}}};' for name, (body, edges) in groups.items()]
    return geo, gap, f"{over} on {below}, turned by {turn:.2g}", "3d"


def scene(seed, dim):
    """Geometry and scene, texts; and what they are: a phrase, the step, whether the state depends on the way."""
    draw = random.Random(seed)
    geo, gap, what, model = (space if dim == 3 else flat)(draw)
    axis, up = model == "axisymmetric", "xyz"[dim - 1]
    order, rigid, friction = draw.choice([1, 2, 2, 2, 3] if dim == 2 else [1, 1, 2, 2]), draw.choice([None, None, None, "up", "low"]), draw.choice([0, 0, 0, 0.1, 0.3, 0.6])
    depth, slide, step = draw.uniform(0.02, 0.15), 0 if axis or draw.random() < 0.4 else draw.uniform(0.1, 1.2), draw.choice([0.1, 0.25, 0.5])
    laws = {"low": material(draw), "up": material(draw)}
    laws = {body: "law: rigid" if body == rigid else law for body, law in laws.items()}
    ways = {"x": f'"{slide:.4g}*max(0, t - 1)"', **({"y": f'"{slide * draw.uniform(-0.5, 0.5):.4g}*max(0, t - 1)"'} if dim == 3 else {}), up: f'"{-depth - gap:.4g}*min(t, 1)"'}
    motion = "{" + ", ".join(f"{c}: {way}" for c, way in ways.items()) + "}"
    held = {"axis": "{fix: x}"} if axis else {}
    held |= {} if rigid == "low" else {"foot": f"{{fix: {'xyz'[:dim]}}}"}
    held |= {} if rigid == "up" else {"head": f"{{displacement: {motion}}}"}
    what += f", order {order}, {f'rigid {rigid}, ' if rigid else ''}friction {friction}, depth {depth:.2g}, slide {slide:.2g}, steps {step}"
    text = [f"title: {seed}, {what}", "mesh: {file: scene.geo, order: 2}", f"model: {model}", f"order: {order}",
            f"body: {{low: {{material: low}}, up: {{material: up{f', motion: {motion}' if rigid == 'up' else ''}}}}}", "material:", *(f"  {body}: {{{law}}}" for body, law in laws.items()),
            "boundary:", *(f"  {name}: {value}" for name, value in held.items()), f"contact: {{c: {{nonmortar: skin, mortar: top{f', friction: {friction}' if friction else ''}}}}}",
            f"load: {{end: {2 if slide else 1}, step: {step}}}"]
    return "\n".join(geo) + "\n", "\n".join(text) + "\n", what, step, bool(friction or "j2" in "".join(laws.values()))


def solve(program, seed, dim, adapt, variants, seconds, keep):
    """The rows of one scene; none where gmsh finds no mesh."""
    geo, text, what, step, history = scene(seed, dim)
    table, states = [], {}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(keep, str(seed)) if keep else pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scene.geo").write_text(geo)
        (folder / "scene.yml").write_text(text)
        for variant, word in variants.items():
            options = {"swap": ["-contact_c_nonmortar", "top", "-contact_c_mortar", "skin"], "half": ["-load_step", str(step / 2)], "": []}[word]
            options += ["-adapt_tolerance", str(adapt)] if adapt else []
            directory = folder / (word or "given")
            directory.mkdir(exist_ok=True)
            code, said, used = gauntlet.execute(program, folder / "scene.yml", options, str(directory), seconds)
            if code == 1 and "gmsh" in said:
                return []
            s, h = gauntlet.read(directory)
            verdict, why = gauntlet.judge({}, options, code, said, s, h)
            if verdict == "ok":
                states[word] = s["contact"]["c"]["force"], max(row["contact_force"] for row in h), any(t in note for note in [*s["warnings"], said] for t in TOLD) or any(r["succeeded"] for r in s["recoveries"].values())
            table.append({"class": "random", "scene": seed, "variant": variant, "verdict": verdict, "exit": code, "t": s.get("t"), "steps": s.get("load_steps"), "newton": s.get("newton_iterations"),
                          "cuts": s.get("step_cuts"), "cells": s.get("cells"), "error": s.get("estimated_error"), "seconds": round(used, 2), "why": why or what})
    if not history and "" in states and "half" in states:
        (force, largest, told), (again, _, told_again) = states[""], states["half"]
        if math.dist(force, again) > max(SAME, adapt) * largest and not told and not told_again:
            table[-1].update(verdict="WRONG", why=f"forces {force} and {again}; {what}")
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default=os.environ.get("MORTISE", "bin/mortise"))
    parser.add_argument("--space", action="store_true", help="scenes in space")
    parser.add_argument("--adapt", type=float, default=0, help="tolerance of the error; default: no adaptation")
    parser.add_argument("--as-drawn", action="store_true", help="neither swapped nor in half steps")
    parser.add_argument("--first", type=int, default=1, help="seed of the first scene")
    parser.add_argument("--number", type=int, default=40, help="of scenes")
    parser.add_argument("--jobs", type=int, default=1, help="scenes at a time")
    parser.add_argument("--seconds", type=float, default=60, help="processor time a run may take")
    parser.add_argument("--csv", type=pathlib.Path, help="file to write the table to")
    parser.add_argument("--keep", help="folder for scenes and results; default: none is kept")
    a = parser.parse_args()
    program, table = os.path.abspath(a.program), []
    print(" ".join(key.ljust(width) for key, width in gauntlet.SHOWN.items()))
    with concurrent.futures.ProcessPoolExecutor(a.jobs) as pool:
        for rows in pool.map(solve, *zip(*((program, seed, 3 if a.space else 2, a.adapt, {"": ""} if a.as_drawn else VARIANTS, a.seconds, a.keep) for seed in range(a.first, a.first + a.number)))):
            table += rows
            for row in rows:
                print(gauntlet.line(row), flush=True)
    gauntlet.save(a.csv, table)
    count = collections.Counter(row["verdict"] for row in table)
    print(", ".join(f"{n} {verdict}" for verdict, n in count.most_common()) + f" of {len(table)} runs")
    return 0 if count["ok"] == len(table) else 1


if __name__ == "__main__":
    sys.exit(main())
