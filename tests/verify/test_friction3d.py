"""Coulomb friction in space: patch tests that stick and slip, a block on an incline, sliding in one step, objectivity, balances, the tangent; ranks, restarts,
adaptation."""
import math

import numpy
import pytest

from blockmesh import linspace, same, turn, write
from conftest import ROOT
from contactkit import contact, spread, steps
from test_contact_patch3d import PAIRINGS, check_pairing, cubes, spot, text

STEEL = {"law": "neo_hookean", "volumetric": "quadratic", "E": 1, "nu": 0.3}
RIGID = {"law": "rigid"}
SHEAR, HEIGHT = (0.12, -0.05), 0.85  # of the deformation F = 1 + (SHEAR, HEIGHT - 1) e_z
TURNED = (30, 20, 50)


def piola(E=1, nu=0.3):
    """First Piola-Kirchhoff stress of F: mu/2 (J^(-2/3) tr F^T F - 3) + kappa/2 (J - 1)^2."""
    F = numpy.eye(3)
    F[:, 2] = (*SHEAR, HEIGHT)
    mu, kappa, J = E / 2 / (1 + nu), E / 3 / (1 - 2 * nu), numpy.linalg.det(F)
    G = numpy.linalg.inv(F).T
    return mu * J ** (-2 / 3) * (F - numpy.sum(F * F) / 3 * G) + kappa * (J - 1) * J * G


TANGENTIAL, NORMAL = math.hypot(*piola()[:2, 2]), -piola()[2, 2]  # the surfaces keep their areas


def vector(angles, v, factor=""):
    return {axis: (f"{value!r}*{factor}" if factor else float(value)) for axis, value in zip("xyz", turn(angles)(*v))}


def sides(names, angles, factor=""):
    """Dead tractions of the state on upright sides."""
    return {f"{axis}{high}_{name}": {"traction": vector(angles, (2 * high - 1) * piola()[:, "xyz".index(axis)], factor)} for name in names for axis in "xy" for high in (0, 1)}


def column(result, name):
    return numpy.array([row[name] for row in result.history])


def tractions(result):
    state = contact(result)
    return state["contact_pressure"], state["tangential_traction"]


@pytest.mark.parametrize("pairing, nonmortar, order, angles", [
    ("two_to_three", "upper", 1, (0, 0, 0)), ("two_to_three", "lower", 2, TURNED), ("hanging_lower", "lower", 1, TURNED), ("hanging_upper", "lower", 1, (0, 0, 0)),
    pytest.param("hanging_lower", "upper", 2, TURNED, marks=pytest.mark.slow), pytest.param("hanging_upper", "upper", 2, TURNED, marks=pytest.mark.slow),
    pytest.param("two_to_three", "upper", 3, TURNED, marks=pytest.mark.slow)])
def test_patch_that_sticks(run, tmp_path, pairing, nonmortar, order, angles):
    nl, nu, side = PAIRINGS[pairing]
    mesh = cubes(tmp_path / "patch.msh", nl, nu, to=turn(angles))
    move = vector(angles, (2 * SHEAR[0], 2 * SHEAR[1], 2 * (HEIGHT - 1)))
    boundary = {"z0_lower": {"fix": "xyz"}, "z1_upper": {"displacement": move}, **sides(["lower", "upper"], angles)}
    scene = text(mesh, nonmortar, {"lower": STEEL, "upper": STEEL}, boundary, spot(side, turn(angles)(0.3, 0.3, 1)), {"friction": 2 * TANGENTIAL / NORMAL}, order=order)
    result = run("patch.yml", "-solve_rtol", 1e-13, "-snes_monitor", text=scene)
    assert result.returncode == 0, result
    check_pairing(result, pairing, nonmortar)
    pressure, traction = tractions(result)
    expected = numpy.array(turn(angles)(*piola()[:2, 2], 0)) * (1 if nonmortar == "lower" else -1)  # on the nonmortar body
    error = spread(pressure, NORMAL), numpy.abs(traction - expected).max() / TANGENTIAL
    print(error, steps(result))
    assert result.summary["step_cuts"] == 0 and max(error) < 1e-10
    assert result.summary["contact"]["pair"]["slipping_nodes"] == 0


