"""Implements the methods of World and Node that are written in Python. They import numpy only when
they need it: the Python of a Script may not have it."""
import contextlib
import math

from . import _arguments


class _Text:
    """A file object for load(): text, and the name of the file that the text stands for."""

    def __init__(self, text, name):
        self._text = text
        self.name = name

    def read(self):
        return self._text


def loads(text, path="<memory>", *, limits=None, allow_absolute=False):
    """Loads a world from VRML97 text (str or bytes), as json.loads does for JSON. path: the file
    that the text stands for; relative URLs are resolved against it. Raises ParseError."""
    from ._xvrml import load
    if not isinstance(text, (str, bytes, bytearray, memoryview)):
        raise TypeError(
            f"loads(): text: a str or bytes expected, not the {type(text).__name__} {text!r}; load() takes files"
        )
    return load(_Text(text if isinstance(text, str) else bytes(text), str(path)),
                limits=limits,
                allow_absolute=allow_absolute)


def _reduce(self):
    """Reduces a World for pickle and copy.deepcopy to its text, as to_vrml() returns it, and its
    path. The copy's clock starts again."""
    from ._xvrml import Browser
    if isinstance(self, Browser):
        raise TypeError(
            "a Browser cannot be pickled: it runs; pickle the World that it was made from, or its to_vrml()"
        )
    return loads, (self.to_vrml(), self.path)


def _end(world, end):
    """Returns node and event for "Clock.fraction_changed" or (node, "fraction_changed")."""
    if isinstance(end, str):
        name, dot, event = end.rpartition(".")
        if not dot:
            raise ValueError(f"'NAME.event' expected, not {end!r}")
        return world[name], event
    if not isinstance(end, (tuple, list)) or len(end) != 2:
        raise TypeError(
            f"'NAME.event' or a tuple (node, 'event') expected, not {_arguments._short(end)}")
    return tuple(end)


def on(self, event, callback=None):
    """Calls callback(value, time) after an eventOut or exposedField has sent. event: "NAME.event"
    or (node, "event"). Without a callback, this is a decorator."""
    node, name = _end(self, event)

    def register(function):
        self.listen(node, name, function)
        return function

    return register if callback is None else register(callback)


def route(self, source, target):
    """Adds ROUTE source TO target; each is "NAME.event" or (node, "event")."""
    if not self.add_route(*_end(self, source), *_end(self, target)):
        raise ValueError(f"no route from {source} to {target}")


def unroute(self, source, target):
    """Removes a route; returns False if there was none."""
    return self.delete_route(*_end(self, source), *_end(self, target))


def _times(name, start, stop, fps):
    """Returns the numbers of the first picture and of the one after the last, at fps pictures per
    second."""
    start, stop = _arguments.number(f"{name}: start",
                                    start), _arguments.number(f"{name}: stop", stop)
    fps = _arguments.number(f"{name}: fps", fps, above=0)
    if stop < start:
        raise ValueError(f"{name}: stop={stop:g} is before start={start:g}")
    return round(start * fps), round(stop * fps)


def _pictures(self, first, end, fps, options):
    step = math.ceil(self.time * fps - 1e-9)  # the first step that is not in the past
    if first < step:
        raise ValueError(
            f"the world's time is {self.time} already: it does not go back to {first / fps}")
    for number in range(first, end):
        for between in range(step, number + 1):
            self.time = max(between / fps, self.time)
        step = number + 1
        yield self.render(**options)


def animate(self, start, stop, fps=25, **options):
    """Yields pictures for the times from start to stop (excluded), fps per second. The options are
    those of render. The clock advances in steps of 1/fps from 0, so that the picture for a given
    time does not depend on earlier pictures."""
    first, end = _times("animate()", start, stop, fps)
    return _pictures(self, first, end, fps, options)


def film(self, path, start, stop, fps=25, **options):
    """Writes a film for the times from start to stop (excluded), with at least one picture. The
    options are those of render, as for animate(). The suffix of path (mp4, webm, gif) selects the
    format."""
    from ._xvrml import Film
    first, end = _times("film()", start, stop, fps)
    with Film(path, fps) as file:
        for picture in _pictures(self, first, max(end, first + 1), fps, options):
            file.add(picture)


def raycaster(self, spheres=0):
    """Returns a Raycaster (xvrml.rt) of what is drawn now. Its geometry ids are indices into its
    list `meshes`; meshes[i].node is the Shape. spheres: see meshes(); 0: exact spheres."""
    from .rt import Raycaster
    caster = Raycaster()
    for mesh in self.meshes(spheres=spheres):
        caster.add_mesh(mesh)
    return caster


@property
def bounds(self):
    """The bounding box of everything drawn: float64 of shape (2, 3), the lower and the upper
    corner; None if nothing is drawn. A level of detail counts with its first level."""
    import numpy as np
    corners = []
    for mesh in self.meshes(spheres=0):
        if mesh.kind == "sphere":
            reach = mesh.radius * np.linalg.norm(mesh.matrix[:3, :3], axis=1)
            corners += [mesh.matrix[:3, 3] - reach, mesh.matrix[:3, 3] + reach]
        else:
            points = mesh.world_vertices[np.unique(mesh.faces)]
            corners += [points.min(0), points.max(0)] if len(points) else []
    return np.array([np.min(corners, 0), np.max(corners, 0)]) if corners else None


def view(self, size=(640, 480), **options):
    """Returns a live view of the world for a notebook: a widget that shows the running world and
    takes the mouse and the keys. The options are those of LiveView. Needs the package
    jupyter_rfb."""
    try:
        from .notebook import View
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            f"world.view() needs the package {error.name}, which is not installed: pip install jupyter_rfb",
            name=error.name) from error
    return View(self, size, **options)


_SMALL = dict(size=(320, 240), spp=16, time_limit=1)  # the picture of a world in a notebook


def _repr_png_(self):
    """Returns a small picture of the world, made anew after a change; None if there can be none
    now."""
    from ._xvrml import RenderError
    known = self.__dict__.get("_small")
    if known is None or known[0] != self._edits:
        try:
            picture = self.render(**_SMALL)
        except RenderError:
            return None
        known = self.__dict__["_small"] = self._edits, picture._repr_png_()
    return known[1]


@contextlib.contextmanager
def edit(self, field):
    """Gives write access to a copy of a field's numbers. The field is assigned when the block ends
    without an exception.

    >>> with coord.edit("point") as p:
    ...     p[:, 1] += 1
    """
    value = getattr(self, field)
    if not hasattr(value, "setflags"):  # a numpy array has it
        raise TypeError(f"{self.node_type}.{field} is no list of numbers: assign it")
    array = value.copy()
    yield array
    setattr(self, field, array)


def complete(world, node):
    from ._renderer import render_with
    for function in (on, route, unroute, animate, film, raycaster, render_with, view, _repr_png_):
        setattr(world, function.__name__, function)
    world.__reduce__ = _reduce
    world.bounds = bounds
    node.edit = edit
