"""Tied surfaces (contact.<pair>.kind: tied): patch tests, rigid rotation, the L-shape against the mesh that conforms, bad input."""
import math
import re

import numpy
import pytest

from conftest import ROOT
from boxes import Box, boxes
from contactkit import PAIRINGS, blocks, bulk, graded, yaml

LINEAR = {"law": "linear", "E": 100, "nu": 0.3}
RUBBER = {"law": "neo_hookean", "E": 100, "nu": 0.3}
H = numpy.array([[0.01, 0.03, 0.02], [-0.02, 0.04, 0.01], [0.03, -0.01, 0.02]])
SIDES = ("left_lower", "left_upper", "right_lower", "right_upper", "bottom", "top")


def motion(matrix):
    """x, y, z of a displacement that is linear in the reference positions."""
    return {"xyz"[i]: " + ".join(f"({value:.17g})*{name}" for value, name in zip(row, "XYZ")) for i, row in enumerate(matrix)}


def affine(state, matrix):
    n = len(matrix)
    return numpy.abs(state["displacement"][:, :n] - state["X"][:, :n] @ numpy.array(matrix).T).max()


@pytest.mark.parametrize("order", [1, pytest.param(2, marks=pytest.mark.slow), 3, pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kinematics", ["small", "finite"])
@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
@pytest.mark.parametrize("pairing", list(PAIRINGS))
def test_patch_in_the_plane(run, pairing, nonmortar, kinematics, order):
    """A deformation that is the same everywhere, imposed on all sides but the tied ones: stretch and shear."""
    parameter, side = PAIRINGS[pairing]
    material = LINEAR if kinematics == "small" else RUBBER
    scene = blocks(nonmortar, {"lower": material, "upper": material}, {name: {"displacement": motion(H[:2, :2])} for name in SIDES}, parameter,
                   graded(side, 0.3, 1, 2) if side else None, {"kind": "tied"}, kinematics=kinematics, order=order)
    result = run("patch.yml", text=scene)
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H[:2, :2]), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


def box_scene(tmp_path, parts, pairs, order=1, kinematics="finite", near=None, to=lambda x: x, matrix=H, sides=None, **keys):
    """Boxes glued in pairs (nonmortar, mortar), every other face moved by the matrix."""
    boxes(tmp_path / "boxes.msh", parts, to)
    tied = {face for pair in pairs for face in pair}
    faces = sides or [f"{name}_{axis}{end}" for name in parts for axis in "xyz" for end in (0, 1) if f"{name}_{axis}{end}" not in tied]
    material = LINEAR if kinematics == "small" else RUBBER
    scene = {"mesh": {"file": str(tmp_path / "boxes.msh")}, "model": "3d", "kinematics": kinematics, "order": order,
             "body": {name: {"material": "bulk"} for name in parts}, "material": {"bulk": material},
             "boundary": {face: {"displacement": motion(matrix)} for face in faces},
             "contact": {f"glue{i}": {"nonmortar": one, "mortar": two, "roles": "given", "kind": "tied"} for i, (one, two) in enumerate(pairs)},
             "load": {"step": 1}, **keys}
    if near:
        scene["refine"] = near
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


TWO = {"lower": Box((0, 0, 0), (1, 1, 1), (2, 3, 2)), "upper": Box((0, 0, 1), (1, 1, 1), (3, 2, 1))}


@pytest.mark.parametrize("order", [1, 2, pytest.param(3, marks=pytest.mark.slow), pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.parametrize("hangs", [None, "upper_z0", "lower_z1"])
@pytest.mark.parametrize("nonmortar", [0, 1])
def test_patch_in_space(run, tmp_path, nonmortar, hangs, order):
    near = {"spot": {"boundary": hangs, "x": 0.1, "y": 0.2, "z": 1, "levels": 1}} if hangs else None
    pair = ("upper_z0", "lower_z1")[:: 1 - 2 * nonmortar]
    result = run("space.yml", text=box_scene(tmp_path, TWO, [pair], order, near=near))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


@pytest.mark.parametrize("order", [1, 2])
def test_sides_that_face_in_part(run, tmp_path, order):
    """A wide block on two others that end within its facets, which are glued to each other as well: pairs meet in an edge."""
    parts = {"top": Box((0, 0, 1), (1, 1, 1), (3, 2, 1)), "one": Box((0, 0, 0), (0.45, 1, 1), (2, 3, 2)), "two": Box((0.45, 0, 0), (0.55, 1, 1), (1, 1, 1))}
    pairs = [("top_z0", "one_z1"), ("top_z0", "two_z1"), ("one_x1", "two_x0")]
    result = run("parts.yml", text=box_scene(tmp_path, parts, pairs, order))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


@pytest.mark.parametrize("order", [1, 2])
def test_four_parts_meet(run, tmp_path, order):
    """Four bars around an edge, each glued to the next: no node of the edge may carry multipliers of every pair."""
    number = {"a": (2, 2, 2), "b": (3, 3, 2), "c": (1, 2, 3), "d": (2, 3, 3)}
    corner = {"a": (0, 0), "b": (1, 0), "c": (1, 1), "d": (0, 1)}
    parts = {name: Box((x, 0, z), (1, 1, 1), number[name]) for name, (x, z) in corner.items()}
    pairs = [("a_x1", "b_x0"), ("b_z1", "c_z0"), ("c_x0", "d_x1"), ("d_z0", "a_z1")]
    result = run("four.yml", text=box_scene(tmp_path, parts, pairs, order))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


def bent(x):
    """A quarter of a thick tube: height is the radius."""
    r, a = 2 + x[2], 0.5 * math.pi * x[0]
    return numpy.array([r * math.cos(a), r * math.sin(a), x[1]])


@pytest.mark.parametrize("gap", ["keep", "close"])
@pytest.mark.parametrize("order", [1, 2])
def test_rotation(run, tmp_path, order, gap):
    """A round interface between facets that do not match, turned by 90 degrees about a skew axis of space by one of its bodies: no stress if gaps are kept, and
    the same stresses, turned, where they were closed."""
    boxes(tmp_path / "boxes.msh", TWO, bent)
    turn = {"rotation": {"axis": "x", "angle": "90*t", "point": {"x": 1, "y": 2, "z": 3}}}
    scene = {"mesh": {"file": str(tmp_path / "boxes.msh")}, "model": "3d", "order": order,
             "body": {name: {"material": "bulk"} for name in TWO}, "material": {"bulk": RUBBER}, "boundary": {"lower_z0": turn},
             "contact": {"glue": {"nonmortar": "upper_z0", "mortar": "lower_z1", "kind": "tied", "initial_gap": gap}}, "load": {"step": 0.5}}
    result = run("turn.yml", text="\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n")
    assert result.returncode == 0, result
    print(result.history[-1]["energy"], result.history[-1]["moment_imbalance"], result.summary["newton_iterations"])
    assert "note: no support holds" not in result.stdout
    if gap == "keep":
        assert numpy.abs(bulk(result)["stress"]).max() < 1e-8 * 100
    else:
        assert result.history[0]["energy"] > 1e-6 and abs(result.history[-1]["energy"] / result.history[0]["energy"] - 1) < 1e-8
        assert max(result.history[-1]["moment_imbalance"], result.history[-1]["contact_imbalance"]) < 1e-9


TUBES = {"mesh": {"file": "inputs/shrinkfit.geo", "order": 2, "parameter": {"n": 4}}, "model": "plane_strain",
         "body": {"inner": {"material": "bulk"}, "outer": {"material": "bulk"}}, "material": {"bulk": RUBBER},
         "boundary": {"plane_x": {"fix": "x"}, "plane_y": {"fix": "y"}, "bore": {"pressure": 3}},
         "contact": {"glue": {"kind": "tied", "nonmortar": "inner_shell", "mortar": "outer_bore"}}, "load": {"step": 1}}


def tubes(**keys):
    scene = {**TUBES, **keys}
    scene["mesh"] = {**scene["mesh"], "file": str(ROOT / scene["mesh"]["file"])}
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


@pytest.mark.parametrize("order", [1, 2, 3])
def test_round_interface(run, order):
    """Two tubes glued at a radius under pressure, small strains: Lame's tube. Tractions across a round interface fall with the mesh like the solution."""
    small = {"kinematics": "small", "material": {"bulk": LINEAR}}
    result = run("tubes.yml", text=tubes(order=order, **small, adapt={"tolerance": 0.01 if order > 1 else 0.04}))
    assert result.returncode == 0, result
    a, b, p, E, nu = 5, 20, 3, 100, 0.3
    factor = (1 + nu) / E * p * a * a / (b * b - a * a)
    energy = 0.5 * p * factor * ((1 - 2 * nu) * a + b * b / a) * a * math.pi / 2
    stress = p * a * a / (b * b - a * a) * (b * b / 100 - 1)
    row = result.history[-1]
    print(row["energy"] / energy - 1, result.summary["contact"]["glue"]["max_traction"] / stress - 1, row["contact.glue.area"] / (5 * math.pi) - 1)
    assert abs(row["energy"] / energy - 1) < (0.01 if order == 1 else 3e-4)
    assert abs(result.summary["contact"]["glue"]["max_traction"] / stress - 1) < (0.1 if order == 1 else 0.02)


@pytest.mark.parametrize("order, ranks", [(1, 2), (2, 4), pytest.param(1, 4, marks=pytest.mark.slow), pytest.param(2, 2, marks=pytest.mark.slow)])
def test_parallel(run, order, ranks):
    """The same figures on 1 to 4 ranks, through an adaptation."""
    text = tubes(order=order, adapt={"tolerance": 0.05, "max_passes": 2})
    results = [run("tubes.yml", text=text, ranks=ranks) for ranks in (1, ranks)]
    for result in results:
        assert result.solved, result
        for key in ("energy", "contact.glue.force.x", "contact.glue.force.y", "contact.glue.max_traction", "estimated_error"):
            one, other = results[0].history[-1][key], result.history[-1][key]
            assert abs(one - other) <= 1e-8 * abs(one), (key, one, other)


@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
@pytest.mark.parametrize("order", [1, 2, pytest.param(3, marks=pytest.mark.slow)])
def test_patch_axisymmetric(run, nonmortar, order):
    """A solid cylinder of two parts that is drawn out: the same strains everywhere, on the axis too."""
    draw = {"x": "0.02*X", "y": "-0.05*Y"}
    scene = blocks(nonmortar, {"lower": RUBBER, "upper": RUBBER}, {name: {"displacement": draw} for name in ("right_lower", "right_upper", "bottom", "top")},
                   {"nl": 4, "nu": 3}, None, {"kind": "tied"}, order=order).replace("plane_strain", "axisymmetric")
    result = run("axi.yml", text=scene)
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, [[0.02, 0], [0, -0.05]]), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


def test_restart(run, tmp_path):
    """Stopped after one of two steps and gone on with, through an adaptation."""
    text = tubes(order=2, load={"step": 0.5}, adapt={"tolerance": 0.05, "max_passes": 2})
    whole = run("tubes.yml", text=text)
    half = run("tubes.yml", "-load_end", 0.5, text=text)
    assert whole.solved and half.solved, (whole, half)
    rest = run("tubes.yml", "-restart", half.directory / "checkpoint.h5", text=text)
    assert rest.solved, rest
    one, other = whole.history[-1], rest.history[-1]
    assert all(abs(one[key] - other[key]) <= 1e-9 * abs(one[key]) for key in ("energy", "contact.glue.force.x", "contact.glue.max_traction")), (one, other)


@pytest.mark.parametrize("options", [["-solve_linear", "iterative"], ["-solve_symmetric", "0"], ["-solve_condense", "yes"], ["-solve_factor", "single"]])
def test_linear_systems(run, tmp_path, options):
    """Each way to solve them gives the same."""
    text = box_scene(tmp_path, TWO, [("upper_z0", "lower_z1")], 2, matrix=H, sides=["lower_z0", "upper_z1"])
    one, other = run("space.yml", text=text), run("space.yml", *options, text=text)
    assert one.returncode == 0 and other.returncode == 0, (one, other)
    a, b = one.history[-1], other.history[-1]
    assert abs(a["energy"] - b["energy"]) <= 1e-9 * a["energy"] and abs(a["contact.glue0.force.z"] - b["contact.glue0.force.z"]) <= 1e-8 * abs(a["contact.glue0.force.z"])


@pytest.mark.parametrize("order", [1, 2])
def test_tangent(run, tmp_path, order):
    """The exact derivative of the residual: a gap over a bent interface of space turns with it, and has second derivatives."""
    text = box_scene(tmp_path, TWO, [("upper_z0", "lower_z1")], order, to=bent, sides=["lower_z0", "upper_z1"], matrix=2 * H)
    result = run("tangent.yml", "-snes_test_jacobian", text=text)
    assert result.returncode == 0, result
    error = [float(e) for e in re.findall(r"J - Jfd\|\|_F/\|\|J\|\|_F = (\S+),", result.stdout)]
    print(error)
    assert len(error) > 2 and max(error) < 1e-6, error


FAN = """// Two blocks on each other between walls x = a y and x = b y.
Macro Side
  Point(k) = {a * y, y, 0}; Point(k + 1) = {b * y, y, 0};
  Line(k) = {k, k + 1}; Transfinite Curve {k} = n + 1;
Return
k = 1; y = 1; n = 3;
Call Side;
k = 3; y = 2;
Call Side;
k = 5; n = 2;
Call Side;
k = 7; y = 3;
Call Side;
Line(11) = {1, 3};  Line(12) = {2, 4};  Line(13) = {5, 7};  Line(14) = {6, 8};
Transfinite Curve {11, 12, 13, 14} = 2;
Curve Loop(1) = {1, 12, -3, -11};  Plane Surface(1) = {1};  Curve Loop(2) = {5, 14, -7, -13};  Plane Surface(2) = {2};
Transfinite Surface {1, 2};  Recombine Surface {1, 2};
Physical Surface("lower") = {1};  Physical Surface("upper") = {2};
Physical Curve("bottom") = {1};  Physical Curve("lower_top") = {3};  Physical Curve("upper_bottom") = {5};  Physical Curve("top") = {7};
Physical Curve("left_lower") = {11};  Physical Curve("right_lower") = {12};  Physical Curve("left_upper") = {13};  Physical Curve("right_upper") = {14};
"""


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
@pytest.mark.parametrize("model", ["plane_strain", "axisymmetric"])
def test_patch_between_oblique_walls(run, tmp_path, model, nonmortar, order):
    """Blocks that grow about the point where two walls meet at an angle slide along both: the ends of the joint have no multiplier across their own wall."""
    (tmp_path / "fan.geo").write_text(f"a = {0.2 if model == 'axisymmetric' else -0.5};\nb = 1;\n" + FAN)
    ends = {name: {"displacement": motion(0.05 * numpy.eye(2))} for name in ("bottom", "top")}
    scene = blocks(nonmortar, {"lower": RUBBER, "upper": RUBBER}, {**{name: {"fix": "normal"} for name in SIDES[:4]}, **ends}, {}, None, {"kind": "tied"}, order=order)
    mesh = yaml({"file": str(tmp_path / "fan.geo"), "order": 1})
    result = run("fan.yml", text=re.sub("mesh: .*", f"mesh: {mesh}", scene).replace("plane_strain", model))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, 0.05 * numpy.eye(2)), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


def figures(result):
    """Those that a rotation of the whole scene leaves alone."""
    assert result.returncode == 0, result
    row = result.history[-1]
    vectors = [key[:-2] for key in row if key.startswith(("reaction.", "contact.")) and key.endswith(".x") and ".moment" not in key]
    forces = [math.hypot(*(row.get(f"{key}.{axis}", 0) for axis in "xyz")) for key in vectors]
    return numpy.array([row["energy"], row["estimated_error"], *(pair["max_traction"] for pair in result.summary["contact"].values()), *forces])


@pytest.mark.parametrize("order, ranks", [(1, 1), (1, 2), (2, 1), (3, 3)])
@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
def test_turned_in_the_plane(run, nonmortar, order, ranks):
    """Blocks pressed between walls, the upper one not as wide, along the axes of the coordinates and turned by 30 degrees: the same."""
    def turned(angle, ranks):
        sides = {**{name: {"fix": "normal"} for name in SIDES[:5]}, "top": {"pressure": 10}}
        return figures(run("turned.yml", text=blocks(nonmortar, {"lower": RUBBER, "upper": RUBBER}, sides, {"nl": 4, "nu": 3, "wu": 0.8, "angle": angle}, None,
                                                     {"kind": "tied"}, order=order), ranks=ranks))

    one, other = turned(0, 1), turned(30, ranks)
    print(one, numpy.abs(other / one - 1))
    assert numpy.abs(other / one - 1).max() < 1e-10


def between_walls(tmp_path, pair, to, boundary, order, turn=numpy.eye(3), parts=TWO, **keys):
    """Boxes whose sides lie along flat walls, turned."""
    walls = {f"{name}_{side}": {"fix": "normal"} for name in parts for side in ("x0", "x1", "y0", "y1")}
    boxes(tmp_path / "boxes.msh", parts, lambda x: turn @ to(x))
    scene = {"mesh": {"file": str(tmp_path / "boxes.msh")}, "model": "3d", "order": order, "body": {name: {"material": "bulk"} for name in parts},
             "material": {"bulk": RUBBER}, "boundary": {name: side for name, side in {**walls, **boundary}.items() if side},
             "contact": {"glue": {"nonmortar": pair[0], "mortar": pair[1], "roles": "given", "kind": "tied"}}, "load": {"step": 1}, **keys}
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


def pyramid(x):
    return numpy.array([(x[0] - 0.5) * (1 + x[2]), 1.4 * (x[1] - 0.5) * (1 + x[2]), 1 + x[2]])


WAYS = [("upper_z0", "lower_z1"), ("lower_z1", "upper_z0")]


@pytest.mark.parametrize("order, hangs", [(1, False), (1, True), (2, False)])
@pytest.mark.parametrize("pair", WAYS)
def test_patch_in_a_pyramid(run, tmp_path, pair, order, hangs):
    """Four walls that meet in a point, none at right angles to another: corners of the joint are held by two."""
    near = {"refine": {"spot": {"boundary": pair[0], "x": -0.9, "y": -1.3, "z": 2, "levels": 1}}} if hangs else {}
    ends = {name: {"displacement": motion(0.05 * numpy.eye(3))} for name in ("lower_z0", "upper_z1")}
    result = run("pyramid.yml", text=between_walls(tmp_path, pair, pyramid, ends, order, **near))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, 0.05 * numpy.eye(3)), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error


