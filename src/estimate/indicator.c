/* The residual estimate: sums over cells (equilibrium inside, incompressibility), then over facets, then over ranks.

     eta_K^2 = scale { h^2/(p^2 m) |Div P + B|^2 + 1/2 sum h/(p m) |[P N]|^2 + sum h/(p m) |P N - T|^2 } + complementarity of contact
     mixed cells: P with the recovered pressure (recover.c; its level in cells of order 1: level.c), + 1/kappa |q|^2 + w |g - Proj g|^2
     m, scale: EstimateModulus_Private, EstimateScale_Private

   (docs/theory.md, error estimation). Div P is exact for the polynomial through the values of P at the Gauss points. */
#include "estimateimpl.h"

/* Derivatives at the points x[n] of the Lagrange polynomials through them, by barycentric weights. */
static void LagrangeDerivative_Private(PetscInt n, const PetscReal x[], PetscReal D[][ESTIMATE_MOST_1D])
{
  PetscReal w[ESTIMATE_MOST_1D];

  for (PetscInt j = 0; j < n; ++j) {
    w[j] = 1;
    for (PetscInt k = 0; k < n; ++k)
      if (k != j) w[j] *= x[j] - x[k];
  }
  for (PetscInt i = 0; i < n; ++i) {
    D[i][i] = 0;
    for (PetscInt j = 0; j < n; ++j) {
      if (i == j) continue;
      D[i][j] = w[i] / (w[j] * (x[i] - x[j]));
      D[i][i] -= D[i][j];
    }
  }
}

/* Points in each direction: order+1; mixed: one more, for the recovered pressure has more coefficients. From order 5 on one more an order, in space from 4 on
   two at least, because stresses are no polynomials: the difference between Div P and that of the polynomial through as few values would be more than the error
   that is to be told. */
static PetscInt LinePoints_Private(PetscInt dim, PetscInt order, PetscBool mixed)
{
  const PetscInt more = dim < 3 ? PetscMax(0, order - 4) : order < 4 ? 0 : PetscMax(2, order - 3);

  return PetscMin(ESTIMATE_MOST_1D, order + (mixed ? 2 : 1) + more);
}

