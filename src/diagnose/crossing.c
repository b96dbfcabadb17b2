/* When does a point go through a straight piece of a surface while it and the corners of the piece move on straight lines? Its height above the plane of the
   piece, times the area, is a polynomial of the way, of second order in the plane and of third in space. */
#include "diagnoseimpl.h"

#define ROUND 1e-9  /* of a piece, by which it is larger than it is: what goes through a corner goes through the surface, too */
#define HALVINGS 60 /* of an interval of length 2 at most: to the last digit */

/* Edges from the first corner (in the plane the second one is the axis out of it), and from there to y. */
static void Frame_Private(PetscInt dim, const PetscReal x[9], const PetscReal y[3], PetscReal e[3], PetscReal f[3], PetscReal r[3])
{
  for (PetscInt c = 0; c < 3; ++c) {
    e[c] = x[3 + c] - x[c];
    f[c] = dim == 3 ? x[6 + c] - x[c] : (PetscReal)(c == 2);
    r[c] = y[c] - x[c];
  }
}

static void Between_Private(PetscInt num, const PetscReal a[], const PetscReal b[], PetscReal s, PetscReal x[])
{
  for (PetscInt i = 0; i < num; ++i) x[i] = (1 - s) * a[i] + s * b[i];
}

void MovingNormal_Private(PetscInt dim, const PetscReal x[2][9], PetscReal s, PetscReal N[3])
{
  PetscReal at[9], e[3], f[3], r[3], length;

  Between_Private(9, x[0], x[1], s, at);
  Frame_Private(dim, at, at, e, f, r);
  Cross3(e, f, N);
  length = PetscSqrtReal(Dot3(N, N));
  for (PetscInt c = 0; c < 3; ++c) N[c] /= length > 0 ? length : 1;
}

/* The height times the length of e x f: c[0] + c[1] s + c[2] s^2 + c[3] s^3. */
static void Height_Private(PetscInt dim, const PetscReal x[2][9], const PetscReal y[2][3], PetscReal c[4])
{
  PetscReal e[2][3], f[2][3], r[2][3], n[4][3];

  for (PetscInt k = 0; k < 2; ++k) Frame_Private(dim, x[k], y[k], e[k], f[k], r[k]);
  for (PetscInt i = 0; i < 3; ++i) {
    e[1][i] -= e[0][i];
    f[1][i] -= f[0][i];
    r[1][i] -= r[0][i];
  }
  for (PetscInt k = 0; k < 4; ++k) Cross3(e[k / 2], f[k % 2], n[k]);
  for (PetscInt i = 0; i < 3; ++i) n[1][i] += n[2][i];
  c[0] = Dot3(n[0], r[0]);
  c[1] = Dot3(n[1], r[0]) + Dot3(n[0], r[1]);
  c[2] = Dot3(n[3], r[0]) + Dot3(n[1], r[1]);
  c[3] = Dot3(n[3], r[1]);
}

static PetscReal Value_Private(const PetscReal c[4], PetscReal s)
{
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

/* Where in (-1, 1) it changes its sign, between the places where it turns; up[i]: to a positive one. */
static PetscInt Roots_Private(const PetscReal c[4], PetscReal s[3], PetscBool up[3])
{
  const PetscReal a = 3 * c[3], b = c[2], d = b * b - a * c[1]; /* of the derivative a s^2 + 2 b s + c[1] */
  PetscReal       turn[4] = {-1};
  PetscInt        num = 0, last = 1;

  if (d > 0) {
    const PetscReal q = -(b + (b < 0 ? -1 : 1) * PetscSqrtReal(d)), one = PetscMin(q / a, c[1] / q), two = PetscMax(q / a, c[1] / q);
    if (one > -1 && one < 1) turn[last++] = one;
    if (two > -1 && two < 1) turn[last++] = two;
  }
  turn[last] = 1;
  for (PetscInt i = 0; i < last; ++i) {
    PetscReal       lo = turn[i], hi = turn[i + 1];
    const PetscBool below = (PetscBool)(Value_Private(c, lo) < 0);
    if (below == (PetscBool)(Value_Private(c, hi) < 0)) continue;
    for (PetscInt k = 0; k < HALVINGS; ++k) {
      const PetscReal at = (lo + hi) / 2;
      if ((PetscBool)(Value_Private(c, at) < 0) == below)
        lo = at;
      else
        hi = at;
    }
    up[num]  = below;
    s[num++] = hi;
  }
  return num;
}

/* Is y, in the plane of the piece at s, on it? */
static PetscBool IsOn_Private(PetscInt dim, const PetscReal x[2][9], const PetscReal y[2][3], PetscReal s)
{
  PetscReal at[9], to[3], e[3], f[3], r[3], n[3], q[3];

  Between_Private(9, x[0], x[1], s, at);
  Between_Private(3, y[0], y[1], s, to);
  Frame_Private(dim, at, to, e, f, r);
  if (dim == 2) return (PetscBool)(Dot3(r, e) >= -ROUND * Dot3(e, e) && Dot3(r, e) <= (1 + ROUND) * Dot3(e, e));
  Cross3(e, f, n);
  Cross3(r, f, q);
  const PetscReal all = Dot3(n, n), u = Dot3(q, n);
  Cross3(e, r, q);
  const PetscReal v = Dot3(q, n);
  return (PetscBool)(u >= -ROUND * all && v >= -ROUND * all && u + v <= (1 + ROUND) * all);
}

PetscInt CrossingsFind_Private(PetscInt dim, const PetscReal x[2][9], const PetscReal y[2][3], Crossing crossing[3])
{
  PetscReal c[4], s[3];
  PetscBool up[3];
  PetscInt  num = 0;

  Height_Private(dim, x, y, c);
  const PetscInt all = Roots_Private(c, s, up);
  for (PetscInt i = 0; i < all; ++i) {
    if (!IsOn_Private(dim, x, y, s[i])) continue;
    crossing[num] = (Crossing){.s = s[i], .out = up[i]};
    MovingNormal_Private(dim, x, s[i], crossing[num++].N);
  }
  return num;
}
