"""Where what is prescribed is one rigid motion with a rotation, and where it only looks like one (src/problem/turn.c)."""
import pathlib

PINS = """
For b In {0:2}
  t = 100*b; sx = b == 1 ? -1 : 1; sy = b == 2 ? -1 : 1;
  Point(t + 1) = {0.1, 0.3, 0}; Point(t + 2) = {0.1 + sx, 0.3, 0}; Point(t + 3) = {0.1 + sx, 0.3 + sy, 0}; Point(t + 4) = {0.1, 0.3 + sy, 0};
  Line(t + 1) = {t + 1, t + 2}; Line(t + 2) = {t + 2, t + 3}; Line(t + 3) = {t + 3, t + 4}; Line(t + 4) = {t + 4, t + 1};
  Curve Loop(t + 1) = {t + 1:t + 4}; Plane Surface(t + 1) = {t + 1};
  Transfinite Curve{t + 1:t + 4} = 3; Transfinite Surface{t + 1}; Recombine Surface{t + 1};
EndFor
Physical Surface("a") = {1}; Physical Surface("b") = {101}; Physical Surface("c") = {201};
Physical Curve("v") = {4, 104, 204}; Physical Curve("h") = {1, 101, 201};
"""
SCENE = """
mesh: {file: pins.geo, order: 1}
model: plane_strain
body: {a: {material: m}, b: {material: m}, c: {material: m}}
material: {m: {law: neo_hookean, E: 1, nu: 0.3}}
boundary: {v: {displacement: {x: "0.1*t"}}, h: {displacement: {y: "0.07*t"}}}
load: {end: 1, step: 0.011}
output: {fields: false}
probe: {far: {x: 1.1, y: 1.3, body: a}}
"""


def test_nodes_at_one_place(run, tmp_path: pathlib.Path):
    """Three blocks that move along their straight edges: the nodes all of whose components are prescribed lie at one place, and products of their distances are round-off, which tells of no rotation."""
    (tmp_path / "pins.geo").write_text(PINS)
    result = run("pins.yml", text=SCENE)
    assert result.returncode == 0 and len(result.history) > 50, result
    for row in result.history:
        assert abs(row["probe.far.displacement.x"] - 0.1 * row["t"]) < 1e-9 and abs(row["probe.far.displacement.y"] - 0.07 * row["t"]) < 1e-9, row


RING = """
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {0, 1, 0}; Point(4) = {-1, 0, 0}; Point(5) = {0, -1, 0};
Point(6) = {2, 0, 0}; Point(7) = {0, 2, 0}; Point(8) = {-2, 0, 0}; Point(9) = {0, -2, 0};
For i In {0:3}
  Circle(1 + i) = {2 + i, 1, 2 + (i + 1) % 4}; Circle(5 + i) = {6 + i, 1, 6 + (i + 1) % 4}; Line(9 + i) = {2 + i, 6 + i};
EndFor
For i In {0:3}
  Curve Loop(1 + i) = {9 + i, 5 + i, -(9 + (i + 1) % 4), -(1 + i)}; Plane Surface(1 + i) = {1 + i};
EndFor
Transfinite Curve {1:12} = 4; Transfinite Surface {1:4}; Recombine Surface {1:4};
Physical Surface("ring") = {1:4}; Physical Curve("bore") = {1:4}; Physical Curve("rim") = {5:8};
"""


def test_couples_have_no_sum(run, tmp_path: pathlib.Path):
    """A ring turned at its bore: reactions are couples, which add up to round-off of what they are made of."""
    (tmp_path / "ring.geo").write_text(RING)
    scene = SCENE.split("boundary:")[0].replace("pins.geo, order: 1", "ring.geo, order: 2").replace("{a: {material: m}, b: {material: m}, c: {material: m}}", "{ring: {material: m}}")
    result = run("ring.yml", text=scene + "boundary: {bore: {rotation: {angle: 20*t}}, rim: {fix: xy}}\nload: {step: 1}\n")
    assert result.returncode == 0 and result.summary["balance"]["supports"] < 1e-9, result.summary["balance"]
