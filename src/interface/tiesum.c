/* Rows of a tied pair (tie.c) out of its functions (tiecarrier.c). B_j: vectors int psi_j (x_m - x_s) dA of functions, less the arms of the facets. The row of
   node j along q is that of its functions, but for what acts along a direction h in which nodes of the facet are held:

     G_j = sum over functions of v.B_j,   v = (q.h) h for those of h,   v = q - sum_h (q.h) h for those where nothing is held.

   Compliances S the same way: v.q' S_jl between components along q and q'. */
#include "interfaceimpl.h"

#define FLAT 1e-12 /* of a facet: a gap that is round-off of positions */

/* q of component k of a node, and v; false: v is 0. */
static PetscBool Share_Private(const Contact *c, PetscInt functions, PetscInt facet, PetscInt node, PetscInt k, PetscReal q[3], PetscReal v[3])
{
  const Tie *t = c->tie;

  TieAxis_Private(&c->side[0], node, k, q);
  for (PetscInt d = 0; d < 3; ++d) v[d] = functions ? 0 : q[d];
  for (PetscInt i = functions ? functions : 1; i < (functions ? functions + 1 : t->num_functions); ++i) {
    const PetscReal *h = t->functions[i].along, along = t->functions[i].here[facet] ? Dot3(q, h) : 0;
    for (PetscInt d = 0; d < 3; ++d) v[d] += (functions ? along : -along) * h[d];
  }
  return (PetscBool)(!TieHolds_Private(&c->side[0], node, k) && Dot3(v, v) > 0);
}

/* Coefficients of g by the frame. */
static void Coefficients_Private(PetscReal e[3][3], const PetscReal g[3], PetscReal arm[3])
{
  for (int i = 0; i < 3; ++i) {
    PetscReal across[3];
    Cross3(e[(i + 1) % 3], e[(i + 2) % 3], across);
    arm[i] = Dot3(across, g) / Dot3(across, e[i]);
  }
}

/* v.g of the gap of a row at the reference positions: closed, or in arms. A gap that is round-off is none: flat surfaces have no arms. */
static void Arms_Private(const Contact *c, const PetscReal g[3], PetscReal weight, const PetscReal v[3], PetscInt r, TieFacet *t)
{
  PetscReal e[3][3], arm[3];

  TieFrame_Private(&c->side[0], c->side[0].X, t->facet.facet, e);
  if (c->spec->close || Dot3(g, g) <= PetscSqr(FLAT * weight) * Dot3(e[0], e[0])) {
    t->start[r] += Dot3(v, g);
    return;
  }
  Coefficients_Private(e, g, arm);
  for (PetscInt i = 0; i < 9; ++i) t->arm[9 * r + i] += arm[i / 3] * v[i % 3];
  if (arm[2] != 0) t->bends = PETSC_TRUE;
}

