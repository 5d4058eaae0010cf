#!/usr/bin/env python3
"""Rules that every file of the repository keeps: hygiene.py ROOT

No source over 500 lines, no line over 130 characters in C and C++, no absolute path of somebody's machine, no left-over
notes to self, no trailing blanks, a first comment in every C and C++ file.
"""
import pathlib
import re
import sys

SOURCE = {".c", ".cpp", ".h", ".hpp", ".py", ".cmake", ".fbs", ".node", ".sh"}
TEXT = SOURCE | {".md", ".txt", ".json", ".in", ".wrl"}
# Files that must look odd: inputs of tests that hold what a rule forbids.
EXCEPT = ("tests/conformance/", "tests/fuzz/", "tests/nodegen/", "tests/checks/hygiene.py")
HOMES = re.compile(r"(?<![\w.:/$}])/(?:home|root|work|Users|mnt|tmp)/[\w.-]+")
NOTES = re.compile(r"\b(?:TODO|FIXME|XXX|HACK)\b")


def complaints(path, relative):
    text = path.read_text(encoding="utf-8")
    lines = text.split("\n")
    if path.suffix in SOURCE and len(lines) > 501:
        yield f"{relative}: {len(lines) - 1} lines; split it (at most 500)"
    for number, line in enumerate(lines, 1):
        where = f"{relative}:{number}"
        if path.suffix in {".c", ".cpp", ".h", ".hpp"} and len(line) > 130:
            yield f"{where}: {len(line)} characters (at most 130)"
        if HOMES.search(line):
            yield f"{where}: a path of one machine: {HOMES.search(line).group()}"
        if NOTES.search(line):
            yield f"{where}: {NOTES.search(line).group()}: do it or open an issue"
        if path.suffix in SOURCE and line.rstrip() != line:
            yield f"{where}: trailing blanks"
    if path.suffix in {".c", ".cpp", ".h", ".hpp"} and not text.lstrip().startswith(("//", "/*")):
        yield f"{relative}: begins without a comment that says what the file owns"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = []
    checked = 0
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root).as_posix()
        if relative.startswith((".git/", "build/")) or "/__pycache__/" in relative or relative.startswith(EXCEPT):
            continue
        if path.is_file() and (path.suffix in TEXT or path.name in {"Makefile", "run", ".clang-format", ".clang-tidy"}):
            checked += 1
            found += complaints(path, relative)
    print("\n".join(found))
    print(f"{checked} files, {len(found)} complaints")
    return 1 if found or checked < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
