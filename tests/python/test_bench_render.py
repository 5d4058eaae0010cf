"""Tests tools/bench_render.py: its arithmetic on made pictures, its worlds, and whole runs with
tiny pictures."""
import array
import math
import pathlib
import random
import statistics
import subprocess
import sys

import pytest

from conftest import HEADER, find_vv

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from rendering import automatic, errors, report, worlds  # noqa: E402

SIZE = 3 * 20000
TRUTH = [0.1 + (k % 97) / 40 for k in range(SIZE)]


def noisy(seed, sigma, truth=TRUTH):
    """Returns a picture with noise of a known variance."""
    rng = random.Random(seed)
    return array.array("f", [t + rng.gauss(0, sigma) for t in truth])


def relative(sigma):
    """Returns the relMSE of noise with the same variance everywhere."""
    return sigma**2 * errors.mean([1 / (t * t + 0.01) for t in TRUTH])


@pytest.mark.parametrize("sigma", [0.05, 0.02, 0.01])
def test_the_noise_of_the_reference_is_subtracted(sigma):
    halves = noisy(1, 0.02), noisy(2, 0.02)
    reference = errors.Reference(*halves)
    assert reference.noise[0] == pytest.approx(0.02**2 / 2, rel=0.05)
    assert reference.noise[1] == pytest.approx(relative(0.02) / 2, rel=0.1)
    mse, relmse = reference.errors(noisy(3, sigma))
    assert mse == pytest.approx(sigma**2, rel=0.1)
    assert relmse == pytest.approx(relative(sigma), rel=0.15)


def test_errors_below_the_noise_are_not_reported():
    reference = errors.Reference(noisy(1, 0.02), noisy(2, 0.02))
    good = errors.Measured(reference, [noisy(seed, 0.002) for seed in (3, 4)])
    assert math.isnan(good.rmse) and math.isnan(good.relmse)
    known = errors.Measured(reference, [noisy(seed, 0.05) for seed in (3, 4)])
    assert known.rmse == pytest.approx(0.05, rel=0.05)
    assert known.relmse_interval < known.relmse


def test_bias_is_found_and_has_an_interval():
    reference = errors.Reference(noisy(1, 0.02), noisy(2, 0.02))
    fair = errors.Measured(reference, [noisy(seed, 0.05) for seed in range(3, 8)])
    assert abs(fair.bias) < 2 * fair.bias_interval < 0.002
    dark = [0.98 * t for t in TRUTH]
    dim = errors.Measured(reference, [noisy(seed, 0.05, dark) for seed in range(3, 8)])
    assert dim.bias == pytest.approx(-0.02, abs=0.001) and -dim.bias > dim.bias_interval


def test_errors_at_a_time_follow_a_power_law_between_measurements():
    curve = [(0.1, 0.5), (0.4, 0.125), (1.6, 0.125 / 16)]
    assert errors.at_time(curve, 0.2) == pytest.approx(0.25)
    assert errors.at_time(curve, 0.8) == pytest.approx(0.125 / 4)
    assert errors.at_time(curve, 0.1) == pytest.approx(0.5)
    assert errors.at_time(curve, 2) is None and errors.at_time(curve, 0.05) is None
    assert errors.at_time([(0.1, math.nan), (1, 0.5)], 0.5) is None


def test_ratios_of_two_programs():
    old = [1.0, 2.0, 3.0, 4.0]
    assert errors.ratio_of_means([v / 2 for v in old], old) == pytest.approx((0.5, 1))
    rng = random.Random(7)
    inside = 0
    for _ in range(200):
        shared = [rng.uniform(1, 2) for _ in range(9)]
        new = [0.9 * v * rng.uniform(0.95, 1.05) for v in shared]
        ratio, factor = errors.ratio_of_means(new, shared)
        inside += ratio / factor <= 0.9 <= ratio * factor
    assert inside > 175, "the interval holds the truth in about 95 % of the trials"
    fireflies = [1.0, 1.0, 1.0, 1.0, 21.0]
    ratio, factor = errors.ratio_of_means(fireflies, [1.0] * 5)
    assert statistics.median(fireflies) == 1 and ratio == 5 and factor > 2


def row(renderer, seconds, relmse):
    return {
        "world": "w",
        "title": "World",
        "renderer": renderer,
        "spp": 4,
        "startup": 0.1,
        "seconds": seconds,
        "rmse": math.sqrt(relmse),
        "relmse": relmse,
        "relmse_interval": 0.0,
        "product": seconds * relmse,
        "bias": 0.0,
        "bias_interval": 0.01
    }


def test_the_table_compares_at_equal_time(tmp_path):
    rows = [row("path", 0.5, 0.04), row("path", 2, 0.01), row(report.PEER, 0.25, 0.16),
            row(report.PEER, 4, 0.01)]  # yapf: disable
    _, _, ours, theirs = report.table(rows).splitlines()
    cells = [c.strip() for c in ours.strip("|").split("|")]
    assert cells[:6] == ["World", "path", "0.1", "-", "0.02", "-"]
    assert cells[8] == "2", "Mitsuba has twice the error after one second"
    assert theirs.split("|")[9].strip() == "-"
    text, names = report.write(rows, tmp_path, True)
    assert len(names) == 2 and report.table(report.read_csv(tmp_path / "render.csv")) == text
    page = tmp_path / "page.md"
    page.write_text("before\n<!-- bench-render -->\nold\n<!-- /bench-render -->\nafter\n")
    (tmp_path / "images").mkdir()
    report.into_page(page, text, names, tmp_path)
    assert "old" not in page.read_text() and page.read_text().endswith("-->\nafter\n")
    assert all((tmp_path / "images" / name).exists() for name in names)


