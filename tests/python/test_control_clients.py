"""Tests vv --control with clients that are wrong or hostile, its addresses and keys, the lines of
docs/control.md, the examples, and the window."""
import json
import os
import re
import shutil
import stat
import subprocess
import sys

import pytest

from conftest import ROOT, find_vv
from control_server import PATIENCE, SMALL, WORLD, Server, module, refused, start  # noqa: F401
from window_driver import coloured, green, red, screen, window  # noqa: F401

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


def test_lines_may_come_in_any_parts(start):
    raw = start().raw()
    line = b'{"id":7,"command":"set","node":"Place","field":"translation","value":[1,2,3]}\r\n'
    for i in range(1, len(line)):
        raw.send(line[:i])
        raw.send(line[i:])
        assert raw.ask(b"") == {"id": 7, "result": None}
    raw.send(line * 1000)
    for _ in range(1000):
        assert raw.receive() == {"id": 7, "result": None}


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
    assert "lineBytes=" in raw.receive()["error"]["message"]
    assert server.connect().get("Cube", "size") == [2, 2, 2]


def test_a_client_that_does_not_read_is_cut_off(start):
    server = start()
    lazy, busy = server.raw(), server.connect()
    assert lazy.ask({
        "command": "subscribe",
        "node": "Many",
        "field": "value_changed"
    })["result"] == []
    busy.set("Many", "keyValue", [[0.123456, 0.234567, 0.345678]] * 30_000)
    for i in range(190):  # about 435 kB for each event
        busy.set("Many", "set_fraction", i / 190)
    assert busy.get("Cube", "size") == [2, 2, 2]
    # it reads on before the connection ends: whole lines in order, and why there are no more
    lines = lazy.file.readlines()
    times = [json.loads(line)["time"] for line in lines[:-1]]
    assert 140 < len(times) < 190 and times == sorted(times)
    assert "unreadBytes=" in json.loads(lines[-1])["error"]["message"]


def test_a_picture_for_a_pipe_is_refused_and_others_go_on(start, tmp_path):
    os.mkfifo(tmp_path / "pipe.png")
    server = start()
    first, second = server.raw(), server.raw()
    for name in ("pipe.png", "/dev/null", "/dev/stdout"):
        answer = first.ask({"command": "render", "file": name, "format": "png"})
        assert answer["error"]["code"] == "file", answer
    assert "regular file" in first.ask({"command": "render", "file": "pipe.png"})["error"]["message"]
    assert second.ask({"command": "render"})["result"]["format"] == "png"
    assert second.ask({"command": "quit"})["result"] is None
    assert server.program.wait(PATIENCE) == 0


def test_standard_input_is_no_world_for_clients(start):
    server = start()
    first, second = server.raw(), server.raw()
    for url in ("-", ["-", "world.wrl"], ["world.wrl", "-"]):
        assert first.ask({"command": "load", "url": url})["error"]["code"] == "world"
    assert second.ask({"command": "load", "url": "world.wrl"})["result"] == "world.wrl"
    assert second.receive()["event"] == "world"
    assert second.ask({"command": "quit"})["result"] is None
    assert server.program.wait(PATIENCE) == 0


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
    with module().connect(f"unix:{tmp_path / 'vv.socket'}") as vv:
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
    (("--control", "unix:" + 200 * "x"), "more than 107 bytes", 2),
    (("--control", "unix:box.wrl"), "there is a file of this name", 1),
    (("--control", "unix:none/socket"), "No such file or directory", 1),
    (("--control", "0.0.0.0:0", "--key", "none.key"), "none.key", 3),
    (("--control", ":0", "-o", "x.png"), "--control cannot be used with -o", 2),
    (("--control", ":0", "--watch"), "--no-window cannot be used with", 2),
])
def test_addresses_that_cannot_be_used(vv, arguments, words, code):
    done = vv("box.wrl", *arguments, "--no-window")
    assert done.returncode == code and words in done.talk, done.talk
    assert len(done.talk.splitlines()) == 1


