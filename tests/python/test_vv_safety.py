"""Tests vv with hostile names, small limits and careless commands: strings of a world sent to a
terminal, which file an output replaces, files and stacks that must not grow."""
import json
import os
import resource
import subprocess
import unicodedata

import pytest
from conftest import HEADER, SMALL

# Control characters that a terminal would interpret: escape sequences, C1 in UTF-8 and as a byte,
# DEL, bell, carriage return, backspace.
NASTY = b"\x1b]0;title\x07\x1b[2J\xc2\x9b31mred\x9b1m\x7f\r\x08"


def nasty(text):
    return text.replace("@", "\0").encode().replace(b"\0", NASTY)


ESCAPES = nasty("""#VRML V2.0 utf8
WorldInfo { title "@" info "@" }
NavigationInfo { type "@" }
DEF N@ame Viewpoint { position 0 0 5 description "@front" }
Viewpoint { description "@" }
PROTO P@roto [ field SFString text "@" ] { Group { } }
DEF Thing Shape { appearance Appearance { material Material { } texture ImageTexture { url "@.png" } } geometry Box { } }
Inline { url "@.wrl" }
AudioClip { url "@.wav" description "@" }
DEF S Script { url "javascript:function initialize() { print('@'); undefinedName(); }" }
DEF T Script { url "no@such:program" }
Anchor { url "@" description "@" }
Foo@ { } ROUTE @.x TO y.z NoSuchNode@ { }
Shape { appearance ORTAppearance { shader ORTShader { name "@" file "@" } } geometry Text { string "@" } }
""")


def obeyed(data):
    """Returns the control characters of the output, except line feed and tab, and bytes that are
    not UTF-8."""
    text = data.decode("utf-8", errors="surrogateescape")
    return [
        c for c in text
        if c not in "\n\t" and (unicodedata.category(c) == "Cc" or 0xDC80 <= ord(c) <= 0xDCFF)
    ]


COMMANDS = [["--list-viewpoints"], ["--info"], ["--list-nodes"], ["--explain"], ["--check"],
            ["--check", "-v"], ["--list-viewpoints", "--json"], ["--info", "--json"],
            ["--list-nodes", "--json"], ["--explain", "--json"], ["-o", "a.png", *SMALL],
            ["-o", "a.png", *SMALL, "--strict"], ["-o", "a.png", *SMALL, "-v"],
            ["-o", "b.png", "--stats", "-", *SMALL],
            ["-o", "c.png", "--viewpoint", "nobody", *SMALL],
            ["-o", "d.png", "--viewpoint", "all", "-v", *SMALL],
            ["-o", "e.png", "-D", "Nothing.x=1", *SMALL],
            ["-o", "f.png", "--shader", "Nothing=Mirror", *SMALL]]


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_a_worlds_strings_do_not_reach_the_terminal(vv, command):
    vv.write("escapes.wrl", ESCAPES)
    done = vv("escapes.wrl", *command)
    assert done.stdout or done.stderr
    assert obeyed(done.stdout) == [] and obeyed(done.stderr) == []
    if "--json" in command or "--stats" in command:
        json.loads(done.stdout)


def test_json_keeps_the_strings(vv):
    vv.write("a.wrl", nasty("#VRML V2.0 utf8\nViewpoint { description \"@\" }\n"))
    listed = json.loads(vv("a.wrl", "--list-viewpoints", "--json").stdout)
    assert listed[0]["description"].startswith("\x1b]0;title\x07\x1b[2J\x9b31mred\ufffd1m\x7f")


def test_a_written_world_keeps_its_bytes_unless_a_terminal_reads(vv):
    vv.write("a.wrl", nasty("#VRML V2.0 utf8\nWorldInfo { title \"@\" }\n"))
    assert NASTY in vv("a.wrl", "--write", "-").stdout
    master, slave = os.openpty()
    done = subprocess.run([vv.program, "a.wrl", "--write", "-"],
                          cwd=vv.folder,
                          stdout=slave,
                          stderr=subprocess.DEVNULL,
                          timeout=60)
    os.close(slave)
    shown = b""
    try:
        while block := os.read(master, 4096):
            shown += block
    except OSError:  # no more data, and the writer has closed
        pass
    os.close(master)
    assert done.returncode == 0 and b"title" in shown
    assert obeyed(shown.replace(b"\r\n", b"\n")) == []


