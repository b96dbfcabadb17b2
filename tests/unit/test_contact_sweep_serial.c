/* Mortar sides whose end, corner or crease crosses a nonmortar surface: weighted gaps, weights and forces follow their derivatives at every place of it, from
   nothing covered to all, so that nothing jumps. Between two places a value changes by the mean of its derivatives there times the distance, but for what the
   derivative is curved: where it differs by more the derivative in the middle counts, too, and where that does not do the interval is halved, down to a width
   at which only a jump could be left. */
#include "rayfixture.h"

#define JUMP 1e-8 /* of the largest value */
#define WIDTH 1e-9
#define MOST (3 * 200)

/* Of the mortar side: its end; an edge beyond which it goes on with another face; in space one of its corners; a bend between two of its facets. */
typedef enum { END, FACE, CORNER, CREASE } Kind;

typedef struct {
  PetscInt    dim, order;
  Kind        kind;
  PetscBool   closed; /* the surfaces touch: what is compared are the forces */
  Patch       nonmortar, mortar;
  ContactPair pair;
  PetscReal   z[200], softness[200];
  PetscBool   rim[200];
} Scene;

/* Mortar nodes at place t of the sweep. The nonmortar surface is [0, 1]^m of height 0. */
static void Place(Scene *s, PetscReal t)
{
  Patch *p = &s->mortar;

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal *u     = p->u + 2 * n,
                    far[2] = {s->kind == CREASE ? (u[0] < 0.5 ? -1 + 2 * u[0] * (1 + t) : t + 2 * (u[0] - 0.5) * (2 - t)) : -1 + (1 + t) * u[0],
                              s->kind == CORNER ? -1 + (1 + 0.9 * t) * u[1] : 3 * u[1] - 1};
    const PetscReal bend = s->kind == CREASE ? PetscMax(0, far[0] - t) : 0, gap = s->closed ? 0 : 0.05 + 0.03 * far[0] + 0.2 * bend;

    p->x[p->dim * n] = far[0];
    if (p->dim == 3) p->x[3 * n + 1] = far[1] + 0.07 * far[0]; /* not parallel to the facets */
    p->x[p->dim * n + p->dim - 1] = gap;
  }
}

static void SceneCreate(Scene *s)
{
  const ContactSpec spec = {.friction = 0};
  uint64_t          seed = 7;

  PatchCreate(&s->nonmortar, s->dim, s->order, 2, 0, 1, (PetscBool)(s->dim == 3), PETSC_FALSE);
  PatchCreate(&s->mortar, s->dim, 1, s->kind == CREASE ? 2 : 1, 0, 1, (PetscBool)(s->dim == 2), PETSC_FALSE);
  for (PetscInt n = 0; n < s->nonmortar.s.num_nodes; n++) {
    for (PetscInt c = 0; c < s->dim; c++) s->nonmortar.x[s->dim * n + c] = s->nonmortar.X[s->dim * n + c] = c < s->dim - 1 ? s->nonmortar.u[2 * n + c] : 0;
    s->z[n]        = 1 + 0.5 * Random(&seed);
    s->softness[n] = 1;
  }
  for (PetscInt n = 0; n < s->mortar.s.num_nodes; n++) s->rim[n] = PETSC_TRUE;
  if (s->kind == FACE) s->mortar.s.rim = s->rim;
  Place(s, 0.5);
  memcpy(s->mortar.X, s->mortar.x, sizeof(PetscReal) * (size_t)(s->dim * s->mortar.s.num_nodes));
  CHECK_CALL(ContactPairCreate(s->dim, PETSC_FALSE, &spec, &s->pair));
  ContactPairSetSoftness(s->pair, s->softness);
  SearchAll(s->pair, &s->nonmortar, &s->mortar, 1, 2);
}

/* Values at t and their derivatives along the sweep: gaps and weights, or forces. Returns their number. */
static PetscInt Values(Scene *s, PetscReal t, PetscReal value[], PetscReal slope[])
{
  PetscReal      *move = calloc((size_t)(s->dim * s->mortar.s.num_nodes), sizeof(PetscReal));
  const PetscReal h    = 0.25; /* places are linear in t, but for the crease's on either side of it */
  const PetscInt  own = s->dim * s->nonmortar.s.num_nodes, others = s->dim * s->mortar.s.num_nodes;
  PetscInt        num = 0;
  Sum             sum;

  for (int k = 0; k < 2; k++) {
    Place(s, t + (k ? h : -h));
    for (PetscInt i = 0; i < others; i++) move[i] += (k ? 0.5 : -0.5) / h * s->mortar.x[i];
  }
  Place(s, t);
  SumCreate(&sum, &s->nonmortar, &s->mortar);
  SumEvaluate(&sum, s->pair, &s->nonmortar, &s->mortar, s->z, s->closed);
  assert_false(sum.failed);
  if (s->closed)
    for (PetscInt i = 0; i < sum.size; i++, num++) {
      value[num] = sum.gradient[i], slope[num] = 0;
      for (PetscInt k = 0; k < others; k++) slope[num] += sum.hessian[i * sum.size + own + k] * move[k];
    }
  else
    for (PetscInt j = 0; j < sum.nn; j++)
      for (int w = 0; w < 2; w++, num++) {
        value[num] = w ? sum.weight[j] : sum.gap[j], slope[num] = 0;
        for (PetscInt k = 0; k < others; k++) slope[num] += (w ? sum.dweight : sum.dgap)[j * sum.size + own + k] * move[k];
      }
  assert_true(num <= MOST);
  SumDestroy(&sum);
  free(move);
  return num;
}

