/* Ogden's solid (docs/theory.md), isochoric part in principal stretches l_k of F, with e_k = ln l_k - ln J / 3:
     W = U(J) + sum_p mu_p/alpha_p (exp(alpha_p e_1) + exp(alpha_p e_2) + exp(alpha_p e_3) - 3).
   At fixed J the stress is F S with S = sum_k s_k N_k (x) N_k, s_k = sum_p mu_p exp(alpha_p e_k) / l_k^2, in the principal axes N_k of C. Its derivative needs
   divided differences of s by C's eigenvalues; written as expm1(m t) / expm1(t) they are exact to round-off for stretches that are equal or nearly so. */
#include "invariants.h"

enum { NUM_TERMS = 3, KAPPA = 6 };

const MaterialParameter MaterialOgdenParameters[] = {
    {"mu1", "stress", "factor of the first term; shear modulus (mu1 alpha1 + mu2 alpha2 + mu3 alpha3)/2", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"alpha1", "1", "its exponent", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"mu2", "stress", "factor of a second term, when wanted", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"alpha2", "1", "its exponent", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"mu3", "stress", "factor of a third term, when wanted", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"alpha3", "1", "its exponent", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {NULL, NULL, NULL, 0, 0},
};

PetscErrorCode MaterialOgdenSetUp(MaterialSpec *spec)
{
  const MaterialParameter *const known = MaterialOgdenParameters;
  PetscReal                     *v = spec->parameter, twice_mu = 0;

  PetscFunctionBegin;
  PetscCheckInput(!PetscIsNanReal(v[0]), "material.%s.mu1: missing; ogden needs mu1, alpha1 and kappa", spec->name);
  PetscCheckInput(!PetscIsNanReal(v[KAPPA]), "material.%s.kappa: missing; ogden needs mu1, alpha1 and kappa", spec->name);
  for (int p = 0; p < NUM_TERMS; p++) {
    PetscReal *const term = &v[2 * p];

    PetscCheckInput(PetscIsNanReal(term[0]) == PetscIsNanReal(term[1]), "material.%s.%s: missing; %s and %s go together", spec->name,
                    known[2 * p + (PetscIsNanReal(term[0]) ? 0 : 1)].name, known[2 * p].name, known[2 * p + 1].name);
    if (PetscIsNanReal(term[0])) {
      term[0] = 0;
      term[1] = 1;
    }
    PetscCheckInput(term[1] != 0, "material.%s.%s: an exponent must not be 0", spec->name, known[2 * p + 1].name);
    twice_mu += term[0] * term[1];
  }
  PetscCheckInput(twice_mu > 0, "material.%s.mu1: shear modulus (mu1 alpha1 + mu2 alpha2 + mu3 alpha3)/2 = %g must be positive", spec->name,
                  (double)(twice_mu / 2));
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: ogden knows quadratic and simo, not log", spec->name);
  spec->mu     = twice_mu / 2;
  spec->kappa  = v[KAPPA];
  spec->lambda = spec->kappa - 2 * spec->mu / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Eigenvalues e[3] and orthonormal eigenvectors, columns of N, of a symmetric tensor: Jacobi's rotations, each digit of small tensors kept. */
static void Principal_Private(PetscReal E[3][3], PetscReal e[3], PetscReal N[3][3])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) N[i][j] = i == j;
  for (int sweep = 0; sweep < 12; sweep++) {
    PetscBool done = PETSC_TRUE;

    for (int i = 0; i < 2; i++) {
      for (int j = i + 1; j < 3; j++) {
        if (!(PetscAbsReal(E[i][j]) > 0.1 * PETSC_MACHINE_EPSILON * (PetscAbsReal(E[0][0]) + PetscAbsReal(E[1][1]) + PetscAbsReal(E[2][2])))) continue;
        const PetscReal half = 0.5 * (E[j][j] - E[i][i]) / E[i][j];
        const PetscReal t = (half < 0 ? -1 : 1) / (PetscAbsReal(half) + PetscSqrtReal(1 + half * half)), c = 1 / PetscSqrtReal(1 + t * t), s = t * c;
        const int       k     = 3 - i - j;
        const PetscReal shift = t * E[i][j], a = E[k][i], b = E[k][j];

        E[i][i] -= shift;
        E[j][j] += shift;
        E[i][j] = E[j][i] = 0;
        E[k][i] = E[i][k] = c * a - s * b;
        E[k][j] = E[j][k] = s * a + c * b;
        for (int m = 0; m < 3; m++) {
          const PetscReal x = N[m][i], y = N[m][j];

          N[m][i] = c * x - s * y;
          N[m][j] = s * x + c * y;
        }
        done = PETSC_FALSE;
      }
    }
    if (done) break;
  }
  for (int i = 0; i < 3; i++) e[i] = E[i][i];
}

/* (x_j^m - x_k^m)/(x_j - x_k) x_k^(1-m) for x_j/x_k = exp(t). */
static PetscReal Divided_Private(PetscReal m, PetscReal t)
{
  return t == 0 ? m : expm1(m * t) / expm1(t);
}

