"""Tests the pictures of the program vv: formats, channels, views."""
import gzip
import json
import subprocess

import pytest
from conftest import BOX, HEADER, SMALL, exr_channels, exr_header, has_tool, read_pfm, read_ppm

# Pictures ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix, start", [("png", b"\x89PNG\r\n\x1a\n"), ("jpg", b"\xff\xd8\xff"),
                                           ("exr", b"\x76\x2f\x31\x01"), ("ppm", b"P6\n"),
                                           ("pfm", b"PF\n"), ("hdr", b"#?RADIANCE\n")])
def test_formats(vv, suffix, start):
    done = vv("box.wrl", "-o", f"out.{suffix}", *SMALL)
    assert done.returncode == 0, done.talk
    data = (vv.folder / f"out.{suffix}").read_bytes()
    assert data.startswith(start)
    assert not vv.leftovers()


def test_formats_agree(vv):
    """The picture is the same in every format: linear numbers in PFM, the sRGB curve in the 8-bit
    ones."""
    names = ["out.pfm", "out.ppm", "out.png", "out.jpg"]
    assert vv("box.wrl", *[a for n in names for a in ("-o", n)], *SMALL).returncode == 0
    width, height, linear = read_pfm((vv.folder / "out.pfm").read_bytes())
    assert (width, height) == (32, 24)
    _, _, shown = read_ppm((vv.folder / "out.ppm").read_bytes())
    curve = lambda v: 12.92 * v if v <= 0.0031308 else 1.055 * v**(1 / 2.4) - 0.055
    for row, other in zip(linear, shown):
        for pixel, byte in zip(row, other):
            assert all(abs(255 * curve(min(1, max(0, v))) - b) <= 0.51 for v, b in zip(pixel, byte))
    assert any(p[0] > 0.1 for row in linear for p in row), "a picture of the box is not black"
    image = pytest.importorskip("PIL.Image")
    flat = [p for row in shown for p in row]
    with image.open(vv.folder / "out.png") as png:
        assert png.mode == "RGB" and list(png.getdata()) == flat
    with image.open(vv.folder / "out.jpg") as jpg:
        assert jpg.size == (32, 24)
        assert sum(
            abs(a - b) for p, q in zip(jpg.getdata(), flat) for a, b in zip(p, q)) / len(flat) < 12


def test_vrml97_colours_have_no_curve(vv):
    vv.write("flat.wrl", HEADER + "Background { skyColor 0.5 0.25 0.125 }")
    assert vv("flat.wrl", "--colour", "vrml97", "-o", "out.ppm", "-o", "out.pfm",
              *SMALL).returncode == 0
    assert read_ppm((vv.folder / "out.ppm").read_bytes())[2][0][0] == (128, 64, 32)
    assert read_pfm((vv.folder / "out.pfm").read_bytes())[2][0][0] == (0.5, 0.25, 0.125)
    assert vv("flat.wrl", "-o", "out.ppm", "-o", "out.pfm", *SMALL).returncode == 0
    assert read_ppm(
        (vv.folder /
         "out.ppm").read_bytes())[2][0][0] == (128, 64,
                                               32), "unlit colours come out as they were written"
    assert abs(read_pfm((vv.folder / "out.pfm").read_bytes())[2][0][0][0] - 0.21404) < 1e-4


def test_exr_channels(vv):
    done = vv("box.wrl", "-o", "out.exr", "--channels",
              "rgba,z,normal,albedo,position,id,samples,motion", "--follow-images", "on", *SMALL)
    assert done.returncode == 0, done.talk
    data = (vv.folder / "out.exr").read_bytes()
    expected = [
        "R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "P.X",
        "P.Y", "P.Z", "id", "samples", "motion.X", "motion.Y", "motion.Z"
    ]
    assert exr_channels(data) == {name: 2 for name in expected}
    header = exr_header(data)
    assert header["compression"][1] == b"\x03", "ZIP"
    assert header["colour"][1] == b"linear"
    assert "chromaticities" in header
    names = json.loads(header["idNames"][1])
    assert "Thing" in " ".join(names.values()) or "Cube" in " ".join(names.values()), names
    if has_tool("exrheader"):
        assert subprocess.run(["exrheader", vv.folder / "out.exr"],
                              capture_output=True).returncode == 0
    assert vv("box.wrl", "-o", "plain.exr", "--colour", "vrml97", *SMALL).returncode == 0
    data = (vv.folder / "plain.exr").read_bytes()
    assert exr_channels(data) == {name: 2 for name in "RGBA"}
    assert "chromaticities" not in exr_header(data)


def test_cryptomatte_layers(vv):
    """The hash of the layer's name begins with 3ae39a5 (MurmurHash3_32 of "CryptoObject")."""
    done = vv("box.wrl", "-o", "out.exr", "--channels", "rgba,cryptomatte", *SMALL)
    assert done.returncode == 0, done.talk
    data = (vv.folder / "out.exr").read_bytes()
    layers = {f"CryptoObject{n:02}.{c}": 2 for n in range(4) for c in "RGBA"}
    assert exr_channels(data) == {**{name: 2 for name in "RGBA"}, **layers}
    header = exr_header(data)
    assert header["cryptomatte/3ae39a5/name"][1] == b"CryptoObject"
    assert header["cryptomatte/3ae39a5/hash"][1] == b"MurmurHash3_32"
    assert header["cryptomatte/3ae39a5/conversion"][1] == b"uint32_to_float32"
    manifest = json.loads(header["cryptomatte/3ae39a5/manifest"][1])
    assert manifest and all(len(digits) == 8 and int(digits, 16) for digits in manifest.values())


