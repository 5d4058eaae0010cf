"""Tests the cluster under faults, with real processes. Workers die, stall, are slow or send
garbage; the picture must have the bytes of one thread. Prints how much time each fault costs
(pytest -s). The slow campaign is tests/cluster/campaign.py."""
import pathlib
import random
import subprocess
import sys
import textwrap
import threading
import time

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cluster"))
import openrt_c  # noqa: E402
from farm import PROGRAM, Worker, cluster, farm, resident  # noqa: E402
from namespace import THERE, namespace  # noqa: E402

pytestmark = pytest.mark.skipif(not PROGRAM.exists(), reason="no openrt-worker in this build")

FRAME = {"width": 96, "height": 72, "spp": 32}


@pytest.fixture(scope="module")
def expected():
    return openrt_c.reference(**FRAME)


class Later:
    """Runs an action once the frame has made some progress. Leaving the block waits for the action
    and raises its exception."""

    def __init__(self, context, action, progress=0.2):
        self.context, self.action, self.progress = context, action, progress
        self.context.rt.rtProgress.restype = openrt_c.ctypes.c_float
        self.context.rt.rtProgress.argtypes = [openrt_c.ctypes.c_void_p]
        self.error = None
        self.over = False
        self.thread = threading.Thread(target=self._run)

    def _run(self):
        try:
            before = self.context.rt.rtProgress(self.context.handle)  # 1 before the frame begins
            end = time.monotonic() + 60
            while not self.over and time.monotonic() < end:
                now = self.context.rt.rtProgress(self.context.handle)
                if self.progress <= now < 1 or (before < 1 and now >= 1):
                    break
                before = now
                time.sleep(0.002)
            self.action()
        except Exception as e:  # noqa: BLE001
            self.error = e

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.over = True
        self.thread.join()
        if self.error:
            raise self.error


def render(context, action=None, progress=0.2):
    begin = time.monotonic()
    if action is None:
        out = context.render()
    else:
        with Later(context, action, progress):
            out = context.render()
    return out, time.monotonic() - begin


def talk(context):
    return "\n".join(text for _, text in context.messages)


@pytest.mark.parametrize("dying", [1, 3, 4])
def test_workers_killed_in_mid_frame(expected, dying):
    with farm(4) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        calm, without = render(c)
        assert calm == expected
        out, took = render(c, lambda: [w.kill() for w in workers[:dying]])
        print(f"{dying} of 4 killed: {took:.2f} s instead of {without:.2f}")
        assert out == expected
        assert render(c)[0] == expected  # the next frame, with the remaining workers


def test_a_worker_that_comes_back_is_taken_again(expected):
    with farm(2) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        assert render(c, workers[0].kill)[0] == expected
        workers[0].start()
        begin = time.monotonic()
        assert c.wait_for(2)
        print(f"back after {time.monotonic() - begin:.2f} s")
        assert render(c, workers[1].kill)[0] == expected


def test_a_worker_joins_in_mid_frame(expected):
    with farm(1, threads=1) as workers:
        late = Worker(threads=1)
        try:
            late.kill()  # its port is known, but no worker listens there yet
            with openrt_c.context(cluster([*workers, late], local=0), **FRAME) as c:
                assert render(c, late.start)[0] == expected
                assert render(c)[0] == expected
        finally:
            late.close()


def test_a_worker_that_stands_still(expected):
    with farm(2) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        _, without = render(c)
        out, took = render(c, workers[0].stop)
        print(f"one of two stopped: {took:.2f} s instead of {without:.2f}")
        assert out == expected
        workers[0].resume()
        for _ in range(3):
            assert render(c)[0] == expected


@pytest.mark.parametrize("fault", ["delay", "loss", "bandwidth"])
def test_slow_links(expected, fault):
    with farm(2, proxy=True) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        _, without = render(c)
        for w in workers[:1 if fault == "bandwidth" else 2]:
            setattr(w.proxy, fault, {"delay": 0.2, "loss": 0.1, "bandwidth": 125_000}[fault])
        out, took = render(c)
        print(f"{fault}: {took:.2f} s instead of {without:.2f}")
        assert out == expected


