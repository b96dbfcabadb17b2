/* Values of a contact pair beyond those a rank needs: all of them everywhere, for output; chosen multipliers, for the way to another mesh. */
#include "problemimpl.h"

#define SIDE_REALS(dim) (3 * (dim) + 3) /* of a node: position, normal, force, z, gap, weight */

PetscErrorCode ContactGatherDestroy_Private(Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscFree(c->all_real[k]));
  PetscCall(PetscFree(c->all_active));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Position and normal of every node from the rank of the first facet that has it as a corner, which knows them whether the node hangs or not. */
static void Corners_Private(const Problem p, const Contact *c, PetscInt k, const ForestTables *t, const PetscReal normal[], PetscReal all[])
{
  const Surface *s    = &c->side[k];
  const PetscInt size = s->dim * s->num_nodes;

  for (PetscInt i = s->corners * s->num_facets - 1; i >= 0; --i) { /* backwards: the first facet has the last word */
    const PetscInt  n    = s->facets[i];
    const PetscBool mine = (PetscBool)(t->leaf_rank[s->facet_leaf[i / s->corners]] == p->rank);
    for (PetscInt d = 0; d < s->dim; ++d) {
      all[s->dim * n + d]        = mine ? s->x[s->dim * n + d] : 0;
      all[size + s->dim * n + d] = mine && k == 0 && normal ? normal[s->dim * n + d] : 0;
    }
  }
}

static PetscErrorCode Side_Private(Problem p, Contact *c, PetscInt k)
{
  const Surface      *s = &c->side[k];
  const PetscInt      n = s->num_nodes, dim = s->dim;
  const PetscReal    *normal;
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  if (!c->all_real[k]) PetscCall(PetscMalloc1(SIDE_REALS(dim) * n, &c->all_real[k]));
  PetscCall(PetscArrayzero(c->all_real[k], SIDE_REALS(dim) * n));
  PetscReal *force = c->all_real[k] + 2 * dim * n, *value = force + dim * n;
  PetscCall(ContactPairGetNormals(c->pair, &normal));
  Corners_Private(p, c, k, t, normal, c->all_real[k]);
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    PetscCall(PetscArraycpy(force + dim * j, s->force + dim * j, dim));
    if (k == 1) continue;
    value[j]         = c->z[j];
    value[n + j]     = c->gap[j];
    value[2 * n + j] = c->weight[j];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->all_real[k], (PetscMPIInt)(SIDE_REALS(dim) * n), MPIU_REAL, MPI_SUM, p->comm));
  if (k == 0) SurfaceFollow_Private(s, 1, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Activity_Private(Problem p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  if (!c->all_active) PetscCall(PetscMalloc1(s->num_nodes, &c->all_active));
  PetscCall(PetscArrayzero(c->all_active, s->num_nodes));
  for (PetscInt i = 0; i < s->num_own; ++i) c->all_active[s->own[i]] = c->active[s->own[i]];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->all_active, (PetscMPIInt)s->num_nodes, MPIU_BOOL, MPI_LOR, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemGatherContactToAll(Problem p, PetscInt pair, const ContactView **view)
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
  c->all.z               = c->all_real[0] + 3 * dim * n;
  c->all.gap             = c->all.z + n;
  c->all.weight          = c->all.z + 2 * n;
  c->all.active          = c->all_active;
  c->all.mortar.x        = c->all_real[1];
  c->all.mortar.force    = c->all_real[1] + 2 * dim * m;
  *view                  = &c->all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFetchMultipliers(Problem p, PetscInt pair, const PetscBool wanted[], PetscReal z[])
{
  const Contact *c    = &p->contacts[pair];
  const Surface *s    = &c->side[0];
  Link           link = {0};
  PetscInt      *nodes, num = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, &nodes));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    z[n] = s->owned[n] ? c->z[n] : NAN;
    if (wanted[n] && !s->owned[n] && s->hang[n] == s->hang[n + 1]) nodes[num++] = n;
  }
  PetscCall(LinkSet_Private(p, s, num, nodes, &link));
  PetscCall(LinkSpread_Private(p, &link, 1, z));
  SurfaceFollow_Private(s, 1, z);
  PetscCall(LinkDestroy_Private(&link));
  PetscCall(PetscFree(nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
