"""Tests moving worlds on vv's command line: --time, --frames, --turntable, films, -D, --explain,
--watch; node plug-ins."""
import json
import os
import signal
import time

import pytest
from conftest import HEADER, ROOT, SMALL, find_vv, read_ppm

# A cube moves from x=-2 to 2 and back in two seconds. A clock with default values must stand still
# (clause 4.6.9).
MOVING = HEADER + """
Viewpoint { position 0 0 8 }
DEF Far Viewpoint { position 0 0 16 }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Idle TimeSensor { }
DEF Way PositionInterpolator { key [0, 0.5, 1] keyValue [-2 0 0, 2 0 0, -2 0 0] }
DEF Up PositionInterpolator { key [0, 1] keyValue [0 0 0, 0 50 0] }
DEF Place Transform { children DEF Inner Transform { children Shape {
  appearance Appearance { material DEF Paint Material { emissiveColor 1 1 1 diffuseColor 0 0 0 } }
  geometry DEF Cube Box { size 1 1 1 } } } }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
ROUTE Idle.fraction_changed TO Up.set_fraction
ROUTE Up.value_changed TO Inner.set_translation
PROTO Lamp [ exposedField SFColor tint 0 0 0 field SFFloat size 1 ] { Shape { appearance Appearance {
  material Material { diffuseColor 0 0 0 emissiveColor IS tint } } geometry Sphere { radius IS size } } }
DEF Low Transform { translation 0 -2 0 children DEF Light Lamp { } }
"""


@pytest.fixture
def moving(vv):
    vv.write("moving.wrl", MOVING)
    return vv


def center(rows):
    """Returns the column of the white cube's middle; None if it is not visible."""
    columns = [
        x for row in rows for x, pixel in enumerate(row) if pixel[0] > 200 and pixel[1] > 200
    ]
    return sum(columns) / len(columns) if columns else None


def picture_of(path):
    return read_ppm(path.read_bytes())[2]


# Time -------------------------------------------------------------------------------------------


def test_time_moves_the_world(moving):
    columns = [
        center(moving.picture("--time", t, world="moving.wrl"))
        for t in ("0", "0.25", "0.5", "0.75", "1", "1.5", "2")
    ]
    assert columns[0] < columns[1] < columns[2] < columns[3] < columns[4]
    assert columns[5] == columns[2] and columns[6] == columns[0]


def test_without_time_it_is_time_zero(moving):
    assert moving.picture(world="moving.wrl") == moving.picture("--time", "0", world="moving.wrl")


def test_a_frame_alone_is_the_frame_of_a_sequence(moving):
    assert moving("moving.wrl", "--frames", "90-100/5", "-o", "all-{frame:4}.exr",
                  *SMALL).returncode == 0
    assert moving("moving.wrl", "--frames", "100", "-o", "one.exr", *SMALL).returncode == 0
    assert moving("moving.wrl", "--frames", "100", "-o", "again.exr", "--threads", "1",
                  *SMALL).returncode == 0
    one = (moving.folder / "one-0100.exr").read_bytes()
    assert one == (moving.folder / "all-0100.exr").read_bytes() == (moving.folder /
                                                                    "again-0100.exr").read_bytes()
    assert one != (moving.folder / "all-0090.exr").read_bytes()
    assert sorted(p.name for p in moving.folder.glob("all-*")) == [
        "all-0090.exr", "all-0095.exr", "all-0100.exr"
    ]


def test_time_is_where_the_frame_is(moving):
    assert moving("moving.wrl", "--frames", "15", "-o", "frame.ppm", *SMALL).returncode == 0
    assert picture_of(moving.folder / "frame-0015.ppm") == moving.picture("--time",
                                                                          "0.5",
                                                                          world="moving.wrl")


def test_fps_says_when_a_frame_is(moving):
    assert moving("moving.wrl", "--frames", "5", "--fps", "10", "-o", "frame.ppm",
                  *SMALL).returncode == 0
    assert picture_of(moving.folder / "frame-0005.ppm") == moving.picture("--time",
                                                                          "0.5",
                                                                          world="moving.wrl")


@pytest.mark.parametrize("name,made", [("a.ppm", "a-0002.ppm"), ("a-{frame}.ppm", "a-2.ppm"),
                                       ("{frame:3}/a.ppm", "002/a.ppm"),
                                       ("a.b{frame:6}.ppm", "a.b000002.ppm")])
