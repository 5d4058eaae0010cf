"""Tests models that do not say how to view them: which way is up, from where, in which light, on
which background."""
import json
import math
import struct
import zlib

import pytest
from conftest import BOX, HEADER, read_ppm


def mesh(low, high, colours=None):
    """Returns a box as exporters write it, an IndexedFaceSet. colours: of the faces -x +x -y +y -z
    +z."""
    points = [
        (x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])
    ]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    colour = "" if not colours else "colorPerVertex FALSE color Color { color [ %s ] }" % ", ".join(
        "%g %g %g" % c for c in colours)
    return """Shape { appearance Appearance { material Material { } } geometry IndexedFaceSet { coord Coordinate { point [ %s ] }
        coordIndex [ %s ] %s } }\n""" % (", ".join("%g %g %g" % p for p in points), " ".join(
        "%d %d %d %d -1" % f for f in faces), colour)


CUBE = mesh((1, 2, 3), (3, 4, 5))  # no axis is preferred


def info(vv, text, *arguments):
    vv.write("model.wrl", text if text.startswith("#VRML") else HEADER + text)
    done = vv("model.wrl", "--info", "--json", *arguments)
    assert done.returncode == 0, done.talk
    return json.loads(done.text)["up"]


@pytest.mark.parametrize("text, axis, reason", [
    (HEADER + "# kicad StepUp wrl exported\n" + CUBE, "z", "kicad"),
    ("#VRML V2.0 utf8 CosmoWorlds V1.0\n" + mesh((0, 0, 0), (5, 5, 1)), "y", "cosmoworlds"),
    ("\n\n# a blank line\n".join(["#VRML V2.0 utf8", CUBE]).replace("# a blank",
                                                                    "# FreeCAD"), "z", "freecad"),
    (CUBE + "# kicad is named too late\n", "y", "no sign"),
    ('WorldInfo { title "Made by OpenSCAD" }' + CUBE, "z", "openscad"),
    ("PROTO Joint [ field SFVec3f jointAxis 0 0 1 ] { Group { } }\n" + CUBE, "z", "jointAxis"),
    ("PROTO Joint [ field SFVec3f center 0 0 1 ] { Group { } }\n" + CUBE, "y", "no sign"),
    ('NavigationInfo { type [ "WALK", "ANY" ] }' + mesh((0, 0, 0), (5, 5, 1)), "y", "WALK"),
    ('NavigationInfo { type "EXAMINE" }' + mesh((1, 2, 0), (5, 5, 1)), "z", "z = 0"),
    ("Background { skyColor [ 0 0 1, 1 1 1 ] skyAngle 1.5 }" + mesh((1, 2, 0),
                                                                    (5, 5, 1)), "y", "Background"),
    ("Background { skyColor 0 0 1 }" + mesh((1, 2, 0), (5, 5, 1)), "z", "z = 0"),
    ("Shape { geometry Cone { } }" + mesh((1, 2, 0), (5, 5, 1)), "y", "Cone"),
    (mesh((1, 0, 3), (3, 4, 5)), "y", "y = 0"),
    (mesh((1, 2, 3), (30, 40, 5)), "z", "flat along z"),
    (mesh((1, 2, 3), (30, 4, 50)), "y", "flat along y"),
    (mesh((1, 2, 3), (4, 40, 50)), "y", "no sign"),
    (mesh((-1, -1, 3), (1, 1, 5)), "z", "centred"),
    (mesh((-1, 3, -1), (1, 5, 1)), "y", "centred"),
    (mesh((1, 2, 3), (5, 5, 3)), "y", "x-y plane"),
    ("", "y", "nothing is drawn"),
])
def test_which_way_is_up(vv, text, axis, reason):
    up = info(vv, text)
    assert up["axis"] == axis and reason in up["reason"], up


@pytest.mark.parametrize("low, high, axis, reason", [
    ((1, 2, 3), (4, 40, 50), "z", "an STL file"),
    ((1, 2, 3), (30, 4, 50), "z", "an STL file"),
    ((1, 2, 0), (30, 40, 5), "z", "z = 0"),
    ((1, 0, 3), (3, 4, 5), "y", "y = 0"),
    ((1, 2, 3), (5, 2, 9), "y", "x-z plane"),
    ((1, 2, 3), (5, 5, 3), "z", "an STL file"),
])
def test_z_is_up_in_stl_unless_a_sign_says_y(vv, low, high, axis, reason):
    corners = [low, (high[0], low[1], low[2]), high]
    vertices = "".join("vertex {} {} {}\n".format(*corner) for corner in corners)
    vv.write("part.stl", f"solid a\nfacet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n"
             "endsolid a\n")
    up = json.loads(vv("part.stl", "--info", "--json").text)["up"]
    assert up["axis"] == axis and reason in up["reason"], up


