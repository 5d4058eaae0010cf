#!/usr/bin/env python3
"""Checks that docs/from-opengl.md and the headers of OpenGL's names agree: gl_names.py ROOT

The table names each function of openrt/gl_functions.h once, and calls those absent that
libopenrt/gl/refused_calls.cpp refuses. openrt/gl_names.h names each with both prefixes."""
import collections
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
headers = root / "libopenrt/include/openrt"
declared = set(re.findall(r"\brtgl([A-Z]\w*)\(", (headers / "gl_functions.h").read_text()))
source = (root / "libopenrt/gl/refused_calls.cpp").read_text()
refused = set(re.findall(r"^REFUSE\((\w+),|^GL\w+ rtgl(\w+)\(", source, re.M))
refused = {a or b for a, b in refused}
names = (headers / "gl_names.h").read_text()
complaints = [f"OpenGL 1.1 has 336 functions, gl_functions.h {len(declared)}"
             ] if len(declared) != 336 else []
for prefix in ("gl", "rt"):
    named = set(re.findall(rf"^#define {prefix}([A-Z]\w*) rtgl\1$", names, re.M))
    complaints += [f"gl_names.h: {prefix}{name}" for name in sorted(named ^ declared)]

listed = collections.Counter()
page = (root / "docs/from-opengl.md").read_text(encoding="utf-8")
for cells, word in re.findall(r"^\| ((?:`gl[A-Z]\w*` ?)+)\| (same|other|absent) \|", page, re.M):
    for name in re.findall(r"`gl(\w+)`", cells):
        listed[name] += 1
        if (word == "absent") != (name in refused):
            complaints.append(f"docs/from-opengl.md: gl{name} is not {word}")
complaints += [f"docs/from-opengl.md lacks gl{name}" for name in sorted(declared - set(listed))]
complaints += [f"docs/from-opengl.md: gl{name} is no function" for name in set(listed) - declared]
complaints += [f"docs/from-opengl.md has gl{name} twice" for name, n in listed.items() if n > 1]
print(*complaints, f"{len(declared)} functions, {len(complaints)} complaints", sep="\n")
sys.exit(1 if complaints else 0)
