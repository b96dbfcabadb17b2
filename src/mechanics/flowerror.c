/* What the load steps leave where material flows. Flow rules are integrated by one backward step for each load step. Beside what these leave at the points goes
   what many small ones leave on the same way, from load step to load step: the difference of the stresses is the error, of which later steps forget what the
   material forgets. The way between two states is straight in F, but where material begins to flow. Rotations of the step are left out of it: history does not
   feel them. */
#include "mechanicsimpl.h"

#define PARTS 4       /* of a step in which material flows, or of the elastic strain, at the beginning: they leave a quarter of what one does */
#define GROWTH 1.5    /* of one part over the last: stress turns towards the direction of the flow within a few elastic strains, and then is there */
#define BISECTIONS 10 /* for where it begins */

/* R^T F1, R the rotation of f = F1 F0^-1, by Newton's method for the polar decomposition: R <- (R + R^-T) / 2. */
static PetscBool Unturned_Private(const PetscReal F0[9], const PetscReal F1[9], PetscReal F[9])
{
  const PetscReal T[9] = {F0[0], F0[3], F0[6], F0[1], F0[4], F0[7], F0[2], F0[5], F0[8]}, one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal       R[9], inverse[9];

  for (int i = 0; i < 3; ++i)
    if (!Solve3(T, F1 + 3 * i, R + 3 * i)) return PETSC_FALSE;
  for (int it = 0; it < 10; ++it) {
    for (int k = 0; k < 3; ++k)
      if (!Solve3(R, one + 3 * k, inverse + 3 * k)) return PETSC_FALSE;
    for (int k = 0; k < 9; ++k) R[k] = 0.5 * (R[k] + inverse[k]);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F[3 * i + j] = R[i] * F1[j] + R[3 + i] * F1[3 + j] + R[6 + i] * F1[6 + j];
  return PETSC_TRUE;
}

/* Kirchhoff stress of P, traceless. */
static void Deviator_Private(const PetscReal P[9], const PetscReal F[9], PetscReal s[9])
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      s[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k) s[3 * i + j] += P[3 * i + k] * F[3 * j + k];
    }
  const PetscReal mean = (s[0] + s[4] + s[8]) / 3;
  for (int i = 0; i < 9; i += 4) s[i] -= mean;
}

static PetscReal Square_Private(const PetscReal s[9])
{
  PetscReal sum = 0;

  for (int k = 0; k < 9; ++k) sum += s[k] * s[k];
  return sum;
}

