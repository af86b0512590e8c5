#!/usr/bin/env python3
"""What a run has committed is found again, whatever ends it: a table of kills, signals, full disks and rival runs.

Usage: nothing_lost.py WEFT [--kills N] [--signals N] [--disks N] [--rivals N] [--csv FILE]
"Committed" is what another process saw in the recording before the end; "found" is what `weft info` finds afterwards,
which checks every frame. Fails if anything committed is not found, or if a later run removes it.
With --csv all rows go to one file: bench/results/nothing_lost.csv is that of the numbers that are the default.
"""
import argparse
import csv
import os
import random
import re
import resource
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SCENE = """schema = "weft-scene/1"
name = "small"
summary = "Shows a small cloth that hangs, with a frame for every step"
[world]
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
time_step = "1/500 s"
duration = "1000 s"
frame_interval = "1/500 s"
[[cloth]]
name = "cloth"
grid = { nodes = [9, 9], size = ["1 m", "1 m"], stencil = "24-neighbour" }
center = ["0 m", "1 m", "0 m"]
u_axis = [1, 0, 0]
v_axis = [0, 0, -1]
areal_density = "250 g/m^2"
collision_margin = "1 cm"
friction = 0.3
pin = [{ corner = "-u-v" }, { corner = "+u-v" }]
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
edge_sets = ["stretch", "shear", "bend"]
stiffness = "60 N/m"
[[cloth.law]]
law = "spring_damping"
edge_sets = ["stretch", "shear", "bend"]
damping = "0.002 N*s/m"
"""
KEPT = re.compile(r"; (\d+) frames up to t = \S+ s are kept in (\S+)")
ACCEPTED_DELAY = 60  # seconds for what takes a moment on an idle machine

COLUMNS = ("experiment", "case", "committed", "found", "exit", "said", "the next command says")

weft = ""
faults = []
rows = []


def expect(condition, what):
    if not condition:
        faults.append(what)
        print(f"FAILED: {what}", flush=True)
    return condition


def start(folder, *options, output="x.weftrec", limit=None):
    def prepare():
        # A shell in the background, and nohup, leave their children deaf to them.
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.Popen(
        [weft, "run", str(folder.parent / "small.toml"), "-e", "reference", "-j", "1", "-o", output, *options],
        cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=prepare)


def committed(path):
    """Frames that another process sees; None if there is no recording yet."""
    if not path.exists():
        return None
    try:
        database = sqlite3.connect(f"file:{path}?mode=ro", uri=True, timeout=5)
        try:
            return database.execute("SELECT count(*) FROM frame").fetchone()[0]
        finally:
            database.close()
    except sqlite3.Error:
        return None


def found(path):
    """Frames in a recording that weft finds sound; -1 if it does not."""
    told = subprocess.run([weft, "info", str(path)], capture_output=True, text=True)
    frames = re.search(r"^  (\d+) frames, ", told.stdout, re.MULTILINE)
    if told.returncode != 0:
        print(told.stderr, end="")
        return -1
    return int(frames[1]) if frames else 0


def wait_for(condition, process):
    begin = time.monotonic()
    while not condition() and process.poll() is None and time.monotonic() - begin < ACCEPTED_DELAY:
        time.sleep(0.002)


def next_command(folder, partial, frames, what):
    """The same command again: it says that the partial recording is there, and leaves it as it is."""
    process = start(folder, "--duration", "0.1 s")
    _, said = process.communicate()
    expect(process.returncode == 0, f"{what}: the next run: exit {process.returncode}, {said}")
    if frames is not None:
        expect(f"{partial.name}: left by an earlier run that did not end, is kept" in said, f"{what}: next run: {said}")
        expect(found(partial) == frames, f"{what}: the next run changed {partial.name}")
    return brief(said)


def brief(said):
    """The last line of what a run says, without what is the same in every message or another one each time."""
    lines = said.strip().splitlines()
    return re.sub(r"process \d+", "process N", lines[-1].removeprefix("weft: ")) if lines else "nothing"


class Table:
    def __init__(self, experiment, title):
        self.experiment, self.title, self.rows = experiment, title, []

    def add(self, case, committed, found, code, said, next_said=""):
        """What was committed and found: frames, None where there was no recording yet."""
        frames = ["none" if number is None else number for number in (committed, found)]
        self.rows.append((self.experiment, case, *frames, code, said, next_said))

    def show(self):
        print(f"\n{self.title}")
        for row in (COLUMNS, *self.rows):
            print(" | ".join(str(cell) for cell in row[1:]))
        rows.extend(self.rows)
        sys.stdout.flush()


def kill_at_random(work, count, chooser):
    table, total = Table("kill -9", f"kill -9 at {count} random moments"), [0, 0, 0]
    for number in range(count):
        folder = work / f"kill{number}"
        folder.mkdir()
        partial = folder / "x.partial.weftrec"
        process = start(folder)
        if number % 4:  # three of four with frames, one while it starts
            wait_for(lambda: committed(partial), process)
            time.sleep(chooser.uniform(0, 0.5))
        else:
            time.sleep(chooser.uniform(0, 0.1))
        before = committed(partial)
        process.kill()
        process.communicate()
        expect(before is not None or number % 4 == 0, f"kill {number}: no {partial.name} to be read")
        after = found(partial) if before is not None else None
        expect(before is None or after >= before, f"kill {number}: committed {before}, found {after}")
        expect(not (folder / "x.weftrec").exists(), f"kill {number}: a finished recording")
        said = next_command(folder, partial, after, f"kill {number}")
        table.add(number, before, after, -signal.SIGKILL, "nothing", said)
        total = [total[0] + 1, total[1] + (before or 0), total[2] + (after or 0)]
    table.show()
    print(f"{total[0]} kills: {total[1]} frames committed, {total[2]} found")


