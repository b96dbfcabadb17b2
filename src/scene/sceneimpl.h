/* Private to scene: the tree of keys, the option table and the objects it fills. */
#pragma once
#include "scene.h"

/* ---- the tree of keys (yaml.c) ------------------------------------------------------------------------------------------ */

typedef enum { NODE_SCALAR, NODE_LIST, NODE_MAP } NodeKind;

enum { NODE_COMMAND_LINE = 0, NODE_DATABASE = -1 }; /* lines of nodes that are in no scene file: options, as given or from -options_file or PETSC_OPTIONS */

typedef struct _SceneNode SceneNode;
struct _SceneNode {
  NodeKind    kind;
  char       *key;    /* owned; "" for the root and for items of a list */
  char       *text;   /* owned; value of a scalar, else NULL */
  PetscBool   quoted; /* the scalar stood in quotes */
  PetscInt    line;   /* in the file, from 1; NODE_COMMAND_LINE, NODE_DATABASE */
  const char *origin; /* borrowed; name of the file */
  SceneNode  *parent, *first, *last, *next;
};

/* Parse YAML text into *root (a map). Errors name origin, line and column. *root is to be destroyed also after an error. Not collective. */
PetscErrorCode SceneParse(const char *origin, const char *text, size_t length, SceneNode **root);
PetscErrorCode NodeCreate(SceneNode *parent, const char *key, NodeKind, const char *origin, PetscInt line, SceneNode **);
PetscErrorCode NodeDestroy(SceneNode **);
PetscErrorCode NodeSetText(SceneNode *, const char *text);
SceneNode     *NodeFind(const SceneNode *map, const char *key); /* child or NULL; map may be NULL */
PetscInt       NodeCount(const SceneNode *);                    /* children; NULL: 0 */
PetscBool      NodeIsEmpty(const SceneNode *);                  /* `key:` with nothing after it */
PetscBool      NodeIsNull(const SceneNode *);                   /* the same, or YAML's words for it */
const char    *NodeWhere(const SceneNode *);                    /* "file:line: a.b.c" in a buffer that lives until the eighth next call */
const char    *NodeOptions(PetscInt line);                      /* where options with this line come from, in words */

/* ---- the option table (optiontable.c) ----------------------------------------------------------------------------------- */

typedef enum { KEY_TEXT, KEY_WORD, KEY_INT, KEY_REAL, KEY_BOOL, KEY_EXPRESSION, KEY_AMPLITUDE, KEY_AXES, KEY_PARAMETER, KEY_WORDS, KEY_GROUPS } KeyType;

#define OPTION_DEPTH 8 /* keys above each other */

/* One row: what -help prints, what parsing and checks do. Pattern: keys joined by '.', <name> stands for any name, <axis> for x, y or z,
   <parameter> for a parameter of a law. Range: an interval "[1,8]", "(0,inf)", or words "small|finite" (their order is that of the enum; KEY_WORDS: any of
   them, with commas between; the i-th sets bit i). KEY_GROUPS: a name or a list of names; what is stored is a text to show, the names are the node's. */
typedef struct {
  const char *pattern;
  KeyType     type;
  const char *unit;     /* in the user's own symbols: length, stress, … */
  const char *fallback; /* default as text; NULL: the key must be given; "": absent */
  const char *range, *help;
  size_t      offset, size; /* place in the object of its section; size of a text */
} Option;

extern const Option Options[]; /* ended by pattern NULL */

/* Where a section of the table stores: the scene itself, or one of these per name. */
typedef struct {
  MaterialSpec spec;
  char         law[MORTISE_NAME];
  int          volumetric, formulation;
  SceneNode   *node; /* borrowed */
  PetscBool    used;
} MaterialEntry;

typedef struct {
  BodySpec   spec;
  char       material[MORTISE_NAME];
  char       moment_about[MORTISE_NAME];
  int        rotation_axis;
  SceneNode *node;
} BodyEntry;

