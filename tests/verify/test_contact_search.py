"""What a nonmortar side sees of the mortar side: deep overlaps, a side that goes on beyond a plane of symmetry, rigid sides."""
import numpy as np
import pytest

from boxmesh import linspace, write
from contactkit import BLOCKS, yaml

QUIET = ("-output_fields", "false")
SWAPPED = ("-contact_pair_nonmortar", "floor_top", "-contact_pair_mortar", "cup")
FLOOR = """
mesh: {file: SCENES/floor.geo, order: 4}
model: plane_strain
body: {disc: {material: rubber}, floor: {material: hard}}
material: {rubber: {law: neo_hookean, volumetric: quadratic, E: 1, nu: 0.3}, hard: {law: rigid}}
boundary: {top: {displacement: {x: 0, y: -0.05}}, sym: {fix: x}}
contact: {pair: {nonmortar: cup, mortar: floor_top, order: full}}
load: {step: 1}
adapt: {tolerance: 0.002, max_passes: 20}
"""
GAUNTLET = "tests/gauntlet/"
FORCE = 0.03753295  # of the whole half disc, to 1e-8


def floor(*edits):
    text = FLOOR.replace("SCENES", str(BLOCKS.parent))
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return text


def overlapping(path, overlap, carries, **keys):
    """Two blocks of height 1 in a channel, the upper one (u) from 1 - overlap on."""
    write(path / "overlap.msh", [linspace(0, 1, 5)] * 2, [lambda x, y: (x, y), lambda x, y: (x + 0.2 * x * (1 - x), y + 1 - overlap)],
          side=lambda name, centre, b: f"{name}_{'lu'[b]}", body=lambda centre, b: "lu"[b])
    sides = ("y0_u", "y1_l") if carries == "upper" else ("y1_l", "y0_u")
    scene = {"mesh": {"file": "overlap.msh"}, "model": "plane_strain", "body": {name: {"material": "m"} for name in "lu"},
             "material": {"m": {"law": "neo_hookean", "volumetric": "log", "E": 1, "nu": 0}},
             "boundary": {"y0_l": {"fix": "y"}, "y1_u": {"fix": "y"}, **{f"x{k}_{b}": {"fix": "x"} for k in (0, 1) for b in "lu"}},
             "contact": {"pair": dict(zip(("nonmortar", "mortar"), sides))}, "load": {"step": 1}, **keys}
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


# ---- overlap at the start ---------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("carries", ["upper", "lower"])
@pytest.mark.parametrize("overlap", [0.3, 0.55, 0.9])
def test_overlap_deeper_than_a_cell(run, tmp_path, carries, overlap):
    """Two blocks of height 1 between walls, the upper one set down into the lower one: each is shortened by half the overlap, whatever the facets measure."""
    result = run("overlap.yml", *QUIET, text=overlapping(tmp_path, overlap, carries))
    assert result.returncode == 0, result
    stretch = 1 - overlap / 2
    assert abs(result.summary["reaction"]["y0_l"][1] / ((1 / stretch - stretch) / 2) - 1) < 1e-6


def test_a_distance_without_bounds(run, tmp_path):
    """The square of the distance was infinite, and contact was off."""
    result = run("overlap.yml", *QUIET, "-contact_pair_search", 1e155, text=overlapping(tmp_path, 0.3, "upper"))
    assert result.returncode == 0, result
    stretch = 1 - 0.3 / 2
    assert abs(result.summary["reaction"]["y0_l"][1] / ((1 / stretch - stretch) / 2) - 1) < 1e-6


# ---- beyond a plane of symmetry ---------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("beyond", [0.5, 5])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_a_floor_that_goes_on_beyond_the_plane_of_symmetry(run, order, beyond):
    """Corners of the floor far behind the fine curved facets at the edge of the zone have their place in the view of those all the same."""
    result = run("floor.yml", *QUIET, "-order", order, "-mesh_parameter_a", beyond, text=floor())
    assert result.returncode == 0 and result.summary["step_cuts"] == 0, result
    assert abs(-2 * result.summary["reaction"]["top"][1] / FORCE - 1) < 1e-5


# ---- corners ----------------------------------------------------------------------------------------------------------------------------

