"""Tears and cuts: new nodes, arrays that are refused afterwards, memory that stays."""
import gc
import unittest

import numpy as np
import weft
from support import LAWS, PRECISION, main, sheet, world


def pulled_sheet(a_world, **options):
    """A sheet that hangs by one side, from which a weight of 30 times its own is about to pull half of the other side off."""
    mesh = sheet(13, mass=0.1, pins=range(13))
    cloth = a_world.add_cloth(mesh, {"tension": {"stiffness": 200.0}, "velocity_damping": {"rate": 2.0}}, **options)
    return cloth


class Tears(unittest.TestCase):
    def tear(self, **options):
        a_world = world()
        cloth = pulled_sheet(a_world, tear=weft.Tear(strain=0.3), **options)
        kept = cloth.positions
        plain = np.asarray(kept)
        for _ in range(200):
            if len(cloth) == 169:
                cloth.add_forces(np.tile((0, 0, 6.0), (5, 1)), nodes=range(156, 161))
            report = a_world.step(1 / 100)
            if report.num_tears:
                return a_world, cloth, kept, plain, report
        self.fail("nothing tore")

    def test_a_tear_adds_nodes_and_invalidates_arrays(self):
        a_world, cloth, kept, plain, report = self.tear(name="sheet")
        self.assertEqual(len(cloth), 169 + report.num_tears)
        self.assertEqual(cloth.positions.shape, (len(cloth), 3))
        self.assertEqual(len(cloth.masses), len(cloth))
        self.assertAlmostEqual(cloth.masses.sum(), 0.1, places=12)
        self.assertLess(cloth.triangles.max(), len(cloth))
        self.assertGreaterEqual(cloth.triangles.max(), 169)
        with self.assertRaisesRegex(weft.StaleArray, "cloth 'sheet' has torn, and has other nodes now"):
            kept[0]
        # Room was reserved: the plain array still shows the nodes that it knew.
        np.testing.assert_array_equal(plain, np.asarray(cloth.positions)[:169])
        self.assertTrue(np.shares_memory(plain, np.asarray(cloth.positions)))

    def test_a_torn_cloth_goes_on(self):
        a_world, cloth, _, _, _ = self.tear()
        a_world.step(1 / 100, steps=100)
        self.assertIsNone(cloth.blow_up)
        self.assertTrue(np.isfinite(np.asarray(cloth.positions)).all())
        with self.assertRaisesRegex(weft.Error, "has torn"):
            cloth.set(weft.laws.tension(stiffness=100.0))

    def test_plain_arrays_stay_in_the_nodes_through_many_tears(self):
        a_world = world(gravity=(0, 0, 0))
        cloth = a_world.add_cloth(sheet(21), LAWS, can_be_cut=True)
        first = np.asarray(cloth.positions)
        for z in np.linspace(-0.45, 0.45, 10):
            self.assertGreater(cloth.cut((-0.6, 0, z), (0.6, 0, z), (0, 0.1, 0)), 0)
        for x in np.linspace(-0.45, 0.45, 10):
            self.assertGreater(cloth.cut((x, 0, -0.6), (x, 0, 0.6), (0, 0.1, 0)), 0)
        self.assertGreater(len(cloth), 2 * 441 - 100)
        self.assertTrue(np.shares_memory(first, np.asarray(cloth.positions)))
        a_world.step(0.01, steps=5)
        np.testing.assert_array_equal(first, np.asarray(cloth.positions)[:441])

    def test_arrays_outlive_a_torn_cloth(self):
        a_world, cloth, _, plain, _ = self.tear()
        values = plain.copy()
        a_world.remove(cloth)
        del a_world, cloth
        gc.collect()
        np.testing.assert_array_equal(plain, values)


class Cuts(unittest.TestCase):
    def test_a_cut_parts_a_sheet(self):
        a_world = world()
        cloth = a_world.add_cloth(sheet(11, pins=[0, 10]), LAWS, can_be_cut=True)
        # Between the rows 5 and 6 of 11: the far half falls.
        added = cloth.cut((-1, 0, -0.02), (1, 0, -0.02), (0, 0.5, 0))
        self.assertEqual(added, 11)
        a_world.step(1 / 60, steps=60)
        self.assertLess(cloth.positions[:, 1].min(), -3)

    def test_a_cloth_without_room_refuses(self):
        cloth = world().add_cloth(sheet(), LAWS, name="whole")
        with self.assertRaisesRegex(ValueError, "cloth 'whole': was made without room for cuts, expected can_be_cut=True"):
            cloth.cut((-1, 0, 0), (1, 0, 0), (0, 1, 0))

    def test_rules_are_checked(self):
        with self.assertRaisesRegex(ValueError, "strain"):
            world().add_cloth(sheet(), LAWS, tear=weft.Tear(strain=-1))
        with self.assertRaisesRegex(ValueError, "seam"):
            world().add_cloth(sheet(), LAWS, tear=weft.Tear(strain=0.3, weak=[("seam", 0.1)]))
        with self.assertRaisesRegex(ValueError, "tear = 0.3, expected weft.Tear"):
            world().add_cloth(sheet(), LAWS, tear=0.3)

    def test_seams_give_way_first(self):
        mesh = sheet(11, mass=0.1, pins=range(11))
        mesh.add_node_set("seam", range(55, 66))
        a_world = world()
        cloth = a_world.add_cloth(mesh, {"tension": {"stiffness": 10.0}}, tear=weft.Tear(strain=50.0, weak=[("seam", 0.01)]))
        report = a_world.step(1 / 60, steps=60)
        self.assertGreater(report.num_tears, 0)
        copies = cloth.positions[121:]
        self.assertEqual(len(copies), report.num_tears)


if __name__ == "__main__":
    main()
