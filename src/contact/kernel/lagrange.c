/* Lagrange functions on Gauss-Lobatto lattices of [-1, 1]^m with derivatives up to the third, and the lattices of surfaces. */
#include "kernelimpl.h"

#define NODES (RAY_ORDER + 4) /* rows of functions, filled up with zeros to whole vectors */

static PetscReal Monomial[RAY_ORDER + 1][RAY_ORDER + 1][NODES]; /* [order][power][function]; good to 1e-13 up to order 8 */

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

/* v[0..depth][order + 1]: values and derivatives, by Horner's rule. */
static inline void Horner_Private(int width, PetscInt order, PetscReal x, int depth, PetscReal v[4][NODES])
{
  for (int k = 0; k <= depth; k++)
    for (int a = 0; a < width; a++) v[k][a] = 0;
  for (PetscInt power = order; power >= 0; power--) {
    for (int k = depth; k > 0; k--)
      for (int a = 0; a < width; a++) v[k][a] = v[k][a] * x + k * v[k - 1][a];
    for (int a = 0; a < width; a++) v[0][a] = v[0][a] * x + Monomial[order][power][a];
  }
}

static inline void Line_Private(int width, PetscInt order, PetscReal x, int depth, PetscReal v[4][NODES])
{
  const PetscReal at = PetscMax(-1, PetscMin(1, x)), beyond = x - at;

  Horner_Private(width, order, at, depth, v);
  if (beyond == 0) return;
  for (PetscInt a = 0; a <= order; a++) v[0][a] += beyond * v[1][a];
  for (int k = 2; k <= depth; k++)
    for (int a = 0; a < width; a++) v[k][a] = 0;
}

/* to[j][i] = u_i w_j: rows follow one another, each overwrites what the last wrote beyond its end */
static inline void Product_Private(int width, PetscInt order, const PetscReal u[], const PetscReal w[], PetscReal to[restrict])
{
  for (PetscInt j = 0; j <= order; j++)
    for (int i = 0; i < width; i++) to[j * (order + 1) + i] = u[i] * w[j];
}

static inline void Functions_Private(int width, PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *f)
{
  PetscReal u[4][NODES], w[4][NODES];

  Line_Private(width, order, xi[0], depth, u);
  if (m == 1) {
    PetscReal *to[4] = {f->N, f->d[0], f->dd[0], f->ddd[0]};

    for (int k = 0; k <= depth; k++)
      for (int a = 0; a < width; a++) to[k][a] = u[k][a];
    return;
  }
  Line_Private(width, order, xi[1], depth, w);
  Product_Private(width, order, u[0], w[0], f->N);
  for (int k = 0; k < 2; k++) Product_Private(width, order, u[1 - k], w[k], f->d[k]);
  for (int k = 0; k < 3 && depth > 1; k++) Product_Private(width, order, u[2 - k], w[k], f->dd[k]);
  for (int k = 0; k < 4 && depth > 2; k++) Product_Private(width, order, u[3 - k], w[k], f->ddd[k]);
}

void ContactRayFunctions(PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *f)
{
  if (order < 4)
    Functions_Private(4, m, order, xi, depth, f);
  else
    Functions_Private(NODES, m, order, xi, depth, f);
}

void ContactRayLatticeSum(const RayLattice *l, const PetscReal f[], PetscReal v[3])
{
  PetscReal sum[4] = {0, 0, 0, 0};

  for (PetscInt a = 0; a < l->num; a++)
    for (int c = 0; c < 4; c++) sum[c] += f[a] * l->x[a][c];
  for (int c = 0; c < 3; c++) v[c] = sum[c];
}

void ContactRayLatticeGather(const ContactSurface *s, PetscInt facet, RayLattice *l)
{
  FacetLattice at;

  ContactFacetLattice(s, facet, &at);
  l->order = at.order, l->num = at.num;
  for (PetscInt a = 0; a < l->num; a++)
    for (PetscInt c = 0; c < 4; c++) l->x[a][c] = c < s->dim ? s->x[s->dim * at.node[a] + c] : 0;
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