@pytest.mark.parametrize("order, angles", [(1, (0, 0, 0)), (2, TURNED)])
def test_patch_that_slips(run, tmp_path, order, angles):
    """The same state on a rigid floor, along which it is drawn over several facets in one step."""
    to, way = turn(angles), numpy.array(SHEAR) / math.hypot(*SHEAR)
    mesh = write(tmp_path / "patch.msh", {"lower": ([linspace(-1, 3, 17), linspace(-1.5, 2.5, 17), [0, 1]], to), "upper": ([linspace(0, 1, 2)] * 2 + [[1, 2]], to)})
    press, slide = to(*SHEAR, HEIGHT - 1), to(*(0.617 * way), 0)
    move = {axis: f"{press[i]!r}*min(t,1)+{slide[i]!r}*max(0,t-1)" for i, axis in enumerate("xyz")}
    scene = text(mesh, "upper", {"lower": RIGID, "upper": STEEL}, {"z1_upper": {"displacement": move}, **sides(["upper"], angles, "min(t,1)")}, None,
                 {"friction": TANGENTIAL / NORMAL}, order=order).replace("load: {step: 1}", "load: {end: 2, step: 1}")
    result = run("patch.yml", "-solve_rtol", 1e-13, "-newton_slide_predictor", "off", "-snes_monitor", text=scene)
    assert result.returncode == 0, result
    pressure, traction = tractions(result)
    error = spread(pressure, NORMAL), numpy.abs(traction + numpy.array(to(*piola()[:2, 2], 0))).max() / TANGENTIAL
    pair = result.summary["contact"]["pair"]
    print(error, pair, result.summary["newton_iterations"])
    assert max(error) < 1e-10 and abs(pair["max_slip"] - 0.617) < 1e-10
    assert abs(column(result, "contact.pair.dissipation")[-1] - 0.617 * TANGENTIAL) < 1e-10
    assert result.summary["step_cuts"] == 0 and result.summary["newton_iterations"] <= 16


def incline(run, tmp_path, mu, share):
    """A block of weight W on a rigid plane, its weight turned to `share` of the angle of friction, askew to its sides."""
    weight, angle, way = 0.02, math.atan(mu) * share, math.radians(25)
    mesh = write(tmp_path / "incline.msh", {"lower": ([linspace(-1, 2, 7)] * 2 + [[0, 1]], same), "upper": ([linspace(0, 1, 2)] * 2 + [[1, 1.25]], same)})
    turned = f"{angle!r}*min(1,max(0,t-1))"
    force = {axis: f"{weight * f!r}*min(t,1)*{function}({turned})" for axis, f, function in (("x", math.cos(way), "sin"), ("y", math.sin(way), "sin"), ("z", -1, "cos"))}
    scene = text(mesh, "upper", {"lower": RIGID, "upper": STEEL}, {}, None, {"friction": mu, "initial_gap": "adjust"}, order=1)
    values = ", ".join(f'{axis}: "{value}"' for axis, value in force.items())
    scene = scene.replace("boundary: {}\n", "").replace("upper: {material: upper}", "upper: {material: upper, force: {" + values + "}}")
    return run("incline.yml", text=scene.replace("load: {step: 1}", "load: {end: 2, step: 1, step_min: 1}"))


def test_block_on_an_incline(run, tmp_path):
    """It stays up to the angle of friction, to 1e-6, and not beyond."""
    below, above = incline(run, tmp_path, 0.3, 1 - 1e-6), incline(run, tmp_path, 0.3, 1 + 1e-6)
    assert below.returncode == 0, below
    assert above.returncode == 2, above


