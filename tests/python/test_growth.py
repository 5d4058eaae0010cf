"""Worlds of many small parts: what each further part takes, in bytes of the process."""
import json
import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import bench_parts  # noqa: E402

FEW, MANY = 90_000, 150_000  # both have more than a million triangles


def peak(vv, parts, kind):
    world = vv.folder / "parts.wrl"
    bench_parts.write_world(world, parts, kind)
    done = vv(world.name, "-q", "-o", "parts.png", "--size", "32x24", "--spp", "1", "--stats", "-",
              "--threads", "2")
    assert done.returncode == 0, done.talk
    return json.loads(done.text)["memory"]["peak_rss"]


@pytest.mark.skipif(bool({"ASAN_OPTIONS", "TSAN_OPTIONS"} & os.environ.keys()),
                    reason="a sanitizer multiplies memory")
@pytest.mark.parametrize("kind, most", [("different", 4800), ("separate", 3550), ("used", 2050)])
def test_a_further_part_takes_few_bytes(vv, kind, most):
    each = (peak(vv, MANY, kind) - peak(vv, FEW, kind)) / (MANY - FEW)
    assert each < most
