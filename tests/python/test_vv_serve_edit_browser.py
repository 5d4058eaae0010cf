"""Tests the editor on the page of `vv serve --edit` in headless Chromium, with real clicks, drags and
keys, on a page of 800x600. Skipped where Chromium is not installed. $VV_SCREENSHOTS names a folder
for pictures to look at."""
import pytest

from conftest import HEADER
from page_client import serve  # noqa: F401
from test_vv_serve_browser import (  # noqa: F401
    CANVAS, browser, errors, finished, first_picture, keep, until_pixel)
from test_vv_serve_edit import WORLD
from window_driver import SENSORS, blue, green, red

ARROW_DOWN, ARROW_RIGHT, ENTER, TAB, CONTROL = "\ue015", "\ue014", "\ue007", "\ue004", "\ue009"


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


def press_with_control(browser, key):
    browser.actions({
        "type":
            "key",
        "id":
            "keys",
        "actions": [{
            "type": "keyDown",
            "value": CONTROL
        }, {
            "type": "keyDown",
            "value": key
        }, {
            "type": "keyUp",
            "value": key
        }, {
            "type": "keyUp",
            "value": CONTROL
        }]
    })


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
    browser.actions({
        "type": "pointer",
        "id": "mouse",
        "parameters": {
            "pointerType": "mouse"
        },
        "actions": steps
    })


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
