/* Multiplier functions of facets of any order: closed form, partition of unity, biorthogonality, polynomials they reproduce, held nodes, inf-sup numbers. */
#include "contactfixture.h"

#include "functionimpl.h"
#include "latticefixture.h"
#include <petscblaslapack.h>

#define POINTS 10 /* Gauss points along a facet */

/* What a surface's functions do. */
typedef struct {
  PetscReal sum;                          /* largest |sum psi - 1| where there are functions */
  PetscReal exact[MORTISE_MAX_ORDER + 1]; /* largest error of sum q(X_j) psi_j for monomials q of that degree */
  PetscReal off, diagonal;                /* int psi_j chi_k off the diagonal; int psi_j chi_j - int chi_j; of those that carry, over the largest */
  PetscReal least;                        /* least int psi_j / int chi_j */
  PetscInt  num, bare;                    /* true nodes that have a function; facets without functions */
} Findings;

/* Dense int psi_j chi_k, int psi_j psi_k, int chi_j chi_k, int chi_j, int psi_j by nodes of the surface. */
typedef struct {
  PetscInt   n;
  PetscReal *D, *P, *M, *chi, *psi;
} Moments;

static void MomentsDestroy(Moments *m)
{
  free(m->D), free(m->P), free(m->M), free(m->chi), free(m->psi);
}

/* chi of the masters of the facet's nodes at xi: places node[], values[]; returns their number (with repetitions). */
static PetscInt Chi(const ContactSurface *s, PetscInt f, const PetscReal N[], PetscInt node[], PetscReal value[])
{
  PetscInt num = 0;

  for (PetscInt a = 0; a < s->first[f + 1] - s->first[f]; a++) {
    const PetscInt n = s->lattice[s->first[f] + a], hangs = s->hang ? s->hang[n + 1] - s->hang[n] : 0;

    if (!hangs) node[num] = n, value[num++] = N[a];
    for (PetscInt k = 0; k < hangs; k++) node[num] = s->hang_master[s->hang[n] + k], value[num++] = s->hang_weight[s->hang[n] + k] * N[a];
  }
  return num;
}

/* Position and measure at xi. */
static PetscReal Point(const ContactSurface *s, PetscInt f, PetscBool axisymmetric, const PetscReal N[], const PetscReal dN[], PetscReal X[3])
{
  PetscReal t[2][3] = {{0, 0, 0}, {0, 0, s->dim == 2}}, n[3];

  X[0] = X[1] = X[2] = 0;
  for (PetscInt a = 0; a < s->first[f + 1] - s->first[f]; a++)
    for (PetscInt c = 0; c < s->dim; c++) {
      const PetscReal place = s->X[s->dim * s->lattice[s->first[f] + a] + c];

      X[c] += N[a] * place;
      for (PetscInt d = 0; d < s->dim - 1; d++) t[d][c] += dN[(s->dim - 1) * a + d] * place;
    }
  Cross3(t[0], t[1], n);
  return sqrt(Dot3(n, n)) * (axisymmetric ? 2 * PETSC_PI * X[0] : 1);
}

static void PolynomialError(const ContactSurface *s, PetscInt rows, const PetscInt node[], const PetscReal psi[], const PetscReal X[3], Findings *out)
{
  for (PetscInt degree = 0; degree <= MORTISE_MAX_ORDER; degree++)
    for (PetscInt i = 0; i <= (s->dim == 3 ? degree : 0); i++) {
      PetscReal error = -PetscPowRealInt(X[0], degree - i) * PetscPowRealInt(X[1], i);

      for (PetscInt r = 0; r < rows; r++)
        error += psi[r] * PetscPowRealInt(s->X[s->dim * node[r]], degree - i) * PetscPowRealInt(s->X[s->dim * node[r] + 1], i);
      out->exact[degree] = PetscMax(out->exact[degree], fabs(error));
    }
}

