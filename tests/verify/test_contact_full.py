"""Contact faces of full order (contact.<pair>.order: full): patch tests in the plane and in space, Hertz and rubber against linear faces, shrink fit on curved
faces that do not match, the tangent, ranks, the key."""
import itertools
import math
import re

import numpy
import pytest

import test_contact_patch as plane
import test_contact_patch3d as space
from contactkit import PAIRINGS, SIDES, blocks, contact, is_quadratic, spread, steps

FULL = {"order": "full"}
QUIET = ("-output_fields", "false")
HERTZ = ("inputs/hertz2d.yml", "-contact_disc_on_block_order", "full", "-adapt_tolerance", 0.02)
RUBBER = ("inputs/rubber2d.yml", "-contact_disc_on_block_order", "full")


def cases():
    """All pairings and sides; a few are quick."""
    for pairing, nonmortar, order in itertools.product(PAIRINGS, SIDES, (2, 3, 4)):
        quick = (pairing, order) in (("two_to_three", 3), ("hanging_upper", 2), ("hanging_lower", 4))
        yield pytest.param(pairing, nonmortar, order, marks=() if quick else pytest.mark.slow)


matrix = pytest.mark.parametrize("pairing, nonmortar, order", list(cases()))


# ---- patch tests in the plane -----------------------------------------------------------------------------------------------------------

@matrix
def test_o40_small_strain(run, pairing, nonmortar, order):
    plane.check_o40(run, pairing, nonmortar, order, FULL)


@matrix
def test_o41a_finite_strain(run, pairing, nonmortar, order):
    result = plane.check_o41a(run, pairing, nonmortar, order, FULL)
    assert spread(contact(result, 1)["contact_pressure"], plane.PRESSURE) < 1e-8


@matrix
def test_o42_rotated(run, pairing, nonmortar, order):
    plane.check_o42(run, pairing, nonmortar, order, FULL)


def test_nodes_on_faces(run):
    """The grid shows a face of order p as p pieces between its nodes."""
    scene = blocks("upper", {"lower": plane.hyperelastic(100), "upper": plane.hyperelastic(1000)}, {**plane.rolled(), "top": {"displacement": {"y": -0.3}}},
                   {"nl": 4, "nu": 6}, None, FULL, order=3)
    result = run("o41.yml", text=scene)
    assert result.returncode == 0, result
    assert len(contact(result)["cells"]) == 3 * 6 and len(contact(result)["X"]) == 3 * 6 + 1
    assert len(contact(result, 1)["cells"]) == 3 * 4 and len(contact(result, 1)["X"]) == 3 * 4 + 1


# ---- patch tests in space ---------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("pairing, nonmortar", [("two_to_three", "upper"), ("two_to_three", "lower"), ("hanging_upper", "upper"), ("hanging_lower", "upper")])
def test_o41a_space(run, tmp_path, pairing, nonmortar):
    result, error = space.finite_strain(run, tmp_path, pairing, nonmortar, 2, "-snes_monitor", pair=FULL)
    assert max(error) < 1e-8
    assert result.summary["load_steps"] == 1 and result.summary["step_cuts"] == 0
    assert is_quadratic(steps(result)[0]), steps(result)


# ---- nodes that carry no multiplier -----------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("order", [2, 3, 4])
def test_axis(run, order):
    """No node on the axis carries a multiplier from order 2 on; the pressure there is that of its neighbours, and the estimate finds nothing amiss."""
    result = run("inputs/patch2d.yml", "-model", "axisymmetric", "-contact_upper_on_lower_order", "full", "-order", order)
    assert result.returncode == 0, result
    assert spread(contact(result)["contact_pressure"], contact(result)["contact_pressure"].max()) < 1e-6
    assert result.summary["estimate"]["total"] < 1e-8


@pytest.mark.parametrize("pairing, order, ranks", [
    *((pairing, order, 1) for pairing in ("two_to_three", "hanging_upper") for order in (2, 3, 4)), ("two_to_three", 2, 3), ("hanging_upper", 3, 3),
    *(pytest.param(*words, 3, marks=pytest.mark.slow) for words in (("two_to_three", 3), ("two_to_three", 4), ("hanging_upper", 2), ("hanging_upper", 4)))])
