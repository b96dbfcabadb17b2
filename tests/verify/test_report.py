"""What a run leaves behind: keys of summary.json, tables that agree with it, fields that readers understand, on one rank and on two."""
import json
import math
import re
import subprocess

import numpy as np
import pytest

from boxmesh import linspace, ring, write
from contactkit import surface
from test_hostile import block, blocks

KEYS = """mortise scene status reason t model ranks load_steps step_cuts adapt_passes newton_iterations cells dofs order_min order_max
          estimated_error energy reaction contact probe time peak_memory_mb""".split()
TIMES = "total mesh assemble contact factor solve estimate output".split()
PAIR = "force moment max_pressure area radius active_nodes min_gap".split()


@pytest.mark.parametrize("ranks,order", [(1, 1), (2, 2)])
def test_patch_reports_agree(run, ranks, order):
    """Uniform state of inputs/patch2d.yml: pressure 0.068898 (its header), the same figure in every file."""
    result = run("inputs/patch2d.yml", "-order", order, "-probe_mid_x", 0.4, "-probe_mid_y", 0.5, ranks=ranks)
    assert result.returncode == 0
    s = result.summary
    assert all(key in s for key in KEYS) and all(key in s["time"] for key in TIMES)
    assert s["status"] == "converged" and s["ranks"] == ranks and s["order_max"] == order
    assert all((result.directory / name).read_text().endswith("\n") for name in ("summary.json", "history.csv", "adapt.csv", "fields.xdmf"))
    pair = s["contact"]["upper_on_lower"]
    assert all(key in pair for key in PAIR)
    pressure = 0.0688979013617
    assert pair["force"] == pytest.approx([0, pressure], abs=1e-9) and pair["mortar_force"] == pytest.approx([0, -pressure], abs=1e-9)
    assert len(pair["moment"]) == 1 and pair["area"] == pytest.approx(1, abs=1e-9)
    assert s["reaction"]["top"] == pytest.approx([0, -pressure], abs=1e-9)
    assert set(s["reaction"]) == {"top", "bottom", "left", "right"}  # not the contact surfaces, which hold nothing
    assert s["probe"]["mid"]["displacement"] == pytest.approx([0, -0.025], abs=1e-9)
    row = result.history[-1]
    assert row["contact.upper_on_lower.force.y"] == pytest.approx(pressure, abs=1e-9) and row["reaction.top.y"] == pytest.approx(-pressure, abs=1e-9)
    assert row["probe.mid.displacement.y"] == pytest.approx(-0.025, abs=1e-9) and row["newton_iterations"] == s["newton_iterations"]
    assert result.adapt[-1]["cells"] == s["cells"] and result.adapt[-1]["accepted"] == 1
    time, bulk = result.states()[-1]
    assert np.allclose(bulk["J"], 0.95, atol=1e-9) and len(bulk["cells"]) == s["cells"] * order**2
    time, contact = result.states("contact")[-1]
    assert np.allclose(contact["contact_pressure"], pressure, atol=1e-9) and np.allclose(contact["status"], 1)
    assert [len(surface(contact, side)["cells"]) for side in (0, 1)] == [5 * order, 3 * order]  # in pieces


@pytest.mark.parametrize("ranks", [1, 2])
def test_balances_of_an_adapted_run(run, ranks):
    """O-90 on Hertz' problem, hanging nodes and all: forces to 1e-10, moments to 1e-6, every pass on a mesh of its own."""
    result = run("inputs/hertz2d.yml", "-order", 2, "-contact_disc_on_block_order", 1, "-adapt_max_passes", 4, "-output_segments", "true", ranks=ranks)
    s = result.summary
    assert result.solved and s["balance"]["contact_force"] < 1e-10 and s["balance"]["contact_moment"] < 1e-6
    assert s["balance"]["supports"] < 1e-8
    pair = s["contact"]["disc_on_block"]
    states = result.states("contact")
    assert [len(result.states(grid, passes=True)) for grid in ("bulk", "contact", "segments")] == [len(result.adapt)] * 3 == [5] * 3
    contact, block = (surface(states[-1][1], side) for side in (0, 1))
    inside = np.abs((contact["X"] + contact["displacement"])[contact["status"] == 1, 0])
    assert len(inside) == pair["active_nodes"] and inside.max() <= pair["radius"] + 1e-12
    assert pair["radius"] == pytest.approx(0.2, abs=0.05) and pair["area"] == pytest.approx(2 * pair["radius"], rel=0.2)
    assert np.all(contact["gap"][contact["status"] == 0] > 0)
    assert np.allclose(np.linalg.norm(contact["normal"], axis=1), 1) and np.allclose(np.linalg.norm(block["normal"], axis=1), 1)
    # the block's side: touched where the disc touches, by pressures that are means of the disc's, open beside it, and nothing faces its far end
    x, y = np.abs((block["X"] + block["displacement"])[:, 0]), np.sort(np.abs((contact["X"] + contact["displacement"])[:, 0]))
    width = np.diff(y).max()
    assert np.all(x[block["status"] == 1] < pair["radius"] + width) and np.all(block["status"][x < pair["radius"] - width] == 1)
    assert 0.8 * pair["max_pressure"] < block["contact_pressure"].max() <= pair["max_pressure"] and block["contact_pressure"].min() >= 0
    assert np.all(block["gap"][(block["status"] == 0) & (x > pair["radius"] + width)] > 0) and np.all(block["status"][x > y[-1] + 0.5] == -1)
    assert np.all(block["normal"][:, 1] > 0.9) and np.all(contact["normal"][:, 1] < 0.1)


