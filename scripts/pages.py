"""Pages of the manual that can be run: used by tests/verify/test_manual.py and scripts/gallery.

In a page, a comment before a code block says what it is: `<!-- file: NAME -->` a file of that name, `<!-- output -->` lines that the command before printed
("..." is anything), `<!-- exit: N -->` the exit status of the commands below. Blocks marked `sh` are run, all in one folder. `<!-- picture: FILE -->` before
an image says which file of a run it is made from.
"""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"(?:^<!-- (\w+)(?:: (\S+))? -->\n)?^```(\w+)\n(.*?)^```$", re.M | re.S)
PICTURE = re.compile(r"^<!-- picture: (\S+) -->\n!\[[^\]]*\]\((\S+)\)", re.M)
INSTALLED = {"mortise-plot": "scripts/plot", "mortise-batch": "scripts/hpc/batch", "mortise-import": "scripts/import", "mortise-simplify": "scripts/simplify"}


def environment(program, folder):
    """The programs by the names that they are installed under, first in PATH."""
    folder.mkdir()
    (folder / "mortise").symlink_to(program)
    for name, file in INSTALLED.items():
        (folder / name).symlink_to(ROOT / file)
    (folder / "python3").symlink_to(sys.executable)  # that which runs this has what the package needs
    return {**os.environ, "MORTISE": str(program), "PYTHONPATH": str(ROOT / "python"), "PATH": f"{folder}:{os.environ['PATH']}"}


def pattern(line):
    return r"\s+".join(r".*".join(map(re.escape, word.split("..."))) for word in line.split())


def walk(page, folder, environment, seconds=300):
    """Do what a page says, in a folder; an AssertionError says what came out otherwise. Seconds: for each block."""
    said = ""
    for kind, what, language, text in BLOCK.findall(page.read_text()):
        if kind == "file":
            (folder / what).write_text(text)
        elif kind == "output":
            missing = [line for line in text.splitlines() if not re.search(rf"^\s*{pattern(line)}\s*$", said, re.M)]
            assert not missing, (missing, said)
        elif language == "sh":
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, timeout=seconds, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            said = done.stdout
            assert done.returncode == int(what if kind == "exit" else 0), (text, said)


def pictures(page):
    """[(file of a run, picture beside the page)]."""
    return [(made, page.parent / name) for made, name in PICTURE.findall(page.read_text())]
