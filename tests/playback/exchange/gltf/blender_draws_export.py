#!/usr/bin/env python3
"""Blender draws a frame of a glTF export as `weft render` draws it: what is cloth in one picture is cloth in the other.

usage: blender_draws_export.py WEFT SOURCE_FOLDER [--keep FOLDER] (exit status 77: Blender is not here)

--keep: also leaves both pictures there, as weft.png and blender.png.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SIZE = "480x270"
# Runs inside Blender: of the pixels that are cloth in one of two pictures, the share that is cloth in both. Cloth is blue.
INSIDE = """
import bpy, sys
import numpy as np

def cloth(name):
    image = bpy.data.images.load(name)
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)
    return pixels[..., 2] > pixels[..., 0] + 0.15

first, *others = sys.argv[sys.argv.index("--") + 1:]
mask = cloth(first)
for other in others:
    its = cloth(other)
    print("WEFT", (mask & its).sum() / (mask | its).sum(), mask.mean())
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("weft")
    parser.add_argument("sources")
    parser.add_argument("--keep")
    options = parser.parse_args()
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: Blender is not here (Debian: blender)")
        return 77
    weft = str(Path(options.weft).resolve())
    drawing = str(Path(options.sources, "tools", "render_in_blender.py").resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def run(*words):
            # Blender asks the first Python of the path where its modules are: Debian's has NumPy for it.
            environment = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]}
            result = subprocess.run(words, cwd=folder, capture_output=True, text=True, env=environment)
            if result.returncode != 0:
                sys.exit(f"{' '.join(words)}: exit status {result.returncode}\n{result.stdout}{result.stderr}")
            return result.stdout

        background = [blender, "--background", "--factory-startup", "--python-exit-code", "3", "--python"]
        run(weft, "run", "drape_sphere", "-e", "reference", "--duration", "1.2 s", "-o", "a.weftrec")
        run(weft, "export", "--gltf", "a.glb", "a.weftrec")
        run(weft, "render", "a.weftrec", "--time", "1 s", "--size", SIZE, "-o", "weft.png")
        samples = "128" if options.keep else "8"
        for time in ("1", "0.8"):
            run(*background, drawing, "--", "a.glb", "--time", time, "--size", SIZE, "--samples", samples, "--output", str(folder / f"at_{time}.png"))
        (folder / "inside.py").write_text(INSIDE)
        pictures = [str(folder / one) for one in ("weft.png", "at_1.png", "at_0.8.png")]
        lines = [line.split() for line in run(*background, str(folder / "inside.py"), "--", *pictures).splitlines() if line.startswith("WEFT ")]
        (same, covered), (earlier, _) = [(float(line[1]), float(line[2])) for line in lines]
        print(f"cloth covers {covered:.1%} of the picture; the same in Blender's to {same:.2%}, a fifth of a second earlier to {earlier:.2%}")
        if options.keep:
            shutil.copy(folder / "weft.png", options.keep)
            shutil.copy(folder / "at_1.png", Path(options.keep, "blender.png"))
        # Pixels at the edge: 0.6 % at this size.
        return 0 if covered > 0.05 and same > 0.985 and earlier < 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
