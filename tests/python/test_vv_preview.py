"""Tests --preview: sequences and films whose pictures are rebuilt from few samples, what their files
say, that they do not depend on threads, and that they are nearer to the true picture."""
import json
import math

import pytest

from conftest import HEADER, SMALL, exr_header, read_ppm

# A ball moves over a floor under an area lamp, so that few samples are noisy.
ROLLING = HEADER + """
NavigationInfo { headlight FALSE }
Viewpoint { position 0 1.5 6 }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Path PositionInterpolator { key [0 1] keyValue [-1.5 .6 0, 1.5 .6 0] }
Transform { translation 0 4 2 children Shape { geometry Sphere { radius .7 } appearance
  ORTAppearance { shader ORTShader {
    name "Diffuse" file "diffuse" options "color emission 9 8 7" } } } }
Transform { translation 0 -.1 0 children Shape { geometry Box { size 9 .2 9 } appearance
  ORTAppearance { shader ORTShader {
    name "Diffuse" file "diffuse" options "color reflectance .5 .6 .7" } } } }
DEF Ball Transform { children Shape { geometry Sphere { radius .6 } appearance
  ORTAppearance { shader ORTShader {
    name "Diffuse" file "diffuse" options "color reflectance .8 .3 .2" } } } }
ROUTE Clock.fraction_changed TO Path.set_fraction
ROUTE Path.value_changed TO Ball.set_translation
"""
SIZE = ("--size", "64x48")
NOTE = "preview: rebuilt from {} per pixel, biased"


@pytest.fixture
def rolling(vv):
    vv.write("rolling.wrl", ROLLING)
    return vv


def frames(vv, name, *options, world="rolling.wrl", last=9):
    """Writes frames 0 to `last`; returns the bytes of the last file."""
    done = vv(world, "--frames", f"0-{last}", "-o", name, *SIZE, *options)
    assert done.returncode == 0, done.talk
    stem, suffix = name.rsplit(".", 1)
    return (vv.folder / f"{stem}-{last:04}.{suffix}").read_bytes()


def bytes_of(ppm):
    return [v for row in read_ppm(ppm)[2] for pixel in row for v in pixel]


def distance(a, b):
    return math.sqrt(sum((x - y)**2 for x, y in zip(a, b)) / len(a))


def without_note(ppm):
    """Returns a PPM file without its comment; checks that it has one."""
    kind, note, rest = ppm.split(b"\n", 2)
    assert note.startswith(b"# preview: ")
    return kind + b"\n" + rest


def test_every_file_says_so(rolling):
    note = NOTE.format("2 samples")
    names = ["a.png", "a.jpg", "a.ppm", "a.exr"]
    outputs = [word for name in [*names, "a.gif"] for word in ("-o", name)]
    done = rolling("rolling.wrl", "--frames", "0-2", "--preview", "--size", "32x24", "--spp", "2",
                   *outputs)
    assert done.returncode == 0, done.talk
    assert done.talk.count(note) == 1, "it is said once"
    for name in names:
        for number in range(3):
            stem, suffix = name.split(".")
            data = (rolling.folder / f"{stem}-{number:04}.{suffix}").read_bytes()
            assert data.count(note.encode()) == 1, (name, number)
    assert b"tEXtComment\0" + note.encode() in (rolling.folder / "a-0000.png").read_bytes()
    exr = exr_header((rolling.folder / "a-0001.exr").read_bytes())
    assert exr["comments"] == ("string", note.encode())
    image = pytest.importorskip("PIL.Image")
    for name, key in (("a-0002.png", "Comment"), ("a-0002.jpg", "comment"), ("a.gif", "comment")):
        with image.open(rolling.folder / name) as opened:
            found = opened.info[key]
            assert (found if isinstance(found, str) else found.decode()) == note, name


@pytest.mark.parametrize("suffix", ["mp4", "webm", "gif"])
def test_films_say_so(rolling, suffix):
    arguments = ["rolling.wrl", "--turntable", "2", "--spp", "1", "--size", "32x24"]
    done = rolling(*arguments, "--preview", "-o", f"a.{suffix}")
    if "has no encoder" in done.talk:
        pytest.skip("the ffmpeg libraries are not in this build")
    assert done.returncode == 0, done.talk
    assert NOTE.format("1 sample").encode() in (rolling.folder / f"a.{suffix}").read_bytes()
    done = rolling(*arguments, "-o", f"b.{suffix}")
    assert done.returncode == 0 and "preview" not in done.talk
    assert b"preview" not in (rolling.folder / f"b.{suffix}").read_bytes()


def test_quiet_says_nothing_and_four_samples_are_the_default(rolling):
    done = rolling("rolling.wrl", "--frames", "0-1", "--preview", "-q", "-o", "a.png", "--size",
                   "32x24", "--stats", "a.json")
    assert done.returncode == 0 and done.talk == ""
    assert NOTE.format("4 samples").encode() in (rolling.folder / "a-0001.png").read_bytes()
    stats = json.loads((rolling.folder / "a.json").read_text())
    assert stats["image"]["preview"] is True and stats["image"]["spp"] == 4
    assert stats["error"]["mean_rel"] is None and stats["error"]["half_width"] is None


