/* Meshes written by gmsh in the working directory: formats, orders, groups, conversion of simplices, and the sentence for each kind of bad file. */
#include "forest_box.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static PetscMPIInt rank;

static void WriteFile(const char *name, const char *text)
{
  if (rank) return;
  FILE *file = fopen(name, "w");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

/* No environment but what tests/tools/gmsh keeps meshes by. */
#define BARE "env -i PATH=\"$PATH\" MORTISE_TEST_GMSH=\"$MORTISE_TEST_GMSH\" MORTISE_TEST_MESHES=\"$MORTISE_TEST_MESHES\""

/* Run gmsh on rank 0, in a bare environment: it may use MPI itself. */
static void Gmsh(const char *geo, const char *arguments, const char *mesh)
{
  WriteFile("test.geo", geo);
  if (rank == 0) {
    char command[1024];
    snprintf(command, sizeof(command), BARE " HOME=\"$HOME\" gmsh test.geo %s -o %s > gmsh.log 2>&1", arguments, mesh);
    assert_int_equal(system(command), 0);
  }
  OK(MPI_Barrier(PETSC_COMM_WORLD));
}

static Forest Read(const char *file, PetscInt dim, PetscInt refine)
{
  ForestSpec spec = {.dim = dim, .refine = refine};
  Forest     forest;

  OK(PetscStrncpy(spec.file, file, sizeof(spec.file)));
  OK(ForestCreate(PETSC_COMM_WORLD, &spec, &forest));
  return forest;
}

/* Volume by 4-point Gauss in each direction of each coarse cell: exact up to order 2, 1e-6 or better for smooth order 4. */
static PetscReal Volume(Forest forest)
{
  static const PetscReal point[4]  = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
  static const PetscReal weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
  const CoarseMesh      *mesh      = &forest->coarse->mesh;
  PetscReal              volume    = 0;

  for (PetscInt c = 0; c < mesh->num_cells; ++c)
    for (PetscInt q = 0; q < (mesh->dim == 2 ? 16 : 64); ++q) {
      const PetscReal xi[3] = {point[q & 3], point[(q >> 2) & 3], point[q >> 4]};
      PetscReal       X[3], J[9];
      ForestCoarseMapPoint(mesh, c, xi, X, J);
      volume += weight[q & 3] * weight[(q >> 2) & 3] * (mesh->dim == 3 ? weight[q >> 4] * Det3(J) : J[0] * J[3] - J[1] * J[2]);
    }
  return volume;
}

/* Facets of a boundary group by name, and how far their points are from the radius (in x, y): checks that the right facets have the name. */
static PetscInt GroupFacets(Forest forest, const char *name, PetscReal radius, PetscReal *worst)
{
  const ForestTables *t    = &forest->tables;
  const CoarseMesh   *mesh = &forest->coarse->mesh;
  PetscInt            num = 0, b = 0;

  while (b < mesh->num_boundaries && strcmp(mesh->boundary_name[b], name)) ++b;
  assert_true(b < mesh->num_boundaries);
  *worst = 0;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) {
    const PetscReal eta[2] = {0.4, 0.7};
    PetscReal       X[3];
    if (!((t->boundary[f] >> b) & 1)) continue;
    ++num;
    EntityPoint(forest, f, eta, X);
    *worst = PetscMax(*worst, PetscAbsReal(PetscSqrtReal(X[0] * X[0] + X[1] * X[1]) - radius));
  }
  return num;
}

/* Quarter of a ring, radii 1 and 2. Its loop runs clockwise when `sense` is -1: cells come turned over. */
#define RING(sense, groups)                                                                                                                                    \
  "Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={2,0,0};Point(4)={0,2,0};Point(5)={0,1,0};\n"                                                                    \
  "Line(1)={2,3};Circle(2)={3,1,4};Line(3)={4,5};Circle(4)={5,1,2};\n"                                                                                         \
  "Curve Loop(1)={" sense "1," sense "2," sense "3," sense "4};Plane Surface(1)={1};\n"                                                                        \
  "Transfinite Curve{1,3}=4;Transfinite Curve{2,4}=7;Transfinite Surface{1};Recombine Surface{1};\n" groups
