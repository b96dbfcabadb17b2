"""Loads that depend on the place are integrated as they are, wherever they jump (src/mechanics/loadmoment.c)."""
import json
import math

import pytest

from boxmesh import linspace, write
from contactkit import is_quadratic, steps

QUIET = ("-output_fields", "false")
LAW = {"law": "neo_hookean", "E": 1e3, "nu": 0.3}


def block(path, dim, model, load, n=4):
    """A unit block with n cells each way and a load on top."""
    write(path / "block.msh", [linspace(0, 1, n)] * dim, to=lambda *x: x)
    up = "xyz"[dim - 1]
    return json.dumps({"mesh": {"file": "block.msh"}, "model": model, "body": {"body": {"material": "m"}}, "material": {"m": LAW},
                       "boundary": {f"{up}0": {"fix": "xyz"[:dim]}, f"{up}1": load}, "load": {"step": 1}})


@pytest.mark.parametrize("kind", ["traction", "pressure"])
@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("low, high", [(0.4, 0.45), (0.26, 0.27), (0.1, 0.613)])
def test_band(run, tmp_path, kind, order, low, high):
    """Between the Gauss points of a facet a narrow band loaded nothing, or a facet's part for all of it: energy 0, "converged"."""
    inside = f"X > {low} && X < {high}"
    load = {"traction": {"y": f"{inside} ? -0.01 : 0"}} if kind == "traction" else {"pressure": f"{inside} ? 0.01 : 0"}
    result = run("s.yml", "-order", order, *QUIET, text=block(tmp_path, 2, "plane_strain", load))
    assert result.returncode == 0 and result.summary["reaction"]["y0"][1] == pytest.approx(0.01 * (high - low), rel=1e-4), result


def test_band_on_an_axis(run, tmp_path):
    load = {"traction": {"y": "X < 0.3 ? -0.01 : 0"}}
    result = run("s.yml", "-order", 2, *QUIET, text=block(tmp_path, 2, "axisymmetric", load).replace('"fix": "xy"', '"fix": "y"'))
    assert result.summary["reaction"]["y0"][1] == pytest.approx(0.01 * math.pi * 0.09, rel=1e-5), result


@pytest.mark.parametrize("order", [1, 2])
def test_disc_in_space(run, tmp_path, order):
    load = {"traction": {"z": "(X - 0.4)^2 + (Y - 0.5)^2 < 0.09 ? -0.01 : 0"}}
    result = run("s.yml", "-order", order, *QUIET, text=block(tmp_path, 3, "3d", load))
    assert result.summary["reaction"]["z0"][2] == pytest.approx(0.01 * math.pi * 0.09, rel=1e-3), result


@pytest.mark.parametrize("kind", ["traction", "pressure"])
def test_on_ranks(run, tmp_path, kind):
    load = {kind: {"x": 0, "y": "X > 0.4 && X < 0.45 ? -2 : 0"}} if kind == "traction" else {kind: "X > 0.4 && X < 0.45 ? 2 : 0"}
    text = block(tmp_path, 2, "plane_strain", load)
    one, two, three = (run("s.yml", "-order", 2, *QUIET, text=text, ranks=ranks).summary["energy"] for ranks in (1, 2, 3))
    assert two == pytest.approx(one, rel=1e-10) and three == pytest.approx(one, rel=1e-10)


def test_tangent_of_a_pressure_that_jumps(run, tmp_path):
    """At finite strain the pressure follows the surface: the tangent is exact, and Newton's method quadratic."""
    text = block(tmp_path, 2, "plane_strain", {"pressure": "X > 0.4 && X < 0.45 ? 2000 : 0"}, 2)
    result = run("s.yml", "-order", 2, *QUIET, "-snes_test_jacobian", "-snes_monitor", text=text)
    error = [float(line.split("=")[1].split(",")[0]) for line in result.stdout.splitlines() if "||J - Jfd||_F/||J||_F =" in line]
    assert result.returncode == 0 and result.summary["newton_iterations"] > 3 and 0 < max(error) < 1e-6, (result, error)
    assert is_quadratic(steps(result)[-1])


def test_smooth(run, tmp_path):
    """A load that is a polynomial of the facet's order is that of its Gauss points."""
    result = run("s.yml", "-order", 2, *QUIET, text=block(tmp_path, 2, "plane_strain", {"traction": {"y": "-0.01*X^3*(1 - X)"}}))
    assert result.summary["reaction"]["y0"][1] == pytest.approx(0.01 / 20, rel=1e-9), result
