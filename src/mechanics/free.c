/* Bodies that no support holds (before contact closes, or in the directions contact leaves free).

   Their tangent gets a small diagonal, MECHANICS_SHIFT of the cells' own stiffness against shear weighted by the cell's share of the body's volume, so that
   the first linear solve has one solution; the residual is left alone, hence no force of it survives in the result. What holds a body that slides on another is
   hardly more, and of either sign: with -0.3 of the diagonal Newton's method would grow by 1.4 in each iteration. So only a part of it counts once the residual
   has fallen (MechanicsSetProximalShift), as in the method of Levenberg and Marquardt. (A share of the stiffness against compression, 1e4 times as much in
   nearly incompressible cells, would be no small one beside soft neighbours.) */
#include "mechanicsimpl.h"
#include <petscblaslapack.h>

#define MOST_MODES 6

/* What of a cell's stiffness answers shear. */
static PetscReal Shear_Private(const MaterialSpec *material)
{
  return PetscIsInfReal(material->kappa) ? 1 : PetscMin(1, 3 * material->mu / material->kappa);
}

/* Rigid motions at X along a direction: translations and rotations (plane: 2 + 1; axisymmetric: along the axis; space: 3 + 3), rotations about the
   body's centre over its size. Returns their number. */
static PetscInt Modes_Private(Model model, const PetscReal X[3], const PetscReal centre[3], PetscReal size, const PetscReal n[3], PetscReal a[MOST_MODES])
{
  const PetscReal r[3] = {(X[0] - centre[0]) / size, (X[1] - centre[1]) / size, (X[2] - centre[2]) / size};
  if (model == MODEL_AXISYMMETRIC) {
    a[0] = n[1];
    return 1;
  }
  const PetscReal about[3] = {r[1] * n[2] - r[2] * n[1], r[2] * n[0] - r[0] * n[2], r[0] * n[1] - r[1] * n[0]};
  const PetscInt  dim      = model == MODEL_3D ? 3 : 2;
  for (PetscInt c = 0; c < dim; ++c) a[c] = n[c];
  for (PetscInt c = 0; c < 2 * dim - 3; ++c) a[dim + c] = about[dim == 3 ? c : 2];
  return 3 * dim - 3;
}

static void Join_Private(PetscInt root[], PetscInt a, PetscInt b)
{
  while (root[a] != a) a = root[a];
  while (root[b] != b) b = root[b];
  root[PetscMax(a, b)] = PetscMin(a, b);
}

