"""scripts/import: meshes of other programs with their sets give the energy of the same mesh in gmsh's own format.

The reference is two bent blocks written by boxmesh; its cells are written here in each format, order 2 without the nodes in the middle of faces and cells, which
the map of the blocks, a polynomial of degree 2, gives back exactly.
"""
import contextlib
import functools
import io
import os
import re
import resource
import subprocess

import boxmesh
import numpy as np
import pytest
from boxmesh import linspace
from conftest import ROOT
from test_hostile import limited

MIDDLES = {2: [4, 5, 6, 7], 3: [8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15]}  # of edges, in the order of Abaqus, CGNS, VTK
SIDES = {2: [(0, 1), (1, 2), (2, 3), (3, 0)], 3: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]}  # of Abaqus
KINDS = {(1, 1): "line", (1, 2): "line3", (2, 1): "quad", (2, 2): "quad8", (3, 1): "hexahedron", (3, 2): "hexahedron20"}
UNV = {(1, 1): 21, (1, 2): 24, (2, 1): 44, (2, 2): 45, (3, 1): 115, (3, 2): 116}
UNV_ORDER = {1: [0, 2, 1], 2: [0, 4, 1, 5, 2, 6, 3, 7], 3: [0, 8, 1, 9, 2, 10, 3, 11, 16, 17, 18, 19, 4, 12, 5, 13, 6, 14, 7, 15]}


class Blocks:
    """Two blocks: points [n][3], cells {body: rows of nodes from 0}, facets {group: rows}; gmsh: the reference file."""

    def __init__(self, directory, dim, order):
        def bent(shift):
            return lambda *x: (x[0] + 0.1 * x[-1] ** 2 + 0.05 * x[0] ** 2, *x[1:-1], x[-1] + shift)

        self.dim, self.order, self.gmsh = dim, order, directory / "reference.msh"
        breaks = [linspace(0, 1, 2)] * (dim - 1)
        top = "xyz"[dim - 1]
        names = {(top + "1", 0): "lower_top", (top + "0", 1): "upper_bottom", (top + "0", 0): "floor", (top + "1", 1): "lid"}
        boxmesh.write(self.gmsh, breaks + [linspace(0, 1, 2)], to=[bent(-1), bent(0.01)], order=order, side=lambda name, _, block: names.get((name, block)),
                      body=lambda _, block: ("lower", "upper")[block])
        self.parse()

    def parse(self):
        lines = iter(self.gmsh.read_text().splitlines())
        physical, self.cells, self.facets = {}, {}, {}
        for line in lines:
            if line in ("$PhysicalNames", "$Nodes", "$Elements"):
                rows = [next(lines).split() for _ in range(int(next(lines)))]
                if line == "$PhysicalNames":
                    physical = {(int(d), int(tag)): name.strip('"') for d, tag, name in rows}
                elif line == "$Nodes":
                    self.points = np.array([[float(v) for v in row[1:]] for row in rows])
                else:
                    for _, kind, _, tag, _, *nodes in rows:
                        d = {1: 1, 8: 1, 3: 2, 10: 2, 5: 3, 12: 3}[int(kind)]
                        nodes = [int(n) - 1 for n in nodes]
                        if d > 1 and self.order == 2:
                            nodes = nodes[:2 ** d] + [nodes[i] for i in MIDDLES[d]]
                        (self.cells if d == self.dim else self.facets).setdefault(physical[d, int(tag)], []).append(nodes)

    def sides(self, group):
        """[(number of the cell from 1, side from 0)] of a group, cells in their order."""
        corners = {tuple(sorted(row[:2 ** (self.dim - 1)])) for row in self.facets[group]}
        return [(c, s) for c, cell in enumerate((cell for rows in self.cells.values() for cell in rows), 1) for s, side in enumerate(SIDES[self.dim])
                if tuple(sorted(cell[i] for i in side)) in corners]


# ---- writers -----------------------------------------------------------------------------------------------------------------------------


def inp_text(blocks, rows_of=10):
    element = {(2, 1): "CPE4H", (2, 2): "CPE8R", (3, 1): "C3D8I", (3, 2): "C3D20RH"}[blocks.dim, blocks.order]
    text = ["*Node, nset=Nall"] + [f"{i}, {x[0]!r}, {x[1]!r}, {x[2]!r}" for i, x in enumerate(blocks.points.tolist(), 1)]
    number = 0
    for body, rows in blocks.cells.items():
        text += [f"*Element, type={element}, elset={body}"]
        for row in rows:
            number += 1
            words = [str(w) for w in [number] + [n + 1 for n in row]]
            text += [", ".join(words[i:i + rows_of]) + ("," if i + rows_of < len(words) else "") for i in range(0, len(words), rows_of)]
    text += ["*Elset, elset=Eall, generate", f"1, {number}, 1", "*Elset, elset=Again", "LOWER, upper"]
    text += [f"*Solid section, elset={body}, material=rubber\n1.," for body in blocks.cells]
    return text


