/* Friction (docs/theory.md, 5): the slip since the pair's points were kept. Forces of tangential tractions: shear.c, shearplane.c.

   Slip. Points q of the pair at the positions x0 where they were kept, with A_jq = psi_j dgamma_q:
     s_j(x) = sum_q A_jq [ t.r(x) - t.r(x0) ],   r = x_m(eta_q) - x(xi_q),
   t = x,xi / |x,xi|; in space each of the node's axes as carried to the point (frame.c).

   Facets that met nothing at x0 have points, too, once they meet the other side: those of the last evaluation, with t.r(x0) of where these were at x0. Such a
   pair is another one at each iterate; for the derivative it is held. What that leaves out, (t.x_m,eta at x less that at x0) deta, vanishes for rigid motion.

   Compliance. On a facet that was covered in part slips count as s + C dq, dq the change of the tractions since then, C = kappa [diag m - m m^T / sum m] as
   for gaps (blend.c): constraints of functions of which slivers are covered say nearly the same. C is that of the positions x0, a constant of the step. */
#include "kernelimpl.h"

typedef struct {
  PetscInt  facet;
  RayPlace  at;
  PetscReal start[2]; /* t.r(x0), in space along the axes of the first row's node */
} Point;              /* facet: of the mortar side */

typedef struct {
  PetscInt facet, num_rows, num_points, row, point, value, micro; /* where its rows, points, values A[points][rows] and C begin; micro -1: no C */
} Kept;

struct ContactSlip {
  PetscInt      num_kept, num_rows, num_points, num_values, num_C, size_kept, size_row, size_weight, size_start, size_point, size_A, size_C;
  PetscInt      num_first, size_met; /* facets kept at x0: the first ones */
  PetscBool    *met;                 /* [num_facets] is it one of them? NULL: others have no points */
  Kept         *kept;
  PetscInt     *row;            /* nodes */
  PetscReal    *weight, *start; /* by rows: sum_q A_jq; [rows][2] sum_q A_jq t.r(x0) */
  Point        *point;
  PetscReal    *A, *C;
  Result        result;
  ContactFacet *facet; /* [num_kept] */
  PetscInt     *ids, num_ids, size_facet, size_ids;
};

