/* A ray from a point of the facet to a mortar facet, the gap density g = s d.n (rho) and the area density |n| (rho), and first derivatives.

   Variations at fixed xi: P = sum N_a dx_a, T_k = sum N_a,k dx_a, V = sum V_v dd_v, M = sum M_b dy_b.
   K (deta, ds) = r = P + s V - M,   K = [x_m,1, x_m,2, -d] (plane: e_z for the second): ds = kappa . r, deta_i = zeta_i . r, kappa = -n_m / d.n_m;
   d(d.n) = n.V + (t_2 x d).T_1 + (d x t_1).T_2. */
#include "kernelimpl.h"

static const RayBeyond Mean = {{0.5, 0.5}, {0, 0}};

void ContactRayDensities(const RayFacet *f, RayPoint *r)
{
  Cross3(r->t[0], r->t[1], r->n);
  r->a = PetscSqrtReal(Dot3(r->n, r->n));
  for (int c = 0; c < 3; c++) r->unit[c] = r->n[c] / r->a;
  r->beta = Dot3(r->d, r->n);
  r->turn = f->ring;
  r->rho  = f->ring > 0 ? f->ring * r->p[0] : 1;
}

/* Facet and directions at xi. */
static void Facet_Private(const RayFacet *f, int depth, RayPoint *r)
{
  static const PetscReal ez[3] = {0, 0, 1};

  ContactRayFunctions(f->m, f->s.order, r->xi, depth, &r->S);
  ContactRayFunctions(f->m, 1, r->xi, depth > 2 ? 2 : depth, &r->V);
  ContactChartAt(f, r->xi, &r->chart);
  ContactRayLatticeSum(&f->s, r->S.N, r->p);
  ContactRayLatticeSum(&f->d, r->V.N, r->d);
  memcpy(r->t[1], ez, sizeof(ez));
  for (PetscInt i = 0; i < f->m; i++) {
    ContactRayLatticeSum(&f->s, r->S.d[i], r->t[i]);
    ContactRayLatticeSum(&f->d, r->V.d[i], r->di[i]);
  }
  for (PetscInt i = 0; i < 2 * f->m - 1 && depth > 1; i++) ContactRayLatticeSum(&f->s, r->S.dd[i], r->tt[i]);
  for (PetscInt i = 0; i < 3 * f->m - 2 && depth > 2; i++) ContactRayLatticeSum(&f->s, r->S.ddd[i], r->ttt[i]);
  if (f->m == 2 && depth > 1) ContactRayLatticeSum(&f->d, r->V.dd[1], r->dij);
  ContactRayDensities(f, r);
}

PetscBool ContactRayInverse(RayPoint *r)
{
  PetscReal normal[3], det, over;

  Cross3(r->Xi[0], r->Xi[1], normal);
  det = -Dot3(r->d, normal);
  if (!(det > CONTACT_GRAZE * PetscSqrtReal(Dot3(normal, normal) * Dot3(r->d, r->d)))) return PETSC_FALSE;
  Cross3(r->d, r->Xi[1], r->zeta[0]);
  Cross3(r->Xi[0], r->d, r->zeta[1]);
  over = 1 / det;
  for (int c = 0; c < 3; c++) {
    r->kappa[c] = normal[c] * over;
    r->zeta[0][c] *= over;
    r->zeta[1][c] *= over;
  }
  return PETSC_TRUE;
}

void ContactRayMortar(PetscInt m, PetscInt order, const PetscReal eta[2], int depth, RayFunctions *M)
{
  ContactRayBeyond(&Mean, m, order, eta, depth, M);
}

