"""Tests vv's window: pointer, keys, loading and replacing worlds, closing. window_driver.py has the
actions."""
import math
import os
import re
import signal
import subprocess
import time

import pytest

from conftest import HEADER, ROOT, find_vv
from window_driver import PATIENCE, SENSORS, SIZE, SPINNING, Shot, blue, coloured, framebuffer, green, red, screen, window  # noqa: F401


def without_display(vv, **env):
    kept = {
        k: v
        for k, v in os.environ.items()
        if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    }
    return subprocess.run([vv.program, "box.wrl"],
                          cwd=vv.folder,
                          env={
                              **kept,
                              **env
                          },
                          capture_output=True,
                          text=True,
                          timeout=60)


@pytest.mark.parametrize("env", [{}, {"DISPLAY": ":no"}])
def test_without_a_display_one_line_says_so(vv, env):
    done = without_display(vv, **env)
    assert done.returncode == 1 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith(
        "vv: error: no window: "), done.stderr
    assert "-o picture.png" in done.stderr


def test_a_touch_sensor_is_clicked(window):
    w = window(SENSORS)
    assert red(*w.until(lambda s: s.width == SIZE[0]).at(-0.3, 0))
    w.click(-0.35, 0)
    w.until(lambda s: green(*s.at(-0.35, 0)))
    assert w.end() == 0


def test_a_plane_sensor_is_dragged_and_the_viewer_stays(window):
    w = window(SENSORS)
    assert blue(*w.shot().at(0.36, 0))
    before = w.camera()
    w.drag(0.36, 0, 0.36, 0.5)
    w.until(lambda s: blue(*s.at(0.36, 0.5)) and not blue(*s.at(0.36, 0)))
    assert w.camera() == before


def test_viewpoint_keys(window):
    w = window(SENSORS)
    front = w.camera()
    w.key("Page_Down")
    w.wait(lambda: abs(w.camera()[0][0] - 10) < 1e-6, "the side")
    w.key("bracketleft")
    w.wait(lambda: w.camera() == front, "the front")
    w.key("End")
    w.wait(lambda: abs(w.camera()[0][0] - 10) < 1e-6, "the last")
    w.key("Home")
    w.wait(lambda: w.camera() == front, "the first")
    w.drag(0, 0.8, 0.3, 0.8)
    assert w.camera() != front
    w.key("BackSpace")
    w.wait(lambda: w.camera() == front, "back")


def pictures_differ(one, other):
    """Returns the number of pixels that differ by more than the rounding of the camera."""
    assert (one.width, one.height) == (other.width, other.height)
    return sum(
        max(abs(p - q)
            for p, q in zip(a, b)) > 2
        for r, s in zip(one.rows, other.rows)
        for a, b in zip(r, s))


def check_the_printed_command(w, vv):
    """Returns the printed command, whose picture must be the one that the S key saves."""
    shot = w.still()
    command = w.command()
    assert command[0] == "vv"
    done = vv(*command[1:-2], "-o", "again.png")
    assert done.returncode == 0, done.talk
    assert pictures_differ(shot, Shot(vv.folder / "again.png")) < SIZE[0] * SIZE[1] / 200, command
    return command


def test_the_printed_command_gives_the_same_view(window, vv):
    w = window(SENSORS, "--shadows", "off")
    w.drag(0, 0.8, 0.3, 0.5)
    w.key("h")
    assert "off" in check_the_printed_command(w, vv)


BALLS = """
NavigationInfo { type [ "EXAMINE" "ANY" ] }
Transform { translation -1 0 3 children DEF Ball Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Sphere {} } }
Transform { translation 1 .5 -3 children USE Ball }
"""


@pytest.mark.parametrize(
    "world, arguments, named",
    [("OrthoViewpoint { position 0 0 10 fieldOfView [ -2 -3 5 4 ] }", (), "--ortho"),
     ("OrthoViewpoint { position 0 0 10 fieldOfView [ -1 -1 1 1 ] }", ("--fit", ), "--ortho"),
     ("OrthoViewpoint { position 0 0 10 }", ("--fov", 50), "--fov"),
     ("Viewpoint { position 0 0 10 }", ("--ortho", 7), "--ortho"),
     ("Viewpoint { position 0 0 10 }", ("--from", "top", "--ortho", 9), "--ortho")])
