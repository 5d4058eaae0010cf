"""A network namespace with one virtual cable to the outside: for TCP it is another machine. Needs
root and iproute2."""
import contextlib
import os
import shutil
import subprocess

HERE, THERE = "198.51.100.1", "198.51.100.2"  # RFC 5737: addresses for documentation


def ip(*arguments):
    return subprocess.run(["ip", *arguments], check=True, capture_output=True)


class Namespace:

    def __init__(self):
        self.name = f"ort{os.getpid()}"
        self.cable = f"o{os.getpid()}"
        ip("netns", "add", self.name)
        try:
            ip("link", "add", self.cable, "type", "veth", "peer", "name", "far", "netns", self.name)
            ip("addr", "add", f"{HERE}/30", "dev", self.cable)
            ip("-n", self.name, "addr", "add", f"{THERE}/30", "dev", "far")
            ip("-n", self.name, "link", "set", "lo", "up")
            ip("-n", self.name, "link", "set", "far", "up")
            self.plug(True)
        except BaseException:
            self.close()
            raise

    def plug(self, there):
        ip("link", "set", self.cable, "up" if there else "down")

    def popen(self, *command, **options):
        return subprocess.Popen(["ip", "netns", "exec", self.name, *command], **options)

    def close(self):
        with contextlib.suppress(subprocess.CalledProcessError):
            ip("link", "del", self.cable)
        with contextlib.suppress(subprocess.CalledProcessError):
            ip("netns", "del", self.name)


@contextlib.contextmanager
def namespace():
    """Yields a Namespace, or None if this machine does not permit one."""
    made = None
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        if os.geteuid() == 0 and shutil.which("ip"):
            made = Namespace()
    try:
        yield made
    finally:
        if made:
            made.close()
