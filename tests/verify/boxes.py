"""Boxes of hexahedra for the cases of contact in three dimensions, written as gmsh 2.2 ASCII, and scenes made of them.

    boxes(path, {"lower": Box((0, 0, 0), (1, 1, 1), (2, 2, 2)), "upper": Box((0, 0, 1), (1, 1, 1), (3, 3, 2))}, to=lambda x: x)

Each box is a body with its own points; its faces are named lower_x0, lower_x1, ..., lower_z1. `to` maps every point, whichever box it belongs to.
"""
import itertools
from typing import NamedTuple

import numpy

from contactkit import yaml

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


class Box(NamedTuple):
    origin: tuple
    size: tuple
    number: tuple
    to: object = None  # its own map, before that of all


def boxes(path, parts, to=lambda x: x):
    points, elements, names = [], [], []
    for name, box in parts.items():
        first, number = len(points) + 1, box.number

        def node(i, j, k, first=first, number=number):
            return first + i + (number[0] + 1) * (j + (number[1] + 1) * k)

        for k, j, i in itertools.product(*(range(n + 1) for n in reversed(number))):
            x = numpy.array(box.origin) + numpy.array(box.size) * (i, j, k) / numpy.array(number)
            points.append(to(box.to(x) if box.to else x))
        names.append((3, name))
        for cell in itertools.product(*map(range, number)):
            elements.append((5, len(names), [node(*(c + o for c, o in zip(cell, corner))) for corner in CORNERS]))
        for axis, high in itertools.product(range(3), (0, 1)):
            names.append((2, f"{name}_{'xyz'[axis]}{high}"))
            one, two = (d for d in range(3) if d != axis)
            for a, b in itertools.product(range(number[one]), range(number[two])):
                corners = []
                for u, v in SQUARE:
                    index = [high * number[axis]] * 3
                    index[one], index[two] = a + u, b + v
                    corners.append(node(*index))
                elements.append((3, len(names), corners))
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(names))
        file.writelines('%d %d "%s"\n' % (dim, tag + 1, name) for tag, (dim, name) in enumerate(names))
        file.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(points))
        file.writelines("%d %.17g %.17g %.17g\n" % (n + 1, *x) for n, x in enumerate(points))
        file.write("$EndNodes\n$Elements\n%d\n" % len(elements))
        file.writelines("%d %d 2 %d %d %s\n" % (i + 1, kind, tag, tag, " ".join(map(str, nodes))) for i, (kind, tag, nodes) in enumerate(elements))
        file.write("$EndElements\n")


RUBBER = {"law": "neo_hookean", "E": 1, "nu": 0.3}


def scene(file, bodies, boundary, contact, **keys):
    """bodies {name: {material parameters}}; contact {pair: {...}}."""
    content = {"mesh": {"file": str(file)}, "model": "3d", "body": {name: {"material": name} for name in bodies}, "material": bodies, "boundary": boundary,
               "contact": contact, "load": {"step": 1}, **keys}
    return "\n".join(f"{key}: {yaml(value)}" for key, value in content.items()) + "\n"