def test_failed_run_is_told(run):
    """Max_steps before the end: status failed with a reason, figures of the last accepted step, exit 2."""
    result = run("inputs/cook.yml", "-load_max_steps", 2)
    s = result.summary
    assert result.returncode == 2 and s["status"] == "failed" and s["reason"] and s["load_steps"] == 2 and 0 < s["t"] < 1
    assert s["energy"] > 0 and len(result.history) == 2
    assert s["probe"]["tip"]["displacement"][1] == pytest.approx(result.history[-1]["probe.tip.displacement.y"], rel=1e-9)


HERTZ = ("inputs/hertz2d.yml", "-adapt_tolerance", 0, "-order", 1, "-contact_disc_on_block_order", 1, "-output_fields", "false")


def test_where_the_error_is(run):
    """A run that gave up names the cell that has most of the estimate, here under the contact; one that ended by the number of its steps does not."""
    result = run(*HERTZ, "-load_step", 0.5, "-load_step_min", 0.2, "-boundary_top_displacement_y", "t < 0.6 ? -0.02*t : -2.6*t")
    assert result.returncode == 2 and result.summary["load_steps"] == 1, result
    x, y = map(float, re.search(r"note: half of the squared error estimate is in \d+ of \d+ cells, the worst at \((\S+), (\S+), 0\) of body (?:disc|block): ", result.stdout).groups())
    assert math.hypot(x, y) < 0.4, result
    assert "note:" not in run(*HERTZ, "-load_step", 0.5, "-load_max_steps", 1).stdout


def test_no_error_of_no_stress(run, tmp_path):
    """A block that is turned as a whole has round-off in place of stress: nothing to estimate an error of."""
    turn = {"y0": {"rotation": {"angle": "90*min(t, 1)"}}, "y1": {"pressure": "0.01*max(t - 1, 0)"}}
    result = run("s.yml", "-load_end", 2, text=block(tmp_path, boundary=turn, load={"step": 1}))
    assert [math.isnan(row["estimated_error"]) for row in result.history] == [True, False] and result.summary["estimated_error"] > 0, result
    result = run("s.yml", text=block(tmp_path, boundary=turn, load={"step": 1}))
    assert result.summary["estimated_error"] is None and "error not estimated" in result.stdout, result


@pytest.mark.parametrize("y,words", [(0.05, "at the end they are 0.051 apart"), (-0.05, None), ("t < 0.6 ? -0.05*t : 0.05", None), (3, "do not face each other")])
def test_pairs_in_vain(run, tmp_path, y, words):
    """Told of pairs that never touched: far from each other, or of other facets than was meant; not of those that parted."""
    text = blocks(tmp_path, pair={"nonmortar": "y0_u", "mortar": "y1_l", "search": 1})
    result = run("s.yml", "-boundary_y1_u_displacement_y", y, text=text)
    note = re.findall("note: the sides of pair pair have not touched; (.*)\n", result.stdout)
    assert result.returncode == 0 and len(note) == (words is not None) and (not note or words in note[0]), result


def test_probe_where_two_bodies_meet(run, tmp_path):
    """The lower block stands, the upper one rises: a note, and the body that the scene names."""
    text = blocks(tmp_path, pair={"nonmortar": "y0_u", "mortar": "y1_l"})
    write(tmp_path / "blocks.msh", [linspace(0, 1, 2)] * 2, [lambda x, y: (x, y), lambda x, y: (x, y + 1 + 2e-9)], side=lambda name, centre, b: f"{name}_{'lu'[b]}",
          body=lambda centre, b: "lu"[b])
    options = ("-boundary_y1_u_displacement_y", 0.1, "-probe_p_x", 0.3, "-probe_p_y", 1)
    result = run("s.yml", *options, text=text)
    assert "note: bodies l and u meet at probe p; it is a point of l unless probe.p.body says otherwise" in result.stdout and result.summary["probe"]["p"]["displacement"][1] == pytest.approx(0, abs=1e-9), result
    result = run("s.yml", *options, "-probe_p_body", "u", text=text)
    assert "meet at" not in result.stdout and result.summary["probe"]["p"]["displacement"][1] == pytest.approx(0.1), result
    assert "probe.p.body: the mesh has no body 'v'" in run("s.yml", *options, "-probe_p_body", "v", text=text).stderr


