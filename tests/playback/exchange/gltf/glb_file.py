"""Reads a .glb file as the glTF 2.0 specification says, with the standard library and NumPy, and nothing of Weft."""
import json
import struct

import numpy

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5125: numpy.dtype("<u4"), 5126: numpy.dtype("<f4")}


class GlbFile:
    """A whole file; everything that the specification demands of what Weft writes is checked on the way."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length = struct.unpack_from("<4sII", data, 0)
        assert (magic, version, length) == (b"glTF", 2, len(data)), (magic, version, length, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON" and size % 4 == 0, (kind, size)
        self.root = json.loads(data[20 : 20 + size].decode("utf-8"))
        begin = 20 + size
        size, kind = struct.unpack_from("<I4s", data, begin)
        assert kind == b"BIN\0" and size % 4 == 0 and begin + 8 + size == len(data), (kind, size)
        self.binary = data[begin + 8 :]
        assert len(self.root["buffers"]) == 1 and self.root["buffers"][0]["byteLength"] == len(self.binary)
        self.check_ranges()

    def accessor(self, index):
        """An array with a row for each element."""
        entry = self.root["accessors"][index]
        view = self.root["bufferViews"][entry["bufferView"]]
        kind, rows = TYPES[entry["componentType"]], COMPONENTS[entry["type"]]
        begin, size = view["byteOffset"], entry["count"] * rows * kind.itemsize
        assert begin % 4 == 0 and size == view["byteLength"] and begin + size <= len(self.binary), (index, entry, view)
        return numpy.frombuffer(self.binary, kind, entry["count"] * rows, begin).reshape(-1, rows)

    def check_ranges(self):
        for index, entry in enumerate(self.root["accessors"]):
            values = self.accessor(index)
            assert numpy.isfinite(values).all(), index
            assert entry["min"] == values.min(axis=0).tolist(), (index, entry)
            assert entry["max"] == values.max(axis=0).tolist(), (index, entry)

    def node(self, name):
        found = [i for i, node in enumerate(self.root["nodes"]) if node["name"] == name and "children" not in node]
        assert len(found) == 1, (name, found)
        return found[0]

    def keys(self, node, path):
        """Times and keys of what moves a node in this way; none if nothing does."""
        for animation in self.root.get("animations", []):
            for channel in animation["channels"]:
                if channel["target"] != {"node": node, "path": path}:
                    continue
                sampler = animation["samplers"][channel["sampler"]]
                assert sampler["interpolation"] == "LINEAR"
                return self.accessor(sampler["input"])[:, 0], self.accessor(sampler["output"])
        return None

    def morphed(self, name, attribute="POSITION", num_left_out=0):
        """Vectors of the vertices in every frame, frames x vertices x 3, in double precision; with fewer targets than there are on demand."""
        node = self.node(name)
        mesh = self.root["meshes"][self.root["nodes"][node]["mesh"]]
        (primitive,) = mesh["primitives"]
        base = self.accessor(primitive["attributes"][attribute]).astype(float)
        targets = primitive.get("targets", [])
        if not targets:
            return base[None]
        _, weights = self.keys(node, "weights")
        weights = weights.reshape(-1, len(targets)).astype(float)
        assert mesh["weights"] == weights[0].tolist(), "without its animation the file shows the first frame"
        assert weights.min() >= 0 and weights.max() <= 1, "Blender cuts off others"
        displacements = numpy.array([self.accessor(target[attribute]) for target in targets], float)
        used = len(targets) - num_left_out
        return base + numpy.tensordot(weights[:, :used], displacements[:used], 1)

    def vertex_nodes(self, name):
        mesh = self.root["meshes"][self.root["nodes"][self.node(name)]["mesh"]]
        return self.accessor(mesh["primitives"][0]["attributes"]["_NODE"])[:, 0].astype(int)
