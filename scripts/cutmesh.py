"""Half of a mesh that is symmetric about a plane: used by scripts/simplify."""
import math
import pathlib
import subprocess

CORNERS = {1: 2, 8: 2, 26: 2, 27: 2, 28: 2, 2: 3, 9: 3, 21: 3, 23: 3, 25: 3, 3: 4, 10: 4, 36: 4, 37: 4, 38: 4, 16: 4, 4: 4, 11: 4, 29: 4, 30: 4, 31: 4,
           5: 8, 12: 8, 92: 8, 93: 8, 94: 8, 17: 8}  # gmsh's types of elements
DIM = {2: 1, 3: 2, 4: 2, 8: 3}
TETRA = (4, 11, 29, 30, 31)
FACETS = {(2, 3): [(0, 1), (1, 2), (2, 0)], (2, 4): [(0, 1), (1, 2), (2, 3), (3, 0)], (3, 4): [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)],
          (3, 8): [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}
LINEAR = {2: 1, 3: 2, 4: 3}


def dimension(kind):
    return 3 if kind in TETRA else DIM[CORNERS[kind]]


def make(geometry, dim, order, parameters, path):
    """gmsh on a .geo; a .msh is written anew in the same format."""
    command = ["gmsh", str(geometry), f"-{dim}" if pathlib.Path(geometry).suffix == ".geo" else "-0", "-order", str(order), "-format", "msh22", "-v", "2", "-nt", "1", "-o", str(path)]
    for name, value in parameters.items(): command += ["-setnumber", name, str(value)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode: raise SystemExit(f"simplify: gmsh fails on {geometry}: {done.stderr.strip()}")


# Facets of a hexahedron with their nodes between: gmsh's numbers, corners first (types 5, 12 and 17).
EDGES = {frozenset(pair): 8 + i for i, pair in enumerate([(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)])}
MIDDLES = {frozenset(face): 20 + i for i, face in enumerate([(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7)])}


def face(kind, nodes, corners):
    """(kind, nodes) of a facet of a hexahedron by its corners."""
    at = [nodes[i] for i in corners]
    if kind == 5: return 3, at
    at += [nodes[EDGES[frozenset((corners[i - 1], corners[i]))]] for i in (1, 2, 3, 0)]
    return (16, at) if kind == 17 else (10, at + [nodes[MIDDLES[frozenset(corners)]]])


def read(path):
    """Names of groups, nodes and elements of a .msh 2.2: [(dim, number, name)], {number: [x, y, z]}, [(kind, group, nodes)]."""
    lines = iter(pathlib.Path(path).read_text().splitlines())
    names, nodes, elements = [], {}, []
    for line in lines:
        if line == "$PhysicalNames":
            for _ in range(int(next(lines))):
                dim, number, name = next(lines).split(maxsplit=2)
                names.append((int(dim), int(number), name.strip('"')))
        elif line == "$Nodes":
            for _ in range(int(next(lines))):
                number, *x = next(lines).split()
                nodes[int(number)] = [float(v) for v in x]
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                _, kind, tags, group, *rest = map(int, next(lines).split())
                elements.append((kind, group, rest[tags - 1:]))
    return names, nodes, elements


def write(path, names, nodes, elements):
    used = {n for _, _, at in elements for n in at}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{dim} {number} "{name}"' for dim, number, name in names] + ["$EndPhysicalNames", "$Nodes", str(len(used))]
    lines += [f"{n} {' '.join(f'{v:.17g}' for v in nodes[n])}" for n in sorted(used)] + ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{i} {kind} 2 {group} {group} {' '.join(map(str, at))}" for i, (kind, group, at) in enumerate(elements, 1)] + ["$EndElements"]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def half(source, path, dim, axis, at, name):
    """The half beyond the plane; its cut becomes the boundary group `name`. Names of the groups that are left."""
    names, nodes, elements = read(source)
    size = max(max(x[c] for x in nodes.values()) - min(x[c] for x in nodes.values()) for c in range(dim))
    kept, cut = [], {}
    for kind, group, at_nodes in elements:
        corners = at_nodes[:CORNERS[kind]]
        if any(nodes[n][axis] < at - 1e-7 * size for n in corners): continue
        on = {n for n in corners if abs(nodes[n][axis] - at) <= 1e-7 * size}
        if dimension(kind) == dim:
            for facet in FACETS[dim, CORNERS[kind]]:
                corner = [corners[i] for i in facet]
                if on.issuperset(corner): cut[tuple(sorted(corner))] = corner
        kept.append((kind, group, at_nodes))
    number = max((n for _, n, _ in names), default=0) + 1
    kept += [(LINEAR[len(c)], number, c) for c in cut.values()]
    left = {(dimension(kind), group) for kind, group, _ in kept if CORNERS.get(kind)}
    names = [row for row in names if row[:2] in left] + [(dim - 1, number, name)]
    write(path, names, nodes, kept)
    return {row[2] for row in names}


def section(source, path, axis, around=False):
    """The lowest side of a prismatic mesh of hexahedra as a mesh in the plane; (length along the axis, names of groups that are left). around: of one of revolution, the side at
    the least angle, its radius along x and its height along y; the length is an angle."""
    names, nodes, elements = read(source)
    a, b = (axis + 1) % 3, (axis + 2) % 3
    along = {n: math.atan2(x[b], x[a]) if around else x[axis] for n, x in nodes.items()}
    place = {n: [math.hypot(x[a], x[b]), x[axis], 0] if around else [x[a], x[b], 0] for n, x in nodes.items()}
    used = {n for kind, _, at in elements if dimension(kind) == 3 for n in at[:8]}
    low, high = min(along[n] for n in used), max(along[n] for n in used)

    def lowest(n): return abs(along[n] - low) < 1e-7 * (high - low)

    def area(at): return sum(place[a][0] * place[b][1] - place[b][0] * place[a][1] for a, b in zip(at, at[1:] + at[:1]))

    kept, edges = [], {}
    for kind, group, at in elements:
        if kind not in (5, 12, 17): continue
        for corners in FACETS[3, 8]:
            if not all(lowest(at[i]) for i in corners): continue
            if area([at[i] for i in corners]) < 0: corners = corners[::-1]
            if all(set(at[i] for i in corners) != set(other[:4]) for _, other, _ in kept): kept.append((*face(kind, at, corners), group))
    of = {n for _, at, _ in kept for n in at[:4]}
    for kind, group, at in elements:
        corner = at[:4]
        if dimension(kind) != 2 or CORNERS[kind] != 4: continue
        for i in range(4):
            pair = corner[i - 1], corner[i]
            if of.issuperset(pair) and sum(map(lowest, corner)) == 2: edges[group, frozenset(pair)] = pair
    groups = {g for _, _, g in kept}
    named = [(2, n, name) for d, n, name in names if d == 3 and n in groups] + [(1, n, name) for d, n, name in names if d == 2 and any(g == n for g, _ in edges)]
    write(path, named, place, [(1, g, pair) for (g, _), pair in edges.items()] + [(kind, g, at) for kind, at, g in kept])
    whole = around and any(max(along[n] for n in at[:8]) - min(along[n] for n in at[:8]) > math.pi for kind, _, at in elements if dimension(kind) == 3)
    return 2 * math.pi if whole else high - low, {row[2] for row in named}
