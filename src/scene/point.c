/* Points that moments are counted about and rigid bodies turn about: named ones, by default the centres of bodies. */
#include "sceneimpl.h"

#define MOST_POINTS 8 /* Gauss points in each direction: exact up to geometry of order 3 in space, and more than enough for order 4 */

PetscErrorCode SceneReadPoint(Scene s, SceneNode *node, PointEntry *p)
{
  PetscFunctionBegin;
  p->node = node;
  PetscCall(OptionsRead("point", node, s->data.mesh.dim, p));
  PetscCheckInput(NodeCount(node), "%s needs coordinates x, y%s", NodeWhere(node), s->data.mesh.dim == 3 ? ", z" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneFindPoint(Scene s, const SceneNode *user, const char *name, PetscReal X[3])
{
  const SceneNode *points = NodeFind(s->root, "point"), *node = NodeFind(user, "moment_about");
  char             list[2048] = "";

  PetscFunctionBegin;
  if (!node) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheckInput(s->data.mechanics.model != MODEL_AXISYMMETRIC, "%s is '%s', but forces on rings have no moment; take it away", NodeWhere(node), name);
  for (PetscInt i = 0; i < s->num_points; ++i) {
    if (strcmp(s->point[i].node->key, name)) continue;
    PetscCall(PetscArraycpy(X, s->point[i].X, 3));
    s->point[i].used = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (const SceneNode *child = points ? points->first : NULL; child; child = child->next) {
    if (list[0]) TextAppend(sizeof(list), list, ", ");
    TextAppend(sizeof(list), list, child->key);
  }
  PetscCall(ErrorInput("%s is '%s', which is not under point; allowed: a name that is (there: %s)", NodeWhere(node), name, list[0] ? list : "none"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume of a coarse cell and its first moments, added to sum[4]. */
static PetscErrorCode Cell_Private(const CoarseMesh *m, PetscInt cell, PetscReal sum[4])
{
  const PetscInt n = PetscMin(MOST_POINTS, (m->geometry_order * (m->dim + 1) + 1) / 2), layers = m->dim == 3 ? n : 1;
  const Basis1D *gauss;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, n, &gauss));
  for (PetscInt i = 0; i < n * n * layers; ++i) {
    const PetscInt  k[3]  = {i % n, i / n % n, i / n / n};
    const PetscReal xi[3] = {gauss->points[k[0]], gauss->points[k[1]], m->dim == 3 ? gauss->points[k[2]] : 0};
    PetscReal       X[3] = {0, 0, 0}, J[9], weight = gauss->weights[k[0]] * gauss->weights[k[1]] * (m->dim == 3 ? gauss->weights[k[2]] : 1);
    ForestCoarseMapPoint(m, cell, xi, X, J);
    weight *= PetscAbsReal(m->dim == 3 ? Det3(J) : J[0] * J[3] - J[1] * J[2]);
    for (PetscInt c = 0; c < m->dim; ++c) sum[c] += weight * X[c];
    sum[3] += weight;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The centre of all bodies that have a facet of a group. */
static void GroupCentre_Private(const CoarseMesh *m, const PetscBool touches[], PetscInt group, PetscReal (*body)[4], PetscReal centre[3])
{
  PetscReal sum[4] = {0};

  for (PetscInt b = 0; b < m->num_bodies; ++b)
    for (PetscInt c = 0; c < 4 && touches[b * m->num_boundaries + group]; ++c) sum[c] += body[b][c];
  for (PetscInt c = 0; c < 3; ++c) centre[c] = sum[3] > 0 ? sum[c] / sum[3] : 0;
}

PetscErrorCode SceneSetPoints(Scene s, const CoarseMesh *m, const PetscBool touches[])
{
  PetscReal(*body)[4];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(m->num_bodies, &body));
  for (PetscInt cell = 0; cell < m->num_cells; ++cell) PetscCall(Cell_Private(m, cell, body[m->cell_body[cell]]));
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const BodyEntry *e = s->body;
    while (strcmp(e->spec.name, s->data.bodies[b].name)) ++e;
    for (PetscInt c = 0; c < 3; ++c) {
      const PetscReal centre = body[b][c] / body[b][3];
      if (!NodeFind(e->node, "moment_about")) s->data.bodies[b].about[c] = centre;
      if (!NodeFind(NodeFind(NodeFind(e->node, "motion"), "rotation"), "point")) s->data.bodies[b].rotation_point[c] = centre;
    }
  }
  for (PetscInt i = 0; i < s->num_boundaries; ++i) {
    BoundarySpec *b = &s->data.boundaries[i];
    if (!NodeFind(s->boundary[i].node, "moment_about")) GroupCentre_Private(m, touches, b->group, body, b->about);
  }
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    ContactSpec *c = &s->data.contacts[i];
    if (!NodeFind(s->contact[i].node, "moment_about")) GroupCentre_Private(m, touches, c->exchanged ? c->mortar : c->nonmortar, body, c->about);
  }
  PetscCall(PetscFree(body));
  PetscFunctionReturn(PETSC_SUCCESS);
}
