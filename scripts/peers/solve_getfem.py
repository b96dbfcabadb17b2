"""GetFEM: integral contact with large sliding (augmented Lagrangian, raytracing, Coulomb friction), laws in its language of weak forms, semi-smooth Newton."""
import getfem as gf
import numpy as np

import meshes
from scenes import COOK, SCENES, options, report

args = options(__doc__, order=2, multiplier=1, n=8, grade=0.0, r=1.0, steps=1, mixed=0, slave="upper", alpha=0.05)
gf.util_trace_level(0)
scene = SCENES.get(args.scene)
dim = scene.dim if scene else 2
TOP, AXIS, AXIS2, CONTACT = 1, 2, 3, 4
curved = min(args.order, 2)


def body(cells, points):
    mesh, kind = gf.Mesh("empty", dim), gf.GeoTrans(f"GT_QK({dim},{curved})")
    for cell in cells:
        mesh.add_convex(kind, points[cell.transpose().ravel()].T)  # first direction fastest
    return mesh


def region(mesh, number, test):
    points, outer = mesh.pts(), mesh.outer_faces()
    mesh.set_region(number, np.array([face for face in outer.T if test(mesh.pts(mesh.pid_in_faces(face.reshape(2, 1)))).all()]).reshape(-1, 2).T)


def add_body(model, name, mesh):
    """Displacement u_name (and pressure p_name) of a body with its forces."""
    field = gf.MeshFem(mesh, dim)
    field.set_fem(gf.Fem(f"FEM_QK({dim},{args.order})"))
    rule = gf.MeshIm(mesh, gf.Integ(f"IM_GAUSS_PARALLELEPIPED({dim},{2 * args.order + 1})"))
    model.add_fem_variable(f"u{name}", field)
    stress = stress_of(name)
    if args.mixed:
        pressure = gf.MeshFem(mesh, 1)
        pressure.set_fem(gf.Fem(f"FEM_QK({dim},{args.order - 1})" if args.order > 1 else f"FEM_QK_DISCONTINUOUS({dim},0)"))
        model.add_fem_variable(f"p{name}", pressure)
        F = gradient(name)
        model.add_nonlinear_term(rule, f"(Det({F})-1{f'-p{name}/kappa' if kappa else ''})*Test_p{name}")
    model.add_nonlinear_term(rule, f"({stress}):Grad_Test_u{name}")
    return field, rule


def gradient(name):
    return f"(Id({dim})+Grad_u{name})"


def stress_of(name):
    F = gradient(name)
    inverse, shear = f"(Inv({F})')", f"mu*pow(Det({F}),-2/3)*({F}-(Norm_sqr({F}){'+1' if dim == 2 else ''})/3*Inv({F})')"
    return f"{shear}+{f'p{name}' if args.mixed else f'kappa*(Det({F})-1)'}*Det({F})*{inverse}"


def solve(model):
    """Newton iterations of one step."""
    found = model.solve("max_iter", 40, "max_res", 1e-9, "lsearch", "simplest", "alpha min", args.alpha, "lsolver", "mumps")
    count = int(found if np.isscalar(found) else found[0])
    if count >= 40:
        raise SystemExit("no equilibrium")
    return count


def roller(model, rule, name, number, axis):
    """No displacement across a plane of symmetry."""
    model.add_initialized_data(f"H{name}{axis}", np.diag([float(k == axis) for k in range(dim)]).ravel(), [dim, dim])
    model.add_generalized_Dirichlet_condition_with_penalization(rule, f"u{name}", 1e8, number, "zero", f"H{name}{axis}")


model = gf.Model("real")
kappa = scene.kappa if scene else None
model.add_initialized_data("mu", [scene.mu if scene else COOK["mu"]])
if kappa:
    model.add_initialized_data("kappa", [kappa])
