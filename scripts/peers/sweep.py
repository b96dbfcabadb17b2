"""What `make peers` runs: for each scene the series of each code, coarse to fine. Orders, meshes, penalties and steps are swept, so that each code is met at its best."""
import itertools

ROUND = ("-mesh_order", 4)
HALF = ("scripts/peers/half_disc.yml", "-adapt_max_passes", 20)
SLIDE = ("inputs/slide2d.yml", *ROUND, "-adapt_max_passes", 20)
MINDLIN = ("-mesh_parameter_h", 2, "-boundary_top_displacement_x", "0.0012*max(t-1,0)", "-boundary_top_displacement_y", "-0.01*min(t,1)")
RUBBER = ("-material_rubber_nu", 0.499, "-boundary_top_displacement_y", -0.3)
COOK = ("inputs/cook.yml", "-material_rubber_kappa", ".inf", "-load_step", 1, "-adapt_max_passes", 30)
WHOLE = ("inputs/rubber2d.yml", *ROUND, "-adapt_max_passes", 20)
CYLINDER = ("tests/verify/scenes/pressed_cylinder.yml", *ROUND, "-adapt_max_passes", 20)


def words(options):
    """{"order": 2} as --order 2."""
    return [str(word) for name, value in options.items() for word in (f"--{name}", value)]


def mortise(common, tolerances, orders=(2, 3, 4), hp=True):
    """Orders of cells and contact faces, and hp, to falling tolerances."""
    series = {f"order {order}": ("-order", order) for order in orders}
    if hp:
        series["hp"] = ("-order", 1, "-adapt_strategy", "hp")
    return {("mortise", name): [[*common, *options, "-adapt_tolerance", tolerance] for tolerance in tolerances] for name, options in series.items()}


def peer(code, common, vary, *meshes):
    """A series for each combination of `vary`, over the meshes."""
    series = {}
    for values in itertools.product(*vary.values()):
        chosen = dict(zip(vary, values))
        name = ", ".join(f"{key} {value if isinstance(value, str) else format(value, 'g')}" for key, value in {**chosen, **common}.items() if key not in ("solver", "mixed"))
        series[code, name] = [words({**common, **chosen, **(mesh if isinstance(mesh, dict) else {"n": mesh})}) for mesh in meshes]
    return series


def graded(*sizes, h=0.13):
    return [{"h": h, "hmin": size} for size in sizes]


