"""Shrink fit of two tubes (O-45): interference on facets that do not match, initial gaps closed; and the keys it takes."""
import math
import pathlib

import numpy
import pytest

from contactkit import contact, is_quadratic, steps

PRESSURE, RADIUS = 65.93406593, 10  # plane strain
QUIET = ("-output_fields", "false")


def fit(run, n, *options):
    result = run("inputs/shrinkfit.yml", "-mesh_parameter_n", n, *options)
    assert result.returncode == 0, result
    z = contact(result)["contact_pressure"] / PRESSURE
    pair = result.summary["contact"]["fit"]
    mean = math.hypot(*pair["force"]) / (math.sqrt(2) * RADIUS) / PRESSURE  # a quarter of a ring under pressure p is pulled by p R both ways
    return result, mean, (z.max() - z.min()) / 2


def test_o45_shrink_fit(run):
    """Divisions 24 and 36 around: mean pressure 0.3 % and falling as h^2, ripple below 0.2 % (wanted: 1 %) and falling faster than h."""
    coarse, mean, ripple = fit(run, 6)
    assert abs(mean - 1) < 3e-3 and ripple < 2e-3
    assert 0 < coarse.summary["contact"]["fit"]["adjusted_gap"] < 0.005  # the facets lie on the circle in the mean; with vertices on it 0.037
    fine, fine_mean, fine_ripple = fit(run, 12, "-mesh_parameter_m", 8)  # on faces of order 2 the walls' four cells would be all of the error that is left
    assert fine_ripple < 0.5 * ripple and abs(fine_mean - 1) < 0.35 * abs(mean - 1)
    u = {name: fine.summary["probe"][name]["displacement"][0] for name in ("inner", "outer")}
    assert abs(u["inner"] / -0.0037142857 - 1) < 5e-3 and abs(u["outer"] / 0.0062857143 - 1) < 5e-3


LINEAR_FACES = pytest.mark.xfail(strict=True, reason="on linear faces that do not match the ripple falls as h with either basis of the multipliers")


@pytest.mark.parametrize("options", [(), pytest.param(("-contact_fit_order", 1), marks=LINEAR_FACES)], ids=["as_it_is", "linear_faces"])
def test_o45_ripple_second_order(run, options):
    """With h^2, as O-45 asks for."""
    ripples = [fit(run, n, "-mesh_parameter_m", n, *options)[2] for n in (12, 24)]
    assert ripples[1] < 0.35 * ripples[0]


@pytest.mark.parametrize("order", [1, 2])
def test_o45_roles(run, order):
    """The outer tube nonmortar: the same limit, second order in the mean."""
    swap = ("-contact_fit_nonmortar", "outer_bore", "-contact_fit_mortar", "inner_shell", "-contact_fit_roles", "given", "-order", order)
    means = [fit(run, n, *swap, "-mesh_parameter_m", n)[1] - 1 for n in (6, 12)]
    assert abs(means[1]) < 3e-3 and abs(means[1]) < 0.35 * abs(means[0])


def test_o45_gaps_kept_matter(run):
    """Without initial_gap: adjust the facets' gap eats the interference: no contact at all on this mesh of order 1. Adjusting is off by default."""
    result, mean, _ = fit(run, 6, "-contact_fit_initial_gap", "keep", "-order", 1)
    assert mean < 0.01 and result.summary["contact"]["fit"]["adjusted_gap"] == 0


@pytest.mark.parametrize("order", [1, 2, 3])
def test_estimate_with_gaps_adjusted(run, order):
    """What facets of other divisions leave of gaps is no error, for it counts as closed, point by point: the estimate is the error in the energy norm within a factor of 3."""
    fine = run("inputs/shrinkfit.yml", "-order", 4, "-mesh_refine", 1, "-adapt_tolerance", 0, *QUIET).summary["energy"]
    summary = run("inputs/shrinkfit.yml", "-order", order, "-adapt_tolerance", 0, *QUIET).summary
    error = math.sqrt((summary["energy"] - fine) / fine)
    print(summary["estimated_error"], error)
    assert 1 / 3 < summary["estimated_error"] / error < 3


