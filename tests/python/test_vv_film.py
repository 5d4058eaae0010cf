"""Tests films of previews: a frame is a function of its number, whichever part of the film is made,
by whichever machine; --denoise filters them, too, and says so."""
import json
import re
import subprocess

import pytest

from cluster_tools import addresses, workers
from conftest import exr_channels, find_vv
from test_vv_denoise import library, made, usable  # noqa: F401  fixtures
from test_vv_denoiser import NAME, fake  # noqa: F401  a fixture
from test_vv_preview import ROLLING, bytes_of, distance, without_note

SMALL = ("--size", "32x24", "--spp", "2", "--preview")
LAST = 19


@pytest.fixture
def rolling(vv):
    vv.write("rolling.wrl", ROLLING)
    return vv


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Returns the files of a film by the number of the frame."""
    if not find_vv().exists():
        pytest.skip("vv is not built")
    folder = tmp_path_factory.mktemp("whole")
    (folder / "rolling.wrl").write_text(ROLLING)
    done = subprocess.run([
        find_vv(), "rolling.wrl", *SMALL, "--frames", f"0-{LAST}", "-o", "f-{frame:3}.ppm", "-q"
    ],
                          cwd=folder,
                          capture_output=True,
                          check=False)
    assert done.returncode == 0, done.stderr
    return {n: (folder / f"f-{n:03}.ppm").read_bytes() for n in range(LAST + 1)}


def files(vv, name="f"):
    return {
        int(path.stem.rsplit("-", 1)[1]): path.read_bytes()
        for path in vv.folder.glob(f"{name}-*.ppm")
    }


def film(vv, frames, *options):
    """Makes frames; returns their files by number."""
    for path in vv.folder.glob("f-*.ppm"):
        path.unlink()
    made(vv, "--frames", frames, "-o", "f-{frame:3}.ppm", *options, world="rolling.wrl", size=SMALL)
    return files(vv)


# A frame is what it is --------------------------------------------------------------------------


@pytest.mark.parametrize("frames", ["0", "7", "8", "17", "3-5", "15-16", "0-19/5", "1-19/9"])
def test_a_part_has_the_bytes_of_the_film(rolling, whole, frames):
    part = film(rolling, frames)
    assert part
    for number, data in part.items():
        assert data == whole[number], number


def test_only_the_frames_that_are_asked_for_are_written(rolling):
    assert sorted(film(rolling, "4-6", "--stats", "s.json")) == [4, 5, 6]
    assert len(json.loads((rolling.folder / "s.json").read_text())["frames"]) == 3


def test_threads_do_not_count(rolling, whole):
    assert film(rolling, "16", "--threads", "1")[16] == film(rolling, "16", "--threads", "3")[16]
    assert files(rolling)[16] == whole[16]


def test_workers_make_the_same_film(rolling, whole):
    with workers(2) as started:
        part = film(rolling, "14-17", "--workers", addresses(started))
    assert part == {n: whole[n] for n in range(14, 18)}


def test_jobs_make_the_film(rolling, whole):
    done = made(rolling, "--frames", f"0-{LAST}", "-o", "f-{frame:3}.ppm", "--jobs", "3",
                world="rolling.wrl", size=SMALL)
    lines = done.text.splitlines()
    first = [int(re.search(r"--frames (\d+)-", line).group(1)) for line in lines]
    assert 1 <= len(lines) <= 3 and all(n % 8 == 0 for n in first), "they begin with a history"
    for line in reversed(lines):
        subprocess.run(["sh", "-c", line], cwd=rolling.folder, capture_output=True, check=True)
    assert files(rolling) == whole


def test_missing_frames_are_made(rolling, whole):
    for number, data in whole.items():
        if number not in (2, 9, 10, 19):
            (rolling.folder / f"f-{number:03}.ppm").write_bytes(data)
    (rolling.folder / "f-005.ppm").write_bytes(whole[5][:-7])
    made(rolling, "--frames", f"0-{LAST}", "-o", "f-{frame:3}.ppm", "--missing",
         world="rolling.wrl", size=SMALL)
    assert files(rolling) == whole


def test_a_turntable_has_no_first_frame(rolling):
    """The frames before the first one are the last ones, so that the film can be repeated."""
    made(rolling, "--turntable", "12", "-o", "t-{frame}.ppm", world="rolling.wrl", size=SMALL)
    turns = files(rolling, "t")
    assert len(turns) == 12
    steps = [
        distance(bytes_of(without_note(turns[n])), bytes_of(without_note(turns[(n + 1) % 12])))
        for n in range(12)
    ]
    assert steps[-1] < 1.5 * max(steps[:-1])


def test_the_first_frame_is_no_noisier(rolling, whole):
    made(rolling, "--time", "0", "--spp", "1024", "-o", "true.ppm", world="rolling.wrl",
         size=("--size", "32x24"))
    true = bytes_of((rolling.folder / "true.ppm").read_bytes())
    made(rolling, "--time", "0", "--spp", "2", "-o", "raw.ppm", world="rolling.wrl",
         size=("--size", "32x24"))
    raw = bytes_of((rolling.folder / "raw.ppm").read_bytes())
    first = bytes_of(without_note(whole[0]))
    assert distance(first, true) < 0.5 * distance(raw, true)


# Denoised ---------------------------------------------------------------------------------------


def denoised(vv, frames, *options):
    """Makes denoised frames; returns their files by number."""
    return film(vv, frames, "--denoise", *options)


def test_denoised_films_are_functions_of_the_number_too(usable):  # noqa: F811
    own = film(usable, "0-17")
    all_of_it = denoised(usable, "0-17")
    assert all(own[n] != data for n, data in all_of_it.items())
    for frames in ("0", "8-9", "17"):
        for number, data in denoised(usable, frames).items():
            assert data == all_of_it[number], number
    note = f"preview: rebuilt from 2 samples per pixel by {NAME}, biased".encode()
    assert all(note in data for data in all_of_it.values())


def test_raw_files_are_the_samples(usable):  # noqa: F811
    made(usable, "--frames", "3", "--denoise", "-o", "a-{frame}.png", "--raw", "r-{frame}.exr",
         "--stats", "s.json", world="rolling.wrl", size=SMALL)
    raw = (usable.folder / "r-3.exr").read_bytes()
    assert set(exr_channels(raw)) == set("RGBA") and b"biased" not in raw
    assert b"biased" in (usable.folder / "a-3.png").read_bytes()
    stats = json.loads((usable.folder / "s.json").read_text())
    assert stats["image"]["denoised"]["by"] == NAME and stats["time"]["denoise"] > 0


def test_a_lie_in_a_film_is_caught(usable):  # noqa: F811
    options = ("--spp", "64", "--denoise", "--audit-denoise", "0", "--stats", "s.json", "-q")
    done = usable("rolling.wrl", "--size", "32x24", "--preview", "--frames", "2-3", *options, "-o",
                  "a-{frame}.exr")
    assert done.returncode == 4 and done.talk.count("doubtful") == 2, done.talk
    assert "doubt" in exr_channels((usable.folder / "a-2.exr").read_bytes())
    stats = json.loads((usable.folder / "s.json").read_text())
    assert all(frame["doubt"]["judged"] > 0 for frame in stats["frames"])


def test_files_take_denoise_and_windows_take_denoiser(usable):  # noqa: F811
    done = usable("rolling.wrl", *SMALL, "--frames", "0-1", "--denoiser", "oidn", "-o", "a.png")
    assert done.returncode == 2 and "with -o, --denoise" in done.talk, done.talk


def test_joined_films_say_so(rolling):
    made(rolling, "--frames", "0-3", "-o", "p-{frame}.png", "-o", "direct.gif", world="rolling.wrl",
         size=SMALL)
    done = rolling("film", "--join", *(f"p-{n}.png" for n in range(4)), "-o", "joined.gif")
    assert done.returncode == 0, done.talk
    direct, joined = ((rolling.folder / f"{name}.gif").read_bytes()
                      for name in ("direct", "joined"))
    assert direct == joined and b"preview: rebuilt" in joined
