/* What a pair of surfaces in the plane or in space gives, assembled over its facets: shared by the contact tests. */
#pragma once
#include "contact.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "near.h"

#define CHECK_CALL(...) assert_int_equal((int)(__VA_ARGS__), 0)

/* Deterministic random numbers in (-1, 1). */
static inline PetscReal Random(uint64_t *state)
{
  *state = *state * 6364136223846793005ULL + 1442695040888963407ULL;
  return (PetscReal)(*state >> 11) / (PetscReal)(1ULL << 52) - 1;
}

/* Unknowns: dim * node + component, mortar nodes after the nonmortar ones. */
typedef struct {
  PetscInt   dim, nn, nm, size, num, springs; /* springs: facets with compliance */
  PetscReal *gap, *weight;                    /* [nn] */
  PetscReal *dgap, *dweight;                  /* [nn][size] */
  PetscReal *gradient;                        /* [size] forces: of S = sum z gap + z.(compliance) z / 2; held lines held */
  PetscReal *hessian;                         /* [size][size] */
  PetscReal  area, min_gap, S;
  PetscBool  failed;
} Sum;

static inline void SumCreateFor(Sum *s, PetscInt dim, PetscInt nn, PetscInt nm)
{
  s->dim = dim, s->nn = nn, s->nm = nm, s->size = dim * (nn + nm);
  s->gap      = calloc((size_t)nn, sizeof(PetscReal));
  s->weight   = calloc((size_t)nn, sizeof(PetscReal));
  s->dgap     = calloc((size_t)(nn * s->size), sizeof(PetscReal));
  s->dweight  = calloc((size_t)(nn * s->size), sizeof(PetscReal));
  s->gradient = calloc((size_t)s->size, sizeof(PetscReal));
  s->hessian  = calloc((size_t)(s->size * s->size), sizeof(PetscReal));
}

static inline void SumDestroy(Sum *s)
{
  free(s->gap), free(s->weight), free(s->dgap), free(s->dweight), free(s->gradient), free(s->hessian);
}

static inline PetscInt SumRow(const Sum *s, const ContactFacet *f, PetscInt a)
{
  const PetscInt node = f->nodes[a / s->dim];

  return s->dim * (node >= 0 ? node : s->nn + ~node) + a % s->dim;
}

static inline void SumAdd(Sum *s, const ContactFacet *f, const PetscReal z[])
{
  const PetscInt n = s->dim * f->num;

  for (PetscInt j = 0; j < f->num_rows; j++) {
    const PetscInt node = f->nodes[j];

    s->gap[node] += f->gap[j];
    s->weight[node] += f->weight[j];
    if (z) s->S += z[node] * f->gap[j];
    for (PetscInt a = 0; a < n && f->dgap; a++) {
      const PetscInt row = SumRow(s, f, a);

      s->dgap[node * s->size + row] += f->dgap[j * n + a];
      s->dweight[node * s->size + row] += f->dweight[j * n + a];
      if (z) s->gradient[row] += z[node] * (f->push ? f->push : f->dgap)[j * n + a];
    }
  }
  if (f->compliance && f->kappa[0] > 0) s->springs++;
  if (f->compliance && z) {
    const PetscReal Q = ContactFacetYield(f, f->nodes, z);

    s->S += 0.5 * f->kappa[0] * Q;
    for (PetscInt a = 0; a < n && f->dshare && !f->push; a++) s->gradient[SumRow(s, f, a)] += 0.5 * f->kappa[1] * Q * f->dshare[a];
  }
  for (PetscInt a = 0; a < n && f->hessian; a++)
    for (PetscInt b = 0; b < n; b++) s->hessian[SumRow(s, f, a) * s->size + SumRow(s, f, b)] += f->hessian[a * n + b];
  s->area += f->area;
  s->min_gap = PetscMin(s->min_gap, f->min_gap);
}

static inline void SumReset(Sum *s)
{
  memset(s->gap, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->weight, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->dgap, 0, (size_t)(s->nn * s->size) * sizeof(PetscReal));
  memset(s->dweight, 0, (size_t)(s->nn * s->size) * sizeof(PetscReal));
  memset(s->gradient, 0, (size_t)s->size * sizeof(PetscReal));
  memset(s->hessian, 0, (size_t)(s->size * s->size) * sizeof(PetscReal));
  s->area = s->S = 0;
  s->springs     = 0;
  s->min_gap     = PETSC_MAX_REAL;
}

/* Evaluate the pair and assemble. */
static inline void SumSurfaces(Sum *s, ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[],
                               PetscBool derivatives, PetscBool hessian)
{
  const ContactFacet *facets;

  SumReset(s);
  CHECK_CALL(ContactPairEvaluate(pair, nonmortar, mortar, z, NULL, derivatives, hessian, &s->num, &facets, &s->failed));
  for (PetscInt i = 0; i < s->num; i++) SumAdd(s, &facets[i], z);
}

/* f'(0) from f(-2h), f(-h), f(h), f(2h): error h^4. */
static inline PetscReal Difference(const PetscReal f[4], PetscReal h)
{
  return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h);
}

static inline PetscReal Largest(const PetscReal a[], PetscInt n)
{
  PetscReal m = 0;

  for (PetscInt i = 0; i < n; i++) m = PetscMax(m, PetscAbsReal(a[i]));
  return m;
}

/* Search over all nonmortar facets. */
static inline void SearchSurfaces(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscReal distance, PetscReal margin)
{
  PetscInt *list = malloc((size_t)nonmortar->num_facets * sizeof(PetscInt));

  for (PetscInt i = 0; i < nonmortar->num_facets; i++) list[i] = i;
  CHECK_CALL(ContactPairSearch(pair, nonmortar, mortar, nonmortar->num_facets, list, distance, margin));
  free(list);
}

/* Chains, sheets and patches alike: whatever has a surface s. */
#define SearchAll(pair, nonmortar, mortar, distance, margin) SearchSurfaces(pair, &(nonmortar)->s, &(mortar)->s, distance, margin)
