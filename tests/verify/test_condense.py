"""Condensation of the unknowns inside cells changes no Newton iteration of the shipped scenes: same counts, same cuts, same result to round-off."""
import pytest

SCENES = ["patch2d", "hertz2d", "cylinder", "roller", "shrinkfit", "cook", "lshape", "sphere", "rubber2d", "blocks3d", "cube"]


@pytest.mark.parametrize("scene", SCENES)
def test_same_iterations(run, scene):
    results = [run(f"inputs/{scene}.yml", "-order", 3, "-adapt_max_passes", 1, "-output_fields", "false", "-solve_condense", word) for word in ("yes", "no")]
    assert all(result.returncode == 0 for result in results), results
    condensed, whole = ([(row["newton_iterations"], row["active_nodes"]) for row in result.history] for result in results)
    assert condensed == whole
    for key in ("step_cuts", "dofs", "newton_iterations", "active_set_changes"):
        assert results[0].summary[key] == results[1].summary[key]
    energy = [result.summary["energy"] for result in results]
    assert energy[0] == pytest.approx(energy[1], rel=1e-9)


def test_bad_word(run):
    result = run("inputs/patch2d.yml", "-solve_condense", "maybe")
    assert result.returncode != 0