static void AddFacet(const ContactSurface *s, const ContactMultiplier *m, PetscInt f, PetscBool axisymmetric, PetscInt points, Findings *out, Moments *mom)
{
  const PetscInt rows = m->row_first[f + 1] - m->row_first[f], num = s->first[f + 1] - s->first[f], *node = m->row_node + m->row_first[f], n = mom->n;
  const Basis1D *b;
  PetscReal     *psi = calloc((size_t)rows + 1, sizeof(PetscReal)), N[LATTICE_NODES], dN[2 * LATTICE_NODES], chi[LATTICE_ROW * LATTICE_NODES];
  PetscInt       place[LATTICE_ROW * LATTICE_NODES];

  CHECK_CALL(Basis1DGet(1, PetscMin(points, 12), &b));
  out->bare += rows == 0;
  for (PetscInt q = 0; q < (s->dim == 2 ? b->num_points : b->num_points * b->num_points); q++) {
    const PetscInt  i = q % b->num_points, k = q / b->num_points;
    const PetscReal xi[2] = {b->points[i], b->points[k]};
    PetscReal       X[3], sum = 0;

    CHECK_CALL(ElementEvaluate(s->dim - 1, s->order[f], xi, N, dN));
    const PetscReal w    = b->weights[i] * (s->dim == 2 ? 1 : b->weights[k]) * Point(s, f, axisymmetric, N, dN, X);
    const PetscInt  chis = Chi(s, f, N, place, chi);
    for (PetscInt r = 0; r < rows; r++) {
      psi[r] = 0;
      for (PetscInt a = 0; a < num; a++) psi[r] += m->T[m->offset[f] + r * num + a] * N[a];
      sum += psi[r];
      mom->psi[node[r]] += w * psi[r];
      for (PetscInt c = 0; c < chis; c++) mom->D[n * node[r] + place[c]] += w * psi[r] * chi[c];
      for (PetscInt c = 0; mom->P && c <= r; c++) mom->P[n * node[r] + node[c]] += w * psi[r] * psi[c];
      for (PetscInt c = 0; mom->P && c < r; c++) mom->P[n * node[c] + node[r]] += w * psi[r] * psi[c];
    }
    for (PetscInt c = 0; c < chis; c++) mom->chi[place[c]] += w * chi[c];
    for (PetscInt c = 0; mom->M && c < chis; c++)
      for (PetscInt d = 0; d < chis; d++) mom->M[n * place[c] + place[d]] += w * chi[c] * chi[d];
    if (!rows) continue;
    out->sum = PetscMax(out->sum, fabs(sum - 1));
    PolynomialError(s, rows, node, psi, X, out);
  }
  free(psi);
}

static void MomentsCreate(const ContactSurface *s, const ContactMultiplier *m, PetscBool axisymmetric, PetscInt points, PetscBool norms, Findings *out,
                          Moments *mom)
{
  const size_t n = (size_t)s->num_nodes;

  memset(out, 0, sizeof(*out));
  *mom = (Moments){.n = s->num_nodes, .D = calloc(n * n, 8), .chi = calloc(n, 8), .psi = calloc(n, 8)};
  if (norms) mom->P = calloc(n * n, 8), mom->M = calloc(n * n, 8);
  for (PetscInt f = 0; f < s->num_facets; f++) AddFacet(s, m, f, axisymmetric, points, out, mom);
}

/* has[j]: node j has a function. */
static PetscBool *HasFunction(const ContactSurface *s, const ContactMultiplier *m)
{
  PetscBool *has = calloc((size_t)s->num_nodes, sizeof(PetscBool));

  for (PetscInt r = 0; r < m->row_first[m->num_facets]; r++) has[m->row_node[r]] = PETSC_TRUE;
  return has;
}

/* except[j] (NULL: none): rows and columns that need not be diagonal. */
static Findings Find(const ContactSurface *s, PetscBool axisymmetric, PetscBool standard, const PetscBool carries[], const PetscBool except[], PetscInt points)
{
  ContactMultiplier *m;
  Findings           out;
  Moments            mom;
  PetscReal          most = 0;

  CHECK_CALL(ContactMultiplierCreate(s, axisymmetric, standard, carries, NULL, &m));
  MomentsCreate(s, m, axisymmetric, points, PETSC_FALSE, &out, &mom);
  PetscBool *has = HasFunction(s, m);
  out.least      = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < s->num_nodes; j++) {
    if (!has[j]) continue;
    assert_true(!carries || carries[j]);
    out.num++;
    most      = PetscMax(most, fabs(mom.chi[j]));
    out.least = PetscMin(out.least, mom.psi[j] / mom.chi[j]);
    if (except && except[j]) continue;
    out.diagonal = PetscMax(out.diagonal, fabs(mom.D[s->num_nodes * j + j] - mom.chi[j]));
    for (PetscInt k = 0; k < s->num_nodes; k++)
      if (k != j && has[k] && !(except && except[k])) out.off = PetscMax(out.off, fabs(mom.D[s->num_nodes * j + k]));
  }
  out.off /= most;
  out.diagonal /= most;
  free(has);
  MomentsDestroy(&mom);
  CHECK_CALL(ContactMultiplierDestroy(&m));
  assert_null(m);
  return out;
}

