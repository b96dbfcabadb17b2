"""Finite elasto-plasticity (law j2): bars (O-30), a tube expanded and released (O-32), the necking bar (O-33), ranks, load steps that are cut."""
import json
import math
import pathlib
import re
import sys

import numpy
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))
import mortise

from boxmesh import linspace, write
from contactkit import is_quadratic, steps
from stripkit import strip

SCENES = pathlib.Path(__file__).resolve().parent / "scenes"
SET_A = {"law": "j2", "volumetric": "simo", "E": 206.9e3, "nu": 0.29, "yield": 450, "hardening": 129.24}
SET_B = {"law": "j2", "volumetric": "simo", "mu": 80e3, "kappa": 170e3, "yield": 205, "hardening": 1000}


def close(value, reference, tolerance):
    assert abs(value - reference) <= tolerance * abs(reference), (value, reference)


def solve(run, tmp_path, material, dim, boundary, num_steps, breaks, to=None, *options, model=None, order=1, ranks=1, **keys):
    """A block or a mapped block between boundaries."""
    write(tmp_path / "block.msh", breaks, to or (lambda *x: x), order=order)
    scene = {"mesh": {"file": "block.msh"}, "model": model or ("3d" if dim == 3 else "plane_strain"), "order": order, "body": {"body": {"material": "m"}},
             "material": {"m": material}, "boundary": boundary, "load": {"step": 1 / num_steps, "step_max": 1 / num_steps}, "output": {"fields": False}, **keys}
    result = run("block.yml", *options, text=json.dumps(scene), ranks=ranks)
    assert result.returncode == 0, result
    return result


# ---- O-30: one element, lateral faces free -----------------------------------------------------------------------------------------------

BARS = [("A", SET_A, .05, 433.940640, .975761191, .047889601), ("A", SET_A, -.2, -580.777360, 1.104637149, .197309542),
        ("B", SET_B, .1, 274.748615, .951512470, .098644179)]


@pytest.mark.parametrize("model, formulation", [("3d", "displacement"), ("3d", "mixed"), ("axisymmetric", "displacement"), ("axisymmetric", "mixed")])
@pytest.mark.parametrize("name, material, e, P, lateral, alpha", BARS)
def test_o30_bar(run, tmp_path, name, material, e, P, lateral, alpha, model, formulation):
    material = {**material, "formulation": formulation}
    if model == "3d":
        boundary = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}, "y1": {"displacement": {"y": f"exp({e}*t)-1"}}}
    else:
        boundary = {"y0": {"fix": "y"}, "x0": {"fix": "x"}, "y1": {"displacement": {"y": f"exp({e}*t)-1"}}}
    dim = 3 if model == "3d" else 2
    s = solve(run, tmp_path, material, dim, boundary, 40, [linspace(0, 1, 1)] * dim, model=model, probe={"corner": {"x": 1, "y": 1}}).summary
    area = 1 if dim == 3 else math.pi
    print("P", s["reaction"]["y1"][1] / area / P - 1, "alpha", s["plastic_strain"] / alpha - 1)
    close(s["reaction"]["y1"][1] / area, P, 1e-3)
    close(1 + s["probe"]["corner"]["displacement"][0], lateral, 1e-4)
    close(s["plastic_strain"], alpha, 5e-3)  # of first order in the step; 1e-4 with 4000 steps (test_material_j2)
    y, K = material["yield"], material["hardening"]
    close(s["plastic_work"] / area, y * s["plastic_strain"] + K * s["plastic_strain"]**2 / 2, 1e-8)
    close(s["body"]["body"]["mean_plastic_strain"], s["plastic_strain"], 1e-8)


# ---- O-32: tube of incompressible material, bore driven to 1.4 and let go ------------------------------------------------------------------

