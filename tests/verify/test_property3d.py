"""Properties that every run with contact in three dimensions must keep (O-90 to O-101, O-103, O-104), and what must not break one. The scenes are small: boxes
on each other whose faces match nowhere, and the two scenes of inputs/. Most run with both linear solvers."""
import math
import re

import numpy as np
import pytest

from boxes import RUBBER, Box, boxes, scene
from combinations import half
from contactkit import contact, is_quadratic, steps

slow = pytest.mark.slow
QUIET = ("-output_fields", 0)
ITERATIVE = ("-solve_linear", "iterative")
SOLVERS = pytest.mark.parametrize("linear", ["direct", pytest.param("iterative", marks=slow)])
LOWER, UPPER = Box((0, 0, 0), (1, 1, 1), (3, 3, 2)), Box((0.2, 0.15, 1), (0.6, 0.55, 0.8), (2, 2, 2))
SIDES = {"upper": ("upper_z0", "lower_z1"), "lower": ("lower_z1", "upper_z0")}  # by the side that carries the multipliers
TILTED = ("0.03", "0.02", "-0.1 - 0.05*{x} + 0.03*{y}")  # of the top: shifted, pressed, tilted
BODIES = {"lower": RUBBER, "upper": RUBBER}


def pairs(carries="upper", **keys):
    return {"pair": {"nonmortar": SIDES[carries][0], "mortar": SIDES[carries][1], **keys}}


class Frame:
    """x -> length R x + shift, and the expressions of the scene that go with it."""

    def __init__(self, seed=None, length=1, shift=0):
        q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0] if seed is not None else np.eye(3)
        self.R, self.length, self.shift = q * np.sign(np.linalg.det(q)), length, shift

    def __call__(self, x):
        return self.length * self.R @ x + self.shift

    def displacement(self, u):
        """Expressions u(x) of the first frame, as {x, y, z} of this one."""
        place = {}
        for name, row in zip("xyz", self.R.T):
            terms = " + ".join(f"({c!r})*({X} - ({self.shift!r}))" for c, X in zip(map(float, row), "XYZ"))
            place[name] = f"(({terms})/{self.length!r})"
        parts = [f"({part.format(**place)})" for part in u]
        return {axis: " + ".join(f"({float(self.length * c)!r})*{part}" for c, part in zip(row, parts)) for axis, row in zip("xyz", self.R)}


def hold(u=TILTED, frame=Frame()):
    return {"lower_z0": {"fix": "xyz"}, "upper_z1": {"displacement": frame.displacement(u)}}


def punch(path, lower=LOWER, upper=UPPER, gap=0.0, to=lambda x: x):
    boxes(path, {"lower": lower, "upper": upper._replace(origin=(*upper.origin[:2], upper.origin[2] + gap))}, to)
    return path


def solver(run, tmp_path):
    """solve(*options, gap=, lower=, upper=, bodies=, boundary=, contact=, ranks=, **keys of the scene): the two boxes."""

    def start(*options, lower=LOWER, upper=UPPER, gap=0.0, frame=Frame(), bodies=BODIES, boundary=None, contact=None, ranks=1, **keys):
        punch(tmp_path / "boxes.msh", lower, upper, gap, frame)
        text = scene("boxes.msh", bodies, boundary or hold(frame=frame), contact or pairs(), **keys)
        return run("boxes.yml", *options, text=text, ranks=ranks)

    return start


@pytest.fixture
def solve(run, tmp_path):
    return solver(run, tmp_path)


def good(result):
    assert result.solved, result
    return result.summary


def only(result):
    return good(result)["contact"]["pair"]


def iterations(result):
    return [row["newton_iterations"] for row in result.adapt]


# ---- O-90: balance --------------------------------------------------------------------------------------------------------


def assert_balance(p, tolerance=1e-10):
    force, moment = np.linalg.norm(p["force"]), np.linalg.norm(p["moment"])
    print("force", np.linalg.norm(np.add(p["force"], p["mortar_force"])) / force, "moment", np.linalg.norm(np.add(p["moment"], p["mortar_moment"])) / moment)
    assert force > 1e-4
    assert np.linalg.norm(np.add(p["force"], p["mortar_force"])) <= 1e-10 * force
    assert np.linalg.norm(np.add(p["moment"], p["mortar_moment"])) <= tolerance * moment


