/* One body on an adapted box (forest_box.h), its space and mechanics, for tests of estimate and transfer that need no scene. */
#pragma once
#include "forest_box.h"
#include "mechanics.h"

#include "near.h"

typedef struct {
  Forest        forest;
  HPSpace       space;
  Mechanics     mechanics;
  Supports      supports;
  MechanicsSpec spec;
  MaterialSpec  material;
  BodySpec      body;
  BoundarySpec  boundaries[6]; /* sides of the box: 2*axis + (high) */
  int8_t       *orders;
} Bulk;

static inline void BulkMaterial(MaterialSpec *material, const char *law, Volumetric volumetric, Formulation formulation, PetscReal mu, PetscReal kappa)
{
  const char *const names[]  = {"mu", "kappa"};
  const PetscReal   values[] = {mu, kappa};

  *material = (MaterialSpec){.law = MaterialLawFind(law), .volumetric = volumetric, .formulation = formulation};
  OK(PetscStrcpy(material->name, "test"));
  OK(MaterialSetUp(material, 2, names, values));
}

/* Nothing prescribed, nothing loaded; the caller may change spec.* and boundaries before BulkSetUp. */
static inline void BulkInit(Bulk *b, PetscInt dim, Model model, Kinematics kinematics)
{
  b->body.material = &b->material;
  b->spec =
      (MechanicsSpec){.model = model, .kinematics = kinematics, .num_bodies = 1, .bodies = &b->body, .num_boundaries = 2 * dim, .boundaries = b->boundaries};
  for (PetscInt s = 0; s < 2 * dim; ++s) {
    OK(PetscSNPrintf(b->boundaries[s].name, MORTISE_NAME, "side%d", (int)s));
    b->boundaries[s].group = s;
  }
}

/* A constant (or any text) as expression; freed by BulkDestroy through the list below. */
static Expression        bulk_expressions[64];
static PetscInt          bulk_num_expressions;
static inline Expression BulkExpression(const char *format, ...)
{
  char    text[8192];
  va_list arguments;

  va_start(arguments, format);
  vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  if (bulk_num_expressions == PETSC_STATIC_ARRAY_LENGTH(bulk_expressions)) abort();
  OK(ExpressionCreate("test", text, &bulk_expressions[bulk_num_expressions]));
  return bulk_expressions[bulk_num_expressions++];
}

/* orders NULL: random in low..high. Forest in b->forest. */
static inline void BulkSetUp(Bulk *b, PetscInt low, PetscInt high)
{
  const ForestTables *t;

  t = ForestGetTables(b->forest);
  OK(PetscMalloc1(t->num_leaves, &b->orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) b->orders[l] = (int8_t)(low + BoxRandom(high - low + 1));
  OK(HPSpaceCreate(b->forest, b->orders, NULL, 0, 0, &b->space));
  OK(MechanicsSupportsCreate(b->space, &b->spec, &b->supports));
  OK(HPSpaceSetUp(b->space, b->supports.fixed, b->supports.num_frames, b->supports.frame_node, (const PetscReal(*)[9])b->supports.frame));
  OK(MechanicsCreate(b->space, &b->spec, &b->supports, &b->mechanics));
  OK(MechanicsSetTime(b->mechanics, 1));
}

static inline void BulkDestroy(Bulk *b)
{
  OK(MechanicsDestroy(&b->mechanics));
  OK(MechanicsSupportsDestroy(&b->supports));
  OK(HPSpaceDestroy(&b->space));
  OK(PetscFree(b->orders));
  OK(ForestDestroy(&b->forest));
  while (bulk_num_expressions) OK(ExpressionDestroy(&bulk_expressions[--bulk_num_expressions]));
}

/* Random marks, adapted in place, `rounds` times. */
static inline void BulkRefine(Forest *forest, PetscInt dim, PetscInt rounds, PetscBool anisotropic)
{
  for (PetscInt round = 0; round < rounds; ++round) {
    const ForestTables *t;
    MarkList            marks;
    t = ForestGetTables(*forest);
    BoxRandomMarks(dim, t->num_leaves, 5, anisotropic, &marks);
    marks.split[BoxRandom(t->num_leaves)] = (int8_t)((1 << dim) - 1);
    AdaptBy(forest, &marks);
  }
}
