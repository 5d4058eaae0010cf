"""Finds the code blocks of the documents and says how each is checked. Used by run_blocks.py,
package_test.py and make_docs.py.

A block is a fence with a language. The test does with it what a reader would do:

sh        is run, all blocks of a page in one folder with the programs of the build and a copy of
          examples/; each starts in the folder to which the one before has changed; pictures are
          made small
python    is run, all blocks of a page in one interpreter
c, cpp    is compiled, and run if it has a main
vrml      is read by vv --check --strict
js, tcl   is read by the language's engine, or by tclsh
X file=N  is written to N for the blocks that follow

Comments before a fence state exceptions:

<!-- unchecked: WHY -->         nothing is checked; text needs it, too, because it is not code
<!-- syntax only: WHY -->       python, sh: compiled, not run
<!-- in: FOLDER -->             checked in this folder
<!-- inside: SIGNATURE -->      c, cpp: the block is the body of this function
<!-- with: TEXT -->             vrml: TEXT is put before it
<!-- part of: FILE -->          any: this file of the repository contains it, up to blanks"""
import dataclasses
import pathlib
import re

# Pages that the test `package` follows step by step with the installed package
TUTORIALS = ("docs/node-plugins.md", "docs/shaders.md", "docs/script-engines.md")
RUN = {"sh", "python"}
COMPILED = {"c", "cpp"}
READ = {"vrml", "js", "tcl"}
# Pages that have a test of their own
BY_TESTS = {
    "docs/python.md": "tests/python/test_docs_python.py",
    "docs/figures.md": "tests/python/test_docs_python.py",
    "docs/ray-queries.md": "tests/python/test_docs_python.py"
}
MARKS = ("unchecked", "syntax only", "in", "inside", "with", "part of")
# Commands that install or build the project are covered by other tests
OTHERS = re.compile(r"(make|git|sudo|apt|apt-get|pip|docker|podman)\b")


@dataclasses.dataclass
class Block:
    page: str
    line: int
    language: str
    file: str
    text: str
    marks: dict

    @property
    def way(self):
        """Returns how it is checked: followed, run, compiled, read, written, compared, syntax or
        unchecked; otherwise what is wrong."""
        if self.page in TUTORIALS and (self.file or self.language in RUN):
            return "followed"
        if self.page in BY_TESTS and self.language == "python":
            return "followed"
        if "part of" in self.marks:
            return "compared"
        if not self.language:
            return "wrong: the fence names no language"
        if self.file:
            return "written"
        if "unchecked" in self.marks:
            return "unchecked" if self.marks["unchecked"] else "wrong: unchecked: says no reason"
        if "syntax only" in self.marks and self.language in RUN:
            return "syntax"
        if self.language in RUN:
            return "run"
        if self.language in COMPILED:
            return "compiled"
        if self.language in READ:
            return "read"
        return f"wrong: nobody checks {self.language}: <!-- unchecked: WHY --> before it, or another language"


def pages(root):
    """Returns the documents whose blocks are checked."""
    found = [
        root / "README.md", root / "HACKING.md", root / "CHANGELOG.md", *sorted(
            (root / "docs").rglob("*.md")), *sorted((root / "examples").rglob("*.md"))
    ]
    return [p for p in found if p.exists()]


def blocks_of(root, page):
    name, marks, out = page.relative_to(root).as_posix(), {}, []
    lines, i = page.read_text(encoding="utf-8").split("\n"), 0
    while i < len(lines):
        line = lines[i]
        mark = re.fullmatch(r"\s*<!-- ([a-z ]+): (.*) -->", line)
        fence = re.match(r"(\s*)(`{3,})(.*)$", line)
        if mark and mark.group(1) in MARKS:
            marks[mark.group(1)] = mark.group(2).strip()
        elif fence:
            words, end = fence.group(3).split(), i + 1
            while end < len(lines) and lines[end].strip() != fence.group(2):
                end += 1
            # {toctree} and other directives are not code
            if not words or not words[0].startswith("{"):
                file = next((w[5:] for w in words if w.startswith("file=")), "")
                margin = len(fence.group(1))
                text = "\n".join(text[margin:] for text in lines[i + 1:end]) + "\n"
                out.append(Block(name, i + 1, words[0] if words else "", file, text, marks))
            marks, i = {}, end
        elif line.strip():
            marks = {}
        i += 1
    return out


def small(command):
    """Returns a shell line with a small picture size, unless its pictures are small already."""
    if not re.search(r"(^|[\s;|&])vv .*-o ", command) or re.search(
            r"--(compare|audit|crop|intrinsics)\b|\bvv (merge|compare|film)\b", command):
        return command
    size = re.search(r"--size (\d+)x(\d+)", command)
    if size and int(size.group(1)) * int(size.group(2)) < 160 * 120:
        return command
    command = re.sub(r" --size \S+", "", command)
    more = " --size 36x24"
    if "--error" not in command:
        command = re.sub(r" --spp \S+", "", command)
        more += " --spp 1"
    return re.sub(r"((?:^|[\s;|&])vv )", r"\1" + more.strip() + " ", command)


def shell(text, change=small):
    """Returns the lines of a shell block that are run, each passed through `change`; empty if there
    are none."""
    joined = re.sub(r"\\\n\s*", "", text)
    return "\n".join(
        change(line)
        for line in joined.split("\n")
        if line.strip() and not OTHERS.match(line.strip()))


def table(root):
    """Returns a Markdown table: how many blocks of each page are checked in which way."""
    ways = ["run", "followed", "compiled", "read", "compared", "written", "syntax", "unchecked"]
    rows = ["| page | " + " | ".join(ways) + " |", "| --- |" + " --- |" * len(ways)]
    for page in pages(root):
        blocks = blocks_of(root, page)
        if blocks:
            counts = [sum(b.way == way for b in blocks) or "" for way in ways]
            rows.append(f"| `{page.relative_to(root)}` | " + " | ".join(map(str, counts)) + " |")
    reasons = [
        f"* `{b.page}`, line {b.line}, {b.language or 'text'}: {b.marks['unchecked']}"
        for page in pages(root)
        for b in blocks_of(root, page)
        if b.way == "unchecked"
    ]
    return "\n".join(rows + ["", "Unchecked, and why:", ""] + reasons)


if __name__ == "__main__":
    print(table(pathlib.Path(__file__).resolve().parents[2]))
