/* From nodal values to points and back, by contraction with one-dimensional tables one direction after the other (sum factorisation):
   O(p^(d+1)) operations a cell and field. Along a line there are n1 = p+1 nodes and q1 points; the inner functions take both as constants for the usual orders,
   so that they unroll. */
#include "mechanicsimpl.h"

#define MOST_LINE ((MORTISE_MAX_ORDER + 1) * MOST_LINE_POINTS) /* nodes of a line times points of a line */

/* One xy-layer f[n1*n1] at its q1*q1 points: derivative by x, derivative by y, value. */
INLINE void LayerGradient_Private(const PetscInt n1, const PetscInt q1, const PetscReal *B, const PetscReal *D, const Lanes *f, Lanes *gx, Lanes *gy, Lanes *v)
{
  Lanes b[MOST_LINE], e[MOST_LINE];

  for (PetscInt y = 0; y < n1; y++) {
    for (PetscInt q = 0; q < q1; q++) {
      Lanes value = B[q * n1] * f[y * n1], slope = D[q * n1] * f[y * n1];

      for (PetscInt x = 1; x < n1; x++) {
        value += B[q * n1 + x] * f[y * n1 + x];
        slope += D[q * n1 + x] * f[y * n1 + x];
      }
      b[y * q1 + q] = value;
      e[y * q1 + q] = slope;
    }
  }
  for (PetscInt qy = 0; qy < q1; qy++) {
    for (PetscInt q = 0; q < q1; q++) {
      Lanes x = {0}, y = {0}, w = {0};

      for (PetscInt j = 0; j < n1; j++) {
        x += B[qy * n1 + j] * e[j * q1 + q];
        y += D[qy * n1 + j] * b[j * q1 + q];
        w += B[qy * n1 + j] * b[j * q1 + q];
      }
      gx[qy * q1 + q] = x;
      gy[qy * q1 + q] = y;
      if (v) v[qy * q1 + q] = w;
    }
  }
}

/* The transpose: f = sum over the layer's points of gx dN/dx + gy dN/dy + v N. */
INLINE void LayerIntegrate_Private(const PetscInt n1, const PetscInt q1, const PetscReal *B, const PetscReal *D, const Lanes *gx, const Lanes *gy,
                                   const Lanes *v, Lanes *f)
{
  Lanes b[MOST_LINE], e[MOST_LINE];

  for (PetscInt y = 0; y < n1; y++) {
    for (PetscInt q = 0; q < q1; q++) {
      Lanes slope = {0}, value = {0};

      for (PetscInt j = 0; j < q1; j++) {
        slope += B[j * n1 + y] * gx[j * q1 + q];
        value += D[j * n1 + y] * gy[j * q1 + q];
        if (v) value += B[j * n1 + y] * v[j * q1 + q];
      }
      e[y * q1 + q] = slope;
      b[y * q1 + q] = value;
    }
  }
  for (PetscInt y = 0; y < n1; y++) {
    for (PetscInt x = 0; x < n1; x++) {
      Lanes sum = {0};

      for (PetscInt q = 0; q < q1; q++) sum += D[q * n1 + x] * e[y * q1 + q] + B[q * n1 + x] * b[y * q1 + q];
      f[y * n1 + x] = sum;
    }
  }
}

/* Gradient of one field over the whole cell, [r][q]. 3-D: layers first, then along z. */
INLINE void FieldGradient_Private(const PetscInt n1, const PetscInt q1, PetscInt dim, PetscInt r, const PetscReal *B, const PetscReal *D, const Lanes *f,
                                  Lanes *layer, Lanes *g)
{
  const PetscInt n2 = n1 * n1, q2 = q1 * q1, part = n1 * q2;

  if (dim == 2) {
    LayerGradient_Private(n1, q1, B, D, f, g, g + q2, r == 3 ? g + 2 * q2 : NULL);
    return;
  }
  for (PetscInt z = 0; z < n1; z++) LayerGradient_Private(n1, q1, B, D, f + z * n2, layer + z * q2, layer + part + z * q2, layer + 2 * part + z * q2);
  for (PetscInt c = 0; c < 3; c++) {
    const PetscReal *T = c == 2 ? D : B;

    for (PetscInt qz = 0; qz < q1; qz++) {
      for (PetscInt q = 0; q < q2; q++) {
        Lanes sum = T[qz * n1] * layer[c * part + q];

        for (PetscInt z = 1; z < n1; z++) sum += T[qz * n1 + z] * layer[c * part + z * q2 + q];
        g[(c * q1 + qz) * q2 + q] = sum;
      }
    }
  }
}

