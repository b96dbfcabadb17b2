/* The whole state from one live problem to another. */
#include "transferimpl.h"

static PetscErrorCode Multipliers_Private(const TransferContext *c, Problem old_problem, Problem new_problem, PetscInt num_pairs, Vec x)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_pairs; ++i) {
    const ContactView *from, *to;
    PetscReal         *old_z, *z;
    PetscBool         *wanted;
    PetscCall(InterfaceGetContact(ProblemInterface(old_problem), i, &from));
    PetscCall(InterfaceGetContact(ProblemInterface(new_problem), i, &to));
    PetscCall(PetscMalloc3(to->num_z * to->nonmortar.num_nodes, &z, from->num_z * from->nonmortar.num_nodes, &old_z, from->nonmortar.num_nodes, &wanted));
    PetscCall(TransferMultiplierNeeds_Private(c->old_t, &from->nonmortar, &to->nonmortar, c->map, wanted));
    PetscCall(InterfaceFetchContact(ProblemInterface(old_problem), i, wanted, old_z, NULL, NULL, NULL));
    PetscCall(PetscArrayzero(z, to->num_z * to->nonmortar.num_nodes));
    for (PetscInt k = 0; k < (from->nonmortar.dim == 2 ? from->num_z : 1); ++k) { /* axes of tractions in space belong to their mesh */
      const PetscReal *old = old_z + k * from->nonmortar.num_nodes;
      PetscCall(
          TransferMultiplier_Private(c->old_t, &from->nonmortar, old, from->has_multiplier, c->new_t, &to->nonmortar, c->map, z + k * to->nonmortar.num_nodes));
    }
    PetscCall(InterfaceSetMultipliers(ProblemInterface(new_problem), i, z, x));
    PetscCall(PetscFree3(z, old_z, wanted));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Scalars_Private(Problem old_problem, Vec from, Problem new_problem, Vec to)
{
  PetscInt   num;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(ProblemNumScalars(old_problem, &num));
  PetscCall(PetscMalloc1(num, &values));
  PetscCall(ProblemGetScalars(old_problem, from, values));
  PetscCall(ProblemSetScalars(new_problem, values, to));
  PetscCall(PetscFree(values));
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
  PetscCall(ProblemGetScene(old_problem, &scene));
  PetscCall(ProblemGetSpace(old_problem, &c.old_space));
  PetscCall(ProblemGetSpace(new_problem, &c.new_space));
  PetscCall(ProblemGetMechanics(old_problem, &c.old_mechanics));
  PetscCall(ProblemGetMechanics(new_problem, &c.new_mechanics));
  c.spec = &scene->mechanics;
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
  PetscCall(Multipliers_Private(&c, old_problem, new_problem, scene->num_contacts, to->x));
  PetscCall(Scalars_Private(old_problem, from->x, new_problem, to->x));
  to->form = from->form;
  PetscCall(StageEnd(STAGE_TRANSFER));
  PetscFunctionReturn(PETSC_SUCCESS);
}
