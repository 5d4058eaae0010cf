"""Tests the page of `vv serve` in headless Chromium, with real clicks, drags, fingers and keys.
Skipped where Chromium is not installed. $VV_SCREENSHOTS names a folder for pictures to look at."""
import os
import pathlib

import pytest

import webdriver
from conftest import HEADER
from page_client import Image, serve  # noqa: F401
from window_driver import SENSORS, SPINNING, blue, green, red

CANVAS = "#picture"
PAGE_DOWN, ARROW_UP = "\ue00f", "\ue013"  # keys of the WebDriver protocol


@pytest.fixture
def browser(tmp_path):
    if webdriver.missing():
        pytest.skip(f"{webdriver.missing()} is not installed")
    one = webdriver.Browser(tmp_path)
    yield one
    one.quit()


def open_page(browser, server):
    browser.open(server.url)
    first_picture(browser)


def first_picture(browser):
    browser.until(
        lambda: browser.script("return document.getElementById('picture').dataset.picture"),
        "a picture")


def pixel(browser, x, y):
    """Returns the colour of the page's picture at a place from -1 to 1."""
    return browser.script(
        "const c = document.getElementById('picture');"
        "return [...c.getContext('2d').getImageData(Math.floor((arguments[0] + 1) / 2 * c.width),"
        " Math.floor((1 - arguments[1]) / 2 * c.height), 1, 1).data].slice(0, 3)", x, y)


def until_pixel(browser, x, y, colour):
    browser.until(lambda: colour(*pixel(browser, x, y)), f"{colour.__name__} at {x}, {y}")


def state(browser):
    return browser.script("return window.page.state")


def until_state(browser, test, what):
    browser.until(lambda: test(state(browser)), what)


def finished(browser):
    browser.until(
        lambda: browser.script("return document.getElementById('picture').dataset.finished") ==
        "true", "a finished picture")


def keep(browser, name):
    """Keeps a screenshot for looking at, and tells that it shows something."""
    folder = pathlib.Path(os.environ.get("VV_SCREENSHOTS", "."))
    path = folder / f"{name}.png"
    if "VV_SCREENSHOTS" not in os.environ:
        return
    browser.screenshot(path)
    with Image.open(path) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 10


def errors(browser):
    return [line for line in browser.log() if line.startswith("SEVERE")]


def test_a_click_works_a_sensor_and_a_drag_moves_another(browser, serve):
    open_page(browser, serve(SENSORS, "--spp", 1))
    until_pixel(browser, -0.3, 0, red)
    browser.drag(CANVAS, (-0.3, 0))  # a click
    until_pixel(browser, -0.3, 0, green)
    assert blue(*pixel(browser, 0.3, 0))
    browser.drag(CANVAS, (0.3, 0), (0.3, 0.2), (0.3, 0.5))
    until_pixel(browser, 0.3, 0.5, blue)
    browser.until(lambda: not blue(*pixel(browser, 0.3, -0.1)), "the old place is free")
    assert "hand" in browser.script("return document.getElementById('picture').className")
    finished(browser)
    keep(browser, "serve-sensors")
    assert errors(browser) == []


def go_back(browser, arrived):
    """Returns to the viewpoint, and waits for the end of the transition: until then the viewer
    does not follow drags."""
    browser.script("document.getElementById('picture').focus()")
    browser.keys("\ue003")  # backspace
    browser.until(arrived, "back")
    finished(browser)


def test_drags_wheel_and_fingers_move_the_viewer(browser, serve):
    open_page(browser, serve(SENSORS, "--spp", 1))
    until_pixel(browser, -0.3, 0, red)
    across = [(-0.9, 0.9), (0, 0.9), (0.9, 0.9)]  # almost half a turn
    browser.drag(CANVAS, *across)
    until_pixel(browser, -0.3, 0, blue)
    go_back(browser, lambda: red(*pixel(browser, -0.3, 0)))
    browser.wheel(CANVAS, 0, 0.9, -500)
    until_pixel(browser, -0.6, 0, red)
    go_back(browser, lambda: not red(*pixel(browser, -0.6, 0)))
    # Two fingers apart come nearer.
    browser.actions(
        browser.pointer(CANVAS, [(-0.1, 0.8), (-0.2, 0.8), (-0.5, 0.8)], kind="touch", name="one"),
        browser.pointer(CANVAS, [(0.1, 0.8), (0.2, 0.8), (0.5, 0.8)], kind="touch", name="two"))
    until_pixel(browser, -0.6, 0, red)
    go_back(browser, lambda: not red(*pixel(browser, -0.6, 0)))
    browser.drag(CANVAS, *across, kind="touch")  # one finger turns
    until_pixel(browser, -0.3, 0, blue)
    assert errors(browser) == []


