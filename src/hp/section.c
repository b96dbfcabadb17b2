/* PetscSection of the space: hanging and prescribed dofs constrained, default constraints of the DM for hanging nodes. */
#include "hpimpl.h"

static PetscBool IsHanging_Private(HPSpace hp, PetscInt node)
{
  return (PetscBool)(hp->tables->parent[hp->node_entity[node]] >= 0);
}

/* Local indices (within its point) of the constrained dofs of a point; returns their number. */
static PetscInt PointConstraints_Private(HPSpace hp, const int8_t fixed[], PetscInt point, PetscInt indices[])
{
  PetscInt num = 0;
  for (PetscInt n = hp->point_node[point], i = 0; n < hp->point_node[point + 1]; ++n) {
    for (PetscInt c = 0; c < hp->dim; ++c, ++i) {
      if (IsHanging_Private(hp, n) || (fixed && (fixed[n] >> c) & 1)) indices[num++] = i;
    }
  }
  return num;
}

static PetscErrorCode LocalSection_Private(HPSpace hp, const int8_t fixed[], PetscSection *section)
{
  PetscSection s;
  PetscInt     max = 0, *indices;

  PetscFunctionBegin;
  PetscCall(PetscSectionCreate(PetscObjectComm((PetscObject)hp->dm), &s));
  PetscCall(PetscSectionSetNumFields(s, 1));
  PetscCall(PetscSectionSetFieldName(s, 0, "displacement"));
  PetscCall(PetscSectionSetFieldComponents(s, 0, hp->dim));
  PetscCall(PetscSectionSetChart(s, 0, hp->num_points));
  for (PetscInt p = 0; p < hp->num_points; ++p) max = PetscMax(max, hp->dim * (hp->point_node[p + 1] - hp->point_node[p]));
  PetscCall(PetscMalloc1(max, &indices));
  for (PetscInt p = 0; p < hp->num_points; ++p) {
    const PetscInt dofs = hp->dim * (hp->point_node[p + 1] - hp->point_node[p]), num = PointConstraints_Private(hp, fixed, p, indices);
    PetscCall(PetscSectionSetDof(s, p, dofs));
    PetscCall(PetscSectionSetFieldDof(s, p, 0, dofs));
    PetscCall(PetscSectionSetConstraintDof(s, p, num));
    PetscCall(PetscSectionSetFieldConstraintDof(s, p, 0, num));
  }
  PetscCall(PetscSectionSetUp(s));
  for (PetscInt p = 0; p < hp->num_points; ++p) {
    if (PointConstraints_Private(hp, fixed, p, indices) == 0) continue;
    PetscCall(PetscSectionSetConstraintIndices(s, p, indices));
    PetscCall(PetscSectionSetFieldConstraintIndices(s, p, 0, indices));
  }
  PetscCall(PetscFree(indices));
  *section = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Global index of every local dof, -1 for constrained ones. */
static PetscErrorCode GlobalDofs_Private(HPSpace hp, const int8_t fixed[])
{
  PetscSection global;

  PetscFunctionBegin;
  PetscCall(DMGetGlobalSection(hp->dm, &global));
  PetscCall(PetscMalloc1(hp->dim * hp->view.num_nodes, &hp->global_dof));
  for (PetscInt p = 0; p < hp->num_points; ++p) {
    PetscInt offset;
    PetscCall(PetscSectionGetOffset(global, p, &offset));
    if (offset < 0) offset = -(offset + 1);
    for (PetscInt n = hp->point_node[p]; n < hp->point_node[p + 1]; ++n) {
      for (PetscInt c = 0; c < hp->dim; ++c) {
        const PetscBool constrained     = (PetscBool)(IsHanging_Private(hp, n) || (fixed && (fixed[n] >> c) & 1));
        hp->global_dof[n * hp->dim + c] = constrained ? -1 : offset++;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cartesian component c of a master as a combination of its dofs: column k gets frame[k][c], or the unit when it has no frame. */
static PetscReal FrameEntry_Private(HPSpace hp, PetscInt node, PetscInt k, PetscInt c)
{
  const PetscInt f = hp->node_frame ? hp->node_frame[node] : -1;
  return f < 0 ? (PetscReal)(k == c) : hp->frame[f][3 * k + c];
}

static PetscErrorCode ConstraintRow_Private(HPSpace hp, Mat mat, PetscInt row, PetscInt node, PetscInt c)
{
  PetscFunctionBegin;
  for (PetscInt h = hp->node_hang[node]; h < hp->node_hang[node + 1]; ++h) {
    const PetscInt master = hp->hang_master[h];
    for (PetscInt k = 0; k < hp->dim; ++k) {
      const PetscReal entry = hp->hang_weight[h] * FrameEntry_Private(hp, master, k, c);
      if (entry != 0) PetscCall(MatSetValue(mat, row, master * hp->dim + k, entry, INSERT_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hanging nodes as the DM's default constraints: a global-to-local fills them, a local-to-global distributes them. All values of a point
   are listed or none (rows are copied point by point); there is no bias because prescribed dofs of masters enter through the local vector. */
static PetscErrorCode DefaultConstraints_Private(HPSpace hp)
{
  PetscSection s;
  Mat          mat;
  PetscInt     rows, longest = 1;

  PetscFunctionBegin;
  PetscCall(PetscSectionCreate(PETSC_COMM_SELF, &s));
  PetscCall(PetscSectionSetChart(s, 0, hp->num_points));
  for (PetscInt p = 0; p < hp->num_points; ++p) {
    if (hp->tables->parent[hp->point_entity[p]] >= 0) PetscCall(PetscSectionSetDof(s, p, hp->dim * (hp->point_node[p + 1] - hp->point_node[p])));
  }
  PetscCall(PetscSectionSetUp(s));
  PetscCall(PetscSectionGetStorageSize(s, &rows));
  for (PetscInt n = 0; n < hp->view.num_nodes; ++n) longest = PetscMax(longest, hp->dim * (hp->node_hang[n + 1] - hp->node_hang[n]));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, rows, hp->dim * hp->view.num_nodes, longest, NULL, &mat));
  for (PetscInt n = 0; n < hp->view.num_nodes; ++n) {
    const PetscInt point = hp->entity_point[hp->node_entity[n]];
    PetscInt       offset;
    if (!IsHanging_Private(hp, n)) continue;
    PetscCall(PetscSectionGetOffset(s, point, &offset));
    for (PetscInt c = 0; c < hp->dim; ++c) PetscCall(ConstraintRow_Private(hp, mat, offset + (n - hp->point_node[point]) * hp->dim + c, n, c));
  }
  PetscCall(MatAssemblyBegin(mat, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(mat, MAT_FINAL_ASSEMBLY));
  PetscCall(DMSetDefaultConstraints(hp->dm, s, mat, NULL));
  PetscCall(MatDestroy(&mat));
  PetscCall(PetscSectionDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceSections_Private(HPSpace hp, const int8_t fixed[])
{
  PetscSection section;
  PetscInt     hanging = 0;

  PetscFunctionBegin;
  PetscCall(LocalSection_Private(hp, fixed, &section));
  PetscCall(DMSetLocalSection(hp->dm, section));
  PetscCall(PetscSectionDestroy(&section));
  PetscCall(GlobalDofs_Private(hp, fixed));
  for (PetscInt n = 0; n < hp->view.num_nodes; ++n) hanging += IsHanging_Private(hp, n);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &hanging, 1, MPIU_INT, MPI_SUM, PetscObjectComm((PetscObject)hp->dm)));
  if (hanging) PetscCall(DefaultConstraints_Private(hp));
  PetscFunctionReturn(PETSC_SUCCESS);
}
