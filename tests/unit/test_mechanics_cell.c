/* The cell kernel: residual = dE/du and tangent = dr/du by differences for every model, kinematics, order, law and formulation;
   patch, rigid motion, batches, inversion, stored pressure, and the energy of cases.md O-03 on one cell of order 4. */
#include "mechanicsimpl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal(call, 0)

typedef struct {
  const char *law;
  Volumetric  volumetric;
  PetscInt    num;
  const char *names[4];
  PetscReal   values[4];
} Choice;

static const Choice choices[] = {
    {"neo_hookean", VOLUMETRIC_LOG, 2, {"mu", "lambda"}, {1, 2}},
    {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {1, 5}},
    {"neo_hookean", VOLUMETRIC_QUADRATIC, 2, {"mu", "kappa"}, {1, 5}},
    {"mooney_rivlin", VOLUMETRIC_LOG, 3, {"c1", "c2", "kappa"}, {.3, .2, 5}},
    {"saint_venant_kirchhoff", VOLUMETRIC_QUADRATIC, 2, {"mu", "lambda"}, {1, 2}},
    {"linear", VOLUMETRIC_QUADRATIC, 2, {"mu", "kappa"}, {1, 5}},
    {"j2", VOLUMETRIC_SIMO, 4, {"mu", "kappa", "yield", "hardening"}, {1, 5, 1e-3, .1}}, /* flows everywhere from the first strain on */
};
#define NUM_CHOICES 7

static uint64_t seed = 12345;

static PetscReal Random(void)
{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (PetscReal)(seed >> 11) / 9007199254740992. - 0.5;
}

static void SpecMake(const Choice *choice, Formulation formulation, MaterialSpec *spec)
{
  PetscMemzero(spec, sizeof(*spec));
  PetscStrncpy(spec->name, "test", sizeof(spec->name));
  spec->law         = MaterialLawFind(choice->law);
  spec->volumetric  = choice->volumetric;
  spec->formulation = formulation;
  OK(MaterialSetUp(spec, choice->num, choice->names, choice->values));
}

/* Nodes of one cell: the unit cell from x = 1 (away from the axis), mapped by a multilinear distortion; `bend` moves every node at random as well. */
static void CellMake(PetscInt dim, PetscInt order, PetscReal amount, PetscReal bend, PetscReal *X)
{
  const PetscReal *nodes;
  const PetscInt   n1 = order + 1, n = ElementNumNodes(dim, order);

  OK(ElementGetNodes(order, &nodes));
  for (PetscInt node = 0; node < n; node++) {
    const PetscReal x = nodes[node % n1], y = nodes[node / n1 % n1], z = dim == 3 ? nodes[node / (n1 * n1)] : 0.3;

    X[node * dim]     = 1 + x + amount * (y * x + 0.5 * z * y + 0.2 * z);
    X[node * dim + 1] = y + amount * (0.7 * x - 0.3 * x * y + 0.2 * z * x);
    if (dim == 3) X[node * dim + 2] = z + amount * (0.4 * x * y * z - 0.2 * x + 0.3 * y);
    for (PetscInt c = 0; c < dim; c++) X[node * dim + c] += bend * Random() / order;
  }
}

static PetscReal *New(PetscInt n)
{
  PetscReal *a = calloc(PetscMax(n, 1), sizeof(PetscReal));

  assert_non_null(a);
  return a;
}

/* sum of w_i f(u + s_i h v) for the fourth-order central difference */
static const PetscReal step[4] = {-2, -1, 1, 2}, weight[4] = {1. / 12, -8. / 12, 8. / 12, -1. / 12};

