"""Builds scenes/models/caped_figure.glb: a low-poly figure that walks, with a cape. For Blender 3.4 (Debian 12):

    blender -b -P tools/models/make_caped_figure.py -- scenes/models/caped_figure.glb

What an artist would do by hand: an armature, a body whose vertices follow one bone each, a cape skinned to the
shoulders with a painted maximum distance in the red channel of its vertex colours (0 at the collar, 1 at the hem), and
one clip, "Walk", of 2 seconds that walks on the spot and turns to both sides. Beside the cape lies "CapeFine", what is
drawn in its place: two layers with a hem, a rolled collar and two clasps. It needs no skin, for the cape leads it. Its
texture coordinates choose between the two colours of the pattern "stripes": cloth, and trimming of hem and clasps.
Lengths are metres; Blender's z is up, the exporter turns it to glTF's y.
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

# The drawn cape.
FINE_ROWS, FINE_COLUMNS = 43, 55
THICKNESS, HEM_THICKNESS, HEM_WIDTH = 0.004, 0.009, 0.028  # of both layers; of the hem, from its fold to its seam
COLLAR_RADIUS, COLLAR_CORNERS = 0.017, 8
CLASP_RADIUS, CLASP_HEIGHT, CLASP_CORNERS = 0.021, 0.009, 16
CLOTH_COLOR, TRIM_COLOR = (0.03, 0.5), (0.09, 0.5)  # the first and the second of the 16 stripes along u


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


def cape_frame(row, column):
    """A point of the cape between its vertices, and the unit normal that points away from the body."""
    step = 1e-4
    place = cape_point(row, column)
    across = cape_point(row, column + step) - cape_point(row, column - step)
    down = cape_point(row + step, column) - cape_point(row - step, column)
    normal = down.cross(across).normalized()
    return place, normal if normal.dot(Vector((place.x, place.y, 0))) > 0 else -normal


class FineCape:
    """Vertices and faces of the drawn cape, with a colour for each face."""

    def __init__(self):
        self.vertices, self.faces, self.colors = [], [], []

    def face(self, corners, color):
        self.faces.append(corners)
        self.colors.append(color)

    def tube(self, rings, color, is_capped):
        """Rings of equally many points, each counter-clockwise seen against the way of the tube."""
        first, corners = len(self.vertices), len(rings[0])
        for ring in rings:
            self.vertices += ring
        for ring in range(len(rings) - 1):
            for corner in range(corners):
                a, b = first + ring * corners + corner, first + ring * corners + (corner + 1) % corners
                self.face((a, b, b + corners, a + corners), color)
        if is_capped:
            last = first + (len(rings) - 1) * corners
            self.face([first + corner for corner in reversed(range(corners))], color)
            self.face([last + corner for corner in range(corners)], color)


def add_layers(fine):
    """Both layers and the rim that closes them; the hem runs along the lower edge and up both front edges."""
    rows = [row * (CAPE_ROWS - 1) / (FINE_ROWS - 1) for row in range(FINE_ROWS)]
    columns = [column * (CAPE_COLUMNS - 1) / (FINE_COLUMNS - 1) for column in range(FINE_COLUMNS)]
    # Lines of vertices at the seam of the hem: one cell from each edge is moved there, the rest stay where they are.
    drop = (CAPE_TOP - CAPE_BOTTOM) / (CAPE_ROWS - 1)
    rows[-2], rows[-3] = CAPE_ROWS - 1 - 0.6 * HEM_WIDTH / drop, CAPE_ROWS - 1 - HEM_WIDTH / drop

    def is_hem(row, column):
        return row >= FINE_ROWS - 3 or column <= 1 or column >= FINE_COLUMNS - 2

    first = len(fine.vertices)
    for side in (1, -1):
        for row in range(FINE_ROWS):
            for column in range(FINE_COLUMNS):
                place, normal = cape_frame(rows[row], columns[column])
                thickness = HEM_THICKNESS if is_hem(row, column) else THICKNESS
                # The rim is round: both layers end at half the thickness.
                if row == FINE_ROWS - 1 or column in (0, FINE_COLUMNS - 1):
                    thickness *= 0.5
                fine.vertices.append(place + normal * (0.5 * side * thickness))

    def vertex(side, row, column):
        return first + (side * FINE_ROWS + row) * FINE_COLUMNS + column

    for row in range(FINE_ROWS - 1):
        for column in range(FINE_COLUMNS - 1):
            is_trim = row >= FINE_ROWS - 3 or column == 0 or column == FINE_COLUMNS - 2
            color = TRIM_COLOR if is_trim else CLOTH_COLOR
            corners = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)]
            fine.face([vertex(0, *corner) for corner in corners], color)
            fine.face([vertex(1, *corner) for corner in reversed(corners)], color)
    rim = [(row, 0) for row in range(FINE_ROWS)] + [(FINE_ROWS - 1, column) for column in range(1, FINE_COLUMNS)]
    rim += [(row, FINE_COLUMNS - 1) for row in reversed(range(FINE_ROWS - 1))]
    rim += [(0, column) for column in reversed(range(1, FINE_COLUMNS - 1))]
    for here, there in zip(rim, rim[1:] + rim[:1]):
        color = CLOTH_COLOR if here[0] == there[0] == 0 else TRIM_COLOR
        fine.face((vertex(0, *here), vertex(0, *there), vertex(1, *there), vertex(1, *here)), color)


def add_collar(fine):
    """A roll along the upper edge."""
    rings = []
    for column in range(FINE_COLUMNS):
        at = column * (CAPE_COLUMNS - 1) / (FINE_COLUMNS - 1)
        place, normal = cape_frame(0.25, at)
        along = (cape_point(0.25, at + 0.01) - cape_point(0.25, at - 0.01)).normalized()
        up = along.cross(normal)
        # It is thinner at its ends.
        end = min(column, FINE_COLUMNS - 1 - column) / 8
        radius = COLLAR_RADIUS * (0.55 + 0.45 * min(1.0, end))
        rings.append([place + radius * (math.cos(angle) * normal + math.sin(angle) * up)
                      for angle in (2 * math.pi * corner / COLLAR_CORNERS for corner in range(COLLAR_CORNERS))])
    fine.tube(rings, CLOTH_COLOR, True)


def add_clasps(fine):
    """A flat knob on each end of the collar."""
    for column in (1.0, CAPE_COLUMNS - 2.0):
        place, normal = cape_frame(0.9, column)
        along = normal.cross(Vector((0, 0, 1))).normalized()
        up = normal.cross(along)
        rings = []
        for height, share in ((0.0, 1.0), (0.55, 1.0), (0.9, 0.8), (1.0, 0.45)):
            middle = place + normal * (0.5 * HEM_THICKNESS + CLASP_HEIGHT * height)
            rings.append([middle + CLASP_RADIUS * share * (math.cos(angle) * along + math.sin(angle) * up)
                          for angle in (2 * math.pi * corner / CLASP_CORNERS for corner in range(CLASP_CORNERS))])
        fine.tube(rings, TRIM_COLOR, True)


def make_fine_cape():
    fine = FineCape()
    add_layers(fine)
    add_collar(fine)
    add_clasps(fine)
    mesh = new_mesh("CapeFine", fine.vertices, fine.faces)
    mesh.validate()
    layer = mesh.uv_layers.new(name="Trim")
    for polygon, color in zip(mesh.polygons, fine.colors):
        polygon.use_smooth = True
        for loop in polygon.loop_indices:
            layer.data[loop].uv = color
    material = bpy.data.materials.new("CapeFine")
    mesh.materials.append(material)
    bpy.context.collection.objects.link(bpy.data.objects.new("CapeFine", mesh))


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
    make_fine_cape()
    animate(rig)
    export(sys.argv[sys.argv.index("--") + 1], sampled=True, texture_coordinates=True)


if __name__ == "__main__":
    main()
