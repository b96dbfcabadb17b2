"""Stable equilibria (load.stable): columns beyond their critical load, free, against a wall, and as many ranks find the same; what is left as it is; descent (-solve_descent)."""
import json
import math
import re

import pytest

from boxmesh import linspace, write

LENGTH, HEIGHT, E, NU = 20, 1, 100, 0.3
EULER = math.pi**2 / 3 * (HEIGHT / LENGTH) ** 2  # strain; a little less for the column's shear


def column(tmp_path, strain, steps, force=0, order=2, **load):
    """Between clamped ends, one of which is pushed towards the other."""
    write(tmp_path / "column.msh", [linspace(0, LENGTH, 16), linspace(0, HEIGHT, 1)])
    return json.dumps({"mesh": {"file": "column.msh"}, "model": "plane_strain", "order": order, "body": {"body": {"material": "m", "force": {"y": force}}},
                       "material": {"m": {"law": "neo_hookean", "E": E, "nu": NU}},
                       "boundary": {"x0": {"fix": "xy"}, "x1": {"displacement": {"x": -strain * LENGTH, "y": 0}}}, "load": {"step": 1 / steps, "step_max": 1 / steps, **load},
                       "probe": {"middle": {"x": LENGTH / 2, "y": HEIGHT / 2}}, "output": {"fields": False}})


def solved(run, text, *options, ranks=1):
    result = run("column.yml", *options, text=text, ranks=ranks)
    assert result.returncode == 0, result
    return result


def test_column_buckles(run, tmp_path):
    """Straight below the load of Euler; beyond it a deflection as that of a column which is not quite straight, a load that grows little from that of Euler on, in every step
    a stable state. Without the key it stays straight, and that is counted."""
    below = solved(run, column(tmp_path, 0.9 * EULER, 1)).summary
    assert below["stabilised"] == below["unstable_equilibria"] == 0 and abs(below["probe"]["middle"]["displacement"][1]) < 1e-10
    free = solved(run, column(tmp_path, 3 * EULER, 3))
    bent = solved(run, column(tmp_path, 3 * EULER, 3, force=1e-5))
    straight = solved(run, column(tmp_path, 3 * EULER, 3, stable=False))
    s = free.summary
    deflection = [abs(x.summary["probe"]["middle"]["displacement"][1]) for x in (free, bent, straight)]
    print("deflection", deflection, "load", [x.summary["reaction"]["x0"][0] for x in (free, bent, straight)], "energy", [x.summary["energy"] for x in (free, bent, straight)])
    assert s["unstable_equilibria"] == 0 and 1 <= s["stabilised"] <= 2 and "unstable" in free.stdout
    assert deflection[0] == pytest.approx(deflection[1], rel=0.01) and deflection[0] > 1
    assert s["reaction"]["x0"][0] == pytest.approx(E / (1 - NU**2) * EULER * HEIGHT, rel=0.05)
    assert straight.summary["unstable_equilibria"] == 2 and straight.summary["stabilised"] == 0 and deflection[2] < 1e-8
    assert s["energy"] < 0.7 * straight.summary["energy"]


