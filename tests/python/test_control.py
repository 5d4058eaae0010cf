"""Tests vv --control without a window, by xvrml.control and by bare sockets: every command, errors,
events, several clients, pictures, worlds, hostile clients, keys, the documents and the examples."""
import json
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import threading

import pytest

import control_server
from conftest import HEADER, ROOT, find_vv, read_ppm
from control_server import PATIENCE, Server

WORLD = HEADER + """
DEF Front Viewpoint { position 0 0 5 description "front" }
DEF Back Viewpoint { position 0 0 -5 orientation 0 1 0 3.14159265 description "from behind" }
DEF Place Transform {
  children DEF Thing Shape {
    appearance Appearance { material DEF Paint Material { diffuseColor 0.8 0.2 0.1 } }
    geometry DEF Cube Box { size 2 2 2 }
  }
}
DEF Blend ScalarInterpolator { key [ 0 1 ] keyValue [ 0 10 ] }
DEF Sum Script {
  eventIn SFFloat left eventIn SFFloat right eventOut SFFloat sum eventOut SFTime stamp
  eventOut MFFloat all
  field SFFloat a 0 field MFFloat kept []
  url "javascript:
    function left(v) { a = v; }
    function right(v, t) { sum = a + v; stamp = t; kept[kept.length] = v; all = kept; }"
}
DEF Clock TimeSensor { cycleInterval 0.5 loop TRUE }
ROUTE Blend.value_changed TO Sum.left
"""
SMALL = ("--size", "32x24", "--spp", "2")


@pytest.fixture
def start(tmp_path):
    """Returns a function that starts vv with WORLD, or with other arguments."""
    if not find_vv().exists():
        pytest.skip("vv is not built")
    (tmp_path / "world.wrl").write_text(WORLD)
    servers = []

    def begin(*arguments, **options):
        servers.append(Server(tmp_path, *(arguments or ("world.wrl", *SMALL)), **options))
        return servers[-1]

    yield begin
    for server in servers:
        server.end()


def refused(code, words, function, *arguments, **options):
    with pytest.raises(control_server.module().ControlError) as error:
        function(*arguments, **options)
    assert error.value.code == code and words in str(error.value), str(error.value)


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
    refused("value", "numbers from 0 to 1", vv.set, "Paint", "transparency", 2)
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
    vv.set_many([("Sum", "left", 3), ("Sum", "right", 4)])
    vv.poll()
    assert [value for field, value in seen if field == "sum"] == [7]
    # The route brings 5 after the last value, so the sum does not contain it.
    vv.set_many([("Blend", "set_fraction", .5), ("Sum", "right", 1)])
    vv.poll()
    assert [value for field, value in seen if field == "sum"] == [7, 4]
    vv.set("Sum", "right", 1)
    vv.poll()
    assert [value for field, value in seen if field == "sum"] == [7, 4, 6]


def test_a_step_with_an_error_changes_nothing(start):
    vv = start().connect()
    refused("value", "expected", vv.set_many, [("Place", "translation", (1, 1, 1)),
                                               ("Paint", "diffuseColor", "red")])
    refused("value", "twice", vv.set_many, [("Place", "translation", (1, 1, 1)),
                                            ("Place", "set_translation", (2, 1, 1))])
    assert vv.get("Place", "translation") == [0, 0, 0]


def test_quiet_commands_are_not_lost_and_keep_their_order(start):
    vv = start().connect()
    count = 3000
    for i in range(count):
        vv.set("Sum", "right", i, quiet=True)
    assert vv.get("Sum", "all") == list(range(count))
    vv.set("Nobody", "right", 1, quiet=True)
    refused("node", "Nobody", vv.get, "Sum", "sum")
    vv.set("Nobody", "right", 1, quiet=True)
    with pytest.raises(control_server.module().ControlError):
        vv.poll(PATIENCE)
    assert vv.get("Sum", "sum") == count - 1 + 0


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
    os.rename(tmp_path / "world.wrl", tmp_path / "world.png")
    server = start("world.png", *SMALL)
    other = server.connect()
    with pytest.raises(control_server.module().ControlError):
        other.render(file="world.png")
    assert (tmp_path / "world.png").read_bytes() == world


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


# --- Clients that are wrong or hostile ---


