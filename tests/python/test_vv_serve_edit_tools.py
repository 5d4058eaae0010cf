"""Tests the tools of the editor on the page of `vv serve --edit` with real WebSockets: nodes in fields,
looks, handles, probes, A and B, problems and reports."""
import base64
import io

from conftest import HEADER
from page_client import Image, serve, wait_for  # noqa: F401
from serve_edit_tools import (
    SIZE, WORLD, drag, field, history, node, opened, paint, save, select, select_row, text_of,
    until, value)
from window_driver import green, red


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
    number = next(one["number"] for one in looks if one["name"] == "Diffuse")
    page.edit("set_look", number=number, only_here=True)
    sheet = until(page, "sheet", lambda t: t.get("look", {}).get("name") == "Diffuse")
    page.edit("select", node=sheet["look"]["surface"])
    sheet = until(page, "sheet", lambda t: t["title"] == "ORTShader")
    colour = next(one for one in sheet["fields"] if one["type"] == "SFColor")
    drag(page, sheet["node"], colour["field"], [0, 1, 0])
    page.still(lambda p: green(*p.at(0, 0)))
    save(page)
    assert 'name "Diffuse"' in text_of(vv) and f"{colour['field']} 0 1 0" in text_of(vv)


def test_options_of_a_shader_are_set_in_their_places(serve, vv):
    world = HEADER + """Shape { geometry Box { } appearance ORTAppearance {
  shader DEF G ORTShader { name "Glass" options [ "1f index 1.50, color tint 1 .9 .8" ] } } } # by hand
"""
    page = serve(world, "--edit", "--spp", 1).join_editor()
    opened(page, "Shape", "appearance: ORTAppearance")
    sheet = select_row(page, "shader: G  ORTShader", "G  ORTShader")
    assert field(sheet, "index")["value"] == 1.5 and field(sheet, "tint")["value"] == [1, 0.9, 0.8]
    drag(page, sheet["node"], "index", 1.4, 1.3)
    drag(page, sheet["node"], "tint", [1, 0.9, 0.5])
    value(page, "tint", [1, 0.9, 0.5])
    history(page, undo="Set ORTShader.tint", unsaved=True)
    save(page)
    assert text_of(vv) == world.replace("1.50", "1.3").replace(".8\"", "0.5\"")
    page.edit("undo")
    page.edit("undo")
    value(page, "index", 1.5)
    history(page, undo="", redo="Set ORTShader.index")


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
    save(page)
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


# --- Light ---


def test_probes_measure_the_light(serve):
    server = serve(WORLD, "--edit", "--spp", 64)
    page = server.join_editor()
    page.edit("probe", x=0, y=0)
    # The interval is not known while there are few samples.
    first = until(page, "probes", lambda t: t["list"] and t["list"][0].get("half_width") is not None)
    probe = first["list"][0]
    assert probe["state"] == "read" and probe["luminance"] > 0 and "trusted" in probe
    assert probe["seen"] == "THING  Shape, Material\nat 0 0 1, 4 from the viewer\nnormal 0 0 1"
    page.edit("keep_probes")
    drag(page, paint(page), "diffuseColor", [1, 1, 1])
    changed = until(page, "probes", lambda t: t["list"] and t["list"][0].get("change", 0) > 0)
    assert changed["list"][0]["luminance"] > probe["luminance"]
    page.edit("probe", x=0.9, y=0.9)
    # Before, the page may have been told that the picture of A was not there yet.
    until(page, "said", lambda t: "nothing here" in t["text"])
    page.edit("clear_probes")
    until(page, "probes", lambda t: t["list"] == [])


