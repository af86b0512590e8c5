#!/usr/bin/env python3
"""Checks the pages: links and headings exist, every page can be reached, none has more words than a sitting takes, a module's
README is a page, and retired words stay away from pages and code."""
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SKIPPED_FOLDERS = {".git", "build", "node_modules", "dist", "out", "third_party", "weft-report"}
START_PAGES = ("README.md", "docs/README.md")
MAX_WORDS = 1200  # of prose: blocks of code and rows of tables do not count
# Page -> how many it may have, and why.
LONG_PAGES = {
    "CHANGELOG.md": (10**6, "grows with every version"),
    "README.md": (1850, "has a whole program, and the limits"),
    "docs/bridge.md": (2200, "everything that a program may call"),
    "docs/colliders.md": (1300, "every shape of Bullet's, and what holds between bodies"),
    "docs/decisions.md": (2850, "one paragraph for each choice, read one at a time"),
    "docs/implicit_step.md": (1780, "the whole step in one place"),
    "docs/playback.md": (1350, "every command and key"),
    "docs/validation.md": (1850, "the method, and what is known to fail"),
}
MAX_README_LINES = 40
# Module -> why its README may be longer.
LONG_READMES = {"bench": "says how each program of it is run"}

# Private words that the field has a term for (docs/glossary.md): word -> term. None may come back into a page or into code.
# What is missing here are words that are plain English elsewhere, such as arm, turn, share, deep, parts, hold, away and thread:
# a pattern cannot tell their uses apart.
RETIRED = {
    # coarse spaces and factors
    r"hats?": "coarse basis function",
    r"restrict_to": "restriction",
    r"IsotropicNetwork": "ConnectivityGraph",
    r"BorderedBand": "DissectedCholesky",
    r"go_up|go_down": "forward and backward substitution",
    r"fill_up": "padding",
    # Newton's method and its line search
    r"NewtonRound": "NewtonIteration",
    r"SolverEffort|efforts?": "SolverSettings, solver settings",
    r"hold_back|tame|go_downhill|descend|is_careful": "line search",
    r"find_balance": "net-momentum correction",
    r"find_remainders": "compensated update",
    r"unbalanced|left_over|leftovers?": "residual",
    # nodes, contact, rigid bodies
    r"LedNode|is_led|check_led|lead_nodes|LedCloth": "kinematic",
    r"PushedBodies": "CoupledBodies",
    r"RigidParts": "RigidSubsteps",
    r"RigidWay": "generalized displacement",
    r"obstacles?": "collider",
    r"look_again": "redetect_contacts",
    r"leave_depths|keep_out_of_missed|stay_outside": "project_out_of_...",
    r"take_impulses|give_impulses": "apply_external_impulses, exchange_impulses",
    r"surprises?": "motion-change threshold",
    r"outdates?": "invalidate",
    # threads
    r"ThreadTeam|thread_team": "WorkerTeam",
    r"tickets?": "claim",
    # laws and scenes
    r"node_by_node": "pointwise",
    r"Steering|ClothSteering|steering": "StepCommands, ClothCommands",
    r"Director|director": "ControllerManager",
    # validation
    r"SceneGate|TheoryGate|scene_gates?|gates?": "SceneBound, TheoryBound, acceptance bound",
    r"StatedDeparture|Departure|departures?": "KnownDeviation, known deviation",
    r"SceneTruth|scene_truth|truths?": "ReferenceSolution, reference solution",
    r"own_error|own error": "discretization error",
    r"thinned|thin_mesh|ThinnedMesh": "decimated, DecimatedMesh",
    r"shadow_area|ShadowRaster": "projected_area, ProjectionRaster",
    # spelling; with a number before it the word is one of the scene format's
    r"(?<!-)[Nn]eighbour(?:s|ing|hood)?": "neighbor",
}
RETIRED_WORD = {re.compile(rf"\b(?:{word})\b"): term for word, term in RETIRED.items()}
# File or folder -> words that it may have, None for all of them, and why.
MAY_NAME_RETIRED = {
    "CHANGELOG.md": (None, "says what was renamed"),
    "docs/validation.md": ({"hat", "gate"}, "has a hat that is worn, and the option --gate"),
    "docs/scenes.md": ({"obstacle"}, "quotes the summary of a scene, which is part of content hashes"),
    "README.md": ({"obstacle"}, "quotes it too"),
    "apps/commands/reference_command.cpp": ({"gate"}, "has the option --gate"),
    "validation/converged/": ({"gate"}, "what the option --gate sets, and the key of stored references"),
    "tests/validation/converged/": ({"gate"}, "reads that key"),
    "validation/report/formats/to_json.cpp": ({"departures"}, "a key of the report's format, which the page reads"),
    "tests/validation/report/json_test.cpp": ({"departures"}, "reads that key"),
    "bench/": ({"truth", "truths", "efforts", "gates"}, "words of its options and of results that are stored under them"),
}
MODULES = ("core", "mesh", "custom_forces", "fast_solver", "bridge", "reference", "characters", "scenes", "playback", "engines",
           "recorder", "python", "validation", "apps", "bench", "fuzz", "tests")