def test_hostile_lines_are_answered(start):
    raw = start().raw()
    raw.send({"command": "hello"})
    assert raw.receive()["result"]["program"] == "vv"
    cases = [
        (b"nonsense\n", "syntax"),
        (b'{"command":"get","node":"\xff","field":"x"}\n', "syntax"),
        (b'{"id":1,"command":"set","node":"Place","field":"scale","value":[1e400,1,1]}\n',
         "syntax"),
        (b'{"command":"set","value":' + 100_000 * b"[" + b"\n", "limit"),
        (b"[" + b"0," * 3_000_000 + b"0]\n", "limit"),
        (b'{"command":"hello","command":"quit"}\n', "syntax"),
        (b'{"command":"create","vrml":"' + 100_000 * b"Group { children [ " + b'"}\n', "vrml"),
    ]
    for line, code in cases:
        answer = raw.ask(line)
        assert answer["error"]["code"] == code, (line[:60], answer)
    assert raw.ask({
        "id": 5,
        "command": "get",
        "node": "Place",
        "field": "scale"
    })["result"] == [1, 1, 1]


def test_other_protocols_are_cut_off(start):
    server = start()
    raw = server.raw()
    raw.send(b'POST / HTTP/1.1\r\nHost: x\r\n\r\n{"command":"quit"}\n')
    assert raw.receive()["error"]["code"] == "syntax"
    assert raw.receive() is None
    assert server.connect().get("Cube", "size") == [2, 2, 2]


def test_a_line_without_an_end_is_cut_off(start):
    server = start()
    raw = server.raw()
    block = b" " * (1 << 20)
    with pytest.raises(OSError):
        for _ in range(1024):  # 1 GB
            raw.socket.sendall(block)
        raise AssertionError("all was read")
    assert server.connect().get("Cube", "size") == [2, 2, 2]


def test_a_client_that_does_not_read_is_cut_off(start):
    server = start()
    lazy, busy = server.raw(), server.connect()
    lazy.send({"command": "subscribe", "node": "Sum", "field": "all"})
    busy.set_many([("Sum", "kept", [0.123456] * 50_000)])
    for _ in range(300):  # about 400 kB for each event
        busy.set("Sum", "right", 1)
    assert busy.get("Cube", "size") == [2, 2, 2]
    last = None
    while (line := lazy.receive()) is not None:
        last = line
    assert "unreadBytes=" in last["error"]["message"]


def test_clients_come_and_go(start):
    server = start()
    for _ in range(100):
        raw = server.raw()
        raw.send({"command": "subscribe", "node": "Clock", "field": "fraction_changed"})
        raw.close()
    assert server.connect().get("Cube", "size") == [2, 2, 2]
    # commands of a client that has ended its side are done
    raw = server.raw()
    raw.send(b'{"id":1,"command":"set","node":"Cube","field":"size","value":[1,1,1]}\n'
             b'{"id":2,"command":"get","node":"Cube","field":"size"}')
    raw.socket.shutdown(1)
    assert raw.receive() == {"id": 1, "result": None}
    assert raw.receive() == {"id": 2, "result": [1, 1, 1]}
    assert raw.receive() is None


# --- Addresses and keys ---


def test_a_unix_socket_belongs_to_the_user(start, tmp_path):
    server = start("world.wrl", address="unix:vv.socket")
    assert stat.S_IMODE((tmp_path / "vv.socket").stat().st_mode) == 0o600
    with control_server.module().connect(f"unix:{tmp_path / 'vv.socket'}") as vv:
        assert vv.get("Cube", "size") == [2, 2, 2]
        taken = subprocess.run([find_vv(), "--control", "unix:vv.socket", "--no-window"],
                               cwd=tmp_path,
                               capture_output=True,
                               text=True)
        assert taken.returncode == 1 and "another program listens there" in taken.stderr
    server.program.kill()  # leaves the file
    server.program.wait()
    again = start("world.wrl", address="unix:vv.socket")
    assert again.end() == 130 and not (tmp_path / "vv.socket").exists()


@pytest.mark.parametrize("arguments, words, code", [
    (("--control", "127.0.0.1"), "the port is missing", 2),
    (("--control", ":70000"), "a port is a number", 2),
    (("--control", "0.0.0.0:0"), "a key is needed", 1),
    (("--control", "0.0.0.0:0", "--key", "none.key"), "none.key", 3),
    (("--control", ":0", "-o", "x.png"), "--control cannot be used with -o", 2),
    (("--control", ":0", "--watch"), "--no-window cannot be used with", 2),
])
def test_addresses_that_cannot_be_used(vv, arguments, words, code):
    done = vv("box.wrl", *arguments, "--no-window")
    assert done.returncode == code and words in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1


def test_no_window_needs_control(vv):
    assert vv("box.wrl", "--no-window").returncode == 2