typedef struct {
  BoundarySpec spec;
  int          rotation_axis;
  char         moment_about[MORTISE_NAME];
  SceneNode   *node;
} BoundaryEntry;

#define SIDE_TEXT 1024   /* room for the names of a side as a text */
#define ROLES_GIVEN 1    /* place of the word given among those of contact.<pair>.roles */
#define SUBDIVIDE_AUTO 9 /* place of the word auto among those of contact.<pair>.subdivide: after 0 to 8 */

typedef struct {
  ContactSpec spec;
  char        nonmortar[SIDE_TEXT], mortar[SIDE_TEXT], surface[SIDE_TEXT], moment_about[MORTISE_NAME];
  int         order, initial_gap, multiplier, roles;
  int         kind;      /* contact, tied */
  int         subdivide; /* isotropic subdivisions of the cells that touch either side; SUBDIVIDE_AUTO */
  SceneNode  *node;
} ContactEntry;

typedef struct {
  ProbeSpec  spec;
  SceneNode *node;
} ProbeEntry;

typedef struct {
  RefineSpec spec;
  char       boundary[MORTISE_NAME];
  SceneNode *node;
} RefineEntry;

typedef struct {
  PetscReal  X[3];
  PetscBool  used;
  SceneNode *node;
} PointEntry;

struct _p_Scene {
  MPI_Comm  comm;
  SceneData data; /* what others see; its arrays are owned here */
  PetscBool check;

  SceneNode        *root;                          /* owned */
  char             *text;                          /* owned; the file */
  char              mesh_file[PETSC_MAX_PATH_LEN]; /* as written in the scene */
  PetscInt          mesh_order, order;
  PetscBool         trust; /* mesh.trust */
  PetscBool         setup;
  uint64_t          exchange;                      /* SceneExchange: pairs, by number … */
  PetscInt          num_corners;                   /* … */
  const RefineSpec *corner;                        /* … and what is refined */
  PetscBool         subdivided;                    /* gmsh made hexahedra out of tetrahedra */
  char              directory[PETSC_MAX_PATH_LEN]; /* of the scene file, with '/' at its end */
  char              temporary[PETSC_MAX_PATH_LEN]; /* directory of the generated mesh, "" when none; rank 0 removes it */

  MaterialEntry *material; /* [data.num_materials] */
  BodyEntry     *body;     /* [num_bodies] in file order */
  BoundaryEntry *boundary;
  ContactEntry  *contact;
  ProbeEntry    *probe;
  RefineEntry   *refine; /* [data.num_refines] */
  PointEntry    *point;
  PetscInt       num_bodies, num_boundaries, num_points, num_contacts; /* num_contacts: pairs as the file names them; data.num_contacts: parts */
  int8_t       **face;                                                 /* [num_contacts] ContactSpec.face */
  PetscInt      *joined;                                               /* MechanicsSpec.joined */
};

/* Every key of the tree is in the table and has the right shape. Not collective. */
PetscErrorCode OptionsCheckTree(const SceneNode *root);
/* Read all rows of a section ("" for those without names; "material.<name>.fiber" for names in the section of a name) from its node (NULL: defaults) into
 * object. dim 2: a z component is an error. */
PetscErrorCode OptionsRead(const char *section, const SceneNode *, PetscInt dim, void *object);
/* Units from words, checked to agree: one sentence when not (units.c). */
PetscErrorCode SceneReadUnits(const char *where, const char *text, SceneUnits *);
/* A number as text, finite, whole text. */
PetscBool OptionParseReal(const char *text, PetscReal *);
/* Put the options that are scene keys into the tree and take them out of PETSc's global database: what is there besides (-options_file), then the command
 * line's. */