STRUT = """
Point(1) = {-0.1, 0, 0, 0.1}; Point(2) = {0.1, 0, 0, 0.1}; Point(3) = {0.1, 6, 0, 0.1}; Point(4) = {-0.1, 6, 0, 0.1};
Point(5) = {-0.8, -0.5, 0, 0.5}; Point(6) = {-0.35, -0.5, 0, 0.5}; Point(7) = {-0.35, 6.5, 0, 0.5}; Point(8) = {-0.8, 6.5, 0, 0.5};
Point(9) = {0.35, -0.5, 0, 0.5}; Point(10) = {0.8, -0.5, 0, 0.5}; Point(11) = {0.8, 6.5, 0, 0.5}; Point(12) = {0.35, 6.5, 0, 0.5};
For i In {0:2}
  For k In {1:4}
    Line(4 * i + k) = {4 * i + k, 4 * i + k % 4 + 1};
  EndFor
  Curve Loop(i + 1) = {4 * i + 1 : 4 * i + 4}; Plane Surface(i + 1) = {i + 1};
EndFor
Transfinite Curve{1, 3} = 3; Transfinite Curve{2, 4} = 41; Transfinite Surface{:}; Recombine Surface{:};
Physical Surface("strut") = {1}; Physical Surface("left") = {2}; Physical Surface("right") = {3};
Physical Curve("foot") = {1}; Physical Curve("east") = {2}; Physical Curve("head") = {3}; Physical Curve("west") = {4}; Physical Curve("to_left") = {6}; Physical Curve("to_right") = {12};
"""


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_from_one_unstable_state_to_the_next(run, tmp_path, ranks):
    """A strut between walls that is shortened to many times its critical load in one step: the first equilibrium that the descent comes to is unstable as well, and it goes on from there. (It
    stayed straight, with three times the energy, away from the walls.)"""
    (tmp_path / "strut.geo").write_text(STRUT)
    text = json.dumps({"mesh": {"file": "strut.geo", "order": 1}, "model": "plane_strain", "order": 2, "output": {"fields": False}, "load": {"step": 1},
                       "body": {"strut": {"material": "m"}, "left": {"material": "r"}, "right": {"material": "r"}},
                       "material": {"m": {"law": "neo_hookean", "E": 10, "nu": 0.3}, "r": {"law": "rigid"}},
                       "boundary": {"foot": {"fix": "xy"}, "head": {"displacement": {"x": 0, "y": -1}}},
                       "contact": {"l": {"nonmortar": "west", "mortar": "to_left"}, "r": {"nonmortar": "east", "mortar": "to_right"}}})
    strut = solved(run, text, "-mat_mumps_icntl_13", 1, ranks=ranks).summary
    print(strut["energy"], strut["contact"])
    assert strut["stabilised"] == 1 and strut["unstable_equilibria"] == 0 and strut["energy"] < 0.072 and strut["contact"]["l"]["force"][0] > 0.05


ADAPTED = ("-adapt_tolerance", 1e-6, "-adapt_max_passes", 2)


DISC = """
s = 0.12; Point(1) = {0, 0, 0, s}; Point(2) = {0.5, 0, 0, s}; Point(3) = {0, 0.5, 0, s}; Point(4) = {-0.5, 0, 0, s}; Point(5) = {0, -0.5, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(11) = {-0.8, 0.505, 0, s}; Point(12) = {0.8, 0.505, 0, s}; Point(13) = {0.8, 0.8, 0, s}; Point(14) = {-0.8, 0.8, 0, s};
Point(21) = {-0.8, -0.505, 0, s}; Point(22) = {0.8, -0.505, 0, s}; Point(23) = {0.8, -0.8, 0, s}; Point(24) = {-0.8, -0.8, 0, s};
For i In {0:3}
  Line(11 + i) = {11 + i, 11 + (i + 1) % 4}; Line(21 + i) = {21 + i, 21 + (i + 1) % 4};
EndFor
Curve Loop(2) = {11:14}; Plane Surface(2) = {2}; Curve Loop(3) = {21:24}; Plane Surface(3) = {3};
Physical Surface("disc") = {1}; Physical Surface("lid") = {2}; Physical Surface("floor") = {3};
Physical Curve("rim") = {1:4}; Physical Curve("above") = {11}; Physical Curve("below") = {21};
"""


def fall(result):
    """Of the energy along the mode, in percent."""
    return float(re.search(r"energy falls by (\S+) % of the strain energy", result.stdout).group(1))


