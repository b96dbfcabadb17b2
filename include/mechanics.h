/* Floor 3. Bulk residual and tangent, loads, supports. Consumes material laws, the hp space and the specs below. */
#pragma once
#include "element.h"
#include "hp.h"
#include "material.h"

typedef enum { MODEL_PLANE_STRAIN, MODEL_AXISYMMETRIC, MODEL_3D } Model; /* axisymmetric: x = r, y = z, weight 2 pi R */
typedef enum { KINEMATICS_FINITE, KINEMATICS_SMALL } Kinematics;
extern const char *const ModelNames[];
extern const char *const KinematicsNames[];

/* What a boundary group prescribes. Components without an Expression stay free. */
typedef struct {
  char       name[MORTISE_NAME]; /* physical group */
  PetscInt   group;              /* bit in ForestTables.boundary */
  Expression displacement[3];
  PetscBool  fix[3];
  PetscBool  fix_normal; /* flat face of any direction: u.N = 0 */
  PetscBool  rotation;   /* finite rotation about the axis through point, degrees, expression of t */
  PetscInt   rotation_axis;
  Expression rotation_angle;
  PetscReal  rotation_point[3];
  Expression pressure;    /* follower, against the outward normal; current area */
  Expression volume;      /* or a follower pressure that is found: it changes the volume that the boundary encloses by so much (control.c) … */
  Expression advance;     /* … or moves the boundary by so much against its outward normal, mean over the reference area */
  Expression traction[3]; /* dead, per reference area */
  PetscReal  about[3];    /* point that moments of the support are counted about */
  Amplitude  amplitude;   /* multiplies displacement, rotation, pressure, volume, advance, traction that are constants in t */
} BoundarySpec;

/* Is the boundary's pressure found; is there one, given or found? */
static inline PetscBool BoundaryIsControlled(const BoundarySpec *b)
{
  return (PetscBool)(b->volume || b->advance);
}
static inline PetscBool BoundaryHasPressure(const BoundarySpec *b)
{
  return (PetscBool)(b->pressure || BoundaryIsControlled(b));
}

static inline PetscBool BoundaryHasTraction(const BoundarySpec *b)
{
  return (PetscBool)(b->traction[0] || b->traction[1] || b->traction[2]);
}

/* The key of the scene that puts a pressure on it. */
static inline const char *BoundaryPressureKey(const BoundarySpec *b)
{
  return b->volume ? "volume" : b->advance ? "advance" : "pressure";
}

/* Does the boundary hold something (fix, displacement, rotation)? Then it has a reaction. */
static inline PetscBool BoundarySupports(const BoundarySpec *b)
{
  PetscBool any = (PetscBool)(b->fix_normal || b->rotation);

  for (PetscInt c = 0; c < 3; ++c) any = (PetscBool)(any || b->fix[c] || b->displacement[c]);
  return any;
}

typedef struct {
  char                name[MORTISE_NAME]; /* physical group of top dimension */
  const MaterialSpec *material;           /* borrowed */
  PetscInt            order;              /* displacement order of its cells, the highest of all directions */
  PetscInt            order_along[3];     /* along cell axes that run mostly in direction x, y, z; 0: order */
  Expression          motion[3];          /* rigid bodies: prescribed translation; NULL: 0 */
  Expression          rotation_angle;     /* rigid bodies: prescribed rotation before it, degrees, about an axis through a point; NULL: none */
  PetscInt            rotation_axis;
  PetscReal           rotation_point[3];
  Expression          load[3];        /* rigid bodies: forces in directions in which they are free to go; NULL: prescribed */
  Expression          load_moment[3]; /* moments about axes through `about`, about which they are free to turn */
  Expression          force[3];       /* dead force per reference volume */
  PetscReal           about[3];       /* point that moments are counted about, moving with the body; reference position */
  Amplitude           amplitude;      /* of motion, rotation, load and force */
} BodySpec;

/* How many axes a rigid body is free to turn about; does it move by forces at all? */
static inline PetscInt BodyNumTurns(const BodySpec *b)
{
  return (b->load_moment[0] != NULL) + (b->load_moment[1] != NULL) + (b->load_moment[2] != NULL);
}
static inline PetscBool BodyIsLoaded(const BodySpec *b)
{
  return (PetscBool)(b->load[0] || b->load[1] || b->load[2] || BodyNumTurns(b) > 0);
}