@SOLVERS
@pytest.mark.parametrize("options", [(), ("-order", 2), ("-adapt_tolerance", 0.01, "-adapt_max_passes", 2), ("-contact_pair_multiplier", "standard")])
def test_o90_momentum(solve, options, linear):
    """Forces and moments of the two sides cancel in the current configuration, on hanging nodes too; the supports carry what the contact does."""
    result = solve("-solve_linear", linear, *options, *QUIET)
    assert_balance(only(result))
    s = result.summary
    assert np.allclose(s["reaction"]["lower_z0"], s["contact"]["pair"]["force"], atol=1e-9 * s["contact"]["pair"]["force"][2])


@pytest.mark.parametrize("order", [1, 2])
def test_o90_momentum_on_a_ball(run, order, tolerance=1e-4):
    """Forces balance exactly. This is a quarter: directions at the planes of symmetry are those of the whole ball and do not turn with the quarter, so that the
    moment of its part alone need not vanish."""
    result = run("inputs/hertz3d.yml", "-order", order, "-adapt_max_passes", 2, "-boundary_top_displacement_z", "-0.05 - 0.05*X + 0.02*Y", *QUIET)
    assert_balance(good(result)["contact"]["ball_on_block"], tolerance)


# ---- O-91: exchange of the sides ------------------------------------------------------------------------------------------


def exchange(solve, n, origin=UPPER.origin, lower=LOWER, upper=UPPER):
    """|change of the total force| when the sides are exchanged, cells divided by n."""
    low, up = (box._replace(number=tuple(n * count for count in box.number)) for box in (lower, upper._replace(origin=origin)))
    one, other = (only(solve(*QUIET, lower=low, upper=up, contact=pairs(side))) for side in ("upper", "lower"))
    return abs(other["force"][2] / -one["force"][2] - 1)


def test_o91_exchange_of_sides(solve, lower=LOWER, upper=UPPER):
    """The upper block wide and the lower one narrow or the other way: total forces come together as h falls."""
    difference = [exchange(solve, n, upper.origin, lower, upper) for n in (1, 3)]
    print("force", difference)
    assert difference[1] < 0.01 and (difference[1] < 0.4 * difference[0] or max(difference) < 1e-3)


# ---- work and energy ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [pytest.param("press", marks=slow), "press_and_slide"])
def test_work_is_energy(solve, path, lower=(6, 4, 1), upper=(2, 2, 1)):
    """Contact without friction does no work: the energy is the work of the top, to second order of the step (trapezoidal rule)."""
    low, up = Box((0, 0, 0), (1.6, 1, 0.5), lower), Box((0.15, 0.2, 0.5), (0.6, 0.55, 0.4), upper)
    u = ("0", "0", "-0.06*t") if path == "press" else ("0.3*t*t", "0.1*t", "-0.06*t")
    error = []
    for n in (10, 20, 40):
        rows = [{"t": 0, **{f"reaction.upper_z1.{a}": 0 for a in "xyz"}}]
        result = solve(*QUIET, lower=low, upper=up, boundary=hold(u), load={"step": 1 / n})
        good(result)
        rows += result.history
        work = 0
        for a, b in zip(rows, rows[1:]):
            for axis, part in zip("xyz", u):
                move = eval(part, {"t": b["t"]}) - eval(part, {"t": a["t"]})
                work += 0.5 * (a[f"reaction.upper_z1.{axis}"] + b[f"reaction.upper_z1.{axis}"]) * move
        error.append(abs(work / result.summary["energy"] - 1))
    print(path, error)
    assert error[2] < 1e-3 and error[1] < 0.5 * error[0] and error[2] < 0.5 * error[1]


# ---- O-92, O-93: frames and units -----------------------------------------------------------------------------------------


def figures(result, frame=Frame(), stress=1.0):
    s, p = good(result), result.summary["contact"]["pair"]
    f = stress * frame.length**2
    return {"energy": s["energy"] / f / frame.length, "force": frame.R.T @ p["force"] / f, "mortar": frame.R.T @ p["mortar_force"] / f,
            "reaction": frame.R.T @ s["reaction"]["upper_z1"] / f, "pressure": p["max_pressure"] / stress, "area": p["area"] / frame.length**2,
            "error": s["estimated_error"]}


def assert_equal(one, other, tolerance):
    worst = {key: float(np.abs(np.asarray(other[key]) - one[key]).max() / np.abs(one[key]).max()) for key in one}
    print(worst)
    for key, difference in worst.items():
        assert difference <= tolerance, key


GRADED = {"refine": {name: {"boundary": name, "x": 0.3, "y": 0.3, "z": 1, "levels": levels} for name, levels in (("upper_z0", 2), ("lower_z1", 1))}}
ADAPTED = ("-adapt_tolerance", 0.01, "-adapt_max_passes", 2, "-output_fields", 0)


