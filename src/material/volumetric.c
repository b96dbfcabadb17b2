/* The volumetric measure g(J) of the mixed formulation: U(J) = m/2 g^2, g(1) = 0, g'(1) = 1. */
#include "material.h"

PetscReal MaterialVolumetricModulus(const MaterialSpec *spec)
{
  return spec->volumetric == VOLUMETRIC_LOG ? spec->log_modulus : spec->kappa;
}

/* Simo's g = sign(j) sqrt(f), f = (J^2-1)/2 - ln J, j = J-1. Near j = 0 f loses its digits: there f = j^2 r(j), r = 1 - j/3 + j^2/4 - j^3/5 + ...,
   and the derivatives follow from those of r. 20 terms keep even g'' to round-off. */
static void Simo_Private(PetscReal j, PetscReal g[3])
{
  const PetscReal J = 1 + j;

  if (PetscAbsReal(j) < 0.1) {
    PetscReal r = 0, dr = 0, ddr = 0, root;

    for (int k = 20; k >= 0; k--) {
      const PetscReal c = k == 0 ? 1 : (k % 2 ? -1. : 1.) / (k + 2);

      ddr = ddr * j + 2 * dr;
      dr  = dr * j + r;
      r   = r * j + c;
    }
    root = PetscSqrtReal(r);
    g[0] = j * root;
    g[1] = root + 0.5 * j * dr / root;
    g[2] = dr / root + j * (0.5 * ddr / root - 0.25 * dr * dr / (r * root));
  } else {
    g[0] = (j > 0 ? 1 : -1) * PetscSqrtReal(j + 0.5 * j * j - PetscLogReal(J));
    g[1] = 0.5 * (J - 1 / J) / g[0];
    g[2] = (0.5 * (1 + 1 / (J * J)) - g[1] * g[1]) / g[0];
  }
}

void MaterialVolumetricPoints(const MaterialSpec *spec, PetscInt n, const PetscReal *J_minus_1, PetscReal *g, PetscReal *dg, PetscReal *ddg)
{
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal j    = J_minus_1[q];
    PetscReal       v[3] = {j, 1, 0};

    if (spec->volumetric == VOLUMETRIC_LOG) {
      v[0] = log1p(j);
      v[1] = 1 / (1 + j);
      v[2] = -v[1] * v[1];
    } else if (spec->volumetric == VOLUMETRIC_SIMO)
      Simo_Private(j, v);
    g[q]   = v[0];
    dg[q]  = v[1];
    ddg[q] = v[2];
  }
}

void MaterialVolumetric(const MaterialSpec *spec, PetscReal J, PetscReal g[3])
{
  const PetscReal j = J - 1;

  MaterialVolumetricPoints(spec, 1, &j, &g[0], &g[1], &g[2]);
}
