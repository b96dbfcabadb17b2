/* Contact terms of the estimate in three dimensions, meshes that do not match and hang on both sides, facets that are no parallelograms: no residual on the
   contact patch; bilinear pressures arrive on both sides as they are; the complementarity of a known gap under a known pressure. */
#include "estimateimpl.h"
#include "solidpatch.h"

static void NoResidual(void **state)
{
  for (PetscInt kind = 0; kind < 4; ++kind) {
    Patch              p;
    Estimate           e;
    const ContactView *view;
    PatchScene(&p, 1 + kind % 2, kind == 3 ? KINEMATICS_SMALL : KINEMATICS_FINITE, (PetscBool)(kind == 2), "-0.1");
    p.forest = PatchForest(2, 3);
    PatchRefine(&p.forest, 1);
    PatchStart(&p);
    view = InterfaceGetContact(ProblemInterface(p.problem), 0);
    assert_true(PatchHanging(&view->nonmortar) > 0 && PatchHanging(&view->mortar) > 0);
    PatchSolve(p.problem, &p.state);
    OK(EstimateCompute(p.problem, &p.state, &e));
    assert_true(e.norm > 0.05);
    if (!(e.total < 1e-7 * e.norm)) /* z g of a gap of round-off: the root of 1e-16 */
      fail_msg("kind %d: %g of %g, shares %g %g %g %g %g", (int)kind, (double)e.total, (double)e.norm, (double)e.part[0], (double)e.part[1], (double)e.part[2],
               (double)e.part[3], (double)e.part[4]);
    OK(EstimateDestroy(&e));
    PatchDestroy(&p);
  }
}

/* A bilinear field at the nonmortar nodes. */
static PetscReal Field(const PetscReal X[3])
{
  return 0.2 + 0.05 * X[0] - 0.03 * X[1] + 0.04 * X[0] * X[1];
}

static void SetField(Patch *p, const ContactView *view)
{
  PetscReal *z;

  OK(PetscMalloc1(view->nonmortar.num_nodes, &z));
  for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) z[n] = Field(view->nonmortar.X + 3 * n);
  OK(InterfaceSetMultipliers(ProblemInterface(p->problem), 0, z, p->state.x));
  OK(PetscFree(z));
}

/* Tractions at points of all facets of this rank on a side, blocks at rest: normals (0, 0, -1), stretch 1. Returns the largest error. */
static PetscReal SideError(const ContactTerms *terms, const ForestTables *t, const SurfaceView *s, PetscReal sign)
{
  PetscReal   error = 0;
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (t->leaf_rank[s->facet_leaf[f]] != rank) continue;
    for (PetscInt q = 0; q < 16; ++q) {
      const PetscReal xi[2] = {-0.97 + 0.6 * (PetscReal)(q % 4), -0.93 + 0.63 * (PetscReal)(q / 4)};
      PetscReal       N[4], X[3], T[3] = {0, 0, 0};
      ContactShape_Private(s, f, xi, N);
      ContactPosition_Private(s, f, s->X, N, X);
      ContactTermsTraction_Private(terms, s->facet_entity[f] - t->first[2], X, T);
      assert_near(T[0], 0, 1e-12);
      assert_near(T[1], 0, 1e-12);
      error = PetscMax(error, PetscAbsReal(T[2] - sign * Field(X)));
    }
  }
  return error;
}

/* Exact on the nonmortar side always, on the mortar side where its facets are parallelograms; else places are linear within a triangle of a segment only. */
static void BothSides(void **state)
{
  for (PetscInt skewed = 0; skewed < 2; ++skewed) {
    Patch               p;
    ContactTerms        terms = {0};
    const ContactView  *view;
    const ForestTables *t;
    ProblemStatus       status;
    Vec                 r;
    patch_skew = skewed ? 0.08 : 0;
    PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, "0");
    p.forest = PatchForest(2, 3);
    PatchRefine(&p.forest, 2);
    PatchStart(&p);
    t    = ForestGetTables(p.forest);
    view = InterfaceGetContact(ProblemInterface(p.problem), 0);
    assert_true(PatchHanging(&view->nonmortar) > 0 && PatchHanging(&view->mortar) > 0);
    SetField(&p, view);
    OK(ProblemCreateVector(p.problem, &r));
    PatchEvaluate(p.problem, p.state.x, r, &status);
    OK(ContactTermsCreate_Private(p.problem, &terms));
    assert_near(SideError(&terms, t, &view->nonmortar, 1), 0, 1e-12);
    assert_near(SideError(&terms, t, &view->mortar, -1), 0, skewed ? 1e-3 : 1e-12);
    OK(ContactTermsDestroy_Private(&terms));
    OK(VecDestroy(&r));
    PatchDestroy(&p);
  }
  patch_skew = 0.08;
}