def test_patch_of_three_in_a_pyramid(run, tmp_path):
    """Nodes where pairs meet, which carry nothing, beside nodes on walls that are not at right angles."""
    parts = {"top": Box((0, 0, 1), (1, 1, 1), (3, 2, 1)), "one": Box((0, 0, 0), (0.45, 1, 1), (2, 3, 2)), "two": Box((0.45, 0, 0), (0.55, 1, 1), (1, 1, 1))}
    sides = {name: {"displacement": motion(0.05 * numpy.eye(3))} for name in ("top_z1", "one_z0", "two_z0")}
    pairs = [("one_z1", "top_z0"), ("two_z1", "top_z0"), ("two_x0", "one_x1")]
    glue = {"contact": {f"glue{i}": {"nonmortar": one, "mortar": two, "roles": "given", "kind": "tied"} for i, (one, two) in enumerate(pairs)}}
    text = between_walls(tmp_path, pairs[0], pyramid, {**sides, "one_x1": None, "two_x0": None}, 2, parts=parts, **glue)
    result = run("three.yml", text=text)
    assert result.returncode == 0, result
    error = affine(bulk(result), 0.05 * numpy.eye(3))
    print(error)
    assert error < 1e-9, error


NARROW = {"lower": Box((0, 0, 0), (1, 1, 1), (2, 2, 1)), "upper": Box((0, 0, 1), (0.7, 1, 1), (2, 1, 1))}
a, b = math.radians(40), math.radians(25)
SKEW = numpy.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]]) @ [[math.cos(b), -math.sin(b), 0], [math.sin(b), math.cos(b), 0], [0, 0, 1]]


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("pair", WAYS)
def test_turned_in_space(run, tmp_path, pair, order):
    """The same in space, with three walls and a side that ends within facets."""
    def turned(turn):
        traction = {"traction": dict(zip("xyz", map(float, turn @ [1, 2, -6])))}
        text = between_walls(tmp_path, pair, lambda x: x, {"lower_x1": None, "upper_x1": None, "lower_z0": {"fix": "normal"}, "upper_z1": traction}, order, turn, NARROW)
        return figures(run("turned.yml", text=text))

    one, other = turned(numpy.eye(3)), turned(SKEW)
    print(one, numpy.abs(other / one - 1))
    assert numpy.abs(other / one - 1).max() < 1e-10


