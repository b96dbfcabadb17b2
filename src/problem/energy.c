/* The augmented Lagrangian of frictionless contact: a function of the displacements alone whose minima, with the right multipliers, are the stable equilibria.

     Phi(u; lambda) = Pi(u) + sum_j w_j / (2 kappa_j) (z_j^2 - lambda_j^2),  z_j = max(0, lambda_j - kappa_j g_j),  g_j = gt_j / w_j,  kappa_j = factor c_j;
     dPhi = dPi - sum_j z_j dgt_j + sum_j a_j dw_j,  a_j = (z_j^2 - lambda_j^2) / (2 kappa_j) + z_j g_j,  0 at a solution;
     Hessian: K - sum_j z_j d2gt_j + sum_pressed kappa_j / w_j b_j b_j^T,  b_j = dgt_j - g_j dw_j   (a_j d2w_j, small beside kappa_j, is left out).

   w f(gt/w) is convex in (gt, w) for convex f and goes to 0 with w, so that a barely covered node has no more force than its weight. The Hessian is not made:
   eliminating the multipliers of

     [ K - sum z d2gt   -B^T           ]
     [ -B               -diag(w/kappa) ]

   gives it. That is the symmetric tangent with another diagonal, has its pattern, and as many negative eigenvalues more than constraints as the Hessian has.
   Compliances of constraints and forces at held rims, which have no energy, are left out: gaps, weights and their derivatives are as the mesh has them. */
#include "problemimpl.h"

PetscErrorCode ProblemHasEnergy(Problem p, PetscBool *yes)
{
  PetscBool incompressible;

  PetscFunctionBegin;
  PetscCall(ProblemIsSymmetric(p, yes));
  PetscCall(ProblemIsIncompressible(p, &incompressible));
  if (incompressible || p->num_scalars > 0 || p->viscous || p->share > 0) *yes = PETSC_FALSE;
  if (p->scene->mechanics.kinematics == KINEMATICS_SMALL || MechanicsIsPlastic(&p->scene->mechanics)) *yes = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Constraints without compliance (on false), or as they were. */
static PetscErrorCode Softness_Private(Problem p, PetscBool on)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactPairSetSoftness(p->contacts[i].pair, on ? p->contacts[i].softness : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Pressure_Private(const Contact *c, PetscInt j, PetscReal factor, PetscReal lambda)
{
  return c->has_multiplier[j] && ContactCovered_Private(c, j) ? PetscMax(0, lambda - factor * c->c[j] * c->gap[j] / c->weight[j]) : 0;
}

/* Multipliers of a vector from those of another, or from the gaps: z_j = max(0, lambda_j - kappa_j g_j), lambda_j in change. plus: z_j + lambda_j. */
static PetscErrorCode SetMultipliers_Private(const Contact *c, PetscReal factor, PetscBool plus, Vec x)
{
  PetscReal *to;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &to));
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    if (c->zlocal[j] >= 0) to[c->zlocal[j]] = Pressure_Private(c, j, factor, c->change[j]) + (plus ? c->change[j] : 0);
  }
  PetscCall(VecRestoreArray(x, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyMultipliers_Private(const Contact *c, Vec lambda, Vec x)
{
  const PetscReal *from;
  PetscReal       *to;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(lambda, &from));
  PetscCall(VecGetArray(x, &to));
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt k = c->zlocal[c->side[0].own[i]];
    if (k >= 0) to[k] = from[k];
  }
  PetscCall(VecRestoreArray(x, &to));
  PetscCall(VecRestoreArrayRead(lambda, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part of Phi, lambda_j in change. */
static PetscReal Energy_Private(const Contact *c, PetscReal factor)
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    if (c->zlocal[j] < 0 || !ContactCovered_Private(c, j)) continue;
    sum += c->weight[j] * (PetscSqr(Pressure_Private(c, j, factor, c->change[j])) - PetscSqr(c->change[j])) / (2 * factor * c->c[j]);
  }
  return sum;
}

/* z_j dgt_j - a_j dw_j of this rank's facets into both sides' arrays, lambda_j in change. */
static void FacetForces_Private(Contact *c, PetscReal factor)
{
  const PetscInt dim = c->side[0].dim;

  ContactForcesZero_Private(c);
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    if (!c->mine[e->facet] || !e->dgap) continue;
    for (PetscInt k = 0; k < e->num_rows; ++k) {
      const PetscInt j = e->nodes[k];
      if (!c->has_multiplier[j] || !ContactCovered_Private(c, j)) continue;
      const PetscReal z = Pressure_Private(c, j, factor, c->change[j]);
      const PetscReal a = (z * z - PetscSqr(c->change[j])) / (2 * factor * c->c[j]) + z * c->gap[j] / c->weight[j];
      if (z == 0 && a == 0) continue;
      for (PetscInt n = 0; n < e->num; ++n) {
        PetscReal     *f  = c->side[NODE_SIDE(e->nodes[n])].force + dim * NODE_INDEX(e->nodes[n]);
        const PetscInt at = dim * (k * e->num + n);
        for (PetscInt d = 0; d < dim; ++d) f[d] += z * e->dgap[at + d] - a * e->dweight[at + d];
      }
    }
  }
}

