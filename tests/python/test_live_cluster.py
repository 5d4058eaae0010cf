"""Tests moving pictures of a cluster while its workers die, stall and come back: previews in files, the
pages of `vv serve` and the control channel. Whatever happens to workers, the pictures are those
of one machine."""
import pytest

from cluster_tools import addresses, needs_worker, workers
from conftest import HEADER
from control_server import Server
from page_client import serve, wait_for  # noqa: F401
from window_driver import SPINNING, blue, coloured

SIZE = (160, 120)
# Geometry and nodes that are made anew while the world moves, and a matrix that is not a number.
CHANGING = HEADER + """
Viewpoint { position 0 0 6 }
PointLight { location 3 3 4 }
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Made Group { }
DEF Turned Transform { children Shape { geometry Box { size 1 1 1 } appearance
  Appearance { material Material { } } } }
DEF Maker Script { directOutput TRUE field SFNode made USE Made field SFNode turned USE Turned
  eventIn SFFloat at url "javascript: function at(v) {
    made.set_children = Browser.createVrmlFromString(
      'Transform { translation ' + (3 * v - 1.5) + ' 1 0 children Shape { geometry Sphere { radius .5 } } }');
    turned.translation = new SFVec3f(v > .3 && v < .5 ? NaN : v, -1, 0); }" }
ROUTE Clock.fraction_changed TO Maker.at
"""


def test_previews_in_files_are_those_of_one_machine(vv):
    needs_worker()
    vv.write("world.wrl", CHANGING)
    options = ("--frames", "0-19", "--preview", "--spp", 2, "--size", "%dx%d" % SIZE)
    assert vv("world.wrl", "-o", "alone.ppm", *options).returncode == 0
    with workers(3) as farm:
        farm[0].stop()  # it stalls: others get its jobs
        done = vv("world.wrl", "-o", "together.ppm", *options, "--local-threads", 1, "--workers",
                  addresses(farm))
        assert done.returncode == 0, done.talk
    for frame in range(20):
        alone, together = (vv.folder / f"{name}-{frame:04}.ppm" for name in ("alone", "together"))
        assert alone.read_bytes() == together.read_bytes(), frame


def test_a_page_survives_its_workers(serve, vv):
    """Workers die and come back while the world moves; then an Anchor leads to another world while
    they are in a frame. Its finished picture is that of one machine."""
    needs_worker()
    vv.write("other.wrl", coloured("0 0 1"))
    done = vv("other.wrl", "-o", "other.png", "--size", "%dx%d" % SIZE, "--spp", 4)
    assert done.returncode == 0, done.talk
    world = SPINNING + """
Transform { translation 0 1.5 0 children Anchor { url "other.wrl" children Shape {
  appearance Appearance { material Material { diffuseColor 0 1 0 } } geometry Sphere { radius .6 } } } }"""
    with workers(2) as farm:
        server = serve(world, "--spp", 4, "--workers", addresses(farm))
        page = server.join(*SIZE)

        def goes_on():
            count = len(page.pictures)
            page.until(lambda p: p.facts["preview"] and len(page.pictures) > count + 3)

        page.until(lambda p: p.facts["preview"])
        page.until_state(lambda s: "2 of 2" in s["facts"][0] or "worker" in s["facts"][0])
        goes_on()
        farm[0].kill()
        goes_on()
        farm[1].stop()
        goes_on()
        farm[0].start()
        farm[1].resume()
        goes_on()
        page.click(0, 0.6)  # no box passes in front of it
        page.still(lambda p: blue(*p.at(0, 0)))
        page.send(type="save", format="png")
        answer = server.get("/" + page.told("saved")["path"])
        assert answer.body == (vv.folder / "other.png").read_bytes()
        assert server.stop() == 0


@pytest.mark.parametrize("first", ["spinning", "still"])
def test_a_program_loads_worlds_while_workers_are_in_a_frame(vv, first):
    needs_worker()
    vv.write("spinning.wrl", SPINNING)
    vv.write("still.wrl", coloured("0 1 0"))
    vv.write("other.wrl", coloured("0 0 1"))
    options = ("--size", "%dx%d" % SIZE, "--spp", 16, "--epoch", 0)
    done = vv("other.wrl", "-o", "other.png", *options)
    assert done.returncode == 0, done.talk
    with workers(2) as farm:
        server = Server(vv.folder, f"{first}.wrl", *options, "--workers", addresses(farm))
        try:
            client = server.connect()
            for worker in (farm[0], farm[1], None):
                client.load(f"{first}.wrl")
                assert client.render().startswith(b"\x89PNG")
                client.load("other.wrl")
                assert client.render() == (vv.folder / "other.png").read_bytes()
                if worker:
                    worker.kill()
        finally:
            server.end()
