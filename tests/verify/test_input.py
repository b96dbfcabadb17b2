"""Wrong input: exit status 1, one sentence that names key, value and what is allowed, nothing solved and no output directory made."""
import pathlib
import re

import pytest



def square(first, y):
    """Points, curves, surface first .. first+3 of the square [0,1] x [y,y+1]; curves: bottom, right, top, left."""
    p = range(first, first + 4)
    return (f"Point({p[0]}) = {{0, {y}, 0}}; Point({p[1]}) = {{1, {y}, 0}}; Point({p[2]}) = {{1, {y + 1}, 0}}; Point({p[3]}) = {{0, {y + 1}, 0}};\n"
            f"Line({p[0]}) = {{{p[0]}, {p[1]}}}; Line({p[1]}) = {{{p[1]}, {p[2]}}}; Line({p[2]}) = {{{p[2]}, {p[3]}}}; Line({p[3]}) = {{{p[3]}, {p[0]}}};\n"
            f"Curve Loop({first}) = {{{p[0]}:{p[3]}}}; Plane Surface({first}) = {{{first}}};\n"
            f"Transfinite Curve {{{p[0]}:{p[3]}}} = n + 1;\nTransfinite Surface {{{first}}};\nRecombine Surface {{{first}}};\n")


GEO = "DefineConstant[ n = 2 ];\n" + square(1, 0) + square(11, 1) + """Physical Surface("lower", 1) = {1};
Physical Surface("upper", 2) = {11};
Physical Curve("bottom", 3) = {1};
Physical Curve("lower_top", 4) = {3};
Physical Curve("lower_side", 5) = {2};
Physical Curve("upper_bottom", 6) = {11};
Physical Curve("top", 7) = {13};
"""

SCENE = """title: two squares
mesh: {file: squares.geo, order: 1}
model: plane_strain
kinematics: finite
order: 1
body:
  lower: {material: rubber}
  upper: {material: rubber}
material:
  rubber: {law: neo_hookean, E: 1, nu: 0.3}
boundary:
  bottom: {fix: xy}
  top: {displacement: {x: 0, y: -0.05}}
contact:
  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}
load: {end: 1, step: 0.5}
"""


RUBBER = "{law: neo_hookean, E: 1, nu: 0.3}"
HGO = "{law: hgo, c: 1, kappa: 100, k1: 1, k2: 1, %s}"
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1"}  # Open MPI: one process needs no daemon, and so no PATH


@pytest.fixture
def check(run, tmp_path):
    """check(edits, *options, geo=GEO): run SCENE with its texts replaced by -check."""
    (tmp_path / "tmp").mkdir()

    def start(edits=(), *options, geo=GEO, ranks=1, env=None):
        text = SCENE
        for old, new in edits:
            assert old in text
            text = text.replace(old, new)
        if geo is not None:
            (tmp_path / "squares.geo").write_text(geo)
        result = run("squares.yml", "-check", *options, text=text, ranks=ranks, env={"TMPDIR": str(tmp_path / "tmp"), **ALONE, **(env or {})})
        assert not list((tmp_path / "tmp").glob("mortise-*")), "the temporary mesh was left behind"
        return result

    return start


def refused(result, *words):
    assert result.returncode == 1, result
    lines = [line for line in result.stderr.splitlines() if line.startswith("mortise: ")]
    assert len(lines) == 1, result
    assert "PETSC ERROR" not in result.stderr, result
    for word in words:
        assert re.search(word, lines[0]), f"{word!r} is not in: {lines[0]}"
    assert not result.directory.exists()


def test_good(check):
    result = check()
    assert result.returncode == 0, result
    assert not result.directory.exists()
    for word in ("two squares", "rubber", "upper_bottom", "plane strain"):
        assert word in result.stdout
    assert re.search(r"\n  mesh \S+: \d+ cells, x = 0 \.\. \S+, y = \S+ \.\. \S+\n", result.stdout), result.stdout


def test_good_on_two_ranks(check):
    assert check(ranks=2).returncode == 0


