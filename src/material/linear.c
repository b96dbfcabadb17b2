/* Linear isotropic elasticity on eps = sym(F - 1): W = kappa/2 (tr eps)^2 + mu dev eps : dev eps. For small kinematics; any F is admissible. */
#include "materialimpl.h"

PetscErrorCode MaterialLinearSetUp(MaterialSpec *spec)
{
  PetscFunctionBegin;
  PetscCheckInput(spec->volumetric == VOLUMETRIC_QUADRATIC, "material.%s.volumetric: linear has no other volumetric law than quadratic", spec->name);
  PetscCall(MaterialSetUpElastic(spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K = kappa or, without the volumetric energy, 0. */
static void Stress_Private(const MaterialSpec *spec, PetscReal K, const PetscReal H[9], PetscReal P[9], PetscReal *W)
{
  const PetscReal mu = spec->mu, trace = H[0] + H[4] + H[8], mean = trace / 3;

  *W = 0.5 * K * trace * trace;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const PetscReal dev = 0.5 * (H[3 * i + j] + H[3 * j + i]) - (i == j ? mean : 0);

      P[3 * i + j] = 2 * mu * dev + (i == j ? K * trace : 0);
      *W += mu * dev * dev;
    }
  }
}

PetscErrorCode MaterialLinear(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  const PetscReal  K = part == MATERIAL_FULL ? spec->kappa : 0, mu = spec->mu, *F = points->F;
  const PetscInt   n = points->n;
  PetscReal *const W = points->W, *const P = points->P, *const A = points->A;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < n && (W || P); q++) {
    PetscReal H[9], stress[9], energy;

    for (int k = 0; k < 9; k++) H[k] = F[k * n + q] - (k % 4 == 0 ? 1 : 0);
    Stress_Private(spec, K, H, stress, &energy);
    if (W) W[q] = energy;
    for (int k = 0; P && k < 9; k++) P[k * n + q] = stress[k];
  }
  for (int a = 0; A && a < 9; a++) {
    for (int b = 0; b < 9; b++) {
      const int       i = a / 3, J = a % 3, k = b / 3, L = b % 3;
      const PetscReal value = (K - 2 * mu / 3) * (i == J) * (k == L) + mu * ((i == k) * (J == L) + (i == L) * (J == k));

      for (PetscInt q = 0; q < n; q++) A[(9 * a + b) * n + q] = value;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
