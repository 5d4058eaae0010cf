#!/usr/bin/env python3
"""Writes API reference pages (reStructuredText, Sphinx's C and C++ domains) of the public headers.

api_pages.py ROOT OUT SCRATCH

Doxygen reads the headers through header_filter.py and writes XML. A page follows its header: the
parts are sections, and declarations that share a comment share a description. Called by
make_docs.py.
"""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent
# page, title, domain, headers
PAGES = [
    ("openrt", "OpenRT: the C API", "c", [
        f"libopenrt/include/openrt/{name}.h" for name in ("openrt", "context", "geometry", "shader",
                                                          "frame", "query", "worker")
    ]),
    ("openrts", "OpenRTS: the shader SDK in C", "c", ["libopenrt/include/openrt/openrts.h"]),
    ("openrts-cpp", "OpenRTS: the shader SDK in C++", "cpp",
     ["libopenrt/include/openrt/openrts.hpp", "libopenrt/include/openrt/openrts_values.hpp"]),
    ("xscript", "The SDK of script engines", "c", ["libxvrml/include/xvrml/xscript.h"]),
    ("xvrml", "XVRML: the scene graph in C++", "cpp", [
        f"libxvrml/include/xvrml/{name}.h" for name in ("world", "browser", "mapper", "node",
                                                        "types", "diagnostics", "limits", "camera",
                                                        "viewer", "media", "change", "behaviour",
                                                        "node_plugin", "node_table",
                                                        "renderer", "appearance", "build",
                                                        "script_engines", "value_text")
    ]),
]
DOXYFILE = """
PROJECT_NAME = {name}
INPUT = {headers}
INPUT_FILTER = "{python} {filter}"
OUTPUT_DIRECTORY = {out}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
QUIET = YES
WARNINGS = NO
MARKDOWN_SUPPORT = NO
OPTIMIZE_OUTPUT_FOR_C = {c}
EXTRACT_ALL = YES
SORT_MEMBER_DOCS = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = RT_API= XS_EXPORT= RTS_EXPORT= {defines}
"""


def run_doxygen(name, domain, headers, root, scratch):
    out = scratch / name
    out.mkdir(parents=True, exist_ok=True)
    config = DOXYFILE.format(name=name,
                             headers=" ".join(f'"{root / h}"' for h in headers),
                             python=sys.executable,
                             filter=HERE / "header_filter.py",
                             out=out,
                             c="YES" if domain == "c" else "NO",
                             defines="" if domain == "c" else "__cplusplus")
    subprocess.run(["doxygen", "-"], input=config, text=True, check=True, stdout=subprocess.DEVNULL)
    return {
        c.get("id"): c for f in sorted((out / "xml").glob("*.xml"))
        for c in ElementTree.parse(f).getroot().findall("compounddef")
    }


def flat(element):
    return re.sub(r"\s+", " ", "".join(element.itertext())).strip() if element is not None else ""


