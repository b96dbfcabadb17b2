"""Rows of docs/stability.md that build their scenes, or compare more than one switch."""
import json
import math

import numpy
import pytest

from kit import ROOT, end, plain, run, told, way  # noqa: F401
from boxmesh import linspace, write
from contactkit import bulk, components, contact
import test_contact_patch as patch
import test_contact_shrinkfit as shrinkfit
import test_friction as friction
import test_plastic as plastic
import textbook

QUIET = ("-output_fields", "false")


def block(run, tmp_path, breaks, material, boundary, to=lambda *x: x, **keys):
    """One body of a box mesh."""
    write(tmp_path / "box.msh", breaks, to)
    scene = {"mesh": {"file": "box.msh"}, "model": "plane_strain", "order": 1, "body": {"body": {"material": "m"}}, "material": {"m": material}, "boundary": boundary,
             "load": {"step": 1}, "output": {"fields": False}, **keys}
    return run("box.yml", text=json.dumps(scene))


@way("Thin cells lock in bending: a cantilever 100 : 1, twenty cells long", "deflection of the tip / that of beam theory", "order 3", "order 1, displacements alone")
def test_thin_cells(run, told, tmp_path):
    L, E, nu, load = 100.0, 1e7, 0.3, 1e-3
    exact = load * L ** 3 / 3 / (E / (1 - nu ** 2) / 12)
    tip = []
    for order in (3, 1):
        result = block(run, tmp_path, [linspace(0, L, 20), [0, 1]], {"law": "linear", "E": E, "nu": nu, "formulation": "displacement"},
                       {"x0": {"fix": "xy"}, "x1": {"traction": {"y": -load}}}, kinematics="small", order=order, probe={"tip": {"x": L, "y": 0.5}})
        assert result.returncode == 0, result
        tip.append(-result.summary["probe"]["tip"]["displacement"][1] / exact)
    told(*tip, picture={"kind": "bars", "x": "deflection / that of beam theory", "values": tip})
    assert abs(tip[0] - 1) < 5e-3 and tip[1] < 0.2


@way("A law that gives way under compression: a block to a third of its height", "force at 1/3 of the height / at 2/3", "neo_hookean, log", "saint_venant_kirchhoff", kind="curves")
def test_law_that_gives_way(run, told, tmp_path):
    ratio, ends = [], []
    for law in ({"law": "neo_hookean", "volumetric": "log"}, {"law": "saint_venant_kirchhoff"}):
        result = block(run, tmp_path, [linspace(0, 1, 4)] * 2, {**law, "E": 1, "nu": 0.3}, {"x0": {"fix": "x"}, "x1": {"fix": "x"}, "y0": {"fix": "y"}, "y1": {"displacement": {"y": -2 / 3}}},
                       load={"step": 0.1, "stable": False})
        force = {round(row["t"], 6): -row["reaction.y1.y"] for row in result.history}
        ends.append(result)
        ratio.append(force[1.0] / force[0.5] if 1.0 in force and 0.5 in force else end(result))
    lines = {name: ([1 - 2 / 3 * row["t"] for row in result.history], [-row["reaction.y1.y"] for row in result.history]) for name, result in zip(("as it is", "the other way"), ends)}
    told(*ratio, picture={"x": "height", "y": "force", "lines": lines})
    assert ends[0].returncode == 0 and ratio[0] > 2
    assert ends[1].returncode == 2 or ratio[1] < 1


@way("Small kinematics under a large rotation: a block turned by 60 degrees", "largest stress / E", "kinematics: finite", "kinematics: small")
def test_large_rotation(run, told, tmp_path):
    stress = []
    for law, kinematics in (("neo_hookean", "finite"), ("linear", "small")):
        result = block(run, tmp_path, [linspace(0, 1, 4)] * 2, {"law": law, "E": 1, "nu": 0.3}, {"y0": {"rotation": {"angle": "60*t", "point": {"x": 0, "y": 0}}}}, kinematics=kinematics,
                       load={"step": 0.1}, probe={"middle": {"x": 0.5, "y": 0.05}})
        assert result.returncode == 0, result
        stress.append(max(map(abs, result.summary["probe"]["middle"]["stress"])))
    told(*stress)
    assert stress[0] < 1e-9 and stress[1] > 0.3


@way("Facets on a round surface eat an interference of 0.1 % (shrink fit)", "mean pressure / exact", "initial_gap: adjust", "initial_gap: keep, order 1")
def test_gaps_of_facets(run, told):
    means = [shrinkfit.fit(run, 6)[1], shrinkfit.fit(run, 6, "-contact_fit_initial_gap", "keep", "-order", 1)[1]]
    told(*means)
    assert abs(means[0] - 1) < 3e-3 and means[1] < 0.01


