/* Probes: points of the reference configuration, found once in the coarse mesh, evaluated on whatever leaves there are. */
#include "output.h"

#define PROBE_OUTSIDE 1e-2 /* share of a coarse cell by which a point may lie outside: on curved edges the mesh is not the user's drawing */
#define PROBE_NEWTON 30
#define TOUCHING 1e-6 /* share of a coarse cell: the point is in it, or on its side */

struct _p_Probes {
  PetscInt num;
  struct {
    PetscInt  root;  /* coarse cell */
    PetscReal xi[3]; /* place in it, [0,1] */
  } * place;         /* owned */
};

/* ---- the geometry of a coarse cell -------------------------------------------------------------------------------------- */

/* Lagrange functions of order q on equispaced nodes of [0,1] and their derivatives. */
static void Equispaced_Private(PetscInt q, PetscReal xi, PetscReal N[], PetscReal D[])
{
  const PetscReal s = xi * (PetscReal)q;

  for (PetscInt i = 0; i <= q; ++i) {
    N[i] = 1;
    D[i] = 0;
    for (PetscInt j = 0; j <= q; ++j) {
      if (j == i) continue;
      const PetscReal f = (s - (PetscReal)j) / (PetscReal)(i - j), df = (PetscReal)q / (PetscReal)(i - j);
      D[i] = D[i] * f + N[i] * df;
      N[i] *= f;
    }
  }
}

/* Position and its derivatives J[component][direction] (unit matrix beyond dim) in a coarse cell. */
static void Geometry_Private(const CoarseMesh *mesh, PetscInt cell, const PetscReal xi[3], PetscReal X[3], PetscReal J[3][3])
{
  const PetscInt   q = mesh->geometry_order, n = q + 1, nz = mesh->dim == 3 ? n : 1;
  const PetscReal *node = mesh->cell_geometry + 3 * cell * ElementNumNodes(mesh->dim, q);
  PetscReal        N[3][MORTISE_MAX_ORDER + 1], D[3][MORTISE_MAX_ORDER + 1];

  N[2][0] = 1;
  D[2][0] = 0;
  for (PetscInt d = 0; d < mesh->dim; ++d) Equispaced_Private(q, xi[d], N[d], D[d]);
  for (PetscInt c = 0; c < 3; ++c) {
    X[c] = 0;
    for (PetscInt d = 0; d < 3; ++d) J[c][d] = mesh->dim == 2 && c == 2 && d == 2;
  }
  for (PetscInt k = 0; k < nz; ++k) {
    for (PetscInt j = 0; j < n; ++j) {
      for (PetscInt i = 0; i < n; ++i, node += 3) {
        for (PetscInt c = 0; c < mesh->dim; ++c) {
          X[c] += N[0][i] * N[1][j] * N[2][k] * node[c];
          J[c][0] += D[0][i] * N[1][j] * N[2][k] * node[c];
          J[c][1] += N[0][i] * D[1][j] * N[2][k] * node[c];
          if (mesh->dim == 3) J[c][2] += N[0][i] * N[1][j] * D[2][k] * node[c];
        }
      }
    }
  }
}

