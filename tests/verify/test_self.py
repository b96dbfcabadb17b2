"""Contact of a surface with itself and of several bodies in one group (contact.<pair>.surface)."""
import shutil
import sys

import numpy
import pytest

from conftest import ROOT

sys.path.insert(0, str(ROOT / "python"))
import mortise

NOTCH = """
mesh: {file: notch.geo, order: 1}
model: plane_strain
order: 2
body: {block: {material: rubber}}
material: {rubber: {law: neo_hookean, E: 1, nu: 0.3}}
boundary: {bottom: {fix: y}, left: {displacement: {x: 0.2}}, right: {displacement: {x: -0.2}}}
contact: {flanks: {surface: flanks}}
load: {step: 0.25}
"""
DISCS = """
mesh: {file: discs.geo, order: 2}
model: plane_strain
order: 2
body: {lower: {material: hard}, middle: {material: soft}, upper: {material: hard}}
material: {soft: {law: neo_hookean, E: 1, nu: 0.3}, hard: {law: neo_hookean, E: 3, nu: 0.3}}
boundary: {axis: {fix: x}, floor: {fix: y}, roof: {displacement: {y: -0.5*t}}}
contact: %s
load: {step: 0.25}
"""

FLANGE = """
mesh: {file: flange.geo, order: 1}
model: plane_strain
order: 1
body: {sheet: {material: soft}, hammer: {material: iron, motion: {x: "0.35*t", y: "-0.35*t"}}}
material: {soft: {law: neo_hookean, E: 1000, nu: 0.3}, iron: {law: rigid}}
boundary: {under: {fix: xy}}
contact: {hammer: {nonmortar: [skin, end], mortar: face, friction: 0.1}%s}
load: {step: 0.05, end: 0.15}
"""
SHEET = """
Point(1) = {0, 0, 0, 0.03}; Point(2) = {0.8, 0, 0, 0.03}; Point(3) = {0.8, 0.05, 0, 0.03};
Point(4) = {0.05, 0.05, 0, 0.03}; Point(5) = {0.05, 0.5, 0, 0.03}; Point(6) = {0, 0.5, 0, 0.03};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(7) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {7}; Recombine Surface {1};
Point(7) = {-0.3, 0.25, 0}; Point(8) = {-0.004, 0.56, 0}; Point(9) = {0.5, 1.15, 0}; Point(10) = {-0.3, 1.15, 0};
Line(8) = {7, 8}; Line(9) = {8, 9}; Line(10) = {9, 10}; Line(11) = {10, 7};
Curve Loop(12) = {8, 9, 10, 11}; Plane Surface(2) = {12};
Transfinite Curve {8, 9, 10, 11} = 5; Transfinite Surface {2}; Recombine Surface {2};
Physical Surface("sheet") = {1}; Physical Surface("hammer") = {2}; Physical Curve("under") = {1};
Physical Curve("skin") = {2, 3, 4, 6}; Physical Curve("end") = {5}; Physical Curve("face") = {8};
"""


def scene(tmp_path, geometry, text, folder="gauntlet"):
    shutil.copy(ROOT / "tests" / folder / geometry, tmp_path / geometry)
    (tmp_path / "scene.yml").write_text(text)
    return tmp_path / "scene.yml"


@pytest.mark.parametrize("order, options", [(1, ()), (2, ()), (3, ()), (4, ()), (2, ("-load_step", 1)), (2, ("-load_step", 0.125)), (2, ("-load_step", 0.1))])
def test_flanks_of_a_notch_meet(run, tmp_path, order, options):
    """Energy of orders 3 and 4 on half the cells: 0.0371013; the flanks carry a pressure and do not pass each other."""
    result = run(scene(tmp_path, "notch.geo", NOTCH), "-order", order, *options)
    assert result.returncode == 0, result
    assert result.summary["energy"] == pytest.approx(0.0371013, rel=5e-3 if order == 1 else 3e-4)
    assert not [w for w in result.summary["warnings"] if "itself" in w]
    pair = result.summary["contact"]["flanks"]
    assert pair["active_nodes"] > 0 and pair["min_gap"] > -1e-9


def test_ends_in_the_mirror(run, tmp_path):
    """In steps of 0.1 the solution lies where facets are covered up to their ends, open there: forces of ends that are held do not jump (frozen_segmentation)."""
    options = ("-load_step", 0.1, "-load_end", 0.9, "-path_descent", "off", "-path_viscous", "off")
    result = run(scene(tmp_path, "notch.geo", NOTCH), *options)
    assert result.returncode == 0 and result.summary["modifiers"]["frozen_segmentation"] == 1, result
    without = run(scene(tmp_path, "notch.geo", NOTCH), *options, "-newton_frozen_segmentation", "off")
    assert without.returncode == 2 and without.summary["t"] < 0.83, without