#define NAMED                                                                                                                                                  \
  "Physical Curve(\"all sides\",9)={1,2,3,4};Physical Surface(\"ring body\",7)={1};Physical Curve(\"inner\",3)={4};Physical Curve(\"outer\",2)={2};\n"

/* Exact 3 pi/4. Straight cells: six trapezoids between the radii, 6 (4 - 1)/2 sin(pi/12). */
static void test_ring(void **state)
{
  static const char *const format[] = {"msh22", "msh22 -bin", "msh41", "msh41 -bin"};
  const PetscReal          exact = 0.75 * PETSC_PI, straight = 9 * PetscSinReal(PETSC_PI / 12);

  for (int f = 0; f < 4; ++f)
    for (int q = 1; q <= 4; ++q) {
      char      arguments[128];
      PetscReal worst;
      snprintf(arguments, sizeof(arguments), "-2 -order %d -format %s", q, format[f]);
      Gmsh(RING("", NAMED), arguments, "ring.msh");
      Forest            forest = Read("ring.msh", 2, 0);
      const CoarseMesh *mesh   = &forest->coarse->mesh;
      assert_int_equal(mesh->num_cells, 18);
      assert_int_equal(mesh->num_vertices, 28);
      assert_int_equal(mesh->geometry_order, q);
      assert_int_equal(mesh->num_bodies, 1);
      assert_string_equal(mesh->body_name[0], "ring body");
      assert_int_equal(mesh->num_boundaries, 3);
      assert_string_equal(mesh->boundary_name[0], "outer"); /* by tag */
      assert_string_equal(mesh->boundary_name[1], "inner");
      assert_string_equal(mesh->boundary_name[2], "all sides");
      for (PetscInt c = 0; c < 18; ++c) assert_int_equal(mesh->cell_body[c], 0);
      const PetscReal area = Volume(forest), limit[5] = {0, 1, 3e-5, 3e-6, 2e-8}; /* relative */
      if (rank == 0) print_message("  %s order %d: area %.9f, exact %.9f\n", format[f], q, (double)area, (double)exact);
      if (q == 1) assert_true(PetscAbsReal(area - straight) < 1e-12);
      assert_true(PetscAbsReal(area - exact) < limit[q] * exact);
      assert_int_equal(GroupFacets(forest, "inner", 1, &worst), 6);
      assert_true(worst < (q == 1 ? 0.04 : 1e-4));
      assert_int_equal(GroupFacets(forest, "outer", 2, &worst), 6);
      assert_true(worst < (q == 1 ? 0.08 : 2e-4));
      assert_int_equal(GroupFacets(forest, "all sides", 0, &worst), 18);
      OK(ForestDestroy(&forest));
    }
}

/* Twice as many cells around: the error of the area falls by 2^4. */
static void test_ring_rate(void **state)
{
  for (int q = 2; q <= 3; ++q) {
    PetscReal error[2];
    for (int level = 0; level < 2; ++level) {
      char arguments[128], geo[2048];
      snprintf(geo, sizeof(geo), "%sTransfinite Curve{2,4}=%d;\n%s", RING("", ""), level ? 5 : 3, NAMED);
      snprintf(arguments, sizeof(arguments), "-2 -order %d -format msh41", q);
      Gmsh(geo, arguments, "ring.msh");
      Forest forest = Read("ring.msh", 2, 1);
      error[level]  = PetscAbsReal(Volume(forest) - 0.75 * PETSC_PI);
      OK(ForestDestroy(&forest));
    }
    assert_true(error[1] < error[0] / 12); /* h^4 in the area for both */
  }
}

static void test_turned_over(void **state)
{
  PetscReal worst;

  Gmsh(RING("-", NAMED), "-2 -order 2 -format msh41", "ring.msh");
  Forest forest = Read("ring.msh", 2, 1);
  assert_true(PetscAbsReal(Volume(forest) - 0.75 * PETSC_PI) < 1e-4);
  assert_int_equal(GroupFacets(forest, "inner", 1, &worst), 12);
  assert_true(worst < 1e-4);
  assert_int_equal(forest->tables.num_leaves, 72);
  OK(ForestDestroy(&forest));
}