typedef struct {
  Model               model;
  Kinematics          kinematics;
  PetscInt            num_bodies;
  const BodySpec     *bodies; /* [num_bodies], index = body of the coarse mesh */
  PetscInt            num_boundaries;
  const BoundarySpec *boundaries;
  const PetscInt     *joined; /* [num_bodies] bodies that are tied to each other have one number; NULL: none are */
} MechanicsSpec;

/* ---- the bulk of one mesh (mechanics.c, support.c, prescribe.c, load.c, integrate.c) ------------------------------------------------ */

typedef struct _p_Mechanics *Mechanics;

/* Which dofs of the space are prescribed, by the scene's boundaries and rigid bodies. Fills fixed[num_nodes] (bit c: component c in the node's frame)
   and the frames of nodes with skew supports; arrays are freed by MechanicsSupportsDestroy. Collective on nothing: input is replicated. */
typedef struct {
  int8_t  *fixed;
  PetscInt num_frames, *frame_node;
  PetscReal (*frame)[9];
  PetscInt *rigid;        /* [num_nodes] rigid body that prescribes all components, -1: none does */
  PetscReal (*normal)[3]; /* [num_boundaries] of those fixed along their normal */
} Supports;

/* Value of an expression times the amplitude; an expression that speaks of t itself takes the amplitude only when one is given. */
PetscErrorCode MechanicsValue(Expression, const Amplitude *, const PetscReal X[3], PetscReal t, PetscReal *value);
PetscErrorCode MechanicsSupportsCreate(HPSpace, const MechanicsSpec *, Supports *);
PetscErrorCode MechanicsSupportsDestroy(Supports *);

/* After HPSpaceSetUp. Takes a reference to nothing: space, spec and supports must outlive it. */
PetscErrorCode MechanicsCreate(HPSpace, const MechanicsSpec *, const Supports *, Mechanics *);
PetscErrorCode MechanicsDestroy(Mechanics *);
/* Is a cell of this rank inverted in the reference mesh (Jacobian determinant not positive at an integration point)? Then its order and a node of it; order 0:
   none is. Cells are images of the nodes of their order, which hang from coarser neighbours: a valid curved coarse mesh does not rule it out. Forces of such a
   mesh must not be asked for. Not collective. */
PetscErrorCode MechanicsFindInverted(Mechanics, PetscInt *order, PetscReal X[3], PetscInt *leaf);
/* folded[leaf] = 1 of this rank's cells that displacements u[] (local array) turn inside out at an integration point: no residual can be had there. Not with
   small kinematics. Not collective. */
PetscErrorCode MechanicsFindFolded(Mechanics, const PetscReal u[], int8_t folded[]);

/* Pseudo-time: evaluates dead loads and prescribed values. */
PetscErrorCode MechanicsSetTime(Mechanics, PetscReal t);
/* Part (0, 1] of the diagonal that bodies without support get in the tangent, MECHANICS_SHIFT of the cells' own stiffness against shear; 1 at first. */
#define MECHANICS_SHIFT 1e-6
PetscErrorCode MechanicsSetProximalShift(Mechanics, PetscReal part);
/* From now on residual and tangent have viscous forces against what cells deform since the displacements from[] (local array; a copy is taken): rate 1 is about
   as stiff as the material; 0: none, from is not looked at. Not collective. */
PetscErrorCode MechanicsSetViscosity(Mechanics, PetscReal rate, const PetscReal from[]);
/* Its forces at u times the motion since then: this rank's part of the energy that it takes. Not collective. */
PetscErrorCode MechanicsViscousWork(Mechanics, const PetscReal u[], PetscReal *work);
/* Sum of q q^T over the supported directions q of the nodes of each body and those joined to it (axisymmetric: the radial direction is supported):
   hold[num_bodies][9]. A direction of which a sum over bodies has no more than MECHANICS_FREE of its trace is free. group[num_bodies] (or NULL): the first of
   the bodies that are joined: they share vertices, or are tied. */