FRAGMENT = re.compile(r"^\s*//+<? Of\b")

FENCE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
HEADING = re.compile(r"^#{1,6}\s+(.+?)\s*#*$", re.MULTILINE)


def blank(match):
    """White space with the same line breaks."""
    return re.sub(r"[^\n]", " ", match[0])


def slugs_of(text):
    """The anchors that Git hosts make of a page's headings."""
    slugs = set()
    for heading in HEADING.findall(FENCE.sub(blank, text)):
        base = re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()).replace(" ", "-")
        slug, count = base, 0
        while slug in slugs:
            count += 1
            slug = f"{base}-{count}"
        slugs.add(slug)
    return slugs


def links_of(text):
    """Yields (line number, target) of every relative link outside code."""
    prose = CODE.sub(blank, FENCE.sub(blank, text))
    for match in LINK.finditer(prose):
        target = match[1] or match[2]
        if not re.match(r"[a-z][a-z0-9+.-]*:", target):
            yield prose.count("\n", 0, match.start()) + 1, target


def pages_of(root):
    """Path relative to root -> text, of every page that is ours."""
    pages = {}
    for file in sorted(root.rglob("*.md")):
        relative = file.relative_to(root)
        if not SKIPPED_FOLDERS.intersection(relative.parts) and not relative.parts[0].startswith("build-"):
            pages[relative.as_posix()] = file.read_text(encoding="utf-8")
    return pages


def num_words(text):
    """Words of a page outside of blocks of code and tables."""
    lines = FENCE.sub(blank, text).splitlines()
    return sum(len(line.split()) for line in lines if not line.lstrip().startswith(("|", "    ")))


def faults_of_words(root, pages):
    """Yields 'file:line: message' for retired words in pages and code, and for comments that begin with a fragment."""
    texts = dict(pages)
    for module in MODULES:
        for file in sorted((root / module).rglob("*.[hc]pp")):
            path = file.relative_to(root).as_posix()
            text = file.read_text(encoding="utf-8")
            texts[path] = text
            for number, line in enumerate(text.splitlines(), 1):
                if FRAGMENT.match(line):
                    yield f"{path}:{number}: the comment begins with a fragment, expected a sentence"
    for path, text in texts.items():
        lists = [words for file, (words, _) in MAY_NAME_RETIRED.items() if path.startswith(file)]
        if None in lists:
            continue
        allowed = set().union(*lists)
        for number, line in enumerate(text.splitlines(), 1):
            for pattern, term in RETIRED_WORD.items():
                if (match := pattern.search(line)) and match[0] not in allowed:
                    yield f"{path}:{number}: '{match[0]}' is retired, the term is {term}"


