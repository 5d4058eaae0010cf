"""Measures the delay of a stream of joints: 100 steps a second of twelve joints. A test of wall-clock
time, which ctest runs apart from the others (label timed)."""
import time

import pytest

from conftest import HEADER, find_vv
from control_server import Server

JOINTS = [f"J{k}" for k in range(12)]
WORLD = HEADER + "".join(f"""
DEF {name} Transform {{ children Shape {{ geometry Box {{ size .1 .1 .1 }} }} }}"""
                         for name in JOINTS)

RATE, SECONDS, LIMIT = 100, 2, .05


def test_a_stream_of_joints_arrives_at_once(tmp_path):
    if not find_vv().exists():
        pytest.skip("vv is not built")
    (tmp_path / "world.wrl").write_text(WORLD)
    server = Server(tmp_path, "world.wrl", "--size", "160x120")
    try:
        vv, reader = server.connect(), server.connect()
        vv.render(samples=1)  # the world has been read
        seen = []
        reader.subscribe("J11", "rotation", lambda value, time: seen.append(value[3]))
        start = time.monotonic()
        steps = RATE * SECONDS
        for step in range(steps):
            vv.set_many([(name, "rotation", (0, 0, 1, (step + 1) / 1000)) for name in JOINTS],
                        quiet=True)
            sent = time.monotonic()
            if step + 1 < steps:
                time.sleep(max(0, start + (step + 1) / RATE - time.monotonic()))
        while reader.get("J11", "rotation")[3] != steps / 1000:
            assert time.monotonic() - sent < 10
        delay = time.monotonic() - sent
        assert delay < LIMIT, delay
        reader.poll()
        assert seen == [(step + 1) / 1000 for step in range(steps)]  # none was lost
    finally:
        server.end()
