"""A mortar side with edges: each of its smooth faces has multipliers of its own, and the pair is one in what a run tells and writes."""
import pathlib
import re

import h5py
import numpy as np
import pytest

from boxmesh import write
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


FIR_TREE = [("fir_tree", 1, "root", "groove"), ("fir_tree", 2, "root", "groove"), ("fir_tree", 3, "root", "groove"), ("fir_tree3d", 1, "root", "groove"),
            ("fir_tree3d", 2, "root", "groove"), ("fir_tree3d", 2, "blade_skin", "disk_skin")]


@pytest.mark.parametrize("scene,order,blade,disk", FIR_TREE)
@pytest.mark.parametrize("swapped", [False, True], ids=["given", "swapped"])
def test_fir_tree(run, scene, order, blade, disk, swapped):
    """Coarse flanks, an edge at either end of each, play: what passes the end of a flank and meets the one behind it is no gap of that flank.

    Forces are along the flanks' normals, (3, 2) and (0.3, 0.2), whatever the pressures.
    """
    nonmortar, mortar = (disk, blade) if swapped else (blade, disk)
    sides = ("-contact_c_nonmortar", nonmortar, "-contact_c_mortar", mortar)
    result = run(f"tests/gauntlet/{scene}.yml", "-order", order, *sides, "-output_fields", "false", "-snes_monitor")
    x, y, *_ = result.summary["contact"]["c"]["force"]
    assert result.returncode == 0 and abs(y) == pytest.approx(0.21 if scene == "fir_tree3d" else 0.7, rel=1e-6), result  # the traction on the top
    assert 1.44 < abs(x / y) < 1.53, (x, y)
    assert result.summary["newton_iterations"] <= 12, result
    assert is_quadratic(steps(result)[-1]), steps(result)


@pytest.mark.parametrize("scene", ["fir_tree", "fir_tree3d"])
def test_fir_tree_on_ranks(run, scene):
    one, two, three = (run(f"tests/gauntlet/{scene}.yml", "-output_fields", "false", ranks=ranks).summary for ranks in (1, 2, 3))
    for other in (two, three):
        assert other["energy"] == pytest.approx(one["energy"], rel=1e-8)
        assert other["contact"]["c"]["force"][:2] == pytest.approx(one["contact"]["c"]["force"][:2], rel=1e-8)


@pytest.mark.parametrize("gap", [0.01, -0.005])
@pytest.mark.parametrize("sides", [("left_teeth", "right_teeth"), ("right_teeth", "left_teeth")], ids=["given", "swapped"])
def test_a_face_hides_those_of_other_parts(run, sides, gap):
    """Teeth behind teeth of a comb: a search no further than a facet finds the same."""
    options = ("-order", 1, "-load_step", 0.5, "-mesh_parameter_gap", gap, "-contact_teeth_nonmortar", sides[0], "-contact_teeth_mortar", sides[1])
    far, near = run("tests/verify/scenes/comb.yml", *options), run("tests/verify/scenes/comb.yml", *options, "-contact_teeth_search", 1)
    print(far.summary["energy"], near.summary["energy"])
    assert far.returncode == near.returncode == 0 and far.summary["energy"] == pytest.approx(near.summary["energy"], rel=1e-9)


def test_thread(run):
    """Three threads of a bolt as one pair: 1.5 % of what cells split to an estimated error of 5 % say, 14.69e3."""
    result = run("inputs/thread.yml", "-output_fields", "false", "-load_step", 1)
    assert result.returncode == 0 and result.summary["contact"]["thread"]["force"][1] == pytest.approx(14.69e3, rel=0.015), result.summary["contact"]


STUDS = """
mesh: {file: studs.msh}
model: 3d
body: {pad: {material: m}, plate: {material: k}}
material: {m: {law: neo_hookean, E: 1, nu: 0.3}, k: {law: neo_hookean, E: 20, nu: 0.3}}
boundary: {bottom: {fix: xyz}, head: {displacement: {x: 0, y: 0, z: "-0.15*t"}}}
contact: {c: {nonmortar: face, mortar: studs}}
load: {step: 0.5}
"""


def studs(path):
    """A plate with nine studs under a pad: cells of 0.3, those of the pad of 0.35."""
    cells = {(i, j): [(0.3 * i, 0.3 * j, 0, 0.3, 0.3)] for i in range(7) for j in range(7)}
    for at in cells:
        if at[0] % 2 and at[1] % 2: cells[at].append((0.3 * at[0], 0.3 * at[1], 0.3, 0.3, 0.2))
    boxes = [(at, box) for at, column in cells.items() for box in column]
    pad = [(0.35 * i - 0.175, 0.35 * j - 0.175, 0.51 + 0.2 * k, 0.35, 0.2) for i in range(7) for j in range(7) for k in range(2)]

    def side(name, centre, block):
        if block >= len(boxes):
            return {"z0": "face", "z1": "head"}.get(name) if (name == "z0") == ((block - len(boxes)) % 2 == 0) else None
        at, box = boxes[block]
        if box[2] > 0: return "studs" if name != "z0" else None
        if name == "z0": return "bottom"
        return "studs" if name == "z1" and len(cells[at]) == 1 else None

    def to(box):
        return lambda x, y, z: (box[0] + box[3] * x, box[1] + box[3] * y, box[2] + box[4] * z)

    return write(path, [[0, 1]] * 3, to=[to(box) for _, box in boxes] + [to(box) for box in pad], side=side,
                 body=lambda centre, block: "plate" if block < len(boxes) else "pad")


def test_what_faces_stand_on_is_not_between_them(run, tmp_path):
    """Else each of the 36 flanks of the studs would have multipliers of its own."""
    studs(tmp_path / "studs.msh")
    result = run("studs.yml", "-output_fields", "false", text=STUDS)
    with h5py.File(result.directory / "checkpoint.h5") as file:
        parts = sum(name.startswith("multiplier.") for name in file["fields"])
    assert result.returncode == 0 and parts <= 6 and result.summary["newton_iterations"] <= 19, (parts, result)


KEY = """
mesh: {file: %s, order: 2}
model: plane_strain
order: 2
body: {key: {material: m}, hub: {material: m}}
material: {m: {law: neo_hookean, E: 1000, nu: 0.3}}
boundary: {base: {fix: xy}, top: {traction: {x: 2, y: -2}}}
contact: {c: {nonmortar: skin, mortar: slot}}
""" % (pathlib.Path(__file__).resolve().parent / "scenes" / "key.geo")


def key(run, *options):
    """Energies in one step and in four."""
    found = [run("key.yml", "-output_fields", "false", "-load_step", step, *options, text=KEY) for step in (1, 0.25)]
    for result in found:
        if not result.solved: pytest.fail(str(result))  # not what is expected to fail
    return [result.summary["energy"] for result in found]


@pytest.mark.xfail(strict=True, raises=AssertionError, reason="where a lip of the mortar side ends within a facet, forces have a part along it (docs/theory.md, after (5.8))")
def test_key_in_its_slot(run):
    one, four = key(run)
    print(one, four)
    assert one == pytest.approx(four, rel=1e-6)


def test_key_in_its_slot_with_a_frozen_segmentation(run):
    one, four = key(run, "-newton_frozen_segmentation", "on")
    print(one, four)
    assert one == pytest.approx(four, rel=1e-6)
