/* Random refinement of boxes with randomly turned coarse cells: the entity tables agree with the positions, whichever leaf, parent or
   sub-entity they are reached through; neighbours are 1-irregular; marks of boundaries are those of the sides. */
#include "forest_box.h"
#include "share.h"

#define TOLERANCE 1e-13

/* Every closure entry of every leaf lies where its other leaves say: sample points of the frame. */
static void CheckLeaves(Forest forest)
{
  const ForestTables *t = &forest->tables;
  const PetscInt      n = ForestPow3[t->dim];
  PetscReal           X[3], Y[3], xi[3], tangent[3], eta[3];

  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    const PetscInt entry = t->closure_offset[t->first[t->dim] + l];
    assert_int_equal(t->closure[entry + n / 2], t->first[t->dim] + l);
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt d = ForestTensorDim[i], e = t->closure[entry + i];
      assert_true(e >= t->first[d] && e < t->first[d + 1]);
      assert_true(t->entity_leaf[e] <= l);
      for (PetscInt a = 0, j = 0; a < t->dim; ++a) {
        const PetscInt s = (i / ForestPow3[a]) % 3;
        xi[a]            = s == 1 ? 0.3 + 0.25 * a : 0.5 * s;
        if (s == 1) tangent[j++] = xi[a];
      }
      ForestOrient(d, t->orientation[entry + i], tangent, eta);
      EntityPoint(forest, e, eta, Y);
      OK(ForestMapPoint(forest, l, xi, X));
      assert_true(Distance(X, Y) < TOLERANCE);
    }
  }
}

/* Closures of edges and faces in their own frames. */
static void CheckSubClosures(Forest forest)
{
  const ForestTables *t = &forest->tables;

  for (PetscInt d = 1; d < t->dim; ++d)
    for (PetscInt e = t->first[d]; e < t->first[d + 1]; ++e) {
      const PetscInt entry = t->closure_offset[e];
      assert_int_equal(t->closure[entry + ForestPow3[d] / 2], e);
      for (PetscInt i = 0; i < ForestPow3[d]; ++i) {
        PetscReal xi[3], tangent[3], eta[3], X[3], Y[3];
        for (PetscInt a = 0, j = 0; a < d; ++a) {
          const PetscInt s = (i / ForestPow3[a]) % 3;
          xi[a]            = s == 1 ? 0.3 + 0.25 * a : 0.5 * s;
          if (s == 1) tangent[j++] = xi[a];
        }
        ForestOrient(ForestTensorDim[i], t->orientation[entry + i], tangent, eta);
        EntityPoint(forest, t->closure[entry + i], eta, Y);
        EntityPoint(forest, e, xi, X);
        assert_true(Distance(X, Y) < TOLERANCE);
      }
    }
}

/* Hanging entities lie where their parents say. Returns their number. */
static PetscInt CheckParents(Forest forest)
{
  const ForestTables *t   = &forest->tables;
  PetscInt            num = 0;

  for (PetscInt d = 0; d < t->dim; ++d)
    for (PetscInt e = t->first[d]; e < t->first[d + 1]; ++e) {
      const PetscInt  parent     = t->parent[e];
      const PetscReal eta[2]     = {0.3, 0.6};
      PetscReal       xi[2]      = {0, 0}, X[3], Y[3];
      PetscInt        parent_dim = 0, chain = 0;
      if (parent < 0) continue;
      ++num;
      while (parent >= t->first[parent_dim + 1]) ++parent_dim;
      for (PetscInt a = 0, j = 0; a < parent_dim; ++a) {
        const int8_t place = t->parent_place[3 * e + a];
        xi[a]              = place == 3 ? 0.5 : place == 2 ? eta[j++] : 0.5 * place + 0.5 * eta[j++];
        assert_true(j <= d);
      }
      EntityPoint(forest, e, eta, X);
      EntityPoint(forest, parent, xi, Y);
      assert_true(Distance(X, Y) < TOLERANCE);
      for (PetscInt p = e; p >= 0; p = t->parent[p]) assert_true(++chain < 60);
    }
  for (PetscInt l = t->first[t->dim]; l < t->num_entities; ++l) assert_int_equal(t->parent[l], -1);
  return num;
}

