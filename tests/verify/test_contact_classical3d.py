"""Classical contact in three dimensions: shrink fit (O-45), sphere on a plane of symmetry (O-52), punch with a rounded edge (O-56), sphere in rubber (O-58);
each against the same problem in two dimensions."""
import math
import pathlib

import numpy
import pytest

from contactkit import contact, surface

SCENES = pathlib.Path(__file__).resolve().parent / "scenes"
INPUTS = SCENES.parent.parent.parent / "inputs"
QUIET = ("-output_fields", "false")


def solved(run, *arguments, **keys):
    result = run(*arguments, **keys)
    assert result.solved and result.summary["step_cuts"] == 0, result
    return result


def pair(result, moment=1e-5):
    """Moments: parts of symmetric models, whose directions at the planes of symmetry are those of the whole, need not balance to the last digit."""
    (only,) = result.summary["contact"].values()
    assert only["force_imbalance"] < 1e-10 and only["moment_imbalance"] < moment
    return only


# ---- O-45 -------------------------------------------------------------------------------------------------------------------------------

PRESSURE, RADIUS, DEPTH = 65.93406593, 10, 2


def ring(run, n, *options):
    """Mean pressure and half the range of the nodal pressures, over the exact pressure."""
    result = solved(run, "inputs/shrinkfit3d.yml", "-mesh_parameter_n", n, *options)
    z = contact(result)["contact_pressure"] / PRESSURE
    force = pair(result)["force"]
    return result, math.hypot(*force[:2]) / (math.sqrt(2) * RADIUS * DEPTH * PRESSURE), (z.max() - z.min()) / 2


def test_o45_ring(run):
    """Divisions 48 and 72, and finer: mean pressure 0.3 % of the exact one and of the plane run; it converges as h^2; the ripple falls as h."""
    plane = solved(run, "inputs/shrinkfit.yml", "-mesh_parameter_n", 12)
    flat = math.hypot(*pair(plane)["force"]) / (math.sqrt(2) * RADIUS * PRESSURE)
    results, means, ripples = zip(*(ring(run, n) for n in (12, 24, 48)))
    assert abs(means[0] - 1) < 3e-3 and abs(means[0] / flat - 1) < 3e-3, (means, flat)
    assert all(abs(fine - 1) < max(0.35 * abs(coarse - 1), 2e-4) for coarse, fine in zip(means, means[1:])), means
    assert all(fine < 0.7 * coarse for coarse, fine in zip(ripples, ripples[1:])) and ripples[2] < 0.01, ripples
    for name, u in (("inner", -0.0037142857), ("outer", 0.0062857143)):
        assert abs(results[1].summary["probe"][name]["displacement"][0] / u - 1) < 5e-3, name


def test_o45_nothing_depends_on_z(run):
    """Two cells deep, supports of plane strain: the same pressure at every depth, no force along z, force as with one cell."""
    result, mean, _ = ring(run, 6, "-mesh_parameter_l", 2)
    rows = 5  # two faces of order 2 deep
    part = contact(result)
    angle, z = numpy.arctan2(part["X"][:, 1], part["X"][:, 0]), part["contact_pressure"]
    order = numpy.lexsort((part["X"][:, 2], angle.round(6)))
    assert numpy.allclose(numpy.ptp(z[order].reshape(-1, rows), axis=1), 0, atol=1e-6 * PRESSURE)
    assert abs(pair(result)["force"][2]) < 1e-8 * PRESSURE and abs(mean / ring(run, 6)[1] - 1) < 1e-8


def test_o45_roles(run):
    """The outer tube nonmortar: second order in the mean, 0.3 % at 48 and 72 divisions."""
    swap = ("-contact_fit_nonmortar", "outer_bore", "-contact_fit_mortar", "inner_shell", "-contact_fit_roles", "given")
    means = [ring(run, n, *swap, "-mesh_parameter_m", n)[1] - 1 for n in (6, 12)]
    assert abs(means[1]) < 3e-3 and abs(means[1]) < 0.35 * abs(means[0]), means


