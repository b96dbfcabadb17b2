"""What must not break a run, or must end it in good order (O-96 to O-99, O-103, O-104): cycles of the active set, free bodies, cross points, inversion, separation."""
import math

import numpy as np
import pytest

from conftest import ROOT
from contactkit import bulk, contact

HERTZ, PATCH = "inputs/hertz2d.yml", "inputs/patch2d.yml"
ONE_MESH = ("-adapt_tolerance", 0, "-output_fields", 0)
PRESSURE = 0.0688979013617  # of the patch, see the header of inputs/patch2d.yml


def assert_converged(result):
    assert result.solved, result


# ---- O-96: active sets that hesitate --------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [("-order", 1, "-adapt_max_passes", 4), ("-order", 1, *ONE_MESH), ("-order", 2, *ONE_MESH)])
@pytest.mark.parametrize("depth", [0, -1e-9])
def test_o96_grazing(run, depth, options):
    """Lifted off, then lowered until the disc just touches: a gap and a pressure that vanish together."""
    result = run(HERTZ, *options, "-boundary_top_displacement_y", f"0.1*(t < 0.5 ? 2*t : 2 - 2*t) + ({depth})*t", "-load_step", 0.25)
    assert_converged(result)
    s = result.summary
    assert s["newton_iterations"] <= 8 * len(result.adapt) and s["step_cuts"] == 0
    assert abs(s["contact"]["disc_on_block"]["min_gap"]) < 1e-12 or s["contact"]["disc_on_block"]["min_gap"] > 0


@pytest.mark.parametrize("nonmortar,mortar", [("upper_bottom", "lower_top"), ("lower_top", "upper_bottom")])
def test_o96_zero_load(run, nonmortar, mortar):
    """Blocks that touch without load, moved together by a rigid motion: all gaps are zero up to round-off, all pressures vanish."""
    sides = ("-contact_upper_on_lower_nonmortar", nonmortar, "-contact_upper_on_lower_mortar", mortar)
    still = run(PATCH, *sides, "-boundary_top_displacement_y", 0)
    text = (ROOT / PATCH).read_text().replace("file: patch2d.geo", f"file: {ROOT}/inputs/patch2d.geo")
    for old, new in (("bottom: {fix: y}", "bottom: {displacement: {y: 0.1}}"), ("left:   {fix: x}", "left: {displacement: {x: 0.3}}"),
                     ("right:  {fix: x}", "right: {displacement: {x: 0.3}}"), ("displacement: {y: -0.1}", "displacement: {y: 0.1}")):
        assert old in text
        text = text.replace(old, new)
    moved = run("moved.yml", *sides, text=text)
    for result in (still, moved):
        assert_converged(result)
        assert result.summary["newton_iterations"] <= 5 and abs(result.summary["contact"]["upper_on_lower"]["force"][1]) < 1e-13


@pytest.mark.parametrize("nonmortar,mortar", [("upper_bottom", "lower_top"), ("lower_top", "upper_bottom")])
@pytest.mark.parametrize("x", [0, 1e-3, -1e-3])
def test_o96_edge_node_on_the_corner(run, x, nonmortar, mortar):
    """Sides free: the corners of the blocks stand exactly on each other, gap 0 and covered up to the very end; then the upper one is shifted over the edge."""
    text = (ROOT / PATCH).read_text().replace("file: patch2d.geo", f"file: {ROOT}/inputs/patch2d.geo")
    for old, new in (("  left:   {fix: x}\n", ""), ("  right:  {fix: x}\n", ""), ("bottom: {fix: y}", "bottom: {fix: xy}")):
        assert old in text
        text = text.replace(old, new)
    result = run("free.yml", "-boundary_top_displacement_x", x, "-contact_upper_on_lower_nonmortar", nonmortar, "-contact_upper_on_lower_mortar", mortar, text=text)
    assert_converged(result)
    s = result.summary
    assert s["newton_iterations"] <= 8 and s["step_cuts"] == 0 and s["active_set_cycles"] == 0 and s["active_set_changes"] > 0


# ---- O-97: a body that only contact holds ---------------------------------------------------------------------------------

