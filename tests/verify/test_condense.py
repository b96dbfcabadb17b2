"""Condensation of the unknowns inside cells changes no Newton iteration of the shipped scenes: same counts, same cuts, same result to round-off; neither with
an iterative solver nor on several processes."""
import re

import pytest

SCENES = ["patch2d", "hertz2d", "cylinder", "roller", "shrinkfit", "cook", "lshape", "sphere", "rubber2d", "blocks3d", "cube"]


@pytest.mark.parametrize("scene", SCENES)
def test_same_iterations(run, scene):
    results = [run(f"inputs/{scene}.yml", "-order", 3, "-adapt_max_passes", 1, "-output_fields", "false", "-solve_condense", word) for word in ("yes", "no")]
    assert all(result.solved for result in results), results
    condensed, whole = ([(row["newton_iterations"], row["active_nodes"]) for row in result.history] for result in results)
    assert condensed == whole
    for key in ("step_cuts", "dofs", "newton_iterations", "active_set_changes"):
        assert results[0].summary[key] == results[1].summary[key]
    energy = [result.summary["energy"] for result in results]
    assert energy[0] == pytest.approx(energy[1], rel=1e-9)


def same(one, other, name):
    """Energy and the pair's force, pressure and zone, to 1e-8."""
    assert other["energy"] == pytest.approx(one["energy"], rel=1e-8)
    pair, first = other["contact"][name], one["contact"][name]
    assert pair["force"] == pytest.approx(first["force"], rel=1e-8, abs=1e-8 * max(map(abs, first["force"])))
    assert pair["max_pressure"] == pytest.approx(first["max_pressure"], rel=1e-8)
    assert pair["active_nodes"] == first["active_nodes"]


def count(result, event):
    """Calls of an event in PETSc's log."""
    found = re.search(rf"^{event} *(\d+)", result.stdout, re.M)
    return int(found.group(1)) if found else 0


SPACE = ("inputs/blocks3d.yml", "-mesh_parameter_n1", 1, "-mesh_parameter_n2", 2, "-boundary_top_displacement_z", "-0.1-0.03*X*Y", "-output_fields", "false",
         "-solve_condense", "yes", "-log_view")


@pytest.mark.parametrize("order, ranks", [(3, 2), (4, 1), pytest.param(3, 1, marks=pytest.mark.slow), pytest.param(4, 2, marks=pytest.mark.slow)])
def test_iterative(run, order, ranks):
    """Conjugate gradients on what condensation leaves of a scene in space find what a factorisation finds."""
    direct, iterative = (run(*SPACE, "-order", order, "-solve_linear", word, ranks=ranks) for word in ("direct", "iterative"))
    assert direct.returncode == 0 and iterative.returncode == 0, (direct, iterative)
    assert count(iterative, "MatMult ") > 5 * count(direct, "MatMult ")  # the iterations did take place
    assert direct.history[-1]["newton_iterations"] == iterative.history[-1]["newton_iterations"]
    same(direct.summary, iterative.summary, "upper_on_lower")


@pytest.mark.parametrize("faces, order, ranks", [(1, 3, 3), ("full", 4, 2), *(pytest.param(*words, marks=pytest.mark.slow) for words in ((1, 3, 2), ("full", 4, 3), (1, 4, 2),
                                                                                                                                  (1, 4, 3), ("full", 3, 2), ("full", 3, 3)))])
def test_active_set_on_ranks(run, faces, order, ranks):
    """The active set finds its way on several processes as on one, with the unknowns inside cells condensed."""
    command = ("inputs/rubber2d.yml", "-order", order, "-contact_disc_on_block_order", faces, "-adapt_max_passes", 2, "-output_fields", "false", "-solve_condense",
               "yes")
    one, many = run(*command), run(*command, ranks=ranks)
    assert one.solved and many.solved, (one, many)
    assert one.summary["active_set_changes"] > 5
    for key in ("newton_iterations", "active_set_changes", "step_cuts", "dofs"):
        assert one.summary[key] == many.summary[key], key
    assert [row["newton_iterations"] for row in one.history] == [row["newton_iterations"] for row in many.history]
    same(one.summary, many.summary, "disc_on_block")


def test_bad_word(run):
    result = run("inputs/patch2d.yml", "-solve_condense", "maybe")
    assert result.returncode != 0
