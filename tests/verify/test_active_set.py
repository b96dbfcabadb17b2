"""Active sets of a linear step that go in circles as long as all nodes that disagree switch at once (src/solve/activeset.c)."""
import pytest

QUIET = ("-output_fields", "false")
SCENE = ("tests/gauntlet/layer_axi.yml", "-order", 3, *QUIET)  # 31 nodes of a stiff rounded punch on 9 facets of a layer 1e5 times softer
LAYER = (*SCENE, "-contact_c_stabilise", "false")  # over-constrained


def counts(result):
    s = result.summary
    print(result.returncode, "t", s["t"], "iterations", s["newton_iterations"], "factorisations", s["factorisations"], "single switches", s["single_switches"], "cycles", s["active_set_cycles"])
    return s


def test_one_node_at_a_time(run):
    """Found without a cut, and in half of the iterations that it takes otherwise, if at all."""
    result = run(*LAYER)
    s = counts(result)
    assert result.returncode == 0 and s["step_cuts"] == 0 and s["single_switches"] > 0 and s["newton_iterations"] <= 60, result
    half = ("-load_step", 0.5, "-load_end", 0.5, "-load_step_min", 0.3)  # one step of those in which all of them go in circles, which take long
    s, naive = counts(run(*LAYER, *half)), counts(without := run(*LAYER, *half, "-solve_single_switches", "no"))
    assert s["single_switches"] > 0 == naive["single_switches"], without
    assert without.returncode == 2 or naive["newton_iterations"] > 2 * s["newton_iterations"], without


def test_stabilised(run):
    """Where the multipliers are stabilised hardly any set goes in circles, and told errors are a third."""
    s, naive = counts(run(*SCENE)), counts(run(*LAYER))
    assert s["contact"]["c"]["stabilised_facets"] > 0 and s["factorisations"] < 0.5 * naive["factorisations"]
    assert s["estimated_error"] < 0.4 * naive["estimated_error"]


def test_ranks(run):
    """The order of nodes, one of which switches, is that of the mesh, whoever has them."""
    one, *more = (counts(run(*LAYER, "-load_end", 0.25, ranks=ranks)) for ranks in (1, 2, 3))
    for other in more:
        assert other["energy"] == pytest.approx(one["energy"], rel=1e-8) and other["single_switches"] == one["single_switches"] > 0


def test_not_convex(run):
    """A blade of rubber that begins in a window: sets need not agree with a tangent that is not convex, which is made again at fixed directions."""
    result, without = (run("tests/gauntlet/wiper.yml", *QUIET, "-newton_frozen_normals", mode) for mode in ("auto", "off"))
    s, naive = counts(result), counts(without)
    assert result.returncode == 0 and s["modifiers"]["frozen_normals"] > 0 and s["newton_iterations"] <= 15, result
    assert without.returncode == 2 or naive["newton_iterations"] > 2 * s["newton_iterations"], without


def test_friction_alone(run):
    """A whole ring between plates leaves them in the middle, and what sticks does so with just the friction that it can bear: where all nodes slip in a linear step
    nothing holds the ring, and no set agrees until it has all of the proximal shift again. By symmetry no force goes across."""
    result = run("tests/verify/scenes/ring_plates.yml", "-order", 1, *QUIET)
    s = counts(result)
    above, below = (s["contact"][pair]["force"] for pair in ("above", "below"))
    assert result.returncode == 0 and s["step_cuts"] == 0 and s["newton_iterations"] <= 25 and s["factorisations"] <= 80, result
    assert above[0] == pytest.approx(0, abs=1e-6) and above[1] == pytest.approx(-below[1], rel=1e-9)