FALL = """
mesh: {{file: {geo}, order: 1}}
model: plane_strain
body: {{lower: {{material: rubber}}, upper: {{material: rubber}}}}
material: {{rubber: {{law: neo_hookean, E: 1, nu: 0.3}}}}
boundary:
  bottom: {{fix: xy}}
  top: {{traction: {{y: -0.02}}}}
contact: {{pair: {{nonmortar: upper_bottom, mortar: lower_top, search: 10}}}}
load: {{step: 1}}
"""


def shifted_patch(tmp_path, gap, n=3):
    """The geometry of inputs/patch2d.geo with the upper block lifted by the gap, narrower than the lower one."""
    text = (ROOT / "inputs" / "patch2d.geo").read_text()
    for number, x, y in ((5, 0.2, 1 + gap), (6, 0.8, 1 + gap), (7, 0.8, 2 + gap), (8, 0.2, 2 + gap)):
        old = {5: "Point(5) = {0, 1, 0}", 6: "Point(6) = {1, 1, 0}", 7: "Point(7) = {1, 2, 0}", 8: "Point(8) = {0, 2, 0}"}[number]
        assert old in text
        text = text.replace(old, f"Point({number}) = {{{x}, {y}, 0}}")
    path = tmp_path / "gap.geo"
    path.write_text(text.replace("n = 3", f"n = {n}"))
    return path


def test_o97_free_fall(run, tmp_path):
    """Nothing but contact holds the upper block, a gap of 0.1 below it, dead load: it lands, and no force of the stabilisation is left."""
    result = run("fall.yml", text=FALL.format(geo=shifted_patch(tmp_path, 0.1)))
    assert_converged(result)
    s = result.summary
    load = 0.02 * 0.6
    assert s["contact"]["pair"]["force"][1] == pytest.approx(load, rel=1e-8)
    assert s["reaction"]["bottom"][1] == pytest.approx(load, rel=1e-8) and abs(s["reaction"]["bottom"][0]) < 1e-8 * load
    assert s["contact"]["pair"]["min_gap"] > -1e-9
    print("iterations", s["newton_iterations"], "force", s["contact"]["pair"]["force"][1] / load - 1, "cuts", s["step_cuts"])


# ---- O-98: cross points ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("nonmortar,mortar", [("upper_bottom", "lower_top"), ("lower_top", "upper_bottom")])
@pytest.mark.parametrize("planes", ["both", "left"])
def test_o98_contact_face_on_symmetry_planes(run, planes, nonmortar, mortar, order):
    """One or both ends of the contact face lie on planes that hold them: uniform pressure to 1e-8 (nu = 0 where one side is free)."""
    options = ("-contact_upper_on_lower_nonmortar", nonmortar, "-contact_upper_on_lower_mortar", mortar, "-order", order)
    if planes == "left":
        text = (ROOT / PATCH).read_text().replace("file: patch2d.geo", f"file: {ROOT}/inputs/patch2d.geo").replace("  right:  {fix: x}\n", "")
        result = run("left.yml", *options, "-material_rubber_nu", 0, text=text)
    else:
        result = run(PATCH, *options)
    assert_converged(result)
    stress = bulk(result)["cauchy_stress"] if "cauchy_stress" in bulk(result) else bulk(result)["stress"]
    expected = stress[0, 3]
    print(planes, order, np.abs(stress[:, 3] / expected - 1).max(), -expected / PRESSURE - 1)
    assert np.abs(stress[:, 3] / expected - 1).max() < 1e-8
    if planes == "both":
        assert -expected == pytest.approx(PRESSURE, rel=1e-8)
    assert np.allclose(contact(result)["contact_pressure"], -expected, rtol=1e-8)


def test_o98_support_across_the_face(run, refine=0):
    """Ends of the contact face held across it, free along it: no symmetry plane, whose mirror image would cancel the normal there. The top is held along it too:
    a body free to slide has a second equilibrium, beside the other. Held ends carry no multiplier: theirs would act on nothing but the tilt of the normal."""
    result = run(PATCH, "-boundary_left_fix", "y", "-boundary_right_fix", "y", "-boundary_bottom_fix", "xy", "-boundary_top_displacement_x", 0,
                 "-boundary_top_displacement_y", "-0.12*X*(1-X)", "-order", 2, "-mesh_refine", refine)
    assert_converged(result)
    s = result.summary
    assert s["newton_iterations"] <= 6 and s["step_cuts"] == 0
    assert s["contact"]["upper_on_lower"]["force"][1] == pytest.approx(0.005552, rel=0.01)  # order 2 at an estimated error of 0.2 %


