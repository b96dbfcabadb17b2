"""Structured meshes of quadrilaterals and hexahedra for the peers that bring no mesher: arrays of points, and cells as lattices of (order + 1)^dim of them.

`n` cells lie along an eighth of the circle, and as many along the block's height; `grade` > 0 draws cells of both bodies towards the first point of contact."""
import itertools

import numpy as np


def drawn(s, grade):
    return s if grade == 0 else np.expm1(grade * s) / np.expm1(grade)


class Mesh:
    def __init__(self, dim, order):
        self.dim, self.order, self.points, self.cells, self.count = dim, order, [], {}, 0

    def add(self, body, image, *cells):
        """A block of so many cells per direction; `image` takes arrays in [0, 1] to points. Points that coincide are merged by finish()."""
        axes = [np.arange(k * self.order + 1) / (k * self.order) for k in cells]
        points = image(*np.meshgrid(*axes, indexing="ij"))
        numbers = self.count + np.arange(points[..., 0].size).reshape(points.shape[:-1])
        self.count += numbers.size
        self.points.append(points.reshape(-1, self.dim))
        step = self.order
        lattices = [numbers[tuple(slice(e * step, e * step + step + 1) for e in cell)] for cell in itertools.product(*map(range, cells))]
        self.cells.setdefault(body, []).extend(lattices)

    def finish(self):
        """(points, {body: cells}); bodies share no points, every cell has a positive volume."""
        points, cells, first, kept = np.concatenate(self.points), {}, 0, []
        points[abs(points) < 1e-13] = 0
        for body, lattices in self.cells.items():
            lattices = np.array(lattices)
            used = np.unique(lattices)
            _, one, same = np.unique(np.round(points[used] * 1e8).astype(np.int64), axis=0, return_index=True, return_inverse=True)
            new = np.full(len(points), -1)
            new[used] = first + same.ravel()
            kept.append(points[used][one])
            first += len(one)
            cells[body] = new[lattices]
        points = np.concatenate(kept)
        for lattices in cells.values():
            corner = points[lattices[(slice(None),) + (0,) * self.dim]]
            edges = [points[lattices[(slice(None),) + tuple(-1 if k == axis else 0 for k in range(self.dim))]] - corner for axis in range(self.dim)]
            wrong = np.linalg.det(np.stack(edges, 1)) < 0
            lattices[wrong] = lattices[wrong][:, ::-1]
        return points, cells


def mix(t, a, b):
    return (1 - t)[..., None] * a + t[..., None] * b


def disc(mesh, body, n, grade, radius, centre, mirrored=False):
    """The lower right quarter (or both) of a disc, three blocks each."""
    O, A, B, C = (radius * np.array(p) for p in ((0, 0), (0, -0.5), (0.42, -0.42), (0.5, 0)))
    along, inward = lambda s: drawn(s, grade), lambda r: 1 - drawn(1 - r, grade)
    for sign in (1, -1) if mirrored else (1,):
        place = lambda p: np.array(centre) + p * np.array([sign, 1])
        arc = lambda angle: radius * np.stack([np.sin(angle), -np.cos(angle)], -1)
        mesh.add(body, lambda s, t: place(mix(1 - t, mix(along(s), A, B), mix(along(s), O, C))), n, n)
        mesh.add(body, lambda s, r: place(mix(inward(r), mix(along(s), A, B), arc(along(s) * np.pi / 4))), n, n)
        mesh.add(body, lambda t, r: place(mix(inward(r), mix(t, C, B), arc(np.pi / 2 - t * np.pi / 4))), n, n)


