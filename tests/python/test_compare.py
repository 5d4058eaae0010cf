"""Tests xvrml.compare(): what vv compare says, for files, Pictures and arrays."""
import json

import pytest

xvrml = pytest.importorskip("xvrml")
np = pytest.importorskip("numpy")


def pictures(box, *seeds, **options):
    world = xvrml.load(box)
    return [world.render(size=(32, 24), seed=seed, **{"spp": 16, **options}) for seed in seeds]


def test_pictures_of_two_seeds(box):
    a, b = pictures(box, 1, 2)
    said = xvrml.compare(a, b, samples=(16, 16))
    assert said["same"] is True and said["pictures"] == ["a", "b"] and said["equal_noise"]
    assert said["width"] == 32 and not said["changes"] and not said["error_bars"]
    changed = xvrml.compare(a, 1.3 * b.array[..., :3], samples=(16, 16))
    assert changed["same"] is False and changed["changes"][0]["change"] > 0
    assert xvrml.compare(a.array, b.array)["rmse"] == said["rmse"]


def test_numbers_that_are_not_finite_are_no_noise():
    image = np.ones((16, 16, 3), np.float32)
    for wrong in (np.nan, np.inf, 1e38):
        half = image.copy()
        half[3, 4] = wrong
        said = xvrml.compare(image, half)
        assert said["same"] is False and said["one_sided"] == 1 and said["not_finite"] == 1
        assert xvrml.compare(half, half)["same"] is True
        with pytest.raises(ValueError, match="no pixel with finite numbers in both"):
            xvrml.compare(image, image * np.float32(wrong))


def test_error_bars_of_pictures_are_used(box):
    a, b = pictures(box, 1, 2, spp=64, channels=("error", "trust"))
    said = xvrml.compare(a, b)
    assert said["error_bars"] and said["tests"]["pixels"] > 0
    a, b = pictures(box, 1, 2, channels=("variance", "samples"))
    assert not xvrml.compare(a, b)["error_bars"]
    assert xvrml.compare(a, b, variance=True)["error_bars"]


def test_files_are_compared_as_by_vv(box, vv):
    for seed in ("1", "2"):
        assert vv("box.wrl", "--size", "32x24", "--seed", seed, "-o", f"{seed}.exr",
                  "-q").returncode == 0
    said = json.loads(vv("compare", "1.exr", "2.exr", "--samples", "16,16", "--json").text)
    first, second = vv.folder / "1.exr", vv.folder / "2.exr"
    mine = xvrml.compare(first, str(second), samples=(16, 16))
    assert mine.pop("pictures") == [str(first), str(second)]
    said.pop("pictures")
    assert mine == said


def test_what_cannot_be_compared(box, tmp_path):
    image = np.ones((16, 16, 3), np.float32)
    with pytest.raises(OSError, match="none.exr"):
        xvrml.compare(image, tmp_path / "none.exr")
    with pytest.raises(ValueError, match="a has 16x16 pixels, b 8x16"):
        xvrml.compare(image, image[:, :8])
    with pytest.raises(ValueError, match="at least 8x8 were expected"):
        xvrml.compare(image[:4], image[:4])
    with pytest.raises(ValueError, match="a has no channels variance.R"):
        xvrml.compare(image, image, variance=True)
    with pytest.raises(ValueError, match="samples"):
        xvrml.compare(image, image, samples=(0, 4))
    with pytest.raises(ValueError, match="b: numbers of shape"):
        xvrml.compare(image, image[..., 0])
    with pytest.raises(TypeError):
        xvrml.compare(image, image, samples=(4, ))
    with pytest.raises(TypeError):
        xvrml.compare(image, None)
