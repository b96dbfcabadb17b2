"""Contact patch tests in space: O-40, O-41a, O-42, O-43, O-44, O-46, on matching, non-matching, hanging and distorted faces, with either side nonmortar."""
import itertools
import re

import numpy
import pytest

from blockmesh import distorted, linspace, same, turn, write
from combinations import half
from contactkit import bulk, contact, is_quadratic, spread, steps, yaml

PRESSURE = 48.2977961996  # of O-41a
SIDES = {"upper": ("z0_upper", "z1_lower"), "lower": ("z1_lower", "z0_upper")}  # by the side that carries the multiplier
PAIRINGS = {  # cells along the sides of the lower and of the upper face, and which side has one face refined once and its child again
    "matching": (2, 2, None),
    "two_to_three": (2, 3, None),
    "hanging_lower": (2, 3, "z1_lower"),
    "hanging_upper": (2, 3, "z0_upper"),
}
AROUND = [f"{side}_{block}" for block in SIDES for side in ("x0", "x1", "y0", "y1")]
ROLLERS = {**{name: {"fix": name[0]} for name in AROUND}, "z0_lower": {"fix": "z"}}
NORMAL = {name: {"fix": "normal"} for name in ROLLERS}
ANGLES = (30, 20, 50)


def linear(E, nu):
    return {"law": "linear", "E": E, "nu": nu}


def hyperelastic(E):
    return {"law": "neo_hookean", "volumetric": "log", "E": E, "nu": 0.3}


SOFT_HARD = {"lower": hyperelastic(100), "upper": hyperelastic(1000)}


def cubes(path, nl, nu, to=same, distortion=0.0, seed=1, m=1):
    """Unit cubes on each other; the columns of cells of both are distorted."""
    lower, upper = ([linspace(0, 1, n), linspace(0, 1, n), linspace(z, z + 1, m)] for z, n in enumerate((nl, nu)))
    return write(path, {"lower": (lower, distorted(lower, distortion, seed, to)), "upper": (upper, distorted(upper, distortion, seed + 1000, to))})


ORIGIN = {"origin": {"x": 0, "y": 0, "z": 0}}  # of moments


def text(mesh, nonmortar, material, boundary, near=None, pair=None, **keys):
    scene = {"mesh": {"file": str(mesh)}, "model": "3d", "body": {name: {"material": name} for name in SIDES}, "material": material, "boundary": boundary,
             "contact": {"pair": {"nonmortar": SIDES[nonmortar][0], "mortar": SIDES[nonmortar][1], "roles": "given", **(pair or {})}}, "load": {"step": 1}, **keys}
    if near:
        scene["refine"] = {"spot": near}
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


def spot(boundary, place=(0.3, 0.3, 1), levels=2):
    return {"boundary": boundary, **dict(zip("xyz", place)), "levels": levels} if boundary else None


def combinations(quick):
    """Pairings x sides x orders: those named are quick."""
    for case in itertools.product(PAIRINGS, SIDES, (1, 2)):
        yield pytest.param(*case, marks=() if case in quick else pytest.mark.slow)


def done(result):
    assert result.returncode == 0, result
    return result


def check_hanging(result, hangs):
    """Where one face was refined twice, areas of faces are 1 : 4 : 16."""
    x, cells = contact(result, hangs)["X"], contact(result, hangs)["cells"]
    q = x[cells]
    area = numpy.linalg.norm(numpy.cross(q[:, 2] - q[:, 0], q[:, 3] - q[:, 1]), axis=1) / 2
    assert abs(area.max() / area.min() - 16) < 1e-6, area


def check_pairing(result, pairing, nonmortar):
    side = PAIRINGS[pairing][2]
    if side:
        check_hanging(result, SIDES[nonmortar].index(side))


# ---- uniform states ---------------------------------------------------------------------------------------------------------------------

QUICK_40 = [("matching", "upper", 2), ("two_to_three", "lower", 1), ("hanging_lower", "upper", 1), ("hanging_lower", "lower", 2), ("hanging_upper", "upper", 1)]


def small_strain(run, tmp_path, pairing, nonmortar, order, ranks=1, distortion=0.0, seed=1, **keys):
    nl, nu, side = PAIRINGS[pairing]
    steel = linear(2e6, 0)
    mesh = cubes(tmp_path / "o40.msh", nl, nu, distortion=distortion, seed=seed)
    result = done(run("o40.yml", ranks=ranks, text=text(mesh, nonmortar, {"lower": steel, "upper": steel}, {**ROLLERS, "z1_upper": {"displacement": {"z": -0.1}}},
                                                        spot(side), kinematics="small", order=order, **keys)))
    stress = bulk(result)["stress"]
    return result, [spread(contact(result)["contact_pressure"], 1e5), spread(contact(result)["displacement"][:, 2], -0.05), spread(stress[:, 5], -1e5),
                    numpy.abs(stress[:, :5]).max() / 1e5]