/* Brute force over the places in the box: whatever lies inside a larger edge or face has a parent, and nothing else has. */
static void CheckComplete(Forest forest, const Box *box)
{
  const ForestTables *t = &forest->tables;
  const PetscInt      n = t->first[t->dim];
  int64_t(*lo)[3], (*hi)[3];

  if (n > 4000) return;
  OK(PetscMalloc2(n, &lo, n, &hi));
  for (PetscInt e = 0; e < n; ++e) {
    const PetscInt  leaf = t->entity_leaf[e], cell = t->leaf_root[leaf];
    const PetscInt *closure = &t->closure[t->closure_offset[t->first[t->dim] + leaf]];
    PetscInt        i       = 0;
    while (closure[i] != e) ++i;
    BoxLeaf(box, t, leaf, lo[e], hi[e]);
    for (PetscInt s = 0; s < t->dim; ++s) {
      const PetscInt a = box->axis[cell][s], place = (i / ForestPow3[s]) % 3;
      if (place == 1) continue;
      if ((place == 2) != box->flip[cell][s])
        lo[e][a] = hi[e][a];
      else
        hi[e][a] = lo[e][a];
    }
  }
  for (PetscInt e = 0; e < n; ++e) {
    PetscBool inside_any = PETSC_FALSE;
    for (PetscInt f = t->first[1]; f < n; ++f) {
      PetscBool inside = PETSC_TRUE, same = PETSC_TRUE;
      for (PetscInt a = 0; a < t->dim && inside; ++a) {
        const PetscBool point = (PetscBool)(lo[e][a] == hi[e][a] && lo[f][a] < hi[f][a]);
        inside                = (PetscBool)(lo[e][a] >= lo[f][a] + point && hi[e][a] <= hi[f][a] - point);
        same                  = (PetscBool)(same && lo[e][a] == lo[f][a] && hi[e][a] == hi[f][a]);
      }
      if (inside && same) assert_int_equal(e, f); /* one id for one place */
      if (inside && !same) inside_any = PETSC_TRUE;
    }
    assert_int_equal(inside_any, t->parent[e] >= 0);
  }
  OK(PetscFree2(lo, hi));
}

/* Every facet is on a side of the box, shared, hanging, or has something hanging in it; marks of the sides on all entities. */
static void CheckFacets(Forest forest, const Box *box)
{
  const ForestTables *t     = &forest->tables;
  const PetscInt      first = t->first[t->dim - 1];
  PetscBool          *is_parent;

  OK(PetscCalloc1(t->num_entities, &is_parent));
  for (PetscInt e = 0; e < t->num_entities; ++e)
    if (t->parent[e] >= 0) is_parent[t->parent[e]] = PETSC_TRUE;
  for (PetscInt f = first; f < t->first[t->dim]; ++f) {
    const PetscInt *leaf = &t->facet_leaf[2 * (f - first)];
    assert_true(leaf[0] >= 0 && leaf[0] == t->entity_leaf[f] && leaf[1] < t->num_leaves && leaf[1] != leaf[0]);
    assert_int_equal(!!t->boundary[f] + (leaf[1] >= 0) + (t->parent[f] >= 0) + is_parent[f], 1);
  }
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    const PetscInt entry = t->closure_offset[t->first[t->dim] + l];
    for (PetscInt i = 0; i < ForestPow3[t->dim]; ++i) {
      int64_t  lo[3], hi[3];
      uint64_t expected = 0;
      BoxLeaf(box, t, l, lo, hi);
      for (PetscInt s = 0; s < t->dim; ++s) {
        const PetscInt cell = t->leaf_root[l], a = box->axis[cell][s], place = (i / ForestPow3[s]) % 3;
        if (place == 1) continue;
        const PetscInt high = (place == 2) != box->flip[cell][s];
        if (!high && lo[a] == 0) expected |= (uint64_t)1 << (2 * a);
        if (high && hi[a] == (int64_t)box->n[a] * FOREST_ONE) expected |= (uint64_t)1 << (2 * a + 1);
      }
      assert_true(t->boundary[t->closure[entry + i]] == expected);
    }
  }
  OK(PetscFree(is_parent));
}