def test_fall_of_the_energy(run, tmp_path):
    """Of a column that buckles some percent along the mode. Of a disc between plates, whose mesh alone says that it is to turn, less than what its
    error leaves room for, 3.4 % in the energy norm."""
    (tmp_path / "disc.geo").write_text(DISC)
    disc = solved(run, json.dumps({"mesh": {"file": "disc.geo", "order": 2}, "model": "plane_strain", "order": 2, "output": {"fields": False},
                                   "body": {"disc": {"material": "m"}, "lid": {"material": "r", "motion": {"y": "-0.1*t"}}, "floor": {"material": "r"}},
                                   "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}, "r": {"law": "rigid"}}, "load": {"step": 0.25},
                                   "contact": {"a": {"nonmortar": "rim", "mortar": "above"}, "b": {"nonmortar": "rim", "mortar": "below"}}}))
    buckled = solved(run, column(tmp_path, 3 * EULER, 1))
    print("fall, %", fall(disc), fall(buckled))
    assert 0 < fall(disc) < 100 * 0.034**2 and fall(buckled) > 1


CUBE = """
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1}; Box(2) = {-1, -1, -1.01, 3, 3, 1}; Box(3) = {-1, -1, 1.01, 3, 3, 1};
Transfinite Curve{:} = 3; Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};
Physical Volume("cube") = {1}; Physical Volume("floor") = {2}; Physical Volume("lid") = {3};
Physical Surface("under") = {5}; Physical Surface("over") = {6}; Physical Surface("below") = {12}; Physical Surface("above") = {17};
"""


@pytest.mark.parametrize("ranks", [1, 2])
def test_free_cube(run, tmp_path, ranks):
    """Squeezed between two plates, free to slide and turn along them: the same uniform state in steps of any size, and round-off of neutral modes makes none of them unstable."""
    (tmp_path / "cube.geo").write_text(CUBE)
    text = json.dumps({"mesh": {"file": "cube.geo", "order": 1}, "model": "3d", "order": 2, "output": {"fields": False},
                       "body": {"cube": {"material": "m"}, "lid": {"material": "r", "motion": {"z": "-0.22*t"}}, "floor": {"material": "r"}},
                       "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.49}, "r": {"law": "rigid"}},
                       "contact": {"a": {"nonmortar": "over", "mortar": "above"}, "b": {"nonmortar": "under", "mortar": "below"}}})
    results = [solved(run, text, "-load_step", step, ranks=ranks) for step in (0.25, 0.34, 0.5, 1)]
    for result in results:
        assert "unstable" not in result.stdout and result.summary["unstable_equilibria"] in (0, None), result
        assert result.summary["energy"] == pytest.approx(results[0].summary["energy"], rel=1e-9)


@pytest.mark.parametrize("repeat", ["step", "path"])
def test_accepted_ones_are_counted(run, tmp_path, repeat):
    """Passes of adaptation, and paths, on coarser meshes find unstable states too: those that are kept count, and none is warned of where all of these gave way."""
    kept, gone = (run("column.yml", *ADAPTED, "-adapt_repeat", repeat, text=column(tmp_path, 3 * EULER, 3, stable=stable)) for stable in (False, True))
    assert kept.solved and kept.summary["unstable_equilibria"] == 2 and "2 solutions are unstable, the first at t = 0.666667" in kept.stdout, kept
    assert gone.solved and gone.summary["stabilised"] > 0 and gone.summary["unstable_equilibria"] == 0 and "unstable, the first" not in gone.stdout, gone


def test_the_first_is_told_after_a_restart(run, tmp_path):
    text = column(tmp_path, 3 * EULER, 3, stable=False)
    part = run("column.yml", "-load_max_steps", 2, text=text)
    result = solved(run, text, "-restart", part.directory / "checkpoint.h5")
    assert "2 solutions are unstable, the first at t = 0.666667" in result.stdout, result


@pytest.mark.parametrize("order,condense", [(1, "no"), (3, "yes")])
def test_same_side_on_any_number_of_ranks(run, tmp_path, order, condense):
    one, two = (solved(run, column(tmp_path, 3 * EULER, 1, order=order), "-solve_condense", condense, ranks=ranks).summary for ranks in (1, 2))
    assert one["stabilised"] == two["stabilised"] == 1
    assert one["probe"]["middle"]["displacement"] == pytest.approx(two["probe"]["middle"]["displacement"], rel=1e-8)


