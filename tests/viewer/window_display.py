"""A display of its own for tests of the window, keys and mouse through X, and pictures that Weft wrote."""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

SKIPPED = 77
PATIENCE = 60.0  # [s] for something that must come
SCENE = """schema = "weft-scene/1"
name = "small"
summary = "Shows a small cloth that hangs"
engines = ["reference", "bullet_forces"]
[world]
gravity = ["0 m/s^2", "-9.81 m/s^2", "0 m/s^2"]
time_step = "1/500 s"
duration = "0.4 s"
frame_interval = "1/50 s"
[[cloth]]
name = "cloth"
grid = { nodes = [13, 13], size = ["1 m", "1 m"] }
center = ["0 m", "1.2 m", "0 m"]
u_axis = [1, 0, 0]
v_axis = [0, 0, -1]
mass = "0.25 kg"
pin = [{ corner = "-u-v" }, { corner = "+u-v" }]
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
stiffness = "20 N/m"
[[cloth.law]]
law = "velocity_damping"
rate = "2 1/s"
[camera]
position = ["1.5 m", "1.5 m", "3.5 m"]
target = ["0 m", "0.6 m", "0 m"]
"""


BALL = """schema = "weft-scene/1"
name = "ball"
summary = "Shows a small cloth that lies on a ball"
engines = ["bullet_forces"]
[world]
time_step = "1/500 s"
duration = "3 s"
frame_interval = "1/50 s"
[[cloth]]
name = "cloth"
grid = { nodes = [21, 21], size = ["1.2 m", "1.2 m"] }
center = ["0 m", "0.55 m", "0 m"]
mass = "0.25 kg"
collision_margin = "1 cm"
friction = 0.8
[[cloth.law]]
law = "gravity"
[[cloth.law]]
law = "tension"
stiffness = "10 N/m"
[[cloth.law]]
law = "velocity_damping"
rate = "2 1/s"
[[collider]]
name = "ball"
shape = "sphere"
radius = "0.5 m"
friction = 0.8
[camera]
position = ["0 m", "0.4 m", "4 m"]
target = ["0 m", "0 m", "0 m"]
"""


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def has_engine(weft, name):
    """Builds without Bullet have the reference solver alone."""
    told = subprocess.run([weft, "list"], check=True, capture_output=True, text=True).stdout
    assert "reference" in told, told
    return re.search(rf"^ *{name} ", told, re.MULTILINE) is not None


class Display:
    """An X server of this test."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "2000x1300x24", "-noreset", "-nolisten", "tcp",
             "-r"],  # a key that a busy machine lets go late is still one key
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        if not number:
            skip("Xvfb does not start")
        self.environment = dict(os.environ, DISPLAY=":" + number, LIBGL_ALWAYS_SOFTWARE="1")
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True,
                              capture_output=True, text=True, timeout=PATIENCE).stdout.strip()


class Window:
    """A `weft view` that runs until it is told to quit."""

    def __init__(self, weft, display, folder, *words):
        self.display = display
        self.state_file = folder / "state.json"
        self.state_file.unlink(missing_ok=True)
        self.process = subprocess.Popen([weft, "view", *words, "--state", str(self.state_file)],
                                        env=display.environment, cwd=folder, stderr=subprocess.PIPE, text=True)
        name = "Weft: " + words[0]
        end = time.monotonic() + PATIENCE
        while True:
            found = subprocess.run(["xdotool", "search", "--name", name], env=display.environment,
                                   capture_output=True, text=True, check=False).stdout.split()
            if found:
                break
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"no window '{name}': {self.process.communicate()[1]}")
            time.sleep(0.1)
        self.window = found[0]
        display.xdotool("windowfocus", "--sync", self.window)
        self.settle()  # the first picture compiles shaders

    def state(self):
        """What the next picture shows."""
        self.state_file.unlink(missing_ok=True)
        end = time.monotonic() + PATIENCE
        while not self.state_file.exists():
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"no state: {self.process.communicate()[1]}")
            time.sleep(0.02)
        return json.loads(self.state_file.read_text(encoding="utf-8"))

    def settle(self):
        """Until a whole picture has seen the input so far: the first one may have begun before it."""
        self.state()
        return self.state()

    def wait_for(self, condition):
        end = time.monotonic() + PATIENCE
        while not condition(state := self.state()):
            assert time.monotonic() < end, f"{condition.__name__} did not come: {state}"
        return state

    def keys(self, *names):
        for name in names:
            self.display.xdotool("key", name)
        self.settle()

    def move_mouse(self, x, y):
        self.display.xdotool("mousemove", "--window", self.window, x, y)
        self.settle()

    def button(self, number, event):
        self.display.xdotool("mouse" + event, number)
        self.settle()

    def begin_drag(self, button, start, end):
        """From and to in pixels of the window, in steps, as a hand moves."""
        self.move_mouse(*start)
        self.button(button, "down")
        for i in range(1, 9):
            self.move_mouse(*(round(a + i / 8 * (b - a)) for a, b in zip(start, end)))

    def drag(self, button, start, end):
        self.begin_drag(button, start, end)
        self.button(button, "up")

    def quit(self):
        self.display.xdotool("key", "ctrl+q")
        try:
            _, errors = self.process.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        assert self.process.returncode == 0, errors
        return json.loads(self.state_file.read_text(encoding="utf-8"))


def read_png(path):
    """Width, height and the RGB bytes of a picture that Weft wrote."""
    data = path.read_bytes()
    place, packed, width, height = 8, b"", 0, 0
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert (depth, color) == (8, 2), "expected 8 bits of red, green and blue"
        if kind == b"IDAT":
            packed += body
        place += 12 + length
    raw, row_size = zlib.decompress(packed), 3 * width
    above, rows = bytearray(row_size), []
    for y in range(height):
        kind, row = raw[y * (row_size + 1)], bytearray(raw[y * (row_size + 1) + 1:(y + 1) * (row_size + 1)])
        for i in range(row_size):
            left, up, corner = (row[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                row[i] = (row[i] + nearest[2]) & 255
        rows.append(bytes(row))
        above = row
    return width, height, b"".join(rows)


def mean_difference(a, b):
    assert a[:2] == b[:2], f"sizes {a[:2]} and {b[:2]}"
    return sum(abs(p - q) for p, q in zip(a[2], b[2])) / len(a[2])


def run_tests(tests, usage):
    """Calls tests with the program, a display and a folder in which small.toml lies; skipped without what they need."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: {usage} PATH_OF_WEFT")
    weft = str(Path(sys.argv[1]).resolve())
    for tool in ("Xvfb", "xdotool"):
        if shutil.which(tool) is None:
            skip(f"{tool} is not installed (tools/packages.txt, group test)")
    with tempfile.TemporaryDirectory() as name, Display() as display:
        folder = Path(name)
        (folder / "small.toml").write_text(SCENE, encoding="utf-8")
        (folder / "probe.txt").write_text("quit\n", encoding="utf-8")
        probe = subprocess.run([weft, "view", "small.toml", "--script", "probe.txt"], env=display.environment, cwd=folder,
                               check=False, capture_output=True, text=True, timeout=PATIENCE)
        if "no OpenGL 3.3" in probe.stderr:
            skip("the display has no OpenGL 3.3")
        assert probe.returncode == 0, probe.stderr
        for test in tests:
            start = time.monotonic()
            for path in folder.glob("weft-view-*"):
                path.unlink()
            test(*(weft, display, folder)[:test.__code__.co_argcount])
            print(f"{test.__name__}: ok, {time.monotonic() - start:.1f} s", flush=True)
