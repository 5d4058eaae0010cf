"""Tests xvrml.merge(), which adds pictures as vv merge does."""
import pickle

import pytest
from conftest import ISA, SMALL

xvrml = pytest.importorskip("xvrml")
np = pytest.importorskip("numpy")

PARTS = (*SMALL[:2], "--spp", "32", "--transport", "path", *ISA, "-q", "--channels",
         "rgba,z,error,trust,id")


@pytest.fixture
def parts(vv, monkeypatch):
    monkeypatch.chdir(vv.folder)
    for seed, view in (("0", ()), ("1", ()), ("2", ("--exposure", "1"))):
        done = vv("box.wrl", *PARTS, "--sums", "--seed", seed, "-o", f"{seed}.exr", *view)
        assert done.returncode == 0, done.talk
    return vv


def contents(vv, name):
    return (vv.folder / name).read_bytes()


def test_files_have_the_bytes_of_vv_merge(parts):
    assert parts("merge", "0.exr", "1.exr", "-o", "all.exr", "-o", "all.png").returncode == 0
    assert parts("merge", "0.exr", "1.exr", "-o", "sums.exr", "--sums").returncode == 0
    image = xvrml.merge(["1.exr", parts.folder / "0.exr"], "a.exr")
    xvrml.merge(("0.exr", "1.exr"), "b.exr", sums=True)
    assert contents(parts, "a.exr") == contents(parts, "all.exr")
    assert contents(parts, "b.exr") == contents(parts, "sums.exr")
    image.save("a.png")
    assert contents(parts, "a.png") == contents(parts, "all.png")
    assert image.stats["seeds"] == 2 and image.stats["samples"] == 64
    assert image.stats["transport"] == "path" and image.stats["error_mean"] > 0
    assert image.channels == ("rgba", "z", "id", "error", "trust") and image.names == ("", "Thing")
    again = pickle.loads(pickle.dumps(image))
    assert np.array_equal(again.array, image.array)


def test_sums_of_another_version_are_called_so(parts):
    data = contents(parts, "0.exr")
    assert data.count(b"VVSUMS2\n") == 2
    (parts.folder / "old.exr").write_bytes(data.replace(b"VVSUMS2\n", b"VVSUMS1\n"))
    with pytest.raises(Exception, match="made by another version"):
        xvrml.merge(["old.exr"])


def test_a_picture_without_a_file(parts):
    one, other = xvrml.merge(["0.exr"]), xvrml.merge(["1.exr"])
    both = xvrml.merge(["0.exr", "1.exr"])
    assert np.allclose(both.array, (one.array + other.array) / 2, atol=1e-5)
    assert sorted(path.name for path in parts.folder.glob("*.exr")) == ["0.exr", "1.exr", "2.exr"]


def test_another_exposure_is_a_warning(parts):
    with pytest.warns(RuntimeWarning, match="2.exr was made with another --exposure"):
        assert xvrml.merge(["0.exr", "2.exr"]).exposure == 0
    with pytest.warns(RuntimeWarning, match="than 2.exr"):
        assert xvrml.merge(["2.exr", "0.exr"]).exposure == 1


@pytest.mark.parametrize("error, arguments, match", [
    (TypeError, ("0.exr", ), "files: a list of file names was expected, not str"),
    (TypeError, (3, ), "files: a list of file names was expected, not int"),
    (TypeError, ([3], ), "int"),
    (ValueError, ([], ), "not an empty one"),
    (ValueError, (["0.exr"], "x\0.png"), "null byte"),
    (OSError, (["none.exr"], ), "cannot read none.exr"),
    (OSError, (["0.exr", "box.wrl"], ), "not a file of sums"),
    (OSError, (["0.exr", "short.exr"], ), "short.exr: it is truncated or damaged: from byte"),
    (OSError, (["0.exr"], "none/x.exr"), "none"),
    (ValueError, (["0.exr"], "x.wrl"), "suffixes"),
    (ValueError, (["0.exr", "1.exr"], "./0.exr"), "0.exr is one of the files"),
    (xvrml.RenderError, (["0.exr", "0.exr"], ), "cannot add 0.exr: .*seed 0"),
])
def test_wrong_calls(parts, error, arguments, match):
    parts.write("short.exr", contents(parts, "0.exr")[:300])
    before = contents(parts, "0.exr")
    with pytest.raises(error, match=match):
        xvrml.merge(*arguments)
    for output in ({}, {"output": "x.png"}):
        with pytest.raises(ValueError, match="sums: an output with the suffix .exr"):
            xvrml.merge(["0.exr"], **output, sums=True)
    assert contents(parts, "0.exr") == before and not (parts.folder / "x.png").exists()
