"""Tests the editor on the page of `vv serve --edit` with real WebSockets: who may edit, what edits do
to pictures, file and history, several editors, lost connections, and what hostile ones cannot do.
test_vv_serve_edit_browser.py works the page itself."""
import base64
import io
import json
import os
import re

import pytest

from conftest import HEADER
from page_client import Image, Refused, serve, wait_for  # noqa: F401
from window_driver import blue, green, red

SIZE = (160, 120)
WORLD = HEADER + """# The hall
Viewpoint { position 0 0 5 }
DEF THING Shape { # on the table
  appearance Appearance { material DEF PAINT Material { diffuseColor 1 0 0 } }
  geometry DEF BLOCK Box { }
}
DEF LIGHTS Group { children [ DEF LAMP PointLight { on FALSE intensity 0.80 } ] }
"""


def newest(page, kind):
    texts = page.of(kind)
    return texts[-1] if texts else {}


def until(page, kind, test):
    """Returns the newest text of a kind, once `test` holds for it."""
    return wait_for(
        lambda: next((t for t in [newest(page, kind)] if t and test(t)), None), lambda:
        (kind, newest(page, kind), page.of("said"), page.closed))


def node(page, label):
    """Returns the number of the node of a row."""
    rows = until(page, "rows", lambda t: any(r["label"] == label for r in t["rows"]))["rows"]
    return next(row["node"] for row in rows if row["label"] == label)


def select(page, label):
    """Selects the node of a row and returns its sheet."""
    page.edit("select", node=node(page, label))
    return until(page, "sheet", lambda t: t["title"] == label)


def opened(page, *labels):
    for label in labels:
        page.edit("open", node=node(page, label), open=True)


def paint(page):
    """Selects the Material and returns its number."""
    opened(page, "THING  Shape", "appearance: Appearance")
    return select_row(page, "material: PAINT  Material", "PAINT  Material")["node"]


def select_row(page, label, title):
    page.edit("select", node=node(page, label))
    return until(page, "sheet", lambda t: t["title"] == title)


def field(sheet, name):
    return next(one for one in sheet["fields"] if one["field"] == name)


def value(page, name, wanted):
    return until(page, "sheet", lambda t: any(
        one["field"] == name and one.get("value") == wanted for one in t["fields"]))


def drag(page, number, name, *values):
    for one in values:
        page.edit("drag", node=number, field=name, value=one)
    page.edit("end_drag")


def history(page, **wanted):
    return until(page, "history", lambda t: all(t[k] == v for k, v in wanted.items()))


def text_of(vv):
    return (vv.folder / "world.wrl").read_text()


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
    page.edit("save")
    history(page, unsaved=False)
    assert "reflectance 0 1 0" in text_of(vv)
    page.edit("undo")
    page.edit("undo")
    history(page, undo="")


# --- Nodes in fields, looks ---


def links(sheet, name):
    return [link["label"] for link in field(sheet, name)["links"]]


