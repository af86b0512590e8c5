"""Weft: cloth and soft characters for the Bullet physics engine, in SI units and validated. docs/python.md has the manual."""
from weft import laws
from weft._core import Mesh, grid, read_mesh, rope, sphere, surface
from weft._core import version as __version__
from weft.cloth import BlowUp, Cloth, Contacts, StepError
from weft.errors import Error, InvalidArgument, StaleArray
from weft.recording import Recording
from weft.scene import ENGINES, Scene, scene_names
from weft.validation import ValidationReport, validate
from weft.world import Solver, StepReport, Tear, World

__all__ = ["BlowUp", "Cloth", "Contacts", "ENGINES", "Error", "InvalidArgument", "Mesh", "Recording", "Scene", "Solver", "StaleArray",
           "StepError", "StepReport", "Tear", "ValidationReport", "World", "grid", "laws", "read_mesh", "rope", "scene_names", "sphere", "surface", "validate"]