def test_check_says_where(run, tmp_path):
    """Groups of boundaries and pairs with their boxes."""
    said = run("s.yml", "-check", text=blocks(tmp_path, pair={"nonmortar": "y0_u", "mortar": "y1_l"})).stdout
    assert "  boundary y0_l: fix x fix y [x = 0 .. 1, y = 0]\n" in said, said
    assert "  contact pair: y0_u (nonmortar) [x = 0 .. 1, y = 1.001] on y1_l [x = 0 .. 1, y = 1]\n" in said, said


def test_probe_outside_is_wrong_input(run):
    result = run("inputs/cook.yml", "-probe_lost_x", 1000, "-probe_lost_y", 0)
    assert result.returncode == 1 and "probe.lost" in result.stderr and "outside" in result.stderr


def test_pipe_has_no_bar(run):
    result = run("inputs/cook.yml")
    assert result.returncode == 0 and "\r" not in result.stdout and "\033" not in result.stdout
    assert math.isfinite(result.summary["time"]["total"]) and "results in" in result.stdout and ("passes.xdmf" in result.stdout) == (result.directory / "passes.xdmf").exists()


# ---- warnings: on the screen and in summary.json ----------------------------------------------------------------------------------------


def warned(result, *words):
    """One warning with these words, in both places."""
    found = [text for text in result.summary["warnings"] if all(word in text for word in words)]
    assert result.returncode == 0 and len(found) == 1 and result.stdout.count(f"warning: {found[0]}\n") == 1, result
    return found[0]


def test_no_warning(run):
    result = run("inputs/patch2d.yml")
    assert result.summary["warnings"] == [] and "warning:" not in result.stdout and "note:" not in result.stdout, result


def open_ring(path, close, dim=2, **keys):
    """A ring with a gap of 0.16 whose one end is moved across it by `close`, to an end that is held."""
    write(path / "block.msh", [linspace(0.8, 1, 1), linspace(0.1, 2 * math.pi - 0.1, 16), linspace(0, 0.4, 2)][:dim], ring)
    return json.dumps({"mesh": {"file": "block.msh"}, "model": "plane_strain" if dim == 2 else "3d", "body": {"body": {"material": "m"}},
                       "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "load": {"step": 0.25},
                       "boundary": {"y0": {"fix": "xyz"[:dim]}, "y1": {"displacement": {axis: close * (axis == "y") for axis in "xyz"[:dim]}}}} | keys)


@pytest.mark.parametrize("dim,ranks", [(2, 1), pytest.param(2, 3, marks=pytest.mark.slow), (3, 1), (3, 2)])
def test_a_body_that_passes_through_itself(run, tmp_path, dim, ranks):
    """Told when the gap is closed, with the place, the same on any number of ranks; and the estimate of such a coarse mesh."""
    result = run("s.yml", text=open_ring(tmp_path, 0.3, dim), ranks=ranks)
    t, x, y = map(float, re.search(r"at t = (\S+), at \((\S+), (\S+),", warned(result, "surface of body body passes through itself")).groups())
    assert 0.16 <= 0.3 * t <= 0.3 and 0.75 < x < 1.05 and -0.1 < y < 0.2, result
    assert not [text for text in run("s.yml", text=open_ring(tmp_path, 0.12, dim), ranks=ranks).summary["warnings"] if "passes" in text], result


def squeezed(path, dim, amount):
    """A unit block, two cells high, whose surface goes by x = -amount X^2: det F = 1 - 2 amount X, which no integration point sees at X = 1."""
    write(path / "block.msh", [linspace(0, 1, 1), linspace(0, 1, 2), linspace(0, 1, 1)][:dim])
    move = {"displacement": {"x": f"-{amount}*t*X*X"} | {axis: 0 for axis in "yz"[:dim - 1]}}
    return json.dumps({"mesh": {"file": "block.msh"}, "model": "plane_strain" if dim == 2 else "3d", "order": 2, "body": {"body": {"material": "m"}},
                       "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "load": {"step": 1},
                       "boundary": {f"{axis}{end}": move for axis in "xyz"[:dim] for end in "01"}})


