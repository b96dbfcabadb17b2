"""Bodies inside each other while their pair bears nothing are no solution (src/diagnose/inside.c): a small block that is moved deep into a large one in one step, where contact is no
longer seen."""
import json

import pytest

from boxmesh import linspace, write

RUBBER, RIGID = {"law": "neo_hookean", "E": 1, "nu": 0.3}, {"law": "rigid"}
SLOW = pytest.mark.slow
GIVE_UP = ("-load_step_min", 0.6, "-path_viscous", "off", "-path_through", "off", "-output_fields", "false")


def scene(path, dim, heights, ways, law=RUBBER, across=0):
    """A large block of height 1, and small ones, 0.2 high, whose bottoms begin at these heights and move down this far, and across."""
    up, num, rigid = "xyz"[dim - 1], len(heights), law["law"] == "rigid"
    names = ["large", *(f"small{k}" for k in range(num))]

    def small(k):
        return lambda *x: tuple(0.2 + (0.5 * k + 0.3 * c) / num for c in x[:-1]) + (heights[k] + 0.2 * x[-1],)

    def side(name, centre, block):
        return {f"{up}0": "bottom_", f"{up}1": "top_"}[name] + names[block] if name[0] == up else None

    write(path / "blocks.msh", [linspace(0, 1, 3)] * dim, [lambda *x: x, *map(small, range(num))], side=side, body=lambda centre, block: names[block])
    motion = [{axis: -way if axis == up else across * (axis == "x") for axis in "xyz"[:dim]} for way in ways]
    return json.dumps({"mesh": {"file": "blocks.msh"}, "model": "plane_strain" if dim == 2 else "3d", "material": {"rubber": RUBBER, "other": law}, "load": {"step": 1},
                       "body": {"large": {"material": "rubber"}} | {name: {"material": "other"} | ({"motion": u} if rigid else {}) for name, u in zip(names[1:], motion)},
                       "boundary": {"bottom_large": {"fix": "xyz"[:dim]}} | {f"top_{name}": {"displacement": u} for name, u in zip(names[1:], motion) if not rigid},
                       "contact": {name: {"nonmortar": "top_large", "mortar": f"bottom_{name}"} for name in names[1:]}})


@pytest.mark.parametrize("dim, law, ranks", [(2, RUBBER, 1), (2, RIGID, 1), (3, RUBBER, 1), (3, RIGID, 1), (2, RIGID, 2),
                                             *(pytest.param(*words, 2, marks=SLOW) for words in ((2, RUBBER), (3, RUBBER), (3, RIGID)))])
def test_deep_inside(run, tmp_path, dim, law, ranks):
    """Not found where half of the step is too long; without the question no force, with exit 0."""
    text = scene(tmp_path, dim, [1.001], [0.7], law)
    told, without = (run("s.yml", *GIVE_UP, *words, text=text, ranks=ranks) for words in ((), ("-path_inside", "off")))
    assert told.returncode == 2 and told.summary["refused_solutions"] == 1, told
    assert without.returncode == 0 and not any(without.summary["contact"]["small0"]["force"]), without


@pytest.mark.parametrize("dim", [2, 3])
def test_as_the_mesh_has_them(run, tmp_path, dim):
    """Bodies that are so deep inside each other in the mesh that no contact is seen stay so, which a warning tells; a pair of that kind does not hide another one that comes to be so."""
    still = run("s.yml", *GIVE_UP, text=scene(tmp_path, dim, [0.3, 1.1], [0, 0.05]))
    assert still.returncode == 0 and still.summary["refused_solutions"] == 0, still
    assert any("pair small0 lie inside each other" in text for text in still.summary["warnings"]) and "small0 have not touched" not in still.stdout, still
    other = run("s.yml", *GIVE_UP, text=scene(tmp_path, dim, [0.3, 1.001], [0, 0.7]))
    assert other.returncode == 2 and other.summary["refused_solutions"] == 1, other


