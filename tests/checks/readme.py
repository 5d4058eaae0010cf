#!/usr/bin/env python3
"""Runs the examples of README.md, docs/gallery.md and docs/cluster.md as a reader would: readme.py ROOT BUILD CC

Blocks marked ```sh, ```c and ```python are run in an empty folder with the programs, headers and libraries of BUILD; the C
blocks are compiled as C99. Commands that build or install (make, git, sudo, apt) are the business of other tests and skipped.
The gallery's pictures are made small; workers listen on ports that are free.
"""
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile

root, build, cc = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
env = dict(os.environ, PATH=f"{build}/bin:" + os.environ["PATH"], PYTHONPATH=f"{build}/python")
has_python = (build / "python").is_dir()
ran = failed = 0


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


probe = subprocess.run([build / "bin/vv", "-", "-o", "png:-", "--workers", "127.0.0.1:1"], input=b"#VRML", capture_output=True, timeout=60)
has_worker = (build / "bin/openrt-worker").exists() and b"not built" not in probe.stderr
free = {"7447": free_port(), "7448": free_port()}

with tempfile.TemporaryDirectory() as scratch:
    os.symlink(root / "examples", pathlib.Path(scratch) / "examples")
    gallery = re.sub(r" --(spp|size) \S+", "", (root / "docs/gallery.md").read_text())
    gallery = re.sub(r"^vv .*$", r"\g<0> --size 36x24 --spp 1", gallery, flags=re.M)
    documents = [("README.md", (root / "README.md").read_text()), ("docs/gallery.md", gallery),
                 ("docs/cluster.md", (root / "docs/cluster.md").read_text())]
    blocks = [(name, *block) for name, document in documents
              for block in re.findall(r"^```(sh|c|python)\n(.*?)^```", document, re.M | re.S)]
    for name, kind, text in blocks:
        text = re.sub(r"\b744[78]\b", lambda port: str(free[port.group()]), text)
        if kind == "sh":
            lines = [line for line in text.splitlines() if line and not re.match(r"(make|git|sudo|apt|cd)\b", line)]
            if not lines or ("openrt-worker" in text and not has_worker):
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
        with tempfile.TemporaryFile("w+") as talk:  # no pipe: a worker in the background would hold it open
            block = subprocess.Popen(command, cwd=scratch, env=env, stdin=subprocess.DEVNULL, stdout=talk, stderr=talk, start_new_session=True)
            code = block.wait(300)
            with contextlib.suppress(ProcessLookupError):
                os.killpg(block.pid, signal.SIGKILL)
            if code:
                failed += 1
                talk.seek(0)
                print(f"--- this {kind} block of {name} fails ({code}):\n{text}\n{talk.read()}")
print(f"{ran} blocks run, {failed} failed")
sys.exit(1 if failed or ran == 0 else 0)
