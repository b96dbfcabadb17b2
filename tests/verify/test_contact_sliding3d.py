"""Large sliding in three dimensions (section 7 of the cases): histories of force and displacement, and how Newton's method gets along them."""
import numpy
import pytest

from conftest import ROOT

QUIET = ("-output_fields", "false")


def solve(run, scene, *options, **keys):
    result = run(scene, *options, **keys)
    assert result.returncode == 0 and result.summary["status"] == "converged", result
    return result


def column(result, name):
    return numpy.array([row[name] for row in result.history])


def at(result, times, name):
    """A column of the history at times; steps that were cut lie in between."""
    return numpy.interp(times, column(result, "t"), column(result, name))


def balanced(result):
    touching = column(result, "contact_force") > 0  # before, forces are round-off
    assert touching.any() and max(column(result, name)[touching].max() for name in ("contact_imbalance", "support_imbalance")) < 1e-8, result


# O-60, shallow ironing. Published history, read from a plot of the frictionless run (Kratos against Poulios & Renard), in units of 1e8.
IRONING = {0.3: (0.23, 0), 0.5: (0.80, 0.03), 0.7: (1.48, 0.12), 0.9: (2.25, 0.23), 1.0: (2.68, 0.30), 1.2: (3.31, 0.02), 1.5: (3.38, 0), 1.8: (3.33, -0.02), 2.0: (2.90, -0.20)}
FOUR_PERCENT = 0.04 * 3.4
SWAPPED = ("-contact_crown_on_block_nonmortar", "block_top", "-contact_crown_on_block_mortar", "crown")
# ten steps of a tenth for the press, then 500 to slide: the step is the unit of t
CASE_STEPS = ("-load_end", 510, "-load_step", 1, "-boundary_top_displacement_x", "max(t - 10, 0)/50", "-boundary_top_displacement_y", "0 - min(t/10, 1)")


def ironing_errors(result, times, component):
    force = at(result, times, "reaction.bottom.y") if component == 0 else at(result, times, "reaction.top.x")
    return numpy.abs(force / 1e8 - [IRONING[t][component] for t in times])


def in_the_plane():
    """The scene without its third direction."""
    text = (ROOT / "inputs/ironing.yml").read_text()
    for old, new in (("file: ironing.geo", f"file: {ROOT}/inputs/ironing.geo"), ("d: 1}", "d: 0}"), ("model: 3d", "model: plane_strain"), ("      z: 0\n", ""),
                     ("bottom: {fix: xyz}", "bottom: {fix: xy}"), ("  back:   {fix: z}\n", "")):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


@pytest.mark.parametrize("roles", [(), SWAPPED], ids=["crown", "block"])
def test_o60_press(run, roles):
    """Pressed in ten steps, then slid by a sixth of the indenter's width in one: no cut. Linear solutions as rough as 1e-6, too rough for the active set, cost the
    second role a cut."""
    result = solve(run, "inputs/ironing.yml", *QUIET, *roles, "-load_step", 0.1, "-load_end", 1)
    times = [t for t in IRONING if t <= 1]
    assert ironing_errors(result, times, 0).max() < FOUR_PERCENT and ironing_errors(result, times, 1).max() < FOUR_PERCENT
    slid = solve(run, "inputs/ironing.yml", *QUIET, *roles, "-load_step", 0.02, "-load_end", 1.02)
    for r in (result, slid):
        balanced(r)
        assert r.summary["step_cuts"] == 0 and column(r, "newton_iterations").max() <= 10
    assert slid.history[-1]["reaction.bottom.y"] > result.history[-1]["reaction.bottom.y"]


