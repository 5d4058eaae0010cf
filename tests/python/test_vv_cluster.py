"""Tests vv with real openrt-workers on loopback: the same bytes as without workers, messages when
something is wrong, statistics."""
import json
import os
import re
import signal
import time

import pytest

from cluster_tools import addresses, free_port, needs_worker, new_key, workers
from conftest import HEADER, SMALL
from window_driver import framebuffer_row, screen, window  # noqa: F401

SIZE = ("--size", "64x48")
# A bit of everything that a picture can contain: shadows, a mirror, glass, a texture; path traced
# because of its emitter.
ROOM = HEADER + """
Viewpoint { position 0 0.4 6 }
PointLight { location 2 4 3 intensity 0.7 }
Transform { translation 0 -1.2 0 children Shape { appearance Appearance { material Material { diffuseColor .7 .6 .5 } }
  geometry Box { size 8 .2 8 } } }
Transform { translation -1 0 0 children Shape { appearance Appearance { material Material { diffuseColor .8 .1 .1 }
  texture PixelTexture { image 2 2 3 0xff0000 0x00ff00 0x0000ff 0xffffff } } geometry Sphere { } } }
Transform { translation 1.2 0 0 children Shape { appearance Appearance { material Material { diffuseColor .2 .3 .9
  specularColor .9 .9 .9 shininess .6 } } geometry Cone { } } }
Transform { translation 0 2.5 -1 children Shape { appearance Appearance { material Material { emissiveColor 1 1 .7 } }
  geometry Box { size 1 .1 1 } } }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Way PositionInterpolator { key [0, 0.5, 1] keyValue [-2 0 1, 2 0 1, -2 0 1] }
DEF Place Transform { children Shape { appearance Appearance { material Material { emissiveColor 0 1 0 } }
  geometry Box { size .5 .5 .5 } } }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
"""


@pytest.fixture
def room(vv):
    vv.write("room.wrl", ROOM)
    return vv


@pytest.fixture(scope="module")
def two():
    with workers(2) as started:
        yield started


def machines(path, here=False):
    return [m for m in json.loads(path.read_text())["cluster"]["machines"] if m["here"] == here]


# The same bytes ---------------------------------------------------------------------------------


@pytest.mark.parametrize("quality", [("--spp", 4), ("--spp", 96, "--transport", "path"),
                                     ("--spp", 64, "--error", "20%"),
                                     ("--spp", 33, "--crop", "17,9,30x20")],
                         ids=["few samples", "many samples", "to an error", "a part"])
def test_the_same_bytes_with_workers_and_without(room, two, quality):
    outputs = ("-o", "{}.png", "-o", "{}.exr", "--channels",
               "rgba,z,normal,albedo,position,id,samples,variance,cryptomatte")
    common = ("room.wrl", *SIZE, *quality)
    assert room(*common, *[o.format("alone") for o in outputs], "--threads", 1).returncode == 0
    for name, how in (("both", ()), ("remote", ("--local-threads", 0, "--require-workers", 2))):
        done = room(*common, *[o.format(name) for o in outputs], "--workers", addresses(two), *how,
                    "--stats", name + ".json")
        assert done.returncode == 0, done.talk
        for suffix in ("png", "exr"):
            assert (room.folder /
                    f"{name}.{suffix}").read_bytes() == (room.folder /
                                                         f"alone.{suffix}").read_bytes(), (name,
                                                                                           suffix)
    assert sum(m["tiles"] for m in machines(room.folder / "remote.json")) > 0
    assert sum(m["tiles"] for m in machines(room.folder / "remote.json", here=True)) == 0


@pytest.mark.parametrize("split", ["auto", "tiles", "samples", "frames"])
def test_an_animation_has_the_same_bytes(room, two, split):
    common = ("room.wrl", "--frames", "0-19", "--fps", 10, "--size", "40x30", "--spp", 2)
    assert room(*common, "-o", "alone-{frame:2}.png").returncode == 0
    done = room(*common, "-o", "many-{frame:2}.png", "--workers", addresses(two), "--split", split,
                "--stats", "many.json")
    assert done.returncode == 0, done.talk
    pictures = {(room.folder / f"alone-{n:02}.png").read_bytes() for n in range(20)}
    assert len(pictures) > 10, "it moves"
    for n in range(20):
        assert (room.folder /
                f"many-{n:02}.png").read_bytes() == (room.folder /
                                                     f"alone-{n:02}.png").read_bytes(), n
    stats = json.loads((room.folder / "many.json").read_text())
    assert [f["frame"] for f in stats["frames"]] == list(range(20))
    assert sum(f["time"]["render"] for f in stats["frames"]) <= stats["time"]["total"]


