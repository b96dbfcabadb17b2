/* Roles of contact pairs by what presses. Which corners will meet a smooth face nobody knows at the start. Where a load step tells that the side with corners
   had better carry the multipliers of a pair, the run begins anew with its roles exchanged. Where nothing is found with the side that has corners, it begins
   once more with the softer one, and that stays. */
#include "appimpl.h"

#define MOST 52 /* pairs whose roles may change, as bits of a number in a checkpoint */

static const char *const Names[] = {"exchanged", "settled"};

PetscErrorCode AppReadRoles(App *app)
{
  uint64_t *const bits[] = {&app->exchanged, &app->settled};

  PetscFunctionBegin;
  if (app->restart[0]) PetscCall(CheckpointRead(app->comm, app->restart, &app->snapshot));
  for (int k = 0; k < 2 && app->restart[0]; ++k) {
    PetscReal value;
    PetscCall(CheckpointGetNumber(app->snapshot, Names[k], &value));
    PetscCheckInput(value >= 0 && value < (PetscReal)(UINT64_C(1) << MOST), "-restart: %s of the checkpoint is %g, which tells of no pairs", Names[k],
                    (double)value);
    *bits[k] = (uint64_t)value;
  }
  SceneExchange(app->scene, app->exchanged);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheckRoles(App *app)
{
  uint64_t pairs;

  PetscFunctionBegin;
  PetscCall(InterfaceFindCorners(ProblemInterface(app->level.problem), &pairs));
  pairs &= ~(app->exchanged | app->settled);
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (c->part > 0 || c->given || c->pair >= MOST || app->touched[c->pair] || !(pairs >> c->pair & 1)) continue;
    app->exchanged |= UINT64_C(1) << c->pair;
    app->anew = PETSC_TRUE;
    PetscCall(
        PetscPrintf(app->comm,
                    "note: contact.%s: at t = %.6g a sharp corner of the mortar side presses within a facet of the nonmortar side: the run begins anew with "
                    "their roles exchanged\n",
                    c->name, (double)app->level.state.t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppReturnRoles(App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (c->part > 0 || !c->cornered || c->pair >= MOST || app->settled >> c->pair & 1) continue;
    app->settled |= UINT64_C(1) << c->pair;
    app->exchanged ^= UINT64_C(1) << c->pair;
    app->anew = PETSC_TRUE;
    PetscCall(
        PetscPrintf(app->comm,
                    "note: contact.%s: no equilibrium was found at t = %.6g with the side that has corners as the nonmortar side: the run begins anew with "
                    "the other one\n",
                    c->name, (double)app->level.state.t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
