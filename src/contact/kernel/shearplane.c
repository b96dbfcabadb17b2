/* Friction in the plane (docs/theory.md, 5): forces of tangential tractions and their derivatives; in space: shear.c.

   Forces. S_j(y; x) = int psi_j y,xi . (y_m(eta) - y(xi)) rho dxi, points, bounds, eta, psi and rho of x, positions y: f = sum_j z_j dS_j/dy at y = x. By the
   facet's numbers, with R = x_m - x less what is closed of it, and t = x,xi, the density is  h_a = N_a,xi R - N_a t  of a node of its lattice,  h_b = M_b t  of
   a mortar node. Its change is that of the numbers at fixed xi, where deta = zeta . (N_a dx_a + s V_v dd_v - M_b dy_b), of the point's place, which goes with
   the ends of the overlap, and of psi with the covered share. */
#include "kernelimpl.h"

/* Weights y of the functions of the lattice in sum_r z_r psi_r, and how they change with the covered share. */
typedef struct {
  PetscReal y[RAY_LATTICE], dy[RAY_LATTICE];
} Functions;

static void Functions_Private(const EvaluateContext *ctx, Functions *o)
{
  const RayWork    w  = ctx->pair->ray;
  const PetscInt   na = w->facet.s.num, nr = w->result.num_rows;
  const PetscReal *z = ctx->pair->traction;

  for (PetscInt a = 0; a < na; a++) {
    o->y[a] = o->dy[a] = 0;
    for (PetscInt r = 0; r < nr && z; r++) {
      o->y[a] += z[w->result.node[r]] * w->T[r * na + a];
      o->dy[a] += z[w->result.node[r]] * w->T[(nr + r) * na + a];
    }
  }
}

/* Sums over a facet. Rows: numbers of the nodes that forces act on, those of the lattice and of the mortar nodes; columns: all numbers. */
typedef struct {
  PetscInt   rows, n;
  PetscReal *F; /* [lattice][rows] by the functions */
  PetscReal *K; /* [rows][n] of their sum weighted with y; NULL: not wanted */
} Sums;

/* Density of the forces h[2][na + nb], at a point, and its slope along the facet. */
static void Density_Private(const RayFacet *f, const RayLattice *mortar, const RayPoint *r, PetscReal h[2][2 * RAY_LATTICE],
                            PetscReal along[2][2 * RAY_LATTICE])
{
  PetscReal R[3], Ri[3], *t = (PetscReal *)r->t[0], etai = 0;

  for (int c = 0; c < 2; c++) etai += r->zeta[0][c] * (t[c] + r->s * r->di[0][c]);
  ContactRayOpening(r, R);
  for (int c = 0; c < 3; c++) Ri[c] = r->Xi[0][c] * etai - t[c];
  ContactRayOpeningAlong(r, 0, Ri);
  for (int c = 0; c < 2; c++) {
    for (PetscInt a = 0; a < f->s.num; a++) {
      h[c][a]     = r->S.d[0][a] * R[c] - r->S.N[a] * t[c];
      along[c][a] = r->S.dd[0][a] * R[c] + r->S.d[0][a] * (Ri[c] - t[c]) - r->S.N[a] * r->tt[0][c];
    }
    for (PetscInt b = 0; b < mortar->num; b++) {
      h[c][f->s.num + b]     = r->M.N[b] * t[c];
      along[c][f->s.num + b] = r->M.d[0][b] * etai * t[c] + r->M.N[b] * r->tt[0][c];
    }
  }
}

/* K += weight times the change of phi rho h by number (node, component e) of a group: of the lattice, the directions or the mortar nodes. */
static void Change_Private(const RayFacet *f, const RayLattice *mortar, const RayPoint *r, int group, PetscInt node, int e, PetscReal weight,
                           PetscReal h[2][2 * RAY_LATTICE], const PetscInt row[], PetscInt column, Sums *s)
{
  const PetscInt   na    = f->s.num;
  const PetscReal *t     = r->t[0];
  const PetscReal  value = group == 0 ? r->S.N[node] : group == 1 ? r->s * r->V.N[node] : -r->M.N[node], deta = r->zeta[0][e] * value;
  const PetscReal  ring  = group == 0 && e == 0 ? weight * r->turn * value : 0;
  PetscReal        dR[3] = {0, 0, 0}, dd[3] = {0, 0, 0}, dt[2] = {0, 0};

  for (int c = 0; c < 2; c++) dR[c] = r->Xi[0][c] * deta;
  if (group == 1) {
    dd[e] = r->V.N[node];
    ContactRayOpeningTurns(r, dd, dR);
  }
  if (group != 1) dR[e] -= value;
  if (group == 0) dt[e] = r->S.d[0][node];
  weight *= r->rho;
  for (int c = 0; c < 2; c++) {
    for (PetscInt a = 0; a < na; a++) s->K[row[2 * a + c] * s->n + column] += weight * (r->S.d[0][a] * dR[c] - r->S.N[a] * dt[c]) + ring * h[c][a];
    for (PetscInt b = 0; b < mortar->num; b++)
      s->K[row[2 * (na + b) + c] * s->n + column] += weight * (r->M.d[0][b] * deta * t[c] + r->M.N[b] * dt[c]) + ring * h[c][na + b];
  }
}

/* row[2 (na + nb)], by node and component: among the rows of the sums; column[]: of the overlap's numbers among the facet's (ContactRayPlaces). */
static void Rows_Private(const RayFacet *f, PetscInt nb, const PetscInt column[], PetscInt row[])
{
  const PetscInt na = f->s.num, D = f->D;

  for (int c = 0; c < 2; c++) {
    for (PetscInt a = 0; a < na; a++) row[2 * a + c] = column[c * na + a];
    for (PetscInt b = 0; b < nb; b++) row[2 * (na + b) + c] = column[D * (na + f->nv) + c * nb + b] - D * f->nv;
  }
}