def test_other_machines_need_the_key(start, tmp_path):
    pytest.importorskip("zmq")
    worker = find_vv().with_name("openrt-worker")
    if not worker.exists():
        pytest.skip("openrt-worker is not built")
    for name in ("a.key", "b.key"):
        subprocess.run([worker, "--new-key", tmp_path / name], check=True, capture_output=True)
    server = start("world.wrl", *SMALL, "--key", "a.key", address="0.0.0.0:0")
    port = server.address.rpartition(":")[2]
    control = control_server.module()
    public = (tmp_path / "a.key").read_text().split()[1]
    with control.connect(f"127.0.0.1:{port}", key=tmp_path / "a.key") as vv:
        seen = []
        vv.subscribe("Sum", "sum", lambda v, t: seen.append(v))
        for i in range(500):
            vv.set("Sum", "right", i, quiet=True)
        assert vv.get("Sum", "sum") == 499
        vv.poll()
        assert seen == list(range(500))
        assert vv.render().startswith(b"\x89PNG")
        refused("node", "Nobody", vv.get, "Nobody", "x")
        with pytest.raises(TimeoutError):
            control.connect(f"127.0.0.1:{port}",
                            key=tmp_path / "b.key",
                            server_key=public,
                            timeout=1)
        with pytest.raises((OSError, ValueError)):
            control.connect(f"127.0.0.1:{port}", timeout=1)
        assert vv.get("Sum", "sum") == 499


# --- Documents and examples ---


@pytest.fixture
def arm(start, tmp_path):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    return start("examples/robots/arm.wrl", *SMALL)


def test_the_lines_of_the_document(arm):
    page = (ROOT / "docs/control.md").read_text()
    talk, events = re.findall(r"```json\n(.*?)```", page, re.S)
    lines = [json.loads(line) for line in talk.splitlines()]
    raw = arm.raw()
    sent = 0
    while lines:
        answer = raw.ask(lines.pop(0))
        sent += 1
        if lines:
            assert answer == lines.pop(0)
        else:
            assert answer["result"]["paused"] is True
    assert sent >= 7
    changed, world = (json.loads(line) for line in events.splitlines())
    raw.ask({"command": "subscribe", "node": "J2", "field": "rotation"})
    raw.send({"command": "set", "node": "J2", "field": "rotation", "value": changed["value"]})
    event = raw.receive()
    assert {**event, "time": changed["time"]} == changed
    raw.receive()
    raw.send({"command": "load", "url": "examples/robots/arm.wrl"})
    answers = [raw.receive(), raw.receive()]
    assert world in answers


def test_the_commands_of_the_document(start):
    page = (ROOT / "docs/control.md").read_text()
    table = page[page.index("## Commands"):page.index("* **set**")]
    listed = [
        name for row in re.findall(r"^\| (`.*?) \|", table, re.M)
        for name in re.findall(r"`(\w+)`", row)
    ]
    source = (ROOT / "apps/vv/control/command.cpp").read_text()
    rows = source[source.index("constexpr Row table[]"):source.
                  index("std::vector<std::string> commandNames")]
    assert sorted(listed) == sorted(re.findall(r'^    \{"(\w+)"', rows, re.M))


def test_a_client_in_tcl(arm, tmp_path):
    tclsh = shutil.which("tclsh")
    if not tclsh:
        pytest.skip("tclsh is not installed")
    script = ROOT / "examples/control/joints.tcl"
    assert len(script.read_text().splitlines()) < 40
    host, _, port = arm.address.rpartition(":")
    done = subprocess.run([tclsh, script, host, port, "arm.png"],
                          cwd=tmp_path,
                          capture_output=True,
                          text=True,
                          timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    angles = [json.loads(line)["value"][3] for line in done.stdout.splitlines()]
    assert angles == [-0.1, -0.2, -0.3, -0.4, -0.5]
    assert (tmp_path / "arm.png").read_bytes().startswith(b"\x89PNG")


def test_the_stream_of_joints(arm, tmp_path):
    pytest.importorskip("xvrml")
    done = subprocess.run(
        [sys.executable, ROOT / "examples/control/stream_joints.py", arm.address, "0.5"],
        capture_output=True,
        text=True,
        timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert "50 steps" in done.stdout


def test_launch(tmp_path):
    if not find_vv().exists():
        pytest.skip("vv is not built")
    control = control_server.module()
    (tmp_path / "world.wrl").write_text(WORLD)
    with control.launch(tmp_path / "world.wrl", *SMALL, program=find_vv()) as vv:
        assert vv.get("Cube", "size") == [2, 2, 2]
        process = vv._process
    assert process.returncode == 0
    with pytest.raises(ConnectionError):
        control.launch(tmp_path / "world.wrl", "--no-such-option", program=find_vv())
