"""Cloth over a ball in Python: arrays that share memory with Bullet, contacts, a law that changes, and a scene of the catalog."""
import numpy as np
import weft

world = weft.World()
world.add_sphere(radius=0.5, friction=0.5, name="ball")
cloth = world.add_cloth(weft.grid(nodes=(40, 40), size=(2, 2), mass=0.5, center=(0, 0.6, 0)),
                        laws={"tension": {"stiffness": 500}, "velocity_damping": {"rate": 0.5}})
for _ in range(180):
    world.step(1 / 60)
print(f"the cloth is {cloth.state} and reaches down to {cloth.positions[:, 1].min():.2f} m")

# An array shows the nodes themselves: what is written is where the next step starts.
x = cloth.positions
x += (0, 0.3, 0)
world.step(1 / 60)
assert x[:, 1].max() > 0.75 and np.shares_memory(x, cloth.positions)

# Back on the ball, which bears its weight of 0.5 kg.
world.step(1 / 60, steps=240)
contacts = cloth.contacts()
weight = contacts.impulse.sum(axis=0)[1] * 60
print(f"{len(contacts.node)} nodes press on '{contacts.body[0]}' with {weight:.2f} N")
assert abs(weight - 0.5 * 9.81) < 0.5

# Any law by name; a mistake says what was expected.
cloth.set("wind", velocity=(3, 0, 0))
world.step(1 / 60, steps=60)
assert x[:, 0].mean() > 0.02
try:
    cloth.set("wind", velocity=3)
except ValueError as error:
    print(error)
else:
    raise AssertionError("a wind of one number was taken")

# A scene of the catalog, as `weft run` records it.
recording = weft.Scene("hang").run("reference", duration=0.2)
print(recording, "lowest node:", recording.positions()[-1, :, 1].min().round(3), "m")
assert recording.report.blow_up is None and len(recording) > 5
