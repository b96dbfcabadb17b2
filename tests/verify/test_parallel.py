"""O-101: the same run on any number of ranks. Figures to 1e-8, the same cells, dofs and iterations; contact faces split over ranks; hanging nodes; more ranks
than cells."""
import numpy as np
import pytest

from conftest import leaves

# Wall-clock figures and what a rank count may change.
OTHER = ("time", "saves", "ranks", "peak_memory_mb", "peak_memory_rank_mb", "active_set_changes", "unstable_equilibria")
TILTED = ("-boundary_top_displacement_z", "-0.06 - 0.06*X*Y", "-adapt_tolerance", 0.001)  # the patch pressed more on one side: not uniform
SCENES = {
    "hertz2d": ("hertz2d", ("-adapt_max_passes", 3)),
    "hertz2d_linear": ("hertz2d", ("-order", 1, "-adapt_max_passes", 5)),
    "hertz2d_hp": ("hertz2d", ("-adapt_strategy", "hp", "-adapt_tolerance", 0.02, "-load_step", 0.25, "-load_end", 0.5)),
    "rubber2d": ("rubber2d", ("-order", 1, "-adapt_max_passes", 4)),
    "slide2d": ("slide2d", ("-order", 1, "-adapt_max_passes", 2)),
    "blocks3d_linear": ("blocks3d", (*TILTED, "-order", 1, "-adapt_max_passes", 3)),
    "blocks3d": ("blocks3d", (*TILTED, "-order", 2, "-adapt_max_passes", 2)),
    "cube": ("cube", ()),
    "cube_hanging": ("cube", ("-boundary_x1_traction_z", -0.1, "-adapt_tolerance", 0.01, "-adapt_max_passes", 2, "-load_step", 1)),
}
COARSE = {"hertz2d_hp": ("-adapt_tolerance", 0.04), "blocks3d": ("-adapt_max_passes", 1), "cube_hanging": ("-adapt_max_passes", 1)}


def assert_same(one, many, scale):
    """Equal to 1e-8 relative; what is zero but for round-off to 1e-8 of the scale of its kind."""
    one, many = (dict(leaves(figures, lambda key: key not in OTHER)) for figures in (one, many))
    assert one.keys() == many.keys()
    worst = (0, "")
    for key, a in one.items():
        b = many[key]
        if isinstance(a, (int, float)) and isinstance(b, (int, float)):
            assert b == pytest.approx(a, rel=1e-8, abs=1e-8 * scale), key
            if abs(a) > 1e-6 * scale:
                worst = max(worst, (abs(b / a - 1), key))
        else:
            assert a == b, key
    return worst


def compare(run, scene, options, counts, exact=False):
    """exact: the solution is in the space, so that its estimated error is round-off and not compared."""
    one = run(f"inputs/{scene}.yml", *options)
    assert one.solved, one
    left_out = ("estimated_error", "estimate", "needs") if exact else ()
    force = max([np.abs(r).max() for r in one.summary["reaction"].values()])
    for ranks in counts:
        many = run(f"inputs/{scene}.yml", *options, ranks=ranks)
        assert many.solved and many.summary["ranks"] == ranks, many
        worst = assert_same(*({k: v for k, v in r.summary.items() if k not in left_out} for r in (one, many)), force)
        print(scene, ranks, "largest difference", worst)
        assert worst[0] <= 1e-8, worst
        assert len(one.history) == len(many.history) and len(one.adapt) == len(many.adapt)
        for table in ("history", "adapt"):
            for a, b in zip(getattr(one, table), getattr(many, table)):
                [row.pop(key, None) for key in ("seconds", *left_out) for row in (a, b)]
                assert_same(a, b, force)
        for column in ("newton_iterations", "cells", "dofs", "active_nodes"):
            assert [row[column] for row in one.adapt] == [row[column] for row in many.adapt], column


@pytest.mark.parametrize("name,ranks", [("hertz2d_linear", 3), ("hertz2d_hp", 3), ("rubber2d", 2), ("slide2d", 3), ("cube_hanging", 2), ("blocks3d_linear", 3),
                                        ("blocks3d", 2)])
def test_o101_ranks(run, name, ranks):
    scene, options = SCENES[name]
    compare(run, scene, (*options, *COARSE.get(name, ())), (ranks,))


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_o101_one_to_four_ranks(run, name):
    compare(run, *SCENES[name], (2, 3, 4))


def test_o101_contact_faces_are_split(run):
    """On three ranks both sides of the contact belong to more than one of them; otherwise the tests above would show little."""
    result = run("inputs/hertz2d.yml", "-order", 1, "-adapt_max_passes", 5, ranks=3)
    assert result.solved
    fields = result.states()[-1][1]
    assert set(np.unique(fields["rank"])) == {0, 1, 2}
    corner = (fields["X"])[np.asarray(fields["cells"])]
    near = np.abs(corner[:, :, 1]).min(axis=1) < 1e-9
    assert len(np.unique(fields["rank"][near])) > 1


def test_o101_more_ranks_than_cells(run):
    compare(run, "cube", ("-mesh_parameter_n", 1, "-load_step", 1), (3,))
    compare(run, "patch2d", ("-mesh_parameter_n", 1), (4,), exact=True)  # 10 cells, a contact side of one edge