def test_a_port_that_is_in_use(start, vv):
    done = vv("box.wrl", "--control", start().address, "--no-window")
    assert done.returncode == 1 and "Address already in use" in done.talk, done.talk


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
    control = module()
    public = (tmp_path / "a.key").read_text().split()[1]
    with control.connect(f"127.0.0.1:{port}", key=tmp_path / "a.key") as vv:
        seen = []
        vv.subscribe("Place", "translation", lambda v, t: seen.append(v[0]))
        for i in range(500):
            vv.set("Place", "translation", (i, 0, 0), quiet=True)
        assert vv.get("Place", "translation") == [499, 0, 0]
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
        assert vv.get("Cube", "size") == [2, 2, 2]


# --- Documents and examples ---


@pytest.fixture
def arm(start, tmp_path):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    return start("examples/robots/arm.wrl", *SMALL)


def test_the_lines_of_the_document(arm):
    page = (ROOT / "docs/control.md").read_text()
    talk, _, events = re.findall(r"```json\n(.*?)```", page, re.S)
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


def test_the_step_of_the_document(start, tmp_path):
    page = (ROOT / "docs/control.md").read_text()
    (tmp_path / "lamp.wrl").write_text(re.findall(r"```vrml file=lamp.wrl\n(.*?)```", page, re.S)[0])
    _, step, _ = re.findall(r"```json\n(.*?)```", page, re.S)
    line, answer = (json.loads(line) for line in step.splitlines())
    assert start("lamp.wrl", *SMALL).raw().ask(line) == answer


def words_of(rows):
    """Returns the names in the first column of a table's rows."""
    return sorted({name for row in re.findall(r"^\| (`.*?) \|", rows, re.M)
                   for name in re.findall(r"`(\w+)`", row)})


def test_the_commands_of_the_document():
    page = (ROOT / "docs/control.md").read_text()
    tables = [part.split("\n\n")[0] for part in page.split("| command | members | result |\n")[1:]]
    source = (ROOT / "apps/vv/control/command.cpp").read_text()
    rows = source[source.index("constexpr Row table[]"):source.
                  index("std::vector<std::string> commandNames")]
    assert words_of("\n".join(tables)) == sorted(re.findall(r'^    \{"(\w+)"', rows, re.M))
    edits = page.split("| edit | members |\n")[1].split("\n\n")[0]
    source = (ROOT / "apps/vv/as_json/edit_step.cpp").read_text()
    rows = source[source.index("Reader::table[10] = {"):]
    assert words_of(edits) == sorted(re.findall(r'\{"(\w+)", &Reader', rows))


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
    control = module()
    (tmp_path / "world.wrl").write_text(WORLD)
    with control.launch(tmp_path / "world.wrl", *SMALL, program=find_vv()) as vv:
        assert vv.get("Cube", "size") == [2, 2, 2]
        process = vv._process
    assert process.returncode == 0
    with pytest.raises(ConnectionError):
        control.launch(tmp_path / "world.wrl", "--no-such-option", program=find_vv())


def test_in_a_window(window, tmp_path):  # noqa: F811
    w = window(
        coloured("1 0 0").replace("Material {", "DEF Paint Material {"), "--control", "127.0.0.1:0")
    w.wait(lambda: any("listening at" in line for line in w.err), "the address")
    address = next(line for line in w.err if "listening at" in line).split()[-1]
    with module().connect(address, timeout=PATIENCE) as vv:
        w.until(lambda s: red(*s.at(0, 0)))
        vv.set("Paint", "diffuseColor", (0, 1, 0))
        w.until(lambda s: green(*s.at(0, 0)))
        png = vv.render(size=(64, 48), samples=4)
        vv.set("Paint", "diffuseColor", (0, 0, 1))
        w.until(lambda s: not green(*s.at(0, 0)))
        world = w.program.args[1]
        subprocess.run([
            find_vv(), world, "-o", "h.png", "--size", "64x48", "--spp", "4", "-q", "-D",
            "Paint.diffuseColor=0 1 0"
        ],
                       cwd=tmp_path,
                       check=True)
        assert png == (tmp_path / "h.png").read_bytes()
        vv.quit()
    assert w.program.wait(PATIENCE) == 0