@SOLVERS
@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=slow)])
def test_o92_rotated_scene(solve, seed, linear):
    """The whole scene turned by a random rotation, supports with it, hanging nodes included: the same run, turned."""
    frame = Frame(seed)
    one, other = solve(*ADAPTED, "-solve_linear", linear), solve(*ADAPTED, "-solve_linear", linear, frame=frame)
    assert_equal(figures(one), figures(other, frame), 1e-8)
    assert [row["cells"] for row in one.adapt] == [row["cells"] for row in other.adapt] and iterations(one) == iterations(other)


def patch(frame, fix):
    """Two cubes pressed together between rollers on their sides; fix: how a side is held, by its name."""
    sides = {f"{body}_{side}": {"fix": fix(side)} for body in ("lower", "upper") for side in ("x0", "x1", "y0", "y1")}
    return {"lower_z0": {"fix": fix("z0")}, "upper_z1": {"displacement": frame.displacement(("0", "0", "-0.1 - 0.05*{x}*{y}"))}, **sides}


@pytest.mark.parametrize("options", [(), ("-adapt_tolerance", 0.001, "-adapt_max_passes", 2), ITERATIVE])
def test_o92_skew_rollers(solve, options):
    """Contact faces that end at rollers of any direction, adapted so that nodes hang on the roller planes: the run of the straight scene, turned."""
    frame = Frame(3)
    keys = {"lower": Box((0, 0, 0), (1, 1, 1), (2, 2, 2)), "upper": Box((0, 0, 1), (1, 1, 1), (3, 3, 2))}
    one = solve(*QUIET, *options, **keys, boundary=patch(Frame(), lambda side: side[0]))
    other = solve(*QUIET, *options, **keys, frame=frame, boundary=patch(frame, lambda side: "normal"))
    assert_equal(figures(one), figures(other, frame), 1e-8)
    assert iterations(one) == iterations(other)


def test_o92_rigid_rotation(solve):
    """Pressed in the first step, then top and bottom turn by 360 degrees about a skew axis, 45 at a step: energy and force stay, the force turns along."""
    k = np.array([1, 2, -2]) / 3
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    turn = [[f"({float(k[i] * k[j])!r} + ({float((i == j) - k[i] * k[j])!r})*cos(A) + ({float(cross[i][j])!r})*sin(A))" for j in range(3)] for i in range(3)]
    centre = (0.3, -0.2, 0.4)
    boundary = {}
    for name, down in (("lower_z0", ("0", "0", "0")), ("upper_z1", ("0.02*P", "0.01*P", "(-0.1 - 0.05*X)*P"))):
        at = [f"({X} + {d} - {c!r})" for X, d, c in zip("XYZ", down, map(float, centre))]
        u = {axis: " + ".join(f"{t}*{x}" for t, x in zip(row, at)) + f" + {c!r} - {X}" for axis, X, row, c in zip("xyz", "XYZ", turn, map(float, centre))}
        boundary[name] = {"displacement": {a: e.replace("A)", "0.25*pi*max(t - 1, 0))").replace("P", "min(t, 1)") for a, e in u.items()}}
    result = solve(*QUIET, boundary=boundary, load={"end": 9, "step": 1})
    good(result)
    rows = [row for row in result.history if row["t"] >= 1]
    energy = [row["energy"] for row in rows]
    force = [np.array([row[f"contact.pair.force.{a}"] for a in "xyz"]) for row in rows]
    size = [np.linalg.norm(f) for f in force]
    print("energy", max(energy) / min(energy) - 1, "force", max(size) / min(size) - 1)
    assert len(rows) == 9 and rows[-1]["t"] == 9 and result.summary["step_cuts"] == 0
    assert max(energy) / min(energy) - 1 < 1e-8 and max(size) / min(size) - 1 < 1e-8
    for row, f in zip(rows, force):
        a = math.pi / 4 * (row["t"] - 1)
        R = np.outer(k, k) + math.cos(a) * (np.eye(3) - np.outer(k, k)) + math.sin(a) * cross
        assert np.abs(R @ force[0] - f).max() < 1e-8 * size[0]


@SOLVERS
@pytest.mark.parametrize("change,length,stress,shift", [("lengths", 1e-3, 1, 0), ("stresses", 1, 1e6, 0), ("both", 1e-3, 1e6, 0), ("large", 1e3, 1e-6, 0),
                                                         ("shift", 1, 1, 1e4)])
