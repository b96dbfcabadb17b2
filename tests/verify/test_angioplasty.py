"""Balloon, sleeve and artery in the cross-section (O-70, inputs/angioplasty2d.yml): three bodies, two gaps that open and close, plastic flow and recoil; exact
answer. Pressures to 1 %, resultants and at every node, radii to 0.2 %, recoil to 5 %, plastic strain at both faces of the sleeve; uniform and adapted meshes of orders
1 and 2 of the quarter and of the full ring, curved contact faces and linear ones, coarser load steps, roles of the contact faces exchanged (O-91), ranks; and how the
sleeve is about to neck."""
import math

import numpy
import pytest

STATES = [  # t; radius of the bore; pressure in it, balloon on sleeve, sleeve on artery; outer radii of sleeve and artery; plastic strain at bore and outside of the sleeve
    (.10, .50, 34.27432, 27.25142, 0, .6782330, 1.1000000, .06090, .04265),
    (.35, .75, 32.23686, 20.33993, 1.21349, .8789198, 1.2158947, .43534, .34055),
    (.50, .90, 30.76529, 18.13008, 2.46254, 1.0099505, 1.3137351, .62009, .50025),
    (.60, 1.0, 30.74063, 17.85661, 4.03201, 1.1000000, 1.3841604, .73014, .59841),
    (.70, 1.1, 32.72668, 19.68809, 7.41197, 1.1916375, 1.4580466, .83137, .69037),
    (1.4, .40, 0, 0, 6.64698, 1.1767998, 1.4459453, .83137, .69037),
]
RECOIL = 0.012451
LINEAR1, LINEAR2 = (("-order", order, "-contact_inside_order", 1, "-contact_outside_order", 1) for order in (1, 2))  # the scene's contact faces are curved
SUBDIVIDED = (*LINEAR2, "-contact_inside_subdivide", 1, "-contact_outside_subdivide", 1)
EXCHANGED = ("-contact_inside_nonmortar", "sleeve_bore", "-contact_inside_mortar", "balloon_skin",
             "-contact_outside_nonmortar", "sleeve_skin", "-contact_outside_mortar", "artery_bore", "-contact_inside_roles", "given", "-contact_outside_roles", "given")
FINE1 = (*LINEAR1, "-mesh_refine", 1)
ADAPTIVE1, ADAPTIVE2 = (*FINE1, "-adapt_tolerance", 0.05, "-adapt_alike", 0.7), ("-adapt_tolerance", 0.0012)
POLYGONS2, FINER_POLYGONS2 = ((*LINEAR2, "-adapt_tolerance", tolerance) for tolerance in (0.0125, 0.006))
RING = ("-mesh_parameter_sectors", 4)
LARGE = ("-load_step", 0.2)
AGAIN = ("-adapt_repeat", "path", "-adapt_alike", 0.5)
POLYGON = pytest.mark.xfail(reason="the sleeve flows as the polygon of the coarser faces, which finer ones on the way back feel: 2 to 7 % of the pressures at single nodes")
RIPPLE = pytest.mark.xfail(reason="linear faces of split and whole cells in turn: pressures at single nodes alternate by 1.7 % where 1 % is asked")
PRESSURE, RADIUS = 0.01, 0.002  # tolerances
RMS = 0.007  # of the pressures at the nodes


def solve(run, *options, **keywords):
    result = run("inputs/angioplasty2d.yml", "-adapt_max_cells", 10000, *options, **keywords)
    assert result.returncode == 0, result
    return result


def figures(row, radius):
    """As in STATES, of a row of the history of a quarter; pressures are resultants over radii."""
    balloon, sleeve, artery = (r + row[f"probe.{name}.displacement.x"] for name, r in (("balloon", .5), ("sleeve", .65), ("artery", 1.1)))
    strains = (row[f"probe.{name}.plastic_strain"] for name in ("sleeve_bore", "sleeve"))
    return row["reaction.bore.x"] / radius, abs(row["contact.inside.force.x"]) / balloon, abs(row["contact.outside.force.x"]) / sleeve, sleeve, artery, *strains


def states(result):
    """{t: figures} of the states that the history has."""
    return {t: figures(row, radius) for t, radius, *_ in STATES for row in result.history if abs(row["t"] - t) < 1e-9}


