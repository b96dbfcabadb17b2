/* Loads: dead tractions and body forces, evaluated once for each time, as follower pressures that depend on the place are; follower pressures. */
#include "mechanicsimpl.h"

PetscInt MechanicsOutwardSign_Private(PetscInt side)
{
  return (side / 2 == 1 ? -1 : 1) * (side % 2 ? 1 : -1);
}

static PetscBool HasLoad_Private(const BoundarySpec *b)
{
  return (PetscBool)(BoundaryHasPressure(b) || BoundaryHasTraction(b));
}

/* Closure index of a side of a leaf: 1 in every direction but the side's. */
static PetscInt SideIndex_Private(PetscInt dim, PetscInt side)
{
  PetscInt index = 0, stride = 1;
  for (PetscInt d = 0; d < dim; ++d, stride *= 3) index += (d == side / 2 ? 2 * (side % 2) : 1) * stride;
  return index;
}

PetscErrorCode MechanicsLoadFacets_Private(Mechanics m)
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  for (PetscInt pass = 0; pass < 2; ++pass) {
    PetscInt num_pressures = 0;
    m->num_facets          = 0;
    for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
      const PetscInt *cl = t->closure + t->closure_offset[t->first[t->dim] + v->cell_leaf[c]];
      if (m->cell_group[c] < 0) continue;
      for (PetscInt side = 0; side < 2 * m->dim; ++side) {
        const uint64_t groups = t->boundary[cl[SideIndex_Private(m->dim, side)]];
        for (PetscInt b = 0; groups && b < m->spec->num_boundaries; ++b) {
          if (!((groups >> m->spec->boundaries[b].group) & 1) || !HasLoad_Private(&m->spec->boundaries[b])) continue;
          const PetscInt  np     = FacetNumPoints(m->dim, m->groups[m->cell_group[c]].order);
          const PetscBool varies = (PetscBool)(m->spec->boundaries[b].pressure && ExpressionUsesPlace(m->spec->boundaries[b].pressure));
          if (pass) m->facets[m->num_facets] = (LoadFacet){c, side, b, varies ? num_pressures : -1};
          m->num_facets++;
          num_pressures += varies ? np : 0;
        }
      }
    }
    if (!pass) PetscCall(PetscMalloc1(m->num_facets, &m->facets));
    if (!pass) PetscCall(PetscCalloc1(num_pressures, &m->pressures));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Trace nodes of a side in lexicographic order of the remaining directions; returns their number. */
static PetscInt TraceNodes_Private(PetscInt dim, PetscInt order, PetscInt side, PetscInt nodes[])
{
  const PetscInt n = order + 1, d = side / 2, fixed = side % 2 ? order : 0;
  PetscInt       num = 0;
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i) {
    const PetscInt index[3] = {i % n, (i / n) % n, i / (n * n)};
    if (index[d] == fixed) nodes[num++] = i;
  }
  return num;
}

PetscInt MechanicsTrace_Private(Mechanics m, const LoadFacet *f, PetscInt nodes[], PetscReal X[])
{
  const CellGroup *g    = &m->groups[m->cell_group[f->cell]];
  const PetscReal *cell = g->X + m->cell_index[f->cell] * g->n * m->dim;
  const PetscInt   num  = TraceNodes_Private(m->dim, g->order, f->side, nodes);
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt c = 0; c < m->dim; ++c) X[i * m->dim + c] = cell[nodes[i] * m->dim + c];
  return num;
}

static void PutTrace_Private(PetscInt dim, PetscInt num, const PetscInt nodes[], const PetscReal *trace, PetscReal *cell)
{
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt c = 0; c < dim; ++c) cell[nodes[i] * dim + c] = trace[i * dim + c];
}

