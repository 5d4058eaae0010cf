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

from conftest import ROOT, find_vv

PATIENCE = 30  # seconds, for things that take a moment on an idle machine


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
        threading.Thread(target=lambda: [self.err.append(x) for x in self.program.stderr],
                         daemon=True).start()
        self.address = self.wait(self.told, "the address").split()[-1]

    def told(self):
        return next((x for x in self.err if "listening at" in x), None)

    def wait(self, test, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if found := test():
                return found
            assert self.program.poll() is None or test(), (what, self.err)
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
