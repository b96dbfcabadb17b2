/* The lattice of one facet: its nodes, their masters, its mass matrix in the reference measure; small symmetric solves. */
#include "functionimpl.h"
#include <petscblaslapack.h>

PetscInt ContactLatticeOrder(const ContactSurface *s, PetscInt facet)
{
  return s->order ? s->order[facet] : 1;
}

PetscInt ContactLatticeNodes(const ContactSurface *s, PetscInt facet, PetscInt node[])
{
  static const int corner[4] = {0, 1, 3, 2};
  const PetscInt   num       = s->first ? s->first[facet + 1] - s->first[facet] : 2 * (s->dim - 1);

  for (PetscInt a = 0; a < num; a++) node[a] = s->first ? s->lattice[s->first[facet] + a] : s->facets[num * facet + corner[a]];
  return num;
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
static PetscReal Measure_Private(const ContactSurface *s, PetscBool axisymmetric, PetscInt num, const PetscInt node[], const PetscReal N[],
                                 const PetscReal dN[])
{
  PetscReal d[2][3] = {{0}, {0, 0, 1}}, n[3], radius = 0;

  if (s->dim == 3) d[1][2] = 0;
  for (PetscInt a = 0; a < num; a++) {
    const PetscReal *X = s->X + s->dim * node[a];

    radius += N[a] * X[0];
    for (PetscInt r = 0; r < s->dim - 1; r++)
      for (PetscInt c = 0; c < s->dim; c++) d[r][c] += dN[(s->dim - 1) * a + r] * X[c];
  }
  Cross3(d[0], d[1], n);
  return PetscSqrtReal(Dot3(n, n)) * (axisymmetric ? radius : 1);
}

PetscErrorCode ContactLatticeMass(const ContactSurface *s, PetscInt facet, PetscBool axisymmetric, PetscReal M[], PetscReal D[])
{
  const PetscInt order = ContactLatticeOrder(s, facet);
  const Basis1D *b;
  PetscInt       node[MULTIPLIER_LATTICE], num;
  PetscReal      N[MULTIPLIER_LATTICE], dN[2 * MULTIPLIER_LATTICE];

  PetscFunctionBegin;
  PetscCheck(order >= 1 && order <= MORTISE_MAX_ORDER, PETSC_COMM_SELF, PETSC_ERR_PLIB, "facet %" PetscInt_FMT " of order %" PetscInt_FMT, facet, order);
  num = ContactLatticeNodes(s, facet, node);
  PetscCheck(num == ElementNumNodes(s->dim - 1, order), PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " lattice nodes on a facet of order %" PetscInt_FMT,
             num, order);
  PetscCall(Basis1DGet(order, order + 4, &b));
  PetscCall(PetscArrayzero(M, num * num));
  PetscCall(PetscArrayzero(D, num));
  for (PetscInt q = 0; q < (s->dim == 2 ? 1 : b->num_points); q++)
    for (PetscInt r = 0; r < b->num_points; r++) {
      const PetscReal xi[2] = {b->points[r], b->points[q]};
      PetscReal       weight;

      PetscCall(ElementEvaluate(s->dim - 1, order, xi, N, dN));
      weight = b->weights[r] * (s->dim == 2 ? 1 : b->weights[q]) * Measure_Private(s, axisymmetric, num, node, N, dN);
      for (PetscInt i = 0; i < num; i++) {
        D[i] += weight * N[i];
        for (PetscInt k = 0; k < num; k++) M[num * i + k] += weight * N[i] * N[k];
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
  for (PetscInt i = 0; i < n; i++) *regular = (PetscBool)(*regular && PetscSqr(M[(n + 1) * i]) > 1e-10);
  if (*regular) PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &size, &columns, M, &size, B, &size, &info));
  for (PetscInt k = 0; k < num; k++)
    for (PetscInt i = 0; i < n; i++) B[n * k + i] *= scale[i];
  PetscCall(PetscFree(scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}
