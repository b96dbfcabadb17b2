#!/usr/bin/env python3
"""Figures of scenes.json that have a closed form, from the data of the scenes: `closed_forms.py` prints them, tests/verify/test_gauntlet.py compares them with scenes.json.

Material: W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2 (volumetric: log); a is the stretch along the load, b the one across, P the nominal stress along the load.
"""
import math


def root(f, low, high):
    """The zero of f between low and high, by bisection."""
    sign = f(low) > 0
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (f(middle) > 0) == sign else (low, middle)
    return 0.5 * (low + high)


def lame(E, nu):
    return E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))


def stress(a, J, E, nu):
    """Nominal stress where the stretch is a and the change of volume J."""
    mu, lam = lame(E, nu)
    return mu * (a - 1 / a) + lam * math.log(J) / a


def confined(a, E, nu):
    """Uniaxial strain."""
    return stress(a, a, E, nu)


def free(a, E, nu, sides):
    """Uniaxial stress: `sides` directions across are free of stress (plane strain: 1, in space: 2)."""
    b = root(lambda b: stress(b, a * b**sides, E, nu), 0.3, 3)
    return stress(a, a * b**sides, E, nu)


def stacked(heights, laws, shortening):
    """Nominal stress of confined blocks, one on the other, that together are shortened."""
    def shorter(P):
        return sum(h * (1 - root(lambda a: confined(a, *law) - P, 0.02, 1)) for h, law in zip(heights, laws)) - shortening

    return root(shorter, confined(0.03, *min(laws)), 0)


def shrink(r, E, nu):
    """Displacement of the outer rim of a hub (radii r[2] at rest, r[3]) shrunk on a shaft (r[0], r[1]), axial strain 0: Lame. Pressures on the two faces carry the same force."""
    def widening(p_inner, r_inner, p_outer, r_outer, E, nu, at):
        """Radial displacement of a tube under pressures inside and outside."""
        d = r_outer**2 - r_inner**2
        uniform, hoop = (p_inner * r_inner**2 - p_outer * r_outer**2) / d, (p_inner - p_outer) * r_inner**2 * r_outer**2 / d
        return (1 + nu) / E * ((1 - 2 * nu) * uniform * at + hoop / at)

    hub = widening(1, r[2], 0, r[3], E[1], nu[1], r[2])
    shaft = widening(0, r[0], r[2] / r[1], r[1], E[0], nu[0], r[1])
    p = (r[1] - r[2]) / (hub - shaft)
    return widening(p, r[2], 0, r[3], E[1], nu[1], r[3])


def upset(area, rounded_off, height, plane_strain):
    """Force on a billet upset to `height` (1 at rest) without friction: all of it yields alike, its rounded edge has become flat."""
    factor = 2 / math.sqrt(3) if plane_strain else 1
    return factor * (4 + 3 * factor * math.log(1 / height)) * (area - rounded_off) / height


def ring(radii, pressures, E, nu):
    """u = A r + B / r of a ring in plane strain, small strains, under pressures inside and outside: A, B."""
    (a, b), (p, q), (mu, lam) = radii, pressures, lame(E, nu)
    return (p * a**2 - q * b**2) / (b**2 - a**2) / (2 * (lam + mu)), (p - q) * a**2 * b**2 / (b**2 - a**2) / (2 * mu)


def glued_rings(a, b, c, laws):
    """Displacement of the bore under pressure 1, of two rings glued to each other at the radius b."""
    def apart(q):
        (A, B), (C, D) = ring((a, b), (1, q), *laws[0]), ring((b, c), (q, 0), *laws[1])
        return (A - C) * b + (B - D) / b

    A, B = ring((a, b), (1, root(apart, 0, 1)), *laws[0])
    return A * a + B / a


EDGE = (1 - math.pi / 4) * 0.15**2  # what is missing at the rounded edge
FIGURES = {
    "sunk": -1.2 * stacked((1, 0.7), ((6, 0.3), (2, 0.2)), 0.2),
    "sunk_deep": -1.2 * stacked((1, 0.7), ((6, 0.3), (2, 0.2)), 0.45),
    "sunk_through": -1.2 * stacked((1, 0.7), ((6, 0.3), (2, 0.2)), 0.62),
    "sunk3d": -0.99 * stacked((0.8, 0.6), ((3, 0.25), (5, 0.3)), 0.25),
    "box": -1.2 * confined(0.85, 1, 0.3),
    "vee": -stress(0.9, 0.9 * 0.95, 1, 0.3),
    "half_patch": -0.8 * free(1 - 0.2 / 0.9, 3, 0.3, 1),
    "cylinder": -math.pi * 0.8**2 * free(1 - 0.2 / 0.9, 3, 0.3, 2),
    "quarter_patch": -0.7 * 0.9 * free(0.8, 3, 0.3, 2),
    "layers": -stacked((0.5, 0.8), ((1e5, 0.3), (1, 0.3)), 0.3),
    "layers_soft_below": -stacked((0.5, 0.8), ((1, 0.3), (1e5, 0.3)), 0.3),
    "stack": -stacked((0.4, 0.5, 0.6), ((1, 0), (100, 0), (1e5, 0)), 0.12),
    "wedge_under": 0.75 * math.tan(math.radians(10)),
    "wedge_rub": 0.75 * (math.tan(math.radians(10) + math.atan(0.2)) + 0.2),
    "belt": 0.5 * math.exp(0.2 * math.pi / 2),
    "rigid3d": -0.6 * 0.5 * free(0.7, 4, 0.25, 2),
    "ratio": -free(1 - 0.25 / 1.1, 2, 0.35, 1),
    "ratio3d": -free(0.8, 2, 0.35, 2),
    "shrink": shrink((0.5, 1, 0.98, 2), (210, 70), (0.3, 0.33)),
    "upset_strip": upset(1, EDGE, 0.85, True),
    "glue_rings": glued_rings(1, 1.5, 2, ((10, 0.3), (1, 0.3))),
    "tied_wall": -stacked((0.6, 0.5), ((1, 0.3), (3, 0.3)), 0.2),
    "tied_wall3d": -0.6 * stacked((0.5, 0.5), ((1, 0.3), (3, 0.3)), 0.2),
    "glue_axi": -math.pi * free(0.8, 1, 0.3, 2),
    "four3d": -free(0.8, 1, 0.3, 2),
    "shrink_reversed": shrink((0.5, 1, 0.98, 2), (70, 210), (0.33, 0.3)),
}

if __name__ == "__main__":
    for name, value in FIGURES.items():
        print(f"{name:20} {value:.12g}")
