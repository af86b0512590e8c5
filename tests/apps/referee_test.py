#!/usr/bin/env python3
"""Results of an engine come back from other programs' files with the verdict and the figures of the engine, and spoiled ones do not.

usage: referee_test.py WEFT with|without (Bullet) [--all]

--all: every way to spoil a file that is in the lists below, not the first two of each.
"""
import array
import json
import os
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

HEADER = struct.Struct("<12siiffi")
checks, failures = 0, 0


def check(what, holds, shown=""):
    global checks, failures
    checks += 1
    if not holds:
        failures += 1
        print(f"FAILED: {what}\n{shown}")


class PointCache:
    """Samples of x y z of every point, as the file has them."""

    def __init__(self, path):
        data = Path(path).read_bytes()
        self.header = HEADER.unpack_from(data)
        self.points, count = self.header[2], self.header[5]
        values = array.array("f", data[HEADER.size:])
        size = 3 * self.points
        self.samples = [values[s * size:(s + 1) * size] for s in range(count)]

    def write(self, path, samples):
        bytes_ = HEADER.pack(*self.header[:5], len(samples)) + b"".join(sample.tobytes() for sample in samples)
        Path(path).write_bytes(bytes_)

    def write_obj_files(self, folder):
        """As Blender has it: z up, here in centimeters."""
        Path(folder).mkdir()
        for number, sample in enumerate(self.samples):
            lines = [f"v {100 * sample[i]!r} {-100 * sample[i + 2]!r} {100 * sample[i + 1]!r}\n"
                     for i in range(0, len(sample), 3)]
            Path(folder, f"cloth_{number + 1}.obj").write_text("".join(lines))


def mapped(sample, change):
    """The sample with change(x, y, z) in place of every point."""
    values = array.array("f")
    for i in range(0, len(sample), 3):
        values.extend(change(*sample[i:i + 3]))
    return values


def swapped(sample, a, b):
    values = sample[:]
    values[3 * a:3 * a + 3], values[3 * b:3 * b + 3] = sample[3 * b:3 * b + 3], sample[3 * a:3 * a + 3]
    return values


class Weft:
    def __init__(self, program):
        self.program = str(Path(program).resolve())

    def __call__(self, expected, *words):
        """Runs the command, which must end with this code; gives standard output and standard error."""
        result = subprocess.run([self.program, *words], capture_output=True, text=True)
        check(f"weft {' '.join(words)}: exit {result.returncode}, expected {expected}", result.returncode == expected,
              result.stdout[-2000:] + result.stderr)
        return result.stdout, result.stderr

    def refuses(self, what, part, *words):
        _, error = self(2, *words)
        check(f"{what}: one line with '{part}'", error.count("\n") == 1 and part in error, error)

    def judge(self, expected, *words):
        """The checks of the recording in the report, by claim and metric."""
        output, _ = self(expected, "validate", "--no-pictures", "-o", "report", *words)
        check("says what is not judged", output.count("Not judged from a recording, because ") == 3, output)
        report = json.loads(Path("report/report.json").read_text())
        return {(row["claim"], row["metric"]): row for row in report["checks"]
                if row["engine"].startswith("recording")}


def compare(name, own, again, size):
    """The same verdicts, and figures within single precision of a scene of this size [m]."""
    check(f"{name}: the same checks", own.keys() == again.keys() and len(own) > 1, f"{own.keys()} {again.keys()}")
    for key, row in own.items():
        there = again.get(key, {})
        check(f"{name}: {key}: the same verdict", row["verdict"] == there.get("verdict"), f"{row}\n{there}")
        difference = abs(float(row["measured"]) - float(there.get("measured", "nan")))
        check(f"{name}: {key}: the same figure", difference <= 2 ** -23 * size, f"{difference}")


def failed(rows):
    return {claim for (claim, _), row in rows.items() if row["verdict"] == "fail"}


