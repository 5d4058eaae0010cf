"""Tests the editor on the page of `vv serve --edit` in headless Chromium, with real clicks, drags and
keys, on a page of 800x600. Skipped where Chromium is not installed. $VV_SCREENSHOTS names a folder
for pictures to look at."""
import pytest

from conftest import HEADER
from page_client import serve  # noqa: F401
from serve_edit_tools import WORLD
from test_vv_serve_browser import (  # noqa: F401
    CANVAS, browser, errors, finished, first_picture, keep, until_pixel)
from window_driver import SENSORS, blue, green, red

ARROW_DOWN, ARROW_RIGHT, ARROW_LEFT = "\ue015", "\ue014", "\ue012"
ESCAPE, ENTER, TAB, CONTROL, SHIFT = "\ue00c", "\ue007", "\ue004", "\ue009", "\ue008"


def open_editor(browser, server):
    address = server.url.split("?")[0] + "?token=" + server.edit_token
    browser.open(address)
    first_picture(browser)
    until_row(browser, "")
    assert "token" not in browser.script("return location.href")


def until_script(browser, text, *arguments):
    return browser.until(lambda: browser.script("return " + text, *arguments), text)


def labels(browser):
    return browser.script(
        "return [...document.querySelectorAll('.row .label')].map(e => e.textContent)")


def until_row(browser, part):
    browser.until(lambda: any(part in label for label in labels(browser)), f"a row with {part}")


def row(browser, label):
    """Returns a selector of the row."""
    until_row(browser, label)
    rows = labels(browser)
    number = next(i for i, one in enumerate(rows) if label in one)
    return f".row:nth-child({number + 1})"


def open_row(browser, label):
    browser.click(row(browser, label) + " .sign")


def until_title(browser, title):
    until_script(browser, "document.getElementById('title').textContent === arguments[0]", title)


def select_paint(browser):
    open_row(browser, "THING")
    open_row(browser, "Appearance")
    browser.click(row(browser, "PAINT") + " .label")
    until_title(browser, "PAINT  Material")


def number_input(name, place=1):
    return f".field[data-field={name}] input[type=number]:nth-of-type({place})"


def type_into(browser, selector, text):
    browser.script("const i = document.querySelector(arguments[0]); i.focus(); i.select();", selector)
    browser.keys(*text, ENTER)


def shown(browser, selector):
    return browser.script("return document.querySelector(arguments[0]).value", selector)


def press_with(browser, modifier, key):
    steps = [("keyDown", modifier), ("keyDown", key), ("keyUp", key), ("keyUp", modifier)]
    browser.actions({
        "type": "key",
        "id": "keys",
        "actions": [{
            "type": kind,
            "value": value
        } for kind, value in steps]
    })


def press_with_control(browser, key):
    press_with(browser, CONTROL, key)


def drag_sideways(browser, selector, distance):
    """Drags an element with the mouse by so many pixels."""
    x, y = browser.script(
        "const e = document.querySelector(arguments[0]); e.scrollIntoView({ block: 'center' });"
        "const r = e.getBoundingClientRect();"
        "return [Math.round(r.left + r.width / 2), Math.round(r.top + r.height / 2)]", selector)
    steps = [{"type": "pointerMove", "duration": 20, "x": x, "y": y, "origin": "viewport"}]
    steps.append({"type": "pointerDown", "button": 0})
    for i in (1, 2, 3, 4):
        steps.append({
            "type": "pointerMove",
            "duration": 40,
            "x": x + distance * i // 4,
            "y": y,
            "origin": "viewport"
        })
    steps.append({"type": "pointerUp", "button": 0})
    browser.actions(browser.pointer_steps(steps))