def inp_groups(blocks, where=""):
    """The lid and the floor as sets of nodes, the others as surfaces of sides."""
    text = []
    for group in ("floor", "lid"):
        text += [f"*NSET, NSET={group}{where}"] + [f"{n + 1}," for n in sorted({n for row in blocks.facets[group] for n in row})]
    for group in ("lower_top", "upper_bottom"):
        sides = blocks.sides(group)
        for side in sorted({s for _, s in sides}):
            text += [f"*Elset, elset=_{group}_S{side + 1}, internal{where}", ", ".join(str(c) for c, s in sides if s == side)]
        text += [f"*Surface, type=ELEMENT, name={group}"] + [f"_{group}_S{s + 1}, S{s + 1}" for s in sorted({s for _, s in sides})]
    return text


def write_inp(blocks, path):
    path.write_text("\n".join(["*Heading", "** a comment", *inp_text(blocks), *inp_groups(blocks)]) + "\n")


def write_inp_assembly(blocks, path):
    """A part, moved and turned back by its instance; the mesh in a file of its own."""
    X = blocks.points
    blocks.points = np.column_stack([X[:, 1], -X[:, 0], X[:, 2]]) - [5, 6, 7]  # turned by -90 degrees about z, then moved
    (path.parent / "mesh.inc").write_text("\n".join(inp_text(blocks)) + "\n")
    blocks.points = X
    path.write_text("\n".join(["*Heading", "*Part, name=Blocks", "*INCLUDE, INPUT=mesh.inc", "*End Part", "*Assembly, name=Assembly",
                               "*Instance, name=Blocks-1, part=Blocks", "5., 6., 7.", "0., 0., 0., 0., 0., 1., 90.", "*End Instance",
                               *inp_groups(blocks, ", instance=Blocks-1"), "*End Assembly"]) + "\n")


def write_unv(blocks, path):
    text, number, groups = ["    -1", "  2411"], 0, []
    for i, x in enumerate(blocks.points.tolist(), 1):
        text += [f"{i:10d}{1:10d}{1:10d}{11:10d}", "".join(f"{v:25.16E}".replace("E", "D") for v in x)]
    text += ["    -1", "    -1", "  2412"]
    for d, sets in ((blocks.dim, blocks.cells), (blocks.dim - 1, blocks.facets)):
        for name, rows in sets.items():
            groups.append((name, list(range(number + 1, number + 1 + len(rows)))))
            for row in rows:
                number += 1
                row = [row[i] + 1 for i in UNV_ORDER[d]] if blocks.order == 2 else [n + 1 for n in row]
                text += ["".join(f"{v:10d}" for v in (number, UNV[d, blocks.order], 1, 1, 7, len(row)))] + ["         0         1         1"] * (d == 1)
                text += ["".join(f"{n:10d}" for n in row[i:i + 8]) for i in range(0, len(row), 8)]
    text += ["    -1", "    -1", "  2467"]
    for g, (name, numbers) in enumerate(groups, 1):
        entities = [f"{8:10d}{n:10d}{0:10d}{0:10d}" for n in numbers]
        text += ["".join(f"{v:10d}" for v in (g, 0, 0, 0, 0, 0, 0, len(numbers))), name] + ["".join(entities[i:i + 2]) for i in range(0, len(entities), 2)]
    path.write_text("\n".join(text + ["    -1"]) + "\n")


