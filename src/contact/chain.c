/* From the variables of one edge, y = (x_0, x_1, n_0, n_1, mortar nodes), to node positions u = (x_0, x_1, previous, next, mortar nodes):
     g_u = J^T g_y,   H_u = J^T H_y J + sum_i g_(n_i) Hess(n_i),   J = dy/du, identity but for the four rows of the normals. */
#include "contactimpl.h"

/* Column of the 8 nonmortar numbers of u that the normal at node k sees as its number a (previous, node, next). */
static const int NormalColumn[2][6] = {{4, 5, 0, 1, 2, 3}, {0, 1, 2, 3, 6, 7}};

/* Derivatives of both normals and the list of nodes that the result depends on. nodes[4 + num_mortar]: the first *num are set, those of the nonmortar
   side; the caller appends the mortar nodes. */
void ContactChainBuild(ContactPair pair, const ContactSurface *s, PetscInt edge, PetscInt num_mortar, EdgeChain *chain, PetscInt nodes[], PetscInt *num)
{
  const PetscInt a = s->facets[2 * edge], b = s->facets[2 * edge + 1], all[4] = {a, b, pair->prev[a], pair->next[b]};

  *num = 0;
  for (int k = 0; k < 4; k++) {
    chain->column[2 * k] = chain->column[2 * k + 1] = -1;
    if (all[k] < 0) continue;
    for (int i = 0; i < 2; i++) chain->column[2 * k + i] = 2 * *num + i;
    nodes[(*num)++] = all[k];
  }
  chain->num_y = 8 + 2 * num_mortar;
  chain->num_u = 2 * (*num + num_mortar);
  memset(chain->dn, 0, sizeof(chain->dn));
  for (int k = 0; k < 2; k++) {
    ContactNormalDerivative(pair, s, all[k], &chain->normal[k]);
    for (int i = 0; i < 2 && !pair->held; i++)
      for (int p = 0; p < 6; p++) chain->dn[2 * k + i][NormalColumn[k][p]] = chain->normal[k].d[i][p];
  }
}

/* u[num_u] = J^T y[num_y] */
void ContactChainGradient(const EdgeChain *chain, const PetscReal y[], PetscReal u[])
{
  const PetscInt own = chain->num_u - (chain->num_y - 8);

  for (int a = 0; a < 8; a++) {
    PetscReal sum = a < 4 ? y[a] : 0;

    if (chain->column[a] < 0) continue;
    for (int i = 0; i < 4; i++) sum += chain->dn[i][a] * y[4 + i];
    u[chain->column[a]] = sum;
  }
  for (PetscInt k = 8; k < chain->num_y; k++) u[own + k - 8] = y[k];
}

/* The 8 x 8 nonmortar block: [S_xx 0; 0 0] + S_xn dn + transpose + dn^T S_nn dn + sum gradient_n Hess n, S = W + W^T. */
static void NonmortarBlock_Private(const EdgeChain *chain, const PetscReal gradient[], const PetscReal W[], PetscReal H[8][8])
{
  const PetscInt ny = chain->num_y;
  PetscReal      half[8][8], right[4];

  for (int a = 0; a < 8; a++)
    for (int b = 0; b < 8; b++) half[a][b] = a < 4 && b < 4 ? W[a * ny + b] : 0;
  for (int b = 0; b < 8; b++) {
    for (int i = 0; i < 4; i++) { /* x rows: W_xn + W_nx^T; n rows: W_nn */
      PetscReal sum = 0;

      right[i] = 0;
      for (int j = 0; j < 4; j++) {
        sum += (W[i * ny + 4 + j] + W[(4 + j) * ny + i]) * chain->dn[j][b];
        right[i] += W[(4 + i) * ny + 4 + j] * chain->dn[j][b];
      }
      half[i][b] += sum;
    }
    for (int a = 0; a < 8; a++)
      for (int i = 0; i < 4; i++) half[a][b] += chain->dn[i][a] * right[i];
  }
  for (int a = 0; a < 8; a++)
    for (int b = 0; b < 8; b++) H[a][b] = half[a][b] + half[b][a];
  for (int k = 0; k < 2; k++)
    for (int p = 0; p < 6; p++)
      for (int q = 0; q < 6; q++)
        H[NormalColumn[k][p]][NormalColumn[k][q]] += gradient[4 + 2 * k] * chain->normal[k].dd[0][p][q] + gradient[5 + 2 * k] * chain->normal[k].dd[1][p][q];
}

