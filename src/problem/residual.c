/* The residual: bulk forces, contact forces, complementarity, volumes of incompressible cells; supports and contact resultants from the same sums. */
#include "problemimpl.h"

static PetscErrorCode Search_Private(Problem p, Vec x, PetscBool goes_on)
{
  PetscReal *local;

  PetscFunctionBegin;
  if (!p->scene->num_contacts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_CONTACT));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  PetscCall(InterfaceSearch(p->interface, x, local, goes_on));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSearch(Problem p, Vec x)
{
  PetscFunctionBegin;
  PetscCall(Search_Private(p, x, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSearchOn(Problem p, Vec x)
{
  PetscFunctionBegin;
  PetscCall(Search_Private(p, x, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bulk and contact forces into the local array r, status summed over ranks. u: local array; pressure: as in MechanicsResidual. */
static PetscErrorCode LocalForces_Private(Problem p, Vec x, const PetscReal u[], const PetscReal pressure[], PetscReal r[], ProblemStatus *status)
{
  MechanicsStatus bulk;
  PetscReal       pending;
  PetscBool       failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(ProblemPending(p, &pending));
  PetscCall(PetscArrayzero(r, p->num_local));
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(MechanicsResidual(p->mechanics, u, pressure, r, &bulk));
  PetscCall(StageEnd(STAGE_ASSEMBLE));
  PetscCall(StageBegin(STAGE_CONTACT));
  PetscCall(InterfaceEvaluate(p->interface, x, u, pending, PETSC_FALSE, &failed));
  PetscCall(InterfaceForces(p->interface, r));
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscReal sum[6]   = {bulk.energy, bulk.scale2, bulk.bad || failed, bulk.noise2, bulk.drift2, InterfaceNoise2(p->interface)};
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

PetscErrorCode ProblemToGlobal_Private(Problem p, PetscReal array[])
{
  const DM dm = HPSpaceGetDM(p->space);

  PetscFunctionBegin;
  PetscCall(VecPlaceArray(p->u_global, array));
  PetscCall(VecSet(p->u_global, 0));
  PetscCall(DMLocalToGlobal(dm, p->r_local, ADD_VALUES, p->u_global));
  PetscCall(VecResetArray(p->u_global));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemResidual(Problem p, Vec x, const PetscReal pressure[], Vec r, ProblemStatus *status)
{
  PetscReal *u, *local, *array;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(LocalForces_Private(p, x, u, pressure, local, status));
  PetscCall(ScalarsMeasure_Private(p, u));
  PetscCall(RigidMeasure_Private(p, local));
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &local));
  PetscCall(VecGetArray(r, &array));
  PetscCall(ProblemToGlobal_Private(p, array));
  InterfaceRows(p->interface, array);
  PetscCall(MechanicsVolumeRows(p->mechanics, array + p->pi_first));
  PetscCall(ScalarsResidual_Private(p, x, array));
  PetscCall(VecRestoreArray(r, &array));
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

PetscErrorCode ProblemForces(Problem p, const State *state, PetscReal reaction[][3], PetscReal support[][3], Resultant body[], PetscReal force[][3],
                             PetscReal moment[][3], ProblemStatus *status)
{
  PetscReal *u, *r;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &r));
  PetscCall(ProblemSetState(p, state));
  PetscCall(ProblemLocalDisplacement(p, state->x, u));
  PetscCall(LocalForces_Private(p, state->x, u, state->pressure, r, status));
  if (body) { /* arrays of boundaries may be of no size */
    PetscCall(MechanicsReactions(p->mechanics, r, reaction));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, reaction, (PetscMPIInt)(3 * p->scene->mechanics.num_boundaries), MPIU_REAL, MPI_SUM, p->comm));
    PetscCall(MechanicsMoments(p->mechanics, r, u, support, body));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, support, (PetscMPIInt)(3 * p->scene->mechanics.num_boundaries), MPIU_REAL, MPI_SUM, p->comm));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, body, (PetscMPIInt)(6 * p->scene->mechanics.num_bodies), MPIU_REAL, MPI_SUM, p->comm));
  }
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &r));
  for (PetscInt i = 0; i < p->scene->num_contacts; ++i) {
    PetscReal f[3], m[3];
    PetscCall(InterfaceResultant(p->interface, i, f, m));
    if (force) PetscCall(PetscArraycpy(force[i], f, 3));
    if (moment) PetscCall(PetscArraycpy(moment[i], m, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
