"""What a run left in its directory: csv tables, summary, and the grids that fields.xdmf names.

    run = mortise.Run("out/hertz2d")
    run.history["t"], run.adapt, run.summary, run.names(), run.times("bulk"), run.state("bulk", time=0.5)
    mortise.Run("out/hertz2d", passes=True)  # the same with all passes of adaptation, of which fields.xdmf has the last of each load step
"""
import copy
import csv
import json
import pathlib
import re
import xml.etree.ElementTree

import h5py
import numpy as np


class Table(dict):
    """{column: array}; units of the columns that have one in units (column "force [N]" is force, in N)."""

    def __init__(self, columns=(), units=()):
        super().__init__(columns)
        self.units = dict(units)

    def label(self, column):
        """Name with the unit, for an axis."""
        return labelled(column, self.units.get(column))


def labelled(name, unit):
    return f"{name} [{unit}]" if unit else name


def table(path):
    """The columns of a csv table; empty when it is not there or has no rows."""
    path = pathlib.Path(path)
    if not path.exists():
        return Table()
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if line.endswith("\n")))  # of a run that goes on the last row may be a part
    found = {key: re.fullmatch(r"(.*?)(?: \[(.*)\])?", key).groups() for key in rows[0]} if rows else {}
    try:
        columns = {name: np.array([float(row[key] or "nan") for row in rows]) for key, (name, _) in found.items()}
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return Table(columns, {name: unit for name, unit in found.values() if unit})


SIX = ("xx", "xy", "xz", "yy", "yz", "zz")
NINE = tuple(a + b for a in "xyz" for b in "xyz")
ROUND_OFF = 1e-9  # of the stress in the bodies: a pressure below is none


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def parts(name, columns):
    """What stands after the dot, by number of components; tensors of six come with principal values."""
    if columns == 6:
        return (*SIX, "1", "2", "3")
    if columns == 9:
        return NINE
    if columns == 3:
        return ("1", "2", "3") if name == "principal_stretches" else ("x", "y", "z", "norm")
    return ()


class State:
    """One grid at one time: time, cells, X, fields at points and at cells (name -> array), information.

    `only`, a name and a value: the cells that have it.
    """

    def __init__(self, element, directory, only=None):
        self.units, self.names = {}, {}  # of fields; of the values 0, 1, ... of body, pair, side

        def data(item, name=None):
            file, path = item.text.strip().split(":")
            with h5py.File(directory / file, "r") as h5:
                if "unit" in h5[path].attrs:
                    self.units[name] = text(h5[path].attrs["unit"])
                if "names" in h5[path].attrs:
                    self.names[name] = [text(word) for word in np.atleast_1d(h5[path].attrs["names"])]
                return h5[path][...]

        self.time = float(element.find("Time").get("Value"))
        self.info = {i.get("Name"): i.get("Value") for i in element.findall("Information")}
        self.cells = data(element.find("Topology/DataItem"))
        self.X = data(element.find("Geometry/DataItem"))
        self.point, self.cell = {}, {}
        for attribute in element.findall("Attribute"):
            kind = self.cell if attribute.get("Center") == "Cell" else self.point
            kind[attribute.get("Name")] = data(attribute.find("DataItem"), attribute.get("Name"))
        if only and only[0] in self.cell:
            self.keep(self.cell[only[0]] == only[1])

    def number(self, name, word):
        """The number of a body, pair or side, by its name or by itself."""
        known = self.names.get(name, [])
        if str(word) not in known and not str(word).isdigit():
            raise KeyError(f"no {name} {word}; there are {', '.join(known)}")
        return known.index(str(word)) if str(word) in known else int(word)

    def where(self, name, word):
        """Which cells are of a body, pair or side."""
        return self.cell[name] == self.number(name, word)

    def only(self, name, word):
        """A copy with these cells alone."""
        part = copy.copy(self)
        part.keep(self.where(name, word))
        return part

    def fields(self):
        """Names of all scalars that value() gives: fields, their components and principal values."""
        out = []
        for name, values in {**self.point, **self.cell}.items():
            columns = 1 if values.ndim == 1 else values.shape[1]
            out += [name] if columns == 1 else [f"{name}.{part}" for part in parts(name, columns)]
        return out

    def value(self, name):
        """A scalar at points or cells: a field, or part of one: displacement.y, displacement.norm, stress.xy, stress.1 (largest principal value) to .3."""
        field, _, part = name.partition(".")
        kind = self.point if field in self.point else self.cell
        if field not in kind:
            raise KeyError(f"no field {name}; there are {', '.join(self.fields())}")
        values = kind[field]
        columns = 1 if values.ndim == 1 else values.shape[1]
        if not part and columns == 1:
            return values
        if part not in parts(field, columns):
            raise KeyError(f"{field} is no scalar; give {', '.join(f'{field}.{p}' for p in parts(field, columns))}" if columns > 1 else f"{field} has no part {part}")
        if part == "norm":
            return np.sqrt((values ** 2).sum(axis=1))
        if columns == 6 and part in "123":
            return np.linalg.eigvalsh(values[:, (0, 1, 2, 1, 3, 4, 2, 4, 5)].reshape(-1, 3, 3))[:, 3 - int(part)]
        return values[:, parts(field, columns).index(part)]

    def label(self, name):
        return labelled(name.replace("_", " "), self.units.get(name.partition(".")[0]))

    def at_corners(self, name):
        """Values of a scalar (as of value) at the corners of each cell."""
        values = self.value(name)
        if name.partition(".")[0] in self.point:
            return values[self.cells]
        return np.repeat(values[:, None], self.cells.shape[1], axis=1)

    def keep(self, cells):
        """Leave these cells (mask) and their points alone."""
        points, numbers = np.unique(self.cells[cells], return_inverse=True)
        self.cells, self.X = numbers.reshape(-1, self.cells.shape[1]), self.X[points]
        self.point = {name: values[points] for name, values in self.point.items()}
        self.cell = {name: values[cells] for name, values in self.cell.items()}

    def curves(self):
        """Lines of points, in order, of a grid of line pieces: [point numbers], ends joined where they are at one place."""
        place = np.unique(np.round(self.X / (np.ptp(self.X, axis=0).max() or 1), 9), axis=0, return_inverse=True)[1].reshape(-1)
        after, starts = {}, []
        for k, (a, _) in enumerate(self.cells):
            after.setdefault(place[a], []).append(k)
        ends = {place[b] for _, b in self.cells}
        starts = [k for k, (a, _) in enumerate(self.cells) if place[a] not in ends] + list(range(len(self.cells)))
        used, out = set(), []
        for k in starts:
            line = []
            while k is not None and k not in used:
                used.add(k)
                line += list(self.cells[k]) if not line or place[line[-1]] != place[self.cells[k][0]] else [self.cells[k][1]]
                k = next((n for n in after.get(place[self.cells[k][1]], []) if n not in used), None)
            if line:
                out.append(np.array(line))
        return out

    def arc(self, line, deformed=False):
        """Length along a line of points at the reference positions, or the deformed ones."""
        x = (self.X + self.point["displacement"] if deformed else self.X)[line]
        return np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])