#define MECHANICS_FREE 1e-9
PetscErrorCode MechanicsGetHold(Mechanics, const PetscReal **hold, const PetscInt **group);
/* The axes that are free by such a sum, as bits. */
static inline PetscInt MechanicsFreeAxes(PetscInt dim, const PetscReal hold[9])
{
  PetscInt axes = 0;

  for (PetscInt c = 0; c < dim; ++c)
    if (hold[4 * c] <= MECHANICS_FREE * (hold[0] + hold[4] + hold[8])) axes |= 1 << c;
  return axes;
}
/* Do supports hold it against every rigid motion, rotations too? Not collective. */
PetscBool MechanicsIsHeld(Mechanics, PetscInt body);
/* Write the prescribed dofs of time t into a local array of dofs; other entries stay. At t = 0 all are 0: bodies are at rest where the mesh puts them, and
   motion that begins with a jump is carried through them by the first step. */
PetscErrorCode MechanicsPrescribe(Mechanics, PetscReal local[]);

/* Where two boundaries, or one and the motion of a rigid body, prescribe different displacements of a node of this rank at time t beyond round-off: a sentence;
   "" where all agree. Values that are not finite are no contradiction. Not collective. */
PetscErrorCode MechanicsFindConflict(Mechanics, PetscReal t, size_t size, char words[]);

/* Derivative by t, by differences over 2 dt, of dead loads and follower pressures at displacement u, as they enter the residual: added to the local array rate.
 */
PetscErrorCode MechanicsLoadRate(Mechanics, const PetscReal u[], PetscReal dt, PetscReal rate[]);

/* Results of a bulk integration on this rank (sums and minima over its own cells). */
typedef struct {
  PetscReal energy; /* strain energy */
  PetscReal scale2; /* sum over cells and loads of squared nodal forces: what a small residual is small against */
  /* Sum over cells of the square of what round-off of F = I + grad u leaves in nodal forces, u being no larger than a cell; grows with F like |F|^4. */
  PetscReal noise2;
  PetscReal drift2;  /* the same for each unit of the largest displacement */
  PetscReal largest; /* largest displacement component */
  PetscReal volume;  /* largest coefficient of g(J) in incompressible cells: their change of volume */
  PetscReal min_det; /* smallest det F */
  PetscBool bad;     /* some det F <= 0: residual must not be used (numerical status) */
} MechanicsStatus;

/* Add the residual (internal minus external forces) at displacement u (local array, prescribed dofs set) to r (local array, prescribed dofs included:
   reactions), with these element pressures. NULL: those that u implies, whose round-off is that of det F times the bulk modulus; so is that of the residual. */
PetscErrorCode MechanicsResidual(Mechanics, const PetscReal u[], const PetscReal pressure[], PetscReal r[], MechanicsStatus *);

/* Work of dead loads on the displacements u (local array): this rank's part. Not collective. */
PetscErrorCode MechanicsDeadWork(Mechanics, const PetscReal u[], PetscReal *work);

/* Receives K[num][num] for local dofs; of an owned cell (its masters in order, all but those inside it where they are condensed) or of a load (cell -1). */
typedef PetscErrorCode (*MatrixSink)(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[]);
/* Tangent at u with the stored pressure (NULL: consistent with u); remembers the linearised pressure for MechanicsUpdatePressure. */
PetscErrorCode MechanicsTangent(Mechanics, const PetscReal u[], const PetscReal pressure[], MatrixSink, void *context, PetscBool *bad);

/* Static condensation (not to be undone): from now on MechanicsTangent eliminates the nodes inside each cell and sends what is left, over the dofs of the
   others; bad also where that is impossible. Not collective. */
PetscErrorCode MechanicsSetCondense(Mechanics);
/* Negative eigenvalues of what the last tangent eliminated on this rank. */
PetscErrorCode MechanicsNumNegative(Mechanics, PetscInt *num);
/* Forces condensed like the last tangent, on a local array that is exact at the inner nodes of this rank's cells: there r becomes 0 (and is remembered), to the
   dofs of the other nodes -K_bi K_ii^-1 r_i is added (this rank's part). */
PetscErrorCode MechanicsCondenseForces(Mechanics, PetscReal r[]);
/* Increments at the inner nodes of this rank's cells from those at all others in du (local array, prescribed ones included): x_i = -K_ii^-1 (r_i + K_ib x_b)
   with the last tangent and the forces last condensed. */