PetscErrorCode OptionsOverride(SceneNode *root, int argc, char **argv);
/* Whether s is one of the keys at the top of a scene, s not necessarily ended by 0. */
PetscBool OptionIsTopKey(const char *s, size_t length);
/* Nearest known key to path ('.' or '_' between its words, as separator says). */
PetscErrorCode OptionNearest(const SceneNode *root, const char *path, char separator, size_t capacity, char nearest[]);
/* An input error, at `where`, for a key of an earlier version: what to use instead. */
PetscErrorCode OptionCheckFormer(const char *where, const char *path, char separator);
PetscBool      OptionKnowsParameter(const char *name); /* of any law of the table of laws */
/* Split "a.b.c" into words; returns how many. */
PetscInt OptionSplit(const char *pattern, char words[OPTION_DEPTH][MORTISE_NAME]);

/* ---- the rest --------------------------------------------------------------------------------------------------------------- */

/* Fill data and entries from the tree and the command line (read.c); everything that needs no mesh is checked. */
PetscErrorCode SceneRead(Scene, int argc, char **argv);
/* drive.c. A motion (NULL: none) at node `motion` must not change along a path (load.control: arc_length). */
PetscErrorCode SceneCheckPath(Scene, const SceneNode *motion, Expression);
/* Tractions and pressures of a boundary's node against what the boundary prescribes. */
PetscErrorCode SceneCheckLoaded(Scene, const SceneNode *boundary, const BoundarySpec *);
/* The expression (NULL: not given) under `key` of a boundary's node, which a pressure that is found is to follow, and what else the boundary has. */
PetscErrorCode SceneCheckControl(Scene, const SceneNode *boundary, const char *key, Expression, const BoundarySpec *);
/* point.c. A named point; X of the one that moment_about of a node names (not given: X stays); points by default, once bodies and boundaries are matched with
   the mesh: touches[num_bodies][num_boundaries of the mesh] tells which bodies have facets of a group. Not collective. */
PetscErrorCode SceneReadPoint(Scene, SceneNode *, PointEntry *);
PetscErrorCode SceneFindPoint(Scene, const SceneNode *user, const char *name, PetscReal X[3]);
PetscErrorCode SceneSetPoints(Scene, const CoarseMesh *, const PetscBool touches[]);
/* What a rigid body's load asks of it and of the scene (drive.c). Not collective. */
PetscErrorCode SceneCheckLoad(Scene, const SceneNode *body, const BodySpec *);
/* Mesh the .geo, or take the .msh as it is: data.mesh.file is set (mesh.c). Collective. */
PetscErrorCode SceneMakeMesh(Scene);
PetscErrorCode SceneRemoveMesh(Scene);
/* A sentence when the .geo, or what it includes, can call a program or write a file, else "" (geo.c). */
void GeoCheck(const char *file, size_t capacity, char message[]);
/* What a .geo does, so that a constant cannot be set from outside; "": it can be. */
const char *GeoCheckConstant(const char *file, const char *constant);
/* Match names with the groups of the mesh, fill data.bodies, boundaries, contacts, and check them (check.c). Collective. */
PetscErrorCode SceneCheckMesh(Scene, Forest);
/* Warnings and notes on a mesh that may not be what is meant (pieces.c); after SceneCheckMesh. Collective. */
PetscErrorCode SceneTellMesh(Scene, Forest);
/* faces.c. Colours of the smooth faces of a group by side of the coarse mesh, -1: not in the group; *colour is the caller's. Not collective. */
PetscErrorCode SceneColourFaces(Forest, PetscInt group, PetscInt *num_colours, int8_t **colour);
/* The same on sides of contact pairs that are chords of what they stand for (chords.c). Collective. */
PetscErrorCode SceneTellChords(Scene, Forest);
/* Reference position of a vertex (check.c). Not collective. */
PetscErrorCode SceneVertex(Forest, PetscInt vertex, PetscReal X[3]);
/* "a, b, c" or "none" (check.c). */
PetscErrorCode SceneListNames(PetscInt num, char (*names)[MORTISE_NAME], size_t capacity, char list[]);
/* fiber.c. Families of fibres find their fields in the mesh. Bodies are matched already. Not collective. */
PetscErrorCode SceneCheckFields(Scene, const CoarseMesh *);
