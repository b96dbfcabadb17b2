/* Finite elasto-plasticity with the yield condition of von Mises: multiplicative, in the intermediate-configuration form of Simo & Hughes (Computational
   Inelasticity, chapter 9; docs/theory.md). Energy U(J) + mu/2 (tr be - 3) of the isochoric elastic strain be = Fbar G Fbar^T, where G = Cp^-1 (det G = 1) is
   remembered at each point together with the plastic strain alpha;

     |s| <= sqrt(2/3) k(alpha),   s = mu dev be,   k = yield (1 + alpha/swift_strain)^swift_exponent + hardening alpha + saturation (1 - exp(-saturation_rate
   alpha)).

   One step, from the trial strain be_tr = Fbar G_n Fbar^T:  s = s_tr - 2 mu_b dg n,  n = s_tr / |s_tr|,  mu_b = mu tr(be_tr)/3,  alpha = alpha_n + sqrt(2/3)
   dg; dev be = s/mu and the trace of be follows from det be = 1. */
#include "materialimpl.h"

enum { YIELD = 5, HARDENING, SATURATION, SATURATION_RATE, SWIFT_STRAIN, SWIFT_EXPONENT }; /* after the elastic parameters */
#define ROOT23 0.81649658092772603273                                                     /* sqrt(2/3) */
#define ON_SURFACE 1e-9 /* share of its radius within which a point is on the yield surface but for round-off */

const MaterialParameter MaterialJ2Parameters[] = {
    {"E", "stress", "Young's modulus", 0, PETSC_MAX_REAL},
    {"nu", "1", "Poisson's ratio; 0.5: incompressible", -1, 0.5},
    {"mu", "stress", "shear modulus", 0, PETSC_MAX_REAL},
    {"kappa", "stress", "bulk modulus; inf: incompressible", 0, INFINITY},
    {"lambda", "stress", "Lame's first parameter", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"yield", "stress", "yield stress of the virgin material", 0, PETSC_MAX_REAL},
    {"hardening", "stress", "its rise per unit of plastic strain; default 0", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"saturation", "stress", "a further rise that saturates, saturation (1 - exp(-saturation_rate alpha)); default 0", PETSC_MIN_REAL, PETSC_MAX_REAL},
    {"saturation_rate", "1", "how fast it does, per unit of plastic strain", 0, PETSC_MAX_REAL},
    {"swift_strain", "1", "Swift's law: the yield stress times (1 + alpha/swift_strain)^swift_exponent takes the place of the yield stress", 0, PETSC_MAX_REAL},
    {"swift_exponent", "1", "of Swift's law", 0, 1},
    {NULL, NULL, NULL, 0, 0},
};

/* Least slope of k: at one end or the other of the exponential; that of Swift's law falls to 0. */
static PetscReal Least_Private(const MaterialSpec *spec)
{
  return spec->parameter[HARDENING] + PetscMin(0, spec->parameter[SATURATION] * spec->parameter[SATURATION_RATE]);
}

PetscBool MaterialSoftens(const MaterialSpec *spec)
{
  return (PetscBool)(spec->law->evaluate == MaterialJ2 && Least_Private(spec) < 0);
}

