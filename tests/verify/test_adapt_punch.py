"""A flat punch 1e5 times stiffer than the ground under it: few facets carry its pressure, singular at the edge, and the estimate has to see that they are too few, whichever side carries the multiplier."""
import pathlib

import pytest

A, E, NU, P = 2.5, 350.0, 0.45, 120.0  # radius, ground, force
MODULUS = E / (1 - NU**2)
DEPTH = P / (2 * A * MODULUS)
# far away the ground moves as under a point force [Boussinesq]; C = P (1 + nu)/(2 pi E), r^2 = X^2 + Y^2, the ground below Y = 0
C = P * (1 + NU) / (2 * 3.141592653589793 * E)
SCENE = f"""
mesh: {{file: {pathlib.Path(__file__).parent}/scenes/loadedpunch.geo, order: 2}}
model: axisymmetric
kinematics: small
body: {{ground: {{material: soft}}, punch: {{material: hard}}}}
material: {{soft: {{law: linear, E: {E}, nu: {NU}}}, hard: {{law: linear, E: {1e5 * E}, nu: 0.3}}}}
boundary:
  axis: {{fix: x}}
  far:
    displacement:
      x: "{C}/sqrt(X*X+Y*Y)*((0-Y)*X/(X*X+Y*Y)-{1 - 2 * NU}*X/(sqrt(X*X+Y*Y)-Y))"
      y: "0-{C}/sqrt(X*X+Y*Y)*({2 * (1 - NU)}+Y*Y/(X*X+Y*Y))"
  top: {{traction: {{y: {-P / (3.141592653589793 * A**2)}}}}}
contact: {{pair: {{nonmortar: NONMORTAR, mortar: MORTAR}}}}
load: {{step: 1}}
adapt: {{tolerance: 0.01, max_passes: 14, max_cells: 20000}}
probe: {{top: {{x: 0, y: 1.5}}}}
output: {{fields: false}}
"""
SIDES = {"stiff": ("face", "surface"), "soft": ("surface", "face")}


def punch(run, nonmortar, *options):
    text = SCENE.replace("NONMORTAR", SIDES[nonmortar][0]).replace("MORTAR", SIDES[nonmortar][1])
    result = run("punch.yml", *options, text=text)
    assert result.solved, result
    return result.summary["estimated_error"], -result.summary["probe"]["top"]["displacement"][1] / DEPTH - 1


@pytest.mark.parametrize("nonmortar, order", [("stiff", 2), ("soft", 3), ("stiff", 4), *(pytest.param(*words, marks=pytest.mark.slow) for words in (("soft", 2), ("stiff", 3)))])
def test_depth_either_side(run, nonmortar, order):
    estimate, error = punch(run, nonmortar, "-order", order)
    assert estimate < 0.01
    assert abs(error) < 1e-3, error


def test_as_many_passes_as_it_takes(run):
    """At a singular edge a pass takes off as much as one split of the cells there does: no limit but that of the tolerance ends adaptation."""
    result = run("punch.yml", "-order", 3, "-adapt_tolerance", 0.004, text=SCENE.replace("NONMORTAR", "face").replace("MORTAR", "surface"))
    assert result.returncode == 0 and result.summary["adapt_passes"] > 10, result


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("passes", [0, 3])
def test_few_facets_are_told(run, order, passes):
    """Linear faces, whose multipliers are too coarse. The relative error of the depth under a given force is the square of that in the energy norm. (Of faces of
    the order of the cells the depth is right by accident on some of these meshes.)"""
    estimate, error = punch(run, "stiff", "-order", order, "-adapt_max_passes", passes, "-contact_pair_order", 1)
    assert 1 / 3 < estimate / abs(error) ** 0.5 < 3, (estimate, error)
