/* From parameters as the user names them to a complete spec, or to a sentence that says what is wrong. */
#include "materialimpl.h"
#include <ctype.h>

const MaterialParameter MaterialElasticParameters[] = {
    {"E", "stress", "Young's modulus", 0, PETSC_MAX_REAL},
    {"nu", "1", "Poisson's ratio; 0.5: incompressible", -1, 0.5},
    {"mu", "stress", "shear modulus", 0, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {"lambda", "stress", "Lame's first parameter", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {NULL, NULL, NULL, 0, 0},
};

/* Edits (insert, delete, replace) from a to b, capitals not counted; names are short. */
static PetscInt Distance_Private(const char *a, const char *b)
{
  PetscInt row[MORTISE_NAME + 1];
  PetscInt na = PetscMin((PetscInt)strlen(a), MORTISE_NAME), nb = PetscMin((PetscInt)strlen(b), MORTISE_NAME);

  for (PetscInt j = 0; j <= nb; j++) row[j] = j;
  for (PetscInt i = 1; i <= na; i++) {
    PetscInt diagonal = row[0];

    row[0] = i;
    for (PetscInt j = 1; j <= nb; j++) {
      const PetscInt replace = diagonal + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]));

      diagonal = row[j];
      row[j]   = PetscMin(replace, 1 + PetscMin(row[j], row[j - 1]));
    }
  }
  return row[nb];
}

/* NULL: the law has none of this name. */
static const MaterialParameter *Find_Private(const MaterialLaw *law, const char name[])
{
  for (const MaterialParameter *p = law->parameters; p->name; p++) {
    if (!strcmp(p->name, name)) return p;
  }
  return NULL;
}

/* An unknown parameter: name the nearest and all known ones. */
static PetscErrorCode Unknown_Private(const MaterialSpec *spec, const char *name)
{
  const MaterialParameter *known = spec->law->parameters, *nearest = known;
  char                     list[256] = "";

  PetscFunctionBegin;
  PetscCheckInput(known->name, "material.%s.%s: the law %s takes no parameters", spec->name, name, spec->law->name);
  for (const MaterialParameter *p = known; p->name; p++) {
    if (Distance_Private(name, p->name) < Distance_Private(name, nearest->name)) nearest = p;
    TextAppend(sizeof(list), list, p == known ? "" : ", ");
    TextAppend(sizeof(list), list, p->name);
  }
  PetscFunctionReturn(ErrorInput("material.%s.%s: unknown; nearest known: %s (%s has %s)", spec->name, name, nearest->name, spec->law->name, list));
}

