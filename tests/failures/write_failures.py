#!/usr/bin/env python3
"""Makes every write fail once: each program that writes files runs on a disk that is full at the
first, second, third ... write.

write_failures.py BIN LIBRARY [--python FOLDER] [--quick]

BIN is the folder of the programs, LIBRARY the one built from write_failures.c, FOLDER the one of
the Python package. For each kind of output the calls that write are counted first. The program then
runs once for each of them with this call failing (ENOSPC), and once more with all later ones
failing, too. Each time:
* the exit code is the one for files that cannot be written, and a message says so;
* the previous file is unchanged, or whole and new;
* nothing else is left in the folder.

--quick tries the first, the middle and the last call of each kind. Standard output is tested with
/dev/full."""
import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

WORLD = "#VRML V2.0 utf8\nDEF T TimeSensor { cycleInterval 2 } Shape { appearance Appearance { material Material { } } geometry Box { } }\n"
NODE = 'component "Given"\n\nabstract thing "A thing."\n\nGiven : thing {\n  "A node."\n  exposedField SFFloat size 1 # (0,inf)\n    change none "Its size."\n}\n'
OLD = b"what was there before\n"
SMALL = ["--size", "16x12", "--spp", "1", "--threads", "1", "-q"]


def is_png(data):
    return data.startswith(b"\x89PNG\r\n\x1a\n") and data.endswith(b"IEND\xaeB`\x82")


def is_jpeg(data):
    return data.startswith(b"\xff\xd8") and data.endswith(b"\xff\xd9")


def is_json(data):
    try:
        return bool(json.loads(data))
    except ValueError:
        return False


def is_recording(data):
    """Returns whether the data is a header and complete chunks (libopenrt/backend/record/format.h).
    """
    at = 16
    while at < len(data):
        if at + 40 > len(data):
            return False
        at += 40 + struct.unpack_from("<Q", data, at + 24)[0]
    return at == len(data) and len(data) > 16


def of_size(least):
    return lambda data: len(data) >= least and data != OLD


@dataclasses.dataclass
class Case:
    """A command and the files that it writes: by name, a function that tells whether one is
    complete."""
    command: list
    files: dict
    code: int = 1  # exit code if a file cannot be written
    old: bytes = OLD  # what the files hold before
    fresh: bool = False  # the files do not exist before
    recording: bool = False  # the command reads given.ort


PICTURES = """import xvrml
picture = xvrml.load("box.wrl").render(size=(16, 12), spp=1)
picture.save("out.png")
with xvrml.Film("out.gif", fps=10) as film:
    film.add(picture)
    film.add(picture)
"""
EDIT = """import xvrml
world = xvrml.load("out.wrl")
world.edit.set(world["B"], "size", (2, 2, 2))
world.edit.save()
"""
EDITED = b"#VRML V2.0 utf8\nShape { geometry DEF B Box { size 1 2 2 } } # a box\n"
CONTEXT = """import xvrml.rt
with xvrml.rt.Context(1, config="backend=record file=out.ort"):
    pass
"""


