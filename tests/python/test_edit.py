"""Tests World.edit: edits of a world's file from Python, also of real files by others."""
import json
import os
import pathlib
import random
import re
import threading
import xml.etree.ElementTree

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

HEAD = "#VRML V2.0 utf8\n"
LAMP = HEAD + "# by day\nDEF L PointLight { intensity 0.80 # bright\n}\nDEF G Group { }\n"
XML = """<?xml version="1.0" encoding="UTF-8"?>
<X3D profile='Immersive' version='3.3'>
  <Scene>
    <!-- by day -->
    <PointLight DEF='L' intensity='0.80'/> <!-- bright -->
    <Group DEF='G'/>
  </Scene>
</X3D>
"""
SHARED = pathlib.Path(__file__).resolve().parents[2].parent / "shared"


@pytest.fixture
def lamp(tmp_path):
    (tmp_path / "l.wrl").write_text(LAMP)
    return xvrml.load(tmp_path / "l.wrl")


def test_a_step_without_a_name_can_be_undone(lamp):
    with lamp.edit(""):
        lamp["L"].intensity = 0.5
    assert lamp.edit.undo() == "Edit"
    assert lamp["L"].intensity == pytest.approx(0.8)


@pytest.mark.parametrize("runs", [False, True])
def test_a_step_is_saved_in_place(lamp, runs):
    if runs:
        lamp.time = 1
    with lamp.edit("Dim"):
        lamp["L"].intensity = .25
        lamp["L"].intensity = .5
        lamp["L"].on = False
    assert lamp["L"].intensity == .5
    assert lamp.edit.changed
    lamp.edit.save()
    assert not lamp.edit.changed
    saved = pathlib.Path(lamp.path).read_text()
    assert saved == LAMP.replace("0.80", "0.5").replace("bright\n", "bright\n  on FALSE\n")
    assert lamp.edit.undo() == "Dim"
    assert lamp["L"].intensity == np.float32(.8) and lamp["L"].on
    assert lamp.edit.changed and lamp.edit.text() == LAMP
    assert lamp.edit.undo() is None
    assert lamp.edit.redo() == "Dim"


def test_an_edit_may_begin_before_the_world_runs(lamp):
    lamp.edit.set(lamp["L"], "intensity", .5)
    lamp.time = 2
    lamp.edit.set(lamp["L"], "intensity", .25)
    lamp.edit.undo()
    assert lamp["L"].intensity == .5
    lamp.edit.undo()
    assert lamp["L"].intensity == np.float32(.8)


def test_what_moves_is_not_saved(tmp_path):
    text = HEAD + """DEF T Transform { translation 1 0 0 children Shape { geometry Box { } } }
DEF C TimeSensor { loop TRUE }
DEF P PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0 0 9 0 ] }
ROUTE C.fraction_changed TO P.set_fraction
ROUTE P.value_changed TO T.set_translation
"""
    (tmp_path / "m.wrl").write_text(text)
    world = xvrml.load(tmp_path / "m.wrl")
    world.time = .25
    assert world["T"].translation[1] > 0
    world.edit.set(world["T"], "scale", (2, 2, 2))
    assert world.edit.text() == text.replace("{ } } }", "{ } } scale 2 2 2 }", 1)
    world.edit.undo()
    assert world["T"].translation[1] > 0, "undo restores what the edit has changed"


def test_an_exception_undoes_the_step(lamp):
    with pytest.raises(ZeroDivisionError):
        with lamp.edit("Fail"):
            lamp["L"].intensity = .5
            1 / 0
    assert lamp["L"].intensity == np.float32(.8) and not lamp.edit.changed
    lamp["L"].intensity = .5  # no edit of the file
    assert lamp.edit.text() == LAMP


def test_steps_within_steps(lamp):
    with lamp.edit("Outer"):
        lamp["L"].intensity = .5
        try:
            with lamp.edit("Inner"):
                lamp["L"].intensity = .25
                raise KeyError
        except KeyError:
            pass
        assert lamp["L"].intensity == .5
        lamp["L"].on = False
        with pytest.raises(xvrml.EditError, match="a step is open"):
            lamp.edit.save()
    assert lamp.edit.undo() == "Outer" and lamp.edit.text() == LAMP


def test_a_route_is_undone_once_the_world_runs(lamp):
    lamp.edit.add_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    lamp.time = 1
    assert lamp.edit.undo() == "Add route" and lamp.edit.text() == LAMP


