"""Builds scenes/models/sock_puppet.glb: a hand without a body in a sock. For Blender 3.4 (Debian 12):

    blender -b -P tools/models/make_sock_puppet.py -- scenes/models/sock_puppet.glb

The sock is one surface: up the forearm, around the bend of the wrist, over the head to the lips, and from there back into
the mouth as far as the throat. Four bones are the hand. The vertex colours say how free the cloth is: black where the hand
or a seam holds it (wrist, knuckles, jaws, lips, eyes), brighter with the distance from there. The clip "Perform" of 4 seconds
looks around, nods, and opens and closes the mouth. Lengths are metres; Blender's z is up, the puppet looks along -y.
"""
import math
import os
import sys

import bpy
from mathutils import Euler, Vector

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
from rig import add_skinned, empty_scene, export, make_armature, new_mesh  # beside this file

FRAMES_PER_SECOND = 24
CLIP_FRAMES = 96  # 4 s

COLUMNS = 20  # around the arm; column 0 is its left side, the first half goes over the back and the upper jaw
HALF = COLUMNS // 2
ARM_RINGS, BEND_RINGS, HEAD_RINGS, MOUTH_RINGS = 13, 7, 11, 5

ARM_RADIUS, ARM_HEIGHT = 0.037, 0.17
BEND_RADIUS = 0.058
HEAD_HEIGHT = ARM_HEIGHT + BEND_RADIUS  # of the line that the jaws turn about
HEAD_BACK = BEND_RADIUS  # how far the head begins in front of the forearm's middle
HINGE = HEAD_BACK + 0.06  # corners of the mouth
HEAD_WIDTH = 0.050  # half

# Of the upper and the lower half: length of the jaw, height of the head, slope of the open jaw at rest.
UPPER = (0.100, 0.043, math.tan(math.radians(10)))
LOWER = (0.086, 0.037, -math.tan(math.radians(14)))

EYE_RADIUS = 0.0165
EYES = [Vector((side * 0.026, -(HINGE + 0.012), HEAD_HEIGHT + 0.043)) for side in (1, -1)]

REACH = 0.04  # distance from what is held at which the paint is white

# name: (head, tail, parent)
BONES = {
    "Wrist": ((0, 0, 0), (0, 0, ARM_HEIGHT), None),
    "Palm": ((0, 0, HEAD_HEIGHT - 0.01), (0, -HINGE, HEAD_HEIGHT), "Wrist"),
    "UpperJaw": ((0, -HINGE, HEAD_HEIGHT), (0, -HINGE - UPPER[0], HEAD_HEIGHT), "Palm"),
    "LowerJaw": ((0, -HINGE, HEAD_HEIGHT), (0, -HINGE - LOWER[0], HEAD_HEIGHT), "Palm"),
}


def smooth_step(x):
    x = min(1.0, max(0.0, x))
    return x * x * (3 - 2 * x)


def lip(column):
    """Forward, sideways and up from the middle between the corners of the mouth."""
    angle = 2 * math.pi * column / COLUMNS
    length, _, slope = UPPER if column <= HALF else LOWER
    forward = length * abs(math.sin(angle)) ** 0.7 if column % HALF else 0.0
    return forward, HEAD_WIDTH * math.cos(angle), slope * forward


def arm_point(ring, column):
    """The forearm and the bend: rings across a line that goes up and then forward."""
    angle = 2 * math.pi * column / COLUMNS
    along = min(1.0, ring / (ARM_RINGS - 1))
    turn = 0.5 * math.pi * max(0, ring - ARM_RINGS + 1) / BEND_RINGS
    middle = Vector((0, -BEND_RADIUS * (1 - math.cos(turn)), ARM_HEIGHT * along + BEND_RADIUS * math.sin(turn)))
    back = Vector((0, math.cos(turn), math.sin(turn)))
    share = turn / (0.5 * math.pi)  # the wrist widens to the palm
    height = (UPPER if column <= HALF else LOWER)[1]
    width = ARM_RADIUS + (0.046 - ARM_RADIUS) * share
    depth = ARM_RADIUS + (height - ARM_RADIUS) * share
    return middle + Vector((width * math.cos(angle), 0, 0)) + back * depth * math.sin(angle)


def head_point(ring, column):
    """A quarter of an ellipse from the palm's last ring to the lip."""
    back = arm_point(ARM_RINGS - 1 + BEND_RINGS, column)
    forward, side, up = lip(column)
    turn = 0.5 * math.pi * ring / HEAD_RINGS
    # At the sides the ellipse is flat: rings at equal distances there.
    round_share = abs(math.sin(2 * math.pi * column / COLUMNS))
    share = round_share * math.sin(turn) + (1 - round_share) * ring / HEAD_RINGS
    return Vector((back.x + (side - back.x) * (1 - math.cos(turn)),
                   -(HEAD_BACK + (HINGE + forward - HEAD_BACK) * share),
                   HEAD_HEIGHT + up + (back.z - HEAD_HEIGHT - up) * math.cos(turn)))


