/* Corners and rounded edges of contact sides and what supports hold of them, by which roles are chosen (check.c): sharp convex corners in the plane, and how
   short the way is within which a surface turns by the angle of one. A facet of the other side that is as long would wrap round it. In space ways go through
   facets from edge to opposite edge. */
#include "rim.h"

/* The rim of the facet that meets this one in its vertex (plane) or edge (space), where two at most do in an outer surface; -1: there is none. */
static PetscInt Neighbour_Private(PetscInt num, const Rim rim[], PetscInt k)
{
  if (k + 1 < num && rim[k + 1].entity == rim[k].entity) return k + 1;
  return k > 0 && rim[k - 1].entity == rim[k].entity ? k - 1 : -1;
}

/* Angle between two rims, negative where the outline is concave: at a vertex tangents of convex facets point to the inner side of each other, within a facet
   those of its ends to the outer one. */
static PetscReal Turn_Private(const Rim *a, const Rim *b, PetscBool within)
{
  const PetscReal angle = acos(PetscMax(-1, PetscMin(1, Dot3(a->N, b->N)))), out = Dot3(a->N, b->T);

  return angle <= ROUND_LENGTH ? 0 : (within ? out < 0 : out > 0) ? -angle : angle;
}

/* From the end k of a facet on along the outline: the way within which it turns by the angle sharp, all in all (arcs of a high order meet in kinks of
   either sign). Infinity: it does not, is straight or concave at first, or there is a shorter one. */
static PetscReal Round_Private(const SideShape *s, PetscInt k, PetscReal sharp, PetscReal most)
{
  const Rim     *rim  = s->rim;
  const PetscInt from = Neighbour_Private(s->num, rim, k);
  PetscReal      way = 0, turned = from < 0 ? 0 : PetscMax(0, Turn_Private(&rim[from], &rim[k], PETSC_FALSE));

  for (PetscInt i = 0; i < s->num && k >= 0 && way < most; ++i) {
    const PetscInt  end    = s->other[k];
    const PetscReal within = Turn_Private(&rim[k], &rim[end], PETSC_TRUE), length = 0.5 * (rim[k].across + rim[end].across);
    if (i == 0 && within + turned <= 0) break;
    if (within > 0 && turned + within >= sharp) return way + length * PetscMax(0, sharp - turned) / within;
    turned += within;
    way += length;
    k = Neighbour_Private(s->num, rim, end);
    if (k < 0) break;
    turned += Turn_Private(&rim[end], &rim[k], PETSC_FALSE);
    if (turned >= sharp) return way;
  }
  return PETSC_INFINITY;
}

/* Does a facet meet its neighbour at the angle of a corner? */
static PetscBool IsSharp_Private(PetscInt num, const Rim rim[], PetscInt k)
{
  const PetscInt next = Neighbour_Private(num, rim, k);
  return (PetscBool)(next >= 0 && Turn_Private(&rim[k], &rim[next], PETSC_FALSE) >= acos(CONTACT_SHARP));
}

/* Do supports hold the normal of a facet at its rim? */
static PetscBool IsHeld_Private(PetscInt num, const BoundarySpec boundary[], const Rim *r)
{
  PetscBool fix[3] = {PETSC_FALSE, PETSC_FALSE, PETSC_FALSE};
  PetscReal held   = 0;

  for (PetscInt b = 0; b < num; ++b) {
    if (!(r->groups >> boundary[b].group & 1)) continue;
    if (boundary[b].fix_normal || boundary[b].rotation) return PETSC_TRUE;
    for (PetscInt c = 0; c < 3; ++c) fix[c] = (PetscBool)(fix[c] || boundary[b].fix[c] || boundary[b].displacement[c]);
  }
  for (PetscInt c = 0; c < 3; ++c)
    if (fix[c]) held += PetscSqr(r->N[c]);
  return (PetscBool)(held > 0.5);
}

/* The opposite vertex or edge of the same facet, rim by rim. */
static PetscErrorCode Opposite_Private(SideShape *s, PetscInt places)
{
  const PetscInt num_facets = s->num / (places - 1);
  PetscInt      *at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num, &s->other));
  PetscCall(PetscMalloc1(places * num_facets, &at));
  for (PetscInt k = 0; k < s->num; ++k) at[places * s->rim[k].facet + s->rim[k].place] = k;
  for (PetscInt k = 0; k < s->num; ++k) s->other[k] = at[places * s->rim[k].facet + places - 1 - s->rim[k].place];
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SideShapeCreate(Forest forest, PetscInt group, PetscInt num_boundaries, const BoundarySpec boundary[], SideShape *s)
{
  const PetscInt dim  = ForestGetTables(forest)->dim;
  PetscInt       held = 0;

  PetscFunctionBegin;
  *s = (SideShape){.corner = PETSC_INFINITY};
  PetscCall(SceneRims(forest, group, &s->num, &s->rim));
  PetscCall(Opposite_Private(s, dim == 2 ? 3 : 9));
  for (PetscInt k = 0; k < s->num; ++k) {
    const Rim     *r    = &s->rim[k];
    const PetscInt next = Neighbour_Private(s->num, s->rim, k);
    held += IsHeld_Private(num_boundaries, boundary, r);
    s->longest = PetscMax(s->longest, r->length);
    if (r->is_vertex) continue;
    s->hollow = PetscMax(s->hollow, -Turn_Private(r, &s->rim[s->other[k]], PETSC_TRUE));
    if (dim == 2 && IsSharp_Private(s->num, s->rim, k)) s->corner = PetscMin(s->corner, PetscMax(r->length, s->rim[next].length));
  }
  s->held = s->num ? (PetscReal)held / (PetscReal)s->num : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SideShapeDestroy(SideShape *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->rim));
  PetscCall(PetscFree(s->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SideShapeRounded(const SideShape *s, PetscReal angle)
{
  PetscReal way = PETSC_INFINITY;

  for (PetscInt k = 0; k < s->num; ++k)
    if (!s->rim[k].is_vertex && !IsSharp_Private(s->num, s->rim, k)) way = PetscMin(way, Round_Private(s, k, angle, way));
  return way;
}