def test_nodes_in_fields_are_added_moved_and_removed(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    sheet = select(page, "LIGHTS  Group")
    group, lamp = sheet["node"], field(sheet, "children")["links"][0]["node"]
    page.edit("choices", node=group, field="children")
    choices = page.told("choices")
    assert {"SpotLight", "Transform"} <= {one["name"] for one in choices["types"]}
    thing = next(one for one in choices["uses"] if one["label"] == "THING  Shape")
    page.edit("add_node", node=group, field="children", kind="SpotLight")
    page.edit("use_node", node=group, field="children", used=thing["node"])
    wanted = ["LAMP  PointLight", "SpotLight", "THING  Shape"]
    sheet = until(page, "sheet", lambda t: links(t, "children") == wanted)
    assert field(sheet, "children")["links"][2]["places"] == 2
    page.edit("move_at", node=lamp, parent=group, field="children", index=0, by=1)
    until(page, "sheet", lambda t: links(t, "children")[1] == "LAMP  PointLight")
    page.edit("separate_at", node=thing["node"], parent=group, field="children", index=2)
    sheet = until(page, "sheet", lambda t: links(t, "children")[2] == "THING_2  Shape")
    page.edit("remove_at", node=lamp, parent=group, field="children", index=1)
    until(page, "sheet", lambda t: links(t, "children") == ["SpotLight", "THING_2  Shape"])
    page.edit("remove_at", node=lamp, parent=group, field="children", index=1)
    until(page, "said", lambda t: "moved or removed meanwhile" in t["text"])
    for _ in range(5):
        page.edit("undo")
    until(page, "sheet", lambda t: links(t, "children") == ["LAMP  PointLight"])
    history(page, undo="", unsaved=False)
    assert text_of(vv) == WORLD


def test_a_look_is_chosen_and_its_parameters_are_set(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still()
    sheet = select(page, "THING  Shape")
    assert sheet["look"]["name"] == "Material" and sheet["look"]["places"] == 1
    looks = page.told("looks")["list"]
    number = next(i for i, one in enumerate(looks) if one["name"] == "Diffuse")
    page.edit("set_look", number=number, only_here=True)
    sheet = until(page, "sheet", lambda t: t.get("look", {}).get("name") == "Diffuse")
    page.edit("select", node=sheet["look"]["surface"])
    sheet = until(page, "sheet", lambda t: t["title"] == "ORTShader")
    colour = next(one for one in sheet["fields"] if one["type"] == "SFColor")
    drag(page, sheet["node"], colour["field"], [0, 1, 0])
    page.still(lambda p: green(*p.at(0, 0)))
    page.edit("save")
    history(page, unsaved=False)
    assert 'name "Diffuse"' in text_of(vv) and f"{colour['field']} 0 1 0" in text_of(vv)


def test_nodes_are_hidden_for_all_and_not_saved(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    viewer, page = server.join(*SIZE), server.join_editor()
    viewer.still(lambda p: red(*p.at(0, 0)))
    select(page, "THING  Shape")
    page.edit("hide")
    viewer.still(lambda p: not red(*p.at(0, 0)))
    history(page, hidden=1, unsaved=False, undo="")
    page.edit("show_all")
    viewer.still(lambda p: red(*p.at(0, 0)))
    history(page, hidden=0)
    assert text_of(vv) == WORLD


# --- Handles and tools ---


def tool_text(page, part):
    return until(page, "tool", lambda t: part in t["text"])["text"]


def test_a_tool_moves_snaps_and_is_taken_back(serve, vv):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still(lambda p: red(*p.at(0, 0)))
    select(page, "THING  Shape")
    handles = until(page, "handles", lambda t: len(t["list"]) == 2)
    assert handles["kind"] == "move" and {h["axis"] for h in handles["list"]} == {0, 1}
    page.edit("tool", kind="move", axis=0, x=0.1, y=0)
    page.edit("tool_at", x=0.8, y=0.3)
    tool_text(page, "Move along x")
    until(page, "sheet", lambda t: t["title"] == "Transform")
    page.edit("end_tool", accept=False)
    until(page, "tool", lambda t: t["text"] == "")
    until(page, "sheet", lambda t: t["title"] == "THING  Shape")
    history(page, undo="", unsaved=False)
    page.edit("tool", kind="move", axis=0, x=0.1, y=0)
    page.edit("tool_at", x=0.57, y=0, snap=True)
    for key in ("2", ".", "5"):
        page.edit("tool_key", key=key)
    tool_text(page, "2.5")
    page.edit("end_tool", accept=True)
    history(page, undo="Move Shape", unsaved=True)
    page.still(lambda p: not red(*p.at(0, 0)))
    value(page, "translation", [2.5, 0, 0])
    page.edit("save")
    history(page, unsaved=False)
    assert "translation 2.5 0 0" in text_of(vv)
    for kind in ("turn", "scale", "none", "move"):
        page.edit("handles")
        until(page, "handles", lambda t, kind=kind: t["kind"] == kind)


def test_an_edit_of_another_page_ends_a_tool(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    select(one, "THING  Shape")
    number = paint(two)
    select(two, "THING  Shape")
    one.edit("tool", kind="move", x=0, y=0)
    one.edit("tool_at", x=0.2, y=0)
    tool_text(one, "Move")
    two.edit("drag", node=number, field="shininess", value=0.5)
    until(one, "tool", lambda t: t["text"] == "")
    one.edit("tool_at", x=0.9, y=0)
    one.edit("end_tool", accept=False)  # it has been kept
    two.edit("end_drag")
    history(two, undo="Set Material.shininess")
    two.edit("undo")
    history(two, undo="Move Shape")
    two.edit("undo")
    history(two, undo="")


def test_a_page_that_leaves_keeps_what_its_tool_has_done(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    select(one, "THING  Shape")
    one.edit("tool", kind="turn", x=0.5, y=0)
    one.edit("tool_key", key="4")
    tool_text(one, "4 degrees")
    one.close()
    history(two, undo="Turn Shape", unsaved=True)


def test_a_revert_ends_a_drag(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    one, two = server.join_editor(), server.join_editor()
    number = paint(one)
    one.edit("drag", node=number, field="diffuseColor", value=[0, 1, 0])
    one.still(lambda p: green(*p.at(0, 0)))
    two.edit("revert")
    one.edit("drag", node=number, field="diffuseColor", value=[0, 0, 1])
    one.still(lambda p: red(*p.at(0, 0)))
    said = len(one.of("said"))
    one.edit("drag", node=number, field="diffuseColor", value=[0, 0, 1])  # a node of the old world
    assert "not shown any more" in one.told("said", said + 1)["text"]
    one.edit("end_drag")
    history(one, undo="", unsaved=False, left=None)
    assert text_of(vv) == WORLD and list(vv.folder.glob(".*.vv-edits*")) == []


# --- Search, save ---


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


def test_probes_measure_the_light(serve):
    server = serve(WORLD, "--edit", "--spp", 64)
    page = server.join_editor()
    page.edit("probe", x=0, y=0)
    # The interval is not known while there are few samples.
    first = until(page, "probes", lambda t: t["list"] and t["list"][0].get("half_width") is not None)
    probe = first["list"][0]
    assert probe["state"] == "read" and probe["luminance"] > 0 and "trusted" in probe
    page.edit("keep_probes")
    drag(page, paint(page), "diffuseColor", [1, 1, 1])
    changed = until(page, "probes", lambda t: t["list"] and t["list"][0].get("change", 0) > 0)
    assert changed["list"][0]["luminance"] > probe["luminance"]
    page.edit("probe", x=0.9, y=0.9)
    assert "nothing here" in page.told("said")["text"]
    page.edit("clear_probes")
    until(page, "probes", lambda t: t["list"] == [])


def test_the_light_that_falls_on_a_surface_is_measured(serve):
    world = WORLD.replace("on FALSE", "on TRUE location 0 0 5")
    server = serve(world, "--edit", "--spp", 16, "--headlight", "off")
    page = server.join_editor()
    page.still()
    page.edit("probe", x=0, y=0, illuminance=True)
    read = until(page, "probes", lambda t: t["list"] and t["list"][0]["state"] == "read")
    before = read["list"][0]["illuminance"]
    assert before > 0 and "luminance" not in read["list"][0]
    page.edit("keep_probes")
    lamp = select_lamp(page)
    drag(page, lamp, "intensity", 0.4)
    changed = until(page, "probes", lambda t: t["list"][0].get("change", 0) < 0)
    assert changed["list"][0]["illuminance"] < 0.6 * before
    marks = until(page, "marks", lambda t: len(t["list"]) == 1)["list"]
    assert abs(marks[0]["x"]) < 0.01 and abs(marks[0]["y"]) < 0.01


def select_lamp(page):
    opened(page, "LIGHTS  Group")
    return select(page, "LAMP  PointLight")["node"]


def test_a_is_compared_with_what_an_edit_has_changed(serve):
    page = serve(WORLD, "--edit", "--spp", 64).join_editor()
    page.edit("compare", what="a")
    assert "nothing is kept" in page.told("said")["text"]
    page.still()
    page.edit("measure", x0=-0.1, y0=-0.1, x1=0.1, y1=0.1)
    page.edit("keep_probes")
    until(page, "comparison", lambda t: t["kept"] and t["complete"])
    area = until(page, "probes", lambda t: t["list"] and t["list"][0]["state"] == "read")["list"][0]
    assert area["least"] <= area["luminance"] <= area["most"] and 0 < area["uniformity"] <= 1
    drag(page, paint(page), "diffuseColor", [0.2, 0, 0])
    page.edit("compare", what="difference")
    found = until(page, "comparison", lambda t: t.get("significant", 0) > 100)
    assert found["shown"] == "difference" and found["least"] < 0 and found["most"] == 0
    cover = wait_for(lambda: page.of("cover"), "a cover")[-1]
    assert (cover["width"], cover["height"]) == SIZE
    jpeg = Image.open(io.BytesIO(base64.b64decode(cover["image"]))).convert("RGB")
    r, _, b = jpeg.getpixel((80, 60))
    assert jpeg.size == SIZE and b > r + 60
    page.edit("point", x=0, y=0)
    until(page, "comparison", lambda t: t.get("here", 0) < 0)
    page.edit("point", x=0.95, y=0.95)
    until(page, "comparison", lambda t: t.get("here") == 0)
    page.edit("compare", what="difference")
    until(page, "comparison", lambda t: t["shown"] == "present")


def test_another_view_is_not_compared(serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    leader, page = server.join(*SIZE), server.join_editor()
    page.send(type="own")
    page.until_state(lambda s: s["role"] == "own")
    for command, members in (("compare", {"what": "a"}),
                             ("measure", {"x0": 0, "y0": 0, "x1": 1, "y1": 1})):
        count = len(page.of("said"))
        page.edit(command, **members)
        assert "page that leads" in page.told("said", count + 1)["text"]
    leader.still()


# --- Problems, reports ---


def test_problems_lead_to_their_nodes(serve):
    world = WORLD.replace("geometry DEF BLOCK Box { }", "geometry DEF BLOCK Box { size -1 1 1 }")
    page = serve(world, "--edit", "--spp", 1).join_editor()
    closed = until(page, "problems", lambda t: t["count"] > 0)
    assert closed["rows"] == []
    page.edit("problems", open=True)
    row = until(page, "problems", lambda t: t["rows"])["rows"][0]
    assert "Box" in row["text"] and row["label"] == "BLOCK  Box"
    page.edit("select", node=row["node"])
    until(page, "sheet", lambda t: t["title"] == "BLOCK  Box")


def test_a_report_is_downloaded(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 4)
    page = server.join_editor()
    page.still()
    page.edit("probe", x=0, y=0)
    drag(page, paint(page), "diffuseColor", [0, 1, 0])
    page.still(lambda p: green(*p.at(0, 0)))
    page.edit("report")
    files = page.told("report")["files"]
    assert [one["name"] for one in files] == ["world-report.html", "world-report.csv"]
    cookie = server.get("/?token=" + server.edit_token).headers["Set-Cookie"].split(";")[0]
    html, table = (server.get("/" + one["path"], {"Cookie": cookie}) for one in files)
    assert html.status == table.status == 200
    assert html.headers["Content-Disposition"].startswith("attachment")
    assert b"Material" in html.body and b"0 1 0" in html.body and b"data:image/png" in html.body
    assert table.body.startswith(b"kind,name,field")
    page.edit("probe_table")
    saved = page.told("saved")
    assert saved["name"] == "world-probes.csv"
    assert server.get("/" + saved["path"], {"Cookie": cookie}).body.startswith(b"probe,x,y,z")
    assert sorted(path.name for path in vv.folder.glob("*report*")) == []


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
    two.edit("save")
    history(two, unsaved=False)
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
    for value_, why in ((2, "from 0 to 1"), ("1", "a number"), ([1, 2], "a number"), (None,
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
    good.edit("save")
    history(good, unsaved=False)
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