def test_numbers_are_typed_and_dragged_undone_and_saved(browser, serve, vv):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    until_pixel(browser, 0, 0, red)
    select_paint(browser)
    keep(browser, "serve-edit")
    type_into(browser, number_input("diffuseColor", 1), "0")
    type_into(browser, number_input("diffuseColor", 3), "1")
    until_pixel(browser, 0, 0, blue)
    press_with_control(browser, "z")
    press_with_control(browser, "z")
    until_pixel(browser, 0, 0, red)
    press_with_control(browser, "y")
    press_with_control(browser, "y")
    until_pixel(browser, 0, 0, blue)
    press_with_control(browser, "s")
    until_script(browser, "document.body.dataset.unsaved === 'false'")
    assert (vv.folder / "world.wrl").read_text() == WORLD.replace("1 0 0", "0 0 1")

    drag_sideways(browser, number_input("shininess"), 40)
    until_script(browser, "document.getElementById('undo').title.includes('Material.shininess')")
    assert float(shown(browser, number_input("shininess"))) > 0.2
    browser.click("#undo")
    browser.until(lambda: shown(browser, number_input("shininess")) == "0.2", "undone as one step")
    browser.click(".field[data-field=diffuseColor] .reset")
    browser.until(lambda: shown(browser, number_input("diffuseColor")) == "0.8", "the default")
    assert "default" in browser.script(
        "return document.querySelector('.field[data-field=diffuseColor]').className")
    assert errors(browser) == []


def test_clicks_on_the_picture_select_and_with_alt_work_sensors(browser, serve):
    open_editor(browser, serve(SENSORS, "--edit", "--spp", 1))
    until_pixel(browser, -0.5, 0, red)
    browser.drag(CANVAS, (-0.5, 0))
    until_script(browser, "document.getElementById('title').textContent.includes('Shape')")
    until_script(browser, "document.querySelectorAll('#frames line').length === 12")
    finished(browser)
    until_pixel(browser, -0.5, 0.02, red)  # no sensor was worked
    keep(browser, "serve-edit-selected")
    browser.click("#show-outline")
    browser.click("#show-sheet")
    browser.drag(CANVAS, (-0.3, 0))
    until_pixel(browser, -0.3, 0, green)
    assert errors(browser) == []


def test_the_keyboard_reaches_everything(browser, serve):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    until_row(browser, "LIGHTS")
    browser.script("document.getElementById('rows').focus()")
    browser.keys(ARROW_DOWN, ARROW_DOWN, ARROW_RIGHT)
    until_row(browser, "LAMP")
    browser.keys(ARROW_DOWN, ENTER)
    until_title(browser, "LAMP  PointLight")
    browser.script("document.getElementById('rename').focus()")
    browser.keys(TAB)
    assert browser.script("return document.activeElement.closest('.field') !== null")
    unnamed = browser.script(
        "return [...document.querySelectorAll('#work input, #work select, #work textarea')].filter("
        "  e => !e.getAttribute('aria-label')).length")
    assert unnamed == 0
    box = browser.script("const r = document.getElementById('picture').getBoundingClientRect();"
                         "return [r.width, r.height, document.documentElement.scrollWidth]")
    assert box[0] > 250 and box[1] > 300 and box[2] <= browser.script("return window.innerWidth")
    assert errors(browser) == []


def test_hostile_names_are_texts(browser, serve):
    markup = "<img/src=x/onerror=window.hurt=1>"
    open_editor(
        browser,
        serve(
            HEADER + "Viewpoint { position 0 0 5 } DEF %s Group { children DEF B Shape {"
            " geometry Text { string [ \"<b>x</b>\" ] } } }" % markup, "--edit", "--spp", 1))
    browser.click(row(browser, markup) + " .label")
    until_title(browser, markup + "  Group")
    assert browser.script("return document.querySelectorAll('#work img, #work b').length") == 0
    assert browser.script("return window.hurt") is None
    assert errors(browser) == []


def test_lists_are_tables(browser, serve):
    open_editor(
        browser,
        serve(HEADER + "Viewpoint { position 0 0 5 } DEF S Shape { geometry DEF P IndexedFaceSet {"
              " coord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 ] } }",
              "--edit", "--spp", 1))
    open_row(browser, "S  Shape")
    open_row(browser, "P  IndexedFaceSet")
    browser.click(row(browser, "C  Coordinate") + " .label")
    until_title(browser, "C  Coordinate")
    rows = "document.querySelectorAll('.field[data-field=point] tr').length"
    until_script(browser, rows + " === 3")
    browser.click(".field[data-field=point] .list > button")
    until_script(browser, rows + " === 4")
    browser.click(".field[data-field=point] tr:nth-child(1) td:last-child button")
    until_script(browser, rows + " === 3")
    assert shown(browser, ".field[data-field=point] tr:nth-child(1) input") == "1"
    press_with_control(browser, "z")
    until_script(browser, rows + " === 4")
    assert errors(browser) == []