def test_o93_units_and_origin(solve, change, length, stress, shift, linear, sooner=0):
    """Same meshes, same iterations, same figures to 1e-8; a shift by 1e4 edges leaves 12 decimals of the positions."""
    frame = Frame(None, length, shift)
    one = solve(*ADAPTED, "-solve_linear", linear, gap=0.01)  # not touching: gaps that vanish exactly are a kink
    other = solve(*ADAPTED, "-solve_linear", linear, gap=0.01, frame=frame, bodies={name: {**RUBBER, "E": stress} for name in BODIES})
    assert_equal(figures(one), figures(other, frame, stress), 1e-8)
    assert [row["cells"] for row in one.adapt] == [row["cells"] for row in other.adapt]
    assert all(0 <= a - b <= sooner for a, b in zip(iterations(one), iterations(other), strict=True))


# ---- O-94, O-95: the tangent and what it makes of Newton's method ---------------------------------------------------------


@pytest.mark.parametrize("options,keys", [
    ((), {}), ((), {"contact": pairs("lower")}), (("-contact_pair_multiplier", "standard"), {}), (("-order", 2), {"lower": LOWER._replace(number=(2, 2, 1))}),
    (("-material_upper_nu", 0.499), {"lower": LOWER._replace(number=(2, 2, 1))}), ((), {"frame": Frame(4)}),
    (("-refine_spot_boundary", "upper_z0", "-refine_spot_x", 0.3, "-refine_spot_y", 0.3, "-refine_spot_z", 1), {"refine": {"spot": {"boundary": "upper_z0"}}})],
    ids=["upper", "lower", "standard", "order2", "mixed", "turned", "hanging"])
