"""Renders the frames of an animation on a Ray cluster. Install it with `pip install xvrml[ray]`, on
every node too.

>>> import ray
>>> import xvrml.ray
>>> ray.init()
>>> for array in xvrml.ray.render_frames("world.wrl", times=[0, 0.5, 1], size=(640, 480)):
...     print(array.shape)

Tasks, bytes of frames and what workers keep are as in xvrml.dask.
"""
from ._frames import Farm, render_film, render_frame

__all__ = ["render_frames"]


def render_frames(world,
                  times,
                  *,
                  out=None,
                  fps=30.0,
                  retries=3,
                  in_flight=None,
                  threads=1,
                  browser=None,
                  **options):
    """Renders the world at each of these times (seconds of its clock) on the Ray cluster that
    ray.init() has connected to, in order. A task takes `threads` CPUs. The other arguments, and what
    is returned, are those of xvrml.dask.render_frames.
    """
    return render_film(_Ray(int(retries), int(threads)), world, times, out, fps, in_flight,
                       dict(options, threads=threads), browser)


class _Ray(Farm):

    def __init__(self, retries, threads):
        try:
            import ray
        except ModuleNotFoundError as error:
            raise ModuleNotFoundError(
                f"render_frames() needs the package {error.name}, which is not installed: "
                "pip install xvrml[ray]",
                name=error.name) from None
        self.ray, self.cpus = ray, max(1, threads)
        self.task = ray.remote(num_cpus=self.cpus, max_retries=retries)(render_frame)

    def threads(self):
        return int(self.ray.cluster_resources().get("CPU", 1)) // self.cpus

    def share(self, source):
        return self.ray.put(source)

    def submit(self, *arguments):
        return self.task.remote(*arguments)

    def result(self, handle):
        try:
            return self.ray.get(handle)
        except self.ray.exceptions.RayTaskError as error:
            raise error.cause from None  # the task's own error, as Dask raises it

    def cancel(self, handles):
        for handle in handles:
            self.ray.cancel(handle, force=False)
