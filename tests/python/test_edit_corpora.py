"""Tests that edits of real files by others change the edited value alone, and keep all comments."""
import collections
import json
import pathlib
import random
import re
import xml.etree.ElementTree

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

SHARED = pathlib.Path(__file__).resolve().parents[2].parent / "shared"


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


def lists_of(world, least=9):
    """Returns the nodes and fields of long lists of numbers, in a fixed order."""
    seen, found, open_ = set(), [], list(world.roots)
    while open_:
        node = open_.pop(0)
        if node is None or node in seen:
            continue
        seen.add(node)
        for name, kind in node.fields.items():
            if kind in ("SFNode", "MFNode"):
                value = getattr(node, name)
                open_.extend([value] if kind == "SFNode" else value)
            elif kind in ("MFVec2f", "MFVec3f", "MFColor", "MFFloat", "MFInt32"):
                if len(getattr(node, name)) >= least:
                    found.append((node, name))
    return found


def comments_of(path, text):
    if path.suffix.lower() in (".x3d", ".x3dz"):
        return re.findall("<!--.*?-->", text, re.S)
    return re.findall("#[^\n\r]*", text)


def edit_lists(path, seed):
    """Changes a list of a file in three places. Returns what is wrong; None if it has none."""
    random_ = random.Random(seed)
    try:
        world = xvrml.load(path)
    except (xvrml.ParseError, OSError):
        return None
    if world.edit.read_only:
        return None
    choices = lists_of(world)
    random_.shuffle(choices)
    for node, name in choices[:5]:
        before = world.edit.text()
        values = np.array(getattr(node, name))
        third = len(values) // 3
        gone, other, new = (random_.randrange(third) + i * third for i in range(3))
        changed = values.copy()
        changed[other] = values[0] if (values[other] != values[0]).any() else values[gone]
        changed = np.insert(changed, new, values[new], axis=0)
        changed = np.delete(changed, gone, axis=0)
        try:
            world.edit.set(node, name, changed)
        except xvrml.EditError:
            continue
        try:
            after = world.edit.text()
        except xvrml.EditError as error:
            return str(error)
        if comments_of(path, before) != comments_of(path, after):
            return "comments have changed"
        lost = collections.Counter(before.splitlines()) - collections.Counter(after.splitlines())
        if sum(lost.values()) > 4:
            return "%d lines have changed" % sum(lost.values())
        world.edit.undo()
        return "" if world.edit.text() == before else "undo gives another text"
    return None


@pytest.mark.parametrize("corpus, suffixes, step",
                         [("corpus", (".wrl", ".wrz", ".x3dv"), 8), ("corpus-x3d", (".x3d", ".x3dz"), 4)])
def test_lists_of_real_files_change_element_by_element(corpus, suffixes, step):
    if not (SHARED / corpus).is_dir():
        pytest.skip("the corpus is not here")
    files = sorted(p for p in (SHARED / corpus).rglob("*")
                   if p.suffix.lower() in suffixes and p.stat().st_size < 300_000)
    results = {path.name: edit_lists(path, number) for number, path in enumerate(files[::step])}
    wrong = {name: problem for name, problem in results.items() if problem}
    tried = sum(problem is not None for problem in results.values())
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
