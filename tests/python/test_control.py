"""Tests the commands of vv --control without a window, by xvrml.control: values, events, nodes, time,
pictures, worlds."""
import signal
import subprocess
import threading

import pytest

from conftest import HEADER, find_vv, read_ppm
from control_server import PATIENCE, SMALL, module, refused, start, until  # noqa: F401

# --- Values ---


def test_get_and_set(start):
    vv = start().connect()
    assert vv.hello["program"] == "vv" and vv.hello["protocol"] == 1
    assert vv.get("Cube", "size") == [2, 2, 2]
    vv.set("Place", "translation", (1, 2.5, -3))
    assert vv.get("Place", "translation") == [1, 2.5, -3]
    vv.set("Place", "set_translation", [0, 0, 1e-3])
    assert vv.get("Place", "translation") == [0, 0, 0.001]
    vv.set("Paint", "diffuseColor", (0, 1, 0))
    thing, = vv.get("Place", "children")
    assert vv.get(thing, "geometry") == vv.node("Cube")["node"]
    vv.set("Sum", "url", ["javascript:"])
    assert vv.get("Sum", "url") == ["javascript:"]


def test_errors_say_where_and_what(start):
    vv = start().connect()
    refused("node", 'no node "Plase"; did you mean "Place"?', vv.get, "Plase", "translation")
    refused("node", "there is no node 77", vv.get, 77, "translation")
    refused("field", "did you mean translation?", vv.get, "Place", "translatoin")
    refused("field", "Script.left is an eventIn: it cannot be read", vv.get, "Sum", "left")
    refused("field", "Script.sum is an eventOut: it cannot be set", vv.set, "Sum", "sum", 1)
    refused("value", "not an array of 2", vv.set, "Place", "translation", (1, 2))
    refused("value", 'not "x" at value[1]', vv.set, "Place", "translation", (1, "x", 2))
    refused("value", "numbers in [0,1]", vv.set, "Paint", "transparency", 2)
    refused("value", "of 32 bits", vv.set, "Place", "translation", (1e39, 0, 0))
    refused("value", "not a Material", vv.set, "Place", "children", ["Paint"])
    refused("value", "would hold itself", vv.set, "Place", "children", ["Place"])
    refused("command", "no command \"gte\"; did you mean get?", vv.call, "gte")
    with pytest.raises(ValueError):
        vv.set("Place", "translation", (float("nan"), 0, 0))
    assert vv.get("Place", "translation") == [0, 0, 0]


def test_several_values_are_one_step(start):
    vv = start().connect()
    seen = []
    for field in ("sum", "stamp"):
        vv.subscribe("Sum", field, lambda value, time, f=field: seen.append((f, value)))

    def sums():
        return [value for field, value in seen if field == "sum"]

    vv.set_many([("Sum", "left", 3), ("Sum", "right", 4)])
    until(vv, sums)
    assert sums() == [7]
    # The route brings 5 after the last value, so the sum does not contain it.
    vv.set_many([("Blend", "set_fraction", .5), ("Sum", "right", 1)])
    until(vv, lambda: len(sums()) == 2)
    assert sums() == [7, 4]
    vv.set("Sum", "right", 1)
    until(vv, lambda: len(sums()) == 3)
    assert sums() == [7, 4, 6]


def test_a_step_with_an_error_changes_nothing(start):
    vv = start().connect()
    refused("value", "expected", vv.set_many, [("Place", "translation", (1, 1, 1)),
                                               ("Paint", "diffuseColor", "red")])
    refused("value", "twice", vv.set_many, [("Place", "translation", (1, 1, 1)),
                                            ("Place", "set_translation", (2, 1, 1))])
    assert vv.get("Place", "translation") == [0, 0, 0]


