"""Methods of World and Node that need nothing but other methods of theirs. Importing the package does not need numpy: programs of
Scripts run in interpreters that may not have it."""
import contextlib
import math

from . import _arguments


class _Text:
    """What load() takes for a file object: text with the name of the file that it stands for."""

    def __init__(self, text, name):
        self._text = text
        self.name = name

    def read(self):
        return self._text


def loads(text, path="<memory>", *, limits=None, allow_absolute=False):
    """A world from VRML97 text (str or bytes), as json.loads is to json.load. path: the file that the text stands for; relative urls
    in it are looked up beside that file. Raises ParseError."""
    from ._xvrml import load
    if not isinstance(text, (str, bytes, bytearray, memoryview)):
        raise TypeError(f"loads(): text: a str or bytes expected, not the {type(text).__name__} {text!r}; load() takes files")
    return load(_Text(text if isinstance(text, str) else bytes(text), str(path)), limits=limits, allow_absolute=allow_absolute)


def _reduce(self):
    """What pickle and copy.deepcopy keep of a World: its text, as to_vrml() gives it, and its path. Its clock begins anew."""
    from ._xvrml import Browser
    if isinstance(self, Browser):
        raise TypeError("a Browser cannot be pickled: it runs; pickle the World that it was made from, or its to_vrml()")
    return loads, (self.to_vrml(), self.path)


def _end(world, end):
    """The node and the event of "Clock.fraction_changed" or of (node, "fraction_changed")."""
    if isinstance(end, str):
        name, dot, event = end.rpartition(".")
        if not dot:
            raise ValueError(f"'NAME.event' expected, not {end!r}")
        return world[name], event
    if not isinstance(end, (tuple, list)) or len(end) != 2:
        raise TypeError(f"'NAME.event' or a tuple (node, 'event') expected, not {_arguments._short(end)}")
    return tuple(end)


def on(self, event, callback=None):
    """Calls callback(value, time) after an eventOut or exposedField has sent. event: "NAME.event" or (node, "event"). A decorator
    without a callback."""
    node, name = _end(self, event)

    def register(function):
        self.listen(node, name, function)
        return function

    return register if callback is None else register(callback)


def route(self, source, target):
    """ROUTE source TO target, each "NAME.event" or (node, "event")."""
    if not self.add_route(*_end(self, source), *_end(self, target)):
        raise ValueError(f"no route from {source} to {target}")


def unroute(self, source, target):
    """Takes a route away; False if there was none."""
    return self.delete_route(*_end(self, source), *_end(self, target))


def _times(name, start, stop, fps):
    """The numbers of the first picture and of the one after the last, at fps pictures a second."""
    start, stop = _arguments.number(f"{name}: start", start), _arguments.number(f"{name}: stop", stop)
    fps = _arguments.number(f"{name}: fps", fps, above=0)
    if stop < start:
        raise ValueError(f"{name}: stop={stop:g} is before start={start:g}")
    return round(start * fps), round(stop * fps)


def _pictures(self, first, end, fps, options):
    step = math.ceil(self.time * fps - 1e-9)  # the first that is not over
    if first < step:
        raise ValueError(f"the world's time is {self.time} already: it does not go back to {first / fps}")
    for number in range(first, end):
        for between in range(step, number + 1):
            self.time = max(between / fps, self.time)
        step = number + 1
        yield self.render(**options)


def animate(self, start, stop, fps=25, **options):
    """Pictures of the times from start up to stop (excluded), fps of them a second; options are those of render. The clock gets
    there in steps of 1/fps from 0, so that a picture of some time is the same whatever was pictured before it."""
    first, end = _times("animate()", start, stop, fps)
    return _pictures(self, first, end, fps, options)


def film(self, path, start, stop, fps=25, **options):
    """Writes a film of the times from start up to stop (excluded): the pictures of animate(), whose options are those of render,
    and at least the first. The suffix of path (mp4, webm, gif) says the format."""
    from ._xvrml import Film
    first, end = _times("film()", start, stop, fps)
    with Film(path, fps) as file:
        for picture in _pictures(self, first, max(end, first + 1), fps, options):
            file.add(picture)


def raycaster(self, spheres=0):
    """A Raycaster (xvrml.rt) of what is drawn now. Its geometry ids are places in its list `meshes`; meshes[i].node is the Shape.
    spheres: see meshes(); 0: they are exact."""
    from .rt import Raycaster
    caster = Raycaster()
    for mesh in self.meshes(spheres=spheres):
        caster.add_mesh(mesh)
    return caster


@property
def bounds(self):
    """The box that everything drawn lies in: float64 of shape (2, 3), the lower and the upper corner; None where nothing is drawn.
    Of levels of detail the first."""
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


@contextlib.contextmanager
def edit(self, field):
    """A copy of a field's numbers that can be written to; the field is assigned when the block ends without an exception.

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
    for function in (on, route, unroute, animate, film, raycaster):
        setattr(world, function.__name__, function)
    world.__reduce__ = _reduce
    world.bounds = bounds
    node.edit = edit
