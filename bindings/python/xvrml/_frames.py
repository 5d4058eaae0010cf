"""Renders an animation on a farm of other programs, one task for each frame: what xvrml.dask and
xvrml.ray have in common. A worker keeps the world of a film between its tasks and lets it run on, so
that n frames cost n steps and one parse for each thread, not n²/2 steps and n parses.
"""
import io
import math
import os
import pathlib
import tempfile
import threading
import uuid
from collections import deque

from . import Browser, World

# A larger world is sent once instead of with every task.
LARGE = 100_000


_mine = threading.local()  # kept: the world that this thread's last task has left


class _Kept:
    """A world of a film that has run up to `time`."""

    def __init__(self, film, world):
        self.film, self.world, self.step, self.time = film, world, 0, 0

    def run_to(self, time, fps):
        """Steps up to a time, as vv does. Returns whether all steps so far were multiples of 1/fps:
        only then a later frame may go on from here and still be that of `vv --frames`."""
        while self.step / fps < time:
            self.world.tick(self.step / fps)
            self.step += 1
        regular = self.step / fps == time
        if self.step == 0 or self.time != time:
            self.world.tick(time)
            self.step += regular
        self.time = time
        return regular or (self.step - 1) / fps == time


def _load(source, browser):
    if isinstance(source, tuple):
        data = io.BytesIO(source[0])
        data.name = source[1] or "<memory>"
        source = data
    return Browser(source, **browser)


def render_frame(film, source, time, fps, suffix, options, browser):
    """Renders one frame. film: identifies the film, all of whose frames have the same source, fps
    and browser. source: a path, or (bytes, name). Returns an array, or with a suffix the bytes of a
    file."""
    kept, _mine.kept = getattr(_mine, "kept", None), None
    if not kept or kept.film != film or kept.time > time:
        kept = None  # frees it before the next one is read
        kept = _Kept(film, _load(source, browser))
    goes_on = kept.run_to(time, fps)
    picture = kept.world.render(**options)
    if suffix is None:
        made = picture.array.copy()
    else:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / ("frame" + suffix)
            picture.save(path)
            made = path.read_bytes()
    if goes_on:
        _mine.kept = kept
    return made


class Farm:
    """Says how tasks are given to the workers of a farm."""

    def threads(self):
        """Returns how many tasks the farm can do at once."""
        raise NotImplementedError

    def share(self, source):
        """Sends a world to all workers; returns what a task gets in its place."""
        return source

    def submit(self, *arguments):
        """Lets a worker call render_frame with these arguments; returns a handle."""
        raise NotImplementedError

    def result(self, handle):
        raise NotImplementedError

    def cancel(self, handles):
        raise NotImplementedError


def render_film(farm, world, times, out, fps, in_flight, options, browser):
    """Renders the world at these times; xvrml.dask.render_frames documents the arguments."""
    times, fps, suffix = list(times), float(fps), None
    if not 0 < fps < math.inf:
        raise ValueError("fps: a finite number above 0 expected")
    if in_flight is not None and in_flight < 1:
        raise ValueError("in_flight: a number from 1 on expected")
    if not all(math.isfinite(time) for time in times) or any(later < earlier for earlier, later in zip([0, *times], times)):
        raise ValueError("times: from 0 on, in their order expected")
    if out is not None:
        suffix = pathlib.Path(str(out)).suffix
        if len(times) > 1 and str(out).format(frame=0) == str(out).format(frame=1):
            raise ValueError("out: a path with {frame} in it expected, not " + str(out))
    frames = _results(farm, _source(world), times, in_flight,
                      (fps, suffix, options, browser or {}))
    if out is None:
        return frames
    paths = []
    for number, data in enumerate(frames):
        path = str(out).format(frame=number)
        _write(path, data)
        paths.append(path)
    return paths


def _results(farm, source, times, in_flight, how):
    """Yields the frames in their order, and submits them as they are consumed."""
    if isinstance(source, tuple) and len(source[0]) > LARGE:
        source = farm.share(source)
    most = in_flight or 2 * max(1, farm.threads())
    film, waiting, out_there = uuid.uuid4().hex, deque(times), deque()
    try:
        while waiting or out_there:
            while waiting and len(out_there) < most:
                out_there.append(farm.submit(film, source, waiting.popleft(), *how))
            yield farm.result(out_there[0])
            out_there.popleft()  # the farm forgets the result together with the handle
    finally:
        farm.cancel(list(out_there))


def _source(world):
    """Returns the world for a task: a path, or (bytes, name)."""
    if isinstance(world, World):
        return world.to_vrml().encode("utf-8", "surrogateescape"), world.path
    if isinstance(world, (bytes, bytearray, memoryview)):
        return bytes(world), ""
    return os.path.abspath(os.fspath(world))


def _write(path, data):
    """Writes to a temporary file and renames it, so that readers see only complete files."""
    folder = os.path.dirname(os.path.abspath(path))
    with tempfile.NamedTemporaryFile(dir=folder, prefix=".xvrml-", delete=False) as file:
        file.write(data)
    try:
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(file.name, 0o666 & ~mask)
        os.replace(file.name, path)
    except BaseException:
        os.unlink(file.name)
        raise
