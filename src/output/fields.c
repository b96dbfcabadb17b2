/* What stands in adapt.csv, history.csv and summary.json: one row per column or field, with its unit and its meaning. */
#include "output.h"

#define FORCE "force"
#define LENGTH "length"
#define MOMENT "force times length"
#define STRESS "stress"
#define ENERGY "energy"
#define SECONDS "s"

#define STEP_HELP "number of the load step, from 1"
#define CELLS_HELP "cells of the mesh, those of rigid bodies included"
#define DOFS_HELP "unknowns: displacements, contact pressures, pressures of incompressible bodies"
#define ACTIVE_HELP "nodes under contact pressure"
#define ERROR_HELP "estimated error relative to the energy norm of the solution; empty: not estimated"
#define ENERGY_HELP "strain energy of all bodies"
#define MIN_DET_HELP "least determinant of the deformation gradient at an integration point; 0 would be a cell turned inside out"
#define MIN_GAP_HELP "least gap at a node of the nonmortar sides; negative: penetration"
#define PLASTIC_HELP "largest plastic strain, at an integration point or at a surface"
#define WORK_HELP "work that plastic flow took so far"

/* Columns are in the order in which history.c gives their values; those of plastic materials are the last PLASTIC_COLUMNS. */
const OutputField OutputAdaptColumns[] = {
    {"step", "", STEP_HELP},
    {"pass", "", "adaptive pass at this load step, from 0; with adapt.repeat: path of the whole path"},
    {"t", "pseudo-time", "time of the load step"},
    {"cells", "", CELLS_HELP},
    {"dofs", "", DOFS_HELP},
    {"newton_iterations", "", "iterations of Newton's method in this pass"},
    {"active_nodes", "", ACTIVE_HELP},
    {"estimated_error", "", ERROR_HELP},
    {"estimate", "root of energy", "estimated error in the energy norm, absolute"},
    {"energy", ENERGY, ENERGY_HELP},
    {"min_det", "", MIN_DET_HELP},
    {"min_gap", LENGTH, MIN_GAP_HELP},
    {"contact_force", FORCE, "magnitude of the contact force, summed over the pairs"},
    {"seconds", SECONDS, "wall time since the start"},
    {"accepted", "", "1: the last pass of its load step, 0: the mesh was refined after it"},
    {"plastic_strain", "", PLASTIC_HELP},
    {"plastic_work", ENERGY, WORK_HELP},
    {"force_change", "", "relative change of reactions and contact forces by the adaptation before this pass, at the same load"},
    {"work_change", "", "the same of the plastic work"},
    {"strain_change", "", "the same of the largest plastic strain"},
    {NULL, NULL, NULL},
};

