/* Compressible neo-Hookean solid. With the logarithmic volume term (docs/theory.md)
     W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2,
   with the quadratic or Simo's volume term (NHq, NHs)  W = U(J) + mu/2 (J^(-2/3) tr C - 3). */
#include "invariants.h"

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

INLINE void NeoHookeanPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  Lanes h[2];

  if (spec->volumetric == VOLUMETRIC_LOG)
    ShearLog_Private(spec, d, h, r);
  else
    FirstInvariant(0.5 * spec->mu, d, LanesExpm1((-2. / 3) * d->lnJ), FirstMinus3(d), h, r);
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialNeoHookean(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(NeoHookeanPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
