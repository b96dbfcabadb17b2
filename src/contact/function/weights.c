/* Weighted gaps of one facet from its moments G_j = int N_j g, D_j = int N_j, M_jk = int N_j N_k over the covered part.

   Dual multipliers: psi = diag(D) M^-1 N,  gt_j = D_j c_j,  c = M^-1 G:
     dgt_j = c_j dD_j + D_j dc_j,  dc = M^-1 (dG - dM c), and with S = sum_j z_j gt_j, y_j = z_j D_j, lambda = M^-1 y
     dS = sum_j z_j c_j dD_j + lambda . (dG - dM c),   d2S / 2 = (first derivatives times d2 moments) / 2 + sum_k (z_k dD_k - sum_l lambda_l dM_lk) dc_k. */
#include "kernelimpl.h"

enum { G = 0, D = 4, M = 8 };

/* Place of M_jk among the moments. */
static inline int Mass_Private(int j, int k)
{
  const int a = j < k ? j : k, b = j < k ? k : j;

  return M + 4 * a - a * (a - 1) / 2 + b - a;
}

/* Inverse of the 4 x 4 mass matrix by Cholesky; false when a pivot is lost in round-off. */
static PetscBool Inverse_Private(const PetscReal q[FACET_MOMENTS], PetscReal inverse[4][4])
{
  PetscReal L[4][4] = {{0}}, K[4][4] = {{0}};

  for (int j = 0; j < 4; j++) {
    PetscReal pivot = q[Mass_Private(j, j)];

    for (int l = 0; l < j; l++) pivot -= L[j][l] * L[j][l];
    if (!(pivot > CONTACT_SINGULAR * q[Mass_Private(j, j)])) return PETSC_FALSE;
    L[j][j] = PetscSqrtReal(pivot);
    for (int i = j + 1; i < 4; i++) {
      PetscReal sum = q[Mass_Private(i, j)];

      for (int l = 0; l < j; l++) sum -= L[i][l] * L[j][l];
      L[i][j] = sum / L[j][j];
    }
  }
  for (int j = 0; j < 4; j++) { /* K = L^-1 */
    K[j][j] = 1 / L[j][j];
    for (int i = j + 1; i < 4; i++) {
      for (int l = j; l < i; l++) K[i][j] -= L[i][l] * K[l][j];
      K[i][j] /= L[i][i];
    }
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      inverse[i][j] = 0;
      for (int l = 0; l < 4; l++) inverse[i][j] += K[l][i] * K[l][j];
    }
  return PETSC_TRUE;
}

PetscBool ContactFacetWeights(const PetscReal q[FACET_MOMENTS], const PetscReal z[4], FacetWeights *w)
{
  PetscReal inverse[4][4], c[4], lambda[4];

  memset(w, 0, sizeof(*w));
  if (!Inverse_Private(q, inverse)) return PETSC_FALSE;
  for (int j = 0; j < 4; j++) {
    c[j] = lambda[j] = 0;
    for (int k = 0; k < 4; k++) {
      c[j] += inverse[j][k] * q[G + k];
      lambda[j] += inverse[j][k] * z[k] * q[D + k];
    }
  }
  for (int k = 0; k < 4; k++) { /* right: dc_k, left: z_k dD_k - lambda_l dM_lk */
    w->left[k][D + k] += z[k];
    for (int l = 0; l < 4; l++) {
      w->right[k][G + l] += inverse[k][l];
      for (int m = 0; m < 4; m++) w->right[k][Mass_Private(l, m)] -= inverse[k][l] * c[m];
      w->left[k][Mass_Private(l, k)] -= lambda[l];
    }
  }
  for (int j = 0; j < 4; j++) {
    w->gap[j] = q[D + j] * c[j];
    for (int r = 0; r < FACET_MOMENTS; r++) w->dgap[j][r] = q[D + j] * w->right[j][r] + (r == D + j ? c[j] : 0);
    w->g[j] = lambda[j];
    for (int k = 0; k < 4; k++) w->D[j][k] = 0.5 * (z[j] * c[j] + z[k] * c[k] - lambda[j] * c[k] - lambda[k] * c[j]);
  }
  w->num_pairs = 4;
  return PETSC_TRUE;
}
