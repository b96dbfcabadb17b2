/* Stages: what -log_view and summary.json know of where the time goes. */
#include "base.h"

const char *const StageNames[NUM_STAGES] = {"mesh", "setup", "assemble", "condense", "contact", "factor", "solve", "estimate", "transfer", "output"};

static PetscLogEvent  stage_event[NUM_STAGES];
static PetscLogDouble stage_start[NUM_STAGES], stage_seconds[NUM_STAGES];
static PetscInt       stage_depth[NUM_STAGES]; /* a stage inside itself counts once */
static PetscBool      stage_registered;

/* Registers the events of -log_view; without it the seconds still accumulate. Calling twice is harmless. */
PetscErrorCode StageRegister(void)
{
  PetscClassId class_id;

  PetscFunctionBegin;
  if (stage_registered) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscClassIdRegister("mortise", &class_id));
  for (PetscInt s = 0; s < NUM_STAGES; s++) {
    char name[MORTISE_NAME];

    PetscCall(PetscSNPrintf(name, sizeof(name), "mortise_%s", StageNames[s]));
    PetscCall(PetscLogEventRegister(name, class_id, &stage_event[s]));
  }
  stage_registered = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageBegin(Stage stage)
{
  PetscFunctionBegin;
  if (stage_registered) PetscCall(PetscLogEventBegin(stage_event[stage], NULL, NULL, NULL, NULL));
  if (stage_depth[stage]++ == 0) PetscCall(PetscTime(&stage_start[stage]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageEnd(Stage stage)
{
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCheck(stage_depth[stage] > 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Stage %s ends before it begins", StageNames[stage]);
  if (stage_registered) PetscCall(PetscLogEventEnd(stage_event[stage], NULL, NULL, NULL, NULL));
  if (--stage_depth[stage] == 0) {
    PetscCall(PetscTime(&now));
    stage_seconds[stage] += now - stage_start[stage];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wall seconds on this rank, closed intervals only. */
PetscReal StageSeconds(Stage stage)
{
  return (PetscReal)stage_seconds[stage];
}

PetscErrorCode StageAdd(Stage stage, PetscReal seconds)
{
  PetscFunctionBegin;
  stage_seconds[stage] += seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}
