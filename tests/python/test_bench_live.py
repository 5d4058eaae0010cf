"""Tests `make bench-live`: the arithmetic of tests/bench/live_flip.py, and whole runs of bench_live at
fixed instants with tiny pictures. A package of the same name stands in for flip-evaluator; it
returns the mean absolute difference."""
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys

import pytest

from conftest import HEADER, ROOT, find_vv, read_ppm

pytest.importorskip("numpy")
pytest.importorskip("PIL.Image")
DRIVER = ROOT / "tests/bench/live_flip.py"
STAND_IN = """import numpy
def evaluate(reference, test, range, applyMagma=True):
    assert range == "LDR" and not applyMagma and reference.shape == test.shape
    assert reference.dtype == numpy.float32 and reference.max() <= 1
    return None, float(numpy.abs(reference - test).mean()), {}
"""
WORLD = HEADER + """NavigationInfo { headlight FALSE } Viewpoint { position 0 1 5 }
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Path PositionInterpolator { key [0 1] keyValue [-1 0 0, 1 0 0] }
Transform { translation 0 3 0 children Shape { geometry Sphere { radius .5 } appearance
  ORTAppearance { shader ORTShader {
    name "Diffuse" file "diffuse" options "color emission 9 8 7" } } } }
Shape { geometry Box { size 6 .1 6 } appearance ORTAppearance { shader ORTShader {
  name "Diffuse" file "diffuse" options "color reflectance .5 .6 .7" } } }
DEF Ball Transform { children Shape { geometry Sphere { radius .4 } appearance
  ORTAppearance { shader ORTShader {
    name "Diffuse" file "diffuse" options "color reflectance .8 .3 .2" } } } }
ROUTE Clock.fraction_changed TO Path.set_fraction ROUTE Path.value_changed TO Ball.set_translation
"""


@pytest.fixture(scope="module")
def stand_in(tmp_path_factory):
    folder = tmp_path_factory.mktemp("packages")
    (folder / "flip_evaluator.py").write_text(STAND_IN)
    return folder


@pytest.fixture(scope="module")
def flip(stand_in):
    """The driver as a module."""
    sys.path.insert(0, str(stand_in))
    try:
        spec = importlib.util.spec_from_file_location("live_flip", DRIVER)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(stand_in))
        sys.modules.pop("flip_evaluator", None)
    return module


@pytest.fixture
def bench(tmp_path):
    program = pathlib.Path(find_vv()).parent / "bench_live"
    if not program.exists():
        pytest.skip("bench_live is not built")
    (tmp_path / "ball.wrl").write_text(WORLD)

    def run(*arguments):
        return subprocess.run([program, *arguments, tmp_path / "ball.wrl"],
                              capture_output=True,
                              text=True,
                              timeout=120)

    run.program = program
    return run


def frame(instant, asked, shown):
    return {"instant": instant, "asked": asked, "shown": shown, "width": 8, "height": 6}


# Arithmetic -------------------------------------------------------------------------------------


def test_times(flip):
    frames = [frame(0, 0.0, 0.02), frame(1, 0.04, 0.06), frame(5, 0.16, 0.20)]
    found = flip.times(frames)
    assert found["rate"] == pytest.approx(2 / 0.18)
    assert found["stall"] == pytest.approx(0.14)
    # 0.04 s of input wait 0.04 s in the mean, and 0.12 s of input 0.10 s
    assert found["latency"] == pytest.approx((0.04 * 0.04 + 0.12 * 0.10) / 0.16)
    assert found["longest_latency"] == pytest.approx(0.16)
    assert flip.times(frames[:1]) == {}


def test_neighbours_are_spread_over_the_run(flip):
    frames = [frame(k, k / 30, (k + 1) / 30) for k in range(0, 120, 2)]
    assert flip.settled(frames, 30)[0]["instant"] == 30
    pairs = [(a["instant"], b["instant"]) for a, b in flip.choose_pairs(frames, 3)]
    assert pairs[-1] == (116, 118) and len(pairs) == 3
    assert all(b - a == 2 for a, b in pairs)
    assert pairs[1][0] - pairs[0][0] == pytest.approx(pairs[2][0] - pairs[1][0], abs=3)
    assert len(flip.choose_pairs(frames[:3], 9)) == 2, "no pair twice"
    assert flip.choose_pairs(frames[:1], 3) == []
    short = [frame(k, k, k) for k in range(8)]
    assert flip.settled(short, 30)[0]["instant"] == 2


def test_small_pictures_are_scaled_as_in_the_window(flip, tmp_path):
    (tmp_path / "a.ppm").write_bytes(b"P6\n2 1\n255\n" + bytes([0, 0, 0, 200, 200, 200]))
    shown = flip.as_shown(tmp_path / "a.ppm", (8, 4), (4, 2))
    assert shown.size == (4, 2)
    row = [shown.getpixel((x, 0))[0] for x in range(4)]
    assert row[0] < 20 and row[3] > 180 and row == sorted(row), "neighbours are interpolated"
    assert 0 < row[1] < row[2] < 200


def test_only_what_is_between_the_marks_changes(flip, tmp_path):
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- bench-live -->\nold\n<!-- /bench-live -->\nafter\n")
    flip.put_between_marks(page, "new\n")
    assert page.read_text() == "before\n<!-- bench-live -->\nnew\n<!-- /bench-live -->\nafter\n"


@pytest.mark.parametrize("name", ["benchmarks.md", "window.md"])
def test_the_pages_have_marks(name):
    text = (ROOT / "docs" / name).read_text()
    assert text.count("<!-- bench-live -->\n") == 1 == text.count("<!-- /bench-live -->\n")