def tube(run, tmp_path, cells, order, num_steps, formulation="mixed", kappa=8e9):
    """Axisymmetric, height 1 between two planes: pressures on the bore by its radius, on the way out and the last before it is free."""
    boundary = {"x0": {"displacement": {"x": "0.4*min(t,1)-0.005*max(t-1,0)"}}, "y0": {"fix": "y"}, "y1": {"fix": "y"}}
    result = solve(run, tmp_path, {**SET_B, "kappa": kappa if kappa < math.inf else "inf", "formulation": formulation}, 2, boundary, num_steps, [linspace(1, 1.15, cells), linspace(0, 1, 1)],
                   model="axisymmetric", order=order, load={"step": 1 / num_steps, "step_max": 1 / num_steps, "end": 1.5},
                   probe={"bore": {"x": 1, "y": 0}, "outside": {"x": 1.15, "y": 0}})
    rows = [(1 + row["probe.bore.displacement.x"], 1.15 + row["probe.outside.displacement.x"], row) for row in result.history]
    return [(ri, ro, row["reaction.x0.x"] / (2 * math.pi * ri), row) for ri, ro, row in rows]


@pytest.mark.parametrize("kappa", [8e9, math.inf])
def test_o32_tube(run, tmp_path, kappa):
    """Pressures by bore radius to 0.3 %, recoil of the bore to 2 %."""
    rows = tube(run, tmp_path, 2, 2, 40, kappa=kappa)
    pressure = {round(ri, 9): p for ri, ro, p, row in rows[:40]}
    for ri, reference in ((1.01, 33.96346), (1.1, 41.02548), (1.2, 45.56302), (1.4, 48.61603)):
        print("bore", ri, "pressure", pressure[ri] / reference - 1)
        close(pressure[ri], reference, 3e-3)
    # elastic unloading is all but linear: its last two pressures tell the radius without pressure
    (r0, o0, p0, row), (r1, o1, p1, _) = rows[-2:]
    close(row["plastic.strain"], .38599, 0.005)  # at the bore; the first integration point, a little inside, has 1.2 % less
    free = -p1 / (p1 - p0)
    print("recoil", (1 - (r1 + free * (r1 - r0)) / 1.4) / 0.002146 - 1, "radii", (r1 + free * (r1 - r0)) / 1.3969955 - 1, (o1 + free * (o1 - o0)) / 1.5080107 - 1, "strain",
          row["plastic.strain"] / .38599 - 1)
    close(1 - (r1 + free * (r1 - r0)) / 1.4, 0.002146, 0.02)
    close(r1 + free * (r1 - r0), 1.3969955, 1e-4)
    close(o1 + free * (o1 - o0), 1.5080107, 1e-4)


# ---- O-33: necking of a bar ----------------------------------------------------------------------------------------------------------------

RADIUS, NECK = 6.413, 0.982 * 6.413
SATURATION = {1: (69.783, .96272), 2: (75.719, .94261), 3: (77.141, .90777), 4: (71.046, .82062), 5: (59.324, .69869), 6: (43.09, .5430), 7: (24.2, .362)}
LINEAR = {.5: (55.467, .95020), 1: (54.139, .91099), 2: (50.575, .82023), 3: (45.33, .71164), 4: (37.6, .5813), 5: (27.1, .428)}
TOLERANCE = {.5: 0.005, 1: 0.005, 2: 0.005, 3: 0.005, 4: 0.005, 5: 0.01, 6: 0.04, 7: 0.15}
ADAPTIVE = ("-mesh_parameter_n", 2, "-mesh_parameter_grade", 1, "-adapt_tolerance", 0.01, "-adapt_strategy", "hp", "-adapt_max_order", 3, "-adapt_max_cells", 100,
            "-adapt_max_passes", 4)


def necking(run, end, *options, ranks=1):
    result = run("inputs/necking.yml", "-load_end", end / 7, "-output_fields", "false", *options, ranks=ranks)
    assert result.solved, result
    return result


def at(result, u):
    """Force and radius of the neck at u, linear between steps (cut at the onset of yield, they end anywhere)."""
    moved = [7 * row["t"] for row in result.history]
    return [numpy.interp(u, moved, values) for values in
            ([row["reaction.end.y"] for row in result.history], [(NECK + row["probe.neck.displacement.x"]) / RADIUS for row in result.history])]


def check_necking(result, table, last):
    for u, (force, neck) in table.items():
        if u > last:
            continue
        found = at(result, u)
        print(u, found[0] / force - 1, found[1] / neck - 1)
        close(found[0], force, TOLERANCE[u])
        close(found[1], neck, TOLERANCE[u])


