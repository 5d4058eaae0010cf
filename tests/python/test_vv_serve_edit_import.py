"""Tests what pages of `vv serve --edit` put into a world from files, and the looks that they choose
from: with real WebSockets, and in headless Chromium."""
import base64
import io
import os

import pytest

from conftest import HEADER
from page_client import Image, serve, wait_for  # noqa: F401
from serve_edit_tools import WORLD, history, newest, save, select, text_of, until
from test_vv_serve_browser import browser, errors, keep  # noqa: F401
from test_vv_serve_edit_browser import (ESCAPE, open_editor, row, until_script, until_title)

BALL = HEADER + "DEF BALL Shape { geometry Sphere { } }\n"


def send(page, name, content, part=30_000):
    """Sends a file in parts, as a page does, and waits until vv has used or refused it."""
    page.edit("import", name=name, bytes=len(content))
    for start in range(0, len(content), part):
        data = base64.b64encode(content[start:start + part]).decode()
        page.edit("import_part", data=data)
    until(page, "import", lambda t: t["bytes"] == 0)


# --- Files ---


def test_a_file_becomes_an_inline(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still()
    (vv.folder / "my_ball.wrl").write_text("precious")
    content = BALL.encode() + b"# " + b"x" * 100_000 + b"\n"
    send(page, "../my ball.wrl", content)
    assert not [t for t in page.of("said") if t["error"]]
    assert (vv.folder / "my_ball.wrl").read_text() == "precious"
    assert (vv.folder / "my_ball-2.wrl").read_bytes() == content
    until(page, "sheet", lambda t: t["title"] == "my_ball-2  Inline")
    history(page, undo="Import my_ball-2", unsaved=True)
    save(page)
    assert 'url [ "my_ball-2.wrl" ]' in text_of(vv)


def test_what_is_refused_leaves_no_file(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still()
    before = sorted(os.listdir(vv.folder))
    for name, content, why in (("x.sh", b"rm", "only worlds and meshes"),
                               ("x.wrl", b"", "empty"), ("x.wrl", b"no world", "x.wrl is not"),
                               ("x.stl", b"solid x facet normal", "the file ends"),
                               ("x.ply", b"ply format", "is not imported"),
                               ("x.x3dv", b"#X3D V3.3 utf8", "holds nothing")):
        count = len(page.of("said"))
        page.edit("import", name=name, bytes=len(content))
        page.edit("import_part", data=base64.b64encode(content).decode())
        wait_for(lambda: page.of("said")[count:], lambda: (name, page.texts))
        assert why in newest(page, "said")["text"] and newest(page, "said")["error"]
    page.edit("import", name="x.wrl", bytes=33_554_433)
    until(page, "said", lambda t: "maxImportBytes" in t["text"])
    page.edit("import", name="x.wrl", bytes=3)
    page.edit("import_part", data="QUJDRA==")
    until(page, "said", lambda t: "as it was sent" in t["text"])
    assert sorted(os.listdir(vv.folder)) == before
    history(page, undo="", unsaved=False)


def test_a_world_that_cannot_be_edited_takes_no_file(serve, vv):
    vv.write("old.wrl", "#VRML V1.0 ascii\nSeparator { Cube { } }\n")
    page = serve("old.wrl", "--edit", "--spp", 1).join_editor()
    why = until(page, "history", lambda t: t["readOnly"])["readOnly"]
    page.edit("import", name="ball.wrl", bytes=3)
    until(page, "said", lambda t: t["error"] and t["text"] == why)
    assert not (vv.folder / "ball.wrl").exists()


def test_a_file_is_dropped_on_the_page(browser, serve, vv):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1))
    browser.script(
        "const files = new DataTransfer();"
        "files.items.add(new File([arguments[0]], 'ball.wrl'));"
        "files.items.add(new File(['nothing'], 'notes.txt'));"
        "for (const kind of ['dragover', 'drop'])"
        "  document.getElementById('picture').dispatchEvent(new DragEvent(kind,"
        "    { dataTransfer: files, bubbles: true, cancelable: true }));", BALL + "# " + "x" * 300_000)
    until_title(browser, "ball  Inline")
    until_script(browser, "document.getElementById('said').textContent.includes('only worlds')")
    assert (vv.folder / "ball.wrl").read_text().startswith(BALL)
    assert not (vv.folder / "notes.txt").exists()
    assert errors(browser) == []


# --- Looks ---


@pytest.fixture
def materials(tmp_path):
    """Returns an environment in which the user has a material of his own."""
    folder = tmp_path / "data" / "xvrml" / "materials"
    folder.mkdir(parents=True)
    (folder / "wood.wrl").write_text(
        HEADER + "Shape { appearance Appearance { material Material { diffuseColor 0 1 0 } } }\n")
    return {"XDG_DATA_HOME": str(tmp_path / "data")}


def test_looks_have_balls_and_those_of_the_user_come_first(serve, vv, materials):
    server = serve(WORLD, "--edit", "--spp", 1, env=materials)
    page = server.join_editor()
    page.still()
    select(page, "THING  Shape")
    page.edit("looks", open=True)
    looks = until(page, "looks", lambda t: "image" in t["list"][0])["list"]
    assert looks[0]["name"] == "wood" and looks[0]["own"] and not looks[1]["own"]
    path = "/" + looks[0]["image"]
    assert server.get(path).status == 404  # it is for those who may edit
    answer = server.get(path + "?token=" + server.edit_token)
    assert answer.headers["Content-Type"] == "image/png"
    ball = Image.open(io.BytesIO(answer.body)).convert("RGB")
    assert ball.size == (56, 56)
    red, green, blue = ball.getpixel((28, 28))
    assert green > 2 * red and green > 2 * blue
    page.edit("set_look", number=looks[0]["number"], only_here=True)
    page.still(lambda p: p.at(0, 0)[1] > 2 * p.at(0, 0)[0])
    save(page)
    assert "diffuseColor 0 1 0" in text_of(vv)


def test_the_list_of_looks_shows_balls(browser, serve, vv, materials):
    open_editor(browser, serve(WORLD, "--edit", "--spp", 1, env=materials))
    browser.click(row(browser, "THING") + " .label")
    until_title(browser, "THING  Shape")
    browser.click("#look .link")
    shown = "[...document.querySelectorAll('.chooser img')].filter(i => i.naturalWidth === 56).length"
    until_script(browser, shown + " > 2")
    keep(browser, "serve-edit-looks")
    first = browser.script("return document.querySelector('.chooser li').textContent")
    assert first == "woodyours"
    browser.keys(*"wood", "\ue007")
    until_script(browser, "document.getElementById('undo').title.includes('wood')")
    browser.keys(ESCAPE)
    assert errors(browser) == []
