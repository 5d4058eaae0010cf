"""Compares the programs in examples/gl: each is compiled for OpenGL and for OpenRT, and draws the
same pictures. Mesa draws OpenGL's without a GPU."""
import os
import re
import shutil
import subprocess

import numpy
import pytest
from conftest import ROOT, find_vv
from xserver import display

BIN = find_vv().parent
NAMES = ("gears", "columns", "viewer")


def pictures(program, folder, frames=3, **environment):
    """Runs a program for some frames, and returns its pictures as arrays of 0 to 1."""
    if not (BIN / program).exists():
        pytest.skip(f"{program} is not built")
    done = subprocess.run([BIN / program],
                          cwd=folder,
                          env={
                              **os.environ, "OPENRT_UT_FRAMES": str(frames),
                              "OPENRT_UT_FILE": f"{program}%d.ppm",
                              "LIBGL_ALWAYS_SOFTWARE": "1",
                              **environment
                          },
                          capture_output=True,
                          text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr
    assert "rtut:" not in done.stderr
    return [read(folder / f"{program}{i}.ppm") for i in range(frames)]


def read(path):
    kind, size, most, data = path.read_bytes().split(b"\n", 3)
    assert (kind, most) == (b"P6", b"255")
    width, height = map(int, size.split())
    return numpy.frombuffer(data, numpy.uint8).reshape(height, width, 3) / 255.0


@pytest.mark.parametrize("name", NAMES)
def test_pictures_are_those_of_opengl(name, tmp_path):
    with display("640x480"):
        theirs = pictures(f"gl_{name}_opengl", tmp_path)
    ours = pictures(f"gl_{name}", tmp_path)
    for frame, (a, b) in enumerate(zip(ours, theirs)):
        difference = numpy.abs(a - b).mean()
        assert difference < 0.02, f"frame {frame} differs by {difference:.4f}"
    assert numpy.abs(ours[0] - ours[1]).mean() > 0.001, "nothing moves"


def test_each_feature_is_drawn_as_opengl_draws_it(tmp_path):
    source = (ROOT / "tests/gl/features.c").read_text()
    names = re.search(r"features\[\]\)\(void\) = \{(.*?)\}", source, re.S)[1].split(",")
    with display("640x480"):
        theirs = pictures("gl_features_opengl", tmp_path, len(names))
    ours = pictures("gl_features", tmp_path, len(names))
    differences = {
        name.strip(): float(numpy.abs(a - b).mean())
        for name, a, b in zip(names, ours, theirs)
    }
    assert max(differences.values()) < 0.02, differences


@pytest.mark.parametrize("light", ("shadows", "linear"))
def test_light_can_be_traced(light, tmp_path):
    plain = pictures("gl_columns", tmp_path, 1)[0]
    traced = pictures("gl_columns", tmp_path, 1, OPENRT_GL_LIGHT=light)[0]
    assert 0.005 < numpy.abs(plain - traced).mean() < 0.4


@pytest.mark.parametrize("name", NAMES)
def test_the_sources_are_nearly_the_same(name):
    text = (ROOT / f"examples/gl/{name}.c").read_text()
    assert "USE_GL" not in re.sub(r"/\*.*?\*/", "", text, flags=re.S)


@pytest.mark.parametrize("name", NAMES)
def test_the_prefix_can_be_replaced(name, tmp_path):
    compiler = shutil.which("cc")
    if not compiler:
        pytest.skip("there is no C compiler")
    for source in (ROOT / "examples/gl").iterdir():
        text = re.sub(r"\bgl([A-Z])", r"rt\1", source.read_text())
        (tmp_path / source.name).write_text(re.sub(r"\bGL_", "RT_", text))
    subprocess.run([
        compiler, "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only",
        f"-I{ROOT}/libopenrt/include", f"{name}.c"
    ],
                   cwd=tmp_path,
                   check=True,
                   timeout=60)


def test_without_a_display_a_program_says_so():
    if not (BIN / "gl_gears").exists():
        pytest.skip("gl_gears is not built")
    without = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run([BIN / "gl_gears"],
                          env={
                              **without, "SDL_VIDEODRIVER": "x11"
                          },
                          capture_output=True,
                          text=True,
                          timeout=60)
    assert done.returncode == 1
    assert "there is no window" in done.stderr and "OPENRT_UT_FRAMES" in done.stderr
