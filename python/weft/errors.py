"""The errors of Weft. Each message is one line that names the place, the value, its unit and what was expected."""


class Error(Exception):
    """Something went wrong that is not a value of the caller's: a file that cannot be written, a world in use."""


class InvalidArgument(Error, ValueError):
    """A value out of its domain, an unknown name, an array of the wrong shape."""


class StaleArray(Error, BufferError):
    """An array of a cloth that has other nodes now, because it has torn or has left its world."""
