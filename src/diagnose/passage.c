/* Does the surface of a part pass through itself? Outer facets as they are drawn, in straight pieces (segments, triangles), at a state: two pieces of one part
   that are no neighbours and of which one cuts the other. Sides of a contact pair are left out: contact keeps those apart.
   Pieces that may meet are found by sort and sweep; each rank tests its own, and those of others in the box of its own. */
#include "diagnoseimpl.h"

#define DEEP 1e-2  /* of the smaller piece: what ends nearer to a piece does not pass through it; curved faces are drawn no better */
#define CLOSE 1e-9 /* of a piece: corners no farther apart at the reference positions are one */

/* ---- pieces ---------------------------------------------------------------------------------------------------------------------------- */

static void Measure_Private(PetscInt dim, Piece *p)
{
  PetscReal d[2][3] = {{0, 0, 0}, {0, 0, 1}}, length;

  for (PetscInt c = 0; c < 3; ++c) d[0][c] = p->x[3 + c] - p->x[c];
  for (PetscInt c = 0; dim == 3 && c < 3; ++c) d[1][c] = p->x[6 + c] - p->x[c];
  Cross3(d[0], d[1], p->N);
  length = PetscSqrtReal(Dot3(p->N, p->N));
  for (PetscInt c = 0; c < 3; ++c) p->N[c] /= length > 0 ? length : 1;
  p->size = 0;
  for (PetscInt a = 0; a < dim; ++a) {
    PetscReal edge = 0;
    for (PetscInt c = 0; c < 3; ++c) edge += PetscSqr(p->x[3 * a + c] - p->x[3 * ((a + 1) % dim) + c]);
    p->size = PetscMax(p->size, PetscSqrtReal(edge));
  }
  for (PetscInt c = 0; c < 3; ++c) {
    p->box[c] = p->box[3 + c] = p->x[c];
    for (PetscInt a = 1; a < dim; ++a) {
      p->box[c]     = PetscMin(p->box[c], p->x[3 * a + c]);
      p->box[3 + c] = PetscMax(p->box[3 + c], p->x[3 * a + c]);
    }
  }
}

