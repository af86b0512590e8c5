"""Ctrl-C ends a call that takes long, and leaves world and recording in order."""
import glob
import os
import signal
import tempfile
import threading
import time
import unittest

import numpy as np
import weft
from support import LAWS, PRECISION, main, sheet, world


def interrupt_after(seconds):
    thread = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    thread.start()
    return thread


class Interrupts(unittest.TestCase):
    def test_steps_end_between_two_steps(self):
        a_world = world()
        cloth = a_world.add_cloth(sheet(21, pins=[0]), LAWS, solver=weft.Solver(may_sleep=False))
        timer = interrupt_after(0.3)
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            a_world.step(1 / 60, steps=10_000_000)
        self.assertLess(time.monotonic() - start, 20)
        timer.join()
        self.assertGreater(a_world.time, 0)
        before = a_world.time
        a_world.step(1 / 60)
        self.assertAlmostEqual(a_world.time, before + 1 / 60, places=5)
        self.assertTrue(np.isfinite(np.asarray(cloth.positions)).all())

    def test_a_run_keeps_its_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            timer = interrupt_after(1.0)
            with self.assertRaises(KeyboardInterrupt):
                weft.Scene("drape_sphere").run("reference", duration=1000, output=os.path.join(folder, "long.weftrec"))
            timer.join()
            (partial,) = glob.glob(os.path.join(folder, "*.partial.weftrec"))
            recording = weft.Recording(partial)
            self.assertFalse(recording.finished)
            self.assertGreater(len(recording), 0)

    def test_a_run_without_output_leaves_nothing(self):
        before = set(glob.glob(os.path.join(tempfile.gettempdir(), "weft-*")))
        timer = interrupt_after(1.0)
        with self.assertRaises(KeyboardInterrupt):
            weft.Scene("drape_sphere").run("reference", duration=1000)
        timer.join()
        self.assertEqual(set(glob.glob(os.path.join(tempfile.gettempdir(), "weft-*"))) - before, set())


if __name__ == "__main__":
    main()
