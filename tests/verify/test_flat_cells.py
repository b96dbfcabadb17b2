"""The estimate on flat cells: what varies along their length is told by their length, not by their thickness (src/estimate/indicator.c)."""
import json

import pytest

RECTANGLE = """
DefineConstant[ n = 4 ];
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 3}; Line(4) = {1, 4}; Curve Loop(1) = {1, 2, -3, -4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = 9; Transfinite Surface{1}; Recombine Surface{1};
Physical Surface("b") = {1}; Physical Curve("ends") = {1, 3}; Physical Curve("sides") = {2, 4};
"""


def column(run, path, order, cells, *options):
    """A force along y that varies along y alone, on cells 1/8 high and 1/cells wide: those in one row have the same displacement at any width."""
    (path / "rectangle.geo").write_text(RECTANGLE)
    return run("s.yml", "-output_fields", "false", *options, text=json.dumps(
        {"mesh": {"file": "rectangle.geo", "order": 1, "parameter": {"n": cells}}, "model": "plane_strain", "kinematics": "small", "order": order,
         "body": {"b": {"material": "m", "force": {"y": "0.01*sin(4*pi*Y)"}}}, "material": {"m": {"law": "linear", "E": 1, "nu": 0.3}},
         "boundary": {"ends": {"fix": "xy"}, "sides": {"fix": "x"}}, "load": {"step": 1}}))


@pytest.mark.parametrize("order", [2, 3, 4])
def test_any_width(run, tmp_path, order):
    """The error, from the energy of a much higher order, is the same for cells 16 times as long as wide; so is what is told, and within a factor of 3."""
    exact = column(run, tmp_path, 8, 4).summary["energy"]
    told = []
    for cells in (8, 128):
        s = column(run, tmp_path, order, cells).summary
        error = (1 - s["energy"] / exact) ** 0.5
        print(f"order {order}, {cells} cells across: told {s['estimated_error']:.3g}, true {error:.3g}")
        assert error / 3 < s["estimated_error"] < 3 * error
        told.append(s["estimated_error"])
    assert told[1] == pytest.approx(told[0], rel=1e-3)


def test_flat_cells_are_split(run, tmp_path):
    """"Converged" at 2 % is true."""
    exact = column(run, tmp_path, 8, 4).summary["energy"]
    result = column(run, tmp_path, 2, 64, "-adapt_tolerance", 0.02)
    print(result.summary["estimated_error"], 1 - result.summary["energy"] / exact)
    assert result.returncode == 0 and 1 - result.summary["energy"] / exact < 0.02**2
