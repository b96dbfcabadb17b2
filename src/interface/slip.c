/* Slip of a step, for laws with friction. Points of the pair are kept where the state was accepted last (ContactPairKeepPoints); how far they have moved along
   the surface since then is a function of the positions alone (docs/theory.md, 5). Each rank keeps the points of the nonmortar facets that it evaluates, and
   links of their own bring it the positions of their partners, wherever those have gone. */
#include "interfaceimpl.h"

/* Planes of symmetry of a node in which the other side ends, too; the first one's normal. Where it does not, as under a body in a guide, it is one of this body
   alone, and what faces the node moves across it. */
static PetscInt SharedPlanes_Private(const Contact *c, PetscInt n, PetscReal normal[3])
{
  const Surface *s = &c->side[0], *m = &c->side[1];
  const PetscInt dim = s->dim, planes = dim - 1;
  PetscInt       num = 0;

  for (PetscInt k = 0; k < planes; ++k) {
    const PetscReal *d      = s->mirror + dim * (planes * n + k);
    PetscBool        shared = PETSC_FALSE;
    if (d[0] == 0 && d[1] == 0 && d[dim - 1] == 0) continue; /* no plane */
    for (PetscInt j = 0; j < planes * m->num_nodes && !shared; ++j) {
      PetscReal cosine = 0, off = 0, distance2 = 0;
      for (PetscInt i = 0; i < dim; ++i) {
        const PetscReal way = m->X[dim * (j / planes) + i] - s->X[dim * n + i];
        cosine += d[i] * m->mirror[dim * j + i];
        off += d[i] * way;
        distance2 += PetscSqr(way);
      }
      shared = (PetscBool)(PetscAbsReal(cosine) > 1 - ROUND_LENGTH && PetscSqr(off) <= PetscSqr(ROUND_LENGTH) * distance2);
    }
    for (PetscInt i = 0; i < dim && shared && num == 0; ++i) normal[i] = d[i];
    num += shared;
  }
  return num;
}

/* Axes along the surface in which supports hold a node, those across a plane of symmetry first (law/coulomb.c). Nodes of rigid bodies are not held: the other
   side moves. */
static void Held_Private(Interface p, Contact *c)
{
  const Surface      *s = &c->side[0];
  const ForestTables *t = ForestGetTables(p->forest);

  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal axis[3] = {0, 0, 0}, normal[3];
    PetscInt  num     = 0;

    if (s->hang[n] < s->hang[n + 1]) continue; /* it has no facets, and its masters' tractions */
    const PetscBool rigid = p->spec->bodies[t->leaf_body[s->facet_leaf[s->node_facet[s->node_first[n]]]]].material->law->rigid;
    if (!rigid) num = ContactHeldAxes_Private(s, n, axis);
    const PetscInt planes = num ? PetscMin(num, SharedPlanes_Private(c, n, normal)) : 0;
    c->slip->held[n]      = num;
    c->slip->plane[n]     = planes;
    for (PetscInt i = 0; i < 3 && p->dim == 3 && (num == 1 || planes == 1); ++i) c->slip->axis[3 * n + i] = num == 1 ? axis[i] : normal[i];
  }
}

