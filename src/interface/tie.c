/* Tied surfaces: both sides are glued to each other as they face at the reference positions (docs/theory.md, 5). The multipliers of a node are the components
   of a traction along the axes q_k of its dofs, which are those of its supports. Row of node j and component k:

     G_jk = q_k . [ sum_a t_ja x_a - sum over facets of (a e_1 + b e_2 + c N) ] = 0,   sum_a t_ja x_a = int psi_j (x_m - x_s) dA,

   and, on facets covered in part, what their compliance adds, (S z)_jk, as in contact (compliance.c);
   e_i and N the diagonals and the vector of the nonmortar facet (plane: the edge and its vector), a, b and c constants such that the rows vanish at the
   reference positions: a gap between both surfaces turns with the facet beside it. In the plane the rows are linear, in space N is of second degree. With
   initial_gap: close these constants are 0. A node carries no multiplier along the axes in which supports hold it, and one at which tied pairs meet none at
   all: functions psi_j depend on the direction, and rows are sums over those of several (tiecarrier.c, tiesum.c). */
#include "interfaceimpl.h"

/* ---- rows ------------------------------------------------------------------------------------------------------------------------------- */

void TieFrame_Private(const Surface *s, const PetscReal x[], PetscInt facet, PetscReal e[3][3])
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

/* Derivative of the arm by the positions, times -1. */
static void ArmGradient_Private(const Surface *s, const ContactFacet *f, PetscReal e[3][3], const PetscReal arm[], PetscReal to[])
{
  PetscReal v[2][3];

  for (int i = 0; i < s->dim - 1; ++i) { /* arm . (dx x y) = dx . (y x arm) */
    Cross3(e[1 - i], arm + 6, v[i]);
    for (int d = 0; d < 3; ++d) v[i][d] = arm[3 * i + d] + (i ? -1 : 1) * v[i][d];
  }
  AtCorner_Private(s, f, s->dim - 1, -1, v[0], to);
  AtCorner_Private(s, f, 0, 1, v[0], to);
  if (s->dim == 2) return;
  AtCorner_Private(s, f, 3, -1, v[1], to);
  AtCorner_Private(s, f, 1, 1, v[1], to);
}

/* Values and derivatives of the rows of a facet's component at positions x. */
static void Rows_Private(const Contact *c, TieFacet *t, PetscBool values)
{
  const Surface      *s   = &c->side[0];
  const PetscInt      dim = s->dim, num = t->facet.num;
  const ContactFacet *f = &t->facet;
  PetscReal           e[3][3];

  TieFrame_Private(s, values ? s->x : s->X, f->facet, e);
  for (PetscInt r = 0; r < f->num_rows; ++r) {
    const PetscReal *tie = t->tie + r * dim * num, *arm = t->arm + 9 * r;
    PetscReal       *d = t->dgap + r * dim * num;
    memcpy(d, tie, (size_t)(dim * num) * sizeof(PetscReal));
    ArmGradient_Private(s, f, e, arm, d);
    if (!values) continue;
    t->gap[r] = 0;
    for (PetscInt i = 0; i < 3; ++i) t->gap[r] -= Dot3(arm + 3 * i, e[i]);
    for (PetscInt i = 0; i < dim * num; ++i) t->gap[r] += tie[i] * c->side[NODE_SIDE(f->nodes[i / dim])].x[dim * NODE_INDEX(f->nodes[i / dim]) + i % dim];
  }
}

/* Second derivatives of z . G, those of N in space, on the masters of the facet's corners. */
static void Bend_Private(const Contact *c, TieFacet *t, const PetscReal z[])
{
  static const int Corner[2][2] = {{2, 0}, {3, 1}};
  const Surface   *s            = &c->side[0];
  const PetscInt   n            = 3 * t->bend.num;
  PetscReal        sum[3]       = {0, 0, 0};

  if (!t->hessian) return;
  for (PetscInt r = 0; r < t->facet.num_rows; ++r)
    for (int d = 0; d < 3; ++d) sum[d] += z[t->facet.nodes[r]] * t->arm[9 * r + 6 + d];
  memset(t->hessian, 0, (size_t)(n * n) * sizeof(PetscReal));
  for (int i = 0; i < 2; ++i)
    for (int b = 0; b < 2; ++b)
      for (int d = 0; d < 3; ++d) { /* component d of an end of e_i, with the other diagonal */
        const PetscReal  axis[3] = {d == 0, d == 1, d == 2};
        const PetscReal *weight;
        const PetscInt  *master, num = SurfaceRow_Private(s, &s->facets[4 * t->facet.facet + Corner[i][b]], &master, &weight);
        PetscReal        v[3];
        Cross3(axis, sum, v);
        for (int q = 0; q < 3 && i != b; ++q) v[q] *= -1;
        for (PetscInt m = 0; m < num; ++m) {
          PetscReal *row = t->hessian + n * (3 * Place_Private(&t->bend, master[m]) + d);
          AtCorner_Private(s, &t->bend, Corner[1 - i][0], weight[m], v, row);
          AtCorner_Private(s, &t->bend, Corner[1 - i][1], -weight[m], v, row);
        }
      }
}

