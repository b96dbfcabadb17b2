"""Properties that every run with contact must keep, whatever the scene (O-90 to O-99, O-103, O-104): the figures compared come from the run itself."""
import math
import re
import subprocess

import numpy as np
import pytest

from conftest import ROOT
from contactkit import is_quadratic, steps

DISC = ROOT / "inputs" / "hertz2d.geo"
HERTZ = "inputs/hertz2d.yml"
LINEAR = ("-order", 2, "-mesh_order", 2, "-contact_disc_on_block_order", 1)  # contact faces
ONE_MESH = ("-adapt_tolerance", 0, "-output_fields", 0)


def pair(result, name="disc_on_block"):
    return result.summary["contact"][name]


def assert_converged(result):
    assert result.solved, result


# ---- O-90, O-91: balance, exchange of the sides ---------------------------------------------------------------------------


@pytest.mark.parametrize("scene,options", [("slide2d", ("-adapt_max_passes", 3)), ("rubber2d", ("-adapt_max_passes", 3)), ("hertz2d", ("-order", 3, *ONE_MESH))])
def test_o90_momentum(run, scene, options):
    """Forces and moments of the two sides cancel in the current configuration, also after finite sliding."""
    result = run(f"inputs/{scene}.yml", *options)
    assert_converged(result)
    p = pair(result)
    size = np.linalg.norm(p["force"])
    assert size > 0.01
    assert np.linalg.norm(np.add(p["force"], p["mortar_force"])) <= 1e-10 * size
    assert abs(p["moment"][0] + p["mortar_moment"][0]) <= 1e-6 * size


def test_o91_exchange_of_sides(run):
    """Total force to 0.5 %, largest pressure to 3 %, and both differences fall with h."""
    difference = []
    for refine in (2, 3):
        one = pair(run(HERTZ, *LINEAR, *ONE_MESH, "-mesh_refine", refine))
        other = pair(run(HERTZ, *LINEAR, *ONE_MESH, "-mesh_refine", refine, "-contact_disc_on_block_nonmortar", "block_top", "-contact_disc_on_block_mortar", "disc_surface"))
        assert other["force"][1] == pytest.approx(-one["force"][1], rel=0.05)  # each is the force on its nonmortar side
        difference.append([abs(other["force"][1] / -one["force"][1] - 1), abs(other["max_pressure"] / one["max_pressure"] - 1)])
    print("force, pressure:", difference)
    assert difference[-1][0] < 0.005 and difference[-1][1] < 0.03
    assert difference[-1][0] < difference[0][0] and difference[-1][1] < difference[0][1]


# ---- O-92, O-93: frames and units -----------------------------------------------------------------------------------------


def test_o92_rigid_rotation(run):
    """Pressed in the first step, then everything that is held turns by 360 degrees about a point, 45 at a step."""
    angle = "0.25*pi*max(t - 1, 0)"
    down = {"top": "0.05*min(t, 1)", "bottom": "0"}
    text = (ROOT / HERTZ).read_text().replace("file: hertz2d.geo", f"file: {DISC}")
    text = re.sub(r"^boundary:\n(  .*\n)+", "", text, flags=re.M)
    text = re.sub(r"^load:\n(  .*\n)+", "load: {end: 9, step: 1}\n", text, flags=re.M)
    text += "boundary:\n"
    for name, d in down.items():  # rotation about (0.3, -0.2) of where the press has put a point
        x, y = "(X - 0.3)", f"(Y - {d} + 0.2)"
        text += f'  {name}: {{displacement: {{x: "cos({angle})*{x} - sin({angle})*{y} + 0.3 - X", y: "sin({angle})*{x} + cos({angle})*{y} - 0.2 - Y"}}}}\n'
    result = run("rotation.yml", *LINEAR, *ONE_MESH, "-mesh_refine", 2, text=text)
    assert_converged(result)
    rows = [row for row in result.history if row["t"] >= 1]
    assert len(rows) >= 9 and rows[-1]["t"] == 9
    energy = [row["energy"] for row in rows]
    force = [math.hypot(row["contact.disc_on_block.force.x"], row["contact.disc_on_block.force.y"]) for row in rows]
    turn = [math.atan2(row["contact.disc_on_block.force.y"], row["contact.disc_on_block.force.x"]) - math.pi / 4 * (row["t"] - 1) for row in rows]
    print("energy", max(energy) / min(energy) - 1, "force", max(force) / min(force) - 1)
    assert max(energy) / min(energy) - 1 < 1e-8 and max(force) / min(force) - 1 < 1e-8
    assert all(math.cos(t - turn[0]) > 1 - 1e-12 for t in turn)


@pytest.fixture(scope="module")
def disc_mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "disc.msh"
    subprocess.run(["gmsh", "-2", "-order", "2", "-format", "msh22", "-o", str(path), str(DISC)], check=True, capture_output=True)
    return path.read_text()


