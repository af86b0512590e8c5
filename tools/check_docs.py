#!/usr/bin/env python3
"""Checks the pages: links and headings exist, every page can be reached, none is longer than a sitting, and retired words
stay away from pages and code."""
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SKIPPED_FOLDERS = {".git", "build", "node_modules", "dist", "out", "third_party", "weft-report"}
START_PAGES = ("README.md", "docs/README.md")
MAX_LINES = 150
# Page -> why it may be longer.
LONG_PAGES = {"CHANGELOG.md": "grows with every version", "README.md": "has a whole program"}

# Private words that the field has a term for (docs/glossary.md): word -> term. None may come back into a page, or into
# the code of the folders below.
RETIRED = {
    r"hats?": "coarse basis function",
    r"ThreadTeam|thread_team": "WorkerTeam",
    r"IsotropicNetwork": "ConnectivityGraph",
    r"BorderedBand": "DissectedCholesky",
    r"NewtonRound": "NewtonIteration",
    r"SolverEffort": "SolverSettings",
    r"LedNode": "KinematicNode",
    r"PushedBodies": "CoupledBodies",
    r"RigidParts": "RigidSubsteps",
    r"hold_back|tame|go_downhill|descend": "line search",
    r"go_up|go_down": "forward and backward substitution",
    r"look_again": "redetect_contacts",
    r"leave_depths|keep_out_of_missed|stay_outside": "project_out_of_...",
    r"take_impulses|give_impulses": "apply_external_impulses, exchange_impulses",
    r"node_by_node": "pointwise",
    r"unbalanced": "residual",
    r"neighbours?": "neighbor",
}
RETIRED_WORD = {re.compile(rf"\b(?:{word})\b"): term for word, term in RETIRED.items()}
CODE_WITHOUT_RETIRED_WORDS = ("fast_solver", "bridge", "tests/fast_solver", "tests/bridge")
# File -> why it may keep a retired word.
MAY_NAME_RETIRED = {
    "CHANGELOG.md": "says what was renamed",
    "docs/validation.md": "has a hat that is worn",
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


def faults_of_words(root, pages):
    """Yields 'file:line: message' for retired words in pages and code, and for comments that begin with a fragment."""
    texts = {page: text for page, text in pages.items() if page not in MAY_NAME_RETIRED}
    for module in MODULES:
        for file in sorted((root / module).rglob("*.[hc]pp")):
            path = file.relative_to(root).as_posix()
            text = file.read_text(encoding="utf-8")
            if path.startswith(CODE_WITHOUT_RETIRED_WORDS):
                texts[path] = text
            for number, line in enumerate(text.splitlines(), 1):
                if FRAGMENT.match(line):
                    yield f"{path}:{number}: the comment begins with a fragment, expected a sentence"
    for path, text in texts.items():
        for number, line in enumerate(text.splitlines(), 1):
            for pattern, term in RETIRED_WORD.items():
                if match := pattern.search(line):
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
        num_lines = len(text.splitlines())
        if num_lines > MAX_LINES and page not in LONG_PAGES:
            faults.append(f"{page}:1: {num_lines} lines, at most {MAX_LINES}")
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
        "docs/README.md": "# Index\n[a](a.md#why-so) [b](b.md) [c](c.md) [up](../README.md)\n",
        "docs/a.md": "# A\n## Why so?\n[x](missing.md)\n",
        "docs/b.md": "# B\n[x](a.md#no-such-heading)\n",
        "docs/c.md": "line\n" * (MAX_LINES + 1),
        "docs/orphan.md": "# Nobody links here\n",
        "bridge/x.cpp": "int neighbor;\n// A hat on a cloth.\n// Of each node.\n",
        "mesh/x.cpp": "int hats;  // another module's business\n",
    }
    expected = [
        "docs/a.md:3: link to 'missing.md'",
        "docs/b.md:2: no heading '#no-such-heading'",
        f"docs/c.md:1: {MAX_LINES + 1} lines",
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
