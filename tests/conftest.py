"""Environment shared by all tests: MPI as root in a container, more ranks than cores, one thread per rank."""
import os

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
                  OMPI_MCA_hwloc_base_binding_policy="none", OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", ASAN_OPTIONS="detect_leaks=0")