PetscErrorCode MaterialJ2SetUp(MaterialSpec *spec)
{
  PetscReal *v = spec->parameter;

  PetscFunctionBegin;
  PetscCall(MaterialSetUpElastic(spec));
  PetscCheckInput(!PetscIsNanReal(v[YIELD]), "material.%s.yield: missing; j2 needs the yield stress", spec->name);
  PetscCheckInput(PetscIsNanReal(v[SATURATION]) == PetscIsNanReal(v[SATURATION_RATE]), "material.%s.%s: missing; saturation and saturation_rate go together",
                  spec->name, PetscIsNanReal(v[SATURATION]) ? "saturation" : "saturation_rate");
  PetscCheckInput(spec->volumetric != VOLUMETRIC_LOG, "material.%s.volumetric: j2 knows quadratic and simo, not log", spec->name);
  PetscCheckInput(PetscIsNanReal(v[SWIFT_STRAIN]) == PetscIsNanReal(v[SWIFT_EXPONENT]), "material.%s.%s: missing; swift_strain and swift_exponent go together",
                  spec->name, PetscIsNanReal(v[SWIFT_STRAIN]) ? "swift_strain" : "swift_exponent");
  if (PetscIsNanReal(v[SWIFT_STRAIN])) {
    v[SWIFT_STRAIN]   = 1;
    v[SWIFT_EXPONENT] = 0;
  }
  if (PetscIsNanReal(v[HARDENING])) v[HARDENING] = 0;
  if (PetscIsNanReal(v[SATURATION])) v[SATURATION] = v[SATURATION_RATE] = 0;
  const PetscReal least = Least_Private(spec); /* mu_b >= mu makes the return mapping well posed above -3 mu */
  PetscCheckInput(least > -3 * spec->mu, "material.%s.hardening: the yield stress falls by %g per unit of plastic strain; allowed: less than 3 mu = %g",
                  spec->name, (double)-least, (double)(3 * spec->mu));
  PetscCheckInput(v[YIELD] + PetscMin(0, v[SATURATION]) > 0, "material.%s.saturation: %g takes all of the yield stress %g away", spec->name,
                  (double)v[SATURATION], (double)v[YIELD]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MaterialJ2Initial(const MaterialSpec *spec, PetscReal history[])
{
  static const PetscReal virgin[] = {1, 0, 0, 1, 0, 1, 0, 0}; /* G: xx xy xz yy yz zz; alpha; settled volume */

  (void)spec;
  for (int k = 0; k < 8; k++) history[k] = virgin[k];
}

/* Work: int k(alpha) dalpha, what plastic flow took; by the yield condition it is the integral of the stress power of the plastic part. */
void MaterialJ2Plastic(const MaterialSpec *spec, const PetscReal history[], PetscReal *strain, PetscReal *work)
{
  const PetscReal *v = spec->parameter, alpha = history[6], x = v[SATURATION_RATE] * alpha, n = v[SWIFT_EXPONENT];

  *strain = alpha;
  *work   = v[YIELD] * v[SWIFT_STRAIN] / (n + 1) * expm1((n + 1) * log1p(alpha / v[SWIFT_STRAIN])) + 0.5 * v[HARDENING] * alpha * alpha;
  if (x > 0) *work += v[SATURATION] * (alpha + expm1(-x) / v[SATURATION_RATE]);
}

/* k and its slope. */
INLINE PetscReal YieldStress_Private(const MaterialSpec *spec, PetscReal alpha, PetscReal *slope)
{
  const PetscReal *v = spec->parameter, left = PetscExpReal(-v[SATURATION_RATE] * alpha);
  const PetscReal  n = v[SWIFT_EXPONENT], part = 1 + alpha / v[SWIFT_STRAIN], swift = n > 0 ? v[YIELD] * PetscPowReal(part, n) : v[YIELD];

  *slope = n * swift / (part * v[SWIFT_STRAIN]) + v[HARDENING] + v[SATURATION] * v[SATURATION_RATE] * left;
  return swift + v[HARDENING] * alpha + v[SATURATION] * (1 - left);
}

/* Root dg of length - 2 mu_b dg - sqrt(2/3) k(alpha + sqrt(2/3) dg), which falls with dg: Newton's method inside a bracket. PETSC_FALSE: there is none, the
   yield stress of a softening material is used up. */
static PetscBool Return_Private(const MaterialSpec *spec, PetscReal length, PetscReal mu_b, PetscReal alpha, PetscReal *dg, PetscReal *slope)
{
  PetscReal lo = 0, hi = length / (2 * mu_b), g = 0, f = PETSC_MAX_REAL;

  for (PetscInt it = 0; it < 100; it++) {
    f = length - 2 * mu_b * g - ROOT23 * YieldStress_Private(spec, alpha + ROOT23 * g, slope);
    if (f > 0)
      lo = g;
    else
      hi = g;
    const PetscReal newton = g + f / (2 * mu_b + 2. / 3 * *slope), next = newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
    if (PetscAbsReal(f) <= PETSC_MACHINE_EPSILON * length || next == g) break;
    g = next;
  }
  *dg = g;
  return (PetscBool)(PetscAbsReal(f) <= 1e-12 * length);
}

/* Largest root x of det(d + x 1) = x^3 - |d|^2/2 x + det d = 1 for a traceless d: Newton's method from above, where the cubic is convex. */
static Lanes MeanStrain_Private(const Lanes d[9], Lanes x)
{
  const Lanes q   = 0.5 * Inner9(d, d);
  const Lanes det = d[0] * (d[4] * d[8] - d[5] * d[5]) - d[1] * (d[1] * d[8] - d[5] * d[2]) + d[2] * (d[1] * d[5] - d[4] * d[2]);

  for (PetscInt it = 0; it < 60; it++) {
    const Lanes step = ((x * x - q) * x + det - 1) / (3 * x * x - q);
    PetscBool   done = PETSC_TRUE;

    x -= step;
    for (int l = 0; l < NUM_LANES; l++) done = (PetscBool)(done && !(PetscAbsReal(step[l]) > 1e-15 * x[l]));
    if (done) break;
  }
  return x;
}

/* A step at the points of all lanes. */
typedef struct {
  Lanes     b[9], s[9], n[9];    /* trial strain, stress, direction of flow */
  Lanes     length, mean, dg;    /* |s_tr|, tr(be_tr)/3, dg */
  Lanes     slope, alpha, be[9]; /* k', after the step */
  LanesMask plastic, flows;      /* beyond the yield surface; there, or on it but for round-off: the tangent is that of further flow */
  LanesMask bad;
} Step;

/* F G F^T J^(-2/3). */
INLINE void Trial_Private(const MaterialSpec *spec, const Deformation *d, Step *t)
{
  static const int8_t at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const Lanes         scale = 1 + LanesExpm1((-2. / 3) * d->lnJ), *F = d->F, *G = d->history;
  Lanes               FG[9];

  for (int i = 0; i < 3; i++)
    for (int J = 0; J < 3; J++) FG[3 * i + J] = scale * (F[3 * i] * G[at[J]] + F[3 * i + 1] * G[at[3 + J]] + F[3 * i + 2] * G[at[6 + J]]);
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++) t->b[3 * i + j] = t->b[3 * j + i] = FG[3 * i] * F[3 * j] + FG[3 * i + 1] * F[3 * j + 1] + FG[3 * i + 2] * F[3 * j + 2];
  t->mean = (t->b[0] + t->b[4] + t->b[8]) / 3;
  for (int k = 0; k < 9; k++) t->s[k] = spec->mu * (t->b[k] - (k % 4 == 0 ? t->mean : (Lanes){0}));
  t->length = Inner9(t->s, t->s);
  for (int l = 0; l < NUM_LANES; l++) t->length[l] = PetscSqrtReal(t->length[l]);
}

/* Points flow, for the tangent, from this multiple of the yield surface's radius on. */
INLINE PetscReal Edge_Private(const Deformation *d)
{
  if (d->held || d->edge == EDGE_RESTS) return 1 + ON_SURFACE;
  return d->edge == EDGE_FLOWS ? 1 - ON_SURFACE : 1;
}

INLINE void Step_Private(const MaterialSpec *spec, const Deformation *d, Step *t)
{
  const PetscReal edge = Edge_Private(d);

  Trial_Private(spec, d, t);
  t->alpha = d->history[6];
  t->dg = t->slope = (Lanes){0};
  t->plastic = t->flows = t->bad = (LanesMask){0};
  for (int l = 0; l < NUM_LANES; l++) {
    PetscReal       dg, slope;
    const PetscReal radius = ROOT23 * YieldStress_Private(spec, t->alpha[l], &slope);

    if (!(t->length[l] > edge * radius)) continue;
    t->flows[l] = -1;
    t->slope[l] = slope;
    if (!(t->length[l] > radius)) continue;
    t->plastic[l] = -1;
    t->dg[l]      = 0.5 * (t->length[l] - PetscMax(0, radius)) / (spec->mu * t->mean[l]); /* no flow: the distance from the surface alone */
    if (d->held) continue;
    if (!Return_Private(spec, t->length[l], spec->mu * t->mean[l], t->alpha[l], &dg, &slope)) t->bad[l] = -1;
    t->dg[l]    = dg;
    t->slope[l] = slope;
    t->alpha[l] += ROOT23 * dg;
  }
  const Lanes inverse = 1 / LanesSelect(t->flows, t->length, LanesSet(1)), back = 2 * spec->mu * t->mean * t->dg;
  for (int k = 0; k < 9; k++) {
    t->n[k]  = LanesSelect(t->flows, t->s[k] * inverse, (Lanes){0});
    t->s[k]  = t->s[k] - back * t->n[k];
    t->be[k] = t->s[k] / spec->mu;
  }
  const Lanes mean = MeanStrain_Private(t->be, t->mean);
  for (int k = 0; k < 9; k++) t->be[k] = LanesSelect(t->plastic, t->be[k] + (k % 4 == 0 ? mean : (Lanes){0}), t->b[k]);
}

/* G = Fbar^-1 be Fbar^-T where there was flow; else bit by bit what it was. F^-1 = cof^T / J. */
INLINE void Remember_Private(const Deformation *d, const Step *t, Lanes trial[8])
{
  const Lanes scale = (1 + LanesExpm1((2. / 3) * d->lnJ)) / (d->J * d->J), *c = d->cof;
  Lanes       B[9];
  int         k = 0;

  for (int i = 0; i < 3; i++)
    for (int J = 0; J < 3; J++) B[3 * i + J] = scale * (t->be[3 * i] * c[J] + t->be[3 * i + 1] * c[3 + J] + t->be[3 * i + 2] * c[6 + J]);
  for (int K = 0; K < 3; K++)
    for (int J = K; J < 3; J++, k++) trial[k] = LanesSelect(t->plastic, c[K] * B[J] + c[3 + K] * B[3 + J] + c[6 + K] * B[6 + J], d->history[k]);
  trial[6] = t->alpha;
  trial[7] = d->history[7]; /* load steps do not change it, meshes do */
}

/* a_imkl = ds_im/dl_kl - delta_mk s_il for dF = l F: the exact derivative of the step. Not symmetric by n (x) dev n^2. Of the part n (x) c, by which beta
   changes, s = beta s_tr, a share is left out: without it this is the secant stiffness. */
INLINE void SpatialTangent_Private(const MaterialSpec *spec, const Step *t, PetscReal secant, Lanes a[81])
{
  const PetscReal mu   = spec->mu;
  const Lanes     mu_b = mu * t->mean, bottom = 2 * mu_b + 2. / 3 * t->slope;
  const Lanes     one = LanesSet(1), length = LanesSelect(t->flows, t->length, one);
  const Lanes     beta = LanesSelect(t->flows, 1 - 2 * mu_b * t->dg / length, one), share = LanesSelect(t->flows, 2. / 3 * t->slope / bottom, (Lanes){0});
  Lanes           c[9], n2[9];

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) n2[3 * i + j] = t->n[3 * i] * t->n[3 * j] + t->n[3 * i + 1] * t->n[3 * j + 1] + t->n[3 * i + 2] * t->n[3 * j + 2];
  for (int k = 0; k < 9; k++) {
    const Lanes dlength = 2 * mu_b * t->n[k] + 2 * t->length * (n2[k] - (k % 4 == 0 ? 1. / 3 : 0)); /* d|s_tr|/dl, dev n^2 where n is a unit tensor */

    c[k] = LanesSelect(t->flows, (1 - secant) * (share * (dlength - 4. / 3 * t->dg * t->length * t->n[k]) - beta * dlength), (Lanes){0});
  }
  for (int i = 0; i < 3; i++) {
    for (int m = 0; m < 3; m++) {
      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) {
          const Lanes *b     = t->b;
          Lanes        value = t->n[3 * i + m] * c[3 * k + l];

          if (i == k) value += beta * mu * b[3 * l + m];
          if (m == k) value += beta * mu * b[3 * i + l] - t->s[3 * i + l];
          if (i == m) value -= 2. / 3 * beta * mu * b[3 * k + l];
          if (k == l) value -= 2. / 3 * beta * mu * (b[3 * i + m] - (i == m ? t->mean : (Lanes){0}));
          a[27 * i + 9 * m + 3 * k + l] = value;
        }
      }
    }
  }
}