@pytest.mark.parametrize("options", [[], ["-solve_symmetric", "0"]])
def test_tangent_at_oblique_walls(run, tmp_path, options):
    """Gaps over a bent interface, a side that ends within facets and nodes that are held across the axes: the derivative is exact."""
    def bulged(x):
        return pyramid(x) * (1 + (0.04 * math.sin(4 * x[0] + 3 * x[1]) if x[2] == 1 else 0))

    ends = {"lower_x1": None, "upper_x1": None, "lower_z0": {"fix": "xyz"}, "upper_z1": {"traction": {"x": 3, "y": 4, "z": -3}}}
    result = run("tangent.yml", "-snes_test_jacobian", *options, text=between_walls(tmp_path, WAYS[1], bulged, ends, 1, SKEW, NARROW))
    assert result.returncode == 0, result
    error = [float(e) for e in re.findall(r"J - Jfd\|\|_F/\|\|J\|\|_F = (\S+),", result.stdout)]
    print(error)
    assert len(error) > 2 and max(error) < 1e-6, error


def glued(pair=None, boundary=None, **keys):
    boundary = boundary or {"bottom": {"fix": "xy"}, "top": {"displacement": {"x": 0.1, "y": -0.1}}}
    return blocks("upper", {"lower": RUBBER, "upper": RUBBER}, boundary, {"nl": 4, "nu": 3}, None, {"kind": "tied", **(pair or {})}, **keys)