def test_all_viewpoints_and_a_turntable_with_workers(room, two):
    for job in (("--viewpoint", "all"), ("--turntable", 3)):
        for name, how in (("a", ()), ("b", ("--workers", addresses(two)))):
            assert room("box.wrl", *job, *SMALL, "-o", name + ".ppm", *how).returncode == 0
        first = sorted(room.folder.glob("a-*.ppm"))
        assert len(first) >= 2
        for path in first:
            assert path.read_bytes() == (room.folder /
                                         path.name.replace("a-", "b-", 1)).read_bytes(), path


def test_workers_call_in(room):
    needs_worker()
    port = free_port()
    assert room("room.wrl", *SIZE, "-o", "alone.png").returncode == 0
    with workers(2, "--connect", f"127.0.0.1:{port}", listen=False):
        done = room("room.wrl", *SIZE, "-o", "called.png", "--listen-workers", f"127.0.0.1:{port}",
                    "--require-workers", 2, "--local-threads", 0)
    assert done.returncode == 0, done.talk
    assert (room.folder / "called.png").read_bytes() == (room.folder / "alone.png").read_bytes()


def test_a_hosts_file(room, two):
    room.write("hosts.txt",
               "# two machines\n\n%s # the first\n  %s\n" % tuple(w.address for w in two))
    done = room("room.wrl", *SIZE, "-o", "x.png", "--workers", "@hosts.txt", "--require-workers", 2,
                "--stats", "x.json")
    assert done.returncode == 0, done.talk
    assert len(machines(room.folder / "x.json")) == 2


# Keys -------------------------------------------------------------------------------------------


def test_with_a_key(room):
    needs_worker()
    new_key(room.folder / "cluster.key")
    assert room("room.wrl", *SIZE, "-o", "alone.png").returncode == 0
    with workers(1, "--key", room.folder / "cluster.key") as started:
        done = room("room.wrl", *SIZE, "-o", "key.png", "--workers", addresses(started), "--key",
                    "cluster.key", "--require-workers", "--local-threads", 0)
    assert done.returncode == 0, done.talk
    assert (room.folder / "key.png").read_bytes() == (room.folder / "alone.png").read_bytes()


def test_a_key_that_others_may_read(room):
    needs_worker()
    new_key(room.folder / "open.key")
    (room.folder / "open.key").chmod(0o644)
    done = room("box.wrl", *SMALL, "-o", "x.png", "--workers", "127.0.0.1:1", "--key", "open.key")
    assert done.returncode == 3 and "open.key" in done.talk and "chmod" in done.talk, done.talk
    done = room("box.wrl", *SMALL, "-o", "x.png", "--workers", "127.0.0.1:1", "--key",
                "missing.key")
    assert done.returncode == 3 and "missing.key" in done.talk and os.strerror(
        2) in done.talk, done.talk
    assert not (room.folder / "x.png").exists()


@pytest.mark.parametrize("where", [("--workers", "192.0.2.1"), ("--listen-workers", "0.0.0.0")])
def test_plain_addresses_are_refused_with_the_remedy(room, where):
    needs_worker()
    done = room("box.wrl", *SMALL, "-o", "x.png", *where)
    assert done.returncode == 2 and not (room.folder / "x.png").exists(), done.talk
    assert where[
        1] in done.talk and "openrt-worker --new-key" in done.talk and "--key" in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1, done.talk


# Workers that are not there ---------------------------------------------------------------------


def test_nobody_answers(room):
    needs_worker()
    assert room("room.wrl", *SIZE, "-o", "alone.png").returncode == 0
    done = room("room.wrl", *SIZE, "-o", "x.png", "--workers", f"127.0.0.1:{free_port()}",
                "--stats", "x.json")
    assert done.returncode == 0, done.talk
    assert (room.folder / "x.png").read_bytes() == (room.folder / "alone.png").read_bytes()
    assert json.loads((room.folder / "x.json").read_text())["cluster"]["workers"] == 0