def test_nodes_that_would_hold_themselves(start):
    vv = start().connect()
    made = vv.create("DEF A Transform {} DEF B Transform {} DEF C Switch {}"
                     " DEF S Script { eventIn SFNode in field SFNode known NULL"
                     ' url "javascript: function known() {}" }')
    a, b, c, s = (made.names[name] for name in "ABCS")
    # only both together are a loop
    refused("value", "would hold itself", vv.set_many, [(a, "children", [b]),
                                                        (b, "addChildren", [a])])
    refused("value", "would hold itself", vv.set_many, [(a, "children", [b]), (b, "children", [c]),
                                                        (c, "choice", [a])])
    assert vv.get(a, "children") == vv.get(b, "children") == []
    # a Script may know a node that holds it, and what is removed is not held
    vv.set(a, "children", [b, s])
    vv.set(s, "known", a)
    vv.set(s, "in", s)
    vv.set(b, "removeChildren", [a])
    assert vv.get(s, "known") == a and vv.get(a, "children") == [b, s]
    vv.add_root(a)
    assert vv.render().startswith(b"\x89PNG")


def test_quiet_commands_are_not_lost_and_keep_their_order(start):
    vv = start().connect()
    seen = []
    vv.subscribe("Place", "translation", lambda value, time: seen.append(value[0]))
    count = 3000
    for i in range(count):
        vv.set("Place", "translation", (i, 0, 0), quiet=True)
    assert vv.get("Place", "translation") == [count - 1, 0, 0]
    vv.poll()
    assert seen == list(range(count))
    vv.set("Nobody", "right", 1, quiet=True)
    refused("node", "Nobody", vv.get, "Place", "translation")
    vv.set("Nobody", "right", 1, quiet=True)
    refused("node", "Nobody", vv.poll, 1)


# --- Events ---


def test_events_of_routes_scripts_and_time(start):
    vv = start().connect()
    seen, ticks = [], []
    assert vv.subscribe("Blend", "value_changed", lambda v, t: seen.append(v)) == 0
    vv.set("Blend", "set_fraction", 0.25)
    vv.poll()
    assert seen == [2.5]
    vv.subscribe("Clock", "fraction_changed", lambda v, t: ticks.append((v, t)))
    while len(ticks) < 5:
        assert vv.poll(PATIENCE / 100) >= 0
    times = [t for _, t in ticks]
    assert times == sorted(times) and times[0] < times[-1]
    assert all(0 <= v <= 1 for v, _ in ticks)
    vv.unsubscribe("Clock", "fraction_changed")
    refused("field", "no subscription", vv.unsubscribe, "Clock", "fraction_changed")
    refused("field", "cannot be subscribed to", vv.subscribe, "Sum", "left", print)


def test_two_clients_hear_of_each_other(start):
    server = start()
    one, two = server.connect(), server.connect()
    heard = []
    two.subscribe("Place", "translation", lambda v, t: heard.append(v))
    number = one.node("Place")["node"]
    one.set(number, "translation", (1, 2, 3))
    two.get("Place", "translation")
    two.poll()
    assert heard == [[1, 2, 3]]
    refused("node", "there is no node", two.get, number + 1000, "translation")
    one.close()
    assert two.get("Place", "translation") == [1, 2, 3]


# --- Nodes ---


def test_nodes_are_created_routed_and_removed(start):
    vv = start().connect()
    made = vv.create("DEF Arm Transform { children DEF Hand Transform {} } Group {}")
    assert len(made.nodes) == 2 and made.problems == []
    assert set(made.names) == {"Arm", "Hand"} and made.names["Arm"] == made.nodes[0]
    vv.set("Place", "addChildren", [made.nodes[0]])
    assert made.nodes[0] in vv.get("Place", "children")
    vv.route("Place", "translation_changed", made.names["Hand"], "set_translation")
    vv.set("Place", "translation", (4, 5, 6))
    assert vv.get(made.names["Hand"], "translation") == [4, 5, 6]
    vv.unroute("Place", "translation_changed", made.names["Hand"], "set_translation")
    vv.set("Place", "translation", (0, 0, 0))
    assert vv.get(made.names["Hand"], "translation") == [4, 5, 6]
    refused("field", "no such route", vv.unroute, "Place", "translation_changed",
            made.names["Hand"], "set_translation")
    refused("field", "a route has one type", vv.route, "Blend", "value_changed", "Place",
            "translation")
    vv.set("Place", "removeChildren", [made.nodes[0]])
    assert made.nodes[0] not in vv.get("Place", "children")
    vv.add_root(made.nodes[1])
    vv.remove_root(made.nodes[1])
    refused("node", "not a root", vv.remove_root, made.nodes[1])
    vv.release(*made.nodes)
    refused("node", "there is no node", vv.node, made.nodes[0])
    refused("vrml", "Nonsense", vv.create, "Nonsense {}")
    told = vv.node("Blend")
    assert told["type"] == "ScalarInterpolator" and told["name"] == "Blend"
    assert {"name": "key", "type": "MFFloat", "access": "exposedField"} in told["fields"]
    assert vv.names()["Place"] == "Transform"