@pytest.mark.parametrize("edit,words", [
    # keys
    (("order: 1\nbody", "ordr: 1\nbody"), [r"squares.yml:5: ordr is not a key", "nearest one is order"]),
    (("nu: 0.3", "nu: 0.3, laww: x"), ["material.rubber.laww", "material.rubber.law"]),
    (("friction: 0", "frction: 0"), ["contact.pair.frction", "contact.pair.friction"]),
    (("load:", "tolerance: 0.1\nload:"), ["tolerance", "adapt.tolerance"]),
    (("order: 1\nbody", "order: 1\norder: 2\nbody"), ["order is given twice, in lines 5 and 6"]),
    (("E: 1,", "E: 1, E: 2,"), ["material.rubber.E is given twice"]),
    (("{law: neo_hookean, E", "{E"), ["material.rubber.law must be given"]),
    (("model: plane_strain\n", ""), ["model must be given", "plane_strain"]),
    (("mesh: {file: squares.geo, order: 1}\n", ""), ["mesh.file must be given"]),
    # shapes and types
    (("E: 1,", "E: {a: 1},"), ["material.rubber.E must be a number", "map"]),
    (("E: 1,", "E: one,"), ["material.rubber.E is 'one'", "number"]),
    (("E: 1,", "E: 1.5.2,"), ["material.rubber.E is '1.5.2'", "number"]),
    (("E: 1,", "E: ,"), ["material.rubber.E must be a number", "empty"]),
    (("E: 1,", "E: nan,"), ["material.rubber.E is 'nan'"]),
    (("  rubber: {law: neo_hookean, E: 1, nu: 0.3}", "  rubber: 5"), ["material.rubber must be a map of keys"]),
    (("order: 1\nbody", "order: 1.5\nbody"), ["order is '1.5'", "integer"]),
    (("order: 1\nbody", "order: [1, 2]\nbody"), ["order must be an integer", "list"]),
    (("step: 0.5", "step: 0.5, max_steps: many"), ["load.max_steps is 'many'", "integer"]),
    (("step: 0.5}", "step: 0.5}\noutput: {fields: perhaps}"), ["output.fields is 'perhaps'", "true, false"]),
    (("fix: xy", "fix: xw"), ["boundary.bottom.fix is 'xw'", "normal"]),
    (("fix: xy", "fix: xyz"), ["boundary.bottom.fix is 'xyz'", "no z"]),
    (("y: -0.05", "z: -0.05"), ["boundary.top.displacement.z", "no z"]),
    (("y: -0.05", "y: '-0.05*s'"), ["boundary.top.displacement.y", "-0.05\\*s", "X, Y, Z, t"]),
    (("y: -0.05}", "y: -0.05}, amplitude: [0, 0, 1]"), ["boundary.top.amplitude", "pairs"]),
    (("y: -0.05}", "y: -0.05}, amplitude: [0, 0, 0, 1]"), ["boundary.top.amplitude", "rise"]),
    (("y: -0.05}", "y: -0.05}, amplitude: 3"), ["boundary.top.amplitude must be a list"]),
    (("fix: xy", "fix: xy, displacement: {x: 1}"), ["boundary.bottom", "x is both fixed and displaced"]),
    (("bottom: {fix: xy}", "bottom: {}"), ["boundary.bottom prescribes nothing"]),
    # ranges
    (("order: 1\nbody", "order: 9\nbody"), ["order is 9", r"\[1,8\]"]),
    (("order: 1\nbody", "order: 0\nbody"), ["order is 0", r"\[1,8\]"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: 99}"), ["body.upper.order is 99", r"\[1,8\]"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: {x: 2, y: 9}}"), [r"body.upper.order.y is 9", r"\[1,8\]"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: {x: 2, y: 0}}"), [r"body.upper.order.y is 0", r"\[1,8\]"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: {x: 2, w: 1}}"), [r"body.upper.order.w is not a key", r"body.upper.order.x"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: {x: 2, z: 1}}"), [r"body.upper.order.z", "no z"]),
    (("upper: {material: rubber}", "upper: {material: rubber, order: [2, 1]}"), [r"body.upper.order must be an integer", "list"]),
    (("nu: 0.3", "nu: 0.5, formulation: displacement"), ["material.rubber.formulation", "nu: 0.5"]),
    (("nu: 0.3", "nu: 0.7"), ["material.rubber.nu", "0.7"]),
    (("E: 1,", "E: -1,"), ["material.rubber.E", "-1"]),
    (("nu: 0.3", "mu: 0.3"), ["material.rubber"]),
    (("step: 0.5", "step: 5"), ["load.step is 5", "load.end"]),
    (("step: 0.5", "step: -1"), ["load.step is -1", "inf"]),
    (("load:", "adapt: {fraction: 2}\nload:"), ["adapt.fraction is 2", r"\(0,1\]"]),
    (("load:", "adapt: {alike: 1}\nload:"), ["adapt.alike is 1", r"\[0,1\)"]),
    (("load:", "adapt: {share: 1.5}\nload:"), ["adapt.share is 1.5", r"\[0,1\]"]),
    (("load:", "adapt: {aspect: 0.5}\nload:"), ["adapt.aspect is 0.5", r"\[1,1e6\]"]),
    (("load:", "adapt: {strategy: r}\nload:"), ["adapt.strategy is .r.", r"h\|p\|hp|h, p, hp"]),
    (("load:", "adapt: {tolerance: 0.1, share: 0.2}\nload:"), ["adapt.share acts with adapt.anisotropic: true alone"]),
    (("load:", "adapt: {tolerance: 0.1, aspect: 3, anisotropic: false}\nload:"), ["adapt.aspect acts with adapt.anisotropic: true alone"]),
    (("load:", "adapt: {tolerance: 0.1, max_order: 3}\nload:"), ["adapt.max_order acts with adapt.strategy: p or hp alone"]),
    (("load:", "adapt: {tolerance: 0.1, max_order: 3, strategy: p, anisotropic: true, share: 0.2, aspect: 3}\nload:"), None),
    (("fix: xy", "fix: xy, amplitude: [0,0, 1,1]"), ["boundary.bottom.amplitude has nothing to multiply; it needs one of displacement, rotation"]),
    (("upper: {", "upper: {amplitude: [0,0, 1,1], "), ["body.upper.amplitude has nothing to multiply; it needs one of motion, load, force"]),
    (("load:", "adapt: {max_order: 9}\nload:"), ["adapt.max_order is 9", r"\[1,8\]"]),
    (("order: 1\nbody:", "order: 3\nadapt: {strategy: hp, max_order: 2}\nbody:"), ["adapt.max_order is 2", "has order 3", "allowed: 3 to 8"]),
    (("load:", "adapt: {anisotropic: maybe}\nload:"), ["adapt.anisotropic is .maybe.", "true, false"]),
    (("model: plane_strain", "model: plane_stress"), ["model is 'plane_stress'", "plane_strain"]),
    (("law: neo_hookean", "law: neohookean"), ["material.rubber.law is 'neohookean'", "neo_hookean"]),
    (("kinematics: finite", "kinematics: small"), ["small", "law: linear"]),
    (("law: neo_hookean", "law: linear"), ["law linear", "small"]),
    (("friction: 0", "subdivide: -1"), [r"contact.pair.subdivide is '-1'; allowed: 0\|1\|.*8\|auto$"]),
    (("friction: 0", "subdivide: 9"), [r"contact.pair.subdivide is '9'; allowed: 0\|1\|.*8\|auto$"]),
    (("friction: 0", "subdivide: 1.5"), ["contact.pair.subdivide is '1.5'; allowed: 0"]),
    (("friction: 0", "subdivide: automatic"), ["contact.pair.subdivide is 'automatic'; allowed: 0"]),
    (("friction: 0", "subdivide: [1, 2]"), ["contact.pair.subdivide must be a word", "list"]),
    (("friction: 0", "order: full, subdivide: auto"), ["contact.pair.subdivide is auto, but faces of full order need no finer layer"]),
    (("friction: 0", "subdivide: auto"), None),
    # not built yet
    (("friction: 0", "friction: 0.3, law: penalty, penalty: 1"), ["contact.pair.friction is 0.3", "law: penalty has no friction"]),
    (("friction: 0", "projection: facet"), ["contact.pair.projection is not a key"]),
    (("friction: 0", "law: penalty"), ["contact.pair.penalty must be given", "stiffness"]),
    (("friction: 0", "penalty: 5"), ["contact.pair.penalty is the stiffness of law: penalty", "frictionless"]),
    (("friction: 0", "order: full, node_to_segment: true"), ["contact.pair.order", "do not go together"]),
    # what drives
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {pressure: 1, volume: t}"), ["boundary.lower_side.volume", "take pressure away"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {advance: t, volume: t}"), ["boundary.lower_side", "both volume and advance"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {volume: cos(t)}"), ["boundary.lower_side.volume is 1 at t = 0", "start at 0"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {advance: X*t}"), ["boundary.lower_side.advance", "t alone"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {volume: s}"), ["boundary.lower_side.volume", "X, Y, Z, t"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy, volume: t}"), ["boundary.bottom.volume", "all displacements .* are prescribed"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {volume: t}\n  lower_top: {advance: t}"), None),  # two of them: good
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_top: {displacement: {y: 0}, volume: t}"), ["boundary.lower_top.volume: .* holds its surface along the normal"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_top: {fix: normal, advance: t}"), ["boundary.lower_top.advance: .* holds its surface along the normal"]),
    (("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_top: {fix: x, advance: t}"), None),
    (("step: 0.5", "step: 0.5, control: riks"), ["load.control is 'riks'", r"time\|arc_length"]),
    (("step: 0.5", "step: 0.5, stop_displacement: -1"), ["load.stop_displacement is -1", "inf"]),
    (("step: 0.5", "step: 0.5, control: arc_length"), ["boundary.top.displacement", "arc_length", "factor of the loads"]),
    # plasticity
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3}"), ["material.rubber.yield: missing"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 0}"), ["material.rubber.yield: 0 is not a finite number above 0"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: -2}"), ["material.rubber.hardening", "allowed: less than 3 mu"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 1, saturation: 1}"), ["material.rubber.saturation_rate: missing"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 1, saturation: 1, saturation_rate: -3}"),
     ["material.rubber.saturation_rate: -3 is not a finite number above 0"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 1, saturation: -1, saturation_rate: 1}"),
     ["material.rubber.saturation: -1 takes all of the yield stress"]),
    (("{law: neo_hookean, E: 1, nu: 0.3}", "{law: j2, E: 1, nu: 0.3, yield: 1, volumetric: log}"), ["material.rubber.volumetric: j2 knows"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: -1}"), ["material.rubber.yield: -1 is not a finite number above 0"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: inf}"), ["material.rubber.yield: inf is not a finite number above 0"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: inf}"), ["material.rubber.hardening: inf is not a finite number"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, saturation: 1, saturation_rate: 0}"), ["material.rubber.saturation_rate: 0 is not a finite number above 0"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: nan}"), ["material.rubber.hardening is 'nan'"]),
    ((RUBBER, "{law: j2, E: -1, nu: 0.3, yield: 1}"), ["material.rubber.E: -1 is not a finite number above 0"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.6, yield: 1}"), ["material.rubber.nu: 0.6 is not between -1 and 0.5"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardning: 1}"), ["material.rubber.hardning is not a key of a scene; the nearest one is material.rubber.hardening"]),
    ((RUBBER, "{law: j2, mu: 1, kappa: inf, yield: 1, formulation: displacement}"), ["material.rubber.formulation: displacements alone cannot keep the volume"]),
    # fibres
    ((RUBBER, HGO % "fiber: {a: {angle: 29}}, frame: {point: {x: 3}}"), None),
    ((RUBBER, HGO % "fiber: {a: {angle: 29}}, frame: {axis: x}"), ["material.rubber.frame.axis is x", "allowed in this model: z"]),
    ((RUBBER, HGO % "fiber: {a: {direction: {x: 1}}}, frame: {axis: z}"), ["material.rubber.frame", "no fibre of this material has an angle"]),
    ((RUBBER, HGO % "fiber: {a: {}}"), ["material.rubber.fiber.a needs an angle, or a direction"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 29, direction: {x: 1}}}"), ["material.rubber.fiber.a has an angle and a direction"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 29, field: f}}"), ["material.rubber.fiber.a has a field and an angle"]),
    ((RUBBER, HGO % "fiber: {a: {direction: {x: 1}, field: f}}"), ["material.rubber.fiber.a has a field and a direction"]),
    ((RUBBER, HGO % "fiber: {a: {field: ''}}"), ["material.rubber.fiber.a.field is ''; it must be a text"]),
    ((RUBBER, HGO % "fiber: {a: {field: f}}, frame: {axis: z}"), ["material.rubber.frame", "no fibre of this material has an angle"]),
    ((RUBBER, HGO % "fiber: {a: {field: f}}"), ["material.rubber.fiber.a.field: the mesh has no field 'f'", "none"]),
    ((RUBBER, HGO % "fiber: {a: {direction: {x: 0}}}"), ["material.rubber.fiber.a.direction is zero"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 29, k1: -2}}"), ["material.rubber.fiber.a.k1 is -2", "inf"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 29, k2: 0}}"), ["material.rubber.fiber.a.k2 is 0", "inf"]),
    ((RUBBER, HGO % "fiber: {a: {direction: {x: .inf}}}"), ["material.rubber.fiber.a.direction.x", "number"]),
    ((RUBBER, HGO % "fiber: {a: {direction: {x: nan}}}"), ["material.rubber.fiber.a.direction.x is 'nan'"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 29, compression: maybe}}"), ["material.rubber.fiber.a.compression is 'maybe'", "true, false"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, swift_strain: 0.01}"), ["material.rubber.swift_exponent: missing", "go together"]),
    ((RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, swift_strain: 0.01, swift_exponent: 1.5}"), ["material.rubber.swift_exponent: 1.5 is not between 0 and 1"]),
    ((RUBBER, "{law: ogden, mu1: 1, kappa: 10}"), ["material.rubber.alpha1: missing; mu1 and alpha1 go together"]),
    ((RUBBER, "{law: ogden, mu1: 1, alpha1: 2}"), ["material.rubber.kappa: missing; ogden needs"]),
    ((RUBBER, "{law: ogden, mu1: 1, alpha1: 0, kappa: 10}"), ["material.rubber.alpha1: an exponent must not be 0"]),
    ((RUBBER, "{law: ogden, mu1: 1, alpha1: -2, kappa: 10}"), ["material.rubber.mu1: shear modulus", "= -1 must be positive"]),
    ((RUBBER, "{law: ogden, mu1: 1, alpha1: 2, kappa: 10, volumetric: log}"), ["material.rubber.volumetric: ogden knows quadratic and simo, not log"]),
    ((RUBBER, "{law: yeoh, c1: 0, kappa: 10}"), ["material.rubber.c1: 0 is not a finite number above 0"]),
    ((RUBBER, "{law: yeoh, c1: 1}"), ["material.rubber.kappa: missing; yeoh needs c1 and kappa"]),
    ((RUBBER, "{law: arruda_boyce, mu: 1, kappa: 10}"), ["material.rubber.locking_stretch: missing; arruda_boyce needs"]),
    ((RUBBER, "{law: arruda_boyce, mu: 1, locking_stretch: 0.9, kappa: 10}"), ["material.rubber.locking_stretch: 0.9 is not a finite number above 1"]),
    ((RUBBER, "{law: hgo, c: -1, kappa: 100, k1: 1, k2: 1, fiber: {a: {angle: 29}}}"), ["material.rubber.c: -1 is not a finite number above 0"]),
    ((RUBBER, "{law: hgo, c: 1, kappa: 100, k1: 0, k2: 1, fiber: {a: {angle: 29}}}"), ["material.rubber.k1: 0 is not a finite number above 0"]),
    ((RUBBER, HGO % "fiber: {a: {angel: 29}}"), ["material.rubber.fiber.a.angel", "material.rubber.fiber.a.angle"]),
    ((RUBBER, HGO % "fiber: {a: {angle: 1}, b: {angle: 2}, c: {angle: 3}, d: {angle: 4}, e: {angle: 5}}"), ["5 families", "at most 4"]),
    ((RUBBER, HGO % "volumetric: simo"), ["material.rubber.fiber: missing"]),
    (("nu: 0.3}", "nu: 0.3, fiber: {a: {angle: 29}}}"), ["material.rubber.fiber: law neo_hookean has no fibres"]),
    # the file
    (("body:\n", "body: [\n"), [r"squares.yml:\d+:\d+: not valid YAML"]),
    (("body:\n", "body:\n\t"), [r"squares.yml:\d+:\d+: not valid YAML", "not by tabs"]),
    (("title: two", "title: \"two"), [r"squares.yml:\d+:\d+: not valid YAML"]),
    ((SCENE, ""), ["empty"]),
    ((SCENE, "# nothing\n"), ["empty"]),
    ((SCENE, "- a\n- b\n"), ["map of keys"]),
    ((SCENE, SCENE + "---\n" + SCENE), ["second document"]),
    # names
    (("upper: {material: rubber}", "upper: {material: ruber}"), ["body.upper.material is 'ruber'", "rubber"]),
    (("  upper: {material: rubber}\n", ""), ["body 'upper'", "no material"]),
    (("  upper: {material: rubber}\n", "  upper: {}\n"), ["body.upper.material must be given"]),
    (("  upper:", "  uper:"), ["'uper'", "lower, upper|upper, lower"]),
    (("boundary:\n", "boundary:\n  tip: {fix: x}\n"), ["boundary.tip", "no boundary group 'tip'", "upper_bottom"]),
    (("mortar: lower_top", "mortar: lower_tip"), ["contact.pair.mortar", "'lower_tip'", "lower_top"]),
    (("boundary:\n", "boundary:\n  upper: {fix: x}\n"), ["'upper' is a body"]),
    (("material:\n", "material:\n  steel: {law: neo_hookean, E: 2, nu: 0.3}\n"), ["material.steel is used by no body"]),
    # pairs and supports
    (("mortar: lower_top", "mortar: upper_bottom"), ["both sides are 'upper_bottom'", "surface: upper_bottom"]),
    (("nonmortar: upper_bottom", "nonmortar: lower_side"), [r"'lower_side' and 'lower_top' share cell \d at \(0.75, 0.75, 0\);"]),
    (("contact:\n  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n", ""), None),  # both held: good
    # mesh
    (("squares.geo", "circles.geo"), ["no file .*circles.geo"]),
    (("squares.geo", "squares.stl"), [r"mesh.file is 'squares.stl'", r"\.geo or \.msh"]),
    (("order: 1}", "order: 1, parameter: {k: 3}}"), ["mesh.parameter.k", "no such constant"]),
    (("order: 1}", "order: 1, parameter: {n: x}}"), ["mesh.parameter.n is 'x'", "number"]),
    (("order: 1}", "order: 77}"), ["mesh.order is 77"]),
])
def test_refused(check, edit, words):
    result = check([edit])
    if words is None:
        assert result.returncode == 0, result
    else:
        refused(result, *words)