def signals(work, count, chooser):
    table = Table("signal", f"{count} signals")
    for number in range(count):
        which = [signal.SIGINT, signal.SIGINT, signal.SIGTERM, signal.SIGHUP][number % 4] if count < 20 else signal.SIGINT
        folder = work / f"signal{number}"
        folder.mkdir()
        partial = folder / "x.partial.weftrec"
        process = start(folder)
        wait_for(lambda: committed(partial), process)
        time.sleep(chooser.uniform(0, 0.5))
        before = committed(partial) or 0
        expect(partial.exists(), f"signal {number}: no {partial.name}")
        process.send_signal(which)
        _, said = process.communicate()
        kept = KEPT.search(said)
        after = found(partial)
        expect(process.returncode == 128 + which, f"signal {number}: exit {process.returncode}: {said}")
        expect(kept and int(kept[1]) == after >= before, f"signal {number}: {before}, {after}, {said}")
        expect(not (folder / "x.weftrec.lock").exists(), f"signal {number}: the lock is left")
        next_said = next_command(folder, partial, after, f"signal {number}")
        table.add(f"{number} {which.name}", before, after, process.returncode, brief(said), next_said)
    table.show()


def full_disk(work, count):
    table = Table("full disk", f"full disk, {count} sizes")
    for number in range(count):
        kilobytes = [8, 40, 100, 160, 250, 400, 700, 1200, 2500, 5000][number * 10 // count]
        for kind in ("limit", "disk"):
            folder = work / f"full{number}{kind}"
            folder.mkdir()
            if kind == "disk":
                mounted = os.geteuid() == 0 and subprocess.run(
                    ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(folder)],
                    capture_output=True).returncode == 0
                if not mounted:
                    table.add(f"{kilobytes} kB, {kind}", None, None, "", "no right to mount")
                    continue
            try:
                run_until_full(table, kind, kilobytes, folder)
            finally:
                if kind == "disk":
                    subprocess.run(["umount", str(folder)], check=True)
    table.show()


def run_until_full(table, kind, kilobytes, folder):
    what = f"{kilobytes} kB {kind}"
    partial = folder / "x.partial.weftrec"
    process = start(folder, limit=1024 * kilobytes if kind == "limit" else None)
    before = 0
    begin = time.monotonic()
    while process.poll() is None and time.monotonic() - begin < 5 * ACCEPTED_DELAY:
        before = max(before, committed(partial) or 0)
        time.sleep(0.005)
    _, said = process.communicate()
    kept = KEPT.search(said)
    expect(process.returncode == 2, f"{what}: exit {process.returncode}: {said}")
    after = found(partial) if kept else 0
    expect(after >= before, f"{what}: committed {before}, found {after}: {said}")
    expect(not kept or int(kept[1]) == after, f"{what}: found {after}: {said}")
    expect(kept or not partial.exists(), f"{what}: {partial.name} without frames is left")
    next_said = ""
    if kind == "limit":  # a full disk has no room for another run
        next_said = next_command(folder, partial, after if kept else None, what)
    table.add(f"{kilobytes} kB, {kind}", before, after, process.returncode, brief(said), next_said)


def rivals(work, count):
    table = Table("two runs", f"two runs with one output, {count} staggerings")
    for number in range(count):
        folder = work / f"rivals{number}"
        folder.mkdir()
        delay = [0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.4, 0.8, 1.5][number * 10 // count]
        force = ["--force"] if number % 2 else []
        runs = [start(folder, "--duration", "4 s", *force)]
        time.sleep(delay)
        runs.append(start(folder, "--duration", "2 s", *force))
        said = [run.communicate()[1] for run in runs]
        codes = [run.returncode for run in runs]
        frames = found(folder / "x.weftrec")
        winners = [i for i in (0, 1) if codes[i] == 0]
        what = f"rivals {number}: exits {codes}: {said}"
        expect(winners, what)
        expect(frames in [(2001, 1001)[i] for i in winners], f"{what}, {frames} frames")
        for i in set((0, 1)) - set(winners):
            expect(codes[i] == 2 and len(said[i].strip().splitlines()) == 1, what)
            expect("is being written by another run" in said[i] or "exists already" in said[i], what)
        expect(sorted(p.name for p in folder.iterdir()) == ["x.weftrec"], f"{what}: {list(folder.iterdir())}")
        next_said = brief(start(folder, "--duration", "0.1 s").communicate()[1])
        expect("x.weftrec: exists already" in next_said, f"{what}, then {next_said}")
        expect(found(folder / "x.weftrec") == frames, f"{what}: the next run changed the recording")
        whole = (2001, 1001)[winners[-1]] if winners else None
        case = f"{delay} s apart{', --force' if force else ''}"
        table.add(case, whole, frames, f"{codes[0]} and {codes[1]}", " / ".join(map(brief, said)), next_said)
    table.show()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("weft")
    for name, number in (("kills", 100), ("signals", 20), ("disks", 10), ("rivals", 10)):
        parser.add_argument(f"--{name}", type=int, default=number)
    parser.add_argument("--csv")
    options = parser.parse_args()
    global weft
    weft = os.path.abspath(options.weft)
    chooser = random.Random(1)
    with tempfile.TemporaryDirectory(prefix="weft_nothing_lost_") as folder:
        work = Path(folder)
        (work / "small.toml").write_text(SCENE, encoding="utf-8")
        kill_at_random(work, options.kills, chooser)
        signals(work, options.signals, chooser)
        full_disk(work, options.disks)
        rivals(work, options.rivals)
    if options.csv:
        with open(options.csv, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows((COLUMNS, *rows))
    print(f"{len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
