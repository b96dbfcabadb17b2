/* Flat corners opened: a cell with two sides on the unit circle and its neighbours, whichever way the cells are numbered and turned. */
#include "forest_box.h"

#define MAX_ORDER 4

typedef struct {
  PetscInt q, start; /* geometry order; corner of the flat cell that comes first */
  PetscInt sides;    /* 1: neighbour beyond C-D, 2: beyond D-A, 3: both */
  PetscInt bodies;   /* 2: the neighbours are another body's */
} Case;

/*  0 1 2: A B C on the circle at 135, 90, 45 degrees; 3: D; 4 5: E F beyond C-D; 6 7: G (on the circle), H beyond D-A. */
static const PetscReal corner[8][2] = {{-M_SQRT1_2, M_SQRT1_2}, {0, 1}, {M_SQRT1_2, M_SQRT1_2}, {0, 0.2}, {1, 0}, {0.4, -0.3}, {-1, 0}, {-0.5, -0.2}};

static void SidePoint(PetscInt v, PetscInt w, PetscReal s, PetscReal X[2])
{
  const PetscReal *a = corner[v], *b = corner[w], ra = a[0] * a[0] + a[1] * a[1], rb = b[0] * b[0] + b[1] * b[1];
  const PetscReal  from = PetscAtan2Real(a[1], a[0]), to = PetscAtan2Real(b[1], b[0]), angle = from + s * (to - from);
  const PetscBool  arc = (PetscBool)(PetscAbsReal(ra - 1) < 1e-9 && PetscAbsReal(rb - 1) < 1e-9);

  X[0] = arc ? PetscCosReal(angle) : a[0] + s * (b[0] - a[0]);
  X[1] = arc ? PetscSinReal(angle) : a[1] + s * (b[1] - a[1]);
}

/* Vertices round the cell -> lexicographic, sides blended. */
static void PutCell(CoarseMesh *m, const PetscInt ring[4])
{
  const PetscInt q = m->geometry_order, lexicographic[4] = {ring[0], ring[1], ring[3], ring[2]};

  for (PetscInt k = 0; k < 4; ++k) m->cell_vertices[4 * m->num_cells + k] = lexicographic[k];
  for (PetscInt j = 0; j <= q; ++j)
    for (PetscInt i = 0; i <= q; ++i) {
      const PetscReal s = (PetscReal)i / q, t = (PetscReal)j / q;
      PetscReal       side[4][2], *X          = m->cell_geometry + 3 * ((m->num_cells * (q + 1) + j) * (q + 1) + i);
      SidePoint(ring[0], ring[1], s, side[0]);
      SidePoint(ring[1], ring[2], t, side[1]);
      SidePoint(ring[3], ring[2], s, side[2]);
      SidePoint(ring[0], ring[3], t, side[3]);
      for (PetscInt c = 0; c < 2; ++c)
        X[c] = (1 - t) * side[0][c] + t * side[2][c] + (1 - s) * side[3][c] + s * side[1][c] - (1 - s) * (1 - t) * corner[ring[0]][c] -
               s * (1 - t) * corner[ring[1]][c] - s * t * corner[ring[2]][c] - (1 - s) * t * corner[ring[3]][c];
      X[2] = 0;
    }
  ++m->num_cells;
}

static void Mesh(const Case *k, CoarseMesh *m)
{
  static const PetscInt right[4] = {3, 5, 4, 2}, left[4] = {6, 7, 3, 0}; /* D F E C; G H D A: counterclockwise, as gmsh's reader has them */
  const PetscInt        flat[4] = {3, 2, 1, 0}, n = 3 * PetscSqr(k->q + 1);
  PetscInt              ring[4];

  *m = (CoarseMesh){.dim = 2, .num_vertices = 8, .geometry_order = k->q, .num_bodies = k->bodies, .num_fields = 2};
  OK(PetscMalloc1(12, &m->cell_vertices));
  OK(PetscMalloc1(3 * n, &m->cell_geometry));
  OK(PetscMalloc1(3, &m->cell_body));
  for (PetscInt i = 0; i < 4; ++i) ring[i] = flat[(k->start + i) % 4];
  PutCell(m, ring);
  if (k->sides & 1) PutCell(m, right);
  if (k->sides & 2) PutCell(m, left);
  OK(PetscMalloc1(6 * m->num_cells, &m->field));
  for (PetscInt c = 0; c < m->num_cells; ++c) {
    m->cell_body[c] = c && k->bodies > 1;
    for (PetscInt i = 0; i < 6; ++i) m->field[3 * (i / 3 * m->num_cells + c) + i % 3] = 100 * (i / 3) + 10 * c + i % 3;
  }
}

