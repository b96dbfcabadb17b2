/* Do bodies of a contact pair lie inside each other where the pair bears nothing? Contact that is lost, by a motion across a whole body in one step say,
   opposes no further motion, and what is found then is no solution. Of the pairs that bear nothing some places of either side (or of its body's boundary), and
   places behind them in their own body, are looked at: as far behind as their facet is long, or half, a quarter, an eighth of that where the body ends before,
   as a tip does. Lines from a place inside a body leave it an odd number of times, whatever their direction. */
#include "diagnoseimpl.h"

#define SAMPLES 32 /* places of one side of a pair on a rank */

enum { DEPTHS = 4 }; /* places behind one */

const PetscReal LinesAlong_Private[2][3] = {{0.7548776662, 0.5698402910, 0.3247179572}, {-0.4142135624, 0.7320508076, -0.6180339887}};

typedef struct {
  PetscReal x[3], behind[3];  /* on a facet, and as far behind it as that is long */
  PetscInt  pair, side, part; /* of the facet */
} Place;

PetscBool LineCrosses_Private(PetscInt dim, const Piece *p, const PetscReal x[3], const PetscReal d[3])
{
  PetscReal r[3], e[3], f[3], n[3], q[3];

  for (PetscInt c = 0; c < 3; ++c) {
    r[c] = p->x[c] - x[c];
    e[c] = p->x[3 + c] - p->x[c];
    f[c] = dim == 3 ? p->x[6 + c] - p->x[c] : 0;
  }
  if (dim == 2) {
    const PetscReal out = d[0] * e[1] - d[1] * e[0], at = (r[0] * d[1] - r[1] * d[0]) / out;
    return (PetscBool)(out != 0 && (r[0] * e[1] - r[1] * e[0]) / out > 0 && at >= 0 && at < 1);
  }
  Cross3(e, f, n);
  Cross3(r, d, q);
  const PetscReal out = Dot3(n, d), u = Dot3(q, f) / out, v = -Dot3(q, e) / out;
  return (PetscBool)(out != 0 && Dot3(n, r) / out > 0 && u >= 0 && v >= 0 && u + v < 1);
}

/* What is looked at: the pieces of a state, which parts have which sides (PiecesParts_Private), and whether places are on all facets of these parts or on the
   pair's own. */
typedef struct {
  Pieces    s;
  int8_t   *is; /* owned */
  PetscBool whole;
} Look;

static PetscBool IsOf_Private(const Look *l, const Piece *p, PetscInt k)
{
  if (l->whole) return (PetscBool)l->is[2 * l->s.scene->num_contacts * p->part + k];
  return (PetscBool)((p->groups & PairGroup_Private(&l->s.scene->contacts[k / 2], k % 2)) != 0);
}

/* Places of this rank, in the middle of pieces. */
static void Places_Private(const Look *l, const PetscInt bare[], PetscInt *num, Place place[])
{
  const Pieces *s = &l->s;

  *num = 0;
  for (PetscInt k = 0; k < 2 * s->scene->num_contacts; ++k) {
    PetscInt count = 0, seen = 0;
    if (!bare[k / 2]) continue;
    for (PetscInt i = 0; i < s->num; ++i) count += IsOf_Private(l, &s->piece[i], k);
    const PetscInt every = (count + SAMPLES - 1) / SAMPLES;
    for (PetscInt i = 0; i < s->num; ++i) {
      const Piece *p = &s->piece[i];
      if (!IsOf_Private(l, p, k) || seen++ % every) continue;
      Place *to = &place[(*num)++];
      *to       = (Place){.pair = k / 2, .side = k % 2, .part = p->part};
      PieceMiddle_Private(s->dim, p->x, to->x);
      for (PetscInt c = 0; c < 3; ++c) to->behind[c] = to->x[c] - p->size * p->N[c];
    }
  }
}

/* Is a part one that a place should not be inside: with the other side of its pair and not with its own too; of one surface, another part? */
static PetscBool IsOther_Private(const Look *l, PetscInt part, const Place *of)
{
  const ContactSpec *pair = &l->s.scene->contacts[of->pair];
  const int8_t      *has  = l->is + 2 * (l->s.scene->num_contacts * part + of->pair);

  if (!has[1 - of->side]) return PETSC_FALSE;
  return (PetscBool)(pair->self ? part != of->part : !has[of->side]);
}