def test_same_bytes_for_any_number_of_threads(vv):
    for suffix in ("exr", "png"):
        pictures = []
        for threads in (1, 2, 5):
            done = vv("box.wrl", "-o", f"t{threads}.{suffix}", "--threads", threads, "--size",
                      "97x61", "--spp", 4)
            assert done.returncode == 0, done.talk
            pictures.append((vv.folder / f"t{threads}.{suffix}").read_bytes())
        assert pictures[0] == pictures[1] == pictures[2]
    other = vv("box.wrl", "-o", "seed.exr", "--seed", 7, "--size", "97x61", "--spp", 4)
    assert other.returncode == 0
    assert (vv.folder / "seed.exr").read_bytes() != (vv.folder / "t1.exr").read_bytes()


def test_standard_input_and_output(vv):
    assert vv("box.wrl", "-o", "file.png", *SMALL).returncode == 0
    png = (vv.folder / "file.png").read_bytes()
    done = vv("-", "-o", "-", *SMALL, stdin=BOX.encode())
    assert done.returncode == 0 and done.stdout == png
    assert vv("-", "-o", "-", *SMALL, stdin=gzip.compress(BOX.encode())).stdout == png
    assert vv("box.wrl", "-o", "pfm:-", *SMALL).stdout.startswith(b"PF\n32 24\n")


def test_gzip_by_any_name(vv):
    assert vv("box.wrl", "-o", "file.png", *SMALL).returncode == 0
    for name in ("a.wrz", "a.wrl.gz", "packed.wrl"):
        vv.write(name, gzip.compress(BOX.encode()))
        assert vv(name, "-o", "other.png", *SMALL).returncode == 0
        assert (vv.folder / "other.png").read_bytes() == (vv.folder / "file.png").read_bytes()


# View -------------------------------------------------------------------------------------------


def test_viewpoints(vv):
    vv.write(
        "two.wrl", HEADER + """Background { skyColor 1 1 1 }
        DEF A Viewpoint { position 0 0 5 description "red" }
        DEF B Viewpoint { position 0 0 -5 orientation 0 1 0 3.14159265 description "green side" }
        Transform { translation 0 0 1 children Shape { appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 1 0 0 } } geometry Box { } } }
        Transform { translation 0 0 -1.5 children Shape { appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 0 1 0 } } geometry Box { } } }"""
    )
    middle = lambda *a: vv.picture(*a, "--headlight", "off", world="two.wrl")[12][16]
    assert middle() == (255, 0, 0)
    for name in ("B", "green side", "1"):
        assert middle("--viewpoint", name) == (0, 255, 0)
    assert middle("--viewpoint", "0") == (255, 0, 0)
    assert middle("--camera", "0,0,-9:0,0,0:0,1,0") == (0, 255, 0)
    assert middle("--camera", "0,0,9:0,0,0") == (255, 0, 0)
    assert middle("--fit") == (255, 0, 0)
    wrong = vv("two.wrl", "-o", "x.png", "--viewpoint", "gren side")
    assert wrong.returncode == 2 and "did you mean green side?" in wrong.talk
    assert vv("two.wrl", "-o", "x.png", "--viewpoint", "2").returncode == 2
    assert not (vv.folder / "x.png").exists()


def test_all_viewpoints(vv):
    assert vv("box.wrl", "-o", "a.png", "-o", "x_{viewpoint}_y.ppm", "--viewpoint", "all",
              *SMALL).returncode == 0
    made = sorted(p.name for p in vv.folder.iterdir() if p.suffix in (".png", ".ppm"))
    assert made == ["a-Back.png", "a-front.png", "x_Back_y.ppm", "x_front_y.ppm"]


def test_world_without_viewpoint_is_fitted(vv):
    vv.write(
        "far.wrl", HEADER +
        "Transform { translation 1000 0 0 children Shape { appearance Appearance { material Material { } } geometry Sphere { radius 3 } } }"
    )
    lit = sum(p != (0, 0, 0) for row in vv.picture(world="far.wrl") for p in row)
    assert 100 < lit < 32 * 24


def test_fov(vv):
    count = lambda *a: sum(p != (0, 0, 0) for row in vv.picture(*a) for p in row)
    assert count("--fov", "20") > count() > count("--fov", "120") > 0


def test_headlight(vv):
    assert all(p == (0, 0, 0) for row in vv.picture("--headlight", "off") for p in row)
    assert vv.picture("--headlight", "on") == vv.picture()
    vv.write("dark.wrl", BOX + "NavigationInfo { headlight FALSE }\n")
    assert all(p == (0, 0, 0) for row in vv.picture(world="dark.wrl") for p in row)
    assert vv.picture("--headlight", "on", world="dark.wrl") == vv.picture()


def test_shadows(vv):
    vv.write(
        "lamp.wrl", HEADER + """NavigationInfo { headlight FALSE } Viewpoint { position 0 0 10 }
        PointLight { location 0 0 6 attenuation 1 0 0 radius 100 }
        Transform { translation 0 0 -2 children Shape { appearance Appearance { material Material { } } geometry Box { size 20 20 1 } } }
        Transform { translation 0 0 3 children Shape { appearance Appearance { material Material { } } geometry Sphere { radius .5 } } }"""
    )
    total = lambda *a: sum(p[0] for row in vv.picture(*a, world="lamp.wrl") for p in row)
    assert total("--shadows", "on") == total() < total("--shadows", "off")