def test_the_file_that_was_loaded_is_edited(lamp, tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "l.wrl").write_text(LAMP)
    monkeypatch.chdir(tmp_path)
    world = xvrml.load("l.wrl")
    monkeypatch.chdir(tmp_path / "sub")
    with pytest.raises(xvrml.EditError, match="load it again"):
        world.edit.set(world["L"], "on", False)
    monkeypatch.chdir(tmp_path)
    world = xvrml.load("l.wrl")
    world.edit.set(world["L"], "on", False)
    (tmp_path / "l.wrl").write_text(LAMP + "# others\n")
    with pytest.raises(xvrml.EditError, match="another program"):
        world.edit.save(tmp_path / "l.wrl")


def test_another_world_is_not_saved_over(tmp_path):
    (tmp_path / "next.wrl").write_text(HEAD + "DEF NEXT Group { }\n")
    (tmp_path / "w.wrl").write_text(
        HEAD + 'DEF L PointLight { }\nDEF A Anchor { url "next.wrl" children Shape { } }\n')
    browser = xvrml.Browser(str(tmp_path / "w.wrl"))
    browser.edit.set(browser["L"], "on", False)
    browser.replace([xvrml.Group()]) if hasattr(browser, "replace") else browser.load_url(["next.wrl"])
    with pytest.raises(xvrml.EditError, match="another world"):
        browser.edit.save()


def test_nodes(lamp):
    edit = lamp.edit
    box = edit.insert("Shape { geometry Box { } }", lamp["G"])
    edit.rename(box, "BOX")
    copy = edit.duplicate(lamp["BOX"])
    assert copy.def_name == "BOX_2" and copy == lamp["BOX_2"]
    place = edit.wrap(copy)
    edit.set(place, "translation", (1, 0, 0))
    edit.use(lamp["BOX"], lamp["G"])
    edit.move(lamp["L"])  # to the end of the file
    with pytest.raises(xvrml.EditError, match="stands in 2 places"):
        edit.remove(lamp["BOX"])
    reloaded = xvrml.loads(edit.text())
    assert [node.node_type for node in reloaded.roots] == ["Group", "PointLight"]
    assert len(reloaded["G"].children) == 3
    assert reloaded["G"].children[2] == reloaded["BOX"]
    assert tuple(reloaded["G"].children[1].translation) == (1, 0, 0)
    while edit.undo():
        pass
    assert edit.text() == LAMP and list(lamp.names) == ["G", "L"]


def test_xml(tmp_path):
    path = tmp_path / "l.x3d"
    path.write_text(XML)
    world = xvrml.load(path)
    with world.edit("Dim"):
        world["L"].intensity = .5
        world["L"].on = False
    world.edit.save()
    dimmed = XML.replace("0.80'", "0.5' on='false'")
    assert path.read_text() == dimmed
    world.edit.insert("<Shape DEF='S'><Box/></Shape>", world["G"])
    world.edit.use(world["S"], world["G"])
    world.edit.add_route(world["L"], "on", world["L"], "on")
    assert world.edit.text() == dimmed.replace(
        "<Group DEF='G'/>\n", """<Group DEF='G'>
      <Shape DEF='S'><Box/></Shape>
      <Shape USE='S'/>
    </Group>
    <ROUTE fromNode='L' fromField='on' toNode='L' toField='on'/>
""")
    while world.edit.undo():
        pass
    assert world.edit.text() == XML
    with pytest.raises(xvrml.EditError):
        world.edit.insert("Shape { }", world["G"])


JSON = """{ "X3D": {
    "@version":"3.3",
    "Scene": {
      "-children":[
        {"#comment":"by day"},
        {"PointLight": {"@DEF":"L", "@intensity":0.80, "#comment":"bright"}},
        {"Group": {"@DEF":"G"}}
      ]
    }
  }
}
"""


def test_json(tmp_path):
    path = tmp_path / "l.x3dj"
    path.write_text(JSON)
    world = xvrml.load(path)
    with world.edit("Dim"):
        world["L"].intensity = .5
        world["L"].on = False
    world.edit.save()
    dimmed = JSON.replace("0.80", "0.5").replace('"bright"}', '"bright", "@on":false}')
    assert path.read_text() == dimmed
    world.edit.insert('{"Shape": {"@DEF":"S"}}', world["G"])
    world.edit.use(world["S"], world["G"])
    world.edit.add_route(world["L"], "on", world["L"], "on")
    assert world.edit.text() == dimmed.replace(
        """{"@DEF":"G"}}
""", """{"@DEF":"G", "-children":[
          {"Shape": {"@DEF":"S"}},
          {"Shape": {"@USE": "S"}}
        ]}},
        {"ROUTE": {"@fromNode": "L", "@fromField": "on", "@toNode": "L", "@toField": "on"}}
""")
    while world.edit.undo():
        pass
    assert world.edit.text() == JSON
    with pytest.raises(xvrml.EditError):
        world.edit.insert("Shape { }", world["G"])


