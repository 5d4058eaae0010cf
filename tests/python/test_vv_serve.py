"""Tests `vv serve` with real HTTP and WebSockets: the page, its pictures, input, several pages and
files. test_vv_serve_access.py has visitors that are hostile or not allowed, page_client.py the
client."""
import os
import re
import subprocess
import time

import pytest

from conftest import HEADER, find_vv
from page_client import Image, serve, wait_for  # noqa: F401
from window_driver import SENSORS, SPINNING, blue, coloured, green, red

SIZE = (160, 120)


def looks_like(shown, path, difference=12):
    """Tells whether a JPEG picture shows the same as a file."""
    with Image.open(path) as file:
        wanted = file.convert("RGB")
    if wanted.size != shown.image.size:
        return False
    pairs = zip(shown.image.getdata(), wanted.getdata())
    far = sum(max(abs(a - b) for a, b in zip(p, q)) > difference for p, q in pairs)
    return far < wanted.width * wanted.height / 50


# --- The page ---


def test_the_page_is_served_with_its_policy(serve):
    server = serve("box.wrl")
    page = server.get("/")
    assert page.status == 200 and b"page.js" in page.body
    policy = page.headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy and "unsafe" not in policy
    for name, kind in (("page.js", "text/javascript"), ("page.css", "text/css"), ("icon-48.png",
                                                                                  "image/png")):
        answer = server.get("/" + name)
        assert answer.status == 200 and answer.headers["Content-Type"].startswith(kind)
        assert "http" not in re.sub(rb'"https?:"', b"", answer.body).decode("latin-1")
    assert server.get("/nothing").status == 404
    assert server.get("/..%2f..%2fetc/passwd").status == 404
    assert server.get("/", method="POST").status == 405
    assert server.stop() == 0


def test_interrupted_without_visitors(serve):
    server = serve("box.wrl")
    assert server.stop() == 0 and server.errors == []


@pytest.mark.parametrize("world, code", [("no.wrl", 3), ("empty.wrl", 3)])
def test_a_world_that_cannot_be_read(serve, vv, world, code):
    (vv.folder / "empty.wrl").write_text("")
    served = vv("serve", world, "--port", 0)
    drawn = vv(world, "-o", "x.png")
    assert (served.returncode, served.talk) == (drawn.returncode, drawn.talk)
    assert served.returncode == code and served.text == ""


def test_options_that_do_not_fit(serve, vv):
    for arguments, text in ((["serve", "box.wrl", "-o",
                              "x.png"], "vv serve shows the world"), (["serve"], "a world"),
                            (["box.wrl", "--port",
                              "8"], "need vv serve"), (["serve", "box.wrl", "--port",
                                                        "70000"], "--port"),
                            (["serve", "box.wrl", "--input",
                              "x"], "--input"), (["serve", "box.wrl", "--token",
                                                  "short"], "16 to 128 characters"),
                            (["serve", "box.wrl", "--address", "0.0.0.0"], "needs a token"),
                            (["serve", "box.wrl", "--address", "example.org", "--token", "new"],
                             "an IP address"), (["serve", "box.wrl", "--token",
                                                 "@/dev/zero"], "16 to 128")):
        done = vv(*arguments)
        assert done.returncode == 2 and text in done.talk, (arguments, done.talk)
    assert "vv serve" in vv("serve", "--help").text


def test_a_port_that_is_in_use(serve, vv):
    server = serve("box.wrl")
    done = vv("serve", "box.wrl", "--port", server.port)
    assert done.returncode == 1 and str(server.port) in done.talk
    assert len(done.talk.splitlines()) == 1


def test_an_address_of_another_machine(serve, vv):
    for address in ("192.0.2.1", "2001:db8::1"):  # for documentation
        done = vv("serve", "box.wrl", "--address", address, "--token", "new")
        assert done.returncode == 1 and address in done.talk and done.text == ""


# --- Pictures and input ---


