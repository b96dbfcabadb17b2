"""Recipes for other packagers: one version, one list of what is needed, files that parse. None of them is built here."""
import ast
import re
import subprocess

import pytest
import yaml
from conftest import PROGRAM, ROOT

PACKAGING = ROOT / "packaging"
# What the source is built with, by the names of Debian, Spack and conda-forge.
NEEDED = {"libpetsc-real-dev": ("petsc", "petsc"), "libmumps-dev": ("mumps", "mumps-mpi"), "libhdf5-openmpi-dev": ("hdf5", "hdf5"), "libmetis-dev": ("metis", "metis"),
          "libopenblas-dev": ("openblas", "openblas"), "libyaml-dev": ("libyaml", "yaml"), "libmuparser-dev": ("muparser", "muparser"),
          "libcjson-dev": ("cjson", "cjson"), "libopenmpi-dev": ("mpi", "openmpi"), "pkg-config": ("pkgconfig", "pkg-config"), "python3": ("python", "python")}


@pytest.fixture(scope="module")
def version():
    return subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]


@pytest.mark.parametrize("file, where", [("packaging/spack/package.py", r'version\("(.*?)"'), ("packaging/conda/meta.yaml", r'set version = "(.*?)"'),
                                         ("CITATION.cff", r"^version: (.*)$"), ("debian/changelog", r"^mortise \((.*?)\)"), ("CHANGELOG.md", r"^## (\d.*)$")])
def test_version(version, file, where):
    assert re.search(where, (ROOT / file).read_text(), re.M)[1] == version


def conda():
    text = re.sub(r"^{%.*%}$", "", (PACKAGING / "conda/meta.yaml").read_text(), flags=re.M).replace("{{ compiler('c') }}", "compiler")
    return yaml.safe_load(re.sub(r"{{ \w+ }}", "1", text))


def test_what_is_needed_to_build():
    """Debian's control is the one that is tried; the others name the same."""
    debian = re.search(r"^Build-Depends:(.*(?:\n .*)*)", (ROOT / "debian/control").read_text(), re.M)[1]
    debian = {re.sub(r"\s*\(.*", "", name.strip()) for name in debian.split(",")}
    assert debian - set(NEEDED) == {"debhelper-compat", "openmpi-bin"} and set(NEEDED) <= debian
    spack = set(re.findall(r'depends_on\("([\w-]+)', (PACKAGING / "spack/package.py").read_text()))
    requirements = conda()["requirements"]
    forge = {name.split()[0] for name in requirements["build"] + requirements["host"]}
    assert {names[0] for names in NEEDED.values()} <= spack
    assert {names[1] for names in NEEDED.values()} <= forge


def test_recipe_of_spack_parses():
    tree = ast.parse((PACKAGING / "spack/package.py").read_text())
    recipe = next(node for node in tree.body if isinstance(node, ast.ClassDef))
    assert recipe.name == "Mortise" and {"build", "install"} <= {node.name for node in recipe.body if isinstance(node, ast.FunctionDef)}


def test_images_do_as_the_debian_package():
    """Both images run the same commands, in both stages."""
    docker = (PACKAGING / "Dockerfile").read_text()
    apptainer = (PACKAGING / "mortise.def").read_text()
    for command in ("build-dep -y --no-install-recommends ./", "dpkg-buildpackage -b -us -uc", "install -y --no-install-recommends /tmp/mortise_*.deb"):
        assert command in docker and command in apptainer
