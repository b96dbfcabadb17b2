/* Mooney-Rivlin solid (MR of docs/theory.md): W = U(J) + c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3). */
#include "materialimpl.h"

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
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: mooney_rivlin knows quadratic and simo, not log", spec->name);
  spec->mu     = 2 * (c1 + c2);
  spec->kappa  = kappa;
  spec->lambda = kappa - 2 * spec->mu / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* c1 (a I1 - 3) with a = J^(-2/3): as in neo_hookean.c, mu = 2 c1. */
INLINE void FirstInvariant_Private(PetscReal c1, const Deformation *d, Lanes am1, Lanes I1m3, Lanes h[2], Response *r)
{
  const Lanes a = 1 + am1, inverse = 1 / d->J;

  if (r->want_W) r->W = c1 * (am1 * (3 + I1m3) + I1m3);
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = 2 * c1 * a * d->F[k];
  if (r->want_A) {
    Lanes v[9];

    for (int k = 0; k < 9; k++) v[k] = (-4. / 3) * c1 * a * inverse * d->F[k];
    SetIdentity(r->A, 2 * c1 * a);
    AddSymmetric(r->A, v, d->cof);
  }
  h[0] = (-2. / 3) * c1 * a * (3 + I1m3) * inverse;
  h[1] = (10. / 9) * c1 * a * (3 + I1m3) * inverse * inverse;
}

/* A += c d(I1 F - F C)/dF = c (I1 1 + 2 F (x) F - d(F C)/dF), d(FC)_iJ/dF_kL = delta_ik C_LJ + F_iL F_kJ + (F F^T)_ik delta_JL. */
INLINE void AddSecondInvariantHessian_Private(Lanes A[81], Lanes c, Lanes I1, const Lanes F[9])
{
  Lanes C[9], B[9];

  for (int r = 0; r < 3; r++) {
    for (int s = 0; s < 3; s++) {
      C[3 * r + s] = F[r] * F[s] + F[3 + r] * F[3 + s] + F[6 + r] * F[6 + s];
      B[3 * r + s] = F[3 * r] * F[3 * s] + F[3 * r + 1] * F[3 * s + 1] + F[3 * r + 2] * F[3 * s + 2];
    }
  }
  AddSquare(A, 2 * c, F);
  for (int k = 0; k < 9; k++) A[10 * k] += c * I1;
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      for (int J = 0; J < 3; J++) {
        A[9 * (3 * i + J) + 3 * k + J] -= c * B[3 * i + k];
        A[9 * (3 * i + J) + 3 * i + k] -= c * C[3 * k + J]; /* here k plays L */
        for (int L = 0; L < 3; L++) A[9 * (3 * i + J) + 3 * k + L] -= c * F[3 * i + L] * F[3 * k + J];
      }
    }
  }
}

/* Adds c2 (b I2 - 3) with b = J^(-4/3), dI2/dF = 2 (I1 F - F C). I2 - 3 = 2 (I1 - 3) + I2(C - 1) keeps small strains. */
INLINE void SecondInvariant_Private(PetscReal c2, const Deformation *d, Lanes I1m3, Lanes h[2], Response *r)
{
  const Lanes bm1 = LanesExpm1((-4. / 3) * d->lnJ), b = 1 + bm1, inverse = 1 / d->J, *F = d->F, *H = d->H;
  Lanes       E[9], G[9], I2m3; /* E = C - 1, G = dI2/dF */

  for (int r0 = 0; r0 < 3; r0++) {
    for (int s = 0; s < 3; s++) E[3 * r0 + s] = H[3 * r0 + s] + H[3 * s + r0] + H[r0] * H[s] + H[3 + r0] * H[3 + s] + H[6 + r0] * H[6 + s];
  }
  I2m3 = 2 * I1m3 + 0.5 * (I1m3 * I1m3 - Inner9(E, E));
  /* I1 F - F C = (I1 - 1) F - F E */
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) G[3 * i + J] = 2 * ((2 + I1m3) * F[3 * i + J] - F[3 * i] * E[J] - F[3 * i + 1] * E[3 + J] - F[3 * i + 2] * E[6 + J]);
  }
  if (r->want_W) r->W += c2 * (bm1 * (3 + I2m3) + I2m3);
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] += c2 * b * G[k];
  if (r->want_A) {
    AddSecondInvariantHessian_Private(r->A, 2 * c2 * b, 3 + I1m3, F);
    for (int k = 0; k < 9; k++) G[k] *= (-4. / 3) * c2 * b * inverse;
    AddSymmetric(r->A, G, d->cof);
  }
  h[0] -= (4. / 3) * c2 * b * (3 + I2m3) * inverse;
  h[1] += (28. / 9) * c2 * b * (3 + I2m3) * inverse * inverse;
}

INLINE void MooneyRivlinPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes I1m3 = 2 * (d->H[0] + d->H[4] + d->H[8]) + Inner9(d->H, d->H);
  Lanes       h[2], U[3];

  FirstInvariant_Private(spec->parameter[0], d, LanesExpm1((-2. / 3) * d->lnJ), I1m3, h, r);
  SecondInvariant_Private(spec->parameter[1], d, I1m3, h, r);
  if (part == MATERIAL_FULL) {
    VolumetricEnergy(spec, d, U);
    if (r->want_W) r->W += U[0];
    h[0] += U[1];
    h[1] += U[2];
  }
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] += h[0] * d->cof[k];
  if (r->want_A) {
    AddSquare(r->A, h[1], d->cof);
    AddCofactorDerivative(r->A, h[0], d->F);
  }
}

PetscErrorCode MaterialMooneyRivlin(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(MooneyRivlinPoint_Private, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