/* Everything a dual basis of order p must do, by integrals with so many points; degree: of the polynomials it reproduces. */
static void CheckDual(const ContactSurface *s, PetscBool axisymmetric, const PetscBool carries[], PetscInt degree, PetscInt points, PetscReal tolerance)
{
  const Findings f = Find(s, axisymmetric, PETSC_FALSE, carries, NULL, points);

  assert_near(f.sum, 0, tolerance);
  assert_near(f.off, 0, tolerance);
  assert_near(f.diagonal, 0, tolerance);
  assert_true(f.least > (carries ? 0.99 * CONTACT_SLIVER : 0.999));
  for (PetscInt d = 0; d <= degree; d++) assert_near(f.exact[d], 0, tolerance);
}

/* ---- closed form ------------------------------------------------------------------------------------------------------- */

/* phi_j + L_p / (p L_p(xi_j)) at xi of [0, 1]. */
static void Closed(PetscInt p, PetscReal xi, PetscReal psi[])
{
  const PetscReal *node;
  PetscReal        L[MORTISE_MAX_ORDER + 1], Lj[MORTISE_MAX_ORDER + 1];

  CHECK_CALL(ElementGetNodes(p, &node));
  CHECK_CALL(ElementEvaluate1D(p, xi, psi, NULL));
  CHECK_CALL(ElementLegendre(p, xi, L, NULL));
  for (PetscInt j = 0; j <= p; j++) {
    CHECK_CALL(ElementLegendre(p, node[j], Lj, NULL));
    psi[j] += L[p] / ((PetscReal)p * Lj[p]);
  }
}

/* Of D^-1/2 M D^-1/2, whose inverse is D^-1/2 T D^1/2. */
static PetscReal Condition(const ContactSurface *s, const PetscReal T[])
{
  PetscBLASInt n = (PetscBLASInt)s->num_nodes, length = 8 * LATTICE_NODES, error;
  PetscReal   *M = calloc((size_t)(n * n), 8), D[LATTICE_NODES], value[LATTICE_NODES], work[8 * LATTICE_NODES];
  FacetLattice l;

  ContactFacetLattice(s, 0, &l);
  CHECK_CALL(ContactLatticeMass(s, &l, PETSC_FALSE, M, D));
  for (PetscBLASInt i = 0; i < n; i++)
    for (PetscBLASInt k = 0; k < n; k++) M[n * i + k] = T[n * i + k] * sqrt(D[k] / D[i]);
  LAPACKsyev_("N", "L", &n, M, &n, value, work, &length, &error);
  assert_int_equal(error, 0);
  free(M);
  return value[n - 1] / value[0];
}

static void ClosedFormOf(PetscInt dim, PetscInt p)
{
  const PetscInt     n = p + 1, samples = 41, num = dim == 2 ? n : n * n;
  LatticeSurface     l;
  LatticeCells       c;
  ContactMultiplier *m;
  PetscReal          N[LATTICE_NODES], psi[2][MORTISE_MAX_ORDER + 1], sup = 0;

  LatticeGrid(&c, 1, 0, p);
  if (dim == 2)
    LatticeChain(&l, 1, (PetscReal[]){0.3, 1.7}, &p);
  else
    LatticeSquare(&l, &c, LatticeFlat);
  CHECK_CALL(ContactMultiplierCreate(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, NULL, &m));
  assert_int_equal(m->row_first[1], num);
  for (PetscInt q = 0; q < (dim == 2 ? samples : samples * samples); q++) {
    const PetscReal xi[2] = {(PetscReal)(q % samples) / (PetscReal)(samples - 1), (PetscReal)(q / samples) / (PetscReal)(samples - 1)};

    CHECK_CALL(ElementEvaluate(dim - 1, p, xi, N, NULL));
    for (int d = 0; d < 2; d++) Closed(p, xi[d], psi[d]);
    for (PetscInt j = 0; j < num; j++) {
      PetscReal value = 0;

      assert_int_equal(m->row_node[j], l.lattice[j]);
      for (PetscInt a = 0; a < num; a++) value += m->T[num * j + a] * N[a];
      assert_near(value, psi[0][j % n] * (dim == 2 ? 1 : psi[1][j / n]), 1e-12);
      sup = PetscMax(sup, fabs(value));
    }
  }
  assert_near(sup, pow(1 + 1 / (PetscReal)p, dim - 1), 1e-12); /* at the ends, which are among the samples */
  assert_near(Condition(&l.s, m->T), pow(2 + 1 / (PetscReal)p, dim - 1), 1e-11);
  CHECK_CALL(ContactMultiplierDestroy(&m));
  LatticeDestroy(&l);
}

static void ClosedForm(void **state)
{
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
    ClosedFormOf(2, p);
    ClosedFormOf(3, p);
  }
}