/* Those of every scene first; then what a scene has, as Columns_Private of history.c adds it. */
const OutputField OutputHistoryColumns[] = {
    {"step", "", STEP_HELP},
    {"t", "pseudo-time", "time at its end"},
    {"dt", "pseudo-time", "its length"},
    {"pass", "", "adaptive pass of the accepted solution"},
    {"step_cuts", "", "how often the step was made shorter, since Newton's method found no equilibrium"},
    {"cells", "", CELLS_HELP},
    {"dofs", "", DOFS_HELP},
    {"newton_iterations", "", "iterations of Newton's method in the whole step, attempts in vain included"},
    {"active_nodes", "", ACTIVE_HELP},
    {"estimated_error", "", ERROR_HELP},
    {"energy", ENERGY, ENERGY_HELP},
    {"min_det", "", MIN_DET_HELP},
    {"min_gap", LENGTH, MIN_GAP_HELP},
    {"contact_force", FORCE, "magnitude of the contact force, summed over the pairs"},
    {"contact_imbalance", "", "sum of the contact forces on both sides of a pair relative to their size; the largest of the pairs"},
    {"moment_imbalance", "", "the same of their moments, relative to force times diameter of the nonmortar side"},
    {"support_imbalance", "",
     "sum of reactions, loads and contact with rigid bodies, relative to the sum of their magnitudes, or to the nodal forces where those are more"},
    {"seconds", SECONDS, "wall time since the start"},
    {"viscous_work", ENERGY, "energy that viscous regularisation dissipated in this step; 0: it was not needed"},
    {"frozen_segmentation", "", "1: the equilibrium was found with the segmentation of contact frozen"},
    {"modifiers", "", "interventions of Newton's modifiers, all together"},
    {"plastic.strain", "", PLASTIC_HELP},
    {"plastic.work", ENERGY, WORK_HELP},
    {"body.<body>.mean_plastic_strain", "", "mean over the reference volume of a body that flows"},
    {"reaction.<boundary>.<axis>", FORCE, "force of a support on the body; axisymmetric: over the full revolution"},
    {"reaction.<boundary>.moment", MOMENT, "plane: its moment about boundary.<name>.moment_about, by default the centre of the body, current positions"},
    {"reaction.<boundary>.moment.<axis>", MOMENT, "space: the same"},
    {"body.<body>.displacement.<axis>", LENGTH, "displacement of a rigid body's point (body.<name>.moment_about, by default its centre)"},
    {"body.<body>.rotation", "degrees", "plane: angle by which it is turned, prescribed or found"},
    {"body.<body>.rotation.<axis>", "degrees", "space: rotation vector, along the axis and as long as the angle"},
    {"body.<body>.force.<axis>", FORCE, "force that all others exert on a rigid body"},
    {"body.<body>.moment", MOMENT, "plane: its moment about body.<name>.moment_about, by default the body's centre, which moves with the body"},
    {"body.<body>.moment.<axis>", MOMENT, "space: the same"},
    {"pressure.<boundary>", STRESS, "pressure that was found for volume or advance"},
    {"volume.<boundary>", "volume", "change of the enclosed volume that it follows"},
    {"advance.<boundary>", LENGTH, "mean displacement against the outward normal that it follows"},
    {"contact.<pair>.force.<axis>", FORCE, "contact force on the nonmortar side of the scene"},
    {"contact.<pair>.moment", MOMENT, "plane: its moment about contact.<pair>.moment_about, by default the centre of the nonmortar side's body"},
    {"contact.<pair>.moment.<axis>", MOMENT, "space: the same"},
    {"contact.<pair>.max_pressure", STRESS, "largest contact pressure at a node"},
    {"contact.<pair>.max_traction", STRESS, "tied: largest traction at a node"},
    {"contact.<pair>.area", "area",
     "area in contact, or that is tied (at the reference positions); plane strain: length; axisymmetric: over the full revolution"},
    {"contact.<pair>.radius", LENGTH, "plane: largest distance of a touching point from x = 0"},
    {"contact.<pair>.active_nodes", "", ACTIVE_HELP},
    {"contact.<pair>.min_gap", LENGTH, "least gap at a node; negative: penetration"},
    {"contact.<pair>.dissipation", ENERGY, "friction: energy that it took in this step"},
    {"contact.<pair>.max_slip", LENGTH, "friction: largest slip of a touching node in this step"},
    {"contact.<pair>.sticking_nodes", "", "friction: touching nodes that stick"},
    {"contact.<pair>.slipping_nodes", "", "friction: touching nodes that slip"},
    {"probe.<probe>.displacement.<axis>", LENGTH, "displacement of the point"},
    {"probe.<probe>.stress.<component>", STRESS, "Cauchy stress: xx, xy, yy, zz; in space also xz, yz"},
    {"probe.<probe>.plastic_strain", "", "plastic strain there"},
    {NULL, NULL, NULL},
};

