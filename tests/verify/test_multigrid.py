"""hypre's BoomerAMG in place of GAMG (-solve_multigrid), and the displacement handed to PETSc's own tools (-solution_view)."""
import re

import numpy as np
import pytest

BALL = ("inputs/hertz3d.yml", "-output_fields", "false")
TOLERANCE = {1: 0.35, 2: 0.15}  # by order: so that nodes hang


@pytest.fixture
def hypre(run):
    if "built without hypre" in run("inputs/blocks3d.yml", "-solve_multigrid", "boomeramg", "-check").stderr:
        pytest.skip("this PETSc has no hypre")


@pytest.mark.parametrize("order, processes", [(1, [3]), (2, [1]), *(pytest.param(*words, marks=pytest.mark.slow) for words in ((1, [1, 2]), (2, [2, 3])))])
def test_boomeramg(run, hypre, order, processes):
    """Hanging nodes and contact, on several processes: nodal coarsening and rotations act, and the result is the factors'."""
    scene = (*BALL, "-order", order, "-adapt_tolerance", TOLERANCE[order], "-info", ":ksp,snes")
    direct = run(*scene, "-solve_linear", "direct")
    for ranks in processes:
        multigrid = run(*scene, "-solve_linear", "iterative", "-solve_multigrid", "boomeramg", "-multigrid_ksp_view", ranks=ranks)
        assert direct.solved and multigrid.solved, (direct, multigrid)
        for words in ("HYPRE BoomerAMG preconditioning", "Using nodal coarsening", "HYPRE_BoomerAMGSetInterpVecVariant() 2", "HMIS", "ext+i"):
            assert words in multigrid.stdout
        a, b = direct.summary, multigrid.summary
        of_gmres = [int(number) for number in re.findall(r"(\d+) iterations of GMRES", multigrid.stdout)]
        assert np.median(of_gmres) < 60 and "multigrid failed" not in multigrid.stdout
        assert b["factorisations"] == 0 < a["factorisations"] and b["cells"] == a["cells"] and b["newton_iterations"] <= a["newton_iterations"] + 1
        assert b["energy"] == pytest.approx(a["energy"], rel=1e-8)
        assert b["contact"]["ball_on_block"]["force"] == pytest.approx(a["contact"]["ball_on_block"]["force"], rel=1e-7, abs=1e-10)


@pytest.mark.parametrize("options, words", [
    (("-solve_multigrid", "gamg", "-solve_linear", "direct"), "-solve_multigrid gamg cannot act with -solve_linear direct; take iterative or auto"),
    (("-solve_multigrid", "gamg", "-multigrid_pc_hypre_boomeramg_P_max", 2), "-multigrid_pc_hypre_boomeramg_P_max cannot act with -solve_multigrid gamg"),
    (("-multigrid_pc_hypre_boomeramg_P_max", 2), "-multigrid_pc_hypre_boomeramg_P_max cannot act with -solve_multigrid auto, which may choose another method; take boomeramg"),
    (("-solve_multigrid", "boomeramg", "-multigrid_pc_gamg_threshold", 0.1), "-multigrid_pc_gamg_threshold cannot act with -solve_multigrid boomeramg; take gamg"),
    (("-solve_linear", "iterative", "-multigrid_pc_gamg_threshold", 0.1), "-multigrid_pc_gamg_threshold cannot act with -solve_multigrid auto, which may choose another method; take gamg"),
    (("-solve_linear", "direct", "-multigrid_pc_gamg_threshold", 0.1), "-multigrid_pc_gamg_threshold cannot act with -solve_linear direct; take iterative or auto"),
    (("-solve_linear", "direct", "-saddle_ksp_max_it", 5), "-saddle_ksp_max_it cannot act with -solve_linear direct; take iterative or auto"),
    (("-solve_multigrid", "gamg", "-multigrid_pc_type", "lu"), "-solve_multigrid and -multigrid_pc_type exclude each other; give one of them"),
    (("-solution_view", "vtk:u.txt"), "-solution_view is 'vtk:u.txt'; a file of vtk ends in .vtu"),
    (("-solution_view", "vtk:/nowhere/u.vtu"), "-solution_view is 'vtk:/nowhere/u.vtu': /nowhere cannot be written to: No such file or directory"),
    (("-solution_view", "draw"), "-solution_view is 'draw'; allowed: vtk:FILE.vtu|hdf5:FILE|binary:FILE"),
])
def test_refused(run, options, words):
    result = run("inputs/blocks3d.yml", *options)
    assert result.returncode == 1 and words in result.stderr and result.stderr.count("\n") == 1 and not result.stdout, result


def test_options_of_the_method_named_act(run):
    """GAMG's own option changes its cycle where GAMG is named, with a higher order too, and is none that nothing used."""
    scene, gmres = ("inputs/hertz3d.yml", "-output_fields", "false", "-order", 2, "-adapt_tolerance", 0, "-solve_linear", "iterative", "-solve_multigrid", "gamg", "-info", ":ksp"), []
    for options in ((), ("-multigrid_pc_gamg_threshold", 0.5)):
        result = run(*scene, *options)
        assert result.solved and "nothing used" not in result.stderr, result
        gmres.append([int(number) for number in re.findall(r"(\d+) iterations of GMRES", result.stdout)])
    assert gmres[0] != gmres[1], gmres


@pytest.mark.parametrize("order, n, k, multigrid", [(1, 9, 15, False), pytest.param(1, 17, 31, True, marks=pytest.mark.slow), pytest.param(2, 8, 15, True, marks=pytest.mark.slow)])
def test_auto_by_operations(run, order, n, k, multigrid):
    """-solve_linear auto: factors where they take few operations for the entries of the matrix, else multigrid; with order 2 a third as many."""
    result = run(*BALL, "-order", order, "-adapt_tolerance", 0, "-mesh_parameter_n", n, "-mesh_parameter_k", k, "-info", ":snes")
    operations = float(re.search(r"a factor takes (\S+) operations for each", result.stdout)[1])
    assert result.solved and (operations > 36e3 / (1 if order == 1 else 3)) == multigrid and (result.summary["factorisations"] == 0) == multigrid, (operations, result)


def appended(path, name):
    """An array of a .vtu file with raw appended data, all pieces one after the other."""
    data = path.read_bytes()
    start, found = data.index(b"_", data.index(b"<AppendedData")) + 1, []
    for offset in re.findall(rf'<DataArray type="Float64" Name="{name}" NumberOfComponents="3" format="appended" offset="(\d+)"'.encode(), data):
        at = start + int(offset)
        found.append(np.frombuffer(data[at + 4:at + 4 + int.from_bytes(data[at:at + 4], "little")], dtype="<f8").reshape(-1, 3))
    return np.concatenate(found)


def test_solution_view(run, tmp_path):
    """Vertices and their displacements in PETSc's own file, hanging ones as well, on one process and on three: those of fields.xdmf."""
    for ranks in (1, 3):
        file = tmp_path / f"{ranks}.vtu"
        result = run("inputs/hertz3d.yml", "-adapt_tolerance", 0.35, "-order", 1, "-solution_view", f"vtk:{file}", ranks=ranks)
        assert result.solved, result
        state = result.states()[-1][1]
        ours = np.concatenate([state["X"], state["displacement"]], axis=1)
        theirs = np.concatenate([appended(file, "Position"), appended(file, "displacement[^\"]*")], axis=1)
        assert len(theirs) >= len(np.unique(ours.round(9), axis=0)) > 100
        for row in theirs:
            assert np.abs(ours - row).max(axis=1).min() < 1e-9
