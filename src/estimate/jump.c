/* Traction defects on facets: jumps inside, P N - T on the boundary, each weighted by h/(p mu). */
#include "estimateimpl.h"

static PetscInt NumPoints_Private(PetscInt dim, const FacetPlace *f)
{
  return dim == 2 ? f->num_1d : f->num_1d * f->num_1d;
}

PetscErrorCode EstimateTracePoints_Private(const EstimateSum *sum, PetscInt cell, PetscReal xi[])
{
  const PetscInt dim = sum->v->dim;

  PetscFunctionBegin;
  for (PetscInt i = sum->facets.cell_first[cell]; i < sum->facets.cell_first[cell + 1]; ++i) {
    const FacetPlace *f    = &sum->facets.facets[sum->facets.cell_facet[i] / 2];
    const FacetSide  *side = &f->side[sum->facets.cell_facet[i] % 2];
    const Basis1D    *gauss;
    PetscCall(Basis1DGet(1, f->num_1d, &gauss));
    for (PetscInt q = 0; q < NumPoints_Private(dim, f); ++q, xi += dim) {
      const PetscReal eta[2] = {gauss->points[q % f->num_1d], gauss->points[q / f->num_1d]};
      PetscReal       place[3];
      FacetSidePoint_Private(side, dim, eta, place);
      for (PetscInt d = 0; d < dim; ++d) xi[d] = place[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* normal * (reference area per unit of the side's own coordinates) out of the cell: +- det J J^-T e_direction. */
static PetscReal OutwardArea_Private(PetscInt side, const PetscReal J[9], PetscReal normal[3])
{
  const PetscInt  a = (side / 2 + 1) % 3, b = (side / 2 + 2) % 3;
  const PetscReal sign = side % 2 ? 1 : -1;

  for (PetscInt c = 0; c < 3; ++c) {
    const PetscInt k = (c + 1) % 3, l = (c + 2) % 3;
    normal[c] = sign * (J[3 * k + a] * J[3 * l + b] - J[3 * l + a] * J[3 * k + b]);
  }
  const PetscReal area = PetscSqrtReal(Dot3(normal, normal));
  for (PetscInt c = 0; c < 3; ++c) normal[c] /= area;
  return area;
}

/* Add -p J F^-T N: follower pressure pulled back to the reference area (its cofactor form needs no inverse); small: -p N. */
static void Follower_Private(PetscReal pressure, Kinematics kinematics, const PetscReal F[9], const PetscReal N[3], PetscReal T[3])
{
  for (PetscInt i = 0; i < 3; ++i) {
    const PetscInt k = (i + 1) % 3, l = (i + 2) % 3;
    PetscReal      n = N[i];
    if (kinematics == KINEMATICS_FINITE) {
      n = 0;
      for (PetscInt J = 0; J < 3; ++J) {
        const PetscInt K = (J + 1) % 3, L = (J + 2) % 3;
        n += (F[3 * k + K] * F[3 * l + L] - F[3 * k + L] * F[3 * l + K]) * N[J];
      }
    }
    T[i] -= pressure * n;
  }
}

/* External traction of the scene's boundaries on a facet. */
static PetscErrorCode Load_Private(const EstimateSum *sum, const FacetPlace *f, const PetscReal X[3], const PetscReal F[9], const PetscReal N[3],
                                   PetscReal T[3])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < sum->spec->num_boundaries; ++b) {
    const BoundarySpec *s = &sum->spec->boundaries[b];
    PetscReal           value;
    if (!((f->groups >> s->group) & 1)) continue;
    for (PetscInt c = 0; c < sum->v->dim; ++c) {
      if (!s->traction[c]) continue;
      PetscCall(MechanicsValue(s->traction[c], &s->amplitude, X, sum->time, &value));
      T[c] += value;
    }
    if (!BoundaryHasPressure(s)) continue;
    PetscCall(MechanicsPressure(sum->mechanics, b, X, sum->time, &value));
    Follower_Private(value, sum->spec->kinematics, F, N, T);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add P N - T of one side at one point to the defect. */
static PetscErrorCode Defect_Private(EstimateSum *sum, const FacetPlace *f, PetscBool touches, const PetscReal X[3], const PetscReal N[3], const PetscReal F[9],
                                     const PetscReal P[9], PetscReal defect[3])
{
  PetscReal T[3] = {0, 0, 0};

  PetscFunctionBegin;
  if (f->loaded) PetscCall(Load_Private(sum, f, X, F, N, T));
  if (touches) ContactTermsTraction_Private(sum->contact, f->facet, X, T);
  for (PetscInt c = 0; c < sum->v->dim; ++c) defect[c] += P[3 * c] * N[0] + P[3 * c + 1] * N[1] + P[3 * c + 2] * N[2] - T[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Defects at the facet points of a cell, where position [][3], dX/dxi, F and P [][9] are known. */
PetscErrorCode EstimateTraces_Private(EstimateSum *sum, PetscInt cell, const PetscReal position[], const PetscReal J[], const PetscReal F[],
                                      const PetscReal P[], PetscReal modulus)
{
  const PetscInt      dim      = sum->v->dim;
  const MaterialSpec *material = sum->spec->bodies[sum->t->leaf_body[sum->v->cell_leaf[cell]]].material;

  PetscFunctionBegin;
  for (PetscInt i = sum->facets.cell_first[cell]; i < sum->facets.cell_first[cell + 1]; ++i) {
    const FacetPlace *f       = &sum->facets.facets[sum->facets.cell_facet[i] / 2];
    const FacetSide  *side    = &f->side[sum->facets.cell_facet[i] % 2];
    const PetscBool   touches = ContactTermsHave_Private(sum->contact, f->facet);
    const PetscReal   scale   = PetscAbsReal(side->slope[0]) * (dim == 3 ? PetscAbsReal(side->slope[1]) : 1);
    const Basis1D    *gauss;
    PetscCall(Basis1DGet(1, f->num_1d, &gauss));
    for (PetscInt q = 0; q < NumPoints_Private(dim, f); ++q, position += 3, J += 9, F += 9, P += 9) {
      const PetscInt point = f->first_point + q;
      PetscReal      normal[3], weight = scale * gauss->weights[q % f->num_1d];
      if (dim == 3) weight *= gauss->weights[q / f->num_1d];
      if (sum->spec->model == MODEL_AXISYMMETRIC) weight *= 2 * PETSC_PI * position[0];
      sum->dA[point] = weight * OutwardArea_Private(side->side, J, normal);
      if (side == &f->side[0]) {
        PetscCall(PetscArraycpy(sum->normal[point], normal, 3));
        Follower_Private(-1, sum->spec->kinematics, F, normal, sum->flux[point]);
      }
      sum->modulus[point] +=
          PetscMax(modulus, EstimateTangent_Private(material, sum->spec->kinematics, F, P)) * (f->side[0].cell >= 0 && f->side[1].cell >= 0 ? 0.5 : 1);
      PetscCall(Defect_Private(sum, f, touches, position, normal, F, P, sum->defect[point]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Squared length of the defect without the prescribed directions (a reaction acts there, whatever it is). An outer face that may only slide in its plane and
   bears no load is taken for a plane of symmetry: half the square of the jump to the mirror image, 2 d, so that a part of a symmetric body has its part of the
   estimate and a symmetric mesh is refined alike on and off the plane. */
static PetscReal Free_Private(PetscInt dim, PetscInt fixed, PetscBool outer, const PetscReal N[3], const PetscReal defect[3])
{
  PetscReal d[3], n[3], length = 0;

  for (PetscInt c = 0; c < 3; ++c) {
    const PetscBool gone = (PetscBool)(c >= dim || ((fixed >> c) & 1));
    d[c]                 = gone ? 0 : defect[c];
    n[c]                 = gone ? 0 : N[c];
  }
  length                 = Dot3(n, n);
  const PetscBool slides = (PetscBool)(fixed && ((fixed & 8) || !(length > 1e-12)));
  if ((fixed & 8) && length > 1e-12) {
    const PetscReal along = Dot3(d, n) / length;
    for (PetscInt c = 0; c < 3; ++c) d[c] -= along * n[c];
  }
  return (slides && outer ? 2 : 1) * Dot3(d, d);
}

PetscReal EstimateFree_Private(const EstimateSum *sum, const FacetPlace *f, PetscInt point, const PetscReal defect[3])
{
  const PetscBool inside = (PetscBool)(f->side[0].cell >= 0 && f->side[1].cell >= 0);

  return Free_Private(sum->v->dim, f->fixed, (PetscBool)(!inside && !f->loaded), sum->normal[point], defect);
}

PetscReal EstimateFacetWeight_Private(const EstimateSum *sum, const FacetPlace *f, PetscInt side, const PetscReal height[][3])
{
  const FacetSide *s       = &f->side[side];
  const PetscBool  inside  = (PetscBool)(f->side[0].cell >= 0 && f->side[1].cell >= 0);
  PetscReal        modulus = 0;

  if (s->cell < 0 || s->cell >= sum->v->num_owned_cells) return 0;
  for (PetscInt q = f->first_point; q < f->first_point + NumPoints_Private(sum->v->dim, f); ++q) modulus = PetscMax(modulus, sum->modulus[q]);
  return EstimateScale_Private(f->order) * (inside ? 0.5 : 1) / f->order * height[s->cell][s->side / 2] / modulus;
}

/* eta2 of owned leaves += scale * share * h/(p mu) |defect|^2; h: the leaf's height over the facet, p: the order of the trace. */
PetscErrorCode EstimateFacets_Private(EstimateSum *sum, const PetscReal height[][3])
{
  const PetscInt dim = sum->v->dim;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetPlace *f      = &sum->facets.facets[i];
    const PetscBool   inside = (PetscBool)(f->side[0].cell >= 0 && f->side[1].cell >= 0);
    const PetscInt    part   = inside ? PART_JUMP : ContactTermsHave_Private(sum->contact, f->facet) ? PART_CONTACT : PART_BOUNDARY;
    PetscReal         square = 0;
    for (PetscInt q = f->first_point; q < f->first_point + NumPoints_Private(dim, f); ++q)
      square += sum->dA[q] * EstimateFree_Private(sum, f, q, sum->defect[q]);
    for (PetscInt s = 0; s < 2; ++s) {
      const FacetSide *side = &f->side[s];
      if (side->cell < 0 || side->cell >= sum->v->num_owned_cells) continue;
      const PetscReal value = EstimateFacetWeight_Private(sum, f, s, height) * square;
      sum->eta2[sum->v->cell_leaf[side->cell]] += value;
      sum->part[part] += value;
      if (inside && sum->along) sum->along[sum->v->cell_leaf[side->cell]][side->side / 2] += value;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
