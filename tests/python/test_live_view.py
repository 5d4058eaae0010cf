"""Tests xvrml.LiveView: pictures of a running world while Python goes on, edits, the mouse and the
keys, callbacks of sensors, several views, errors. No clock of the machine decides about a result:
steps have times of their own, and pictures are waited for."""
import gc
import subprocess
import sys
import threading
import time
import weakref

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from live_view_tools import SIZE, WORLD, at, click, drag, key, steps  # noqa: E402


@pytest.fixture
def world():
    return xvrml.loads(WORLD)


@pytest.fixture
def view(world):
    with xvrml.LiveView(world, **SIZE) as view:
        view.wait()
        yield view


# Pictures ---------------------------------------------------------------------------------------


def test_a_still_picture_has_the_bytes_of_render(world):
    with xvrml.LiveView(world, **SIZE) as view:
        assert view.picture is None and view.look() is None and view.camera is None
        picture = view.wait()
        assert picture.dtype == np.uint8 and picture.shape == (48, 64, 3)
        assert np.array_equal(picture, world.render(**SIZE).display)
        facts = view.facts
        assert facts["finished"] and not facts["preview"] and facts["samples"] == 4
        assert facts["size"] == (64, 48) and facts["frame_rate"] == 0


def test_a_still_picture_after_motion_has_the_bytes_of_render(world):
    with xvrml.LiveView(world, **SIZE) as view:
        view.wait()
        world["Clock"].enabled = True
        shown = []
        steps(view, lambda: view.look() is not None and shown.append(1) or len(shown) > 5)
        world["Clock"].enabled = False
        world["Place"].translation = (1, 0, 0)
        assert np.array_equal(view.wait(), world.render(**SIZE).display)


def test_a_world_without_viewpoint_is_shown_as_render_shows_it():
    world = xvrml.loads(
        "#VRML V2.0 utf8\nShape { geometry Cone { } appearance Appearance { material Material { } } }"
    )
    with xvrml.LiveView(world, **SIZE) as view:
        assert np.array_equal(view.wait(), world.render(**SIZE).display)
        before = view.camera
        drag(view, (30, 20), (40, 20))
        view.wait()
        assert not np.allclose(view.camera, before)
        distance = lambda pose: np.linalg.norm(pose[:3, 3])
        assert distance(view.camera) == pytest.approx(distance(before), rel=1e-2)  # it turned


def test_the_arguments_of_render(world):
    place = ((3, 2, 8), (0, 0, 0))
    with xvrml.LiveView(world, camera=place, fov=30, headlight=False, seed=3, **SIZE) as view:
        same = world.render(camera=place, fov=30, headlight=False, seed=3, **SIZE)
        assert np.array_equal(view.wait(), same.display)
        assert view.camera == pytest.approx(same.camera.pose @ np.diag([1, -1, -1, 1]))


def test_pictures_arrive_while_something_moves(world, view):
    world["Clock"].enabled = True
    columns = set()

    def seen():
        picture = view.look()
        if picture is not None and view.facts["finished"]:
            columns.add(round(np.nonzero(picture[..., 0] > 128)[1].mean() / picture.shape[1], 2))
        return len(columns) >= 5

    steps(view, seen)
    assert view.facts["frame_rate"] > 0 and world.time > 0


def test_resize(view):
    view.event({"type": "resize", "width": 20, "height": 15, "ratio": 2})
    assert view.wait().shape == (30, 40, 3)
    view.resize(16, 12)
    assert view.wait().shape == (12, 16, 3)
    for size in ((0, 5), (70000, 1), (65536, 65536)):
        with pytest.raises(ValueError, match="size"):
            view.resize(*size)


def test_render_beside_a_view(world, view):
    """world.render() takes the renderer; the view makes another one and misses no change."""
    before = view.picture
    world["Place"].translation = (1, 0, 0)
    image = world.render(**SIZE)
    assert np.array_equal(view.wait(), image.display) and not np.array_equal(before, image.display)


# Edits and time -----------------------------------------------------------------------------------


def test_an_edit_is_seen_and_wakes_the_view(world, view):
    before, woken = view.picture, []
    view.on_wake = lambda: woken.append(1)
    world["Place"].translation = (1, 1, 0)
    assert woken
    assert not np.array_equal(view.wait(), before)
    woken.clear()
    world.add(xvrml.PointLight())
    assert woken