def ball(mesh, body, n, grade):
    """An eighth of a ball of radius 1 about (0, 0, 1), four blocks."""
    corner = {(0, 0, 0): (0, 0, 0), (1, 0, 0): (0.5, 0, 0), (0, 1, 0): (0, 0.5, 0), (0, 0, 1): (0, 0, 0.5),
              (1, 1, 0): (0.42, 0.42, 0), (1, 0, 1): (0.42, 0, 0.42), (0, 1, 1): (0, 0.42, 0.42), (1, 1, 1): (0.36, 0.36, 0.36)}
    along, inward, tangent = lambda s: drawn(s, grade), lambda r: 1 - drawn(1 - r, grade), lambda s: np.tan(s * np.pi / 4)

    def core(s, t, w):
        return sum(((s if k[0] else 1 - s) * (t if k[1] else 1 - t) * (w if k[2] else 1 - w))[..., None] * np.array(p) for k, p in corner.items())

    def shell(inside, direction, r):
        return mix(inward(r), inside, direction / np.linalg.norm(direction, axis=-1)[..., None])

    place = lambda p: np.array([0, 0, 1.0]) + p * np.array([1, 1, -1])
    one = np.ones_like
    mesh.add(body, lambda s, t, w: place(core(along(s), along(t), w)), n, n, n)
    mesh.add(body, lambda s, t, r: place(shell(core(along(s), along(t), one(s)), np.stack([tangent(along(s)), tangent(along(t)), one(s)], -1), r)), n, n, n)
    mesh.add(body, lambda t, w, r: place(shell(core(one(t), along(t), w), np.stack([one(t), tangent(along(t)), tangent(w)], -1), r)), n, n, n)
    mesh.add(body, lambda s, w, r: place(shell(core(along(s), one(s), w), np.stack([tangent(along(s)), one(s), tangent(w)], -1), r)), n, n, n)


def generate(scene, n, order, grade):
    """Mesh of a scene of scenes.py: bodies upper and lower."""
    mesh = Mesh(scene.dim, order)
    deep = lambda t: -scene.height * drawn(t, 1.15 * grade)
    if scene.dim == 3:
        ball(mesh, "upper", n, grade)
        mesh.add("lower", lambda s, t, w: np.stack([drawn(s, 1.15 * grade), drawn(t, 1.15 * grade), deep(w)], -1), n, n, n)
    else:
        disc(mesh, "upper", n, grade, 1, (0, 1), mirrored=not scene.half)
        left, wide = (0, 1) if scene.half else (-scene.width, 2 * scene.width)
        across = lambda s: drawn(s, 1.15 * grade)
        if not scene.half:
            across = lambda s: (1 + np.sign(s - 0.5) * drawn(abs(2 * s - 1), 1.15 * grade)) / 2
        mesh.add("lower", lambda s, t: np.stack([left + wide * across(s), deep(t)], -1), int(np.ceil(n * wide)), n)
    return mesh.finish()


def corners(cells):
    """Nodes of linear cells, counter-clockwise, the lower face first."""
    if cells.ndim == 3:
        return np.stack([cells[:, 0, 0], cells[:, -1, 0], cells[:, -1, -1], cells[:, 0, -1]], 1)
    return np.concatenate([corners(cells[..., 0]), corners(cells[..., -1])], 1)


def serendipity(cells):
    """Nodes of cells of order 2 without middles: corners, then edges."""
    if cells.ndim == 3:
        return np.concatenate([corners(cells), np.stack([cells[:, 1, 0], cells[:, 2, 1], cells[:, 1, 2], cells[:, 0, 1]], 1)], 1)
    edges = [serendipity(cells[..., 0])[:, 4:], serendipity(cells[..., 2])[:, 4:], corners(cells[..., 1])]
    return np.concatenate([corners(cells), *edges], 1)


def faces(cells, points, test):
    """(cell, face, lattice of nodes) of the faces of which `test` (of all points) holds; faces numbered from 0 in the order of Abaqus."""
    s = slice(None)
    cuts = [(s, 0), (-1, s), (s, -1), (0, s)] if cells.ndim == 3 else [(s, s, 0), (s, s, -1), (s, 0, s), (-1, s, s), (s, -1, s), (0, s, s)]
    on = test(points)
    return [(e, f, nodes) for f, cut in enumerate(cuts) for e, nodes in enumerate(cells[(s,) + cut]) if on[nodes].all()]


def on_arc(points):
    centre = np.zeros(points.shape[1])
    centre[-1] = 1
    return (abs(np.linalg.norm(points - centre, axis=1) - 1) < 1e-7) & (points[:, -1] < 1 + 1e-9)


def on_face(points):
    return abs(points[:, -1]) < 1e-9
