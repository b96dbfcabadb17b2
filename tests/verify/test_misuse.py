"""What users do wrong beyond the cases of test_input.py: words, YAML, meshes, options, directories, restarts. One sentence, exit status 1, nothing half written."""
import json
import os
import resource
import subprocess

import pytest
from combinations import on_two
from conftest import PROGRAM, ROOT
from test_hostile import limited
from test_input import GEO, RUBBER, SCENE, check, refused  # noqa: F401 (check is a fixture)
from test_orderly import refused as refused_run

PAIR = "  pair: {nonmortar: upper_bottom, mortar: lower_top, friction: 0}\n"
TOP = "top: {displacement: {x: 0, y: -0.05}}"
BODIES = "  lower: {material: rubber}\n  upper: {material: rubber}\n"
STEEL = ("material:\n", "material:\n  steel: {law: rigid}\n")


def moved(motion):
    return [STEEL, ("upper: {material: rubber}", f"upper: {{material: steel, motion: {motion}}}"), (f"  {TOP}\n", "")]


def more(keys):
    return [("load: {", keys + "\nload: {")]


@pytest.mark.parametrize("edits,words", [
    # numbers
    ([("E: 1,", "E: 1e400,")], ["material.rubber.E is '1e400'; it must be a number"]), ([("E: 1,", "E: 210 GPa,")], ["material.rubber.E is '210 GPa'"]),
    ([("E: 1,", "E: '1,5',")], ["material.rubber.E is '1,5'"]), ([("E: 1,", "E: 1_000,")], ["material.rubber.E is '1_000'"]),
    ([("E: 1,", "E: true,")], ["material.rubber.E is 'true'"]), ([("E: 1,", "E: null,")], ["material.rubber.E is 'null'"]),
    ([("E: 1,", "E: 0,")], ["material.rubber.E: 0 is not a finite number above 0"]), ([("nu: 0.3", "nu: -1")], ["material.rubber.nu: -1 is not between -1 and 0.5"]),
    ([("y: -0.05", 'y: "-"')], ['displacement.y: "-" is neither', "a sign in it has nothing to act on"]),
    ([("step: 0.5", "step: 2")], ["load.step is 2; allowed: up to load.end, which is 1"]),
    ([("nu: 0.3", "nu: 0.5000001")], ["s.yml:", ": material.rubber.nu: 0.5000001 is not between -1 and 0.5"]),
    ([("nu: 0.3", "nu: 0.5, volumetric: log")], ["material.rubber.volumetric: log has no incompressible limit"]),
    ([(RUBBER, "{law: saint_venant_kirchhoff, E: 1, nu: 0.5}")], ["saint_venant_kirchhoff has no incompressible limit"]),
    ([(RUBBER, "{law: neo_hookean, mu: 1, kappa: -1}")], ["material.rubber.kappa: -1 is not"]), ([(RUBBER, "{law: neo_hookean, mu: 1, kappa: 1e15}")], ["more than 1e12 times"]),
    ([(RUBBER, "{law: mooney_rivlin, c1: -1, c2: 0.5, kappa: 10}")], ["= -1 must be positive"]), ([(RUBBER, "{law: rigid, E: 1}")], ["the law rigid takes no parameters"]),
    ([("nu: 0.3", "nu: 0.3, formulation: u-p")], [r"formulation is 'u-p'; allowed: auto\|displacement\|mixed"]),
    # pairs
    ([("friction: 0", "friction: -0.1")], ["contact.pair.friction is -0.1; allowed: 0 or a positive"]), ([("friction: 0", "friction: nan")], ["no finite number"]),
    ([("friction: 0", "friction: X")], ["contact.pair.friction is \"X\": one coefficient for the whole pair"]),
    ([(PAIR, "  pair: {friction: 0}\n")], ["contact.pair.nonmortar must be given: a pair has two sides"]),
    ([("friction: 0", "surface: upper_bottom")], ["contact.pair.surface is 'upper_bottom', but nonmortar is given"]),
    ([("mortar: lower_top", "mortar: [lower_top, lower]")], ["contact.pair.mortar: 'lower' is a body of the mesh"]),
    ([("mortar: lower_top", "mortar: lower")], ["contact.pair.mortar: 'lower' is a body of the mesh"]), ([(PAIR, "  pair: yes\n")], ["contact.pair must be a map of keys"]),
    ([("friction: 0", "law: mortar")], [r"contact.pair.law is 'mortar'; allowed: frictionless\|"]), ([("friction: 0", "search: -1")], ["contact.pair.search is -1"]),
    ([("friction: 0", "law: penalty, penalty: 0")], ["contact.pair.penalty is 0"]), ([("friction: 0", "initial_gap: 0.1")], [r"initial_gap is '0.1'; allowed: keep\|"]),
    ([STEEL, (BODIES, BODIES.replace("rubber", "steel")), (f"  {TOP}\n", ""), ("  bottom: {fix: xy}\n", ""), (f"  rubber: {RUBBER}\n", "")], ["both sides of rigid bodies"]),
    # what moves and holds
    (moved("{w: 1}"), ["body.upper.motion.w is not a key"]), (moved("{y: '-0.1*X'}"), ["body.upper.motion.y is \"-0.1\\*X\": one translation for the whole body"]),
    (moved("{y: 0/0}"), ["body.upper.motion.y: \"0/0\" is no finite number"]),
    ([("upper: {material: rubber}", "upper: {material: rubber, motion: {y: -0.1}}")], ["only a rigid body moves as told"]),
    ([("fix: xy", "fix: xx")], ["boundary.bottom.fix is 'xx': x is there twice"]), ([("fix: xy", "fix: true")], ["fix is 'true'; allowed: letters of xy, or normal"]),
    ([("displacement: {x: 0, y: -0.05}", "displacement: -0.05")], ["displacement must be a map of keys"]), ([("y: -0.05", "y: '-0.05*t**2'")], ["Unexpected operator"]),
    ([("y: -0.05", "y: 'X=3'")], ["assigns with '='; compare with '=='"]), ([("y: -0.05", f"y: '{'+'.join('t' * 3000)}'")], ["at most 4000 characters"]),
    ([("y: -0.05}", "y: -0.05}, amplitude: []")], ["amplitude has 0 numbers"]), ([("y: -0.05}", "y: -0.05}, amplitude: [0, 0, 1, nan]")], ["amplitude: \"nan\" is no finite"]),
    ([(TOP, "upper: {traction: {x: 1}}")], ["'upper' is a body of the mesh"]), ([(TOP, TOP + "\n  lower_side: {traction: {}}")], ["lower_side prescribes nothing"]),
    ([(TOP, TOP + "\n  lower_side: {pressure: {x: 1}}")], ["pressure must be a number or an expression, it is a map"]),
    ([("fix: xy", "fix: xy, moment_about: nope")], ["moment_about is 'nope', which is not under point"]), ([("displacement: {x: 0, y: -0.05}", "rotation: {}")], ["rotation.angle must be given"]),
    # how it is solved
    ([("end: 1", "end: nan")], ["load.end is 'nan'"]), ([("end: 1", "end: 0")], ["load.end is 0"]), ([("step: 0.5", "step: 0.5, max_steps: 1e3")], ["load.max_steps is '1e3'"]),
    ([("step: 0.5", "step: 0.5, step_min: 0.9")], ["load.step is 0.5; it must lie between step_min 0.9"]), (more("adapt: {max_cells: 0}"), ["adapt.max_cells is 0"]),
    (more("adapt: {max_passes: 1e99}"), ["adapt.max_passes is '1e99'"]), (more("refine: {a: {}}"), ["refine.a needs a boundary, a point"]),
    (more("refine: {a: {boundary: nope}}"), ["no boundary group 'nope'"]), (more("output: {quantities: temperature}"), [r"output.quantities is 'temperature'; allowed: principal"]),
    (more("output: {fields: Off}"), ["output.fields is 'Off'; allowed: true, false"]), (more("probe: {p: {x: 5, y: 5}}"), [r"\(5, 5, 0\) lies outside all bodies"]),
    (more("probe: {p: {}}"), ["probe.p needs coordinates x, y"]), (more("units: 'mm, N, Pa'"), ["units is 'mm, N, Pa', but Pa is not N/mm"]), (more("units: furlong"), ["furlong is no unit"]),
    # YAML
    ([(BODIES, "  lower: &b {material: rubber}\n  upper: *b\n")], ["anchors of YAML are not used"]), ([("upper: {material: rubber}", "upper: *nope")], ["aliases of YAML"]),
    ([("upper: {material: rubber}", "upper: {<<: {material: rubber}}")], ["body.upper.<< is not a key"]), ([("order: 1\nbody", "order: !!int 1\nbody")], ["tags of YAML"]),
    ([("title: two squares", "load.end: 2")], [r"load.end is not a key of a scene; keys stand in each other, load: \{end: ...\}"]),
    ([("title: two squares", "Model: 3d")], ["Model is not a key of a scene; the nearest one is model"]), ([("title: two squares", "? [a, b]\n: 3")], ["a key must be a plain word"]),
    ([("title: two squares", "'': 4")], ["an empty key"]), ([("title: two squares", f"title: {'[' * 2000}{']' * 2000}")], ["nested deeper"]),
    ([("body:\n", "body: {}\nx:\n")], ["x is not a key of a scene"]),
    # the mesh
    ([("squares.geo", "part.step")], ["must end in .geo or .msh, which mortise-import makes of others"]), ([("order: 1}", "order: 1, parameter: {n: inf}}")], ["mesh.parameter.n is 'inf'"]),
    ([("squares.geo", "''")], ["mesh.file is ''"]), ([("squares.geo", "a" * 5000 + ".msh")], ["mesh.file is longer than 4095"]), ([("order: 1}", "order: 1, refine: 99}")], ["mesh.refine is 99"]),
])
def test_scene(check, edits, words):
    refused(check(edits), *words)