@pytest.mark.parametrize("dim,ranks", [(2, 1), (2, 2), (3, 1), (3, 2)])
def test_cells_folded_at_a_corner(run, tmp_path, dim, ranks):
    """A solution whose cells are turned inside out between integration points and corners is told with the place, the same on any number of ranks."""
    result = run("s.yml", text=squeezed(tmp_path, dim, 0.52), ranks=ranks)
    words = warned(result, "2 cells are turned inside out at a corner at t = 1, the worst at (1, ", "of body body, det F = -0.04 there")
    assert result.summary["min_det"] > 0 and words.endswith("doubt what depends on that place"), result
    assert run("s.yml", text=squeezed(tmp_path, dim, 0.48), ranks=ranks).summary["warnings"] == []


def test_passage_of_a_face_that_a_pair_does_not_name(run):
    """A coil whose end touches the next turn: the pair is there, the end is not in it, and the warning says so; with the end in it there is none."""
    end, without = (run("tests/gauntlet/coil.yml", "-order", 1, "-contact_c_surface", surface, "-output_fields", "false") for surface in ("hull", "flanks"))
    assert "contact pair c has one of the faces there and does not keep the other off" in warned(without, "surface of body strip passes through itself")
    assert not any("passes through" in warning for warning in end.summary["warnings"]), end


def test_hanging_facets_pass_through_nothing(run):
    """A round surface with linear faces of different sizes: corners that hang lie on what they hang on."""
    result = run("inputs/hertz3d.yml", "-adapt_max_passes", 3, "-output_fields", "false")
    assert result.adapt[-1]["cells"] > result.adapt[0]["cells"] and not result.summary["warnings"], result


def test_a_rough_estimate(run, tmp_path):
    assert float(re.search(r"up to (\S+) %", warned(run("s.yml", text=open_ring(tmp_path, 0.1)), "estimated error")).group(1)) > 50


def test_bodies_in_pieces(run, tmp_path):
    """Two squares of one body that only look joined; a third one of another body on them, in no pair."""
    text = blocks(tmp_path, pair={"nonmortar": "y0_u", "mortar": "y1_l"})
    maps = [lambda x, y: (x, y), lambda x, y: (x + 1 + 1e-8, y), lambda x, y: (x, y + 1 + 1e-8)]
    write(tmp_path / "blocks.msh", [linspace(0, 1, 2)] * 2, maps, side=lambda name, centre, b: f"{name}_{'llu'[b]}", body=lambda centre, b: "llu"[b])
    result = run("s.yml", text=text)
    warned(result, "body l is in 2 pieces", "at (1.25, 0.25, 0)")
    warned(result, "3 nodes coincide with others of their own body and are not merged, one of l at (1, ")
    assert "of another body" not in result.stdout, result
    result = run("s.yml", text=json.dumps({key: value for key, value in json.loads(text).items() if key != "contact"}))
    warned(result, "3 nodes coincide with those of another body, neither merged nor on the sides of a pair, one of l and u at (")


def test_chords_are_told(run):
    """An arc of a mesh of order 1, not of one of order 4, nor a flat side."""
    words = "side disc_surface of pair disc_on_block turns by up to 23 degrees"
    assert words in run("inputs/hertz2d.yml", "-mesh_order", 1, "-check").stdout
    assert "turns by" not in run("inputs/hertz2d.yml", "-check").stdout + run("inputs/patch2d.yml", "-check").stdout


BOX = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.CharacteristicLengthMin = 1;
Mesh.CharacteristicLengthMax = 1;
Physical Volume("body") = {1};
Physical Surface("y0") = {3};
Physical Surface("y1") = {4};
"""


def test_tetrahedra_become_hexahedra(run, tmp_path):
    """Of a .geo by gmsh, of a .msh here: how many cells come of it."""
    (tmp_path / "box.geo").write_text(BOX)
    subprocess.run(["gmsh", "-3", "-format", "msh22", "-o", "box.msh", "box.geo"], cwd=tmp_path, check=True, capture_output=True)
    for file in ("box.geo", "box.msh"):
        mesh = {"file": file} | ({"order": 1} if file.endswith("geo") else {})
        result = run("s.yml", text=block(tmp_path, mesh=mesh, model="3d", boundary={"y0": {"fix": "xyz"}, "y1": {"displacement": {"y": -0.01}}}))
        assert f"{result.summary['cells']} cells come of it" in warned(result, "tetrahedra"), result


def test_an_unstable_equilibrium(run, tmp_path):
    """A slender strut beyond Euler's load, straight by symmetry of its mesh."""
    text = block(tmp_path, order=2, boundary={"y0": {"fix": "xy"}, "y1": {"displacement": {"x": 0, "y": "-0.1*t"}}}, load={"step": 0.25, "stable": False})
    write(tmp_path / "block.msh", [linspace(0, 0.1, 2), linspace(0, 1, 10)])
    t = float(re.search(r"the first at t = (\S+):", warned(run("s.yml", text=text), "unstable")).group(1))
    assert 0.25 <= t <= 0.75
