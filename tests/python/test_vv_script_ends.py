"""Tests that a world whose Scripts make worlds with Scripts ends cleanly, whatever ends it: the last
picture, an interrupt, another world, the death of the process of its programs."""
import os
import pathlib
import signal
import time

import pytest

from conftest import HEADER
from control_server import PATIENCE, SMALL, start  # noqa: F401

# At every tick the Script makes an Inline of the world itself; its handles then hold the last
# references to other Scripts.
WORLD = HEADER + """
DEF T TimeSensor { loop TRUE } DEF X Transform { } Shape { geometry Box { } }
DEF S Script { directOutput TRUE field SFNode x USE X eventIn SFFloat f url "javascript:
  var kept = [];
  function f() {
    x.children = Browser.createVrmlFromString('Inline { url \\"ends.wrl\\" }');
    kept.push(x.children);
  }" }
ROUTE T.fraction_changed TO S.f
"""


@pytest.fixture
def ends(vv):
    vv.write("ends.wrl", WORLD)
    return vv


def helpers(parent):
    """Returns the processes below a process that run programs of Scripts."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            name, rest = stat.read_text().rsplit(")", 1)
        except OSError:
            continue
        if int(rest.split()[1]) == parent and "script" in name:
            found.append(int(stat.parent.name))
    return found


def test_after_the_last_picture(ends):
    for moment in (0.1, 0.3, 1):
        done = ends("ends.wrl", "-o", "x.png", "--time", moment, "--fps", 10, *SMALL)
        assert done.returncode == 0, (moment, done.talk)


def test_at_an_interrupt_of_a_server(ends):
    served = ends.start("serve", "ends.wrl", "--port", 0)
    try:
        assert b"http" in served.stdout.readline()
        time.sleep(.5)
        served.send_signal(signal.SIGINT)
        assert served.wait(PATIENCE) == 0, served.stderr.read()
    finally:
        served.kill()
        served.communicate()


def test_when_another_world_takes_its_place(start, ends):
    for _ in range(2):
        server = start(ends.folder / "ends.wrl")
        client = server.connect()
        client.time(paused=True)
        for _ in range(3):
            client.time(skip=0.1)
        client.load("box.wrl")
        client.load("ends.wrl")
        client.time(paused=True)
        client.time(skip=0.1)
        client.quit()
        assert server.program.wait(PATIENCE) == 0, server.err


def test_when_the_process_of_its_programs_dies(start, ends):
    server = start(ends.folder / "ends.wrl")
    client = server.connect()
    client.time(paused=True)
    for _ in range(3):
        client.time(skip=0.1)
        for process in helpers(server.program.pid)[:1]:
            os.kill(process, signal.SIGKILL)
    client.time(skip=0.1)
    client.quit()
    assert server.program.wait(PATIENCE) == 0, server.err
