/* Floor 7. Figures of a state (balances of force and moment, zones of contact) and what a run prints. The files of a run (output, floor 8) report the same
   figures, so that screen, tables and summary agree. */
#pragma once
#include "estimate.h"

/* ---- figures of a state (diagnose/balance.c, zone.c) ------------------------------------------------------------------ */

/* One contact pair; sides: 0 nonmortar, 1 mortar, as the scene names them (ContactSpec.exchanged). In two dimensions forces have two components and moments
 * one, the last (about z). */
typedef struct {
  PetscReal       force[2][3];      /* total contact force on each side; axisymmetric: over the full revolution */
  PetscReal       moment[2][3];     /* its moment about ContactSpec.about, in the current configuration (small kinematics: the reference) */
  PetscReal       total;            /* sum of |nodal forces| of the nonmortar side */
  PetscReal       force_imbalance;  /* |sum over both sides| / total; 0 without contact */
  PetscReal       moment_imbalance; /* |sum over both sides| / (total * diameter of the nonmortar side) */
  PetscReal       max_pressure;     /* largest multiplier */
  PetscReal       area;             /* in contact: sum of the tributary lengths (areas) of active nodes */
  PetscReal       radius;           /* two dimensions: largest |x| of a touching point, see BalanceZone; three: of a circle of this area; 0 without contact */
  PetscReal       min_gap, max_gap; /* over covered nodes, gt_j / w_j; negative: penetration. 0 when nothing is covered */
  PetscInt        stabilised;       /* facets whose multipliers are stabilised (ContactView) */
  PetscInt        unusable;         /* overlaps that could not be used (ContactView) */
  PetscReal       adjusted;         /* largest initial gap that was closed at a node (initial_gap: adjust) */
  PetscInt        active_nodes, covered_nodes;
  PetscBool       tied;     /* max_pressure: of the traction; area: at the reference positions; what tells of a zone, and of gaps, is 0 */
  FrictionFigures friction; /* of the step */
} PairFigures;

typedef struct {
  PetscInt num_boundaries, num_contacts, num_bodies;
  PetscReal (*reaction)[3]; /* owned [num_boundaries] force of each support on the body */
  PetscReal (
      *support_moment)[3]; /* owned [num_boundaries] its moment about BoundarySpec.about, current positions (small kinematics: reference); space, plane */
  PetscReal (*motion)[6];  /* owned [num_bodies] displacement of BodySpec.about of rigid bodies, and rotation vector, degrees; else 0 */
  Resultant   *body;       /* owned [num_bodies] force and moment on rigid bodies (MechanicsMoments), else 0 */
  PetscReal   *pressure, *control; /* owned [num_boundaries] where a pressure is found: it, and what it follows (change of volume, mean advance); else 0 */
  PairFigures *pair;               /* owned [num_contacts] as the scene names them, parts (ContactSpec) together */
  PetscReal    load[3];            /* resultant of dead loads, body forces and follower pressures; axisymmetric: the axial component, others 0 */
  PetscReal    force_imbalance;    /* largest of the pairs (O-90) */
  PetscReal    moment_imbalance;   /* largest of the pairs (O-90) */
  PetscReal    support_imbalance;  /* |supports + loads + contact with rigid bodies| over the sum of their magnitudes, or of those of nodal forces
                                      (ProblemStatus.scale) where that is more; axisymmetric: axial component */
  PetscReal     plastic_strain;    /* largest at an integration point */
  PetscReal     plastic_work;      /* int int k(alpha) dalpha dV: what plastic flow took so far; 0 without plastic materials, like the strain */
  PetscReal    *mean_strain;       /* owned [num_bodies] int alpha dV / int dV over the reference volume of each body; 0 where the material does not flow */
  ProblemStatus status;
} Balance;

/* Figures at a state of this problem, the same on every rank. Evaluates the residual. Collective. */
PetscErrorCode BalanceCompute(Problem, const State *, Balance *);
/* Has the body a law with plastic flow, and has none of it ever flowed? Plastic strain only grows, so the last state tells of all before. Not collective. */
PetscBool      BalanceStaysElastic(const Balance *, const MechanicsSpec *, PetscInt body);
PetscErrorCode BalanceDestroy(Balance *);
/* What adaptation changed, from one state to another at the same load, relative to the first (0 where that is 0): root of the summed squared differences of
   reactions and of the pairs' totals (reactions of a closed boundary cancel, totals do not), plastic work, largest plastic strain. The finer mesh's gain and
   the loss on the way to it are both in these. */
void BalanceChange(const Balance *from, const Balance *to, PetscReal change[3]);
/* The zone of contact alone: max_pressure to covered_nodes above, from the tables of a view: each rank its own nodes, then over the ranks of comm. Collective.
   radius: the zone ends between its last active node and the next one. There the square of the pressure is extended linearly to zero (the pressure between
   smooth bodies falls with the root of the distance), at most to the next node; where it does not fall, the zone ends in the middle of the edge. */
PetscErrorCode BalanceZone(MPI_Comm comm, const ContactView *, PairFigures *);

/* ---- surfaces that pass through themselves (diagnose/passage.c) ---------------------------------------------------------- */

typedef struct {
  PetscReal depth;   /* of what lies behind the surface; 0: nothing does */
  PetscReal x[3];    /* about there */
  PetscInt  body[2]; /* bodies of one part: one body, or two that are joined */
  PetscInt  pair;    /* a contact of the scene that has one of both facets there, -1: none */
  PetscBool none;    /* of PassageFindApart: all parts may meet each other, and will */
  PetscBool whole;   /* the first lies wholly inside the second; no surface crosses, and there is no depth */
  PetscReal box[6];  /* around all facets that cut others */
} Passage;

