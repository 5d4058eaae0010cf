#!/usr/bin/env python3
"""Runs the examples of README.md and docs/gallery.md as a reader would: readme.py ROOT BUILD CC

Blocks marked ```sh, ```c and ```python are run in an empty folder with the programs, headers and libraries of BUILD; the C
blocks are compiled as C99. Commands that build or install (make, git, sudo, apt) are the business of other tests and skipped.
The gallery's pictures are made small.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

root, build, cc = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
env = dict(os.environ, PATH=f"{build}/bin:" + os.environ["PATH"], PYTHONPATH=f"{build}/python")
has_python = (build / "python").is_dir()
ran = failed = 0

with tempfile.TemporaryDirectory() as scratch:
    os.symlink(root / "examples", pathlib.Path(scratch) / "examples")
    gallery = re.sub(r" --(spp|size) \S+", "", (root / "docs/gallery.md").read_text())
    gallery = re.sub(r"^vv .*$", r"\g<0> --size 36x24 --spp 1", gallery, flags=re.M)
    blocks = [(name, *block) for name, document in (("README.md", (root / "README.md").read_text()), ("docs/gallery.md", gallery))
              for block in re.findall(r"^```(sh|c|python)\n(.*?)^```", document, re.M | re.S)]
    for name, kind, text in blocks:
        if kind == "sh":
            lines = [line for line in text.splitlines() if line and not re.match(r"(make|git|sudo|apt|cd)\b", line)]
            if not lines:
                continue
            command = ["bash", "-euc", "\n".join(lines)]
        elif kind == "c":
            source = pathlib.Path(scratch) / "example.c"
            source.write_text(text)
            command = ["bash", "-euc", f'"{cc}" -std=c99 -Wall -Wextra -Werror -I"{root}/libopenrt/include" example.c -o example '
                                       f'-L"{build}/lib" -lopenrt -Wl,-rpath,"{build}/lib" && ./example']
        else:
            if not has_python:
                continue
            command = [python, "-c", text]
        ran += 1
        done = subprocess.run(command, cwd=scratch, env=env, capture_output=True, text=True, timeout=300)
        if done.returncode:
            failed += 1
            print(f"--- this {kind} block of {name} fails ({done.returncode}):\n{text}\n{done.stdout}{done.stderr}")
print(f"{ran} blocks run, {failed} failed")
sys.exit(1 if failed or ran == 0 else 0)
