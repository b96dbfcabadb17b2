/* Residual, tangent and energy of batches of cells. Several cells are integrated at once, one in each lane; the law sees all their points as one batch. */
#include "mechanicsimpl.h"

static PetscErrorCode TablesCreate_Private(CellKernel k)
{
  const Basis1D *b  = k->basis;
  const PetscInt n1 = k->n1, q1 = k->q1, m = k->num_pressure;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(k->num_points, &k->weight, k->num_points * m, &k->legendre, n1 * n1 * 4 * q1, &k->pairs));
  for (PetscInt q = 0; q < k->num_points; q++) {
    const PetscInt index[3] = {q % q1, q / q1 % q1, q / (q1 * q1)};
    PetscReal      value[3][MORTISE_MAX_ORDER + 1];
    PetscInt       l = 0;

    k->weight[q] = 1;
    for (PetscInt c = 0; c < k->dim; c++) {
      k->weight[q] *= b->weights[index[c]];
      PetscCall(ElementLegendre(k->order - 1, b->points[index[c]], value[c], NULL));
    }
    for (PetscInt z = 0; m && z < (k->dim == 3 ? k->order : 1); z++) {
      for (PetscInt y = 0; y + z < k->order; y++) {
        for (PetscInt x = 0; x + y + z < k->order; x++) k->legendre[q * m + l++] = value[0][x] * value[1][y] * (k->dim == 3 ? value[2][z] : 1);
      }
    }
  }
  for (PetscInt i = 0; i < n1 * n1 * 4 * q1; i++) {
    const PetscInt q = i % q1, s = i / q1 % 2, r = i / q1 / 2 % 2, fb = i / q1 / 4 % n1, fa = i / q1 / 4 / n1;

    k->pairs[i] = (r ? b->D : b->B)[q * n1 + fa] * (s ? b->D : b->B)[q * n1 + fb];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One block of memory, aligned to lanes, cut into the arrays of the kernel. */
static PetscErrorCode ArenaCreate_Private(CellKernel k)
{
  const size_t n = k->num_nodes, q = k->num_points, d = k->dim, r = k->num_derivatives, m = k->num_pressure, n1 = k->n1, q1 = k->q1, slab = k->slab_points,
               h = k->material.law->num_history;
  const struct {
    Lanes **array;
    size_t  num;
  } parts[] = {
      {&k->X, d * n},
      {&k->u, d * n},
      {&k->gradient, d * r * q},
      {&k->layer, d == 3 ? 3 * n1 * q1 * q1 : 0},
      {&k->inverse, d * d * q},
      {&k->hoop_inverse, k->hoop ? q : 0},
      {&k->volume, q},
      {&k->F, 9 * q},
      {&k->fiber, (size_t)k->material.num_fibers * 3 * q},
      {&k->P, 9 * q},
      {&k->W, q},
      {&k->A, 81 * slab},
      {&k->measure, m ? 4 * q : 0},
      {&k->history, h * q},
      {&k->trial, h * q},
      {&k->mass, m * m},
      {&k->moment, m},
      {&k->coefficient, m},
      {&k->stored, m},
      {&k->coupling, m * d * n},
      {&k->reference_tangent, d * d * r * r * q},
      {&k->layer_tangent, d * d * r * r * q1 * q1},
      {&k->tile, n1 * d * n1 * d},
  };
  size_t total = 1;
  Lanes *start;

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(parts); i++) total += parts[i].num;
  PetscCall(PetscMalloc(total * sizeof(Lanes), &k->arena));
  start = (Lanes *)(((uintptr_t)k->arena + sizeof(Lanes) - 1) / sizeof(Lanes) * sizeof(Lanes));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(parts); i++) {
    *parts[i].array = start;
    start += parts[i].num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPointRule(PetscInt order, const Basis1D **basis)
{
  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, CellLinePoints(order), basis));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellKernelCreate(PetscInt dim, Model model, Kinematics kinematics, PetscInt order, const MaterialSpec *material, CellKernel *kernel)
{
  CellKernel k;

  PetscFunctionBegin;
  PetscCheck(dim == (model == MODEL_3D ? 3 : 2), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "Model and dimension %" PetscInt_FMT " disagree", dim);
  PetscCheck(!material->law->rigid, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "Cells of rigid material %s are not assembled", material->name);
  PetscCheckInput(!material->law->small || kinematics == KINEMATICS_SMALL, "material.%s.law: %s needs kinematics: small", material->name, material->law->name);
  PetscCheckInput(!material->law->num_history || kinematics == KINEMATICS_FINITE, "material.%s.law: %s needs kinematics: finite", material->name,
                  material->law->name);
  PetscCall(PetscNew(&k));
  k->dim             = dim;
  k->order           = order;
  k->n1              = order + 1;
  k->num_nodes       = ElementNumNodes(dim, order);
  k->q1              = CellLinePoints(order);
  k->num_points      = ElementNumNodes(dim, k->q1 - 1);
  k->small           = kinematics == KINEMATICS_SMALL ? PETSC_TRUE : PETSC_FALSE;
  k->hoop            = model == MODEL_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  k->mixed           = material->mixed;
  k->incompressible  = material->incompressible;
  k->unsymmetric     = material->law->unsymmetric;
  k->num_derivatives = k->hoop ? 3 : dim;
  k->num_pressure    = !k->mixed ? 0 : MechanicsPressureCount(dim, order);
  k->num_slabs       = dim == 3 && order > 1 ? k->q1 : 1;
  k->slab_points     = k->num_points / k->num_slabs;
  k->material        = *material;
  if (k->small) { /* small kinematics: every law is its linearisation */
    k->material.law        = MaterialLawFind("linear");
    k->material.volumetric = VOLUMETRIC_QUADRATIC;
    k->material.num_fibers = 0; /* they are slack to first order */
  }
  PetscCall(MechanicsPointRule(order, &k->basis));
  PetscCall(TablesCreate_Private(k));
  PetscCall(ArenaCreate_Private(k));
  *kernel = k;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellKernelDestroy(CellKernel *kernel)
{
  PetscFunctionBegin;
  if (!*kernel) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*kernel)->weight, (*kernel)->legendre, (*kernel)->pairs));
  PetscCall(PetscFree((*kernel)->arena));
  PetscCall(PetscFree(*kernel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* best_batch: a multiple of the lanes for which a tangent batch stays within about 2 MB. */
void CellKernelSizes(CellKernel k, PetscInt *num_nodes, PetscInt *num_pressure, PetscInt *best_batch)
{
  const PetscInt size = k->num_nodes * k->dim;

  if (num_nodes) *num_nodes = k->num_nodes;
  if (num_pressure) *num_pressure = k->num_pressure;
  if (best_batch) *best_batch = NUM_LANES * PetscMax(1, PetscMin(8, 32768 / (size * size)));
}

void CellKernelHistory(CellKernel k, PetscInt *num_points, PetscInt *num_history)
{
  if (num_points) *num_points = k->num_points;
  if (num_history) *num_history = k->material.law->num_history;
}

/* Nodal values [cells][n][d] to lanes [d][n]; lanes beyond num repeat the last cell. */
static void Load_Private(PetscInt num, PetscInt n, PetscInt d, const PetscReal *values, Lanes *lanes)
{
  for (PetscInt l = 0; l < NUM_LANES; l++) {
    const PetscReal *cell = values + PetscMin(l, num - 1) * n * d;

    for (PetscInt node = 0; node < n; node++) {
      for (PetscInt c = 0; c < d; c++) lanes[c * n + node][l] = cell[node * d + c];
    }
  }
}

static void Store_Private(PetscInt num, PetscInt n, PetscInt d, const Lanes *lanes, PetscReal *values)
{
  for (PetscInt l = 0; l < num; l++) {
    for (PetscInt node = 0; node < n; node++) {
      for (PetscInt c = 0; c < d; c++) values[(l * n + node) * d + c] = lanes[c * n + node][l];
    }
  }
}

static void StoreDiagonal_Private(PetscInt num, PetscInt m, const Lanes *matrix, PetscReal *values)
{
  for (PetscInt l = 0; l < num; l++) {
    for (PetscInt i = 0; i < m; i++) values[l * m + i] = matrix[i * m + i][l];
  }
}

/* Point values [cells][num][q] to lanes, slab after slab. */
static void LoadSlabs_Private(CellKernel k, PetscInt num_cells, PetscInt num, const PetscReal *values, Lanes *lanes)
{
  const PetscInt slab = k->slab_points;

  for (PetscInt q = 0; q < k->num_points; q++) {
    for (PetscInt c = 0; c < num; c++) {
      for (PetscInt l = 0; l < NUM_LANES; l++) {
        lanes[(q / slab * num + c) * slab + q % slab][l] = values[(PetscMin(l, num_cells - 1) * num + c) * k->num_points + q];
      }
    }
  }
}

PetscErrorCode CellKernelVolumes(CellKernel k, const PetscReal *X, PetscReal *volume)
{
  PetscFunctionBegin;
  Load_Private(1, k->num_nodes, k->dim, X, k->X);
  (void)CellKernelGeometry_Private(k);
  for (PetscInt q = 0; q < k->num_points; q++) volume[q] = k->volume[q][0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellKernelFindInverted(CellKernel k, PetscInt nc, const PetscReal *X, PetscInt *cell)
{
  PetscFunctionBegin;
  *cell = -1;
  for (PetscInt first = 0; first < nc && *cell < 0; first += NUM_LANES) {
    Load_Private(PetscMin(NUM_LANES, nc - first), k->num_nodes, k->dim, X + first * k->num_nodes * k->dim, k->X);
    const PetscInt lane = CellKernelGeometry_Private(k);
    if (lane >= 0) *cell = PetscMin(first + lane, nc - 1); /* lanes beyond the last cell repeat it */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers at points: [cells][points][h] from/to lanes [slab][h][points of a slab]. Lanes beyond num repeat the last cell. */
static void LoadHistory_Private(CellKernel k, PetscInt num, const PetscReal *values)
{
  const PetscInt h = k->material.law->num_history, slab = k->slab_points;

  for (PetscInt l = 0; l < NUM_LANES; l++) {
    const PetscReal *cell = values + PetscMin(l, num - 1) * k->num_points * h;

    for (PetscInt q = 0; q < k->num_points; q++) {
      for (PetscInt c = 0; c < h; c++) k->history[((q / slab) * h + c) * slab + q % slab][l] = cell[q * h + c];
    }
  }
}

static void StoreTrial_Private(CellKernel k, PetscInt num, PetscReal *values)
{
  const PetscInt h = k->material.law->num_history, slab = k->slab_points;

  for (PetscInt l = 0; l < num; l++) {
    for (PetscInt q = 0; q < k->num_points; q++) {
      for (PetscInt c = 0; c < h; c++) values[(l * k->num_points + q) * h + c] = k->trial[((q / slab) * h + c) * slab + q % slab][l];
    }
  }
}

/* The law at all points: F -> W, P, and slab by slab A, which is pulled back at once while it is in cache. *bad: it has no answer (det F was tested before). */
static PetscErrorCode Law_Private(CellKernel k, PetscBool tangent, const CellBatch *b, const Lanes *pressure, PetscBool *bad)
{
  const PetscInt     slab = k->slab_points, count = slab * NUM_LANES, h = k->material.law->num_history;
  const MaterialPart part = k->mixed ? MATERIAL_ISOCHORIC : MATERIAL_FULL;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < k->num_slabs; s++) {
    MaterialPoints points = {.n       = count,
                             .F       = (PetscReal *)&k->F[s * 9 * slab],
                             .fiber   = (PetscReal *)&k->fiber[s * 3 * k->material.num_fibers * slab],
                             .W       = (PetscReal *)&k->W[s * slab],
                             .P       = (PetscReal *)&k->P[s * 9 * slab],
                             .A       = tangent ? (PetscReal *)k->A : NULL,
                             .history = (PetscReal *)&k->history[s * h * slab],
                             .trial   = (PetscReal *)&k->trial[s * h * slab],
                             .edge    = b->edge,
                             .secant  = b->secant,
                             .held    = b->held};

    PetscCall(MaterialEvaluate(&k->material, part, &points));
    if (points.bad) *bad = PETSC_TRUE;
    if (tangent && k->mixed) CellKernelAddPressureTangent_Private(k, s, pressure);
    if (tangent) CellKernelTangentSlab_Private(k, s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* int W_iso + 1/(2 modulus) pi . M pi, where M pi = modulus int q g (incompressible: nothing). */
static void Energy_Private(CellKernel k, PetscInt num, PetscReal *energy)
{
  Lanes sum = {0};

  for (PetscInt q = 0; q < k->num_points; q++) sum += k->volume[q] * k->W[q];
  for (PetscInt i = 0; i < k->num_pressure && !k->incompressible; i++) sum += 0.5 * k->moment[i] * k->coefficient[i];
  for (PetscInt l = 0; l < num; l++) energy[l] = sum[l];
}

/* Largest F:F/3 of each cell. */
static void Stretch_Private(CellKernel k, PetscInt num, PetscReal *stretch2)
{
  const PetscInt slab = k->slab_points;

  for (PetscInt l = 0; l < num; l++) stretch2[l] = 0;
  for (PetscInt q = 0; q < k->num_points; q++) {
    const Lanes *F   = k->F + (q / slab) * 9 * slab + q % slab;
    Lanes        sum = {0};

    for (int c = 0; c < 9; c++) sum += F[c * slab] * F[c * slab];
    for (PetscInt l = 0; l < num; l++) stretch2[l] = PetscMax(stretch2[l], sum[l] / 3);
  }
}

/* Everything that is asked of cells first .. first+num-1 of the batch. */
static PetscErrorCode Chunk_Private(CellKernel k, CellBatch *b, PetscInt first, PetscInt num)
{
  const PetscInt  n = k->num_nodes, d = k->dim, m = k->num_pressure, size = n * d, fibers = 3 * k->material.num_fibers;
  const PetscBool tangent = b->tangent ? PETSC_TRUE : PETSC_FALSE,
                  couple  = m && ((b->tangent && !k->incompressible) || b->dpressure) ? PETSC_TRUE : PETSC_FALSE;
  const Lanes *pressure   = k->coefficient;
  Lanes        min_det;
  PetscBool    bad = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheck(b->history || !k->material.law->num_history || !(b->energy || b->residual || tangent || b->trial || b->consistent), PETSC_COMM_SELF,
             PETSC_ERR_ARG_NULL, "The law %s needs the history of its points", k->material.law->name);
  Load_Private(num, n, d, b->X + first * size, k->X);
  Load_Private(num, n, d, b->u + first * size, k->u);
  PetscCheck(CellKernelGeometry_Private(k) < 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "A cell is inverted in the reference mesh (MechanicsFindInverted)");
  CellKernelDeformation_Private(k, &min_det);
  for (PetscInt l = 0; l < num; l++) {
    if (b->min_det) b->min_det[first + l] = min_det[l];
    if (!k->small && !(min_det[l] > 0)) bad = PETSC_TRUE;
  }
  if (b->stretch2) Stretch_Private(k, num, b->stretch2 + first);
  if (bad) b->bad = PETSC_TRUE;
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  if (b->history) LoadHistory_Private(k, num, b->history + first * k->num_points * k->material.law->num_history);
  if (k->mixed) CellKernelProject_Private(k);
  if (b->consistent && m) Store_Private(num, m, 1, k->incompressible ? k->moment : k->coefficient, b->consistent + first * m);
  if (b->mass && k->incompressible) StoreDiagonal_Private(num, m, k->mass, b->mass + first * m);
  if (k->mixed && b->pressure) {
    Load_Private(num, m, 1, b->pressure + first * m, k->stored);
    pressure = k->stored;
  }
  if (fibers && (b->energy || b->residual || tangent)) LoadSlabs_Private(k, num, fibers, b->fiber + first * fibers * k->num_points, k->fiber);
  if (b->energy || b->residual || tangent || b->trial) PetscCall(Law_Private(k, tangent, b, pressure, &bad));
  if (bad) b->bad = PETSC_TRUE;
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  if (b->trial) StoreTrial_Private(k, num, b->trial + first * k->num_points * k->material.law->num_history);
  if (b->energy) Energy_Private(k, num, b->energy + first);
  if (b->residual) {
    if (k->mixed) CellKernelAddPressure_Private(k, k->incompressible || b->acts ? pressure : k->coefficient);
    CellKernelFlux_Private(k, k->gradient);
    CellKernelIntegrate_Private(k, k->gradient, k->u);
    Store_Private(num, n, d, k->u, b->residual + first * size);
  }
  if (couple) CellKernelCouple_Private(k, num, b->dpressure ? b->dpressure + first * m * size : NULL);
  if (tangent) CellKernelTangent_Private(k, b, first, num);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellKernelEvaluate(CellKernel k, CellBatch *b)
{
  PetscFunctionBegin;
  b->bad = PETSC_FALSE;
  for (PetscInt first = 0; first < b->nc; first += NUM_LANES) PetscCall(Chunk_Private(k, b, first, PetscMin(NUM_LANES, b->nc - first)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
