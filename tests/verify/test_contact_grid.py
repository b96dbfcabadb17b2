"""The contact surfaces and segments a run leaves, both sides, in two and three dimensions (inputs/patch2d.yml, inputs/blocks3d.yml: the exact state is uniform)."""
import xml.etree.ElementTree

import numpy
import pytest

from contactkit import contact, surface

SMALL = ("-kinematics", "small", "-material_rubber_law", "linear")
PRESSURE = {(): 0.0688979013617, SMALL: 0.05 * 0.7 / (1.3 * 0.4)}
CORNER = ("-refine_corner_boundary", "{}", "-refine_corner_x", 0, "-refine_corner_y", 0, "-refine_corner_z", 1, "-refine_corner_levels", 2)


def refined(boundary):
    return tuple(boundary if option == "{}" else option for option in CORNER)


def areas(points, cells):
    """Vector areas of triangles or quadrilaterals."""
    x = points[cells.astype(int)]
    return 0.5 * numpy.cross(x[:, -2] - x[:, 0], x[:, -1] - x[:, x.shape[1] - 3])


def tributary(part):
    """Area around each node of a surface of rectangles, a hanging node's given to the ends of the edge it hangs on."""
    x, cells = part["X"], part["cells"]
    weight = numpy.bincount(cells.ravel(), numpy.repeat(numpy.linalg.norm(areas(x, cells), axis=1) / 4, 4), len(x))
    for node, ends in sorted(hanging(part).items(), key=lambda item: edge_length(part, item[1])):  # the finest first: its masters may hang
        weight[list(ends)] += weight[node] / 2
        weight[node] = 0
    return weight


def edge_length(part, ends):
    return numpy.linalg.norm(part["X"][ends[1]] - part["X"][ends[0]])


def hanging(part):
    """{node: ends} of the nodes in the middle of another facet's edge."""
    at = {tuple(numpy.round(x, 9)): n for n, x in enumerate(part["X"])}
    edges = {tuple(sorted((q[k], q[(k + 1) % 4]))) for q in part["cells"] for k in range(4)}
    middle = ((at.get(tuple(numpy.round((part["X"][a] + part["X"][b]) / 2, 9))), (a, b)) for a, b in edges)
    return {node: ends for node, ends in middle if node is not None}


def check_uniform(result, pressure):
    """Pressure everywhere, no gap, all touching, normals out of their bodies, facets counterclockwise seen from outside."""
    assert result.returncode == 0, result
    for side, up in ((0, -1), (1, 1)):
        part = contact(result, side)
        assert numpy.allclose(part["contact_pressure"], pressure, atol=1e-9) and numpy.allclose(part["gap"], 0, atol=1e-9), (side, part)
        assert numpy.all(part["status"] == 1) and numpy.allclose(part["normal"], (0, 0, up)) and numpy.allclose(part["displacement"], (0, 0, -0.05))
        area = areas(part["X"], part["cells"])
        assert numpy.all(area[:, 2] * up > 0) and numpy.allclose(area.sum(axis=0), (0, 0, up)) and numpy.all(part["pair"] == 0)
    return result


@pytest.mark.parametrize("options", (pytest.param((), id="finite"), pytest.param(SMALL, id="small")))
@pytest.mark.parametrize("ranks", (1, 2, 3))
def test_uniform_in_space(run, ranks, options):
    result = check_uniform(run("inputs/blocks3d.yml", "-output_segments", "true", *options, ranks=ranks), PRESSURE[options])
    assert [(len(contact(result, side)["X"]), len(contact(result, side)["cells"])) for side in (0, 1)] == [(16, 9), (9, 4)]
    # 3 x 3 facets on 2 x 2: the middle row and column are cut, 4 x 4 rectangles of two triangles each
    segments = result.states("segments")[-1][1]
    x = segments["X"] + segments["displacement"]
    area = areas(segments["X"], segments["cells"])
    assert len(segments["cells"]) == 32 and numpy.all(area[:, 2] < 0) and numpy.allclose(area.sum(axis=0), (0, 0, -1), atol=1e-9)
    assert numpy.allclose(segments["gap"], 0, atol=1e-9) and numpy.allclose(x[:, 2], 0.95)
    for number, side in (("facet", 0), ("mortar_facet", 1)):  # every triangle lies in the facets it names
        part = contact(result, side)
        corner = part["X"][part["cells"]][segments[number].astype(int)]
        own = segments["X"][segments["cells"].astype(int)]
        assert numpy.all(own[..., :2] >= corner.min(axis=1)[:, None, :2] - 1e-9) and numpy.all(own[..., :2] <= corner.max(axis=1)[:, None, :2] + 1e-9)
    root = xml.etree.ElementTree.parse(result.directory / "fields.xdmf").getroot()
    shape = {grid.get("Name"): grid.find("Grid/Topology").get("TopologyType") for grid in root.findall("Domain/Grid")}
    assert shape == {"bulk": "Hexahedron", "contact": "Quadrilateral", "segments": "Triangle"}


