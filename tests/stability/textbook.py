"""Textbook methods that the program has no switch for, in a few lines each."""
import math

import numpy as np


def averaged_normals(n, R=1.0, depth=0.1):
    """Half a polygon of 2n chords round a circle, and the whole one, pressed on a plane by springs at its nodes along the averaged normals of the facets beside each. In the
    half the node on the plane of symmetry has one facet only, and its normal leans by half the angle of a chord. Vertical forces: of half, twice; of the whole."""
    def force(angles):
        x = R * np.stack([np.sin(angles), -np.cos(angles)], axis=1)
        edge = np.diff(x, axis=0)
        facet = np.stack([edge[:, 1], -edge[:, 0]], axis=1)  # outward, as long as the facet
        normal, weight = np.zeros_like(x), np.zeros(len(x))
        for side in (slice(None, -1), slice(1, None)):
            normal[side] += facet
            weight[side] += np.linalg.norm(edge, axis=1) / 2
        lean = normal[:, 1] / np.linalg.norm(normal, axis=1)
        return weight @ (np.maximum(0, -(R - depth) - x[:, 1]) * lean ** 2)  # overlap along the normal, and the vertical part of its force
    step = math.pi / 2 / n
    return 2 * force(np.arange(n + 1) * step), force(np.arange(-n, n + 1) * step)


def smoothed_friction(share, mu=0.8):
    """Coulomb's law smoothed over a velocity v0, T = mu p tanh(v / v0): the velocity / v0 at which a block creeps down an incline of `share` of the angle of friction."""
    return math.atanh(min(1, math.tan(share * math.atan(mu)) / mu))


def stiffness(nx, ny, w, h, E, nu):
    """Plane strain, bilinear cells on nx x ny of a box: (matrix, positions)."""
    lam, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)
    D = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
    a, b, ke = w / nx, h / ny, np.zeros((8, 8))
    for s in (-3 ** -0.5, 3 ** -0.5):
        for t in (-3 ** -0.5, 3 ** -0.5):
            dx = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) / 2 / a
            dy = np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) / 2 / b
            B = np.zeros((3, 8))
            B[0, ::2], B[1, 1::2], B[2, ::2], B[2, 1::2] = dx, dy, dy, dx
            ke += B.T @ D @ B * a * b / 4
    K = np.zeros((2 * (nx + 1) * (ny + 1),) * 2)
    for j in range(ny):
        for i in range(nx):
            c = [i + j * (nx + 1), i + 1 + j * (nx + 1), i + 1 + (j + 1) * (nx + 1), i + (j + 1) * (nx + 1)]
            at = np.ravel([(2 * n, 2 * n + 1) for n in c])
            K[np.ix_(at, at)] += ke
    return K


def friction_in_turn(mu, n=8, passes=12, E=1.0, nu=0.3, press=0.05):
    """A block (2 : 1) pressed on a rigid plane and drawn along it, all of its foot slipping: the bound of friction is taken from the pressures of the pass before (contact and
    friction in turn). Sums of the normal force by passes, and the factor by which a pass changes what the one before was off."""
    K = stiffness(2 * n, n, 2.0, 1.0, E, nu)
    foot, top = np.arange(2 * n + 1), np.arange(n * (2 * n + 1), (n + 1) * (2 * n + 1))
    held = np.concatenate([2 * top, 2 * top + 1, 2 * foot + 1])
    u = np.zeros(len(K))
    u[2 * top + 1] = -press
    free = np.setdiff1d(np.arange(len(K)), held)
    inverse = np.linalg.inv(K[np.ix_(free, free)])

    def forces(pressure):
        f = np.zeros(len(K))
        f[2 * foot] = -mu * pressure
        u[free] = inverse @ (f[free] - K[np.ix_(free, held)] @ u[held])
        return (K @ u)[2 * foot + 1]

    found, pressure = [], np.zeros(len(foot))
    off = []
    for _ in range(passes):
        new = forces(pressure)
        off.append(np.linalg.norm(new - pressure))
        found.append(new.sum())
        pressure = new
    return found, off[-1] / off[-2]