/* The local array r, summed over ranks, as displacement part of a vector; 0 in its other parts. */
static PetscErrorCode ToGlobal_Private(Problem p, Vec gradient)
{
  PetscReal *array;
  DM         dm;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetDM(p->space, &dm));
  PetscCall(VecSet(gradient, 0));
  PetscCall(VecGetArray(gradient, &array));
  PetscCall(VecPlaceArray(p->u_global, array));
  PetscCall(DMLocalToGlobalBegin(dm, p->r_local, ADD_VALUES, p->u_global));
  PetscCall(DMLocalToGlobalEnd(dm, p->r_local, ADD_VALUES, p->u_global));
  PetscCall(VecResetArray(p->u_global));
  PetscCall(VecRestoreArray(gradient, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy and forces of cells and dead loads into the local array r; status but for noise and volume. */
static PetscErrorCode Bulk_Private(Problem p, const PetscReal u[], PetscReal r[], PetscReal *energy, ProblemStatus *status)
{
  MechanicsStatus bulk;
  PetscReal       work;
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(PetscArrayzero(r, v->num_nodes * p->dim));
  PetscCall(MechanicsResidual(p->mechanics, u, NULL, r, &bulk));
  PetscCall(MechanicsDeadWork(p->mechanics, u, &work));
  PetscReal sum[4]   = {bulk.energy, bulk.scale2, bulk.bad, work};
  PetscReal least[2] = {bulk.min_det, -bulk.largest};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 2, MPIU_REAL, MPI_MIN, p->comm));
  *energy = sum[0] - sum[3];
  *status = (ProblemStatus){.energy = sum[0], .scale = PetscSqrtReal(sum[1]), .bad = (PetscBool)(sum[2] > 0), .min_det = least[0], .largest = -least[1]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pair: its part of Phi, its forces off r (NULL: not wanted), its multipliers into x. Derivatives come of facets whose multipliers do not vanish: for them
   x has z + lambda. */
static PetscErrorCode Contact_Private(Problem p, Contact *c, PetscReal factor, Vec lambda, const PetscReal u[], PetscReal r[], Vec x, PetscReal *energy,
                                      PetscBool *failed)
{
  PetscFunctionBegin;
  PetscCall(CopyMultipliers_Private(c, lambda, x));
  PetscCall(ContactEvaluate_Private(p, c, x, u, PETSC_FALSE, PETSC_FALSE, failed));
  PetscCall(PetscArraycpy(c->change, c->z, c->side[0].num_nodes));
  *energy += Energy_Private(c, factor);
  if (r) {
    PetscCall(SetMultipliers_Private(c, factor, PETSC_TRUE, x));
    PetscCall(ContactEvaluate_Private(p, c, x, u, PETSC_TRUE, PETSC_FALSE, failed));
    FacetForces_Private(c, factor);
    PetscCall(ContactForcesSubtract_Private(p, c, r));
  }
  PetscCall(SetMultipliers_Private(c, factor, PETSC_FALSE, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMerit(Problem p, PetscReal factor, Vec lambda, Vec x, Vec gradient, PetscReal *merit, ProblemStatus *status)
{
  PetscReal *u, *r, energy = 0;
  PetscBool  failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &r));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(Bulk_Private(p, u, r, merit, status));
  if (!status->bad) {
    PetscCall(Softness_Private(p, PETSC_FALSE));
    for (PetscInt i = 0; i < p->num_contacts; ++i) {
      PetscCall(Contact_Private(p, &p->contacts[i], factor, lambda, u, gradient ? r : NULL, x, &energy, &failed));
    }
    PetscCall(Softness_Private(p, PETSC_TRUE));
  }
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &r));
  PetscReal sum[2] = {energy, failed};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, p->comm));
  *merit += sum[0];
  if (sum[1] > 0 || PetscIsInfOrNanReal(*merit)) status->bad = PETSC_TRUE;
  if (status->bad) *merit = PETSC_MAX_REAL;
  if (gradient) PetscCall(ToGlobal_Private(p, gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMeritDepth(Problem p, Vec depth)
{
  PetscReal *to;

  PetscFunctionBegin;
  PetscCall(VecSet(depth, 0));
  PetscCall(VecGetArray(depth, &to));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (c->zlocal[j] >= 0) to[c->zlocal[j]] = ContactCovered_Private(c, j) ? PetscMax(0, -c->gap[j] / (c->weight[j] * c->extent[j])) : -1;
    }
  }
  PetscCall(VecRestoreArray(depth, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of the multipliers of this rank: c_j b_j of those that press, each times -1, and the diagonal. */
static PetscErrorCode Rows_Private(Problem p, Contact *c, PetscReal factor)
{
  PetscInt num, at;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    if (c->zlocal[j] < 0) continue;
    PetscCall(ContactNodeGradient_Private(p, c, j, c->active[j] ? -c->c[j] : 0, PETSC_TRUE, &num));
    PetscCall(PetscFindInt(c->zdof[j], num, p->work_index, &at));
    p->work_value[at] = -c->c[j] * (c->active[j] ? c->weight[j] / factor : c->w0[j]);
    PetscCall(ProblemInsert_Private(p, 1, &c->zdof[j], num, p->work_index, p->work_value, INSERT_VALUES));
    PetscCall(ProblemInsert_Private(p, num, p->work_index, 1, &c->zdof[j], p->work_value, INSERT_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Contact at x with its Hessian; which nodes press. alone: none do. */
static PetscErrorCode Contacts_Private(Problem p, Vec x, const PetscReal u[], PetscBool alone, PetscBool *failed)
{
  PetscFunctionBegin;
  PetscCall(Softness_Private(p, PETSC_FALSE));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    PetscCall(ContactEvaluate_Private(p, c, x, u, PETSC_TRUE, PETSC_TRUE, failed));
    for (PetscInt k = 0; k < c->num_valued; ++k) {
      const PetscInt j = c->valued_node[k];
      c->active[j]     = (PetscBool)(!alone && c->has_multiplier[j] && c->z[j] > 0);
    }
  }
  PetscCall(Softness_Private(p, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMeritTangent(Problem p, PetscReal factor, Vec x, Vec lift, PetscBool *bad)
{
  const PetscBool alone = (PetscBool)(lift != NULL), symmetric = p->symmetric;
  PetscReal      *u;
  PetscBool       failed = PETSC_FALSE;
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(Contacts_Private(p, x, u, alone, &failed));
  p->symmetric = PETSC_TRUE;
  p->lifting   = alone;
  p->lift      = lift;
  if (alone) PetscCall(VecZeroEntries(lift));
  if (alone) PetscCall(VecSetOption(lift, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) p->increment[i] = p->target[i] - p->applied[i];
  PetscCall(ProblemReadyMatrix_Private(p));
  PetscCall(MechanicsTangent(p->mechanics, u, NULL, ProblemCellSink_Private, p, bad));
  PetscCall(VecRestoreArray(p->u_local, &u));
  for (PetscInt i = 0; i < p->num_contacts && !alone; ++i) PetscCall(ContactHessians_Private(p, &p->contacts[i]));
  PetscCall(MatAssemblyBegin(p->matrix, MAT_FLUSH_ASSEMBLY));
  PetscCall(MatAssemblyEnd(p->matrix, MAT_FLUSH_ASSEMBLY));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(Rows_Private(p, &p->contacts[i], factor));
  PetscCall(MatAssemblyBegin(p->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(p->matrix, MAT_FINAL_ASSEMBLY));
  if (alone) PetscCall(VecAssemblyBegin(lift));
  if (alone) PetscCall(VecAssemblyEnd(lift));
  p->symmetric = symmetric;
  p->lifting   = PETSC_FALSE;
  p->lift      = NULL;
  int any      = *bad || failed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, p->comm));
  *bad = (PetscBool)any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMeritSide(Problem p, Vec gradient, Vec lift, Vec rhs)
{
  PetscFunctionBegin;
  PetscCall(ProblemReduce_Private(p, gradient, rhs));
  if (lift) PetscCall(VecAXPY(rhs, 1, lift));
  PetscCall(VecScale(rhs, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMeritRecover(Problem p, Vec y, Vec dx)
{
  const PetscBool symmetric = p->symmetric;

  PetscFunctionBegin;
  p->symmetric = PETSC_TRUE;
  PetscCall(ProblemRecover(p, y, dx));
  p->symmetric = symmetric;
  PetscFunctionReturn(PETSC_SUCCESS);
}
