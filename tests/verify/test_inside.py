"""Bodies inside each other while their pair bears nothing are no solution (src/diagnose/inside.c): a small block that is moved deep into a large one in one step, where contact is no
longer seen."""
import json

import pytest

from boxmesh import linspace, write

RUBBER = {"law": "neo_hookean", "E": 1, "nu": 0.3}
GIVE_UP = ("-load_step_min", 0.6, "-path_viscous", "off", "-path_through", "off", "-output_fields", "false")


def scene(path, dim, heights, ways, law=RUBBER, across=0):
    """A large block of height 1, and small ones, 0.2 high, whose bottoms begin at these heights and move down this far, and across."""
    up, num, rigid = "xyz"[dim - 1], len(heights), law["law"] == "rigid"
    names = ["large", *(f"small{k}" for k in range(num))]

    def small(k):
        return lambda *x: tuple(0.2 + (0.5 * k + 0.3 * c) / num for c in x[:-1]) + (heights[k] + 0.2 * x[-1],)

    def side(name, centre, block):
        return {f"{up}0": "bottom_", f"{up}1": "top_"}[name] + names[block] if name[0] == up else None

    write(path / "blocks.msh", [linspace(0, 1, 3)] * dim, [lambda *x: x, *map(small, range(num))], side=side, body=lambda centre, block: names[block])
    motion = [{axis: -way if axis == up else across * (axis == "x") for axis in "xyz"[:dim]} for way in ways]
    return json.dumps({"mesh": {"file": "blocks.msh"}, "model": "plane_strain" if dim == 2 else "3d", "material": {"rubber": RUBBER, "other": law}, "load": {"step": 1},
                       "body": {"large": {"material": "rubber"}} | {name: {"material": "other"} | ({"motion": u} if rigid else {}) for name, u in zip(names[1:], motion)},
                       "boundary": {"bottom_large": {"fix": "xyz"[:dim]}} | {f"top_{name}": {"displacement": u} for name, u in zip(names[1:], motion) if not rigid},
                       "contact": {name: {"nonmortar": "top_large", "mortar": f"bottom_{name}"} for name in names[1:]}})


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("law", [RUBBER, {"law": "rigid"}], ids=["rubber", "rigid"])
@pytest.mark.parametrize("dim", [2, 3])
def test_deep_inside(run, tmp_path, dim, law, ranks):
    """Not found where half of the step is too long; without the question no force, with exit 0."""
    text = scene(tmp_path, dim, [1.001], [0.7], law)
    told, without = (run("s.yml", *GIVE_UP, *words, text=text, ranks=ranks) for words in ((), ("-path_inside", "off")))
    assert told.returncode == 2 and told.summary["refused_solutions"] == 1, told
    assert without.returncode == 0 and not any(without.summary["contact"]["small0"]["force"]), without


@pytest.mark.parametrize("dim", [2, 3])
def test_as_the_mesh_has_them(run, tmp_path, dim):
    """Bodies that are so deep inside each other in the mesh that no contact is seen stay so; a pair of that kind does not hide another one that comes to be so."""
    still = run("s.yml", *GIVE_UP, text=scene(tmp_path, dim, [0.3, 1.1], [0, 0.05]))
    assert still.returncode == 0 and still.summary["refused_solutions"] == 0, still
    other = run("s.yml", *GIVE_UP, text=scene(tmp_path, dim, [0.3, 1.001], [0, 0.7]))
    assert other.returncode == 2 and other.summary["refused_solutions"] == 1, other
