"""Tests Picture.denoised(), xvrml.denoise() and xvrml.features(). A process finds the library once,
so each test runs a program of its own, with a fake library in the place of the real one."""
import os
import re
import subprocess
import sys
import textwrap

import pytest

from conftest import BOX, ROOT
from test_vv_denoiser import fake  # noqa: F401  a fixture

xvrml = pytest.importorskip("xvrml")
np = pytest.importorskip("numpy")

HEAD = """
import copy, pickle
import numpy as np
import xvrml
NAME = "Open Image Denoise 2.4.99"
def fails(kind, words, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except kind as error:
        assert words in str(error), error
    else:
        raise AssertionError(f"no {kind.__name__}")
"""


@pytest.fixture
def program(tmp_path):
    """Returns a function that runs a program with a library."""
    (tmp_path / "box.wrl").write_text(BOX)

    def run(text, library, **env):
        done = subprocess.run([sys.executable, "-c", HEAD + textwrap.dedent(text)],
                              cwd=tmp_path,
                              env={
                                  **os.environ, "OPENRT_OIDN_LIBRARY": str(library),
                                  **env
                              },
                              capture_output=True,
                              text=True,
                              timeout=120)
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.folder = tmp_path
    return run


def test_a_denoised_picture_knows_that_it_is_denoised(program, fake):  # noqa: F811
    program(
        """
        world = xvrml.load("box.wrl")
        image = world.render(size=(32, 24), spp=8, error=0.5,
                             channels=("albedo", "normal", "z", "error", "id"))
        before = image.array.copy()
        done = image.denoised()
        assert (image.array == before).all() and image.note == "" and "denoised" not in repr(image)
        assert repr(done) == f"<Picture 32x24, denoised by {NAME}>"
        assert done.note == f"denoised by {NAME}, biased"
        assert done.stats["denoised_by"] == NAME and done.stats["shapes"] == 1
        assert any(key.startswith("error_") for key in image.stats)
        assert not any(key.startswith("error_") for key in done.stats)
        assert np.allclose(done.array[12, 16, :3], before[..., :3].mean(axis=(0, 1)), atol=1e-6)
        assert done.shape == image.shape and done.time == image.time
        assert set(done.channels) == set(image.channels) - {"error", "trust"}
        assert (done["z"] == image["z"]).all() and done.names == image.names
        assert (done.camera.T == image.camera.T).all() and done.nodes[1] == image.nodes[1]
        fails(AttributeError, "error bars belong to the picture before", lambda: done.error)
        fails(ValueError, "denoised already", done.denoised)
        assert (image.denoised(threads=1).array == done.array).all()
        fails(ValueError, "threads: 0 to 1024 expected, not -1", image.denoised, threads=-1)
        fails(TypeError, "threads", image.denoised, threads="two")
        for again in (pickle.loads(pickle.dumps(done)), copy.deepcopy(done)):
            assert repr(again) == repr(done) and again.note == done.note
            fails(ValueError, "denoised already", again.denoised)
        """, fake())


def test_doubt(program, fake):  # noqa: F811
    program(
        """
        world = xvrml.load("box.wrl")
        image = world.render(size=(32, 24), spp=64,
                             channels=("albedo", "normal", "error", "trust"))
        done = image.denoised(audit=True)
        doubt = done["doubt"]
        assert "doubt" in done.channels and "doubt" not in image.channels
        assert doubt.shape == (24, 32) and doubt.dtype == np.float32
        assert ((doubt < 0) == (image["trust"] == 0)).all() and (doubt > 1).any()
        judged = (doubt >= 0).sum()
        assert done.stats["doubt_judged"] == judged
        assert abs(done.stats["doubt_share"] - (doubt > 1).sum() / judged) < 1e-9
        assert (image.doubt(np.asarray(done)) == doubt).all()
        assert (image.doubt(done.array[..., :3]) == doubt).all(), "of any denoiser"
        own = image.doubt(image.array)
        assert ((own == 0) | (own == -1)).all()
        assert (pickle.loads(pickle.dumps(done))["doubt"] == doubt).all()
        done.save("a.exr")
        assert "doubt" not in image.denoised().channels
        fails(ValueError, "the picture is denoised", done.doubt, done.array)
        fails(ValueError, "32x24, not 16x24", image.doubt, done.array[:, ::2])
        fails(ValueError, "colours: numbers of shape", image.doubt, done.array[..., 0])
        fails(KeyError, "no channel doubt", lambda: image["doubt"])
        fails(ValueError, "channels", world.render, size=(8, 8), channels=("doubt", ))
        image = world.render(size=(32, 24), spp=4, channels=("albedo", "normal"))
        fails(ValueError, "no channel error, which doubt needs", image.denoised, audit=True)
        fails(ValueError, "no channel error, which doubt needs", image.doubt, image.array)
        """, fake())


