"""Shared by the tests of `vv serve`: starts the program, speaks HTTP and WebSocket (RFC 6455) with
it by the standard library, and keeps what it sends."""
import base64
import http.client
import io
import json
import os
import re
import secrets
import signal
import socket
import struct
import subprocess
import threading
import time

import pytest

from conftest import PATIENCE, find_vv

Image = pytest.importorskip("PIL.Image")


def wait_for(test, what, seconds=PATIENCE):
    """Returns the first answer of `test` that is true."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        answer = test()
        if answer:
            return answer
        time.sleep(0.01)
    raise AssertionError(f"not within {seconds} s: {what() if callable(what) else what}")


class Served:
    """A process of `vv serve`."""

    def __init__(self, folder, arguments, env=None):
        self.program = subprocess.Popen([find_vv(), "serve", *map(str, arguments)],
                                        cwd=folder,
                                        stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE,
                                        text=True,
                                        env={
                                            **os.environ,
                                            **(env or {})
                                        })
        self.errors = []
        threading.Thread(target=lambda: [self.errors.append(x) for x in self.program.stderr],
                         daemon=True).start()
        self.url = self.program.stdout.readline().strip()
        found = re.fullmatch(r"http://(.+):(\d+)/(\?token=(.*))?", self.url)
        assert found, (self.url, self.errors, self.program.poll())
        self.host, self.port = found[1].strip("[]"), int(found[2])
        self.token = found[4]
        self.edit_token = None
        if "--edit" in arguments:
            edits = self.program.stdout.readline()
            self.edit_token = re.fullmatch(r"http://.+/\?token=([0-9a-f]{32})  edits the world\n",
                                           edits)[1]

    def get(self, path="/", headers=None, method="GET", host="127.0.0.1"):
        connection = http.client.HTTPConnection(host, self.port, timeout=PATIENCE)
        connection.request(method, path, headers=headers or {})
        answer = connection.getresponse()
        answer.body = answer.read()
        connection.close()
        return answer

    def join(self, width=160, height=120, **more):
        page = Page(self.port, **more)
        if width:
            page.send(type="size", width=width, height=height)
        return page

    def join_editor(self, width=160, height=120):
        """Returns a page that may edit and has the editor open."""
        page = self.join(width, height, path="/live?token=" + self.edit_token)
        page.told("editor")
        page.edit("rows", first=0, count=100)
        page.told("rows")
        return page

    def cpu(self, of_main_thread=False):
        """Returns the seconds of processor time so far."""
        thread = f"task/{self.program.pid}/" if of_main_thread else ""
        with open(f"/proc/{self.program.pid}/{thread}stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def stop(self):
        """Ends the process as Ctrl+C does; returns its exit code."""
        self.program.send_signal(signal.SIGINT)
        return self.program.wait(PATIENCE)

    def kill(self):
        self.program.kill()
        self.program.wait()
        self.program.stdout.close()


class Shown:
    """A picture that a page got: facts, and pixels addressed by positions from -1 to 1."""

    def __init__(self, message):
        length, = struct.unpack_from("<I", message)
        self.facts = json.loads(message[4:4 + length])
        self.jpeg = message[4 + length:]
        self.image = Image.open(io.BytesIO(self.jpeg)).convert("RGB")
        self.width, self.height = self.image.size
        assert (self.width, self.height) == (self.facts["width"], self.facts["height"])

    def at(self, x, y):
        return self.image.getpixel((int((x + 1) / 2 * self.width), int((1 - y) / 2 * self.height)))


class Refused(Exception):
    """The server did not accept a WebSocket; `status` is that of its HTTP answer."""

    def __init__(self, status):
        super().__init__(status)
        self.status = status


class Page:
    """A page's end of the WebSocket. A thread reads what comes; pictures are acknowledged at once
    unless `silent`."""

    def __init__(self, port, silent=False, headers=None, path="/live", host="127.0.0.1"):
        self.silent = silent
        self.texts, self.pictures, self.closed = [], [], None
        self.state, self.viewpoints = {}, None
        self.lock = threading.Lock()
        self.socket = socket.create_connection((host, port), timeout=PATIENCE)
        self.connect(port, headers or {}, path)
        self.socket.settimeout(None)
        threading.Thread(target=self.read, daemon=True).start()

    # --- Frames ---

    def connect(self, port, headers, path):
        lines = {
            "Host": f"127.0.0.1:{port}",
            "Origin": f"http://127.0.0.1:{port}",
            "Upgrade": "websocket",
            "Connection": "Upgrade",
            "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": base64.b64encode(secrets.token_bytes(16)).decode(),
            **headers
        }
        text = f"GET {path} HTTP/1.1\r\n" + "".join(
            f"{k}: {v}\r\n" for k, v in lines.items() if v is not None)
        self.socket.sendall(text.encode() + b"\r\n")
        answer = b""
        while b"\r\n\r\n" not in answer:
            got = self.socket.recv(1)
            if not got:
                break
            answer += got
        status = int(answer.split(b" ", 2)[1]) if answer else 0
        if status != 101:
            self.socket.close()
            raise Refused(status)

    def send_frame(self, code, payload, final=True):
        size = len(payload)
        length = (bytes([0x80 | size]) if size < 126 else bytes([0x80 | 126]) +
                  struct.pack(">H", size) if size < 65536 else bytes([0x80 | 127]) +
                  struct.pack(">Q", size))
        mask = secrets.token_bytes(4)
        masked = bytes(b ^ mask[i % 4] for i, b in enumerate(payload))
        with self.lock:
            self.socket.sendall(bytes([(0x80 if final else 0) | code]) + length + mask + masked)

    def exactly(self, size):
        data = b""
        while len(data) < size:
            got = self.socket.recv(size - len(data))
            if not got:
                raise EOFError
            data += got
        return data

    def read(self):
        try:
            while True:
                self.take(*self.next_message())
        except (EOFError, OSError):
            self.closed = self.closed or (0, "")

    def next_message(self):
        code, message = 0, b""
        while True:
            first, second = self.exactly(2)
            size = second & 127
            if size == 126:
                size, = struct.unpack(">H", self.exactly(2))
            elif size == 127:
                size, = struct.unpack(">Q", self.exactly(8))
            payload = self.exactly(size)
            if first & 15 >= 8:
                return first & 15, payload
            code, message = code or first & 15, message + payload
            if first & 128:
                return code, message

    def take(self, code, message):
        if code == 1:
            text = json.loads(message)
            if text["type"] == "state":
                self.state = text
            elif text["type"] == "viewpoints":
                self.viewpoints = text["list"]
            self.texts.append(text)
        elif code == 2:
            shown = Shown(message)
            self.pictures.append(shown)
            if not self.silent:
                self.send(type="shown", picture=shown.facts["picture"])
        elif code == 8:
            number = struct.unpack(">H", message[:2])[0] if message else 0
            self.closed = (number, message[2:].decode())
        elif code == 9:
            self.send_frame(10, message)

    # --- What a page does ---

    def send(self, **message):
        self.send_text(json.dumps(message))

    def send_text(self, text):
        self.send_frame(1, text.encode() if isinstance(text, str) else text)

    def edit(self, command, **members):
        self.send(type="edit", command=command, **members)

    def click(self, x, y):
        self.send(type="move", x=x, y=y)
        self.send(type="press", button="left", x=x, y=y)
        self.send(type="release", button="left", x=x, y=y)

    def drag(self, x0, y0, x1, y1, button="left", steps=4):
        self.send(type="move", x=x0, y=y0)
        self.send(type="press", button=button, x=x0, y=y0)
        for i in range(1, steps + 1):
            self.send(type="move", x=x0 + (x1 - x0) * i / steps, y=y0 + (y1 - y0) * i / steps)
        self.send(type="release", button=button, x=x1, y=y1)

    def key(self, name, **modifiers):
        self.send(type="down", key=name, **modifiers)
        self.send(type="up", key=name, **modifiers)

    def close(self):
        try:
            self.socket.shutdown(socket.SHUT_RDWR)  # wakes the thread that reads
        except OSError:
            pass
        self.socket.close()

    # --- What a page waits for ---

    def told(self, kind, count=1):
        """Returns the last text of a kind, once there are so many."""
        return wait_for(lambda: self.of(kind)[count - 1:], lambda:
                        (kind, self.texts, self.closed))[-1]

    def of(self, kind):
        return [text for text in self.texts if text["type"] == kind]

    def until(self, test, what="no such picture"):
        """Returns the newest picture for which `test` is true."""
        return wait_for(
            lambda: next((p for p in self.pictures[-1:] if test(p)), None), lambda:
            (what, self.pictures and self.pictures[-1].facts, self.state, self.closed))

    def still(self, test=lambda picture: True):
        """Returns a finished picture."""
        return self.until(lambda p: p.facts["finished"] and test(p))

    def until_state(self, test):
        return wait_for(lambda: self.state and test(self.state), lambda: self.state)

    def until_closed(self):
        return wait_for(lambda: self.closed, "it is still open")

    def command(self):
        """Returns the words of the command of the view."""
        import shlex
        count = len(self.of("command"))
        self.send(type="command")
        return shlex.split(self.told("command", count + 1)["text"])

    def camera(self):
        numbers = next(w for w in self.command() if w.startswith("--camera="))[9:]
        return [[float(v) for v in part.split(",")] for part in numbers.split(":")]


@pytest.fixture
def serve(vv):
    """Starts `vv serve` for a world: a file name, or the text of one."""
    started = []
    if "without libwebsockets" in vv("serve", "no.wrl").talk:
        pytest.skip("vv is built without libwebsockets")

    def start(world, *arguments, env=None):
        if world.startswith("#VRML"):
            vv.write("world.wrl", world)
            world = "world.wrl"
        one = Served(vv.folder, [world, "--port", 0, *arguments], env)
        started.append(one)
        return one

    yield start
    for one in started:
        one.kill()