@pytest.mark.parametrize("friction", [pytest.param(0, marks=pytest.mark.slow), 0.2])
def test_bodies_of_one_group(run, tmp_path, friction):
    """Three discs in a pile: one group where everything may touch everything is the two pairs that do touch."""
    one = run(scene(tmp_path, "discs.geo", DISCS % f"{{all: {{surface: skins, friction: {friction}}}}}"), "-load_step", 0.5)
    pairs = f"{{below: {{nonmortar: middle_skin, mortar: lower_skin, friction: {friction}}}, above: {{nonmortar: middle_skin, mortar: upper_skin, friction: {friction}}}}}"
    two = run(scene(tmp_path, "discs.geo", DISCS % pairs), "-load_step", 0.5)
    assert one.returncode == 0 and two.returncode == 0, (one, two)
    assert one.summary["energy"] == pytest.approx(two.summary["energy"], rel=1e-9)
    assert one.summary["reaction"]["roof"] == pytest.approx(two.summary["reaction"]["roof"], rel=1e-8, abs=1e-9)


ORINGS = """
mesh: {file: orings.geo, order: 3}
model: axisymmetric
order: 2
body: {o0: {material: m}, o1: {material: m}, o2: {material: m}, floor: {material: r}, piston: {material: r, motion: {y: -0.3*t}}, shaft: {material: r}, bore: {material: r}}
material: {m: {law: neo_hookean, E: 1, nu: 0.3}, r: {law: rigid}}
contact:
  %s
  low: {nonmortar: o0_o, mortar: floor_t}
  high: {nonmortar: o2_o, mortar: piston_b}
  inn: {nonmortar: [o0_o, o1_o, o2_o], mortar: shaft_r}
  out: {nonmortar: [o0_o, o1_o, o2_o], mortar: bore_l}
load: {step: 0.1, end: 0.4}
"""
RING = """
mesh: {file: splitring.geo, order: 3}
model: plane_strain
order: 2
body: {c: {material: m}}
material: {m: {law: neo_hookean, E: 1, nu: 0.3}}
boundary: {top: {displacement: {x: 0, y: -0.18}}, bot: {displacement: {x: 0, y: 0.18}}}
contact: {ends: {%s, friction: 0.3}}
load: {step: 0.25}
"""


def test_what_lies_behind_is_hidden_from_a_shoulder(run, tmp_path):
    """Of three rings on each other one group is the pairs that do touch: the lowest one's shoulder, which the middle one covers in part, does not see the third through it."""
    text = {"one": "all: {surface: [o0_o, o1_o, o2_o]}", "two": "ab: {nonmortar: o0_o, mortar: o1_o}\n  bc: {nonmortar: o1_o, mortar: o2_o}"}
    result = {name: run(scene(tmp_path, "orings.geo", ORINGS % pairs, "verify/scenes")) for name, pairs in text.items()}
    assert all(r.returncode == 0 for r in result.values()), result
    assert result["one"].summary["energy"] == pytest.approx(result["two"].summary["energy"], rel=1e-9)


@pytest.mark.parametrize("step, ranks", [(0.0625, 1), (0.25, 1), (0.25, 3), pytest.param(0.25, 2, marks=pytest.mark.slow)])
def test_corners_of_ends_that_meet(run, tmp_path, step, ranks):
    """A split ring closes at the inner corners of its ends. The bore beside them sees itself across the ring: that gap has multipliers of its own, and does not hold the corners open."""
    one = run(scene(tmp_path, "splitring.geo", RING % "surface: [c_s, c_e, inner]", "verify/scenes"), "-load_step", step, ranks=ranks)
    pair = run(scene(tmp_path, "splitring.geo", RING % "nonmortar: c_s, mortar: c_e", "verify/scenes"))
    assert one.returncode == 0 and pair.returncode == 0, (one, pair)
    assert one.summary["energy"] == pytest.approx(pair.summary["energy"], rel=1e-6)


@pytest.mark.parametrize("ranks", [pytest.param(2, marks=pytest.mark.slow), 3])
def test_ranks(run, tmp_path, ranks):
    results = [run(scene(tmp_path, "notch.geo", NOTCH), ranks=n) for n in (1, ranks)]
    energy = [r.summary["energy"] for r in results]
    assert energy[1] == pytest.approx(energy[0], rel=1e-8)


@pytest.mark.parametrize("contact, words", [
    ("{flanks: {surface: flanks, mortar: left}}", ["contact.flanks.surface", "mortar"]),
    ("{flanks: {surface: flanks, roles: given}}", ["contact.flanks.surface", "roles"]),
    ("{flanks: {surface: flanks, initial_gap: ramp}}", ["contact.flanks.surface", "initial_gap"]),
    ("{flanks: {surface: flanks, kind: tied}}", ["contact.flanks.surface", "tied"]),
    ("{flanks: {nonmortar: flanks}}", ["contact.flanks", "mortar", "surface"]),
    ("{flanks: {nonmortar: flanks, mortar: flanks}}", ["contact.flanks", "surface: flanks"]),
    ("{flanks: {surface: flank}}", ["contact.flanks.surface", "flank"]),
])
def test_wrong_pairs(run, tmp_path, contact, words):
    result = run(scene(tmp_path, "notch.geo", NOTCH.replace("{flanks: {surface: flanks}}", contact)))
    assert result.returncode == 1
    for word in words:
        assert word in result.stderr, result.stderr