@pytest.mark.slow
@way("Faces graded 1 : 64 through hanging nodes", "error of the stress", "mortar", "node_to_segment: true")
def test_graded_faces(run, told):
    error = [patch.strongly_graded(run, "lower"), patch.strongly_graded(run, "lower", node_to_segment=True)]
    told(*error)
    assert error[0] < 1e-8 and error[1] > 0.1


def drop_off(run, **pair):
    """A punch whose outline cuts faces of the side that carries the pressure (O-43): error of the stress in the punch, away from its foot."""
    body = patch.linear(1000, 0.3)
    scene = patch.blocks("lower", {"lower": body, "upper": body}, {**patch.TAYLOR, "lower_top": {"traction": {"y": "-(" + patch.outside(5) + ")"}}},
                         {**patch.FOUNDATION, "nl": 5, "nu": 3}, pair=pair, kinematics="small")
    result = run("punch.yml", text=scene)
    if result.returncode:
        return end(result), None
    told_pair = result.summary["contact"]["pair"]
    state = bulk(result)
    centre = state["X"][state["cells"].astype(int)].mean(axis=1)
    cut = (numpy.abs(centre[:, 0] - 1) < 3 / 5) | (numpy.abs(centre[:, 0] - 2) < 3 / 5)
    error = numpy.abs(components(state["stress"]) - [0, 0, -1]).max(axis=1)
    return float(error[(centre[:, 1] < 1) & ~cut].max()), told_pair


@way("Faces covered in part: the outline of a punch cuts faces", "error of the stress below", "mortar", "node_to_segment: true")
def test_covered_in_part(run, told):
    ours, naive = drop_off(run)[0], drop_off(run, node_to_segment=True)[0]
    told(ours, naive)
    assert ours < 1e-8 and (isinstance(naive, str) or naive > 1e-3)


@pytest.mark.slow
@way("The sides exchange their roles: half a disc on a block, linear faces", "change of the force", "mortar", "node_to_segment: true", show=(0, 2))
def test_sides_swapped(run, told):
    scene = ("inputs/hertz2d.yml", "-order", 1, "-contact_disc_on_block_order", 1, "-adapt_tolerance", 0, "-mesh_refine", 2, "-boundary_top_displacement_y", -0.3,
             "-load_step_min", 0.25, *QUIET)
    change = []
    for switch in ((), ("-contact_disc_on_block_node_to_segment", "true")):
        results = [run(*scene, *switch, *words) for words in ((), ("-contact_disc_on_block_nonmortar", "block_top", "-contact_disc_on_block_mortar", "disc_surface"))]
        failed = [result for result in results if result.returncode]
        force = [result.summary["reaction"]["top"][1] for result in results]
        change.append(end(failed[0]) + f" with {2 - len(failed)} of the two" if failed else abs(force[1] / force[0] - 1))
    told(*change)
    assert change[0] < 2e-3 and isinstance(change[1], str)


@pytest.mark.slow
@way("Ripple as a round body slides over facets", "(largest - least) / mean force", "mortar", "node_to_segment: true")
def test_ripple(run, told):
    ripple, lines = [], {}
    for switch in ((), ("-contact_disc_on_block_node_to_segment", "true", "-contact_disc_on_block_order", 1)):
        result = run("inputs/slide2d.yml", "-adapt_tolerance", 0, "-load_step", 0.05, "-load_step_max", 0.05, "-load_step_min", 0.01, "-mesh_parameter_n", 8, *switch, *QUIET)
        force = numpy.array([-row["reaction.top.y"] for row in result.history if row["t"] > 1 - 1e-9])
        lines[f"faces: {'as it is' if not switch else 'the other way'}"] = [row["t"] for row in result.history][-len(force):], force
        ripple.append(float(numpy.ptp(force) / force.mean()) if result.returncode == 0 else end(result))
    told(*ripple, picture={"kind": "curves", "x": "t", "y": "force", "lines": lines})
    assert ripple[0] < 0.02 and (isinstance(ripple[1], str) or ripple[1] > 3 * ripple[0])


@way("A plane of symmetry through the contact (cross points): half a disc against the whole", "change of the force", "both models",
     "springs along averaged normals, 16 chords on the half")
