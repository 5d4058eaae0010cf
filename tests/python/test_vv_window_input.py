"""Tests input scripts for vv's window, which also play without one, and its sound."""
import math
import re
import struct
import wave

import pytest

from conftest import HEADER, read_ppm
from window_driver import PATIENCE, SENSORS, SIZE, SPINNING, Shot, blue, green, red, screen, window  # noqa: F401

INPUT = """# a click, a drag, a viewpoint, a way round
0.1 move -0.35 0
0.2 press left
0.3 release left
0.5 press left 0.36 0
0.6 move 0.36 0.25
0.7 release left 0.36 0.5
1 press left 0 0.9
1.1 move 0.2 0.8
1.2 release left
1.5 wheel 1
"""


def test_the_same_input_gives_the_same_bytes(vv):
    vv.write("world.wrl", SENSORS)
    vv.write("in.txt", INPUT)
    made = []
    for name in ("a.ppm", "b.ppm"):
        done = vv("world.wrl", "--input", "in.txt", "-o", name, "--size", "160x120", "--spp", 2)
        assert done.returncode == 0, done.talk
        made.append((vv.folder / name).read_bytes())
    assert made[0] == made[1]
    rows = read_ppm(made[0])[2]
    count = [sum(test(*p) for row in rows for p in row) for test in (red, green, blue)]
    assert count[0] == 0 and count[1] > 200 and count[2] > 100
    assert vv("world.wrl", "-o", "c.ppm", "--size", "160x120", "--spp", 2).returncode == 0
    assert (vv.folder / "c.ppm").read_bytes() != made[0]


def test_what_is_typed_reaches_the_sensors_of_the_world(vv):
    vv.write(
        "world.x3dv", "#X3D V3.3 utf8\nPROFILE Immersive\nDEF K KeySensor { }\n"
        "DEF S Script { inputOnly SFString down inputOnly SFInt32 action url \"ecmascript:\n"
        "function down(v) { print('key ' + v); } function action(v) { print('action ' + v); }\" }\n"
        "ROUTE K.keyPress TO S.down\nROUTE K.actionKeyPress TO S.action\n")
    vv.write("in.txt", "0.1 key A\n0.2 key A shift\n0.3 key Up\n0.4 type \"x y\"\n0.5 key S ctrl\n")
    done = vv("world.x3dv", "--input", "in.txt", "-o", "a.ppm", "--size", "8x6", "--spp", 1)
    assert done.returncode == 0, done.talk
    said = re.findall(r"(?:key|action) \S+", done.talk)
    assert said == ["key a", "key A", "action 17", "key x", "key y"]


def test_with_and_without_a_window_input_gives_the_same_bytes(window, vv):
    vv.write("world.wrl", SPINNING)
    vv.write(
        "in.txt",
        "0.2 press left 0 0.5\n0.4 move 0.3 0.1\n0.6 release left\n0.7 key F\n1 save w.png\n1.1 quit\n"
    )
    w = window("world.wrl", "--input", "in.txt", "--spp", 3, ready=False)
    assert w.program.wait(PATIENCE) == 0
    done = vv("world.wrl", "--input", "in.txt", "--time", 1, "-o", "h.png", "--size",
              "%dx%d" % SIZE, "--spp", 3)
    assert done.returncode == 0, done.talk
    assert (vv.folder / "w.png").read_bytes() == (vv.folder / "h.png").read_bytes()


EXAMINED = HEADER + """
Viewpoint { position 0 0 6 }
NavigationInfo { type [ "EXAMINE" "ANY" ] }
Background { skyColor .6 .7 .9 }
Shape { appearance Appearance { material Material { diffuseColor 1 1 0 } } geometry Box { size 1 2 1 } }
"""


@pytest.mark.parametrize("save, at", [("0.3 key S", .3), ("0.3 save world-1.png", .3),
                                      ("0.31 save world-1.png", .31)])