class Text:
    """Converts Doxygen's paragraphs to reStructuredText; names of the API become links."""

    def __init__(self, roles):
        self.roles = roles

    def escape(self, text):
        text = re.sub(r"\s+", " ", text)

        def word(match):
            role = self.roles.get(match.group(0))
            return f":{role}:`{match.group(0)}`\\ " if role else match.group(0)

        pieces = re.split(r"(`[^`]*`|\w+)", text)
        out = ""
        for piece in pieces:
            if re.fullmatch(r"`[^`]+`", piece):
                out += f"``{piece[1:-1]}``\\ "
            elif re.fullmatch(r"\w+", piece):
                linked = word(re.match(r"\w+", piece))
                out += linked if linked != piece else re.sub(r"_$", r"\\_", piece)
            else:
                out += re.sub(r"([*|\\`])", r"\\\1", piece)
        return out

    def blocks(self, element):
        """Returns the lines of all paragraphs below an element."""
        lines = []
        for para in element.findall("para") if element is not None else []:
            lines += self.paragraph(para)
        return lines

    def paragraph(self, para):
        lines, text = [], para.text or ""
        for child in para:
            if child.tag in ("programlisting", "verbatim", "itemizedlist", "simplesect"):
                lines += [self.escape(text).strip(), ""] if text.strip() else []
                text = ""
                if child.tag == "itemizedlist":
                    for item in child.findall("listitem"):
                        body = [line for p in item.findall("para") for line in self.paragraph(p)]
                        lines += ["* " + body[0], *("  " + line for line in body[1:])]
                    lines.append("")
                elif child.tag == "programlisting":
                    code = [
                        "".join(" " if e.tag == "sp" else (e.text or "") +
                                (e.tail or "") if e.tag != "sp" else ""
                                for e in self.leaves(line))
                        for line in child.findall("codeline")
                    ]
                    lines += [".. code-block:: text", "", *("   " + line for line in code), ""]
                else:
                    lines += self.blocks(child)
            else:
                text += "".join(child.itertext())
            text += child.tail or ""
        if text.strip():
            lines += [self.escape(text).strip(), ""]
        return lines

    def leaves(self, line):
        """Returns a line of code as a flat list of elements with text."""
        for highlight in line:
            yield _Leaf(highlight.text or "")
            for child in highlight:
                yield _Leaf(" " if child.tag == "sp" else "".join(child.itertext()))
                yield _Leaf(child.tail or "")


class _Leaf:
    tag = "text"
    tail = ""

    def __init__(self, text):
        self.text = text


def described(text, member):
    return text.blocks(member.find("briefdescription")) + text.blocks(
        member.find("detaileddescription"))


def indent(lines, by="   "):
    return [by + line if line else "" for line in lines]


def line_of(element):
    place = element.find("location")
    return (place.get("file", ""), int(place.get("line", "0"))) if place is not None else ("", 0)


def template_of(member):
    parameters = member.find("templateparamlist")
    if parameters is None:
        return ""
    return "template <" + ", ".join(
        flat(p.find("type")) +
        (" " + flat(p.find("declname")) if p.find("declname") is not None else "")
        for p in parameters) + "> "


def signature(member, domain):
    """Returns the declaration for the domain's directive, without parts that it does not
    understand."""
    kind, name = member.get("kind"), flat(member.find("name"))
    type_, arguments = flat(member.find("type")), flat(member.find("argsstring"))
    if kind == "function":
        arguments = re.sub(r"\s*=\s*(default|delete)$", r" = \1", arguments)
        text = f"{template_of(member)}{type_} {name}{arguments}"
        if member.get("static") == "yes" and not type_.startswith("static"):
            text = "static " + text
        return re.sub(r"\b(RT_API|inline) ", "", text).strip()
    if kind == "typedef":
        if "(*" in type_ or type_.endswith("(*"):
            return f"{type_}{name}{arguments}"
        if domain == "cpp":
            return f"{template_of(member)}{name} = {type_}" if type_ else name
        return f"{type_} {name}{arguments}"
    value = flat(member.find("initializer"))
    value = " " + value if value and len(value) < 60 and domain == "cpp" else ""
    type_ = re.sub(r"\b(inline|constexpr) ", "", type_)
    type_ = re.sub(r"^(union|struct) \S*@\d+", r"\1", type_)
    return f"{type_}{'' if type_.endswith('(*') else ' '}{name}{arguments}{value}".strip()


DIRECTIVE = {"function": "function", "typedef": "type", "variable": "member", "define": "macro"}