def test_the_clock(world, view):
    start = world.time
    at(view, 100)
    at(view, 100.1)
    assert world.time == pytest.approx(start + 0.1)
    at(view, 1000)  # a cell that took long is no jump
    assert world.time == pytest.approx(start + 0.35)
    view.paused = True
    at(view, 1000.1)
    assert world.time == pytest.approx(start + 0.35) and view.paused
    view.paused = False
    at(view, 1000.2)
    assert world.time == pytest.approx(start + 0.45)
    world.time = 50  # the program may set the time as always
    at(view, 1000.3)
    assert world.time == pytest.approx(50.1)


def test_nothing_happens_while_nobody_looks(world, view):
    view.visible = False
    view.step(100)
    start = world.time
    assert view.step(100.2) is None and world.time == start
    world["Place"].translation = (1, 0, 0)
    before = view.picture
    for now in range(101, 110):
        assert view.step(now) is None
    assert view.picture is before
    view.visible = True
    assert not np.array_equal(view.wait(), before)


def test_idle_steps_are_rare(view):
    assert view.step() >= 0.1 and view.is_finished
    view.paused = True
    assert view.step() is None


# The mouse and the keys ---------------------------------------------------------------------------


def test_a_sensor_calls_back(world, view):
    heard = []
    world.on("Touch.touchTime", lambda value, now: heard.append(("touched", threading.get_ident())))
    world.on("Touch.isOver", lambda value, now: heard.append(value))
    click(view, 32, 24)
    steps(view, lambda: len(heard) >= 2)
    assert heard == [True, ("touched", threading.get_ident())]
    before = view.camera
    view.event({"type": "pointer_leave"})
    steps(view, lambda: heard[-1] is False)
    assert np.array_equal(view.camera, before)  # a click on a sensor does not move the viewer


def test_a_callback_may_change_and_render_the_world(world, view):
    pictures = []

    @world.on("Touch.touchTime")
    def touched(value, now):
        world["Paint"].emissiveColor = (1, 0, 0)
        pictures.append(world.render(**SIZE).display)
        view.step()  # does nothing: the step is under way

    click(view, 32, 24)
    steps(view, lambda: pictures)
    assert np.array_equal(view.wait(), pictures[0]) and view.picture[24, 32, 1] < 255


def test_the_exception_of_a_callback_is_raised_by_the_step(world, view):

    def fail(value, now):
        raise KeyError("mine")

    world.on("Touch.touchTime", fail)
    before = view.picture
    click(view, 32, 24)
    with pytest.raises(KeyError, match="mine"):
        steps(view, lambda: False)
    world["Place"].translation = (1, 1, 0)
    assert not np.array_equal(view.wait(), before)  # the view goes on


@pytest.mark.parametrize("button, modifiers", [(1, ()), (2, ()), (1, ("Shift",)), (3, ()),
                                               (1, ("Control",))])
def test_drags_in_examine(view, button, modifiers):
    before = view.camera
    key(view, "1")
    drag(view, (4, 4), (20, 4 if button == 1 and not modifiers else 12), button, modifiers)
    view.wait()
    turned = not np.allclose(view.camera[:3, :3], before[:3, :3])
    assert turned == (button == 1 and not modifiers)
    assert not np.allclose(view.camera[:3, 3], before[:3, 3])


def test_a_drag_in_walk_goes_on_while_it_is_held(view):
    key(view, "3")
    before = view.camera
    view.event({"type": "pointer_down", "x": 4, "y": 24, "button": 1, "modifiers": ()})
    view.event({"type": "pointer_move", "x": 4, "y": 12, "button": 1, "modifiers": ()})
    at(view, 10)
    at(view, 10.2)
    near = view.camera[2, 3]
    at(view, 10.4)
    assert before[2, 3] > near > view.camera[2, 3]
    view.event({"type": "pointer_up", "x": 4, "y": 12, "button": 1, "modifiers": ()})
    at(view, 10.4)
    there = view.camera
    at(view, 10.6)
    assert np.array_equal(view.camera, there)