/* Mortar facet at eta; K^-1. */
static PetscBool Mortar_Private(const RayFacet *f, const RayLattice *mortar, int depth, RayPoint *r)
{
  ContactRayMortar(f->m, mortar->order, r->eta, PetscMin(depth, 2), &r->M);
  ContactRayLatticeSum(mortar, r->M.N, r->X);
  r->Xi[1][0] = r->Xi[1][1] = 0, r->Xi[1][2] = 1;
  for (PetscInt i = 0; i < f->m; i++) ContactRayLatticeSum(mortar, r->M.d[i], r->Xi[i]);
  for (PetscInt i = 0; i < 2 * f->m - 1 && depth > 1; i++) ContactRayLatticeSum(mortar, r->M.dd[i], r->Xij[i]);
  return ContactRayInverse(r);
}

void ContactRayOpen(const RayFacet *f, RayPoint *r)
{
  r->open   = r->s;
  r->dopen  = 0;
  r->closes = f->closes;
  if (!f->closes) return;
  const PetscReal square = Dot3(r->d, r->d), over = 1 / PetscSqrtReal(square), *c = f->closed;
  PetscReal       closed = 0;

  r->closing[0] = r->closing[1] = r->closing[2] = 0;
  for (PetscInt v = 0; v < f->nv; v++) {
    closed += r->V.N[v] * c[v];
    for (PetscInt i = 0; i < f->m; i++) r->closing[i] += over * r->V.d[i][v] * c[v];
  }
  if (f->m == 2) r->closing[2] = over * (c[0] - c[1] - c[2] + c[3]) / 4;
  r->open -= closed * over;
  r->dopen = closed * over / square;
}

void ContactRayOpening(const RayPoint *r, PetscReal R[3])
{
  const PetscReal closed = r->s - r->open;

  for (int c = 0; c < 3; c++) R[c] = r->X[c] - r->p[c] - closed * r->d[c];
}

void ContactRayOpeningTurns(const RayPoint *r, const PetscReal dd[3], PetscReal dR[3])
{
  const PetscReal closed = r->s - r->open, along = r->dopen * Dot3(r->d, dd);

  for (int c = 0; c < 3; c++) dR[c] -= closed * dd[c] - along * r->d[c];
}

void ContactRayOpeningAlong(const RayPoint *r, PetscInt k, PetscReal dR[3])
{
  ContactRayOpeningTurns(r, r->di[k], dR);
  for (int c = 0; c < 3 && r->closes; c++) dR[c] -= r->closing[k] * r->d[c];
}

/* e = x - x_m, and the length along the ray. Steps zeta . (e + s d) to where they meet do not depend on s: zeta . d = 0, kappa . d = -1. */
static void Along_Private(const RayFacet *f, RayPoint *r, PetscReal e[3])
{
  for (int c = 0; c < 3; c++) e[c] = r->p[c] - r->X[c];
  r->s = Dot3(r->kappa, e);
  ContactRayOpen(f, r);
}