PetscErrorCode MaterialCheckRange(const MaterialLaw *law, const char name[], PetscReal value, const char where[], const char text[])
{
  const MaterialParameter *p = Find_Private(law, name);

  PetscFunctionBegin;
  if (!p || MaterialIsLimit(p, value) || (value > p->min && value < p->max)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheckInput(p->max == PETSC_MAX_REAL, "%s: %s is not between %g and %g", where, text, (double)p->min, (double)p->max);
  PetscCheckInput(p->min == PETSC_MIN_REAL, "%s: %s is not a finite number above %g", where, text, (double)p->min);
  PetscFunctionReturn(ErrorInput("%s: %s is not a finite number", where, text));
}

static PetscReal Poisson_Private(const MaterialSpec *spec)
{
  const PetscReal ratio = spec->mu / spec->kappa;

  return (3 - 2 * ratio) / (2 * (3 + ratio));
}

/* The elastic pairs E,nu | mu,nu | mu,kappa | mu,lambda; exactly one of them. */
PetscErrorCode MaterialSetUpElastic(MaterialSpec *spec)
{
  static const int8_t pairs[4][2] = {
      {0, 1}, /* E, nu */
      {2, 3}, /* mu, kappa */
      {2, 4}, /* mu, lambda */
      {2, 1}  /* mu, nu */
  };
  PetscReal *v    = spec->parameter;
  PetscInt   pair = -1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; k++) {
    if (pair < 0 && !PetscIsNanReal(v[pairs[k][0]]) && !PetscIsNanReal(v[pairs[k][1]])) pair = k;
  }
  if (pair < 0) {
    const PetscInt missing = !PetscIsNanReal(v[0])                            ? 1
                             : !PetscIsNanReal(v[1])                          ? 0
                             : !PetscIsNanReal(v[2])                          ? 3
                             : !PetscIsNanReal(v[3]) || !PetscIsNanReal(v[4]) ? 2
                                                                              : 0;

    PetscFunctionReturn(ErrorInput("material.%s.%s: missing; %s needs E and nu, or mu and nu, kappa or lambda", spec->name,
                                   MaterialElasticParameters[missing].name, spec->law->name));
  }
  for (PetscInt k = 0; k < 5; k++) {
    PetscCheckInput(PetscIsNanReal(v[k]) || k == pairs[pair][0] || k == pairs[pair][1],
                    "material.%s.%s: one parameter too many; %s takes E and nu, or mu and nu, kappa or lambda", spec->name, MaterialElasticParameters[k].name,
                    spec->law->name);
  }
  const PetscBool ratio = (PetscBool)(pairs[pair][1] == 1);
  const PetscReal E     = pair == 0 ? v[0] : 2 * v[2] * (1 + v[1]); /* with ratio */
  spec->mu              = pair == 0 ? E / (2 * (1 + v[1])) : v[2];
  spec->lambda          = ratio ? E * v[1] / ((1 + v[1]) * (1 - 2 * v[1])) : pair == 1 ? v[3] - 2 * v[2] / 3 : v[4];
  spec->kappa           = ratio ? E / (3 * (1 - 2 * v[1])) : pair == 1 ? v[3] : v[4] + 2 * v[2] / 3;
  PetscCheckInput(spec->kappa > 0, "material.%s.lambda: %g gives the bulk modulus %g, which must be positive", spec->name, (double)v[4], (double)spec->kappa);
  spec->log_modulus = spec->lambda;
  v[0]              = MaterialYoung(spec);
  v[1]              = ratio ? v[1] : Poisson_Private(spec);
  v[2]              = spec->mu;
  v[3]              = spec->kappa;
  v[4]              = spec->lambda;
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define STIFFEST 1e12 /* kappa over mu: beyond, round-off of J times kappa is as large as what shear answers, and an unloaded body already looks balanced */

/* The incompressible limit needs a pressure of its own, and a shear part that feels no change of volume; that of NHc does. */
static PetscErrorCode CheckLimit_Private(MaterialSpec *spec)
{
  PetscFunctionBegin;
  spec->incompressible = (PetscBool)(!spec->law->rigid && PetscIsInfReal(spec->kappa));
  PetscCheckInput(
      spec->law->rigid || spec->incompressible || spec->kappa <= STIFFEST * spec->mu,
      "material.%s.kappa: the bulk modulus %g is more than 1e12 times the shear modulus %g, of which round-off leaves nothing; take inf (incompressible)",
      spec->name, (double)spec->kappa, (double)spec->mu);
  if (!spec->incompressible) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheckInput(!spec->law->whole, "material.%s.law: %s has no incompressible limit (nu: 0.5, kappa: inf); take neo_hookean, or nu below 0.5", spec->name,
                  spec->law->name);
  PetscCheckInput(spec->mixed, "material.%s.formulation: displacements alone cannot keep the volume (kappa: inf, nu: 0.5); take mixed, or nu below 0.5",
                  spec->name);
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: log has no incompressible limit (kappa: inf, nu: 0.5); take quadratic or simo",
                  spec->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Plastic flow keeps the volume as rubber does, and locks cells of displacements alone (docs/theory.md, plasticity). */
static PetscBool KeepsVolume_Private(const MaterialSpec *spec, PetscReal nu)
{
  return (PetscBool)(!spec->law->rigid && (spec->law->plastic || nu >= 0.45 - 1e-12));
}

/* `mixed`: as told, or where the volume is all but kept. The modulus of the pressure must not vanish then. */
static PetscErrorCode ResolveMixed_Private(MaterialSpec *spec)
{
  const PetscReal nu = Poisson_Private(spec);

  PetscFunctionBegin;
  spec->mixed = (PetscBool)(spec->formulation == FORMULATION_MIXED || (spec->formulation == FORMULATION_AUTO && KeepsVolume_Private(spec, nu)));
  PetscCall(CheckLimit_Private(spec));
  PetscCheckInput(!spec->mixed || !spec->law->whole,
                  "material.%s.formulation: %s has no mixed form (meant for nu from 0.45 up, here %g); set formulation: displacement or take neo_hookean",
                  spec->name, spec->law->name, (double)nu);
  PetscCheckInput(!spec->mixed || MaterialVolumetricModulus(spec) > 0, "material.%s.formulation: mixed with volumetric: log needs %s above 0, which is %g",
                  spec->name, spec->log_modulus == spec->lambda ? "lambda" : "kappa - 4/3 c1 - 16/3 c2", (double)spec->log_modulus);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MaterialSetUp(MaterialSpec *spec, PetscInt num, const char *const names[], const PetscReal values[])
{
  PetscFunctionBegin;
  PetscCheck(spec->law, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "Material %s has no law", spec->name);
  for (PetscInt k = 0; k < MATERIAL_MAX_PARAMETERS; k++) spec->parameter[k] = (PetscReal)NAN;
  for (PetscInt i = 0; i < num; i++) {
    const MaterialParameter *p = Find_Private(spec->law, names[i]);
    char                     where[2 * MORTISE_NAME + 16], text[32];

    if (!p) PetscCall(Unknown_Private(spec, names[i]));
    (void)snprintf(where, sizeof(where), "material.%s.%s", spec->name, names[i]);
    (void)snprintf(text, sizeof(text), "%.15g", (double)values[i]);
    PetscCall(MaterialCheckRange(spec->law, names[i], values[i], where, text));
    spec->parameter[p - spec->law->parameters] = values[i];
  }
  PetscCheckInput(!spec->num_fibers || spec->law->fibers, "material.%s.fiber: the law %s has no fibres; hgo has", spec->name, spec->law->name);
  PetscCheckInput(spec->num_fibers || !spec->law->fibers, "material.%s.fiber: missing; %s needs one to %d families, fiber: {a: {angle: 29}}", spec->name,
                  spec->law->name, MATERIAL_MAX_FIBERS);
  PetscCall(spec->law->setup(spec));
  PetscCall(ResolveMixed_Private(spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}
