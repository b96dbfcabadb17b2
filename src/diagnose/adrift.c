/* Bodies that nothing holds: neither a support, nor contact with bodies that one holds. */
#include "diagnoseimpl.h"

/* Do not push: forces below this share of the cells' nodal forces. */
#define ROUND_OFF 1e-10

static PetscInt Root_Private(const PetscInt root[], PetscInt a)
{
  while (root[a] != a) a = root[a];
  return a;
}

static void Join_Private(PetscInt root[], PetscInt a, PetscInt b)
{
  const PetscInt to = PetscMin(Root_Private(root, a), Root_Private(root, b));

  root[Root_Private(root, a)] = to;
  root[Root_Private(root, b)] = to;
}

/* force[body]: sum of the magnitudes of this rank's nodal forces on a side. */
static void SideForces_Private(const ForestTables *t, const SurfaceView *s, PetscReal force[])
{
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt *node, num = SurfaceFacetNodes(s, e, &node);
    for (PetscInt k = 0; k < num; ++k) {
      for (PetscInt c = 0; c < s->dim && s->owned[node[k]]; ++c) force[t->leaf_body[s->facet_leaf[e]]] += PetscAbsReal(s->force[s->dim * node[k] + c]);
    }
  }
}

/* Bodies that a pair presses on each other. */
static PetscErrorCode JoinPairs_Private(Problem problem, PetscInt num, PetscInt num_bodies, PetscReal scale, PetscInt root[])
{
  const ForestTables *t = ForestGetTables(ProblemForest(problem));
  const ContactView  *v;
  PetscReal          *force; /* [num][num_bodies] */

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num * num_bodies, &force));
  for (PetscInt i = 0; i < num; ++i) {
    v = InterfaceGetContact(ProblemInterface(problem), i);
    SideForces_Private(t, &v->nonmortar, force + i * num_bodies);
    SideForces_Private(t, &v->mortar, force + i * num_bodies);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, (PetscMPIInt)(num * num_bodies), MPIU_REAL, MPI_SUM, ForestComm(ProblemForest(problem))));
  for (PetscInt i = 0; i < num; ++i) {
    PetscInt first = -1;
    for (PetscInt b = 0; b < num_bodies; ++b) {
      if (!(force[i * num_bodies + b] > ROUND_OFF * scale)) continue;
      if (first < 0) first = b;
      Join_Private(root, first, b);
    }
  }
  PetscCall(PetscFree(force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AdriftFind(Problem problem, PetscReal scale, PetscInt axes[])
{
  const SceneData  *scene = ProblemGetScene(problem);
  const CoarseMesh *mesh  = ForestGetCoarse(ProblemForest(problem));
  const PetscReal  *hold;
  const PetscInt   *group;
  PetscReal        *sum;
  PetscInt         *root, num, free = 0;

  PetscFunctionBegin;
  PetscCall(MechanicsGetHold(ProblemMechanics(problem), &hold, &group));
  num = scene->mechanics.num_bodies;
  for (PetscInt b = 0; b < num; ++b) free |= axes[b] = MechanicsFreeAxes(mesh->dim, hold + 9 * b);
  if (!free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(9 * num, &sum, num, &root));
  PetscCall(PetscArraycpy(root, group, num));
  PetscCall(JoinPairs_Private(problem, scene->num_contacts, num, scale, root));
  for (PetscInt b = 0; b < num; ++b)
    for (PetscInt c = 0; c < 9 && group[b] == b; ++c) sum[9 * Root_Private(root, b) + c] += hold[9 * b + c];
  for (PetscInt b = 0; b < num; ++b) axes[b] = MechanicsFreeAxes(mesh->dim, sum + 9 * Root_Private(root, b));
  PetscCall(PetscFree2(sum, root));
  PetscFunctionReturn(PETSC_SUCCESS);
}