def nodal(result):
    """{t: [pressures at all nodes that have a multiplier, inside; outside; radii at all nodes of the sleeve's skin]} of the states; of passes at one time the last."""
    found = {}
    for time, state in result.states("contact"):
        for t, *_ in STATES:
            if not 0 <= time - t < 2e-5:
                continue
            x = state["X"] + state["displacement"]
            inside, outside, skin = (numpy.unique(state["cells"][(state["pair"] == pair) & on]) for pair, on in
                                     ((0, state["side"] == 0), (1, state["side"] == 0), (1, numpy.isclose(numpy.hypot(*state["X"][state["cells"][:, 0], :2].T), .65, atol=5e-3))))
            found[t] = state["contact_pressure"][inside], state["contact_pressure"][outside], numpy.hypot(*x[skin, :2].T)
    return found


def accurate_everywhere(result, pressure=PRESSURE, back=PRESSURE, rms=RMS):
    """Pressures (back: where the balloon has gone) and radii at every node, pressures also in the mean square."""
    found = nodal(result)
    assert found.keys() >= {row[0] for row in STATES if row[0] <= result.history[-1]["t"]}, found.keys()
    for t, values in found.items():
        reference = next((row[3], row[4], row[5]) for row in STATES if row[0] == t)
        errors = [value / ref - 1 if ref else value for value, ref in zip(values, reference)]
        print(t, *("%d nodes %+.1e .. %+.1e rms %.1e;" % (e.size, e.min(), e.max(), (e**2).mean()**.5) for e in errors))
        for k, (e, ref) in enumerate(zip(errors, reference)):
            bound = RADIUS if k == 2 else 1e-3 if not ref else back if t > 1 else pressure
            assert abs(e).max() < bound and (e**2).mean()**.5 < rms * bound / pressure, (t, k, e)


def accurate(result, strains, **local):
    """A quarter: resultants, radii, plastic strains to a share, and accurate_everywhere."""
    found = states(result)
    assert set(found) == {row[0] for row in STATES}, found  # load steps end at the times of the amplitude, whatever was cut
    for t, radius, *reference in STATES:
        print(t, ["%+.1e" % (value / ref - 1 if ref else value) for value, ref in zip(found[t], reference)])
        for k, (value, ref) in enumerate(zip(found[t], reference)):
            assert abs(value - ref) <= (PRESSURE, PRESSURE, PRESSURE, RADIUS, RADIUS, strains, strains)[k] * ref + 1e-3 * (ref == 0), (t, k, value, ref)
    recoil = 1 - found[1.4][3] / found[.7][3]
    assert abs(recoil / RECOIL - 1) < 0.05, recoil
    accurate_everywhere(result, **local)


def adapted(result, first):
    cells = {row["cells"] for row in result.adapt}
    assert min(cells) == first < max(cells), cells


def test_o70_steps_four_times_larger(run):
    """No step is cut, not even where the flow ends and the balloon leaves."""
    result = solve(run, *LARGE)
    accurate(result, 0.03, rms=0.009)
    assert result.summary["step_cuts"] == 0, result


@pytest.mark.slow
@pytest.mark.parametrize("options", [ADAPTIVE1, ADAPTIVE2, ("-adapt_tolerance", 0.0005), FINER_POLYGONS2], ids=["order_1", "order_2", "order_2_after_flow", "order_2_linear_faces"])
def test_o70_adaptive_steps_four_times_larger(run, options):
    result = solve(run, *options, *LARGE)
    accurate(result, 0.04, rms=0.009)
    adapted(result, 720 if options is ADAPTIVE1 else 180)


@pytest.mark.slow
@pytest.mark.parametrize("options, strains", [((), 0.003), (FINE1, 0.03), (SUBDIVIDED, 0.02)], ids=["order_2", "order_1", "linear_faces"])
def test_o70(run, options, strains):
    result = solve(run, *options)
    accurate(result, strains)
    assert result.summary["step_cuts"] == 0, result


@pytest.mark.slow
@pytest.mark.parametrize("tolerance, last", [(0.00117, 1.3), (0.00045, 0.7), (0.0003, 0.65)])
def test_o70_adaptive(run, tolerance, last):
    """Order 2; histories are carried from mesh to mesh, also after the balloon has left (last: when cells are split for the last time)."""
    result = solve(run, "-adapt_tolerance", tolerance)
    accurate(result, 0.003)
    adapted(result, 180)
    assert abs(max(row["t"] for row in result.adapt if row["pass"]) - last) < 1e-9, result


