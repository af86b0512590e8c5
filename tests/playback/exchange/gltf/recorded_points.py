"""The numbers of a recording as weft export --vtp writes them, read with the standard library and NumPy: what other files are held against."""
import base64
import xml.etree.ElementTree as ElementTree

import numpy

TYPES = {"Float64": "<f8", "Float32": "<f4", "Int32": "<i4"}


def array_of(element):
    data = base64.b64decode(element.text)
    values = numpy.frombuffer(data, TYPES[element.get("type")], offset=8)
    return values.reshape(-1, int(element.get("NumberOfComponents")))


class RecordedPoints:
    """Points [m] and triangles of every body in every frame of a VTP series."""

    def __init__(self, folder):
        self.times, self.points, self.triangles = [], {}, {}
        for item in ElementTree.parse(folder / "series.pvd").getroot().iter("DataSet"):
            time = float(item.get("timestep"))
            if not self.times or self.times[-1] != time:
                self.times.append(time)
            root = ElementTree.parse(folder / item.get("file")).getroot()
            name = item.get("name")
            self.points.setdefault(name, []).append(array_of(root.find(".//Points/DataArray")).astype(float))
            cells = root.find(".//Polys/DataArray[@Name='connectivity']")
            self.triangles.setdefault(name, []).append(array_of(cells).reshape(-1, 3))

    def of_last_nodes(self, name, values=None):
        """The points of the nodes of the last frame in every frame, frames x nodes x 3: a node that tears later is still the one it was torn from."""
        values = self.points[name] if values is None else values
        last = self.triangles[name][-1]
        result = []
        for points, triangles in zip(values, self.triangles[name]):
            moved = numpy.full((len(values[-1]), 3), numpy.nan)
            moved[last.ravel()] = points[triangles.ravel()]
            result.append(moved)
        return numpy.array(result)

    def normals(self, name):
        """Unit normals of the nodes in every frame, weighted by the areas of the triangles."""
        result = []
        for points, triangles in zip(self.points[name], self.triangles[name]):
            a, b, c = (points[triangles[:, k]] for k in range(3))
            sums = numpy.zeros_like(points)
            for k in range(3):
                numpy.add.at(sums, triangles[:, k], numpy.cross(b - a, c - a))
            with numpy.errstate(invalid="ignore"):
                result.append(sums / numpy.linalg.norm(sums, axis=1, keepdims=True))
        return result
