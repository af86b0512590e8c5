"""Worlds: the drape in ten lines, laws that change, contacts, forces, pins, and what a call refuses."""
import math
import unittest

import numpy as np
import weft
from support import LAWS, PRECISION, SCALAR, main, sheet, world


class Drape(unittest.TestCase):
    def test_drape_in_ten_lines(self):
        table = weft.World(precision=PRECISION)
        table.add_sphere(radius=0.5, friction=0.5)
        cloth = table.add_cloth(weft.grid(nodes=(40, 40), size=(2, 2), mass=0.5, center=(0, 0.6, 0)),
                                laws={"tension": {"stiffness": 500}, "velocity_damping": {"rate": 0.5}})
        for _ in range(180):
            table.step(1 / 60)
        x = cloth.positions
        # It lies on the ball at its margin of 1 cm, within what a facet may sink in, and hangs down around it.
        distance = np.linalg.norm(x, axis=1)
        self.assertGreater(distance.min(), 0.5)
        self.assertLess(distance.min(), 0.5101)
        self.assertAlmostEqual(x[:, 1].max(), 0.51, places=2)
        self.assertLess(x[:, 1].min(), -0.3)
        self.assertLess(np.abs(x[:, [0, 2]].mean(axis=0)).max(), 0.05)
        self.assertIsNone(cloth.blow_up)
        self.assertLess(cloth.step_error.distance, 1e-3)
        self.assertAlmostEqual(table.time, 3, places=5)


class Steps(unittest.TestCase):
    def test_gravity_acts_on_cloth_unless_its_laws_say_so(self):
        a_world = world(gravity=(0, -2, 0))
        falling = a_world.add_cloth(sheet(), {"tension": {"stiffness": 500.0}})
        floating = a_world.add_cloth(sheet(center=(5, 0, 0)), {"tension": {"stiffness": 500.0}, "gravity": {"acceleration": (0, 0, 0)}})
        self.assertIn(weft.laws.gravity(acceleration=(0.0, -2.0, 0.0)), falling.laws)
        a_world.step(0.01, steps=50)
        np.testing.assert_allclose(falling.velocities[:, 1], -1, rtol=1e-4)
        self.assertLess(np.abs(floating.velocities).max(), 1e-3)  # rounding

    def test_explicit_laws_follow_the_same_fall(self):
        a_world = world()
        cloth = a_world.add_cloth(sheet(), {"tension": {"stiffness": 50.0}, "velocity_damping": {"rate": 0.5}}, implicit=False, velocity=(1, 0, 0))
        a_world.step(1e-3, steps=100)
        np.testing.assert_allclose(cloth.velocities[:, 0], math.exp(-0.05), rtol=1e-3)
        self.assertEqual(cloth.step_error.newton_iterations, 0)

    def test_many_steps_of_one_call_are_those_of_many_calls(self):
        def run(calls, steps):
            a_world = world()
            cloth = a_world.add_cloth(sheet(pins=[0]), LAWS)
            for _ in range(calls):
                report = a_world.step(1 / 60, steps=steps)
            return cloth.positions.copy(), report.time

        one, many = run(30, 1), run(1, 30)
        np.testing.assert_array_equal(one[0], many[0])
        self.assertEqual(one[1], many[1])

    def test_reports_add_up(self):
        a_world = world()
        a_world.add_cloth(sheet(pins=[0]), LAWS, solver=weft.Solver(newton_iterations=1, linear_iterations=1))
        report = a_world.step(1 / 30, steps=20)
        self.assertGreater(report.unfinished_steps, 0)
        self.assertGreater(report.largest_error, 1e-5)
        self.assertEqual(report.num_tears, 0)

    def test_bad_steps(self):
        a_world = world()
        for step in (0, -1, math.nan, math.inf, 1e-12, 1e9):
            with self.assertRaisesRegex(ValueError, r"^world: time_step = .* \[s\], expected 1e-09 to 1000$"):
                a_world.step(step)
        with self.assertRaisesRegex(ValueError, "steps = 0, expected >= 1"):
            a_world.step(0.01, steps=0)
        with self.assertRaisesRegex(ValueError, "time_step = '0.01', expected a number in s"):
            a_world.step("0.01")
        self.assertEqual(a_world.time, 0)


