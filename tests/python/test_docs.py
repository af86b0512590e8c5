"""The samples of docs/python.md run, and its table knows every argument of PyBullet's loadSoftBody."""
import os
import re
import subprocess
import sys
import unittest

from support import main

PAGE = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "python.md")
# pybullet.c, pybullet_loadSoftBody().
ARGUMENTS = ("fileName basePosition baseOrientation scale mass collisionMargin useMassSpring useBendingSprings useNeoHookean springElasticStiffness "
             "springDampingStiffness springDampingAllDirections springBendingStiffness NeoHookeanMu NeoHookeanLambda NeoHookeanDamping frictionCoeff "
             "useFaceContact useSelfCollision repulsionStiffness simFileName physicsClientId").split()


class Page(unittest.TestCase):
    def setUp(self):
        with open(PAGE, encoding="utf-8") as file:
            self.text = file.read()

    def test_samples_run(self):
        samples = re.findall(r"```python\n(.*?)```", self.text, re.DOTALL)
        self.assertGreaterEqual(len(samples), 2)
        for sample in samples:
            lines = sample if sample.startswith("import weft") else "import weft\n" + sample
            done = subprocess.run([sys.executable, "-W", "error", "-c", lines], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""), sample)
        self.assertEqual(len(samples[0].splitlines()), 8)  # "ten lines"

    def test_every_argument_has_a_row(self):
        section = self.text[self.text.index("## I have PyBullet's `loadSoftBody`"):]
        named = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\|([^|]*)\|", section, re.MULTILINE))))
        self.assertEqual([one for one in ARGUMENTS if one not in named], [])

    def test_laws_of_the_table_can_be_made(self):
        import weft

        mesh = weft.surface([(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1)], [(0, 1, 2), (0, 2, 3)], 0.1)
        world = weft.World(precision=os.environ["WEFT_TEST_PRECISION"])
        laws = {"spring_damping": {"damping": 0.1}, "velocity_damping": {"rate": 1.0}, "hinge_torsion": {"rigidity": 1e-6}}
        given = [weft.laws.tension(stiffness=100, sets=["stretch"]), weft.laws.tension(stiffness=1, sets=["bend"]), *weft.laws.laws_from(laws)]
        cloth = world.add_cloth(mesh, given, margin=0.01, friction=0.5, self_collision=True, thickness=0.02, cloth_collision=True)
        world.step(1 / 60, steps=30)
        self.assertIsNone(cloth.blow_up)
        for name in re.findall(r'`"(\w+)"', self.text):
            if name.startswith("float"):
                continue
            self.assertIn(name, weft.laws.NAMES)


if __name__ == "__main__":
    main()