/* A piece with these points of a cell's lattice for corners. */
static PetscErrorCode Add_Private(Pieces *s, const Piece *like, const PetscReal X[], const PetscReal u[], const PetscInt corner[])
{
  Piece *p;

  PetscFunctionBegin;
  if (s->num == s->room) {
    s->room = PetscMax(64, 2 * s->room);
    PetscCall(PetscRealloc((size_t)s->room * sizeof(Piece), &s->piece));
  }
  p  = &s->piece[s->num++];
  *p = *like;
  for (PetscInt a = 0; a < s->dim; ++a) {
    for (PetscInt c = 0; c < s->dim; ++c) {
      p->X[3 * a + c] = X[s->dim * corner[a] + c];
      p->x[3 * a + c] = p->X[3 * a + c] + u[s->dim * corner[a] + c];
    }
  }
  Measure_Private(s->dim, p);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The facet at the low or high end of an axis of a cell whose lattice has n pieces each way. */
static PetscErrorCode AddFacet_Private(Pieces *s, const Piece *like, PetscInt axis, PetscInt high, PetscInt n, const PetscReal X[], const PetscReal u[])
{
  const PetscInt stride[3] = {1, n + 1, (n + 1) * (n + 1)}, a = (axis + 1) % s->dim, b = (axis + 2) % 3, start = high ? n * stride[axis] : 0;
  const PetscInt flip = s->dim == 3 ? !high : axis ? high : !high; /* the other way round, for the outward normal */

  PetscFunctionBegin;
  for (PetscInt j = 0; j < (s->dim == 3 ? n : 1); ++j) {
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt at = start + i * stride[a] + (s->dim == 3 ? j * stride[b] : 0), up = s->dim == 3 ? stride[b] : 0, on = stride[a];
      if (s->dim == 2) {
        PetscCall(Add_Private(s, like, X, u, flip ? (const PetscInt[]){at + on, at} : (const PetscInt[]){at, at + on}));
        continue;
      }
      PetscCall(Add_Private(s, like, X, u, flip ? (const PetscInt[]){at, at + on + up, at + on} : (const PetscInt[]){at, at + on, at + on + up}));
      PetscCall(Add_Private(s, like, X, u, flip ? (const PetscInt[]){at, at + up, at + on + up} : (const PetscInt[]){at, at + on + up, at + up}));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets with cells on one side only. */
static PetscErrorCode Outer_Private(const ForestTables *t, PetscBool **outer)
{
  const PetscInt first = t->first[t->dim - 1], last = t->first[t->dim];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(last - first, outer));
  for (PetscInt f = first; f < last; ++f) (*outer)[f - first] = (PetscBool)((t->facet_leaf[2 * (f - first)] < 0) != (t->facet_leaf[2 * (f - first) + 1] < 0));
  for (PetscInt f = first; f < last; ++f) {
    if (t->parent[f] < first) continue;
    (*outer)[f - first] = (*outer)[t->parent[f] - first] = PETSC_FALSE; /* coarser and finer cells face each other */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PiecesCollect_Private(Problem problem, const State *state, PetscBool rigid, Pieces *s)
{
  const ForestTables *t;
  const CoarseMesh   *mesh;
  const HPTables     *v;
  HPSpace             space;
  Forest              forest;
  PetscInt            pieces[MORTISE_MAX_ORDER + 1], num_parts, *part, most = 0;
  PetscBool          *outer;
  PetscReal          *u, *X;

  PetscFunctionBegin;
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ProblemGetScene(problem, &s->scene));
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(ForestGetCoarse(forest, &mesh));
  PetscCall(ProblemGetSpace(problem, &space));
  PetscCall(HPSpaceGetTables(space, &v));
  PetscCall(HPSpacePieces(space, 0, pieces));
  for (PetscInt p = 0; p <= MORTISE_MAX_ORDER; ++p) most = PetscMax(most, ElementNumNodes(v->dim, pieces[p]));
  PetscCall(PetscMalloc3(v->num_nodes * v->dim, &u, 2 * most * v->dim, &X, mesh->num_cells, &part));
  PetscCall(ForestCoarseParts(mesh, &num_parts, part));
  s->dim       = v->dim;
  s->num_parts = num_parts;
  PetscCall(Outer_Private(t, &outer));
  PetscCall(ProblemLocalDisplacement(problem, state->x, u));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt leaf = v->cell_leaf[c], n = pieces[v->cell_order[c]], *closure = t->closure + t->closure_offset[t->first[v->dim] + leaf];
    const PetscInt step[3] = {1, 3, 9}, centre = v->dim == 2 ? 4 : 13;
    PetscReal     *drawn = X + ElementNumNodes(v->dim, n) * v->dim;
    PetscBool      ready = PETSC_FALSE;
    Piece          like  = {.part = part[t->leaf_root[leaf]], .body = t->leaf_body[leaf]};
    if (!rigid && s->scene->mechanics.bodies[like.body].material->law->rigid) continue;
    for (PetscInt side = 0; side < 2 * v->dim; ++side) {
      const PetscInt facet = closure[centre + (side % 2 ? 1 : -1) * step[side / 2]];
      if (!outer[facet - t->first[v->dim - 1]]) continue;
      if (!ready) PetscCall(HPSpaceLattice(space, c, pieces, u, X, drawn));
      ready       = PETSC_TRUE;
      like.groups = t->boundary[facet];
      PetscCall(AddFacet_Private(s, &like, side / 2, side % 2, n, X, drawn));
    }
  }
  PetscCall(PetscFree(outer));
  PetscCall(PetscFree3(u, X, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- two pieces ------------------------------------------------------------------------------------------------------------------------- */

static PetscBool BoxesMeet_Private(const PetscReal a[6], const PetscReal b[6])
{
  return (PetscBool)(a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] && b[2] <= a[5]);
}

static PetscBool Neighbours_Private(PetscInt dim, const Piece *p, const Piece *q)
{
  const PetscReal near = CLOSE * (p->size + q->size);

  for (PetscInt a = 0; a < dim; ++a) {
    for (PetscInt b = 0; b < dim; ++b) {
      PetscReal far = 0;
      for (PetscInt c = 0; c < 3; ++c) far = PetscMax(far, PetscAbsReal(p->X[3 * a + c] - q->X[3 * b + c]));
      if (far <= near) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

static PetscBool InPair_Private(const SceneData *scene, uint64_t a, uint64_t b)
{
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    const PetscInt n = scene->contacts[i].nonmortar, m = scene->contacts[i].mortar;
    if (((a >> n & 1) && (b >> m & 1)) || ((a >> m & 1) && (b >> n & 1))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscReal Height_Private(const Piece *p, const PetscReal x[3])
{
  return p->N[0] * (x[0] - p->x[0]) + p->N[1] * (x[1] - p->x[1]) + p->N[2] * (x[2] - p->x[2]);
}

/* Does the segment a-b, with these heights above the piece, cut it? Neither where it ends nor at the border of the piece: there hanging corners meet what they
   hang on. */
static PetscBool Cuts_Private(PetscInt dim, const Piece *p, const PetscReal a[3], const PetscReal b[3], PetscReal ha, PetscReal hb, PetscReal off)
{
  PetscReal y[3], edge[3], to[3], turn[3];

  if (!(ha * hb < 0) || PetscMin(PetscAbsReal(ha), PetscAbsReal(hb)) <= off) return PETSC_FALSE;
  for (PetscInt c = 0; c < 3; ++c) y[c] = a[c] + ha / (ha - hb) * (b[c] - a[c]);
  for (PetscInt k = 0; k < (dim == 2 ? 2 : 3); ++k) {
    const PetscReal *from = p->x + 3 * k, *on = p->x + 3 * ((k + 1) % dim);
    for (PetscInt c = 0; c < 3; ++c) edge[c] = on[c] - from[c], to[c] = y[c] - from[c];
    Cross3(edge, to, turn);
    if ((dim == 2 ? Dot3(edge, to) : Dot3(turn, p->N)) <= off * PetscSqrtReal(Dot3(edge, edge))) return PETSC_FALSE; /* this far from its border */
  }
  return PETSC_TRUE;
}

/* How deep corners of q lie behind p where an edge of q cuts p; 0: none does. */
static PetscReal Depth_Private(PetscInt dim, const Piece *p, const Piece *q)
{
  const PetscReal off = DEEP * PetscMin(p->size, q->size);
  PetscReal       height[3], depth = 0;

  for (PetscInt a = 0; a < dim; ++a) height[a] = Height_Private(p, q->x + 3 * a);
  for (PetscInt a = 0; a < (dim == 2 ? 1 : 3); ++a) {
    const PetscInt b = (a + 1) % dim;
    if (Cuts_Private(dim, p, q->x + 3 * a, q->x + 3 * b, height[a], height[b], off)) depth = PetscMax(depth, -PetscMin(height[a], height[b]));
  }
  return depth;
}

static void Test_Private(const Pieces *s, const Piece *p, const Piece *q, Passage *worst)
{
  PetscReal depth;

  if (p->part != q->part || Neighbours_Private(s->dim, p, q) || InPair_Private(s->scene, p->groups, q->groups)) return;
  depth = PetscMax(Depth_Private(s->dim, p, q), Depth_Private(s->dim, q, p));
  if (depth <= worst->depth) return;
  worst->depth   = depth;
  worst->body[0] = PetscMin(p->body, q->body);
  worst->body[1] = PetscMax(p->body, q->body);
  for (PetscInt c = 0; c < 3; ++c) {
    worst->x[c] = 0;
    for (PetscInt a = 0; a < s->dim; ++a) worst->x[c] += (p->x[3 * a + c] + q->x[3 * a + c]) / (2 * s->dim);
  }
}

/* ---- all of them ------------------------------------------------------------------------------------------------------------------------ */

static int Compare_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Piece *)a)->box[0], y = ((const Piece *)b)->box[0];
  return x < y ? -1 : x > y;
}

static void Sweep_Private(Pieces *s, Passage *worst)
{
  qsort(s->piece, (size_t)s->num, sizeof(Piece), Compare_Private);
  for (PetscInt i = 0; i < s->num; ++i) {
    for (PetscInt j = i + 1; j < s->num && s->piece[j].box[0] <= s->piece[i].box[3]; ++j) {
      if (BoxesMeet_Private(s->piece[i].box, s->piece[j].box)) Test_Private(s, &s->piece[i], &s->piece[j], worst);
    }
  }
}

/* Append the pieces of other ranks that meet the box of those here. */
static PetscErrorCode Exchange_Private(MPI_Comm comm, Pieces *s)
{
  PetscReal   mine[6] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}, (*box)[6];
  PetscMPIInt size, rank, num_to = 0, *to;
  PetscInt   *first, num_received;
  Pieces      send = {0};
  Piece      *received;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < s->num; ++i) {
    for (PetscInt c = 0; c < 3; ++c) {
      mine[c]     = PetscMin(mine[c], s->piece[i].box[c]);
      mine[3 + c] = PetscMax(mine[3 + c], s->piece[i].box[3 + c]);
    }
  }
  PetscCall(PetscMalloc3(size, &box, size, &to, size + 1, &first));
  PetscCallMPI(MPI_Allgather(mine, 6, MPIU_REAL, box, 6, MPIU_REAL, comm));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) {
    for (PetscInt i = 0; r != rank && i < s->num; ++i) {
      if (!BoxesMeet_Private(s->piece[i].box, box[r])) continue;
      if (send.num == send.room) {
        send.room = PetscMax(64, 2 * send.room);
        PetscCall(PetscRealloc((size_t)send.room * sizeof(Piece), &send.piece));
      }
      send.piece[send.num++] = s->piece[i];
    }
    if (send.num == first[num_to]) continue;
    to[num_to]      = r;
    first[++num_to] = send.num;
  }
  PetscCall(SparseExchange(comm, num_to, to, first, sizeof(Piece), send.piece, &num_received, &received));
  PetscCall(PetscRealloc((size_t)(s->num + num_received) * sizeof(Piece), &s->piece));
  PetscCall(PetscArraycpy(s->piece + s->num, received, num_received));
  s->num += num_received;
  PetscCall(PetscFree(received));
  PetscCall(PetscFree(send.piece));
  PetscCall(PetscFree3(box, to, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PassageFind(Problem problem, const State *state, Passage *worst)
{
  Forest      forest;
  Pieces      s = {0};
  PetscReal   depth;
  PetscMPIInt owner;

  PetscFunctionBegin;
  *worst = (Passage){.depth = 0};
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(PiecesCollect_Private(problem, state, PETSC_FALSE, &s));
  PetscCall(Exchange_Private(ForestComm(forest), &s));
  Sweep_Private(&s, worst);
  PetscCall(PetscFree(s.piece));
  PetscCallMPI(MPI_Allreduce(&worst->depth, &depth, 1, MPIU_REAL, MPI_MAX, ForestComm(forest)));
  if (!(depth > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RankFirst(ForestComm(forest), (PetscBool)(worst->depth == depth), &owner));
  PetscCallMPI(MPI_Bcast(worst, (PetscMPIInt)sizeof(*worst), MPI_BYTE, owner, ForestComm(forest)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
