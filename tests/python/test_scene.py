"""Scenes and their runs: the same bits as the command's, in both precisions, and worlds that repeat a scene."""
import glob
import os
import subprocess
import tempfile
import unittest

import numpy as np
import weft
from support import PRECISION, main

OTHER = "float64" if PRECISION == "float32" else "float32"


def command_run(folder, scene, engine, precision, duration):
    """The recording that the command makes of a scene."""
    path = os.path.join(folder, f"command_{engine}_{precision}.weftrec")
    subprocess.run([os.environ["WEFT_COMMAND"], "run", scene, "--engine", engine, "--precision", precision, "--duration", f"{duration} s",
                    "--output", path], check=True, stdout=subprocess.DEVNULL)
    return weft.Recording(path)


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_a_scene_says_what_it_is(self):
        scene = weft.Scene("drape_sphere")
        self.assertEqual((scene.name, scene.duration, scene.time_step, scene.frame_interval), ("drape_sphere", 6, 0.01, 0.04))
        self.assertEqual((scene.cloths, scene.colliders, scene.gravity), (["cloth"], ["ball"], (0, -9.81, 0)))
        self.assertEqual(scene.engines, list(weft.ENGINES))
        self.assertIn("drape_sphere", weft.scene_names())
        self.assertEqual(weft.Scene.from_text(scene.text).text, scene.text)

    def test_runs_have_the_bits_of_the_command(self):
        for engine, precision in (("bullet_weft", PRECISION), ("bullet_forces", PRECISION), ("reference", "float64"), ("bullet_weft", OTHER)):
            with self.subTest(engine=engine, precision=precision):
                mine = weft.Scene("hang").run(engine, precision=precision, duration=0.2)
                theirs = command_run(self.folder, "hang", engine, precision, 0.2)
                self.assertEqual(mine.content_hash, theirs.content_hash)
                np.testing.assert_array_equal(mine.positions(), theirs.positions())
                self.assertEqual((mine.precision, mine.provenance["engine"]), (precision, engine))
                self.assertEqual(mine.report.content_hash, mine.content_hash)

    def test_a_world_repeats_the_drape_of_the_scene_bit_for_bit(self):
        drape = weft.World(precision=PRECISION, distance_field_voxel=0.1, solver=weft.Solver(may_sleep=False))
        cloth = drape.add_cloth(
            weft.grid((50, 50), (7, 7), 1.0, center=(0, 2.5, 0), lumping="uniform"), margin=0.02, friction=0.3,
            laws=[weft.laws.gravity(acceleration=(0, -9.81, 0)), weft.laws.tension(stiffness=0.5, sets=["stretch", "shear", "bend"]),
                  weft.laws.velocity_damping(rate=0.6)])
        drape.add_sphere(2.0, friction=1.0)
        recorded = command_run(self.folder, "drape_sphere", "bullet_weft", PRECISION, 1.6)
        for frame in recorded:
            while drape.time < frame.time - 1e-6:
                drape.step(0.01)
            np.testing.assert_array_equal(np.asarray(cloth.positions), frame.cloths["cloth"].positions, f"at {frame.time} s")
            np.testing.assert_array_equal(np.asarray(cloth.velocities), frame.cloths["cloth"].velocities)
        # It has met the ball by then.
        self.assertGreater(len(cloth.contacts().node), 100)

    def test_a_run_without_output_leaves_nothing(self):
        recording = weft.Scene("hang").run("reference", duration=0.02)
        path = recording.path
        self.assertTrue(os.path.exists(path))
        del recording
        self.assertFalse(os.path.exists(os.path.dirname(path)))

    def test_output_is_kept_and_not_written_over(self):
        path = os.path.join(self.folder, "mine.weftrec")
        scene = weft.Scene("hang")
        recording = scene.run("reference", duration=0.02, time_step=0.001, output=path)
        self.assertEqual((recording.path, recording.report.steps), (path, 20))
        with self.assertRaisesRegex(weft.Error, "mine.weftrec"):
            scene.run("reference", duration=0.02, output=path)
        longer = scene.run("reference", duration=0.04, output=path, replace=True)
        self.assertGreater(longer.report.time, 0.03)
        self.assertEqual(os.listdir(self.folder), ["mine.weftrec"])

    def test_a_blow_up_is_data(self):
        recording = weft.Scene("hang").run("bullet_forces", precision=PRECISION, time_step=0.02, duration=2)
        self.assertIsNotNone(recording.report.blow_up)
        self.assertEqual(recording.report.blow_up, recording.blow_up)
        self.assertLess(recording.report.time, 2)
        self.assertRegex(recording.blow_up.reason, "m/s|finite|m")

    def test_what_is_refused(self):
        scene = weft.Scene("hang")
        cases = ((lambda: weft.Scene("drape_spher"), "drape_sphere"), (lambda: weft.Scene("/nowhere/x.toml"), "/nowhere/x.toml"),
                 (lambda: scene.run("bullet"), "engine = 'bullet', expected one of reference"),
                 (lambda: scene.run("reference", precision="float32"), "precision = 'float32' of reference, expected 'float64'"),
                 (lambda: scene.run("bullet_weft", precision="half"), "expected 'float32' or 'float64'"),
                 (lambda: scene.run("reference", duration=-1), "duration"), (lambda: scene.run("reference", time_step=0), "time_step"),
                 (lambda: scene.run("reference", duration="1 s"), "duration = '1 s', expected a number in s"),
                 (lambda: weft.Scene.from_text("schema = 3", "mine"), "^mine:1:"),
                 (lambda: scene.run("bullet_weft", precision=OTHER, duration=-1), "duration"))
        for call, message in cases:
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()
        with self.assertRaisesRegex(weft.Error, "/nowhere"):
            scene.run("reference", duration=0.02, output="/nowhere/x.weftrec")
        self.assertEqual(glob.glob(os.path.join(tempfile.gettempdir(), "weft-*", "hang_*")), [])


if __name__ == "__main__":
    main()
