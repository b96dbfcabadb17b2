"""What a run left in its directory: csv tables, summary, and the grids that fields.xdmf names.

    run = mortise.Run("out/hertz2d")
    run.history["t"], run.adapt, run.summary, run.names(), run.times("bulk"), run.state("bulk", time=0.5)
"""
import csv
import json
import pathlib
import xml.etree.ElementTree

import h5py
import numpy as np


def table(path):
    """{column: array} of a csv table; {} when it is not there or has no rows."""
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0]} if rows else {}


class State:
    """One grid at one time: time, cells, X, fields at points and at cells (name -> array), information.

    `only`, a name and a value: the cells that have it.
    """

    def __init__(self, element, directory, only=None):
        def data(item):
            file, path = item.text.strip().split(":")
            with h5py.File(directory / file, "r") as h5:
                return h5[path][...]

        self.time = float(element.find("Time").get("Value"))
        self.info = {i.get("Name"): i.get("Value") for i in element.findall("Information")}
        self.cells = data(element.find("Topology/DataItem"))
        self.X = data(element.find("Geometry/DataItem"))
        self.point, self.cell = {}, {}
        for attribute in element.findall("Attribute"):
            kind = self.cell if attribute.get("Center") == "Cell" else self.point
            kind[attribute.get("Name")] = data(attribute.find("DataItem"))
        if only and only[0] in self.cell:
            keep = self.cell[only[0]] == only[1]
            points, cells = np.unique(self.cells[keep], return_inverse=True)
            self.cells, self.X = cells.reshape(-1, self.cells.shape[1]), self.X[points]
            self.point = {name: values[points] for name, values in self.point.items()}
            self.cell = {name: values[keep] for name, values in self.cell.items()}

    def at_corners(self, name):
        """Values of a scalar field at the corners of each cell."""
        if name in self.point:
            return self.point[name][self.cells]
        return np.repeat(self.cell[name][:, None], self.cells.shape[1], axis=1)


class Run:
    """A directory of results. Tables are read when they are asked for."""

    def __init__(self, directory):
        self.directory = pathlib.Path(directory)
        index = self.directory / "fields.xdmf"
        found = xml.etree.ElementTree.parse(index).getroot().findall("Domain/Grid") if index.exists() else ()
        self._series = {grid.get("Name"): grid.findall("Grid") for grid in found}

    @property
    def history(self):
        return table(self.directory / "history.csv")

    @property
    def adapt(self):
        return table(self.directory / "adapt.csv")

    @property
    def summary(self):
        return json.loads((self.directory / "summary.json").read_text())

    def names(self):
        """Names of the series of grids."""
        return list(self._series)

    def times(self, name="bulk"):
        return np.array([float(grid.find("Time").get("Value")) for grid in self._series[name]])

    def load_times(self, name="bulk"):
        """Times of the load. Adaptation passes of one load step share it; times() tells them apart."""
        found = [grid.find("Information[@Name='load_time']") for grid in self._series[name]]
        own = self.times(name)
        return np.array([t if info is None else float(info.get("Value")) for info, t in zip(found, own)])

    def state(self, name="bulk", time=None, only=None):
        """The grid `name` at the load time next to `time`, after its last pass; without one, the last of all."""
        away = np.zeros(len(self._series[name])) if time is None else np.abs(self.load_times(name) - time)
        at = np.flatnonzero(away == away.min())[-1]
        return State(self._series[name][at], self.directory, only)

    def contacts(self, time):
        """Contact grids of the bulk state whose own time (State.time) is `time`: the sides that carry the pressure."""
        found = [(name, np.flatnonzero(self.times(name) == time)) for name in self._series if name != "bulk"]
        return [State(self._series[name][at[-1]], self.directory, ("side", 0)) for name, at in found if len(at)]
