"""Tests --audit-denoise: a denoiser that lies is caught. The fake of Open Image Denoise gives every
pixel the mean colour, which is a lie wherever there is anything to see."""
import json

import pytest

from conftest import exr_channels
from exr_tools import read_exr
from test_vv_denoise import library, made, usable  # noqa: F401  fixtures
from test_vv_denoiser import fake  # noqa: F401  a fixture

np = pytest.importorskip("numpy")
SPP = ("--spp", "64", "--denoise", "--audit-denoise")


def stats(vv):
    return json.loads((vv.folder / "s.json").read_text())


def test_a_denoiser_that_lies_is_caught(usable):  # noqa: F811
    done = made(usable, *SPP, "-o", "a.exr", "-o", "a.png", "--stats", "s.json", "--raw", "raw.exr",
                "--channels", "rgba,error,trust")
    doubt = stats(usable)["image"]["denoised"]["doubt"]
    assert doubt["pixels"] == 32 * 24 and 0 < doubt["doubtful"] <= doubt["judged"] <= 32 * 24
    assert doubt["share"] == pytest.approx(doubt["doubtful"] / doubt["judged"])
    assert f"of {doubt['judged']} judged pixels are doubtful" in done.talk
    assert set(exr_channels((usable.folder / "a.exr").read_bytes())) == set("RGBA") | {"doubt"}
    assert "doubt" not in exr_channels((usable.folder / "raw.exr").read_bytes())
    _, planes = read_exr((usable.folder / "a.exr").read_bytes())
    _, raw = read_exr((usable.folder / "raw.exr").read_bytes())
    seen = planes["doubt"]
    assert (seen > 1).sum() == doubt["doubtful"] and (seen >= 0).sum() == doubt["judged"]
    assert ((seen < 0) == (raw["trust"] == 0)).all(), "what has no interval is not judged"
    # In half-widths of the 99 % interval, which is no narrower than what is seen.
    y, x = np.unravel_index(np.argmax((seen > 2) & (raw["error.R"] > .01)), seen.shape)
    half = np.maximum([raw[f"error.{c}"][y, x] * 3.49948 / 2.36462 for c in "RGB"],
                      max(raw[c][y, x] for c in "RGB") / 128)
    away = [abs(planes[c][y, x] - raw[c][y, x]) for c in "RGB"]
    assert seen[y, x] == pytest.approx(min(99, max(away / half)), rel=1e-4)


def test_the_exit_code_can_ask_for_it(usable):  # noqa: F811
    for limit, code in (("0", 4), ("100", 0), (None, 0)):
        done = usable("box.wrl", "--size", "32x24", *SPP, *([limit] if limit else []), "-o", "a.png",
                      "-q")
        assert done.returncode == code, done.talk
        assert (usable.folder / "a.png").exists(), "the picture is written all the same"
        assert ("doubtful" in done.talk) == (code == 4)
        (usable.folder / "a.png").unlink()


def test_pictures_without_error_bars(usable):  # noqa: F811
    done = usable("box.wrl", "--size", "32x24", "--spp", "4", "--denoise", "--audit-denoise", "-o",
                  "a.png", "--stats", "s.json")
    assert done.returncode == 0 and "--spp 32 or more" in done.talk
    doubt = stats(usable)["image"]["denoised"]["doubt"]
    assert doubt["judged"] == 0 and doubt["share"] is None
    done = usable("box.wrl", "--size", "32x24", "--spp", "4", "--denoise", "--audit-denoise", "50",
                  "-o", "a.png", "-q")
    assert done.returncode == 4 and "cannot be audited" in done.talk


def test_sequences(usable):  # noqa: F811
    done = usable("rolling.wrl", "--size", "32x24", *SPP, "0", "--frames", "0-1", "-o", "a.png",
                  "--stats", "s.json", "-q")
    assert done.returncode == 4
    assert done.talk.count("doubtful") == 2, "each frame that has too much of it is named"
    assert all(frame["doubt"]["judged"] > 0 for frame in stats(usable)["frames"])


def test_the_audit_changes_no_pixel_of_files_without_it(usable):  # noqa: F811
    files = []
    for threads in ("1", "3"):
        made(usable, *SPP, "--threads", threads, "-o", "a.exr")
        files.append((usable.folder / "a.exr").read_bytes())
    assert files[0] == files[1]


def test_it_needs_denoise(vv):
    done = vv("box.wrl", "-o", "a.png", "--audit-denoise")
    assert done.returncode == 2 and "--audit-denoise needs --denoise" in done.talk
    done = vv("box.wrl", "-o", "a.png", "--channels", "doubt")
    assert done.returncode == 2, "frames have no such channel"
    for wrong in ("=101", "=-1", "=x"):
        done = vv("box.wrl", "-o", "a.png", "--denoise", "--audit-denoise" + wrong)
        assert done.returncode == 2 and done.talk.count("\n") == 1
