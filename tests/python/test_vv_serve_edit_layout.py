"""Tests in headless Chromium that the texts over the picture of `vv serve --edit` do not cover each
other, and that the editor's keys are those that its help lists. $VV_SCREENSHOTS names a folder for
pictures to look at."""
import pytest

from page_client import serve  # noqa: F401
from serve_edit_tools import WORLD
from test_vv_serve_browser import browser, errors, keep  # noqa: F401
from test_vv_serve_edit_browser import (ARROW_DOWN, ARROW_LEFT, ARROW_RIGHT, ENTER, ESCAPE, SHIFT,
                                        labels, open_editor, press_with, until_row, until_script,
                                        until_title)

# Everything that may be said at once, as vv would say it, and nothing else from then on.
MESSAGES = """
const page = window.page;
page.on_state = () => {};
page.on_said({ error: true, text: arguments[0] });
page.on_comparison({ kept: true, complete: false, shown: "difference", most: 12.5, least: -3.25,
                     pixels: 480000, judged: 470000, significant: 1200, here: 2.5 });
page.on_tool({ text: "Move along x: 3" });
page.on_progress({ text: "report: 12 of 64 samples" });
document.getElementById("hint").textContent = "a lamp";
"""
BOXES = """
const stage = document.getElementById("stage").getBoundingClientRect();
return [...document.querySelectorAll("#notes > *")].map((e) => {
  const r = e.getBoundingClientRect();
  return [e.id, r.left - stage.left, r.top - stage.top, stage.right - r.right,
          stage.bottom - r.bottom, r.width, r.height];
}).filter((one) => one[5] > 0 && one[6] > 0);
"""


@pytest.mark.parametrize("width, height, zoom", [(1000, 700, 1), (400, 700, 1), (1000, 700, 2),
                                                 (400, 700, 2)])
def test_texts_over_the_picture_do_not_overlap(browser, serve, width, height, zoom):
    browser.resize(width, height)
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    until_script(browser, "document.getElementById('facts').textContent !== ''")
    # As with a browser in which the user has chosen larger texts.
    browser.script("document.documentElement.style.fontSize = arguments[0]", f"{87.5 * zoom}%")
    browser.script(MESSAGES, "the value of a field is refused, with a reason of more than one line")
    keep(browser, f"serve-edit-notes-{width}-{zoom}")
    boxes = browser.script(BOXES)
    assert {box[0] for box in boxes} >= {"facts", "said", "legend", "tool", "progress", "hint"}
    for one in boxes:
        assert min(one[1:4]) >= -0.5, one
    for above, below in zip(boxes, boxes[1:]):  # a column: each begins below the one before
        assert above[2] + above[6] <= below[2] + 0.5, (above, below)
    if zoom == 1 or width == 1000:  # the smallest page has no room for all in large letters
        assert min(box[4] for box in boxes) >= -0.5, boxes
    for panel in ("outline", "bar"):
        inside = browser.script(
            "const p = document.getElementById(arguments[0]).getBoundingClientRect();"
            "const s = document.getElementById('stage').getBoundingClientRect();"
            "return p.right <= s.left + 0.5 || p.top >= s.bottom - 0.5", panel)
        assert inside, panel
    assert browser.script("return document.documentElement.scrollWidth <= innerWidth")


def test_the_help_lists_the_keys_that_work(browser, serve, vv):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    until_script(browser, "window.editor.keys.rows.length > 0")
    browser.script("document.getElementById('picture').focus()")
    browser.keys("?")
    until_script(browser, "document.getElementById('panel').open")
    listed = " ".join(vv("--list-keys").stdout.decode().split())
    shown = browser.script("return window.editor.keys.rows")
    assert len(shown) > 20 and all(text in listed for _, text in shown)
    cells = browser.script(
        "return [...document.querySelectorAll('#content td')].map(e => e.textContent)")
    assert all(what in cells and text in cells for what, text in shown)
    words = {word for what, _ in shown for word in what.replace(",", " ").split()} | {","}
    bound = browser.script("return window.editor.keys.keys.flatMap(one => one.keys)")
    assert [key for key in bound if key not in words] == []
    browser.keys(ESCAPE)
    until_script(browser, "!document.getElementById('panel').open")
    assert errors(browser) == []


def test_the_panels_and_the_menu_are_worked_by_keys(browser, serve):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    browser.script("document.getElementById('rows').focus()")
    until_row(browser, "LIGHTS")
    browser.keys(ARROW_DOWN, ARROW_DOWN, ARROW_RIGHT)
    until_row(browser, "LAMP")
    browser.keys(ARROW_DOWN, ENTER)
    until_title(browser, "LAMP  PointLight")
    browser.keys(ARROW_LEFT, ENTER)  # the parent
    until_title(browser, "LIGHTS  Group")
    browser.script("document.querySelector('#rows').focus()")
    press_with(browser, SHIFT, "a")
    until_script(browser, "document.querySelector('.chooser').open")
    browser.keys(*"spot", ENTER)
    until_title(browser, "SpotLight")
    assert any("SpotLight" in label for label in labels(browser))
    browser.script("document.getElementById('picture').focus()")
    seen = browser.script("return getComputedStyle(document.activeElement).outlineStyle")
    assert seen == "solid"
    browser.keys(ESCAPE)  # selects nothing
    until_script(browser, "window.editor.selected === 0")
    browser.keys("e")
    until_script(browser, "document.getElementById('outline').hidden")
    assert browser.script("return document.activeElement.id") == "picture"
    browser.keys("e")
    until_row(browser, "LIGHTS")
    browser.keys(ESCAPE)
    until_script(browser, "document.getElementById('outline').hidden")
    assert errors(browser) == []
