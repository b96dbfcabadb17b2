/* What a simpler model asks of the state found: how far contact slides, whether the supports of a body are a motion of it as a whole, how symmetric it is. */
#include "needsimpl.h"

/* ---- contact ---------------------------------------------------------------------------------------------------------------------------- */

/* Sums over the nodes of a side, weighted by the magnitude of the contact force: 0 weight, 1-3 displacement, 4-6 position, 7 its square, 8-10 force. */
static void Side_Private(const SurfaceView *s, PetscReal sum[11])
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal weight = 0;
    if (!s->owned[n]) continue;
    for (PetscInt c = 0; c < s->dim; ++c) weight += PetscSqr(s->force[s->dim * n + c]);
    weight = PetscSqrtReal(weight);
    sum[0] += weight;
    for (PetscInt c = 0; c < s->dim; ++c) {
      const PetscReal x = s->x[s->dim * n + c];
      sum[1 + c] += weight * (x - s->X[s->dim * n + c]);
      sum[4 + c] += weight * x;
      sum[7] += weight * x * x;
      sum[8 + c] += s->force[s->dim * n + c];
    }
  }
}

/* Of the facets of a side, weighted by the contact force at their corners: 0 weight, 1 squared turn of the normal. */
static void Normals_Private(const SurfaceView *s, PetscReal sum[2])
{
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *corner = s->facets + s->corners * f;
    PetscReal       N[3], n[3], weight = 0, turn2 = 0;

    for (PetscInt k = 0; k < s->corners * s->dim; ++k) weight += PetscAbsReal(s->force[s->dim * corner[k / s->dim] + k % s->dim]);
    if (!(weight > 0)) continue;
    ContactFacetVector(s->dim, s->X, corner, N);
    ContactFacetVector(s->dim, s->x, corner, n);
    for (PetscInt c = 0; c < 3; ++c) turn2 += PetscSqr(n[c] / PetscSqrtReal(Dot3(n, n)) - N[c] / PetscSqrtReal(Dot3(N, N)));
    sum[0] += weight;
    sum[1] += weight * turn2;
  }
}

/* Small kinematics leaves the pressure where it would be if the sides did not slide along each other. The gap of smooth surfaces is quadratic about the middle
   of their zone, so what that changes goes with the square of the slide over the size of the zone. And it leaves the pressure's direction as it was. */