/* Is X within the box of a coarse cell's nodes, widened by half of it (curved sides may reach beyond their nodes)? */
static PetscBool Near_Private(const CoarseMesh *mesh, PetscInt cell, const PetscReal X[3])
{
  const PetscInt   n    = ElementNumNodes(mesh->dim, mesh->geometry_order);
  const PetscReal *node = mesh->cell_geometry + 3 * cell * n;

  for (PetscInt c = 0; c < mesh->dim; ++c) {
    PetscReal lo = node[c], hi = node[c];
    for (PetscInt i = 1; i < n; ++i) {
      lo = PetscMin(lo, node[3 * i + c]);
      hi = PetscMax(hi, node[3 * i + c]);
    }
    if (X[c] < 1.5 * lo - 0.5 * hi || X[c] > 1.5 * hi - 0.5 * lo) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Place of X in a coarse cell by Newton's method; *outside: how far beyond [0,1] it lies (0: inside), or a large number when there is none. */
static void Invert_Private(const CoarseMesh *mesh, PetscInt cell, const PetscReal X[3], PetscReal xi[3], PetscReal *outside)
{
  PetscReal change = 1;

  *outside = PETSC_MAX_REAL;
  for (PetscInt d = 0; d < 3; ++d) xi[d] = d < mesh->dim ? 0.5 : 0;
  for (PetscInt it = 0; it < PROBE_NEWTON && change > 1e-13; ++it) {
    PetscReal Y[3], J[3][3], r[3], dxi[3];
    Geometry_Private(mesh, cell, xi, Y, J);
    for (PetscInt c = 0; c < 3; ++c) r[c] = c < mesh->dim ? X[c] - Y[c] : 0;
    if (!Solve3((const PetscReal *)J, r, dxi)) return;
    change = 0;
    for (PetscInt d = 0; d < mesh->dim; ++d) {
      xi[d]  = PetscMax(-1., PetscMin(2., xi[d] + dxi[d]));
      change = PetscMax(change, PetscAbsReal(dxi[d]));
    }
  }
  if (change > 1e-9) return;
  *outside = 0;
  for (PetscInt d = 0; d < mesh->dim; ++d) *outside = PetscMax(*outside, PetscMax(-xi[d], xi[d] - 1));
}

/* ---- places ------------------------------------------------------------------------------------------------------------- */

/* Number of the body that a probe is to be in, -1: any. */
static PetscErrorCode Body_Private(const ProbeSpec *spec, const CoarseMesh *mesh, PetscInt *body)
{
  PetscFunctionBegin;
  *body = -1;
  for (PetscInt b = 0; b < mesh->num_bodies && spec->body[0]; ++b)
    if (!strcmp(mesh->body_name[b], spec->body)) *body = b;
  PetscCheckInput(*body >= 0 || !spec->body[0], "probe.%s.body: the mesh has no body '%s'", spec->name, spec->body);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The cell nearest to a probe, the first of several. */
static PetscErrorCode Find_Private(Probes p, PetscInt probe, const ProbeSpec *spec, const CoarseMesh *mesh)
{
  PetscReal best = PETSC_MAX_REAL;
  PetscInt  body;

  PetscFunctionBegin;
  PetscCall(Body_Private(spec, mesh, &body));
  for (PetscInt cell = 0; cell < mesh->num_cells && best > 0; ++cell) {
    PetscReal xi[3], outside;
    if ((body >= 0 && mesh->cell_body[cell] != body) || !Near_Private(mesh, cell, spec->X)) continue;
    Invert_Private(mesh, cell, spec->X, xi, &outside);
    if (outside >= best) continue;
    best                 = outside;
    p->place[probe].root = cell;
    for (PetscInt d = 0; d < 3; ++d) p->place[probe].xi[d] = PetscMax(0., PetscMin(1., xi[d]));
  }
  PetscCheckInput(best < PROBE_OUTSIDE, "probe.%s: the point (%g, %g, %g) lies outside %s%s", spec->name, (double)spec->X[0], (double)spec->X[1],
                  (double)spec->X[2], spec->body[0] ? "body " : "all bodies", spec->body);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Another body that has the point too, -1: none. */
static PetscInt Also_Private(const ProbeSpec *spec, const CoarseMesh *mesh, PetscInt body)
{
  for (PetscInt cell = 0; cell < mesh->num_cells; ++cell) {
    PetscReal xi[3], outside;
    if (mesh->cell_body[cell] == body || !Near_Private(mesh, cell, spec->X)) continue;
    Invert_Private(mesh, cell, spec->X, xi, &outside);
    if (outside <= TOUCHING) return mesh->cell_body[cell];
  }
  return -1;
}

PetscErrorCode ProbesCreate(const SceneData *scene, Forest forest, Probes *probes)
{
  const CoarseMesh *mesh = ForestGetCoarse(forest);
  Probes            p;

  PetscFunctionBegin;
  PetscCall(PetscNew(&p));
  *probes = p;
  p->num  = scene->num_probes;
  PetscCall(PetscCalloc1(p->num, &p->place));
  for (PetscInt i = 0; i < p->num; ++i) {
    const ProbeSpec *spec = &scene->probes[i];
    PetscCall(Find_Private(p, i, spec, mesh));
    const PetscInt body = mesh->cell_body[p->place[i].root], also = spec->body[0] ? -1 : Also_Private(spec, mesh, body);
    if (also < 0) continue;
    PetscCall(PetscPrintf(ForestComm(forest), "note: bodies %s and %s meet at probe %s; it is a point of %s unless probe.%s.body says otherwise\n",
                          mesh->body_name[body], mesh->body_name[also], spec->name, mesh->body_name[body], spec->name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProbesDestroy(Probes *probes)
{
  PetscFunctionBegin;
  if (!*probes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*probes)->place));
  PetscCall(PetscFree(*probes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProbesGetPlace(Probes p, PetscInt probe, PetscInt *root, PetscReal xi[3])
{
  PetscFunctionBegin;
  *root = p->place[probe].root;
  PetscCall(PetscArraycpy(xi, p->place[probe].xi, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First leaf of a coarse cell that contains the place, and the place in the leaf. */
static PetscInt Leaf_Private(const ForestTables *t, PetscInt root, const PetscReal xi[3], PetscReal in_leaf[3])
{
  const PetscReal unit = (PetscReal)(1 << FOREST_MAX_LEVEL);

  for (PetscInt leaf = 0; leaf < t->num_leaves; ++leaf) {
    PetscBool inside = PETSC_TRUE;
    if (t->leaf_root[leaf] != root) continue;
    for (PetscInt d = 0; d < t->dim; ++d) {
      const PetscReal extent = unit / (PetscReal)(1 << t->leaf_level[3 * leaf + d]);
      in_leaf[d]             = (xi[d] * unit - (PetscReal)t->leaf_lo[3 * leaf + d]) / extent;
      if (in_leaf[d] < 0 || in_leaf[d] > 1) inside = PETSC_FALSE;
    }
    if (inside) return leaf;
  }
  return -1;
}

/* ---- values ------------------------------------------------------------------------------------------------------------- */

/* Values at one place of an owned cell. */
static PetscErrorCode Values_Private(Problem problem, PetscInt cell, const PetscReal xi[3], const PetscReal u[], ProbeValue *value)
{
  const SceneData    *scene     = ProblemGetScene(problem);
  const ForestTables *t         = ForestGetTables(ProblemForest(problem));
  HPSpace             space     = ProblemSpace(problem);
  const HPTables     *v         = HPSpaceGetTables(space);
  Mechanics           mechanics = ProblemMechanics(problem);
  PetscReal          *nodal, *N, F[9], P[9];

  PetscFunctionBegin;
  const PetscInt n = ElementNumNodes(v->dim, v->cell_order[cell]);
  PetscCall(PetscMalloc2(n * v->dim, &nodal, n, &N));
  PetscCall(HPSpaceGather(space, cell, u, nodal));
  PetscCall(ElementEvaluate(v->dim, v->cell_order[cell], xi, N, NULL));
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt c = 0; c < v->dim; ++c) value->displacement[c] += N[i] * nodal[i * v->dim + c];
  }
  PetscCall(PetscFree2(nodal, N));
  if (scene->mechanics.bodies[t->leaf_body[v->cell_leaf[cell]]].material->law->rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsPoints(mechanics, cell, 1, xi, u, &(PointValues){.F = F, .P = P}));
  OutputCauchy(scene->mechanics.kinematics, F, P, value->stress, NULL);
  PetscCall(MechanicsPlasticStrain(mechanics, cell, 1, xi, u, &value->plastic_strain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProbesEvaluate(Probes p, Problem problem, Vec x, ProbeValue value[])
{
  Forest     forest = ProblemForest(problem);
  PetscReal *u;

  PetscFunctionBegin;
  if (!p->num) PetscFunctionReturn(PETSC_SUCCESS);
  const ForestTables *t = ForestGetTables(forest);
  const HPTables     *v = HPSpaceGetTables(ProblemSpace(problem));
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(PetscArrayzero(value, p->num));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  for (PetscInt i = 0; i < p->num; ++i) {
    PetscReal      xi[3] = {0, 0, 0};
    const PetscInt leaf  = Leaf_Private(t, p->place[i].root, p->place[i].xi, xi);
    for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
      if (v->cell_leaf[c] == leaf) PetscCall(Values_Private(problem, c, xi, u, &value[i]));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, value, (PetscMPIInt)(p->num * sizeof(*value) / sizeof(PetscReal)), MPIU_REAL, MPI_SUM, ForestComm(forest)));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
