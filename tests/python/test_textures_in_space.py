"""Textures in space (ISO/IEC 19775-1 clause 33) in pictures: files, encodings, exports, and the same
bytes for any number of threads."""
import gzip
import struct

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = ("#X3D V4.0 utf8\nPROFILE Full\nNavigationInfo { headlight FALSE }\n"
        "OrthoViewpoint { position 0 0 10 fieldOfView [ -1 -1 1 1 ] }\n")
# A square of the view's size. Its place in the volume is (x, y, 1/2) of 0 to 1.
SQUARE = """geometry IndexedFaceSet { coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
  coordIndex [ 0 1 2 3 -1 ]
  texCoord TextureCoordinate3D { point [ 0 0 .5, 1 0 .5, 1 1 .5, 0 1 .5 ] } }"""
N = 4  # pixels along a side of volume and picture
VALUES = np.arange(N**3, dtype=np.uint8).reshape(N, N, N) * 4  # by r, t, s


def nrrd(values, kind="uchar", encoding="raw"):
    head = (f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {N} {N} {N}\nendian: little\n"
            f"encoding: {encoding}\n\n").encode()
    if encoding == "ascii":
        return head + " ".join(str(v) for v in values.ravel()).encode()
    return head + (gzip.compress(values.tobytes(), mtime=0) if encoding == "gzip" else values.tobytes())


def dds(values):
    words = (124, 0x801007, N, N, 0, N, 0)
    head = (b"DDS " + struct.pack("<7I", *words)).ljust(76, b"\0")
    head += struct.pack("<8I", 32, 0x20000, 0, 8, 255, 0, 0, 0) + struct.pack("<5I", 0x1008, 0x200000, 0, 0, 0)
    return head + values[:, ::-1].tobytes()  # rows from the top


def shown(folder, name, data, **options):
    """Returns the picture of a volume in a file, as numbers of the file, rows from the bottom."""
    (folder / name).write_bytes(data)
    (folder / "world.x3dv").write_text(
        HEAD + f"Shape {{ appearance Appearance {{ texture ImageTexture3D {{ url \"{name}\" }} }} {SQUARE} }}")
    world = xvrml.load(str(folder / "world.x3dv"))
    assert not world.warnings
    return np.asarray(world.render(size=(N, N), spp=1, transport="direct", **options))


def test_files_show_the_same_volume(tmp_path):
    """The middle of r lies between the two middle slices."""
    files = {
        "raw.nrrd": nrrd(VALUES),
        "gzip.nrrd": nrrd(VALUES, encoding="gzip"),
        "ascii.nrrd": nrrd(VALUES, encoding="ascii"),
        "scaled.nrrd": nrrd((VALUES / VALUES.max() * 60000 - 30000).astype("<i2"), "short"),
        "volume.dds": dds(VALUES),
    }
    pictures = {name: shown(tmp_path, name, data) for name, data in files.items()}
    assert pictures["raw.nrrd"].shape[:2] == (N, N)
    for name in ("gzip.nrrd", "ascii.nrrd", "volume.dds"):
        assert np.array_equal(pictures[name], pictures["raw.nrrd"]), name
    rows = pictures["raw.nrrd"][::-1, :, 0]  # linear light
    codes = np.where(rows <= 0.0031308, 12.92 * rows, 1.055 * np.maximum(rows, 0)**(1 / 2.4) - 0.055) * 255
    assert (np.diff(codes, axis=0) > 8).all() and (np.diff(codes, axis=1) > 2).all()
    # Codes are decoded before they are mixed, so the mean is a little above that of the codes.
    mean = (VALUES[1].astype(float) + VALUES[2]) / 2
    assert (codes > mean - 4).all() and (codes < mean + 12).all(), codes - mean
    assert pictures["scaled.nrrd"][..., 0].max() > pictures["raw.nrrd"][..., 0].max() * 0.9


def test_threads_give_the_same_bytes(tmp_path):
    one = shown(tmp_path, "a.nrrd", nrrd(VALUES), threads=1)
    assert np.array_equal(one, shown(tmp_path, "a.nrrd", nrrd(VALUES), threads=3))


def test_every_encoding_shows_the_same_picture(vv):
    vv.write("a.x3dv", HEAD + "Shape { appearance Appearance { texture PixelTexture3D { image [ 3 1 1 2 0xFF0000 "
             "0x0000FF ] } textureTransform TextureTransform3D { translation 0 0 .1 } } " + SQUARE + " }")
    one = vv.picture(world="a.x3dv")
    for suffix in ("x3d", "json", "x3dv", "wrl"):
        assert vv("a.x3dv", "--write", f"b.{suffix}").returncode == 0
        assert np.array_equal(one, vv.picture(world=f"b.{suffix}")), suffix


def test_exports_say_what_they_leave_out(vv):
    vv.write("a.x3dv", HEAD + "Shape { appearance Appearance { texture PixelTexture3D { image [ 1 1 1 2 0 255 ] } } "
             + SQUARE + " }")
    for suffix in ("gltf", "obj"):
        said = vv("a.x3dv", "--write", f"a.{suffix}").stderr.decode()
        assert "PixelTexture3D" in said, suffix
