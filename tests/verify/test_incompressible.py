"""Incompressible material (kappa: inf, nu: 0.5): the pressures are unknowns of the whole problem. The limit of finite bulk moduli, at their rate; exact solutions;
contact; ranks; the tangent; what cannot be asked for; and the count of unstable equilibria."""
import json
import math
import pathlib

import pytest

import test_bulk_rubber as rubber
from boxmesh import linspace, write

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
INF = "inf"
QUIET = ("-output_fields", "false")


def done(result):
    assert result.solved, result
    return result.summary


def leaves(value, skip=("time", "needs", "ranks", "peak_memory_mb", "peak_memory_rank_mb")):
    if isinstance(value, dict):
        return [x for key, v in value.items() if key not in skip for x in leaves(v)]
    return [x for v in value for x in leaves(v)] if isinstance(value, list) else [value]


# ---- the limit ------------------------------------------------------------------------------------------------------------------------

def test_cook_is_the_limit(run):
    """O-10: tip and energy come closer to those of kappa: inf as 1/kappa, with no fewer iterations."""
    def solve(kappa):
        s = done(run("inputs/cook.yml", "-material_rubber_kappa", kappa, *QUIET))
        return s["probe"]["tip"]["displacement"][1], s["energy"], s["newton_iterations"]

    limit = solve(".inf")
    error = {}
    for ratio in (1e3, 1e4, 1e5, 1e6):
        found = solve(80.1938 * ratio)
        error[ratio] = [abs(a / b - 1) for a, b in zip(found[:2], limit[:2])]
        assert limit[2] <= found[2]
    print(limit, error)
    for ratio in (1e3, 1e4, 1e5):
        for k in range(2):
            assert math.log10(error[ratio][k] / error[10 * ratio][k]) == pytest.approx(1, abs=0.03)
    assert limit[0] == pytest.approx(6.90143, rel=5e-4)  # quadratic cells, n = 8


@pytest.mark.parametrize("ri, p, ro, N", [rubber.RING[1], rubber.RING[3]])
def test_cylinder(run, tmp_path, ri, p, ro, N):
    """O-11 in space by prescribed radius: the volume of every cell, hence the outer radius, is exact; so is, on this mesh to 1e-3, the pressure."""
    scene = rubber.tube(tmp_path, 3)
    scene["material"]["m"]["kappa"] = INF
    scene["boundary"].update({"x0": {"displacement": {"x": f"{ri - 1}*X", "y": f"{ri - 1}*Y"}}, "z0": {"fix": "z"}, "z1": {"fix": "z"}})
    s = rubber.converged(run, scene)
    rubber.relative(2 + s["probe"]["outside"]["displacement"][0], ro, 2e-5)
    rubber.relative(s["reaction"]["x0"][0], p * ri, 1e-3)
    rubber.relative(4 * s["reaction"]["z1"][2] - math.pi * ri ** 2 * p, N, 1e-3)


def test_cylinder_limit(run, tmp_path):
    """The same under pressure, which follows the bore (unsymmetric tangent): bore radii of kappa = 1e4 .. 1e6 against that of kappa: inf, rate 1/kappa."""
    ri, p, ro = rubber.RING[1][:3]
    scene = rubber.tube(tmp_path)
    scene["boundary"]["x0"] = {"pressure": p}

    def bore(kappa):
        scene["material"]["m"]["kappa"] = kappa
        return rubber.converged(run, scene)["probe"]["bore"]["displacement"][0]

    limit = bore(INF)
    error = [bore(kappa) / limit - 1 for kappa in (1e4, 1e5, 1e6)]
    print(limit, error)
    rubber.relative(1 + limit, ri, 2e-5)
    assert [error[k] / error[k + 1] for k in range(2)] == pytest.approx([10, 10], rel=0.02)


