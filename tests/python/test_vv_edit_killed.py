"""Kills vv at twenty random moments (SIGKILL) while it edits and saves: by a program, on a page and in its
window. The file is always whole, and the edits of at most five seconds are lost."""
import concurrent.futures
import contextlib
import random
import re
import threading
import time

import pytest

from conftest import HEADER
from control_server import SMALL, Server, module
from editor_window import skip_without_editor
from page_client import Served
from serve_edit_tools import select
from window_driver import Window, screen  # noqa: F401

MOST_LOST = 5  # seconds
LONGEST = 2.6  # seconds until vv is killed: the journal is written at once, and then every two seconds
WORLD = HEADER + """# The hall
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DEF THING Transform { translation 0 0 0 # moved by hand
  children Shape { geometry Box { size 2 2 2 } } }
"""


def moved(x):
    return WORLD.replace("translation 0 0 0", f"translation {x:g} 0 0")


def place(text):
    return float(re.search(r"translation (\S+) 0 0", text)[1])


class Killed:
    """A session that is killed after a while. edit(x) moves the thing to x, save() saves."""

    def __init__(self, folder, seed):
        folder.mkdir()
        self.file = folder / "hall.wrl"
        self.file.write_text(WORLD)
        self.random = random.Random(seed)

    def work(self, program, edit, save):
        """Edits, and saves now and then, until vv is killed."""
        killer = threading.Timer(self.random.uniform(0, LONGEST), program.kill)
        killer.start()
        done, saved = [], 0  # done: time and value of each edit
        with contextlib.suppress(ConnectionError, OSError):
            for i in range(1, 10_000):
                edit(i)
                if program.poll() is not None:
                    break
                done.append((time.monotonic(), i))
                if self.random.random() < .05:
                    save()
                    saved += 1
        program.wait(20)
        self.check(done, saved, time.monotonic())

    def check(self, done, saved, end):
        now = self.file.read_text()
        assert now == moved(place(now)) and (saved > 0 or now == WORLD), "the file is whole"
        server = Server(self.file.parent, self.file.name, *SMALL)
        try:
            vv = server.connect()
            if vv.edits()["recoverable"]:
                vv.recover()
            text = vv.edits(text=True)["text"]
            assert text == moved(place(text)), "all of an edit, or nothing"
            lost = [when for when, x in done if x > place(text) + 1e-6]
            assert not lost or end - lost[0] < MOST_LOST
            if vv.edits()["changed"]:
                vv.save()
        finally:
            server.end()
        assert self.file.read_text() == text
        # A save that is killed leaves its temporary file, and nothing else.
        names = {path.name for path in self.file.parent.iterdir()} - {"hall.wrl"}
        assert len(names) <= 1 and all(name.startswith(".vv-") for name in names)


def by_a_program(folder, seed):
    session = Killed(folder, seed)
    server = Server(folder, "hall.wrl", *SMALL)
    vv = server.connect()

    def edit(x):
        with vv.edit("Move") as step:
            step.set("THING", "translation", (x, 0, 0))

    session.work(server.program, edit, vv.save)
    vv.close()


def on_a_page(folder, seed):
    session = Killed(folder, seed)
    server = Served(folder, ["hall.wrl", "--port", 0, "--edit", "--spp", 1])
    page = server.join_editor(32, 24)
    number = select(page, "THING  Transform")["node"]

    def edit(x):
        page.edit("drag", node=number, field="translation", value=[x, 0, 0])
        page.edit("end_drag")
        time.sleep(.03)

    session.work(server.program, edit, lambda: page.edit("save"))
    page.close()
    server.program.stdout.close()


@pytest.mark.parametrize("face", [by_a_program, on_a_page])
def test_edits_of_programs_and_pages(vv, tmp_path, face):
    if face is on_a_page and "without libwebsockets" in vv("serve", "no.wrl").talk:
        pytest.skip("vv is built without libwebsockets")
    module()  # is loaded by one thread
    with concurrent.futures.ThreadPoolExecutor(4) as threads:
        for done in [threads.submit(face, tmp_path / str(seed), seed) for seed in range(8)]:
            done.result()


def test_edits_in_the_window(vv, screen, tmp_path):  # noqa: F811
    skip_without_editor(vv)
    for seed in range(4):
        session = Killed(tmp_path / str(seed), 100 + seed)
        w = Window(session.file.parent, screen[0], ["hall.wrl", "--size", "300x200", "--spp", 1])
        w.ready()
        w.key("e")
        w.tool("mousemove", "--window", w.id, 150, 100, "keydown", "ctrl", "click", 1, "keyup", "ctrl")
        step = ["g", "x", "1", "Return"]
        session.work(w.program, lambda x, w=w: w.key(*step), lambda w=w: w.key("ctrl+s"))
