"""Section needs of summary.json: what could have been left out. Each promise is checked by running the simpler model."""
import json
import re
import subprocess
import sys

import pytest

from conftest import ROOT, module

sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests" / "needs")]
promised = module("promised", ROOT / "tests" / "needs" / "run.py")

QUIET = ("-output_fields", "false")


def rows(result, *parts):
    """What could have been left out of these parts of the model."""
    return {part: result.summary["needs"][part] for part in parts if part in result.summary["needs"]}


def scene(name):
    return re.sub(r"file: (\w+\.geo)", rf"file: {ROOT}/inputs/\1", (ROOT / "inputs" / f"{name}.yml").read_text())


def same(one, other):
    """Forces to 1e-8, energy to 1e-7 (law j2 takes it from tr be - 3, which at strains of 1e-5 keeps seven digits), the error estimate to 1e-3, on the same cells."""
    assert one.returncode == other.returncode == 0, (one, other)
    for key, tolerance in (("energy", 1e-7), ("min_det", 1e-9), ("estimated_error", 1e-3)):
        assert one.summary[key] == pytest.approx(other.summary[key], rel=tolerance, abs=1e-14), key
    for name, force in one.summary["reaction"].items():
        assert force == pytest.approx(other.summary["reaction"][name], rel=1e-8, abs=1e-12), name
    assert one.summary["cells"] == other.summary["cells"]


@pytest.mark.parametrize("adapt", [(), ("-order", 2, "-adapt_tolerance", 0.02)], ids=["as_it_is", "adapted"])
def test_pair_that_never_touches(run, adapt):
    text = scene("hertz2d").replace("y: -0.05", "x: 0, y: 0.05").replace("{x: 0, x: 0", "{x: 0").replace("disc:  {material: rubber}", "disc:  {material: rubber, force: {x: 0.01}}")
    pair = re.search(r"contact:\n.*\n", text)[0]
    with_pair, without = run("with.yml", *QUIET, *adapt, text=text), run("without.yml", *QUIET, *adapt, text=text.replace(pair, ""))
    need = with_pair.summary["needs"]["contact"]["disc_on_block"]
    assert need["change"] == 0 and need["keeps"] and need["set"] == {"contact.disc_on_block": None} and need["why"] == "its sides have not touched", with_pair
    assert not rows(with_pair, "flow")
    same(with_pair, without)


@pytest.mark.parametrize("adapt", [(), ("-adapt_tolerance", 0.02)], ids=["as_it_is", "adapted"])
def test_material_that_never_flows(run, adapt):
    text = scene("necking")
    law = re.search(r"steel:.*\n?.*law: j2.*?\}", text, re.S)[0]
    elastic = re.sub(r",\s*(yield|hardening|saturation|saturation_rate): [\d.e+-]+", "", law.replace("law: j2", "law: neo_hookean"))
    end = ("-load_end", 1e-4, "-load_step", 1e-4)
    plastic, simple = run("plastic.yml", *QUIET, *end, *adapt, text=text), run("elastic.yml", *QUIET, *end, *adapt, text=text.replace(law, elastic))
    need = plastic.summary["needs"]["flow"]
    assert list(need) == ["steel"] and need["steel"]["change"] == 0 and need["steel"]["set"]["material.steel"]["law"] == "neo_hookean", plastic
    assert "note: not needed: flow of steel (its material has not flowed" in plastic.stdout
    same(plastic, simple)


def test_matrix_that_pressure_makes_unsymmetric(run):
    """Without flow its cells are cheaper, the factors are not."""
    result = run("tests/needs/plate.yml", *QUIET, "-boundary_hole_pressure", 0.01)
    time, told = result.summary["time"], result.summary["needs"]["flow"]["steel"]["saves"]
    assert told <= 1.2 * (0.4 * (time["assemble"] + time["estimate"]) + 0.8 * time["transfer"]) / time["total"], (told, time)


def test_nothing_is_promised(run):
    """Of a pair that bears, a bar that flows, a run that was given up."""
    assert not rows(run("inputs/patch2d.yml", *QUIET), "contact", "flow")
    flowed = run("inputs/necking.yml", *QUIET, "-load_end", 0.05)
    assert flowed.returncode == 0 and flowed.summary["plastic_strain"] > 0 and not rows(flowed, "contact", "flow", "load_steps")
    assert run("inputs/hertz2d.yml", *QUIET, "-boundary_top_displacement_y", 0.05, "-load_step", 0.5, "-load_max_steps", 1).summary["needs"] == {}


def test_symmetry_is_told_before(run):
    """-check; not where a load goes across the plane, nor where the mesh is cut already."""
    told = "note: mesh, supports and loads are symmetric about x = 0: half is enough"
    assert told in run("inputs/hertz2d.yml", "-check").stdout
    assert told not in run("inputs/hertz2d.yml", "-check", "-boundary_top_displacement_x", 0.01).stdout
    assert told not in run("inputs/hertz2d.yml", "-check", "-body_disc_force_x", "0.01*t*(1-t)").stdout  # gone at the end
    assert "symmetric about" not in run("inputs/cylinder.yml", "-check").stdout


def test_no_revolution_where_the_load_goes_one_way(run):
    """The same quarter of tubes with one of them moved across: neither along nor around the axis does it stay as it is, and a load that is not along the axis is refused unseen."""
    told = run("inputs/shrinkfit3d.yml", *QUIET).summary["needs"]
    assert told["revolution"]["z"]["keeps"] and told["revolution"]["z"]["set"] == {"revolve": "z"}
    assert "revolution" not in run("inputs/shrinkfit3d.yml", *QUIET, "-boundary_ends_traction_x", 0).summary["needs"]


