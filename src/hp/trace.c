/* Rows of the space on faces and edges, for tables that every rank holds: orders and the forest's tables are replicated, local nodes are not. */
#include "hpimpl.h"

PetscErrorCode HPSpaceGetTraceRow(HPSpace hp, PetscInt entity, const PetscReal xi[], PetscInt max, PetscInt *num, PetscInt nodes[][2], PetscReal weights[])
{
  HPRow row = {.everywhere = PETSC_TRUE};

  PetscFunctionBegin;
  PetscCheck(entity < hp->tables->first[hp->dim], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "entity %" PetscInt_FMT " is a cell", entity);
  PetscCall(HPRowAccumulate_Private(hp, entity, xi, MORTISE_MAX_ORDER, 1.0, &row));
  PetscCheck(row.num <= max, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "row of %" PetscInt_FMT " nodes, room for %" PetscInt_FMT, row.num, max);
  *num = row.num;
  for (PetscInt k = 0; k < row.num; ++k) {
    nodes[k][0] = row.node[k] / HP_SIDE_NODES;
    nodes[k][1] = row.node[k] % HP_SIDE_NODES;
    weights[k]  = row.weight[k];
  }
  PetscCall(HPRowDestroy_Private(&row));
  PetscFunctionReturn(PETSC_SUCCESS);
}