def test_keys(view, world):
    before = view.camera
    view.event({"type": "key_down", "key": "ArrowUp", "modifiers": ()})
    at(view, 10)
    at(view, 10.2)
    ahead = view.camera
    assert ahead[2, 3] < before[2, 3]
    view.event({"type": "key_up", "key": "ArrowUp", "modifiers": ()})
    at(view, 10.2)
    key(view, "Backspace")
    at(view, 10.2)
    assert view.camera == pytest.approx(before)
    key(view, "PageDown")
    at(view, 10.2)
    assert view.camera[:3, 3] == pytest.approx([8, 0, 0])
    key(view, "Home")
    at(view, 10.2)
    assert view.camera == pytest.approx(before)
    key(view, "f")  # frame all comes nearer
    at(view, 10.2)
    assert view.camera[2, 3] < 6
    key(view, "p")
    at(view, 10.2)
    assert view.paused
    view.event({"type": "wheel", "dx": 0, "dy": 300})
    farther = view.camera[2, 3]
    at(view, 10.2)
    assert view.camera[2, 3] > farther


@pytest.mark.parametrize("event, said", [
    ({
        "type": "pointer_move",
        "x": float("nan"),
        "y": 0
    }, "x: a number"),
    ({
        "type": "pointer_move",
        "x": "1",
        "y": 0
    }, "x: a number"),
    ({
        "type": "pointer_move",
        "x": 1
    }, "y: a number"),
    ({
        "type": "wheel",
        "dy": None
    }, "dy: a number"),
    ({
        "type": "resize",
        "width": 1e300,
        "height": 1,
        "ratio": 1
    }, "size"),
    ({
        "type": "resize",
        "width": 5,
        "height": 5,
        "ratio": "x"
    }, "ratio"),
])
def test_wrong_events_say_so(view, event, said):
    with pytest.raises(ValueError, match=said):
        view.event(event)
        view.step()
    view.wait()


def test_events_that_mean_nothing_are_left_alone(view):
    before = view.camera
    for event in ({
            "type": "char",
            "data": "x"
    }, {
            "type": "key_down",
            "key": None
    }, {
            "type": 5
    }, {}, {
            "type": "pointer_up",
            "x": 1e308,
            "y": -1e308,
            "button": 77
    }):
        view.event(event)
    view.wait()
    assert np.array_equal(view.camera, before)
    with pytest.raises(TypeError, match="dict"):
        view.event("click")


# Several views ------------------------------------------------------------------------------------


def test_two_views_of_a_world(world):
    with xvrml.LiveView(world, **SIZE) as one, xvrml.LiveView(world, size=(32, 24), spp=2) as two:
        assert one.wait().shape == (48, 64, 3) and two.wait().shape == (24, 32, 3)
        front = one.camera
        two.event({"type": "wheel", "dy": -300})
        two.wait()
        one.wait()
        assert np.array_equal(one.camera, front) and not np.allclose(two.camera, front)
        near = two.camera
        key(one, "PageDown")  # each view keeps its place while the other one is used
        one.wait()
        two.wait()
        assert one.camera[:3, 3] == pytest.approx([8, 0, 0]) and np.allclose(two.camera, near)
        before = one.picture, two.picture
        world["Paint"].emissiveColor = (1, 0, 0)
        assert not np.array_equal(one.wait(), before[0])  # both show the edit
        assert not np.array_equal(two.wait(), before[1])
        start = world.time
        now = time.monotonic() + 100
        for reading in (now, now + 0.1):  # one clock
            at(one, reading)
            at(two, reading)
        assert world.time - start == pytest.approx(0.35)
        two.close()
        world["Place"].translation = (0, 0, 0)
        one.wait()
        assert one.is_open and not two.is_open


def test_a_view_from_a_viewpoint(world):
    with xvrml.LiveView(world, **SIZE) as front, xvrml.LiveView(world, viewpoint="side",
                                                                **SIZE) as side:
        side.wait()
        assert np.array_equal(side.picture, world.render(viewpoint="Side", **SIZE).display)
        assert side.camera[:3, 3] == pytest.approx([8, 0, 0])
        front.wait()
    for wrong in ("nowhere", 2):
        with pytest.raises((KeyError, IndexError), match="viewpoint"):
            xvrml.LiveView(world, viewpoint=wrong, **SIZE)


def test_views_of_a_world_have_the_same_options(world, view):
    with pytest.raises(ValueError, match="same options"):
        xvrml.LiveView(world, transport="path", **SIZE)
    view.close()
    with xvrml.LiveView(world, transport="path", **SIZE) as other:
        other.wait()


