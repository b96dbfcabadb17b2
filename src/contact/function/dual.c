/* Multiplier functions of one facet, or of the facets that hanging nodes join (functionimpl.h has the definitions). */
#include "functionimpl.h"

/* Facets whose functions are made together, and their true nodes. */
typedef struct {
  const PetscInt *facet;
  PetscInt        num_facets, num, *node;
  PetscBool       hangs, held; /* some lattice node hangs; some node carries nothing */
} Group;

/* True nodes of the group's facets, in the order of their lattices. */
static PetscErrorCode GroupOpen_Private(MultiplierWork *w, PetscInt num_facets, const PetscInt facet[], Group *g)
{
  PetscInt         room = 0;
  FacetLattice     l;
  const PetscInt  *master;
  const PetscReal *weight;

  PetscFunctionBegin;
  *g = (Group){.facet = facet, .num_facets = num_facets};
  for (int pass = 0; pass < 2; pass++) {
    if (pass) PetscCall(PetscMalloc1(room, &g->node));
    for (PetscInt f = 0; f < num_facets; f++) {
      ContactFacetLattice(w->s, facet[f], &l);
      for (PetscInt a = 0; a < l.num; a++) {
        const PetscInt masters = ContactNodeRow(w->s, l.node + a, &master, &weight);

        room += masters;
        for (PetscInt i = 0; pass && i < masters; i++) {
          PetscCheck(!ContactNodeHangs(w->s, master[i]), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a node of a contact surface hangs on a node that hangs");
          if (w->place[master[i]] >= 0) continue;
          w->place[master[i]] = g->num;
          g->node[g->num++]   = master[i];
          if (!w->carries[master[i]]) g->held = PETSC_TRUE;
        }
        if (ContactNodeHangs(w->s, l.node[a])) g->hangs = PETSC_TRUE;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GroupClose_Private(MultiplierWork *w, Group *g)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < g->num; i++) w->place[g->node[i]] = -1;
  PetscCall(PetscFree(g->node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* T = P^T C of a facet, C[lattice][lattice] (NULL: one). */
static void Restrict_Private(const MultiplierWork *w, PetscInt facet, const PetscReal C[], PetscReal T[])
{
  FacetLattice     l;
  const PetscInt  *master;
  const PetscReal *weight;

  ContactFacetLattice(w->s, facet, &l);
  for (PetscInt a = 0; a < l.num; a++) {
    const PetscInt masters = ContactNodeRow(w->s, l.node + a, &master, &weight);

    for (PetscInt i = 0; i < masters; i++)
      for (PetscInt b = 0; b < l.num; b++) T[l.num * w->place[master[i]] + b] += weight[i] * (C ? C[l.num * a + b] : (PetscReal)(a == b));
  }
}

/* M_E += P^T M P of a facet, D_E += P^T D. */
static void AddMass_Private(const MultiplierWork *w, const FacetLattice *l, const PetscReal M[], const PetscReal D[], PetscInt size, PetscReal ME[],
                            PetscReal DE[])
{
  const PetscInt  *row, *column;
  const PetscReal *p, *q;

  for (PetscInt a = 0; a < l->num; a++) {
    const PetscInt rows = ContactNodeRow(w->s, l->node + a, &row, &p);

    for (PetscInt i = 0; i < rows; i++) DE[w->place[row[i]]] += p[i] * D[a];
    for (PetscInt b = 0; b < l->num; b++) {
      const PetscInt columns = ContactNodeRow(w->s, l->node + b, &column, &q);

      for (PetscInt i = 0; i < rows; i++)
        for (PetscInt k = 0; k < columns; k++) ME[size * w->place[row[i]] + w->place[column[k]]] += p[i] * q[k] * M[l->num * a + b];
    }
  }
}

/* Rows of the Bernstein polynomials of a facet. */
static PetscErrorCode Bernstein_Private(MultiplierWork *w, PetscInt facet)
{
  const PetscInt   num = ContactLatticeSize(w->s, facet), *master;
  const PetscReal *weight;
  PetscReal       *C, *B = w->rows[facet].B;
  FacetLattice     l;

  PetscFunctionBegin;
  ContactFacetLattice(w->s, facet, &l);
  PetscCall(PetscMalloc1(num * num, &C));
  PetscCall(ContactBernsteinRows(w->s->dim - 1, l.order, C));
  for (PetscInt a = 0; a < num; a++) {
    const PetscInt masters = ContactNodeRow(w->s, l.node + a, &master, &weight);
    PetscReal      sum     = 0;

    for (PetscInt i = 0; i < masters; i++) sum += PetscMax(0, weight[i]);
    for (PetscInt i = 0; i < masters; i++)
      for (PetscInt b = 0; b < num; b++) B[num * w->place[master[i]] + b] += PetscMax(0, weight[i]) / sum * C[num * a + b];
  }
  PetscCall(PetscFree(C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for a row of every node of the group on each of its facets. */
static PetscErrorCode RowsOpen_Private(MultiplierWork *w, const Group *g)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < g->num_facets; f++) {
    MultiplierRows *r    = w->rows + g->facet[f];
    const PetscInt  size = g->num * ContactLatticeSize(w->s, g->facet[f]);

    PetscCall(PetscFree3(r->node, r->T, r->B));
    PetscCall(PetscCalloc3(g->num, &r->node, size, &r->T, size, &r->B));
    r->num = g->num;
    PetscCall(PetscArraycpy(r->node, g->node, g->num));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* diag(int_E chi) M_E^-1 P^T on each facet of the group. */
static PetscErrorCode GroupDual_Private(MultiplierWork *w, const Group *g, PetscBool *regular)
{
  PetscInt     columns = 0;
  PetscReal   *M, *ME, *DE, *B, D[MULTIPLIER_LATTICE];
  FacetLattice l;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < g->num_facets; f++) columns += ContactLatticeSize(w->s, g->facet[f]);
  PetscCall(PetscMalloc1(MULTIPLIER_LATTICE * MULTIPLIER_LATTICE, &M));
  PetscCall(PetscCalloc3(g->num * g->num, &ME, g->num, &DE, g->num * columns, &B));
  columns = 0;
  for (PetscInt f = 0; f < g->num_facets; f++) {
    PetscReal *T = w->rows[g->facet[f]].T;

    ContactFacetLattice(w->s, g->facet[f], &l);
    PetscCall(ContactLatticeMass(w->s, &l, w->axisymmetric, M, D));
    AddMass_Private(w, &l, M, D, g->num, ME, DE);
    Restrict_Private(w, g->facet[f], NULL, T);
    for (PetscInt i = 0; i < g->num; i++)
      for (PetscInt b = 0; b < l.num; b++) B[g->num * (columns + b) + i] = T[l.num * i + b];
    columns += l.num;
  }
  PetscCall(ContactSolveSymmetric(g->num, ME, columns, B, regular));
  columns = 0;
  for (PetscInt f = 0; f < g->num_facets; f++) {
    const PetscInt num = ContactLatticeSize(w->s, g->facet[f]);

    for (PetscInt i = 0; i < g->num; i++)
      for (PetscInt b = 0; b < num; b++) w->rows[g->facet[f]].T[num * i + b] = DE[i] * B[g->num * (columns + b) + i];
    columns += num;
  }
  PetscCall(PetscFree3(ME, DE, B));
  PetscCall(PetscFree(M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* P^T diag(int N) M^-1 N on one facet; a facet without measure has P^T N. */
static PetscErrorCode LatticeDual_Private(MultiplierWork *w, PetscInt facet)
{
  const PetscInt num = ContactLatticeSize(w->s, facet);
  PetscReal     *M, *C, D[MULTIPLIER_LATTICE];
  PetscBool      regular;
  FacetLattice   l;

  PetscFunctionBegin;
  ContactFacetLattice(w->s, facet, &l);
  PetscCall(PetscMalloc2(num * num, &M, num * num, &C));
  PetscCall(ContactLatticeMass(w->s, &l, w->axisymmetric, M, D));
  for (PetscInt a = 0; a < num; a++)
    for (PetscInt b = 0; b < num; b++) C[num * a + b] = (PetscReal)(a == b);
  PetscCall(ContactSolveSymmetric(num, M, num, C, &regular));
  for (PetscInt a = 0; a < num; a++)
    for (PetscInt b = 0; b < num; b++) C[num * a + b] *= D[a];
  Restrict_Private(w, facet, regular ? C : NULL, w->rows[facet].T);
  PetscCall(PetscFree2(M, C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Positive_Private(PetscInt num, const PetscReal weight[])
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < num; i++) sum += PetscMax(0, weight[i]);
  return sum;
}

/* Functions of nodes that give go to those that take. */
static PetscErrorCode Give_Private(MultiplierWork *w, const Group *g, PetscInt degree, const PetscBool gives[], const PetscBool takes[])
{
  PetscReal *W;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(g->num * g->num, &W));
  if (!g->hangs) PetscCall(ContactExtrapolateLattice(w->s->dim, w->s->order ? w->s->order[g->facet[0]] : 1, degree, takes, W));
  if (g->hangs) PetscCall(ContactExtrapolateNodes(w->s, g->num_facets, g->facet, degree, g->num, g->node, takes, W));
  for (PetscInt e = 0; e < g->num; e++)
    if (!gives[e]) PetscCall(PetscArrayzero(W + g->num * e, g->num));
  PetscCall(ContactDonorsKeep(w->donors + g->facet[0], g->num, g->node, takes, W));
  for (PetscInt f = 0; f < g->num_facets; f++) {
    const PetscInt  num = ContactLatticeSize(w->s, g->facet[f]);
    MultiplierRows *r   = w->rows + g->facet[f];

    for (PetscInt k = 0; k < g->num * g->num; k++) {
      const PetscInt  e = k % g->num, i = k / g->num;
      const PetscReal weight = W[g->num * e + i], positive = weight > 0 ? weight / Positive_Private(g->num, W + g->num * e) : 0;

      for (PetscInt b = 0; weight != 0 && b < num; b++) {
        r->T[num * i + b] += weight * r->T[num * e + b];
        r->B[num * i + b] += positive * r->B[num * e + b];
      }
    }
  }
  PetscCall(PetscFree(W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Functions of nodes that carry nothing go to the others, those of late nodes in the second round; rows of what has none left go. */
static PetscErrorCode GroupRemove_Private(MultiplierWork *w, const Group *g, const PetscInt degree[2])
{
  PetscBool *gives, *takes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(g->num, &gives, g->num, &takes));
  for (int round = 0; round <= w->round; round++) {
    PetscInt givers = 0, takers = 0;

    for (PetscInt i = 0; i < g->num; i++) {
      const PetscBool carries = w->carries[g->node[i]], late = (PetscBool)(w->late && w->late[g->node[i]]);
      givers += gives[i] = (PetscBool)(!carries && late == (PetscBool)round);
      takers += takes[i] = (PetscBool)(round ? carries && !late : carries || late);
    }
    if (givers && takers) PetscCall(Give_Private(w, g, degree[round], gives, takes));
  }
  for (PetscInt f = 0; f < g->num_facets; f++) {
    const PetscInt  num = ContactLatticeSize(w->s, g->facet[f]);
    MultiplierRows *r   = w->rows + g->facet[f];

    r->num = 0;
    for (PetscInt i = 0; i < g->num; i++) { /* rows that stay, in place: the place is never behind the row */
      if (!w->carries[g->node[i]] && (w->round || !w->late || !w->late[g->node[i]])) continue;
      PetscCall(PetscArraymove(r->T + num * r->num, r->T + num * i, num));
      PetscCall(PetscArraymove(r->B + num * r->num, r->B + num * i, num));
      r->node[r->num++] = g->node[i];
    }
  }
  PetscCall(PetscFree2(gives, takes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactMultiplierGroup(MultiplierWork *w, PetscInt num_facets, const PetscInt facet[], const PetscInt degree[2], PetscBool *held)
{
  PetscBool regular = PETSC_FALSE;
  Group     g;

  PetscFunctionBegin;
  PetscCall(GroupOpen_Private(w, num_facets, facet, &g));
  PetscCall(RowsOpen_Private(w, &g));
  if (!w->standard && !w->exact[facet[0]]) {
    PetscCall(GroupDual_Private(w, &g, &regular));
    if (!regular) PetscCall(RowsOpen_Private(w, &g));
  }
  for (PetscInt f = 0; f < num_facets && !regular; f++) {
    if (w->standard)
      Restrict_Private(w, facet[f], NULL, w->rows[facet[f]].T);
    else
      PetscCall(LatticeDual_Private(w, facet[f]));
  }
  for (PetscInt f = 0; f < num_facets; f++) PetscCall(Bernstein_Private(w, facet[f]));
  *held = g.held;
  if (g.held) PetscCall(GroupRemove_Private(w, &g, degree));
  PetscCall(GroupClose_Private(w, &g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