def mouth_point(ring, column):
    """From the lip to the throat, the line between the corners of the mouth."""
    forward, side, up = lip(column)
    share = 1 - ring / MOUTH_RINGS
    return Vector((side, -(HINGE + share * forward), HEAD_HEIGHT + share * up))


def sock_rows():
    """(kind, points of the ring) from the cuff to the throat."""
    rows = [("arm", [arm_point(r, c) for c in range(COLUMNS)]) for r in range(ARM_RINGS + BEND_RINGS)]
    rows += [("head", [head_point(r, c) for c in range(COLUMNS)]) for r in range(1, HEAD_RINGS + 1)]
    rows += [("mouth", [mouth_point(r, c) for c in range(COLUMNS)]) for r in range(1, MOUTH_RINGS + 1)]
    return rows


def bone_weights(row, column, point):
    bend = smooth_step((row - ARM_RINGS + 4) / (BEND_RINGS + 4))
    if bend < 1:
        return {"Wrist": 1 - bend, "Palm": bend}
    jaw = smooth_step((-point.y - HEAD_BACK) / (HINGE - HEAD_BACK))
    upper = smooth_step(0.5 + math.sin(2 * math.pi * column / COLUMNS) / 0.8)
    return {"Palm": 1 - jaw, "UpperJaw": jaw * upper, "LowerJaw": jaw * (1 - upper)}


