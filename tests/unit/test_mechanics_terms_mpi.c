/* Energies that parts of a model add (mechanics/terms.c), at homogeneous deformations of a box on a mesh with hanging nodes, against closed forms. */
#include "bulkfixture.h"

/* Local array of u = H X. */
static void Fill(const Bulk *b, const PetscReal H[9], PetscReal **u)
{
  const HPTables *v;

  v = HPSpaceGetTables(b->space);
  OK(PetscCalloc1(v->num_nodes * v->dim, u));
  for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i)
    for (PetscInt k = 0; k < v->dim; ++k) (*u)[i] += H[3 * (i % v->dim) + k] * v->X[3 * (i / v->dim) + k];
}

/* Terms of all ranks, and the turn of pressures on the high side across x. */
static BodyTerms Terms(PetscInt dim, const char *law, Formulation formulation, const PetscReal H[9], PetscReal pressure, PetscReal *turn)
{
  Bulk       b = {0};
  Box        box;
  BodyTerms  terms;
  PetscReal *u;

  BulkInit(&b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&b.material, law, VOLUMETRIC_QUADRATIC, formulation, 1.5, 4);
  b.boundaries[1].pressure = BulkExpression("%.17g", (double)pressure);
  b.forest                 = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 1}, 1, 0, 3, &box);
  BulkRefine(&b.forest, dim, 1, PETSC_TRUE);
  BulkSetUp(&b, 1, 3);
  Fill(&b, H, &u);
  OK(MechanicsTerms(b.mechanics, u, &terms));
  OK(MechanicsFollowerTurn(b.mechanics, u, turn));
  OK(MPI_Allreduce(MPI_IN_PLACE, &terms, (PetscMPIInt)(sizeof(terms) / sizeof(PetscReal)), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, turn, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(PetscFree(u));
  BulkDestroy(&b);
  return terms;
}

/* Stretches e_i: with the law S = C : E the terms of small kinematics are S : (e - E) = - S_i e_i^2 / 2, the misfit 2 mu (e_i^2 / 2)^2; a pressure's face grows
   by the stretches across it. */
static void Stretched(void **state)
{
  const PetscReal e[3] = {0.1, -0.05, 0.02}, mu = 1.5, lambda = 4 - 2 * mu / 3;

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    const PetscReal H[9]  = {e[0], 0, 0, 0, e[1], 0, 0, 0, dim == 3 ? e[2] : 0};
    PetscReal       trace = 0, energy, linear = 0, misfit = 0, strain2 = 0, turn;
    for (PetscInt i = 0; i < dim; ++i) trace += e[i] + 0.5 * e[i] * e[i];
    energy = 0.5 * lambda * trace * trace;
    for (PetscInt i = 0; i < dim; ++i) {
      const PetscReal E = e[i] + 0.5 * e[i] * e[i];
      energy += mu * E * E;
      linear -= 0.5 * (lambda * trace + 2 * mu * E) * e[i] * e[i];
      misfit += 2 * mu * PetscSqr(0.5 * e[i] * e[i]);
      strain2 += E * E;
    }
    const BodyTerms t      = Terms(dim, "saint_venant_kirchhoff", FORMULATION_DISPLACEMENT, H, 0.3, &turn);
    const PetscReal growth = dim == 2 ? e[1] : (1 + e[1]) * (1 + e[2]) - 1;
    assert_true(t.volume > 0);
    assert_near(t.energy, energy * t.volume, 1e-12);
    assert_near(t.linear, linear * t.volume, 1e-12);
    assert_near(t.misfit, misfit * t.volume, 1e-12);
    assert_near(t.strain2, strain2 * t.volume, 1e-12);
    assert_near(turn, -0.5 * 0.3 * growth * e[0] * t.volume, 1e-12);
    assert_true(t.fibers == 0 && t.projected == 0);
  }
}

/* A turned body has neither stress nor energy: small kinematics, which would see a strain, adds nothing to the energy at the stress found. */
static void Turned(void **state)
{
  const PetscReal a = 0.7, H[9] = {cos(a) - 1, -sin(a), 0, sin(a), cos(a) - 1, 0, 0, 0, 0};
  PetscReal       turn;
  const BodyTerms t = Terms(2, "neo_hookean", FORMULATION_DISPLACEMENT, H, 0, &turn);

  assert_near(t.energy, 0, 1e-12);
  assert_near(t.linear, 0, 1e-12);
  assert_near(t.strain2, 0, 1e-12);
}

/* The pressure field of a mixed cell follows a constant change of volume whole. */
static void Mixed(void **state)
{
  const PetscReal H[9] = {0.1, 0.05, 0, -0.02, 0.08, 0, 0, 0, 0};
  PetscReal       turn;
  const BodyTerms t = Terms(2, "neo_hookean", FORMULATION_MIXED, H, 0, &turn), whole = Terms(2, "neo_hookean", FORMULATION_DISPLACEMENT, H, 0, &turn);

  assert_near(t.projected, 0, 1e-12);
  assert_near(t.energy, whole.energy, 1e-12);
  assert_true(whole.projected == 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Stretched), cmocka_unit_test(Turned), cmocka_unit_test(Mixed)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
