"""Public problems with published numbers: rows of docs/benchmarks.md. Each figure of a row is asserted with the tolerance of its source, or a narrower one."""
import json
import math
import pathlib
import sys

import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "stability"))
from kit import ROOT, plain, run  # noqa: E402, F401
from boxmesh import write  # noqa: E402
from contactkit import contact  # noqa: E402
import test_contact_classical3d as classical3d  # noqa: E402

HERE = "tests/benchmarks/"
QUIET = ("-output_fields", "false")
SSNP154 = "NAFEMS R0094, benchmark 1; code_aster, SSNP154"


@pytest.fixture
def figures(record_property):
    """figures(problem, source, result, rows, published): rows of (figure, value, target, tolerance), asserted; tolerance relative, or absolute as a tuple (x,)."""
    def tell(problem, source, result, rows, published="-"):
        s = result.summary
        record_property("benchmark", {"problem": problem, "source": source, "published": published, "unknowns": s["dofs"], "steps": s["load_steps"], "newton": s["newton_iterations"],
                                      "seconds": s["time"]["total"] - s["time"]["mesh"], "rows": [(name, float(value), float(target), tolerance) for name, value, target, tolerance in rows]})
        print([(name, float(value), target) for name, value, target, _ in rows], s["load_steps"], s["newton_iterations"], s["dofs"])
        assert result.solved, result
        for name, value, target, tolerance in rows:
            assert abs(value - target) <= (tolerance[0] if isinstance(tolerance, tuple) else tolerance * abs(target)), (name, value, target)
    return tell


def along(result, side=0):
    """Reference x, displacement and pressure of nonmortar nodes, by x."""
    state = contact(result)
    nodes = numpy.unique(state["cells"].astype(int)[state["side"] == side])
    nodes = nodes[numpy.argsort(state["X"][nodes, 0])]
    return state["X"][nodes], state["displacement"][nodes], state["contact_pressure"][nodes]


def test_cylinder_on_block(run, figures):
    result = run("inputs/cylinder.yml", "-adapt_tolerance", 0.01, "-adapt_max_passes", 12)
    centre = result.summary["probe"]["centre"]
    figures("Cylinder on a block, 35 kN/mm, no friction", SSNP154, result,
            [("displacement of the block's centre", centre["displacement"][1], -1.30802, 0.005), ("its stress", centre["stress"][3], -3513.37, 0.02)])


@pytest.mark.slow
def test_hertz(run, figures):
    result = run("inputs/cylinder.yml", "-boundary_flat_traction_y", -3.5, "-adapt_tolerance", 0.01, "-adapt_max_passes", 14,
                 *(word for body in ("steel", "aluminium") for word in (f"-material_{body}_law", "neo_hookean", f"-material_{body}_volumetric", "log")))
    pair = result.summary["contact"]["cylinder_on_block"]
    figures("The same, a hundredth of the force: Hertz", SSNP154, result, [("largest pressure", pair["max_pressure"], 358.536, 0.01), ("half width", pair["radius"], 0.62146, 0.03)])


@pytest.mark.slow
def test_cylinder_with_friction(run, figures):
    result = run("inputs/cylinder.yml", "-contact_cylinder_on_block_friction", 0.1, "-adapt_tolerance", 0.01, "-adapt_max_passes", 12)
    figures("Cylinder on a block, friction 0.1", SSNP154, result, [("displacement of the block's centre", result.summary["probe"]["centre"]["displacement"][1], -1.30264, 0.005)])


def test_plate_on_a_plane(run, figures):
    result = run(HERE + "greco.yml")
    slips = [result.summary["probe"][f"p{k}"]["displacement"][0] for k in range(5)]
    figures("Plate on a rigid plane, friction 1: slip, stick and lift-off", "GRECO problem; code_aster, SSNV128, digitised mean of codes", result,
            [(f"slip at {x} mm, 1e-5 m", slip * 1e5, target, 0.05) for x, slip, target in zip((0, 1.25, 5, 7.5, 11.25), slips, (2.86, 2.72, 2.28, 1.98, 1.50))])


