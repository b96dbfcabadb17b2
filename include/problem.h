/* Floor 5. One scene on one mesh: bulk + contact, the layout of unknowns (u, z, pi), residual and tangent. Defines State.

   Global vector: on each rank first its free displacement dofs (numbering of the HPSpace), then its multipliers: z_j, the contact pressure at nonmortar
   node j, then the element pressures pi of its incompressible cells. Residual rows: forces for u; for z_j the complementarity  R_j = w0_j [ z_j - max(0, z_j -
   c_j gt_j / w_j) ]  (unit: force), c_j = E / w0_j with w0_j the reference tributary length (area) of the node; for pi E/h int q g(J), h the cell's extent
   (unit: force). Tangent: exact, active set as decided by the residual. The last rank's part ends with
   the scalars (scalar.c): pressures that are found, and pseudo-time where a path is followed. */
#pragma once
#include "interface.h"
#include "scene.h"

typedef struct _p_Problem *Problem;

/* Everything that evolves, besides the forest. */
typedef struct {
  Vec        x; /* owned: global (u, z, pi) of the problem it belongs to */
  PetscInt   num_pressure;
  PetscReal *pressure; /* owned [num_pressure] element pressures of this rank that are condensed */
  PetscInt   num_history;
  PetscReal *history; /* owned [num_history] what the laws of this rank's cells remember from the last accepted step (MechanicsHistoryRange) */
  PetscReal *fine;    /* owned [num_history] the same, had each step been many small ones on the way it went: what the load steps leave (StateFlowError) */
  PetscInt   num_from;
  PetscReal *from; /* owned [num_from] local displacements in which the history was left; none where nothing flows */
  PetscReal *way;  /* owned [num_from] where the first linear step led from there; means nothing without has_way */
  PetscBool  has_way;
  PetscInt   num_before;
  PetscReal *before; /* owned [num_before] local displacements and this rank's multipliers that slip counts from; none without friction */
  PetscReal  t;      /* pseudo-time of this state */
  Form       form;
  PetscInt   num_leaves;
  int8_t    *leaf_order; /* owned [num_leaves], replicated */
} State;

PetscErrorCode StateCreate(Problem, State *);
PetscErrorCode StateCopy(const State *from, State *to); /* same problem */
PetscErrorCode StateDestroy(State *);
/* The step that led to s->x is accepted: the history becomes what it left. Stress and forces at s->x stay the same. The problem's prescribed motion must be
   that of the state. Collective. */
PetscErrorCode StateCommit(Problem, State *);
/* The history was left at s->x. The problem's prescribed motion must be that of the state. Collective. */
PetscErrorCode StateKeepFrom(Problem, State *);
/* The first linear step dx of a solve that begins at x: which way a step begins, if it begins where the history was left. Collective. */
PetscErrorCode StateNoteWay(Problem, Vec x, Vec dx, State *);
/* Energy of the error that the load steps up to a state that has just been committed leave where material flows. Collective. */
PetscErrorCode StateFlowError(Problem, const State *, PetscReal *energy);
/* Slip counts from this state from now on (Commit and Admit do so too). The problem's prescribed motion must be that of the state. Collective. */
PetscErrorCode StateKeepOrigin(Problem, State *);
/* The history of an accepted state becomes admissible at s->x (MechanicsAdmit): one carried over from another mesh may lie beyond the yield surface. The
   problem's prescribed motion must be that of the state. Collective. */
PetscErrorCode StateAdmit(Problem, State *);

/* Initial cell orders of a scene on a forest, [num_leaves], to be freed by the caller. */
PetscErrorCode ProblemInitialOrders(const SceneData *, Forest, int8_t **leaf_order);
/* No cell's order along its axis a is above (*cap)[leaf][a]: the body's order in the direction along which the axis runs mostly, if that is below the body's
   highest; (*cap)[num_leaves][3] is to be freed by the caller, NULL where no body has a lower order in a direction. */
PetscErrorCode ProblemOrderCaps(const SceneData *, Forest, int8_t (**cap)[3]);

