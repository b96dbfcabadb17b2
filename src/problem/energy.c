/* The augmented Lagrangian of frictionless contact: a function of the displacements alone whose minima, with the right multipliers, are the stable equilibria.

     Phi(u; lambda) = Pi(u) + sum_j w_j / (2 kappa_j) (z_j^2 - lambda_j^2),  z_j = max(0, lambda_j - kappa_j g_j),  g_j = gt_j / w_j,  kappa_j = factor c_j;
     dPhi = dPi - sum_j z_j dgt_j + sum_j a_j dw_j,  a_j = (z_j^2 - lambda_j^2) / (2 kappa_j) + z_j g_j,  0 at a solution;
     Hessian: K - sum_j z_j d2gt_j + sum_pressed kappa_j / w_j b_j b_j^T,  b_j = dgt_j - g_j dw_j   (a_j d2w_j, small beside kappa_j, is left out).

   w f(gt/w) is convex in (gt, w) for convex f and goes to 0 with w, so that a barely covered node has no more force than its weight. The Hessian is not made:
   eliminating the multipliers of

     [ K - sum z d2gt   -B^T           ]
     [ -B               -diag(w/kappa) ]

   gives it. That is the symmetric tangent with another diagonal, has its pattern, and as many negative eigenvalues more than constraints as the Hessian has.
   Compliances of constraints and forces of a frozen segmentation, which have no energy, are left out: gaps, weights and their derivatives are as the mesh has
   them. */
#include "problemimpl.h"

PetscBool ProblemHasEnergy(Problem p)
{
  if (!ProblemIsSymmetric(p) || ProblemIsIncompressible(p) || p->num_scalars > 0 || p->viscous || InterfaceTies(p->interface)) return PETSC_FALSE;
  return (PetscBool)(p->scene->mechanics.kinematics != KINEMATICS_SMALL && !MechanicsIsPlastic(&p->scene->mechanics));
}

/* Energy and forces of cells and dead loads into the local array r; status but for noise and volume. */
static PetscErrorCode Bulk_Private(Problem p, const PetscReal u[], PetscReal r[], PetscReal *energy, ProblemStatus *status)
{
  MechanicsStatus bulk;
  PetscReal       work;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(r, p->num_local));
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

PetscErrorCode ProblemMerit(Problem p, PetscReal factor, Vec lambda, Vec x, Vec gradient, PetscReal *merit, ProblemStatus *status)
{
  PetscReal *u, *r, pending, energy = 0;
  PetscBool  failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(VecGetArray(p->r_local, &r));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(Bulk_Private(p, u, r, merit, status));
  if (!status->bad) {
    PetscCall(ProblemPending(p, &pending));
    PetscCall(InterfaceMerit(p->interface, factor, lambda, u, pending, gradient ? r : NULL, x, &energy, &failed));
  }
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCall(VecRestoreArray(p->r_local, &r));
  PetscReal sum[2] = {energy, failed};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, p->comm));
  *merit += sum[0];
  if (sum[1] > 0 || PetscIsInfOrNanReal(*merit)) status->bad = PETSC_TRUE;
  if (status->bad) *merit = PETSC_MAX_REAL;
  if (gradient) {
    PetscCall(VecSet(gradient, 0));
    PetscCall(VecGetArray(gradient, &r));
    PetscCall(ProblemToGlobal_Private(p, r));
    PetscCall(VecRestoreArray(gradient, &r));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMeritTangent(Problem p, PetscReal factor, Vec x, Vec lift, PetscBool *bad)
{
  const PetscBool alone = (PetscBool)(lift != NULL), symmetric = p->symmetric;
  PetscReal      *u, pending;
  PetscBool       failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(ProblemPending(p, &pending));
  PetscCall(InterfaceMeritEvaluate(p->interface, x, u, pending, alone, &failed));
  p->symmetric = PETSC_TRUE;
  p->lift      = lift;
  if (alone) PetscCall(VecZeroEntries(lift));
  if (alone) PetscCall(VecSetOption(lift, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt i = 0; i < p->num_local; ++i) p->increment[i] = p->target[i] - p->applied[i];
  PetscCall(ProblemReadyMatrix_Private(p));
  PetscCall(MechanicsTangent(p->mechanics, u, NULL, ProblemCellSink_Private, p, bad));
  PetscCall(VecRestoreArray(p->u_local, &u));
  const InterfaceSystem system = ProblemSystem_Private(p);
  if (!alone) PetscCall(InterfaceMeritHessians(p->interface, &system));
  PetscCall(MatAssemble(p->matrix, MAT_FLUSH_ASSEMBLY));
  PetscCall(InterfaceMeritRows(p->interface, &system, factor));
  PetscCall(MatAssemble(p->matrix, MAT_FINAL_ASSEMBLY));
  if (alone) PetscCall(VecAssemble(lift));
  p->symmetric = symmetric;
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