def test_the_picture_is_that_of_vv(serve, vv):
    vv.write("world.wrl", SENSORS)
    assert vv("world.wrl", "-o", "x.png", "--size", "%dx%d" % SIZE, "--spp", 4).returncode == 0
    page = serve("world.wrl", "--spp", 4).join(*SIZE)
    shown = page.still()
    assert shown.facts["samples"] == 4 and not shown.facts["preview"]
    assert looks_like(shown, vv.folder / "x.png")
    keys = [key for key, text in page.told("hello")["keys"]]
    assert "H" in keys and "L" not in keys  # pages have no false colours
    assert page.viewpoints == ["front", "side"]
    assert page.state["world"] == "world.wrl" and page.state["viewpoint"] == 0


def test_pictures_follow_the_size_of_the_page(serve):
    page = serve(SENSORS, "--spp", 1).join(*SIZE)
    page.still()
    page.send(type="size", width=200, height=64)
    page.still(lambda p: (p.width, p.height) == (200, 64))
    page.send(type="size", width=65536, height=65536)
    largest = page.until(lambda p: p.facts["finished"] and p.width > 200)
    assert largest.width * largest.height <= 4194304


def test_a_drag_turns_and_the_wheel_goes_nearer(serve):
    page = serve(SENSORS, "--spp", 1).join(*SIZE)
    page.still()
    page.drag(0, 0.9, 0.5, 0.9)
    wait_for(lambda: page.camera()[0][0] < -1, "turned")
    page.key("Backspace")
    wait_for(lambda: page.camera()[0] == [0, 0, 10], "back")
    page.send(type="wheel", amount=2)
    wait_for(lambda: 3 < page.camera()[0][2] < 9, "nearer")


def test_sensors_work(serve):
    page = serve(SENSORS, "--spp", 1).join(*SIZE)
    assert red(*page.still().at(-0.35, 0))
    page.send(type="move", x=-0.35, y=0)
    page.until_state(lambda s: s["hand"])
    page.click(-0.35, 0)
    page.still(lambda p: green(*p.at(-0.35, 0)))
    before = page.camera()
    page.drag(0.36, 0, 0.36, 0.5)
    page.still(lambda p: blue(*p.at(0.36, 0.5)) and not blue(*p.at(0.36, 0)))
    assert page.camera() == before


def test_viewpoints_and_keys(serve):
    page = serve(SENSORS, "--spp", 1).join(*SIZE)
    page.still()
    page.send(type="viewpoint", number=1)
    page.until_state(lambda s: s["viewpoint"] == 1)
    wait_for(lambda: abs(page.camera()[0][0] - 10) < 1e-6, "the side")
    page.send(type="viewpoint", number=99)
    page.key("PageUp")
    page.until_state(lambda s: s["viewpoint"] == 0)
    page.key("3")
    page.until_state(lambda s: s["bottom"] == "fly")
    page.send(type="down", key="Up")
    wait_for(lambda: page.camera()[0][2] < 9.5, "flying")
    page.send(type="up", key="Up")


def test_viewpoints_with_names_like_numbers(serve):
    page = serve(HEADER + 'Viewpoint { position 0 0 5 description "1" } '
                 'Viewpoint { position 0 0 6 description "x" } '
                 'Viewpoint { position 0 0 7 description "0" } Shape { geometry Box {} }').join()
    page.still()
    for number in (2, 1, 0):
        page.send(type="viewpoint", number=number)
        wait_for(lambda n=number: abs(page.camera()[0][2] - 5 - n) < 1e-6, f"number {number}")


def test_moving_worlds_are_previews_and_say_so(serve):
    page = serve(SPINNING).join(*SIZE)
    page.until(lambda p: p.facts["preview"] and not p.facts["finished"])
    page.until_state(lambda s: s["facts"][0].startswith("preview"))
    page.key("N")
    page.until_state(lambda s: s["facts"][0].startswith("raw samples"))
    page.key("P")
    page.still()
    page.until_state(lambda s: "paused" in s["facts"][0])