/* The deepest place at a state, which the problem stands at, the same on every rank. Rigid bodies and the sides of a contact pair, which contact keeps apart,
   are left out; group not negative: only facets of this boundary group are looked at. O(n log n) for n outer facets, on the rank that has them. Collective. */
PetscErrorCode PassageFind(Problem, const State *, PetscInt group, Passage *);
/* The same where bodies that hang together nowhere pass through each other, or lie inside each other, and no contact pair is between them; not both rigid. */
PetscErrorCode PassageFindApart(Problem, const State *, Passage *);

/* inside.c: the first contact pair that bears nothing though its bodies lie inside each other, deeper than a facet is long and not so at the reference
   positions, or of one surface that passes through itself so that a facet of it lies wholly inside; -1: there is none. *still: the first one whose
   bodies do and did so at the reference positions, -1. Looked at are the pair's own facets, or the whole boundaries of its bodies: sides that passed each other
   in the mesh lie inside neither. At the state that was evaluated last. Finite kinematics. Collective. */
PetscErrorCode InsideFind(Problem, const State *, PetscBool whole, PetscInt *pair, PetscInt *still);

/* through.c: the first contact pair that bears nothing of which a body went right through the other one on straight ways from displacements `from` (local
   array) to the state; -1: there is none. At the state that was evaluated last. Finite kinematics. Collective. */
PetscErrorCode ThroughFind(Problem, const PetscReal from[], const State *, PetscInt *pair);

/* adrift.c: axes[body], as bits: those along which no support holds a body, nor the bodies that contact presses it on, nor those that hold them. At the state
   evaluated last; scale: the largest ProblemStatus.scale of the path, against which forces are round-off. Collective. */
PetscErrorCode AdriftFind(Problem, PetscReal scale, PetscInt axes[]);

/* thrown.c: the first body that nothing holds along an axis and that moved along it, from displacements `from` (local array) to the state, farther than its own
   size and what is held moved at most; -1: there is none. At the state that was evaluated last; scale: its ProblemStatus.scale. Collective. */
PetscErrorCode ThrownFind(Problem, const PetscReal from[], const State *, PetscReal scale, PetscInt *body);

/* Cells of deformable bodies with det F <= 0 at a corner (of the section, where it is plane or axisymmetric). */
typedef struct {
  PetscInt  num, body; /* how many; body of the worst */
  PetscReal det, X[3]; /* least det F at a corner, and where, at the reference position */
} Folded;

/* folded.c: at a solution x, the same on every rank; leaf[num_leaves]: those of these cells (NULL: not wanted). Means nothing with small kinematics.
   Collective. */
PetscErrorCode FoldedFind(Problem, Vec x, Folded *, int8_t leaf[]);

/* Figures of one pass or accepted step, also the rows of adapt.csv and history.csv. */
typedef struct {
  PetscInt  step, pass, cells, dofs;
  PetscInt  newton_iterations; /* on the way to this row: of one pass; in history.csv of the whole step */
  PetscInt  active_nodes;
  PetscInt  step_cuts;  /* of this step so far */
  PetscInt  set_cycles; /* active sets that repeated on the way to this row */
  PetscReal t, dt, estimated_error /* relative; NaN: not estimated */, estimate /* absolute */, energy, min_det, min_gap, contact_force, seconds;
  PetscReal force_imbalance, moment_imbalance, support_imbalance;
  PetscBool frozen_segmentation; /* of the state (Form) */
  PetscInt  modifiers;           /* interventions of Newton's modifiers on the way to this row */
  PetscInt  factorisations;      /* of the run (MonitorFooter) */
  PetscReal viscous_work;        /* energy that viscous regularisation dissipated in this step */
  PetscReal plastic_strain, plastic_work;
  PetscReal force_change, work_change, strain_change; /* by the adaptation before this pass, at the same load: see BalanceChange */
  PetscBool accepted;
} ReportRow;

/* Fill what problem, state, estimate (NULL: none) and balance know: t, cells, dofs, active_nodes, estimated_error, estimate, energy, min_det, min_gap,
   contact_force (sum of the magnitudes over pairs), imbalances, plastic_strain, plastic_work. The rest is the caller's. Not collective. */
PetscErrorCode ReportRowFill(Problem, const State *, const Estimate *, const Balance *, ReportRow *);

/* ---- what a run prints (diagnose/monitor.c) -------------------------------------------------------------------------- */

typedef struct _p_Monitor *Monitor;
/* Decides whether standard output is a terminal of this run's first rank; starts the clock. Collective. */
PetscErrorCode MonitorCreate(MPI_Comm, const SceneData *, Monitor *);
PetscErrorCode MonitorHeader(Monitor, Problem); /* version, scene, model, cells, dofs, ranks; names of the columns */
/* The run goes on from a file: step, step_cuts, newton_iterations (of the whole run), t and seconds so far. */
PetscErrorCode MonitorResume(Monitor, const char *file, const ReportRow *so_far);
/* The path of loads begins again, for the number-th time, on a finer mesh; error: the largest estimate of the one before. */
PetscErrorCode MonitorAgain(Monitor, PetscInt number, PetscInt cells, PetscReal error);
PetscErrorCode MonitorRow(Monitor, const ReportRow *); /* one line; on a terminal a bar with the time left below it */
/* What was computed, estimated error, where results are. status as in summary.json; reason may be empty; checkpoint: one was written; total: step, t,
   newton_iterations, step_cuts and seconds of the whole run, with those of attempts that failed; last accepted row, NULL: none. */
PetscErrorCode MonitorFooter(Monitor, const char *status, const char *reason, const char *adapt_stop, PetscBool checkpoint, const ReportRow *total,
                             const ReportRow *last);
PetscErrorCode MonitorDestroy(Monitor *);