INLINE void FieldIntegrate_Private(const PetscInt n1, const PetscInt q1, PetscInt dim, PetscInt r, const PetscReal *B, const PetscReal *D, const Lanes *g,
                                   Lanes *layer, Lanes *f)
{
  const PetscInt n2 = n1 * n1, q2 = q1 * q1, part = n1 * q2;

  if (dim == 2) {
    LayerIntegrate_Private(n1, q1, B, D, g, g + q2, r == 3 ? g + 2 * q2 : NULL, f);
    return;
  }
  for (PetscInt c = 0; c < 3; c++) {
    const PetscReal *T = c == 2 ? D : B;

    for (PetscInt z = 0; z < n1; z++) {
      for (PetscInt q = 0; q < q2; q++) {
        Lanes sum = T[z] * g[c * q1 * q2 + q];

        for (PetscInt qz = 1; qz < q1; qz++) sum += T[qz * n1 + z] * g[(c * q1 + qz) * q2 + q];
        layer[c * part + z * q2 + q] = sum;
      }
    }
  }
  for (PetscInt z = 0; z < n1; z++) LayerIntegrate_Private(n1, q1, B, D, layer + z * q2, layer + part + z * q2, layer + 2 * part + z * q2, f + z * n2);
}

/* [d][n] -> [d][r][q] */
static void Gradient_Private(CellKernel k, const Lanes *field, Lanes *gradient)
{
  const PetscInt   dim = k->dim, r = k->num_derivatives;
  const PetscReal *B = k->basis->B, *D = k->basis->D;

  for (PetscInt c = 0; c < dim; c++) {
    const Lanes *f = field + c * k->num_nodes;
    Lanes       *g = gradient + c * r * k->num_points;

#define CALL(n1, q1) FieldGradient_Private(n1, q1, dim, r, B, D, f, k->layer, g)
    CELL_OF_ORDER(k, CALL)
#undef CALL
  }
}

void CellKernelIntegrate_Private(CellKernel k, const Lanes *flux, Lanes *result)
{
  const PetscInt   dim = k->dim, r = k->num_derivatives;
  const PetscReal *B = k->basis->B, *D = k->basis->D;

  for (PetscInt c = 0; c < dim; c++) {
    const Lanes *g = flux + c * r * k->num_points;
    Lanes       *f = result + c * k->num_nodes;

#define CALL(n1, q1) FieldIntegrate_Private(n1, q1, dim, r, B, D, g, k->layer, f)
    CELL_OF_ORDER(k, CALL)
#undef CALL
  }
}

/* Inverse of a 3x3 Jacobian G[i][r] = dX_i/dxi_r as inv[r][J]; returns the determinant. */
INLINE Lanes Invert3_Private(const Lanes G[9], Lanes inv[9])
{
  Lanes cof[9], det;

  CellCofactor(G, cof);
  det = G[0] * cof[0] + G[1] * cof[1] + G[2] * cof[2];
  for (int i = 0; i < 3; i++) {
    for (int r = 0; r < 3; r++) inv[3 * r + i] = cof[3 * i + r] / det;
  }
  return det;
}

PetscInt CellKernelGeometry_Private(CellKernel k)
{
  const PetscInt nq = k->num_points, d = k->dim, r = k->num_derivatives;
  Lanes         *G        = k->gradient;
  PetscInt       inverted = -1;

  Gradient_Private(k, k->X, G);
  for (PetscInt q = 0; q < nq; q++) {
    Lanes det;

    if (d == 3) {
      Lanes local[9], inv[9];

      for (int c = 0; c < 9; c++) local[c] = G[c * nq + q];
      det = Invert3_Private(local, inv);
      for (int c = 0; c < 9; c++) k->inverse[c * nq + q] = inv[c];
    } else {
      const Lanes a = G[q], b = G[nq + q], c = G[r * nq + q], e = G[(r + 1) * nq + q];

      det                    = a * e - b * c;
      k->inverse[q]          = e / det;
      k->inverse[nq + q]     = -b / det;
      k->inverse[2 * nq + q] = -c / det;
      k->inverse[3 * nq + q] = a / det;
    }
    k->volume[q] = k->weight[q] * det;
    if (k->hoop) {
      const Lanes R = G[2 * nq + q];

      k->hoop_inverse[q] = 1 / R;
      k->volume[q] *= 2 * PETSC_PI * R;
    }
    for (int l = 0; l < NUM_LANES; l++)
      if (!(k->volume[q][l] > 0)) inverted = l;
  }
  return inverted;
}

