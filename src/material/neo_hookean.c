/* Compressible neo-Hookean solid. With the logarithmic volume term (NHc of docs/theory.md)
     W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2,
   with the quadratic or Simo's volume term (NHq, NHs)  W = U(J) + mu/2 (J^(-2/3) tr C - 3). */
#include "materialimpl.h"

/* The mu part of NHc. P = mu (F - F^-T). */
INLINE void ShearLog_Private(const MaterialSpec *spec, const Deformation *d, Lanes h[2], Response *r)
{
  const PetscReal mu      = spec->mu;
  const Lanes     inverse = 1 / d->J;

  if (r->want_W) r->W = mu * (d->H[0] + d->H[4] + d->H[8] - d->lnJ + 0.5 * Inner9(d->H, d->H));
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = mu * d->F[k];
  if (r->want_A) SetIdentity(r->A, LanesSet(mu));
  h[0] = -mu * inverse;
  h[1] = mu * inverse * inverse;
}

/* mu/2 (a I1 - 3) with a = J^(-2/3). */
INLINE void ShearBar_Private(const MaterialSpec *spec, const Deformation *d, Lanes h[2], Response *r)
{
  const PetscReal mu  = spec->mu;
  const Lanes     am1 = LanesExpm1((-2. / 3) * d->lnJ), a = 1 + am1, I1m3 = 2 * (d->H[0] + d->H[4] + d->H[8]) + Inner9(d->H, d->H);
  const Lanes     inverse = 1 / d->J;

  if (r->want_W) r->W = 0.5 * mu * (am1 * (3 + I1m3) + I1m3);
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = mu * a * d->F[k];
  if (r->want_A) {
    const Lanes c = (-2. / 3) * mu * a * inverse;
    Lanes       v[9];

    for (int k = 0; k < 9; k++) v[k] = c * d->F[k];
    SetIdentity(r->A, mu * a);
    AddSymmetric(r->A, v, d->cof);
  }
  h[0] = (-1. / 3) * mu * a * (3 + I1m3) * inverse;
  h[1] = (5. / 9) * mu * a * (3 + I1m3) * inverse * inverse;
}

/* h = (dW/dJ, d2W/dJ2) at fixed F multiplies cof and cof (x) cof. */
INLINE void NeoHookeanPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  Lanes h[2], U[3];

  if (spec->volumetric == VOLUMETRIC_LOG)
    ShearLog_Private(spec, d, h, r);
  else
    ShearBar_Private(spec, d, h, r);
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

PetscErrorCode MaterialNeoHookean(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(NeoHookeanPoint_Private, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