/* ---- what is kept of a mesh --------------------------------------------------------------------------------------------------------- */

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
  Tie           *t;

  PetscFunctionBegin;
  if (!c->law->ties) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&t));
  c->tie = t;
  PetscCall(PetscCalloc5(p->dim * n, &t->carries, p->dim * n, &t->weight, p->dim * n, &t->gap, p->dim * n, &t->lift, p->dim * n, &t->spring));
  PetscCall(PetscCalloc1(p->dim * n, &t->z));
  c->view.z = t->z;
  for (PetscInt k = 0; k < p->dim; ++k) PetscCall(PetscMalloc1(c->side[0].num_facets, &t->result[k]));
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  PetscCall(TieCarriers_Private(p, c));
  PetscCall(TieSum_Private(p, c));
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
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) Rows_Private(c, &t->facets[k][i], PETSC_FALSE);
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
      PetscCall(PetscFree4(f->weight, f->gap, f->start, f->arm));
      PetscCall(PetscFree2(f->tie, f->dgap));
      PetscCall(FreeAll(4, (void *[]){&f->facet.nodes, &f->bend.nodes, &f->hessian, &f->soft}));
    }
    PetscCall(PetscFree(t->facets[k]));
    PetscCall(PetscFree(t->result[k]));
  }
  for (PetscInt i = 0; i < t->num_functions; ++i) {
    TieFunctions *f = &t->functions[i];
    PetscCall(PetscFree3(f->carries, f->late, f->here));
    PetscCall(PetscFree3(f->donor_first, f->donor, f->donor_weight));
  }
  PetscCall(PetscFree(t->functions));
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

/* To all that use them, and to hanging nodes. */
static PetscErrorCode Spread_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->dim; ++k) {
    PetscCall(LinkSpread_Private(p, &s->values, 1, c->tie->z + s->num_nodes * k));
    SurfaceFollow_Private(s, 1, c->tie->z + s->num_nodes * k);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The traction at node j from nodes that its functions went to, along h. */
static void Donate_Private(const Contact *c, const TieFunctions *f, PetscInt j, const PetscReal h[3], PetscReal z[])
{
  const PetscInt n = c->side[0].num_nodes, dim = c->side[0].dim;

  for (PetscInt m = f->donor_first[j]; m < f->donor_first[j + 1]; ++m) {
    PetscReal along = 0;
    for (PetscInt d = 0; d < dim; ++d) along += h[d] * z[n * d + f->donor[m]];
    for (PetscInt d = 0; d < dim; ++d) z[n * d + j] += f->donor_weight[m] * along * h[d];
  }
}

/* Tractions along the coordinates. Where nodes carry no component, or none at all, from others: first what acts along directions in which they are held. */
static PetscErrorCode Shown_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];
  const Tie     *t = c->tie;
  const PetscInt n = s->num_nodes, dim = p->dim;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n * dim; ++i) {
    t->z[i] = 0;
    for (PetscInt k = 0; k < dim; ++k) t->z[i] += s->frame[dim * (dim * (i % n) + k) + i / n] * c->z[n * k + i % n];
  }
  for (PetscInt i = 0; i < t->num_functions * s->num_own; ++i) {
    const PetscInt j = s->own[i % s->num_own], function = i / s->num_own;
    if (function && t->functions[0].carries[j]) Donate_Private(c, &t->functions[function], j, t->functions[function].along, t->z);
  }
  PetscCall(Spread_Private(p, c));
  for (PetscInt i = 0; i < dim * s->num_own; ++i) {
    const PetscInt  j       = s->own[i / dim];
    const PetscReal axis[3] = {i % dim == 0, i % dim == 1, i % dim == 2};
    if (!t->functions[0].carries[j]) Donate_Private(c, &t->functions[0], j, axis, t->z);
  }
  PetscCall(Spread_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceResolveTies(Interface p, PetscInt pair, PetscReal z[])
{
  const Contact *c = &p->contacts[pair];
  const Surface *s = &c->side[0];

  for (PetscInt i = 0; i < s->num_own && c->tie; ++i) NodeTurn_Private(s->dim, s->frame + s->dim * s->dim * s->own[i], z + s->own[i], s->num_nodes);
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
      if (!small) Rows_Private(c, f, PETSC_TRUE);
      if (!small) Bend_Private(c, f, c->z + n * k);
      for (PetscInt r = 0; r < e->num_rows; ++r) {
        if (!c->side[0].owned[e->nodes[r]]) continue;
        for (PetscInt l = 0; l < p->dim * e->num_rows && f->soft; ++l)
          gap[e->nodes[r]] += f->soft[p->dim * e->num_rows * r + l] * c->z[n * (l / e->num_rows) + e->nodes[l % e->num_rows]];
        gap[e->nodes[r]] += small ? f->start[r] + ContactFacetDot_Private(c, e, e->dgap + p->dim * r * e->num) : e->gap[r];
      }
    }
  }
  PetscCall(Shown_Private(p, c));
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