def test_the_printed_command_has_the_projection(window, vv, world, arguments, named):
    vv.write("balls.x3dv", "#X3D V3.2 utf8\nPROFILE Interchange\n" + world + BALLS)
    w = window("balls.x3dv", *arguments)
    w.drag(0, 0.8, 0.2, 0.7)
    assert named in check_the_printed_command(w, vv)


def test_the_printed_command_has_the_shader_of_the_viewpoint(window, vv):
    w = window(HEADER + BALLS + """ORTViewpoint { position 0 0 10 shader ORTShader {
      name "ThinLens" options [ "1f radius .5" "1f focus 7" "1i blades 5" ] } }""")
    w.drag(0, 0.8, 0.2, 0.7)
    command = check_the_printed_command(w, vv)
    assert command[command.index("--camera-shader") + 1] == "ThinLens:radius=0.5:focus=7:blades=5"


def test_examine_turns_moves_and_zooms(window):
    w = window(coloured("1 0 0"))
    w.drag(0, 0.9, 0.5, 0.9)  # the world follows the pointer
    eye = w.camera()[0]
    assert math.hypot(*eye) == pytest.approx(5, abs=1e-3) and eye[0] == pytest.approx(
        -5 * math.sin(math.pi / 4), abs=0.2)
    w.key("BackSpace")
    w.move(0, 0.9)
    w.tool("click", 4)
    w.wait(lambda: 3 < w.camera()[0][2] < 4.9, "nearer")
    w.key("BackSpace")
    w.wait(lambda: w.camera()[0] == [0, 0, 5], "back")
    w.drag(0, 0.9, 0.5, 0.9, button=3)
    assert w.camera()[0][0] == pytest.approx(-0.5 * 5 * math.tan(math.pi / 8) * 4 / 3, abs=0.06)


def test_walking_by_keys_and_by_mouse_on_the_ground(window):
    w = window(
        HEADER + "NavigationInfo { type \"WALK\" speed 4 } Viewpoint { position 0 1.6 30 } "
        "Transform { translation 0 -1 0 children Shape { geometry Box { size 100 2 100 } } }")
    w.tool("keydown", "Up")
    w.wait(lambda: w.camera()[0][2] < 29.5, "ahead")
    w.tool("keyup", "Up")
    eye = w.camera()[0]
    assert eye[0] == pytest.approx(0, abs=1e-6) and eye[1] == pytest.approx(1.6, abs=1e-4)
    w.move(0, 0)
    w.tool("mousedown", 1)
    w.move(0, 0.5)
    w.wait(lambda: w.camera()[0][2] < eye[2] - 0.5, "ahead by mouse")
    w.tool("mouseup", 1)
    w.key("4")  # the world allows only WALK
    w.tool("keydown", "Left")
    w.wait(lambda: w.camera()[1][0] < -0.1, "turned to the left")
    w.tool("keyup", "Left")


def test_resizing_makes_larger_pictures(window):
    w = window(SENSORS)
    w.tool("windowsize", w.id, 240, 200)
    shot = w.until(lambda s: (s.width, s.height) == (240, 200))
    assert red(*shot.at(-0.4, 0))


def test_pausing_holds_the_world_and_not_the_viewer(window):
    w = window(SPINNING)
    first = w.shot().bytes
    w.until(lambda s: s.bytes != first)
    w.key("p")
    held = w.still()
    before = w.camera()
    w.key("3")
    w.tool("keydown", "Up")
    w.wait(lambda: w.camera()[0][2] < before[0][2] - 0.1, "flying")
    w.tool("keyup", "Up")
    w.key("p")
    w.until(lambda s: s.bytes != held.bytes)


def test_headlight_key(window):
    w = window(coloured("1 0 0"))
    assert red(*w.shot().at(0, 0))
    w.key("h")
    w.until(lambda s: s.at(0, 0) == (0, 0, 0))


def seen_in(w, screen):
    """Returns the rows of pixels that the X server shows of a window."""
    text = w.tool("getwindowgeometry", "--shell", w.id)
    left, top = (int(re.search(rf"\b{n}=(\d+)", text)[1]) for n in "XY")
    width, height = w.size()
    return [row[left:left + width] for row in framebuffer(screen[1])[top:top + height]]


