"""python/mortise reads a run: tables, summary, times, and grids at a time."""
import pathlib
import sys

import numpy as np

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
