"""Recordings as arrays."""
import os
import tempfile
import unittest

import numpy as np
import weft
from support import PRECISION, SCALAR, main


class Recordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recording = weft.Scene("ball_on_cloth").run("bullet_weft", precision=PRECISION, duration=0.5)

    def test_frames(self):
        r = self.recording
        self.assertGreater(len(r), 5)
        self.assertEqual(len(r.times), len(r))
        self.assertTrue((np.diff(r.times) > 0).all())
        (cloth,) = r.cloths
        frame = r[-1]
        self.assertEqual(frame.time, r.times[-1])
        self.assertEqual(frame.cloths[cloth].positions.dtype, SCALAR)
        self.assertEqual(frame.cloths[cloth].positions.shape, (len(r.mesh()), 3))
        self.assertIsNone(frame.cloths[cloth].triangles)
        self.assertEqual(list(frame.bodies), ["ball"])
        # The ball is thrown at 1 m/s and falls freely at first.
        np.testing.assert_allclose(r[3].bodies["ball"].velocity, (0, -1 - 9.81 * r.times[3], 0), rtol=1e-4, atol=1e-6)
        self.assertLess(frame.bodies["ball"].position[1], r[0].bodies["ball"].position[1])
        self.assertEqual([f.time for f in r], list(r.times))
        self.assertEqual([f.time for f in r[1:4]], list(r.times[1:4]))

    def test_whole_arrays(self):
        r = self.recording
        x, v = r.positions(), r.velocities(r.cloths[0])
        self.assertEqual(x.shape, (len(r), len(r.mesh()), 3))
        np.testing.assert_array_equal(x[3], r[3].cloths[r.cloths[0]].positions)
        np.testing.assert_array_equal(v[3], r[3].cloths[r.cloths[0]].velocities)
        np.testing.assert_array_equal(x[0], r.mesh().vertices.astype(SCALAR))

    def test_what_it_says_of_itself(self):
        r = self.recording
        self.assertTrue(r.finished)
        self.assertEqual(r.precision, PRECISION)
        self.assertIsNone(r.blow_up)
        self.assertEqual(r.content_hash, r.report.content_hash)
        self.assertEqual(weft.Scene.from_text(r.scene_text).name, "ball_on_cloth")
        self.assertEqual(r.provenance["program"], "Python")
        times, errors = r.metric("solver_error_m")
        self.assertEqual(len(times), len(errors))
        self.assertAlmostEqual(errors.max(), r.report.largest_error)

    def test_torn_cloths_are_read_frame_by_frame(self):
        r = weft.Scene("tear").run("bullet_forces", precision=PRECISION, duration=1.2)
        (cloth,) = r.cloths
        last = r[-1].cloths[cloth]
        self.assertGreater(len(last.positions), len(r[0].cloths[cloth].positions))
        self.assertEqual(last.triangles.max(), len(last.positions) - 1)
        with self.assertRaisesRegex(ValueError, "tears, expected a number of nodes that stays"):
            r.positions()

    def test_what_is_refused(self):
        r = self.recording
        for index in (len(r), -len(r) - 1):
            with self.assertRaises(IndexError):
                r[index]
        with self.assertRaisesRegex(ValueError, "metric 'energy' is not in it, expected one of solver_error_m"):
            r.metric("energy")
        with self.assertRaisesRegex(ValueError, "cloth = 'hat', expected one of"):
            r.positions("hat")
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("missing.weftrec", None), ("text.weftrec", b"no recording")):
                path = os.path.join(folder, name)
                if content:
                    with open(path, "wb") as file:
                        file.write(content)
                with self.assertRaisesRegex(weft.Error, name):
                    weft.Recording(path)


if __name__ == "__main__":
    main()
