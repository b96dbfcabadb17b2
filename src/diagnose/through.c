/* Did a body go right through the other one of a contact pair that bears nothing? Nothing overlaps any more when it is out at the far side, and no contact
   tells. From the state that was set out from (s = 0) to the one found (s = 1) all outer facets, as they are drawn, move on straight lines. Of a middle that
   touches the other body at s = 0, round-off decides on which side it is: the way is followed from s = -1 on. */
#include "diagnoseimpl.h"

/* A piece on its way. */
typedef struct {
  PetscReal   x[2][9]; /* corners at s = 0 and 1 */
  PetscReal   box[6];  /* from s = -1 to 1; of a middle: of that alone */
  uint64_t    groups;
  PetscInt    part, piece, pair, side; /* of a middle: the piece it is of, and the side of a pair */
  PetscInt    number;                  /* of a middle: among those of all ranks */
  PetscMPIInt rank;
} Mover;

/* A middle goes through a piece of another part. */
typedef struct {
  Crossing  at;
  PetscReal along, way; /* cosines of the piece's normal with the middle's own, and with its motion past the piece */
  PetscInt  number, pair, part;
  PetscBool side; /* the piece is on the pair's other side */
} Event;

typedef struct {
  PetscInt num, room;
  Event   *event; /* owned */
} Events;

/* ---- what moves ------------------------------------------------------------------------------------------------------------------------ */

/* Where a point gets from s = -1 to 1. */
static void Extend_Private(PetscReal box[6], const PetscReal from[3], const PetscReal to[3])
{
  for (PetscInt c = 0; c < 3; ++c) {
    const PetscReal back = 2 * from[c] - to[c];
    box[c]               = PetscMin(box[c], PetscMin(back, to[c]));
    box[3 + c]           = PetscMax(box[3 + c], PetscMax(back, to[c]));
  }
}

static void Empty_Private(PetscReal box[6])
{
  for (PetscInt c = 0; c < 3; ++c) box[c] = PETSC_MAX_REAL, box[3 + c] = -PETSC_MAX_REAL;
}

static PetscErrorCode Movers_Private(const Pieces s[2], MPI_Comm comm, Mover **mover)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(s->num, mover));
  for (PetscInt i = 0; i < s->num; ++i) {
    Mover *m = *mover + i;
    *m       = (Mover){.groups = s->piece[i].groups, .part = s->piece[i].part, .piece = i, .rank = rank};
    for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscArraycpy(m->x[k], s[k].piece[i].x, 9));
    Empty_Private(m->box);
    for (PetscInt a = 0; a < s->dim; ++a) Extend_Private(m->box, m->x[0] + 3 * a, m->x[1] + 3 * a);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Boxes of the ways of all parts. Collective. */
static PetscErrorCode Ways_Private(MPI_Comm comm, PetscInt num_parts, PetscInt num, const Mover mover[], PetscReal (**way)[6])
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_parts, way));
  for (PetscInt p = 0; p < num_parts; ++p) Empty_Private((*way)[p]);
  for (PetscInt i = 0; i < num; ++i) {
    PetscReal *box = (*way)[mover[i].part];
    for (PetscInt c = 0; c < 3; ++c) {
      box[c]     = PetscMin(box[c], mover[i].box[c]);
      box[3 + c] = PetscMax(box[3 + c], mover[i].box[3 + c]);
    }
  }
  for (PetscInt k = 0; k < 6 * num_parts; ++k) (*way)[k / 6][k % 6] *= k % 6 < 3 ? 1 : -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, *way, (PetscMPIInt)(6 * num_parts), MPIU_REAL, MPI_MIN, comm));
  for (PetscInt k = 0; k < 6 * num_parts; ++k) (*way)[k / 6][k % 6] *= k % 6 < 3 ? 1 : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a middle on this side of the pair get where a part with the other side gets? */
