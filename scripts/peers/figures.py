#!/usr/bin/env python3
"""Tables and charts of docs/charts/peers.csv: error of the scene's quantity against seconds and unknowns, time to a given error, this program beside the best peer.

    scripts/peers/figures.py

Writes docs/charts/peers_<scene>_{seconds,unknowns}.png and the tables between the marks of README.md and docs/peers.md."""
import csv
import json
import pathlib
import sys
import textwrap

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
from measure import plain_seconds  # noqa: E402

CHARTS = ROOT / "docs" / "charts"
CSV = CHARTS / "peers.csv"
REFERENCES = json.loads((ROOT / "docs" / "references.json").read_text())
COLUMNS = ("scene", "code", "version", "series", "options", "status", "unknowns", "value", "error", "seconds", "runs", "memory", "iterations", "steps", "load", "date")
NAMES = {"mortise": "mortise", "ngsolve": "NGSolve", "getfem": "GetFEM", "calculix": "CalculiX", "kratos": "Kratos"}
COLOURS = {"mortise": "tab:red", "ngsolve": "tab:blue", "getfem": "tab:green", "calculix": "tab:purple", "kratos": "tab:brown"}
MARKERS = "osv^DPX*<>"
ERRORS = (1e-2, 1e-3, 1e-4, 1e-5)  # columns of the tables


def reference(scene, code="mortise"):
    """The value a code is held against: that of its own law where it has another one."""
    entry = REFERENCES[scene]
    return entry.get("other_law", {}).get(code, {}).get("value", entry["value"])


def certain(scene):
    """The smallest error that is charted: three times the difference of the two ways to the reference."""
    first, second = (way["value"] for way in REFERENCES[scene]["ways"])
    return 3 * abs(first / second - 1) if second else 0.0


def error(scene, code, value):
    """Relative; a scene whose value is an error already has the reference 0."""
    wanted = reference(scene, code)
    return abs(value / wanted - 1) if wanted else abs(value)


