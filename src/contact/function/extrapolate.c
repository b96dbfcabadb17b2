/* Where functions of nodes that carry no multiplier go: weights of a polynomial extrapolation from nodes that carry to those that do not.

   Lattice on which nothing hangs. To node e along the lattice line through e that has more nodes that carry, from the degree + 1 nearest of them; both lines
   alike (a lone corner): half each. Neither line has any (corner of two held sides): along the first direction to the line's nodes whose second line has some,
   then along those: products.

   Other sets of nodes: w with sum_k w_k q(X_k) = q(X_e) for polynomials q of that degree in the plane of the facets' mean normal, and least
   sum_k |X_k - X_e|^2 w_k^2; a lower degree where nodes do not determine one. */
#include "functionimpl.h"

typedef struct {
  PetscInt         order, n, directions, degree; /* n = order + 1 */
  const PetscBool *carries;                      /* [n^directions] */
  const PetscReal *point;                        /* [n] */
} Grid;

/* Lagrange weights w[n] at point `at` from the degree + 1 nearest points in use. */
static void Line_Private(const Grid *g, PetscInt at, const PetscBool use[], PetscReal w[])
{
  PetscInt  chosen[MORTISE_MAX_ORDER + 1], num = 0;
  PetscBool taken[MORTISE_MAX_ORDER + 1] = {PETSC_FALSE};

  for (PetscInt round = 0; round <= g->degree; round++) {
    PetscInt best = -1;

    for (PetscInt k = 0; k < g->n; k++) {
      if (!use[k] || taken[k]) continue;
      if (best < 0 || PetscAbsReal(g->point[k] - g->point[at]) < PetscAbsReal(g->point[best] - g->point[at])) best = k;
    }
    if (best < 0) break;
    taken[best]   = PETSC_TRUE;
    chosen[num++] = best;
  }
  for (PetscInt k = 0; k < g->n; k++) w[k] = 0;
  for (PetscInt i = 0; i < num; i++) {
    w[chosen[i]] = 1;
    for (PetscInt k = 0; k < num; k++) {
      if (k != i) w[chosen[i]] *= (g->point[at] - g->point[chosen[k]]) / (g->point[chosen[i]] - g->point[chosen[k]]);
    }
  }
}

/* Which nodes of the line through e in direction d carry; returns their number. */
static PetscInt LineUse_Private(const Grid *g, PetscInt e, PetscInt d, PetscBool use[])
{
  const PetscInt stride = d ? g->n : 1, start = e - stride * (d ? e / g->n : e % g->n);
  PetscInt       num = 0;

  for (PetscInt k = 0; k < g->n; k++) num += use[k] = g->carries[start + stride * k];
  return num;
}

/* w += share * weights of node e along direction d. */
static void AddLine_Private(const Grid *g, PetscInt e, PetscInt d, PetscReal share, PetscReal w[])
{
  const PetscInt stride = d ? g->n : 1, at = d ? e / g->n : e % g->n;
  PetscBool      use[MORTISE_MAX_ORDER + 1];
  PetscReal      line[MORTISE_MAX_ORDER + 1];

  (void)LineUse_Private(g, e, d, use);
  Line_Private(g, at, use, line);
  for (PetscInt k = 0; k < g->n; k++) w[e + stride * (k - at)] += share * line[k];
}

static void AddProduct_Private(const Grid *g, PetscInt e, PetscReal w[])
{
  const PetscInt at = e % g->n;
  PetscBool      use[MORTISE_MAX_ORDER + 1], other[MORTISE_MAX_ORDER + 1];
  PetscReal      line[MORTISE_MAX_ORDER + 1];

  for (PetscInt k = 0; k < g->n; k++) use[k] = (PetscBool)(LineUse_Private(g, e - at + k, 1, other) > 0);
  Line_Private(g, at, use, line);
  for (PetscInt k = 0; k < g->n; k++)
    if (use[k]) AddLine_Private(g, e - at + k, 1, line[k], w);
}

