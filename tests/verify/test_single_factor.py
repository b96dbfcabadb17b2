"""Factors in single precision refined by GMRES in double give what factors in double give, in as many Newton iterations, or are given up for those."""
import pytest

QUIET = ("-output_fields", "false", "-solve_linear", "direct")
HERTZ = ("inputs/hertz3d.yml", *QUIET, "-adapt_tolerance", 0)


def both(run, *options, ranks=1):
    single, double = (run(*options, "-solve_factor", kind, ranks=ranks).summary for kind in ("single", "double"))
    print({key: (single[key], double[key]) for key in ("newton_iterations", "factorisations", "single_factor_failures")})
    assert single["status"] == double["status"] == "converged"
    return single, double


def assert_same(single, double, support):
    largest = max(map(abs, double["reaction"][support]))
    assert all(abs(a - b) <= 1e-9 * largest for a, b in zip(single["reaction"][support], double["reaction"][support]))
    assert single["newton_iterations"] == double["newton_iterations"] and single["step_cuts"] == double["step_cuts"]
    assert single["single_factor_failures"] == double["single_factor_failures"] == 0
    assert single["factorisations"] > 0


@pytest.mark.parametrize("order, ranks", [(1, 1), (1, 2), (2, 1), pytest.param(2, 2, marks=pytest.mark.slow)])
def test_hertz3d(run, order, ranks):
    assert_same(*both(run, *HERTZ, "-order", order, "-mesh_parameter_n", 4, ranks=ranks), "top")


def test_units(run):
    """Pascal instead of one: entries of the tangent beyond what a float holds when squared."""
    one, pascal = (both(run, *HERTZ, "-order", 1, "-mesh_parameter_n", 4, "-material_rubber_E", E) for E in (1, 2e11))
    assert_same(*pascal, "top")
    assert pascal[0]["newton_iterations"] == one[0]["newton_iterations"]
    assert pascal[0]["reaction"]["top"][2] / 2e11 == pytest.approx(one[0]["reaction"]["top"][2], rel=1e-9)


@pytest.mark.parametrize("ranks", [1, 3])
def test_blocks3d(run, ranks):
    assert_same(*both(run, "inputs/blocks3d.yml", *QUIET, ranks=ranks), "bottom")


def test_large_problems_choose_it(run):
    """By size alone: the same scene below and above 20 000 unknowns; the factorisations are counted, and one serves several solutions."""
    small, large = (run(*HERTZ, "-order", 1, "-mesh_parameter_n", n, "-mesh_parameter_k", k, "-info", timeout=240) for n, k in ((4, 7), (9, 16)))
    assert "single factor: status 0" not in small.stdout and "single factor: status 0" in large.stdout
    assert large.summary["dofs"] >= 20000 > small.summary["dofs"]
    assert large.summary["factorisations"] < large.summary["newton_iterations"]


def test_falls_back(run):
    """One iteration of GMRES is too few for a factor in single precision: the first one fails, those in double take over and nothing else changes."""
    short, double = (run(*HERTZ, "-order", 1, "-mesh_parameter_n", 4, *options).summary
                     for options in (("-solve_factor", "single", "-again_ksp_max_it", 1), ("-solve_factor", "double")))
    assert short["status"] == "converged" and short["single_factor_failures"] == 1
    assert short["newton_iterations"] == double["newton_iterations"] and short["factorisations"] > double["factorisations"]
    assert short["reaction"]["top"] == pytest.approx(double["reaction"]["top"], rel=1e-9)


def test_bad_value_is_an_input_error(run):
    result = run(*HERTZ, "-solve_factor", "single", "-pc_type", "lu")
    assert result.returncode == 1 and "-solve_factor single" in result.stderr, result
