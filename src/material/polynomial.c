/* Solids whose isochoric energy is a polynomial of Y = J^(-2/3) I1 - 3 (docs/theory.md): W = U(J) + c_1 Y + ... + c_5 Y^5.
     yeoh            c_1, c_2, c_3 as given
     arruda_boyce    mu sum_i C_i / locking_stretch^(2i-2) ((Y + 3)^i - 3^i), the first five terms of the eight-chain model's series */
#include "invariants.h"

enum { NUM_POWERS = 5, POWERS = MATERIAL_MAX_PARAMETERS - NUM_POWERS }; /* c_1 ... c_5 stand behind the parameters */

const MaterialParameter MaterialYeohParameters[] = {
    {"c1", "stress", "factor of the first power of the first invariant less 3; shear modulus 2 c1", 0, PETSC_MAX_REAL},
    {"c2", "stress", "factor of the second power; default 0", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"c3", "stress", "factor of the third power; default 0", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {NULL, NULL, NULL, 0, 0},
};

const MaterialParameter MaterialArrudaBoyceParameters[] = {
    {"mu", "stress", "density of chains times temperature; shear modulus mu (1 + 3/5 locking_stretch^-2 + ...)", 0, PETSC_MAX_REAL},
    {"locking_stretch", "1", "stretch at which chains are straight", 1, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {NULL, NULL, NULL, 0, 0},
};

static PetscErrorCode Complete_Private(MaterialSpec *spec, PetscReal kappa)
{
  PetscFunctionBegin;
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: %s knows quadratic and simo, not log", spec->name, spec->law->name);
  spec->mu     = 2 * spec->parameter[POWERS];
  spec->kappa  = kappa;
  spec->lambda = spec->kappa - 2 * spec->mu / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MaterialYeohSetUp(MaterialSpec *spec)
{
  PetscReal *v = spec->parameter;

  PetscFunctionBegin;
  PetscCheckInput(!PetscIsNanReal(v[0]), "material.%s.c1: missing; yeoh needs c1 and kappa", spec->name);
  PetscCheckInput(!PetscIsNanReal(v[3]), "material.%s.kappa: missing; yeoh needs c1 and kappa", spec->name);
  for (int i = 0; i < 3; i++) {
    if (PetscIsNanReal(v[i])) v[i] = 0;
    v[POWERS + i] = v[i];
  }
  v[POWERS + 3] = v[POWERS + 4] = 0;
  PetscCall(Complete_Private(spec, v[3]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MaterialArrudaBoyceSetUp(MaterialSpec *spec)
{
  static const PetscReal series[NUM_POWERS] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};
  PetscReal             *v                  = spec->parameter, factor;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    PetscCheckInput(!PetscIsNanReal(v[k]), "material.%s.%s: missing; arruda_boyce needs mu, locking_stretch and kappa", spec->name,
                    MaterialArrudaBoyceParameters[k].name);
  }
  for (int k = 0; k < NUM_POWERS; k++) v[POWERS + k] = 0;
  factor = v[0];
  for (int i = 1; i <= NUM_POWERS; i++, factor /= v[1] * v[1]) { /* (Y + 3)^i - 3^i by powers of Y */
    PetscReal binomial = 1;

    for (int k = i; k >= 1; k--) { /* i over k */
      v[POWERS + k - 1] += factor * series[i - 1] * binomial * PetscPowRealInt(3, i - k);
      binomial *= (PetscReal)k / (i - k + 1);
    }
  }
  PetscCall(Complete_Private(spec, v[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The response of f(Y): with f = f(Y), f1 = f', f2 = f'', y = dY/dF at fixed J = 2 J^(-2/3) F and Y_J = -2/3 (Y + 3)/J. */
INLINE void PolynomialPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes am1 = LanesExpm1((-2. / 3) * d->lnJ), I1m3 = FirstMinus3(d), Y = am1 * (3 + I1m3) + I1m3;
  const Lanes inverse = 1 / d->J, Y_J = (-2. / 3) * (Y + 3) * inverse;
  Lanes       f = {0}, f1 = {0}, f2 = {0}, h[2], y[9], v[9];

  for (int i = NUM_POWERS; i >= 1; i--) {
    const PetscReal c = spec->parameter[POWERS + i - 1];

    if (i > 1) f2 = f2 * Y + c * i * (i - 1);
    f1 = f1 * Y + c * i;
    f  = (f + c) * Y;
  }
  for (int k = 0; k < 9; k++) y[k] = 2 * (1 + am1) * d->F[k];
  if (r->want_W) r->W = f;
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = f1 * y[k];
  if (r->want_A) {
    for (int k = 0; k < 9; k++) v[k] = (f2 * Y_J - (2. / 3) * inverse * f1) * y[k];
    SetIdentity(r->A, 2 * (1 + am1) * f1);
    AddSquare(r->A, f2, y);
    AddSymmetric(r->A, v, d->cof);
  }
  h[0] = f1 * Y_J;
  h[1] = f2 * Y_J * Y_J + (10. / 9) * f1 * (Y + 3) * inverse * inverse;
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialPolynomial(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(PolynomialPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
