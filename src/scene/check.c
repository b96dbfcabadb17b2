/* The scene against its mesh: names of groups, every cell in a body, every body held, contact pairs of two surfaces. */
#include "rim.h"

/* Times the modulus of the other side: then nothing of a body's own makes each of many constraints at a corner, in space round an edge, felt. */
#define AS_RIGID 10
#define LONGER 2 /* times the other side's facets: as nonmortar ones they miss what its nodes do between */

/* What one pass over the facets of the mesh finds. */
typedef struct {
  Forest              whole;
  const CoarseMesh   *mesh;
  const ForestTables *forest;
  PetscInt           *num_facets;   /* [num_boundaries] outer facets of each group */
  PetscBool          *inner;        /* [num_boundaries] some facet of the group lies between two cells */
  PetscBool          *body_touches; /* [num_bodies][num_boundaries] the group has a facet of the body */
  uint64_t           *together;     /* [num_boundaries] groups that have an outer facet of the group too */
  uint64_t           *cell_groups;  /* [num_cells] groups of the outer facets of each coarse cell */
} Facets;

static PetscErrorCode FacetsCreate_Private(Forest forest, Facets *f)
{
  const ForestTables *t;
  PetscInt            nb;

  PetscFunctionBegin;
  f->mesh   = ForestGetCoarse(forest);
  f->forest = ForestGetTables(forest);
  f->whole  = forest;
  t         = f->forest;
  nb        = f->mesh->num_boundaries;
  PetscCall(PetscCalloc5(nb, &f->num_facets, nb, &f->inner, f->mesh->num_bodies * nb, &f->body_touches, nb, &f->together, f->mesh->num_cells, &f->cell_groups));
  for (PetscInt e = t->first[t->dim - 1]; e < t->first[t->dim]; ++e) {
    const PetscInt *leaf  = t->facet_leaf + 2 * (e - t->first[t->dim - 1]);
    const PetscBool outer = leaf[0] < 0 || leaf[1] < 0 ? PETSC_TRUE : PETSC_FALSE;
    if (!t->boundary[e]) continue;
    for (PetscInt g = 0; g < nb; ++g) {
      if (!(t->boundary[e] >> g & 1)) continue;
      f->num_facets[g] += outer;
      if (!outer) f->inner[g] = PETSC_TRUE;
      if (outer) f->together[g] |= t->boundary[e];
      for (int side = 0; side < 2; ++side)
        if (leaf[side] >= 0) f->body_touches[t->leaf_body[leaf[side]] * nb + g] = PETSC_TRUE;
    }
    for (int side = 0; side < 2; ++side)
      if (leaf[side] >= 0) f->cell_groups[t->leaf_root[leaf[side]]] |= t->boundary[e];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Index_Private(const char *name, PetscInt num, char (*names)[MORTISE_NAME])
{
  for (PetscInt i = 0; i < num; ++i)
    if (!strcmp(name, names[i])) return i;
  return -1;
}

PetscErrorCode SceneListNames(PetscInt num, char (*names)[MORTISE_NAME], size_t capacity, char list[])
{
  PetscFunctionBegin;
  PetscCall(PetscStrncpy(list, num ? "" : "none", capacity));
  for (PetscInt i = 0; i < num; ++i) {
    if (i) TextAppend(capacity, list, ", ");
    TextAppend(capacity, list, names[i]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindGroup_Private(const CoarseMesh *m, const char *where, const char *name, PetscInt *group)
{
  char list[2048];

  PetscFunctionBegin;
  *group = Index_Private(name, m->num_boundaries - m->num_unions, m->boundary_name);
  if (*group >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneListNames(m->num_boundaries - m->num_unions, m->boundary_name, sizeof(list), list));
  PetscCheckInput(Index_Private(name, m->num_bodies, m->body_name) < 0, "%s: '%s' is a body of the mesh, not one of its boundary groups: %s", where, name,
                  list);
  PetscCall(ErrorInput("%s: the mesh has no boundary group '%s'; it has: %s", where, name, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneVertex(Forest forest, PetscInt vertex, PetscReal X[3])
{
  const ForestTables *t = ForestGetTables(forest);

  PetscFunctionBegin;
  const PetscInt  leaf = t->entity_leaf[vertex];
  const PetscInt *at   = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  PetscInt        i    = 0;
  while (at[i] != vertex) ++i;
  const PetscReal xi[3] = {0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9)};
  PetscCall(ForestMapPoint(forest, leaf, xi, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- bodies ------------------------------------------------------------------------------------------------------------------------- */

/* Mean of the geometry nodes of a coarse cell. */
static void Centre_Private(const CoarseMesh *m, PetscInt cell, PetscReal centre[3])
{
  PetscInt nodes = 1;

  for (PetscInt d = 0; d < m->dim; ++d) nodes *= m->geometry_order + 1;
  for (PetscInt i = 0; i < 3; ++i) centre[i] = 0;
  for (PetscInt i = 0; i < 3 * nodes; ++i) centre[i % 3] += m->cell_geometry[3 * nodes * cell + i] / nodes;
}

static PetscErrorCode CheckCells_Private(Scene s, const CoarseMesh *m)
{
  PetscInt nodes = 1;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < m->dim; ++d) nodes *= m->geometry_order + 1;
  for (PetscInt c = 0; c < m->num_cells; ++c) {
    const PetscReal *X = m->cell_geometry + 3 * nodes * c;
    PetscReal        centre[3], scale = 0;
    Centre_Private(m, c, centre);
    for (PetscInt i = 0; i < 3 * nodes; ++i) scale = PetscMax(scale, PetscAbsReal(X[i]));
    PetscCheckInput(m->cell_body[c] >= 0, "mesh: cell %d at (%g, %g, %g) is in no physical group of dimension %d, so in no body", (int)c, (double)centre[0],
                    (double)centre[1], (double)centre[2], (int)m->dim);
    for (PetscInt i = 0; i < nodes; ++i) {
      PetscCheckInput(s->data.mechanics.model != MODEL_AXISYMMETRIC || X[3 * i] >= -1e-8 * scale,
                      "model is axisymmetric, but cell %d of the mesh at (%g, %g) reaches radius x = %g < 0", (int)c, (double)centre[0], (double)centre[1],
                      (double)X[3 * i]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the mesh adapts, sides of a body that deforms come to lie on its curves. Those of a rigid one follow them at once, at no cost: vertices between chords
   would press into fine cells of the other side as corners that nobody drew. On a fixed mesh chords face chords, whose errors cancel where surfaces fit into
   each other. */
static void CurveRigid_Private(Scene s, const BodyEntry *b, const CoarseMesh *m, BodySpec *body)
{
  if (s->data.adapt.tolerance > 0 && body->material->law->rigid && !NodeFind(b->node, "order")) body->order = PetscMax(body->order, m->geometry_order);
}

static PetscErrorCode MatchBodies_Private(Scene s, const CoarseMesh *m)
{
  char list[2048];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(m->num_bodies, &s->data.bodies));
  PetscCall(SceneListNames(m->num_bodies, m->body_name, sizeof(list), list));
  for (PetscInt i = 0; i < s->num_bodies; ++i) {
    const BodyEntry *b     = &s->body[i];
    PetscInt         index = Index_Private(b->spec.name, m->num_bodies, m->body_name);
    PetscCheckInput(index >= 0, "%s: the mesh has no physical group '%s' of dimension %d; it has: %s", NodeWhere(b->node), b->spec.name, (int)m->dim, list);
    s->data.bodies[index] = b->spec;
    CurveRigid_Private(s, b, m, &s->data.bodies[index]);
    PetscCheckInput(s->data.adapt.strategy == ADAPT_H || b->spec.order <= s->data.adapt.max_order,
                    "%s is %d, but body '%s' has order %d from the start; allowed: %d to %d", NodeWhere(NodeFind(NodeFind(s->root, "adapt"), "max_order")),
                    (int)s->data.adapt.max_order, b->spec.name, (int)b->spec.order, (int)b->spec.order, MORTISE_MAX_ORDER);
  }
  for (PetscInt i = 0; i < m->num_bodies; ++i)
    PetscCheckInput(s->data.bodies[i].material, "%s: body '%s' of the mesh has no material; add body: {%s: {material: ...}}", s->root->origin, m->body_name[i],
                    m->body_name[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- boundaries, pairs, supports ------------------------------------------------------------------------------------------------------ */

static PetscErrorCode MatchBoundaries_Private(Scene s, const Facets *f)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->num_boundaries, &s->data.boundaries));
  for (PetscInt i = 0; i < s->num_boundaries; ++i) {
    BoundaryEntry *b = &s->boundary[i];
    PetscCall(FindGroup_Private(f->mesh, NodeWhere(b->node), b->spec.name, &b->spec.group));
    PetscCheckInput(f->num_facets[b->spec.group] || f->inner[b->spec.group], "%s: no facet of a cell is in group '%s' of the mesh", NodeWhere(b->node),
                    b->spec.name);
    PetscCheckInput(!BoundaryHasPressure(&b->spec) || !f->inner[b->spec.group], "%s.%s: a facet of this group lies between two cells and has no outward normal",
                    NodeWhere(b->node), BoundaryPressureKey(&b->spec));
    PetscCheckInput(!BoundaryHasTraction(&b->spec) || !f->inner[b->spec.group],
                    "%s.traction: a facet of this group lies between two cells, of which each would bear the load; allowed: faces of bodies",
                    NodeWhere(b->node));
    for (PetscInt body = 0; body < f->mesh->num_bodies; ++body) {
      const PetscBool rigid = s->data.bodies[body].material->law->rigid;
      if (!rigid || !f->body_touches[body * f->mesh->num_boundaries + b->spec.group]) continue;
      PetscCheckInput(!BoundaryHasPressure(&b->spec) && !BoundaryHasTraction(&b->spec),
                      "%s.%s: the boundary is one of the rigid body '%s', which forces move by body.%s.load alone", NodeWhere(b->node),
                      BoundaryHasPressure(&b->spec) ? BoundaryPressureKey(&b->spec) : "traction", f->mesh->body_name[body], f->mesh->body_name[body]);
    }
    s->data.boundaries[i] = b->spec;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two facets that face each other in two pairs would have their gap closed twice, by pressures of which only the sum is known. One surface of several pairs is
   good: its facets face others in each. */
static PetscErrorCode CheckPairs_Private(Scene s, const Facets *f)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    const ContactSpec *a = &s->data.contacts[i];
    for (PetscInt j = 0; j < i; ++j) {
      const ContactSpec *b    = &s->data.contacts[j];
      const PetscBool    same = (PetscBool)((f->together[a->nonmortar] >> b->nonmortar & 1) && (f->together[a->mortar] >> b->mortar & 1));
      const PetscBool    swap = (PetscBool)((f->together[a->nonmortar] >> b->mortar & 1) && (f->together[a->mortar] >> b->nonmortar & 1));
      PetscCheckInput(!same && !swap,
                      "%s: '%s' and '%s' have facets in common with the sides of pair '%s', '%s' and '%s'; facets may face each other in one pair only",
                      NodeWhere(s->contact[i].node), s->contact[i].nonmortar, s->contact[i].mortar, b->name,
                      same ? s->contact[j].nonmortar : s->contact[j].mortar, same ? s->contact[j].mortar : s->contact[j].nonmortar);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sides of a pair are apart. */
static PetscErrorCode CheckSides_Private(const ContactEntry *c, const Facets *f, const PetscInt group[2])
{
  const uint64_t  both   = UINT64_C(1) << group[0] | UINT64_C(1) << group[1];
  const PetscBool facets = (PetscBool)(f->together[group[0]] >> group[1] & 1);
  PetscReal       X[3];

  PetscFunctionBegin;
  for (PetscInt cell = 0; cell < f->mesh->num_cells; ++cell) {
    if ((f->cell_groups[cell] & both) != both) continue;
    Centre_Private(f->mesh, cell, X);
    PetscCall(ErrorInput(
        "%s: '%s' and '%s' share cell %d at (%g, %g, %g)%s; the sides of a pair must have cells of their own (one surface that may meet itself is given by one "
        "name, surface)",
        NodeWhere(c->node), c->nonmortar, c->mortar, (int)cell, (double)X[0], (double)X[1], (double)X[2], facets ? ", and have facets in common" : ""));
  }
  for (PetscInt v = 0; v < f->forest->first[1]; ++v) {
    if ((f->forest->boundary[v] & both) != both) continue;
    PetscCall(SceneVertex(f->whole, v, X));
    PetscCall(ErrorInput("%s: '%s' and '%s' share vertex %d of the mesh at (%g, %g, %g); bodies in contact must have vertices of their own (gmsh merges points "
                         "closer than 1e-8 of the model, and those that Extrude makes twice; Geometry.AutoCoherence = 0 keeps them apart)",
                         NodeWhere(c->node), c->nonmortar, c->mortar, (int)v, (double)X[0], (double)X[1], (double)X[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Young's modulus of the softest body that has facets in the group; infinite where all are rigid. */
static PetscReal Stiffness_Private(Scene s, const Facets *f, PetscInt group)
{
  PetscReal least = PETSC_INFINITY;
  for (PetscInt b = 0; b < f->mesh->num_bodies; ++b) {
    const MaterialSpec *m = s->data.bodies[b].material;
    if (f->body_touches[b * f->mesh->num_boundaries + group] && !m->law->rigid) least = PetscMin(least, MaterialYoung(m));
  }
  return least;
}

/* Why the nonmortar side of the scene is better the mortar one by what it is made of, NULL: it is not. Nodes that a support holds have no multiplier. On a
   stiffer side, or one of much longer facets, the constraints are as coarse as its facets while the other side deforms between its nodes; on a rigid one
   nothing of its own makes each of them felt. */
static const char *Plain_Private(const PetscReal stiffness[2], const SideShape side[2])
{
  PetscInt held[2];

  for (PetscInt k = 0; k < 2; ++k) {
    if (stiffness[k] >= PETSC_INFINITY) return k ? NULL : "is rigid";
    held[k] = (side[k].held > 0.5) + (side[k].held == 1);
  }
  if (held[0] != held[1]) return held[0] > held[1] ? "is held by supports" : NULL;
  if (stiffness[0] != stiffness[1]) return stiffness[0] > stiffness[1] ? "is the stiffer one" : NULL;
  return side[0].longest > (LONGER + ROUND_LENGTH) * side[1].longest ? "has facets more than twice as long" : NULL;
}

/* The same with what it looks like. In the plane the side that has corners carries the multiplier: a corner has a node, which is held on a smooth face wherever
   it slides; within a facet of the other side its constraint would be a mean of gaps that grow to both sides, which depends on the place, so that the corner
   rides over bumps. One that is rounded within a facet of the other side is alike, in space too: that facet would wrap round it, unless it is as hollow. Not
   where the corner's facets are longer than all of the other side: what lies between its nodes is held by nothing; nor a sharp one, in space none, of a body
   that is rigid or next to it. *cornered: for its shape. */
static const char *Exchange_Private(const Facets *f, const ContactEntry *c, const PetscReal stiffness[2], const SideShape side[2], PetscBool *cornered)
{
  const char *plain = Plain_Private(stiffness, side), *why = plain;
  PetscBool   corner[2], rounded[2];

  if (c->spec.law == CONTACT_TIED || side[0].held > 0.5 || side[1].held > 0.5) return plain;
  for (PetscInt k = 0; k < 2; ++k) {
    const SideShape *other = &side[!k];
    const PetscBool  stiff = (PetscBool)(stiffness[k] > AS_RIGID * stiffness[!k]);
    corner[k]              = (PetscBool)(!stiff && side[k].corner <= other->longest);
    rounded[k]             = (PetscBool)((f->mesh->dim == 2 || !stiff) && SideShapeRounded(&side[k], acos(CONTACT_SHARP) + other->hollow) <= other->longest);
  }
  if (corner[0] != corner[1])
    why = corner[0] ? NULL : plain ? plain : "has no corner, the other side has,";
  else if (!corner[0] && rounded[0] != rounded[1]) /* a sharp one comes first */
    why = rounded[0] ? NULL : plain ? plain : "has no edge rounded within a facet of the other side, which has,";
  *cornered = (PetscBool)((why != NULL) != (plain != NULL));
  return why;
}

static PetscErrorCode Roles_Private(Scene s, const Facets *f, ContactEntry *c)
{
  const PetscInt group[2] = {c->spec.nonmortar, c->spec.mortar};
  PetscReal      stiffness[2];
  PetscBool      fixed[2]; /* nothing of it moves under a pressure */
  SideShape      side[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) stiffness[k] = Stiffness_Private(s, f, group[k]);
  const PetscBool rigid[2] = {(PetscBool)(stiffness[0] >= PETSC_INFINITY), (PetscBool)(stiffness[1] >= PETSC_INFINITY)};
  PetscCheckInput(!rigid[0] || !rigid[1], "%s: '%s' and '%s' are both sides of rigid bodies; one side of a pair must be of a body that deforms",
                  NodeWhere(c->node), c->nonmortar, c->mortar);
  for (PetscInt k = 0; k < 2; ++k) {
    PetscCall(SideShapeCreate(f->whole, group[k], s->num_boundaries, s->data.boundaries, &side[k]));
    if (rigid[k]) side[k].held = 0; /* its nodes have multipliers */
    fixed[k] = (PetscBool)(rigid[k] || side[k].held == 1);
  }
  PetscCheckInput(c->spec.law == CONTACT_TIED || !fixed[0] || !fixed[1],
                  "%s: supports or rigid bodies hold all of '%s' and of '%s' along their normals; one side of a pair must be free to move under a pressure",
                  NodeWhere(c->node), c->nonmortar, c->mortar);
  const char *why = fixed[0] ? Plain_Private(stiffness, side) : NULL;
  if (c->roles != ROLES_GIVEN) why = Exchange_Private(f, c, stiffness, side, &c->spec.cornered);
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SideShapeDestroy(&side[k]));
  c->spec.given = (PetscBool)(c->roles == ROLES_GIVEN);
  if (s->exchange >> (c - s->contact) & 1) {
    c->spec.cornered = (PetscBool)!c->spec.cornered;
    why              = why ? NULL : c->spec.cornered ? "has no corner that presses, the other side has," : "is the stiffer one";
  }
  const PetscInt nonmortar = why ? 1 : 0;
  c->spec.stiff            = (PetscBool)(stiffness[nonmortar] > AS_RIGID * stiffness[!nonmortar]);
  if (!why) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(s->comm, "note: %s: '%s' %s and becomes the mortar side, '%s' the nonmortar side\n", NodeWhere(c->node), c->nonmortar, why, c->mortar));
  c->spec.exchanged = PETSC_TRUE;
  c->spec.nonmortar = group[1];
  c->spec.mortar    = group[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies on both sides of a tied pair hold each other. */
static PetscErrorCode Joined_Private(Scene s, const Facets *f)
{
  const PetscInt num = f->mesh->num_bodies, groups = f->mesh->num_boundaries;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &s->joined));
  for (PetscInt b = 0; b < num; ++b) s->joined[b] = b;
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    const ContactSpec *c    = &s->data.contacts[i];
    PetscInt           root = -1;
    for (PetscInt b = 0; b < num && c->law == CONTACT_TIED; ++b) {
      if (!f->body_touches[b * groups + c->nonmortar] && !f->body_touches[b * groups + c->mortar]) continue;
      if (root < 0) root = s->joined[b];
      const PetscInt from = s->joined[b];
      for (PetscInt k = 0; k < num; ++k)
        if (s->joined[k] == from) s->joined[k] = root;
    }
  }
  s->data.mechanics.joined = s->joined;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What may meet itself deforms: two facets of rigid bodies have no pressure that keeps them apart. */
static PetscErrorCode CheckSelf_Private(Scene s, const Facets *f, const ContactEntry *c)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < f->mesh->num_bodies; ++b)
    PetscCheckInput(
        !f->body_touches[b * f->mesh->num_boundaries + c->spec.nonmortar] || !s->data.bodies[b].material->law->rigid,
        "%s is '%s', with facets of the rigid body '%s'; a surface that may meet itself is of bodies that deform, a rigid one is the side of a pair",
        NodeWhere(NodeFind(c->node, "surface")), c->surface, f->mesh->body_name[b]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The group that a side of a pair names, or is made of. */
static PetscErrorCode FindSide_Private(Forest forest, const CoarseMesh *m, const SceneNode *node, PetscInt *group)
{
  uint64_t groups = 0;

  PetscFunctionBegin;
  if (node->kind == NODE_SCALAR) PetscCall(FindGroup_Private(m, NodeWhere(node), node->text, group));
  for (const SceneNode *item = node->first; item; item = item->next) {
    PetscCall(FindGroup_Private(m, NodeWhere(node), item->text, group));
    groups |= UINT64_C(1) << *group;
  }
  if (groups) PetscCall(ForestUnite(forest, groups, group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sides of pairs: before anything is counted by groups. */
static PetscErrorCode FindSides_Private(Scene s, Forest forest, const CoarseMesh *m)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_contacts; ++i) {
    ContactEntry *c = &s->contact[i];
    PetscCall(FindSide_Private(forest, m, NodeFind(c->node, c->spec.self ? "surface" : "nonmortar"), &c->spec.nonmortar));
    PetscCall(FindSide_Private(forest, m, NodeFind(c->node, c->spec.self ? "surface" : "mortar"), &c->spec.mortar));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each group of the side is of free facets. */
static PetscErrorCode CheckFree_Private(const ContactEntry *c, const Facets *f, PetscInt side)
{
  const uint64_t groups = CoarseMembers(f->mesh, side);

  PetscFunctionBegin;
  for (PetscInt g = 0; g < f->mesh->num_boundaries; ++g) {
    if (!(groups >> g & 1)) continue;
    PetscCheckInput(!f->inner[g], "%s: '%s' lies between two cells; a contact surface must be a free one", NodeWhere(c->node), f->mesh->boundary_name[g]);
    PetscCheckInput(f->num_facets[g], "%s: no facet of a cell is in group '%s' of the mesh", NodeWhere(c->node), f->mesh->boundary_name[g]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MatchContacts_Private(Scene s, const Facets *f)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->data.num_contacts, &s->data.contacts));
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    ContactEntry  *c        = &s->contact[i];
    const PetscInt group[2] = {c->spec.nonmortar, c->spec.mortar};
    for (int side = 0; side < 2; ++side) PetscCall(CheckFree_Private(c, f, group[side]));
    PetscCall(c->spec.self ? CheckSelf_Private(s, f, c) : CheckSides_Private(c, f, group));
    if (!c->spec.self) PetscCall(Roles_Private(s, f, c));
    s->data.contacts[i] = c->spec;
  }
  PetscCall(CheckPairs_Private(s, f));
  PetscCall(Joined_Private(s, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MatchRefines_Private(Scene s, const Facets *f)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->data.num_refines, &s->data.refines));
  for (PetscInt i = 0; i < s->data.num_refines; ++i) {
    RefineEntry *r = &s->refine[i];
    if (r->boundary[0]) PetscCall(FindGroup_Private(f->mesh, NodeWhere(NodeFind(r->node, "boundary")), r->boundary, &r->spec.group));
    s->data.refines[i] = r->spec;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a displacement condition, a contact pair or its own rigidity hold the body by itself? */
static PetscBool HoldsItself_Private(Scene s, const PetscBool *touches, PetscInt body)
{
  for (PetscInt i = 0; i < s->num_boundaries; ++i) {
    const BoundarySpec *b = &s->data.boundaries[i];
    if (!touches[b->group]) continue;
    if (b->rotation || b->fix_normal) return PETSC_TRUE;
    for (int c = 0; c < 3; ++c)
      if (b->fix[c] || b->displacement[c]) return PETSC_TRUE;
  }
  for (PetscInt i = 0; i < s->data.num_contacts; ++i)
    if (s->data.contacts[i].law != CONTACT_TIED && (touches[s->data.contacts[i].nonmortar] || touches[s->data.contacts[i].mortar])) return PETSC_TRUE;
  return s->data.bodies[body].material->law->rigid;
}

/* A body must be held by a condition of its own, or grow together with one that is, or be tied to it. */
static PetscErrorCode CheckHeld_Private(Scene s, const Facets *f)
{
  const ForestTables *t   = f->forest;
  const PetscInt      num = f->mesh->num_bodies;
  PetscBool          *held, changed = PETSC_TRUE;
  PetscInt            loose = -1;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &held));
  for (PetscInt body = 0; body < num; ++body) held[body] = HoldsItself_Private(s, f->body_touches + body * f->mesh->num_boundaries, body);
  while (changed) {
    changed = PETSC_FALSE;
    for (PetscInt e = 0; e < t->first[t->dim] - t->first[t->dim - 1]; ++e) {
      const PetscInt *leaf = t->facet_leaf + 2 * e;
      if (leaf[0] < 0 || leaf[1] < 0 || held[t->leaf_body[leaf[0]]] == held[t->leaf_body[leaf[1]]]) continue;
      held[t->leaf_body[leaf[0]]] = held[t->leaf_body[leaf[1]]] = changed = PETSC_TRUE;
    }
    for (PetscInt a = 0; a < num; ++a)
      for (PetscInt b = 0; b < a; ++b)
        if (s->joined[a] == s->joined[b] && held[a] != held[b]) held[a] = held[b] = changed = PETSC_TRUE;
  }
  for (PetscInt body = num - 1; body >= 0; --body)
    if (!held[body]) loose = body;
  PetscCall(PetscFree(held));
  PetscCheckInput(loose < 0, "%s: nothing holds body '%s': none of its boundary groups has fix, displacement or rotation, and it is in no contact pair",
                  s->root->origin, f->mesh->body_name[loose]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define FARTHEST 1e10 /* of shear moduli from each other: beyond, round-off of stresses in the stiff body is as large as the forces of the soft one */

static PetscErrorCode CheckStiffness_Private(Scene s, PetscInt num)
{
  const MaterialSpec *least = NULL, *most = NULL;

  PetscFunctionBegin;
  for (PetscInt body = 0; body < num; ++body) {
    const MaterialSpec *m = s->data.bodies[body].material;
    if (m->law->rigid) continue;
    if (!least || m->mu < least->mu) least = m;
    if (!most || m->mu > most->mu) most = m;
  }
  PetscCheckInput(
      !most || most->mu <= FARTHEST * least->mu,
      "material.%s: its shear modulus %g is more than 1e10 times that of material %s, %g, whose forces are less than its round-off; take law: rigid",
      most->name, (double)most->mu, least->name, (double)least->mu);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body that has a vertex of this one, if only one that it is hinged to, -1: none. */
static PetscErrorCode Sharing_Private(const CoarseMesh *m, PetscInt body, PetscInt *other)
{
  PetscBool *mine;

  PetscFunctionBegin;
  *other = -1;
  PetscCall(PetscCalloc1(m->num_vertices, &mine));
  for (PetscInt i = 0; i < m->num_cells << m->dim; ++i)
    if (m->cell_body[i >> m->dim] == body) mine[m->cell_vertices[i]] = PETSC_TRUE;
  for (PetscInt i = 0; i < m->num_cells << m->dim && *other < 0; ++i)
    if (m->cell_body[i >> m->dim] != body && mine[m->cell_vertices[i]]) *other = m->cell_body[i >> m->dim];
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A rigid body that forces move: contact alone meets it. */
static PetscErrorCode CheckLoaded_Private(Scene s, const Facets *f)
{
  const PetscInt nb = f->mesh->num_boundaries;

  PetscFunctionBegin;
  for (PetscInt body = 0; body < f->mesh->num_bodies; ++body) {
    const BodySpec *b   = &s->data.bodies[body];
    PetscBool       any = PETSC_FALSE;
    PetscInt        other;
    if (!BodyIsLoaded(b)) continue;
    for (PetscInt i = 0; i < s->num_boundaries; ++i)
      PetscCheckInput(!f->body_touches[body * nb + s->data.boundaries[i].group] || !BoundarySupports(&s->data.boundaries[i]),
                      "%s holds body '%s', which body.%s.load moves; take one of them away", NodeWhere(s->boundary[i].node), b->name, b->name);
    for (PetscInt i = 0; i < s->data.num_contacts; ++i)
      any = (PetscBool)(any || f->body_touches[body * nb + s->data.contacts[i].nonmortar] || f->body_touches[body * nb + s->data.contacts[i].mortar]);
    PetscCheckInput(any, "body.%s.load: the body is in no contact pair, so that nothing bears its load", b->name);
    PetscCall(Sharing_Private(f->mesh, body, &other));
    PetscCheckInput(other < 0, "body.%s.load: the body is joined to body '%s'; a rigid body with a load must touch others by contact alone", b->name,
                    f->mesh->body_name[other]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A pair for each colour of the mortar side's faces, of a surface that may meet itself of its own. */
static PetscErrorCode PartContacts_Private(Scene s, const Facets *f)
{
  PetscInt    *num, total = 0;
  ContactSpec *parts;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->num_contacts, &s->face));
  PetscCall(PetscMalloc1(s->num_contacts, &num));
  for (PetscInt i = 0; i < s->num_contacts; ++i) {
    const ContactSpec *c = &s->data.contacts[i];
    num[i]               = 1;
    if (c->law != CONTACT_TIED && !c->node_to_segment) PetscCall(SceneColourFaces(f->whole, c->mortar, &num[i], &s->face[i]));
    if (total + num[i] + s->num_contacts - i - 1 > FORM_PAIRS) num[i] = 1;
    total += num[i];
  }
  PetscCall(PetscMalloc1(total, &parts));
  s->data.num_contacts = 0;
  for (PetscInt i = 0; i < s->num_contacts; ++i)
    for (PetscInt k = 0; k < num[i]; ++k) {
      ContactSpec *c = &parts[s->data.num_contacts++];
      *c             = s->data.contacts[i];
      c->pair        = i;
      c->part        = k;
      c->face        = num[i] > 1 ? s->face[i] : NULL;
    }
  PetscCall(PetscFree(s->data.contacts));
  PetscCall(PetscFree(num));
  s->data.contacts = parts;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check_Private(Scene s, const Facets *f)
{
  PetscFunctionBegin;
  PetscCall(MatchBoundaries_Private(s, f));
  PetscCall(MatchContacts_Private(s, f));
  PetscCall(MatchRefines_Private(s, f));
  PetscCall(CheckHeld_Private(s, f));
  PetscCall(CheckLoaded_Private(s, f));
  PetscCall(CheckStiffness_Private(s, f->mesh->num_bodies));
  PetscCall(SceneSetPoints(s, f->mesh, f->body_touches));
  PetscCall(PartContacts_Private(s, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckMesh(Scene s, Forest forest)
{
  const CoarseMesh *mesh = ForestGetCoarse(forest);
  Facets            f;
  PetscErrorCode    status;

  PetscFunctionBegin;
  PetscCall(CheckCells_Private(s, mesh)); /* before any table is indexed by bodies */
  PetscCall(MatchBodies_Private(s, mesh));
  PetscCall(SceneCheckFields(s, mesh));
  PetscCall(FindSides_Private(s, forest, mesh));
  PetscCall(FacetsCreate_Private(forest, &f));
  status = Check_Private(s, &f);
  PetscCall(PetscFree5(f.num_facets, f.inner, f.body_touches, f.together, f.cell_groups));
  PetscCall(status);
  PetscFunctionReturn(PETSC_SUCCESS);
}
