"""Compares the programs in examples/gl: each is compiled for OpenGL and for OpenRT, and draws the
same pictures. Mesa draws OpenGL's without a GPU."""
import os
import re
import shutil
import subprocess

import numpy
import pytest
from conftest import ROOT, find_vv
from flip import flip
from xserver import display

BIN = find_vv().parent
NAMES = ("gears", "columns", "viewer")


def run(program, folder, frames=3, **environment):
    """Runs a program for some frames, and returns what it prints."""
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
    return done.stdout


def pictures(program, folder, frames=3, **environment):
    """Runs a program for some frames, and returns its pictures as arrays of 0 to 1."""
    run(program, folder, frames, **environment)
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
        difference = flip(a, b)
        assert difference < 0.1, f"frame {frame} differs by FLIP {difference:.4f}"
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


def test_flip_is_that_of_its_authors():
    """The values are those of their package flip-evaluator 1.7."""
    y, x = numpy.mgrid[0:90, 0:120]
    plain = numpy.stack((x / 119, y / 89, 0 * x + 0.5), 2)
    disk = numpy.where(((x - 60)**2 + (y - 45)**2 < 900)[..., None], plain[..., ::-1], plain)
    assert flip(plain, plain) == 0
    assert flip(plain, disk) == pytest.approx(0.0912236, abs=1e-5)
    black, white = numpy.zeros((40, 40, 3)), numpy.ones((40, 40, 3))
    assert flip(black, white) == pytest.approx(0.9673994, abs=1e-4)


def test_names_are_selected_as_opengl_selects_them(tmp_path):
    with display("640x480"):
        theirs = run("gl_picking_opengl", tmp_path, 1).split()
    ours = run("gl_picking", tmp_path, 1).split()
    assert len(ours) == len(theirs) > 80, ours
    for a, b in zip(ours, theirs):
        if "." in a:
            assert float(a) == pytest.approx(float(b), abs=2e-4)
        else:
            assert a == b


@pytest.mark.parametrize("value", ("three", "0", "-1", "2x", "99999999999"))
def test_another_value_than_a_number_of_frames_is_reported(value, tmp_path):
    if not (BIN / "gl_gears").exists():
        pytest.skip("gl_gears is not built")
    done = subprocess.run([BIN / "gl_gears"],
                          cwd=tmp_path,
                          env={
                              **os.environ, "OPENRT_UT_FRAMES": value
                          },
                          capture_output=True,
                          text=True,
                          timeout=60)
    assert f"OPENRT_UT_FRAMES={value}: a number of frames" in done.stderr
    assert done.stderr.count("\n") == 1 and not list(tmp_path.iterdir())


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