@pytest.mark.slow
@pytest.mark.parametrize("options, tolerance, back", [(LINEAR2, 0.01, 0.07), (LINEAR2, 0.008, 0.04), (LINEAR2, 0.006, PRESSURE), pytest.param(SUBDIVIDED, 0.0046, PRESSURE, marks=POLYGON)],
                         ids=["0.01", "0.008", "0.006", "subdivided_0.0046"])
def test_o70_adaptive_linear_faces(run, options, tolerance, back):
    """Linear faces before cells of order 2. Where faces of sleeve and artery are split on the way back, the polygon as which the sleeve has flowed stays, 5e-5 of the
    radius, and the artery's finer faces feel it, against 8000 of shear modulus 6 % of the pressure at single nodes (back)."""
    result = solve(run, *options, "-adapt_tolerance", tolerance)
    accurate(result, 0.03, back=back)
    adapted(result, 180 if options is LINEAR2 else 432)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.03, 0.015, 0.0125, 0.008])
def test_o70_adaptive_linear_faces_path_again(run, tolerance):
    """Where the sleeve flows on the mesh that it has at the end, its faces are right at every node there and back."""
    result = solve(run, *LINEAR2, *AGAIN, "-adapt_tolerance", tolerance)
    accurate(result, 0.03)
    adapted(result, 180)
    assert result.summary["step_cuts"] == 0 and max(row["estimated_error"] for row in result.history) <= tolerance, result


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [pytest.param(0.05, marks=RIPPLE), pytest.param(0.03, marks=RIPPLE), 0.014])
def test_o70_adaptive_order_1(run, tolerance):
    result = solve(run, *FINE1, "-adapt_tolerance", tolerance)
    accurate(result, 0.03)
    adapted(result, 720)


@pytest.mark.slow
def test_o70_is_beyond_bifurcations(run):
    """What a small load cos(n a) on the sleeve does to its thickness grows without bounds and comes back from the other side where the even ring loses its uniqueness:
    for n = 8 on the way from t = 0.2 to 0.25, for n = 16 from 0.45 to 0.5, for n = 24 and more nowhere."""
    def thinning(n):
        paths = []
        for load in (1e-3, -1e-3):
            traction = f"{load}*cos({n}*atan2(Y,X))*"
            result = solve(run, "-output_fields", "false", "-load_end", 0.5, "-boundary_sleeve_skin_traction_x", traction + "X/0.65", "-boundary_sleeve_skin_traction_y", traction + "Y/0.65")
            assert result.summary["step_cuts"] == 0, result
            paths.append({round(row["t"], 6): row["probe.sleeve.displacement.x"] - row["probe.sleeve_bore.displacement.x"] for row in result.history})
        return {t: (paths[0][t] - paths[1][t]) / 2 for t in paths[0] if t > 0.06}  # the balloon has met the sleeve, which flows

    for n, last in ((8, 0.2), (16, 0.45), (24, 0.5)):
        response = thinning(n)
        print(n, {t: f"{value:.1e}" for t, value in response.items()})
        for t, value in response.items():
            assert (value > 0) == (t <= last), (n, t, response)
    assert max(response.values()) < 5e-7, response  # n = 24


@pytest.mark.slow
def test_o70_final_state_forgets_the_steps(run):
    """Back at the start the balloon is free, and of what the larger steps cost the plastic flow on the way only the plastic strains tell (3 %)."""
    small, large = (solve(run, "-output_fields", "false", "-load_step", step) for step in (0.05, 0.7))
    for k, (a, b) in enumerate(zip(figures(small.history[-1], 0.4), figures(large.history[-1], 0.4))):
        assert abs(a - b) <= (1e-3 if k < 5 else 3e-2) * abs(a) + 1e-4, (a, b)


@pytest.mark.slow
@pytest.mark.parametrize("options, local", [((), 0.005), (("-mesh_refine", 1), 0.0025), (FINE1, 0.03), (SUBDIVIDED, 0.05), ((*SUBDIVIDED, "-mesh_refine", 1), 0.012)],
                         ids=["order_2", "order_2_finer", "order_1", "linear_faces", "linear_faces_finer"])
