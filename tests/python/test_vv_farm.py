"""Tests --jobs and --missing of vv: films on farms (docs/farms.md)."""
import re
import shlex
import shutil
import struct
import subprocess
import zlib

import pytest
from conftest import HEADER

# A room with a lamp comes around the viewer after one second. Before, there is nothing to draw.
WORLD = HEADER + """Viewpoint { position 0 0 4 }
NavigationInfo { headlight FALSE }
DEF T TimeSensor { cycleInterval 2 loop TRUE }
DEF I PositionInterpolator { key [ 0, .5, .5, 1 ] keyValue [ 900 0 0, 900 0 0, 0 0 0, .1 0 0 ] }
DEF P Transform { children [
  Shape { appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options "color reflectance .9 .9 .9" } }
    geometry IndexedFaceSet { solid FALSE
      coord Coordinate { point [ -5 -5 -5, 5 -5 -5, 5 5 -5, -5 5 -5, -5 -5 5, 5 -5 5, 5 5 5, -5 5 5 ] }
      coordIndex [ 0 1 2 3 -1 4 5 6 7 -1 0 1 5 4 -1 2 3 7 6 -1 0 3 7 4 -1 1 2 6 5 ] } }
  Shape { appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" options "color emission 5 5 5" } }
    geometry Sphere { radius .3 } } ] }
ROUTE T.fraction_changed TO I.set_fraction
ROUTE I.value_changed TO P.set_translation
"""
FILM = ("--size", "32x24", "--spp", "2", "-o", "f-{frame:3}.png")


def jobs_of(vv, *options):
    done = vv("film.wrl", *FILM, *options)
    assert done.returncode == 0, done.talk
    return done.text.splitlines()


def ranges(lines):
    found = [re.search(r"--frames (\d+)-(\d+)(?:/(\d+))?$", line) for line in lines]
    return [tuple(int(n or 1) for n in match.groups()) for match in found]


@pytest.fixture
def film(vv):
    vv.write("film.wrl", WORLD)
    return vv