@pytest.mark.parametrize("pair, words", [
    ({"friction": 0.2}, "contact.pair.friction"), ({"interference": 0.1}, "contact.pair.interference"), ({"law": "penalty", "penalty": 10}, "contact.pair.law"),
    ({"node_to_segment": True}, "contact.pair.node_to_segment"), ({"initial_gap": "adjust"}, "allowed here: keep|close"),
    ({"initial_gap": "ramp"}, "allowed here: keep|close"), ({"kind": "contact", "initial_gap": "close"}, "allowed here: keep|adjust|ramp"),
    ({"kind": "contact", "law": "tied"}, "set kind: tied instead"), ({"kind": "glued"}, "contact|tied")])
def test_bad_input(run, pair, words):
    result = run("bad.yml", text=glued(pair).replace("kind: tied, kind: ", "kind: "))
    assert result.returncode == 1 and words in result.stderr and len(result.stderr.strip().splitlines()) == 1, result


def test_sides_that_do_not_meet(run):
    result = run("apart.yml", text=glued().replace("nu: 3}", "nu: 3, xu: 3}"))
    assert result.returncode == 1 and "nothing of one side faces the other" in result.stderr, result


def test_nothing_holds_them(run):
    result = run("loose.yml", text=glued(boundary={"top": {"pressure": 0.1}}))
    assert result.returncode == 1 and "nothing holds body" in result.stderr, result


