"""Structured meshes for cases, written as gmsh 2.2 ASCII: quadrilaterals or hexahedra on a lattice of parameters, mapped anywhere.

    write(path, [linspace(0, 1, 8), linspace(0, 1, 8)], to=lambda x, y: (x, y), order=1)

Several maps of the same lattice make several blocks, joined where their points coincide. Sides are named x0, x1, y0, y1 (z0, z1) after the parameters;
`side(name, centre, block)` may rename one of their facets (centre in parameters), drop it (None) or give it several names (a list); `body(centre, block)` names the body of a cell. ring, disc and sphere are maps for it.
"""
import itertools
import math

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


def write(path, breaks, to=lambda *x: x, order=1, side=lambda name, centre, block: name, body=lambda centre, block: "body"):
    dim, number = len(breaks), [len(b) - 1 for b in breaks]
    lattice = [fine(b, order) for b in breaks]
    points, elements, names, bodies = {}, [], {}, {}
    for block, map_ in enumerate(to if isinstance(to, list) else [to]):
        number_of = {}
        for index in itertools.product(*(range(len(x)) for x in lattice)):
            x = (tuple(map_(*(lattice[d][i] for d, i in enumerate(index)))) + (0, 0))[:3]
            number_of[index] = points.setdefault(tuple(round(c, 9) + 0.0 for c in x), (1 + len(points), x))[0]
        for cell in itertools.product(*map(range, number)):
            nodes = [number_of[tuple(order * c + p for c, p in zip(cell, place))] for place in places(dim, order)]
            name = body(tuple((breaks[d][i] + breaks[d][i + 1]) / 2 for d, i in enumerate(cell)), block)
            elements.append((TYPE[dim, order], bodies.setdefault(name, 101 + len(bodies)), nodes))
        for axis, high in itertools.product(range(dim), (0, 1)):
            others = [d for d in range(dim) if d != axis]
            for facet in itertools.product(*(range(number[d]) for d in others)):
                centre = [breaks[axis][-high]] * dim
                for d, i in zip(others, facet):
                    centre[d] = (breaks[d][i] + breaks[d][i + 1]) / 2
                group = side("xyz"[axis] + str(high), tuple(centre), block)
                nodes = []
                for place in places(dim - 1, order):
                    index = [high * (len(lattice[axis]) - 1)] * dim
                    for d, i, p in zip(others, facet, place):
                        index[d] = order * i + p
                    nodes.append(number_of[tuple(index)])
                for name in group if isinstance(group, list) else [group] * (group is not None):
                    elements.append((TYPE[dim - 1, order], names.setdefault(name, 1 + len(names)), nodes))
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % (len(bodies) + len(names)))
        for d, group in ((dim, bodies), (dim - 1, names)):
            file.writelines("%d %d \"%s\"\n" % (d, tag, name) for name, tag in group.items())
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(points))
        file.writelines("%d %.17g %.17g %.17g\n" % (n, *x) for n, x in points.values())
        file.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        file.writelines("%d %d 2 %d %d %s\n" % (i + 1, kind, tag, tag, " ".join(map(str, nodes))) for i, (kind, tag, nodes) in enumerate(elements))
        file.write("$EndElements\n")
    return path


# ---- maps ---------------------------------------------------------------------------------------------------------------------------

def ring(r, a, *z):
    """Radius and angle to the plane; a height is kept."""
    return (r * math.cos(a), r * math.sin(a), *z)


def disc(core=0.45):
    """Five blocks [0,1]^2 (x height) -> unit disc: a square of half width `core` in a ring of four; x1 is the rim in blocks 1 to 4."""
    def inside(a, b, *z):
        return (core * (2 * a - 1), core * (2 * b - 1), *z)

    def around(quarter):
        def to(a, b, *z):
            b = 2 * b - 1
            x, y = (1 - a) * core + a * math.cos(math.pi / 4 * b), (1 - a) * core * b + a * math.sin(math.pi / 4 * b)
            for _ in range(quarter):
                x, y = -y, x
            return (x, y, *z)
        return to

    return [inside] + [around(quarter) for quarter in range(4)]


def sphere():
    """Three blocks (radius, [0,1]^2) -> octant of a sphere; side y0 of block k lies in the plane of coordinate k+1, z0 in that of k+2 (cyclic)."""
    def patch(k):
        def to(r, a, b):
            direction = [1, math.tan(math.pi / 4 * a), math.tan(math.pi / 4 * b)]
            length = math.hypot(*direction)
            x = [0, 0, 0]
            for d in range(3):
                x[(k + d) % 3] = r * direction[d] / length
            return x
        return to

    return [patch(k) for k in range(3)]
