"""The types of errors, and what a process refuses."""
import subprocess
import sys
import unittest

import weft
from support import PRECISION, main, world

OTHER = "float64" if PRECISION == "float32" else "float32"


def run_python(code):
    """What an interpreter of its own prints."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    return done.stdout + done.stderr


class Errors(unittest.TestCase):
    def test_types(self):
        self.assertTrue(issubclass(weft.InvalidArgument, ValueError))
        self.assertTrue(issubclass(weft.StaleArray, weft.Error))
        with self.assertRaises(weft.InvalidArgument) as caught:
            weft.laws.tension(stiffness=-1)
        self.assertNotIn("\n", str(caught.exception))

    def test_one_precision_in_a_process(self):
        world()
        with self.assertRaisesRegex(weft.Error, f"precision = '{OTHER}': this process has Bullet in {PRECISION} already"):
            weft.World(precision=OTHER)
        self.assertEqual(weft.World().precision, PRECISION)
        with self.assertRaisesRegex(ValueError, "precision = 'half', expected 'float32' or 'float64'"):
            weft.World(precision="half")

    def test_scenes_and_recordings_leave_the_precision_open(self):
        out = run_python("import weft\nweft.Scene('hang').run('reference', duration=0.01)\n"
                         f"print(weft.World(precision={OTHER!r}).precision)")
        self.assertEqual(out, OTHER + "\n")

    def test_another_bullet_in_the_process_is_refused(self):
        out = run_python("import sys, types, weft\nsys.modules['pybullet'] = types.ModuleType('pybullet')\nweft.World()")
        self.assertIn("pybullet is loaded in this process: it has a Bullet of its own", out)

    def test_worlds(self):
        for options, message in ((dict(gravity=(0, 1)), r"world: gravity has the shape \(2,\), expected \(3,\)"),
                                 (dict(gravity=(0, float("nan"), 0)), r"world: gravity: number 1 = nan \[m/s\^2\]"),
                                 (dict(distance_field_voxel=0), "distance_field_voxel = 0"), (dict(solver="fast"), "solver = 'fast', expected a weft.Solver")):
            with self.assertRaisesRegex(ValueError, message):
                world(**options)

    def test_everything_public_is_described(self):
        for name in weft.__all__:
            if name not in ("ENGINES", "laws"):
                self.assertTrue(getattr(weft, name).__doc__, name)


if __name__ == "__main__":
    main()
