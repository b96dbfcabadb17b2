/* One row per key of a scene: name, type, unit, default, range, help. Parsing, checks and -help are made from it. */
#include "sceneimpl.h"

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#define SCENE(f) offsetof(struct _p_Scene, f), sizeof(((struct _p_Scene *)0)->f)
#define MAT(f) offsetof(MaterialEntry, f), sizeof(((MaterialEntry *)0)->f)
#define FIBER(f) offsetof(MaterialFiber, f), sizeof(((MaterialFiber *)0)->f)
#define BODY(f) offsetof(BodyEntry, f), sizeof(((BodyEntry *)0)->f)
#define BOUND(f) offsetof(BoundaryEntry, f), sizeof(((BoundaryEntry *)0)->f)
#define PAIR(f) offsetof(ContactEntry, f), sizeof(((ContactEntry *)0)->f)
#define REFINE(f) offsetof(RefineEntry, f), sizeof(((RefineEntry *)0)->f)
#define POINT(f) offsetof(PointEntry, f), sizeof(((PointEntry *)0)->f)
#define PROBE(f) offsetof(ProbeEntry, f), sizeof(((ProbeEntry *)0)->f)
#define NOWHERE 0, 0
#define ORDERS "[1," TEXT(MORTISE_MAX_ORDER) "]"
#define ANY "(-inf,inf)"
#define POSITIVE "(0,inf)"
#define NOT_BELOW "[0,inf)"

