"""An X server for tests with windows: Xvfb on a display that it chooses itself. Tests are skipped
if it is not installed."""
import contextlib
import os
import shutil
import subprocess

import pytest


@contextlib.contextmanager
def display(size="1024x768", *options):
    """Runs Xvfb, with these additional options; $DISPLAY names it meanwhile."""
    if not shutil.which("Xvfb"):
        pytest.skip("Xvfb is not installed")
    reading, writing = os.pipe()
    server = subprocess.Popen([
        "Xvfb", "-displayfd",
        str(writing), "-screen", "0", f"{size}x24", "-nolisten", "tcp", *options
    ],
                              pass_fds=[writing],
                              stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    os.close(writing)
    before = os.environ.get("DISPLAY")
    try:
        with os.fdopen(reading) as answer:
            number = answer.readline().strip()
        if not number:
            pytest.skip("Xvfb does not start")
        os.environ["DISPLAY"] = f":{number}"
        yield os.environ["DISPLAY"]
    finally:
        if before is None:
            os.environ.pop("DISPLAY", None)
        else:
            os.environ["DISPLAY"] = before
        server.terminate()
        server.wait(20)
