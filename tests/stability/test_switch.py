"""Rows of docs/stability.md that are one scene with and without one switch: a figure of each, and what must hold of both."""
import pytest

from kit import end, plain, run, told, way  # noqa: F401

NTS = "node_to_segment true"


def top(component=1):
    return lambda s: s["reaction"]["top"][component]


def off(target, value=top()):
    """Relative error of a figure."""
    return lambda s: abs(value(s) / target - 1)


def newton(s):
    return s["newton_iterations"]


def factorisations(s):
    return s["factorisations"]


STOPS = None  # the naive method finds no solution: exit 2 before the end
ALONE = "-path_descent off -path_viscous off -path_coarsen off"  # what finds the solution elsewise hides what the switch does
TANGENT = "-newton_secant_flow off -path_predictor off"
SLIDE = ("inputs/slide2d.yml -adapt_tolerance 0 -mesh_parameter_n 8 -order 1 -boundary_top_displacement_x 0.9*max(t-1,0) -boundary_top_displacement_y -0.3*min(t,1) "
         "-material_rubber_nu 0.499 -contact_disc_on_block_nonmortar block_top -contact_disc_on_block_mortar disc_surface " + ALONE)
DRIVEN = ("inputs/cylinder.yml -boundary_flat_traction_y 0 -boundary_flat_displacement_y -1.6 -load_step 1 -mesh_parameter_n 4 -mesh_parameter_m 4 "
          "-refine_arc_levels 3 -refine_top_levels 3 -adapt_tolerance 0 -order 2 -contact_cylinder_on_block_order full")
PATCH, PAIR = "inputs/patch2d.yml", "-contact_upper_on_lower_"
SPOT = "-refine_spot_boundary upper_bottom -refine_spot_x 0 -refine_spot_y 1 -refine_spot_levels 2"
P = -0.0688979013617  # exact pressure of the patch

