"""Tests that tools/make_scenes.py writes the worlds that are checked in."""
import gzip
import json
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_scenes_are_as_written(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools/make_scenes.py", tmp_path], check=True)
    made = sorted(tmp_path.iterdir())
    assert len(made) > 10
    for world in made:
        here, there = world.read_bytes(), (ROOT / "examples/scenes" / world.name).read_bytes()
        if world.suffix == ".wrz":  # another version of zlib may compress differently
            here, there = gzip.decompress(here), gzip.decompress(there)
        if world.suffix != ".png":
            assert here == there, world.name


@pytest.mark.parametrize("name", ["headlight_studio.wrl", "car.wrz", "globe.wrl"])
def test_large_scenes_have_no_problems(vv, name):
    done = vv(ROOT / "examples/scenes" / name, "--check")
    assert done.returncode == 0, done.talk


def test_the_headlight_is_as_large_as_it_says(vv):
    totals = json.loads(
        vv(ROOT / "examples/scenes/headlight_studio.wrl", "--explain", "--json").text)["totals"]
    assert 780_000 < totals["triangles"] < 800_000


def test_chessmen_share_their_forms_and_stand_on_their_squares(vv):
    scene = ROOT / "examples/scenes/chess.wrl"
    totals = json.loads(vv(scene, "--explain", "--json").text)["totals"]
    assert totals["instanced_triangles"] > 5 * totals["triangles"]
    text = scene.read_text()
    for file, letter in enumerate("abcdefgh"):
        for rank, z in ((1, "3.5"), (2, "2.5"), (7, "-2.5"), (8, "-3.5")):
            assert f"DEF Piece_{letter}{rank} Transform {{ translation {file - 3.5:g} 0 {z} " in text
