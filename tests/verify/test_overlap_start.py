"""Overlap at the start that is deep against the radius of the tip: no load parameter scales it, so the step cannot be cut."""
import json

import pytest

from boxmesh import linspace, write
from test_hostile import MATERIAL

SCENES = {"soft": ("-mesh_parameter_r", 0.05, "-mesh_parameter_o", 0.6, "-material_rubber_nu", 0.3), "compressible": ("-mesh_parameter_r", 0.05, "-mesh_parameter_o", 0.6, "-material_rubber_nu", 0.4)}


@pytest.mark.parametrize("name", [pytest.param("soft", marks=pytest.mark.slow), "compressible"])
def test_taken_up_in_pieces(run, name):
    """The deepest place first, the whole load from the first piece on; in one step nothing is found."""
    options = ("tests/gauntlet/wiper.yml", *SCENES[name], "-output_fields", "false")
    pieces, one = run(*options), run(*options, "-path_overlap", "off", "-load_step_min", 0.4)
    assert pieces.returncode == 0 and one.returncode == 2, (pieces, one)
    assert pieces.summary["recoveries"]["overlap"] == {"tried": 1, "succeeded": 1} and pieces.summary["load_steps"] == 1
    assert one.summary["recoveries"]["overlap"]["tried"] == 0
    force = pieces.summary["contact"]["c"]["force"]
    assert force[1] == pytest.approx(-pieces.summary["reaction"]["arm"][1], rel=1e-8) and abs(force[0]) < 1e-6 * force[1]


def test_only_where_one_step_does_not_do(run):
    result = run("tests/gauntlet/wiper.yml", "-order", 2, "-output_fields", "false")
    assert result.returncode == 0 and result.summary["recoveries"]["overlap"]["tried"] == 0 and result.summary["newton_iterations"] <= 12


# ---- where no pair is -----------------------------------------------------------------------------------------------------------------------

TOLD = "bodies l and u overlap in the mesh, at "


def two(path, dim, up, cells=2, contact=None, rigid=(), scale=1):
    """A block l and a block u that `up` moves, both held."""
    write(path / "two.msh", [linspace(0, 1, cells)] * dim, [lambda *x: x, lambda *x: tuple(scale * a + b for a, b in zip(x, up))], side=lambda name, centre, b: f"{name}_{'lu'[b]}",
          body=lambda centre, b: "lu"[b])
    scene = {"mesh": {"file": "two.msh"}, "model": "3d" if dim == 3 else "plane_strain", "material": {"m": MATERIAL, "r": {"law": "rigid"}}, "load": {"step": 1},
             "body": {name: {"material": "r" if name in rigid else "m"} for name in "lu"}, "boundary": {f"y0_{name}": {"fix": "xyz"[:dim]} for name in "lu" if name not in rigid}}
    if contact: scene["contact"] = {"pair": {"nonmortar": "x1_l", "mortar": "x0_u"} | contact}
    scene["material"] = {name: scene["material"][name] for name in {"m": len(rigid) < 2, "r": bool(rigid)} if {"m": len(rigid) < 2, "r": bool(rigid)}[name]}
    return json.dumps(scene)


@pytest.mark.parametrize("dim, ranks", [(2, 1), (2, 2), (3, 1), pytest.param(3, 2, marks=pytest.mark.slow)])
def test_no_pair_between_them(run, tmp_path, dim, ranks):
    """Told with a place in both bodies, by a run and before it."""
    text = two(tmp_path, dim, (0.8, 0.3, 0.1))
    for options in ("-check",), ():
        result = run("s.yml", *options, text=text, ranks=ranks)
        assert result.returncode == 0 and result.stdout.count(TOLD) == 1, result
        x, y = (float(word) for word in result.stdout.split(TOLD + "(")[1].split(",")[:2])
        assert 0.5 < x < 1.3 and 0 < y < 1.3, result
    assert any(TOLD in line for line in result.summary["warnings"]), result


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("up,more,told", [
    ((1, 0, 0), {}, False), ((1, 0.3, 0.3), {}, False), ((1, 0.25, 0.25), {}, False), ((1 + 1e-9, 0, 0), {}, False), ((1 - 1e-4, 0.3, 0.1), {}, False),  # they touch
    ((0.8, 0.3, 0.1), {"rigid": "l"}, True), ((0.8, 0.3, 0.1), {"rigid": "lu"}, False),
    ((0.8, 0.3, 0.1), {"contact": {"initial_gap": "ramp"}}, False), ((0.8, 0.3, 0.1), {"contact": {"kind": "tied"}}, False),
])
def test_where_it_is_meant(run, tmp_path, dim, up, more, told):
    result = run("s.yml", "-check", text=two(tmp_path, dim, up, **more))
    assert (TOLD in result.stdout) == told and result.returncode in (0, 1), result


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("up,more,told", [((0.4, 0.3, 0.4), {}, True), ((0.4, 0.3, 0.4), {"rigid": "u"}, True), ((1.4, 0.3, 0.4), {}, False),
                                          ((0.4, 0.3, 0.4), {"contact": {"initial_gap": "ramp"}}, False)])
def test_one_wholly_inside_the_other(run, tmp_path, dim, up, more, told, ranks):
    """No surface crosses: told all the same; not beside it, nor where a pair is between them."""
    if ranks == 3 and not told: pytest.skip("one process will do")
    result = run("s.yml", "-check", text=two(tmp_path, dim, up, scale=0.25, cells=3, **more), ranks=ranks)
    assert ("body u lies wholly inside body l in the mesh, at (" in result.stdout) == told and TOLD not in result.stdout and result.returncode in (0, 1), result


def test_inside_and_flush(run, tmp_path):
    """One inside the other, whose bottoms lie in one line."""
    result = run("s.yml", "-check", text=two(tmp_path, 2, (0.4, 0), scale=0.25, cells=3))
    assert TOLD in result.stdout and result.returncode == 0, result
