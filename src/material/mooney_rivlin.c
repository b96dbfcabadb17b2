/* Mooney-Rivlin solid. With the quadratic or Simo's volume term (docs/theory.md) W = U(J) + c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3),
   with the logarithmic one
     W = c1 (I1 - 3) + c2 (I2 - 3) - (2 c1 + 4 c2) ln J + log_modulus/2 (ln J)^2.
   To second order in the strain e the terms of c2 are 2 c2 (e:e + (tr e)^2): of Lame's first parameter 4 c2 is in them. */
#include "invariants.h"

const MaterialParameter MaterialMooneyRivlinParameters[] = {
    {"c1", "stress", "factor of the first invariant; shear modulus 2 (c1 + c2)", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"c2", "stress", "factor of the second invariant", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {NULL, NULL, NULL, 0, 0},
};

PetscErrorCode MaterialMooneyRivlinSetUp(MaterialSpec *spec)
{
  const PetscReal c1 = spec->parameter[0], c2 = spec->parameter[1], kappa = spec->parameter[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) {
    PetscCheckInput(!PetscIsNanReal(spec->parameter[k]), "material.%s.%s: missing; mooney_rivlin needs c1, c2 and kappa", spec->name,
                    MaterialMooneyRivlinParameters[k].name);
  }
  PetscCheckInput(c1 + c2 > 0, "material.%s.c1: shear modulus 2 (c1 + c2) = %g must be positive", spec->name, (double)(2 * (c1 + c2)));
  spec->mu          = 2 * (c1 + c2);
  spec->kappa       = kappa;
  spec->lambda      = kappa - 2 * spec->mu / 3;
  spec->log_modulus = spec->lambda - 4 * c2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All but the square of ln J. */
INLINE void ShearLog_Private(PetscReal c1, PetscReal c2, const Deformation *d, Lanes I1m3, Lanes h[2], Response *r)
{
  const PetscReal factor  = 2 * c1 + 4 * c2;
  const Lanes     inverse = 1 / d->J;
  Lanes           G[9], I2m3;

  I2m3 = SecondMinus3(d, I1m3, G);
  if (r->want_W) r->W = c1 * I1m3 + c2 * I2m3 - factor * d->lnJ;
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = 2 * c1 * d->F[k] + c2 * G[k];
  if (r->want_A) {
    SetIdentity(r->A, LanesSet(2 * c1));
    AddSecondInvariantHessian(r->A, LanesSet(2 * c2), 3 + I1m3, d->F);
  }
  h[0] = -factor * inverse;
  h[1] = factor * inverse * inverse;
}

INLINE void MooneyRivlinPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes I1m3 = FirstMinus3(d);
  Lanes       h[2];

  if (spec->volumetric == VOLUMETRIC_LOG)
    ShearLog_Private(spec->parameter[0], spec->parameter[1], d, I1m3, h, r);
  else {
    FirstInvariant(spec->parameter[0], d, LanesExpm1((-2. / 3) * d->lnJ), I1m3, h, r);
    SecondInvariant(spec->parameter[1], d, I1m3, h, r);
  }
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialMooneyRivlin(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(MooneyRivlinPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