def test_rings(run, figures):
    result = run(HERE + "rings.yml")
    x, _, p = along(result)
    angle = numpy.arctan2(x[:, 1], x[:, 0])
    probe = result.summary["probe"]
    exact = 9259259.259 + 135718 * numpy.cos(2 * angle)
    figures("Two rings, pressure with cos 2 theta", "code_aster, SSNP167, exact", result,
            [("pressure at 0 degrees", p[numpy.argmin(angle)], 9394977.169, 1e-3), ("at 90 degrees", p[numpy.argmax(angle)], 9123541.350, 1e-3),
             ("displacement at 0 degrees", probe["at0"]["displacement"][0], -0.00551736682, 1e-3), ("at 90 degrees", probe["at90"]["displacement"][1], -0.00514929985, 1e-3),
             ("largest error of the pressure / pressure", numpy.abs(p / exact - 1).max(), 0, (1e-3,))])


def test_disc_in_a_ring(run, figures):
    result = run("disc.yml", text=(ROOT / HERE / "rings.yml").read_text().replace("rings.geo", str(ROOT / HERE / "disc.geo")))
    x, _, p = along(result)
    angle = numpy.arctan2(x[:, 1], x[:, 0])
    exact = 1e7 + 147926.267 * numpy.cos(2 * angle)
    figures("A disc in a ring, pressure with cos 2 theta", "code_aster, SSNP169, exact", result,
            [("pressure at 0 degrees", p[numpy.argmin(angle)], 1e7 + 147926.267, 1e-3), ("at 90 degrees", p[numpy.argmax(angle)], 1e7 - 147926.267, 1e-3),
             ("largest error of the pressure / pressure", numpy.abs(p / exact - 1).max(), 0, (1e-3,))])


def test_manufactured(run, figures):
    result = run(HERE + "obstacle.yml", "-mesh_refine", 1)
    x, _, p = along(result)
    figures("Manufactured solution with contact, large deformation", "code_aster, SSNP150, exact", result,
            [("pressure in the middle", p[numpy.argmin(abs(x[:, 0] - 0.5))], 0.0132603, 0.01), ("at the ends", p[0], 0.0285334, 0.01)])


@pytest.mark.slow
def test_manufactured_rates(run):
    """Each refinement divides the error of the pressure in the middle by two at least (order 2)."""
    error = []
    for refine in (0, 1, 2):
        x, _, p = along(run(HERE + "obstacle.yml", "-mesh_refine", refine))
        error.append(abs(p[numpy.argmin(abs(x[:, 0] - 0.5))] / 0.013260288 - 1))
    print(error)
    assert error[2] < error[0] / 4


@pytest.mark.slow
def test_column(run, figures):
    result = run(HERE + "column.yml", *QUIET)
    s = result.summary
    figures("Four bodies in a column, three contacts that begin in points", "code_aster, SSNA102, mean of three codes", result,
            [("displacement under the lower plate", s["probe"]["centre"]["displacement"][1], -0.81, 0.04), ("force of the clamped edge, N per radian", s["reaction"]["edge"][1] / 2 / math.pi, 17229.58, 0.016)])


def test_crushed_cylinder(run, figures):
    result = run("tests/verify/scenes/pressed_cylinder.yml", *QUIET, "-load_step", 0.5)
    force = {row["t"]: -2 * row["reaction.middle.y"] / 1e3 for row in result.history}
    figures("Rubber cylinder crushed between plates", "Sussman & Bathe, Comput. Struct. 26 (1987) 357; ANSYS VM201", result,
            [("force at an approach of 0.1 m, kN/m", force[0.5], 250, 0.02), ("at 0.2 m", force[1], 1400, 0.02)])


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="a mean of codes on coarse cells; both roles, orders 1 to 4 and the quarter in space converge to -0.1340, 2.5 % more")
def test_rounded_punch(run, figures):
    result = run("round.yml", *QUIET, text=classical3d.ROUND)
    centre = result.summary["probe"]["centre"]
    figures("Punch with a rounded edge", "NAFEMS R0094, benchmark 2; code_aster, SSNA122, mean of codes", result,
            [("displacement at the centre", centre["displacement"][1], -0.130734, 0.01), ("stress", centre["stress"][3], -91.1006, 0.05)])


