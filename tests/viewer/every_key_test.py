#!/usr/bin/env python3
"""Each key of the help of `weft view`, pressed through X in a window: what it says must happen, in the state and in the
picture.

usage: every_key_test.py PATH_OF_WEFT
The scale of the window is that of the environment variable WEFT_TEST_SCALE (default 1).
Skipped with exit code 77 where Xvfb or xdotool is not there, or where the display has no OpenGL 3.3.
"""
import os
import re
import subprocess
from pathlib import Path

from window_display import BALL, PATIENCE, Window, has_engine, run_tests

SCALE = int(os.environ.get("WEFT_TEST_SCALE", "1"))
X_NAMES = {"Space": "space", "PageUp": "Prior", "PageDown": "Next", "Enter": "Return", "[": "bracketleft",
           "]": "bracketright", "=": "equal", "-": "minus", "Ctrl": "ctrl", "Shift": "shift"}


def input_map():
    """id -> key of all actions, from the table that help, tooltips and keys come from."""
    text = (Path(__file__).resolve().parents[2] / "viewer" / "model" / "action.cpp").read_text(encoding="utf-8")
    rows = re.findall(r'^    \{k\w+, "(\w+)", "[^"]+", "([^"]+)", "[^"]+"\},$', text, re.MULTILINE)
    assert len(rows) > 60, f"{len(rows)} rows: this test does not find them"
    return dict(rows)


def x_key(key):
    parts = re.findall(r"Ctrl|Shift|(?<=\+).+$|^[^+]+$", key) if "+" in key else [key]
    return "+".join(X_NAMES.get(part, part if len(part) > 1 else part.lower()) for part in parts)


class Keys:
    """Presses keys in a window, and remembers which of them did what they should."""

    def __init__(self, window, pressed):
        self.window, self.map, self.pressed = window, input_map(), pressed

    def press(self, action, has_changed):
        """has_changed(before, after), which may come some pictures later."""
        before = self.window.settle()
        self.window.keys(x_key(self.map[action]))

        def has_happened(state):
            return has_changed(before, state)
        has_happened.__name__ = f"what '{action}' [{self.map[action]}] should do"
        after = self.window.wait_for(has_happened)
        self.pressed.add(action)
        return after

    def toggle(self, action, field):
        """On and off, or off and on."""
        for _ in range(2):
            self.press(action, lambda before, after: after[field] is not before[field])


def differs(field):
    return lambda before, after: after[field] != before[field]


def moves(axis, field, step):
    def has_moved(before, after):
        return all(abs(after[field][k] - before[field][k] - (step if k == axis else 0.0)) < 1e-9 for k in range(3))
    return has_moved


def distance(state):
    camera = state["camera"]
    return sum((a - b) ** 2 for a, b in zip(camera["position"], camera["target"])) ** 0.5


def right_of(state, vector):
    """How far a vector goes to the right in the picture."""
    look = [b - a for a, b in zip(state["camera"]["position"], state["camera"]["target"])]
    right = [-look[2], 0.0, look[0]]
    return sum(a * b for a, b in zip(right, vector))


def camera_way(before, after, end):
    return [a - b for a, b in zip(after["camera"][end], before["camera"][end])]


def press_time(keys):
    keys.press("step_forward", lambda a, b: b["step"] == a["step"] + 1)
    keys.press("step_forward", lambda a, b: b["step"] == a["step"] + 1)
    keys.press("take_back", lambda a, b: b["step"] == a["step"] - 1)
    keys.press("step_forward", lambda a, b: b["step"] == 2)
    keys.press("step_back", lambda a, b: b["step"] == 1 and b["looks_back"])
    keys.press("last_frame", lambda a, b: b["step"] == 2 and not b["looks_back"])
    keys.press("first_frame", lambda a, b: b["step"] == 0 and b["looks_back"])
    keys.press("pause", lambda a, b: b["playing"] and b["time"] > 0.05)
    keys.press("pause", lambda a, b: not b["playing"])
    keys.press("faster", lambda a, b: b["speed"] > a["speed"])
    keys.press("slower", lambda a, b: b["speed"] < a["speed"])


