"""What a run that fails, or finds another state than was meant, says of the reason: critical loads, neutral equilibria, sides that came apart, where it was out of balance."""
import pathlib
import re

SCENES = pathlib.Path(__file__).resolve().parent / "scenes"

TABLE = """
mesh: {file: %s, order: 2}
model: plane_strain
order: 2
body: {plate: {material: i, load: {y: -0.2*t, moment_z: 0}, moment_about: g}, l: {material: m}, r: {material: m}}
material: {m: {law: neo_hookean, E: 10, nu: 0.3}, i: {law: rigid}}
boundary: {lfoot: {fix: xy}, rfoot: {fix: xy}}
contact: {a: {nonmortar: ltop, mortar: pf}, b: {nonmortar: rtop, mortar: pf}}
point: {g: {x: 0.4, y: 0.4}}
load: {step: 0.25, step_min: 0.2}
output: {fields: false}
"""


def test_critical_load(run):
    """A rigid plate on two columns, its load aside of the middle: at three quarters of the load the tangent is stable, and beyond it is not. The place is that of a top."""
    result = run("table.yml", "-path_viscous", "off", text=TABLE % (SCENES / "table.geo"))
    print(result.stdout)
    assert result.returncode == 2 and "the load may be critical" in result.summary["reason"]
    assert re.search(r"just beyond the last equilibrium, which is stable, .* the softest mode of that equilibrium moves most at \(1\S*, 0\.1\S*, 0\) of body r, and has lost", result.stdout)
    assert re.search(r"forces were farthest out of balance at \(\S+, 0\.\S*, 0\)( of body [lr])?, on a side of pair [ab]", result.stdout)


CORD = """
mesh: {file: %s, order: 2, parameter: {s: 2}}
model: plane_strain
order: 2
body: {cord: {material: m}, groove: {material: i}, lid: {material: i, motion: {y: "-0.2*min(t, 1)"}}}
material: {m: {law: mooney_rivlin, c1: 0.8, c2: 0.2, kappa: 200}, i: {law: rigid}}
boundary: {sl: {pressure: "0.8*max(t-1,0)"}}
contact: {g: {nonmortar: [sr, sl], mortar: gf}, u: {nonmortar: [sr, sl], mortar: uf}}
load: {end: 2, step: 0.1, step_min: 0.1}
output: {fields: false}
"""


def test_neutral_is_not_unstable(run):
    """A cord pressed between two flat faces without friction slides and rolls freely: the sign of the determinant is one of round-off in all ten steps, nor is it called
    unstable when pressure drives it to the right wall. Where a step is not found, that a motion meets no resistance is said."""
    text = CORD % (SCENES / "cord.geo")
    result, stopped = run("cord.yml", "-path_viscous", "off", text=text), run("cord.yml", "-path_viscous", "off", "-snes_max_it", 4, text=text)
    assert result.summary["t"] > 1 and result.summary["unstable_equilibria"] in (0, None) and "is unstable" not in result.stdout and "are unstable" not in result.stdout, result
    assert stopped.returncode == 2 and re.search(r"the last equilibrium is neutral, a motion that moves most at .* of body cord meets no resistance", stopped.stdout), stopped


KEY = """
mesh: {file: %s, order: 2}
model: plane_strain
body: {key: {material: k}, u: {material: m}}
material: {m: {law: neo_hookean, E: 10, nu: 0.3}, k: {law: neo_hookean, E: 100, nu: 0.3}}
boundary: {bot: {fix: xy}, x0: {fix: x}}
contact: {c: {nonmortar: s, mortar: k}}
output: {fields: false}
"""


def test_sides_that_came_apart(run):
    """A key wider than its slot leaves it on the way to the first state: its sides have touched, if in no state found, and contact is not called needless. With its top held it stays."""
    text = KEY % (SCENES / "keyslot.geo")
    out, stays = run("key.yml", text=text), run("key.yml", text=text.replace("bot:", "top: {fix: y}, bot:"))
    assert out.returncode == 0 and "the sides of pair c were in contact on the way to a state found, but are in none of these" in out.stdout, out
    assert "have not touched" not in out.stdout
    assert stays.returncode == 0 and stays.summary["energy"] > 1e-4 and "came apart" not in stays.stdout, stays
