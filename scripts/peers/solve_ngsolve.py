"""NGSolve: curved triangles and tetrahedra of any order, contact by the penalty of its ContactBoundary, full Newton with load steps."""
import math

import netgen.meshing
import ngsolve as ng
from netgen.occ import Box, Compound, MoveTo, OCCGeometry, Pnt, Sphere, WorkPlane
from ngsolve import Det, Grad, Id, IfPos, InnerProduct, Norm, Variation, ds, dx, x, y, z

from scenes import COOK, CYLINDER, SCENES, options, report

args = options(__doc__, order=2, h=0.2, hmin=0.0, hcorner=0.0, gamma=1e3, steps=1, solver="sparsecholesky", mixed=0, reach=0.25, tol=1e-7)
ng.SetNumThreads(1)
scene = SCENES.get(args.scene)
dim = scene.dim if scene else 2


def name_edges(shape, rules, other):
    for part in shape.edges if dim == 2 else shape.faces:
        part.name = next((name for name, axis, value in rules if abs(part.center[axis] - value) < 1e-9), other)
    return shape


def half_disc_on_block():
    disc = WorkPlane().MoveTo(0, 1).Circle(1).Face() * MoveTo(0 if scene.half else -2, -0.5).Rectangle(2 if scene.half else 4, 1.5).Face()
    block = MoveTo(0 if scene.half else -scene.width, -scene.height).Rectangle(scene.width * (1 if scene.half else 2), scene.height).Face()
    axis = [("axis", 0, 0)] if scene.half else []
    name_edges(disc, [("top", 1, 1), *axis], "arc")
    name_edges(block, [("bottom", 1, -scene.height), ("face", 1, 0), *axis], "side")
    return OCCGeometry(Compound([disc, block]), dim=2)


def half_ball_on_block():
    ball = Sphere(Pnt(0, 0, 1), 1) * Box(Pnt(0, 0, -0.5), Pnt(2, 2, 1))
    block = Box(Pnt(0, 0, -1), Pnt(1, 1, 0))
    name_edges(ball, [("axis", 0, 0), ("axis2", 1, 0), ("top", 2, 1)], "arc")
    name_edges(block, [("axis", 0, 0), ("axis2", 1, 0), ("bottom", 2, -1), ("face", 2, 0)], "side")
    return OCCGeometry(Compound([ball, block]))


def quarter_cylinder():
    r = CYLINDER["radius"]
    return OCCGeometry(name_edges(WorkPlane().Circle(r).Face() * MoveTo(0, -1).Rectangle(1, 1).Face(), [("axis", 0, 0), ("top", 1, 0)], "arc"), dim=2)


def membrane():
    pen = WorkPlane().MoveTo(*COOK["corners"][0])
    for corner in COOK["corners"][1:]:
        pen.LineTo(*corner)
    return OCCGeometry(name_edges(pen.Close().Face(), [("left", 0, 0), ("right", 0, 48)], "free"), dim=2)


def zone():
    """Points about which cells are small: both sides of the contact."""
    r = CYLINDER["radius"] if args.scene == "cylinder" else 1
    reach, shift = args.reach * r, -r if args.scene == "cylinder" else 0
    count = math.ceil(reach / args.hmin)
    across = [k * reach / count for k in range(count + 1)]
    if scene and not scene.half:  # wherever the disc goes
        return [(a, b, 0) for k in range(-count, count + 1) for a, b in [(k * reach / count, 1 - math.sqrt(1 - (k * reach / count) ** 2))]] + [
            (k * args.hmin - reach, 0, 0) for k in range(int((2 * reach + scene.slide) / args.hmin) + 1)]
    if dim == 2:
        return [(a, b + shift, 0) for a in across for b in (0, r - math.sqrt(r * r - a * a))]
    return [(a, b, c) for a in across for b in across for c in (0, 1 - math.sqrt(1 - a * a - b * b))]


def generate(geometry):
    sizes = netgen.meshing.MeshingParameters(maxh=args.h, grading=0.25 if args.hmin or args.hcorner else 0.5)
    if args.hmin:
        for point in zone():
            sizes.RestrictH(*point, h=args.hmin)
    if args.hcorner:
        for point in [(*c, 0) for c in COOK["corners"]] if args.scene == "cook" else [(1, 1, 0), (1, -1, 0)]:
            sizes.RestrictH(*point, h=args.hcorner)
    mesh = ng.Mesh(geometry.GenerateMesh(sizes))
    mesh.Curve(args.order)
    return mesh


mesh = generate({"cylinder": quarter_cylinder, "cook": membrane, "hertz3d": half_ball_on_block}.get(args.scene, half_disc_on_block)())
held = {"top": "xyz", "bottom": "xyz", "axis": "x", "axis2": "y", "left": "xyz"}
if args.scene == "cylinder":
    held["top"] = "y"