@pytest.mark.parametrize("encode,good", [(lambda text: b"\xef\xbb\xbf" + text.encode(), True), (lambda text: text.replace("\n", "\r\n").encode(), True),
                                         (lambda text: text.encode("utf-16"), True), (lambda text: text.replace("two", "zwölf").encode("latin1"), False),
                                         (lambda text: text.replace("two", "t\0wo").encode(), False), (lambda text: text.encode() + b"#" + b"x" * (1 << 22), False)])
def test_bytes(check, run, tmp_path, encode, good):
    """Marks of the byte order, line ends of other systems and UTF-16 are read; what is no text is told."""
    check()
    (tmp_path / "bytes.yml").write_bytes(encode(SCENE))
    result = run(tmp_path / "bytes.yml", "-check")
    if good:
        assert result.returncode == 0 and not result.stderr, result
    else:
        refused(result, "not valid YAML|is larger than")


@pytest.mark.parametrize("options,words", [
    (["--", "-order", "2"], ["'--' is neither the scene nor an option"]), (["--order", "2"], ["--order is no key of a scene", "nearest one is -order"]),
    (["-output_dir", "out"], ["nearest one is -output_directory"]), (["-mesh_parameters_n", "2"], ["nearest one is -mesh_parameter_"]),
    (["-order=2"], ["-order=2 is no key of a scene", "nearest one is -order"]), (["-load.end", "2"], ["-load.end is no key of a scene", "-load_end"]),
    (["-load_end", "-2"], ["command line: load.end is -2"]), (["-max_seconds", "5m"], ["-max_seconds is '5m'"]), (["-restart", "none.h5"], ["-restart none.h5: the file cannot be read"]),
    (["-restart", "."], ["-restart .: .*directory"]), (["-restart", "/dev/zero"], ["this is no checkpoint of mortise"]),
    (["-info", "/nowhere/x"], ["an option of PETSc cannot act: Unable to open file /nowhere/x"]), (["-fp_trap"], ["-fp_trap cannot act here"]), (["-fp_trap", "maybe"], ["an option of PETSc cannot act: Unknown logical value"]), (["-restart", str(ROOT / "README.md")], ["this is no checkpoint of mortise"]),
    (["-options_file", "."], ["-options_file: .* is a directory"]), (["-output_directory", "a" * 300], ["output.directory .*File name too long"]),
    (["-output_directory", "a/" * 2040], ["output.directory is longer than 4063"]), (["-output_directory", "a\nb"], ["output.directory is 'a.b', with a control character or the end of a line"]),
])
def test_options(check, options, words):
    refused(check((), *options), *words)


