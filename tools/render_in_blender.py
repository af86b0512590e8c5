"""Draws one frame of a glTF export with Blender's Cycles, from the camera in the file: what another program makes of it, to look at
beside `weft render` of the same frame.

    weft export --gltf d.glb d.weftrec
    blender --background --python tools/render_in_blender.py -- d.glb --time 3 --output d_blender.png
"""
import argparse
import math
import sys

import bpy
import numpy

# Blender 3.4's import of glTF asks for a name that NumPy 1.24 does not have any more; Debian 12 has both.
if not hasattr(numpy, "bool"):
    numpy.bool = bool


def arguments():
    parser = argparse.ArgumentParser(prog="render_in_blender.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("file", help="from `weft export --gltf`")
    parser.add_argument("--time", type=float, required=True, help="[s] in the recording")
    parser.add_argument("--output", required=True, help="PNG to write")
    # Debian builds Blender without what would take the noise out.
    parser.add_argument("--samples", type=int, default=128, help="for each pixel, default 128")
    parser.add_argument("--size", default="960x540", help="[pixels], default 960x540")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def light(scene):
    """A sun from above the camera's left, and a gray sky."""
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 3.5
    sun.data.angle = math.radians(8)
    sun.rotation_euler = (math.radians(40), math.radians(-12), math.radians(20))
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"].inputs
    sky["Color"].default_value = (0.86, 0.87, 0.89, 1)
    sky["Strength"].default_value = 0.45


def main():
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=options.file)
    scene = bpy.context.scene
    frame = options.time * scene.render.fps / scene.render.fps_base
    scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
    cameras = [one for one in scene.objects if one.type == "CAMERA"]
    if not cameras:
        sys.exit(f"{options.file}: has no camera, expected the one that `weft export --gltf` writes")
    scene.camera = cameras[0]
    for mesh in (one.data for one in scene.objects if one.type == "MESH"):
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    light(scene)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = options.samples
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    width, height = (int(part) for part in options.size.split("x"))
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = options.output
    bpy.ops.render.render(write_still=True)


main()