@pytest.mark.parametrize("held,told", [("fix: normal", True), ("displacement: {y: 0}", True), ("fix: x", False)])
def test_a_pressure_that_moves_nothing(check, held, told):
    """Its reaction may be wanted."""
    result = check([("bottom: {fix: xy}", f"bottom: {{fix: xy}}\n  lower_top: {{{held}, pressure: 1}}")])
    assert result.returncode == 0 and ("boundary.lower_top.pressure moves nothing" in result.stdout) == told, result


def test_keys_without_what_they_act_with(check):
    """Left out on the command line for one run; told where the scene has both."""
    scene = [("load:", "adapt: {tolerance: 0.1, max_order: 3, strategy: p, anisotropic: true, aspect: 3}\noutput: {quantities: energy_density, divide: 2}\nload:")]
    result = check(scene, "-adapt_strategy", "h", "-adapt_anisotropic", "false", "-output_fields", "false")
    assert result.returncode == 0 and "does nothing" not in result.stdout, result
    result = check([("load:", "output: {fields: false, divide: 2}\npoint: {p: {x: 1}, q: {x: 1}}\nload:"), ("fix: xy", "fix: xy, moment_about: q")])
    assert result.returncode == 0 and "output.divide does nothing, for output.fields is false" in result.stdout, result
    assert "point.p does nothing, for no moment_about names it" in result.stdout and "point.q does" not in result.stdout, result


