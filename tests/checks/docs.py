#!/usr/bin/env python3
"""What the documents name must be there: docs.py ROOT

Checks paths of the repository in back quotes (globs and {a,b} too), relative links, `make` targets and presets.
"""
import itertools
import json
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
TOPS = {p.name for p in root.iterdir() if p.is_dir() and not p.name.startswith(".")} - {"build"}
targets = set(re.findall(r"^([a-z-]+):", (root / "Makefile").read_text(), re.M))
presets = {p["name"] for p in json.loads((root / "CMakePresets.json").read_text())["configurePresets"]}


def braces(text):
    """a{b,c}d -> abd, acd."""
    pieces = re.split(r"\{([^}]*)\}", text)
    choices = [piece.split(",") if i % 2 else [piece] for i, piece in enumerate(pieces)]
    return ["".join(choice) for choice in itertools.product(*choices)]


def missing(document, text):
    for code in re.findall(r"`([^`\n]+)`", text):
        for word in code.split():
            word = word.strip("(),;:")
            if word.split("/")[0] in TOPS and "/" in word and re.fullmatch(r"[\w./{},*-]+", word) and "NAME" not in word and "NNNN" not in word:
                yield from (f"no {path}" for path in braces(word.rstrip("/")) if not any(root.glob(path + "*")) and not any(root.glob(path)))
            elif word.startswith("decisions/") and "NNNN" not in word and not (root / "docs" / word).exists():
                yield f"no docs/{word}"
        for target in re.findall(r"^make ([a-z]+)", code):
            if target not in targets:
                yield f"no make target {target}"
        for preset in re.findall(r"--preset ([a-z-]+)", code):
            if preset not in presets:
                yield f"no preset {preset}"
    for link in re.findall(r"\]\(([^)#:]+)\)", text):
        if not (document.parent / link).exists():
            yield f"no {link}"


failed = 0
for document in sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")]):
    for what in missing(document, document.read_text(encoding="utf-8")):
        failed += 1
        print(f"{document.relative_to(root)}: {what}")
sys.exit(1 if failed else 0)