@pytest.mark.parametrize("dim, radial, around", [pytest.param(2, 8, 4, id="axisymmetric"), pytest.param(3, 4, 2, id="octant", marks=pytest.mark.slow)])
def test_sphere_below_its_limit_point(run, tmp_path, dim, radial, around):
    """O-12: up the stable branch to 1.5 times the radius."""
    a, p = rubber.BALL[2]
    scene = rubber.ball(tmp_path, dim, radial, around)
    scene["material"]["m"]["kappa"] = INF
    scene["boundary"]["inner"] = {"pressure": p}
    scene["load"] = {"step": 0.25}
    s = rubber.converged(run, scene)
    rubber.relative(1 + s["probe"]["bore"]["displacement"][0], a, 2e-3)
    rubber.relative(2 + s["probe"]["outside"]["displacement"][0], (7 + a ** 3) ** (1 / 3), 2e-3)


@pytest.mark.parametrize("law", [{"law": "mooney_rivlin", "c1": 0.3, "c2": 0.2}, {"law": "neo_hookean", "mu": 1, "volumetric": "simo"},
                                 {"law": "ogden", "mu1": 1.5, "alpha1": 1.3, "mu2": 0.003, "alpha2": 5, "mu3": -0.024, "alpha3": -2},
                                 {"law": "yeoh", "c1": 0.5, "c2": -0.01, "c3": 0.002}, {"law": "arruda_boyce", "mu": 1, "locking_stretch": 2},
                                 {"law": "hgo", "c": 1, "k1": 0.5, "k2": 0.8, "fiber": {"a": {"angle": 30}, "b": {"angle": -30}}},
                                 pytest.param({"law": "j2", "mu": 1, "yield": 0.4, "hardening": 0.2}, id="j2")],
                         ids=lambda law: law["law"])
def test_laws(run, tmp_path, law):
    """Every law with an isochoric part has the limit: reactions of a blown-up tube at kappa = 1e6 mu agree to 1e-4."""
    scene = rubber.tube(tmp_path, radial=3, around=2)
    scene["boundary"]["x0"] = {"displacement": {"x": "0.2*X", "y": "0.2*Y"}}
    found = []
    for kappa in (INF, 1e6):
        scene["material"]["m"] = {**law, "kappa": kappa}
        found.append(rubber.converged(run, scene))
    for key in ("x0", "y0"):
        assert found[0]["reaction"][key] == pytest.approx(found[1]["reaction"][key], rel=1e-4, abs=1e-6)
    assert found[0]["newton_iterations"] <= found[1]["newton_iterations"] + 1


def test_small_strains(run, tmp_path):
    """Linear elasticity has one linear system to solve; it is that of nu -> 0.5."""
    write(tmp_path / "box.msh", [linspace(0, 1, 4)] * 2)
    scene = {"mesh": {"file": "box.msh"}, "model": "plane_strain", "kinematics": "small", "order": 2, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "linear", "E": 3, "nu": 0.5}}, "boundary": {"y0": {"fix": "xy"}, "x0": {"traction": {"x": 1}}},
             "load": {"step": 1}, "output": {"fields": False}, "probe": {"corner": {"x": 1, "y": 1}}}
    limit = rubber.converged(run, scene)
    finite = rubber.converged(run, scene, "-material_m_nu", 0.49999999)
    assert limit["newton_iterations"] == 1
    assert limit["probe"]["corner"]["displacement"] == pytest.approx(finite["probe"]["corner"]["displacement"], rel=1e-5)
    assert limit["estimated_error"] == pytest.approx(finite["estimated_error"], rel=1e-5)


# ---- contact, adaptation, ranks --------------------------------------------------------------------------------------------------------

RUBBER = ("inputs/rubber2d.yml", *QUIET)


def test_contact(run):
    """rubber2d, adapted: the same meshes, force and pressure as with kappa = 1e6 mu to 1e-5, in no more iterations."""
    limit = done(run(*RUBBER, "-material_rubber_nu", 0.5))
    finite = done(run(*RUBBER, "-material_rubber_nu", 0.4999995))
    assert [limit[key] for key in ("cells", "adapt_passes", "step_cuts")] == [finite[key] for key in ("cells", "adapt_passes", "step_cuts")]
    assert limit["newton_iterations"] <= finite["newton_iterations"]
    for a, b in ((limit["reaction"]["top"][1], finite["reaction"]["top"][1]), (limit["energy"], finite["energy"]),
                 (limit["contact"]["disc_on_block"]["max_pressure"], finite["contact"]["disc_on_block"]["max_pressure"]),
                 (limit["estimated_error"], finite["estimated_error"])):
        assert a == pytest.approx(b, rel=1e-5)
    assert limit["balance"]["supports"] < 1e-10 and limit["unstable_equilibria"] == 0


