#!/usr/bin/env python3
"""The window of `weft view` on a display of its own: keys and mouse through X, pictures through a script.

usage: window_test.py PATH_OF_WEFT
Skipped with exit code 77 where Xvfb or xdotool is not there, or where the display has no OpenGL 3.3.
"""
import json
import re
import shutil
import subprocess
import time
from pathlib import Path

from window_display import BALL, PATIENCE, Window, has_engine, mean_difference, read_png, run_tests


def test_keys_through_x(weft, display, folder):
    window = Window(weft, display, folder, "hang", "--paused", "--size", "1024x640")
    window.keys("x", "x", "shift+z", "ctrl+y", "2", "n", "4", "t", "F1", "c", "bracketright", "Page_Down", "ctrl+equal",
                "Right", "Right", "Right")

    def has_made_three_steps(state):
        return state["step"] == 3
    window.wait_for(has_made_three_steps)
    window.keys("Left", "o", "Down", "o", "F7")
    state = window.quit()
    assert state["wind"] == [1.0, 0.0, -0.5], state["wind"]
    assert abs(state["gravity"][1] + 8.81) < 1e-9, state["gravity"]
    assert state["style"] == "wireframe" and state["worst_shown"] and state["help"], state
    assert not state["shadow"] and not state["plots"], state
    assert state["cloth_type"] == "handkerchief" and state["speed"] == 2.0, state
    assert state["chosen"] == 1 and state["text_scale"] == 1.25, state
    assert state["step"] == 2 and state["looks_back"] and not state["playing"], state
    assert state["row"] == 1 and not state["list"], state
    assert state["window"] == [1280, 800], state["window"]


def test_mouse_through_x(weft, display, folder):
    still = Window(weft, display, folder, "hang", "--paused", "--size", "1024x640").quit()
    assert still["camera"]["position"] == [1.5, 1.5, 3.5], still["camera"]

    window = Window(weft, display, folder, "hang", "--paused", "--size", "1024x640")
    window.drag(1, (620, 300), (700, 260))
    turned = window.quit()
    assert turned["camera"]["position"] != still["camera"]["position"]
    assert turned["camera"]["target"] == still["camera"]["target"]

    window = Window(weft, display, folder, "hang", "--paused", "--size", "1024x640")
    window.drag(3, (620, 300), (700, 260))
    moved = window.quit()
    assert moved["camera"]["target"] != still["camera"]["target"]

    window = Window(weft, display, folder, "hang", "--paused", "--size", "1024x640")
    window.move_mouse(620, 300)
    display.xdotool("click", 4)
    window.settle()
    nearer = window.quit()

    def distance(state):
        camera = state["camera"]
        return sum((a - b) ** 2 for a, b in zip(camera["position"], camera["target"])) ** 0.5
    assert distance(nearer) < distance(still)


def test_pull_and_buttons_through_x(weft, display, folder):
    # The panels are hidden, so that the cloth is under the mouse.
    window = Window(weft, display, folder, "hang", "--size", "1024x640")
    window.keys("Tab")

    def hangs(state):
        return state["time"] > 3.0
    window.wait_for(hangs)
    window.begin_drag(2, (420, 330), (560, 120))

    def pulls(state):
        return state["largest_pull_N"] > 0.05
    window.wait_for(pulls)
    window.button(2, "up")
    pulled = window.quit()
    assert pulled["playing"] and not pulled["panels"], pulled
    # The first button of the timeline.
    window = Window(weft, display, folder, "hang", "--size", "1024x640")
    window.move_mouse(50, 603)
    window.button(1, "down")
    window.button(1, "up")
    assert not window.quit()["playing"]