/* Volume of the leaves by Gauss quadrature with 4 points a direction: exact up to geometry order 2. */
static PetscReal Volume(Forest forest)
{
  static const PetscReal point[4]  = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
  static const PetscReal weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
  const ForestTables    *t         = &forest->tables;
  PetscReal              volume    = 0;

  for (PetscInt l = 0; l < t->num_leaves; ++l)
    for (PetscInt q = 0; q < (t->dim == 2 ? 16 : 64); ++q) {
      const PetscInt index[3] = {q & 3, (q >> 2) & 3, q >> 4};
      PetscReal      xi[3], X[3], J[9], scale = 1;
      for (PetscInt a = 0; a < t->dim; ++a) {
        const PetscReal h = 1.0 / (1 << t->leaf_level[3 * l + a]);
        xi[a]             = (PetscReal)t->leaf_lo[3 * l + a] / FOREST_ONE + h * point[index[a]];
        scale *= h * weight[index[a]];
      }
      ForestCoarseMapPoint(&forest->coarse->mesh, t->leaf_root[l], xi, X, J);
      volume += scale * (t->dim == 3 ? Det3(J) : J[0] * J[3] - J[1] * J[2]);
    }
  return volume;
}

/* All pairs of leaves, by their places in the box: independent of keys and tables. */
static void CheckIrregular(const ForestTables *t, const Box *box)
{
  int64_t(*lo)[3], (*hi)[3];

  OK(PetscMalloc2(t->num_leaves, &lo, t->num_leaves, &hi));
  for (PetscInt l = 0; l < t->num_leaves; ++l) BoxLeaf(box, t, l, lo[l], hi[l]);
  for (PetscInt l = 0; l < t->num_leaves; ++l)
    for (PetscInt m = 0; m < l; ++m) {
      PetscInt touch = 0, longer = 0, shorter = 0, ratio = 1;
      for (PetscInt a = 0; a < t->dim; ++a) {
        const int64_t overlap = PetscMin(hi[l][a], hi[m][a]) - PetscMax(lo[l][a], lo[m][a]);
        const int64_t mine = hi[l][a] - lo[l][a], theirs = hi[m][a] - lo[m][a];
        if (overlap < 0) touch = 4;
        if (overlap == 0) ++touch;
        if (overlap <= 0) continue;
        longer += mine > theirs;
        shorter += mine < theirs;
        ratio = PetscMax(ratio, (PetscInt)(PetscMax(mine, theirs) / PetscMin(mine, theirs)));
      }
      assert_true(touch > 0);
      if (touch > t->dim - 1) continue;
      assert_true(ratio <= 2);
      if (touch == 1) assert_false(longer && shorter);
    }
  OK(PetscFree2(lo, hi));
}

static void CheckMap(const ForestTables *new, const ForestTables *old, const ForestMap *map, const Box *box)
{
  assert_int_equal(map->num, new->num_leaves);
  for (PetscInt l = 0; l < map->num; ++l) {
    int64_t   lo[3], hi[3], old_lo[3], old_hi[3];
    PetscReal volume = 0, whole = 1;
    BoxLeaf(box, new, l, lo, hi);
    for (PetscInt a = 0; a < 3; ++a) whole *= (PetscReal)(hi[a] - lo[a]);
    assert_true(map->old_count[l] >= 1);
    for (PetscInt o = map->old_first[l]; o < map->old_first[l] + map->old_count[l]; ++o) {
      PetscReal part = 1;
      BoxLeaf(box, old, o, old_lo, old_hi);
      for (PetscInt a = 0; a < 3; ++a) part *= (PetscReal)(PetscMin(hi[a], old_hi[a]) - PetscMax(lo[a], old_lo[a]));
      assert_true(part > 0);
      volume += part;
    }
    assert_true(PetscAbsReal(volume - whole) < 1e-10 * whole);
  }
}

static void CheckAll(Forest forest, const Box *box)
{
  PetscReal volume = 1;

  for (PetscInt a = 0; a < box->dim; ++a) volume *= box->n[a];
  CheckIrregular(&forest->tables, box);
  CheckLeaves(forest);
  CheckSubClosures(forest);
  CheckFacets(forest, box);
  CheckComplete(forest, box);
  assert_true(PetscAbsReal(Volume(forest) - volume) < 1e-11 * volume);
}

