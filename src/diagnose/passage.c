/* Does the surface of a part pass through itself? Outer facets as they are drawn, in straight pieces (segments, triangles), at a state: two pieces of one part
   that are no neighbours and of which one cuts the other. Sides of a contact pair are left out: contact keeps those apart. Or do parts pass through each other
   that no pair is between?
   Pieces that may meet are found by sort and sweep; each rank tests its own, and those of others in the box of its own. */
#include "diagnoseimpl.h"

#define DEEP 1e-2  /* of the smaller piece: what ends nearer to a piece does not pass through it; curved faces are drawn no better */
#define CLOSE 1e-9 /* of a piece: corners no farther apart at the reference positions are one */

/* ---- two pieces ------------------------------------------------------------------------------------------------------------------------- */

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

/* The first contact that a facet of these groups is in, -1: none. */
static PetscInt PairOf_Private(const SceneData *scene, uint64_t groups)
{
  for (PetscInt i = 0; i < scene->num_contacts; ++i)
    if (groups & (PairGroup_Private(&scene->contacts[i], 0) | PairGroup_Private(&scene->contacts[i], 1))) return i;
  return -1;
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

/* How deep corners of q lie behind p where an edge of q cuts p; 0: none does. Of two parts that of q is taken for smaller than it is, by twice what is cut at
   the border of p: sides that lie flush do not cut then, and those that run through a corner of p do beside it. */
static PetscReal Depth_Private(PetscInt dim, const Piece *p, const Piece *q)
{
  const PetscReal off = DEEP * PetscMin(p->size, q->size), less = p->part == q->part ? 0 : 2 * off;
  PetscReal       x[9], height[3], depth = 0;

  for (PetscInt a = 0; a < dim; ++a) {
    for (PetscInt c = 0; c < 3; ++c) x[3 * a + c] = q->x[3 * a + c] - less * q->N[c];
    height[a] = Height_Private(p, x + 3 * a);
  }
  for (PetscInt a = 0; a < (dim == 2 ? 1 : 3); ++a) {
    const PetscInt b = (a + 1) % dim;
    if (Cuts_Private(dim, p, x + 3 * a, x + 3 * b, height[a], height[b], off)) depth = PetscMax(depth, -PetscMin(height[a], height[b]));
  }
  return depth;
}

/* Which pieces are not to meet: of one part, all or those of a group; or of two, by the pairs' sides that each part has. */
typedef struct {
  PetscInt  group; /* -1: all */
  PetscBool apart; /* of two parts */
  int8_t   *sides; /* with it: of PiecesParts_Private */
} Which;

/* Is a pair, or one surface, between two parts; or are both rigid? */
static PetscBool MayMeet_Private(const SceneData *scene, const int8_t *sides, const Piece *p, const Piece *q)
{
  const PetscInt num = 2 * scene->num_contacts;
  const int8_t  *a = sides + num * p->part, *b = sides + num * q->part;

  for (PetscInt k = 0; k < num; ++k)
    if (a[k] && b[k ^ 1]) return PETSC_TRUE;
  return (PetscBool)(scene->mechanics.bodies[p->body].material->law->rigid && scene->mechanics.bodies[q->body].material->law->rigid);
}

static PetscBool Counts_Private(const Pieces *s, const Which *which, const Piece *p, const Piece *q)
{
  if (which->apart) return (PetscBool)(p->part != q->part && !MayMeet_Private(s->scene, which->sides, p, q));
  if (p->part != q->part || Neighbours_Private(s->dim, p, q)) return PETSC_FALSE;
  return (PetscBool)(which->group >= 0 ? (p->groups & q->groups) >> which->group & 1 : !InPair_Private(s->scene, p->groups, q->groups));
}

static void Test_Private(const Pieces *s, const Which *which, const Piece *p, const Piece *q, Passage *worst)
{
  PetscReal depth, middle[2][3];

  if (!Counts_Private(s, which, p, q)) return;
  depth = PetscMax(Depth_Private(s->dim, p, q), Depth_Private(s->dim, q, p));
  for (PetscInt c = 0; c < 3 && depth > 0; ++c) {
    worst->box[c]     = PetscMin(worst->box[c], PetscMin(p->box[c], q->box[c]));
    worst->box[3 + c] = PetscMax(worst->box[3 + c], PetscMax(p->box[3 + c], q->box[3 + c]));
  }
  if (depth <= worst->depth) return;
  worst->depth   = depth;
  worst->body[0] = PetscMin(p->body, q->body);
  worst->body[1] = PetscMax(p->body, q->body);
  worst->pair    = PairOf_Private(s->scene, p->groups | q->groups);
  PieceMiddle_Private(s->dim, p->x, middle[0]);
  PieceMiddle_Private(s->dim, q->x, middle[1]);
  for (PetscInt c = 0; c < 3; ++c) worst->x[c] = (middle[0][c] + middle[1][c]) / 2;
}

/* ---- all of them ------------------------------------------------------------------------------------------------------------------------ */

static int Compare_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Piece *)a)->box[0], y = ((const Piece *)b)->box[0];
  return x < y ? -1 : x > y;
}

