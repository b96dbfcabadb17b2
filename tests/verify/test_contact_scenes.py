"""The contact scenes of inputs/: reference forces, robustness on every mesh with either side nonmortar, Newton's order, the tangent by differences."""
import re

import pytest

from combinations import half
from contactkit import is_quadratic, steps

QUIET = ("-output_fields", "false")
SWAPPED = ("-contact_disc_on_block_nonmortar", "block_top", "-contact_disc_on_block_mortar", "disc_surface")
UNIFORM = ("-adapt_tolerance", 0)
ROLES = pytest.mark.parametrize("roles", [(), SWAPPED], ids=["disc", "block"])

HERTZ = 0.01875797  # reaction of hertz2d, to 1e-6
LINEAR = ("-order", 2, "-contact_disc_on_block_order", 1, "-adapt_tolerance", 0.02)  # contact faces
RUBBER = 0.4024  # of rubber2d, known to 0.0006


def solve(run, scene, *options, **keys):
    result = run(f"inputs/{scene}.yml", *QUIET, *options, **keys)
    assert result.returncode == 0, result
    return result


def pull(result):
    top, bottom = (result.summary["reaction"][name] for name in ("top", "bottom"))
    assert all(abs(a + b) < 1e-9 * abs(top[1]) for a, b in zip(top, bottom)), (top, bottom)
    pair = result.summary["contact"]["disc_on_block"]
    assert pair["force_imbalance"] < 1e-10 and pair["moment_imbalance"] < 1e-6
    return -top[1]


def solved_in_one_step(result, most):
    """No step cut, at most so many Newton iterations at each load, Newton's order at its end."""
    assert result.summary["step_cuts"] == 0 and len(steps(result)) == result.summary["load_steps"], result
    for norms in steps(result):
        assert len(norms) - 1 <= most, norms
        assert is_quadratic(norms), norms


@ROLES
def test_hertz2d_adaptive(run, roles):
    assert abs(pull(solve(run, "hertz2d", *roles)) / HERTZ - 1) < (3e-4 if roles else 1e-4)  # the estimate allowed is that of the energy, 1 %
    assert abs(pull(solve(run, "hertz2d", *LINEAR, *roles)) / HERTZ - 1) < 1e-3


@pytest.mark.slow
def test_hertz2d_adaptive_needs_a_fifth_of_the_cells(run):
    """For the same error of the force a uniform mesh needs more than five times as many cells: one of each of these sizes is still worse."""
    adaptive = solve(run, "hertz2d", *LINEAR)
    error, cells = abs(pull(adaptive) / HERTZ - 1), adaptive.summary["cells"]
    for n in (48, 56, 64):
        uniform = solve(run, "hertz2d", *LINEAR, *UNIFORM, "-mesh_parameter_n", n)
        assert uniform.summary["cells"] >= 5 * cells
        assert abs(pull(uniform) / HERTZ - 1) > error, n


@half("n, order, roles", [4, 8, 16, 6, 12, 24, 32, 48, 64], [1, 2], [(), SWAPPED], slow=(6, 12, 24, 32, 48, 64))
def test_hertz2d_every_mesh(run, n, order, roles):
    result = solve(run, "hertz2d", *UNIFORM, "-mesh_parameter_n", n, "-order", order, "-snes_monitor", *roles)
    solved_in_one_step(result, 5)
    pull(result)
    if n >= 32:
        assert abs(pull(result) / HERTZ - 1) < 6e-3  # first order in the size of the contact faces


@ROLES
def test_rubber2d_adaptive(run, roles):
    assert abs(pull(solve(run, "rubber2d", *roles)) - RUBBER) < 3e-3 * RUBBER + 6e-4


@half("n, roles", [4, 11, 6, 21, *(n for n in range(4, 33) if n not in (4, 6, 11, 21))], [(), SWAPPED], slow=[n for n in range(4, 33) if n not in (4, 6, 11, 21)])
def test_rubber2d_linear_faces(run, n, roles):
    """Order 3 inside, linear contact faces, the cells behind them subdivided twice: the force is right on every mesh. From n = 21 on facets are so small against
    the gaps of the first linear step that its curvature must not enter the second."""
    result = solve(run, "rubber2d", *UNIFORM, "-mesh_parameter_n", n, "-order", 3, "-contact_disc_on_block_subdivide", 2, "-snes_monitor", *roles)
    solved_in_one_step(result, 8)
    assert abs(pull(result) / RUBBER - 1) < 3e-3