def test_held_ends(run, pairing, order, ranks):
    """Ends held where they are under uniform pressure show it."""
    parameter, side = PAIRINGS[pairing]
    ends = {name: {"displacement": {"x": 0, "y": "-0.05 * Y"}} for name in plane.rolled() if name != "bottom"}
    steel = plane.linear(2e6, 0)
    scene = blocks("upper", {"lower": steel, "upper": steel}, {**ends, "bottom": {"fix": "y"}, "top": {"displacement": {"y": -0.1}}}, parameter,
                   plane.refined(side), FULL, kinematics="small", order=order)
    result = run("held.yml", text=scene, ranks=ranks)
    assert result.returncode == 0, result
    assert spread(contact(result)["contact_pressure"], 1e5) < 1e-10
    assert result.summary["estimate"]["total"] < 1e-7 * result.summary["estimate"]["norm"]


@pytest.mark.parametrize("pairing, order, ranks", [("two_to_three", 2, 1), ("two_to_three", 3, 2), ("hanging_upper", 2, 3)])
def test_held_sides_space(run, tmp_path, pairing, order, ranks):
    """Two sides and the corner between them held, hanging nodes beside."""
    nl, nu, side = space.PAIRINGS[pairing]
    steel = space.linear(2e6, 0)
    held = {f"{name}_{block}": {"displacement": {"x": 0, "y": 0, "z": "-0.05 * Z"}} for name in ("x0", "y0") for block in space.SIDES}
    mesh = space.cubes(tmp_path / "held.msh", nl, nu)
    text = space.text(mesh, "upper", {"lower": steel, "upper": steel}, {**space.ROLLERS, **held, "z1_upper": {"displacement": {"z": -0.1}}},
                      space.spot(side, (0.1, 0.1, 1)), FULL, kinematics="small", order=order)
    result = run("held.yml", text=text, ranks=ranks)
    assert result.solved, result
    assert spread(contact(result)["contact_pressure"], 1e5) < 1e-9
    assert result.summary["estimate"]["total"] < 1e-7 * result.summary["estimate"]["norm"]


# ---- curved bodies ----------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("order", [2, 3, 4])
def test_hertz(run, order):
    """Adapted to 2 %, on far fewer cells than linear faces take, one load step and Newton's method without a cut."""
    result = run(*HERTZ, "-order", order, *QUIET)
    assert result.returncode == 0, result
    s = result.summary
    assert s["adapt_stop"] == "tolerance" and s["step_cuts"] == 0
    assert abs(s["contact"]["disc_on_block"]["force"][1] / 0.01875797 - 1) < 5e-4, s
    linear = run(*HERTZ, "-contact_disc_on_block_order", 1, "-order", order, *QUIET).summary
    assert s["dofs"] < linear["dofs"], (s["dofs"], linear["dofs"])


def test_hertz_space(run):
    """Hanging nodes on round faces leave slivers between mortar facets; a facet is no less covered for them, or its functions would change from one iterate to
    the next."""
    result = run("inputs/hertz3d.yml", "-contact_ball_on_block_order", "full", "-order", 3, "-mesh_order", 4, "-adapt_tolerance", 0.1, *QUIET).summary
    assert result["step_cuts"] == 0 and result["estimate"]["total"] < 0.1 * result["estimate"]["norm"]
    assert abs(result["reaction"]["top"][2] / -0.002438 - 1) < 4e-3


@pytest.mark.parametrize("order", [2, 3, 4])
def test_rubber(run, order):
    """Order 4 stops a little short: beyond, the cell in the clamped corner collapses, whatever the faces."""
    result = run(*RUBBER, "-order", order, *QUIET, "-adapt_tolerance", 0.065)
    assert result.returncode == 0, result
    s = result.summary
    assert s["adapt_stop"] == "tolerance" and s["step_cuts"] == 0
    assert abs(s["contact"]["disc_on_block"]["force"][1] / 0.4024 - 1) < 4e-3, s


