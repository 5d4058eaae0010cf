"""Tests the denoiser of previews: a fake of the library Open Image Denoise, its absence and its
failures, and what files and messages say. Pictures without --preview are never touched."""
import shutil
import subprocess

import pytest

from conftest import ROOT
from test_vv_preview import NOTE, ROLLING, bytes_of, frames, without_note

NAME = "Open Image Denoise 2.4.99"


@pytest.fixture
def rolling(vv, monkeypatch):
    vv.write("rolling.wrl", ROLLING)
    vv.library = lambda name: monkeypatch.setenv("OPENRT_OIDN_LIBRARY", str(name))
    return vv


@pytest.fixture(scope="module")
def fake(tmp_path_factory):
    """Returns a function that compiles the fake library with a fault and returns its file."""
    compiler = shutil.which("cc")
    if not compiler:
        pytest.skip("there is no C compiler")
    folder = tmp_path_factory.mktemp("oidn")

    def make(fault=""):
        file = folder / f"fake{fault}.so"
        if not file.exists():
            subprocess.run([
                compiler, "-std=c99", "-D_POSIX_C_SOURCE=200809L", "-shared", "-fPIC", "-o", file,
                ROOT / "tests/oidn/fake_oidn.c", *([f"-D{fault}"] if fault else [])
            ],
                           check=True)
        return file

    return make


def test_it_filters_previews_and_they_say_so(rolling, fake):
    own = frames(rolling, "own.ppm", "--preview", "--spp", "1", last=2)
    rolling.library(fake())
    unasked = frames(rolling, "unasked.ppm", "--preview", "--spp", "1", last=2)
    assert unasked == own, "files do not depend on an installed library unless that is asked for"
    asked = frames(rolling, "oidn.ppm", "--preview", "--spp", "1", "--denoise", last=2)
    note = NOTE.format("1 sample").replace("per pixel", f"per pixel by {NAME}")
    assert note.encode() in asked
    assert bytes_of(without_note(asked)) != bytes_of(without_note(own))
    again = frames(rolling,
                   "oidn.ppm",
                   "--preview",
                   "--spp",
                   "1",
                   "--denoise",
                   "--threads",
                   "1",
                   last=2)
    assert asked == again, "the same bytes with any number of threads, as far as the library permits"


def test_pictures_without_bias_are_not_touched(rolling, fake):
    true = frames(rolling, "true.ppm", "--spp", "2", last=1)
    rolling.library(fake())
    assert frames(rolling, "oidn.ppm", "--spp", "2", "--denoiser", "auto", last=1) == true


@pytest.mark.parametrize("fault, words", [
    ("FAKE_OLD", "is Open Image Denoise 1.4.3; version 2.0.0 or newer is needed"),
    ("FAKE_INCOMPLETE", "has no function oidnExecuteFilter"),
    ("FAKE_WITHOUT_DEVICE", "the fake has no device"),
    ("FAKE_FAILING", "the fake cannot filter this"),
    ("FAKE_CRASHING", "crashes when it is tried"),
])
def test_a_library_that_cannot_be_used_is_refused(rolling, fake, fault, words):
    rolling.library(fake(fault))
    done = rolling("rolling.wrl", "--denoiser", "oidn", "-o", "a.png")
    assert done.returncode == 2 and words in done.talk, done.talk
    assert not (rolling.folder / "a.png").exists()


def test_a_failure_ends_the_sequence(rolling, fake):
    rolling.library(fake("FAKE_FAILING_LARGE"))
    done = rolling("rolling.wrl", "--frames", "0-2", "--preview", "--denoise", "--size", "64x48",
                   "-o", "a.png")
    assert done.returncode == 1 and "the fake cannot filter this" in done.talk, done.talk


@pytest.mark.parametrize("library, words", [
    ("none", "Open Image Denoise 2 was not found"),
    ("/nowhere/oidn.so", "/nowhere/oidn.so"),
    ("no-such-oidn.so", "OPENRT_OIDN_LIBRARY: there is no library no-such-oidn.so"),
])
def test_absence_is_told_only_if_the_library_is_asked_for(rolling, library, words):
    rolling.library(library)
    done = rolling("rolling.wrl", "--denoiser", "oidn", "-o", "a.png")
    assert done.returncode == 2 and words in done.talk, done.talk
    frames(rolling, "own.ppm", "--preview", "--denoiser", "auto", "--spp", "1", last=1)


def test_other_words_are_refused(vv):
    done = vv("box.wrl", "--denoiser", "best", "-o", "a.png")
    assert done.returncode == 2 and 'auto, own or oidn was expected, not "best"' in done.talk
