/* The residual: bulk forces, contact forces, complementarity, volumes of incompressible cells; supports and contact resultants from the same sums. */
#include "problemimpl.h"

PetscErrorCode ProblemSearch(Problem p, Vec x)
{
  PetscReal *local;

  PetscFunctionBegin;
  if (!p->num_contacts || p->scene->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_CONTACT));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < 2; ++k) {
      SurfaceForget_Private(&c->side[k]);
      SurfacePlace_Private(&c->side[k], local, c->side[k].X, c->side[k].x);
    }
    PetscCall(ContactSearch_Private(p, c, PETSC_FALSE, 0.1 * c->distance));
  }
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Square of what round-off of positions leaves in the rows and forces of this rank's active nodes: epsilon |x| (E + z) w0 / extent. */
static PetscReal ContactNoise2_Private(Problem p)
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j      = c->side[0].own[k];
      PetscReal      square = 0;
      for (PetscInt d = 0; d < p->dim; ++d) square += PetscSqr(c->side[0].x[p->dim * j + d]);
      if (c->active[j]) sum += square * PetscSqr(PETSC_MACHINE_EPSILON * (c->w0[j] * (c->c[j] + PetscAbsReal(c->z[j]) / c->extent[j])));
    }
  }
  return sum;
}

/* Bulk and contact forces into the local array r, status summed over ranks. u: local array; pressure: as in MechanicsResidual. */
static PetscErrorCode LocalForces_Private(Problem p, Vec x, const PetscReal u[], const PetscReal pressure[], PetscReal r[], ProblemStatus *status)
{
  MechanicsStatus bulk;
  PetscBool       failed = PETSC_FALSE;
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(PetscArrayzero(r, v->num_nodes * p->dim));
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(MechanicsResidual(p->mechanics, u, pressure, r, &bulk));
  PetscCall(StageEnd(STAGE_ASSEMBLE));
  PetscCall(StageBegin(STAGE_CONTACT));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    PetscCall(ContactEvaluate_Private(p, c, x, u, PETSC_TRUE, PETSC_FALSE, &failed));
    PetscCall(ContactForces_Private(p, c, r));
  }
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscReal sum[6]   = {bulk.energy, bulk.scale2, bulk.bad || failed, bulk.noise2, bulk.drift2, ContactNoise2_Private(p)};
  PetscReal least[3] = {bulk.min_det, -bulk.largest, -bulk.volume};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 3, MPIU_REAL, MPI_MIN, p->comm));
  status->energy  = sum[0];
  status->scale   = PetscSqrtReal(sum[1]);
  status->bad     = (PetscBool)(sum[2] > 0);
  status->min_det = least[0];
  status->volume  = -least[2];
  status->largest = -least[1];
  status->noise   = PetscSqrtReal(sum[3] + PetscSqr(least[1]) * sum[4] + sum[5]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemResidual(Problem p, Vec x, const PetscReal pressure[], Vec r, ProblemStatus *status)
{
  PetscReal *u, *local, *array;
  DM         dm;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetDM(p->space, &dm));
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(LocalForces_Private(p, x, u, pressure, local, status));
  PetscCall(ScalarsMeasure_Private(p, u));
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &local));
  PetscCall(VecGetArray(r, &array));
  PetscCall(VecPlaceArray(p->u_global, array));
  PetscCall(VecSet(p->u_global, 0));
  PetscCall(DMLocalToGlobalBegin(dm, p->r_local, ADD_VALUES, p->u_global));
  PetscCall(DMLocalToGlobalEnd(dm, p->r_local, ADD_VALUES, p->u_global));
  PetscCall(VecResetArray(p->u_global));
  for (PetscInt i = 0; i < p->num_contacts; ++i) ContactRows_Private(&p->contacts[i], array);
  PetscCall(PressureRows_Private(p, array));
  PetscCall(ScalarsResidual_Private(p, x, array));
  PetscCall(VecRestoreArray(r, &array));
  if (p->share > 0) PetscCall(VecAXPY(r, -p->share, p->imbalance));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRefresh(Problem p, Vec x)
{
  ProblemStatus status;
  Vec           r;

  PetscFunctionBegin;
  PetscCall(ProblemCreateVector(p, &r));
  PetscCall(ProblemResidual(p, x, NULL, r, &status));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemForces(Problem p, const State *state, PetscReal reaction[][3], PetscReal force[][3], PetscReal moment[][3], ProblemStatus *status)
{
  PetscReal *u, *r;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &r));
  PetscCall(ProblemSetState(p, state));
  PetscCall(ProblemLocalDisplacement(p, state->x, u));
  PetscCall(LocalForces_Private(p, state->x, u, state->pressure, r, status));
  if (reaction) {
    PetscCall(MechanicsReactions(p->mechanics, r, reaction));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, reaction, (PetscMPIInt)(3 * p->scene->mechanics.num_boundaries), MPIU_REAL, MPI_SUM, p->comm));
  }
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &r));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Surface   *s      = &p->contacts[i].side[0];
    const PetscReal *at     = p->scene->mechanics.kinematics == KINEMATICS_SMALL ? s->X : s->x; /* where the forces act */
    PetscReal        sum[6] = {0}, *f = sum, *m = sum + 3;
    for (PetscInt k = 0; k < s->num_own; ++k) {
      const PetscReal *q = s->force + p->dim * s->own[k], *y = at + p->dim * s->own[k];
      for (PetscInt d = 0; d < p->dim; ++d) f[d] += q[d];
      m[2] += y[0] * q[1] - y[1] * q[0];
      if (p->dim == 2) continue;
      m[0] += y[1] * q[2] - y[2] * q[1];
      m[1] += y[2] * q[0] - y[0] * q[2];
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, p->comm));
    if (force) PetscCall(PetscArraycpy(force[i], f, 3));
    if (moment) PetscCall(PetscArraycpy(moment[i], m, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
