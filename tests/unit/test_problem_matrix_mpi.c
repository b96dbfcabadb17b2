/* The matrix has room for all that its ranks add to each other's rows: assembly finds no entry without a place, on no number of ranks. Blocks in contact, whose
   facets meet other ranks' nodes; cells with nodes that hang on nodes far from them, with displacements alone or with unknown pressures. */
#include "problemfixture.h"
#include "problemimpl.h"
#include "solidpatch.h"

/* A matrix as it is made, then the tangent at x: nothing may be new. */
static void CheckRoom(Problem p, Vec x)
{
  PetscObjectState made, state;
  PetscBool        bad = PETSC_FALSE;
  MatInfo          info;
  Mat              matrix;

  OK(ProblemMatrix_Private(p));
  OK(ProblemGetMatrix(p, &matrix));
  OK(MatGetNonzeroState(matrix, &made));
  OK(ProblemTangent(p, x, NULL, NULL, &bad));
  assert_false(bad);
  OK(ProblemGetMatrix(p, &matrix));
  OK(MatGetNonzeroState(matrix, &state));
  OK(MatGetInfo(matrix, MAT_GLOBAL_SUM, &info));
  if (info.mallocs > 0 || state != made) fail_msg("%g reallocations, state of the pattern %d, made as %d", info.mallocs, (int)state, (int)made);
}

static PetscBool Bears(Problem problem)
{
  const ContactView *view = InterfaceGetContact(ProblemInterface(problem), 0);
  PetscInt           num  = 0;

  for (PetscInt j = 0; j < view->nonmortar.num_nodes; ++j) num += view->nonmortar.owned[j] && view->active[j];
  OK(MPI_Allreduce(MPI_IN_PLACE, &num, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return (PetscBool)(num > 0);
}

static void Contact(void **unused)
{
  for (PetscInt k = 0; k < 3; ++k) {
    Patch p;
    PatchScene(&p, k ? 2 : 1, KINEMATICS_FINITE, (PetscBool)(k == 2), "-0.1");
    p.contact.full = (PetscBool)(k == 2);
    p.forest       = PatchForest(3, 4);
    PatchRefine(&p.forest, 2);
    PatchStart(&p);
    PatchSolve(p.problem, &p.state);
    assert_true(Bears(p.problem));
    CheckRoom(p.problem, p.state.x);
    PatchDestroy(&p);
  }
}

static void Hanging(void **unused)
{
  for (PetscInt k = 0; k < 8; ++k) {
    const PetscInt  dim    = 2 + k % 2;
    const PetscBool volume = (PetscBool)(k / 2 % 2);
    Solved          s;

    memset(&s, 0, sizeof(s));
    HangingMesh(&s, dim, 1, (1 << dim) - 1, (uint64_t)k + 1);
    BulkInit(&s.bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
    BulkMaterial(&s.bulk.material, "neo_hookean", VOLUMETRIC_QUADRATIC, volume ? FORMULATION_AUTO : FORMULATION_DISPLACEMENT, 1, volume ? INFINITY : 2);
    for (PetscInt c = 0; c < dim; ++c) s.bulk.boundaries[0].fix[c] = PETSC_TRUE;
    SolvedCreate(&s, volume ? 2 : 1, 2);
    OK(ProblemSetTime(s.problem, 1));
    CheckRoom(s.problem, s.state.x);
    SolvedDestroy(&s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Contact), cmocka_unit_test(Hanging)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