def test_viewpoints(start):
    vv = start().connect()
    assert [(v["name"], v["bound"]) for v in vv.viewpoints()] == [("Front", True), ("Back", False)]
    for name in ("from behind", "Front", 1):
        vv.bind(name)
    assert [v["bound"] for v in vv.viewpoints()] == [False, True]
    refused("node", "no viewpoint", vv.bind, "Side")


KEYS = """#X3D V3.3 utf8
PROFILE Immersive
DEF K KeySensor { }
DEF T StringSensor { enabled FALSE }
"""


def test_keys_for_the_world(start, tmp_path):
    (tmp_path / "keys.x3dv").write_text(KEYS)
    vv = start().connect()
    assert not vv.key("a")
    vv.load(str(tmp_path / "keys.x3dv"))
    assert vv.key("F2", True) and vv.key("a") and not vv.key("no key")
    assert (vv.get("K", "actionKeyPress"), vv.get("K", "keyRelease")) == (2, "a")
    vv.set("T", "enabled", True)
    assert vv.type("some\ntext")
    assert (vv.get("T", "finalText"), vv.get("T", "enteredText")) == ("some", "text")
    refused("command", "key", vv.call, "key")


def test_time_stands_still_and_is_skipped(start):
    vv = start("world.wrl", *SMALL, "--epoch", "1000000").connect()
    now = vv.time(paused=True)
    assert vv.time() == now
    ticks = []
    vv.subscribe("Clock", "fraction_changed", lambda v, t: ticks.append(t))
    assert vv.time(skip=0.25) == pytest.approx(now + 0.25)
    vv.poll()
    assert len(ticks) >= 7 and ticks[-1] == pytest.approx(now + 0.25)
    vv.time(paused=False)
    refused("command", "must be paused", vv.time, skip=1)
    while vv.time() <= now + 0.25:
        pass


# --- Pictures and worlds ---


def test_a_picture_has_the_bytes_of_vv_o(start, tmp_path):
    vv = start().connect()

    def headless(*arguments, name="h.png"):
        subprocess.run([find_vv(), "world.wrl", "-o", name, *(arguments or SMALL), "-q"],
                       cwd=tmp_path,
                       check=True)
        return (tmp_path / name).read_bytes()

    assert vv.render() == headless()
    assert vv.render(size=(40, 10), samples=3) == headless("--size", "40x10", "--spp", "3")
    assert vv.render(file="made.png") == b""
    assert (tmp_path / "made.png").read_bytes() == headless()
    vv.render(file="made.exr", channels=["rgba", "z"])
    assert (tmp_path / "made.exr").read_bytes() == headless(*SMALL,
                                                            "--channels",
                                                            "rgba,z",
                                                            name="h.exr")
    vv.bind("Back")
    assert vv.render() == headless(*SMALL, "--viewpoint", "Back")
    vv.set("Paint", "diffuseColor", (0, 0, 1))
    blue = read_ppm(vv.render(format="ppm"))[2][12][16]
    assert blue[2] > 100 and blue[0] < 60
    assert vv.render() == headless(*SMALL, "--viewpoint", "Back", "-D", "Paint.diffuseColor=0 0 1")
    # the picture contains all that was sent before it, and nothing that comes later
    vv.set("Place", "scale", (.01, .01, .01), quiet=True)
    empty = vv.render()
    vv.set("Place", "scale", (1, 1, 1), quiet=True)
    assert vv.render() != empty