def test_a_model_that_cannot_be_seen_says_so(vv):
    clear = "Shape { appearance Appearance { material Material { transparency 1 } } geometry Box { } }"
    vv.write("clear.wrl", HEADER + clear + clear)
    done = vv("clear.wrl", "--check")
    assert "the material of each of the 2 Shapes has transparency 1" in done.talk, done.talk
    vv.write("clear.wrl", HEADER + clear + "Shape { geometry Sphere { } }")
    assert "transparency" not in vv("clear.wrl", "--check").talk
    vv.write("m.mtl", "newmtl a\nd 0\n")
    vv.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
    assert "the only Shape has transparency 1" in vv("m.obj", "--check").talk


def test_up_is_said(vv):
    assert info(vv, CUBE, "--up=-x") == {"axis": "-x", "reason": ""}
    assert info(vv, CUBE, "--up", "+z") == {"axis": "z", "reason": ""}
    assert info(vv, BOX) == {"axis": "y", "reason": ""}
    for wrong in ("w", "xy", "--z", "+-z"):
        done = vv("model.wrl", "--info", f"--up={wrong}")
        assert done.returncode == 2 and "x, y, z, -x, -y or -z" in done.talk, wrong


def counts(rows):
    """Returns the numbers of pixels that are mostly red, green and blue."""
    tops = [max(range(3), key=lambda c: p[c]) for row in rows for p in row if any(p)]
    return [tops.count(c) for c in range(3)]


# The upper face is blue, the front and right ones are red and green, the others white.
@pytest.mark.parametrize("up, top, front, right", [("x", 1, 5, 2), ("y", 3, 5, 1), ("z", 5, 2, 1),
                                                   ("-x", 0, 5, 3), ("-y", 2, 5, 0),
                                                   ("-z", 4, 3, 1)])
def test_three_quarters(vv, up, top, front, right):
    colours = [(1, 1, 1)] * 6
    colours[top], colours[front], colours[right] = (0, 0, 1), (1, 0, 0), (0, 1, 0)
    vv.write("cube.wrl", HEADER + mesh((10, 20, 30), (12, 22, 32), colours))
    rows = vv.picture(f"--up={up}", "--size", "64x48", world="cube.wrl")
    assert not any(min(p) > 0 for row in rows for p in row), "nothing of the other faces"
    red, green, blue = counts(rows)
    assert red > green > blue > 20, (red, green, blue)
    across = lambda c: [
        x for row in rows for x, p in enumerate(row) if p[c] > max(p[:c] + p[c + 1:])
    ]
    mean = lambda values: sum(values) / len(values)
    assert mean(across(0)) < mean(across(1)), "the front to the left"
    down = [y for y, row in enumerate(rows) for p in row if p[2] > max(p[:2])]
    assert mean(down) < 24, "the top above"


def border(rows):
    return rows[0] + rows[-1] + [p for row in rows for p in (row[0], row[-1])]


@pytest.mark.parametrize("size", ["80x48", "48x80"])
@pytest.mark.parametrize("up", ["x", "y", "z"])
@pytest.mark.parametrize("how", [("--fit",), ("--camera", "300,400,500:50,15,22", "--fit")])
def test_a_turntable_stays_in_the_window(vv, size, up, how):
    vv.write("rod.wrl", HEADER + mesh((-100, 5, 7), (200, 25, 37)))
    assert vv("rod.wrl", *how, "--up", up, "--turntable", 8, "--size", size, "--spp", 4, "-o",
              "t.ppm").returncode == 0
    widest = 0
    for number in range(8):
        rows = read_ppm((vv.folder / f"t-{number:04}.ppm").read_bytes())[2]
        assert not any(any(p) for p in border(rows)), number
        seen = [(x, y) for y, row in enumerate(rows) for x, p in enumerate(row) if any(p)]
        assert seen, number
        xs, ys = [x for x, _ in seen], [y for _, y in seen]
        widest = max(widest, max(xs) - min(xs), max(ys) - min(ys))
    assert widest >= 0.7 * 48, "and no smaller than it must be"


def test_a_turntable_goes_round_the_axis(vv):
    """The top stays in place; the sides rotate."""
    colours = [(1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 1), (0, 0, 1)]
    vv.write("part.wrl", HEADER + "# KiCad\n" + mesh((10, 20, 30), (12, 22, 31), colours))
    assert vv("part.wrl", "--turntable", 4, "--size", "48x36", "--spp", 1, "-o",
              "t.ppm").returncode == 0
    seen = [counts(read_ppm((vv.folder / f"t-{n:04}.ppm").read_bytes())[2]) for n in range(4)]
    assert all(blue > 100 and abs(blue - seen[0][2]) <= 12 for _, _, blue in seen), seen
    assert len({(red > green) for red, green, _ in seen}) == 2, seen


