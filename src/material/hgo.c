/* Artery wall of Holzapfel, Gasser and Ogden (hgo of docs/theory.md): an isotropic ground substance with families of fibres M_i that carry tension only,
     W = U(J) + c/2 (J^(-2/3) I1 - 3) + c2/2 (J^(-4/3) I2 - 3) + sum_i k1/(2 k2) (exp(k2 <E_i>^2) - 1),   E_i = J^(-2/3) |F M_i|^2 - 1,  <x> = max(x, 0).
   The stress of a family vanishes where it goes slack; its modulus jumps there from k1 to 0, which Newton's method takes as it is (semismooth). */
#include "invariants.h"

enum { C, KAPPA, K1, K2, C2 };

const MaterialParameter MaterialHGOParameters[] = {
    {"c", "stress", "shear modulus of the ground substance", 0, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {"k1", "stress", "stiffness of the fibres, of all families that have none of their own", 0, PETSC_MAX_REAL},
    {"k2", "1", "how fast the fibres stiffen, likewise", 0, PETSC_MAX_REAL},
    {"c2", "stress", "twice the factor of the ground substance's second invariant; 0 when left out", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {NULL, NULL, NULL, 0, 0},
};

#define MOST_EXPONENT 20 /* beyond it a deformation counts as impossible, as det F <= 0 does: next to e^20 k1 the forces of all others would be round-off */

/* Moduli of a family, and its direction of length 1. */
static PetscErrorCode FamilySetUp_Private(const MaterialSpec *spec, MaterialFiber *f)
{
  PetscReal length = 0;

  PetscFunctionBegin;
  if (f->k1 == 0) f->k1 = spec->parameter[K1];
  if (f->k2 == 0) f->k2 = spec->parameter[K2];
  PetscCheckInput(f->k1 > 0, "material.%s.fiber.%s.k1: missing or not positive; it is given here or as material.%s.k1 for all families", spec->name, f->name,
                  spec->name);
  PetscCheckInput(f->k2 > 0, "material.%s.fiber.%s.k2: missing or not positive; it is given here or as material.%s.k2 for all families", spec->name, f->name,
                  spec->name);
  if (!f->straight) PetscFunctionReturn(PETSC_SUCCESS);
  for (int c = 0; c < 3; c++) length += PetscSqr(f->direction[c]);
  PetscCheckInput(length > 0 && !PetscIsInfReal(length), "material.%s.fiber.%s.direction: (%g, %g, %g) has no direction", spec->name, f->name,
                  (double)f->direction[0], (double)f->direction[1], (double)f->direction[2]);
  for (int c = 0; c < 3; c++) f->direction[c] /= PetscSqrtReal(length);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MaterialHGOSetUp(MaterialSpec *spec)
{
  PetscReal *v = spec->parameter;

  PetscFunctionBegin;
  for (int k = C; k <= KAPPA; k++) {
    PetscCheckInput(!PetscIsNanReal(v[k]), "material.%s.%s: missing; hgo needs c, kappa, k1 and k2", spec->name, MaterialHGOParameters[k].name);
  }
  if (PetscIsNanReal(v[C2])) v[C2] = 0;
  PetscCheckInput(v[C2] >= 0, "material.%s.c2: %g is below 0", spec->name, (double)v[C2]);
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: hgo knows quadratic and simo, not log", spec->name);
  for (PetscInt f = 0; f < spec->num_fibers; f++) PetscCall(FamilySetUp_Private(spec, &spec->fiber[f]));
  spec->mu     = v[C] + v[C2];
  spec->kappa  = v[KAPPA];
  spec->lambda = spec->kappa - 2 * spec->mu / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a family. With I = |F M|^2 and a = J^(-2/3) = 1 + am1: d(a I)/dF = 2 a F M (x) M - 2/3 a I/J cof F. */
INLINE void Family_Private(const MaterialFiber *f, const Lanes M[3], const Deformation *d, Lanes am1, Lanes h[2], Response *r)
{
  const Lanes a = 1 + am1, inverse = 1 / d->J;
  Lanes       FM[3], Im1           = {0}, E, exponent, growth, slope, bar;
  LanesMask   tight, huge;

  for (int i = 0; i < 3; i++) {
    const Lanes HM = d->H[3 * i] * M[0] + d->H[3 * i + 1] * M[1] + d->H[3 * i + 2] * M[2];

    FM[i] = M[i] + HM;
    Im1 += (M[i] + FM[i]) * HM;
  }
  E        = am1 * (1 + Im1) + Im1;
  tight    = f->compression ? ~(LanesMask){0} : (LanesMask)(E > 0);
  E        = (Lanes)((LanesMask)E & tight);
  exponent = f->k2 * E * E;
  huge     = (LanesMask)(exponent > MOST_EXPONENT);
  r->bad |= huge;
  exponent = (Lanes)((LanesMask)exponent & ~huge);
  growth   = LanesExpm1(exponent);
  slope    = f->k1 * E * (1 + growth);
  bar      = a * (1 + Im1) * inverse; /* a I / J */
  if (r->want_W) r->W += f->k1 / (2 * f->k2) * growth;
  for (int k = 0; r->want_P && k < 9; k++) r->P[k] += 2 * slope * a * FM[k / 3] * M[k % 3];
  h[0] -= (2. / 3) * slope * bar;
  h[1] += (10. / 9) * slope * bar * inverse;
  if (r->want_A) {
    const Lanes curvature = (Lanes)((LanesMask)(f->k1 * (1 + growth) * (1 + 2 * exponent)) & tight);
    Lanes       D[9], v[9];

    for (int k = 0; k < 9; k++) {
      D[k] = 2 * a * FM[k / 3] * M[k % 3] - (2. / 3) * bar * d->cof[k];
      v[k] = (-4. / 3) * slope * a * inverse * FM[k / 3] * M[k % 3];
    }
    AddSquare(r->A, curvature, D);
    AddSymmetric(r->A, v, d->cof);
    for (int k = 0; k < 27; k++) r->A[9 * (k / 3) + 3 * (k / 9) + k % 3] += 2 * slope * a * M[k / 3 % 3] * M[k % 3];
  }
}

INLINE void HGOPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes am1 = LanesExpm1((-2. / 3) * d->lnJ), I1m3 = FirstMinus3(d);
  Lanes       h[2];

  FirstInvariant(0.5 * spec->parameter[C], d, am1, I1m3, h, r);
  if (spec->parameter[C2] > 0) SecondInvariant(0.5 * spec->parameter[C2], d, I1m3, h, r);
  for (PetscInt f = 0; f < spec->num_fibers; f++) Family_Private(&spec->fiber[f], d->fiber[f], d, am1, h, r);
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialHGO(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(HGOPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
