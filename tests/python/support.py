"""What the tests of the Python module share."""
import os
import tempfile
import unittest

import numpy as np
import weft

# Tests in double precision are the same files, run once more (CMakeLists.txt).
PRECISION = os.environ.get("WEFT_TEST_PRECISION", "float32")
SCALAR = np.dtype(PRECISION)


def world(**options):
    return weft.World(precision=PRECISION, **options)


def sheet(nodes=11, size=1.0, mass=0.2, **options):
    """A square sheet around the origin."""
    return weft.grid((nodes, nodes), (size, size), mass, **options)


LAWS = {"tension": {"stiffness": 500.0}, "velocity_damping": {"rate": 0.5}}


def main():
    # A folder of its own for temporary files, so that tests which look for what is left see no other test's.
    with tempfile.TemporaryDirectory(prefix="weft_test_") as folder:
        tempfile.tempdir = folder
        unittest.main(verbosity=1)
