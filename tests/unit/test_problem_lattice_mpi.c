/* Contact surfaces with facets of higher order, as lattices of nodes. On random meshes with hanging nodes, random orders 1..4, random axes and curved sides:
   - nodes with unknowns are the nodes of the space on the surface, each once, with the same dofs;
   - a facet's polynomial is the trace of the cell behind it: positions, and any field, hanging nodes filled by their rows;
   - the shares of the nodes make up the surface's measure and are positive; all of it also where faces are linear. */
#include "interfaceimpl.h"
#include "problemfixture.h"
#include "problemimpl.h"

#define TOP(dim) (2 * (dim)-1)
#define BOTTOM(dim) (2 * (dim)-2)

typedef struct {
  Solved      s;
  ContactSpec contact;
} Case;

/* bend: of the top; sides: contact on facing sides of one box, which never meet. */
static void CaseCreate(Case *c, PetscInt dim, PetscInt low, PetscInt high, PetscBool full, PetscBool anisotropic, uint64_t seed)
{
  const PetscInt n[3] = {2, 2, 1};
  Box            box;

  memset(c, 0, sizeof(*c));
  box_bend         = 0.1;
  c->s.bulk.forest = BoxForest(PETSC_COMM_WORLD, dim, n, 2, 0, seed, &box);
  c->contact       = (ContactSpec){.name = "pair", .nonmortar = TOP(dim), .mortar = BOTTOM(dim), .full = full};
  c->s.scene.mesh  = (ForestSpec){.dim = dim};
  BulkRefine(&c->s.bulk.forest, dim, dim == 2 ? 3 : 2, anisotropic);
  BulkMaterial(&c->s.bulk.material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_DISPLACEMENT, 1, 2);
  BulkInit(&c->s.bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  c->s.scene.num_contacts = 1;
  c->s.scene.contacts     = &c->contact;
  SolvedCreate(&c->s, low, high);
}

/* Something that is no polynomial. */
static PetscReal Field(const PetscReal X[], PetscInt dim)
{
  PetscReal sum = 0.3;

  for (PetscInt a = 0; a < dim; ++a) sum += (17 + 11 * a) * X[a];
  return PetscSinReal(sum);
}

/* ---- nodes ----------------------------------------------------------------------------------------------------------------------- */

static void CheckNodes(const Case *c, const Surface *s, PetscInt group)
{
  const HPTables     *v = c->s.tables;
  const ForestTables *t;
  PetscInt           *count, num[2] = {0, 0};

  t = ForestGetTables(c->s.bulk.forest);
  OK(PetscCalloc1(v->num_nodes, &count));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    const PetscBool hangs = (PetscBool)(s->hang[n] < s->hang[n + 1]);
    if (s->local[n] < 0) continue;
    ++count[s->local[n]];
    assert_int_equal(hangs, v->node_hang[s->local[n]] < v->node_hang[s->local[n] + 1]);
    for (PetscInt d = 0; d < s->dim; ++d) {
      assert_near(s->X[s->dim * n + d], v->X[3 * s->local[n] + d], 1e-13);
      assert_int_equal(s->dof[s->dim * n + d], hangs ? -1 : c->s.problem->row[s->dim * s->local[n] + d]);
    }
    if (s->owned[n]) ++num[0];
  }
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt entity = v->node_entity[n];
    if (!((t->boundary[entity] >> group) & 1) || v->node_hang[n] < v->node_hang[n + 1]) continue;
    assert_int_equal(count[n], 1);
    if (t->leaf_rank[t->entity_leaf[entity]] == c->s.problem->rank) ++num[1];
  }
  assert_int_equal(num[0], num[1]);
  for (PetscInt k = 0; k < s->hang[s->num_nodes]; ++k) assert_int_equal(s->hang[s->hang_master[k]], s->hang[s->hang_master[k] + 1]);
  OK(PetscFree(count));
}

/* ---- traces ---------------------------------------------------------------------------------------------------------------------- */

/* Coordinates in the leaf of corner k of a facet. */
static void CornerInLeaf(const ForestTables *t, const Surface *s, PetscInt facet, PetscInt k, PetscReal xi[3])
{
  const PetscInt *cl = t->closure + t->closure_offset[t->first[t->dim] + s->facet_leaf[facet]];
  PetscInt        i  = 0;

  while (cl[i] != s->node_entity[s->facets[s->corners * facet + k]]) ++i;
  for (PetscInt a = 0; a < t->dim; ++a, i /= 3) xi[a] = (i % 3) / 2;
}

