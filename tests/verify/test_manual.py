"""The manual: every command in it runs and prints what the page says, no link leads nowhere, and the site is built without a warning.

How a page says what is to be run: scripts/pages.py.
"""
import os
import re
import shutil
import subprocess
import sys

import pytest
from conftest import PROGRAM, ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import pages

TUTORIALS = sorted(f"tutorials/{path.name}" for path in (ROOT / "docs/tutorials").glob("*.md"))
ENVIRONMENT = {**os.environ, "MORTISE": str(PROGRAM)}
SITE = "mkdocs"


@pytest.mark.parametrize("page", ["start.md", "howto.md", *(pytest.param(page, marks=pytest.mark.slow) for page in TUTORIALS)])
def test_commands(page, tmp_path):
    folder = tmp_path / "work"
    folder.mkdir()
    pages.walk(ROOT / "docs" / page, folder, pages.environment(PROGRAM, tmp_path / "bin"))


@pytest.mark.parametrize("page", TUTORIALS)
def test_tutorials_have_a_picture_and_a_check(page):
    """Each ends at a figure that theory confirms: check.py compares, with status 1 where it differs."""
    text = (ROOT / "docs" / page).read_text()
    assert pages.pictures(ROOT / "docs" / page)
    assert "<!-- file: check.py -->" in text and "python3 check.py" in text and "assert" in text


def test_no_dead_link(tmp_path):
    done = subprocess.run([ROOT / "scripts/manual", tmp_path / "manual"], env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stdout, done


def test_dead_links_are_told(tmp_path):
    """The check itself: a page with links to nothing, in a copy of the source."""
    for folder in ("docs", "scripts", "src", "include"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    shutil.copy(ROOT / "README.md", tmp_path)
    (tmp_path / "docs/index.md").write_text("# A page\n[a](nowhere.md) [b](start.md#nowhere) [c](#nothing) `[d](code.md)` [e](start.md#install) [f](#a-page)\n")
    done = subprocess.run([tmp_path / "scripts/manual", tmp_path / "manual"], env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 1
    assert re.findall(r"index.md: dead link (\S+)", done.stdout) == ["nowhere.md", "start.md#nowhere", "#nothing"]


def test_site(tmp_path):
    """Strict: a warning is an error."""
    if not shutil.which(SITE):
        pytest.skip("no mkdocs; `make docs` installs it")
    subprocess.run([ROOT / "scripts/manual", tmp_path / "manual"], env=ENVIRONMENT, check=True)
    text = (ROOT / "mkdocs.yml").read_text().replace("build/manual", str(tmp_path / "manual")).replace("out/manual", str(tmp_path / "site"))
    (tmp_path / "mkdocs.yml").write_text(text)
    done = subprocess.run([SITE, "build", "-f", tmp_path / "mkdocs.yml"], capture_output=True, text=True)
    assert done.returncode == 0 and "WARNING" not in done.stderr, done
    assert (tmp_path / "site/reference/keys.html").exists()


@pytest.fixture(scope="module")
def messages():
    """Patterns of the sentences in reference/messages.md, by section."""
    text = subprocess.run([ROOT / "scripts/messages"], check=True, capture_output=True, text=True).stdout
    sections = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", text, re.M | re.S))
    return {title: [re.sub(r"…|\\ ", lambda m: ".*" if m[0] == "…" else " ", re.escape(words)) for words in re.findall(r"^- `(.*)`$", body, re.M)]
            for title, body in sections.items()}


@pytest.mark.parametrize("options", [["-material_rubber_E", "-1"], ["-model", "shell"], ["-mesh_file", "nothing.geo"], ["-adapt_tolerence", "1"],
                                     ["-boundary_top_displacement_y", "1+"], ["-solve_rtol", "0.1"], ["-restart", "nothing.h5"]])
def test_refusals_are_in_the_reference(messages, options, tmp_path):
    done = subprocess.run([PROGRAM, ROOT / "inputs/hertz2d.yml", "-check", *options], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    told = done.stderr.removeprefix("mortise: ").strip()
    own = [words for words in messages["Refused"] if re.search("[a-z]{4}", words)]  # not one that matches everything
    assert [words for words in own if re.fullmatch(words, told)], told


def test_every_refusal_of_the_source_is_in_the_reference(messages):
    """As many at least as there are calls with a sentence of their own; warnings, notes and failures too."""
    calls = sum(len(re.findall(r"\b(?:PetscCheckInput|ErrorInput)\(", path.read_text())) for path in ROOT.glob("src/**/*.c"))
    assert len(messages["Refused"]) > 0.9 * calls > 200
    assert all(messages[title] for title in ("Warnings", "Notes", "Why a run failed"))


def test_what_the_developer_guide_names_exists():
    """Files, functions of the program, words in capitals: `code` that looks like one."""
    words = set(re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```$", "", (ROOT / "docs/developer.md").read_text(), flags=re.M | re.S)))
    source = "\n".join(path.read_text() for folder in ("src", "include") for path in (ROOT / folder).rglob("*.[ch]"))
    files = {word for word in words if re.fullmatch(r"(src|include|tests|scripts|docs)/[\w/.]+", word)}
    names = {word for word in words if re.fullmatch(r"[A-Z]\w*[a-z]\w*|PART_\w+|MORTISE_\w+|NUM_LANES|\w+_Private", word)}
    assert len(files) > 30 and len(names) > 15
    assert not [file for file in files if not (ROOT / file).exists()]
    assert not [name for name in names if not re.search(rf"\b{name}\b", source)]


@pytest.mark.parametrize("page", [*sorted(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md")), *(f"docs/{page}" for page in TUTORIALS),
                                  "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "packaging/README.md"])
def test_lines_are_short(page):
    """Of prose; not of code and tables. scripts/wrap fills them again."""
    text = re.sub(r"^```.*?^```$", "", (ROOT / page).read_text(), flags=re.M | re.S)
    assert not [line for line in text.splitlines() if len(line) > 120 and not line.startswith(("|", "    ", "!["))]
