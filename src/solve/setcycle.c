/* Cycles of the active set. Semi-smooth Newton methods may visit the same few sets again and again where a gap and a pressure vanish together (edges of
   contact, zero load, grazing touch); a set is told by its hash. */
#include "solveimpl.h"

#define SAME 1e-8 /* relative difference of residuals below which two iterates with the same set are the same iterate */

PetscErrorCode SetHistoryAdd_Private(SetHistory *h, uint64_t hash, PetscReal norm, PetscBool compare, PetscBool *repeats)
{
  PetscBool between = PETSC_FALSE;

  PetscFunctionBegin;
  *repeats = PETSC_FALSE;
  for (PetscInt i = h->num - 1; i >= 0 && !*repeats; --i) {
    if (h->hash[i] != hash)
      between = PETSC_TRUE;
    else
      *repeats = (PetscBool)(between && (!compare || PetscAbsReal(norm - h->norm[i]) <= SAME * norm));
  }
  if (h->num == h->size) {
    h->size = 2 * h->size + 8;
    PetscCall(PetscRealloc(h->size * sizeof(*h->hash), &h->hash));
    PetscCall(PetscRealloc(h->size * sizeof(*h->norm), &h->norm));
  }
  h->hash[h->num]   = hash;
  h->norm[h->num++] = norm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SetHistoryDestroy_Private(SetHistory *h)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(h->hash));
  PetscCall(PetscFree(h->norm));
  h->num = h->size = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin_Private(Solver s)
{
  PetscFunctionBegin;
  s->iterate_sets.num = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Verdict_Private(Solver s, Iterate *it, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  PetscCall(SetHistoryAdd_Private(&s->iterate_sets, it->set, it->norm, PETSC_TRUE, acts));
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  it->trouble = "the active set of contact repeats itself";
  it->reason  = SNES_DIVERGED_INNER;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSetCycle = {"set_cycle", "a solve whose iterates come back to the same active set and residual is given up at once",
                                   .begin = Begin_Private, .verdict = Verdict_Private};
