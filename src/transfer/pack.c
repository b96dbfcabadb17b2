/* A state as arrays in an order that every partition shares: displacements by entity (vertices, edges, faces, cells) and the entity's nodes, what belongs to
   cells by leaf, multipliers by node of the nonmortar side. Each rank knows where its own values lie; messages follow from that. */
#include "transferimpl.h"

/* ---- displacements: Cartesian, of true nodes, prescribed ones among them -------------------------------------------------- */

/* First number of each entity's nodes, [num_entities + 1]; hanging entities have none. */
static PetscErrorCode EntityOffsets_Private(HPSpace space, const ForestTables *t, PetscInt **offset)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->num_entities + 1, offset));
  (*offset)[0] = 0;
  for (PetscInt e = 0, d = 0; e < t->num_entities; ++e) {
    PetscInt orders[3], nodes = 1;
    while (e >= t->first[d + 1]) ++d;
    PetscCall(HPSpaceGetAxisOrders(space, e, orders));
    for (PetscInt a = 0; a < d; ++a) nodes *= orders[a] - 1;
    (*offset)[e + 1] = (*offset)[e] + (t->parent[e] >= 0 ? 0 : nodes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places of the true nodes that this rank owns, dim each, and the local nodes they are, node[num/dim]. */
static PetscErrorCode NodePlaces_Private(Problem problem, Places *p, PetscInt **node)
{
  Forest              forest = ProblemForest(problem);
  const ForestTables *t      = ForestGetTables(forest);
  HPSpace             space  = ProblemSpace(problem);
  const HPTables     *v      = HPSpaceGetTables(space);
  PetscMPIInt         rank;
  PetscInt           *offset, num = 0, start = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  PetscCall(EntityOffsets_Private(space, t, &offset));
  PetscCall(PetscMalloc1(v->num_nodes, node));
  PetscCall(PlacesCreate_Private(v->num_nodes * v->dim, offset[t->num_entities] * v->dim, p));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt e = v->node_entity[n];
    if (n && e != v->node_entity[n - 1]) start = n;
    if (t->parent[e] >= 0 || t->leaf_rank[t->entity_leaf[e]] != rank) continue;
    for (PetscInt c = 0; c < v->dim; ++c) p->index[num * v->dim + c] = (offset[e] + n - start) * v->dim + c;
    (*node)[num++] = n;
  }
  p->num = num * v->dim;
  PetscCall(PetscFree(offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PackDisplacement_Private(Problem problem, Vec x, Vec *field)
{
  Places          p;
  HPSpace         space = ProblemSpace(problem);
  const HPTables *v     = HPSpaceGetTables(space);
  PetscInt       *node;
  PetscReal      *u;

  PetscFunctionBegin;
  PetscCall(NodePlaces_Private(problem, &p, &node));
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  for (PetscInt i = 0; i < p.num / v->dim; ++i) PetscCall(TransferTurn_Private(space, v->dim, node[i], PETSC_TRUE, u + node[i] * v->dim, p.value + i * v->dim));
  PetscCall(PlacesSend_Private(PetscObjectComm((PetscObject)x), &p, field));
  PetscCall(PetscFree(u));
  PetscCall(PetscFree(node));
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* *jump: how far prescribed components of the field and of the problem are apart, against the field's largest. */
static PetscErrorCode UnpackDisplacement_Private(Problem problem, Vec field, Vec x, PetscReal *jump)
{
  const PetscInt *global;
  Places          p;
  HPSpace         space = ProblemSpace(problem);
  const HPTables *v     = HPSpaceGetTables(space);
  PetscInt       *node;
  PetscReal      *u, largest;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetGlobalDofs(space, &global));
  PetscCall(NodePlaces_Private(problem, &p, &node));
  PetscCall(PlacesFetch_Private(field, &p));
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  *jump = 0;
  for (PetscInt i = 0; i < p.num / v->dim; ++i) {
    PetscReal d[3];
    PetscCall(TransferTurn_Private(space, v->dim, node[i], PETSC_FALSE, p.value + i * v->dim, d));
    for (PetscInt c = 0, k = node[i] * v->dim; c < v->dim; ++c, ++k) {
      if (global[k] < 0) *jump = PetscMax(*jump, PetscAbsReal(u[k] - d[c]));
      u[k] = d[c];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, jump, 1, MPIU_REAL, MPI_MAX, PetscObjectComm((PetscObject)x)));
  PetscCall(VecNorm(field, NORM_INFINITY, &largest));
  if (*jump > 0) *jump /= largest;
  PetscCall(ProblemSetDisplacement(problem, u, x));
  PetscCall(PetscFree(u));
  PetscCall(PetscFree(node));
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what belongs to cells: a block of any length for each leaf ------------------------------------------------------------- */

/* Where the block of an owned cell lies in this rank's array. */
typedef PetscErrorCode (*BlockRange)(Mechanics, PetscInt cell, PetscInt *first, PetscInt *num);

static PetscErrorCode BlockPlaces_Private(Problem problem, BlockRange range, PetscInt num, Places *p)
{
  const HPTables     *v         = HPSpaceGetTables(ProblemSpace(problem));
  Forest              forest    = ProblemForest(problem);
  const ForestTables *t         = ForestGetTables(forest);
  Mechanics           mechanics = ProblemMechanics(problem);
  PetscInt           *offset, first, size;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->num_leaves + 1, &offset));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) PetscCall(range(mechanics, c, &first, &offset[v->cell_leaf[c] + 1]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, offset, (PetscMPIInt)(t->num_leaves + 1), MPIU_INT, MPI_SUM, ForestComm(forest)));
  for (PetscInt l = 0; l < t->num_leaves; ++l) offset[l + 1] += offset[l];
  PetscCall(PlacesCreate_Private(num, offset[t->num_leaves], p));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscCall(range(mechanics, c, &first, &size));
    for (PetscInt k = 0; k < size; ++k) p->index[first + k] = offset[v->cell_leaf[c]] + k;
  }
  PetscCall(PetscFree(offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* values[num] of this rank to the field, or (back) from it. */
static PetscErrorCode Blocks_Private(Problem problem, BlockRange range, PetscInt num, PetscReal values[], PetscBool back, Vec *field)
{
  Places p;

  PetscFunctionBegin;
  PetscCall(BlockPlaces_Private(problem, range, num, &p));
  if (back) {
    PetscCall(PlacesFetch_Private(*field, &p));
    PetscCall(PetscArraycpy(values, p.value, num));
  } else {
    PetscCall(PetscArraycpy(p.value, values, num));
    PetscCall(PlacesSend_Private(ForestComm(ProblemForest(problem)), &p, field));
  }
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pressures that are unknowns, of incompressible cells: to the field those that act (the state's displacement was asked for last), or back into x. */
static PetscErrorCode Unknowns_Private(Problem problem, Vec x, PetscBool back, Vec *field)
{
  Mechanics  mechanics = ProblemMechanics(problem);
  PetscInt   num, all;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(MechanicsNumUnknowns(mechanics, &num, &all));
  PetscCall(PetscMalloc1(num, &values));
  if (!back) PetscCall(MechanicsGetPressure(mechanics, 0, num, values));
  PetscCall(Blocks_Private(problem, MechanicsUnknownRange, num, values, back, field));
  if (back) PetscCall(ProblemSetPressures(problem, values, x));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- multipliers ----------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode Multipliers_Private(Problem problem, PetscInt pair, Vec x, PetscBool back, Vec *field)
{
  const ContactView *view = InterfaceGetContact(ProblemInterface(problem), pair);
  Places             p;
  PetscReal         *z;
  PetscBool         *own;
  PetscInt           num = 0;

  PetscFunctionBegin;
  const PetscInt nodes = view->nonmortar.num_nodes, total = view->num_z * nodes;
  PetscCall(PetscMalloc2(total, &z, nodes, &own));
  PetscCall(InterfaceGetMultipliers(ProblemInterface(problem), pair, x, z, own));
  PetscCall(PlacesCreate_Private(total, total, &p));
  for (PetscInt j = 0; j < total; ++j) {
    if (own[j % nodes]) p.index[num] = j, p.value[num++] = z[j];
  }
  p.num = num;
  if (back) {
    PetscCall(PlacesFetch_Private(*field, &p));
    for (PetscInt i = 0; i < num; ++i) z[p.index[i]] = p.value[i];
    PetscCall(InterfaceSetMultipliers(ProblemInterface(problem), pair, z, x));
  } else
    PetscCall(PlacesSend_Private(PetscObjectComm((PetscObject)x), &p, field));
  PetscCall(PlacesDestroy_Private(&p));
  PetscCall(PetscFree2(z, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- scalars, and the direction of a path --------------------------------------------------------------------------------------- */

static PetscErrorCode Scalars_Private(Problem problem, Vec x, PetscBool back, Vec *field)
{
  MPI_Comm    comm = PetscObjectComm((PetscObject)x);
  PetscMPIInt rank;
  Places      p;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  const PetscInt num = ProblemNumScalars(problem);
  PetscCall(PlacesCreate_Private(num, num, &p));
  for (PetscInt i = 0; i < num; ++i) p.index[i] = i;
  if (back) {
    PetscCall(PlacesFetch_Private(*field, &p));
    PetscCall(ProblemSetScalars(problem, p.value, x));
  } else {
    PetscCall(ProblemGetScalars(problem, x, p.value));
    if (rank) p.num = 0; /* all ranks have them */
    PetscCall(PlacesSend_Private(comm, &p, field));
  }
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The path goes on from x as it did. */
static PetscErrorCode Follow_Private(Problem problem, Vec field, Vec x)
{
  Vec       direction;
  PetscReal jump;

  PetscFunctionBegin;
  PetscCall(ProblemCreateVector(problem, &direction));
  PetscCall(UnpackDisplacement_Private(problem, field, direction, &jump)); /* of free components only: what is prescribed has no direction */
  PetscCall(ProblemFollowAlong(problem, direction, x));
  PetscCall(VecDestroy(&direction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the whole state ------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode Append_Private(Pack *pack, Vec values, const char *format, const char *name)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(pack->field[pack->num].name, sizeof(pack->field[0].name), format, name));
  pack->field[pack->num++].values = values;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names of a pair's fields; its further parts are numbered. */
static PetscErrorCode Name_Private(const ContactSpec *c, char name[2 * MORTISE_NAME])
{
  PetscFunctionBegin;
  if (c->part)
    PetscCall(PetscSNPrintf(name, 2 * MORTISE_NAME, "%s.%" PetscInt_FMT, c->name, c->part));
  else
    PetscCall(PetscStrncpy(name, c->name, 2 * MORTISE_NAME));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferPack(Problem problem, const State *state, Pack *pack)
{
  const SceneData *scene;
  Vec              field, path;
  char             name[2 * MORTISE_NAME];

  PetscFunctionBegin;
  scene     = ProblemGetScene(problem);
  pack->num = 0;
  PetscCall(PetscMalloc1(7 + 2 * scene->num_contacts, &pack->field));
  ProblemGetPath(problem, &path);
  if (path) {
    PetscCall(PackDisplacement_Private(problem, path, &field)); /* before the displacement: its scalars must act last */
    PetscCall(Append_Private(pack, field, "%s", "path"));
  }
  PetscCall(PackDisplacement_Private(problem, state->x, &field));
  PetscCall(Append_Private(pack, field, "%s", "displacement"));
  PetscCall(Blocks_Private(problem, MechanicsPressureRange, state->num_pressure, state->pressure, PETSC_FALSE, &field));
  PetscCall(Append_Private(pack, field, "%s", "pressure"));
  PetscCall(Blocks_Private(problem, MechanicsHistoryRange, state->num_history, state->history, PETSC_FALSE, &field));
  PetscCall(Append_Private(pack, field, "%s", "history"));
  PetscCall(Blocks_Private(problem, MechanicsHistoryRange, state->num_history, state->fine, PETSC_FALSE, &field));
  PetscCall(Append_Private(pack, field, "%s", "fine_history"));
  PetscCall(Unknowns_Private(problem, state->x, PETSC_FALSE, &field));
  PetscCall(Append_Private(pack, field, "%s", "unknown_pressure"));
  PetscCall(Scalars_Private(problem, state->x, PETSC_FALSE, &field));
  PetscCall(Append_Private(pack, field, "%s", "scalars"));
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    PetscCall(Multipliers_Private(problem, i, state->x, PETSC_FALSE, &field));
    PetscCall(Name_Private(&scene->contacts[i], name));
    PetscCall(Append_Private(pack, field, "multiplier.%s", name));
    PetscCall(PatternPack_Private(problem, i, &field));
    PetscCall(Append_Private(pack, field, "pattern.%s", name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static Vec Look_Private(const Pack *pack, const char *name)
{
  for (PetscInt i = 0; i < pack->num; ++i)
    if (!strcmp(pack->field[i].name, name)) return pack->field[i].values;
  return NULL;
}

/* The field of that name. */
static PetscErrorCode Find_Private(const Pack *pack, const char *format, const char *name, Vec *field)
{
  char full[3 * MORTISE_NAME];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(full, sizeof(full), format, name));
  *field = Look_Private(pack, full);
  PetscCheckInput(*field, "-restart: the checkpoint has no field %s: another version of mortise wrote it", full);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferUnpack(Problem problem, const Pack *pack, State *state, PetscReal *jump)
{
  const SceneData *scene;
  Vec              field;
  char             name[2 * MORTISE_NAME];

  PetscFunctionBegin;
  scene = ProblemGetScene(problem);
  PetscCall(Find_Private(pack, "%s", "unknown_pressure", &field));
  PetscCall(Unknowns_Private(problem, state->x, PETSC_TRUE, &field));
  PetscCall(Find_Private(pack, "%s", "scalars", &field));
  PetscCall(Scalars_Private(problem, state->x, PETSC_TRUE, &field));
  PetscCall(Find_Private(pack, "%s", "displacement", &field));
  PetscCall(UnpackDisplacement_Private(problem, field, state->x, jump));
  if (Look_Private(pack, "path")) PetscCall(Follow_Private(problem, Look_Private(pack, "path"), state->x));
  PetscCall(Find_Private(pack, "%s", "pressure", &field));
  PetscCall(Blocks_Private(problem, MechanicsPressureRange, state->num_pressure, state->pressure, PETSC_TRUE, &field));
  PetscCall(Find_Private(pack, "%s", "history", &field));
  PetscCall(Blocks_Private(problem, MechanicsHistoryRange, state->num_history, state->history, PETSC_TRUE, &field));
  PetscCall(Find_Private(pack, "%s", "fine_history", &field));
  PetscCall(Blocks_Private(problem, MechanicsHistoryRange, state->num_history, state->fine, PETSC_TRUE, &field));
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    PetscCall(Name_Private(&scene->contacts[i], name));
    PetscCall(Find_Private(pack, "multiplier.%s", name, &field));
    PetscCall(Multipliers_Private(problem, i, state->x, PETSC_TRUE, &field));
    PetscCall(Find_Private(pack, "pattern.%s", name, &field));
    PetscCall(PatternUnpack_Private(problem, i, field));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PackDestroy(Pack *pack)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < pack->num; ++i) PetscCall(VecDestroy(&pack->field[i].values));
  PetscCall(PetscFree(pack->field));
  pack->num = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
