/* The estimate over the error in energy, for tests of solved problems with a known deformation. */
#pragma once
#include "estimateimpl.h"
#include "problemfixture.h"

/* H : A(F) : H, A that of the law at the exact deformation gradient. */
static PetscReal EnergyDensity(const MaterialSpec *material, const PetscReal F[9], const PetscReal H[9])
{
  PetscReal      A[81], P[9], sum = 0;
  MaterialPoints point = {.n = 1, .F = F, .P = P, .A = A};

  OK(MaterialEvaluate(material, MATERIAL_FULL, &point));
  assert_false(point.bad);
  for (PetscInt a = 0; a < 9; ++a)
    for (PetscInt b = 0; b < 9; ++b) sum += H[a] * A[9 * a + b] * H[b];
  return sum;
}

static PetscReal Estimated(const Solved *s)
{
  const ForestTables *t;
  PetscReal           eta = 0;
  EstimateSum         sum = {.space = s->space, .mechanics = s->mechanics, .spec = &s->bulk.spec, .time = 1, .u = s->u};

  t = ForestGetTables(s->bulk.forest);
  OK(PetscCalloc1(t->num_leaves, &sum.eta2));
  OK(EstimateBulk_Private(&sum));
  for (PetscInt l = 0; l < t->num_leaves; ++l) eta += sum.eta2[l];
  OK(PetscFree(sum.eta2));
  return PetscSqrtReal(eta);
}