/* A_iJkL = a_imkl Finv_Jm Finv_Ll. */
INLINE void PullBack_Private(const Deformation *d, const Lanes a[81], Lanes A[81])
{
  const Lanes inverse = 1 / d->J;
  Lanes       inv[9], half[81];

  for (int k = 0; k < 9; k++) inv[k] = inverse * d->cof[k]; /* Finv_Jm = inv[3m+J] */
  for (int im = 0; im < 9; im++)
    for (int k = 0; k < 3; k++)
      for (int L = 0; L < 3; L++)
        half[9 * im + 3 * k + L] = a[9 * im + 3 * k] * inv[L] + a[9 * im + 3 * k + 1] * inv[3 + L] + a[9 * im + 3 * k + 2] * inv[6 + L];
  for (int i = 0; i < 3; i++)
    for (int J = 0; J < 3; J++)
      for (int kL = 0; kL < 9; kL++)
        A[9 * (3 * i + J) + kL] = half[27 * i + kL] * inv[J] + half[27 * i + 9 + kL] * inv[3 + J] + half[27 * i + 18 + kL] * inv[6 + J];
}

INLINE void J2Point_Private(const MaterialSpec *spec, MaterialPart part, const Deformation *d, Response *r)
{
  const Lanes inverse = 1 / d->J, *c = d->cof;
  Lanes       U[3] = {{0}}, a[81];
  Step        t;

  Step_Private(spec, d, &t);
  r->bad |= t.bad;
  Remember_Private(d, &t, r->trial);
  if (part == MATERIAL_FULL) VolumetricEnergy(spec, d, U);
  if (r->want_W) r->W = 0.5 * spec->mu * (t.be[0] + t.be[4] + t.be[8] - 3) + U[0];
  for (int k = 0; r->want_P && k < 9; k++)
    r->P[k] = inverse * (t.s[k - k % 3] * c[k % 3] + t.s[k - k % 3 + 1] * c[3 + k % 3] + t.s[k - k % 3 + 2] * c[6 + k % 3]) + U[1] * c[k];
  if (!r->want_A) return;
  SpatialTangent_Private(spec, &t, d->secant, a);
  PullBack_Private(d, a, r->A);
  AddSquare(r->A, U[2], c);
  AddCofactorDerivative(r->A, U[1], d->F);
}

PetscErrorCode MaterialJ2(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PointLoop(J2Point_Private, 8, spec, part, points);
  PetscFunctionReturn(PETSC_SUCCESS);
}
