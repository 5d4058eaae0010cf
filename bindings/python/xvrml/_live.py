"""Shows a running world while Python goes on: a LiveView renders on threads of its own, and step()
never waits for a picture. notebook.py puts it into a notebook; a program with an event loop of its
own calls step() from there."""
import collections
import time
import weakref

from . import _pilot
from ._xvrml import Viewer

_SOON = 0.008  # seconds until the next step while a frame is rendered or something moves
_QUIET = 0.1  # while nothing moves: a TimeSensor or a Script may begin by itself
_FRAME = 1 / 30  # seconds between the starts of two frames of something that moves
_PATIENCE = 0.05  # seconds that a step waits for Scripts, as in vv's window
_LONGEST = 0.25  # seconds of world time in one step: a long wait is no jump of the world


class _Clock:
    """Steps a world and lets its views take turns with its renderer. A world has at most one; its
    views own it."""

    def __init__(self, world):
        self.world = world
        self.paused = False
        self.stepping = False
        self._views = []  # weak references, in the order of their turns
        self._last = None  # the reading of the last step

    def add(self, view):
        self._views.append(weakref.ref(view))

    def remove(self, view):
        self._views = [one for one in self._views if one() not in (None, view)]

    def step(self, now):
        if self.stepping:  # called by a callback of the world
            return _SOON
        views = [view for view in (one() for one in self._views) if view is not None]
        shown = [view for view in views if view.visible]
        if not shown:
            self._last = None
            return None
        passed = min(max(now - self._last, 0), _LONGEST) if self._last is not None else 0
        state = shown[0]._viewer.state
        if state == "busy":  # the time goes on when the world is free again
            return _SOON
        self._last = now
        self.stepping = True
        try:
            for view in views:
                view._take_pictures(now)
            self.world._set_script_patience(_PATIENCE)
            self._advance(passed, shown)
        finally:  # the pictures go on after an exception of a callback
            self.world._set_script_patience(0)
            self.stepping = False
            self._draw(state, views, shown, now)
        if any(view._is_busy() for view in shown):
            return _SOON
        return None if self.paused else _QUIET

    def _advance(self, passed, views):
        if not self.paused:
            self.world.time = self.world.time + passed
        for view in views:
            view._take_events(passed)

    def _draw(self, state, views, shown, now):
        """Begins the next frame, or ends one that is refined while something has changed."""
        if state == "rendering":
            for view in views:
                if view._phase == "refining" and view._drawing:
                    if not view.visible or any(one._viewer.is_outdated for one in shown):
                        view._viewer.cancel()
            return
        outdated = [view for view in shown if view._viewer.is_outdated]
        unfinished = [view for view in shown if view._phase in ("moving", "refining")]
        for view in outdated or unfinished:
            if view._begin(bool(outdated), now):
                for one in views:
                    one._drawing = one is view
                self.remove(view)  # it goes to the end of the queue
                self.add(view)
                return


def _clock_of(world):
    known = world.__dict__.get("_clock")
    clock = known() if known else None
    if clock is None:
        clock = _Clock(world)
        world.__dict__["_clock"] = weakref.ref(clock)
    return clock


