/* Checkpoints in memory: made of a state, or read from a file, and turned into forest and state again. */
#include "outputimpl.h"

#define VALUES "values"  /* field of the caller's, beside those of Pack */
#define SAME_MOTION 1e-9 /* prescribed values that differ by less than this of the largest displacement are the same */

static PetscErrorCode Number_Private(Checkpoint c, const char *name, PetscReal value)
{
  PetscFunctionBegin;
  PetscCall(PetscStrncpy(c->number[c->num_numbers].name, name, sizeof(c->number[0].name)));
  c->number[c->num_numbers++].value = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyForest_Private(Checkpoint c, Forest forest, const State *state)
{
  const ForestTables *t = ForestGetTables(forest);

  PetscFunctionBegin;
  PetscCall(ForestCoarseHash(forest, &c->mesh));
  PetscCall(ForestGetSplits(forest, &c->num_splits, &c->split));
  c->revision   = t->revision;
  c->num_leaves = t->num_leaves;
  PetscCall(PetscMalloc1(c->num_leaves, &c->order));
  PetscCall(PetscArraycpy(c->order, state->leaf_order, c->num_leaves));
  PetscCall(PetscMalloc1(c->num_leaves, &c->owner));
  PetscCall(PetscArraycpy(c->owner, t->leaf_rank, c->num_leaves));
  PetscCallMPI(MPI_Comm_size(c->comm, &c->ranks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointCreate(Problem problem, const State *state, PetscInt num, const CheckpointNumber numbers[], const char *note, Checkpoint *checkpoint)
{
  Forest     forest = ProblemForest(problem);
  Checkpoint c;
  OutputText text = {0};

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  const SceneData  *scene = ProblemGetScene(problem);
  const CoarseMesh *mesh  = ForestGetCoarse(forest);
  PetscCall(PetscCommDuplicate(ForestComm(forest), &c->comm, NULL));
  PetscCall(OutputPhysics(scene, mesh, &text));
  c->physics = text.text;
  PetscCall(PetscStrncpy(c->note, note, sizeof(c->note)));
  PetscCall(CopyForest_Private(c, forest, state));
  PetscCall(PetscMalloc1(num + 2, &c->number));
  PetscCall(Number_Private(c, "t", state->t));
  PetscCall(Number_Private(c, "frozen_segmentation", state->form.frozen_segmentation));
  for (PetscInt i = 0; i < num; ++i) PetscCall(Number_Private(c, numbers[i].name, numbers[i].value));
  PetscCall(TransferPack(problem, state, &c->pack));
  *checkpoint = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointPutValues(Checkpoint c, PetscInt num, const PetscReal values[])
{
  Pack      *pack = &c->pack;
  PetscInt   lo, hi;
  PetscReal *mine;

  PetscFunctionBegin;
  PetscCall(PetscRealloc(sizeof(*pack->field) * (size_t)(pack->num + 1), &pack->field));
  PackField *f = &pack->field[pack->num++];
  PetscCall(PetscStrncpy(f->name, VALUES, sizeof(f->name)));
  PetscCall(VecCreateMPI(c->comm, PETSC_DECIDE, num, &f->values));
  PetscCall(VecGetOwnershipRange(f->values, &lo, &hi));
  PetscCall(VecGetArray(f->values, &mine));
  PetscCall(PetscArraycpy(mine, values + lo, hi - lo));
  PetscCall(VecRestoreArray(f->values, &mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointGetValues(Checkpoint c, PetscInt *num, PetscReal **values)
{
  PetscInt         i = 0;
  const PetscReal *all;
  VecScatter       scatter;
  Vec              whole;

  PetscFunctionBegin;
  *num    = 0;
  *values = NULL;
  while (i < c->pack.num && strcmp(c->pack.field[i].name, VALUES)) ++i;
  if (i == c->pack.num) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecScatterCreateToAll(c->pack.field[i].values, &scatter, &whole));
  PetscCall(VecScatterBegin(scatter, c->pack.field[i].values, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, c->pack.field[i].values, whole, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetLocalSize(whole, num));
  PetscCall(PetscMalloc1(*num, values));
  PetscCall(VecGetArrayRead(whole, &all));
  PetscCall(PetscArraycpy(*values, all, *num));
  PetscCall(VecRestoreArrayRead(whole, &all));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(VecDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointDestroy(Checkpoint *checkpoint)
{
  Checkpoint c = *checkpoint;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(c->physics));
  PetscCall(PetscFree(c->split));
  PetscCall(PetscFree(c->order));
  PetscCall(PetscFree(c->owner));
  PetscCall(PetscFree(c->number));
  PetscCall(PackDestroy(&c->pack));
  PetscCall(PetscCommDestroy(&c->comm));
  PetscCall(PetscFree(*checkpoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointCheck(Checkpoint c, const SceneData *scene, Forest coarse)
{
  const CoarseMesh *mesh;
  uint64_t          hash;
  OutputText        text = {0};
  char              what[2][OUTPUT_DIFFERENCE];

  PetscFunctionBegin;
  PetscCall(ForestCoarseHash(coarse, &hash));
  PetscCheckInput(hash == c->mesh, "-restart %s: it was written on another mesh than %s is meshed with now", c->path, scene->file);
  mesh = ForestGetCoarse(coarse);
  PetscCall(OutputPhysics(scene, mesh, &text));
  PetscCheckInput(!OutputFirstDifference(c->physics, text.text, what), "-restart %s: it was written with '%s', the scene has '%s'", c->path, what[0], what[1]);
  PetscCall(OutputTextDestroy(&text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointForest(Checkpoint c, Forest coarse, Forest *forest)
{
  const CoarseMesh *mesh = ForestGetCoarse(coarse);
  PetscMPIInt       ranks;
  PetscReal        *weight;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(c->comm, &ranks));
  PetscCall(PetscMalloc1(c->num_leaves, &weight));
  for (PetscInt l = 0; l < c->num_leaves; ++l) weight[l] = PetscPowInt(c->order[l], mesh->dim);
  PetscCall(ForestRestore(coarse, c->num_splits, c->split, c->revision, c->num_leaves, ranks == c->ranks ? c->owner : NULL, weight, forest));
  PetscCall(PetscFree(weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointOrders(Checkpoint c, const int8_t **leaf_order)
{
  PetscFunctionBegin;
  *leaf_order = c->order;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointState(Checkpoint c, Problem problem, State *state)
{
  PetscReal jump, frozen;

  PetscFunctionBegin;
  PetscCall(CheckpointGetNumber(c, "t", &state->t));
  PetscCall(CheckpointGetNumber(c, "frozen_segmentation", &frozen));
  state->form = FormPlain((PetscBool)(frozen != 0));
  PetscCall(TransferUnpack(problem, &c->pack, state, &jump));
  PetscCheckInput(jump <= SAME_MOTION,
                  "-restart %s: at t = %g the scene prescribes other displacements than it was written with (difference %.3g of the largest)", c->path,
                  (double)state->t, (double)jump);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointGetNumber(Checkpoint c, const char *name, PetscReal *value)
{
  PetscInt i = 0;

  PetscFunctionBegin;
  while (i < c->num_numbers && strcmp(c->number[i].name, name)) ++i;
  PetscCheckInput(i < c->num_numbers, "-restart %s: it has no number %s: another version of mortise wrote it", c->path, name);
  *value = c->number[i].value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *CheckpointNote(Checkpoint c)
{
  return c->note;
}