/* Without names the tags are the names; a file saved with everything has vertices that belong to no cell. */
static void test_unnamed(void **state)
{
  PetscReal worst;

  Gmsh(RING("", "Physical Surface(7)={1};Physical Curve(3)={4};Physical Curve(2)={2};Physical Curve(9)={1,2,3,4};\n"), "-2 -order 1 -format msh22 -save_all",
       "ring.msh");
  Forest forest = Read("ring.msh", 2, 0);
  assert_int_equal(forest->coarse->mesh.num_vertices, 28);
  OK(ForestDestroy(&forest));
  Gmsh(RING("", "Physical Surface(7)={1};Physical Curve(3)={4};Physical Curve(2)={2};Physical Curve(9)={1,2,3,4};\n"), "-2 -order 1 -format msh41", "ring.msh");
  forest = Read("ring.msh", 2, 0);
  assert_string_equal(forest->coarse->mesh.body_name[0], "7");
  assert_int_equal(GroupFacets(forest, "2", 2, &worst), 6);
  assert_int_equal(GroupFacets(forest, "3", 1, &worst), 6);
  assert_int_equal(GroupFacets(forest, "9", 1, &worst), 18);
  OK(ForestDestroy(&forest));
}

#define BACKWARDS(group)                                                                                                                                       \
  "Point(1)={0,0,0};Point(2)={1,0,0};Point(3)={1,1,0};Point(4)={0,1,0};Line(1)={2,1};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Curve Loop(1)={-1,2,3,4};\n"    \
  "Plane Surface(1)={1};Transfinite Curve{1,2,3,4}=3;Transfinite Surface{1};Recombine Surface{1};Physical Surface(\"s\",2)={-1};Physical Curve(\"a\"," group   \
  ")={-1,3};\n"

/* Groups that name entities backwards are whole; the one case that PETSc would lose is refused. */
static void test_backwards(void **state)
{
  static const char *const format[] = {"msh22", "msh41", "msh41 -bin"};

  for (int f = 0; f < 3; ++f) {
    char      arguments[64];
    PetscReal worst;
    snprintf(arguments, sizeof(arguments), "-2 -format %s", format[f]);
    Gmsh(BACKWARDS("5"), arguments, "back.msh");
    Forest forest = Read("back.msh", 2, 0);
    assert_int_equal(forest->coarse->mesh.num_boundaries, 1);
    assert_int_equal(GroupFacets(forest, "a", 0, &worst), 4);
    assert_string_equal(forest->coarse->mesh.body_name[0], "s");
    for (PetscInt c = 0; c < 4; ++c) assert_int_equal(forest->coarse->mesh.cell_body[c], 0);
    OK(ForestDestroy(&forest));
  }
}

#define SQUARES(recombine)                                                                                                                                     \
  "Point(1)={0,0,0,.4};Point(2)={1,0,0,.4};Point(3)={1,1,0,.4};Point(4)={0,1,0,.4};Point(5)={2,0,0,.4};Point(6)={2,1,0,.4};\n"                                 \
  "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,1};Line(5)={2,5};Line(6)={5,6};Line(7)={6,3};\n"                                                       \
  "Curve Loop(1)={1,2,3,4};Plane Surface(1)={1};Curve Loop(2)={5,6,7,-2};Plane Surface(2)={2};\n" recombine                                                    \
  "Physical Surface(\"left\",1)={1};Physical Surface(\"right\",2)={2};Physical Curve(\"middle\",1)={2};Physical Curve(\"bottom\",2)={1,5};\n"