EDGE = """
mesh: {file: SCENES/edge.geo, order: 1}
model: plane_strain
body: {slider: {material: m}, block: {material: m}}
material: {m: {law: neo_hookean, E: 10, nu: 0.3}}
boundary: {top: {displacement: {x: "2.2*max(t-1,0)", y: "-0.1*min(t,1)"}}, bottom: {fix: xy}}
contact: {pair: {nonmortar: skin, mortar: hull}}
load: {end: 2, step: 0.2}
"""


@pytest.mark.parametrize("options", [(), ("-load_step", 0.1), ("-mesh_parameter_k", 2), ("-order", 2), ("-contact_pair_order", "full")], ids=str)
@pytest.mark.parametrize("roles", [(), ("-contact_pair_nonmortar", "hull", "-contact_pair_mortar", "skin")], ids=["slider", "block"])
def test_off_an_edge(run, roles, options):
    """A slider pushed over the edge of a block, whole contours: side faces at the corners, bulged by some degrees, do not take what they graze for a contact."""
    result = run("edge.yml", *QUIET, *roles, *options, text=EDGE.replace("SCENES", str(BLOCKS.parent)))
    assert result.returncode == 0, result
    assert abs(result.history[-1]["contact_force"]) < 1e-9


EDGE3D = """
mesh: {file: SCENES/edge3d.geo, order: 1}
model: 3d
body: {slider: {material: m}, block: {material: m}}
material: {m: {law: neo_hookean, E: 10, nu: 0.3}}
boundary: {top: {displacement: {x: "1.6*max(t-1,0)", y: 0, z: "-0.05*min(t,1)"}}, bottom: {fix: xyz}}
contact: {pair: {nonmortar: skin, mortar: hull}}
load: {end: 2, step: 0.2}
"""


HULL = ("-contact_pair_nonmortar", "hull", "-contact_pair_mortar", "skin")


@pytest.mark.parametrize("roles, step", [((), 0.2), ((), 0.4), (HULL, 0.1), (HULL, 0.4), *(pytest.param(*words, marks=pytest.mark.slow) for words in (((), 0.1), (HULL, 0.2)))])
def test_off_an_edge_in_space(run, roles, step):
    """The same aslant. In the strip in which the bodies overlap at first, upright sides see far ones through both: no contact."""
    result = run("edge3d.yml", *QUIET, *roles, "-load_step", step, text=EDGE3D.replace("SCENES", str(BLOCKS.parent)))
    assert result.returncode == 0, result
    assert abs(result.history[-1]["contact_force"]) < 1e-9


def test_an_overlap_that_cannot_be_told(run, tmp_path):
    """More than half of what both blocks measure may be the far side of one behind: a note says so, and that the pair does not touch."""
    result = run("overlap.yml", *QUIET, text=overlapping(tmp_path, 1.2, "upper"))
    assert "note: the sides of pair pair overlap by 1.2 at the start, more than half" in result.stdout, result
    assert "overlap by" not in run("overlap.yml", *QUIET, text=overlapping(tmp_path, 0.9, "upper")).stdout


# ---- rigid sides ------------------------------------------------------------------------------------------------------------------------

def test_a_rigid_nonmortar_side(run):
    """The roles are exchanged, and it says so; figures are those of the sides as the scene names them."""
    text, options = floor() + "point: {origin: {x: 0, y: 0}}\n", (*QUIET, "-order", 3, "-contact_pair_moment_about", "origin")
    plain, swapped = run("floor.yml", *options, text=text), run("floor.yml", *options, *SWAPPED, text=text)
    assert plain.returncode == swapped.returncode == 0, swapped
    assert "is rigid and becomes the mortar side" in swapped.stdout and "becomes the mortar" not in plain.stdout
    first, second = plain.summary["contact"]["pair"], swapped.summary["contact"]["pair"]
    assert second["roles_exchanged"] is True and first["roles_exchanged"] is False
    assert second["force"] == first["mortar_force"] and second["mortar_force"] == first["force"] and second["moment"] == first["mortar_moment"]
    assert second["max_pressure"] == first["max_pressure"] and swapped.summary["reaction"] == plain.summary["reaction"]


