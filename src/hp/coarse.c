/* The space of order 1 on the same mesh inside this one: what its vertices make of every node. For multigrid methods. */
#include "hpimpl.h"

PetscErrorCode HPSpaceGetVertexRow(HPSpace hp, PetscInt node, PetscInt max, PetscInt *num, PetscInt vertices[], PetscReal weights[])
{
  const PetscInt entity = hp->node_entity[node];
  PetscReal      eta[3] = {0, 0, 0};
  HPRow          row    = {0};

  PetscFunctionBegin;
  PetscCall(HPNodePoint_Private(hp, entity, node - hp->point_node[hp->entity_point[entity]], eta));
  PetscCall(HPRowAccumulate_Private(hp, entity, eta, 1, 1.0, &row));
  PetscCheck(row.num <= max, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "row of %" PetscInt_FMT " vertices, room for %" PetscInt_FMT, row.num, max);
  *num = row.num;
  PetscCall(PetscArraycpy(vertices, row.node, row.num));
  PetscCall(PetscArraycpy(weights, row.weight, row.num));
  PetscCall(HPRowDestroy_Private(&row));
  PetscFunctionReturn(PETSC_SUCCESS);
}
