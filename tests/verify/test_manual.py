"""The manual: every command in it runs and prints what the page says, no link leads nowhere, and the site is built without a warning.

In pages, a comment before a code block says what it is: `<!-- file: NAME -->` a file of that name, `<!-- output -->` lines that the command before printed
("..." is anything), `<!-- exit: N -->` the exit status of the commands below. Blocks marked `sh` are run, in one folder for each page.
"""
import os
import re
import shutil
import subprocess

import pytest
from conftest import PROGRAM, ROOT

PAGES = ["start.md", "howto.md"]
BLOCK = re.compile(r"(?:^<!-- (\w+)(?:: (\S+))? -->\n)?^```(\w+)\n(.*?)^```$", re.M | re.S)
ENVIRONMENT = {**os.environ, "MORTISE": str(PROGRAM)}
SITE = "mkdocs"


@pytest.fixture
def path(tmp_path):
    """PATH with the programs as they are installed."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, file in (("mortise", PROGRAM), ("mortise-plot", ROOT / "scripts/plot"), ("mortise-batch", ROOT / "scripts/hpc/batch"),
                       ("mortise-import", ROOT / "scripts/import")):
        (folder / name).symlink_to(file)
    return f"{folder}:{os.environ['PATH']}"


def pattern(line):
    return r"\s+".join(r".*".join(map(re.escape, word.split("..."))) for word in line.split())


@pytest.mark.parametrize("page", PAGES)
def test_commands(page, path, tmp_path):
    folder = tmp_path / "work"
    folder.mkdir()
    said = ""
    for kind, what, language, text in BLOCK.findall((ROOT / "docs" / page).read_text()):
        if kind == "file":
            (folder / what).write_text(text)
        elif kind == "output":
            missing = [line for line in text.splitlines() if not re.search(rf"^\s*{pattern(line)}\s*$", said, re.M)]
            assert not missing, (missing, said)
        elif language == "sh":
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env={**ENVIRONMENT, "PATH": path}, timeout=300,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            said = done.stdout
            assert done.returncode == int(what if kind == "exit" else 0), (text, said)


def test_no_dead_link(tmp_path):
    done = subprocess.run([ROOT / "scripts/manual", tmp_path / "manual"], env=ENVIRONMENT, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stdout, done


def test_dead_links_are_told(tmp_path):
    """The check itself: a page with links to nothing, in a copy of the source."""
    for folder in ("docs", "scripts"):
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


@pytest.mark.parametrize("page", ["index.md", "start.md", "howto.md", "developer.md"])
def test_lines_are_short(page):
    """Of prose; not of code and tables."""
    text = re.sub(r"^```.*?^```$", "", (ROOT / "docs" / page).read_text(), flags=re.M | re.S)
    assert not [line for line in text.splitlines() if len(line) > 120 and not line.startswith(("|", "    "))]