static PetscBool Nears_Private(const Pieces *s, const int8_t is[], const PetscReal way[][6], const Mover *middle)
{
  for (PetscInt p = 0; p < s->num_parts; ++p) {
    if (is[2 * (p * s->scene->num_contacts + middle->pair) + 1 - middle->side] && ContactBoxesMeet(way[p], middle->box)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The middles of pieces on the sides of bare pairs, of all ranks. Collective. */
static PetscErrorCode Middles_Private(const Pieces *s, MPI_Comm comm, const PetscInt bare[], const int8_t is[], const Mover mover[], PetscInt *num,
                                      Mover **middle)
{
  PetscInt mine = 0, most = 0;
  Mover   *own;
  PetscReal(*way)[6];

  PetscFunctionBegin;
  PetscCall(Ways_Private(comm, s->num_parts, s->num, mover, &way));
  for (PetscInt i = 0; i < 2 * s->scene->num_contacts; ++i) most += bare[i / 2] ? s->num : 0;
  PetscCall(PetscMalloc1(most, &own));
  for (PetscInt k = 0; k < 2 * s->scene->num_contacts; ++k) {
    const uint64_t group = PairGroup_Private(&s->scene->contacts[k / 2], k % 2);
    for (PetscInt i = 0; bare[k / 2] && i < s->num; ++i) {
      PetscReal from[3], to[3];
      if (!(mover[i].groups & group)) continue;
      own[mine]      = mover[i];
      own[mine].pair = k / 2, own[mine].side = k % 2;
      PieceMiddle_Private(s->dim, mover[i].x[0], from);
      PieceMiddle_Private(s->dim, mover[i].x[1], to);
      Empty_Private(own[mine].box);
      Extend_Private(own[mine].box, from, to);
      mine += Nears_Private(s, is, way, &own[mine]);
    }
  }
  PetscCall(GatherAll(comm, mine, sizeof(Mover), own, num, middle));
  for (PetscInt i = 0; i < *num; ++i) (*middle)[i].number = i;
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(way));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what it goes through -------------------------------------------------------------------------------------------------------------- */

/* Unit vector along the motion of a middle past the middle of a piece. */
static void Past_Private(PetscInt dim, const Mover *p, const PetscReal y[2][3], PetscReal way[3])
{
  PetscReal x[2][3], size;

  for (PetscInt k = 0; k < 2; ++k) PieceMiddle_Private(dim, p->x[k], x[k]);
  for (PetscInt c = 0; c < 3; ++c) way[c] = y[1][c] - y[0][c] - (x[1][c] - x[0][c]);
  size = PetscSqrtReal(Dot3(way, way));
  for (PetscInt c = 0; c < 3 && size > 0; ++c) way[c] /= size;
}

static PetscErrorCode Meet_Private(const Pieces *s, const int8_t is[], const Mover *m, const Mover *p, Events *events)
{
  Crossing  crossing[3];
  PetscReal y[2][3], own[3], way[3];

  PetscFunctionBegin;
  if (!is[2 * (p->part * s->scene->num_contacts + m->pair) + 1 - m->side] || !ContactBoxesMeet(m->box, p->box)) PetscFunctionReturn(PETSC_SUCCESS);
  if (m->rank == p->rank && m->piece == p->piece) PetscFunctionReturn(PETSC_SUCCESS);             /* its own */
  if (s->scene->contacts[m->pair].self && m->part == p->part) PetscFunctionReturn(PETSC_SUCCESS); /* inside.c */
  for (PetscInt k = 0; k < 2; ++k) PieceMiddle_Private(s->dim, m->x[k], y[k]);
  Past_Private(s->dim, p, y, way);
  const PetscInt num = CrossingsFind_Private(s->dim, p->x, y, crossing);
  for (PetscInt i = 0; i < num; ++i) {
    if (events->num == events->room) {
      events->room = PetscMax(64, 2 * events->room);
      PetscCall(PetscRealloc((size_t)events->room * sizeof(Event), &events->event));
    }
    MovingNormal_Private(s->dim, m->x, crossing[i].s, own);
    events->event[events->num++] = (Event){.at     = crossing[i],
                                           .along  = Dot3(crossing[i].N, own),
                                           .way    = Dot3(crossing[i].N, way),
                                           .number = m->number,
                                           .pair   = m->pair,
                                           .part   = p->part,
                                           .side   = (PetscBool)((p->groups & PairGroup_Private(&s->scene->contacts[m->pair], 1 - m->side)) != 0)};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int Compare_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Mover *)a)->box[0], y = ((const Mover *)b)->box[0];
  return x < y ? -1 : x > y;
}

/* Sort and sweep: of each the others that begin within it. */
static PetscErrorCode Sweep_Private(const Pieces *s, const int8_t is[], PetscInt num, Mover middle[], Mover mover[], Events *events)
{
  PetscFunctionBegin;
  qsort(middle, (size_t)num, sizeof(Mover), Compare_Private);
  qsort(mover, (size_t)s->num, sizeof(Mover), Compare_Private);
  for (PetscInt i = 0, from = 0; i < s->num; ++i) {
    while (from < num && middle[from].box[0] < mover[i].box[0]) ++from;
    for (PetscInt k = from; k < num && middle[k].box[0] <= mover[i].box[3]; ++k) PetscCall(Meet_Private(s, is, &middle[k], &mover[i], events));
  }
  for (PetscInt k = 0, from = 0; k < num; ++k) {
    while (from < s->num && mover[from].box[0] <= middle[k].box[0]) ++from;
    for (PetscInt i = from; i < s->num && mover[i].box[0] <= middle[k].box[3]; ++i) PetscCall(Meet_Private(s, is, &middle[k], &mover[i], events));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- who is through --------------------------------------------------------------------------------------------------------------------- */

/* By middle, part and way. */
static int Order_Private(const void *a, const void *b)
{
  const Event *x = a, *y = b;
  if (x->number != y->number) return x->number < y->number ? -1 : 1;
  if (x->part != y->part) return x->part < y->part ? -1 : 1;
  if (x->at.s != y->at.s) return x->at.s < y->at.s ? -1 : 1;
  return (int)x->at.out - (int)y->at.out;
}

/* Is a middle, after these events of it with one part, out at a far side, one that looks along its motion and its own normal, when it went in at one that
   looks against its motion? Who slides along a side and off its edge did not go in so. Who comes back in there is where it was before. */
static PetscBool IsThrough_Private(PetscInt num, const Event event[])
{
  PetscBool in = PETSC_FALSE, through = PETSC_FALSE;

  for (PetscInt i = 0; i < num; ++i) {
    const Crossing *at  = &event[i].at;
    const PetscBool far = (PetscBool)(event[i].along > CONTACT_OPPOSE);
    if (at->out) {
      through = (PetscBool)(through || (in && far && event[i].way > CONTACT_OPPOSE && at->s > 0));
      in      = PETSC_FALSE;
    } else if (through && far) {
      through = PETSC_FALSE;
      in      = PETSC_TRUE;
    } else if (event[i].side)
      in = (PetscBool)(event[i].way < -CONTACT_OPPOSE);
  }
  return through;
}

/* The first pair of which a middle is through, -1: none. */
static PetscInt First_Private(Events *events)
{
  PetscInt pair = -1;

  qsort(events->event, (size_t)events->num, sizeof(Event), Order_Private);
  for (PetscInt i = 0, last; i < events->num; i = last) {
    const Event *e = &events->event[i];
    for (last = i + 1; last < events->num && events->event[last].number == e->number && events->event[last].part == e->part;) ++last;
    if ((pair < 0 || e->pair < pair) && IsThrough_Private(last - i, e)) pair = e->pair;
  }
  return pair;
}

static PetscErrorCode Find_Private(const Pieces s[2], MPI_Comm comm, const PetscInt bare[], PetscInt *pair)
{
  Events   mine = {0}, all = {0};
  PetscInt num;
  int8_t  *is;
  Mover   *mover, *middle;

  PetscFunctionBegin;
  PetscCall(PiecesParts_Private(s, comm, &is));
  PetscCall(Movers_Private(s, comm, &mover));
  PetscCall(Middles_Private(s, comm, bare, is, mover, &num, &middle));
  if (num > 0) {
    PetscCall(Sweep_Private(s, is, num, middle, mover, &mine));
    PetscCall(GatherAll(comm, mine.num, sizeof(Event), mine.event, &all.num, &all.event));
    *pair = First_Private(&all);
  }
  PetscCall(PetscFree(mine.event));
  PetscCall(PetscFree(all.event));
  PetscCall(PetscFree(middle));
  PetscCall(PetscFree(mover));
  PetscCall(PetscFree(is));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ThroughFind(Problem problem, const PetscReal from[], const State *state, PetscInt *pair)
{
  Forest    forest = ProblemForest(problem);
  Pieces    s[2]   = {{0}, {0}};
  PetscInt *bare;
  PetscBool any;

  PetscFunctionBegin;
  *pair                  = -1;
  const SceneData *scene = ProblemGetScene(problem);
  if (scene->num_contacts == 0 || scene->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(scene->num_contacts, &bare));
  PetscCall(PairsBare_Private(problem, ForestComm(forest), scene->num_contacts, bare, &any));
  if (any) {
    PetscCall(PiecesAt_Private(problem, from, PETSC_TRUE, &s[0]));
    PetscCall(PiecesCollect_Private(problem, state, PETSC_TRUE, &s[1]));
    PetscCall(Find_Private(s, ForestComm(forest), bare, pair));
    PetscCall(PetscFree(s[0].piece));
    PetscCall(PetscFree(s[1].piece));
  }
  PetscCall(PetscFree(bare));
  PetscFunctionReturn(PETSC_SUCCESS);
}
