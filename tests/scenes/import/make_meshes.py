#!/usr/bin/env python3
"""Writes the mesh files of good/ and broken/: small ones, one fault each. They are kept in the repository; run this
again after a change here."""
import base64
import json
import struct
from pathlib import Path

HERE = Path(__file__).resolve().parent

# A unit square of four triangles around its middle, front up.
SQUARE = """v 0 0 0
v 1 0 0
v 1 0 -1
v 0 0 -1
v 0.5 0 -0.5
"""
FACES = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"
# Vertices and outward triangles of a tetrahedron.
CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
SIDES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]

# A PLY file with bytes changed here and there.
STRANGE_HEADER = (
    b'ply\nformat ascii 1\x000\nelement vertex 4\nproperty flo\x7ft x\nprop\xf6rty\x83'
    b'float y\nproperty float`z*element face 4\nprop\x80rtyYlist uchar int '
    b'verte\xff_indices\nend_h\x80ader\n0 0 \x80\x081 0 0\xda0 1\xff0\n\x80 0 1\n3 0 2 -1\n3 0 1'
    b' 3\n3 0 3\xff2\n3 1 2 3\n')


def gltf(indices=SIDES, nodes=None, bin_uri=None, **changes):
    """A glTF file of the tetrahedron with its data inside."""
    positions = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)
    index = b"".join(struct.pack("<3H", *side) for side in indices)
    data = positions + index
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes or [{"name": "tent", "mesh": 0}],
        "meshes": [{"name": "cover", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(positions)},
                        {"buffer": 0, "byteOffset": len(positions), "byteLength": len(index)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5123, "count": 3 * len(indices), "type": "SCALAR"}],
    }
    document.update(changes)
    if bin_uri != "":
        document["buffers"][0]["uri"] = (
            bin_uri or "data:application/octet-stream;base64," + base64.b64encode(data).decode())
    return document, data


def glb(document, data):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<2I", len(text), 0x4E4F534A) + text + struct.pack("<2I", len(data), 0x004E4942) + data
    return struct.pack("<3I", 0x46546C67, 2, 12 + len(chunks)) + chunks


def stl(sides):
    out = b"binary".ljust(80) + struct.pack("<I", len(sides))
    for side in sides:
        out += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *CORNERS[c]) for c in side) + b"\0\0"
    return out


def ply(vertices, faces, count=None):
    head = f"ply\nformat ascii 1.0\nelement vertex {count or len(vertices)}\n"
    head += "property float x\nproperty float y\nproperty float z\n"
    if faces:
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
    head += "end_header\n"
    rows = [" ".join(map(str, v)) for v in vertices] + [" ".join(map(str, (len(f), *f))) for f in faces]
    return head + "\n".join(rows) + "\n"


def write(name, content):
    path = HERE / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def main():
    whole = glb(*gltf(bin_uri=""))
    write("good/tetrahedron.glb", whole)
    write("good/tetrahedron.stl", stl(SIDES))
    write("good/tetrahedron.ply", ply(CORNERS, SIDES))
    write("good/square.obj", "o sheet\n" + SQUARE + "v 9 9 9\n" + FACES + "f 1 2 5\n")
    write("good/quad.obj", "o quad\nv 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n")
    two = "o left\n" + SQUARE + FACES + "o right\n" + "".join(
        f"v {x} 0 {z}\n" for x, z in ((2, 0), (3, 0), (3, -1), (2, -1))) + "f 6 7 8\nf 6 8 9\n"
    write("good/two_parts.obj", two)

    write("broken/empty.obj", "")
    write("broken/no_faces.obj", SQUARE)
    write("broken/truncated.glb", whole[:-60])
    write("broken/half.glb", whole[:40])
    write("broken/wrong_magic.glb", b"gltF" + whole[4:])
    write("broken/bad_index.gltf", json.dumps(gltf(indices=SIDES[:3] + [(1, 2, 900)])[0]))
    write("broken/bad_index.obj", SQUARE + "f 1 2 99\n")
    write("broken/nan.ply", ply([("nan", 0, 0), *CORNERS[1:]], SIDES))
    write("broken/infinite.stl", stl(SIDES).replace(struct.pack("<f", 1.0), struct.pack("<f", float("inf")), 1))
    write("broken/branching_edge.obj", "o fins\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n"
          "f 1 2 3\nf 1 2 4\nf 1 2 5\n")
    write("broken/bow_tie.obj", "o bow\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv -1 0 0\nv -1 0 -1\nf 1 2 3\nf 1 4 5\n")
    write("broken/flat_face.obj", "o flat\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 1\nf 1 4 2\nf 1 2 3\n")
    write("broken/collapsed_face.obj", "o thin\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 0 0\nf 1 3 2\nf 1 4 2\n")
    write("broken/repeated_corner.ply", ply(CORNERS, [(0, 2, 1), (0, 0, 3)]))
    write("broken/points_only.ply", ply(CORNERS, []))
    write("broken/lines_only.obj", SQUARE + "l 1 2\nl 2 3\n")
    write("broken/huge_count.ply", ply(CORNERS, SIDES, count=4000000000))
    write("broken/flipped.obj", "o flip\n" + SQUARE + "f 1 2 5\nf 2 3 5\nf 3 5 4\nf 4 1 5\n")
    write("broken/missing_buffer.gltf", json.dumps(gltf(bin_uri="not_there.bin")[0]))
    for name, uri in (("above", "../broken_cases.hpp"), ("elsewhere", "/etc/hostname"), ("of_no_buffer", "text.fbx")):
        write(f"broken/buffer_{name}.gltf", json.dumps(gltf(bin_uri=uri)[0]))
    # Headers of which assimp never finds the end.
    write("broken/header_cut_off.ply", "ply\nformat ascii ")
    write("broken/header_without_format.ply", b"ply\nformat ascii \x01\0\0\x008.")
    write("broken/header_without_end.ply",
          b"ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\npro\xff\xff\xff\x7fy floa")
    write("broken/header_with_strange_bytes.ply", STRANGE_HEADER)
    circle = [{"name": "a", "children": [1], "mesh": 0}, {"name": "b", "children": [0]}]
    write("broken/circle.gltf", json.dumps(gltf(nodes=circle)[0]))
    write("broken/no_such_mesh.gltf", json.dumps(gltf(nodes=[{"mesh": 7}])[0]))
    write("broken/text.fbx", "This is a letter, not a mesh.\n")
    write("broken/binary.obj", bytes(range(256)) * 4)
    write("broken/unknown.xyz", "0 0 0\n1 0 0\n")
    write("broken/huge_accessor.gltf", json.dumps(gltf(accessors=[
        {"bufferView": 0, "componentType": 5126, "count": 2000000000, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}])[0]))


main()
