/* Private to material: kinematics and tensor products at NUM_LANES points at once, and the loop every hyperelastic law runs in. */
#pragma once
#include "material.h"

#define INLINE static inline __attribute__((always_inline, unused))

typedef long LanesMask __attribute__((vector_size(NUM_LANES * sizeof(long)), may_alias)); /* what a comparison of Lanes yields: 0 or -1 */

/* What the laws need to know of a deformation. J - 1 is built from H = F - 1, so that small strains keep their digits. */
typedef struct {
  Lanes        F[9], H[9], cof[9]; /* cof = J F^-T */
  Lanes        fiber[MATERIAL_MAX_FIBERS][3];
  Lanes        jm1, J, lnJ;
  Lanes        history[MATERIAL_MAX_HISTORY]; /* of laws that have one */
  MaterialEdge edge;                          /* as in MaterialPoints, and so */
  PetscReal    secant;
  PetscBool    held;
} Deformation;

/* What they answer. W alone, or with P, or with P and A, as asked. */
typedef struct {
  PetscBool want_W, want_P, want_A;
  Lanes     W, P[9], A[81];
  Lanes     trial[MATERIAL_MAX_HISTORY]; /* laws with history: always */
  LanesMask bad;                         /* or-ed at points without an answer */
} Response;

INLINE Lanes LanesSet(PetscReal value)
{
  return value - (Lanes){0};
}

INLINE Lanes LanesSelect(LanesMask mask, Lanes yes, Lanes no)
{
  return (Lanes)(((LanesMask)yes & mask) | ((LanesMask)no & ~mask));
}

INLINE Lanes LanesLog1p(Lanes x)
{
  Lanes y = x;

  for (int l = 0; l < NUM_LANES; l++) y[l] = log1p(x[l]);
  return y;
}

INLINE Lanes LanesExpm1(Lanes x)
{
  Lanes y = x;

  for (int l = 0; l < NUM_LANES; l++) y[l] = expm1(x[l]);
  return y;
}

/* Inner product of two tensors. */
INLINE Lanes Inner9(const Lanes a[9], const Lanes b[9])
{
  Lanes sum = a[0] * b[0];

  for (int k = 1; k < 9; k++) sum += a[k] * b[k];
  return sum;
}

INLINE void Cofactor(const Lanes F[9], Lanes cof[9])
{
  cof[0] = F[4] * F[8] - F[5] * F[7];
  cof[1] = F[5] * F[6] - F[3] * F[8];
  cof[2] = F[3] * F[7] - F[4] * F[6];
  cof[3] = F[2] * F[7] - F[1] * F[8];
  cof[4] = F[0] * F[8] - F[2] * F[6];
  cof[5] = F[1] * F[6] - F[0] * F[7];
  cof[6] = F[1] * F[5] - F[2] * F[4];
  cof[7] = F[2] * F[3] - F[0] * F[5];
  cof[8] = F[0] * F[4] - F[1] * F[3];
}

/* J - 1 = tr H + tr cof H + det H. */
INLINE Lanes DeterminantMinus1(const Lanes H[9])
{
  Lanes c[9];

  Cofactor(H, c);
  return (H[0] + H[4] + H[8]) + (c[0] + c[4] + c[8]) + (H[0] * c[0] + H[1] * c[1] + H[2] * c[2]);
}

/* Points with J <= 0 (or NaN) answer as if J were 1 and are marked in `bad`. */
INLINE void DeformationSet(Deformation *d, LanesMask *bad)
{
  LanesMask good;

  for (int k = 0; k < 9; k++) d->H[k] = d->F[k] - (k % 4 == 0 ? 1 : 0);
  Cofactor(d->F, d->cof);
  d->jm1 = DeterminantMinus1(d->H);
  good   = d->jm1 > -1;
  *bad |= ~good;
  d->jm1 = (Lanes)((LanesMask)d->jm1 & good);
  d->J   = 1 + d->jm1;
  d->lnJ = LanesLog1p(d->jm1);
}

/* A = c 1. */
INLINE void SetIdentity(Lanes A[81], Lanes c)
{
  for (int k = 0; k < 81; k++) A[k] = (Lanes){0};
  for (int k = 0; k < 81; k += 10) A[k] = c;
}

/* A += c a (x) a. */
INLINE void AddSquare(Lanes A[81], Lanes c, const Lanes a[9])
{
  for (int r = 0; r < 9; r++) {
    const Lanes ca = c * a[r];

    for (int s = 0; s < 9; s++) A[9 * r + s] += ca * a[s];
  }
}

/* A += a (x) b + b (x) a. */
INLINE void AddSymmetric(Lanes A[81], const Lanes a[9], const Lanes b[9])
{
  for (int r = 0; r < 9; r++) {
    for (int s = 0; s < 9; s++) A[9 * r + s] += a[r] * b[s] + b[r] * a[s];
  }
}

/* A += h d cof / dF: components (iJ, kL), i != k, J != L, are +- F of the remaining row and column. */
INLINE void AddCofactorDerivative(Lanes A[81], Lanes h, const Lanes F[9])
{
  for (int i = 0; i < 3; i++) {
    for (int J = 0; J < 3; J++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, J1 = (J + 1) % 3, J2 = (J + 2) % 3, row = 9 * (3 * i + J);

      A[row + 3 * i1 + J1] += h * F[3 * i2 + J2];
      A[row + 3 * i2 + J2] += h * F[3 * i1 + J1];
      A[row + 3 * i1 + J2] -= h * F[3 * i2 + J1];
      A[row + 3 * i2 + J1] -= h * F[3 * i1 + J2];
    }
  }
}