/* Bodies that share vertices of the mesh, or are tied, move together: root of each body's group. */
static PetscErrorCode Joined_Private(const CoarseMesh *mesh, const PetscInt joined[], PetscInt root[])
{
  PetscInt *body;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->num_vertices, &body));
  for (PetscInt v = 0; v < mesh->num_vertices; ++v) body[v] = -1;
  for (PetscInt b = 0; b < mesh->num_bodies; ++b) root[b] = b;
  for (PetscInt i = 0; i < mesh->num_cells << mesh->dim; ++i) {
    const PetscInt b     = mesh->cell_body[i >> mesh->dim];
    PetscInt      *first = &body[mesh->cell_vertices[i]];
    if (*first < 0) *first = b;
    Join_Private(root, b, *first);
  }
  for (PetscInt a = 0; joined && a < mesh->num_bodies; ++a)
    for (PetscInt b = 0; b < a; ++b)
      if (joined[a] == joined[b]) Join_Private(root, a, b);
  for (PetscInt b = 0; b < mesh->num_bodies; ++b) {
    while (root[b] != root[root[b]]) root[b] = root[root[b]];
  }
  PetscCall(PetscFree(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a positive semidefinite matrix have full rank? */
static PetscErrorCode FullRank_Private(PetscInt n, PetscReal *A, PetscBool *full)
{
  PetscReal    w[MOST_MODES], work[64];
  PetscBLASInt size = (PetscBLASInt)n, lwork = 64, info;

  PetscFunctionBegin;
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("N", "U", &size, A, &size, w, work, &lwork, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "eigenvalues of a %" PetscInt_FMT "-square matrix: LAPACK says %d", n, (int)info);
  *full = (PetscBool)(w[n - 1] > 0 && w[0] > 1e-10 * w[n - 1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume of a cell by its quadrature (without the revolution). */
static PetscErrorCode CellVolume_Private(PetscInt dim, PetscInt order, PetscInt n, const PetscReal *X, PetscReal *volume)
{
  const Basis1D *basis;
  PetscReal      value[729], gradient[3 * 729];

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(order, &basis));
  *volume = 0;
  for (PetscInt q = 0; q < ElementNumNodes(dim, basis->num_points - 1); ++q) {
    PetscReal       xi[3], J[9] = {0, 0, 0, 0, 0, 0, 0, 0, (PetscReal)(dim == 2)};
    const PetscReal weight = Basis1DPoint(basis, dim, q, xi);
    PetscCall(ElementEvaluate(dim, order, xi, value, gradient));
    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt c = 0; c < dim; ++c)
        for (PetscInt d = 0; d < dim; ++d) J[3 * c + d] += gradient[i * dim + d] * X[i * dim + c];
    *volume += weight * Det3(J);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body of whose motion some is found: what is prescribed of it holds its point, not its nodes. */
static void Prescribed_Private(Mechanics m, const BodySpec *body, const PetscReal centre[3], PetscReal size, PetscReal gram[])
{
  const PetscInt dim = m->dim, first = m->spec->model == MODEL_AXISYMMETRIC ? 1 : 0, turns = m->spec->model == MODEL_AXISYMMETRIC ? 0 : 2 * dim - 3;

  for (PetscInt k = first; k < dim + turns; ++k) {
    const PetscInt  axis = k < dim ? k : dim == 3 ? k - dim : 2;
    const PetscReal n[3] = {axis == 0, axis == 1, axis == 2};
    PetscReal       a[MOST_MODES];
    if (k < dim ? body->load[axis] != NULL : body->load_moment[axis] != NULL) continue;
    const PetscInt num = Modes_Private(m->spec->model, body->about, centre, size, n, a);
    for (PetscInt i = 0; i < num && k >= dim; ++i) a[i] = i == k;
    for (PetscInt i = 0; i < num; ++i)
      for (PetscInt j = 0; j < num; ++j) gram[i * num + j] += a[i] * a[j];
  }
}

/* Gram matrices of the rigid motions that supports see, [bodies][36]; extents first. first: this is the first rank. */
static PetscErrorCode Gram_Private(Mechanics m, const PetscInt root[], const PetscReal centre[3], PetscReal size, PetscBool first, PetscReal *gram)
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  PetscInt           *body;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes, &body));
  for (PetscInt n = 0; n < v->num_nodes; ++n) body[n] = -1;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    for (PetscInt k = v->cell_row[c]; k < v->cell_row[c + 1]; ++k) body[v->cell_master[k]] = root[t->leaf_body[v->cell_leaf[c]]];
  }
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *frame;
    if (body[n] < 0 || !m->supports->fixed[n]) continue;
    const PetscInt rigid = m->supports->rigid[n];
    if (rigid >= 0 && BodyIsLoaded(&m->spec->bodies[rigid])) continue;
    PetscCall(HPSpaceGetFrame(m->space, n, &frame));
    for (PetscInt k = 0; k < m->dim; ++k) {
      PetscReal a[MOST_MODES], direction[3] = {0, 0, 0};
      if (!((m->supports->fixed[n] >> k) & 1)) continue;
      for (PetscInt c = 0; c < m->dim; ++c) direction[c] = frame ? frame[3 * k + c] : (PetscReal)(c == k);
      const PetscInt num = Modes_Private(m->spec->model, v->X + 3 * n, centre, size, direction, a);
      for (PetscInt i = 0; i < num; ++i)
        for (PetscInt j = 0; j < num; ++j) gram[36 * body[n] + i * num + j] += a[i] * a[j];
    }
  }
  PetscCall(PetscFree(body));
  for (PetscInt b = 0; b < m->spec->num_bodies && first; ++b)
    if (BodyIsLoaded(&m->spec->bodies[b])) Prescribed_Private(m, &m->spec->bodies[b], centre, size, gram + 36 * root[b]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetProximalShift(Mechanics m, PetscReal part)
{
  PetscFunctionBegin;
  m->free_part = part;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The translations' part of the Gram matrices. */
static PetscErrorCode Hold_Private(Mechanics m, PetscInt modes, const PetscInt root[], const PetscReal gram[])
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(9 * m->spec->num_bodies, &m->hold));
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) {
    const PetscReal *G    = gram + 36 * root[b];
    PetscReal       *hold = m->hold + 9 * b;
    if (m->spec->model == MODEL_AXISYMMETRIC) hold[0] = 1, hold[4] = G[0];
    for (PetscInt i = 0; i < m->dim && modes > 1; ++i)
      for (PetscInt j = 0; j < m->dim; ++j) hold[3 * i + j] = G[i * modes + j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsGetHold(Mechanics m, const PetscReal **hold, const PetscInt **group)
{
  PetscFunctionBegin;
  *hold = m->hold;
  if (group) *group = m->body_group;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool MechanicsIsHeld(Mechanics m, PetscInt body)
{
  return m->held[body];
}

PetscErrorCode MechanicsFreeBodies_Private(Mechanics m)
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  const CoarseMesh   *mesh   = ForestGetCoarse(forest);
  MPI_Comm            comm;
  PetscMPIInt         rank;
  PetscReal          *gram, *volume, lo[3], hi[3], centre[3], size = 0;
  PetscInt           *root, nb = m->spec->num_bodies, modes;

  PetscFunctionBegin;
  comm = ForestComm(forest);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  ForestCoarseBox(mesh, lo, hi);
  for (PetscInt c = 0; c < 3; ++c) {
    centre[c] = 0.5 * (lo[c] + hi[c]);
    size      = PetscMax(size, hi[c] - lo[c]);
  }
  PetscCall(PetscMalloc1(nb, &m->body_group));
  root = m->body_group;
  PetscCall(PetscCalloc2(36 * nb, &gram, nb, &volume));
  PetscCall(PetscMalloc1(nb, &m->held));
  PetscCall(PetscCalloc1(v->num_owned_cells, &m->free_share));
  PetscCall(Joined_Private(mesh, m->spec->joined, root));
  PetscCall(Gram_Private(m, root, centre, size, (PetscBool)(rank == 0), gram));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    if (m->cell_group[c] < 0) continue;
    const CellGroup *g = &m->groups[m->cell_group[c]];
    PetscCall(CellVolume_Private(m->dim, g->order, g->n, g->X + m->cell_index[c] * g->n * m->dim, &m->free_share[c]));
    volume[root[t->leaf_body[v->cell_leaf[c]]]] += m->free_share[c];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, (PetscMPIInt)(36 * nb), MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, (PetscMPIInt)nb, MPIU_REAL, MPI_SUM, comm));
  modes = m->spec->model == MODEL_AXISYMMETRIC ? 1 : 3 * m->dim - 3;
  PetscCall(Hold_Private(m, modes, root, gram));
  for (PetscInt b = 0; b < nb; ++b) {
    if (root[b] == b) PetscCall(FullRank_Private(modes, gram + 36 * b, &m->held[b])); /* roots come first */
    m->held[b] = m->held[root[b]];
    volume[b]  = m->held[b] ? 0 : volume[b];
  }
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt  body  = t->leaf_body[v->cell_leaf[c]];
    const PetscReal whole = volume[root[body]];
    m->free_share[c]      = whole > 0 ? MECHANICS_SHIFT * Shear_Private(m->spec->bodies[body].material) * m->free_share[c] / whole : 0;
  }
  PetscCall(PetscFree2(gram, volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}
