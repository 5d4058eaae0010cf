"""Shared by the tests of the editor in vv's window: they skip without the editor, look at the file, and
click at pixels of the window."""
import re

import pytest


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


def press(w, x, y, button=1):
    """Clicks at a pixel of the window, where panels have their buttons."""
    w.tool("mousemove", "--window", w.id, x, y)
    w.tool("click", button)
