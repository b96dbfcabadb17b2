/* Meshes written by gmsh in the working directory: formats, orders, groups, conversion of simplices, and the sentence for each kind of bad file. */
#include "forest_box.h"
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static PetscMPIInt rank, size;

static void WriteFile(const char *name, const char *text)
{
  if (rank) return;
  FILE *file = fopen(name, "w");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

static const char *const version[] = {"2.2", "2.2, binary", "4.1", "4.1, binary"}; /* of the format */

/* A mesh that gmsh wrote, of this order and format. */
static const char *Mesh(const char *name, int order, int format)
{
  static char file[64];

  snprintf(file, sizeof(file), "%s-%d-%d.msh", name, order, format);
  return file;
}

/* For what rank 0 does alone: the others sleep, where a barrier would spin. */
static void Wait(void)
{
  MPI_Request request;
  int         done = 0;

  for (OK(MPI_Ibarrier(PETSC_COMM_WORLD, &request)); !done; usleep(1000)) OK(MPI_Test(&request, &done, MPI_STATUS_IGNORE));
}

/* Run gmsh on rank 0, in a bare environment: it may use MPI itself. One start, most of its time, for the orders from low to high in every format. */
static void Gmsh(const char *geo, int dim, const char *name, int low, int high)
{
  char text[8192], line[128];

  snprintf(text, sizeof(text), "%sMesh %d;\n", geo, dim);
  for (int order = low; order <= high; ++order) {
    snprintf(line, sizeof(line), "SetOrder %d;\n", order);
    OK(PetscStrlcat(text, line, sizeof(text)));
    for (int format = 0; format < 4; ++format) {
      snprintf(line, sizeof(line), "Mesh.MshFileVersion=%.3s;Mesh.Binary=%d;Save \"%s\";\n", version[format], format % 2, Mesh(name, order, format));
      OK(PetscStrlcat(text, line, sizeof(text)));
    }
  }
  WriteFile("test.geo", text);
  if (rank == 0) assert_int_equal(system("env -i PATH=\"$PATH\" HOME=\"$HOME\" gmsh test.geo - > gmsh.log 2>&1"), 0);
  Wait();
}

static Forest Read(const char *file, PetscInt dim, PetscInt refine)
{
  ForestSpec spec = {.dim = dim, .refine = refine};
  Forest     forest;

  OK(PetscStrncpy(spec.file, file, sizeof(spec.file)));
  OK(ForestCreate(PETSC_COMM_WORLD, &spec, &forest));
  return forest;
}

/* Volume by 4-point Gauss in each direction of each coarse cell, of which each rank does its share: exact up to order 2, 1e-6 or better for smooth order 4. */
static PetscReal Volume(Forest forest)
{
  static const PetscReal point[4]  = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
  static const PetscReal weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
  const CoarseMesh      *mesh      = &forest->coarse->mesh;
  PetscReal              volume    = 0;

  for (PetscInt c = rank; c < mesh->num_cells; c += size)
    for (PetscInt q = 0; q < (mesh->dim == 2 ? 16 : 64); ++q) {
      const PetscReal xi[3] = {point[q & 3], point[(q >> 2) & 3], point[q >> 4]};
      PetscReal       X[3], J[9];
      ForestCoarseMapPoint(mesh, c, xi, X, J);
      volume += weight[q & 3] * weight[(q >> 2) & 3] * (mesh->dim == 3 ? weight[q >> 4] * Det3(J) : J[0] * J[3] - J[1] * J[2]);
    }
  OK(MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
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
  const PetscReal exact = 0.75 * PETSC_PI, straight = 9 * PetscSinReal(PETSC_PI / 12);

  Gmsh(RING("", NAMED), 2, "ring", 1, 4);
  for (int f = 0; f < 4; ++f)
    for (int q = 1; q <= 4; ++q) {
      PetscReal         worst;
      Forest            forest = Read(Mesh("ring", q, f), 2, 0);
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
      if (rank == 0) print_message("  %s order %d: area %.9f, exact %.9f\n", version[f], q, (double)area, (double)exact);
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
  PetscReal error[2][4];

  for (int level = 0; level < 2; ++level) {
    char geo[2048];
    snprintf(geo, sizeof(geo), "%sTransfinite Curve{2,4}=%d;\n%s", RING("", ""), level ? 5 : 3, NAMED);
    Gmsh(geo, 2, "rate", 2, 3);
    for (int q = 2; q <= 3; ++q) {
      Forest forest   = Read(Mesh("rate", q, 2), 2, 1);
      error[level][q] = PetscAbsReal(Volume(forest) - 0.75 * PETSC_PI);
      OK(ForestDestroy(&forest));
    }
  }
  for (int q = 2; q <= 3; ++q) assert_true(error[1][q] < error[0][q] / 12); /* h^4 in the area for both */
}

static void test_turned_over(void **state)
{
  PetscReal worst;

  Gmsh(RING("-", NAMED), 2, "turned", 2, 2);
  Forest forest = Read(Mesh("turned", 2, 2), 2, 1);
  assert_true(PetscAbsReal(Volume(forest) - 0.75 * PETSC_PI) < 1e-4);
  assert_int_equal(GroupFacets(forest, "inner", 1, &worst), 12);
  assert_true(worst < 1e-4);
  assert_int_equal(forest->tables.num_leaves, 72);
  OK(ForestDestroy(&forest));
}

#define UNNAMED "Physical Surface(7)={1};Physical Curve(3)={4};Physical Curve(2)={2};Physical Curve(9)={1,2,3,4};\n"

/* Without names the tags are the names; a file saved with everything has vertices that belong to no cell. */
static void test_unnamed(void **state)
{
  PetscReal worst;

  Gmsh(RING("", UNNAMED "Mesh.SaveAll=1;\n"), 2, "all", 1, 1);
  Forest forest = Read(Mesh("all", 1, 0), 2, 0);
  assert_int_equal(forest->coarse->mesh.num_vertices, 28);
  OK(ForestDestroy(&forest));
  Gmsh(RING("", UNNAMED), 2, "unnamed", 1, 1);
  forest = Read(Mesh("unnamed", 1, 2), 2, 0);
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
  Gmsh(BACKWARDS("5"), 2, "back", 1, 1);
  for (int f = 0; f < 4; ++f) {
    PetscReal worst;
    Forest    forest = Read(Mesh("back", 1, f), 2, 0);
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
  for (int v = 0; v < 2; ++v) {
    Gmsh(v ? SQUARES("Recombine Surface{2};") : SQUARES(""), 2, "squares", 1, 2);
    for (int q = 1; q <= 2; ++q) {
      Forest              forest  = Read(Mesh("squares", q, 2), 2, 0);
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
  Gmsh(CUBE(""), 3, "cube", 1, 1);
  Forest forest = Read(Mesh("cube", 1, 2), 3, 0);
  CheckCube(forest, 1);
  OK(ForestDestroy(&forest));
  Gmsh(CUBE("Mesh.SubdivisionAlgorithm=2;"), 3, "hexes", 2, 2);
  forest = Read(Mesh("hexes", 2, 3), 3, 0);
  CheckCube(forest, 2);
  OK(ForestDestroy(&forest));
}

/* A ball of hexes with all orientations, order 2 and 3, against 4 pi / 3. */
static void test_ball(void **state)
{
  const PetscReal limit[4] = {0, 0, 1e-4, 1e-4};

  Gmsh("SetFactory(\"OpenCASCADE\");Sphere(1)={0,0,0,1};Mesh.CharacteristicLengthMax=0.9;Mesh.CharacteristicLengthMin=0.6;Mesh.SubdivisionAlgorithm=2;Physical "
       "Volume(\"ball\",1)={1};"
       "Physical Surface(\"skin\",1)={1};\n",
       3, "ball", 2, 3);
  for (int q = 2; q <= 3; ++q) {
    Forest          forest = Read(Mesh("ball", q, 2), 3, 0);
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
  Gmsh(BACKWARDS("1"), 2, "lost", 1, 1);
  for (int binary = 0; binary < 2; ++binary) Refused(Mesh("lost", 1, 2 + binary), 2, "backwards");
  Refused(Mesh("cube", 1, 2), 2, "cells of dimension 3"); /* test_cube's */
  WriteFile("wedge.msh",
            HEAD "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 0 1\n6 0 1 1\n$EndNodes\n$Elements\n1\n1 6 2 1 1 1 2 3 4 5 6\n$EndElements\n");
  Refused("wedge.msh", 3, "shape");
}

/* A good file cut anywhere is refused with a sentence or, cut in its closing line, read: never a crash, never an unhandled error. */
static void test_cut_files(void **state)
{
  static char bytes[100000];

  for (int f = 0; f < 4 && rank == 0; ++f) {
    FILE *in = fopen(Mesh("ring", 2, f), "rb"); /* test_ring's */
    assert_non_null(in);
    const size_t length = fread(bytes, 1, sizeof(bytes), in);
    fclose(in);
    int refused = 0, tried = 0;
    for (size_t cut = 1; cut < length; cut += length / 61) {
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
    print_message("  %s: %d of %d cut files refused\n", version[f], refused, tried);
    assert_true(refused >= tried - 2);
  }
  Wait();
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
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
