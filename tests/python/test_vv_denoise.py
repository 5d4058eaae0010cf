"""Tests --denoise, --raw and --list-features: what files and statistics say, what is refused, and
libraries that are absent, unusable or dangerous. A fake of Open Image Denoise gives every pixel the
mean colour; one test uses the real one where it is installed."""
import ctypes.util
import importlib.util
import json
import os
import pathlib
import shutil

import pytest

from conftest import SMALL, exr_channels, exr_header, read_pfm, read_ppm
from test_vv_denoiser import NAME, fake  # noqa: F401  a fixture
from test_vv_preview import ROLLING

NOTE = f"denoised by {NAME}, biased"
SIZE = ("--size", "32x24")


@pytest.fixture
def library(monkeypatch):
    """Sets the library; None: wherever it is found."""

    def choose(name):
        if name is None:
            monkeypatch.delenv("OPENRT_OIDN_LIBRARY")
        else:
            monkeypatch.setenv("OPENRT_OIDN_LIBRARY", str(name))

    return choose


@pytest.fixture
def usable(vv, fake, library):  # noqa: F811
    vv.write("rolling.wrl", ROLLING)
    library(fake())
    return vv


def made(vv, *options, world="box.wrl", size=SIZE):
    done = vv(world, *size, *options)
    assert done.returncode == 0, done.talk
    return done


# Files ------------------------------------------------------------------------------------------


def test_pictures_are_denoised_and_say_so(usable):
    names = ["a.png", "a.jpg", "a.ppm", "a.exr"]
    done = made(usable, "--denoise", *(word for name in names for word in ("-o", name)))
    assert done.talk.count(NOTE) == 1 and "without --denoise" in done.talk
    for name in names:
        assert (usable.folder / name).read_bytes().count(NOTE.encode()) == 1, name
    assert exr_header((usable.folder / "a.exr").read_bytes())["comments"] == ("string",
                                                                              NOTE.encode())
    _, _, rows = read_ppm(without_comment((usable.folder / "a.ppm").read_bytes()))
    shown = {pixel for row in rows for pixel in row}
    assert shown == {(0, 0, 0), rows[12][16]}, "the fake's mean, and black where nothing is seen"
    assert made(usable, "--denoise", "-q", "-o", "b.png").talk == ""


def without_comment(ppm):
    kind, note, rest = ppm.split(b"\n", 2)
    assert note.startswith(b"# ")
    return kind + b"\n" + rest


def test_the_raw_picture_is_written_beside(usable):
    names = ("raw.png", "raw.exr", "raw.pfm")
    options = ("--channels", "z,error", "--spp", "8")
    made(usable, *options, *(word for name in names for word in ("-o", name)))
    true = [(usable.folder / name).read_bytes() for name in names]
    made(usable, *options, "--denoise", "-o", "a.exr",
         *(word for name in names for word in ("--raw", name)))
    assert [(usable.folder / name).read_bytes() for name in names] == true
    denoised = (usable.folder / "a.exr").read_bytes()
    assert set(exr_channels(denoised)) == set("RGBAZ"), "error bars belong to the raw picture"
    assert "error.R" in exr_channels(true[1])
    _, _, rows = read_pfm(true[2])
    assert len({pixel for row in rows for pixel in row}) > 2


def test_threads_do_not_matter(usable):
    files = []
    for threads in ("1", "3"):
        made(usable, "--denoise", "--threads", threads, "-o", "a.exr", world="rolling.wrl")
        files.append((usable.folder / "a.exr").read_bytes())
    assert files[0] == files[1]


def test_sequences_films_and_views(usable):
    made(usable, "--denoise", "--frames", "0-2", "-o", "a.png", "-o", "a.gif", "--raw", "r.gif",
         "--raw", "r.png", "--stats", "s.json", world="rolling.wrl")
    for number in range(3):
        assert NOTE.encode() in (usable.folder / f"a-{number:04}.png").read_bytes()
        assert b"denoised" not in (usable.folder / f"r-{number:04}.png").read_bytes()
    assert NOTE.encode() in (usable.folder / "a.gif").read_bytes()
    assert b"denoised" not in (usable.folder / "r.gif").read_bytes()
    stats = json.loads((usable.folder / "s.json").read_text())
    assert stats["image"]["denoised"]["by"] == NAME and stats["time"]["denoise"] > 0
    assert all(frame["time"]["denoise"] > 0 for frame in stats["frames"])
    made(usable, "--denoise", "--viewpoint", "all", "-o", "v.png", "--raw", "w.png")
    names = sorted(path.name for path in usable.folder.glob("[vw]-*.png"))
    assert len(names) == 4, names


