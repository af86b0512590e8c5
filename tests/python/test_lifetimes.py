"""Worlds, cloths, bodies and arrays may end in any order, and nothing is left behind."""
import gc
import itertools
import random
import unittest
import weakref

import numpy as np
import weft
from support import LAWS, PRECISION, main, sheet, world


def make():
    a_world = world()
    ball = a_world.add_sphere(0.2, position=(0, -0.3, 0), mass=1)
    cloth = a_world.add_cloth(sheet(7), LAWS)
    a_world.step(0.01)
    return {"world": a_world, "cloth": cloth, "ball": ball, "array": cloth.positions, "plain": np.asarray(cloth.velocities)}


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


class Lifetimes(unittest.TestCase):
    def test_everything_may_end_in_any_order(self):
        for order in itertools.permutations(["world", "cloth", "ball", "array", "plain"]):
            things = make()
            native = weakref.ref(things["world"]._native)
            for name in order:
                del things[name]
                [repr(left) for left in things.values()]
            gc.collect()
            self.assertIsNone(native(), order)

    def test_a_cloth_keeps_its_world_in_motion(self):
        things = make()
        cloth, step = things["cloth"], things["world"].step
        del things
        before = cloth.positions.copy()
        step(0.01)
        self.assertLess(cloth.positions[:, 1].mean(), before[:, 1].mean())

    def test_cycles_through_python_are_collected(self):
        things = make()

        class Owner:
            pass

        owner = Owner()
        owner.things = things
        owner.itself = owner
        owner.step = things["world"].step
        things["owner"] = owner
        native, me = weakref.ref(things["world"]._native), weakref.ref(owner)
        del owner, things
        gc.collect()
        self.assertIsNone(me())
        self.assertIsNone(native())

    def test_removed_things_end_when_nobody_has_them(self):
        a_world = world()
        kept = a_world.add_cloth(sheet(7), LAWS)
        for _ in range(3):
            cloth, ball = a_world.add_cloth(sheet(7), LAWS), a_world.add_sphere(0.2, mass=1)
            a_world.step(0.01)
            a_world.remove(cloth)
            a_world.remove(ball)
            a_world.remove(cloth)
            self.assertEqual(repr(cloth), f"<weft.Cloth '{cloth.name}', removed>")
            for call in (lambda: len(cloth), lambda: cloth.laws, lambda: cloth.set("tension", stiffness=1), lambda: cloth.contacts(),
                         lambda: cloth.state, lambda: ball.position, lambda: cloth.wake()):
                with self.assertRaisesRegex(weft.Error, "has been removed from its world"):
                    call()
            a_world.step(0.01)
        self.assertEqual(a_world.cloths, [kept])

    def test_memory_does_not_grow(self):
        def churn(count):
            for _ in range(count):
                make()
            gc.collect()

        churn(200)
        before = resident_bytes()
        churn(600)
        # A world of these is some 3 MB (Bullet's pools), most of it untouched: a leak of each would be far over the bound.
        self.assertLess(resident_bytes() - before, 30e6)

    def test_the_interpreter_ends_with_everything_alive(self):
        import subprocess
        import sys

        code = ("import sys, threading, weft\n"
                f"w = weft.World(precision={PRECISION!r})\n"
                "c = w.add_cloth(weft.grid((9, 9), (1, 1), 0.1), {'tension': {'stiffness': 100}})\n"
                "sys.kept = [c.positions, c, w]\n"
                "t = threading.Thread(target=lambda: w.step(0.01, steps=50)); t.start()\n"
                "weft.Scene('hang').run('reference', duration=0.01)\n")
        done = subprocess.run([sys.executable, "-X", "dev", "-c", code], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


class RandomCalls(unittest.TestCase):
    """Whatever is called in whatever order, a call does what it says or raises one of the module's errors."""

    def test_sequences(self):
        for seed in range(40):
            with self.subTest(seed=seed):
                self.sequence(random.Random(seed))

    def sequence(self, dice):
        worlds, cloths, bodies, arrays = [world()], [], [], []

        def point(scale=1.0):
            return [dice.uniform(-scale, scale) for _ in range(3)]

        def value():
            return dice.choice([dice.uniform(-2, 2), 0, float("nan"), float("inf"), 1e30, -1e30, 1e-30])

        def any_of(things):
            return dice.choice(things) if things else None

        def add_cloth():
            laws = dict(LAWS, wind={"velocity": point(5)}) if dice.random() < 0.3 else LAWS
            cloths.append(any_of(worlds).add_cloth(
                sheet(dice.randint(2, 9), center=point(), pins=dice.choice([[], [0], [0, 1]])), laws, self_collision=dice.random() < 0.3,
                cloth_collision=dice.random() < 0.3, implicit=dice.random() < 0.8, tear=dice.choice([None, None, weft.Tear(strain=0.2)]),
                velocity=point(3), can_be_cut=dice.random() < 0.5))

        def add_body():
            add = dice.choice(["add_sphere", "add_box", "add_plane", "add_capsule"])
            arguments = {"add_sphere": [0.3], "add_box": [(0.2, 0.3, 0.4)], "add_plane": [], "add_capsule": [0.2, 0.3]}[add]
            mass = dice.choice([0, 0, 1, 10]) if add != "add_plane" else 0
            bodies.append(getattr(any_of(worlds), add)(*arguments, position=point(), mass=mass, kinematic=mass == 0 and dice.random() < 0.5))

        def cloth_call():
            cloth = any_of(cloths)
            dice.choice([lambda: cloth.set("tension", stiffness=abs(value())), lambda: cloth.set(weft.laws.wind(velocity=point(9))),
                         lambda: cloth.remove_law("wind"), lambda: cloth.contacts(), lambda: repr(cloth), lambda: cloth.blow_up,
                         lambda: cloth.cut(point(), point(), point()), lambda: cloth.wake(), lambda: cloth.triangles, lambda: cloth.masses,
                         lambda: cloth.add_forces([point(5)], nodes=[0]), lambda: cloth.move_pins([0], [point()]), lambda: cloth.step_error,
                         lambda: cloth.anchor(dice.randint(0, 90), any_of(bodies)), lambda: cloth.release(), lambda: arrays.append(cloth.positions),
                         lambda: arrays.append(np.asarray(cloth.velocities)), lambda: cloth.laws, lambda: cloth.num_contacts])()

        def write():
            array = any_of(arrays)
            array[dice.randrange(len(array))] = point(2) if dice.random() < 0.8 else value()

        def body_call():
            body = any_of(bodies)
            dice.choice([lambda: setattr(body, "position", point(2)), lambda: setattr(body, "velocity", point(5)), lambda: body.add_force(point(50)),
                         lambda: body.orientation, lambda: setattr(body, "friction", value()), lambda: body.mass])()

        calls = [add_cloth, add_body, cloth_call, cloth_call, cloth_call, write, body_call, lambda: any_of(arrays).sum(),
                 lambda: any_of(worlds).step(dice.choice([1 / 60, 0.01, 1e-4, 0.1]), steps=dice.randint(1, 4)),
                 lambda: any_of(worlds).step(1 / 60), lambda: any_of(worlds).remove(any_of(cloths)), lambda: any_of(worlds).remove(any_of(bodies)),
                 lambda: worlds.append(world()) if len(worlds) < 3 else worlds.pop(dice.randrange(len(worlds))),
                 lambda: cloths.pop(dice.randrange(len(cloths))), lambda: arrays.pop(dice.randrange(len(arrays))), gc.collect]
        done = 0
        for _ in range(120):
            if not worlds:
                worlds.append(world())
            try:
                dice.choice(calls)()
                done += 1
            except weft.Error:
                pass
            except (TypeError, AttributeError, ValueError, IndexError):
                # There was nothing to call it on.
                if cloths and bodies and arrays:
                    raise
        self.assertGreater(done, 20)


if __name__ == "__main__":
    main()