# Outputs and inputs -----------------------------------------------------------------------------

WHOLE = HEADER + """Viewpoint { position 0 0 5 }
Shape { appearance Appearance { material Material { } texture ImageTexture { url "image.ppm" } } geometry Box { } }
Inline { url "part.wrl" }
"""


@pytest.fixture
def whole(vv):
    vv.write("world.wrl", WHOLE)
    vv.write("part.wrl", HEADER + "Shape { geometry Sphere { } }\n")
    vv.write("image.ppm", b"P6 2 2 255\n" + bytes(range(12)))
    vv.write("sky.pfm", b"PF\n2 1\n-1.0\n" + bytes(24))
    vv.write("input.txt", "0 key F\n")
    for link, to in (("link.png", "world.wrl"), ("part.png", "part.wrl"), ("null.ppm",
                                                                           "/dev/null")):
        (vv.folder / link).symlink_to(to)
    os.link(vv.folder / "world.wrl", vv.folder / "hard.png")
    assert vv("world.wrl", "-o", "reference.exr", *SMALL).returncode == 0
    return vv


def contents(folder):
    return {
        p.name: p.read_bytes()
        for p in folder.iterdir()
        if p.is_file() and p.resolve().parent == folder.resolve()
    }


@pytest.mark.parametrize("arguments, what", [
    (["-o", "link.png"], "the world that is read"),
    (["-o", "hard.png"], "the world that is read"),
    (["--write", "world.wrl"], "the world that is read"),
    (["-o", "a.png", "--stats", "world.wrl"], "the world that is read"),
    (["-o", "a.png", "--record", "world.wrl"], "the world that is read"),
    (["-o", "part.png"], "made of"),
    (["-o", "image.ppm"], "made of"),
    (["-o", "a.png", "--stats", "image.ppm"], "made of"),
    (["-o", "a.png", "--environment", "sky.pfm", "--stats", "sky.pfm"], "--environment"),
    (["--compare", "reference.exr", "-o", "reference.exr"], "--compare"),
    (["-o", "a.png", "--input", "input.txt", "--frames", "0-1", "--stats", "input.txt"], "--input"),
    (["-o", "a.png", "--stats", "a.png"], "name one file"),
    (["-o", "a.png", "-o", "./a.png"], "name one file"),
    (["-o", "a.png", "--write", "a.png"], "name one file"),
    (["-o", "a.png", "--record", "a.png"], "name one file"),
])
def test_no_output_replaces_what_is_read_or_another_output(whole, arguments, what):
    before = contents(whole.folder)
    done = whole("world.wrl", *arguments, *SMALL)
    assert done.returncode in (1, 2), done.talk
    assert what in done.talk, done.talk
    after = contents(whole.folder)
    assert {name: after.get(name) for name in before} == before
    assert whole.leftovers() == []


def test_files_beside_inputs_and_devices_are_no_inputs(whole):
    assert whole("world.wrl", "-o", "fresh.png", "--stats", "fresh.json", "--write", "fresh.wrl",
                 *SMALL).returncode == 0
    # replaced
    assert whole("world.wrl", "-o", "fresh.png", "--stats", "fresh.json", *SMALL).returncode == 0
    assert whole("world.wrl", "-o", "null.ppm", "-o", "null.ppm", "--stats", "/dev/null",
                 *SMALL).returncode == 0


def test_a_world_that_is_named_like_a_picture_is_kept(whole):
    whole.write("in.png", WHOLE)
    done = whole("in.png", "-o", "in.png", *SMALL)
    assert done.returncode == 1 and "in.png: it is the world that is read; another name is needed" in done.talk
    assert (whole.folder / "in.png").read_text() == WHOLE


def test_a_sequence_does_not_reach_its_texture(whole):
    os.rename(whole.folder / "image.ppm", whole.folder / "f-0002.ppm")
    whole.write("world.wrl", WHOLE.replace("image.ppm", "f-0002.ppm"))
    kept = (whole.folder / "f-0002.ppm").read_bytes()
    done = whole("world.wrl", "--frames", "0-3", "-o", "f.ppm", *SMALL)
    assert done.returncode == 1 and "made of" in done.talk
    assert (whole.folder / "f-0002.ppm").read_bytes() == kept


