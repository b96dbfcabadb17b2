"""Each modifier of Newton's iteration earns its place: a scene that takes clearly more, or finds nothing, without it (docs/ablation.md has all scenes)."""
import re

import pytest
from contactkit import is_quadratic, steps

QUIET = ("-output_fields", "false")
ALONE = ("-path_descent", "off", "-path_viscous", "off", "-path_coarsen", "off")  # what finds the solution elsewise hides what the modifier saves
LOCKS = ("-material_soft_formulation", "displacement")  # the blank of coin without pressures of its own, which is the harder one
EXACT = ("-newton_frozen_normals", "off")  # the same where active sets go in circles
DEEP = ("inputs/slide2d.yml", "-adapt_tolerance", 0, "-mesh_parameter_n", 8, "-order", 1, "-boundary_top_displacement_x", "0.9*max(t - 1, 0)",
        "-boundary_top_displacement_y", "-0.3*min(t, 1)", "-material_rubber_nu", 0.499, "-contact_disc_on_block_nonmortar", "block_top",
        "-contact_disc_on_block_mortar", "disc_surface")
DRIVEN = ("inputs/cylinder.yml", "-boundary_flat_traction_y", 0, "-boundary_flat_displacement_y", -1.6, "-load_step", 1, "-mesh_parameter_n", 4,
          "-mesh_parameter_m", 4, "-refine_arc_levels", 3, "-refine_top_levels", 3, "-adapt_tolerance", 0, "-order", 2, "-contact_cylinder_on_block_order", "full")
ROLLS = ("tests/gauntlet/rocker.yml", "-adapt_tolerance", 0, "-material_soil_E", 20, "-mesh_parameter_k", 1.25, "-load_step", 0.25, "-load_step_min", 0.2,
         "-load_end", 1.25)
UPSET = ("tests/gauntlet/upset.yml", "-load_end", 0.3, "-load_step", 0.15, "-load_step_min", 0.15, "-path_predictor", "off")
NEEDED = [  # modifier, figure of summary.json, how many times as large it is without (None: no equilibrium is found), scene
    ("slide_predictor", "newton_iterations", 2, DEEP),
    ("first_touch", "factorisations", 1.5, DRIVEN),
    ("yield_edge", "newton_iterations", 1.3, ("inputs/necking.yml", "-load_end", 0.1)),
    ("stall", "factorisations", 2, ("tests/gauntlet/upset_strip.yml", "-adapt_tolerance", 0, "-load_step", 0.1, "-newton_line_search", "off", "-material_metal_formulation", "displacement")),
    ("secant_flow", None, None, UPSET),
    ("line_search", None, None, UPSET),
    ("carried_force", "newton_iterations", 2, ("tests/gauntlet/plate_drawn.yml", "-order", 3, *EXACT)),
    ("frozen_normals", "newton_iterations", 2, ("tests/verify/scenes/pressed_cylinder.yml", "-load_step", 1, "-body_plate_motion_y", 0.13)),
    ("warm_start", None, None, ROLLS),
    ("frozen_normals", None, None, ("tests/gauntlet/coin.yml", "-contact_c_friction", 0.3, "-load_end", 0.4, "-load_step", 0.4, "-load_step_min", 0.4, *LOCKS)),
]


@pytest.mark.parametrize("name,figure,times,scene", NEEDED, ids=[row[0] for row in NEEDED])
def test_needed(run, name, figure, times, scene):
    """The same solution with and without, and clearly more work without; or none is found without."""
    plain, without = (run(*scene, *QUIET, *ALONE, f"-newton_{name}", word) for word in ("auto", "off"))
    assert plain.returncode == 0 and plain.summary["modifiers"][name] > 0 == without.summary["modifiers"][name], plain
    if figure is None:
        assert without.returncode == 2 and without.summary["status"] == "failed", without
        return
    assert without.returncode == 0, without
    print(figure, plain.summary[figure], without.summary[figure])
    assert without.summary[figure] > times * plain.summary[figure]
    assert without.summary["energy"] == pytest.approx(plain.summary["energy"], rel=1e-3)