class Page:

    def __init__(self, domain, compounds, text):
        self.domain, self.compounds, self.text = domain, compounds, text
        self.done = set()

    def directive(self, kind, signatures, body):
        prefix = f".. {self.domain}:{kind}:: "
        return [
            prefix + signatures[0], *(" " * len(prefix) + s for s in signatures[1:]), "",
            *indent(body), ""
        ]

    def enum(self, member):
        name, out = flat(member.find("name")), []
        values = []
        for value in member.findall("enumvalue"):
            initial = flat(value.find("initializer"))
            values += self.directive(
                "enumerator", [flat(value.find("name")) + (" " + initial if initial else "")],
                described(self.text, value))
        said = described(self.text, member)
        if not name or name.startswith("@"):
            return [*said, *values]
        kind = "enum-class" if member.get("strong") == "yes" else "enum"
        out += self.directive(kind, [name], [*said, *values])
        return out

    def member(self, member):
        kind = member.get("kind")
        if kind == "enum":
            return self.enum(member)
        name = flat(member.find("name"))
        if kind not in DIRECTIVE or name.startswith("@"):
            return []
        if kind == "typedef" and re.search(rf"^(struct|enum|union) {name}$",
                                           flat(member.find("type"))):
            return []  # C's second name for the same type
        if kind == "define":
            if name.endswith(("_API", "_EXPORT", "_H", "_HPP")):
                return []
            parameters = [flat(p) for p in member.findall("param")]
            said = described(self.text, member)
            value = flat(member.find("initializer"))
            if value and len(value) < 40:
                said = [f"``{value}``", "", *said]
            macro = name + (f"({', '.join(parameters)})" if parameters else "")
            prefix = f".. c:macro:: {macro}"
            return [prefix, "", *indent(said), ""]
        # Doxygen lists the members of a union before the union itself.
        if kind == "variable" and re.match(r"union \S*@\d+$", flat(member.find("type"))):
            return [f"The pointers above are one union, ``{name}``.", ""]
        sign = signature(member, self.domain)
        directive = DIRECTIVE[kind]
        if kind == "variable" and not sign.replace(flat(member.find("name")), "").strip():
            return []
        body = described(self.text, member)
        return self.directive(directive, [sign], body)

    def sections(self, compound):
        """Returns entries (line, lines of the page) for the members of a compound."""
        entries = []
        for section in compound.findall("sectiondef"):
            if section.get("kind", "").startswith(("private", "protected")):
                continue
            members = [
                m for m in section.findall("memberdef")
                if m.get("id") not in self.done and m.get("prot", "public") == "public"
            ]
            if section.get("kind") == "user-defined" and members and all(
                    m.get("kind") in ("function", "variable") for m in members):
                # These members share one description.
                self.done.update(m.get("id") for m in members)
                kinds = {m.get("kind") for m in members}
                directive = DIRECTIVE[kinds.pop()] if len(kinds) == 1 else "function"
                body = self.text.blocks(section.find("description"))
                for m in members:
                    body += described(self.text, m)
                entries.append((line_of(members[0]),
                                self.directive(directive,
                                               [signature(m, self.domain) for m in members], body)))
                continue
            for together in self.by_line(members):
                self.done.update(m.get("id") for m in together)
                if len(together) > 1:
                    body = [line for m in together for line in described(self.text, m)]
                    entries.append(
                        (line_of(together[0]),
                         self.directive("member", [signature(m, self.domain) for m in together],
                                        body)))
                else:
                    entries.append((line_of(together[0]), self.member(together[0])))
        for inner in compound.findall("innerclass"):
            if inner.get("prot", "public") == "public" and inner.get("refid") not in self.done:
                inside = self.compounds.get(inner.get("refid"))
                if inside is not None:
                    self.done.add(inner.get("refid"))
                    entries.append((line_of(inside), self.structure(inside)))
        return entries

    def by_line(self, members):
        """Groups variables that one line declares; they share its comment."""
        out = []
        for member in members:
            if out and member.get("kind") == out[-1][0].get("kind") == "variable" and line_of(
                    member) == line_of(out[-1][0]):
                out[-1].append(member)
            else:
                out.append([member])
        return out

    def structure(self, compound):
        name = flat(compound.find("compoundname"))
        if "detail" in name.split("::") or name.split("::")[-1].startswith("@"):
            return []
        bases = [flat(b) for b in compound.findall("basecompoundref") if b.get("prot") == "public"]
        kind = compound.get("kind")
        body = self.text.blocks(compound.find("briefdescription")) + self.text.blocks(
            compound.find("detaileddescription"))
        for _, lines in sorted(self.sections(compound), key=lambda e: e[0]):
            body += lines
        shown = name.split("::")[-1] if self.depth_of(name) else re.sub(r"^(rts|xvrml)::", "", name)
        sign = template_of(compound) + shown + (" : public " + ", ".join(bases)
                                                if bases and self.domain == "cpp" else "")
        return self.directive({
            "class": "class",
            "struct": "struct",
            "union": "union"
        }[kind], [sign], body)

    def depth_of(self, name):
        """Returns the depth of nesting in other structures (not name spaces) of the page."""
        outer = name.rsplit("::", 1)[0]
        return any(
            flat(c.find("compoundname")) == outer and c.get("kind") in ("class", "struct")
            for c in self.compounds.values())

    def title(self, text, line):
        return [text, line * len(text), ""]

    def header(self, path, root, single):
        filtered = path.name
        compound = next(c for c in self.compounds.values()
                        if c.get("kind") == "file" and flat(c.find("compoundname")) == filtered)
        out = [] if single else self.title(path.parent.name + "/" + path.name, "-")
        out += [f"``#include <{path.parent.name}/{path.name}>``", ""]
        out += self.text.blocks(compound.find("briefdescription")) + self.text.blocks(
            compound.find("detaileddescription"))
        groups = []
        for c in self.compounds.values():
            if c.get("kind") == "group" and flat(
                    c.find("compoundname")).startswith(re.sub(r"\W", "_", path.name) + "_"):
                groups.append((c, sorted(self.sections(c), key=lambda e: e[0])))
        groups.sort(key=lambda g: g[1][0][0] if g[1] else ("", 0))
        names = {
            flat(c.find("compoundname"))
            for c in self.compounds.values()
            if c.get("kind") == "namespace"
        } - {""}
        space = next((n for n in sorted(names) if "::" not in n and n in ("rts", "xvrml")), None)
        own = sorted(self.sections(compound), key=lambda e: e[0])
        if space and self.domain == "cpp":
            # members of the name space that this header declares
            inside = next(
                c for c in self.compounds.values() if flat(c.find("compoundname")) == space)
            own += [e for e in self.sections_in(inside, path)]
            own.sort(key=lambda e: e[0])
            out += [f".. cpp:namespace:: {space}", ""]
        for _, lines in own:
            out += lines
        for group, entries in groups:
            out += self.title(flat(group.find("title")), "~")
            out += self.text.blocks(group.find("detaileddescription"))
            for _, lines in entries:
                out += lines
        return out

    def sections_in(self, namespace, path):
        entries = []
        for section in namespace.findall("sectiondef"):
            for member in section.findall("memberdef"):
                if line_of(member)[0].endswith(f"/{path.parent.name}/{path.name}") and member.get(
                        "id") not in self.done:
                    self.done.add(member.get("id"))
                    entries.append((line_of(member), self.member(member)))
        return entries


