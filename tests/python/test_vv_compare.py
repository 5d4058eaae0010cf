"""Tests vv compare: pictures of vv and of other programs, what it says, and what it refuses."""
import json
import struct
import zlib

import pytest

from exr_tools import read_exr

np = pytest.importorskip("numpy")

ROOM = """#VRML V2.0 utf8
Viewpoint { position 0 1.5 4 }
NavigationInfo { headlight FALSE }
PointLight { location 1 3 1 radius 20 }
DEF WHITE Shape { appearance Appearance { material Material { diffuseColor .8 .8 .8 } }
  geometry Box { size 8 .1 8 } }
DEF Box Transform { translation 0 .6 0 rotation 0 1 0 .5 children Shape {
  appearance Appearance { material DEF Paint Material { diffuseColor .3 .3 .3
    emissiveColor .2 .2 .2 } } geometry Box { } } }
Transform { translation 0 2 -4 rotation 1 0 0 1.5707963 children USE WHITE }
"""
SIZE = ("--size", "64x48")


def write_exr(path, planes, half=False):
    """Writes an OpenEXR file as another program may: planes {name: array}, not compressed."""
    height, width = next(iter(planes.values())).shape
    names = sorted(planes)
    kind, number = ("<f2", 1) if half else ("<f4", 2)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", number, 0, 1, 1)
                        for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = (("channels", "chlist", channels), ("compression", "compression", b"\0"),
                  ("dataWindow", "box2i", window), ("displayWindow", "box2i", window),
                  ("lineOrder", "lineOrder", b"\0"), ("pixelAspectRatio", "float",
                                                      struct.pack("<f", 1)),
                  ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1)))
    head = b"v/1\x01\x02\0\0\0" + b"".join(
        f"{name}\0{of}\0".encode() + struct.pack("<i", len(data)) + data
        for name, of, data in attributes) + b"\0"
    rows = []
    for y in range(height):
        data = b"".join(planes[name][y].astype(kind).tobytes() for name in names)
        rows.append(struct.pack("<2i", y, len(data)) + data)
    places, at = [], len(head) + 8 * height
    for row in rows:
        places.append(at)
        at += len(row)
    path.write_bytes(head + struct.pack(f"<{height}Q", *places) + b"".join(rows))


def write_pfm(path, image):
    height, width, _ = image.shape
    path.write_bytes(b"PF\n%d %d\n-1\n" % (width, height) + image[::-1].astype("<f4").tobytes())


def write_png(path, image):
    """image: bytes of shape (height, width, 3 or 4)."""
    height, width, components = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(
            ">I", zlib.crc32(kind + data))

    colour = {3: 2, 4: 6}[components]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" +
                     chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def rgb(image):
    return {name: image[..., k] for k, name in enumerate("RGB")}


def noise(seed, samples=16, shape=(48, 64, 3)):
    return np.random.default_rng(seed).normal(1, .5 / samples**.5, shape).astype(np.float32)


def compared(vv, *arguments):
    """Returns what vv compare says as JSON; its exit code must be that of `same`."""
    done = vv("compare", *arguments, "--json")
    assert done.returncode in (0, 4), done.talk
    said = json.loads(done.text)
    assert said["same"] == (done.returncode == 0) and done.talk == ""
    return said


# Pictures of vv ---------------------------------------------------------------------------------


@pytest.fixture
def room(vv):
    vv.write("room.wrl", ROOM)

    def made(name, *options):
        done = vv("room.wrl", *SIZE, "-q", "-o", name, *options)
        assert done.returncode == 0, done.talk

    vv.made = made
    return vv


def test_seeds_do_not_differ(room):
    room.made("a.exr", "--seed", "1")
    room.made("b.exr", "--seed", "2")
    said = compared(room, "a.exr", "b.exr", "--samples", "16,16")
    assert said["same"] and said["equal_noise"] and not said["error_bars"]
    assert said["tests"]["found"] == 0 and said["tests"]["squares"] > 100
    assert abs(said["bias"]) < 3 * said["bias_interval"] and said["rmse"] > 0
    assert 0 < said["flip"] < .2 and said["flip_exposures"] >= 2
    same = compared(room, "a.exr", "a.exr")
    assert same["same"] and same["rmse"] == same["flip"] == same["different"] == 0


def test_few_samples_do_not_differ_from_many(room):
    room.made("few.exr", "--seed", "1", "--spp", "4")
    room.made("many.exr", "--seed", "2", "--spp", "512")
    said = compared(room, "few.exr", "many.exr")
    assert said["same"] and not said["equal_noise"]


