"""Applies the events of a view to a running world: the pointer on its sensors, navigation by mouse
and keys, viewpoints. The events are those of jupyter_rfb (https://jupyter-rfb.readthedocs.io, "the
event spec"). The mouse and the keys do what they do in vv's window (docs/window.md)."""
import math

_NOTCH = 0.2  # one notch of the wheel: full speed for this many seconds
_NOTCH_PIXELS = 100
_DEAD = 0.02  # a drag shorter than this part of half the picture does nothing in walk and fly
_ARROWS = {"ArrowLeft": "left", "ArrowRight": "right", "ArrowUp": "up", "ArrowDown": "down"}
_NAVIGATION = {"1": "examine", "2": "walk", "3": "fly", "4": "none"}
_VIEWPOINTS = {
    "PageUp": "page_up",
    "[": "page_up",
    "PageDown": "page_down",
    "]": "page_down",
    "Backspace": "home"
}


def _number(event, name, least=-1e9):
    value = event.get(name)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ValueError(f"event {kind_of(event)}: {name}: a number expected, not {value!r}")
    return min(max(float(value), least), 1e9)


def kind_of(event):
    """Returns the type of an event; older versions of jupyter_rfb have another key for it."""
    if not isinstance(event, dict):
        raise TypeError(
            f"event: a dict expected, not an object of the class {type(event).__name__}")
    return event.get("type", event.get("event_type"))


def size_of(event):
    """Returns the size of a resize event in CSS pixels and in pixels of the screen."""
    width, height = _number(event, "width", 1), _number(event, "height", 1)
    name = "ratio" if "ratio" in event else "pixel_ratio"
    ratio = min(_number(event, name, 0.1), 8) if name in event else 1
    return (width, height), (max(1, round(width * ratio)), max(1, round(height * ratio)))


def _speed(way):
    """Returns the speed for a drag in walk and fly. It rises slowly at first."""
    far = max(0.0, abs(way) - _DEAD)
    return math.copysign(far + 3 * far * far, way)


class Pilot:
    """viewer: the _xvrml.Viewer of the view. clock: has the attribute `paused`."""

    def __init__(self, viewer, clock, size):
        self._viewer = viewer
        self._clock = clock
        self.size = size  # in the pixels that the events count in
        self._inside = False
        self._at = (0.0, 0.0)  # the pointer's place, from -1 to 1
        self._drag = None  # None, "sensor" or "view"
        self._pressed = (0.0, 0.0)
        self._button = None  # that began the drag: 1 left, 2 right, 3 middle
        self._acts_as = None  # the same; Shift and Control stand for other buttons
        self._held = set()
        self._modifiers = frozenset()
        self._walks = False  # gravity acts, because the user has walked

    def handle(self, event):
        kind = kind_of(event)
        if "modifiers" in event:
            self._modifiers = frozenset(event["modifiers"])
        if kind in ("pointer_move", "pointer_enter", "pointer_down", "pointer_up"):
            self._point(kind, event)
        elif kind == "pointer_leave":
            if self._drag is None:  # the drag goes on outside of the picture
                self._leave()
        elif kind == "wheel":
            notches = -_number(event, "dy") / _NOTCH_PIXELS
            self._navigate(_NOTCH, ahead=min(max(notches, -10), 10))
        elif kind == "key_down":
            self._press(event.get("key"))
        elif kind == "key_up":
            self._held.discard(_ARROWS.get(event.get("key")))

    def rest(self):
        """Forgets held keys and the pointer: the view is no longer visible."""
        self._held.clear()
        self._drag = None
        if self._inside:
            self._leave()

    # The pointer

    def _point(self, kind, event):
        x = 2 * _number(event, "x") / self.size[0] - 1
        y = 1 - 2 * _number(event, "y") / self.size[1]
        way = (x - self._at[0], y - self._at[1])
        self._at, self._inside = (x, y), True
        if kind == "pointer_down":
            self._begin_drag(event.get("button", 1))
        elif self._drag == "view":
            self._turn(way)
        else:
            self.send()
        if kind == "pointer_up" and self._drag is not None:
            if event.get("button", self._button) in (self._button, 0):
                self._drag = None
                self.send()

    def send(self):
        """Sends the pointer to the sensors. Returns whether one is below it."""
        return self._inside and self._viewer.point(*self._at, self._drag == "sensor")

    def follow(self):
        """Sends the pointer again, because the world or the viewer has moved below it."""
        if self._inside and self._drag != "view":
            self.send()

    def _begin_drag(self, button):
        if self._drag is not None:
            return
        self._pressed, self._button = self._at, button
        self._acts_as = button
        if button == 1:
            self._acts_as = 2 if "Shift" in self._modifiers else 3 if "Control" in self._modifiers else 1
        over = self.send()
        self._drag = "sensor" if over and button == 1 else "view"
        if self._drag == "sensor":
            self.send()

    def _leave(self):
        self._inside, self._drag = False, None
        self._viewer.leave()

    # The viewer

    def _turn(self, way):
        """EXAMINE: the world follows the pointer. The other types use the way since the press, in
        move()."""
        if way == (0, 0) or self._viewer.navigation != "examine":
            return
        x, y = way
        if self._acts_as == 2:
            size = math.tan(self._viewer.fovy / 2)
            self._navigate(1, right=-x * size * self.size[0] / self.size[1], up=-y * size)
        elif self._acts_as == 3:
            self._navigate(1, ahead=y)
        else:
            self._navigate(1, turn=-x, tilt=y)

    def _navigate(self, seconds, **speeds):
        self._viewer.navigate(seconds, **speeds)
        self._walks = self._viewer.navigation == "walk"

    def move(self, seconds):
        """Moves the viewer by held keys and by drags."""
        if seconds <= 0:
            return
        speeds = dict.fromkeys(("ahead", "right", "up", "turn", "tilt"), 0.0)
        if self._drag == "view" and self._viewer.navigation != "examine":
            x, y = (_speed(to - start) for start, to in zip(self._pressed, self._at))
            if self._acts_as == 2:
                speeds.update(right=x, up=y)
            elif self._acts_as == 3:
                speeds.update(turn=-x, tilt=y)
            else:
                speeds.update(turn=-x, ahead=y)
        across = ("right" in self._held) - ("left" in self._held)
        along = ("up" in self._held) - ("down" in self._held)
        fast = 4 if "Shift" in self._modifiers else 1
        if "Alt" in self._modifiers:
            speeds["right"] += across * fast
            speeds["up"] += along * fast
        else:
            speeds["turn"] -= across
            speeds["ahead"] += along * fast
        if any(speeds.values()):
            self._navigate(seconds, **speeds)
        elif self._walks:
            self._viewer.navigate(seconds)

    def _press(self, key):
        if key in _ARROWS:
            self._held.add(_ARROWS[key])
            return
        if not isinstance(key, str) or self._modifiers & {"Control", "Alt", "Meta"}:
            return
        if key in _VIEWPOINTS or key in ("Home", "End"):
            self._walks = False
            try:
                if key in _VIEWPOINTS:
                    self._viewer.press(_VIEWPOINTS[key])
                else:
                    self._viewer.bind(0 if key == "Home" else -1)
            except IndexError:  # the world has no Viewpoint
                self._viewer.frame_all()
        elif key in _NAVIGATION:
            self._walks = False
            self._viewer.navigation = _NAVIGATION[key]
        elif key in ("f", "F"):
            self._walks = False
            self._viewer.frame_all()
        elif key in ("p", "P"):
            self._clock.paused = not self._clock.paused
