#!/usr/bin/env python3
"""Checks that the arrows between the modules never turn round (see docs/conventions.md, "Modules").

CMake gives each module only the include roots of the modules it links; this scan also catches what a compiler
cannot: relative paths, Bullet outside the bridge, another module's detail/ folder.
"""
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

_SCENES = {
    "custom_forces", "characters", "scenes", "scenes/import", "scenes/output", "scenes/recording", "scenes/playback"
}
_ENGINES = _SCENES | {"fast_solver", "bridge", "validation/reference", "scenes/engines"}
_ALL = _ENGINES | {"validation", "validation/metrics", "validation/report", "scenes/page"}

# Module folder -> the modules it may include. The longest matching folder decides.
MAY_INCLUDE = {
    "custom_forces": {"custom_forces"},
    "fast_solver": {"fast_solver", "custom_forces"},
    "bridge": {"bridge", "fast_solver", "custom_forces"},
    "validation/reference": {"validation/reference", "custom_forces"},
    "characters": {"characters", "custom_forces"},
    "scenes": {"scenes", "characters", "scenes/import", "custom_forces"},
    "scenes/import": {"scenes/import", "custom_forces"},
    "scenes/output": {"scenes/output", "custom_forces"},
    "scenes/recording": {
        "scenes/recording", "scenes/output", "scenes", "characters", "scenes/import", "custom_forces"
    },
    "scenes/playback": _SCENES,
    "scenes/page": _SCENES | {"scenes/page"},
    "scenes/engines": _ENGINES,
    "validation/metrics": _SCENES | {"validation/metrics"},
    "validation/report": _SCENES | {"validation/metrics", "validation/report"},
    "validation/converged": _ALL | {"validation/converged"},
    "validation": _ALL,
    "apps": _ALL | {"apps", "validation/converged"},
    "bench": _ALL | {"bench"},
    "fuzz": _SCENES | {"fuzz"},
    "tests": _ALL | {"apps", "bench", "tests", "validation/converged"},
}

# Path prefixes where Bullet's own types may appear.
BULLET_ALLOWED = (
    "bridge/",
    "scenes/engines/bullet_",
    "tests/bridge/",
    "tests/engines/bullet_",
    "tests/install/",  # a user's program with a Bullet world of its own
    "tests/docs/",  # the samples of the documentation, likewise
    "bench/bullet_",
)

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
BULLET = re.compile(r"^(bullet/|(BulletSoftBody|BulletDynamics|BulletCollision|LinearMath)/|bt[A-Z])")


def module_of(path):
    """The module folder that a path (relative to the root, with /) belongs to, or None."""
    fitting = [module for module in MAY_INCLUDE if path.startswith(module + "/")]
    return max(fitting, key=len, default=None)


def faults_of_include(path, target):
    """What is wrong with including target in the file at path."""
    if target.startswith("../") or "/../" in target:
        yield f"'{target}' climbs out of its folder, expected <weft/module/file.hpp>"
    if BULLET.match(target) and not path.startswith(BULLET_ALLOWED):
        yield f"'{target}' is Bullet's; Bullet types stay in bridge/ and scenes/engines/bullet_*"
    if not target.startswith("weft/"):
        return
    includer, included = module_of(path), module_of(target.removeprefix("weft/"))
    if included is None:
        yield f"'{target}' is in no module of tools/check_layers.py"
    elif included not in MAY_INCLUDE[includer]:
        allowed = ", ".join(sorted(MAY_INCLUDE[includer]))
        yield f"{includer} may not include {included} ('{target}'); it may include: {allowed}"
    elif "/detail/" in target and included != includer and includer != "tests":
        yield f"'{target}' is private to {included}"


def check(root):
    """All faults below root as 'file:line: message', and the number of files read."""
    faults, num_files = [], 0
    for module in sorted({name.split("/")[0] for name in MAY_INCLUDE}):
        for file in sorted((root / module).rglob("*.[hc]pp")):
            path = file.relative_to(root).as_posix()
            num_files += 1
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if match := INCLUDE.match(line):
                    faults += [f"{path}:{number}: {text}" for text in faults_of_include(path, match[2])]
    return faults, num_files


def self_test():
    """Every rule finds its violation, and clean files have none."""
    cases = {
        "custom_forces/up.cpp": ("<weft/scenes/scene.hpp>", "custom_forces may not include scenes"),
        "scenes/up.hpp": ("<weft/scenes/engines/engine.hpp>", "scenes may not include scenes/engines"),
        "validation/reference/up.cpp": ("<weft/bridge/solver.hpp>", "may not include bridge"),
        "bridge/up.cpp": ("<weft/validation/reference/solver.hpp>", "may not include validation/reference"),
        "apps/relative.cpp": ('"../scenes/scene.hpp"', "climbs out"),
        "scenes/playback/bullet.cpp": ("<LinearMath/btVector3.h>", "is Bullet's"),
        "scenes/engines/reference.cpp": ("<btBulletDynamicsCommon.h>", "is Bullet's"),
        "bridge/private.cpp": ("<weft/custom_forces/detail/x.hpp>", "is private to custom_forces"),
        "apps/unknown.cpp": ("<weft/physics/x.hpp>", "is in no module"),
        "bridge/clean.cpp": ("<BulletSoftBody/btSoftBody.h>", None),
        "scenes/engines/bullet_soft.cpp": ("<weft/bridge/solver.hpp>", None),
        "tests/bridge/clean_test.cpp": ("<weft/custom_forces/detail/x.hpp>", None),
        "custom_forces/clean.cpp": ("<Eigen/Core>", None),
    }
    with tempfile.TemporaryDirectory() as folder:
        for path, (target, _) in cases.items():
            (Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (Path(folder) / path).write_text(f"#pragma once\n#include {target}\n", encoding="utf-8")
        found, _ = check(Path(folder))
    for path, (_, expected) in cases.items():
        mine = [fault for fault in found if fault.startswith(f"{path}:2: ")]
        if expected is None:
            assert not mine, f"{path} is clean, but: {mine}"
        else:
            assert len(mine) == 1 and expected in mine[0], f"{path}: expected '{expected}', got {mine}"
    print(f"check_layers: self-test passed, {len(cases)} files")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1:]:
        sys.exit("usage: check_layers.py [--self-test]")
    faults, num_files = check(ROOT)
    if faults:
        sys.exit("\n".join(faults + [f"check_layers: {len(faults)} faults in {num_files} files"]))
    print(f"check_layers: {num_files} files, every include follows the arrows")


if __name__ == "__main__":
    main()