/* A surface without lattices is one of order 1. */
static void WithoutLattice(void **state)
{
  LatticeSurface     l;
  LatticeCells       c;
  ContactMultiplier *m[2];

  LatticeGrid(&c, 3, 1, 1);
  LatticeRefine(&c, 4);
  LatticeSquare(&l, &c, LatticeFlat);
  ContactSurface plain = l.s;
  plain.order = NULL, plain.first = NULL, plain.lattice = NULL;
  CHECK_CALL(ContactMultiplierCreate(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, NULL, &m[0]));
  CHECK_CALL(ContactMultiplierCreate(&plain, PETSC_FALSE, PETSC_FALSE, NULL, NULL, &m[1]));
  assert_int_equal(m[0]->row_first[l.s.num_facets], m[1]->row_first[l.s.num_facets]);
  for (PetscInt r = 0; r < m[0]->row_first[l.s.num_facets]; r++) {
    assert_int_equal(m[0]->row_node[r], m[1]->row_node[r]);
    for (int a = 0; a < 4; a++) assert_near(m[0]->T[4 * r + a], m[1]->T[4 * r + a], 0);
  }
  for (int k = 0; k < 2; k++) CHECK_CALL(ContactMultiplierDestroy(&m[k]));
  LatticeDestroy(&l);
}

/* ---- curves ------------------------------------------------------------------------------------------------------------ */

static void Curves(void **state)
{
  const PetscReal x[] = {0, 0.2, 0.9, 1.0, 1.7, 2.0};

  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++)
    for (int mixed = 0; mixed < 2; mixed++) {
      const PetscInt order[] = {p, mixed ? PetscMin(p + 1, MORTISE_MAX_ORDER) : p, mixed ? MORTISE_MAX_ORDER : p, p, p};
      LatticeSurface l;

      LatticeChain(&l, 5, x, order);
      PetscBool *carries = calloc((size_t)l.s.num_nodes, sizeof(PetscBool));
      CheckDual(&l.s, PETSC_FALSE, NULL, p - 1, POINTS, 1e-11);
      CheckDual(&l.s, PETSC_TRUE, NULL, 0, POINTS, 1e-11);
      for (PetscInt n = 0; n < l.s.num_nodes; n++) carries[n] = (PetscBool)(n != l.facets[0] && n != l.facets[9]);
      CheckDual(&l.s, PETSC_FALSE, carries, p - 1, POINTS, 1e-11);
      CheckDual(&l.s, PETSC_TRUE, carries, 0, POINTS, 1e-11);
      const Findings f = Find(&l.s, PETSC_FALSE, PETSC_TRUE, carries, NULL, POINTS);
      assert_near(f.sum, 0, 1e-12);
      for (PetscInt d = 0; d < p; d++) assert_near(f.exact[d], 0, 1e-11);
      assert_true(p > 4 || f.exact[p] > 1e-6);
      free(carries);
      LatticeDestroy(&l);
    }
}

/* From order 2 on int chi_j R dR of the node on the axis vanishes: it has no function, its neighbours' still sum to 1. */
static void Axis(void **state)
{
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++)
    for (int standard = 0; standard < 2; standard++) {
      const PetscInt order[2] = {p, p};
      LatticeSurface l;

      LatticeChain(&l, 2, (PetscReal[]){0, 0.5, 1}, order);
      const Findings f = Find(&l.s, PETSC_TRUE, (PetscBool)standard, NULL, NULL, POINTS);
      assert_int_equal(f.num, p == 1 ? 3 : 2 * p);
      assert_near(f.sum, 0, 1e-11);
      assert_true(f.least > 0.99 * CONTACT_SLIVER);
      if (!standard) assert_near(f.off, 0, 1e-11);
      LatticeDestroy(&l);
    }
}

/* psi_j + l_j(end) psi_end with l_j of the nodes other than the end. Both ends of a single edge held: the degree is lowered until all weights are positive. */
static void HeldEnd(void **state)
{
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
    const PetscInt     order[2] = {p, p};
    LatticeSurface     l;
    ContactMultiplier *m;
    PetscBool          carries[2 * MORTISE_MAX_ORDER + 1];
    const PetscReal   *point;
    PetscReal          psi[MORTISE_MAX_ORDER + 1], N[MORTISE_MAX_ORDER + 1];

    LatticeChain(&l, 2, (PetscReal[]){0, 1, 2}, order);
    CHECK_CALL(ElementGetNodes(p, &point));
    for (PetscInt n = 0; n < l.s.num_nodes; n++) carries[n] = (PetscBool)(n > 0);
    CHECK_CALL(ContactMultiplierCreate(&l.s, PETSC_FALSE, PETSC_FALSE, carries, NULL, &m));
    assert_int_equal(m->row_first[1], p);
    for (int q = 0; q <= 10; q++) {
      Closed(p, q / 10., psi);
      CHECK_CALL(ElementEvaluate1D(p, q / 10., N, NULL));
      for (PetscInt j = 1; j <= p; j++) {
        PetscReal weight = 1, value = 0;

        for (PetscInt k = 1; k <= p; k++)
          if (k != j) weight *= point[k] / (point[k] - point[j]);
        for (PetscInt a = 0; a <= p; a++) value += m->T[(p + 1) * (j - 1) + a] * N[a];
        assert_near(value, psi[j] + weight * psi[0], 1e-11);
      }
    }
    CHECK_CALL(ContactMultiplierDestroy(&m));
    LatticeDestroy(&l);
    LatticeChain(&l, 1, (PetscReal[]){0, 1}, &p);
    for (int both = 0; both < 2; both++) {
      for (PetscInt n = 0; n <= p; n++) carries[n] = (PetscBool)(n > 0 && (n < p || !both));
      const Findings f = Find(&l.s, PETSC_FALSE, PETSC_FALSE, carries, NULL, POINTS);
      assert_int_equal(f.num, p - both);
      assert_int_equal(f.bare, p == 1 && both);
      if (f.num == 0) continue;
      assert_near(f.sum, 0, 1e-12);
      assert_near(f.off, 0, 1e-12);
      assert_true(f.least > 0.99 * CONTACT_SLIVER);
    }
    LatticeDestroy(&l);
  }
}

