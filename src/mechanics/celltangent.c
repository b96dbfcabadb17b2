/* Element matrix by sum factorisation: K_(a i)(b k) = sum_q At_(i r k s)(q) d_r N_a d_s N_b with At the moduli pulled back to reference coordinates.
   The z direction is summed for each pair (a_z, b_z), then y, then x: O(p^(2d+1)) instead of O(p^(3d)) operations. Lines of nodes along x make tiles;
   only tiles (a_z a_y) <= (b_z b_y) are summed, the others are their transposes; of unsymmetric laws all tiles. */
#include "mechanicsimpl.h"

/* 3-D: moduli A of point i of a slab, [9][9] with stride slab, to reference coordinates of point q. */
INLINE void PullBackTwice3_Private(CellKernel k, const PetscBool full, PetscInt q, const Lanes *A, PetscInt slab)
{
  const PetscInt nq = k->num_points;
  Lanes          inv[9], T[9][3], *out = k->reference_tangent + q;

  for (int c = 0; c < 9; c++) inv[c] = k->inverse[c * nq + q];
  for (int kk = 0; kk < 3; kk++) {
    for (int a = 0; a < (full ? 9 : 3 * kk + 3); a++) { /* T[iJ][s] = volume A_iJkL inv_sL for i <= k */
      const Lanes *row = A + (9 * a + 3 * kk) * slab, r0 = row[0] * k->volume[q], r1 = row[slab] * k->volume[q], r2 = row[2 * slab] * k->volume[q];

      for (int s = 0; s < 3; s++) T[a][s] = r0 * inv[3 * s] + r1 * inv[3 * s + 1] + r2 * inv[3 * s + 2];
    }
    for (int i = 0; i < (full ? 3 : kk + 1); i++) {
      for (int r = 0; r < 3; r++) {
        for (int s = 0; s < 3; s++) {
          const Lanes value = T[3 * i][s] * inv[3 * r] + T[3 * i + 1][s] * inv[3 * r + 1] + T[3 * i + 2][s] * inv[3 * r + 2];

          out[((3 * i + kk) * 9 + 3 * r + s) * nq] = value;
          if (!full && i != kk) out[((3 * kk + i) * 9 + 3 * s + r) * nq] = value;
        }
      }
    }
  }
}

/* 2-D: dF of (component i, derivative r) has the entries F_iJ += inv_rJ, and F_33 += 1/R for (0, value). */
INLINE void PullBackTwice2_Private(CellKernel k, const int nr, PetscInt q, const Lanes *A, PetscInt slab)
{
  static const int place[2][2] = {{0, 1}, {3, 4}};
  const PetscInt   nq          = k->num_points;
  const Lanes      w           = k->volume[q];
  Lanes           *out         = k->reference_tangent + q, inv[4];

  for (int c = 0; c < 4; c++) inv[c] = k->inverse[c * nq + q];
  for (int i = 0; i < 2; i++) {
    for (int kk = 0; kk < 2; kk++) {
      for (int r = 0; r < 2; r++) {
        for (int s = 0; s < 2; s++) {
          Lanes sum = {0};

          for (int J = 0; J < 2; J++) {
            for (int L = 0; L < 2; L++) sum += A[(9 * place[i][J] + place[kk][L]) * slab] * inv[2 * r + J] * inv[2 * s + L];
          }
          out[((2 * i + kk) * nr * nr + r * nr + s) * nq] = w * sum;
        }
      }
    }
  }
  if (nr == 3) {
    const Lanes h = k->hoop_inverse[q];

    for (int c = 0; c < 4; c++) {
      for (int r = 0; r < 3; r++) out[(c * 9 + 3 * r + 2) * nq] = out[(c * 9 + 6 + r) * nq] = (Lanes){0};
    }
    out[8 * nq] = w * A[80 * slab] * h * h;
    for (int i = 0; i < 2; i++) {
      for (int r = 0; r < 2; r++) { /* (i,r) with (0,value) and its transpose */
        const Lanes value = w * h * (A[(9 * place[i][0] + 8) * slab] * inv[2 * r] + A[(9 * place[i][1] + 8) * slab] * inv[2 * r + 1]);
        const Lanes other = w * h * (A[(72 + place[i][0]) * slab] * inv[2 * r] + A[(72 + place[i][1]) * slab] * inv[2 * r + 1]);

        out[(2 * i * 9 + 3 * r + 2) * nq] = value;
        out[(i * 9 + 6 + r) * nq]         = other;
      }
    }
  }
}

void CellKernelTangentSlab_Private(CellKernel k, PetscInt s)
{
  const PetscInt slab = k->slab_points;

  for (PetscInt i = 0; i < slab; i++) {
    if (k->dim == 3 && k->unsymmetric)
      PullBackTwice3_Private(k, PETSC_TRUE, s * slab + i, k->A + i, slab);
    else if (k->dim == 3)
      PullBackTwice3_Private(k, PETSC_FALSE, s * slab + i, k->A + i, slab);
    else if (k->hoop)
      PullBackTwice2_Private(k, 3, s * slab + i, k->A + i, slab);
    else
      PullBackTwice2_Private(k, 2, s * slab + i, k->A + i, slab);
  }
}

