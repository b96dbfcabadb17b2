"""Properties O-90 to O-104 in the plane once more, with cells of order 2 and 4, contact faces linear and of the order of the cells: the tests of test_property_contact.py,
test_property_robust.py, test_contact_scenes.py and test_parallel.py with these options added."""
import functools

import pytest

import test_checkpoint as checkpoint
import test_contact_patch as patch
import test_contact_scenes as scenes
import test_parallel as parallel
import test_property_contact as plane
import test_property_robust as robust
from contactkit import blocks, contact, spread
from higher import faces, higher
from test_property_contact import ONE_MESH, disc_mesh

slow = pytest.mark.slow
SIDES = pytest.mark.parametrize("nonmortar,mortar", [("upper_bottom", "lower_top"), pytest.param("lower_top", "upper_bottom", marks=slow)])
SWAPPED = pytest.mark.parametrize("roles", [(), pytest.param(scenes.SWAPPED, marks=slow)], ids=["disc", "block"])


# ---- O-90 to O-93: balance, exchange of the sides, frames and units ---------------------------------------------------------


@faces("2-full")
@pytest.mark.parametrize("scene,options", [("slide2d", ("-adapt_max_passes", 3)), ("rubber2d", ("-adapt_max_passes", 3)), ("hertz2d", ONE_MESH)])
def test_o90_momentum(higher, scene, options):
    plane.test_o90_momentum(higher, scene, options)


@faces()
def test_o91_exchange_of_sides(higher):
    plane.test_o91_exchange_of_sides(higher)


@faces("2-full")
def test_o92_rigid_rotation(higher):
    plane.test_o92_rigid_rotation(lambda scene, *options, **keys: higher(scene, *options, "-mesh_refine", 1, **keys))


@faces("2-full")
@pytest.mark.parametrize("change,length,stress,shift", [("lengths", 1e-3, 1, 0), ("stresses", 1, 1e6, 0), ("both", 1e-3, 1e6, 0), ("large", 1e3, 1e-6, 0), ("shift", 1, 1, 1e4)])
def test_o93_units_and_origin(higher, tmp_path, disc_mesh, change, length, stress, shift):
    """At order 4 what the shift leaves of the positions is 1.1e-7 of the estimated error, far less of all else."""
    plane.test_o93_units_and_origin(higher, tmp_path, disc_mesh, change, length, stress, shift, 3e-7 if shift else 1e-8)


# ---- O-94, O-95: the tangent and what it makes of Newton's method -----------------------------------------------------------


@faces("2-full", kinds=("2-1", "2-full", "3-full", "4-1", "4-full"))
@pytest.mark.parametrize("scene,options", [("hertz2d", ()), ("slide2d", ("-load_step", 2)), ("rubber2d", ("-material_rubber_formulation", "displacement", "-boundary_top_displacement_y", -0.1)),
                                           ("rubber2d", ("-boundary_top_displacement_y", -0.1))])
def test_o94_tangent(higher, scene, options):
    plane.test_o94_tangent(higher, scene, 2, options)


@faces(kinds=("2-1", "2-full", "3-full", "4-1", "4-full"))
@SWAPPED
@pytest.mark.parametrize("scene", ["hertz2d", "rubber2d"])
def test_o94_tangent_other_meshes(higher, scene, roles):
    scenes.test_o94_tangent(higher, scene, 2, roles)


@faces("2-full")
@pytest.mark.parametrize("scene,options", [
    ("patch2d", ("-boundary_top_displacement_y", -0.6)), ("hertz2d", ("-boundary_top_displacement_x", 0.0123, *ONE_MESH)),
    ("hertz2d", ("-boundary_top_displacement_x", 0.0123, "-boundary_top_displacement_y", -0.3, *ONE_MESH)), ("rubber2d", ONE_MESH), ("slide2d", ONE_MESH)])
def test_o95_newton_order(higher, scene, options):
    plane.test_o95_newton_order(higher, scene, options)


# ---- O-96 to O-99: what must not break a run --------------------------------------------------------------------------------


