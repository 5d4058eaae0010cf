"""The program vv on the command line: pictures, exit codes, messages, interrupts, lists."""
import errno
import gzip
import json
import os
import signal
import stat
import subprocess
import time

import pytest
from conftest import BOX, exr_channels, exr_header, find_vv, has_tool, read_pfm, read_ppm

SMALL = ("--size", "32x24", "--spp", "1")
HEADER = "#VRML V2.0 utf8\n"


def write(vv, name, text):
    path = vv.folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def leftovers(vv):
    return [p.name for p in vv.folder.iterdir() if p.name.startswith(".vv-")]


# Pictures -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix, start", [("png", b"\x89PNG\r\n\x1a\n"), ("jpg", b"\xff\xd8\xff"), ("exr", b"\x76\x2f\x31\x01"),
                                           ("ppm", b"P6\n"), ("pfm", b"PF\n")])
def test_formats(vv, suffix, start):
    done = vv("box.wrl", "-o", f"out.{suffix}", *SMALL)
    assert done.returncode == 0, done.talk
    data = (vv.folder / f"out.{suffix}").read_bytes()
    assert data.startswith(start)
    assert not leftovers(vv)


def test_formats_agree(vv):
    """The same picture in every format: linear numbers in PFM, the sRGB curve in the 8 bit ones."""
    names = ["out.pfm", "out.ppm", "out.png", "out.jpg"]
    assert vv("box.wrl", *[a for n in names for a in ("-o", n)], *SMALL).returncode == 0
    width, height, linear = read_pfm((vv.folder / "out.pfm").read_bytes())
    assert (width, height) == (32, 24)
    _, _, shown = read_ppm((vv.folder / "out.ppm").read_bytes())
    curve = lambda v: 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055
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
        assert sum(abs(a - b) for p, q in zip(jpg.getdata(), flat) for a, b in zip(p, q)) / len(flat) < 12


def test_vrml97_colours_have_no_curve(vv):
    write(vv, "flat.wrl", HEADER + "Background { skyColor 0.5 0.25 0.125 }")
    assert vv("flat.wrl", "--colour", "vrml97", "-o", "out.ppm", "-o", "out.pfm", *SMALL).returncode == 0
    assert read_ppm((vv.folder / "out.ppm").read_bytes())[2][0][0] == (128, 64, 32)
    assert read_pfm((vv.folder / "out.pfm").read_bytes())[2][0][0] == (0.5, 0.25, 0.125)
    assert vv("flat.wrl", "-o", "out.ppm", "-o", "out.pfm", *SMALL).returncode == 0
    assert read_ppm((vv.folder / "out.ppm").read_bytes())[2][0][0] == (128, 64, 32), "unlit colours come out as they were written"
    assert abs(read_pfm((vv.folder / "out.pfm").read_bytes())[2][0][0][0] - 0.21404) < 1e-4