@pytest.mark.parametrize("pairing, nonmortar, order", combinations(QUICK_40))
def test_o40_small_strain(run, tmp_path, pairing, nonmortar, order):
    result, error = small_strain(run, tmp_path, pairing, nonmortar, order)
    print(error)
    assert max(error) < 1e-10
    check_pairing(result, pairing, nonmortar)


def finite_strain(run, tmp_path, pairing, nonmortar, order, *options, ranks=1, angles=(0, 0, 0), distortion=0.0, **keys):
    nl, nu, side = PAIRINGS[pairing]
    to = turn(angles)
    boundary = {**(NORMAL if any(angles) else ROLLERS), "z1_upper": {"displacement": dict(zip("xyz", to(0, 0, -0.3)))}}
    mesh = cubes(tmp_path / "o41.msh", nl, nu, to, distortion)
    result = done(run("o41.yml", *options, ranks=ranks, text=text(mesh, nonmortar, SOFT_HARD, boundary, spot(side, to(0.3, 0.3, 1)), order=order, **keys)))
    u = contact(result)["displacement"] @ numpy.array(to(0, 0, 1))
    return result, [spread(contact(result)["contact_pressure"], PRESSURE), spread(u, 0.7347128571 - 1)]


QUICK_41 = [("matching", "lower", 1), ("two_to_three", "upper", 2), ("hanging_lower", "lower", 1), ("hanging_upper", "lower", 1), ("hanging_upper", "upper", 2)]


@pytest.mark.parametrize("pairing, nonmortar, order", combinations(QUICK_41))
def test_o41a_finite_strain(run, tmp_path, pairing, nonmortar, order):
    result, error = finite_strain(run, tmp_path, pairing, nonmortar, order, "-snes_monitor")
    print(error)
    assert max(error) < 1e-8
    assert result.summary["load_steps"] == 1 and result.summary["step_cuts"] == 0
    assert is_quadratic(steps(result)[0]), steps(result)
    check_pairing(result, pairing, nonmortar)


QUICK_42 = [("two_to_three", "upper", 1), ("two_to_three", "lower", 2), ("hanging_lower", "upper", 1), ("hanging_upper", "upper", 1)]


@pytest.mark.parametrize("pairing, nonmortar, order", combinations(QUICK_42))
def test_o42_rotated(run, tmp_path, pairing, nonmortar, order):
    _, error = finite_strain(run, tmp_path, pairing, nonmortar, order, angles=ANGLES)
    print(error)
    assert max(error) < 1e-8


@pytest.mark.parametrize("nonmortar", SIDES)
def test_order_4(run, tmp_path, nonmortar):
    _, error = finite_strain(run, tmp_path, "two_to_three", nonmortar, 4, angles=ANGLES)
    assert max(error) < 1e-8


# ---- ranks, distorted faces -------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("ranks", [pytest.param(2, marks=pytest.mark.slow), pytest.param(3, marks=pytest.mark.slow), 4])
@pytest.mark.parametrize("pairing, nonmortar", [("hanging_lower", "lower"), pytest.param("hanging_upper", "lower", marks=pytest.mark.slow)])
def test_ranks(run, tmp_path, pairing, nonmortar, ranks):
    _, error = small_strain(run, tmp_path, pairing, nonmortar, 2, ranks, 0.1)
    assert max(error) < 1e-10
    result, error = finite_strain(run, tmp_path, pairing, nonmortar, 1, ranks=ranks, angles=ANGLES)
    assert max(error) < 1e-8
    assert result.summary["newton_iterations"] == finite_strain(run, tmp_path, pairing, nonmortar, 1, angles=ANGLES)[0].summary["newton_iterations"]


DISTORTION = [(0.1, 1e-11), (0.2, 1e-8), (0.3, 1e-6)]  # share of a cell by which columns move, error of the rule on triangles


@half("nonmortar, pairing, distorted, multiplier", list(SIDES), ["two_to_three", "hanging_upper"], list(DISTORTION), ["dual", "standard"], slow=["hanging_upper"])
def test_distorted_faces(run, tmp_path, nonmortar, pairing, distorted, multiplier):
    """Faces that are no parallelograms, on a plane: the only error is that of integrating rational functions."""
    distortion, tolerance = distorted
    for seed in (1, 2):
        result, error = small_strain(run, tmp_path, pairing, nonmortar, 1, distortion=distortion, seed=seed,
                                     **({"pair": {"multiplier": multiplier}} if multiplier == "standard" else {}))
        print(seed, error)
        assert max(error) < tolerance
        q = contact(result)["X"][contact(result)["cells"]]
        assert numpy.abs(q[:, 0] - q[:, 1] + q[:, 2] - q[:, 3]).max() > 0.1 * distortion  # they are not


