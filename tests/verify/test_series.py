"""fields.xdmf is one series over the times of the load, as meshio and VTK (so ParaView) read it; passes of adaptation are apart from it, in passes.xdmf."""
import sys
import xml.etree.ElementTree

import numpy as np
import pytest

from conftest import ROOT

sys.path.insert(0, str(ROOT / "python"))
import mortise

ADAPTIVE = ("inputs/hertz2d.yml", "-order", 1, "-load_step", 0.5, "-adapt_tolerance", 0.2)


@pytest.fixture
def result(run):
    return run(*ADAPTIVE)


def marks(result, index, grid):
    """(step, pass, load time) of each state of a grid, as the index tells them."""
    root = xml.etree.ElementTree.parse(result.directory / index).getroot()
    return [tuple(float(state.find(f"Information[@Name='{name}']").get("Value")) for name in ("step", "pass", "load_time"))
            for state in root.findall(f"Domain/Grid[@Name='{grid}']/Grid")]


def test_times_and_passes(result):
    rows = [(row["step"], row["pass"], row["t"]) for row in result.adapt]
    last = [row for row, then in zip(rows, [*rows[1:], None]) if not then or then[0] != row[0]]
    assert len(rows) > len(last) + 2 and len(last) == 2
    for grid in "bulk", "contact":
        assert marks(result, "fields.xdmf", grid) == last and marks(result, "passes.xdmf", grid) == rows
        assert [t for t, _ in result.states(grid)] == [row["t"] for row in result.history] == [0.5, 1]
        assert [t for t, _ in result.states(grid, passes=True)] == list(range(len(rows)))
    assert [len(state["cells"]) for _, state in result.states(passes=True)] == [row["cells"] for row in result.adapt]
    one, all_of_it = mortise.Run(result.directory), mortise.Run(result.directory, passes=True)
    assert list(one.times()) == [0.5, 1] and list(all_of_it.load_times()) == [row["t"] for row in result.adapt]
    assert len(one.state(time=0.5).cells) == len(all_of_it.state(time=0.5).cells) == result.history[0]["cells"]


def test_without_passes_there_is_one_series(run, result):
    """And the next run in the directory leaves nothing of the one before."""
    assert (result.directory / "passes.xdmf").exists()
    again = run(*ADAPTIVE, "-adapt_tolerance", 0, "-output_directory", result.directory)
    assert again.returncode == 0 and not (result.directory / "passes.xdmf").exists()
    assert mortise.Run(result.directory, passes=True).times().tolist() == [0.5, 1]


def test_meshio_reads_a_series(result):
    meshio = pytest.importorskip("meshio")
    for index, states in ("fields.xdmf", result.states()), ("passes.xdmf", result.states(passes=True)):
        series = xml.etree.ElementTree.parse(result.directory / index).getroot().find("Domain")
        assert series[-1].get("Name") == "bulk"  # the one that meshio takes
        with meshio.xdmf.TimeSeriesReader(result.directory / index) as reader:
            assert reader.num_steps == len(states)
            for k, (time, state) in enumerate(states):
                reader.mesh_grid = reader.collection[k]  # every state has its own mesh, meshio takes the first
                points, cells = reader.read_points_cells()
                assert np.array_equal(points, state["X"]) and np.array_equal(cells[0].data, state["cells"])
                t, point, cell = reader.read_data(k)
                assert t == time and np.array_equal(point["displacement"], state["displacement"]) and np.array_equal(cell["body"][0], state["body"])


def test_vtk_reads_a_series(result):
    pytest.importorskip("vtkmodules")
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    for index, grids in ("fields.xdmf", [result.states(grid) for grid in ("contact", "bulk")]), ("passes.xdmf", [result.states(g, passes=True) for g in ("contact", "bulk")]):
        reader = vtkXdmfReader()
        reader.SetFileName(str(result.directory / index))
        reader.UpdateInformation()
        assert list(reader.GetOutputInformation(0).Get(pipeline.TIME_STEPS())) == [time for time, _ in grids[0]]
        for k, (time, _) in enumerate(grids[0]):
            reader.UpdateTimeStep(time)
            blocks = [reader.GetOutputDataObject(0).GetBlock(b) for b in range(len(grids))]
            for block, states in zip(blocks, grids):
                assert block.GetNumberOfCells() == len(states[k][1]["cells"]) and block.GetPointData().HasArray("displacement")
