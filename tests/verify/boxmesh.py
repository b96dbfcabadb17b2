"""Structured meshes for cases, written as gmsh 2.2 ASCII: quadrilaterals or hexahedra on a lattice of parameters, mapped anywhere.

    write(path, [linspace(0, 1, 8), linspace(0, 1, 8)], to=lambda x, y: (x, y), order=1)

Sides are named x0, x1, y0, y1 (z0, z1) after the parameters; `side(name, centre)` may rename one of their facets (centre in parameters) or drop it (None).
"""
import itertools

# gmsh's numbering as places in the lattice of one cell, 0 .. order in each direction
CORNERS = {1: [(0,), (1,)], 2: [(0, 0), (1, 0), (1, 1), (0, 1)],
           3: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]}
GROUPS = {1: [(0, 1)], 2: [(0, 1), (1, 2), (2, 3), (3, 0), (0, 1, 2, 3)],
          3: [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7),
              (0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7), tuple(range(8))]}
TYPE = {(1, 1): 1, (1, 2): 8, (2, 1): 3, (2, 2): 10, (3, 1): 5, (3, 2): 12}


def places(dim, order):
    corner = [tuple(order * c for c in place) for place in CORNERS[dim]]
    if order == 1:
        return corner
    return corner + [tuple(sum(corner[v][d] for v in group) // len(group) for d in range(dim)) for group in GROUPS[dim]]


def linspace(low, high, n):
    return [low + (high - low) * i / n for i in range(n + 1)]


def fine(breaks, order):
    return [a + (b - a) * k / order for a, b in zip(breaks, breaks[1:]) for k in range(order)] + [breaks[-1]]


def write(path, breaks, to=lambda *x: x, order=1, side=lambda name, centre: name, body="body"):
    dim, number = len(breaks), [len(b) - 1 for b in breaks]
    lattice = [fine(b, order) for b in breaks]
    size = [len(x) for x in lattice]

    def node(index):
        return 1 + sum(i * stride for i, stride in zip(index, (1, size[0], size[0] * size[1])))

    points = {node(index): tuple(to(*(lattice[d][i] for d, i in enumerate(index)))) for index in itertools.product(*map(range, size))}
    elements, names = [], {}
    for cell in itertools.product(*map(range, number)):
        elements.append((TYPE[dim, order], 1, [node([order * c + p for c, p in zip(cell, place)]) for place in places(dim, order)]))
    for axis in range(dim):
        others = [d for d in range(dim) if d != axis]
        for high in (0, 1):
            for facet in itertools.product(*(range(number[d]) for d in others)):
                centre = [0] * dim
                centre[axis] = breaks[axis][-high]
                for d, i in zip(others, facet):
                    centre[d] = (breaks[d][i] + breaks[d][i + 1]) / 2
                name = side("xyz"[axis] + str(high), tuple(centre))
                if name is None:
                    continue
                nodes = []
                for place in places(dim - 1, order):
                    index = [0] * dim
                    index[axis] = high * (size[axis] - 1)
                    for d, i, p in zip(others, facet, place):
                        index[d] = order * i + p
                    nodes.append(node(index))
                elements.append((TYPE[dim - 1, order], names.setdefault(name, 2 + len(names)), nodes))
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n%d 1 \"%s\"\n" % (1 + len(names), dim, body))
        file.writelines("%d %d \"%s\"\n" % (dim - 1, tag, name) for name, tag in names.items())
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(points))
        file.writelines("%d %.17g %.17g %.17g\n" % (n, *(x + (0, 0))[:3]) for n, x in points.items())
        file.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        file.writelines("%d %d 2 %d %d %s\n" % (i + 1, kind, tag, tag, " ".join(map(str, nodes))) for i, (kind, tag, nodes) in enumerate(elements))
        file.write("$EndElements\n")
    return path