def test_the_list_of_viewpoints_and_the_keys(browser, serve):
    open_page(browser, serve(SENSORS, "--spp", 1))
    until_state(browser, lambda s: s.get("viewpoint") == 0, "the front")
    options = browser.script(
        "return [...document.querySelectorAll('#viewpoints option')].map(o => o.textContent)")
    assert options == ["Viewpoint", "front", "side"]
    browser.script("const s = document.getElementById('viewpoints'); s.value = '1';"
                   "s.dispatchEvent(new Event('change'));")
    until_state(browser, lambda s: s["viewpoint"] == 1, "the side")
    browser.keys(PAGE_DOWN)
    until_state(browser, lambda s: s["viewpoint"] == 0, "the front again")
    browser.keys("3")
    until_state(browser, lambda s: s["bottom"] == "fly", "flying")
    assert browser.text("#hint") == "fly"
    browser.click("#help")
    assert "frame all" in browser.text("#content")
    keep(browser, "serve-help")
    browser.click("#close")
    browser.keys("c")
    browser.until(lambda: browser.text("#content").startswith("vv world.wrl"), "the command")
    browser.click("#close")
    browser.keys("i")
    browser.until(lambda: "triangles" in browser.text("#facts"), "all facts")
    assert errors(browser) == []


def test_files_are_downloaded(browser, serve, vv):
    open_page(browser, serve(SENSORS, "--spp", 1))
    finished(browser)
    browser.click("#png")
    path = vv.folder / "world-1.png"
    browser.until(path.exists, "the file")
    size = browser.script(
        "const c = document.getElementById('picture'); return [c.width, c.height]")
    with Image.open(path) as picture:
        assert list(picture.size) == size
    browser.click("#exr")
    browser.until((vv.folder / "world-2.exr").exists, "the OpenEXR file")


def test_two_pages(browser, serve):
    server = serve(SENSORS, "--spp", 1)
    open_page(browser, server)
    first = browser.handle()
    until_pixel(browser, -0.3, 0, red)
    second = browser.new_tab()
    open_page(browser, server)
    until_state(browser, lambda s: s.get("role") == "follower", "following")
    until_pixel(browser, -0.3, 0, red)
    assert "Following" in browser.text("#role")
    browser.click("#own")
    until_state(browser, lambda s: s["role"] == "own", "an own view")
    browser.script("const s = document.getElementById('viewpoints'); s.value = '1';"
                   "s.dispatchEvent(new Event('change'));")
    until_state(browser, lambda s: s["viewpoint"] == 1, "the side")
    keep(browser, "serve-own-view")
    browser.switch(first)
    until_state(browser, lambda s: s["pages"] == 2 and s["viewpoint"] == 0, "the front")
    browser.drag(CANVAS, (-0.3, 0))  # both see what a sensor does
    until_pixel(browser, -0.3, 0, green)
    browser.switch(second)
    browser.click("#own")
    until_state(browser, lambda s: s["role"] == "follower", "following again")
    until_pixel(browser, -0.3, 0, green)
    assert errors(browser) == []


def test_a_lost_connection_comes_back(browser, serve):
    server = serve(SENSORS, "--spp", 1)
    open_page(browser, server)
    until_pixel(browser, -0.3, 0, red)
    browser.drag(CANVAS, (-0.3, 0))
    until_pixel(browser, -0.3, 0, green)
    server.kill()
    browser.until(lambda: "lost" in browser.text("#lost"), "the page says so")
    keep(browser, "serve-lost")
    again = serve("world.wrl", "--spp", 1, "--port", server.port)
    assert again.port == server.port
    browser.until(lambda: browser.script("return document.body.dataset.connection") == "connected",
                  "the connection")
    until_pixel(browser, -0.3, 0, red)  # a new process shows the world from its beginning
    assert browser.text("#lost") == ""


def test_texts_of_the_world_are_no_html(browser, serve):
    world = HEADER + """
Viewpoint { position 0 0 5 description "<img src=x onerror=alert(1)>" }
Anchor { url "javascript:alert(1)" description "<b>bold</b>" children Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box {} } }
"""
    open_page(browser, serve(world, "--spp", 1))
    until_pixel(browser, 0, 0, red)
    browser.drag(CANVAS, (0, 0))
    browser.until(lambda: "javascript" in browser.text("#hint"), "why the anchor leads nowhere")
    assert browser.script("return document.querySelectorAll('img, #hint *').length") == 0
    assert len(browser.handles()) == 1 and errors(browser) == []


def test_the_token_leaves_the_address(browser, serve):
    server = serve(SENSORS, "--spp", 1, "--token", "new")
    open_page(browser, server)
    until_pixel(browser, -0.3, 0, red)
    assert browser.script("return location.search") == ""
    assert browser.script("return document.cookie") == ""  # scripts do not see it


def test_a_moving_world_is_shown(browser, serve):
    open_page(browser, serve(SPINNING))
    until_state(browser, lambda s: s.get("facts", [""])[0].startswith("preview"), "a preview")
    seen = {browser.script("return document.getElementById('picture').dataset.picture")}
    browser.until(
        lambda: seen.add(browser.script("return document.getElementById('picture').dataset.picture")
                        ) or len(seen) > 5, "pictures")
    keep(browser, "serve-moving")