@pytest.mark.parametrize("options", [("-D", "Paint.emissiveColor=.22 .2 .2"), ("-D",
                                                                              "Box.translation=.1 .6 0"),
                                     ("--headlight", "on")])
def test_changes_of_the_world_are_found(room, options):
    room.made("a.exr", "--seed", "1", "--spp", "64")
    room.made("b.exr", "--seed", "2", "--spp", "64", *options)
    said = compared(room, "a.exr", "b.exr", "--samples", "64,64")
    assert not said["same"]
    change = said["changes"][0]
    assert change["chance"] < 1e-6 and change["x"] + change["width"] <= 64
    assert change["y"] + change["height"] <= 48


def test_error_bars_judge_pixels(room):
    options = ("--channels", "rgba,error,trust", "--spp", "64")
    room.made("a.exr", "--seed", "1", *options)
    room.made("b.exr", "--seed", "2", *options)
    said = compared(room, "a.exr", "b.exr")
    assert said["same"] and said["error_bars"] and said["tests"]["pixels"] > 1000
    text = room("compare", "a.exr", "b.exr").text
    assert "same      yes" in text and "judged by their error bars" in text
    _, planes = read_exr((room.folder / "b.exr").read_bytes())
    planes["R"] = planes["R"].copy()
    planes["R"][20, 30] += 20
    write_exr(room.folder / "c.exr", planes)
    said = compared(room, "a.exr", "c.exr")
    assert [(one["x"], one["y"], one["width"]) for one in said["changes"]] == [(30, 20, 1)]


def test_a_map_is_written(room):
    room.made("a.exr", "--seed", "1")
    room.made("b.exr", "--seed", "2", "-D", "Paint.emissiveColor=1 .2 .2")
    done = room("compare", "a.exr", "b.exr", "-o", "z.png", "-o", "z.exr")
    assert done.returncode == 4, done.talk
    assert (room.folder / "z.png").read_bytes()[:4] == b"\x89PNG"
    _, planes = read_exr((room.folder / "z.exr").read_bytes())
    assert planes["R"].shape == (48, 64) and np.abs(planes["R"]).max() > 5
    assert abs(np.median(planes["B"])) < 1


# Pictures of other programs ---------------------------------------------------------------------


def test_formats(vv):
    a, b = noise(1), noise(2)
    for name, image in (("a", a), ("b", b)):
        write_exr(vv.folder / f"{name}.exr", rgb(image))
        write_exr(vv.folder / f"{name}h.exr", rgb(image), half=True)
        write_pfm(vv.folder / f"{name}.pfm", image)
        write_png(vv.folder / f"{name}.png", (image * 60).round().astype(np.uint8))
    for suffix in (".exr", "h.exr", ".pfm", ".png"):
        said = compared(vv, "a" + suffix, "b" + suffix, "--samples", "16,16")
        assert said["same"] and said["radiance"] == (suffix != ".png")
        assert said["different"] > 1000
    for other in ("ah.exr", "a.pfm"):
        said = compared(vv, "a.exr", other)
        assert said["same"] and said["different"] == 0 and said["rmse"] < 1e-3


def test_transparent_pngs(vv):
    image = np.full((16, 16, 4), 200, np.uint8)
    image[:, :8, 3] = 0
    other = image.copy()
    other[:, :8, :3] = 10  # colours of what is not seen
    write_png(vv.folder / "a.png", image)
    write_png(vv.folder / "b.png", other)
    assert compared(vv, "a.png", "b.png")["different"] == 0


def test_a_change_of_one_percent_is_found(vv):
    write_exr(vv.folder / "a.exr", rgb(noise(1, 256)))
    write_exr(vv.folder / "b.exr", rgb(1.01 * noise(2, 256)))
    said = compared(vv, "a.exr", "b.exr", "--samples", "256,256")
    assert not said["same"] and .005 < said["bias"] < .015
    assert said["would_find"][-1]["change"] < .01
    text = vv("compare", "a.exr", "b.exr").text
    assert "same      no" in text and "change    64x48 pixels at 0,0" in text


