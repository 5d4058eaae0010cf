"""Shared by the tests of the editor in vv's window: they skip without the editor, look at the file, and
click at pixels of the window."""
import re

import pytest

from window_driver import framebuffer


def skip_without_editor(vv):
    if re.search(r"^edit +no", vv("--list-features").text, re.M):
        pytest.skip("vv is built without the editor")


@pytest.fixture(autouse=True)
def needs_the_editor(vv):
    skip_without_editor(vv)


def text(vv):
    return (vv.folder / "world.wrl").read_text()


def changed(w, vv, test):
    """Returns the text once the file has changed in this way."""
    w.wait(lambda: test(text(vv)), "the file")
    return text(vv)


def saved(w, vv, test):
    """Saves until the file has changed in this way: what was asked for may still have to be done."""

    def tried():
        w.key("ctrl+s")
        return test(text(vv))

    w.wait(tried, "the file")
    return text(vv)


def until_sheet(w, screen, width):
    """Waits until the right panel of a window of this width shows a node, before it is clicked at."""
    place = w.tool("getwindowgeometry", "--shell", w.id)
    left, top = [int(re.search(rf"{n}=(-?\d+)", place)[1]) for n in ("X", "Y")]

    def shown():
        rows = framebuffer(screen[1])[top + 50:top + 75]
        return any(min(p) > 150 for row in rows for p in row[left + width - 160:left + width])

    w.wait(shown, "the fields of a node")


def press(w, x, y, button=1):
    """Clicks at a pixel of the window, where panels have their buttons."""
    w.tool("mousemove", "--window", w.id, x, y)
    w.tool("click", button)
