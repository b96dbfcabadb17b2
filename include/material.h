/* Floor 1. Pointwise constitutive laws: one file and one table row each. A law always sees a 3x3 deformation gradient.
   Stress-like quantities are in the user's unit of stress. Components of F, P: row-major, P[3*i+J]. */
#pragma once
#include "base.h"

typedef enum {
  VOLUMETRIC_QUADRATIC,
  VOLUMETRIC_SIMO,
  VOLUMETRIC_LOG
} Volumetric; /* U = kappa/2 (J-1)^2 | kappa/2 ((J^2-1)/2 - ln J) | log_modulus/2 (ln J)^2, docs/theory.md */
typedef enum { FORMULATION_AUTO, FORMULATION_DISPLACEMENT, FORMULATION_MIXED } Formulation; /* auto: mixed from nu = 0.45 up */
extern const char *const VolumetricNames[];                                                 /* PETSc enum name arrays */

#define MATERIAL_MAX_PARAMETERS 12
#define MATERIAL_MAX_HISTORY 8
#define MATERIAL_MAX_FIBERS 4

typedef struct _MaterialLaw MaterialLaw; /* a row of the table of laws */

/* A family of parallel fibres. */
typedef struct {
  char      name[MORTISE_NAME];
  PetscReal k1, k2;              /* 0 before set-up: those of the law */
  PetscBool straight;            /* the same direction everywhere; else of a field, or an angle in the frame */
  PetscReal direction[3];        /* straight: in the reference configuration; of length 1 after set-up */
  PetscReal angle;               /* degrees, from the circumferential direction of the frame towards its axis */
  char      field[MORTISE_NAME]; /* of the mesh, that has a vector for each cell; empty: none */
  const PetscReal (*along)[3];   /* borrowed, of any length: [coarse cells] of the field once the mesh is known, else NULL */
  PetscBool compression;         /* comparison only: fibres push where they are shortened */
} MaterialFiber;

/* The axis around which circumferential directions turn: parallel to a coordinate axis, through a point. The circumferential direction at X is
   axis x (X - point), made a unit vector; on the axis itself, where none is singled out, it is the next coordinate direction but one. */
typedef struct {
  int       axis;
  PetscReal point[3];
  PetscBool meridian; /* axisymmetric model: the circumferential direction is the third one everywhere, the axis is y */
} MaterialFrame;

typedef struct {
  char               name[MORTISE_NAME];                 /* the user's name of the material */
  const MaterialLaw *law;                                /* row of the table, never NULL after set-up */
  PetscReal          mu, lambda, kappa;                  /* derived from whichever pair was given; shear modulus, Lame's first, bulk modulus */
  PetscReal          log_modulus;                        /* volumetric: log: factor of (ln J)^2/2; lambda, less what the shear energy has of it */
  PetscReal          parameter[MATERIAL_MAX_PARAMETERS]; /* law's own (mooney_rivlin: c1, c2, kappa) */
  PetscInt           num_fibers;
  MaterialFiber      fiber[MATERIAL_MAX_FIBERS];
  MaterialFrame      frame;
  Volumetric         volumetric;
  Formulation        formulation;
  PetscBool          mixed;          /* resolved by MaterialSetUp: pressure is an independent field, condensed in the cell */
  PetscBool          incompressible; /* kappa (and lambda) are infinite: mixed, and the pressures are unknowns of the whole problem */
} MaterialSpec;

/* One named parameter of a law, for -list, -help and the checks. */
typedef struct {
  const char *name, *unit, *help;
  PetscReal   min, max; /* admissible open interval; max itself, too, where it is the incompressible limit */
} MaterialParameter;

/* Poisson's ratio of 0.5 and an infinite bulk modulus. */
static inline PetscBool MaterialIsLimit(const MaterialParameter *p, PetscReal value)
{
  return (PetscBool)(value == p->max && (!strcmp(p->name, "nu") || !strcmp(p->name, "kappa")));
}

/* What the tangent expects of points on their yield surface but for round-off, as every step finds them that follows one in which they flowed: the side they
   are on, which is the derivative; that they flow on; or that they become elastic. */
typedef enum { EDGE_AS_IT_IS, EDGE_FLOWS, EDGE_RESTS } MaterialEdge;

/* Points at which a law is asked, structure of arrays with stride n. Outputs that are NULL are skipped. */
typedef struct {
  PetscInt         n;
  const PetscReal *F;     /* [9][n] */
  const PetscReal *fiber; /* [num_fibers][3][n] unit vectors in the reference configuration; NULL for laws without fibres */
  PetscReal       *W;     /* [n] energy density */
  PetscReal       *P;     /* [9][n] */
  PetscReal       *A;     /* [81][n]: A[9*a+b] = dP_a/dF_b, symmetric unless the law says otherwise */
  /* Laws with history: what the last accepted step left at the points, [num_history][n], and what a step that ended at F would leave. All answers are
     functions of F and history alone. */
  const PetscReal *history;
  PetscReal       *trial;
  MaterialEdge     edge;   /* for A, and */
  PetscReal        secant; /* share of the secant stiffness of plastic flow in A; 0: A is the derivative of P */
  PetscBool held; /* trial alone: points beyond the yield surface go back to it without any flow, the elastic strain radially, plastic strain unchanged */
  PetscBool bad;  /* out: set at points with det F <= 0, or where the law has no answer (the energy exceeds all numbers, the yield stress is used up) (numerical
                     status, no error); never reset */
} MaterialPoints;

