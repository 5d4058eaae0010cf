#!/usr/bin/env python3
"""Writes manual pages of section 3 from the comments of C headers: one page for each part, and a
link for every function.

make_man_pages.py FOLDER VERSION HEADER...

The first comment of the first header introduces the library. A part begins with a comment of one
line that ends in dashes. A comment describes what is below it, up to the next comment or blank
line. Indented lines of a comment stay unchanged; lines that begin with a dash are items of a list.
"""
import pathlib
import re
import sys

NAMES = {
    "errors": "errors",
    "life": "contexts",
    "primitives": "primitives",
    "arrays": "arrays",
    "matrices": "matrices",
    "objects": "objects",
    "shaders": "shaders",
    "roles": "roles",
    "textures": "textures",
    "frames": "frames",
    "statistics": "statistics",
    "queries": "queries",
    "double": "double_queries",
    "nearest": "nearest_places",
    "workers": "workers",
    "sums": "sums"
}
TITLES = {
    "errors": "errors and messages",
    "contexts": "contexts and their configuration",
    "primitives": "primitives of an object",
    "arrays": "primitives from arrays",
    "matrices": "the matrix stack",
    "objects": "objects and instances",
    "shaders": "shaders and their parameters",
    "roles": "lights, camera, environment, transport",
    "textures": "textures",
    "frames": "frames, quality, pixels, statistics",
    "statistics": "statistics of the scene and of the last frame",
    "queries": "ray queries and picking",
    "double_queries": "ray queries in double precision",
    "nearest_places": "the nearest places of a scene",
    "workers": "the workers of a cluster",
    "sums": "sums of frames, to continue and to add them"
}


def escape(text):
    text = text.replace("\\", "\\e")
    return "\n".join(
        "\\&" + line if line.startswith((".", "'")) else line for line in text.split("\n"))


def comment_text(block):
    """Returns the lines of a comment without its frame."""
    lines = re.sub(r"^\s*/\*+ ?|\s*\*/\s*$", "", block, flags=re.S).split("\n")
    return [
        re.sub(r"^ ?\* ?", "",
               line.lstrip() if line.lstrip().startswith("*") else line).rstrip() for line in lines
    ]


def paragraphs(lines):
    """Converts running text, items and literal lines of a comment to roff."""
    out, text, literal = [], [], []

    def flush():
        nonlocal text, literal
        if text:
            out.append(escape(" ".join(text)))
        if literal:
            out.extend([".nf", *[escape(line) for line in literal], ".fi"])
        text, literal = [], []

    for line in lines:
        item = re.match(r"\s*- (.*)", line)
        if item:
            flush()
            out.append('.IP \\(bu 3')
            text = [item.group(1)]
        elif not line.strip():
            flush()
            out.append(".PP")
        elif re.match(r" {2,}\S", line) and not (text and out and out[-1].startswith(".IP")):
            if text:
                flush()
            literal.append(line)
        else:
            if literal:
                flush()
            text.append(line.strip())
    flush()
    return out


def tokens(part):
    """Returns the comments, function declarations, other declarations and blank lines of a part, in
    order."""
    lines, i = part.split("\n"), 0
    while i < len(lines):
        line = lines[i]
        if not line.strip():
            yield "blank", ""
        elif line.startswith("/*"):
            block = [line]
            while "*/" not in block[-1]:
                i += 1
                block.append(lines[i])
            yield "comment", "\n".join(block)
        elif line.startswith("RT_API"):
            block = [line]
            while not block[-1].rstrip().endswith(";"):
                i += 1
                block.append(lines[i])
            yield "function", re.sub(r"\s+", " ", " ".join(block)).replace("RT_API ", "")
        elif not line.startswith("#"):
            block = [line]
            while not re.search(r"(^}.*;|;)\s*(/\*.*)?$",
                                block[-1]) or block[0].count("{") and not any("}" in b
                                                                              for b in block):
                i += 1
                block.append(lines[i])
            while "/*" in block[-1] and "*/" not in block[-1]:
                i += 1
                block.append(lines[i])
            yield "other", "\n".join(block)
        i += 1


def function_name(declaration):
    return re.search(r"(\w+)\(", declaration).group(1)