@pytest.mark.slow
def test_polyurethane_ring(run, figures):
    result = run("inputs/ring.yml", *QUIET, "-boundary_front_fix", "z")
    force = {round(row["t"], 6): row["contact_force"] for row in result.history}
    figures("Polyurethane ring between rigid plates", "Saleeb, Chen & Chang, Int. J. Numer. Methods Eng. 37 (1994); code_aster SSNP501", result,
            [(f"force at {4.45 * t:.4g} cm, N", force[t], target, tolerance)
             for t, target, tolerance in ((0.25, 8.0083, 0.10), (0.5, 16.0166, 0.06), (0.75, 24.0250, 0.04), (1, 32.0333, 0.04))])


def slips(result, after):
    """Times from which a part and all of the foot slips."""
    rows = [row for row in result.history if row["t"] > after + 1e-6]
    return [min(round(row["t"], 6) for row in rows if condition(row)) for condition in (lambda row: row["contact.c.slipping_nodes"] > 0, lambda row: row["contact.c.sticking_nodes"] == 0)]


def test_drawn_block(run, figures):
    """On the deck's own mesh of one cell; with more the corner at the front digs in, and sticks longer."""
    result = run(HERE + "drawn.yml", *QUIET)
    part, whole = slips(result, 0.2)
    figures("Block drawn over a rigid plane, friction 0.5, one cell", "FEBio test suite, deck co46", result, [("t at which part of it slips", part, 0.23, (0.0101,)), ("all of it", whole, 0.25, (0.0101,))], "100 steps, 852 iterations")
    assert result.summary["newton_iterations"] <= 400 and result.summary["load_steps"] == 100
    held = [slips(run(HERE + "drawn.yml", *QUIET, "-mesh_parameter_n", n), 0.2)[1] for n in (2, 4, 8)]
    print(held)
    assert held == sorted(held) and whole < held[0]


def test_block_drawn_over_a_block(run):
    """FEBio's deck co44 (50 steps, 382 iterations there): its mesh of one cell each and finer ones."""
    for n in (1, 4):
        for order in (1, 2):
            result = run(HERE + "pair.yml", *QUIET, "-mesh_parameter_n", n, "-order", order)
            print(n, order, result.summary["newton_iterations"])
            assert result.solved and result.summary["load_steps"] == 50 and result.summary["step_cuts"] == 0 and result.summary["newton_iterations"] <= 200, result


def hertz(row, R=200, E=1000, nu=0.3):
    """(force, radius of contact by it, shear modulus) of a half of sphere.geo, whose other half is its mirror image."""
    P = abs(row["contact.c.force.z"])
    return P, (0.75 * P * R * (1 - nu ** 2) / E) ** (1 / 3), E / 2 / (1 + nu)


def lubkin(twist):
    """Torque / (mu P a) at twist G a^2 / (mu P): theta of the radius c of the stick zone by its integral, and dT = 16/3 c^3 dtheta."""
    c, phi = 1 - numpy.linspace(0, 1, 1000, endpoint=False) ** 2, (numpy.arange(2000) + 0.5) * math.pi / 4000
    theta = [3 / (4 * math.pi) * numpy.mean((1 - x * x) * numpy.cos(phi) ** 2 / numpy.sqrt(x * x + (1 - x * x) * numpy.sin(phi) ** 2)) * math.pi / 2 for x in c]
    torque = numpy.concatenate([[0], numpy.cumsum(8 / 3 * (c[1:] ** 3 + c[:-1] ** 3) * numpy.diff(theta))])
    return numpy.interp(twist, theta, torque)


def test_formulas():
    """The tables of the two problems."""
    for twist, torque in ((0.038514, 0.176345), (0.123436, 0.409739), (0.225712, 0.528576), (0.365570, 0.576869)):
        assert lubkin(twist) == pytest.approx(torque, rel=1e-4)
    full, loop = shifted(18.315018, 0.5, 1000 / 2.6)
    assert full == pytest.approx(1.821429e-2, rel=1e-5) and loop(0.75) == pytest.approx(1.333335e-2, rel=1e-5)


@pytest.mark.slow
def test_lubkin(run, figures):
    """The twist is prescribed, and the depth: compared with the theory for the force found. Half of the model: the other sphere turns the other way."""
    result = run(HERE + "lubkin.yml", "-adapt_tolerance", 0.1)
    figure, nominal = [], 4 / 3 * 1000 / 0.91 / 200
    for row, twist in zip(result.history[1:], (0.038514, 0.123436, 0.225712, 0.365570)):
        P, a, _ = hertz(row)
        twist *= nominal / P * a ** 2
        figure.append((f"torque / (mu P a) at a twist of {twist:.4f} mu P / (G a^2)", abs(row["contact.c.moment.z"]) / (0.3 * P * a), lubkin(twist), 0.005))
    figures("Two spheres twisted against each other", "Lubkin, J. Appl. Mech. 18 (1951) 183", result, figure)


