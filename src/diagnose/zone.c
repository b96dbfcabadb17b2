/* The zone of contact of one pair: its area, its edge, pressures and gaps, from the nodal tables, each rank its own nodes. */
#include "diagnose.h"

static PetscBool Covered_Private(const ContactView *v, PetscInt node)
{
  return (PetscBool)(v->has_multiplier[node] && v->weight[node] > 0);
}

/* Distance from the active node a, towards the inactive node that is `length` away, at which the zone ends; behind: the neighbour of a on the other side, -1:
 * none. */
static PetscReal Reach_Private(const ContactView *v, PetscInt a, PetscInt behind, PetscReal length)
{
  PetscReal fall;

  if (behind < 0 || !v->active[behind]) return length / 2;
  const PetscReal *x = v->nonmortar.x, back = PetscSqrtReal(PetscSqr(x[2 * a] - x[2 * behind]) + PetscSqr(x[2 * a + 1] - x[2 * behind + 1]));
  fall = (PetscSqr(v->z[behind]) - PetscSqr(v->z[a])) / back;
  if (!(fall > 0)) return length / 2;
  return PetscMin(length, PetscSqr(v->z[a]) / fall);
}

/* Largest |x| of this rank's part of the zone: active nodes, and its ends on edges with one active node. neighbour[node][0]: node before, [1]: after along the
 * surface. */
static PetscErrorCode Radius_Private(const ContactView *v, PetscReal *radius)
{
  const SurfaceView *s = &v->nonmortar;
  PetscInt(*neighbour)[2];

  PetscFunctionBegin;
  *radius = 0;
  PetscCall(PetscMalloc1(s->num_nodes, &neighbour));
  for (PetscInt n = 0; n < s->num_nodes; ++n) neighbour[n][0] = neighbour[n][1] = -1;
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt *node, num = SurfaceFacetNodes(s, e, &node);
    for (PetscInt k = 0; k + 1 < num; ++k) {
      neighbour[node[k]][1]     = node[k + 1];
      neighbour[node[k + 1]][0] = node[k];
    }
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (!s->owned[n] || !v->active[n]) continue;
    *radius = PetscMax(*radius, PetscAbsReal(s->x[2 * n]));
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscInt next = neighbour[n][k];
      if (next < 0 || v->active[next]) continue;
      const PetscReal d[2] = {s->x[2 * next] - s->x[2 * n], s->x[2 * next + 1] - s->x[2 * n + 1]}, length = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
      if (!(length > 0)) continue;
      *radius = PetscMax(*radius, PetscAbsReal(s->x[2 * n] + d[0] / length * Reach_Private(v, n, neighbour[n][1 - k], length)));
    }
  }
  PetscCall(PetscFree(neighbour));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A tied pair has no zone that comes and goes: its area is that at the reference positions, its largest "pressure" the size of the traction. */
static PetscErrorCode Tied_Private(MPI_Comm comm, const ContactView *v, PairFigures *f)
{
  PetscReal most = 0;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
    PetscReal square = 0;
    for (PetscInt k = 0; k < v->num_z && v->nonmortar.owned[n]; ++k) square += PetscSqr(v->z[k * v->nonmortar.num_nodes + n]);
    most = PetscMax(most, PetscSqrtReal(square));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, comm));
  f->max_pressure = most;
  f->area         = v->area;
  f->tied         = PETSC_TRUE;
  f->unusable     = v->unusable;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BalanceZone(MPI_Comm comm, const ContactView *v, PairFigures *f)
{
  PetscReal sum[3] = {0, 0, 0}, most[4] = {0, PETSC_MIN_REAL, PETSC_MIN_REAL, 0}; /* active, covered, area; pressure, - gap, gap, radius */

  PetscFunctionBegin;
  if (v->spec->law == CONTACT_TIED) {
    PetscCall(Tied_Private(comm, v, f));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
    if (!v->nonmortar.owned[n] || !Covered_Private(v, n)) continue;
    const PetscReal gap = v->gap[n] / v->weight[n];
    most[0]             = PetscMax(most[0], v->z[n]);
    most[1]             = PetscMax(most[1], -gap);
    most[2]             = PetscMax(most[2], gap);
    sum[1] += 1;
    if (!v->active[n]) continue;
    sum[0] += 1;
    sum[2] += v->weight[n];
  }
  if (v->nonmortar.dim == 2) PetscCall(Radius_Private(v, &most[3]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 4, MPIU_REAL, MPI_MAX, comm));
  f->active_nodes  = (PetscInt)sum[0];
  f->covered_nodes = (PetscInt)sum[1];
  f->area          = sum[2];
  f->max_pressure  = most[0];
  f->min_gap       = f->covered_nodes ? -most[1] : 0;
  f->max_gap       = f->covered_nodes ? most[2] : 0;
  f->radius        = v->nonmortar.dim == 2 ? most[3] : PetscSqrtReal(f->area / PETSC_PI);
  f->adjusted      = v->adjusted;
  f->unusable      = v->unusable;
  f->stabilised    = v->stabilised;
  PetscFunctionReturn(PETSC_SUCCESS);
}