def describe(part):
    """Returns the body of DESCRIPTION, and the declarations of the part's functions."""
    body, functions, said, open_run = [], [], None, False
    for kind, text in tokens(part):
        if kind == "blank":
            if said is not None:
                body += [".PP", *paragraphs(said)]
            said, open_run = None, False
        elif kind == "comment":
            if said is not None:
                body += [".PP", *paragraphs(said)]
            said, open_run = comment_text(text), False
        elif kind == "function":
            functions.append(text)
            if not open_run:
                body.append(".PP")
            body += [".B " + escape(text), ".br"]
            open_run = True
            continue_said = said
            if continue_said is not None:
                body += ["@" + "\n".join(continue_said)]  # moved after the declarations below
                said = None
        else:
            if said is not None:
                body += [".PP", *paragraphs(said)]
                said = None
            body += [".PP", ".nf", escape(text), ".fi"]
            open_run = False
    if said is not None:
        body += [".PP", *paragraphs(said)]
    return settle(body), functions


def settle(body):
    """Moves the text of a comment behind the declarations below it."""
    out, waiting = [], None
    for i, line in enumerate(body):
        if line.startswith("@"):
            waiting = line[1:].split("\n")
            continue
        if waiting is not None and line == ".PP":
            out += [".RS 4", *paragraphs(waiting), ".RE"]
            waiting = None
        out.append(line)
    if waiting is not None:
        out += [".RS 4", *paragraphs(waiting), ".RE"]
    return out


def page(name, title, version, names, synopsis, body, others):
    upper = name.upper()
    lines = [
        f'.TH {upper} 3 "" "OpenRT {version}" "OpenRT Manual"', ".nh", ".ad l", ".SH NAME",
        escape(", ".join(names)) + " \\- " + title, ".SH SYNOPSIS", ".nf",
        ".B #include <openrt/openrt.h>", ".PP", *[escape(s) for s in synopsis], ".fi", ".PP",
        "Link with \\fI-lopenrt\\fP.", ".SH DESCRIPTION", *body
    ]
    if name != "openrt":
        lines += [
            ".SH ERRORS", "A call that fails changes nothing and records an error, which",
            ".BR rtGetError (3)",
            "returns; calls that return an id then return 0. Without a current context every call but those of",
            ".BR openrt_contexts (3)", "fails with RT_INVALID_OPERATION."
        ]
    lines += [
        ".SH SEE ALSO", ",\n".join(f".BR {other} (3)" for other in others).replace(",\n", " ,\n")
    ]
    text = "\n".join(lines) + "\n"
    text = re.sub(r"(\.PP\n)+(?=\.(SH|RS|PP|IP))", "", text)
    return re.sub(r"(\.SH [^\n]*\n)\.PP\n", r"\1", text)


def main():
    folder, version = pathlib.Path(sys.argv[1]), sys.argv[2]
    headers = [pathlib.Path(name).read_text() for name in sys.argv[3:]]
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.3"):
        old.unlink()
    intro = comment_text(re.match(r"/\*.*?\*/", headers[0], re.S).group(0))
    parts = []
    for header in headers:
        if "#ifdef __cplusplus" in header:
            header = header[:header.rindex("#ifdef __cplusplus")]
        pieces = re.split(r"^/\* ([A-Z][^\n]*?) ?-{4,} \*/$", header, flags=re.M)
        for title, text in zip(pieces[1::2], pieces[2::2]):
            name = NAMES[re.match(r"\w+", title).group(0).lower()]
            body, functions = describe(text)
            parts.append((name, body, functions))
    all_pages = ["openrt"] + ["openrt_" + name for name, _, _ in parts]
    for name, body, functions in parts:
        names = [function_name(f) for f in functions]
        own = "openrt_" + name
        others = [p for p in all_pages if p != own]
        (folder / f"{own}.3").write_text(
            page(own, TITLES[name], version, [own] + names, functions, body, others))
        for link in names:
            (folder / f"{link}.3").write_text(f".so man3/{own}.3\n")
    groups = [
        line for name, _, functions in parts
        for line in (".TP", f".BR openrt_{name} (3)",
                     escape(TITLES[name] + ": " + ", ".join(map(function_name, functions))))
    ]
    body = [*paragraphs(intro[1:]), ".PP", "The functions by group:", *groups]
    (folder / "openrt.3").write_text(
        page("openrt", "a ray tracing interface in OpenGL's manner", version, ["openrt"],
             ["RTcontext context = rtNewContext(NULL);"], body, all_pages[1:]))


if __name__ == "__main__":
    main()
