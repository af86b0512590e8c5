"""A world of cloth and rigid bodies."""
import itertools
from dataclasses import dataclass
from typing import NamedTuple

from weft import _core, _native
from weft import laws as _laws
from weft._arguments import count, instance, number, optional_number
from weft.cloth import Cloth

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_ZERO = (0.0, 0.0, 0.0)


class StepReport(NamedTuple):
    """What the steps of one call did."""

    time: float  # [s] of the world
    largest_error: float  # [m] of a step of implicit springs
    unfinished_steps: int  # whose budget ended before the tolerance was met
    num_tears: int  # nodes that tears have added


@dataclass(frozen=True)
class Solver:
    """How implicit springs are solved (docs/fast_solver.md)."""

    tolerance: float = 0.001
    newton_iterations: int = 24
    linear_iterations: int = 200
    may_sleep: bool = True
    sleep_speed: float = 0.005  # [m/s]
    sleep_time: float = 1.0  # [s]


@dataclass(frozen=True)
class Tear:
    """When a cloth tears: beyond a strain [-] of the edges of a set, each with its limit times 1 - variation to 1 + variation. weak: node
    sets of the mesh with a limit of their own."""

    strain: float
    edge_set: str = "stretch"
    variation: float = 0.0
    max_splits: int = 4
    weak: tuple = ()


