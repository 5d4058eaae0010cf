#!/usr/bin/env python3
"""Converts a public header for Doxygen: header_filter.py HEADER (an INPUT_FILTER; writes to
standard output).

The headers use plain comments, with the rules of tools/make_man_pages.py. A comment describes what
is below it, up to the next comment or blank line; a trailing comment describes its declaration; a
title that ends in dashes opens a part. Doxygen gets comments of its own form: parts become groups,
and runs of declarations under one comment become named sections.
"""
import pathlib
import re
import sys

SECTION = re.compile(r"^(?:/\*|//) ?([A-Z][^\n]*?) ?-{4,}(?: \*/)?$")
SUBSECTION = re.compile(r"^\s*(?://|/\*) --- (.*) ---(?: \*/)?$")


def slug(title):
    return re.sub(r"\W+", "_", re.split(r"[:(]", title)[0].strip().lower()).strip("_")


def groups_of(text, name):
    """Returns (group id, title) of each part of a header."""
    prefix = re.sub(r"\W", "_", name)
    return [(f"{prefix}_{slug(m.group(1))}", m.group(1))
            for m in map(SECTION.match, text.split("\n"))
            if m]


def escape(text):
    text = re.sub(r"([\\@<>&#%])", r"\\\1", text).replace("*/", "* /")
    return re.sub(r"(?<!-)(-{2,3})(?!-)", r"\\\1", text)


def body(lines):
    """Returns the text of a comment: list items stay, and indented lines are literal."""
    out, literal, item = [], False, False
    for line in lines:
        bullet = re.match(r"\s*- ", line)
        indented = bool(re.match(r" {2,}\S", line)) and not bullet and not item
        if indented != literal:
            out.append("@code{.unparsed}" if indented else "@endcode")
            literal = indented
        item = bool(bullet) or (item and bool(line.strip()))
        out.append(line.replace("*/", "* /") if literal else escape(line))
    return out + (["@endcode"] if literal else [])


def plain(block):
    """Returns the lines of a comment without its frame."""
    if block[0].lstrip().startswith("//"):
        return [re.sub(r"^\s*// ?", "", line).rstrip() for line in block]
    lines = re.sub(r"^\s*/\* ?|\s*\*/\s*$", "", "\n".join(block)).split("\n")
    margin = 3 + len(block[0]) - len(block[0].lstrip())  # margin of the text after "/* "
    return [
        re.sub(r"^\s*\* ?", "", line)
        if re.match(r"\s*\*", line) else line[min(margin,
                                                  len(line) - len(line.lstrip())):]
        for line in lines
    ]


def trailing(line):
    """Converts code with a trailing comment for Doxygen. Strings in headers contain no comments."""
    if line.startswith("}") and "namespace" in line:
        return "}"
    line = re.sub(r"(\S\s*)/\*(?!\*)", r"\1/**<", line, count=1)
    found = re.match(r'^((?:[^"/]|"[^"]*"|/(?!/))*\S)\s*//(?!/) ?(.*)$', line)
    return f"{found.group(1)} ///< {escape(found.group(2))}" if found else line


def is_comment(line):
    return line.lstrip().startswith("//") or line.lstrip().startswith("/*")


def take_comment(lines, i):
    """Returns the end of the comment that begins at line i."""
    if lines[i].lstrip().startswith("//"):
        while i < len(lines) and lines[i].lstrip().startswith("//"):
            i += 1
        return i
    while "*/" not in lines[i]:
        i += 1
    return i + 1


def run_of(lines, i):
    """Returns the lines from i to a blank line or a comment, which the comment above describes. A
    declaration with a body is not part of a run."""
    end = i
    while end < len(lines) and lines[end].strip() and not is_comment(lines[end]):
        if "{" in lines[end] or lines[end].lstrip().startswith(("#", "}")):
            return None
        end += 1
    text = "\n".join(lines[i:end])
    declarations = re.findall(r"\([^;]*;", re.sub(r"/\*.*?\*/|//[^\n]*", "", text))
    return end if len(declarations) > 1 else None


def filtered(text, name):
    prefix = re.sub(r"\W", "_", name)
    lines, out, i, group = text.split("\n"), [], 0, None
    guard = max((n for n, line in enumerate(lines)
                 if line.startswith(("#ifdef __cplusplus", "} // namespace", "} /* extern"))),
                default=len(lines))
    while i < len(lines):
        line = lines[i]
        if group and i == guard:
            out += ["/** @} */", ""]
            group = None
        section = SECTION.match(line)
        if section:
            if group:
                out.append("/** @} */")
            group = f"{prefix}_{slug(section.group(1))}"
            out += [f"/** @defgroup {group} {escape(section.group(1))}", " * @{ */"]
            i += 1
            if line.startswith("/*") and "*/" not in line:  # the text of the part follows
                end = i
                while "*/" not in lines[end]:
                    end += 1
                out += [f"/** @addtogroup {group}", *body(plain(["/*", *lines[i:end + 1]])), "*/"]
                i = end + 1
        elif is_comment(line):
            end = take_comment(lines, i)
            said = body(plain(lines[i:end]))
            following = run_of(lines, end)
            if i == 0:
                out += [f"/** @file {name}", *said, "*/"]
            elif SUBSECTION.match(lines[i]) and end == i + 1:
                out.append("")
            elif end < len(lines) and not lines[end].strip():
                out += [f"/** @addtogroup {group}", *said, "*/"] if group else [""]
            elif following:
                out += [
                    f"/** @name run {end}", *said, "*/", "/**@{*/",
                    *(trailing(code) for code in lines[end:following]), "/**@}*/"
                ]
                end = following
            else:
                out += ["/**", *said, "*/"]
            i = end
        else:
            out.append(trailing(line))
            i += 1
            # it continues on the next lines
            if "/*" in line and "*/" not in line[line.index("/*"):]:
                while "*/" not in lines[i]:
                    out.append(lines[i])
                    i += 1
                out.append(lines[i])
                i += 1
    return "\n".join(out)


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    sys.stdout.write(filtered(path.read_text(encoding="utf-8"), path.name))