/* ---- hanging nodes ----------------------------------------------------------------------------------------------------- */

/* Cells of a 5 x 5 grid refined that share no edge. */
static void Isolated(LatticeCells *c, PetscInt order)
{
  LatticeGrid(c, 5, 1, order);
  LatticeRefine(c, 6);
  LatticeRefine(c, 18);
  LatticeRefine(c, 10);
}

/* Refined four times at random places, and towards a corner: five levels, sizes of neighbours differ by 2 at most. */
static void Graded(LatticeCells *c, PetscInt order, uint64_t seed)
{
  uint64_t rng = seed;

  LatticeGrid(c, 2, 4, order);
  for (int k = 0; k < 4; k++) LatticeRefine(c, LatticeFind(c, 1e-3, 1e-3));
  for (int k = 0; k < 6; k++) {
    rng = rng * 6364136223846793005u + 1442695040888963407u;

    const PetscInt cell = (PetscInt)((rng >> 33) % (uint64_t)c->num);
    if (c->cell[cell].size > 1) LatticeRefine(c, cell);
  }
}

static void Hanging(void **state)
{
  LatticeSurface l;
  LatticeCells   c;

  for (PetscInt p = 1; p <= 6; p++) {
    Isolated(&c, p);
    LatticeSquare(&l, &c, LatticeFlat);
    CheckDual(&l.s, PETSC_FALSE, NULL, p - 1, POINTS, 1e-10);
    LatticeDestroy(&l);
  }
  for (PetscInt p = 1; p <= 3; p++)
    for (uint64_t seed = 1; seed <= 3; seed++) {
      Graded(&c, p, seed);
      LatticeSquare(&l, &c, LatticeFlat);
      CheckDual(&l.s, PETSC_FALSE, NULL, p - 1, POINTS, 1e-10);
      const Findings f = Find(&l.s, PETSC_FALSE, PETSC_TRUE, NULL, NULL, POINTS);
      assert_near(f.sum, 0, 1e-12);
      for (PetscInt d = 0; d <= p; d++) assert_near(f.exact[d], 0, 1e-11);
      LatticeDestroy(&l);
    }
}

static void Curved(const PetscReal at[2], PetscReal X[3])
{
  X[0] = at[0] + 0.1 * at[1] * at[1], X[1] = at[1] - 0.2 * at[0] * at[1], X[2] = 0.3 * at[0] * at[0];
}

/* On curved facets constants and the diagonal survive. */
static void CurvedFacets(void **state)
{
  LatticeSurface l;
  LatticeCells   c;

  for (PetscInt p = 1; p <= 4; p++) {
    Isolated(&c, p);
    LatticeSquare(&l, &c, Curved);
    const Findings f = Find(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, NULL, p + 4); /* the points of the construction */
    assert_near(f.sum, 0, 1e-11);
    assert_near(f.off, 0, 1e-11);
    assert_near(f.diagonal, 0, 1e-11);
    assert_true(f.least > 0.999 && f.exact[1] > 1e-6);
    LatticeDestroy(&l);
  }
}

/* Different orders side by side, nothing hangs on a coarser edge: the constrained basis has a dual of its own. */
static void MixedOrders(void **state)
{
  LatticeSurface l;
  LatticeCells   c;

  for (PetscInt least = 1; least <= 3; least++) {
    LatticeGrid(&c, 4, 0, least);
    for (PetscInt k = 0; k < c.num; k++) c.cell[k].order = least + k * 7 % 3;
    LatticeSquare(&l, &c, LatticeFlat);
    assert_true(l.hang[l.s.num_nodes] > 0);
    CheckDual(&l.s, PETSC_FALSE, NULL, least - 1, POINTS, 1e-11);
    LatticeDestroy(&l);
  }
}