/* Triangles become quads, curved or not; mixed with quads too. The group in the interior and the two bodies survive. */
static void test_simplices_2d(void **state)
{
  for (int v = 0; v < 2; ++v)
    for (int q = 1; q <= 2; ++q) {
      char arguments[320];
      snprintf(arguments, sizeof(arguments), "-2 -order %d -format msh41", q);
      Gmsh(v ? SQUARES("Recombine Surface{2};") : SQUARES(""), arguments, "squares.msh");
      Forest              forest  = Read("squares.msh", 2, 0);
      const CoarseMesh   *mesh    = &forest->coarse->mesh;
      const ForestTables *t       = &forest->tables;
      PetscReal           part[2] = {0, 0};
      PetscInt            shared = 0, bottom = 0;
      assert_true(PetscAbsReal(Volume(forest) - 2) < 1e-12);
      assert_int_equal(mesh->num_bodies, 2);
      for (PetscInt l = 0; l < t->num_leaves; ++l) {
        PetscReal X[3];
        OK(ForestMapPoint(forest, l, (const PetscReal[3]){0.5, 0.5, 0.5}, X));
        assert_int_equal(mesh->cell_body[t->leaf_root[l]], X[0] > 1);
        assert_int_equal(t->leaf_body[l], X[0] > 1);
        part[X[0] > 1] += 1;
      }
      for (PetscInt f = t->first[1]; f < t->first[2]; ++f) {
        PetscReal X[3];
        EntityPoint(forest, f, (const PetscReal[2]){0.3, 0}, X);
        assert_int_equal(t->boundary[f], (PetscAbsReal(X[0] - 1) < 1e-12 ? 1 : 0) + (PetscAbsReal(X[1]) < 1e-12 ? 2 : 0));
        shared += t->boundary[f] == 1;
        bottom += t->boundary[f] == 2;
      }
      assert_true(shared >= 4 && bottom >= 8);
      if (rank == 0) print_message("  %s order %d: %d + %d quads\n", v ? "mixed" : "triangles", q, (int)part[0], (int)part[1]);
      OK(ForestDestroy(&forest));
    }
}

#define CUBE(more)                                                                                                                                             \
  "SetFactory(\"OpenCASCADE\");Box(1)={0,0,0,1,1,1};Mesh.CharacteristicLengthMax=0.6;Mesh.CharacteristicLengthMin=0.6;\n"                                      \
  "Physical Volume(\"cube\",1)={1};Physical Surface(\"low x\",4)={1};Physical Surface(\"some\",2)={1,2,5};\n" more

static void CheckCube(Forest forest, PetscInt order)
{
  const ForestTables *t    = &forest->tables;
  PetscReal           area = 0;

  assert_true(PetscAbsReal(Volume(forest) - 1) < 1e-12);
  assert_int_equal(forest->coarse->mesh.geometry_order, order);
  assert_string_equal(forest->coarse->mesh.boundary_name[0], "some");
  assert_string_equal(forest->coarse->mesh.boundary_name[1], "low x");
  for (PetscInt f = t->first[2]; f < t->first[3]; ++f) {
    PetscReal X[3], eta[2] = {0.3, 0.4};
    EntityPoint(forest, f, eta, X);
    const uint64_t expected = PetscAbsReal(X[0]) < 1e-12 ? 3 : PetscAbsReal(X[0] - 1) < 1e-12 || PetscAbsReal(X[2]) < 1e-12 ? 1 : 0;
    assert_true(t->boundary[f] == expected);
    area += expected == 3;
  }
  assert_true(area > 0);
}

static void test_cube(void **state)
{
  Gmsh(CUBE(""), "-3 -order 1 -format msh41", "cube.msh");
  Forest forest = Read("cube.msh", 3, 0);
  CheckCube(forest, 1);
  OK(ForestDestroy(&forest));
  Gmsh(CUBE("Mesh.SubdivisionAlgorithm=2;"), "-3 -order 2 -format msh41 -bin", "cube.msh");
  forest = Read("cube.msh", 3, 0);
  CheckCube(forest, 2);
  OK(ForestDestroy(&forest));
}

