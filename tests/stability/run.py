#!/usr/bin/env python3
"""Run the rows of the stability suite and write docs/stability.md. Arguments are pytest's: run.py -m "not slow", run.py -k clip; nothing is written with them."""
import os
import pathlib
import shutil
import subprocess
import sys
import time

import pytest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PAGE = ROOT / "docs" / "stability.md"
PICTURES = ROOT / "docs" / "stability"
HEAD = """# Where methods fail

Each row is a way in which methods fail: what a run does as it is, and the failing method *run beside it*, by a switch
of the same program on the same scene. `make stability` runs all of them and writes this page; each row is a test of
`tests/stability` that asserts both sides, and a quick part of them is in `make test`. Where the program has no switch
for a method that fails, it is a textbook one in a few lines of the test. Pictures are drawn from what the runs left:
last states coloured by the stress of von Mises unless they are charts; red: the other way.

"""


def reason(report):
    """What of a test did not hold, in its own figures."""
    message = getattr(getattr(report.longrepr, "reprcrash", None), "message", "the test fails")
    return next((line.strip() for line in reversed(message.splitlines()) if line.startswith("assert")), message.splitlines()[0])


class Rows:
    """Collects what tests tell (kit.py)."""

    def __init__(self): self.tests, self.rows = {}, []

    def pytest_collection_modifyitems(self, items):
        for item in items: self.tests[item.nodeid] = getattr(item.function, "way", {})

    def pytest_runtest_logreport(self, report):
        if report.when != "call" and not (report.when == "setup" and report.failed): return
        told = [value for name, value in report.user_properties if name == "stability"]
        row = {**self.tests[report.nodeid], **(told[-1] if told else {"values": ["-", "-"]})}
        if "title" not in row: return
        state = "yes" if report.passed else f"**no**: {report.wasxfail}" if hasattr(report, "wasxfail") else f"**no**: {reason(report)}"
        self.rows.append({**row, "passed": state, "test": report.nodeid.split("::")[-1], "file": pathlib.Path(report.nodeid.split("::")[0]).name})


def cell(text): return str(text).replace("|", "\\|")


def page(rows, version):
    passed = sum(row["passed"] == "yes" for row in rows)
    lines = [HEAD, f"{len(rows)} rows, {passed} passed; {version}.\n\n", "| where methods fail | figure | as it is | the other way | passed | |\n|---|---|---|---|---|---|\n"]
    for row in rows:
        ours, naive = row["values"]
        picture = f"![picture]({PICTURES.name}/{row['drawn']})" if "drawn" in row else "-"
        lines.append(f"| {cell(row['title'])} (`{cell(row['test'])}`) | {cell(row['figure'])} | **{cell(ours)}**; {cell(row['ours'])} | {cell(naive)}; {cell(row['naive'])} | {row['passed']} "
                     f"| {picture} |\n")
    return "".join(lines)


def main():
    program = os.environ.setdefault("MORTISE", str(ROOT / "bin" / "mortise"))
    rows, began = Rows(), time.time()
    if len(sys.argv) == 1:
        shutil.rmtree(PICTURES, ignore_errors=True)
        PICTURES.mkdir()
        os.environ["MORTISE_STABILITY_PICTURES"] = str(PICTURES)
    status = pytest.main(["-c", str(ROOT / "tests" / "pytest.ini"), "--rootdir", str(ROOT / "tests"), "-q", "--durations=5", *sys.argv[1:], str(HERE)], plugins=[rows])
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    if len(sys.argv) == 1:
        PAGE.write_text(page(rows.rows, version))
        print(f"{PAGE.relative_to(ROOT)}: {len(rows.rows)} rows in {time.time() - began:.0f} s")
    else:
        print(page(rows.rows, version))
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