def test_text_is_read_from_the_front(vv):
    vv.write("text.wrl", HEADER + 'Shape { geometry Text { string "IIII" } }')
    vv.write("front.wrl", HEADER + 'Viewpoint { } Shape { geometry Text { string "IIII" } }')
    rows = vv.picture("--size", "64x48", world="text.wrl")
    lit = [sum(any(p) for p in row) for row in rows]
    full = [n for n in lit if n]
    stems = full[len(full) // 4:-(len(full) // 4)]  # between the serifs
    assert stems and max(stems) == min(stems), "columns stand upright"


def test_camera_with_fit(vv):
    """Uses the direction of --camera and the distance of --fit."""
    vv.write("cube.wrl", HEADER + mesh((10, 20, 30), (12, 22, 32), [(1, 0, 0),
                                                                    (0, 1, 0)] + [(0, 0, 1)] * 4))
    near = vv.picture("--camera", "11.5,21,31:11,21,31", "--fit", world="cube.wrl")
    assert counts(near)[1] > 100 and counts(near)[0] == counts(near)[2] == 0, "it looks along -x"
    assert near == vv.picture("--camera", "9111,21,31:11,21,31", "--fit", world="cube.wrl")
    done = vv("cube.wrl", "-o", "x.png", "--viewpoint", "0", "--fit")
    assert done.returncode == 2 and "--viewpoint" in done.talk


def faces(rows):
    """Returns the brightness of the faces of a white box, the three largest."""
    seen = {}
    for row in rows:
        for p in row:
            if any(p):
                seen[p] = seen.get(p, 0) + 1
    return sorted(sorted(seen, key=seen.get)[-3:])


def test_the_light_of_models(vv):
    vv.write("cube.wrl", HEADER + CUBE)
    shown = faces(vv.picture("--size", "64x48", world="cube.wrl"))
    lone = faces(vv.picture("--size", "64x48", "--headlight", "on", world="cube.wrl"))
    assert all(b[0] - a[0] >= 25
               for a, b in zip(shown, shown[1:])), "each face has a brightness of its own"
    assert shown[0][0] > 100 and shown[-1][0] < 255, "none is dark, none is burnt out"
    assert shown != lone and not any(
        map(any, sum(vv.picture("--headlight", "off", world="cube.wrl"), [])))


@pytest.mark.parametrize("more", [
    "NavigationInfo { }", "DirectionalLight { on FALSE }", "Viewpoint { position 2 3 14 }",
    "Transform { children PointLight { location 2 3 99 intensity 0 } }"
])
def test_worlds_that_bring_light_keep_theirs(vv, more):
    vv.write("own.wrl", HEADER + CUBE + more)
    assert vv.picture(world="own.wrl") == vv.picture("--headlight", "on", world="own.wrl")


def test_same_bytes_with_any_threads(vv):
    vv.write("cube.wrl", HEADER + CUBE)
    assert vv.picture("--threads", "1", world="cube.wrl") == vv.picture("--threads",
                                                                        "3",
                                                                        world="cube.wrl")


# --- Background ---


def read_png(data):
    """Returns width, height, components and rows of tuples of an 8-bit PNG without interlacing."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    n = {2: 3, 6: 4}[colour]
    raw, before, rows = zlib.decompress(packed), bytearray(width * n), []
    for y in range(height):
        how, line = raw[y * (width * n + 1)], bytearray(raw[y * (width * n + 1) + 1:(y + 1) *
                                                            (width * n + 1)])
        for i in range(width * n):
            a, b, c = line[i - n] if i >= n else 0, before[i], before[i - n] if i >= n else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, paeth)[how]) & 255
        before = line
        rows.append([tuple(line[n * x:n * x + n]) for x in range(width)])
    return width, height, n, rows


SKY = BOX + "Background { skyColor 0 0 1 }\n"


def png(vv, *arguments, world="sky.wrl", spp="1"):
    vv.write("sky.wrl", SKY)
    done = vv(world, "-o", "png:-", "--size", "32x24", "--spp", spp, *arguments)
    assert done.returncode == 0, done.talk
    return read_png(done.stdout)[2:]


def test_a_model_of_metal_has_a_studio_to_reflect(vv):
    ball = """#X3D V4.0 utf8
PROFILE Interchange
Shape { appearance Appearance { material PhysicalMaterial { metallic %s roughness .2 } }
  geometry Sphere {} }
"""
    vv.write("metal.x3dv", ball % "1")
    vv.write("paint.x3dv", ball % "0")
    rows = png(vv, world="metal.x3dv", spp="16")[1]
    middle = [sum(rows[y][x]) / 3 for y in (10, 12, 14) for x in (13, 16, 19)]
    assert min(middle) > 60 and max(middle) - min(middle) > 10  # not black, not flat
    assert min(rows[0][0]) > 100
    neutral = (158, 166, 173)  # decision 40
    assert png(vv, world="paint.x3dv")[1][0][0] == neutral
    assert png(vv, "--background", "black", world="metal.x3dv")[1][0][0] == (0, 0, 0)
    assert png(vv, "--colour", "vrml97", world="metal.x3dv")[1][0][0] == neutral


def test_background_none(vv):
    components, rows = png(vv, "--background", "none", spp="16")
    assert components == 4 and rows[0][0] == (0, 0, 0, 0) and rows[12][16][3] == 255
    opaque, plain = png(vv)
    assert opaque == 3 and plain[0][0] == (0, 0, 255) and plain[12][16] == rows[12][16][:3]
    inside = rows[12][16][:3]
    edge = [p for row in rows for p in row if 0 < p[3] < 255]
    assert edge and all(abs(a - b) <= 3 for p in edge if p[3] > 60
                        for a, b in zip(p[:3], inside)), "colours as of the surface"


def test_background_none_in_a_file_without_alpha(vv):
    small = ("--size", "8x8", "--spp", "1", "--background", "none")
    vv.write("sky.wrl", SKY)
    assert "only EXR and PNG files can be transparent" in vv("sky.wrl", "-o", "x.jpg", *small).talk
    assert "transparent" not in vv("sky.wrl", "-o", "x.jpg", "-o", "x.png", *small).talk


def srgb(byte):
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055)**2.4


def display(v):
    return 255 * (12.92 * v if v <= 0.0031308 else 1.055 * v**(1 / 2.4) - 0.055)


@pytest.mark.parametrize("colour, corner", [("white", (255, 255, 255)), ("#f80", (255, 136, 0)),
                                            ("#336699", (51, 102, 153)),
                                            ("0.2,0.4,1", (51, 102, 255)), ("Black", (0, 0, 0))])
def test_background_colour(vv, colour, corner):
    components, rows = png(vv, "--background", colour, spp="16")
    assert components == 3 and rows[0][0] == corner
    _, clear = png(vv, "--background", "none", spp="16")
    for row, other in zip(rows, clear):
        for p, (*c, a) in zip(row, other):  # composited over the colour in linear light
            wanted = [
                display(srgb(x) * a / 255 + srgb(y) * (1 - a / 255)) for x, y in zip(c, corner)
            ]
            assert all(abs(x - y) <= 4 for x, y in zip(p, wanted))
    assert png(vv, "--background", colour, "--colour", "vrml97")[1][0][0] == corner


def test_background_file(vv):
    """A background picture of twice the width: its middle is visible, its sides are cut off."""
    columns = [(255, 0, 0)] * 16 + [(0, 255, 0)] * 32 + [(0, 0, 255)] * 16
    raw = b"".join(b"\0" + b"".join(bytes(p) for p in columns) for _ in range(24))
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(
        ">I", zlib.crc32(kind + body))
    vv.write(
        "wide.png",
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 64, 24, 8, 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))
    components, rows = png(vv, "--background", "wide.png")
    assert components == 3 and {rows[0][0], rows[0][-1], rows[-1][0], rows[-1][-1]} == {(0, 255, 0)}
    assert rows[12][16] == png(vv)[1][12][16]


@pytest.mark.parametrize("wrong, word", [("whit", "colour"), ("#12", "colour"), ("1,2,3", "0 to 1"),
                                         ("1,1", "colour"), ("#gggggg", "colour"),
                                         ("0.5,0.5,nan", "colour")])
def test_wrong_backgrounds(vv, wrong, word):
    done = vv("box.wrl", "-o", "x.png", f"--background={wrong}")
    assert done.returncode == 2 and "--background" in done.talk and word in done.talk
    missing = vv("box.wrl", "-o", "x.png", "--background", "missing.png")
    assert missing.returncode == 3
    assert missing.talk == "vv: error: --background: cannot read missing.png: No such file or directory\n"


def test_background_keeps_fog(vv):
    vv.write("fog.wrl", BOX + "Fog { color 0 1 0 visibilityRange 8 } Background { skyColor 0 0 1 }")
    _, plain = png(vv, world="fog.wrl")
    _, clear = png(vv, "--background", "none", world="fog.wrl")
    assert clear[12][16][:3] == plain[12][16] and clear[0][0][3] == 0
    assert math.isclose(plain[12][16][1], clear[12][16][1]) and plain[12][16][1] > 100
