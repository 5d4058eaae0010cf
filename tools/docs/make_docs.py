#!/usr/bin/env python3
"""Builds the documentation as a static site (`make docs`).

make_docs.py ROOT BUILD OUT [--strict] [--check]

ROOT: the repository; BUILD: a build of it (programs, generated node reference, Python package);
OUT: the folder of the site. The pages are those of docs/ and generated ones: the C and C++ API from
the headers, nodes from the .node files, shaders from their plug-ins, options from vv's table,
Python from its stubs. Exit code 77: Sphinx or Doxygen is not installed. --strict: warnings are
errors. --check: every link of the site is followed (check_site.py).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = ["openrt-worker", "openrt-replay", "nodegen"]
# Headers that pages name, and the pages that describe them.
HEADERS = {
    "openrt/openrt.h": "openrt",
    "openrt/openrts.h": "openrts",
    "openrt/openrts.hpp": "openrts-cpp",
    "xvrml/xscript.h": "xscript"
}


def lacking():
    missing = [] if shutil.which("doxygen") else ["doxygen"]
    for module, package in (("sphinx", "python3-sphinx"), ("myst_parser", "python3-myst-parser"),
                            ("furo", "furo")):
        if subprocess.run([sys.executable, "-c", f"import {module}"],
                          capture_output=True).returncode:
            missing.append(package)
    return missing


def title_of(page):
    found = re.search(r"^# (.+)$", page.read_text(encoding="utf-8"), re.M)
    return re.sub(r"^\d+\. ", "", found.group(1)) if found else page.stem


class Site:

    def __init__(self, root, build, out):
        self.root, self.build, self.out = root, build, out
        self.source = out.parent / "docs-source"

    def site_text(self, text, page):
        """Converts a page of docs/ for Sphinx: names of other pages become links, names of files
        become captions of their blocks."""
        out = []
        for piece in re.split(r"(^```.*?^```\n)", text, flags=re.M | re.S):
            if piece.startswith("```"):
                piece = re.sub(r"\A```(\w+) file=(\S+)\n", self.named_block, piece)
            else:
                piece = re.sub(r"\[([^\]\n]*)\]\((\.\./[^)\n]+)\)", lambda m: self.outside(m, page),
                               piece)
                piece = re.sub(r"(?<!\[)`([^`\n]+)`(?!\])", lambda m: self.linked(m, page), piece)
                piece = piece.replace("](docs/", "](")
            out.append(piece)
        return "".join(out)

    def named_block(self, match):
        language = "node" if match.group(2).endswith(".node") else match.group(1)
        return f"```{{code-block}} {language}\n:caption: {match.group(2)}\n\n"

    def outside(self, match, page):
        """Converts a link upwards: a page of docs/ stays a link, a file beside docs/ becomes plain
        text."""
        target = pathlib.Path(
            os.path.normpath(self.root / "docs" / page.parent / match.group(2).split("#")[0]))
        if target.is_relative_to(self.root / "docs"):
            return match.group(0)
        if target.name in ("README.md", "HACKING.md",
                           "CHANGELOG.md") and target.parent == self.root:
            return f"[{match.group(1)}]({'../' * (len(page.parts) - 1)}{target.name.lower()})"
        return match.group(1)

    def linked(self, match, page):
        """Converts `docs/x.md` to a link with the title of that page, and a public header to a link
        to its reference."""
        name = match.group(1)
        up = "../" * (len(page.parts) - 1)
        if re.fullmatch(r"(docs/)?[\w/.-]+\.md", name):
            inner = name[5:] if name.startswith("docs/") else name
            target = self.root / "docs" / inner
            if name in ("README.md", "HACKING.md", "CHANGELOG.md"):
                return f"[{name}]({up}{name.lower()})"
            if (name.startswith(
                ("docs/", "decisions/")) or len(page.parts) == 1) and target.exists():
                return f"[{title_of(target)}]({up}{inner})"
        for header, reference in HEADERS.items():
            if name == header or name.endswith("include/" + header):
                return f"[`{header}`]({up}reference/{reference}.rst)"
        return match.group(0)

    def put(self, name, text):
        path = self.source / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def copy_pages(self):
        docs = self.root / "docs"
        for page in sorted(docs.rglob("*.md")):
            relative = page.relative_to(docs)
            if relative.name != "index.md":
                self.put(relative, self.site_text(page.read_text(encoding="utf-8"), relative))
        for name in ("README.md", "HACKING.md", "CHANGELOG.md"):
            text = (self.root / name).read_text(encoding="utf-8")
            if name == "README.md":
                text = re.sub(r"\A# .*\n", "# Getting started\n", text)
            self.put(name.lower(), self.site_text(text, pathlib.Path(name)))
        sys.path.insert(0, str(self.root / "tests/checks"))
        import blocks
        with (self.source / "documentation.md").open("a", encoding="utf-8") as file:
            file.write("\n## Blocks of each page\n\n" + blocks.table(self.root) + "\n")
        decisions = sorted((docs / "decisions").glob("[0-9]*.md"))
        listed = "\n\n```{toctree}\n:maxdepth: 1\n\n" + "\n".join(
            p.stem for p in decisions) + "\n```\n"
        with (self.source / "decisions/README.md").open("a", encoding="utf-8") as file:
            file.write(listed)
        for picture in [*docs.glob("images/*")]:
            (self.source / "images").mkdir(exist_ok=True)
            shutil.copy(picture, self.source / "images")
        self.put("index.md", self.present((docs / "index.md").read_text(encoding="utf-8")))
        shutil.copy(docs / "site/conf.py", self.source)
        shutil.copytree(docs / "site/static", self.source / "static")

    def present(self, index):
        """Removes entries of the contents whose pages this build lacks."""

        def entry(match):
            name = match.group(0)
            return name if any(
                (self.source / (name + end)).exists() for end in (".md", ".rst")) else None

        def contents(match):
            lines = [
                line for line in match.group(0).split("\n")
                if not re.fullmatch(r"[a-z][\w/-]*", line) or entry(re.match(".*", line))
            ]
            return "\n".join(lines)

        return re.sub(r"```\{toctree\}.*?```", contents, index, flags=re.S)

    def generate(self):
        sys.path.insert(0, str(HERE))
        sys.path.insert(0, str(self.build / "python"))
        sys.dont_write_bytecode = True
        import api_pages
        import options_page
        import python_page
        api_pages.write_pages(self.root, self.source / "reference",
                              self.out.parent / "docs-doxygen")
        self.put("reference/vv.rst", options_page.vv_page(self.build / "bin/vv"))
        self.put(
            "reference/programs.md",
            options_page.programs_page(
                [p for n in PROGRAMS if (p := self.build / "bin" / n).exists()]))
        nodes = next(self.build.rglob("generated/nodes.md"))
        self.put("reference/nodes.md", self.node_page(nodes.read_text(encoding="utf-8")))
        shaders = subprocess.run(
            [sys.executable, self.root / "tools/make_shader_classes.py", self.build / "bin/vv"],
            check=True,
            capture_output=True,
            text=True).stdout
        self.put("shader-classes.md", self.site_text(shaders, pathlib.Path("shader-classes.md")))
        package = self.build / "python/xvrml"
        if package.is_dir():
            self.put("reference/python.rst", python_page.page(package))

    def node_page(self, text):
        return re.sub(r"\A# .*", "# Nodes", text)

    def run(self, strict):
        for folder in (self.source, self.out.parent / "docs-doxygen"):
            shutil.rmtree(folder, ignore_errors=True)
        self.source.mkdir(parents=True)
        self.generate()
        self.copy_pages()
        version = ".".join(
            re.findall(r"OPENRT_VERSION_\w+ (\d+)",
                       (self.root / "libopenrt/include/openrt/context.h").read_text())[:3])
        env = {
            **os.environ, "OPENRT_DOCS_TOOLS": str(HERE),
            "OPENRT_VERSION": version,
            "PYTHONDONTWRITEBYTECODE": "1"
        }
        options = ["-W", "--keep-going"] if strict else []
        command = [
            sys.executable, "-m", "sphinx", "-q", "-E", "-j", "2", "-b", "html", *options, "-d",
            self.out.parent / "docs-doctrees", self.source, self.out
        ]
        return subprocess.run([str(c) for c in command], env=env).returncode


def main():
    arguments = [a for a in sys.argv[1:] if not a.startswith("--")]
    root, build, out = (pathlib.Path(a).resolve() for a in arguments)
    if missing := lacking():
        print("make_docs: these packages are missing:", *missing,
              "(tools/install-packages.sh docs)")
        return 77
    status = Site(root, build, out).run("--strict" in sys.argv)
    if "--check" in sys.argv:
        import check_site
        status = check_site.main(out) or status
    return status


if __name__ == "__main__":
    sys.exit(main())
