"""Tests xvrml.notebook.View, the widget of jupyter_rfb, without a page: what the page would send is handed to
the widget, and what it sends is kept. Also the message where jupyter_rfb is missing, and the
notebook in examples/notebook. tests/python/test_jupyterlab.py has a page."""
import asyncio
import io
import json
import pathlib
import re
import subprocess
import sys
import time

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from live_view_tools import WORLD  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
needs_rfb = pytest.mark.skipif(not hasattr(xvrml, "notebook"),
                               reason="jupyter_rfb is not installed")


def test_without_jupyter_rfb_there_is_one_message():
    code = ("import sys; sys.modules['jupyter_rfb'] = None; import xvrml\n"
            "assert not hasattr(xvrml, 'notebook')\n"
            "try: xvrml.World().view()\n"
            "except ModuleNotFoundError as error: print(error)\n")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stderr == "" and done.stdout == (
        "world.view() needs the package jupyter_rfb, which is not installed: pip install jupyter_rfb\n"
    )


class Page:
    """Stands for the page: keeps what the widget sends, confirms it, and sends events."""

    def __init__(self, view, visible=True):
        self.view, self.messages = view, []
        view.send = lambda message, buffers=None: self.messages.append((message, buffers))
        self.trait = "_has_visible_views" if view.has_trait(
            "_has_visible_views") else "has_visible_views"
        self.feedback = "_frame_feedback" if view.has_trait("_frame_feedback") else "frame_feedback"
        self.show(visible)
        self.event("resize", width=64, height=48, ratio=1, pwidth=64, pheight=48)

    def show(self, visible):
        setattr(self.view, self.trait, visible)

    def event(self, kind, **more):
        self.view._rfb_handle_msg(self.view, {
            "type": kind,
            "event_type": kind,
            "timestamp": 0,
            "modifiers": [],
            **more
        }, [])

    def click(self):
        for kind in ("pointer_move", "pointer_down", "pointer_up"):
            self.event(kind, x=32, y=24, button=1)

    async def until(self, condition, limit=60):
        end = time.monotonic() + limit
        while not condition():
            assert time.monotonic() < end, (self.view.live.facts, len(self.messages))
            await asyncio.sleep(0.005)
            setattr(self.view, self.feedback, {
                "index": self.view._rfb_frame_index,
                "timestamp": time.time(),
                "localtime": time.time()
            })

    async def finished(self):
        await self.until(lambda: self.view.live.is_finished and self.messages)
        count = len(self.messages)
        await self.until(
            lambda: len(self.messages) > count or "png" in self.messages[-1][0]["mimetype"]
        )  # jupyter_rfb sends the last picture again without loss


def on_page(test):
    """Runs a test with a world, its view and a page."""

    @needs_rfb
    def run():

        async def main():
            world = xvrml.loads(WORLD)
            view = world.view(size=(64, 48), spp=4)
            try:
                await test(world, view, Page(view))
            finally:
                view.close()

        asyncio.run(main())

    return run


@on_page
async def test_the_page_gets_pictures(world, view, page):
    await page.finished()
    image = pytest.importorskip("PIL.Image").open(io.BytesIO(page.messages[-1][1][0]))
    assert np.array_equal(np.asarray(image.convert("RGB")),
                          world.render(size=(64, 48), spp=4).display)
    assert np.array_equal(view.get_frame(), view.live.picture)


@on_page
async def test_an_edit_reaches_the_page(world, view, page):
    await page.finished()
    count, before = len(page.messages), view.live.picture
    world["Place"].translation = (1, 1, 0)
    await page.until(lambda: len(page.messages) > count)
    await page.finished()
    assert not np.array_equal(view.live.picture, before)


@on_page
async def test_an_idle_view_sends_nothing(world, view, page):
    await page.finished()
    await asyncio.sleep(0.5)  # jupyter_rfb's last picture, and the title
    count = len(page.messages)
    steps = []
    step = view.live.step
    view.live.step = lambda: steps.append(1) or step()
    await asyncio.sleep(0.5)
    assert len(page.messages) == count and len(steps) <= 7


@on_page
async def test_a_hidden_view_rests(world, view, page):
    world["Clock"].enabled = True
    await page.until(lambda: world.time > 0)
    page.show(False)
    await asyncio.sleep(0.05)
    start = world.time
    await asyncio.sleep(0.2)
    assert world.time == start and view._timer is None
    page.show(True)
    await page.until(lambda: world.time > start)


@on_page
async def test_sensors_call_back_and_exceptions_are_shown(world, view, page):
    heard, errors = [], []
    view._output_context.append_stderr = errors.append

    @world.on("Touch.touchTime")
    def touched(value, now):
        heard.append(value)
        raise KeyError("mine")

    page.click()
    await page.until(lambda: errors)
    assert len(heard) == 1 and "KeyError: 'mine'" in errors[0] and len(errors) == 1
    assert view.live.paused  # the world waits, so that an exception at every step is shown once
    view.live.paused = False
    start = world.time
    await page.until(lambda: world.time > start)


@on_page
async def test_a_cell_that_runs_shows_its_steps(world, view, page):
    await page.finished()
    count, end = len(page.messages), time.monotonic() + 60
    step = 0
    while len(page.messages) < count + 3:  # no `await`: the event loop waits for the cell
        assert time.monotonic() < end
        step += 1
        world["Place"].translation = (step % 100 / 50 - 1, 0, 0)
        view.update()
        time.sleep(0.005)


@on_page
async def test_the_end(world, view, page):
    await page.until(lambda: view.live.picture is not None)
    page.event("close")
    assert not view.live.is_open
    page.click()
    view.update()
    view.close()
    world["Place"].translation = (1, 0, 0)


@needs_rfb
def test_a_view_needs_no_event_loop():
    world = xvrml.loads(WORLD)
    view = world.view(size=(64, 48), spp=4)
    page = Page(view)
    end = time.monotonic() + 60
    while not page.messages:
        assert time.monotonic() < end
        view.update()
        time.sleep(0.005)
    view.close()


# The small picture of a world -----------------------------------------------------------------------


def test_a_world_has_a_small_picture_until_it_changes():
    world = xvrml.loads(WORLD)
    png = world._repr_png_()
    assert png.startswith(b"\x89PNG") and len(png) < 200_000
    assert world._repr_png_() is png
    world["Place"].translation = (1, 0, 0)
    moved = world._repr_png_()
    assert moved != png
    world["Clock"].enabled = True
    world.time = 0.5
    assert world._repr_png_() != moved
    assert xvrml.Browser(WORLD.encode())._repr_png_().startswith(b"\x89PNG")


def test_an_empty_world_has_a_small_picture_too():
    assert xvrml.World()._repr_png_().startswith(b"\x89PNG")


# The example ----------------------------------------------------------------------------------------


def cells():
    notebook = json.loads((ROOT / "examples/notebook/live.ipynb").read_text())
    assert notebook["nbformat"] == 4
    return ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]


@needs_rfb
def test_the_notebook_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT / "examples/notebook")
    names = {}

    async def main():
        for cell in cells():
            exec(compile(cell, "live.ipynb", "exec"), names)
        page = Page(names["view"])
        await page.until(lambda: len(page.messages) > 3)
        names["view"].close()

    asyncio.run(main())
    assert len(cells()) >= 4


def test_the_notebook_has_no_output():
    notebook = json.loads((ROOT / "examples/notebook/live.ipynb").read_text())
    assert all(cell.get("outputs", []) == [] for cell in notebook["cells"])
    assert not re.search(r"/(home|tmp|work)/", json.dumps(notebook))