def cases(programs, python):
    vv = [str(programs / "vv"), "box.wrl", *SMALL]
    pixels = 16 * 12
    frames = {f"out{i}.png": is_png for i in range(3)}
    result = {
        "png":
            Case(vv + ["-o", "out.png"], {"out.png": is_png}),
        "jpeg":
            Case(vv + ["-o", "out.jpg"], {"out.jpg": is_jpeg}),
        "exr":
            Case(vv + ["-o", "out.exr"], {"out.exr": of_size(300)}),
        "ppm":
            Case(vv + ["-o", "out.ppm"], {"out.ppm": of_size(3 * pixels)}),
        "pfm":
            Case(vv + ["-o", "out.pfm"], {"out.pfm": of_size(12 * pixels)}),
        "hdr":
            Case(vv + ["-o", "out.hdr"], {"out.hdr": of_size(200)}),
        "new":
            Case(vv + ["-o", "out.png"], {"out.png": is_png}, fresh=True),
        "stats":
            Case(vv + ["-o", "out.png", "--stats", "out.json"], {
                "out.png": is_png,
                "out.json": is_json
            }),
        "world":
            Case(vv[:2] + ["--write", "out.wrl"], {"out.wrl": of_size(50)}),
        "export":
            Case(vv[:2] + ["--write", "out.gltf"], {
                "out.gltf": is_json,
                "out.bin": of_size(500)
            }),
        "frames":
            Case(vv + ["--frames", "0-2", "-o", "out{frame}.png", "--stats", "out.json"], {
                **frames, "out.json": is_json
            }),
        "recording":
            Case(vv + ["-o", "out.png", "--record", "out.ort"], {
                "out.png": is_png,
                "out.ort": is_recording
            }),
        "new recording":
            Case(vv + ["-o", "out.png", "--record", "out.ort"], {
                "out.png": is_png,
                "out.ort": is_recording
            },
                 fresh=True),
    }
    replay = [str(programs / "openrt-replay"), "given.ort", "--threads", "1"]
    result["replay"] = Case(replay + ["-o", "out.pfm"], {"out.pfm": of_size(12 * pixels)},
                            recording=True)
    result["export"] = Case(replay + ["--export", "out.json"], {
        "out.json": is_json,
        "out.json.bin": of_size(100)
    },
                            recording=True)
    for kind in ("gif", "mp4", "webm"):
        result["film " + kind] = Case(vv + ["--frames", "0-3", "-o", "out." + kind],
                                      {"out." + kind: of_size(100)})
    if (programs / "openrt-worker").exists():
        key = [str(programs / "openrt-worker"), "--new-key", "out.key"]
        result["key file"] = Case(key, {"out.key": of_size(90)}, code=3, fresh=True)
    nodes = [str(programs / "nodegen"), "given.node", "--reference", "out.md", "--stub", "out.pyi"]
    result["nodegen"] = Case(nodes, {"out.md": of_size(50), "out.pyi": of_size(50)}, code=5)
    if python:
        result["python"] = Case([sys.executable, "-c", PICTURES], {
            "out.png": is_png,
            "out.gif": of_size(100)
        })
        result["python edit"] = Case([sys.executable, "-c", EDIT],
                                     {"out.wrl": lambda data: data == EDITED.replace(b"1 2 2", b"2 2 2")},
                                     old=EDITED)
        result["python recording"] = Case([sys.executable, "-c", CONTEXT], {"out.ort": of_size(16)})
        result["python world"] = Case(
            [sys.executable, "-c", 'import xvrml\nxvrml.load("box.wrl").save("out.wrl")'],
            {"out.wrl": of_size(50)})
    return result


