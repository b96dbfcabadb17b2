/* The outer facets of all bodies as they are drawn, in straight pieces (segments, triangles), and what contact pairs they are of. */
#include "diagnoseimpl.h"

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

PetscErrorCode PiecesAt_Private(Problem problem, const PetscReal u[], PetscBool rigid, Pieces *s)
{
  HPSpace    space  = ProblemSpace(problem);
  Forest     forest = ProblemForest(problem);
  PetscInt   pieces[MORTISE_MAX_ORDER + 1], num_parts, *part, most = 0;
  PetscBool *outer;
  PetscReal *X;

  PetscFunctionBegin;
  s->scene                 = ProblemGetScene(problem);
  const ForestTables *t    = ForestGetTables(forest);
  const CoarseMesh   *mesh = ForestGetCoarse(forest);
  const HPTables     *v    = HPSpaceGetTables(space);
  PetscCall(HPSpacePieces(space, 0, pieces));
  for (PetscInt p = 0; p <= MORTISE_MAX_ORDER; ++p) most = PetscMax(most, ElementNumNodes(v->dim, pieces[p]));
  PetscCall(PetscMalloc2(2 * most * v->dim, &X, mesh->num_cells, &part));
  PetscCall(ForestCoarseParts(mesh, &num_parts, part));
  s->dim       = v->dim;
  s->num_parts = num_parts;
  PetscCall(Outer_Private(t, &outer));
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
  PetscCall(PetscFree2(X, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PiecesCollect_Private(Problem problem, const State *state, PetscBool rigid, Pieces *s)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(problem));
  PetscReal      *u;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemLocalDisplacement(problem, state->x, u));
  PetscCall(PiecesAt_Private(problem, u, rigid, s));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- and contact pairs -------------------------------------------------------------------------------------------------------------- */

PetscErrorCode PairsBare_Private(Problem problem, MPI_Comm comm, PetscInt num, PetscInt bare[], PetscBool *any)
{
  const ContactView *v;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) {
    bare[i] = 1;
    v       = InterfaceGetContact(ProblemInterface(problem), i);
    for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
      if (v->nonmortar.owned[n] && v->active[n]) bare[i] = 0;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bare, (PetscMPIInt)num, MPIU_INT, MPI_MIN, comm));
  *any = PETSC_FALSE;
  for (PetscInt i = 0, first = 0; i < num; ++i) { /* the pair as a whole, under its first part */
    v = InterfaceGetContact(ProblemInterface(problem), i);
    if (v->spec->part) {
      bare[first] = PetscMin(bare[first], bare[i]);
      bare[i]     = 0;
    } else
      first = i;
  }
  for (PetscInt i = 0; i < num; ++i) *any = (PetscBool)(*any || bare[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PiecesParts_Private(const Pieces *s, MPI_Comm comm, int8_t **is)
{
  const PetscInt num = 2 * s->scene->num_contacts;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num * s->num_parts, is));
  for (PetscInt i = 0; i < s->num; ++i) {
    for (PetscInt k = 0; k < num; ++k) {
      if (s->piece[i].groups & PairGroup_Private(&s->scene->contacts[k / 2], k % 2)) (*is)[num * s->piece[i].part + k] = 1;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, *is, (PetscMPIInt)(num * s->num_parts), MPI_SIGNED_CHAR, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
