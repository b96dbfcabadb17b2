/* Private to problem. */
#pragma once
#include "problem.h"

/* An unknown of a rigid body that forces move: body (place among the links), place in RigidLink.row, value, force that holds it, load at the time set. */
typedef struct {
  PetscInt  link, motion;
  PetscReal q, force, load;
} RigidUnknown;

struct _p_Problem {
  const SceneData *scene;
  Forest           forest;
  MPI_Comm         comm;
  PetscMPIInt      rank, size;
  PetscInt         dim;
  HPSpace          space;
  const HPTables  *tables;    /* of the space */
  PetscInt         num_local; /* length of a local array, num_nodes * dim */
  Supports         supports;
  Mechanics        mechanics;
  Interface        interface;
  int8_t          *leaf_order;

  /* layout */
  PetscInt   num_u, num_z, start; /* this rank's displacement dofs and multipliers, first index */
  PetscInt  *u_start, *p_start;   /* [size+1] ranges of the space's and the problem's numbering */
  PetscInt  *index;               /* [num_nodes*dim] local dof -> problem index or -1 */
  PetscBool  condensed;           /* the matrix knows no unknowns inside cells */
  PetscInt   num_inner;           /* those of this rank, the first of its vector; 0: not condensed */
  PetscInt   num_rows, first_row; /* of the matrix on this rank: num_u + num_z - num_inner */
  PetscInt  *row_start;           /* [size+1] ranges of the matrix's rows */
  PetscInt  *row;                 /* [num_nodes*dim] local dof -> row of the matrix or -1 */
  Vec        u_global, u_local, r_local, prototype;
  PetscReal *target, *applied; /* [num_nodes*dim] prescribed values */
  PetscReal *increment;        /* [num_nodes*dim] of the Newton step under discussion */
  PetscReal *start_applied;    /* [num_nodes*dim] applied where the Newton step starts */
  Vec        start_x;
  PetscInt   num_dofs;

  /* pressure.c: unknown pressures, behind the multipliers; of local cells, as MechanicsSetPressure takes them */
  PetscInt     num_pi, pi_first;  /* this rank's, and where they begin in its part of the vector */
  PetscInt    *pi_index, *pi_row; /* [local unknowns] problem index, row of the matrix */
  PetscMPIInt *pi_rank;           /* [local unknowns] owner */
  PetscReal   *pi_scale;          /* [num_pi] factor of the residual's row against that of the symmetric form, at the last tangent */
  Vec          pi_local;          /* values of all local unknowns; NULL: no rank has any */
  VecScatter   pi_scatter;

  /* scalar.c, path.c: unknowns that belong to no node */
  PetscInt     num_scalars, num_controls; /* the last of the vector and of the matrix: pressures found, then pseudo-time where a path is followed */
  PetscInt     num_rigid, num_links;      /* rigid.c: unknowns of rigid bodies, between controls and pseudo-time; such bodies */
  RigidUnknown rigid[INTERFACE_MOTIONS];
  RigidLink    links[INTERFACE_LINKS];
  PetscReal    rigid_arms[INTERFACE_LINKS][9], rigid_shift; /* sum of (x - c) r^T over the nodes of a body, at the last residual; see SHIFT */
  int8_t      *node_link;                                   /* owned [num_nodes] body that a local node is of, -1: none */
  PetscReal   *scalar;                                      /* [num_scalars] of the vector last seen */
  PetscReal   *factor, *norm, *measure;                     /* [num_controls] of the rows; of the target; what is followed, at the last residual */
  PetscReal    extent, path_start, path_advance;            /* of all bodies; place of the last state along `path`, and how far from there */
  PetscBool    following;                                   /* along the path; else time is as set */
  Vec          path;                                        /* (u1 - u0) / (|u1 - u0| sqrt(N)), 0 but for displacements */

  Mat              matrix;
  ptrdiff_t       *scatter_first; /* [num_owned_cells] where a cell's places start in scatter, -1: it goes by MatSetValues */
  uint16_t        *scatter;       /* scatter.c */
  PetscObjectState scatter_state; /* pattern the places belong to */
  Form             form;
  PetscBool        symmetric; /* the last tangent is in the symmetric form */
  PetscBool        viscous;   /* there are viscous forces (ProblemSetViscosity) */
  Vec              lift;      /* of the tangent being made; NULL: not wanted */
  PetscReal        t;
  RowBuffer        work;
};

PetscErrorCode ProblemLayout_Private(Problem);
/* scalar.c. Create: before the layout. Read: from a vector to where they act. Measure: what controls follow at the local displacements u. Residual: their rows
   in the rank's part r of the residual, after Read and Measure. Pattern, Tangent: their rows and columns. Column: a local array as column of scalar k. All
   collective. */