def test_prescribed_side(run):
    """It becomes the mortar side; not where supports hold the other one along its normal, too: what may slide there cannot be tied to it."""
    sides = ("-contact_pair_nonmortar", "lower_top", "-contact_pair_mortar", "upper_bottom")
    text = glued(boundary={"bottom": {"fix": "xy"}, "upper_bottom": {"displacement": {"x": 0.1, "y": -0.1}}})
    result, swapped = run("held.yml", text=text), run("held.yml", *sides, text=text)
    assert result.returncode == swapped.returncode == 0 and "is held by supports and becomes the mortar side" in result.stdout, result
    assert result.summary["reaction"]["bottom"] == pytest.approx(swapped.summary["reaction"]["bottom"], rel=1e-9) and result.summary["reaction"]["bottom"][1] > 0.01
    both = glued(boundary={"bottom": {"fix": "xy"}, "lower_top": {"fix": "y"}, "upper_bottom": {"displacement": {"x": 0.1, "y": -0.1}}})
    result = run("held.yml", text=both)
    assert result.returncode == 1 and "exchange nonmortar and mortar" in result.stderr, result


@pytest.mark.parametrize("order", [1, 2, 4])
def test_side_that_ends_in_a_facet(run, order):
    """The end of the upper block goes over a node of the lower side: slivers of facets change neither the solution nor the tractions at a jump."""
    def figures(beyond):
        scene = blocks("lower", {"lower": LINEAR, "upper": LINEAR}, {"bottom": {"fix": "xy"}, "top": {"displacement": {"x": 0.01, "y": 0.01}}},
                       {"nl": 4, "nu": 3, "xu": 0.25 - beyond, "wu": 0.5 + 2 * beyond}, None, {"kind": "tied"}, order=order, kinematics="small")
        result = run("end.yml", text=scene)
        assert result.returncode == 0, result
        return result.summary["energy"], result.summary["contact"]["pair"]["max_traction"], result.summary["estimated_error"]

    one = figures(0)
    for beyond in (-1e-6, 1e-6, 1e-4, 1e-3):
        energy, traction, error = figures(beyond)
        print(beyond, energy / one[0] - 1, traction / one[1] - 1, error / one[2] - 1)
        assert abs(energy / one[0] - 1) < 10 * abs(beyond) and abs(traction / one[1] - 1) < 100 * abs(beyond) and abs(error / one[2] - 1) < 0.05


