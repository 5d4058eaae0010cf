"""Tests the commands of vv --control that edit the world's file: steps, undo, saving, and what hostile
clients send."""
import json
import os
import random
import subprocess

import pytest

from conftest import HEADER, find_vv
from control_server import SMALL, module, refused, start  # noqa: F401

TABLE = HEADER + """# The table of the hall
DEF LAMP PointLight { intensity 0.80 # by day
}
DEF TABLE Group {
  children [
    DEF LEG Shape { geometry DEF BLOCK Box { size .1 1 .1 } } # oak
  ]
}
DEF SECOND Group { children USE LEG }
DEF CLOCK TimeSensor { }
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "table.wrl").write_text(TABLE)
    return tmp_path / "table.wrl"


@pytest.fixture
def table(start, file):
    return start("table.wrl", *SMALL).connect()


def one(vv, edit, called="A step", **members):
    """Does one edit. Returns the number of the node that it makes."""
    return vv.call("edit", name=called, edits=[{"edit": edit, **members}])["nodes"][0]


def text(vv):
    return vv.edits(text=True)["text"]


def test_steps_are_done_undone_and_saved(table, file):
    state = table.edits()
    assert state == {
        "read_only": None,
        "changed": False,
        "changed_on_disk": False,
        "undo": None,
        "redo": None,
        "recoverable": None
    }
    with table.edit("Dim") as step:
        step.set("LAMP", "intensity", 0.5)
        step.set("LAMP", "color", (1, 0.9, 0.8))
    assert table.get("LAMP", "intensity") == 0.5 and table.edits()["changed"]
    assert table.undo() == "Dim" and table.undo() is None
    assert table.get("LAMP", "intensity") == pytest.approx(0.8) and text(table) == TABLE
    assert table.edits()["redo"] == "Dim"
    assert table.redo() == "Dim" and table.redo() is None
    table.save()
    assert not table.edits()["changed"]
    saved = file.read_text()
    assert "intensity 0.5 # by day" in saved and "# oak" in saved
    # what set does is not part of the file
    table.set("LAMP", "intensity", 0.25)
    assert text(table) == saved


def test_nodes_are_made_and_named_within_a_step(table):
    with table.edit("Build") as step:
        place = step.wrap("LAMP")
        step.set(place, "translation", (1, 2, 3))
        step.rename(place, "STAND")
        spot = step.insert("DEF SPOT SpotLight { }", place, index=0)
        copy = step.duplicate("TABLE")
        step.move("CLOCK", "TABLE", index=0)
        step.use(spot, copy)
        step.route("CLOCK", "isActive", spot, "set_on")
    assert table.node(place.number)["name"] == "STAND"
    assert table.get("STAND", "children") == [spot.number, table.node("LAMP")["node"]]
    assert table.get(copy.number, "children")[-1] == spot.number
    assert table.get("TABLE", "children")[0] == table.node("CLOCK")["node"]
    assert "ROUTE CLOCK.isActive TO SPOT.set_on" in text(table)
    with table.edit("Cut") as step:
        step.unroute("CLOCK", "isActive", "SPOT", "set_on")
    assert "ROUTE" not in text(table)
    assert table.undo() == "Cut" and table.undo() == "Build" and text(table) == TABLE
    assert table.node(place.number)["type"] == "Transform", "a number keeps its node"


def test_a_step_is_done_as_a_whole_or_not(table):
    with pytest.raises(module().ControlError) as error:
        with table.edit("Fails") as step:
            step.set("LAMP", "intensity", 0.5)
            step.insert("Group { }")
            step.remove("LEG")
    assert error.value.code == "edit"
    assert str(error.value) == "edit: edits[2]: this Shape stands in 2 places: say which one is meant"
    assert text(table) == TABLE and table.edits()["undo"] is None
    with pytest.raises(ZeroDivisionError):
        with table.edit("Never sent") as step:
            step.set("LAMP", "intensity", 1 / 0)
    with table.edit("Empty"):
        pass
    assert table.edits()["undo"] is None


def test_places(table):
    with table.edit("Remove the second") as step:
        step.remove("LEG", at={"parent": "SECOND"})
    assert table.get("SECOND", "children") == []
    assert table.undo() == "Remove the second"
    with table.edit("Move to the top") as step:
        step.move("LEG", at={"parent": "TABLE", "field": "children", "index": 0}, index=0)
    assert text(table).index("Shape") < text(table).index("LAMP")
    table.undo()
    with table.edit("To the end of its own list") as step:
        step.move("LAMP")
    assert text(table).rstrip().endswith("}") and text(table).index("LAMP") > text(table).index("CLOCK")
    table.undo()
    assert text(table) == TABLE
    refused("edit", "does not stand there", one, table, "remove", node="LEG", at={"parent": None})
    refused("edit", "there is no place 9 among 4", one, table, "insert", vrml="Group {}", index=9)
    refused("edit", "does not stand in the world's own file", one, table, "remove",
            node=table.create("Group {}").nodes[0])


def test_what_cannot_be_edited(table):
    refused("node", "edits[0]: the world has no node \"LAMB\"; did you mean \"LAMP\"?", one, table,
            "rename", node="LAMB", name="A")
    refused("node", "there is no node 99", one, table, "set", node=99, field="on", value=True)
    refused("field", "did you mean intensity?", one, table, "set", node="LAMP", field="intensty",
            value=1)
    refused("field", "it cannot be edited", one, table, "set", node="CLOCK", field="time", value=1)
    refused("value", "numbers in [0,1]", one, table, "set", node="LAMP", field="intensity",
            value=2)
    refused("value", "edits[0]: PointLight.on", one, table, "set", node="LAMP", field="on",
            value=[[[]]])
    refused("edit", "holds nodes", one, table, "set", node="TABLE", field="children", value=["LAMP"])
    refused("edit", "is no name", one, table, "rename", node="LAMP", name="a b")
    refused("edit", "another node is named", one, table, "rename", node="LAMP", name="LEG")
    refused("edit", "would become a part of itself", one, table, "use", node="TABLE",
            parent="TABLE")
    refused("edit", "no node with children", one, table, "wrap", node="LAMP", type="Box")
    refused("edit", "has no field", one, table, "insert", vrml="Group {}", parent="LAMP")
    refused("edit", "Nonsense", one, table, "insert", vrml="Nonsense {}")
    refused("edit", "one node", one, table, "insert", vrml="Group {} Group {}")
    refused("edit", "no eventOut", one, table, "route", **{"from": ["LAMP", "x"], "to": ["LEG", "y"]})
    refused("edit", "no such route", one, table, "unroute",
            **{"from": ["CLOCK", "isActive"], "to": ["LAMP", "set_on"]})
    with pytest.raises(ValueError):
        one(table, "set", node="LAMP", field="intensity", value=float("nan"))
    assert text(table) == TABLE and table.edits()["undo"] is None


def test_nodes_that_are_gone(table):
    number = table.node("LAMP")["node"]
    one(table, "remove", node="LAMP")
    refused("node", "no node \"LAMP\"", one, table, "set", node="LAMP", field="on", value=False)
    refused("edit", "does not stand in the world's own file", one, table, "remove", node=number)
    before = text(table)
    refused("edit", "has been removed from the file", one, table, "set", node=number, field="on",
            value=False)
    assert text(table) == before
    table.undo()
    assert text(table) == TABLE
    table.release(number)
    refused("node", "has released it", one, table, "set", node=number, field="on", value=False)


def test_files_that_save_refuses(table, file, tmp_path):
    one(table, "set", node="LAMP", field="on", value=False)
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", "/dev/null"):
        refused("file", "a pipe or a device", table.save, path)
    refused("file", "nowhere", table.save, "nowhere/a.wrl")
    refused("file", "directory", table.save, ".")
    table.save("other.wrl")
    assert "on FALSE" in (tmp_path / "other.wrl").read_text() and table.edits()["changed"]
    file.write_text(TABLE + "# others\n")
    assert table.edits()["changed_on_disk"]
    refused("edit", "another program", table.save)
    refused("edit", "another program", table.save, file)
    table.save(overwrite=True)
    assert "# others" not in file.read_text()


def test_a_file_that_the_world_reads_is_not_saved_over(start, tmp_path):
    (tmp_path / "part.wrl").write_text(HEADER + "Group { }\n")
    (tmp_path / "whole.wrl").write_text(HEADER + 'Inline { url "part.wrl" }\nDEF G Group { }\n')
    vv = start("whole.wrl", *SMALL).connect()
    one(vv, "rename", node="G", name="H")
    refused("file", "a file that the world is made of", vv.save, "part.wrl")
    # Pictures do not replace the world's file, also when edits have.
    for _ in range(2):
        with pytest.raises(module().ControlError, match="whole.wrl"):
            vv.render(file="whole.wrl", format="png")
        vv.save()
        assert (tmp_path / "whole.wrl").read_text().endswith("DEF H Group { }\n")
        one(vv, "set", node="H", field="bboxSize", value=[1, 1, 1])
        vv.undo()


def test_files_that_are_only_read(start, tmp_path, file):
    (tmp_path / "old.wrl").write_text("#VRML V1.0 ascii\nSeparator { Cube { } }\n")
    vv = start("old.wrl", *SMALL).connect()
    assert "is VRML 1.0" in vv.edits()["read_only"]
    refused("edit", "can be edited", one, vv, "insert", vrml="Group {}")
    refused("edit", "can be edited", vv.save)
    vv.load("table.wrl")
    one(vv, "set", node="LAMP", field="on", value=False)
    made = vv.create("Group { }").nodes
    vv.replace_world(made)
    refused("edit", "another world", one, vv, "rename", node=made[0], name="A")
    refused("edit", "another world", vv.undo)
    refused("edit", "another world", vv.save)
    assert file.read_text() == TABLE


def test_clients_share_one_history(start, file):
    server = start("table.wrl", *SMALL)
    one_client, two = server.connect(), server.connect()
    one(one_client, "set", "First", node="LAMP", field="on", value=False)
    one(two, "set", "Second", node="LAMP", field="intensity", value=0)
    assert one_client.undo() == "Second" and two.undo() == "First"
    assert text(one_client) == TABLE


def test_large_steps(table):
    refused("limit", "edits=10000", table.call, "edit", name="x",
            edits=[{"edit": "duplicate", "node": "LEG"}] * 100_000)
    with table.edit("Many") as step:
        for i in range(1000):
            step.set(step.insert(f"DEF N{i} Transform {{ }}"), "translation", (i, 0, 0))
    assert table.get("N999", "translation") == [999, 0, 0]
    assert table.undo() == "Many" and text(table) == TABLE


def test_random_steps_give_the_file_back(table):
    choose = random.Random(45)
    numbers = [table.node(name)["node"] for name in ("LAMP", "TABLE", "LEG", "SECOND", "CLOCK")]
    done = 0
    for i in range(200):
        node, other = choose.choice(numbers), choose.choice(numbers)
        edit = choose.choice([
            {"edit": "wrap", "node": node},
            {"edit": "duplicate", "node": node},
            {"edit": "remove", "node": node, "at": {"parent": other}},
            {"edit": "move", "node": node, "parent": other, "index": choose.randrange(3)},
            {"edit": "use", "node": node, "parent": other},
            {"edit": "insert", "vrml": "DEF N Transform { }", "parent": choose.choice([None, other])},
            {"edit": "rename", "node": node, "name": f"R{i}"},
        ])  # yapf: disable
        try:
            made, = table.call("edit", name=str(i), edits=[edit])["nodes"]
            done += 1
            if made is not None:
                numbers.append(made)
        except module().ControlError as error:
            assert error.code == "edit", (edit, error)
    assert done > 50
    edited = text(table)
    for _ in range(done):
        assert table.undo() is not None
    assert table.undo() is None and text(table) == TABLE
    for _ in range(done):
        assert table.redo() is not None
    assert text(table) == edited


# --- Nodes and places ---


def test_roots_parents_and_selection(start, file):
    server = start("table.wrl", *SMALL)
    vv, other = server.connect(), server.connect()
    roots = vv.roots()
    assert [(r["type"], r["name"]) for r in roots] == [("PointLight", "LAMP"), ("Group", "TABLE"),
                                                       ("Group", "SECOND"), ("TimeSensor", "CLOCK")]
    lamp, table_, second, _ = (r["node"] for r in roots)
    leg = vv.node("LEG")["node"]
    places = sorted(vv.parents("LEG"), key=lambda place: place["parent"])
    assert places == [{"parent": p, "field": "children", "index": 0} for p in (table_, second)]
    assert vv.parents(lamp) == [{"parent": None, "field": None, "index": 0}]
    for place in vv.parents("LEG"):  # places may be sent back
        one(vv, "remove", node="LEG", at=place)
    assert vv.parents(leg) == [] and vv.undo() == vv.undo() == "A step"
    assert vv.selection() == []
    vv.select("LAMP", leg)
    assert [n["name"] for n in other.selection()] == ["LAMP", "LEG"]
    other.select()
    assert vv.selection() == []
    refused("node", "no node", vv.select, "LAMP", "NOBODY")
    refused("node", "there is no node 77", vv.parents, 77)


PICKED = HEADER + """
DEF V Viewpoint { position 0 0 5 fieldOfView 1.5707963 }
DEF T Transform { translation 2 0 0 children DEF S Shape {
  appearance DEF A ORTAppearance { shader DEF G ORTShader { name "Glass" file "glass" } }
  geometry DEF B Box { size 2 2 2 }
} }
"""


def test_pick(start, tmp_path):
    (tmp_path / "picked.wrl").write_text(PICKED)
    vv = start("picked.wrl", "--size", "40x20", "--spp", "1").connect()
    hit = vv.pick(0.25, 0)  # aspect 2, tan(45 degrees) = 1: 0.5 to the right at distance 1
    assert hit["point"] == pytest.approx([2, 0, 1]) and hit["normal"] == pytest.approx([0, 0, 1])
    assert hit["distance"] == pytest.approx(4 * 1.25**.5)
    assert [n["name"] for n in hit["path"]] == ["T", "S"]
    named = {name: hit[name]["name"] for name in ("geometry", "appearance", "shader")}
    assert named == {"geometry": "B", "appearance": "A", "shader": "G"}
    vv.select(hit["path"][-1]["node"])
    assert vv.selection()[0]["name"] == "S"
    assert vv.pick(-1, 1) is None
    vv.set("T", "translation", (-2, 0, 0))
    assert vv.pick(0.25, 0) is None and vv.pick(-0.25, 0)["point"] == pytest.approx([-2, 0, 1])
    refused("command", "from -1 to 1", vv.pick, 2, 0)


def test_pick_says_which_side_is_seen(start, tmp_path):
    (tmp_path / "sides.wrl").write_text(HEADER + """