/* inside[num]: do places lie inside their own part, or inside others (IsOther_Private)? Two lines have to say so. Collective. */
static PetscErrorCode Inside_Private(const Look *l, MPI_Comm comm, PetscBool own, PetscInt num, const Place place[], PetscBool inside[])
{
  const Pieces *s = &l->s;
  PetscInt     *crossed;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(2 * num, &crossed));
  for (PetscInt i = 0; i < s->num; ++i) {
    const Piece *p = &s->piece[i];
    for (PetscInt k = 0; k < num; ++k) {
      if (!(own ? p->part == place[k].part : IsOther_Private(l, p->part, &place[k]))) continue;
      for (PetscInt d = 0; d < 2; ++d) crossed[2 * k + d] += LineCrosses_Private(s->dim, p, place[k].x, LinesAlong_Private[d]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, crossed, (PetscMPIInt)(2 * num), MPIU_INT, MPI_SUM, comm));
  for (PetscInt k = 0; k < num; ++k) inside[k] = (PetscBool)(crossed[2 * k] % 2 && crossed[2 * k + 1] % 2);
  PetscCall(PetscFree(crossed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* within[pair]: of these places, which lie inside another body, one has the farthest place behind it that is in its own body inside there as well. Collective.
 */
static PetscErrorCode Behind_Private(const Look *l, MPI_Comm comm, PetscInt num, const Place place[], PetscBool within[])
{
  Place     *deep;
  PetscBool *own, *other;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(DEPTHS * num, &deep, DEPTHS * num, &own, DEPTHS * num, &other));
  for (PetscInt i = 0; i < DEPTHS * num; ++i) { /* the farthest first */
    const PetscReal share = 1 / (PetscReal)(1 << i % DEPTHS);
    deep[i]               = place[i / DEPTHS];
    for (PetscInt c = 0; c < 3; ++c) deep[i].x[c] += share * (deep[i].behind[c] - deep[i].x[c]);
  }
  PetscCall(Inside_Private(l, comm, PETSC_TRUE, DEPTHS * num, deep, own));
  PetscCall(Inside_Private(l, comm, PETSC_FALSE, DEPTHS * num, deep, other));
  for (PetscInt k = 0; k < num; ++k) {
    PetscInt i = DEPTHS * k;
    while (i < DEPTHS * (k + 1) && !own[i]) ++i;
    if (i < DEPTHS * (k + 1) && other[i]) within[place[k].pair] = PETSC_TRUE;
  }
  PetscCall(PetscFree3(deep, own, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* within[pair]: one of its places lies inside the other body. Collective. */
static PetscErrorCode Find_Private(const Look *l, MPI_Comm comm, const PetscInt bare[], PetscBool within[])
{
  PetscInt   num_mine, num, found = 0;
  Place     *mine, *all;
  PetscBool *inside;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < l->s.scene->num_contacts; ++i) within[i] = PETSC_FALSE;
  PetscCall(PetscMalloc1(2 * SAMPLES * l->s.scene->num_contacts, &mine));
  Places_Private(l, bare, &num_mine, mine);
  PetscCall(GatherAll(comm, num_mine, sizeof(Place), mine, &num, &all));
  PetscCall(PetscMalloc1(num, &inside));
  PetscCall(Inside_Private(l, comm, PETSC_FALSE, num, all, inside));
  for (PetscInt k = 0; k < num; ++k)
    if (inside[k]) all[found++] = all[k];
  if (found) PetscCall(Behind_Private(l, comm, found, all, within));
  PetscCall(PetscFree(inside));
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first pair of those that is within, and not so as the mesh has it, with nothing displaced: supports and rigid bodies neither; and the first that still
   is. */
static PetscErrorCode First_Private(Problem problem, MPI_Comm comm, PetscBool whole, PetscInt num, PetscInt bare[], const PetscBool within[], PetscInt *pair,
                                    PetscInt *still)
{
  Look       drawn = {.whole = whole};
  PetscReal *none;
  PetscBool *before, any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) {
    bare[i] = within[i];
    any     = (PetscBool)(any || within[i]);
  }
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(ProblemSpace(problem));
  PetscCall(PetscCalloc1(v->num_nodes * v->dim, &none));
  PetscCall(PetscMalloc1(num, &before));
  PetscCall(PiecesAt_Private(problem, none, PETSC_TRUE, &drawn.s));
  PetscCall(PiecesParts_Private(&drawn.s, comm, &drawn.is));
  PetscCall(Find_Private(&drawn, comm, bare, before));
  for (PetscInt i = num - 1; i >= 0; --i) {
    if (within[i]) *(before[i] ? still : pair) = i;
  }
  PetscCall(PetscFree(drawn.is));
  PetscCall(PetscFree(drawn.s.piece));
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one surface ------------------------------------------------------------------------------------------------------------------------ */

/* How often place k of a piece (halfway from its middle to a corner, or its middle) lies in the body of its own part, the body right behind it not counted: so
   often more does a line that begins outwards leave than enter the body, through other pieces. */
static PetscInt Within_Private(const Pieces *s, const Piece *of, PetscInt k, const PetscReal along[3])
{
  const PetscReal sign = along[0] * of->N[0] + along[1] * of->N[1] + along[2] * of->N[2] < 0 ? -1 : 1,
                  d[3] = {sign * along[0], sign * along[1], sign * along[2]};
  PetscReal x[3];
  PetscInt  within = 0;

  PieceMiddle_Private(s->dim, of->x, x);
  for (PetscInt c = 0; c < 3 && k < s->dim; ++c) x[c] = (x[c] + of->x[3 * k + c]) / 2;
  for (PetscInt i = 0; i < s->num; ++i) {
    const Piece *p = &s->piece[i];
    if (p->part == of->part && memcmp(p->X, of->X, sizeof(p->X)) && LineCrosses_Private(s->dim, p, x, d)) within += Dot3(p->N, d) > 0 ? 1 : -1;
  }
  return within;
}

/* Does a facet of this group that pieces which cut each other are near to lie wholly inside its own body, as another part of the surface? Less than that, a
   corner within the facet that it meets, is what weighted gaps leave open. Collective. */
static PetscErrorCode Deep_Private(const Pieces *s, MPI_Comm comm, PetscInt group, const PetscReal box[6], PetscBool *deep)
{
  const PetscInt each = 2 * (s->dim + 1); /* places of a piece, lines */
  PetscInt       num  = 0, *within;
  Piece         *near, *all;

  PetscFunctionBegin;
  *deep = PETSC_FALSE;
  PetscCall(PetscMalloc1(s->num, &near));
  for (PetscInt i = 0; i < s->num; ++i) {
    if ((s->piece[i].groups >> group & 1) && ContactBoxesMeet(s->piece[i].box, box)) near[num++] = s->piece[i];
  }
  PetscCall(GatherAll(comm, num, sizeof(Piece), near, &num, &all));
  PetscCall(PetscMalloc1(each * num, &within));
  for (PetscInt i = 0; i < each * num; ++i) within[i] = Within_Private(s, &all[i / each], i % each / 2, LinesAlong_Private[i % 2]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, within, (PetscMPIInt)(each * num), MPIU_INT, MPI_SUM, comm));
  for (PetscInt i = 0; i < num; ++i) {
    PetscBool is = PETSC_TRUE;
    for (PetscInt k = 0; k < each; ++k) is = (PetscBool)(is && within[each * i + k] > 0);
    *deep = (PetscBool)(*deep || is);
  }
  PetscCall(PetscFree(near));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(within));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first pair of one surface that bears nothing and of which a part passes through itself. */
static PetscErrorCode Own_Private(Problem problem, const State *state, const Pieces *s, MPI_Comm comm, const PetscInt bare[], PetscInt *pair)
{
  PetscFunctionBegin;
  *pair = -1;
  for (PetscInt i = 0; i < s->scene->num_contacts && *pair < 0; ++i) {
    const PetscInt group   = s->scene->contacts[i].nonmortar;
    Passage        passage = {.depth = 0};
    PetscBool      deep    = PETSC_FALSE;
    if (bare[i] && s->scene->contacts[i].self) PetscCall(PassageFind(problem, state, group, &passage));
    if (passage.depth > 0) PetscCall(Deep_Private(s, comm, group, passage.box, &deep));
    if (deep) *pair = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InsideFind(Problem problem, const State *state, PetscBool whole, PetscInt *pair, PetscInt *still)
{
  Forest    forest = ProblemForest(problem);
  Look      now    = {.whole = whole};
  PetscInt *bare, own;
  PetscBool any, *within;

  PetscFunctionBegin;
  *pair = *still         = -1;
  const SceneData *scene = ProblemGetScene(problem);
  if (scene->num_contacts == 0 || scene->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(scene->num_contacts, &bare, scene->num_contacts, &within));
  PetscCall(PairsBare_Private(problem, ForestComm(forest), scene->num_contacts, bare, &any));
  if (any) {
    PetscCall(PiecesCollect_Private(problem, state, PETSC_TRUE, &now.s));
    PetscCall(PiecesParts_Private(&now.s, ForestComm(forest), &now.is));
    PetscCall(Find_Private(&now, ForestComm(forest), bare, within));
    PetscCall(Own_Private(problem, state, &now.s, ForestComm(forest), bare, &own));
    PetscCall(First_Private(problem, ForestComm(forest), whole, scene->num_contacts, bare, within, pair, still));
    PetscCall(PetscFree(now.is));
    PetscCall(PetscFree(now.s.piece));
    if (*pair < 0) *pair = own;
  }
  PetscCall(PetscFree2(bare, within));
  PetscFunctionReturn(PETSC_SUCCESS);
}