def test_files_of_it_say_so(program, fake):  # noqa: F811
    program(
        """
        import pathlib
        world = xvrml.load("box.wrl")
        image = world.render(size=(32, 24), spp=1, channels=("albedo", "normal"))
        done = image.denoised()
        for suffix in ("png", "jpg", "exr", "ppm"):
            done.save("a." + suffix)
            image.save("r." + suffix)
            assert done.note.encode() in pathlib.Path("a." + suffix).read_bytes(), suffix
            assert b"denoised" not in pathlib.Path("r." + suffix).read_bytes()
        fails(ValueError, "PFM files cannot say that they are denoised", done.save, "a.pfm")
        assert not pathlib.Path("a.pfm").exists()
        with xvrml.Film("a.gif") as film:
            film.add(done)
            fails(ValueError, "denoised by one library, or none", film.add, image)
        assert done.note.encode() in pathlib.Path("a.gif").read_bytes()
        """, fake())


def test_what_cannot_be_denoised(program, fake):  # noqa: F811
    program(
        """
        world = xvrml.load("box.wrl")
        image = world.render(size=(16, 12), spp=1)
        fails(ValueError, "no channel albedo, which denoising needs: render(channels=('albedo', "
              "'normal'))", image.denoised)
        image = world.render(size=(16, 12), spp=1, channels=("albedo", "normal"))
        image.array[3, 4, 1] = np.nan
        fails(ValueError, "colours: finite numbers expected, not nan", image.denoised)
        """, fake())


def test_arrays(program, fake):  # noqa: F811
    program(
        """
        colour = np.arange(24, dtype=float).reshape(2, 4, 3)
        made = xvrml.denoise(colour)
        assert made.dtype == np.float32 and made.shape == (2, 4, 3)
        assert np.allclose(made, colour.mean(axis=(0, 1)))
        guide = np.full((2, 4, 3), 0.5)
        assert np.allclose(xvrml.denoise(colour, guide, normal=guide), made)
        alpha = np.concatenate([colour, np.ones((2, 4, 1))], axis=2)
        again = xvrml.denoise(alpha.astype(np.float16)[:, ::-1], guide, guide)
        assert again.shape == (2, 4, 4) and (again[..., 3] == 1).all()
        assert np.allclose(again[..., :3], made)
        shape = "colour: numbers of shape (height, width, 3) or (height, width, 4) expected"
        for wrong in (colour[0], colour[..., :2], np.zeros((0, 4, 3)), np.zeros((2, 2, 2, 3))):
            fails(ValueError, shape, xvrml.denoise, wrong)
        fails(TypeError, "colour", xvrml.denoise, "colour")
        fails(ValueError, "albedo: an array of the size of colour expected, 4x2, not 2x4",
              xvrml.denoise, colour, guide.transpose(1, 0, 2), guide)
        fails(ValueError, "albedo and normal: both or none", xvrml.denoise, colour, guide)
        for bad in (np.inf, np.nan):
            fails(ValueError, "normal: finite numbers expected", xvrml.denoise, colour, guide,
                  guide * bad)
            fails(ValueError, "colour: finite numbers expected", xvrml.denoise, colour * bad)
        assert xvrml.denoise(np.zeros((1, 1, 3))).tolist() == [[[0, 0, 0]]]
        """, fake())


def test_the_example_of_the_guide(program, fake):  # noqa: F811
    guide = (ROOT / "docs/python.md").read_text()
    block, = re.findall(r"```python needs=pyoidn\n(.*?)```", guide, re.S)
    program('world = xvrml.load("box.wrl")\n' + block, fake())
    assert b"denoised by" in (program.folder / "pretty.png").read_bytes()


@pytest.mark.parametrize("fault, words", [
    (None, "Open Image Denoise 2 was not found: pip install pyoidn"),
    ("FAKE_OLD", "version 2.0.0 or newer is needed"),
    ("FAKE_CRASHING", "crashes when it is tried"),
])
def test_without_a_usable_library(program, fake, fault, words):  # noqa: F811
    program(
        f"""
        for _ in range(2):
            fails(xvrml.RenderError, {words!r}, xvrml.denoise, np.zeros((4, 4, 3)))
        row = xvrml.features()["denoise"]
        assert not row.available and row.file == "" and "pip install pyoidn" in row.how, row
        assert {words!r}.split(":")[0] in row.detail, row
        """,
        fake(fault) if fault else "none")


def test_features(program, fake):  # noqa: F811
    program(
        """
        rows = xvrml.features()
        assert list(rows)[0] == "denoise" and rows["denoise"].available
        assert rows["denoise"].detail == NAME and rows["denoise"].file.endswith("fake.so")
        assert rows["gif"].available
        for name, row in rows.items():
            assert isinstance(row, xvrml.Feature) and row.name == name and row.text
            assert bool(row.how) != row.available, row
        import importlib.util
        assert rows["notebook"].available == bool(importlib.util.find_spec("jupyter_rfb"))
        """, fake())


def test_the_package_pyoidn_is_found_on_the_path_of_python(program, fake):  # noqa: F811
    lib = program.folder / "site/pyoidn/oidn/lib"
    lib.mkdir(parents=True)
    (lib.parent.parent / "__init__.py").write_text("raise RuntimeError('it is not imported')")
    os.link(fake(), lib / "libOpenImageDenoise.so.2")
    out = program("print(xvrml.features()['denoise'].file)",
                  "",
                  HOME=str(program.folder),
                  PYTHONPATH=f"{program.folder / 'site'}{os.pathsep}{os.environ['PYTHONPATH']}")
    import ctypes.util
    if ctypes.util.find_library("OpenImageDenoise") is None:
        assert out.strip() == str(lib / "libOpenImageDenoise.so.2")
