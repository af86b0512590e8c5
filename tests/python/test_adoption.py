"""Bodies that Bullet's own calls make of arrays, and that Weft adopts."""
import unittest

import numpy as np
import weft
from support import LAWS, main, sheet, world

MESH = sheet(21)


class Adoption(unittest.TestCase):
    def setUp(self):
        self.world = world()

    def adopt(self, **options):
        return self.world.adopt(MESH.vertices, MESH.triangles, 0.2, **options)

    def test_it_hangs_by_its_pins(self):
        cloth = self.adopt(stiffness=1000.0, pins=[0, 20], laws={"velocity_damping": {"rate": 1.0}})
        self.assertEqual(cloth.pins, [0, 20])
        self.world.step(1 / 60, steps=300)
        x = np.asarray(cloth.positions)
        np.testing.assert_allclose(x[[0, 20]], MESH.vertices[[0, 20]], atol=1e-6)
        self.assertAlmostEqual(x[:, 1].min(), -1, delta=0.05)
        self.assertEqual([law.name for law in cloth.laws], ["tension", "velocity_damping", "gravity"])

    def test_the_report_says_what_became_of_each_property(self):
        report = self.adopt(link_factor=0.5, bending_factor=0.1, friction=0.7, cloth_collision=True).adoption
        fates = {what: (fate, how) for what, fate, how in report}
        links = [what for what in fates if "links" in what]
        self.assertEqual(len(links), 2)
        self.assertTrue(all(fates[what][0] == "mapped" for what in links))
        self.assertEqual(fates["441 nodes"][0], "kept")
        self.assertIn("contact VF_SS", fates)

    def test_it_moves_alike_for_any_number_of_iterations_if_the_stiffness_is_given(self):
        def depth(iterations):
            a_world = world()
            cloth = a_world.adopt(MESH.vertices, MESH.triangles, 0.2, stiffness=200.0, iterations=iterations, pins=[0, 20])
            a_world.step(1 / 60, steps=60)
            return cloth.positions.copy()

        np.testing.assert_array_equal(depth(1), depth(50))

    def test_it_shares_memory_and_takes_other_laws(self):
        cloth = self.adopt(stiffness=1000.0, pins=[0, 20])
        x = cloth.positions
        self.world.step(1 / 60, steps=60)
        lowest = x[:, 1].min()
        cloth.set("tension", stiffness=10.0)
        self.world.step(1 / 60, steps=120)
        self.assertLess(x[:, 1].min(), lowest - 0.1)
        with self.assertRaisesRegex(ValueError, "without room for cuts"):
            cloth.cut((-1, 0, 0), (1, 0, 0), (0, 1, 0))

    def test_it_lies_on_a_ball(self):
        self.world.add_sphere(0.3, position=(0, -0.4, 0))
        cloth = self.adopt(stiffness=500.0, laws={"velocity_damping": {"rate": 1.0}})
        self.world.step(1 / 60, steps=120)
        distance = np.linalg.norm(np.asarray(cloth.positions) - (0, -0.4, 0), axis=1)
        self.assertAlmostEqual(distance.min(), 0.31, delta=0.005)

    def test_what_is_refused(self):
        vertices = np.vstack([MESH.vertices, [(9, 9, 9)]])
        cases = ((lambda: self.world.adopt(vertices, MESH.triangles, 1), "adopt: vertex 441 belongs to no triangle"),
                 (lambda: self.world.adopt(np.zeros((0, 3)), np.zeros((0, 3), int), 1), "adopt: there is no vertex"),
                 (lambda: self.world.adopt(MESH.vertices, MESH.triangles, 0), r"adopt: mass = 0 \[kg\], expected > 0"),
                 (lambda: self.adopt(link_factor=2), r"link_factor = 2 \[1\], expected 0 to 1"), (lambda: self.adopt(iterations=0), "iterations = 0"),
                 (lambda: self.adopt(stiffness=-1), "stiffness"), (lambda: self.adopt(time_step=0), "time_step"),
                 (lambda: self.adopt(pins=[441]), r"adopt: pins\[0\] = 441"), (lambda: self.adopt(damping=2), "damping = 2"),
                 (lambda: self.adopt(laws={"wind": {}}), "wind: parameter 'velocity' is missing"))
        for call, message in cases:
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()
        self.assertEqual(self.world.cloths, [])
        self.world.step(0.01)


if __name__ == "__main__":
    main()