/* One configuration: num directions (or all unit vectors); relative errors against the largest entry below 1e-8 (residual), 1e-8 (tangent, coupling). */
static void CheckDerivatives(PetscInt dim, Model model, Kinematics kinematics, PetscInt order, const Choice *choice, Formulation formulation)
{
  const PetscReal h = strcmp(choice->law, "j2") ? 1e-3 : 2e-4; /* its direction of flow turns quickly */
  MaterialSpec    spec;
  CellKernel      kernel;
  PetscInt        n, m, size, num, points, h_num;
  PetscReal      *history, *X, *u, *v, *w, *r, *K, *rs, *c, *cs, *b, e[4], most_r = 0, most_K = 0, most_b = 0;

  SpecMake(choice, formulation, &spec);
  OK(CellKernelCreate(dim, model, kinematics, order, &spec, &kernel));
  CellKernelSizes(kernel, &n, &m, NULL);
  CellKernelHistory(kernel, &points, &h_num);
  assert_int_equal(n, ElementNumNodes(dim, order));
  assert_int_equal(m > 0, formulation == FORMULATION_MIXED);
  size = n * dim;
  num  = size <= 24 ? size : 4;
  X = New(size), u = New(size), v = New(size), w = New(size), r = New(size), K = New(size * size), rs = New(4 * size), c = New(m + 1), cs = New(4 * m + 4),
  b       = New(m * size + 1);
  history = New(points * h_num);
  for (PetscInt q = 0; q < points && h_num; q++) spec.law->initial(&spec, history + q * h_num);
  CellMake(dim, order, 0.15, 0.02, X);
  for (PetscInt i = 0; i < size; i++) u[i] = 0.1 * Random() / order + 0.1 * X[i] * X[(i + 1) % size] / 4;
  CellBatch batch = {
      .nc = 1, .X = X, .u = u, .residual = r, .tangent = K, .consistent = m ? c : NULL, .dpressure = m ? b : NULL, .history = h_num ? history : NULL};
  OK(CellKernelEvaluate(kernel, &batch));
  assert_false(batch.bad);
  for (PetscInt i = 0; i < size; i++) most_r = PetscMax(most_r, PetscAbsReal(r[i]));
  for (PetscInt i = 0; i < size * size; i++) {
    most_K = PetscMax(most_K, PetscAbsReal(K[i]));
    if (!spec.law->unsymmetric) assert_near(K[i], K[i % size * size + i / size], 1e-13 * (1 + most_K));
  }
  for (PetscInt i = 0; i < m * size; i++) most_b = PetscMax(most_b, PetscAbsReal(b[i]));
  for (PetscInt k = 0; k < num; k++) {
    PetscReal slope = 0, product = 0;

    for (PetscInt i = 0; i < size; i++) v[i] = num == size ? i == k : Random() / PetscSqrtReal(size);
    for (int s = 0; s < 4; s++) {
      CellBatch moved = {
          .nc = 1, .X = X, .u = w, .energy = &e[s], .residual = rs + s * size, .consistent = m ? cs + s * m : NULL, .history = h_num ? history : NULL};

      for (PetscInt i = 0; i < size; i++) w[i] = u[i] + step[s] * h * v[i];
      OK(CellKernelEvaluate(kernel, &moved));
      slope += weight[s] * e[s] / h;
    }
    for (PetscInt i = 0; i < size; i++) product += r[i] * v[i];
    if (!h_num) assert_near(product, slope, 1e-8 * most_r);
    for (PetscInt i = 0; i < size; i++) {
      PetscReal Kv = 0, dr = 0;

      for (PetscInt j = 0; j < size; j++) Kv += K[i * size + j] * v[j];
      for (int s = 0; s < 4; s++) dr += weight[s] * rs[s * size + i] / h;
      assert_near(Kv, dr, 1e-8 * most_K);
    }
    for (PetscInt i = 0; i < m; i++) {
      PetscReal bv = 0, dc = 0;

      for (PetscInt j = 0; j < size; j++) bv += b[i * size + j] * v[j];
      for (int s = 0; s < 4; s++) dc += weight[s] * cs[s * m + i] / h;
      assert_near(bv, dc, 1e-8 * most_b);
    }
  }
  free(X), free(u), free(v), free(w), free(r), free(K), free(rs), free(c), free(cs), free(b), free(history);
  OK(CellKernelDestroy(&kernel));
}

