/* Private to material: energies c1 (J^(-2/3) I1 - 3) and c2 (J^(-4/3) I2 - 3), as the isochoric laws are made of them. What multiplies cof F and
   cof F (x) cof F, the derivatives by J at fixed F, is collected in h[2]; AddVolume adds it at the end. */
#pragma once
#include "materialimpl.h"

/* I1 - 3, free of cancellation. */
INLINE Lanes FirstMinus3(const Deformation *d)
{
  return 2 * (d->H[0] + d->H[4] + d->H[8]) + Inner9(d->H, d->H);
}

/* c1 (a I1 - 3) with a = J^(-2/3) = 1 + am1; sets the response. */
INLINE void FirstInvariant(PetscReal c1, const Deformation *d, Lanes am1, Lanes I1m3, Lanes h[2], Response *r)
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
INLINE void AddSecondInvariantHessian(Lanes A[81], Lanes c, Lanes I1, const Lanes F[9])
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

/* I2 - 3 = 2 (I1 - 3) + I2(C - 1), which keeps small strains, and G = dI2/dF = 2 (I1 F - F C). */
INLINE Lanes SecondMinus3(const Deformation *d, Lanes I1m3, Lanes G[9])
{
  const Lanes *F = d->F, *H = d->H;
  Lanes        E[9]; /* C - 1 */

  for (int r0 = 0; r0 < 3; r0++) {
    for (int s = 0; s < 3; s++) E[3 * r0 + s] = H[3 * r0 + s] + H[3 * s + r0] + H[r0] * H[s] + H[3 + r0] * H[3 + s] + H[6 + r0] * H[6 + s];
  }
  /* I1 F - F C = (I1 - 1) F - F E */
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) G[3 * i + J] = 2 * ((2 + I1m3) * F[3 * i + J] - F[3 * i] * E[J] - F[3 * i + 1] * E[3 + J] - F[3 * i + 2] * E[6 + J]);
  }
  return 2 * I1m3 + 0.5 * (I1m3 * I1m3 - Inner9(E, E));
}

/* Adds c2 (b I2 - 3) with b = J^(-4/3). */
INLINE void SecondInvariant(PetscReal c2, const Deformation *d, Lanes I1m3, Lanes h[2], Response *r)
{
  const Lanes bm1 = LanesExpm1((-4. / 3) * d->lnJ), b = 1 + bm1, inverse = 1 / d->J;
  Lanes       G[9], I2m3;

  I2m3 = SecondMinus3(d, I1m3, G);
  if (r->want_W) r->W += c2 * (bm1 * (3 + I2m3) + I2m3);
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] += c2 * b * G[k];
  if (r->want_A) {
    AddSecondInvariantHessian(r->A, 2 * c2 * b, 3 + I1m3, d->F);
    for (int k = 0; k < 9; k++) G[k] *= (-4. / 3) * c2 * b * inverse;
    AddSymmetric(r->A, G, d->cof);
  }
  h[0] -= (4. / 3) * c2 * b * (3 + I2m3) * inverse;
  h[1] += (28. / 9) * c2 * b * (3 + I2m3) * inverse * inverse;
}

/* The volumetric energy of the whole law, and all that was collected in h. */
INLINE void AddVolume(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Lanes h[2], Response *r)
{
  Lanes U[3];

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