def test_the_recording_that_is_replayed_is_kept(whole):
    replay = whole.program.parent / "openrt-replay"
    if not replay.exists():
        pytest.skip("openrt-replay is not built")
    assert whole("world.wrl", "-o", "a.png", "--record", "a.ort", *SMALL).returncode == 0
    before = (whole.folder / "a.ort").read_bytes()
    done = subprocess.run([replay, "a.ort", "-o", "./a.ort"],
                          cwd=whole.folder,
                          capture_output=True,
                          text=True,
                          timeout=60)
    assert done.returncode == 2 and "another name" in done.stderr
    assert (whole.folder / "a.ort").read_bytes() == before


# Limits of the system ---------------------------------------------------------------------------


def limited(kind, amount):
    return lambda: resource.setrlimit(kind, (amount, amount))


@pytest.mark.parametrize(
    "output",
    [["-o", "a.png"], ["-o", "a.exr"], ["--write", "a.wrl"], ["-o", "ppm:-", "--stats", "a.json"]])
def test_a_file_that_may_not_grow_is_an_error_and_leaves_nothing(vv, output):
    vv.write(
        "long.wrl", HEADER + "Viewpoint { position 0 0 5 }\nShape { geometry Text { string \"" +
        "x" * 9000 + "\" } }\nShape { geometry Box { } }\n")
    with open(vv.folder / "out", "wb") as out:
        done = subprocess.run([vv.program, "long.wrl", *output, "--size", "200x150", "--spp", "1"],
                              cwd=vv.folder,
                              stderr=subprocess.PIPE,
                              stdout=subprocess.DEVNULL if "--stats" in output else out,
                              timeout=60,
                              preexec_fn=limited(resource.RLIMIT_FSIZE, 100))
    assert done.returncode == 1, (done.returncode, done.stderr)
    assert b"cannot write" in done.stderr and b"too large" in done.stderr, done.stderr
    assert vv.leftovers() == [] and not (vv.folder / output[-1]).exists()


def nested(depth,
           kind="Transform { scale 1 1 1 children [ ",
           inside="Shape { appearance Appearance { material Material { } } geometry Box { } }"):
    return HEADER + "Viewpoint { position 0 0 5 }\n" + kind * depth + inside + " ] }" * depth + "\n"


@pytest.mark.parametrize("arguments",
                         [["--check"], ["-o", "a.png", *SMALL], ["--info"], ["--write", "b.wrl"],
                          ["--list-nodes"], ["--explain"], ["-o", "a.png", "--time", "1", *SMALL]],
                         ids=" ".join)
@pytest.mark.parametrize("kilobytes", [256, 64])
def test_a_small_stack_is_enough_for_deep_worlds(vv, arguments, kilobytes):
    vv.write("deep.wrl", nested(900))
    done = subprocess.run([vv.program, "deep.wrl", *arguments],
                          cwd=vv.folder,
                          capture_output=True,
                          timeout=120,
                          preexec_fn=limited(resource.RLIMIT_STACK, kilobytes << 10))
    assert done.returncode == 0, (done.returncode, done.stderr[-500:])


def test_files_within_files_each_as_deep_as_may_be(vv):
    for i in range(31):
        vv.write(f"{i}.wrl", nested(990, inside=f"Inline {{ url \"{i + 1}.wrl\" }}"))
    vv.write("31.wrl", nested(990))
    for arguments in (["--check"], ["-o", "a.png", *SMALL], ["--info"]):
        done = vv("0.wrl", *arguments, timeout=300)
        assert done.returncode in (0, 4), (arguments, done.returncode, done.talk[-500:])


def test_the_budget_of_a_world_bounds_standard_input(vv):
    text = (HEADER + 3_000_000 * "Group { }\n").encode()
    done = vv("-", "-o", "x.png", "--size", "8x6", "--limit", "worldBytes=10000000", stdin=text)
    assert done.returncode == 3, done.talk
    assert "worldBytes=10000000" in done.talk and len(done.talk.splitlines()) == 1