def check_loss(result):
    """Force, plastic work and largest strain at the same load, before and after the history went to a finer mesh."""
    passes = [row for row in result.adapt if row["pass"] > 0]
    assert passes
    for row in passes:
        assert row["force_change"] < 5e-4 and abs(row["work_change"]) < 2e-5 and abs(row["strain_change"]) < 0.01, row
    return passes


def test_o33_to_the_largest_force(run):
    check_necking(necking(run, 3, "-mesh_parameter_n", 3), {u: SATURATION[u] for u in (1, 2, 3)}, 3)


@pytest.mark.slow
def test_o33_saturation(run):
    result = necking(run, 7)
    check_necking(result, SATURATION, 7)
    assert result.summary["step_cuts"] == 0 and result.summary["newton_iterations"] < 700


@pytest.mark.slow
def test_o33_linear(run):
    """Falls from the start: the bar necks at once."""
    check_necking(necking(run, 5, "-material_steel_hardening", 0.25, "-material_steel_saturation", 0), LINEAR, 5)


@pytest.mark.slow
def test_o33_adaptive(run):
    """98 cells of orders 2 and 3 where 1152 uniform ones of order 2 give the same forces."""
    result = necking(run, 7, *ADAPTIVE)
    check_necking(result, SATURATION, 7)
    check_loss(result)
    assert result.summary["cells"] <= 100 and result.summary["dofs"] < 2000
    uniform = necking(run, 6, "-mesh_parameter_n", 24, "-mesh_parameter_grade", 1)
    close(at(result, 6)[0], at(uniform, 6)[0], 1e-3)


@pytest.mark.slow
def test_o33_adaptive_h(run):
    """198 cells of order 2 where 648 uniform ones are still 11 % off at u = 7."""
    result = necking(run, 7, "-mesh_parameter_n", 3, *ADAPTIVE[2:6], "-adapt_fraction", 0.4, "-adapt_max_cells", 200, "-adapt_max_passes", 4)
    check_necking(result, SATURATION, 7)
    check_loss(result)
    assert result.summary["cells"] <= 200 and abs(at(result, 7)[0] / SATURATION[7][0] - 1) < 0.08


@pytest.mark.parametrize("ranks", [(2,), pytest.param((2, 3), marks=pytest.mark.slow)])
def test_adaptation_keeps_history_on_any_ranks(run, ranks):
    """Splits, merges and raised orders; one, two and three processes agree, and what an adaptation changes is small where steps are no longer than the mesh follows
    (beyond the largest force the estimate goes from 4 to 13 % in a step of 0.05)."""
    step = 0.05 if ranks == (2,) else 0.025
    options = (*ADAPTIVE[:-2], "-adapt_max_passes", 2, "-adapt_coarsen", 0.05, "-load_step", step, "-load_step_max", step)
    runs = [necking(run, 3 if ranks == (2,) else 3.5, *options, ranks=n) for n in (1, *ranks)]
    assert len(check_loss(runs[0])) >= 2
    for other in runs[1:]:
        for a, b in zip(runs[0].history, other.history):
            for key in ("reaction.end.y", "plastic.strain", "plastic.work", "body.bar.mean_plastic_strain", "energy", "cells"):
                close(b[key], a[key], 1e-8)


@pytest.mark.parametrize("ranks", [1, 2])
def test_mean_plastic_strain_of_bodies(run, tmp_path, ranks):
    """Without hardening plastic work is the yield stress times int alpha dV: of two bodies of one material, a third and two thirds of what flows. The elastic one below
    has no such figure."""
    write(tmp_path / "block.msh", [linspace(0, 1, 3), linspace(0, 1, 3)], order=2,
          body=lambda centre, block: "elastic" if centre[1] < 1 / 3 else "left" if centre[0] < 1 / 3 else "right")
    soft = {**SET_B, "hardening": 0}
    scene = {"mesh": {"file": "block.msh"}, "model": "plane_strain", "order": 2, "output": {"fields": False}, "load": {"step": 1 / 3},
             "body": {"elastic": {"material": "stiff"}, "left": {"material": "soft"}, "right": {"material": "soft"}},
             "material": {"soft": soft, "stiff": {"law": "neo_hookean", "mu": 80e3, "kappa": 170e3}},
             "boundary": {"y0": {"fix": "xy"}, "y1": {"displacement": {"y": "-0.004*t*(1+X)"}}}}
    result = run("block.yml", text=json.dumps(scene), ranks=ranks)
    assert result.returncode == 0, result
    s, row = result.summary, result.history[-1]
    left, right = (s["body"][name]["mean_plastic_strain"] for name in ("left", "right"))
    assert set(s["body"]) == {"left", "right"} and 0 < left < 0.9 * right < right < s["plastic_strain"], s
    close(s["plastic_work"], soft["yield"] * (left * 2 + right * 4) / 9, 1e-10)
    for name, value in (("left", left), ("right", right)):
        close(row[f"body.{name}.mean_plastic_strain"], value, 1e-12)
    assert "body.elastic.mean_plastic_strain" not in row