BALL = """
mesh: {file: GEO, order: 2, parameter: {n: N, k: K}}
model: 3d
order: ORDER
body: {ball: {material: r}, block: {material: r}}
material: {r: {law: neo_hookean, volumetric: quadratic, E: 1, nu: 0.3}}
boundary:
  top: {displacement: {x: "0.5*max(t - 1, 0)", y: 0, z: "-0.1*min(t, 1)"}}
  bottom: {fix: xyz}
  ball_y: {fix: y}
  block_y: {fix: y}
contact: {pair: {PAIR, roles: given, friction: MU}}
load: {end: 2, step: 1}
"""
PAIRS = {"ball": "nonmortar: ball_surface, mortar: block_top", "block": "nonmortar: block_top, mortar: ball_surface"}


def ball(pair, order, mu, n=2):
    scene = BALL.replace("GEO", str(ROOT / "inputs" / "hertz3d.geo")).replace("ORDER", str(order)).replace("PAIR", PAIRS[pair]).replace("MU", str(mu))
    return scene.replace("N,", f"{n},").replace("K}", f"{2 * n}" + "}")


def check_law(result, mu):
    summary = result.summary
    assert summary["step_cuts"] == 0
    assert summary["balance"]["contact_force"] < 1e-9 and summary["balance"]["supports"] < 1e-9
    pressure, traction = tractions(result)
    assert numpy.all(numpy.linalg.norm(traction, axis=1) <= mu * pressure * (1 + 1e-9) + 1e-12)
    assert column(result, "contact.pair.dissipation").min() >= -1e-15


SLOW = [("ball", 2), ("block", 2)]


@pytest.mark.parametrize("mu", [0.1, 0.3, 0.6, 1.0])
@pytest.mark.parametrize("pair, order", [(*case, ) if case not in SLOW else pytest.param(*case, marks=pytest.mark.slow) for case in [("ball", 1), ("block", 1), *SLOW]])
def test_pressed_and_slid(run, pair, order, mu):
    """Pressed 0.1, then slid half a radius in one step. What slips obeys the law, forces balance, friction takes energy."""
    result = run("ball.yml", text=ball(pair, order, mu))
    assert result.returncode == 0, result
    print(pair, order, mu, column(result, "newton_iterations"), result.summary["contact"]["pair"]["force"], result.summary["balance"])
    check_law(result, mu)
    assert column(result, "newton_iterations").max() <= 8


@pytest.mark.parametrize("pair", list(PAIRS))
def test_moments_balance(run, pair):
    """Without planes of symmetry, where only half of the moments is there."""
    result = run("ball.yml", text=ball(pair, 1, 0.3).replace("  ball_y: {fix: y}\n  block_y: {fix: y}\n", ""))
    assert result.returncode == 0, result
    check_law(result, 0.3)
    assert result.summary["balance"]["contact_moment"] < 1e-9


def test_tangent(run, tmp_path):
    """A block on a larger one, pressed and sheared until nodes slip."""
    move = {"x": "0.2*t", "y": "0.05*t", "z": "-0.05*t"}
    mesh = write(tmp_path / "blocks.msh", {"lower": ([linspace(-0.5, 1.5, 3)] * 2 + [[0, 1]], same), "upper": ([linspace(0, 1, 2)] * 2 + [[1, 2]], same)})
    scene = text(mesh, "upper", {"lower": STEEL, "upper": STEEL}, {"z0_lower": {"fix": "xyz"}, "z1_upper": {"displacement": move}}, None, {"friction": 0.3}, order=1)
    result = run("blocks.yml", "-snes_test_jacobian", text=scene)
    assert result.summary["contact"]["pair"]["slipping_nodes"] > 0
    error = [float(line.split("=")[1].split(",")[0]) for line in result.stdout.splitlines() if "||J - Jfd||_F/||J||_F =" in line]
    print(error, steps(result))
    assert result.returncode == 0 and error[-1] < 1e-6


def test_without_friction_nothing_changes(run):
    scene = ball("ball", 1, 0)
    plain = run("plain.yml", "-snes_monitor", text=scene.replace(", friction: 0", ""))
    zero = run("zero.yml", "-snes_monitor", text=scene)
    assert steps(plain) == steps(zero) and plain.summary["energy"] == zero.summary["energy"]


