#!/usr/bin/env python3
"""Checks that everything the documents refer to exists: docs.py ROOT

Checks paths of the repository in back quotes (also globs and {a,b}), relative links and their
anchors, `make` targets and presets, and that docs/index.md lists every page of docs/."""
import itertools
import json
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
TOPS = {p.name for p in root.iterdir() if p.is_dir() and not p.name.startswith(".")} - {"build"}
targets = set(re.findall(r"^([a-z0-9-]+):", (root / "Makefile").read_text(), re.M))
presets = {
    p["name"] for p in json.loads((root / "CMakePresets.json").read_text())["configurePresets"]
}


def braces(text):
    """Expands a{b,c}d to abd and acd."""
    pieces = re.split(r"\{([^}]*)\}", text)
    choices = [piece.split(",") if i % 2 else [piece] for i, piece in enumerate(pieces)]
    return ["".join(choice) for choice in itertools.product(*choices)]


def missing(document, text):
    for code in re.findall(r"`([^`\n]+)`", text):
        for word in code.split():
            word = word.strip("(),;:")
            if word.split("/")[0] in TOPS and "/" in word and re.fullmatch(
                    r"[\w./{},*-]+", word) and "NAME" not in word and "NNNN" not in word:
                yield from (f"no {path}" for path in braces(word.rstrip("/"))
                            if not any(root.glob(path + "*")) and not any(root.glob(path)))
            elif word.startswith("decisions/") and "NNNN" not in word and not (root / "docs" /
                                                                               word).exists():
                yield f"no docs/{word}"
        for target in re.findall(r"^make ([a-z][a-z0-9-]*)", code):
            if target not in targets:
                yield f"no make target {target}"
        for preset in re.findall(r"cmake --preset ([a-z-]+)", code):
            if preset not in presets:
                yield f"no preset {preset}"
    for link, anchor in re.findall(r"\]\(([^)#:\s]*)(#[^)\s]+)?\)", text):
        target = document.parent / link if link else document
        if not target.exists():
            yield f"no {link}"
        elif anchor and target.suffix == ".md" and anchor[1:] not in anchors(target):
            yield f"no such heading: {link}{anchor}"


def anchors(document):
    """Returns the anchors of the headings, as GitHub and MyST make them."""
    text = re.sub(r"^```.*?^```", "", document.read_text(encoding="utf-8"), flags=re.M | re.S)
    found, seen = set(), {}
    for title in re.findall(r"^#+ (.+?)\s*$", text, re.M):
        slug = re.sub(r"[^\w\- ]", "",
                      re.sub(r"[`*]|\]\([^)]*\)", "", title).lower()).replace(" ", "-")
        found.add(slug if slug not in seen else f"{slug}-{seen[slug]}")
        seen[slug] = seen.get(slug, 0) + 1
    return found


# Pages that are generated or not written yet
COMING = re.compile(r"reference/.*|readme|hacking|changelog|python|ray-queries|cluster|protocol")


def contents():
    """Yields pages missing from the contents of the site, and entries without a page."""
    index = (root / "docs/index.md").read_text(encoding="utf-8")
    listed = {
        line for toc in re.findall(r"```\{toctree\}\n(.*?)```", index, re.S)
        for line in toc.split("\n") if re.fullmatch(r"[\w/-]+", line)
    }
    there = {
        p.relative_to(root / "docs").with_suffix("").as_posix()
        for p in (root / "docs").rglob("*.md")
    }
    there = {p for p in there if not re.match(r"decisions/\d|index$", p)}
    yield from (f"the contents lack {page}" for page in sorted(there - listed))
    yield from (f"no page {page}" for page in sorted(listed - there) if not COMING.fullmatch(page))


failed = 0
for what in contents():
    failed += 1
    print(f"docs/index.md: {what}")
for document in sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")]):
    for what in missing(document, document.read_text(encoding="utf-8")):
        failed += 1
        print(f"{document.relative_to(root)}: {what}")
sys.exit(1 if failed else 0)