static PetscErrorCode TableCreate_Private(PetscInt dim, PetscInt order, PetscBool mixed, VolumeTable *table)
{
  const PetscInt n1 = LinePoints_Private(dim, order, mixed), num = ElementNumNodes(dim, n1 - 1);
  const Basis1D *gauss;

  PetscFunctionBegin;
  if (table->order) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Basis1DGet(order, n1, &gauss));
  table->order = order;
  table->n1    = n1;
  table->num   = num;
  PetscCall(PetscMalloc2(num * dim, &table->xi, num, &table->weight));
  for (PetscInt q = 0; q < num; ++q) table->weight[q] = Basis1DPoint(gauss, dim, q, table->xi + q * dim);
  LagrangeDerivative_Private(table->n1, gauss->points, table->D);
  if (mixed) PetscCall(RecoveryCreate_Private(dim, table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far apart the cell's sides across each direction are: along the normal of the surface halfway between them, at the middle of the cell. */
static void Height_Private(PetscInt dim, PetscInt order, const PetscReal X[], PetscReal height[3])
{
  const PetscInt stride[3] = {order, order * (order + 1), order * (order + 1) * (order + 1)}, edges = 1 << (dim - 1);
  PetscReal      along[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}, across[3];

  for (PetscInt d = 0; d < dim; ++d) {
    for (PetscInt c = 0; c < 3; ++c) along[d][c] = 0;
    for (PetscInt corner = 0; corner < 1 << dim; ++corner) {
      PetscInt node = 0;
      for (PetscInt a = 0; a < dim; ++a) node += ((corner >> a) & 1) * stride[a];
      for (PetscInt c = 0; c < dim; ++c) along[d][c] += ((corner >> d) & 1 ? 1 : -1) * X[node * dim + c] / edges;
    }
  }
  for (PetscInt d = 0; d < dim; ++d) {
    Cross3(along[(d + 1) % 3], along[(d + 2) % 3], across);
    height[d] = PetscAbsReal(Dot3(along[d], across)) / PetscSqrtReal(Dot3(across, across));
  }
}

/* Div P at Gauss point q: derivative of the tensor Lagrange polynomial, mapped by J^-1; axisymmetric: plus (P_rR - P_tt)/R, P_zR/R. S: the square of what each
   axis adds to it over a cell's length of that axis. */
static void Divergence_Private(PetscInt dim, Model model, const VolumeTable *table, PetscInt q, const PetscReal *P, const PetscReal J[9], const PetscReal X[3],
                               PetscReal div[3], PetscReal S[3])
{
  const PetscReal det = Det3(J);

  div[0] = div[1] = div[2] = 0;
  for (PetscInt d = 0, stride = 1; d < dim; ++d, stride *= table->n1) {
    const PetscInt i = q / stride % table->n1, a = (d + 1) % 3, b = (d + 2) % 3;
    PetscReal      gradient[3], dP[9] = {0};
    for (PetscInt c = 0; c < 3; ++c) { /* row d of J^-1: grad xi_d */
      const PetscInt k = (c + 1) % 3, l = (c + 2) % 3;
      gradient[c] = (J[3 * k + a] * J[3 * l + b] - J[3 * l + a] * J[3 * k + b]) / det;
    }
    for (PetscInt j = 0; j < table->n1; ++j) {
      const PetscReal *p = P + 9 * (q + (j - i) * stride), D = table->D[i][j];
      for (PetscInt k = 0; k < 3 * dim; ++k) dP[k] += D * p[k];
    }
    S[d] = 0;
    for (PetscInt c = 0; c < dim; ++c) {
      const PetscReal part = Dot3(dP + 3 * c, gradient);
      div[c] += part;
      S[d] += PetscSqr(part) / Dot3(gradient, gradient);
    }
  }
  if (model == MODEL_AXISYMMETRIC) {
    div[0] += (P[9 * q] - P[9 * q + 8]) / X[0];
    div[1] += P[9 * q + 3] / X[0];
  }
}

/* R = Div P + B at the Gauss points. */
static PetscErrorCode Residual_Private(const EstimateSum *sum, const BodySpec *body, const VolumeTable *table, CellWork *w)
{
  const PetscInt dim = sum->v->dim;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < table->num; ++q) {
    PetscReal force;
    Divergence_Private(dim, sum->spec->model, table, q, w->P, w->J + 9 * q, w->position + 3 * q, w->R + 3 * q, w->S + 3 * q);
    for (PetscInt c = 0; c < dim; ++c) {
      if (!body->force[c]) continue;
      PetscCall(MechanicsValue(body->force[c], &body->amplitude, w->position + 3 * q, sum->time, &force));
      w->R[3 * q + c] += force;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal WeightedSquare_Private(PetscInt num, PetscInt components, const PetscReal weight[], const PetscReal values[])
{
  PetscReal sum = 0;

  for (PetscInt q = 0; q < num; ++q) {
    for (PetscInt c = 0; c < components; ++c) sum += weight[q] * PetscSqr(values[components * q + c]);
  }
  return sum;
}

/* The part of g(J) that the pressure space does not see, in w->g: the residual of the pressure's equation g = pi/modulus. */
static PetscErrorCode UnseenVolume_Private(const EstimateSum *sum, const MaterialSpec *material, const VolumeTable *table, CellWork *w)
{
  PetscReal coefficient[ESTIMATE_MOST_NODES], *projected = w->g + table->num, g[3];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < table->num; ++q) {
    const PetscReal *F = w->F + 9 * q;
    if (sum->spec->kinematics == KINEMATICS_FINITE)
      MaterialVolumetric(material, Det3(F), g);
    else
      g[0] = F[0] + F[4] + F[8] - 3; /* every law is linear there */
    w->g[q] = g[0];
  }
  PetscCall(MechanicsPressureProject(sum->v->dim, table->order, table->num, table->xi, w->weight, w->g, coefficient));
  PetscCall(MechanicsPressureEvaluate(sum->v->dim, table->order, table->num, table->xi, coefficient, projected));
  for (PetscInt q = 0; q < table->num; ++q) w->g[q] -= projected[q];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal VolumetricModulus_Private(const EstimateSum *sum, const MaterialSpec *material)
{
  return sum->spec->kinematics == KINEMATICS_FINITE ? MaterialVolumetricModulus(material) : material->kappa;
}

/* Incompressibility: 1/kappa |q|^2, the error of the pressure as recovered (modulus for kappa where that is more, for q balances the error of the stress), and
   w |g - Proj g|^2, w = 2 mu / (1 + 2 mu / kappa): a volume error that the pressure space does not see is answered by shear, however stiff the material is
   against its mean; of that what flow has left of the stiffness is told. */
static PetscErrorCode Volume_Private(EstimateSum *sum, PetscInt cell, const MaterialSpec *material, const VolumeTable *table, PetscReal modulus, CellWork *w)
{
  const PetscInt  leaf  = sum->v->cell_leaf[cell];
  const PetscReal kappa = VolumetricModulus_Private(sum, material);

  PetscFunctionBegin;
  const PetscReal seen = WeightedSquare_Private(table->num, 1, w->weight, w->recovered) / PetscMax(kappa, modulus);
  if (table->order == 1) {
    sum->compliance[cell] = 0;
    for (PetscInt q = 0; q < table->num; ++q) sum->compliance[cell] += w->weight[q] / PetscMax(kappa, modulus);
  }
  PetscCall(UnseenVolume_Private(sum, material, table, w));
  const PetscReal unseen = 2 * material->mu / (1 + 2 * material->mu / kappa) * WeightedSquare_Private(table->num, 1, w->weight, w->g);
  sum->eta2[leaf] += seen + unseen;
  sum->part[PART_VOLUME] += seen + EstimateLeft_Private(sum, leaf) * unseen;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Weights_Private(const EstimateSum *sum, const VolumeTable *table, CellWork *w)
{
  for (PetscInt q = 0; q < table->num; ++q) {
    w->weight[q] = table->weight[q] * Det3(w->J + 9 * q);
    if (sum->spec->model == MODEL_AXISYMMETRIC) w->weight[q] *= 2 * PETSC_PI * w->position[3 * q];
  }
}

/* Energy, interior residual and incompressibility of an owned cell. modulus: of its stiffest point. */
static PetscErrorCode OwnedCell_Private(EstimateSum *sum, PetscInt cell, const VolumeTable *table, CellWork *w, const PetscReal height[3], PetscReal modulus)
{
  const PetscInt      leaf     = sum->v->cell_leaf[cell];
  const MaterialSpec *material = sum->spec->bodies[sum->t->leaf_body[leaf]].material;
  PetscReal           h        = height[0], square;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < table->num; ++q) sum->energy += w->weight[q] * w->W[q];
  for (PetscInt d = 1; d < sum->v->dim; ++d) h = PetscMin(h, height[d]);
  square = WeightedSquare_Private(table->num, 3, w->weight, w->R) * EstimateScale_Private(table->order) * PetscSqr(h / table->order) / modulus;
  sum->eta2[leaf] += square;
  sum->part[PART_INTERIOR] += square;
  EstimateInterior_Private(sum, leaf, table->num, w->weight, w->S, square);
  if (material->mixed) PetscCall(Volume_Private(sum, cell, material, table, modulus, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal LeastDet_Private(PetscInt num, const PetscReal F[])
{
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt q = 0; q < num; ++q) least = PetscMin(least, Det3(F + 9 * q));
  return least;
}

/* The least det F of a cell at its integration points. */
static PetscErrorCode LeastOfSolution_Private(const EstimateSum *sum, PetscInt cell, PetscReal *least)
{
  const PetscInt dim = sum->v->dim;
  const Basis1D *rule;
  PetscReal     *xi, *F;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(sum->v->cell_order[cell], &rule));
  const PetscInt n = rule->num_points, num = ElementNumNodes(dim, n - 1);
  PetscCall(PetscMalloc2(num * dim, &xi, num * 9, &F));
  for (PetscInt q = 0; q < num; ++q)
    for (PetscInt d = 0, k = q; d < dim; ++d, k /= n) xi[q * dim + d] = rule->points[k % n];
  PetscCall(MechanicsPoints(sum->mechanics, cell, num, xi, sum->u, &(PointValues){.F = F}));
  *least = LeastDet_Private(num, F);
  PetscCall(PetscFree2(xi, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cell may be folded between its integration points and its corners, whose F comes after that of the num others (det F <= 0), where no law has an answer, and
   on the way there stresses grow without bound. Where det F is less than at all integration points the estimate takes what is at the first of eight places on
   the way to the cell's centre where it is not. */
static PetscErrorCode Unfold_Private(const EstimateSum *sum, PetscInt cell, PetscInt num, CellWork *w)
{
  const PetscInt dim = sum->v->dim;
  PetscReal      least;

  PetscFunctionBegin;
  if (sum->spec->kinematics == KINEMATICS_SMALL || LeastDet_Private(1 << dim, w->F + 9 * num) > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LeastOfSolution_Private(sum, cell, &least));
  for (PetscInt q = 0; q < num; ++q) {
    for (PetscInt eighth = 7; eighth >= 0 && !(Det3(w->F + 9 * q) >= least); --eighth) {
      PetscReal xi[3];
      for (PetscInt c = 0; c < dim; ++c) xi[c] = 0.5 + 0.125 * (PetscReal)eighth * (w->xi[q * dim + c] - 0.5);
      PetscCall(MechanicsPoints(sum->mechanics, cell, 1, xi, sum->u, &(PointValues){.F = w->F + 9 * q, .P = w->P + 9 * q, .W = w->W + q}));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One call of the material for all points of a cell: Gauss points first, then those of its facets, then the corners. Where a cell collapses, its polynomials
   and their derivatives take the steepness of its stiffest point everywhere: the weight of all its terms is that point's, too. A ghost's Gauss points tell
   that, and its pressure. */
static PetscErrorCode Cell_Private(EstimateSum *sum, PetscInt cell, VolumeTable tables[][2], CellWork *w, PetscReal height[][3])
{
  const PetscInt  dim = sum->v->dim, order = sum->v->cell_order[cell];
  const BodySpec *body  = &sum->spec->bodies[sum->t->leaf_body[sum->v->cell_leaf[cell]]];
  const PetscBool owned = (PetscBool)(cell < sum->v->num_owned_cells), mixed = body->material->mixed;
  VolumeTable    *table   = &tables[order][mixed];
  PetscInt        traces  = 0;
  PetscReal       modulus = 0;

  PetscFunctionBegin;
  for (PetscInt i = sum->facets.cell_first[cell]; i < sum->facets.cell_first[cell + 1]; ++i) {
    const PetscInt n1 = sum->facets.facets[sum->facets.cell_facet[i] / 2].num_1d;
    traces += dim == 2 ? n1 : n1 * n1;
  }
  if (!owned && !traces) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TableCreate_Private(dim, order, mixed, table));
  PetscCall(HPSpaceGatherPositions(sum->space, cell, w->X));
  const PetscInt num = table->num;
  PetscCall(PetscArraycpy(w->xi, table->xi, num * dim));
  PetscReal *xi = w->xi + num * dim, *F = w->F + 9 * num, *P = w->P + 9 * num, *J = w->J + 9 * num, *position = w->position + 3 * num;
  PetscCall(EstimateTracePoints_Private(sum, cell, xi));
  for (PetscInt k = 0; k < dim << dim; ++k) xi[traces * dim + k] = (k / dim >> k % dim) & 1;
  PetscCall(MechanicsPoints(sum->mechanics, cell, num + traces + (1 << dim), w->xi, sum->u, &(PointValues){w->position, w->J, w->F, w->P, w->W}));
  PetscCall(Unfold_Private(sum, cell, num + traces, w));
  if (owned || mixed) {
    Weights_Private(sum, table, w);
    PetscCall(Residual_Private(sum, body, table, w));
  }
  for (PetscInt q = 0; q < num; ++q) modulus = PetscMax(modulus, EstimateTangent_Private(body->material, sum->spec->kinematics, w->F + 9 * q, w->P + 9 * q));
  if (mixed) PetscCall(EstimateRecover_Private(sum, table, w, traces, xi, F, P));
  if (owned) {
    Height_Private(dim, order, w->X, height[cell]);
    PetscCall(OwnedCell_Private(sum, cell, table, w, height[cell], modulus));
  }
  PetscCall(EstimateTraces_Private(sum, cell, position, J, F, P, modulus));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WorkCreate_Private(const EstimateSum *sum, CellWork *w)
{
  PetscInt most = 0;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < sum->v->num_cells; ++c)
    most = PetscMax(most, ElementNumNodes(sum->v->dim, LinePoints_Private(sum->v->dim, sum->v->cell_order[c], PETSC_TRUE) - 1));
  const PetscInt points = most + sum->facets.most_points + (1 << sum->v->dim);
  PetscCall(
      PetscMalloc7(3 * most, &w->X, 3 * points, &w->xi, 3 * points, &w->position, 9 * points, &w->J, 9 * points, &w->F, 9 * points, &w->P, points, &w->W));
  PetscCall(PetscMalloc5(most, &w->weight, 2 * most, &w->g, 3 * most, &w->R, 3 * most, &w->S, most, &w->recovered));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WorkDestroy_Private(CellWork *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree7(w->X, w->xi, w->position, w->J, w->F, w->P, w->W));
  PetscCall(PetscFree5(w->weight, w->g, w->R, w->S, w->recovered));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Cells_Private(EstimateSum *sum, PetscReal height[][3])
{
  VolumeTable tables[MORTISE_MAX_ORDER + 1][2] = {0};
  CellWork    w;

  PetscFunctionBegin;
  PetscCall(WorkCreate_Private(sum, &w));
  for (PetscInt c = 0; c < sum->v->num_cells; ++c) {
    const BodySpec *body = &sum->spec->bodies[sum->t->leaf_body[sum->v->cell_leaf[c]]];
    if (!body->material->law->rigid) PetscCall(Cell_Private(sum, c, tables, &w, height));
  }
  for (PetscInt i = 2; i < 2 * (MORTISE_MAX_ORDER + 1); ++i) {
    VolumeTable *table = &tables[i / 2][i % 2];
    if (!table->order) continue;
    PetscCall(PetscFree2(table->xi, table->weight));
    PetscCall(RecoveryDestroy_Private(table));
  }
  PetscCall(WorkDestroy_Private(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateBulk_Private(EstimateSum *sum)
{
  PetscReal(*height)[3];

  PetscFunctionBegin;
  sum->v              = HPSpaceGetTables(sum->space);
  const Forest forest = HPSpaceGetForest(sum->space);
  sum->t              = ForestGetTables(forest);
  sum->energy         = 0;
  sum->overlap        = (EstimateOverlap){0};
  PetscCall(PetscArrayzero(sum->part, NUM_PARTS));
  PetscCall(FacetListCreate_Private(sum, &sum->facets));
  PetscCall(PetscCalloc5(sum->facets.num_points, &sum->defect, sum->facets.num_points, &sum->normal, sum->facets.num_points, &sum->flux, sum->facets.num_points,
                         &sum->dA, sum->facets.num_points, &sum->modulus));
  PetscCall(PetscCalloc2(sum->v->num_owned_cells, &height, sum->v->num_owned_cells, &sum->compliance));
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) sum->compliance[c] = -1;
  PetscCall(EstimateFlow_Private(sum));
  PetscCall(Cells_Private(sum, height));
  PetscCall(EstimateLevels_Private(sum, ForestComm(forest), height));
  PetscCall(EstimateFacets_Private(sum, height));
  if (sum->contact) {
    PetscCall(EstimateComplementarity_Private(sum));
    PetscCall(EstimateGap_Private(sum));
    PetscCall(EstimateSlip_Private(sum));
  }
  if (sum->along) PetscCall(EstimateDoubts_Private(sum));
  PetscCall(PetscFree(sum->left));
  PetscCall(PetscFree2(height, sum->compliance));
  PetscCall(PetscFree5(sum->defect, sum->normal, sum->flux, sum->dA, sum->modulus));
  PetscCall(FacetListDestroy_Private(&sum->facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define UNBOUNDED 1e200 /* its square root can still be squared */

/* Stress that overflows, or that no law answers for, is the largest of errors, not none. */
static void Bound_Private(PetscInt num, PetscReal square[])
{
  for (PetscInt i = 0; i < num; ++i) square[i] = square[i] < UNBOUNDED ? square[i] : UNBOUNDED;
}

/* The deepest overlap of all ranks; total and parts are known. */
static PetscErrorCode Overlap_Private(MPI_Comm comm, const EstimateSum *sum, Estimate *e)
{
  PetscFunctionBegin;
  e->overlap = sum->overlap;
  PetscCall(BroadcastLargest(comm, e->overlap.share, &e->overlap, sizeof(e->overlap)));
  if (2 * e->part[PART_CONTACT] <= PetscSqr(e->total)) e->overlap.share = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* eta2 and along, shares and energy over all ranks. */
static PetscErrorCode Reduce_Private(MPI_Comm comm, EstimateSum *sum, Estimate *e)
{
  PetscReal *buffer;

  PetscFunctionBegin;
  Bound_Private(3 * e->num_leaves, sum->along[0]);
  Bound_Private(e->num_leaves, sum->eta2);
  Bound_Private(NUM_PARTS, sum->part);
  Bound_Private(1, &sum->energy);
  PetscCallMPI(MPI_Allreduce(sum->along, e->along, (PetscMPIInt)(3 * e->num_leaves), MPIU_REAL, MPI_SUM, comm));
  PetscCall(PetscMalloc1(e->num_leaves + NUM_PARTS + 1, &buffer));
  PetscCall(PetscArraycpy(buffer, sum->eta2, e->num_leaves));
  PetscCall(PetscArraycpy(buffer + e->num_leaves, sum->part, NUM_PARTS));
  buffer[e->num_leaves + NUM_PARTS] = sum->energy;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, buffer, (PetscMPIInt)(e->num_leaves + NUM_PARTS + 1), MPIU_REAL, MPI_SUM, comm));
  PetscCall(PetscArraycpy(e->eta2, buffer, e->num_leaves));
  PetscCall(PetscArraycpy(e->part, buffer + e->num_leaves, NUM_PARTS));
  const PetscReal energy = buffer[e->num_leaves + NUM_PARTS];
  PetscCall(PetscFree(buffer));
  e->total = 0;
  for (PetscInt i = 0; i < NUM_PARTS; ++i) e->total += e->part[i];
  e->total    = PetscSqrtReal(e->total);
  e->norm     = PetscSqrtReal(2 * PetscMax(energy, 0));
  e->relative = e->total > 0 ? e->total / PetscSqrtReal(PetscSqr(e->norm) + PetscSqr(e->total)) : 0;
  PetscCall(Overlap_Private(comm, sum, e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the choice between splitting and raising needs. */
static PetscErrorCode Choice_Private(const SceneData *scene, const EstimateSum *sum, const State *state, Estimate *e)
{
  const PetscMPIInt num = (PetscMPIInt)e->num_leaves;

  PetscFunctionBegin;
  if (scene->adapt.strategy == ADAPT_H) PetscFunctionReturn(PETSC_SUCCESS);
  const Forest forest = HPSpaceGetForest(sum->space);
  PetscCall(PetscCalloc1(num, &e->decay));
  PetscCall(PetscCalloc1(num, &e->irregular));
  PetscCall(PetscMalloc1(num, &e->order));
  PetscCall(PetscArraycpy(e->order, state->leaf_order, num));
  PetscCall(ProblemInitialOrders(scene, forest, &e->lowest));
  PetscCall(EstimateDecay_Private(sum, e->decay));
  PetscCall(EstimateIrregular_Private(sum, e->irregular));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, e->decay, num, MPIU_REAL, MPI_SUM, ForestComm(forest)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, e->irregular, num, MPI_SIGNED_CHAR, MPI_BOR, ForestComm(forest)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateCompute(Problem problem, const State *state, Estimate *e)
{
  const SceneData *scene;
  ContactTerms     contact;
  EstimateSum      sum = {.time = state->t};
  PetscReal       *u;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_ESTIMATE));
  scene             = ProblemGetScene(problem);
  sum.space         = ProblemSpace(problem);
  sum.mechanics     = ProblemMechanics(problem);
  const HPTables *v = HPSpaceGetTables(sum.space);
  sum.spec          = &scene->mechanics;
  PetscCall(ProblemSetState(problem, state));
  if (scene->num_contacts) {
    PetscCall(ProblemRefresh(problem, state->x));
    PetscCall(ContactTermsCreate_Private(problem, &contact));
    sum.contact = &contact;
  }
  *e = (Estimate){.num_leaves = state->num_leaves};
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(PetscMalloc1(e->num_leaves, &e->eta2));
  PetscCall(PetscMalloc1(e->num_leaves, &e->along));
  PetscCall(PetscCalloc1(e->num_leaves, &sum.eta2));
  PetscCall(PetscCalloc1(e->num_leaves, &sum.along));
  PetscCall(ProblemLocalDisplacement(problem, state->x, u));
  sum.u = u;
  PetscCall(EstimateBulk_Private(&sum));
  PetscCall(Reduce_Private(ForestComm(ProblemForest(problem)), &sum, e));
  PetscCall(Choice_Private(scene, &sum, state, e));
  PetscCall(PetscFree(u));
  PetscCall(PetscFree(sum.eta2));
  PetscCall(PetscFree(sum.along));
  if (scene->num_contacts) PetscCall(ContactTermsDestroy_Private(&contact));
  PetscCall(StageEnd(STAGE_ESTIMATE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateDestroy(Estimate *e)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(e->eta2));
  PetscCall(PetscFree(e->along));
  PetscCall(PetscFree(e->decay));
  PetscCall(PetscFree(e->order));
  PetscCall(PetscFree(e->lowest));
  PetscCall(PetscFree(e->irregular));
  PetscCall(PetscMemzero(e, sizeof(*e)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
