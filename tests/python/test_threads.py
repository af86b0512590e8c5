"""The interpreter goes on while a world is stepped, and other threads are refused in the meantime."""
import threading
import time
import unittest

import numpy as np
import weft
from support import LAWS, PRECISION, main, sheet, world


class Ticks:
    """A thread of Python that notes the time, over and over."""

    def __enter__(self):
        self.times = []
        self._stop = False
        self._thread = threading.Thread(target=self._run)
        self._thread.start()
        while not self.times:
            time.sleep(0.001)
        return self

    def _run(self):
        while not self._stop:
            self.times.append(time.perf_counter())
            time.sleep(0.0005)

    def __exit__(self, *_):
        self._stop = True
        self._thread.join()

    def between(self, start, end):
        return sum(start < one < end for one in self.times)


def heavy_world():
    """A world whose first step takes some tenths of a second."""
    a_world = world()
    cloth = a_world.add_cloth(sheet(110, pins=[0]), {"tension": {"stiffness": 20000.0}})
    return a_world, cloth


class Threads(unittest.TestCase):
    def test_python_goes_on_during_a_single_step(self):
        a_world, _ = heavy_world()
        with Ticks() as ticks:
            start = time.perf_counter()
            a_world.step(1 / 60)  # one step: between two of them the lock is asked for anyway
            end = time.perf_counter()
        self.assertGreater(end - start, 0.02, "the step is too short to tell")
        # The middle half, so that what begins and ends the call does not count.
        quarter = (end - start) / 4
        self.assertGreaterEqual(ticks.between(start + quarter, end - quarter), 3)

    def test_python_goes_on_during_a_run_of_a_scene(self):
        with Ticks() as ticks:
            start = time.perf_counter()
            weft.Scene("drape_sphere").run("reference", duration=0.5)
            end = time.perf_counter()
        quarter = (end - start) / 4
        self.assertGreaterEqual(ticks.between(start + quarter, end - quarter), 10)

    def test_a_world_in_use_refuses_other_threads(self):
        a_world, cloth = heavy_world()
        ball = a_world.add_sphere(1, position=(9, 0, 0))
        started = threading.Event()

        def run():
            started.set()
            a_world.step(1 / 60, steps=25)

        thread = threading.Thread(target=run)
        thread.start()
        started.wait()
        refused = {}
        calls = {"step": lambda: a_world.step(0.01), "positions": lambda: cloth.positions, "add": lambda: a_world.add_sphere(1),
                 "remove": lambda: a_world.remove(cloth), "law": lambda: cloth.set("tension", stiffness=1), "body": lambda: ball.position,
                 "contacts": cloth.contacts}
        while thread.is_alive() and len(refused) < len(calls):
            for name, call in calls.items():
                if name in refused or not thread.is_alive():
                    continue
                try:
                    # Before the other thread is in its step a call may still succeed; those that change nothing are asked first.
                    cloth.num_contacts
                except weft.Error:
                    with self.assertRaisesRegex(weft.Error, "is being stepped by another thread, expected calls between steps only"):
                        call()
                    refused[name] = True
            time.sleep(0.001)
        thread.join()
        self.assertEqual(set(refused), set(calls))
        self.assertEqual(len(cloth), 12100)

    def test_worlds_in_threads_of_their_own_have_the_same_bits(self):
        def run(results, index):
            a_world = world()
            a_world.add_sphere(0.3, position=(0, -0.4, 0))
            cloth = a_world.add_cloth(sheet(25), LAWS)
            a_world.step(1 / 60, steps=60)
            results[index] = cloth.positions.copy()

        results = [None] * 4
        run(results, 0)
        threads = [threading.Thread(target=run, args=(results, i)) for i in (1, 2, 3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for other in results[1:]:
            np.testing.assert_array_equal(results[0], other)


if __name__ == "__main__":
    main()
