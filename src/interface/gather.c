/* Values of a contact pair beyond those a rank needs: all of them everywhere, for output; chosen ones from those who know them. */
#include "interfaceimpl.h"

#define SIDE_REALS(dim, num) (3 * (dim) + 6 + (num)) /* of a node: position, normal, force, gap, weight, multipliers, slip, tangential traction */

/* Space: the tangential traction on the mortar side at a node whose value is known here; of a node that hangs that between its masters. */
static PetscErrorCode Traction_Private(const Contact *c, PetscInt j, PetscReal traction[3])
{
  const Surface   *s = &c->side[0];
  const PetscReal *weight, *z = c->z;
  const PetscInt  *node, num  = SurfaceRow_Private(s, &j, &node, &weight);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(traction, 3));
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal e[2][3];

    PetscCall(ContactPairGetTangents(c->pair, node[k], e));
    for (PetscInt i = 0; i < 2; ++i) {
      const PetscReal q = weight[k] * z[s->num_nodes * (1 + i) + node[k]];
      for (PetscInt d = 0; d < 3 && q != 0; ++d) traction[d] += q * e[i][d]; /* axes of nodes that see nothing may not be known */
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceResolveTractions(Interface p, PetscInt pair, const PetscReal traction[], PetscReal z[])
{
  const Contact *c = &p->contacts[pair];
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->num_own; ++k) {
    const PetscInt   j = s->own[k];
    const PetscReal *t = traction + 3 * j;
    PetscReal        e[2][3];

    z[s->num_nodes + j] = z[2 * s->num_nodes + j] = 0;
    if (Dot3(t, t) == 0) continue; /* axes of nodes that see nothing may not be known */
    PetscCall(ContactPairGetTangents(c->pair, j, e));
    for (PetscInt i = 0; i < 2; ++i) z[s->num_nodes * (1 + i) + j] = Dot3(e[i], t);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Side_Private(Interface p, Contact *c, PetscInt k)
{
  const Surface *s = &c->side[k];
  const PetscInt n = s->num_nodes, dim = s->dim;

  PetscFunctionBegin;
  if (!c->all_real[k]) PetscCall(PetscMalloc1(SIDE_REALS(dim, c->num) * n, &c->all_real[k]));
  PetscCall(PetscArrayzero(c->all_real[k], SIDE_REALS(dim, c->num) * n));
  PetscReal       *x = c->all_real[k], *direction = x + dim * n, *force = direction + dim * n, *value = force + dim * n;
  const PetscReal *normal = ContactPairGetNormals(c->pair);
  for (PetscInt j = 0; j < n; ++j) {
    if (s->owner[j] != p->rank) continue;
    PetscCall(PetscArraycpy(x + dim * j, s->x + dim * j, dim));
    PetscCall(PetscArraycpy(force + dim * j, s->force + dim * j, dim));
    if (k == 1) continue;
    if (normal) PetscCall(PetscArraycpy(direction + dim * j, normal + dim * j, dim));
    value[j]     = c->gap[j];
    value[n + j] = c->weight[j];
    for (PetscInt i = 0; i < c->num; ++i) value[(2 + i) * n + j] = c->view.z[i * n + j];
    if (!c->slip) continue;
    PetscReal *slip = value + (2 + c->num) * n;
    slip[j]         = c->slip->mean[j];
    if (dim == 2) continue;
    slip[j] = PetscSqrtReal(PetscSqr(slip[j]) + PetscSqr(c->slip->mean[n + j]));
    PetscCall(Traction_Private(c, j, slip + n + 3 * j));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->all_real[k], (PetscMPIInt)(SIDE_REALS(dim, c->num) * n), MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Activity_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  if (!c->all_active) PetscCall(PetscMalloc1(s->num_nodes, &c->all_active));
  PetscCall(PetscArrayzero(c->all_active, s->num_nodes));
  for (PetscInt i = 0; i < s->num_own; ++i) c->all_active[s->own[i]] = c->active[s->own[i]];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->all_active, (PetscMPIInt)s->num_nodes, MPI_INT8_T, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceGatherContactToAll(Interface p, PetscInt pair, const ContactView **view)
{
  Contact       *c = &p->contacts[pair];
  const PetscInt n = c->side[0].num_nodes, m = c->side[1].num_nodes, dim = p->dim;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(Side_Private(p, c, k));
  PetscCall(Activity_Private(p, c));
  c->all                 = c->view;
  c->all.nonmortar.x     = c->all_real[0];
  c->all.normal          = c->all_real[0] + dim * n;
  c->all.nonmortar.force = c->all_real[0] + 2 * dim * n;
  c->all.gap             = c->all_real[0] + 3 * dim * n;
  c->all.weight          = c->all.gap + n;
  c->all.z               = c->all.gap + 2 * n;
  c->all.slip            = c->slip ? c->all.z + c->num * n : NULL;
  c->all.traction        = c->slip && dim == 3 ? c->all.slip + n : NULL;
  c->all.active          = c->all_active;
  c->all.mortar.x        = c->all_real[1];
  c->all.mortar.force    = c->all_real[1] + 2 * dim * m;
  *view                  = &c->all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFetchContact(Interface p, PetscInt pair, const PetscBool wanted[], PetscReal z[], PetscReal normal[], PetscReal x[],
                                     PetscReal traction[])
{
  const Contact   *c    = &p->contacts[pair];
  const Surface   *s    = &c->side[0];
  Link             link = {0};
  const PetscReal *own  = ContactPairGetNormals(c->pair);
  PetscInt        *nodes, num = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, &nodes));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    const PetscBool mine = (PetscBool)(s->owner[n] == p->rank);
    for (PetscInt k = 0; k < c->num; ++k) z[s->num_nodes * k + n] = mine ? c->view.z[s->num_nodes * k + n] : NAN;
    for (PetscInt d = 0; d < s->dim && normal; ++d) normal[s->dim * n + d] = mine ? own[s->dim * n + d] : NAN;
    for (PetscInt d = 0; d < s->dim && x; ++d) x[s->dim * n + d] = mine ? s->x[s->dim * n + d] : NAN;
    for (PetscInt d = 0; d < 3 && traction; ++d) traction[3 * n + d] = mine ? 0 : NAN;
    if (mine && traction && c->slip && s->dim == 3) PetscCall(Traction_Private(c, n, traction + 3 * n));
    if (wanted[n] && !mine) nodes[num++] = n;
  }
  PetscCall(LinkSet_Private(p, s, num, nodes, &link));
  for (PetscInt k = 0; k < c->num; ++k) PetscCall(LinkSpread_Private(p, &link, 1, z + s->num_nodes * k));
  if (normal) PetscCall(LinkSpread_Private(p, &link, s->dim, normal));
  if (x) PetscCall(LinkSpread_Private(p, &link, s->dim, x));
  if (traction) PetscCall(LinkSpread_Private(p, &link, 3, traction));
  PetscCall(LinkDestroy_Private(&link));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