def test_pictures_that_cannot_be_made(start, tmp_path):
    vv = start().connect()
    refused("command", "channels: one of rgba", vv.render, channels=["colour"])
    refused("command", "format: one of", vv.render, format="bmp")
    refused("command", "size[0]", vv.render, size=(0, 10))
    refused("limit", "pixels=", vv.render, size=(60000, 60000))
    refused("render", "nowhere", vv.render, file="nowhere/x.png")
    world = (tmp_path / "world.wrl").read_bytes()
    with pytest.raises(module().ControlError, match="world.wrl"):
        vv.render(file="world.wrl", format="png")
    assert (tmp_path / "world.wrl").read_bytes() == world


def test_clients_take_turns_for_pictures(start):
    server = start()
    pictures = {}

    def take(k, client):
        pictures[k] = [client.render(size=(32 + k, 24)) for _ in range(3)]

    threads = [threading.Thread(target=take, args=(k, server.connect())) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert len(pictures) == 4 and all(
        len(set(three)) == 1 and three[0].startswith(b"\x89PNG") for three in pictures.values())


def test_worlds_are_loaded_and_replaced(start, tmp_path):
    (tmp_path / "other.wrl").write_text(HEADER + "DEF Only Group {}")
    server = start()
    vv, watcher = server.connect(), server.connect()
    number = vv.node("Place")["node"]
    vv.subscribe("Place", "translation", print)
    refused("world", "nothing.wrl", vv.load, "nothing.wrl")
    assert vv.names()["Place"] == "Transform"
    assert vv.load("nothing.wrl", "other.wrl").endswith("other.wrl")
    assert vv.names() == {"Only": "Group"}
    refused("node", "there is no node", vv.get, number, "translation")
    watcher.names()
    watcher.poll()
    assert watcher.hello["world"].endswith("other.wrl")
    made = vv.create("DEF New Transform {}")
    vv.replace_world(made.nodes)
    assert vv.names() == {}
    vv.set(made.nodes[0], "translation", (1, 0, 0))
    assert vv.get(made.nodes[0], "translation") == [1, 0, 0]
    assert vv.render().startswith(b"\x89PNG")


def test_worlds_change_while_a_picture_is_rendered(start, tmp_path):
    (tmp_path / "other.wrl").write_text(HEADER + "DEF Only Group {}")
    server = start()
    painter, vv = server.raw(), server.connect()
    endless = {"id": 1, "command": "render", "size": [1600, 1200], "samples": 65536}
    painter.send(endless)
    refused("world", "nothing.wrl", vv.load, "nothing.wrl")
    assert vv.get("Cube", "size") == [2, 2, 2]
    vv.load("other.wrl")
    answer = painter.ask(b"")
    assert "replaced before the picture" in answer["error"]["message"]
    painter.send(endless)
    vv.quit()
    answer = painter.ask(b"")
    assert "vv ended before the picture" in answer["error"]["message"]
    assert painter.receive() is None and server.program.wait(PATIENCE) == 0


def test_loads_take_turns(start, tmp_path):
    server = start()
    clients = [server.raw() for _ in range(8)]
    for i, raw in enumerate(clients):
        (tmp_path / f"{i}.wrl").write_text(HEADER + f"DEF N{i} Group {{}}")
        raw.send({"id": i, "command": "load", "url": f"{i}.wrl"})
    for i, raw in enumerate(clients):
        assert raw.ask(b"") == {"id": i, "result": f"{i}.wrl"}
    assert len(server.connect().names()) == 1


def test_without_a_world(start, tmp_path):
    vv = start(*SMALL).connect()
    assert vv.hello["world"] is None
    refused("world", "no world is loaded", vv.names)
    vv.load("world.wrl")
    assert "Place" in vv.names()


def test_a_world_that_cannot_be_read_ends_vv(start, tmp_path):
    server = start("nothing.wrl")
    assert server.program.wait(PATIENCE) == 3
    (tmp_path / "bad.wrl").write_text(HEADER + "Nonsense {}")
    strict = start("bad.wrl", "--strict")
    assert strict.program.wait(PATIENCE) == 4


def test_quit_and_interrupt(start):
    server = start()
    server.connect().quit()
    assert server.program.wait(PATIENCE) == 0
    server = start()
    server.connect()
    server.program.send_signal(signal.SIGINT)
    assert server.program.wait(PATIENCE) == 130