def test_warm_start_on_ranks(run):
    """States that a linear step begins with are those of the owners of nodes: the same run on any number of processes."""
    one, *others = (run(*ROLLS, *QUIET, ranks=ranks) for ranks in (1, 2, 3))
    for more in others:
        assert one.summary["modifiers"]["warm_start"] == more.summary["modifiers"]["warm_start"] > 0
        assert one.summary["newton_iterations"] == more.summary["newton_iterations"]
        assert more.summary["energy"] == pytest.approx(one.summary["energy"], rel=1e-8)


def test_inside(run):
    """A half disc pressed through the top of a block by more than its radius in one step: without a line search Newton's
    method ends with the disc inside the block and no contact at all. That is no solution; half the step is, and the force
    is that of ten steps."""
    scene = ("inputs/hertz2d.yml", "-adapt_tolerance", 0, "-order", 2, "-boundary_top_displacement_y", "-1.1*t", "-newton_line_search", "off")
    plain, fine, without = (run(*scene, *QUIET, *words) for words in ((), ("-load_step", 0.1), ("-path_inside", "off", "-path_through", "off")))
    for result in (plain, fine, without): assert result.returncode == 0, result
    assert plain.summary["refused_solutions"] == 1 and plain.summary["step_cuts"] == 1 and fine.summary["refused_solutions"] == without.summary["refused_solutions"] == 0
    force = [result.summary["contact"]["disc_on_block"]["force"][1] for result in (plain, fine, without)]
    print(force)
    assert force[0] > 1 and force[0] == pytest.approx(force[1], rel=1e-6) and force[2] == 0


def test_finer_meshes(run):
    """A block of rubber folds under the ends of its bonded faces, between integration points; on smaller cells there no equilibrium is found. The rest of the
    mesh is refined, and the tolerance is reached; not without that."""
    scene = ("tests/gauntlet/bonded.yml", *QUIET, "-adapt_tolerance", 0.06)
    plain, without = (run(*scene, "-path_unfolded", word) for word in ("auto", "off"))
    print(plain.summary["estimated_error"], without.summary["estimated_error"])
    assert plain.returncode == 0 and plain.summary["estimated_error"] < 0.06 and plain.summary["folded_left"] > 0, plain
    assert without.summary["status"] == "inaccurate" and without.summary["estimated_error"] > 0.06 and without.summary["folded_left"] == 0, without


def test_merged_cells(run):
    """A sharp wedge is drawn through a block: on the cells that adaptation made at its edge load steps are not found, on coarser ones they are. Without that the
    run ends where it stands."""
    scene = ("tests/verify/scenes/plough.yml", *QUIET, "-contact_c_roles", "given", "-load_end", 1.15)
    plain, without = (run(*scene, "-path_coarsen", word) for word in ("auto", "off"))
    print(plain.summary["estimated_error"], plain.summary["recoveries"]["coarsen"], without.summary["t"])
    assert plain.summary["t"] == 1.15 and plain.summary["status"] in ("converged", "inaccurate"), plain
    assert plain.summary["recoveries"]["coarsen"]["succeeded"] > 0 and "cells of the adapted mesh" in plain.stdout
    assert without.returncode == 2 and without.summary["status"] == "failed" and without.summary["t"] < 1.15, without
    first = int(re.search(r"(\d+) cells of order", plain.stdout)[1])
    assert all(int(cells) >= first for cells in re.findall(r"on (\d+) cells there is one", plain.stdout)), plain


