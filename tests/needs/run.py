#!/usr/bin/env python3
"""Check what section `needs` of summary.json promises: scenes of inputs/ and eight made for it, each with and without every part that it says is not needed.

    tests/needs/run.py [--times N] [--write] [SCENE...]

Prints a row for each promise; --write: docs/needs.md. Runs of both in turn, at most N (default 16) until the least processor time, which counts, was met twice."""
import argparse
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import simpler  # noqa: E402

INPUTS = "hertz2d rubber2d cook tube cylinder oring sphere balloon slide2d roller shrinkfit3d".split()
MADE = "bracket bush plate tissue stops layer beam wheel".split()
HEAD = """# No more model than needed

At its end a run says what it could have left out of its model within the tolerance, what that would change and what
it would save ([how to](howto.md#model-no-more-than-needed), [theory](theory.md#no-more-model-than-needed)). Here each
such promise is checked by running the simpler model: `make needs` does it and writes this page.

Change: the largest relative change of the energy norm and of the forces of supports and contact pairs (cells, order:
the estimated error). It holds where it is within a factor of 3 of what was told or below a tenth of the tolerance, and
within the tolerance. Saving: share of the processor time, without the start of the process, the mesh made beforehand;
the least of runs of both in turn, repeated until it was met twice to a quarter of the saving told (16 runs at most). It
holds within a factor of 2.

"""


def folder(name): return ROOT / ("tests/needs" if name in MADE else "inputs")


def holds(row, change, tolerance): return change is not None and change <= tolerance and (change <= 0.1 * tolerance or row["change"] / 3 <= change <= 3 * row["change"])


def saved(row, share): return share is not None and (row["saves"] / 2 <= share <= 2 * row["saves"])


def promises(name, scratch, times, only=None):
    """(tolerance, part, name, row, change, share saved) of each promise of a scene."""
    where = pathlib.Path(scratch) / name
    scene = simpler.meshed(simpler.read(folder(name) / f"{name}.yml"), where, "mesh")
    base, idle = simpler.run(scene, where, "whole"), simpler.start()
    assert base.solved, base.text
    for part, of, row in base.rows():
        if not row["keeps"] or (only and part not in only): continue
        change, share, _ = simpler.check(scene, base, part, row, where, f"{part}_{of}", times, idle)
        yield base.summary["needs"]["tolerance"], part, of, row, change, share


def line(name, tolerance, part, of, row, change, share):
    cells = [name, f"{tolerance:.2g}", part, of, f"{row['change']:.1e}", "not solved" if change is None else f"{change:.1e}",
             "yes" if holds(row, change, tolerance) else "**no**", f"{100 * row['saves']:.0f} %", "" if share is None else f"{100 * share:.0f} %", "yes" if saved(row, share) else "**no**"]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scene", nargs="*")
    parser.add_argument("--times", type=int, default=16)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    lines = ["| scene | tolerance | part | of | change told | was | holds | saving told | was | holds |", "|---|---|---|---|---|---|---|---|---|---|"]
    print("\n".join(lines))
    with tempfile.TemporaryDirectory() as scratch:
        for name in args.scene or INPUTS + MADE:
            for row in promises(name, scratch, args.times):
                lines.append(line(name, *row))
                print(lines[-1], flush=True)
    rows = lines[2:]
    columns = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    total = (f"{len(rows)} promises in {len({c[0] for c in columns})} scenes; changes hold in {sum(c[6] == 'yes' for c in columns)}, savings within a factor of 2 in "
             f"{sum(c[9] == 'yes' for c in columns)}.")
    print(total)
    if args.write: (ROOT / "docs/needs.md").write_text(HEAD + total + "\n\n" + "\n".join(lines) + "\n")


if __name__ == "__main__": main()
