"""A cloth of a world."""
from typing import NamedTuple

import numpy as np

from weft import laws as _laws
from weft.node_array import node_array


class BlowUp(NamedTuple):
    """Why a cloth does not move any more; numerical trouble is data."""

    node: int  # -1: no single one
    reason: str


class StepError(NamedTuple):
    """How far the last step of a cloth with implicit springs was solved."""

    distance: float  # [m] root mean square of the nodes from the solution, a bound by estimate
    newton_iterations: int
    is_within_tolerance: bool


class Contacts(NamedTuple):
    """What touched a cloth in the last step, in ascending order of nodes; an entry of each array for each contact."""

    node: np.ndarray
    point: np.ndarray  # (k, 3) [m] of the body's surface
    normal: np.ndarray  # (k, 3) out of the body
    impulse: np.ndarray  # (k, 3) [N s] of the body on the node, friction included
    is_sticking: np.ndarray
    body: list  # names

    def __repr__(self):
        return f"<weft.Contacts: {len(self.node)}>"


class Cloth:
    """A cloth of a world; World.add_cloth() and World.adopt() make it. It keeps its world alive."""

    def __init__(self, native):
        self._native = native

    def __repr__(self):
        if self.is_removed:
            return f"<weft.Cloth '{self.name}', removed>"
        return f"<weft.Cloth '{self.name}': {len(self)} nodes, {self.state}>"

    def __len__(self):
        return len(self._native)

    def __eq__(self, other):
        return isinstance(other, Cloth) and self._native.is_same(other._native)

    def __hash__(self):
        return hash(self.name)

    @property
    def name(self):
        return self._native.name

    @property
    def is_removed(self):
        return self._native.is_removed

    @property
    def positions(self):
        """(n, 3) [m], the nodes themselves: nothing is copied, and what is written is there in the next step."""
        return node_array(self._native.positions(), self._native)

    @positions.setter
    def positions(self, values):
        self.positions[...] = values

    @property
    def velocities(self):
        """(n, 3) [m/s], likewise."""
        return node_array(self._native.velocities(), self._native)

    @velocities.setter
    def velocities(self, values):
        self.velocities[...] = values

    @property
    def triangles(self):
        """(t, 3) nodes, counter-clockwise seen from the front; a copy."""
        return self._native.triangles()

    @property
    def masses(self):
        """(n,) [kg]; a copy. Pinned nodes of an adopted body have 0."""
        return self._native.masses()

    @property
    def pins(self):
        return self._native.pins()

    @property
    def laws(self):
        """The laws as they act, with their defaults."""
        return [_laws._law_of(row) for row in self._native.laws()]

    def set(self, law, **parameters):
        """Gives the cloth this law in place of those with its name and sets: set(laws.tension(stiffness=500)), set("tension", stiffness=500)."""
        if isinstance(law, str):
            law = _laws._law_from_dict(law, parameters)
        elif parameters:
            raise TypeError("set() takes parameters for a law by name only")
        (law,) = _laws.laws_from([law])
        self._native.set_law(_laws._tuple_of(law))

    def remove_law(self, name):
        self._native.remove_law(name)

    @property
    def state(self):
        """"awake", "asleep", "suspended", "blown up", or "without laws"."""
        return self._native.state()

    @property
    def blow_up(self):
        """BlowUp, or None: the cloth has not blown up."""
        found = self._native.blow_up()
        return BlowUp(*found) if found else None

    @property
    def step_error(self):
        return StepError(*self._native.step_error())

    def contacts(self):
        """The contacts with rigid bodies that bore anything in the last step."""
        return Contacts(*self._native.contacts())

    @property
    def num_contacts(self):
        """Contacts with rigid bodies and with cloth that the last step looked at."""
        return self._native.num_contacts()

    def move_pins(self, nodes, targets):
        """Moves pinned nodes, in ascending order, to targets (k, 3) [m] within the next step, and springs and contacts with them."""
        self._native.move_pins(nodes, targets)

    def add_forces(self, forces, nodes=None):
        """Forces (k, 3) [N] on nodes (None: all) in the next step, beside the laws."""
        self._native.add_forces(nodes, forces)

    def anchor(self, node, body, collides=False):
        """Ties a node to where it is on a rigid body. collides: the cloth still meets the body."""
        self._native.anchor(node, body, collides)

    def release(self):
        """Takes away all anchors of the cloth; how many there were."""
        return self._native.release()

    def wake(self):
        self._native.wake()

    @property
    def adoption(self):
        """For an adopted cloth: (what, fate, how) of each property of Bullet's body."""
        return self._native.adoption()

    def cut(self, start, end, depth):
        """Cuts by a blade, the parallelogram around the line from start to end that reaches depth to both sides [m]; how many nodes
        that added. The cloth needs can_be_cut=True or a tear rule."""
        return self._native.cut(start, end, depth)