@on_two("files", [{"a": "-options_file a"}, {"a": "-order 2\n-options_file b # which\n", "b": "-load_end 1 -options_file a"}, {"a": "-options_file b\n", "b": "\n-options_file b"}], also=[1])
def test_option_files_that_name_themselves(run, tmp_path, files, ranks):
    for name, text in files.items():
        (tmp_path / name).write_text(text.replace("_file ", f"_file {tmp_path}/"))
    result = run("inputs/patch2d.yml", "-options_file", tmp_path / "a", ranks=ranks)
    refused_run(result, "-options_file: ", "names itself")
    (tmp_path / "once").write_text("-load_step 1\n")
    (tmp_path / "a").write_text(f"-options_file {tmp_path}/once\n-options_file {tmp_path}/once\n")  # one that is read twice is no such
    assert run("inputs/patch2d.yml", "-check", "-options_file", tmp_path / "a").returncode == 0


@on_two("option,words", [(("-ksp_type", "nonsense"), "KSP type nonsense"), (("-pc_type", "nonsense"), "PC type nonsense"),
                                          (("-pc_factor_mat_solver_type", "nonsense"), "solver type nonsense"), (("-snes_view", "a.b.c"), "viewer a.b.c"),
                                          (("-log_view", "a\033b"), "viewer a?b"), (("-mat_mumps_icntl_14", "many"), "many"), (("-again_ksp_type", "nonsense"), "KSP type nonsense"),
                                          (("-multigrid_pc_type", "nonsense"), "PC type nonsense"), (("-mat_mumps_cntl_1", "many"), "many")], also=[2])
