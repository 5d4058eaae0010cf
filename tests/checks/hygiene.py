#!/usr/bin/env python3
"""Checks rules for every file of the repository: hygiene.py ROOT

* No source over 500 lines without a stated reason.
* No line over 100 characters in C and C++, except in worlds and programs in raw strings.
* No absolute path of a developer's machine, no left-over notes to self, no trailing blanks.
* At most 120 lines in the README.md of the root.
* A first comment in every C and C++ file. That of the header of the same name also serves a .cpp
  file."""
import pathlib
import re
import sys

SOURCE = {".c", ".cpp", ".h", ".hpp", ".py", ".cmake", ".fbs", ".node", ".sh"}
TEXT = SOURCE | {".md", ".txt", ".json", ".in", ".wrl"}
# Files that may break a rule: inputs of tests.
EXCEPT = ("tests/conformance/", "tests/fuzz/", "tests/nodegen/", "tests/checks/hygiene.py")
HOMES = re.compile(r"(?<![\w.:/$}])/(?:home|root|work|Users|mnt|tmp)/[\w.-]+")
NOTES = re.compile(r"\b(?:TODO|FIXME|XXX|HACK)\b")

REASON = "Longer than 500 lines because"
RAW_STRING = re.compile(r'R"(\w*)\(.*?\)\1"', re.S)


def raw_lines(text):
    """Returns the numbers of the lines that a raw string covers."""
    covered = set()
    for match in RAW_STRING.finditer(text):
        first = text.count("\n", 0, match.start()) + 1
        covered.update(range(first, first + match.group().count("\n") + 1))
    return covered


def complaints(root, path, relative):
    text = path.read_text(encoding="utf-8")
    lines = text.split("\n")
    if path.suffix in SOURCE and len(lines) > 501 and not any(REASON in line
                                                              for line in lines[:20]):
        yield f"{relative}: {len(lines) - 1} lines: split it, or say why it is one file (\"{REASON} ...\") in its first comment"
    if str(relative) == "README.md" and len(lines) > 121:
        yield f"{relative}: {len(lines) - 1} lines (at most 120)"
    raw = raw_lines(text)
    for number, line in enumerate(lines, 1):
        where = f"{relative}:{number}"
        if path.suffix in {".c", ".cpp", ".h", ".hpp"} and len(line) > 100 and number not in raw:
            yield f"{where}: {len(line)} characters (at most 100)"
        if HOMES.search(line):
            yield f"{where}: a path of one machine: {HOMES.search(line).group()}"
        if NOTES.search(line):
            yield f"{where}: {NOTES.search(line).group()}: do it or open an issue"
        if path.suffix in SOURCE and line.rstrip() != line:
            yield f"{where}: trailing blanks"
    described_by_header = path.suffix == ".cpp" and (path.with_suffix(".h").exists() or any(
        root.glob(f"lib*/include/*/{path.stem}.h")))
    if path.suffix in {".c", ".cpp", ".h", ".hpp"
                      } and not described_by_header and not text.lstrip().startswith(("//", "/*")):
        yield f"{relative}: begins without a comment that says what the file owns"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = []
    checked = 0
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root).as_posix()
        if relative.startswith(
            (".git/", "build/")) or "/__pycache__/" in relative or relative.startswith(EXCEPT):
            continue
        if path.is_file() and (path.suffix in TEXT or
                               path.name in {"Makefile", "run", ".clang-format", ".clang-tidy"}):
            checked += 1
            found += complaints(root, path, relative)
    print("\n".join(found))
    print(f"{checked} files, {len(found)} complaints")
    return 1 if found or checked < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
