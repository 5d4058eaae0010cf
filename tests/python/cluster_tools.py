"""Starts workers for pytest (tests/cluster/farm.py). Tests are skipped if the program is not built.
"""
import contextlib
import pathlib
import stat
import subprocess
import sys

import pytest

from conftest import PATIENCE

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cluster"))
from farm import PROGRAM, addresses, farm, free_port  # noqa: E402, F401


def needs_worker():
    if not PROGRAM.exists():
        pytest.skip("openrt-worker is not built")


def new_key(path):
    """Makes a key file; returns its public key."""
    done = subprocess.run([PROGRAM, "--new-key", path],
                          capture_output=True,
                          text=True,
                          timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    return done.stdout.split()[0]


@contextlib.contextmanager
def workers(count, *arguments, **options):
    """Yields this many workers and ends them afterwards."""
    needs_worker()
    with farm(count, *arguments, **options) as started:
        yield started