PetscErrorCode MechanicsRecover(Mechanics, PetscReal du[]);

/* ---- pressures that are found (control.c) ------------------------------------------------------------------------------- */

/* Boundaries whose pressure is found, by their index among the boundaries, ascending. Not collective. */
PetscErrorCode MechanicsGetControls(Mechanics, PetscInt *num, const PetscInt **boundary);
/* Their pressures in everything that follows; 0 before. Not collective. */
PetscErrorCode MechanicsSetControls(Mechanics, const PetscReal pressure[]);
/* Follower pressure of a boundary at reference position X and time t: given, or found. Not collective. */
PetscErrorCode MechanicsPressure(Mechanics, PetscInt boundary, const PetscReal X[3], PetscReal t, PetscReal *pressure);
/* What control k follows, this rank's part at displacement u (local array); n out of the body:
     volume   V(u) = - int_0^1 int u . n da at X + s u ds: swept by the boundary on straight lines from X to X + u;
     advance  V(u) = - int u . N dA: the mean times the area.
   Its derivative by u is added to gradient, the residual of a unit pressure to force (local arrays, NULL: skip). Not collective. */
PetscErrorCode MechanicsControl(Mechanics, PetscInt k, const PetscReal u[], PetscReal *value, PetscReal gradient[], PetscReal force[]);
/* Reference area of its facets (axisymmetric: of the revolution), and area times shear modulus: this rank's part. Not collective. */
PetscErrorCode MechanicsControlArea(Mechanics, PetscInt k, PetscReal sum[2]);
/* Mark the local nodes that its facets depend on. Not collective. */
PetscErrorCode MechanicsControlNodes(Mechanics, PetscInt k, PetscBool mark[]);

/* ---- element pressures --------------------------------------------------------------------------------------------- */

/* Cells of incompressible material: their pressures are unknowns, which are set from outside, and have rows of their own. (incompressible.c)
   Arrays of them hold those of local cells one after the other, owned cells before ghosts. */
PetscErrorCode MechanicsNumUnknowns(Mechanics, PetscInt *owned, PetscInt *all);
PetscErrorCode MechanicsUnknownRange(Mechanics, PetscInt cell, PetscInt *first, PetscInt *num);
/* From now on these are the pressures; 0 before. */
PetscErrorCode MechanicsSetPressure(Mechanics, const PetscReal pressure[]);
/* Those of a range. */
PetscErrorCode MechanicsGetPressure(Mechanics, PetscInt first, PetscInt num, PetscReal pressure[]);
/* Rows of owned cells at the last MechanicsResidual: E/h int q g(J) dV, h the cell's extent (unit: force). */
PetscErrorCode MechanicsVolumeRows(Mechanics, PetscReal rows[]);
/* Receives of an owned cell the derivative B[num_rows][num] of int q g(J) by local dofs, the factor E/h of its rows, and hold[num_rows]: a small diagonal
   against pressures that nothing determines, to be taken off. */
typedef PetscErrorCode (*VolumeSink)(void *context, PetscInt cell, PetscInt num_rows, PetscInt num, const PetscInt dofs[], const PetscReal B[], PetscReal scale,
                                     const PetscReal hold[]);
/* Those of the last MechanicsTangent. */
PetscErrorCode MechanicsVolumeTangent(Mechanics, VolumeSink, void *context);

/* Element pressures that are condensed: num coefficients on this rank, cell after cell. */
PetscErrorCode MechanicsNumPressure(Mechanics, PetscInt *num);
/* pressure += step * (linearised pressure at the last tangent + its derivative . du - pressure), du local array. */
PetscErrorCode MechanicsUpdatePressure(Mechanics, const PetscReal du[], PetscReal step, PetscReal pressure[]);
/* Take a copy of them: stress at points is theirs from now on. Before, it is that of those u implies. Collective: ghosts get theirs. */
PetscErrorCode MechanicsStorePressure(Mechanics, const PetscReal pressure[]);

/* History of laws that have one: num numbers on this rank, cell after cell, [point][component] in each. Residual and tangent are functions of u and of the
   history last set, which is that of the last accepted step; at first that of the virgin material. */
