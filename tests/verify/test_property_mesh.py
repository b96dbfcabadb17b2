"""A damaged .msh ends in exit status 1 with a sentence, not in a signal."""
import json
import math
import subprocess

import pytest

from boxmesh import linspace, write
from conftest import ROOT
from contactkit import blocks


def damaged(run, tmp_path, line, text):
    """The mesh of inputs/patch2d.geo with one line of its nodes replaced."""
    path = tmp_path / "d.msh"
    subprocess.run(["gmsh", "-2", "-order", "1", "-format", "msh22", "-o", str(path), str(ROOT / "inputs" / "patch2d.geo")], check=True, capture_output=True)
    lines = path.read_text().splitlines()
    at = lines.index("$Nodes") + 1 + line
    lines[at] = text(lines[at])
    path.write_text("\n".join(lines) + "\n")
    scene = (ROOT / "inputs" / "patch2d.yml").read_text().replace("file: patch2d.geo", "file: d.msh").replace("  order: 1\n", "", 1)
    return run("d.yml", "-check", text=scene)


def test_undamaged_mesh_is_read(run, tmp_path):
    """Nothing damaged: the mesh is fine as gmsh wrote it."""
    assert damaged(run, tmp_path, 27, lambda line: line).returncode == 0


def test_lost_separator_is_told(run, tmp_path):
    """A line of $Nodes has lost a number, so that the numbers after it shift: PETSc 3.18 alone would follow a node that does not exist."""
    result = damaged(run, tmp_path, 27, lambda line: line.replace(" ", "", 1))
    assert result.returncode == 1 and "mortise: " in result.stderr, result


def test_axis_within_round_off(run, tmp_path):
    """Nodes on the axis of revolution at the radius that cos(90 degrees) is in floating point: the estimate is that of an axis at 0."""
    estimates = []
    for axis in (0, 6e-17):
        write(tmp_path / "rod.msh", [linspace(0, 1, 3)] * 2, lambda x, y: (x or axis * (2 - y), y))
        scene = {"mesh": {"file": "rod.msh"}, "model": "axisymmetric", "order": 3, "body": {"body": {"material": "m"}}, "load": {"step": 1},
                 "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "boundary": {"y0": {"fix": "xy"}, "y1": {"displacement": {"x": 0, "y": 0.1}}}}
        result = run("s.yml", "-adapt_tolerance", 0.9, text=json.dumps(scene))
        assert result.returncode == 0, result
        estimates.append(result.summary["estimate"]["total"])
    assert estimates[1] == pytest.approx(estimates[0], rel=1e-6) and estimates[0] > 0


SEGMENT = """Point(1) = {1, 0, 0}; Point(2) = {0, 1, 0}; Point(3) = {0, 0, 0}; Circle(1) = {1, 3, 2}; Line(2) = {2, 1};
Transfinite Curve {1} = 3; Transfinite Curve {2} = 2; Curve Loop(1) = {1, 2}; Plane Surface(1) = {1};
Physical Surface("b") = {1}; Physical Curve("arc") = {1}; Physical Curve("flat") = {2};
"""


@pytest.mark.parametrize("order", [2, 3, 4])
def test_triangle_with_two_sides_on_one_arc(run, tmp_path, order):
    """It becomes quadrilaterals of which one has a corner of 180 degrees: inverted with the curved sides of orders 3 and 4, so its sides are straight, which is told."""
    (tmp_path / "s.geo").write_text(SEGMENT)
    scene = {"mesh": {"file": "s.geo", "order": order}, "model": "plane_strain", "order": 2, "body": {"b": {"material": "m"}}, "load": {"step": 1},
             "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "boundary": {"flat": {"fix": "xy"}, "arc": {"pressure": 0.01}}}
    result = run("s.yml", text=json.dumps(scene))
    assert result.returncode == 0 and ("have straight ones" in result.stdout) == (order > 2), result
    assert result.summary["energy"] == pytest.approx(1.14e-5, rel=0.03)


def test_arc_between_two_bodies_stays(run, tmp_path):
    """The same where another body lies on the arc, whose sides would no longer be those of the first: refused."""
    (tmp_path / "s.geo").write_text(SEGMENT + """Point(4) = {2, 0, 0}; Point(5) = {0, 2, 0}; Circle(3) = {4, 3, 5}; Line(4) = {1, 4}; Line(5) = {2, 5}; Transfinite Curve {3} = 3;
Curve Loop(2) = {4, 3, -5, -1}; Plane Surface(2) = {2}; Transfinite Curve {4, 5} = 2; Transfinite Surface {2}; Recombine Surface {2}; Physical Surface("c") = {2};
""")
    scene = {"mesh": {"file": "s.geo", "order": 3}, "model": "plane_strain", "body": {name: {"material": "m"} for name in "bc"}, "load": {"step": 1},
             "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "boundary": {"flat": {"fix": "xy"}}}
    result = run("s.yml", text=json.dumps(scene))
    assert result.returncode == 1 and "is inverted or degenerate" in result.stderr and "with straight sides it would be" in result.stderr, result


def test_refined_near_a_point(run):
    """As many cells lie within a distance of a point in a mesh that is turned as in one along the axes."""
    def cells(angle):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        spot = {"x": 0.3 * c - 0.5 * s, "y": 0.3 * s + 0.5 * c, "radius": 0.1, "levels": 2}
        scene = blocks("upper", {name: {"law": "neo_hookean", "E": 1, "nu": 0.3} for name in ("lower", "upper")}, {"bottom": {"fix": "xy"}, "top": {"fix": "xy"}},
                       {"nl": 4, "ml": 4, "nu": 4, "angle": angle}, {"spot": spot}, {"kind": "tied"})
        result = run("spot.yml", text=scene)
        assert result.returncode == 0, result
        return result.history[-1]["cells"]

    assert cells(30) == cells(0)
