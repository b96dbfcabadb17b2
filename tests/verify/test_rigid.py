"""Rigid bodies that turn (body.<name>.motion.rotation), supports that turn and move, and moments of supports, contact forces and rigid bodies."""
import json
import math

import numpy
import pytest

from boxmesh import linspace, write
from test_input import refused

GAP = 0.01
ELASTIC = {"law": "neo_hookean", "E": 1, "nu": 0.3}


def solve(run, scene, *options, **keywords):
    result = run("scene.yml", *options, text=json.dumps(scene), **keywords)
    assert result.returncode == 0, result
    return result


def pressed(tmp_path, dim=2, cells=2, tool=ELASTIC):
    """A tool 0.6 wide and 0.4 high over a strip [-1, 1] x [0, 1], a gap between them."""
    def strip(x, y, *z):
        return (2 * x - 1, y, *z)

    def punch(x, y, *z):
        return (0.6 * x - 0.2, 1 + GAP + 0.4 * y, *(0.1 + 0.6 * c for c in z))

    name = ("strip", "tool")
    mesh = write(tmp_path / f"pressed{dim}.msh", [linspace(0, 1, cells + 1)] + [linspace(0, 1, cells)] * (dim - 1), [strip, punch],
                 side=lambda side, centre, block: f"{name[block]}_{side}", body=lambda centre, block: name[block])
    return {"mesh": {"file": str(mesh)}, "model": "plane_strain" if dim == 2 else "3d", "order": 2,
            "body": {"strip": {"material": "elastic"}, "tool": {"material": "tool"}}, "material": {"elastic": ELASTIC, "tool": tool},
            "boundary": {"strip_y0": {"fix": "xyz"[:dim]}}, "contact": {"c": {"nonmortar": "strip_y1", "mortar": "tool_y0", "roles": "given"}},
            "load": {"step": 1}}


def turned(angle, x=(0, 0), about=(0, 0)):
    """Displacement {x, y} by a rotation by an expression of t, in degrees, and a translation after it."""
    cosine, sine = f"cos(({angle})*pi/180)", f"sin(({angle})*pi/180)"
    a, b = f"(X-({about[0]!r}))", f"(Y-({about[1]!r}))"
    return {"x": f"{cosine}*{a}-{sine}*{b}-{a}+({x[0]})", "y": f"{sine}*{a}+{cosine}*{b}-{b}+({x[1]})"}


def every(tool, dim):
    return {f"tool_{axis}{k}": tool for axis in "xyz"[:dim] for k in (0, 1)}


def cross(x, f):
    return x[0] * f[1] - x[1] * f[0]


def contact(result):
    return result.summary["contact"]["c"]


# ---- motion ---------------------------------------------------------------------------------------------------------------------------

ABOUT = (0.1, 1.3)


@pytest.mark.parametrize("order, steps", [(1, 1), (2, 1), (2, 4)])
def test_turned_block_is_the_motion_given_point_by_point(run, tmp_path, order, steps):
    """A rigid block pressed into a strip and turned, and one that deforms but all of whose points are told where to go: a cell of order 1 has no others."""
    angle, way = "12*t", ("0.05*t", "-0.1*t")
    scene = pressed(tmp_path, cells=1, tool={"law": "rigid"})
    scene["order"], scene["load"]["step"] = order, 1 / steps
    scene["body"]["tool"] |= {"order": 1, "motion": {"x": way[0], "y": way[1], "rotation": {"angle": angle, "point": {"x": ABOUT[0], "y": ABOUT[1]}}}}
    told = json.loads(json.dumps(scene))
    told["body"]["tool"] = {"material": "tool", "order": 1}
    told["material"]["tool"] = ELASTIC
    told["boundary"] |= every({"displacement": turned(angle, way, ABOUT)}, 2)
    # the mesh has two cells along each block; the points between them are on its outline, too
    rigid, other = solve(run, scene), solve(run, told)
    for key in ("force", "moment", "mortar_force", "mortar_moment", "max_pressure"):
        assert contact(rigid)[key] == pytest.approx(contact(other)[key], rel=1e-9, abs=1e-11), key
    assert contact(rigid)["max_pressure"] > 0.01
    body = rigid.summary["body"]["tool"]
    assert body["force"] == pytest.approx(contact(rigid)["mortar_force"], abs=1e-12)