/* What the values change by besides the mean of their derivatives at both ends. */
static PetscReal Besides(PetscInt num, PetscReal h, const PetscReal a[][MOST], const PetscReal b[][MOST], PetscReal scale)
{
  PetscReal worst = 0;

  for (PetscInt i = 0; i < num; i++) worst = PetscMax(worst, fabs(b[0][i] - a[0][i] - 0.5 * h * (a[1][i] + b[1][i])));
  return worst / scale;
}

/* The same, the derivative a parabola through its values at the ends and in the middle: over the interval and over its first half. */
static PetscReal BesidesParabola(PetscInt num, PetscReal h, const PetscReal a[][MOST], const PetscReal m[][MOST], const PetscReal b[][MOST], PetscReal scale)
{
  PetscReal worst = 0;

  for (PetscInt i = 0; i < num; i++) {
    worst = PetscMax(worst, fabs(b[0][i] - a[0][i] - h * (a[1][i] + 4 * m[1][i] + b[1][i]) / 6));
    worst = PetscMax(worst, fabs(m[0][i] - a[0][i] - h * (5 * a[1][i] + 8 * m[1][i] - b[1][i]) / 24));
  }
  return worst / scale;
}

static PetscReal Between(Scene *s, PetscReal t, PetscReal h, const PetscReal a[][MOST], const PetscReal b[][MOST], PetscInt num, PetscReal scale)
{
  PetscReal besides = Besides(num, h, a, b, scale);
  PetscReal(*middle)[MOST], part[2];

  if (besides < JUMP || h < WIDTH) return besides;
  middle = calloc(2, sizeof(*middle));
  Values(s, t + 0.5 * h, middle[0], middle[1]);
  besides = BesidesParabola(num, h, a, (const PetscReal(*)[MOST])middle, b, scale);
  if (besides < JUMP) {
    free(middle);
    return besides;
  }
  part[0] = Between(s, t, 0.5 * h, a, (const PetscReal(*)[MOST])middle, num, scale);
  part[1] = Between(s, t + 0.5 * h, 0.5 * h, (const PetscReal(*)[MOST])middle, b, num, scale);
  free(middle);
  return PetscMax(part[0], part[1]);
}

static void Sweep(PetscInt dim, PetscInt order, Kind kind, PetscBool closed)
{
  static const char *name[] = {"end", "face", "corner", "crease"};
  Scene              s      = {.dim = dim, .order = order, .kind = kind, .closed = closed};
  PetscReal(*v)[2][MOST] = calloc(41, sizeof(*v)), scale = 0, worst = 0;
  PetscInt num = 0;

  SceneCreate(&s);
  for (int k = 0; k <= 40; k++) { /* t: from before the surface to beyond it */
    num   = Values(&s, -0.1 + 0.03 * k, v[k][0], v[k][1]);
    scale = PetscMax(scale, Largest(v[k][0], num));
  }
  for (int k = 0; k < 40; k++) {
    const PetscReal jump = Between(&s, -0.1 + 0.03 * k, 0.03, (const PetscReal(*)[MOST])v[k], (const PetscReal(*)[MOST])v[k + 1], num, scale);

    worst = PetscMax(worst, jump);
  }
  print_message("%dD order %d, %s: %s jump by less than %.1e\n", (int)dim, (int)order, name[kind], closed ? "forces" : "gaps and weights", worst);
  assert_true(worst < JUMP);
  PatchDestroy(&s.nonmortar);
  PatchDestroy(&s.mortar);
  CHECK_CALL(ContactPairDestroy(&s.pair));
  free(v);
}

static void Plane(void **state)
{
  for (PetscInt order = 1; order <= 4; order++)
    for (int closed = 0; closed < 2; closed++) {
      Sweep(2, order, END, closed);
      Sweep(2, order, FACE, closed);
      Sweep(2, order, CREASE, closed);
    }
}

static PetscInt most = 2; /* order in space */

static void Space(void **state)
{
  for (PetscInt order = most == 2 ? 1 : 3; order <= most; order++)
    for (int closed = 0; closed < 2; closed++)
      for (Kind kind = END; kind <= CREASE; kind++) Sweep(3, order, kind, closed);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Plane), cmocka_unit_test(Space)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (argc > 1 && !strcmp(argv[1], "-slow")) most = 4;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