def falls(result, least):
    """Adaptation reaches its tolerance, and from the mesh number `least` on no mesh has more than twice the estimate of the one before."""
    errors = [row["estimated_error"] for row in result.adapt]
    print(errors)
    assert result.returncode == 0, result
    assert all(b < 2 * a for a, b in zip(errors[least:], errors[least + 1:])), errors


@pytest.mark.parametrize("order", [pytest.param(1, marks=pytest.mark.slow), 2, 3, 4])
def test_adapted_where_a_side_ends(run, order):
    """A stiff block ends within facets of the one it is glued to, at a singular corner: tractions do not oscillate, and the estimate is that of the mesh."""
    def energy(tolerance, nu):
        scene = blocks("lower", {"lower": LINEAR, "upper": {**LINEAR, "E": 1000}}, {"bottom": {"fix": "xy"}, "top": {"displacement": {"x": 0.01, "y": 0.01}}},
                       {"nl": 4, "nu": nu, "xu": 0.3, "wu": 0.5}, None, {"kind": "tied"}, order=order, kinematics="small", adapt={"tolerance": tolerance, "max_passes": 15})
        result = run("end.yml", text=scene)
        falls(result, 2)
        return result.summary["energy"]

    coarse = energy(0.03, 3)
    assert abs(coarse / energy(0.015, 4) - 1) < 0.03**2