/* The upper block moved by d, all multipliers z: share of contact in the estimate. */
static PetscReal ContactShare(Patch *p, PetscReal d, PetscReal z)
{
  const ContactView  *view;
  const HPTables     *v;
  const ForestTables *t;
  ProblemStatus       status;
  Estimate            e;
  Vec                 r;
  PetscReal          *local, *all;

  v    = HPSpaceGetTables(ProblemSpace(p->problem));
  t    = ForestGetTables(p->forest);
  view = InterfaceGetContact(ProblemInterface(p->problem), 0);
  OK(PetscCalloc1(3 * v->num_nodes, &local));
  for (PetscInt n = 0; n < v->num_nodes; ++n) local[3 * n + 2] = t->leaf_body[t->entity_leaf[v->node_entity[n]]] == 1 ? d : 0;
  OK(ProblemSetDisplacement(p->problem, local, p->state.x));
  OK(PetscMalloc1(view->nonmortar.num_nodes, &all));
  for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) all[n] = z;
  OK(InterfaceSetMultipliers(ProblemInterface(p->problem), 0, all, p->state.x));
  OK(ProblemCreateVector(p->problem, &r));
  PatchEvaluate(p->problem, p->state.x, r, &status);
  OK(EstimateCompute(p->problem, &p->state, &e));
  const PetscReal share = e.part[PART_CONTACT];
  OK(EstimateDestroy(&e));
  OK(VecDestroy(&r));
  OK(PetscFree(all));
  OK(PetscFree(local));
  return share;
}

/* Area over the size of the facet, summed over the nonmortar facets. */
static PetscReal AreaOverSize(const Patch *p)
{
  const ContactView  *view;
  const ForestTables *t;
  PetscReal           sum = 0;

  t    = ForestGetTables(p->forest);
  view = InterfaceGetContact(ProblemInterface(p->problem), 0);
  for (PetscInt f = 0; f < view->nonmortar.num_facets; ++f) {
    const int8_t *level = t->leaf_level + 3 * view->nonmortar.facet_leaf[f];
    sum += PetscSqrtReal(4. / 9 / (PetscReal)(1 << (level[0] + level[1])));
  }
  return sum;
}

/* Moved apart by d under z = 1/10: int z g = d z on area 4, besides the traction that no stress answers, twice 1/6 z^2 h/(p m) by facets. Moved into each
 * other, z = 0: pi E* d^2 / size, E* half of E/(1 - nu^2). */
static void Complementarity(void **state)
{
  const PetscReal z = 0.1;
  PetscReal       share[3];

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal    d[3]    = {0.02, 0.05, -0.01};
    static const char *text[3] = {"0.02", "0.05", "-0.01"};
    Patch              p;
    PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, text[k]);
    p.forest = PatchForest(2, 3);
    PatchRefine(&p.forest, 2);
    PatchStart(&p);
    OK(ProblemJump(p.problem));
    share[k] = ContactShare(&p, d[k], k < 2 ? z : 0);
    if (k == 2) {
      const PetscReal mu = p.material.mu, kappa = p.material.kappa, both = (3 * kappa + 4 * mu) / (2 * mu * (3 * kappa + mu));
      const PetscReal expected = PETSC_PI / both * PetscSqr(d[k]) * AreaOverSize(&p);
      assert_near(share[k], expected, 1e-9 * expected);
    }
    PatchDestroy(&p);
  }
  assert_near(share[1] - share[0], 4 * z * (0.05 - 0.02), 1e-9);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NoResidual), cmocka_unit_test(BothSides), cmocka_unit_test(Complementarity)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
