# Copyright: the mortise authors. SPDX-License-Identifier: BSD-2-Clause
"""Spack recipe; what of it was tried: packaging/README.md. Until it is in a repository of Spack:

    spack repo create mine && mkdir -p mine/packages/mortise && cp packaging/spack/package.py mine/packages/mortise/
    spack repo add mine && spack dev-build --source-path . mortise@0.1.0
"""
from spack.package import *


class Mortise(MakefilePackage):
    """Contact between bodies that deform a lot, to the accuracy asked for: an adaptive finite element solver on PETSc."""

    homepage = "https://example.org/mortise"
    url = "https://example.org/mortise-0.1.0.tar.gz"

    license("BSD-2-Clause")
    version("0.1.0")

    depends_on("c", type="build")
    depends_on("gmake", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18:+mpi+mumps+hdf5+metis+double~complex")
    depends_on("mumps+mpi+double+float")
    depends_on("hdf5+mpi")
    depends_on("metis")
    depends_on("openblas")
    depends_on("libyaml")
    depends_on("muparser")
    depends_on("cjson")
    depends_on("gmsh", type="run")
    depends_on("python@3.9:", type=("build", "run"))
    depends_on("py-numpy", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-matplotlib", type="run")

    def flags(self, *more):
        """PORTABLE: no -march=native, Spack's compiler wrapper says the target."""
        return ("PORTABLE=1", f"PETSC_DIR={self.spec['petsc'].prefix}", *more)

    def build(self, spec, prefix):
        make(*self.flags("all"))

    def install(self, spec, prefix):
        make(*self.flags("install", f"PREFIX={prefix}"))

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def check_version(self):
        Executable(self.prefix.bin.mortise)("--version")