static uint64_t Hash(uint64_t h, const void *data, size_t size)
{
  for (size_t i = 0; i < size; ++i) h = (h ^ ((const unsigned char *)data)[i]) * 1099511628211ULL;
  return h;
}

/* Checksum of everything but the partition. */
static uint64_t Checksum(const ForestTables *t)
{
  const size_t n = (size_t)t->num_entities, l = (size_t)t->num_leaves, size = (size_t)(t->closure_offset[n - 1] + ForestPow3[t->dim]);
  uint64_t     h = 14695981039346656037ULL;

  h = Hash(h, t->first, sizeof(PetscInt) * (size_t)(t->dim + 2));
  h = Hash(h, t->leaf_root, sizeof(PetscInt) * l);
  h = Hash(h, t->leaf_lo, sizeof(PetscInt) * 3 * l);
  h = Hash(h, t->leaf_level, 3 * l);
  h = Hash(h, t->closure, sizeof(PetscInt) * size);
  h = Hash(h, t->orientation, size);
  h = Hash(h, t->parent, sizeof(PetscInt) * n);
  h = Hash(h, t->parent_place, 3 * n);
  h = Hash(h, t->boundary, sizeof(uint64_t) * n);
  h = Hash(h, t->entity_leaf, sizeof(PetscInt) * n);
  return Hash(h, t->facet_leaf, sizeof(PetscInt) * 2 * (size_t)(t->first[t->dim] - t->first[t->dim - 1]));
}

static void SameOnAllRanks(uint64_t checksum)
{
  uint64_t first = checksum;

  OK(MPI_Bcast(&first, 1, MPI_UINT64_T, 0, PETSC_COMM_WORLD));
  assert_true(first == checksum);
}

/* One history of random splits and merges on all ranks together and on this rank alone. */
static void RandomHistory(PetscInt dim, const PetscInt n[3], PetscInt q, PetscBool anisotropic, PetscInt passes, PetscInt one_in, uint64_t seed)
{
  Box      box;
  Forest   alone = BoxForest(PETSC_COMM_SELF, dim, n, q, 0, seed, &box), all = BoxForest(PETSC_COMM_WORLD, dim, n, q, 0, seed, &box), next;
  PetscInt hanging = 0;

  for (PetscInt pass = 0; pass < passes; ++pass) {
    ForestMap map;
    MarkList  marks;
    BoxRandomMarks(dim, alone->tables.num_leaves, one_in, anisotropic, &marks);
    if (pass > 1)
      for (PetscInt l = 0; l < alone->tables.num_leaves; ++l) marks.coarsen[l] = (int8_t)(BoxRandom(8) > 0);
    OK(ForestAdapt(alone, &marks, NULL, 0, NULL, &next, &map));
    CheckMap(&next->tables, &alone->tables, &map, &box);
    for (PetscInt l = 0; l < alone->tables.num_leaves; ++l)
      if (marks.split[l])
        for (PetscInt k = 0; k < map.num; ++k) /* a marked leaf does not survive */
          if (map.old_first[k] == l && map.old_count[k] == 1) assert_memory_not_equal(&alone->tables.leaf_level[3 * l], &next->tables.leaf_level[3 * k], 3);
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&alone));
    alone = next;
    OK(ForestAdapt(all, &marks, NULL, 0, NULL, &next, &map));
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&all));
    all = next;
    MarksDestroy(&marks);
    CheckAll(alone, &box);
    hanging = CheckParents(alone);
    assert_true(Checksum(&alone->tables) == Checksum(&all->tables));
    SameOnAllRanks(Checksum(&all->tables));
    for (PetscInt l = 0; l < all->tables.num_leaves; ++l) assert_in_range(all->tables.leaf_rank[l], 0, 63);
  }
  assert_true(hanging > 0);
  if (PetscGlobalRank == 0)
    print_message("  %d-D q=%d %s: %d leaves, %d hanging\n", (int)dim, (int)q, anisotropic ? "anisotropic" : "isotropic", (int)alone->tables.num_leaves,
                  (int)hanging);
  OK(ForestDestroy(&alone));
  OK(ForestDestroy(&all));
}