/* In the order of summary.c. A figure that is not known is null. */
const OutputField OutputSummaryFields[] = {
    {"mortise", "", "version of the program"},
    {"scene", "", "name of the scene file"},
    {"title", "", "title of the scene"},
    {"units", "", "units of the scene, where it says them"},
    {"status", "", "converged, inaccurate (adapt.tolerance was not reached in all steps), failed, stopped"},
    {"reason", "", "why it is not converged, in words; else empty"},
    {"warnings", "", "warnings of the run, in words"},
    {"t", "pseudo-time", "time of the last accepted load step"},
    {"model", "", "plane_strain, axisymmetric or 3d"},
    {"ranks", "", "processes"},
    {"load_steps", "", "load steps accepted"},
    {"step_cuts", "", "how often a step was made shorter"},
    {"adapt_stop", "", "why the last adaptation ended: tolerance, max_passes, max_cells, …; empty: there was none"},
    {"adapt_passes", "", "adaptive passes of all steps"},
    {"newton_iterations", "", "iterations of Newton's method, attempts in vain included"},
    {"active_set_changes", "", "changes of the active set of contact"},
    {"single_switches", "", "of these, nodes that switched alone"},
    {"active_set_cycles", "", "active sets that repeated"},
    {"factorisations", "", "factorisations of the tangent"},
    {"single_factor_failures", "", "factorisations in single precision that had to be made in double precision"},
    {"modifiers.<modifier>", "", "interventions of each modifier of Newton's method"},
    {"recoveries.<recovery>.tried", "", "how often a recovery was tried"},
    {"recoveries.<recovery>.succeeded", "", "and how often it found an equilibrium"},
    {"viscous_work", ENERGY, "energy that viscous regularisation dissipated in all steps"},
    {"flow_error", "", "estimated error that the load steps up to here leave where material flows, in the energy norm, of the solution's"},
    {"descent_iterations", "", "iterations of descent on the energy"},
    {"refused_solutions", "", "solutions found that are none: bodies of a pair inside each other that bear nothing (-path_inside)"},
    {"passed_through", "", "and those for which a body went right through the other of such a pair (-path_through)"},
    {"thrown_off", "", "and those for which a body that nothing holds moved farther than its own size and all that is held (-path_thrown)"},
    {"begun_anew", "", "how often the run began anew with other roles of its contact pairs (contact.<pair>.roles)"},
    {"rolled_too_far", "", "load steps that were made again, shorter, for bodies rolled too far on each other in them (-path_rolling)"},
    {"stabilised", "", "unstable equilibria that gave way to stable ones (load.stable)"},
    {"folded_left", "", "cells that adaptation was to split and left as they were, for they are turned inside out at a corner (-path_unfolded)"},
    {"unstable_equilibria", "", "equilibria kept though unstable; null: not known"},
    {"cells", "", CELLS_HELP},
    {"dofs", "", DOFS_HELP},
    {"order_min", "", "lowest order of a deformable cell"},
    {"order_max", "", "highest order of a deformable cell"},
    {"estimated_error", "", "estimated error relative to the energy norm of the solution"},
    {"estimate.total", "root of energy", "estimated error in the energy norm, absolute"},
    {"estimate.norm", "root of energy", "energy norm of the solution"},
    {"estimate.interior", "root of energy", "share of the equilibrium inside cells"},
    {"estimate.jumps", "root of energy", "share of jumps of the traction between cells"},
    {"estimate.boundary", "root of energy", "share of tractions on the boundary"},
    {"estimate.contact", "root of energy", "share of contact faces"},
    {"estimate.incompressibility", "root of energy", "share of the volumes that should be kept"},
    {"energy", ENERGY, ENERGY_HELP},
    {"min_det", "", MIN_DET_HELP},
    {"plastic_strain", "", PLASTIC_HELP},
    {"plastic_work", ENERGY, WORK_HELP},
    {"body.<body>.mean_plastic_strain", "", "mean over the reference volume of a body that flows"},
    {"reaction.<boundary>", FORCE, "force of a support on the body, by axis; axisymmetric: over the full revolution"},
    {"reaction_moment.<boundary>", MOMENT,
     "its moment about boundary.<name>.moment_about, by default the centre of the body, current positions; not axisymmetric"},
    {"body.<body>.displacement", LENGTH, "displacement of a rigid body's point (body.<name>.moment_about, by default its centre), by axis"},
    {"body.<body>.rotation", "degrees", "angle by which it is turned, prescribed or found; space: rotation vector; not axisymmetric"},
    {"body.<body>.force", FORCE, "force that all others exert on a rigid body, by axis"},
    {"body.<body>.moment", MOMENT, "its moment about body.<name>.moment_about, by default the body's centre, which moves with the body; not axisymmetric"},
    {"pressure.<boundary>", STRESS, "pressure that was found for volume or advance"},
    {"volume.<boundary>", "volume", "change of the enclosed volume that it follows"},
    {"advance.<boundary>", LENGTH, "mean displacement against the outward normal that it follows"},
    {"contact.<pair>.roles_exchanged", "", "true: the mortar side of the scene carries the pressure: it is softer, or has corners that press"},
    {"contact.<pair>.force", FORCE, "contact force on the nonmortar side of the scene, by axis"},
    {"contact.<pair>.moment", MOMENT, "its moment about contact.<pair>.moment_about, by default the centre of the nonmortar side's body, current positions"},
    {"contact.<pair>.mortar_force", FORCE, "contact force on the mortar side"},
    {"contact.<pair>.mortar_moment", MOMENT, "its moment about the same point"},
    {"contact.<pair>.force_imbalance", "", "sum of both forces relative to their size"},
    {"contact.<pair>.moment_imbalance", "", "the same of the moments"},
    {"contact.<pair>.max_pressure", STRESS, "largest contact pressure at a node"},
    {"contact.<pair>.max_traction", STRESS, "tied: largest traction at a node"},
    {"contact.<pair>.area", "area",
     "area in contact, or that is tied (at the reference positions); plane strain: length; axisymmetric: over the full revolution"},
    {"contact.<pair>.radius", LENGTH, "plane: largest distance of a touching point from x = 0"},
    {"contact.<pair>.equivalent_radius", LENGTH, "space: radius of a circle of the area in contact"},
    {"contact.<pair>.active_nodes", "", ACTIVE_HELP},
    {"contact.<pair>.covered_nodes", "", "nodes that face the other side"},
    {"contact.<pair>.min_gap", LENGTH, "least gap at a node; negative: penetration"},
    {"contact.<pair>.max_gap", LENGTH, "largest gap at a node that faces the other side"},
    {"contact.<pair>.adjusted_gap", LENGTH, "largest initial gap that initial_gap: adjust closed"},
    {"contact.<pair>.unusable_overlaps", "", "overlaps of facets that could not be used"},
    {"contact.<pair>.stabilised_facets", "", "facets of a stiff nonmortar side, shorter than those of the other one, whose pressures are stabilised"},
    {"contact.<pair>.dissipation", ENERGY, "friction: energy that it took in this step"},
    {"contact.<pair>.max_slip", LENGTH, "friction: largest slip of a touching node in this step"},
    {"contact.<pair>.sticking_nodes", "", "friction: touching nodes that stick"},
    {"contact.<pair>.slipping_nodes", "", "friction: touching nodes that slip"},
    {"balance.load", FORCE, "resultant of dead loads, body forces and pressures, by axis"},
    {"balance.contact_force", "", "largest force_imbalance of the pairs"},
    {"balance.contact_moment", "", "largest moment_imbalance of the pairs"},
    {"balance.supports", "",
     "sum of reactions, loads and contact with rigid bodies, relative to the sum of their magnitudes, or to the nodal forces where those are more"},
    {"probe.<probe>.displacement", LENGTH, "displacement of the point, by axis"},
    {"probe.<probe>.stress", STRESS, "Cauchy stress there: xx, xy, xz, yy, yz, zz"},
    {"probe.<probe>.plastic_strain", "", "plastic strain there"},
    {"needs.tolerance", "", "what changes of the model are held against: adapt.tolerance; without one the estimated error"},
    {"needs.<part>.<name>.change", "",
     "parts of the model that could have been left out, of a pair, body, material or axis (contact, flow, fibers, mixed, kinematics, load_steps, rigid, "
     "symmetry, "
     "cells): estimated relative change of forces and energy norm"},
    {"needs.<part>.<name>.saves", "", "estimated share of the time that this would save"},
    {"needs.<part>.<name>.keeps", "", "is the change within the tolerance?"},
    {"needs.<part>.<name>.set", "", "keys of the scene that leave it out, with their values; null: without the key; plane: the mesh is cut there"},
    {"needs.<part>.<name>.why", "", "what the estimate is made from"},
    {"time.total", SECONDS, "wall time"},
    {"time.<stage>", SECONDS, "wall time of a stage, the largest of any process"},
    {"peak_memory_mb", "MB", "memory of all processes at their peaks"},
    {"peak_memory_rank_mb", "MB", "the largest of one process"},
    {NULL, NULL, NULL},
};

