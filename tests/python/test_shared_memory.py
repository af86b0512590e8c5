"""Arrays of nodes show Bullet's memory, both ways, and never memory that is gone."""
import gc
import unittest

import numpy as np
import weft
from support import LAWS, PRECISION, SCALAR, main, sheet, world


class SharedMemory(unittest.TestCase):
    def setUp(self):
        self.world = world(gravity=(0, 0, 0))
        self.cloth = self.world.add_cloth(sheet(), LAWS)

    def test_nothing_is_copied(self):
        a, b = self.cloth.positions, self.cloth.positions
        self.assertIsInstance(a, np.ndarray)
        self.assertTrue(np.shares_memory(a, b))
        self.assertFalse(a.flags.owndata)
        self.assertEqual(a.shape, (121, 3))
        self.assertEqual(a.dtype, SCALAR)
        a[7] = (1, 2, 3)
        np.testing.assert_array_equal(b[7], (1, 2, 3))
        self.assertFalse(np.shares_memory(a, self.cloth.velocities))

    def test_steps_are_seen_by_an_array_that_is_there_already(self):
        positions, velocities = self.cloth.positions, self.cloth.velocities
        velocities[:] = (0, 3, 0)
        before = positions.copy()
        self.world.step(0.01)
        # Damping is 0.5 / s: after a step 3 m/s are 3 exp(-0.005) m/s.
        np.testing.assert_allclose(velocities[:, 1], 3 * np.exp(-0.005), rtol=1e-4)
        moved = positions - before
        self.assertGreater(moved[:, 1].min(), 0.029)
        self.assertLess(np.abs(moved[:, [0, 2]]).max(), 1e-6)

    def test_written_positions_are_where_the_next_step_starts(self):
        self.cloth.positions += (10, 0, 0)
        self.world.step(0.01)
        x = np.asarray(self.cloth.positions)
        self.assertAlmostEqual(x[:, 0].mean(), 10, places=4)
        # It was moved, not thrown.
        self.assertLess(np.abs(self.cloth.velocities).max(), 1e-3)

    def test_a_node_that_is_pulled_out_pulls_its_neighbors(self):
        self.cloth.positions[60] += (0, 0.05, 0)
        self.world.step(0.01)
        v = self.cloth.velocities
        self.assertLess(v[60, 1], -0.1)
        self.assertGreater(v[59, 1], 0.01)

    def test_pinned_nodes_that_are_written_stay_there(self):
        cloth = self.world.add_cloth(sheet(center=(0, 5, 0), pins=[0]), LAWS)
        cloth.positions[0] = (-0.6, 5.1, 0.5)
        self.world.step(0.01, steps=50)
        np.testing.assert_allclose(cloth.positions[0], (-0.6, 5.1, 0.5), atol=1e-6)

    def test_what_is_written_wakes_a_cloth_that_sleeps(self):
        self.world.step(0.02, steps=100)
        self.assertEqual(self.cloth.state, "asleep")
        self.cloth.velocities[:] = (0, 1, 0)
        self.world.step(0.02)
        self.assertEqual(self.cloth.state, "awake")
        self.assertGreater(self.cloth.positions[:, 1].mean(), 0.015)

    def test_slices_share_and_results_do_not(self):
        x = self.cloth.positions
        row = x[3]
        row[:] = 4
        np.testing.assert_array_equal(x[3], 4)
        for result in (x + 1, x * x, np.add(x, x), x.mean(axis=0), np.linalg.norm(x, axis=1), np.concatenate([x, x])):
            self.assertIs(type(result), np.ndarray)
            self.assertFalse(np.shares_memory(result, x))
        self.assertFalse(np.shares_memory(x[[1, 2]], x))
        self.assertFalse(np.shares_memory(x.copy(), x))

    def test_in_place_operations_stay_in_the_nodes(self):
        x = self.cloth.positions
        before = np.array(x)
        x += 1
        np.multiply(x, 2, out=x)
        np.testing.assert_allclose(self.cloth.positions, 2 * (before + 1), rtol=1e-6)
        self.cloth.positions = before
        np.testing.assert_array_equal(self.cloth.positions, before)

    def test_numbers_that_are_not_finite_become_a_blow_up(self):
        self.cloth.positions[5, 1] = np.nan
        self.world.step(0.01)
        self.assertEqual(self.cloth.state, "blown up")
        self.assertIn("not finite", self.cloth.blow_up.reason)

    def test_an_array_keeps_world_and_cloth_alive(self):
        x = self.cloth.positions
        plain = np.asarray(x)
        before = plain.copy()
        del self.world, self.cloth, x
        gc.collect()
        churn = [world().add_cloth(sheet(), LAWS) for _ in range(5)]
        np.testing.assert_array_equal(plain, before)
        plain[:] = 0
        del churn


class Removal(unittest.TestCase):
    def test_arrays_of_a_removed_cloth_are_refused(self):
        a_world = world()
        cloth = a_world.add_cloth(sheet(), LAWS, name="flag")
        x = cloth.positions
        part, plain = x[2:4], np.asarray(x)
        values = plain.copy()
        a_world.remove(cloth)
        uses = {"item": lambda: x[0], "write": lambda: x.__setitem__(0, 1), "sum": lambda: x + 1, "reverse": lambda: 1 + x,
                "method": lambda: x.mean(), "function": lambda: np.sum(x), "part": lambda: part[0], "text": lambda: repr(x),
                "out": lambda: np.add(values, 1, out=x), "in place": lambda: x.__iadd__(1), "loop": lambda: list(x),
                "shape": lambda: x.shape, "nested": lambda: np.concatenate([values, x]), "copy": lambda: x.copy(),
                "where": lambda: np.add(values, values, where=x > 0), "length": lambda: len(x)}
        for name, use in uses.items():
            with self.subTest(name), self.assertRaisesRegex(weft.StaleArray, "cloth 'flag' has been removed from its world"):
                use()
        # A plain array cannot raise; it shows what the nodes were last.
        np.testing.assert_array_equal(plain, values)
        with self.assertRaisesRegex(weft.Error, "'flag' has been removed"):
            cloth.positions


if __name__ == "__main__":
    main()