def roles_of(compounds, domain):
    """Returns name -> role, for links in running text."""
    roles = {}
    if domain != "c":
        return roles
    for compound in compounds.values():
        if compound.get("kind") == "struct":
            roles[flat(compound.find("compoundname"))] = "c:struct"
        for member in compound.iter("memberdef"):
            name, kind = flat(member.find("name")), member.get("kind")
            if compound.get("kind") == "struct":
                continue
            if kind == "function":
                roles[name] = "c:func"
            elif kind == "typedef":
                roles.setdefault(name, "c:type")
            elif kind == "enum" and name and not name.startswith("@"):
                roles[name] = "c:enum"
            for value in member.findall("enumvalue"):
                roles[flat(value.find("name"))] = "c:enumerator"
    return {n: r for n, r in roles.items() if len(n) > 3}


def write_pages(root, out, scratch):
    out.mkdir(parents=True, exist_ok=True)
    for name, title, domain, headers in PAGES:
        compounds = run_doxygen(name, domain, headers, root, scratch)
        page = Page(domain, compounds, Text(roles_of(compounds, domain)))
        lines = page.title(title, "=") + ["*Made from the header's own comments.*", ""]
        for header in headers:
            lines += page.header(root / header, root, len(headers) == 1)
        if "c" == domain:
            lines = [".. highlight:: c", "", *lines]
        (out / f"{name}.rst").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write_pages(
        pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