@faces("2-full")
@pytest.mark.parametrize("options", [("-adapt_max_passes", 4), ONE_MESH])
@pytest.mark.parametrize("depth", [0, pytest.param(-1e-9, marks=slow)])
def test_o96_grazing(higher, depth, options):
    robust.test_o96_grazing(higher, depth, options)


@faces("2-full")
@SIDES
def test_o96_zero_load(higher, nonmortar, mortar):
    robust.test_o96_zero_load(higher, nonmortar, mortar)


@faces("2-full")
@SIDES
@pytest.mark.parametrize("x", [0, 1e-3, -1e-3])
def test_o96_edge_node_on_the_corner(higher, x, nonmortar, mortar):
    robust.test_o96_edge_node_on_the_corner(higher, x, nonmortar, mortar)


@faces("2-full")
def test_o97_free_fall(higher, tmp_path):
    robust.test_o97_free_fall(higher, tmp_path)


@faces("2-full")
@SIDES
@pytest.mark.parametrize("planes", ["both", "left"])
def test_o98_contact_face_on_symmetry_planes(higher, planes, nonmortar, mortar):
    robust.test_o98_contact_face_on_symmetry_planes(higher, planes, nonmortar, mortar, 2)


@faces("2-full")
def test_o98_support_across_the_face(higher, kind):
    """Of linear faces four see the contact of the coarse mesh, and the force is 12 % off; refined twice it is 0.3 %."""
    robust.test_o98_support_across_the_face(higher, 0 if kind.endswith("full") else 2)


@faces("2-full")
@pytest.mark.parametrize("lower_carries", [False, True])
def test_o98_three_bodies_at_a_point(higher, tmp_path, lower_carries):
    robust.test_o98_three_bodies_at_a_point(higher, tmp_path, lower_carries)


@faces("2-full")
def test_o99_one_step_or_ten(higher):
    robust.test_o99_one_step_or_ten(higher)


@faces("2-full")
@pytest.mark.parametrize("ranks", [1])
def test_o99_impossible_motion_ends_in_order(higher, ranks):
    robust.test_o99_impossible_motion_ends_in_order(higher, ranks)


# ---- O-100, O-102, O-103: pressure, restart ---------------------------------------------------------------------------------


@faces("2-full")
@pytest.mark.parametrize("number", [{"nl": 8, "nu": 1}, {"nl": 1, "nu": 8}], ids=["fine_below", "fine_above"])
@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
def test_o100_uniform_pressure_of_unequal_meshes(higher, nonmortar, number):
    """Faces 8 times finer on one side, with either side nonmortar: no pressure oscillates."""
    bodies = {"lower": patch.hyperelastic(100), "upper": patch.hyperelastic(1000)}
    result = higher("o100.yml", text=blocks(nonmortar, bodies, {**patch.rolled(), "top": {"displacement": {"y": -0.3}}}, number, None, None))
    assert result.returncode == 0 and spread(contact(result)["contact_pressure"], patch.PRESSURE) < 1e-8


@faces()
@pytest.mark.parametrize("name,ranks,then", [("adaptive", 1, 1), ("adaptive", 1, 3), ("mixed", 2, 1)])
def test_o102_restart(higher, name, ranks, then):
    whole = higher(f"inputs/{checkpoint.SCENES[name][0]}.yml", *checkpoint.SCENES[name][1])
    assert whole.returncode == 0, whole
    checkpoint.assert_same_run(whole, checkpoint.break_off_and_go_on(higher, name, ranks, then))


@faces("2-full")
def test_o103_no_multiplier_on_constrained_nodes(higher):
    robust.test_o103_no_multiplier_on_constrained_nodes(higher)


# ---- O-101, O-104: ranks, separation, search --------------------------------------------------------------------------------


@faces()
@pytest.mark.parametrize("name,ranks", [("hertz2d", (2, 3)), ("rubber2d", (2, 3)), ("slide2d", (2, 3))])
def test_o101_ranks(higher, name, ranks):
    parallel.compare(higher, *parallel.SCENES[name], ranks)


