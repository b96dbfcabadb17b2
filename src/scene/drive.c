/* What may drive a scene together: pressures that are found, paths along which the loads' factor is found, prescribed motion. */
#include "sceneimpl.h"

/* Is the expression 0 everywhere and at all times, as far as two of them tell? */
static PetscErrorCode IsZero_Private(Expression e, PetscBool *yes)
{
  static const PetscReal at[2][3] = {{0.3, 0.7, 0.9}, {-1.1, 0.2, 2.3}};
  PetscReal              first, second;

  PetscFunctionBegin;
  PetscCall(ExpressionEvaluate(e, at[0], 0.4, &first));
  PetscCall(ExpressionEvaluate(e, at[1], 1.7, &second));
  *yes = (PetscBool)(first == 0 && second == 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Along a path t multiplies loads; nothing is moved by it. */
PetscErrorCode SceneCheckPath(Scene s, const SceneNode *motion, Expression e)
{
  PetscBool zero = PETSC_TRUE;

  PetscFunctionBegin;
  if (s->data.load.control != LOAD_ARC_LENGTH || !e) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(IsZero_Private(e, &zero));
  PetscCheckInput(zero,
                  "%s: with load.control: arc_length the factor of the loads is found, and nothing may move with t; take load.control: time, or a load in "
                  "place of this motion",
                  NodeWhere(motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Loads on a boundary that is prescribed where they act would show in its reaction alone. */
PetscErrorCode SceneCheckLoaded(Scene s, const SceneNode *boundary, const BoundarySpec *b)
{
  PetscBool held[3], whole = PETSC_TRUE, zero;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < s->data.mesh.dim; ++c) {
    held[c] = (PetscBool)(b->rotation || b->displacement[c] || b->fix[c]);
    whole   = (PetscBool)(whole && held[c]);
    if (!b->traction[c] || !held[c]) continue;
    PetscCall(IsZero_Private(b->traction[c], &zero));
    PetscCheckInput(zero, "%s.%c: the displacement of this boundary along %c is prescribed, so no traction moves it; take one of them away",
                    NodeWhere(NodeFind(boundary, "traction")), 'x' + (int)c, 'x' + (int)c);
  }
  PetscCheckInput(!whole || !BoundaryHasPressure(b), "%s.%s: all displacements of this boundary are prescribed, so no pressure moves it", NodeWhere(boundary),
                  BoundaryPressureKey(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A pressure that is found: `key` says what it follows. */
PetscErrorCode SceneCheckControl(Scene s, const SceneNode *boundary, const char *key, Expression e, const BoundarySpec *b)
{
  const SceneNode *node      = NodeFind(boundary, key);
  const PetscReal  origin[3] = {0, 0, 0};
  PetscReal        start;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheckInput(!b->pressure, "%s: the pressure that leads there is found, not given; take pressure away", NodeWhere(node));
  PetscCheckInput(!b->volume || !b->advance, "%s: one pressure cannot follow both volume and advance; take one away", NodeWhere(boundary));
  PetscCheckInput(s->data.mechanics.kinematics == KINEMATICS_FINITE,
                  "%s needs kinematics: finite; with small ones no boundary moves away from its reference position", NodeWhere(node));
  PetscCheckInput(s->data.load.control == LOAD_TIME,
                  "%s and load.control: arc_length do not go together: that finds the factor of given loads; allowed here: time", NodeWhere(node));
  PetscCheckInput(!ExpressionUsesPlace(e), "%s is \"%s\": one number for the whole boundary, so an expression in t alone", NodeWhere(node), ExpressionText(e));
  PetscCall(MechanicsValue(e, &b->amplitude, origin, 0, &start));
  PetscCheckInput(PetscAbsReal(start) < 1e-12, "%s is %g at t = 0; it is counted from the reference configuration and must start at 0", NodeWhere(node),
                  (double)start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A direction is either prescribed or free. */
static PetscErrorCode CheckDirections_Private(const SceneNode *load, const BodySpec *b)
{
  const PetscInt turns = BodyNumTurns(b);

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; ++c) {
    PetscCheckInput(!b->load[c] || !b->motion[c], "%s.%c: the body's motion in %c is prescribed; allowed in one direction: motion or load", NodeWhere(load),
                    'x' + (int)c, 'x' + (int)c);
    PetscCheckInput(!b->load[c] || !ExpressionUsesPlace(b->load[c]), "%s.%c is \"%s\": one force for the whole body, so an expression in t alone",
                    NodeWhere(load), 'x' + (int)c, ExpressionText(b->load[c]));
    PetscCheckInput(!b->load_moment[c] || !ExpressionUsesPlace(b->load_moment[c]),
                    "%s.moment_%c is \"%s\": one moment for the whole body, so an expression in t alone", NodeWhere(load), 'x' + (int)c,
                    ExpressionText(b->load_moment[c]));
  }
  PetscCheckInput(!turns || !b->rotation_angle, "%s: the rotation of the body is prescribed; allowed: motion.rotation or a moment", NodeWhere(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckLoad(Scene s, const SceneNode *body, const BodySpec *b)
{
  const SceneNode *load  = NodeFind(body, "load");
  const PetscInt   turns = BodyNumTurns(b);

  PetscFunctionBegin;
  if (!load) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheckInput(b->material->law->rigid, "%s: only a rigid body takes a load, and material %s is %s; load a boundary instead (traction, pressure)",
                  NodeWhere(load), b->material->name, b->material->law->name);
  PetscCheckInput(s->data.load.control == LOAD_TIME,
                  "%s and load.control: arc_length do not go together: that finds the factor of loads on bodies that deform; allowed here: time",
                  NodeWhere(load));
  PetscCheckInput(s->data.mesh.dim == 3 || (!b->load_moment[0] && !b->load_moment[1]), "%s.moment_%c: a two-dimensional model turns about z only",
                  NodeWhere(load), b->load_moment[0] ? 'x' : 'y');
  PetscCheckInput(s->data.mechanics.model != MODEL_AXISYMMETRIC || (!turns && !b->load[0]),
                  "%s: a body of revolution moves along its axis only; allowed here: y", NodeWhere(load));
  PetscCheckInput(!turns || s->data.mechanics.kinematics == KINEMATICS_FINITE,
                  "%s: a moment needs kinematics: finite; with small ones contact does not know of a turn", NodeWhere(load));
  PetscCall(CheckDirections_Private(load, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
