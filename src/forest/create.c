/* A forest from a mesh file: read on rank 0, known to all. */
#include "forestimpl.h"

static PetscErrorCode BroadcastInts_Private(MPI_Comm comm, PetscMPIInt rank, PetscInt num, PetscInt **data)
{
  PetscFunctionBegin;
  if (rank) PetscCall(PetscMalloc1(num, data));
  PetscCallMPI(MPI_Bcast(*data, (PetscMPIInt)num, MPIU_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BroadcastNames_Private(MPI_Comm comm, PetscMPIInt rank, PetscInt num, char (**names)[MORTISE_NAME])
{
  PetscFunctionBegin;
  if (rank) PetscCall(PetscMalloc1(num, names));
  PetscCallMPI(MPI_Bcast(*names, (PetscMPIInt)num * MORTISE_NAME, MPI_CHAR, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Broadcast_Private(MPI_Comm comm, CoarseMesh *mesh, PetscInt *num_facets, PetscInt **facet_vertices, uint64_t **facet_groups)
{
  PetscInt    size[9] = {mesh->dim,   mesh->num_cells,  mesh->num_vertices,  mesh->geometry_order, mesh->num_bodies, mesh->num_boundaries,
                         *num_facets, mesh->num_fields, mesh->from_simplices};
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(size, 9, MPIU_INT, 0, comm));
  mesh->dim            = size[0];
  mesh->num_cells      = size[1];
  mesh->num_vertices   = size[2];
  mesh->geometry_order = size[3];
  mesh->num_bodies     = size[4];
  mesh->num_boundaries = size[5];
  *num_facets          = size[6];
  mesh->num_fields     = size[7];
  mesh->from_simplices = (PetscBool)size[8];
  const PetscInt q1 = mesh->geometry_order + 1, reals = 3 * mesh->num_cells * q1 * q1 * (mesh->dim == 3 ? q1 : 1);
  PetscCall(BroadcastNames_Private(comm, rank, mesh->num_bodies, &mesh->body_name));
  PetscCall(BroadcastNames_Private(comm, rank, mesh->num_boundaries, &mesh->boundary_name));
  PetscCall(BroadcastNames_Private(comm, rank, mesh->num_fields, &mesh->field_name));
  PetscCall(BroadcastInts_Private(comm, rank, mesh->num_cells << mesh->dim, &mesh->cell_vertices));
  PetscCall(BroadcastInts_Private(comm, rank, mesh->num_cells, &mesh->cell_body));
  PetscCall(BroadcastInts_Private(comm, rank, *num_facets << (mesh->dim - 1), facet_vertices));
  if (rank) PetscCall(PetscMalloc1(reals, &mesh->cell_geometry));
  if (rank) PetscCall(PetscMalloc1(*num_facets, facet_groups));
  if (rank) PetscCall(PetscMalloc1(3 * mesh->num_fields * mesh->num_cells, &mesh->field));
  PetscCallMPI(MPI_Bcast(mesh->cell_geometry, (PetscMPIInt)reals, MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(mesh->field, (PetscMPIInt)(3 * mesh->num_fields * mesh->num_cells), MPIU_REAL, 0, comm));
  PetscCallMPI(MPI_Bcast(*facet_groups, (PetscMPIInt)*num_facets, MPI_UINT64_T, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TellOpened_Private(MPI_Comm comm, const CoarseMesh *mesh)
{
  PetscFunctionBegin;
  if (!mesh->num_opened) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(comm,
                        "note: mesh cells with a flat corner, as where two sides lie on one curve: %" PetscInt_FMT " of %" PetscInt_FMT
                        ", the first at (%.4g, %.4g); each and a neighbour become four (mesh.keep_flat: true leaves them)\n",
                        mesh->num_opened, mesh->num_cells - 2 * mesh->num_opened, (double)mesh->first_opened[0], (double)mesh->first_opened[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCreate(MPI_Comm comm, const ForestSpec *spec, Forest *forest)
{
  char        message[1024] = "";
  CoarseMesh  mesh          = {0};
  PetscInt    num_facets = 0, *facet_vertices = NULL;
  uint64_t   *facet_groups = NULL;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(ForestReadGmsh(spec, &mesh, &num_facets, &facet_vertices, &facet_groups, sizeof(message), message));
  if (rank == 0 && !message[0] && !spec->keep_flat) PetscCall(ForestOpenFlatCorners(&mesh, num_facets, facet_vertices));
  PetscCallMPI(MPI_Bcast(message, sizeof(message), MPI_CHAR, 0, comm));
  if (message[0]) {
    PetscCall(ForestCoarseMeshDestroy(&mesh));
    PetscCall(PetscFree(facet_vertices));
    PetscCall(PetscFree(facet_groups));
    return ErrorInput("%s", message);
  }
  PetscCall(TellOpened_Private(comm, &mesh));
  PetscCall(Broadcast_Private(comm, &mesh, &num_facets, &facet_vertices, &facet_groups));
  const double cells = ldexp((double)mesh.num_cells, (int)(mesh.dim * spec->refine));
  PetscCheckInput(cells <= FOREST_ENTITIES >> mesh.dim, /* a cell brings 2^dim entities at least */
                  "mesh.refine is %" PetscInt_FMT ": %.0f cells, of %" PetscInt_FMT " in the mesh; at most %" PetscInt_FMT
                  " fit; refine.<name> refines where it matters",
                  spec->refine, cells, mesh.num_cells, FOREST_ENTITIES >> mesh.dim);
  ErrorAsked("%.0f cells (mesh.refine: %" PetscInt_FMT ")", cells, spec->refine);
  const PetscErrorCode status = ForestCreateFromCoarse(comm, &mesh, num_facets, facet_vertices, facet_groups, spec->refine, forest);
  PetscCall(PetscFree(facet_vertices));
  PetscCall(PetscFree(facet_groups));
  PetscFunctionReturn(status);
}
