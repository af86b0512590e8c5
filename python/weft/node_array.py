"""NumPy arrays that show the nodes of a cloth, and refuse to be used when the cloth has other nodes."""
import numpy as np

from weft.errors import StaleArray

# What NumPy and this class need even of a stale array.
_ALWAYS = frozenset({"_lease", "__class__", "__dict__", "__array_finalize__", "__array_ufunc__", "__array_function__", "__array_priority__"})


class Lease:
    """The right to show the nodes of a cloth, which ends when it tears or leaves its world."""

    __slots__ = ("_cloth", "_generation")

    def __init__(self, cloth):
        self._cloth = cloth
        self._generation = cloth.generation

    def check(self):
        if self._cloth.generation == self._generation:
            return
        why = "has been removed from its world" if self._cloth.is_removed else "has torn, and has other nodes now"
        raise StaleArray(f"cloth '{self._cloth.name}' {why}: an array of its nodes is out of date, expected one that is taken anew")


def _plain(value):
    """The value with NodeArrays as plain arrays of the same memory, once they are found to be up to date."""
    if isinstance(value, NodeArray):
        value._check()
        return value.view(np.ndarray)
    if isinstance(value, (list, tuple)):
        return type(value)(map(_plain, value)) if not hasattr(value, "_fields") else value
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    return value


class NodeArray(np.ndarray):
    """An array (n, 3) in the memory of the nodes. Parts of it (slices) show that memory too; results of computations are plain arrays.

    After a tear every use of it raises StaleArray. np.asarray(x) gives a plain array of the same memory, which cannot raise; its
    memory stays alive as long as it does.
    """

    _lease = None

    def __array_finalize__(self, source):
        lease = getattr(source, "_lease", None)
        # A copy has memory of its own, which no tear takes away.
        if lease is not None and np.may_share_memory(self, source):
            self._lease = lease

    def _check(self):
        if self._lease is not None:
            self._lease.check()

    def __getattribute__(self, name):
        if name not in _ALWAYS and name != "_check":
            object.__getattribute__(self, "_check")()
        return super().__getattribute__(name)

    def __array_ufunc__(self, ufunc, method, *inputs, out=None, **keywords):
        if out is not None:
            keywords["out"] = tuple(_plain(one) for one in out)
        result = getattr(ufunc, method)(*map(_plain, inputs), **{key: _plain(one) for key, one in keywords.items()})
        # x += y must give x itself.
        return out[0] if out is not None and len(out) == 1 and method != "at" else result

    def __array_function__(self, function, types, arguments, keywords):
        return function(*map(_plain, arguments), **{key: _plain(one) for key, one in keywords.items()})

    def __getitem__(self, key):
        self._check()
        return super().__getitem__(key)

    def __setitem__(self, key, value):
        self._check()
        super().__setitem__(key, _plain(value))

    def __iter__(self):
        self._check()
        return super().__iter__()

    def __len__(self):
        self._check()
        return super().__len__()

    def __repr__(self):
        self._check()
        return super().__repr__()

    def __str__(self):
        self._check()
        return super().__str__()


def node_array(array, cloth):
    """The array, of the memory of the nodes, as one with a lease."""
    result = array.view(NodeArray)
    result._lease = Lease(cloth)
    return result