class World:
    """Bullet's soft-body world with Weft's solver, in SI units.

    gravity [m/s^2] acts on rigid bodies, and on every cloth whose laws name no gravity. precision: "float32" or "float64", one in a
    process; None: the one that the process has, or else "float32".
    """

    def __init__(self, gravity=(0.0, -9.81, 0.0), *, precision=None, solver=Solver(), distance_field_voxel=0.05):
        self._module = _native.world_module(precision or _native.loaded_precision() or "float32")
        self._native = self._module.World(gravity, number("world", "distance_field_voxel", distance_field_voxel, "m"))
        self.solver = instance("world", "solver", solver, Solver, "a weft.Solver")

    def __repr__(self):
        return f"<weft.World: {len(self.cloths)} cloths, {len(self.bodies)} bodies, t = {self.time:.6g} s, {self.precision}>"

    @property
    def precision(self):
        return self._module.precision

    @property
    def gravity(self):
        return self._native.gravity

    @property
    def time(self):
        """[s] simulated so far."""
        return self._native.time

    @property
    def cloths(self):
        return [Cloth(one) for one in self._module.cloths(self._native)]

    @property
    def bodies(self):
        return self._module.bodies(self._native)

    def __getitem__(self, name):
        """The cloth or body of this name."""
        for one in itertools.chain(self.cloths, self.bodies):
            if one.name == name:
                return one
        raise KeyError(name)

    def step(self, time_step, steps=1):
        """Takes steps of time_step [s] without the lock of the interpreter. Ctrl-C ends a call between two steps."""
        found = self._native.step(number("world", "time_step", time_step, "s"), count("world", "steps", steps))
        return StepReport(self.time, *found)

    def add_cloth(self, mesh, laws, *, name=None, margin=0.01, friction=0.5, self_collision=False, cloth_collision=False,
                  thickness=None, tear=None, can_be_cut=False, velocity=_ZERO, implicit=True, solver=None):
        """Adds a cloth of a weft.Mesh. margin [m]: distance at which it rests on a surface; thickness [m] that its layers keep
        (None: twice margin); velocity [m/s] of all free nodes; implicit: springs by the fast solver, stable at any step."""
        name = self._name(name, "cloth")
        where = f"cloth '{name}'"
        instance(where, "mesh", mesh, _core.Mesh, "a weft.Mesh, as of weft.grid() or weft.surface()")
        return Cloth(self._module.add_cloth(
            self._native, name, mesh, self._all_laws(laws), number(where, "margin", margin, "m"), number(where, "friction", friction, "1"),
            bool(implicit), self._fast(where, solver), bool(self_collision), bool(cloth_collision),
            optional_number(where, "thickness", thickness, "m"), _tear_rule(where, tear), bool(can_be_cut), velocity))

    def adopt(self, vertices, triangles, mass, *, name=None, stiffness=None, link_factor=1.0, bending_factor=None, laws=(), time_step=1 / 60,
              iterations=10, margin=0.01, friction=0.5, damping=0.0, cloth_collision=False, pins=(), solver=None):
        """Makes a soft body of arrays by Bullet's own calls, as PyBullet does, and adopts it: its links become implicit springs, with
        stiffness [N/m], or with what link_factor (kLST) means at time_step [s] and so many iterations."""
        name = self._name(name, "cloth")
        where = f"cloth '{name}'"
        return Cloth(self._module.adopt(
            self._native, name, vertices, triangles, self._all_laws(laws), optional_number(where, "stiffness", stiffness, "N/m"),
            number(where, "time_step", time_step, "s"), self._fast(where, solver), number(where, "mass", mass, "kg"),
            number(where, "link_factor", link_factor, "1"), optional_number(where, "bending_factor", bending_factor, "1"),
            count(where, "iterations", iterations), number(where, "margin", margin, "m"), number(where, "friction", friction, "1"),
            number(where, "damping", damping, "1"), bool(cloth_collision), pins))

    def add_sphere(self, radius, **options):
        """Adds a rigid ball. Options of all bodies: name, position [m], orientation (x, y, z, w), mass [kg] (0: fixed), kinematic,
        friction, restitution, velocity [m/s], angular_velocity [rad/s]."""
        return self._add("sphere", options, number("sphere", "radius", radius, "m"))

    def add_box(self, half_extents, **options):
        return self._add("box", options, half_extents)

    def add_plane(self, **options):
        """Adds the half space below the body's x-z plane. It has no end."""
        return self._add("plane", options)

    def add_capsule(self, radius, height, **options):
        """Adds a capsule along its y axis; height [m] of the cylinder between the caps."""
        return self._add("capsule", options, number("capsule", "radius", radius, "m"), number("capsule", "height", height, "m"))

    def add_cylinder(self, radius, height, **options):
        return self._add("cylinder", options, number("cylinder", "radius", radius, "m"), number("cylinder", "height", height, "m"))

    def add_hull(self, points, **options):
        """Adds the convex hull of points (4 to 128, 3) [m]."""
        return self._add("hull", options, points)

    def add_mesh(self, vertices, triangles, **options):
        """Adds a surface that is solid behind its fronts, fixed or kinematic."""
        return self._add("mesh", options, vertices, triangles)

    def remove(self, one):
        """Takes a cloth or body out of the world; nothing happens if it is out already."""
        self._module.remove(self._native, one._native if isinstance(one, Cloth) else one)

    def _add(self, shape, options, *arguments):
        known = dict(name=None, position=_ZERO, orientation=_NO_TURN, mass=0.0, kinematic=False, friction=0.5, restitution=0.0,
                     velocity=_ZERO, angular_velocity=_ZERO)
        for option in options:
            if option not in known:
                raise TypeError(f"add_{shape}() has no option '{option}', expected one of {', '.join(known)}")
        known.update(options)
        name = known["name"] = self._name(known["name"], shape)
        for option, unit in (("mass", "kg"), ("friction", "1"), ("restitution", "1")):
            known[option] = number(f"body '{name}'", option, known[option], unit)
        known["kinematic"] = bool(known["kinematic"])
        return getattr(self._module, f"add_{shape}")(self._native, *known.values(), *arguments)

    def _fast(self, where, solver):
        solver = instance(where, "solver", solver or self.solver, Solver, "a weft.Solver")
        where += ": solver"
        return self._module.FastSettings(
            number(where, "tolerance", solver.tolerance, "1"), count(where, "newton_iterations", solver.newton_iterations),
            count(where, "linear_iterations", solver.linear_iterations), bool(solver.may_sleep),
            number(where, "sleep_speed", solver.sleep_speed, "m/s"), number(where, "sleep_time", solver.sleep_time, "s"))

    def _all_laws(self, given):
        laws = _laws.laws_from(given)
        if any(self.gravity) and not any(law.name == "gravity" for law in laws):
            laws.append(_laws.Law("gravity", {"acceleration": self.gravity}))
        return [_laws._tuple_of(law) for law in laws]

    def _name(self, name, kind):
        if name is not None:
            return instance("world", "name", name, str, "a text")
        taken = {one.name for one in itertools.chain(self.cloths, self.bodies)}
        return next(free for number in itertools.count(1) if (free := f"{kind}_{number}") not in taken)


def _tear_rule(where, tear):
    """What the extension modules take."""
    if tear is None:
        return None
    instance(where, "tear", tear, Tear, "weft.Tear(strain=...)")
    where += ": tear"
    weak = [(instance(where, "node set", name, str, "a name"), number(where, "strain", strain, "1")) for name, strain in tear.weak]
    return (instance(where, "edge_set", tear.edge_set, str, "a name"), number(where, "strain", tear.strain, "1"),
            number(where, "variation", tear.variation, "1"), count(where, "max_splits", tear.max_splits), weak)