@pytest.mark.parametrize("order", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_adapted_where_a_side_ends_in_space(run, tmp_path, order):
    parts = {"left": Box((0, 0, 0), (1, 1, 1), (2, 2, 2)), "right": Box((1, 0.3, 0), (1, 1, 1), (3, 3, 2))}
    text = box_scene(tmp_path, parts, [("right_x0", "left_x1")], order, kinematics="small", sides=["left_x0", "right_x1"], matrix=0.1 * numpy.eye(3), adapt={"tolerance": 0.12})
    falls(run("end.yml", text=text), 2)


@pytest.mark.parametrize("order, ranks", [(1, 1), pytest.param(2, 1, marks=pytest.mark.slow), (2, 2)])
def test_lshape(run, order, ranks):
    """Glued across the line that ends in the singular corner, on meshes that do not match: adapted, the energy of the mesh that conforms, no lower a
    rate, and about its error at equal unknowns (both begin on meshes of their own)."""
    def adapted(scene):
        result = run(scene, "-order", order, "-adapt_tolerance", 0.02, ranks=ranks)
        assert result.returncode == 0, result
        rows = [row for row in result.adapt if row["dofs"] > 500]
        return result.history[-1]["energy"], numpy.polyfit(numpy.log([row["dofs"] for row in rows]), numpy.log([row["estimate"] for row in rows]), 1)

    energy, (slope, at) = adapted("inputs/tied_lshape.yml")
    conforming, (other, level) = adapted("inputs/lshape.yml")
    middle = math.log(5000 if order == 1 else 1200)
    print(energy / 2.0545124437e-5, energy / conforming - 1, slope, other, math.exp(slope * middle + at - other * middle - level))
    assert abs(energy / conforming - 1) < 1e-3 and slope < 0.99 * other and math.exp(slope * middle + at - other * middle - level) < 1.1


@pytest.mark.slow
@pytest.mark.parametrize("order, tolerance, least", [(1, 0.005, 3000), (2, 0.0006, 10000)])
def test_lshape_rates(run, order, tolerance, least):
    """On many meshes, of more unknowns than where rates still rise: the error in energy falls at the rate of the mesh that conforms, which is the best one."""
    def rate(scene):
        result = run(scene, "-order", order, "-adapt_tolerance", tolerance, "-adapt_max_passes", 30, "-output_fields", "false")
        assert result.solved, result  # order 1 ends at the largest number of cells
        rows = [row for row in result.adapt if row["dofs"] > least]
        error = [math.sqrt(2 * abs(row["energy"] - 2.0545124437e-4)) for row in rows]
        return result.history[-1]["energy"], numpy.polyfit(numpy.log([row["dofs"] for row in rows]), numpy.log(error), 1)[0], len(rows)

    tied, conforming = rate("inputs/tied_lshape.yml"), rate("inputs/lshape.yml")
    print(tied, conforming)
    assert min(tied[2], conforming[2]) >= 5 and abs(tied[0] / conforming[0] - 1) < 1e-4
    assert abs(tied[1] / conforming[1] - 1) < 0.01 and abs(tied[1] / (-order / 2) - 1) < 0.01


def test_with_contact(run, tmp_path):
    """A body that is glued to another touches a third one."""
    boxed = {"low": Box((0, 0, 0), (1, 1, 1), (3, 1, 2)), "mid": Box((0.2, 0, 1), (0.6, 1, 0.5), (2, 1, 2)), "top": Box((0.2, 0, 1.5), (0.6, 1, 0.5), (3, 1, 1))}
    boxes(tmp_path / "three.msh", boxed)
    scene = {"mesh": {"file": str(tmp_path / "three.msh")}, "model": "3d", "body": {name: {"material": "bulk"} for name in boxed}, "material": {"bulk": RUBBER},
             "boundary": {"low_z0": {"fix": "xyz"}, "top_z1": {"displacement": {"x": 0.05, "y": 0, "z": -0.05}}},
             "contact": {"glue": {"nonmortar": "mid_z1", "mortar": "top_z0", "kind": "tied"}, "touch": {"nonmortar": "mid_z0", "mortar": "low_z1"}},
             "load": {"step": 0.5}}
    result = run("three.yml", text="\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n")
    assert result.returncode == 0, result
    pair = result.summary["contact"]
    print(pair["glue"]["force"], pair["touch"]["force"], result.history[-1]["support_imbalance"])
    assert numpy.abs(numpy.add(pair["glue"]["force"], pair["touch"]["force"])).max() < 1e-9 * numpy.abs(pair["touch"]["force"]).max()
    assert "active_nodes" not in pair["glue"] and result.history[-1]["active_nodes"] == pair["touch"]["active_nodes"] > 0


@pytest.mark.parametrize("scene, pressures, options", [("tied_wall", (0.22138176452, 0.20242786812), ("-order", "1")), ("tied_wall", (0.22138176452, 0.20242786812), ("-order", "2")),
                                                      ("tied_wall3d", (0.26834998908, 0.24278813789), ("-order", "1")), ("tied_wall3d", (0.26834998908, 0.24278813789), ("-order", "2"))])
def test_at_a_wall(run, scene, pressures, options):
    """Two glued blocks between walls: at the corners of the joint the gaps of both and the glue are more constraints than motions. Pressures of the closed form at all nodes."""
    result = run(f"tests/gauntlet/{scene}.yml", *options)
    assert result.returncode == 0, result
    print(result.summary["estimated_error"], [result.summary["contact"][name]["max_pressure"] for name in "ab"], result.summary["active_set_cycles"])
    for name, value in zip("ab", pressures):
        assert abs(result.summary["contact"][name]["max_pressure"] / value - 1) < 1e-6
    assert result.summary["estimated_error"] < 1e-6 and result.summary["active_set_cycles"] == 0 and result.summary["step_cuts"] == 0
