"""Scenes: from the catalog, from files and from text; and their runs."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import weakref
from typing import NamedTuple, Optional

from weft import _core, _native
from weft._arguments import optional_number
from weft.errors import Error, InvalidArgument
from weft.recording import RecordedBlowUp, Recording

# The reference first: what a scene is run on that names no engine.
ENGINES = tuple(sorted(_core.engines, key=lambda name: name != "reference"))


class RunReport(NamedTuple):
    """What came of a run."""

    steps: int
    frames: int
    time: float  # [s] reached
    blow_up: Optional[RecordedBlowUp]
    largest_error: Optional[float]  # [m] of a step, of an engine that iterates
    unfinished_steps: int
    engine_seconds: float  # [s] of wall time in the engine alone
    content_hash: str


def scene_names():
    """The scenes that come with Weft."""
    return _core.scene_names()


class Scene:
    """A scene of the catalog, by name, or of a TOML file, by path."""

    def __init__(self, name_or_path):
        self._scene = _core.load_scene(os.fspath(name_or_path))
        name = os.fspath(name_or_path)
        # A name of the catalog goes before a file of the same name.
        self._source = {"load": name if name in scene_names() else os.path.abspath(name)}

    @classmethod
    def from_text(cls, text, name="scene"):
        """A scene from TOML that names no file; name stands for the file in messages."""
        scene = cls.__new__(cls)
        scene._scene = _core.read_scene_text(text, name)
        scene._source = {"text": text, "name": name}
        return scene

    def __repr__(self):
        return f"<weft.Scene '{self.name}': {', '.join(self.cloths)}>"

    name = property(lambda self: self._scene.name)
    summary = property(lambda self: self._scene.summary)
    text = property(lambda self: self._scene.text, doc="TOML with every default written out.")
    engines = property(lambda self: self._scene.engines or list(ENGINES), doc="Names of the engines that it is made for.")
    duration = property(lambda self: self._scene.duration, doc="[s]")
    time_step = property(lambda self: self._scene.time_step, doc="[s]")
    frame_interval = property(lambda self: self._scene.frame_interval, doc="[s]")
    gravity = property(lambda self: self._scene.gravity, doc="[m/s^2]")
    cloths = property(lambda self: self._scene.cloths, doc="Names.")
    colliders = property(lambda self: self._scene.colliders, doc="Names.")

    def run(self, engine=None, *, precision=None, duration=None, time_step=None, output=None, replace=False):
        """Runs and records the scene, as `weft run` does and with the same bits, and returns the Recording; recording.report is a
        RunReport. duration and time_step [s] in place of the scene's. Without output the recording lasts as long as the object.

        A precision that this process cannot have any more is run by a Python process of its own.
        """
        engine = engine or self.engines[0]
        if engine not in ENGINES or not self._scene.is_for_engine(engine):
            raise InvalidArgument(f"scene '{self.name}': engine = {engine!r}, expected one of {', '.join(self.engines)}")
        if precision is None:
            precision = "float64" if engine == "reference" else _native.loaded_precision() or "float32"
        if precision not in _native.PRECISIONS or (engine == "reference" and precision != "float64"):
            raise InvalidArgument(f"scene '{self.name}': precision = {precision!r} of {engine}, expected " +
                                  ("'float64'" if engine == "reference" else "'float32' or 'float64'"))
        where = f"scene '{self.name}'"
        duration, time_step = optional_number(where, "duration", duration, "s"), optional_number(where, "time_step", time_step, "s")
        folder = None
        if output is None:
            folder = tempfile.mkdtemp(prefix="weft-")
            output = os.path.join(folder, f"{self.name}_{engine}_{precision}.weftrec")
        try:
            values = self._run(engine, precision, os.fspath(output), bool(replace), duration, time_step)
            recording = Recording(output)
        except BaseException:
            if folder:
                shutil.rmtree(folder, ignore_errors=True)
            raise
        if folder:
            weakref.finalize(recording, shutil.rmtree, folder, True)
        if values["blow_up"]:
            values["blow_up"] = RecordedBlowUp(**values["blow_up"])
        recording.report = RunReport(**values)
        return recording

    def _run(self, engine, precision, output, replace, duration, time_step):
        if engine == "reference":
            return _core.run_reference(self._scene, output, replace, duration, time_step)
        if _native.loaded_precision() in (None, precision):
            return _native.world_module(precision).run_engine(self._scene, engine, output, replace, duration, time_step)
        request = dict(self._source, engine=engine, precision=precision, output=os.path.abspath(output), replace=replace,
                       duration=duration, time_step=time_step)
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join([os.path.dirname(os.path.dirname(__file__))] +
                                                                  os.environ.get("PYTHONPATH", "").split(os.pathsep)))
        done = subprocess.run([sys.executable, "-m", "weft._run_elsewhere"], input=json.dumps(request), env=environment,
                              stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0 or not done.stdout:
            raise Error(f"scene '{self.name}': the process that ran it in {precision} ended with status {done.returncode}")
        answer = json.loads(done.stdout)
        if "error" in answer:
            raise {"InvalidArgument": InvalidArgument}.get(answer["error"], Error)(answer["message"])
        return answer
