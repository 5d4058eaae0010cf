"""The worlds that tools/make_scenes.py writes are those that are checked in."""
import gzip
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_scenes_are_as_written(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools/make_scenes.py", tmp_path], check=True)
    made = sorted(tmp_path.iterdir())
    assert len(made) > 10
    for world in made:
        here, there = world.read_bytes(), (ROOT / "examples/scenes" / world.name).read_bytes()
        if world.suffix == ".wrz":  # zlib may pack otherwise elsewhere
            here, there = gzip.decompress(here), gzip.decompress(there)
        if world.suffix != ".png":
            assert here == there, world.name
