"""Renders the frames of an animation on a Dask cluster. Install it with `pip install xvrml[dask]`,
on every Dask worker too.

>>> from dask.distributed import Client
>>> import xvrml.dask
>>> with Client("scheduler:8786") as client:
...     for array in xvrml.dask.render_frames("world.wrl", times=[0, 0.5, 1], client=client, size=(640, 480)):
...         print(array.shape)

One task renders one frame: it reads the world, advances its clock to the frame's time in steps of
1/fps, and renders. A frame therefore has the same bytes as with `vv --frames`, on any worker, and a
frame whose worker fails is rendered again. To share a single picture among machines, use
xvrml.Cluster.
"""
import io
import os
import pathlib
import tempfile
from collections import deque

from . import Browser, World

__all__ = ["render_frames"]


def render_frames(world,
                  times,
                  client=None,
                  *,
                  out=None,
                  fps=30.0,
                  retries=3,
                  in_flight=None,
                  threads=1,
                  browser=None,
                  **options):
    """Renders the world at each of these times (seconds of its clock) on a Dask cluster, in order.

    world      a path that every Dask worker can read; or bytes or an xvrml.World, which are sent to
               the workers (files that such a world refers to are resolved against its own path, if
               the workers have them)
    client     a dask.distributed.Client; None: the current one
    out        None: returns an iterator of numpy arrays (float32, height x width x 4), which
               submits frames as they are consumed. A path with {frame} in it, such as
               "film-{frame:04}.png": this process, not a worker, writes the files, and their paths
               are returned
    fps        steps per second of the world's clock, as in vv
    retries    how often a frame is rendered again if its worker fails or is lost
    in_flight  maximum number of submitted frames, which limits the memory (default: two for each
               thread of the cluster)
    threads    rendering threads of a task
    browser    keyword arguments of xvrml.Browser (limits, allow_absolute)
    options    those of Browser.render: size, spp, viewpoint, transport ...
    """
    if client is None:
        try:
            from distributed import get_client
        except ModuleNotFoundError as error:
            raise ModuleNotFoundError(
                f"render_frames() without a client needs the package {error.name}, which is not installed: "
                "pip install xvrml[dask]",
                name=error.name) from None
        client = get_client()
    times, fps, suffix = list(times), float(fps), None
    if not fps > 0:
        raise ValueError("fps: a number above 0 expected")
    if any(later < earlier for earlier, later in zip([0, *times], times)):
        raise ValueError("times: from 0 on, in their order expected")
    if out is not None:
        suffix = pathlib.Path(str(out)).suffix
        if len(times) > 1 and str(out).format(frame=0) == str(out).format(frame=1):
            raise ValueError("out: a path with {frame} in it expected, not " + str(out))
    frames = _frames(_source(world), times, client, suffix, fps, int(retries), in_flight,
                     dict(options, threads=threads), browser or {})
    if out is None:
        return frames
    paths = []
    for number, data in enumerate(frames):
        path = str(out).format(frame=number)
        _write(path, data)
        paths.append(path)
    return paths


def _frames(source, times, client, suffix, fps, retries, in_flight, options, browser):
    # sent once instead of with every task
    if isinstance(source, tuple) and len(source[0]) > 100_000:
        source = client.scatter([source], broadcast=True, hash=False)[0]
    most = in_flight or 2 * max(1, sum(client.nthreads().values()))
    waiting, out_there = deque(times), deque()
    try:
        while waiting or out_there:
            while waiting and len(out_there) < most:
                out_there.append(
                    client.submit(_render,
                                  source,
                                  waiting.popleft(),
                                  fps,
                                  suffix,
                                  options,
                                  browser,
                                  retries=retries,
                                  pure=False,
                                  key=None))
            yield out_there[0].result()
            out_there.popleft()  # the cluster forgets the result together with the future
    finally:
        client.cancel(list(out_there))


def _source(world):
    """Returns the world for a task: a path, or (bytes, name)."""
    if isinstance(world, World):
        return world.to_vrml().encode("utf-8", "surrogateescape"), world.path
    if isinstance(world, (bytes, bytearray, memoryview)):
        return bytes(world), ""
    return os.path.abspath(os.fspath(world))


def _render(source, time, fps, suffix, options, browser):
    """Renders one frame on a Dask worker. Returns an array, or the bytes of a file."""
    if isinstance(source, tuple):
        data = io.BytesIO(source[0])
        data.name = source[1] or "<memory>"
        source = data
    running = Browser(source, **browser)
    step = 0
    while step / fps < time:
        running.tick(step / fps)
        step += 1
    running.tick(time)
    picture = running.render(**options)
    if suffix is None:
        return picture.array.copy()
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / ("frame" + suffix)
        picture.save(path)
        return path.read_bytes()


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