/* Collective. Scene data and forest must outlive the problem. */
PetscErrorCode ProblemCreate(const SceneData *, Forest, const int8_t leaf_order[], Problem *);
PetscErrorCode ProblemDestroy(Problem *);
/* MechanicsFindInverted over all ranks. Collective. */
PetscErrorCode ProblemFindInverted(Problem, PetscInt *order, PetscReal X[3], PetscInt *leaf);
/* MechanicsFindFolded of the displacements of x over all ranks, folded[num_leaves]. Collective. */
PetscErrorCode ProblemFindFolded(Problem, Vec x, int8_t folded[]);
/* MechanicsFindConflict over all ranks. Collective. */
PetscErrorCode ProblemFindConflict(Problem, PetscReal t, size_t size, char words[]);

const SceneData *ProblemGetScene(Problem);
Forest           ProblemForest(Problem);
HPSpace          ProblemSpace(Problem);
Mechanics        ProblemMechanics(Problem);
PetscErrorCode   ProblemCreateVector(Problem, Vec *);
PetscErrorCode   ProblemGetMatrix(Problem, Mat *);

/* Copies of a state's history, which residual and tangent start from, of its element pressures, for stress at points, and of its form. Whoever is given a
   state of this problem sets it. Collective. */
PetscErrorCode ProblemSetState(Problem, const State *);
/* Residual and tangent are those of this form from now on, until another one or a state is set. Not collective. */
PetscErrorCode ProblemSetForm(Problem, const Form *);

/* Prescribed motion: SetTime fixes the target; Jump applies it at once (no lift); otherwise the part not yet applied enters the next linear solve. */
PetscErrorCode ProblemSetTime(Problem, PetscReal t);
/* turn.c. Where supports go from where they are in x to where they are at the time last set by one rigid motion with a rotation: x is moved by it, and nothing
   of the motion is left to be put in. Collective. */
PetscErrorCode ProblemTurn(Problem, Vec x, PetscBool *turned);
/* rolling.c: the largest angle (radians) by which bodies that press on each other with friction turned against each other, not about the normal, from
   displacements `from` (local array) to the solution x evaluated last. 0 with small kinematics, axisymmetric, or without friction. Collective. */
PetscErrorCode ProblemRolls(Problem, const PetscReal from[], Vec x, PetscReal *angle);
PetscErrorCode ProblemJump(Problem);
/* How fast dead loads and follower pressures at x change from the time last set on: as a multiple of their mean change by t on the way there, 0 where they
   stay. Loads on rigid bodies are not looked at. Collective. */
PetscErrorCode ProblemLoadSpeed(Problem, Vec x, PetscReal *speed);

/* Viscous forces against the deformation since x = from, with the prescribed motion as applied now (MechanicsSetViscosity; rate 0: none, from NULL); the energy
   that they dissipate on the way to x. Collective. */
PetscErrorCode ProblemSetViscosity(Problem, PetscReal rate, Vec from);
PetscErrorCode ProblemViscousWork(Problem, Vec x, PetscReal *work);

/* Are pressures of incompressible cells among the unknowns? Then neither condensation nor multigrid is to be had. */
PetscBool ProblemIsIncompressible(Problem);
/* Set them in x: those of this rank's cells, as MechanicsSetPressure takes them. */
PetscErrorCode ProblemSetPressures(Problem, const PetscReal pressure[], Vec x);

/* Local displacement array (Cartesian frames applied only through HPSpaceGather): free dofs from x, prescribed dofs as applied so far. local[num_nodes*dim].
   The scalars of x and its element pressures act from now on. Collective. */
PetscErrorCode ProblemLocalDisplacement(Problem, Vec x, PetscReal local[]);
/* Write a local array's free dofs into x (owned entries). */
PetscErrorCode ProblemSetDisplacement(Problem, const PetscReal local[], Vec x);

/* ---- scalars (scalar.c) and the path of equilibria (path.c) ------------------------------------------------------------------ */

PetscInt       ProblemNumScalars(Problem);
PetscErrorCode ProblemGetScalars(Problem, Vec x, PetscReal values[]); /* on all ranks. Collective. */
PetscErrorCode ProblemSetScalars(Problem, const PetscReal values[], Vec x);
/* Of the boundaries of MechanicsGetControls: the pressure found, and what it follows, in the unit of its target (change of volume, mean displacement).
 * Collective. */