def test_events_after_a_save_happen_after_it_in_the_window_and_without(window, vv, save, at):
    vv.write("world.wrl", EXAMINED)
    after = "0.31" if at > .3 else "0.3"
    vv.write(
        "in.txt", "0.1 move 0 0.8\n0.1 press left 0 0.8\n0.2 move 0.4 0.6\n"
        f"0.3 release left 0.4 0.6\n{save}\n{after} move 0 0.8\n{after} press left 0 0.8\n"
        f"{after} move -0.3 0.7\n0.5 release left -0.3 0.7\n0.7 save end.png\n0.7 down Q\n")
    w = window("world.wrl", "--input", "in.txt", "--spp", 2, ready=False)
    assert w.program.wait(PATIENCE) == 0
    for name, time in ("world-1.png", at), ("end.png", .7):
        done = vv("world.wrl", "--input", "in.txt", "--time", time, "-o", "h.png", "--size",
                  "%dx%d" % SIZE, "--spp", 2)
        assert done.returncode == 0, done.talk
        assert (vv.folder / name).read_bytes() == (vv.folder / "h.png").read_bytes(), name


def test_a_script_shows_the_same_false_colours_with_and_without_a_window(window, vv):
    vv.write("world.wrl", EXAMINED)
    vv.write("in.txt", "0.1 key L\n0.2 save on.png\n0.3 key L\n0.4 save off.png\n0.5 quit\n")
    w = window("world.wrl", "--input", "in.txt", ready=False)
    assert w.program.wait(PATIENCE) == 0
    files = []
    for name, time in ("on.png", .2), ("off.png", .4):
        done = vv("world.wrl", "--input", "in.txt", "--time", time, "-o", "h.png", "--size",
                  "%dx%d" % SIZE, "--spp", 1)
        assert done.returncode == 0, done.talk
        files.append((vv.folder / name).read_bytes())
        assert files[-1] == (vv.folder / "h.png").read_bytes(), name
    # The pictures of a sequence have one size.
    done = vv("world.wrl", "--input", "in.txt", "--frames", "5-8", "-o", "film.gif", "--size",
              "%dx%d" % SIZE, "--spp", 1)
    assert done.returncode == 0, done.talk
    assert files[0] != files[1]


def test_a_recording_keeps_what_follows_a_save_behind_it(window, vv):
    # Steps of half a second: what follows the save comes in the same step.
    w = window(SPINNING, "--record-input", "in.txt", "--fps", 2, "--spp", 4)
    w.drag(0, 0.8, 0.4, 0.6)
    for count in (1, 2):
        w.key("s")
        w.said("saved as", count)
        w.drag(0, 0.8, -0.3, 0.7)
    assert w.end() == 0
    lines = [line.split() for line in (vv.folder / "in.txt").read_text().splitlines()]
    saves = [i for i, line in enumerate(lines) if line[1:] == ["down", "S"]]
    assert len(saves) == 2
    for count, i in enumerate(saves, 1):
        assert float(lines[i + 1][0]) > float(lines[i][0])
        done = vv("world.wrl", "--input", "in.txt", "--time", lines[i][0], "--fps", 2, "-o",
                  "h.png", "--size", "%dx%d" % SIZE, "--spp", 4)
        assert done.returncode == 0, done.talk
        saved = (vv.folder / f"world-{count}.png").read_bytes()
        assert saved == (vv.folder / "h.png").read_bytes()


def test_a_recording_ends_when_another_world_begins(window, vv):
    w = window(SENSORS, "--record-input", "in.txt")
    w.click(-0.35, 0)
    w.key("r")
    w.said("in.txt ends here")
    w.ready(2)
    w.click(0, 0.9)
    assert w.end() == 0
    text = (vv.folder / "in.txt").read_text()
    assert text.count("press left") == 1 and text.count("down R") == 1
    # The replay does not load the world again, which would begin the script again.
    vv.write("again.txt", text + text.split()[-3] + " save last.png\n1e3 quit\n")
    played = window("world.wrl", "--input", "again.txt", ready=False)
    played.said("saved as last.png")


def test_commands_of_programs_are_not_recorded(vv):
    done = vv("box.wrl", "--record-input", "in.txt", "--control", "127.0.0.1:0")
    assert done.returncode == 2 and "--control" in done.talk


