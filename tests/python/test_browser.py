"""Tests the Python class Browser: time, events, callbacks, routes, the pointer, pictures of a
running world; node plug-ins."""
import gc
import threading
import weakref

import pytest
from conftest import find_vv

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

MOVING = b"""#VRML V2.0 utf8
DEF View Viewpoint { position 0 0 8 }
DEF Side Viewpoint { position 8 0 0 orientation 0 1 0 1.5708 description "side" }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Way PositionInterpolator { key [0, 1] keyValue [-2 0 0, 2 0 0] }
DEF Place Transform { children [
  DEF Touch TouchSensor { }
  Shape { appearance Appearance { material DEF Paint Material { emissiveColor 1 1 1 } } geometry DEF Cube Box { size 1 1 1 } } ] }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
"""
SMALL = dict(size=(32, 24), spp=1)


@pytest.fixture
def browser():
    return xvrml.Browser(MOVING)


def centre(picture):
    return np.nonzero(picture.display[..., 0] > 200)[1].mean()


def test_time_is_an_argument(browser):
    assert browser.now == 0
    browser.tick(0.5)
    assert browser.now == 0.5
    assert browser["Place"].translation == pytest.approx((-1, 0, 0))
    with pytest.raises(ValueError, match="0.5"):
        browser.tick(0.25)
    with pytest.raises(ValueError):
        browser.tick(float("nan"))


def test_a_moment_is_told_once():
    w = xvrml.loads(
        "DEF T TimeSensor { loop TRUE cycleInterval 4 } DEF S TimeSensor { loop TRUE cycleInterval 4 }"
        .join(("#VRML V2.0 utf8\n", "\n")))
    heard = []
    for event in ("T.fraction_changed", "T.time", "T.isActive", "S.fraction_changed"):
        w.on(event, lambda value, time, event=event: heard.append((event, value)))
    w.time = 0.5
    assert [e for e, _ in heard].count("T.fraction_changed") == 1
    heard.clear()
    w["T"].loop = False
    w.time = 0.5
    assert heard == []
    w["T"].enabled = False  # the sensor stops at the same time
    assert [e for e, _ in heard] == ["T.fraction_changed", "T.time", "T.isActive"
                                    ] and heard[-1][1] is False
    heard.clear()
    w["T"].enabled = True  # and starts again
    w.time = 1
    assert ("S.fraction_changed", 0.25) in heard


def test_a_browser_is_a_world(browser):
    assert isinstance(browser, xvrml.World)
    assert "Clock" in browser and set(browser.names) >= {"Clock", "Place"}
    assert browser.node("Nobody") is None and browser.node("Cube") == browser["Cube"]
    assert "TimeSensor" in browser.to_vrml() and browser.warnings == []


def test_event_outs_hold_what_was_sent(browser):
    browser.tick(0.5)
    assert browser["Clock"].fraction_changed == pytest.approx(0.25)
    assert browser["Clock"].isActive is True
    with pytest.raises(AttributeError, match="fraction_changed"):
        browser["Clock"].fraction_change


def test_assigning_sends_an_event(browser):
    heard = []
    browser.listen(browser["Way"], "value_changed", lambda value, now: heard.append((value, now)))
    browser["Way"].set_fraction = 0.75
    assert heard == [((1.0, 0.0, 0.0), 0.0)]
    assert browser["Place"].translation == (1, 0, 0)
    with pytest.raises(TypeError):
        browser["Way"].set_fraction = "half"


def test_listen_and_unlisten(browser):
    heard = []
    number = browser.listen(browser["Place"], "translation", lambda value, now: heard.append(value))
    browser.tick(0.5)
    assert len(heard) == 1
    browser.unlisten(browser["Place"], number)
    browser.tick(1)
    assert len(heard) == 1
    with pytest.raises(AttributeError, match="translation"):
        browser.listen(browser["Place"], "translatoin", print)


def test_an_exception_of_a_callback_is_raised_by_the_call(browser):

    def fail(value, now):
        raise KeyError("mine")

    number = browser.listen(browser["Place"], "translation", fail)
    with pytest.raises(KeyError, match="mine"):
        browser.tick(0.5)
    assert browser["Place"].translation == pytest.approx((-1, 0, 0))  # events are still handled
    with pytest.raises(KeyError):
        browser["Place"].translation = (0, 0, 0)
    browser.unlisten(browser["Place"], number)
    browser.tick(1)