def test_what_is_seen_under_a_pointer_that_rests(serve):
    server = serve(WORLD, "--edit", "--spp", 256)
    page = server.join_editor()
    page.still()
    page.edit("point", x=0, y=0)
    seen = until(page, "pointer", lambda t: "seen" in t)
    assert seen["seen"] == "THING  Shape, Material\nat 0 0 1, 4 from the viewer\nnormal 0 0 1"
    assert (seen["x"], seen["y"]) == (0, 0)
    drag(page, paint(page), "diffuseColor", [0.5, 0.25, 1])
    read = until(page, "pointer", lambda t: t.get("samples") == 256 and t["radiance"][2] > 0)
    r, g, b = read["radiance"]
    assert b > r > g > 0 and g < read["luminance"] < b
    assert len(read["radiance_half_width"]) == 3 and read["half_width"] >= 0 and read["trusted"]
    page.edit("probe", x=0, y=0)
    probe = until(page, "probes", lambda t: t["list"] and t["list"][0]["state"] == "read")
    assert probe["list"][0]["luminance"] == read["luminance"]
    page.edit("point", x=0.9, y=0.9)
    until(page, "pointer", lambda t: t.get("seen") == "nothing is here")
    page.edit("point")
    until(page, "pointer", lambda t: t == {"type": "pointer"})
    other = server.join_editor()
    other.send(type="own")
    other.until_state(lambda s: s["role"] == "own")
    other.edit("point", x=0, y=0)  # the picture that is read is the leader's
    other.edit("search", text="THING")
    until(other, "rows", lambda t: t["total"] == 1)
    assert all("seen" not in text for text in other.of("pointer"))


def test_a_reading_under_the_pointer_gets_sharper_while_it_rests(serve):
    # Light that comes by way of the wall has noise.
    world = HEADER + """
Viewpoint { position 0 1 6 }
NavigationInfo { headlight FALSE }
PointLight { location 0 2 1 }
Shape { appearance DEF LOOK ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" } }
  geometry Box { size 8 .1 8 } }
Transform { translation 0 2 -1 children Shape { appearance USE LOOK geometry Box { size 8 4 .1 } } }
"""
    page = serve(world, "--edit", "--spp", 16384).join_editor()
    page.edit("point", x=0.1, y=-0.6)
    # Fewer samples may have missed the brightest light, and tell too little noise.
    known = lambda: [t for t in page.of("pointer")
                     if t.get("half_width") is not None and t["samples"] >= 64]
    first = wait_for(known, "a reading")[0]
    assert 0 < first["samples"] < 4096
    wait_for(lambda: known()[-1]["samples"] >= 8 * first["samples"], "more samples")
    assert 0 < known()[-1]["half_width"] < first["half_width"]


def test_the_light_that_falls_on_a_surface_is_measured(serve):
    world = WORLD.replace("on FALSE", "on TRUE location 0 0 5")
    server = serve(world, "--edit", "--spp", 16, "--headlight", "off")
    page = server.join_editor()
    page.still()
    page.edit("probe", x=0, y=0, illuminance=True)
    read = until(page, "probes", lambda t: t["list"] and t["list"][0]["state"] == "read")
    before = read["list"][0]["illuminance"]
    assert before > 0 and "luminance" not in read["list"][0]
    page.edit("name_probe", probe=1, name="Desk")
    assert until(page, "probes", lambda t: "name" in t["list"][0])["list"][0]["name"] == "Desk"
    page.edit("keep_in_world", probe=1)
    history(page, undo="Keep probe 1", unsaved=True)
    until(page, "sheet", lambda t: t["title"] == "ORTSensor")
    page.edit("show_sensors")
    assert "no more sensors" in page.told("said")["text"]
    page.edit("keep_in_world", probe=7)
    assert "has been removed" in page.told("said", 2)["text"]
    until(page, "probes", lambda t: t["list"][0]["state"] == "read")
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

    def loss_at_the_middle():  # a comparison of fewer samples came before
        for cover in page.of("cover")[-1:]:
            assert (cover["width"], cover["height"]) == SIZE
            jpeg = Image.open(io.BytesIO(base64.b64decode(cover["image"]))).convert("RGB")
            assert jpeg.size == SIZE
            r, _, b = jpeg.getpixel((80, 60))
            return b > r + 60

    wait_for(loss_at_the_middle, "the difference")
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