def test_names_of_frames(moving, name, made):
    (moving.folder / "002").mkdir()
    done = moving("moving.wrl", "--frames", "2", "-o", name, *SMALL)
    assert done.returncode == 0, done.talk
    assert (moving.folder / made).exists()


def test_all_viewpoints_of_all_frames(moving):
    done = moving("moving.wrl", "--frames", "0-1", "--viewpoint", "all", "-o",
                  "{viewpoint}-{frame:2}.ppm", *SMALL)
    assert done.returncode == 0, done.talk
    assert sorted(p.name for p in moving.folder.glob("*.ppm")) == [
        "0-00.ppm", "0-01.ppm", "Far-00.ppm", "Far-01.ppm"
    ]
    assert moving("moving.wrl", "--frames", "1", "--viewpoint", "Far", "-o", "one.ppm",
                  *SMALL).returncode == 0
    assert (moving.folder / "one-0001.ppm").read_bytes() == (moving.folder /
                                                             "Far-01.ppm").read_bytes()


def test_turntable_comes_round(vv):
    vv.write(
        "side.wrl", HEADER +
        "Viewpoint { position 0 0 8 } Transform { translation 2 0 0 children Shape { appearance Appearance {"
        " material Material { emissiveColor 1 1 1 } } geometry Box { } } } Transform { translation -2 0 0 children Shape {"
        " appearance Appearance { material Material { emissiveColor 1 0 0 diffuseColor 0 0 0 } } geometry Box { } } }"
    )
    assert vv("side.wrl", "--turntable", "4", "-o", "t.ppm", *SMALL).returncode == 0
    pictures = [picture_of(vv.folder / f"t-{i:04}.ppm") for i in range(4)]
    middle = len(pictures[0][0]) / 2
    # Seen from behind, the white box is on the left.
    assert center(pictures[0]) > middle > center(pictures[2])
    # Behind the red one.
    assert center(pictures[1]) == pytest.approx(middle, abs=1) and center(pictures[3]) is None
    assert pictures[0] == vv.picture(world="side.wrl")


def test_stats_of_a_sequence(moving):
    done = moving("moving.wrl", "--frames", "0-4/2", "--stats", "s.json", "-o", "f.ppm", *SMALL)
    assert done.returncode == 0, done.talk
    stats = json.loads((moving.folder / "s.json").read_text())
    assert [f["frame"] for f in stats["frames"]] == [0, 2, 4]
    assert [f["world_time"] for f in stats["frames"]] == pytest.approx([0, 2 / 30, 4 / 30])
    assert stats["schema"] == 1 and stats["rays"]["camera"] == 3 * 32 * 24
    assert stats["time"]["render"] == pytest.approx(
        sum(f["time"]["render"] for f in stats["frames"]))


def test_check_runs_the_world(vv):
    vv.write(
        "wide.wrl", HEADER +
        "DEF T TimeSensor { loop TRUE } DEF I ScalarInterpolator { key [0 1] keyValue [0 1] }\n"
        "Shape { appearance Appearance { material DEF M Material { } } geometry Box { } } ROUTE T.fraction_changed TO I.set_fraction ROUTE I.value_changed TO M.set_transparency"
    )
    done = vv("wide.wrl", "--check", "--frames", "0-10")
    assert done.returncode == 0, done.talk


@pytest.mark.parametrize("options", [("--frames", "x"), ("--frames", "5-1"), ("--frames", "1-2/0"),
                                     ("--time", "-1"), ("--fps", "0"),
                                     ("--frames", "1", "--time", "2"),
                                     ("--frames", "1", "--turntable", "2"), ("--turntable", "0")])
def test_wrong_times(moving, options):
    done = moving("moving.wrl", *options, "-o", "x.ppm", *SMALL)
    assert done.returncode == 2 and "expected" in done.talk or "only one" in done.talk
    assert not list(moving.folder.glob("x*"))


@pytest.mark.parametrize("output", ["-", "x-{frame:}.ppm", "x-{frame:99}.ppm", "x-{framed}.ppm"])
def test_wrong_names_of_frames(moving, output):
    assert moving("moving.wrl", "--frames", "0-1", "-o", output, *SMALL).returncode == 2