static void test_random_2d(void **state)
{
  for (uint64_t seed = 0; seed < 6; ++seed) {
    if (!Share((PetscInt)seed, 2)) continue;
    RandomHistory(2, (const PetscInt[3]){3, 2, 1}, 1, PETSC_FALSE, 6, 3, seed);
    RandomHistory(2, (const PetscInt[3]){3, 3, 1}, 2, PETSC_TRUE, 7, 3, seed);
  }
}

static void test_random_3d(void **state)
{
  for (uint64_t seed = 0; seed < 4; ++seed) {
    if (!Share((PetscInt)seed, 2)) continue;
    RandomHistory(3, (const PetscInt[3]){2, 2, 2}, 1, PETSC_FALSE, 4, 9, seed);
    RandomHistory(3, (const PetscInt[3]){2, 1, 2}, 2, PETSC_TRUE, 6, 4, seed);
  }
  RandomHistory(3, (const PetscInt[3]){3, 3, 3}, 1, PETSC_TRUE, 3, 5, 7);
}

/* Splits crosswise several times on either side of a facet, without any other neighbour to mediate. */
static void test_crosswise(void **state)
{
  for (uint64_t seed = 0; seed < 8; ++seed) {
    Box    box;
    Forest forest = BoxForest(PETSC_COMM_SELF, 3, (const PetscInt[3]){2, 1, 1}, 1, 0, seed, &box), next;
    for (PetscInt pass = 0; pass < 3; ++pass) {
      ForestMap           map;
      MarkList            marks;
      const ForestTables *t = &forest->tables;
      BoxRandomMarks(3, t->num_leaves, 1000000, PETSC_FALSE, &marks);
      for (PetscInt l = 0; l < t->num_leaves; ++l)
        for (PetscInt s = 0; s < 3; ++s) /* the left cell along y, the right one along z */
          if (box.axis[t->leaf_root[l]][s] == 1 + t->leaf_root[l]) marks.split[l] = (int8_t)(1 << s);
      OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
      OK(ForestMapDestroy(&map));
      OK(ForestDestroy(&forest));
      MarksDestroy(&marks);
      forest = next;
      CheckAll(forest, &box);
      CheckParents(forest);
    }
    OK(ForestDestroy(&forest));
  }
}

/* Refine at random, then merge as long as anything merges: back to the coarse mesh, whatever order. */
static void CoarsenBack(PetscInt dim, PetscBool anisotropic)
{
  const PetscInt n[3] = {2, 3, 2};
  Box            box;
  Forest         forest = BoxForest(PETSC_COMM_SELF, dim, n, 1, 0, 11, &box), next;
  const uint64_t before = Checksum(&forest->tables);
  ForestMap      map;
  MarkList       marks;

  for (PetscInt pass = 0; pass < 3; ++pass) {
    BoxRandomMarks(dim, forest->tables.num_leaves, 4, anisotropic, &marks);
    OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&forest));
    MarksDestroy(&marks);
    forest = next;
  }
  for (PetscInt pass = 0, last = 0; last != forest->tables.num_leaves; ++pass) {
    last = forest->tables.num_leaves;
    BoxRandomMarks(dim, last, 1000000, PETSC_FALSE, &marks);
    for (PetscInt l = 0; l < last; ++l) marks.coarsen[l] = 1, marks.split[l] = 0;
    OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
    CheckMap(&next->tables, &forest->tables, &map, &box);
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&forest));
    MarksDestroy(&marks);
    forest = next;
    CheckIrregular(&forest->tables, &box);
  }
  assert_true(Checksum(&forest->tables) == before);
  OK(ForestDestroy(&forest));
}

static void test_coarsen_back(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (PetscInt a = 0; a < 2; ++a) CoarsenBack(dim, (PetscBool)a);
}

