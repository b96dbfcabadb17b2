"""A sharp corner of the mortar side slides along an oblique face without friction: the force is normal to that face. Within a facet its gap is a mean that
depends on the place, so that the run begins anew with the roles of the pair exchanged."""
import json
import math
import pathlib
import re

import pytest

SCENES = pathlib.Path(__file__).resolve().parent.parent / "gauntlet"
NORMAL = -0.73  # of the forces that a slope of 34 degrees takes, turned with the beam


def rib(radius, order=2):
    """A rigid rib that pushes the hook of a beam up a slope of 34 degrees."""
    return json.dumps({"mesh": {"file": str(SCENES / "rib.geo"), "parameter": {"r": radius}}, "model": "plane_strain", "order": order,
                       "body": {"beam": {"material": "plastic"}, "rib": {"material": "tool", "motion": {"x": "-0.9*t"}}},
                       "material": {"plastic": {"law": "neo_hookean", "E": 1000, "nu": 0.3}, "tool": {"law": "rigid"}}, "boundary": {"root": {"fix": "xy"}},
                       "contact": {"c": {"nonmortar": "hook", "mortar": "rib_face"}}, "load": {"step": 0.025, "end": 0.3}})


def edge(size, friction=0):
    """An elastic wedge, its face at 45 degrees, on the sharp edge of a block 200 times as stiff."""
    pair = {"nonmortar": "face", "mortar": ["top", "inner"]}
    if friction:
        pair["friction"] = friction
    return json.dumps({"mesh": {"file": str(SCENES / "edge_slope.geo"), "order": 1, "parameter": {"f": size}}, "model": "plane_strain", "order": 2,
                       "body": {"block": {"material": "hard"}, "wedge": {"material": "soft"}},
                       "material": {"soft": {"law": "neo_hookean", "E": 1000, "nu": 0.3}, "hard": {"law": "neo_hookean", "E": 200000, "nu": 0.3}},
                       "boundary": {"base": {"fix": "xy"}, "held": {"displacement": {"x": 0, "y": -0.05}}}, "contact": {"c": pair}, "load": {"step": 1}})


def ends(run, text, *options, ranks=1, scene="s.yml"):
    result = run(scene, "-output_fields", "false", *options, text=text, ranks=ranks)
    assert result.returncode == 0, result
    print(result.summary["contact"]["c"]["force"], result.summary["energy"], result.summary["estimated_error"], result.summary["newton_iterations"])
    return result


def force(result):
    return result.summary["contact"]["c"]["force"]


def test_round_rib(run):
    x, y = force(ends(run, rib(0.03)))
    assert x / y == pytest.approx(-0.68, rel=0.03) and y == pytest.approx(0.0034, rel=0.05)


@pytest.mark.parametrize("options", [(), ("-order", "3"), ("-load_step", "0.05"), ("-load_step", "0.3"), ("-mesh_refine", "1"), ("-adapt_tolerance", "0.02")],
                         ids=" ".join)
def test_sharp_rib(run, options):
    """Orders, steps and meshes agree on the force to 0.2 %."""
    result = ends(run, rib(0), *options)
    x, y = force(result)
    assert x / y == pytest.approx(NORMAL, rel=0.01) and y == pytest.approx(0.004893, rel=0.002), (x, y)
    assert result.summary["contact"]["c"]["roles_exchanged"] and result.summary["begun_anew"] == 1
    assert "the run begins anew with their roles exchanged" in result.stdout


def test_roles_given(run):
    """What roles are exchanged for: the force that the rib meets is 40 times as large, along the slope."""
    result = ends(run, rib(0), "-contact_c_roles", "given")
    x, y = force(result)
    assert not result.summary["contact"]["c"]["roles_exchanged"] and result.summary["begun_anew"] == 0
    assert math.hypot(x, y) > 10 * 0.006


@pytest.mark.parametrize("ranks", [2, 3])
def test_ranks(run, ranks):
    assert force(ends(run, rib(0), ranks=ranks)) == pytest.approx(force(ends(run, rib(0))), rel=1e-8)


