"""Tests edits against what happens beside them: Scripts that take nodes away, saves while others edit, and
a disk that is full while the file is saved. Nothing is lost, and one message says what was refused."""
import re
import resource
import threading
import time

import pytest

from conftest import HEADER
from control_server import SMALL, module, refused, start  # noqa: F401
from page_client import serve, wait_for  # noqa: F401
from serve_edit_tools import WORLD, drag, history, newest, opened, select, text_of, until, value

# The Script empties the group at the first event, and fills it with another node at the second.
TAKEN = HEADER + """# The hall
Viewpoint { position 0 0 5 }
DEF LIGHTS Group { children [
  DEF LAMP PointLight { intensity 0.80 # by day
  }
  DEF INNER Group { children DEF SPOT SpotLight { radius 7 } }
] }
DEF THIEF Script {
  eventIn SFBool take eventIn SFBool fill field SFNode lights USE LIGHTS directOutput TRUE
  url "javascript:
    function take() { lights.children = new MFNode(); }
    function fill() { lights.children = new MFNode(new SFNode('Group { }')); }"
}
Shape { geometry Box { } }
"""


@pytest.fixture
def hall(start, tmp_path):
    """Returns a function that starts vv with TAKEN and a client."""

    def begin():
        (tmp_path / "hall.wrl").write_text(TAKEN)
        return start("hall.wrl", *SMALL).connect()

    return begin


def taken(vv):
    vv.set("THIEF", "take", True)
    end = time.monotonic() + 20
    while vv.get("LIGHTS", "children"):
        assert time.monotonic() < end
        time.sleep(.01)


def text(vv):
    return vv.edits(text=True)["text"]


def test_a_selected_node_that_a_script_takes_away_is_edited_in_the_file(hall, tmp_path):
    vv = hall()
    vv.select("LAMP")
    lamp = vv.node("LAMP")["node"]
    with vv.edit("Dim") as step:
        step.set("LAMP", "intensity", 0.5)
    taken(vv)
    assert [one["node"] for one in vv.selection()] == [lamp]
    with vv.edit("Dim more") as step:
        step.set(lamp, "intensity", 0.25)
    dimmed = TAKEN.replace("0.80", "0.25")
    assert text(vv) == dimmed
    assert vv.undo() == "Dim more" and vv.undo() == "Dim" and text(vv) == TAKEN
    assert vv.redo() == "Dim" and vv.redo() == "Dim more"
    vv.save()
    assert (tmp_path / "hall.wrl").read_text() == dimmed, "what the Script has done is not saved"
    assert vv.get("LIGHTS", "children") == [], "nor is it taken back"


def test_undo_of_nodes_whose_parent_a_script_has_emptied(hall):
    vv = hall()
    steps = [
        ("remove", {"node": "LAMP"}), ("insert", {"vrml": "DEF NEW Group { }", "parent": "INNER"}),
        ("set", {"node": "SPOT", "field": "radius", "value": 5}), ("duplicate", {"node": "SPOT"}),
        ("wrap", {"node": "INNER"}), ("rename", {"node": "SPOT", "name": "TORCH"})]  # yapf: disable
    for edit, members in steps:
        vv.call("edit", name=edit, edits=[{"edit": edit, **members}])
    edited = text(vv)
    taken(vv)
    assert text(vv) == edited
    for edit, _ in reversed(steps):
        assert vv.undo() == edit
    assert text(vv) == TAKEN and vv.edits()["undo"] is None
    vv.set("THIEF", "fill", True)
    for edit, _ in steps:
        assert vv.redo() == edit
    assert text(vv) == edited
    vv.save()
    assert not vv.edits()["changed"]


def test_a_page_goes_on_when_a_script_takes_its_selection_away(serve, vv):
    server = serve(TAKEN.replace("Shape {", "DEF TOUCH TouchSensor { } Shape {") +
                   "ROUTE TOUCH.isActive TO THIEF.take\n", "--edit", "--spp", 1)
    page = server.join_editor()
    opened(page, "LIGHTS  Group")
    number = select(page, "LAMP  PointLight")["node"]
    page.edit("drag", node=number, field="intensity", value=0.5)
    viewer = server.join()
    viewer.still()
    viewer.send(type="own")
    viewer.until_state(lambda s: s["role"] == "own")
    viewer.click(0, 0)

    def is_gone():
        for words in ("", "LAMP"):
            page.edit("search", text=words)
        time.sleep(.1)
        return newest(page, "rows")["total"] == 0

    wait_for(is_gone, "the Script takes it away")
    drag(page, number, "intensity", 0.25)
    history(page, undo="Set PointLight.intensity", unsaved=True)
    page.edit("undo")
    history(page, undo="", redo="Set PointLight.intensity")
    page.edit("redo")
    history(page, undo="Set PointLight.intensity", unsaved=True)
    page.edit("save")
    history(page, unsaved=False)
    assert "intensity 0.25 # by day" in text_of(vv) and "DEF INNER Group" in text_of(vv)
    assert not [one for one in page.of("said") if one["error"]]


