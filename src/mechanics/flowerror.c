/* What a step leaves where its material has a history: flow rules are integrated by one backward step. Twice the difference from two steps of half the length,
   by way of the mean of both deformation gradients, is the local error to first order (Richardson). The rotation of the step is left out of the mean: history
   does not feel it. */
#include "mechanicsimpl.h"

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

/* Energy of the stress that one step from F0 to F1 is off by. */
static PetscErrorCode Point_Private(const MaterialSpec *m, const PetscReal history[], const PetscReal F0[9], const PetscReal F1[9], PetscReal *energy)
{
  PetscReal      middle[MATERIAL_MAX_HISTORY], F[9], P[2][9], s[9], length = 0;
  MaterialPoints once = {.n = 1, .F = F1, .history = history, .P = P[0]}, half = {.n = 1, .F = F, .history = history, .trial = middle};
  MaterialPoints rest = {.n = 1, .F = F1, .history = middle, .P = P[1]};

  PetscFunctionBegin;
  *energy = 0;
  if (!Unturned_Private(F0, F1, F)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 9; ++k) F[k] = 0.5 * (F0[k] + F[k]);
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &once));
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &half));
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &rest));
  if (once.bad || half.bad || rest.bad) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      s[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k) s[3 * i + j] += 2 * (P[1][3 * i + k] - P[0][3 * i + k]) * F1[3 * j + k];
      length += PetscSqr(s[3 * i + j]);
    }
  *energy = (length - PetscSqr(s[0] + s[4] + s[8]) / 3) / (4 * m->mu);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Cell_Private(Mechanics m, PetscInt cell, const CellGroup *g, const PetscReal u0[], const PetscReal u1[], PetscReal *energy)
{
  const PetscBool  ring    = (PetscBool)(m->spec->model == MODEL_AXISYMMETRIC);
  const PetscInt   np      = g->num_points;
  const PetscReal *history = MechanicsBatchHistory_Private(m, g, m->cell_index[cell]);
  const Basis1D   *rule;
  PetscReal       *xi, *X, *J, *F;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(g->order, &rule));
  PetscCall(PetscMalloc4(3 * np, &xi, 3 * np, &X, 9 * np, &J, 18 * np, &F));
  for (PetscInt q = 0; q < np; ++q) (void)Basis1DPoint(rule, m->dim, q, xi + m->dim * q);
  PetscCall(MechanicsPoints(m, cell, np, xi, u0, &(PointValues){.F = F}));
  PetscCall(MechanicsPoints(m, cell, np, xi, u1, &(PointValues){.X = X, .J = J, .F = F + 9 * np}));
  for (PetscInt q = 0; q < np; ++q) {
    PetscReal       unused[3], here;
    const PetscReal volume = Basis1DPoint(rule, m->dim, q, unused) * Det3(J + 9 * q) * (ring ? 2 * PETSC_PI * X[3 * q] : 1);
    PetscCall(Point_Private(g->material, history + q * g->h, F + 9 * q, F + 9 * (np + q), &here));
    *energy += volume * here;
  }
  PetscCall(PetscFree4(xi, X, J, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsFlowError(Mechanics m, const PetscReal u0[], const PetscReal u1[], PetscReal *energy)
{
  PetscFunctionBegin;
  *energy           = 0;
  const HPTables *v = HPSpaceGetTables(m->space);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const CellGroup *g = m->cell_group[c] < 0 ? NULL : &m->groups[m->cell_group[c]];
    if (g && g->h) PetscCall(Cell_Private(m, c, g, u0, u1, energy));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