def test_anchors_lead_to_worlds_and_pages(serve, vv):
    vv.write("other.wrl", coloured("0 0 1"))
    world = HEADER + """
Viewpoint { position 0 0 10 }
Anchor { url "https://example.org/a?b" description "the web" children Transform { translation -2 0 0
  children Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box {} } } }
Anchor { url "other.wrl" children Transform { translation 2 0 0
  children Shape { appearance Appearance { material Material { diffuseColor 0 1 0 } } geometry Box {} } } }
"""
    page = serve(world, "--spp", 1).join(*SIZE)
    page.still()
    page.send(type="move", x=-0.35, y=0)
    page.until_state(lambda s: s["bottom"] == "the web")
    page.click(-0.35, 0)
    assert page.told("open")["url"] == "https://example.org/a?b"
    page.click(0.35, 0)
    page.still(lambda p: blue(*p.at(0, 0)))
    page.until_state(lambda s: s["world"] == "other.wrl")


def test_the_viewpoint_of_the_command_line_is_of_its_world(serve, vv):
    vv.write("other.wrl", coloured("0 0 1"))
    page = serve(
        HEADER + """
Viewpoint { position 0 0 10 } Viewpoint { position 0 0 5 description "near" }
Anchor { url "other.wrl" children Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box {} } }
""", "--spp", 1, "--viewpoint", "near").join(*SIZE)
    page.still()
    assert page.camera()[0][2] == 5
    page.click(0, 0)
    page.still(lambda p: blue(*p.at(0, 0)))
    page.until_state(lambda s: s["world"] == "other.wrl")


def test_the_changes_of_the_command_line_are_of_its_world(serve, vv):
    vv.write("other.wrl", coloured("0 0 1"))
    vv.write(
        "first.wrl", HEADER + """
Viewpoint { position 0 0 5 }
Anchor { url "other.wrl" children DEF Thing Shape { appearance Appearance {
  material DEF Paint Material { diffuseColor 1 0 0 } } geometry Box {} } }
""")
    page = serve("first.wrl", "--spp", 1, "-D", "Paint.diffuseColor=0 1 0", "--shader",
                 "Thing=Diffuse:reflectance=0,1,0").join(*SIZE)
    page.still(lambda p: green(*p.at(0, 0)))
    page.click(0, 0)
    page.still(lambda p: blue(*p.at(0, 0)))
    page.until_state(lambda s: s["world"] == "other.wrl")


def test_a_world_opens_few_pages_of_the_web(serve):
    engines = subprocess.run([find_vv(), "--list-engines"], capture_output=True, text=True).stdout
    if "javascript" not in engines:
        pytest.skip("no ECMAScript engine is built")
    page = serve(
        HEADER + """
Viewpoint { position 0 0 5 }
Shape { geometry Box {} }
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Opener Script { eventIn SFTime tick directOutput TRUE
  url "javascript: function tick(v) {
    Browser.loadURL(new MFString('https://example.org/'), new MFString()); }" }
ROUTE Clock.time TO Opener.tick
""", "--spp", 1).join(*SIZE)
    page.until_state(lambda s: "maxOpensPerMinute" in s["bottom"])
    time.sleep(1)  # 30 steps
    assert 4 <= len(page.of("open")) <= 6


def test_anchors_keep_to_the_rules_of_worlds(serve, vv):
    world = HEADER + """
Viewpoint { position 0 0 5 }
Anchor { url "/etc/hostname" children Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box {} } }
"""
    page = serve(world, "--spp", 1).join(*SIZE)
    page.still()
    page.click(0, 0)
    page.until_state(lambda s: "absolute paths" in s["bottom"])
    assert red(*page.pictures[-1].at(0, 0))