/* z: layer_tangent[ik][rs][q12] = sum_q3 At[ik][rs][q3][q12] times the pair (a_z, b_z); third derivative is along z. */
INLINE void SumZ_Private(CellKernel k, const PetscInt n1, const PetscInt q1, PetscInt az, PetscInt bz)
{
  const PetscInt   q2   = q1 * q1;
  const PetscReal *pair = k->pairs + (az * n1 + bz) * 4 * q1;

  for (PetscInt c = 0; c < 81; c++) {
    const PetscReal *z   = pair + (2 * (c % 9 / 3 == 2) + (c % 3 == 2)) * q1;
    const Lanes     *in  = k->reference_tangent + c * q2 * q1;
    Lanes           *out = k->layer_tangent + c * q2;

    for (PetscInt q = 0; q < q2; q++) {
      Lanes sum = z[0] * in[q];

      for (PetscInt q3 = 1; q3 < q1; q3++) sum += z[q3] * in[q3 * q2 + q];
      out[q] = sum;
    }
  }
}

/* y, then x: tile[a_x i][b_x k] for lines (.., a_y) and (.., b_y); d components, nr derivatives of which 0 is along x, 1 along y. */
INLINE void SumTile_Private(CellKernel k, const PetscInt n1, const PetscInt q1, const int d, const int nr, const Lanes *moduli, PetscInt ay, PetscInt by)
{
  const PetscInt   q2   = q1 * q1;
  const PetscReal *pair = k->pairs + (ay * n1 + by) * 4 * q1, *B = k->basis->B, *D = k->basis->D;

  for (int c = 0; c < d * d; c++) {
    Lanes line[4 * MOST_LINE_POINTS]; /* [x derivative of a][of b][q1] */

    for (PetscInt i = 0; i < 4 * q1; i++) line[i] = (Lanes){0};
    for (int r = 0; r < nr; r++) {
      for (int s = 0; s < nr; s++) {
        const PetscReal *y   = pair + (2 * (r == 1) + (s == 1)) * q1;
        const Lanes     *in  = moduli + (c * nr * nr + r * nr + s) * q2;
        Lanes           *out = line + (2 * (r == 0) + (s == 0)) * q1;

        for (PetscInt q = 0; q < q1; q++) {
          for (PetscInt j = 0; j < q1; j++) out[q] += y[j] * in[j * q1 + q];
        }
      }
    }
    for (PetscInt a = 0; a < n1; a++) {
      Lanes value[MOST_LINE_POINTS], slope[MOST_LINE_POINTS]; /* function a applied: what multiplies function b and its derivative */

      for (PetscInt q = 0; q < q1; q++) {
        value[q] = B[q * n1 + a] * line[q] + D[q * n1 + a] * line[2 * q1 + q];
        slope[q] = B[q * n1 + a] * line[q1 + q] + D[q * n1 + a] * line[3 * q1 + q];
      }
      for (PetscInt b = 0; b < n1; b++) {
        Lanes sum[2] = {B[b] * value[0], D[b] * slope[0]}; /* independent, so that their additions overlap */

        for (PetscInt q = 1; q < q1; q++) {
          sum[0] += B[q * n1 + b] * value[q];
          sum[1] += D[q * n1 + b] * slope[q];
        }
        k->tile[(a * d + c / d) * n1 * d + b * d + c % d] = sum[0] + sum[1];
      }
    }
  }
}

#define PRESSURES_AT_ONCE 16 /* whose lines of nodes stay in cache while all rows of the tile meet them */

/* tile += modulus (L^-1 b)^T (L^-1 b) on the lines that start at nodes a and b. */
INLINE void AddCoupling_Private(CellKernel k, const PetscInt n1, const int d, PetscInt a, PetscInt b)
{
  const PetscInt  m = k->num_pressure, n = k->num_nodes, cols = n1 * d;
  const PetscReal modulus = MaterialVolumetricModulus(&k->material);

  for (PetscInt first = 0; first < m; first += PRESSURES_AT_ONCE) {
    const PetscInt last = PetscMin(m, first + PRESSURES_AT_ONCE);

    for (PetscInt row = 0; row < cols; row++) {
      Lanes sum[3 * (MORTISE_MAX_ORDER + 1)];

      for (PetscInt col = 0; col < cols; col++) sum[col] = (Lanes){0};
      for (PetscInt l = first; l < last; l++) {
        const Lanes *y = k->coupling + l * d * n, ya = y[(row % d) * n + a + row / d];

        for (int c = 0; c < d; c++) {
          for (PetscInt x = 0; x < n1; x++) sum[x * d + c] += ya * y[c * n + b + x];
        }
      }
      for (PetscInt col = 0; col < cols; col++) k->tile[row * cols + col] += modulus * sum[col];
    }
  }
}

