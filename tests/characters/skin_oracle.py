#!/usr/bin/env python3
"""Evaluates the skin of a .glb file from nothing but the glTF 2.0 text: an oracle for tests/characters/skinning_test.cpp.

    skin_oracle.py model.glb             writes a table: part, vertex of the file, time [s], x, y, z [m]
    skin_oracle.py model.glb table.txt  compares with a table that was written before; fails if a number differs

Standard library only. It shares no line with the C++ reader: matrices are lists, quaternions are tuples (x, y, z, w).
Some vertices of each primitive, at times that fall on keys, between keys and behind the end.
"""
import base64
import json
import math
import struct
import sys

COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TIMES = (0.0, 0.1, 0.25, 0.333, 0.8125, 1.37, 5.0)
VERTICES = 16  # of each primitive, about
DIGITS_APART = 2e-9  # tables have nine digits after the point


def load(path):
    data = open(path, "rb").read()
    if data[:4] != b"glTF":
        model = json.loads(data)
        return model, [base64.b64decode(buffer["uri"].split(",", 1)[1]) for buffer in model["buffers"]]
    magic, version, _ = struct.unpack_from("<4sII", data, 0)
    assert magic == b"glTF" and version == 2, path
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    return json.loads(data[20 : 20 + size]), [data[20 + size + 8 :]]


def elements(model, buffers, index):
    accessor = model["accessors"][index]
    view = model["bufferViews"][accessor["bufferView"]]
    binary = buffers[view["buffer"]]
    count = SIZES[accessor["type"]]
    layout = "<" + str(count) + COMPONENTS[accessor["componentType"]]
    step = view.get("byteStride", struct.calcsize(layout))
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    rows = [struct.unpack_from(layout, binary, start + i * step) for i in range(accessor["count"])]
    if accessor.get("normalized"):
        largest = {5121: 255.0, 5123: 65535.0}[accessor["componentType"]]
        rows = [tuple(value / largest for value in row) for row in rows]
    return rows


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def from_columns(numbers):
    return [[numbers[4 * column + row] for column in range(4)] for row in range(4)]


def from_parts(translation, rotation, scale):
    x, y, z, w = rotation
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    rows = [[turn[i][j] * scale[j] for j in range(3)] + [translation[i]] for i in range(3)]
    return rows + [[0.0, 0.0, 0.0, 1.0]]


def unit(q):
    length = math.sqrt(sum(c * c for c in q))
    return tuple(c / length for c in q)


def slerp(a, b, part):
    dot = sum(p * q for p, q in zip(a, b))
    if dot < 0:
        b, dot = tuple(-c for c in b), -dot
    angle = math.acos(min(1.0, dot))
    if angle < 1e-6:
        return unit(tuple(p + part * (q - p) for p, q in zip(a, b)))
    s = math.sin(angle)
    return tuple(math.sin((1 - part) * angle) / s * p + math.sin(part * angle) / s * q for p, q in zip(a, b))


def sample(model, binary, sampler, path, time):
    times = [t for (t,) in elements(model, binary, sampler["input"])]
    values = elements(model, binary, sampler["output"])
    kind = sampler.get("interpolation", "LINEAR")
    at = (lambda k: values[3 * k + 1]) if kind == "CUBICSPLINE" else (lambda k: values[k])
    finish = unit if path == "rotation" else tuple
    if time <= times[0]:
        return finish(at(0))
    if time >= times[-1]:
        return finish(at(len(times) - 1))
    key = max(k for k in range(len(times)) if times[k] <= time)
    span = times[key + 1] - times[key]
    s = (time - times[key]) / span
    if kind == "STEP":
        return finish(at(key))
    if kind == "CUBICSPLINE":
        out_tangent, in_tangent = values[3 * key + 2], values[3 * key + 3]
        weights = (2 * s**3 - 3 * s**2 + 1, span * (s**3 - 2 * s**2 + s), -2 * s**3 + 3 * s**2, span * (s**3 - s**2))
        rows = (at(key), out_tangent, at(key + 1), in_tangent)
        return finish(tuple(sum(w * row[i] for w, row in zip(weights, rows)) for i in range(len(rows[0]))))
    if path == "rotation":
        return slerp(unit(at(key)), unit(at(key + 1)), s)
    return tuple(p + s * (q - p) for p, q in zip(at(key), at(key + 1)))


def frames(model, binary, animation, time):
    moved = {}
    for channel in animation["channels"]:
        target = channel["target"]
        sampler = animation["samplers"][channel["sampler"]]
        moved.setdefault(target["node"], {})[target["path"]] = sample(model, binary, sampler, target["path"], time)
    parent = {child: n for n, node in enumerate(model["nodes"]) for child in node.get("children", [])}

    def place(index):
        node = model["nodes"][index]
        if "matrix" in node:
            local = from_columns(node["matrix"])
        else:
            given = {**node, **moved.get(index, {})}
            local = from_parts(
                given.get("translation", (0, 0, 0)), given.get("rotation", (0, 0, 0, 1)), given.get("scale", (1, 1, 1)))
        return product(place(parent[index]), local) if index in parent else local

    return [place(n) for n in range(len(model["nodes"]))]


def table(path):
    model, binary = load(path)
    lines = []
    for time in TIMES:
        placed = frames(model, binary, model["animations"][0], time)
        for number, node in enumerate(model["nodes"]):
            if "skin" not in node:
                continue
            name = node.get("name", f"node_{number}")
            skin = model["skins"][node["skin"]]
            binds = [from_columns(m) for m in elements(model, binary, skin["inverseBindMatrices"])]
            matrices = [product(placed[joint], bind) for joint, bind in zip(skin["joints"], binds)]
            for primitive in model["meshes"][node["mesh"]]["primitives"]:
                attributes = primitive["attributes"]
                positions = elements(model, binary, attributes["POSITION"])
                joints = elements(model, binary, attributes["JOINTS_0"])
                weights = elements(model, binary, attributes["WEIGHTS_0"])
                for v in range(0, len(positions), max(1, len(positions) // VERTICES)):
                    total = sum(weights[v])
                    point = [0.0, 0.0, 0.0]
                    for joint, weight in zip(joints[v], weights[v]):
                        matrix = matrices[joint]
                        for i in range(3):
                            moved = sum(matrix[i][k] * positions[v][k] for k in range(3)) + matrix[i][3]
                            point[i] += weight / total * moved
                    bind = " ".join(f"{c:.9f}" for c in positions[v])
                    lines.append(f"{name} {bind} {time:.4f} " + " ".join(f"{c:.9f}" for c in point))
    return lines


def main():
    lines = table(sys.argv[1])
    if len(sys.argv) < 3:
        print("\n".join(lines))
        return
    known = open(sys.argv[2], encoding="utf-8").read().splitlines()
    assert len(lines) == len(known), f"{len(lines)} lines, expected {len(known)}"
    for number, (line, other) in enumerate(zip(lines, known), 1):
        numbers = [[float(word) for word in text.split()[1:]] for text in (line, other)]
        worst = max(abs(a - b) for a, b in zip(*numbers))
        assert line.split()[0] == other.split()[0] and worst <= DIGITS_APART, f"line {number}: {line} is not {other}"
    print(f"skin_oracle: {len(lines)} places agree")


if __name__ == "__main__":
    main()
