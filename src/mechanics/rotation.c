/* Finite rotations by a vector phi: by |phi| radians about it.  R = I + s [phi] + a [phi]^2,  s = sin t / t, a = (1 - cos t) / t^2, t = |phi|;  the spin of a
   change of phi is J dphi, J = I + a [phi] + b [phi]^2, b = (t - sin t) / t^3. */
#include "mechanics.h"
#include <petscblaslapack.h>

#define SERIES 0.1 /* angle below which the series below are exact to round-off and the closed forms are not */

typedef struct {
  PetscReal s, a, b;
} Coefficients;

static Coefficients Coefficients_Private(const PetscReal phi[3])
{
  const PetscReal t2 = Dot3(phi, phi), t = PetscSqrtReal(t2);

  if (t < SERIES)
    return (Coefficients){1 - t2 / 6 * (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72))), (1 - t2 / 12 * (1 - t2 / 30 * (1 - t2 / 56))) / 2,
                          (1 - t2 / 20 * (1 - t2 / 42 * (1 - t2 / 72))) / 6};
  return (Coefficients){PetscSinReal(t) / t, (1 - PetscCosReal(t)) / t2, (t - PetscSinReal(t)) / (t * t2)};
}

/* out = I + f [phi] + g [phi]^2 */
static void Polynomial_Private(PetscReal f, PetscReal g, const PetscReal phi[3], PetscReal out[9])
{
  for (PetscInt c = 0; c < 3; ++c) {
    const PetscReal unit[3] = {c == 0, c == 1, c == 2};
    PetscReal       once[3], twice[3];
    Cross3(phi, unit, once);
    Cross3(phi, once, twice);
    for (PetscInt r = 0; r < 3; ++r) out[3 * r + c] = unit[r] + f * once[r] + g * twice[r];
  }
}

void RotationMatrix(const PetscReal phi[3], PetscReal R[9])
{
  const Coefficients k = Coefficients_Private(phi);

  Polynomial_Private(k.s, k.a, phi, R);
}

void RotationSpin(const PetscReal phi[3], PetscReal J[9])
{
  const Coefficients k = Coefficients_Private(phi);

  Polynomial_Private(k.a, k.b, phi, J);
}

PetscErrorCode RotationNearest(PetscInt dim, const PetscReal S[9], PetscReal q[4], PetscBool *unique)
{
  PetscReal    N[16] = {S[0] + S[4] + S[8], 0, 0,           0,           S[5] - S[7], S[0] - S[4] - S[8], 0, 0, S[6] - S[2], S[1] + S[3],
                        S[4] - S[0] - S[8], 0, S[1] - S[3], S[6] + S[2], S[5] + S[7], S[8] - S[0] - S[4]};
  PetscReal    w[4], work[32];
  PetscBLASInt n = 4, size = 32, info;

  PetscFunctionBegin;
  if (dim == 2) {
    const PetscReal angle = atan2(S[1] - S[3], S[0] + S[4]);

    *unique = (PetscBool)(PetscSqr(S[1] - S[3]) + PetscSqr(S[0] + S[4]) > 0);
    q[0]    = PetscCosReal(angle / 2);
    q[1] = q[2] = 0;
    q[3]        = PetscSinReal(angle / 2);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, N, &n, w, work, &size, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "eigenvalues of a 4-square matrix: LAPACK says %d", (int)info);
  *unique = (PetscBool)(w[3] - w[2] > ROUND_LENGTH * (w[3] - w[0]));
  PetscCall(PetscArraycpy(q, N + 12, 4));
  PetscFunctionReturn(PETSC_SUCCESS);
}