def test_goes_on(run, tmp_path):
    """A checkpoint knows the roles."""
    whole = ends(run, rib(0))
    stopped = run("s.yml", "-output_fields", "false", "-load_max_steps", "10", text=rib(0))
    assert stopped.returncode == 2, stopped
    result = ends(run, rib(0), "-restart", stopped.directory / "checkpoint.h5")
    assert force(result) == pytest.approx(force(whole), rel=1e-10)
    assert result.summary["begun_anew"] == 1


@pytest.mark.parametrize("size", [2, 1.5, 1.2, 0.8, 0.6])
def test_edge_on_slope(run, size):
    """Which side's facets are longer does not matter: the force is normal to the face in each, but for the few degrees by which that turns."""
    x, y = force(ends(run, edge(size)))
    assert -x / y == pytest.approx(1, abs=0.05) and y > 8, (x, y)


@pytest.mark.parametrize("size", [2, 1.2])
def test_edge_on_slope_adaptive(run, size):
    """On finer meshes the zone of contact is wider than facets, and the softer side is the better one: where none is found with exchanged roles, the run goes
    back to the former ones."""
    result = ends(run, edge(size), "-adapt_tolerance", "0.05")
    assert force(result) == pytest.approx([-7.505, 7.505], rel=0.03)
    assert result.summary["energy"] == pytest.approx(0.171, rel=0.005)
    assert not result.summary["contact"]["c"]["roles_exchanged"] and result.summary["begun_anew"] == 2


def tooth(friction, **body):
    """A sharp rigid tooth, its tip beside a node of a soft bed."""
    return json.dumps({"mesh": {"file": str(SCENES / "tooth.geo"), "parameter": {"sh": 0.06}}, "model": "plane_strain", "order": 2,
                       "body": {"gasket": {"material": "soft"}, "tooth": {"material": "hard", **body}},
                       "material": {"soft": {"law": "neo_hookean", "E": 2, "nu": 0.4}, "hard": {"law": "rigid"}}, "boundary": {"gb": {"fix": "xy"}},
                       "contact": {"c": {"nonmortar": "gt", "mortar": "ft", "friction": friction}}, "load": {"step": 0.5}})


@pytest.mark.parametrize("body", [{"motion": {"y": "-0.1*t"}}, {"load": {"y": "-0.16*t", "x": "0.005*t"}}], ids=lambda body: next(iter(body)))
def test_tangent(run, body):
    """A rigid side that carries the multipliers, moved or under forces: its tangents are those of its residual."""
    out = ends(run, tooth(0.3, **body), "-snes_test_jacobian").stdout.split("begins anew")
    assert len(out) == 2
    ratios = [float(ratio) for ratio in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+?),", out[1])]
    assert len(ratios) > 5 and max(ratios) < 1e-6, ratios


def test_under_forces(run):
    """Pressed by a force a rigid side that carries them is where the same motion meets that force, on 1, 2 and 3 processes; forces and moments balance."""
    text = tooth(0, load={"y": "-0.16*t"})
    pressed = ends(run, text)
    place = pressed.summary["body"]["tooth"]["displacement"]
    for ranks in (2, 3):
        assert ends(run, text, ranks=ranks).summary["body"]["tooth"]["displacement"] == pytest.approx(place, rel=1e-8)
    moved = ends(run, tooth(0, motion={"y": f"{place[1]:.17g}*t"}))
    assert force(pressed)[1] == pytest.approx(-0.16, rel=1e-9) and force(moved) == pytest.approx(force(pressed), rel=1e-8)
    for result in (pressed, moved):
        assert max(result.summary["contact"]["c"][key] for key in ("force_imbalance", "moment_imbalance")) < 1e-12


