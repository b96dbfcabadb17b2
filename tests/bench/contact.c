/* Contact in three dimensions: seconds of search and evaluation against the number of facets, two wavy sheets of n x n and about 1.5 n x 1.5 n facets pressed
   together everywhere. Comma separated: nonmortar facets, mortar facets, segments, search, values, gradients (forces), gradients and Hessian (tangent).
   -order P: facets of order P, on lattices. */
#include "contact.h"
#include "element.h"
#include <petsctime.h>

#define OK(...)                                                                                                                                                \
  do {                                                                                                                                                         \
    if ((__VA_ARGS__) != 0) abort();                                                                                                                           \
  } while (0)

typedef struct {
  ContactSurface s;
  PetscInt      *facets, *first, *lattice;
  int8_t        *order;
  PetscReal     *x, *z;
} Sheet;

static void SheetCreate(PetscInt n, PetscInt p, PetscReal height, PetscBool up, Sheet *c)
{
  const PetscInt   row = p * n + 1, most = (p + 1) * (p + 1);
  const PetscReal *node;

  OK(ElementGetNodes(p, &node));
  OK(PetscMalloc3(4 * n * n, &c->facets, 3 * row * row, &c->x, row * row, &c->z));
  OK(PetscMalloc3(n * n, &c->order, n * n + 1, &c->first, most * n * n, &c->lattice));
  for (PetscInt k = 0; k < row * row; ++k) {
    const PetscInt  i = k % row, j = k / row;
    const PetscReal a = ((PetscReal)(i / p) + (i % p ? node[i % p] : 0)) / (PetscReal)n, b = ((PetscReal)(j / p) + (j % p ? node[j % p] : 0)) / (PetscReal)n;

    c->x[3 * k]     = a + 0.1 / (PetscReal)n * sin(7 * b);
    c->x[3 * k + 1] = b + 0.1 / (PetscReal)n * sin(5 * a);
    c->x[3 * k + 2] = height + 0.05 * sin(6 * a) * sin(4 * b);
    c->z[k]         = 1;
  }
  for (PetscInt f = 0; f < n * n; ++f) {
    const PetscInt a = p * (f / n * row + f % n), around[4] = {a, a + p, a + p * row + p, a + p * row};

    for (PetscInt k = 0; k < 4; ++k) c->facets[4 * f + k] = around[up ? k : 3 - k];
    for (PetscInt k = 0; k < most; ++k) c->lattice[most * f + k] = a + row * (up ? k / (p + 1) : p - k / (p + 1)) + k % (p + 1);
    c->order[f] = (int8_t)p;
    c->first[f] = most * f;
  }
  c->first[n * n] = most * n * n;
  c->s            = (ContactSurface){.dim = 3, .num_nodes = row * row, .num_facets = n * n, .facets = c->facets, .x = c->x, .X = c->x};
  if (p > 1) c->s.order = c->order, c->s.first = c->first, c->s.lattice = c->lattice;
}

static double Evaluate(ContactPair pair, const Sheet *a, const Sheet *b, PetscBool derivatives, PetscBool hessian)
{
  const ContactFacet *facets;
  PetscLogDouble      best = 1e9, start, end;
  PetscInt            num;
  PetscBool           failed;

  for (PetscInt repeat = 0; repeat < 3; ++repeat) {
    b->x[0] += 1e-12; /* else the last results stand */
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
  PetscInt              most = 316, order = 1;

  OK(PetscInitialize(&argc, &argv, NULL, NULL));
  OK(PetscOptionsGetInt(NULL, NULL, "-most", &most, NULL));
  OK(PetscOptionsGetInt(NULL, NULL, "-order", &order, NULL));
  printf("nonmortar,mortar,segments,search,values,forces,tangent\n");
  for (size_t i = 0; i < sizeof(Sizes) / sizeof(Sizes[0]) && Sizes[i] <= most; ++i) {
    const PetscInt        n = Sizes[i], m = n + n / 2;
    const ContactSpec     spec = {0};
    const ContactSegment *segments;
    PetscLogDouble        search = 1e9, start, end;
    PetscInt             *list, num;
    ContactPair           pair;
    Sheet                 a, b;
    double                seconds[3];

    SheetCreate(n, order, 0, PETSC_TRUE, &a);
    SheetCreate(m, order, 1e-3, PETSC_FALSE, &b);
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
    ContactPairGetSegments(pair, &num, &segments);
    printf("%d,%d,%d,%.5f,%.5f,%.5f,%.5f\n", (int)(n * n), (int)(m * m), (int)num, search, seconds[0], seconds[1], seconds[2]);
    OK(ContactPairDestroy(&pair));
    OK(PetscFree(list));
    OK(PetscFree3(a.facets, a.x, a.z));
    OK(PetscFree3(b.facets, b.x, b.z));
    OK(PetscFree3(a.order, a.first, a.lattice));
    OK(PetscFree3(b.order, b.first, b.lattice));
  }
  return PetscFinalize();
}
