#!/usr/bin/env python3
"""Writes the linker's version script of a library. It exports what the library's public headers
declare under VERSION, and what a sibling library of the project includes of its private headers
under a private version of this release. Everything else is local.

make_version_script.py --output FILE --version NODE
    [--private NODE (--private-all NAMESPACE | --of FOLDER --siblings FOLDER...)] HEADER...

C functions are recognized by RT_API. From C++ headers it takes functions and variables of
namespaces, member functions, static members, virtual function tables and type information, as
patterns over demangled names (`extern "C++"`). CMake runs it; without Python there is no version
script.
"""
import argparse
import pathlib
import re

TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|[A-Za-z_]\w*|::|[^\sA-Za-z_]')


def tokens(text):
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", text, flags=re.S)
    # digit separators, not character literals
    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "", text)
    text = re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", " ", text, flags=re.M)
    return TOKEN.findall(text)


def skip(words, i, opening, closing):
    """Returns the index after the bracket that closes the one at i."""
    depth = 0
    while i < len(words):
        depth += (words[i] == opening) - (words[i] == closing)
        i += 1
        if depth == 0:
            return i
    return i


def without_templates(statement):
    """Removes template arguments: `std::vector<int()> f(int)` -> `std :: vector f ( int )`."""
    out, depth = [], 0
    for k, word in enumerate(statement):
        if word == "<" and out and re.match(r"\w", out[-1]) and out[-1] != "operator":
            depth += 1
        elif word == ">" and depth:
            depth -= 1
        elif depth == 0:
            out.append(word)
    return out


def declared(statement, scope, kind):
    """Returns the linker name that a statement (without body and `;`) declares, or None."""
    if not statement or statement[0] in ("using", "typedef", "friend", "template", "static_assert",
                                         "public", "enum"):
        return None
    words = without_templates(statement)
    if "operator" in words:
        at = words.index("operator")
        rest = words[at + 1:]
        name = "operator" + ("()" if rest[:2] == ["(", ")"] else
                             "".join(rest[:rest.index("(")] if "(" in rest else rest))
        return None if words[-1] in ("default", "delete", "0") else name
    while "__attribute__" in words:
        at = words.index("__attribute__")
        words = words[:at] + words[skip(words, at + 1, "(", ")"):]
    if "(" in words:
        at = words.index("(")
        if words[-2:-1] == ["="] or at == 0 or "inline" in words or "constexpr" in words:
            return None  # defaulted, deleted, pure
        name = words[at - 1]
        if not re.match(r"[A-Za-z_]", name):
            return None
        if at >= 2 and words[at - 2] == "~":
            name = "~" + name
        if "=" in words[:at] or name in ("void", "bool", "int", "double", "float", "char"):
            return None  # an initial value, or a pointer to a function
        return name
    if kind == "class" and "static" not in words or kind != "class" and "extern" not in words:
        return None
    if "constexpr" in words or "inline" in words:
        return None
    return next((w for w in reversed(words) if re.match(r"[A-Za-z_]\w*$", w)), None)


def scan(words):
    """Returns (names for the linker, classes) of a header, both with their scopes."""
    names, classes, stack, statement, i = set(), set(), [], [], 0

    def scope():
        return "".join(n + "::" for _, n in stack if n)

    while i < len(words):
        word = words[i]
        kind = stack[-1][0] if stack else "namespace"
        if word == "{":
            plain = without_templates(statement)
            if plain[:1] in (["namespace"], ["inline"]) and "namespace" in plain:
                stack.append(("namespace", "".join(plain[plain.index("namespace") + 1:])))
                statement = []
            elif plain[:1] == ["extern"]:
                stack.append(("namespace", ""))
                statement = []
            elif "(" not in plain and ("struct" in plain or "class"
                                       in plain) and "enum" not in plain and "=" not in plain:
                head = plain[:plain.index(":")] if ":" in plain else plain
                name = [
                    w for w in head if re.match(r"[A-Za-z_]", w) and w not in ("final", "struct",
                                                                               "class", "alignas")
                ]
                template = statement[:1] == ["template"]
                stack.append(("template" if template or kind == "template" else "class",
                              name[-1] if name else ""))
                if name and not template and kind != "template":
                    classes.add(scope()[:-2])
                statement = []
            else:  # a body, an enumeration, an initial value
                i = skip(words, i, "{", "}")
                if i < len(words) and words[i] != ";" or "(" in plain:
                    statement = [] if "(" in plain or "enum" in plain else statement
                if "(" in plain:
                    statement = ["using"] if i < len(words) and words[i] == ";" else []
                continue
        elif word == "}":
            if stack:
                stack.pop()
            statement = []
        elif word == ";":
            name = None if kind == "template" else declared(statement, scope(), kind)
            if name:
                names.add(scope() + name)
            statement = []
        elif word == ":" and statement in (["public"], ["private"], ["protected"]):
            statement = []
        elif word == "(":
            end = skip(words, i, "(", ")")
            statement += words[i:end]
            i = end
            continue
        else:
            statement.append(word)
        i += 1
    return names, classes