@pytest.mark.parametrize("nonmortar", SIDES)
def test_o42_distorted(run, tmp_path, nonmortar):
    _, error = finite_strain(run, tmp_path, "two_to_three", nonmortar, 2, angles=ANGLES, distortion=0.15)
    print(error)
    assert max(error) < 1e-8


# ---- O-43: the punch over a foundation --------------------------------------------------------------------------------------------------

TAYLOR = {"z0_lower": {"fix": "z"}, "x0_lower": {"fix": "x"}, "x0_upper": {"fix": "x"}, "y0_lower": {"fix": "y"}, "y0_upper": {"fix": "y"},
          "z1_upper": {"pressure": 1}}
BODY = {"lower": linear(1000, 0.3), "upper": linear(1000, 0.3)}
EXACT = [0, 0, 0, 0, 0, -1]


def covered(x, margin=0.0):
    return ((x[:, :2] > 1 - margin - 1e-9) & (x[:, :2] < 2 + margin + 1e-9)).all(axis=1)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("nonmortar", SIDES)
@pytest.mark.parametrize("nu", [2, pytest.param(3, marks=pytest.mark.slow), pytest.param(5, marks=pytest.mark.slow)])
def test_o43_taylor(run, tmp_path, nonmortar, nu, order):
    """The lower mesh ends cells where the punch does; the faces inside the outline do not match for nu = 3, 5."""
    lower, upper = [linspace(0, 3, 6), linspace(0, 3, 6), [0, 1]], [linspace(1, 2, nu), linspace(1, 2, nu), [1, 2]]

    def outer(block, side, centre):
        return ("uncovered",) if (block, side) == ("lower", "z1") and not all(1 < c < 2 for c in centre[:2]) else ()

    mesh = write(tmp_path / "o43.msh", {"lower": (lower, same), "upper": (upper, distorted(upper, 0.1, 5))}, outer)
    result = done(run("o43.yml", text=text(mesh, nonmortar, BODY, {**TAYLOR, "uncovered": {"pressure": 1}}, kinematics="small", order=order)))
    assert numpy.abs(bulk(result)["stress"] - EXACT).max() < 1e-8
    z, x = contact(result)["contact_pressure"], contact(result)["X"]
    assert numpy.abs(z[covered(x)] - 1).max() < 1e-8 and numpy.abs(z[~covered(x)]).max(initial=0) < 1e-8


def inside(axis, nl, low=1.0, high=2.0, width=3.0):
    """The function that is linear in each of nl cells and has the moments of 1 on [low, high], 0 elsewhere."""
    h, terms = width / nl, []
    for k in range(nl):
        a, b = k * h, (k + 1) * h
        s, t = (max(a, low) - a) / h, (min(b, high) - a) / h
        if t <= s:
            continue
        second = (t * t - s * s) / 2
        f0, f1 = (t - s) - second, second
        q0, q1 = 4 * f0 - 2 * f1, 4 * f1 - 2 * f0
        terms.append(f"({axis} > {a!r} && {axis} < {b!r} ? {q0!r} + {(q1 - q0) / h!r}*({axis} - {a!r}) : 0)")
    return "(" + " + ".join(terms) + ")"


@pytest.mark.parametrize("nl, nu", [(4, 2), (5, 3), pytest.param(7, 2, marks=pytest.mark.slow), pytest.param(8, 5, marks=pytest.mark.slow)])
def test_o43_drop_off(run, tmp_path, nl, nu):
    """Faces of the lower block, which carries the multiplier, reach out from under the punch: the outer load has the exact nodal forces."""
    lower, upper = [linspace(0, 3, nl), linspace(0, 3, nl), [0, 1]], [linspace(1, 2, nu), linspace(1, 2, nu), [1, 2]]
    load = f"-(1 - {inside('X', nl)}*{inside('Y', nl)})"
    mesh = write(tmp_path / "o43.msh", {"lower": (lower, same), "upper": (upper, same)})
    result = done(run("o43.yml", text=text(mesh, "lower", BODY, {**TAYLOR, "z1_lower": {"traction": {"z": load}}}, None, {"moment_about": "origin"}, point=ORIGIN,
                                            kinematics="small")))
    pair = result.summary["contact"]["pair"]
    assert numpy.abs(numpy.array(pair["force"]) - [0, 0, -1]).max() < 1e-9 and numpy.abs(numpy.array(pair["moment"]) - [-1.5, 1.5, 0]).max() < 1e-9, pair
    state, surface, h = bulk(result), contact(result), 3 / nl
    assert numpy.abs(state["stress"] - EXACT).max() < 1e-8  # in the row of cut faces too: their nodal forces are exact
    active = surface["status"] > 0.5
    assert not numpy.any(active & ~covered(surface["X"], h))
    assert surface["contact_pressure"].max() < 1.5 and surface["contact_pressure"].min() > -1e-12


