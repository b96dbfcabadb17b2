/* The contact laws, in the order of the words of contact.<pair>.law. */
#include "interfaceimpl.h"

extern const ContactLawOps ContactFrictionless, ContactPenalty, ContactCoulomb, ContactTied;

const ContactLawOps *const ContactLaws[] = {&ContactFrictionless, &ContactPenalty, &ContactCoulomb, &ContactTied, NULL};