DEF V Viewpoint { position 0 0 5 }
Shape { geometry IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 3 ]
  coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } } }
""")
    vv = start("sides.wrl", *SMALL).connect()
    hit = vv.pick(0, 0)
    assert hit["normal"] == pytest.approx([0, 0, 1]) and hit["facing"] is True
    vv.set("V", "position", (0, 0, -5))
    vv.set("V", "orientation", (0, 1, 0, 3.1415927))
    hit = vv.pick(0, 0)
    assert hit["normal"] == pytest.approx([0, 0, 1]) and hit["facing"] is False


def test_pick_waits_for_the_viewer(start, tmp_path):
    (tmp_path / "plain.wrl").write_text(HEADER + "Transform { translation 30 0 0 children Shape { "
                                        "geometry Sphere { } } }")
    vv = start("plain.wrl", *SMALL).connect()
    assert vv.pick(0, 0)["path"][0]["type"] == "Transform", "the first picture shows the whole world"
    lens = start("plain.wrl", *SMALL, "--camera-shader", "Panorama").connect()
    refused("failed", "camera shader", lens.pick, 0, 0)


# --- Light ---

LIT = HEADER + """
NavigationInfo { headlight FALSE }
DEF V Viewpoint { position 0 0 4 }
DEF GLOW Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options [ "color emission 5 10 20", "color reflectance 0 0 0" ] } }
  geometry Sphere { }
}
Transform { translation 0 -3 0 children DEF FLOOR Shape {
  appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
    options [ "color reflectance .5 .5 .5" ] } }
  geometry Box { size 20 .1 20 }
} }
"""
SIZE = (48, 32)


def pixel_of(picture, x, y):
    """Returns the values of each channel of an EXR picture at a place."""
    exr_tools = pytest.importorskip("exr_tools")
    _, planes = exr_tools.read_exr(picture)
    column, row = (
        min(max(int(place * count), 1), count - 2)  # not at the border
        for place, count in zip(((x + 1) / 2, (1 - y) / 2), SIZE))
    return {name: float(plane[row][column]) for name, plane in planes.items()}


@pytest.fixture
def lit(start, tmp_path):
    (tmp_path / "lit.wrl").write_text(LIT)
    return start("lit.wrl", "--size", "48x32", "--spp", "64").connect()


def test_probe_reads_a_pixel_of_the_true_picture(lit, tmp_path):
    subprocess.run([
        find_vv(), "lit.wrl", "-o", "lit.exr", "--size", "48x32", "--spp", "64", "--channels",
        "rgba,error,trust,samples", "-q"
    ],
                   cwd=tmp_path,
                   check=True)
    picture = (tmp_path / "lit.exr").read_bytes()
    for x, y in ((0, 0), (-1, 0), (0.3, -0.8), (-0.9, 0.7), (-1, -1), (1, 1)):
        got, want = lit.probe(x, y), pixel_of(picture, x, y)
        assert got["samples"] == 64
        for k, colour in enumerate("RGB"):
            assert got["radiance"][k] == pytest.approx(want[colour], rel=1e-6), (x, y)
            assert got["radiance_half_width"][k] == pytest.approx(want[f"error.{colour}"], rel=1e-6)
        assert got["trusted"] == (want["trust"] > 0)
        r, g, b = got["radiance"]
        assert got["luminance"] == pytest.approx(.2126 * r + .7152 * g + .0722 * b, rel=1e-6)
    glow = lit.probe(0, 0)
    assert glow["radiance"] == [5, 10, 20] and glow["half_width"] < .1
    assert glow["hit"]["path"][-1]["name"] == "GLOW"
    assert lit.probe(0, 0) == glow
    assert lit.probe(-0.9, 0.9)["hit"] is None


def test_probe_follows_edits(lit):
    before = lit.probe(0.3, -0.8, samples=256)
    assert before["hit"]["path"][-1]["name"] == "FLOOR"
    assert before["trusted"] and 0 < before["half_width"] < before["luminance"] / 4
    shader = lit.probe(0, 0)["hit"]["shader"]["node"]
    one(lit, "set", node=shader, field="options",
        value=["color emission 10 20 40", "color reflectance 0 0 0"])
    after = lit.probe(0.3, -0.8, samples=256)
    assert abs(after["luminance"] - 2 * before["luminance"]) < 2 * before["half_width"] + after["half_width"]
    lit.undo()
    assert lit.probe(0.3, -0.8, samples=256) == before
    # pictures are whole again
    assert len(lit.render(format="ppm")) > 48 * 32 * 3


def test_probes_and_pictures_take_turns(start, tmp_path):
    (tmp_path / "lit.wrl").write_text(LIT)
    server = start("lit.wrl", "--size", "48x32", "--spp", "16")
    one_, two = server.raw(), server.raw()
    for i in range(5):
        one_.send({"id": i, "command": "probe", "x": 0, "y": -0.8})
        two.send({"id": i, "command": "render", "format": "ppm"})
    probes = [one_.receive() for _ in range(5)]
    pictures = [two.receive() for _ in range(5)]
    assert [p["id"] for p in probes] == [p["id"] for p in pictures] == list(range(5))
    assert len({p["result"]["luminance"] for p in probes}) == 1
    assert len({p["result"]["data"] for p in pictures}) == 1
    assert probes[0]["result"]["trusted"] is False, "16 samples make no replicates"


def test_worlds_without_light_units(start, tmp_path):
    (tmp_path / "lit.wrl").write_text(LIT)
    vv = start("lit.wrl", *SMALL, "--colour", "vrml97").connect()
    refused("failed", "not light", vv.probe, 0, 0)
    vv.call("hello")


# --- The end ---


def test_nothing_is_done_behind_quit(start, file):
    server = start("table.wrl", *SMALL)
    raw = server.raw()

    def dim(intensity):
        return {"command": "edit", "name": "Dim", "edits": [
            {"edit": "set", "node": "LAMP", "field": "intensity", "value": intensity}]}

    lines = [dim(0.5), {"command": "quit", "discard": True}, dim(0.25), {"command": "save"}]
    raw.send(b"".join(json.dumps({"id": i, **line}).encode() + b"\n"
                      for i, line in enumerate(lines)))
    answers = [raw.receive() for _ in lines]
    assert [a["id"] for a in answers[:2]] == [0, 1] and all("result" in a for a in answers[:2])
    for answer in answers[2:]:  # the connection may have ended before the line was read
        assert answer is None or answer["error"]["code"] == "refused", answer
    assert server.program.wait(20) == 0
    assert file.read_text() == TABLE
    assert sorted(path.name for path in file.parent.iterdir()) == ["table.wrl", "world.wrl"]


def test_what_is_kept_of_edits_is_not_overwritten(start, file):
    server = start("table.wrl", *SMALL)
    vv = server.connect()
    one(vv, "set", node="LAMP", field="intensity", value=0.5)
    journal = file.with_name(".table.wrl.vv-edits")
    for name in (journal, journal.with_name(journal.name + "-3")):
        refused("file", "another name is needed", vv.save, str(name))
    refused("file", "another name is needed", vv.render, file=str(journal), format="png")
    server.wait(lambda: journal.exists() and "intensity 0.5" in journal.read_text(), "the journal")
    vv.save()
    assert "intensity 0.5" in file.read_text()


def test_texts_with_zero_bytes_are_refused(table):
    refused("command", "without zero bytes", one, table, "rename", node="LEG", name="A\0B")
    refused("command", "without zero bytes", one, table, "remove", called="a\0b", node="LEG")
    refused("command", "without zero bytes", table.create, "Group { }\0")
    refused("node", "\\u0000", table.get, "LEG\0", "children")
    assert text(table) == TABLE
