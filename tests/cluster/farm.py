"""Runs workers as processes on loopback, each behind a fault proxy if requested, and measures
processes."""
import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import time

from fault_proxy import FaultProxy
from openrt_c import build

PROGRAM = pathlib.Path(os.environ.get("OPENRT_WORKER", build() / "bin/openrt-worker"))


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as s:
        return s.getsockname()[1]


def listening(port, process, seconds=30):
    end = time.monotonic() + seconds
    while time.monotonic() < end and process.poll() is None:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            return True
        time.sleep(0.02)
    return False


class Worker:
    """One openrt-worker process. It listens at `address`, where the master connects, or its
    arguments name the master to call."""

    def __init__(self, *arguments, listen=True, threads=1, proxy=False):
        self.port = free_port() if listen else None
        place = ["--listen", f"127.0.0.1:{self.port}"] if listen else []
        self.arguments = [PROGRAM, *place, "--threads", str(threads), *map(str, arguments)]
        self.process = None
        self.proxy = None
        self.start()
        if proxy:
            self.proxy = FaultProxy(("127.0.0.1", self.port))
        self.address = self.proxy.address if proxy else f"127.0.0.1:{self.port}"

    def start(self):
        with tempfile.TemporaryFile() as said:
            self.process = subprocess.Popen(self.arguments, stdout=subprocess.DEVNULL, stderr=said)
            if self.port and not listening(self.port, self.process):
                said.seek(0)
                raise AssertionError("openrt-worker does not listen: " + said.read().decode())

    def kill(self):
        self.process.kill()
        self.process.wait()

    def stop(self):
        self.process.send_signal(signal.SIGSTOP)

    def resume(self):
        self.process.send_signal(signal.SIGCONT)

    def close(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.kill()
        if self.proxy:
            self.proxy.close()


@contextlib.contextmanager
def farm(count, *arguments, **options):
    workers = []
    try:
        for _ in range(count):
            workers.append(Worker(*arguments, **options))
        yield workers
    finally:
        for worker in workers:
            worker.close()


def addresses(workers):
    return ",".join(worker.address for worker in workers)


def cluster(workers, **options):
    """Returns the configuration of a context."""
    words = {"workers": addresses(workers), **options}
    return "backend=cluster " + " ".join(f"{key}={value}" for key, value in words.items())


def resident(pid="self"):
    """Returns the resident memory of a process in bytes."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) * 1024
    return 0


def descriptors(pid="self"):
    return len(os.listdir(f"/proc/{pid}/fd"))