def test_a_stiffer_nonmortar_side(run, tmp_path):
    """The softer side carries the multiplier, whatever the scene calls it; `roles: given` keeps the scene's roles."""
    text = overlapping(tmp_path, 0.1, "upper", body={"l": {"material": "m"}, "u": {"material": "stiff"}},
                       material={name: {"law": "neo_hookean", "volumetric": "log", "E": E, "nu": 0} for name, E in (("m", 1), ("stiff", 1000))})
    swap = ("-contact_pair_nonmortar", "y1_l", "-contact_pair_mortar", "y0_u")
    stiff, soft, given = (run("overlap.yml", *QUIET, *options, text=text) for options in ((), swap, ("-contact_pair_roles", "given")))
    assert stiff.returncode == soft.returncode == given.returncode == 0, stiff
    assert "'y0_u' is the stiffer one and becomes the mortar side" in stiff.stdout
    assert "becomes the mortar" not in soft.stdout + given.stdout and given.summary["contact"]["pair"]["roles_exchanged"] is False
    assert stiff.summary["reaction"] == soft.summary["reaction"]


@pytest.mark.parametrize("scene, sides", [("dent.yml", ("face", "skin")), ("overhang.yml", ("skin", "hull"))])
def test_a_side_with_corners(run, scene, sides):
    """The side that alone has corners carries the multiplier, stiffer or not, whatever the scene calls it; not where its facets are coarser."""
    options = (*QUIET, "-order", 1)
    swap = ("-contact_c_nonmortar", sides[1], "-contact_c_mortar", sides[0])
    plain, swapped = run(GAUNTLET + scene, *options), run(GAUNTLET + scene, *options, *swap)
    assert plain.returncode == swapped.returncode == 0, plain
    assert f"'{sides[0]}' has no corner, the other side has, and becomes the mortar side" in plain.stdout
    assert "becomes the mortar" not in swapped.stdout and plain.summary["step_cuts"] == 0
    assert plain.summary["reaction"] == swapped.summary["reaction"]
    given = run(GAUNTLET + scene, *options, "-load_end", 0.25, "-contact_c_roles", "given")
    assert "becomes the mortar" not in given.stdout
    coarse = {"dent.yml": ("-mesh_parameter_nu", 2), "overhang.yml": ("-mesh_parameter_nl", 2)}[scene]
    assert "has no corner" not in run(GAUNTLET + scene, *options, "-load_end", 0.25, *coarse).stdout


@pytest.mark.parametrize("radius, facets", [(0.03, 1), (0.03, 3), (0.08, 2), *(pytest.param(*words, marks=pytest.mark.slow) for words in ((0.03, 2), (0.08, 1), (0.08, 3)))])
def test_a_side_with_rounded_corners(run, radius, facets):
    """An edge that turns by 40 degrees within a facet of the other side is a corner, however many facets it has itself: the softer block's facets would wrap round it."""
    result = run(GAUNTLET + "round_press.yml", *QUIET, "-mesh_parameter_r", radius, "-mesh_parameter_k", facets)
    assert result.returncode == 0 and not result.summary["contact"]["c"]["roles_exchanged"] and result.summary["newton_iterations"] < 60, result
    assert abs(result.summary["contact"]["c"]["force"][1]) == pytest.approx({0.03: 0.679, 0.08: 0.7057}[radius], rel=0.01)


def test_a_side_rounded_widely(run):
    """It turns by less within a facet of the other side: the softer side carries the multiplier."""
    result = run(GAUNTLET + "round_press.yml", *QUIET, "-mesh_parameter_r", 0.2)
    assert result.returncode == 0 and result.summary["contact"]["c"]["roles_exchanged"], result


@pytest.mark.parametrize("swapped", [False, True])
def test_a_corner_slides_along_a_smooth_face(run, swapped):
    """The sharp nose of a snap hook on the flat top of its catch, without friction: forces are normal to it, from place to place the same. With the top as the nonmortar side (roles: given) the
    nose rides over bumps: forces along the top of 18 % of those across it on this mesh, of 41 % with cells half as large."""
    sides = ("-contact_snap_nonmortar", "nose", "-contact_snap_mortar", "edge") if swapped else ()
    result = run("tests/verify/scenes/snaphook.yml", "-load_end", 0.75, *sides)
    assert result.returncode == 0 and ("has no corner" in result.stdout) != swapped, result
    top = np.array([[float(row["contact.snap.force." + c]) for c in "xy"] for row in result.history if 0.5 <= row["t"] <= 0.75])
    assert len(top) >= 6 and max(abs(top[:, 0] / top[:, 1])) < 0.005, top
    np.testing.assert_allclose(top[:, 1], top[0, 1], rtol=2e-3)