# ---- the solver ----------------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("formulation", ["displacement", "mixed"])
def test_newton_is_quadratic_through_yield(run, tmp_path, formulation):
    """A punched block, elastic, then partly and then largely plastic in three steps: each solve ends with squared residuals."""
    boundary = {"y0": {"fix": "xy"}, "y1": {"displacement": {"y": "-0.004*t*(1+X)"}}}
    result = solve(run, tmp_path, {**SET_B, "formulation": formulation}, 2, boundary, 3, [linspace(0, 1, 3), linspace(0, 1, 3)], None, "-snes_monitor", order=2)
    solves = steps(result)
    assert len(solves) == 3 and result.summary["plastic_strain"] > 0.005
    for residuals in solves:
        assert len(residuals) <= 9 and is_quadratic(residuals), residuals


def test_contact_slides_along_material_that_flows(run):
    """A bush pressed into a tight housing: what contact leaves behind unloads, what it comes to yields. (Without a first elastic tangent after
    the slide predictor, three cuts or more.)"""
    result = run("tests/verify/scenes/pressfit.yml")
    assert result.returncode == 0, result
    s = result.summary
    assert s["plastic_strain"] > 0.03 and s["contact"]["fit"]["max_pressure"] > 150, s
    assert s["step_cuts"] <= 1 and s["newton_iterations"] < 7 * s["load_steps"], s


def test_elastic_first(run):
    """Upsetting in large steps: where a step that begins as flow leads nowhere, one that begins elastic finds the solution (recovery predictor)."""
    scene = ("tests/gauntlet/upset.yml", "-load_end", 0.15, "-load_step", 0.15, "-load_step_min", 0.15, "-path_viscous", "off", "-adapt_tolerance", 0,
             "-newton_line_search", "off", "-output_fields", "false")  # which gets over it, too
    found, lost = (run(*scene, "-path_predictor", word) for word in ("auto", "off"))
    assert found.returncode == 0 and found.summary["recoveries"]["predictor"]["succeeded"] > 0 and found.summary["step_cuts"] == 0, found
    assert lost.returncode == 2, lost


@pytest.mark.parametrize("formulation", ["displacement", "mixed"])
def test_o94_tangent(run, formulation):
    """PETSc's difference quotients of the residual at every iterate but those on the yield surface itself, where steps start: a kink."""
    result = necking(run, 0.15, "-mesh_parameter_n", 2, "-material_steel_formulation", formulation, "-snes_test_jacobian")
    ratios = [float(value) for value in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+?),", result.stdout)]
    assert len(ratios) >= 9 and sum(value > 1e-6 for value in ratios) <= len(result.history) - 1, ratios


def test_steps_that_are_cut_leave_no_trace(run, tmp_path):
    """A first step far too long is halved until it converges; the run then equals, bit by bit, one that starts with the step that converged."""
    boundary = {"y0": {"fix": "xy"}, "y1": {"fix": "x", "displacement": {"y": "0.8*t"}}}
    def pulled(step, *options):
        return solve(run, tmp_path, SET_B, 2, boundary, 1, [linspace(0, 1, 4), linspace(0, 1, 4)], None, "-snes_max_it", 4, *options,
                     load={"step": step, "step_max": step, "step_min": 1e-4})
    cut = pulled(1)
    cuts = int(cut.history[0]["step_cuts"])
    assert cuts > 0
    plain = pulled(0.5 ** cuts, "-load_step_max", 1)
    for key in ("reaction.y1.y", "plastic.strain", "plastic.work", "energy"):
        assert cut.history[0][key] == plain.history[0][key]
    assert plain.history[0]["step_cuts"] == 0


