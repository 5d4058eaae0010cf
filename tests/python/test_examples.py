"""Runs the programs in examples/python that use the package as a user would."""
import math
import os
import pathlib
import re
import subprocess
import sys

import pytest

pytest.importorskip("numpy")
pytest.importorskip("xvrml")
ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples/python"


def run(name, *arguments, folder):
    done = subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)],
                          cwd=folder,
                          capture_output=True,
                          text=True,
                          timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_world_is_built_and_a_depth_camera_sees_it(tmp_path):
    run("build_world.py", tmp_path, folder=tmp_path)
    assert (tmp_path / "spiral.png").read_bytes().startswith(b"\x89PNG")
    told = run("depth_camera.py", "spiral.wrl", folder=tmp_path)
    assert "of the rays meet" in told and "@" in told


def test_a_film(tmp_path, box):
    run("film.py", box, tmp_path, "0.3", folder=tmp_path)
    assert sorted(
        p.name for p in tmp_path.glob("frame*.png")) == [f"frame{n:04}.png" for n in range(3)]


def test_hidden_lines(tmp_path, box):
    told = run("hidden_lines.py", box, tmp_path / "box.svg", folder=tmp_path)
    assert told.startswith("12 edges, 33%"), told
    ends = re.findall(r'd="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)"',
                      (tmp_path / "box.svg").read_text())
    assert len(ends) == 4 * 32
    focal = 300 / math.tan(math.pi / 8)  # the angle of view is 45 degrees
    length = 0.0
    for x, y, u, v in (map(float, line) for line in ends):
        length += math.hypot(u - x, v - y)
        for column, row in ((x, y), (u, v)):  # on the outline of the front of the box
            side = max(abs(column - 399.5), abs(row - 299.5))
            assert abs(side - focal / 4) < 0.02
    assert abs(length - 4 * focal / 2) < 0.5


def test_the_bare_renderer(tmp_path):
    run("bare_renderer.py", "torus.png", folder=tmp_path)
    assert os.path.getsize(tmp_path / "torus.png") > 5000