@pytest.mark.parametrize("name", ["variance", "Variance"])
def test_variances_of_other_programs(vv, name):
    planes = {}
    for seed in (1, 2):
        planes[seed] = rgb(noise(seed))
        planes[seed].update({f"{name}.{c}": np.full((48, 64), .25, np.float32) for c in "RGB"})
        write_exr(vv.folder / f"{seed}.exr", planes[seed])
    for c in "RGB":
        planes[2][c] = planes[2][c].copy()
        planes[2][c][11, 22] += 6
    write_exr(vv.folder / "changed.exr", planes[2])
    said = compared(vv, "1.exr", "2.exr", "--variance", "--samples", "16,16")
    assert said["same"] and said["error_bars"] and said["tests"]["pixels"] == 48 * 64
    said = compared(vv, "1.exr", "changed.exr", "--variance", "--samples", "16,16")
    assert (said["changes"][0]["x"], said["changes"][0]["y"]) == (22, 11)
    assert compared(vv, "1.exr", "changed.exr")["same"], "one pixel may be noise"


# Refusals ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("arguments, code, words", [
    ((), 2, "two pictures were expected, not 0"),
    (("a.exr", ), 2, "two pictures were expected, not 1"),
    (("a.exr", "a.exr", "a.exr"), 2, "two pictures were expected, not 3"),
    (("a.exr", "a.exr", "--spp", "4"), 2, "vv compare renders nothing: --spp cannot be used"),
    (("a.exr", "a.exr", "--samples", "16"), 2, "N,M was expected"),
    (("a.exr", "a.exr", "--samples", "16,0"), 2, "N,M was expected"),
    (("a.exr", "a.exr", "-o", "a.mp4"), 2, "one picture, not a film"),
    (("a.exr", "a.exr", "-o", "-"), 2, "-o needs a file name"),
    (("a.exr", "a.exr", "-o", "a.exr"), 1, "a picture of vv compare"),
    (("a.exr", "none.exr"), 3, "cannot read none.exr: No such file or directory"),
    (("a.exr", "none.png"), 3, "none.png"),
    (("a.exr", "text.exr"), 3, "text.exr"),
    (("a.exr", "cut.exr"), 3, "cut.exr"),
    (("a.exr", "layers.exr"), 3, "there is no channel R; it has Combined.B, Combined.G, Combined.R"),
    (("a.exr", "small.exr"), 3, "a.exr has 64x48 pixels, small.exr 32x24"),
    (("tiny.exr", "tiny.exr"), 3, "at least 8x8 were expected"),
    (("a.exr", "a.png"), 3, "a.exr has radiance, a.png colours for screens"),
    (("a.exr", "a.exr", "--variance"), 3, "a.exr has no channels variance.R, variance.G"),
])
def test_what_cannot_be_compared(vv, arguments, code, words):
    image = noise(1)
    write_exr(vv.folder / "a.exr", rgb(image))
    write_exr(vv.folder / "small.exr", rgb(noise(1, shape=(24, 32, 3))))
    write_exr(vv.folder / "tiny.exr", rgb(noise(1, shape=(7, 32, 3))))
    write_exr(vv.folder / "layers.exr", {f"Combined.{c}": image[..., 0] for c in "RGB"})
    write_png(vv.folder / "a.png", np.full((48, 64, 3), 7, np.uint8))
    (vv.folder / "text.exr").write_text("no picture")
    (vv.folder / "cut.exr").write_bytes((vv.folder / "a.exr").read_bytes()[:3000])
    before = (vv.folder / "a.exr").read_bytes()
    done = vv("compare", *arguments)
    assert done.returncode == code and words in done.talk, done.talk
    assert done.talk.count("\n") == 1 and done.text == ""
    assert (vv.folder / "a.exr").read_bytes() == before


def test_options_of_it_need_it(vv):
    for arguments, words in ((("--samples", "4,4"), "--spp N"), (("--variance", ), "vv compare")):
        done = vv("box.wrl", "-o", "a.png", *arguments)
        assert done.returncode == 2 and words in done.talk, done.talk


def test_numbers_of_hostile_files(vv):
    image = noise(1)
    image[0, 0], image[1, 1], image[2, 2], image[3, 3] = np.nan, np.inf, 3e38, -3e38
    write_exr(vv.folder / "a.exr", rgb(image))
    write_exr(vv.folder / "b.exr", rgb(noise(2)))
    said = compared(vv, "a.exr", "b.exr", "-o", "z.png")
    assert not said["same"] and not said["changes"]
    assert said["not_finite"] == said["one_sided"] == 4
    assert all(np.isfinite(said[name]) for name in ("bias", "rmse", "flip"))