@pytest.mark.parametrize("answer, ends", [("#replace", "diffuseColor 0 0 0 }"),
                                          ("#dont", "# by another")])
def test_the_page_asks_before_it_replaces_a_file(browser, serve, vv, answer, ends):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    select_paint(browser)
    type_into(browser, number_input("diffuseColor", 1), "0")
    until_script(browser, "document.body.dataset.unsaved === 'true'")
    (vv.folder / "world.wrl").write_text(WORLD + "# by another")
    browser.click("#save")
    until_script(browser, "document.getElementById('question') !== null")
    browser.click(answer)
    browser.until(lambda: ends in (vv.folder / "world.wrl").read_text(), ends)
    assert errors(browser) == []


# --- Sessions: a lens, a lamp, and the light on a wall ---

ROOM = HEADER + """
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DEF LAMP Transform { translation 0 2 0 children [ # by hand
  ORTLight { shader ORTShader { name "Luminaire" file "luminaire" options "1f lumen 1256.6371" } }
] }
DEF WALL Transform { translation 0 0 -4 children Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options "color reflectance .6 .6 .6" } }
  geometry Box { size 30 30 2 } } }
DEF LENS Shape {
  appearance ORTAppearance { shader DEF GLASS ORTShader { name "Glass" file "glass"
    exposedField SFFloat index 1.5 } }
  geometry Sphere { radius .7 } }
"""


def probe_text(browser):
    return browser.script("return document.querySelector('#readings li')?.textContent ?? ''")


def until_probe(browser, *parts):
    browser.until(lambda: all(part in probe_text(browser) for part in parts), parts)
    return probe_text(browser)


def handle(browser, axis):
    """Returns the place of the head of a handle, from -1 to 1."""
    found = "window.editor.tools.handles.list.find(h => h.axis === arguments[0])?.end"
    return until_script(browser, found, axis)


def move_pointer(browser, x, y):
    px, py = browser.point(CANVAS, x, y)
    steps = [{"type": "pointerMove", "duration": 40, "x": px + d, "y": py, "origin": "viewport"}
             for d in (3, 0)]  # yapf: disable
    browser.actions(browser.pointer_steps(steps))


def test_a_lens_and_a_lamp_are_changed(browser, serve, vv):
    open_editor(browser, serve(ROOM, "--edit", "--spp", 16))
    finished(browser)
    browser.drag(CANVAS, (0, 0))  # a click on the lens
    until_title(browser, "LENS  Shape")
    browser.script("document.querySelector('#look .link').dispatchEvent("
                   "new MouseEvent('contextmenu', { cancelable: true }))")
    until_script(browser, "document.querySelector('#content pre')?.textContent ==="
                 " '--shader LENS=glass/Glass:index=1.5'")
    browser.script("document.getElementById('panel').close()")
    until_script(browser, "document.querySelector('#look .link').textContent === 'Glass'")
    browser.click("#look button:nth-of-type(2)")
    until_title(browser, "GLASS  ORTShader")
    type_into(browser, number_input("index"), "1.8")
    until_script(browser, "document.getElementById('undo').title.includes('ORTShader.index')")

    browser.click(row(browser, "LAMP") + " .label")
    until_title(browser, "LAMP  Transform")
    x, y = handle(browser, 0)
    keep(browser, "serve-edit-handles")
    browser.drag(CANVAS, (x, y), (x + 0.03, y), (x + 0.1, y), (x + 0.2, y))
    until_script(browser, "document.getElementById('undo').title.includes('Move Transform')")
    browser.until(lambda: float(shown(browser, number_input("translation", 1))) > 0.3, "moved")
    assert shown(browser, number_input("translation", 2)) == "2"
    press_with_control(browser, "z")
    browser.until(lambda: shown(browser, number_input("translation", 1)) == "0", "undone")
    press_with_control(browser, "s")
    until_script(browser, "document.body.dataset.unsaved === 'false'")
    assert (vv.folder / "world.wrl").read_text() == ROOM.replace("index 1.5", "index 1.8")
    assert errors(browser) == []