/* The tile into the matrices of all cells, and its transpose across the diagonal. */
INLINE void StoreTile_Private(CellKernel k, const PetscInt n1, const int d, PetscInt num_cells, PetscInt a, PetscInt b, PetscReal *tangent)
{
  const PetscInt   cols = n1 * d, size = k->num_nodes * d;
  const PetscReal *tile = (const PetscReal *)k->tile;

  for (PetscInt cell = 0; cell < num_cells; cell++) {
    PetscReal *K = tangent + cell * size * size;

    for (PetscInt row = 0; row < cols; row++) {
      for (PetscInt col = 0; col < cols; col++) K[(a * d + row) * size + b * d + col] = tile[(row * cols + col) * NUM_LANES + cell];
    }
    if (a == b || k->unsymmetric) continue;
    for (PetscInt row = 0; row < cols; row++) {
      for (PetscInt col = 0; col < cols; col++) K[(b * d + row) * size + a * d + col] = tile[(col * cols + row) * NUM_LANES + cell];
    }
  }
}

/* The tile into the upper triangles of the matrices of cells first .. first+num-1, nodes in their places: rows of inner nodes and of others. */
INLINE void PlaceTile_Private(CellKernel k, const PetscInt n1, const int d, const CellBatch *out, PetscInt first, PetscInt num, PetscInt a, PetscInt b)
{
  const PetscInt  cols = n1 * d, size = k->num_nodes * d, ni = out->num_inner * d, rest = size - ni;
  const PetscInt *place = out->place;

  for (PetscInt x = 0; x < n1; x++) {
    for (PetscInt y = 0; y < n1; y++) {
      const PetscInt  row = place[a + x] * d, col = place[b + y] * d, upper = PetscMin(row, col), right = PetscMax(row, col);
      const PetscBool inside = upper < ni ? PETSC_TRUE : PETSC_FALSE;
      const PetscInt  stride = inside ? size : rest, matrix = inside ? ni * size : rest * rest;
      PetscReal      *to = inside ? out->inner + first * matrix + upper * size + right : out->tangent + first * matrix + (upper - ni) * rest + right - ni;
      const Lanes    *in = k->tile + x * d * cols + y * d;

      if (row > col && a == b) continue;
      for (int i = 0; i < d; i++) {
        for (int j = 0; j < d; j++) {
          PetscReal *K = to + (row <= col ? i * stride + j : j * stride + i);

          for (PetscInt cell = 0; cell < num; cell++) K[cell * matrix] = in[i * cols + j][cell];
        }
      }
    }
  }
}

INLINE void Tangent_Private(CellKernel k, const PetscInt n1, const PetscInt q1, const int d, const int nr, const CellBatch *out, PetscInt first, PetscInt num)
{
  const PetscInt nz = d == 3 ? n1 : 1, size = k->num_nodes * d;

  for (PetscInt az = 0; az < nz; az++) {
    for (PetscInt bz = k->unsymmetric ? 0 : az; bz < nz; bz++) {
      const Lanes *moduli = d == 3 ? k->layer_tangent : k->reference_tangent;

      if (d == 3) SumZ_Private(k, n1, q1, az, bz);
      for (PetscInt ay = 0; ay < n1; ay++) {
        for (PetscInt by = bz == az && !k->unsymmetric ? ay : 0; by < n1; by++) {
          const PetscInt a = (az * n1 + ay) * n1, b = (bz * n1 + by) * n1;

          SumTile_Private(k, n1, q1, d, nr, moduli, ay, by);
          if (k->mixed && !k->incompressible) AddCoupling_Private(k, n1, d, a, b);
          if (out->place)
            PlaceTile_Private(k, n1, d, out, first, num, a, b);
          else
            StoreTile_Private(k, n1, d, num, a, b, out->tangent + first * size * size);
        }
      }
    }
  }
}

/* One instance for each usual order, with constant loop bounds. */
INLINE void TangentOfOrder_Private(CellKernel k, const int d, const int nr, const CellBatch *out, PetscInt first, PetscInt num)
{
#define CALL(n1, q1) Tangent_Private(k, n1, q1, d, nr, out, first, num)
  CELL_OF_ORDER(k, CALL)
#undef CALL
}

void CellKernelTangent_Private(CellKernel k, const CellBatch *out, PetscInt first, PetscInt num)
{
  if (k->dim == 3)
    TangentOfOrder_Private(k, 3, 3, out, first, num);
  else if (k->hoop)
    TangentOfOrder_Private(k, 2, 3, out, first, num);
  else
    TangentOfOrder_Private(k, 2, 2, out, first, num);
}