static PetscReal Area(const CoarseMesh *m)
{
  PetscReal area = 0;

  for (PetscInt c = 0; c < m->num_cells; ++c)
    for (PetscInt i = 0; i < 64; ++i) { /* 8 points of Gauss in each direction */
      static const PetscReal x[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
      static const PetscReal w[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
      const PetscInt         a = i & 7, b = i >> 3;
      const PetscReal        xi[3] = {0.5 + (a & 1 ? 0.5 : -0.5) * x[a >> 1], 0.5 + (b & 1 ? 0.5 : -0.5) * x[b >> 1], 0};
      PetscReal              X[3], J[9];
      ForestCoarseMapPoint(m, c, xi, X, J);
      area += 0.25 * w[a >> 1] * w[b >> 1] * (J[0] * J[3] - J[1] * J[2]);
    }
  return area;
}

/* Of the angles at corners of cells; negative: inverted. */
static PetscReal LeastSine(const CoarseMesh *m)
{
  PetscReal least = 1;

  for (PetscInt c = 0; c < m->num_cells; ++c)
    for (PetscInt k = 0; k < 4; ++k) {
      const PetscReal xi[3] = {k & 1, k >> 1, 0};
      PetscReal       X[3], J[9];
      ForestCoarseMapPoint(m, c, xi, X, J);
      least = PetscMin(least, (J[0] * J[3] - J[1] * J[2]) / PetscSqrtReal((J[0] * J[0] + J[2] * J[2]) * (J[1] * J[1] + J[3] * J[3])));
    }
  return least;
}

static void test_opened(void **state)
{
  PetscReal worst = 1;

  for (PetscInt q = 2; q <= MAX_ORDER; ++q)
    for (PetscInt start = 0; start < 4; ++start)
      for (PetscInt sides = 1; sides <= 3; ++sides) {
        const Case      k = {.q = q, .start = start, .sides = sides, .bodies = 1};
        CoarseMesh      m;
        const PetscInt *facets = NULL;
        Mesh(&k, &m);
        const PetscInt  num    = m.num_cells;
        const PetscReal before = Area(&m);
        assert_true(LeastSine(&m) < 0.05);
        OK(ForestOpenFlatCorners(&m, 0, facets));
        assert_int_equal(m.num_opened, 1);
        assert_true(PetscAbsReal(m.first_opened[0]) + PetscAbsReal(m.first_opened[1] - 1) < 1e-14);
        assert_int_equal(m.num_cells, num + 2);
        assert_int_equal(m.num_vertices, 10);
        assert_true(PetscAbsReal(Area(&m) - before) < 1e-13);
        worst = PetscMin(worst, LeastSine(&m));
        for (PetscInt c = 0; c < m.num_cells; ++c) {
          assert_true(ForestCoarseJacobianSign(&m, c) > 0);
          for (PetscInt f = 0; f < 2; ++f) { /* the field of the cell that it was part of */
            const PetscReal *value = m.field + 3 * (f * m.num_cells + c);
            const PetscReal  from  = value[0] - 100 * f;
            assert_true(from == 0 || (from == 10 && num > 1) || (from == 20 && num > 2));
            assert_true(value[2] == value[0] + 2);
            if (c < num) assert_true(from == 10 * c);
          }
        }
        OK(ForestCoarseMeshDestroy(&m));
      }
  print_message("  least sine of a corner's angle %.3f\n", (double)worst);
  assert_true(worst > PetscSinReal(165 * PETSC_PI / 180));
}

/* Sides that a group names, or that lie between two bodies, stay; without a neighbour nothing can be done. */
static void test_kept(void **state)
{
  static const PetscInt named[4] = {3, 2, 0, 3};

  for (PetscInt i = 0; i < 4; ++i) {
    const Case k = {.q = 2, .sides = i == 3 ? 0 : 3, .bodies = i == 2 ? 2 : 1};
    CoarseMesh m;
    Mesh(&k, &m);
    const PetscInt num = m.num_cells;
    OK(ForestOpenFlatCorners(&m, i < 2 ? i + 1 : 0, named));
    assert_int_equal(m.num_cells, i == 0 ? num + 2 : num);
    assert_int_equal(m.num_opened, i == 0);
    for (PetscInt c = 0; c < m.num_cells && i == 0; ++c) { /* C is still joined with D, but not with B across it */
      PetscInt has = 0;
      for (PetscInt v = 0; v < 4; ++v) has |= (m.cell_vertices[4 * c + v] == 3) | (m.cell_vertices[4 * c + v] == 2) << 1;
      if (c == 1) assert_int_equal(has, 3);
    }
    OK(ForestCoarseMeshDestroy(&m));
  }
}

/* Straight sides have no flat corner here: 135 degrees. */
static void test_straight(void **state)
{
  const Case k = {.q = 1, .sides = 3, .bodies = 1};
  CoarseMesh m;

  Mesh(&k, &m);
  OK(ForestOpenFlatCorners(&m, 0, NULL));
  assert_int_equal(m.num_cells, 3);
  OK(ForestCoarseMeshDestroy(&m));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_opened), cmocka_unit_test(test_kept), cmocka_unit_test(test_straight)};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ErrorHandlerPush());
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
