/* Supports that all turn alike turn the bodies with them. From the straight way of a large turn, on which bodies shrink, Newton's method may find another
   state: one with friction that has slipped. So where the whole of what is prescribed is one rotation, a step starts from the last state turned by it. */
#include "problemimpl.h"

/* The turn from one time to another of the first boundary that has one, radians about its axis; 0: none. */
static PetscErrorCode Angle_Private(const MechanicsSpec *m, PetscReal from, PetscReal to, const BoundarySpec **by, PetscReal *angle)
{
  PetscReal degrees[2];

  PetscFunctionBegin;
  *angle = 0;
  if (m->model == MODEL_AXISYMMETRIC || m->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < m->num_boundaries; ++i) {
    *by = &m->boundaries[i];
    if ((*by)->fix_normal) PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < m->num_boundaries && *angle == 0; ++i) {
    *by = &m->boundaries[i];
    if (!(*by)->rotation) continue;
    PetscCall(MechanicsValue((*by)->rotation_angle, &(*by)->amplitude, (*by)->rotation_point, from, &degrees[0]));
    PetscCall(MechanicsValue((*by)->rotation_angle, &(*by)->amplitude, (*by)->rotation_point, to, &degrees[1]));
    *angle = (degrees[1] - degrees[0]) * PETSC_PI / 180;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u: displacements, turned with what they have moved to. */
static void Turn_Private(const HPTables *v, const BoundarySpec *by, PetscReal angle, PetscReal u[])
{
  PetscReal phi[3] = {0, 0, 0}, R[9];

  phi[by->rotation_axis] = angle;
  RotationMatrix(phi, R);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscReal x[3] = {0, 0, 0};

    for (PetscInt c = 0; c < 3; ++c) x[c] = v->X[3 * n + c] + (c < v->dim ? u[v->dim * n + c] : 0) - by->rotation_point[c];
    for (PetscInt c = 0; c < v->dim; ++c) u[v->dim * n + c] = Dot3(R + 3 * c, x) + by->rotation_point[c] - v->X[3 * n + c];
  }
}

PetscErrorCode ProblemTurn(Problem p, PetscReal from, Vec x, PetscBool *turned)
{
  const HPTables     *v = p->tables;
  const BoundarySpec *by;
  PetscReal           angle, off = 0, *u;

  PetscFunctionBegin;
  *turned = PETSC_FALSE;
  PetscCall(Angle_Private(&p->scene->mechanics, from, p->t, &by, &angle));
  if (angle == 0 || p->num_scalars) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(p->num_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  Turn_Private(v, by, angle, u);
  for (PetscInt i = 0; i < p->num_local; ++i)
    if (p->supports.fixed[i / v->dim] >> (i % v->dim) & 1) off = PetscMax(off, PetscAbsReal(u[i] - p->target[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPIU_REAL, MPI_MAX, p->comm));
  if (off <= ROUND_LENGTH * p->extent) {
    *turned = PETSC_TRUE;
    PetscCall(ProblemSetDisplacement(p, u, x));
    PetscCall(ProblemJump(p));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