def test_an_interrupt_ends_a_sequence(moving):
    running = moving.start("moving.wrl", "--frames", "0-100000", "-o", "f.ppm", *SMALL)
    while not (moving.folder / "f-0001.ppm").exists():
        assert running.poll() is None
        time.sleep(0.01)
    running.send_signal(signal.SIGINT)
    talk = running.communicate(timeout=60)[1].decode()
    assert running.returncode == 130 and "interrupted" in talk
    assert moving.leftovers() == []


# Films ------------------------------------------------------------------------------------------

# A film whose left half is white and turns grey: a MovieTexture must show the values put in.
FADING = HEADER + """
Viewpoint { position 0 0 8 } NavigationInfo { headlight FALSE }
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Fade ColorInterpolator { key [0, 1] keyValue [1 1 1, 0 0 0] }
Transform { translation -3 0 0 children Shape { appearance Appearance { material DEF Paint Material {
  emissiveColor 1 1 1 diffuseColor 0 0 0 } } geometry Box { size 5 20 .1 } } }
ROUTE Clock.fraction_changed TO Fade.set_fraction
ROUTE Fade.value_changed TO Paint.set_emissiveColor
"""


def test_a_gif_holds_the_frames(moving):
    image = pytest.importorskip("PIL.Image")
    moving.write("fading.wrl", FADING)
    done = moving("fading.wrl", "--frames", "0-7", "--fps", "8", "-o", "v.gif", "-o", "v.ppm",
                  *SMALL)
    assert done.returncode == 0, done.talk
    with image.open(moving.folder / "v.gif") as film:
        assert film.n_frames == 8 and film.size == (32, 24) and film.info["loop"] == 0
        hundredths = 0
        for number in range(8):
            film.seek(number)
            hundredths += film.info["duration"] // 10
            shown = film.convert("RGB").getpixel((8, 12))
            wanted = read_ppm((moving.folder / f"v-000{number}.ppm").read_bytes())[2][12][8]
            assert all(abs(a - b) <= 4 for a, b in zip(shown, wanted)), (number, shown, wanted)
        assert hundredths == 100  # 12.5 hundredths each: the rounding errors do not add up
    assert moving.leftovers() == []


@pytest.mark.parametrize("suffix, signature", [("mp4", b"ftyp"), ("webm", b"\x1a\x45\xdf\xa3")])
def test_a_film_needs_no_program(moving, suffix, signature):
    arguments = ["moving.wrl", "--frames", "0-2", "--fps", "25", "--size", "33x25", "--spp", "1"]
    done = moving(*arguments, "-o", f"-v.{suffix}", env={"PATH": "/nonexistent"})
    if "has no encoder" in done.talk:
        pytest.skip("the ffmpeg libraries are not in this build")
    assert done.returncode == 0, done.talk
    film = (moving.folder / f"-v.{suffix}").read_bytes()
    assert signature in film[:16]
    assert moving(*arguments, "-o", f"again.{suffix}").returncode == 0
    assert (moving.folder / f"again.{suffix}").read_bytes() == film
    assert moving.leftovers() == []


def test_an_mp4_shows_what_was_put_in(moving):
    moving.write("fading.wrl", FADING)
    done = moving("fading.wrl", "--frames", "0-7", "--fps", "8", "-o", "v.mp4", "-o", "v.ppm",
                  "--size", "64x48", "--spp", "1")
    if "has no encoder" in done.talk:
        pytest.skip("the ffmpeg libraries are not in this build")
    assert done.returncode == 0, done.talk
    moving.write(
        "cinema.wrl",
        HEADER + """Viewpoint { position 0 0 2.4142 } NavigationInfo { headlight FALSE }
Shape { appearance Appearance { texture MovieTexture { url "v.mp4" loop TRUE } } geometry IndexedFaceSet { solid FALSE
  coord Coordinate { point [-1 -1 0, 1 -1 0, 1 1 0, -1 1 0] } coordIndex [0 1 2 3]
  texCoord TextureCoordinate { point [0 0, 1 0, 1 1, 0 1] } texCoordIndex [0 1 2 3] } }""")
    for number in (1, 4, 6):
        assert moving("cinema.wrl", "--time", str((number + 0.5) / 8), "-o", "s.ppm", "--size",
                      "48x48", "--spp", "1").returncode == 0
        shown = read_ppm((moving.folder / "s.ppm").read_bytes())[2][24][12]
        wanted = read_ppm((moving.folder / f"v-000{number}.ppm").read_bytes())[2][24][16]
        assert all(abs(a - b) <= 8 for a, b in zip(shown, wanted)), (number, shown, wanted)