def run(vv, line):
    done = subprocess.run(["sh", "-c", line], cwd=vv.folder, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr


def test_jobs_cover_the_film_and_make_its_pictures(film):
    lines = jobs_of(film, "--frames", "0-59", "--jobs", "5")
    assert not list(film.folder.glob("*.png"))
    parts = ranges(lines)
    assert 1 <= len(parts) <= 5 and parts[0][0] == 0 and parts[-1][1] == 59
    assert all(a[1] + 1 == b[0] for a, b in zip(parts, parts[1:]))
    assert all(shlex.split(line)[0] == str(film.program) for line in lines)
    for line in lines[-1:]:
        run(film, line)
    made = {path.name: path.read_bytes() for path in film.folder.glob("f-*.png")}
    assert set(made) == {f"f-{n:03}.png" for n in range(parts[-1][0], 60)}
    assert film("film.wrl", *FILM, "--frames", "0-59").returncode == 0
    assert all((film.folder / name).read_bytes() == data for name, data in made.items())


def test_a_dear_half_gets_more_jobs(film):
    parts = ranges(jobs_of(film, "--frames", "0-59", "--jobs", "8", "--size", "128x96", "--spp", "16"))
    assert sum(first >= 28 for first, *_ in parts) > len(parts) / 2


def test_steps_stay(film):
    parts = ranges(jobs_of(film, "--frames", "3-33/3", "--jobs", "3"))
    assert all(step == 3 and first % 3 == 0 and last % 3 == 0 for first, last, step in parts)


def test_missing_makes_what_is_absent_or_damaged(film):
    assert film("film.wrl", *FILM, "--frames", "0-6").returncode == 0
    files = [film.folder / f"f-{n:03}.png" for n in range(7)]
    whole = [file.read_bytes() for file in files]
    files[1].unlink()
    files[2].write_bytes(whole[2][:-5])
    files[3].write_bytes(b"")
    files[5].write_bytes(whole[5][:60] + bytes([whole[5][60] ^ 1]) + whole[5][61:])
    stamps = [file.stat().st_mtime_ns for file in (files[0], files[4], files[6])]
    lines = jobs_of(film, "--frames", "0-6", "--missing", "--jobs", "1")
    assert ranges(lines) == [(1, 5, 1)] and "--missing" in lines[0]
    run(film, lines[0])
    assert [file.read_bytes() for file in files] == whole
    assert stamps == [file.stat().st_mtime_ns for file in (files[0], files[4], files[6])]
    done = film("film.wrl", *FILM, "--frames", "0-6", "--missing")
    assert done.returncode == 0 and "no frame is missing" in done.talk
    assert jobs_of(film, "--frames", "0-6", "--missing", "--jobs", "3", "-q") == []


@pytest.mark.parametrize("suffix", ["exr", "jpg", "ppm", "pfm"])
def test_damage_is_found_in_every_format(film, suffix):
    options = ("--size", "16x12", "--spp", "1", "--frames", "0-1", "-o", "g-{frame}." + suffix)
    assert film("film.wrl", *options).returncode == 0
    again = film("film.wrl", *options, "--missing")
    assert "no frame is missing" in again.talk, again.talk
    file = film.folder / f"g-1.{suffix}"
    whole = file.read_bytes()
    file.write_bytes(whole[:-20])
    assert film("film.wrl", *options, "--missing").returncode == 0
    assert file.read_bytes() == whole


def test_missing_makes_what_an_interrupt_cut_short(film):
    assert film("film.wrl", *FILM, "--frames", "0-2").returncode == 0
    whole = [file.read_bytes() for file in sorted(film.folder.glob("*.png"))]
    file = sorted(film.folder.glob("*.png"))[1]
    text = b"tEXtComment\0unfinished: saved before it had all samples"
    chunk = struct.pack(">I", len(text) - 4) + text + struct.pack(">I", zlib.crc32(text))
    file.write_bytes(whole[1][:33] + chunk + whole[1][33:])  # behind IHDR
    assert film("film.wrl", *FILM, "--frames", "0-2", "--missing").returncode == 0
    assert [file.read_bytes() for file in sorted(film.folder.glob("*.png"))] == whole


def test_what_cannot_be_cut_is_refused(film):
    for options, text in ((("--jobs", "2"), "--jobs needs --frames"),
                          (("--missing",), "--missing needs --frames"),
                          (("--frames", "0-9", "--jobs", "0"), "0"),
                          (("--frames", "0-9", "--jobs", "2", "--exposure", "auto"), "first picture of a run"),
                          (("--frames", "0-9", "--missing", "--exposure", "auto"), "give a number"),
                          (("--frames", "0-9", "--jobs", "2", "-o", "x.gif"), "film")):
        done = film("film.wrl", *FILM, *options)
        assert done.returncode == 2 and text in done.talk, done.talk
    done = film("-", *FILM, "--frames", "0-9", "--jobs", "2", stdin=WORLD.encode())
    assert done.returncode == 2 and "standard input" in done.talk


def test_jobs_run_in_gnu_parallel(film):
    if not shutil.which("parallel"):
        pytest.skip("parallel is not installed")
    lines = jobs_of(film, "--frames", "0-7", "--jobs", "4")
    done = subprocess.run(["parallel", "--jobs", "2"], cwd=film.folder, timeout=120,
                          input="\n".join(lines).encode(), capture_output=True)
    assert done.returncode == 0, done.stderr
    assert len(list(film.folder.glob("f-*.png"))) == 8


def test_jobs_run_in_a_shell_with_xargs(film):
    lines = jobs_of(film, "--frames", "0-7", "--jobs", "4")
    (film.folder / "jobs.txt").write_text("\n".join(lines) + "\n")
    run(film, "xargs -d '\\n' -n 1 -P 2 sh -c < jobs.txt")
    assert len(list(film.folder.glob("f-*.png"))) == 8


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_pictures_are_joined_to_the_film_that_vv_makes(film, suffix):
    made = film("film.wrl", *FILM, "-o", "direct." + suffix, "--frames", "25-35")
    if "ffmpeg" in made.talk:
        pytest.skip("this build writes no " + suffix)
    assert made.returncode == 0, made.talk
    pictures = sorted(path.name for path in film.folder.glob("f-*.png"))
    done = film("film", "--join", *pictures, "-o", "joined." + suffix)
    assert done.returncode == 0 and "joined 11 pictures" in done.talk, done.talk
    direct, joined = ((film.folder / f"{name}.{suffix}").read_bytes() for name in ("direct", "joined"))
    assert len(direct) > 100 and direct == joined


def test_what_cannot_be_joined_is_refused(film):
    assert film("film.wrl", *FILM, "--frames", "0-1").returncode == 0
    assert film("film.wrl", *FILM, "--size", "8x8", "--frames", "2").returncode == 0
    (film.folder / "bad.png").write_bytes(b"no picture")
    names = [f"f-{n:03}.png" for n in range(3)]
    for words, code, text in ((names, 3, "f-002.png has 8x8 pixels, but f-000.png has 32x24"),
                              ([names[0], "bad.png"], 3, "bad.png"), ([names[0], "none.png"], 3, "none.png"),
                              ([], 2, "vv film --join")):
        done = film("film", "--join", *words, "-o", "x.gif")
        assert done.returncode == code and text in done.talk, done.talk
    assert not (film.folder / "x.gif").exists()
    own = film("film", "--join", names[0], names[1], "-o", "a.gif")
    assert own.returncode == 0
    again = film("film", "--join", "a.gif", "-o", "a.gif")
    assert again.returncode and "a picture of vv film" in again.talk, again.talk
    assert film("film", "--join", names[0], "-o", "x.png").returncode == 2
    assert film("film", "--join", names[0], "-o", "x.gif", "--spp", "4").returncode == 2
    assert film("film", names[0], "-o", "x.gif").returncode == 2
    assert film("film.wrl", "--join").returncode == 2