const Option Options[] = {
    {"title", KEY_TEXT, "", "", "", "what the scene shows; default: name of the file", SCENE(data.title)},
    {"units", KEY_TEXT, "", "", "", "units of length, force and stress that the numbers are in, as in mm, N, MPa: checked to agree, written beside results",
     SCENE(data.units.text)},

    {"mesh.file", KEY_TEXT, "", NULL, "", ".geo: meshed by gmsh; .msh (2.2, 4.1): read as it is; relative to the scene file", SCENE(mesh_file)},
    {"mesh.order", KEY_INT, "", "2", "[1,4]", "geometry order asked of gmsh for a .geo", SCENE(mesh_order)},
    {"mesh.refine", KEY_INT, "", "0", "[0,12]", "uniform refinements before the first solve", SCENE(data.mesh.refine)},
    {"mesh.keep_flat", KEY_BOOL, "", "false", "",
     "true: cells of the plane with a flat corner, where their map is singular, stay as they are; else each and a neighbour become four",
     SCENE(data.mesh.keep_flat)},
    {"mesh.trust", KEY_BOOL, "", "false", "", "true: a .geo may run programs and write files, as gmsh lets it; only for one that you know all of",
     SCENE(trust)},
    {"mesh.parameter.<constant>", KEY_PARAMETER, "", "", ANY, "value of a constant that the .geo declares with DefineConstant", NOWHERE},

    {"refine.<name>.boundary", KEY_TEXT, "", "", "", "before the first solve, refine the cells along this boundary", REFINE(boundary)},
    {"refine.<name>.<axis>", KEY_REAL, "length", "0", ANY, "and near this reference point; at least one of boundary and point", REFINE(spec.X)},
    {"refine.<name>.radius", KEY_REAL, "length", "0", NOT_BELOW, "near: the cells that a ball of this radius around the point touches", REFINE(spec.radius)},
    {"refine.<name>.levels", KEY_INT, "", "1", "[0,16]", "how often; each time the cells that then touch", REFINE(spec.levels)},

    {"model", KEY_WORD, "", NULL, "plane_strain|axisymmetric|3d", "axisymmetric: x = r, y = z", SCENE(data.mechanics.model)},
    {"kinematics", KEY_WORD, "", "finite", "finite|small", "small: geometry and material are linear (law: linear)", SCENE(data.mechanics.kinematics)},
    {"order", KEY_INT, "", "1", ORDERS, "displacement order p of the cells", SCENE(order)},

    {"body.<name>.material", KEY_TEXT, "", NULL, "", "a name under material; <name>: physical group of top dimension", BODY(material)},
    {"body.<name>.order", KEY_INT, "", "", ORDERS,
     "displacement order of this body's cells; default: order, of a rigid body with adapt.tolerance at least mesh.order", BODY(spec.order)},
    {"body.<name>.order.<axis>", KEY_INT, "", "", ORDERS,
     "or one for each direction, {x: 3, y: 3, z: 1}: of the cell axes that run mostly along it; letters not given: order", BODY(spec.order_along)},
    {"body.<name>.motion.<axis>", KEY_EXPRESSION, "length", "", ANY, "translation of a rigid body", BODY(spec.motion)},
    {"body.<name>.motion.rotation.axis", KEY_WORD, "", "z", "x|y|z", "axis of a rotation of a rigid body, exact at any angle; the translation follows it",
     BODY(rotation_axis)},
    {"body.<name>.motion.rotation.angle", KEY_EXPRESSION, "degrees", "", ANY, "angle of the rotation", BODY(spec.rotation_angle)},
    {"body.<name>.motion.rotation.point.<axis>", KEY_REAL, "length", "0", ANY,
     "a point of the axis at the reference positions; without point: the centre of the body", BODY(spec.rotation_point)},
    {"body.<name>.load.<axis>", KEY_EXPRESSION, "force", "", ANY,
     "force on a rigid body, which is free to go in this direction; 0: nothing holds it there but contact", BODY(spec.load)},
    {"body.<name>.load.moment_x", KEY_EXPRESSION, "force times length", "", ANY,
     "moment on a rigid body about its point (moment_about), and it is free to turn about this axis", BODY(spec.load_moment[0])},
    {"body.<name>.load.moment_y", KEY_EXPRESSION, "force times length", "", ANY, "the same about y", BODY(spec.load_moment[1])},
    {"body.<name>.load.moment_z", KEY_EXPRESSION, "force times length", "", ANY, "the same about z; in the plane", BODY(spec.load_moment[2])},
    {"body.<name>.force.<axis>", KEY_EXPRESSION, "force/volume", "", ANY, "dead force per reference volume", BODY(spec.force)},
    {"body.<name>.amplitude", KEY_AMPLITUDE, "", "[0,0, 1,1]", "t rising",
     "t0,v0, t1,v1, ...: multiplies motion, load and force, piecewise linear in t; load steps end at its times; arc_length: the last piece goes on",
     BODY(spec.amplitude)},
    {"body.<name>.moment_about", KEY_TEXT, "", "", "",
     "a name under point: of a rigid body, the point that moves with it and that moments on it are counted about; default: the body's centre",
     BODY(moment_about)},

    {"material.<name>.law", KEY_TEXT, "", NULL, "", "name of a law; bin/mortise -list shows them", MAT(law)},
    {"material.<name>.volumetric", KEY_WORD, "", "quadratic", "quadratic|simo|log",
     "U(J): kappa/2 (J-1)^2 | kappa/2 ((J^2-1)/2 - ln J) | -mu ln J + lambda/2 (ln J)^2 with mu/2 (I1-3)", MAT(volumetric)},
    {"material.<name>.formulation", KEY_WORD, "", "auto", "auto|displacement|mixed",
     "mixed: pressure is a field of its own; auto: mixed for law j2 and from nu = 0.45 up; nu = 0.5 or kappa inf: incompressible, mixed alone",
     MAT(formulation)},
    {"material.<name>.<parameter>", KEY_PARAMETER, "", "", ANY, "a parameter of the law (E, nu, mu, ...); bin/mortise -list shows them with units and ranges",
     NOWHERE},
    {"material.<name>.fiber.<family>.angle", KEY_REAL, "degrees", "", ANY,
     "law hgo: direction of a family of fibres, from the circumferential direction of the frame towards its axis", FIBER(angle)},
    {"material.<name>.fiber.<family>.direction.<axis>", KEY_REAL, "", "0", ANY,
     "or one direction for all points, of any length (x, y, z; axisymmetric: z is the circumferential direction)", FIBER(direction)},
    {"material.<name>.fiber.<family>.field", KEY_TEXT, "", "", "",
     "or the name of a view $ElementData with a vector, of any length, for each cell of an ASCII .msh", FIBER(field)},
    {"material.<name>.fiber.<family>.k1", KEY_REAL, "stress", "", POSITIVE, "this family's own stiffness; default: the material's", FIBER(k1)},
    {"material.<name>.fiber.<family>.k2", KEY_REAL, "", "", POSITIVE, "this family's own k2; default: the material's", FIBER(k2)},
    {"material.<name>.fiber.<family>.compression", KEY_BOOL, "", "false", "", "fibres that push as well when shortened, for comparison only",
     FIBER(compression)},
    {"material.<name>.frame.axis", KEY_WORD, "", "", "x|y|z", "axis that circumferential directions turn around; default: z, axisymmetric: y",
     MAT(spec.frame.axis)},
    {"material.<name>.frame.point.<axis>", KEY_REAL, "length", "0", ANY, "a point of that axis", MAT(spec.frame.point)},

    {"boundary.<name>.displacement.<axis>", KEY_EXPRESSION, "length", "", ANY,
     "prescribed displacement; components not given stay free; <name>: physical group of one dimension less; boundaries that meet must agree there",
     BOUND(spec.displacement)},
    {"boundary.<name>.fix", KEY_AXES, "", "", "letters of xyz, or normal", "no displacement in these directions; normal: of a flat face of any direction",
     BOUND(spec.fix)},
    {"boundary.<name>.rotation.axis", KEY_WORD, "", "z", "x|y|z", "axis of a prescribed finite rotation, which a displacement of the boundary follows",
     BOUND(rotation_axis)},
    {"boundary.<name>.rotation.angle", KEY_EXPRESSION, "degrees", "", ANY, "angle of the rotation", BOUND(spec.rotation_angle)},
    {"boundary.<name>.rotation.point.<axis>", KEY_REAL, "length", "0", ANY, "a point of the axis", BOUND(spec.rotation_point)},
    {"boundary.<name>.pressure", KEY_EXPRESSION, "stress", "", ANY, "follower load against the outward normal", BOUND(spec.pressure)},
    {"boundary.<name>.volume", KEY_EXPRESSION, "volume", "", ANY,
     "change of the volume it encloses, an expression in t from 0 on; the follower pressure for it is found (history.csv: pressure.<name>)",
     BOUND(spec.volume)},
    {"boundary.<name>.advance", KEY_EXPRESSION, "length", "", ANY,
     "mean displacement against the outward normal, an expression in t from 0 on; the follower pressure for it is found", BOUND(spec.advance)},
    {"boundary.<name>.traction.<axis>", KEY_EXPRESSION, "force/area", "", ANY, "dead load per reference area", BOUND(spec.traction)},
    {"boundary.<name>.amplitude", KEY_AMPLITUDE, "", "[0,0, 1,1]", "t rising",
     "t0,v0, t1,v1, ...: multiplies the values of this boundary, piecewise linear in t; load steps end at its times; arc_length: the last piece goes on",
     BOUND(spec.amplitude)},
    {"boundary.<name>.moment_about", KEY_TEXT, "", "", "",
     "a name under point that the moment of the support is counted about; default: the centre of the body, or bodies, of the boundary at the reference "
     "positions",
     BOUND(moment_about)},

    {"contact.<pair>.nonmortar", KEY_GROUPS, "", "", "",
     "physical group of one dimension less, or a list [a, b] of groups that are one side together: the side that carries the contact pressure (the "
     "multiplier), unless it is the stiffer one; must be given, or surface",
     PAIR(nonmortar)},
    {"contact.<pair>.mortar", KEY_GROUPS, "", "", "", "physical group, or list of groups, of the other side; must be given, or surface", PAIR(mortar)},
    {"contact.<pair>.surface", KEY_GROUPS, "", "", "",
     "instead of two sides: one physical group, or list of groups, that may meet itself, of one body or several; which facets carry the pressure is chosen",
     PAIR(surface)},
    {"contact.<pair>.roles", KEY_WORD, "", "auto", "auto|given",
     "auto: a nonmortar side that is stiffer, as stiff and of facets twice as long, or rigid changes places with the other, unless it alone has a corner, "
     "or an edge rounded within a facet of the other side (plane), and one that has none where the other has; the run begins anew so where a corner of the "
     "mortar side presses within a facet; given: for comparison, only where it is rigid",
     PAIR(roles)},
    {"contact.<pair>.kind", KEY_WORD, "", "contact", "contact|tied",
     "tied: what faces each other at the reference positions is glued, meshes need not match; each side may have facets that face nothing", PAIR(kind)},
    {"contact.<pair>.law", KEY_WORD, "", "frictionless", "frictionless|penalty|coulomb|tied",
     "what holds between gap, pressure and slip; coulomb: that of a pair with friction; tied: that of a tied pair; penalty: for comparison only, overlaps by "
     "pressure over penalty",
     PAIR(spec.law)},
    {"contact.<pair>.penalty", KEY_REAL, "stress/length", "", POSITIVE, "stiffness of law: penalty, pressure per overlap", PAIR(spec.penalty)},
    {"contact.<pair>.friction", KEY_EXPRESSION, "", "0", NOT_BELOW,
     "coefficient of Coulomb friction, also as an expression in t that is never negative; axisymmetric without twist; load.control: time", PAIR(spec.friction)},
    {"contact.<pair>.order", KEY_WORD, "", "auto", "1|full|auto",
     "order of the contact faces; full: that of their cells, with their curved geometry; auto: full, but 1 with subdivide, node_to_segment or orders per "
     "direction",
     PAIR(order)},
    {"contact.<pair>.subdivide", KEY_WORD, "", "0", "0|1|2|3|4|5|6|7|8|auto",
     "before the first solve, how often to subdivide the cells that touch either side, so that linear faces are as accurate as the cells' order; auto: "
     "at each load step, until the estimated error of these cells no longer exceeds that of the cells inside, at most order + 1 times",
     PAIR(subdivide)},
    {"contact.<pair>.search", KEY_REAL, "edges", "0", NOT_BELOW,
     "distance of the search, in multiples of the larger edge; 0: automatic; of a tied pair: what is further apart is not tied, 0: a tenth of the smaller side",
     PAIR(spec.search)},
    {"contact.<pair>.initial_gap", KEY_WORD, "", "keep", "keep|adjust|ramp|close",
     "adjust: what faces each other at the reference positions counts as touching, so that facets on a curved surface make no gap; ramp: bodies that overlap "
     "there are pressed apart step by step, as if one of them grew from where it just touches at t = 0 to its size at t = 1; of a tied pair: keep: gaps stay "
     "and turn with the surface, close: gaps are closed",
     PAIR(initial_gap)},
    {"contact.<pair>.interference", KEY_EXPRESSION, "length", "", ANY,
     "overlap at the reference positions, taken off the gap (shrink fit); an expression in t is brought in step by step, a number is there from the start",
     PAIR(spec.interference)},
    {"contact.<pair>.multiplier", KEY_WORD, "", "dual", "dual|standard",
     "basis of the contact pressure: dual to the functions of the nodes, or these themselves", PAIR(multiplier)},
    {"contact.<pair>.moment_about", KEY_TEXT, "", "", "",
     "a name under point that the moments of the contact forces are counted about; default: the centre of the body, or bodies, of the nonmortar side at the "
     "reference positions",
     PAIR(moment_about)},
    {"contact.<pair>.node_to_segment", KEY_BOOL, "", "false", "", "node-to-segment contact, for comparison only", PAIR(spec.node_to_segment)},
    {"contact.<pair>.see_through", KEY_BOOL, "", "false", "",
     "for comparison only: searches look through bodies and take the far side of one behind, within their distance, for an overlap", PAIR(spec.see_through)},
    {"contact.<pair>.stabilise", KEY_BOOL, "", "true", "",
     "false, for comparison only: in the plane, pressures on facets of a stiffer or rigid side that are much shorter than those of the other one are not "
     "stabilised",
     PAIR(spec.stabilise)},

    {"load.end", KEY_REAL, "pseudo-time", "1", POSITIVE, "t runs from 0 to here", SCENE(data.load.end)},
    {"load.step", KEY_REAL, "pseudo-time", "", POSITIVE, "first step, 1e-8 of end or more; default: end/10", SCENE(data.load.step)},
    {"load.step_min", KEY_REAL, "pseudo-time", "", POSITIVE, "a step that would have to be smaller is given up; default: step/1024", SCENE(data.load.step_min)},
    {"load.step_max", KEY_REAL, "pseudo-time", "", POSITIVE,
     "steps grow to this size; default: step; arc_length: lengths are to the first as step_min and step_max are to step", SCENE(data.load.step_max)},
    {"load.max_steps", KEY_INT, "", "10000", "[1,1000000]", "a run that is not through after so many load steps is given up", SCENE(data.load.max_steps)},

    {"load.control", KEY_WORD, "", "time", "time|arc_length",
     "arc_length: t, the factor of all loads, is found along the path of equilibria, through limit points, until it reaches end", SCENE(data.load.control)},
    {"load.stable", KEY_BOOL, "", "true", "",
     "where the equilibrium found is unstable, as that of a column beyond its critical load, a stable one of less energy is taken; not along a path "
     "(arc_length), nor where there is no energy to find it by: friction, tied pairs, follower loads, loads of rigid bodies, plastic flow, incompressible "
     "material; there it is told",
     SCENE(data.load.stable)},
    {"load.stop_displacement", KEY_REAL, "length", "0", NOT_BELOW, "the run ends once a displacement component is as large; 0: it does not",
     SCENE(data.load.stop_displacement)},

    {"adapt.tolerance", KEY_REAL, "", "0", "[0,1)", "relative estimated error to reach, in the energy norm; 0: no adaptation", SCENE(data.adapt.tolerance)},
    {"adapt.max_passes", KEY_INT, "", TEXT(FOREST_MAX_LEVEL), "[0,100]",
     "adaptive passes at each load step; repeat: path: of the whole path; by default as many as a cell can be split, so that max_cells is the limit",
     SCENE(data.adapt.max_passes)},
    {"adapt.max_cells", KEY_INT, "", "200000", "[1,100000000]",
     "no refinement beyond this number of cells, counted as in summary.json: with those of rigid bodies", SCENE(data.adapt.max_cells)},
    {"adapt.fraction", KEY_REAL, "", "0.8", "(0,1]", "share of the squared estimate that the cells to be refined carry", SCENE(data.adapt.fraction)},
    {"adapt.alike", KEY_REAL, "", "0", "[0,1)",
     "cells whose squared indicators differ by less than this share are treated alike where that can be: marking ends at the widest gap among them",
     SCENE(data.adapt.alike)},
    {"adapt.coarsen", KEY_REAL, "", "0", "[0,1)", "cells below this share of the mean squared indicator may merge; 0: none", SCENE(data.adapt.coarsen)},
    {"adapt.anisotropic", KEY_BOOL, "", "false", "", "split cells only in the directions that matter for the error", SCENE(data.adapt.anisotropic)},
    {"adapt.share", KEY_REAL, "", "0.05", "[0,1]", "anisotropic: directions with less than this share of the largest one's squared estimate do not matter",
     SCENE(data.adapt.share)},
    {"adapt.aspect", KEY_REAL, "", "64", "[1,1e6]", "anisotropic: no split leaves an edge more than this many times as long as the cell's shortest",
     SCENE(data.adapt.aspect)},
    {"adapt.strategy", KEY_WORD, "", "h", "h|p|hp", "what adaptation changes: cells are split, their orders raised, or whichever suits the solution in each",
     SCENE(data.adapt.strategy)},
    {"adapt.repeat", KEY_WORD, "", "step", "step|path",
     "what is computed again on a refined mesh: the load step, with the state carried over; or the whole path of loads from t = 0, with nothing carried over",
     SCENE(data.adapt.repeat)},
    {"adapt.history", KEY_WORD, "", "carried", "carried|nearest|none",
     "what new cells know of the load steps before. carried: plastic flow by way of the elastic strain, and where slip counts from; for comparison only: "
     "nearest, the flow of the nearest old point; none, no flow, and slip counts from the solution found on the coarser mesh",
     SCENE(data.adapt.history)},
    {"adapt.max_order", KEY_INT, "", "8", "[1,8]", "strategies p and hp: no cell above this order", SCENE(data.adapt.max_order)},

    {"output.directory", KEY_TEXT, "", "", "", "relative to the working directory; default: out/<name of the scene>", SCENE(data.output.directory)},
    {"output.overwrite", KEY_BOOL, "", "false", "",
     "true: files in it that a run would write, but none has written, are replaced all the same, and those that viewers of PETSc name",
     SCENE(data.output.overwrite)},
    {"output.fields", KEY_BOOL, "", "true", "", "write fields.xdmf and its HDF5 files", SCENE(data.output.fields)},
    {"output.divide", KEY_WORD, "", "auto", "auto|1|2|3|4|5|6|7|8", "pieces of a cell in each direction in fields.xdmf; auto: as many as its order",
     SCENE(data.output.divide)},
    {"output.quantities", KEY_WORDS, "", "", "principal_stretches|logarithmic_strain|energy_density|first_piola",
     "further fields of the bodies in fields.xdmf, with commas between; stress (Cauchy), pressure, von_mises and J are always there",
     SCENE(data.output.quantities)},
    {"output.segments", KEY_BOOL, "", "false", "", "write the pieces of facets that face each other (segments) as a grid of fields.xdmf too",
     SCENE(data.output.segments)},
    {"output.checkpoint", KEY_INT, "load steps", "1", NOT_BELOW,
     "write checkpoint.h5, from which -restart goes on, every so many accepted load steps, and at the end; 0: only when the run is stopped; the one before "
     "stays beside it until the run ends",
     SCENE(data.output.checkpoint)},

    {"probe.<name>.<axis>", KEY_REAL, "length", "0", ANY, "reference point whose fields go to history.csv and summary.json", PROBE(spec.X)},
    {"probe.<name>.body", KEY_TEXT, "", "", "", "the body it is a point of, where several touch; default: the first that has it", PROBE(spec.body)},

    {"point.<name>.<axis>", KEY_REAL, "length", "0", ANY,
     "reference position of a point that moments may be counted about (moment_about); it need not be in a body", POINT(X)},
    {NULL, KEY_TEXT, NULL, NULL, NULL, NULL, NOWHERE},
};