def test_many_long_names(check):
    """Forty groups of sixty characters are more than the message has room for: it ends among them."""
    names = [f"group_{i}_{'x' * 60}"[:60] for i in range(40)]
    geo = GEO + "".join(f'Physical Curve("{name}", {20 + i}) = {{{(2, 4, 12, 14)[i % 4]}}};\n' for i, name in enumerate(names))
    result = check([("boundary:\n", "boundary:\n  tip: {fix: x}\n")], geo=geo)
    refused(result, "no boundary group 'tip'", names[0])
    assert names[-1] not in result.stderr, result


NO_PAIR = ("contact:\n  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n", "")


def test_volume_in_small_kinematics(check):
    edits = [("kinematics: finite", "kinematics: small"), ("law: neo_hookean", "law: linear"), ("bottom: {fix: xy}", "bottom: {fix: xy}\n  lower_side: {volume: t}")]
    refused(check(edits), "boundary.lower_side.volume", "kinematics: finite")


def test_volume_of_a_rigid_body(check):
    edits = [("upper: {material: rubber}", "upper: {material: steel}"), ("material:\n", "material:\n  steel: {law: rigid}\n"),
             ("top: {displacement: {x: 0, y: -0.05}}", "top: {volume: t}")]
    refused(check(edits), "boundary.top.volume", "rigid body 'upper'")


