/* Nodal normals: outward side, means of the edges' vectors, symmetry planes. */
#include "contactfixture.h"

static const PetscReal *Normals(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  const PetscReal *n;

  EvaluateOnce(nonmortar, mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, pair, s);
  n = ContactPairGetNormals(*pair);
  return n;
}

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
  SumDestroy(s);
}

/* Closed counterclockwise polygon, edges of different length but vertices on a circle: with equal angles the normals are radial, pointing out. */
static void Circle(void **state)
{
  Chain            c, m;
  ContactPair      pair;
  Sum              s;
  const PetscReal *n;

  ChainCreate(&c, 12, PETSC_TRUE);
  for (int i = 0; i < 12; i++) c.x[2 * i] = 2 * cos(PETSC_PI * i / 6), c.x[2 * i + 1] = 2 * sin(PETSC_PI * i / 6);
  ChainLine(&m, 2, -1, 2.2, 1, 2.2);
  n = Normals(&c, &m, &pair, &s);
  for (int i = 0; i < 24; i++) assert_near(n[i], c.x[i] / 2, 1e-14);
  Cleanup(&c, &m, &pair, &s);
}

/* A corner, flat enough to be no edge: mean of both edges' vectors, the longer counts for more. */
static void Corner(void **state)
{
  Chain            c, m;
  ContactPair      pair;
  Sum              s;
  const PetscReal *n;

  ChainCreate(&c, 3, PETSC_FALSE);
  memcpy(c.x, (const PetscReal[6]){4, -3 * 0.5, 0, 0, -1, 0}, 6 * sizeof(PetscReal)); /* up a slope, then along the top */
  ChainLine(&m, 2, -1, 0.2, 5, 0.2);
  n = Normals(&c, &m, &pair, &s);
  assert_near(n[0], 1.5 / hypot(1.5, 4), 1e-15);
  assert_near(n[2], 1.5 / hypot(1.5, 5), 1e-15);
  assert_near(n[3], 5 / hypot(1.5, 5), 1e-15);
  assert_near(n[5], 1, 1e-15);
  Cleanup(&c, &m, &pair, &s);
}

static PetscReal Arch(PetscReal x)
{
  return 0.3 * x * x + 0.05 * x * x * x;
}

/* A half model with a symmetry plane x = 0 gives the full model's normals, gaps and gradients (half the weight at the plane). */
static void MirrorMatchesFullModel(void **state)
{
  enum { H = 5, M = 4 };
  Chain            half, full, mhalf, mfull;
  ContactPair      ph, pf;
  Sum              sh, sf;
  const PetscReal *nh, *nf;

  ChainCreate(&half, H, PETSC_FALSE); /* from x = 1 to the plane */
  ChainCreate(&full, 2 * H - 1, PETSC_FALSE);
  for (int i = 0; i < H; i++) {
    const PetscReal x = 1 - (PetscReal)i / (H - 1);

    half.x[2 * i] = full.x[2 * i] = x;
    full.x[2 * (2 * H - 2 - i)]   = -x;
    half.x[2 * i + 1] = full.x[2 * i + 1] = full.x[2 * (2 * H - 2 - i) + 1] = -Arch(x) + 0.2 * (1 - x);
  }
  half.mirror[2 * H - 2] = 1;
  ChainLine(&mhalf, M, 0, 0.3, 0.9, 0.25);
  ChainCreate(&mfull, 2 * M - 1, PETSC_FALSE);
  for (int i = 0; i < M; i++) {
    for (int k = 0; k < 2; k++) mfull.x[2 * (M - 1 + i) + k] = mhalf.x[2 * i + k];
    mfull.x[2 * (M - 1 - i)]     = -mhalf.x[2 * i];
    mfull.x[2 * (M - 1 - i) + 1] = mhalf.x[2 * i + 1];
  }
  nh = Normals(&half, &mhalf, &ph, &sh);
  nf = Normals(&full, &mfull, &pf, &sf);
  for (int i = 0; i < 2 * H; i++) assert_near(nh[i], nf[i], 1e-15);
  assert_near(nh[2 * H - 2], 0, 1e-15);
  for (int i = 0; i < H; i++) {
    const PetscReal share = i == H - 1 ? 2 : 1;

    assert_near(share * sh.gap[i], sf.gap[i], 1e-14);
    assert_near(share * sh.weight[i], sf.weight[i], 1e-14);
    for (int k = 0; k < 2 * (H - 1); k++) { /* a move of the half model is a symmetric move of the full one */
      const int image = 2 * (2 * H - 2 - k / 2) + k % 2, sign = k % 2 ? 1 : -1;

      assert_near(sh.dgap[i * sh.size + k] * share, sf.dgap[i * sf.size + k] + sign * sf.dgap[i * sf.size + image], 1e-13);
    }
    assert_near(sh.dgap[i * sh.size + 2 * H - 1] * share, sf.dgap[i * sf.size + 2 * H - 1], 1e-13); /* motion along the plane */
  }
  Cleanup(&half, &mhalf, &ph, &sh);
  Cleanup(&full, &mfull, &pf, &sf);
}

CONTACT_TEST_MAIN("contact: nodal normals", cmocka_unit_test(Circle), cmocka_unit_test(Corner), cmocka_unit_test(MirrorMatchesFullModel))
