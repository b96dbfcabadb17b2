/* Surfaces of quadrilaterals for the three-dimensional contact tests: grids over [0, 1]^2, nonmortar facing up, mortar facing down. */
#pragma once
#include "contact.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "near.h"

#define CHECK_CALL(...) assert_int_equal((int)(__VA_ARGS__), 0)

typedef struct {
  ContactSurface s;
  PetscInt      *facets;
  PetscReal     *x;
} Sheet;

static inline PetscReal Random(uint64_t *state) /* in [-1, 1] */
{
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (PetscReal)(*state >> 11) / 9007199254740992.0 * 2 - 1;
}

/* n x m facets over [lo, hi] in x and y at height z; up: normal +z. */
static inline void SheetCreate(Sheet *c, PetscInt n, PetscInt m, PetscReal lo, PetscReal hi, PetscReal z, PetscBool up)
{
  c->facets = calloc((size_t)(4 * n * m), sizeof(PetscInt));
  c->x      = calloc((size_t)(3 * (n + 1) * (m + 1)), sizeof(PetscReal));
  for (PetscInt j = 0; j <= m; j++)
    for (PetscInt i = 0; i <= n; i++) {
      PetscReal *x = c->x + 3 * (j * (n + 1) + i);

      x[0] = lo + (hi - lo) * (PetscReal)i / (PetscReal)n;
      x[1] = lo + (hi - lo) * (PetscReal)j / (PetscReal)m;
      x[2] = z;
    }
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt a = j * (n + 1) + i, around[4] = {a, a + 1, a + n + 2, a + n + 1};

      for (PetscInt k = 0; k < 4; k++) c->facets[4 * (j * n + i) + k] = around[up ? k : 3 - k];
    }
  c->s = (ContactSurface){.dim = 3, .num_nodes = (n + 1) * (m + 1), .num_facets = n * m, .facets = c->facets, .x = c->x};
}

static inline void SheetDestroy(Sheet *c)
{
  free(c->facets);
  free(c->x);
}

/* x <- rotation about an axis by an angle, then shift, all nodes. */
static inline void SheetMove(Sheet *c, const PetscReal axis[3], PetscReal angle, const PetscReal shift[3])
{
  const PetscReal l = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), k[3] = {axis[0] / l, axis[1] / l, axis[2] / l};

  for (PetscInt n = 0; n < c->s.num_nodes; n++) {
    PetscReal      *x     = c->x + 3 * n, y[3];
    const PetscReal along = k[0] * x[0] + k[1] * x[1] + k[2] * x[2];

    for (int i = 0; i < 3; i++)
      y[i] = cos(angle) * x[i] + sin(angle) * (k[(i + 1) % 3] * x[(i + 2) % 3] - k[(i + 2) % 3] * x[(i + 1) % 3]) + (1 - cos(angle)) * along * k[i] + shift[i];
    for (int i = 0; i < 3; i++) x[i] = y[i];
  }
}

/* Results assembled over facets: numbers 3 * node + component, mortar nodes after the nonmortar ones. */
typedef struct {
  PetscInt   nn, nm, size, num;
  PetscReal *gap, *weight, *dgap, *dweight, *gradient, *hessian;
  PetscReal  area, min_gap, S;
  PetscBool  failed;
} Sum;

static inline void SumCreate(Sum *s, PetscInt nn, PetscInt nm)
{
  s->nn = nn, s->nm = nm, s->size = 3 * (nn + nm);
  s->gap      = calloc((size_t)nn, sizeof(PetscReal));
  s->weight   = calloc((size_t)nn, sizeof(PetscReal));
  s->dgap     = calloc((size_t)(nn * s->size), sizeof(PetscReal));
  s->dweight  = calloc((size_t)(nn * s->size), sizeof(PetscReal));
  s->gradient = calloc((size_t)s->size, sizeof(PetscReal));
  s->hessian  = calloc((size_t)(s->size * s->size), sizeof(PetscReal));
}

static inline void SumDestroy(Sum *s)
{
  free(s->gap);
  free(s->weight);
  free(s->dgap);
  free(s->dweight);
  free(s->gradient);
  free(s->hessian);
}

static inline PetscInt SumRow(const Sum *s, const ContactFacet *e, PetscInt a)
{
  const PetscInt node = e->nodes[a / 3];

  return 3 * (node >= 0 ? node : s->nn + ~node) + a % 3;
}

static inline void SumAdd(Sum *s, const ContactFacet *e, const PetscReal z[])
{
  const PetscInt n = 3 * e->num;

  for (PetscInt j = 0; j < e->num_rows; j++) {
    const PetscInt node = e->nodes[j];

    s->gap[node] += e->gap[j];
    s->weight[node] += e->weight[j];
    if (z) s->S += z[node] * e->gap[j];
    for (PetscInt a = 0; a < n && e->dgap; a++) {
      s->dgap[node * s->size + SumRow(s, e, a)] += e->dgap[j * n + a];
      s->dweight[node * s->size + SumRow(s, e, a)] += e->dweight[j * n + a];
      if (z) s->gradient[SumRow(s, e, a)] += z[node] * e->dgap[j * n + a];
    }
  }
  for (PetscInt a = 0; a < n && e->hessian; a++)
    for (PetscInt b = 0; b < n; b++) s->hessian[SumRow(s, e, a) * s->size + SumRow(s, e, b)] += e->hessian[a * n + b];
  s->area += e->area;
  s->min_gap = PetscMin(s->min_gap, e->min_gap);
}

static inline void SumEvaluate(Sum *s, ContactPair pair, const Sheet *nonmortar, const Sheet *mortar, const PetscReal z[], PetscBool hessian)
{
  const ContactFacet *facets;

  memset(s->gap, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->weight, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->dgap, 0, (size_t)(s->nn * s->size) * sizeof(PetscReal));
  memset(s->dweight, 0, (size_t)(s->nn * s->size) * sizeof(PetscReal));
  memset(s->gradient, 0, (size_t)s->size * sizeof(PetscReal));
  memset(s->hessian, 0, (size_t)(s->size * s->size) * sizeof(PetscReal));
  s->area = s->S = 0;
  s->min_gap     = PETSC_MAX_REAL;
  CHECK_CALL(ContactPairEvaluate(pair, &nonmortar->s, &mortar->s, z, NULL, PETSC_TRUE, hessian, &s->num, &facets, &s->failed));
  for (PetscInt i = 0; i < s->num; i++) SumAdd(s, &facets[i], z);
}

/* Search over all nonmortar facets. */
static inline void SearchAll(ContactPair pair, const Sheet *nonmortar, const Sheet *mortar, PetscReal distance, PetscReal margin)
{
  PetscInt *list = malloc((size_t)nonmortar->s.num_facets * sizeof(PetscInt));

  for (PetscInt i = 0; i < nonmortar->s.num_facets; i++) list[i] = i;
  CHECK_CALL(ContactPairSearch(pair, &nonmortar->s, &mortar->s, nonmortar->s.num_facets, list, distance, margin));
  free(list);
}
