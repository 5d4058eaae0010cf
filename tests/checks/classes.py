"""Widths of C++ classes, for hygiene.py."""
import collections
import re

from comments import C_TOKENS

# number: the line where the class begins; functions: how many its body declares; lines: those of
# the body; head: the comment above it.
Class = collections.namedtuple("Class", "name number functions lines head")

# A head ends before a block: no ";" or "(" stands between the name and the brace, so that forward
# declarations, friends and parameters are none.
HEAD = re.compile(r"\b(?:class|struct)\s+(?:\[\[[^\]]*\]\]\s*)?(?:[A-Z][A-Z_]+\s+)?"
                  r"((?:\w+::)*\w+)\s*(?:final\s*)?(?::[^;{}()]*)?\{")
ACCESS = re.compile(r"\b(?:public|private|protected)\s*:(?!:)")
NO_FUNCTION = re.compile(r"\s*(?:using|friend|static_assert|typedef|enum)\b")
OPERATOR = re.compile(r"\boperator\s*(?:\(\)|[^\s(\w]+|\w[\w:]*[ &*]*)")
INNERMOST_ANGLES = re.compile(r"<[^<>;{}]*>")


def blank(text):
    """Returns code of the same length without comments and strings."""
    return C_TOKENS.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def end_of_block(code, begin):
    """Returns the place behind the brace that closes the block whose inside starts at begin."""
    depth = 1
    for match in re.compile(r"[{}]").finditer(code, begin):
        depth += 1 if match.group() == "{" else -1
        if depth == 0:
            return match.end()
    return len(code)


def statements(body):
    """Yields the declarations of a body; blocks within are left as "{}"."""
    statement, place = "", 0
    for match in iter(lambda: re.compile(r"[{;]").search(body, place), None):
        statement += body[place:match.start()]
        place = match.end()
        if match.group() == "{":
            place = end_of_block(body, place)
            statement += "{}"
            if body[place:].lstrip()[:1] in (",", "{", ";"):
                continue  # an initializer, or a type with a variable
        yield statement
        statement = ""


def is_function(statement):
    """Tells whether a declaration of a class is that of a function."""
    statement = OPERATOR.sub("operator_", ACCESS.sub("", statement))
    statement = re.sub(r"\[\[.*?\]\]|alignas\s*\([^)]*\)", "", statement)
    if NO_FUNCTION.match(statement):
        return False
    while (shorter := INNERMOST_ANGLES.sub("", statement)) != statement:
        statement = shorter
    before, bracket, _ = statement.partition("(")
    return bool(bracket) and not re.search("[={]", before) and bool(re.search(r"\w\s*$", before))


def classes(text):
    """Yields the classes and structs of a source file."""
    code = blank(text)
    for match in HEAD.finditer(code):
        if re.search(r"\benum\s*$", code[:match.start()]):
            continue
        body = code[match.end():end_of_block(code, match.end()) - 1]
        above = re.search(r"(?:^[ \t]*//.*\n)*\Z", text[:code.rfind("\n", 0, match.start()) + 1], re.M)
        yield Class(match.group(1), code.count("\n", 0, match.start()) + 1,
                    sum(map(is_function, statements(body))), body.count("\n") + 1,
                    above.group() if above else "")
