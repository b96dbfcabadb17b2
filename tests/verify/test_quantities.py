"""Fields on demand (output.quantities) against closed forms: homogeneous states, turned by a rigid rotation, in every layout of the bulk grid."""
import json
import math

import numpy as np
import pytest

from boxmesh import linspace, write

ALL = "principal_stretches, logarithmic_strain,energy_density , first_piola"
SIX = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
MU, LAMBDA = 100 / 2.6, 30 / (1.3 * 0.4)
KAPPA = LAMBDA + 2 * MU / 3


def rotation(axis, degrees):
    axis = np.array(axis) / np.linalg.norm(axis)
    spin = np.cross(np.eye(3), axis)
    return np.eye(3) + math.sin(math.radians(degrees)) * spin + (1 - math.cos(math.radians(degrees))) * spin @ spin


def closed_form(F):
    """W and P = dW/dF of mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J-1)^2."""
    J, I1, inverse = np.linalg.det(F), (F * F).sum(), np.linalg.inv(F).T
    return MU / 2 * (J ** (-2 / 3) * I1 - 3) + KAPPA / 2 * (J - 1) ** 2, MU * J ** (-2 / 3) * (F - I1 / 3 * inverse) + KAPPA * (J - 1) * J * inverse


def last(run, tmp_path, F, order, dim=3, material=None, boundary=None, **keys):
    """Bulk fields of a block with cells distorted inside, whose boundary moves as F says."""
    def to(*x):
        bump = 0.1 * math.prod(math.sin(math.pi * c) for c in x)
        return tuple(c + bump * (1 - 0.5 * i) for i, c in enumerate(x))

    write(tmp_path / "block.msh", [linspace(0, 1, 2)] * dim, to)
    move = {axis: " + ".join(f"({F[i][j] - (i == j)!r})*{letter}" for j, letter in zip(range(dim), "XYZ")) for i, axis in zip(range(dim), "xyz")}
    move = {axis: f"t*({text})" for axis, text in move.items()}
    scene = {"mesh": {"file": "block.msh"}, "model": "3d" if dim == 3 else "plane_strain", "order": order, "body": {"body": {"material": "m"}},
             "material": {"m": material or {"law": "neo_hookean", "E": 100, "nu": 0.3}},
             "boundary": boundary or {f"{axis}{side}": {"displacement": move} for axis in "xyz"[:dim] for side in (0, 1)}, "load": {"step": 0.25}, "output": {"quantities": ALL}, **keys}
    result = run("block.yml", text=json.dumps(scene))
    assert result.returncode == 0, result
    return result.states()[-1][1]


def check(fields, name, value, size=1.0):
    assert np.allclose(fields[name], value, rtol=0, atol=1e-8 * size), (name, fields[name][0], value)


@pytest.mark.parametrize("order", (1, 2))
@pytest.mark.parametrize("degrees", (0, 60))
def test_homogeneous(run, tmp_path, order, degrees):
    """F = R U: stretches of U, ln V = R ln U R^T, W of U, P = R P(U), Cauchy stress P F^T / J."""
    U = rotation((1, 2, 3), 25) @ np.diag((1.3, 0.9, 0.8)) @ rotation((1, 2, 3), 25).T
    R = rotation((0, 1, 1), degrees)
    fields = last(run, tmp_path, R @ U, order)
    W, P = closed_form(U)
    strain = R @ rotation((1, 2, 3), 25) @ np.diag(np.log((1.3, 0.9, 0.8))) @ rotation((1, 2, 3), 25).T @ R.T
    check(fields, "principal_stretches", (1.3, 0.9, 0.8))
    check(fields, "logarithmic_strain", [strain[i, j] for i, j in SIX])
    check(fields, "energy_density", W, 100)
    check(fields, "first_piola", (R @ P).ravel(), 100)
    sigma = R @ P @ U.T @ R.T / np.linalg.det(U)
    check(fields, "stress", [sigma[i, j] for i, j in SIX], 100)


@pytest.mark.parametrize("material", ({"law": "neo_hookean", "E": 100, "nu": 0.3}, {"law": "neo_hookean", "E": 100, "nu": 0.499}), ids=("displacement", "mixed"))
def test_rigid_rotation(run, tmp_path, material):
    """A block that only turns bears nothing and stores nothing."""
    fields = last(run, tmp_path, np.eye(3), 2, dim=2, material=material, boundary={"x0": {"rotation": {"angle": 80}}})
    turned = fields["X"] @ rotation((0, 0, 1), 80).T
    check(fields, "displacement", turned - fields["X"])
    for name, value in (("principal_stretches", 1), ("logarithmic_strain", 0), ("energy_density", 0), ("first_piola", 0), ("stress", 0)):
        check(fields, name, value, 100)


def test_small_kinematics(run, tmp_path):
    """The linear strain, turned axes told by stretches of 1 + its eigenvalues."""
    gradient = np.array([[0.01, 0.03, 0], [0.01, -0.02, 0], [0, 0, 0]])
    fields = last(run, tmp_path, np.eye(3) + gradient, 1, dim=2, material={"law": "linear", "E": 100, "nu": 0.3}, kinematics="small")
    strain = (gradient + gradient.T) / 2
    check(fields, "logarithmic_strain", [strain[i, j] for i, j in SIX])
    check(fields, "principal_stretches", 1 + np.linalg.eigvalsh(strain)[::-1])
    stress = 2 * MU * strain + LAMBDA * np.trace(strain) * np.eye(3)
    check(fields, "first_piola", stress.ravel(), 100)
    check(fields, "energy_density", (stress * strain).sum() / 2, 100)


def test_rigid_body_and_choice(run):
    """Of a rigid body: stretches 1, no energy; and nothing is written but what was asked for."""
    result = run("inputs/belt.yml", "-output_quantities", "principal_stretches,energy_density", "-load_end", 1)
    assert result.returncode == 0, result
    fields = result.states()[-1][1]
    rigid = np.unique(fields["cells"][fields["body"] == 1].astype(int))
    assert np.allclose(fields["principal_stretches"][rigid], 1, rtol=0, atol=1e-12) and np.all(fields["energy_density"][rigid] == 0) and fields["energy_density"].max() > 0
    assert not {"logarithmic_strain", "first_piola"} & set(fields)


@pytest.mark.parametrize("value, words", [("energy", "output.quantities is 'energy'; allowed: principal_stretches|"),
                                          ("first_piola,first_piola", "first_piola is there twice"), (",", "is ''; allowed")])
def test_words(run, value, words):
    result = run("inputs/patch2d.yml", "-output_quantities", value, "-check")
    assert result.returncode == 1 and words in result.stderr, result
