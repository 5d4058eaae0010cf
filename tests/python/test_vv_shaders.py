"""Tests vv and shaders: --shader, --list-shaders, --transport and its messages, HDR emission."""
import json
import re
import struct

import pytest

from conftest import HEADER, ROOT, SMALL

WORLD = HEADER + """
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 5 }
DEF Group Transform { children [
  DEF Wall Shape { appearance DEF Paint Appearance { material DEF M Material { emissiveColor 0 1 0 } }
    geometry IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, -9 9 0 ] } coordIndex [ 0 1 2 3 -1 ] } } ] }
"""


@pytest.fixture
def wall(vv):
    vv.write("wall.wrl", WORLD)
    return vv


def middle(rows):
    return rows[len(rows) // 2][len(rows[0]) // 2]


@pytest.mark.parametrize("target", ["Group", "Wall", "Paint", "M", "*"])
def test_a_shader_for_whatever_shapes_hang_on(wall, target):
    assert middle(wall.picture(world="wall.wrl")) == (0, 255, 0)
    assert middle(wall.picture("--shader", target + "=Diffuse:emission=0,0,1",
                               world="wall.wrl")) == (0, 0, 255)
    # a parameter that the material sets, of a class that knows it
    assert middle(wall.picture("--shader", target + "=VRML97:diffuseColor=1",
                               world="wall.wrl")) == (0, 255, 0)


def test_later_ones_win_and_single_numbers_are_grey(wall):
    both = ("--shader", "*=Diffuse:emission=0,0,1", "--shader", "Paint=diffuse/Diffuse:emission=1")
    assert middle(wall.picture(*both, world="wall.wrl")) == (255, 255, 255)


def test_it_can_be_written(wall):
    wall("wall.wrl", "--shader", "Wall=Glass:index=1.25", "--write", "out.wrl")
    text = (wall.folder / "out.wrl").read_text()
    assert '"1f index 1.25"' in text and "DEF Paint ORTAppearance" in text
    assert wall("out.wrl", "--check").returncode == 0


@pytest.mark.parametrize("shader, words", [
    ("Wall", "SELECTOR=CLASS"),
    ("Wal=Glass", "did you mean Wall?"),
    ("Wall=", "shader class was expected"),
    ("Wall=Nothing", "error: --shader Nothing: there is no shader class \"Nothing\"; looked in"),
    ("Wall=Glas", "there is no shader class \"Glas\"; did you mean Glass? vv --list-shaders"),
    ("Wall=PerspectiveCamera", "PerspectiveCamera is a shader for a camera"),
    ("Wall=Glass:indx=1", "did you mean index?"),
    ("Wall=Glass:index", "PARAM=VALUE"),
    ("Wall=Glass:index=glassy", "numbers"),
    ("Wall=Glass:index=1,2", "1 number was"),
    ("Wall=Glass:index=1000", "out of range"),
    ("Wall=Glass:shadow=.5", "shadow"),
    ("Wall=../../x/Glass", "bare name"),
])
def test_what_is_wrong_with_a_shader(wall, shader, words):
    done = wall("wall.wrl", "-o", "x.png", "--shader", shader, *SMALL)
    assert done.returncode == 2 and words in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1


def test_textures_are_files_of_the_users(wall):
    import struct, zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(
            ">I", zlib.crc32(kind + data))

    red = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
        ">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(b"\0\xff\0\0")) + chunk(
            b"IEND", b"")
    wall.write("50% red.png", red)
    for path in ("50% red.png", wall.folder / "50% red.png"):
        rows = wall.picture("--shader", f"*=VRML97:lit=0:texture={path}", world="wall.wrl")
        assert middle(rows) == (255, 0, 0)


def test_light_of_more_than_one(wall):
    done = wall("wall.wrl", "-o", "x.pfm", "--shader", "*=Diffuse:emission=12.5", *SMALL)
    assert done.returncode == 0, done.talk
    import struct
    data = (wall.folder / "x.pfm").read_bytes()
    values = struct.unpack("<%df" % (32 * 24 * 3), data[-32 * 24 * 12:])
    assert max(values) == 12.5


def test_another_camera_at_the_same_place(vv):
    vv.write(
        "sky.wrl", HEADER + "NavigationInfo { headlight FALSE } Viewpoint { }\n"
        "Background { skyColor [ 0 0 1, 0 0 1, 1 0 0, 1 0 0 ] skyAngle [ 1.5, 1.6, 3.14 ] }")
    rows = vv.picture("--camera-shader", "Panorama", world="sky.wrl")
    assert {p for p in rows[0] + rows[8]} == {(0, 0, 255)} and {p for p in rows[-1] + rows[15]
                                                               } == {(255, 0, 0)}
    assert vv.picture("--camera-shader", "ThinLens:focus=3",
                      world="sky.wrl") == vv.picture(world="sky.wrl")
    for wrong in ("Glass", "ThinLense", "ThinLens:radius=-1"):
        assert vv("sky.wrl", "-o", "x.png", "--camera-shader", wrong).returncode == 2


