"""Tests world.view() in JupyterLab in headless Chromium: the picture arrives, a click on a sensor
calls back, a drag turns the world. It needs jupyterlab, jupyter_rfb, chromium and chromedriver."""
import base64
import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import urllib.error
import urllib.request

import pytest

xvrml = pytest.importorskip("xvrml")
from live_view_tools import WORLD  # noqa: E402

PACKAGES = ("jupyterlab", "ipykernel", "jupyter_rfb")
pytestmark = pytest.mark.skipif(
    any(importlib.util.find_spec(name) is None for name in PACKAGES) or
    not shutil.which("chromedriver"),
    reason="jupyterlab, ipykernel, jupyter_rfb or chromedriver is not installed")

CELLS = [
    "import pathlib, xvrml\nworld = xvrml.load('world.wrl')\n"
    "note = lambda name, text: pathlib.Path(name).write_text(str(text))",
    "world.on('Touch.touchTime', lambda value, time: note('touched', value))\n"
    "view = world.view(size=(320, 240), spp=4)\nview",
]


def wait(condition, limit=90):
    end = time.monotonic() + limit
    while True:
        found = condition()
        if found:
            return found
        assert time.monotonic() < end, "the page did not come so far"
        time.sleep(0.05)


def program(command, folder, pattern, environment=None):
    """Starts a program. Returns it and what the pattern finds in its output."""
    log = folder / (pathlib.Path(command[0]).name + ".log")
    with open(log, "w") as out:
        running = subprocess.Popen(command,
                                   cwd=folder,
                                   stdout=out,
                                   stderr=out,
                                   env={
                                       **os.environ,
                                       **(environment or {})
                                   })
    found = wait(lambda: re.search(pattern, log.read_text()) or running.poll() is not None)
    assert not isinstance(found, bool), log.read_text()
    return running, found


class Driver:
    """A session of chromedriver (W3C WebDriver)."""

    def __init__(self, address):
        self.address = address + "/session"
        arguments = [
            "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            "--window-size=1200,900"
        ]
        made = self(
            "", {
                "capabilities": {
                    "alwaysMatch": {
                        "browserName": "chrome",
                        "goog:chromeOptions": {
                            "args": arguments
                        }
                    }
                }
            })
        self.address += "/" + made["sessionId"]

    def __call__(self, path, body=None, method=None):
        request = urllib.request.Request(self.address + path,
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={"Content-Type": "application/json"},
                                         method=method)
        with urllib.request.urlopen(request, timeout=90) as answer:
            return json.load(answer)["value"]

    def script(self, text):
        return self("/execute/sync", {"script": text, "args": []})

    def pointer(self, *actions):
        """actions: (x, y) moves, "down" and "up"."""
        steps = [{
            "type": "pointerMove",
            "duration": 50,
            "x": round(action[0]),
            "y": round(action[1])
        } if isinstance(action, tuple) else {
            "type": "pointer" + action.capitalize(),
            "button": 0
        } for action in actions]
        self(
            "/actions", {
                "actions": [{
                    "type": "pointer",
                    "id": "mouse",
                    "parameters": {
                        "pointerType": "mouse"
                    },
                    "actions": steps
                }]
            })

    def screenshot(self, path):
        path.write_bytes(base64.b64decode(self("/screenshot")))


def notebook(cells):
    return {
        "nbformat":
            4,
        "nbformat_minor":
            4,
        "metadata": {
            "kernelspec": {
                "display_name": "Python 3",
                "language": "python",
                "name": "python3"
            }
        },
        "cells": [{
            "cell_type": "code",
            "execution_count": None,
            "metadata": {},
            "outputs": [],
            "source": cell
        } for cell in cells]
    }


@pytest.fixture
def page(tmp_path):
    """A page of JupyterLab that has run the cells."""
    (tmp_path / "world.wrl").write_text(WORLD + 'NavigationInfo { type ["EXAMINE", "ANY"] }')
    (tmp_path / "live.ipynb").write_text(json.dumps(notebook(CELLS)))
    kernel = tmp_path / "share/kernels/python3"
    kernel.mkdir(parents=True)
    (kernel / "kernel.json").write_text(
        json.dumps({
            "argv": [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"],
            "display_name": "Python 3",
            "language": "python"
        }))
    environment = {
        "HOME": str(tmp_path),
        "JUPYTER_CONFIG_DIR": str(tmp_path / "config"),
        "JUPYTER_RUNTIME_DIR": str(tmp_path / "runtime"),
        "JUPYTER_DATA_DIR": str(tmp_path / "share"),
    }
    running = []
    try:
        lab, found = program([
            sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--ip=127.0.0.1",
            "--port=0", "--IdentityProvider.token=test", "--expose-app-in-browser",
            "--LabApp.news_url=", "--LabApp.check_for_updates_class="
            "jupyterlab.NeverCheckForUpdate"
        ], tmp_path, r"http://127\.0\.0\.1:(\d+)/lab", environment)
        running.append(lab)
        chromedriver, driven = program(["chromedriver", "--port=0"], tmp_path,
                                       r"started successfully on port (\d+)", environment)
        running.append(chromedriver)
        driver = Driver(f"http://127.0.0.1:{driven[1]}")
        try:
            driver("/url", {"url": f"http://127.0.0.1:{found[1]}/lab/tree/live.ipynb?token=test"})
            wait(lambda: driver.script("return !!window.jupyterapp && "
                                       "!!document.querySelector('.jp-Notebook .jp-Cell')"))
            wait(lambda: driver.script(
                "let w = jupyterapp.shell.currentWidget;"
                "return w && w.sessionContext && w.sessionContext.session && "
                "w.sessionContext.session.kernel && w.sessionContext.session.kernel.status == 'idle'"
            ))
            driver.script("jupyterapp.commands.execute('notebook:run-all-cells')")
            yield driver
        finally:
            if "JUPYTERLAB_PICTURES" in os.environ:
                driver.screenshot(pathlib.Path(os.environ["JUPYTERLAB_PICTURES"]) / "lab.png")
            driver("", method="DELETE")
    finally:
        for one in reversed(running):
            one.terminate()
            one.wait(30)


IMAGE = "document.querySelector('.jp-OutputArea img[src^=blob]')"
TITLE = "document.querySelector('.renderview-wrapper').innerText"
SUM = f"""let image = {IMAGE}, canvas = document.createElement('canvas');
canvas.width = image.naturalWidth; canvas.height = image.naturalHeight;
let context = canvas.getContext('2d');
context.drawImage(image, 0, 0);
return context.getImageData(0, 0, canvas.width, canvas.height).data.reduce((a, b) => a + b, 0)"""


def test_a_view_in_jupyterlab(page, tmp_path):
    wait(lambda: page.script(f"return {IMAGE} ? {IMAGE}.naturalWidth : 0") > 300)
    wait(lambda: "samples: 4" in page.script(f"return {TITLE}"))
    page.script(f"{IMAGE}.scrollIntoView({{block: 'center'}})")
    x, y, width, height = page.script(
        f"let r = {IMAGE}.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]")
    page.pointer((x + width / 2, y + height / 2), "down", "up")
    wait((tmp_path / "touched").exists)
    before = page.script(SUM)
    # near the edge the box is far from the pointer: the drag turns the world
    page.pointer((x + width / 8, y + height / 8), "down", (x + width / 4, y + height / 4), "up")
    wait(lambda: abs(page.script(SUM) - before) > before / 1000)