def test_a_film_that_cannot_be_written(moving):
    moving.write("v.gif", "before")
    os.chmod(moving.folder / "v.gif", 0o444)
    done = moving("moving.wrl", "--frames", "0-2", "-o", "nowhere/v.gif", *SMALL)
    assert done.returncode == 1 and "nowhere/v.gif" in done.talk
    assert (moving.folder / "v.gif").read_text() == "before" and moving.leftovers() == []


def test_a_film_needs_a_sequence(moving):
    done = moving("moving.wrl", "-o", "v.mp4", *SMALL)
    assert done.returncode == 2 and "--turntable" in done.talk


def test_a_film_of_an_interrupted_sequence_is_whole(moving):
    image = pytest.importorskip("PIL.Image")
    running = moving.start("moving.wrl", "--frames", "0-100000", "-o", "v.gif", "-o", "f.ppm",
                           *SMALL)
    while not (moving.folder / "f-0002.ppm").exists():
        assert running.poll() is None
        time.sleep(0.01)
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=60)
    assert running.returncode == 130
    with image.open(moving.folder / "v.gif") as film:
        assert film.n_frames >= 2
    assert moving.leftovers() == []


# -D ---------------------------------------------------------------------------------------------


def test_a_field_gets_another_value(moving):
    assert center(moving.picture("-D", "Inner.translation=100 0 0", world="moving.wrl")) is None
    fast = moving.picture("-D", "Clock.cycleInterval=4", "--time", "1", world="moving.wrl")
    assert fast == moving.picture("--time", "0.5", world="moving.wrl")


def test_a_prototype_gets_an_event(moving):
    rows = moving.picture("-D", "Light.tint=0 1 0", world="moving.wrl")
    assert any(pixel == (0, 255, 0) for row in rows for pixel in row)


def test_changed_fields_are_written(moving):
    done = moving("moving.wrl", "-D", "Cube.size=3 2 1", "--write", "-")
    assert done.returncode == 0 and "size 3 2 1" in done.text


@pytest.mark.parametrize("definition,told", [("Plaze.translation=0 0 1", "Place"),
                                             ("Place.translatoin=0 0 1", "translation"),
                                             ("Place.translation=0 0", "SFVec3f"),
                                             ("Place.translation=0 0 1 2", "SFVec3f"),
                                             ("Clock.loop=yes", "SFBool"),
                                             ("Paint.transparency=2", "range"),
                                             ("Clock.fraction_changed=1", "eventOut"),
                                             ("Light.size=2", "exposedField"),
                                             ("nonsense", "DEF.FIELD=VALUE"),
                                             ("Way.keyValue=[0 0 0", "MFVec3f")])
def test_wrong_definitions(moving, definition, told):
    done = moving("moving.wrl", "-D", definition, "-o", "x.ppm", *SMALL)
    assert done.returncode == 2 and told in done.talk
    assert not (moving.folder / "x.ppm").exists()


# --explain --------------------------------------------------------------------------------------


def test_explain_tells_objects_and_reasons(moving):
    done = moving("moving.wrl", "--explain", "--json")
    assert done.returncode == 0, done.talk
    told = json.loads(done.text)
    assert told["totals"]["objects"] == len(told["objects"]) > 0
    assert all(o["reason"] and o["name"] for o in told["objects"])
    assert sum(o["triangles"] for o in told["objects"]) == told["totals"]["triangles"] >= 12
    lines = moving("moving.wrl", "--explain").text.split("\n")
    assert lines[0].startswith("transport direct: ")
    table = lines[2:]
    assert len(table) == len(told["objects"]) + 3 and told["objects"][0]["reason"] in table[1]


def test_explain_counts_instances_in_instances(vv):
    vv.write(
        "nested.wrl", HEADER + """
        DEF Outer ORTInstance { children DEF Inner ORTInstance { children Shape { geometry Box { } } } }
        Transform { translation 3 0 0 children [ USE Inner, Transform { translation 3 0 0 children USE Outer } ] }"""
    )
    assert json.loads(vv("nested.wrl", "--explain",
                         "--json").text)["totals"]["instanced_triangles"] == 3 * 12


# --watch ----------------------------------------------------------------------------------------


