#!/usr/bin/env python3
"""Writes the reference of shader classes from the texts in their plug-ins.

make_shader_classes.py VV > docs/shader-classes.md

VV: the program vv of a build. --check PAGE writes nothing: it checks that the page agrees with the
plug-ins, and names the classes that the page lacks.
"""
import json
import os
import subprocess
import sys

HEAD = """# Shader classes

What `rtNewShaderClass`, `ORTShader` and `vv --shader` find, with all parameters. Written by `tools/make_shader_classes.py` from what the
plug-ins say of themselves; `vv --list-shaders` prints the same. How they work is in `docs/shaders.md`.
"""
KINDS = ["surface", "light", "camera", "environment", "transport"]


def number(x):
    return f"{x:.6g}"


def value(x):
    return " ".join(map(number, x)) if isinstance(
        x, list) else number(x) if isinstance(x, (int, float)) else ""


def row(p):
    default = p.get("default")
    if p["type"] == "matrix":
        default = None
    low, high = p.get("minimum", 0), p.get("maximum", 0)
    span = "" if low == high else f"{number(low)} .." if high > 1e37 else f"{number(low)} .. {number(high)}"
    kind = p["type"] + ("" if p.get("per", "shader") == "shader" else ", per " + p["per"])
    return f"| `{p['name']}` | {kind} | {value(default)} | {span} | {p['text']} |"


def section(c):
    lines = [f"### {c['name']}", "", f"Plug-in `{c['library']}`: {c['text']}.", ""]
    if c["parameters"]:
        lines += [
            "| parameter | type | default | range | meaning |", "| --- | --- | --- | --- | --- |"
        ] + [row(p) for p in c["parameters"]] + [""]
    return "\n".join(lines)


vv = sys.argv[1]
env = {k: v for k, v in os.environ.items() if k != "OPENRT_SHADER_PATH"}
classes = json.loads(
    subprocess.run([vv, "--list-shaders", "--json"],
                   env=env,
                   capture_output=True,
                   text=True,
                   check=True).stdout)["shaders"]
classes.sort(key=lambda c: (KINDS.index(c["kind"]), c["name"]))
if sys.argv[2:3] != ["--check"]:
    text = HEAD
    for kind in KINDS:
        some = [section(c) for c in classes if c["kind"] == kind]
        if some:
            text += "\n## " + {
                "surface": "Surfaces",
                "light": "Lights",
                "camera": "Cameras",
                "environment": "Environments",
                "transport": "Transports"
            }[kind] + "\n\n" + "\n".join(some)
    print(text.rstrip())
    sys.exit(0)

page = open(sys.argv[3], encoding="utf-8").read()
names = [c["name"] for c in classes]
listed = [line[4:].strip() for line in page.splitlines() if line.startswith("### ")]
wrong = [name for name in listed if name not in names]
wrong += [c["name"] for c in classes if c["name"] in listed and section(c).rstrip() not in page]
lacking = [name for name in names if name not in listed]
if lacking:
    print("not on the page yet:", *lacking)
if wrong or not listed:
    sys.exit(
        f"{sys.argv[3]} is out of date ({', '.join(wrong)}): tools/make_shader_classes.py {vv} > docs/shader-classes.md"
    )
