/* The level of the recovered pressure in cells of order 1.

   recover.c adds q cof F to the stress of a mixed cell, q of mean zero, for the mean is the discrete pressure's, which is right where displacements and
   pressures are a stable pair. Cells of order 1 with one pressure each are none: on fine and on adapted meshes their pressures may alternate from cell to cell,
   by as much as kappa lets them, with next to no error in the displacement; the jumps, weighed by 1/mu, would tell of ten times the error. But any q gives an
   upper bound (recover.c), a constant in each cell, c, too: it adds c cof F N to the tractions, nothing to Div P + B, and c^2/kappa to the error of the
   pressure. The least of these bounds is a quadratic problem with one unknown to a cell,

     sum over facets w |d + (c0 - c1) m|^2 + sum over cells v c^2/kappa, m = cof F N,

   whose conjugate gradients end where an iteration takes less than a hundredth off what is left: alternating pressures are the first to go. */
#include "estimateimpl.h"

#define LITTLE 0.01 /* of what is left of the bound: an iteration that takes off less is the last */

/* A facet as a spring between the levels of its two leaves (-1: none): stiffness (c0 - c1)^2 + 2 force (c0 - c1). */
typedef struct {
  PetscInt  leaf[2];
  PetscReal stiffness, force;
} Spring;

typedef struct {
  MPI_Comm   comm;
  PetscInt   num_leaves, num;
  Spring    *springs;    /* owned [num] */
  PetscReal  bound;      /* the sum over facets before, of all ranks */
  PetscReal *compliance; /* owned [num_leaves] the same on all ranks; -1: no level is looked for */
} Levels;

static PetscErrorCode Sum_Private(const Levels *l, PetscReal values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)l->num_leaves, MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which leaves have a level; *any: some has. */
static PetscErrorCode Compliances_Private(const EstimateSum *sum, Levels *l, PetscBool *any)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(l->num_leaves, &l->compliance));
  for (PetscInt i = 0; i < l->num_leaves; ++i) l->compliance[i] = -1;
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) l->compliance[sum->v->cell_leaf[c]] = sum->compliance[c];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, l->compliance, (PetscMPIInt)l->num_leaves, MPIU_REAL, MPI_MAX, l->comm));
  *any = PETSC_FALSE;
  for (PetscInt i = 0; i < l->num_leaves; ++i) *any = (PetscBool)(*any || l->compliance[i] >= 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves of a facet's sides that have a level. */
static void Leaves_Private(const EstimateSum *sum, const Levels *l, const FacetPlace *f, PetscInt leaf[2])
{
  for (PetscInt s = 0; s < 2; ++s) {
    leaf[s] = f->side[s].cell < 0 ? -1 : sum->v->cell_leaf[f->side[s].cell];
    if (leaf[s] >= 0 && l->compliance[leaf[s]] < 0) leaf[s] = -1;
  }
}

/* This rank's share of each facet: that of the sides it owns. */
static PetscErrorCode Springs_Private(const EstimateSum *sum, const PetscReal height[][3], Levels *l)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(sum->facets.num, &l->springs));
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetPlace *f      = &sum->facets.facets[i];
    const PetscInt    end    = i + 1 < sum->facets.num ? sum->facets.facets[i + 1].first_point : sum->facets.num_points;
    const PetscReal   weight = EstimateFacetWeight_Private(sum, f, 0, height) + EstimateFacetWeight_Private(sum, f, 1, height);
    Spring            spring = {.stiffness = 0};
    Leaves_Private(sum, l, f, spring.leaf);
    if (spring.leaf[0] < 0 && spring.leaf[1] < 0) continue;
    for (PetscInt q = f->first_point; q < end; ++q) {
      PetscReal more[3], less[3];
      for (PetscInt c = 0; c < 3; ++c) {
        more[c] = sum->defect[q][c] + sum->flux[q][c];
        less[c] = sum->defect[q][c] - sum->flux[q][c];
      }
      l->bound += weight * sum->dA[q] * EstimateFree_Private(sum, f, q, sum->defect[q]);
      spring.stiffness += weight * sum->dA[q] * EstimateFree_Private(sum, f, q, sum->flux[q]);
      spring.force += weight * sum->dA[q] * (EstimateFree_Private(sum, f, q, more) - EstimateFree_Private(sum, f, q, less)) / 4;
    }
    l->springs[l->num++] = spring;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &l->bound, 1, MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Pull_Private(const Spring *s, PetscReal value, PetscReal to[])
{
  if (s->leaf[0] >= 0) to[s->leaf[0]] += value;
  if (s->leaf[1] >= 0) to[s->leaf[1]] -= value;
}