def fit(run, order, n, gap):
    result = run("inputs/shrinkfit.yml", "-contact_fit_order", "full", "-contact_fit_initial_gap", gap, "-order", order, "-mesh_order", order,
                 "-mesh_parameter_n", n, "-mesh_parameter_m", n)
    assert result.returncode == 0, result
    z = contact(result)["contact_pressure"] / 65.93406593
    mean = math.hypot(*result.summary["contact"]["fit"]["force"]) / (math.sqrt(2) * 10) / 65.93406593
    return abs(mean - 1), numpy.abs(z - 1).max()


@pytest.mark.parametrize("order", [2, 3, 4])
def test_o45_shrink_fit(run, order):
    """Faces of order p on circles that do not match: the largest error of the pressure falls as h^p, its mean as h^(p+1) at least."""
    (coarse_mean, coarse), (fine_mean, fine) = (fit(run, order, n, "adjust") for n in ((3, 6) if order == 4 else (6, 12)))
    assert coarse < 0.02 and fine < 1.5 * 0.5**order * coarse, (coarse, fine)
    assert fine_mean < max(1.5 * 0.5 ** (order + 1) * coarse_mean, 1e-8), (coarse_mean, fine_mean)


def test_o45_gaps_kept(run):
    """Faces of order 4 lie on the circle so well that their gaps need not be taken off."""
    coarse, fine = fit(run, 4, 3, "keep"), fit(run, 4, 6, "keep")
    assert coarse[1] < 2e-3 and fine[1] < 1e-4, (coarse, fine)


# ---- the tangent, ranks, the key --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("order", [2, 4])
def test_tangent(run, order):
    """Off the middle, where no two vertices face each other: there the gap has one derivative only."""
    result = run(*HERTZ, "-order", order, *QUIET, "-adapt_max_passes", 1, "-boundary_top_displacement_x", 0.0171, "-snes_test_jacobian")
    ratios = [float(r) for r in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+),", result.stdout)]
    assert result.solved and len(ratios) > 5 and max(ratios) < 1e-6, ratios


@pytest.mark.parametrize("case, order, ranks", [(HERTZ, 3, 3), (RUBBER, 2, 2), *(pytest.param(*words, marks=pytest.mark.slow) for words in ((HERTZ, 3, 2), (RUBBER, 2, 3)))])
def test_ranks(run, case, order, ranks):
    """The same on 1, 2 and 3 processes."""
    one, *others = [run(*case, "-order", order, *QUIET, "-adapt_max_passes", 2, ranks=r) for r in (1, ranks)]
    for result in (one, *others):
        assert result.solved, result
        pair, first = (r.summary["contact"]["disc_on_block"] for r in (result, one))
        assert result.summary["dofs"] == one.summary["dofs"] and pair["active_nodes"] == first["active_nodes"]
        assert abs(pair["force"][1] / first["force"][1] - 1) < 1e-8 and abs(pair["max_pressure"] / first["max_pressure"] - 1) < 1e-8


def test_key(run):
    for options, words in ((("-contact_disc_on_block_order", 2), "allowed: 1|full"),
                           (("-contact_disc_on_block_order", "full", "-contact_disc_on_block_node_to_segment", "true"), "do not go together")):
        result = run("inputs/hertz2d.yml", *options)
        assert result.returncode == 1 and words in result.stderr and result.stderr.count("\n") == 1, result
    assert ", linear faces" not in run(*HERTZ, "-check").stdout


@pytest.mark.parametrize("scene", ["slide", "slide3d"])
def test_order_one(run, scene):
    """Faces of full order on cells of order 1 are those of order 1: one discrete problem, off an edge too, to the last digit."""
    full, one = (run(f"tests/gauntlet/{scene}.yml", "-order", 1, "-load_end", 1.5, "-contact_c_order", order, *QUIET) for order in ("full", 1))
    assert full.solved and one.solved, (full, one)
    assert len(full.history) == len(one.history)
    for a, b in zip(full.history, one.history):
        assert {k: v for k, v in a.items() if k != "seconds"} == {k: v for k, v in b.items() if k != "seconds"}