FLUSH = """
Point(1) = {0, 0, 0, 0.2}; Point(2) = {1, 0, 0, 0.2}; Point(3) = {1, 1, 0, 0.2}; Point(4) = {0, 1, 0, 0.2};
Point(11) = {a, -0.5, 0, 0.2}; Point(12) = {1 - a, -0.5, 0, 0.2}; Point(13) = {1 - a, 0.5, 0, 0.2}; Point(14) = {a, 0.5, 0, 0.2};
For i In {0:3}
  Line(1 + i) = {1 + i, 1 + (i + 1) % 4}; Line(11 + i) = {11 + i, 11 + (i + 1) % 4};
EndFor
Curve Loop(1) = {1:4}; Plane Surface(1) = {1}; Curve Loop(2) = {11:14}; Plane Surface(2) = {2}; Transfinite Surface{:}; Recombine Surface{:};
Physical Surface("lower") = {1}; Physical Surface("upper") = {2};
Physical Curve("bottom") = {1}; Physical Curve("hill") = {3}; Physical Curve("top") = {13}; Physical Curve("under") = {11};
"""


@pytest.mark.parametrize("aside", [0, 0.1])
def test_sides_that_passed_each_other(run, tmp_path, aside):
    """In the mesh, so that neither lies inside the other body, whose flanks are flush or not: that the bodies overlap is told."""
    (tmp_path / "b.geo").write_text(f"a = {aside};" + FLUSH)
    result = run("s.yml", text=json.dumps({"mesh": {"file": "b.geo"}, "model": "plane_strain", "body": {"lower": {"material": "m"}, "upper": {"material": "m"}},
                                           "material": {"m": RUBBER}, "boundary": {"bottom": {"fix": "xy"}, "top": {"displacement": {"x": 0, "y": -0.1}}},
                                           "contact": {"c": {"nonmortar": "under", "mortar": "hill"}}, "output": {"fields": False}}))
    assert any("pair c lie inside each other" in text for text in result.summary["warnings"]), result


TIPS = """
Point(1) = {0, 0, 0, 0.15}; Point(2) = {1, 0.9, 0, 0.15}; Point(3) = {1, 1.4, 0, 0.15}; Point(4) = {0, 1.4, 0, 0.15};
Point(5) = {0, -1.4, 0, 0.15}; Point(6) = {1, -1.4, 0, 0.15}; Point(7) = {1, -0.9, 0, 0.15}; Point(8) = {0, 0, 0, 0.15};
For i In {0:1}
  For j In {1:4}
    Line(4 * i + j) = {4 * i + j, 4 * i + 1 + j % 4};
  EndFor
  Curve Loop(1 + i) = {4 * i + 1:4 * i + 4}; Plane Surface(1 + i) = {1 + i}; Recombine Surface{1 + i};
EndFor
Physical Surface("a") = {1}; Physical Surface("b") = {2};
Physical Curve("as") = {1, 2}; Physical Curve("at") = {3}; Physical Curve("axis") = {4, 8}; Physical Curve("bb") = {5}; Physical Curve("bs") = {6, 7};
"""


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_tip_on_tip(run, tmp_path, ranks):
    """Halves of two wedges on a symmetry plane, whose flanks do not face each other: one goes into the other, where a tip is thinner than its facets are long."""
    (tmp_path / "tips.geo").write_text(TIPS)
    text = json.dumps({"mesh": {"file": "tips.geo"}, "model": "plane_strain", "order": 2, "body": {"a": {"material": "m"}, "b": {"material": "m"}}, "material": {"m": RUBBER},
                       "boundary": {"axis": {"fix": "x"}, "at": {"displacement": {"y": -0.3}}, "bb": {"fix": "y"}}, "contact": {"c": {"nonmortar": "as", "mortar": "bs"}}})
    told = run("tips.yml", "-load_step_min", 0.1, "-path_viscous", "off", "-output_fields", "false", text=text, ranks=ranks)
    assert told.returncode == 2 and told.summary["refused_solutions"] > 0 and "inside each other" in told.stdout, told