UMFPACK = {"mixed": 1, "solver": "umfpack"}
SCENES = {
    "hertz2d": {
        **mortise(HALF, (0.3, 0.1, 0.03, 0.01, 0.003, 0.001)),
        **peer("ngsolve", {}, {"order": (2, 3, 4), "gamma": (1e3, 1e4)}, *graded(0.08, 0.04, 0.02, 0.01)),
        **peer("ngsolve", {"hcorner": 0.02}, {"order": (3, 4), "gamma": (1e5,)}, *graded(0.04, 0.02, 0.01)),
        **peer("getfem", {}, {"order": (1,), "grade": (0, 1.5)}, 6, 8, 16, 32),
        **peer("getfem", {}, {"order": (2,), "grade": (0, 1.5)}, 4, 8, 12),
        **peer("getfem", {"multiplier": 2}, {"order": (3,), "grade": (0, 1.5)}, 3, 4, 8),
        **peer("calculix", {}, {"cell": ("C3D8",), "penalty": (1e3, 1e4)}, 8, 16, 32),
        **peer("calculix", {}, {"cell": ("C3D8I", "C3D20R"), "penalty": (1e4,)}, 4, 8, 16),
        **peer("kratos", {}, {"steps": (1,), "grade": (0, 1)}, 4, 8, 16),
    },
    "rubber2d": {
        **mortise((*HALF, *RUBBER), (0.1, 0.06, 0.04), orders=(2, 3), hp=False),
        **{("mortise", f"{name[1]}, whole"): runs for name, runs in mortise(WHOLE, (0.1, 0.06, 0.04), orders=(2, 3), hp=False).items()},
        **peer("getfem", {"mixed": 1}, {"order": (1,), "steps": (1, 4)}, 4, 8, 16),
        **peer("getfem", {"mixed": 1}, {"order": (2,), "steps": (2, 8)}, 4, 8),
        **peer("getfem", {"mixed": 1, "multiplier": 2}, {"order": (3,), "steps": (8,)}, 4, 8, 12),
        **peer("calculix", {}, {"cell": ("C3D8R",), "penalty": (1e2, 1e3)}, 8, 16),
        **peer("ngsolve", UMFPACK, {"order": (2,), "gamma": (30.0, 100.0), "steps": (4,)}, {"h": 0.2}),
        **peer("kratos", {}, {"steps": (8,)}, 8),
    },
    "hertz3d": {
        **mortise(("inputs/hertz3d.yml", *ROUND, "-adapt_max_passes", 20), (0.2, 0.1, 0.07, 0.04), orders=(2, 3), hp=False),
        **{("mortise", f"{name[1]}, anisotropic"): [[*run, "-adapt_anisotropic", "true", "-adapt_fraction", 0.5] for run in runs]
           for name, runs in mortise(("inputs/hertz3d.yml", *ROUND, "-adapt_max_passes", 20), (0.1, 0.07, 0.04), orders=(2, 3), hp=False).items()},
        **peer("ngsolve", {}, {"order": (2,), "gamma": (1e3, 1e4)}, {"h": 0.4, "hmin": 0.1}, {"h": 0.25, "hmin": 0.06}),
        **peer("ngsolve", {}, {"order": (3,), "gamma": (1e3, 1e4)}, {"h": 0.4}, {"h": 0.25}),
        **peer("getfem", {}, {"order": (1,), "grade": (0, 1)}, 4, 8),
        **peer("getfem", {}, {"order": (2,), "grade": (0, 1)}, 2, 4),
        **peer("calculix", {}, {"cell": ("C3D8", "C3D8I"), "penalty": (1e4,)}, 4, 8),
        **peer("calculix", {}, {"cell": ("C3D20R",), "penalty": (1e3,)}, 2, 4),
        **peer("kratos", {}, {"steps": (1,)}, 4, 8),
    },
    "lshape": {
        **mortise(("inputs/lshape.yml", "-adapt_max_passes", 40), (0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4, 3e-5, 1e-5), orders=(4,)),
        ("mortise", "order 2"): [["inputs/lshape.yml", "-adapt_max_passes", 40, "-order", 2, "-adapt_tolerance", tolerance] for tolerance in (0.03, 0.01, 0.003, 0.001)],
        **peer("ngsolve", {}, {"order": (2,)}, *({"passes": passes} for passes in (4, 8, 12, 16, 20))),
        **peer("ngsolve", {}, {"order": (4, 6)}, *({"passes": passes} for passes in (4, 8, 12, 16, 20, 24, 30))),
    },
    "cook": {
        **mortise(COOK, (0.1, 0.05, 0.03, 0.02, 0.015, 0.01), orders=(2, 3)),
        ("mortise", "order 2, uniform"): [[*COOK, "-adapt_tolerance", 0, "-mesh_parameter_n", n] for n in (4, 8, 16, 32)],
        ("mortise", "order 4, uniform"): [[*COOK, "-adapt_tolerance", 0, "-order", 4, "-mesh_parameter_n", n] for n in (4, 8, 16)],
        **peer("ngsolve", UMFPACK, {"order": (2, 3, 5), "hcorner": (0.5, 0.1), "steps": (1,)}, {"h": 20}, {"h": 10}, {"h": 5}),
        **peer("getfem", {"mixed": 1}, {"order": (2, 3), "steps": (1,)}, 4, 8, 16),
    },
    "cylinder": {
        **mortise((*CYLINDER, "-load_step", 0.5), (0.1, 0.03, 0.01, 0.003)),
        **peer("ngsolve", UMFPACK, {"order": (2, 3, 4), "gamma": (1e5, 1e6), "steps": (2, 4)}, {"h": 0.05}, {"h": 0.05, "hmin": 0.02}, {"h": 0.04, "hmin": 0.008}),
    },
    "slide2d": {
        **mortise(SLIDE, (0.1, 0.03, 0.01, 0.005)),
        **peer("ngsolve", {}, {"order": (2, 3), "gamma": (1e3, 1e4), "steps": (2,)}, {"h": 0.2}, {"h": 0.1}),
        **peer("getfem", {}, {"order": (1, 2), "steps": (1, 2)}, 4, 8),
        **peer("getfem", {"multiplier": 2}, {"order": (3,), "steps": (2,)}, 4, 8, 12),
        **peer("calculix", {}, {"cell": ("C3D8", "C3D8I"), "penalty": (1e4,), "steps": (1, 20)}, 4, 8),
    },
    "friction2d": {
        **mortise((*SLIDE, "-contact_disc_on_block_friction", 0.3), (0.1, 0.03, 0.01)),
        **peer("getfem", {}, {"order": (1, 2), "steps": (1, 4)}, 4, 8),
        **peer("getfem", {"multiplier": 2}, {"order": (3,), "steps": (1,)}, 4, 8),
        **peer("calculix", {}, {"cell": ("C3D8",), "penalty": (1e3, 1e4), "steps": (1, 20)}, 4, 8),
    },
    "mindlin": {
        **{("mortise", f"{name[1]}, step {step}"): runs for step in (1, 0.5, 0.25)
           for name, runs in mortise((*SLIDE, *MINDLIN, "-contact_disc_on_block_friction", 0.3, "-load_step", step), (0.05, 0.02, 0.01), orders=(2, 3), hp=False).items()},
        **peer("getfem", {"grade": 3}, {"order": (2,), "steps": (1, 2, 4)}, 6, 10),
        **peer("getfem", {"grade": 3}, {"order": (1,), "steps": (2,)}, 8, 16),
        **peer("calculix", {"grade": 3}, {"cell": ("C3D8", "C3D8I"), "penalty": (1e4,), "steps": (2, 4)}, 8, 12),
    },
}