def test_partition_and_healing(expected):
    with farm(2, proxy=True) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        out, took = render(c, workers[0].proxy.partition)
        print(f"partition: {took:.2f} s")
        assert out == expected
        time.sleep(1)
        workers[0].proxy.heal()
        for _ in range(2):
            assert render(c)[0] == expected


@pytest.mark.parametrize("fault", ["corrupt", "swallow", "repeat", "cut"])
def test_bytes_that_are_damaged_on_the_way(expected, fault):
    random.seed(7)
    with farm(2, proxy=True) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:

        def hurt():
            for _ in range(6):
                getattr(random.choice(workers).proxy, fault)()
                time.sleep(0.05)

        out, took = render(c, hurt)
        print(f"{fault}: {took:.2f} s")
        assert out == expected
        assert render(c)[0] == expected


def test_one_pixel_four_hundred_times():
    tiny = {"width": 1, "height": 1, "spp": 1}
    with openrt_c.context("threads=1", **tiny) as c:
        alone = []
        for i in range(400):
            c.camera(0.01 * i)
            alone.append(c.render())
    with farm(2) as workers, openrt_c.context(cluster(workers), **tiny) as c:
        for i in range(400):
            c.camera(0.01 * i)
            assert c.render() == alone[i], i


def test_progressive_moving_and_cancelled_frames():
    still = {"width": 64, "height": 48, "spp": 64}
    with openrt_c.context("threads=1", **still) as c:
        alone = []
        for i in range(6):
            c.move(0.3 * i)
            alone.append(c.render())
    with farm(2) as workers, openrt_c.context(cluster(workers), progressive=True, **still) as c:
        for i in range(6):
            c.move(0.3 * i)
            with Later(c, c.cancel, 0.1):  # the newest frame wins
                c("Render")
            assert c.render() == alone[i], i


MASTER = textwrap.dedent("""
    import sys
    sys.path.insert(0, {folder!r})
    import openrt_c
    with openrt_c.context({config!r}, **{frame!r}) as c:
        for i in range({frames}):
            c.render()
            print(i, flush=True)
""")


def test_the_master_is_killed_and_starts_again(expected):
    folder = str(pathlib.Path(openrt_c.__file__).parent)
    with farm(2) as workers:
        sizes = []
        for _ in range(3):
            code = MASTER.format(folder=folder,
                                 config=cluster(workers, local=0),
                                 frame=FRAME,
                                 frames=1000)
            with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as master:
                master.stdout.readline()  # the master is in the middle of its second frame
                time.sleep(0.1)
                master.kill()
            with openrt_c.context(cluster(workers, local=0), **FRAME) as c:
                assert render(c)[0] == expected
                assert c.stats()["cluster"]["tilesRemote"] > 0
            sizes.append([resident(w.process.pid) for w in workers])
        print("workers' memory after each master:", sizes)


def test_nobody_there_the_master_does_it_alone_and_says_so(expected):
    gone = Worker()
    gone.close()
    with openrt_c.context(cluster([gone]), **FRAME) as c:
        assert render(c)[0] == expected
    with farm(1) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        assert render(c, workers[0].kill)[0] == expected
        assert "alone" in talk(c)


def test_another_machine_with_a_key_and_a_cable_that_is_pulled(expected, tmp_path):
    key = tmp_path / "cluster.key"
    subprocess.run([PROGRAM, "--new-key", key], check=True, capture_output=True)
    with namespace() as there:
        if there is None:
            pytest.skip("no network namespaces here (they need root and iproute2)")
        with there.popen(PROGRAM, "--listen", f"{THERE}:7447", "--threads", "1", "--key",
                         key) as worker:
            try:
                time.sleep(0.5)
                with pytest.raises(openrt_c.RtError, match="key"):
                    openrt_c.Context(f"backend=cluster workers={THERE}:7447")
                with openrt_c.context(f"backend=cluster workers={THERE}:7447 local=0 key={key}",
                                      **FRAME) as c:
                    assert c.wait_for(1), talk(c)
                    assert render(c)[0] == expected
                    assert c.stats()["cluster"]["tilesRemote"] > 0
                    out, took = render(c, lambda: there.plug(False))
                    print(f"the cable is pulled: {took:.2f} s")
                    assert out == expected
                    there.plug(True)
                    assert c.wait_for(1), talk(c)
                    assert render(c)[0] == expected
            finally:
                worker.kill()
