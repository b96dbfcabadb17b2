"""scripts/peers without the peers: rows of a csv become times to an error, tables and charts; references have two ways; a run is measured whole; the sweep is sound."""
import json
import pathlib
import sys

import pytest

from conftest import module

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts" / "peers"))
import figures  # noqa: E402
import sweep  # noqa: E402

peers = module("peers", ROOT / "scripts" / "peers" / "run.py")


def row(code, series, error, seconds, unknowns=100, scene="cook", status="ok"):
    value = "" if error is None else figures.reference(scene, code) * (1 + error)
    return {"scene": scene, "code": code, "series": series, "options": f"{unknowns}", "status": status, "unknowns": str(unknowns), "value": str(value), "seconds": str(seconds),
            "memory": "50", "version": "1", "date": "2000-01-01", "error": "" if error is None else str(abs(error))}


ROWS = [
    row("mortise", "a", 5e-2, 0.1), row("mortise", "a", 5e-3, 0.2, 200), row("mortise", "a", -5e-4, 0.4, 400),
    row("getfem", "lucky", 1e-7, 0.05), row("getfem", "lucky", 2e-3, 0.6, 200),  # meets the value in passing
    row("ngsolve", "b", 8e-3, 0.3), row("ngsolve", "b", 5e-4, 0.35, 200), row("kratos", "c", None, 1, status="no answer"),
]


def test_time_to_an_error():
    """An error that later rows of the series leave again is not reached; failures are no rows of a series."""
    assert figures.best(ROWS, "cook", 1e-2, True) == (0.2, "mortise")
    assert figures.best(ROWS, "cook", 1e-2, False) == (0.05, "getfem")
    assert figures.best(ROWS, "cook", 1e-3, False) == (0.35, "ngsolve")
    assert figures.best(ROWS, "cook", 1e-4, True) is None
    assert figures.cell(ROWS, "cook", 1e-3) == "**0.4 / 0.35 NGSolve**"
    assert figures.cell(ROWS, "cook", figures.certain("cook") / 2) == "·"
    assert ("kratos", "c") not in figures.series(ROWS, "cook")


def test_decisive():
    """Rows worth a second run: those that a code's times in the table come from."""
    kept = [(r["code"], r["seconds"]) for r in figures.decisive(ROWS, "cook")]
    assert kept == [("mortise", "0.2"), ("mortise", "0.4"), ("ngsolve", "0.3"), ("ngsolve", "0.35"), ("getfem", "0.05")]


def test_csv_tables_and_charts(tmp_path, monkeypatch):
    figures.write(tmp_path / "rows.csv", ROWS)
    rows = figures.read(tmp_path / "rows.csv")
    assert [float(r["error"] or -1) for r in rows] == pytest.approx([float(r["error"] or -1) for r in ROWS], rel=1e-2, abs=1e-9)
    assert figures.front_table(rows).count("\n") == 3 and "| 1 of 1 |" in figures.code_table(rows)
    assert figures.insert("x\n<!-- m -->\nold\n<!-- /m -->\ny", "m", "new\n") == "x\n<!-- m -->\nnew\n<!-- /m -->\ny"
    monkeypatch.setattr(figures, "CHARTS", tmp_path)
    figures.draw(rows, "cook", "seconds", "s")
    assert (tmp_path / "peers_cook_seconds.png").stat().st_size > 1000


def test_pages_are_those_of_the_csv():
    """The front page and docs/peers.md hold what figures.py makes of the csv."""
    rows = figures.read(figures.CSV)
    assert figures.front_table(rows) in (ROOT / "README.md").read_text()
    page = (ROOT / "docs" / "peers.md").read_text()
    for table in (figures.front_table(rows), figures.code_table(rows), figures.reference_table()):
        assert table in page


@pytest.mark.parametrize("scene", sweep.SCENES)
def test_references_have_two_ways(scene):
    """Of two codes, or a code and a closed form, that differ by a third of the smallest error in chart and tables at most, and by little enough for the column of 1e-3."""
    first, second = figures.REFERENCES[scene]["ways"]
    assert first["code"] != second["code"] and figures.REFERENCES[scene]["value"] in (0, first["value"])  # 0: an error itself
    rows = figures.read(figures.CSV)
    smallest = min(error for errors in figures.charted(rows, scene).values() for error in errors)
    assert 0 < abs(first["value"] / second["value"] - 1) <= smallest / 3 * (1 + 1e-9) and figures.certain(scene) < 1e-3
    told = [float(line.split("|")[3]) for line in figures.code_table(rows).splitlines() if line.startswith(f"| {scene} ") and "–" not in line]
    assert told and min(told) >= 0.95 * figures.certain(scene)  # two digits
    assert all(figures.cell(rows, scene, wanted) == "·" for wanted in figures.ERRORS if wanted < figures.certain(scene))


def test_sweep():
    """Every scene has a reference and this program; options of a row are words; names of files exist."""
    assert set(sweep.SCENES) == set(figures.REFERENCES)
    for series in sweep.SCENES.values():
        assert any(code == "mortise" for code, _ in series) and len({code for code, _ in series}) > 1
        for (code, _), runs in series.items():
            assert all((ROOT / options[0]).exists() for options in runs if code == "mortise")


def test_a_run_is_measured_whole():
    """Time and memory of what a process starts count; a limit ends it."""
    inner = "x = bytearray(60_000_000); sum(range(6_000_000))"
    output, seconds, memory, status = peers.run([sys.executable, "-c", f"import subprocess, sys; subprocess.run([sys.executable, '-c', '{inner}']); print('done')"], 20)
    assert output == "done\n" and status == 0 and seconds > 0.05 and memory > 60
    assert peers.run([sys.executable, "-c", "while True: pass"], 1)[3] != 0


def test_this_program_is_measured(run):
    found = peers.once("hertz2d", "mortise", ["scripts/peers/half_disc.yml", "-adapt_max_passes", 20, "-adapt_tolerance", 0.01], 60)
    assert figures.error("hertz2d", "mortise", found["value"]) < 1e-4 and found["seconds"] > 0 and json.dumps(found)
