/* How far a body that only contact holds would move along the surface in one linear step.

   Along the surface nothing holds it but the slope of the pressure as it moves, z times a slope: of either sign (a block pressed between two wider ones is
   pushed out towards the nearer edge: in balance, and unstable), small, and only as right as the pressures are. So linear steps move it far, over the next
   nodes and beyond edges, where nothing of the linearisation holds. Such a step is made with forces along the surface on both sides, equal and opposite and
   spread as the contact forces are, which let the bodies slide half the distance of two nodes past each other and no further; the next iteration is without.
   Unlike a shorter step this leaves what is pressed in balance with its new place, and unlike a stiffness it does not ask for the sign of what holds the body.
 */
#include "interfaceimpl.h"

/* P = (1 + A / tiny)^-1 of the supports A of the bodies of one side: what they leave free of a translation. */
static PetscErrorCode Free_Private(Interface p, const Surface *s, PetscReal P[9])
{
  const ForestTables *tables = p->tables;
  const PetscReal    *hold;
  PetscReal           A[9] = {0};

  PetscFunctionBegin;
  PetscCall(MechanicsGetHold(p->mechanics, &hold, NULL));
  for (PetscInt f = 0; f < s->num_facets; ++f)
    for (int i = 0; i < 9; ++i) A[i] += hold[9 * tables->leaf_body[s->facet_leaf[f]] + i];
  const PetscReal trace = A[0] + A[4] + A[8];
  for (int i = 0; i < 9; ++i) A[i] = (i % 4 == 0) + (trace > 0 ? A[i] / (MECHANICS_FREE * trace) : 0);
  for (int i = 0; i < 3; ++i) {
    const PetscReal unit[3] = {i == 0, i == 1, i == 2};
    (void)Solve3(A, unit, P + 3 * i); /* at least 1; rows for columns: P is symmetric */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactFreedom_Private(Interface p, Contact *c)
{
  PetscFunctionBegin;
  c->drifts = PETSC_FALSE;
  for (PetscInt k = 0; k < 2; ++k) {
    PetscCall(Free_Private(p, &c->side[k], c->freedom[k]));
    for (PetscInt d = 0; d < p->dim; ++d) c->drifts = (PetscBool)(c->drifts || c->freedom[k][4 * d] > sqrt(MECHANICS_FREE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Means over the nodes of both sides, weighted with their forces: relative motion and distance of nodes; mean direction n of the forces; their sums. */
static PetscErrorCode Means_Private(Interface p, Contact *c, const PetscReal increment[], PetscReal motion[3], PetscReal n[3], PetscReal *distance,
                                    PetscReal sum[2])
{
  const PetscInt dim     = p->dim;
  PetscReal      all[12] = {0}; /* motion of the sides, force, distance, sums */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    PetscCall(SurfaceGather_Private(p, s, increment, NULL, s->du));
    for (PetscInt i = 0; i < s->num_own; ++i) {
      const PetscInt   j = s->own[i];
      const PetscReal *f = s->force + dim * j, size = PetscSqrtReal(f[0] * f[0] + f[1] * f[1] + (dim == 3 ? f[2] * f[2] : 0));
      for (PetscInt d = 0; d < dim; ++d) {
        all[3 * k + d] += size * s->du[dim * j + d];
        if (k == 0) all[6 + d] += f[d];
      }
      if (k == 0) all[9] += size * c->extent[j];
      all[10 + k] += size;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, 12, MPIU_REAL, MPI_SUM, p->comm));
  for (int k = 0; k < 2; ++k) sum[k] = all[10 + k];
  for (int d = 0; d < 3; ++d) {
    motion[d] = sum[0] > 0 && sum[1] > 0 ? all[d] / sum[0] - all[3 + d] / sum[1] : 0;
    n[d]      = all[6 + d];
  }
  *distance = sum[0] > 0 ? all[9] / sum[0] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Slide of one pair: its direction, length and limit, and sums of the forces' sizes on both sides. */
static PetscErrorCode Slide_Private(Interface p, Contact *c, const PetscReal increment[], PetscReal e[3], PetscReal *length, PetscReal *limit, PetscReal sum[2])
{
  PetscReal t[3], n[3], along[2][3], size, distance;

  PetscFunctionBegin;
  *length = *limit = 0;
  PetscCall(Means_Private(p, c, increment, t, n, &distance, sum));
  size = PetscSqrtReal(Dot3(n, n));
  if (sum[0] == 0 || sum[1] == 0 || size == 0) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal normal = Dot3(t, n) / (size * size);
  for (int d = 0; d < 3; ++d) t[d] -= normal * n[d];
  for (int k = 0; k < 2; ++k)
    for (int d = 0; d < 3; ++d) along[k][d] = Dot3(c->freedom[k] + 3 * d, t);
  const PetscReal *free = Dot3(along[0], along[0]) > Dot3(along[1], along[1]) ? along[0] : along[1];
  *length               = PetscSqrtReal(Dot3(free, free));
  *limit                = 0.5 * distance;
  for (int d = 0; d < 3 && *length > 0; ++d) e[d] = free[d] / *length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A force of node j of side k, factor times e, in the rows of the rigid body that it belongs to. */
static PetscErrorCode AddRigid_Private(const Contact *c, PetscInt k, PetscInt j, const PetscReal e[3], PetscReal factor, Vec force)
{
  const PetscInt dim = c->side[0].dim;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < c->num_q; ++m) {
    PetscReal lever[3];
    if (c->link[k][j] < 0 || c->links + c->link[k][j] != c->q_link[m]) continue;
    RigidLever(c->q_link[m], c->q_motion[m], c->side[k].X + dim * j, dim, lever);
    PetscCall(VecSetValue(force, c->q_row[m], factor * Dot3(e, lever), ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces of sum 1 along e on the nonmortar side, -1 on the mortar side. */
static PetscErrorCode Forces_Private(Interface p, const Contact *c, const PetscReal e[3], const PetscReal sum[2], Vec force)
{
  const PetscInt dim = p->dim;

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(force));
  PetscCall(VecSetOption(force, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    for (PetscInt i = 0; i < s->num_own; ++i) {
      const PetscInt   j = s->own[i];
      const PetscReal *f = s->force + dim * j, size = PetscSqrtReal(f[0] * f[0] + f[1] * f[1] + (dim == 3 ? f[2] * f[2] : 0));
      PetscReal        value[3] = {0, 0, 0};
      for (PetscInt d = 0; d < dim; ++d)
        for (PetscInt a = 0; a < dim; ++a) value[d] += s->frame[dim * (dim * j + d) + a] * e[a] * (k ? -1 : 1) * size / sum[k];
      PetscCall(VecSetValues(force, dim, s->dof + dim * j, value, ADD_VALUES));
      PetscCall(AddRigid_Private(c, k, j, e, (k ? -1 : 1) * size / sum[k], force));
    }
  }
  PetscCall(VecAssemble(force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindSlide(Interface p, const PetscReal increment[], Vec force, PetscReal *excess)
{
  PetscReal worst = 1 + ROUND_LENGTH; /* a slide that is held back already is no more than that */

  PetscFunctionBegin;
  *excess = 0;
  if (p->spec->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact  *c = &p->contacts[i];
    PetscReal e[3], length, limit, sum[2];
    if (ContactIsReleased_Private(p, c) || !c->drifts) continue;
    PetscCall(Slide_Private(p, c, increment, e, &length, &limit, sum));
    if (length <= worst * limit) continue;
    worst   = length / limit;
    *excess = length - limit;
    PetscCall(Forces_Private(p, c, e, sum, force));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