def test_a_callback_may_change_the_world_and_render(browser):
    told = []

    def react(value, now):
        browser["Paint"].transparency = 0.5
        told.append(browser["Clock"].fraction_changed)
        browser.render(**SMALL)

    browser.listen(browser["Place"], "translation", react)
    browser.tick(0.5)
    assert browser["Paint"].transparency == 0.5 and told == [pytest.approx(0.25)]


def test_routes(browser):
    clock, cube = browser["Clock"], browser["Paint"]
    assert browser.add_route(clock, "fraction_changed", cube, "transparency")
    browser.tick(1)
    assert cube.transparency == pytest.approx(0.5)
    assert browser.delete_route(clock, "fraction_changed", cube, "transparency")
    assert not browser.delete_route(clock, "fraction_changed", cube, "transparency")
    browser.tick(1.5)
    assert cube.transparency == pytest.approx(0.5)
    with pytest.raises(TypeError, match="SFFloat.*SFVec3f"):
        browser.add_route(clock, "fraction_changed", browser["Place"], "translation")
    with pytest.raises(AttributeError, match="did you mean fraction_changed"):
        browser.add_route(clock, "fraction_change", cube, "transparency")


def test_nodes_of_another_world_are_refused(browser):
    other = xvrml.Browser(MOVING)
    with pytest.raises(ValueError, match="this world"):
        browser.add_route(other["Clock"], "fraction_changed", browser["Paint"], "transparency")
    with pytest.raises(ValueError):
        browser["Place"].children = [other["Place"]]


def test_nodes_are_made_and_put_into_the_world(browser):
    ball = browser.create_node("Sphere", radius=0.5)
    place = browser.create_node("Transform",
                                translation=(0, 2, 0),
                                children=[browser.create_node("Shape", geometry=ball)])
    before = browser.render(**SMALL).array.copy()
    browser.add_root(place)
    after = browser.render(**SMALL).array.copy()
    assert not np.array_equal(before, after)
    browser.remove_root(place)
    assert np.array_equal(browser.render(**SMALL).array, before)
    with pytest.raises(ValueError, match="did you mean Sphere"):
        browser.create_node("Spere")


def test_nodes_come_from_text(browser):
    made = browser.create_vrml_from_string("Shape { geometry Cone { } } DEF X Group { }")
    assert [node.node_type for node in made] == ["Shape", "Group"]
    browser["Place"].children = [*browser["Place"].children, made[0]]
    assert len(browser["Place"].children) == 3
    assert browser.create_vrml_from_string("Nothing { }") == ()
    assert "Nothing" in str(browser.warnings[-1])


def test_another_world_takes_the_place(browser, tmp_path):
    before, generation = browser.render(**SMALL).array.copy(), browser.generation
    (tmp_path / "other.wrl").write_text(
        "#VRML V2.0 utf8\nViewpoint { position 0 0 5 } DEF New Shape { geometry Sphere { } }")
    old = browser["Place"]
    here = xvrml.Browser(tmp_path / "other.wrl")
    here.load_url(["missing.wrl", "other.wrl#New"])
    browser.replace_world(
        browser.create_vrml_from_string(
            "Viewpoint { position 0 0 4 } Shape { geometry Sphere { } }"))
    assert browser.generation == generation + 1
    assert not np.array_equal(browser.render(**SMALL).array, before)
    assert old.translation == (0, 0, 0)
    browser.tick(1)


def test_pictures_follow_the_world(browser):
    columns = []
    for time in (0, 0.5, 1, 1.5):
        browser.tick(time)
        columns.append(centre(browser.render(**SMALL)))
    assert columns == sorted(columns) and columns[0] < columns[-1]
    fresh = xvrml.Browser(MOVING)
    for time in (0, 0.5, 1, 1.5):
        fresh.tick(time)
    # The same, whether kept from picture to picture or made from scratch.
    assert np.array_equal(fresh.render(**SMALL).array, browser.render(**SMALL).array)


def test_the_viewer(browser):
    assert browser.bound["viewpoint"] == browser["View"] and browser.bound["fog"] is None
    assert browser.camera()[:3, 3] == pytest.approx([0, 0, 8])
    assert browser.bind_viewpoint("side") and not browser.bind_viewpoint("nowhere")
    assert browser.bound["viewpoint"] == browser["Side"]
    assert browser.camera()[:3, 3] == pytest.approx([8, 0, 0])
    browser.bind_viewpoint("View")
    front = browser.render(**SMALL).array.copy()
    browser.navigation = "fly"
    assert browser.navigation == "fly"
    browser.navigate(4.0, ahead=1.0)
    assert browser.camera()[2, 3] == pytest.approx(4)
    assert not np.array_equal(browser.render(**SMALL).array, front)
    with pytest.raises(ValueError, match="examine"):
        browser.navigation = "swim"
    with pytest.raises(ValueError, match="page_up"):
        browser.key("return", True)


