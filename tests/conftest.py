"""Environment shared by all tests: MPI as root in a container, more ranks than cores, ranks that wait give way to the others (several tests run side by side: otherwise
most of the processor time of a test on two ranks goes into waiting), one thread per rank; no search for devices other than processors, a fifth of the start on two ranks, nor for
networks, nor files that processes share for what few tell each other, which cost every start as much again;
signals as a terminal leaves them, where nohup or a script's & had them ignored, which the program would go on with; meshes of gmsh made once, and what copies of the
program are made with (tests/tools/copies.py)."""
import atexit
import os
import pathlib
import shutil
import signal
import sys
import tempfile

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1",
                  OMPI_MCA_hwloc_base_binding_policy="none", OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_pml="ob1", OMPI_MCA_btl="self,vader", PMIX_MCA_gds="hash", HWLOC_COMPONENTS="-linuxio,-pci,-opencl,-cuda,-nvml,-gl,-x86",
                  OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", ASAN_OPTIONS="detect_leaks=0")

for number in (signal.SIGHUP, signal.SIGQUIT):
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)

TOOLS = pathlib.Path(__file__).resolve().parent / "tools"
sys.path.insert(0, str(TOOLS))
import copies  # noqa: E402


def meshes_folder(gmsh):
    """Beside what was built, for the next time, too; of this gmsh alone."""
    build = pathlib.Path(os.environ.get("MORTISE_BUILD", TOOLS.parent.parent / "build"))
    if build.is_dir() and os.access(build, os.W_OK):
        status = os.stat(gmsh)
        folder = build.resolve() / "meshes" / f"{status.st_mtime_ns:x}.{status.st_size:x}"
        folder.mkdir(parents=True, exist_ok=True)
    else:
        folder = tempfile.mkdtemp(prefix="meshes")
        atexit.register(shutil.rmtree, folder, True)
    return str(folder)


# tests/tools/gmsh stands for gmsh; workers of pytest-xdist, which start with this environment, share its meshes.
if "MORTISE_TEST_MESHES" not in os.environ and shutil.which("gmsh"):
    os.environ.update(MORTISE_TEST_GMSH=shutil.which("gmsh"), MORTISE_TEST_MESHES=meshes_folder(shutil.which("gmsh")),
                      PATH=f"{TOOLS}:{os.environ['PATH']}")

if "MORTISE_TEST_COPIES" not in os.environ:
    folder = tempfile.mkdtemp(prefix="copies")
    atexit.register(shutil.rmtree, folder, True)
    os.environ["MORTISE_TEST_COPIES"] = os.path.join(folder, "server.so")
    copies.build(os.environ["MORTISE_TEST_COPIES"])
