"""Contact laws: the linear penalty, which is there for comparison, against what it has to be, and against the frictionless law that it tends to."""
import pytest

from contactkit import PAIRINGS, blocks, contact, spread

E, NU = 1, 0.3
SIDES = {name: {"fix": "x"} for name in ("left_lower", "left_upper", "right_lower", "right_upper")}


def pressure(stretch):
    """Of plane blocks that are shortened by this factor and as wide as before, quadratic U(J)."""
    mu, kappa = E / (2 + 2 * NU), E / (3 - 6 * NU)
    return -(kappa * (stretch - 1) + 2 / 3 * mu * stretch ** (-5 / 3) * (stretch**2 - 1))


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("penalty", [1, 100, 1e4])
def test_patch_overlaps_by_pressure_over_penalty(run, order, penalty):
    rubber = {"law": "neo_hookean", "E": E, "nu": NU}
    boundary = {**SIDES, "bottom": {"fix": "y"}, "top": {"displacement": {"y": -0.1}}}
    text = blocks("upper", {"lower": rubber, "upper": rubber}, boundary, PAIRINGS["two_to_three"][0], pair={"law": "penalty", "penalty": penalty}, order=order)
    result = run("penalty.yml", text=text)
    assert result.returncode == 0, result
    overlap = -result.history[-1]["min_gap"]
    error = [spread(contact(result)["contact_pressure"], pressure(1 - (0.1 - overlap) / 2)), spread(overlap * penalty, pressure(1 - (0.1 - overlap) / 2))]
    print(error)
    assert max(error) < 1e-9, error


def test_penalty_tends_to_frictionless(run):
    """Hertz at a given approach: what is missing of the force falls with 1 / penalty."""
    def force(*law):
        result = run("inputs/hertz2d.yml", "-adapt_tolerance", 0, *law)
        assert result.returncode == 0, result
        return result.history[-1]["contact_force"]

    exact = force()
    missing = [1 - force("-contact_disc_on_block_law", "penalty", "-contact_disc_on_block_penalty", penalty) / exact for penalty in (1e3, 1e4)]
    print(missing)
    assert 0 < missing[0] < 0.02
    assert missing[1] == pytest.approx(missing[0] / 10, rel=0.02)