def check(root):
    """All faults below root as 'file:line: message', and the number of pages read."""
    pages, faults, links = pages_of(root), [], {}
    for page, text in pages.items():
        links[page] = set()
        for line, target in links_of(text):
            path, _, anchor = target.partition("#")
            file = ((root / page).parent / path).resolve() if path else root / page
            if not file.exists() or not file.is_relative_to(root):
                faults.append(f"{page}:{line}: link to '{target}', which is not there")
                continue
            linked = file.relative_to(root).as_posix()
            links[page].add(linked)
            if anchor and linked in pages and anchor not in slugs_of(pages[linked]):
                faults.append(f"{page}:{line}: no heading '#{anchor}' in {linked}")
        most_words, _ = LONG_PAGES.get(page, (MAX_WORDS, ""))
        if num_words(text) > most_words:
            faults.append(f"{page}:1: {num_words(text)} words of prose, at most {most_words}")
        module, _, name = page.partition("/")
        num_lines = len(text.splitlines())
        if module in MODULES and name == "README.md" and num_lines > MAX_README_LINES and module not in LONG_READMES:
            faults.append(f"{page}:1: {num_lines} lines, at most {MAX_README_LINES} in a module's README")
    faults += faults_of_words(root, pages)
    faults += [f"{page}: this start page is missing" for page in START_PAGES if page not in pages]
    reached, waiting = set(), [page for page in START_PAGES if page in pages]
    while waiting:
        page = waiting.pop()
        if page not in reached:
            reached.add(page)
            waiting += [linked for linked in links[page] if linked in pages]
    faults += [f"{page}:1: cannot be reached from {' or '.join(START_PAGES)}" for page in pages if page not in reached]
    return faults, len(pages)


def self_test():
    """Each rule finds its violation, and the clean pages have none."""
    pages = {
        "README.md": "# Top\n[docs](docs/README.md) [web](https://example.org/x) `[not](a-link.md)`\n```\n[nor](this.md)\n```\n",
        "docs/README.md": "# Index\n[a](a.md#why-so) [b](b.md) [c](c.md) [mesh](../mesh/README.md) [up](../README.md)\n",
        "docs/a.md": "# A\n## Why so?\n[x](missing.md)\n",
        "docs/b.md": "# B\n[x](a.md#no-such-heading)\n",
        "docs/c.md": "a word\n" * MAX_WORDS + "| not | counted |\n",
        "docs/orphan.md": "# Nobody links here\n",
        "bridge/x.cpp": "int neighbor;\n// A hat on a cloth.\n// Of each node.\n",
        "mesh/x.cpp": "enum { k24Neighbour };  // \"24-neighbour\"\n",
        "mesh/README.md": "line\n" * (MAX_README_LINES + 1),
        "apps/commands/reference_command.cpp": "int gate;\n",
    }
    expected = [
        "docs/a.md:3: link to 'missing.md'",
        "docs/b.md:2: no heading '#no-such-heading'",
        f"docs/c.md:1: {2 * MAX_WORDS} words of prose",
        "mesh/README.md:1: 41 lines, at most 40",
        "docs/orphan.md:1: cannot be reached",
        "bridge/x.cpp:2: 'hat' is retired, the term is coarse basis function",
        "bridge/x.cpp:3: the comment begins with a fragment",
    ]
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder).resolve()
        for path, text in pages.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        found, _ = check(root)
        (root / "README.md").unlink()
        without_start, _ = check(root)
    assert len(found) == len(expected), found
    for prefix in expected:
        assert any(fault.startswith(prefix) for fault in found), f"expected '{prefix}', got {found}"
    assert "README.md: this start page is missing" in without_start, without_start
    print(f"check_docs: self-test passed, {len(pages)} pages")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1:]:
        sys.exit("usage: check_docs.py [--self-test]")
    faults, num_pages = check(ROOT)
    if faults:
        sys.exit("\n".join(faults + [f"check_docs: {len(faults)} faults in {num_pages} pages"]))
    print(f"check_docs: {num_pages} pages, every link leads somewhere, every page is linked")


if __name__ == "__main__":
    main()