def test_o91_roles_exchanged(run, options, local):
    """Resultants and radii alike; pressures at nodes of the stiff sleeve with curved faces, too. With linear ones they are not until the mesh is finer, nor are plastic
    strains at the corners of the faces."""
    one, other = (solve(run, *options, *roles) for roles in ((), EXCHANGED))
    accurate(other, 0.03, pressure=local, back=local, rms=0.7 * local)
    for t, values in states(one).items():
        for a, b in zip(values[:5], states(other)[t]):
            assert abs(a - b) <= 5e-3 * abs(a) + 1e-3, (t, values, states(other)[t])


def test_o70_full_ring_meets_the_artery(run):
    result = solve(run, *RING, *ADAPTIVE2, "-load_step", 0.1, "-load_end", 0.35)
    assert result.summary["step_cuts"] == 0, result
    accurate_everywhere(result)
    adapted(result, 720)


@pytest.mark.slow
@pytest.mark.parametrize("options, strains, rms, first, cuts, back", [
    ((), 0.003, RMS, 0, 0, PRESSURE), (ADAPTIVE1, 0.03, RMS, 2880, 0, PRESSURE), (ADAPTIVE2, 0.003, RMS, 720, 0, PRESSURE), pytest.param(POLYGONS2, 0.03, RMS, 720, 0, PRESSURE, marks=POLYGON),
    ((*ADAPTIVE1, *LARGE), 0.04, 0.009, 2880, 0, PRESSURE), ((*ADAPTIVE2, *LARGE), 0.03, 0.009, 720, 1, PRESSURE), pytest.param((*POLYGONS2, *LARGE), 0.04, 0.009, 720, 0, 0.012, marks=POLYGON)],
                         ids=["order_2", "adaptive_order_1", "adaptive_order_2", "adaptive_order_2_linear_faces", "adaptive_order_1_larger_steps", "adaptive_order_2_larger_steps",
                              "adaptive_order_2_linear_faces_larger_steps"])
def test_o70_full_ring(run, options, strains, rms, first, cuts, back):
    """There and back without support but on one ray: pressures at all nodes of both gaps, which hold the resultants, and radii all round; figures of the ray. Only
    the large step in which the sleeve crosses the gap to an artery that nothing else holds along x may be cut, with curved faces. back: linear faces split on the
    way back feel the polygon as which the sleeve has flowed."""
    result = solve(run, *RING, *options)
    assert result.summary["step_cuts"] <= cuts, result
    accurate_everywhere(result, back=back, rms=rms)
    rows = states(result)
    for t, _, *reference in STATES:
        print(t, ["%+.1e" % (value / ref - 1 if ref else value) for value, ref in zip(rows[t][3:], reference[3:])])
        for value, ref, share in zip(rows[t][3:], reference[3:], (RADIUS, RADIUS, strains, strains), strict=True):
            assert abs(value / ref - 1) < share, (t, value, ref)
    assert abs((1 - rows[1.4][3] / rows[.7][3]) / RECOIL - 1) < 0.05
    if first:
        adapted(result, first)
        changes = [row["force_change"] for row in result.adapt if row["pass"]]
        assert changes and 1e-8 < max(changes) < 2e-3, changes  # the resultants cancel, what they are measured against does not


@pytest.mark.slow
@pytest.mark.parametrize("options,pressure", [(LINEAR1, 1e-4), (ADAPTIVE2, 5e-4)], ids=["order_1", "adaptive_order_2"])
def test_o70_ring_is_four_quarters(run, options, pressure):
    """Four quarters, held on one ray (where sleeve and artery are along x is for contact to find): the energy of four, their radii, pressures and estimate."""
    quarter, ring = (solve(run, "-output_fields", "false", *options, *sectors) for sectors in ((), RING))
    assert ring.summary["step_cuts"] == 0, ring
    for one, four in zip(quarter.history, ring.history, strict=True):
        assert abs(four["t"] - one["t"]) < 1e-12 and abs(four["energy"] / one["energy"] - 4) < 4e-6
        assert abs(four["estimated_error"] / one["estimated_error"] - 1) < 1e-4, (one["t"], four["estimated_error"], one["estimated_error"])
        for key in (f"contact.{name}.max_pressure" for name in ("inside", "outside")):
            assert abs(four[key] - one[key]) <= pressure * one[key] + 1e-8, (one["t"], key, four[key], one[key])
        for key in (f"probe.{name}.displacement.x" for name in ("balloon", "sleeve", "artery")):
            assert abs(four[key] - one[key]) <= 1e-6 * abs(one[key]) + 1e-9, (one["t"], key, four[key], one[key])