/* A load at the points of a facet. */
static PetscErrorCode Values_Private(Mechanics m, PetscInt order, const PetscReal trace[], const LoadExpression *load, PetscReal value[])
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  if (ExpressionUsesPlace(load->expression)) {
    PetscCall(MechanicsLoadMoments_Private(m->dim, order, trace, load, m->t, value));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MechanicsValue(load->expression, load->amplitude, origin, m->t, &value[0]));
  for (PetscInt q = 1; q < FacetNumPoints(m->dim, order); ++q) value[q] = value[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FacetTraction_Private(Mechanics m, const LoadFacet *f, PetscReal *work)
{
  const CellGroup    *g = &m->groups[m->cell_group[f->cell]];
  const BoundarySpec *b = &m->spec->boundaries[f->boundary];
  PetscInt            nodes[MOST_FACET_NODES], np = FacetNumPoints(m->dim, g->order);
  PetscReal           trace[3 * MOST_FACET_NODES], r[3 * MOST_FACET_NODES], traction[MOST_FACET_POINTS][3], value[MOST_FACET_POINTS];

  PetscFunctionBegin;
  const PetscInt num = MechanicsTrace_Private(m, f, nodes, trace);
  PetscCall(PetscMemzero(traction, sizeof(traction)));
  for (PetscInt c = 0; c < m->dim; ++c) {
    const LoadExpression load = {b->traction[c], &b->amplitude};
    if (!b->traction[c]) continue;
    PetscCall(Values_Private(m, g->order, trace, &load, value));
    for (PetscInt q = 0; q < np; ++q) traction[q][c] = value[q];
  }
  PetscCall(FacetTraction(m->dim, m->spec->model, g->order, trace, traction[0], r));
  PetscCall(PetscArrayzero(work, g->n * m->dim));
  PutTrace_Private(m->dim, num, nodes, r, work);
  PetscCall(HPSpaceScatterAdd(m->space, f->cell, work, m->dead));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r -= int N f dV of one cell, by a point more in each direction than its stress. */
static PetscErrorCode CellForce_Private(Mechanics m, const CellGroup *g, const BodySpec *body, const PetscReal *X, PetscReal *r)
{
  const Basis1D *basis;
  PetscReal      value[(MORTISE_MAX_ORDER + 1) * MOST_FACET_NODES], gradient[3 * (MORTISE_MAX_ORDER + 1) * MOST_FACET_NODES];

  PetscFunctionBegin;
  PetscCall(Basis1DGet(g->order, CellLinePoints(g->order) + 1, &basis));
  for (PetscInt q = 0; q < ElementNumNodes(m->dim, basis->num_points - 1); ++q) {
    PetscReal xi[3], J[9] = {0, 0, 0, 0, 0, 0, 0, 0, (PetscReal)(m->dim == 2)}, x[3] = {0, 0, 0}, weight, f;
    weight = Basis1DPoint(basis, m->dim, q, xi);
    PetscCall(ElementEvaluate(m->dim, g->order, xi, value, gradient));
    for (PetscInt i = 0; i < g->n; ++i) {
      for (PetscInt c = 0; c < m->dim; ++c) {
        x[c] += value[i] * X[i * m->dim + c];
        for (PetscInt d = 0; d < m->dim; ++d) J[3 * c + d] += gradient[i * m->dim + d] * X[i * m->dim + c];
      }
    }
    weight *= Det3(J);
    if (m->spec->model == MODEL_AXISYMMETRIC) weight *= 2 * PETSC_PI * x[0];
    for (PetscInt c = 0; c < m->dim; ++c) {
      if (!body->force[c]) continue;
      PetscCall(MechanicsValue(body->force[c], &body->amplitude, x, m->t, &f));
      for (PetscInt i = 0; i < g->n; ++i) r[i * m->dim + c] -= weight * f * value[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BodyForces_Private(Mechanics m, PetscReal *work)
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const BodySpec *body = &m->spec->bodies[t->leaf_body[v->cell_leaf[c]]];
    if (m->cell_group[c] < 0 || !(body->force[0] || body->force[1] || body->force[2])) continue;
    const CellGroup *g = &m->groups[m->cell_group[c]];
    PetscCall(PetscArrayzero(work, g->n * m->dim));
    PetscCall(CellForce_Private(m, g, body, g->X + m->cell_index[c] * g->n * m->dim, work));
    PetscCall(HPSpaceScatterAdd(m->space, c, work, m->dead));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool AnyDeadLoad_Private(Mechanics m)
{
  for (PetscInt b = 0; b < m->spec->num_boundaries; ++b) {
    const BoundarySpec *s = &m->spec->boundaries[b];
    if (BoundaryHasTraction(s)) return PETSC_TRUE;
  }
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) {
    const BodySpec *s = &m->spec->bodies[b];
    if (s->force[0] || s->force[1] || s->force[2]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode Pressures_Private(Mechanics m)
{
  PetscInt  nodes[MOST_FACET_NODES];
  PetscReal trace[3 * MOST_FACET_NODES];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    const LoadFacet     *f    = &m->facets[i];
    const BoundarySpec  *b    = &m->spec->boundaries[f->boundary];
    const LoadExpression load = {b->pressure, &b->amplitude};
    if (f->pressure < 0) continue;
    (void)MechanicsTrace_Private(m, f, nodes, trace);
    PetscCall(Values_Private(m, m->groups[m->cell_group[f->cell]].order, trace, &load, m->pressures + f->pressure));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsDeadLoads_Private(Mechanics m)
{
  PetscReal *work;

  PetscFunctionBegin;
  PetscCall(Pressures_Private(m));
  if (!AnyDeadLoad_Private(m)) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(m->space);
  if (!m->dead) PetscCall(PetscMalloc1(v->num_nodes * m->dim, &m->dead));
  PetscCall(PetscArrayzero(m->dead, v->num_nodes * m->dim));
  PetscCall(PetscMalloc1(3 * (MORTISE_MAX_ORDER + 1) * MOST_FACET_NODES, &work));
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    const BoundarySpec *b = &m->spec->boundaries[m->facets[i].boundary];
    if (BoundaryHasTraction(b)) PetscCall(FacetTraction_Private(m, &m->facets[i], work));
  }
  PetscCall(BodyForces_Private(m, work));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsDeadWork(Mechanics m, const PetscReal u[], PetscReal *work)
{
  PetscFunctionBegin;
  *work             = 0;
  const HPTables *v = HPSpaceGetTables(m->space);
  for (PetscInt i = 0; i < v->num_nodes * m->dim && m->dead; ++i) *work -= m->dead[i] * u[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follower pressure on one facet: residual into r, tangent (full cell matrix in K) when asked. Small kinematics: the load stays on the reference facet. */
static PetscErrorCode FacetFollower_Private(Mechanics m, const LoadFacet *f, const PetscReal u[], PetscReal *values, PetscReal *r, PetscReal *K)
{
  const CellGroup *g = &m->groups[m->cell_group[f->cell]];
  PetscInt         nodes[MOST_FACET_NODES], np = FacetNumPoints(m->dim, g->order), nd = g->n * m->dim;
  PetscReal        trace[3 * MOST_FACET_NODES], rt[3 * MOST_FACET_NODES], pressure[MOST_FACET_POINTS], *Kt = NULL;
  const PetscReal  origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  const PetscInt num = MechanicsTrace_Private(m, f, nodes, trace), size = num * m->dim;
  for (PetscInt q = 0; q < np && f->pressure >= 0; ++q) pressure[q] = m->pressures[f->pressure + q];
  if (f->pressure < 0) PetscCall(MechanicsPressure(m, f->boundary, origin, m->t, &pressure[0]));
  for (PetscInt q = 1; q < np && f->pressure < 0; ++q) pressure[q] = pressure[0];
  if (m->spec->kinematics == KINEMATICS_FINITE) {
    PetscCall(HPSpaceGather(m->space, f->cell, u, values));
    for (PetscInt i = 0; i < num; ++i)
      for (PetscInt c = 0; c < m->dim; ++c) trace[i * m->dim + c] += values[nodes[i] * m->dim + c];
    if (K) PetscCall(PetscMalloc1(size * size, &Kt));
  }
  PetscCall(FacetPressure(m->dim, m->spec->model, g->order, trace, MechanicsOutwardSign_Private(f->side), pressure, rt, Kt));
  PetscCall(PetscArrayzero(r, nd));
  PutTrace_Private(m->dim, num, nodes, rt, r);
  if (K) PetscCall(PetscArrayzero(K, nd * nd));
  for (PetscInt i = 0; Kt && i < size; ++i) {
    for (PetscInt j = 0; j < size; ++j) K[(nodes[i / m->dim] * m->dim + i % m->dim) * nd + nodes[j / m->dim] * m->dim + j % m->dim] = Kt[i * size + j];
  }
  PetscCall(PetscFree(Kt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsFollowers_Private(Mechanics m, const PetscReal u[], PetscReal r[], MatrixSink sink, void *context)
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    const LoadFacet *f = &m->facets[i];
    if (!BoundaryHasPressure(&m->spec->boundaries[f->boundary])) continue;
    const PetscInt nd = m->groups[m->cell_group[f->cell]].n * m->dim, most = m->dim * (v->cell_row[f->cell + 1] - v->cell_row[f->cell]);
    PetscReal     *work, *values, *K = NULL, *Km = NULL;
    PetscInt      *dofs, num;
    PetscCall(PetscMalloc3(nd, &work, nd, &values, most, &dofs));
    if (sink) PetscCall(PetscMalloc2(nd * nd, &K, most * most, &Km));
    PetscCall(FacetFollower_Private(m, f, u, values, work, K));
    if (r) PetscCall(HPSpaceScatterAdd(m->space, f->cell, work, r));
    if (sink) {
      PetscCall(HPSpaceTransformMatrix(m->space, f->cell, K, Km, dofs, &num));
      PetscCall(sink(context, -1, num, dofs, Km));
      PetscCall(PetscFree2(K, Km));
    }
    PetscCall(PetscFree3(work, values, dofs));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsLoadRate(Mechanics m, const PetscReal u[], PetscReal dt, PetscReal rate[])
{
  const PetscReal t = m->t;
  const HPTables *v = HPSpaceGetTables(m->space);
  PetscReal      *r;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes * m->dim, &r));
  for (PetscInt side = -1; side <= 1; side += 2) {
    PetscCall(MechanicsSetTime(m, t + side * dt));
    PetscCall(PetscArrayzero(r, v->num_nodes * m->dim));
    PetscCall(MechanicsFollowers_Private(m, u, r, NULL, NULL));
    for (PetscInt i = 0; i < v->num_nodes * m->dim; ++i) rate[i] += side * (r[i] + (m->dead ? m->dead[i] : 0)) / (2 * dt);
  }
  PetscCall(MechanicsSetTime(m, t));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