def test_o94_tangent(solve, options, keys):
    """Every iterate of a solve against differences of the residual: bulk, tilt of the planes, corners of the polygons, dual coefficients, complementarity. The boxes overlap at
    the start: gaps that vanish exactly are a kink of the complementarity."""
    if "-material_upper_nu" in options:
        keys = {**keys, "bodies": {"lower": RUBBER, "upper": {**RUBBER, "formulation": "displacement"}}}
    result = solve(*QUIET, *options, "-snes_test_jacobian", gap=-0.013,
                   **{"upper": UPPER._replace(number=(2, 2, 1)), "lower": LOWER._replace(number=(3, 3, 1)), **keys})
    good(result)
    ratios = [float(r) for r in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([\d.e+-]+)", result.stdout)]
    print(ratios)
    assert len(ratios) >= 3 and max(ratios) < 1e-6


@pytest.mark.parametrize("options", [(), ("-order", 2), ("-adapt_tolerance", 0.01, "-adapt_max_passes", 2), ("-contact_pair_multiplier", "standard")])
@pytest.mark.parametrize("carries", ["upper", pytest.param("lower", marks=slow)])
def test_o95_newton_order(solve, options, carries):
    """The last residuals of every solve fall as the square, with the exact and with the symmetric form of the tangent."""
    for symmetric in (0, 1):
        result = solve(*QUIET, *options, "-snes_monitor", "-solve_symmetric", symmetric, contact=pairs(carries))
        good(result)
        print("Newton iterations", iterations(result), "estimated error", result.summary["estimated_error"], [[f"{r:.1e}" for r in one[-3:]] for one in steps(result)])
        for one in steps(result):
            assert len(one) < 3 or is_quadratic(one), one


SLIVERS = (-0.02, 0, 1e-4, 1e-3, 0.01, 0.05, 0.1, 0.2)  # of a face


@pytest.mark.parametrize("order,widths", [(1, (1e-4, 0.01, 0.05, 0.1)), pytest.param(1, SLIVERS, marks=slow), pytest.param(2, SLIVERS, marks=slow)])
def test_slivers(solve, order, widths):
    """The narrow body ends just beyond lines of the wide one's mesh, which carries the multipliers; pressed and tilted, it bulges through the whole range of widths. How much of the faces
    there is covered decides neither how many iterations it takes nor what comes out: without a compliance of what slivers hold, steps are cut, or no equilibrium is found."""
    forces, largest = [], []
    for width in widths:
        lo, size = 0.25 * (1 - width), 0.5 * (1 + width)
        s = good(solve(*QUIET, "-order", order, lower=LOWER._replace(number=(4, 4, 2)), upper=Box((lo, lo, 1), (size, size, 0.8), (2, 2, 2)),
                       boundary=hold(("0", "0", "-0.1 - 0.05*{x} + 0.03*{y}")), contact=pairs("lower")))
        print(width, s["newton_iterations"], s["contact"]["pair"]["force"][2], s["contact"]["pair"]["max_pressure"])
        assert s["step_cuts"] == 0 and s["recoveries"]["viscous"]["tried"] == 0 and s["newton_iterations"] <= 8
        forces.append(s["contact"]["pair"]["force"][2])
        largest.append(s["contact"]["pair"]["max_pressure"])
    apart = np.abs(np.polyval(np.polyfit(widths, forces, 2), widths) / forces - 1).max()
    print("forces apart from a smooth curve", apart)
    assert max(largest) < 1 and apart < 5e-4


# ---- O-96 to O-99: what must not break a run ------------------------------------------------------------------------------


@SOLVERS
@half("x, carries", [0, 1e-3, -1e-3], ["upper", "lower"])
def test_o96_edges_on_edges(solve, x, carries, linear):
    """Faces of the same size whose edges and corners coincide, then shifted by a hair, sides free."""
    result = solve(*QUIET, "-solve_linear", linear, upper=Box((0, 0, 1), (1, 1, 1), (2, 2, 2)), boundary=hold((str(x), str(x), "-0.1")), contact=pairs(carries))
    s = good(result)
    assert s["step_cuts"] == 0 and s["newton_iterations"] <= 8 and 0.05 < abs(s["contact"]["pair"]["force"][2]) < 0.12


@pytest.mark.parametrize("dz", [0.09, 0.1, 0.1001, 0.11, -0.1])
def test_o96_lines_on_lines(solve, dz):
    """Faces pressed together and slid along each other, lines y = 1/2 of both meshes on each other but for round-off: one state on either side of symmetry."""
    result = solve(*QUIET, lower=Box((0, 0, 0.5), (1, 1, 0.6), (6, 6, 2)), upper=Box((1, 0, 0.5), (1, 1, 0.6), (4, 4, 2)),
                   boundary={"lower_x0": {"fix": "xyz"}, "upper_x1": {"displacement": {"x": -0.02, "y": 0, "z": dz}}},
                   contact={"pair": {"nonmortar": "lower_x1", "mortar": "upper_x0"}})
    p = only(result)
    assert result.summary["newton_iterations"] <= 6 and result.summary["step_cuts"] == 0
    assert p["force"][0] == pytest.approx(-0.00591, rel=0.02) and p["force"][2] * dz < 0


@pytest.mark.parametrize("boundary", [hold(("0", "0", "0")), {f"{body}": {"displacement": {"x": 0.3, "y": 0.2, "z": 0.1}} for body in ("lower_z0", "upper_z1")}],
                         ids=["still", "moved"])
def test_o96_zero_load(solve, boundary):
    """Faces that touch without load: gaps of zero up to round-off, no force."""
    result = solve(*QUIET, boundary=boundary)
    p = only(result)
    assert result.summary["newton_iterations"] <= 5 and np.abs(p["force"]).max() < 1e-13


@SOLVERS
@pytest.mark.parametrize("gap,search", [(0.05, 0), (0.1, 10)])
def test_o97_free_fall(solve, gap, search, linear):
    """A block held by contact only falls on the other under dead load: no force of anything but the load is left."""
    upper = Box((0.2, 0.2, 1), (0.6, 0.6, 0.8), (2, 2, 2))
    result = solve(*QUIET, "-solve_linear", linear, upper=upper, gap=gap, contact=pairs(search=search),
                   boundary={"lower_z0": {"fix": "xyz"}, "upper_z1": {"traction": {"z": -0.02}}})
    load = 0.02 * 0.36
    assert np.allclose(only(result)["force"], [0, 0, load], atol=1e-8 * load)
    assert np.allclose(result.summary["reaction"]["lower_z0"], [0, 0, load], atol=1e-8 * load)


@SOLVERS
@pytest.mark.parametrize("lift,top", [(0, ("0", "0", "-0.1")), (0, ("0.05", "0", "-0.1 - 0.02*{x}")), (0.05, ("0", "0", "-0.2"))])
def test_o97_held_by_contact_only(run, tmp_path, lift, top, linear):
    """A block between two others that nothing else holds, touching or with gaps to both: it ends between them, in balance (where it would be pushed out to either side:
    unstable along the surfaces), at once."""
    parts = {"lower": Box((0, 0, 0), (1, 1, 0.5), (3, 3, 1)), "middle": Box((0.1, 0.15, 0.5 + lift), (0.7, 0.7, 0.5), (2, 2, 1)),
             "upper": Box((0, 0, 1 + 2 * lift), (1, 1, 0.5), (3, 3, 1))}
    boxes(tmp_path / "stack.msh", parts)
    contacts = {"below": {"nonmortar": "middle_z0", "mortar": "lower_z1"}, "above": {"nonmortar": "middle_z1", "mortar": "upper_z0"}}
    result = run("stack.yml", *QUIET, "-solve_linear", linear, "-load_stable", False, text=scene("stack.msh", {name: RUBBER for name in parts}, hold(top), contacts))
    c = good(result)["contact"]
    size = np.linalg.norm(c["below"]["force"])
    assert result.summary["step_cuts"] == 0 and size > 0.02 and np.linalg.norm(np.add(c["below"]["force"], c["above"]["force"])) < 1e-8 * size
    assert np.linalg.norm(np.add(c["below"]["moment"], c["above"]["moment"])) < 1e-8 * size


FIVE = {"low": Box((0, 0, 0), (2, 1, 0.5), (7, 4, 1)), "a": Box((0, 0, 0.5), (1, 1, 0.6), (3, 3, 1)), "b": Box((1, 0, 0.5), (1, 1, 0.6), (2, 2, 1)),
        "top": Box((0.2, 0.2, 1.1), (1.6, 0.6, 0.4), (4, 2, 1))}
FIVE_PAIRS = {"al": ("a_z0", "low_z1"), "bl": ("b_z0", "low_z1"), "ab": ("a_x1", "b_x0"), "ta": ("top_z0", "a_z1"), "tb": ("top_z0", "b_z1")}


@half("options, flip", [(), ITERATIVE, ("-mesh_refine", 1)], [0, 1])
def test_o98_five_pairs(run, tmp_path, options, flip):
    """Two blocks side by side between two others: nodes in two pairs, edges where three bodies meet, roller planes along all of it, blocks slipping off each other by
    a hair."""
    boxes(tmp_path / "five.msh", FIVE)
    contacts = {name: {"nonmortar": sides[flip], "mortar": sides[1 - flip]} for name, sides in FIVE_PAIRS.items()}
    boundary = {"low_z0": {"fix": "xyz"}, "top_z1": {"displacement": {"x": 0, "y": 0, "z": -0.1}}, "a_x0": {"fix": "x"}, "b_x1": {"fix": "x"},
                **{f"{body}_y{i}": {"fix": "y"} for body in "ab" for i in (0, 1)}}
    result = run("five.yml", *QUIET, *options, text=scene("five.msh", {name: RUBBER for name in FIVE}, boundary, contacts))
    c = good(result)["contact"]
    force = {name: (1 - 2 * flip) * np.array(p["force"]) for name, p in c.items()}
    assert np.allclose(force["al"] + force["ab"] - force["ta"], -np.array(result.summary["reaction"]["a_x0"]) - result.summary["reaction"]["a_y0"]
                       - result.summary["reaction"]["a_y1"], atol=1e-9)
    assert force["ab"][0] < -0.005 and force["al"][2] == pytest.approx(force["bl"][2], rel=0.05)


@SOLVERS
def test_o99_one_step_or_ten(solve, linear, depth=0.3):
    one, ten = (solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", f"-{depth}*t")), load={"step": step}) for step in (1, 0.1))
    assert good(one)["energy"] == pytest.approx(good(ten)["energy"], rel=1e-8)


@pytest.mark.parametrize("ranks", [1, pytest.param(2, marks=slow)])
def test_o99_impossible_motion_ends_in_order(solve, ranks):
    """The upper block is to be pressed through the lower one: exit 2, and the last accepted step complete."""
    result = solve(boundary=hold(("0", "0", "-2.2*t")), load={"step": 0.1, "step_min": 0.02}, ranks=ranks)
    s = result.summary
    assert result.returncode == 2 and s["status"] == "failed" and s["reason"] and 0.2 < s["t"] < 1 and s["step_cuts"] > 0
    assert result.history[-1]["t"] == pytest.approx(s["t"]) and s["energy"] == pytest.approx(result.history[-1]["energy"], rel=1e-9)
    assert all(np.isfinite(values).all() for values in result.states()[-1][1].values())


# ---- O-100, O-103: pressure -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("low,up,carries", [((8, 8, 2), (1, 1, 2), "upper"), ((1, 1, 2), (8, 8, 2), "lower"), ((4, 1, 2), (1, 4, 2), "upper"),
                                            *(pytest.param(*words, marks=slow) for words in (((8, 8, 2), (1, 1, 2), "lower"), ((1, 1, 2), (8, 8, 2), "upper"), ((4, 1, 2), (1, 4, 2), "lower")))])
