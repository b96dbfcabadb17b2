/* Mooney-Rivlin solid (MR of docs/theory.md): W = U(J) + c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3). */
#include "invariants.h"

const MaterialParameter MaterialMooneyRivlinParameters[] = {
    {"c1", "stress", "factor of the first invariant; shear modulus 2 (c1 + c2)", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"c2", "stress", "factor of the second invariant", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus", 0, PETSC_MAX_REAL},
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
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: mooney_rivlin knows quadratic and simo, not log", spec->name);
  spec->mu     = 2 * (c1 + c2);
  spec->kappa  = kappa;
  spec->lambda = kappa - 2 * spec->mu / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

INLINE void MooneyRivlinPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes I1m3 = FirstMinus3(d);
  Lanes       h[2];

  FirstInvariant(spec->parameter[0], d, LanesExpm1((-2. / 3) * d->lnJ), I1m3, h, r);
  SecondInvariant(spec->parameter[1], d, I1m3, h, r);
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialMooneyRivlin(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(MooneyRivlinPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
