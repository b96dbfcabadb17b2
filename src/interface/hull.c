/* All outer facets of the mesh at their reference positions, and which of them belong together: for the search, which asks how thick bodies are. */
#include "interfaceimpl.h"

PetscErrorCode HullCreate_Private(Interface p)
{
  const CoarseMesh   *mesh = ForestGetCoarse(p->forest);
  const ForestTables *t    = p->tables;
  const PetscInt      dim = p->dim, corners = dim == 2 ? 2 : 4;
  PetscInt            num = 0, num_parts, *part;
  PetscBool          *inner;
  PetscReal          *X;

  PetscFunctionBegin;
  const PetscInt first = t->first[dim - 1], last = t->first[dim];
  PetscCall(PetscMalloc1(mesh->num_cells, &p->part));
  PetscCall(ForestCoarseParts(mesh, &num_parts, p->part));
  PetscCall(PetscCalloc1(last - first, &inner));
  for (PetscInt f = first; f < last; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - first);
    if (leaf[0] < 0 || leaf[1] >= 0 || t->parent[f] >= first) inner[f - first] = PETSC_TRUE;
    if (t->parent[f] >= first) inner[t->parent[f] - first] = PETSC_TRUE; /* finer cells on its other side */
  }
  for (PetscInt f = first; f < last; ++f) num += !inner[f - first];
  PetscCall(PetscMalloc1(num, &part));
  PetscCall(PetscMalloc1(dim * corners * num, &X));
  num = 0;
  for (PetscInt f = first; f < last; ++f) {
    const PetscInt leaf = t->facet_leaf[2 * (f - first)];
    if (inner[f - first]) continue;
    PetscCall(SurfaceCorners_Private(p->forest, f, leaf, X + dim * corners * num));
    part[num++] = p->part[t->leaf_root[leaf]];
  }
  PetscCall(PetscFree(inner));
  PetscCall(ContactHullCreate(dim, num, part, X, &p->hull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HullParts_Private(Interface p, const Surface *s, PetscInt **part)
{
  const ForestTables *t = p->tables;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_facets, part));
  for (PetscInt f = 0; f < s->num_facets; ++f) (*part)[f] = p->part[t->leaf_root[s->facet_leaf[f]]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

void HullDepth_Private(Interface p, const Contact *c, PetscReal *deepest)
{
  *deepest = 0;
  if (c->spec->search > 0) return;
  for (PetscInt k = 0; k < 2; ++k) {
    const ContactSurface side = SurfaceAt_Private(&c->side[k], c->side[k].X);
    PetscReal            most;

    ContactHullThickness(p->hull, &side, c->part[k], &most);
    *deepest += 0.5 * most;
  }
}

PetscErrorCode InterfaceUntoldOverlap(Interface p, PetscInt pair, PetscBool reference, PetscReal *depth)
{
  Contact  *c = &p->contacts[pair];
  PetscReal deepest;

  PetscFunctionBegin;
  *depth = 0;
  if (c->tie || c->spec->self) PetscFunctionReturn(PETSC_SUCCESS); /* a surface that may meet itself sees its own far side all along */
  HullDepth_Private(p, c, &deepest);
  if (!(deepest > 0) || c->spec->see_through) PetscFunctionReturn(PETSC_SUCCESS);
  ContactPairSetHull(c->pair, p->hull, c->part[0], c->part[1], 2 * deepest);
  PetscCall(ContactSearch_Private(p, c, reference, 0));
  ContactPairGetUntold(c->pair, depth);
  ContactPairSetHull(c->pair, p->hull, c->part[0], c->part[1], deepest);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, depth, 1, MPIU_REAL, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