def test_pressures_at_the_end_of_a_step(run):
    """A die of nearly incompressible material coins a plastic block: steps that go too far are told by the residual with the element pressures of their end."""
    plain, without = (run("tests/gauntlet/coin.yml", "-order", 4, "-mesh_parameter_h", 0.12, *LOCKS, *QUIET, *EXACT, "-newton_line_search", word) for word in ("auto", "off"))
    print(plain.summary["newton_iterations"], without.summary["newton_iterations"])
    assert plain.returncode == without.returncode == 0 and plain.summary["step_cuts"] == 0 < plain.summary["modifiers"]["line_search"]
    assert without.summary["newton_iterations"] > 2 * plain.summary["newton_iterations"]
    assert plain.summary["contact"]["c"]["force"][1] == pytest.approx(without.summary["contact"]["c"]["force"][1], rel=0.01)


def test_carried_force_keeps_the_order(run):
    """Residuals fall quadratically to the end where multipliers of nodes on slivers are taken over as forces, and ranks agree."""
    one, *others = (run("tests/gauntlet/plate_drawn.yml", *QUIET, "-snes_monitor", ranks=ranks) for ranks in (1, 2, 3))
    assert one.returncode == 0 and one.summary["modifiers"]["carried_force"] > 3, one
    assert is_quadratic(steps(one)[-1]), steps(one)[-1]
    for other in others:
        assert other.summary["newton_iterations"] == one.summary["newton_iterations"]
        assert other.summary["energy"] == pytest.approx(one.summary["energy"], rel=1e-12)
        assert other.summary["contact"]["c"]["force"] == pytest.approx(one.summary["contact"]["c"]["force"], rel=1e-10)


def test_load_again_on_a_finer_mesh(run):
    """Cook's membrane of incompressible rubber is not found from what was carried over to smaller cells at its held corner, but when the load is put on again
    from rest: nothing else is tried. Without that the mesh stays coarse."""
    scene = ("inputs/cook.yml", "-material_rubber_kappa", ".inf", "-load_step", 1, "-order", 4, "-mesh_parameter_n", 4, "-adapt_max_passes", 30, *QUIET)
    result = run(*scene, "-adapt_tolerance", 0.015)
    assert result.returncode == 0 and result.summary["recoveries"]["cut"]["succeeded"] > 0, result
    assert not any(row["tried"] for name, row in result.summary["recoveries"].items() if name != "cut")
    assert result.summary["probe"]["tip"]["displacement"][1] == pytest.approx(6.934, rel=1e-3)
    without = run(*scene, "-adapt_tolerance", 0.015, "-path_cut", "off")
    assert without.returncode == 2 and without.summary["status"] == "inaccurate" and without.summary["estimated_error"] > 0.015, without


def test_switches_and_counters(run):
    """Each has a row in -help and a counter in summary.json, steps of history.csv add up to them, and none acts when it is off."""
    names = re.findall(r"^  -newton_(\w+) +auto\|on\|off$", run("inputs/patch2d.yml", "-help").stdout, re.M)
    plain = run("inputs/patch2d.yml", *QUIET)
    assert len(names) >= 5 and sorted(plain.summary["modifiers"]) == sorted(names) and sum(plain.summary["modifiers"].values()) > 0
    assert sum(row["modifiers"] for row in plain.history) == sum(plain.summary["modifiers"].values())
    off = run("inputs/patch2d.yml", *QUIET, *(word for name in names for word in (f"-newton_{name}", "off")))
    assert off.returncode == 0 and not any(off.summary["modifiers"].values())
    assert off.summary["energy"] == pytest.approx(plain.summary["energy"], rel=1e-9)


def test_cells_that_would_fold(run):
    """Where the mesh without cells that are folded already has no equilibrium, one without those that fold on it has: a mount of rubber is done to its tolerance."""
    scene = ("tests/gauntlet/mount.yml", *QUIET, "-adapt_tolerance", 0.06, "-order", 3)
    plain, without = (run(*scene, "-path_unfolded", word) for word in ("auto", "off"))
    assert plain.returncode == 0 and plain.summary["recoveries"]["unfolded"]["succeeded"] > 0, plain
    assert without.returncode == 2 and without.summary["status"] == "inaccurate", without
