"""Tests the window on a cluster whose workers die, stall and come back while its user drags, resizes
and minimises it, and saves pictures in motion: they are those of one machine without a window."""
import time

from cluster_tools import addresses, needs_worker, workers
from window_driver import SIZE, SPINNING, screen, window  # noqa: F401

# In motion by itself, with light that is sampled.
MOVING = SPINNING + """
NavigationInfo { type [ "EXAMINE" "ANY" ] }
Background { skyColor [ .6 .7 .9 ] }
Transform { translation 0 -1.2 0 children Shape { appearance Appearance { material Material {
  diffuseColor .7 .7 .7 } } geometry Box { size 6 .2 6 } } }
"""


def save(w):
    """Presses S while something moves and waits for the file."""
    count = sum("saved as" in line for line in w.err)
    w.key("s")
    w.said("saved as", count + 1)


def test_pictures_saved_in_motion_are_the_headless_ones_whatever_happens_to_workers(window, vv):
    needs_worker()
    samples = 8
    with workers(2) as farm:
        w = window(MOVING, "--transport", "path", "--spp", samples, "--record-input", "in.txt",
                   "--workers", addresses(farm))
        w.drag(0, 0.8, 0.4, 0.6)
        save(w)
        farm[0].stop()  # it stalls
        w.drag(0, 0.8, -0.3, 0.7)
        save(w)
        farm[1].kill()
        w.drag(0, 0.8, 0.2, 0.4, button=2)
        save(w)
        farm[0].resume()
        farm[1].start()
        w.key("3", "H", "i")
        w.tool("keydown", "Up")
        time.sleep(0.3)
        w.tool("keyup", "Up")
        save(w)
        assert w.end() == 0
    times = [
        line.split()[0]
        for line in (vv.folder / "in.txt").read_text().splitlines()
        if line.split()[1:3] == ["down", "S"]
    ]
    saved = sorted(vv.folder.glob("world-*.png"), key=lambda p: int(p.stem.split("-")[1]))
    assert len(saved) == len(times) == 4
    for path, at in zip(saved, times):
        done = vv("world.wrl", "--input", "in.txt", "--time", at, "--transport", "path", "-o",
                  "h.png", "--size", "%dx%d" % SIZE, "--spp", samples)
        assert done.returncode == 0, done.talk
        assert path.read_bytes() == (vv.folder / "h.png").read_bytes(), at


def test_the_window_on_a_cluster_is_resized_and_hidden_and_comes_back(window):
    needs_worker()
    with workers(2) as farm:
        w = window(MOVING, "--spp", 4, "--workers", addresses(farm))
        for size in ((240, 200), (90, 50), (320, 100)):
            w.tool("windowsize", w.id, *size)
            farm[0].kill()
            w.until(lambda s: (s.width, s.height) == size)
            farm[0].start()
        w.tool("windowunmap", "--sync", w.id)
        farm[1].kill()
        time.sleep(0.3)
        w.tool("windowmap", "--sync", w.id)
        w.tool("windowfocus", "--sync", w.id)
        first = w.shot().bytes
        w.until(lambda s: s.bytes != first)
        assert w.end() == 0