@pytest.mark.slow
@pytest.mark.parametrize("roles", [(), SWAPPED], ids=["crown", "block"])
def test_o60_history(run, roles):
    result = solve(run, "inputs/ironing.yml", *QUIET, *roles)
    balanced(result)
    assert result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 10
    assert ironing_errors(result, list(IRONING), 1).max() < FOUR_PERCENT
    assert ironing_errors(result, [t for t in IRONING if t <= 1], 0).max() < FOUR_PERCENT
    assert ironing_errors(result, list(IRONING), 0).max() < 0.06 * 3.4


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="vertical force while sliding 5.7 % above the published 3.38e8; other published histories (with friction) lie between 3.37e8 and 4.21e8")
def test_o60_published_plateau(run):
    assert ironing_errors(solve(run, "inputs/ironing.yml", *QUIET), [1.2, 1.5, 1.8, 2.0], 0).max() < FOUR_PERCENT


@pytest.mark.slow
def test_o60_ripple_in_the_plane(run):
    """Plane strain, the 510 steps of the case: no cut; on the plateau no saw-teeth where faces pass faces."""
    result = solve(run, "plane.yml", *QUIET, *CASE_STEPS, text=in_the_plane())
    assert result.summary["load_steps"] == 510 and result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 8
    slide = numpy.maximum(column(result, "t") - 10, 0) / 50
    plateau = (slide > 3) & (slide <= 7)
    s, fy, fx = slide[plateau] - 5, at(result, column(result, "t"), "reaction.bottom.y")[plateau], column(result, "reaction.top.x")[plateau]
    rest = fy - numpy.polyval(numpy.polyfit(s, fy, 3), s)
    passing = 2 * abs(numpy.mean(rest * numpy.exp(2j * numpy.pi * s / 0.2)))  # faces of the block are 0.2 long
    assert passing < 1e-3 * fy.mean() and numpy.ptp(rest) < 5e-3 * fy.mean()
    assert (abs(fx) / fy).max() < 0.01


@pytest.mark.slow
def test_o60_plane_against_slice(run):
    """A slice held on both faces is plane strain: the same forces up to the projection of gaps, and a stiffer block than with one face free."""
    plane = solve(run, "plane.yml", *QUIET, "-load_step", 0.1, "-load_end", 1, text=in_the_plane())
    held = solve(run, "inputs/ironing.yml", *QUIET, "-load_step", 0.1, "-load_end", 1, "-boundary_front_fix", "z")
    free = solve(run, "inputs/ironing.yml", *QUIET, "-load_step", 0.1, "-load_end", 1)
    times = [0.3, 0.5, 0.7, 0.9, 1.0]
    a, b, c = (at(r, times, "reaction.bottom.y") for r in (plane, held, free))
    assert numpy.abs(b / a - 1).max() < 1e-3 and (c < 0.95 * a).all()


# O-60 with friction of 0.3, both forces: read from the plot of Kratos' run against Poulios & Renard, in units of 1e8 (the vertical ones are those without friction).
FRICTION = {0.5: (0.85, 0.16), 1.0: (2.68, 0.56), 1.2: (3.33, 1.00), 1.5: (3.38, 1.03), 1.8: (3.33, 0.99), 2.0: (2.90, 0.64)}


@pytest.mark.slow
def test_o60_friction(run):
    """Both forces; on the way the vertical one is as much above the published one as without friction."""
    result = solve(run, "inputs/ironing.yml", *QUIET, "-contact_crown_on_block_friction", 0.3)
    balanced(result)
    down, along = (at(result, list(FRICTION), name) / 1e8 for name in ("reaction.bottom.y", "reaction.top.x"))
    published = numpy.array(list(FRICTION.values())).T
    print(down - published[0], along - published[1], result.summary["newton_iterations"], result.summary["step_cuts"])
    assert result.summary["step_cuts"] == 0 and column(result, "contact.crown_on_block.dissipation").min() > -1e-12 * result.history[-1]["energy"]
    assert numpy.abs(along - published[1]).max() < FOUR_PERCENT and abs(down[0] - published[0][0]) < FOUR_PERCENT
    assert numpy.abs(down - published[0]).max() < 0.075 * 3.4


