#!/usr/bin/env python3
"""Runs every scene of the catalog in every engine and both precisions and writes the content hash of each recording.

Two such tables from before and after a change that should not move a number must be equal:

    tools/content_hashes.py build/before/bin/weft before.csv
    tools/content_hashes.py build/release/bin/weft after.csv --compare before.csv
"""
import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BULLET_ENGINES = ("bullet_weft", "bullet_forces", "bullet_soft", "bullet_deformable", "bullet_deformable_implicit")
COLUMNS = ("scene", "engine", "precision", "time_step", "duration", "result")


def scenes_of(weft):
    """The names that `weft list` prints below "Scenes:"."""
    text = subprocess.run([weft, "list"], capture_output=True, text=True, check=True).stdout
    block = text.split("Scenes:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in block.splitlines() if line.strip()]


def result_of(weft, scene, engine, precision, time_step, duration, seconds):
    """The hash of the run's recording, or why there is none: not made for the scene, or not done in time.

    Ends the program for any other error, because two tables of errors would be equal.
    """
    with tempfile.TemporaryDirectory() as folder:
        recording = str(Path(folder) / "run.weftrec")
        command = [weft, "run", scene, "--engine", engine, "--precision", precision, "--output", recording]
        if time_step:
            command += ["--time-step", time_step]
        if duration:
            command += ["--duration", duration]
        try:
            run = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return f"not done after {seconds} s"
        is_refused = "is not made for it" in run.stderr or "expected a whole number of" in run.stderr
        if run.returncode == 2 and is_refused:
            return "refused"
        match = re.search(r"content hash ([0-9a-f]{32})\b", run.stdout)
        if not match or run.returncode not in (0, 1):
            sys.exit(f"{' '.join(command)}: no hash, exit status {run.returncode}: {run.stderr.strip()}")
        return f"{match[1]}{' blew up' if run.returncode else ''}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("weft", help="the command; weft-float64 stands beside it")
    parser.add_argument("table", help="CSV file to write")
    parser.add_argument("--duration", default="0.3 s", help='simulated time of each run (default "0.3 s"); "" for the scene\'s own')
    parser.add_argument("--seconds", type=int, default=300, help="wall time that a run may take (default 300 s)")
    parser.add_argument("--compare", metavar="CSV", help="a table of before: exit with 1 unless all rows are equal")
    arguments = parser.parse_args()
    precisions = ("float32", "float64")
    # The implicit solver at a large step too, which is where its iterations work.
    runs = [("reference", "float64", "")] + [(engine, precision, "") for engine in BULLET_ENGINES for precision in precisions]
    runs += [("bullet_weft", precision, "1/50 s") for precision in precisions]
    jobs = [(scene, *run) for scene in scenes_of(arguments.weft) for run in runs]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda job: result_of(arguments.weft, *job, arguments.duration, arguments.seconds), jobs))
    rows = [[*job, arguments.duration or "the scene's", result] for job, result in zip(jobs, results)]
    with open(arguments.table, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([COLUMNS, *rows])
    print(f"{len(rows)} runs: {arguments.table}")
    if arguments.compare:
        with open(arguments.compare, newline="", encoding="utf-8") as file:
            before = list(csv.reader(file))[1:]
        differing = [(now, then) for now, then in zip(rows, before) if now != then]
        for now, then in differing:
            print(f"{' '.join(now[:4])}: {now[5]}, before {then[5]}")
        if differing or len(rows) != len(before):
            sys.exit(f"{len(differing)} of {len(rows)} rows differ")
        print("all rows are equal")


if __name__ == "__main__":
    main()
