/* Symmetric rules on triangles, exact to degree 10, 12 and 14 [Dunavant 1985]; weights sum up to 1. */
#include "kernelimpl.h"

/* By their orbits: weight of the middle, 0: it is no point; weight, a for (1 - 2 a, a, a); weight, a, b for (a, b, 1 - a - b). */
#define MOST_POINTS 42
typedef struct {
  PetscInt  degree, num3, num6;
  PetscReal middle, orbit3[6][2], orbit6[4][3];
} Orbits;

static const Orbits Rules[3] = {
    {10,
     2,
     3,
     0.090817990382753691,
     {{0.036725957756466858, 0.485577633383657337}, {0.045321059435527784, 0.109481575485037563}},
     {{0.072757916845419990, 0.141707219414879987, 0.307939838764121065},
      {0.028327242531057534, 0.025003534762686408, 0.246672560639902089},
      {0.009421666963732889, 0.009540815400299871, 0.066803251012200096}}},
    {12,
     5,
     3,
     0,
     {{0.025731066440455322, 0.48821738977380486},
      {0.043692544538038454, 0.43972439229446031},
      {0.062858224217885117, 0.27121038501211592},
      {0.034796112930708889, 0.12757614554158578},
      {0.0061662610515590237, 0.021317350453210385}},
     {{0.04037155776638094, 0.115343494534698, 0.27571326968551396},
      {0.022356773202303445, 0.022838332222257063, 0.28132558098993959},
      {0.017316231108658885, 0.025734050548330206, 0.11625191590759719}}},
    {14,
     6,
     4,
     0,
     {{0.0218835813694289, 0.48896391036217868},
      {0.032788353544125355, 0.41764471934045394},
      {0.051774104507291585, 0.27347752830883865},
      {0.042162588736993044, 0.17720553241254342},
      {0.014433699669776661, 0.06179988309087265},
      {0.0049234036024000949, 0.019390961248701068}},
     {{0.024665753212563681, 0.057124757403647898, 0.17226668782135565},
      {0.038571510787060677, 0.092916249356971792, 0.33686145979634496},
      {0.01443630811353384, 0.014646950055654405, 0.29837288213625779},
      {0.005010228838500665, 0.0012683309328720186, 0.11897449769695674}}},
};
static PetscReal Points[3][MOST_POINTS][3], Weights[3][MOST_POINTS];

/* The first num, 1, 3 or 6, permutations of three numbers; returns the place after them. */
static PetscInt Orbit_Private(const PetscReal b[3], PetscInt num, PetscReal weight, PetscInt at, PetscReal point[][3], PetscReal w[])
{
  for (PetscInt k = 0; k < num; k++) {
    for (PetscInt i = 0; i < 3; i++) point[at + k][(i * (k < 3 ? 1 : 2) + k) % 3] = b[i];
    w[at + k] = weight;
  }
  return at + num;
}

PetscBool ContactRuleGet(PetscInt degree, PetscInt *num, const PetscReal (**point)[3], const PetscReal **weight)
{
  const Orbits *o;
  PetscReal(*to)[3], *w;
  PetscInt rule = 0, at = 0;

  while (rule < 3 && Rules[rule].degree < degree) rule++;
  if (rule == 3) return PETSC_FALSE;
  o = &Rules[rule], to = Points[rule], w = Weights[rule];
  *num = (o->middle > 0) + 3 * o->num3 + 6 * o->num6, *point = (const PetscReal(*)[3])to, *weight = w;
  if (w[0] != 0) return PETSC_TRUE;
  if (o->middle > 0) at = Orbit_Private((const PetscReal[3]){1. / 3, 1. / 3, 1. / 3}, 1, o->middle, at, to, w);
  for (PetscInt k = 0; k < o->num3; k++) {
    const PetscReal a = o->orbit3[k][1];

    at = Orbit_Private((const PetscReal[3]){1 - 2 * a, a, a}, 3, o->orbit3[k][0], at, to, w);
  }
  for (PetscInt k = 0; k < o->num6; k++) {
    const PetscReal a = o->orbit6[k][1], b = o->orbit6[k][2];

    at = Orbit_Private((const PetscReal[3]){a, b, 1 - a - b}, 6, o->orbit6[k][0], at, to, w);
  }
  return PETSC_TRUE;
}