# O-61, double-layer arch: imposed displacement of the ends and published displacement of the middle, mm.
ARCH = {20: -5.8, 30: -5.2, 40: -3.5, 50: 0.6, 55: 8.5, 57.5: 27, 60: 40, 65: 50.5, 70: 56.7}
ARCH_ROLES = ("-contact_ring_on_block_nonmortar", "block_top", "-contact_ring_on_block_mortar", "ring_skin", "-contact_ring_on_block_roles", "given")
ARCH_SLICE = ("-mesh_parameter_d", 25, "-model", "3d", "-boundary_back_fix", "z", "-boundary_front_fix", "z", "-boundary_ends_displacement_z", 0, "-boundary_bottom_fix", "xyz")


def middle(result, times=tuple(ARCH)):
    return at(result, times, "probe.middle.displacement.y")


def test_o61_lift_off_and_snap(run):
    """The middle lifts off while the ring stays in contact beside it, then the ring snaps: no step is cut, in steps of 5 mm either, and both sides as nonmortar agree."""
    result = solve(run, "inputs/arch.yml")
    balanced(result)
    iterations = column(result, "newton_iterations")
    assert result.summary["step_cuts"] == 0 and iterations[:16].max() <= 5 and iterations.max() <= 15  # a step of the snap moves the middle by 25 mm
    pressed, buckled = middle(result, (20, 70))
    assert pressed < 0 < 50 < buckled
    assert column(result, "contact_force").argmax() < len(result.history) - 5  # the force falls when the ring snaps
    last = result.states("contact")[-1][1]
    touching = last["X"][last["status"] > 0]
    assert touching[:, 0].min() > 20  # beside the middle alone
    coarse = solve(run, "inputs/arch.yml", *QUIET, "-load_step", 5)
    assert coarse.summary["step_cuts"] == 0 and abs(coarse.history[-1]["probe.middle.displacement.y"] - buckled) < 1e-4
    swapped = solve(run, "inputs/arch.yml", *QUIET, *ARCH_ROLES)
    assert swapped.summary["step_cuts"] == 0 and numpy.abs(middle(swapped, (20, 30, 40, 60, 65, 70)) - middle(result, (20, 30, 40, 60, 65, 70))).max() < 0.5


@pytest.mark.slow
def test_o61_mesh_and_slice(run):
    """Converged in the mesh; a slice held on both faces says the same as the plane."""
    times = (20, 30, 40, 60, 65, 70)
    coarse = solve(run, "inputs/arch.yml", *QUIET)
    fine = solve(run, "inputs/arch.yml", *QUIET, "-mesh_parameter_n", 48, "-mesh_parameter_k", 50)
    assert numpy.abs(middle(fine, times) - middle(coarse, times)).max() < 0.5
    plane = solve(run, "inputs/arch.yml", *QUIET, "-order", 1)
    slice_ = solve(run, "inputs/arch.yml", *QUIET, "-order", 1, *ARCH_SLICE)
    assert numpy.abs(middle(slice_, times) - middle(plane, times)).max() < 0.1
    balanced(slice_)


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="with the moduli named the middle lies 3.8 to 5.9 mm above the published curve up to 40 mm and the ring snaps 8 mm earlier, on every mesh, with "
                   "either side nonmortar; a block of 100 instead of 300 MPa comes to 0.8 mm up to 40 mm and 1.5 mm from 65 mm on")
def test_o61_published(run):
    error = numpy.abs(middle(solve(run, "inputs/arch.yml", *QUIET)) - list(ARCH.values()))
    assert error[:4].max() < 1.5 and error[-2:].max() < 4


# O-61 with friction of 0.5, read from the plot of Kratos' run against Poulios & Renard.
ARCH_FRICTION = {20: -5.8, 30: -5.5, 40: -4.2, 50: -1.6, 60: 1.8, 65: 5.4, 70: 11.3}


