"""Meshes of arrays, grids, spheres, ropes and files."""
import os
import tempfile
import unittest

import numpy as np
import weft
from support import main

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1)], dtype=float)
HALVES = np.array([(0, 1, 2), (0, 2, 3)])


class Meshes(unittest.TestCase):
    def test_a_grid_is_what_it_says(self):
        mesh = weft.grid((4, 3), (3, 2), 0.6, center=(1, 2, 3), pins=[-1, 0])
        self.assertEqual(len(mesh), 12)
        x = mesh.vertices
        np.testing.assert_allclose(x[0], (-0.5, 2, 4))
        np.testing.assert_allclose(x[1] - x[0], (1, 0, 0))
        np.testing.assert_allclose(x[4] - x[0], (0, 0, -1))
        self.assertAlmostEqual(mesh.masses.sum(), 0.6)
        self.assertEqual(mesh.pins, [0, 11])
        self.assertEqual(mesh.triangles.shape, (12, 3))
        self.assertEqual(set(mesh.edge_sets), {"stretch", "shear", "bend"})
        self.assertEqual(mesh.edge_sets["stretch"].shape, (17, 2))
        self.assertEqual(set(weft.grid((4, 3), (3, 2), 1, stencil="8-neighbor").edge_sets), {"stretch", "shear"})
        x[:] = 0  # a copy
        self.assertGreater(np.abs(mesh.vertices).max(), 1)
        self.assertEqual(repr(mesh), "<weft.Mesh: 12 nodes, 12 triangles, 66 edges, 0.6 kg>".replace("66", str(sum(map(len, mesh.edge_sets.values())))))

    def test_arrays_of_any_kind_and_order(self):
        for vertices in (SQUARE, SQUARE.astype(np.float32), np.asfortranarray(SQUARE), SQUARE.tolist(), np.repeat(SQUARE, 2, axis=0)[::2], SQUARE.astype(int)):
            for triangles in (HALVES, HALVES.astype(np.int32), HALVES.astype(np.uint8), HALVES.tolist(), np.asfortranarray(HALVES)):
                mesh = weft.surface(vertices, triangles, 2.0)
                np.testing.assert_array_equal(mesh.vertices, SQUARE)
                np.testing.assert_array_equal(mesh.triangles, HALVES)
        np.testing.assert_allclose(mesh.masses, np.array([2, 1, 2, 1]) / 3)

    def test_spheres_and_ropes(self):
        ball = weft.sphere(2.0, 3.0, center=(0, 1, 0), frequency=3, center_mass_share=0.1)
        self.assertEqual(len(ball), 93)
        np.testing.assert_allclose(np.linalg.norm(ball.vertices[:-1] - (0, 1, 0), axis=1), 2)
        rope = weft.rope(11, (0, 0, 0), (1, 0, 0), 0.1, lumping="uniform")
        np.testing.assert_allclose(rope.masses, 0.1 / 11)
        self.assertEqual(rope.triangles.shape, (0, 3))

    def test_node_sets(self):
        mesh = weft.grid((3, 3), (1, 1), 1)
        mesh.add_node_set("hem", [8, 7, -3])
        self.assertEqual(mesh.node_sets, {"hem": [6, 7, 8]})
        with self.assertRaisesRegex(ValueError, "node set 'hem' already"):
            mesh.add_node_set("hem", [1])

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "square.obj")
            with open(path, "w") as file:
                file.write("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n")
            vertices, triangles = weft.read_mesh(path, scale=0.5, up="z")
            self.assertEqual((vertices.shape, triangles.shape), ((4, 3), (2, 3)))
            np.testing.assert_allclose(vertices.max(axis=0) - vertices.min(axis=0), (1, 0, 1))
            self.assertEqual(len(weft.surface(vertices, triangles, 1.0)), 4)
            with self.assertRaisesRegex(ValueError, "up = 'x', expected one of y, z"):
                weft.read_mesh(path, up="x")
        with self.assertRaisesRegex(ValueError, "nowhere.obj"):
            weft.read_mesh("/nowhere.obj")

    def test_what_is_refused(self):
        nan = SQUARE.copy()
        nan[2, 1] = np.nan
        cases = ((lambda: weft.surface(SQUARE[:, :2], HALVES, 1), r"surface: vertices has the shape \(4, 2\), expected \(n, 3\)"),
                 (lambda: weft.surface(nan, HALVES, 1), r"surface: vertices: number 7 = nan \[m\], expected a finite one"),
                 (lambda: weft.surface("abc", HALVES, 1), "surface: vertices is no array of numbers"),
                 (lambda: weft.surface(SQUARE * 1j, HALVES, 1), "vertices is no array of numbers, but complex128"),
                 (lambda: weft.surface([[1, 2, 3], [1, 2]], HALVES, 1), "vertices is no array of numbers"),
                 (lambda: weft.surface(SQUARE, HALVES * 1.0, 1), "triangles is no array of whole numbers, but float64"),
                 (lambda: weft.surface(SQUARE, HALVES - 1, 1), r"triangles\[0, 0\] = -1, expected a node from 0 to 3"),
                 (lambda: weft.surface(SQUARE, HALVES + 2**40, 1), "triangles"), (lambda: weft.surface(SQUARE, HALVES.ravel(), 1), r"\(6,\), expected \(t, 3\)"),
                 (lambda: weft.surface(SQUARE, HALVES[:1], 1), "node 3"), (lambda: weft.surface(SQUARE, HALVES, 0), "mass"),
                 (lambda: weft.surface(SQUARE, HALVES, 1, pins=[4]), r"surface: pins\[0\] = 4, expected a node from -4 to 3"),
                 (lambda: weft.surface(SQUARE, HALVES, 1, lumping="heap"), "lumping = 'heap', expected one of area, uniform"),
                 (lambda: weft.grid((3, 3), (1, 1), 1, stencil="9"), "stencil = '9', expected one of 24-neighbor"),
                 (lambda: weft.grid((3, 3), (1, -1), 1), "size"), (lambda: weft.sphere(-1, 1), "radius"), (lambda: weft.rope(1, (0, 0, 0), (1, 0, 0), 1), "nodes"))
        for call, message in cases:
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()


if __name__ == "__main__":
    main()