PetscErrorCode SlipCreate_Private(Interface p, Contact *c)
{
  const PetscInt n = c->side[0].num_nodes, m = p->dim - 1, num_facets = c->side[0].num_facets;
  SlipHistory   *s;

  PetscFunctionBegin;
  if (!c->law->slips) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(p->space);
  PetscCall(PetscNew(&s));
  s->size = p->dim * v->num_nodes;
  PetscCall(PetscCalloc7(m * n, &s->slip, n, &s->weight, m * n, &s->mean, m * n, &s->change, m * n, &s->lift, num_facets, &s->result, s->size, &s->from));
  PetscCall(PetscCalloc4(3 * n, &s->aim, 3 * n, &s->axis, m * n, &s->q, m * n, &s->coupled));
  for (PetscInt f = 0; f < num_facets; ++f) s->result[f] = -1;
  s->stale     = PETSC_TRUE;
  c->slip      = s;
  c->view.slip = s->mean;
  PetscCall(PetscCalloc2(n, &s->held, n, &s->plane));
  Held_Private(p, c);
  ContactPairSetTraction(c->pair, c->z + n);
  ContactPairSetAxes(c->pair, s->axis);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlipDestroy_Private(Contact *c)
{
  SlipHistory *s = c->slip;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree7(s->slip, s->weight, s->mean, s->change, s->lift, s->result, s->from));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(LinkDestroy_Private(&s->places[k]));
  PetscCall(PetscFree4(s->aim, s->axis, s->q, s->coupled));
  PetscCall(PetscFree2(s->held, s->plane));
  PetscCall(PetscFree(c->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tractions of this rank's nodes that count from now on. */
static void KeepTractions_Private(Interface p, Contact *c, const PetscReal z[])
{
  const Surface *s = &c->side[0];

  for (PetscInt i = 0; i < (p->dim - 1) * s->num_own; ++i) {
    const PetscInt j = s->own[i % s->num_own], d = i / s->num_own;

    c->slip->q[s->num_nodes * d + j] = c->zlocal[j] >= 0 ? z[c->zlocal[j] - p->first_z + 1 + d] : 0;
  }
}

PetscErrorCode InterfaceSetSlipOrigin(Interface p, const PetscReal u[], const PetscReal z[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    SlipHistory *s = p->contacts[i].slip;

    if (!s) continue;
    if (memcmp(s->from, u, (size_t)s->size * sizeof(PetscReal))) s->stale = PETSC_TRUE;
    PetscCall(PetscArraycpy(s->from, u, s->size));
    KeepTractions_Private(p, &p->contacts[i], z);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool InterfaceSlips(Interface p)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i)
    if (p->contacts[i].slip) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What tractions q[dim - 1][n] add to the slips of this rank's nodes by compliance. */
void SlipCoupling_Private(const Contact *c, const PetscReal q[], PetscReal coupled[])
{
  const SlipHistory *s = c->slip;
  const PetscInt     n = c->side[0].num_nodes, m = c->side[0].dim - 1;

  for (PetscInt i = 0; i < m * n; ++i) coupled[i] = 0;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const ContactFacet *e  = &s->facets[f];
    const PetscInt      nr = e->num_rows, size = m * nr;

    for (PetscInt i = 0; i < size * size && e->micro; ++i) {
      const PetscInt row = i / size, column = i % size, j = e->nodes[row % nr], at = n * (column / nr) + e->nodes[column % nr];

      if (c->side[0].owned[j]) coupled[n * (row / nr) + j] += e->micro[i] * (q[at] - s->q[at]);
    }
  }
}

PetscErrorCode SlipKeep_Private(Interface p, Contact *c)
{
  SlipHistory *s = c->slip;
  PetscBool    failed;
  int          stale = s && s->stale;

  PetscFunctionBegin;
  if (!c->law->slips) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &stale, 1, MPI_INT, MPI_MAX, p->comm));
  if (!stale) PetscFunctionReturn(PETSC_SUCCESS);
  s->stale = PETSC_FALSE;
  if (p->spec->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS); /* points are kept once (SlipFreeze_Private) */
  for (PetscInt k = 0; k < 2; ++k) {
    SurfaceForget_Private(&c->side[k]);
    SurfacePlace_Private(&c->side[k], s->from, ContactBase_Private(c, k), c->side[k].x);
  }
  PetscCall(ContactSearch_Private(p, c, PETSC_FALSE, 0));
  for (PetscInt k = 0; k < 2; ++k) {
    PetscCall(SurfaceGather_Private(p, &c->side[k], s->from, ContactBase_Private(c, k), c->side[k].x));
    PetscCall(LinkSet_Private(p, &c->side[k], c->side[k].places.num, c->side[k].places.nodes, &s->places[k]));
  }
  const ContactSurface side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].x), SurfaceAt_Private(&c->side[1], c->side[1].x)};
  PetscCall(ContactPairKeepPoints(c->pair, &side[0], &side[1], &failed));
  s->num_facets = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlipFreeze_Private(Interface p, Contact *c, PetscBool *failed)
{
  const ContactSurface side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  SlipHistory         *s       = c->slip;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; ++k) PetscCall(LinkSet_Private(p, &c->side[k], c->side[k].places.num, c->side[k].places.nodes, &s->places[k]));
  PetscCall(ContactPairKeepPoints(c->pair, &side[0], &side[1], failed));
  PetscCall(ContactPairSlip(c->pair, &side[0], &side[1], NULL, &s->num_facets, &s->facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Increments since the state that slip counts from, of both sides, by which slip is linear where facets are frozen. */
static PetscErrorCode Since_Private(Interface p, Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    PetscCall(SurfaceGather_Private(p, s, c->slip->from, s->X, s->du));
    PetscCall(LinkSpread_Private(p, &c->slip->places[k], p->dim, s->du));
    for (PetscInt i = 0; i < p->dim * s->num_nodes; ++i) s->du[i] = s->x[i] - s->du[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlipEvaluate_Private(Interface p, Contact *c)
{
  const Surface *own = &c->side[0];
  const PetscInt n = own->num_nodes, m = p->dim - 1;
  SlipHistory   *s = c->slip;
  ContactSurface side[2], from[2];

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; ++k) {
    PetscCall(LinkSpread_Private(p, &s->places[k], p->dim, c->side[k].x));
    side[k] = SurfaceAt_Private(&c->side[k], c->side[k].x);
  }
  if (c->mean0) { /* small kinematics */
    PetscCall(Since_Private(p, c));
  } else {
    for (PetscInt k = 0; k < 2; ++k) {
      PetscCall(SurfaceGather_Private(p, &c->side[k], s->from, ContactBase_Private(c, k), c->side[k].du));
      from[k] = SurfaceAt_Private(&c->side[k], c->side[k].du);
    }
    PetscCall(ContactPairSlip(c->pair, &side[0], &side[1], from, &s->num_facets, &s->facets));
  }
  for (PetscInt f = 0; f < own->num_facets; ++f) s->result[f] = -1;
  PetscCall(PetscArrayzero(s->slip, m * n));
  PetscCall(PetscArrayzero(s->weight, n));
  for (PetscInt i = 0; i < s->num_facets; ++i) {
    const ContactFacet *e = &s->facets[i];

    s->result[e->facet] = i;
    for (PetscInt k = 0; k < e->num_rows; ++k) {
      for (PetscInt d = 0; d < m; ++d) {
        const PetscInt row = e->num_rows * d + k;
        s->slip[n * d + e->nodes[k]] += c->mean0 ? ContactFacetDot_Private(c, e, e->dgap + p->dim * row * e->num) : e->gap[row];
      }
      s->weight[e->nodes[k]] += e->weight[k];
    }
  }
  for (PetscInt d = 0; d < m; ++d) PetscCall(LinkSpread_Private(p, &own->values, 1, s->q + n * d)); /* who uses them changes with the search */
  SlipCoupling_Private(c, c->z + n, s->coupled);
  for (PetscInt i = 0; i < m * n; ++i) s->slip[i] += s->coupled[i];
  for (PetscInt d = 0; d < m; ++d) PetscCall(LinkSpread_Private(p, &own->values, 1, s->slip + n * d));
  PetscCall(LinkSpread_Private(p, &own->values, 1, s->weight));
  for (PetscInt j = 0; j < own->num_nodes; ++j)
    if (!(s->weight[j] > CONTACT_ROUND * c->w0[j])) s->slip[j] = s->slip[n * (m - 1) + j] = s->weight[j] = 0; /* no partner then */
  for (PetscInt j = 0; j < m * n; ++j) s->mean[j] = s->weight[j % n] > 0 ? s->slip[j] / s->weight[j % n] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlipChange_Private(Interface p, Contact *c, PetscReal change[])
{
  SlipHistory *s = c->slip;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; ++k) PetscCall(LinkSpread_Private(p, &s->places[k], p->dim, c->side[k].du));
  PetscCall(PetscArrayzero(change, (p->dim - 1) * c->side[0].num_nodes));
  for (PetscInt i = 0; i < s->num_facets; ++i) {
    const ContactFacet *e = &s->facets[i];

    for (PetscInt k = 0; k < (p->dim - 1) * e->num_rows; ++k) {
      const PetscInt j = e->nodes[k % e->num_rows];
      if (c->side[0].owned[j]) change[c->side[0].num_nodes * (k / e->num_rows) + j] += ContactFacetDot_Private(c, e, e->dgap + p->dim * k * e->num);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceGetSlipPoints(Interface p, PetscInt pair, PetscInt *num, ContactSlipPoint **points)
{
  Contact       *c = &p->contacts[pair];
  ContactSurface side[2], increment[2];

  PetscFunctionBegin;
  *num    = 0;
  *points = NULL;
  if (!c->slip) PetscFunctionReturn(PETSC_SUCCESS);
  if (c->mean0) PetscCall(Since_Private(p, c));
  for (PetscInt k = 0; k < 2; ++k) {
    side[k]      = SurfaceAt_Private(&c->side[k], c->mean0 ? c->side[k].X : c->side[k].x);
    increment[k] = SurfaceAt_Private(&c->side[k], c->side[k].du);
  }
  PetscCall(ContactPairSlipPoints(c->pair, side, c->mean0 ? increment : NULL, num, points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFriction(Interface p, PetscInt pair, FrictionFigures *f)
{
  const Contact *c      = &p->contacts[pair];
  PetscReal      sum[3] = {0, 0, 0}, most = 0;

  PetscFunctionBegin;
  *f = (FrictionFigures){0};
  if (!c->slip) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i], n = c->side[0].num_nodes;
    PetscReal      square = 0;

    if (!c->has_multiplier[j] || !c->active[j]) continue;
    for (PetscInt d = 0; d < p->dim - 1; ++d) {
      sum[0] -= c->z[n * (1 + d) + j] * c->slip->mean[n * d + j] * c->weight[j];
      square += PetscSqr(c->slip->mean[n * d + j]);
    }
    if (c->slip->weight[j] == 0) continue;
    /* nodes that rest after a slide stay at the bound, and slip by round-off */
    sum[c->view.friction == 0 || (c->law->slides(c->active[j]) && square > PetscSqr(ROUND_LENGTH * c->extent[j])) ? 2 : 1] += 1;
    most = PetscMax(most, PetscSqrtReal(square));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, p->comm));
  *f = (FrictionFigures){sum[0], most, (PetscInt)sum[1], (PetscInt)sum[2]};
  PetscFunctionReturn(PETSC_SUCCESS);
}