def shifted(P, a, G, mu=0.3, nu=0.3):
    """(shift of two spheres at which all slips, energy of a loop) by Mindlin; loop(q): between +- q mu P."""
    full = 3 * mu * P * (2 - nu) / (8 * a * G)
    return full, lambda q: 9 / 5 * (mu * P) ** 2 * (2 - nu) / (a * G) * (1 - (1 - q) ** (5 / 3) - 5 / 6 * q * (1 + (1 - q) ** (2 / 3)))


SHIFT = 0.0036428571  # at which all slips by the nominal force


def partial_slip(rows):
    """Figures of mindlin.yml (name, found, by the theory for the forces found, tolerance). The shift is prescribed, and the depth. 0.3 % of the shift is missing, what
    is beyond the 205 radii of the bodies; the energy goes with its cube, so the loop is compared by its force."""
    figure = []
    for row, q in zip(rows[1:4], (0.25, 0.5, 0.75)):
        P, a, G = hertz({"contact.c.force.z": 2 * row["contact.c.force.z"]})
        found, shift = 2 * abs(row["contact.c.force.x"]) / 0.3 / P, SHIFT * (1 - (1 - q) ** (2 / 3)) / shifted(P, a, G)[0]
        figure.append((f"shift / (shift of full slip) at Q = {found:.3f} mu P", shift, 1 - (1 - found) ** (2 / 3), 0.01))
    energy = 2 * sum(row["contact.c.dissipation"] for row in rows[4:6])
    return [*figure, ("energy of a loop between these forces", energy, shifted(P, a, G)[1](found), 0.01)]


@pytest.mark.slow
def test_mindlin(run, figures):
    result = run(HERE + "mindlin.yml", "-adapt_tolerance", 0.1, "-adapt_max_passes", 4)
    figures("Two spheres, a tangential force to and fro", "Mindlin, J. Appl. Mech. 16 (1949) 259; Mindlin & Deresiewicz 1953", result, partial_slip(result.history))


@pytest.mark.slow
def test_mindlin_loop(run):
    """Coarse cells: a restart in the loop changes nothing; after adaptation within it the loop is that of the finer mesh."""
    start = run(HERE + "mindlin.yml", "-load_max_steps", 4, "-output_checkpoint", 1)
    whole = run(HERE + "mindlin.yml", "-output_checkpoint", 1)
    rest = run(HERE + "mindlin.yml", "-restart", start.directory / "checkpoint.h5")
    loops = [[row["contact.c.dissipation"] for row in result.history[-2:]] for result in (whole, rest)]
    assert loops[1] == pytest.approx(loops[0], rel=1e-3)
    adapted = run(HERE + "mindlin.yml", "-restart", start.directory / "checkpoint.h5", "-adapt_tolerance", 0.2)
    fine = run(HERE + "mindlin.yml", "-adapt_tolerance", 0.2)
    for result in (adapted, fine): assert result.solved, result
    assert [row["pass"] for row in adapted.adapt][-3:] == [0, 1, 0]
    energy = [result.history[-1]["contact.c.dissipation"] for result in (adapted, fine)]
    print(loops, energy)
    assert energy[0] == pytest.approx(energy[1], rel=0.01)


