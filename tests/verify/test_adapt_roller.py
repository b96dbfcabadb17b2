"""Line contact in three dimensions, inputs/roller.yml: plane strain along its axis, so that the run in the plane is the reference, and cells split only in the
directions that matter give the same force with a fifth of the cells, cells of order 1 along the axis with half the unknowns."""
import numpy as np
import pytest

SCENE = "inputs/roller.yml"
LINEAR = ("-contact_roller_on_block_order", 1)  # contact faces, as with orders per direction


def force(result):
    """Of the quarter that is modelled: half a section, half of length 4."""
    assert result.solved, result
    return -result.summary["reaction"]["top"][2]


def adapted(run, order, passes, anisotropic, *options):
    result = run(SCENE, "-order", order, "-adapt_anisotropic", str(anisotropic).lower(), "-adapt_tolerance", 1e-6, "-adapt_max_passes", passes, *options)
    assert result.solved, result
    assert len(result.adapt) == passes + 1
    return result


@pytest.fixture
def plane(run):
    """Reaction of inputs/hertz2d.yml: the same arcs; of the whole section per unit length, as half a section of length 2."""
    result = run("inputs/hertz2d.yml", "-mesh_order", 2, "-order", 2, "-contact_disc_on_block_order", 1, "-adapt_tolerance", 0.003, "-adapt_max_passes", 12)
    assert result.returncode == 0, result
    return -result.summary["reaction"]["top"][1]


def test_force_is_that_of_the_plane(run, plane):
    """The scene as it stands, and no load lost between the bodies, which touch along a line of the mesh."""
    result = run(SCENE)
    assert abs(force(result) / plane - 1) < 1e-3
    assert result.summary["adapt_stop"] == "tolerance"
    assert abs(result.summary["contact"]["roller_on_block"]["force"][2] / force(result) - 1) < 1e-9


def test_nothing_is_split_along_the_axis(run):
    """Without a limit of the aspect no cell gets shorter along y, for nothing varies along it; across it the smallest are a tenth as wide or less."""
    result = adapted(run, 2, 5, True, "-adapt_aspect", 1e6)
    state = result.states()[-1][1]
    corner = state["X"][state["cells"]]  # a cell of order 2 is written as eight
    width = np.ptp(corner, axis=1)
    assert width[:, 1].min() > 0.5 - 1e-9
    assert width[:, 0].min() < 0.05 and width[:, 2].min() < 0.05


def test_limit_of_the_aspect(run):
    """Cells that would grow longer are split along the axis, too."""
    result = adapted(run, 2, 3, True, "-adapt_aspect", 8)
    state = result.states()[-1][1]
    width = np.ptp(state["X"][state["cells"]], axis=1)
    assert width[:, 1].min() < 0.5 - 1e-9
    assert (width.max(axis=1) / width.min(axis=1)).max() < 2 * 8  # boxes of curved and skewed cells


def test_order_one_along_the_axis(run):
    """Order 1 along y, along which nothing varies: the same cells and the same force as with order 2 in all directions, with 0.6 times the unknowns."""
    options = ("-adapt_tolerance", 1e-6, "-adapt_max_passes", 2, "-output_fields", "false")
    along = ("-body_roller_order_y", 1, "-body_block_order_y", 1)
    same, fewer, ranks = run(SCENE, *options, *LINEAR), run(SCENE, *options, *along), run(SCENE, *options, *along, ranks=3)
    assert abs(force(fewer) / force(same) - 1) < 1e-9
    assert fewer.summary["cells"] == ranks.summary["cells"] == same.summary["cells"]
    assert fewer.summary["dofs"] == ranks.summary["dofs"] < 0.6 * same.summary["dofs"]
    assert abs(force(ranks) / force(fewer) - 1) < 1e-10


def test_order_per_direction_is_not_condensed(run):
    """Nodes inside cells of directional order belong to lower ones outside: asked for, it is refused; by itself it stays off, at order 4, too."""
    options = ("-order", 4, "-body_roller_order_y", 1, "-adapt_max_passes", 0, "-output_fields", "false")
    result = run(SCENE, *options, "-solve_condense", "yes")
    assert result.returncode == 1 and "-solve_condense yes: not with orders per direction" in result.stderr
    assert abs(force(run(SCENE, *options)) / force(run(SCENE, *options, "-body_roller_order_y", 4, *LINEAR)) - 1) < 1e-8


@pytest.mark.slow
def test_fifth_of_the_cells_for_the_same_force(run, plane):
    """Order 2, five passes of either kind: both are as far from the force of the plane (7e-5), to a tenth of that, and the anisotropic ones no further by their own
    estimate, with at least 5 times fewer cells."""
    many, few = adapted(run, 2, 5, False), adapted(run, 2, 5, True)
    error = [abs(force(result) / plane - 1) for result in (many, few)]
    print(error, force(few) / force(many) - 1)
    assert max(error) < 1e-4 and abs(error[1] - error[0]) < 0.1 * error[0], error
    assert few.summary["estimated_error"] < many.summary["estimated_error"]
    assert many.summary["cells"] >= 5 * few.summary["cells"]


def test_fifth_of_the_cells_for_the_same_estimate(run):
    """Order 1: the same estimated error after four passes of either kind."""
    many, few = adapted(run, 1, 4, False).summary, adapted(run, 1, 4, True).summary
    assert few["estimated_error"] < 1.01 * many["estimated_error"]
    assert many["cells"] >= 5 * few["cells"]


def test_ranks(run):
    """The same mesh and force on three ranks."""
    options = ("-order", 1, "-adapt_tolerance", 1e-6, "-adapt_max_passes", 2, "-output_fields", "false")
    one, three = run(SCENE, *options), run(SCENE, *options, ranks=3)
    assert one.summary["cells"] == three.summary["cells"]
    assert abs(force(three) / force(one) - 1) < 1e-10