/* With `part` ISOCHORIC, the volumetric energy kappa/2 g(J)^2 is left out (mixed formulation adds it through its projection). */
typedef enum { MATERIAL_FULL, MATERIAL_ISOCHORIC } MaterialPart;
typedef PetscErrorCode (*MaterialKernel)(const MaterialSpec *, MaterialPart part, MaterialPoints *);

struct _MaterialLaw {
  const char              *name, *help;
  const MaterialParameter *parameters;  /* ended by name NULL */
  PetscBool                small;       /* linear law of small kinematics */
  PetscBool                rigid;       /* cells are not assembled */
  PetscBool                fibers;      /* needs families of fibres */
  PetscBool                whole;       /* energy does not split into shear and volume: no volumetric law, displacement formulation alone */
  PetscBool                unsymmetric; /* A is not symmetric: the linear solver must be one for unsymmetric matrices */
  PetscInt                 num_history; /* numbers it remembers at each integration point, <= MATERIAL_MAX_HISTORY; P is then no derivative of W */
  PetscInt                 settled; /* which of these is the volume g(J) that mixed cells take no pressure from: coarser cells, that the mesh had before, did
                                       not see it as they flowed (src/transfer/history.c); 0: none */
  PetscErrorCode (*setup)(MaterialSpec *);
  MaterialKernel evaluate;                                    /* NULL for rigid */
  void (*initial)(const MaterialSpec *, PetscReal history[]); /* before the first step, [num_history]; NULL without history */
  /* Plastic strain alpha and plastic work per reference volume that a history tells of; NULL for laws without plastic flow. */
  void (*plastic)(const MaterialSpec *, const PetscReal history[], PetscReal *strain, PetscReal *work);
};

/* Secant over initial shear modulus where the material has flowed by plastic strain alpha with plastic work w (MaterialLaw.plastic), by Hencky's theory of
   deformation (docs/theory.md, error estimation): 1/(1 + 3 mu alpha^2/w), 1 without flow, about 0 where it is far beyond the strain at yield. */
PetscReal MaterialSecant(const MaterialSpec *, PetscReal strain, PetscReal work);

/* Does the yield stress fall somewhere with plastic strain? Zones of flow then shrink to the width of a cell: results depend on the mesh. */
PetscBool MaterialSoftens(const MaterialSpec *);

/* The table of laws, ended by name NULL; and look-up by name (NULL when unknown). */
extern const MaterialLaw MaterialLaws[];
const MaterialLaw       *MaterialLawFind(const char *name);

/* Complete a spec from parameters given by name: `names[i]`, `values[i]`, i < num. Checks which sets are complete (E,nu | mu,kappa | mu,lambda |
   the law's own), ranges (E > 0, -1 < nu <= 0.5, moduli positive; nu = 0.5 or kappa = infinity: incompressible), names unknown
   parameters with the nearest known one, resolves `mixed`. Messages start with "material.<name>.<parameter>". */
PetscErrorCode MaterialSetUp(MaterialSpec *, PetscInt num, const char *const names[], const PetscReal values[]);

/* Does the law's parameter of this name take the value? Else a sentence on what stands where (text: the value as it was given); an unknown name is
   MaterialSetUp's to tell. */
PetscErrorCode MaterialCheckRange(const MaterialLaw *, const char name[], PetscReal value, const char where[], const char text[]);

/* Young's modulus; 3 mu for incompressible material. */
static inline PetscReal MaterialYoung(const MaterialSpec *spec)
{
  return 9 * spec->mu / (3 + spec->mu / spec->kappa);
}

/* Do its cells have a pressure of their own that is condensed there? */
static inline PetscBool MaterialStoresPressure(const MaterialSpec *spec)
{
  return (PetscBool)(spec->mixed && !spec->incompressible);
}

/* Unit vectors of all families at the reference position X in a coarse cell (which families of a field ask for); none for laws without fibres. Not
   collective. */
void MaterialFiberDirections(const MaterialSpec *, PetscInt cell, const PetscReal X[3], PetscReal fiber[][3]);

PetscErrorCode MaterialEvaluate(const MaterialSpec *, MaterialPart, MaterialPoints *);

/* Volumetric measure g(J) with U(J) = kappa/2 g(J)^2 and its first two derivatives: J-1 (quadratic), ln J (log: with log_modulus for kappa),
   sign(J-1) sqrt((J^2-1)/2 - ln J) (simo; series near 1). The independent pressure field is pi = modulus * Proj g; Cauchy pressure -pi g'(J) . */
void      MaterialVolumetric(const MaterialSpec *, PetscReal J, PetscReal g[3]);
PetscReal MaterialVolumetricModulus(const MaterialSpec *);
/* The same at n points from J-1, which loses no digits near 1: g[n], dg[n], ddg[n]. */
void MaterialVolumetricPoints(const MaterialSpec *, PetscInt n, const PetscReal *J_minus_1, PetscReal *g, PetscReal *dg, PetscReal *ddg);
