/* Where the fibres of a material run: straight, along a field of the mesh, or at an angle to the circumferential direction of its frame. */
#include "material.h"

static void Circumferential_Private(const MaterialFrame *frame, const PetscReal X[3], PetscReal around[3])
{
  const int axis = frame->axis, i = (axis + 1) % 3, j = (axis + 2) % 3;
  PetscReal x = X[i] - frame->point[i], y = X[j] - frame->point[j], radius = PetscSqrtReal(x * x + y * y);

  around[axis] = 0;
  around[i]    = radius > 0 ? -y / radius : 0;
  around[j]    = radius > 0 ? x / radius : 1;
  if (frame->meridian) { /* the third component of an axisymmetric model, also on the axis */
    around[0] = around[1] = 0;
    around[2]             = 1;
  }
}

static void Along_Private(const PetscReal v[3], PetscReal fiber[3])
{
  const PetscReal length = PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);

  for (int c = 0; c < 3; c++) fiber[c] = v[c] / length;
}

void MaterialFiberDirections(const MaterialSpec *spec, PetscInt cell, const PetscReal X[3], PetscReal fiber[][3])
{
  PetscReal around[3];

  if (spec->num_fibers) Circumferential_Private(&spec->frame, X, around);
  for (PetscInt f = 0; f < spec->num_fibers; f++) {
    const MaterialFiber *family = &spec->fiber[f];
    const PetscReal      angle  = family->angle * PETSC_PI / 180;

    for (int c = 0; c < 3; c++)
      fiber[f][c] = family->straight ? family->direction[c] : PetscCosReal(angle) * around[c] + (c == spec->frame.axis ? PetscSinReal(angle) : 0);
    if (family->field[0]) Along_Private(family->along[cell], fiber[f]);
  }
}
