"""openrt-worker --metrics, --cache-folder and --share: what a monitoring system sees over HTTP, and
that a worker that begins again has kept what it was sent."""
import re
import socket
import subprocess
import time
import urllib.error
import urllib.request

import pytest
from cluster_tools import PATIENCE, PROGRAM, free_port, needs_worker, workers
from conftest import HEADER

HILLS = HEADER + f"""
Viewpoint {{ position 30 20 80 }}
Shape {{ appearance Appearance {{ material Material {{ }} }}
  geometry ElevationGrid {{ xDimension 60 zDimension 60 height [
    {" ".join(str(i * 7919 % 101 / 50) for i in range(3600))} ] }} }}
"""


def metrics(port):
    """Returns the samples of a worker, by name and labels."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=PATIENCE) as answer:
        assert answer.headers["Content-Type"].startswith("text/plain; version=0.0.4")
        lines = answer.read().decode().splitlines()
    return {line.rsplit(" ", 1)[0]: float(line.rsplit(" ", 1)[1]) for line in lines if line[0] != "#"}


def by_place(samples, name):
    return {
        place: samples[f'openrt_worker_{name}{{from="{place}"}}']
        for place in ("memory", "folder", "worker", "master")
    }


def render(vv, worker):
    vv.write("hills.wrl", HILLS)
    done = vv("hills.wrl", "-o", "ppm:-", "--size", "40x30", "--spp", "1", "--workers",
              worker.address, "--local-threads", "0", "--require-workers")
    assert done.returncode == 0, done.talk
    return done.stdout


def test_a_worker_tells_what_it_has_done(vv, tmp_path):
    port = free_port()
    folder = tmp_path / "arrays"
    options = ["--cache-folder", folder, "--metrics", f"127.0.0.1:{port}"]
    with workers(1, *options) as (worker, ):
        before = metrics(port)
        assert before["openrt_worker_jobs_total"] == 0
        assert before["openrt_worker_threads"] == 1
        first = render(vv, worker)
        after = metrics(port)
    assert after["openrt_worker_masters_total"] == 1
    assert after["openrt_worker_jobs_total"] > 0
    assert after["openrt_worker_job_seconds_total"] > 0
    assert after['openrt_worker_rays_total{kind="camera"}'] >= 40 * 30
    assert after['openrt_worker_received_bytes_total{from="master"}'] > 1000
    sent = by_place(after, "arrays_total")
    assert sent["master"] > 0 and sent["folder"] == 0

    with workers(1, *options) as (worker, ):  # another process, the same folder
        assert render(vv, worker) == first
        kept = by_place(metrics(port), "arrays_total")
    assert kept["folder"] > 0
    assert kept["master"] < sent["master"]
    assert kept["folder"] + kept["master"] == sent["master"]
    assert all(re.fullmatch(r"[0-9a-f]{32}\.zst", file.name) for file in folder.iterdir())


def test_other_requests_are_refused_and_slow_ones_hold_up_nobody(tmp_path):
    port = free_port()
    with workers(1, "--metrics", f"127.0.0.1:{port}"):
        held = [socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) for _ in range(8)]
        for one in held:
            one.sendall(b"GET /met")
        for path, code in (("/", 404), ("/metricsx", 404)):
            with pytest.raises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=PATIENCE)
            assert refused.value.code == code
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", b"data", timeout=PATIENCE)
        assert refused.value.code == 405
        with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as endless:
            with pytest.raises(OSError):
                for _ in range(1000):
                    endless.sendall(b"x" * 1000)
                    time.sleep(0.001)
        assert metrics(port)["openrt_worker_serving"] == 0
        with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE) as slow:
            slow.sendall(b"GET /met")
            slow.sendall(b"rics HTTP/1.0\r\n\r\n")
            assert slow.recv(4096).startswith(b"HTTP/1.1 200 OK\r\n")
        for one in held:
            one.close()


@pytest.mark.parametrize("options, code, said", [
    (["--share"], 2, "--share requires --cache-folder"),
    (["--cache-folder", ""], 2, "a value was expected"),
    (["--cache-folder", "/nowhere/at/all"], 2, "No such file or directory"),
    (["--cache-folder-size", "10"], 2, "--cache-folder-size requires --cache-folder"),
    (["--metrics", "no address"], 2, "blanks"),
])
def test_options_that_cannot_work_are_refused(options, code, said):
    needs_worker()
    done = subprocess.run([PROGRAM, "--listen", "127.0.0.1:0", *options],
                          capture_output=True,
                          text=True,
                          timeout=PATIENCE)
    assert done.returncode == code, done.stderr
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_port_that_is_taken_is_no_place_for_metrics():
    needs_worker()
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = subprocess.run([
            PROGRAM, "--listen", "127.0.0.1:0", "--metrics",
            f"127.0.0.1:{taken.getsockname()[1]}"
        ], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 75
    assert "cannot listen at" in done.stderr
