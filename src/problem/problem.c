/* Life cycle of a problem, its vectors, prescribed motion. */
#include "problemimpl.h"

PetscErrorCode ProblemInitialOrders(const SceneData *scene, Forest forest, int8_t **leaf_order)
{
  const ForestTables *t = ForestGetTables(forest);

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->num_leaves, leaf_order));
  for (PetscInt l = 0; l < t->num_leaves; ++l) (*leaf_order)[l] = (int8_t)scene->bodies[t->leaf_body[l]].order;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boundary groups that are contact faces of order 1. */
static uint64_t LinearGroups_Private(const SceneData *scene)
{
  uint64_t groups = 0;
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    if (!scene->contacts[i].full) groups |= ((uint64_t)1 << scene->contacts[i].nonmortar) | ((uint64_t)1 << scene->contacts[i].mortar);
  }
  return groups;
}

/* Boundary groups that are planes of symmetry: held in one direction, neither moved nor loaded. */
static uint64_t MirrorGroups_Private(const SceneData *scene)
{
  uint64_t groups = 0;
  for (PetscInt i = 0; i < scene->mechanics.num_boundaries; ++i) {
    const BoundarySpec *b     = &scene->mechanics.boundaries[i];
    PetscBool           other = (PetscBool)(b->rotation || BoundaryHasPressure(b));
    PetscInt            held  = b->fix_normal ? 1 : 0;
    for (PetscInt c = 0; c < 3; ++c) {
      held += b->fix[c] ? 1 : 0;
      if (b->displacement[c] || b->traction[c]) other = PETSC_TRUE;
    }
    if (held == 1 && !other) groups |= (uint64_t)1 << b->group;
  }
  return groups;
}