static PetscErrorCode PrintRow_Private(MPI_Comm comm, const Option *row)
{
  static const char *const kinds[] = {
      "text", "", "integer", "number", "true|false", "number or expression", "list of numbers", "", "number", "any of", "name or list of names"};
  char        key[128], kind[512];
  const char *axis = strstr(row->pattern, "<axis>"), *range = strcmp(row->range, ANY) ? row->range : "";

  PetscFunctionBegin;
  if (axis)
    PetscCall(PetscSNPrintf(key, sizeof(key), "%.*s<x|y|z>", (int)(axis - row->pattern), row->pattern));
  else
    PetscCall(PetscStrncpy(key, row->pattern, sizeof(key)));
  PetscCall(PetscSNPrintf(kind, sizeof(kind), "%s%s%s%s%s%s%s%s", kinds[row->type], kinds[row->type][0] && range[0] ? " " : "", range, row->unit[0] ? " [" : "",
                          row->unit, row->unit[0] ? "]" : "", row->fallback ? (row->fallback[0] ? "; default " : "") : "; must be given",
                          row->fallback ? row->fallback : ""));
  PetscCall(HelpRow(comm, key, kind, row->help));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScenePrintHelp(MPI_Comm comm)
{
  char section[MORTISE_NAME] = "";

  PetscFunctionBegin;
  PetscCall(HelpText(comm,
                     "mortise %s: adaptive mortar contact of bodies that deform a lot\n\n"
                     "  mortise SCENE.yml [options]     solve; mpiexec -n 4 mortise ... on four processes\n"
                     "  mortise SCENE.yml -check        say what would be solved, refuse what a run would refuse; solve and write nothing\n"
                     "  mortise new NAME                write NAME.yml and NAME.geo, a commented scene to start from\n"
                     "  mortise -help                   this text, also -h and --help; -help WORD: keys and options with that word in them;\n"
                     "                                  -help json: its tables, for programs\n"
                     "  mortise -list                   models, laws with their parameters, boundary kinds\n"
                     "  mortise --version               its version\n\n"
                     "Keys of a scene. Any of them can be set on the command line, which wins over the file: material.rubber.E is -material_rubber_E.\n"
                     "-options_file FILE reads such options from a file, one a line, values with spaces in quotes; the command line wins over it too.\n"
                     "Expressions are in X, Y, Z (reference position), t (pseudo-time) and pi: \"0.1*Y*sin(pi*t)\". The program is free of units: use any\n"
                     "consistent set; a word in [] names the kind of quantity.\n",
                     MORTISE_VERSION));
  for (const Option *row = Options; row->pattern; ++row) {
    size_t n = strcspn(row->pattern, ".");
    if (strncmp(section, row->pattern, n) || section[n]) {
      PetscCall(HelpText(comm, "\n"));
      PetscCall(PetscSNPrintf(section, sizeof(section), "%.*s", (int)n, row->pattern));
    }
    PetscCall(PrintRow_Private(comm, row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintLaws_Private(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(comm, "\nmaterial laws (material.<name>.law) and their parameters\n"));
  for (const MaterialLaw *law = MaterialLaws; law->name; ++law) {
    PetscCall(PetscPrintf(comm, "  %-22s %s\n", law->name, law->help));
    for (const MaterialParameter *p = law->parameters; p && p->name; ++p) {
      char lo[32] = "-inf", hi[32] = "inf";
      if (p->min > -1e30) (void)snprintf(lo, sizeof(lo), "%g", (double)p->min);
      if (p->max < 1e30) (void)snprintf(hi, sizeof(hi), "%g", (double)p->max);
      PetscCall(PetscPrintf(comm, "    %-12s (%s,%s%s%s%s%s  %s\n", p->name, lo, hi, MaterialIsLimit(p, p->max) ? "]" : ")", p->unit && p->unit[0] ? " [" : "",
                            p->unit ? p->unit : "", p->unit && p->unit[0] ? "]" : "", p->help));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScenePrintList(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(comm, "models (model)\n"
                              "  plane_strain   two dimensions, per unit thickness\n"
                              "  axisymmetric   x = r, y = z; forces of the full revolution\n"
                              "  3d             three dimensions\n"
                              "\nkinematics\n"
                              "  finite         large displacements and strains\n"
                              "  small          geometry and material linear (law: linear)\n"));
  PetscCall(PrintLaws_Private(comm));
  PetscCall(PetscPrintf(comm, "\nboundary kinds (boundary.<name>)\n"
                              "  displacement   {x, y, z}: prescribed, components not given stay free\n"
                              "  fix            letters of xyz, or normal\n"
                              "  rotation       {axis, angle, point}: finite rotation in degrees\n"
                              "  pressure       follower, against the outward normal\n"
                              "  volume         change of the enclosed volume; the follower pressure is found\n"
                              "  advance        mean displacement against the outward normal; the follower pressure is found\n"
                              "  traction       {x, y, z}: dead, per reference area\n"
                              "\nbody kinds (body.<name>)\n"
                              "  material       deformable, or moved by motion {x, y, z, rotation} when its law is rigid\n"
                              "  load           {x, y, z, moment_x, moment_y, moment_z}: forces and a moment that move a rigid body\n"
                              "  force          {x, y, z}: dead, per reference volume\n"
                              "\ncontact (contact.<pair>)\n"
                              "  mortar         dual multipliers on the nonmortar side, frictionless\n"
                              "  node_to_segment  for comparison only\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
