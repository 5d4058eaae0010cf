"""Tests vv and openrt-worker where something is short or empty: time, file descriptors, values of
options; and signals that end a run."""
import resource
import signal
import subprocess
import time

import pytest

from conftest import SMALL, find_vv


def limited(vv, number, *arguments, program=None):
    """Runs a program that can open `number` files."""
    return subprocess.run([program or vv.program, *map(str, arguments)],
                          cwd=vv.folder,
                          capture_output=True,
                          text=True,
                          timeout=60,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE,
                                                                (number, number)))


def worker():
    program = find_vv().parent / "openrt-worker"
    if not program.exists():
        pytest.skip("openrt-worker is not built")
    return program


@pytest.mark.parametrize("seconds", ["1e-300", "1e-45", "1e-40"])
def test_the_shortest_time_limit_ends_at_once(vv, seconds):
    done = vv("box.wrl", "-o", "x.png", "--size", "400x300", "--time-limit", seconds, timeout=60)
    assert done.returncode == 0, done.talk
    assert (vv.folder / "x.png").exists()


def test_words_after_two_dashes_are_files(vv):
    (vv.folder / "-box.wrl").write_bytes((vv.folder / "box.wrl").read_bytes())
    for words in (["--", "box.wrl"], ["--", "-box.wrl"], ["-q", "--", "-box.wrl"]):
        done = vv("-o", "x.png", *SMALL, *words)
        assert done.returncode == 0, done.talk
    done = vv("-o", "x.png", *SMALL, "--", "box.wrl", "-q")
    assert done.returncode == 2 and '"-q" is one too many' in done.talk
    done = vv("-o", "--", *SMALL, "box.wrl")  # the value of an option
    assert done.returncode == 2 and "--" in done.talk


@pytest.mark.parametrize("option", [["--workers", "127.0.0.1:1"],
                                    ["--listen-workers", "127.0.0.1:0"]])
def test_a_cluster_without_file_descriptors_is_a_message(vv, option):
    done = limited(vv, 10, "box.wrl", "-o", "x.png", *SMALL, *option)
    assert done.returncode == 75, (done.returncode, done.stderr)
    assert "file descriptors (ulimit -n)" in done.stderr and len(done.stderr.splitlines()) == 1


def test_a_worker_without_file_descriptors_is_a_message(vv):
    done = limited(vv, 10, "--listen", "127.0.0.1:0", program=worker())
    assert done.returncode == 75 and "file descriptors (ulimit -n)" in done.stderr


@pytest.mark.parametrize("number", [4, 5, 12])
def test_a_server_without_file_descriptors_is_a_message(vv, number):
    done = limited(vv, number, "serve", "box.wrl", "--port", "0")
    assert done.returncode == 75, (done.returncode, done.stdout, done.stderr)
    assert done.stdout == "" and "vv serve needs" in done.stderr
    assert "file descriptors (ulimit -n)" in done.stderr and len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("option", ["--connect", "--key", "--allow", "--new-key"])
def test_a_worker_refuses_empty_values(vv, option):
    for words in ([option, ""], [option + "="], [option + "=", "k"]):
        done = limited(vv, 256, *words, program=worker())
        assert done.returncode == 2, (done.returncode, done.stdout, done.stderr)
        assert option in done.stderr


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGXCPU, signal.SIGTERM])
def test_signals_that_end_a_run_save_the_picture_so_far(vv, number):
    run = vv.start("box.wrl", "-o", "x.png", "--size", "400x300", "--spp", 60000)
    time.sleep(1.5)
    run.send_signal(number)
    said = run.communicate(timeout=60)[1].decode()
    assert run.returncode == 130 and "the picture so far is saved" in said, said
    assert (vv.folder / "x.png").read_bytes().startswith(b"\x89PNG")


def test_nohup_goes_on(vv):
    run = subprocess.Popen([find_vv(), "box.wrl", "-o", "x.png", "--size", "400x300", "--spp", "60000"],
                           cwd=vv.folder,
                           stderr=subprocess.PIPE,
                           preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    time.sleep(1.5)
    run.send_signal(signal.SIGHUP)
    time.sleep(0.5)
    assert run.poll() is None
    run.send_signal(signal.SIGTERM)
    run.communicate(timeout=60)
    assert run.returncode == 130
