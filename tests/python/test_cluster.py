"""Tests xvrml.Cluster with real openrt-workers on loopback, and xvrml.dask on a cluster of its own
processes."""
import os
import pathlib
import subprocess
import sys
import threading
import time

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

from cluster_tools import PATIENCE, addresses, free_port, needs_worker, new_key, workers
from conftest import BOX, HEADER, find_vv
from test_vv_cluster import ROOM

SMALL = {"size": (64, 48), "spp": 4}
MOVING = HEADER + """
Viewpoint { position 0 0 8 }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE }
DEF Way PositionInterpolator { key [0, 0.5, 1] keyValue [-2 0 0, 2 0 0, -2 0 0] }
DEF Place Transform { children Shape { appearance Appearance { material Material { diffuseColor .2 .9 .4 } } geometry Sphere { } } }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
"""


@pytest.fixture(scope="module")
def two():
    with workers(2) as started:
        yield started


@pytest.fixture
def room():
    return xvrml.load(ROOM.encode())


def same(a, b):
    return np.array_equal(a.array.view(np.uint32), b.array.view(np.uint32))


# Cluster ----------------------------------------------------------------------------------------


def test_renders_in_its_scope_use_it(two, room):
    alone = room.render(**SMALL)
    with xvrml.Cluster([w.address for w in two], local_threads=0) as cluster:
        cluster.wait(2, timeout=PATIENCE)
        assert same(room.render(**SMALL), alone)
        assert {w.name.count(":") > 0 for w in cluster.workers if not w.here} == {True}
        assert sum(w.tiles for w in cluster.workers if not w.here) > 0
        assert all(
            w.alive and w.threads == 1 and w.bytes_sent > 0 for w in cluster.workers if not w.here)
        assert "Cluster of 2 workers" in repr(cluster) and "tiles" in repr(cluster.workers[0])
        before = sum(w.tiles for w in cluster.workers)
    assert same(room.render(**SMALL), alone)
    assert before > 0 and repr(cluster) == "<Cluster, closed>"
    with pytest.raises(ValueError, match="closed"):
        cluster.workers


def test_named_in_the_call(two, room):
    alone = room.render(**SMALL)
    cluster = xvrml.Cluster(addresses(two), require=2)
    try:
        assert same(room.render(cluster=cluster, **SMALL), alone)
    finally:
        cluster.close()
    with pytest.raises(ValueError, match="closed"):
        room.render(cluster=cluster, **SMALL)
    with pytest.raises(TypeError, match="cluster"):
        room.render(cluster="127.0.0.1", **SMALL)


def test_the_instruction_set_of_a_cluster(two, room):
    for isa in ("sse2", "avx2", "neon"):
        try:
            alone = room.render(isa=isa, **SMALL)
        except ValueError:  # not on this machine
            with pytest.raises(ValueError, match="isa: expected auto"):
                xvrml.Cluster(addresses(two), isa=isa)
            continue
        with xvrml.Cluster(addresses(two), require=2, local_threads=0, isa=isa):
            assert same(room.render(**SMALL), alone), isa
            with pytest.raises(ValueError, match="isa: a cluster has its own"):
                room.render(isa=isa, **SMALL)


def test_worlds_and_browsers_take_turns(two, room):
    """A Browser keeps the cluster's context between pictures until another world needs it."""
    browser, other = xvrml.Browser(MOVING.encode()), xvrml.load(BOX.encode())
    wanted = []
    for time_ in (0, 0.25, 0.5):
        browser.tick(time_)
        wanted += [browser.render(**SMALL), room.render(**SMALL), other.render(**SMALL)]
    browser = xvrml.Browser(MOVING.encode())
    with xvrml.Cluster(addresses(two), require=2):
        for time_ in (0, 0.25, 0.5):
            browser.tick(time_)
            for world in (browser, room, other):
                assert same(world.render(**SMALL), wanted.pop(0)), (time_, world)
    assert same(browser.render(**SMALL), browser.render(threads=1, **SMALL))


def test_scopes_nest_and_threads_have_their_own(two, room):
    with xvrml.Cluster(two[0].address, require=1) as outer:
        room.render(**SMALL)
        counted = sum(w.tiles for w in outer.workers)
        with xvrml.Cluster(two[1].address, require=1) as inner:
            room.render(**SMALL)
            assert sum(w.tiles for w in inner.workers) > 0
        assert sum(w.tiles for w in outer.workers) == counted
        thread = threading.Thread(target=room.render, kwargs=SMALL)
        thread.start()
        thread.join()
        assert sum(w.tiles for w in outer.workers) == counted, "a thread begins without a scope"
        room.render(**SMALL)
        assert sum(w.tiles for w in outer.workers) > counted