@pytest.mark.parametrize("turns", [8, 4])
def test_objectivity(run, tmp_path, turns):
    """Pressed and sheared, then both bodies turned by 360 degrees about an axis along the surface in 8 and in 4 steps: nothing slips, forces turn along, no step is cut."""
    mesh = cubes(tmp_path / "turn.msh", 2, 3)
    rotation = {"rotation": {"angle": f"{360 / turns}*max(0,t-1)", "axis": "y", "point": {"x": 0.5, "y": 0.5, "z": 1}}}
    scene = text(mesh, "upper", {"lower": STEEL, "upper": STEEL}, {"z0_lower": rotation, "z1_upper": rotation}, None, {"friction": 0.5, "interference": 0.05})
    result = run("turn.yml", text=scene.replace("load: {step: 1}", f"load: {{end: {turns + 1}, step: 1}}"))
    assert result.returncode == 0 and result.summary["step_cuts"] == 0, result
    force = numpy.linalg.norm([column(result, f"contact.pair.force.{axis}") for axis in "xyz"], axis=0)
    print(force, column(result, "contact.pair.max_slip"), column(result, "newton_iterations"))
    assert spread(force, force[0]) < 1e-10 and force[0] > 1e-3
    assert numpy.abs(column(result, "contact.pair.max_slip")[1:]).max() < 1e-10


NAMES = ("contact.pair.force.x", "contact.pair.force.z", "contact.pair.dissipation", "contact.pair.max_slip")


@pytest.mark.parametrize("ranks", [3, pytest.param(2, marks=pytest.mark.slow), pytest.param(4, marks=pytest.mark.slow)])
def test_ranks(run, ranks):
    """The same on several processes."""
    alone = run("ball.yml", "-solve_rtol", 1e-13, text=ball("ball", 1, 0.3))
    result = run("ball.yml", "-solve_rtol", 1e-13, text=ball("ball", 1, 0.3), ranks=ranks)
    assert result.returncode == 0, result
    for name in NAMES:
        assert column(result, name) == pytest.approx(column(alone, name), rel=1e-8, abs=1e-11), name


def test_adapted(run):
    """Refined where a step ends: refinement is no slip."""
    result = run("adapted.yml", "-adapt_tolerance", 0.5, "-adapt_max_passes", 2, text=ball("block", 1, 0.3))
    assert result.returncode == 0, result
    passes = [row for row in result.adapt if row["pass"] > 0]
    print([(row["step"], row["pass"], row["newton_iterations"]) for row in passes])
    assert passes and max(row["newton_iterations"] for row in passes) <= 8
    check_law(result, 0.3)


def test_restart(run):
    """Stopped after the press and gone on from there: the same, to what the linear solver leaves. (A run that goes on begins its first linear solve with
    the factor of the last tangent, one from a checkpoint has none.)"""
    scene = ball("ball", 1, 0.3)
    whole = run("whole.yml", text=scene)
    first = run("whole.yml", "-load_max_steps", 1, "-output_checkpoint", 1, text=scene)
    rest = run("whole.yml", "-restart", first.directory / "checkpoint.h5", text=scene)
    assert rest.returncode == 0, rest
    assert rest.summary["energy"] == pytest.approx(whole.summary["energy"], rel=1e-11)
    pairs = [result.summary["contact"]["pair"] for result in (rest, whole)]
    for name in ("force", "max_pressure", "dissipation", "max_slip", "area"):
        assert pairs[0][name] == pytest.approx(pairs[1][name], rel=1e-10, abs=1e-14), name
    assert pairs[0]["slipping_nodes"] == pairs[1]["slipping_nodes"]