def test_condensation_is_refused(run, tmp_path):
    write(tmp_path / "block.msh", [linspace(0, 1, 1)] * 2)
    scene = {"mesh": {"file": "block.msh"}, "model": "plane_strain", "body": {"body": {"material": "m"}}, "material": {"m": SET_B}, "boundary": {"y0": {"fix": "xy"}}}
    result = run("block.yml", "-solve_condense", "yes", text=json.dumps(scene))
    assert result.returncode == 1 and "-solve_condense yes: not with material m" in result.stderr


# ---- O-34: limit load of a strip with a hole ------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("n, most", [(4, 1.01), pytest.param(8, 1.004, marks=pytest.mark.slow)])
def test_o34_limit_load(run, tmp_path, n, most):
    """Mixed cells of order 2, 48 and 192 of them, come to rest at the limit load (case: 0.5 % below to 2 % above), from above by less the finer they are."""
    load = strip(run, tmp_path, n, 2, "mixed")
    print("over the exact limit load", load[-1] - 1, "last step", load[-1] - load[-2])
    assert 0.995 < load[-1] < most and abs(load[-1] - load[-2]) < 1e-4


@pytest.mark.parametrize("n, most", [(2, 1.02), pytest.param(4, 1.007, marks=pytest.mark.slow)])
def test_o34_limit_load_of_a_sheet(run, tmp_path, n, most):
    """Plane stress: 12 and 48 mixed cells of order 2 in space, half a sheet whose hole is 20 thicknesses wide."""
    load = strip(run, tmp_path, n, 2, "mixed", thickness=0.02)
    print("over the exact limit load", load[-1] - 1, "last step", load[-1] - load[-2])
    assert 0.995 < load[-1] < most and abs(load[-1] - load[-2]) < 1e-4


def test_softening_is_announced(run):
    options = ("-load_end", 0.01, "-mesh_parameter_n", 2, "-output_fields", "false", "-material_steel_hardening")
    assert "warning: the yield stress of material steel falls" in run("inputs/necking.yml", *options, -0.1).stdout
    assert "warning" not in run("inputs/necking.yml", *options, 0.1).stdout


def test_flow_error_does_not_feel_rotations(run, tmp_path):
    """A sheared block all of which flows, one step; then the same turned by 60 degrees in that step: what the step leaves is the same, and it is not nothing."""
    write(tmp_path / "box.msh", [[0, 0.5, 1]] * 2)
    told = []
    for angle in (0, 60):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        (a, b), (d, e) = (c, 0.1 * c - s), (s, 0.1 * s + c)  # the turn times [[1, 0.1], [0, 1]]
        move = {"x": f"t*({a - 1!r}*X + {b!r}*Y)", "y": f"t*({d!r}*X + {e - 1!r}*Y)"}
        scene = {"mesh": {"file": "box.msh"}, "model": "plane_strain", "order": 1, "body": {"body": {"material": "m"}},
                 "material": {"m": {"law": "j2", "volumetric": "simo", "E": 200, "nu": 0.3, "yield": 1, "hardening": 10, "formulation": "displacement"}},
                 "boundary": {side: {"displacement": move} for side in ("x0", "x1", "y0", "y1")}, "load": {"step": 1, "step_min": 1}, "output": {"fields": False}}
        result = run("box.yml", text=json.dumps(scene))
        assert result.returncode == 0 and result.summary["load_steps"] == 1, result
        told.append(result.summary["flow_error"])
    assert told[0] > 1e-4 and told[1] == pytest.approx(told[0], rel=1e-6), told


@pytest.mark.parametrize("step", [1, 0.1, 0.05])
def test_flow_error_where_a_step_begins_elastic(run, step):
    """A tube expanded into a ring by pressure, and unloaded: the ratio of its stresses is elastic first, and relaxes along the tube as it flows. Straight from
    start to end it would be the same all the way. Told against the axial force of 1600 steps, 1000 of them while it flows."""
    result = run("tests/verify/scenes/tube_in_ring.yml", "-output_fields", "false", "-load_step", step, "-load_step_max", step)
    error, told = abs(0.52902 / result.summary["reaction"]["y1"][1] - 1), result.summary["flow_error"]
    print("error", error, "told", told)
    assert result.returncode == 0 and 1 / 3 < told / error < 3


