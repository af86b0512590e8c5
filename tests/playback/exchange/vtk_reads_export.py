#!/usr/bin/env python3
"""VTK's own reader opens the VTP series of weft export and finds the numbers of the recording's point cache.

usage: vtk_reads_export.py WEFT (exit status 77: VTK's Python package is not here)
"""
import shutil
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

# The system's Python has Debian's package python3-vtk9, another one in front of it need not.
try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError:
    system = "/usr/bin/python3"
    if Path(sys.executable).resolve() != Path(system).resolve() and shutil.which(system):
        sys.exit(subprocess.run([system, *sys.argv]).returncode)
    print("skipped: VTK's Python package is not here (Debian: python3-vtk9)")
    sys.exit(77)


def read_point_cache(path):
    data = path.read_bytes()
    points, _, _, samples = struct.unpack_from("<iffi", data, 16)
    values = struct.unpack_from(f"<{3 * points * samples}f", data, 32)
    return points, samples, values


def read_surface(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def main():
    weft = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run = lambda *words: subprocess.run([weft, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        run("run", "ball_on_cloth", "-e", "reference", "--duration", "0.2 s", "-o", "a.weftrec")
        run("export", "--vtp", "series", "--pc2", "caches", "a.weftrec")
        sets = list(ElementTree.parse(folder / "series/series.pvd").getroot().iter("DataSet"))
        times = sorted({float(item.get("timestep")) for item in sets})
        assert len(times) > 3 and times[0] == 0.0 and abs(times[-1] - 0.2) < 1e-3, times
        largest_strain = 0.0
        for item in sets:
            points, samples, values = read_point_cache(folder / "caches" / (item.get("name") + ".pc2"))
            assert samples == len(times)
            frame = times.index(float(item.get("timestep")))
            surface = read_surface(folder / "series" / item.get("file"))
            assert surface.GetNumberOfPoints() == points and surface.GetNumberOfPolys() > 0
            for i in range(points):
                expected = values[3 * (points * frame + i) : 3 * (points * frame + i + 1)]
                assert max(abs(a - b) for a, b in zip(surface.GetPoint(i), expected)) < 1e-6, (item.get("file"), i)
            fields = surface.GetPointData()
            assert fields.GetArray("velocity_m_s").GetNumberOfComponents() == 3
            if fields.GetArray("mass_kg") is None:
                continue
            masses = [fields.GetArray("mass_kg").GetValue(i) for i in range(points)]
            pins = [fields.GetArray("pinned").GetValue(i) for i in range(points)]
            assert min(masses) > 0 and 0 < sum(pins) < points and set(pins) == {0.0, 1.0}
            largest_strain = max(largest_strain, fields.GetArray("strain").GetRange()[1])
        assert largest_strain > 0, "the cloth hangs, so it is stretched"
        print(f"{len(sets)} files, {len(times)} times: VTK reads what the recording holds")


if __name__ == "__main__":
    main()