def pattern(name):
    """Returns a linker pattern for a demangled name; characters that a pattern cannot contain
    become ?."""
    return re.sub(r"[^\w:*]", "?", name)


def patterns(names, classes):
    """A function's name may be followed by ABI tags and parameters, a variable's by nothing."""
    lines = set()
    for name in names:
        lines |= {pattern(name), pattern(name) + "[!a-zA-Z0-9_]*"}
    for name in classes:
        lines |= {f"{what}?for?{name}" for what in ("vtable", "typeinfo")
                 } | {f"typeinfo?name?for?{name}"}
    return sorted(lines)


def c_functions(text):
    return set(re.findall(r"^RT_API [^;(]*?\b(rt\w+)\(", text, re.M))


def private_headers(folder, sources):
    """Returns the headers of a library's own folder that a sibling's sources include."""
    found = set()
    for source in sources:
        for name in re.findall(r'^#include "([^"]+)"', source.read_text(), re.M):
            if not name.startswith(("xvrml/", "openrt/")) and (folder / name).exists():
                found.add(folder / name)
    return sorted(found)


def sibling_patterns(options):
    names, classes = set(), set()
    sources = [
        f for folder in options.siblings for kind in ("*.cpp", "*.h")
        for f in sorted(folder.rglob(kind))
    ]
    for header in private_headers(options.of, sources):
        n, c = scan(tokens(header.read_text()))
        names |= n
        classes |= c
    return patterns(names, classes)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--private", default="")
    parser.add_argument("--private-all",
                        default="",
                        help="namespace that is exported as a whole, for tests of the inside")
    parser.add_argument("--of", type=pathlib.Path)
    parser.add_argument("--siblings",
                        type=pathlib.Path,
                        action="append",
                        help="folder of the sources of a sibling library; several times")
    parser.add_argument("headers", nargs="+", type=pathlib.Path)
    o = parser.parse_args()
    functions, names, classes = set(), set(), set()
    for header in o.headers:
        text = header.read_text()
        if found := c_functions(text):
            functions |= found
        else:
            n, c = scan(tokens(text))
            names |= n
            classes |= c
    out = ["/* Made by cmake/tools/make_version_script.py from the headers; do not edit. */"]
    if o.private:  # first, because the linker uses the last matching pattern
        inner = [f"{o.private_all}::*", f"*?for?{o.private_all}::*"
                ] if o.private_all else sibling_patterns(o)
        out += [
            o.private + " {", "  global:", '    extern "C++" {', *[f"      {p};" for p in inner],
            "    };", "};"
        ]
    out += [o.version + " {", "  global:", *[f"    {name};" for name in sorted(functions)]]
    if names or classes:
        out += ['    extern "C++" {', *[f"      {p};" for p in patterns(names, classes)], "    };"]
    out += ["  local: *;", "};"]
    text = "\n".join(out) + "\n"
    o.output.parent.mkdir(parents=True, exist_ok=True)
    if not o.output.exists() or o.output.read_text() != text:
        o.output.write_text(text)


if __name__ == "__main__":
    main()
