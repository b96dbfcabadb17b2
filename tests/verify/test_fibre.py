"""Walls with fibres (law hgo): strips (O-20) and the inflation and extension of a two-layer artery (O-21)."""
import math

import numpy
import pytest

from test_bulk_homogeneous import block, close

MEDIA = {"c": 3.0, "k1": 2.3632, "k2": 0.8393}, 29
ADVENTITIA = {"c": 0.3, "k1": 0.5620, "k2": 0.7112}, 62


def wall(layer, fiber, ratio=1e5, **keys):
    return {"law": "hgo", **layer[0], "kappa": ratio * layer[0]["c"], "volumetric": "simo", "fiber": fiber, **keys}


# ---- O-20: strips -------------------------------------------------------------------------------------------------------------------

STRIPS = [  # layer, pulled along x (around the artery) or y (along it), stretch; lateral stretch in the plane, in thickness, nominal stress
    ("media", MEDIA, 0, 1.2, .868522053, .959484368, 3.881186974),
    ("media", MEDIA, 0, 1.4, .745590100, .958013947, 11.131809925),
    ("media", MEDIA, 1, 1.2, .912870929, .912870929, 1.516666667),  # slack: the ground substance alone
    ("media", MEDIA, 1, 1.4, .842987842, .847326235, 2.674827556),
    ("adventitia", ADVENTITIA, 1, 1.2, .828082644, 1.006340780, .714052548),
    ("adventitia", ADVENTITIA, 1, 1.4, .680441591, 1.049738470, 2.234018437),
]
BIAXIAL = [(1.2, 1.2, 6.885964041, 3.774448676), (1.3, 1.1, 9.947511713, 3.831984774)]
HELD = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}}


def strip(layer, ratio):
    c, s = math.cos(math.radians(layer[1])), math.sin(math.radians(layer[1]))
    return wall(layer, {"a": {"direction": {"x": c, "y": s}}, "b": {"direction": {"x": 2 * c, "y": -2 * s}}}, ratio)


def stress(layer, ratio, stretch):
    """Nominal stresses of a strip of finite bulk modulus, from the energy by hand: no tensors."""
    law, J = layer[0], math.prod(stretch)
    square = [math.cos(math.radians(layer[1])) ** 2, math.sin(math.radians(layer[1])) ** 2, 0]
    I1, I4, bar = sum(s * s for s in stretch), sum(m * s * s for m, s in zip(square, stretch)), J ** (-2 / 3)
    E = max(bar * I4 - 1, 0)
    slope = 2 * law["k1"] * E * math.exp(law["k2"] * E * E)  # both families
    return [ratio * law["c"] / 2 * (J - 1 / J) * J / s + law["c"] * bar * (s - I1 / (3 * s)) + slope * bar * (2 * m * s - 2 * I4 / (3 * s))
            for m, s in zip(square, stretch)]


def answer(layer, ratio, given, start):
    """(stretches, nominal stresses) where those not given are free; Newton's method with differences from those of the table."""
    x = numpy.array([given.get(i, start.get(i, 0)) for i in range(3)])
    free = [i for i in range(3) if i not in given]
    if not x.all():
        x[2] = 1 / (x[0] * x[1])
    for _ in range(20):
        step = 1e-7 * numpy.identity(3)[free]
        slope = [(numpy.array(stress(layer, ratio, x + h)) - stress(layer, ratio, x - h))[free] / 2e-7 for h in step]
        x[free] -= numpy.linalg.solve(numpy.transpose(slope), numpy.array(stress(layer, ratio, x))[free])
    return x, stress(layer, ratio, x)


def pull(run, tmp_path, layer, ratio, given, order):
    """(stretches, nominal stresses of the given directions) of a unit block."""
    pulled = {"xyz"[i] + "1": {"displacement": {"xyz"[i]: value - 1}} for i, value in given.items()}
    s = block(run, tmp_path, 3, strip(layer, ratio), {**HELD, **pulled}, order=order)
    return [1 + u for u in s["probe"]["corner"]["displacement"]], {i: s["reaction"]["xyz"[i] + "1"][i] for i in given}


CASES = [pytest.param(layer, {along: stretch}, {1 - along: lateral, 2: thickness}, {along: nominal}, id=f"{name}-{'xy'[along]}-{stretch}")
         for name, layer, along, stretch, lateral, thickness, nominal in STRIPS]
CASES += [pytest.param(MEDIA, {0: x, 1: y}, {}, {0: P, 1: Q}, id=f"media-{x}-{y}") for x, y, P, Q in BIAXIAL]


@pytest.mark.parametrize("layer, given, stretch, nominal", CASES)
def test_o20_strip(run, tmp_path, layer, given, stretch, nominal):
    """The incompressible table at kappa = 1e7 c, where the bulk modulus is no longer seen; the strip of kappa = 1e5 c, which differs from it by up to
    6e-5, to the digits of its own solution."""
    stretches, stresses = pull(run, tmp_path, layer, 1e7, given, 1)
    for i, value in stretch.items():
        close(stretches[i], value, 1e-5)
    for i, value in nominal.items():
        close(stresses[i], value, 1e-5)
    stretches, stresses = pull(run, tmp_path, layer, 1e5, given, 2)
    exact = answer(layer, 1e5, given, stretch)
    for i in range(3):
        close(stretches[i], exact[0][i], 1e-8)
    for i in given:
        close(stresses[i], exact[1][i], 1e-8)
