#!/usr/bin/env python3
"""Checks the code blocks of a document as blocks.py says: run_blocks.py ROOT BUILD CC CXX INCLUDES
PAGE

* BUILD: programs, libraries and the Python package of a build.
* INCLUDES: its folder of generated headers.
* PAGE: relative to ROOT, or `--marks`: only checks, for all pages, that every block is checked or
  says why not.

Exit code 77: everything was skipped (no Python package). With `--times` after the page the commands
of vv run as they stand, with full-size pictures, and their seconds are printed."""
import ast
import contextlib
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

import blocks

TIMEOUT = 500
SERVER = """
import json, sys, traceback
space = {"__name__": "__main__"}
answers, sys.stdout = sys.stdout, sys.stderr
for line in sys.stdin:
    text, name = json.loads(line)
    try:
        exec(compile(text, name, "exec"), space)
        said = ""
    except SystemExit as end:
        said = "" if not end.code else f"exit {end.code}"
    except BaseException:
        said = traceback.format_exc()
    print(json.dumps(said), file=answers, flush=True)
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return str(probe.getsockname()[1])


class Runner:

    def __init__(self, root, build, cc, cxx, includes, scratch):
        self.root, self.build, self.cc, self.cxx, self.scratch = root, build, cc, cxx, scratch
        self.includes = [
            f"-I{root}/libopenrt/include", f"-I{root}/libxvrml/include", f"-I{includes}"
        ]
        self.python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
        self.env = dict(os.environ,
                        PATH=f"{build}/bin:{root}/tools:" + os.environ["PATH"],
                        PYTHONPATH=f"{build}/python",
                        PYTHONDONTWRITEBYTECODE="1",
                        NO_COLOR="1")
        self.interpreter = None
        self.place = scratch  # the current folder of the page's shell
        self.times = None  # a file: commands run unchanged, and their seconds are written to it
        # The pages' workers listen on free ports.
        self.ports = {"7447": free_port(), "7448": free_port()}
        self.has_worker = (build / "bin/openrt-worker").exists()
        self.has_python = not self.call([self.python, "-c", "import xvrml"], scratch)
        shutil.copytree(root / "examples", scratch / "examples")

    def call(self, command, folder):
        """Runs a command. Returns its output if it fails, otherwise "". Processes that it leaves
        running are ended."""
        # Not a pipe: a worker in the background would hold it open.
        with tempfile.TemporaryFile() as talk:
            done = subprocess.Popen([str(c) for c in command],
                                    cwd=folder,
                                    env=self.env,
                                    stdin=subprocess.DEVNULL,
                                    stdout=talk,
                                    stderr=talk,
                                    start_new_session=True)
            try:
                code = done.wait(TIMEOUT)
            except subprocess.TimeoutExpired:
                code = f"none after {TIMEOUT} s"
            with contextlib.suppress(ProcessLookupError):
                os.killpg(done.pid, signal.SIGKILL)
            done.wait()
            talk.seek(0)
            return f"exit code {code}\n{talk.read().decode('utf-8', 'replace')[-4000:]}" if code else ""

    def timed(self, line):
        """Returns the line. If it calls vv, commands that write its seconds to the file of times
        are added."""
        if not line.startswith("vv "):
            return line
        command = line.partition(" #")[0].strip()
        now = "${EPOCHREALTIME/[.,]/}"  # microseconds
        return f"start={now}\n{line}\necho $(({now} - start)) {shlex.quote(command)} >>{self.times}"

    def sh(self, block, folder):
        text = blocks.shell(block.text, self.timed) if self.times else blocks.shell(block.text)
        if not text:
            return "left"
        if "openrt-worker" in text and not self.has_worker:
            return None
        text = re.sub(r"\b744[78]\b", lambda port: self.ports[port.group()], text)
        if "syntax only" in block.marks:
            return self.call(["bash", "-nc", text], folder)
        # A reader pastes all blocks of a page into one shell, so each starts where the one before
        # has ended.
        start = folder if "in" in block.marks else self.place
        place = self.scratch.parent / (self.scratch.name + ".place")
        wrong = self.call(["bash", "-euo", "pipefail", "-c", f"trap 'pwd >{place}' EXIT\n{text}"],
                          start)
        if "in" not in block.marks and place.exists():
            self.place = pathlib.Path(place.read_text().rstrip("\n"))
        place.unlink(missing_ok=True)
        return wrong

    def run_python(self, block, folder):
        if "syntax only" in block.marks:
            ast.parse(block.text)
            return ""
        if not self.has_python:
            return None
        if not self.interpreter:
            self.interpreter = subprocess.Popen([self.python, "-c", SERVER],
                                                cwd=folder,
                                                env=self.env,
                                                stdin=subprocess.PIPE,
                                                stdout=subprocess.PIPE,
                                                stderr=sys.stderr,
                                                text=True)
        text = re.sub(r"\b744[78]\b", lambda port: self.ports[port.group()], block.text)
        print(json.dumps([text, f"{block.page}:{block.line}"]),
              file=self.interpreter.stdin,
              flush=True)
        answer = self.interpreter.stdout.readline()
        return json.loads(answer) if answer else "the interpreter ended"

    def compiled(self, block, folder):
        text, cpp = block.text, block.language == "cpp"
        if "inside" in block.marks:
            head = [line for line in text.split("\n") if line.startswith("#")]
            body = [line for line in text.split("\n") if not line.startswith("#")]
            text = "\n".join([*head, block.marks["inside"] + " {", *body, "}"])
        source = folder / f"block{block.line}.{block.language}"
        source.write_text(text)
        flags = [
            "-std=c++20" if cpp else "-std=c99", "-Wall", "-Wextra", "-Wno-unused-function",
            "-Wno-unused-variable", *self.includes
        ]
        compiler = self.cxx if cpp else self.cc
        if "int main" not in text:  # declarations without bodies are allowed here
            return self.call([compiler, *flags, "-fsyntax-only", source], folder)
        libraries = [
            f"-L{self.build}/lib", f"-Wl,-rpath,{self.build}/lib",
            *(["-lxvrml_openrt", "-lxvrml"] if cpp else []), "-lopenrt", "-lm"
        ]
        program = source.with_suffix("")
        return self.call([compiler, *flags, "-Werror", source, "-o", program, *libraries],
                         folder) or self.call([program], folder) or self.black(folder)

    def black(self, folder):
        """Returns which picture that a program has written is black."""
        for picture in folder.glob("*.ppm"):
            content = picture.read_bytes()
            if max(content[content.index(b"255\n") + 4:]) < 64:
                return f"{picture.name} is black"
        return ""

    def vrml(self, block, folder):
        world = folder / f"block{block.line}.wrl"
        text = block.text if block.text.startswith(
            "#VRML") else f"#VRML V2.0 utf8\n{block.marks.get('with', '')}\n{block.text}"
        world.write_text(text)
        return self.call(["vv", world.name, "--check", "--trust"], folder)

    def compared(self, block):
        source = self.root / block.marks["part of"]
        whole = " ".join(source.read_text(encoding="utf-8").split()) if source.is_file() else ""
        return "" if " ".join(
            block.text.split()) in whole else f"{block.marks['part of']} does not hold it"

    def js(self, block, folder):
        (folder / f"block{block.line}.js").write_text(block.text)
        world = folder / f"block{block.line}.wrl"
        world.write_text(f'#VRML V2.0 utf8\nScript {{ url "block{block.line}.js" }}\n')
        return self.call(["vv", world.name, "--check", "--strict"], folder)

    def tcl(self, block, folder):
        tclsh = shutil.which("tclsh")
        if not tclsh:
            return None
        (folder / "block.tcl").write_text(block.text)
        test = "set f [open block.tcl]; if {![info complete [read $f]]} {puts {not a complete script}; exit 1}"
        (folder / "test.tcl").write_text(test)
        return self.call([tclsh, "test.tcl"], folder)

    def check(self, block):
        """Returns None if something is not installed, "left" if other tests cover it, "" if it is
        correct, otherwise what is wrong."""
        way = block.way
        if way.startswith("wrong: "):
            return way[len("wrong: "):]
        if way in ("unchecked", "followed"):
            return "left"
        if way == "compared":
            return self.compared(block)
        folder = self.scratch / block.marks.get("in", ".")
        if block.file:
            (folder / block.file).parent.mkdir(parents=True, exist_ok=True)
            (folder / block.file).write_text(block.text)
            if block.language == "vrml" and block.file.endswith(".wrl"):
                return self.call(["vv", block.file, "--check", "--trust"], folder)
            return ""
        if block.language in blocks.COMPILED:
            return self.compiled(block, folder)
        return {
            "sh": self.sh,
            "python": self.run_python,
            "vrml": self.vrml,
            "js": self.js,
            "tcl": self.tcl
        }[block.language](block, folder)


def check_marks(root):
    wrong = [
        b for page in blocks.pages(root) for b in blocks.blocks_of(root, page)
        if b.way.startswith("wrong: ")
    ]
    for block in wrong:
        print(f"{block.page}:{block.line}: {block.way[len('wrong: '):]}")
    total = sum(len(blocks.blocks_of(root, page)) for page in blocks.pages(root))
    print(f"{total} blocks, {len(wrong)} of which nothing is known")
    return 1 if wrong or total < 20 else 0


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    if sys.argv[-1] == "--marks":
        return check_marks(root)
    timed = sys.argv[-1] == "--times"
    build, page = pathlib.Path(sys.argv[2]).resolve(), root / sys.argv[6]
    checked = failed = left = absent = 0
    with tempfile.TemporaryDirectory() as scratch:
        runner = Runner(root, build, sys.argv[3], sys.argv[4], sys.argv[5], pathlib.Path(scratch))
        runner.times = pathlib.Path(scratch) / "times" if timed else None
        for block in blocks.blocks_of(root, page):
            wrong = runner.check(block)
            if wrong is None or wrong == "left":
                left += 1
                absent += wrong is None
                continue
            checked += 1
            if wrong:
                failed += 1
                print(
                    f"--- {block.page}:{block.line}: this {block.language} block fails: {wrong}\n{block.text}"
                )
        if runner.interpreter:
            runner.interpreter.stdin.close()
            runner.interpreter.wait(60)
        if timed and runner.times.exists():
            for line in runner.times.read_text().splitlines():
                seconds, _, command = line.partition(" ")
                print(f"{float(seconds) / 1e6:7.1f} s  {command}")
    print(f"{sys.argv[6]}: {checked} blocks checked, {failed} failed, {left} left to others or out")
    return 1 if failed else 77 if absent and not checked else 0


if __name__ == "__main__":
    sys.exit(main())
