/* The contact laws, in the order of the words of contact.<pair>.law. */
#include "interfaceimpl.h"

extern const ContactLawOps ContactFrictionless, ContactPenalty;

const ContactLawOps *const ContactLaws[] = {&ContactFrictionless, &ContactPenalty, NULL};