@pytest.mark.parametrize("modulus", [100, pytest.param(300, marks=pytest.mark.slow)])
def test_o61_friction(run, modulus):
    """Friction keeps the feet of the ring together: the middle stays lower and does not snap, at either modulus of the block and with either side nonmortar. Steps of 5 mm."""
    times, options = tuple(ARCH_FRICTION), (*QUIET, "-load_step", 5, "-material_soft_E", modulus)
    plain, result = (solve(run, "inputs/arch.yml", *options, *words) for words in ((), ("-contact_ring_on_block_friction", 0.5)))
    balanced(result)
    print(modulus, middle(result, times) - list(ARCH_FRICTION.values()), result.summary["newton_iterations"])
    taken = column(result, "contact.ring_on_block.dissipation")
    assert result.summary["step_cuts"] == 0 and taken.min() > -1e-12 * taken.sum()
    assert (middle(result, times) < middle(plain, times)).all() and middle(result, times)[-1] < 25 < middle(plain, times)[-1]
    if modulus != 100: return
    assert (numpy.abs(middle(result, times) - list(ARCH_FRICTION.values()))[:4] < 1.5).all()
    swapped = solve(run, "inputs/arch.yml", *options, "-contact_ring_on_block_friction", 0.5, *ARCH_ROLES)
    assert numpy.abs(middle(swapped, times) - middle(result, times)).max() < 0.5


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="with the moduli named the middle lies 3.5 to 7.7 mm above the published curve; with a block of 100 MPa within 1.3 mm to 50 mm, then up to 9 mm above")
def test_o61_friction_published(run):
    error = numpy.abs(middle(solve(run, "inputs/arch.yml", *QUIET, "-contact_ring_on_block_friction", 0.5), tuple(ARCH_FRICTION)) - list(ARCH_FRICTION.values()))
    assert error[:4].max() < 1.5 and error[-2:].max() < 4


# O-62, ring between plates: published force on half of a plate, N, and its tolerance, at a quarter, half, three quarters and all of 4.45 cm.
RING, RING_TOLERANCE = numpy.array([8.0083, 16.0166, 24.0250, 32.0333]), numpy.array([0.10, 0.06, 0.04, 0.04])
RING_TIMES = (0.25, 0.5, 0.75, 1)
PLANE_STRAIN = ("-boundary_front_fix", "z")


def ring_force(result):
    return at(result, RING_TIMES, "contact_force")


def test_o62_ring(run):
    """In plane strain the published forces; all of it in one step too; the pressure moves from the middle to the edge of the zone."""
    result = solve(run, "inputs/ring.yml", *PLANE_STRAIN)
    balanced(result)
    assert (numpy.abs(ring_force(result) / RING - 1) < RING_TOLERANCE).all()
    assert result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 6
    once = solve(run, "inputs/ring.yml", *QUIET, *PLANE_STRAIN, "-load_step", 1)
    assert once.summary["load_steps"] == 1 and once.summary["newton_iterations"] <= 8
    assert abs(once.history[-1]["contact_force"] / result.history[-1]["contact_force"] - 1) < 1e-8
    for (_, state), split in zip(result.states("contact"), (False, False, False, True)):
        nonmortar = numpy.unique(state["cells"].astype(int)[state["side"] == 0])
        x, z = (state["X"] + state["displacement"])[nonmortar, 0], state["contact_pressure"][nonmortar]
        assert (x[z.argmax()] > 1) == split
    swapped = solve(run, "inputs/ring.yml", *QUIET, *PLANE_STRAIN, "-mesh_parameter_k", 16, "-contact_ring_on_plate_nonmortar", "plate_top", "-contact_ring_on_plate_mortar", "outside",
                    "-contact_ring_on_plate_roles", "given")
    assert numpy.abs(ring_force(swapped) / ring_force(result) - 1).max() < 0.01