/* Fine facets of different orders on one coarse edge, or half of them missing: P^T psi there, exact; the rest stays diagonal. */
static void Lattices(void **state)
{
  LatticeSurface l;
  LatticeCells   c;

  for (int missing = 0; missing < 2; missing++) {
    Isolated(&c, 2);
    for (PetscInt k = 0; k < c.num; k++)
      if (!missing && k == LatticeFind(&c, 0.21, 0.21)) c.cell[k].order = 3;
    if (missing) c.cell[LatticeFind(&c, 0.21, 0.21)] = c.cell[c.num - 1], c.num--;
    LatticeSquare(&l, &c, LatticeFlat);
    PetscBool *except = calloc((size_t)l.s.num_nodes, sizeof(PetscBool));
    for (PetscInt k = 0; k < c.num; k++) {
      const PetscBool inside = (PetscBool)(c.cell[k].size == 1 && c.cell[k].x < 4 && c.cell[k].y < 4);

      for (PetscInt i = l.first[k]; inside && i < l.first[k + 1]; i++) {
        const PetscInt n = l.lattice[i];

        except[n] = PETSC_TRUE;
        for (PetscInt h = l.hang[n]; h < l.hang[n + 1]; h++) except[l.master[h]] = PETSC_TRUE;
      }
    }
    const Findings f = Find(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, except, POINTS), all = Find(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, NULL, POINTS);
    for (PetscInt d = 0; d <= 1; d++) assert_near(f.exact[d], 0, 1e-12);
    assert_near(f.sum, 0, 1e-12);
    assert_near(f.off, 0, 1e-12);
    assert_near(f.diagonal, 0, 1e-12);
    assert_true(all.off > 1e-3); /* what was left out is not diagonal */
    free(except);
    LatticeDestroy(&l);
  }
}

/* ---- held nodes in space ------------------------------------------------------------------------------------------------ */

/* Sides of the square: 1 x = 0, 2 y = 0, 4 x = 1; 8: its corner at the origin only. */
static PetscBool *Held(const LatticeSurface *l, int sides)
{
  PetscBool *carries = calloc((size_t)l->s.num_nodes, sizeof(PetscBool));

  for (PetscInt n = 0; n < l->s.num_nodes; n++) {
    const PetscReal *X = l->X + 3 * n;

    carries[n] =
        (PetscBool) !(((sides & 1) && X[0] < 1e-9) || ((sides & 2) && X[1] < 1e-9) || ((sides & 4) && X[0] > 1 - 1e-9) || ((sides & 8) && X[0] + X[1] < 1e-9));
  }
  return carries;
}

/* Facets are flat here: p + 1 points are exact. */
static void HeldSides(void **state)
{
  static const int sides[] = {1, 3, 7, 8};
  LatticeSurface   l;
  LatticeCells     c;

  for (PetscInt p = 1; p <= 5; p++)
    for (int kind = 0; kind < 3; kind++)
      for (int k = 0; k < 4; k++) {
        if (kind == 0) LatticeGrid(&c, 3, 1, p);
        if (kind == 1) Isolated(&c, p); /* one of the refined cells lies at the side x = 0 */
        if (kind == 2) LatticeGrid(&c, 3, 1, p), LatticeRefine(&c, 0);
        LatticeSquare(&l, &c, LatticeFlat);
        PetscBool *carries = Held(&l, sides[k]);
        CheckDual(&l.s, PETSC_FALSE, carries, p - 1, p + 1, 1e-9);
        const Findings f = Find(&l.s, PETSC_FALSE, PETSC_TRUE, carries, NULL, p + 1);
        assert_near(f.sum, 0, 1e-11);
        for (PetscInt d = 0; d < p; d++) assert_near(f.exact[d], 0, 1e-9);
        free(carries);
        LatticeDestroy(&l);
      }
}

