"""A mortar side with edges: each of its smooth faces has multipliers of its own, and the pair is one in what a run tells and writes."""
import re

import h5py
import numpy as np
import pytest

from contactkit import is_quadratic, steps

SCENE = "tests/gauntlet/sharp.yml"


def force(result):
    assert result.returncode == 0, result
    return result.summary["contact"]["c"]["force"]


@pytest.mark.parametrize("step", [1, 0.1])
@pytest.mark.parametrize("order", [1, 2])
def test_any_step(run, order, step):
    """Material flows round the corner of a rigid punch. More than one state may balance where a node is at the corner: they differ by little."""
    options = ("-order", order, "-mesh_parameter_n", 8, "-output_fields", "false")
    other = force(run(SCENE, *options, "-load_step", step))
    usual = force(run(SCENE, *options))
    assert abs(other[1] / usual[1] - 1) < 2e-3, (other, usual)


def test_balance_and_ranks(run):
    one, three = run(SCENE, "-output_fields", "false"), run(SCENE, "-output_fields", "false", ranks=3)
    np.testing.assert_allclose(force(one), force(three), rtol=1e-8, atol=1e-10)
    pair = one.summary["contact"]["c"]
    assert pair["force_imbalance"] < 1e-12 and pair["moment_imbalance"] < 1e-10
    np.testing.assert_allclose(pair["force"], [-f for f in pair["mortar_force"]], atol=1e-12)


def test_files_have_one_pair(run):
    result = run(SCENE)
    assert list(result.summary["contact"]) == ["c"]
    assert list(result.history[0]).count("contact.c.force.y") == 1
    with h5py.File(sorted(result.directory.glob("fields_*.h5"))[-1]) as file:
        grid = file["contact"]
        side = np.ravel(grid["side"][:])
        assert set(np.ravel(grid["pair"][:])) == {0} and np.size(grid["pair"].attrs["names"]) == 1
        assert np.sum(side == 0) == 20 and np.sum(side == 1) == 2  # top of the block, two sides of the punch
        assert np.max(grid["contact_pressure"][:]) == pytest.approx(result.summary["contact"]["c"]["max_pressure"])


def test_goes_on(run, tmp_path):
    """A run that ends half way and goes on comes to the same end."""
    whole = force(run(SCENE, "-output_fields", "false"))
    half = run(SCENE, "-output_fields", "false", "-load_end", 0.5)
    rest = run(SCENE, "-output_fields", "false", "-restart", half.directory / "checkpoint.h5")
    np.testing.assert_allclose(force(rest), whole, rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("order", [1, 2])
def test_tangent(run, order):
    """A wedge off the nodes: facets lie across its edge. Derivatives by differences (the first iterate touches without pressure, a kink), and Newton's order."""
    result = run("tests/gauntlet/wedge_in.yml", "-output_fields", "false", "-order", order, "-load_step", 1, "-snes_monitor", "-snes_test_jacobian")
    ratios = [float(value) for value in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = (\S+?),", result.stdout)]
    assert result.returncode == 0 and len(ratios) >= 3 and max(ratios[1:]) < 1e-6, (ratios, result)
    assert is_quadratic(steps(result)[-1]), steps(result)


@pytest.mark.parametrize("scene,order", [("fir_tree", 1), ("fir_tree", 2), ("fir_tree", 3), ("fir_tree3d", 1), ("fir_tree3d", 2)])
@pytest.mark.parametrize("sides", [("root", "groove"), ("groove", "root")], ids=["root", "groove"])
def test_fir_tree(run, sides, scene, order):
    """Flanks as coarse as the lobes, an edge at either end of each: no facet takes what is before and behind a flank for one gap.

    Forces are along the flanks' normals, (3, 2) and (0.3, 0.2), whatever the pressures.
    """
    result = run(f"tests/gauntlet/{scene}.yml", "-order", order, "-contact_c_nonmortar", sides[0], "-contact_c_mortar", sides[1], "-output_fields", "false")
    x, y, *_ = result.summary["contact"]["c"]["force"]
    assert result.returncode == 0 and abs(y) == pytest.approx(0.21 if scene == "fir_tree3d" else 0.7, rel=1e-6), result  # the traction on the top
    assert 1.44 < abs(x / y) < 1.53, (x, y)
    assert result.summary["newton_iterations"] <= 12, result