def test_o45_case(run):
    """24 and 36 divisions: mean 0.3 %, ripple 1 %, as in the plane."""
    _, mean, ripple = ring(run, 6)
    assert abs(mean - 1) < 3e-3 and ripple < 2e-3, (mean, ripple)


# ---- O-52 -------------------------------------------------------------------------------------------------------------------------------

# Lengths in radii: R = 50, approach 2 become 1 and 0.04. The plane of symmetry is the face of a rigid block.
BALL = f"""
mesh: {{file: {INPUTS}/hertz3d.geo, order: 4, parameter: {{n: 4, k: 1}}}}
model: 3d
kinematics: small
order: 2
body: {{ball: {{material: ball}}, block: {{material: hard}}}}
material: {{ball: {{law: linear, E: 2e4, nu: 0.3}}, hard: {{law: rigid}}}}
boundary: {{ball_x: {{fix: x}}, ball_y: {{fix: y}}, top: {{displacement: {{z: -DEPTH}}}}}}
contact: {{pair: {{nonmortar: ball_surface, mortar: block_top}}}}
refine: {{spot: {{boundary: ball_surface, x: 0, y: 0, radius: SPOT, levels: LEVELS}}}}
load: {{step: 1}}
adapt: {{tolerance: TOLERANCE, max_passes: 8, max_cells: 1500}}
"""
MERIDIAN = f"""
mesh: {{file: {SCENES}/hemisphere.geo, order: 4, parameter: {{r: 50}}}}
model: axisymmetric
kinematics: small
order: 2
body: {{ball: {{material: ball}}, plate: {{material: hard}}}}
material: {{ball: {{law: linear, E: 2e4, nu: 0.3}}, hard: {{law: rigid}}}}
boundary: {{axis: {{fix: x}}, flat: {{displacement: {{y: -2}}}}}}
contact: {{pair: {{nonmortar: surface, mortar: plate_top}}}}
refine: {{spot: {{boundary: surface, x: 0, y: 0, radius: 10, levels: 2}}}}
load: {{step: 1}}
adapt: {{tolerance: 0.01, max_passes: 12}}
"""
HERTZ_FORCE, HERTZ_PEAK = 586080.59, 2798.3287  # approach 2


def ball(run, depth, spot, levels, tolerance):
    """Small kinematics: forces act at reference positions a gap apart, so moments balance to the gap times the slope of the ball there, up to depth * 2 depth ** 0.5."""
    text = BALL.replace("DEPTH", str(depth)).replace("SPOT", str(spot)).replace("LEVELS", str(levels)).replace("TOLERANCE", str(tolerance))
    result = solved(run, "o52.yml", text=text)
    only = pair(result, max(1e-5, depth * depth**0.5))
    return result, 4 * 50**2 * only["force"][2], only["max_pressure"]


@pytest.mark.parametrize("levels", [3, pytest.param(4, marks=pytest.mark.slow)], ids=["h_1.2", "h_0.6"])
def test_o52_sphere(run, levels):
    """Largest pressure: 5 % of Hertz. The force is that of a hemisphere whose flat is pushed, 15 % above Hertz's half space at a / R = 0.2: the meridian's run
    has it too."""
    result, force, peak = ball(run, 0.04, 0.2, levels, 0.2)
    assert abs(peak / HERTZ_PEAK - 1) < 0.05
    meridian = solved(run, "meridian.yml", *QUIET, text=MERIDIAN)
    assert abs(force / pair(meridian)["force"][1] - 1) < 0.01 and abs(peak / pair(meridian)["max_pressure"] - 1) < 0.03, (force, pair(meridian))
    part = contact(result)
    corner = part["X"][part["cells"].astype(int)]
    inside = numpy.linalg.norm(corner[..., :2], axis=2).max(axis=1) < 0.2
    assert 50 * numpy.linalg.norm(corner[inside, 0] - corner[inside, 1], axis=1).max() < 10 / 2**levels


