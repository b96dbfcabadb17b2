"""Cells that are folded at a corner (det F <= 0 between their integration points), as under the end of a bonded edge: their estimate is true."""
import pytest

SCENE = ("tests/gauntlet/bonded.yml", "-adapt_tolerance", 0, "-output_fields", "false")
LEAST = 0.01901  # energy, the least that is found on any mesh: order 4, -adapt_tolerance 0.05


@pytest.mark.parametrize("order, refine", [(2, 1), (2, 2), (3, 0), (3, 1), (4, 1)])
def test_estimate(run, order, refine):
    """Where det F vanishes no stress is asked for, and a surface that is folded back overlaps nothing: what is told is the error, within a factor of 2. With
    stresses from as near to the fold as det F > 0 it was 0.17 to 1.0."""
    result = run(*SCENE, "-order", order, "-mesh_refine", refine)
    told, error = result.summary["estimated_error"], (result.summary["energy"] / LEAST - 1) ** 0.5
    print(told, error)
    assert result.returncode == 0 and "turned inside out at a corner" in result.stdout, result
    assert 0.5 < told / error < 2
    assert "overlap by" not in result.stdout, result


def test_ranks(run):
    """The same on 1, 2 and 3 processes, wherever the folded cells are."""
    one, *others = (run(*SCENE, "-mesh_refine", 2, ranks=ranks) for ranks in (1, 2, 3))
    for other in others:
        assert other.returncode == 0 and other.summary["newton_iterations"] == one.summary["newton_iterations"], other
        for key in ("energy", "estimated_error"): assert other.summary[key] == pytest.approx(one.summary[key], rel=1e-8)
