"""Loads the extension modules. Bullet's two precisions cannot live in one process, so the first world decides (docs/python.md)."""
import importlib
import sys

from weft import _core
from weft.errors import Error, InvalidArgument

PRECISIONS = ("float32", "float64")
_loaded = None

core = _core


def loaded_precision():
    """"float32", "float64", or None while no world has been made."""
    return _loaded.precision if _loaded else None


def world_module(precision):
    """The module with Bullet in this precision; Error if the process has the other one already."""
    global _loaded
    if precision not in PRECISIONS:
        raise InvalidArgument(f"precision = {precision!r}, expected 'float32' or 'float64'")
    if _loaded and _loaded.precision != precision:
        raise Error(f"precision = '{precision}': this process has Bullet in {_loaded.precision} already, and both cannot live in one "
                    "process; expected one precision, or another process (multiprocessing with the method 'spawn')")
    if "pybullet" in sys.modules:
        raise Error("pybullet is loaded in this process: it has a Bullet of its own with the same symbols; expected another process")
    if not _loaded:
        try:
            _loaded = importlib.import_module(f"weft._{precision}")
        except ImportError as error:
            raise Error(f"precision = '{precision}': Weft was built without Bullet in this precision ({error})") from error
    return _loaded