def test_keys_for_the_world():
    browser = xvrml.Browser(b"#X3D V3.3 utf8\nPROFILE Immersive\nDEF T StringSensor { }\n")
    assert browser.senses_keys
    assert browser.type_text("h\u00fc!\n") and browser.press_key("x") and browser.press_key("x", False)
    assert not browser.press_key("no key")
    text = browser.node("T")
    assert (text.finalText, text.enteredText) == ("h\u00fc!", "x")
    text.enabled = False
    assert not browser.senses_keys and not browser.type_text("x")


def test_the_pointer(browser):
    heard = []
    for event in ("isOver", "isActive", "touchTime", "hitPoint_changed"):
        browser.listen(browser["Touch"],
                       event,
                       lambda value, now, event=event: heard.append((event, value)))
    browser["Clock"].enabled = False
    browser["Place"].translation = (0, 0, 0)
    browser.tick(1)
    browser.pointer(0, 0, False)
    assert ("isOver", True) in heard and browser.sensors_at_pointer == (browser["Touch"],)
    browser.pointer(0, 0, True)
    browser.pointer(0, 0, False)
    assert ("touchTime", browser.epoch + 1.0) in heard
    browser.pointer_leave()
    assert heard[-1] == ("isOver", False)
    hit = browser.pick((0, 0, 8), (0, 0, -1))
    assert hit["distance"] == pytest.approx(7.5) and hit["normal"] == pytest.approx((0, 0, 1))
    assert hit["path"][0] == browser["Place"] and browser.pick((0, 0, 8), (0, 0, 1)) is None


def test_nodes_keep_the_browser_alive():
    node = xvrml.Browser(MOVING)["Place"]
    gc.collect()
    assert node.translation == (0, 0, 0)
    node.translation = (1, 2, 3)
    assert node.translation == (1, 2, 3)


def test_a_browser_ends_with_its_last_name():

    class Heard:

        def __call__(self, value, now):
            pass

    heard = Heard()
    watcher = weakref.ref(heard)
    browser = xvrml.Browser(MOVING)
    browser.listen(browser["Place"], "translation", heard)
    browser.render(**SMALL)
    del heard
    assert watcher() is not None
    del browser
    gc.collect()
    assert watcher() is None


def test_threads_take_turns(browser):
    errors = []

    def work():
        try:
            for i in range(200):
                browser["Place"].scale = (1, 1, 1 + i)
                assert browser["Place"].scale[2] >= 1
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for i in range(1, 50):
        browser.tick(i / 10)
    for thread in threads:
        thread.join()
    assert errors == []


def test_sources(tmp_path):
    (tmp_path / "moving.wrl").write_bytes(MOVING)
    assert xvrml.Browser(tmp_path / "moving.wrl", start=100).now == 100
    with pytest.raises(OSError):
        xvrml.Browser(tmp_path / "missing.wrl")
    with pytest.raises(xvrml.ParseError):
        xvrml.Browser(b"nothing")


# Node plug-ins ----------------------------------------------------------------------------------

PLUGINS = find_vv().parent.parent / "examples/nodes"


@pytest.mark.skipif(not (PLUGINS / "springs.so").exists(),
                    reason="the example plug-in is not built")
def test_plugin_nodes_are_like_built_in_ones():
    assert xvrml.load_node_plugins(PLUGINS) == [] == xvrml.load_node_plugins(str(PLUGINS))
    browser = xvrml.Browser(
        b"#VRML V2.0 utf8\nViewpoint { position 0 2 9 }\nDEF S Shape { appearance Appearance { material Material {"
        b" emissiveColor 1 1 1 } } geometry DEF Coil Spring { turns 3 } } DEF Count Counter { }")
    coil, count = browser["Coil"], browser["Count"]
    assert coil.node_type == "Spring" and coil.turns == 3 and coil.fields["height"] == "SFFloat"
    low = browser.render(**SMALL).display.sum()
    coil.height = 4
    assert browser.render(**SMALL).display.sum() > low
    with pytest.raises(ValueError):
        coil.turns = 0
    told = []
    browser.listen(count, "value_changed", lambda value, now: told.append(value))
    count.count = 5.0
    count.count = 6.0
    assert count.value == 2 and told == [1, 2]
    other = browser.create_node("Spring", turns=1)
    browser["S"].geometry = other
    assert browser["S"].geometry == other and "turns 1" in browser.to_vrml()
