/* The pieces in which mortar facets are seen.

   Both sides of an edge must have one picture of it, straight from image to image. Where a corner hangs in the middle of a straight edge, that is the line
   between the images of the edge's ends, and the corner is seen in its middle. Where the edge is curved the corner lies as far beside that line as the edge
   bends, often by more than the facets on its finer side are wide, and rays would leave them: it is seen where it is, and the facet on the coarser side in
   pieces, halves or quarters, whose corners are its own, those that hang on its sides, and the middles of the straight lines between. */
#include "kernelimpl.h"

/* Names of images: the mortar node, or beyond the nodes five for each mortar facet, the middles of its sides and of itself. */
static PetscInt Middle_Private(const RayWork w, const ContactSurface *mortar, PetscInt facet, PetscInt side)
{
  const PetscInt hangs = w->mortar_middle[4 * facet + side];

  return hangs >= 0 ? hangs : mortar->num_nodes + 5 * facet + side;
}

/* The images in the middle of which an image lies; -1: it is a mortar node's own. */
void ContactRayParents(const RayWork w, const ContactSurface *mortar, PetscInt name, PetscInt parent[2])
{
  const PetscInt facet = (name - mortar->num_nodes) / 5, k = (name - mortar->num_nodes) % 5;

  for (int e = 0; e < 2; e++) {
    if (name < mortar->num_nodes)
      parent[e] = w->mortar_parent[2 * name + e];
    else
      parent[e] = k < 4 ? mortar->facets[4 * facet + (k + e) % 4] : Middle_Private(w, mortar, facet, 2 * e);
  }
}

/* Corners of the pieces in which a mortar facet is seen, in its own order. Returns their number. */
PetscInt ContactRayPieces(const RayWork w, const ContactSurface *mortar, PetscInt facet, PetscInt corner[4][4])
{
  const PetscInt  nv = w->facet.nv, *c = mortar->facets + nv * facet, *hangs = w->mortar_middle + 4 * facet;
  const PetscBool first = (PetscBool)(nv == 4 && (hangs[0] >= 0 || hangs[2] >= 0)), second = (PetscBool)(nv == 4 && (hangs[1] >= 0 || hangs[3] >= 0));
  PetscInt        at[3][3]; /* the facet's corners and middles, as they lie */

  for (PetscInt k = 0; k < nv; k++) corner[0][k] = c[k];
  if (!first && !second) return 1;
  at[0][0] = c[0], at[0][1] = Middle_Private(w, mortar, facet, 0), at[0][2] = c[1];
  at[1][0] = Middle_Private(w, mortar, facet, 3), at[1][1] = mortar->num_nodes + 5 * facet + 4, at[1][2] = Middle_Private(w, mortar, facet, 1);
  at[2][0] = c[3], at[2][1] = Middle_Private(w, mortar, facet, 2), at[2][2] = c[2];
  for (PetscInt k = 0, u = first ? 1 : 2, v = second ? 1 : 2; k < (first ? 2 : 1) * (second ? 2 : 1); k++) {
    const PetscInt i = first ? k % 2 : 0, j = second ? k / (first ? 2 : 1) : 0;

    corner[k][0] = at[j][i], corner[k][1] = at[j][i + u], corner[k][2] = at[j + v][i + u], corner[k][3] = at[j + v][i];
  }
  return (first ? 2 : 1) * (second ? 2 : 1);
}
