/* Slides along a good part of the zone of contact. Seen from the side that stays, a body of radius R that moves by s
   along the other leaves a gap (X - s)^2 / 2R, of which the linearisation at s = 0 lacks s^2 / 2R: too deep against a
   depth of contact of a^2 / R, half width a, from about s = a on. The linear step then presses the body far into the
   other, and Newton's method does not find back. What it does tell is that contact moves: its active set leaves nodes
   that carry pressure and takes as many new ones (never more than half of the old: the linear gap below the centre does
   not change). The bodies are then brought to their new places first. */
#include "interfaceimpl.h"

#define STAYS 0.9 /* share of the smaller of the old and the new zone that both have in common, below which contact moves */
#define FAR 0.15  /* of the zone: a pair that slips by less in the mean stays in place */

/* Does contact, by the active set at hand, leave nodes that carry pressure for others? By reference length, so that
   graded meshes count alike. A zone that only grows or only shrinks does not move. */
static PetscErrorCode HasMoved_Private(Interface p, const Contact *c, PetscBool *moved)
{
  const Surface *s      = &c->side[0];
  PetscReal      sum[3] = {0, 0, 0}, most = 0; /* pressed, active, both */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_own; ++i) {
    if (c->has_multiplier[s->own[i]]) most = PetscMax(most, c->z[s->own[i]]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, p->comm));
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt  j       = s->own[i];
    const PetscBool pressed = (PetscBool)(ContactPressed_Private(c, j) && c->z[j] > PETSC_SQRT_MACHINE_EPSILON * most); /* less is round-off of an open node */
    if (!c->has_multiplier[j]) continue;
    if (pressed) sum[0] += c->w0[j];
    if (c->active[j]) sum[1] += c->w0[j];
    if (pressed && c->active[j]) sum[2] += c->w0[j];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, p->comm));
  *moved = (PetscBool)(sum[2] < STAYS * PetscMin(sum[0], sum[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a node's share of the zone and its slip, as a vector of the plane or in space. */
static PetscErrorCode AddSlip_Private(const Contact *c, PetscInt j, PetscReal *zone, PetscReal slip[3])
{
  const SlipHistory *s   = c->slip;
  const PetscInt     dim = c->side[0].dim, num = c->side[0].num_nodes;
  const PetscReal    size    = dim == 3 ? c->w0[j] : c->extent[j];
  PetscReal          e[2][3] = {{1, 0, 0}, {0, 0, 0}};

  PetscFunctionBegin;
  if (dim == 3) PetscCall(ContactPairGetTangents(c->pair, j, e));
  *zone += size;
  for (PetscInt i = 0; i < dim - 1 && s->weight[j] > 0; ++i)
    for (PetscInt d = 0; d < 3; ++d) slip[d] += size * e[i][d] * (s->slip[num * i + j] + s->change[num * i + j]) / s->weight[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With friction: does the zone slip by a good part of it in the mean, in the first linear step? Then bodies are brought to their new places first. Where
   friction holds, or drives, they would have to be pulled back from there. */
static PetscErrorCode Slips_Private(Interface p, const Contact *c, PetscBool swap, PetscBool *slips)
{
  PetscReal sum[5] = {0}, *slip = sum + 1, *pressed = sum + 4; /* zone; integral of the slip; nodes with pressure */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];

    if (ContactPressed_Private(c, j)) *pressed += 1;
    if (c->active[j] && ContactPressed_Private(c, j)) PetscCall(AddSlip_Private(c, j, sum, slip));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 5, MPIU_REAL, MPI_SUM, p->comm));
  const PetscReal length = p->dim == 3 ? PetscSqrtReal(sum[0]) : sum[0];
  *slips                 = (PetscBool)(*pressed > 0 && swap != (PetscSqrtReal(Dot3(slip, slip)) > FAR * sum[0] * length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindSliding(Interface p, PetscReal pending, PetscBool swap, uint64_t *pairs)
{
  PetscBool moved;

  PetscFunctionBegin;
  *pairs = 0;
  if (p->spec->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; pending > 0 && i < p->num_contacts; ++i) {
    if (p->contacts[i].tie) continue;
    if (p->contacts[i].view.friction > 0)
      PetscCall(Slips_Private(p, &p->contacts[i], swap, &moved));
    else
      PetscCall(HasMoved_Private(p, &p->contacts[i], &moved));
    if (moved) *pairs |= FormPair(i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