def test_small_kinematics_and_rigid_bodies_are_refused(run, tmp_path):
    small = run(scene(tmp_path, "notch.geo", NOTCH.replace("neo_hookean", "linear") + "kinematics: small\n"))
    assert small.returncode == 1 and "kinematics" in small.stderr
    rigid = run(scene(tmp_path, "discs.geo", DISCS.replace("hard: {law: neo_hookean, E: 3, nu: 0.3}", "hard: {law: rigid}").replace("floor: {fix: y}, roof: {displacement: {y: -0.5*t}}", "left: {fix: x}")
                      .replace(", left: {fix: x}", "") % "{all: {surface: skins}}"))
    assert rigid.returncode == 1 and "contact.all.surface" in rigid.stderr and "rigid" in rigid.stderr


def enclosed(directory):
    """t and the area that the middle line of the tube encloses, over pi R^2: the mean of its two faces."""
    fields, found = mortise.Run(directory), []
    for time in fields.times():
        state = fields.state("bulk", time=time)
        X = numpy.asarray(state.X)[:, :2]
        x = X + numpy.column_stack([state.value("displacement.x"), state.value("displacement.y")])
        radius, both = numpy.hypot(*X.T), 0
        for face in (radius > 1.0035, radius < 0.9965):
            order = numpy.argsort(numpy.arctan2(X[face, 1], X[face, 0]))
            a, b = x[face][order].T
            both += 0.25 * abs(numpy.sum(a * numpy.roll(b, -1) - b * numpy.roll(a, -1)))
        found.append((time, both / numpy.pi))
    return numpy.array(sorted(found)).T


@pytest.mark.slow
def test_tube_collapses_on_itself(run, tmp_path):
    """P-10: the force of the line of contact and the area. The bore meets where middle lines are t = 0.01 apart: by reciprocity that adds t dF/dp to the area of
    the table, whose walls are thin. The quarter of the tube against a plate is the same state."""
    result = run("inputs/tube_self.yml", "-output_divide", 2)
    assert result.returncode == 0, result
    t, line = [10 * r["t"] for r in result.history], [abs(r["contact.walls.force.y"]) for r in result.history]
    for pressure, force in ((6.9969, 2.73), (7.9969, 4.30), (8.9969, 5.86), (9.9969, 7.43)):
        found = numpy.interp(pressure, t, line)
        print(pressure, found)
        assert found == pytest.approx(force, rel=0.01)
    times, areas = enclosed(result.directory)
    for pressure, area in ((5.9969, 0.2629), (6.9969, 0.2516), (7.9969, 0.2397), (8.9969, 0.2271), (9.9969, 0.2140)):
        found = numpy.interp(pressure / 10, times, areas)
        print(pressure, found)
        assert found == pytest.approx(area + 0.01 * (7.43 - 1.17) / 4 / numpy.pi, rel=0.01)
    for file in ("tube_self.yml", "tube_self.geo"):
        shutil.copy(ROOT / "inputs" / file, tmp_path / file)
    text = (tmp_path / "tube_self.yml").read_text()
    for old, new in (("  tube: {material: steel}", "  tube: {material: steel}\n  plate: {material: hard}"), ("nu: 0.3}", "nu: 0.3}\n  hard: {law: rigid}"),
                     ("{surface: bore}", "{nonmortar: bore, mortar: plate_face}"), ("order: 2\n", "order: 2\n  parameter: {whole: 0}\n")):
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / "quarter.yml").write_text(text)
    quarter = run(tmp_path / "quarter.yml")
    assert quarter.returncode == 0, quarter
    print(4 * quarter.summary["energy"], result.summary["energy"])
    assert result.summary["energy"] == pytest.approx(4 * quarter.summary["energy"], rel=1e-4)
    assert result.summary["contact"]["walls"]["max_pressure"] > 0


@pytest.mark.slow
def test_serpentine(run):
    """Energy of order 2 on 4 x 16 cells a limb: 0.0029169. FEBio's deck co41, another strip that is squeezed, takes 46 iterations in ten steps."""
    result = run("inputs/serpentine.yml")
    assert result.returncode == 0, result
    assert result.summary["energy"] == pytest.approx(0.0029169, rel=0.01)
    assert result.summary["newton_iterations"] <= 60 and result.summary["step_cuts"] == 0
    assert not [w for w in result.summary["warnings"] if "itself" in w]


def test_flange_does_not_meet_its_own_back(run, tmp_path):
    """A sheet of two limbs whose whole surface may meet itself and does not: as without that pair. The facet at the re-entrant corner saw the outer side of its own limb as soon as that bent."""
    (tmp_path / "flange.geo").write_text(SHEET)
    for name, pair in (("with", ", skin: {surface: [skin, end]}"), ("without", "")):
        (tmp_path / f"{name}.yml").write_text(FLANGE % pair)
    result, without = (run(tmp_path / f"{name}.yml") for name in ("with", "without"))
    assert result.returncode == 0 and without.summary["energy"] > 0, result
    assert result.summary["energy"] == pytest.approx(without.summary["energy"], rel=1e-9)
    assert result.summary["newton_iterations"] == without.summary["newton_iterations"]