INDENT = """
mesh: {file: %s, order: 2}
model: plane_strain
order: 2
body: {block: {material: m}, punch: {material: r, motion: {y: "-0.1*t"}}}
material: {r: {law: rigid}, m: {law: j2, E: 1000, nu: 0.3, yield: 2, hardening: 0}}
boundary: {bottom: {fix: y}, middle: {fix: x}}
contact: {c: {nonmortar: top, mortar: skin}}
load: {step: 0.1}
adapt: {tolerance: 0.8, repeat: path}
"""


def test_estimate_where_material_flows(run):
    """Stresses at the nodes of the mesh against those of cells of a quarter and a half of the size, in the norm of their energy: the estimate is within a factor of 3.
    It was 4 to 13 times the error while volume and gaps that are not seen met the stiffness of the virgin material."""
    E, nu = 200, 0.3
    results = [run("tests/verify/scenes/dent_flow.yml", "-mesh_parameter_k", k, "-load_end", 0.4) for k in (1, 2, 4)]
    states, fine = [mortise.Run(result.directory).state("bulk") for result in results], {}
    for X, stress in zip(states[2].X, states[2].point["stress"]): fine.setdefault(tuple(numpy.round(X, 9)), []).append(stress)
    for result, state in zip(results[:2], states):
        square = 0
        for corners in state.cells:
            x = state.X[corners]
            area = abs(numpy.cross(x[2, :2] - x[0, :2], x[3, :2] - x[1, :2])) / 2
            for node in corners:
                d = state.point["stress"][node] - numpy.mean(fine[tuple(numpy.round(state.X[node], 9))], axis=0)
                full = numpy.array([[d[0], d[1], d[2]], [d[1], d[3], d[4]], [d[2], d[4], d[5]]])
                square += area / 4 * ((1 + nu) * (full**2).sum() - nu * full.trace()**2) / (2 * E)
        error, told = math.sqrt(square / results[2].summary["energy"]), result.summary["estimated_error"]
        print(error, told)
        assert error / 3 < told < 3 * error


def test_metal_does_not_lock(run):
    """A billet is upset: the elastic energy of cells of orders 1 and 2 is that of order 3 on half of their size, 0.01689. Without pressures of its own: 0.0322 and 0.0193."""
    for order in (1, 2):
        result = run("tests/gauntlet/upset.yml", "-adapt_tolerance", 0, "-load_step", 0.1, "-order", order, "-output_fields", "false")
        assert result.summary["energy"] == pytest.approx(0.01689, rel=0.006), result.summary["energy"]


def test_refined_cells_keep_the_pressures_of_flow(run):
    """A billet adapts for the first time at the end of its way. Its volume was not seen by the coarser cells where it is by the finer ones: not settled, the force fell by 4 %."""
    result = run("tests/gauntlet/forge.yml", "-output_fields", "false")
    passes = [row for row in result.adapt if row["pass"]]
    assert passes and passes[0]["t"] == 1 and all(row["force_change"] < 0.006 for row in passes), passes
    assert result.summary["energy"] == pytest.approx(0.13246, rel=2e-3)


def test_upright_side_of_a_punch(run):
    """It is over a node of the block, and the gap there is open, while the node before it bears: forces of ends that are held do not jump (frozen_segmentation)."""
    result = run("indent.yml", text=INDENT % (SCENES / "indent.geo"))
    print(result.summary["newton_iterations"], result.summary["reaction"])
    assert result.solved and result.summary["t"] == 1 and result.summary["step_cuts"] == 0, result


def test_node_that_is_left(run):
    """A sliver over a node has a weight below 0 by round-off, and none after the step: its force is not carried over (carried_force), or the residual is no number."""
    result = run("indent.yml", "-order", 3, "-newton_frozen_segmentation", "off", "-info", text=INDENT % (SCENES / "indent.geo"))
    assert "is no number" not in result.stdout