def moved_mesh(mesh, factor, shift):
    head, nodes, tail = re.fullmatch(r"(.*\$Nodes\n\d+\n)(.*?)(\$EndNodes.*)", mesh, re.S).groups()
    lines = []
    for line in nodes.splitlines():
        n, x, y, z = line.split()
        lines.append(f"{n} {float(x) * factor + shift!r} {float(y) * factor + shift!r} {z}\n")
    return head + "".join(lines) + tail


@pytest.mark.parametrize("change,length,stress,shift,tolerance", [
    ("lengths", 1e-3, 1, 0, 1e-8), ("stresses", 1, 1e6, 0, 1e-8), ("both", 1e-3, 1e6, 0, 1e-8), ("large", 1e3, 1e-6, 0, 1e-8),
    # A shift by 1e4 radii leaves 12 decimals of the mesh itself and of current positions: what it costs is asserted.
    ("shift", 1, 1, 1e4, 1e-8)])
def test_o93_units_and_origin(run, tmp_path, disc_mesh, change, length, stress, shift, tolerance):
    def solve(factor, modulus, by, name):
        (tmp_path / f"{name}.msh").write_text(moved_mesh(disc_mesh, factor, by))
        text = (ROOT / HERTZ).read_text().replace("file: hertz2d.geo", f"file: {name}.msh").replace("  order: 4 ", "  #")
        result = run(f"{name}.yml", "-order", 2, "-contact_disc_on_block_order", 1, "-boundary_top_displacement_y", -0.05 * factor, "-material_rubber_E", modulus, "-adapt_max_passes", 4, "-output_fields", 0, text=text)
        assert_converged(result)
        return result

    one, other = solve(1, 1, 0, "one"), solve(length, stress, shift, "other")
    a, b = one.summary, other.summary
    if not shift: # which costs digits: the last iteration of a pass may be spared
        assert [row["newton_iterations"] for row in one.adapt] == [row["newton_iterations"] for row in other.adapt]
    assert [row["cells"] for row in one.adapt] == [row["cells"] for row in other.adapt]
    figures = {"energy": (a["energy"] * stress * length**2, b["energy"]), "error": (a["estimated_error"], b["estimated_error"]),
               "force": (pair(one)["force"][1] * stress * length, pair(other)["force"][1]), "pressure": (pair(one)["max_pressure"] * stress, pair(other)["max_pressure"]),
               "area": (pair(one)["area"] * length, pair(other)["area"]), "reaction": (a["reaction"]["top"][1] * stress * length, b["reaction"]["top"][1])}
    print(change, {key: abs(q / p - 1) for key, (p, q) in figures.items()})
    for key, (p, q) in figures.items():
        assert q == pytest.approx(p, rel=tolerance), key


# ---- O-94, O-95: the tangent and what it makes of Newton's method ---------------------------------------------------------


@pytest.mark.parametrize("scene,order,options", [
    ("hertz2d", 1, ()), ("hertz2d", 2, ()), ("slide2d", 1, ("-load_step", 2)), ("rubber2d", 1, ("-material_rubber_formulation", "displacement")),
    ("rubber2d", 1, ("-boundary_top_displacement_y", -0.1))])
def test_o94_tangent(run, scene, order, options):
    """Every iterate of a solve against differences of the residual: bulk, normals, segment ends, dual coefficients, complementarity. The load is not symmetric:
    exactly symmetric meshes have segments that end in nodes, a kink."""
    x = () if scene == "slide2d" else ("-boundary_top_displacement_x", 0.0123)
    result = run(f"inputs/{scene}.yml", *ONE_MESH, "-order", order, *x, *options, "-snes_test_jacobian")
    assert_converged(result)
    ratios = [float(r) for r in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([\d.e+-]+)", result.stdout)]
    print(scene, order, ratios)
    assert len(ratios) >= 3 and max(ratios) < 1e-6


@pytest.mark.parametrize("scene,options", [
    ("patch2d", ("-boundary_top_displacement_y", -0.6)), ("hertz2d", ("-boundary_top_displacement_x", 0.0123, *ONE_MESH)),
    ("hertz2d", ("-boundary_top_displacement_x", 0.0123, "-boundary_top_displacement_y", -0.3, "-order", 2, *ONE_MESH)), ("rubber2d", ONE_MESH), ("slide2d", ONE_MESH)])
def test_o95_newton_order(run, scene, options):
    """The last residuals of every solve fall as the square, with the exact and with the symmetric form of the tangent."""
    for symmetric in (0, 1):
        result = run(f"inputs/{scene}.yml", *options, "-snes_monitor", "-solve_symmetric", symmetric)
        assert_converged(result)
        print(scene, [[f"{r:.1e}" for r in solve[-3:]] for solve in steps(result)])
        for solve in steps(result):
            assert len(solve) < 3 or is_quadratic(solve), solve
