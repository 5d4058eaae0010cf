"""Shared by the tests of the editor on the page of `vv serve --edit`: a world, and what a page with
the editor open does and waits for."""
from conftest import HEADER
from page_client import wait_for

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


def save(page):
    """Saves the world, once the page knows that something is unsaved."""
    history(page, unsaved=True)
    page.edit("save")
    history(page, unsaved=False)


def text_of(vv):
    return (vv.folder / "world.wrl").read_text()
