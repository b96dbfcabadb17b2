"""What a new user meets first: installation, a scene to start from, the schema for editors, completion and man page, all made from the program's tables."""
import copy
import json
import os
import re
import resource
import shutil
import subprocess

import pytest
import yaml
from conftest import PROGRAM, ROOT, execute
from test_hostile import limited

DESCRIBE = ROOT / "scripts" / "describe"


def describe(*what):
    return subprocess.run([DESCRIBE, *what], env={**os.environ, "MORTISE": str(PROGRAM)}, capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """An installation, away from the source."""
    directory = tmp_path_factory.mktemp("prefix")
    build = os.environ.get("MORTISE_BUILD", str(ROOT / "build"))
    command = ["make", "-o", str(PROGRAM), "install", f"PREFIX={directory}", f"PROGRAM={PROGRAM}", f"BUILD={build}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return directory


@pytest.fixture(scope="module")
def validator():
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(describe("schema"))
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


# ---- installation, and a scene to start from ----------------------------------------------------------------------------------


def test_install_and_new(prefix, tmp_path):
    """Installed, the program writes a scene, solves it and draws it; it replaces nothing."""
    home = {"PATH": f"{prefix / 'bin'}:{os.environ['PATH']}"}

    def start(*command):
        return subprocess.run(command, cwd=tmp_path, env={**os.environ, **home}, capture_output=True, text=True)

    assert start("mortise", "--version").stdout.startswith("mortise ")
    assert start("mortise", "new", "first").returncode == 0
    text = (tmp_path / "first.yml").read_text()
    again = start("mortise", "new", "first")
    assert again.returncode == 1 and again.stderr == "mortise: new: cannot write first.yml: File exists\n"
    assert (tmp_path / "first.yml").read_text() == text and "@NAME@" not in text + (tmp_path / "first.geo").read_text()
    run = start("mortise", "first.yml")
    assert run.returncode == 0 and not run.stderr and "warning" not in run.stdout, run
    summary = json.loads((tmp_path / "out/first/summary.json").read_text())
    assert summary["status"] == "converged" and summary["contact"]["punch_on_block"]["force"][1] == pytest.approx(-1.0987, rel=0.01)
    assert start("mortise-plot", "out/first").returncode == 0 and (tmp_path / "out/first/mesh.png").exists()
    simplify = start("mortise-simplify", "first.yml", "-o", "simple")
    assert simplify.returncode == 0 and (tmp_path / "simple/simpler.yml").exists(), simplify
    wrong = start("mortise-simplify", "first.yml", "load.step")
    assert wrong.returncode == 1 and wrong.stderr == "simplify: 'load.step' is not KEY=VALUE\n", wrong
    batch = start("mortise-batch", prefix / "share/mortise/examples/patch2d.yml")
    assert batch.returncode == 0 and "converged" in batch.stdout, batch


def test_new_leaves_the_scene_where_only_the_geometry_is_in_the_way(tmp_path):
    (tmp_path / "a.geo").write_text("mine")
    refused = subprocess.run([PROGRAM, "new", "a"], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 1 and "a.geo" in refused.stderr
    assert sorted(os.listdir(tmp_path)) == ["a.geo"] and (tmp_path / "a.geo").read_text() == "mine"


@pytest.mark.parametrize("kilobytes", [0, 1])
def test_new_leaves_nothing_where_there_is_no_room(tmp_path, kilobytes):
    with limited(resource.RLIMIT_FSIZE, kilobytes):
        full = subprocess.run([PROGRAM, "new", "a"], cwd=tmp_path, capture_output=True, text=True)
    assert full.returncode == 1 and full.stderr.startswith("mortise: new: cannot write a.") and not os.listdir(tmp_path), full


@pytest.mark.parametrize("name", ["", "a/b", "-a", "a b", "a" * 64])
def test_new_refuses_names(tmp_path, name):
    refused = subprocess.run([PROGRAM, "new", name], cwd=tmp_path, capture_output=True, text=True)
    assert refused.returncode == 1 and "is no name for a scene" in refused.stderr and not os.listdir(tmp_path)


def test_one_version():
    version = execute([str(PROGRAM), "--version"])[1].split()[1]
    assert (ROOT / "debian/changelog").read_text().startswith(f"mortise ({version})")
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()


def test_help_by_any_name():
    texts = {execute([str(PROGRAM), option])[1] for option in ("-help", "--help", "-h")}
    assert len(texts) == 1 and "mortise new NAME" in texts.pop()


@pytest.mark.parametrize("word, rows", [("contact.<pair>.fric", {"contact.<pair>.friction"}), ("max_seconds", {"-max_seconds"}),
                                        ("-newton_st", {"-newton_stall"}), ("Adapt_tol", {"adapt.tolerance"})])
def test_help_of_a_word(word, rows):
    """Keys and options with the word in their name, as it is in a file or on the command line, and no text besides."""
    text = execute([str(PROGRAM), "-help", word])[1]
    assert set(re.findall(r"^  (\S+)  ", text, re.M)) == rows and len(text.splitlines()) == 2 * len(rows), text


def test_help_of_nothing():
    status, out, err = execute([str(PROGRAM), "-help", "frict\x1bion"])
    assert status == 1 and out == "" and "no key or option has that in its name" in err and "\x1b" not in err, err


# ---- schema ---------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("folder", ["inputs", "tests/gauntlet", "tests/verify/scenes"])
def test_schema_knows_our_scenes(validator, folder):
    scenes = sorted((ROOT / folder).glob("*.yml"))
    assert scenes
    for scene in scenes:
        assert not [f"{scene.name}: {list(e.path)}: {e.message}" for e in validator.iter_errors(yaml.safe_load(scene.read_text()))]


BASE = {"mesh": {"file": "patch2d.geo"}, "model": "plane_strain", "body": {"upper": {"material": "rubber"}, "lower": {"material": "rubber"}},
        "material": {"rubber": {"law": "neo_hookean", "E": 1, "nu": 0.3}}, "boundary": {"top": {"displacement": {"y": -0.1}}, "bottom": {"fix": "xy"}},
        "contact": {"pair": {"nonmortar": "a", "mortar": "b"}}}
GONE = object()
WRONG = [("mesh.file", GONE), ("model", GONE), ("body.upper.material", GONE), ("material.rubber.law", GONE), ("contact.pair.mortar", GONE),
         ("contact.pair.nonmortar", GONE), ("model", "plane_stress"), ("model", 3), ("kinematics", "large"), ("order", 0), ("order", 9), ("order", 1.5),
         ("order", "two"), ("mesh.order", 5), ("mesh.order", 0), ("mesh.refine", -1), ("mesh.trust", "perhaps"), ("mesh.size", 1), ("mesh.parameter.n", "many"),
         ("bodies", {}), ("body.upper.order", 9), ("body.upper.order", {"w": 1}), ("body.upper.stiffness", 1), ("body.upper.amplitude", 1),
         ("body.upper.amplitude", [0]), ("material.rubber.law", "neohookean"), ("material.rubber.E", "soft"), ("material.rubber.E", 0),
         ("material.rubber.E", -1), ("material.rubber.nu", 0.6), ("material.rubber.c1", 1), ("material.rubber.yield", 1),
         ("material.rubber.volumetric", "cubic"), ("material.rubber.formulation", "hybrid"), ("material.rubber.young", 1),
         ("boundary.top.fix", "xw"), ("boundary.top.displacement.w", 1), ("boundary.top.displacement", 1), ("boundary.top.rotation.axis", "u"),
         ("boundary.top.load", 1), ("contact.pair.order", 2), ("contact.pair.roles", "swap"), ("contact.pair.subdivide", 9), ("contact.pair.friction", -1),
         ("contact.pair.law", "stick"), ("contact.pair.search", -1), ("contact.pair.slave", "a"), ("load.end", 0), ("load.step", -1),
         ("load.max_steps", 0), ("load.control", "force"), ("load.steps", 10), ("adapt.tolerance", 1), ("adapt.fraction", 0), ("adapt.strategy", "r"),
         ("adapt.max_order", 9), ("output.divide", 9), ("output.fields", "maybe"), ("output.checkpoint", -1), ("probe.p.w", 1), ("title", []), ("title", ""),
         ("title", 256 * "t"), ("units", ""), ("output.quantities", ""), ("output.directory", ""), ("output.overwrite", 2)]
ODD = [("adapt", None), ("order", 1.0), ("output.overwrite", 1), ("output.fields", "no"), ("title", 255 * "t")]


@pytest.mark.parametrize("path,value", ODD)
def test_schema_takes_what_the_program_takes(validator, tmp_path, path, value):
    scene = copy.deepcopy(BASE)
    *above, last = path.split(".")
    (scene.setdefault(above[0], {}) if above else scene)[last] = value
    assert not list(validator.iter_errors(scene))
    (tmp_path / "patch2d.geo").write_text("")
    (tmp_path / "odd.yml").write_text(yaml.safe_dump(scene))
    status, _, error = execute([str(PROGRAM), str(tmp_path / "odd.yml"), "-check"])
    assert status == 1 and "cells of dimension" in error, error


@pytest.mark.parametrize("path,value", WRONG, ids=[f"{path}={value}" if value is not GONE else f"no {path}" for path, value in WRONG])
def test_schema_refuses_what_the_program_refuses(validator, tmp_path, path, value):
    assert not list(validator.iter_errors(BASE))
    scene = copy.deepcopy(BASE)
    *above, last = path.split(".")
    at = scene
    for key in above:
        at = at.setdefault(key, {})
    if value is GONE:
        del at[last]
    else:
        at[last] = value
    assert list(validator.iter_errors(scene))
    (tmp_path / "patch2d.geo").write_text("")
    (tmp_path / "wrong.yml").write_text(yaml.safe_dump(scene))
    status, _, error = execute([str(PROGRAM), str(tmp_path / "wrong.yml"), "-check"])
    assert status == 1 and "cells of dimension" not in error, error  # before the mesh, which is empty, is looked at


# ---- completion, man page, reference ------------------------------------------------------------------------------------------------


def test_bash_completion(tmp_path):
    """Completes options, words that they take, and scenes."""
    (tmp_path / "_mortise").write_text(describe("bash"))
    (tmp_path / "scene.yml").write_text("")
    for line, expected in (("mortise -adapt_str", "-adapt_strategy"), ("mortise s.yml -adapt_strategy h", "h hp"), ("mortise sc", "scene.yml"), ("mortise ne", "new"),
                           ("mortise -newton_stall o", "on off"), ("mortise -max_s", "-max_seconds")):
        words = line.split(" ")
        program = f'source ./_mortise; COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _mortise; echo "${{COMPREPLY[*]}}"'
        said = subprocess.run(["bash", "-c", program], cwd=tmp_path, capture_output=True, text=True)
        assert said.stdout.strip() == expected and not said.stderr, (line, said)


def test_zsh_completion_parses(tmp_path):
    (tmp_path / "_mortise").write_text(describe("zsh"))
    assert "-adapt_strategy" in (tmp_path / "_mortise").read_text()
    if shutil.which("zsh"):
        assert subprocess.run(["zsh", "-f", "-n", tmp_path / "_mortise"], capture_output=True).returncode == 0


def test_man_page_has_every_key():
    page = describe("man").replace("\\-", "-")
    tables = json.loads(execute([str(PROGRAM), "-help", "json"])[1])
    assert not [row["key"] for row in tables["keys"] if f".B {row['key']}\n" not in page]
    assert all(f".B {option} " in page for option in ("-restart", "-max_seconds", "-solve_linear", "-newton_stall", "-path_descent"))
    if shutil.which("groff"):
        said = subprocess.run(["groff", "-man", "-Tutf8", "-ww"], input=page, capture_output=True, text=True)
        assert said.returncode == 0 and not said.stderr, said.stderr


def test_reference_has_every_key_and_field(tmp_path):
    describe("reference", str(tmp_path))
    pages = "".join((tmp_path / f"{name}.md").read_text() for name in ("keys", "laws", "options", "files", "exit"))
    tables = json.loads(execute([str(PROGRAM), "-help", "json"])[1])
    names = [row["key"] for row in tables["keys"]] + [row["name"] for rows in tables["files"].values() for row in rows]
    names += [p["name"] for law in tables["laws"] for p in law["parameters"]] + re.findall(r"^  (-\w+) ", execute([str(PROGRAM), "-help"])[1], re.M)
    assert len(names) > 200 and not [name for name in names if f"`{name}`" not in pages]
    assert [line for line in pages.splitlines() if line.startswith("| 3 |")]


# ---- tables of columns and fields are what runs write ----------------------------------------------------------------------------------


def matched(name, fields):
    """The rows of a table that a name is one of."""
    return [name] if name in fields else [f for f in fields if re.fullmatch(re.sub(r"<\w+>", "[^.]+", f.replace(".", r"\.").replace("<axis>", "[xyz]")), name)]


def paths(value, above=""):
    for key, v in value.items():
        if isinstance(v, dict) and v and key != "set":  # keys of the scene
            yield from paths(v, f"{above}{key}.")
        elif not isinstance(v, dict) or key == "set":
            yield above + key


SCENES = [("inputs/hertz2d.yml", "-adapt_tolerance", 0.1, "-probe_p_x", 0, "-probe_p_y", 0.5), ("inputs/necking.yml", "-load_max_steps", 1, "-probe_p_y", 1),
          ("inputs/balloon.yml", "-load_max_steps", 1), ("inputs/blocks3d.yml", "-adapt_max_passes", 0, "-load_max_steps", 1),
          ("inputs/cook.yml", "-material_rubber_kappa", "inf", "-load_max_steps", 1), ("inputs/belt.yml", "-load_max_steps", 1),
          ("inputs/necking.yml", "-load_end", 1e-4, "-load_step", 1e-4), ("inputs/tied_lshape.yml", "-adapt_max_passes", 1), ("tests/gauntlet/rigid_disc.yml", "-load_max_steps", 1), ("tests/gauntlet/rigid3d.yml", "-load_max_steps", 1)]


def test_fields_of_runs_are_in_the_tables(run):
    """Every column and field of these runs is in its table, once; and all of the tables but two occur."""
    tables = {file: [row["name"] for row in rows] for file, rows in json.loads(execute([str(PROGRAM), "-help", "json"])[1])["files"].items() if file != "fields.xdmf"}
    seen = {file: set() for file in tables}
    for scene, *options in SCENES:
        result = run(scene, *options, "-output_fields", "false")
        names = {"summary.json": list(paths(result.summary))}
        for file in ("history.csv", "adapt.csv"):
            names[file] = (result.directory / file).read_text().splitlines()[0].split(",")
        for file, of_run in names.items():
            rows = [matched(name, tables[file]) for name in of_run]
            assert all(len(row) == 1 for row in rows), (scene, file, [pair for pair in zip(of_run, rows) if len(pair[1]) != 1])
            seen[file].update(row[0] for row in rows)
    missing = {name for file in tables for name in tables[file] if name not in seen[file]}
    assert missing <= {"advance.<boundary>", "units"}, missing


def test_fields_of_field_files_are_in_the_table(run):
    """And all of the table occur in these runs."""
    table = {row["name"] for row in json.loads(execute([str(PROGRAM), "-help", "json"])[1])["files"]["fields.xdmf"]}
    wanted = ("-output_quantities", "principal_stretches,logarithmic_strain,energy_density,first_piola", "-output_segments", "true", "-load_max_steps", 1)
    results = [run("inputs/belt.yml", *wanted), run("inputs/necking.yml", "-load_max_steps", 1)]
    seen = {name for result in results for grid in ("bulk", "contact", "segments") for _, fields in result.states(grid)[-1:] for name in fields} - {"cells"}
    assert seen == table, seen ^ table