# The end ------------------------------------------------------------------------------------------


def test_closing_while_a_frame_is_rendered(world):
    view = xvrml.LiveView(world, size=(400, 300), spp=65536)
    steps(view, lambda: view.facts.get("size") == (400, 300) and not view.facts["finished"])
    view.close()
    view.close()
    assert not view.is_open and view.step() is None and "closed" in repr(view)
    view.event({"type": "pointer_move", "x": 1, "y": 1})
    with pytest.raises(TimeoutError, match="closed"):
        view.wait()
    world["Place"].translation = (1, 0, 0)  # the world goes on
    assert world.render(**SIZE).array.shape == (48, 64, 4)


def test_a_view_ends_with_its_last_name():
    world = xvrml.loads(WORLD)
    watcher = weakref.ref(world)
    view = xvrml.LiveView(world, **SIZE)
    view.wait()
    del world
    gc.collect()
    assert watcher() is view.world  # a view keeps its world
    del view
    gc.collect()
    assert watcher() is None


def test_a_program_may_end_while_a_view_renders(tmp_path):
    (tmp_path / "world.wrl").write_text(WORLD)
    code = ("import time, xvrml\n"
            "view = xvrml.LiveView(xvrml.load('world.wrl'), size=(400, 300), spp=65536)\n"
            "while view.picture is None or view.facts['size'] != (400, 300):\n"
            "    view.step()\n"
            "    time.sleep(0.001)\n"
            "print('shown')\n")
    done = subprocess.run([sys.executable, "-c", code],
                          cwd=tmp_path,
                          capture_output=True,
                          text=True,
                          timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "shown\n", "")


def test_other_threads_may_edit(world, view):
    errors = []

    def work():
        try:
            for i in range(200):
                world["Place"].translation = (i / 100 - 1, 0, 0)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    steps(view, lambda: not any(thread.is_alive() for thread in threads))
    for thread in threads:
        thread.join()
    assert errors == []
    assert np.array_equal(view.wait(), world.render(**SIZE).display)


def test_another_world_takes_the_place():
    browser = xvrml.Browser(WORLD.encode())
    with xvrml.LiveView(browser, **SIZE) as view:
        before = view.wait()
        key(view, "PageDown")
        view.wait()
        browser.replace_world(
            browser.create_vrml_from_string(
                "Viewpoint { position 0 0 4 } Shape { geometry Sphere { } appearance Appearance { material Material { } } }"
            ))
        after = view.wait()
        assert not np.array_equal(before, after)
        assert np.array_equal(after, browser.render(**SIZE).display)
        assert view.camera[:3, 3] == pytest.approx([0, 0, 4])


def test_wrong_arguments(world):
    for options, said in ((dict(sice=(1, 2)), "did you mean size"), (dict(size=(0, 1)), "size"),
                          (dict(channels="z"), "channels"), (dict(spp=0), "spp"),
                          (dict(camera=xvrml.Pinhole(np.eye(3))), "Pinhole")):
        with pytest.raises((TypeError, ValueError), match=said):
            xvrml.LiveView(world, **options)
    with pytest.raises(TypeError, match="World"):
        xvrml.LiveView("world.wrl")


# Scripts ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("program", [
    "javascript: function turn() { while (true); }",
    "tcl: proc turn {v t} { while 1 {} }",
])
@pytest.mark.timed
def test_a_script_that_never_ends_leaves_the_view_alone(program):
    """A call of a Script may take two seconds before it is stopped; the steps of a view do not wait
    for that."""
    world = xvrml.loads(
        WORLD.replace("enabled FALSE", "") + """
DEF S Script { eventIn SFFloat turn url "%s" } ROUTE Clock.fraction_changed TO S.turn""" % program)
    if any("engine" in str(one) for one in world.warnings):
        pytest.skip("the engine is not built")
    with xvrml.LiveView(world, **SIZE) as view:
        pictures, longest, end = 0, 0.0, time.monotonic() + 60
        while pictures < 12:
            began = time.monotonic()
            view.step()
            longest = max(longest, time.monotonic() - began)
            pictures += view.look() is not None
            time.sleep(0.005)
            assert time.monotonic() < end
        assert longest < 1  # also on a busy machine
