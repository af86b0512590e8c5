#!/usr/bin/env python3
"""Blender opens the OBJ and PC2 files of weft export, and its vertices stand where the point cache says.

usage: blender_reads_export.py WEFT (exit status 77: Blender is not here)
"""
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

# Runs inside Blender: the largest distance, over three frames, of an evaluated vertex from the cache's point.
INSIDE = """
import bpy, struct
data = open(FOLDER + "/caches/cloth.pc2", "rb").read()
points, start, step, samples = struct.unpack_from("<iffi", data, 16)
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.obj(filepath=FOLDER + "/caches/cloth.obj", split_mode="OFF")
cloth = bpy.context.selected_objects[0]
cache = cloth.modifiers.new("cache", "MESH_CACHE")
cache.cache_format = "PC2"
cache.filepath = FOLDER + "/caches/cloth.pc2"
largest = 0.0
for frame in (0, samples // 2, samples - 1):
    bpy.context.scene.frame_set(frame)
    mesh = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert len(mesh.vertices) == points, (len(mesh.vertices), points)
    for i, vertex in enumerate(mesh.vertices):
        expected = struct.unpack_from("<3f", data, 32 + 12 * (points * frame + i))
        largest = max(largest, max(abs(a - b) for a, b in zip(vertex.co, expected)))
print("WEFT", points, samples, largest)
"""


def main():
    blender = shutil.which("blender")
    if blender is None:
        print("skipped: Blender is not here (Debian: blender)")
        return 77
    weft = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run = lambda *words: subprocess.run([weft, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        run("run", "hang", "-e", "reference", "--duration", "0.4 s", "-o", "a.weftrec")
        run("export", "--pc2", "caches", "a.weftrec")
        script = folder / "inside.py"
        script.write_text(f"FOLDER = {name!r}\n{INSIDE}")
        command = [blender, "--background", "--factory-startup", "--python-exit-code", "3", "--python", str(script)]
        result = subprocess.run(command, capture_output=True, text=True)
        lines = [line for line in result.stdout.splitlines() if line.startswith("WEFT ")]
        if result.returncode != 0 or not lines:
            print(result.stdout, result.stderr)
            return 1
        _, points, samples, largest = lines[0].split()
        print(f"{points} points, {samples} samples: vertices at most {float(largest):.3g} m from the cache")
        # Single precision goes in and comes out.
        return 0 if float(largest) == 0.0 and int(samples) > 3 else 1


if __name__ == "__main__":
    sys.exit(main())
