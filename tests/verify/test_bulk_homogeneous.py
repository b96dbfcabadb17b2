"""Discrete and homogeneous answers that are exact: the clamped cube (O-03) and uniform stretch (O-04)."""
import json
import math

import pytest

from boxmesh import linspace, write

# ---- O-03: energies and tip displacements of the discrete problem -------------------------------------------------------------------

CUBE = [  # cells a side, order, energy, displacement of (1,1,1)
    (2, 1, 0.196234828256, (.17426259, -.06312461, -.949169)),
    (4, 1, 0.20696245214, (.13141136, -.04946471, -1.06877552)),
    (2, 2, 0.2124627912745, (.10389808, -.04199951, -1.11965769)),
    (4, 2, 0.217187932433, (.08199603, -.04444753, -1.16293748)),
    (1, 4, 0.214824343153, (.08804094, -.03850318, -1.14381849)),
    (2, 3, 0.216362239243, (.08329285, -.04441562, -1.15975453)),
    (2, 4, 0.21868058091, (.07518759, -.04549034, -1.17599921)),
]


@pytest.mark.parametrize("n, order, energy, tip", CUBE)
def test_o03_clamped_cube(run, n, order, energy, tip):
    result = run("inputs/cube.yml", "-mesh_parameter_n", n, "-order", order, "-output_fields", "false")
    assert result.returncode == 0, result
    assert abs(result.summary["energy"] / energy - 1) < 1e-8, result.summary["energy"]
    for value, reference in zip(result.summary["probe"]["corner"]["displacement"], tip):
        assert abs(value - reference) < 1e-8  # the digits of the table


def test_o03_mooney_rivlin(run, tmp_path):
    """lambda/2 ln^2 J - (m1 + 2 m2) ln J + m1/2 (I1 - 3) + m2/2 (I2 - 3), m1 = m2 = 0.5, lambda = 4: kappa = lambda + 2 m2 + 2/3 (m1 + m2)."""
    material = {"law": "mooney_rivlin", "volumetric": "log", "formulation": "displacement", "c1": 0.25, "c2": 0.25, "kappa": 17 / 3}
    write(tmp_path / "cube.msh", [linspace(0, 1, 2)] * 3, lambda *x: x)
    scene = {"mesh": {"file": "cube.msh"}, "model": "3d", "order": 2, "body": {"body": {"material": "m"}}, "material": {"m": material},
             "boundary": {"x0": {"fix": "xyz"}, "x1": {"traction": {"z": -0.5}}}, "load": {"step": 0.25}, "probe": {"corner": {"x": 1, "y": 1, "z": 1}},
             "output": {"fields": False}}
    result = run("cube.yml", text=json.dumps(scene))
    assert result.returncode == 0, result
    assert abs(result.summary["energy"] / 0.2339138879702 - 1) < 1e-8, result.summary["energy"]
    for value, reference in zip(result.summary["probe"]["corner"]["displacement"], (.11289155, -.0551175, -1.20172966)):
        assert abs(value - reference) < 1e-8


def test_mixed_cell_of_order_7(run):
    """84 pressures in one cell: its stresses are found for output and estimate, and the two formulations tell nearly the same energy."""
    options = ("-mesh_parameter_n", 1, "-order", 7, "-load_end", 0.1, "-load_step", 0.1)
    energy = [run("inputs/cube.yml", *options, "-material_rubber_formulation", f).summary["energy"] for f in ("mixed", "displacement")]
    assert abs(energy[0] / energy[1] - 1) < 0.01, energy


# ---- O-04: uniform stretch ----------------------------------------------------------------------------------------------------------

MODULI = {"E": 100, "nu": 0.3}
VOLUMETRIC = {"NHc": "log", "NHs": "simo", "NHq": "quadratic"}
STRETCH = [  # law, stretch; uniaxial: lateral stretch, P; plane strain: lateral stretch, P, Pzz
    ("NHc", .7, 1.107934733, -40.523042431, 1.150796046, -45.842392321, -12.474290010),
    ("NHc", .5, 1.210767391, -93.535205689, 1.288304972, -108.440746286, -25.374219297),
    ("NHs", .7, 1.111318893, -45.107826057, 1.126655834, -50.165308724, -12.136390017),
    ("NHq", .7, 1.104472315, -44.554936667, 1.106266753, -47.813424459, -10.208583880),
    ("NHc", 1.3, .921999955, 24.849588265, .886870147, 26.729625509, 8.210051623),
]


def energy_density(law, stretch):
    """W of principal stretches, from the formulas of the table of laws."""
    mu, lam = 100 / 2.6, 30 / (1.3 * 0.4)
    kappa, J, I1 = lam + 2 * mu / 3, math.prod(stretch), sum(s * s for s in stretch)
    if law == "NHc":
        return mu / 2 * (I1 - 3) - mu * math.log(J) + lam / 2 * math.log(J) ** 2
    volumetric = kappa / 2 * ((J * J - 1) / 2 - math.log(J)) if law == "NHs" else kappa / 2 * (J - 1) ** 2
    return volumetric + mu / 2 * (J ** (-2 / 3) * I1 - 3)