model.add_initialized_data("zero", [0.0] * dim)
iterations = 0
if args.scene == "cook":
    corner = [np.array(c, float) for c in COOK["corners"]]
    plate = meshes.Mesh(2, curved)
    plate.add("m", lambda s, t: meshes.mix(t, meshes.mix(s, corner[0], corner[1]), meshes.mix(s, corner[3], corner[2])), args.n, args.n)
    points, cells = plate.finish()
    mesh = body(cells["m"], points)
    region(mesh, TOP, lambda x: abs(x[0] - 48) < 1e-9)
    region(mesh, CONTACT, lambda x: abs(x[0]) < 1e-9)
    field, rule = add_body(model, "m", mesh)
    model.add_Dirichlet_condition_with_simplification("um", CONTACT, "zero")
    model.add_initialized_data("load", [0.0, 0.0])
    model.add_source_term_brick(rule, "um", "load", TOP)
    for k in range(1, args.steps + 1):
        model.set_variable("load", [0, COOK["traction"] * k / args.steps])
        iterations += solve(model)
    nodes = field.basic_dof_nodes()
    at = np.flatnonzero((abs(nodes[0] - 48) < 1e-9) & (abs(nodes[1] - 60) < 1e-9))
    report(model.variable("um")[at[1]], model.nbdof(), iterations, args.steps)
    raise SystemExit

points, cells = meshes.generate(scene, args.n, curved, args.grade)
upright = dim - 1
parts = {}
for name in ("upper", "lower"):
    mesh = body(cells[name], points)
    region(mesh, TOP, lambda x: abs(x[upright] - (1 if name == "upper" else -scene.height)) < 1e-9)
    region(mesh, CONTACT, lambda x: meshes.on_arc(x.T) if name == "upper" else meshes.on_face(x.T))
    field, rule = add_body(model, name[0], mesh)
    if scene.half:
        for axis, number in ((0, AXIS), (1, AXIS2))[: dim - 1]:
            region(mesh, number, lambda x: abs(x[axis]) < 1e-9)
            roller(model, rule, name[0], number, axis)
    parts[name] = mesh, field, rule
model.add_initialized_data("top", [0.0] * dim)
model.add_Dirichlet_condition_with_simplification("ul", TOP, "zero")
model.add_Dirichlet_condition_with_simplification("uu", TOP, "top")
model.add_initialized_data("r", [args.r * scene.E * args.n])
model.add_initialized_data("friction", [scene.friction])
model.add_initialized_data("alpha", [1.0])
master = "lower" if args.slave == "upper" else "upper"
multiplier = gf.MeshFem(parts[args.slave][0], dim)
multiplier.set_fem(gf.Fem(f"FEM_QK({dim},{args.multiplier})"))
model.add_filtered_fem_variable("lambda", multiplier, CONTACT)
brick = model.add_integral_large_sliding_contact_brick_raytracing("r", 0.4, "friction", "alpha", 1 if not scene.friction else 0)
rules = {name: gf.MeshIm(parts[name][0], gf.Integ(f"IM_GAUSS_PARALLELEPIPED({dim},{2 * args.order + 3})")) for name in parts}
before = {}
for name in parts:
    if scene.friction:
        before[name] = f"w{name[0]}"
        model.add_initialized_fem_data(before[name], parts[name][1], 0 * model.variable(f"u{name[0]}"))
model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, rules[args.slave], CONTACT, f"u{args.slave[0]}", "lambda", *filter(None, [before.get(args.slave)]))
model.add_master_contact_boundary_to_large_sliding_contact_brick(brick, rules[master], CONTACT, f"u{master[0]}", *filter(None, [before.get(master)]))
path = [(0, k / args.steps) for k in range(1, args.steps + 1)] + ([(k / args.steps, 1) for k in range(1, args.steps + 1)] if scene.slide else [])
for across, down in path:
    top = np.zeros(dim)
    top[0], top[upright] = scene.slide * across, -scene.press * down
    model.set_variable("top", top)
    iterations += solve(model)
    for name, data in before.items():
        model.set_variable(data, model.variable(f"u{name[0]}"))

mesh, field, rule = parts["upper"]  # reaction: what the stresses of the disc leave at its top
data = ["mu", 0, np.array([scene.mu]), "kappa", 0, np.array([kappa]), "uu", 1, field, model.variable("uu")]
if args.mixed:
    data += ["pu", 0, model.mesh_fem_of_variable("pu"), model.variable("pu")]
forces = np.ravel(gf.asm_generic(rule, 1, f"({stress_of('u')}):Grad_Test_uu", -1, *data))
top = field.basic_dof_on_region(TOP)
component = 0 if scene.friction else upright
report(abs(forces[top[top % dim == component]].sum()) * scene.fold, sum(parts[n][1].nbdof() for n in parts), iterations, len(path))
