#!/usr/bin/env python3
"""Checks that every library source says which test exercises it.

The tree of tests mirrors the tree of the library: tests/mesh/topology/hinges_test.cpp tests mesh/topology/hinges.hpp and mesh/topology/hinges.cpp.
A source without such a test names those that exercise it in one line near the top of its header, or of its .cpp file
if it has no header:

    // Tested by tests/mesh/topology/hinges_test.cpp, tests/mesh/cutting/tear_test.cpp.
"""
import argparse
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODULES = ("core", "mesh", "custom_forces", "fast_solver", "bridge", "reference", "characters", "scenes", "playback",
           "engines", "recorder", "validation", "viewer", "python")
# The least share of the sources that must have a test.
MIN_SHARE = 0.9
# The line must stand among so many lines at the top, where a reader sees it first.
MAX_LINE_NUMBER = 30

START = re.compile(r"^//+<?\s*Tested\b")
LINE = re.compile(r"^// Tested by (tests/[^\s,]+(?:, tests/[^\s,]+)*)\.$")


def sources_of(root):
    """Yields (path without suffix, file that has the line) of every source: a header and its .cpp file are one."""
    for module in MODULES:
        files = sorted((root / module).rglob("*.[hc]pp"))
        for stem in sorted({file.with_suffix("") for file in files}):
            header = stem.with_suffix(".hpp")
            yield stem.relative_to(root).as_posix(), header if header.exists() else stem.with_suffix(".cpp")


def named_tests(path, text):
    """The tests that the text of the file at path names, and what is wrong with the line that names them."""
    for number, line in enumerate(text.splitlines(), 1):
        if not START.match(line):
            continue
        match = LINE.match(line)
        if not match:
            return [], [f"{path}:{number}: '{line}', expected '// Tested by tests/<path>_test.cpp.', more tests after commas"]
        if number > MAX_LINE_NUMBER:
            return [], [f"{path}:{number}: expected this line among the first {MAX_LINE_NUMBER}"]
        return match[1].split(", "), []
    return [], []


def check(root):
    """All faults below root as 'file:line: message', the sources without a test, and the number of sources."""
    faults, untested, num_sources = [], [], 0
    for stem, file in sources_of(root):
        num_sources += 1
        path = file.relative_to(root).as_posix()
        tests, line_faults = named_tests(path, file.read_text(encoding="utf-8"))
        missing = [test for test in tests if not (root / test).is_file()]
        if missing:
            line_faults.append(f"{path}: names {', '.join(missing)}, which is not there")
        faults += line_faults
        if not (line_faults or tests or (root / f"tests/{stem}_test.cpp").exists()):
            untested.append(path)
    return faults, untested, num_sources


def share_text(untested, num_sources):
    """One line about how many sources have a test."""
    num_tested = num_sources - len(untested)
    return f"{num_tested} of {num_sources} library sources ({100 * num_tested / max(1, num_sources):.1f} %) have a test"


def self_test():
    """Each rule finds its violation, and tested sources have none."""
    files = {
        "tests/mesh/mirrored_test.cpp": "",
        "tests/mesh/other_test.cpp": "",
        "tests/apps/whole.sh": "",
        "mesh/mirrored.hpp": "#pragma once\n",
        "mesh/mirrored.cpp": "// Of the same source as the header.\n",
        "mesh/named.hpp": "#pragma once\n\n// Tested by tests/mesh/other_test.cpp, tests/apps/whole.sh.\n",
        "mesh/named.cpp": "int f();\n",
        "mesh/alone.cpp": "// Tested by tests/mesh/other_test.cpp.\n",
        "mesh/untested.hpp": "#pragma once\n",
        "mesh/wrong_file.hpp": "#pragma once\n",
        "mesh/wrong_file.cpp": "// Tested by tests/mesh/other_test.cpp.\n",
        "mesh/gone.hpp": "// Tested by tests/mesh/other_test.cpp, tests/mesh/gone_test.cpp.\n",
        "mesh/form.cpp": "// Tested by other_test.cpp.\n",
        "mesh/late.cpp": "int i;\n" * MAX_LINE_NUMBER + "// Tested by tests/mesh/other_test.cpp.\n",
        "apps/main.cpp": "// Programs are no library.\n",
    }
    expected = [
        "mesh/form.cpp:1: '// Tested by other_test.cpp.', expected '// Tested by tests/",
        "mesh/gone.hpp: names tests/mesh/gone_test.cpp, which is not there",
        f"mesh/late.cpp:{MAX_LINE_NUMBER + 1}: expected this line among the first {MAX_LINE_NUMBER}",
    ]
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / path).write_text(text, encoding="utf-8")
        faults, untested, num_sources = check(Path(folder))
    assert len(faults) == len(expected), faults
    for fault, start in zip(faults, expected):
        assert fault.startswith(start), f"expected '{start}', got '{fault}'"
    assert untested == ["mesh/untested.hpp", "mesh/wrong_file.hpp"], untested
    assert num_sources == 8, num_sources
    assert share_text(untested, num_sources).startswith("6 of 8 library sources (75.0 %)")
    print(f"check_tested: self-test passed, {len(files)} files")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--self-test", action="store_true", help="check the checker on samples with known faults")
    if parser.parse_args().self_test:
        return self_test()
    faults, untested, num_sources = check(ROOT)
    for path in untested:
        print(f"{path}: no test at the mirrored path, and no line '// Tested by tests/<path>_test.cpp.'")
    if len(untested) > (1 - MIN_SHARE) * num_sources:
        faults.append(f"check_tested: only {share_text(untested, num_sources)}, expected {100 * MIN_SHARE:.0f} %")
    if faults:
        sys.exit("\n".join(faults))
    print(f"check_tested: {share_text(untested, num_sources)}")


if __name__ == "__main__":
    main()
