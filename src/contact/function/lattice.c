/* The lattice of one facet: its nodes, their masters, its mass matrix in the reference measure; small symmetric solves. */
#include "functionimpl.h"
#include <petscblaslapack.h>

void ContactFacetLattice(const ContactSurface *s, PetscInt facet, FacetLattice *l)
{
  const PetscInt nv = 2 * (s->dim - 1);

  l->order = s->order ? s->order[facet] : 1;
  l->num   = ElementNumNodes(s->dim - 1, l->order);
  for (PetscInt a = 0; a < nv; a++) l->corner[a] = s->facets[nv * facet + (a < 2 ? a : 5 - a)];
  l->node = s->order ? s->lattice + s->first[facet] : l->corner;
}

PetscBool ContactNodeHangs(const ContactSurface *s, PetscInt n)
{
  return (PetscBool)(s->hang && s->hang[n + 1] > s->hang[n]);
}

PetscInt ContactNodeRow(const ContactSurface *s, const PetscInt *n, const PetscInt **master, const PetscReal **weight)
{
  static const PetscReal one = 1;

  *master = n;
  *weight = &one;
  if (!ContactNodeHangs(s, *n)) return 1;
  *master = s->hang_master + s->hang[*n];
  *weight = s->hang_weight + s->hang[*n];
  return s->hang[*n + 1] - s->hang[*n];
}

/* Length or area of the reference facet per unit of its parameters, times the radius where axisymmetric (2 pi cancels in the functions). */
static PetscReal Measure_Private(const ContactSurface *s, PetscBool axisymmetric, const FacetLattice *l, const PetscReal N[], const PetscReal dN[])
{
  PetscReal d[2][3] = {{0}, {0, 0, s->dim == 2}}, n[3], radius = 0;

  for (PetscInt a = 0; a < l->num; a++) {
    const PetscReal *X = s->X + s->dim * l->node[a];

    radius += N[a] * X[0];
    for (PetscInt r = 0; r < s->dim - 1; r++)
      for (PetscInt c = 0; c < s->dim; c++) d[r][c] += dN[(s->dim - 1) * a + r] * X[c];
  }
  Cross3(d[0], d[1], n);
  return PetscSqrtReal(Dot3(n, n)) * (axisymmetric ? radius : 1);
}

PetscErrorCode ContactLatticeMass(const ContactSurface *s, const FacetLattice *l, PetscBool axisymmetric, PetscReal M[], PetscReal D[])
{
  const PetscInt num = l->num;
  const Basis1D *b;
  PetscReal      N[MULTIPLIER_LATTICE], dN[2 * MULTIPLIER_LATTICE];

  PetscFunctionBegin;
  PetscCheck(l->order >= 1 && l->order <= MORTISE_MAX_ORDER, PETSC_COMM_SELF, PETSC_ERR_PLIB, "facet of order %" PetscInt_FMT, l->order);
  PetscCall(Basis1DGet(l->order, l->order + 4, &b));
  if (M) PetscCall(PetscArrayzero(M, num * num));
  PetscCall(PetscArrayzero(D, num));
  for (PetscInt q = 0; q < PetscPowInt(b->num_points, s->dim - 1); q++) {
    PetscReal xi[2], weight = Basis1DPoint(b, s->dim - 1, q, xi);

    PetscCall(ElementEvaluate(s->dim - 1, l->order, xi, N, dN));
    weight *= Measure_Private(s, axisymmetric, l, N, dN);
    for (PetscInt i = 0; i < num; i++) {
      D[i] += weight * N[i];
      for (PetscInt k = 0; k < num && M; k++) M[num * i + k] += weight * N[i] * N[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactSolveSymmetric(PetscInt n, PetscReal M[], PetscInt num, PetscReal B[], PetscBool *regular)
{
  PetscBLASInt size, columns, info;
  PetscReal   *scale;

  PetscFunctionBegin;
  *regular = PETSC_FALSE;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(num, &columns));
  for (PetscInt i = 0; i < n; i++)
    if (!(M[(n + 1) * i] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &scale));
  for (PetscInt i = 0; i < n; i++) scale[i] = 1 / PetscSqrtReal(M[(n + 1) * i]);
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt k = 0; k < n; k++) M[n * i + k] *= scale[i] * scale[k];
  for (PetscInt k = 0; k < num; k++)
    for (PetscInt i = 0; i < n; i++) B[n * k + i] *= scale[i];
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &size, M, &size, &info));
  *regular = (PetscBool)(info == 0);
  for (PetscInt i = 0; i < n; i++) *regular = (PetscBool)(*regular && PetscSqr(M[(n + 1) * i]) > CONTACT_ROUND);
  if (*regular) PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &size, &columns, M, &size, B, &size, &info));
  for (PetscInt k = 0; k < num; k++)
    for (PetscInt i = 0; i < n; i++) B[n * k + i] *= scale[i];
  PetscCall(PetscFree(scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}
