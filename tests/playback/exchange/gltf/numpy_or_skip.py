"""import numpy_or_skip: goes on with a Python that has NumPy, or ends with status 77, which counts as skipped."""
import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

# The system's Python has Debian's package python3-numpy, another one in front of it need not.
if importlib.util.find_spec("numpy") is None:
    system = "/usr/bin/python3"
    if Path(sys.executable).resolve() != Path(system).resolve() and shutil.which(system):
        sys.exit(subprocess.run([system, *sys.argv]).returncode)
    print("skipped: NumPy is not here (Debian: python3-numpy)")
    sys.exit(77)
