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
   either sign). Infinity: it does not, is straight or concave at first, or there is a shorter one. other[k]: the rim at the other end of the facet. */
static PetscReal Round_Private(PetscInt num, const Rim rim[], const PetscInt other[], PetscInt k, PetscReal sharp, PetscReal most)
{
  const PetscInt from = Neighbour_Private(num, rim, k);
  PetscReal      way = 0, turned = from < 0 ? 0 : PetscMax(0, Turn_Private(&rim[from], &rim[k], PETSC_FALSE));

  for (PetscInt i = 0; i < num && k >= 0 && way < most; ++i) {
    const PetscInt  end    = other[k];
    const PetscReal within = Turn_Private(&rim[k], &rim[end], PETSC_TRUE), length = 0.5 * (rim[k].across + rim[end].across);
    if (i == 0 && within + turned <= 0) break;
    if (within > 0 && turned + within >= sharp) return way + length * PetscMax(0, sharp - turned) / within;
    turned += within;
    way += length;
    k = Neighbour_Private(num, rim, end);
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

/* The opposite vertex or edge of the same facet, rim by rim. */
static PetscErrorCode Opposite_Private(PetscInt places, PetscInt num, const Rim rim[], PetscInt other[])
{
  PetscInt *at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(places * num, &at));
  for (PetscInt k = 0; k < num; ++k) at[places * rim[k].facet + rim[k].place] = k;
  for (PetscInt k = 0; k < num; ++k) other[k] = at[places * rim[k].facet + places - 1 - rim[k].place];
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneSide(Forest forest, PetscInt group, SideShape *shape)
{
  const PetscInt dim = ForestGetTables(forest)->dim, places = dim == 2 ? 3 : 9;
  PetscInt       num, *other;
  Rim           *rim;

  PetscFunctionBegin;
  *shape = (SideShape){.corner = PETSC_INFINITY};
  PetscCall(SceneRims(forest, group, &num, &rim));
  PetscCall(PetscMalloc1(num, &other));
  PetscCall(Opposite_Private(places, num, rim, other));
  for (PetscInt k = 0; k < num; ++k) {
    if (dim == 3 && rim[k].place % 2 == 0) continue; /* a vertex of a facet in space */
    const PetscInt next = Neighbour_Private(num, rim, k);
    shape->longest      = PetscMax(shape->longest, rim[k].length);
    shape->hollow       = PetscMax(shape->hollow, -Turn_Private(&rim[k], &rim[other[k]], PETSC_TRUE));
    if (dim == 2 && IsSharp_Private(num, rim, k)) shape->corner = PetscMin(shape->corner, PetscMax(rim[k].length, rim[next].length));
  }
  PetscCall(PetscFree(other));
  PetscCall(PetscFree(rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneRounded(Forest forest, PetscInt group, PetscReal angle, PetscReal *way)
{
  const PetscInt dim = ForestGetTables(forest)->dim, places = dim == 2 ? 3 : 9;
  PetscInt       num, *other;
  Rim           *rim;

  PetscFunctionBegin;
  *way = PETSC_INFINITY;
  PetscCall(SceneRims(forest, group, &num, &rim));
  PetscCall(PetscMalloc1(num, &other));
  PetscCall(Opposite_Private(places, num, rim, other));
  for (PetscInt k = 0; k < num; ++k) {
    if ((dim == 2 || rim[k].place % 2) && !IsSharp_Private(num, rim, k)) *way = PetscMin(*way, Round_Private(num, rim, other, k, angle, *way));
  }
  PetscCall(PetscFree(other));
  PetscCall(PetscFree(rim));
  PetscFunctionReturn(PETSC_SUCCESS);
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

PetscErrorCode SceneHeld(Forest forest, PetscInt group, PetscInt num_boundaries, const BoundarySpec boundary[], PetscReal *share)
{
  PetscInt num, held = 0;
  Rim     *rim;

  PetscFunctionBegin;
  PetscCall(SceneRims(forest, group, &num, &rim));
  for (PetscInt k = 0; k < num; ++k) held += IsHeld_Private(num_boundaries, boundary, &rim[k]);
  *share = num ? (PetscReal)held / (PetscReal)num : 0;
  PetscCall(PetscFree(rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}