class Sweep:

    def __init__(self, programs, library, python, quick):
        self.programs, self.library, self.python, self.quick = programs, library, python, quick
        self.faults = []
        self.runs = 0

    def run(self, folder, command, failing, sticks):
        count = folder.parent / "count"
        count.unlink(missing_ok=True)
        environment = {
            **os.environ, "LD_PRELOAD": str(self.library),
            "WRITE_FAILURE": str(failing),
            "WRITE_FAILURE_COUNT": str(count),
            "WRITE_FAILURE_STICKS": "1" if sticks else "0",
            "PYTHONDONTWRITEBYTECODE": "1"
        }
        if self.python:
            environment["PYTHONPATH"] = str(self.python)
        done = subprocess.run(command,
                              cwd=folder,
                              env=environment,
                              capture_output=True,
                              timeout=120)
        self.runs += 1
        return done, int(count.read_text()) if count.exists() else 0

    def folder(self, parent, case, recording):
        """Makes a new folder with the inputs and an old file for each output."""
        folder = parent / "run"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "box.wrl").write_text(WORLD)
        (folder / "given.node").write_text(NODE)
        if recording:
            (folder / "given.ort").write_bytes(recording)
        given = {p.name for p in folder.iterdir()}
        for name in () if case.fresh else case.files:
            (folder / name).write_bytes(case.old)
        return folder, given

    def told(self, what, done, code):
        text = done.stderr.decode(errors="replace").strip()
        if done.returncode != code:
            self.faults.append(
                f"{what}: exit code {done.returncode}, expected {code}: {text[-200:]}")
        elif not any(word in text for word in ("cannot write", "cannot be", "No space", "failed")):
            self.faults.append(
                f"{what}: no message says that it could not be written: {text[-200:]!r}")

    def check(self, what, folder, given, case, done):
        self.told(what, done, case.code)
        for name, whole in case.files.items():
            data = (folder / name).read_bytes() if (folder / name).exists() else None
            if data is None:
                if not case.fresh:
                    self.faults.append(f"{what}: {name}, which was there before, has gone")
            elif data != case.old and not whole(data):
                self.faults.append(f"{what}: {name} is damaged ({len(data)} bytes)")
        left = sorted({p.name for p in folder.iterdir()} - set(case.files) - given)
        if left:
            self.faults.append(f"{what}: left behind: {', '.join(left)}")

    def kind(self, parent, name, case, recording):
        folder, given = self.folder(parent, case, recording)
        done, calls = self.run(folder, case.command, 0, False)
        text = done.stderr.decode(errors="replace")[-300:]
        if name.startswith("film") and done.returncode == 2 and "ffmpeg" in text:
            print(f"{name}: not built in", flush=True)
            return
        wrong = [
            file for file, whole in case.files.items()
            if not (folder / file).exists() or not whole((folder / file).read_bytes())
        ]
        if done.returncode != 0 or wrong or calls == 0:
            self.faults.append(
                f"{name}: without any failure: exit code {done.returncode}, {calls} calls, wrong: {wrong}: {text}"
            )
            return
        numbers = range(1, calls + 1)
        if self.quick:
            numbers = sorted({1, (calls + 1) // 2, calls})
        for number in numbers:
            for sticks in (False, True):
                folder, given = self.folder(parent, case, recording)
                done, seen = self.run(folder, case.command, number, sticks)
                what = f"{name}, call {number} of {calls}{' and all after it' if sticks else ''}"
                if seen < number:
                    self.faults.append(f"{what}: did not happen")
                else:
                    self.check(what, folder, given, case, done)
        print(f"{name}: {calls} calls that write", flush=True)

    def printed(self, parent, recording):
        """Runs the command with a full disk as standard output."""
        folder, _ = self.folder(parent, Case([], {}), recording)
        vv = [str(self.programs / "vv")]
        small = vv + ["box.wrl", *SMALL]
        commands = [
            vv + [option] for option in ("--help", "--version", "--list-nodes", "--list-shaders",
                                         "--list-engines")
        ]
        commands += [
            small[:2] + ["--info"], small[:2] + ["--write", "-"], small + ["--explain"],
            small + ["-o", "-"], small + ["-o", "out.png", "--stats", "-"]
        ]
        for program in ("openrt-replay", "openrt-worker"):
            if (self.programs / program).exists():
                commands.append([str(self.programs / program), "--help"])
        commands.append(
            [str(self.programs / "openrt-replay"), "given.ort", "--threads", "1", "--stats"])
        if (self.programs / "openrt-worker").exists():
            commands.append([str(self.programs / "openrt-worker"), "--new-key", "out.key"])
        commands.append([str(self.programs / "nodegen"), "--help"])
        for command in commands:
            with open("/dev/full", "wb") as full:
                done = subprocess.run(command,
                                      cwd=folder,
                                      stdout=full,
                                      stderr=subprocess.PIPE,
                                      timeout=120)
            self.runs += 1
            name = pathlib.Path(command[0]).name
            self.told(f"{name} {' '.join(command[1:])} > /dev/full", done,
                      5 if name == "nodegen" else 1)
        print(f"standard output: {len(commands)} commands", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--python",
                        type=pathlib.Path,
                        help="the folder of the Python package; left out: not tried")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", help="kinds whose name contains this")
    arguments = parser.parse_args()
    programs = arguments.bin.resolve()
    python = arguments.python and arguments.python.resolve()
    sweep = Sweep(programs, arguments.library.resolve(), python, arguments.quick)
    with tempfile.TemporaryDirectory() as temporary:
        parent = pathlib.Path(temporary)
        folder, _ = sweep.folder(parent, Case([], {}), None)
        command = [
            str(programs / "vv"), "box.wrl", *SMALL, "-o", "out.png", "--record", "given.ort"
        ]
        subprocess.run(command, cwd=folder, check=True, timeout=120)
        recording = (folder / "given.ort").read_bytes()
        for name, case in cases(programs, python).items():
            if arguments.only is None or arguments.only in name:
                sweep.kind(parent, name, case, recording if case.recording else None)
        if arguments.only is None or arguments.only in "standard output":
            sweep.printed(parent, recording)
    for fault in sweep.faults:
        print("fault:", fault)
    print(f"{sweep.runs} runs, {len(sweep.faults)} faults")
    return 1 if sweep.faults else 0


if __name__ == "__main__":
    sys.exit(main())
