"""Comments of source files, and the paragraphs of documents, for hygiene.py."""
import collections
import io
import re
import tokenize

# One comment, or lines of comments that belong together. number: that of the first line;
# trailing: stands after code in its line.
Block = collections.namedtuple("Block", "number trailing text")

# Strings come first, so that what looks like a comment in one of them is none.
C_TOKENS = re.compile(
    r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'|'
    r'//[^\n]*|/\*.*?\*/', re.S)
C_SUFFIXES = {".c", ".cpp", ".h", ".hpp", ".fbs"}
MARKS = re.compile(r'^(?://[/!]?<?|/\*+|#+:?|[a-z]?""")|(?:\*/|""")$')


def pieces(path, text):
    """Yields line, column, whether code stands before it, and text of each comment."""
    if path.suffix in C_SUFFIXES:
        for match in C_TOKENS.finditer(text):
            if match.group().startswith(("//", "/*")):
                start = text.rfind("\n", 0, match.start()) + 1
                before = text[start:match.start()]
                yield text.count("\n", 0, match.start()) + 1, len(before), bool(
                    before.strip()), match.group()
    elif path.suffix == ".py":
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            line, column = token.start
            before = token.line[:column].strip()
            if token.type == tokenize.COMMENT:
                yield line, column, bool(before), token.string
            elif token.type == tokenize.STRING and token.string.startswith('"""') and not before:
                yield line, column, False, token.string
    elif path.suffix in {".cmake", ".sh", ".node"} or path.name in {
            "CMakeLists.txt", "Makefile", "run"
    }:
        for number, line in enumerate(text.split("\n"), 1):
            match = re.search(r"(?:^|(?<=\s))#(?!!).*", line)
            if match and line[:match.start()].count('"') % 2 == 0:
                before = line[:match.start()]
                yield number, len(before), bool(before.strip()), match.group()


def blocks(path, text):
    """Returns the blocks of comments of a source file."""
    found, end, left = [], 0, 0
    for line, column, trailing, comment in pieces(path, text):
        lines = comment.count("\n")
        plain = re.sub(r"\n[ \t]*\*?", "\n", MARKS.sub("", comment)).strip()
        if found and not trailing and not found[-1].trailing and (line, column) == (end + 1, left):
            found[-1] = found[-1]._replace(text=f"{found[-1].text}\n{plain}")
        else:
            found.append(Block(line, trailing, plain))
        end, left = line + lines, column
    return found


def paragraphs(text):
    """Returns the paragraphs and lists of a document: no code, no headings, no tables."""
    text = re.sub(r"^ *```.*?^ *```", lambda match: "\n" * match.group().count("\n"), text,
                  flags=re.M | re.S)
    return [
        Block(text.count("\n", 0, match.start()) + 1, False, match.group())
        for match in re.finditer(r"(?:^(?!\s*$|#|\||\s*:alt:).*\n?)+", text, re.M)
    ]