@pytest.mark.parametrize("side", [1, -1])
def test_lower_side(run, tmp_path, side):
    """A small load across decides to which side the column goes, however large the step."""
    s = solved(run, column(tmp_path, 3 * EULER, 1, force=side * 1e-4)).summary
    assert side * s["probe"]["middle"]["displacement"][1] > 1 and s["unstable_equilibria"] == 0


def test_incompressible_columns_are_told(run, tmp_path):
    """No energy of the displacements alone: nothing is done but counted."""
    scene = json.loads(column(tmp_path, 3 * EULER, 1))
    scene["material"]["m"]["nu"] = 0.5
    s = solved(run, json.dumps(scene)).summary
    assert s["unstable_equilibria"] == 1 and s["stabilised"] == 0


def beside(tmp_path, scene):
    """A second block beside the column, at a distance of 5."""
    write(tmp_path / "column.msh", [linspace(0, LENGTH, 16), linspace(0, HEIGHT, 1)], [lambda x, y: (x, y), lambda x, y: (x, y + 5)],
          side=lambda name, centre, block: name + "b" * block, body=lambda centre, block: "b" if block else "body")
    scene["body"]["b"] = {"material": "m"}


@pytest.mark.parametrize("kind,ranks", [("j2", 1), ("j2", 3), ("pressure", 1)])
def test_tangents_that_are_not_symmetric(run, tmp_path, kind, ranks):
    """Of a metal, before it flows, and under a follower pressure: the symmetric part tells that each of two columns has a direction to buckle in. An even number
    of them leaves the sign of the determinant as it is."""
    scene = json.loads(column(tmp_path, 1.8 * EULER, 2, order=3))
    beside(tmp_path, scene)
    scene["boundary"] |= {"x0b": scene["boundary"]["x0"], "x1b": scene["boundary"]["x1"]}
    if kind == "j2":
        scene["material"]["m"].update(law="j2", **{"yield": 1e3})
    else:
        scene["boundary"]["y0"] = {"pressure": 1e-9}
    result = solved(run, json.dumps(scene), ranks=ranks)
    assert result.summary["unstable_equilibria"] == 1 and "1 solution is unstable, the first at t = 1" in result.stdout, result


def test_told_by_the_determinant(run, tmp_path):
    """With friction, here of a pair that never touches, the sign of the determinant tells of the one direction that a column has to buckle in."""
    scene = json.loads(column(tmp_path, 1.8 * EULER, 2, order=3))
    beside(tmp_path, scene)
    scene["body"]["b"], scene["material"]["r"] = {"material": "r"}, {"law": "rigid"}
    scene["contact"] = {"c": {"nonmortar": "y1", "mortar": "y0b", "friction": 0.3}}
    result = solved(run, json.dumps(scene))
    assert result.summary["unstable_equilibria"] == 1 and "1 solution is unstable, the first at t = 1" in result.stdout, result


def test_times_are_the_decimals_they_are_meant_to_be(run, tmp_path):
    """Steps of 0.05 add up to 1 and a little: what begins after t = 1 has not begun there."""
    scene = json.loads(column(tmp_path, 0, 20, order=1))
    scene["boundary"]["x1"]["displacement"]["x"] = "t > 0.3 ? -0.01 : 0"
    result = solved(run, json.dumps(scene), "-load_end", 0.35)
    assert [row["reaction.x1.x"] != 0 for row in result.history] == 6 * [False] + [True], result


@pytest.mark.parametrize("ranks", [1, 2])
def test_stays_stable_on_finer_meshes(run, ranks):
    """A slender strut that buckles twice between walls, in one step: 150 iterations down from the straight state, and on the finer mesh down from what was found on the coarser
    one, for the way of the load leads to the straight state again (four times the energy; it was accepted)."""
    result = run("tests/gauntlet/walls.yml", "-load_step", "1", "-adapt_tolerance", "0.02", "-output_fields", "false", ranks=ranks)
    assert result.returncode == 0 and result.summary["stabilised"] == 1 and result.summary["unstable_equilibria"] == 0, result
    assert result.summary["energy"] == pytest.approx(16.357, rel=1e-3)