def test_the_light_of_a_lamp_is_measured_and_compared(browser, serve, vv):
    # Light by way of the lens would take very many samples until it is trusted.
    room = ROOM[:ROOM.index("DEF LENS")]
    open_editor(browser, serve(room, "--edit", "--spp", 64))
    finished(browser)
    browser.click(row(browser, "LAMP") + " .label")
    until_title(browser, "LAMP  Transform")
    browser.script("document.getElementById('picture').focus()")
    move_pointer(browser, -0.6, 0.6)
    browser.keys("u")
    assert "\u00b1" in until_probe(browser, "lx trusted")
    type_into(browser, "#readings input", "Desk")
    browser.script("document.getElementById('picture').focus()")
    browser.keys("b")
    until_script(browser, "window.editor.light.state.complete === true")
    move_pointer(browser, 0.3, 0.6)
    browser.keys("g", "x", "3")
    until_script(browser, "document.getElementById('tool').textContent.includes('along x: 3')")
    keep(browser, "serve-edit-tool")
    browser.keys(ENTER)
    until_script(browser, "document.getElementById('tool').textContent === ''")
    assert shown(browser, number_input("translation", 1)) == "3"
    until_probe(browser, "B - A: -", " significant")
    assert shown(browser, "#readings input") == "Desk"
    wraps = browser.script(
        "return [...document.querySelectorAll('.quantity')].map(e => e.getClientRects().length)")
    assert set(wraps) == {1}

    browser.keys("\\")
    until_script(browser, "window.editor.light.state.shown === 'a'")
    until_script(browser, "!document.getElementById('cover').hidden")
    keep(browser, "serve-edit-a")
    browser.keys("w")
    until_script(browser, "!document.getElementById('wiper').hidden")
    until_script(browser, "!document.getElementById('cover').hidden")
    browser.script("document.getElementById('wiper').focus()")
    browser.keys(ARROW_LEFT, ARROW_LEFT)
    assert browser.script("return document.getElementById('wiper').ariaValueNow") == "46"
    keep(browser, "serve-edit-wiper")
    browser.keys("d")
    until_script(browser, "window.editor.light.state.significant > 0")
    until_script(browser, "document.getElementById('legend').textContent.includes('darker')")
    keep(browser, "serve-edit-changes")
    browser.keys(ESCAPE)
    until_script(browser, "window.editor.light.state.shown === 'present'")

    press_with_control(browser, "z")
    browser.until(lambda: shown(browser, number_input("translation", 1)) == "0", "undone")
    press_with_control(browser, "y")
    browser.until(lambda: shown(browser, number_input("translation", 1)) == "3", "done again")
    press_with_control(browser, "s")
    until_script(browser, "document.body.dataset.unsaved === 'false'")
    wanted = room.replace("translation 0 2 0", "translation 3 2 0")
    assert (vv.folder / "world.wrl").read_text() == wanted
    assert errors(browser) == []


def test_nodes_are_put_into_fields_by_the_keyboard(browser, serve, vv):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    browser.click(row(browser, "LIGHTS") + " .label")
    until_title(browser, "LIGHTS  Group")
    add = ".field[data-field=children] .links > button"
    browser.script("document.querySelector(arguments[0]).focus()", add)
    browser.keys(ENTER)
    until_script(browser, "document.querySelector('.chooser').open")
    keep(browser, "serve-edit-chooser")
    browser.keys(*"spotl", ENTER)
    chips = "[...document.querySelectorAll('.field[data-field=children] .link')].map(e => e.textContent)"
    browser.until(lambda: browser.script("return " + chips) == ["LAMP  PointLight", "SpotLight"],
                  "a SpotLight")
    assert browser.script("return document.querySelector('.chooser').open") is False
    browser.click(".field[data-field=children] .chip:nth-of-type(2) button:nth-of-type(2)")
    browser.until(lambda: browser.script("return " + chips) == ["SpotLight", "LAMP  PointLight"],
                  "moved up")
    browser.keys("w", "d")  # no A has been kept: the page says so and goes on
    until_script(browser, "document.getElementById('said').textContent.includes('kept as A')")
    browser.click(row(browser, "THING") + " .label")
    until_title(browser, "THING  Shape")
    browser.click("#look .link")
    until_script(browser, "document.querySelector('.chooser').open")
    browser.keys(*"physical", ENTER)
    until_script(browser, "document.querySelector('#look .link').textContent === 'PhysicalMaterial'")
    press_with_control(browser, "s")
    until_script(browser, "document.body.dataset.unsaved === 'false'")
    text = (vv.folder / "world.wrl").read_text()
    assert "SpotLight" in text and "PhysicalMaterial" in text and "# on the table" in text
    browser.keys("\ue031")  # F1
    until_script(browser, "document.getElementById('content').textContent.includes('duplicate')")
    unnamed = browser.script(
        "return [...document.querySelectorAll('#work input, #work select, #work textarea, "
        "#work button, .chooser input')].filter(e => !e.getAttribute('aria-label') && !e.textContent)"
        ".length")
    assert unnamed == 0
    assert errors(browser) == []


