"""scripts/plot draws what a run left: the curves of adapt.csv and the outlines of cells, not of their sub-cells."""
import importlib.machinery
import importlib.util
import pathlib

import numpy as np

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts" / "plot"
loader = importlib.machinery.SourceFileLoader("plot", str(SCRIPT))
plot = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot", loader))
loader.exec_module(plot)


def test_outline_is_of_cells():
    """Two cells side by side, 2 x 2 sub-cells each: 8 edges around each cell, the 4 inside it not drawn."""
    number = np.arange(15).reshape(3, 5)  # points of a 4 x 2 grid of sub-cells
    quads = np.array([(number[j, i], number[j, i + 1], number[j + 1, i + 1], number[j + 1, i]) for j in range(2) for i in range(4)])
    leaf = np.array([i // 2 for j in range(2) for i in range(4)])
    edges, owner = plot.outline(quads, leaf)
    assert len(edges) == 16
    drawn = {tuple(sorted(e)) for e in edges}
    assert (2, 7) in drawn and (7, 12) in drawn  # between the two cells
    assert (1, 6) not in drawn and (5, 6) not in drawn  # inside the first
    assert all(set(edge) <= set(quads[q]) for edge, q in zip(edges, owner))


def test_skin_has_no_inner_faces():
    """Two hexahedra on each other with points of their own: 10 of 12 faces are outside."""
    faces = np.array(plot.HEX_FACES)
    place = np.concatenate([faces, faces + 4])  # the upper one's bottom is the lower one's top
    assert plot.used_once(place).sum() == 10
