/* Piecewise linear amplitudes in pseudo-time. */
#include "base.h"

PetscReal AmplitudeEvaluate(const Amplitude *a, PetscReal t)
{
  static const PetscReal ramp[4] = {0, 0, 1, 1};
  const PetscReal       *p       = a->num ? a->pairs : ramp;
  const PetscInt         num     = a->num ? a->num : 2;

  if (t <= p[0] && !a->endless) return p[1];
  for (PetscInt i = 1; i < num; ++i) {
    const PetscReal *lo = p + 2 * (i - 1), *hi = p + 2 * i;
    if (t <= hi[0] || (a->endless && i == num - 1)) return lo[1] + (hi[1] - lo[1]) * (t - lo[0]) / (hi[0] - lo[0]);
  }
  return p[2 * num - 1];
}

PetscReal AmplitudeNext(const Amplitude *a, PetscReal t)
{
  for (PetscInt i = 0; i < a->num; ++i) {
    if (a->pairs[2 * i] > t) return a->pairs[2 * i];
  }
  return PETSC_MAX_REAL;
}
