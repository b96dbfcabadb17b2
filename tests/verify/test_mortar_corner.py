"""A sharp corner of a rigid body, which is the mortar side, slides along an oblique face without friction: the force is normal to that face."""
import json
import pathlib

import pytest

SCENES = pathlib.Path(__file__).resolve().parent / "scenes"


def force(run, radius, *options):
    """On the hook, where the rib has pushed it up a slope of 34 degrees."""
    content = {"mesh": {"file": str(SCENES / "snap_slope.geo"), "parameter": {"r": radius}}, "model": "plane_strain", "order": 2,
               "body": {"beam": {"material": "plastic"}, "rib": {"material": "tool", "motion": {"x": "-0.9*t"}}},
               "material": {"plastic": {"law": "neo_hookean", "E": 1000, "nu": 0.3}, "tool": {"law": "rigid"}}, "boundary": {"root": {"fix": "xy"}},
               "contact": {"c": {"nonmortar": "hook", "mortar": "rib_face"}}, "load": {"step": 0.025, "end": 0.3}}
    result = run("s.yml", "-output_fields", "false", *options, text=json.dumps(content))
    assert result.returncode == 0, result
    print(result.summary["contact"]["c"]["force"], result.summary["estimated_error"])
    return result.summary["contact"]["c"]["force"]


def test_round(run):
    x, y = force(run, 0.03)
    assert x / y == pytest.approx(-0.68, rel=0.03) and y == pytest.approx(0.0034, rel=0.05)


@pytest.mark.xfail(strict=True, raises=AssertionError, reason="gaps are weighted with functions that are fixed to the facet, along which the corner rides over bumps")
def test_sharp(run):
    x, y = force(run, 0)
    assert x / y == pytest.approx(-0.68, rel=0.1)