PetscErrorCode ContactExtrapolateLattice(PetscInt dim, PetscInt order, PetscInt degree, const PetscBool carries[], PetscReal W[])
{
  Grid           g   = {.order = order, .n = order + 1, .directions = dim - 1, .degree = degree, .carries = carries};
  const PetscInt num = ElementNumNodes(dim - 1, order);
  PetscBool      use[MORTISE_MAX_ORDER + 1];

  PetscFunctionBegin;
  PetscCall(ElementGetNodes(order, &g.point));
  for (PetscInt e = 0; e < num; e++) {
    PetscInt count[2] = {0, 0};

    if (carries[e]) continue;
    PetscCall(PetscArrayzero(W + num * e, num));
    for (PetscInt d = 0; d < g.directions; d++) count[d] = PetscMin(degree + 1, LineUse_Private(&g, e, d, use));
    if (PetscMax(count[0], count[1]) == 0) AddProduct_Private(&g, e, W + num * e);
    for (PetscInt d = 0; d < g.directions; d++)
      if (count[d] > 0 && count[d] >= count[1 - d]) AddLine_Private(&g, e, d, count[0] == count[1] ? 0.5 : 1, W + num * e);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places of nodes in [0, 1]^2 of the plane normal to the facets' mean normal. */
static void Places_Private(const ContactSurface *s, PetscInt num_facets, const PetscInt facets[], PetscInt n, const PetscInt node[], PetscReal place[][2])
{
  PetscReal N[3] = {0, 0, 0}, axis[2][3], low[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, high[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}, size;
  PetscInt  c = 0;

  for (PetscInt f = 0; f < num_facets; f++) {
    PetscReal part[3];

    ContactFacetVector(3, s->X, s->facets + 4 * facets[f], part);
    for (int k = 0; k < 3; k++) N[k] += part[k];
  }
  for (int k = 1; k < 3; k++)
    if (PetscAbsReal(N[k]) < PetscAbsReal(N[c])) c = k;
  Cross3((const PetscReal[3]){c == 0, c == 1, c == 2}, N, axis[0]);
  Cross3(N, axis[0], axis[1]);
  for (int d = 0; d < 2; d++) {
    const PetscReal length = PetscSqrtReal(Dot3(axis[d], axis[d]));

    for (PetscInt i = 0; i < n; i++) {
      place[i][d] = Dot3(axis[d], s->X + 3 * node[i]) / length;
      low[d]      = PetscMin(low[d], place[i][d]);
      high[d]     = PetscMax(high[d], place[i][d]);
    }
  }
  size = PetscMax(high[0] - low[0], high[1] - low[1]);
  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < 2; d++) place[i][d] = (place[i][d] - low[d]) / size;
}

/* Polynomials of total degree <= degree at a place; returns their number. */
static PetscErrorCode Polynomials_Private(PetscInt degree, const PetscReal place[2], PetscReal value[], PetscInt *num)
{
  PetscReal L[2][MORTISE_MAX_ORDER + 1];

  PetscFunctionBegin;
  *num = 0;
  for (int d = 0; d < 2; d++) PetscCall(ElementLegendre(degree, place[d], L[d], NULL));
  for (PetscInt i = 0; i <= degree; i++)
    for (PetscInt k = 0; k <= degree - i; k++) value[(*num)++] = L[0][i] * L[1][k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w = R^-1 C^T [C R^-1 C^T]^-1 c; C[n][num]: polynomials at the nodes, R: squared distances. False: the nodes do not determine polynomials of that degree. */
static PetscErrorCode Fit_Private(PetscInt degree, PetscInt n, const PetscReal place[][2], const PetscBool carries[], PetscInt e, PetscReal w[],
                                  PetscBool *regular)
{
  PetscReal C[MULTIPLIER_LATTICE], c[MULTIPLIER_LATTICE], G[MULTIPLIER_LATTICE * MULTIPLIER_LATTICE / 4], sum = 0;
  PetscInt  num;

  PetscFunctionBegin;
  PetscCall(Polynomials_Private(degree, place[e], c, &num));
  PetscCall(PetscArrayzero(G, num * num));
  PetscCall(PetscArrayzero(w, n));
  for (PetscInt k = 0; k < n; k++) {
    if (!carries[k]) continue;
    w[k] = 1 / (PetscSqr(place[k][0] - place[e][0]) + PetscSqr(place[k][1] - place[e][1]) + PETSC_SQRT_MACHINE_EPSILON);
    PetscCall(Polynomials_Private(degree, place[k], C, &num));
    for (PetscInt i = 0; i < num; i++)
      for (PetscInt l = 0; l < num; l++) G[num * i + l] += w[k] * C[i] * C[l];
  }
  PetscCall(ContactSolveSymmetric(num, G, 1, c, regular));
  for (PetscInt k = 0; *regular && k < n; k++) {
    PetscReal value = 0;

    PetscCall(Polynomials_Private(degree, place[k], C, &num));
    for (PetscInt i = 0; i < num; i++) value += C[i] * c[i];
    w[k] *= value;
    sum += w[k];
  }
  for (PetscInt k = 0; *regular && k < n; k++) w[k] /= sum; /* sum is 1 up to round-off */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactExtrapolateNodes(const ContactSurface *s, PetscInt num_facets, const PetscInt facets[], PetscInt degree, PetscInt n,
                                       const PetscInt node[], const PetscBool carries[], PetscReal W[])
{
  PetscReal(*place)[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &place));
  Places_Private(s, num_facets, facets, n, node, place);
  for (PetscInt e = 0; e < n; e++) {
    PetscBool regular = PETSC_FALSE;

    if (carries[e]) continue;
    for (PetscInt d = degree; d >= 0 && !regular; d--) PetscCall(Fit_Private(d, n, place, carries, e, W + n * e, &regular));
    PetscCheck(regular, PETSC_COMM_SELF, PETSC_ERR_PLIB, "no node to extrapolate from");
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}