# id: way, figure, ours, naive (switches added to those of the scene), scene with its options, value of a summary, bound of ours from above,
# bound of the naive from below (STOPS: it ends with exit 2 before the load is on)
ROWS = {
    "penalty": ("A penalty moves the answer", "error of the force", "multipliers", f"{PAIR}law penalty {PAIR}penalty 10", PATCH, off(P), 1e-9, 0.05),
    "units": ("A penalty knows the units: stresses in Pa instead of MPa", "error of the force", "multipliers", f"{PAIR}law penalty {PAIR}penalty 1000",
              f"{PATCH} -material_rubber_E 1e6", off(1e6 * P), 1e-9, 0.9),
    "one_to_eight": ("Sixteen faces on two, the coarse side nonmortar", "error of the force, uniform pressure", "mortar", f"-contact_c_{NTS}",
                     "tests/gauntlet/ratio.yml -contact_c_roles given", off(-0.671529175186), 1e-6, 0.3),
    "hanging": ("Hanging nodes on the nonmortar side", "error of the force, uniform pressure", "mortar", f"{PAIR}{NTS}", f"{PATCH} {SPOT}", off(P), 1e-9, 1e-4),
    "corner": ("A die with a corner", "error of the force, twelve facets under the die", "mortar", f"-contact_c_{NTS}", "tests/gauntlet/dent.yml -mesh_refine 1",
               off(-0.1347), 0.01, 0.05),
    "rim": ("A block drawn off over the rim of another", "energy left", "mortar", f"-contact_c_{NTS}", "tests/gauntlet/slide.yml", lambda s: s["energy"], 1e-20, STOPS),
    "chords": ("Chords of a round surface, one facet under the load", "error of the force", "-contact_disc_on_block_order full",
               f"-contact_disc_on_block_order 1 -contact_disc_on_block_{NTS}", "inputs/hertz2d.yml -adapt_tolerance 0", off(-0.01875797), 1e-3, 0.05),
    "stiff": ("The stiff side carries the pressure, stiffness 1e5 : 1", "error of the force, one mesh", "roles: auto", "-contact_c_roles given",
              "tests/gauntlet/press.yml -adapt_tolerance 0", off(-0.29497), 2e-3, 7e-3),
    "wraps": ("Long facets of a leaf spring wrap round a rigid cam", "|energy / that of fine meshes - 1|, one mesh", "roles: auto", "-contact_lift_roles given",
              "tests/gauntlet/leaf_cam.yml -adapt_tolerance 0 -mesh_parameter_n 2", lambda s: abs(s["energy"] / 6.7312 - 1), 2e-3, 0.2),
    "bifurcation": ("A perfectly straight strut stays straight", "force on the head", "load.stable: true", "-load_stable false", "tests/gauntlet/straight.yml",
                    lambda s: -s["reaction"]["head"][1], 0.2, 0.9),
    "wall": ("A strut with a small side load follows the unstable branch", "unstable equilibria accepted", "load.stable: true", "-load_stable false",
             "tests/gauntlet/strut.yml", lambda s: s["unstable_equilibria"], 0, 5),
    "through": ("A step as long as the bodies: one goes through the other", "1 - force / force in ten steps", "-path_through auto", "-path_inside off -path_through off",
                "tests/gauntlet/through.yml", lambda s: abs(1 + s["reaction"]["top"][1] / 2.18155), 1e-3, 0.99),
    "inside": ("A converged state with one body inside the other", "1 - force / force in ten steps", "-path_inside auto", "-path_inside off -path_through off",
               "inputs/hertz2d.yml -adapt_tolerance 0 -order 2 -boundary_top_displacement_y -1.1*t -newton_line_search off",
               lambda s: abs(1 + s["reaction"]["top"][1] / 1.812647), 1e-4, 0.99),
    "cycling": ("The active set changes once a linearisation, and cycles", "Newton iterations", "active set iterated", "-solve_active_set_passes 0",
                "tests/verify/scenes/pressed_cylinder.yml -load_step 1", newton, 12, 60),
    "circles": ("Active sets of one linear step go in circles (a stiff rounded punch on a soft layer)", "Newton iterations", "-solve_single_switches yes",
                "-solve_single_switches no", "tests/gauntlet/layer_axi.yml -order 3", newton, 40, 80),
    "normals": ("Directions of gaps turn faster than facets", "Newton iterations", "-newton_frozen_normals auto", "-newton_frozen_normals off",
                f"tests/verify/scenes/pressed_cylinder.yml -load_step 1 -body_plate_motion_y 0.13 {ALONE}", newton, 12, 20),
    "overshoot": ("Flow at a rounded edge: Newton's method overshoots", "Newton iterations", "-newton_line_search auto", "-newton_line_search off",
                  f"tests/gauntlet/upset.yml -load_end 0.05 {ALONE}", newton, 50, STOPS),
    "soft": ("The tangent of plastic flow is soft far from a solution", "1 - t / t asked for", "-newton_secant_flow auto", "-newton_secant_flow off",
             f"tests/gauntlet/upset.yml -load_end 0.3 -load_step 0.1 -load_step_min 0.1 {ALONE}", lambda s: 1 - s["t"] / 0.3, 1e-12, STOPS),
    "flow": ("Material that flowed is taken for elastic at the start of a step", "Newton iterations", "-newton_yield_edge auto", "-newton_yield_edge off",
             "inputs/necking.yml -load_end 0.1", newton, 55, 65),
    "slide": ("Contact slides over half a disc in one step", "Newton iterations", "-newton_slide_predictor auto", "-newton_slide_predictor off", SLIDE, newton, 15, 25),
    "touch": ("First touch: all overlapping nodes taken for active", "factorisations", "-newton_first_touch auto", "-newton_first_touch off", DRIVEN, factorisations, 6, 8),
    "overlap": ("Bodies that overlap deeply at the start, which no part of the load scales", "1 - t reached", "-path_overlap auto", "-path_overlap off -load_step_min 0.4",
                "tests/gauntlet/wiper.yml -mesh_parameter_r 0.05 -mesh_parameter_o 0.6 -material_rubber_nu 0.4", lambda s: 1 - s["t"], 1e-12, STOPS),
    "stall": ("A solve without hope goes on", "factorisations", "-newton_stall auto", "-newton_stall off",
              f"tests/gauntlet/upset_strip.yml -adapt_tolerance 0 -load_step 0.05 -newton_line_search off {ALONE} {TANGENT}", factorisations, 500, 700),
    "snap": ("A clip snaps: behind the limit point no equilibrium is near", "1 - t reached", "-path_viscous auto, -path_descent auto",
             f"{ALONE} -path_predictor off", "tests/gauntlet/clip.yml -mesh_refine 1", lambda s: 1 - s["t"], 1e-12, STOPS),
    "membrane": ("Locking as nu goes to 1/2 (Cook's membrane, 8 x 8 cells)", "1 - displacement of the tip / 6.93", "mixed form, order 2",
                 "-order 1 -material_rubber_formulation displacement", "inputs/cook.yml", lambda s: 1 - s["probe"]["tip"]["displacement"][1] / 6.93, 0.006, 0.5),
    "singular": ("A singular corner spoils uniform refinement", "error of the energy, fewer unknowns for ours", "adapted", "-adapt_tolerance 0 -mesh_refine 3",
                 "inputs/lshape.yml", lambda s: s["energy"] / 2.0545124437e-4 - 1, 8e-4, 2e-3),
}
# seconds each; circles is in test_active_set.py; soft and overlap are in tests/verify, test_modifiers.py (secant_flow) and test_overlap_start.py, and the die of corner in the gauntlet
SLOW = ("circles", "stall", "snap", "rim", "cycling", "one_to_eight", "through", "overshoot", "normals", "corner", "soft", "overlap")


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in ROWS])
def test_switch(run, told, name):
    title, figure, ours, naive, scene, value, below, above = ROWS[name]
    scene, *options = scene.split()
    options += ["-output_fields", "false"]
    words = {"title": title, "figure": figure, "ours": ours, "naive": naive, "scene": scene, "picture": {"kind": {newton: "iterations", factorisations: "bars"}.get(value, "states")}}
    told("-", "-", **words)
    results = [run(scene, *options), run(scene, *options, *naive.split())]
    values = [value(result.summary) for result in results]
    shown = [v if result.returncode == 0 else end(result) for v, result in zip(values, results)]
    words["picture"].update(values=values, x=figure)
    told(*shown, **words)
    assert results[0].returncode == 0 and values[0] <= below, results[0]
    if above is STOPS:
        assert results[1].returncode == 2 and results[1].summary["status"] in ("failed", "inaccurate"), results[1]
    else:
        assert results[1].returncode == 0 and values[1] >= above, results[1]