/* At one point: logarithms of stretches, axes, and sums over the terms. */
typedef struct {
  PetscReal W, J1, J2;   /* energy; J dW/dJ and J^2 d2W/dJ2 at fixed F */
  PetscReal s[3], sJ[3]; /* s_k and J ds_k/dJ */
  PetscReal slope[3][3]; /* ds by C's eigenvalues, twice */
  PetscReal N[3][3];
} Stretches;

static void Stretches_Private(const MaterialSpec *spec, PetscReal E[3][3], Stretches *out)
{
  PetscReal l[3], e[3], mean;

  PetscMemzero(out, sizeof(*out));
  Principal_Private(E, l, out->N);
  for (int k = 0; k < 3; k++) l[k] = 0.5 * log1p(l[k]);
  mean = (l[0] + l[1] + l[2]) / 3;
  for (int k = 0; k < 3; k++) e[k] = l[k] - mean;
  for (int p = 0; p < NUM_TERMS; p++) {
    const PetscReal mu = spec->parameter[2 * p], a = spec->parameter[2 * p + 1], m = 0.5 * a - 1;

    for (int k = 0; mu != 0 && k < 3; k++) {
      const PetscReal x = PetscExpReal(a * e[k]), s = mu * x * PetscExpReal(-2 * l[k]);

      out->W += mu / a * expm1(a * e[k]);
      out->J1 -= mu / 3 * x;
      out->J2 += mu / 3 * (a / 3 + 1) * x;
      out->s[k] += s;
      out->sJ[k] -= a / 3 * s;
      for (int j = 0; j <= k; j++) out->slope[j][k] += 2 * s * PetscExpReal(-2 * l[k]) * Divided_Private(m, 2 * (l[j] - l[k]));
    }
  }
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < k; j++) out->slope[k][j] = out->slope[j][k];
}

/* With f_k = F N_k: dP = dF S + sum_jk slope_jk/2 f_j (x) N_k (f_j.dF N_k + f_k.dF N_j). */
INLINE void Tangent_Private(const Lanes S[9], const Lanes slope[9], const Lanes M[9][9], Lanes A[81])
{
  for (int k = 0; k < 81; k++) A[k] = (Lanes){0};
  for (int i = 0; i < 3; i++)
    for (int J = 0; J < 3; J++)
      for (int L = 0; L < 3; L++) A[9 * (3 * i + J) + 3 * i + L] = S[3 * J + L];
  for (int j = 0; j < 3; j++) {
    AddSquare(A, slope[4 * j], M[4 * j]);
    for (int k = 0; k < j; k++) {
      Lanes both[9];

      for (int n = 0; n < 9; n++) both[n] = M[3 * j + k][n] + M[3 * k + j][n];
      AddSquare(A, 0.5 * slope[3 * j + k], both);
    }
  }
}

INLINE void OgdenPoint_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes inverse = 1 / d->J, *H = d->H;
  Lanes       W, h[2], s[3], sJ[3], slope[9], N[9], M[9][9], S[9] = {{0}}, v[9] = {{0}};

  for (int q = 0; q < NUM_LANES; q++) {
    PetscReal E[3][3];
    Stretches point;

    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) E[i][j] = H[3 * i + j][q] + H[3 * j + i][q] + H[i][q] * H[j][q] + H[3 + i][q] * H[3 + j][q] + H[6 + i][q] * H[6 + j][q];
    Stretches_Private(spec, E, &point);
    W[q]    = point.W;
    h[0][q] = point.J1;
    h[1][q] = point.J2;
    for (int k = 0; k < 9; k++) {
      N[k][q]     = point.N[k / 3][k % 3];
      slope[k][q] = point.slope[k / 3][k % 3];
    }
    for (int k = 0; k < 3; k++) {
      s[k][q]  = point.s[k];
      sJ[k][q] = point.sJ[k];
    }
  }
  if (r->want_W) r->W = W;
  h[0] *= inverse;
  h[1] *= inverse * inverse;
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++) {
        const Lanes f = d->F[3 * i] * N[j] + d->F[3 * i + 1] * N[3 + j] + d->F[3 * i + 2] * N[6 + j];

        for (int J = 0; J < 3; J++) M[3 * j + k][3 * i + J] = f * N[3 * J + k];
      }
  for (int n = 0; n < 9; n++) {
    for (int k = 0; k < 3; k++) {
      S[n] += s[k] * N[3 * (n / 3) + k] * N[3 * (n % 3) + k];
      v[n] += inverse * sJ[k] * M[4 * k][n];
    }
    if (r->want_P) r->P[n] = s[0] * M[0][n] + s[1] * M[4][n] + s[2] * M[8][n];
  }
  if (r->want_A) {
    Tangent_Private(S, slope, (const Lanes(*)[9])M, r->A);
    AddSymmetric(r->A, v, d->cof);
  }
  AddVolume(spec, part, d, h, r);
}

PetscErrorCode MaterialOgden(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(OgdenPoint_Private, 0, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
