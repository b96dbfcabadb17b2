"""A damaged .msh ends in exit status 1 with a sentence, not in a signal."""
import subprocess

from conftest import ROOT


def damaged(run, tmp_path, line, text):
    """The mesh of inputs/patch2d.geo with one line of its nodes replaced."""
    path = tmp_path / "d.msh"
    subprocess.run(["gmsh", "-2", "-order", "1", "-format", "msh22", "-o", str(path), str(ROOT / "inputs" / "patch2d.geo")], check=True, capture_output=True)
    lines = path.read_text().splitlines()
    at = lines.index("$Nodes") + 1 + line
    lines[at] = text(lines[at])
    path.write_text("\n".join(lines) + "\n")
    scene = (ROOT / "inputs" / "patch2d.yml").read_text().replace("file: patch2d.geo", "file: d.msh").replace("  order: 1\n", "", 1)
    return run("d.yml", "-check", text=scene)


def test_undamaged_mesh_is_read(run, tmp_path):
    """Nothing damaged: the mesh is fine as gmsh wrote it."""
    assert damaged(run, tmp_path, 27, lambda line: line).returncode == 0


def test_lost_separator_is_told(run, tmp_path):
    """A line of $Nodes has lost a number, so that the numbers after it shift: PETSc 3.18 alone would follow a node that does not exist."""
    result = damaged(run, tmp_path, 27, lambda line: line.replace(" ", "", 1))
    assert result.returncode == 1 and "mortise: " in result.stderr, result
