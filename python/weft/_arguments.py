"""Checks of what a caller gives for a number, before it goes to the extension modules: one line that names it."""
from numbers import Integral, Real

from weft.errors import InvalidArgument


def number(where, name, value, unit):
    """The value as a float."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InvalidArgument(f"{where}: {name} = {value!r}, expected a number in {unit}")
    return float(value)


def optional_number(where, name, value, unit):
    return None if value is None else number(where, name, value, unit)


def count(where, name, value):
    """The value as an int."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise InvalidArgument(f"{where}: {name} = {value!r}, expected a whole number")
    if not -2**31 <= value < 2**31:
        raise InvalidArgument(f"{where}: {name} = {value}, expected a number of 32 bits")
    return int(value)


def instance(where, name, value, kind, expected):
    """The value, which is of this type."""
    if not isinstance(value, kind):
        raise InvalidArgument(f"{where}: {name} = {value!r}, expected {expected}")
    return value
