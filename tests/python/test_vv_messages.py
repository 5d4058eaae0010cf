"""Tests exit codes and messages of the program vv on the command line."""
import os
import re
import resource
import subprocess

import pytest
from conftest import HEADER, SMALL


@pytest.mark.parametrize("arguments, word", [
    (["-o", "x.png"], "world"),
    (["box.wrl", "--no-such-thing"], "--no-such-thing"),
    (["box.wrl", "--veiwpoint", "1", "-o", "x.png"], "did you mean --viewpoint?"),
    (["box.wrl", "--sise=3x3", "-o", "x.png"], "did you mean --size?"),
    (["box.wrl", "-o", "x.tif"], "exr, png, jpg"),
    (["box.wrl", "-o", "x"], "suffix"),
    (["box.wrl", "-o"], "-o: a value was expected"),
    (["box.wrl", "-o", "x.png", "--spp=", "64"], "--spp: a whole number"),
    (["box.wrl", "-o", "x.png", "--size=", "64x48"], "--size: "),
    (["box.wrl", "-o", "x.png", "--shadows="], "on or off"),
    (["--output=", "box.wrl"], "-o: a file name"),
    (["--audit=", "box.wrl"], "--audit: a value was expected: [N]"),
    (["--help=", "all"], "--help: a value was expected: [TOPIC]"),
    (["box.wrl", "-o", "x.png", "--preview=off"], "--preview takes no value: =off was not"),
    (["box.wrl", "-o", "x.png", "--preview="], "--preview takes no value: = was not expected"),
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
    (["box.wrl", "-o", "x.png", "--viewpoint", "0", "--fit"], "--viewpoint"),
    (["box.wrl", "-o", "x.png", "--ortho", "2", "--fov", "9"], "--ortho says what"),
    (["box.wrl", "-o", "x.png", "--ortho", "0"], "between 0 and"),
    (["box.wrl", "-o", "x.png", "--environment", "a.hdr", "--background", "white"], "only one of"),
    (["box.wrl", "-o", "x.png", "--channels", "rgba,depth"], "rgba,z,normal"),
    (["box.wrl", "-o", "x.png", "--limit", "nestin=5"], "did you mean nesting?"),
    (["box.wrl", "-o", "x.png", "--limit", "nesting"], "NAME=VALUE"),
    (["box.wrl", "-o", "x.png", "--limit", "nesting=-1"], "count"),
    (["box.wrl", "other.wrl", "-o", "x.png"], "one world at a time"),
    (["box.wrl", "x.png"], "vv box.wrl -o x.png"),
    (["box.wrl", "-o", "x.png", "--size", "800,600"], "did you mean --size 800x600?"),
    (["box.wrl", "-o", "x.png", "--size", "800*600"], "did you mean --size 800x600?"),
    (["box.wrl", "-o", "x.png", "--size", "800"], "did you mean --size 800x600?"),
    (["box.wrl", "-o", "x.png", "--size", "-800,600"], "640x480"),
    (["box.wrl", "-o", "x.png", "--resolution", "800,600"], "--size 800x600"),
    (["box.wrl", "-o", "x.png", "--samples=64"], "--spp N"),
    (["box.wrl", "--video", "x.mp4"], "-o film.mp4"),
    (["box.wrl", "-o", "-", "--stats", "-"], "standard output"),
    (["box.wrl", "--check", "-o", "x.png"], "--check"),
    (["box.wrl", "--stats", "s.json"], "-o"),
    (["box.wrl", "-o", "x.png", "--json"], "--json"),
    (["box.wrl", "-q", "-v", "-o", "x.png"], "--quiet"),
    (["box.wrl", "-o", "x.tiff"], "-o: a file name"),
])
def test_usage(vv, arguments, word):
    done = vv(*arguments)
    assert done.returncode == 2, (done.returncode, done.talk)
    assert done.stdout == b""
    lines = done.talk.splitlines()
    assert len(lines) == 1 and lines[0].startswith("vv: error: ") and word in lines[0], done.talk
    assert not (vv.folder / "x.png").exists()


