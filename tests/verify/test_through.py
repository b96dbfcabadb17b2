"""Solutions for which a body went right through the other one of a pair that bears nothing are none (src/diagnose/through.c)."""
import pytest

from combinations import half
from test_inside import RIGID, RUBBER, SLOW, scene

QUIET = ("-output_fields", "false")
ONE_STEP = ("-load_step_min", 0.6, "-path_inside", "off", *QUIET)  # not found where half of the step is too long
PASSED = {
    "cylinder": ("tests/verify/scenes/pressed_cylinder.yml", "-load_step", 1, "-body_plate_motion_y", 0.16),
    "hertz2d": ("inputs/hertz2d.yml", "-adapt_tolerance", 0, "-boundary_top_displacement_y", -1.4),
    "patch2d": ("inputs/patch2d.yml", "-boundary_top_displacement_y", -2.5),
    "corners": ("tests/verify/scenes/diamond.yml",),
}
SWAPPED = {
    "cylinder": ("-contact_c_nonmortar", "plate_top", "-contact_c_mortar", "arc"),
    "patch2d": ("-contact_upper_on_lower_nonmortar", "lower_top", "-contact_upper_on_lower_mortar", "upper_bottom"),
}


def forces(result):
    return [component for pair in result.summary["contact"].values() for component in pair["force"]]


def is_told(run, *words, **keys):
    """Asked, no such solution is taken; else it is, with exit status 0 and no force."""
    told, without = (run(*words, *ONE_STEP, "-path_through", mode, **keys) for mode in ("auto", "off"))
    assert told.returncode == 2 and told.summary["passed_through"] >= 1, told
    assert without.returncode == 0 and without.summary["passed_through"] == 0 and not any(forces(without)), without


@half("name,order", ["cylinder", "cylinder, swapped", "hertz2d", "patch2d", "patch2d, swapped", "corners"], [1, 2, 3])
def test_right_through(run, name, order):
    scene, *swapped = name.split(", ")
    is_told(run, *PASSED[scene], *(SWAPPED[scene] if swapped else ()), "-order", order)


@pytest.mark.parametrize("start,dim,law,ranks", [
    (1.0, 2, RUBBER, 1), (1.0, 2, RIGID, 2), (1.0, 3, RUBBER, 1), (1.0, 3, RIGID, 1), (1.3, 2, RUBBER, 1), (1.3, 3, RIGID, 1),
    *(pytest.param(*words, marks=SLOW) for words in ((1.0, 3, RUBBER, 2), (1.3, 2, RIGID, 2), (1.3, 3, RUBBER, 2)))])
def test_a_small_block_right_through(run, tmp_path, start, dim, law, ranks):
    """Out of the other side with all of it, from apart or from touch."""
    is_told(run, "s.yml", text=scene(tmp_path, dim, [start], [start + 0.5], law), ranks=ranks)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_step_sizes(run, order):
    """The force is the same in steps of any size."""
    found = [run(*PASSED["hertz2d"][:-1], "-1.03*t", "-order", order, "-load_step", step, *QUIET) for step in (1, 0.5, 0.25, 0.1)]
    for result in found: assert result.returncode == 0 and forces(result)[1] == pytest.approx(forces(found[-1])[1], rel=1e-6) != 0, result


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("law", [RUBBER, {"law": "rigid"}], ids=["rubber", "rigid"])
@pytest.mark.parametrize("across,down", [(1.5, 0.4), (1.6, 1.0)], ids=["off an edge", "round a corner"])
def test_out_at_a_side(run, tmp_path, dim, law, across, down):
    """Who slides off an edge or goes round a corner in one step has not passed, on the straight way neither."""
    result = run("s.yml", *ONE_STEP, text=scene(tmp_path, dim, [1.001], [down], law, across))
    assert result.returncode == 0 and result.summary["passed_through"] == 0 and not any(forces(result)), result


@pytest.mark.parametrize("dim", [2, 3])
def test_back_from_the_far_side(run, tmp_path, dim):
    """A block below the other one gets back to where it belongs."""
    result = run("s.yml", *ONE_STEP, text=scene(tmp_path, dim, [-0.5], [-1.6]))
    assert result.returncode == 0 and result.summary["passed_through"] == 0 and not any(forces(result)), result
