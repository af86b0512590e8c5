"""Rigid bodies: shapes, places, motion, and what is refused."""
import math
import unittest

import numpy as np
import weft
from support import LAWS, main, sheet, world

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
# The faces of a tetrahedron, counter-clockwise seen from outside.
CORNERS = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
FACES = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]


class Bodies(unittest.TestCase):
    def setUp(self):
        self.world = world()

    def test_free_fall(self):
        ball = self.world.add_sphere(0.1, mass=2, position=(1, 2, 3), velocity=(1, 0, 0), angular_velocity=(0, 0, 1))
        self.world.step(1 / 100, steps=100)
        self.assertAlmostEqual(ball.mass, 2, places=5)
        np.testing.assert_allclose(ball.velocity, (1, -9.81, 0), rtol=1e-4, atol=1e-6)
        np.testing.assert_allclose(ball.position, (2, 2 - 9.81 * 0.505, 3), rtol=1e-4)
        np.testing.assert_allclose(ball.orientation, (0, 0, math.sin(0.5), math.cos(0.5)), atol=1e-4)

    def test_forces_and_torques(self):
        box = self.world.add_box((1, 1, 1), mass=3)
        box.add_force((0, 3 * 9.81, 6))
        box.add_torque((0, 2, 0))
        self.world.step(0.01)
        np.testing.assert_allclose(box.velocity, (0, 0, 0.02), atol=1e-6)
        # I = m (2^2 + 2^2) / 12
        np.testing.assert_allclose(box.angular_velocity, (0, 0.01, 0), rtol=1e-4, atol=1e-7)

    def test_every_shape_stops_a_cloth(self):
        adders = {"sphere": lambda at: self.world.add_sphere(0.3, position=at), "box": lambda at: self.world.add_box((0.3, 0.3, 0.3), position=at),
                  "capsule": lambda at: self.world.add_capsule(0.3, 0.4, position=at, orientation=(0, 0, math.sqrt(0.5), math.sqrt(0.5))),
                  "cylinder": lambda at: self.world.add_cylinder(0.3, 0.6, position=at),
                  "hull": lambda at: self.world.add_hull(0.3 * np.array(CUBE), position=at),
                  "mesh": lambda at: self.world.add_mesh(np.array(CORNERS) * 0.4, FACES, position=at),
                  "plane": lambda at: self.world.add_plane(position=(0, -3, 0))}
        cloths = {}
        for number, (name, add) in enumerate(adders.items()):
            add((3 * number, 0, 0))
            cloths[name] = self.world.add_cloth(sheet(15, size=0.8, center=(3 * number, 0.6, 0)), LAWS)
        self.world.step(1 / 100, steps=60)
        for name, cloth in cloths.items():
            height = cloth.positions[:, 1].max()
            with self.subTest(name):
                if name == "plane":
                    self.assertLess(height, -0.8)  # still falls
                else:
                    self.assertGreater(height, 0.25)
                    self.assertLess(height, 0.6)
        self.world.step(1 / 100, steps=60)
        np.testing.assert_allclose(cloths["plane"].positions[:, 1], -2.99, atol=2e-3)

    def test_a_kinematic_body_carries_cloth(self):
        tray = self.world.add_box((1, 0.1, 1), kinematic=True, friction=1.0)
        cloth = self.world.add_cloth(sheet(center=(0, 0.12, 0)), LAWS, friction=1.0)
        self.world.step(1 / 60, steps=30)
        for step in range(60):
            tray.position = (0.5 * (step / 60) ** 2, 0, 0)
            self.world.step(1 / 60)
        self.assertTrue(tray.is_kinematic)
        self.assertAlmostEqual(cloth.positions[:, 0].mean(), tray.position[0], delta=0.05)

    def test_places_can_be_set(self):
        hull = self.world.add_hull(np.array(CUBE) + (2, 0, 0), mass=1)
        hull.position = (1, 2, 3)
        hull.orientation = (0, 1, 0, 0)
        np.testing.assert_allclose(hull.position, (1, 2, 3), atol=1e-5)
        np.testing.assert_allclose(np.abs(hull.orientation), (0, 1, 0, 0), atol=1e-5)
        hull.velocity = (0, 1, 0)
        hull.angular_velocity = (1, 0, 0)
        hull.friction = 0.25
        self.assertEqual((hull.velocity, hull.angular_velocity, hull.friction), ((0, 1, 0), (1, 0, 0), 0.25))

    def test_removal(self):
        floor = self.world.add_box((1, 1, 1), position=(0, -1, 0), name="floor")
        cloth = self.world.add_cloth(sheet(center=(0, 0.02, 0)), LAWS)
        self.world.step(1 / 60, steps=150)
        self.assertEqual(cloth.state, "asleep")
        self.world.remove(floor)
        self.world.remove(floor)
        self.assertTrue(floor.is_removed)
        self.assertEqual(self.world.bodies, [])
        self.world.step(1 / 60, steps=60)
        self.assertLess(cloth.positions[:, 1].max(), -2)
        with self.assertRaisesRegex(weft.Error, "'floor' has been removed from its world"):
            floor.position

    def test_what_is_refused(self):
        add = self.world
        cases = ((lambda: add.add_sphere(0), r"body 'sphere_1': radius = 0 \[m\], expected > 0 and finite"),
                 (lambda: add.add_sphere("1"), "sphere: radius = '1', expected a number in m"),
                 (lambda: add.add_sphere(1, mass=-1), r"mass = -1 \[kg\]"), (lambda: add.add_sphere(1, friction=math.nan), "friction = nan"),
                 (lambda: add.add_box((1, math.inf, 1)), "half_extents"), (lambda: add.add_box((1, 1)), r"\(2,\), expected \(3,\)"),
                 (lambda: add.add_capsule(1, -1), r"height = -1 \[m\]"), (lambda: add.add_plane(mass=1), "planes and meshes are fixed"),
                 (lambda: add.add_mesh(CORNERS, FACES, mass=1), "planes and meshes are fixed"),
                 (lambda: add.add_mesh(CORNERS, [(0, 1, 4)]), r"triangles\[0, 2\] = 4, expected a node from 0 to 3"),
                 (lambda: add.add_hull(CUBE[:3]), "3 points, expected 4 to 128"),
                 (lambda: add.add_hull([(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)]), "one plane"),
                 (lambda: add.add_sphere(1, kinematic=True, mass=1), "expected 0: the program moves it"),
                 (lambda: add.add_sphere(1, velocity=(1, 0, 0)), "a velocity of a body without a mass"),
                 (lambda: add.add_sphere(1, orientation=(0, 0, 0, 2)), r"orientation has the length 2"),
                 (lambda: add.add_sphere(1, orientation=(0, 0, 1)), "expected a quaternion"),
                 (lambda: add.add_sphere(1, position="abc"), "position is no array of numbers"))
        for call, message in cases:
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()
        with self.assertRaisesRegex(TypeError, "no option 'weight', expected one of name, position"):
            add.add_sphere(1, weight=2)
        fixed = add.add_sphere(1)
        for change in (lambda: setattr(fixed, "velocity", (1, 0, 0)), lambda: fixed.add_force((1, 0, 0))):
            with self.assertRaisesRegex(ValueError, "expected a body with a mass"):
                change()
        self.assertEqual(len(add.bodies), 1)


if __name__ == "__main__":
    main()