def test_a_missing_package_is_named(tmp_path):
    (tmp_path / "flip_evaluator.py").write_text("raise ImportError('No module flip_evaluator')")
    done = subprocess.run([sys.executable, DRIVER],
                          capture_output=True,
                          text=True,
                          env={
                              **os.environ, "PYTHONPATH": str(tmp_path)
                          })
    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert "pip install --target FOLDER flip-evaluator" in done.stderr


# Whole runs -------------------------------------------------------------------------------------


def shows(bench, folder, *options):
    folder.mkdir()
    done = bench(f"--show={folder}", "--size=64x48", "--steps=5", "--frame=32x24x1", *options)
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "frames.json").read_text())


def test_pictures_at_fixed_instants(bench, tmp_path):
    facts = shows(bench, tmp_path / "a", "--speed=0.8")
    assert [f["instant"] for f in facts["frames"]] == [0, 1, 2, 3, 4]
    assert all((f["width"], f["height"]) == (32, 24) for f in facts["frames"])
    assert facts["still"]["instant"] == 4 and facts["still"]["samples"] == 4
    assert read_ppm((tmp_path / "a/still.ppm").read_bytes())[:2] == (64, 48)
    pictures = [(tmp_path / f"a/000{k}.ppm").read_bytes() for k in range(5)]
    assert len(set(pictures)) == 5, "camera and world move"
    shows(bench, tmp_path / "b", "--speed=0.8", "--threads=1")
    for k in range(5):
        assert (tmp_path / f"b/000{k}.ppm").read_bytes() == pictures[k], "nothing depends on time"
    assert (tmp_path / "b/still.ppm").read_bytes() == (tmp_path / "a/still.ppm").read_bytes()


def test_converged_pictures_show_the_same_instants(bench, tmp_path):
    shows(bench, tmp_path / "a", "--raw", "--speed=0.8", "--still=64")
    (tmp_path / "true").mkdir()
    done = bench(f"--converge={tmp_path / 'true'}", "--size=64x48", "--speed=0.8", "--at=4,0",
                 "--spp=64", "--error=0")
    assert done.returncode == 0, done.stderr
    assert sorted(p.name for p in (tmp_path / "true").iterdir()) == ["0000.ppm", "0004.ppm"]
    true = (tmp_path / "true/0004.ppm").read_bytes()
    assert true != (tmp_path / "true/0000.ppm").read_bytes()
    assert true == (tmp_path / "a/still.ppm").read_bytes(), "a still picture of as many samples"


def test_what_cannot_be_done_is_said(bench, tmp_path):
    done = bench("--show=" + str(tmp_path / "nowhere"), "--size=64x48", "--steps=2")
    assert done.returncode == 1 and "nowhere" in done.stderr
    done = bench(f"--show={tmp_path}", "--steps=2", "another.wrl")
    assert done.returncode == 2 and "one world" in done.stderr
    done = bench(f"--show={tmp_path}", "--steps=2", "--frame=0x4")
    assert done.returncode == 2 and "--frame" in done.stderr


@pytest.mark.parametrize("mode", [[], ["--show=.", "--steps=1"], ["--converge=.", "--at=0"]])
def test_a_missing_world_is_named_in_one_line(bench, tmp_path, mode):
    (tmp_path / "ball.wrl").unlink()
    done = bench(*mode)
    assert done.returncode == 1
    assert re.fullmatch(r"bench_live: \S*ball\.wrl: error: .*\n", done.stderr), done.stderr


def test_a_whole_run(bench, stand_in, tmp_path):

    def run():
        return subprocess.run([
            sys.executable, DRIVER, "--bench", bench.program, "--out", tmp_path / "out", "--worlds",
            f"{tmp_path / 'ball.wrl'},nowhere", "--steps", "8", "--frame", "32x24", "--size",
            "64x48", "--compare", "32x24", "--pairs", "2", "--reference-spp", "32", "--strip",
            tmp_path / "strips"
        ],
                              capture_output=True,
                              text=True,
                              timeout=300,
                              env={
                                  **os.environ, "PYTHONPATH": str(stand_in)
                              })

    done = run()
    assert done.returncode == 0, done.stderr
    assert "nowhere: not here, left out" in done.stdout
    rows = json.loads((tmp_path / "out/live.json").read_text())
    assert [(r["world"], r["turn"]) for r in rows] == [("ball", "slow"), ("ball", "fast")]
    for row in rows:
        assert row["noise"] < row["raw"]["flip"], "the true pictures are better than the raw ones"
        assert row["still"] < row["raw"]["flip"], "a still picture is better, too"
        assert row["raw"]["size"] == row["rebuilt"]["size"] == "32x24"
        assert "rate" not in row["raw"] and row["raw"]["flicker"] > 0
        assert row["previews"], "bench_live asks for previews"
        # The world has little noise, and the pictures are tiny.
        assert row["rebuilt"]["flip"] < 1.5 * row["raw"]["flip"]
    assert (tmp_path / "out/live.md").read_text() in done.stdout
    from PIL import Image
    with Image.open(tmp_path / "strips/live-ball.png") as strip:
        assert strip.size == (960, 480)
    kept = {p: p.stat().st_mtime_ns for p in (tmp_path / "out/references").rglob("*.ppm")}
    again = run()
    assert again.returncode == 0 and "converged pictures\n" not in again.stdout
    assert {p: p.stat().st_mtime_ns for p in kept} == kept, "true pictures are kept"
    assert json.loads((tmp_path / "out/live.json").read_text()) == rows, "nothing depends on time"
