"""Tests vv --audit and --compare: pictures against references."""
import re


def value(text, name):
    match = re.search(r"^%s +([-+.0-9e]+)" % name, text, re.MULTILINE)
    assert match, text
    return float(match.group(1))


def test_a_picture_compared_with_itself_and_with_another(vv):
    assert vv("box.wrl", "-o", "ref.exr", "--size", "24x16", "-q").returncode == 0
    same = vv("box.wrl", "--compare", "ref.exr", "--size", "24x16", "-q")
    assert same.returncode == 0, same.talk
    for name in ("rmse", "relmse", "bias", "largest"):
        assert value(same.text, name) == 0
    other = vv("box.wrl", "--compare", "ref.exr", "--size", "24x16", "--seed", "5", "-q")
    assert other.returncode == 0 and 0 < value(other.text, "rmse") < .1


def test_references_that_are_none(vv):
    assert vv("box.wrl", "-o", "ref.exr", "-o", "ref.png", "--size", "24x16", "-q").returncode == 0
    for arguments, expected in (
        (("--compare", "none.exr"), "none.exr"),
        (("--compare", "ref.png"), "ref.png"),
        (("--compare", "ref.exr", "--size", "25x16"), "24x16"),
    ):
        done = vv("box.wrl", "-q", *arguments)
        assert done.returncode == 3 and expected in done.talk, done.talk
    assert vv("box.wrl", "--audit", "--time-limit", "1").returncode == 2
    assert vv("box.wrl", "--audit", "1").returncode == 2


def test_an_audit_says_whether_the_error_bars_hold(vv):
    done = vv("box.wrl", "--audit", "6", "--size", "24x16", "--spp", "32", "-q")
    assert done.returncode in (0, 4), done.talk
    assert done.text.startswith("6 pictures of 32 samples")
    assert 0 <= value(done.text, "trusted") <= 100
    assert ("the error bars hold" in done.text) == (done.returncode == 0)
    given = vv("box.wrl", "-o", "ref.exr", "--size", "24x16", "--spp", "256", "--channels",
               "rgba,error,trust", "-q")
    assert given.returncode == 0
    done = vv("box.wrl", "--audit", "3", "--compare", "ref.exr", "--size", "24x16", "--spp", "32",
              "-q")
    assert "ref.exr with its own error bars" in done.text
