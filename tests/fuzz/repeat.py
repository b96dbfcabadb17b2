#!/usr/bin/env python3
"""Run the tests again and again beside busy processes, to find those that fail now and then.

    tests/fuzz/repeat.py [--times 20] [--busy 1] [--keep-going] [COMMAND ...]

COMMAND is `make test` unless given; it runs in the directory of the repository. --busy processes that only count keep
that many cores busy meanwhile. A line a run: seconds, what other processes than the tests used of the machine meanwhile
(in cores), the last line that the command printed. Output of runs that fail is kept in out/repeat/. Exit status 0 where
no run failed.
"""
import argparse
import os
import pathlib
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def machine():
    """Processor seconds that the machine has used since it started."""
    ticks = [int(x) for x in open("/proc/stat").readline().split()[1:9]]
    return (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK")


def children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def once(command):
    start, before, own = time.monotonic(), machine(), children()
    done = subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    seconds = time.monotonic() - start
    others = (machine() - before - (children() - own)) / seconds
    return done.returncode, seconds, others, done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--busy", type=int, default=1)
    parser.add_argument("--keep-going", action="store_true", help="do not stop at the first run that fails")
    parser.add_argument("command", nargs="*", default=["make", "test"])
    args = parser.parse_args()
    kept = ROOT / "out" / "repeat"
    kept.mkdir(parents=True, exist_ok=True)
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(args.busy)]
    failed = 0
    try:
        for run in range(1, args.times + 1):
            status, seconds, others, text = once(args.command)
            last = text.strip().splitlines()[-1] if text.strip() else ""
            print(f"{run:3d}  status {status}  {seconds:6.1f} s  beside {others:4.2f} cores  {last}", flush=True)
            if status:
                failed += 1
                (kept / f"run{run}.txt").write_text(text)
                if not args.keep_going:
                    break
    finally:
        for one in busy:
            one.kill()
    print(f"{failed} of {run} runs failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