/* H[num_u][num_u], symmetric, from the half form W[num_y][num_y] and the gradient by y. */
void ContactChainHessian(const EdgeChain *chain, const PetscReal gradient[], const PetscReal W[], PetscReal H[])
{
  const PetscInt ny = chain->num_y, nu = chain->num_u, own = nu - (ny - 8);
  PetscReal      block[8][8];

  NonmortarBlock_Private(chain, gradient, W, block);
  for (int a = 0; a < 8; a++) {
    const PetscInt row = chain->column[a];

    if (row < 0) continue;
    for (int b = 0; b < 8; b++)
      if (chain->column[b] >= 0) H[row * nu + chain->column[b]] = block[a][b];
    for (PetscInt k = 8; k < ny; k++) {
      PetscReal sum = a < 4 ? W[a * ny + k] + W[k * ny + a] : 0;

      for (int i = 0; i < 4; i++) sum += chain->dn[i][a] * (W[(4 + i) * ny + k] + W[k * ny + 4 + i]);
      H[row * nu + own + k - 8] = H[(own + k - 8) * nu + row] = sum;
    }
  }
  for (PetscInt k = 8; k < ny; k++)
    for (PetscInt l = 8; l < ny; l++) H[(own + k - 8) * nu + own + l - 8] = W[k * ny + l] + W[l * ny + k];
}

/* Where the 16 numbers of a segment stand in y; the last ones are used only by foreign bounds. */
static PetscInt Places_Private(const PetscInt local[4], PetscInt place[CONTACT_LOCAL])
{
  const PetscInt c = local[0], d = local[1];

  for (int i = 0; i < 8; i++) place[i] = i;
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 2; i++) place[8 + 2 * k + i] = 8 + 2 * PetscMax(local[k], 0) + i;
  return (local[2] < 0 || local[2] == c || local[2] == d) && (local[3] < 0 || local[3] == c || local[3] == d) ? 12 : CONTACT_LOCAL;
}

/* W[num_y][num_y] += w of one segment */
void ContactScatter(const PetscInt local[4], PetscInt num_y, const PetscReal w[CONTACT_LOCAL][CONTACT_LOCAL], PetscReal W[])
{
  PetscInt       place[CONTACT_LOCAL];
  const PetscInt num = Places_Private(local, place);

  for (PetscInt i = 0; i < num; i++)
    for (PetscInt j = 0; j < num; j++) W[place[i] * num_y + place[j]] += w[i][j];
}

void ContactScatterVector(const PetscInt local[4], const PetscReal v[CONTACT_LOCAL], PetscReal y[])
{
  PetscInt       place[CONTACT_LOCAL];
  const PetscInt num = Places_Private(local, place);

  for (PetscInt i = 0; i < num; i++) y[place[i]] += v[i];
}

/* First and second derivatives of |x_1 - x_0| by (x_0, x_1). */
void ContactLengthDerivative(const EdgeFrame *f, PetscReal dL[4], PetscReal ddL[4][4])
{
  const PetscReal t[2] = {f->dx[0] / f->length, f->dx[1] / f->length};

  for (int a = 0; a < 4; a++) {
    dL[a] = a < 2 ? -t[a] : t[a - 2];
    for (int b = 0; b < 4; b++) ddL[a][b] = ((a < 2) == (b < 2) ? 1 : -1) * ((a % 2 == b % 2) - t[a % 2] * t[b % 2]) / f->length;
  }
}

/* Positions of a segment's mortar nodes and where its bounds' nodes stand among the 16 numbers. */
void ContactGeometry(const ContactSurface *mortar, const Segment *s, SegmentGeometry *g)
{
  const PetscInt *node = &mortar->facets[2 * s->mortar_facet];

  for (int i = 0; i < 2; i++) {
    g->c[i] = mortar->x[2 * node[0] + i];
    g->d[i] = mortar->x[2 * node[1] + i];
    g->e[i] = g->d[i] - g->c[i];
  }
  for (int b = 0; b < 2; b++) {
    const PetscInt m = s->bound[b];

    g->lambda[b] = s->lambda[b];
    g->place[b]  = m < 0 ? -1 : m == node[0] ? 8 : m == node[1] ? 10 : 12 + 2 * b;
    for (int i = 0; i < 2; i++) g->m[b][i] = m < 0 ? 0 : mortar->x[2 * m + i];
  }
}
