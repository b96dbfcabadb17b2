"""What fields.xdmf shows of cells of higher order: few cells of a thick tube under pressure, whose deformation is known (O-11)."""
import numpy
import pytest

SPREAD = 1.25**2 - 1  # r^2 - R^2, everywhere


def leaves(state):
    """Points of each leaf, [leaf][points]."""
    points = [numpy.unique(state["cells"][state["cell"] == leaf]) for leaf in numpy.unique(state["cell"])]
    return numpy.array(points)


def von_mises(R):
    square = (R**2 + SPREAD) / R**2  # of the hoop stretch
    b = numpy.array([square, 1 / square, numpy.ones_like(square)])
    return numpy.sqrt(0.5 * sum((b[i] - b[i - 1]) ** 2 for i in range(3)))


# order, output.divide, bounds: of the place of points on the circles, of the deformed radius, of the stress
CASES = ((2, "auto", 2, 1e-10, 1e-3, 0.4), (4, "auto", 4, 1e-10, 5e-5, 0.02), (4, 7, 7, 1e-5, 5e-5, 0.02), (8, "auto", 8, 1e-5, 5e-6, 2e-4), (8, 3, 3, 1e-5, 5e-6, 2e-4))


@pytest.mark.parametrize("order,divide,pieces,circle,radius,stress", CASES)
def test_points_lie_on_the_curve(run, order, divide, pieces, circle, radius, stress):
    """Two cells around a quarter: the lattice on the circles, before and after, and the stress at its points."""
    result = run("inputs/tube.yml", "-mesh_parameter_n", 1, "-mesh_order", 4, "-order", order, "-output_divide", divide, ranks=1 + order % 3)
    assert result.returncode == 0, result
    state = result.states()[-1][1]
    X, x = state["X"][:, :2], (state["X"] + state["displacement"])[:, :2]
    R, r = (numpy.linalg.norm(y, axis=1) for y in (X, x))
    assert leaves(state).shape == (2, (pieces + 1) ** 2) and len(state["cells"]) == 2 * pieces**2 and set(state["order"]) == {order}
    line = numpy.arange(pieces + 1) / pieces  # lines across the wall: as many radii, the outer ones on the circles
    for leaf in leaves(state):
        near = numpy.argmin(numpy.abs(R[leaf][:, None] - (1 + line)), axis=1)
        assert numpy.abs(R[leaf] - 1 - line[near]).max() < circle and numpy.all(numpy.bincount(near) == pieces + 1)
        on = leaf[near == 0]
        angle = numpy.sort(numpy.arctan2(X[on, 1], X[on, 0]))
        assert numpy.allclose(numpy.diff(angle), numpy.pi / 4 / pieces, rtol=0.02)
    assert numpy.abs(r - numpy.sqrt(R**2 + SPREAD)).max() < radius
    assert numpy.abs(state["von_mises"] - von_mises(R)).max() < stress
    pieces_area = sum(numpy.cross(x[b] - x[a], x[c] - x[a]) for a, b, c in (state["cells"].T[[0, 1, 2]], state["cells"].T[[0, 2, 3]])) / 2
    assert numpy.all(pieces_area > 0)


def test_word_that_is_none(run):
    result = run("inputs/tube.yml", "-output_divide", 9)
    assert result.returncode == 1 and "output.divide is '9'; allowed: auto|1|2" in result.stdout + result.stderr


@pytest.mark.parametrize("order", (2, 4, 8))
def test_contact_faces_are_curved(run, order):
    """Contact faces of the cells' order are cut at their nodes, on the circle of the half disc; the bulk beside them is drawn on it too."""
    result = run("inputs/hertz2d.yml", "-order", order, "-mesh_order", 4, "-contact_disc_on_block_order", "full", "-adapt_tolerance", 0, ranks=2)
    assert result.returncode == 0, result
    contact, bulk = (result.states(grid)[-1][1] for grid in ("contact", "bulk"))
    own = numpy.unique(contact["cells"][contact["side"] == 0])
    assert len(own) == order * len(set(contact["cell"][contact["side"] == 0])) + 1
    assert numpy.abs(numpy.linalg.norm(contact["X"][own, :2] - (0, 1), axis=1) - 1).max() < 1e-5
    R = numpy.linalg.norm(bulk["X"][:, :2] - (0, 1), axis=1)
    near = (numpy.abs(R - 1) < 1e-5) & (bulk["X"][:, 1] < 1 - 1e-9)
    assert near.sum() >= len(own) - 2 and R[bulk["X"][:, 1] > 1e-9].max() < 1 + 1e-5