@pytest.mark.slow
def test_tube_collapse(run, figures):
    """Pressure / (D/R^3): half minor axis of the midline, and where walls meet (of thickness 0: at half of it here a little before); force of the walls on each other, R^2/D. Of a
    thickness of 0.01 R: what is off goes with it (of 0.02: forces by 0.11)."""
    result = run(HERE + "tube.yml", *QUIET, "-load_step", 0.025, "-load_step_max", 0.025)
    p = numpy.array([8 * row["t"] for row in result.history])
    minor = numpy.array([0.999 + row["probe.minor.displacement.y"] for row in result.history])
    force = numpy.array([abs(row["contact_force"]) for row in result.history])
    touched = p[force > 1e-9].min()
    figures("A long tube collapses until its walls meet", "the elastica, integrated; Flaherty, Keller & Rubinow, SIAM J. Appl. Math. 23 (1972) 446", result,
            [("half minor axis / R at p = 3.86212", numpy.interp(3.86212, p, minor), 0.33923, (0.005,)), ("at 4.51569", numpy.interp(4.51569, p, minor), 0.14669, (0.005,)),
             ("pressure at which walls meet", touched, 5.24689, 0.01)] +
            [(f"force of the walls at p = {at}", 2 * numpy.interp(at, p, force), target, (0.06,)) for at, target in ((5.9969, 1.17), (6.9969, 2.73), (7.9969, 4.30))])


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="sliding 5.8 % above the published, digitised force; other published histories, with friction, lie between 3.37 and 4.21")
def test_shallow_ironing(run, figures):
    result = run("inputs/ironing.yml", *QUIET, "-load_step", 0.05, "-load_step_max", 0.05)
    t, force = ([row[key] for row in result.history] for key in ("t", "reaction.bottom.y"))
    figures("Shallow ironing, a slice with one face free", "Poulios & Renard, Comput. Struct. 153 (2015) 75, digitised", result,
            [(f"vertical force at t = {at}, 1e8", numpy.interp(at, t, force) / 1e8, target, (0.136,)) for at, target in ((0.5, 0.80), (1, 2.68), (1.5, 3.38), (2, 2.90))], "510 steps")


def cube(run, tmp_path, material, boundary, model="3d", **load):
    """One cell, pulled."""
    dim = 3 if model == "3d" else 2
    write(tmp_path / "cube.msh", [[0, 1]] * dim)
    scene = {"mesh": {"file": "cube.msh"}, "model": model, "body": {"body": {"material": "m"}}, "material": {"m": material}, "boundary": boundary, "load": load, "output": {"fields": False}}
    return run("cube.yml", text=json.dumps(scene))


def test_rubber_of_ogden(run, figures, tmp_path):
    """sum mu_p (l^(alpha_p - 1) - l^(-alpha_p/2 - 1)), the law's own figure for Treloar's rubber, in kg/cm2."""
    material = {"law": "ogden", "mu1": 6.3, "alpha1": 1.3, "mu2": 0.012, "alpha2": 5, "mu3": -0.1, "alpha3": -2, "kappa": "inf", "volumetric": "simo"}
    result = cube(run, tmp_path, material, {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}, "x1": {"displacement": {"x": 6}}}, step=0.25, step_max=0.25)
    stress = {row["t"]: row["reaction.x1.x"] for row in result.history}
    exact = lambda x: 6.3 * (x ** 0.3 - x ** -1.65) + 0.012 * (x ** 4 - x ** -3.5) - 0.1 * (x ** -3 - 1)  # noqa: E731
    figures("Treloar's rubber in tension, Ogden's law of three terms", "Ogden, Proc. R. Soc. Lond. A 326 (1972) 565, closed form", result,
            [(f"nominal stress at stretch {1 + 6 * t:g}", stress[t], exact(1 + 6 * t), 1e-6) for t in (0.5, 1)])


@pytest.mark.slow
def test_necking_strain(run, figures, tmp_path):
    """Considere: the force on a bar is largest where dk/d(strain) = k, for Swift's law at a logarithmic strain of n - e0 (stiff elasticity)."""
    n, e0 = 0.216, 0.0045
    material = {"law": "j2", "volumetric": "simo", "E": 2e5, "nu": 0.4999, "formulation": "mixed", "yield": 1, "swift_strain": e0, "swift_exponent": n}
    result = cube(run, tmp_path, material, {"y0": {"fix": "y"}, "x0": {"fix": "x"}, "y1": {"displacement": {"y": 0.3}}}, model="axisymmetric", step=0.005, step_max=0.005)
    force = numpy.array([row["reaction.y1.y"] for row in result.history])
    top = force.argmax()
    fit = numpy.polyfit([row["t"] for row in result.history[top - 5:top + 6]], force[top - 5:top + 6] / force[top], 2)
    figures("Uniform strain of a bar with Swift's hardening", "Swift, J. Mech. Phys. Solids 1 (1952) 1; Considere", result,
            [("logarithmic strain at the largest force", math.log(1 - 0.3 * fit[1] / 2 / fit[0]), n - e0, 0.01), ("largest stress / yield", force[top] / math.pi * math.exp(n - e0), (n / e0) ** n, 1e-3)])