class Changes(unittest.TestCase):
    def setUp(self):
        self.world = world()

    def hang(self, **options):
        return self.world.add_cloth(sheet(pins=[0, 10]), LAWS, **options)

    def test_laws_change_while_it_runs(self):
        cloth = self.hang()
        self.world.step(1 / 60, steps=120)
        lowest = cloth.positions[:, 1].min()
        cloth.set(weft.laws.tension(stiffness=20.0))
        self.assertIn(("tension", 20.0), [(law.name, law.parameters.get("stiffness")) for law in cloth.laws])
        self.world.step(1 / 60, steps=120)
        self.assertLess(cloth.positions[:, 1].min(), lowest - 0.02)
        cloth.set("wind", velocity=(0, 0, 8))
        self.world.step(1 / 60, steps=60)
        self.assertGreater(cloth.positions[:, 2].mean(), 0.6)
        cloth.remove_law("wind")
        self.assertNotIn("wind", [law.name for law in cloth.laws])
        with self.assertRaisesRegex(ValueError, "has no law 'wind'"):
            cloth.remove_law("wind")

    def test_a_law_that_is_refused_changes_nothing(self):
        cloth = self.hang()
        before = cloth.laws
        for law, message in ((("tension", {"stiffness": -1}), r"tension: stiffness = -1 \[N/m\], expected >= 0"),
                             (("tensoin", {}), "tensoin"),
                             (("tension", {"stiffness": 1, "sets": ["hem"]}), "hem")):
            with self.assertRaisesRegex(ValueError, message):
                cloth.set(law[0], **law[1])
        self.assertEqual(cloth.laws, before)

    def test_pins_are_led_without_lag(self):
        cloth = self.hang()
        targets = np.array(cloth.positions[[0, 10]], dtype=float)
        for _ in range(30):
            targets += (0, 0.01, 0.02)
            cloth.move_pins([0, 10], targets)
            self.world.step(1 / 60)
        np.testing.assert_array_equal(cloth.positions[[0, 10]], targets.astype(SCALAR))
        self.world.step(1 / 60)
        np.testing.assert_array_equal(cloth.positions[[0, 10]], targets.astype(SCALAR))
        with self.assertRaisesRegex(ValueError, "node 5 is not pinned"):
            cloth.move_pins([5], [(0, 0, 0)])
        with self.assertRaisesRegex(ValueError, r"targets has the shape \(1, 3\), expected \(2, 3\)"):
            cloth.move_pins([0, 10], [(0, 0, 0)])
        cloth.move_pins([-111, 0], targets[::-1])  # in any order; -111 is node 10
        self.world.step(1 / 60)
        np.testing.assert_array_equal(cloth.positions[[0, 10]], targets.astype(SCALAR))
        with self.assertRaisesRegex(ValueError, "node 10 is named twice"):
            cloth.move_pins([10, 10], targets)

    def test_forces_act_for_one_step(self):
        cloth = self.world.add_cloth(sheet(mass=0.5), {"tension": {"stiffness": 500.0}, "gravity": {"acceleration": (0, 0, 0)}})
        for _ in range(10):
            cloth.add_forces(np.outer(cloth.masses, (0, 3, 0)))
            cloth.add_forces(np.outer(cloth.masses[4::-1], (1, 0, 0)), nodes=range(4, -1, -1))
            self.world.step(0.01)
        momentum = cloth.masses @ np.asarray(cloth.velocities, dtype=float)
        np.testing.assert_allclose(momentum, (0.1 * cloth.masses[:5].sum(), 0.5 * 0.3, 0), rtol=2e-4, atol=1e-5)
        self.world.step(0.01)
        np.testing.assert_allclose(cloth.masses @ np.asarray(cloth.velocities, dtype=float), momentum, rtol=1e-4, atol=1e-5)
        with self.assertRaisesRegex(ValueError, "node 1 is named twice"):
            cloth.add_forces([(0, 0, 0)] * 2, nodes=[1, 1])

    def test_contacts_bear_the_weight(self):
        self.world.add_plane(name="floor")
        cloth = self.world.add_cloth(sheet(center=(0, 0.05, 0)), {"tension": {"stiffness": 500.0}, "velocity_damping": {"rate": 2.0}},
                                     solver=weft.Solver(may_sleep=False))
        self.world.step(1 / 60, steps=120)
        contacts = cloth.contacts()
        self.assertGreater(len(contacts.node), 100)
        self.assertEqual(set(contacts.body), {"floor"})
        np.testing.assert_allclose(contacts.normal, np.tile((0, 1, 0), (len(contacts.node), 1)), atol=1e-6)
        self.assertAlmostEqual(contacts.impulse[:, 1].sum() * 60, 0.2 * 9.81, delta=0.02)
        np.testing.assert_allclose(contacts.point[:, 1], 0, atol=1e-3)
        np.testing.assert_allclose(cloth.positions[:, 1], 0.01, atol=1e-3)
        self.assertEqual(contacts.is_sticking.dtype, bool)
        self.assertGreaterEqual(cloth.num_contacts, len(contacts.node))

    def test_layers_keep_their_distance(self):
        self.world.add_plane()
        lower = self.world.add_cloth(sheet(center=(0, 0.02, 0)), LAWS, cloth_collision=True, margin=0.02)
        upper = self.world.add_cloth(sheet(nodes=9, size=0.5, mass=0.05, center=(0.01, 0.15, 0.02)), LAWS, cloth_collision=True, margin=0.02)
        self.world.step(1 / 100, steps=200)
        self.assertGreater(upper.positions[:, 1].min(), np.asarray(lower.positions)[:, 1].mean() + 0.02)

    def test_an_anchor_holds_cloth_on_a_body(self):
        hand = self.world.add_box((0.05, 0.05, 0.05), kinematic=True, position=(-0.5, 0, 0.5))
        cloth = self.world.add_cloth(sheet(), LAWS)
        cloth.anchor(0, hand)
        for _ in range(60):
            hand.position = (hand.position[0], hand.position[1] + 0.01, 0.5)
            self.world.step(1 / 60)
        self.assertLess(np.linalg.norm(np.asarray(cloth.positions[0]) - hand.position), 0.02)
        with self.assertRaisesRegex(ValueError, "holds anchors of cloth 'cloth_1', expected none"):
            self.world.remove(hand)
        self.assertEqual(cloth.release(), 1)
        self.world.step(1 / 60, steps=60)
        self.assertLess(cloth.positions[0, 1], 0)
        self.world.remove(hand)

    def test_names(self):
        cloth = self.hang(name="flag")
        ball = self.world.add_sphere(0.1, name="ball", position=(5, 0, 0))
        self.assertEqual(self.world["flag"], cloth)
        self.assertEqual(self.world["ball"].name, ball.name)
        self.assertEqual([one.name for one in self.world.cloths], ["flag"])
        with self.assertRaises(KeyError):
            self.world["hat"]
        for name in ("flag", "ball"):
            with self.assertRaisesRegex(ValueError, f"name '{name}' is taken"):
                self.world.add_sphere(0.1, name=name)

    def test_other_worlds_are_told_apart(self):
        other = world()
        cloth = other.add_cloth(sheet(), LAWS, name="theirs")
        ball = other.add_sphere(0.1)
        with self.assertRaisesRegex(ValueError, "'theirs' is in another world"):
            self.world.remove(cloth)
        with self.assertRaisesRegex(ValueError, "is in another world"):
            self.hang().anchor(5, ball)

    def test_arguments_of_cloths(self):
        cases = ((dict(margin=-1), r"collision_margin = -1.* \[m\]"), (dict(friction=math.nan), "friction"),
                 (dict(margin="1"), "margin = '1', expected a number in m"), (dict(solver=3), "solver = 3, expected a weft.Solver"),
                 (dict(velocity=(0, 1)), r"velocity has the shape \(2,\), expected \(3,\)"),
                 (dict(self_collision=True, thickness=-1), "thickness"), (dict(name=""), "name is empty"), (dict(name=3), "name = 3"),
                 (dict(solver=weft.Solver(newton_iterations=0)), "newton"))
        for options, message in cases:
            with self.subTest(options), self.assertRaisesRegex(ValueError, message):
                self.hang(**options)
        with self.assertRaisesRegex(ValueError, "mesh = 3, expected a weft.Mesh"):
            self.world.add_cloth(3, LAWS)
        self.assertEqual(self.world.cloths, [])
        self.world.step(0.01)


if __name__ == "__main__":
    main()
