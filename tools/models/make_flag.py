"""Builds the import tests' flag with vertex groups, as an artist would: a sheet of 4 x 3 vertices on two bones, in
every format that Blender 3.4 (Debian 12) writes bones into:

    blender -b -P tools/models/make_flag.py -- tests/scenes/import/good

The left column (x = 0) follows the bone "Pole" alone, the right one (x = 0.3 m) the bone "Tip" alone; between them the
weights are shared out evenly. Lengths are metres.
"""
import os
import sys

import bpy

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from rig import add_skinned, empty_scene, make_armature, new_mesh  # beside this file

COLUMNS, ROWS, SPACING = 4, 3, 0.1


def main():
    folder = sys.argv[sys.argv.index("--") + 1]
    empty_scene(24, 0, 1)
    rig = make_armature("Rig", {"Pole": ((0, 0, 0), (0, 0, 0.2), None), "Tip": ((0.3, 0, 0), (0.3, 0, 0.2), "Pole")})
    vertices = [(c * SPACING, 0, r * SPACING) for r in range(ROWS) for c in range(COLUMNS)]
    faces = [(r * COLUMNS + c, r * COLUMNS + c + 1, (r + 1) * COLUMNS + c + 1, (r + 1) * COLUMNS + c)
             for r in range(ROWS - 1) for c in range(COLUMNS - 1)]
    shares = [c / (COLUMNS - 1) for r in range(ROWS) for c in range(COLUMNS)]
    groups = [{bone: w for bone, w in (("Pole", 1 - s), ("Tip", s)) if w > 0} for s in shares]
    add_skinned("Flag", new_mesh("Flag", vertices, faces), groups, rig)
    bpy.ops.export_scene.gltf(filepath=os.path.join(folder, "flag.glb"), export_format="GLB", export_animations=False)
    bpy.ops.preferences.addon_enable(module="io_scene_fbx")
    bpy.ops.export_scene.fbx(filepath=os.path.join(folder, "flag.fbx"), add_leaf_bones=False, bake_anim=False,
                             apply_scale_options="FBX_SCALE_UNITS")


if __name__ == "__main__":
    main()