def test_volume_along_a_path(check):
    edits = [NO_PAIR, ("top: {displacement: {x: 0, y: -0.05}}", "top: {fix: xy}\n  lower_side: {volume: t}"), ("step: 0.5", "step: 0.5, control: arc_length")]
    refused(check(edits), "boundary.lower_side.volume", "arc_length", "allowed here: time")


@pytest.mark.parametrize("option", [("-solve_linear", "iterative"), ("-solve_condense", "yes")])
def test_solvers_that_know_no_paths(run, tmp_path, option):
    (tmp_path / "squares.geo").write_text(GEO)
    text = SCENE
    for old, new in (NO_PAIR, ("top: {displacement: {x: 0, y: -0.05}}", "top: {fix: xy}\n  lower_side: {pressure: 0.1}"), ("step: 0.5", "step: 0.5, control: arc_length")):
        text = text.replace(old, new)
    result = run("squares.yml", *option, text=text)
    assert result.returncode == 1 and " ".join(option) in result.stderr and "arc_length" in result.stderr, result


def test_nothing_holds(check):
    refused(check([("  top: {displacement: {x: 0, y: -0.05}}\n", ""), ("contact:\n  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n", "")]),
            "nothing holds body 'upper'")


def test_three_dimensions_of_a_plane_mesh(check):
    refused(check([("plane_strain", "3d"), ("contact:\n  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n", "")]), "model is 3d", "dimension 3")


