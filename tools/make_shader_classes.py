#!/usr/bin/env python3
"""Writes the reference of shader classes from the texts in their plug-ins.

make_shader_classes.py VV > docs/shader-classes.md
make_shader_classes.py VV --check docs/shader-classes.md

VV: the program vv of a build. --check prints the differences between the page and the plug-ins, and
fails if there are any.
"""
import difflib
import json
import os
import subprocess
import sys
import textwrap

HEAD = """# Shader classes

These are the classes that `rtNewShaderClass`, `ORTShader` and `vv --shader` find, with all
parameters. `tools/make_shader_classes.py` writes this page from what the plug-ins say of
themselves; `vv --list-shaders` prints the same. How they work is in `docs/shaders.md`.
"""
TITLES = {
    "surface": "Surfaces",
    "light": "Lights",
    "camera": "Cameras",
    "environment": "Environments",
    "transport": "Transports"
}


def number(x):
    return f"{x:.6g}"


def value(x):
    return " ".join(map(number, x)) if isinstance(
        x, list) else number(x) if isinstance(x, (int, float)) else ""


def row(p):
    default = p.get("default")
    if p["type"] == "matrix":
        default = None
    low, high = p.get("minimum"), p.get("maximum")  # None: no bound
    ends = [number(end) if end is not None and abs(end) < 1e37 else "" for end in (low, high)]
    span = "" if low == high or ends == ["", ""] else " .. ".join(ends).strip()
    kind = p["type"] + ("" if p.get("per", "shader") == "shader" else ", per " + p["per"])
    return f"| `{p['name']}` | {kind} | {value(default)} | {span} | {p['text']} |"


def section(c):
    intro = textwrap.fill(f"Plug-in `{c['library']}`: {c['text']}.",
                          100,
                          break_long_words=False,
                          break_on_hyphens=False)
    lines = [f"### {c['name']}", "", intro, ""]
    if c["parameters"]:
        lines += [
            "| parameter | type | default | range | meaning |", "| --- | --- | --- | --- | --- |"
        ] + [row(p) for p in c["parameters"]] + [""]
    return "\n".join(lines)


def page(classes):
    text = HEAD
    for kind, title in TITLES.items():
        some = [section(c) for c in classes if c["kind"] == kind]
        if some:
            text += f"\n## {title}\n\n" + "\n".join(some)
    return text.rstrip() + "\n"


def read_classes(vv):
    env = {k: v for k, v in os.environ.items() if k != "OPENRT_SHADER_PATH"}
    done = subprocess.run([vv, "--list-shaders", "--json"],
                          env=env,
                          capture_output=True,
                          text=True,
                          check=True)
    return sorted(json.loads(done.stdout)["shaders"], key=lambda c: c["name"])


def main():
    vv = sys.argv[1]
    text = page(read_classes(vv))
    if sys.argv[2:3] != ["--check"]:
        sys.stdout.write(text)
        return 0
    path = sys.argv[3]
    with open(path, encoding="utf-8") as file:
        there = file.read()
    if there == text:
        return 0
    sys.stdout.writelines(
        difflib.unified_diff(there.splitlines(True), text.splitlines(True), path, "the plug-ins"))
    print(f"{path} is out of date: tools/make_shader_classes.py {vv} > docs/shader-classes.md")
    return 1


if __name__ == "__main__":
    sys.exit(main())