def roller(tmp_path, around=32):
    """A ring of facets of order 2 over a strip."""
    def disc(x, y, *_):
        return ((0.3 + 0.2 * y) * math.sin(-2 * math.pi * x), 1.5 + GAP + (0.3 + 0.2 * y) * math.cos(2 * math.pi * x))

    def strip(x, y, *_):
        return (2 * x - 1, y)

    name = ("strip", "disc")
    mesh = write(tmp_path / "roller.msh", [linspace(0, 1, around), linspace(0, 1, 2)], [strip, disc], 2,
                 side=lambda side, centre, block: f"{name[block]}_{side}" if side[0] == "y" or not block else None, body=lambda centre, block: name[block])
    return {"mesh": {"file": str(mesh)}, "model": "plane_strain", "order": 2, "body": {"strip": {"material": "elastic"}, "disc": {"material": "tool"}},
            "material": {"elastic": ELASTIC, "tool": {"law": "rigid"}}, "boundary": {"strip_y0": {"fix": "xy"}},
            "contact": {"c": {"nonmortar": "strip_y1", "mortar": "disc_y1"}}, "load": {"end": 2, "step": 1}}


def test_moments_of_contact_are_about_the_body(run, tmp_path):
    """Without moment_about: about the centre of the body of the side that the scene calls nonmortar, on both sides, whoever carries the multiplier."""
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene["body"]["tool"]["motion"] = {"x": "0.02*t", "y": "-0.1*t", "rotation": {"angle": "5*t"}}
    centre = {"strip": (0, 0.5), "tool": (0.1, 1 + GAP + 0.2)}
    sides = scene["contact"]["c"]["nonmortar"], scene["contact"]["c"]["mortar"]
    for first, other in (sides, sides[::-1]):
        scene["contact"]["c"] |= {"nonmortar": first, "mortar": other}
        scene["contact"]["c"].pop("moment_about", None)
        default = contact(solve(run, scene))
        scene["point"] = {"middle": dict(zip("xy", centre[first.split("_")[0]]))}
        scene["contact"]["c"]["moment_about"] = "middle"
        named = contact(solve(run, scene))
        size = numpy.abs(named["force"]).max()
        assert default["moment"] == pytest.approx(named["moment"], abs=1e-9 * size) and abs(default["moment"][0]) > 1e-3 * size
        assert default["mortar_moment"] == pytest.approx(named["mortar_moment"], abs=1e-9 * size)


@pytest.mark.parametrize("angle, tolerance", [(360 / 32, 1e-9), (90, 1e-9), (17, 1e-3)])
def test_roller_turned_about_its_centre_changes_nothing(run, tmp_path, angle, tolerance):
    """Turned by whole facets the disc is what it was; in between it is so as far as curved facets are a circle."""
    scene = roller(tmp_path)
    scene["body"]["disc"]["motion"] = {"y": "-0.1*min(t,1)", "rotation": {"angle": f"{angle}*max(t-1,0)"}}
    before, after = solve(run, scene).history
    for column in ("contact.c.force.y", "contact.c.max_pressure", "contact.c.area", "energy", "reaction.strip_y0.y"):
        assert after[column] == pytest.approx(before[column], rel=tolerance), column
    assert abs(after["contact.c.force.x"]) < tolerance * abs(after["contact.c.force.y"])
    assert abs(after["body.disc.moment"]) < 10 * tolerance * abs(after["contact.c.force.y"])


