"""Tied surfaces (contact.<pair>.kind: tied): patch tests, rigid rotation, the L-shape against the mesh that conforms, bad input."""
import math

import numpy
import pytest

from boxes import Box, boxes
from contactkit import PAIRINGS, blocks, bulk, graded, yaml

LINEAR = {"law": "linear", "E": 100, "nu": 0.3}
RUBBER = {"law": "neo_hookean", "E": 100, "nu": 0.3}
H = numpy.array([[0.01, 0.03, 0.02], [-0.02, 0.04, 0.01], [0.03, -0.01, 0.02]])
SIDES = ("left_lower", "left_upper", "right_lower", "right_upper", "bottom", "top")


def motion(matrix):
    """x, y, z of a displacement that is linear in the reference positions."""
    return {"xyz"[i]: " + ".join(f"({value:.17g})*{name}" for value, name in zip(row, "XYZ")) for i, row in enumerate(matrix)}


def affine(state, matrix):
    n = len(matrix)
    return numpy.abs(state["displacement"][:, :n] - state["X"][:, :n] @ numpy.array(matrix).T).max()


@pytest.mark.parametrize("order", [1, pytest.param(2, marks=pytest.mark.slow), 3, pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kinematics", ["small", "finite"])
@pytest.mark.parametrize("nonmortar", ["upper", "lower"])
@pytest.mark.parametrize("pairing", list(PAIRINGS))
def test_patch_in_the_plane(run, pairing, nonmortar, kinematics, order):
    """A deformation that is the same everywhere, imposed on all sides but the tied ones: stretch and shear."""
    parameter, side = PAIRINGS[pairing]
    material = LINEAR if kinematics == "small" else RUBBER
    scene = blocks(nonmortar, {"lower": material, "upper": material}, {name: {"displacement": motion(H[:2, :2])} for name in SIDES}, parameter,
                   graded(side, 0.3, 1, 2) if side else None, {"kind": "tied"}, kinematics=kinematics, order=order)
    result = run("patch.yml", text=scene)
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H[:2, :2]), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error
