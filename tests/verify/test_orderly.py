"""What goes wrong on the way ends in order: one sentence and exit status 1 where the input is the cause, else the last good state stays and is told of."""
import json
import math

import pytest

from boxmesh import linspace, ring, write


def refused(result, *words):
    """Exit status 1, one sentence with these words, nothing written."""
    assert result.returncode == 1 and not result.directory.exists(), result
    said = [line for line in result.stderr.splitlines() if line.strip() and "MPI_" not in line]
    assert len([line for line in said if line.startswith("mortise: ")]) == 1 and "PETSC ERROR" not in result.stderr, result
    for word in words:
        assert word in result.stderr, result


# ---- inverted cells of the reference mesh -----------------------------------------------------------------------------------------------


def thin_ring(path, layers=2, thick=0.06, **scene):
    """A sixth of a thin ring in a few long curved cells. Where cells of one layer are split, their new nodes on the next one's straight sides lie a thirtieth of the
    radius inside the circle: further than the first row of children is wide."""
    write(path / "ring.msh", [linspace(1, 1 + thick, layers), linspace(0, math.pi / 3, 2)], ring, order=2)
    return json.dumps({"mesh": {"file": "ring.msh"}, "model": "plane_strain", "body": {"body": {"material": "m"}}, "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}},
                       "boundary": {"y0": {"fix": "xy"}, "y1": {"fix": "xy"}, "x0": {"pressure": 0.001}}, "load": {"step": 1}} | scene)


@pytest.mark.parametrize("ranks", [1, 2])
def test_refined_at_the_start(run, tmp_path, ranks):
    near = {"refine": {"bore": {"boundary": "x0"}}}
    refused(run("ring.yml", text=thin_ring(tmp_path, **near), ranks=ranks), "order 1", "inverted", "mesh")
    refused(run("ring.yml", "-check", text=thin_ring(tmp_path, **near), ranks=ranks), "order 1", "inverted", "mesh")
    assert run("ring.yml", "-order", 2, text=thin_ring(tmp_path, **near)).returncode == 0


@pytest.mark.parametrize("ranks", [1, 2])
def test_adaptation_keeps_the_coarser_mesh(run, tmp_path, ranks):
    """The cells at one end alone are to be refined."""
    adapt = {"adapt": {"tolerance": 1e-6, "max_passes": 3, "fraction": 0.01}}
    result = run("ring.yml", text=thin_ring(tmp_path, **adapt), ranks=ranks)
    assert result.returncode == 0 and result.summary["status"] == "converged", result
    assert "inverts a curved cell" in result.summary["adapt_stop"] and "note: refinement would invert" in result.stdout, result
    assert result.summary["cells"] == result.adapt[-1]["cells"] and result.history[-1]["t"] == 1


@pytest.mark.parametrize("shift,fine", [(0.24, True), (0.27, False)])
def test_inverted_between_samples(run, tmp_path, shift, fine):
    """The middle node of a cell of nine moved aside by `shift`: the determinant 1 + 16 shift (1 - 2 x) y (1 - y) is least, 1 - 4 shift, in the middle of a side, and
    still positive at thirds of it."""
    write(tmp_path / "cell.msh", [linspace(0, 1, 1)] * 2, lambda x, y: (x + (shift if x == y == 0.5 else 0), y), order=2)
    scene = {"mesh": {"file": "cell.msh"}, "model": "plane_strain", "order": 2, "body": {"body": {"material": "m"}}, "boundary": {"y0": {"fix": "xy"}},
             "material": {"m": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "load": {"step": 1}}
    result = run("cell.yml", text=json.dumps(scene))
    if fine:
        assert result.returncode == 0, result
    else:
        refused(result, "mesh cell 1 of 1", "inverted")


# ---- a direct solver that fails -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ranks", [1, 2])
def test_mumps_fails_in_the_solve(run, ranks):
    """ICNTL(31) = 1 makes MUMPS throw its factors away: it factorises, and cannot solve (INFOG(1) = -44). Steps are cut and given up like others that fail."""
    result = run("inputs/patch2d.yml", "-mat_mumps_icntl_31", 1, ranks=ranks)
    s = result.summary
    assert result.returncode == 2 and s["status"] == "failed" and s["reason"] and s["t"] == 0 and s["step_cuts"] > 5, result
    assert "PETSC ERROR" not in result.stderr and "MPI_ABORT" not in result.stderr, result
    assert f", {s['step_cuts']} step cuts, " in result.stdout and f", {s['newton_iterations']} Newton iterations, " in result.stdout, result