ARM = """
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 0.2, 0}; Point(4) = {1.7, 0.2, 0}; Point(5) = {1.7, 1.2, 0}; Point(6) = {1.5, 1.2, 0};
Point(7) = {1.5, 0.2, 0}; Point(8) = {0.2, 0.2, 0}; Point(9) = {0.2, 0.62, 0}; Point(10) = {1.3, 0.62, 0}; Point(11) = {1.3, 0.83, 0}; Point(12) = {0, 0.83, 0};
For i In {1:12}
  Line(i) = {i, i % 12 + 1};
EndFor
Curve Loop(1) = {1:12}; Plane Surface(1) = {1}; MeshSize {:} = 0.1;
Physical Surface("all") = {1}; Physical Curve("bottom") = {1}; Physical Curve("arm") = {9, 11}; Physical Curve("hull") = {4:6, 9:11};
"""


@pytest.mark.parametrize("ranks", [1, pytest.param(2, marks=SLOW)])
def test_arm_in_its_own_post(run, tmp_path, ranks):
    """The arm of a body is drawn through a post of the same body in one step; a search that is too short sees nothing."""
    (tmp_path / "arm.geo").write_text(ARM)
    text = json.dumps({"mesh": {"file": "arm.geo", "order": 1}, "model": "plane_strain", "body": {"all": {"material": "rubber"}}, "material": {"rubber": RUBBER},
                       "boundary": {"bottom": {"fix": "xy"}, "arm": {"displacement": {"x": "0.6*max(0, X - 0.2)/1.1", "y": 0}}}, "load": {"step": 1},
                       "contact": {"own": {"surface": "hull", "search": 0.01}}})
    told, without = (run("s.yml", *GIVE_UP, *words, text=text, ranks=ranks) for words in ((), ("-path_inside", "off")))
    assert told.returncode == 2 and told.summary["refused_solutions"] > 0, told
    assert without.returncode == 0 and not any(without.summary["contact"]["own"]["force"]), without


def test_corner_of_a_coil(run):
    """The end of a coil touches the next turn with a corner, within a facet: that far weighted gaps let it, and it is no contact that is lost."""
    result = run("tests/gauntlet/coil.yml", "-output_fields", "false")
    assert result.returncode == 0 and result.summary["refused_solutions"] == 0 and result.summary["newton_iterations"] < 200, result
    assert result.summary["energy"] == pytest.approx(0.00054735, rel=0.006), result  # that of the gauntlet, which need not run it again


@pytest.mark.parametrize("dim,across,ranks", [(2, 0, 1), (2, 0.03, 2), (3, 0.03, 1)])
def test_without_a_pair(run, tmp_path, dim, across, ranks):
    """Bodies that no pair is between pass through each other, and the run says so, where their nodes meet, too."""
    text = json.loads(scene(tmp_path, dim, [1.001], [0.3], across=across)) | {"contact": {}}
    result = run("s.yml", "-load_step", 0.5, text=json.dumps(text), ranks=ranks)
    assert result.returncode == 0 and result.stdout.count("overlap at t = 0.5") == 1 and "no contact pair is between them" in result.stdout, result
    apart = run("s.yml", text=json.dumps(text | {"boundary": text["boundary"] | {"top_small0": {"fix": "xyz"[:dim]}}}), ranks=ranks)
    assert apart.returncode == 0 and "overlap" not in apart.stdout, apart


@pytest.mark.parametrize("roles", ["auto", "given"])
def test_the_two_faces_of_one_body(run, tmp_path, roles):
    """A pair of the top and the bottom of a block, by mistake, does not take the block for an overlap."""
    text = json.loads(scene(tmp_path, 2, [1.2], [0.1]))
    text["contact"] = {"wrong": {"nonmortar": "top_large", "mortar": "bottom_large", "roles": roles}}
    result = run("s.yml", text=json.dumps(text))
    assert result.returncode == 0 and result.summary["newton_iterations"] < 10 and "have not touched" in result.stdout, result
