/* Where an iterate is least of a solution: the node whose forces are farthest out of balance, or whose contact condition is farthest from met (both are
   forces), its body, and a pair on one of whose sides it is. */
#include "problemimpl.h"

typedef struct {
  PetscReal    most; /* of the residual, negative where nothing was looked at */
  ProblemPlace place;
} Worst;

/* A cell that depends on a local node. */
static PetscInt Cell_Private(const HPTables *v, PetscInt node)
{
  for (PetscInt c = 0; c < v->num_cells; ++c)
    for (PetscInt k = v->cell_row[c]; k < v->cell_row[c + 1]; ++k)
      if (v->cell_master[k] == node) return c;
  return -1;
}

PetscInt ProblemNodeBody(Problem p, PetscInt node)
{
  const HPTables *v    = HPSpaceGetTables(p->space);
  const PetscInt  cell = Cell_Private(v, node);

  return cell < 0 ? -1 : ForestGetTables(p->forest)->leaf_body[v->cell_leaf[cell]];
}

static PetscBool Has_Private(const SurfaceView *s, PetscInt entity)
{
  for (PetscInt i = 0; i < s->num_nodes; ++i)
    if (s->node_entity[i] == entity) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Of this rank's displacements. */
static PetscErrorCode Forces_Private(Problem p, const PetscReal r[], Worst *w)
{
  const HPTables *v    = HPSpaceGetTables(p->space);
  PetscInt        node = -1;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_local; ++i) {
    const PetscInt row = p->index[i] - p->start;
    if (p->index[i] < 0 || row < 0 || row >= p->num_u || PetscAbsReal(r[row]) <= w->most) continue;
    w->most = PetscAbsReal(r[row]);
    node    = i / v->dim;
  }
  if (node < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(w->place.X, v->X + 3 * node, 3));
  w->place.body = ProblemNodeBody(p, node);
  for (PetscInt i = 0; i < p->scene->num_contacts && w->place.pair < 0; ++i) {
    const ContactView *view = InterfaceGetContact(p->interface, i);
    if (Has_Private(&view->nonmortar, v->node_entity[node]) || Has_Private(&view->mortar, v->node_entity[node])) w->place.pair = i;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of this rank's multipliers. */
static PetscErrorCode Contact_Private(Problem p, Vec r, Worst *w)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->scene->num_contacts; ++i) {
    const ContactView *view = InterfaceGetContact(p->interface, i);
    const SurfaceView *s    = &view->nonmortar;
    PetscReal         *z;
    PetscBool         *own;
    PetscCall(PetscCalloc2(view->num_z * s->num_nodes, &z, s->num_nodes, &own));
    PetscCall(InterfaceGetMultipliers(p->interface, i, r, z, own));
    for (PetscInt k = 0; k < view->num_z * s->num_nodes; ++k) {
      const PetscInt node = k % s->num_nodes;
      if (!own[node] || PetscAbsReal(z[k]) <= w->most) continue;
      *w = (Worst){.most = PetscAbsReal(z[k]), .place = {.body = -1, .pair = i}};
      for (PetscInt c = 0; c < s->dim; ++c) w->place.X[c] = s->X[node * s->dim + c];
    }
    PetscCall(PetscFree2(z, own));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindWorst(Problem p, Vec r, ProblemPlace *place)
{
  Worst            w = {.most = -1, .place = {.body = -1, .pair = -1}};
  const PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(r, &array));
  PetscCall(Forces_Private(p, array, &w));
  PetscCall(VecRestoreArrayRead(r, &array));
  PetscCall(Contact_Private(p, r, &w));
  w.place.known = (PetscBool)(w.most > 0);
  PetscCall(BroadcastLargest(p->comm, w.most, &w.place, sizeof(w.place)));
  *place = w.place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindInvertedAt(Problem p, Vec x, ProblemPlace *place)
{
  const ForestTables *t        = ForestGetTables(p->forest);
  const PetscReal     middle[] = {0.5, 0.5, 0.5};
  int8_t             *folded;
  PetscInt            leaf = 0;

  PetscFunctionBegin;
  *place = (ProblemPlace){.inverted = PETSC_TRUE, .pair = -1};
  PetscCall(PetscCalloc1(t->num_leaves, &folded));
  PetscCall(ProblemFindFolded(p, x, folded));
  while (leaf < t->num_leaves && !folded[leaf]) ++leaf;
  PetscCall(PetscFree(folded));
  place->known = (PetscBool)(leaf < t->num_leaves);
  if (!place->known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestMapPoint(p->forest, leaf, middle, place->X));
  place->body = t->leaf_body[leaf];
  PetscFunctionReturn(PETSC_SUCCESS);
}
