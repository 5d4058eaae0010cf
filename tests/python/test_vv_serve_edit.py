"""Tests the editor on the page of `vv serve --edit` with real WebSockets: who may edit, what edits do
to pictures, file and history, several editors, lost connections, and what hostile ones cannot do.
test_vv_serve_edit_tools.py tests its tools and measurements, and test_vv_serve_edit_browser.py works the
page itself."""
import json
import os
import re

import pytest

from conftest import HEADER
from page_client import Refused, serve, wait_for  # noqa: F401
from serve_edit_tools import (
    SIZE, WORLD, drag, field, history, newest, opened, paint, save, select, select_row, text_of,
    until, value)
from window_driver import blue, green, red


# --- Who may edit ---


def test_only_the_second_address_edits(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    plain = server.get("/").body
    first = server.get("/?token=" + server.edit_token)
    assert first.status == 303 and first.headers["Referrer-Policy"] == "no-referrer"
    cookie = first.headers["Set-Cookie"].split(";")[0]
    page = server.get("/", {"Cookie": cookie}).body
    assert b"edit.js" in page and b"edit.js" not in plain
    assert server.get("/edit.js", {"Cookie": cookie}).headers["Content-Type"].startswith(
        "text/javascript")

    viewer = server.join(*SIZE)
    viewer.still()
    for path in ("/live?token=" + "0" * 32, "/live?token=" + server.edit_token[:-1]):
        server.join(path=path).still()  # the wrong token is none: it sees, and does not edit
    editor = server.join_editor()
    assert "Box" in editor.told("editor")["kinds"]
    viewer.edit("undo")
    code, reason = viewer.until_closed()
    assert code == 1008 and reason.startswith("type: ")
    kinds = {text["type"] for text in viewer.texts}
    assert kinds <= {"hello", "state", "viewpoints"}
    by_cookie = server.join(headers={"Cookie": cookie})
    by_cookie.told("editor")
    with pytest.raises(Refused):
        server.join(headers={"Cookie": cookie, "Origin": "http://evil.example"})
    assert server.stop() == 0 and not [e for e in server.errors if server.edit_token in e]


def test_without_the_option_nobody_edits(serve):
    plain = serve(WORLD, "--spp", 1)
    editable = serve(WORLD, "--spp", 1, "--edit")
    for path in ("/", "/page.js", "/page.css"):
        assert plain.get(path).body == editable.get(path).body
    page = plain.join(path="/live?token=" + "0" * 32)
    page.still()
    page.edit("rows", first=0, count=10)
    assert page.until_closed()[0] == 1008


def test_the_token_of_viewers_does_not_edit(serve):
    server = serve(WORLD, "--edit", "--token", "new", "--spp", 1)
    assert server.token != server.edit_token
    assert server.get("/").status == 403
    viewer = server.join(path="/live?token=" + server.token)
    viewer.still()
    viewer.edit("undo")
    assert viewer.until_closed()[0] == 1008
    server.join_editor().still()


# --- What edits do ---


def test_edits_show_are_undone_and_saved(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    viewer, page = server.join(*SIZE), server.join_editor()
    viewer.still(lambda p: red(*p.at(0, 0)))
    number = paint(page)
    drag(page, number, "diffuseColor", [1, 0, 0.5], [0, 1, 0], [0, 0, 1])
    viewer.still(lambda p: blue(*p.at(0, 0)))
    history(page, undo="Set Material.diffuseColor", unsaved=True, redo="")
    page.edit("undo")
    viewer.still(lambda p: red(*p.at(0, 0)))
    history(page, undo="", redo="Set Material.diffuseColor", unsaved=False)
    page.edit("redo")
    value(page, "diffuseColor", [0, 0, 1])
    page.edit("save")
    history(page, unsaved=False, undo="Set Material.diffuseColor")
    assert text_of(vv) == WORLD.replace("diffuseColor 1 0 0", "diffuseColor 0 0 1")
    page.edit("reset", node=number, field="diffuseColor")
    sheet = value(page, "diffuseColor", [0.8, 0.8, 0.8])
    assert field(sheet, "diffuseColor")["default"]
    history(page, undo="Reset Material.diffuseColor")


def test_a_click_on_the_picture_selects(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    page.still()
    page.edit("select_at", x=0, y=0)
    until(page, "sheet", lambda t: t["title"] == "THING  Shape")
    until(page, "frames", lambda t: len(t["lines"]) == 12)
    rows = until(page, "rows", lambda t: any(r.get("selected") for r in t["rows"]))["rows"]
    assert [r["label"] for r in rows if r.get("selected")] == ["THING  Shape"]
    page.edit("select_at", x=0.9, y=0.9)
    until(page, "sheet", lambda t: t["node"] is None)


def test_nodes_are_added_copied_wrapped_renamed_and_removed(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    select(page, "LIGHTS  Group")
    page.edit("add", kind="SpotLight")
    sheet = until(page, "sheet", lambda t: t["title"] == "SpotLight")
    edits = [{"edit": "rename", "node": sheet["node"], "name": "SPOT"}]
    page.edit("step", name="Rename", edits=edits)
    until(page, "sheet", lambda t: t["title"] == "SPOT  SpotLight")
    page.edit("duplicate")
    until(page, "sheet", lambda t: t["title"] == "SPOT_2  SpotLight")
    page.edit("wrap")
    until(page, "sheet", lambda t: t["title"] == "Transform")
    select(page, "SPOT  SpotLight")
    page.edit("remove")
    until(page, "sheet", lambda t: t["node"] is None)
    page.edit("save")
    history(page, unsaved=False, undo="Remove SpotLight")
    text = text_of(vv)
    assert "DEF SPOT SpotLight" not in text and "Transform" in text and "SPOT_2" in text
    for name in ("Remove SpotLight", "Wrap SpotLight", "Duplicate SpotLight", "Rename"):
        history(page, undo=name)
        page.edit("undo")
    page.edit("step", name="Insert", edits=[{"edit": "insert", "vrml": "DEF NEW Group { }"}])
    until(page, "sheet", lambda t: t["title"] == "NEW  Group")


def test_parameters_of_shaders_are_declared_when_they_are_set(serve, vv):
    world = HEADER + """Viewpoint { position 0 0 5 }
Shape { appearance ORTAppearance { shader DEF LOOK ORTShader { name "Diffuse" } }
  geometry Box { } }
"""
    server = serve(world, "--edit", "--spp", 1)
    page = server.join_editor()
    opened(page, "Shape", "appearance: ORTAppearance")
    sheet = select_row(page, "shader: LOOK  ORTShader", "LOOK  ORTShader")
    assert not field(sheet, "reflectance")["declared"] and field(sheet, "reflectance")["linear"]
    for one in ([0, 1, 1], [0, 1, 0]):
        page.edit("drag", node=sheet["node"], field="reflectance", value=one)
    page.edit("end_drag")
    page.still(lambda p: green(*p.at(0, 0)))
    sheet = value(page, "reflectance", [0, 1, 0])
    assert field(sheet, "reflectance")["declared"]
    save(page)
    assert "reflectance 0 1 0" in text_of(vv)
    page.edit("undo")
    page.edit("undo")
    history(page, undo="")


def test_the_search_finds_names_types_and_fields(serve):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.edit("search", text="lamp")
    rows = until(page, "rows", lambda t: t["total"] == 1)["rows"]
    assert rows[0]["label"] == "LAMP  PointLight"
    page.edit("search", text="")
    until(page, "rows", lambda t: t["total"] == 3)


def test_a_change_on_disk_is_asked_about(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    drag(page, paint(page), "diffuseColor", [0, 1, 0])
    history(page, unsaved=True)
    (vv.folder / "world.wrl").write_text(WORLD + "# by another program\n")
    page.edit("save")
    assert "Another program" in page.told("question")["text"]
    assert text_of(vv).endswith("# by another program\n")
    page.edit("save", overwrite=True)
    history(page, unsaved=False)
    assert text_of(vv) == WORLD.replace("diffuseColor 1 0 0", "diffuseColor 0 1 0")


def test_unsaved_edits_are_kept_at_the_end_and_keep_the_world(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    page.still()
    drag(page, paint(page), "diffuseColor", [0, 1, 0])
    history(page, unsaved=True)
    page.key("R")  # the leader reloads
    page.until_state(lambda s: "not saved" in s["bottom"])
    page.still(lambda p: green(*p.at(0, 0)))
    page.edit("drag", node=newest(page, "sheet")["node"], field="diffuseColor", value=[0, 0, 1])
    page.still(lambda p: blue(*p.at(0, 0)))
    assert server.stop() == 0
    wait_for(lambda: any("unsaved edits" in e for e in server.errors), lambda: server.errors)
    assert text_of(vv) == WORLD

    page = serve("world.wrl", "--edit", "--spp", 1).join_editor()
    until(page, "history", lambda t: t["left"] is not None)
    page.still(lambda p: red(*p.at(0, 0)))
    page.edit("recover", use=True)
    page.still(lambda p: blue(*p.at(0, 0)))
    history(page, unsaved=True, left=None, undo="")
    page.edit("revert")
    page.still(lambda p: red(*p.at(0, 0)))
    history(page, unsaved=False, left=None)
    assert text_of(vv) == WORLD
    assert list(vv.folder.glob(".*.vv-edits*")) == []


def test_without_the_option_nothing_is_said_of_what_was_left(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    drag(page, paint(page), "diffuseColor", [0, 1, 0])
    history(page, unsaved=True)
    server.stop()
    kept = list(vv.folder.glob(".*.vv-edits*"))
    plain = serve("world.wrl", "--spp", 1)
    plain.join(*SIZE).still(lambda p: red(*p.at(0, 0)))
    assert plain.stop() == 0 and plain.errors == []
    assert len(kept) == 1 and kept[0].exists()


# --- Several editors ---


def test_two_pages_drag_the_same_field(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    first, second = paint(one), paint(two)
    one.edit("drag", node=first, field="shininess", value=0.5)
    value(two, "shininess", 0.5)
    two.edit("drag", node=second, field="shininess", value=0.25)
    value(one, "shininess", 0.25)
    one.edit("drag", node=first, field="shininess", value=0.75)
    one.edit("end_drag")
    value(two, "shininess", 0.75)
    two.edit("drag", node=second, field="shininess", value=0.125)
    two.edit("end_drag")
    for page in (one, two):
        value(page, "shininess", 0.125)
        history(page, undo="Set Material.shininess", redo="")
    one.edit("undo")
    for page in (one, two):
        value(page, "shininess", 0.2)
        history(page, undo="", redo="Set Material.shininess")


def test_two_pages_change_two_elements_of_a_list(serve, vv):
    world = HEADER + """Shape { geometry IndexedFaceSet { coordIndex [ 0 1 2 -1 ]
  coord DEF C Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } } }
"""
    server = serve(world, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    opened(one, "Shape", "geometry: IndexedFaceSet")
    number = select_row(one, "coord: C  Coordinate", "C  Coordinate")["node"]
    other = until(two, "sheet", lambda t: t["title"] == "C  Coordinate")["node"]
    for i in range(1, 4):  # both at once
        one.edit("drag", node=number, field="point", value=[i, 1, 1], index=0, size=3)
        two.edit("drag", node=other, field="point", value=[2, 2, i], index=2, size=3)
    one.edit("end_drag")
    two.edit("end_drag")
    both = [[3, 1, 1], [1, 0, 0], [2, 2, 3]]
    value(one, "point", both)
    value(two, "point", both)
    one.edit("drag", node=number, field="point", value=None, index=1, size=3)
    one.edit("end_drag")
    value(two, "point", [both[0], both[2]])
    two.edit("drag", node=other, field="point", value=[9, 9, 9], index=1, size=3)
    until(two, "said", lambda t: t["error"] and "2 elements now" in t["text"])
    two.edit("drag", node=other, field="point", value=[9, 9, 9], index=2, size=2)
    two.edit("end_drag")
    value(one, "point", [both[0], both[2], [9, 9, 9]])


def test_the_selection_is_of_all_and_places_are_their_own(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    opened(one, "LIGHTS  Group")
    select(one, "LAMP  PointLight")
    until(two, "sheet", lambda t: t["title"] == "LAMP  PointLight")
    assert two.told("reveal")["row"] == 3
    two.edit("search", text="block")
    until(two, "rows", lambda t: t["total"] == 1)
    assert newest(one, "rows")["total"] == 4


def test_an_edit_of_another_page_ends_a_drag(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    number = paint(one)
    one.edit("drag", node=number, field="shininess", value=0.5)
    value(two, "shininess", 0.5)
    two.edit("undo")
    value(one, "shininess", 0.2)
    history(one, undo="", redo="Set Material.shininess")
    one.edit("drag", node=number, field="shininess", value=0.75)  # goes on, in a step of its own
    one.edit("end_drag")
    history(two, undo="Set Material.shininess", redo="")


@pytest.mark.parametrize("how", ["closed", "aborted"])
def test_a_lost_connection_ends_its_drag(serve, vv, how):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    number = paint(one)
    one.edit("drag", node=number, field="shininess", value=0.5)
    value(two, "shininess", 0.5)
    if how == "aborted":
        one.send_text("{")  # the connection is ended by vv
        one.until_closed()
    else:
        one.close()
    history(two, undo="Set Material.shininess", unsaved=True)
    save(two)
    assert "shininess 0.5" in text_of(vv)


def test_the_number_of_editors_is_limited(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    pages = [server.join_editor(32, 24) for _ in range(8)]
    late = server.join(32, 24, path="/live?token=" + server.edit_token)
    late.edit("rows", first=0, count=10)
    assert "maxEditors" in late.told("said")["text"]
    pages[0].edit("close")
    wait_for(lambda: late.edit("rows", first=0, count=10) or late.of("rows"), "a place")


# --- Hostile pages and files ---

MALFORMED = [
    {"command": "quit"}, {"command": "undo", "x": 1}, {"command": 5}, {},
    {"command": "rows", "first": 0, "count": 1e9}, {"command": "rows", "first": -1, "count": 1},
    {"command": "select", "node": "LAMP"}, {"command": "select", "node": 1e300},
    {"command": "select_at", "x": 2, "y": 0}, {"command": "open", "node": 1},
    {"command": "drag", "node": 1, "field": "on", "value": [[[[[[[[[1]]]]]]]]]},
    {"command": "drag", "node": 1, "field": 7, "value": 1},
    {"command": "drag", "node": 1, "field": "x", "value": [0] * 21_000},
    {"command": "step", "name": "x", "edits": [{"edit": "quit"}]},
    {"command": "step", "name": "x" * 300, "edits": [{"edit": "insert", "vrml": "Group { }"}]},
    {"command": "step", "name": "x", "edits": [{"edit": "insert", "vrml": "Group { }"}] * 101},
    {"command": "search", "text": "x" * 300}, {"command": "save", "path": "x.wrl"},
    {"command": "tool", "kind": "move", "x": 1e3, "y": 0}, {"command": "tool", "kind": 1},
    {"command": "tool_at", "x": None, "y": 0}, {"command": "tool_key", "key": "x" * 17},
    {"command": "end_tool"}, {"command": "compare", "what": "all"},
    {"command": "measure", "x0": 0, "y0": 0, "x1": 1.1, "y1": 1}, {"command": "problems"},
    {"command": "probe", "x": 0, "y": 0, "illuminance": 1}, {"command": "point", "x": 2, "y": 0},
    {"command": "remove_at", "node": 1, "parent": -1, "field": "children", "index": 0},
    {"command": "move_at", "node": 1, "parent": 1, "field": "children", "index": 0, "by": 9},
    {"command": "set_look", "number": -1}, {"command": "report", "path": "/etc/x"},
]  # yapf: disable

REFUSED = [
    ({"command": "select", "node": 999_999}, "not shown any more"),
    ({"command": "select", "node": 2**64 - 1}, "not shown any more"),
    ({"command": "open", "node": 999_999, "open": True}, "not shown any more"),
    ({"command": "drag", "node": 0, "field": "on", "value": True}, "not shown any more"),
    ({"command": "reset", "node": 0, "field": "on"}, "not shown any more"),
    ({"command": "add", "kind": "Script { }"}, "no such node"),
    ({"command": "remove"}, "nothing is selected"),
    ({"command": "hide"}, "nothing is selected"),
    ({"command": "tool", "kind": "move", "x": 0, "y": 0}, "nothing is selected"),
    ({"command": "choices", "node": 0, "field": "on"}, "not shown any more"),
    ({"command": "remove_at", "node": 0, "parent": None, "field": "", "index": 0},
     "not shown any more"),
    ({"command": "set_look", "number": 2_000_000_000}, "no such look"),
    ({"command": "compare", "what": "a"}, "nothing is kept"),
    ({"command": "step", "name": "x", "edits": [{"edit": "rename", "node": "LAMP", "name": "L"}]},
     "by their numbers"),
    ({"command": "step", "name": "x", "edits": [{"edit": "insert", "vrml": "Group {"}]}, "edits[0]"),
]  # yapf: disable


def test_hostile_edits_end_the_connection_or_are_refused(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    good = server.join_editor()
    path = "/live?token=" + server.edit_token
    for members in MALFORMED:
        page = server.join(None, path=path)
        page.send(type="edit", **members)
        code, reason = page.until_closed()
        assert code == 1008 and reason, members
        page.close()
    page = server.join(None, path=path)
    page.send(type="edit", command="search", text="x" * 70_000)
    assert page.until_closed() == (1009, "maxEditBytes")
    page.close()
    for members, why in REFUSED:
        count = len(good.of("said"))
        good.send(type="edit", **members)
        said = good.told("said", count + 1)
        assert said["error"] and why in said["text"], (members, said)
    number = paint(good)
    for value_, why in ((2, "in [0,1]"), ("1", "a number"), ([1, 2], "a number"), (None,
                                                                                      "a number")):
        count = len(good.of("said"))
        good.edit("drag", node=number, field="shininess", value=value_)
        assert why in good.told("said", count + 1)["text"]
    for name in ("nothing", "children", "set_shininess"):
        count = len(good.of("said"))
        good.edit("drag", node=number, field=name, value=1)
        assert good.told("said", count + 1)["error"]
    assert history(good, unsaved=False)["undo"] == ""
    page = server.join(None, path=path)
    try:
        for _ in range(3000):
            page.edit("undo")
    except OSError:
        pass
    assert page.until_closed() in ((1008, "maxMessagesPerSecond"), (0, ""))
    drag(good, number, "shininess", 0.5)
    value(good, "shininess", 0.5)
    save(good)
    assert text_of(vv).count("shininess") == 1 and server.stop() == 0


def test_hostile_names_are_bounded_text(serve):
    name, markup = "n" * 10_000, "<img/src=x/onerror=alert(1)>"
    page = serve(HEADER + "DEF %s Group { } DEF %s Group { } Shape { geometry Box { } }" %
                 (name, markup), "--edit", "--spp", 1).join_editor()
    rows = until(page, "rows", lambda t: t["total"] == 3)["rows"]
    assert len(rows[0]["label"]) < 100 and rows[1]["label"] == markup + "  Group"
    page.edit("select", node=rows[0]["node"])
    sheet = until(page, "sheet", lambda t: t["node"] is not None)
    assert "name" not in sheet and len(json.dumps(sheet)) < 20_000
    assert len(json.dumps(newest(page, "history"))) < 2_000


def test_a_large_world_sends_what_is_seen(serve):
    count = int(os.environ.get("VV_MANY_NODES", "50000"))
    world = HEADER + "Viewpoint { position 0 0 5 } Shape { geometry Box { } }\n"
    world += "".join(f"DEF T{i} Transform {{ }}\n" for i in range(count))
    page = serve(world, "--edit", "--spp", 1).join_editor()
    page.edit("rows", first=count // 2, count=40)
    rows = until(page, "rows", lambda t: t["first"] == count // 2)
    assert rows["total"] == count + 2 and len(rows["rows"]) == 40
    assert len(json.dumps(rows)) < 10_000
    for first in range(0, 40_000, 400):  # more nodes than a page may name
        page.edit("rows", first=first, count=400)
    last = until(page, "rows", lambda t: t["first"] == 39_600)["rows"][0]
    page.edit("select", node=last["node"])
    until(page, "sheet", lambda t: t["title"] == last["label"])
    assert not re.search("not shown any more", json.dumps(page.of("said")))
