"""Drives headless Chromium by the W3C WebDriver protocol: plain HTTP to chromedriver, with the
standard library alone."""
import base64
import json
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request

from conftest import PATIENCE

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the name that the protocol gives to elements


def missing():
    """Returns the name of a program that is not installed, or None."""
    return next((name for name in ("chromium", "chromedriver") if not shutil.which(name)), None)


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Browser:
    """A Chromium with one window for each page."""

    def __init__(self, folder, width=800, height=600):
        port = free_port()
        self.base = f"http://127.0.0.1:{port}"
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"],
                                       stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        self.until(lambda: self.call("GET", "/status")["ready"], "chromedriver")
        arguments = [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            "--no-first-run", "--disable-background-networking", "--disable-component-update",
            "--disable-sync", "--force-device-scale-factor=1", f"--user-data-dir={folder}/profile",
            f"--window-size={width},{height}"
        ]
        answer = self.call(
            "POST", "/session", {
                "capabilities": {
                    "alwaysMatch": {
                        "browserName": "chrome",
                        "goog:chromeOptions": {
                            "args": arguments,
                            "binary": shutil.which("chromium"),
                            "prefs": {
                                "download.default_directory": str(folder),
                                "download.prompt_for_download": False
                            }
                        },
                        "goog:loggingPrefs": {
                            "browser": "ALL"
                        }
                    }
                }
            })
        self.session = f"/session/{answer['sessionId']}"
        self.resize(width, height)

    def call(self, method, path, body=None):
        data = json.dumps(body if body is not None else {}).encode() if method == "POST" else None
        request = urllib.request.Request(self.base + path, data, method=method)
        request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE * 2) as answer:
                return json.loads(answer.read())["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{path}: {json.loads(error.read())['value']['message']}") from None

    def do(self, path, body=None, method="POST"):
        return self.call(method, self.session + path, body)

    def quit(self):
        try:
            self.call("DELETE", self.session)
        except (RuntimeError, OSError, AttributeError):
            pass
        self.driver.terminate()
        self.driver.wait()

    @staticmethod
    def until(test, what, seconds=PATIENCE):
        """Returns the first answer of `test` that is true."""
        end = time.monotonic() + seconds
        last = None
        while time.monotonic() < end:
            try:
                last = test()
            except (RuntimeError, OSError) as error:
                last, error_text = None, error
                what_now = f"{what}: {error_text}"
            else:
                what_now = what
            if last:
                return last
            time.sleep(0.03)
        raise AssertionError(f"not within {seconds} s: {what_now}")

    # --- Windows and pages ---

    def open(self, url):
        self.do("/url", {"url": url})

    def new_tab(self):
        handle = self.do("/window/new", {"type": "window"})["handle"]
        self.switch(handle)
        return handle

    def handle(self):
        return self.do("/window", method="GET")

    def handles(self):
        return self.do("/window/handles", method="GET")

    def switch(self, handle):
        self.do("/window", {"handle": handle})

    def resize(self, width, height):
        self.do("/window/rect", {"width": width, "height": height})

    def script(self, text, *arguments):
        return self.do("/execute/sync", {"script": text, "args": list(arguments)})

    def screenshot(self, path):
        path.write_bytes(base64.b64decode(self.do("/screenshot", method="GET")))

    def log(self):
        """Returns what the console has said since the last call."""
        return [f"{e['level']} {e['message']}" for e in self.do("/se/log", {"type": "browser"})]

    # --- Elements ---

    def element(self, selector):
        return self.do("/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        self.do(f"/element/{self.element(selector)}/click")

    def text(self, selector):
        return self.do(f"/element/{self.element(selector)}/text", method="GET")

    # --- Mouse, fingers and keys ---

    def actions(self, *sources):
        self.do("/actions", {"actions": list(sources)})

    def point(self, canvas, x, y):
        """Returns the place of the window for a place of the picture from -1 to 1."""
        area = self.script(
            "const c = document.querySelector(arguments[0]), r = c.getBoundingClientRect();"
            "return [r.left, r.top, r.width, r.height, c.width, c.height];", canvas)
        left, top, width, height, across, down = area
        scale = min(width / across, height / down)
        return (round(left + width / 2 + x * across * scale / 2),
                round(top + height / 2 - y * down * scale / 2))

    def pointer(self, canvas, places, button=0, kind="mouse", name="mouse"):
        """Presses at the first place, moves through the others, and releases."""

        def move(place):
            x, y = self.point(canvas, *place)
            return {"type": "pointerMove", "duration": 40, "x": x, "y": y, "origin": "viewport"}

        steps = [move(places[0]), {"type": "pointerDown", "button": button}]
        steps += [move(place) for place in places[1:]]
        steps.append({"type": "pointerUp", "button": button})
        return self.pointer_steps(steps, kind, name)

    @staticmethod
    def pointer_steps(steps, kind="mouse", name="mouse"):
        """Returns the source of actions that does these steps with a mouse or a finger."""
        return {
            "type": "pointer",
            "id": name,
            "parameters": {
                "pointerType": kind
            },
            "actions": steps
        }

    def drag(self, canvas, *places, button=0, kind="mouse"):
        self.actions(self.pointer(canvas, places, button, kind, kind))

    def wheel(self, canvas, x, y, amount):
        px, py = self.point(canvas, x, y)
        self.actions({
            "type":
                "wheel",
            "id":
                "wheel",
            "actions": [{
                "type": "scroll",
                "x": px,
                "y": py,
                "deltaX": 0,
                "deltaY": amount,
                "origin": "viewport"
            }]
        })

    def keys(self, *keys):
        """Presses keys one after the other; names as in the protocol's table."""
        steps = []
        for key in keys:
            steps += [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self.actions({"type": "key", "id": "keys", "actions": steps})