def test_scripts_run(serve):
    engines = subprocess.run([find_vv(), "--list-engines"], capture_output=True, text=True).stdout
    if "javascript" not in engines:
        pytest.skip("no ECMAScript engine is built")
    page = serve(
        HEADER + """
Viewpoint { position 0 0 5 }
Group { children [ DEF Touch TouchSensor {} Shape {
  appearance Appearance { material DEF Paint Material { diffuseColor 1 0 0 } } geometry Box {} } ] }
DEF Change Script { eventIn SFTime touched eventOut SFColor colour
  url "javascript: function touched(v) { colour = new SFColor(0, 1, 0); }" }
ROUTE Touch.touchTime TO Change.touched
ROUTE Change.colour TO Paint.set_diffuseColor
""", "--spp", 1).join(*SIZE)
    page.still(lambda p: red(*p.at(0, 0)))
    page.click(0, 0)
    page.still(lambda p: green(*p.at(0, 0)))


def test_reloading(serve, vv):
    server = serve(coloured("1 0 0"), "--spp", 1)
    page, other = server.join(*SIZE), server.join(*SIZE)
    page.still(lambda p: red(*p.at(0, 0)))
    other.still()
    other.send(type="own")
    other.until_state(lambda s: s["role"] == "own")
    vv.write("world.wrl", coloured("0 0 1"))
    other.key("R")
    other.until_state(lambda s: "only the page that leads" in s["bottom"])
    page.key("R")
    page.still(lambda p: blue(*p.at(0, 0)))
    other.still(lambda p: blue(*p.at(0, 0)))


# --- Several pages ---


def test_a_second_page_follows_and_may_leave(serve):
    server = serve(SENSORS, "--spp", 1)
    first, second = server.join(*SIZE), None
    first.still()
    second = server.join(*SIZE)
    second.still()
    second.until_state(lambda s: s["role"] == "follower" and s["pages"] == 2)
    first.until_state(lambda s: s["role"] == "leader" and s["pages"] == 2)
    second.drag(0, -0.9, 0.5, -0.9)  # a follower moves nothing
    first.drag(0, -0.9, 0.3, -0.9)
    wait_for(lambda: second.camera()[0][0] < -0.5, "following")
    wait_for(lambda: second.camera()[0] == first.camera()[0], "the same place")

    second.send(type="own")
    second.until_state(lambda s: s["role"] == "own")
    place = first.camera()
    second.drag(0, -0.9, 0.5, -0.9)
    wait_for(lambda: second.camera()[0][0] < place[0][0] - 1, "an own view")
    assert first.camera() == place
    second.send(type="viewpoint", number=1)
    wait_for(lambda: abs(second.camera()[0][0] - 10) < 1e-6, "the side")
    second.until_state(lambda s: s["viewpoint"] == 1)
    assert first.camera() == place

    second.send(type="follow")
    wait_for(lambda: second.camera() == place, "following again")
    first.close()
    second.until_state(lambda s: s["role"] == "leader" and s["pages"] == 1)
    assert second.camera() == place


def test_an_own_view_has_its_own_pictures_and_works_sensors(serve):
    server = serve(SENSORS, "--spp", 2)
    first = server.join(*SIZE)
    assert red(*first.still().at(-0.35, 0))
    second = server.join(100, 100)
    second.still()
    second.send(type="own")
    second.still(lambda p: (p.width, p.height) == (100, 100))
    second.key("3")
    second.send(type="down", key="Up")
    wait_for(lambda: second.camera()[0][2] < 9, "flying")
    second.send(type="up", key="Up")
    second.send(type="viewpoint", number=0)
    wait_for(lambda: second.camera()[0] == [0, 0, 10], "the front")
    second.still()
    second.click(-0.45, 0)  # both see what it does
    first.still(lambda p: green(*p.at(-0.35, 0)))
    second.still(lambda p: green(*p.at(-0.45, 0)))
    assert first.camera()[0] == [0, 0, 10]