def write_exodus(blocks, path):
    netCDF4 = pytest.importorskip("netCDF4")
    exodus_side = {2: [1, 2, 3, 4], 3: [5, 6, 1, 2, 3, 4]}[blocks.dim]
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as data:
        for name, size in (("len_string", 33), ("num_dim", 3), ("num_nodes", len(blocks.points)), ("num_el_blk", 2), ("num_side_sets", 3), ("num_node_sets", 1)):
            data.createDimension(name, size)
        data.createVariable("coord", "f8", ("num_dim", "num_nodes"))[:] = blocks.points.T

        def names(variable, dimension, words):
            table = data.createVariable(variable, "S1", (dimension, "len_string"))
            table[:] = np.array([list(word.ljust(33, "\0")) for word in words], "S1")

        names("eb_names", "num_el_blk", blocks.cells)
        for b, rows in enumerate(blocks.cells.values(), 1):
            data.createDimension(f"num_el_in_blk{b}", len(rows))
            data.createDimension(f"num_nod_per_el{b}", len(rows[0]))
            # Exodus has the edges upwards before those of the top
            order = [*range(12), *range(16, 20), *range(12, 16)] if len(rows[0]) == 20 else range(len(rows[0]))
            table = data.createVariable(f"connect{b}", "i4", (f"num_el_in_blk{b}", f"num_nod_per_el{b}"))
            table[:] = np.array(rows)[:, list(order)] + 1
            table.elem_type = "HEX20" if blocks.dim == 3 else "QUAD"
        *by_sides, by_nodes = ("lower_top", "upper_bottom", "lid", "floor")
        names("ss_names", "num_side_sets", by_sides)
        for s, group in enumerate(by_sides, 1):
            sides = blocks.sides(group)
            data.createDimension(f"num_side_ss{s}", len(sides))
            data.createVariable(f"elem_ss{s}", "i4", (f"num_side_ss{s}",))[:] = [c for c, _ in sides]
            data.createVariable(f"side_ss{s}", "i4", (f"num_side_ss{s}",))[:] = [exodus_side[s] for _, s in sides]
        names("ns_names", "num_node_sets", [by_nodes])
        nodes = sorted({n + 1 for row in blocks.facets[by_nodes] for n in row})
        data.createDimension("num_nod_ns1", len(nodes))
        data.createVariable("node_ns1", "i4", ("num_nod_ns1",))[:] = nodes


def write_cgns(blocks, path):
    h5py = pytest.importorskip("h5py")
    kind = {(1, 1): 3, (1, 2): 4, (2, 1): 7, (2, 2): 8, (3, 1): 17, (3, 2): 18}
    upwards = [*range(12), *range(16, 20), *range(12, 16)]  # CGNS has these edges before those of the top

    def node(parent, name, label, data=None):
        group = parent.create_group(name)
        group.attrs["label"] = np.bytes_(label)
        if data is not None:
            group[" data"] = np.frombuffer(data.encode(), "i1") if isinstance(data, str) else np.array(data)
        return group

    with h5py.File(path, "w") as file:
        base = node(file, "Base", "CGNSBase_t", [blocks.dim, 3])
        zone = node(base, "Zone", "Zone_t", [[len(blocks.points)], [8], [0]])
        node(zone, "ZoneType", "ZoneType_t", "Unstructured")
        grid = node(zone, "GridCoordinates", "GridCoordinates_t")
        for axis, x in zip("XYZ", blocks.points.T):
            node(grid, f"Coordinate{axis}", "DataArray_t", x)
        all_bc, number = node(zone, "ZoneBC", "ZoneBC_t"), 0
        for d, sets in ((blocks.dim, blocks.cells), (blocks.dim - 1, blocks.facets)):
            for name, rows in sets.items():
                section = node(zone, name if d == blocks.dim else f"facets of {name}", "Elements_t", [kind[d, blocks.order], 0])
                rows = np.array(rows) + 1
                node(section, "ElementRange", "IndexRange_t", [number + 1, number + len(rows)])
                node(section, "ElementConnectivity", "DataArray_t", (rows[:, upwards] if rows.shape[1] == 20 else rows).ravel())
                if d < blocks.dim:
                    bc = node(all_bc, name, "BC_t", "BCWall")
                    if name == "floor":
                        node(bc, "PointList", "IndexArray_t", [np.unique(rows)])
                    else:
                        node(bc, "PointRange", "IndexRange_t", [[number + 1, number + len(rows)]])
                        node(bc, "GridLocation", "GridLocation_t", "FaceCenter")
                number += len(rows)


def write_meshio(blocks, path, **data):
    meshio = pytest.importorskip("meshio")
    sets = [(KINDS[d, blocks.order], rows) for d, of in ((blocks.dim, blocks.cells), (blocks.dim - 1, blocks.facets)) for rows in of.values()]
    mesh = meshio.Mesh(blocks.points, [(kind, np.array(rows)) for kind, rows in sets], **{k: v([len(rows) for _, rows in sets]) for k, v in data.items()})
    return mesh


def write_vtk(blocks, path):
    write_meshio(blocks, path, cell_data=lambda sizes: {"group": [np.full(n, i + 1) for i, n in enumerate(sizes)]}).write(path)