def is_held(row, column, kind, point):
    """Where the hand or a seam holds the sock."""
    if row < 2:
        return True  # the wrist
    if kind == "arm":  # four places every few rings, and the knuckles at the end of the bend
        return row % 6 == 0 and column % 5 == 0 or row == ARM_RINGS + BEND_RINGS - 1 and column % 5 == 0
    lip_row = ARM_RINGS + BEND_RINGS + HEAD_RINGS - 1
    if row >= lip_row:
        return True  # the lips, and the mouth, which lies on the fingers
    if row == lip_row - 1 and abs(column % HALF - HALF // 2) <= 1:
        return True  # the tips of the jaws
    return any((point - eye).length < EYE_RADIUS + 0.004 for eye in EYES)


def stripe(kind, row):
    """Texture coordinate u of a row of faces, near and far end: Weft's pattern "stripes" has 8 pairs along u."""
    ground, figure = 0.25 / 8, 0.75 / 8
    if kind == "arm" and row < ARM_RINGS + 3:
        return row / 4 / 8, (row + 1) / 4 / 8  # a pair every four rings
    lip_row = ARM_RINGS + BEND_RINGS + HEAD_RINGS - 1
    return (figure, figure) if row >= lip_row - 1 else (ground, ground)


class Sock:
    """The surface's lists, with vertices that fall together made one."""

    def __init__(self):
        self.vertices, self.groups, self.held, self.faces, self.texture = [], [], [], [], []
        self.number = {}
        rows = sock_rows()
        self.at = [[self.vertex(r, c, kind, points[c]) for c in range(COLUMNS)] for r, (kind, points) in enumerate(rows)]
        for row in range(len(rows) - 1):
            for column in range(COLUMNS):
                self.add_quad(row, column, rows[row][0])

    def vertex(self, row, column, kind, point):
        key = tuple(round(x, 6) for x in point)
        if key not in self.number:
            self.number[key] = len(self.vertices)
            self.vertices.append(point)
            self.groups.append({b: w for b, w in bone_weights(row, column, point).items() if w > 0})
            self.held.append(is_held(row, column, kind, point))
        return self.number[key]

    def add_quad(self, row, column, kind):
        right = (column + 1) % COLUMNS
        near, far = stripe(kind, row)
        corners = [(self.at[row][column], near), (self.at[row][right], near), (self.at[row + 1][right], far),
                   (self.at[row + 1][column], far)]
        # Diagonals that alternate, so that the cloth has no preferred direction; front faces outward.
        odd = (row + column) % 2
        for picked in ((0, 1, 2), (0, 2, 3)) if odd else ((0, 1, 3), (1, 2, 3)):
            triangle = [corners[p] for p in picked]
            if len({v for v, _ in triangle}) == 3:  # at the corners of the mouth quads shrink
                self.faces.append([v for v, _ in triangle])
                self.texture += [(u, 0.5) for _, u in triangle]


def make_mesh(name, vertices, faces, groups, texture, rig):
    mesh = new_mesh(name, vertices, faces)
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, place in enumerate(texture):
        layer.data[loop].uv = place
    return add_skinned(name, mesh, groups, rig)


def make_sock(rig):
    sock = Sock()
    thing = make_mesh("Sock", sock.vertices, sock.faces, sock.groups, sock.texture, rig)
    held = [v for v, is_black in zip(sock.vertices, sock.held) if is_black]
    layer = thing.data.color_attributes.new(name="MaxDistance", type="BYTE_COLOR", domain="POINT")
    for vertex, point in enumerate(sock.vertices):
        distance = 0.0 if sock.held[vertex] else min((point - h).length for h in held)
        share = min(1.0, distance / REACH)
        layer.data[vertex].color = (share, share, share, 1.0)


def make_eyes(rig):
    """Buttons on the upper jaw that look forward and a little up."""
    vertices, faces, groups, texture, places = [], [], [], [], []
    rings, corners = 12, 16
    for eye in EYES:
        axis = Vector((0.18 * (1 if eye.x > 0 else -1), -1, 0.30)).normalized()
        side = axis.cross(Vector((0, 0, 1))).normalized()
        up = side.cross(axis)
        first = len(vertices)
        for ring in range(rings + 1):
            angle = math.pi * ring / rings
            # A dot of the pattern "dots" has radius 0.27 of a cell, 1/8: here it spans 40 degrees.
            radius = min(0.5, 0.27 * angle / math.radians(40)) / 8
            for corner in range(corners if 0 < ring < rings else 1):
                turn = 2 * math.pi * corner / corners
                across = side * math.cos(turn) + up * math.sin(turn)
                vertices.append(eye + EYE_RADIUS * (axis * math.cos(angle) + across * math.sin(angle)))
                places.append((4.5 / 8 + radius * math.cos(turn), 4.5 / 8 + radius * math.sin(turn)))
                groups.append({"UpperJaw": 1.0})
        at = lambda ring, corner: (first if ring == 0 else len(vertices) - 1 if ring == rings
                                   else first + 1 + (ring - 1) * corners + corner % corners)
        for ring in range(rings):
            for corner in range(corners):
                a, b = at(ring, corner), at(ring, corner + 1)
                c, d = at(ring + 1, corner + 1), at(ring + 1, corner)
                faces += [f for f in ((a, d, c), (a, c, b)) if len(set(f)) == 3]
    texture = [places[v] for face in faces for v in face]
    make_mesh("Eyes", vertices, faces, groups, texture, rig)


def key(rig, bone, axes):
    """Turns a bone by Euler angles [deg], each a list at equal times over the clip."""
    pose = rig.pose.bones[bone]
    pose.rotation_mode = "QUATERNION"
    count = len(next(iter(axes.values())))
    for number in range(count):
        turn = [math.radians(axes.get(axis, [0] * count)[number]) for axis in "xyz"]
        pose.rotation_quaternion = Euler(turn, "YXZ").to_quaternion()
        pose.keyframe_insert("rotation_quaternion", frame=1 + round(number * CLIP_FRAMES / (count - 1)))


def animate(rig):
    rig.animation_data_create()
    rig.animation_data.action = bpy.data.actions.new("Perform")
    # Every half second: looks to its left, to its right, nods twice, then speaks.
    key(rig, "Wrist", {"y": [0, 32, 38, -10, -36, -24, 0, 0, 0], "x": [0, -6, 0, 5, 0, -4, 6, -4, 0],
                       "z": [0, 7, 4, 0, -7, -4, 0, 0, 0]})
    # Every quarter second. The palm's own x points sideways: positive bends it down.
    key(rig, "Palm", {"x": [0, 0, -4, -6, 0, 0, -4, -6, 0, 0, -10, 28, -8, 28, -6, -4, 0],
                      "y": [0, 4, 10, 8, 0, -4, -10, -8, 0, 0, 0, 0, 0, 0, 0, 0, 0]})
    opening = [0, 0, 0.4, -0.7, 0.4, 0, 0.4, -0.7, 0.3, 1, -0.7, -0.5, 0, -0.5, 1, -0.7, 0]
    key(rig, "UpperJaw", {"x": [12 * o for o in opening]})
    key(rig, "LowerJaw", {"x": [-16 * o for o in opening]})
    wrist = rig.pose.bones["Wrist"]
    for number, height in enumerate([0, 0.02, 0, 0.02, 0, 0.025, 0, 0.025, 0]):
        wrist.location = ((0, 0.02, 0.03, 0, -0.03, -0.02, 0, 0, 0)[number], height, 0)
        wrist.keyframe_insert("location", frame=1 + round(number * CLIP_FRAMES / 8))


def main():
    empty_scene(FRAMES_PER_SECOND, 1, 1 + CLIP_FRAMES)
    rig = make_armature("Hand", BONES)
    make_sock(rig)
    make_eyes(rig)
    animate(rig)
    # Splines: no bone of the hand points against its parent.
    export(sys.argv[sys.argv.index("--") + 1], sampled=False, texture_coordinates=True)


if __name__ == "__main__":
    main()
