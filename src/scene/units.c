/* Units that a scene says it is in. The program computes without any: what is checked is that they agree, and results are labelled with them. */
#include "sceneimpl.h"

enum { UNIT_LENGTH, UNIT_FORCE, UNIT_STRESS, NUM_UNITS };

static const struct {
  const char *name;
  int         kind;
  double      si; /* in m, N, Pa */
} Known[] = {
    {"m", UNIT_LENGTH, 1},
    {"dm", UNIT_LENGTH, 0.1},
    {"cm", UNIT_LENGTH, 1e-2},
    {"mm", UNIT_LENGTH, 1e-3},
    {"um", UNIT_LENGTH, 1e-6},
    {"nm", UNIT_LENGTH, 1e-9},
    {"in", UNIT_LENGTH, 0.0254},
    {"ft", UNIT_LENGTH, 0.3048},
    {"N", UNIT_FORCE, 1},
    {"mN", UNIT_FORCE, 1e-3},
    {"uN", UNIT_FORCE, 1e-6},
    {"nN", UNIT_FORCE, 1e-9},
    {"kN", UNIT_FORCE, 1e3},
    {"MN", UNIT_FORCE, 1e6},
    {"lbf", UNIT_FORCE, 4.4482216152605},
    {"kgf", UNIT_FORCE, 9.80665},
    {"Pa", UNIT_STRESS, 1},
    {"kPa", UNIT_STRESS, 1e3},
    {"MPa", UNIT_STRESS, 1e6},
    {"GPa", UNIT_STRESS, 1e9},
    {"psi", UNIT_STRESS, 4.4482216152605 / (0.0254 * 0.0254)},
    {"ksi", UNIT_STRESS, 4448.2216152605 / (0.0254 * 0.0254)},
};

static const char *const kind_name[NUM_UNITS] = {"length", "force", "stress"};

/* The row of a word; -1: none. */
static int Find_Private(const char *word)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Known); ++i)
    if (!strcmp(Known[i].name, word)) return (int)i;
  return -1;
}

/* The words of the text, one of each kind at most. */
static PetscErrorCode Words_Private(const char *where, const char *text, int row[NUM_UNITS])
{
  char copy[MORTISE_NAME], *rest = copy, *word;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(copy, text, sizeof(copy)));
  for (int k = 0; k < NUM_UNITS; ++k) row[k] = -1;
  while ((word = strtok_r(rest, ", ", &rest))) {
    const int i = Find_Private(word);
    PetscCheckInput(i >= 0,
                    "%s is '%s', where %s is no unit known here; allowed: lengths m dm cm mm um nm in ft, forces N mN uN nN kN MN lbf kgf, stresses "
                    "Pa kPa MPa GPa psi ksi",
                    where, text, word);
    PetscCheckInput(row[Known[i].kind] < 0, "%s is '%s': %s and %s are both units of %s", where, text, Known[row[Known[i].kind]].name, word,
                    kind_name[Known[i].kind]);
    row[Known[i].kind] = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A known unit of stress of this size; NULL: none. */
static const char *Stress_Private(double si)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Known); ++i)
    if (Known[i].kind == UNIT_STRESS && fabs(Known[i].si / si - 1) < 1e-12) return Known[i].name;
  return NULL;
}

PetscErrorCode SceneReadUnits(const char *where, const char *text, SceneUnits *units)
{
  int row[NUM_UNITS];

  PetscFunctionBegin;
  PetscCall(Words_Private(where, text, row));
  PetscCheckInput(row[UNIT_LENGTH] >= 0 && row[UNIT_FORCE] >= 0,
                  "%s is '%s', without a unit of %s; it needs one of length and one of force, and may have the one of stress, as in mm, N, MPa", where, text,
                  kind_name[row[UNIT_LENGTH] < 0 ? UNIT_LENGTH : UNIT_FORCE]);
  const char *const length = Known[row[UNIT_LENGTH]].name, *const force = Known[row[UNIT_FORCE]].name;
  const double      si    = Known[row[UNIT_FORCE]].si / PetscSqr(Known[row[UNIT_LENGTH]].si);
  const char *const named = Stress_Private(si);
  PetscCheckInput(row[UNIT_STRESS] < 0 || fabs(Known[row[UNIT_STRESS]].si / si - 1) < 1e-12,
                  "%s is '%s', but %s is not %s/%s^2, which is %s%s; numbers of a scene go together only when stress is force per length squared", where, text,
                  Known[PetscMax(0, row[UNIT_STRESS])].name, force, length, named ? "" : "no unit of stress with a name of its own", named ? named : "");
  PetscCall(PetscSNPrintf(units->length, sizeof(units->length), "%s", length));
  PetscCall(PetscSNPrintf(units->force, sizeof(units->force), "%s", force));
  if (named)
    PetscCall(PetscSNPrintf(units->stress, sizeof(units->stress), "%s", named));
  else
    PetscCall(PetscSNPrintf(units->stress, sizeof(units->stress), "%s/%s^2", force, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In plane strain forces are per thickness: a length less in what they make. */
PetscErrorCode SceneUnit(const SceneData *scene, const char *kind, size_t size, char unit[])
{
  const SceneUnits *u     = &scene->units;
  const PetscBool   plane = (PetscBool)(scene->mechanics.model == MODEL_PLANE_STRAIN);
  char              energy[64];

  PetscFunctionBegin;
  unit[0] = 0;
  if (!u->length[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(energy, sizeof(energy), plane ? "%s" : "%s %s", u->force, u->length));
  if (!strcmp(kind, "length"))
    PetscCall(PetscSNPrintf(unit, size, "%s", u->length));
  else if (!strcmp(kind, "area"))
    PetscCall(PetscSNPrintf(unit, size, plane ? "%s" : "%s^2", u->length));
  else if (!strcmp(kind, "volume"))
    PetscCall(PetscSNPrintf(unit, size, plane ? "%s^2" : "%s^3", u->length));
  else if (!strcmp(kind, "force"))
    PetscCall(PetscSNPrintf(unit, size, plane ? "%s/%s" : "%s", u->force, u->length));
  else if (!strcmp(kind, "stress"))
    PetscCall(PetscSNPrintf(unit, size, "%s", u->stress));
  else if (!strcmp(kind, "energy") || !strcmp(kind, "force times length"))
    PetscCall(PetscSNPrintf(unit, size, "%s", energy));
  else if (!strcmp(kind, "root of energy"))
    PetscCall(PetscSNPrintf(unit, size, plane ? "%s^0.5" : "(%s)^0.5", energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
