"""python/mortise reads a run: tables, summary, times, and grids at a time."""
import pathlib
import sys

import numpy as np
import pytest

from conftest import PROGRAM, ROOT

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "python"))
import mortise

INDEX = """<Xdmf><Domain><Grid Name="bulk">{}</Grid></Domain></Xdmf>"""
GRID = """<Grid><Time Value="{}"/></Grid>"""


def test_times_and_tables(tmp_path):
    (tmp_path / "fields.xdmf").write_text(INDEX.format("".join(GRID.format(t) for t in (0, 0.5, 1))))
    (tmp_path / "history.csv").write_text("t,cells\n0.5,4\n1,\n")
    (tmp_path / "summary.json").write_text('{"status": "converged"}')
    run = mortise.Run(tmp_path)
    assert run.names() == ["bulk"]
    assert list(run.times()) == [0, 0.5, 1]
    assert list(run.history["t"]) == [0.5, 1] and np.isnan(run.history["cells"][1])
    assert run.adapt == {}
    assert run.summary["status"] == "converged"


def test_empty_directory(tmp_path):
    assert mortise.Run(tmp_path).names() == []


def test_passes_share_a_load_time(tmp_path):
    passes = ((0.5, 0.5), (1, 1), (1.000001, 1))
    info = """<Grid><Time Value="{}"/><Information Name="load_time" Value="{}"/></Grid>"""
    (tmp_path / "fields.xdmf").write_text(INDEX.format("".join(info.format(*p) for p in passes)))
    run = mortise.Run(tmp_path)
    assert list(run.times()) == [0.5, 1, 1.000001]
    assert list(run.load_times()) == [0.5, 1, 1]


def test_units_of_columns(tmp_path):
    """The unit stands in the header and is no part of the name."""
    (tmp_path / "history.csv").write_text("t,energy [N mm],gap.a-b [mm]\n1,2,3\n")
    history = mortise.Run(tmp_path).history
    assert list(history) == ["t", "energy", "gap.a-b"] and history.units == {"energy": "N mm", "gap.a-b": "mm"}
    assert history.label("energy") == "energy [N mm]" and history.label("t") == "t"


def test_runs_and_reads(tmp_path, monkeypatch):
    """A sweep: the pressure of the patch test by its closed form, contact as a curve, components, principal values, units and names."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MORTISE", str(PROGRAM))
    keys = {"output.quantities": "logarithmic_strain,principal_stretches,first_piola", "units": "mm, N, MPa"}
    runs = mortise.sweep(ROOT / "inputs" / "patch2d.yml", "boundary.top.displacement.y", [-0.1, 0], jobs=2, keys=keys)
    run = runs[-0.1]
    assert run.units == "mm, N, MPa" and (run.directory / "run.log").exists()
    rows = mortise.compare(runs.values(), ["status", "contact.upper_on_lower.max_pressure", "contact.upper_on_lower.force.1"])
    assert [row[1] for row in rows] == ["converged"] * 2 and abs(rows[0][2] - 0.068898) < 1e-6 and abs(rows[0][3] - 0.068898) < 1e-6
    bulk = run.state()
    assert np.allclose(bulk.value("logarithmic_strain.yy"), np.log(0.95)) and np.allclose(bulk.value("logarithmic_strain.3"), np.log(0.95))
    assert np.allclose(bulk.value("principal_stretches.3"), 0.95) and np.allclose(bulk.value("stress.3"), -0.068898, atol=1e-6)
    assert np.allclose(bulk.value("displacement.norm"), -bulk.value("displacement.y")) and bulk.value("first_piola.yx").shape == bulk.value("J").shape
    assert bulk.label("stress.3") == "stress.3 [MPa]" and bulk.names["body"] == ["lower", "upper"] and bulk.where("body", "upper").sum() == 25
    for wrong in ("stress", "stress.7", "none"):
        with pytest.raises(KeyError):
            bulk.value(wrong)
    for side, nodes in (("nonmortar", 6), ("mortar", 4)):
        contact = run.contact("upper_on_lower", side=side)
        (line,) = contact.curves()
        assert len(line) == nodes and abs(contact.arc(line)[-1] - 1) < 1e-12 and np.all(np.diff(contact.X[line, 0]) * np.sign(contact.X[line[-1], 0] - 0.5) > 0)
        assert np.allclose(contact.point["contact_pressure"], 0.068898, atol=1e-6)
    assert np.all(runs[0].contact().point["contact_pressure"] == 0)  # round-off is no pressure
    with pytest.raises(mortise.WrongInput, match="material.rubber.nu: 0.7 is not between"):
        mortise.run(ROOT / "inputs" / "patch2d.yml", {"material.rubber.nu": 0.7}, tmp_path / "out" / "wrong")


def test_values_that_begin_with_a_minus(tmp_path, monkeypatch):
    monkeypatch.setenv("MORTISE", str(PROGRAM))
    (run,) = mortise.sweep(ROOT / "inputs" / "patch2d.yml", "boundary.top.displacement.y", ["-t*0.05"], directory=tmp_path / "out").values()
    assert run.summary["status"] == "converged" and run.directory == tmp_path / "out" / "-t*0.05"


def test_places_of_their_own(tmp_path):
    """A sweep keeps runs apart whose values are written alike, and below its directory; what is not there is no empty run."""
    from mortise import running
    places = []
    kept, running.run = running.run, lambda scene, keys, directory, **options: places.append(directory)
    try:
        running.sweep("s.yml", "mesh.file", ["a/b", "a_b", ".."], directory=tmp_path)
    finally:
        running.run = kept
    assert len(set(places)) == 3 and all(tmp_path in place.resolve().parents for place in places)
    with pytest.raises(FileNotFoundError, match="there is no directory"):
        mortise.Run(tmp_path / "none")
