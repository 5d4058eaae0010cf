"""Tests the files that vv writes: they are complete or absent. Also signals and reports."""
import errno
import json
import os
import pathlib
import re
import signal
import stat
import subprocess
import time

import pytest
from conftest import HEADER, SMALL, find_vv, read_pfm, read_ppm

# Output ------------------------------------------------------------------------------------------


def test_output_to_a_full_device(vv):
    done = vv("box.wrl", "-o", "-", *SMALL)
    assert done.returncode == 0
    full = subprocess.run([vv.program, "box.wrl", "-o", "-", *SMALL],
                          cwd=vv.folder,
                          stdout=open("/dev/full", "wb"),
                          stderr=subprocess.PIPE)
    assert full.returncode == 1 and os.strerror(errno.ENOSPC) in full.stderr.decode()
    os.symlink("/dev/full", vv.folder / "full.png")
    done = vv("box.wrl", "-o", "full.png", *SMALL)
    assert done.returncode == 1 and os.strerror(
        errno.ENOSPC) in done.talk and "full.png" in done.talk
    assert not vv.leftovers()


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
    """A file size limit simulates a full disk: the old picture stays and nothing half-written is
    left."""
    (vv.folder / "out.ppm").write_bytes(b"old")
    command = f"trap '' XFSZ; ulimit -f 8; exec '{vv.program}' box.wrl -o out.ppm --size 400x300 --spp 1"
    done = subprocess.run(["bash", "-c", command], cwd=vv.folder, capture_output=True)
    assert done.returncode == 1 and b"cannot write out.ppm" in done.stderr, done.stderr
    assert (vv.folder / "out.ppm").read_bytes() == b"old"
    assert not vv.leftovers()


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
    picture = subprocess.run([vv.program, "box.wrl", "-o", "-", *SMALL],
                             cwd=vv.folder,
                             stdout=write_end,
                             stderr=subprocess.PIPE)
    assert picture.returncode == 1 and os.strerror(errno.EPIPE) in picture.stderr.decode()
    os.close(write_end)


# Signals ----------------------------------------------------------------------------------------

# Takes far longer than a test may, so only the signal can end it.
LONG = ("--size", "1600x1200", "--spp", "4096", "--threads", "1")


def wait_until_rendering(running):
    """Waits until the process has been busy for a second after start-up. The world is tiny, so it
    is rendering."""
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
    assert not vv.leftovers()


def test_an_interrupted_picture_shows_all_of_the_world(vv):
    vv.write(
        "white.wrl", HEADER +
        "Background { skyColor 1 1 1 } Shape { appearance Appearance { material Material { "
        "emissiveColor .5 .5 .5 } } geometry Sphere { } }")
    running = vv.start("white.wrl", "-o", "part.pfm", "--size", "320x240", "--spp", "65536",
                       "--threads", "1")
    wait_until_rendering(running)
    running.send_signal(signal.SIGINT)
    _, talk = running.communicate(timeout=30)
    assert running.returncode == 130, talk
    _, _, rows = read_pfm((vv.folder / "part.pfm").read_bytes())
    assert min(pixel[0] for row in rows for pixel in row) > 0.1  # every pixel has samples


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


def wait_for_handler(process, number):
    """Waits until the program handles the signal, which takes a while after its start on a busy
    machine."""
    for _ in range(1000):
        caught = re.search(r"SigCgt:\s*(\w+)",
                           pathlib.Path(f"/proc/{process.pid}/status").read_text())
        if int(caught[1], 16) >> (number - 1) & 1:
            return
        time.sleep(0.01)
    raise AssertionError(f"no handler of signal {number}")


def test_interrupt_before_there_is_anything(vv):
    os.mkfifo(vv.folder / "pipe.wrl")
    running = subprocess.Popen([vv.program, "-", "-o", "x.png"],
                               cwd=vv.folder,
                               stdin=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    wait_for_handler(running, signal.SIGINT)
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=10)
    assert running.returncode == 130 and not (vv.folder / "x.png").exists()


def test_instruction_sets(vv):
    small = "--size", "40x30", "--spp", "4"
    refused = vv("box.wrl", *small, "-o", "x.exr", "--isa", "mmx")
    assert refused.returncode == 2 and 'not "mmx"' in refused.talk, refused.talk
    assert "--isa: expected auto, or one that this machine has: " in refused.talk
    assert len(refused.talk.splitlines()) == 1
    for isa in refused.talk.split("has: ")[1].split(", not")[0].split(", "):
        for name, threads in (("one.exr", 1), ("two.exr", 2)):
            done = vv("box.wrl", *small, "-o", name, "--isa", isa, "--threads", threads, "--stats",
                      "stats.json")
            assert done.returncode == 0, done.talk
            stats = json.loads((vv.folder / "stats.json").read_text())
            assert stats["machine"]["isa"] == isa
        assert (vv.folder / "one.exr").read_bytes() == (vv.folder / "two.exr").read_bytes(), isa


# Reports ----------------------------------------------------------------------------------------