def test_fine_side_on_a_coarse_curved_one(run):
    """The nonmortar side 4 times as fine as the curved mortar side: with gaps adjusted the pressure is that of polynomial faces (straight pieces of them would leave percents at any order);
    gaps kept are misfits of the two images of the circle, h^3 at order 2, and pressures of at least h^2."""
    def error(n, order, gap):
        result, mean, _ = fit(run, n, "-mesh_parameter_ratio", 4, "-mesh_parameter_m", 4, "-order", order, "-mesh_order", order, "-contact_fit_order", "full", "-contact_fit_nonmortar", "outer_bore",
                              "-contact_fit_mortar", "inner_shell", "-contact_fit_initial_gap", gap)
        z = contact(result)["contact_pressure"] / PRESSURE - 1
        print(n, order, gap, "root mean square", math.sqrt((z * z).mean()), "mean", mean - 1)
        return math.sqrt((z * z).mean())

    assert error(6, 2, "adjust") < 2e-3 and error(6, 3, "adjust") < 1e-4
    assert error(12, 2, "keep") < 0.25 * error(6, 2, "keep")


def test_finite_strain_and_ranks(run):
    """Small overlap: the finite theory agrees; three processes find the same."""
    finite = ("-kinematics", "finite", "-material_steel_law", "neo_hookean")
    one, mean, _ = fit(run, 6, *finite)
    assert abs(mean - 1) < 5e-3
    three = run("inputs/shrinkfit.yml", "-mesh_parameter_n", 6, *finite, *QUIET, ranks=3)
    assert three.returncode == 0, three
    assert numpy.allclose(three.summary["contact"]["fit"]["force"], one.summary["contact"]["fit"]["force"], rtol=1e-8)


def test_refine_keys(run):
    """refine.<name>: along a boundary, near a point, both; wrong ones are one sentence."""
    def cells(*options):
        result = run("inputs/patch2d.yml", *QUIET, "-mesh_parameter_n", 4, *options)
        assert result.returncode == 0, result
        assert abs(result.summary["contact"]["upper_on_lower"]["force"][1] / 0.0688979 - 1) < 1e-5
        return result.summary["cells"]

    base = 4 * 4 + 6 * 6
    assert cells() == base
    assert cells("-refine_band_boundary", "lower_top") == base + 3 * 4
    assert cells("-refine_band_boundary", "lower_top", "-refine_band_levels", 2) == base + 3 * 4 + 3 * 8
    assert cells("-refine_spot_boundary", "upper_bottom", "-refine_spot_x", 0.1, "-refine_spot_y", 1) == base + 3
    assert cells("-refine_spot_x", 0.1, "-refine_spot_y", 1) == base + 6
    assert cells("-refine_spot_x", 0.5, "-refine_spot_y", 0.5, "-refine_spot_radius", 5) == 4 * base
    for options, words in ((("-refine_spot_levels", 2), "needs a boundary, a point"), (("-refine_spot_boundary", "nowhere"), "no boundary group 'nowhere'"),
                           (("-refine_spot_boundary", "top", "-refine_spot_radius", 1), "a radius needs a point")):
        result = run("inputs/patch2d.yml", *options)
        assert result.returncode == 1 and words in result.stderr and result.stderr.count("\n") == 1, result


def test_subdivide(run):
    """contact.<pair>.subdivide: the cells that touch either side and no others, level by level; the patch test holds."""
    def leaves(*options):
        result = run("inputs/patch2d.yml", "-mesh_parameter_n", 4, *options)
        assert result.returncode == 0, result
        assert abs(result.summary["contact"]["upper_on_lower"]["force"][1] / 0.0688979 - 1) < 1e-5
        bulk = result.states()[-1][1]
        corners = bulk["X"][bulk["cells"]]
        assert len(corners) == result.summary["cells"]
        return numpy.ptp(corners[..., 1], axis=1), numpy.abs(corners[..., 1].mean(axis=1) - level)

    level = 1  # y of the faces in contact
    heights, distances = leaves()
    assert len(heights) == 4 * 4 + 6 * 6
    layer = distances < 0.51 * heights
    for times in (1, 2):
        fine, where = leaves("-contact_upper_on_lower_subdivide", times)
        rows = sum(2**i for i in range(times))
        assert len(fine) == 4 * 4 + 6 * 6 + 3 * (4 + 6) * rows
        assert numpy.isclose(numpy.sort(fine[where < 0.51 * fine]), numpy.sort(numpy.repeat(heights[layer], 2**times) / 2**times)).all()
        far = where > heights.max()  # beyond the layer nothing changes
        assert numpy.isclose(numpy.sort(fine[far]), numpy.sort(heights[distances > heights.max()])).all()


