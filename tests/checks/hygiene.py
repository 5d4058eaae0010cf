#!/usr/bin/env python3
"""Checks rules for every file of the repository, and of its comments and documents.

hygiene.py ROOT      checks
hygiene.py --self    tests the rules of comments with some that must be refused and some that must pass

* No source over 500 lines without a stated reason.
* No line over 100 characters in C and C++, except in worlds and programs in raw strings.
* No absolute path of a developer's machine, no left-over notes to self, no trailing blanks.
* No class with over 40 functions or 300 lines without a stated reason in the comment above it.
* At most 120 lines in the README.md of the root.
* A first comment in every C and C++ file. That of the header of the same name also serves a .cpp
  file.
* At most 60 lines in a record of docs/decisions.
* A file that a comment names exists, or a build or a tool makes it, or some source includes it from
  another library.
* No sentence of a comment or document begins with "Of", "Whose" or "What", but for questions: it
  shall begin with its subject. No comment behind code begins with "of".
* The version in CMakeLists.txt stands wherever it is repeated."""
import pathlib
import re
import sys

from classes import classes
from comments import C_SUFFIXES, blocks, paragraphs

SOURCE = {".c", ".cpp", ".h", ".hpp", ".py", ".cmake", ".fbs", ".node", ".sh"}
TEXT = SOURCE | {".md", ".txt", ".json", ".in", ".wrl"}
# Files that may break a rule: inputs of tests.
EXCEPT = ("tests/conformance/", "tests/fuzz/", "tests/nodegen/", "tests/checks/hygiene.py")
# Files that a comment may name although they are not in the tree: those that the build or a tool
# makes, and names in examples.
MADE = {
    "nodes.h", "node_renderer.h", "nodes_renderer.cpp", "nodes.md", "NAME_nodes.h",
    "nodes_list.cpp", "render.md", "transports.md", "binaries.md", "live.md", "table.md",
    "denoise.md", "page.cpp", "spec.node", "x.md"
}
FILE_NAME = re.compile(r"(?<![\w./*{}<>-])((?:[\w.+-]+/)*[A-Za-z][\w+-]*\."
                       r"(?:cpp|hpp|h|c|py|cmake|node|fbs|md))(?![\w/(*{-])")
SENTENCE = re.compile(
    r"(?:^|(?<=[.!?:]\s)|(?<=[.!?]\*\*\s)|(?<=^\* )|(?<=^- ))(?:Of|Whose|What)\b"
    r"[^.!?]*(?:[.!?](?=\S)[^.!?]*)*[.!?]?", re.M)
HOMES = re.compile(r"(?<![\w.:/$}])/(?:home|root|work|Users|mnt|tmp)/[\w.-]+")
NOTES = re.compile(r"\b(?:TODO|FIXME|XXX|HACK)\b")

REASON = "Longer than 500 lines because"
WIDE = "Wide because"
RAW_STRING = re.compile(r'R"(\w*)\(.*?\)\1"', re.S)


def raw_lines(text):
    """Returns the numbers of the lines that a raw string covers."""
    covered = set()
    for match in RAW_STRING.finditer(text):
        first = text.count("\n", 0, match.start()) + 1
        covered.update(range(first, first + match.group().count("\n") + 1))
    return covered


class Names:
    """Holds which files a comment may name."""

    def __init__(self, files, included=()):
        self.ends = set()
        for file in [*files, *included]:
            parts = file.split("/")
            self.ends.update("/".join(parts[i:]) for i in range(len(parts)))

    def __contains__(self, name):
        return name in self.ends or name.rsplit("/", 1)[-1] in MADE


def prose(path, text, names):
    """Yields line and complaint of comments, or of the paragraphs of a document."""
    document = path.suffix == ".md"
    for block in paragraphs(text) if document else blocks(path, text):
        if not document:
            for match in FILE_NAME.finditer(block.text):
                if match.group(1) not in names:
                    yield (block.number + block.text.count("\n", 0, match.start()),
                           f"there is no file {match.group(1)}")
            if block.trailing and block.text.startswith("of "):
                yield block.number, f"a comment behind code that begins with \"of\": {block.text}"
        for match in SENTENCE.finditer(block.text):
            before = block.text[:match.start()].rstrip()
            # A line in the middle of a sentence may begin with a name.
            if match.group().endswith("?") or before and before[-1] not in ".!?:*-":
                continue
            yield (block.number + block.text.count("\n", 0, match.start()),
                   f"a sentence begins with \"{match.group().split()[0]}\": {match.group()[:60]}")


def wide_classes(text):
    """Yields line and complaint of classes that are wider than their comment permits."""
    for one in classes(text):
        if (one.functions > 40 or one.lines > 300) and WIDE not in one.head:
            yield one.number, (f"class {one.name} has {one.functions} functions in {one.lines} lines: "
                               f"split it, or say why it is one class (\"{WIDE} ...\") above it")


def versions(root):
    """Yields places that repeat another version than that of CMakeLists.txt."""
    version = re.search(r"^project\(\w+ VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text(),
                        re.M).group(1)
    macros = re.findall(r"define OPENRT_VERSION_\w+ (\d+)",
                        (root / "libopenrt/include/openrt/context.h").read_text())
    if ".".join(macros) != version:
        yield f"libopenrt/include/openrt/context.h: is not of version {version}"
    for path, repeated in (("apps/vv/desktop/vv.metainfo.xml", f'<release version="{version}"'),
                           ("docs/packages.md", f"`XVRML_PRIVATE_{version}`"),
                           ("contrib/github-action/action.yml", f"xvrml-{version}-"),
                           ("contrib/github/release.yml", f"/openrt-{version}.tar.gz"),
                           ("CHANGELOG.md", f" {version}")):
        if repeated not in (root / path).read_text():
            yield f"{path}: lacks {repeated.strip()}"