# ---- O-44: linear pressure --------------------------------------------------------------------------------------------------------------

def linear_pressure(run, tmp_path, nonmortar, n, order, multiplier, hangs=None, distortion=0.0, faces="auto"):
    """Blocks 2 x 1 x 1, sigma_zz = -(1 + X / 2): forces given on the top, so the resultants are those of statics."""
    body, half = linear(1000, 0), 3 * n // 2
    lower, upper = [linspace(0, 2, 2 * n), linspace(0, 1, n), [0, 1]], [linspace(0, 2, 2 * half), linspace(0, 1, half), [1, 2]]
    mesh = write(tmp_path / "o44.msh", {"lower": (lower, distorted(lower, distortion, 3)), "upper": (upper, distorted(upper, distortion, 4))})
    boundary = {"z0_lower": {"fix": "xyz"}, "z1_upper": {"displacement": {"x": "0.25*Z^2/1000", "y": 0}, "traction": {"z": "-(1 + 0.5*X)"}}}
    near = spot(hangs, (0.6, 0.3, 1))
    result = done(run("o44.yml", "-solve_rtol", 1e-12, text=text(mesh, nonmortar, {"lower": body, "upper": body}, boundary, near, {"multiplier": multiplier, "order": faces, "moment_about": "origin"},
                                                               point=ORIGIN, kinematics="small", order=order)))
    pair, sign = result.summary["contact"]["pair"], 1 if nonmortar == "upper" else -1
    force, moment = sign * numpy.array(pair["force"]), sign * numpy.array(pair["moment"])
    print(multiplier, n, force - [0, 0, 3], moment)
    assert numpy.abs(force - [0, 0, 3]).max() < 3e-9 and numpy.abs(moment - [1.5, -10 / 3, 0]).max() < 3e-9, pair
    x, z = contact(result)["X"], contact(result)["contact_pressure"]
    return x, z - (1 + 0.5 * x[:, 0])


@pytest.mark.parametrize("nonmortar", SIDES)
@pytest.mark.parametrize("hangs", ["z1_lower", "z0_upper"])
def test_o44_dual_hanging(run, tmp_path, nonmortar, hangs):
    """Resultants (asserted there), and an error no larger than without hanging nodes."""
    x, error = linear_pressure(run, tmp_path, nonmortar, 2, 2, "dual", hangs)
    print(numpy.abs(error).max())
    assert numpy.abs(error).max() < 0.1


@pytest.mark.parametrize("nonmortar", SIDES)
def test_o44_dual(run, tmp_path, nonmortar):
    """Dual multipliers of linear faces: exact resultants, no oscillation, pressure error falling at least as h. Faces of the order of the cells are exact."""
    assert numpy.abs(linear_pressure(run, tmp_path, nonmortar, 2, 2, "dual")[1]).max() < 1e-9
    largest = []
    for n in (2, 4, 6) if nonmortar == "lower" else (2, 4):
        x, error = linear_pressure(run, tmp_path, nonmortar, n, 2, "dual", faces=1)
        z = error + 1 + 0.5 * x[:, 0]
        for y in numpy.unique(numpy.round(x[:, 1], 9)):
            row = numpy.abs(x[:, 1] - y) < 1e-9
            assert numpy.all(numpy.diff(z[row][numpy.argsort(x[row, 0])]) > 0)  # the pressure rises along x, and so does its approximation
        largest.append(numpy.abs(error).max() * n)
    print("largest error * n", largest)
    assert numpy.all(numpy.diff(largest) < 0.1 * largest[0]), largest


@pytest.mark.parametrize("nonmortar", SIDES)
@pytest.mark.parametrize("order, hangs", [(2, None), (2, "z1_lower"), (2, "z0_upper"), pytest.param(4, None, marks=pytest.mark.slow)])
def test_o44_standard(run, tmp_path, nonmortar, order, hangs):
    """Standard multipliers hold the linear pressure: exact."""
    _, error = linear_pressure(run, tmp_path, nonmortar, 2, order, "standard", hangs)
    assert numpy.abs(error).max() < 1e-9