RING = """
mesh: {file: ring.geo, order: 3}
model: plane_strain
order: 3
body: {disc: {material: steel}, ring: {material: alu}}
material: {steel: {law: neo_hookean, E: 210000, nu: 0.3}, alu: {law: neo_hookean, E: 70000, nu: 0.33}}
boundary: {sym: {fix: y}}
contact: {c: {nonmortar: bore, mortar: rim, interference: "0.002*t"}}
load: {step: 1}
"""
RING_GEO = """
DefineConstant[ s = 0.2 ];
Point(1) = {0, 0, 0, s}; Point(2) = {1, 0, 0, s}; Point(3) = {0, 1, 0, s}; Point(4) = {-1, 0, 0, s};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 1}; Line(4) = {1, 2}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Point(12) = {1, 0, 0, 1.3 * s}; Point(13) = {0, 1, 0, 1.3 * s}; Point(14) = {-1, 0, 0, 1.3 * s}; Point(15) = {1.6, 0, 0, 1.3 * s}; Point(16) = {0, 1.6, 0, 1.3 * s}; Point(17) = {-1.6, 0, 0, 1.3 * s};
Circle(11) = {12, 1, 13}; Circle(12) = {13, 1, 14}; Line(13) = {14, 17}; Circle(14) = {17, 1, 16}; Circle(15) = {16, 1, 15}; Line(16) = {15, 12}; Curve Loop(2) = {11:16}; Plane Surface(2) = {2};
Recombine Surface {1, 2};
Physical Surface("disc") = {1}; Physical Surface("ring") = {2};
Physical Curve("rim") = {1, 2}; Physical Curve("bore") = {11, 12}; Physical Curve("sym") = {3, 4, 13, 16};
"""


def test_estimate_of_an_interference(run, tmp_path):
    """A ring on a disc, half of it: the pressure of Lame; what the estimate says of contact is small. The interference taken off gaps of the present measure, not of the reference one,
    left an overlap of interference times strain, which told 2.7 % here and more on finer meshes."""
    ring, disc_ = (1 + 0.33) / 70000 * (1 - 2 * 0.33 + 1.6**2) / (1.6**2 - 1), (1 + 0.3) * (1 - 2 * 0.3) / 210000
    (tmp_path / "ring.geo").write_text(RING_GEO)
    told = []
    for size in (0.2, 0.1):
        result = run("ring.yml", "-mesh_parameter_s", size, *QUIET, text=RING)
        assert result.returncode == 0, result
        told.append(result.summary["estimate"]["contact"] / result.summary["estimate"]["norm"])
        print(told, result.summary["estimated_error"], result.summary["contact"]["c"]["force"])
        assert abs(result.summary["contact"]["c"]["force"][1]) == pytest.approx(2 * 0.002 / (ring + disc_), rel=6e-3)
    assert max(told) < 1e-3


@pytest.mark.parametrize("mu", [0, 0.2])
def test_closed_gaps_leave_no_trace(run, mu):
    """Two squares that end flush: the same as without a gap, whatever gap of the mesh counts as closed. As constants taken off the integrals gaps left forces that jump where the ends pass each other: no equilibrium."""
    folder = pathlib.Path(__file__).resolve().parents[1] / "gauntlet"
    text = (folder / "flush.yml").read_text().replace("flush.geo", str(folder / "flush.geo")).replace('interference: "0.1*t"', "initial_gap: adjust")
    text = text.replace("top: {fix: xy}", 'top: {displacement: {x: 0, y: "-0.1*t"}}')
    results = [run("flush.yml", "-mesh_parameter_g", gap, "-contact_c_friction", mu, *QUIET, text=text) for gap in (0, 0.002, 0.05)]
    results.append(run("tests/gauntlet/flush.yml", "-contact_c_friction", mu, *QUIET))  # an interference as large as the way
    assert all(result.returncode == 0 and result.summary["step_cuts"] == 0 for result in results), results
    force = [result.summary["reaction"]["top"][1] for result in results]
    print(force)
    assert force[1:] == pytest.approx(force[:1] * 3, rel=1e-9)


