/* Life cycle of the hp space. */
#include "hpimpl.h"

PetscErrorCode HPSpaceCreate(Forest forest, const int8_t leaf_order[], const int8_t leaf_cap[][3], uint64_t linear_groups, uint64_t mirror_groups,
                             HPSpace *space)
{
  HPSpace  hp;
  PetscInt num_owned, largest = 1;
  DM       leaf;

  PetscFunctionBegin;
  PetscCall(PetscNew(&hp));
  hp->forest = forest;
  hp->tables = ForestGetTables(forest);
  hp->dim    = hp->tables->dim;
  PetscCall(ForestGetLeafDM(forest, &leaf, &num_owned, &hp->num_points, &hp->point_entity));
  PetscCall(DMClone(leaf, &hp->dm));
  PetscCall(HPSpaceOrders_Private(hp, leaf_order, leaf_cap, linear_groups));
  PetscCall(HPSpaceNodes_Private(hp, num_owned));
  PetscCall(HPSpaceRows_Private(hp));
  PetscCall(HPSpacePositions_Private(hp, linear_groups, mirror_groups));
  for (PetscInt c = 0; c < hp->view.num_cells; ++c) {
    const PetscInt nm = hp->cell_row[c + 1] - hp->cell_row[c], n = ElementNumNodes(hp->dim, hp->cell_order[c]);
    largest = PetscMax(largest, nm * n);
  }
  PetscCall(PetscMalloc1(largest * hp->dim * hp->dim, &hp->work));
  *space = hp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceSetUp(HPSpace hp, const int8_t fixed[], PetscInt num_frames, const PetscInt frame_node[], const PetscReal frame[][9])
{
  PetscFunctionBegin;
  if (num_frames) {
    PetscCall(PetscMalloc2(hp->view.num_nodes, &hp->node_frame, num_frames, &hp->frame));
    for (PetscInt n = 0; n < hp->view.num_nodes; ++n) hp->node_frame[n] = -1;
    for (PetscInt f = 0; f < num_frames; ++f) {
      hp->node_frame[frame_node[f]] = f;
      PetscCall(PetscArraycpy(hp->frame[f], frame[f], 9));
    }
    hp->num_frames = num_frames;
  }
  PetscCall(HPSpaceSections_Private(hp, fixed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceDestroy(HPSpace *space)
{
  HPSpace hp = *space;

  PetscFunctionBegin;
  if (!hp) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMDestroy(&hp->dm));
  PetscCall(PetscFree2(hp->entity_point, hp->point_node));
  PetscCall(PetscFree2(hp->entity_order, hp->axis_order));
  PetscCall(PetscFree3(hp->node_entity, hp->cell_leaf, hp->cell_order));
  PetscCall(PetscFree2(hp->cell_row, hp->cell_weight));
  PetscCall(PetscFree(hp->cell_master));
  PetscCall(PetscFree(hp->weight));
  PetscCall(PetscFree(hp->node_hang));
  PetscCall(PetscFree(hp->hang_master));
  PetscCall(PetscFree(hp->hang_weight));
  PetscCall(PetscFree(hp->X));
  PetscCall(PetscFree(hp->global_dof));
  if (hp->node_frame) PetscCall(PetscFree2(hp->node_frame, hp->frame));
  PetscCall(PetscFree(hp->work));
  PetscCall(PetscFree(*space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const HPTables *HPSpaceGetTables(HPSpace hp)
{
  return &hp->view;
}

Forest HPSpaceGetForest(HPSpace hp)
{
  return hp->forest;
}

DM HPSpaceGetDM(HPSpace hp)
{
  return hp->dm;
}

PetscErrorCode HPSpaceGetGlobalDofs(HPSpace hp, const PetscInt **dofs)
{
  PetscFunctionBegin;
  *dofs = hp->global_dof;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceGetFrame(HPSpace hp, PetscInt node, const PetscReal **frame)
{
  PetscFunctionBegin;
  *frame = hp->node_frame && hp->node_frame[node] >= 0 ? hp->frame[hp->node_frame[node]] : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt HPSpaceGetOrder(HPSpace hp, PetscInt entity)
{
  return hp->entity_order[entity];
}

PetscErrorCode HPSpaceGetAxisOrders(HPSpace hp, PetscInt entity, PetscInt orders[3])
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < 3; ++a) orders[a] = hp->axis_order[entity][a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceIsDirectional(HPSpace hp, PetscBool *directional)
{
  const ForestTables *t = hp->tables;

  PetscFunctionBegin;
  *directional = PETSC_FALSE;
  for (PetscInt e = t->first[t->dim]; e < t->num_entities; ++e)
    for (PetscInt a = 0; a < t->dim; ++a)
      if (hp->axis_order[e][a] != hp->entity_order[e]) *directional = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