@half("n, order, roles", [4, 8, 16, 6, 12, 24, 32], [1, 2], [(), SWAPPED], slow=(6, 12, 24, 32))
def test_rubber2d_every_mesh(run, n, order, roles):
    result = solve(run, "rubber2d", *UNIFORM, "-mesh_parameter_n", n, "-order", order, "-snes_monitor", *roles)
    solved_in_one_step(result, 8)
    force = pull(result)
    if n == 32:
        assert abs(force - RUBBER) < 3e-3 * RUBBER + 6e-4


@half("n, order, roles", [4, 8, 16, 6, 12, 24, 32, 48], [1, 2], [(), SWAPPED], slow=(6, 12, 24, 32, 48))
def test_slide2d_every_mesh(run, n, order, roles):
    """One load step to press, one to slide over many cells. With the block nonmortar the slide, linearised at the old place, is no small step: it needs the bodies
    taken to the new place first. The count of the history contains the linearisation that this discards."""
    result = solve(run, "slide2d", *UNIFORM, "-mesh_parameter_n", n, "-order", order, "-snes_monitor", *roles)
    assert result.summary["load_steps"] == 2
    solved_in_one_step(result, 8)
    assert max(step["newton_iterations"] for step in result.history) <= 8
    pull(result)


@half("slide, n", [0.1, 0.5, 0.8], [8, 16, 32], slow=[32])
def test_slide2d_deep_rubber(run, slide, n):
    """Nearly incompressible, pressed by 0.3: the zone is 1.4 wide and moves by a small to a large part of that."""
    motion = ("-boundary_top_displacement_x", f"{slide}*max(t - 1, 0)", "-boundary_top_displacement_y", "-0.3*min(t, 1)")
    result = solve(run, "slide2d", *UNIFORM, "-mesh_parameter_n", n, "-material_rubber_nu", 0.499, *motion, *SWAPPED)
    assert result.summary["step_cuts"] == 0 and result.summary["load_steps"] == 2
    assert max(step["newton_iterations"] for step in result.history) <= 8


@ROLES
def test_slide2d_adaptive(run, roles):
    result = solve(run, "slide2d", "-snes_monitor", *roles)
    assert result.summary["step_cuts"] == 0 and result.summary["load_steps"] == 2
    assert max(len(norms) - 1 for norms in steps(result)) <= 8, [len(norms) - 1 for norms in steps(result)]
    pressed, slid = result.history
    assert abs(slid["reaction.top.y"] / pressed["reaction.top.y"] - 1) < 0.01
    assert abs(slid["reaction.top.x"]) < 1e-3 * abs(slid["reaction.top.y"])


@ROLES
@pytest.mark.parametrize("scene, order", [("hertz2d", 1), ("hertz2d", 2), ("rubber2d", 1), ("rubber2d", 2)])
def test_o94_tangent(run, scene, order, roles):
    """PETSc's difference quotients of the residual at every Newton iterate but the first. There the disc touches without pressure, and on a symmetric mesh nodes
    face nodes: both are kinks, where a difference quotient means nothing. A sideways motion leads away from them."""
    result = solve(run, scene, *UNIFORM, "-mesh_parameter_n", 6, "-order", order, "-boundary_top_displacement_x", 0.013, "-snes_test_jacobian", *roles)
    ratios = [float(value) for value in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+?),", result.stdout)]
    assert len(ratios) >= 3, result
    assert max(ratios[1:]) < 1e-6, ratios


# ---- O-ring ---------------------------------------------------------------------------------------------------------------------------------

def test_oring(run):
    """One surface of the ring in two pairs, against floor, wall and lid at a time; nothing but contact holds it along the axis."""
    result = solve(run, "oring")
    s = result.summary
    assert s["step_cuts"] == 0 and s["newton_iterations"] <= 70 and s["estimated_error"] < 0.05, s
    lid, groove = s["contact"]["under_lid"], s["contact"]["in_groove"]
    assert abs(s["reaction"]["lid_top"][1] + 224.8) < 0.005 * 224.8 and abs(lid["max_pressure"] - 2.547) < 0.005 * 2.547, s
    assert abs(lid["force"][1] + groove["force"][1]) < 1e-8 * 224.8  # floor and lid balance; the wall bears along the radius alone
    assert groove["force"][0] < -20 and abs(lid["force"][0]) < 0.01, (groove, lid)