def hang(weft, engine):
    run = ["run", "hang", "-e", engine, "-o", "hang.weftrec"]
    if engine != "reference":
        run += ["--time-step", "1/100 s", "--bullet-time-step"]
    weft(0, *run)
    own = weft.judge(0, "--recording", "hang.weftrec")
    weft(0, "export", "--pc2", "caches", "hang.weftrec")
    take = ["import", "hang", "--force", "-o", "theirs.weftrec", "--frame-rate"]
    output, _ = weft(0, *take, "50 Hz", "--pc2", "caches/cloth.pc2")
    check("says that the faces are checked", "faces as in the scene (caches/cloth.obj)" in output, output)
    compare("hang, PC2", own, weft.judge(0, "--recording", "theirs.weftrec"), 2)
    output, _ = weft(0, "info", "theirs.weftrec")
    for part in ("engine imported, float32", "imported_cloth: caches/cloth.pc2, 101 samples, XXH3 ",
                 "imported_velocities: central differences of positions", "imported_axes: y is up, one unit is 1 m"):
        check(f"info says '{part}'", part in output, output)

    cache = PointCache("caches/cloth.pc2")
    cache.write_obj_files("sequence")
    weft(0, "import", "hang", "-o", "objs.weftrec", "--obj-sequence", "sequence", "--frame-rate", "50 Hz", "--up", "z",
         "--unit", "1 cm")
    compare("hang, OBJ files", own, weft.judge(0, "--recording", "objs.weftrec", "hang"), 4)
    spoil_hang(weft, cache, take)


def tried(spoiled):
    """All with --all: each is judged beside a run of the reference, which takes some seconds."""
    return list(spoiled.items())[:None if "--all" in sys.argv else 2]


def spoil_hang(weft, cache, take):
    samples = cache.samples
    refused = {
        "scaled by 2 %": [mapped(sample, lambda x, y, z: (1.02 * x, 1.02 * y, 1.02 * z)) for sample in samples],
        "mirrored": [mapped(sample, lambda x, y, z: (-x, y, z)) for sample in samples],
        "two nodes swapped": [swapped(sample, 100, 200) for sample in samples],
        "one frame late": samples[1:],
        "another axis": [mapped(sample, lambda x, y, z: (x, -z, y)) for sample in samples],
    }
    for name, spoiled in tried(refused):
        cache.write("spoiled.pc2", spoiled)
        weft.refuses(name, "spoiled.pc2: the first sample of body 'cloth' is up to ", *take, "50 Hz", "--pc2",
                     "spoiled.pc2")
        # Whoever takes it in nonetheless does not get it past the judge.
        weft(0, *take, "50 Hz", "--pc2", "spoiled.pc2", "--other-start", "a test")
        rows = weft.judge(1, "--recording", "theirs.weftrec")
        check(f"{name}: the start fails", "starts where the scene starts" in failed(rows), str(rows))
    failing = {
        "frozen": [samples[0]] * len(samples),
        "twice as fast": samples[::2],
        "three frames late after the right start": samples[:1] + samples[3:],
        "mirrored after the right start": samples[:1] + refused["mirrored"][1:],
        "cut off after 0.3 s": samples[:16],
    }
    for name, spoiled in tried(failing):
        cache.write("spoiled.pc2", spoiled)
        weft(0, *take, "50 Hz", "--pc2", "spoiled.pc2")
        rows = weft.judge(1, "--recording", "theirs.weftrec")
        check(f"{name}: the motion fails", failed(rows) == {"stays near the reference"}, str(rows))
    output, _ = weft(0, *take, "25 Hz", "--pc2", "caches/cloth.pc2")
    check("another rate: says so", "weft validate --recording needs frames 0.02 s apart" in output, output)
    weft.refuses("another rate", "theirs.weftrec: frame 1, t = 0.04 s: expected t = 0.02 s", "validate", "--recording",
                 "theirs.weftrec", "-o", "report")