@pytest.mark.slow
@pytest.mark.parametrize("ranks", [2, 3])
def test_o70_ranks(run, ranks):
    options = (*LINEAR1, "-load_step", 0.2, "-output_fields", "false")
    for a, b in zip(states(solve(run, *options))[1.4], states(solve(run, *options, ranks=ranks))[1.4]):
        assert abs(a - b) <= 1e-8 * max(1, abs(a)), (a, b)


COUNTS = ("step", "t", "pass", "step_cuts", "cells", "dofs", "active_nodes")


@pytest.mark.slow
@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("roles", [(), EXCHANGED[4:]], ids=["artery", "sleeve"])
def test_o70_ranks_adaptive(run, ranks, roles):
    """The same steps, meshes and active sets on any number of ranks, whichever side of the gap outside carries the multiplier: pressures of round-off, which this
    pair has before it closes, decide nothing."""
    options = ("-order", 1, "-adapt_tolerance", 0.03, "-adapt_max_cells", 2500, *LARGE, *roles, "-output_fields", "false")
    one, many = (run("inputs/angioplasty2d.yml", *options, ranks=n) for n in (1, ranks))
    ends = [(result.returncode, result.summary["status"], result.summary["adapt_stop"], result.summary["t"]) for result in (one, many)]
    assert ends[0] == ends[1] and ends[0] in ((0, "converged", "tolerance", 1.4), (2, "inaccurate", "max_cells", 1.4)), ends
    assert len({row["cells"] for row in one.history}) > 2 and one.summary["step_cuts"] == 0, one
    for table in ("history", "adapt"):
        for a, b in zip(getattr(one, table), getattr(many, table), strict=True):
            assert [a[key] for key in COUNTS if key in a] == [b[key] for key in COUNTS if key in b]
    for a, b in zip(states(one)[1.4], states(many)[1.4]):
        assert abs(a - b) <= 1e-8 * max(1, abs(a)), (a, b)


# ---- O-71: the slotted stent in space ------------------------------------------------------------------------------------------------------

PLACES = {"middle": ("stent_middle", .485410197, .352671151), "end": ("stent_end", .6, 0), "slot": ("lumen_slot", .71, 0), "strut": ("lumen_strut", .574402066, .417327529)}
# at the widest and afterwards: figure, share by which it may change from the second mesh to the third
STENT_FIGURES = ({"middle": (0.81644, .001), "end": (0.82939, .001), "lumen": (2.2252, .001), "dogboning": (0.01587, .02), "shortening": (0.02797, .005), "force": (1.7207, .005),
                  "work": (0.08091, .005), "mean": (0.01362, .005), "largest": (0.197, .02)},
                 {"middle": (0.76192, .001), "end": (0.74145, .002), "lumen": (1.9804, .002), "dogboning": (-0.02686, .02), "shortening": (0.01462, .01), "force": (0.30995, .005),
                  "work": (0.08357, .005), "mean": (0.01402, .005), "largest": (0.2049, .02), "recoil": (0.0668, .01)})


def stent_figures(result):
    """Radii of the stent halfway through its wall, dogboning, area of the lumen (its radius goes from slot to strut by a cosine), foreshortening, contact force,
    plastic work, mean and largest plastic strain at t = 1 and 2; recoil."""
    figures = []
    for row in (next(row for row in result.history if abs(row["t"] - t) < 1e-9) for t in (1, 2)):
        r = {key: math.hypot(x + row[f"probe.{name}.displacement.x"], y + row[f"probe.{name}.displacement.y"]) for key, (name, x, y) in PLACES.items()}
        figures.append({"middle": r["middle"], "end": r["end"], "dogboning": r["end"] / r["middle"] - 1,
                        "lumen": math.pi * ((r["slot"] + r["strut"])**2 / 4 + (r["slot"] - r["strut"])**2 / 8),
                        "shortening": -row["probe.stent_end.displacement.z"], "force": row["contact_force"], "work": row["plastic.work"],
                        "mean": row["body.stent.mean_plastic_strain"], "largest": row["plastic.strain"], "cells": row["cells"]})
    figures[1]["recoil"] = 1 - figures[1]["middle"] / figures[0]["middle"]
    return figures