/* On one facet: the functions of a held side go along the other direction, those of a corner of two held sides by products; T of the facet against them. */
static void HeldProducts(void **state)
{
  for (PetscInt p = 1; p <= 5; p++) {
    const PetscInt     n = p + 1, num = n * n;
    LatticeSurface     l;
    LatticeCells       c;
    ContactMultiplier *m;
    const PetscReal   *point;
    PetscReal          one[2][MORTISE_MAX_ORDER + 1][MORTISE_MAX_ORDER + 1], N[LATTICE_NODES], psi[2][MORTISE_MAX_ORDER + 1];

    LatticeGrid(&c, 2, 0, p);
    LatticeSquare(&l, &c, LatticeFlat);
    CHECK_CALL(ElementGetNodes(p, &point));
    for (PetscInt j = 1; j <= p; j++) {
      one[0][0][j] = 1; /* weight of the first node's function in that of node j */
      for (PetscInt k = 1; k <= p; k++)
        if (k != j) one[0][0][j] *= point[k] / (point[k] - point[j]);
    }
    PetscBool *carries = Held(&l, 3);
    CHECK_CALL(ContactMultiplierCreate(&l.s, PETSC_FALSE, PETSC_FALSE, carries, NULL, &m));
    assert_int_equal(m->row_first[1], p * p);
    for (int q = 0; q < 36; q++) {
      const PetscReal xi[2] = {q % 6 / 5., q / 6 / 5.};

      CHECK_CALL(ElementEvaluate(2, p, xi, N, NULL));
      for (int d = 0; d < 2; d++) Closed(p, xi[d], psi[d]);
      for (PetscInt r = 0; r < p * p; r++) {
        const PetscInt i = 1 + r % p, k = 1 + r / p;
        PetscReal      value = 0;

        assert_int_equal(m->row_node[r], l.lattice[n * k + i]);
        for (PetscInt a = 0; a < num; a++) value += m->T[num * r + a] * N[a];
        assert_near(value, (psi[0][i] + one[0][0][i] * psi[0][0]) * (psi[1][k] + one[0][0][k] * psi[1][0]), 1e-10);
      }
    }
    CHECK_CALL(ContactMultiplierDestroy(&m));
    free(carries);
    LatticeDestroy(&l);
  }
}

/* Any set of nodes may be held: sum 1 wherever there are functions, positive weights, diagonal. */
static void HeldAnyhow(void **state)
{
  uint64_t rng = 5;

  for (int trial = 0; trial < 60; trial++) {
    const PetscInt p = 1 + trial % 4;
    LatticeSurface l;
    LatticeCells   c;

    if (trial % 3 == 0) LatticeGrid(&c, 2, 1, p);
    if (trial % 3 == 1) Isolated(&c, p);
    if (trial % 3 == 2) LatticeGrid(&c, 2, 1, p), LatticeRefine(&c, 3);
    LatticeSquare(&l, &c, LatticeFlat);
    PetscBool *carries = calloc((size_t)l.s.num_nodes, sizeof(PetscBool));
    for (PetscInt n = 0; n < l.s.num_nodes; n++) {
      rng        = rng * 6364136223846793005u + 1442695040888963407u;
      carries[n] = (PetscBool)((rng >> 33) % 10 >= (uint64_t)(1 + trial % 9));
    }
    const Findings f = Find(&l.s, PETSC_FALSE, PETSC_FALSE, carries, NULL, p + 1);
    assert_near(f.sum, 0, 1e-10);
    assert_near(f.off, 0, 1e-9);
    assert_true(f.num == 0 || f.least > 0);
    free(carries);
    LatticeDestroy(&l);
  }
}

/* ---- inf-sup ------------------------------------------------------------------------------------------------------------ */

/* Least of int lambda u / (|lambda| |u|), L2 norms, lambda of the functions, u of the true basis: beta^2 = least eigenvalue of D M^-1 D^T by P. */
static PetscReal InfSup(const ContactSurface *s, const ContactMultiplier *m)
{
  Findings     f;
  Moments      mom;
  PetscBLASInt n = 0, one = 1, error, length;

  MomentsCreate(s, m, PETSC_FALSE, POINTS, PETSC_TRUE, &f, &mom);
  PetscBool *has  = HasFunction(s, m);
  PetscInt  *list = calloc((size_t)s->num_nodes, sizeof(PetscInt));
  for (PetscInt j = 0; j < s->num_nodes; j++)
    if (has[j]) list[n++] = j;
  for (PetscBLASInt i = 0; i < n; i++)
    for (PetscBLASInt k = 0; k < n; k++) {
      mom.D[n * i + k] = mom.D[s->num_nodes * list[i] + list[k]]; /* the places written are not read again */
      mom.M[n * i + k] = mom.M[s->num_nodes * list[i] + list[k]];
      mom.P[n * i + k] = mom.P[s->num_nodes * list[i] + list[k]];
    }
  length           = 40 * n;
  PetscReal *value = calloc((size_t)n, 8), *work = calloc((size_t)length, 8), *S = calloc((size_t)(n * n), 8), unit = 1, zero = 0;
  LAPACKpotrf_("L", &n, mom.M, &n, &error);
  assert_int_equal(error, 0);
  BLAStrsm_("L", "L", "N", "N", &n, &n, &unit, mom.M, &n, mom.D, &n); /* columns of mom.D: rows of D */
  BLASgemm_("T", "N", &n, &n, &n, &unit, mom.D, &n, mom.D, &n, &zero, S, &n);
  LAPACKsygv_(&one, "N", "L", &n, S, &n, mom.P, &n, value, work, &length, &error);
  assert_int_equal(error, 0);
  const PetscReal beta = sqrt(value[0]);
  free(has), free(list), free(value), free(work), free(S);
  MomentsDestroy(&mom);
  return beta;
}