@pytest.mark.parametrize("content, name", [
    (b"(kicad_pcb (version 20221018)", "KiCad board"),
    (b"\x89PNG\r\n\x1a\n", "a picture"),
    (b"<!DOCTYPE html><title>404</title>", "web page"),
    (b"PK\x03\x04", "ZIP archive"),
])
def test_files_of_other_formats_are_named(vv, content, name):
    (vv.folder / "other.wrl").write_bytes(content)
    done = vv("other.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 3 and name in done.talk, done.talk
    assert "which cannot be read (VRML97, X3D ClassicVRML" in done.talk, done.talk


def test_folders_that_do_not_exist(vv):
    for option in ("--shader-path", "--node-path", "--script-path"):
        done = vv("box.wrl", "-o", "x.png", option, "/nix", *SMALL)
        assert done.returncode == 0
        assert done.talk == f"vv: warning: {option}: there is no folder /nix\n"


def test_help_is_short_and_has_topics(vv):
    short = vv("--help")
    assert short.returncode == 0 and short.talk == "" and vv("-h").text == short.text
    assert len(short.text.splitlines()) <= 50 and "--output" in short.text
    whole = vv("--help", "all").text
    topics = re.search(r"vv --help TOPIC\s+([^;]*);", short.text).group(1)
    for topic in re.sub(r"\s+", " ", topics).strip().split(", "):
        one = vv("--help", topic)
        assert one.returncode == 0 and one.text.strip() in whole, topic
    assert vv("--help", "View").text == vv("--help", "view").text
    size = vv("--help", "--size").text
    assert size.startswith("  --size WxH ") and size in whole and vv("-h", "size").text == size
    wrong = vv("--help", "qualty")
    assert wrong.returncode == 2 and "did you mean quality?" in wrong.talk


def test_help_and_version(vv):
    done = vv("--help", "all")
    assert done.returncode == 0 and done.talk == ""
    for option in ("--output", "--size", "--viewpoint", "--camera", "--fit", "--fov", "--headlight",
                   "--spp", "--depth", "--shadows", "--seed", "--threads", "--colour", "--stats",
                   "--check", "--strict", "--info", "--list-nodes", "--list-viewpoints", "--json",
                   "--write", "--channels", "--limit", "--allow-absolute", "--record",
                   "--shader-path", "--quiet", "--verbose", "--version"):
        assert option in done.text
    assert max(map(len, done.text.splitlines())) <= 130
    assert vv("-h", "all").text == vv("merge", "--help", "all").text == done.text
    version = vv("--version")
    assert vv("merge", "--version").text == version.text
    assert version.returncode == 0 and version.text.startswith("vv ")


@pytest.mark.parametrize("content, place, words", [
    (None, "", "missing.wrl"),
    ("", "", "world.wrl"),
    ("hello world\n", "world.wrl", "VRML"),
    ("#VRML V3.0 utf8\nGroup { }\n", "world.wrl", "VRML97"),
    (b"\x89PNG\r\n\x1a\n\0\0\0\0", "world.wrl", "VRML"),
    (b"\x1f\x8b\x08\0broken", "world.wrl", ""),
])
def test_unusable_input(vv, content, place, words):
    name = "missing.wrl"
    if content is not None:
        name = "world.wrl"
        vv.write(name, content)
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
    vv.write("faulty.wrl", FAULTY)
    done = vv("faulty.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0, "the rest of the file is drawn"
    assert "faulty.wrl:3:18: error: " in done.talk and "faulty.wrl:5:" in done.talk
    lines = done.talk.splitlines()
    at = next(i for i, line in enumerate(lines) if ":3:18:" in line)
    assert "sise" in lines[at + 1] and lines[at + 2].strip() == "^", "the source line and a caret"
    assert lines[at + 2].index("^") == lines[at + 1].index("sise")
    assert (vv.folder / "x.png").exists()


def test_check_and_strict(vv):
    vv.write("faulty.wrl", FAULTY)
    assert vv("box.wrl", "--check").returncode == 0
    done = vv("faulty.wrl", "--check")
    assert done.returncode == 4 and "faulty.wrl:3:18: error: " in done.talk and done.text == ""
    strict = vv("faulty.wrl", "--strict", "-o", "x.png", *SMALL)
    assert strict.returncode == 4 and not (vv.folder / "x.png").exists()
    assert vv("box.wrl", "--strict", "-o", "x.png", *SMALL).returncode == 0


def test_missing_texture_and_plugin(vv):
    vv.write(
        "texture.wrl", HEADER +
        'Shape { appearance Appearance { material Material { } texture ImageTexture { url "no.png" } } geometry Box { } }'
    )
    vv.write(
        "plugin.wrl", HEADER +
        'Shape { appearance ORTAppearance { shader ORTShader { name "X" file "nosuchlibrary" } } geometry Box { } }'
    )
    for name in ("texture.wrl", "plugin.wrl"):
        done = vv(name, "-o", "x.png", *SMALL)
        assert done.returncode == 0 and f"{name}:2:" in done.talk, done.talk
        os.unlink(vv.folder / "x.png")
        done = vv(name, "--strict", "-o", "x.png", *SMALL)
        assert done.returncode == 5 and not (vv.folder / "x.png").exists(), done.talk
    assert vv("texture.wrl", "--check").returncode == 4


def test_many_problems_are_counted(vv):
    vv.write("many.wrl", HEADER + "Group { sise 1 }\n" * 300)
    done = vv("many.wrl", "-o", "x.png", *SMALL)
    assert done.returncode == 0
    assert done.talk.count("error:") <= 60 and "more" in done.talk
    assert vv("many.wrl", "-v", "-o", "x.png", *SMALL).talk.count("error:") == 300


def test_control_characters_do_not_reach_the_terminal(vv):
    vv.write("evil.wrl",
             HEADER.encode() + b"Box { si\x1b[31mse 1 }\nNoSuch\x07 { }\nNo\xe2\x80\xaeSuch { }\n")
    done = vv("evil.wrl", "-o", "x.png", *SMALL)
    assert b"\x1b" not in done.stderr and b"\x07" not in done.stderr
    assert "\u202e".encode(
    ) not in done.stderr and b"\\xe2\\x80\\xaeSuch" in done.stderr, "the direction of text must not change"


def test_quiet(vv):
    assert vv("box.wrl", "-q", "-o", "x.png", *SMALL).talk == ""
    assert vv("box.wrl", "-o", "x.png",
              *SMALL).talk == "", "a picture that is there at once needs no words"
    vv.write(
        "v.wrl", HEADER +
        'Shape { appearance Appearance { texture ImageTexture { url "no.png" } } geometry Box { } }'
    )
    assert "warning" in vv("v.wrl", "-o", "x.png", *SMALL).talk
    assert vv("v.wrl", "-q", "-o", "x.png", *SMALL).talk == ""


def test_limits(vv):
    vv.write("deep.wrl", HEADER + "Group { children " * 50 + "Shape { }" + " }" * 50)
    assert vv("deep.wrl", "--check").returncode == 0
    done = vv("deep.wrl", "--check", "--limit", "nesting=10")
    assert done.returncode in (3, 4) and "nesting" in done.talk


@pytest.mark.parametrize("megabytes", [300, 500, 700])
def test_exit_code_without_memory(vv, megabytes):
    """Whatever fails first."""
    limit = megabytes << 20
    done = subprocess.run(
        [vv.program, "box.wrl", "-o", "x.exr", "--size", "9000x9000", "--spp", "1", "--channels", "rgba,z,normal,position"],
        cwd=vv.folder,
        capture_output=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
    assert done.returncode == 75, done.stderr
    assert not (vv.folder / "x.exr").exists()