def test_auto_is_compared_with_the_better_transport(tmp_path):
    rows = []
    for name, error in (("light", 0.04), ("path", 0.01), ("auto", 0.012)):
        rows += [row(name, .25, 4 * error), row(name, 4, error / 4)]
    time, found, mean, largest = automatic.compare(rows, "w")
    assert time == 4 and found == {"light": 0.01, "path": 0.0025, "auto": 0.003}
    assert mean == pytest.approx(1.2) and largest == pytest.approx(1.2)
    text, names = automatic.write(rows, tmp_path)
    cells = [c.strip() for c in text.splitlines()[2].strip("|").split("|")]
    assert cells == ["World", "4", "0.01", "0.0025", "0.003", "1.2", "1.2"]
    assert names == ["bench_transports_w_relmse.svg"] and (tmp_path / names[0]).exists()
    apart = [row("light", 1, 1), row("auto", 2, 1)]
    assert automatic.compare(apart, "w") is None
    assert "| World | - | - | - | - | - |" in automatic.table(apart)


@pytest.mark.parametrize("name", [n for n, w in worlds.WORLDS.items() if w.write])
def test_written_worlds_have_no_problems(vv, tmp_path, name):
    file = worlds.find(name, tmp_path)[2]
    done = vv(file, "--check")
    assert done.returncode == 0 and b"0 errors, 0 warnings" in done.stdout + done.stderr, done.talk


def test_unknown_worlds_are_named(tmp_path):
    assert len(worlds.WORLDS) >= 8
    with pytest.raises(SystemExit, match="nowhere is neither a file nor one of cornell"):
        worlds.find("nowhere", tmp_path)


def bench(folder, *options):
    world = folder / "lamp.wrl"
    world.write_text(HEADER + """NavigationInfo { headlight FALSE } Viewpoint { position 0 1 5 }
      Transform { translation 0 3 0 children Shape { geometry Sphere { radius .5 } appearance
        ORTAppearance { shader ORTShader {
          name "Diffuse" file "diffuse" options "color emission 9 8 7" } } } }
      Shape { geometry Box { size 6 .1 6 } appearance ORTAppearance { shader ORTShader {
        name "Diffuse" file "diffuse" options "color reflectance .5 .6 .7" } } }""")
    return subprocess.run([
        sys.executable, ROOT / "tools/bench_render.py", "--out", folder / "out", "--worlds", world,
        "--size", "32x24", "--reference", "1", "--picture", ".3", "--mitsuba", "nothing", "--vv",
        find_vv(), *options
    ],
                          capture_output=True,
                          text=True,
                          timeout=120)


def test_a_whole_run(vv, tmp_path):
    done = bench(tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Mitsuba 3 is not installed here" in done.stdout
    rows = report.read_csv(tmp_path / "out/render.csv")
    assert {(r["world"], r["renderer"]) for r in rows} == {("lamp", "auto")}
    assert all(r["seconds"] > 0 and r["startup"] > 0 for r in rows)
    assert all(r["relmse"] > 0 for r in rows[:-1]), "only the last row may be too good to judge"
    kept = {p: p.stat().st_mtime_ns for p in (tmp_path / "out/references").iterdir()}
    assert len(kept) == 2
    assert bench(tmp_path).returncode == 0
    assert {p: p.stat().st_mtime_ns for p in kept} == kept, "the reference is kept"
    again = bench(tmp_path, "--again")
    assert again.returncode == 0 and "lamp" in (tmp_path / "out/render.md").read_text()


def test_a_run_of_transports(vv, tmp_path):
    done = bench(tmp_path, "--transports", "path,light,auto")
    assert done.returncode == 0, done.stderr
    rows = report.read_csv(tmp_path / "out/transports.csv")
    assert {r["renderer"] for r in rows} == {"path", "light", "auto"}
    assert "auto / best" in (tmp_path / "out/transports.md").read_text()
    assert "Mitsuba" not in done.stdout


def test_two_binaries_take_turns(vv, tmp_path):
    equal = bench(tmp_path, "--binaries", find_vv(), find_vv(), "--rounds", "2", "--spp", "8")
    assert equal.returncode == 0, equal.stderr
    assert "same bytes" in equal.stdout
    missing = bench(tmp_path, "--binaries", "no/such/vv", find_vv())
    assert missing.returncode == 1 and missing.stderr == (
        "bench_render.py: no/such/vv does not start: No such file or directory\n")
    darker = f"{find_vv()} --depth 0"
    other = bench(tmp_path, "--binaries", find_vv(), darker, "--rounds", "3", "--spp", "8")
    assert other.returncode == 0, other.stderr
    line = next(l for l in other.stdout.splitlines() if l.startswith("| lamp"))
    assert "same bytes" not in line
    assert float(line.split("|")[-2].split()[0]) < 0.9, "light is lost, and the table shows it"