@pytest.mark.parametrize("ranks", (1, 3))
@pytest.mark.parametrize("boundary", ("upper_bottom", "lower_top"))
def test_uniform_with_hanging_nodes(run, boundary, ranks):
    """Nodes that hang show what their masters have, on either side."""
    result = check_uniform(run("inputs/blocks3d.yml", *refined(boundary), ranks=ranks), PRESSURE[()])
    assert len(hanging(contact(result, 0 if boundary == "upper_bottom" else 1))) >= 4


def test_open(run):
    """The upper block is lifted: the gap on both sides, nothing touches."""
    result = run("inputs/blocks3d.yml", "-boundary_top_displacement_z", 0.03, "-output_segments", "true")
    assert result.returncode == 0, result
    for side in (0, 1):
        part = contact(result, side)
        assert numpy.allclose(part["gap"], 0.03) and numpy.all(part["status"] == 0) and numpy.all(part["contact_pressure"] == 0)
    assert numpy.allclose(result.states("segments")[-1][1]["gap"], 0.03)


@pytest.mark.parametrize("boundary", (None, "upper_bottom", "lower_top"))
def test_means_keep_the_force(run, boundary):
    """Pressure that varies: the mortar side's means, summed with the areas of its nodes, are the force; the same on any number of ranks."""
    options = (*SMALL, "-boundary_top_displacement_z", "-0.1*(1+X+0.5*Y^2)", *(refined(boundary) if boundary else ()))
    one, three = (run("inputs/blocks3d.yml", *options, ranks=ranks) for ranks in (1, 3))
    assert one.returncode == 0 and three.returncode == 0, (one, three)
    force = one.summary["contact"]["upper_on_lower"]["force"][2]
    for side in (0, 1):
        part, other = contact(one, side), contact(three, side)
        assert numpy.dot(tributary(part), part["contact_pressure"]) == pytest.approx(force, rel=1e-9)
        assert numpy.ptp(part["contact_pressure"]) > 0.1 * force
        a, b = (numpy.lexsort(numpy.round(p["X"], 9).T) for p in (part, other))
        for name in ("X", "contact_pressure", "gap", "status", "normal"):
            assert numpy.allclose(part[name][a], other[name][b], rtol=1e-8, atol=1e-10), name
        for node, ends in hanging(part).items():
            assert part["contact_pressure"][node] == pytest.approx(part["contact_pressure"][list(ends)].mean(), rel=1e-12)
    low, high = (numpy.array([f(contact(one, side)["contact_pressure"]) for side in (0, 1)]) for f in (numpy.min, numpy.max))
    assert low[1] > low[0] and high[1] < high[0]  # means stay within what they are taken of


def test_both_sides_in_the_plane(run):
    """Edges of both sides: outward normals, bodies on the left, uniform fields; a quad for each segment as before."""
    result = run("inputs/patch2d.yml", "-output_segments", "true", ranks=2)
    assert result.returncode == 0, result
    state, segments = result.states("contact")[-1][1], result.states("segments")[-1][1]
    for side, up, cells in ((0, -1, 5), (1, 1, 3)):
        part = surface(state, side)
        assert len(part["cells"]) == cells and numpy.allclose(part["normal"], (0, up, 0)) and numpy.all(part["status"] == 1)
        assert numpy.allclose(part["contact_pressure"], PRESSURE[()], atol=1e-9) and numpy.allclose(part["gap"], 0, atol=1e-9)
        assert numpy.all(-up * numpy.diff(part["X"][part["cells"]][:, :, 0]) > 0)
    assert len(segments["cells"]) == 7 and set(segments["facet"]) == set(range(5)) and set(segments["mortar_facet"]) == set(range(3))