@pytest.mark.parametrize("ranks, scene", [((2, 3), ("flush",)), ((2, 3), ("tight",)), ((2,), ("oring_roll", "-load_end", 0.5)),
                                          pytest.param((2, 3), ("oring_roll", "-load_end", 1), marks=pytest.mark.slow)])
def test_order_of_convergence_and_ranks(run, ranks, scene):
    """An interference in the plane, round an axis, with friction: residuals fall quadratically at the end of every step, and ranks agree."""
    one, *others = (run(f"tests/gauntlet/{scene[0]}.yml", *scene[1:], *QUIET, "-snes_monitor", ranks=count) for count in (1, *ranks))
    assert one.returncode == 0 and all(is_quadratic(step) for step in steps(one)), steps(one)
    pair = next(iter(one.summary["contact"]))
    for other in others:
        assert other.summary["newton_iterations"] == one.summary["newton_iterations"]
        assert other.summary["energy"] == pytest.approx(one.summary["energy"], rel=1e-11)
        assert other.summary["contact"][pair]["force"] == pytest.approx(one.summary["contact"][pair]["force"], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_patch_across_a_closed_gap(run, order):
    """Uniform stress between faces of 4 and 7 cells, 0.05 apart in the mesh: the pressure is the force over the area everywhere, and the force that of a mesh without a gap."""
    folder = pathlib.Path(__file__).resolve().parents[1] / "gauntlet"
    text = (folder / "flush.yml").read_text().replace("flush.geo", str(folder / "flush.geo")).replace('interference: "0.1*t"', "initial_gap: adjust")
    text = text.replace("bottom: {fix: xy}, top: {fix: xy}", 'bottom: {fix: y}, top: {displacement: {y: "-0.1*t"}}, left: {fix: x}')
    gap, none = (run("patch.yml", "-order", order, *words, *QUIET, text=text)
                 for words in (("-mesh_parameter_g", 0.05, "-mesh_parameter_m", 7), ("-mesh_parameter_g", 0)))
    pair = gap.summary["contact"]["c"]
    print(gap.summary["reaction"]["top"], pair["max_pressure"], pair["area"], gap.summary["estimated_error"])
    assert gap.returncode == 0 and gap.summary["estimated_error"] < 1e-7, gap  # the root of round-off
    assert pair["max_pressure"] * pair["area"] == pytest.approx(abs(pair["force"][1]), rel=1e-10)
    assert gap.summary["reaction"]["top"][1] == pytest.approx(none.summary["reaction"]["top"][1], rel=1e-10)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_interference_is_a_length(run, order):
    """A hub stretched by a tenth on a rigid shaft: forces on both as on a shaft that is meshed as much thicker. The integrals less a constant gave 23.17 and 21.38 for 25.21."""
    thick = ("-mesh_parameter_R", 22, "-contact_c_interference", 0, "-contact_c_initial_gap", "ramp")
    bush, meshed = (run("tests/gauntlet/tight.yml", "-order", order, *words, *QUIET) for words in ((), thick))
    assert bush.returncode == meshed.returncode == 0, (bush, meshed)
    pair = bush.summary["contact"]["c"]
    print(pair["force"], meshed.summary["contact"]["c"]["force"])
    assert [pair["force"][0], -pair["mortar_force"][0]] == pytest.approx([meshed.summary["contact"]["c"]["force"][0]] * 2, rel=1e-10)


def test_friction_across_an_interference(run):
    """A shaft drawn out of a hub that it was shrunk into: the pull is that of a shaft meshed thicker, but for the sides' being 0.01 apart; 3 % less where gaps were constants of the integrals."""
    thick = ("-mesh_parameter_d", 0.01, "-contact_c_interference", 0, "-contact_c_initial_gap", "ramp")
    pull = [run("tests/gauntlet/pull_out.yml", "-order", 3, *words, *QUIET).summary["reaction"]["head"][1] for words in ((), thick)]
    print(pull)
    assert pull[0] == pytest.approx(pull[1], rel=3e-4)