PetscErrorCode ProblemGetControls(Problem, Vec x, PetscReal pressure[], PetscReal value[]);

/* Root mean square of the change of displacement dofs between two states (from NULL: the reference). Collective. */
PetscErrorCode ProblemDistance(Problem, Vec from, Vec to, PetscReal *distance);
/* load.control: arc_length. Time is an unknown: of the state it is as set (Hold; the start), or found such that the state lies on a plane across the
   direction from -> to, through `to` (Follow) or further by `advance` (Advance). *length: of the way from -> to. Collective. */
PetscErrorCode ProblemFollow(Problem, Vec from, Vec to, PetscReal *length);
void           ProblemAdvance(Problem, PetscReal advance);
/* The direction of the path that is followed, borrowed, NULL: none is; and to follow it from `to` on in another problem of the same mesh. Collective. */
void           ProblemGetPath(Problem, Vec *direction);
PetscErrorCode ProblemFollowAlong(Problem, Vec direction, Vec to);
void           ProblemHold(Problem);
PetscBool      ProblemIsFollowing(Problem);
/* Time of a state: its unknown, or as set. Collective. */
PetscErrorCode ProblemGetTime(Problem, Vec x, PetscReal *t);

/* ---- contact (interface.h) ---------------------------------------------------------------------------------------------------- */

/* All contact pairs of the problem. Not collective. */
Interface ProblemInterface(Problem);
/* InterfaceSetPattern; the matrix is made anew when next asked for. Not collective. */
PetscErrorCode ProblemSetPattern(Problem, PetscInt pair, const PetscInt first[], const PetscInt node[]);
/* The candidate search at x; between Newton iterations only. */
PetscErrorCode ProblemSearch(Problem, Vec x);
/* The same, going on from the one that ProblemStepBegin kept (ContactPairGoOn): at the trial steps from one iterate. */
PetscErrorCode ProblemSearchOn(Problem, Vec x);

/* ---- residual and tangent --------------------------------------------------------------------------------------------------- */

typedef struct {
  PetscReal energy;  /* strain energy */
  PetscReal min_det; /* smallest det F */
  PetscReal volume;  /* largest coefficient of g(J) in incompressible cells: their change of volume */
  PetscReal scale;   /* root of the summed squared nodal forces of cells and loads: the residual is small against it */
  PetscReal largest; /* displacement component */
  PetscReal noise;   /* level of round-off in the residual: no Newton step gets below */
  PetscBool bad;     /* outside the domain: det F <= 0 or a failed projection */
} ProblemStatus;

/* R(x) with the prescribed motion as applied and the history last set, with these element pressures (NULL: those that x implies). Deterministic function of
   both. Collective; status is the same on every rank. */
PetscErrorCode ProblemResidual(Problem, Vec x, const PetscReal pressure[], Vec r, ProblemStatus *);
/* Views of contact show the last evaluation: make it that of x. Collective. */
PetscErrorCode ProblemRefresh(Problem, Vec x);
/* Static condensation, chosen once, before the matrix is made: the matrix and its right-hand side leave out the unknowns of nodes inside cells; vectors of
   the problem keep them. Collective. */
PetscErrorCode ProblemSetCondense(Problem);
/* A vector of the matrix: right-hand side, lift, solution. */
PetscErrorCode ProblemCreateRightSide(Problem, Vec *);
/* dx = y, multipliers in the unit of pressures (the symmetric form has them over E/h), and the solution at nodes inside cells where they are condensed (with
   the lift of the last tangent). Collective. */
PetscErrorCode ProblemRecover(Problem, Vec y, Vec dx);
/* dR/dx, as far as the form does not say otherwise, with the stored element pressures in the geometric stiffness (NULL: consistent). When lift is given, the
   change of R that the remaining prescribed motion makes to first order is added to it. Assembles the problem's matrix. Collective. */