/* Of the grids bulk, contact and segments. Tensors: xx xy xz yy yz zz; first_piola row by row. */
const OutputField OutputFieldFields[] = {
    {"X", LENGTH, "reference position of a point"},
    {"displacement", LENGTH, "what moves it"},
    {"pressure", STRESS, "-tr(sigma)/3"},
    {"stress", STRESS, "Cauchy stress, six components"},
    {"von_mises", STRESS, "von Mises stress"},
    {"J", "", "determinant of the deformation gradient"},
    {"principal_stretches", "", "output.quantities: principal stretches, the largest first"},
    {"logarithmic_strain", "", "output.quantities: ln V = ln(F F^T)/2, six components; kinematics: small: the linear strain"},
    {"energy_density", STRESS, "output.quantities: strain energy per reference volume"},
    {"first_piola", STRESS, "output.quantities: first Piola-Kirchhoff stress P, nine components"},
    {"plastic_strain", "", "plastic strain, where a body flows"},
    {"order", "", "displacement order of a cell"},
    {"level", "", "how often it was halved in one direction"},
    {"body", "", "number of its body; attribute names: their names"},
    {"rank", "", "process that had it"},
    {"error", "root of energy", "indicator of the estimated error"},
    {"cell", "", "number of the cell that a piece is of"},
    {"gap", LENGTH, "contact: weighted gap over the weight; negative: penetration"},
    {"contact_pressure", STRESS, "contact: pressure"},
    {"status", "", "contact: 1 touches, 0 open, -1 faces nothing"},
    {"tangential_traction", STRESS, "friction: tangential traction on the body"},
    {"slip", LENGTH, "friction: slip of the load step"},
    {"normal", "", "contact: unit normal out of the body"},
    {"pair", "", "contact: number of the pair; attribute names: their names"},
    {"side", "", "contact: 0 nonmortar, 1 mortar; attribute names: these"},
    {"facet", "", "segments: number of the nonmortar facet"},
    {"mortar_facet", "", "segments: number of the mortar facet"},
    {NULL, NULL, NULL},
};

/* Does a name fit a pattern, whose <axis> is x, y or z, <component> xx, xy, ..., any other <...> a name without dots. */
static PetscBool Fits_Private(const char *pattern, const char *name)
{
  for (; *pattern && *pattern != '<'; ++pattern, ++name)
    if (*pattern != *name) return PETSC_FALSE;
  if (!*pattern) return (PetscBool) !*name;
  const size_t n = strcspn(name, ".");
  if (n == 0 || (!strncmp(pattern, "<axis>", 6) && (n != 1 || !strchr("xyz", name[0]))) || (!strncmp(pattern, "<component>", 11) && n != 2)) return PETSC_FALSE;
  return Fits_Private(strchr(pattern, '>') + 1, name + n);
}

PetscErrorCode OutputColumnName(const SceneData *scene, const OutputField fields[], const char *name, size_t size, char column[])
{
  const OutputField *row = fields;
  char               unit[64];

  PetscFunctionBegin;
  while (row->name && !Fits_Private(row->name, name)) ++row;
  PetscCall(SceneUnit(scene, row->name ? row->unit : "", sizeof(unit), unit));
  PetscCall(PetscSNPrintf(column, size, unit[0] ? "%s [%s]" : "%s", name, unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}