def test_colliders_and_contacts_through_x(weft, display, folder):
    """Shift and drag moves a collider; A shows forces as arrows, in the picture too."""
    (folder / "ball.toml").write_text(BALL, encoding="utf-8")
    if not has_engine(weft, "bullet_forces"):
        print("a build without Bullet: no engine tells its contacts")
        return
    window = Window(weft, display, folder, "ball.toml", "-e", "bullet_forces", "--size", "640x400")
    window.keys("Tab")

    def lies(state):
        return state["time"] > 1.5 and state.get("touches", 0) > 10
    window.wait_for(lies)
    for key in ("space", "p", "a", "p"):
        window.keys(key)  # one by one: two screenshots in a picture are one
    plain, arrows = (read_png(folder / f"weft-view-{i}.png") for i in (1, 2))
    assert mean_difference(plain, arrows) > 0.05, "no arrows"
    window.keys("a", "space")
    display.xdotool("keydown", "shift")
    window.begin_drag(1, (320, 206), (445, 206))
    target = window.state()["rigids"]["ball"][0]
    for _ in range(60):
        time.sleep(0.1)
        before, target = target, window.state()["rigids"]["ball"][0]
        if target > 0.2 and target == before:
            break
    window.button(1, "up")
    display.xdotool("keyup", "shift")
    state = window.quit()
    assert 0.2 < state["rigids"]["ball"][0] == target, state["rigids"]
    assert state["camera"]["position"] == [0.0, 0.4, 4.0], "the view has turned"


def test_film_through_x(weft, display, folder):
    if shutil.which("ffmpeg") is None:
        print("ffmpeg is not installed: no film")
        return
    window = Window(weft, display, folder, "small.toml", "--size", "640x401")
    window.keys("m")
    assert window.state()["filming"]
    time.sleep(1.0)
    window.keys("m")
    state = window.quit()
    assert not state["filming"] and "weft-view-1.mp4" in state["message"], state["message"]
    told = subprocess.run(["ffprobe", "-v", "error", "-show_entries", "stream=width,height,duration", "-of", "json",
                           "weft-view-1.mp4"], cwd=folder, check=True, capture_output=True, text=True)
    stream = json.loads(told.stdout)["streams"][0]
    assert (stream["width"], stream["height"]) == (640, 400), stream
    assert 0.9 < float(stream["duration"]) < 30, stream


def test_list_has_pictures(weft, display, folder):
    """Each row of the list of scenes has a picture, also for a person who only scrolls."""
    (folder / "script.txt").write_text("do panels\ndo scene_list\nwait 12\nscreenshot list.png\nquit\n", encoding="utf-8")
    subprocess.run([weft, "view", "small.toml", "--paused", "--size", "900x600", "--script", "script.txt"],
                   env=display.environment, cwd=folder, check=True, timeout=2 * PATIENCE)
    width, height, pixels = read_png(folder / "list.png")
    # The pictures stand in a column at the left of the list, which is 520 pixels wide and in the middle.
    column = [pixels[3 * (y * width + 250):3 * (y * width + 251)] for y in range(80, height - 80)]
    assert len(set(column)) > 60, f"{len(set(column))} colors where pictures should be"


def test_every_control_has_a_tooltip():
    """Every widget of Dear ImGui is followed by its tooltip, and those of actions come from the input map."""
    widget = re.compile(r"ImGui::(Button|SmallButton|Checkbox|RadioButton|Slider\w+|Drag\w+|Input\w+|Selectable|BeginCombo)\(")
    count = 0
    for path in sorted((Path(__file__).resolve().parents[2] / "viewer" / "ui").rglob("*.cpp")):
        lines = path.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines, 1):
            if not widget.search(line):
                continue
            count += 1
            after = "\n".join(lines[number - 1:number + 16])
            assert re.search(r"\btip\(|SetTooltip\(", after), f"{path.name}:{number}: a control without a tooltip"
    assert count > 8, f"{count} controls: this test does not find them"