PetscErrorCode NeedsContactTurn(const NeedsRun *run, PetscInt pair, PetscReal *turn)
{
  const ContactView *v, *all;
  PetscReal          sum[2][11] = {{0}}, normals[2] = {0, 0}, slide[3], force = 0, normal = 0, size, tangent = 0;

  PetscFunctionBegin;
  *turn = 0;
  v     = InterfaceGetContact(ProblemInterface(run->level->problem), pair);
  Side_Private(&v->nonmortar, sum[0]);
  Side_Private(&v->mortar, sum[1]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 22, MPIU_REAL, MPI_SUM, run->comm));
  PetscCall(InterfaceGatherContactToAll(ProblemInterface(run->level->problem), pair, &all)); /* facets have corners of several ranks */
  Normals_Private(&all->nonmortar, normals);
  Normals_Private(&all->mortar, normals);
  if (normals[0] > 0) *turn = PetscSqrtReal(normals[1] / normals[0]);
  if (!(sum[0][0] > 0) || !(sum[1][0] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  size = sum[0][7] / sum[0][0];
  for (PetscInt c = 0; c < 3; ++c) {
    size -= PetscSqr(sum[0][4 + c] / sum[0][0]);
    slide[c] = sum[0][1 + c] / sum[0][0] - sum[1][1 + c] / sum[1][0];
    force += PetscSqr(sum[0][8 + c]);
  }
  if (force < 0.25 * PetscSqr(sum[0][0]) || !(size > 0)) PetscFunctionReturn(PETSC_SUCCESS); /* it goes round: there is no one direction to slide in */
  for (PetscInt c = 0; c < 3; ++c) normal += slide[c] * sum[0][8 + c] / PetscSqrtReal(force);
  for (PetscInt c = 0; c < 3; ++c) tangent += PetscSqr(slide[c] - normal * sum[0][8 + c] / PetscSqrtReal(force));
  *turn = PetscMax(*turn, tangent / size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- bodies ----------------------------------------------------------------------------------------------------------------------------- */

/* Has the body a facet of the group? */
static PetscBool Touches_Private(const ForestTables *t, PetscInt body, PetscInt group)
{
  for (PetscInt leaf = 0; leaf < t->num_leaves; ++leaf)
    if (t->leaf_body[leaf] == body && ForestLeafTouches(t, leaf, UINT64_C(1) << group)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does it face a rigid body in a pair? One side of each has to deform. */
static PetscBool FacesRigid_Private(const NeedsRun *run, const ForestTables *t, PetscInt body)
{
  const SceneData *data = run->data;

  for (PetscInt i = 0; i < data->num_contacts; ++i) {
    const PetscInt group[2] = {data->contacts[i].nonmortar, data->contacts[i].mortar};
    for (PetscInt k = 0; k < 2; ++k) {
      if (!Touches_Private(t, body, group[k])) continue;
      for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b)
        if (data->mechanics.bodies[b].material->law->rigid && Touches_Private(t, b, group[1 - k])) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

PetscErrorCode NeedsRigidMotion(const NeedsRun *run, PetscInt body, cJSON **motion, PetscBool *held)
{
  const MechanicsSpec *m        = &run->data->mechanics;
  const PetscInt       dim      = m->model == MODEL_3D ? 3 : 2;
  const BodySpec      *spec     = &m->bodies[body];
  const char          *value[3] = {NULL, NULL, NULL};

  PetscFunctionBegin;
  *motion               = cJSON_CreateObject();
  *held                 = (PetscBool)(!spec->force[0] && !spec->force[1] && !spec->force[2]);
  const ForestTables *t = ForestGetTables(run->level->forest);
  if (FacesRigid_Private(run, t, body)) *held = PETSC_FALSE;
  if (m->model == MODEL_AXISYMMETRIC) value[0] = "0";
  for (PetscInt i = 0; i < m->num_boundaries && *held; ++i) {
    const BoundarySpec *b = &m->boundaries[i];
    if (!Touches_Private(t, body, b->group)) continue;
    if (b->rotation || b->fix_normal || BoundaryHasPressure(b) || BoundaryHasTraction(b) || b->amplitude.num) *held = PETSC_FALSE;
    for (PetscInt c = 0; c < dim; ++c) {
      const char *here = b->fix[c] ? "0" : b->displacement[c] ? ExpressionText(b->displacement[c]) : NULL;
      if (!here) continue;
      if (b->displacement[c] && ExpressionUsesPlace(b->displacement[c])) *held = PETSC_FALSE;
      if (value[c] && strcmp(value[c], here)) *held = PETSC_FALSE;
      value[c] = here;
    }
  }
  for (PetscInt c = 0; c < dim; ++c) {
    const char axis[] = {(char)('x' + c), 0};
    if (!value[c]) *held = PETSC_FALSE;
    if (value[c] && strcmp(value[c], "0")) cJSON_AddStringToObject(*motion, axis, value[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Middle of the box around a body's facets of a group; any: it has some. Every rank knows all facets. */
static PetscErrorCode Facets_Private(const NeedsRun *run, PetscInt body, PetscInt group, PetscReal at[3], PetscBool *any)
{
  PetscReal box[6]; /* largest of X, of -X */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 6; ++k) box[k] = -PETSC_MAX_REAL;
  const ForestTables *t = ForestGetTables(run->level->forest);
  for (PetscInt e = t->first[t->dim - 1]; e < t->first[t->dim]; ++e) {
    PetscReal X[3];
    if (!(t->boundary[e] >> group & 1) || t->leaf_body[t->entity_leaf[e]] != body) continue;
    PetscCall(NeedsMiddle(run->level->forest, t, t->entity_leaf[e], e, X));
    for (PetscInt k = 0; k < 6; ++k) box[k] = PetscMax(box[k], k < 3 ? X[k] : -X[k - 3]);
  }
  *any = (PetscBool)(box[0] > -PETSC_MAX_REAL);
  for (PetscInt c = 0; c < 3; ++c) at[c] = 0.5 * (box[c] - box[c + 3]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscReal at[3];
  PetscBool holds[3];
} Hold;

/* Supports of a body, then zones of contact pairs on it. */
static PetscErrorCode Holds_Private(const NeedsRun *run, PetscInt body, PetscInt *num, Hold place[])
{
  const SceneData *data = run->data;

  PetscFunctionBegin;
  *num = 0;
  for (PetscInt i = 0; i < data->mechanics.num_boundaries; ++i) {
    const BoundarySpec *b = &data->mechanics.boundaries[i];
    Hold               *p = &place[*num];
    PetscBool           any;
    for (PetscInt c = 0; c < 3; ++c) p->holds[c] = (PetscBool)(b->fix[c] || b->fix_normal || b->displacement[c]);
    PetscCall(Facets_Private(run, body, b->group, p->at, &any));
    *num += any;
  }
  for (PetscInt i = 0; i < 2 * data->num_contacts; ++i) {
    const ContactView *v;
    PetscReal          sum[11] = {0};
    Hold              *p       = &place[*num];
    PetscBool          any;
    v = InterfaceGetContact(ProblemInterface(run->level->problem), i / 2);
    Side_Private(i % 2 ? &v->mortar : &v->nonmortar, sum);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 11, MPIU_REAL, MPI_SUM, run->comm));
    PetscCall(Facets_Private(run, body, i % 2 ? data->contacts[i / 2].mortar : data->contacts[i / 2].nonmortar, p->at, &any));
    for (PetscInt c = 0; c < 3; ++c) {
      p->holds[c] = PETSC_TRUE;
      p->at[c]    = sum[4 + c] / sum[0];
    }
    *num += any && sum[0] > 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NeedsStretch(const NeedsRun *run, PetscInt body, PetscReal *strain)
{
  Hold    *place;
  PetscInt num;

  PetscFunctionBegin;
  *strain = 0;
  PetscCall(PetscMalloc1(run->data->mechanics.num_boundaries + 2 * run->data->num_contacts, &place));
  PetscCall(Holds_Private(run, body, &num, place));
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt j = 0; j < i; ++j) {
      const PetscReal d[3] = {place[i].at[0] - place[j].at[0], place[i].at[1] - place[j].at[1], place[i].at[2] - place[j].at[2]}, d2 = Dot3(d, d);
      for (PetscInt c = 0; c < 3 && d2 > 0; ++c)
        if (place[i].holds[c] && place[j].holds[c]) *strain = PetscMax(*strain, PetscAbsReal(d[c]) / d2);
    }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- symmetry --------------------------------------------------------------------------------------------------------------------------- */

PetscErrorCode NeedsAsymmetry(const NeedsRun *run, PetscInt axis, PetscReal *off)
{
  const PetscReal   at   = run->mirror_at[axis];
  const CoarseMesh *mesh = ForestGetCoarse(run->level->forest);
  PetscReal         lo[3], hi[3], most = 0, largest;
  PetscInt          num;
  Place            *corner;

  PetscFunctionBegin;
  const PetscReal size = NeedsSize(mesh, lo, hi);
  PetscCall(NeedsCorners(run, axis, &at, &num, &corner, &largest));
  for (PetscInt i = 0, first = 0; i < num; ++i) {
    const PetscInt last = PlacesLike(num, corner, i, size, &first);
    PetscReal      best = PETSC_MAX_REAL; /* where bodies touch corners of several lie in one place */
    for (PetscInt j = first; j < last; ++j) {
      PetscReal here = 0;
      if (!PlaceIs(&corner[i], &corner[j], axis, at, -1, size)) continue;
      for (PetscInt d = 0; d < 3; ++d) here = PetscMax(here, PetscAbsReal((d == axis ? -1 : 1) * corner[i].u[d] - corner[j].u[d]));
      best = PetscMin(best, here);
    }
    if (best < PETSC_MAX_REAL) most = PetscMax(most, best);
  }
  *off = largest > 0 ? most / largest : 0;
  PetscCall(PetscFree(corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