def test_all_views_are_drawn_while_the_world_moves(serve):
    server = serve(SPINNING)
    pages = [server.join(*SIZE) for _ in range(3)]
    for page in pages:
        page.until(lambda p: True)
    for page in pages[1:]:
        page.send(type="own")
        page.until_state(lambda s: s["role"] == "own")
    counts = [len(page.pictures) for page in pages]
    wait_for(lambda: all(len(p.pictures) > n + 10 for p, n in zip(pages, counts)), "pictures")


def test_a_silent_page_costs_the_others_nothing(serve):
    server = serve(SPINNING)
    page = server.join(*SIZE)
    silent = server.join(*SIZE, silent=True)
    silent.until(lambda p: True)
    count = len(page.pictures)
    wait_for(lambda: len(page.pictures) > count + 20, "pictures")
    assert len(silent.pictures) == 1
    # It gets the newest picture when it wakes up.
    silent.send(type="shown", picture=silent.pictures[0].facts["picture"])
    newest = wait_for(lambda: len(silent.pictures) == 2 and silent.pictures[1], "the second")
    assert newest.facts["picture"] >= page.pictures[count + 10].facts["picture"]


def test_nothing_is_drawn_while_nobody_looks(serve):
    server = serve(SPINNING)
    page = server.join(*SIZE)
    page.until(lambda p: len(page.pictures) > 3)
    page.silent = True  # as a hidden page is
    time.sleep(3)
    before = server.cpu()
    time.sleep(2)
    assert server.cpu() - before < 0.1


def test_idle_costs_nothing(serve):
    server = serve(SENSORS, "--spp", 1)
    page = server.join(*SIZE)
    page.still()
    time.sleep(1.5)
    before, count = server.cpu(), len(page.pictures)
    time.sleep(3)
    assert server.cpu() - before < 0.1 and len(page.pictures) == count


def test_the_command_gives_the_same_view(serve, vv):
    server = serve(SENSORS, "--spp", 2, "--shadows", "off")
    page = server.join(*SIZE)
    page.still()
    page.drag(0, -0.9, 0.3, -0.7)

    def has_turned():
        camera = page.camera()
        time.sleep(0.3)  # the whole drag has been followed when the camera stands still
        return camera[0][0] < -1 and page.camera() == camera

    wait_for(has_turned, "turned")
    words = page.command()
    assert words[0] == "vv" and "off" in words and "serve" not in words
    done = vv(*words[1:-2], "-o", "again.png")
    assert done.returncode == 0, done.talk
    page.still(lambda p: looks_like(p, vv.folder / "again.png"))


# --- Memory ---


def memory(server, what):
    """Returns megabytes: VmRSS (now) or VmHWM (at most so far)."""
    with open(f"/proc/{server.program.pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(what))


@pytest.mark.skipif("TSAN_OPTIONS" in os.environ, reason="the sanitizer multiplies memory")
def test_the_views_of_all_pages_share_a_budget_and_give_it_back(serve):
    server = serve(coloured("1 1 0"), "--spp", 2)
    before = memory(server, "VmRSS")
    pages = [server.join(4096, 1024)]
    pages[0].still(lambda p: (p.width, p.height) == (4096, 1024))
    for _ in range(3):
        page = server.join(4096, 1024)
        page.send(type="own")
        page.until_state(lambda s: s["role"] == "own")
        pages.append(page)
    for page in pages:  # four views of a quarter of maxViewPixels
        shown = page.until(lambda p: p.facts["finished"] and p.width < 4096)
        assert 2_000_000 < shown.width * shown.height <= 8388608 / 4
    assert memory(server, "VmHWM") < before + 2000  # docs/limits.md: 1.8 GB for all views
    for page in pages:
        page.close()
    wait_for(lambda: memory(server, "VmRSS") < before + 150, "the memory is given back")
    page = server.join(320, 80)
    page.still(lambda p: (p.width, p.height) == (320, 80))  # after the last one of before
