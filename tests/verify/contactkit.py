"""Scenes of two blocks for the cases of contact in the plane (scenes/blocks.geo), and what the cases read from a run."""
import pathlib
import re

import numpy

BLOCKS = pathlib.Path(__file__).resolve().parent / "scenes" / "blocks.geo"

# The mesh pairings of the patch tests: parameters of blocks.geo, and which side has one face refined once and its child again.
PAIRINGS = {
    "matching": ({"nl": 4, "nu": 4}, None),
    "two_to_three": ({"nl": 4, "nu": 6}, None),
    "hanging_lower": ({"nl": 4, "nu": 3}, "lower_top"),
    "hanging_upper": ({"nl": 4, "nu": 3}, "upper_bottom"),
}
SIDES = {"upper": ("upper_bottom", "lower_top"), "lower": ("lower_top", "upper_bottom")}  # by the side that carries the multiplier


def yaml(value):
    """Flow style, which is all a scene needs."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {yaml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(yaml, value)) + "]"
    if isinstance(value, str) and not re.fullmatch(r"[\w./-]+", value):
        return '"' + value + '"'
    return repr(value).lower() if isinstance(value, bool) else str(value)


def blocks(nonmortar, material, boundary, parameter, near=None, pair=None, **keys):
    """A scene: material {lower: {...}, upper: {...}}; near {name: {...}}: local refinement; pair: further keys of the contact pair."""
    scene = {"mesh": {"file": str(BLOCKS), "order": 1, "parameter": parameter}, "model": "plane_strain",
             "body": {name: {"material": name} for name in material}, "material": material, "boundary": boundary,
             "contact": {"pair": {"nonmortar": SIDES[nonmortar][0], "mortar": SIDES[nonmortar][1], "roles": "given", **(pair or {})}},
             "load": {"step": 1}, **keys}
    if near:
        scene["refine"] = near
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


def graded(boundary, x, y, levels):
    return {"spot": {"boundary": boundary, "x": x, "y": y, "levels": levels}}


def components(stress):
    """Columns xx, xy, yy of the stress of cells."""
    return stress[:, [0, 1, 3]]


def bulk(result):
    return result.states("bulk")[-1][1]


def surface(state, side):
    """One side of the contact grid of a state (0: nonmortar, 1: mortar), points and cells numbered anew."""
    cells = state["cells"].astype(int)
    keep = state["side"] == side
    points, number = numpy.unique(cells[keep], return_inverse=True)
    at_cells = ("pair", "side", "cell")
    part = {name: values[keep if name in at_cells else points] for name, values in state.items() if name != "cells"}
    return {**part, "cells": number.reshape(-1, cells.shape[1])}


def contact(result, side=0):
    return surface(result.states("contact")[-1][1], side)


def steps(result):
    """Newton residuals of each nonlinear solve, from -snes_monitor."""
    out = []
    for number, norm in re.findall(r"^ *(\d+) SNES Function norm (\S+)", result.stdout, re.M):
        if number == "0":
            out.append([])
        out[-1].append(float(norm))
    return out


def is_quadratic(norms):
    """The last three residuals fall as Newton's do, down to round-off: r2 / r0 <= C (r1 / r0)^2, all scaled by the first residual r0 after the predictor."""
    scale = norms[1]
    before, after = norms[-2] / scale, norms[-1] / scale
    return after <= max(100 * before**2, 1e-11)


def spread(values, expected):
    return float(numpy.max(numpy.abs(numpy.asarray(values) / expected - 1)))