def test_what_was_recorded_can_be_played(window, vv):
    w = window(SENSORS, "--record-input", "in.txt")
    w.click(-0.35, 0)
    w.drag(0.36, 0, 0.36, 0.5)
    w.key("Page_Down")
    w.until(lambda s: blue(*s.at(0, 0.4)))
    assert w.end() == 0
    text = (vv.folder / "in.txt").read_text()
    assert "press left" in text and "down PageDown" in text
    end = float(text.splitlines()[-1].split()[0]) + 2
    for name in ("a.png", "b.png"):
        assert vv("world.wrl", "--input", "in.txt", "--time", end, "-o", name, "--size",
                  "%dx%d" % SIZE, "--spp", 1).returncode == 0
    assert (vv.folder / "a.png").read_bytes() == (vv.folder / "b.png").read_bytes()
    shot = Shot(vv.folder / "a.png")
    assert shot.share(blue) > 0.01 and shot.share(red) == 0


def test_a_recording_with_keys_of_several_words_can_be_played(window, vv):
    w = window(SENSORS, "--record-input", "in.txt")
    w.key("shift+s")
    w.said("saved as world-1.exr")
    assert w.end() == 0
    assert '"Left Shift"' in (vv.folder / "in.txt").read_text()
    done = vv("world.wrl", "--input", "in.txt", "-o", "p.png", "--size", "16x12", "--spp", 1)
    assert done.returncode == 0, done.talk


@pytest.mark.parametrize("event", ['key "Left', 'down ""', 'down'])
def test_keys_without_a_name_are_refused(vv, event):
    vv.write("in.txt", f"0.5 {event}\n")
    done = vv("box.wrl", "--input", "in.txt", "-o", "p.png")
    assert done.returncode == 3 and "in.txt:1: a key was expected" in done.talk


def test_what_cannot_be_recorded_is_told(window):
    w = window(SENSORS, "--record-input", "/dev/full")
    w.click(-0.35, 0)
    w.said("--record-input: cannot write /dev/full: No space left")
    assert w.end() == 1


@pytest.mark.parametrize("line, word", [("x", "number"), ("0 jump", "no event"),
                                        ("1 move 0", "a place"), ("1 press up", "middle"),
                                        ("1 key H super", "shift"), ("1 leave it", "not expected"),
                                        ("2 leave\n1 leave", "earlier")])
def test_a_script_that_is_wrong_names_its_line(vv, line, word):
    vv.write("in.txt", "# first\n" + line + "\n")
    done = vv("box.wrl", "--input", "in.txt", "-o", "x.png")
    assert done.returncode == 3 and re.search(r"in\.txt:[23]: ",
                                              done.talk) and word in done.talk, done.talk
    assert vv("box.wrl", "--input", "absent.txt", "-o", "x.png").returncode == 3


def test_sound_arrives_with_its_pitch_on_its_side(window, vv):
    rate, tone = 8000, 500
    with wave.open(str(vv.folder / "tone.wav"), "wb") as file:
        file.setnchannels(1), file.setsampwidth(2), file.setframerate(rate)
        file.writeframes(b"".join(
            struct.pack("<h", int(16000 * math.sin(2 * math.pi * tone * i / rate)))
            for i in range(rate)))
    w = window(
        HEADER +
        "Viewpoint { position 0 0 0 } Sound { location 5 0 0 minFront 20 minBack 20 maxFront 90 maxBack 90 intensity 1 "
        "source AudioClip { url \"tone.wav\" loop TRUE pitch 2 } } Shape { geometry Box {} }",
        env={
            "SDL_AUDIODRIVER": "disk",
            "SDL_DISKAUDIOFILE": "sound.raw",
            "SDL_DISKAUDIODELAY": "5"
        })
    raw = vv.folder / "sound.raw"
    w.wait(lambda: raw.exists() and raw.stat().st_size > 8 * 48000, "sound")
    assert w.end() == 0
    data = raw.read_bytes()
    pairs = struct.unpack(f"<{len(data) // 8 * 2}f", data[:len(data) // 8 * 8])
    left, right = pairs[4096:8 * 4096:2], pairs[4097:8 * 4096:2]  # after the fade-in
    strength = [math.sqrt(sum(v * v for v in side) / len(side)) for side in (left, right)]
    assert strength[1] > 1.2 * strength[0] > 0
    assert max(right) < 16000 / 32768 * math.sqrt(2) * 1.01
    crossings = sum(a < 0 <= b for a, b in zip(right, right[1:]))
    assert crossings / (len(right) / 48000) == pytest.approx(2 * tone, rel=0.03)
