"""The quick part of the gauntlet (tests/gauntlet, docs/gauntlet.md): variants that scenes.json lists as quick, each judged by its figures; and what judges them."""
import os
import pathlib

import pytest

from conftest import module

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "gauntlet"
PROGRAM = os.environ.get("MORTISE", str(FOLDER.parent.parent / "bin" / "mortise"))
gauntlet, closed_forms = module("gauntlet_run", FOLDER / "run.py"), module("gauntlet_closed_forms", FOLDER / "closed_forms.py")
ALL = list(gauntlet.rows(FOLDER))
QUICK = list(gauntlet.rows(FOLDER, quick=True))


@pytest.mark.parametrize("scene, variant, options", QUICK, ids=[f"{scene['name']}-{variant or 'plain'}" for scene, variant, _ in QUICK])
def test_quick(scene, variant, options):
    row = gauntlet.solve(PROGRAM, FOLDER, scene, variant, options)
    print(gauntlet.line(row))
    assert row["verdict"] == "ok", row


def test_scenes():
    """Names are unique, every class is there, quick variants exist, no contact setting in any scene or variant: what is to be computed is none."""
    scenes = {scene["name"]: scene for scene, _, _ in ALL}
    runs = [(scene["name"], variant) for scene, variant, _ in ALL]
    assert len(scenes) >= 40 and len(set(runs)) == len(runs)
    assert {scene["class"] for scene in scenes.values()} == {"edges", "corners", "overlap", "half models", "soft and stiff", "rigid nonmortar", "1:8", "snaps", "press fits", "billets", "forming",
                                                            "bonded edges", "buckling", "folding", "conforming", "friction", "seals", "tied", "rigid under loads", "held by contact alone"}
    for scene, _, options in ALL:
        assert {figure[0] for figure in scene["figures"]} >= set(scene.get("friction", [])), scene["name"]
        assert scene["figures"] and scene["source"] and set(scene.get("quick", [])) <= set(scene["variants"]), scene["name"]
        settings = [word for word in options if word.startswith("-contact_") and not word.endswith(("_nonmortar", "_mortar", "_friction"))]
        assert not settings, (scene["name"], settings)
    for file in FOLDER.glob("*.yml"):
        contact = [line.replace("initial_gap: ramp", "") for line in file.read_text().splitlines() if line.startswith("contact:")]  # a way there, as load steps
        assert all(word not in line for line in contact for word in ("order", "subdivide", "search", "multiplier", "initial_gap")), file


def test_closed_forms():
    """What scenes.json says comes from closed_forms.py does."""
    scenes = {scene["name"]: scene for scene, _, _ in ALL}
    same = {"rigid_floor": "cylinder", "layers_reversed": "layers_soft_below", "bricks": "tied_wall"}
    found = [name for name, scene in scenes.items() if scene["source"].startswith("closed_forms.py")]
    assert len(found) >= 12
    for name in found:
        assert scenes[name]["figures"][0][2] == pytest.approx(closed_forms.FIGURES[same.get(name, name)], rel=1e-9), name


def test_verdicts():
    """Each verdict from what a run leaves: exit status, screen, summary."""
    scene = {"figures": [["force", "s['f']", 2.0, 0.01]], "tolerance": 0.05}
    good, off, rough = {"f": 2.01, "estimated_error": 0.04}, {"f": 2.1, "estimated_error": 0.04}, {"f": 2.0, "estimated_error": 0.06}

    def judge(code, summary, said="", options=(), **keys):
        return gauntlet.judge({**scene, **keys}, list(options), code, said, summary, [])[0]

    assert judge(0, good) == "ok" and judge(0, off) == "WRONG" and judge(0, {}) == "WRONG" and judge(0, {**good, "f": float("nan")}) == "WRONG"
    assert judge(0, rough) == "short" and judge(0, rough, options=["-adapt_tolerance", "0.1"]) == "ok"
    assert judge(2, {"status": "inaccurate"}) == "inaccurate" and judge(2, {"status": "failed"}) == "failed" and judge(None, good) == "slow"
    assert judge(1, {}, "overlap: too deep\n") == "failed" and judge(1, {}, "overlap: too deep\n", told=True) == "ok" and judge(1, {}, "one\ntwo\n", told=True) == "failed"
