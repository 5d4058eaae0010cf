"""Tests pictures that survive: --resume after every kind of interruption, and vv merge."""
import json
import os
import re
import resource
import signal
import subprocess
import time

import pytest
from conftest import ISA

ROOM = """#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Viewpoint { position 0 1 6 }
DEF Floor Transform { translation 0 -1 0 children Shape {
  appearance Appearance { material Material { diffuseColor .7 .6 .5 } }
  geometry Box { size 8 .1 8 } } }
DEF Ball Shape { appearance Appearance { material Material { diffuseColor .2 .4 .8 } }
  geometry Sphere { } }
DEF Lamp Transform { translation 0 3 0 children Shape {
  appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor 8 8 8 } }
  geometry Box { size 2 .1 2 } } }
"""
PATHS = ("--transport", "path", "--size", "96x64", *ISA)
ERRORS = ("--channels", "rgba,z,error,variance,trust,samples,id,cryptomatte")
SEEDS = ("-q", *PATHS, "--spp", "32", *ERRORS)


@pytest.fixture
def room(vv):
    vv.write("room.wrl", ROOM)
    return vv


def contents(vv, name):
    return (vv.folder / name).read_bytes()


def made(vv, *arguments, world="room.wrl"):
    done = vv(world, *arguments)
    assert done.returncode == 0, done.talk
    return done


def killed_until_done(vv, *arguments, seconds, threads=lambda i: ()):
    """Kills a run again and again, later each time, until it ends by itself."""
    for i in range(200):
        run = vv.start("room.wrl", *arguments, "-q", "--resume-every", "0.01", *threads(i))
        try:
            run.wait(timeout=seconds * (1 + i / 4))
        except subprocess.TimeoutExpired:
            run.kill()
        talk = run.communicate()[1].decode()
        assert run.returncode in (0, -signal.SIGKILL), talk
        if run.returncode == 0:
            return
    raise AssertionError("the run does not end")


def numbers(vv, name):
    """Returns the statistics that a picture has, without times and machines."""
    json_ = json.loads(contents(vv, name))
    rays = {key: json_["rays"][key] for key in ("camera", "shadow", "secondary")}
    return json_["error"], json_["left_out"], rays, json_["image"]


# Resuming ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("how", [("--spp", "48"), ("--spp", "100", *ERRORS), ("--spp", "8"),
                                 ("--spp", "512", "--error", "8%", *ERRORS)])
def test_a_run_that_is_killed_again_and_again_gets_the_same_bytes(room, how):
    made(room, *PATHS, *how, "-o", "whole.exr", "--stats", "whole.json")
    killed_until_done(room, *PATHS, *how, "-o", "part.exr", "--stats", "part.json", "--resume",
                      "part.sums", seconds=.25, threads=lambda i: ("--threads", str(1 + i % 2)))
    assert contents(room, "part.exr") == contents(room, "whole.exr")
    # The file stays: the same command makes the picture again at once.
    again = ("-o", "again.exr", "--stats", "again.json", "--resume", "part.sums")
    made(room, *PATHS, *how, *again)
    assert contents(room, "again.exr") == contents(room, "whole.exr")
    assert numbers(room, "part.json") == numbers(room, "again.json")
    assert numbers(room, "whole.json")[0] == numbers(room, "again.json")[0]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_save_the_samples(room, number):
    how = (*PATHS, "--spp", "4096")
    run = room.start("room.wrl", *how, "-o", "part.exr", "--resume", "part.sums", "--resume-every",
                     "1000")
    time.sleep(1.5)
    run.send_signal(number)
    assert run.wait(timeout=60) == 130
    assert "the same command continues the picture" in run.communicate()[1].decode()
    assert (room.folder / "part.sums").stat().st_size > 1000


def test_a_time_limit_ends_the_run_and_not_the_picture(room):
    how = (*PATHS, "--spp", "96", *ERRORS)
    made(room, *how, "-o", "whole.exr")
    for _ in range(100):
        done = room("room.wrl", *how, "-o", "part.exr", "--resume", "part.sums", "--time-limit", "1",
                    "--size", "96x64")
        assert done.returncode in (0, 7), done.talk
        if done.returncode == 0:
            break
        assert "the time limit is reached; the same command continues" in done.talk
    assert contents(room, "part.exr") == contents(room, "whole.exr")


