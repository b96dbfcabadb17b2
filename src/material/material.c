/* The table of laws: one row each. A new law is a file, a row here, and its documentation follows from the row. */
#include "materialimpl.h"

const char *const VolumetricNames[] = {"quadratic", "simo", "log", "Volumetric", "VOLUMETRIC_", NULL};

const MaterialLaw MaterialLaws[] = {
    {"neo_hookean", "compressible neo-Hookean solid", MaterialElasticParameters, .setup = MaterialSetUpElastic, .evaluate = MaterialNeoHookean},
    {"mooney_rivlin", "Mooney-Rivlin solid", MaterialMooneyRivlinParameters, .setup = MaterialMooneyRivlinSetUp, .evaluate = MaterialMooneyRivlin},
    {"ogden", "Ogden's solid of one to three terms, in principal stretches", MaterialOgdenParameters, .setup = MaterialOgdenSetUp, .evaluate = MaterialOgden},
    {"yeoh", "Yeoh's solid, a cubic polynomial of the first invariant", MaterialYeohParameters, .setup = MaterialYeohSetUp, .evaluate = MaterialPolynomial},
    {"arruda_boyce", "eight-chain model of Arruda and Boyce", MaterialArrudaBoyceParameters, .setup = MaterialArrudaBoyceSetUp, .evaluate = MaterialPolynomial},
    {"hgo", "artery wall of Holzapfel, Gasser and Ogden: isotropic solid with families of fibres that carry tension only", MaterialHGOParameters,
     .fibers = PETSC_TRUE, .setup = MaterialHGOSetUp, .evaluate = MaterialHGO},
    {"saint_venant_kirchhoff", "St. Venant-Kirchhoff solid: small strains, any rotation", MaterialElasticParameters, .whole = PETSC_TRUE,
     .setup = MaterialSetUpElastic, .evaluate = MaterialSaintVenantKirchhoff},
    {"linear", "linear isotropic elasticity, small kinematics", MaterialElasticParameters, .small = PETSC_TRUE, .setup = MaterialLinearSetUp,
     .evaluate = MaterialLinear},
    {"j2", "finite elasto-plastic solid: von Mises yield, isotropic hardening", MaterialJ2Parameters, .unsymmetric = PETSC_TRUE, .num_history = 8, .settled = 7,
     .setup = MaterialJ2SetUp, .evaluate = MaterialJ2, .initial = MaterialJ2Initial, .plastic = MaterialJ2Plastic},
    {"rigid", "rigid body that moves as told", MaterialRigidParameters, .rigid = PETSC_TRUE, .setup = MaterialRigidSetUp},
    {NULL},
};

PetscReal MaterialSecant(const MaterialSpec *spec, PetscReal strain, PetscReal work)
{
  return work > 0 ? 1 / (1 + 3 * spec->mu * strain * strain / work) : 1;
}

const MaterialLaw *MaterialLawFind(const char *name)
{
  for (const MaterialLaw *law = MaterialLaws; law->name; law++) {
    if (!strcmp(law->name, name)) return law;
  }
  return NULL;
}

PetscErrorCode MaterialEvaluate(const MaterialSpec *spec, MaterialPart part, MaterialPoints *points)
{
  PetscFunctionBegin;
  PetscCheck(spec->law->evaluate, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "Material %s (%s) has no stress", spec->name, spec->law->name);
  PetscCheck(!spec->law->num_history || points->history, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "Material %s (%s) needs the history of its points", spec->name,
             spec->law->name);
  PetscCall(spec->law->evaluate(spec, part, points));
  PetscFunctionReturn(PETSC_SUCCESS);
}