/* Compliance of component k by those of other rows; place: those of the nodes. */
static PetscErrorCode Soften_Private(const Contact *c, PetscInt functions, PetscInt k, const ContactFacet *from, const PetscInt place[], TieFacet *t)
{
  const Surface *s   = &c->side[0];
  const PetscInt dim = s->dim, nr = t->facet.num_rows;
  PetscReal      q[3], v[3];

  PetscFunctionBegin;
  if (!from->compliance) PetscFunctionReturn(PETSC_SUCCESS);
  if (!t->soft) PetscCall(PetscCalloc1(dim * nr * nr, &t->soft));
  for (PetscInt r = 0; r < from->num_rows; ++r) {
    if (!Share_Private(c, functions, from->facet, from->nodes[r], k, q, v)) continue;
    for (PetscInt i = 0; i < dim * from->num_rows; ++i) {
      const PetscInt m = i / from->num_rows, l = i % from->num_rows;
      if (TieHolds_Private(s, from->nodes[l], m)) continue;
      TieAxis_Private(s, from->nodes[l], m, q);
      t->soft[(dim * place[r] + m) * nr + place[l]] += Dot3(v, q) * ContactCompliance_Private(from, r, l);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A facet's result of these functions, added to the rows of component k. */
static PetscErrorCode Add_Private(const Contact *c, PetscInt functions, PetscInt k, const ContactFacet *from, TieFacet *t)
{
  const PetscInt dim = c->side[0].dim;
  PetscInt      *place;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(from->num, &place));
  for (PetscInt a = 0; a < from->num; ++a)
    while (t->facet.nodes[place[a]] != from->nodes[a]) ++place[a];
  for (PetscInt r = 0; r < from->num_rows; ++r) {
    PetscReal q[3], v[3], g[3] = {0, 0, 0};
    if (!Share_Private(c, functions, from->facet, from->nodes[r], k, q, v)) continue;
    for (PetscInt a = 0; a < from->num; ++a) {
      const PetscInt  id = from->nodes[a];
      const PetscReal w  = from->tie[r * from->num + a];
      for (PetscInt d = 0; d < dim; ++d) {
        g[d] += w * c->side[NODE_SIDE(id)].X[dim * NODE_INDEX(id) + d];
        t->tie[dim * (t->facet.num * place[r] + place[a]) + d] += w * v[d];
      }
    }
    t->weight[place[r]] += Dot3(v, q) * from->weight[r];
    Arms_Private(c, g, from->weight[r], v, place[r], t);
  }
  PetscCall(Soften_Private(c, functions, k, from, place, t));
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An empty facet: rows of all nodes whose functions are made together with its own and that carry anything. */
static PetscErrorCode Open_Private(const Contact *c, const ContactFacet *from, TieFacet *t)
{
  const Surface *s = &c->side[0];
  PetscInt      *nodes, nr = 0, num, dim = s->dim;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->true_first[from->facet + 1] - s->true_first[from->facet] + from->num, &nodes));
  for (PetscInt k = s->true_first[from->facet]; k < s->true_first[from->facet + 1]; ++k)
    if (c->tie->functions[0].carries[s->true_node[k]]) nodes[nr++] = s->true_node[k];
  num = nr;
  for (PetscInt a = 0; a < from->num; ++a) {
    PetscInt r = 0;
    while (r < nr && nodes[r] != from->nodes[a]) ++r;
    if (r == nr) nodes[num++] = from->nodes[a];
  }
  *t = (TieFacet){.facet = {.facet = from->facet, .num_rows = nr, .num = num, .nodes = nodes}};
  PetscCall(PetscCalloc4(nr, &t->weight, nr, &t->gap, nr, &t->start, 9 * nr, &t->arm));
  PetscCall(PetscCalloc2(dim * nr * num, &t->tie, dim * nr * num, &t->dgap));
  t->facet.weight = t->weight;
  t->facet.gap    = t->gap;
  t->facet.dgap   = t->dgap;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OpenAll_Private(Contact *c, PetscInt num, const ContactFacet facets[])
{
  Tie *t = c->tie;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < c->num; ++k) {
    t->num_facets[k] = num;
    PetscCall(PetscCalloc1(num, &t->facets[k]));
    for (PetscInt f = 0; f < c->side[0].num_facets; ++f) t->result[k][f] = -1;
    for (PetscInt i = 0; i < num; ++i) {
      PetscCall(Open_Private(c, &facets[i], &t->facets[k][i]));
      t->result[k][facets[i].facet] = i;
    }
  }
  for (PetscInt i = 0; i < num; ++i)
    if (c->mine[facets[i].facet]) c->view.area += facets[i].area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Functions_Private(Contact *c, PetscInt functions)
{
  const PetscInt      n       = c->side[0].num_nodes;
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  Tie                *t       = c->tie;
  TieFunctions       *f       = &t->functions[functions];
  const ContactFacet *facets;
  const PetscInt     *first, *donor;
  const PetscReal    *donor_weight;
  PetscInt            num;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(ContactPairSetCarriers(c->pair, &side[0], f->carries, f->late));
  PetscCall(ContactPairTie(c->pair, &side[0], &side[1], &num, &facets, &failed));
  if (!functions) PetscCall(OpenAll_Private(c, num, facets));
  for (PetscInt i = 0; i < num; ++i) {
    const PetscInt at = t->result[0][facets[i].facet];
    for (PetscInt k = 0; k < c->num && at >= 0 && (!functions || f->here[facets[i].facet]); ++k)
      PetscCall(Add_Private(c, functions, k, &facets[i], &t->facets[k][at]));
  }
  ContactPairGetDonors(c->pair, &first, &donor, &donor_weight);
  PetscCall(PetscMalloc3(n + 1, &f->donor_first, first[n], &f->donor, first[n], &f->donor_weight));
  PetscCall(PetscArraycpy(f->donor_first, first, n + 1));
  PetscCall(PetscArraycpy(f->donor, donor, first[n]));
  PetscCall(PetscArraycpy(f->donor_weight, donor_weight, first[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Second derivatives of arms in space, by the masters of the facet's corners. */
static PetscErrorCode Masters_Private(const Surface *s, TieFacet *t)
{
  PetscInt *node, num = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(4 * MOST_LATTICE_MASTERS, &node));
  for (PetscInt k = 0; k < s->corners; ++k) {
    const PetscReal *weight;
    const PetscInt  *master, rows = SurfaceRow_Private(s, &s->facets[s->corners * t->facet.facet + k], &master, &weight);
    for (PetscInt i = 0; i < rows; ++i) node[num++] = master[i];
  }
  PetscCall(PetscSortRemoveDupsInt(&num, node));
  PetscCall(PetscCalloc1(9 * num * num, &t->hessian));
  t->bend = (ContactFacet){.facet = t->facet.facet, .num = num, .nodes = node, .hessian = t->hessian};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Component k at the nodes. */
static PetscErrorCode Nodes_Private(Interface p, Contact *c, PetscInt k)
{
  const Surface *s = &c->side[0];
  const PetscInt n = s->num_nodes;
  Tie           *t = c->tie;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
    TieFacet      *f  = &t->facets[k][i];
    const PetscInt nr = f->facet.num_rows;
    for (PetscInt r = 0; r < nr; ++r) {
      const PetscInt j = n * k + f->facet.nodes[r];
      if (!s->owned[f->facet.nodes[r]]) continue;
      t->weight[j] += f->weight[r];
      if (f->soft) t->spring[j] += f->soft[(p->dim * r + k) * nr + r];
    }
    if (f->bends && p->dim == 3 && p->spec->kinematics == KINEMATICS_FINITE) PetscCall(Masters_Private(s, f));
  }
  PetscCall(LinkSpread_Private(p, &s->values, 1, t->weight + n * k));
  for (PetscInt j = 0; j < n; ++j)
    t->carries[n * k + j] = (PetscBool)(t->functions[0].carries[j] && !TieHolds_Private(s, j, k) && t->weight[n * k + j] > CONTACT_ROUND * c->w0[j]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieSum_Private(Interface p, Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->tie->num_functions; ++i) PetscCall(Functions_Private(c, i));
  for (PetscInt k = 0; k < p->dim; ++k) PetscCall(Nodes_Private(p, c, k));
  PetscFunctionReturn(PETSC_SUCCESS);
}