static PetscErrorCode Vectors_Private(Problem p)
{
  PetscFunctionBegin;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, p->num_local, &p->u_local));
  PetscCall(VecDuplicate(p->u_local, &p->r_local));
  PetscCall(PetscCalloc4(p->num_local, &p->target, p->num_local, &p->applied, p->num_local, &p->increment, p->num_local, &p->start_applied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemCreate(const SceneData *scene, Forest forest, const int8_t leaf_order[], Problem *problem)
{
  const Form plain = FormPlain(PETSC_FALSE);
  Problem    p;
  int8_t(*cap)[3];

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_SETUP));
  PetscCall(PetscNew(&p));
  p->scene  = scene;
  p->forest = forest;
  p->comm   = ForestComm(forest);
  PetscCallMPI(MPI_Comm_rank(p->comm, &p->rank));
  PetscCallMPI(MPI_Comm_size(p->comm, &p->size));
  const ForestTables *t = ForestGetTables(forest);
  p->dim                = t->dim;
  ErrorAsked("%" PetscInt_FMT " cells", t->num_leaves);
  PetscCall(PetscMalloc1(t->num_leaves, &p->leaf_order));
  PetscCall(PetscArraycpy(p->leaf_order, leaf_order, t->num_leaves));
  PetscCall(ProblemOrderCaps(scene, forest, &cap));
  PetscCall(HPSpaceCreate(forest, leaf_order, cap, LinearGroups_Private(scene), MirrorGroups_Private(scene), &p->space));
  PetscCall(PetscFree(cap));
  PetscCall(MechanicsSupportsCreate(p->space, &scene->mechanics, &p->supports));
  PetscCall(HPSpaceSetUp(p->space, p->supports.fixed, p->supports.num_frames, p->supports.frame_node, (const PetscReal(*)[9])p->supports.frame));
  p->tables    = HPSpaceGetTables(p->space);
  p->num_local = p->tables->num_nodes * p->dim;
  PetscCall(MechanicsCreate(p->space, &scene->mechanics, &p->supports, &p->mechanics));
  PetscCall(InterfaceCreate(p->space, p->mechanics, &scene->mechanics, p->supports.fixed, scene->num_contacts, scene->contacts, &p->interface));
  PetscCall(ProblemSetForm(p, &plain));
  PetscCall(Vectors_Private(p));
  PetscCall(ScalarsCreate_Private(p));
  PetscCall(ProblemLayout_Private(p));
  ErrorAsked("%" PetscInt_FMT " cells, %" PetscInt_FMT " unknowns", t->num_leaves, p->num_dofs);
  PetscCall(ProblemCreateVector(p, &p->start_x));
  PetscCall(StageEnd(STAGE_SETUP));
  *problem = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemDestroy(Problem *problem)
{
  Problem p = *problem;

  PetscFunctionBegin;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InterfaceDestroy(&p->interface));
  PetscCall(PetscFree(p->leaf_order));
  PetscCall(PetscFree2(p->index, p->row));
  PetscCall(PetscFree2(p->scatter_first, p->scatter));
  PetscCall(PetscFree3(p->u_start, p->p_start, p->row_start));
  PetscCall(PetscFree4(p->target, p->applied, p->increment, p->start_applied));
  PetscCall(RowBufferDestroy(&p->work));
  PetscCall(PressureDestroy_Private(p));
  PetscCall(VecDestroyAll(5, (Vec *[]){&p->u_global, &p->u_local, &p->r_local, &p->prototype, &p->start_x}));
  PetscCall(ScalarsDestroy_Private(p));
  PetscCall(MatDestroy(&p->matrix));
  PetscCall(MechanicsDestroy(&p->mechanics));
  PetscCall(MechanicsSupportsDestroy(&p->supports));
  PetscCall(HPSpaceDestroy(&p->space));
  PetscCall(PetscFree(*problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SceneData *ProblemGetScene(Problem p)
{
  return p->scene;
}

Forest ProblemForest(Problem p)
{
  return p->forest;
}

HPSpace ProblemSpace(Problem p)
{
  return p->space;
}

Mechanics ProblemMechanics(Problem p)
{
  return p->mechanics;
}

Interface ProblemInterface(Problem p)
{
  return p->interface;
}

PetscErrorCode ProblemSetPattern(Problem p, PetscInt pair, const PetscInt first[], const PetscInt node[])
{
  PetscFunctionBegin;
  PetscCall(InterfaceSetPattern(p->interface, pair, first, node));
  PetscCall(MatDestroy(&p->matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemCreateVector(Problem p, Vec *x)
{
  PetscFunctionBegin;
  PetscCall(VecDuplicate(p->prototype, x));
  PetscCall(VecSet(*x, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemGetMatrix(Problem p, Mat *matrix)
{
  PetscFunctionBegin;
  if (!p->matrix) PetscCall(ProblemMatrix_Private(p));
  *matrix = p->matrix;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ProblemGetSymmetric(Problem p)
{
  return p->symmetric;
}

PetscBool ProblemIsSymmetric(Problem p)
{
  return ProblemIsSymmetricBut(p, NULL);
}

PetscBool ProblemIsSymmetricBut(Problem p, const MaterialSpec *but)
{
  const MechanicsSpec *m = &p->scene->mechanics;

  if (p->scene->load.control != LOAD_TIME || !InterfaceIsSymmetric(p->interface) || !RigidIsSymmetric_Private(p)) return PETSC_FALSE;
  for (PetscInt b = 0; b < m->num_boundaries; ++b)
    if (BoundaryHasPressure(&m->boundaries[b]) && m->kinematics == KINEMATICS_FINITE) return PETSC_FALSE;
  for (PetscInt b = 0; b < m->num_bodies; ++b)
    if (m->bodies[b].material != but && m->bodies[b].material->law->unsymmetric) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode ProblemSetState(Problem p, const State *s)
{
  PetscFunctionBegin;
  PetscCall(MechanicsSetHistory(p->mechanics, s->history));
  PetscCall(MechanicsStorePressure(p->mechanics, s->pressure));
  if (s->num_before) PetscCall(InterfaceSetSlipOrigin(p->interface, s->before, s->before + p->num_local));
  PetscCall(ProblemSetForm(p, &s->form));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetForm(Problem p, const Form *form)
{
  PetscFunctionBegin;
  p->form = *form;
  PetscCall(MechanicsSetFlow(p->mechanics, form->edge, form->secant));
  PetscCall(MechanicsSetProximalShift(p->mechanics, form->proximal));
  InterfaceSetForm(p->interface, &p->form);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ProblemNumDofs(Problem p)
{
  return p->num_dofs;
}

PetscErrorCode ProblemNumNegative(Problem p, PetscInt *num)
{
  PetscInt inner;

  PetscFunctionBegin;
  PetscCall(MechanicsNumNegative(p->mechanics, &inner));
  *num = p->num_rows - (p->num_u - p->num_inner) - inner - (p->rank == p->size - 1 ? p->num_rigid : 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, num, 1, MPIU_INT, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemStableSign(Problem p, PetscInt *sign)
{
  PetscInt num, multipliers = p->num_z;

  PetscFunctionBegin;
  PetscCall(ProblemNumNegative(p, &num));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &multipliers, 1, MPIU_INT, MPI_SUM, p->comm));
  *sign = p->num_controls > 0 || p->scene->load.control != LOAD_TIME ? 0 : (num - multipliers) % 2 ? -1 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetTime(Problem p, PetscReal t)
{
  PetscFunctionBegin;
  p->t = t;
  PetscCall(MechanicsSetTime(p->mechanics, t));
  PetscCall(MechanicsPrescribe(p->mechanics, p->target));
  PetscCall(InterfaceSetTime(p->interface, t));
  PetscCall(RigidSetTime_Private(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemJump(Problem p)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(p->applied, p->target, p->num_local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemPending(Problem p, PetscReal *remaining)
{
  PetscFunctionBegin;
  *remaining = 0;
  for (PetscInt i = 0; i < p->num_local; ++i) {
    const PetscReal left = PetscAbsReal(p->target[i] - p->applied[i]);
    if (!(left <= *remaining)) *remaining = PetscIsNanReal(left) ? PETSC_MAX_REAL : left; /* what is no number is never put in */
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, remaining, 1, MPIU_REAL, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The displacement part of a vector, seen as a vector of the space, filled into a local array with given prescribed values. */
static PetscErrorCode FillLocal_Private(Problem p, Vec x, const PetscReal prescribed[], PetscReal local[])
{
  const PetscReal *array;
  Vec              ul;
  const DM         dm = HPSpaceGetDM(p->space);

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(local, prescribed, p->num_local));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->num_local, local, &ul));
  PetscCall(VecGetArrayRead(x, &array));
  PetscCall(VecPlaceArray(p->u_global, array));
  PetscCall(DMGlobalToLocal(dm, p->u_global, INSERT_VALUES, ul));
  PetscCall(VecResetArray(p->u_global));
  PetscCall(VecRestoreArrayRead(x, &array));
  PetscCall(VecDestroy(&ul));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLocalDisplacement(Problem p, Vec x, PetscReal local[])
{
  PetscFunctionBegin;
  PetscCall(ScalarsRead_Private(p, x));
  PetscCall(FillLocal_Private(p, x, p->applied, local));
  RigidMove_Private(p, local);
  PetscCall(PressureSpread_Private(p, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemIncrement_Private(Problem p, Vec dx, PetscReal share)
{
  PetscReal *pending;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p->num_local, &pending));
  for (PetscInt i = 0; i < p->num_local; ++i) pending[i] = share * (p->target[i] - p->applied[i]);
  PetscCall(FillLocal_Private(p, dx, pending, p->increment));
  if (p->num_rigid) {
    PetscReal *change;
    PetscCall(PetscMalloc1(p->num_scalars, &change));
    PetscCall(ProblemGetScalars(p, dx, change));
    RigidIncrement_Private(p, change + p->num_controls, p->increment);
    PetscCall(PetscFree(change));
  }
  PetscCall(PetscFree(pending));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetDisplacement(Problem p, const PetscReal local[], Vec x)
{
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &array));
  for (PetscInt i = 0; i < p->num_local; ++i) {
    const PetscInt row = p->index[i] - p->start;
    if (p->index[i] >= 0 && row >= 0 && row < p->num_u) array[row] = local[i];
  }
  PetscCall(VecRestoreArray(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemWork(Problem p, Vec r, Vec dx, PetscReal *work)
{
  const PetscReal *force, *way;

  PetscFunctionBegin;
  *work = 0;
  PetscCall(VecGetArrayRead(r, &force));
  PetscCall(VecGetArrayRead(dx, &way));
  for (PetscInt i = 0; i < p->num_u; ++i) *work += force[i] * way[i];
  if (RigidLocal_Private(p) >= 0) *work += RigidWork_Private(p, force + RigidLocal_Private(p), way + RigidLocal_Private(p));
  PetscCall(VecRestoreArrayRead(dx, &way));
  PetscCall(VecRestoreArrayRead(r, &force));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemStepBegin(Problem p, Vec x, Vec dx)
{
  PetscFunctionBegin;
  InterfaceKeepSearch(p->interface);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(VecCopy(x, p->start_x));
  PetscCall(PetscArraycpy(p->start_applied, p->applied, p->num_local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers and other unknowns beside displacements to the end of the step. */
static PetscErrorCode Rest_Private(Problem p, Vec dx, Vec x)
{
  const PetscReal *start, *change;
  PetscReal       *values;
  PetscInt         num;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(x, &num));
  PetscCall(VecGetArrayRead(p->start_x, &start));
  PetscCall(VecGetArrayRead(dx, &change));
  PetscCall(VecGetArray(x, &values));
  const PetscInt rigid = RigidLocal_Private(p); /* motions, like displacements */
  for (PetscInt i = p->num_u; i < num; ++i)
    if (rigid < 0 || i < rigid || i >= rigid + p->num_rigid) values[i] = start[i] + change[i];
  PetscCall(VecRestoreArray(x, &values));
  PetscCall(VecRestoreArrayRead(dx, &change));
  PetscCall(VecRestoreArrayRead(p->start_x, &start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemStepMove(Problem p, Vec dx, PetscReal step, PetscBool whole, Vec x)
{
  PetscFunctionBegin;
  PetscCall(VecWAXPY(x, step, dx, p->start_x));
  if (whole) PetscCall(Rest_Private(p, dx, x));
  for (PetscInt i = 0; i < p->num_local; ++i) p->applied[i] = step == 1 ? p->target[i] : p->start_applied[i] + step * (p->target[i] - p->start_applied[i]);
  PetscCall(ProblemSearchOn(p, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemStepAccept(Problem p, PetscReal step, PetscReal pressure[])
{
  PetscFunctionBegin;
  PetscCall(MechanicsUpdatePressure(p->mechanics, p->increment, step, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindInverted(Problem p, PetscInt *order, PetscReal X[3], PetscInt *leaf)
{
  PetscMPIInt first;

  PetscFunctionBegin;
  PetscCall(MechanicsFindInverted(p->mechanics, order, X, leaf));
  PetscCall(RankFirst(p->comm, (PetscBool)(*order > 0), &first));
  if (first < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(order, 1, MPIU_INT, first, p->comm));
  PetscCallMPI(MPI_Bcast(leaf, 1, MPIU_INT, first, p->comm));
  PetscCallMPI(MPI_Bcast(X, 3, MPIU_REAL, first, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindFolded(Problem p, Vec x, int8_t folded[])
{
  const ForestTables *t = ForestGetTables(p->forest);
  PetscReal          *u;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(folded, t->num_leaves));
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(MechanicsFindFolded(p->mechanics, u, folded));
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, folded, (PetscMPIInt)t->num_leaves, MPI_INT8_T, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindConflict(Problem p, PetscReal t, size_t size, char words[])
{
  PetscMPIInt first;

  PetscFunctionBegin;
  PetscCall(MechanicsFindConflict(p->mechanics, t, size, words));
  PetscCall(RankFirst(p->comm, (PetscBool)(words[0] != 0), &first));
  if (first >= 0) PetscCallMPI(MPI_Bcast(words, (PetscMPIInt)size, MPI_CHAR, first, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