/* H = grad u at point q: H_iJ = sum_r du_i/dxi_r dxi_r/dX_J; hoop: H_33 = u_r / R. */
INLINE void DisplacementGradient_Private(CellKernel k, const int d, PetscInt q, Lanes H[9])
{
  const PetscInt nq = k->num_points, nr = k->num_derivatives;

  for (int c = 0; c < 9; c++) H[c] = (Lanes){0};
  for (int i = 0; i < d; i++) {
    for (int r = 0; r < d; r++) {
      const Lanes g = k->gradient[(i * nr + r) * nq + q];

      for (int J = 0; J < d; J++) H[3 * i + J] += g * k->inverse[(r * d + J) * nq + q];
    }
  }
  if (d == 2 && k->hoop) H[8] = k->gradient[2 * nq + q] * k->hoop_inverse[q];
}

/* F, and J - 1 = tr H + tr cof H + det H (small: tr H) free of cancellation. */
INLINE void Deformation_Private(CellKernel k, const int d, Lanes *min_det)
{
  const PetscInt slab  = k->slab_points;
  Lanes          least = {0};

  for (PetscInt q = 0; q < k->num_points; q++) {
    Lanes *F = k->F + (q / slab) * 9 * slab + q % slab, H[9], cof[9], jm1, det;

    DisplacementGradient_Private(k, d, q, H);
    CellCofactor(H, cof);
    jm1 = H[0] + H[4] + H[8];
    det = 1 + (jm1 + (cof[0] + cof[4] + cof[8]) + (H[0] * cof[0] + H[1] * cof[1] + H[2] * cof[2]));
    if (!k->small) jm1 = jm1 + (cof[0] + cof[4] + cof[8]) + (H[0] * cof[0] + H[1] * cof[1] + H[2] * cof[2]);
    if (k->mixed) k->measure[q] = jm1;
    for (int c = 0; c < 9; c++) F[c * slab] = H[c] + (c % 4 == 0 ? 1 : 0);
    /* A ring turned to a negative radius with its section inverted has det F > 0 all the same. */
    for (int l = 0; d == 2 && l < NUM_LANES; l++) det[l] = 1 + H[8][l] > 0 ? det[l] : -PetscAbsReal(det[l]);
    /* A lane that is not a number stays so: every comparison with it is false. */
    for (int l = 0; l < NUM_LANES; l++) least[l] = q == 0 || !(det[l] >= least[l]) ? det[l] : least[l];
  }
  *min_det = least;
}

void CellKernelDeformation_Private(CellKernel k, Lanes *min_det)
{
  Gradient_Private(k, k->u, k->gradient);
  if (k->dim == 3)
    Deformation_Private(k, 3, min_det);
  else
    Deformation_Private(k, 2, min_det);
}

INLINE void PullBack_Private(CellKernel k, const int d, PetscInt q, const Lanes T[9], Lanes *flux)
{
  const PetscInt nq = k->num_points, nr = k->num_derivatives;

  for (int i = 0; i < d; i++) {
    for (int r = 0; r < d; r++) {
      Lanes sum = {0};

      for (int J = 0; J < d; J++) sum += T[3 * i + J] * k->inverse[(r * d + J) * nq + q];
      flux[(i * nr + r) * nq + q] = sum * k->volume[q];
    }
  }
  if (d == 2 && k->hoop) {
    flux[2 * nq + q] = T[8] * k->hoop_inverse[q] * k->volume[q];
    flux[5 * nq + q] = (Lanes){0};
  }
}

void CellKernelPullBack_Private(CellKernel k, PetscInt q, const Lanes T[9], Lanes *flux)
{
  if (k->dim == 3)
    PullBack_Private(k, 3, q, T, flux);
  else
    PullBack_Private(k, 2, q, T, flux);
}

void CellKernelFlux_Private(CellKernel k, Lanes *flux)
{
  const PetscInt slab = k->slab_points;

  for (PetscInt q = 0; q < k->num_points; q++) {
    const Lanes *P = k->P + (q / slab) * 9 * slab + q % slab;
    Lanes        T[9];

    for (int c = 0; c < 9; c++) T[c] = P[c * slab];
    CellKernelPullBack_Private(k, q, T, flux);
  }
}