@pytest.mark.parametrize("rigid", [True, False])
def test_all_turned_together(run, tmp_path, rigid):
    """Pressed, then turned as a whole by 360 degrees, looked at every quarter: forces turn with the bodies, moments about the axis stay. Supports turn and move at once."""
    angle, turn = 90, "90*max(t-1,0)"
    down = [f"0.1*min(t,1)*sin({turn}*pi/180)", f"-0.1*min(t,1)*cos({turn}*pi/180)"]
    scene = pressed(tmp_path, tool={"law": "rigid"} if rigid else ELASTIC)
    point = {"x": ABOUT[0], "y": ABOUT[1]}
    scene["point"] = {"axle": point}
    scene["load"] = {"end": 5, "step": 1}
    scene["boundary"] = {"strip_y0": {"rotation": {"angle": turn, "point": point}, "moment_about": "axle"}}
    scene["contact"]["c"]["moment_about"] = "axle"
    tool = {"rotation": {"angle": turn, "point": point}}
    if rigid:
        scene["body"]["tool"] |= {"motion": {"x": down[0], "y": down[1], **tool}, "moment_about": "axle"}
    else:
        scene["boundary"]["tool_y1"] = {"displacement": {"x": down[0], "y": down[1]}, "moment_about": "axle", **tool}
    scene["load"]["step"] = 0.25
    rows = [row for row in solve(run, scene).history if row["t"] % 1 == 0]
    first = rows[0]
    size = abs(first["contact.c.force.y"])
    assert size > 0.01 and len(rows) == 5
    for k, row in enumerate(rows):
        cosine, sine = round(math.cos(math.radians(angle * k))), round(math.sin(math.radians(angle * k)))
        for name in ("contact.c.force", "reaction.strip_y0"):
            expected = [cosine * first[name + ".x"] - sine * first[name + ".y"], sine * first[name + ".x"] + cosine * first[name + ".y"]]
            assert [row[name + ".x"], row[name + ".y"]] == pytest.approx(expected, abs=1e-9 * size)
        assert row["contact.c.moment"] == pytest.approx(first["contact.c.moment"], abs=1e-9 * size)
        assert row["energy"] == pytest.approx(first["energy"], rel=1e-9)
        assert row["reaction.strip_y0.moment"] == pytest.approx(-row["contact.c.moment"], abs=1e-9 * size)  # of the strip
        if not rigid:
            assert row["reaction.tool_y1.moment"] == pytest.approx(row["contact.c.moment"], abs=1e-9 * size)  # of the tool


def test_support_that_turns_and_moves(run, tmp_path):
    """Rotation and displacement of one boundary: the same as both written as displacements; the displacement may depend on the place."""
    scene = pressed(tmp_path)
    both = {"rotation": {"angle": "20*t", "point": {"x": 0.1, "y": 1.4}}, "displacement": {"x": "0.02*t", "y": "-0.1*t+0.01*X*t"}}
    written = {"displacement": turned("20*t", ("0.02*t", "-0.1*t+0.01*X*t"), (0.1, 1.4))}
    results = []
    for tool in (both, written):
        scene["boundary"]["tool_y1"] = tool
        results.append(solve(run, scene).summary)
    for key in ("reaction", "reaction_moment"):
        for name, values in results[0][key].items():
            assert values == pytest.approx(results[1][key][name], abs=1e-11), name


@pytest.mark.parametrize("axis", "xyz")
def test_space(run, tmp_path, axis):
    """All turned together about any axis in space: pressed, then turned by 90 degrees."""
    turn = "90*max(t-1,0)"
    point = {"x": 0.2, "y": -0.3, "z": 0.4}
    i, j = [("y", "z"), ("z", "x"), ("x", "y")]["xyz".index(axis)]
    scene = pressed(tmp_path, 3, 1, {"law": "rigid"})
    scene |= {"order": 1, "point": {"axle": point}, "load": {"end": 2, "step": 1}}
    rotation = {"axis": axis, "angle": turn, "point": point}
    scene["boundary"] = {"strip_y0": {"rotation": rotation, "moment_about": "axle"}}
    scene["contact"]["c"]["moment_about"] = "axle"
    down = {"y": "-0.1*min(t,1)"} if axis == "y" else \
        {i: f"0.1*min(t,1)*sin({turn}*pi/180)", j: f"-0.1*min(t,1)*cos({turn}*pi/180)"} if axis == "z" else \
        {i: f"-0.1*min(t,1)*cos({turn}*pi/180)", j: f"-0.1*min(t,1)*sin({turn}*pi/180)"}
    scene["body"]["tool"] |= {"motion": {**down, "rotation": rotation}, "moment_about": "axle"}
    before, after = (row for row in solve(run, scene).history if row["t"] in (1, 2))
    size = math.hypot(*(before[f"contact.c.force.{a}"] for a in "xyz"))
    for name in ("contact.c.force", "contact.c.moment", "reaction.strip_y0", "reaction.strip_y0.moment"):
        assert after[f"{name}.{i}"] == pytest.approx(-before[f"{name}.{j}"], abs=1e-9 * size), name
        assert after[f"{name}.{j}"] == pytest.approx(before[f"{name}.{i}"], abs=1e-9 * size), name
        assert after[f"{name}.{axis}"] == pytest.approx(before[f"{name}.{axis}"], abs=1e-9 * size), name
    for a in "xyz":
        assert after[f"reaction.strip_y0.moment.{a}"] == pytest.approx(-after[f"contact.c.moment.{a}"], abs=1e-9 * size)