/* Volumetric energy m/2 g(J)^2 and its first two derivatives by J. */
INLINE void VolumetricEnergy(const MaterialSpec *spec, const Deformation *d, Lanes U[3])
{
  const PetscReal m       = MaterialVolumetricModulus(spec);
  const Lanes     inverse = 1 / d->J;

  if (spec->volumetric == VOLUMETRIC_LOG) {
    U[0] = 0.5 * m * d->lnJ * d->lnJ;
    U[1] = m * d->lnJ * inverse;
    U[2] = m * (1 - d->lnJ) * inverse * inverse;
  } else if (spec->volumetric == VOLUMETRIC_SIMO) {
    U[0] = 0.5 * m * (d->jm1 + 0.5 * d->jm1 * d->jm1 - d->lnJ);
    U[1] = 0.5 * m * d->jm1 * (d->jm1 + 2) * inverse;
    U[2] = 0.5 * m * (1 + inverse * inverse);
  } else {
    U[0] = 0.5 * m * d->jm1 * d->jm1;
    U[1] = m * d->jm1;
    U[2] = LanesSet(m);
  }
}

typedef void (*PointLaw)(const MaterialSpec *, MaterialPart, const Deformation *, Response *);

/* Numbers of `count` points i, i+1, … in arrays [num][n]; lanes beyond repeat the last one. */
INLINE void LoadPoints(PetscInt num, PetscInt n, PetscInt i, PetscInt count, const PetscReal *from, Lanes *to)
{
  for (PetscInt k = 0; k < num; k++) {
    if (count == NUM_LANES)
      to[k] = *(const LanesAny *)&from[k * n + i];
    else
      for (PetscInt l = 0; l < NUM_LANES; l++) to[k][l] = from[k * n + i + PetscMin(l, count - 1)];
  }
}

INLINE void StorePoints(PetscInt num, PetscInt n, PetscInt i, PetscInt count, const Lanes *from, PetscReal *to)
{
  for (PetscInt k = 0; to && k < num; k++) {
    if (count == NUM_LANES)
      *(LanesAny *)&to[k * n + i] = from[k];
    else
      for (PetscInt l = 0; l < count; l++) to[k * n + i + l] = from[k][l];
  }
}

/* Run a law over points. `law` and its number of history values are constants at every call, so that it is inlined. */
INLINE void PointLoop(PointLaw law, const PetscInt num_history, const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  const PetscInt n   = points->n;
  LanesMask      any = {0};
  Response       r;

  r.want_W = points->W ? PETSC_TRUE : PETSC_FALSE;
  r.want_P = points->P ? PETSC_TRUE : PETSC_FALSE;
  r.want_A = points->A ? PETSC_TRUE : PETSC_FALSE;
  r.bad    = (LanesMask){0};
  for (PetscInt i = 0; i < n; i += NUM_LANES) {
    const PetscInt count = PetscMin(NUM_LANES, n - i);
    Deformation    d;

    LoadPoints(9, n, i, count, points->F, d.F);
    LoadPoints(3 * spec->num_fibers, n, i, count, points->fiber, d.fiber[0]);
    if (num_history) LoadPoints(num_history, n, i, count, points->history, d.history);
    DeformationSet(&d, &any);
    d.edge   = points->edge;
    d.secant = points->secant;
    d.held   = points->held;
    law(spec, part, &d, &r);
    StorePoints(1, n, i, count, &r.W, points->W);
    StorePoints(9, n, i, count, r.P, points->P);
    StorePoints(81, n, i, count, r.A, points->A);
    if (num_history) StorePoints(num_history, n, i, count, r.trial, points->trial);
  }
  any |= r.bad;
  for (int l = 0; l < NUM_LANES; l++) {
    if (any[l]) points->bad = PETSC_TRUE;
  }
}

/* ---- set-up shared by laws (setup.c) ---- */

extern const MaterialParameter MaterialElasticParameters[]; /* E, nu, mu, kappa, lambda */
PetscErrorCode                 MaterialSetUpElastic(MaterialSpec *);

/* ---- one row each, in its own file ---- */

PetscErrorCode MaterialNeoHookean(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialMooneyRivlin(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialOgden(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialPolynomial(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialHGO(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialSaintVenantKirchhoff(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialLinear(const MaterialSpec *, MaterialPart, MaterialPoints *);
PetscErrorCode MaterialJ2(const MaterialSpec *, MaterialPart, MaterialPoints *);

extern const MaterialParameter MaterialMooneyRivlinParameters[];
PetscErrorCode                 MaterialMooneyRivlinSetUp(MaterialSpec *);
extern const MaterialParameter MaterialOgdenParameters[];
PetscErrorCode                 MaterialOgdenSetUp(MaterialSpec *);
extern const MaterialParameter MaterialYeohParameters[];
PetscErrorCode                 MaterialYeohSetUp(MaterialSpec *);
extern const MaterialParameter MaterialArrudaBoyceParameters[];
PetscErrorCode                 MaterialArrudaBoyceSetUp(MaterialSpec *);
extern const MaterialParameter MaterialHGOParameters[];
PetscErrorCode                 MaterialHGOSetUp(MaterialSpec *);
extern const MaterialParameter MaterialRigidParameters[];
PetscErrorCode                 MaterialRigidSetUp(MaterialSpec *);
PetscErrorCode                 MaterialLinearSetUp(MaterialSpec *);
extern const MaterialParameter MaterialJ2Parameters[];
PetscErrorCode                 MaterialJ2SetUp(MaterialSpec *);
void                           MaterialJ2Initial(const MaterialSpec *, PetscReal history[]);
void                           MaterialJ2Plastic(const MaterialSpec *, const PetscReal history[], PetscReal *strain, PetscReal *work);
