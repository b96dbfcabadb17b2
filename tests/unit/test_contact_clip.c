/* The overlap of two quadrilaterals with sides on lines that nearly coincide: its corners stay with both and its area is theirs. Of others
   that are not convex, or folded: signed areas, and never more corners than there is room for. */
#include "contactfixture.h"
#include "kernelimpl.h"

/* Nonmortar: the unit square. Mortar: its lower side runs above y = 0 by `low` at x = a and by `high` at x = b, both near 1e-9, where clipping decides. */
static void Make(PetscReal a, PetscReal b, PetscReal low, PetscReal high, Overlap *o)
{
  const PetscReal own[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, other[4][2] = {{a, low}, {b, high}, {b, 0.8}, {a, 0.8}};

  memset(o, 0, sizeof(*o));
  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 2; i++) o->side[0].Y[k][i] = own[k][i], o->side[1].Y[k][i] = other[k][i];
}

static void Check(const Overlap *o, PetscReal a, PetscReal b)
{
  const PetscReal from = PetscMax(a, 0), to = PetscMin(b, 1);

  for (PetscInt k = 0; k < o->num; k++) {
    assert_true(o->v[k][0] > from - 2e-3 && o->v[k][0] < to + 2e-3);
    assert_true(o->v[k][1] > -1e-6 && o->v[k][1] < 0.8 + 1e-6);
  }
  assert_near(o->area, 0.8 * (to - from), 1e-7);
}

static void SidesThatNearlyCoincide(void **state)
{
  const PetscReal ends[][2] = {{-0.3, 0.7}, {0.2, 1.4}, {-0.2, 1.2}, {0.1, 0.9}};

  for (size_t e = 0; e < sizeof(ends) / sizeof(ends[0]); e++)
    for (int i = -40; i <= 40; i++)
      for (int j = -40; j <= 40; j++) {
        const PetscReal low = 5e-11 * i + 1e-9, high = 5e-11 * j + 1e-9;
        Overlap         o;

        Make(ends[e][0], ends[e][1], low, high, &o);
        assert_true(ContactClip(&o, 1));
        Check(&o, ends[e][0], ends[e][1]);
      }
}

/* Signed area of the part of corners a, b, c, d in o's first side; *fits: no more corners than there is room for. */
static PetscReal Part(const Overlap *o, int a, int b, int c, int d, PetscBool *fits)
{
  const int place[4] = {a, b, c, d};
  Overlap   part     = *o;

  for (int k = 0; k < 4; k++)
    for (int i = 0; i < 2; i++) part.side[1].Y[k][i] = o->side[1].Y[place[k]][i];
  part.area = 0;
  (void)ContactClip(&part, 1);
  *fits = (PetscBool)(part.num <= FACET_VERTICES);
  return part.num < 3 ? 0 : part.area;
}

static void QuadrilateralsOfAnyShape(void **state)
{
  PetscInt many = 0, bent = 0;
  uint64_t seed = 7;

  for (int n = 0; n < 200000; n++) {
    PetscBool fits[3];
    PetscReal whole, first, second;
    Overlap   o;

    Make(0, 1, 0, 0, &o);
    for (int k = 0; k < 4; k++)
      for (int i = 0; i < 2; i++) o.side[1].Y[k][i] = 0.5 + 1.5 * Random(&seed);
    whole  = Part(&o, 0, 1, 2, 3, &fits[0]);
    first  = Part(&o, 0, 1, 2, 2, &fits[1]);
    second = Part(&o, 0, 2, 3, 3, &fits[2]);
    assert_true(fits[1] && fits[2]);
    if (!ContactQuadIsConvex(&o.side[1])) bent++;
    if (fits[0])
      assert_near(whole, first + second, 1e-7);
    else
      many++;
  }
  assert_true(bent > 100000 && many > 0);
  printf("%d of %d have more corners than there is room for\n", (int)many, 200000);
}

CONTACT_TEST_MAIN("contact: clipping", cmocka_unit_test(SidesThatNearlyCoincide), cmocka_unit_test(QuadrilateralsOfAnyShape))
