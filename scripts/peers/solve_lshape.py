"""NGSolve on the singular L-shape of inputs/lshape.yml: adaptive triangles of one order, error of the recovered stress, a quarter of the largest marked; true error in the energy norm."""
import math

import ngsolve as ng
from netgen.occ import OCCGeometry, WorkPlane
from ngsolve import Grad, Id, InnerProduct, Sym, Trace, dx, x, y

from scenes import options, report

args = options(__doc__, order=2, passes=10, fraction=0.25)
ng.SetNumThreads(1)
E, NU, A = 1e5, 0.3, 0.544483736782464
MU, LAMBDA = E / 2 / (1 + NU), E * NU / (1 + NU) / (1 - 2 * NU)
pen = WorkPlane().MoveTo(0, 0)
for corner in ((-1, -1), (0, -2), (1, -1), (2, 0), (1, 1), (0, 2), (-1, 1)):
    pen.LineTo(*corner)
plate = pen.Close().Face()
for edge in plate.edges:
    edge.name = "free" if edge.center.x < 0 and abs(abs(edge.center.x) - abs(edge.center.y)) < 1e-9 and math.hypot(edge.center.x, edge.center.y) < 0.8 else "outer"
mesh = ng.Mesh(OCCGeometry(plate, dim=2).GenerateMesh(maxh=1))
r, t = ng.sqrt(x * x + y * y), ng.atan2(y, x)
exact = ng.CF((r**A * (2.3009636771228888e-05 * ng.cos(A * t) - 1.3033708113580929e-05 * ng.cos((2 - A) * t)),
               r**A * (6.316621392757296e-05 * ng.sin(A * t) - 1.3033708113580929e-05 * ng.sin((2 - A) * t))))


def stress(strain):
    return 2 * MU * strain + LAMBDA * Trace(strain) * Id(2)


V = ng.VectorH1(mesh, order=args.order, dirichlet="outer", autoupdate=True)
S = ng.MatrixValued(ng.H1(mesh, order=args.order, autoupdate=True), symmetric=True)
u, v = V.TnT()
a = ng.BilinearForm(V, symmetric=True)
a += InnerProduct(stress(Sym(Grad(u))), Sym(Grad(v))) * dx
solution, recovered = ng.GridFunction(V, autoupdate=True), ng.GridFunction(S, autoupdate=True)
for k in range(args.passes + 1):
    a.Assemble()
    solution.vec[:] = 0
    solution.Set(exact, definedon=mesh.Boundaries("outer"))
    rest = solution.vec.CreateVector()
    rest.data = a.mat * solution.vec
    solution.vec.data -= a.mat.Inverse(V.FreeDofs(), inverse="sparsecholesky") * rest
    if k == args.passes:
        break
    found = stress(Sym(Grad(solution)))
    recovered.Set(found)
    error = ng.Integrate(InnerProduct(found - recovered, found - recovered), mesh, ng.VOL, element_wise=True)
    limit = args.fraction * max(error)
    for element in mesh.Elements():
        mesh.SetRefinementFlag(element, error[element.nr] > limit)
    mesh.Refine()

# a(u, u_h) is the work of the exact tractions on u_h, so |u - u_h|^2 = 2 W(u) + 2 W(u_h) - 2 int t(u) . u_h ds without a quadrature near the corner
strain = ng.CF((exact[0].Diff(x), (exact[0].Diff(y) + exact[1].Diff(x)) / 2, (exact[0].Diff(y) + exact[1].Diff(x)) / 2, exact[1].Diff(y)), dims=(2, 2))
ENERGY = 2.05451244369501353e-4
work = ng.Integrate(InnerProduct(stress(strain) * ng.specialcf.normal(2), solution), mesh, ng.BND, definedon=mesh.Boundaries("outer"), order=4 * args.order + 12)
own = ng.Integrate(InnerProduct(stress(Sym(Grad(solution))), Sym(Grad(solution))), mesh, order=2 * args.order)
report(math.sqrt(max(0, 2 * ENERGY + own - 2 * work) / 2 / ENERGY), sum(V.FreeDofs()), args.passes + 1, 1, energy=own / 2)