def clean(contact, bulk):
    """Contact pressures of round-off size, measured by the stress in the bodies, become zero."""
    if "contact_pressure" in contact.point and "von_mises" in {**bulk.point, **bulk.cell}:
        stress = max(np.nanmax(np.abs(bulk.value("pressure"))), np.nanmax(bulk.value("von_mises")))
        pressure = contact.point["contact_pressure"]
        pressure[np.abs(pressure) <= ROUND_OFF * stress] = 0


class Run:
    """A directory of results. Tables are read when they are asked for.

    passes: all passes of adaptation; times() are then their numbers, load_times() the times that they share.
    """

    def __init__(self, directory, passes=False):
        self.directory = pathlib.Path(directory)
        if not self.directory.is_dir():
            raise FileNotFoundError(f"there is no directory {directory}")
        index = self.directory / "passes.xdmf"  # there where a load step has several
        if not passes or not index.exists():
            index = self.directory / "fields.xdmf"
        try:
            found = xml.etree.ElementTree.parse(index).getroot().findall("Domain/Grid") if index.exists() else ()
        except xml.etree.ElementTree.ParseError as error:
            raise ValueError(f"{index} is damaged: {error}") from None
        self._series = {grid.get("Name"): grid.findall("Grid") for grid in found}

    @property
    def history(self):
        return table(self.directory / "history.csv")

    @property
    def adapt(self):
        return table(self.directory / "adapt.csv")

    @property
    def units(self):
        """Units of the scene as it says them; "": it does not."""
        return self.summary.get("units", "")

    @property
    def summary(self):
        return json.loads((self.directory / "summary.json").read_text())

    def names(self):
        """Names of the series of grids."""
        return list(self._series)

    def times(self, name="bulk"):
        return np.array([float(grid.find("Time").get("Value")) for grid in self._series[name]])

    def load_times(self, name="bulk"):
        """Times of the load; along a path, where it may fall, other ones than times()."""
        found = [grid.find("Information[@Name='load_time']") for grid in self._series[name]]
        own = self.times(name)
        return np.array([t if info is None else float(info.get("Value")) for info, t in zip(found, own)])

    def state(self, name="bulk", time=None, only=None):
        """The grid `name` at the load time next to `time`, after its last pass; without one, the last of all."""
        if not self._series.get(name):
            raise KeyError(f"no grid {name} in {self.directory}/fields.xdmf; there are {', '.join(self._series) or 'none'}")
        away = np.zeros(len(self._series[name])) if time is None else np.abs(self.load_times(name) - time)
        at = np.flatnonzero(away == away.min())[-1]
        return State(self._series[name][at], self.directory, only)

    def contacts(self, time):
        """Contact grids of the bulk state whose own time (State.time) is `time`: the sides that carry the pressure."""
        found = [(name, np.flatnonzero(self.times(name) == time)) for name in self._series if name != "bulk"]
        states = [State(self._series[name][at[-1]], self.directory, ("side", 0)) for name, at in found if len(at)]
        bulk = State(self._series["bulk"][np.flatnonzero(self.times() == time)[-1]], self.directory)
        for state in states:
            clean(state, bulk)
        return states

    def contact(self, pair=None, time=None, side="nonmortar"):
        """One side of a contact pair, by name or number (None: all), at the load time next to `time`, pressures of round-off size set to zero.
        In the plane a curve: points in order in .curves(), length along it in .arc()."""
        state = self.state("contact", time=time, only=("side", ("nonmortar", "mortar").index(side)))
        if pair is not None:
            state.keep(state.where("pair", pair))
        clean(state, self.state(time=time))
        return state
