/* Contact in three dimensions: seconds of search and evaluation against the number of facets, two wavy sheets of n x n and about 1.5 n x 1.5 n facets pressed
   together everywhere. Comma separated: nonmortar facets, mortar facets, segments, search, values, gradients (forces), gradients and Hessian (tangent).
   -continuous: along a continuous direction. */
#include "contact.h"
#include <petsctime.h>

#define OK(...)                                                                                                                                                \
  do {                                                                                                                                                         \
    if ((__VA_ARGS__) != 0) abort();                                                                                                                           \
  } while (0)

typedef struct {
  ContactSurface s;
  PetscInt      *facets;
  PetscReal     *x, *z;
} Sheet;

static void SheetCreate(PetscInt n, PetscReal height, PetscBool up, Sheet *c)
{
  OK(PetscMalloc3(4 * n * n, &c->facets, 3 * (n + 1) * (n + 1), &c->x, (n + 1) * (n + 1), &c->z));
  for (PetscInt k = 0; k < (n + 1) * (n + 1); ++k) {
    const PetscReal a = (PetscReal)(k % (n + 1)) / (PetscReal)n, b = (PetscReal)(k / (n + 1)) / (PetscReal)n;

    c->x[3 * k]     = a + 0.1 / (PetscReal)n * sin(7 * b);
    c->x[3 * k + 1] = b + 0.1 / (PetscReal)n * sin(5 * a);
    c->x[3 * k + 2] = height + 0.05 * sin(6 * a) * sin(4 * b);
    c->z[k]         = 1;
  }
  for (PetscInt f = 0; f < n * n; ++f) {
    const PetscInt a = f / n * (n + 1) + f % n, around[4] = {a, a + 1, a + n + 2, a + n + 1};

    for (PetscInt k = 0; k < 4; ++k) c->facets[4 * f + k] = around[up ? k : 3 - k];
  }
  c->s = (ContactSurface){.dim = 3, .num_nodes = (n + 1) * (n + 1), .num_facets = n * n, .facets = c->facets, .x = c->x, .X = c->x};
}

static double Evaluate(ContactPair pair, const Sheet *a, const Sheet *b, PetscBool derivatives, PetscBool hessian)
{
  const ContactFacet *facets;
  PetscLogDouble      best = 1e9, start, end;
  PetscInt            num;
  PetscBool           failed;

  for (PetscInt repeat = 0; repeat < 3; ++repeat) {
    OK(PetscTime(&start));
    OK(ContactPairEvaluate(pair, &a->s, &b->s, a->z, NULL, derivatives, hessian, &num, &facets, &failed));
    OK(PetscTime(&end));
    best = PetscMin(best, end - start);
  }
  return best;
}

int main(int argc, char **argv)
{
  static const PetscInt Sizes[] = {10, 18, 32, 56, 100, 178, 316};
  PetscInt              most    = 316;
  PetscBool             rays    = PETSC_FALSE;

  OK(PetscInitialize(&argc, &argv, NULL, NULL));
  OK(PetscOptionsGetInt(NULL, NULL, "-most", &most, NULL));
  OK(PetscOptionsGetBool(NULL, NULL, "-continuous", &rays, NULL));
  printf("nonmortar,mortar,segments,search,values,forces,tangent\n");
  for (size_t i = 0; i < sizeof(Sizes) / sizeof(Sizes[0]) && Sizes[i] <= most; ++i) {
    const PetscInt        n = Sizes[i], m = n + n / 2;
    const ContactSpec     spec = {.continuous = rays};
    const ContactSegment *segments;
    PetscLogDouble        search = 1e9, start, end;
    PetscInt             *list, num;
    ContactPair           pair;
    Sheet                 a, b;
    double                seconds[3];

    SheetCreate(n, 0, PETSC_TRUE, &a);
    SheetCreate(m, 1e-3, PETSC_FALSE, &b);
    OK(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
    OK(PetscMalloc1(n * n, &list));
    for (PetscInt k = 0; k < n * n; ++k) list[k] = k;
    for (PetscInt repeat = 0; repeat < 3; ++repeat) {
      OK(PetscTime(&start));
      OK(ContactPairSearch(pair, &a.s, &b.s, n * n, list, 0.1, 0.01 / (PetscReal)n));
      OK(PetscTime(&end));
      search = PetscMin(search, end - start);
    }
    seconds[0] = Evaluate(pair, &a, &b, PETSC_FALSE, PETSC_FALSE);
    seconds[1] = Evaluate(pair, &a, &b, PETSC_TRUE, PETSC_FALSE);
    seconds[2] = n > 178 ? 0 : Evaluate(pair, &a, &b, PETSC_TRUE, PETSC_TRUE); /* Hessians of 100 000 facets take 3 GB */
    OK(ContactPairGetSegments(pair, &num, &segments));
    printf("%d,%d,%d,%.5f,%.5f,%.5f,%.5f\n", (int)(n * n), (int)(m * m), (int)num, search, seconds[0], seconds[1], seconds[2]);
    OK(ContactPairDestroy(&pair));
    OK(PetscFree(list));
    OK(PetscFree3(a.facets, a.x, a.z));
    OK(PetscFree3(b.facets, b.x, b.z));
  }
  return PetscFinalize();
}