def test_too_few_workers(room):
    """The timeout is ten seconds, so both cases run at the same time."""
    needs_worker()
    for name in ("ours.key", "theirs.key"):
        new_key(room.folder / name)
    with workers(1) as plain, workers(1, "--key", room.folder / "theirs.key") as foreign:
        wrong = ("room.wrl", *SIZE, "--workers", addresses(foreign), "--key", "ours.key")
        runs = [
            room.start(*wrong, "-o", "a.png", "--require-workers"),
            room.start("room.wrl", *SIZE, "-o", "b.png", "--workers",
                       f"{plain[0].address},127.0.0.1:{free_port()}", "--require-workers", 2)
        ]
        done = room(*wrong, "-o", "alone.png")
        assert done.returncode == 0 and (room.folder /
                                         "alone.png").exists(), "this machine makes it alone"
        talks = [run.communicate(timeout=60)[1].decode() for run in runs]
    assert [run.returncode for run in runs] == [6, 6], talks
    assert "key" in talks[0] and "1 worker is needed, there are 0" in talks[0], talks
    assert "2 workers are needed, there is 1" in talks[1], talks
    assert all(talk.count("vv: error:") == 1 for talk in talks)
    assert not (room.folder / "a.png").exists() and not (room.folder / "b.png").exists()


def test_all_workers_die(room):
    """The picture is finished locally, with the same bytes, and one message says so."""
    needs_worker()
    common = ("room.wrl", "--size", "160x120", "--spp", 128, "--transport", "path")
    assert room(*common, "-o", "alone.png").returncode == 0
    with workers(2) as started:
        running = room.start(*common, "-o", "x.png", "--workers", addresses(started), "--stats",
                             "x.json", "-v", "--local-threads", 0)
        talk, joined = "", 0
        while joined < 2 and (line := running.stderr.readline().decode()):
            talk += line
            joined += "has joined" in line
        for worker in started:
            worker.process.kill()
        talk += running.communicate(timeout=120)[1].decode()
    assert running.returncode == 0, talk
    assert (room.folder / "x.png").read_bytes() == (room.folder / "alone.png").read_bytes()
    assert talk.count("alone") == 1, talk
    assert all(not m["alive"] for m in machines(room.folder / "x.json"))


def test_progress_tells_of_workers_and_an_interrupt_saves_what_there_is(room, two):
    running = room.start("room.wrl", "--size", "1600x1200", "--spp", 4096, "--workers",
                         addresses(two), "-o", "part.ppm")
    time.sleep(7)
    running.send_signal(signal.SIGINT)
    _, talk = running.communicate(timeout=60)
    assert running.returncode == 130 and b"is saved" in talk, talk
    assert (room.folder / "part.ppm").exists()
    assert re.search(rb"vv: +\d+ %.*2 workers", talk), talk


# Talk -------------------------------------------------------------------------------------------


def test_statistics(room, two):
    done = room("room.wrl", *SIZE, "-o", "x.png", "--workers", addresses(two), "--require-workers",
                2, "--stats", "x.json", "-v")
    assert done.returncode == 0, done.talk
    cluster = json.loads((room.folder / "x.json").read_text())["cluster"]
    assert {
        "workers", "tiles", "tiles_here", "retries", "duplicates", "bytes", "bytes_sent",
        "bytes_received", "machines"
    } <= set(cluster)
    assert cluster["workers"] == 2 and cluster[
        "bytes"] == cluster["bytes_sent"] + cluster["bytes_received"] > 0
    assert len(cluster["machines"]) == 3 and sum(m["here"] for m in cluster["machines"]) == 1
    for machine in cluster["machines"]:
        assert {
            "name", "alive", "threads", "tiles", "rays", "bytes_sent", "bytes_received", "late",
            "lost", "busy", "latency"
        } <= set(machine)
        assert machine["alive"]
    assert sum(m["tiles"] for m in cluster["machines"]) == cluster["tiles"] + cluster["tiles_here"]
    assert all(m["threads"] == 1 for m in cluster["machines"] if not m["here"])
    assert "2 workers" in done.talk and "this process" in done.talk and "latency" in done.talk, done.talk
    for worker in two:
        assert worker.address in done.talk


def test_without_a_cluster_its_statistics_are_empty(vv):
    assert vv("box.wrl", *SMALL, "-o", "x.png", "--stats", "x.json").returncode == 0
    cluster = json.loads((vv.folder / "x.json").read_text())["cluster"]
    assert (cluster["workers"], cluster["tiles"], cluster["bytes"], cluster["machines"]) == (0, 0,
                                                                                             0, [])


