"""Section needs of summary.json: what could have been left out. Each promise is checked by running the simpler model."""
import re

import pytest

from conftest import ROOT

QUIET = ("-output_fields", "false")
ELASTIC = {"contact": {}, "body": {}}


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
    assert with_pair.summary["needs"] == {"contact": {"disc_on_block": {"change": 0, "why": "its sides have not touched"}}, "body": {}}, with_pair
    same(with_pair, without)


@pytest.mark.parametrize("adapt", [(), ("-adapt_tolerance", 0.02)], ids=["as_it_is", "adapted"])
def test_material_that_never_flows(run, adapt):
    text = scene("necking")
    law = re.search(r"steel:.*\n?.*law: j2.*?\}", text, re.S)[0]
    elastic = re.sub(r",\s*(yield|hardening|saturation|saturation_rate): [\d.e+-]+", "", law.replace("law: j2", "law: neo_hookean"))
    end = ("-load_end", 1e-4, "-load_step", 1e-4)
    plastic, simple = run("plastic.yml", *QUIET, *end, *adapt, text=text), run("elastic.yml", *QUIET, *end, *adapt, text=text.replace(law, elastic))
    assert list(plastic.summary["needs"]["body"]) == ["bar"] and plastic.summary["needs"]["body"]["bar"]["change"] == 0, plastic
    assert "note: body bar has not flowed" in plastic.stdout
    same(plastic, simple)


def test_nothing_is_promised(run):
    """Of a pair that bears, a bar that flows, a run that was given up."""
    assert run("inputs/patch2d.yml", *QUIET).summary["needs"] == ELASTIC
    flowed = run("inputs/necking.yml", *QUIET, "-load_end", 0.05)
    assert flowed.returncode == 0 and flowed.summary["plastic_strain"] > 0 and flowed.summary["needs"] == ELASTIC
    assert run("inputs/hertz2d.yml", *QUIET, "-boundary_top_displacement_y", 0.05, "-load_step", 0.5, "-load_max_steps", 1).summary["needs"] == ELASTIC