def environment(width, height, colour):
    import struct
    return b"PF\n%d %d\n-1.0\n" % (width, height) + b"".join(
        struct.pack("<3f", *colour(x, y)) for y in range(height) for x in range(width))


def test_light_from_all_around(vv):
    vv.write(
        "empty.wrl",
        HEADER + "NavigationInfo { headlight FALSE } Viewpoint { } Background { skyColor 1 0 1 }")
    # Straight ahead is the middle of the map.
    vv.write("a.pfm", environment(8, 4, lambda x, y: (0, 1, 0) if 2 <= x < 6 else (0, 0, 1)))
    assert middle(vv.picture("--environment", "a.pfm", world="empty.wrl")) == (0, 255, 0)
    assert middle(vv.picture("--environment", "a.pfm", "--camera", "0,0,0:0,0,1",
                             world="empty.wrl")) == (0, 0, 255)
    half = middle(vv.picture("--environment", "a.pfm:0.5", world="empty.wrl"))
    assert half[1] == 188 and half[0] == half[2] == 0
    row = lambda bright: bytes([2, 2, 0, 8]) + bytes([136, bright]) + bytes([136, 0]) * 2 + bytes(
        [136, 129])
    vv.write("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + row(127) * 4)
    red = middle(vv.picture("--environment", "a.hdr", world="empty.wrl"))
    assert red[0] == 255 and red[1] < 20
    # OpenEXR, with its first row at the top
    vv.write(
        "halves.wrl", HEADER + "NavigationInfo { headlight FALSE } Viewpoint { } "
        "Background { skyColor 0 1 0 groundColor [ 0 0 1, 0 0 1 ] groundAngle 1.570796 }")
    assert vv("halves.wrl", "-o", "sky.exr", "--size", "8x4", "--spp", "1").returncode == 0
    vv.write("nothing.wrl", HEADER)
    assert middle(
        vv.picture("--environment", "sky.exr", "--camera", "0,0,0:0,1,0:0,0,1",
                   world="nothing.wrl")) == (0, 255, 0)
    assert middle(
        vv.picture("--environment",
                   "sky.exr",
                   "--camera",
                   "0,0,0:0,-1,0:0,0,1",
                   world="nothing.wrl")) == (0, 0, 255)
    # The environment lights objects
    vv.write(
        "ball.wrl", HEADER +
        "NavigationInfo { headlight FALSE } Viewpoint { position 0 0 3 } Shape { appearance Appearance { "
        "material Material { diffuseColor 1 1 1 } } geometry Sphere { } }")
    vv.write("white.pfm", environment(8, 4, lambda x, y: (.5, .5, .5)))
    lit = middle(
        vv.picture("--environment",
                   "white.pfm",
                   "--transport",
                   "path",
                   "--spp",
                   "64",
                   world="ball.wrl"))
    assert all(abs(c - 188) < 6 for c in lit)
    # The transport that "auto" chooses.
    assert middle(vv.picture("--environment", "white.pfm", "--spp", "64", world="ball.wrl")) == lit


def test_skies_that_worlds_name(vv):
    """The picture is the same as with --environment, for each format. Also a Background, and a
    texture with values above 1."""
    start = HEADER + "NavigationInfo { headlight FALSE } Viewpoint { position 0 0 3 } "
    ball = "Shape { appearance Appearance { material Material { diffuseColor 1 1 1 } } geometry Sphere { } }"
    vv.write("plain.wrl", start + ball)
    vv.write("sky.pfm", environment(8, 4, lambda x, y: (2 * x, y, 1)))
    vv.write("empty.wrl", HEADER)
    run = vv("empty.wrl", "-o", "sky.exr", "--environment", "sky.pfm", "--camera-shader",
             "Panorama", "--size", "16x8", "--spp", "1")
    assert run.returncode == 0, run.talk
    row = lambda bright: bytes([2, 2, 0, 8]) + bytes([136, bright]) + bytes([136, 0]) * 2 + bytes(
        [136, 129])
    vv.write("sky.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + row(127) * 4)
    for name in ("sky.pfm", "sky.hdr", "sky.exr"):
        shader = f'ORTShader {{ name "EnvironmentMap" file "environmentmap" options "texture texture {name}" }}'
        vv.write("named.wrl", start + ball + f" ORTBackground {{ shader {shader} }}")
        pictures = []
        for world, more in (("named.wrl", ()), ("plain.wrl", ("--environment", name))):
            done = vv(world, "-o", f"{world}.pfm", "--spp", "4", *more, *SMALL)
            assert done.returncode == 0 and "warning" not in done.talk, done.talk
            pictures.append((vv.folder / f"{world}.pfm").read_bytes())
        assert pictures[0] == pictures[1], name
    vv.write("five.pfm", environment(2, 2, lambda x, y: (5, 5, 5)))
    vv.write(
        "front.wrl", HEADER +
        'NavigationInfo { headlight FALSE } Viewpoint { } Background { frontUrl "five.pfm" }')
    vv.write(
        "texture.wrl", start +
        'Shape { appearance Appearance { texture ImageTexture { url "five.pfm" } } geometry Sphere { } }'
    )
    for world in ("front.wrl", "texture.wrl"):
        assert vv(world, "-o", "x.pfm", *SMALL).returncode == 0
        texels = (vv.folder / "x.pfm").read_bytes()[-32 * 24 * 12:]
        assert struct.unpack_from("<3f", texels, (12 * 32 + 16) * 12) == (5, 5, 5), world


@pytest.mark.parametrize("name, content", [
    ("none.pfm", None),
    ("empty.pfm", b""),
    ("short.pfm", b"PF\n8 4\n-1.0\nxxx"),
    ("huge.pfm", b"PF\n99999 99999\n-1.0\n"),
    ("nan.pfm", b"PF\n1 1\n-1.0\n\0\0\xc0\x7f" + b"\0" * 8),
    ("grey.pfm", b"Pf\n1 1\n-1.0\n\0\0\0\0"),
    ("text.hdr", b"hello\n"),
    ("short.hdr", b"#?RADIANCE\n\n-Y 4 +X 8\n\2\2\0\x08\x88"),
    ("run.hdr", b"#?RADIANCE\n\n-Y 1 +X 8\n\2\2\0\x08\xff\1"),
    ("a.txt", b"x"),
    ("text.exr", b"hello"),
])
def test_bad_pictures_of_radiance(vv, name, content):
    if content is not None:
        vv.write(name, content)
    done = vv("box.wrl", "-o", "x.png", "--environment", name, *SMALL)
    assert done.returncode == 3 and len(done.talk.splitlines()) == 1, done.talk
    assert done.talk.startswith(f"vv: error: --environment: cannot read {name}: "), done.talk
    assert done.talk.count(name) == 1, done.talk


def test_list_shaders(vv):
    text = vv("--list-shaders").text
    for name in ("VRML97 (surface", "ThinLens (camera", "Panorama (camera", "Glass (surface",
                 "VRML97Environment (environment"):
        assert name in text
    classes = {c["name"]: c for c in json.loads(vv("--list-shaders", "--json").text)["shaders"]}
    glass = classes["Glass"]
    assert glass["library"] == "glass" and glass["kind"] == "surface" and glass["text"]
    index = {p["name"]: p for p in glass["parameters"]}["index"]
    assert index["type"] == "float" and index[
        "default"] == 1.5 and index["minimum"] < 1 < index["maximum"] and index["text"]
    assert len(classes) >= 14


def test_a_bad_plug_in_is_named(vv):
    (vv.folder / "shaders").mkdir(mode=0o755)
    (vv.folder / "shaders/bad.so").write_text("no library")
    done = vv("--list-shaders", "--shader-path", vv.folder / "shaders")
    assert done.returncode == 0 and "bad.so" in done.talk and "Glass" in done.text


@pytest.mark.parametrize("name", ["direct", "whitted", "path"])
def test_transport_in_the_statistics(wall, name):
    done = wall("wall.wrl", "-o", "x.png", "--stats", "-", "--transport", name, "--depth", "3",
                *SMALL)
    transport = json.loads(done.text)["transport"]
    assert transport["chosen"] == name and transport["claim"] and transport["reason"]
    explained = json.loads(wall("wall.wrl", "--explain", "--json", "--transport", name).text)
    assert explained["transport"]["chosen"] == name and explained["objects"]
    assert wall("wall.wrl", "--explain", "--transport", name).text.startswith("transport " + name)


def test_a_clamp_is_part_of_the_claim(wall):
    done = wall("wall.wrl", "-o", "x.pfm", "--stats", "-", "--shader", "*=Diffuse:emission=12.5",
                "--clamp", "2", *SMALL)
    assert "clamped to 2" in json.loads(done.text)["transport"]["claim"]


def test_what_the_engine_says_is_heard(vv):
    vv.write(
        "lamp.wrl", HEADER +
        "Viewpoint { } Shape { geometry Sphere { } }\nORTLight { shader ORTShader { name \"Luminaire\" file "
        "\"luminaire\" options \"string profile 'no profile'\" } }")
    done = vv("lamp.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0 and "Luminaire" in done.talk and "warning" in done.talk
    assert vv("lamp.wrl", "-o", "y.png", "--strict", *SMALL).returncode == 4


# Light paths bring the noise of the room. Those of the headlight bring its light, but not its noise.
@pytest.mark.parametrize("name, several", [("interior", True), ("headlight", False)])
def test_how_many_light_paths(vv, name, several):
    world = ROOT / f"examples/scenes/{name}.wrl"
    done = vv(world, "-o", "x.png", "--stats", "-", "--size", "48x32", "--spp", "16")
    reason = json.loads(done.text)["transport"]["reason"]
    assert (re.search(", x[248] light", reason) is not None) == several, reason
