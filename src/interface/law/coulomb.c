/* Coulomb friction in the plane: the pressure z as without friction, and a tangential traction q with  |q| <= b = mu z, as

     R = w0 [ q - min(b, max(-b, tau)) ],   tau = q - c s / wn,   s the slip of the step weighted with psi_j, wn = int psi_j where it began:

   it sticks, s = 0, where |tau| <= b; else it slips, q = +- mu z, against s. A node that touches what it had not before it in its step begins without
   traction. */
#include "interfaceimpl.h"

#define ROUND_OFF                                                                                                                                              \
  1e-8 /* a traction that is short of its bound by this share slips: where a step begins s = 0, and nodes that slipped in the last one lie on it */

enum { OPEN, STICK, SLIP, SLIP_BACK, NEW }; /* SLIP: tau > b */

static PetscInt Two_Private(PetscInt dim)
{
  return 2;
}

/* From slip to slip the other way by way of stick only: tau jumps over +-b where c is as large as the bodies' stiffness, and sets would go to and fro. */
static int8_t State_Private(const ContactPoint *p)
{
  const PetscReal pressure = p->z[0] - p->c * p->gap / p->weight, bound = (1 - ROUND_OFF) * p->spec->friction * pressure;
  PetscReal       tau;

  if (!(pressure > 0)) return OPEN;
  if (p->slip_weight == 0) return NEW;
  tau = p->z[1] - p->c * p->slip / p->slip_weight;
  if (tau > bound) return p->state == SLIP_BACK ? STICK : SLIP;
  if (tau < -bound) return p->state == SLIP ? STICK : SLIP_BACK;
  return STICK;
}

static void Rows_Private(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  const PetscReal share = p->state == SLIP ? p->spec->friction : p->state == SLIP_BACK ? -p->spec->friction : 0;

  ContactCompliantRow_Private(p, p->spring, 0, symmetric, &row[0]);
  if (p->state == STICK) {
    row[1]      = (ContactRow){.slip = PETSC_TRUE, .factor = p->w0 * p->c / p->slip_weight};
    row[1].side = -row[1].factor * (p->slip + p->slip_lift);
  } else
    row[1] = (ContactRow){.z = {-p->w0 * share, p->w0}, .side = -p->w0 * (p->z[1] - share * p->z[0])};
}

static PetscInt Slides_Private(int8_t state)
{
  return state == SLIP ? 1 : state == SLIP_BACK ? -1 : 0;
}

const ContactLawOps ContactCoulomb = {
    .name = "coulomb", .slips = PETSC_TRUE, .num_multipliers = Two_Private, .state = State_Private, .rows = Rows_Private, .slides = Slides_Private};
