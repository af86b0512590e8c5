#!/usr/bin/env python3
"""Checks the subjects of commits: at most 72 characters, no full stop at the end, a capital or "area: " at the start.

usage: check_commits.py [BASE]   (commits since BASE; default: where the branch left origin/main, else the last commit)
"""
import re
import subprocess
import sys

MAX_LENGTH = 72
START = re.compile(r"[A-Z]|[a-z_/, ]+: \S")


def faults_of(subject):
    """What is wrong with a subject."""
    if len(subject) > MAX_LENGTH:
        yield f"{len(subject)} characters, at most {MAX_LENGTH}"
    if subject.endswith("."):
        yield "ends with a full stop"
    if not START.match(subject):
        yield "begins neither with a capital nor with 'area: '"


def git(*arguments):
    """Output of git without its last line break, or nothing if it fails."""
    run = subprocess.run(["git", *arguments], capture_output=True, text=True)
    return run.stdout.rstrip("\n") if run.returncode == 0 else ""


def self_test():
    """Each rule finds its violation."""
    cases = {"bridge: a b": 0, "Mend a thing": 0, "x" * 73: 2, "Mend it.": 1, "mend it": 1, "tools, docs: say why": 0}
    for subject, expected in cases.items():
        assert len(list(faults_of(subject))) == expected, subject
    print(f"check_commits: self-test passed, {len(cases)} subjects")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) > 2:
        sys.exit("usage: check_commits.py [BASE]")
    base = sys.argv[1] if len(sys.argv) == 2 else git("merge-base", "HEAD", "origin/main")
    if not base or base == git("rev-parse", "HEAD"):
        base = git("rev-parse", "--verify", "-q", "HEAD~1")
    subjects = git("log", "--no-merges", "--format=%s", f"{base}..HEAD" if base else "HEAD").splitlines()
    faults = [f"'{subject}': {fault}" for subject in subjects for fault in faults_of(subject)]
    if faults:
        sys.exit("\n".join(faults + [f"check_commits: {len(faults)} faults in {len(subjects)} subjects"]))
    print(f"check_commits: {len(subjects)} subjects are in order")


if __name__ == "__main__":
    main()
