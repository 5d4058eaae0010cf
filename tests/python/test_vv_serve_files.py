"""Tests the files that pages of `vv serve` save: their bytes, who waits for whom, and giving up."""
import io
import re

import pytest

from cluster_tools import addresses, needs_worker, workers
from conftest import exr_channels
from page_client import Image, serve  # noqa: F401
from window_driver import SENSORS, SPINNING, green

SIZE = (160, 120)


def saved(server, page, kind):
    count = len(page.of("saved"))
    page.send(type="save", format=kind)
    told = page.told("saved", count + 1)
    assert re.fullmatch(r"saved/[0-9a-f]{32}/world-\d+\." + kind, told["path"])
    assert told["path"].endswith(told["name"])
    answer = server.get("/" + told["path"])
    assert answer.status == 200
    assert answer.headers["Content-Disposition"] == f'attachment; filename="{told["name"]}"'
    return answer.body


@pytest.mark.parametrize("kind", ["png", "exr"])
def test_saved_pictures_have_the_bytes_of_vv(serve, vv, kind):
    vv.write("world.wrl", SENSORS)
    server = serve("world.wrl", "--spp", 3, "--epoch", 0)
    page, guest = server.join(*SIZE), server.join(96, 64)
    page.still()
    guest.still()
    guest.send(type="own")
    guest.until_state(lambda s: s["role"] == "own")
    guest.send(type="viewpoint", number=1)
    for one, viewpoint, size in ((page, 0, "160x120"), (guest, 1, "96x64"), (page, 0, "160x120")):
        one.until_state(lambda s, v=viewpoint: s["viewpoint"] == v)
        data = saved(server, one, kind)
        done = vv("world.wrl", "-o", f"x.{kind}", "--size", size, "--spp", 3, "--viewpoint",
                  viewpoint, "--epoch", 0)
        assert done.returncode == 0, done.talk
        assert data == (vv.folder / f"x.{kind}").read_bytes()


def test_a_page_saves_one_picture_at_a_time(serve):
    server = serve(SENSORS, "--spp", 1)
    page = server.join(1600, 1200)
    page.still()
    for _ in range(200):
        page.send(type="save", format="exr")
    page.command()  # all of them have been read
    page.told("saved")
    saved(server, page, "png")
    # The file of the first takes longer to make than the others take to arrive.
    assert len(page.of("saved")) < 20


def test_a_page_that_saves_all_the_time_leaves_the_others_their_pictures(serve):
    server = serve(SPINNING, "--spp", 1024)
    page, saver = server.join(*SIZE), server.join(*SIZE)
    page.until(lambda p: p.facts["preview"])
    saved(server, saver, "png")
    for _ in range(2):
        count = len(page.pictures)
        saved(server, saver, "png")
        # Between two files there is time for as many samples, thus for many previews.
        assert len(page.pictures) > count + 4


def test_saving_while_something_moves(serve):
    server = serve(SPINNING, "--spp", 8)
    page = server.join(*SIZE)
    page.until(lambda p: p.facts["preview"])
    data = saved(server, page, "png")
    with Image.open(io.BytesIO(data)) as picture:
        assert picture.size == SIZE and "preview" not in str(picture.info)
    assert set(exr_channels(saved(server, page, "exr"))) >= {"R", "G", "B"}
    count = len(page.pictures)  # and the world goes on
    page.until(lambda p: len(page.pictures) > count + 5)


def test_saving_can_be_given_up(serve):
    page = serve(SPINNING, "--spp", 65536).join(*SIZE)
    page.until(lambda p: p.facts["preview"])
    page.send(type="save", format="png")
    page.until_state(lambda s: "Escape gives up" in s["bottom"])
    page.key("Escape")
    page.until_state(lambda s: s["bottom"] == "the picture is not saved")
    count = len(page.pictures)
    page.until(lambda p: len(page.pictures) > count + 5)
    assert page.of("saved") == []


def test_a_cluster_renders_for_the_page(serve, vv):
    needs_worker()
    vv.write("world.wrl", SENSORS)
    assert vv("world.wrl", "-o", "x.png", "--size", "%dx%d" % SIZE, "--spp", 4).returncode == 0
    with workers(1) as ports:
        server = serve("world.wrl", "--spp", 4, "--workers", addresses(ports))
        page = server.join(*SIZE)
        page.until_state(lambda s: "1 of 1" in s["facts"][0] or "worker" in s["facts"][0])
        page.still()
        assert saved(server, page, "png") == (vv.folder / "x.png").read_bytes()
        page.click(-0.35, 0)
        page.still(lambda p: green(*p.at(-0.35, 0)))
        assert server.stop() == 0