def test_o52_hundredth_of_the_approach(run):
    """a / R = 0.02: Hertz's force to 3 %, his peak to 5 %."""
    _, force, peak = ball(run, 0.0004, 0.02, 6, 0.1)
    assert abs(force / (1e-3 * HERTZ_FORCE) - 1) < 0.03 and abs(peak / (0.1 * HERTZ_PEAK) - 1) < 0.05


# ---- O-56 -------------------------------------------------------------------------------------------------------------------------------

ROUND = f"""
mesh: {{file: {SCENES}/roundpunch.geo, order: 4}}
model: axisymmetric
kinematics: small
order: 2
body: {{punch: {{material: steel}}, foundation: {{material: aluminium}}}}
material: {{steel: {{law: linear, E: 210e3, nu: 0.3}}, aluminium: {{law: linear, E: 70e3, nu: 0.3}}}}
boundary: {{axis: {{fix: x}}, head: {{traction: {{y: -100}}}}, bottom: {{fix: xy}}}}
contact: {{pair: {{nonmortar: foot, mortar: top, roles: given}}}}
probe: {{centre: {{x: 0, y: -1e-6}}}}
load: {{step: 1}}
adapt: {{tolerance: 0.01, max_passes: 12}}
"""
SWAPPED = ("-contact_pair_nonmortar", "top", "-contact_pair_mortar", "foot")
BENCHMARK = (-0.130734, -91.1006)


def section(run, *options):
    """Displacement and stress at the centre of the foundation's top."""
    result = solved(run, "round.yml", *QUIET, *options, text=ROUND)
    assert result.returncode == 0, result  # the tolerance is reached
    centre = result.summary["probe"]["centre"]
    return centre["displacement"][1], centre["stress"][3]


def test_o56_rounded_punch(run):
    """Quarter and section agree: displacement 1 %. Moments of the rounded side's pressures balance to the gap that its motion leaves, as for the ball above."""
    result = solved(run, "inputs/punch3d.yml", *QUIET, "-adapt_tolerance", 0.15)
    assert result.summary["adapt_passes"] <= 5 and result.summary["cells"] < 800, result  # with the foundation's side as the nonmortar one 13 passes and 979 cells
    assert abs(pair(result, 1e-4)["force"][2] / (25 * math.pi * 50**2) - 1) < 2e-4
    centre = result.summary["probe"]["centre"]
    assert abs(centre["displacement"][2] / section(run)[0] - 1) < 0.01, centre


@pytest.mark.slow
def test_o56_stress(run):
    """As the scene is: displacement 1 %, stress and contact pressure at the centre 3 % of the section's stress."""
    u, stress = section(run, "-adapt_tolerance", 0.005)
    result = solved(run, "inputs/punch3d.yml")
    centre = result.summary["probe"]["centre"]
    assert abs(centre["displacement"][2] / u - 1) < 0.01 and abs(centre["stress"][5] / stress - 1) < 0.03, (centre, u, stress)
    part = contact(result)
    middle = numpy.argmin(numpy.linalg.norm(part["X"][:, :2], axis=1))
    assert abs(part["contact_pressure"][middle] / -stress - 1) < 0.03


FINEST = (-0.1339807, -87.256)  # order 4 at an estimate of 1e-3; the benchmark's stress, of coarse cells, is 4.4 % more


@pytest.mark.parametrize("faces, stress, tolerance", [(1, BENCHMARK[1], 0.04), ("full", FINEST[1], 4e-3)])
def test_o56_section(run, faces, stress, tolerance):
    """Either role, and twice as fine: the same displacement to 1e-3; stress, with linear faces that of the benchmark to 4 %."""
    face = ("-contact_pair_order", faces)
    values = [section(run, *face), section(run, *face, "-adapt_tolerance", 0.005), section(run, *face, "-adapt_tolerance", 0.005, "-adapt_max_passes", 24, *SWAPPED)]
    assert max(abs(u / FINEST[0] - 1) for u, _ in values) < 1e-3, values
    assert max(abs(s / stress - 1) for _, s in values) < tolerance, values