def test_plane_model_of_a_mesh_in_space(check):
    refused(check(geo=GEO.replace("{0, 0, 0}", "{0, 0, 1}")), "squares", "plane", "z")


def test_plane_model_of_a_mesh_of_solids(check, tmp_path):
    """A cube of one hexahedron, given to a plane model."""
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    nodes = "".join(f"{i} {x} {y} {z}\n" for i, (x, y, z) in enumerate(corners, 1))
    (tmp_path / "cube.msh").write_text('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 2 "bottom"\n3 1 "lower"\n$EndPhysicalNames\n'
                                       f"$Nodes\n8\n{nodes}$EndNodes\n$Elements\n2\n1 3 2 2 1 1 2 3 4\n2 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n")
    refused(check([("squares.geo, order: 1", "cube.msh")]), "cube.msh|two-dimensional", "3|dimension")


def test_negative_radius(check):
    refused(check([("plane_strain", "axisymmetric")], geo=GEO.replace("{0, 0, 0}", "{-1, 0, 0}")), "axisymmetric", "radius")


def test_node_to_segment_in_space(run):
    """Contact in space is there, the comparison is not."""
    assert run("inputs/blocks3d.yml", "-check").returncode == 0
    refused(run("inputs/blocks3d.yml", "-check", "-contact_upper_on_lower_node_to_segment", "true"), "node_to_segment|node-to-segment", "two dimensions")


def test_cell_in_no_body(check):
    bad = GEO + "Mesh.SaveAll = 1;\n"
    refused(check(geo=bad.replace('Physical Surface("upper", 2) = {11};\n', "")), "cell|upper")


def test_sides_share_a_vertex(check):
    """The upper square begins at a corner of the lower one."""
    bad = GEO.replace("Line(11) = {11, 12}", "Line(11) = {4, 12}").replace("Line(14) = {14, 11}", "Line(14) = {14, 4}")
    assert bad != GEO
    refused(check(geo=bad), r"'upper_bottom' and 'lower_top' share vertex \d+ of the mesh at \(0, 1, 0\);")


def test_gmsh_rejects(check):
    refused(check(geo=GEO + "Line(99) = {77, 78};\n"), "gmsh rejects", "squares.geo")


def test_meshes_are_called_by_the_name_of_their_geo(check):
    """Not by that of the file that gmsh left, which is gone by then."""
    prisms = 'Point(1) = {0, 0, 0, 1}; Point(2) = {1, 0, 0, 1}; Point(3) = {0, 1, 0, 1}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n' \
             'Curve Loop(1) = {1:3}; Plane Surface(1) = {1}; a[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; }; Physical Volume("lower") = {a[1]};\n'
    result = check([("plane_strain", "3d")], geo=prisms)
    refused(result, "squares.geo' has cells of shape 'triangular_prism'")
    assert "tmp" not in result.stderr, result


def test_gmsh_syntax(check):
    refused(check(geo="foo bar;\n"), "gmsh rejects", "bar|foo")


def test_gmsh_missing(check, tmp_path):
    refused(check(env={"PATH": str(tmp_path)}), "gmsh, which is not installed")


def test_gmsh_crashes(check, tmp_path):
    (tmp_path / "gmsh").write_text("#!/bin/sh\nkill -SEGV $$\n")
    (tmp_path / "gmsh").chmod(0o755)
    refused(check(env={"PATH": str(tmp_path)}), "gmsh crashed", "Segmentation fault")


def test_mesh_is_garbage(check, tmp_path):
    (tmp_path / "noise.msh").write_bytes(bytes(range(256)))
    refused(check([("file: squares.geo, order: 1", "file: noise.msh")]), "noise.msh")


def test_inverted_cell(check, tmp_path):
    (tmp_path / "bow.msh").write_text('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 3 "bottom"\n2 1 "lower"\n$EndPhysicalNames\n$Nodes\n4\n'
                                      '1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n$Elements\n2\n1 1 2 3 1 1 2\n2 3 2 1 1 1 2 3 4\n$EndElements\n')
    text = [("file: squares.geo, order: 1", "file: bow.msh"), ("  upper: {material: rubber}\n", ""), ("  top: {displacement: {x: 0, y: -0.05}}\n", ""),
            ("contact:\n  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n", "")]
    refused(check(text), "inverted|cell")