def write_med(blocks, path):
    kinds, tags, rows = {}, {}, 0
    names = [*blocks.cells, *blocks.facets]
    for d, of in ((blocks.dim, blocks.cells), (blocks.dim - 1, blocks.facets)):
        for name, members in of.items():
            rows = kinds.setdefault(KINDS[d, blocks.order], [[], []])
            rows[0] += members
            rows[1] += [-1 - names.index(name)] * len(members)
    meshio = pytest.importorskip("meshio")
    tags = {-1 - i: [name] for i, name in enumerate(names)}
    mesh = meshio.Mesh(blocks.points, [(kind, np.array(rows)) for kind, (rows, _) in kinds.items()],
                       cell_data={"cell_tags": [np.array(t) for _, t in kinds.values()]})
    mesh.cell_tags, mesh.point_tags = tags, {}
    mesh.write(path)


# ---- cases -----------------------------------------------------------------------------------------------------------------------------------


SCENE = """mesh: {{file: {file}}}
model: {model}
order: 2
body: {{{lower}: {{material: rubber}}, {upper}: {{material: rubber}}}}
material: {{rubber: {{law: neo_hookean, E: 1, nu: 0.3}}}}
boundary:
  {floor}: {{fix: {axes}}}
  {lid}: {{displacement: {{x: 0.02, {up}: -0.1}}}}
contact: {{pair: {{nonmortar: {upper_bottom}, mortar: {lower_top}}}}}
load: {{step: 1}}
"""
GROUPS = ("lower", "upper", "floor", "lower_top", "upper_bottom", "lid")


def energy(run, directory, file, dim, names=None):
    names = names or {name: name for name in GROUPS}
    up = "xyz"[dim - 1]
    text = SCENE.format(file=directory / file, model={2: "plane_strain", 3: "3d"}[dim], axes="xyz"[:dim], up=up, **names)
    result = run(f"{file}.yml", "-output_fields", "false", text=text)
    assert result.returncode == 0, result
    return result.summary["energy"]


@functools.lru_cache(None)
def script():
    """scripts/import without its last line, which starts it."""
    names = {"__name__": "import"}
    exec(compile((ROOT / "scripts/import").read_text().rsplit("main()", 1)[0], ROOT / "scripts/import", "exec"), names)
    return names["main"]


def convert(*arguments):
    """scripts/import in this process: to start Python and its libraries takes a second, once for all."""
    words, streams, status = ["import", *map(str, arguments)], [io.TextIOWrapper(io.BytesIO()) for _ in range(2)], 0
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]), pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", words)
        try:
            script()()
        except SystemExit as end:
            status = end.code if isinstance(end.code, int) else 1
            if status and not isinstance(end.code, int): print(end.code, file=streams[1])
    for stream in streams: stream.flush()
    return subprocess.CompletedProcess(words, status, *(stream.buffer.getvalue().decode() for stream in streams))


CASES = [(".inp", write_inp, 2, 1), (".inp", write_inp, 2, 2), (".inp", write_inp_assembly, 3, 1), (".inp", write_inp, 3, 2),
         (".unv", write_unv, 2, 2), (".unv", write_unv, 3, 1), (".unv", write_unv, 3, 2), (".exo", write_exodus, 2, 2), (".exo", write_exodus, 3, 2),
         (".cgns", write_cgns, 2, 1), (".cgns", write_cgns, 3, 2), (".med", write_med, 2, 2), (".med", write_med, 3, 1), (".vtk", write_vtk, 2, 2),
         (".vtu", write_vtk, 3, 2)]


REFERENCE = {}  # energies of (dimension, order), which no format changes


@pytest.mark.parametrize("extension,writer,dim,order", CASES, ids=[f"{w.__name__[6:]}{e}-{d}d-{o}" for e, w, d, o in CASES])
def test_energy(run, tmp_path, extension, writer, dim, order):
    blocks = Blocks(tmp_path, dim, order)
    writer(blocks, tmp_path / f"mesh{extension}")
    done = convert(tmp_path / f"mesh{extension}", tmp_path / "mesh.msh")
    assert done.returncode == 0, done
    assert f"of order {order}" in done.stdout
    names = {name: name for name in GROUPS}
    if writer is write_vtk:
        names = {name: f"group_{i}" for i, name in enumerate([*blocks.cells, *blocks.facets], 1)}
    if writer is write_inp_assembly:
        names.update(lower="Blocks-1_lower", upper="Blocks-1_upper")
    if (dim, order) not in REFERENCE: REFERENCE[dim, order] = energy(run, tmp_path, "reference.msh", dim)
    assert energy(run, tmp_path, "mesh.msh", dim, names) == pytest.approx(REFERENCE[dim, order], rel=1e-10)