@pytest.mark.parametrize("order", [2, 3, 4])
def test_o56_roles(run, order):
    """The punch's edge is rounded within a facet of the softer foundation, also where arcs of its mesh meet in kinks of either sign: its foot carries the multiplier, whatever the scene calls it."""
    auto = ("-contact_pair_roles", "auto", "-mesh_order", order, "-adapt_tolerance", 0.1)
    plain, swapped = solved(run, "round.yml", *QUIET, *auto, text=ROUND), solved(run, "round.yml", *QUIET, *auto, *SWAPPED, text=ROUND)
    assert not pair(plain)["roles_exchanged"] and pair(swapped)["roles_exchanged"], plain
    assert plain.returncode == 0 and plain.summary["adapt_passes"] <= 6 and plain.summary["energy"] == pytest.approx(swapped.summary["energy"], rel=1e-12)


def test_o56_roles_matter(run):
    """With the foundation's facets round the punch's edge: 12 passes do not reach what 9 do with the punch's foot as the nonmortar side, and on one mesh a single node bears all."""
    foot, top = (solved(run, "round.yml", *QUIET, *roles, "-adapt_tolerance", 0.005, text=ROUND) for roles in ((), SWAPPED))
    for result in (foot, top): print([round(row["estimated_error"], 3) for row in result.adapt], [row["active_nodes"] for row in result.adapt])
    assert foot.returncode == 0 and foot.summary["adapt_passes"] <= 9
    assert top.returncode == 2 and top.summary["estimated_error"] > 0.02 and any(row["active_nodes"] == 1 for row in top.adapt)


@pytest.mark.xfail(strict=True, reason="the benchmark's displacement is an average of codes on coarse cells; both roles, orders 1 and 2 and the quarter in "
                                       "three dimensions converge to -0.1340, 2.5 % more")
def test_o56_benchmark(run):
    assert abs(section(run)[0] / BENCHMARK[0] - 1) < 0.01


# ---- O-58 -------------------------------------------------------------------------------------------------------------------------------

TABLE = [(.17270, .31, .80), (.48977, .44, 1.19), (.89814, .54, 1.53), (1.37621, .62, 1.87), (1.91059, .69, 2.22)]
ADAPTED = ("-adapt_tolerance", 0.08, "-adapt_max_cells", 1100)


def reach(rubber):
    """Deformed radius of the outermost node that carries, and the largest facet within it."""
    x, faces = (rubber["X"] + rubber["displacement"])[:, :2], rubber["cells"].astype(int)
    r = numpy.linalg.norm(x, axis=1)
    outermost = r[rubber["contact_pressure"] > 0].max()
    corner = x[faces[(r[faces] < outermost).any(axis=1)]]
    return outermost, numpy.linalg.norm(corner[:, 0] - corner[:, 1], axis=1).max()


COARSE = ("-refine_spot_levels", 2, "-mesh_parameter_s", 14)


@pytest.mark.parametrize("options", [COARSE, *(pytest.param(words, marks=pytest.mark.slow) for words in ((), ADAPTED))], ids=["coarse", "given", "adapted"])
def test_o58_sphere_in_rubber(run, options):
    """Force 1 % of the table and of the axisymmetric run; the outermost node that carries lies within one face of that run's radius of contact."""
    result = solved(run, "inputs/sphere3d.yml", *options)
    flat = solved(run, "inputs/sphere.yml", *QUIET)
    assert len(result.history) == len(flat.history) == 5
    states = {round(5 * t): surface(state, 0) for t, state in result.states("contact")}
    for k, (row, other, (force, _, _)) in enumerate(zip(result.history, flat.history, TABLE)):
        total = -4 * row["contact.ball_on_rubber.force.z"]
        assert abs(total / force - 1) < 0.01 and abs(total / -other["contact.ball_on_rubber.force.y"] - 1) < 0.01, (k, total)
        if options is not ADAPTED:  # under adaptation a node may carry through coarse facets that hang
            outermost, size = reach(states[k + 1])
            assert abs(outermost - other["contact.ball_on_rubber.radius"]) < size, (k, outermost, size)