fixed = {axis: "|".join(name for name, axes in held.items() if axis in axes) for axis in "xyz"[:dim]}
V = ng.VectorH1(mesh, order=args.order, **{f"dirichlet{axis}": names for axis, names in fixed.items()})
space = V * ng.H1(mesh, order=args.order - 1) if args.mixed else V
(u, p) = space.TrialFunction() if args.mixed else (space.TrialFunction(), None)

F = Grad(u) + Id(dim)
J, I1 = Det(F), InnerProduct(F, F) + (3 - dim)


def volume(kappa):
    """Energy of the change of volume, of a pressure where it is an unknown."""
    if not args.mixed:
        return kappa / 2 * (J - 1) ** 2
    return p * (J - 1) - (p * p / 2 / kappa if kappa else 0)


if args.scene == "cylinder":
    C = F.trans * F
    I2 = (I1**2 - InnerProduct(C, C) - 1) / 2  # plane strain: the third stretch is 1
    unit = CYLINDER["c1"]  # of stress
    bulk = J ** (-2 / 3) * I1 - 3 + CYLINDER["c2"] / unit * (J ** (-4 / 3) * I2 - 3) + volume(CYLINDER["kappa"] / unit)
elif args.scene == "cook":
    bulk = COOK["mu"] / 2 * (J ** (-2 / 3) * I1 - 3) + volume(None)
else:
    bulk = scene.mu / 2 * (J ** (-2 / 3) * I1 - 3) + volume(scene.kappa)
A = ng.BilinearForm(space, symmetric=args.solver == "sparsecholesky")
A += Variation(bulk.Compile() * dx)
solution = ng.GridFunction(space)
U = solution.components[0] if args.mixed else solution
plane, load, gamma = ng.Parameter(0), ng.Parameter(0), ng.Parameter(args.gamma)
contact = None
if args.scene == "cook":
    A += Variation(-load * COOK["traction"] * u[1] * ds("right"))
elif args.scene == "cylinder":  # a rigid plate: no search, the deformed surface is exact
    depth = plane - CYLINDER["radius"] - (y + u[1])
    A += Variation(IfPos(depth, 0.5 * gamma / CYLINDER["radius"] * depth * depth, 0) * ds("arc", bonus_intorder=2))
else:
    contact = ng.ContactBoundary(mesh.Boundaries("arc"), mesh.Boundaries("face"))
    X = ng.CoefficientFunction((x, y, z)[:dim])
    depth = InnerProduct(X + u - X.Other() - u.Other(), contact.normal)
    contact.AddEnergy(IfPos(depth, 0.5 * gamma * scene.E * depth * depth, 0))
free, force, step = space.FreeDofs(), solution.vec.CreateVector(), solution.vec.CreateVector()
iterations = 0


def linearise():
    if contact:
        contact.Update(U, A, intorder=2 * args.order + 2, maxdist=0.6 if scene.press < 0.1 and dim == 2 else 0.25)
    A.Apply(solution.vec, force)
    A.AssembleLinearization(solution.vec)
    return A.mat.Inverse(free, inverse=args.solver)


def newton():
    global iterations
    for _ in range(40):
        step.data = linearise() * force
        solution.vec.data -= step
        size = Norm(step) / Norm(solution.vec)
        iterations += 1
        if not math.isfinite(size):
            return False
        if size < args.tol:
            return True
    return False


def move(across, down):
    """Prescribe an increment at the top; the tangent carries it into the bodies."""
    change = ng.GridFunction(space)
    (change.components[0] if args.mixed else change).Set(ng.CF((across, down) if dim == 2 else (0, 0, down)), definedon=mesh.Boundaries("top"))
    inverse = linearise()
    force.data = A.mat * change.vec
    solution.vec.data += change.vec - inverse * force


def equilibrium():
    """Newton's method with the penalty raised in decades, from a hundred."""
    values = [args.gamma]
    while values[0] > 101:
        values.insert(0, values[0] / 10)
    for value in values:
        gamma.Set(value)
        if not newton():
            raise SystemExit("no equilibrium")


steps = max(args.steps, 1)
for k in range(1, steps + 1):
    if args.scene == "cook":
        load.Set(k / steps)
    elif args.scene == "cylinder":
        plane.Set(CYLINDER["press"] * k / steps)
    else:
        move(0, -scene.press / steps)
    equilibrium()
if scene and scene.slide:
    for k in range(steps):
        move(scene.slide / steps, 0)
        equilibrium()
if args.scene == "cook":
    value = U(mesh(48, 60))[1]
else:
    linearise()
    one = ng.GridFunction(space)
    (one.components[0] if args.mixed else one).Set(ng.CF((0,) * (dim - 1) + (1,)), definedon=mesh.Boundaries("top"))
    value = abs(InnerProduct(force, one.vec)) * (2 * unit / 1e3 if args.scene == "cylinder" else scene.fold)
report(value, sum(free), iterations, steps)