def test_problems_and_reports(browser, serve, tmp_path):
    world = WORLD.replace("geometry DEF BLOCK Box { }", "geometry DEF BLOCK Box { size -1 1 1 }")
    open_editor(browser, serve(world, "--edit", "--spp", 1))
    until_script(browser, "document.getElementById('show-problems').textContent !== 'Problems (0)'")
    browser.click("#show-problems")
    until_script(browser, "document.querySelectorAll('#problems li button').length > 0")
    browser.click("#problems li button")
    until_title(browser, "BLOCK  Box")
    until_script(browser, "document.querySelector('#problems pre').textContent.includes('size')")
    keep(browser, "serve-edit-problems")
    browser.click("#report")
    until_script(browser, "document.querySelectorAll('#report-files a').length === 2")
    browser.click("#report-files li:first-child a")
    browser.until(lambda: (tmp_path / "world-report.html").exists(), "the file")
    assert errors(browser) == []


def move_pointer(browser, x, y):
    """Moves the pointer to a place of the picture, from -1 to 1."""
    px, py = browser.point(CANVAS, x, y)
    browser.actions(
        browser.pointer_steps([{
            "type": "pointerMove",
            "duration": 20,
            "x": px,
            "y": py,
            "origin": "viewport"
        }]))


def test_a_readout_stands_beside_a_pointer_that_rests(browser, serve):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 16))
    readout = "document.getElementById('readout')"
    assert browser.script(f"return {readout}.hidden")
    move_pointer(browser, -0.1, 0.1)
    until_script(browser, f"!{readout}.hidden && {readout}.textContent.includes('THING  Shape')")
    # The next picture has error bars.
    select_paint(browser)
    type_into(browser, number_input("shininess"), "0.3")
    move_pointer(browser, -0.1, 0.1)
    until_script(browser, f"!{readout}.hidden && {readout}.textContent.includes('radiance')")
    keep(browser, "readout")
    text = browser.script(f"return {readout}.innerText")
    assert "cd/m\u00b2" in text and "trusted" in text and "normal 0 0 1" in text, text
    assert "THING" in text and "from the viewer" in text, text
    browser.script("window.sent = 0; const send = window.page.send.bind(window.page);"
                   "window.page.send = (m) => { if (m.command === 'point') ++window.sent; send(m) }")
    move_pointer(browser, -0.15, 0.12)
    until_script(browser, f"!{readout}.hidden")
    assert browser.script("return window.sent") == 2  # it rests no more; it rests elsewhere
    move_pointer(browser, 0.95, 0.95)
    until_script(browser, f"{readout}.textContent.includes('nothing is here')")
    browser.script("document.getElementById('picture').focus()")
    browser.keys("e")
    until_script(browser, f"{readout}.hidden")
    assert errors(browser) == []


def test_textures_have_small_pictures(browser, serve):
    world = WORLD.replace("appearance Appearance {",
                          "appearance Appearance { texture DEF GRAIN PixelTexture {"
                          " image 2 1 3 0x00ff00 0x0000ff }")
    open_editor(browser, serve(world, "--edit", "--spp", 1))
    open_row(browser, "THING")
    browser.click(row(browser, "Appearance") + " .label")
    pixel = ("[...document.querySelector('{} .thumbnail canvas')?.getContext('2d')"
             ".getImageData({}, 0, 1, 1).data ?? []].join()")
    until_script(browser, pixel.format(".field[data-field=texture]", 0) + " === '0,255,0,255'")
    open_row(browser, "Appearance")
    browser.click(row(browser, "GRAIN") + " .label")
    until_script(browser, pixel.format("#texture", 1) + " === '0,0,255,255'")
    keep(browser, "thumbnail")
    browser.click(row(browser, "LIGHTS") + " .label")
    until_title(browser, "LIGHTS  Group")
    until_script(browser, "document.querySelectorAll('.thumbnail canvas').length === 0")
    assert errors(browser) == []
