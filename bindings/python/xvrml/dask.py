"""Renders the frames of an animation on a Dask cluster. Install it with `pip install xvrml[dask]`,
on every Dask worker too.

>>> from dask.distributed import Client
>>> import xvrml.dask
>>> with Client("scheduler:8786") as client:
...     for array in xvrml.dask.render_frames("world.wrl", times=[0, 0.5, 1], client=client, size=(640, 480)):
...         print(array.shape)

One task renders one frame: it advances the clock of the world to the frame's time in steps of 1/fps,
and renders. A frame therefore has the same bytes as with `vv --frames`, on any worker, and a frame
whose worker fails is rendered again. A worker reads the world once and keeps it, one for each of its
threads, until it gets a task of another film. To share a single picture among machines, use
xvrml.Cluster.
"""
from ._frames import Farm, render_film, render_frame

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
    return render_film(_Dask(client, int(retries)), world, times, out, fps, in_flight,
                       dict(options, threads=threads), browser)


class _Dask(Farm):

    def __init__(self, client, retries):
        self.client, self.retries = client, retries

    def threads(self):
        return sum(self.client.nthreads().values())

    def share(self, source):
        return self.client.scatter([source], broadcast=True, hash=False)[0]

    def submit(self, *arguments):
        return self.client.submit(render_frame,
                                  *arguments,
                                  retries=self.retries,
                                  pure=False,
                                  key=None)

    def result(self, handle):
        return handle.result()

    def cancel(self, handles):
        self.client.cancel(handles)
