"""Overlap at the start that is deep against the radius of the tip: no load parameter scales it, so the step cannot be cut."""
import pytest

SCENES = {"rubber": ("-mesh_parameter_r", 0.05, "-mesh_parameter_o", 0.6), "compressible": ("-mesh_parameter_r", 0.05, "-mesh_parameter_o", 0.6, "-material_rubber_nu", 0.4)}


@pytest.mark.parametrize("name", SCENES)
def test_taken_up_in_pieces(run, name):
    """The deepest place first, the whole load from the first piece on; in one step nothing is found."""
    options = ("tests/gauntlet/wiper.yml", *SCENES[name], "-output_fields", "false")
    pieces, one = run(*options), run(*options, "-path_overlap", "off", "-load_step_min", 0.4)
    assert pieces.returncode == 0 and one.returncode == 2, (pieces, one)
    assert pieces.summary["recoveries"]["overlap"] == {"tried": 1, "succeeded": 1} and pieces.summary["load_steps"] == 1
    assert one.summary["recoveries"]["overlap"]["tried"] == 0
    force = pieces.summary["contact"]["c"]["force"]
    assert force[1] == pytest.approx(-pieces.summary["reaction"]["arm"][1], rel=1e-8) and abs(force[0]) < 1e-6 * force[1]


def test_only_where_one_step_does_not_do(run):
    result = run("tests/gauntlet/wiper.yml", "-order", 2, "-output_fields", "false")
    assert result.returncode == 0 and result.summary["recoveries"]["overlap"]["tried"] == 0 and result.summary["newton_iterations"] <= 12
