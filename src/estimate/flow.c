/* What a cell whose material has flowed has left of its stiffness. The estimate is of stresses: a volume that mixed cells do not see, or a gap that the
   constraints do not, is an error of strain that stiffness makes one of stress. Where material has flowed far such strains were not there at once: they grew
   with the flow, as those of the cell did, and stress stayed on the yield surface. So the stress they make goes by the secant of the way there (Hencky's theory
   of deformation): of a strain |e| = |s|/(2 mu) + sqrt(3/2) alpha and the stress |s| = sqrt(2/3) k,

     mu_s/mu = 1/(1 + 3 mu alpha/k),   k from the plastic work: alpha k, in the mean of the cell.

   The energy of that stress is as the square of it.

   Which cells are refined first is another question: a strain that is missed is flow that goes elsewhere from then on, most of all where a neck or a band of
   shear begins. So cells are ranked as if nothing had flowed. */
#include "estimateimpl.h"

/* Mean plastic strain and plastic work of a cell's points. */
static void Mean_Private(const MaterialSpec *m, PetscInt num, const PetscReal history[], PetscReal *strain, PetscReal *work)
{
  const PetscInt points = num / m->law->num_history;

  *strain = *work = 0;
  for (PetscInt q = 0; q < points; ++q) {
    PetscReal alpha, taken;
    m->law->plastic(m, history + m->law->num_history * q, &alpha, &taken);
    *strain += alpha / (PetscReal)points;
    *work += taken / (PetscReal)points;
  }
}

PetscErrorCode EstimateFlow_Private(EstimateSum *sum)
{
  const PetscInt num_leaves = sum->t->num_leaves;
  PetscInt       size, first, num;
  PetscReal     *history, strain, work;
  PetscBool      bad;

  PetscFunctionBegin;
  if (!MechanicsIsPlastic(sum->spec)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num_leaves, &sum->left));
  for (PetscInt l = 0; l < num_leaves; ++l) sum->left[l] = 1;
  PetscCall(MechanicsNumHistory(sum->mechanics, &size));
  PetscCall(PetscMalloc1(size, &history));
  PetscCall(MechanicsCommit(sum->mechanics, sum->u, history, &bad));
  for (PetscInt c = 0; c < sum->v->num_owned_cells && !bad; ++c) {
    const PetscInt      leaf = sum->v->cell_leaf[c];
    const MaterialSpec *m    = sum->spec->bodies[sum->t->leaf_body[leaf]].material;
    if (!m->law->plastic) continue;
    PetscCall(MechanicsHistoryRange(sum->mechanics, c, &first, &num));
    Mean_Private(m, num, history + first, &strain, &work);
    sum->left[leaf] = PetscSqr(MaterialSecant(m, strain, work));
  }
  PetscCall(PetscFree(history));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum->left, (PetscMPIInt)num_leaves, MPIU_REAL, MPI_MIN, ForestComm(HPSpaceGetForest(sum->space))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal EstimateLeft_Private(const EstimateSum *sum, PetscInt leaf)
{
  return sum->left ? sum->left[leaf] : 1;
}