def block(run, tmp_path, dim, material, boundary, model=None, order=1, n=2, **keys):
    """A unit block, its cells distorted inside, between the given boundaries."""
    def to(*x):
        bump = 0.1 * math.prod(math.sin(math.pi * c) for c in x)
        return tuple(c + bump * (1 - 0.5 * i) for i, c in enumerate(x))

    write(tmp_path / "block.msh", [linspace(0, 1, n)] * dim, to)
    scene = {"mesh": {"file": "block.msh"}, "model": model or ("3d" if dim == 3 else "plane_strain"), "order": order, "body": {"body": {"material": "m"}},
             "material": {"m": material}, "boundary": boundary, "load": {"step": 0.5}, "probe": {"corner": {"x": 1, "y": 1, **({"z": 1} if dim == 3 else {})}},
             "output": {"fields": False}, **keys}
    result = run("block.yml", text=json.dumps(scene))
    assert result.returncode == 0, result
    return result.summary


def close(value, reference, tolerance):
    assert abs(value - reference) <= tolerance * max(1, abs(reference)), (value, reference)


@pytest.mark.parametrize("formulation", ["displacement", "mixed"])
@pytest.mark.parametrize("law, stretch, lateral, P", [row[:4] for row in STRETCH])
def test_o04_uniaxial(run, tmp_path, law, stretch, lateral, P, formulation):
    """In space and axisymmetric: all give the same numbers, and a uniform pressure is in the mixed space."""
    material = {"law": "neo_hookean", "volumetric": VOLUMETRIC[law], "formulation": formulation, **MODULI}
    s = block(run, tmp_path, 3, material, {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}, "x1": {"displacement": {"x": stretch - 1}}})
    close(s["reaction"]["x1"][0], P, 1e-8)
    close(s["reaction"]["x0"][0], -P, 1e-8)
    for value, reference in zip(s["probe"]["corner"]["displacement"], (stretch - 1, lateral - 1, lateral - 1)):
        close(value, reference, 1e-8)
    close(s["energy"], energy_density(law, (stretch, lateral, lateral)), 1e-8)
    s = block(run, tmp_path, 2, material, {"y0": {"fix": "y"}, "x0": {"fix": "x"}, "y1": {"displacement": {"y": stretch - 1}}}, "axisymmetric", 2)
    close(s["reaction"]["y1"][1], math.pi * P, 1e-8)  # full revolution of radius 1
    close(s["probe"]["corner"]["displacement"][0], lateral - 1, 1e-8)
    close(s["energy"], math.pi * energy_density(law, (stretch, lateral, lateral)), 1e-8)


@pytest.mark.parametrize("law, stretch, lateral, P, Pzz", [row[:2] + row[4:] for row in STRETCH])
def test_o04_plane_strain(run, tmp_path, law, stretch, lateral, P, Pzz):
    """In the plane and in space between two rollers, whose reaction is Pzz times the area."""
    material = {"law": "neo_hookean", "volumetric": VOLUMETRIC[law], **MODULI}
    plane = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "x1": {"displacement": {"x": stretch - 1}}}
    flat = block(run, tmp_path, 2, material, plane, order=2)
    solid = block(run, tmp_path, 3, material, {**plane, "z0": {"fix": "z"}, "z1": {"fix": "z"}})
    close(solid["reaction"]["z1"][2], Pzz, 1e-8)
    close(flat["probe"]["corner"]["stress"][5], Pzz / (stretch * lateral), 1e-8)  # Cauchy: P33 / J, F33 = 1
    for s in (flat, solid):
        close(s["reaction"]["x1"][0], P, 1e-8)
        close(s["probe"]["corner"]["displacement"][1], lateral - 1, 1e-8)
        close(s["energy"], energy_density(law, (stretch, lateral, 1)), 1e-8)


@pytest.mark.parametrize("stretch", [.7, 1.3])
def test_o04_saint_venant_kirchhoff(run, tmp_path, stretch):
    """Hooke's law between S and E, so closed forms in both: S = Y E and lateral -nu E, or in plane strain Y/(1 - nu^2) and -nu/(1 - nu)."""
    material = {"law": "saint_venant_kirchhoff", **MODULI}
    pull, Y, nu = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "x1": {"displacement": {"x": stretch - 1}}}, MODULI["E"], MODULI["nu"]
    strain = (stretch**2 - 1) / 2
    s = block(run, tmp_path, 3, material, {**pull, "z0": {"fix": "z"}})
    close(s["reaction"]["x1"][0], stretch * Y * strain, 1e-8)
    close(s["energy"], Y * strain**2 / 2, 1e-8)
    for value in s["probe"]["corner"]["displacement"][1:]:
        close(value, math.sqrt(1 - 2 * nu * strain) - 1, 1e-8)
    Y, lateral = Y / (1 - nu**2), math.sqrt(1 - 2 * nu / (1 - nu) * strain)
    flat = block(run, tmp_path, 2, material, pull, order=2)
    solid = block(run, tmp_path, 3, material, {**pull, "z0": {"fix": "z"}, "z1": {"fix": "z"}})
    close(solid["reaction"]["z1"][2], nu * Y * strain, 1e-8)
    close(flat["probe"]["corner"]["stress"][5], nu * Y * strain / (stretch * lateral), 1e-8)
    for s in (flat, solid):
        close(s["reaction"]["x1"][0], stretch * Y * strain, 1e-8)
        close(s["probe"]["corner"]["displacement"][1], lateral - 1, 1e-8)
        close(s["energy"], Y * strain**2 / 2, 1e-8)


