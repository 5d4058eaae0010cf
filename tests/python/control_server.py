"""Starts vv with a control channel for tests, and connects to it by xvrml.control, whose file works
without the rest of the package."""
import importlib.util
import json
import os
import socket
import subprocess
import sys
import threading
import time

import pytest

from conftest import HEADER, PATIENCE, ROOT, find_vv


def module():
    """Returns xvrml.control, loaded from its file."""
    if "control_client" not in sys.modules:
        spec = importlib.util.spec_from_file_location("control_client",
                                                      ROOT / "bindings/python/xvrml/control.py")
        sys.modules["control_client"] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules["control_client"])
    return sys.modules["control_client"]


class Server:
    """A vv that listens."""

    def __init__(self, folder, *arguments, address="127.0.0.1:0", window=False, env=None):
        self.folder = folder
        self.program = subprocess.Popen([
            find_vv(), *map(str, arguments), "--control", address,
            *([] if window else ["--no-window"])
        ],
                                        cwd=folder,
                                        stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE,
                                        text=True,
                                        env={
                                            **os.environ,
                                            **(env or {})
                                        })
        self.err = []
        self.clients = []
        self.reader = threading.Thread(
            target=lambda: [self.err.append(x) for x in self.program.stderr], daemon=True)
        self.reader.start()
        self.address = self.wait(self.told, "the address").split()[-1]

    def told(self):
        return next((x for x in self.err if "listening at" in x), None)

    def wait(self, test, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if found := test():
                return found
            if (code := self.program.poll()) is not None:
                self.reader.join(PATIENCE)  # its last lines
                assert test(), (what, code, self.err)
            time.sleep(.005)
        raise AssertionError((what, self.err))

    def connect(self, **options):
        self.clients.append(module().connect(self.address, timeout=PATIENCE, **options))
        return self.clients[-1]

    def raw(self):
        """Returns a bare connection."""
        self.clients.append(Raw(self.address))
        return self.clients[-1]

    def end(self):
        """Ends vv. Returns its exit code."""
        for client in self.clients:
            client.close()
        if self.program.poll() is None:
            self.program.terminate()
        return self.program.wait(PATIENCE)


class Raw:
    """Lines over a socket, without a client."""

    def __init__(self, address):
        if address.startswith("unix:"):
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.connect(address[5:])
        else:
            host, _, port = address.rpartition(":")
            self.socket = socket.create_connection((host, int(port)))
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.settimeout(PATIENCE)
        self.file = self.socket.makefile("rb")

    def send(self, line):
        self.socket.sendall(line if isinstance(line, bytes) else json.dumps(line).encode() + b"\n")

    def receive(self):
        """Returns the next line; None at the end."""
        try:
            line = self.file.readline()
        except ConnectionResetError:
            return None
        return json.loads(line) if line else None

    def ask(self, line):
        self.send(line)
        while True:
            answer = self.receive()
            if answer is None or "event" not in answer:
                return answer

    def close(self):
        self.file.close()
        self.socket.close()


def until(client, test):
    """Lets the client poll until the test holds. Scripts may answer after a command has."""
    end = time.monotonic() + PATIENCE
    while not test():
        assert time.monotonic() < end
        client.poll(.01)


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
  field SFFloat a 0
  url "javascript:
    function left(v) { a = v; }
    function right(v, t) { sum = a + v; stamp = t; }"
}
DEF Many CoordinateInterpolator { key [ 0 1 ] }
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
    with pytest.raises(module().ControlError) as error:
        function(*arguments, **options)
    assert error.value.code == code and words in str(error.value), str(error.value)