def test_statistics_say_so(usable):
    made(usable, "--denoise", "-o", "a.png", "--stats", "s.json")
    stats = json.loads((usable.folder / "s.json").read_text())
    assert stats["image"]["denoised"] == {"by": NAME, "channels": ["rgba"], "biased": True}
    assert stats["time"]["denoise"] > 0 and stats["time"]["write"] >= 0
    made(usable, "-o", "a.png", "--stats", "s.json")
    stats = json.loads((usable.folder / "s.json").read_text())
    assert "denoised" not in stats["image"] and "denoise" not in stats["time"]


@pytest.mark.parametrize("size", ["1x1", "1x40", "3x2"])
def test_tiny_pictures(usable, size):
    made(usable, "--denoise", "-o", "a.png", size=("--size", size))


def test_transparent_pictures(usable):
    image = pytest.importorskip("PIL.Image")
    made(usable, "--denoise", "--background", "none", "--spp", "16", "-o", "a.png", "--raw",
         "r.png")
    with image.open(usable.folder / "a.png") as opened:
        alpha = opened.convert("RGBA").getchannel("A")
    with image.open(usable.folder / "r.png") as opened:
        raw = opened.convert("RGBA").getchannel("A")
    assert alpha.getpixel((0, 0)) == raw.getpixel((0, 0)) == 0
    assert alpha.getpixel((16, 12)) == raw.getpixel((16, 12)) == 255
    assert list(alpha.getdata()) != list(raw.getdata()), "borders are denoised, too"


# Refusals ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("options, words", [
    (("-o", "a.png", "--error", "2%"), "--error"),
    (("--audit", ), "--audit"),
    (("-o", "a.png", "--compare", "ref.exr"), "--compare"),
    (("--measure", "a.csv"), "--measure"),
    (("-o", "a.png", "--false-colour", "auto"), "--false-colour"),
    (("-o", "a.pfm", ), "PFM files cannot say that they are denoised"),
    (("-o", "a.exr", "--channels", "error"), "--raw FILE.exr keeps them"),
    (("-o", "a.exr", "--channels", "trust", "--raw", "r.png"), "--raw FILE.exr keeps them"),
    (("--raw", "r.exr"), "--denoise needs -o"),
    ((), "--denoise needs -o"),
    (("-o", "a.png", "--raw", "a.png"), "-o and --raw name one file, a.png"),
    (("-o", "a.png", "--raw", "a.bmp"), "--raw: a file name with one of the suffixes"),
    (("-o", "-", "--raw", "-"), "only one thing can go to standard output"),
])
def test_what_rests_on_unbiased_values_is_refused(usable, options, words):
    done = usable("box.wrl", "--denoise", *options, *SMALL[:2])
    assert done.returncode == 2 and words in done.talk, done.talk
    assert not list(usable.folder.glob("*.png")) and done.talk.count("\n") == 1


def test_raw_needs_denoise(vv):
    done = vv("box.wrl", "-o", "a.png", "--raw", "r.png")
    assert done.returncode == 2 and "--raw needs --denoise" in done.talk


# Libraries --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name, words", [
    ("none", "Open Image Denoise 2 was not found: pip install pyoidn"),
    ("/nowhere/oidn.so", "/nowhere/oidn.so"),
    (__file__, "Open Image Denoise cannot be loaded"),
    ("libm.so.6", "has no function oidnNewDevice: it is not Open Image Denoise 2"),
])
def test_without_the_library_a_message_says_how_to_get_it(vv, library, name, words):
    library(name)
    done = vv("box.wrl", "--denoise", "-o", "a.png")
    assert done.returncode == 2 and words in done.talk and done.talk.count("\n") == 1, done.talk
    assert not (vv.folder / "a.png").exists()
    made(vv, "-o", "a.png")


@pytest.mark.parametrize("fault, words", [
    ("FAKE_OLD", "is Open Image Denoise 1.4.3; version 2.0.0 or newer is needed"),
    ("FAKE_INCOMPLETE", "has no function oidnExecuteFilter"),
    ("FAKE_WITHOUT_DEVICE", "the fake has no device"),
    ("FAKE_FAILING", "the fake cannot filter this"),
    ("FAKE_CRASHING", "crashes when it is tried (Segmentation fault)"),
    ("FAKE_LEAVING", "ends the process that loads it"),
])
def test_an_unusable_library_is_refused_before_anything_is_drawn(vv, fake, library, fault, words):  # noqa: F811
    library(fake(fault))
    done = vv("box.wrl", "--denoise", "-o", "a.png", "--raw", "r.png")
    assert done.returncode == 2 and words in done.talk and done.talk.count("\n") == 1, done.talk
    assert not list(vv.folder.glob("*.png"))
    row = {row["name"]: row for row in json.loads(vv("--list-features", "--json").text)["features"]}
    assert not row["denoise"]["available"] and words in row["denoise"]["detail"]