def test_output_cannot_be_written(check):
    refused(check([("load:", "output: {directory: out}\nload:")], "-output_directory", str(pathlib.Path(__file__)) + "/out"), "output.directory", "written")


@pytest.mark.parametrize("options,words", [
    (["-material_ruber_E", "2"], ["-material_ruber_E", "-material_rubber_E"]),
    (["-material_rubber_E", "x"], ["command line: material.rubber.E is 'x'"]),
    (["-adapt_tolernce", "1"], ["-adapt_tolernce", "-adapt_tolerance"]),
    (["-order"], ["-order needs a value"]),
    (["-boundary_top_displacement_y", "-t"], ["-boundary_top_displacement_y needs a value", "a blank before it, in quotation marks"]),
    (["-contact_pair_nonmortar", "[upper_bottom"], ["contact.pair.nonmortar is '.upper_bottom'", "ends with ]"]),
    (["-contact_pair_nonmortar", "[upper_bottom,]"], ["nothing stands between two of its commas, or at its end"]),
    (["-boundary_top_amplitude", "[0,0,1,1"], ["boundary.top.amplitude is '.0,0,1,1'", "ends with ]"]),
    (["-boundary_top_amplitude", "0,0,1,1]"], ["boundary.top.amplitude is '0,0,1,1]'"]),
    (["-boundary_top_amplitude", "[0,0,1,1]]"], ["boundary.top.amplitude: \"1]\" is neither a number"]),
    (["-boundary_top_amplitude", "[0,0,,1]"], ["nothing stands between two of its commas"]),
    (["second.yml"], ["second.yml"]),
    (["-order", "2", "3"], ["'3' is neither the scene nor an option nor its value"]),
    (["-adaptt_tolerance", "1"], ["-adaptt_tolerance is no key of a scene and no option", "-adapt_tolerance"]),
    (["-max_second", "1"], ["-max_second is no key of a scene and no option", "-max_seconds"]),
    (["-newton", "1", "-ksp_monitor"], ["-newton is no key of a scene and no option"]),
    (["-options_file", "nowhere.txt"], ["-options_file: .*nowhere.txt"]),
])
def test_command_line(check, options, words):
    refused(check((), *options), *words)


@pytest.mark.parametrize("option,value,allowed", [
    ("-solve_factor", "half", "auto|single|double"), ("-solve_condense", "maybe", "auto|yes|no"), ("-solve_linear", "cg", "auto|direct|iterative"),
    ("-solve_symmetric", "2", "0|1|false|true|no|yes"), ("-snes_max_it", "few", "an integer, 0 or more"), ("-solve_cuts", "-1", "an integer, 0 or more"),
    ("-solve_rtol", "1e-8x", "a number above 0, 1e-3 at most"), ("-solve_linear_rtol", "0", "a number above 0"), ("-snes_rtol", "-1", "a number, 0 or more, below 1"), ("-snes_rtol", "1", "a number, 0 or more, below 1"),
    ("-newton_stall", "no", "auto|on|off"), ("-solve_multigrid", "ml", "auto|gamg|boomeramg"),
])
def test_solver_options(run, option, value, allowed):
    result = run("inputs/patch2d.yml", option, value)
    assert result.returncode == 1, result
    assert result.stderr == f"mortise: {option} is '{value}'; allowed: {allowed}\n", result.stderr
    assert run("inputs/patch2d.yml", option, value, "-check").returncode == 1


def test_solver_option_misspelt(run):
    """Before anything is solved, with -check or without."""
    for check in ((), ("-check",)):
        result = run("inputs/patch2d.yml", "-solve_rtoll", "1e-8", *check)
        assert result.returncode == 1 and not result.stdout, result
        assert result.stderr == "mortise: -solve_rtoll is no option of the solver; the nearest one is -solve_rtol\n", result.stderr


@pytest.mark.parametrize("option", ["-snes_monitorr", "-snes_linesearch_type", "-snes_type", "-snes_lag_jacobian"])
def test_option_of_snes_that_cannot_act(run, option):
    """Newton's iteration is the program's own: what SNES would do in others is refused by name, before anything is solved."""
    for check in ((), ("-check",)):
        result = run("inputs/patch2d.yml", option, "bt", *check)
        assert result.returncode == 1 and not result.stdout and result.stderr.startswith(f"mortise: {option} cannot act here; "), result
        assert result.stderr.count("\n") == 1


def test_options_of_snes_that_act(run):
    """Limits cut the run short, with their names; a looser tolerance takes fewer iterations than the default; monitors print."""
    disc = ("inputs/hertz2d.yml", "-adapt_tolerance", 0, "-output_fields", "false")
    plain = run(*disc).summary["newton_iterations"]
    for limit in ("max_it", "max_funcs"):
        short = run("inputs/patch2d.yml", f"-snes_{limit}", 1, "-load_step_min", 0.6, "-path_descent", "off")
        assert short.returncode == 2 and f"-snes_{limit}" in short.summary["reason"], short
    for tolerance in (("-snes_rtol", 0.1), ("-snes_atol", 1e-5), ("-snes_stol", 0.1)):
        loose = run(*disc, *tolerance)
        assert loose.returncode == 0 and loose.summary["newton_iterations"] < plain, loose
    assert "SNES Function norm" in run("inputs/patch2d.yml", "-snes_monitor").stdout