TRELOAR = {"law": "ogden", "mu1": 6.3, "alpha1": 1.3, "mu2": 0.012, "alpha2": 5, "mu3": -0.1, "alpha3": -2, "kappa": "inf", "volumetric": "simo"}


def ogden(first, second):
    """Nominal stress along the first stretch, the third direction free of stress, volume kept."""
    terms = [(TRELOAR[f"mu{p}"], TRELOAR[f"alpha{p}"]) for p in (1, 2, 3)]
    return sum(mu * (first ** a - (first * second) ** -a) for mu, a in terms) / first


def test_o06_rubber_of_three_terms(run, tmp_path):
    """Treloar's rubber: nominal stresses in simple tension, pure shear and equibiaxial tension at a stretch of 2."""
    planes = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}, "x1": {"displacement": {"x": 1}}}
    s = block(run, tmp_path, 3, TRELOAR, planes, order=2)
    close(s["reaction"]["x1"][0], ogden(2, 2 ** -0.5), 1e-8)
    s = block(run, tmp_path, 3, TRELOAR, {**planes, "y1": {"displacement": {"y": 1}}}, order=2)
    close(s["reaction"]["y1"][1], ogden(2, 2), 1e-8)
    s = block(run, tmp_path, 2, TRELOAR, {k: v for k, v in planes.items() if k != "z0"}, order=2)
    close(s["reaction"]["x1"][0], ogden(2, 1), 1e-8)


RUBBER = [{"law": "neo_hookean", "volumetric": "quadratic", "mu": 1, "kappa": 1e5}, {"law": "neo_hookean", "volumetric": "simo", "mu": 1, "kappa": 1e5},
          {"law": "mooney_rivlin", "c1": 0.5, "c2": 0, "kappa": 1e5, "formulation": "mixed"}]


@pytest.mark.parametrize("material", RUBBER, ids=["quadratic", "simo", "mooney_rivlin"])
def test_o04_incompressible(run, tmp_path, material):
    """mu = 1, stretch 2: uniaxial, equibiaxial and pure shear nominal stresses of the u-p elements at kappa = 1e5 mu."""
    planes = {"x0": {"fix": "x"}, "y0": {"fix": "y"}, "z0": {"fix": "z"}, "x1": {"displacement": {"x": 1}}}
    for order in (1, 2):
        s = block(run, tmp_path, 3, material, planes, order=order)
        close(s["reaction"]["x1"][0], 1.75, 1e-4)
        s = block(run, tmp_path, 3, material, {**planes, "y1": {"displacement": {"y": 1}}}, order=order)
        close(s["reaction"]["x1"][0], 1.96875, 1e-4)
        close(s["reaction"]["y1"][1], 1.96875, 1e-4)
        s = block(run, tmp_path, 2, material, {k: v for k, v in planes.items() if k != "z0"}, order=order)
        close(s["reaction"]["x1"][0], 1.875, 1e-4)


# ---- bodies held all around ----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("cells, order", [(1, 1), (1, 2), (1, 3), (2, 2), (4, 2)])
def test_rotation_of_all_sides(run, tmp_path, cells, order):
    """A nearly incompressible square whose sides turn by 80 degrees in large steps is free of stress. The first linear step of a load step leaves a
    constant pressure that no residual of a displacement sees; one cell of order 1 or 3 leaves no unknown to solve for at all."""
    write(tmp_path / "square.msh", [linspace(0, 1, cells)] * 2, lambda *x: x)
    turn = {"rotation": {"angle": "80*t", "point": {"x": 0.5, "y": 0.5}}}
    scene = {"mesh": {"file": "square.msh"}, "model": "plane_strain", "order": order, "body": {"body": {"material": "m"}},
             "material": {"m": {"law": "neo_hookean", "E": 1000, "nu": 0.499}}, "boundary": dict.fromkeys(("x0", "x1", "y0", "y1"), turn),
             "load": {"step": 0.25}, "probe": {"point": {"x": 0.3, "y": 0.4}}, "output": {"fields": False}}
    result = run("square.yml", text=json.dumps(scene))
    assert result.returncode == 0, result
    assert max(map(abs, result.summary["probe"]["point"]["stress"])) < 1e-6 and abs(result.summary["energy"]) < 1e-9, result.summary