def test_plane_of_symmetry(run, told):
    force = [run(f"tests/gauntlet/{name}_disc.yml", "-adapt_tolerance", 0, *QUIET).summary["reaction"]["top"][1] for name in ("half", "full")]
    leaning = {n: abs(1 - numpy.divide(*textbook.averaged_normals(n))) for n in (8, 16, 32, 64)}
    ours = abs(2 * force[0] / force[1] - 1)
    told(ours, leaning[16], picture={"kind": "curves", "x": "chords on the half", "y": "change of the force", "log": True,
                                     "lines": {"as it is": (list(leaning), [max(ours, 1e-16)] * 4), "the other way": (list(leaning), list(leaning.values()))}})
    assert ours < 1e-9 and leaning[16] > 1e-4


@way("Rigid-body modes: a block that only contact holds up flies off, 'converged' but out of balance", "1 - force / load", "-newton_proximal_shift auto", "-newton_proximal_shift off")
def test_rigid_body_modes(run, told):
    scene = (ROOT / "inputs" / "patch2d.yml").read_text().replace("file: patch2d.geo", f"file: {ROOT}/inputs/patch2d.geo")
    key = "top:    {displacement: {y: -0.1}}"
    assert key in scene
    scene = scene.replace(key, "top:    {traction: {y: -0.05}}").replace("contact:\n  upper_on_lower: {", "contact:\n  upper_on_lower: {interference: -0.05, ")
    results = [run("weight.yml", *switch, *QUIET, text=scene) for switch in ((), ("-newton_proximal_shift", "off", "-path_descent", "off", "-path_viscous", "off"))]
    shown = [abs(r.summary["reaction"]["bottom"][1] / 0.05 - 1) if r.returncode == 0 else end(r) for r in results]
    told(*shown, picture={"kind": "bars", "x": "force / load", "values": [abs(r.summary["reaction"]["bottom"][1] / 0.05) for r in results]})
    assert results[0].returncode == 0 and shown[0] < 1e-8
    assert results[1].returncode == 2 or shown[1] > 0.9


@pytest.mark.slow
@way("Partial slip depends on the path: pressed and moved along at once, or one after the other", "tangential over normal force", "pressed, then moved, twenty steps", "both in one step")
def test_path_of_slip(run, told):
    text = friction.disc("disc", 2, 0.3).replace("0.5*max(t - 1, 0)", "0.02*max(t - 1, 0)")
    ours, fine = (run("disc.yml", "-load_step", step, text=text) for step in (0.1, 0.05))
    naive = run("disc.yml", text=text.replace("0.02*max(t - 1, 0)", "0.01*t").replace("-0.1*min(t, 1)", "-0.05*t").replace("step: 1", "step: 2"))
    share = [abs(result.summary["contact"]["pair"]["force"][0] / result.summary["contact"]["pair"]["force"][1]) for result in (ours, fine, naive)]
    told(f"{share[0]:.4g} (half the steps: {share[1]:.4g})", share[2], picture={"kind": "bars", "x": "tangential over normal force", "values": [share[0], share[2]]})
    assert share[0] == pytest.approx(share[1], rel=0.02) and abs(share[2] / share[1] - 1) > 0.03


@way("Onset of sliding at a friction of 0.8: an incline of the angle of friction", "stays at 1 - 1e-6 of it, slides at 1 + 1e-6; velocity at half of it", "law: coulomb",
     "Coulomb's law smoothed over a velocity v0, tanh(v / v0)")
def test_onset_of_sliding(run, told):
    below, above = friction.incline(run, 0.8, 1 - 1e-6, 1), friction.incline(run, 0.8, 1 + 1e-6, 1)
    creeps, shares = textbook.smoothed_friction(0.5), [0.02 * k for k in range(50)] + [1 - 1e-6]
    told(f"{'stays' if below.returncode == 0 else 'slides'}, {'slides' if above.returncode == 2 else 'stays'}; 0", f"slides; {creeps:.2g} v0",
         picture={"kind": "curves", "x": "angle / angle of friction", "y": "velocity / v0",
                  "lines": {"as it is": ([0, 1 - 1e-6, 1 + 1e-6], [0, 0, 8]), "the other way": (shares, [textbook.smoothed_friction(share) for share in shares])}})
    assert below.returncode == 0 and above.returncode == 2 and creeps > 0.1


@way("Friction above 1: pressed, then slid in one step with mu = 2", "largest traction / (mu p), steps cut; change of the pressures from pass to pass", "law: coulomb",
     "contact and friction in turn: the bound from the pressures before (a block, 16 x 8 cells)")