def test_option_of_petsc(run):
    """One that nothing uses is named once, by us, not by PETSc; one that PETSc reads last of all is no such option."""
    for option, said in (("-ksp_monitorr", "mortise: nothing used the option -ksp_monitorr: it is spelt wrong, or of something that this run did without\n"), ("-options_view", "")):
        result = run("inputs/patch2d.yml", option)
        assert result.returncode == 0 and result.stderr == said and "unused" not in result.stdout, result


@pytest.mark.parametrize("ranks", [1, 2])
def test_options_file(check, tmp_path, ranks):
    """Keys of the scene and options of the solver, in PETSc's form; the command line wins over both."""
    options = tmp_path / "options.txt"
    options.write_text('# of several runs\n-material_rubber_E 26\n-boundary_top_displacement_y "-0.02 * t"\n-order 3\n-snes_max_it 30\n')
    result = check((), "-options_file", options, "-order", 2, "-snes_max_it", 20, ranks=ranks)
    assert result.returncode == 0 and "mu = 10," in result.stdout and "order 2" in result.stdout and "u_y = -0.02 * t" in result.stdout, result


@pytest.mark.parametrize("line,words", [
    ("-material_ruber_E 2", ["-options_file or PETSC_OPTIONS: -material_ruber_E", "-material_rubber_E"]),
    ("-material_rubber_E x", ["-options_file or PETSC_OPTIONS: material.rubber.E is 'x'"]),
    ("-order", ["-order needs a value"]),
    ("-solve_rtoll 1e-8", ["-solve_rtoll is no option of the solver"]),
    ("-tolerance 1", ["-tolerance is no key of a scene and no option"]),
    ("order 2", ["-options_file: .* line 1: order"]),
    ("-order 2\n-boundary_top_displacement_y \"-t", ["-options_file: .*options.txt:2: a quotation mark is not closed"]),
    ("-boundary_top_displacement_y -0.02 * t", ["-options_file: .* line 1: extra token"]),
])
def test_options_file_refused(check, tmp_path, line, words):
    (tmp_path / "options.txt").write_text(line + "\n")
    refused(check((), "-options_file", tmp_path / "options.txt"), *words)


def test_options_of_petsc_stay(check):
    """Those that nothing asks for before the run are no mistake."""
    result = check((), "-log_view", "-ksp_monitor", "-pc_factor_shift_type", "none", "-mat_mumps_icntl_14", 30, "-multigrid_pc_type", "lu")
    assert result.returncode == 0 and "mortise: -" not in result.stderr, result


def test_command_line_wins(check):
    result = check((), "-material_rubber_E", "26", "-order", "3", "-boundary_bottom_fix", "y", "-mesh_parameter_n", "3")
    assert result.returncode == 0, result
    assert "mu = 10," in result.stdout and "order 3" in result.stdout and "fix y" in result.stdout


def test_warnings(check):
    """Allowed, and said before anything is solved: vectors of another length, a yield stress that falls, fibres that push."""
    assert "material.rubber.fiber.a.direction has length 2; made a unit vector" in check([(RUBBER, HGO % "fiber: {a: {direction: {x: 2}}}")]).stdout
    assert "made a unit vector" not in check([(RUBBER, HGO % "fiber: {a: {direction: {x: 0.6, y: 0.8}}}")]).stdout
    assert "in compression too" in check([(RUBBER, HGO % "fiber: {a: {angle: 29, compression: true}}")]).stdout
    falls = "warning: the yield stress of material rubber falls"
    assert falls in check([(RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: -0.1}")]).stdout
    assert falls in check([(RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: 0.1, saturation: -0.5, saturation_rate: 1}")]).stdout
    assert falls not in check([(RUBBER, "{law: j2, E: 1, nu: 0.3, yield: 1, hardening: 0}")]).stdout


DIRECTIONS = ("upper: {material: rubber}", "upper: {material: rubber, order: {x: 3, y: 2}}")


def test_orders_per_direction(check):
    """Letters that are not given take the scene's order; the same in all directions is one order."""
    assert "order 3 (along x: 3, y: 2)" in check((DIRECTIONS,)).stdout
    assert "order 4 (along x: 1, y: 4)" in check((), "-body_upper_order_y", "4").stdout
    assert re.search(r"body upper: order 2, material", check((), "-body_upper_order_x", "2", "-body_upper_order_y", "2").stdout)
    assert re.search(r"body upper: order 5, material", check((DIRECTIONS,), "-body_upper_order", "5").stdout)


def test_orders_per_direction_refused(check):
    refused(check((DIRECTIONS, ("friction: 0", "friction: 0, order: full"))), r"contact.pair.order", "orders per direction", "upper", "allowed here: 1")
    refused(check((DIRECTIONS, ("nu: 0.3", "nu: 0.49"))), r"body.upper.order", "mixed", "allowed: one order")
    refused(check((("upper: {material: rubber}", "upper: {material: rubber, order: 2}"),), "-body_upper_order_y", "1"), r"body.upper.order, which is 2", "map")


def test_no_scene(run, tmp_path):
    result = run("missing.yml", "-check", text="")
    refused(result, "empty")
    (tmp_path / "missing.yml").unlink()


def test_triangles_become_quads(check):
    result = check(geo=re.sub(r"(Recombine|Transfinite) Surface .*", "", GEO))
    assert result.returncode == 0, result