THREE = """
n = 4;
Point(1) = {0, 0, 0};   Point(2) = {2, 0, 0};   Point(3) = {2, 1, 0};  Point(4) = {0, 1, 0};
Point(11) = {0, 1, 0};  Point(12) = {1, 1, 0};  Point(13) = {1, 2, 0}; Point(14) = {0, 2, 0};
Point(21) = {1, 1, 0};  Point(22) = {2, 1, 0};  Point(23) = {2, 2, 0}; Point(24) = {1, 2, 0};
"""
for first, last, name in ((1, 4, "low"), (11, 14, "a"), (21, 24, "b")):
    for i, side in enumerate(("bottom", "right", "top", "left")):
        THREE += f"Line({first + i}) = {{{first + i}, {first + (i + 1) % 4}}}; Physical Curve(\"{name}_{side}\") = {{{first + i}}};\n"
    THREE += f"Curve Loop({first}) = {{{first}:{last}}}; Plane Surface({first}) = {{{first}}}; Physical Surface(\"{name}\") = {{{first}}};\n"
THREE += """
Transfinite Curve {1:4} = 8;  Transfinite Curve {11:14} = 5;  Transfinite Curve {21:24} = 4;
Transfinite Surface {1, 11, 21};  Recombine Surface {1, 11, 21};
"""


@pytest.mark.parametrize("lower_carries", [False, True])
def test_o98_three_bodies_at_a_point(run, tmp_path, lower_carries):
    """Blocks a and b side by side on a third: their corners (nonmortar nodes in two pairs, when the upper ones carry the multipliers) meet at one point.
    Everything confined: uniform state."""
    (tmp_path / "three.geo").write_text(THREE)
    down = ("low_top", "{}_bottom") if lower_carries else ("{}_bottom", "low_top")
    pairs = [(n.format(x), m.format(x), x) for x in "ab" for n, m in [down]] + [("a_right", "b_left", "side")]
    text = "mesh: {file: three.geo, order: 1}\nmodel: plane_strain\nmaterial: {rubber: {law: neo_hookean, E: 1, nu: 0.3}}\n"
    text += "body: {low: {material: rubber}, a: {material: rubber}, b: {material: rubber}}\nload: {step: 1}\nboundary:\n"
    text += "".join(f"  {name}: {{fix: {axis}}}\n" for name, axis in (("low_bottom", "y"), ("low_left", "x"), ("low_right", "x"), ("a_left", "x"), ("b_right", "x")))
    text += "".join(f"  {x}_top: {{displacement: {{y: -0.1}}}}\n" for x in "ab")
    text += "contact:\n" + "".join(f"  {name}: {{nonmortar: {n}, mortar: {m}}}\n" for n, m, name in pairs)
    result = run("three.yml", text=text)
    assert_converged(result)
    s = result.summary
    print({name: p["force"] for name, p in s["contact"].items()}, s["newton_iterations"])
    assert s["min_det"] == pytest.approx(0.95, rel=1e-8)
    assert sum(p["force"][1] for name, p in s["contact"].items() if name != "side") == pytest.approx((-1 if lower_carries else 1) * 2 * PRESSURE, rel=1e-8)
    assert np.allclose(bulk(result)["J"], 0.95, rtol=1e-8)


# ---- O-99: inversion ------------------------------------------------------------------------------------------------------


def test_o99_one_step_or_ten(run):
    """The disc squeezed by 0.6 of its radius in one step: the state does not depend on how it was reached."""
    one = run("inputs/rubber2d.yml", "-order", 1, *ONE_MESH, "-boundary_top_displacement_y", -0.6)
    ten = run("inputs/rubber2d.yml", "-order", 1, *ONE_MESH, "-boundary_top_displacement_y", -0.6, "-load_step", 0.1)
    assert_converged(one)
    assert_converged(ten)
    print("cuts", one.summary["step_cuts"], ten.summary["step_cuts"], one.summary["energy"] / ten.summary["energy"] - 1)
    assert one.summary["energy"] == pytest.approx(ten.summary["energy"], rel=1e-6)
    assert one.summary["contact"]["disc_on_block"]["force"][1] == pytest.approx(ten.summary["contact"]["disc_on_block"]["force"][1], rel=1e-6)