# ---- moments ----------------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("order", [1, 2, 3])
def test_moment_of_a_support_is_that_of_statics(run, tmp_path, order):
    """A column, small displacements, sheared by a dead traction 0.3: its foot's moment is force times arm, about the centre or a point given."""
    mesh = write(tmp_path / "column.msh", [linspace(0, 1, 2), linspace(0, 3, 4)])
    scene = {"mesh": {"file": str(mesh)}, "model": "plane_strain", "order": order, "kinematics": "small", "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "linear", "E": 10, "nu": 0.3}}, "boundary": {"y0": {"fix": "xy"}, "y1": {"traction": {"x": 0.3}}}, "load": {"step": 1}}
    summary = solve(run, scene).summary
    assert summary["reaction"]["y0"] == pytest.approx([-0.3, 0], abs=1e-10)
    assert summary["reaction_moment"]["y0"] == pytest.approx([0.3 * 1.5], abs=1e-9)  # about the centre (0.5, 1.5): the load's is -0.45
    scene["point"] = {"foot": {"x": 7, "y": -1}}
    scene["boundary"]["y0"]["moment_about"] = "foot"
    result = solve(run, scene)
    assert result.summary["reaction_moment"]["y0"] == pytest.approx([0.3 * 4], abs=1e-9)
    assert result.history[-1]["reaction.y0.moment"] == pytest.approx(0.3 * 4, abs=1e-9)


@pytest.mark.parametrize("dim, ranks, options", [(2, 1, ()), (2, 3, ("-refine_spot_boundary", "strip_y1", "-refine_spot_x", "0.1", "-refine_spot_y", "1")), (3, 1, ()), (3, 2, ())])
def test_moments_balance(run, tmp_path, dim, ranks, options):
    """A rigid tool tilted into a strip: contact, tool and foot exert moments that differ by the arms of their forces; hanging nodes and ranks change nothing."""
    scene = pressed(tmp_path, dim, 1, {"law": "rigid"})
    scene["point"] = {"p": {"x": 0.4, "y": -0.7, **({"z": 0.3} if dim == 3 else {})}}
    scene["boundary"]["strip_y0"]["moment_about"] = "p"
    scene["contact"]["c"]["moment_about"] = "p"
    scene["body"]["tool"]["motion"] = {"y": "-0.08*t", "rotation": {"angle": "3*t"}}
    summary = solve(run, scene, *options, ranks=ranks).summary
    c, body = summary["contact"]["c"], summary["body"]["tool"]
    size = numpy.linalg.norm(c["force"])
    foot = summary["reaction_moment"]["strip_y0"]
    assert len(foot) == len(c["moment"]) == (1 if dim == 2 else 3)
    assert numpy.add(c["moment"], foot) == pytest.approx(0, abs=1e-9 * size)  # what the strip feels
    assert numpy.add(c["moment"], c["mortar_moment"]) == pytest.approx(0, abs=1e-9 * size)
    assert body["force"] == pytest.approx(c["mortar_force"], abs=1e-11)
    centre = [0.1 - 0.4, 1 + GAP + 0.2 - 0.08 + 0.7] + [0.4 - 0.3] * (dim - 2)  # of the tool, where it is now, from p
    arm = [cross(centre, body["force"])] if dim == 2 else numpy.cross(centre, body["force"])
    assert numpy.add(body["moment"], arm) == pytest.approx(c["mortar_moment"], abs=1e-9 * size)


# ---- refusals -----------------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("edit, words", [
    (lambda s: s["boundary"]["strip_y0"].update(moment_about="q"), ["boundary.strip_y0.moment_about is 'q'", "under point", "there: p"]),
    (lambda s: s["contact"]["c"].update(moment_about="q"), ["contact.c.moment_about is 'q'", "under point"]),
    (lambda s: s["body"]["strip"].update(moment_about="p"), ["body.strip.moment_about", "rigid"]),
    (lambda s: s["boundary"].update(strip_x0={"traction": {"x": 1}, "moment_about": "p"}), ["boundary.strip_x0.moment_about", "holds nothing"]),
    (lambda s: s["point"].update(r={}), ["point.r needs coordinates"]),
    (lambda s: s["point"].update(r={"z": 1}), ["point.r.z is given", "two-dimensional"]),
    (lambda s: s["body"]["strip"].update(motion={"rotation": {"angle": 1}}), ["body.strip.motion", "only a rigid body"]),
    (lambda s: s["body"]["tool"].update(motion={"rotation": {"axis": "z"}}), ["body.tool.motion.rotation.angle must be given"]),
    (lambda s: s["body"]["tool"].update(motion={"rotation": {"axis": "x", "angle": 1}}), ["body.tool.motion.rotation", "about z only"]),
    (lambda s: s["body"]["tool"].update(motion={"rotation": {"axis": "n", "angle": 1}}), ["body.tool.motion.rotation.axis is 'n'", "x|y|z"]),
    (lambda s: s["body"]["tool"].update(motion={"rotation": {"angle": "X*t"}}), ["body.tool.motion.rotation.angle", "in t alone"]),
    (lambda s: s["boundary"].update(strip_x0={"fix": "x", "rotation": {"angle": 1}}), ["boundary.strip_x0.rotation", "take fix away"]),
])
def test_refused(run, tmp_path, edit, words):
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene["point"] = {"p": {"x": 0}}
    edit(scene)
    refused(run("scene.yml", text=json.dumps(scene)), *words)


