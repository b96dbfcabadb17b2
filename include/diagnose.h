/* Floor 7. What a run prints: header, a line per adaptive pass and load step, progress bar. */
#pragma once
#include "problem.h"

/* Figures of one pass or accepted step, also the rows of adapt.csv and history.csv. */
typedef struct {
  PetscInt  step, pass, cells, dofs, newton_iterations, active_nodes, step_cuts;
  PetscReal t, dt, estimated_error, energy, min_det, min_gap, contact_force, seconds, force_imbalance, moment_imbalance;
  PetscBool accepted;
} ReportRow;

typedef struct _p_Monitor *Monitor;
PetscErrorCode MonitorCreate(MPI_Comm, const SceneData *, Monitor *);
PetscErrorCode MonitorHeader(Monitor, Problem);              /* version, scene, model, cells, dofs, ranks */
PetscErrorCode MonitorRow(Monitor, const ReportRow *);       /* one line; on a terminal a bar with the time left below it */
PetscErrorCode MonitorDestroy(Monitor *);