/* P^T psi_L everywhere: rows of the lattice's own duals summed by masters. */
static void LatticeMultiplier(const ContactSurface *s, ContactMultiplier *base)
{
  ContactSurface     loose = *s;
  ContactMultiplier *loosened;
  PetscInt           rows = 0, size = 0;

  loose.hang = NULL;
  CHECK_CALL(ContactMultiplierCreate(&loose, PETSC_FALSE, PETSC_FALSE, NULL, NULL, &loosened));
  *base           = (ContactMultiplier){.num_facets = s->num_facets};
  base->row_first = calloc((size_t)s->num_facets + 1, sizeof(PetscInt));
  base->offset    = calloc((size_t)s->num_facets, sizeof(PetscInt));
  base->row_node  = calloc((size_t)(s->num_facets * LATTICE_NODES * 2), sizeof(PetscInt));
  base->T         = calloc((size_t)(s->num_facets * LATTICE_NODES * 2 * LATTICE_NODES), sizeof(PetscReal));
  for (PetscInt f = 0; f < s->num_facets; f++) {
    const PetscInt num = s->first[f + 1] - s->first[f];

    base->row_first[f] = rows;
    base->offset[f]    = size;
    for (PetscInt a = 0; a < num; a++) {
      const PetscInt n = s->lattice[s->first[f] + a], hangs = s->hang[n + 1] - s->hang[n];

      for (PetscInt k = 0; k < PetscMax(1, hangs); k++) {
        const PetscInt  to     = hangs ? s->hang_master[s->hang[n] + k] : n;
        const PetscReal weight = hangs ? s->hang_weight[s->hang[n] + k] : 1;
        PetscInt        r      = base->row_first[f];

        while (r < rows && base->row_node[r] != to) r++;
        if (r == rows) base->row_node[rows++] = to;
        for (PetscInt b = 0; b < num; b++) base->T[size + (r - base->row_first[f]) * num + b] += weight * loosened->T[loosened->offset[f] + num * a + b];
      }
    }
    size += (rows - base->row_first[f]) * num;
  }
  base->row_first[s->num_facets] = rows;
  CHECK_CALL(ContactMultiplierDestroy(&loosened));
}

/* Every second cell of 4 x 4 refined, none of which share an edge; all nodes free. */
static void InfSupNumbers(void **state)
{
  static const PetscReal macro[] = {0.78, 0.84, 0.87, 0.89}, lattice[] = {0.70, 0.77, 0.81, 0.83};

  for (PetscInt p = 1; p <= 4; p++) {
    LatticeSurface     l;
    LatticeCells       c;
    ContactMultiplier *m, other;

    LatticeGrid(&c, 4, 1, p);
    for (PetscInt k = 0; k < 16; k++)
      if ((k % 4 + k / 4) % 2 == 0) LatticeRefine(&c, k);
    LatticeSquare(&l, &c, LatticeFlat);
    LatticeMultiplier(&l.s, &other);
    CHECK_CALL(ContactMultiplierCreate(&l.s, PETSC_FALSE, PETSC_FALSE, NULL, NULL, &m));
    const PetscReal beta[2] = {InfSup(&l.s, m), InfSup(&l.s, &other)};
    print_message("inf-sup, order %d: macro %.3f, P^T psi %.3f\n", (int)p, (double)beta[0], (double)beta[1]);
    assert_near(beta[0], macro[p - 1], 0.0051);
    assert_near(beta[1], lattice[p - 1], 0.0051);
    free(other.row_first), free(other.offset), free(other.row_node), free(other.T);
    CHECK_CALL(ContactMultiplierDestroy(&m));
    LatticeDestroy(&l);
  }
}

CONTACT_TEST_MAIN("contact: multiplier functions of any order", cmocka_unit_test(ClosedForm), cmocka_unit_test(WithoutLattice), cmocka_unit_test(Curves),
                  cmocka_unit_test(Axis), cmocka_unit_test(HeldEnd), cmocka_unit_test(Hanging), cmocka_unit_test(CurvedFacets), cmocka_unit_test(MixedOrders),
                  cmocka_unit_test(Lattices), cmocka_unit_test(HeldSides), cmocka_unit_test(HeldProducts), cmocka_unit_test(HeldAnyhow),
                  cmocka_unit_test(InfSupNumbers))
