/* Floor 4. The scene: one YAML file plus command-line overrides -> checked specs of the modules that consume them. Immutable after SceneSetUp. */
#pragma once
#include "contact.h"
#include "forest.h"
#include "mechanics.h"

typedef enum { LOAD_TIME, LOAD_ARC_LENGTH } LoadControl; /* steps of t; or along the path of equilibria, t being found */
typedef struct {
  PetscReal   end, step, step_min, step_max; /* pseudo-time */
  PetscInt    max_steps;
  LoadControl control;
  PetscBool   stable;            /* where an equilibrium is unstable, a stable one is looked for */
  PetscReal   stop_displacement; /* the run ends when a displacement component has reached this; 0: it does not */
} LoadSpec;

typedef enum { ADAPT_H, ADAPT_P, ADAPT_HP } AdaptStrategy;
typedef enum { REPEAT_STEP, REPEAT_PATH } AdaptRepeat; /* what is computed again on a finer mesh: the load step at hand, or all from t = 0 */
/* What new cells know of the load steps before; others than the first for comparison only. */
typedef enum { HISTORY_CARRIED, HISTORY_NEAREST, HISTORY_NONE } AdaptHistory;
typedef struct {
  PetscReal     tolerance; /* relative; 0: no adaptation */
  PetscInt      max_passes, max_cells;
  PetscReal     fraction;    /* Dörfler share of the squared estimate to mark */
  PetscReal     alike;       /* marking ends at the widest gap among leaves whose squared estimates differ by less than this share */
  PetscReal     coarsen;     /* cells below this share of the mean squared indicator may merge */
  PetscBool     anisotropic; /* split only in the directions that matter */
  PetscReal     share;       /* of the largest direction's squared estimate: a direction with less does not matter */
  PetscReal     aspect;      /* a split must not leave a cell more than this many times as long as its shortest edge */
  AdaptStrategy strategy;
  PetscInt      max_order; /* p, hp: no order above */
  AdaptRepeat   repeat;
  AdaptHistory  history;
} AdaptSpec;

/* Bits of OutputSpec.quantities: fields written on demand (output.h says what each is). */
enum { QUANTITY_STRETCHES = 1, QUANTITY_STRAIN = 2, QUANTITY_ENERGY = 4, QUANTITY_PIOLA = 8 };

typedef struct {
  char      directory[PETSC_MAX_PATH_LEN];
  PetscBool fields, segments; /* write fields.xdmf; write segments */
  int       quantities;       /* QUANTITY_..., of fields.xdmf */
  int       divide;           /* pieces of a cell in each direction; 0: as many as its order */
  PetscInt  checkpoint;       /* every so many load steps; 0: only when the run is stopped */
  PetscBool overwrite;        /* also files that no run has written */
} OutputSpec;

typedef struct {
  char      name[MORTISE_NAME];
  PetscReal X[3];
  char      body[MORTISE_NAME]; /* it is a point of this body; "": of any */
} ProbeSpec;

/* What results are labelled with; all empty: the scene does not say. */
typedef struct {
  char text[MORTISE_NAME]; /* as written */
  char length[16], force[16], stress[32];
} SceneUnits;

typedef struct {
  char          file[PETSC_MAX_PATH_LEN]; /* the scene file as given */
  char          title[256];
  SceneUnits    units;
  ForestSpec    mesh;
  PetscInt      num_refines;
  RefineSpec   *refines;
  MechanicsSpec mechanics;
  PetscInt      num_materials;
  MaterialSpec *materials;
  BodySpec     *bodies; /* in the order of the mesh's bodies */
  BoundarySpec *boundaries;
  PetscInt      num_contacts; /* parts of pairs, one for each colour of faces of the mortar side */
  ContactSpec  *contacts;
  LoadSpec      load;
  AdaptSpec     adapt;
  OutputSpec    output;
  PetscInt      num_probes;
  ProbeSpec    *probes;
} SceneData;

/* Contact pairs as the scene names them. */
static inline PetscInt SceneNumPairs(const SceneData *d)
{
  return d->num_contacts ? d->contacts[d->num_contacts - 1].pair + 1 : 0;
}

typedef struct _p_Scene *Scene;

/* Read the scene named in the arguments (the first that ends in .yml or .yaml, else the first argument) and the overrides; validate everything that
   needs no mesh. Options whose first word is a top key of a scene (title, units, mesh, refine, model, kinematics, order, body, material, boundary, contact,
   load, adapt, output, probe, point) are overrides, those of -options_file and PETSC_OPTIONS too, over which the command line wins: they are taken out of
   PETSc's global database, as is -check; all others stay there. Every wrong input is one sentence (ErrorInput). Nothing is written. Collective. */
PetscErrorCode SceneCreate(MPI_Comm, int argc, char **argv, Scene *);
/* Mesh a .geo with gmsh in a temporary directory (rank 0); read the coarse mesh into *forest and validate names, bodies, contact pairs and supports
   against it; complete the data. After an error *forest is NULL, and the scene is still to be destroyed. Collective. */
PetscErrorCode SceneSetUp(Scene, Forest *forest);
PetscErrorCode SceneGetData(Scene, const SceneData **);
/* Unit of a kind of quantity (force, length, area, volume, stress, energy, force times length, root of energy), in plane strain per thickness where forces
   are; "" for any other kind, or when the scene has no units. Not collective. */
PetscErrorCode SceneUnit(const SceneData *, const char *kind, size_t, char unit[]);
PetscErrorCode SceneDestroy(Scene *);
/* Before SceneSetUp: pairs, in the order of the scene, whose roles are to be the other way round than stiffness and corners at the reference positions say; and
   what is to be refined besides, at[num], where group is a pair and stands for its nonmortar side. Borrowed. Not collective. */
void        SceneExchange(Scene, uint64_t pairs, PetscInt num, const RefineSpec at[]);
PetscBool   SceneCheckOnly(Scene); /* -check given */
const char *SceneMeshFile(Scene);  /* mesh.file, from the working directory; valid until the next call. Not collective. */
/* The key of this scene, as an option without its dash, that is nearest to a name. Not collective. */
PetscErrorCode SceneNearestOption(Scene, const char *name, size_t capacity, char nearest[]);
/* A short readable report of what would be solved on this forest; after SceneSetUp. Collective. */
PetscErrorCode SceneView(Scene, Forest, PetscViewer);

/* The manual (-help) and the catalogue (-list), made from the option table and the tables of laws; written to stdout by rank 0. */
PetscErrorCode ScenePrintHelp(MPI_Comm);
PetscErrorCode ScenePrintList(MPI_Comm);
/* The same tables as arrays "keys" and "laws" of a JSON object (describe.c). Not collective. */
struct cJSON;
PetscErrorCode SceneDescribe(struct cJSON *);