def complaints(root, path, relative, names):
    text = path.read_text(encoding="utf-8")
    lines = text.split("\n")
    if path.suffix in SOURCE and len(lines) > 501 and not any(REASON in line
                                                              for line in lines[:20]):
        yield f"{relative}: {len(lines) - 1} lines: split it, or say why it is one file (\"{REASON} ...\") in its first comment"
    if str(relative) == "README.md" and len(lines) > 121:
        yield f"{relative}: {len(lines) - 1} lines (at most 120)"
    if re.match(r"docs/decisions/\d", relative) and len(lines) > 61:
        yield f"{relative}: {len(lines) - 1} lines (at most 60): measurements belong to docs/accuracy.md and docs/benchmarks.md"
    for number, what in prose(path, text, names):
        yield f"{relative}:{number}: {what}"
    if path.suffix in C_SUFFIXES:
        for number, what in wide_classes(text):
            yield f"{relative}:{number}: {what}"
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


def self_test():
    """Returns a complaint for each comment that is judged wrongly."""
    names = Names(["libopenrt/render/film/sums.h", "tools/made.py"], ["sys/socket.h"])
    refused = {
        "a.cpp": [
            "int a; // of the picture", "int a; /* of the picture */", "// Of all pictures one counts.",
            "// Good. What it does\n// is seen later.", "// Whose turn it is follows.",
            "// See render/sums.h.", "/* light_tracer.h\n */", "// Sums.\n// Of these some are 0."
        ],
        "a.py": ["a = 1  # of the picture", '"""Good.\n\nWhat it does is seen."""', "# See gone.py."],
        "CMakeLists.txt": ["set(a b) # of the picture", "# What it does."],
        "a.md": ["* What it does is seen.", "Good. Of these\nsome are 0.", "**Cost.** Of these some."],
    }
    passed = {
        "a.cpp": [
            "// of the picture, in a line of its own", 'auto s = "// What it does.";',
            "// What does it do? It waits.", "// See film/sums.h, sums.h and <sys/socket.h>.",
            "// See sys/socket.h, xvrml/nodes.h, *_test.h and file.h/.cpp.",
            "// The node What is one.", "int a; // the size of the picture",
            "// It is of the kind\n// What, which is a name."
        ],
        "a.py": ["a = '# of'", "# The tool made.py makes it."],
        "a.md": [
            "## What it does\n", "| What | how |\n", "```\nWhat it does.\n```\n", "What does it do?",
            "It names gone.h."
        ],
    }
    for cases, wanted in ((refused, True), (passed, False)):
        for name, texts in cases.items():
            for text in texts:
                if bool(list(prose(pathlib.Path(name), text + "\n", names))) != wanted:
                    yield f"{name}: {'passes' if wanted else 'is refused'}: {text!r}"
    declared = [
        "int f(int a = 1);", "A& operator()(int) const { return g(1); }", "explicit X(B b) : b_{b} {}",
        "template <class T> void f(std::function<void(int)> call);", "~X();", "bool operator<(X) const;"
    ]
    others = [
        "int a = f(1);", "std::function<void(int)> call;", "using F = void(int);", "enum class E { a, b };",
        "friend void f(X);", "struct In { int a; };", "int b{f(2)};", "// void f();", "class Forward;"
    ]
    for text, wanted in ((f"class X {{\n public:\n  {one}\n}};", count)
                         for group, count in ((declared, 1), (others, 0)) for one in group):
        if [one.functions for one in classes(text) if one.name == "X"] != [wanted]:
            yield f"class: {'is no function' if wanted else 'is a function'}: {text!r}"
    for text, wanted in (("class X {" + " void f();" * 41 + "};", True),
                         ("class X {" + " void f();" * 40 + "};", False),
                         ("class X {" + "\n" * 300 + "};", True),
                         ("// Wide because it is.\nclass X {" + "\n" * 300 + "};", False)):
        if bool(list(wide_classes(text))) != wanted:
            yield f"class: {'passes' if wanted else 'is refused'}: {text[:60]!r}"


def main():
    if sys.argv[1:] == ["--self"]:
        found = list(self_test())
        print("\n".join(found))
        return 1 if found else 0
    root = pathlib.Path(sys.argv[1]).resolve()
    files = {
        relative: path
        for path in sorted(root.rglob("*"))
        if path.is_file() and not (relative := path.relative_to(root).as_posix()).startswith(
            (".git/", "build/")) and "/__pycache__/" not in relative
    }
    included = {
        name
        for path in files.values() if path.suffix in C_SUFFIXES
        for name in re.findall(r"#\s*include <([\w./+-]+)>", path.read_text(encoding="utf-8"))
    }
    names = Names(files, included)
    found = list(versions(root))
    checked = 0
    for relative, path in files.items():
        if relative.startswith(EXCEPT):
            continue
        if path.suffix in TEXT or path.name in {"Makefile", "run", ".clang-format", ".clang-tidy"}:
            checked += 1
            found += complaints(root, path, relative, names)
    print("\n".join(found))
    print(f"{checked} files, {len(found)} complaints")
    return 1 if found or checked < 50 else 0


if __name__ == "__main__":
    sys.exit(main())
