/* Fibres along a field of the mesh: the field is there, and tells a direction for every cell of the bodies that want it. */
#include "sceneimpl.h"

static PetscErrorCode FindField_Private(const CoarseMesh *m, const char *where, const char *name, PetscInt *index)
{
  char     list[1024];
  PetscInt num = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_fields; ++i) {
    if (strcmp(m->field_name[i], name)) continue;
    *index = i;
    ++num;
  }
  PetscCall(SceneListNames(m->num_fields, m->field_name, sizeof(list), list));
  PetscCheckInput(num, "%s: the mesh has no field '%s'; its fields ($ElementData of three components in an ASCII .msh): %s", where, name, list);
  PetscCheckInput(num == 1, "%s: the mesh has %d fields '%s', allowed: one; its fields: %s", where, (int)num, name, list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All cells of bodies of this material have a vector that points somewhere. */
static PetscErrorCode CheckVectors_Private(Scene s, const CoarseMesh *m, const MaterialSpec *material, const char *where, const MaterialFiber *fiber)
{
  PetscReal shortest = PETSC_MAX_REAL, longest = 0;
  char      list[1024];

  PetscFunctionBegin;
  PetscCall(SceneListNames(m->num_fields, m->field_name, sizeof(list), list));
  for (PetscInt c = 0; c < m->num_cells; ++c) {
    const PetscReal *v = fiber->along[c], length = PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (s->data.bodies[m->cell_body[c]].material != material) continue;
    PetscCheckInput(!PetscIsNanReal(length), "%s: field '%s' has no vector for cell %d of the mesh, of body '%s'; fields of the mesh: %s", where, fiber->field,
                    (int)c, m->body_name[m->cell_body[c]], list);
    PetscCheckInput(length > 0 && !PetscIsInfReal(length),
                    "%s: the vector (%g, %g, %g) of field '%s' in cell %d of the mesh points nowhere; fields of the mesh: %s", where, (double)v[0],
                    (double)v[1], (double)v[2], fiber->field, (int)c, list);
    shortest = PetscMin(shortest, length);
    longest  = PetscMax(longest, length);
  }
  if (shortest < 1 - 1e-6 || longest > 1 + 1e-6)
    PetscCall(PetscPrintf(s->comm, "note: %s: vectors of field '%s' have lengths from %.6g to %.6g; made unit vectors\n", where, fiber->field, (double)shortest,
                          (double)longest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckFields(Scene s, const CoarseMesh *m)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->data.num_materials; ++i) {
    MaterialSpec *material = &s->data.materials[i];
    for (PetscInt f = 0; f < material->num_fibers; ++f) {
      MaterialFiber *fiber = &material->fiber[f];
      PetscInt       index = 0;
      if (!fiber->field[0]) continue;
      const char *where = NodeWhere(NodeFind(NodeFind(NodeFind(s->material[i].node, "fiber"), fiber->name), "field"));
      PetscCall(FindField_Private(m, where, fiber->field, &index));
      fiber->along = (const PetscReal(*)[3])(m->field + 3 * m->num_cells * index);
      PetscCall(CheckVectors_Private(s, m, material, where, fiber));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