def test_errors_are_exceptions(room, tmp_path):
    needs_worker()
    nobody = f"127.0.0.1:{free_port()}"
    assert issubclass(xvrml.ClusterError, xvrml.RenderError)
    with xvrml.Cluster([nobody]) as cluster:
        start = time.monotonic()
        with pytest.raises(TimeoutError, match="0 of 1 workers"):
            cluster.wait(1, timeout=0.2)
        assert time.monotonic() - start < PATIENCE
        assert same(room.render(**SMALL), room.render(threads=1,
                                                      **SMALL)), "this process does it alone"
    with pytest.raises(xvrml.ClusterError, match="--new-key|new-key"):
        xvrml.Cluster(["192.0.2.1"])
    with pytest.raises(xvrml.RenderError, match="missing.key"):
        xvrml.Cluster([nobody], key=tmp_path / "missing.key")


@pytest.mark.parametrize("arguments, text", [
    ({}, "workers or listen"),
    ({
        "workers": [""]
    }, "workers"),
    ({
        "workers": ["a,b"]
    }, "workers"),
    ({
        "workers": "a",
        "split": "halves"
    }, "split"),
    ({
        "workers": "a",
        "local_threads": -1
    }, "local_threads"),
    ({
        "workers": "a",
        "require": -1
    }, "require"),
])
def test_arguments(arguments, text):
    with pytest.raises(ValueError, match=text):
        xvrml.Cluster(**arguments)


def test_with_a_key(room, tmp_path):
    needs_worker()
    new_key(tmp_path / "cluster.key")
    with workers(1, "--key", tmp_path / "cluster.key") as started:
        with xvrml.Cluster(addresses(started),
                           key=tmp_path / "cluster.key",
                           require=1,
                           local_threads=0):
            picture = room.render(**SMALL)
    assert same(picture, room.render(**SMALL))


# Dask -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("xvrml.dask")
    paths = os.pathsep.join(
        [str(pathlib.Path(xvrml.__file__).parents[1]),
         os.environ.get("PYTHONPATH", "")])
    before, os.environ["PYTHONPATH"] = os.environ.get("PYTHONPATH"), paths
    try:
        with distributed.LocalCluster(n_workers=2,
                                      threads_per_worker=1,
                                      processes=True,
                                      dashboard_address=None,
                                      silence_logs=50) as cluster:
            with distributed.Client(cluster) as made:
                yield made
    finally:
        if before is None:
            del os.environ["PYTHONPATH"]
        else:
            os.environ["PYTHONPATH"] = before


def expected(time_, fps=30.0, **options):
    browser = xvrml.Browser(MOVING.encode())
    step = 0
    while step / fps < time_:
        browser.tick(step / fps)
        step += 1
    browser.tick(time_)
    return browser.render(**options)


def test_frames_on_dask(client):
    times = [0, 0.1, 0.4, 0.5, 1.25]
    arrays = list(xvrml.dask.render_frames(MOVING.encode(), times, client, **SMALL))
    assert len(arrays) == len(times)
    for time_, array in zip(times, arrays):
        assert np.array_equal(array, expected(time_, **SMALL).array), time_


def test_frames_on_dask_as_files(client, tmp_path):
    """Rendering from a path and from a World gives the same files as vv."""
    world = tmp_path / "moving.wrl"
    world.write_text(MOVING)
    done = subprocess.run([
        find_vv(), world, "--frames", "0-2", "-o", tmp_path / "vv-{frame:4}.png", "--size", "64x48",
        "--spp", "4"
    ],
                          timeout=120)
    assert done.returncode == 0
    for source in (world, xvrml.load(world)):
        files = xvrml.dask.render_frames(source, [0, 1 / 30, 2 / 30],
                                         client,
                                         out=tmp_path / "dask-{frame:04}.png",
                                         **SMALL)
        assert [pathlib.Path(f).name for f in files
               ] == ["dask-0000.png", "dask-0001.png", "dask-0002.png"]
        for n in range(3):
            assert (tmp_path / f"dask-{n:04}.png").read_bytes() == (tmp_path /
                                                                    f"vv-{n:04}.png").read_bytes()
            (tmp_path / f"dask-{n:04}.png").unlink()
    assert not list(tmp_path.glob(".xvrml-*"))


def test_a_frame_of_a_dead_dask_worker_is_made_again(client):
    frames = xvrml.dask.render_frames(MOVING.encode(), [n / 10 for n in range(6)], client, **SMALL)
    first = next(frames)
    worker = next(iter(client.cluster.workers.values()))
    worker.process.process._process.kill() if hasattr(worker.process,
                                                      "process") else worker.process.kill()
    rest = list(frames)
    assert len(rest) == 5 and np.array_equal(first, expected(0, **SMALL).array)
    assert np.array_equal(rest[-1], expected(0.5, **SMALL).array)


def test_what_is_wrong_is_said_at_once(client, tmp_path):
    for times, out, text in (([1, 0.5], None, "times"), ([-1], None, "times"),
                             ([0, 1], tmp_path / "x.png", "frame")):
        with pytest.raises(ValueError, match=text):
            list(xvrml.dask.render_frames(MOVING.encode(), times, client, out=out))
    with pytest.raises(xvrml.ParseError):
        list(xvrml.dask.render_frames(b"nonsense", [0], client, retries=0))
    with pytest.raises(ValueError, match="fps"):
        list(xvrml.dask.render_frames(MOVING.encode(), [0], client, fps=0))