def test_routes(lamp):
    lamp.edit.add_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    assert lamp.edit.text().endswith("ROUTE L.on_changed TO L.set_on\n")
    lamp.edit.delete_route(lamp["L"], "on_changed", lamp["L"], "set_on")
    assert lamp.edit.text() == LAMP


def test_files_on_disk(lamp, tmp_path):
    path = tmp_path / "l.wrl"
    os.chmod(path, 0o640)
    lamp.edit.set(lamp["L"], "on", False)
    lamp.edit.save(tmp_path / "other.wrl")
    assert lamp.edit.changed and path.read_text() == LAMP
    path.write_text(LAMP + "# others\n")
    with pytest.raises(xvrml.EditError, match="another program"):
        lamp.edit.save()
    lamp.edit.save(overwrite=True)
    assert "on FALSE" in path.read_text() and path.stat().st_mode & 0o777 == 0o640
    with pytest.raises(OSError):
        lamp.edit.save(tmp_path / "none" / "x.wrl")


def test_refusals(lamp):
    with pytest.raises(ValueError, match=r"in \[0,1\]"):
        lamp.edit.set(lamp["L"], "intensity", 2)
    with pytest.raises(TypeError):
        lamp.edit.set(lamp["L"], "intensity", "much")
    with pytest.raises(xvrml.EditError):
        with lamp.edit("Nodes"):
            lamp["G"].children = [xvrml.Shape()]
    loose = xvrml.loads(LAMP)
    assert "does not come from a file" in loose.edit.read_only
    with pytest.raises(xvrml.EditError):
        loose.edit.set(loose["L"], "on", False)
    with pytest.raises(ValueError):
        loose.edit.rename(lamp["L"], "M")


def test_edits_while_pictures_are_rendered(lamp):
    failures = []

    def draw():
        try:
            for _ in range(10):
                lamp.render(size=(16, 12), spp=1)
        except Exception as error:
            failures.append(error)

    thread = threading.Thread(target=draw)
    thread.start()
    for i in range(50):
        lamp.edit.set(lamp["L"], "intensity", i / 50)
        lamp.edit.undo()
    thread.join()
    assert not failures and lamp.edit.text() == LAMP


def changeable(world):
    """Returns the nodes and fields of numbers that a file has, in a fixed order."""
    seen, found, open_ = set(), [], list(world.roots)
    while open_:
        node = open_.pop(0)
        if node is None or node in seen:
            continue
        seen.add(node)
        for name, kind in node.fields.items():
            value = getattr(node, name)
            if kind in ("SFNode", "MFNode"):
                open_.extend([value] if kind == "SFNode" else value)
            elif kind in ("SFVec3f", "SFFloat", "SFBool", "SFColor"):
                found.append((node, name, kind))
    return found


def value_for(kind, random_):
    if kind == "SFBool":
        return random_.random() < .5
    numbers = [round(random_.uniform(.1, .9), 3) for _ in range(3)]
    return numbers[0] if kind == "SFFloat" else numbers


def difference(old, new):
    """Returns the changed parts of two texts: what lies between their common ends."""
    first = next((i for i, (a, b) in enumerate(zip(old, new)) if a != b), min(len(old), len(new)))
    last = 0
    while last < min(len(old), len(new)) - first and old[-1 - last] == new[-1 - last]:
        last += 1
    return old[first:len(old) - last], new[first:len(new) - last]


def edit_one(path, seed):
    """Changes a field of a file. Returns what is wrong; None if it cannot be edited."""
    random_ = random.Random(seed)
    try:
        world = xvrml.load(path)
    except (xvrml.ParseError, OSError):
        return None
    if world.edit.read_only:
        return None
    choices = changeable(world)
    random_.shuffle(choices)
    for node, name, kind in choices[:20]:
        before = world.edit.text()
        try:
            world.edit.set(node, name, value_for(kind, random_))
        except xvrml.EditError:  # out of range, in a prototype, of another file
            continue
        try:
            after = world.edit.text()
        except xvrml.EditError as error:
            return str(error)
        gone, come = difference(before, after)
        if len(gone) > 60 or len(come) > 120:
            return "%d bytes became %d" % (len(gone), len(come))
        marks = {".x3d": "<>", ".x3dz": "<>", ".x3dj": "{}"}.get(path.suffix.lower(), "")
        if set(gone + come) & set(marks) and '{"@name"' not in come:  # a new fieldValue is an object
            return "%r became %r" % (gone, come)
        world.edit.undo()
        return "" if world.edit.text() == before else "undo gives another text"
    return None


