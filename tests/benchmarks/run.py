#!/usr/bin/env python3
"""Run the public problems of test_benchmarks.py and write docs/benchmarks.md. Arguments are pytest's; with any, the table goes to the screen alone."""
import os
import pathlib
import subprocess
import sys

import pytest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PAGE = ROOT / "docs" / "benchmarks.md"
HEAD = """# Public problems

Problems with published numbers, from validation manuals and papers: what the program finds, the target, and the
tolerance that a test of `tests/benchmarks` asserts (of the target, or absolute: ±). `make benchmarks` runs them and
writes this page. Seconds are those of one process without the mesh generator, on the machine that made the page;
"published": steps and iterations of the source, where it tells them.

"""


class Rows:
    def __init__(self): self.rows = []

    def pytest_runtest_logreport(self, report):
        if report.when != "call": return
        for name, row in report.user_properties:
            if name == "benchmark": self.rows.append({**row, "passed": "yes" if report.passed else f"**no**: {getattr(report, 'wasxfail', 'the test fails')}"})


def number(x): return f"{x:.6g}"


def page(rows, version):
    lines = [HEAD, f"{len(rows)} problems, {sum(row['passed'] == 'yes' for row in rows)} passed; {version}.\n\n",
             "| problem | figure: found, target, tolerance | unknowns | steps | Newton | seconds | published | passed |\n|---|---|---|---|---|---|---|---|\n"]
    for row in rows:
        figures = "<br>".join(f"{name}: **{number(value)}**, {number(target)}, {'±' + number(tolerance[0]) if isinstance(tolerance, (tuple, list)) else f'{100 * tolerance:g} %'}"
                              for name, value, target, tolerance in row["rows"])
        lines.append(f"| {row['problem']} ({row['source']}) | {figures} | {row['unknowns']} | {row['steps']} | {row['newton']} | {row['seconds']:.2g} | {row['published']} | {row['passed']} |\n")
    return "".join(lines)


def main():
    program = os.environ.setdefault("MORTISE", str(ROOT / "bin" / "mortise"))
    rows = Rows()
    status = pytest.main(["-c", str(ROOT / "tests" / "pytest.ini"), "--rootdir", str(ROOT / "tests"), "-q", "--durations=5", *sys.argv[1:], str(HERE)], plugins=[rows])
    text = page(rows.rows, subprocess.run([program, "--version"], capture_output=True, text=True).stdout.split("\n")[0])
    if len(sys.argv) > 1: print(text)
    else: PAGE.write_text(text)
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