def free_ball(weft, engine):
    """A body that moves freely comes back from its points, and bounds of contact hold."""
    scene = "kit/collision_free_ball_144.toml"
    run = ["run", scene, "-e", engine, "-o", "ball.weftrec"]
    if engine != "reference":
        run += ["--time-step", "1/250 s", "--bullet-time-step"]
    weft(0, *run)
    own = weft.judge(0, "--recording", "ball.weftrec")
    weft(0, "export", "--pc2", "balls", "ball.weftrec")
    take = ["import", scene, "--force", "-o", "ball2.weftrec", "--frame-rate", "50 Hz", "--pc2", "cloth=balls/cloth.pc2"]
    weft.refuses("a ball without a file", "collider 'body' of scene 'collision_free_ball' has no file", *take)
    weft(0, *take, "--pc2", "body=balls/body.pc2")
    compare("free ball", own, weft.judge(0, "--recording", "ball2.weftrec"), 1)
    cache = PointCache("balls/cloth.pc2")
    # Every node that the ball has pushed down is put back half of the way: it would be inside of the ball.
    cache.write("balls/cloth.pc2", [mapped(sample, lambda x, y, z: (x, 0.5 * y, z)) for sample in cache.samples])
    weft(0, *take, "--pc2", "body=balls/body.pc2")
    rows = weft.judge(1, "--recording", "ball2.weftrec")
    check("half as deep: motion and rest fail", len(failed(rows)) == 2, str(rows))


def bad_input(weft):
    take = ["import", "hang", "-o", "never.weftrec", "--pc2", "caches/cloth.pc2"]
    weft(2, *take)  # no frame rate
    weft.refuses("a rate without a unit", '--frame-rate "50"', *take, "--frame-rate", "50")
    weft.refuses("a rate of nothing", "frame rate = 0 [1/s], expected > 0", *take, "--frame-rate", "0 Hz")
    weft.refuses("a unit of nothing", '--unit "0 m": expected a length > 0', *take, "--frame-rate", "50 Hz", "--unit",
                 "0 m")
    weft.refuses("a file that is not there", "gone.pc2: ", "import", "hang", "-o", "never.weftrec", "--frame-rate",
                 "50 Hz", "--pc2", "gone.pc2")
    weft.refuses("no file", "expected --pc2 FILE or --obj-sequence FOLDER", "import", "hang", "-o", "never.weftrec",
                 "--frame-rate", "50 Hz")
    weft.refuses("another scene", "caches/cloth.pc2: has 625 points, expected the 2500 nodes of body 'cloth'", "import",
                 "drape_sphere", "-o", "never.weftrec", "--frame-rate", "50 Hz", "--pc2", "caches/cloth.pc2")
    Path("mine.txt").write_text("mine")
    weft.refuses("another file at the place", "mine.txt", "import", "hang", "-o", "mine.txt", "--frame-rate", "50 Hz",
                 "--pc2", "caches/cloth.pc2")
    check("it stays", Path("mine.txt").read_text() == "mine")
    check("nothing is left behind", not list(Path().glob("never*")))
    weft.refuses("bounds of no engine", "--engine reference: has no bounds", "validate", "--recording", "hang.weftrec",
                 "--engine", "reference", "-o", "none")
    weft.refuses("a case that runs engines", "case 'determinism' cannot be judged from a recording", "validate",
                 "determinism", "--recording", "hang.weftrec", "-o", "none")
    weft.refuses("no recording", "mine.txt: ", "validate", "--recording", "mine.txt", "-o", "none")
    check("no report of them", not Path("none").exists())


def main():
    weft = Weft(sys.argv[1])
    engine = "bullet_weft" if sys.argv[2] == "with" else "reference"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        output, _ = weft(0, "validate", "--write-scenes", "kit")
        check("says how many", "kit: 39 scenes" in output, output)
        for scene in ("hang", "collision_led_sphere_676", "collision_mesh_144"):
            weft(0, "check", f"kit/{scene}.toml")
        hang(weft, engine)
        free_ball(weft, engine)
        bad_input(weft)
        os.chdir("/")
    print(f"{checks} checks, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