def read(path):
    """Rows of a csv, numbers as they stand there, errors against docs/references.json."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:  # references may have moved since
        row["error"] = f"{error(row['scene'], row['code'], float(row['value'])):.3g}" if row["value"] else ""
    return rows


def write(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, restval="", extrasaction="ignore", lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def answered(rows):
    return [row for row in rows if row["error"] not in ("", None)]


def series(rows, scene):
    """{(code, series): rows with an answer}, coarse to fine."""
    found = {}
    for row in answered(rows):
        if row["scene"] == scene:
            found.setdefault((row["code"], row["series"]), []).append(row)
    return found


def reached(rows, wanted):
    """The first row of a series from which on the error stays below: a mesh that meets the value in passing does not count."""
    return next((row for k, row in enumerate(rows) if all(float(later["error"]) <= wanted for later in rows[k:])), None)


def decisive(rows, scene):
    """Rows that a code reaches an error of the tables with, its fastest and those within a quarter of it."""
    found = []
    for code in NAMES:
        for wanted in ERRORS:
            first = [row for (own, _), mine in series(rows, scene).items() if own == code and (row := reached(mine, wanted))]
            limit = 1.25 * min((float(row["seconds"]) for row in first), default=0)
            found += [row for row in first if float(row["seconds"]) <= limit and row not in found]
    return found


def best(rows, scene, wanted, own):
    """(seconds, code) of the fastest series, of this program or of the others."""
    rows = [(row, code) for (code, _), mine in series(rows, scene).items() if (code == "mortise") == own and (row := reached(mine, wanted))]
    return min(((float(row["seconds"]), code) for row, code in rows), default=None)


def cell(rows, scene, wanted):
    """'0.21 / 0.46 NGSolve', bold where a peer is the faster."""
    if wanted < certain(scene):
        return "·"
    own, other = best(rows, scene, wanted, True), best(rows, scene, wanted, False)
    left = f"{own[0]:.2g}" if own else "–"
    right = f"{other[0]:.2g} {NAMES[other[1]]}" if other else "–"
    text = f"{left} / {right}"
    return f"**{text}**" if other and (not own or other[0] < own[0]) else text


def power(value):
    return f"{value:.0e}".replace("e-0", "e-")


def front_table(rows):
    """Seconds to an error, this program / the best peer."""
    lines = ["| seconds to an error of | " + " | ".join(map(power, ERRORS)) + " |\n", "|---" * (len(ERRORS) + 1) + "|\n"]
    for scene, entry in REFERENCES.items():
        if series(rows, scene):
            lines.append(f"| {entry['title']} | " + " | ".join(cell(rows, scene, wanted) for wanted in ERRORS) + " |\n")
    return "".join(lines)


def smallest(rows, scene, code):
    """The row of a code with the smallest error that counts, the fastest of equals."""
    mine = [row for row in answered(rows) if row["scene"] == scene and row["code"] == code]
    return min(mine, key=lambda row: (max(float(row["error"]), certain(scene)), float(row["seconds"])), default=None)


def code_table(rows):
    """What each code reached: its smallest error, what that took, and how many runs gave no answer."""
    lines = ["| scene | code | smallest error | seconds | MB | unknowns | settings | no answer |\n", "|---|---|---|---|---|---|---|---|\n"]
    for scene in REFERENCES:
        for code in NAMES:
            mine = [row for row in rows if row["scene"] == scene and row["code"] == code]
            if not mine:
                continue
            row, failed = smallest(rows, scene, code), sum(row["status"] != "ok" for row in mine)
            found = f"{max(float(row['error']), certain(scene)):.1e} | {float(row['seconds']):.2g} | {row['memory']} | {row['unknowns']} | {row['series']}" if row else "– | – | – | – | –"
            lines.append(f"| {scene} | {NAMES[code]} | {found} | {failed} of {len(mine)} |\n")
    return "".join(lines)


def reference_table():
    lines = ["| scene | quantity | first way | second way | smallest error charted |\n", "|---|---|---|---|---|\n"]
    for scene, entry in REFERENCES.items():
        ways = " | ".join(f"{way['value']:.9g}: {way['how']}" for way in entry["ways"])
        lines.append(f"| {scene}: {entry['title']} | {entry['quantity']} | {ways} | {certain(scene):.1e} |\n")
    return "".join(lines)


def versions(rows):
    found = {}
    for row in rows:
        found.setdefault(row["code"], set()).add(row["version"])
    dates = sorted({row["date"] for row in rows})
    if not rows: return "\n"
    words = "; ".join(f"{NAMES[code]} {', '.join(sorted(v))}" for code, v in found.items()) + f"; {' to '.join(sorted({dates[0], dates[-1]}))}."
    return textwrap.fill(words, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def insert(text, mark, table):
    """The text with what stands between <!-- mark --> and <!-- /mark --> replaced."""
    head, rest = text.split(f"<!-- {mark} -->\n")
    return f"{head}<!-- {mark} -->\n{table}<!-- /{mark} -->{rest.split(f'<!-- /{mark} -->')[1]}"


def charted(rows, scene):
    """{(code, series): errors}: none below what the reference is good for."""
    return {key: [max(float(row["error"]), certain(scene)) for row in mine] for key, mine in series(rows, scene).items()}


def draw(rows, scene, x, label):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(9.2, 5), dpi=100)
    count, errors = {}, charted(rows, scene)
    for (code, name), mine in series(rows, scene).items():
        marker = MARKERS[count.setdefault(code, 0) % len(MARKERS)]
        count[code] += 1
        axes.loglog([float(row[x]) for row in mine], errors[code, name], color=COLOURS[code], marker=marker, markersize=4,
                    linewidth=1.6 if code == "mortise" else 0.7, zorder=3 if code == "mortise" else 2, label=f"{NAMES[code]}: {name}")
    entry = REFERENCES[scene]
    largest = max(float(row["error"]) for mine in series(rows, scene).values() for row in mine)
    axes.set(xlabel=label, ylabel=f"relative error: {entry['quantity']}", title=entry["title"], ylim=(max(certain(scene), 1e-6) / 1.3, 1.5 * min(largest, 1)))
    axes.grid(True, which="both", color="0.92")
    if x == "seconds":
        plain_seconds(axes)
    axes.legend(fontsize=5.5, handlelength=2.5, loc="upper left", bbox_to_anchor=(1.01, 1))
    figure.tight_layout()
    figure.savefig(CHARTS / f"peers_{scene}_{x}.png", metadata={"Software": None})
    plt.close(figure)


def main():
    rows = read(CSV)
    for scene in REFERENCES:
        if series(rows, scene):
            draw(rows, scene, "seconds", "processor time of the whole process / s")
            draw(rows, scene, "unknowns", "unknowns")
    for name, tables in (("README.md", {"peers": front_table(rows)}),
                         ("docs/peers.md", {"versions": versions(rows), "peers": front_table(rows), "references": reference_table(), "codes": code_table(rows)})):
        path = ROOT / name
        text = path.read_text()
        for mark, table in tables.items():
            text = insert(text, mark, table)
        path.write_text(text)


if __name__ == "__main__":
    main()