def test_types_that_petsc_does_not_know(run, option, words, ranks):
    """Told before what an earlier run has left is touched."""
    result = run("inputs/patch2d.yml", *option, ranks=ranks)
    assert not result.directory.exists()
    said = [line for line in result.stderr.splitlines() if line.startswith("mortise: ")]
    assert result.returncode == 1 and len(said) == 1 and "an option of PETSc cannot act: " in said[0] and words in said[0] and "PETSC ERROR" not in result.stderr, result


def test_what_petsc_tells_at_its_end(run):
    result = run("inputs/patch2d.yml", "-options_view", "a.b")
    assert result.returncode == 1 and result.stderr == "mortise: an option of PETSc cannot act: Unknown logical value: a.b\n", result


@on_two("option,words", [(("-solution_view", "vtk:HERE/folder.vtu"), "HERE/folder.vtu cannot be written to: Is a directory"),
                         (("-log_view", ":/nonexist/x"), "/nonexist cannot be written to: No such file"), (("-snes_monitor", "ascii:/nonexist/x"), "/nonexist cannot"),
                         (("-solution_view", "vtk:x.vtu:append"), "'append' is no format"), (("-ksp_view", "::nonsense"), "'nonsense' is no format"),
                         (("-log_view", ":HERE/theirs"), "there is a file HERE/theirs"), (("-solution_view", "hdf5:HERE/theirs::append"), "there is a file"),
                         (("-output_overwrite", "true", "-solution_view", "binary:HERE/patch.yml"), "the run itself reads or writes that file"),
                         (("-output_overwrite", "true", "-ksp_monitor", "ascii:HERE/patch.geo"), "the run itself")], also=[2])
def test_views_that_cannot_be_written(run, tmp_path, option, words, ranks):
    """Told before anything is solved; what is there stays, -log_view's file too, which PETSc would write at its end."""
    (tmp_path / "folder.vtu").mkdir()
    (tmp_path / "theirs").write_text("keep")
    for end in ("yml", "geo"):
        (tmp_path / f"patch.{end}").write_text((ROOT / f"inputs/patch2d.{end}").read_text().replace("patch2d.geo", "patch.geo"))
    before = {path: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}
    result = run(tmp_path / "patch.yml", *(word.replace("HERE", str(tmp_path)) for word in option), ranks=ranks)
    refused_run(result, words.replace("HERE", str(tmp_path)))
    assert before == {path: path.read_bytes() for path in tmp_path.iterdir() if path.is_file()}