def test_two_rigid_sides(run):
    result = run("floor.yml", text=floor(("disc: {material: rubber}", "disc: {material: hard}"), ("rubber: {law: neo_hookean, volumetric: quadratic, E: 1, nu: 0.3}, ", ""), ("{top: {displacement: {x: 0, y: -0.05}}, sym: {fix: x}}", "{}")))
    assert result.returncode == 1 and result.stderr.count("\n") == 1, result
    assert "contact.pair" in result.stderr and "'cup' and 'floor_top' are both sides of rigid bodies" in result.stderr


# ---- sides that supports hold -----------------------------------------------------------------------------------------------------------

def held(path, carries, **boundary):
    """The upper block's lower face is held: the lower block, stiffer, takes the whole overlap."""
    walls = {f"x{k}_{b}": {"fix": "x"} for k in (0, 1) for b in "lu"}
    return overlapping(path, 0.1, carries, body={"l": {"material": "m"}, "u": {"material": "soft"}},
                       material={name: {"law": "neo_hookean", "volumetric": "log", "E": E, "nu": 0} for name, E in (("m", 1), ("soft", 0.1))},
                       boundary={"y0_l": {"fix": "y"}, "y1_u": {"fix": "y"}, "y0_u": {"fix": "y"}, **walls, **boundary})


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("roles", ["auto", "given"])
@pytest.mark.parametrize("carries", ["upper", "lower"])
def test_a_held_side(run, tmp_path, carries, roles, order):
    """Its nodes have no multiplier: it is the mortar side, as a rigid one, soft or not. (As the nonmortar side it bore nothing.)"""
    result = run("overlap.yml", *QUIET, "-contact_pair_roles", roles, "-order", order, text=held(tmp_path, carries))
    assert result.returncode == 0 and ("'y0_u' is held by supports and becomes the mortar side" in result.stdout) == (carries == "upper"), result
    assert result.summary["reaction"]["y0_l"][1] == pytest.approx((1 / 0.9 - 0.9) / 2, rel=1e-9)


def test_a_held_side_on_ranks(run, tmp_path):
    one, *more = (run("overlap.yml", *QUIET, ranks=ranks, text=held(tmp_path, "upper")).summary for ranks in (1, 2, 3))
    for other in more: assert other["energy"] == pytest.approx(one["energy"], rel=1e-10)


def test_a_side_held_along_itself(run, tmp_path):
    """Rollers leave the face free to move along its normal: nothing is exchanged."""
    result = run("overlap.yml", *QUIET, text=held(tmp_path, "upper", y0_u={"fix": "x"}))
    assert result.returncode == 0 and "becomes the mortar" not in result.stdout, result
    assert result.summary["contact"]["pair"]["force"][1] > 0.009


def test_two_held_sides(run, tmp_path):
    result = run("overlap.yml", text=held(tmp_path, "upper", y1_l={"displacement": {"y": 0.01}}))
    assert result.returncode == 1 and result.stderr.count("\n") == 1, result
    assert "contact.pair" in result.stderr and "hold all of 'y0_u' and of 'y1_l' along their normals" in result.stderr


# ---- edges rounded within a facet, in space -----------------------------------------------------------------------------------------------

def test_a_side_with_rounded_edges_in_space(run):
    """They carry the multiplier, unless the body is so stiff that nothing of its own makes constraints felt; a hollow side as round does not wrap round them."""
    words = run("inputs/punch3d.yml", "-check").stdout
    assert "becomes the mortar" not in words
    words = run("inputs/punch3d.yml", "-check", "-mesh_parameter_k", 12).stdout  # the foundation's facets are shorter than the rounded edge
    assert "'foot' is the stiffer one and becomes the mortar side" in words
    words = run("inputs/angioplasty3d.yml", "-check").stdout  # metal 40 times as stiff as the balloon, 8000 times as the artery
    assert "'stent_inner' is the stiffer one and becomes the mortar side" in words and "has no edge rounded" not in words
    words = run("inputs/shrinkfit3d.yml", "-check").stdout
    assert "has no edge rounded" not in words