@pytest.mark.parametrize("every", [(), ("--resume-every", "0.01")])
def test_a_picture_is_written_even_if_its_sums_cannot_be(room, every):
    """The disk has room for the picture alone."""
    limit = 32 * 1024
    done = subprocess.run(
        [room.program, "room.wrl", "-o", "a.png", "--stats", "a.json", *PATHS, "--spp", "4", *every, "--resume", "a.sums"],
        cwd=room.folder,
        capture_output=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    talk = done.stderr.decode()
    assert done.returncode == 1 and "--resume: cannot write a.sums: File too large" in talk
    assert not (room.folder / "a.sums").exists() and not room.leftovers()
    made(room, "-o", "b.png", *PATHS, "--spp", "4", "-q")
    assert contents(room, "a.png") == contents(room, "b.png")
    assert (room.folder / "a.json").exists()


def test_the_file_of_resume_is_all_that_is_written(room):
    room.write("a.sums.new", "important")
    os.symlink("kept.sums", room.folder / "a.sums")
    made(room, "-o", "a.exr", *PATHS, "--spp", "2", "-q", "--resume", "a.sums")
    assert contents(room, "a.sums.new") == b"important"
    assert (room.folder / "a.sums").is_symlink() and (room.folder / "kept.sums").exists()


def test_pipes_and_circles_of_links(room):
    run = subprocess.run([room.program, "room.wrl", "-q", "-o", "a.png", "--size", "8x6", "--spp", "1", "--stats", "/dev/stdout"],
                         cwd=room.folder,
                         capture_output=True)
    assert run.returncode == 0 and json.loads(run.stdout)
    os.symlink("one.png", room.folder / "two.png")
    os.symlink("two.png", room.folder / "one.png")
    done = room("room.wrl", "-q", "-o", "one.png", "--size", "8x6", "--spp", "1")
    assert done.returncode == 1 and "symbolic links" in done.talk
    assert (room.folder / "one.png").is_symlink()
    os.symlink("b.png", room.folder / "b.json")
    done = room("room.wrl", "-q", "-o", "b.png", "--stats", "b.json", "--size", "8x6", "--spp", "1")
    assert done.returncode == 2 and not (room.folder / "b.png").exists()


def test_a_picture_gets_more_samples(room):
    made(room, *PATHS, "--spp", "64", "-o", "short.exr", "--resume", "a.sums")
    made(room, *PATHS, "--spp", "160", "-o", "long.exr", "--resume", "a.sums")
    made(room, *PATHS, "--spp", "160", "-o", "whole.exr")
    assert contents(room, "long.exr") == contents(room, "whole.exr")
    before = contents(room, "a.sums")
    done = room("room.wrl", *PATHS, "--spp", "64", "-o", "x.exr", "--resume", "a.sums")
    assert done.returncode == 2 and "cannot get fewer" in done.talk
    assert contents(room, "a.sums") == before


def test_files_of_something_else_are_refused_and_left_alone(room):
    made(room, *PATHS, "--spp", "32", "-o", "a.exr", "--resume", "a.sums")
    kept = contents(room, "a.sums")
    room.write("other.wrl", ROOM.replace(".2 .4 .8", ".2 .5 .8"))

    def refused(code, text, *arguments, world="room.wrl"):
        done = room(world, "-o", "b.exr", *PATHS, "--spp", "32", "--resume", "a.sums", *arguments)
        assert done.returncode == code and text in done.talk, done.talk
        assert done.talk.count("error:") == 1 and "left as it is" in done.talk
        assert not (room.folder / "b.exr").exists()

    refused(2, "another world", world="other.wrl")
    refused(2, "another view", "--camera", "1,1,6:0,0,0")
    refused(2, "width", "--size", "48x32")
    refused(2, "another --channels", "--channels", "rgba,z")
    refused(2, "the seed 0, and the seed 1", "--seed", "1")
    refused(2, "transport", "--transport", "direct")
    refused(2, "--background", "--background", "white")
    assert contents(room, "a.sums") == kept
    for damaged in (b"", b"VVSUMS1\n", kept[:-1], kept[:100], kept + b"x", b"#VRML V2.0 utf8\n",
                    kept[:2000] + bytes([kept[2000] ^ 1]) + kept[2001:]):
        room.write("a.sums", damaged)
        refused(3, "cannot read a.sums")
        assert contents(room, "a.sums") == damaged


def test_options_that_do_not_go_together(room):

    def refused(text, *arguments):
        done = room("room.wrl", *arguments)
        assert done.returncode == 2 and text in done.talk, done.talk

    refused("for one picture", "-o", "a.png", "--resume", "a.sums", "--frames", "0-3")
    refused("for one picture", "-o", "a.png", "--resume", "a.sums", "--viewpoint", "all")
    refused("need -o", "--resume", "a.sums", "--check")
    refused("--sums needs -o with an EXR file", "-o", "a.png", "--sums")
    refused("--error cannot be used", "-o", "a.exr", "--sums", "--error", "5%")
    refused("--time-limit", "-o", "a.exr", "--seed", "0-3", "--time-limit", "1")
    for wrong in ("3-1", "0-", "-1", "0-99999", "a"):
        refused("--seed", "-o", "a.exr", "--seed=" + wrong)


# Adding --------------------------------------------------------------------------------------------


@pytest.fixture
def parts(room):
    for seed in range(4):
        made(room, *SEEDS, "--sums", "--seed", str(seed), "-o", f"{seed}.exr")
    return room


def merged(vv, out, *files, stats=None):
    done = vv("merge", *files, "-o", out, "--sums", *(("--stats", stats) if stats else ()))
    assert done.returncode == 0, done.talk
    return contents(vv, out)


def test_seeds_add_up_to_one_longer_run_in_any_order(parts):
    made(parts, *SEEDS, "--sums", "--seed", "0-3", "-o", "whole.exr", "--stats", "whole.json")
    whole = contents(parts, "whole.exr")
    assert merged(parts, "all.exr", "0.exr", "1.exr", "2.exr", "3.exr", stats="all.json") == whole
    assert merged(parts, "back.exr", "3.exr", "1.exr", "2.exr", "0.exr") == whole
    merged(parts, "odd.exr", "3.exr", "1.exr")
    merged(parts, "even.exr", "0.exr", "2.exr")
    assert merged(parts, "again.exr", "odd.exr", "even.exr") == whole
    one, all_ = numbers(parts, "whole.json"), numbers(parts, "all.json")
    assert one[0] == all_[0] and one[2] == all_[2] and all_[3]["spp"] == 128
    # Without --sums the pictures are the same, and as small as usual.
    made(parts, *SEEDS, "--seed", "0-3", "-o", "plain.exr")
    done = parts("merge", "0.exr", "1.exr", "2.exr", "3.exr", "-o", "small.exr")
    assert done.returncode == 0 and "added 4 seeds of 32 samples per pixel" in done.talk
    assert contents(parts, "plain.exr") == contents(parts, "small.exr")
    assert whole.startswith(contents(parts, "plain.exr"))


def test_files_of_resume_can_be_added(parts):
    made(parts, *SEEDS, "--seed", "1", "-o", "x.exr", "--resume", "1.sums")
    assert merged(parts, "a.exr", "0.exr", "1.sums") == merged(parts, "b.exr", "0.exr", "1.exr")


def test_several_seeds_survive_a_kill(parts):
    made(parts, *SEEDS, "--seed", "0-3", "-o", "whole.exr")
    killed_until_done(parts, *SEEDS[1:], "--seed", "0-3", "-o", "part.exr", "--resume", "p.sums",
                      seconds=.3)
    assert contents(parts, "part.exr") == contents(parts, "whole.exr")


def test_depths_are_those_that_were_asked_for(parts):
    depth = ("--channels", "rgba,z", "--depth-along")
    for seed in "01":
        made(parts, *SEEDS, "--sums", "--seed", seed, *depth, "ray", "-o", f"ray{seed}.exr")
    made(parts, *SEEDS, "--sums", "--seed", "2", *depth, "axis", "-o", "axis2.exr")
    made(parts, *SEEDS, "--seed", "0-1", *depth, "ray", "-o", "same.exr")
    assert parts("merge", "ray1.exr", "ray0.exr", "-o", "both.exr").returncode == 0
    assert contents(parts, "both.exr") == contents(parts, "same.exr")
    done = parts("merge", "ray0.exr", "axis2.exr", "-o", "x.exr")
    assert done.returncode == 2 and "--depth-along" in done.talk
    made(parts, *SEEDS, "--resume", "z.sums", *depth, "axis", "-o", "z.exr")
    done = parts("room.wrl", *SEEDS, "--resume", "z.sums", *depth, "ray", "-o", "z.exr")
    assert done.returncode == 2 and "--depth-along" in done.talk


VIEWS = [("--exposure", "1.5"), ("--exposure", "auto", "--view", "agx"), ("--view", "filmic")]


@pytest.mark.parametrize("view", VIEWS)
def test_the_sum_is_shown_as_its_parts(room, view):
    files = ("-o", "same.exr", "-o", "same.png")
    made(room, *SEEDS, *view, "--seed", "0-1", *files, "--sums")
    for seed in "01":
        made(room, *SEEDS, *view, "--seed", seed, "-o", f"{seed}.exr", "--sums", "--resume",
             f"{seed}.sums")
    for parts in (("0.exr", "1.exr"), ("1.sums", "0.exr")):
        done = room("merge", *parts, "-o", "all.exr", "-o", "all.png", "--sums")
        assert done.returncode == 0 and "warning" not in done.talk
        for suffix in ("exr", "png"):
            assert contents(room, "all." + suffix) == contents(room, "same." + suffix)
    # Another view does not change the sums: the run continues.
    made(room, *SEEDS, "--seed", "0", "-o", "plain.exr", "-o", "plain.png")
    made(room, *SEEDS, "--seed", "0", "-o", "again.exr", "-o", "again.png", "--resume", "0.sums")
    for suffix in ("exr", "png"):
        assert contents(room, "plain." + suffix) == contents(room, "again." + suffix)


def test_parts_that_are_shown_differently(room):
    for seed, view in enumerate(VIEWS):
        made(room, *SEEDS, *view, "--seed", str(seed), "-o", f"{seed}.exr", "--sums")
    made(room, *SEEDS, *VIEWS[2], "--seed", "0-2", "-o", "same.png")
    done = room("merge", "2.exr", "0.exr", "1.exr", "-o", "all.png")
    assert done.talk.count("warning") == 1 and contents(room, "all.png") == contents(room, "same.png")
    assert "warning: 0.exr was made with another --exposure or --view than 2.exr" in done.talk
    assert room("merge", "2.exr", "0.exr", "-o", "x.exr", "-q").talk == ""


@pytest.mark.parametrize("name", ["/dev/zero", "pipe"])
def test_special_files_are_not_read(parts, name):
    if name == "pipe":
        os.mkfifo(parts.folder / "pipe")
    done = parts("room.wrl", *SEEDS, "--resume", name, "-o", "x.exr")
    assert done.returncode == 3 and "not an ordinary file" in done.talk


def test_links_stay(parts):
    made(parts, *SEEDS, "--resume", "real.sums", "-o", "x.exr")
    (parts.folder / "link.sums").symlink_to("real.sums")
    before = contents(parts, "real.sums")
    made(parts, *SEEDS, "--resume", "link.sums", "--spp", "40", "-o", "x.exr")
    assert (parts.folder / "link.sums").is_symlink()
    assert contents(parts, "real.sums") != before


def test_what_cannot_be_added(parts):

    def refused(code, text, *files):
        done = parts("merge", *files, "-o", "x.exr")
        assert done.returncode == code and text in done.talk, done.talk
        assert not (parts.folder / "x.exr").exists()

    made(parts, *SEEDS, "--seed", "9", "-o", "plain.exr")
    made(parts, *SEEDS, "--sums", "--seed", "9", "--spp", "64", "-o", "longer.exr")
    made(parts, *SEEDS, "--sums", "--seed", "9", "--size", "48x32", "-o", "smaller.exr")
    made(parts, *SEEDS, "--sums", "--seed", "9", "--fov", "20", "-o", "view.exr")
    made(parts, *SEEDS, "--sums", "--seed", "9", "--background", "white", "-o", "white.exr")
    made(parts, *SEEDS, "--sums", "--seed", "9", "-D", "Floor.translation=0 -2 0", "-o", "other.exr")
    refused(3, "only rounded means; --sums", "0.exr", "plain.exr")
    refused(2, "both have the seed 0", "0.exr", "1.exr", "0.exr")
    refused(2, "samples a pixel", "0.exr", "longer.exr")
    refused(2, "width", "0.exr", "smaller.exr")
    refused(2, "view", "0.exr", "view.exr")
    refused(2, "--background", "0.exr", "white.exr")
    refused(2, "another world", "0.exr", "other.exr")
    refused(3, "cannot read none.exr", "0.exr", "none.exr")
    refused(3, "not a file of sums", "0.exr", "room.wrl")
    whole = contents(parts, "1.exr")
    for damaged in (whole[:-1], whole[:-20], whole[:-1000] + whole[-999:],
                    whole[:-500] + bytes([whole[-500] ^ 1]) + whole[-499:]):
        parts.write("damaged.exr", damaged)
        refused(3, "damaged.exr", "0.exr", "damaged.exr")
    done = parts("merge", "0.exr", "-o", "0.exr")
    assert done.returncode != 0 and contents(parts, "0.exr").startswith(b"\x76\x2f\x31\x01")


@pytest.mark.parametrize("arguments, text", [
    (("-o", "x.exr"), "files were expected"),
    (("0.exr", ), "-o FILE was expected, for the picture of all seeds, or --compare REF.exr"),
    (("0.exr", "-o", "x.exr", "--spp", "3"), "--spp cannot be used with it"),
    (("0.exr", "-o", "x.mp4"), "one picture, not a film"),
    (("0.exr", "--compare", "0.exr", "--sums"), "--sums needs -o with an EXR file"),
    (("0.exr", "-o", "-", "--compare", "0.exr"), "nothing else can go there"),
    (("0.exr", "-o", "-", "--stats", "-"), "only one thing can go to standard output"),
])
def test_options_of_merge(vv, arguments, text):
    done = vv("merge", *arguments)
    assert done.returncode == 2 and text in done.talk and done.text == ""


def test_the_sum_is_compared_without_a_file(parts):
    done = parts("merge", "0.exr", "--compare", "0.exr")
    assert done.returncode == 0 and "rmse      0\n" in done.text
    assert "rmse      0\n" not in parts("merge", "0.exr", "1.exr", "--compare", "0.exr").text


def test_files_that_are_not_complete(room):
    made(room, *SEEDS, "--sums", "-o", "0.exr", "--resume", "a.sums")
    made(room, *SEEDS, "-o", "plain.exr")
    whole, plain, kept = (contents(room, name) for name in ("0.exr", "plain.exr", "a.sums"))
    end = len(plain)  # the end of the pixels in both
    assert whole.startswith(plain)

    def said(name, damaged):
        room.write(name, damaged)
        done = room("merge", name, "-o", "x.exr")
        assert done.returncode == 3 and done.talk.count("cannot read " + name) == 1
        done = room("room.wrl", *SEEDS, "-o", "x.exr", "--resume", name)
        assert done.returncode == 3 and f"--resume: cannot read {name}" in done.talk
        assert contents(room, name) == damaged and not (room.folder / "x.exr").exists()
        return done.talk

    for size in (0, 3):
        assert f"it is truncated: it has {size} bytes" in said("t.exr", whole[:size])
    for size in (5, 100, 300):
        text = said("t.exr", whole[:size])
        place = re.search(r"from byte (\d+) on, (\d+) of \d+ bytes are there", text)
        assert sum(map(int, place.groups())) == size
    rows = said("t.exr", whole[:end - 1])
    assert f"it ends at byte {end - 1}, before the pixels from row 48 on are complete" in rows
    assert "only rounded means" in said("t.exr", plain)
    for size in (end + 3, end + 1000, len(whole) - 17, len(whole) - 1):
        text = said("t.exr", whole[:size])
        assert f"its sums begin at byte {end}, and their end is not at byte {size}" in text
    without = said("t.exr", whole[:end + 500] + whole[end + 501:])
    assert "it is damaged: sums of" in without
    flipped = whole[:-500] + bytes([whole[-500] ^ 1]) + whole[-499:]
    assert "it is damaged between the bytes" in said("t.exr", flipped)
    # a table of blocks that leads nowhere, and one of a file that was not written to its end
    table = whole.index(b"\0" * 2, whole.index(b"screenWindowWidth")) + 2
    while int.from_bytes(whole[table:table + 8], "little") not in range(table, table + 1000):
        table += 1
    lost = plain[:table] + b"\xff" * 8 + plain[table + 8:]
    assert f"it is damaged at byte {table}: it does not lead" in said("t.exr", lost)
    missing = plain[:table + 8] + b"\0" * 8 + plain[table + 16:]
    assert f"damaged at byte {table + 8}: the pixels from row 16 on" in said("t.exr", missing)
    assert "it is truncated or damaged: from byte" in said("t.sums", kept[:-1])
    assert "it is damaged: more follows" in said("t.sums", kept + b"x")
    assert "not a file of sums, and no OpenEXR file" in said("t.sums", b"hello")