PetscErrorCode ScalarsCreate_Private(Problem);
PetscErrorCode ScalarsDestroy_Private(Problem);
PetscErrorCode ScalarsRead_Private(Problem, Vec x);
PetscErrorCode ScalarsMeasure_Private(Problem, const PetscReal u[]);
PetscErrorCode ScalarsResidual_Private(Problem, Vec x, PetscReal r[]);
PetscErrorCode ScalarsPattern_Private(Problem, PetscInt diagonal[], PetscInt other[]);
PetscErrorCode ScalarsTangent_Private(Problem, const PetscReal u[]);
PetscErrorCode ScalarsColumn_Private(Problem, PetscInt k, const PetscReal local[]);
/* rigid.c. SetRows: its unknowns have the rows from `first` on. Read: values. Move: what they add to the displacements of a local array. Increment: dx = G dq,
   added. Measure: forces that hold the bodies, r a local array of this rank's forces. Tangent: diagonal. Collective. */
PetscErrorCode RigidCreate_Private(Problem);
PetscErrorCode RigidSetRows_Private(Problem, PetscInt first);
PetscErrorCode RigidSetTime_Private(Problem); /* loads */
PetscErrorCode RigidRead_Private(Problem, const PetscReal q[]);
void           RigidMove_Private(Problem, PetscReal local[]);
void           RigidIncrement_Private(Problem, const PetscReal dq[], PetscReal local[]);
PetscErrorCode RigidMeasure_Private(Problem, const PetscReal r[]);
PetscErrorCode RigidTangent_Private(Problem);
PetscReal      RigidWork_Private(Problem, const PetscReal r[], const PetscReal dq[]); /* of their rows on changes of these unknowns */
PetscBool      RigidIsSymmetric_Private(Problem);                                     /* is their part of the tangent? */
/* scalar.c: place of the first of these unknowns in this rank's part of the vector; -1: another rank's. */
PetscInt RigidLocal_Private(Problem);
/* path.c: the equation of pseudo-time and its row and column. Collective. */
PetscErrorCode PathResidual_Private(Problem, Vec x, PetscReal *r);
PetscErrorCode PathTangent_Private(Problem, PetscInt row, const PetscReal u[]);
/* scatter.c: places of cells in the matrix as it stands, made when its pattern is new; add a cell's matrix there (*added false: it has no places). */
PetscErrorCode ProblemScatter_Private(Problem);
PetscErrorCode ProblemScatterAdd_Private(Problem, PetscInt cell, PetscInt num_dofs, const PetscInt dofs[], const PetscReal K[], PetscBool *added);
/* pressure.c: counts[rank] grow by the pressure unknowns; their indices, once the ranges of the ranks are known; their rows likewise. Collective. */
PetscErrorCode PressureNumber_Private(Problem, PetscInt counts[]);
PetscErrorCode PressureIndices_Private(Problem);
PetscErrorCode PressureRowNumbers_Private(Problem, const PetscInt inner[]);
PetscErrorCode PressureDestroy_Private(Problem);
/* Pressures of local cells from x to the mechanics. Collective. */
PetscErrorCode PressureSpread_Private(Problem, Vec x);
/* Entries of this rank's cells in the matrix: counted, or without counters written as explicit zeros. Columns of a cell in the rows of its nodes, appended. */
PetscErrorCode PressurePattern_Private(Problem, PetscInt diagonal[], PetscInt other[]);
PetscErrorCode PressureColumns_Private(Problem, PetscInt cell, PetscInt columns[], PetscInt *num);
/* Blocks of the last tangent (added), effect of the motion to come on the rows to the lift; right-hand side in the form of the rows. */
PetscErrorCode PressureBlocks_Private(Problem);
PetscErrorCode PressureSides_Private(Problem, Vec rhs);
/* condense.c: rows of the matrix from the layout. Collective. */
PetscErrorCode ProblemRows_Private(Problem);
/* The local array r_local, summed over ranks, as displacement part of a rank's part of a vector. */
PetscErrorCode ProblemToGlobal_Private(Problem, PetscReal array[]);
PetscErrorCode ProblemReduce_Private(Problem, Vec r, Vec rhs);
PetscErrorCode ProblemMatrix_Private(Problem);
/* clique.c: cliques of rows, of any rank's contact or cells with hanging nodes, that have rows of this rank; freed by the caller. Collective. */
PetscErrorCode ProblemCliques_Private(Problem, PetscInt *num, PetscInt **cliques);
/* increment (local array) = free dofs of dx + share of the prescribed motion still to come. */
PetscErrorCode ProblemIncrement_Private(Problem, Vec dx, PetscReal share);
/* tangent.c: the system at hand; the matrix with room for all of contact, zero; a cell's matrix into it (MatrixSink). */
InterfaceSystem ProblemSystem_Private(Problem);
PetscErrorCode  ProblemReadyMatrix_Private(Problem);
PetscErrorCode  ProblemCellSink_Private(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[]);