/* A ball of hexes with all orientations, order 2 and 3, against 4 pi / 3. */
static void test_ball(void **state)
{
  const PetscReal limit[4] = {0, 0, 1e-4, 1e-4};

  for (int q = 2; q <= 3; ++q) {
    char arguments[320];
    snprintf(arguments, sizeof(arguments), "-3 -order %d -format msh41", q);
    Gmsh("SetFactory(\"OpenCASCADE\");Sphere(1)={0,0,0,1};Mesh.CharacteristicLengthMax=0.9;Mesh.SubdivisionAlgorithm=2;Physical "
         "Volume(\"ball\",1)={1};Physical Surface(\"skin\",1)={1};\n",
         arguments, "ball.msh");
    Forest          forest = Read("ball.msh", 3, 0);
    const PetscReal volume = Volume(forest);
    if (rank == 0) print_message("  ball order %d: %d cells, volume %.7f, exact %.7f\n", q, (int)forest->tables.num_leaves, (double)volume, 4 * PETSC_PI / 3);
    assert_true(PetscAbsReal(volume - 4 * PETSC_PI / 3) < limit[q] * volume);
    OK(ForestDestroy(&forest));
  }
}

/* ForestCreate fails alike on all ranks; rank 0 says a sentence that contains `expected`, and nothing else. */
static void Refused(const char *file, PetscInt dim, const char *expected)
{
  ForestSpec spec = {.dim = dim};
  Forest     forest;
  char       said[4096] = "";

  OK(PetscStrncpy(spec.file, file, sizeof(spec.file)));
  OK(MPI_Barrier(PETSC_COMM_WORLD));
  fflush(stderr);
  char name[32];
  snprintf(name, sizeof(name), "stderr.%d", rank);
  const int saved = dup(2), to = open(name, O_CREAT | O_TRUNC | O_WRONLY, 0600);
  dup2(to, 2);
  const PetscErrorCode status = ForestCreate(PETSC_COMM_WORLD, &spec, &forest);
  fflush(stderr);
  dup2(saved, 2);
  close(to);
  close(saved);
  FILE *in = fopen(name, "r");
  assert_non_null(in);
  said[fread(said, 1, sizeof(said) - 1, in)] = 0;
  fclose(in);
  assert_int_equal(status, MORTISE_ERR_INPUT);
  if (rank) {
    assert_string_equal(said, "");
    return;
  }
  print_message("  %s", said);
  assert_non_null(strstr(said, expected));
  assert_int_equal(strncmp(said, "mortise: ", 9), 0);
  assert_ptr_equal(strchr(said, '\n'), said + strlen(said) - 1); /* one line */
}

#define HEAD "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"