def press_laws(keys):
    for axis, name in enumerate("xyz"):
        for field, step in (("wind", 0.5), ("gravity", 1.0)):
            keys.press(f"{field}_{name}_more", moves(axis, field, step))
            keys.press(f"{field}_{name}_more", moves(axis, field, step))
            keys.press(f"{field}_{name}_less", moves(axis, field, -step))
    # The state has the laws that were set; the picture's are those of the run.
    # Both start again and run.
    keys.press("pause", lambda a, b: b["time"] > 2.0)
    keys.press("restart", lambda a, b: b["time"] < a["time"] and b["wind"] == [0.5, 0.5, 0.5])
    keys.press("restart_as_written", lambda a, b: b["playing"] and b["wind"] == [0.0, 0.0, 0.0]
               and abs(b["gravity"][1] + 9.81) < 1e-9)
    keys.press("pause", lambda a, b: not b["playing"])
    keys.press("next_cloth", lambda a, b: b["cloth_type"] == "handkerchief")
    keys.press("previous_cloth", lambda a, b: b["cloth_type"] == "as written")
    keys.press("next_parameter", lambda a, b: b["chosen"] == 1 and b["laws_shown"])
    keys.press("previous_parameter", lambda a, b: b["chosen"] == 0)

    def grows(factor):
        def has_grown(a, b):
            changed = [name for name in a["laws"] if a["laws"][name] != b["laws"][name]]
            return len(changed) == 1 and abs(b["laws"][changed[0]] / a["laws"][changed[0]] - factor) < 1e-9
        return has_grown
    keys.press("next_parameter", differs("chosen"))
    keys.press("next_parameter", differs("chosen"))
    keys.press("next_parameter", differs("chosen"))
    keys.press("larger_parameter", grows(1.1))
    keys.press("smaller_parameter", grows(1 / 1.1))
    keys.toggle("laws", "laws_shown")


def press_view(keys):
    for action, style in (("next_style", "wireframe"), ("strain", "strain"), ("wireframe", "wireframe"), ("shaded", "shaded")):
        keys.press(action, lambda a, b, style=style: b["style"] == style)
    for action, field in (("shadow", "shadow"), ("worst_node", "worst_shown"), ("plots", "plots"), ("panels", "panels"),
                          ("contacts", "contacts_shown")):
        keys.toggle(action, field)
    for action, sign in (("rotate_left", -1), ("rotate_right", 1)):
        keys.press(action, lambda a, b, sign=sign: sign * right_of(a, camera_way(a, b, "position")) > 0.01
                   and a["camera"]["target"] == b["camera"]["target"])
    for action, sign in (("rotate_up", 1), ("rotate_down", -1)):
        keys.press(action, lambda a, b, sign=sign: sign * camera_way(a, b, "position")[1] > 0.01)
    for action, sign in (("move_left", -1), ("move_right", 1)):
        keys.press(action, lambda a, b, sign=sign: sign * right_of(a, camera_way(a, b, "target")) > 0.01)
    for action, sign in (("move_up", 1), ("move_down", -1)):
        keys.press(action, lambda a, b, sign=sign: sign * camera_way(a, b, "target")[1] > 0.01)
    keys.press("zoom_in", lambda a, b: distance(b) < 0.95 * distance(a))
    keys.press("zoom_out", lambda a, b: distance(b) > 1.05 * distance(a))
    keys.press("zoom_out", lambda a, b: distance(b) > 1.05 * distance(a))
    keys.press("reset_view", lambda a, b: b["camera"]["position"] == [1.5, 1.5, 3.5])


def press_window(keys, folder):
    keys.press("window_larger", lambda a, b: b["window"][0] > a["window"][0])
    keys.press("window_smaller", lambda a, b: b["window"][0] < a["window"][0])
    keys.press("larger_text", lambda a, b: b["text_scale"] == 1.25 * a["text_scale"])
    keys.press("smaller_text", lambda a, b: b["text_scale"] < a["text_scale"])
    keys.toggle("full_screen", "full_screen")
    keys.press("help", lambda a, b: b["help"])
    keys.press("close", lambda a, b: not b["help"])
    keys.press("screenshot", lambda a, b: (folder / "weft-view-1.png").exists())
    keys.press("film", lambda a, b: b["filming"] or "ffmpeg" in b["message"])
    keys.window.keys(x_key(keys.map["film"]))


def press_scenes(keys, folder):
    keys.press("next_engine", differs("engine"))
    keys.press("scene_list", lambda a, b: b["list"])
    keys.press("scene_list", lambda a, b: not b["list"])
    keys.press("list_down", lambda a, b: b["list"] and b["row"] == 1)
    keys.press("list_up", lambda a, b: b["row"] == 0)
    keys.press("list_down", lambda a, b: b["row"] == 1)
    keys.press("list_open", lambda a, b: b["title"] == "other.toml" and not b["list"])
    # A scene that was opened runs; the file read again begins anew.
    keys.window.wait_for(lambda state: state["time"] > 2.0)
    keys.press("reload", lambda a, b: b["time"] < a["time"] and "other.toml" in b["title"])