def test_views_in_the_directory_of_the_run(run, tmp_path):
    """It is there when they are written; with output.overwrite files are replaced."""
    for _ in range(2):
        result = run("inputs/patch2d.yml", "-output_directory", tmp_path / "o", "-output_overwrite", "true", "-log_view", f":{tmp_path}/o/log", "-solution_view", f"vtk:{tmp_path}/o/u.vtu")
        assert result.returncode == 0 and result.stderr == "" and (tmp_path / "o/log").stat().st_size > 1000 and (tmp_path / "o/u.vtu").stat().st_size > 0, result
    checkpoint = (tmp_path / "o/checkpoint.h5").read_bytes()
    result = run("inputs/patch2d.yml", "-output_directory", tmp_path / "o", "-output_overwrite", "true", "-solution_view", f"hdf5:{tmp_path}/o/checkpoint.h5")
    assert result.returncode == 1 and "the run itself reads or writes" in result.stderr and checkpoint == (tmp_path / "o/checkpoint.h5").read_bytes(), result


@pytest.mark.parametrize("ranks", [1, 2])
def test_more_options_than_petsc_takes(run, ranks):
    options = [word for k in range(600) for word in (f"-mesh_parameter_p{k}", 1)]
    refused_run(run("inputs/patch2d.yml", *options, ranks=ranks), "there are more than 512 options")