PetscErrorCode ContactSlipDestroy(struct ContactSlip **slip)
{
  struct ContactSlip *s = *slip;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactResultDestroy(&s->result));
  PetscCall(FreeAll(10, (void *[]){&s->kept, &s->met, &s->row, &s->weight, &s->start, &s->point, &s->A, &s->C, &s->facet, &s->ids}));
  PetscCall(PetscFree(*slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairSetTraction(ContactPair pair, const PetscReal traction[])
{
  pair->traction     = traction;
  pair->state.stands = PETSC_FALSE;
}

PetscBool ContactSlipLoads(const EvaluateContext *ctx)
{
  const RayWork    w = ctx->pair->ray;
  const PetscReal *q = ctx->pair->traction;

  for (PetscInt r = 0; r < w->result.num_rows && q; r++)
    for (PetscInt i = 0; i < w->facet.m; i++)
      if (q[ctx->nonmortar->num_nodes * i + w->result.node[r]] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* to[D masters] of a row of nodes: v < na of the lattice, then mortar nodes. */
void ContactSlipMasters(const RayWork w, PetscInt stride, const PetscReal from[], PetscInt ld, PetscReal to[])
{
  const PetscInt D = w->facet.D;

  for (PetscInt v = 0; v < w->facet.s.num + w->num_mortar; v++)
    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (PetscInt c = 0; c < D; c++)
        for (PetscInt j = 0; j < stride; j++) to[(D * w->result.row_node[k] + c) * ld + j] += w->result.row_weight[k] * from[(D * v + c) * stride + j];
}

/* ---- points kept ------------------------------------------------------------------------------------------------------------------- */

/* A kept point where it is now. */
typedef struct {
  RayFunctions N, M;
  PetscReal    t[2][3], n[3], length, r[3]; /* tangents (plane: the second e_z), unit normal, length or area, distance */
} Now;

static void Now_Private(PetscInt m, const RayLattice *own, const RayLattice *other, const RayPlace *at, Now *o)
{
  static const PetscReal ez[3] = {0, 0, 1};
  PetscReal              x[3];

  ContactRayFunctions(m, own->order, at->xi, 1, &o->N);
  ContactRayMortar(m, other->order, at->eta, 1, &o->M);
  ContactRayLatticeSum(own, o->N.N, x);
  memcpy(o->t[1], ez, sizeof(ez));
  for (PetscInt i = 0; i < m; i++) ContactRayLatticeSum(own, o->N.d[i], o->t[i]);
  ContactRayLatticeSum(other, o->M.N, o->r);
  for (int c = 0; c < 3; c++) o->r[c] -= x[c];
  Cross3(o->t[0], o->t[1], o->n);
  o->length = PetscSqrtReal(Dot3(o->n, o->n));
  for (int c = 0; c < 3; c++) o->n[c] /= o->length;
}

/* The distance along an axis t, t.r, and how it changes: by r as t, by x,k as across[k]; in space by the axis and its normal as by[0] and by[1]. */
typedef struct {
  PetscReal along, t[3], across[2][3], by[2][3];
} Step;

static void InPlane_Private(const Now *o, Step *s)
{
  for (int c = 0; c < 3; c++) s->t[c] = o->t[0][c] / o->length;
  s->along = Dot3(s->t, o->r);
  for (int c = 0; c < 3; c++) s->across[0][c] = (o->r[c] - s->along * s->t[c]) / o->length;
}

static void InSpace_Private(const Now *o, const PetscReal m[3], const PetscReal e[3], Step *s)
{
  const PetscReal a = ContactCarry(m, o->n, e, s->t);
  PetscReal       A[3][3], B[3][3], v[3], along;

  ContactCarryRows(m, o->n, e, A, B);
  s->along = Dot3(s->t, o->r);
  for (int c = 0; c < 3; c++) {
    s->by[0][c] = A[0][c] * o->r[0] + A[1][c] * o->r[1] + A[2][c] * o->r[2];
    s->by[1][c] = -a * s->by[0][c];
    v[c]        = (B[0][c] * o->r[0] + B[1][c] * o->r[1] + B[2][c] * o->r[2]) / o->length;
  }
  along = Dot3(v, o->n);
  for (int c = 0; c < 3; c++) v[c] -= along * o->n[c];
  Cross3(o->t[1], v, s->across[0]);
  Cross3(v, o->t[0], s->across[1]);
}

/* Along the facet, or along axis i of a node. */
static void Step_Private(const ContactPair pair, const Now *now, PetscInt node, PetscInt i, Step *s)
{
  if (pair->dim == 2)
    InPlane_Private(now, s);
  else
    InSpace_Private(now, pair->ray->frame[node].m, pair->ray->frame[node].e[i], s);
}

/* start of a facet's rows, of its points at these positions; in space the nodes' axes are those there. */
static PetscErrorCode Start_Private(ContactPair pair, const Kept *kept, const ContactSurface *nonmortar, const ContactSurface *mortar)
{
  struct ContactSlip *s  = pair->slip;
  const PetscInt      nr = kept->num_rows, m = nonmortar->dim - 1;
  PetscReal          *start = s->start + 2 * kept->row;
  RayLattice          own, other;

  PetscFunctionBegin;
  ContactRayLatticeGather(nonmortar, kept->facet, &own);
  PetscCall(PetscArrayzero(start, 2 * nr));
  for (PetscInt q = 0; q < kept->num_points; q++) {
    Point           *p = &s->point[kept->point + q];
    const PetscReal *A = s->A + kept->value + q * nr;
    Now              now;
    Step             step;

    ContactRayLatticeGather(mortar, p->facet, &other);
    Now_Private(m, &own, &other, &p->at, &now);
    for (PetscInt j = 0; j < m * nr; j++) {
      Step_Private(pair, &now, s->row[kept->row + j % nr], j / nr, &step);
      start[2 * (j % nr) + j / nr] += A[j % nr] * step.along;
      if (j % nr == 0) p->start[j / nr] = step.along;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* context: the pair's points, the last facet of which is being kept. */
static PetscErrorCode KeepPoint_Private(void *context, RayWork w, PetscInt k, const PetscInt column[], PetscInt num_mortar, const RayPlace *place,
                                        const RayPoint *r, PetscReal area)
{
  struct ContactSlip *s    = context;
  Kept               *kept = &s->kept[s->num_kept - 1];
  const PetscInt      nr = kept->num_rows, na = w->facet.s.num;
  PetscReal          *A;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(s->num_points + 1, sizeof(Point), &s->size_point, &s->point));
  PetscCall(ArrayGrow(s->num_values + nr, sizeof(PetscReal), &s->size_A, &s->A));
  A = s->A + s->num_values;
  for (PetscInt j = 0; j < nr; j++) {
    A[j] = 0;
    for (PetscInt i = 0; i < na; i++) A[j] += w->T[j * na + i] * r->S.N[i] * area;
    s->weight[kept->row + j] += A[j];
  }
  s->point[s->num_points++] = (Point){.facet = w->mortar[k], .at = *place};
  s->num_values += nr;
  kept->num_points++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C of the facet at hand, by components and rows; axes of nodes that differ couple as vectors do. */
static PetscErrorCode KeepCompliance_Private(const EvaluateContext *ctx, const ContactFacet *out, struct ContactSlip *s, Kept *kept)
{
  const NodeFrame *frame = ctx->pair->ray->frame;
  const PetscInt   nr = kept->num_rows, m = ctx->pair->dim - 1, n = m * nr, *node = s->row + kept->row;

  PetscFunctionBegin;
  if (!out->compliance) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(s->num_C + n * n, sizeof(PetscReal), &s->size_C, &s->C));
  kept->micro = s->num_C;
  s->num_C += n * n;
  for (PetscInt i = 0; i < n * n; i++) {
    const PetscInt  j = i / n % nr, l = i % nr, a = i / n / nr, b = i % n / nr;
    const PetscReal along = m == 1 ? 1 : Dot3(frame[node[j]].e[a], frame[node[l]].e[b]);

    s->C[kept->micro + i] = along * out->kappa[0] * out->compliance[j] * ((PetscReal)(j == l) - out->compliance[l] / out->compliance_sum);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Keep_Private(const EvaluateContext *ctx, PetscInt facet, const ContactFacet *out)
{
  RayWork             w  = ctx->pair->ray;
  struct ContactSlip *s  = ctx->pair->slip;
  const PetscInt      nr = w->result.num_rows;
  Kept               *kept;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(s->num_kept + 1, sizeof(Kept), &s->size_kept, &s->kept));
  PetscCall(ArrayGrow(s->num_rows + nr, sizeof(PetscInt), &s->size_row, &s->row));
  PetscCall(ArrayGrow(s->num_rows + nr, sizeof(PetscReal), &s->size_weight, &s->weight));
  PetscCall(ArrayGrow(2 * (s->num_rows + nr), sizeof(PetscReal), &s->size_start, &s->start));
  kept  = &s->kept[s->num_kept++];
  *kept = (Kept){.facet = facet, .num_rows = nr, .row = s->num_rows, .point = s->num_points, .value = s->num_values, .micro = -1};
  for (PetscInt j = 0; j < nr; j++) {
    s->row[s->num_rows + j]    = w->result.node[j];
    s->weight[s->num_rows + j] = 0;
  }
  s->num_rows += nr;
  PetscCall(ContactRayWalk(w, ctx->mortar, KeepPoint_Private, s));
  if (ctx->pair->keeps) PetscCall(KeepCompliance_Private(ctx, out, s, kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactSlipForget(ContactPair pair)
{
  struct ContactSlip *s = pair->slip;

  if (!s || s->num_kept == s->num_first) return;
  const Kept *kept = &s->kept[s->num_first];
  s->num_rows      = kept->row;
  s->num_points    = kept->point;
  s->num_values    = kept->value;
  s->num_kept      = s->num_first;
}

PetscErrorCode ContactSlipFacet(const EvaluateContext *ctx, PetscInt facet, PetscBool derivatives, ContactFacet *out)
{
  ContactPair pair = ctx->pair;

  PetscFunctionBegin;
  out->shear = NULL;
  if (!pair->traction && !pair->keeps) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->ray->result.num_rows && (pair->keeps || (pair->slip && pair->slip->met && !pair->slip->met[facet]))) PetscCall(Keep_Private(ctx, facet, out));
  if (!pair->traction || !derivatives) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall((pair->dim == 3 ? ContactShear : ContactShearPlane)(ctx, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairKeepPoints(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscBool *failed)
{
  const ContactFacet *facets;
  struct ContactSlip *s;
  PetscInt            num;

  PetscFunctionBegin;
  if (!pair->slip) PetscCall(PetscNew(&pair->slip));
  s           = pair->slip;
  s->num_kept = s->num_first = s->num_rows = s->num_points = s->num_values = s->num_C = 0;

  pair->keeps        = PETSC_TRUE;
  pair->state.stands = PETSC_FALSE;
  PetscCall(ContactPairEvaluate(pair, nonmortar, mortar, NULL, NULL, PETSC_FALSE, PETSC_FALSE, &num, &facets, failed));
  pair->keeps = pair->state.stands = PETSC_FALSE;
  if (*failed) s->num_kept = s->num_rows = s->num_points = s->num_values = 0;
  s->num_first = s->num_kept;
  PetscCall(ArrayGrow(nonmortar->num_facets, sizeof(PetscBool), &s->size_met, &s->met));
  PetscCall(PetscArrayzero(s->met, nonmortar->num_facets));
  for (PetscInt i = 0; i < s->num_kept; i++) {
    s->met[s->kept[i].facet] = PETSC_TRUE;
    PetscCall(Start_Private(pair, &s->kept[i], nonmortar, mortar));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- slip -------------------------------------------------------------------------------------------------------------------------- */

/* gradient[nn] += factor f, a function of the vertex' nodes, in direction v. */
static void Add_Private(const Result *r, PetscInt vertex, PetscInt D, PetscReal f, const PetscReal v[], PetscReal gradient[])
{
  for (PetscInt k = r->row_first[vertex]; k < r->row_first[vertex + 1]; k++)
    for (PetscInt c = 0; c < D; c++) gradient[D * r->row_node[k] + c] += r->row_weight[k] * f * v[c];
}

/* Nodes of a kept facet's result: rows, its lattice, in space what the axes of the rows depend on, the lattices of the mortar facets it met: vertices, first[k]
   the first of point k's facet. */
static PetscErrorCode Vertices_Private(ContactPair pair, const Kept *kept, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt first[])
{
  struct ContactSlip *s   = pair->slip;
  PetscInt            num = 0, vertex = 0, place;
  Result             *r = &s->result;

  PetscFunctionBegin;
  r->num_nodes = 0;
  for (PetscInt j = 0; j < kept->num_rows; j++) PetscCall(ContactResultNode(r, s->row[kept->row + j], &place));
  for (PetscInt j = 0; j < kept->num_rows && pair->dim == 3; j++) PetscCall(ContactFrameNodes(pair->ray, nonmortar, s->row[kept->row + j], r));
  for (PetscInt k = -1; k < kept->num_points; k++) {
    const ContactSurface *side  = k < 0 ? nonmortar : mortar;
    const PetscInt        facet = k < 0 ? kept->facet : s->point[kept->point + k].facet;
    FacetLattice          l;

    if (k > 0 && facet == s->point[kept->point + k - 1].facet) {
      first[k] = first[k - 1];
      continue;
    }
    if (k >= 0) first[k] = vertex;
    ContactFacetLattice(side, facet, &l);
    PetscCall(ArrayGrow(vertex + l.num + 1, sizeof(PetscInt), &r->size_row_first, &r->row_first));
    for (PetscInt a = 0; a < l.num; a++, vertex++) PetscCall(ContactResultRow(r, side, l.node[a], (PetscBool)(k >= 0), vertex, &num));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* gradient[nn] += A times the step's change by the nodes. */
static void AddStep_Private(const Result *r, PetscInt D, const Now *o, PetscInt num_own, PetscInt first, PetscInt num_other, PetscReal A, const Step *s,
                            PetscReal gradient[])
{
  for (PetscInt a = 0; a < num_own; a++) {
    Add_Private(r, a, D, -A * o->N.N[a], s->t, gradient);
    for (PetscInt k = 0; k < D - 1; k++) Add_Private(r, a, D, A * o->N.d[k][a], s->across[k], gradient);
  }
  for (PetscInt b = 0; b < num_other; b++) Add_Private(r, first + b, D, A * o->M.N[b], s->t, gradient);
}

/* gradient[2 nr][nn] += by[2 nr][2][3], of the axes and their normals, times how these follow the nodes. */
static PetscErrorCode Axes_Private(ContactPair pair, const Kept *kept, const ContactSurface *nonmortar, const PetscReal by[][2][3], PetscReal gradient[])
{
  Result        *r  = &pair->slip->result;
  const PetscInt nn = 3 * r->num_nodes;
  PetscReal     *axes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(9 * nn, &axes));
  for (PetscInt j = 0; j < kept->num_rows; j++) {
    PetscCall(ContactFrameRows(pair->ray, nonmortar, pair->slip->row[kept->row + j], r, axes));
    for (PetscInt i = 0; i < 2; i++) {
      const PetscInt row = kept->num_rows * i + j;

      for (int c = 0; c < 3; c++)
        for (PetscInt k = 0; k < nn; k++) gradient[row * nn + k] += by[row][0][c] * axes[(3 * i + c) * nn + k] + by[row][1][c] * axes[(6 + c) * nn + k];
    }
  }
  PetscCall(PetscFree(axes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Slip_Private(ContactPair pair, const Kept *kept, const ContactSurface *nonmortar, const ContactSurface *mortar, ContactFacet *out)
{
  struct ContactSlip *s = pair->slip;
  const PetscInt      D = nonmortar->dim, m = D - 1, nr = kept->num_rows;
  PetscInt           *first, nn;
  PetscReal          *slip, *gradient, *row, (*by)[2][3];
  RayLattice          own, other;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(kept->num_points + 1, &first));
  PetscCall(Vertices_Private(pair, kept, nonmortar, mortar, first));
  nn = D * s->result.num_nodes;
  PetscCall(ContactStoreReserve(&s->result.store, m * nr * (1 + nn), &slip));
  gradient = slip + m * nr;
  PetscCall(PetscCalloc2(nn, &row, m * nr, &by));
  ContactRayLatticeGather(nonmortar, kept->facet, &own);
  for (PetscInt j = 0; j < m * nr; j++) slip[j] = -s->start[2 * (kept->row + j % nr) + j / nr];
  for (PetscInt q = 0; q < kept->num_points; q++) {
    const Point     *p = &s->point[kept->point + q];
    const PetscReal *A = s->A + kept->value + q * nr;
    Now              now;
    Step             step;

    ContactRayLatticeGather(mortar, p->facet, &other);
    Now_Private(m, &own, &other, &p->at, &now);
    if (D == 2) {
      Step_Private(pair, &now, 0, 0, &step);
      PetscCall(PetscArrayzero(row, nn));
      AddStep_Private(&s->result, D, &now, own.num, first[q], other.num, 1, &step, row);
    }
    for (PetscInt j = 0; j < m * nr; j++) {
      if (D == 3) {
        Step_Private(pair, &now, s->row[kept->row + j % nr], j / nr, &step);
        AddStep_Private(&s->result, D, &now, own.num, first[q], other.num, A[j % nr], &step, gradient + j * nn);
      }
      slip[j] += A[j % nr] * step.along;
      for (PetscInt i = 0; i < nn && D == 2; i++) gradient[j * nn + i] += A[j] * row[i];
      for (int c = 0; c < 6 && D == 3; c++) by[j][c / 3][c % 3] += A[j % nr] * step.by[c / 3][c % 3];
    }
  }
  if (D == 3) PetscCall(Axes_Private(pair, kept, nonmortar, (const PetscReal(*)[2][3])by, gradient));
  PetscCall(PetscMemzero(out, sizeof(*out)));
  out->facet    = kept->facet;
  out->num_rows = nr;
  out->num      = s->result.num_nodes;
  out->gap      = slip;
  out->weight   = s->weight + kept->row;
  out->dgap     = gradient;
  out->micro    = kept->micro < 0 ? NULL : s->C + kept->micro;
  PetscCall(PetscFree2(row, by));
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Space: axes of the nodes at these positions. */
static PetscErrorCode Turn_Private(ContactPair pair, const ContactSurface *nonmortar)
{
  PetscFunctionBegin;
  if (pair->dim == 2) PetscFunctionReturn(PETSC_SUCCESS);
  ContactDirections(pair->ray, nonmortar);
  PetscCall(ContactFrames(pair, nonmortar));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSlip(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const ContactSurface from[2], PetscInt *num,
                               const ContactFacet **facets)
{
  struct ContactSlip *s = pair->slip;

  PetscFunctionBegin;
  *num    = 0;
  *facets = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (!from) ContactSlipForget(pair);
  if (s->num_kept > s->num_first) PetscCall(Turn_Private(pair, &from[0]));
  for (PetscInt i = s->num_first; i < s->num_kept; i++) PetscCall(Start_Private(pair, &s->kept[i], &from[0], &from[1]));
  if (s->num_kept) PetscCall(Turn_Private(pair, nonmortar));
  s->result.store.at = s->result.store.used = 0;
  s->num_ids                                = 0;
  PetscCall(ArrayGrow(s->num_kept, sizeof(ContactFacet), &s->size_facet, &s->facet));
  for (PetscInt i = 0; i < s->num_kept; i++) {
    PetscCall(Slip_Private(pair, &s->kept[i], nonmortar, mortar, &s->facet[i]));
    PetscCall(ArrayGrow(s->num_ids + s->facet[i].num, sizeof(PetscInt), &s->size_ids, &s->ids));
    PetscCall(PetscArraycpy(s->ids + s->num_ids, s->result.node, s->facet[i].num));
    s->num_ids += s->facet[i].num;
  }
  s->num_ids = 0; /* the array is where it stays now */
  for (PetscInt i = 0; i < s->num_kept; i++) {
    s->facet[i].nodes = s->ids + s->num_ids;
    s->num_ids += s->facet[i].num;
  }
  *num    = s->num_kept;
  *facets = s->facet;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* t.r of a point changes by r as t and by the tangents x,k as across[k]; axes that turn in the facet's plane add no more than what r has in it. */
static PetscReal Linear_Private(PetscInt m, const Now *now, const Step *step, const RayLattice *own, const RayLattice *other)
{
  PetscReal du[3], along;

  ContactRayLatticeSum(other, now->M.N, du);
  along = Dot3(step->t, du);
  ContactRayLatticeSum(own, now->N.N, du);
  along -= Dot3(step->t, du);
  for (PetscInt k = 0; k < m; k++) {
    ContactRayLatticeSum(own, now->N.d[k], du);
    along += Dot3(step->across[k], du);
  }
  return along;
}

/* Slip of point q of a kept facet, and its weight. */
static void SlipPoint_Private(ContactPair pair, const Kept *kept, PetscInt q, const ContactSurface side[2], const ContactSurface *increment,
                              const RayLattice own[2], ContactSlipPoint *to)
{
  const struct ContactSlip *s = pair->slip;
  const Point              *p = &s->point[kept->point + q];
  const PetscInt            m = side[0].dim - 1;
  RayLattice                other[2];
  Now                       now;

  *to = (ContactSlipPoint){.facet = kept->facet, .mortar_facet = p->facet};
  for (PetscInt d = 0; d < m; d++) to->xi[d] = p->at.xi[d];
  for (PetscInt j = 0; j < kept->num_rows; j++) to->weight += s->A[kept->value + q * kept->num_rows + j];
  ContactRayLatticeGather(&side[1], p->facet, &other[0]);
  if (increment) ContactRayLatticeGather(&increment[1], p->facet, &other[1]);
  Now_Private(m, &own[0], &other[0], &p->at, &now);
  for (PetscInt i = 0; i < m; i++) {
    Step step;

    Step_Private(pair, &now, s->row[kept->row], i, &step);
    const PetscReal along = increment ? Linear_Private(m, &now, &step, &own[1], &other[1]) : step.along - p->start[i];
    for (int c = 0; c < 3; c++) to->slip[c] += along * step.t[c];
  }
}

PetscErrorCode ContactPairSlipPoints(ContactPair pair, const ContactSurface side[2], const ContactSurface increment[2], PetscInt *num,
                                     ContactSlipPoint **points)
{
  struct ContactSlip *s = pair->slip;

  PetscFunctionBegin;
  *num = 0;
  PetscCall(PetscMalloc1(s ? s->num_points : 0, points));
  if (!s || !s->num_kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Turn_Private(pair, &side[0]));
  for (PetscInt i = 0; i < s->num_kept; i++) {
    RayLattice own[2];

    ContactRayLatticeGather(&side[0], s->kept[i].facet, &own[0]);
    if (increment) ContactRayLatticeGather(&increment[0], s->kept[i].facet, &own[1]);
    for (PetscInt q = 0; q < s->kept[i].num_points; q++) SlipPoint_Private(pair, &s->kept[i], q, side, increment, own, &(*points)[(*num)++]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