def test_o100_uniform_pressure_of_unequal_meshes(solve, low, up, carries):
    """Faces 8 times finer on one side, with either side nonmortar: the patch is exact, no pressure oscillates."""
    boundary = {**patch(Frame(), lambda side: side[0]), "upper_z1": {"displacement": {"z": -0.1}}}
    result = solve(lower=Box((0, 0, 0), (1, 1, 1), low), upper=Box((0, 0, 1), (1, 1, 1), up), boundary=boundary, contact=pairs(carries))
    good(result)
    assert np.allclose(contact(result)["contact_pressure"], 0.0688979013617, rtol=1e-8)


def hanging(grid):
    """[(node, end, end)]: nodes of a contact surface that lie in the middle of another facet's side."""
    X, found = grid["X"], set()
    for corners in grid["cells"]:
        for a, b in zip(corners, np.roll(corners, -1)):
            middle = np.flatnonzero(np.abs(X - (X[a] + X[b]) / 2).max(axis=1) < 1e-9)
            found |= {(int(m), int(min(a, b)), int(max(a, b))) for m in middle}
    return sorted(found)


def test_o103_hanging_nodes_follow(solve):
    """Nodes that hang on both contact faces: the pressure there is that of their masters' hats, never one of its own; so is the place."""
    result = solve(**GRADED)
    good(result)
    sides = [contact(result, side) for side in (0, 1)]
    for grid in sides:
        assert len(hanging(grid)) >= 2
        for name in ("displacement", "contact_pressure") if grid is sides[0] else ("displacement",):
            for m, a, b in hanging(grid):
                assert np.allclose(grid[name][m], (grid[name][a] + grid[name][b]) / 2, rtol=1e-8, atol=1e-12)


