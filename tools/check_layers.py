#!/usr/bin/env python3
"""Checks that the arrows between the modules never turn round (see docs/conventions.md, "Modules").

Every module is one top-level folder. CMake gives each module only the include roots of the modules it links; this scan
also catches what a compiler cannot: relative paths, and Bullet's types outside the bridge.
"""
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# The modules from the lowest to the highest; each may include itself and what its row names.
MAY_INCLUDE = {
    "core": (),
    "mesh": ("core",),
    "custom_forces": ("mesh", "core"),
    "fast_solver": ("custom_forces", "mesh", "core"),
    "bridge": ("fast_solver", "custom_forces", "mesh", "core"),
    "reference": ("custom_forces", "mesh", "core"),
    "characters": ("mesh", "core"),
    "scenes": ("characters", "custom_forces", "mesh", "core"),
    "playback": ("scenes", "characters", "custom_forces", "mesh", "core"),
    "engines": ("scenes", "reference", "bridge", "characters", "custom_forces", "mesh", "core"),
    "viewer": ("engines", "playback", "scenes", "characters", "custom_forces", "mesh", "core"),
    "recorder": ("scenes", "bridge", "mesh", "core"),
    "validation": ("engines", "playback", "scenes", "reference", "characters", "custom_forces", "mesh", "core"),
    "apps": ("validation", "viewer", "engines", "playback", "scenes", "characters", "custom_forces", "mesh", "core"),
    "python": ("validation", "recorder", "engines", "scenes", "bridge", "custom_forces", "mesh", "core"),
    # Programs of their own, which nothing of the above includes.
    "bench": ("validation", "recorder", "engines", "playback", "scenes", "bridge", "fast_solver", "custom_forces", "mesh", "core"),
    "fuzz": ("playback", "scenes", "characters", "mesh", "core"),
    "tests": ("bench", "apps", "validation", "viewer", "recorder", "engines", "playback", "scenes", "characters", "reference", "bridge",
              "fast_solver", "custom_forces", "mesh", "core"),
}

# Path prefixes where Bullet's own types may appear.
BULLET_ALLOWED = (
    "bridge/",
    "engines/bullet/",
    "recorder/",
    "python/",
    "bench/bullet/",
    "tests/bridge/",
    "tests/engines/bullet/",
    "tests/recorder/",
    "tests/install/",  # a user's program with a Bullet world of its own
    "tests/docs/",  # the samples of the documentation, likewise
)

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
BULLET = re.compile(r"^(bullet/|(BulletSoftBody|BulletDynamics|BulletCollision|LinearMath)/|bt[A-Z])")


def faults_of_include(path, target):
    """What is wrong with including target in the file at path (relative to the root, with /)."""
    if target.startswith("../") or "/../" in target:
        yield f"'{target}' climbs out of its folder, expected <weft/module/file.hpp>"
    if BULLET.match(target) and not path.startswith(BULLET_ALLOWED):
        yield f"'{target}' is Bullet's; Bullet types stay in bridge/, engines/bullet/, recorder/ and python/"
    if not target.startswith("weft/"):
        return
    includer, included = path.split("/")[0], target.split("/")[1]
    if included not in MAY_INCLUDE:
        yield f"'{target}' is in no module of tools/check_layers.py"
    elif included != includer and included not in MAY_INCLUDE[includer]:
        allowed = ", ".join(MAY_INCLUDE[includer]) or "nothing else"
        yield f"{includer} may not include {included} ('{target}'); it may include: {allowed}"


def check(root):
    """All faults below root as 'file:line: message', and the number of files read."""
    faults, num_files = [], 0
    for module in MAY_INCLUDE:
        for file in sorted((root / module).rglob("*.[hc]pp")):
            path = file.relative_to(root).as_posix()
            num_files += 1
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if match := INCLUDE.match(line):
                    faults += [f"{path}:{number}: {text}" for text in faults_of_include(path, match[2])]
    return faults, num_files


def self_test():
    """Every rule finds its violation, and clean files have none; the rows themselves have no circle."""
    lower = []
    for module, others in MAY_INCLUDE.items():
        assert set(others) <= set(lower), f"{module} includes something above it"
        lower.append(module)
    cases = {
        "core/up.cpp": ("<weft/mesh/cloth_mesh.hpp>", "core may not include mesh"),
        "custom_forces/up.cpp": ("<weft/scenes/scene.hpp>", "custom_forces may not include scenes"),
        "scenes/up.hpp": ("<weft/engines/engine_table.hpp>", "scenes may not include engines"),
        "reference/up.cpp": ("<weft/bridge/solver.hpp>", "may not include bridge"),
        "bridge/up.cpp": ("<weft/reference/solver.hpp>", "may not include reference"),
        "playback/window.cpp": ("<weft/viewer/session.hpp>", "playback may not include viewer"),
        "apps/relative.cpp": ('"../scenes/scene.hpp"', "climbs out"),
        "playback/bullet.cpp": ("<LinearMath/btVector3.h>", "is Bullet's"),
        "engines/reference.cpp": ("<btBulletDynamicsCommon.h>", "is Bullet's"),
        "apps/unknown.cpp": ("<weft/physics/x.hpp>", "is in no module"),
        "bridge/up.hpp": ("<weft/python/bindings/world/world.hpp>", "bridge may not include python"),
        "python/viewer.cpp": ("<weft/viewer/session.hpp>", "python may not include viewer"),
        "python/clean.cpp": ("<BulletSoftBody/btSoftBody.h>", None),
        "bridge/clean.cpp": ("<BulletSoftBody/btSoftBody.h>", None),
        "engines/bullet/bullet_soft.cpp": ("<weft/bridge/solver.hpp>", None),
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
