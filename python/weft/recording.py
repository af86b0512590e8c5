"""Recordings of scenes, frame by frame, as NumPy arrays."""
import os
from dataclasses import dataclass
from typing import NamedTuple, Optional

import numpy as np

from weft import _core
from weft.errors import InvalidArgument


class RigidState(NamedTuple):
    position: tuple  # [m] of the centre of mass
    orientation: tuple  # quaternion (x, y, z, w)
    velocity: tuple  # [m/s]
    angular_velocity: tuple  # [rad/s]


@dataclass(frozen=True)
class ClothFrame:
    """A cloth at one time, in the precision of the recording."""

    positions: np.ndarray  # (n, 3) [m]
    velocities: np.ndarray  # (n, 3) [m/s]
    triangles: Optional[np.ndarray]  # once it has torn; None: those of its mesh


@dataclass(frozen=True)
class Frame:
    time: float  # [s]
    cloths: dict  # name -> ClothFrame
    bodies: dict  # name -> RigidState


class RecordedBlowUp(NamedTuple):
    step: int
    time: float  # [s]
    body: str
    node: int
    reason: str


class Recording:
    """A recording that `weft run`, Scene.run() or a program's recorder has written. recording[i] is a Frame."""

    def __init__(self, path):
        self.path = os.fspath(path)
        self._reader = _core.RecordingReader(self.path)

    def __repr__(self):
        state = "finished" if self.finished else "unfinished"
        return f"<weft.Recording '{self.path}': {len(self)} frames, {self.precision}, {state}>"

    def __len__(self):
        return len(self._reader)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        frame = self._reader.frame(index)
        return Frame(frame["time"], {name: ClothFrame(**cloth) for name, cloth in frame["cloths"].items()},
                     {name: RigidState(**body) for name, body in frame["bodies"].items()})

    def __iter__(self):
        return (self[i] for i in range(len(self)))

    @property
    def times(self):
        """(frames,) [s]"""
        return self._reader.times()

    def positions(self, cloth=None):
        """(frames, n, 3) [m] of a cloth that does not tear; None: the only cloth."""
        return np.stack([frame.cloths[self._cloth(cloth)].positions for frame in self._whole(cloth)])

    def velocities(self, cloth=None):
        """(frames, n, 3) [m/s], likewise."""
        return np.stack([frame.cloths[self._cloth(cloth)].velocities for frame in self._whole(cloth)])

    def mesh(self, cloth=None):
        """The weft.Mesh that a cloth starts with."""
        return self._reader.first_mesh(self._cloth(cloth))

    def _cloth(self, name):
        names = self.cloths
        if name is None and len(names) == 1:
            return names[0]
        if name not in names:
            raise InvalidArgument(f"recording: cloth = {name!r}, expected one of {', '.join(names)}")
        return name

    def _whole(self, name):
        frames = list(self)
        if any(frame.cloths[self._cloth(name)].triangles is not None for frame in frames):
            raise InvalidArgument(f"recording: cloth '{self._cloth(name)}' tears, expected a number of nodes that stays: read frame by frame")
        return frames

    @property
    def cloths(self):
        """Names."""
        return self._reader.scene.cloths

    @property
    def scene_text(self):
        """The scene with all defaults, as TOML."""
        return self._reader.scene_text

    @property
    def provenance(self):
        return self._reader.provenance

    @property
    def precision(self):
        return self._reader.precision

    @property
    def finished(self):
        return self._reader.finished

    @property
    def content_hash(self):
        return self._reader.content_hash

    @property
    def blow_up(self):
        """RecordedBlowUp, or None."""
        found = self._reader.blow_up
        return RecordedBlowUp(**found) if found else None

    @property
    def metrics(self):
        """Names of recorded numbers."""
        return self._reader.metric_names

    def metric(self, name):
        """(times [s], values), an array each."""
        return self._reader.metric(name)