def test_tractions_on_another_mesh(run, tmp_path):
    """A constant state is carried over as it is, tractions along the axes of the new nodes too: equilibrium on the finer mesh from the start."""
    mesh = cubes(tmp_path / "patch.msh", *PAIRINGS["two_to_three"][:2], to=turn(TURNED))
    move = vector(TURNED, (2 * SHEAR[0], 2 * SHEAR[1], 2 * (HEIGHT - 1)))
    boundary = {"z0_lower": {"fix": "xyz"}, "z1_upper": {"displacement": move}, **sides(["lower", "upper"], TURNED)}
    scene = text(mesh, "lower", {"lower": STEEL, "upper": STEEL}, boundary, None, {"friction": 2 * TANGENTIAL / NORMAL}, order=1)
    result = run("patch.yml", "-solve_rtol", 1e-11, "-adapt_tolerance", 1e-300, "-adapt_max_passes", 1, text=scene)
    print([(row["pass"], row["cells"], row["newton_iterations"]) for row in result.adapt])
    first, last = result.adapt
    assert last["cells"] > first["cells"] and last["newton_iterations"] == 0
    pressure, traction = tractions(result)
    expected = numpy.array(turn(TURNED)(*piola()[:2, 2], 0))
    assert max(spread(pressure, NORMAL), numpy.abs(traction - expected).max() / TANGENTIAL) < 1e-9


def test_refined_from_a_coarse_ball(run):
    """Few and tilted facets: nodes in the plane of symmetry have no traction across it, on any mesh."""
    result = run("coarse.yml", "-adapt_tolerance", 0.45, "-load_max_steps", 1, text=ball("ball", 1, 0.3))
    passes = [row["newton_iterations"] for row in result.adapt]
    print(passes)
    assert len(passes) > 2 and max(passes) <= 6
    state = contact(result)
    middle = numpy.abs(state["X"][:, 1]) < 1e-12
    assert middle[:len(state["tangential_traction"])].any() and numpy.abs(state["tangential_traction"][middle, 1]).max() < 1e-12


GUIDE = """
mesh: {file: GEO, order: 1, parameter: {l0: -1, l1: 2, k0: 0, k1: 1, nl: 7, kl: 3, ml: 2, u0: 0, u1: 0.7, v0: 0.2, v1: 0.8, nu: 3, ku: 3, mu: 2}}
model: 3d
order: ORDER
body: {lower: {material: m}, upper: {material: m}}
material: {m: {law: neo_hookean, E: 100, nu: 0.3}}
boundary:
  bottom: {displacement: {x: "0.3*max(t-1,0)", y: "0.1*max(t-1,0)", z: 0}}
  upper_x: {fix: x}
  upper_y: {fix: y}
  top: {traction: {z: -1}, amplitude: [0,0, 1,1, 2,1]}
contact: {c: {SIDES, friction: 0.3}}
load: {end: 2, step: 0.5}
"""


@pytest.mark.parametrize("pair", ["nonmortar: under, mortar: face", "nonmortar: face, mortar: under"])
@pytest.mark.parametrize("order", [1, 2])
def test_guided_block(run, tmp_path, order, pair):
    """A plate drawn away under a loaded block in a guide: friction is that of the load, along the way. Nodes that the guide holds, half of them here, had no traction along the axis that is held."""
    geo = (ROOT / "tests" / "gauntlet" / "blocks3d.geo").read_text()
    (tmp_path / "guide.geo").write_text(geo + '\nPhysical Surface("upper_x") = {c[3], c[5]}; Physical Surface("upper_y") = {c[2], c[4]};\n')
    result = run("guide.yml", text=GUIDE.replace("GEO", str(tmp_path / "guide.geo")).replace("ORDER", str(order)).replace("SIDES", pair))
    assert result.returncode == 0, result
    force = numpy.abs(result.summary["contact"]["c"]["force"])
    print(order, pair, force, result.summary["newton_iterations"], result.summary["step_cuts"])
    friction = 0.3 * 0.42 / math.hypot(0.3, 0.1)
    assert force == pytest.approx([0.3 * friction, 0.1 * friction, 0.42], rel=0.02)
