"""Half of a mesh that is symmetric about a plane: used by scripts/simplify."""
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
