"""Two blocks of hexahedra for cases of contact in space, written as gmsh 2.2 ASCII: lattices of their own, mapped anywhere, faces named x0_lower ... z1_upper.

    write(path, {"lower": (breaks, to), "upper": (breaks, to)}, rename={"lower_top": ("lower", "z1", inside)})
"""
import itertools
import math
import random

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def linspace(low, high, n):
    return [low + (high - low) * i / n for i in range(n + 1)]


def same(x, y, z):
    return x, y, z


def turn(degrees):
    """Rotation about x, then y, then z."""
    a = [math.radians(d) for d in degrees]

    def to(*x):
        x = list(x)
        for axis in range(3):
            i, j = (axis + 1) % 3, (axis + 2) % 3
            c, s = math.cos(a[axis]), math.sin(a[axis])
            x[i], x[j] = c * x[i] - s * x[j], s * x[i] + c * x[j]
        return tuple(x)

    return to


def distorted(breaks, amount, seed, to=same):
    """The columns of a lattice moved across by up to `amount` cells, those on the sides along them only, corners not: facets are no parallelograms."""
    rng = random.Random(seed)
    shift = {}
    for i, j in itertools.product(range(len(breaks[0])), range(len(breaks[1]))):
        at = (breaks[0][i], breaks[1][j])
        move = [0.0, 0.0]
        for d, k in enumerate((i, j)):
            inside = 0 < k < len(breaks[d]) - 1
            move[d] = amount * rng.uniform(-1, 1) * (breaks[d][1] - breaks[d][0]) if inside else 0.0
        shift[at] = move

    def moved(x, y, z):
        dx, dy = shift[(x, y)]
        return to(x + dx, y + dy, z)

    return moved


def write(path, blocks, more=lambda block, side, centre: ()):
    """more(block, side, centre): further names of a facet of a side (x0 ... z1), centre on the lattice."""
    points, elements, volumes, surfaces = [], [], {}, {}
    for block, (breaks, to) in blocks.items():
        size = [len(b) for b in breaks]
        first = len(points)

        def node(index):
            return first + 1 + (index[0] * size[1] + index[1]) * size[2] + index[2]

        points += [to(*(breaks[d][i] for d, i in enumerate(index))) for index in itertools.product(*map(range, size))]
        volumes[block] = len(volumes) + 1
        for cell in itertools.product(*(range(n - 1) for n in size)):
            elements.append((5, volumes[block], [node([c + p for c, p in zip(cell, corner)]) for corner in CORNERS]))
        for axis, high in itertools.product(range(3), (0, 1)):
            others = [d for d in range(3) if d != axis]
            for facet in itertools.product(*(range(size[d] - 1) for d in others)):
                nodes, centre = [], [breaks[axis][-high]] * 3
                for corner in SQUARE:
                    index = [high * (size[axis] - 1)] * 3
                    for d, i, p in zip(others, facet, corner):
                        index[d] = i + p
                        centre[d] = (breaks[d][i] + breaks[d][i + 1]) / 2
                    nodes.append(node(index))
                side = "xyz"[axis] + str(high)
                for name in (side + "_" + block, *more(block, side, centre)):
                    elements.append((3, surfaces.setdefault(name, 10 + len(surfaces)), nodes))
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % (len(volumes) + len(surfaces)))
        file.writelines('%d %d "%s"\n' % (dim, tag, name) for dim, names in ((3, volumes), (2, surfaces)) for name, tag in names.items())
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(points))
        file.writelines("%d %.17g %.17g %.17g\n" % (n + 1, *x) for n, x in enumerate(points))
        file.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        file.writelines("%d %d 2 %d %d %s\n" % (i + 1, kind, tag, tag, " ".join(map(str, nodes))) for i, (kind, tag, nodes) in enumerate(elements))
        file.write("$EndElements\n")
    return path
