"""Workers for tests: real openrt-workers on ports of their own, on loopback. Tests skip where the program is not built."""
import contextlib
import os
import pathlib
import socket
import stat
import subprocess
import sys
import time

import pytest

from conftest import find_vv

PATIENCE = 30  # seconds, for what takes a moment on an idle machine


def find_worker():
    """$OPENRT_WORKER, else the program beside vv."""
    return pathlib.Path(os.environ.get("OPENRT_WORKER", find_vv().parent / "openrt-worker"))


def needs_worker():
    if not find_worker().exists():
        pytest.skip("openrt-worker is not built")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def new_key(path):
    """A key file; returns its public key."""
    done = subprocess.run([find_worker(), "--new-key", path], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    return done.stdout.split()[0]


class Worker:
    """An openrt-worker; its address once it listens."""

    def __init__(self, *arguments, listen=True, threads=1):
        self.port = free_port()
        self.address = f"127.0.0.1:{self.port}"
        place = ["--listen", self.address] if listen else []
        self.process = subprocess.Popen([find_worker(), *place, "--threads", str(threads), *map(str, arguments)], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True)
        if listen:
            self.until_it_listens()

    def until_it_listens(self):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise AssertionError(self.process.stderr.read())
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", self.port), timeout=1):
                return
            time.sleep(0.02)
        raise AssertionError("the worker does not listen")

    def kill(self):
        self.process.kill()
        self.process.wait(PATIENCE)
        self.process.stderr.close()


@contextlib.contextmanager
def workers(count, *arguments, **options):
    """So many workers; gone at the end."""
    needs_worker()
    started = []
    try:
        for _ in range(count):
            started.append(Worker(*arguments, **options))
        yield started
    finally:
        for worker in started:
            worker.kill()


def addresses(started):
    return ",".join(worker.address for worker in started)


if __name__ == "__main__":  # by hand: a few workers until Enter is pressed
    with workers(int(sys.argv[1])) as all_of_them:
        print(addresses(all_of_them))
        input()