def check_all(weft, display, folder, scale):
    """A live window, one with two recordings, and one that is closed by its key: together every row of the map."""
    pressed = set()
    (folder / "other.toml").write_text((folder / "small.toml").read_text(encoding="utf-8"), encoding="utf-8")
    options = ["--size", "1024x640", "--scale", str(scale)]
    window = Window(weft, display, folder, "small.toml", "other.toml", "--paused", *options)
    keys = Keys(window, pressed)
    press_time(keys)
    press_laws(keys)
    press_view(keys)
    press_window(keys, folder)
    press_scenes(keys, folder)
    window.quit()

    for name in ("a", "b"):
        subprocess.run([weft, "run", "small.toml", "-f", "-o", f"{name}.weftrec"], cwd=folder, check=True, capture_output=True)
    window = Window(weft, display, folder, "a.weftrec", "b.weftrec", *options)
    keys = Keys(window, pressed)
    keys.toggle("ghosts", "ghosts")
    keys.press("next_ghost", lambda a, b: b["solid"] == "b.weftrec")
    keys.toggle("loop", "loop")
    keys.press("last_frame", lambda a, b: b["frame"] == 20)
    keys.press("step_back", lambda a, b: b["frame"] == 19)
    keys.press("first_frame", lambda a, b: b["frame"] == 0)
    keys.press("step_forward", lambda a, b: b["frame"] == 1)
    window.display.xdotool("key", x_key(keys.map["quit"]))
    window.process.communicate(timeout=PATIENCE)
    assert window.process.returncode == 0
    pressed.add("quit")
    missing = set(input_map()) - pressed
    assert not missing, f"keys that this test does not press: {sorted(missing)}"
    print(f"{len(pressed)} keys at scale {scale}", flush=True)


def test_every_key(weft, display, folder):
    check_all(weft, display, folder, SCALE)


def pictures_of(weft, display, folder, files, lines, scale):
    """The pictures p0.png, p1.png ... after each of the lines of a script, as bytes."""
    script = ["do panels", "wait_time 0", *["do step_forward"] * 5, "wait 1.5", "screenshot p0.png"]
    for i, line in enumerate(lines, 1):
        script += [line, "wait 0.8", f"screenshot p{i}.png"]
    (folder / "script.txt").write_text("\n".join([*script, "quit"]), encoding="utf-8")
    subprocess.run([weft, "view", *files, "--size", "800x600", "--scale", str(scale), "--script", "script.txt"],
                   env=display.environment, cwd=folder, check=True, timeout=6 * PATIENCE)
    return [(folder / f"p{i}.png").read_bytes() for i in range(len(lines) + 1)]


def test_every_function_is_seen(weft, display, folder):
    """What moves the camera, the run or the panels changes the picture."""
    actions = ["wireframe", "strain", "next_style", "shadow", "rotate_left", "rotate_up", "rotate_right", "rotate_down",
               "move_left", "move_up", "move_right", "move_down", "zoom_in", "zoom_out", "worst_node", "step_forward",
               "step_back", "first_frame", "last_frame", "take_back", "panels", "plots", "laws", "next_parameter",
               "wind_x_more", "gravity_z_less", "next_cloth", "faster", "larger_text", "help", "close", "scene_list", "list_down",
               "close", "restart"]
    pictures = pictures_of(weft, display, folder, ["small.toml", "--paused"], [f"do {action}" for action in actions], SCALE)
    same = [f"{i}: {action}" for i, action in enumerate(actions, 1) if pictures[i] == pictures[i - 1]]
    assert not same, f"these change nothing: {same}"


def test_ghosts_and_contacts_are_seen(weft, display, folder):
    (folder / "ball.toml").write_text(BALL.replace('duration = "3 s"', 'duration = "0.6 s"'), encoding="utf-8")
    if not has_engine(weft, "bullet_forces"):
        print("a build without Bullet: no engine tells its contacts")
        return
    subprocess.run([weft, "run", "small.toml", "-f", "-o", "a.weftrec"], cwd=folder, check=True, capture_output=True)
    (folder / "soft.toml").write_text((folder / "small.toml").read_text(encoding="utf-8").replace("20 N/m", "5 N/m"),
                                      encoding="utf-8")
    subprocess.run([weft, "run", "soft.toml", "-f", "-o", "b.weftrec"], cwd=folder, check=True, capture_output=True)
    lines = ["do last_frame", "do ghosts", "do next_ghost", "do ghosts"]
    pictures = pictures_of(weft, display, folder, ["a.weftrec", "b.weftrec"], lines, SCALE)
    assert len(set(pictures)) == len(pictures), "ghosts are not seen"
    files = ["ball.toml", "-e", "bullet_forces", "--paused"]
    # Paused again: a run that goes on would change the picture without contacts too.
    pictures = pictures_of(weft, display, folder, files, ["do pause\nwait_time 0.59\ndo pause", "do contacts"], SCALE)
    assert pictures[2] != pictures[1], "contacts are not seen"


if __name__ == "__main__":
    run_tests([test for name, test in globals().copy().items() if name.startswith("test_")], "every_key_test.py")