def test_corner_ends_a_zone(run):
    """A corner of a steel tool comes first, in a step of a tenth, and carries alone; then the face beside it presses, which the rubber's nodes know better. As in
    steps in which the face presses at once; on any number of ranks."""
    options = ("-mesh_parameter_f", 0.4, "-load_step", 0.1, "-load_end", 0.5)
    energy = run("tests/gauntlet/turned_tool.yml", "-mesh_parameter_f", 0.4, "-load_end", 0.5).summary["energy"]
    for ranks in (1, 2, 3):
        result = run("tests/gauntlet/turned_tool.yml", *options, ranks=ranks)
        assert result.summary["begun_anew"] == 2 and result.summary["energy"] == pytest.approx(energy, rel=1e-8), result


# ---- in space -------------------------------------------------------------------------------------------------------------------------


def edge_in_space(path, size, layers=1, roles="auto"):
    """The wedge on the edge of a block between two planes of symmetry, which is plane strain."""
    (path / "edge.geo").write_text((SCENES / "edge_slope.geo").read_text().split("Physical")[0] + f"""
e[] = Extrude {{0, 0, 0.3}} {{ Surface{{1}}; Layers{{{layers}}}; Recombine; }}; w[] = Extrude {{0, 0, 0.3}} {{ Surface{{2}}; Layers{{{layers}}}; Recombine; }};
Physical Volume("block") = {{e[1]}}; Physical Volume("wedge") = {{w[1]}}; Physical Surface("flanks") = {{1, 2, e[0], w[0]}};
Physical Surface("base") = {{e[2]}}; Physical Surface("top") = {{e[4]}}; Physical Surface("inner") = {{e[5]}};
Physical Surface("face") = {{w[2]}}; Physical Surface("held") = {{w[4]}};
""")
    scene = json.loads(edge(size))
    scene |= {"mesh": {"file": "edge.geo", "order": 1, "parameter": {"f": size}}, "model": "3d"}
    scene["boundary"] |= {"flanks": {"fix": "z"}}
    scene["contact"]["c"]["roles"] = roles
    return json.dumps(scene)


@pytest.mark.parametrize("size", [1, 0.8])
def test_edge_in_space(run, tmp_path, size):
    """As in the plane, and normal to the face; with the softer side as the nonmortar one a seventh of that, or another direction."""
    plane, space = ends(run, edge(size)), ends(run, edge_in_space(tmp_path, size))
    x, y, _ = force(space)
    assert space.summary["begun_anew"] == 1 and (x / 0.3, y / 0.3) == pytest.approx(force(plane)[:2], rel=1e-3)
    given = ends(run, edge_in_space(tmp_path, size, roles="given"))
    assert given.summary["begun_anew"] == 0 and math.dist(force(given), force(space)) > 0.5 * math.hypot(x, y), given


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_corner_in_space(run, ranks):
    """Of a cube that stands on it: by symmetry the force is upright; the block's coarse facets alone see nothing of the corner."""
    options = ("-adapt_tolerance", 0, "-mesh_refine", 1, "-boundary_head_displacement_z", "-0.12*t", "-output_fields", "false")
    x, y, z = force(run("tests/verify/scenes/cube_corner.yml", *options, ranks=ranks))
    print(x, y, z)
    assert max(abs(x), abs(y)) < 0.05 * abs(z) and abs(z) > 0.01


@pytest.mark.parametrize("cells,corner", [(8, 0), (4, 1)])
def test_few_facets_round_a_tool(run, cells, corner):
    """They turn by 45 degrees from middle to middle but meet smoothly: a corner only to facets so long that one wraps round, known before the first step."""
    result = ends(run, None, "-mesh_parameter_n", cells, scene="tests/verify/scenes/round_tool.yml")
    carries = "'rim' the nonmortar side" in result.stdout
    assert result.summary["begun_anew"] == 0 and carries == bool(corner) and force(result)[1] == pytest.approx(-0.1925, rel=0.08 if corner else 0.01)
    for ranks in (2, 3):
        other = ends(run, None, "-mesh_parameter_n", cells, scene="tests/verify/scenes/round_tool.yml", ranks=ranks)
        assert other.summary["begun_anew"] == 0 and other.summary["energy"] == pytest.approx(result.summary["energy"], rel=1e-8)