def test_exr_channels(vv):
    done = vv("box.wrl", "-o", "out.exr", "--channels", "rgba,z,normal,albedo,position,id,samples", *SMALL)
    assert done.returncode == 0, done.talk
    data = (vv.folder / "out.exr").read_bytes()
    expected = ["R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "P.X", "P.Y", "P.Z", "id", "samples"]
    assert exr_channels(data) == {name: 2 for name in expected}
    header = exr_header(data)
    assert header["compression"][1] == b"\x03", "ZIP"
    assert header["colour"][1] == b"linear"
    assert "chromaticities" in header
    names = json.loads(header["idNames"][1])
    assert "Thing" in " ".join(names.values()) or "Cube" in " ".join(names.values()), names
    if has_tool("exrheader"):
        assert subprocess.run(["exrheader", vv.folder / "out.exr"], capture_output=True).returncode == 0
    assert vv("box.wrl", "-o", "plain.exr", "--colour", "vrml97", *SMALL).returncode == 0
    data = (vv.folder / "plain.exr").read_bytes()
    assert exr_channels(data) == {name: 2 for name in "RGBA"}
    assert "chromaticities" not in exr_header(data)


def test_same_bytes_for_any_number_of_threads(vv):
    for suffix in ("exr", "png"):
        pictures = []
        for threads in (1, 2, 5):
            done = vv("box.wrl", "-o", f"t{threads}.{suffix}", "--threads", threads, "--size", "97x61", "--spp", 4)
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
        write(vv, name, gzip.compress(BOX.encode()))
        assert vv(name, "-o", "other.png", *SMALL).returncode == 0
        assert (vv.folder / "other.png").read_bytes() == (vv.folder / "file.png").read_bytes()


# View -----------------------------------------------------------------------------------------------------------------


def picture(vv, *arguments, world="box.wrl"):
    done = vv(world, "-o", "ppm:-", *SMALL, *arguments)
    assert done.returncode == 0, done.talk
    return read_ppm(done.stdout)[2]


def test_viewpoints(vv):
    write(vv, "two.wrl", HEADER + """Background { skyColor 1 1 1 }
        DEF A Viewpoint { position 0 0 5 description "red" }
        DEF B Viewpoint { position 0 0 -5 orientation 0 1 0 3.14159265 description "green side" }
        Transform { translation 0 0 1 children Shape { appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 1 0 0 } } geometry Box { } } }
        Transform { translation 0 0 -1.5 children Shape { appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 0 1 0 } } geometry Box { } } }""")
    middle = lambda *a: picture(vv, *a, "--headlight", "off", world="two.wrl")[12][16]
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
    assert vv("box.wrl", "-o", "a.png", "-o", "x_{viewpoint}_y.ppm", "--viewpoint", "all", *SMALL).returncode == 0
    made = sorted(p.name for p in vv.folder.iterdir() if p.suffix in (".png", ".ppm"))
    assert made == ["a-Back.png", "a-front.png", "x_Back_y.ppm", "x_front_y.ppm"]


def test_world_without_viewpoint_is_fitted(vv):
    write(vv, "far.wrl", HEADER + "Transform { translation 1000 0 0 children Shape { appearance Appearance { material Material { } } geometry Sphere { radius 3 } } }")
    lit = sum(p != (0, 0, 0) for row in picture(vv, world="far.wrl") for p in row)
    assert 100 < lit < 32 * 24


def test_fov(vv):
    count = lambda *a: sum(p != (0, 0, 0) for row in picture(vv, *a) for p in row)
    assert count("--fov", "20") > count() > count("--fov", "120") > 0


def test_headlight(vv):
    assert all(p == (0, 0, 0) for row in picture(vv, "--headlight", "off") for p in row)
    assert picture(vv, "--headlight", "on") == picture(vv)
    write(vv, "dark.wrl", BOX + "NavigationInfo { headlight FALSE }\n")
    assert all(p == (0, 0, 0) for row in picture(vv, world="dark.wrl") for p in row)
    assert picture(vv, "--headlight", "on", world="dark.wrl") == picture(vv)


def test_shadows(vv):
    write(vv, "lamp.wrl", HEADER + """NavigationInfo { headlight FALSE } Viewpoint { position 0 0 10 }
        PointLight { location 0 0 6 attenuation 1 0 0 radius 100 }
        Transform { translation 0 0 -2 children Shape { appearance Appearance { material Material { } } geometry Box { size 20 20 1 } } }
        Transform { translation 0 0 3 children Shape { appearance Appearance { material Material { } } geometry Sphere { radius .5 } } }""")
    total = lambda *a: sum(p[0] for row in picture(vv, *a, world="lamp.wrl") for p in row)
    assert total("--shadows", "on") == total() < total("--shadows", "off")


# Exit codes and messages ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("arguments, word", [
    ([], "world"),
    (["box.wrl"], "window"),
    (["box.wrl", "--no-such-thing"], "--no-such-thing"),
    (["box.wrl", "--veiwpoint", "1", "-o", "x.png"], "did you mean --viewpoint?"),
    (["box.wrl", "--sise=3x3", "-o", "x.png"], "did you mean --size?"),
    (["box.wrl", "-o", "x.gif"], "exr, png, jpg"),
    (["box.wrl", "-o", "x"], "suffix"),
    (["box.wrl", "-o"], "-o: a value was expected"),
    (["box.wrl", "-o", "x.png", "--size", "640"], "640x480"),
    (["box.wrl", "-o", "x.png", "--size", "0x10"], "640x480"),
    (["box.wrl", "-o", "x.png", "--size", "65536x65536"], "2^28"),
    (["box.wrl", "-o", "x.png", "--size", "10x10x10"], "640x480"),
    (["box.wrl", "-o", "x.png", "--spp", "0"], "1 to 65536"),
    (["box.wrl", "-o", "x.png", "--spp", "4k"], "whole number"),
    (["box.wrl", "-o", "x.png", "--spp", "1e3"], "whole number"),
    (["box.wrl", "-o", "x.png", "--spp", "99999999999999999999"], "whole number"),
    (["box.wrl", "-o", "x.png", "--depth", "-1"], "0 to 10000"),
    (["box.wrl", "-o", "x.png", "--seed", "x"], "whole number"),
    (["box.wrl", "-o", "x.png", "--threads", "-3"], "0 to 1024"),
    (["box.wrl", "-o", "x.png", "--fov", "180"], "between 0 and 180"),
    (["box.wrl", "-o", "x.png", "--fov", "nan"], "between 0 and 180"),
    (["box.wrl", "-o", "x.png", "--shadows", "maybe"], "on or off"),
    (["box.wrl", "-o", "x.png", "--headlight", "dim"], "on, off or auto"),
    (["box.wrl", "-o", "x.png", "--colour", "srgb"], "linear or vrml97"),
    (["box.wrl", "-o", "x.png", "--camera", "1,2:3,4"], "px,py,pz"),
    (["box.wrl", "-o", "x.png", "--camera", "1,2,3:1,2,3"], "same point"),
    (["box.wrl", "-o", "x.png", "--camera", "1,2,3:0,0,0", "--fit"], "only one of"),
    (["box.wrl", "-o", "x.png", "--channels", "rgba,depth"], "rgba,z,normal"),
    (["box.wrl", "-o", "x.png", "--limit", "nestin=5"], "did you mean nesting?"),
    (["box.wrl", "-o", "x.png", "--limit", "nesting"], "NAME=VALUE"),
    (["box.wrl", "-o", "x.png", "--limit", "nesting=-1"], "count"),
    (["box.wrl", "other.wrl", "-o", "x.png"], "one world at a time"),
    (["box.wrl", "-o", "-", "--stats", "-"], "standard output"),
    (["box.wrl", "--check", "-o", "x.png"], "--check"),
    (["box.wrl", "--stats", "s.json"], "-o"),
    (["box.wrl", "-o", "x.png", "--json"], "--json"),
    (["box.wrl", "-q", "-v", "-o", "x.png"], "--quiet"),
])
def test_usage(vv, arguments, word):
    done = vv(*arguments)
    assert done.returncode == 2, (done.returncode, done.talk)
    assert done.stdout == b""
    lines = done.talk.splitlines()
    assert len(lines) == 1 and lines[0].startswith("vv: error: ") and word in lines[0], done.talk
    assert not (vv.folder / "x.png").exists()