# ---- O-104: separation, search --------------------------------------------------------------------------------------------


@SOLVERS
def test_o104_separation(solve, linear):
    result = solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", "t < 1 ? -0.1*t : -0.1 + 0.4*(t - 1)")), load={"end": 2, "step": 0.5})
    p = only(result)
    assert np.abs(p["force"]).max() < 1e-20 and p["max_pressure"] < 1e-20 and p["active_nodes"] == 0 and result.summary["energy"] < 1e-20
    assert max(row["contact.pair.force.z"] for row in result.history) > 0.02


@SOLVERS
def test_o104_open_and_close(solve, linear):
    """Pressed, lifted off by twice as much, pressed again: the state of pressing once."""
    again = solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", "-0.1*cos(pi*t)")), load={"end": 2, "step": 0.25})
    once = solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", "-0.1")))
    assert good(again)["energy"] == pytest.approx(good(once)["energy"], rel=1e-8)
    assert np.allclose(only(again)["force"], only(once)["force"], atol=1e-9)


@SOLVERS
@pytest.mark.parametrize("step", [1, 0.1])
def test_o104_from_out_of_reach(solve, step, linear):
    """A gap of 3, beyond the distance of the search, in one step or ten: the state of starting close."""
    far = solve(*QUIET, "-solve_linear", linear, gap=3, boundary=hold(("0", "0", "-3.1")), load={"step": step})
    near = solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", "-0.1")))
    assert good(far)["energy"] == pytest.approx(good(near)["energy"], rel=1e-8)


@SOLVERS
def test_sliding_over_many_facets(solve, linear, lower=(9, 6, 2), upper=(3, 3, 2)):
    """Slid over four facets in nine steps, or carried there in one: the same state."""
    keys = {"lower": Box((0, 0, 0), (2, 1.2, 0.5), lower), "upper": Box((0.1, 0.1, 0.5), (0.6, 0.5, 0.5), upper)}
    path = ("0.5*max(t - 0.2, 0)", "0.25*max(t - 0.2, 0)", "-0.05*min(t/0.2, 1)")
    steps_, once = (solve(*QUIET, "-solve_linear", linear, **keys, boundary=hold(path), load={"end": 2, "step": step}) for step in (0.2, 2))
    assert good(steps_)["energy"] == pytest.approx(good(once)["energy"], rel=1e-8) and np.allclose(only(steps_)["force"], only(once)["force"], atol=1e-9)


@SOLVERS
@pytest.mark.parametrize("gap", [0.05, -0.05])
def test_initial_gap_and_overlap(solve, gap, linear):
    """Blocks that start apart or inside each other, the top moved so that both end alike: the state of blocks that start in touch, but for the height of the upper."""
    result = solve(*QUIET, "-solve_linear", linear, gap=gap, boundary=hold(("0", "0", str(-0.1 - gap))))
    touch = solve(*QUIET, "-solve_linear", linear, boundary=hold(("0", "0", "-0.1")))
    assert good(result)["energy"] == pytest.approx(good(touch)["energy"], rel=1e-8)
    assert abs(only(result)["min_gap"]) < 1e-9


# ---- bodies: nearly incompressible, rigid, small kinematics ---------------------------------------------------------------