def test_pictures(weft, display, folder):
    """Every function that changes the picture does; without one it stays the same, byte for byte."""
    actions = ["wireframe", "strain", "shaded", "shadow", "rotate_left", "zoom_in", "move_up", "worst_node", "panels", "help",
               "help", "scene_list", "scene_list", "plots", "laws", "larger_text", "window_larger"]
    lines = ["do panels", "do window_smaller", "do window_smaller", "wait_time 0", *["do step_forward"] * 5, "wait_time 0.01", "wait 1.5", "screenshot p0.png", "wait 0.6",
             "screenshot same.png"]
    for i, action in enumerate(actions, 1):
        lines += [f"do {action}", "wait 1", f"screenshot p{i}.png"]
    (folder / "script.txt").write_text("\n".join([*lines, "quit"]), encoding="utf-8")
    subprocess.run([weft, "view", "small.toml", "--paused", "--script", "script.txt"], env=display.environment, cwd=folder,
                   check=True, timeout=5 * PATIENCE)
    pictures = [(folder / f"p{i}.png").read_bytes() for i in range(len(actions) + 1)]
    assert (folder / "same.png").read_bytes() == pictures[0], "a picture changes by itself"
    for i, action in enumerate(actions, 1):
        assert pictures[i] != pictures[i - 1], f"{action} changes nothing"
    # From strain to shaded and back to the looks of the first picture.
    assert pictures[3] == pictures[0], "shaded is not what it was"


def test_picture_is_that_of_render(weft, display, folder):
    subprocess.run([weft, "run", "small.toml", "-o", "small.weftrec"], cwd=folder, check=True, capture_output=True)
    subprocess.run([weft, "render", "small.weftrec", "-o", "render.png", "--size", "400x300"], cwd=folder, check=True,
                   capture_output=True)
    (folder / "script.txt").write_text("do panels\ndo last_frame\nwait 2\nscreenshot window.png\nquit\n", encoding="utf-8")
    subprocess.run([weft, "view", "small.weftrec", "--size", "400x300", "--script", "script.txt"], env=display.environment,
                   cwd=folder, check=True, timeout=PATIENCE)
    difference = mean_difference(read_png(folder / "window.png"), read_png(folder / "render.png"))
    assert difference < 0.5, f"mean difference {difference} of 255"
    # Negative control: another frame.
    subprocess.run([weft, "render", "small.weftrec", "-o", "first.png", "--size", "400x300", "--time", "0 s"], cwd=folder,
                   check=True, capture_output=True)
    other = mean_difference(read_png(folder / "window.png"), read_png(folder / "first.png"))
    assert other > 2.0, f"the test would not notice another frame: {other}"


def test_untouched_run_has_the_bits_of_run(weft, display, folder):
    for engine in ("reference", "bullet_forces"):
        if not has_engine(weft, engine):
            continue
        subprocess.run([weft, "run", "small.toml", "-e", engine, "-o", f"run_{engine}.weftrec"], cwd=folder, check=True,
                       capture_output=True)
        subprocess.run([weft, "view", "small.toml", "-e", engine, "--record", f"view_{engine}.weftrec", "--exit-at-end"],
                       env=display.environment, cwd=folder, check=True, timeout=PATIENCE)
        told = subprocess.run([weft, "diff", f"run_{engine}.weftrec", f"view_{engine}.weftrec"], cwd=folder, check=False,
                              capture_output=True, text=True)
        assert told.returncode == 0 and "equal bit for bit, 21 frames" in told.stdout, told.stdout + told.stderr


def test_mistakes_are_told(weft, display, folder):
    def told(*words, environment=display.environment):
        result = subprocess.run([weft, "view", *words], env=environment, cwd=folder, check=False, capture_output=True, text=True,
                                timeout=PATIENCE)
        assert result.returncode == 2 and result.stderr.count("\n") <= 2, result
        return result.stderr
    assert "expected pixels" in told("small.toml", "--size", "3")
    assert "'nonsense'" in told("nonsense")
    assert "missing.txt" in told("small.toml", "--script", "missing.txt")
    (folder / "bad.txt").write_text("wait 1\nfly\n", encoding="utf-8")
    assert "bad.txt:2" in told("small.toml", "--script", "bad.txt")
    nowhere = {key: value for key, value in display.environment.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    assert "there is no display" in told("small.toml", environment=nowhere)
    assert "expected float32 or float64" in told("small.toml", "-p", "float16")


if __name__ == "__main__":
    run_tests([test for name, test in globals().copy().items() if name.startswith("test_")], "window_test.py")