def wait_for(condition, running, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert running.poll() is None and time.monotonic() < end
        time.sleep(0.02)


def test_watch_renders_again(vv):
    vv.write("part.wrl", HEADER + "Shape { geometry Box { } }")
    vv.write("main.wrl", HEADER + 'Viewpoint { } Inline { url "part.wrl" }')
    out = vv.folder / "out.ppm"
    running = vv.start("main.wrl", "--watch", "-o", "out.ppm", *SMALL)
    try:
        wait_for(out.exists, running)
        box = out.read_bytes()
        # A file that the world uses.
        vv.write("part.wrl", HEADER + "Shape { geometry Sphere { radius 3 } }")
        wait_for(lambda: out.read_bytes() != box, running)
        sphere = out.read_bytes()
        vv.write("main.wrl", "no world at all")  # reported, and the files are still watched
        time.sleep(0.5)
        vv.write("main.wrl", HEADER + "Viewpoint { } Shape { geometry Cone { } }")
        wait_for(lambda: out.read_bytes() != sphere, running)
    finally:
        running.send_signal(signal.SIGINT)
        talk = running.communicate(timeout=60)[1].decode()
    assert running.returncode == 130, talk
    assert vv.leftovers() == []


# --node-path ------------------------------------------------------------------------------------

PLUGINS = find_vv().parent.parent / "examples/nodes"
SPRING = HEADER + "Viewpoint { position 0 1 6 } Shape { appearance Appearance { material Material { } } geometry Spring { } }"


@pytest.mark.skipif(not (PLUGINS / "springs.so").exists(),
                    reason="the example plug-in is not built")
def test_nodes_of_a_plugin(vv):
    vv.write("spring.wrl", SPRING)
    assert vv("spring.wrl", "--check").returncode == 4  # an unknown node
    assert vv("spring.wrl", "--check", "--node-path", PLUGINS).returncode == 0
    assert vv("spring.wrl", "--check", env={
        "XVRML_NODE_PATH": f"/nonexistent:{PLUGINS}"
    }).returncode == 0
    assert any(pixel != (0, 0, 0)
               for row in vv.picture("--node-path", PLUGINS, world="spring.wrl")
               for pixel in row)
    assert "Spring {" in vv("--list-nodes", "--node-path", PLUGINS).text
    written = vv("spring.wrl", "--write", "-", "--node-path", PLUGINS).text
    assert "Spring {" in written


def test_a_file_that_is_no_plugin_is_refused(vv):
    (vv.folder / "plugins").mkdir()
    vv.write("plugins/not.so", "text")
    done = vv("box.wrl", "--check", "--node-path", "plugins")
    assert done.returncode == 0 and "plugins/not.so" in done.talk


# Scripts and scenes -----------------------------------------------------------------------------


def test_info_announces_scripts(vv):
    vv.write(
        "scripts.wrl", HEADER +
        'Script { url "javascript: function initialize() {}" } Script { url [ "Javascript:x", "a.class" ] }\n'
        'Script { url "things/Mover.class" } Script { } PROTO P [ ] { Group { } Script { url "nosuch:x" } }'
    )
    done = vv("scripts.wrl", "--info", "--json", "-q")
    assert done.returncode == 0, done.talk
    scripts = {one["protocol"]: one for one in json.loads(done.text)["scripts"]}
    assert {
        name: (one["count"], one["declared"]) for name, one in scripts.items()
    } == {
        "javascript": (2, 0),
        "java": (1, 0),
        "none": (1, 0),
        "nosuch": (0, 1)
    }
    assert scripts["nosuch"]["engine"] is False
    assert "2 javascript" in vv("scripts.wrl", "--info", "-q").text


def test_the_globe_turns_under_the_lamp(vv):
    scene = ROOT / "examples/scenes/globe.wrl"
    done = vv(scene, "--check", "--frames", "0-240/80")
    assert done.returncode == 0, done.talk
    assert vv(scene, "--frames", "0-240/60", "-o", "g.ppm", *SMALL).returncode == 0
    pictures = [picture_of(vv.folder / f"g-{i:04}.ppm") for i in (0, 60, 120, 180, 240)]
    assert len({str(p) for p in pictures[:4]}) == 4
    differences = [
        abs(a - b)
        for one, other in zip(pictures[0], pictures[4])
        for p, q in zip(one, other)
        for a, b in zip(p, q)
    ]
    assert sum(differences) / len(differences) < 0.5  # eight seconds are one cycle
