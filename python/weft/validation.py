"""Weft's validation from Python: the command does it, for each of its runs is a process of its own anyway."""
import json
import os
import shutil
import subprocess
import tempfile
from typing import NamedTuple

from weft.errors import Error, InvalidArgument


class ValidationReport(NamedTuple):
    """What `weft validate` found: docs/validation.md has the meaning of its numbers."""

    passed: bool
    summary: dict
    checks: list  # a dict for each check
    folder: str  # with index.html, report.json and junit.xml; "" if nobody asked for them


def command():
    """The path of the `weft` command: WEFT_COMMAND, or that of this installation or build, or the first in PATH."""
    here = os.path.dirname(os.path.realpath(os.path.dirname(__file__)))
    # <build>/python/weft with <build>/bin, and <prefix>/lib/python3.x/dist-packages/weft with <prefix>/bin.
    beside = [os.path.join(here, *[os.pardir] * levels, "bin", "weft") for levels in (1, 3)]
    candidates = [os.environ["WEFT_COMMAND"]] if "WEFT_COMMAND" in os.environ else [*beside, shutil.which("weft") or ""]
    for path in candidates:
        if os.access(path, os.X_OK):
            return os.path.normpath(path)
    raise Error(f"the weft command is at none of: {', '.join(filter(None, candidates))}; expected it there, in PATH or in WEFT_COMMAND")


def validate(*cases, quick=False, output=None, parameters=None):
    """Runs validation cases (none: all of them, which takes half an hour; quick: those of the commit tier) and returns a ValidationReport.
    parameters: one point of one case, as in `weft validate oscillator --mass 2`."""
    if quick and cases:
        raise InvalidArgument(f"validate: quick=True and cases {', '.join(cases)}, expected one of the two")
    arguments = [command(), "validate", *cases, "--no-pictures", *(["--quick"] if quick else [])]
    for name, value in (parameters or {}).items():
        arguments += [f"--{name.replace('_', '-')}", repr(float(value))]
    with tempfile.TemporaryDirectory(prefix="weft-") as temporary:
        folder = os.fspath(output) if output is not None else temporary
        done = subprocess.run([*arguments, "--output", folder], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode not in (0, 1):  # 1: a check has failed, which the report says
            lines = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith("Try:")]
            raise InvalidArgument(f"validate: {lines[-1] if lines else f'ended with status {done.returncode}'}")
        with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
    return ValidationReport(report["passed"], report["summary"], report["checks"], folder if output is not None else "")