def test_false_colours_in_the_window_are_those_of_files(window, screen, vv):
    """A red box of 0.2 cd/m2 is green on a scale to 0.5 cd/m2. The legend is white."""
    world = coloured("1 0 0", "DEF Front Viewpoint { position 0 0 4 }")
    w = window(world, "--false-colour", 0.5)
    w.move(0, -0.9)  # the cursor is part of the screen

    def look():
        """Tells whether the box is red, and whether a legend is at the right."""
        rows = seen_in(w, screen)
        legend = [row[-2] for row in rows[SIZE[1] // 3:2 * SIZE[1] // 3]]
        return red(*rows[SIZE[1] // 2][SIZE[0] // 2]), all(p == (255, 255, 255) for p in legend)

    w.wait(lambda: look() == (False, True), "false colours and a legend")
    shot = w.shot()
    command = w.command()
    assert command[command.index("--false-colour") + 1] == "0.5"
    done = vv("world.wrl", "--false-colour", 0.5, "--spp", 1, "--size", "%dx%d" % SIZE, "-o", "o.png")
    assert done.returncode == 0, done.talk
    assert shot.bytes == (vv.folder / "o.png").read_bytes() and shot.width > SIZE[0]

    w.key("l")
    w.wait(lambda: look() == (True, False), "own colours without a legend")
    assert w.shot().width == SIZE[0] and "--false-colour" not in w.command()
    w.key("l")
    w.wait(lambda: look() == (False, True), "false colours again")
    assert w.shot().bytes == shot.bytes
    assert w.end() == 0


def test_a_key_shows_false_colours_where_there_is_luminance(window, screen, vv):
    w = window(coloured("1 0 0"))
    w.key("l")
    shot = w.until(lambda s: s.width > SIZE[0])
    command = w.command()
    assert command[command.index("--false-colour") + 1] == "auto"
    done = vv("world.wrl", "--false-colour", "auto", "--spp", 1, "--size", "%dx%d" % SIZE, "-o",
              "o.png")
    assert done.returncode == 0, done.talk
    assert shot.bytes == (vv.folder / "o.png").read_bytes()
    assert w.end() == 0
    w = window(coloured("1 0 0"), "--colour", "vrml97")
    before = w.still()
    w.key("l")
    assert w.still().bytes == before.bytes
    assert w.end() == 0


def test_frame_all_shows_a_world_far_away(window):
    w = window(
        HEADER +
        "Viewpoint { position 0 0 500 } NavigationInfo { type \"EXAMINE\" } Shape { appearance Appearance { "
        "material Material { diffuseColor 1 0 0 } } geometry Box {} }")
    assert w.shot().share(red) < 0.01
    w.key("f")
    w.until(lambda s: s.share(red) > 0.2)


def test_a_world_without_viewpoint_is_seen_whole_as_in_a_picture(window, vv):
    w = window(HEADER +
               "Transform { translation 40 3 2 children Shape { geometry Box { size 6 1 1 } } }")
    shot = w.until(lambda s: s.width == SIZE[0])
    # before the grey backdrop that models have everywhere
    assert vv("world.wrl", "-o", "p.png", "--size", "%dx%d" % SIZE, "--spp", 1).returncode == 0
    still = Shot(vv.folder / "p.png")
    assert sum(a != b for r, s in zip(shot.rows, still.rows) for a, b in zip(r, s)) < 20


def test_an_anchor_leads_to_another_world_and_a_bad_one_nowhere(window, vv):
    vv.write("other.wrl", coloured("0 0 1"))
    anchors = (
        'Anchor { url "missing.wrl" children Transform { translation -1.2 0 0 children Shape { geometry Box { size 1 1 1 } } } } '
        'Anchor { url "other.wrl" description "away" children Transform { translation 1.2 0 0 children Shape { geometry '
        'Box { size 1 1 1 } } } }')
    w = window(HEADER + "Viewpoint { position 0 0 5 } " + anchors)
    w.click(-0.45, 0)
    w.said("missing.wrl")
    assert not blue(*w.shot().at(0, 0))
    w.click(0.45, 0)
    w.ready(2)
    w.until(lambda s: blue(*s.at(0, 0)))
    assert w.end() == 0


def test_watch_reads_a_changed_file_and_keeps_the_viewer(window, vv):
    w = window(coloured("1 0 0"), "--watch")
    w.drag(0, 0.9, 0.2, 0.9)
    w.until(lambda s: red(*s.at(0, 0)))
    place = w.camera()
    vv.write("world.wrl", coloured("0 0 1"))
    w.until(lambda s: blue(*s.at(0, 0)))
    assert all(a == pytest.approx(b) for a, b in zip(w.camera(), place))
    vv.write("world.wrl", "no world at all")
    w.said("vv: error")
    assert blue(*w.shot().at(0, 0))


@pytest.mark.parametrize("arguments, word, code",
                         [(["absent.wrl"], "absent.wrl", 3),
                          (["box.wrl", "--viewpoint", "Nowhere"], "Nowhere", 2)])
def test_what_cannot_be_shown_is_said_in_the_window(window, arguments, word, code):
    w = window(*arguments, ready=False)
    w.said(word)
    w.id = w.wait(lambda: w.tool("search", "--pid", str(w.program.pid)).split(), "window")[0]
    w.tool("windowfocus", "--sync", w.id)
    assert w.end("Escape") == code


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_it(window, number):
    w = window(SPINNING, "--spp", 60000)
    w.program.send_signal(number)
    assert w.program.wait(PATIENCE) == 130


def test_inlines_come_after_the_first_picture(window, vv):
    vv.write("part.wrl", coloured("0 0 1"))
    vv.write("nest.wrl", HEADER + 'Inline { url "part.wrl" }')
    w = window(HEADER + 'Viewpoint { position 0 0 5 } Inline { url "nest.wrl" }')
    w.until(lambda s: blue(*s.at(0, 0)))


def test_the_screen_shows_the_picture_and_the_overlay(window, screen):
    w = window(coloured("1 0 0"))
    w.move(0, -0.9)  # the cursor is part of the screen
    w.until(lambda s: s.width == SIZE[0])

    def seen():
        rows = framebuffer(screen[1])
        text = w.tool("getwindowgeometry", "--shell", w.id)
        left, top = (int(re.search(rf"\b{n}=(\d+)", text)[1]) for n in "XY")
        part = [row[left:left + SIZE[0]] for row in rows[top:top + SIZE[1]]]
        corner = sum(max(p) > 150 for row in part[:20] for p in row[:100])  # letters
        return red(*part[SIZE[1] // 2][SIZE[0] // 2]), corner > 20

    w.wait(lambda: seen() == (True, True), "picture and overlay")
    w.key("i")  # two presses at once would be taken for key repeat
    w.key("i")
    w.wait(lambda: seen() == (True, False), "no overlay")


def test_a_script_that_never_ends_leaves_the_window_alone(window):
    if not (find_vv().parents[1] / "lib/xvrml/scripts/ecmascript.so").exists():
        pytest.skip("the ECMAScript engine is not built")
    w = window(
        SPINNING +
        """DEF S Script { eventIn SFFloat turn url "javascript: function turn() { print('begun'); while (true); }" }
                             ROUTE Clock.fraction_changed TO S.turn""")
    w.said("begun")
    first = w.shot().bytes
    w.until(lambda s: s.bytes != first)
    w.said("took too long")
    assert w.end() == 0


def test_the_cursor_is_a_hand_over_a_sensor(window, screen):
    w = window(SENSORS)

    def cursor(x, y):
        w.move(x, y)
        time.sleep(0.3)
        place = dict(re.findall(r"(\w+)=(\d+)", w.tool("getmouselocation", "--shell")))
        left, top = int(place["X"]) - 10, int(place["Y"]) - 10
        part = [row[left:left + 20] for row in framebuffer(screen[1])[top:top + 20]]
        ground = part[19][19]
        return [[p == ground for p in row] for row in part]

    w.wait(lambda: cursor(0.75, 0.5) == cursor(0.75, -0.4) != cursor(-0.35, 0), "hand")


def test_the_page_lists_the_keys(vv):
    done = vv("--list-keys")
    assert done.returncode == 0
    own, editor = done.text.split("\nWhile the editor is open:\n")
    for text, name in ((own, "window.md"), (editor, "editor.md")):
        page = re.sub(r"`| \(\[below\]\(#[\w-]+\)\)", "", (ROOT / "docs" / name).read_text())
        rows = {
            tuple(cell.strip()
                  for cell in line.strip("|").split("|"))
            for line in page.splitlines()
            if line.startswith("|")
        }
        for line in text.splitlines():
            assert (line[:24].strip(), line[24:].strip()) in rows, line
