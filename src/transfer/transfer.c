/* The whole state from one live problem to another. */
#include "transferimpl.h"

/* Tangential tractions in space are vectors; their components belong to the axes of a mesh, of the new one at the state that was carried over. */
static PetscErrorCode Tractions_Private(const TransferContext *c, const ContactView *from, const PetscReal old[], Problem new_problem, PetscInt pair,
                                        const ContactView *to, PetscReal z[])
{
  const PetscInt num_old = from->nonmortar.num_nodes, num = to->nonmortar.num_nodes;
  PetscReal     *old_part, *part, *traction;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(num_old, &old_part, num, &part, 3 * num, &traction));
  for (PetscInt d = 0; d < 3; ++d) {
    for (PetscInt n = 0; n < num_old; ++n) old_part[n] = old[3 * n + d];
    PetscCall(TransferMultiplier_Private(c->old_t, &from->nonmortar, old_part, from->has_multiplier, c->new_t, &to->nonmortar, c->map, part));
    for (PetscInt n = 0; n < num; ++n) traction[3 * n + d] = part[n];
  }
  PetscCall(InterfaceResolveTractions(ProblemInterface(new_problem), pair, traction, z));
  PetscCall(PetscFree3(old_part, part, traction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Multipliers_Private(const TransferContext *c, Problem old_problem, Problem new_problem, PetscInt num_pairs, Vec x)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_pairs; ++i) {
    const ContactView *from, *to;
    PetscReal         *old_z, *z, *traction;
    PetscBool         *wanted;
    from                    = InterfaceGetContact(ProblemInterface(old_problem), i);
    to                      = InterfaceGetContact(ProblemInterface(new_problem), i);
    const PetscInt  num     = from->nonmortar.num_nodes;
    const PetscBool vectors = (PetscBool)(from->slip && from->nonmortar.dim == 3);
    PetscCall(PetscMalloc4(to->num_z * to->nonmortar.num_nodes, &z, from->num_z * num, &old_z, num, &wanted, 3 * num, &traction));
    PetscCall(TransferMultiplierNeeds_Private(c->old_t, &from->nonmortar, &to->nonmortar, c->map, wanted));
    PetscCall(InterfaceFetchContact(ProblemInterface(old_problem), i, wanted, old_z, NULL, NULL, vectors ? traction : NULL));
    for (PetscInt k = 0; k < (vectors ? 1 : from->num_z); ++k)
      PetscCall(TransferMultiplier_Private(c->old_t, &from->nonmortar, old_z + k * num, from->has_multiplier, c->new_t, &to->nonmortar, c->map,
                                           z + k * to->nonmortar.num_nodes));
    if (vectors) PetscCall(Tractions_Private(c, from, traction, new_problem, i, to, z));
    InterfaceResolveTies(ProblemInterface(new_problem), i, z);
    PetscCall(InterfaceSetMultipliers(ProblemInterface(new_problem), i, z, x));
    PetscCall(PetscFree4(z, old_z, wanted, traction));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Axes of tangential tractions in space are those of an evaluation. */
static PetscErrorCode Evaluate_Private(Problem problem, State *s)
{
  PetscFunctionBegin;
  if (!InterfaceSlips(ProblemInterface(problem))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateKeepOrigin(problem, s));
  PetscCall(ProblemSetState(problem, s));
  PetscCall(ProblemSearch(problem, s->x));
  PetscCall(ProblemRefresh(problem, s->x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Scalars_Private(Problem old_problem, Vec from, Problem new_problem, Vec to)
{
  const PetscInt num = ProblemNumScalars(old_problem);
  PetscReal     *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &values));
  PetscCall(ProblemGetScalars(old_problem, from, values));
  PetscCall(ProblemSetScalars(new_problem, values, to));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The history that small steps would have left goes the same way. */
static PetscErrorCode Fine_Private(const TransferContext *c, OldFields fields, const State *from, State *to)
{
  OldCells old;

  PetscFunctionBegin;
  if (!from->num_from) PetscFunctionReturn(PETSC_SUCCESS);
  fields.history = from->fine;
  PetscCall(OldCellsFetch_Private(c, &fields, &old));
  PetscCall(TransferHistory_Private(c, &old, to->fine));
  PetscCall(OldCellsDestroy_Private(&old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferState(Problem old_problem, const State *from, Problem new_problem, const ForestMap *map, State *to)
{
  TransferContext  c = {.map = map};
  OldCells         old;
  const SceneData *scene;
  PetscReal       *u, *unknown;
  PetscInt         num_pressure, num_unknown, all;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_TRANSFER));
  scene           = ProblemGetScene(old_problem);
  c.old_space     = ProblemSpace(old_problem);
  c.new_space     = ProblemSpace(new_problem);
  c.old_mechanics = ProblemMechanics(old_problem);
  c.new_mechanics = ProblemMechanics(new_problem);
  c.spec          = &scene->mechanics;
  c.kept          = scene->adapt.history;
  PetscCall(TransferContextSetUp_Private(&c));
  PetscCall(MechanicsNumPressure(c.new_mechanics, &num_pressure));
  PetscCheck(to->num_pressure == num_pressure, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "state holds %" PetscInt_FMT " pressures, its problem %" PetscInt_FMT,
             to->num_pressure, num_pressure);

  /* Prescribed values are no part of a state: the old problem takes those of the state's time, whichever it stood at. */
  PetscCall(ProblemSetTime(old_problem, from->t));
  PetscCall(ProblemJump(old_problem));
  PetscCall(PetscMalloc1(c.old_v->num_nodes * c.old_v->dim, &u));
  PetscCall(ProblemLocalDisplacement(old_problem, from->x, u));
  const OldFields fields = {.u = u, .pressure = from->pressure, .history = from->history};
  PetscCall(Fine_Private(&c, fields, from, to));
  PetscCall(OldCellsFetch_Private(&c, &fields, &old));
  PetscCall(PetscFree(u));
  PetscCall(PetscCalloc1(c.new_v->num_nodes * c.new_v->dim, &u));
  PetscCall(TransferDisplacement_Private(&c, &old, u));
  PetscCall(ProblemSetDisplacement(new_problem, u, to->x));
  PetscCall(PetscFree(u));
  PetscCall(MechanicsNumUnknowns(c.new_mechanics, &num_unknown, &all));
  PetscCall(PetscMalloc1(num_unknown, &unknown));
  PetscCall(TransferPressure_Private(&c, &old, to->pressure, unknown));
  PetscCall(ProblemSetPressures(new_problem, unknown, to->x));
  PetscCall(PetscFree(unknown));
  PetscCall(TransferHistory_Private(&c, &old, to->history));
  PetscCall(OldCellsDestroy_Private(&old));

  if (scene->num_contacts) PetscCall(ProblemSetState(old_problem, from));
  if (scene->num_contacts) PetscCall(ProblemRefresh(old_problem, from->x));
  if (c.new_t->dim == 3) PetscCall(Evaluate_Private(new_problem, to));
  PetscCall(Multipliers_Private(&c, old_problem, new_problem, scene->num_contacts, to->x));
  PetscCall(Scalars_Private(old_problem, from->x, new_problem, to->x));
  to->form = from->form;
  PetscCall(StageEnd(STAGE_TRANSFER));
  PetscFunctionReturn(PETSC_SUCCESS);
}