/* Only whole families merge; a family with a member marked for splitting stays. */
static void test_coarsen_families(void **state)
{
  Box       box;
  Forest    forest = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){4, 1, 1}, 1, 1, 5, &box), next;
  ForestMap map;
  MarkList  marks;

  BoxRandomMarks(2, 16, 1000000, PETSC_FALSE, &marks);
  for (PetscInt l = 0; l < 16; ++l) marks.coarsen[l] = 1, marks.split[l] = 0;
  marks.coarsen[2]  = 0; /* first family incomplete */
  marks.split[5]    = 3; /* second has a split */
  marks.coarsen[11] = 0; /* third incomplete: it separates the second and the fourth */
  OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
  assert_int_equal(next->tables.num_leaves, 4 + 7 + 4 + 1);
  assert_int_equal(next->tables.revision, 1);
  const PetscInt first[16] = {0, 1, 2, 3, 4, 5, 5, 5, 5, 6, 7, 8, 9, 10, 11, 12};
  for (PetscInt l = 0; l < 16; ++l) {
    assert_int_equal(map.old_first[l], first[l]);
    assert_int_equal(map.old_count[l], l == 15 ? 4 : 1);
  }
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(ForestDestroy(&forest));
  OK(ForestDestroy(&next));
}

/* The high corner of a box split as often as can be: low ends and levels take all the bits they have, and every entity is one of its own. */
static void test_deepest(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Box    box;
    Forest forest = BoxForest(PETSC_COMM_SELF, dim, (const PetscInt[3]){1, 1, 1}, 1, 0, 1, &box);
    for (PetscInt pass = 0; pass < FOREST_MAX_LEVEL; ++pass) {
      const PetscInt num = forest->tables.num_leaves;
      Forest         next;
      ForestMap      map;
      MarkList       marks;
      BoxRandomMarks(dim, num, 1000000, PETSC_FALSE, &marks);
      for (PetscInt l = 0; l < num; ++l) marks.coarsen[l] = marks.split[l] = 0;
      marks.split[num - 1] = (int8_t)((1 << dim) - 1);
      OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
      MarksDestroy(&marks);
      OK(ForestMapDestroy(&map));
      OK(ForestDestroy(&forest));
      forest = next;
    }
    assert_int_equal(forest->tables.num_leaves, 1 + FOREST_MAX_LEVEL * ((1 << dim) - 1));
    assert_int_equal(forest->tables.leaf_level[3 * (forest->tables.num_leaves - 1)], FOREST_MAX_LEVEL);
    CheckAll(forest, &box);
    OK(ForestDestroy(&forest));
  }
}

/* Two quads with the vertices of an edge in common but different curves between them: told, not glued. */
static void test_torn(void **state)
{
  for (PetscInt torn = 0; torn < 2; ++torn) {
    CoarseMesh     mesh        = {.dim = 2, .num_cells = 2, .num_vertices = 6, .geometry_order = 2};
    const PetscInt vertices[8] = {0, 1, 3, 4, 1, 2, 4, 5};
    Forest         forest      = NULL;
    OK(PetscMalloc1(8, &mesh.cell_vertices));
    OK(PetscArraycpy(mesh.cell_vertices, vertices, 8));
    OK(PetscCalloc1(2, &mesh.cell_body));
    OK(PetscCalloc1(3 * 18, &mesh.cell_geometry));
    for (PetscInt i = 0; i < 18; ++i) {
      mesh.cell_geometry[3 * i]     = i / 9 + 0.5 * (i % 3);
      mesh.cell_geometry[3 * i + 1] = 0.5 * (i % 9 / 3);
    }
    if (torn) mesh.cell_geometry[3 * 5] += 0.01; /* middle of the right edge of the first */
    const PetscErrorCode status = ForestCreateFromCoarse(PETSC_COMM_SELF, &mesh, 0, NULL, NULL, 0, &forest);
    assert_int_equal(status, torn ? MORTISE_ERR_INPUT : 0);
    OK(ForestDestroy(&forest));
  }
}

/* Numbers entity * FOREST_PARTS + part stay in range; one entity more is an input error. */
static void test_size(void **state)
{
  assert_true((PetscInt64)FOREST_ENTITIES * FOREST_PARTS <= PETSC_MAX_INT);
  assert_int_equal(ForestCheckSize(FOREST_ENTITIES), 0);
  assert_int_equal(ForestCheckSize((PetscInt64)FOREST_ENTITIES + 1), MORTISE_ERR_INPUT);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_2d),    cmocka_unit_test(test_random_3d),        cmocka_unit_test(test_crosswise),
                                     cmocka_unit_test(test_coarsen_back), cmocka_unit_test(test_coarsen_families), cmocka_unit_test(test_torn),
                                     cmocka_unit_test(test_size),         cmocka_unit_test(test_deepest)};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ErrorHandlerPush());
  PetscCall(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