static void test_bad_files(void **state)
{
  Refused("absent.msh", 2, "cannot be opened");
  WriteFile("bad.msh", "solid teapot\nfacet normal 0 0 1\n");
  Refused("bad.msh", 2, "not a gmsh file");
  WriteFile("bad.msh", "");
  Refused("bad.msh", 2, "not a gmsh file");
  WriteFile("bad.msh", "$MeshFormat\n3.0 0 8\n$EndMeshFormat\n");
  Refused("bad.msh", 2, "version 3.0");
  WriteFile("bad.msh", "$MeshFormat\n");
  Refused("bad.msh", 2, "no format version");
  WriteFile("bad.msh", HEAD "$PhysicalNames\n2\n2 1 \"a\"\n");
  Refused("bad.msh", 2, "ends too early");
  WriteFile("bad.msh", HEAD "$PhysicalNames\n1\n2 1 \"a\"\n$EndPhysicalNames\n$PhysicalNames\n1\n2 2 \"b\"\n$EndPhysicalNames\n");
  Refused("bad.msh", 2, "two sections");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n");
  Refused("bad.msh", 2, "truncated");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 5\n$EndElements\n");
  Refused("bad.msh", 2, "names a node twice or one that is not there");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 00\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  Refused("bad.msh", 2, "damaged");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  Refused("bad.msh", 3, "no cells of dimension 3");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  Refused("bad.msh", 2, "cell 1 of 1, centre (0.5, 0.5, 0), is inverted");
  WriteFile("bad.msh", HEAD "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 1\n4 0 1 0\n$EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n");
  Refused("bad.msh", 2, "not plane");
  WriteFile("bad.msh", HEAD "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n$EndNodes\n$Elements\n3\n1 3 2 1 1 1 2 3 4\n2 3 2 1 1 2 5 6 3\n3 "
                            "3 2 1 1 2 3 6 5\n$EndElements\n");
  Refused("bad.msh", 2, "one cell listed twice");
  WriteFile("bad.msh", HEAD "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 1 0\n7 2 -1 0\n8 2 .5 0\n$EndNodes\n$Elements\n3\n1 3 2 1 1 1 2 3 4\n"
                            "2 3 2 1 1 2 5 6 3\n3 3 2 1 1 2 7 8 3\n$EndElements\n");
  Refused("bad.msh", 2, "share one edge");
  WriteFile("bad.msh", HEAD "$PhysicalNames\n1\n1 1 \"depth\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
                            "$Elements\n2\n1 1 2 1 1 1 2\n2 3 2 1 1 1 2 3 4\n$EndElements\n");
  Refused("bad.msh", 2, "reserved");
  for (int binary = 0; binary < 2; ++binary) {
    Gmsh(BACKWARDS("1"), binary ? "-2 -format msh41 -bin" : "-2 -format msh41", "back.msh");
    Refused("back.msh", 2, "backwards");
  }
  Gmsh(CUBE(""), "-3 -format msh41", "cube.msh");
  Refused("cube.msh", 2, "cells of dimension 3");
  WriteFile("wedge.msh",
            HEAD "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 0 1\n6 0 1 1\n$EndNodes\n$Elements\n1\n1 6 2 1 1 1 2 3 4 5 6\n$EndElements\n");
  Refused("wedge.msh", 3, "shape");
}

/* A good file cut anywhere is refused with a sentence or, cut in its closing line, read: never a crash, never an unhandled error. */
static void test_cut_files(void **state)
{
  static const char *const format[] = {"msh22", "msh41", "msh41 -bin"};
  static char              bytes[100000];

  if (rank) return;
  for (int f = 0; f < 3; ++f) {
    char arguments[320];
    snprintf(arguments, sizeof(arguments), BARE " gmsh test.geo -2 -order 2 -format %s -o whole.msh > gmsh.log 2>&1", format[f]);
    WriteFile("test.geo", RING("", NAMED));
    assert_int_equal(system(arguments), 0);
    FILE *in = fopen("whole.msh", "rb");
    assert_non_null(in);
    const size_t size = fread(bytes, 1, sizeof(bytes), in);
    fclose(in);
    int refused = 0, tried = 0;
    for (size_t cut = 1; cut < size; cut += size / 61) {
      ForestSpec spec = {.dim = 2, .file = "cut.msh"};
      CoarseMesh mesh;
      char       message[1024];
      PetscInt   num_facets, *vertices = NULL;
      uint64_t  *groups = NULL;
      FILE      *out    = fopen("cut.msh", "wb");
      assert_int_equal(fwrite(bytes, 1, cut, out), cut);
      fclose(out);
      OK(ForestReadGmsh(&spec, &mesh, &num_facets, &vertices, &groups, sizeof(message), message));
      refused += message[0] != 0;
      ++tried;
      OK(ForestCoarseMeshDestroy(&mesh));
      OK(PetscFree(vertices));
      OK(PetscFree(groups));
    }
    print_message("  %s: %d of %d cut files refused\n", format[f], refused, tried);
    assert_true(refused >= tried - 2);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ring),     cmocka_unit_test(test_ring_rate), cmocka_unit_test(test_turned_over),
                                     cmocka_unit_test(test_unnamed),  cmocka_unit_test(test_backwards), cmocka_unit_test(test_simplices_2d),
                                     cmocka_unit_test(test_cube),     cmocka_unit_test(test_ball),      cmocka_unit_test(test_bad_files),
                                     cmocka_unit_test(test_cut_files)};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ErrorHandlerPush());
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