def test_o62_friction(run):
    """The published forces, which know no friction, hold with a little of it; more friction, more force; plates take what the ring slides."""
    force = []
    for friction in (0, 0.1, 0.3):
        result = solve(run, "inputs/ring.yml", *QUIET, *PLANE_STRAIN, "-contact_ring_on_plate_friction", friction)
        balanced(result)
        force.append(ring_force(result))
        print(friction, force[-1] / RING - 1, result.summary["newton_iterations"])
        assert result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 8
    assert (numpy.abs(force[1] / RING - 1) < RING_TOLERANCE).all() and (force[0] < force[1]).all() and (force[1] < force[2]).all()
    assert column(result, "contact.ring_on_plate.dissipation").min() >= 0 < column(result, "contact.ring_on_plate.dissipation").sum()


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="a slice with free faces (plane stress, as the source says) is 16 to 24 % softer than the published forces, which are those of plane strain")
def test_o62_plane_stress(run):
    assert (numpy.abs(ring_force(solve(run, "inputs/ring.yml", *QUIET)) / RING - 1) < RING_TOLERANCE).all()


# O-63, crossing tubes
TUBES_FINE = ("-order", 2, "-mesh_parameter_m", 1)
TUBES_COARSE = ("-mesh_parameter_n", 4, "-mesh_parameter_k", 8, "-contact_tubes_multiplier", "standard")
TUBES_ROLES = ("-contact_tubes_nonmortar", "lower_skin", "-contact_tubes_mortar", "upper_skin", "-contact_tubes_roles", "given")
WALL = 0.2


@pytest.mark.parametrize("options", [TUBES_ROLES, TUBES_COARSE, *(pytest.param(words, marks=pytest.mark.slow) for words in ((), TUBES_FINE))],
                         ids=["swapped", "coarse", "linear", "quadratic"])
def test_o63_crossing_tubes(run, options):
    """To the end without a cut; no penetration; forces balance and rise; the work of the ends is the energy stored."""
    result = solve(run, "inputs/tubes.yml", *QUIET, *options)
    balanced(result)
    assert result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 8
    assert column(result, "min_gap").min() > -1e-3 * WALL
    t, force = numpy.append(0, column(result, "t")), numpy.append(0, -column(result, "reaction.upper_end.y"))
    assert (numpy.diff(force) > 0).all()
    work = numpy.sum((force[1:] + force[:-1]) / 2 * numpy.diff(t))
    assert abs(work / result.history[-1]["energy"] - 1) < 1e-3
    assert 1.6 + result.history[-1]["probe.bore_top.displacement.y"] - result.history[-1]["probe.bore_bottom.displacement.y"] > 0.5  # the bore is open


def test_o63_at_once(run):
    """All of it in one step, to the same end."""
    once = solve(run, "inputs/tubes.yml", *QUIET, "-load_step", 1, *TUBES_ROLES)
    slowly = solve(run, "inputs/tubes.yml", *QUIET, "-load_step", 0.25, *TUBES_ROLES)
    assert once.summary["load_steps"] == 1 and once.summary["newton_iterations"] <= 10
    assert abs(once.history[-1]["contact_force"] / slowly.history[-1]["contact_force"] - 1) < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("roles", [(), TUBES_ROLES], ids=["upper", "lower"])
def test_o63_friction(run, roles):
    """Friction of 0.3: the same properties, and the work of the ends is stored or dissipated."""
    result = solve(run, "inputs/tubes.yml", *QUIET, "-contact_tubes_friction", 0.3, *roles)
    balanced(result)
    assert result.summary["step_cuts"] == 0 and column(result, "newton_iterations").max() <= 8 and column(result, "min_gap").min() > -1e-3 * WALL
    t, force, taken = numpy.append(0, column(result, "t")), numpy.append(0, -column(result, "reaction.upper_end.y")), column(result, "contact.tubes.dissipation")
    work = numpy.sum((force[1:] + force[:-1]) / 2 * numpy.diff(t))
    print(work, result.history[-1]["energy"], taken.sum())
    assert (numpy.diff(force) > 0).all() and taken.min() >= 0 < taken.sum()
    assert abs(work - result.history[-1]["energy"] - taken.sum()) < 1e-3 * work