@pytest.mark.parametrize("fault, code, words", [
    ("FAKE_FAILING_LARGE", 1, "the fake cannot filter this"),
    ("FAKE_WITHOUT_MEMORY", 75, "out of memory"),
])
def test_a_failure_leaves_the_raw_picture(vv, fake, library, fault, code, words):  # noqa: F811
    library(fake(fault))
    done = vv("box.wrl", "--denoise", "-o", "a.png", "--raw", "r.png", *SIZE)
    assert done.returncode == code and words in done.talk, done.talk
    assert (vv.folder / "r.png").exists() and not (vv.folder / "a.png").exists()


@pytest.mark.skipif(ctypes.util.find_library("OpenImageDenoise") is not None,
                    reason="the dynamic linker finds a real library")
def test_the_python_package_is_found_where_pip_puts_it(vv, fake, library):  # noqa: F811
    library(None)
    package = vv.folder / "venv/lib/python3.11/site-packages/pyoidn/oidn/lib"
    package.mkdir(parents=True)
    shutil.copy(fake(), package / "libOpenImageDenoise.so.2")
    env = {"VIRTUAL_ENV": str(vv.folder / "venv"), "HOME": str(vv.folder)}
    done = vv("box.wrl", "--denoise", "-o", "a.png", *SIZE, env=env)
    assert done.returncode == 0 and NOTE in done.talk, done.talk
    features = json.loads(vv("--list-features", "--json", env=env).text)["features"]
    assert features[0]["file"] == str(package / "libOpenImageDenoise.so.2")


# The list ---------------------------------------------------------------------------------------


def test_features_are_listed(usable):
    done = usable("--list-features")
    assert done.returncode == 0 and done.talk == ""
    lines = done.text.splitlines()
    assert any(line.startswith("denoise     yes ") for line in lines), done.text
    assert any(NAME in line for line in lines)
    rows = json.loads(usable("--list-features", "--json").text)["features"]
    names = [row["name"] for row in rows]
    assert names[:4] == ["denoise", "mp4", "webm", "gif"] and len(set(names)) == len(names)
    assert {"ecmascript", "tcl", "python", "native", "seccomp", "window",
            "serve"} <= set(names)
    for row in rows:
        assert set(row) == {"name", "text", "available", "detail", "file", "how"}
        assert bool(row["how"]) != row["available"], row
        assert not row["file"] or os.path.exists(row["file"])
    engines = {e["name"] for e in json.loads(usable("--list-engines", "--json").text)["engines"]}
    assert {row["name"] for row in rows if row["available"]} >= engines


def test_what_is_missing_is_listed_with_its_remedy(vv):
    rows = json.loads(vv("--list-features", "--json").text)["features"]
    assert rows[0]["name"] == "denoise" and not rows[0]["available"]
    assert "pip install pyoidn" in rows[0]["how"] and "was not found" in rows[0]["detail"]
    assert "to get it: pip install pyoidn" in vv("--list-features").text
    done = vv("--list-features", "--list-engines")
    assert done.returncode == 2 and "--list-features" in done.talk


# The real library -------------------------------------------------------------------------------


def real_library():
    spec = importlib.util.find_spec("pyoidn")
    if not spec:
        return None
    return pathlib.Path(spec.origin).parent / "oidn/lib/libOpenImageDenoise.so.2"


def test_the_real_library_brings_pictures_nearer_to_the_truth(vv, library):
    file = real_library()
    if not file or not file.exists():
        pytest.skip("pyoidn is not installed")
    library(file)
    vv.write("rolling.wrl", ROLLING)

    def mean_square(name):
        data = (vv.folder / name).read_bytes()
        _, _, rows = read_ppm(without_comment(data) if name == "a.ppm" else data)
        pairs = zip((v for row in rows for p in row for v in p), truth)
        return sum((a - b)**2 for a, b in pairs)

    made(vv, "--spp", "1024", "-o", "t.ppm", world="rolling.wrl", size=("--size", "96x72"))
    _, _, rows = read_ppm((vv.folder / "t.ppm").read_bytes())
    truth = [v for row in rows for pixel in row for v in pixel]
    made(vv, "--spp", "4", "--seed", "5", "--denoise", "-o", "a.ppm", "--raw", "r.ppm",
         world="rolling.wrl", size=("--size", "96x72"))
    assert mean_square("a.ppm") < mean_square("r.ppm") / 4
