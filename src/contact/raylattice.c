/* Lagrange functions on Gauss-Lobatto lattices of [-1, 1]^m with derivatives up to the third, and the lattices of surfaces. */
#include "rayimpl.h"

#define NODES (RAY_ORDER + 1)

static PetscReal Monomial[RAY_ORDER + 1][NODES][NODES]; /* [order][power][function]; good to 1e-13 up to order 8 */

PetscErrorCode ContactRayLatticePrepare(void)
{
  PetscFunctionBegin;
  if (Monomial[1][0][0] != 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt order = 1; order <= RAY_ORDER; order++) {
    const PetscReal *node;

    PetscCall(ElementGetNodes(order, &node));
    for (PetscInt a = 0; a <= order; a++) {
      PetscReal c[NODES + 1] = {1};

      for (PetscInt b = 0, degree = 0; b <= order; b++) {
        const PetscReal x = 2 * node[b] - 1, over = a == b ? 1 : 1 / (2 * (node[a] - node[b]));

        if (a == b) continue;
        for (PetscInt k = ++degree; k >= 0; k--) c[k] = ((k ? c[k - 1] : 0) - x * c[k]) * over;
      }
      for (PetscInt k = 0; k <= order; k++) Monomial[order][k][a] = c[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* v[0..3][order + 1]: values and derivatives. */
static void Line_Private(PetscInt order, PetscReal x, PetscReal v[4][NODES])
{
  const PetscReal at = PetscMax(-1, PetscMin(1, x)), beyond = x - at;

  if (order == 1) {
    v[0][0] = 0.5 * (1 - x), v[0][1] = 0.5 * (1 + x);
    v[1][0] = -0.5, v[1][1] = 0.5;
    v[2][0] = v[2][1] = v[3][0] = v[3][1] = 0;
    return;
  }
  for (int k = 0; k < 4; k++)
    for (PetscInt a = 0; a <= order; a++) v[k][a] = 0;
  for (PetscInt power = order; power >= 0; power--)
    for (PetscInt a = 0; a <= order; a++) {
      v[3][a] = v[3][a] * at + 3 * v[2][a];
      v[2][a] = v[2][a] * at + 2 * v[1][a];
      v[1][a] = v[1][a] * at + v[0][a];
      v[0][a] = v[0][a] * at + Monomial[order][power][a];
    }
  if (beyond == 0) return;
  for (PetscInt a = 0; a <= order; a++) {
    v[0][a] += beyond * v[1][a];
    v[2][a] = v[3][a] = 0;
  }
}

void ContactRayFunctions(PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *f)
{
  PetscReal u[4][NODES], w[4][NODES];
  PetscInt  n = 0;

  Line_Private(order, xi[0], u);
  if (m == 1) {
    for (PetscInt a = 0; a <= order; a++) {
      f->N[a]    = u[0][a];
      f->d[0][a] = u[1][a];
      if (depth > 1) f->dd[0][a] = u[2][a];
      if (depth > 2) f->ddd[0][a] = u[3][a];
    }
    return;
  }
  Line_Private(order, xi[1], w);
  for (PetscInt j = 0; j <= order; j++)
    for (PetscInt i = 0; i <= order; i++, n++) {
      f->N[n]    = u[0][i] * w[0][j];
      f->d[0][n] = u[1][i] * w[0][j];
      f->d[1][n] = u[0][i] * w[1][j];
      for (int k = 0; k < 3 && depth > 1; k++) f->dd[k][n] = u[2 - k][i] * w[k][j];
      for (int k = 0; k < 4 && depth > 2; k++) f->ddd[k][n] = u[3 - k][i] * w[k][j];
    }
}

void ContactRayLatticeSum(const RayLattice *l, const PetscReal f[], PetscReal v[3])
{
  v[0] = v[1] = v[2] = 0;
  for (PetscInt a = 0; a < l->num; a++)
    for (int c = 0; c < 3; c++) v[c] += f[a] * l->x[a][c];
}

/* Nodes of a facet on its lattice; order1: room for those of a facet without one. Returns the order. */
PetscInt ContactRayLatticeNodes(const ContactSurface *s, PetscInt facet, const PetscInt **nodes, PetscInt order1[4])
{
  const PetscInt nv = s->dim == 2 ? 2 : 4;

  if (s->order) {
    *nodes = s->lattice + s->first[facet];
    return s->order[facet];
  }
  for (PetscInt k = 0; k < nv; k++) order1[k] = s->facets[nv * facet + (k < 2 ? k : 5 - k)];
  *nodes = order1;
  return 1;
}

void ContactRayLatticeGather(const ContactSurface *s, PetscInt facet, RayLattice *l)
{
  const PetscInt *node;
  PetscInt        order1[4];

  l->order = ContactRayLatticeNodes(s, facet, &node, order1);
  l->num   = ElementNumNodes(s->dim - 1, l->order);
  for (PetscInt a = 0; a < l->num; a++)
    for (PetscInt c = 0; c < 3; c++) l->x[a][c] = c < s->dim ? s->x[s->dim * node[a] + c] : 0;
  if (l->num == 4 && l->order == 1) ContactRayLatticePolynomial(l);
}

void ContactRayLatticePolynomial(RayLattice *l)
{
  for (int i = 0; i < 3; i++) {
    const PetscReal a = l->x[0][i], b = l->x[1][i], d = l->x[2][i], e = l->x[3][i];

    l->c[0][i] = 0.25 * (a + b + d + e);
    l->c[1][i] = 0.25 * (b - a + e - d);
    l->c[2][i] = 0.25 * (d - a + e - b);
    l->c[3][i] = 0.25 * (a - b - d + e);
  }
}

/* The functions that weigh the gap, from those of the facet's lattice. */
void ContactRayTestFunctions(const RayFacet *f, const RayTest *t, const RayFunctions *own, const PetscReal xi[2], RayFunctions *to)
{
  PetscReal at[2] = {0, 0}, scale[2] = {1, 1};

  if (!t->hats) {
    const size_t size = (size_t)f->s.num * sizeof(PetscReal);

    memcpy(to->N, own->N, size);
    for (PetscInt i = 0; i < f->m; i++) memcpy(to->d[i], own->d[i], size);
    for (PetscInt i = 0; i < 2 * f->m - 1; i++) memcpy(to->dd[i], own->dd[i], size);
    return;
  }
  for (PetscInt i = 0; i < f->m; i++) {
    scale[i] = 2 / t->size[i];
    at[i]    = scale[i] * (xi[i] - t->lo[i]) - 1;
  }
  ContactRayFunctions(f->m, 1, at, 2, to);
  for (PetscInt a = 0; a < t->num; a++) {
    for (PetscInt i = 0; i < f->m; i++) to->d[i][a] *= scale[i];
    if (f->m == 2) to->dd[1][a] *= scale[0] * scale[1];
  }
}
