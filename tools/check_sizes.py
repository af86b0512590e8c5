#!/usr/bin/env python3
"""Checks that files and functions stay small enough to read in one go.

Headers have at most 250 lines, sources and scripts 500, C++ functions 80. The targets that authors aim at are 150,
300 and 40. A class has at most 400 lines and 25 functions over all its files. Functions are found by their braces, without a parser: good enough for a limit.
"""
import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SKIPPED_FOLDERS = {".git", "build", "node_modules", "dist", "out", "third_party", "weft-report"}
MAX_LINES = {".hpp": 250, ".cpp": 500, ".ts": 500, ".py": 500, ".sh": 500, ".cmake": 250}
MAX_FUNCTION_LINES = 80

# File, or file:line text of the function's first line -> the reason why it may be longer.
EXCEPTIONS = {
    "bridge/implicit/fast_body.hpp": "declares every stage of a step",
    "fast_solver/implicit_solver.hpp": "declares every part of a solve",
}

# A class counts over its header and all sources that define its members, so that splitting it over files helps nobody.
MAX_CLASS_LINES = 400
MAX_CLASS_FUNCTIONS = 25
# "module Class" -> how many lines and functions it may have today, and why. They go down; up only for what a fault needs.
LARGE_CLASSES = {
    "fast_solver ImplicitSolver": (1580, 72, "Newton, line search, contact states and rigid coupling share the state of a step"),
    "bridge FastBody": (1060, 57, "all stages of an implicit step of one body"),
    "bridge SoftBodySolver": (867, 54, "everything that a program may call, and Bullet's nine hooks"),
    "fast_solver CoarseCorrection": (538, 26, "set-up, changes and use of one coarse space"),
    "fast_solver NetworkForces": (418, 22, "forces and matrices of one network, in two layouts"),
}

NOT_CODE = re.compile(
    r'R"(?P<delimiter>[^()\s\\]{0,16})\(.*?\)(?P=delimiter)"'  # raw string
    r'|"(?:\\.|[^"\\\n])*"'  # string
    r"|(?<![0-9a-zA-Z])'(?:\\.|[^'\\\n])+'"  # character, not the digit separator of 1'000
    r"|//[^\n]*|/\*.*?\*/"  # comments
    r"|\b(?:public|private|protected)\s*:(?!:)"  # labels in a class
    r"|^[ \t]*#(?:\\\n|[^\n])*",  # preprocessor line with its continuations
    re.DOTALL | re.MULTILINE,
)
# The head of a block that only groups declarations: what is inside is measured piece by piece.
GROUP = re.compile(r"^(?!.*\)$).*\b(namespace|class|struct|union|enum|extern)\b[^()]*$", re.DOTALL)


def blank(match):
    """White space with the same line breaks."""
    return re.sub(r"[^\n]", " ", match[0])


def kind_of_block(head):
    """What a brace outside of functions opens, judged by the text before it."""
    if not head or head.startswith(","):
        return "continuation"  # of a constructor, after the braces of an initialiser
    if GROUP.match(head):
        return "group"
    return "function" if ")" in head and not head.endswith("=") else "table"


def function_lengths(text):
    """First line -> number of lines, head included, of the functions in C++ text."""
    code = NOT_CODE.sub(blank, text)
    lengths = {}
    open_blocks = []  # (kind, first line) of each open brace
    last_function = None  # first line of the function whose piece ended just before
    head_start = 0
    for match in re.finditer("[{};]", code):
        head = code[head_start : match.start()]
        line = code.count("\n", 0, match.start()) + 1
        inside = any(kind == "function" for kind, _ in open_blocks)
        if match[0] == "{":
            kind = "inner" if inside else kind_of_block(head.strip())
            first = line - head.lstrip().count("\n")
            if kind == "continuation":
                kind, first = ("function", last_function) if last_function else ("table", first)
            open_blocks.append((kind, first))
        elif match[0] == "}" and open_blocks:
            kind, first = open_blocks.pop()
            if kind == "function":
                lengths[first] = line - first + 1
            last_function = first if kind == "function" else None
        elif not inside:
            last_function = None
        head_start = match.end()
    return lengths


def files_of(root):
    """Every file with a limit, without generated and foreign folders."""
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root)
        if path.suffix in MAX_LINES and not SKIPPED_FOLDERS.intersection(relative.parts) and path.is_file():
            if not relative.parts[0].startswith("build-"):
                yield path, relative.as_posix()


def check(root, exceptions):
    """All faults below root as 'file:line: message', and the number of files read."""
    faults, num_files = [], 0
    for file, path in files_of(root):
        num_files += 1
        text = file.read_text(encoding="utf-8")
        lines = text.splitlines()
        if len(lines) > MAX_LINES[file.suffix] and path not in exceptions:
            faults.append(f"{path}:1: {len(lines)} lines, at most {MAX_LINES[file.suffix]}: which two ideas are in it?")
        if file.suffix in (".hpp", ".cpp"):
            for first, length in function_lengths(text).items():
                if length > MAX_FUNCTION_LINES and f"{path}:{lines[first - 1].strip()}" not in exceptions:
                    faults.append(f"{path}:{first}: function of {length} lines, at most {MAX_FUNCTION_LINES}")
    return faults, num_files


CLASS_HEAD = re.compile(r"^(?:class|struct)\s+(\w+)(?:\s+final)?[^;{()]*\{", re.MULTILINE)
MEMBER_HEAD = re.compile(r"\b([A-Z]\w*)(?:<[\w, ]*>)?::~?\w+\s*\(")


