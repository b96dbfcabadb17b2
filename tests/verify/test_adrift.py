"""A body that contact holds and then no longer does is told (src/diagnose/adrift.c): a puck between a block and a plate that goes away again."""
import json

import pytest

from boxmesh import linspace, write

RUBBER = {"law": "neo_hookean", "E": 1, "nu": 0.3}


def scene(path, dim):
    """A block, a puck and a plate, each of height 1, one on the other; the plate presses and is lifted off. The puck may move up and down alone: between two faces that give way less in
    their middle it would slip out."""
    up, names = "xyz"[dim - 1], ("block", "puck", "plate")
    blocks = [lambda *x, k=k: (*((c + 0.45 * (k == 1)) / (1 + (k == 1)) for c in x[:-1]), x[-1] + k) for k in range(3)]

    def side(name, centre, block):
        if name[0] != up:
            return {"x0": "left", "y0": "front"}.get(name) if block == 1 else None
        return {"0": "bottom_", "1": "top_"}[name[1]] + names[block]

    write(path / "blocks.msh", [linspace(0, 1, 2)] * dim, blocks, side=side, body=lambda centre, block: names[block])
    return json.dumps({"mesh": {"file": "blocks.msh"}, "model": "plane_strain" if dim == 2 else "3d", "material": {"rubber": RUBBER},
                       "body": {name: {"material": "rubber"} for name in names}, "load": {"step": 0.5, "end": 2},
                       "boundary": {"bottom_block": {"fix": "xyz"[:dim]}, "left": {"fix": "x"}, **({"front": {"fix": "y"}} if dim == 3 else {}), "top_plate": {"displacement": dict.fromkeys("xyz"[:dim], 0) | {up: "0.2*max(t-1,0)-0.1*min(t,1)"}}},
                       "contact": {"low": {"nonmortar": "bottom_puck", "mortar": "top_block"}, "high": {"nonmortar": "top_puck", "mortar": "bottom_plate"}}})


@pytest.mark.parametrize("dim, ranks", [(2, 1), (2, 2), (3, 1), pytest.param(3, 2, marks=pytest.mark.slow)])
def test_let_go(run, tmp_path, dim, ranks):
    r = run("s.yml", "-output_fields", "false", text=scene(tmp_path, dim), ranks=ranks)
    told = [w for w in r.summary["warnings"] if "any more, as contact did" in w]
    assert r.returncode == 0 and len(told) == 1 and "body puck" in told[0] and f"along {'xyz'[dim - 1]} any more" in told[0], r


def test_held_to_the_end(run, tmp_path):
    """Not where contact bears it at every step."""
    r = run("s.yml", "-output_fields", "false", "-load_end", 1, text=scene(tmp_path, 2))
    assert r.returncode == 0 and not any("any more, as contact did" in w for w in r.summary["warnings"]), r
