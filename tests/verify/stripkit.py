"""Strip with a central hole, perfectly plastic, pulled to its limit load (O-34), in plane strain or as a thin sheet."""
import json
import math

from boxmesh import linspace, write


def strip(run, tmp_path, n, order, formulation, num_steps=12, thickness=0):
    """Quarter of a strip of half width 1 and half length 2 with a hole of radius 0.2, perfectly plastic, pulled by a tiny displacement: load against the exact
    limit, step by step: (2/sqrt 3) yield (1 - 0.2) in plane strain (thickness 0), yield (1 - 0.2) thickness for a sheet in plane stress, half of which is one
    layer of cells in space with a free face."""
    def part(outer, first):
        def to(a, b, *z):
            angle = math.pi / 4 * (first + b)
            return (*((1 - a) * c + a * o for c, o in zip((0.2 * math.cos(angle), 0.2 * math.sin(angle)), outer(b))), *z)
        return to

    def side(name, centre, block):
        names = [{"x0": "hole", "x1": "edge", "y0": "middle"}, {"x0": "hole", "y1": "axis"}, {"x1": "end", "y0": "edge", "y1": "axis"}]
        return {"z0": "plane", "z1": "face", **names[block]}.get(name)

    half = thickness / 2
    write(tmp_path / "strip.msh", [linspace(0, 1, n), linspace(0, 1, n)] + ([[0, half]] if half else []),
          [part(lambda b: (1, b), 0), part(lambda b: (1 - b, 1), 1), lambda a, b, *z: (1 - b, 1 + a, *z)], side=side)
    material = {"law": "j2", "E": 1e5, "nu": 0.3, "yield": 1, "formulation": formulation}
    scene = {"mesh": {"file": "strip.msh"}, "model": "3d" if half else "plane_strain", "order": order, "body": {"body": {"material": "m"}}, "material": {"m": material},
             "boundary": {"middle": {"fix": "y"}, "axis": {"fix": "x"}, "end": {"displacement": {"y": "1e-4*t"}}, **({"plane": {"fix": "z"}} if half else {})},
             "load": {"step": 1 / num_steps, "step_max": 1 / num_steps}, "output": {"fields": False}}
    result = run(f"strip{n}{order}{formulation}.yml", text=json.dumps(scene))
    assert result.returncode == 0, result
    limit = half * 0.8 if half else 2 / math.sqrt(3) * 0.8
    return [row["reaction.end.y"] / limit for row in result.history]