static PetscErrorCode Overlap_Private(RayWork w, const ContactSurface *surface, PetscInt k, const PetscReal y[], const RayPlace **place, Sums *s)
{
  const RayFacet *f = &w->facet;
  const Overlap  *o = &w->overlap[k];
  const PetscInt  D = f->D, na = f->s.num;
  PetscInt        column[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES], row[4 * RAY_LATTICE], points;
  PetscReal       h[2][2 * RAY_LATTICE], along[2][2 * RAY_LATTICE];
  RayLattice      mortar;
  RayMove         move[FACET_VERTICES];
  RaySimplex      interval;
  const PetscReal(*point)[3], *weight;

  PetscFunctionBegin;
  ContactRayLatticeGather(surface, w->mortar[k], &mortar);
  ContactRayPlaces(w, surface, k, mortar.num, column);
  Rows_Private(f, mortar.num, column, row);
  ContactRayMoves(f, o, move);
  ContactRaySimplex(f, o, 0, &interval);
  PetscCall(ContactRayRule(f, o, mortar.order, &points, &point, &weight));
  for (PetscInt q = 0; q < points; q++, (*place)++) {
    const PetscReal W   = interval.size * weight[q];
    PetscReal       phi = 0, phi_xi = 0;
    RayPoint        r;

    PetscCheck(ContactRayAgain(f, &mortar, *place, 2, &r), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a ray that met the mortar facet does not meet it again");
    Density_Private(f, &mortar, &r, h, along);
    for (PetscInt i = 0; i < na; i++) {
      phi += y[i] * r.S.N[i];
      phi_xi += y[i] * r.S.d[0][i];
      for (PetscInt a = 0; a < na + mortar.num; a++)
        for (int c = 0; c < 2; c++) s->F[i * s->rows + row[2 * a + c]] += W * r.S.N[i] * r.rho * h[c][a];
    }
    if (!s->K) continue;
    for (int e = 0; e < 2; e++) {
      for (PetscInt a = 0; a < na; a++) Change_Private(f, &mortar, &r, 0, a, e, W * phi, h, row, column[e * na + a], s);
      for (PetscInt v = 0; v < f->nv; v++) Change_Private(f, &mortar, &r, 1, v, e, W * phi, h, row, column[D * na + e * f->nv + v], s);
      for (PetscInt b = 0; b < mortar.num; b++) Change_Private(f, &mortar, &r, 2, b, e, W * phi, h, row, column[D * (na + f->nv) + e * mortar.num + b], s);
    }
    for (PetscInt l = 0; l < 2; l++) { /* images */
      PetscReal dxi = 0, dsize = 0;

      for (int v = 0; v < 2; v++) {
        dxi += point[q][v] * move[interval.corner[v]].d[0][l];
        dsize += interval.d[v] * move[interval.corner[v]].d[0][l];
      }
      const PetscReal on = weight[q] * dsize * phi * r.rho + W * dxi * (phi_xi * r.rho + phi * r.turn * r.t[0][0]), slope = W * dxi * phi * r.rho;

      for (PetscInt a = 0; a < na + mortar.num; a++)
        for (int c = 0; c < 2; c++) s->K[row[2 * a + c] * s->n + column[D * (na + f->nv + mortar.num) + l]] += on * h[c][a] + slope * along[c][a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* H += the change of the forces, rows: forces. */
static PetscErrorCode Tangent_Private(RayWork w, const Sums *s, const Functions *o, PetscReal H[])
{
  const PetscInt   n = s->n, rows = s->rows;
  const PetscReal *dshare = w->dq + 2 * w->facet.s.num * n;
  PetscReal       *to;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < w->facet.s.num && w->share.part; a++)
    for (PetscInt i = 0; i < rows; i++)
      for (PetscInt j = 0; j < n; j++) s->K[i * n + j] += s->F[a * rows + i] * o->dy[a] * dshare[j];
  PetscCall(PetscCalloc1(rows * w->nn, &to));
  PetscCall(ContactRayChainForces(w, rows, s->K, to));
  ContactSlipMasters(w, w->nn, to, w->nn, H);
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactShearPlane(const EvaluateContext *ctx, ContactFacet *out)
{
  RayWork         w  = ctx->pair->ray;
  const PetscInt  na = w->facet.s.num, nr = w->result.num_rows;
  const RayPlace *place = w->places;
  Sums            s     = {.rows = w->facet.D * (na + w->num_mortar), .n = w->n};
  PetscReal      *shear, *row;
  Functions       o;

  PetscFunctionBegin;
  Functions_Private(ctx, &o);
  PetscCall(PetscCalloc3(na * s.rows, &s.F, s.rows * (out->hessian ? s.n : 0), &s.K, s.rows, &row));
  if (!out->hessian) s.K = NULL;
  for (PetscInt k = 0; k < w->num_overlaps; k++) PetscCall(Overlap_Private(w, ctx->mortar, k, o.y, &place, &s));
  PetscCall(ContactStoreReserve(&w->result.store, nr * w->nn, &shear));
  for (PetscInt r = 0; r < nr; r++) {
    PetscCall(PetscArrayzero(row, s.rows));
    for (PetscInt a = 0; a < na; a++)
      for (PetscInt i = 0; i < s.rows; i++) row[i] += w->T[r * na + a] * s.F[a * s.rows + i];
    ContactSlipMasters(w, 1, row, 1, shear + r * w->nn);
  }
  out->shear = shear;
  if (s.K) PetscCall(Tangent_Private(w, &s, &o, (PetscReal *)out->hessian));
  PetscCall(PetscFree3(s.F, s.K, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}