TILTED = ("-boundary_top_displacement_x", 0.0123, *ONE_MESH)
RANKS = {
    "o90": lambda run, path: plane.test_o90_momentum(run, "hertz2d", ONE_MESH),
    "o91": lambda run, path: plane.test_o91_exchange_of_sides(run),
    "o94": lambda run, path: plane.test_o94_tangent(run, "hertz2d", 2, ()),
    "o95": lambda run, path: plane.test_o95_newton_order(run, "hertz2d", TILTED),
    "o96": lambda run, path: robust.test_o96_edge_node_on_the_corner(run, 1e-3, "upper_bottom", "lower_top"),
    "o97": lambda run, path: robust.test_o97_free_fall(run, path),
    "o98": lambda run, path: robust.test_o98_contact_face_on_symmetry_planes(run, "both", "lower_top", "upper_bottom", 2),
    "o99": lambda run, path: robust.test_o99_one_step_or_ten(run),
    "o100": lambda run, path: test_o100_uniform_pressure_of_unequal_meshes(run, "upper", {"nl": 1, "nu": 8}),
    "o103": lambda run, path: robust.test_o103_no_multiplier_on_constrained_nodes(run),
    "o104": lambda run, path: robust.test_o104_separation(run, ONE_MESH),
}


@faces()
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("name", RANKS)
def test_on_ranks(higher, tmp_path, name, ranks):
    RANKS[name](functools.partial(higher, ranks=ranks), tmp_path)


@faces("2-full")
@pytest.mark.parametrize("ranks", [2, pytest.param(3, marks=slow)])
def test_o92_on_ranks(higher, ranks):
    plane.test_o92_rigid_rotation(lambda scene, *options, **keys: higher(scene, *options, "-mesh_refine", 1, ranks=ranks, **keys))


@faces("2-full")
@pytest.mark.parametrize("ranks", [2, pytest.param(3, marks=slow)])
@pytest.mark.parametrize("change,length,stress,shift", [("both", 1e-3, 1e6, 0), pytest.param("large", 1e3, 1e-6, 0, marks=slow), pytest.param("shift", 1, 1, 1e4, marks=slow)])
def test_o93_on_ranks(higher, tmp_path, disc_mesh, ranks, change, length, stress, shift):
    plane.test_o93_units_and_origin(lambda scene, *options, **keys: higher(scene, *options, "-adapt_max_passes", 2, ranks=ranks, **keys), tmp_path, disc_mesh, change, length, stress, shift, 3e-7 if shift else 1e-8)


@faces("2-full")
@pytest.mark.parametrize("options", [("-adapt_max_passes", 4), ONE_MESH])
def test_o104_separation(higher, options):
    robust.test_o104_separation(higher, options)


@faces("2-full")
@pytest.mark.parametrize("step", [1, 0.25])
def test_o104_nothing_in_reach(higher, tmp_path, step):
    robust.test_o104_nothing_in_reach(higher, tmp_path, step)


# ---- scenes: every mesh, either role, sliding -------------------------------------------------------------------------------


@faces()
@scenes.ROLES
@pytest.mark.parametrize("n", [4, 8, 16])
def test_hertz2d_every_mesh(higher, n, roles):
    scenes.test_hertz2d_every_mesh(higher, n, 2, roles)


@faces("2-full")
@scenes.ROLES
@pytest.mark.parametrize("n", [4, pytest.param(8, marks=slow)])
def test_slide2d_every_mesh(higher, n, roles):
    scenes.test_slide2d_every_mesh(higher, n, 2, roles)


@faces()
@scenes.ROLES
def test_slide2d_fine_mesh(higher, roles):
    scenes.test_slide2d_every_mesh(higher, 16, 2, roles)


@faces("2-full")
@pytest.mark.parametrize("slide,n", [(0.5, 8)] + [pytest.param(slide, n, marks=slow) for slide in (0.1, 0.5, 0.8) for n in (8, 16) if (slide, n) != (0.5, 8)])
def test_slide2d_deep_rubber(higher, slide, n):
    scenes.test_slide2d_deep_rubber(higher, slide, n)


@faces()
@scenes.ROLES
def test_slide2d_adaptive(higher, roles):
    scenes.test_slide2d_adaptive(higher, roles)


@faces()
@pytest.mark.parametrize("n", [4, 8, 16])
@scenes.ROLES
def test_rubber2d_every_mesh(higher, n, roles):
    scenes.test_rubber2d_every_mesh(higher, n, 2, roles)
