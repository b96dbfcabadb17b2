/* Floor 9. What a run could have left out of its model, told at its end (docs/needs.md). */
#pragma once
#include "output.h"

/* A run that has come to its end, at the last accepted state. Borrowed. */
typedef struct {
  MPI_Comm         comm;
  const SceneData *data;
  Level           *level;
  const Path      *path;
  const Balance   *balance;
  const Estimate  *estimate;       /* NULL: there was none */
  const PetscInt  *touched;        /* by ContactSpec.pair: load step in which it was in contact first; 0: none */
  const PetscBool *mirror;         /* [3] planes of symmetry that are not used (NeedsFindMirrors) … */
  const PetscReal *mirror_at;      /* [3] … and where they are */
  PetscReal        most_energy;    /* stored at the end of an accepted load step */
  PetscReal        seconds, later; /* the last: in the first solutions of load steps but the first */
  PetscInt         load_steps, adapt_passes;
} NeedsRun;

/* Rows of `needs`, which is empty; and away with them. Collective. */
PetscErrorCode NeedsFind(const NeedsRun *, Needs *needs);
PetscErrorCode NeedsDestroy(Needs *);
/* Middle planes of the mesh across each axis that mesh, supports and loads are symmetric about and no cell straddles; of the forest as it begins. Not
   collective. */
PetscErrorCode NeedsFindMirrors(const SceneData *, Forest, PetscBool mirror[3], PetscReal at[3]);