/* Ax, A the matrix of the quadratic form. Collective. */
static PetscErrorCode Apply_Private(const Levels *l, const PetscReal x[], PetscReal Ax[])
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(Ax, l->num_leaves));
  for (PetscInt i = 0; i < l->num; ++i) {
    const Spring   *s    = &l->springs[i];
    const PetscReal jump = (s->leaf[0] < 0 ? 0 : x[s->leaf[0]]) - (s->leaf[1] < 0 ? 0 : x[s->leaf[1]]);
    Pull_Private(s, s->stiffness * jump, Ax);
  }
  PetscCall(Sum_Private(l, Ax));
  for (PetscInt i = 0; i < l->num_leaves; ++i) Ax[i] += PetscMax(l->compliance[i], 0) * x[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Minus the forces, and the diagonal. Collective. */
static PetscErrorCode Begin_Private(const Levels *l, PetscReal residual[], PetscReal diagonal[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < l->num; ++i) {
    const Spring *s = &l->springs[i];
    Pull_Private(s, -s->force, residual);
    for (PetscInt k = 0; k < 2; ++k)
      if (s->leaf[k] >= 0) diagonal[s->leaf[k]] += s->stiffness;
  }
  PetscCall(Sum_Private(l, residual));
  PetscCall(Sum_Private(l, diagonal));
  for (PetscInt i = 0; i < l->num_leaves; ++i) diagonal[i] += PetscMax(l->compliance[i], 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Product_Private(PetscInt num, const PetscReal a[], const PetscReal b[])
{
  PetscReal total = 0;

  for (PetscInt i = 0; i < num; ++i) total += a[i] * b[i];
  return total;
}

/* Conjugate gradients with the diagonal, the same on all ranks. level: 0 at first. Collective. */
static PetscErrorCode Solve_Private(const Levels *l, PetscReal level[])
{
  const PetscInt n    = l->num_leaves;
  PetscReal      left = l->bound, last = 0, before = 0;
  PetscReal     *residual, *diagonal, *direction, *image;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(n, &residual, n, &diagonal, n, &direction, n, &image));
  PetscCall(Begin_Private(l, residual, diagonal));
  do {
    PetscReal product = 0;
    for (PetscInt i = 0; i < n; ++i)
      if (diagonal[i] > 0) product += PetscSqr(residual[i]) / diagonal[i];
    for (PetscInt i = 0; i < n; ++i) direction[i] = (before > 0 ? product / before * direction[i] : 0) + (diagonal[i] > 0 ? residual[i] / diagonal[i] : 0);
    PetscCall(Apply_Private(l, direction, image));
    const PetscReal curvature = Product_Private(n, direction, image), step = curvature > 0 ? product / curvature : 0;
    for (PetscInt i = 0; i < n; ++i) {
      level[i] += step * direction[i];
      residual[i] -= step * image[i];
    }
    before = product;
    last   = step * product;
    left -= last;
  } while (last > LITTLE * left && left > 0);
  PetscCall(PetscFree4(residual, diagonal, direction, image));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the levels add to defects, and to the error of the pressure. */
static void Add_Private(EstimateSum *sum, const Levels *l, const PetscReal level[])
{
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetPlace *f   = &sum->facets.facets[i];
    const PetscInt    end = i + 1 < sum->facets.num ? sum->facets.facets[i + 1].first_point : sum->facets.num_points;
    PetscInt          leaf[2];
    Leaves_Private(sum, l, f, leaf);
    const PetscReal jump = (leaf[0] < 0 ? 0 : level[leaf[0]]) - (leaf[1] < 0 ? 0 : level[leaf[1]]);
    for (PetscInt q = f->first_point; q < end; ++q)
      for (PetscInt c = 0; c < 3; ++c) sum->defect[q][c] += jump * sum->flux[q][c];
  }
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) {
    const PetscInt leaf = sum->v->cell_leaf[c];
    if (sum->compliance[c] < 0) continue;
    const PetscReal square = sum->compliance[c] * PetscSqr(level[leaf]);
    sum->eta2[leaf] += square;
    sum->part[PART_VOLUME] += square;
  }
}

PetscErrorCode EstimateLevels_Private(EstimateSum *sum, MPI_Comm comm, const PetscReal height[][3])
{
  Levels     l = {.comm = comm, .num_leaves = sum->t->num_leaves};
  PetscReal *level;
  PetscBool  any;

  PetscFunctionBegin;
  PetscCall(Compliances_Private(sum, &l, &any));
  if (any) {
    PetscCall(PetscCalloc1(l.num_leaves, &level));
    PetscCall(Springs_Private(sum, height, &l));
    PetscCall(Solve_Private(&l, level));
    Add_Private(sum, &l, level);
    PetscCall(PetscFree(level));
    PetscCall(PetscFree(l.springs));
  }
  PetscCall(PetscFree(l.compliance));
  PetscFunctionReturn(PETSC_SUCCESS);
}
