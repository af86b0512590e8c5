#!/usr/bin/env python3
"""Blender imports the .glb file of weft export, and its vertices stand where those of the recording do, within the error that the file states.

usage: blender_reads_gltf.py WEFT (exit status 77: Blender or NumPy is not here)
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy_or_skip  # before anything that imports NumPy
import numpy

from glb_file import GlbFile
from recorded_points import RecordedPoints

# Blender computes in single precision, a frame number among it: t = 1 s is frame 24 to within 2e-6 s, which at 3 m/s are 6 um.
BLENDERS_ROUNDING = 2e-5

# Runs inside Blender: vertices of every mesh at the times that are asked for, in its axes (z is up).
INSIDE = """
import bpy, json, numpy
numpy.bool = bool  # Debian 12: its Blender 3.4 asks for a name that its NumPy 1.24 no longer has, for any glTF file
job = json.load(open(FOLDER + "/job.json"))
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=FOLDER + "/a.glb")
scene = bpy.context.scene
shown = {name: [] for name in job["meshes"]}
for time in job["times"]:
    place = time * scene.render.fps / scene.render.fps_base
    scene.frame_set(int(place), subframe=place - int(place))
    graph = bpy.context.evaluated_depsgraph_get()
    for name in job["meshes"]:
        body = bpy.data.objects[name].evaluated_get(graph)
        shown[name].append([list(body.matrix_world @ vertex.co) for vertex in body.data.vertices])
shown["materials"] = {name: [slot.material.use_backface_culling for slot in bpy.data.objects[name].material_slots]
                      for name in job["meshes"]}
json.dump(shown, open(FOLDER + "/shown.json", "w"))
print("WEFT done")
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
        run("run", "ball_on_cloth", "-e", "reference", "--duration", "1 s", "-o", "a.weftrec")
        run("export", "--gltf", "a.glb", "--vtp", "series", "a.weftrec")
        recorded = RecordedPoints(folder / "series")
        glb = GlbFile(folder / "a.glb")
        frames = [0, len(recorded.times) // 3, len(recorded.times) - 1]
        job = {"times": [recorded.times[frame] for frame in frames], "meshes": ["cloth", "ball"]}
        (folder / "job.json").write_text(json.dumps(job))
        script = folder / "inside.py"
        script.write_text(f"FOLDER = {name!r}\n{INSIDE}")
        command = [blender, "--background", "--factory-startup", "--python-exit-code", "3", "--python", str(script)]
        # Blender's Python looks for its modules beside the first python3 in PATH.
        environment = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]}
        result = subprocess.run(command, capture_output=True, text=True, env=environment)
        if result.returncode != 0 or "WEFT done" not in result.stdout:
            print(result.stdout, result.stderr)
            return 1
        shown = json.loads((folder / "shown.json").read_text())

    report = glb.root["asset"]["extras"]["cloths"][0]
    to_gltf_axes = lambda points: numpy.array(points)[..., [0, 2, 1]] * [1, 1, -1]
    cloth = to_gltf_axes(shown["cloth"])
    true = recorded.of_last_nodes("cloth")[frames][:, glb.vertex_nodes("cloth")]
    assert cloth.shape == true.shape, (cloth.shape, true.shape)
    largest = numpy.linalg.norm(cloth - true, axis=2).max()
    moved = numpy.linalg.norm(true[-1] - true[0], axis=1).max()
    print(f"cloth: {report['morph_targets']} shape keys, vertices at most {largest * 1e3:.3g} mm from the recording, "
          f"stated {report['largest_error_m'] * 1e3:.3g} mm; it moves by {moved * 1e3:.3g} mm")
    ball = to_gltf_axes(shown["ball"])
    # Both are tessellations of the same ball, whose middle is that of their box.
    middle = lambda points: (points.min(axis=-2) + points.max(axis=-2)) / 2
    drift = numpy.abs(middle(ball) - middle(numpy.array(recorded.points["ball"])[frames])).max()
    print(f"ball: middle at most {drift * 1e3:.3g} mm from the recording's")
    assert shown["materials"]["cloth"] == [False], "both sides are shown"
    return 0 if largest <= report["largest_error_m"] + BLENDERS_ROUNDING < moved / 10 and drift <= BLENDERS_ROUNDING else 1


if __name__ == "__main__":
    sys.exit(main())