PetscErrorCode MechanicsNumHistory(Mechanics, PetscInt *num);
PetscErrorCode MechanicsInitialHistory(Mechanics, PetscReal history[]);
/* Take a copy of history[num]. Collective: ghosts get theirs. */
PetscErrorCode MechanicsSetHistory(Mechanics, const PetscReal history[]);
/* history[num] = what a step from the history last set to u leaves; *bad as in MechanicsStatus. Not collective. */
PetscErrorCode MechanicsCommit(Mechanics, const PetscReal u[], PetscReal history[], PetscBool *bad);
/* history[num] = that last set, admissible at u: where the stress lies beyond the yield surface the elastic strain goes back radially, with determinant 1 and
   the same plastic strain. Cells that u inverts keep theirs. Not collective. */
PetscErrorCode MechanicsAdmit(Mechanics, const PetscReal u[], PetscReal history[]);
/* At how many integration points of this rank material flows on the way from the history last set to u. Not collective. */
PetscErrorCode MechanicsNumFlowing(Mechanics, const PetscReal u[], PetscInt *num);
/* What the tangent expects of points on their yield surface, and the share of the secant stiffness of plastic flow in it (MaterialPoints). Not collective. */
PetscErrorCode MechanicsSetFlow(Mechanics, MaterialEdge, PetscReal secant);
/* The integration points of a cell of this order: tensor products of this table's, the first direction fastest. Not collective. */
PetscErrorCode MechanicsPointRule(PetscInt order, const Basis1D **);
/* Where an owned cell's numbers lie in the array; num 0: no history, rigid, or a ghost. */
PetscErrorCode MechanicsHistoryRange(Mechanics, PetscInt cell, PetscInt *first, PetscInt *num);
/* Does any body flow? */
PetscBool MechanicsIsPlastic(const MechanicsSpec *);
/* Plastic flow up to u on this rank: largest plastic strain, at integration points and at cells' nodes by polynomials through these points; plastic work; and
   for each body that flows integral[num_bodies][2] = int alpha dV and int dV over the reference volume, 0 for the others (axisymmetric: of the full
   revolution). Not collective. */
PetscErrorCode MechanicsPlastic(Mechanics, const PetscReal u[], PetscReal *strain, PetscReal *work, PetscReal integral[][2]);
/* terms.c. What parts of the model add to the energy of a body at displacements u; this rank's part, sums over integration points of the reference volume. */
typedef struct {
  PetscReal volume, energy; /* of the body; stored in it */
  PetscReal strain2;        /* squared strain */
  PetscReal linear;         /* small kinematics instead of finite ones, at the stresses found; 0 in laws with history */
  PetscReal misfit;         /* 2 mu times the squared difference of the linear strain from that of these stresses in the linear law */
  PetscReal fibers;         /* of it in the fibres */
  PetscReal projected;      /* the displacement form instead of the mixed one; 0 with volumetric: log */
} BodyTerms;
/* terms[num_bodies], 0 for rigid ones. Pressures and history are those last set. Not collective. */
PetscErrorCode MechanicsTerms(Mechanics, const PetscReal u[], BodyTerms terms[]);
/* Work of follower pressures on u by straight ways beyond that of their forces at rest, (f(u) - f(0)) . u / 2: this rank's part. Not collective. */
PetscErrorCode MechanicsFollowerTurn(Mechanics, const PetscReal u[], PetscReal *work);
/* flowerror.c. fine[num], a history at displacements u0, becomes what many small steps leave on the way from there to u1: by the increment of displacements
   `way` (NULL: not known) up to where material begins to flow, and on straight. Not collective. */
PetscErrorCode MechanicsFollowFlow(Mechanics, const PetscReal u0[], const PetscReal way[], const PetscReal u1[], PetscReal fine[]);
/* Energy of the difference of the stresses at u between the history last set, left there, and this one: this rank's part. Not collective. */
PetscErrorCode MechanicsFlowError(Mechanics, const PetscReal u[], const PetscReal fine[], PetscReal *energy);
/* Plastic strain at np reference points of an owned cell, by polynomials through the integration points; 0 for laws without. Not collective. */
PetscErrorCode MechanicsPlasticStrain(Mechanics, PetscInt cell, PetscInt np, const PetscReal xi[], const PetscReal u[], PetscReal strain[]);

