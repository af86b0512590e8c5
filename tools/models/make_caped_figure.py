"""Builds scenes/models/caped_figure.glb: a low-poly figure that walks, with a cape. For Blender 3.4 (Debian 12):

    blender -b -P tools/models/make_caped_figure.py -- scenes/models/caped_figure.glb

What an artist would do by hand: an armature, a body whose vertices follow one bone each, a cape skinned to the
shoulders with a painted maximum distance in the red channel of its vertex colours (0 at the collar, 1 at the hem), and
one clip, "Walk", of 2 seconds that walks on the spot and turns to both sides. Lengths are metres; Blender's z is up, the
exporter turns it to glTF's y.
"""
import math
import os
import sys

import bpy
from mathutils import Vector

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from rig import add_skinned, empty_scene, export, make_armature, new_mesh  # beside this file

FRAMES_PER_SECOND = 60
CLIP_FRAMES = 120  # 2 s: two steps with each foot

# name: (head, tail, parent); the figure looks along -y and is 1.8 m tall.
BONES = {
    "Hips": ((0, 0, 0.95), (0, 0, 1.10), None),
    "Spine": ((0, 0, 1.10), (0, 0, 1.45), "Hips"),
    "Neck": ((0, 0, 1.45), (0, 0, 1.55), "Spine"),
    "Head": ((0, 0, 1.55), (0, 0, 1.80), "Neck"),
    "UpperArm.L": ((0.20, 0, 1.42), (0.26, 0, 1.14), "Spine"),
    "LowerArm.L": ((0.26, 0, 1.14), (0.28, 0, 0.88), "UpperArm.L"),
    "UpperArm.R": ((-0.20, 0, 1.42), (-0.26, 0, 1.14), "Spine"),
    "LowerArm.R": ((-0.26, 0, 1.14), (-0.28, 0, 0.88), "UpperArm.R"),
    "UpperLeg.L": ((0.10, 0, 0.95), (0.11, 0, 0.52), "Hips"),
    "LowerLeg.L": ((0.11, 0, 0.52), (0.11, 0, 0.09), "UpperLeg.L"),
    "Foot.L": ((0.11, 0, 0.09), (0.11, -0.16, 0.03), "LowerLeg.L"),
    "UpperLeg.R": ((-0.10, 0, 0.95), (-0.11, 0, 0.52), "Hips"),
    "LowerLeg.R": ((-0.11, 0, 0.52), (-0.11, 0, 0.09), "UpperLeg.R"),
    "Foot.R": ((-0.11, 0, 0.09), (-0.11, -0.16, 0.03), "LowerLeg.R"),
}

# Rings of the limbs: bone: ((height share along the bone, half width x, half width y), ...).
LIMBS = {
    "Hips": ((-0.25, 0.13, 0.09), (0.3, 0.15, 0.11), (1.0, 0.13, 0.10)),
    "Spine": ((0.0, 0.13, 0.10), (0.45, 0.17, 0.12), (0.85, 0.19, 0.11), (1.02, 0.10, 0.08)),
    "Neck": ((-0.1, 0.055, 0.055), (1.0, 0.05, 0.05)),
    "Head": ((-0.1, 0.05, 0.06), (0.2, 0.085, 0.10), (0.6, 0.095, 0.11), (0.9, 0.07, 0.08), (1.02, 0.02, 0.02)),
    "UpperArm": ((-0.08, 0.05, 0.05), (0.4, 0.052, 0.052), (1.0, 0.042, 0.042)),
    "LowerArm": ((-0.02, 0.042, 0.042), (0.35, 0.042, 0.042), (0.85, 0.03, 0.03), (1.2, 0.035, 0.022), (1.3, 0.015, 0.012)),
    "UpperLeg": ((-0.05, 0.085, 0.085), (0.4, 0.08, 0.08), (1.0, 0.058, 0.058)),
    "LowerLeg": ((-0.02, 0.058, 0.058), (0.35, 0.06, 0.062), (1.0, 0.038, 0.038)),
    "Foot": ((-0.35, 0.035, 0.03), (0.2, 0.045, 0.045), (1.0, 0.042, 0.028), (1.25, 0.02, 0.015)),
}
RING = 8  # corners of a ring

# The cape: rows from the collar to the hem, columns around the back from shoulder to shoulder.
CAPE_ROWS, CAPE_COLUMNS = 22, 25
CAPE_TOP, CAPE_BOTTOM = 1.47, 0.42  # heights
PLEATS = 4


def frame_of(head, tail):
    """Two directions across a bone: the first as close to x as can be."""
    along = (tail - head).normalized()
    across = Vector((1, 0, 0)) - along * along.x
    across.normalize()
    return across, along.cross(across)


def limb(bone, vertices, faces, groups):
    """A closed tube of rings around a bone."""
    head, tail = Vector(BONES[bone][0]), Vector(BONES[bone][1])
    across, other = frame_of(head, tail)
    rings = LIMBS[bone.split(".")[0]]
    first = len(vertices)
    for share, half_x, half_y in rings:
        center = head + (tail - head) * share
        for corner in range(RING):
            angle = 2 * math.pi * corner / RING
            vertices.append(center + across * half_x * math.cos(angle) + other * half_y * math.sin(angle))
    for ring in range(len(rings) - 1):
        for corner in range(RING):
            a, b = first + ring * RING + corner, first + ring * RING + (corner + 1) % RING
            faces.append((a, b, b + RING, a + RING))
    faces.append([first + corner for corner in reversed(range(RING))])
    faces.append([first + (len(rings) - 1) * RING + corner for corner in range(RING)])
    for vertex in range(first, len(vertices)):
        groups.append({bone: 1.0})