def test_what_is_not_kept_is_told(tmp_path):
    blocks = Blocks(tmp_path, 3, 1)
    write_inp(blocks, tmp_path / "mesh.inp")
    with open(tmp_path / "mesh.inp", "a") as file:
        file.write("*Element, type=C3D6, elset=wedges\n900, 1, 2, 3, 4, 5, 6\n*Nset, nset=corner\n1,\n*Nset, nset=left side\n")
        file.write(",\n".join(str(n + 1) for n in np.flatnonzero(blocks.points[:, 1] == 0)) + "\n")
    done = convert(tmp_path / "mesh.inp", tmp_path / "mesh.msh")
    assert done.returncode == 0 and "not kept: cells of kind C3D6" in done.stdout, done
    assert "set of nodes corner has all nodes of no outer facet" in done.stdout and "left side is called left_side" in done.stdout, done
    assert "sets of cells that are no bodies: Again, Eall" in done.stdout and "boundary left_side: 8 facets" in done.stdout, done
    assert "body lower: 8 cells" in done.stdout and "body upper: 8 cells" in done.stdout, done
    done = convert(tmp_path / "mesh.inp", tmp_path / "mesh.msh", "--bodies", "upper,Eall")
    assert "body Eall: 8 cells" in done.stdout, done


STRIP = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4, ELSET=ALL\n1, 1, 2, 3, 4\n"


@pytest.mark.parametrize("name,text,words", [
    ("none.inp", None, "there is no file"),
    ("a.inp", "*NODE\n1, 0, 0, 0\n", "has no cells of two or three dimensions"),
    ("a.inp", "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n", "which is not there"),
    ("a.inp", "*NODE\n1, 0, zero, 0\n", "is damaged or of another format"),
    ("a.inp", "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 1\n*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n", "is a surface in space"),
    ("a.inp", "*NODE\n1, 0, 0\n2, 1, 0\n*NGEN\n1, 2, 1\n", r"*NGEN makes nodes"),
    ("a.inp", STRIP + "*NMAP\n", "*NMAP moves nodes"), ("a.inp", "*SYSTEM\n1, 1, 1\n" + STRIP, "*SYSTEM gives nodes in coordinates of its own"),
    ("a.inp", STRIP.replace("*NODE", "*NODE, SYSTEM=C"), "*NODE, SYSTEM=C: only Cartesian"), ("a.inp", STRIP.replace("*NODE", "*NODE, INPUT=b"), "*NODE, INPUT=b: data lines"),
    ("a.inp", STRIP + "*SOLID SECTION, ELSET=ALL\n*SOLID SECTION, ELSET=all\n", "set of cells all has two sections"),
    ("a.inp", STRIP + "*INCLUDE, INPUT=a.inp\n", "a.inp includes itself"),
    ("a.inp", STRIP + "*INCLUDE, INPUT=/dev/zero\n", "there is no file /dev/zero"),
    ("a.inp", STRIP.replace("3, 1, 1", "3, 1, nan"), "node 3 is at (1.0, nan, 0.0), which is no place"),
    ("a.inp", STRIP.replace("4, 0, 1", "4, 0, 1\n4, 0, 2"), "there are two nodes 4"),
    ("a.inp", STRIP + "1, 2, 3, 4, 1\n", "there are two cells 1"),
    ("a.inp", STRIP + "2, 2, 3, 4\n", "cell 2 has 3 nodes; a quad has 4"),
    ("a.vtu", "<x", "a.vtu cannot be read"),
    ("a.step", "no", "gmsh finds no geometry in it"),
    ("a.cgns", "no", "is no HDF5 file"),
    ("a.unv", "    -1\n  2412\n 1 115\n    -1\n", "is damaged or of another format"),
])
def test_refused(tmp_path, name, text, words):
    if text is not None:
        (tmp_path / name).write_text(text)
    done = convert(tmp_path / name, tmp_path / "out.msh")
    assert done.returncode == 1 and words in done.stderr and "Traceback" not in done.stderr and (done.stderr.count("\n") == 1 or name == "a.vtu"), done  # there meshio speaks, too
    assert not (tmp_path / "out.msh").exists()


