/* St. Venant-Kirchhoff solid: W = lambda/2 (tr E)^2 + mu E : E with E = (C - 1)/2. Linear elasticity in the strain of Green and Lagrange: what many codes
   mean by "elastic, large rotations". Good for small strains only: uniaxial compression loses its stiffness at a stretch of 0.577. The energy does
   not split into shear and volume, so there is no volumetric law to choose and no mixed form. */
#include "materialimpl.h"

/* E = sym H + H^T H / 2, which keeps small strains. */
INLINE void GreenStrain_Private(const Lanes H[9], Lanes E[9])
{
  for (int r = 0; r < 3; r++) {
    for (int s = 0; s < 3; s++) E[3 * r + s] = 0.5 * (H[3 * r + s] + H[3 * s + r] + H[r] * H[s] + H[3 + r] * H[3 + s] + H[6 + r] * H[6 + s]);
  }
}

/* A_iJkL = delta_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik delta_JL). */
INLINE void Tangent_Private(const MaterialSpec *spec, const Lanes F[9], const Lanes S[9], Lanes A[81])
{
  SetIdentity(A, (Lanes){0});
  AddSquare(A, LanesSet(spec->lambda), F);
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++) {
      const Lanes B = spec->mu * (F[3 * i] * F[3 * k] + F[3 * i + 1] * F[3 * k + 1] + F[3 * i + 2] * F[3 * k + 2]);

      for (int J = 0; J < 3; J++) {
        A[9 * (3 * i + J) + 3 * k + J] += B;
        A[9 * (3 * i + J) + 3 * i + k] += S[3 * J + k]; /* here k plays L */
        for (int L = 0; L < 3; L++) A[9 * (3 * i + J) + 3 * k + L] += spec->mu * F[3 * i + L] * F[3 * k + J];
      }
    }
  }
}

INLINE void SaintVenantKirchhoffPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  Lanes E[9], S[9], trace;

  GreenStrain_Private(d->H, E);
  trace = E[0] + E[4] + E[8];
  for (int k = 0; k < 9; k++) S[k] = 2 * spec->mu * E[k] + (k % 4 == 0 ? spec->lambda : 0) * trace;
  if (r->want_W) r->W = 0.5 * Inner9(S, E);
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] = d->F[k - k % 3] * S[k % 3] + d->F[k - k % 3 + 1] * S[3 + k % 3] + d->F[k - k % 3 + 2] * S[6 + k % 3];
  if (r->want_A) Tangent_Private(spec, d->F, S, r->A);
}

PetscErrorCode MaterialSaintVenantKirchhoff(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PetscCheck(part == MATERIAL_FULL, PETSC_COMM_SELF, PETSC_ERR_SUP, "Material %s (%s) has no isochoric part", spec->name, spec->law->name);
  PointLoop(SaintVenantKirchhoffPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
