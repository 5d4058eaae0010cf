"""Shared by the tests of vv and of the Python package: the path of the program, small worlds,
readers of picture files."""
import os
import pathlib
import platform
import shutil
import signal
import struct
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A shell that runs the tests in the background starts them with SIGINT ignored, and nohup with
# SIGHUP ignored. The programs under test would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)


def pytest_configure(config):
    config.addinivalue_line("markers", "timed: measures wall-clock time, so a busy machine can make it fail")


# Previews are filtered in the same way on every machine, unless a test asks for the library.
os.environ["OPENRT_OIDN_LIBRARY"] = "none"

BOX = """#VRML V2.0 utf8
Viewpoint { position 0 0 5 description "front" }
DEF Back Viewpoint { position 0 0 -5 orientation 0 1 0 3.14159265 description "from behind" }
DEF Place Transform {
  children DEF Thing Shape {
    appearance Appearance { material DEF Paint Material { diffuseColor 0.8 0.2 0.1 } }
    geometry DEF Cube Box { size 2 2 2 }
  }
}
"""

# Seconds for things that take a moment on an idle machine. A sanitizer needs many times as long, so
# OPENRT_TEST_PATIENCE is a factor.
PATIENCE = 30 * float(os.environ.get("OPENRT_TEST_PATIENCE", "1"))

HEADER = "#VRML V2.0 utf8\n"
SMALL = ("--size", "32x24", "--spp", "1")
# The instruction set that every machine of this kind has, so that bytes can be compared.
ISA = ("--isa", "sse2") if platform.machine() == "x86_64" else ("--isa", "auto")


def find_vv():
    """Returns $OPENRT_VV, else the program beside the package on PYTHONPATH, else that of the
    release build."""
    if "OPENRT_VV" in os.environ:
        return pathlib.Path(os.environ["OPENRT_VV"])
    for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep):
        if folder and (pathlib.Path(folder).resolve().parent / "bin/vv").exists():
            return pathlib.Path(folder).resolve().parent / "bin/vv"
    return ROOT / "build/release/bin/vv"


class Vv:
    """Runs vv in a folder of its own."""

    def __init__(self, folder):
        self.program = find_vv()
        self.folder = folder

    def __call__(self, *arguments, stdin=b"", env=None, timeout=120):
        done = subprocess.run([self.program, *map(str, arguments)],
                              cwd=self.folder,
                              input=stdin,
                              capture_output=True,
                              timeout=timeout,
                              env={
                                  **os.environ,
                                  **(env or {})
                              })
        done.text = done.stdout.decode(errors="replace")
        done.talk = done.stderr.decode(errors="replace")
        return done

    def write(self, name, content):
        (self.folder /
         name).write_bytes(content if isinstance(content, bytes) else content.encode())

    def picture(self, *arguments, world="box.wrl"):
        """Renders a small picture; returns its rows of (r, g, b) bytes."""
        done = self(world, "-o", "ppm:-", *SMALL, *arguments)
        assert done.returncode == 0, done.talk
        return read_ppm(done.stdout)[2]

    def floats(self, *arguments, world="board.wrl"):
        """Renders a small picture; returns its rows of linear (r, g, b)."""
        done = self(world, "-o", "pfm:-", "--size", "24x16", "--spp", "4", *arguments)
        assert done.returncode == 0, done.talk
        return read_pfm(done.stdout)[2]

    def leftovers(self):
        return [p.name for p in self.folder.iterdir() if p.name.startswith(".vv-")]

    def start(self, *arguments):
        return subprocess.Popen([self.program, *map(str, arguments)],
                                cwd=self.folder,
                                stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)


@pytest.fixture
def vv(tmp_path):
    if not find_vv().exists():
        pytest.skip("vv is not built")
    (tmp_path / "box.wrl").write_text(BOX)
    return Vv(tmp_path)


@pytest.fixture
def box(tmp_path):
    path = tmp_path / "box.wrl"
    path.write_text(BOX)
    return path


def read_pfm(data):
    """Returns width, height and the rows from the top of (r, g, b) tuples."""
    kind, size, scale, pixels = data.split(b"\n", 3)
    assert kind == b"PF" and float(scale) < 0
    width, height = map(int, size.split())
    numbers = struct.unpack(f"<{3 * width * height}f", pixels)
    rows = [[numbers[3 * (y * width + x):3 * (y * width + x) + 3]
             for x in range(width)]
            for y in range(height)]
    return width, height, rows[::-1]


def read_ppm(data):
    kind, size, maximum, pixels = data.split(b"\n", 3)
    assert kind == b"P6" and maximum == b"255"
    width, height = map(int, size.split())
    assert len(pixels) == 3 * width * height
    return width, height, [[
        tuple(pixels[3 * (y * width + x):3 * (y * width + x) + 3]) for x in range(width)
    ] for y in range(height)]


def exr_header(data):
    """Returns the attributes of a single-part OpenEXR file: name -> (type, bytes)."""
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name = data[at:end].decode()
        at = end + 1
        end = data.index(b"\0", at)
        kind = data[at:end].decode()
        size = struct.unpack_from("<i", data, end + 1)[0]
        attributes[name] = (kind, data[end + 5:end + 5 + size])
        at = end + 5 + size
    return attributes


def exr_channels(data):
    """Returns the channel names of an OpenEXR file and their types (2: 32-bit float)."""
    block, at, channels = exr_header(data)["channels"][1], 0, {}
    while block[at]:
        end = block.index(b"\0", at)
        channels[block[at:end].decode()] = struct.unpack_from("<i", block, end + 1)[0]
        at = end + 17
    return channels


def has_tool(name):
    return shutil.which(name) is not None