@SOLVERS
@pytest.mark.parametrize("carries", ["upper", "lower"])
@pytest.mark.parametrize("order", [1, 2])
def test_nearly_incompressible(solve, order, carries, linear, least=0.9):
    rubber = {**RUBBER, "nu": 0.499}
    result = solve(*QUIET, "-order", order, "-solve_linear", linear, bodies={name: rubber for name in BODIES}, contact=pairs(carries, order=1))
    assert_balance(only(result))
    assert result.summary["newton_iterations"] <= 7 and result.summary["min_det"] > least


@SOLVERS
@pytest.mark.parametrize("carries", ["upper", "lower"])
def test_rigid_punch(solve, carries, linear):
    """A rigid block moved into the other, nonmortar or mortar, with adaptation."""
    result = solve(*ADAPTED, "-solve_linear", linear, bodies={"lower": RUBBER, "upper": {"law": "rigid"}}, boundary={"lower_z0": {"fix": "xyz"}}, contact=pairs(carries),
                   body={"lower": {"material": "lower"}, "upper": {"material": "upper", "motion": {"x": 0.02, "y": "0.01", "z": -0.1}}})
    p = only(result)
    assert result.summary["step_cuts"] == 0 and 0.07 < abs(p["force"][2]) < 0.12
    assert np.allclose(result.summary["reaction"]["lower_z0"], np.multiply(p["force"], 1 if carries == "upper" else -1), atol=1e-9)


@SOLVERS
@pytest.mark.parametrize("carries", ["upper", "lower"])
def test_small_kinematics(solve, carries, linear):
    """Linear but for contact: closed contact answers twice the load with twice the force."""
    bodies = {name: {**RUBBER, "law": "linear"} for name in BODIES}
    force = [np.array(only(solve(*QUIET, "-solve_linear", linear, bodies=bodies, kinematics="small", contact=pairs(carries), boundary=hold(("0", "0", f"{-0.05 * k}"))))["force"])
             for k in (1, 2)]
    assert abs(force[0][2]) > 0.01 and np.allclose(force[1], 2 * force[0], atol=1e-10)


# ---- O-101: ranks ---------------------------------------------------------------------------------------------------------

RANKS = {
    "tilted": GRADED, "mixed": {"bodies": {name: {**RUBBER, "nu": 0.499} for name in BODIES}}, "iterative": {},
    "rigid": {"bodies": {"lower": RUBBER, "upper": {"law": "rigid"}}, "boundary": {"lower_z0": {"fix": "xyz"}}, "contact": pairs("lower"),
              "body": {"lower": {"material": "lower"}, "upper": {"material": "upper", "motion": {"z": -0.05}}}},
    "small": {"bodies": {name: {**RUBBER, "law": "linear"} for name in BODIES}, "kinematics": "small"},
}


def on_ranks(solve, name, counts):
    options = (*ADAPTED, *(ITERATIVE if name == "iterative" else ()))
    one = solve(*options, **RANKS[name])
    p = only(one)
    print(name, "Newton iterations", iterations(one), "estimated error", one.summary["estimated_error"])
    for ranks in counts:
        many = solve(*options, **RANKS[name], ranks=ranks)
        q = only(many)
        assert [row["cells"] for row in one.adapt] == [row["cells"] for row in many.adapt]
        if name != "iterative":  # the preconditioner depends on the partition
            assert iterations(one) == iterations(many)
        worst = max(abs(many.summary["energy"] / one.summary["energy"] - 1), np.abs(np.subtract(p["force"], q["force"])).max() / abs(p["force"][2]),
                    abs(p["max_pressure"] / q["max_pressure"] - 1), abs(many.summary["estimated_error"] / one.summary["estimated_error"] - 1))
        print(name, ranks, worst)
        assert worst < 1e-8


@pytest.mark.parametrize("name,ranks", [("tilted", 3), ("rigid", 2)])
def test_o101_ranks(solve, name, ranks):
    on_ranks(solve, name, (ranks,))


@slow
@pytest.mark.parametrize("name", RANKS)
def test_o101_one_to_four_ranks(solve, name):
    on_ranks(solve, name, (2, 3, 4))


# ---- degenerate ------------------------------------------------------------------------------------------------------------


def test_folded_mortar_facet(solve):
    """A corner of a mortar facet beyond its diagonal: the cell under it is no cell, which is said before anything is solved."""
    def fold(x):
        return x + ([0.18, 0.18, 0] if x[2] > 0.99 and np.hypot(x[0] - 1 / 3, x[1] - 1 / 3) < 0.1 else [0, 0, 0])

    result = solve(*QUIET, lower=LOWER._replace(to=fold))
    assert result.returncode == 1 and "inverted or degenerate" in result.stderr, result
