/* The overlap of two convex quadrilaterals in a plane: the mortar facet is cut by the four lines of the nonmortar facet, one after the other [Sutherland &
   Hodgman 1974]. Sides remember the line they lie on, and vertices are intersections of two lines: that says how they move.

   A vertex within CONTACT_ROUND of a line counts as outside of it. So where sides coincide, or a corner lies on a side, the vertices of the overlap are those
   of the nonmortar facet or slide along its sides, and the cover of the facet stays what it is when the mortar side moves a little: what one mortar facet would
   lose its neighbour gains, and neither would show if the sliver between were dropped on one side only. */
#include "kernelimpl.h"

static inline const PetscReal *LineStart_Private(const Overlap *o, int line)
{
  return o->side[line / 4].Y[line % 4];
}
static inline const PetscReal *LineEnd_Private(const Overlap *o, int line)
{
  return o->side[line / 4].Y[(line + 1) % 4];
}

/* The ends of a line in an order that is the same for both facets it belongs to: so they have the same crossing, which rounding moves far along lines that meet
   at a small angle. */
static void Ends_Private(const Overlap *o, int line, const PetscReal **from, const PetscReal **to)
{
  const PetscReal *a = LineStart_Private(o, line), *b = LineEnd_Private(o, line);
  const PetscBool  swap = (PetscBool)(a[0] > b[0] || (a[0] == b[0] && a[1] > b[1]));

  *from = swap ? b : a;
  *to   = swap ? a : b;
}

/* Where two lines meet: neighbouring sides of one facet at its corner. near: the place on the side that is cut, which holds when the lines are so close to each
   other that they meet elsewhere: one end of the side is off the line by a little more than CONTACT_ROUND, the other by a little less. */
static void Meet_Private(const Overlap *o, int a, int b, const PetscReal near[2], PetscReal size, PetscReal v[2])
{
  if (a / 4 == b / 4 && (a - b) % 2) {
    const PetscReal *y = o->side[a / 4].Y[(a + 1) % 4 == b % 4 ? b % 4 : a % 4];

    v[0] = y[0], v[1] = y[1];
    return;
  }
  const PetscReal *p, *q, *P, *Q;

  Ends_Private(o, PetscMin(a, b), &p, &P);
  Ends_Private(o, PetscMax(a, b), &q, &Q);
  const PetscReal d[2] = {P[0] - p[0], P[1] - p[1]}, e[2] = {Q[0] - q[0], Q[1] - q[1]}, r[2] = {q[0] - p[0], q[1] - p[1]}, det = Cross2(d, e);

  if (PetscAbsReal(det) <= CONTACT_ROUND * PetscSqrtReal(Dot2(d, d) * Dot2(e, e))) {
    v[0] = near[0], v[1] = near[1];
    return;
  }
  for (int i = 0; i < 2; i++) v[i] = p[i] + Cross2(r, e) / det * d[i];
  if (PetscMax(PetscAbsReal(v[0] - near[0]), PetscAbsReal(v[1] - near[1])) > CONTACT_GRAZE * size) v[0] = near[0], v[1] = near[1];
}

static PetscReal Area_Private(const Overlap *o)
{
  PetscReal sum = 0;

  for (PetscInt k = 1; k + 1 < o->num; k++) {
    const PetscReal d[2] = {o->v[k][0] - o->v[0][0], o->v[k][1] - o->v[0][1]}, e[2] = {o->v[k + 1][0] - o->v[0][0], o->v[k + 1][1] - o->v[0][1]};

    sum += 0.5 * Cross2(d, e);
  }
  return sum;
}

/* Keep what lies inside nonmortar line i. False: more corners than there is room for, which takes a quadrilateral that is not convex. */
static PetscBool Cut_Private(Overlap *o, int i, PetscReal size)
{
  const PetscReal *p = LineStart_Private(o, i), *P = LineEnd_Private(o, i), e[2] = {P[0] - p[0], P[1] - p[1]}, length = PetscSqrtReal(Dot2(e, e));
  PetscReal        d[FACET_VERTICES], v[2 * FACET_VERTICES][2];
  int8_t           line[2 * FACET_VERTICES];
  PetscInt         num = 0;

  for (PetscInt k = 0; k < o->num; k++) {
    const PetscReal r[2] = {o->v[k][0] - p[0], o->v[k][1] - p[1]};

    d[k] = Cross2(e, r) / length;
  }
  for (PetscInt k = 0; k < o->num; k++) {
    const PetscInt  l  = (k + 1) % o->num;
    const PetscBool in = (PetscBool)(d[k] > CONTACT_ROUND * size), next = (PetscBool)(d[l] > CONTACT_ROUND * size);

    if (in) {
      v[num][0] = o->v[k][0], v[num][1] = o->v[k][1];
      line[num++] = o->line[k];
    }
    if (in != next) {
      const PetscReal share   = PetscMax(0, PetscMin(1, d[k] / (d[k] - d[l]))),
                      near[2] = {o->v[k][0] + share * (o->v[l][0] - o->v[k][0]), o->v[k][1] + share * (o->v[l][1] - o->v[k][1])};

      Meet_Private(o, in ? o->line[k] : i, in ? i : o->line[k], near, size, v[num]);
      line[num++] = in ? (int8_t)i : o->line[k];
    }
  }
  o->num = num;
  if (num > FACET_VERTICES) return PETSC_FALSE;
  for (PetscInt k = 0; k < num; k++) {
    o->v[k][0] = v[k][0], o->v[k][1] = v[k][1];
    o->line[k] = line[k];
  }
  return PETSC_TRUE;
}

PetscBool ContactClip(Overlap *o, PetscReal size)
{
  o->num = 4;
  for (int k = 0; k < 4; k++) {
    o->v[k][0] = o->side[1].Y[k][0], o->v[k][1] = o->side[1].Y[k][1];
    o->line[k] = (int8_t)(4 + k);
  }
  for (int i = 0; i < 4 && o->num; i++)
    if (!Cut_Private(o, i, size)) return PETSC_FALSE;
  if (o->num < 3) return PETSC_FALSE;
  o->area = Area_Private(o);
  return o->area > PetscSqr(CONTACT_ROUND * size) ? PETSC_TRUE : PETSC_FALSE;
}