PetscErrorCode ProblemTangent(Problem, Vec x, const PetscReal pressure[], Vec lift, PetscBool *bad);
/* Symmetric form of the tangent: same solution, symmetric matrix, right-hand side by ProblemRightSide; its multiplier columns are exact to second order.
   Only for problems whose bulk tangent is symmetric (ProblemIsSymmetric): no follower pressures, no plastic flow, no scalars; and where no active constraint
   holds the rim of a mortar side (ContactFacet.push). Get: was the last tangent in it? */
PetscBool ProblemGetSymmetric(Problem);
PetscBool ProblemIsSymmetric(Problem);
/* Would it be, if this material had a symmetric tangent? */
PetscBool ProblemIsSymmetricBut(Problem, const MaterialSpec *);
/* The symmetric part of dR/dx at a solution x, without friction; its lowest eigenvalue is not above the real part of any of dR/dx. Into the problem's
   matrix, with shift times the largest entry of each row of displacements on its diagonal. *is_there: not where a constraint holds the rim of a mortar side.
   Collective. */
PetscErrorCode ProblemSymmetricPart(Problem, Vec x, const PetscReal pressure[], PetscReal shift, PetscBool *is_there);
/* The largest entry of each row of displacements of its matrix A, 0 for all others. Collective. */
PetscErrorCode ProblemRowScale(Problem, Mat A, Vec scale);
/* rhs = -(r + lift), condensed like the last tangent, multiplier rows in its form; r of the problem, lift and rhs of the matrix. */
PetscErrorCode ProblemRightSide(Problem, Vec r, Vec lift, Vec rhs);
/* Active-set passes against the last tangent: given the solution dx of tangent . dx = -rhs, decide anew which constraints are active, rewrite their rows in the
   matrix and the right-hand side: of all nodes whose state disagrees with dx, or of one of them. *disagree: how many do (all ranks). Collective. */
PetscErrorCode ProblemSwitchActiveSet(Problem, Vec dx, SwitchRule, Vec rhs, PetscInt *disagree);
/* ---- what a form may be chosen by, at the last residual. All collective ---- */

/* As InterfaceMayFreezeSegmentation. Under viscous regularisation: no. */
PetscErrorCode ProblemMayFreezeSegmentation(Problem, PetscBool any, PetscBool *yes);
/* At the start of a step, where dx is the linear step there: would most points on their yield surface leave it? */
PetscErrorCode ProblemUnloads(Problem, Vec x, Vec dx, PetscBool *yes);

/* Work of the forces r on the displacements of dx and on motions of rigid bodies that are found, those of prescribed motion not counted. Collective. */
PetscErrorCode ProblemWork(Problem, Vec r, Vec dx, PetscReal *work);

/* A Newton step: Begin remembers where it starts; Move sets x = start + step dx and the prescribed motion likewise (may be called again with a shorter step),
   whole: all but displacements to the end of the step, and refreshes the contact search; Accept updates the element pressures for the step taken. */
PetscErrorCode ProblemStepBegin(Problem, Vec x, Vec dx);
PetscErrorCode ProblemStepMove(Problem, Vec dx, PetscReal step, PetscBool whole, Vec x);
PetscErrorCode ProblemStepAccept(Problem, PetscReal step, PetscReal pressure[]);
/* worst.c. The node at which the residual r is largest: reference position, its body (-1: a node of the pair's nonmortar side), a pair one of whose sides it is
   on (contact, -1: none). Inverted: the middle of a cell that x inverts, and its body. Collective. */
typedef struct {
  PetscBool known, inverted;
  PetscReal X[3];
  PetscInt  body, pair;
} ProblemPlace;
PetscErrorCode ProblemFindWorst(Problem, Vec r, ProblemPlace *);
PetscErrorCode ProblemFindInvertedAt(Problem, Vec x, ProblemPlace *);
/* The body of a true local node, -1: no cell of this rank depends on it. Not collective. */
PetscInt ProblemNodeBody(Problem, PetscInt node);
/* Largest part of the prescribed motion not yet applied, in the user's unit of length; 0 when the target is reached. */
PetscErrorCode ProblemPending(Problem, PetscReal *remaining);