class LiveView:
    """One view of a running world. The options are those of World.render(), without channels, error,
    time_limit, cluster and progress.

    >>> view = xvrml.LiveView(world, size=(640, 480))
    >>> while view.is_open:
    ...     view.step()
    ...     picture = view.look()  # uint8 of shape (height, width, 3), or None
    """

    raw = False  # shows the samples of something that moves as they are
    on_wake = None  # called without arguments, on any thread, when another step() is of use

    def __init__(self, world, size=(640, 480), **options):
        self._viewer = Viewer(world, size=size, **options)
        self._end = weakref.finalize(self, self._viewer.close)  # also when the program ends
        self._clock = _clock_of(world)
        self._clock.add(self)
        self._pilot = _pilot.Pilot(self._viewer, self._clock, tuple(size))
        self._events = collections.deque()
        self._visible = True
        self._picture = None
        self._fresh = False
        self._facts = {}
        self._phase = "new"  # "new", "moving", "refining" or "done"
        self._drawing = False
        self._gap = 0.0  # smoothed seconds between the pictures of something that moves
        self._shown_at = None
        self._began_at = 0.0
        self_reference = weakref.ref(self)

        def changed():
            view = self_reference()
            if view is not None:
                view._wake()

        self._viewer.on_change = changed

    # Driving

    def step(self, now=None):
        """Advances the world's clock by the time since the last step, handles the events, and
        begins the next frame if one is due, for all views of the world. It does not wait for a
        picture. now: seconds of any clock that does not go back. Returns the seconds until another
        step is of use, or None if it is only after a call of on_wake. Raises the first exception of
        a callback."""
        return self._clock.step(time.monotonic() if now is None else now)

    def look(self):
        """Returns the newest picture, uint8 of shape (height, width, 3), first row at the top, or
        None if there is no newer one since the last call. A picture of something that moves can be
        smaller than the view."""
        picture, self._fresh = (self._picture if self._fresh else None), False
        return picture

    def wait(self, timeout=60):
        """Calls step() until the picture has all samples and nothing moves, and returns it. Raises
        TimeoutError after `timeout` seconds."""
        end = time.monotonic() + timeout
        while True:
            delay = self.step()
            if self.is_finished:
                self._fresh = False
                return self._picture
            if time.monotonic() > end or not self.is_open:
                raise TimeoutError(f"the picture is not finished after {timeout} s" if self.
                                   is_open else "the view is closed")
            time.sleep(delay or _SOON)

    def event(self, event):
        """Takes an event: a dict as jupyter_rfb sends it. The next step() handles it."""
        kind = _pilot.kind_of(event)
        if kind == "resize":
            self._pilot.size, size = _pilot.size_of(event)
            self.resize(*size)
        elif kind == "close":
            self.close()
        else:
            self._events.append(event)
        self._wake()

    def resize(self, width, height):
        self._viewer.resize(width, height)

    def close(self):
        """Ends the view. The world stays as it is."""
        self._clock.remove(self)
        self._end()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def __repr__(self):
        return f"<LiveView of {self.world!r}{'' if self.is_open else ', closed'}>"

    # State

    @property
    def world(self):
        return self._clock.world

    @property
    def is_open(self):
        return self._viewer.is_open

    @property
    def picture(self):
        """The newest picture; None before the first."""
        return self._picture

    @property
    def is_finished(self):
        """Whether the picture shows the world as it is now, with all samples."""
        return self._phase == "done" and not self._viewer.is_outdated

    @property
    def facts(self):
        """Returns what the newest picture is: size, samples (mean over the pixels), moving (one of
        a sequence, perhaps smaller than the view), preview (rebuilt from few samples), finished,
        seconds, frame_rate (0: nothing moves)."""
        moving = self._phase == "moving"
        return {**self._facts, "frame_rate": 1 / self._gap if moving and self._gap > 0 else 0.0}

    @property
    def camera(self):
        """The pose of the view, as World.render(camera=...) takes it; None before the first
        picture."""
        return self._viewer.camera

    @property
    def paused(self):
        """Whether the world's time stands still, for all views of the world."""
        return self._clock.paused

    @paused.setter
    def paused(self, paused):
        self._clock.paused = bool(paused)
        self._wake()

    @property
    def visible(self):
        """Whether somebody sees the view. While no view of the world is visible, nothing is
        rendered and the world's time stands still."""
        return self._visible and self.is_open

    @visible.setter
    def visible(self, visible):
        if self._visible and not visible:
            self._events.append({"type": "hidden"})
        self._visible = bool(visible)
        self._wake()

    # For the clock

    def _wake(self):
        if self.on_wake is not None and not self._clock.stepping:
            self.on_wake()

    def _is_busy(self):
        return self._phase != "done" or bool(self._events) or self._viewer.is_outdated

    def _take_pictures(self, now):
        try:
            while (found := self._viewer.look()) is not None:
                picture, facts = found
                moving = facts["moving"]
                if facts["finished"]:
                    if not moving:
                        self._phase = "done"
                    elif self._shown_at is not None:
                        gap = now - self._shown_at
                        self._gap = 0.9 * self._gap + 0.1 * gap if self._gap > 0 else gap
                    self._shown_at = now if moving else None
                # A part of a picture is not shown over the last one while something moves.
                if facts["finished"] or self._picture is None or not moving:
                    self._picture, self._facts, self._fresh = picture, facts, True
        except Exception:
            self._phase = "done"  # the same frame would fail again
            raise

    def _take_events(self, passed):
        if self._picture is None:  # no frame has read the world
            return
        while self._events:
            event = self._events.popleft()
            if event.get("type") == "hidden":
                self._pilot.rest()
            else:
                self._pilot.handle(event)
        self._pilot.move(passed)
        if self._viewer.is_outdated:
            self._pilot.follow()

    def _begin(self, moving, now):
        if moving and self._phase == "moving" and 0 <= now - self._began_at < _FRAME:
            return False
        if not self._viewer.start(moving, self.raw):
            return False
        self._began_at = now
        if moving and self._phase != "moving":
            self._gap, self._shown_at = 0.0, None
        self._phase = "moving" if moving else "refining"
        return True
