/* Node-to-segment contact, for comparison only: the integrals of an edge of order 1 by the trapezoidal rule. At every node the gap along its ray to the mortar
   edge that this meets, weighted with half of each adjacent edge's length. What a node sees is the overlap that reaches the edge's end; it stands for the
   whole edge and has one point, at that end (ContactRayRule). */
#include "kernelimpl.h"

void ContactNodeHits(RayWork w)
{
  Overlap   hit[2];
  PetscInt  mortar[2];
  PetscBool has[2] = {PETSC_FALSE, PETSC_FALSE};

  for (PetscInt k = 0; k < w->num_overlaps; k++)
    for (int end = 0; end < 2; end++) {
      const Overlap *o = &w->overlap[k];

      if (has[end] || o->line[end] >= 0) continue;
      hit[end] = *o, mortar[end] = w->mortar[k], has[end] = PETSC_TRUE;
    }
  w->num_overlaps = 0;
  for (int end = 0; end < 2; end++) {
    Overlap *o = &w->overlap[w->num_overlaps];

    if (!has[end]) continue;
    *o      = hit[end];
    o->node = end;
    for (int k = 0; k < 4; k++) o->v[k][0] = k == 0 || k == 3 ? w->facet.chart.Y[0][0] : w->facet.chart.Y[1][0];
    o->line[0] = o->line[1]      = -1;
    w->mortar[w->num_overlaps++] = mortar[end];
  }
}