/* Field and positions of a facet and of the cell behind it at a random place; returns the largest difference. */
static PetscReal PlaceError(Case *c, const Surface *s, const PetscReal values[], PetscInt facet, PetscInt cell, const PetscReal local[])
{
  const HPTables     *v = c->s.tables;
  const ForestTables *t;
  const PetscInt      dim = s->dim, *node, num = SurfaceNodes_Private(s, facet, &node), n = ElementNumNodes(dim, v->cell_order[cell]);
  const PetscReal     xi[2]        = {BoxRandom(2001) * 1e-3 - 1, BoxRandom(2001) * 1e-3 - 1};
  PetscReal           corner[3][3] = {{0}}, place[3], N[SURFACE_MOST_NODES], M[125], X[375], u[375], a[6] = {0}, b[6] = {0}, error = 0;

  t = ForestGetTables(c->s.bulk.forest);
  for (PetscInt k = 0; k < dim; ++k) CornerInLeaf(t, s, facet, k == 2 ? 3 : k, corner[k]);
  for (PetscInt d = 0; d < dim; ++d) {
    place[d] = corner[0][d];
    for (PetscInt k = 1; k < dim; ++k) place[d] += 0.5 * (1 + xi[k - 1]) * (corner[k][d] - corner[0][d]);
  }
  SurfaceShape(dim, s->order[facet], xi, N, NULL);
  OK(ElementEvaluate(dim, v->cell_order[cell], place, M, NULL));
  OK(HPSpaceGather(c->s.space, cell, local, u));
  OK(HPSpaceGatherPositions(c->s.space, cell, X));
  for (PetscInt d = 0; d < dim; ++d) {
    for (PetscInt k = 0; k < num; ++k) {
      a[d] += N[k] * s->X[dim * node[k] + d];
      a[3 + d] += N[k] * values[dim * node[k] + d];
    }
    for (PetscInt k = 0; k < n; ++k) {
      b[d] += M[k] * X[dim * k + d];
      b[3 + d] += M[k] * u[dim * k + d];
    }
  }
  for (PetscInt k = 0; k < 6; ++k) error = PetscMax(error, PetscAbsReal(a[k] - b[k]));
  return error;
}

static void CheckTraces(Case *c, const Surface *s)
{
  const HPTables *v = c->s.tables;
  PetscReal      *local, *values;

  OK(PetscMalloc1(v->num_nodes * s->dim, &local));
  OK(PetscMalloc1(s->num_nodes * s->dim, &values));
  for (PetscInt i = 0; i < v->num_nodes * s->dim; ++i) local[i] = Field(v->X + 3 * (i / s->dim), s->dim) + i % s->dim;
  OK(SurfaceGather_Private(c->s.problem->interface, s, local, NULL, values));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
      if (v->cell_leaf[cell] != s->facet_leaf[f]) continue;
      for (PetscInt k = 0; k < 5; ++k) assert_near(PlaceError(c, s, values, f, cell, local), 0, 1e-11);
    }
  }
  OK(PetscFree(local));
  OK(PetscFree(values));
}

/* The nodes' shares: positive, together the measure of the surface by quadrature. */
static void CheckShares(const Contact *c)
{
  const Surface *s   = &c->side[0];
  PetscReal      sum = 0, area = 0, N[SURFACE_MOST_NODES];
  const Basis1D *gauss;

  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (s->hang[n] < s->hang[n + 1]) continue;
    assert_true(c->w0[n] > 0);
    assert_true(c->extent[n] > 0);
    sum += c->w0[n];
  }
  OK(Basis1DGet(1, 8, &gauss));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    for (PetscInt k = 0; k < (s->dim == 2 ? 8 : 64); ++k) {
      const PetscReal xi[2] = {2 * gauss->points[k % 8] - 1, 2 * gauss->points[k / 8] - 1};
      area += 2 * gauss->weights[k % 8] * (s->dim == 2 ? 1 : 2 * gauss->weights[k / 8]) * SurfacePoint_Private(s, f, s->X, xi, PETSC_FALSE, N);
    }
  }
  assert_near(sum / area, 1, 1e-4); /* hanging nodes give their shares whole; quadrature of the measure differs */
}

static void test_lattice(void **state)
{
  PetscInt hanging = 0;

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt seed = 0; seed < (dim == 2 ? 8 : 5); ++seed) {
      Case c;
      CaseCreate(&c, dim, 1 + seed % 2, seed == 2 ? 2 : 4, PETSC_TRUE, (PetscBool)(seed % 2), (uint64_t)seed);
      Contact *contact = &c.s.problem->interface->contacts[0];
      assert_non_null(contact->side[0].order);
      CheckNodes(&c, &contact->side[0], TOP(dim));
      CheckNodes(&c, &contact->side[1], BOTTOM(dim));
      CheckTraces(&c, &contact->side[0]);
      CheckTraces(&c, &contact->side[1]);
      CheckShares(contact);
      hanging += contact->side[0].hang[contact->side[0].num_nodes];
      SolvedDestroy(&c.s);
    }
  }
  assert_true(hanging > 100);
}

/* All facets linear, by the key or by the cells. */
static void test_linear(void **state)
{
  for (PetscInt k = 0; k < 4; ++k) {
    Case c;
    CaseCreate(&c, 2 + k % 2, 1, k < 2 ? 3 : 1, k < 2 ? PETSC_FALSE : PETSC_TRUE, PETSC_FALSE, (uint64_t)k);
    for (PetscInt side = 0; side < 2; ++side) {
      const Surface *s = &c.s.problem->interface->contacts[0].side[side];
      assert_int_equal(s->first[s->num_facets], s->corners * s->num_facets);
      CheckNodes(&c, s, side ? BOTTOM(s->dim) : TOP(s->dim));
      CheckTraces(&c, s);
    }
    SolvedDestroy(&c.s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lattice), cmocka_unit_test(test_linear)};

  if (PetscInitialize(&argc, &argv, NULL, NULL) || StageRegister()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