def test_help_and_version(vv):
    done = vv("--help")
    assert done.returncode == 0 and done.talk == ""
    for option in ("--output", "--size", "--viewpoint", "--camera", "--fit", "--fov", "--headlight", "--spp", "--depth", "--shadows",
                   "--seed", "--threads", "--colour", "--stats", "--check", "--strict", "--info", "--list-nodes", "--list-viewpoints",
                   "--json", "--write", "--channels", "--limit", "--allow-absolute", "--record", "--shader-path", "--quiet",
                   "--verbose", "--version"):
        assert option in done.text
    assert max(map(len, done.text.splitlines())) <= 130
    assert vv("-h").text == done.text
    version = vv("--version")
    assert version.returncode == 0 and version.text.startswith("vv ")


@pytest.mark.parametrize("content, place, words", [
    (None, "", "missing.wrl"),
    ("", "", "world.wrl"),
    ("hello world\n", "world.wrl", "VRML"),
    ("#VRML V1.0 ascii\nSeparator { }\n", "world.wrl", "VRML 1.0"),
    (b"\x89PNG\r\n\x1a\n\0\0\0\0", "world.wrl", "VRML"),
    (b"\x1f\x8b\x08\0broken", "world.wrl", ""),
])
def test_unusable_input(vv, content, place, words):
    name = "missing.wrl"
    if content is not None:
        name = "world.wrl"
        write(vv, name, content)
    done = vv(name, "-o", "x.png", *SMALL)
    assert done.returncode == 3, (done.returncode, done.talk)
    assert "error" in done.talk and place in done.talk and words in done.talk
    assert not (vv.folder / "x.png").exists()