/* Does the mortar facet reach as far as where the ray met it? */
static PetscBool Inside_Private(const RayFacet *f, const RayPoint *r)
{
  for (PetscInt i = 0; i < f->m; i++)
    if (!(PetscAbsReal(r->eta[i]) < FACET_OUTSIDE)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* From r->eta as a first guess. */
PetscBool ContactRaySolve(const RayFacet *f, const RayLattice *mortar, const PetscReal xi[2], int depth, RayPoint *r)
{
  PetscReal step = 1;

  if (f->m == 2 && f->s.order == 1 && mortar->order == 1) return ContactRayBilinear(f, mortar, xi, PETSC_FALSE, depth, r);
  r->xi[0] = xi[0], r->xi[1] = xi[1];
  Facet_Private(f, depth, r);
  for (int k = 0; k < 20; k++) {
    const PetscBool last = (PetscBool)(step < CONTACT_ROUND); /* the last step left a square of that */
    PetscReal       e[3];

    if (!Mortar_Private(f, mortar, last ? depth : 1, r)) return PETSC_FALSE;
    Along_Private(f, r, e);
    if (last) return Inside_Private(f, r);
    step = 0;
    for (PetscInt i = 0; i < f->m; i++) {
      const PetscReal move = Dot3(r->zeta[i], e);

      r->eta[i] += move;
      step = PetscMax(step, PetscAbsReal(move));
    }
    if (!(step < 10)) return PETSC_FALSE;
  }
  return PETSC_FALSE;
}

PetscBool ContactRayAgain(const RayFacet *f, const RayLattice *mortar, const RayPlace *place, int depth, RayPoint *r)
{
  PetscReal e[3];

  for (int i = 0; i < 2; i++) r->eta[i] = place->eta[i];
  if (f->m == 2 && f->s.order == 1 && mortar->order == 1) return ContactRayBilinear(f, mortar, place->xi, PETSC_TRUE, depth, r);
  for (int i = 0; i < 2; i++) r->xi[i] = place->xi[i];
  Facet_Private(f, depth, r);
  if (!Mortar_Private(f, mortar, depth, r)) return PETSC_FALSE;
  Along_Private(f, r, e);
  return PETSC_TRUE;
}

PetscReal ContactRayGap(const RayPoint *r)
{
  return r->open * r->beta * r->rho;
}

PetscReal ContactRayArea(const RayPoint *r)
{
  return r->a * r->rho;
}

INLINE void First_Private(PetscInt D, PetscInt na, PetscInt nv, PetscInt nb, const RayPoint *r, PetscReal gap[], PetscReal area[], PetscReal gap_xi[2],
                          PetscReal area_xi[2])
{
  const PetscInt  m  = D - 1;
  const PetscReal br = r->beta * r->rho, sr = r->open * r->rho;
  PetscReal       A[3], B[2][3], C[3], E[3], Aa[3] = {r->a * r->turn, 0, 0}, Ba[2][3];

  Cross3(r->t[1], r->d, B[0]);
  Cross3(r->d, r->t[0], B[1]);
  Cross3(r->t[1], r->unit, Ba[0]);
  Cross3(r->unit, r->t[0], Ba[1]);
  for (int c = 0; c < 3; c++) {
    A[c] = br * r->kappa[c] + (c == 0 ? r->open * r->beta * r->turn : 0);
    C[c] = br * r->s * r->kappa[c] + sr * r->n[c];
    if (r->closes) C[c] += br * r->dopen * r->d[c];
    E[c] = -br * r->kappa[c];
    for (int k = 0; k < 2; k++) B[k][c] *= sr, Ba[k][c] *= r->rho;
  }
  ContactRaySlopes(D, m, na, r->S.N, A, r->S.d, B, gap);
  ContactRaySet(D, nv, r->V.N, C, gap + D * na);
  ContactRaySet(D, nb, r->M.N, E, gap + D * (na + nv));
  ContactRaySlopes(D, m, na, r->S.N, Aa, r->S.d, Ba, area);
  for (PetscInt i = 0; i < m; i++) {
    gap_xi[i]  = Dot3(A, r->t[i]) + Dot3(C, r->di[i]) - (r->closes ? br * r->closing[i] : 0);
    area_xi[i] = Dot3(Aa, r->t[i]);
    for (PetscInt k = 0; k < m; k++) {
      gap_xi[i] += Dot3(B[k], r->tt[i + k]);
      area_xi[i] += Dot3(Ba[k], r->tt[i + k]);
    }
  }
}

/* Facets of order 1 with numbers that are known here: loops are unrolled. */
void ContactRayFirst(const RayFacet *f, const RayLattice *mortar, const RayPoint *r, PetscReal gap[], PetscReal area[], PetscReal gap_xi[2],
                     PetscReal area_xi[2])
{
  const PetscInt num = f->s.num == mortar->num && f->s.num == f->nv ? f->nv : 0;

  if (num == 2)
    First_Private(2, 2, 2, 2, r, gap, area, gap_xi, area_xi);
  else if (num == 4)
    First_Private(3, 4, 4, 4, r, gap, area, gap_xi, area_xi);
  else
    First_Private(f->D, f->s.num, f->nv, mortar->num, r, gap, area, gap_xi, area_xi);
}
