/* Energies that single parts of the model add at a state, body by body: what a simpler model would leave out. To first order the potential energy of the
   simpler model at its own solution differs from that of the whole one by its difference at the state found (docs/theory.md, no more model than needed). */
#include "mechanicsimpl.h"

/* What there is at one point. */
typedef struct {
  PetscReal volume, F[9], P[9], W; /* volume: weight times reference volume */
} TermPoint;

/* S = F^-1 P, the second Piola stress, by Cramer's rule. */
static PetscBool SecondPiola_Private(const PetscReal F[9], const PetscReal P[9], PetscReal S[9])
{
  for (int b = 0; b < 3; ++b) {
    const PetscReal column[3] = {P[b], P[3 + b], P[6 + b]};
    PetscReal       x[3];
    if (!Solve3(F, column, x)) return PETSC_FALSE;
    for (int a = 0; a < 3; ++a) S[3 * a + b] = x[a];
  }
  return PETSC_TRUE;
}

/* What small kinematics adds, stresses being those found (Hellinger and Reissner): S : eps - S : C^-1 : S / 2 - W. The displacements' own linear energy would
   count rotations as strain, and changes of volume with the bulk modulus. misfit: of the strains, 2 mu |eps - C^-1 : S|^2. */
static PetscReal Linear_Private(const MaterialSpec *m, const PetscReal S[9], const TermPoint *q, PetscReal *misfit)
{
  const PetscReal mean = (S[0] + S[4] + S[8]) / 3;
  PetscReal       work = 0, complementary = mean * mean / (2 * m->kappa);

  *misfit = 0;
  for (int k = 0; k < 9; ++k) {
    const PetscReal one = k % 4 == 0, eps = 0.5 * (q->F[k] + q->F[3 * (k % 3) + k / 3]) - one, dev = S[k] - one * mean;
    work += S[k] * eps;
    complementary += dev * dev / (4 * m->mu);
    *misfit += 2 * m->mu * PetscSqr(eps - dev / (2 * m->mu) - one * mean / (3 * m->kappa));
  }
  return work - complementary - q->W;
}

/* Square of Green's strain; small kinematics: of the linear one. */
static PetscReal Strain2_Private(PetscBool small, const PetscReal F[9])
{
  PetscReal sum = 0;

  for (int k = 0; k < 9; ++k) {
    const int       a = k / 3, b = k % 3;
    const PetscReal C = small ? F[k] + F[3 * b + a] - (a == b) : F[a] * F[b] + F[3 + a] * F[3 + b] + F[6 + a] * F[6 + b];
    sum += 0.25 * PetscSqr(C - (a == b));
  }
  return sum;
}

/* What the displacement form adds to a mixed one: U(J) less the energy of the pressure field, which is the trace of P F^T in laws whose shear part has none. */
static PetscReal Projected_Private(const MaterialSpec *m, PetscBool small, const TermPoint *q)
{
  const PetscReal J = small ? 1 : Det3(q->F), K = MaterialVolumetricModulus(m);
  PetscReal       trace = 0, g[3];

  MaterialVolumetric(m, J, g);
  for (int a = 0; a < 9; ++a) trace += q->P[a] * (small ? a % 4 == 0 : q->F[a]);
  if (small) {
    g[0] = q->F[0] + q->F[4] + q->F[8] - 3;
    g[1] = 1;
  }
  const PetscReal pi = trace / (3 * J * g[1]);
  return 0.5 * K * g[0] * g[0] - 0.5 * pi * pi / K;
}