# ---- O-46: faces graded 1 : 64 ----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("order", [1, pytest.param(2, marks=pytest.mark.slow)])
@pytest.mark.parametrize("nonmortar", SIDES)
def test_o46_graded(run, tmp_path, nonmortar, order):
    steel = linear(2e6, 0)
    mesh = cubes(tmp_path / "o46.msh", 2, 2)
    boundary = {**ROLLERS, "z1_upper": {"displacement": {"z": -0.1}}}
    result = done(run("o46.yml", text=text(mesh, nonmortar, {"lower": steel, "upper": steel}, boundary, spot("z0_upper", levels=6), kinematics="small", order=order)))
    stress, upper = bulk(result)["stress"], contact(result, SIDES[nonmortar].index("z0_upper"))
    q = upper["X"][upper["cells"]]
    edges = numpy.linalg.norm(q[:, 1] - q[:, 0], axis=1)
    error = [spread(stress[:, 5], -1e5), spread(contact(result)["contact_pressure"], 1e5)]
    print(error, result.summary["cells"])
    assert abs(edges.max() / edges.min() - 64) < 1e-6
    assert max(error) < 1e-8


# ---- O-94: the tangent of the whole program -----------------------------------------------------------------------------------------------

@pytest.mark.parametrize("seed, nonmortar, multiplier", [(1, "upper", "dual"), (2, "lower", "dual"), (3, "upper", "standard")])
def test_o94_tangent(run, tmp_path, seed, nonmortar, multiplier):
    """A smaller block, turned, tilted and off the middle, on distorted meshes: every iterate against differences of the residual."""
    lower, upper = [linspace(0, 1, 2), linspace(0, 1, 2), [0, 1]], [linspace(-0.37, 0.43, 2), linspace(-0.4, 0.4, 3), [0, 0.7]]
    tilt = turn((3 + seed, 2 - seed, 20 + 10 * seed))

    def place(*x):
        x = tilt(*x)
        return x[0] + 0.55, x[1] + 0.71, x[2] + 1.03

    mesh = write(tmp_path / "o94.msh", {"lower": (lower, distorted(lower, 0.2, seed)), "upper": (upper, distorted(upper, 0.2, seed + 50, place))})
    boundary = {"z0_lower": {"fix": "xyz"}, "z1_upper": {"displacement": {"x": 0.013, "y": -0.017, "z": -0.12}}}
    result = done(run("o94.yml", "-snes_test_jacobian", "-solve_symmetric", 0, text=text(mesh, nonmortar, SOFT_HARD, boundary, pair={"multiplier": multiplier})))
    ratios = [float(r) for r in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([\d.e+-]+)", result.stdout)]
    pair = result.summary["contact"]["pair"]
    print(ratios, pair["area"], pair["active_nodes"])
    assert len(ratios) >= 3 and max(ratios) < 1e-6
    assert 0.05 < pair["area"] < 0.7
    assert pair["equivalent_radius"] == pytest.approx(numpy.sqrt(pair["area"] / numpy.pi), rel=1e-9)


def test_rim_held_across_the_face(run):
    """A fine nonmortar face on a single mortar face, its rim held across: with multipliers on the rim the system is singular (a force of 1e32 was found)."""
    sides = [word for side in ("x0", "x1", "y0", "y1") for word in (f"-boundary_{side}_fix", "z")]
    result = run("inputs/blocks3d.yml", "-mesh_parameter_n1", 1, "-mesh_parameter_n2", 6, *sides, "-boundary_bottom_fix", "xyz", "-boundary_top_displacement_x", 0,
                 "-boundary_top_displacement_y", 0, "-boundary_top_displacement_z", "-1.6*X*(1-X)*Y*(1-Y)")
    assert result.returncode == 0, result
    assert result.summary["newton_iterations"] <= 5 and result.summary["step_cuts"] == 0
    assert 1e-3 < result.summary["contact"]["upper_on_lower"]["force"][2] < 3e-3


@pytest.mark.parametrize("d", [0, 0.018])
def test_border_of_two_pairs(run, d):
    """Two bricks under one, all under the same pressure, the joint below at a point (at 0.018 beside it, in the slit) where the upper one's stress is looked at: what
    presses there is counted once. It was twice, and 12 % were told of an exact solution."""
    result = run("tests/verify/scenes/bricks.yml", "-mesh_parameter_d", d, "-output_fields", "false")
    assert result.solved and result.summary["energy"] == pytest.approx(0.192, rel=1e-10) and result.summary["estimated_error"] < 1e-6, result