static void DerivativesAgree(void **state)
{
  for (int model = 0; model < 3; model++) {
    for (int kinematics = 0; kinematics < 2; kinematics++) {
      for (PetscInt order = 1; order <= 4; order++) {
        for (int i = 0; i < NUM_CHOICES; i++) {
          if (!strcmp(choices[i].law, "linear") && kinematics == KINEMATICS_FINITE) continue;
          if (!strcmp(choices[i].law, "j2") && kinematics == KINEMATICS_SMALL) continue;
          CheckDerivatives(model == MODEL_3D ? 3 : 2, (Model)model, (Kinematics)kinematics, order, &choices[i], FORMULATION_DISPLACEMENT);
          if (MaterialLawFind(choices[i].law)->whole) continue;
          CheckDerivatives(model == MODEL_3D ? 3 : 2, (Model)model, (Kinematics)kinematics, order, &choices[i], FORMULATION_MIXED);
        }
      }
    }
  }
  CheckDerivatives(3, MODEL_3D, KINEMATICS_FINITE, 5, &choices[0], FORMULATION_MIXED);
  for (PetscInt order = 6; order <= 8; order++) { /* more points than nodes */
    CheckDerivatives(2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE, order, &choices[1], FORMULATION_MIXED);
    CheckDerivatives(2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, order, &choices[2], FORMULATION_DISPLACEMENT);
    CheckDerivatives(2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE, order, &choices[6], FORMULATION_MIXED);
    CheckDerivatives(3, MODEL_3D, KINEMATICS_FINITE, order, &choices[0], order == 6 ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT);
  }
}

/* A kernel with its material and arrays of one cell. */
typedef struct {
  MaterialSpec spec;
  CellKernel   kernel;
  PetscInt     dim, n, m, size;
  PetscReal   *X, *u, *r, *K, *c, energy, min_det;
  CellBatch    batch;
} Cell;

static void CellSetUp(Cell *cell, PetscInt dim, Model model, Kinematics kinematics, PetscInt order, const Choice *choice, Formulation formulation)
{
  SpecMake(choice, formulation, &cell->spec);
  OK(CellKernelCreate(dim, model, kinematics, order, &cell->spec, &cell->kernel));
  CellKernelSizes(cell->kernel, &cell->n, &cell->m, NULL);
  cell->dim  = dim;
  cell->size = cell->n * dim;
  cell->X = New(cell->size), cell->u = New(cell->size), cell->r = New(cell->size), cell->K = New(cell->size * cell->size), cell->c = New(cell->m + 1);
  cell->batch = (CellBatch){.nc         = 1,
                            .X          = cell->X,
                            .u          = cell->u,
                            .energy     = &cell->energy,
                            .residual   = cell->r,
                            .tangent    = cell->K,
                            .consistent = cell->m ? cell->c : NULL,
                            .min_det    = &cell->min_det};
}

static void CellTearDown(Cell *cell)
{
  free(cell->X), free(cell->u), free(cell->r), free(cell->K), free(cell->c);
  OK(CellKernelDestroy(&cell->kernel));
}

static PetscBool OnBoundary(PetscInt dim, PetscInt order, PetscInt node)
{
  const PetscInt n1 = order + 1, i = node % n1, j = node / n1 % n1, k = node / (n1 * n1);

  return i % order == 0 || j % order == 0 || (dim == 3 && k % order == 0) ? PETSC_TRUE : PETSC_FALSE;
}

