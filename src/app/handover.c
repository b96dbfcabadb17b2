/* The displacement for PETSc's own tools, at the end of a run: a vector on the leaf DM with a PetscFE of the highest order, through the viewers that PETSc has.
 */
#include "appimpl.h"
#include <petscdmplex.h>

#define OPTION "-solution_view"

static const char *const Viewers[] = {"vtk:", "hdf5:", "binary:"};

PetscErrorCode AppCheckHandOver(void)
{
  char      text[PETSC_MAX_PATH_LEN] = "";
  PetscBool set, known = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, OPTION, text, sizeof(text), &set));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Viewers); ++i) {
    const size_t n = strlen(Viewers[i]);
    known          = (PetscBool)(known || (!strncmp(text, Viewers[i], n) && text[n]));
  }
  PetscCheckInput(!set || known, OPTION " is '%s'; allowed: %s", text, APP_SOLUTION_VIEW);
  const size_t end = strncmp(text, "vtk:", 4) ? 0 : 4 + strcspn(text + 4, ":");
  PetscCheckInput(!end || (end > 8 && !strncmp(text + end - 4, ".vtu", 4)), OPTION " is '%s'; a file of vtk ends in .vtu", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppHandOver(App *app)
{
  const Level *l     = &app->level;
  HPSpace      space = ProblemSpace(l->problem);
  PetscReal   *u;
  PetscBool    set;
  DM           dm;
  Vec          local, x;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, OPTION, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(space);
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemLocalDisplacement(l->problem, l->accepted.x, u));
  PetscCall(HPSpaceCreateFE(space, "", &dm));
  PetscCall(DMCreateLocalVector(dm, &local));
  PetscCall(DMCreateGlobalVector(dm, &x));
  PetscCall(PetscObjectSetName((PetscObject)dm, "mesh"));
  PetscCall(PetscObjectSetName((PetscObject)x, "displacement"));
  PetscCall(HPSpaceToFE(space, u, dm, local));
  PetscCall(DMLocalToGlobal(dm, local, INSERT_VALUES, x));
  PetscCall(VecViewFromOptions(x, NULL, OPTION));
  PetscCall(VecDestroy(&local));
  PetscCall(VecDestroy(&x));
  PetscCall(DMDestroy(&dm));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
