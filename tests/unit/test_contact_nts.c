/* Node-to-segment option: gap along the nodal normal, tributary weights, hits at vertices. (Derivatives: test_contact_jacobian; balance: test_contact_gap.) */
#include "contactfixture.h"

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
  SumDestroy(s);
}

/* A tilted straight mortar side over a flat one: g_j = y(x_j), w_j = half the adjacent lengths; nodes beyond the mortar side have no weight. */
static void TiltedFace(void **state)
{
  Chain       nonmortar, mortar;
  ContactPair pair;
  Sum         s;

  ChainLine(&nonmortar, 6, 1, 0, 0, 0);
  ChainLine(&mortar, 4, 0.1, 0.1 + 0.03 * 0.1, 2, 0.1 + 0.03 * 2);
  EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_TRUE, 0.5, NULL, &pair, &s);
  for (int j = 0; j < 6; j++) {
    const PetscReal w = j == 5 ? 0 : j == 0 ? 0.1 : 0.2;

    assert_near(s.weight[j], w, 1e-15);
    assert_near(s.gap[j], w * (0.1 + 0.03 * (1 - 0.2 * j)), 1e-15);
  }
  assert_near(s.min_gap, 0.1 + 0.03 * 0.2, 1e-15);
  Cleanup(&nonmortar, &mortar, &pair, &s);
}

/* Matching meshes in many directions: every ray meets a mortar vertex up to rounding. Each node is hit exactly once per adjacent edge. */
static void VertexHits(void **state)
{
  for (int turn = 0; turn < 12; turn++) {
    const ContactSegment *seg;
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    Sum                   s;
    PetscInt              num;

    ChainLine(&nonmortar, 8, 1, 0, 0, 0);
    ChainLine(&mortar, 8, -1. / 7, 0.07, 1 - 1. / 7, 0.07);
    mortar.x[14] = 1.01;
    ChainMove(&nonmortar, 0.37 * turn, 3, 2);
    ChainMove(&mortar, 0.37 * turn, 3, 2);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_TRUE, 0.5, NULL, &pair, &s);
    ContactPairGetSegments(pair, &num, &seg);
    assert_int_equal(num, 14);
    for (int j = 0; j < 8; j++) assert_near(s.gap[j], 0.07 * s.weight[j], 1e-14);
    assert_near(s.area, 1, 1e-14);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

CONTACT_TEST_MAIN("contact: node to segment", cmocka_unit_test(TiltedFace), cmocka_unit_test(VertexHits))