/* Energy of the fibres: with them less without them. */
static PetscErrorCode Fibers_Private(const MaterialSpec *m, PetscInt root, const PetscReal X[3], const TermPoint *q, PetscReal *energy)
{
  MaterialSpec   bare = *m;
  PetscReal      fiber[MATERIAL_MAX_FIBERS][3], F[9], with, without;
  MaterialPoints point = {.n = 1, .F = F, .fiber = fiber[0], .W = &with};

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(F, q->F, 9));
  MaterialFiberDirections(m, root, X, fiber);
  PetscCall(MaterialEvaluate(m, MATERIAL_ISOCHORIC, &point));
  bare.num_fibers = 0;
  point.W         = &without;
  PetscCall(MaterialEvaluate(&bare, MATERIAL_ISOCHORIC, &point));
  *energy = point.bad ? 0 : with - without;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Point_Private(const MaterialSpec *m, PetscBool small, PetscInt root, const PetscReal X[3], const TermPoint *q, BodyTerms *sum)
{
  PetscReal S[9] = {0}, fibers, misfit;

  PetscFunctionBegin;
  sum->volume += q->volume;
  sum->energy += q->volume * q->W;
  sum->strain2 += q->volume * Strain2_Private(small, q->F);
  if (!small && !m->law->num_history && SecondPiola_Private(q->F, q->P, S)) {
    sum->linear += q->volume * Linear_Private(m, S, q, &misfit);
    sum->misfit += q->volume * misfit;
  }
  if (MaterialStoresPressure(m) && m->volumetric != VOLUMETRIC_LOG) sum->projected += q->volume * Projected_Private(m, small, q);
  if (!small && m->num_fibers) {
    PetscCall(Fibers_Private(m, root, X, q, &fibers));
    sum->fibers += q->volume * fibers;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An owned cell of order p, at p + 1 points in each direction: at p of them the pressure field is that of the displacements. */
static PetscErrorCode Cell_Private(Mechanics m, PetscInt cell, PetscInt root, PetscInt order, const MaterialSpec *material, const PetscReal u[], BodyTerms *sum)
{
  const PetscBool small = (PetscBool)(m->spec->kinematics == KINEMATICS_SMALL), ring = (PetscBool)(m->spec->model == MODEL_AXISYMMETRIC);
  const PetscInt  np = ElementNumNodes(m->dim, order);
  const Basis1D  *basis;
  PetscReal      *xi, *X, *J, *F, *P, *W;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 1, &basis));
  PetscCall(PetscMalloc6(3 * np, &xi, 3 * np, &X, 9 * np, &J, 9 * np, &F, 9 * np, &P, np, &W));
  for (PetscInt i = 0; i < np; ++i) Basis1DPoint(basis, m->dim, i, xi + m->dim * i);
  PetscCall(MechanicsPoints(m, cell, np, xi, u, &(PointValues){.X = X, .J = J, .F = F, .P = P, .W = W}));
  for (PetscInt i = 0; i < np; ++i) {
    PetscReal unused[3];
    TermPoint q = {.volume = Basis1DPoint(basis, m->dim, i, unused) * Det3(J + 9 * i) * (ring ? 2 * PETSC_PI * X[3 * i] : 1), .W = W[i]};
    PetscCall(PetscArraycpy(q.F, F + 9 * i, 9));
    PetscCall(PetscArraycpy(q.P, P + 9 * i, 9));
    PetscCall(Point_Private(material, small, root, X + 3 * i, &q, sum));
  }
  PetscCall(PetscFree6(xi, X, J, F, P, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsTerms(Mechanics m, const PetscReal u[], BodyTerms terms[])
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(terms, m->spec->num_bodies));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt c = 0; c < g->num_cells; ++c) {
      const PetscInt leaf = v->cell_leaf[g->cells[c]];
      PetscCall(Cell_Private(m, g->cells[c], t->leaf_root[leaf], v->cell_order[g->cells[c]], g->material, u, &terms[t->leaf_body[leaf]]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsFollowerTurn(Mechanics m, const PetscReal u[], PetscReal *work)
{
  const HPTables *v = HPSpaceGetTables(m->space);
  PetscReal      *rest, *there, *here;

  PetscFunctionBegin;
  const PetscInt n = v->num_nodes * m->dim;
  PetscCall(PetscCalloc3(n, &rest, n, &there, n, &here));
  PetscCall(MechanicsFollowers_Private(m, rest, there, NULL, NULL));
  PetscCall(MechanicsFollowers_Private(m, u, here, NULL, NULL));
  *work = 0;
  for (PetscInt i = 0; i < n; ++i) *work += 0.5 * (there[i] - here[i]) * u[i];
  PetscCall(PetscFree3(rest, there, here));
  PetscFunctionReturn(PETSC_SUCCESS);
}