def test_without_it_nothing_changes(rolling):
    data = frames(rolling, "a.png", "--spp", "2", last=3)
    assert b"preview" not in data and b"tEXt" not in data
    done = rolling("rolling.wrl", "--time", "0.1", "-o", "b.png", *SIZE, "--spp", "2")
    assert done.returncode == 0 and (rolling.folder / "b.png").read_bytes() == data
    frames(rolling, "c.png", "--stats", "c.json", last=1)
    assert "preview" not in json.loads((rolling.folder / "c.json").read_text())["image"]


def test_a_preview_is_nearer_to_the_true_picture(rolling):
    raw = bytes_of(frames(rolling, "raw.ppm", "--spp", "2"))
    rebuilt = bytes_of(without_note(frames(rolling, "rebuilt.ppm", "--spp", "2", "--preview")))
    done = rolling("rolling.wrl", "--time", "0.3", "-o", "true.ppm", *SIZE, "--spp", "1024")
    assert done.returncode == 0, done.talk
    true = bytes_of((rolling.folder / "true.ppm").read_bytes())
    assert rebuilt != raw
    floor = slice(40 * 64 * 3, None)  # without the ball, whose edges are alike in both
    assert distance(rebuilt[floor], true[floor]) < 0.5 * distance(raw[floor], true[floor])
    assert distance(rebuilt, true) < distance(raw, true)
    assert sum(rebuilt) == pytest.approx(sum(true), rel=0.05)


def test_the_bytes_do_not_depend_on_threads(rolling):
    options = ("--preview", "--spp", "1")
    one = frames(rolling, "one.exr", *options, "--threads", "1")
    assert frames(rolling, "three.exr", *options, "--threads", "3") == one
    assert frames(rolling, "again.exr", *options, "--threads", "3") == one


def test_a_still_world_is_rebuilt_from_all_its_pictures(rolling):
    """The camera and the world rest, so that samples add up from picture to picture, also from those
    before the first one."""
    rolling.write("still.wrl", ROLLING.replace("loop TRUE", "enabled FALSE"))
    last = bytes_of(
        without_note(frames(rolling, "a.ppm", "--preview", "--spp", "2", world="still.wrl")))
    first = bytes_of(without_note((rolling.folder / "a-0000.ppm").read_bytes()))
    raw = bytes_of(frames(rolling, "raw.ppm", "--spp", "2", world="still.wrl", last=0))
    done = rolling("still.wrl", "-o", "true.ppm", *SIZE, "--spp", "1024")
    assert done.returncode == 0, done.talk
    true = bytes_of((rolling.folder / "true.ppm").read_bytes())
    assert distance(last, true) < 0.5 * distance(raw, true)
    assert distance(first, true) < 0.5 * distance(raw, true)


@pytest.mark.parametrize("options, why", [
    (("-o", "a.png"), "needs -o with the frames of a film"),
    (("--time", "3", "-o", "a.png"), "needs -o with the frames of a film"),
    ((), "needs -o with the frames of a film"),
    (("--check", "--frames", "0-3"), "needs -o with the frames of a film"),
    (("--frames", "0-3", "-o", "a.exr", "--channels", "rgba,z"), "--channels"),
    (("--frames", "0-3", "-o", "a.exr", "--channels", "error"), "--channels"),
    (("--frames", "0-3", "-o", "a.png", "--error", "2%"), "--error"),
    (("--frames", "0-3", "-o", "a.png", "--time-limit", "1"), "--time-limit"),
    (("--frames", "0-3", "-o", "a.png", "--compare", "b.exr"), "--compare"),
    (("--frames", "0-3", "-o", "a.png", "--viewpoint", "all"), "--viewpoint all"),
    (("--frames", "0-3", "-o", "a.pfm"), "PFM files cannot say"),
    (("--frames", "0-3", "-o", "a.gif", "-o", "pfm:a"), "PFM files cannot say"),
])
def test_wrong_combinations(rolling, options, why):
    done = rolling("rolling.wrl", "--preview", *SMALL, *options)
    assert done.returncode == 2 and why in done.talk, done.talk
    assert "--preview" in done.talk and not list(rolling.folder.glob("a*"))


def test_exposure_is_chosen_from_the_samples(vv):
    """The filter spreads a trace of light to the black sky, which is most of this picture."""
    vv.write("night.wrl", HEADER + """Viewpoint { position 0 0 20 }
Shape { geometry Sphere { } appearance Appearance { material Material { emissiveColor 1 1 1 } } }""")
    chosen = {}
    for options in ((), ("--preview", )):
        done = vv("night.wrl", "--frames", "0", "-o", "n-{frame}.png", "--spp", "4", "--exposure", "auto", *SIZE,
                  *options)
        assert done.returncode == 0, done.talk
        chosen[options] = float(done.talk.split("--exposure auto is ")[1].split()[0])
    assert abs(chosen[("--preview", )] - chosen[()]) < .5, chosen