def test_statistics(vv):
    done = vv("box.wrl", "-o", "x.png", "--stats", "stats.json", "--size", "40x30", "--spp", "4",
              "--threads", "2")
    assert done.returncode == 0, done.talk
    stats = json.loads((vv.folder / "stats.json").read_text())
    assert stats["schema"] == 1 and stats["version"] and "box.wrl" in stats["command"]
    keys = {
        "scene":
            "path nodes shapes triangles unique_triangles objects instances textures lights warnings",
        "image":
            "width height spp spp_mean channels",
        "scripts":
            "scripts started calls seconds",
        "time":
            "parse graph start map build first_pass render write total",
        "rays":
            "camera shadow secondary per_second",
        "transport":
            "chosen reason claim leaves_out",
        "error":
            "mean_rel mean_rel_interval half_width p99 pixels_trusted unmet level method",
        "memory":
            "peak_rss bvh scene",
        "cluster":
            "workers tiles tiles_here retries duplicates bytes bytes_sent bytes_received machines",
        "left_out":
            "cut_by_depth cut_by_energy clipped unreached_lights shader_faults wrong_hits rejected_rays",
        "machine":
            "isa threads embree",
    }
    for group, names in keys.items():
        assert set(stats[group]) == set(names.split()), group
    assert stats["scene"]["path"] == "box.wrl" and stats["scene"]["shapes"] == 1 and stats["scene"][
        "warnings"] == 0
    assert stats["scene"]["triangles"] == 12
    assert stats["image"] == {
        "width": 40,
        "height": 30,
        "spp": 4,
        "spp_mean": 4,
        "channels": ["rgba"]
    }
    assert stats["rays"]["camera"] == 40 * 30 * 4
    assert stats["machine"]["threads"] == 2 and "Embree" in stats["machine"]["embree"]
    assert 0 < stats["time"]["render"] < stats["time"]["total"] < 60
    stages = ("parse", "graph", "start", "map", "render", "write")
    assert sum(stats["time"][stage] for stage in stages) <= stats["time"]["total"]
    assert stats["error"]["level"] == 0.95 and stats["error"]["mean_rel"] is None
    assert stats["memory"]["peak_rss"] > 1 << 20
    assert json.loads(vv("box.wrl", "-o", "x.png", "--stats", "-", *SMALL).text)["schema"] == 1


def test_the_error_in_statistics_is_that_of_error_bars_or_null_with_the_way_to_get_it(vv):
    without = "box.wrl -o a.exr --stats a.json --size 32x24 --spp 64".split()
    assert vv(*without).returncode == 0
    error = json.loads((vv.folder / "a.json").read_text())["error"]
    assert {error[key] for key in error if key not in ("level", "method")} == {None}
    assert "--channels rgba,error,trust or --error" in error["method"]
    assert vv(*without, "--channels", "rgba,error,trust").returncode == 0
    error = json.loads((vv.folder / "a.json").read_text())["error"]
    assert error["method"].startswith("replicated") and error["pixels_trusted"] > .9
    assert error["mean_rel"] >= 0 and error["half_width"] >= 0


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
    assert "standard" not in size
    solid = next(f for f in nodes["Box"]["fields"] if f["name"] == "solid")
    assert solid["standard"] == "ISO/IEC 19775-1"
    assert (nodes["Box"]["standard"], nodes["Box"]["clause"]) == ("ISO/IEC 14772-1", "6.7")
    group = nodes["StaticGroup"]
    assert (group["standard"], group["clause"]) == ("ISO/IEC 19775-1", "10.4.2")
    assert "standard" not in nodes["ORTSensor"]
    assert "ISO/IEC 19775-1 clause 10.4.2." in text
    box = text[text.index("Box {"):].split("}")[0]
    assert re.search(r"SFBool +solid +TRUE +# X3D", box)
    vv.write("proto.wrl", HEADER + "PROTO Lamp [ field SFFloat power 2.5 ] { Group { } } Lamp { }")
    data = json.loads(vv("proto.wrl", "--list-nodes", "--json").text)
    assert data["prototypes"][0]["name"] == "Lamp" and data["prototypes"][0]["fields"][0][
        "default"] == "2.5"


def test_list_viewpoints(vv):
    assert vv("box.wrl", "--list-viewpoints").text == "0\t-\tfront\n1\tBack\tfrom behind\n"
    data = json.loads(vv("box.wrl", "--list-viewpoints", "--json").text)
    assert [v["name"] for v in data] == ["", "Back"] and [v["description"] for v in data
                                                         ] == ["front", "from behind"]
    assert len(data[0]["matrix"]) == 16


def test_info(vv):
    text = vv("box.wrl", "--info").text
    assert "nodes" in text and "bounds      -1 -1 -1  to  1 1 1" in text
    data = json.loads(vv("box.wrl", "--info", "--json").text)
    assert data["bounds"] == {"minimum": [-1, -1, -1], "maximum": [1, 1, 1]}
    assert data["types"] == {
        "Appearance": 1,
        "Box": 1,
        "Material": 1,
        "Shape": 1,
        "Transform": 1,
        "Viewpoint": 2
    }
    assert set(data["names"]) == {"Back", "Place", "Thing", "Paint", "Cube"}
    vv.write("nothing.wrl", HEADER)
    assert json.loads(vv("nothing.wrl", "--info", "--json").text)["bounds"] is None


