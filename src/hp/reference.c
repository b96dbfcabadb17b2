/* The space for PETSc's own tools: the leaf DM with a PetscFE of the highest order, and a field of the space in it. A cell of lower order, and one that hangs,
   is a polynomial of the highest order too: it is evaluated at the element's nodes, so that nothing is lost and hanging nodes are filled. */
#include "hpimpl.h"
#include <petscds.h>
#include <petscfe.h>

/* Values of the element's functionals, from nodal values of a cell of order p: functional f is weight[f][c] of component c at the point whose functions are
   N[f][n]. */
typedef struct {
  PetscInt   num, n; /* functionals; nodes of a cell */
  PetscReal *N, *weight;
} Sample;

static PetscErrorCode SampleCreate_Private(PetscFE fe, PetscInt dim, PetscInt order, Sample *s)
{
  PetscDualSpace dual;

  PetscFunctionBegin;
  PetscCall(PetscFEGetDualSpace(fe, &dual));
  PetscCall(PetscDualSpaceGetDimension(dual, &s->num));
  s->n = ElementNumNodes(dim, order);
  PetscCall(PetscMalloc2(s->num * s->n, &s->N, s->num * dim, &s->weight));
  for (PetscInt f = 0; f < s->num; ++f) {
    const PetscReal *point, *weight;
    PetscInt         num_points, num_components;
    PetscReal        xi[3];
    PetscQuadrature  functional;
    PetscCall(PetscDualSpaceGetFunctional(dual, f, &functional));
    PetscCall(PetscQuadratureGetData(functional, NULL, &num_components, &num_points, &point, &weight));
    PetscCheck(num_points == 1 && num_components == dim, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a functional of PETSc's Lagrange element is no value at a node");
    for (PetscInt d = 0; d < dim; ++d) xi[d] = 0.5 * (1 + point[d]); /* PETSc's reference cell is [-1,1]^dim */
    PetscCall(ElementEvaluate(dim, order, xi, s->N + f * s->n, NULL));
    PetscCall(PetscArraycpy(s->weight + f * dim, weight, dim));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SampleApply_Private(const Sample *s, PetscInt dim, const PetscReal nodal[], PetscScalar value[])
{
  for (PetscInt f = 0; f < s->num; ++f) {
    value[f] = 0;
    for (PetscInt i = 0; i < s->n; ++i) {
      for (PetscInt c = 0; c < dim; ++c) value[f] += s->weight[f * dim + c] * s->N[f * s->n + i] * nodal[i * dim + c];
    }
  }
}

/* Highest order of a cell on any rank. */
static PetscErrorCode Highest_Private(HPSpace hp, PetscInt *order)
{
  PetscFunctionBegin;
  *order = 1;
  for (PetscInt c = 0; c < hp->view.num_owned_cells; ++c) *order = PetscMax(*order, hp->cell_order[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, order, 1, MPIU_INT, MPI_MAX, PetscObjectComm((PetscObject)hp->dm)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vertices where the space has them: faces of contact of order 1 and hanging nodes lie off the exact geometry. */
static PetscErrorCode SetCoordinates_Private(HPSpace hp, DM dm)
{
  PetscSection section;
  PetscScalar *x;
  PetscInt     start, end, offset;
  Vec          old, coordinates;

  PetscFunctionBegin;
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMGetCoordinatesLocal(dm, &old));
  PetscCall(VecDuplicate(old, &coordinates));
  PetscCall(VecCopy(old, coordinates));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &start, &end));
  PetscCall(VecGetArray(coordinates, &x));
  for (PetscInt p = start; p < end; ++p) {
    PetscCall(PetscSectionGetOffset(section, p, &offset));
    for (PetscInt d = 0; d < hp->dim; ++d) x[offset + d] = hp->X[3 * hp->point_node[p] + d];
  }
  PetscCall(VecRestoreArray(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Viewers draw the cells of this label: each rank its own. */
static PetscErrorCode SetDrawn_Private(HPSpace hp, DM dm)
{
  PetscFunctionBegin;
  for (PetscInt c = 0; c < hp->view.num_owned_cells; ++c) PetscCall(DMSetLabelValue(dm, "vtk", c, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceCreateFE(HPSpace hp, const char *name, DM *dm)
{
  PetscInt order;
  PetscFE  fe;
  DM       leaf;

  PetscFunctionBegin;
  PetscCall(ForestGetLeafDM(hp->forest, &leaf, NULL, NULL, NULL));
  PetscCall(Highest_Private(hp, &order));
  PetscCall(DMClone(leaf, dm));
  PetscCall(PetscFECreateLagrange(PETSC_COMM_SELF, hp->dim, hp->dim, PETSC_FALSE, order, PETSC_DETERMINE, &fe));
  PetscCall(PetscObjectSetName((PetscObject)fe, name));
  PetscCall(DMSetField(*dm, 0, NULL, (PetscObject)fe));
  PetscCall(PetscFEDestroy(&fe));
  PetscCall(DMCreateDS(*dm));
  PetscCall(SetCoordinates_Private(hp, *dm));
  PetscCall(SetDrawn_Private(hp, *dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceToFE(HPSpace hp, const PetscReal local[], DM dm, Vec x)
{
  const PetscInt dim = hp->dim;
  Sample         sample[MORTISE_MAX_ORDER + 1];
  PetscReal     *nodal;
  PetscScalar   *value;
  PetscSection   section;
  PetscFE        fe;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sample, MORTISE_MAX_ORDER + 1));
  PetscCall(DMGetField(dm, 0, NULL, (PetscObject *)&fe));
  PetscCall(DMGetLocalSection(dm, &section));
  PetscCall(PetscFEGetDimension(fe, &sample[0].num));
  PetscCall(PetscMalloc2(dim * ElementNumNodes(dim, MORTISE_MAX_ORDER), &nodal, sample[0].num, &value));
  PetscCall(VecZeroEntries(x));
  for (PetscInt c = 0; c < hp->view.num_cells; ++c) {
    Sample *s = &sample[hp->cell_order[c]];
    if (!s->N) PetscCall(SampleCreate_Private(fe, dim, hp->cell_order[c], s));
    PetscCall(HPSpaceGather(hp, c, local, nodal));
    SampleApply_Private(s, dim, nodal, value);
    PetscCall(DMPlexVecSetClosure(dm, section, x, c, value, INSERT_VALUES));
  }
  PetscCall(PetscFree2(nodal, value));
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; ++p) PetscCall(PetscFree2(sample[p].N, sample[p].weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}
