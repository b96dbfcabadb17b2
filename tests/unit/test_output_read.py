"""What test_output_writer_mpi.c writes, read the way a user's script would: fields.xdmf by an XML parser, data by h5py."""
import os
import pathlib
import subprocess
import xml.etree.ElementTree

import h5py
import numpy as np
import pytest

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = pathlib.Path(os.environ.get("MORTISE_BUILD", HERE.parent.parent / "build")) / "unit" / "test_output_writer_mpi"


def item(directory, element):
    """The array of a DataItem; its Dimensions must be those of the data set."""
    file, path = element.text.strip().split(":")
    with h5py.File(directory / file) as h5:
        assert h5.attrs["complete"] == 1
        data = h5[path]
        assert data.compression == "gzip" and data.shuffle
        assert tuple(map(int, element.get("Dimensions").split())) == data.shape
        return data[...]


@pytest.mark.parametrize("ranks", (1, 2, 3))
def test_series_reads_back(ranks, tmp_path):
    process = subprocess.run(["mpiexec", "-n", str(ranks), str(PROGRAM), "-directory", str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert process.returncode == 0, process.stdout + process.stderr
    domain = xml.etree.ElementTree.parse(tmp_path / "fields.xdmf").getroot().find("Domain")
    series = {grid.get("Name"): grid.findall("Grid") for grid in domain}
    assert {name: len(states) for name, states in series.items()} == {"bulk": 2, "contact": 1}  # no contact cells in the first state
    assert all(grid.get("CollectionType") == "Temporal" for grid in domain)
    assert [float(state.find("Time").get("Value")) for state in series["bulk"]] == [0.0, 0.1 + 0.2]
    facts = {i.get("Name"): float(i.get("Value")) for i in series["bulk"][1].findall("Information")}
    assert facts == {"time": 0.1 + 0.2, "step": 5, "pass": 1, "load_time": 0.25}
    for state in series["bulk"]:
        cells = item(tmp_path, state.find("Topology/DataItem"))
        X = item(tmp_path, state.find("Geometry/DataItem"))
        field = {a.get("Name"): item(tmp_path, a.find("DataItem")) for a in state.findall("Attribute")}
        kind = {a.get("Name"): (a.get("AttributeType"), a.get("Center")) for a in state.findall("Attribute")}
        assert kind == {"displacement": ("Vector", "Node"), "stress": ("Tensor6", "Node"), "level": ("Scalar", "Cell")}
        assert np.array_equal(field["displacement"], np.stack([X[:, 0] / 3, -X[:, 1], X.prod(axis=1)], axis=1))
        assert np.array_equal(field["stress"], np.arange(6) + X[:, :1] / 7)
        assert np.array_equal(field["level"], X[cells][:, :, 0].min(axis=1))
        # VTK's hexahedron: bottom quad around, top quad above it. Each is 1 x 2 x 3, edge 0-1 along x, 1-2 along y, 0-4 along z.
        corner = X[cells]
        for a, b, edge in ((0, 1, (1, 0, 0)), (1, 2, (0, 2, 0)), (3, 2, (1, 0, 0)), (0, 4, (0, 0, 3)), (4, 5, (1, 0, 0)), (5, 6, (0, 2, 0))):
            assert np.array_equal(corner[:, b] - corner[:, a], np.broadcast_to(edge, (len(cells), 3)))