def test_edits_while_the_file_is_saved(start, tmp_path):
    """The file has a state of the world at each time, and no save takes a later edit away."""
    world = TAKEN + "".join(f"DEF N{i} Group {{ }}\n" for i in range(3000))
    file = tmp_path / "hall.wrl"
    file.write_text(world)
    server = start("hall.wrl", *SMALL)
    editor, saver = server.connect(), server.connect()
    read, last, done = [], [0.8], threading.Event()

    def save():
        while not done.is_set():
            before = last[0]
            saver.save()
            read.append((before, file.read_text()))

    def edit():
        for i in range(1, 400):
            with editor.edit("Dim") as step:
                step.set("LAMP", "intensity", 0.8 - i / 1000)
            last[0] = 0.8 - i / 1000
        done.set()

    threads = [threading.Thread(target=work) for work in (save, edit)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert done.is_set() and len(read) > 1
    for before, saved in read:
        word = re.search(r"intensity (\S+)", saved)[1]
        assert saved == world.replace("0.80", word)
        assert float(word) <= before + 1e-6, "an edit that was done before is in it"
    saver.save()
    assert file.read_text() == world.replace("0.80", "0.401") and not editor.edits()["changed"]
    while editor.undo():
        pass
    assert text(editor) == world


class Disk:
    """Lets files of a program grow no more, as on a full disk, and then again."""

    def __init__(self, program):
        self.program = program

    def limit(self, size):
        resource.prlimit(self.program.pid, resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))

    def __enter__(self):
        self.limit(20)

    def __exit__(self, *_):
        self.limit(resource.RLIM_INFINITY)


def names(folder):
    return sorted(path.name for path in folder.iterdir() if path.name != "world.wrl")


def test_a_full_disk_leaves_the_file_and_the_edits(start, tmp_path):
    (tmp_path / "hall.wrl").write_text(TAKEN)
    server = start("hall.wrl", *SMALL)
    vv = server.connect()
    with Disk(server.program):
        with vv.edit("Dim") as step:
            step.set("LAMP", "intensity", 0.5)
        refused("file", "hall.wrl", vv.save)
        refused("file", "other.wrl", vv.save, "other.wrl")
        assert (tmp_path / "hall.wrl").read_text() == TAKEN
        assert not (tmp_path / "other.wrl").exists()
        assert vv.edits()["changed"]
        server.wait(lambda: [line for line in server.err if "kept nowhere" in line], "a message")
    assert not [name for name in names(tmp_path) if name.startswith(".vv-")], "no temporary file"
    vv.save()
    assert (tmp_path / "hall.wrl").read_text() == TAKEN.replace("0.80", "0.5")
    assert not vv.edits()["changed"] and names(tmp_path) == ["hall.wrl"]
    with vv.edit("Dim more") as step:  # edits are kept again
        step.set("LAMP", "intensity", 0.25)
    journal = tmp_path / ".hall.wrl.vv-edits"
    server.wait(lambda: journal.exists() and "0.25" in journal.read_text(), "the journal")
    assert len([line for line in server.err if "kept nowhere" in line]) == 1


def test_a_page_says_that_the_disk_is_full(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    opened(page, "LIGHTS  Group")
    number = select(page, "LAMP  PointLight")["node"]
    drag(page, number, "intensity", 0.5)
    value(page, "intensity", 0.5)
    with Disk(server.program):
        page.edit("save")
        until(page, "said", lambda t: t["error"] and "world.wrl" in t["text"])
        assert text_of(vv) == WORLD
        history(page, unsaved=True)
        page.edit("import", name="leg.wrl", bytes=26)
        page.edit("import_part", data="I1ZSTUwgVjIuMCB1dGY4Ckdyb3VwIHsgfQoK")
        until(page, "said", lambda t: t["error"] and "leg.wrl" in t["text"])
        assert not (vv.folder / "leg.wrl").exists()
    page.edit("save")
    history(page, unsaved=False)
    assert text_of(vv) == WORLD.replace("0.80", "0.5")