def test_friction_above_one(run, told):
    result = run("disc.yml", text=friction.disc("disc", 2, 2))
    pressure, traction = friction.tractions(result)
    share = float((traction / numpy.maximum(pressure, 1e-9))[pressure > 1e-3 * pressure.max()].max() / 2)
    force, factor = textbook.friction_in_turn(2)
    told(f"{share:.6g}, {result.summary['step_cuts']}", f"diverges, x {factor:.3g}",
         picture={"kind": "curves", "x": "pass", "y": "normal force", "lines": {f"the other way, mu = {mu:g}": (range(25), textbook.friction_in_turn(mu, passes=25)[0]) for mu in (1, 1.5, 2)}})
    assert result.returncode == 0 and result.summary["step_cuts"] == 0 and share < 1 + 1e-6 and factor > 1


@way("The load is on in one step while material flows (bar necks): what the step leaves", "force / that of fine steps - 1; told", "flow_error of summary.json: against small steps on the same way",
     "the residual of Newton's method is all that is told")
def test_step_error_of_flow(run, told):
    steps = (0.002, 0.1, 0.05)
    fine, *coarse = (run("inputs/necking.yml", "-load_end", 0.1, "-load_step", step, "-load_step_max", step, *QUIET) for step in steps)
    error = [abs(result.summary["reaction"]["end"][1] / fine.summary["reaction"]["end"][1] - 1) for result in coarse]
    found = [result.summary["flow_error"] for result in coarse]
    told(f"{error[0]:.4g}; {found[0]:.4g}", f"{error[0]:.4g}; 1e-10",
         picture={"kind": "curves", "x": "load step", "y": "relative error", "log": True,
                  "lines": {"error of the force": (steps[1:], error), "told": (steps[1:], found), "the other way: residual": (steps[1:], [1e-10] * 2)}})
    for result, true, estimate in zip(coarse, error, found):
        assert result.returncode == 0 and true / 3 < estimate < 3 * true


@way("Inf-sup of contact, cells of order 2: the fine face of a body 1e5 times as stiff carries multipliers of full order", "largest alternation / mean of the pressures; error of the force",
     "roles: auto", "roles: given, stabilise: false", kind="curves")
def test_multipliers_finer_than_what_gives(run, told):
    """A stiff face does not give, and what gives is the coarse face of the soft body: more constraints than it has freedom, whose pressures alternate and do not fall with the mesh."""
    shown, lines = [], {}
    for n, roles in ((3, "auto"), (9, "auto"), (3, "given"), (9, "given")):
        result = run("tests/gauntlet/press.yml", "-adapt_tolerance", 0, "-mesh_parameter_n", n, "-contact_c_roles", roles, "-contact_c_stabilise", "false")
        assert result.returncode == 0, result
        state = contact(result)
        place, first = numpy.unique((state["X"][:, 0] + state["displacement"][:, 0]).round(9), return_index=True)
        pressure = state["contact_pressure"][first]
        place, pressure = place[pressure > 0], pressure[pressure > 0]
        shown.append((float(numpy.abs(pressure[1:-1] - (pressure[:-2] + pressure[2:]) / 2).max() / pressure.mean()), abs(result.summary["reaction"]["top"][1] / -0.29497 - 1)))
        if n == 9: lines["as it is" if roles == "auto" else "the other way"] = place, pressure
    print(shown)
    told(*(f"{shown[k][0]:.2g}; {shown[k][1]:.2g}" for k in (1, 3)), picture={"x": "x", "y": "pressure", "lines": lines})
    assert max(shown[0][0], shown[1][0]) < 0.15
    assert shown[3][0] > 1 and shown[3][0] > 5 * shown[2][0]


@pytest.mark.slow
@way("A mesh adapts while material flows (bar necks): what new points know of the flow", "largest change of the force as a mesh adapts; force / 59.324 - 1", "adapt.history: carried",
     "adapt.history: nearest; none")
def test_history_across_adaptation(run, told):
    """The flow of the nearest old point leaves new cells out of balance, and no flow at all makes them hard again: either is a force that adaptation makes, and stays."""
    change, error, lines = [], [], {}
    for history in ("carried", "nearest", "none"):
        result = run("inputs/necking.yml", *plastic.ADAPTIVE, "-load_end", 5 / 7, "-adapt_history", history, *QUIET)
        assert result.summary["t"] == pytest.approx(5 / 7), result
        change.append(max(row["force_change"] for row in result.adapt if row["pass"] > 0))
        error.append(plastic.at(result, 5)[0] / plastic.SATURATION[5][0] - 1)
        lines[history] = [7 * row["t"] for row in result.history], [row["reaction.end.y"] for row in result.history]
    print(change, error)
    told(f"{change[0]:.2g}; {error[0]:.2g}", f"{change[1]:.2g}; {error[1]:.2g}; none: {change[2]:.2g}; {error[2]:.2g}",
         picture={"kind": "curves", "x": "elongation", "y": "force", "lines": lines})
    assert change[0] < 5e-4 and abs(error[0]) < 1e-3
    assert min(change[1:]) > 0.03 and min(map(abs, error[1:])) > 0.01


