"""Laws by name: Weft's own table, names, defaults and errors."""
import inspect
import unittest

import weft
from support import main, sheet, world

TABLE = {row["name"]: row for row in weft.laws._core.law_table()}


class Laws(unittest.TestCase):
    def test_every_law_of_the_table_is_a_function(self):
        self.assertEqual(set(weft.laws.NAMES), set(TABLE))
        self.assertIn("tension", weft.laws.NAMES)
        for name, row in TABLE.items():
            function = getattr(weft.laws, name)
            parameters = inspect.signature(function).parameters
            self.assertEqual([p for p in parameters if p != "sets"], [one["name"] for one in row["parameters"]])
            self.assertEqual("sets" in parameters, bool(row["set_key"]))
            self.assertIn(row["summary"], function.__doc__)

    def test_every_law_can_be_made_and_is_checked(self):
        for name, row in TABLE.items():
            with self.subTest(name):
                values = {one["name"]: 0.25 if one["size"] == 1 else (0.25, 0.5, 1.0) for one in row["parameters"] if one["required"]}
                if name == "pressure":
                    values["pressure"] = 100.0
                made = getattr(weft.laws, name)(**values)
                self.assertEqual((made.name, made.parameters), (name, values))
                with self.assertRaisesRegex(weft.InvalidArgument, f"{name}: parameter 'hue' is unknown"):
                    getattr(weft.laws, name)(**values, hue=1)

    def test_messages_are_those_of_the_table(self):
        cases = ((dict(stiffness=-3), r"tension: stiffness = -3 \[N/m\], expected >= 0"), (dict(), "tension: parameter 'stiffness' is missing"),
                 (dict(stiffness=float("nan")), "tension: stiffness = nan"), (dict(stiffness="5 N/m"), "tension: stiffness = '5 N/m', expected a number"),
                 (dict(stiffness=(1, 2)), "tension: .*stiffness"), (dict(stiffness=[[1]]), "expected a number"))
        for values, message in cases:
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                weft.laws.tension(**values)
        with self.assertRaisesRegex(ValueError, "gravity: .*acceleration"):
            weft.laws.gravity(acceleration=9.81)

    def test_what_laws_may_be(self):
        one = weft.laws.tension(stiffness=5, sets="stretch")
        self.assertEqual(weft.laws.laws_from(one), [one])
        self.assertEqual(weft.laws.laws_from({"tension": {"stiffness": 5, "sets": "stretch"}}), [one])
        self.assertEqual(repr(one), "weft.laws.tension(stiffness=5, sets=['stretch'])")
        self.assertEqual(eval(repr(one)), one)
        for bad, message in (([3], "3 is no law"), ({"tension": 5}, "tension = 5, expected a dict"), ({"hum": {}}, "hum")):
            with self.assertRaisesRegex(ValueError, message):
                weft.laws.laws_from(bad)

    def test_a_cloth_has_the_laws_that_it_was_given(self):
        given = [weft.laws.tension(stiffness=5.0, compression_ratio=1.0, sets=("stretch",)), weft.laws.tension(stiffness=1.0, compression_ratio=1.0, sets=("bend",)),
                 weft.laws.gravity(acceleration=(0.0, -1.0, 0.0))]
        self.assertEqual(world().add_cloth(sheet(), given).laws, given)

    def test_sets_that_the_mesh_does_not_have(self):
        a_world = world()
        with self.assertRaisesRegex(ValueError, "hem"):
            a_world.add_cloth(sheet(), [weft.laws.tension(stiffness=5, sets=["hem"])])
        self.assertEqual(a_world.cloths, [])
        a_world.step(0.01)


if __name__ == "__main__":
    main()