def make_mesh(name, vertices, faces, groups, color, rig):
    mesh = new_mesh(name, vertices, faces)
    mesh.validate()
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    mesh.materials.append(material)
    return add_skinned(name, mesh, groups, rig)


def make_body(rig):
    vertices, faces, groups = [], [], []
    for bone in BONES:
        limb(bone, vertices, faces, groups)
    return make_mesh("Body", vertices, faces, groups, (0.35, 0.38, 0.45), rig)


def cape_point(row, column):
    """On a half cone behind the back that widens towards the hem."""
    down = row / (CAPE_ROWS - 1)
    # 0 is behind the figure. The edges end behind the arms, which would otherwise stand in the cape.
    angle = math.pi * (column / (CAPE_COLUMNS - 1) - 0.5) * 0.68
    # Pleats that open towards the hem: cloth that hangs smooth does not flow.
    pleat = 1 + 0.09 * down * math.cos(2 * math.pi * PLEATS * column / (CAPE_COLUMNS - 1))
    half_x = (0.20 + 0.14 * down) * pleat
    half_y = (0.10 + 0.15 * down) * pleat
    # The collar lies on the shoulders: higher at the neck, lower towards the arms.
    top = CAPE_TOP - 0.055 * abs(math.sin(angle))
    height = top + (CAPE_BOTTOM - top) * down
    return Vector((half_x * math.sin(angle), 0.02 + half_y * math.cos(angle), height))


def make_cape(rig):
    vertices, faces, groups, painted = [], [], [], []
    for row in range(CAPE_ROWS):
        for column in range(CAPE_COLUMNS):
            vertices.append(cape_point(row, column))
            down = row / (CAPE_ROWS - 1)
            groups.append({"Spine": 1.0 - 0.5 * down, "Hips": 0.5 * down} if row else {"Spine": 1.0})
            painted.append(0.0 if row < 2 else min(1.0, (row - 1) / (CAPE_ROWS - 5)))
    for row in range(CAPE_ROWS - 1):
        for column in range(CAPE_COLUMNS - 1):
            a = row * CAPE_COLUMNS + column
            # Diagonals that alternate, so that the cloth has no preferred direction; front faces outward.
            corners = (a, a + 1, a + CAPE_COLUMNS + 1, a + CAPE_COLUMNS)
            if (row + column) % 2:
                faces += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
            else:
                faces += [(corners[0], corners[1], corners[3]), (corners[1], corners[2], corners[3])]
    cape = make_mesh("Cape", vertices, faces, groups, (0.55, 0.05, 0.07), rig)
    layer = cape.data.color_attributes.new(name="MaxDistance", type="FLOAT_COLOR", domain="POINT")
    for vertex, share in enumerate(painted):
        layer.data[vertex].color = (share, share, share, 1.0)
    return cape


def swing(rig, bone, angles, axis=0):
    """Turns a bone about one of its own axes: angles [deg] at equal times over the clip."""
    pose = rig.pose.bones[bone]
    pose.rotation_mode = "QUATERNION"
    for key, angle in enumerate(angles):
        frame = round(key * CLIP_FRAMES / (len(angles) - 1))
        direction = [0.0, 0.0, 0.0]
        direction[axis] = 1.0
        half = math.radians(angle) / 2
        pose.rotation_quaternion = (math.cos(half), *(math.sin(half) * d for d in direction))
        pose.keyframe_insert("rotation_quaternion", frame=frame)


def animate(rig):
    rig.animation_data_create()
    rig.animation_data.action = bpy.data.actions.new("Walk")
    # Starts with the legs side by side: a leg behind would stand in the cape.
    # Positive angles turn a limb backwards.
    stride = [0, 26, 0, -26, 0, 26, 0, -26, 0]
    knee = [45, 6, 2, 12, 45, 6, 2, 12, 45]
    opposite = [-a for a in stride]
    late_knee = knee[2:] + knee[1:3]
    swing(rig, "UpperLeg.L", stride)
    swing(rig, "UpperLeg.R", opposite)
    swing(rig, "LowerLeg.L", late_knee)
    swing(rig, "LowerLeg.R", knee)
    swing(rig, "UpperArm.L", [0.7 * a for a in opposite])
    swing(rig, "UpperArm.R", [0.7 * a for a in stride])
    swing(rig, "LowerArm.L", [-20] * 9)
    swing(rig, "LowerArm.R", [-20] * 9)
    swing(rig, "Hips", [0, 18, 30, 18, 0, -18, -30, -18, 0], axis=1)  # about the vertical
    swing(rig, "Spine", [4, 6, 4, 6, 4, 6, 4, 6, 4])
    hips = rig.pose.bones["Hips"]
    for key, height in enumerate([0.0, -0.03, 0.0, -0.03, 0.0, -0.03, 0.0, -0.03, 0.0]):
        hips.location = (0, height, 0)
        hips.keyframe_insert("location", frame=round(key * CLIP_FRAMES / 8))
    # The walk goes on from its last pose to its first one: automatic handles then look across the seam.
    for curve in rig.animation_data.action.fcurves:
        curve.modifiers.new("CYCLES")
        curve.update()


def main():
    empty_scene(FRAMES_PER_SECOND, 0, CLIP_FRAMES)
    rig = make_armature("Rig", BONES)
    make_body(rig)
    make_cape(rig)
    animate(rig)
    export(sys.argv[sys.argv.index("--") + 1], sampled=True, texture_coordinates=False)


if __name__ == "__main__":
    main()
