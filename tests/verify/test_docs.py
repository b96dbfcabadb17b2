"""What docs/cases.md says of the tests is so: cases that are cited are defined, those that are defined are cited, and the tests it names exist."""
import re

from conftest import ROOT

CASES = ROOT / "docs" / "cases.md"
TEXT = CASES.read_text()
DEFINED = re.findall(r"^\*\*(O-\d+) ", TEXT, re.M)
SOURCES = [file for folder in ("src", "include", "tests", "docs", "inputs", "scripts") for file in (ROOT / folder).rglob("*")
           if file.is_file() and file != CASES and file.name != "test_docs.py" and file.suffix not in (".png", ".pyc")] + [ROOT / "README.md"]


def cited():
    return {case for file in SOURCES for case in re.findall(r"\bO-\d+", file.read_text())}


def test_cases_are_defined_once_and_in_order():
    numbers = [int(case[2:]) for case in DEFINED]
    assert numbers == sorted(set(numbers)) and len(numbers) > 50


def test_every_case_cited_is_defined_and_every_one_defined_is_cited():
    assert cited() == set(DEFINED)


def test_every_case_has_tests_that_exist():
    entries = dict(zip(DEFINED, re.split(r"^\*\*O-\d+ .*$", TEXT, flags=re.M)[1:]))
    missing = []
    for case, entry in entries.items():
        tests = re.findall(r"`(test_\w+\.(?:py|c))::(\w+)`", entry)
        missing += [case] * (not tests)
        for file, name in tests:
            found = [path for folder in ("unit", "verify") for path in (ROOT / "tests" / folder).glob(file)]
            start = rf"^def {name}\(" if file.endswith(".py") else rf"^static void {name}\(void"
            missing += [f"{case}: {file}::{name}"] * (not found or not re.search(start, found[0].read_text(), re.M))
    assert not missing, missing


def test_lines_are_short():
    assert max(map(len, TEXT.splitlines())) < 120
