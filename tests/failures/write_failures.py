#!/usr/bin/env python3
"""Every write fails once: each program that writes files, on a disk that is full at the first, second, third ... write.

write_failures.py BIN LIBRARY [--quick]

BIN is the folder of the programs, LIBRARY the one that write_failures.c makes. For each kind of output the calls that write are
counted first. Then the program runs once for each of them, with this call failing (ENOSPC), and once more with all later ones
failing, too. What must hold each time: the exit code is 1 and a message says that it could not be written; the file that was
there before is as it was, or whole and new; nothing else is left in the folder. --quick tries three calls of each kind.
"""
import argparse
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

WORLD = "#VRML V2.0 utf8\nDEF T TimeSensor { cycleInterval 2 } Shape { appearance Appearance { material Material { } } geometry Box { } }\n"
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
    """A header and whole chunks (libopenrt/backend/record/format.h)."""
    at = 16
    while at < len(data):
        if at + 40 > len(data):
            return False
        at += 40 + struct.unpack_from("<Q", data, at + 24)[0]
    return at == len(data) and len(data) > 16


def of_size(least):
    return lambda data: len(data) >= least and data != OLD


def cases(programs):
    vv = [str(programs / "vv"), "box.wrl", *SMALL]
    pixels = 16 * 12
    result = {
        "png": (vv + ["-o", "out.png"], {"out.png": is_png}),
        "jpeg": (vv + ["-o", "out.jpg"], {"out.jpg": is_jpeg}),
        "exr": (vv + ["-o", "out.exr"], {"out.exr": of_size(300)}),
        "ppm": (vv + ["-o", "out.ppm"], {"out.ppm": of_size(3 * pixels)}),
        "pfm": (vv + ["-o", "out.pfm"], {"out.pfm": of_size(12 * pixels)}),
        "stats": (vv + ["-o", "out.png", "--stats", "out.json"], {"out.png": is_png, "out.json": is_json}),
        "world": (vv[:2] + ["--write", "out.wrl"], {"out.wrl": of_size(50)}),
        "frames": (vv + ["--frames", "0-2/10", "-o", "out{frame}.png"], {f"out{i}.png": is_png for i in range(3)}),
        "recording": (vv + ["-o", "out.png", "--record", "out.ort"], {"out.png": is_png, "out.ort": is_recording}),
        "recording of frames": (vv + ["--frames", "0-2/10", "-o", "out{frame}.png", "--record", "out.ort"],
                                {**{f"out{i}.png": is_png for i in range(3)}, "out.ort": is_recording}),
    }
    replay = [str(programs / "openrt-replay"), "given.ort", "--threads", "1"]
    result["replay"] = (replay + ["-o", "out.pfm"], {"out.pfm": of_size(12 * pixels)})
    result["export"] = (replay + ["--export", "out.json"], {"out.json": is_json, "out.json.bin": of_size(100)})
    if shutil.which("ffmpeg"):  # its own writes fail: the last suffix says the format
        for suffix in ("gif", "mp4"):
            result["film " + suffix] = (vv + ["--frames", "0-3/10", "-o", "out." + suffix], {"out." + suffix: of_size(100)})
    return result


class Sweep:
    def __init__(self, programs, library, quick):
        self.programs, self.library, self.quick = programs, library, quick
        self.faults = []
        self.runs = 0

    def run(self, folder, command, failing, sticks):
        count = folder.parent / "count"
        count.unlink(missing_ok=True)
        environment = {**os.environ, "LD_PRELOAD": str(self.library), "WRITE_FAILURE": str(failing), "WRITE_FAILURE_COUNT": str(count),
                       "WRITE_FAILURE_STICKS": "1" if sticks else "0", "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, timeout=120)
        self.runs += 1
        return done, int(count.read_text()) if count.exists() else 0

    def folder(self, parent, files, recording):
        """A fresh folder with the inputs, and an old file for each output."""
        folder = parent / "run"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "box.wrl").write_text(WORLD)
        if recording:
            (folder / "given.ort").write_bytes(recording)
        for name in files:
            (folder / name).write_bytes(OLD)
        return folder

    def check(self, what, folder, files, done, given):
        text = done.stderr.decode(errors="replace").strip()
        if done.returncode != 1:
            self.faults.append(f"{what}: exit code {done.returncode}, expected 1: {text[-200:]}")
        elif not any(word in text for word in ("cannot write", "cannot be", "No space", "failed")):
            self.faults.append(f"{what}: no message says that it could not be written: {text[-200:]!r}")
        for name, whole in files.items():
            data = (folder / name).read_bytes() if (folder / name).exists() else None
            if data is None:
                self.faults.append(f"{what}: {name}, which was there before, has gone")
            elif data != OLD and not whole(data):
                self.faults.append(f"{what}: {name} is damaged ({len(data)} bytes)")
        left = sorted({p.name for p in folder.iterdir()} - set(files) - given)
        if left:
            self.faults.append(f"{what}: left behind: {', '.join(left)}")

    def kind(self, parent, name, command, files, recording):
        folder = self.folder(parent, files, recording)
        given = {p.name for p in folder.iterdir()} - set(files)
        done, calls = self.run(folder, command, 0, False)
        wrong = [file for file, whole in files.items() if not whole((folder / file).read_bytes())]
        if done.returncode != 0 or wrong or calls == 0:
            self.faults.append(f"{name}: without any failure: exit code {done.returncode}, {calls} calls, wrong: {wrong}: "
                               f"{done.stderr.decode(errors='replace')[-300:]}")
            return
        numbers = range(1, calls + 1)
        if self.quick:
            numbers = sorted({1, (calls + 1) // 2, calls})
        for number in numbers:
            for sticks in (False, True):
                folder = self.folder(parent, files, recording)
                done, seen = self.run(folder, command, number, sticks)
                if seen < number:
                    self.faults.append(f"{name}: call {number} of {calls} did not happen")
                else:
                    self.check(f"{name}, call {number} of {calls}{' and all after it' if sticks else ''}", folder, files, done, given)
        print(f"{name}: {calls} calls that write", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", help="kinds whose name contains this")
    arguments = parser.parse_args()
    programs = arguments.bin.resolve()
    sweep = Sweep(programs, arguments.library.resolve(), arguments.quick)
    with tempfile.TemporaryDirectory() as temporary:
        parent = pathlib.Path(temporary)
        folder = sweep.folder(parent, [], None)
        command = [str(programs / "vv"), "box.wrl", *SMALL, "-o", "out.png", "--record", "given.ort"]
        subprocess.run(command, cwd=folder, check=True, timeout=120)
        recording = (folder / "given.ort").read_bytes()
        for name, (command, files) in cases(programs).items():
            if arguments.only is None or arguments.only in name:
                sweep.kind(parent, name, command, files, recording if "given.ort" in command else None)
    for fault in sweep.faults:
        print("fault:", fault)
    print(f"{sweep.runs} runs, {len(sweep.faults)} faults")
    return 1 if sweep.faults else 0


if __name__ == "__main__":
    sys.exit(main())