@pytest.mark.parametrize("ranks", [1, 2])
def test_o99_impossible_motion_ends_in_order(run, ranks):
    """The upper block is to be pressed through the lower one: exit 2, the last accepted step complete and readable, no number that is none."""
    result = run(PATCH, "-boundary_top_displacement_y", -2.5, "-load_step", 0.1, "-load_step_min", 0.01, ranks=ranks)
    s = result.summary
    assert result.returncode == 2 and s["status"] == "failed" and s["reason"] and 0.3 < s["t"] < 0.8 and s["step_cuts"] > 0
    assert len(result.history) == s["load_steps"] and result.history[-1]["t"] == pytest.approx(s["t"])
    assert s["energy"] == pytest.approx(result.history[-1]["energy"], rel=1e-9) and 0 < s["min_det"] < 1
    time, fields = result.states()[-1]
    assert all(np.isfinite(values).all() for values in fields.values()) and time == pytest.approx(s["t"], rel=1e-5)
    assert s["contact"]["upper_on_lower"]["force"][1] == pytest.approx(s["reaction"]["bottom"][1], rel=1e-8)


# ---- O-103, O-104 ---------------------------------------------------------------------------------------------------------


def test_o103_no_multiplier_on_constrained_nodes(run):
    """Adapted meshes: each node of the contact grid is the end of one or two edges, and neighbours share it: nothing hangs on the contact face. (That the weighted
    gap of an edge is the sum over its children is not tested here.)"""
    result = run(HERTZ, "-order", 1, "-adapt_max_passes", 5)
    assert_converged(result)
    grid = contact(result)
    ends = np.sort(np.asarray(grid["X"])[:, 0])
    assert result.summary["contact"]["disc_on_block"]["active_nodes"] == int((grid["status"] >= 1).sum())
    assert np.all(np.diff(ends) > 0)  # no node twice
    cells = np.asarray(grid["cells"]).reshape(len(ends) - 1, -1)[:, -2:]
    assert np.bincount(cells.ravel()).max() == 2 and (np.bincount(cells.ravel()) == 1).sum() == 2  # one chain


@pytest.mark.parametrize("options", [("-order", 1, "-adapt_max_passes", 4), ("-order", 1, *ONE_MESH), ("-order", 2, *ONE_MESH)])
def test_o104_separation(run, options):
    """Press, then pull apart: no force, no multiplier left, both bodies free of stress."""
    result = run(HERTZ, *options, "-boundary_top_displacement_y", "t < 1 ? -0.05*t : -0.05 + 0.25*(t - 1)", "-load_end", 2, "-load_step", 0.5)
    assert_converged(result)
    s = result.summary
    p = s["contact"]["disc_on_block"]
    pressed = max(row["contact.disc_on_block.force.y"] for row in result.history)
    assert pressed > 0.015 and np.abs(p["force"]).max() < 1e-20 and p["max_pressure"] < 1e-20 and p["active_nodes"] == 0
    assert s["energy"] < 1e-20 and np.abs(s["reaction"]["bottom"]).max() < 1e-13
    print(s["energy"], s["reaction"]["bottom"], s["newton_iterations"], s["step_cuts"])


@pytest.mark.parametrize("step", [1, 0.25])
def test_o104_nothing_in_reach(run, tmp_path, step):
    """The upper block starts out of reach of the search and is lowered on the lower one, in one step or in several: the same state."""
    def lowered(gap):
        text = FALL.format(geo=shifted_patch(tmp_path, gap)).replace(", search: 10", "").replace("{traction: {y: -0.02}}", f"{{displacement: {{x: 0, y: {-gap - 0.1}}}}}")
        return run("lowered.yml", "-load_step", step, text=text)

    far, near = lowered(3), lowered(0)
    for result in (far, near):
        assert_converged(result)
    assert far.summary["contact"]["pair"]["force"][1] > 0.01
    assert far.summary["energy"] == pytest.approx(near.summary["energy"], rel=1e-8)
