/* Contact along a continuous direction where both surfaces end in planes of symmetry that lines of either mesh meet at an angle: what the mortar side covers
   ends where the nonmortar side ends. */
#include "rayfixture.h"

/* A chart point to the sphere of radius 1, v along (1, a, b); the planes a = 0, a = 1, b = 0, b = 1 meet its lines at an angle, two of them at 120 degrees. */
static void Place(Patch *p)
{
  const PetscReal root = sqrt(0.5), plane[2][2][3] = {{{0, 1, 0}, {root, -root, 0}}, {{0, 0, 1}, {root, 0, -root}}};

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal v[3] = {1, p->u[2 * n], p->u[2 * n + 1]}, length = sqrt(Dot3(v, v));
    PetscInt        num = 0;

    for (int c = 0; c < 3; c++) p->x[3 * n + c] = p->X[3 * n + c] = v[c] / length;
    for (int i = 0; i < 2; i++)
      for (int k = 0; k < 2; k++) {
        if (fabs(p->u[2 * n + i] - k) > 1e-9) continue;
        for (int c = 0; c < 3; c++) p->mirror[6 * n + 3 * num + c] = plane[i][k][c];
        num++;
      }
  }
}

/* n x n facets; strip: a row of n instead, of the same extent. */
static void Make(Patch *p, PetscInt order, PetscInt n, PetscReal lo, PetscReal hi, PetscBool forward, PetscBool strip)
{
  PatchCreate(p, 3, order, n, lo, hi, forward, PETSC_FALSE);
  if (strip) {
    p->s.num_facets = n;
    for (PetscInt i = 0; i < p->s.num_nodes; i++) p->u[2 * i + 1] = lo + (PetscReal)n * (p->u[2 * i + 1] - lo);
  }
  Place(p);
}

/* Area that a mortar side of m facets along each direction, from lo to hi, covers of a nonmortar side of n from 0 to 1. */
static PetscReal Area(const PetscInt order[2], PetscBool strip, PetscInt n, PetscInt m, PetscReal lo, PetscReal hi)
{
  const ContactSpec spec = {.friction = 0};
  Patch             nonmortar, mortar;
  ContactPair       pair;
  Sum               s;
  PetscReal         area;
  PetscInt          degenerate;

  Make(&nonmortar, order[0], n, 0, 1, PETSC_TRUE, strip);
  Make(&mortar, order[1], m, lo, hi, PETSC_FALSE, strip);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(&s, &nonmortar, &mortar);
  SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_FALSE);
  degenerate = ContactPairGetDegenerate(pair);
  assert_false(s.failed);
  assert_int_equal(degenerate, 0);
  area = s.area;
  SumDestroy(&s);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
  return area;
}

static void test_planes_at_an_angle(void **state)
{
  static const PetscInt Orders[][2] = {{1, 1}, {1, 3}, {2, 2}, {3, 2}, {3, 3}, {4, 4}};

  (void)state;
  for (size_t k = 0; k < sizeof(Orders) / sizeof(Orders[0]); k++)
    for (int strip = 0; strip < 2; strip++)
      for (PetscInt n = 2; n < 4; n++) {
        const PetscReal all = Area(Orders[k], strip, n, 5, -0.1, 1.1), few = Area(Orders[k], strip, n, 2, 0, 1), many = Area(Orders[k], strip, n, 5, 0, 1);

        print_message("orders %d/%d, %d%s: share not covered by 2 %.1e, by 5 %.1e\n", (int)Orders[k][0], (int)Orders[k][1], (int)n,
                      strip ? " in a row" : " x n", 1 - few / all, 1 - many / all);
        assert_near(few, all, 1e-9 * all);
        assert_near(many, all, 1e-9 * all);
      }
}

/* Facets that end in a plane of symmetry and have turned so far that they lie along it, seen by a rank that did not know those beyond its own and their
   neighbours when it searched: the same normals and gaps, once it knows them, as where all was known. */
static void test_known_later(void **state)
{
  const ContactSpec spec = {0};
  const PetscInt   *start, *candidate, facet[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  PetscBool         has[16];
  PetscReal         known[48];
  Patch             a, b;
  ContactPair       pair[2];
  ContactSurface    early;
  Sum               sum[2];

  PatchCreate(&a, 3, 1, 3, 0, 1, PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&b, 3, 1, 2, -1, 2, PETSC_FALSE, PETSC_FALSE);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) {
    const PetscReal u = a.u[2 * n], v = a.u[2 * n + 1];

    if (u == 0) a.mirror[6 * n] = 1;
    for (int c = 0; c < 3; c++) a.x[3 * n + c] = a.X[3 * n + c] = c == 0 ? u : c == 1 ? v : 0.9 * u;
    a.x[3 * n + 2] = 1.5 * u * (1 + 0.1 * v);
    has[n]         = (PetscBool)(v < 0.5);
    for (int c = 0; c < 3; c++) known[3 * n + c] = has[n] ? a.x[3 * n + c] : NAN;
  }
  for (PetscInt n = 0; n < b.s.num_nodes; n++)
    for (int c = 0; c < 3; c++) b.x[3 * n + c] = b.X[3 * n + c] = c < 2 ? b.u[2 * n + c] : 2;
  early   = a.s;
  early.x = known, early.has = has;
  for (int k = 0; k < 2; k++) {
    CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair[k]));
    SumCreate(&sum[k], &a, &b);
  }
  SearchAll(pair[0], &a, &b, 5, 0);
  ContactPairGetCandidates(pair[0], &start, &candidate);
  CHECK_CALL(ContactPairSearch(pair[1], &early, &b.s, 0, NULL, 5, 0));
  CHECK_CALL(ContactPairSetCandidates(pair[1], &a.s, 9, facet, start, candidate));
  for (int k = 0; k < 2; k++) SumSurfaces(&sum[k], pair[k], &a.s, &b.s, NULL, PETSC_FALSE, PETSC_FALSE);
  assert_false(sum[0].failed || sum[1].failed);
  for (PetscInt n = 0; n < 3 * a.s.num_nodes; n++) assert_near(ContactPairGetNormals(pair[1])[n], ContactPairGetNormals(pair[0])[n], 1e-15);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) assert_near(sum[1].gap[n], sum[0].gap[n], 1e-15);
  assert_true(ContactPairGetNormals(pair[0])[0] < -0.7);
  for (int k = 0; k < 2; k++) {
    CHECK_CALL(ContactPairDestroy(&pair[k]));
    SumDestroy(&sum[k]);
  }
  PatchDestroy(&a), PatchDestroy(&b);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_known_later), cmocka_unit_test(test_planes_at_an_angle)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