/* The flow of a step from `history` to F at once, in elastic strains; 0: none. Not ok: the law has no answer. */
static PetscErrorCode Once_Private(const MaterialSpec *m, const PetscReal history[], const PetscReal F[9], PetscReal *flow, PetscBool *ok)
{
  PetscReal      trial[MATERIAL_MAX_HISTORY], P[9], s[9], before, after, work;
  MaterialPoints once = {.n = 1, .F = F, .history = history, .trial = trial, .P = P};

  PetscFunctionBegin;
  *flow = 0;
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &once));
  *ok = (PetscBool)!once.bad;
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  m->law->plastic(m, history, &before, &work);
  m->law->plastic(m, trial, &after, &work);
  Deviator_Private(P, F, s);
  if (after > before) *flow = 2 * m->mu * (after - before) / PetscSqrtReal(Square_Private(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Distance2_Private(const PetscReal A[9], const PetscReal B[9])
{
  PetscReal sum = 0;

  for (int k = 0; k < 9; ++k) sum += PetscSqr(A[k] - B[k]);
  return sum;
}

static void Between_Private(const PetscReal F0[9], const PetscReal F1[9], PetscReal share, PetscReal F[9])
{
  for (int k = 0; k < 9; ++k) F[k] = share == 1 ? F1[k] : F0[k] + share * (F1[k] - F0[k]);
}

/* A step in which material begins to flow has two directions: the elastic one in which it begins, and that of the flow. F goes in the first, to Fw, up to where
   it flows; not at all where that leads to no flow, or farther than the step to F1: what the step met on its way, Fw does not know. */
static PetscErrorCode Elastic_Private(const MaterialSpec *m, const PetscReal history[], const PetscReal Fw[9], const PetscReal F1[9], PetscReal F[9])
{
  PetscReal share[2] = {0, 1}, F0[9], end[9], flow;
  PetscBool ok;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(F0, F, 9));
  if (!Unturned_Private(F0, Fw, end) || Distance2_Private(end, F0) > Distance2_Private(F1, F0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Once_Private(m, history, end, &flow, &ok));
  if (!ok || flow == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < BISECTIONS; ++i) {
    const PetscReal middle = i == 0 ? ROUND_LENGTH : 0.5 * (share[0] + share[1]); /* most of what flows has flowed before */
    Between_Private(F0, end, middle, F);
    PetscCall(Once_Private(m, history, F, &flow, &ok));
    share[flow > 0 || !ok] = middle;
    if (share[1] <= ROUND_LENGTH) break;
  }
  Between_Private(F0, end, share[0], F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* history at F0 -> at F1, in parts whose flow is a share of the elastic strain at the beginning. What has no answer stays as it is. Fw: NULL, or F at the end
   of `way`. */
static PetscErrorCode Follow_Private(const MaterialSpec *m, const PetscReal F0[9], const PetscReal Fw[9], const PetscReal F1[9], PetscReal history[])
{
  PetscReal start[9], end[9], F[9], flow, next[2][MATERIAL_MAX_HISTORY], share = 0;
  PetscInt  last = 0;
  PetscBool ok;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(start, F0, 9));
  if (!Unturned_Private(F0, F1, end)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Once_Private(m, history, end, &flow, &ok));
  if (!ok || flow == 0) PetscFunctionReturn(PETSC_SUCCESS); /* the straight way to a stress that does not flow is elastic */
  if (Fw) PetscCall(Elastic_Private(m, history, Fw, end, start));
  PetscCall(PetscArraycpy(next[0], history, m->law->num_history));
  for (PetscReal part = PetscMin(1, 1 / flow) / PARTS; share < 1; part = PetscMin(GROWTH * part, 1. / PARTS)) {
    MaterialPoints point = {.n = 1, .F = F, .history = next[last], .trial = next[1 - last]};
    share                = share + part < 1 - ROUND_LENGTH ? share + part : 1;
    Between_Private(start, end, share, F);
    PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &point));
    if (point.bad) PetscFunctionReturn(PETSC_SUCCESS);
    last = 1 - last;
  }
  PetscCall(PetscArraycpy(history, next[last], m->law->num_history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F at the integration points of a cell, [num_points][9]; volumes of these points where wanted. */
static PetscErrorCode Points_Private(Mechanics m, PetscInt cell, const CellGroup *g, const PetscReal u[], PetscReal volume[], PetscReal F[])
{
  const PetscBool ring = (PetscBool)(m->spec->model == MODEL_AXISYMMETRIC);
  const PetscInt  np   = g->num_points;
  const Basis1D  *rule;
  PetscReal      *xi, *X, *J;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(g->order, &rule));
  PetscCall(PetscMalloc3(3 * np, &xi, 3 * np, &X, 9 * np, &J));
  for (PetscInt q = 0; q < np; ++q) (void)Basis1DPoint(rule, m->dim, q, xi + m->dim * q);
  PetscCall(MechanicsPoints(m, cell, np, xi, u, &(PointValues){.X = X, .J = J, .F = F}));
  for (PetscInt q = 0; q < np && volume; ++q) {
    PetscReal unused[3];
    volume[q] = Basis1DPoint(rule, m->dim, q, unused) * Det3(J + 9 * q) * (ring ? 2 * PETSC_PI * X[3 * q] : 1);
  }
  PetscCall(PetscFree3(xi, X, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The group of an owned cell whose law has a history, and where the cell's begins; NULL: it has none. */
static const CellGroup *Group_Private(Mechanics m, PetscInt cell, PetscInt *first)
{
  const CellGroup *g = m->cell_group[cell] < 0 ? NULL : &m->groups[m->cell_group[cell]];

  if (!g || !g->h) return NULL;
  *first = g->history + m->cell_index[cell] * g->num_points * g->h;
  return g;
}

PetscErrorCode MechanicsFollowFlow(Mechanics m, const PetscReal u0[], const PetscReal way[], const PetscReal u1[], PetscReal fine[])
{
  const HPTables *v   = HPSpaceGetTables(m->space);
  const PetscInt  num = way ? v->num_nodes * m->dim : 0;
  PetscReal      *uw;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &uw));
  for (PetscInt i = 0; i < num; ++i) uw[i] = u0[i] + way[i];
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscInt         first;
    PetscReal       *F;
    const CellGroup *g = Group_Private(m, c, &first);
    if (!g) continue;
    const PetscInt np = g->num_points;
    PetscCall(PetscMalloc1(27 * np, &F));
    PetscCall(Points_Private(m, c, g, u0, NULL, F));
    PetscCall(Points_Private(m, c, g, u1, NULL, F + 9 * np));
    if (way) PetscCall(Points_Private(m, c, g, uw, NULL, F + 18 * np));
    for (PetscInt q = 0; q < np; ++q)
      PetscCall(Follow_Private(g->material, F + 9 * q, way ? F + 9 * (2 * np + q) : NULL, F + 9 * (np + q), fine + first + q * g->h));
    PetscCall(PetscFree(F));
  }
  PetscCall(PetscFree(uw));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Energy of the difference of the stresses at F. */
static PetscErrorCode Point_Private(const MaterialSpec *m, const PetscReal history[], const PetscReal fine[], const PetscReal F[9], PetscReal *energy)
{
  PetscReal      P[2][9], s[9];
  MaterialPoints is = {.n = 1, .F = F, .history = history, .P = P[0]}, was = {.n = 1, .F = F, .history = fine, .P = P[1]};

  PetscFunctionBegin;
  *energy = 0;
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &is));
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &was));
  if (is.bad || was.bad) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 9; ++k) P[0][k] -= P[1][k];
  Deviator_Private(P[0], F, s);
  *energy = Square_Private(s) / (4 * m->mu);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsFlowError(Mechanics m, const PetscReal u[], const PetscReal fine[], PetscReal *energy)
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  *energy = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscInt         first;
    PetscReal       *F, *volume, here;
    const CellGroup *g = Group_Private(m, c, &first);
    if (!g) continue;
    PetscCall(PetscMalloc2(9 * g->num_points, &F, g->num_points, &volume));
    PetscCall(Points_Private(m, c, g, u, volume, F));
    for (PetscInt q = 0; q < g->num_points; ++q) {
      const PetscInt at = first + q * g->h;
      PetscCall(Point_Private(g->material, m->history.values + at, fine + at, F + 9 * q, &here));
      *energy += volume[q] * here;
    }
    PetscCall(PetscFree2(F, volume));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