def opened_stent(run, passes, *options):
    """There and back, forces balanced at every step; the artery stays open when the balloon has gone."""
    result = run("inputs/angioplasty3d.yml", "-output_fields", "false", "-adapt_max_passes", passes, *options, timeout=3000)
    assert result.solved and result.summary["adapt_passes"] == passes and result.summary["adapt_stop"] == "max_passes", result
    assert max(row["contact_imbalance"] for row in result.history) < 1e-12 and max(row["support_imbalance"] for row in result.history) < 1e-9
    assert result.summary["contact"]["balloon_in_stent"]["active_nodes"] == 0 and result.summary["contact"]["stent_in_artery"]["active_nodes"] > 5
    assert len({row["cells"] for row in result.history}) == 1
    figures = stent_figures(result)
    print(*figures, sep="\n")
    return result, figures


def test_o71_touches(run):
    """The balloon meets the stent: forces of the two sides balance, nothing is cut."""
    result = run("inputs/angioplasty3d.yml", "-output_fields", "false", "-adapt_tolerance", 0, "-load_step", 0.5, "-load_step_max", 0.5, "-load_end", 0.5)
    assert result.returncode == 0 and result.summary["step_cuts"] == 0, result
    assert result.summary["contact"]["balloon_in_stent"]["active_nodes"] > 0 and result.summary["contact"]["balloon_in_stent"]["force_imbalance"] < 1e-12


@pytest.mark.slow
def test_o71_slotted_stent(run):
    """A slotted stent opens, meets the artery and keeps it open when the balloon has gone. One run computes the whole path on three meshes, and its figures change by
    less than 2 % from the second to the third; runs that end after one path and after two, whose probes are known, are the beginning of it."""
    paths = [opened_stent(run, passes) for passes in range(3)]
    told = paths[2][0].adapt
    for t, (first, a, b, bands) in enumerate(zip(*(figures for _, figures in paths), STENT_FIGURES), 1):
        assert first["cells"] == 193 and a["cells"] > 1.25 * first["cells"] and b["cells"] > 1.25 * a["cells"]
        for one, other in ((first, a), (a, b)):
            print("t =", t, {key: f"{other[key] / one[key] - 1:+.2%}" for key in other})
        for passes, path in enumerate((first, a, b)):
            row = next(row for row in told if row["pass"] == passes and abs(row["t"] - t) < 1e-9)
            assert row["cells"] == path["cells"], (row, path)
            assert (row["contact_force"], row["plastic_work"], row["plastic_strain"]) == pytest.approx((path["force"], path["work"], path["largest"]), rel=1e-8)
        for key, (value, change) in bands.items():
            assert abs(b[key] / value - 1) < 0.01 and abs(b[key] / a[key] - 1) < change, (t, key, a, b)


@pytest.mark.slow
def test_o71_step_by_step(run):
    """A stent's history is carried to finer meshes on the way up and on the way back, and each of them finds equilibrium; what this changes at the same load is told."""
    result = run("tests/verify/scenes/stent.yml", "-output_fields", "false", timeout=3000)
    assert result.solved and result.summary["adapt_stop"] == "max_cells" and result.summary["step_cuts"] <= 2 and result.summary["newton_iterations"] < 260, result
    assert max(row["contact_imbalance"] for row in result.history) < 1e-12 and max(row["support_imbalance"] for row in result.history) < 1e-9
    carried = [(a["t"], b["contact_force"] / a["contact_force"] - 1, b["work_change"]) for a, b in zip(result.adapt, result.adapt[1:]) if b["pass"] > 0]
    print("force and plastic work changed by", *("t = %g: %+.1e %+.1e;" % row for row in carried))
    assert len(carried) >= 2 and carried[-1][0] > 1 and max(max(abs(force), abs(work)) for _, force, work in carried) < 0.1
    assert result.history[-1]["contact_force"] == pytest.approx(0.186, rel=0.1)