/* Sum of residual entries r (local array, as returned by MechanicsResidual plus contact) over what each boundary prescribes: force of the support on the body,
   Cartesian; reaction[num_boundaries][3], this rank's part. */
PetscErrorCode MechanicsReactions(Mechanics, const PetscReal r[], PetscReal reaction[][3]);
/* moment.c. Moments of the same forces, where the displacements u (local array) carry them (small kinematics: at the reference positions):
   support[num_boundaries][3] of each support, about BoundarySpec.about; body[num_bodies]: force and moment, about BodySpec.about as it moves, that everything
   else exerts on a rigid body; 0 for others. This rank's part. Not collective. */
typedef struct {
  PetscReal force[3], moment[3];
} Resultant;
PetscErrorCode MechanicsMoments(Mechanics, const PetscReal r[], const PetscReal u[], PetscReal support[][3], Resultant body[]);
/* What forces add to the motion of a rigid body that they move: a translation, and a rotation vector (radians) about BodySpec.about. Not collective. */
PetscErrorCode MechanicsSetFreeMotion(Mechanics, PetscInt body, const PetscReal translation[3], const PetscReal rotation[3]);
/* Rotation vector (degrees) by which a rigid body is turned now, prescribed or found. Not collective. */
PetscErrorCode MechanicsBodyRotation(Mechanics, PetscInt body, PetscReal rotation[3]);
/* rotation.c. Rotation by the vector phi (radians): matrix, row-major; spin J dphi of a change of phi. */
void RotationMatrix(const PetscReal phi[3], PetscReal R[9]);
void RotationSpin(const PetscReal phi[3], PetscReal J[9]);
/* The unit quaternion of the rotation that takes points nearest to others, S[3 i + j] = sum of x_i before times x_j after, about the centroids: the eigenvector
   of the largest eigenvalue of Horn's matrix (J. Opt. Soc. Am. A 4, 1987, 629); in the plane of the rotations about z. *unique: there is one only. */
PetscErrorCode RotationNearest(PetscInt dim, const PetscReal S[9], PetscReal q[4], PetscBool *unique);
/* Displacement of the material point at X of a rigid body at the time last set. Not collective. */
PetscErrorCode MechanicsBodyMotion(Mechanics, PetscInt body, const PetscReal X[3], PetscReal u[3]);

/* What is wanted at points of a cell; NULL: skipped. */
typedef struct {
  PetscReal *X, *J; /* [np][3] reference position, third 0 in the plane; [np][9] dX/dxi, in the plane 1 in the third direction */
  PetscReal *F, *P; /* [np][9] */
  PetscReal *W;     /* [np] strain energy density */
} PointValues;

/* Point values in cell at np reference points xi[np][dim]. Owned and ghost cells (MechanicsStorePressure). */
PetscErrorCode MechanicsPoints(Mechanics, PetscInt cell, PetscInt np, const PetscReal xi[], const PetscReal u[], const PointValues *);

/* Where the coefficients of an owned cell lie in the pressure array; num 0: none are condensed (not mixed, incompressible, rigid), or a ghost. */
PetscErrorCode MechanicsPressureRange(Mechanics, PetscInt cell, PetscInt *first, PetscInt *num);
/* Coefficients of a cell of this order: complete polynomials of degree order-1. */
static inline PetscInt MechanicsPressureCount(PetscInt dim, PetscInt order)
{
  return dim == 2 ? order * (order + 1) / 2 : order * (order + 1) * (order + 2) / 6;
}
/* The pressure field of a cell of this order at np reference points xi[np][dim]: complete polynomials of degree order-1 times coefficients. Not collective. */
PetscErrorCode MechanicsPressureEvaluate(PetscInt dim, PetscInt order, PetscInt np, const PetscReal xi[], const PetscReal pressure[], PetscReal values[]);
/* Coefficients of the weighted least squares fit to values[np]; the points must determine it (order points in each direction do). Not collective. */
PetscErrorCode MechanicsPressureProject(PetscInt dim, PetscInt order, PetscInt np, const PetscReal xi[], const PetscReal weights[], const PetscReal values[],
                                        PetscReal pressure[]);