def test_info_of_the_head_of_an_x3d_file(vv):
    assert "file        VRML97 2.0\n" in vv("box.wrl", "--info").text
    vv.write(
        "head.x3dv", '#X3D V3.3 utf8\nPROFILE Interchange\nCOMPONENT Text:1\n'
        'UNIT mass gram 0.001\nMETA "title" "a box"\nShape { geometry Box { } }\n')
    text = vv("head.x3dv", "--info").text
    for line in ("file        X3D ClassicVRML 3.3, profile Interchange", "component   Text:1",
                 "unit        mass gram 0.001", "meta        title: a box"):
        assert line + "\n" in text, text
    assert json.loads(vv("head.x3dv", "--info", "--json").text)["file"] == {
        "encoding": "X3D ClassicVRML",
        "version": "3.3",
        "profile": "Interchange",
        "components": [{
            "name": "Text",
            "level": 1
        }],
        "units": [{
            "category": "mass",
            "name": "gram",
            "factor": 0.001
        }],
        "meta": [{
            "name": "title",
            "content": "a box"
        }]
    }


def test_write_round_trip(vv):
    done = vv("box.wrl", "--write", "copy.wrl")
    assert done.returncode == 0, done.talk
    assert vv("copy.wrl", "--write", "again.wrl").returncode == 0
    assert (vv.folder / "copy.wrl").read_bytes() == (vv.folder / "again.wrl").read_bytes()
    assert vv("box.wrl", "--write", "-").stdout == (vv.folder / "copy.wrl").read_bytes()
    assert vv.picture() == vv.picture(world="copy.wrl")


def test_write_x3d(vv):
    done = vv("box.wrl", "--write", "copy.x3dv")
    assert done.returncode == 0, done.talk
    text = (vv.folder / "copy.x3dv").read_bytes()
    assert text.startswith(b"#X3D V3.3 utf8\n")
    assert vv("box.wrl", "--write", "x3dv:-").stdout == text
    assert vv("copy.x3dv", "--write", "x3dv:again").returncode == 0
    assert (vv.folder / "again").read_bytes() == text
    assert vv.picture() == vv.picture(world="copy.x3dv")
    assert b"<X3D profile='Immersive' version='3.3'>" in vv("box.wrl", "--write", "x3d:-").stdout
    assert json.loads(vv("box.wrl", "--write", "x3dj:-").stdout)["X3D"]["@version"] == "3.3"
    assert vv("box.wrl", "--write", "x3d:").returncode == 2


def test_recording(vv):
    assert vv("box.wrl", "-o", "a.png", "--record", "scene.ort", *SMALL).returncode == 0
    assert (vv.folder / "scene.ort").stat().st_size > 0
    assert vv("box.wrl", "-o", "b.png", *SMALL).returncode == 0
    assert (vv.folder / "a.png").read_bytes() == (vv.folder / "b.png").read_bytes()


def test_empty_world_makes_a_picture(vv):
    vv.write("empty.wrl", HEADER)
    assert vv("empty.wrl", "-o", "x.ppm", *SMALL).returncode == 0
    assert all(
        p == (0, 0, 0) for row in read_ppm((vv.folder / "x.ppm").read_bytes())[2] for p in row)


def test_progress_lines(vv):
    """Without a terminal: a line every few seconds and no escape sequences."""
    running = vv.start("box.wrl", "-o", "x.png", *LONG)
    time.sleep(7)
    running.send_signal(signal.SIGINT)
    _, talk = running.communicate(timeout=30)
    assert b" %" in talk and b"\x1b" not in talk and b"\r" not in talk
    assert find_vv().exists()


def test_a_film_suffix_may_have_capitals(vv):
    done = vv("box.wrl", "--frames", "0-1", "-o", "a.GIF", "--size", "8x8", "--spp", "1")
    assert done.returncode == 0, done.talk
    assert (vv.folder / "a.GIF").read_bytes().startswith(b"GIF89a")


def test_lost_channels_are_told(vv):
    for name, told in (("a.ppm", True), ("a.jpg", True), ("a.png", True), ("a.pfm", True), ("a.exr",
                                                                                            False)):
        done = vv("box.wrl", "-o", name, "--channels", "z", "--size", "8x8", "--spp", "1")
        assert done.returncode == 0 and ("only EXR files keep channels" in done.talk) == told, name


def test_a_failed_write_names_the_option(vv):
    done = vv("box.wrl", "-o", "png:/dev/full", "--size", "8x8", "--spp", "1")
    assert done.returncode == 1 and "error: -o: cannot write /dev/full" in done.talk, done.talk


def test_a_negative_number_of_workers_is_named(vv):
    done = vv("box.wrl", "-o", "a.ppm", "--workers", "localhost", "--require-workers", "-1")
    assert done.returncode == 2 and "--require-workers: a whole number" in done.talk, done.talk