/* u = (F1 - 1) X on a distorted cell: P = P(F1) at random points, no force on inner nodes, sum r (x) X = V P(F1): 1e-12 of the modulus. Mixed alike. */
static void PatchIsExact(void **state)
{
  const PetscReal H[9] = {.2, .15, -.1, .05, -.1, .2, -.08, .12, .05};

  for (PetscInt dim = 2; dim <= 3; dim++) {
    for (PetscInt order = 1; order <= 4; order++) {
      for (int formulation = 1; formulation <= 2; formulation++) {
        Cell      cell;
        PetscReal F1[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, P1[9], W1, xi[15], F[45], P[45], W[5], virial[9] = {0}, volume;
        PetscBool bad = PETSC_FALSE;

        CellSetUp(&cell, dim, dim == 3 ? MODEL_3D : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, order, &choices[1], (Formulation)formulation);
        CellMake(dim, order, 0.15, dim == 2 ? 0.02 : 0, cell.X); /* p+1 points integrate the forces exactly on these */
        for (PetscInt i = 0; i < cell.size; i++) {
          for (PetscInt J = 0; J < dim; J++) cell.u[i] += H[3 * (i % dim) + J] * cell.X[i / dim * dim + J];
        }
        for (PetscInt i = 0; i < dim; i++) {
          for (PetscInt J = 0; J < dim; J++) F1[3 * i + J] += H[3 * i + J];
        }
        MaterialPoints point = {.n = 1, .F = F1, .W = &W1, .P = P1};
        OK(MaterialEvaluate(&cell.spec, MATERIAL_FULL, &point));
        OK(CellKernelEvaluate(cell.kernel, &cell.batch));
        assert_near(cell.min_det, Det3(F1), 1e-13);
        volume = cell.energy / W1;
        for (PetscInt i = 0; i < 5 * dim; i++) xi[i] = 0.5 + Random();
        OK(CellKernelPoints(cell.kernel, 0, 5, xi, cell.X, cell.u, cell.m ? cell.c : NULL, NULL, &(PointValues){.F = F, .P = P, .W = W}, &bad));
        assert_false(bad);
        for (int i = 0; i < 45; i++) {
          assert_near(F[i], F1[i % 9], 1e-13);
          assert_near(P[i], P1[i % 9], 1e-12);
        }
        assert_near(W[2], W1, 1e-12);
        for (PetscInt node = 0; node < cell.n; node++) {
          for (PetscInt i = 0; i < dim; i++) {
            if (!OnBoundary(dim, order, node)) assert_near(cell.r[node * dim + i], 0, 1e-12);
            for (PetscInt J = 0; J < dim; J++) virial[3 * i + J] += cell.r[node * dim + i] * cell.X[node * dim + J];
          }
        }
        for (PetscInt i = 0; i < dim; i++) {
          for (PetscInt J = 0; J < dim; J++) assert_near(virial[3 * i + J], volume * P1[3 * i + J], 1e-12);
        }
        CellTearDown(&cell);
      }
    }
  }
}

/* A rotation by 130 degrees: no energy, no force; the tangent annihilates the infinitesimal rotation of the deformed cell. */
static void CheckRotation(PetscInt dim, PetscInt order, const Choice *choice, Formulation formulation)
{
  const PetscReal c = PetscCosReal(2.27), s = PetscSinReal(2.27);
  Cell            cell;

  CellSetUp(&cell, dim, dim == 3 ? MODEL_3D : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, order, choice, formulation);
  CellMake(dim, order, 0.15, 0.04 / order, cell.X);
  for (PetscInt node = 0; node < cell.n; node++) {
    const PetscReal *X = cell.X + node * dim;

    cell.u[node * dim]     = (c - 1) * X[0] - s * X[1];
    cell.u[node * dim + 1] = s * X[0] + (c - 1) * X[1];
  }
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_near(cell.energy, 0, 1e-14);
  for (PetscInt k = 0; k < cell.size; k++) {
    PetscReal spin = 0;

    for (PetscInt node = 0; node < cell.n; node++) {
      const PetscInt at = node * dim;

      spin += -cell.K[k * cell.size + at] * (cell.X[at + 1] + cell.u[at + 1]) + cell.K[k * cell.size + at + 1] * (cell.X[at] + cell.u[at]);
    }
    assert_near(cell.r[k], 0, 1e-13);
    assert_near(spin, 0, 1e-12);
  }
  CellTearDown(&cell);
}

static void RigidRotationIsFree(void **state)
{
  const PetscInt orders[4] = {2, 6, 7, 8};

  for (PetscInt dim = 2; dim <= 3; dim++) {
    for (int k = 0; k < 4; k++) {
      for (int i = 0; i < (dim == 2 || k == 0 ? 5 : 1); i++) {
        CheckRotation(dim, orders[k], &choices[i], FORMULATION_DISPLACEMENT);
        if (!MaterialLawFind(choices[i].law)->whole && orders[k] <= (dim == 2 ? 8 : 6)) CheckRotation(dim, orders[k], &choices[i], FORMULATION_MIXED);
      }
    }
  }
}

/* 21 different cells at once equal the cells one by one, whatever lane they fall in. */
static void BatchesEqualCells(void **state)
{
  enum { NC = 21 };
  Cell       one;
  PetscReal *X, *u, *e, *r, *K, *c;

  CellSetUp(&one, 2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE, 2, &choices[1], FORMULATION_MIXED);
  X = New(NC * one.size), u = New(NC * one.size), e = New(NC), r = New(NC * one.size), K = New(NC * one.size * one.size), c = New(NC * one.m);
  for (int k = 0; k < NC; k++) {
    CellMake(2, 2, 0.1, 0.02, X + k * one.size);
    for (PetscInt i = 0; i < one.size; i++) u[k * one.size + i] = 0.1 * Random();
  }
  CellBatch batch = {.nc = NC, .X = X, .u = u, .energy = e, .residual = r, .tangent = K, .consistent = c};
  OK(CellKernelEvaluate(one.kernel, &batch));
  for (int k = 0; k < NC; k++) {
    PetscMemcpy(one.X, X + k * one.size, one.size * sizeof(PetscReal));
    PetscMemcpy(one.u, u + k * one.size, one.size * sizeof(PetscReal));
    OK(CellKernelEvaluate(one.kernel, &one.batch));
    assert_near(one.energy, e[k], 1e-14);
    for (PetscInt i = 0; i < one.m; i++) assert_near(one.c[i], c[k * one.m + i], 1e-13);
    for (PetscInt i = 0; i < one.size; i++) assert_near(one.r[i], r[k * one.size + i], 1e-13);
    for (PetscInt i = 0; i < one.size * one.size; i++) assert_near(one.K[i], K[k * one.size * one.size + i], 1e-11);
  }
  free(X), free(u), free(e), free(r), free(K), free(c);
  CellTearDown(&one);
}

/* Where it acts the stored pressure is in the residual too: the consistent one changes nothing, another its forces by int dg/du, and no energy. Q1/P0, whose
   dpressure is kappa over the volume times that. */
static void StoredPressureActs(void **state)
{
  Cell       cell;
  PetscReal *r0, *dpressure, volume[16], e0, stored, sum = 0;
  PetscInt   points;

  CellSetUp(&cell, 3, MODEL_3D, KINEMATICS_FINITE, 1, &choices[2], FORMULATION_MIXED);
  assert_int_equal(cell.m, 1);
  r0 = New(cell.size), dpressure = New(cell.size);
  CellMake(3, 1, 0.15, 0.02, cell.X);
  for (PetscInt i = 0; i < cell.size; i++) cell.u[i] = 0.05 * Random();
  CellKernelHistory(cell.kernel, &points, NULL);
  OK(CellKernelVolumes(cell.kernel, cell.X, volume));
  for (PetscInt q = 0; q < points; q++) sum += volume[q];
  cell.batch.dpressure = dpressure;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  PetscMemcpy(r0, cell.r, cell.size * sizeof(PetscReal));
  e0                  = cell.energy;
  stored              = cell.c[0];
  cell.batch.pressure = &stored;
  cell.batch.acts     = PETSC_TRUE;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  for (PetscInt i = 0; i < cell.size; i++) assert_near(cell.r[i], r0[i], 0);
  stored += 2;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  for (PetscInt i = 0; i < cell.size; i++) assert_near(cell.r[i] - r0[i], 2 * dpressure[i] * sum / 5, 1e-14);
  assert_near(cell.energy, e0, 0);
  free(r0), free(dpressure);
  CellTearDown(&cell);
}

/* The stored pressure enters the tangent alone, and linearly: residual and energy stay; the consistent one gives the same tangent as none. */
static void StoredPressureIsGeometric(void **state)
{
  Cell       cell;
  PetscReal *K0, *K1, *r0, e0, stored[10];

  CellSetUp(&cell, 3, MODEL_3D, KINEMATICS_FINITE, 2, &choices[1], FORMULATION_MIXED);
  K0 = New(cell.size * cell.size), K1 = New(cell.size * cell.size), r0 = New(cell.size);
  CellMake(3, 2, 0.15, 0.02, cell.X);
  for (PetscInt i = 0; i < cell.size; i++) cell.u[i] = 0.05 * Random();
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  PetscMemcpy(K0, cell.K, cell.size * cell.size * sizeof(PetscReal));
  PetscMemcpy(r0, cell.r, cell.size * sizeof(PetscReal));
  e0 = cell.energy;
  for (PetscInt i = 0; i < cell.m; i++) stored[i] = cell.c[i];
  cell.batch.pressure = stored;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  for (PetscInt i = 0; i < cell.size * cell.size; i++) assert_near(cell.K[i], K0[i], 1e-14);
  for (PetscInt i = 0; i < cell.m; i++) stored[i] += 1 + i;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  PetscMemcpy(K1, cell.K, cell.size * cell.size * sizeof(PetscReal));
  for (PetscInt i = 0; i < cell.size; i++) assert_near(cell.r[i], r0[i], 0);
  assert_near(cell.energy, e0, 0);
  for (PetscInt i = 0; i < cell.m; i++) stored[i] += 1 + i;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  PetscReal most = 0;
  for (PetscInt i = 0; i < cell.size * cell.size; i++) {
    most = PetscMax(most, PetscAbsReal(K1[i] - K0[i]));
    assert_near(cell.K[i] - K1[i], K1[i] - K0[i], 1e-12);
  }
  assert_true(most > 0.01);
  free(K0), free(K1), free(r0);
  CellTearDown(&cell);
}

/* Q1/P0: the pressure is kappa times the mean of g(J), and a constant dilatation gives it exactly; from order 2 on it follows J within the cell. */
static void PressureIsProjection(void **state)
{
  Cell           cell;
  const Basis1D *b;
  PetscReal      volume = 0, mean = 0;

  CellSetUp(&cell, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, 1, &choices[2], FORMULATION_MIXED);
  assert_int_equal(cell.m, 1);
  CellMake(2, 1, 0, 0, cell.X);
  cell.u[6] = 0.2;
  cell.u[5] = 0.1;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  OK(Basis1DGet(1, 2, &b));
  for (int q = 0; q < 4; q++) {
    const PetscReal xi[2] = {b->points[q % 2], b->points[q / 2]};
    PetscReal       F[9];
    PetscBool       bad;

    OK(CellKernelPoints(cell.kernel, 0, 1, xi, cell.X, cell.u, cell.c, NULL, &(PointValues){.F = F}, &bad));
    volume += 0.25;
    mean += 0.25 * (Det3(F) - 1);
  }
  assert_near(cell.c[0], 5 * mean / volume, 1e-14);
  CellTearDown(&cell);
}

/* u_r = e R, u_z = 0 between R = 1 and 2: F = diag(1+e, 1, 1+e), volume 3 pi. */
static void AxisymmetricHoopIsExact(void **state)
{
  for (int formulation = 1; formulation <= 2; formulation++) {
    for (PetscInt order = 1; order <= 3; order++) {
      const PetscReal F[9] = {1.2, 0, 0, 0, 1, 0, 0, 0, 1.2};
      Cell            cell;
      PetscReal       W, P[9], work = 0;

      CellSetUp(&cell, 2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE, order, &choices[1], (Formulation)formulation);
      CellMake(2, order, 0, 0, cell.X);
      for (PetscInt node = 0; node < cell.n; node++) cell.u[2 * node] = 0.2 * cell.X[2 * node];
      OK(CellKernelEvaluate(cell.kernel, &cell.batch));
      MaterialPoints point = {.n = 1, .F = F, .W = &W, .P = P};
      OK(MaterialEvaluate(&cell.spec, MATERIAL_FULL, &point));
      assert_near(cell.energy, 3 * PETSC_PI * W, 1e-12);
      assert_near(cell.min_det, 1.44, 1e-14);
      for (PetscInt node = 0; node < cell.n; node++) work += cell.r[2 * node] * cell.X[2 * node];
      assert_near(work, 3 * PETSC_PI * (P[0] + P[8]), 1e-12);
      CellTearDown(&cell);
    }
  }
}

/* Small kinematics: every law is its linearisation at u = 0, whatever u is. */
static void SmallIsLinearised(void **state)
{
  for (int model = 0; model < 3; model++) {
    for (int formulation = 1; formulation <= 2; formulation++) {
      const PetscInt dim = model == MODEL_3D ? 3 : 2;
      Cell           finite, small;

      CellSetUp(&finite, dim, (Model)model, KINEMATICS_FINITE, 2, &choices[2], (Formulation)formulation);
      CellSetUp(&small, dim, (Model)model, KINEMATICS_SMALL, 2, &choices[2], (Formulation)formulation);
      CellMake(dim, 2, 0.1, 0.02, finite.X);
      PetscMemcpy(small.X, finite.X, finite.size * sizeof(PetscReal));
      for (PetscInt i = 0; i < small.size; i++) small.u[i] = 2 * Random(); /* far beyond det F > 0 */
      OK(CellKernelEvaluate(finite.kernel, &finite.batch));
      OK(CellKernelEvaluate(small.kernel, &small.batch));
      assert_false(small.batch.bad);
      for (PetscInt i = 0; i < small.size; i++) {
        PetscReal Ku = 0;

        for (PetscInt j = 0; j < small.size; j++) {
          assert_near(small.K[i * small.size + j], finite.K[i * small.size + j], 1e-11);
          Ku += small.K[i * small.size + j] * small.u[j];
        }
        assert_near(small.r[i], Ku, 1e-10);
      }
      CellTearDown(&finite);
      CellTearDown(&small);
    }
  }
}

/* A node pushed through the cell is reported, not computed with; neither is a displacement that is no number. */
static void InversionIsReported(void **state)
{
  Cell cell;

  CellSetUp(&cell, 3, MODEL_3D, KINEMATICS_FINITE, 1, &choices[0], FORMULATION_DISPLACEMENT);
  CellMake(3, 1, 0.1, 0.02, cell.X);
  cell.u[3 * 7] = -3;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_true(cell.batch.bad);
  assert_true(cell.min_det < 0);
  cell.u[3 * 7] = (PetscReal)NAN;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_true(cell.batch.bad);
  cell.u[3 * 7] = 0;
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_false(cell.batch.bad);
  CellTearDown(&cell);
}

/* r -> -r: hoop and radial stretch -1, det F = 1. A ring cannot pass through the axis. */
static void RingThroughAxisIsReported(void **state)
{
  Cell cell;

  CellSetUp(&cell, 2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE, 2, &choices[1], FORMULATION_MIXED);
  CellMake(2, 2, 0, 0, cell.X);
  for (PetscInt node = 0; node < cell.n; node++) cell.u[2 * node] = -2 * cell.X[2 * node];
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_true(cell.batch.bad);
  assert_true(cell.min_det < 0);
  CellTearDown(&cell);
}

/* The stretch that the estimate of round-off grows with: F:F/3, at its largest in the cell. */
static void StretchIsReported(void **state)
{
  for (PetscInt dim = 2; dim <= 3; dim++) {
    Cell      cell;
    PetscReal stretch2[NUM_LANES + 1];

    CellSetUp(&cell, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE, 2, &choices[0], FORMULATION_DISPLACEMENT);
    CellMake(dim, 2, 0.1, 0.02, cell.X);
    for (PetscInt node = 0; node < cell.n; node++) cell.u[dim * node] = cell.X[dim * node] + 0.5 * cell.X[dim * node + 1];
    cell.batch.stretch2 = stretch2;
    OK(CellKernelEvaluate(cell.kernel, &cell.batch));
    assert_near(stretch2[0], (4 + 0.25 + 1 + 1) / 3, 1e-13);
    CellTearDown(&cell);
  }
}

/* Solve K x = f in place for the free dofs (mask), Gauss elimination with pivots; f becomes x, fixed entries 0. */
static void SolveFree(PetscInt size, const PetscBool *fixed, PetscReal *K, PetscReal *f)
{
  for (PetscInt i = 0; i < size; i++) {
    if (!fixed[i]) continue;
    for (PetscInt j = 0; j < size; j++) K[i * size + j] = K[j * size + i] = i == j;
    f[i] = 0;
  }
  for (PetscInt j = 0; j < size; j++) {
    PetscInt pivot = j;

    for (PetscInt i = j; i < size; i++) pivot = PetscAbsReal(K[i * size + j]) > PetscAbsReal(K[pivot * size + j]) ? i : pivot;
    for (PetscInt c = 0; pivot != j && c < size; c++) {
      const PetscReal keep = K[j * size + c];

      K[j * size + c]     = K[pivot * size + c];
      K[pivot * size + c] = keep;
    }
    if (pivot != j) {
      const PetscReal keep = f[j];

      f[j]     = f[pivot];
      f[pivot] = keep;
    }
    for (PetscInt i = j + 1; i < size; i++) {
      const PetscReal factor = K[i * size + j] / K[j * size + j];

      for (PetscInt c = j; factor != 0 && c < size; c++) K[i * size + c] -= factor * K[j * size + c];
      f[i] -= factor * f[j];
    }
  }
  for (PetscInt i = size - 1; i >= 0; i--) {
    for (PetscInt c = i + 1; c < size; c++) f[i] -= K[i * size + c] * f[c];
    f[i] /= K[i * size + i];
  }
}

/* cases.md O-03, one cell of order 4: NHc E = 2.8, nu = 0.4, clamped at x = 0, traction (0,0,-0.5) on x = 1. */
static void ClampedCubeOfOrder4(void **state)
{
  const Choice choice = {"neo_hookean", VOLUMETRIC_LOG, 2, {"E", "nu"}, {2.8, 0.4}};
  Cell         cell;
  PetscBool    fixed[375];
  PetscReal    trace[75], traction[36 * 3] = {0}, load[75], norm;

  CellSetUp(&cell, 3, MODEL_3D, KINEMATICS_FINITE, 4, &choice, FORMULATION_DISPLACEMENT);
  assert_int_equal(cell.size, 375);
  CellMake(3, 4, 0, 0, cell.X);
  for (PetscInt i = 0; i < 375; i++) fixed[i] = i / 3 % 5 == 0;
  for (PetscInt i = 0; i < 75; i++) trace[i] = cell.X[(5 * (i / 3) + 4) * 3 + i % 3];
  for (PetscInt q = 0; q < 36; q++) traction[3 * q + 2] = -0.5;
  OK(FacetTraction(3, MODEL_3D, 4, trace, traction, load));
  for (int increment = 1; increment <= 5; increment++) {
    int its = 0;

    do {
      PetscReal du[375] = {0};

      OK(CellKernelEvaluate(cell.kernel, &cell.batch));
      assert_false(cell.batch.bad);
      for (PetscInt i = 0; i < 375; i++) du[i] = -cell.r[i];
      for (PetscInt i = 0; i < 75; i++) du[(5 * (i / 3) + 4) * 3 + i % 3] -= increment / 5. * load[i];
      norm = 0;
      for (PetscInt i = 0; i < 375; i++) norm += fixed[i] ? 0 : du[i] * du[i];
      SolveFree(375, fixed, cell.K, du);
      for (PetscInt i = 0; i < 375; i++) cell.u[i] += du[i];
    } while (norm > 1e-26 && ++its < 20);
    assert_true(its < 12);
  }
  OK(CellKernelEvaluate(cell.kernel, &cell.batch));
  assert_near(cell.energy, 0.214824343153, 1e-11);
  assert_near(cell.u[372], 0.08804094, 1e-8);
  assert_near(cell.u[373], -0.03850318, 1e-8);
  assert_near(cell.u[374], -1.14381849, 1e-8);
  CellTearDown(&cell);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(DerivativesAgree),          cmocka_unit_test(PatchIsExact),
      cmocka_unit_test(RigidRotationIsFree),       cmocka_unit_test(BatchesEqualCells),
      cmocka_unit_test(StoredPressureIsGeometric), cmocka_unit_test(StoredPressureActs),
      cmocka_unit_test(PressureIsProjection),      cmocka_unit_test(AxisymmetricHoopIsExact),
      cmocka_unit_test(RingThroughAxisIsReported), cmocka_unit_test(StretchIsReported),
      cmocka_unit_test(SmallIsLinearised),         cmocka_unit_test(InversionIsReported),
      cmocka_unit_test(ClampedCubeOfOrder4),
  };

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