def test_rings_have_no_moment(run, tmp_path):
    scene = pressed(tmp_path, tool={"law": "rigid"})
    scene |= {"model": "axisymmetric", "point": {"p": {"x": 0}}}
    scene["boundary"]["strip_y0"]["moment_about"] = "p"
    refused(run("scene.yml", text=json.dumps(scene)), "boundary.strip_y0.moment_about is 'p'|reaches radius", "moment|radius")


# ---- shape ----------------------------------------------------------------------------------------------------------------------------

ROLLER = """
Point(1) = {-1.2, -0.8, 0, 0.12}; Point(2) = {1.2, -0.8, 0, 0.12}; Point(3) = {1.2, 0, 0, 0.12}; Point(4) = {-1.2, 0, 0, 0.12};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Transfinite Surface {1}; Recombine Surface {1};
Point(11) = {0, 0.01, 0, 0.08}; Point(12) = {0.4, 0.41, 0, 0.08}; Point(13) = {-0.4, 0.41, 0, 0.08}; Point(14) = {0, 0.41, 0};
Circle(11) = {11, 14, 12}; Line(12) = {12, 13}; Circle(13) = {13, 14, 11};
Curve Loop(2) = {11:13}; Plane Surface(2) = {2}; Recombine Surface {2};
Physical Surface("block") = {1}; Physical Surface("roller") = {2};
Physical Curve("foot") = {1}; Physical Curve("top") = {3}; Physical Curve("skin") = {11, 13};
"""


def test_a_round_rigid_body_is_round(run, tmp_path):
    """In an adaptive run its sides are as curved as the mesh at any order of the scene: at order 1, too, the force is that of order 2 with an error of 3 %."""
    (tmp_path / "roller.geo").write_text(ROLLER)
    scene = {"mesh": {"file": "roller.geo"}, "model": "plane_strain", "order": 1, "material": {"elastic": ELASTIC, "steel": {"law": "rigid"}},
             "body": {"block": {"material": "elastic"}, "roller": {"material": "steel", "motion": {"x": "0.8*max(0, t - 1)", "y": "-0.14*min(1, t)"}}}, "adapt": {"tolerance": 0.1},
             "boundary": {"foot": {"fix": "xy"}}, "contact": {"c": {"nonmortar": "top", "mortar": "skin", "friction": 0.3}}, "load": {"step": 0.1, "end": 1.3}}
    result = solve(run, scene, "-output_overwrite", "true")
    assert result.summary["contact"]["c"]["force"] == pytest.approx([0.03688, -0.12522], rel=0.006), result
    assert "body roller: order 2" in run("scene.yml", "-check", text=json.dumps(scene)).stdout
    assert "body roller: order 1" in run("scene.yml", "-check", "-adapt_tolerance", 0, text=json.dumps(scene)).stdout