def test_no_promise_of_one_step_where_contact_begins_later(run):
    """The beam meets its stop in the second load step; bent to the end at once it would first be found far beyond."""
    told = run("tests/needs/stops.yml", *QUIET, "-mesh_parameter_n", 3).summary["needs"]
    assert not told["load_steps"]["scene"]["keeps"]


def test_no_promise_of_one_step_past_a_barrier(run):
    """An arch that is pushed through and left stays on the other side. At its end it stores less than on the way: in one step the punch, back where it was, would not be met."""
    found, once = run("tests/needs/snap.yml", *QUIET), run("tests/needs/snap.yml", *QUIET, "-load_step", 2)
    assert found.returncode == once.returncode == 0 and found.summary["step_cuts"] == 0
    assert found.summary["probe"]["middle"]["displacement"][1] < -9 and abs(once.summary["probe"]["middle"]["displacement"][1]) < 0.1
    assert not found.summary["needs"].get("load_steps", {}).get("scene", {}).get("keeps"), found


def test_forces_of_a_part():
    """Half of an arch thrusts against its foot, the whole one against itself; a section across y has z along x and x along y."""
    half = promised.simpler.Share().of({"set": {"plane": {"x": 0}}}, "", "")
    assert half.part == 0.5 and half.off([0, 2], [-5, 1]) == 0 and half.off([0, 2], [-5, -1]) == 4
    assert half.off([3, 2], [3, 2]) == 0  # a foot on one side of the plane
    section = promised.simpler.Share(1 / 3, ["z", "x"])
    assert section.off([-1, 0, 6], [2, -1 / 3]) == pytest.approx(0) and section.off([-1, 0, 6], [2, 1 / 3]) == pytest.approx(2)


def test_thrust_of_a_guided_beam(run):
    """One end moves across by a twentieth of the thickness, and may not come nearer: the beam pulls at its ends as much as it resists, which small kinematics does not see.
    Free to come nearer it does not pull."""
    text = (ROOT / "tests" / "needs" / "beam.yml").read_text().replace("beam.geo", str(ROOT / "tests" / "needs" / "beam.geo")).replace("  top:   {pressure: 4e-5}\n", "")
    guided, free = (run(f"{name}.yml", *QUIET, text=text.replace("right: {fix: xy}", f"right: {{displacement: {{{held}y: -0.05}}}}")) for name, held in (("guided", "x: 0, "), ("free", "")))
    force = guided.summary["reaction"]["right"]
    told = [result.summary["needs"]["kinematics"]["scene"]["change"] for result in (guided, free)]
    assert abs(force[0] / force[1]) > 1 and 0.5 < told[0] < 2.5 and told[1] < 0.1, (force, told)


def test_orders_of_a_linear_field(run, tmp_path):
    """A strip that is only stretched loses nothing with any order above 1."""
    text = (ROOT / "tests" / "needs" / "layer.yml").read_text().replace("layer.geo", str(ROOT / "tests" / "needs" / "layer.geo"))
    text = text.replace(', force: {x: "0.05*sin(2*X)"}', "").replace("right: {fix: x}", "right: {displacement: {x: 0.1}}")
    need = run("layer.yml", *QUIET, text=text).summary["needs"]["order"]["strip"]
    assert need["keeps"] and need["set"] == {"body.strip.order": 1} and need["change"] < 1e-6, need


def test_soft_body_is_not_rigid(run):
    """A sleeve that its neighbour stretches takes little energy since it is soft: it is no part that could be rigid."""
    soft = run("tests/needs/bush.yml", *QUIET, "-material_alloy_E", 1e-3, "-load_step", 1, "-adapt_tolerance", 0.2)
    assert soft.returncode == 0 and soft.summary["needs"]["rigid"]["core"]["keeps"] and not soft.summary["needs"].get("rigid", {}).get("sleeve", {}).get("keeps"), soft


def check(name, tmp_path, only=None):
    """Each promise of a scene holds. Savings are a matter of docs/needs.md, not of a test on a busy machine."""
    found = list(promised.promises(name, tmp_path, 1, only))
    assert found
    for tolerance, part, of, row, change, _ in found:
        assert promised.holds(row, change, tolerance), (name, part, of, row, change)


@pytest.mark.parametrize("name,only", [("bracket", ["kinematics"]), ("stops", ["contact", "rigid"]), ("hertz2d", ["symmetry"]), ("shrinkfit3d", ["prism", "revolution"]), ("layer", ["cells", "order"]),
                                       ("beam", ["kinematics"]), ("wheel", ["prism"])])
def test_promises_quick(name, only, tmp_path):
    check(name, tmp_path, only)


@pytest.mark.slow
@pytest.mark.parametrize("name", promised.INPUTS + promised.MADE)
def test_promises(name, tmp_path):
    check(name, tmp_path)


@pytest.mark.slow
def test_simplify(tmp_path):
    """The plate becomes a quarter of elastic material: its scene runs and finds the same."""
    subprocess.run([ROOT / "scripts" / "simplify", ROOT / "tests" / "needs" / "plate.yml", "-o", tmp_path], check=True, capture_output=True)
    whole, scene = json.loads((tmp_path / "whole" / "summary.json").read_text()), promised.simpler.read(tmp_path / "simpler.yml")
    assert {"cut_x", "cut_y"} <= set(scene["boundary"]) and (tmp_path / "simplify.png").exists()
    simple = promised.simpler.run(scene, tmp_path, "again").summary
    assert 4 * simple["energy"] == pytest.approx(whole["energy"], rel=2 * 0.005)  # its tolerance, of the energy norm