@pytest.mark.parametrize("corpus, suffixes, step",
                         [("corpus", (".wrl", ".wrz", ".x3dv"), 4), ("corpus-x3d", (".x3d", ".x3dz"), 2)])
def test_real_files_change_within_the_field(corpus, suffixes, step):
    if not (SHARED / corpus).is_dir():
        pytest.skip("the corpus is not here")
    files = sorted(p for p in (SHARED / corpus).rglob("*")
                   if p.suffix.lower() in suffixes and p.stat().st_size < 300_000)
    assert files
    tried, wrong = 0, {}
    for number, path in enumerate(files[::step]):
        problem = edit_one(path, number)
        if problem is None:
            continue
        tried += 1
        if problem:
            wrong[path.name] = problem
    assert tried > 20
    assert len(wrong) <= tried / 100, wrong


FIELDS = {
    "Appearance": "appearance", "Color": "color", "ColorRGBA": "color", "Coordinate": "coord", "FontStyle":
    "fontStyle", "ImageTexture": "texture", "Material": "material", "MovieTexture": "texture", "Normal":
    "normal", "PixelTexture": "texture", "TextureCoordinate": "texCoord", "TextureTransform":
    "textureTransform"
}
GEOMETRY = ("Box", "Cone", "Cylinder", "ElevationGrid", "Extrusion", "IndexedFaceSet", "IndexedLineSet",
            "IndexedTriangleSet", "PointSet", "Sphere", "Text", "TriangleSet")


def json_value(text):
    """Returns the value of an attribute of XML as JSON has it."""
    if text in ("true", "false"):
        return text == "true"
    if text.lstrip().startswith('"'):
        return [re.sub(r"\\(.)", r"\1", one) for one in re.findall(r'"((?:[^"\\]|\\.)*)"', text)]
    try:
        numbers = [json.loads(one) for one in text.replace(",", " ").split()]
    except ValueError:
        return text
    return numbers[0] if len(numbers) == 1 else numbers or text


def json_object(element):
    """Returns the object for an element of XML."""
    made = {"@" + name: json_value(value) for name, value in element.attrib.items() if "}" not in name}
    in_nodes = element.tag not in ("X3D", "head", "ProtoInterface", "ProtoDeclare", "IS")
    for child in element:
        field = child.get("containerField") or FIELDS.get(
            child.tag, "geometry" if child.tag in GEOMETRY else "metadata" if
            child.tag.startswith("Metadata") else "children")
        if child.tag in ("field", "fieldValue", "connect", "meta", "component", "unit"):
            made.setdefault(child.tag, []).append(json_object(child))
        elif not in_nodes or child.tag == "IS":
            made[child.tag] = json_object(child)
        elif field in ("children", "proxy") or element.tag in ("fieldValue", "field"):
            made.setdefault("-" + field, []).append({child.tag: json_object(child)})
        else:
            made["-" + field] = {child.tag: json_object(child)}
    if (element.text or "").strip() and element.tag == "Script":
        made["#sourceCode"] = element.text.strip().split("\n")
    return made


def test_real_files_in_json_change_within_the_field(tmp_path):
    if not (SHARED / "corpus-x3d").is_dir():
        pytest.skip("the corpus is not here")
    files = sorted((SHARED / "corpus-x3d").rglob("*.x3dj"))
    for number, path in enumerate(sorted((SHARED / "corpus-x3d").rglob("*.x3d"))[::3]):
        if path.stat().st_size > 200_000:
            continue
        try:
            root = xml.etree.ElementTree.parse(path).getroot()
        except xml.etree.ElementTree.ParseError:
            continue
        files.append(tmp_path / ("%d.x3dj" % number))
        style = [{"indent": 2}, {"indent": 1, "separators": (",", ":")}, {}][number % 3]
        files[-1].write_text(json.dumps({root.tag: json_object(root)}, **style))
    tried, wrong = 0, {}
    for number, path in enumerate(files):
        problem = edit_one(path, number)
        if problem is None:
            continue
        tried += 1
        if problem:
            wrong[path.name] = problem
    assert tried > 20
    assert len(wrong) <= tried / 100, wrong