@pytest.mark.parametrize("stiff", ["disc", pytest.param("block", marks=pytest.mark.slow)])
def test_one_body_of_two(run, stiff):
    """Incompressible beside condensed material, on either side: between the two that are alike."""
    options = ("-adapt_tolerance", 0, "-mesh_refine", 1)
    both = [done(run(*RUBBER, *options, "-material_rubber_nu", nu))["reaction"]["top"][1] for nu in (0.499, 0.5)]
    text = (ROOT / "inputs/rubber2d.yml").read_text().replace("file: hertz2d.geo", f"file: {ROOT}/inputs/hertz2d.geo")
    text = text.replace("rubber: {law", "hard: {law: neo_hookean, E: 1, nu: 0.5}\n  rubber: {law")
    result = run("two.yml", *QUIET, *options, f"-body_{stiff}_material", "hard", text=text)
    force = done(result)["reaction"]["top"][1]
    print(both, force)
    assert min(both) < force < max(both)


@pytest.mark.parametrize("scene", [("rubber2d", "-material_rubber_nu", 0.5, "-adapt_max_passes", 1),
                                   pytest.param(("sphere", "-material_soft_kappa", INF, "-adapt_max_passes", 1), marks=pytest.mark.slow),
                                   pytest.param(("tube", "-material_rubber_kappa", INF), marks=pytest.mark.slow)], ids=lambda s: s[0])
def test_ranks_agree(run, scene):
    one, *others = [done(run(f"inputs/{scene[0]}.yml", *scene[1:], *QUIET, ranks=ranks)) for ranks in (1, 2, 3)]
    size = max(abs(x) for x in leaves(one["reaction"]))
    for many in others:
        assert many["newton_iterations"] == one["newton_iterations"] and many["unstable_equilibria"] == one["unstable_equilibria"]
        assert leaves(many) == pytest.approx(leaves(one), rel=1e-8, abs=1e-8 * size, nan_ok=True)


def test_tangent(run):
    """PETSc's finite-difference test in contact, on an adapted mesh, and quadratic convergence down to round-off (a tolerance that asks for it: at the default
    one, how small the last residual is depends on where the last step but one lands)."""
    result = run(*RUBBER, "-material_rubber_nu", 0.5, "-order", 2, "-adapt_tolerance", 0, "-refine_spot_x", 0.1, "-refine_spot_y", 0, "-refine_spot_levels", 1,
                 "-snes_test_jacobian", "-snes_monitor", "-solve_rtol", 1e-13)
    done(result)
    error = [float(line.split("=")[1].split(",")[0]) for line in result.stdout.splitlines() if line.strip().startswith("||J - Jfd||_F/||J||_F =")]
    norm = [float(line.split()[-1]) for line in result.stdout.splitlines() if "SNES Function norm" in line]
    print(error, norm)
    assert len(error) > 3 and max(error[-2:]) < 1e-6
    assert norm[-1] < 1e-12 * max(norm) and all(after < 20 * before**2 + 1e-14 for before, after in zip(norm[-4:], norm[-3:]))


@pytest.mark.slow
def test_space(run):
    """In space, factors of either precision."""
    command = ("inputs/sphere3d.yml", *QUIET, "-adapt_max_passes", 1)
    limit, single = (done(run(*command, "-material_soft_kappa", INF, "-solve_factor", word)) for word in ("double", "single"))
    finite = done(run(*command, "-material_soft_kappa", 1e6))
    assert single["single_factor_failures"] == 0
    assert single["energy"] == pytest.approx(limit["energy"], rel=1e-10)
    assert finite["energy"] == pytest.approx(limit["energy"], rel=1e-5)
    assert limit["newton_iterations"] <= finite["newton_iterations"]


# ---- volume that cannot be kept, pressures that nothing determines, unstable equilibria -------------------------------------------------