def test_a_mesh_of_another_program_stays(tmp_path):
    """One of its own is replaced."""
    (tmp_path / "a.inp").write_text(STRIP + "*SYSTEM\n*ORIENTATION, SYSTEM=CYLINDRICAL\n")
    assert all(convert(tmp_path / "a.inp", tmp_path / "a.msh").returncode == 0 for _ in range(2))
    text = (tmp_path / "a.msh").read_text()
    (tmp_path / "a.msh").write_text("mine")
    done = convert(tmp_path / "a.inp", tmp_path / "a.msh")
    assert done.returncode == 1 and "a.msh is there, and another program has made it" in done.stderr and (tmp_path / "a.msh").read_text() == "mine", done
    assert convert(tmp_path / "a.inp", tmp_path / "a.msh", "--replace").returncode == 0 and (tmp_path / "a.msh").read_text() == text


def test_strange_but_good(tmp_path):
    """A mark of the byte order, exponents of Fortran, a range of numbers most of which are not there, names that the locale has no letters for."""
    text = STRIP.replace("4, 0, 1", "4, 0.D0, 1d0").replace("ALL", "größe") + "*NSET, NSET=TOP, GENERATE\n3, 2000000000, 1\n"
    (tmp_path / "a.inp").write_text("\ufeff" + text, encoding="utf-8")
    environ = {**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    done = subprocess.run([ROOT / "scripts/import", "a.inp"], cwd=tmp_path, env=environ, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "boundary TOP: 1 facets" in done.stdout and not done.stderr, done
    assert '"gr__e"' in (tmp_path / "a.msh").read_text(encoding="utf-8")


@pytest.mark.parametrize("out,words", [("none/a.msh", "No such file or directory"), (".", "no file that could be written"), ("full/a.msh", "File too large")])
def test_no_place_for_the_mesh(tmp_path, out, words):
    """One sentence, and the mesh of before stays."""
    (tmp_path / "a.inp").write_text(STRIP)
    (tmp_path / "full").mkdir()
    (tmp_path / "full/a.msh").write_text("mine")
    with limited(resource.RLIMIT_FSIZE, 0 if "full" in out else 1000):
        done = convert(tmp_path / "a.inp", tmp_path / out, "--replace")
    assert done.returncode == 1 and words in done.stderr and done.stderr.count("\n") == 1, done
    assert os.listdir(tmp_path / "full") == ["a.msh"] and (tmp_path / "full/a.msh").read_text() == "mine"


def test_cad(run, tmp_path):
    """STEP: a .geo with groups where the faces are; it replaces none."""
    (tmp_path / "box.geo").write_text('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 2, 1, 0.5};\n')
    subprocess.run(["gmsh", "-0", "box.geo", "-o", "part.step"], cwd=tmp_path, capture_output=True, check=True)
    done = convert(tmp_path / "part.step", tmp_path / "part.geo")
    assert done.returncode == 0 and "1 body, 6 faces" in done.stdout, done
    text = (tmp_path / "part.geo").read_text()
    names = {what: re.search(rf'"(face_\d)".*// {what}$', text, re.M)[1] for what in ("x = 0, y = 0 .. 1, z = 0 .. 0.5", "x = 2, y = 0 .. 1, z = 0 .. 0.5")}
    left, right = names.values()
    scene = f"""mesh: {{file: {tmp_path}/part.geo, order: 1, parameter: {{size: 1}}}}
model: 3d
kinematics: small
body: {{body_1: {{material: steel}}}}
material: {{steel: {{law: linear, E: 1, nu: 0}}}}
boundary: {{{left}: {{fix: xyz}}, {right}: {{displacement: {{x: 0.2}}}}}}
load: {{step: 1}}
"""
    result = run("part.yml", "-output_fields", "false", text=scene)
    assert result.summary["reaction"][left][0] == pytest.approx(-0.05, rel=1e-8)  # E A u / L
    again = convert(tmp_path / "part.step", tmp_path / "part.geo")
    assert again.returncode == 1 and "is there" in again.stderr and (tmp_path / "part.geo").read_text() == text


def test_without_meshio(tmp_path):
    """One sentence says what to install."""
    (tmp_path / "meshio.py").write_text("raise ImportError\n")
    (tmp_path / "a.vtk").write_text("")
    done = subprocess.run([ROOT / "scripts/import", tmp_path / "a.vtk"], env={"PATH": "/usr/bin:/bin", "PYTHONPATH": str(tmp_path)}, capture_output=True, text=True)
    assert done.returncode == 1 and "need meshio (apt-get install python3-meshio" in done.stderr, done