def test_folder_as_input(vv):
    assert vv(".", "-o", "x.png").returncode == 3


FAULTY = HEADER + """Shape {
  geometry Box { sise 1 2 3 }
}
Shape { geometry Sphere { radius "big" } }
Shape { appearance Appearance { material Material { } } geometry Box { } }
"""


def test_problems_have_places(vv):
    write(vv, "faulty.wrl", FAULTY)
    done = vv("faulty.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0, "the rest of the file is drawn"
    assert "faulty.wrl:3:18: error: " in done.talk and "faulty.wrl:5:" in done.talk
    lines = done.talk.splitlines()
    at = next(i for i, line in enumerate(lines) if ":3:18:" in line)
    assert "sise" in lines[at + 1] and lines[at + 2].strip() == "^", "the source line and a caret"
    assert lines[at + 2].index("^") == lines[at + 1].index("sise")
    assert (vv.folder / "x.png").exists()


def test_check_and_strict(vv):
    write(vv, "faulty.wrl", FAULTY)
    assert vv("box.wrl", "--check").returncode == 0
    done = vv("faulty.wrl", "--check")
    assert done.returncode == 4 and "faulty.wrl:3:18: error: " in done.talk and done.text == ""
    strict = vv("faulty.wrl", "--strict", "-o", "x.png", *SMALL)
    assert strict.returncode == 4 and not (vv.folder / "x.png").exists()
    assert vv("box.wrl", "--strict", "-o", "x.png", *SMALL).returncode == 0


def test_missing_texture_and_plugin(vv):
    write(vv, "texture.wrl", HEADER + 'Shape { appearance Appearance { material Material { } texture ImageTexture { url "no.png" } } geometry Box { } }')
    write(vv, "plugin.wrl", HEADER + 'Shape { appearance ORTAppearance { shader ORTShader { name "X" file "nosuchlibrary" } } geometry Box { } }')
    for name in ("texture.wrl", "plugin.wrl"):
        done = vv(name, "-o", "x.png", *SMALL)
        assert done.returncode == 0 and f"{name}:2:" in done.talk, done.talk
        os.unlink(vv.folder / "x.png")
        done = vv(name, "--strict", "-o", "x.png", *SMALL)
        assert done.returncode == 5 and not (vv.folder / "x.png").exists(), done.talk
    assert vv("texture.wrl", "--check").returncode == 4


def test_many_problems_are_counted(vv):
    write(vv, "many.wrl", HEADER + "Box { sise 1 }\n" * 300)
    done = vv("many.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0
    assert done.talk.count("error:") <= 60 and "more" in done.talk
    assert vv("many.wrl", "-v", "-o", "x.png", *SMALL).talk.count("error:") == 300


def test_control_characters_do_not_reach_the_terminal(vv):
    write(vv, "evil.wrl", HEADER.encode() + b"Box { si\x1b[31mse 1 }\nNoSuch\x07 { }\n")
    done = vv("evil.wrl", "-o", "x.png", *SMALL)
    assert b"\x1b" not in done.stderr and b"\x07" not in done.stderr


def test_quiet(vv):
    assert vv("box.wrl", "-q", "-o", "x.png", *SMALL).talk == ""
    assert vv("box.wrl", "-o", "x.png", *SMALL).talk == "", "a picture that is there at once needs no words"
    write(vv, "v.wrl", HEADER + 'Shape { appearance Appearance { texture ImageTexture { url "no.png" } } geometry Box { } }')
    assert "warning" in vv("v.wrl", "-o", "x.png", *SMALL).talk
    assert vv("v.wrl", "-q", "-o", "x.png", *SMALL).talk == ""


def test_limits(vv):
    write(vv, "deep.wrl", HEADER + "Group { children " * 50 + "Shape { }" + " }" * 50)
    assert vv("deep.wrl", "--check").returncode == 0
    done = vv("deep.wrl", "--check", "--limit", "nesting=10")
    assert done.returncode in (3, 4) and "nesting" in done.talk


# Output -----------------------------------------------------------------------------------------------------------------


def test_output_to_a_full_device(vv):
    done = vv("box.wrl", "-o", "-", *SMALL)
    assert done.returncode == 0
    full = subprocess.run([vv.program, "box.wrl", "-o", "-", *SMALL], cwd=vv.folder, stdout=open("/dev/full", "wb"), stderr=subprocess.PIPE)
    assert full.returncode == 1 and os.strerror(errno.ENOSPC) in full.stderr.decode()
    os.symlink("/dev/full", vv.folder / "full.png")
    done = vv("box.wrl", "-o", "full.png", *SMALL)
    assert done.returncode == 1 and os.strerror(errno.ENOSPC) in done.talk and "full.png" in done.talk
    assert not leftovers(vv)


def test_output_that_is_not_possible(vv):
    for path, reason in (("no/such/folder/x.png", errno.ENOENT), ("box.wrl/x.png", errno.ENOTDIR)):
        done = vv("box.wrl", "-o", path, *SMALL)
        assert done.returncode == 1 and os.strerror(reason) in done.talk, done.talk
    (vv.folder / "taken.png").mkdir()
    done = vv("box.wrl", "-o", "taken.png", *SMALL)
    assert done.returncode == 1 and os.strerror(errno.EISDIR) in done.talk
    assert vv("box.wrl", "--write", "no/such/folder/x.wrl").returncode == 1


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_read_only_folder(vv):
    folder = vv.folder / "locked"
    folder.mkdir()
    (folder / "old.png").write_bytes(b"old")
    folder.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        done = vv("box.wrl", "-o", "locked/old.png", *SMALL)
        assert done.returncode == 1 and os.strerror(errno.EACCES) in done.talk
        assert (folder / "old.png").read_bytes() == b"old"
    finally:
        folder.chmod(0o700)


def test_small_disk(vv):
    """A file size limit stands for a full disk: the old picture stays, nothing half-written is left."""
    (vv.folder / "out.ppm").write_bytes(b"old")
    command = f"trap '' XFSZ; ulimit -f 8; exec '{vv.program}' box.wrl -o out.ppm --size 400x300 --spp 1"
    done = subprocess.run(["bash", "-c", command], cwd=vv.folder, capture_output=True)
    assert done.returncode == 1 and b"cannot write out.ppm" in done.stderr, done.stderr
    assert (vv.folder / "out.ppm").read_bytes() == b"old"
    assert not leftovers(vv)


def test_links_and_modes_stay(vv):
    (vv.folder / "real.png").write_bytes(b"old")
    (vv.folder / "real.png").chmod(0o640)
    os.symlink("real.png", vv.folder / "link.png")
    assert vv("box.wrl", "-o", "link.png", *SMALL).returncode == 0
    assert (vv.folder / "link.png").is_symlink()
    assert (vv.folder / "real.png").read_bytes().startswith(b"\x89PNG")
    assert stat.S_IMODE((vv.folder / "real.png").stat().st_mode) == 0o640


def test_reader_that_goes_away(vv):
    read_end, write_end = os.pipe()
    os.close(read_end)
    lists = subprocess.run([vv.program, "--list-nodes"], stdout=write_end, stderr=subprocess.PIPE)
    assert lists.returncode == 0 and lists.stderr == b""
    picture = subprocess.run([vv.program, "box.wrl", "-o", "-", *SMALL], cwd=vv.folder, stdout=write_end, stderr=subprocess.PIPE)
    assert picture.returncode == 1 and os.strerror(errno.EPIPE) in picture.stderr.decode()
    os.close(write_end)


# Signals ----------------------------------------------------------------------------------------------------------------

# Far more than a test may take: it must be the signal that ends it.
LONG = ("--size", "1600x1200", "--spp", "4096", "--threads", "1")


def wait_until_rendering(running):
    """Busy for a second beyond start-up: the world is tiny, so it renders."""
    time.sleep(1.5)
    assert running.poll() is None


def test_interrupt_keeps_the_picture(vv):
    running = vv.start("box.wrl", "-o", "part.pfm", *LONG)
    wait_until_rendering(running)
    running.send_signal(signal.SIGINT)
    _, talk = running.communicate(timeout=30)
    assert running.returncode == 130, talk
    assert b"so far" in talk
    width, height, _ = read_pfm((vv.folder / "part.pfm").read_bytes())
    assert (width, height) == (1600, 1200)
    assert not leftovers(vv)


def test_termination_is_an_interrupt(vv):
    running = vv.start("box.wrl", "-o", "part.png", *LONG)
    wait_until_rendering(running)
    running.terminate()
    running.communicate(timeout=30)
    assert running.returncode == 130 and (vv.folder / "part.png").exists()


def test_save_request_saves_and_goes_on(vv):
    running = vv.start("box.wrl", "-o", "part.png", *LONG)
    try:
        wait_until_rendering(running)
        running.send_signal(signal.SIGUSR1)
        for _ in range(200):
            if (vv.folder / "part.png").exists():
                break
            time.sleep(0.1)
        assert (vv.folder / "part.png").read_bytes().startswith(b"\x89PNG")
        assert running.poll() is None, "and goes on"
    finally:
        running.kill()
        running.communicate()


def test_interrupt_before_there_is_anything(vv):
    os.mkfifo(vv.folder / "pipe.wrl")
    running = subprocess.Popen([vv.program, "-", "-o", "x.png"], cwd=vv.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=10)
    assert running.returncode == 130 and not (vv.folder / "x.png").exists()


# Reports ----------------------------------------------------------------------------------------------------------------


def test_statistics(vv):
    done = vv("box.wrl", "-o", "x.png", "--stats", "stats.json", "--size", "40x30", "--spp", "4", "--threads", "2")
    assert done.returncode == 0, done.talk
    stats = json.loads((vv.folder / "stats.json").read_text())
    assert stats["schema"] == 1 and stats["version"] and "box.wrl" in stats["command"]
    keys = {
        "scene": "path nodes shapes triangles unique_triangles objects instances textures lights warnings",
        "image": "width height spp channels",
        "time": "parse graph map build first_pass render write total",
        "rays": "camera shadow secondary per_second",
        "transport": "chosen reason claim",
        "error": "mean_rel p99 pixels_trusted level method",
        "memory": "peak_rss bvh scene",
        "cluster": "workers tiles retries bytes",
        "machine": "isa threads embree",
    }
    for group, names in keys.items():
        assert set(stats[group]) == set(names.split()), group
    assert stats["scene"]["path"] == "box.wrl" and stats["scene"]["shapes"] == 1 and stats["scene"]["warnings"] == 0
    assert stats["scene"]["triangles"] == 12
    assert stats["image"] == {"width": 40, "height": 30, "spp": 4, "channels": ["rgba"]}
    assert stats["rays"]["camera"] == 40 * 30 * 4
    assert stats["machine"]["threads"] == 2 and "Embree" in stats["machine"]["embree"]
    assert 0 < stats["time"]["render"] < stats["time"]["total"] < 60
    assert stats["error"]["level"] == 0.95 and stats["error"]["mean_rel"] >= 0
    assert stats["memory"]["peak_rss"] > 1 << 20
    assert json.loads(vv("box.wrl", "-o", "x.png", "--stats", "-", *SMALL).text)["schema"] == 1


def test_statistics_do_not_change_the_picture(vv):
    assert vv("box.wrl", "-o", "a.exr", *SMALL).returncode == 0
    assert vv("box.wrl", "-o", "b.exr", "--stats", "s.json", *SMALL).returncode == 0
    assert (vv.folder / "a.exr").read_bytes() == (vv.folder / "b.exr").read_bytes()


def test_list_nodes(vv):
    text = vv("--list-nodes").text
    assert "Box {" in text and "SFVec3f    size" in text
    nodes = {n["name"]: n for n in json.loads(vv("--list-nodes", "--json").text)["nodes"]}
    assert len(nodes) >= 54
    size = next(f for f in nodes["Box"]["fields"] if f["name"] == "size")
    assert (size["type"], size["access"], size["default"]) == ("SFVec3f", "field", "2 2 2")
    write(vv, "proto.wrl", HEADER + "PROTO Lamp [ field SFFloat power 2.5 ] { Group { } } Lamp { }")
    data = json.loads(vv("proto.wrl", "--list-nodes", "--json").text)
    assert data["prototypes"][0]["name"] == "Lamp" and data["prototypes"][0]["fields"][0]["default"] == "2.5"


def test_list_viewpoints(vv):
    assert vv("box.wrl", "--list-viewpoints").text == "0\t-\tfront\n1\tBack\tfrom behind\n"
    data = json.loads(vv("box.wrl", "--list-viewpoints", "--json").text)
    assert [v["name"] for v in data] == ["", "Back"] and [v["description"] for v in data] == ["front", "from behind"]
    assert len(data[0]["matrix"]) == 16


def test_info(vv):
    text = vv("box.wrl", "--info").text
    assert "nodes" in text and "bounds      -1 -1 -1  to  1 1 1" in text
    data = json.loads(vv("box.wrl", "--info", "--json").text)
    assert data["bounds"] == {"minimum": [-1, -1, -1], "maximum": [1, 1, 1]}
    assert data["types"] == {"Appearance": 1, "Box": 1, "Material": 1, "Shape": 1, "Transform": 1, "Viewpoint": 2}
    assert set(data["names"]) == {"Back", "Place", "Thing", "Paint", "Cube"}
    write(vv, "nothing.wrl", HEADER)
    assert json.loads(vv("nothing.wrl", "--info", "--json").text)["bounds"] is None


def test_write_round_trip(vv):
    done = vv("box.wrl", "--write", "copy.wrl")
    assert done.returncode == 0, done.talk
    assert vv("copy.wrl", "--write", "again.wrl").returncode == 0
    assert (vv.folder / "copy.wrl").read_bytes() == (vv.folder / "again.wrl").read_bytes()
    assert vv("box.wrl", "--write", "-").stdout == (vv.folder / "copy.wrl").read_bytes()
    assert picture(vv) == picture(vv, world="copy.wrl")


def test_recording(vv):
    assert vv("box.wrl", "-o", "a.png", "--record", "scene.ort", *SMALL).returncode == 0
    assert (vv.folder / "scene.ort").stat().st_size > 0
    assert vv("box.wrl", "-o", "b.png", *SMALL).returncode == 0
    assert (vv.folder / "a.png").read_bytes() == (vv.folder / "b.png").read_bytes()


def test_empty_world_makes_a_picture(vv):
    write(vv, "empty.wrl", HEADER)
    assert vv("empty.wrl", "-o", "x.ppm", *SMALL).returncode == 0
    assert all(p == (0, 0, 0) for row in read_ppm((vv.folder / "x.ppm").read_bytes())[2] for p in row)


def test_progress_lines(vv):
    """Not a terminal: a line every few seconds, no escape sequences."""
    running = vv.start("box.wrl", "-o", "x.png", *LONG)
    time.sleep(7)
    running.send_signal(signal.SIGINT)
    _, talk = running.communicate(timeout=30)
    assert b" %" in talk and b"\x1b" not in talk and b"\r" not in talk
    assert find_vv().exists()