@pytest.mark.slow
@way("A mesh adapts in mid-slide: half a disc pressed and drawn in one step each, friction 0.3", "slip at the end; work of friction / that of a fine mesh - 1", "adapt.history: carried",
     "adapt.history: none, slip counts from the solution on the coarser mesh")
def test_refinement_is_no_slip(run, told):
    text = friction.disc("disc", 2, 0.3)
    fine, *adapted = (run("disc.yml", *options, *QUIET, text=text) for options in (("-mesh_refine", 2), *(("-adapt_tolerance", 0.02, "-adapt_history", way) for way in ("carried", "none"))))
    pairs = [result.summary["contact"]["pair"] for result in (fine, *adapted)]
    slip, work = ([pair[name] for pair in pairs] for name in ("max_slip", "dissipation"))
    told(*(f"{slip[k]:.4g}; {work[k] / work[0] - 1:.2g}" for k in (1, 2)), picture={"kind": "bars", "x": "work of friction / that of a fine mesh", "values": [w / work[0] for w in work[1:]]})
    assert all(result.returncode == 0 for result in adapted) and all(any(row["pass"] > 0 for row in result.adapt if row["step"] == 2) for result in adapted)
    assert slip[1] == pytest.approx(slip[0], rel=5e-3) and abs(work[1] / work[0] - 1) < 1e-3
    assert slip[2] < 0.01 * slip[0] and work[2] < 0.01 * work[0]


@way("A body folds onto itself", "legs of the horseshoe pass through each other", "pair of one surface: {surface: inside}", "no such pair: what is in none is not in contact",
     show=(0, 1))
def test_fold(run, told):
    """Until the legs lie on each other over most of their length. Beyond, the upper one is driven out, and its end, which is not of the pair, meets the other leg."""
    scene = (ROOT / "tests" / "gauntlet" / "fold.yml").read_text().replace("file: fold.geo", f"file: {ROOT}/tests/gauntlet/fold.geo")
    key = "contact: {"
    assert key in scene
    text = scene.replace(key, key + "gap: {surface: inside}, ")
    pair = run("fold.yml", "-load_end", 0.75, *QUIET, text=text)
    none = run("tests/gauntlet/fold.yml", *QUIET)
    said = any("self" in str(word) for word in none.summary["warnings"])
    told("no" if pair.summary["contact"]["gap"]["min_gap"] > -1e-3 else "yes", "yes; a warning says so" if said else "yes")
    assert pair.returncode == 0 and pair.summary["contact"]["gap"]["min_gap"] > -1e-3 and pair.summary["contact"]["gap"]["max_pressure"] > 0
    assert none.returncode == 0 and said
    for step in (0.05, 0.01):
        finer = run("fold.yml", "-load_end", 0.75, "-load_step", step, *QUIET, text=text)
        assert finer.returncode == 0 and finer.summary["energy"] == pytest.approx(pair.summary["energy"], rel=1e-9)


@way("A corner of a soft block is drawn over a rigid plane, friction 0.5, eight cells along its foot: all of it slips", "tangential over normal force", "law: coulomb", "multiplier: standard")
@pytest.mark.xfail(strict=True, reason="the pressure at the corner that digs in is normal to the block's faces there, not to the plane")
def test_corner_that_digs_in(run, told):
    result = run("tests/benchmarks/drawn.yml", "-mesh_parameter_n", 8, "-load_end", 0.4, *QUIET)
    last = result.history[-1]
    share = abs(last["contact.c.force.x"] / last["contact.c.force.y"])
    naive = run("tests/benchmarks/drawn.yml", "-mesh_parameter_n", 8, "-load_end", 0.4, "-contact_c_multiplier", "standard", *QUIET)
    lines = {name: ([row["t"] for row in rows], [abs(row["contact.c.force.x"] / row["contact.c.force.y"]) for row in rows])
             for name, rows in (("as it is", result.history[1:]), ("the other way", naive.history[1:]))}
    told(share, lines["the other way"][1][-1], picture={"kind": "curves", "x": "t", "y": "share of friction", "lines": lines})
    assert result.returncode == 0 and last["contact.c.sticking_nodes"] == 0
    assert share == pytest.approx(0.5, rel=1e-3)
