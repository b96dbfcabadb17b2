"""The small picture of a row of docs/stability.md, from what the runs of its test left: both last states, iterations over the load, or curves that the test hands over."""
import importlib.machinery
import importlib.util
import io
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST = 20000  # bytes
SIDES = ("as it is", "the other way")


def script(name):
    """A file of scripts/ without an ending, as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(ROOT / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


plot = script("plot")
sys.path.insert(0, str(ROOT / "python"))
import mortise  # noqa: E402


def state(directory):
    """The last state of a run; None: it has none."""
    run = mortise.Run(directory)
    return run.state() if "bulk" in run.names() else None


def skin(bulk):
    """Faces of cells in space that no other cell has, their owners, and the value of each."""
    faces = np.concatenate([bulk.cells[:, f] for f in plot.HEX_FACES])
    outside = plot.used_once(plot.merged_points(bulk)[faces])
    owner = np.concatenate([len(plot.HEX_FACES) * plot.leaf_numbers(bulk) + side for side in range(len(plot.HEX_FACES))])
    return faces[outside], owner[outside], outside


def panel(axes, bulk, field, limits, solved=True):
    """The deformed mesh, coloured; of a run without a state the mesh alone."""
    x, values = bulk.X + solved * bulk.point["displacement"], bulk.at_corners(field).mean(axis=1)
    shade = plt.get_cmap("viridis")(plt.Normalize(*limits)(values)) if solved else np.ones((len(values), 4))
    if bulk.cells.shape[1] == 8:
        faces, owner, outside = skin(bulk)
        x, (edges, _) = x @ plot.view().T, plot.outline(faces, owner)
        order = np.argsort(x[faces][:, :, 2].mean(axis=1))
        axes.add_collection(PolyCollection(x[faces][order][:, :, :2], facecolors=np.tile(shade, (len(plot.HEX_FACES), 1))[outside][order], edgecolors="0.3", linewidths=0.2))
    else:
        axes.add_collection(PolyCollection(x[bulk.cells][:, :, :2], facecolors=shade, edgecolors="face", linewidths=0.2, rasterized=True))
        edges = plot.outline(bulk.cells, plot.leaf_numbers(bulk))[0]
        axes.add_collection(LineCollection(x[edges][:, :, :2], colors="black", linewidths=max(0.05, min(0.4, 8 / np.sqrt(len(bulk.cells))))))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()


def states(axes, runs, field):
    """Both last states in one scale of colours, that of what is right."""
    found = [state(run.directory) for run in runs]
    known = [bulk for bulk in found if bulk is not None]
    ranges = [(np.nanmin(bulk.value(field)), np.nanmax(bulk.value(field))) for bulk in known]
    even = ranges and np.ptp(ranges[0]) < 1e-6 * np.abs(ranges).max()  # then the other way says what there is to see
    limits = plot.colour_range(np.array(ranges[-1 if even else 0])) if known else (0, 1)
    for side, bulk, run, name in zip(axes, found, runs, SIDES):
        panel(side, known[0] if bulk is None else bulk, field, limits, bulk is not None)
        side.set_title(f"{name}: gives up at t = 0" if bulk is None else f"{name}, t = {run.summary['t']:.3g}{'' if run.solved else ': gives up'}", fontsize=8)
    for end in ("xlim", "ylim"):  # one scale of lengths, too
        ends = np.array([getattr(side, f"get_{end}")() for side in axes])
        for side in axes: side.set(**{end: (ends.min(), ends.max())})


def iterations(axes, runs):
    """Newton iterations so far over the load; a run that ends before goes straight up there."""
    for run, name, mark in zip(runs, SIDES, ("C0.-", "C3.-")):
        rows, summary = run.history, run.summary
        t, n = [0] + [row["t"] for row in rows], np.cumsum([0] + [row["newton_iterations"] for row in rows])
        axes.plot(t + [summary["t"]], list(n) + [max(n[-1], summary["newton_iterations"])], mark, label=name + ("" if run.solved else ": ends there"), linewidth=1, markersize=3)
    axes.set_xlabel("t", fontsize=8)
    axes.set_ylabel("Newton iterations", fontsize=8)


def bars(axes, drawn):
    """A figure of both, where neither state nor way tells them apart."""
    for at, (value, colour) in enumerate(zip(drawn["values"], ("C0", "C3"))):
        axes.barh(-at, value, color=colour, height=0.6)
    axes.set_yticks((0, -1), SIDES)
    axes.set_xlabel(drawn["x"], fontsize=8)


def curves(axes, drawn):
    """{"x": label, "y": label, "lines": {name: (x, y)}}, of which the last is the other way."""
    for k, (name, (x, y)) in enumerate(drawn["lines"].items()):
        axes.plot(x, y, "C3.-" if k == len(drawn["lines"]) - 1 else ("C0.-", "C2.-", "k-")[k], label=name, linewidth=1, markersize=3)
    axes.set_xlabel(drawn["x"], fontsize=8)
    axes.set_ylabel(drawn["y"], fontsize=8)
    if drawn.get("log"): axes.set_yscale("log")


def draw(path, runs, what):
    """what: {"kind": states | iterations | bars | curves, ...}. In few colours, and smaller where it would be more than MOST bytes."""
    from PIL import Image

    kind = what.get("kind", "states")
    figure, axes = plt.subplots(1, 2 if kind == "states" else 1, figsize=(4.2, 1.7), layout="constrained", squeeze=False)
    if kind == "states": states(axes[0], runs, what.get("field", "von_mises"))
    else:
        if kind == "iterations": iterations(axes[0, 0], runs)
        else: {"bars": bars, "curves": curves}[kind](axes[0, 0], what)
        if kind != "bars": axes[0, 0].legend(fontsize=7, frameon=False)
        axes[0, 0].tick_params(labelsize=7)
        axes[0, 0].grid(linewidth=0.3)
    for dpi, colours in ((110, 64), (110, 24), (80, 16), (60, 12)):
        page, out = io.BytesIO(), io.BytesIO()
        figure.savefig(page, dpi=dpi)
        Image.open(page).convert("RGB").quantize(colours, dither=Image.Dither.NONE).save(out, "PNG", optimize=True)
        if len(out.getvalue()) <= MOST: break
    plt.close(figure)
    path.write_bytes(out.getvalue())