def box(tmp_path, order, top):
    write(tmp_path / "box.msh", [linspace(0, 1, 6)] * 2)
    held = {name: {"displacement": {"x": "0.2*Y", "y": f"{top}*Y"}} for name in ("x0", "x1", "y0", "y1")}
    return {"mesh": {"file": "box.msh"}, "model": "plane_strain", "order": order, "body": {"body": {"material": "m", "force": {"y": "-sin(7*X)"}}},
            "material": {"m": {"law": "neo_hookean", "mu": 1, "kappa": INF}}, "boundary": held,
            "load": {"step": 1, "step_min": 0.5}, "output": {"fields": False}, "probe": {"inside": {"x": 0.51, "y": 0.52}}}


@pytest.mark.parametrize("order", [1, 2])
def test_held_all_around(run, tmp_path, order):
    """A constant pressure (order 1: a checkerboard, too) does no work: displacements are found all the same."""
    limit = rubber.converged(run, box(tmp_path, order, 0))
    finite = rubber.converged(run, box(tmp_path, order, 0), "-material_m_kappa", 1e6)
    assert limit["newton_iterations"] <= 5
    assert limit["probe"]["inside"]["displacement"] == pytest.approx(finite["probe"]["inside"]["displacement"], rel=1e-5)
    # The linear solve's own round-off is the only pressure there is beside the equilibrium: reactions stay finite.
    assert max(abs(x) for x in leaves(limit["reaction"])) < 1


def test_pressed_all_around(run, tmp_path):
    """A box that is made smaller: no state keeps the volume. The run must say so and not take huge pressures for equilibrium."""
    result = run("scene.yml", text=json.dumps(box(tmp_path, 2, -0.05)))
    assert result.returncode == 2, result
    assert "incompressible material cannot keep its volume" in result.summary["reason"]


@pytest.mark.parametrize("kappa, order, condense, ranks", [(INF, 2, "auto", 1), (INF, 3, "auto", 2), (1000, 2, "no", 1), (1000, 3, "yes", 1)])
def test_buckling_is_counted(run, tmp_path, kappa, order, condense, ranks):
    """A strip ten times as long as high between clamped ends stays straight beyond the load of Euler, at a strain of pi^2/3 (h/L)^2 = 3.3 % or, for its shear, a little
    less, because nothing disturbs it. Steps of 1 %. A tangent without symmetric form tells it by its determinant."""
    write(tmp_path / "strip.msh", [linspace(0, 10, 10), linspace(0, 1, 2)])
    scene = {"mesh": {"file": "strip.msh"}, "model": "plane_strain", "order": order, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "neo_hookean", "mu": 1, "kappa": kappa}},
             "boundary": {"x0": {"fix": "xy"}, "x1": {"displacement": {"x": -0.6, "y": 0}}}, "load": {"step": 1 / 6, "step_max": 1 / 6, "stable": False},
             "output": {"fields": False}}
    s = rubber.converged(run, scene, "-solve_condense", condense, ranks=ranks)
    assert s["load_steps"] == 6 and s["unstable_equilibria"] == 3
    if order == 2:
        assert rubber.converged(run, scene, "-solve_symmetric", 0)["unstable_equilibria"] == 3


# ---- what is refused ----------------------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("options, sentence", [
    (("-material_rubber_formulation", "displacement"), "material.rubber.formulation: displacements alone cannot keep the volume"),
    (("-material_rubber_volumetric", "log"), "material.rubber.volumetric: log has no incompressible limit"),
    (("-solve_condense", "yes"), "-solve_condense yes: not with incompressible material"),
    (("-solve_linear", "iterative"), "-solve_linear iterative: not with incompressible material"),
    (("-material_rubber_mu", "inf"), "material.rubber.mu: inf is not a finite number above 0"),
    (("-material_rubber_kappa", "-inf"), "must be a number"),
    (("-material_rubber_kappa", "1e15"), "take inf (incompressible)"),
])
def test_refused(run, options, sentence):
    result = run("inputs/cook.yml", "-material_rubber_kappa", INF, *options)
    assert result.returncode == 1 and sentence in result.stderr and len(result.stderr.strip().splitlines()) == 1, result
