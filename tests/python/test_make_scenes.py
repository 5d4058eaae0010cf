"""The worlds that tools/make_scenes.py writes are those that are checked in."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def test_scenes_are_as_written(tmp_path):
    subprocess.run([sys.executable, ROOT / "tools/make_scenes.py", tmp_path], check=True)
    made = sorted(tmp_path.iterdir())
    assert len(made) > 10
    for world in (m for m in made if m.suffix == ".wrl"):
        assert world.read_bytes() == (ROOT / "examples/scenes" / world.name).read_bytes(), world.name