def test_new(tmp_path):
    done = subprocess.run([PROGRAM, "new", "a", "b"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr == "mortise: new: 'b' after 'a'; one scene has one name\n" and not os.listdir(tmp_path), done


def test_a_working_directory_that_is_gone(tmp_path):
    (tmp_path / "gone").mkdir()
    done = subprocess.run(["sh", "-c", f"rmdir ../gone && {PROGRAM} {ROOT}/inputs/patch2d.yml"], cwd=tmp_path / "gone", capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr.startswith("mortise: the working directory cannot be found") and done.stderr.count("\n") == 1, done


# ---- meshes ---------------------------------------------------------------------------------------------------------------------------------

ALONE = """mesh: {file: m.msh}
model: plane_strain
body: {lower: {material: rubber}}
material: {rubber: {law: neo_hookean, E: 1, nu: 0.3}}
boundary: {bottom: {fix: xy}}
load: {step: 1}
"""
SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
CELLS = ("1 2 3 1 1 2", "3 2 1 1 1 2 3 4")


def msh(nodes=SQUARE, cells=CELLS, names=('1 3 "bottom"', '2 1 "lower"')):
    def section(name, rows):
        return "\n".join([f"${name}", *([] if name == "MeshFormat" else [str(len(rows))]), *rows, f"$End{name}"]) + "\n"

    return (section("MeshFormat", ["2.2 0 8"]) + section("PhysicalNames", names) + section("Nodes", [f"{i} {x} {y} 0" for i, (x, y) in enumerate(nodes, 1)])
            + section("Elements", [f"{i} {cell}" for i, cell in enumerate(cells, 1)]))


@pytest.mark.parametrize("mesh,words", [
    (msh([(0, 0), (1, 0), (1, 0), (0, 0)]), "inverted or degenerate"), (msh([(0, 0), (1, 0), (2, 0), (3, 0)]), "inverted or degenerate"),
    (msh([(0, 0), (1, 0), (0.1, 0.1), (0, 1)]), "inverted or degenerate"), (msh([(1e200 * x, 1e200 * y) for x, y in SQUARE]), "is 1e+200 long, and its volume is none"),
    (msh([(1e-200 * x, 1e-200 * y) for x, y in SQUARE]), "is 1e-200 long, and its volume is none"), (msh(cells=[]), "has no cells of dimension 2"),
    (msh(cells=["15 2 3 1 1"]), "has no cells of dimension 2"), (msh(cells=CELLS[1:]), "no boundary group 'bottom'; it has: none"),
    (msh(cells=["1 2 3 1 1 3", CELLS[1]]), "group 'bottom' joins nodes of the cell at (0.5, 0.5, 0) and is none of its facets"), (msh(cells=[CELLS[0], "3 2 0 1 1 2 3 4"]), "is in no physical group of dimension 2"),
    (msh(cells=[CELLS[0], "3 2 1 1 1 2 3 3"]), "an element names a node twice"), (msh(names=['1 3 "bottom"', '2 7 "lower"']), "no physical group 'lower' of dimension 2"),
    ("", "does not begin with $MeshFormat"), ("$NOD\n1\n1 0 0 0\n$ENDNOD\n", "does not begin with $MeshFormat"), ("$MeshFormat\n4 0 8\n$EndMeshFormat\n", "has gmsh format version 4.0"),
    (msh().replace("1 0 0\n", "1,0 0 0\n"), "truncated or damaged"), (None, "cannot be read"),
    (msh([*SQUARE, (0, 0), (1, 0)], ["1 2 3 1 5 6", CELLS[1]]), "element 1 of a boundary group is no facet of a cell"),
    (msh(cells=[*CELLS, "1 2 3 1 2 4"]), "as a diagonal"),
    (msh(names=('1 3 "bottom"', '2 1"lower"')), "a line of $PhysicalNames"), (msh(names=('1 3\x1b "bottom"', '2 1 "lower"')), "a line of $PhysicalNames"),
    (msh(names=('1 3 4680"bottom"', '2 1 "lower"')), "a line of $PhysicalNames"),
    (msh([*SQUARE, (0.5, 0.9), (1, 0.5), (0.5, 1), (0, 0.5), (0.5, 0.5)], ["8 2 3 1 1 2 5", "10 2 1 1 1 2 3 4 5 6 7 8 9"]), "positive everywhere; with straight sides it would be"),
])
def test_mesh(run, tmp_path, mesh, words):
    if mesh is None:
        (tmp_path / "m.msh").mkdir()
    else:
        (tmp_path / "m.msh").write_text(mesh)
    refused_run(run("s.yml", "-check", text=ALONE), words)


@pytest.mark.parametrize("mesh", [msh(), msh().replace("\n", "\r\n"), msh(cells=[CELLS[0], "3 2 1 1 4 3 2 1"]), msh(names=['1 3 "bottom"', '2 1 "lower"', '2 2 "ghost"'])])
def test_mesh_that_is_good(run, tmp_path, mesh):
    """Lines end as elsewhere, a cell runs the other way round, a group is empty."""
    (tmp_path / "m.msh").write_text(mesh)
    assert run("s.yml", "-check", text=ALONE).returncode == 0


def test_more_processes_than_cells(run, tmp_path):
    (tmp_path / "m.msh").write_text(msh())
    result = run("s.yml", text=ALONE, ranks=3)
    assert result.returncode == 0 and result.summary["cells"] == 1 and result.summary["ranks"] == 3, result


def test_keys_of_a_geo_on_a_mesh(run, tmp_path):
    (tmp_path / "m.msh").write_text(msh())
    refused_run(run("s.yml", "-check", text=ALONE.replace("m.msh", "m.msh, parameter: {n: 2}")), "mesh.parameter: only a .geo has parameters")
    told = "mesh.order acts on a .geo, which is meshed here; cells of mesh.file m.msh have the order that they have"
    assert told in run("s.yml", "-check", text=ALONE.replace("m.msh", "m.msh, order: 2")).stdout and told not in run("s.yml", "-check", text=ALONE).stdout


@pytest.mark.parametrize("line", ["Mesh.Binary = 1;", "Mesh.Format = 2;", "Mesh.MshFileVersion = 1;", "Mesh.SaveParametric = 1;", "Exit;"])
def test_formats_that_a_geo_asks_for(check, line):
    """They are for another reader."""
    result = check(geo=GEO + line + "\n")
    if line == "Exit;":
        refused(result, "gmsh ended without a mesh")
    else:
        assert result.returncode == 0 and "8 cells" in result.stdout, result


def test_texts_that_are_no_utf8(tmp_path):
    """summary.json is JSON all the same."""
    (tmp_path / "m.msh").write_text(msh())
    (tmp_path / "s.yml").write_text(ALONE)
    done = subprocess.run([PROGRAM, "s.yml", "-title", b"gr\xf6\xdfe \xe2\x98\x83 \xe2\x98", "-output_directory", "out"], cwd=tmp_path, capture_output=True)
    assert done.returncode == 0 and json.loads((tmp_path / "out/summary.json").read_text())["title"] == "gr??e \u2603 ??", done


def test_no_room_for_the_mesh_of_gmsh(run, tmp_path):
    """gmsh says nothing, and leaves a part of it."""
    (tmp_path / "squares.geo").write_text(GEO + "// a mesh that is not there yet\n")
    with limited(resource.RLIMIT_FSIZE, 1):
        refused_run(run("s.yml", text=SCENE), "gmsh could not write all of its mesh to ", "TMPDIR")


# ---- going on -------------------------------------------------------------------------------------------------------------------------------


def test_orders_after_a_restart_are_told_as_they_are(run, tmp_path):
    """Of the checkpoint's cells, not of the scene that goes on."""
    (tmp_path / "m.msh").write_text(msh())
    first = run("s.yml", "-load_step", 0.5, "-load_max_steps", 1, text=ALONE)
    assert first.returncode == 2 and "1 cells of order 1," in first.stdout, first
    result = run("s.yml", "-order", 2, "-restart", first.directory / "checkpoint.h5", text=ALONE)
    assert result.returncode == 0 and "1 cells of order 1," in result.stdout and "note: cells keep the orders that they have" in result.stdout, result
    again = run("s.yml", "-restart", first.directory / "checkpoint.h5", text=ALONE)
    assert again.returncode == 0 and "cells keep the orders" not in again.stdout, again



TOP = ("1 2 3 1 1 2", "1 2 4 1 3 4", "3 2 1 1 1 2 3 4")


@pytest.mark.parametrize("body,boundary,more,words", [
    ("rigid", {"top": {"traction": {"y": 1}}}, {}, "boundary.top.traction: the boundary is one of the rigid body 'lower'"),
    ("rigid", {"top": {"pressure": 1}}, {}, "boundary.top.pressure: the boundary is one of the rigid body 'lower'"),
    (None, {"top": {"traction": {"y": 1}, "displacement": {"y": 0.1}}}, {}, "boundary.top.traction.y: the displacement of this boundary along y is prescribed"),
    (None, {"top": {"pressure": 1, "fix": "xy"}}, {}, "boundary.top.pressure: all displacements of this boundary are prescribed"),
    (None, {}, {"refine": {"a": {"x": 100, "y": 0, "radius": 1}}}, "refine.a: no cell is there"),
    (None, {"top": {"traction": {"x": 0, "y": 1}, "fix": "x"}}, {}, ""),
])
def test_loads_that_cannot_act(run, tmp_path, body, boundary, more, words):
    (tmp_path / "m.msh").write_text(msh(cells=TOP, names=('1 3 "bottom"', '1 4 "top"', '2 1 "lower"')))
    law = {"law": "rigid"} if body else {"law": "neo_hookean", "E": 1, "nu": 0.3}
    scene = {"mesh": {"file": "m.msh"}, "model": "plane_strain", "body": {"lower": {"material": "rubber"}}, "material": {"rubber": law},
             "boundary": {**({} if body else {"bottom": {"fix": "xy"}}), **boundary}, "load": {"step": 1}} | more
    result = run("s.yml", "-check", text=json.dumps(scene))
    assert result.returncode == (1 if words else 0) and words in result.stderr, result


def test_stiff_beyond_round_off(run, tmp_path):
    """Forces of a body that is 1e15 times softer than another one were lost in that one's round-off, 6 % of them, and exit 0."""
    (tmp_path / "m.msh").write_text(msh([*SQUARE, (2, 0), (2, 1)], ["1 2 3 1 1 2", "3 2 1 1 1 2 3 4", "3 2 2 2 2 5 6 3"], ('1 3 "bottom"', '2 1 "lower"', '2 2 "side"')))
    for E, status in ((1e15, 1), (1e9, 0)):
        result = run("s.yml", text=ALONE.replace("{lower: {material: rubber}}", "{lower: {material: rubber}, side: {material: stiff}}")
                     .replace("{rubber:", f"{{stiff: {{law: neo_hookean, E: {E}, nu: 0.3}}, rubber:"))
        assert result.returncode == status and (status == 0 or "more than 1e10 times that of material rubber" in result.stderr), result


def test_far_from_the_origin(run, tmp_path):
    for far in (0, 1e8):
        (tmp_path / "m.msh").write_text(msh([(x + far, y) for x, y in SQUARE]))
        result = run("s.yml", "-check", text=ALONE)
        assert result.returncode == 0 and ("times as far from the origin as it is large" in result.stdout) == (far > 0), result