static void Sweep_Private(Pieces *s, const Which *which, Passage *worst)
{
  qsort(s->piece, (size_t)s->num, sizeof(Piece), Compare_Private);
  for (PetscInt i = 0; i < s->num; ++i) {
    for (PetscInt j = i + 1; j < s->num && s->piece[j].box[0] <= s->piece[i].box[3]; ++j) {
      if (ContactBoxesMeet(s->piece[i].box, s->piece[j].box)) Test_Private(s, which, &s->piece[i], &s->piece[j], worst);
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
      if (!ContactBoxesMeet(s->piece[i].box, box[r])) continue;
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

/* The worst of those collected, of all ranks. */
static PetscErrorCode Find_Private(MPI_Comm comm, Pieces *s, const Which *which, Passage *worst)
{
  const PetscReal most = PETSC_MAX_REAL;
  PetscReal       depth, box[6];
  PetscMPIInt     owner;

  PetscFunctionBegin;
  *worst = (Passage){.box = {most, most, most, -most, -most, -most}};
  PetscCall(Exchange_Private(comm, s));
  Sweep_Private(s, which, worst);
  PetscCall(PetscFree(s->piece));
  PetscCallMPI(MPI_Allreduce(&worst->depth, &depth, 1, MPIU_REAL, MPI_MAX, comm));
  if (!(depth > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RankFirst(comm, (PetscBool)(worst->depth == depth), &owner));
  for (PetscInt c = 0; c < 6; ++c) box[c] = c < 3 ? -worst->box[c] : worst->box[c];
  PetscCallMPI(MPI_Bcast(worst, (PetscMPIInt)sizeof(*worst), MPI_BYTE, owner, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, 6, MPIU_REAL, MPI_MAX, comm));
  for (PetscInt c = 0; c < 6; ++c) worst->box[c] = c < 3 ? -box[c] : box[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- parts wholly inside others --------------------------------------------------------------------------------------------------------- */

/* The boxes of all parts. */
static PetscErrorCode PartBoxes_Private(MPI_Comm comm, const Pieces *s, PetscReal box[][6])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_parts; ++i)
    for (PetscInt c = 0; c < 6; ++c) box[i][c] = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < s->num; ++i) {
    PetscReal *of = box[s->piece[i].part];
    for (PetscInt c = 0; c < 3; ++c) {
      of[c]     = PetscMin(of[c], s->piece[i].box[c]);
      of[3 + c] = PetscMin(of[3 + c], -s->piece[i].box[3 + c]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, (PetscMPIInt)(6 * s->num_parts), MPIU_REAL, MPI_MIN, comm));
  for (PetscInt i = 0; i < s->num_parts; ++i)
    for (PetscInt c = 3; c < 6; ++c) box[i][c] = -box[i][c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the first box inside the second? */
static PetscBool BoxWithin_Private(PetscInt dim, const PetscReal a[6], const PetscReal b[6])
{
  for (PetscInt c = 0; c < dim; ++c)
    if (!(a[c] > b[c] && a[3 + c] < b[3 + c])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The first and the last piece of each part on each rank: all of one that is wholly inside another are in it. */
static PetscErrorCode Samples_Private(MPI_Comm comm, const Pieces *s, PetscInt *num, Piece **all)
{
  PetscInt *at, mine = 0;
  Piece    *piece;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * s->num_parts, &at, 2 * s->num_parts, &piece));
  for (PetscInt i = 0; i < 2 * s->num_parts; ++i) at[i] = -1;
  for (PetscInt i = 0; i < s->num; ++i) {
    PetscInt *of = at + 2 * s->piece[i].part;
    if (of[0] < 0) of[0] = i;
    of[1] = i;
  }
  for (PetscInt i = 0; i < 2 * s->num_parts; ++i)
    if (at[i] >= 0) piece[mine++] = s->piece[at[i]];
  PetscCall(GatherAll(comm, mine, sizeof(Piece), piece, num, all));
  PetscCall(PetscFree2(at, piece));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the part of one sample lie in that of the other? Places are on each sample of it and half its length behind, where surfaces that touch say nothing. */
static PetscErrorCode Enclosed_Private(MPI_Comm comm, const Pieces *s, const Piece *inner, const Piece *outer, PetscInt num, const Piece sample[],
                                       Passage *found)
{
  PetscInt *crossed;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(4 * num, &crossed));
  for (PetscInt k = 0; k < 2 * num; ++k) {
    const Piece *p = &sample[k / 2];
    PetscReal    x[3];
    if (p->part != inner->part) continue;
    PieceMiddle_Private(s->dim, p->x, found->x);
    for (PetscInt c = 0; c < 3; ++c) x[c] = found->x[c] - k % 2 * p->size * p->N[c] / 2;
    for (PetscInt i = 0; i < s->num; ++i) {
      if (s->piece[i].part != outer->part) continue;
      for (PetscInt d = 0; d < 2; ++d) crossed[2 * k + d] += LineCrosses_Private(s->dim, &s->piece[i], x, LinesAlong_Private[d]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, crossed, (PetscMPIInt)(4 * num), MPIU_INT, MPI_SUM, comm));
  found->whole   = PETSC_TRUE;
  found->body[0] = inner->body;
  found->body[1] = outer->body;
  for (PetscInt k = 0; k < 4 * num; ++k) found->whole = (PetscBool)(found->whole && (sample[k / 4].part != inner->part || crossed[k] % 2));
  PetscCall(PetscFree(crossed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first part wholly inside another that it may not meet. Only where its box is in that one's is anything counted. */
static PetscErrorCode FindEnclosed_Private(MPI_Comm comm, const Pieces *s, const Which *which, Passage *found)
{
  PetscReal(*box)[6];
  Piece        *sample;
  const Piece **of; /* a sample of each part, NULL: it has no surface */
  PetscInt      num;

  PetscFunctionBegin;
  *found = (Passage){.depth = 0};
  PetscCall(PetscMalloc1(s->num_parts, &box));
  PetscCall(PetscCalloc1(s->num_parts, &of));
  PetscCall(PartBoxes_Private(comm, s, box));
  PetscCall(Samples_Private(comm, s, &num, &sample));
  for (PetscInt k = 0; k < num; ++k) of[sample[k].part] = &sample[k];
  for (PetscInt a = 0; a < s->num_parts && !found->whole; ++a) {
    for (PetscInt b = 0; b < s->num_parts && !found->whole; ++b) {
      if (a == b || !of[a] || !of[b] || !BoxWithin_Private(s->dim, box[a], box[b]) || MayMeet_Private(s->scene, which->sides, of[a], of[b])) continue;
      PetscCall(Enclosed_Private(comm, s, of[a], of[b], num, sample, found));
    }
  }
  PetscCall(PetscFree(sample));
  PetscCall(PetscFree(of));
  PetscCall(PetscFree(box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* May all parts meet each other? They hang together as they do, whatever the state. */
static PetscErrorCode AllMeet_Private(MPI_Comm comm, const Pieces *s, const Which *which, PetscBool *all)
{
  Piece   *sample;
  PetscInt num;

  PetscFunctionBegin;
  PetscCall(Samples_Private(comm, s, &num, &sample));
  *all = PETSC_TRUE;
  for (PetscInt a = 0; a < num; ++a)
    for (PetscInt b = 0; b < a; ++b) *all = (PetscBool)(*all && !Counts_Private(s, which, &sample[a], &sample[b]));
  PetscCall(PetscFree(sample));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what is asked ---------------------------------------------------------------------------------------------------------------------- */

PetscErrorCode PassageFind(Problem problem, const State *state, PetscInt group, Passage *worst)
{
  const Which which = {.group = group};
  Pieces      s     = {0};

  PetscFunctionBegin;
  PetscCall(PiecesCollect_Private(problem, state, PETSC_FALSE, &s));
  PetscCall(Find_Private(ForestComm(ProblemForest(problem)), &s, &which, worst));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PassageFindApart(Problem problem, const State *state, Passage *worst)
{
  Which   which  = {.group = -1, .apart = PETSC_TRUE};
  Forest  forest = ProblemForest(problem);
  Pieces  s      = {0};
  Passage whole;

  PetscFunctionBegin;
  PetscCall(PiecesCollect_Private(problem, state, PETSC_TRUE, &s));
  PetscCall(PiecesParts_Private(&s, ForestComm(forest), &which.sides));
  *worst = (Passage){.depth = 0};
  PetscCall(AllMeet_Private(ForestComm(forest), &s, &which, &worst->none));
  if (worst->none)
    PetscCall(PetscFree(s.piece));
  else {
    PetscCall(FindEnclosed_Private(ForestComm(forest), &s, &which, &whole));
    PetscCall(Find_Private(ForestComm(forest), &s, &which, worst));
    if (!(worst->depth > 0)) *worst = whole;
  }
  PetscCall(PetscFree(which.sides));
  PetscFunctionReturn(PETSC_SUCCESS);
}