/* overlap.c. How deep the sides of pairs are in each other at x, at most (unit: length). Leave: from now on one side of each pair lies further in by this share
   of its own; as created, and after Note: 0. Collective. */
PetscErrorCode ProblemNoteOverlap(Problem, Vec x, PetscReal *deepest);
void           ProblemLeaveOverlap(Problem, PetscReal share);

/* energy.c. The augmented Lagrangian Phi(u; lambda), with penalties kappa_j = factor c_j. HasEnergy: is there one? Not with follower loads, plastic flow,
   pressures among the unknowns, small kinematics, viscous regularisation. Not collective. */
PetscBool ProblemHasEnergy(Problem);
/* Phi at the displacements of x and the prescribed motion as applied, and its gradient (NULL: not wanted; 0 but for displacements). lambda: multipliers, in a
   vector of the problem whose other entries are not looked at. The multipliers of x become max(0, lambda_j - kappa_j g_j). merit: the largest number where
   status->bad. Collective. */
PetscErrorCode ProblemMerit(Problem, PetscReal factor, Vec lambda, Vec x, Vec gradient, PetscReal *merit, ProblemStatus *status);
/* The Hessian of Phi as a matrix that has it for its Schur complement (symmetric; the multipliers' block is negative definite), at x as ProblemMerit left it,
   into the problem's matrix. With lift: of the bodies alone, without contact, and in lift the forces of the prescribed motion still to come. Collective. */
PetscErrorCode ProblemMeritTangent(Problem, PetscReal factor, Vec x, Vec lift, PetscBool *bad);
/* rhs = -(gradient + lift) of that matrix (lift NULL: none); dx from its solution y. Collective. */
PetscErrorCode ProblemMeritSide(Problem, Vec gradient, Vec lift, Vec rhs);
PetscErrorCode ProblemMeritRecover(Problem, Vec y, Vec dx);

/* Forces of the supports in a state, which is set: reaction[num_boundaries][3], their moments support[num_boundaries][3], forces and moments on rigid bodies
   body[num_bodies] (MechanicsMoments); body NULL: none of these; contact force and moment about the origin on the nonmortar side:
   force[num_contacts][3], moment[num_contacts][3]; all ranks. Evaluates the residual. */
PetscErrorCode ProblemForces(Problem, const State *, PetscReal reaction[][3], PetscReal support[][3], Resultant body[], PetscReal force[][3],
                             PetscReal moment[][3], ProblemStatus *);
/* Displacement dofs and multipliers of this rank, in that order in its part of the matrix; dimension. Not collective. */
void ProblemGetBlocks(Problem, PetscInt *num_u, PetscInt *num_z, PetscInt *dim);
/* For multigrid methods, the space of order 1 on the same mesh in whole blocks: interpolation from the dofs of all vertices that have a free one (dim of each)
   to the displacement dofs of this problem; ones on the diagonal of the prescribed ones among them; their rigid-body modes; are there nodes
   that are no vertices? Collective. */
PetscErrorCode ProblemProlongation(Problem, Mat *prolongation, Mat *pinned, MatNullSpace *modes, PetscBool *higher);
/* Negative eigenvalues of the matrix in its symmetric form at a stable equilibrium: one for each constraint (pressures of contact, open or not, and of
   incompressible cells), less those that condensation met at the last tangent. Collective. */
PetscErrorCode ProblemNumNegative(Problem, PetscInt *num);
/* Sign of the determinant of the exact matrix at a stable equilibrium: rows of multipliers and of rigid bodies add factors above zero, those of pressures
   below. 0: not known, with rows of controls. Collective. */
PetscErrorCode ProblemStableSign(Problem, PetscInt *sign);
PetscInt       ProblemNumDofs(Problem); /* global: u, z and pi */
/* Is there a body that supports do not hold? Not collective. */
PetscBool ProblemHasFreeBody(Problem);
/* Axes along which no support holds the body or any that is joined to it: bit c for axis c; turns: it is held along all, and can turn. Not collective. */
PetscErrorCode ProblemFreeAxes(Problem, PetscInt body, PetscInt *axes, PetscBool *turns);
