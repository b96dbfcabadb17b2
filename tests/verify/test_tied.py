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


def box_scene(tmp_path, parts, pairs, order=1, kinematics="finite", near=None, to=lambda x: x, matrix=H, sides=None, **keys):
    """Boxes glued in pairs (nonmortar, mortar), every other face moved by the matrix."""
    boxes(tmp_path / "boxes.msh", parts, to)
    tied = {face for pair in pairs for face in pair}
    faces = sides or [f"{name}_{axis}{end}" for name in parts for axis in "xyz" for end in (0, 1) if f"{name}_{axis}{end}" not in tied]
    material = LINEAR if kinematics == "small" else RUBBER
    scene = {"mesh": {"file": str(tmp_path / "boxes.msh")}, "model": "3d", "kinematics": kinematics, "order": order,
             "body": {name: {"material": "bulk"} for name in parts}, "material": {"bulk": material},
             "boundary": {face: {"displacement": motion(matrix)} for face in faces},
             "contact": {f"glue{i}": {"nonmortar": one, "mortar": two, "roles": "given", "kind": "tied"} for i, (one, two) in enumerate(pairs)},
             "load": {"step": 1}, **keys}
    if near:
        scene["refine"] = near
    return "\n".join(f"{key}: {yaml(value)}" for key, value in scene.items()) + "\n"


TWO = {"lower": Box((0, 0, 0), (1, 1, 1), (2, 3, 2)), "upper": Box((0, 0, 1), (1, 1, 1), (3, 2, 1))}


@pytest.mark.parametrize("order", [1, 2, pytest.param(3, marks=pytest.mark.slow), pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.parametrize("hangs", [None, "upper_z0", "lower_z1"])
@pytest.mark.parametrize("nonmortar", [0, 1])
def test_patch_in_space(run, tmp_path, nonmortar, hangs, order):
    near = {"spot": {"boundary": hangs, "x": 0.1, "y": 0.2, "z": 1, "levels": 1}} if hangs else None
    pair = ("upper_z0", "lower_z1")[:: 1 - 2 * nonmortar]
    result = run("space.yml", text=box_scene(tmp_path, TWO, [pair], order, near=near))
    assert result.returncode == 0, result
    state = bulk(result)
    error = [affine(state, H), numpy.ptp(state["stress"], axis=0).max() / 100]
    print(error)
    assert max(error) < 1e-10, error