def class_sizes(root):
    """'module Class' -> [lines, functions defined in sources], over all files of each top-level folder."""
    sizes = {}
    for file in sorted(root.rglob("*.[hc]pp")):
        parts = file.relative_to(root).parts
        if len(parts) < 2 or SKIPPED_FOLDERS.intersection(parts) or parts[0] == "tests" or parts[0].startswith("build-"):
            continue
        text = file.read_text(encoding="utf-8")
        if file.suffix == ".hpp":
            code = NOT_CODE.sub(blank, text)
            for match in CLASS_HEAD.finditer(code):
                end, depth = match.end(), 1
                while depth and end < len(code):
                    depth += {"{": 1, "}": -1}.get(code[end], 0)
                    end += 1
                sizes.setdefault(f"{parts[0]} {match[1]}", [0, 0])[0] += code.count("\n", match.start(), end) + 1
            continue
        lines = text.splitlines()
        for first, length in function_lengths(text).items():
            if match := MEMBER_HEAD.search(" ".join(lines[first - 1 : first + 3])):
                size = sizes.setdefault(f"{parts[0]} {match[1]}", [0, 0])
                size[0] += length
                size[1] += 1
    return sizes


def check_classes(root, large_classes):
    """Classes that are larger than they may be."""
    for name, (num_lines, num_functions) in sorted(class_sizes(root).items()):
        most_lines, most_functions, _ = large_classes.get(name, (MAX_CLASS_LINES, MAX_CLASS_FUNCTIONS, ""))
        if num_lines > most_lines or num_functions > most_functions:
            yield (f"{name}: {num_lines} lines and {num_functions} functions over all its files, "
                   f"at most {most_lines} and {most_functions}")


def self_test():
    """Long files and functions are found at their first line; long tables, types and namespaces are not functions."""
    body = "  f();\n" * MAX_FUNCTION_LINES
    cases = {
        "long.hpp": ("// x\n" * (MAX_LINES[".hpp"] + 1), "long.hpp:1: 251 lines"),
        "long.cpp": ("// x\n" * (MAX_LINES[".cpp"] + 1), "long.cpp:1: 501 lines"),
        "plain.cpp": (f"namespace a {{\n\nint f(int x)\n{{\n{body}}}\n}}\n", "plain.cpp:3: function of 83 lines"),
        "lambda.cpp": (f"const auto f = [](int x) {{\n{body}}};\n", "lambda.cpp:1: function of 82 lines"),
        "test.cpp": (f"TEST(A, B) {{\n{body}}}\n", "test.cpp:1: function of 82 lines"),
        "method.hpp": (f"class A : B {{\n public:\n  int f() const {{\n{body}}}\n}};\n", "method.hpp:3: function of 82 lines"),
        "constructor.cpp": (f"A::A(int x)\n    : a_{{x}}, b_{{1}} {{\n{body}}}\n", "constructor.cpp:1: function of 83 lines"),
        "short.cpp": ("int f() {\n" + "  f();\n" * (MAX_FUNCTION_LINES - 2) + "}\n" + "int g() { return 1'000; }\n", None),
        "table.cpp": (f"constexpr Law kLaws[] = {{\n{body}}};\n", None),
        "struct.hpp": ("struct A {\n" + "  int f() { return 1; }\n" * 100 + "};\n", None),
        "raw.cpp": ('const char* k = R"(\n' + "f() {\n" * 100 + ')";\nint f() { return \'{\'; }\n', None),
        "allowed.cpp": (f"int f() {{\n{body}}}\n", None),
    }
    with tempfile.TemporaryDirectory() as folder:
        for path, (text, _) in cases.items():
            (Path(folder) / path).write_text(text, encoding="utf-8")
        found, _ = check(Path(folder), {"allowed.cpp:int f() {": "self-test"})
    for path, (_, expected) in cases.items():
        mine = [fault for fault in found if fault.startswith(f"{path}:")]
        if expected is None:
            assert not mine, f"{path} is clean, but: {mine}"
        else:
            assert len(mine) == 1 and mine[0].startswith(expected), f"expected '{expected}', got {mine}"
    with tempfile.TemporaryDirectory() as folder:
        module = Path(folder) / "mesh"
        module.mkdir()
        (module / "a.hpp").write_text("class Wide {\n" + "  int f();\n" * 30 + "};\nclass Small {};\n", encoding="utf-8")
        for part in range(2):
            body = "".join(f"int Wide::f{part}{i}() {{\n  return 1;\n}}\n" for i in range(15))
            (module / f"a{part}.cpp").write_text(body + "Small::Small() {}\n", encoding="utf-8")
        found = list(check_classes(Path(folder), {}))
        assert found == ["mesh Wide: 122 lines and 30 functions over all its files, at most 400 and 25"], found
        assert not list(check_classes(Path(folder), {"mesh Wide": (122, 30, "self-test")}))
    print(f"check_sizes: self-test passed, {len(cases)} files")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1:]:
        sys.exit("usage: check_sizes.py [--self-test]")
    faults, num_files = check(ROOT, EXCEPTIONS)
    faults += check_classes(ROOT, LARGE_CLASSES)
    if faults:
        sys.exit("\n".join(faults + [f"check_sizes: {len(faults)} faults in {num_files} files"]))
    print(f"check_sizes: {num_files} files, all within their limits")


if __name__ == "__main__":
    main()
