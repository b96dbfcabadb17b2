/* Tied surfaces: both sides are glued to each other as they face at the reference positions (docs/theory.md, 5). The multipliers of a node are the components
   of a traction. Row of node j and component k:

     G_jk = [ sum_a t_ja x_a - sum over facets of (a e_1 + b e_2 + c N) ]_k = 0,   sum_a t_ja x_a = int psi_j (x_m - x_s) dA,

   and, on facets covered in part, what their compliance adds, (S z)_jk, as in contact (compliance.c);
   e_i and N the diagonals and the vector of the nonmortar facet (plane: the edge and its vector), a, b and c constants such that the rows vanish at the
   reference positions: a gap between both surfaces turns with the facet beside it. In the plane the rows are linear, in space N is of second degree. With
   initial_gap: close these constants are 0. Functions psi_j depend on the component: a node that a support does not leave free along an axis of the coordinates
   carries no multiplier of that component, and one at which tied pairs meet none at all. */
#include "interfaceimpl.h"

#define FLAT 1e-12 /* of a facet: a gap that is round-off of positions */

/* ---- rows ------------------------------------------------------------------------------------------------------------------------------- */

/* Diagonals e[0], e[1] of a facet with these corners and its vector e[2]; plane: e[1] = e_z. */
static void Frame_Private(const Surface *s, const PetscReal x[], PetscInt facet, PetscReal e[3][3])
{
  const PetscInt *v = s->facets + s->corners * facet;

  memset(e, 0, 3 * sizeof(e[0]));
  if (s->dim == 2) e[1][2] = 1;
  for (PetscInt d = 0; d < s->dim; ++d) {
    e[0][d] = x[s->dim * v[s->dim - 1] + d] - x[s->dim * v[0] + d];
    if (s->dim == 3) e[1][d] = x[3 * v[3] + d] - x[3 * v[1] + d];
  }
  Cross3(e[0], e[1], e[2]);
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

/* Place of a node among those of a facet's result. */
static PetscInt Place_Private(const ContactFacet *f, PetscInt node)
{
  PetscInt at = 0;
  while (f->nodes[at] != node) ++at;
  return at;
}

/* to[dim num] += factor v at corner number `corner` of the facet, or at its masters. */
static void AtCorner_Private(const Surface *s, const ContactFacet *f, PetscInt corner, PetscReal factor, const PetscReal v[3], PetscReal to[])
{
  const PetscReal *weight;
  const PetscInt  *master, num = SurfaceRow_Private(s, &s->facets[s->corners * f->facet + corner], &master, &weight);

  for (PetscInt i = 0; i < num; ++i) {
    const PetscInt at = s->dim * Place_Private(f, master[i]);
    for (PetscInt d = 0; d < s->dim; ++d) to[at + d] += factor * weight[i] * v[d];
  }
}

/* Derivative of component k of the arm by the positions, times -1. */
static void ArmGradient_Private(const Surface *s, const ContactFacet *f, PetscInt k, PetscReal e[3][3], const PetscReal arm[3], PetscReal to[])
{
  PetscReal unit[3] = {k == 0, k == 1, k == 2}, v[2][3];

  for (int i = 0; i < s->dim - 1; ++i) { /* e_k . (dx x y) = dx . (y x e_k) */
    Cross3(e[1 - i], unit, v[i]);
    for (int d = 0; d < 3; ++d) v[i][d] = arm[i] * unit[d] + (i ? -1 : 1) * arm[2] * v[i][d];
  }
  AtCorner_Private(s, f, s->dim - 1, -1, v[0], to);
  AtCorner_Private(s, f, 0, 1, v[0], to);
  if (s->dim == 2) return;
  AtCorner_Private(s, f, 3, -1, v[1], to);
  AtCorner_Private(s, f, 1, 1, v[1], to);
}

/* Values and derivatives of the rows of a facet's component k at positions x. */
static void Rows_Private(const Contact *c, TieFacet *t, PetscInt k, PetscBool values)
{
  const Surface      *s   = &c->side[0];
  const PetscInt      dim = s->dim, num = t->facet.num;
  const ContactFacet *f = &t->facet;
  PetscReal           e[3][3];

  Frame_Private(s, values ? s->x : s->X, f->facet, e);
  for (PetscInt r = 0; r < f->num_rows; ++r) {
    PetscReal *d = t->dgap + r * dim * num, *arm = t->arm + 3 * r;
    memset(d, 0, (size_t)(dim * num) * sizeof(PetscReal));
    if (values) t->gap[r] = -(arm[0] * e[0][k] + arm[1] * e[1][k] + arm[2] * e[2][k]);
    for (PetscInt a = 0; a < num; ++a) {
      d[dim * a + k] = f->tie[r * num + a];
      if (values) t->gap[r] += f->tie[r * num + a] * c->side[NODE_SIDE(f->nodes[a])].x[dim * NODE_INDEX(f->nodes[a]) + k];
    }
    ArmGradient_Private(s, f, k, e, arm, d);
  }
}

/* Second derivatives of z . G, those of N in space, on the masters of the facet's corners. */
static void Bend_Private(const Contact *c, TieFacet *t, PetscInt k, const PetscReal z[])
{
  static const int Corner[2][2] = {{2, 0}, {3, 1}};
  const Surface   *s            = &c->side[0];
  const PetscInt   n            = 3 * t->bend.num;
  PetscReal        sum          = 0;

  if (!t->hessian) return;
  for (PetscInt r = 0; r < t->facet.num_rows; ++r) sum += z[t->facet.nodes[r]] * t->arm[3 * r + 2];
  memset(t->hessian, 0, (size_t)(n * n) * sizeof(PetscReal));
  for (int i = 0; i < 2; ++i)
    for (int b = 0; b < 2; ++b)
      for (int d = 0; d < 3; ++d) { /* component d of an end of e_i, with the other diagonal */
        const PetscReal  unit[3] = {k == 0, k == 1, k == 2}, axis[3] = {d == 0, d == 1, d == 2};
        const PetscReal *weight;
        const PetscInt  *master, num = SurfaceRow_Private(s, &s->facets[4 * t->facet.facet + Corner[i][b]], &master, &weight);
        PetscReal        v[3];
        Cross3(axis, unit, v);
        for (int q = 0; q < 3; ++q) v[q] *= i == b ? sum : -sum;
        for (PetscInt m = 0; m < num; ++m) {
          PetscReal *row = t->hessian + n * (3 * Place_Private(&t->bend, master[m]) + d);
          AtCorner_Private(s, &t->bend, Corner[1 - i][0], weight[m], v, row);
          AtCorner_Private(s, &t->bend, Corner[1 - i][1], -weight[m], v, row);
        }
      }
}

/* ---- what is kept of a mesh --------------------------------------------------------------------------------------------------------- */

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

/* Of component k. A gap that is round-off is none: flat surfaces have no arms. */
static void Arms_Private(const Contact *c, PetscInt k, TieFacet *t)
{
  const Surface *s = &c->side[0];
  PetscReal      e[3][3];

  Frame_Private(s, s->X, t->facet.facet, e);
  for (PetscInt r = 0; r < t->facet.num_rows; ++r) {
    PetscReal g[3] = {0, 0, 0};
    for (PetscInt a = 0; a < t->facet.num; ++a) {
      const PetscInt id = t->facet.nodes[a];
      for (PetscInt d = 0; d < s->dim; ++d) g[d] += t->facet.tie[r * t->facet.num + a] * c->side[NODE_SIDE(id)].X[s->dim * NODE_INDEX(id) + d];
    }
    t->start[r] = g[k];
    if (c->spec->close || Dot3(g, g) <= PetscSqr(FLAT * t->facet.weight[r]) * Dot3(e[0], e[0])) continue;
    t->start[r] = 0;
    Coefficients_Private(e, g, t->arm + 3 * r);
    if (t->arm[3 * r + 2] != 0) t->bends = PETSC_TRUE;
  }
}

/* A facet's result, copied: the pair's next evaluation overwrites it. */
static PetscErrorCode Keep_Private(Interface p, const Contact *c, PetscInt k, const ContactFacet *from, TieFacet *t)
{
  const PetscInt nr = from->num_rows, num = from->num;
  PetscInt      *nodes;
  PetscReal     *weight, *tie, *compliance; /* of no size: NULL */

  PetscFunctionBegin;
  *t = (TieFacet){.facet = *from};
  PetscCall(PetscMalloc3(num, &nodes, nr, &weight, from->compliance ? nr : 0, &compliance));
  PetscCall(PetscMalloc1(nr * num, &tie));
  PetscCall(PetscCalloc4(nr, &t->gap, nr, &t->start, 3 * nr, &t->arm, p->dim * nr * num, &t->dgap));
  PetscCall(PetscArraycpy(nodes, from->nodes, num));
  PetscCall(PetscArraycpy(weight, from->weight, nr));
  PetscCall(PetscArraycpy(tie, from->tie, nr * num));
  if (from->compliance) PetscCall(PetscArraycpy(compliance, from->compliance, nr));
  t->facet.compliance = compliance;
  t->facet.nodes      = nodes;
  t->facet.weight     = weight;
  t->facet.tie        = tie;
  t->facet.gap        = t->gap;
  t->facet.dgap       = t->dgap;
  Arms_Private(c, k, t);
  if (t->bends && p->dim == 3 && p->spec->kinematics == KINEMATICS_FINITE) PetscCall(Masters_Private(&c->side[0], t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Component k. */
static PetscErrorCode Component_Private(Interface p, Contact *c, PetscInt k, const PetscBool carries[])
{
  const Surface      *s       = &c->side[0];
  const PetscInt      n       = s->num_nodes;
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  Tie                *t       = c->tie;
  const ContactFacet *facets;
  const PetscInt     *first, *donor;
  const PetscReal    *donor_weight;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(ContactPairSetCarriers(c->pair, &side[0], carries));
  PetscCall(ContactPairTie(c->pair, &side[0], &side[1], &t->num_facets[k], &facets, &failed));
  PetscCall(PetscCalloc1(t->num_facets[k], &t->facets[k]));
  for (PetscInt f = 0; f < s->num_facets; ++f) t->result[k][f] = -1;
  for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
    TieFacet *f = &t->facets[k][i];
    PetscCall(Keep_Private(p, c, k, &facets[i], f));
    t->result[k][f->facet.facet] = i;
    if (k == 0 && c->mine[f->facet.facet]) c->view.area += f->facet.area;
    for (PetscInt r = 0; r < f->facet.num_rows; ++r) {
      const PetscInt j = n * k + f->facet.nodes[r];
      if (!s->owned[f->facet.nodes[r]]) continue;
      t->weight[j] += f->facet.weight[r];
      if (f->facet.compliance) t->spring[j] += ContactCompliance_Private(&f->facet, r, r);
    }
  }
  PetscCall(LinkSpread_Private(p, &s->values, 1, t->weight + n * k));
  for (PetscInt j = 0; j < n; ++j) t->carries[n * k + j] = (PetscBool)(carries[j] && t->weight[n * k + j] > CONTACT_ROUND * c->w0[j]);
  ContactPairGetDonors(c->pair, &first, &donor, &donor_weight);
  if (!first) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n + 1, &t->donor_first[k], first[n], &t->donor[k], first[n], &t->donor_weight[k]));
  PetscCall(PetscArraycpy(t->donor_first[k], first, n + 1));
  PetscCall(PetscArraycpy(t->donor[k], donor, first[n]));
  PetscCall(PetscArraycpy(t->donor_weight[k], donor_weight, first[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Moves_Private(const Surface *s, PetscInt n)
{
  for (PetscInt d = 0; d < s->dim; ++d)
    if (!((s->dof[s->dim * n] >> d) & 1)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A facet whose displacement is prescribed has no multipliers, and nothing would tie to it what can move. */
static PetscErrorCode CheckSides_Private(Interface p, const Contact *c)
{
  const Surface *s     = &c->side[0];
  PetscBool      loose = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->tie->num_facets[0]; ++i) {
    const ContactFacet *e     = &c->tie->facets[0][i].facet;
    PetscBool           moves = PETSC_FALSE, other = PETSC_FALSE;
    for (PetscInt k = s->true_first[e->facet]; k < s->true_first[e->facet + 1]; ++k) moves = (PetscBool)(moves || Moves_Private(s, s->true_node[k]));
    for (PetscInt a = 0; a < e->num && !moves; ++a)
      other = (PetscBool)(other || (NODE_SIDE(e->nodes[a]) && Moves_Private(&c->side[1], NODE_INDEX(e->nodes[a]))));
    loose = (PetscBool)(loose || other);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &loose, 1, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  PetscCheckInput(!loose,
                  "contact.%s: supports prescribe the displacement of facets on the side that carries the multipliers, which so cannot be tied; exchange "
                  "nonmortar and mortar, with roles: given where the bodies differ in stiffness",
                  c->spec->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieCreate_Private(Interface p, Contact *c)
{
  const PetscInt n = c->side[0].num_nodes;
  PetscBool     *carries;
  Tie           *t;

  PetscFunctionBegin;
  if (!c->law->ties) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&t));
  c->tie = t;
  PetscCall(PetscCalloc5(p->dim * n, &t->carries, p->dim * n, &t->weight, p->dim * n, &t->gap, p->dim * n, &t->lift, p->dim * n, &t->spring));
  PetscCall(PetscCalloc1(p->dim * n, &t->z));
  c->view.z = t->z;
  for (PetscInt k = 0; k < p->dim; ++k) PetscCall(PetscMalloc1(c->side[0].num_facets, &t->result[k]));
  PetscCall(PetscCalloc1(p->dim * n, &carries));
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  PetscCall(TieCarriers_Private(p, c, carries));
  for (PetscInt k = 0; k < p->dim; ++k) PetscCall(Component_Private(p, c, k, carries + n * k));
  PetscCall(PetscFree(carries));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->view.area, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscCheckInput(c->view.area > 0,
                  "contact.%s: nothing of one side faces the other within %g, so that nothing can be tied; with search: a number the distance is that many of "
                  "the longest edges",
                  c->spec->name, (double)c->distance);
  PetscCall(CheckSides_Private(p, c));
  for (PetscInt f = 0; f < c->side[0].num_facets; ++f) c->result[f] = -1;
  for (PetscInt j = 0; j < n; ++j) {
    c->near[j] = PETSC_TRUE;
    for (PetscInt k = 0; k < p->dim; ++k) {
      c->weight[j] = PetscMax(c->weight[j], t->weight[n * k + j]);
      if (t->carries[n * k + j]) c->active[j] = 1;
    }
  }
  for (PetscInt k = 0; k < p->dim && p->spec->kinematics == KINEMATICS_SMALL; ++k)
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) Rows_Private(c, &t->facets[k][i], k, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieDestroy_Private(Contact *c)
{
  Tie *t = c->tie;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->num; ++k) {
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
      TieFacet *f = &t->facets[k][i];
      PetscCall(PetscFree3(f->facet.nodes, f->facet.weight, f->facet.compliance));
      PetscCall(PetscFree(f->facet.tie));
      PetscCall(PetscFree4(f->gap, f->start, f->arm, f->dgap));
      PetscCall(PetscFree(f->bend.nodes));
      PetscCall(PetscFree(f->hessian));
    }
    PetscCall(PetscFree(t->facets[k]));
    PetscCall(PetscFree(t->result[k]));
    PetscCall(PetscFree3(t->donor_first[k], t->donor[k], t->donor_weight[k]));
  }
  PetscCall(PetscFree5(t->carries, t->weight, t->gap, t->lift, t->spring));
  PetscCall(PetscFree(t->z));
  PetscCall(PetscFree(c->tie));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool InterfaceTies(Interface p)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i)
    if (p->contacts[i].tie) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* ---- evaluation ------------------------------------------------------------------------------------------------------------------------- */

/* The traction where a component has no multiplier: from the nodes that its functions went to. */
static PetscErrorCode Shown_Private(Interface p, Contact *c, PetscInt k)
{
  const Surface *s = &c->side[0];
  const Tie     *t = c->tie;
  PetscReal     *z = t->z + s->num_nodes * k;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(z, c->z + s->num_nodes * k, s->num_nodes));
  for (PetscInt i = 0; i < s->num_own && t->donor_first[k]; ++i) {
    const PetscInt j = s->own[i];
    if (t->carries[s->num_nodes * k + j]) continue;
    z[j] = 0;
    for (PetscInt m = t->donor_first[k][j]; m < t->donor_first[k][j + 1]; ++m) z[j] += t->donor_weight[k][m] * z[t->donor[k][m]];
  }
  PetscCall(LinkSpread_Private(p, &s->values, 1, z));
  SurfaceFollow_Private(s, 1, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieEvaluate_Private(Interface p, Contact *c)
{
  const PetscBool small = (PetscBool)(p->spec->kinematics == KINEMATICS_SMALL);
  const PetscInt  n     = c->side[0].num_nodes;
  Tie            *t     = c->tie;

  PetscFunctionBegin;
  for (PetscInt side = 0; side < 2 && small; ++side) {
    Surface *s = &c->side[side];
    for (PetscInt i = 0; i < p->dim * s->num_nodes; ++i) s->du[i] = s->x[i] - s->X[i];
  }
  for (PetscInt k = 0; k < p->dim; ++k) {
    PetscReal *gap = t->gap + n * k;
    PetscCall(PetscArrayzero(gap, n));
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
      TieFacet           *f = &t->facets[k][i];
      const ContactFacet *e = &f->facet;
      if (!small) Rows_Private(c, f, k, PETSC_TRUE);
      if (!small) Bend_Private(c, f, k, c->z + n * k);
      const PetscReal mean = e->compliance ? ContactFacetMean(e, e->nodes, c->z + n * k) : 0;
      for (PetscInt r = 0; r < e->num_rows; ++r) {
        if (!c->side[0].owned[e->nodes[r]]) continue;
        if (e->compliance) gap[e->nodes[r]] += e->kappa[0] * e->compliance[r] * (c->z[n * k + e->nodes[r]] - mean);
        gap[e->nodes[r]] += small ? f->start[r] + ContactFacetDot_Private(c, e, e->dgap + p->dim * r * e->num) : e->gap[r];
      }
    }
  }
  for (PetscInt k = 0; k < p->dim; ++k) PetscCall(Shown_Private(p, c, k));
  c->view.min_gap = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TiePoint_Private(const Contact *c, PetscInt j, PetscBool lifted, ContactPoint *point)
{
  const Tie *t = c->tie;

  for (PetscInt k = 0; k < c->num; ++k) {
    const PetscInt i = c->side[0].num_nodes * k + j;
    point->tie[k]    = (TiePoint){t->gap[i], t->carries[i] ? t->weight[i] : 0, lifted ? t->lift[i] : 0, t->spring[i]};
  }
}

PetscErrorCode TieChange_Private(Interface p, Contact *c, const PetscReal increment[], PetscReal change[])
{
  const PetscInt n = c->side[0].num_nodes;
  const Tie     *t = c->tie;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], increment, NULL, c->side[k].du));
  PetscCall(PetscArrayzero(change, p->dim * n));
  for (PetscInt k = 0; k < p->dim; ++k)
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
      const ContactFacet *e = &t->facets[k][i].facet;
      for (PetscInt r = 0; r < e->num_rows; ++r)
        if (c->side[0].owned[e->nodes[r]]) change[n * k + e->nodes[r]] += ContactFacetDot_Private(c, e, e->dgap + p->dim * r * e->num);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TieForces_Private(Contact *c)
{
  const PetscInt dim = c->side[0].dim, n = c->side[0].num_nodes;
  const Tie     *t = c->tie;

  for (PetscInt k = 0; k < dim; ++k)
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
      const ContactFacet *e = &t->facets[k][i].facet;
      for (PetscInt r = 0; r < e->num_rows && c->mine[e->facet]; ++r) {
        const PetscReal z = t->carries[n * k + e->nodes[r]] ? c->z[n * k + e->nodes[r]] : 0;
        for (PetscInt a = 0; a < e->num && z != 0; ++a) {
          PetscReal *f = c->side[NODE_SIDE(e->nodes[a])].force + dim * NODE_INDEX(e->nodes[a]);
          for (PetscInt d = 0; d < dim; ++d) f[d] += z * e->dgap[dim * (r * e->num + a) + d];
        }
      }
    }
}