@pytest.mark.parametrize("arguments, text", [
    (("--key", "k"), "--key needs --workers or --listen-workers"),
    (("--split", "tiles"), "--split needs --workers"),
    (("--local-threads", "0"), "--local-threads needs --workers"),
    (("--require-workers",), "--require-workers needs --workers"),
    (("--tolerant",), "--tolerant needs --workers"),
    (("--workers", "a", "--allow-keys", "k"), "--allow-keys needs --key"),
    (("--workers", ""), "--workers: HOST[:PORT],... or @FILE was expected"),
    (("--workers", "@"), "--workers: HOST[:PORT],... or @FILE was expected"),
    (("--workers", "a", "--split", "halves"),
     "--split: auto, tiles, samples or frames was expected"),
    (("--workers", "a", "--require-workers", "0"), "--require-workers: "),
    (("--workers", "a", "--local-threads", "-1"), "--local-threads: "),
    (("--worker", "a"), "did you mean --workers?"),
])
def test_usage(vv, arguments, text):
    done = vv("box.wrl", *SMALL, "-o", "x.png", *arguments)
    assert done.returncode == 2 and text in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1


def test_it_says_that_no_worker_answered(vv):
    needs_worker()
    done = vv("box.wrl", *SMALL, "-o", "x.png", "--workers", "127.0.0.1:9")
    assert done.returncode == 0, done.talk
    assert "vv: warning: no worker answered; this machine made the picture alone" in done.talk


def test_workers_are_for_pictures(vv):
    done = vv("box.wrl", "--check", "--workers", "127.0.0.1")
    assert done.returncode == 2 and "need -o, the window or vv serve" in done.talk


@pytest.mark.parametrize("content, line", [("127.0.0.1:7447\nhost:port\n", 2),
                                           ("# nothing\n\na b c\n", 3), ("x:99999\n", 1)])
def test_a_hosts_file_with_errors(vv, content, line):
    needs_worker()
    vv.write("hosts.txt", content)
    done = vv("box.wrl", *SMALL, "-o", "x.png", "--workers", "@hosts.txt")
    assert done.returncode == 3 and f"hosts.txt:{line}" in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1


def test_a_hosts_file_that_is_no_use(vv):
    needs_worker()
    done = vv("box.wrl", *SMALL, "-o", "x.png", "--workers", "@missing.txt")
    assert done.returncode == 3 and "missing.txt" in done.talk and os.strerror(
        2) in done.talk, done.talk
    vv.write("empty.txt", "# nobody\n")
    done = vv("box.wrl", *SMALL, "-o", "x.png", "--workers", "@empty.txt")
    assert done.returncode == 3 and "empty.txt" in done.talk, done.talk


# The window -------------------------------------------------------------------------------------


def test_the_window_with_a_worker(window, vv, two):  # noqa: F811
    vv.write("room.wrl", ROOM.replace("loop TRUE", "loop FALSE"))
    alone = window("room.wrl", "--time", 0).still()
    opened = window("room.wrl", "--time", 0, "--workers", addresses(two), "--local-threads", 0)
    opened.until(lambda shot: shot.rows == alone.rows)
    opened.key("i")  # shows all known information
    assert opened.end() == 0, opened.err


def test_a_window_whose_world_moves_and_comes_to_rest(window, vv, two, screen):  # noqa: F811
    """During motion pictures overlap and are shown; the last one equals the one without workers."""
    vv.write("room.wrl", ROOM)
    vv.write(
        "in.txt",
        "0.1 down Left\n0.6 up Left\n0.7 press left 0 0.5\n0.9 move 0.3 0.1\n1.2 release left\n1.4 save w.ppm\n2 quit\n"
    )
    opened = window(ROOM, "--spp", 2, "--input", "in.txt", "--workers", addresses(two),
                    "--local-threads", 0)
    top = int(re.search(r"\bY=(\d+)", opened.tool("getwindowgeometry", "--shell", opened.id))[1])
    seen = set()
    while opened.program.poll() is None:
        seen.add(framebuffer_row(screen[1], top + 60))  # the middle, where there is no text
        time.sleep(0.01)
    assert opened.program.wait(60) == 0, opened.err
    assert len(seen) > 3, "nothing moves"
    assert vv("room.wrl", "-o", "alone.ppm", "--size", "160x120", "--spp", 2, "--input", "in.txt",
              "--time", 1.4).returncode == 0
    assert (vv.folder / "w.ppm").read_bytes() == (vv.folder / "alone.ppm").read_bytes()


def test_a_window_whose_worker_dies_goes_on(window, vv):  # noqa: F811
    with workers(1) as started:
        opened = window(ROOM, "--workers", addresses(started), "--local-threads", 0, "--spp", 2)
        started[0].process.kill()
        opened.said("alone")
        opened.shot()
        assert opened.end() == 0


def test_the_window_is_not_opened_for_addresses_that_cannot_be_used(vv):
    needs_worker()
    done = vv("box.wrl", "--workers", "192.0.2.1", env={"DISPLAY": ":no"})
    assert done.returncode == 2 and "--new-key" in done.talk, done.talk
