/* Coulomb friction: the pressure z as without friction, and a tangential traction q, in space a vector, with  |q| <= b = mu z, as

     R = w0 [ q - tau min(1, b / |tau|) ],   tau = q - c s / wn,   s the slip of the step weighted with psi_j, wn = int psi_j where it began:

   it sticks, s = 0, where |tau| <= b; else it slips, |q| = mu z, against s. A node that meets nothing at all, as yet, has no traction.

   In space rows of slip are those at a place tau*, b* (aim), e = tau* / |tau*|, k = b* / |tau*|: that of the last evaluation, or where states of a linear step
   are found, that at which it began to slip:
     q = mu z e + k (1 - e e^T) (q - c s / wn).

   Along axes in which a support holds the node, nothing of its own answers q, and where the other side does not move either, nothing at all does. There tau =
   qn - c s / wn with the traction qn where the step began: a spring as stiff as the cell. Across a plane of symmetry the mirror image cancels s. */
#include "interfaceimpl.h"

/* A traction that is short of its bound by this share lies on it: where a step begins s = 0, and nodes that slipped in the
   last one are there. Rows leave such a lack out, or no state would fulfil its own row. */
#define ROUND_OFF PETSC_SQRT_MACHINE_EPSILON

enum { OPEN, STICK, SLIP, SLIP_BACK, FREE }; /* SLIP: in the plane tau > b; FREE: without traction */

static PetscInt Count_Private(PetscInt dim)
{
  return dim;
}

/* z where the row of the pressure is fulfilled (frictionless.c). */
static PetscReal Pressure_Private(const ContactPoint *p)
{
  return p->z[0] - p->c * (p->gap + p->spring * p->z[0]) / (p->weight + p->c * p->spring);
}

/* Of the slip along an axis, where the other side is held as well none. */
static PetscReal Stiffness_Private(const ContactPoint *p, PetscInt i)
{
  return i < p->plane ? 0 : p->c;
}

/* tau, with the slip of the motion still to come; returns its length. */
static PetscReal Trial_Private(const ContactPoint *p, PetscReal tau[2])
{
  tau[1] = 0;
  for (PetscInt i = 0; i < p->dim - 1; ++i)
    tau[i] = p->slip_weight > 0 ? (i < p->held ? p->q[i] : p->z[1 + i]) - Stiffness_Private(p, i) * (p->slip[i] + p->slip_lift[i]) / p->slip_weight : 0;
  return PetscSqrtReal(tau[0] * tau[0] + tau[1] * tau[1]);
}

/* From slip to slip the other way by way of stick only: tau jumps over +-b where c is as large as the bodies' stiffness, and sets would go to and fro. */
static int8_t State_Private(const ContactPoint *p)
{
  const PetscReal pressure = Pressure_Private(p), bound = (1 - ROUND_OFF) * p->friction * pressure;
  PetscReal       tau[2];

  if (!(pressure > 0)) return OPEN;
  if (p->slip_weight == 0 || p->friction == 0) return FREE;
  if (!(Trial_Private(p, tau) > bound)) return STICK;
  if (p->dim == 3) return p->state == SLIP && p->aim[0] * tau[0] + p->aim[1] * tau[1] < 0 ? STICK : SLIP;
  if (tau[0] > 0) return p->state == SLIP_BACK ? STICK : SLIP;
  return p->state == SLIP ? STICK : SLIP_BACK;
}

static void Aim_Private(const ContactPoint *p, PetscReal aim[3])
{
  PetscReal       tau[2];
  const PetscReal length = Trial_Private(p, tau), bound = p->friction * Pressure_Private(p);

  for (int i = 0; i < 2; ++i) aim[i] = length > 0 ? tau[i] / length : 0;
  aim[2] = length > 0 && bound > 0 ? PetscMin(1, bound / length) : 0;
}

static void Stick_Private(const ContactPoint *p, PetscInt i, ContactRow *row)
{
  *row         = (ContactRow){0};
  row->slip[i] = p->w0 * Stiffness_Private(p, i) / p->slip_weight;
  row->side    = -row->slip[i] * (p->slip[i] + p->slip_lift[i]);
  if (i >= p->held) return;
  row->z[1 + i] = p->w0;
  row->side -= p->w0 * (p->z[1 + i] - p->q[i]);
}

/* q = share z */
static void Bound_Private(const ContactPoint *p, PetscInt i, PetscReal share, ContactRow *row)
{
  const PetscReal bound = share * p->z[0], lack = bound - p->z[1 + i];

  *row          = (ContactRow){.z = {-p->w0 * share}, .side = PetscAbsReal(lack) > ROUND_OFF * PetscAbsReal(bound) ? p->w0 * lack : 0};
  row->z[1 + i] = p->w0;
}

static void Slip_Private(const ContactPoint *p, PetscInt i, ContactRow *row)
{
  PetscReal       tau[2];
  const PetscReal bound = p->friction * p->z[0], lack = bound - Trial_Private(p, tau), share = p->friction * p->aim[i];

  *row          = (ContactRow){.z = {-p->w0 * share}, .side = -p->w0 * (p->z[1 + i] - share * p->z[0])};
  row->z[1 + i] = p->w0;
  if (lack > 0 && lack <= ROUND_OFF * bound) row->side -= p->w0 * p->aim[i] * lack;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscReal across = p->w0 * p->aim[2] * ((PetscReal)(i == k) - p->aim[i] * p->aim[k]);

    if (k >= p->held) row->z[1 + k] -= across;
    row->slip[k] = across * Stiffness_Private(p, k) / p->slip_weight;
    row->side += across * tau[k];
  }
}

static void Rows_Private(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  ContactCompliantRow_Private(p, p->spring, 0, symmetric, &row[0]);
  for (PetscInt i = 0; i < p->dim - 1; ++i) {
    if (p->state == STICK)
      Stick_Private(p, i, &row[1 + i]);
    else if (p->dim == 3 && p->state == SLIP)
      Slip_Private(p, i, &row[1 + i]);
    else
      Bound_Private(p, i, p->state == SLIP ? p->friction : p->state == SLIP_BACK ? -p->friction : 0, &row[1 + i]);
  }
}

static PetscBool Slides_Private(int8_t state)
{
  return (PetscBool)(state == SLIP || state == SLIP_BACK);
}

const ContactLawOps ContactCoulomb = {.name            = "coulomb",
                                      .slips           = PETSC_TRUE,
                                      .num_multipliers = Count_Private,
                                      .state           = State_Private,
                                      .rows            = Rows_Private,
                                      .slides          = Slides_Private,
                                      .aim             = Aim_Private};
