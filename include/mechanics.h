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
  PetscBool  fix_normal;         /* flat face of any direction: u.N = 0 */
  PetscBool  rotation;           /* finite rotation about the axis through point, degrees, expression of t */
  PetscInt   rotation_axis;
  Expression rotation_angle;
  PetscReal  rotation_point[3];
  Expression pressure;           /* follower, against the outward normal; current area */
  Expression traction[3];        /* dead, per reference area */
  Amplitude  amplitude;          /* multiplies displacement, rotation, pressure, traction that are constants in t */
} BoundarySpec;

typedef struct {
  char                name[MORTISE_NAME]; /* physical group of top dimension */
  const MaterialSpec *material;           /* borrowed */
  PetscInt            order;              /* displacement order of its cells */
  Expression          motion[3];          /* rigid bodies: prescribed translation; NULL: 0 */
  Expression          force[3];           /* dead force per reference volume */
  Amplitude           amplitude;          /* of motion and force */
} BodySpec;

typedef struct {
  Model               model;
  Kinematics          kinematics;
  PetscInt            num_bodies;
  const BodySpec     *bodies; /* [num_bodies], index = body of the coarse mesh */
  PetscInt            num_boundaries;
  const BoundarySpec *boundaries;
} MechanicsSpec;
