"""Shows a LiveView in a notebook: a widget of jupyter_rfb. It is imported on first use, because
jupyter_rfb is optional. The world's clock runs on the event loop of the notebook's kernel, between
the cells, so that the callbacks of a world run on the thread that the cells run on."""
import asyncio
import time

import jupyter_rfb

from ._live import LiveView

_TITLE_GAP = 0.5  # seconds between two titles: each is a message to the page
_SEND_GAP = 0.04  # seconds between two pictures that update() sends

__all__ = ["View"]


def _loop():
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


class View(jupyter_rfb.RemoteFrameBuffer):
    """A view of a running world in a notebook. The options are those of LiveView."""

    def __init__(self, world, size=(640, 480), **options):
        self.live = LiveView(world, size, **options)
        self.live.visible = False  # until the page says otherwise
        self.live.on_wake = self._wake
        self._timer = None
        self._loop = None  # the kernel's event loop, once it is known
        self._sent_at = self._titled_at = -1e9
        width, height = size
        super().__init__(css_width=f"{width}px", css_height=f"{height}px")
        if self.has_trait("has_titlebar"):
            self.has_titlebar, self.title = True, "..."
        visible = "_has_visible_views" if self.has_trait(
            "_has_visible_views") else "has_visible_views"
        self.observe(lambda change: self._show(change["new"]), names=visible)
        self._wake()

    # Methods that jupyter_rfb calls

    def get_frame(self):
        """Returns the newest picture, without waiting."""
        self._sent_at = time.monotonic()
        return self.live.picture

    def handle_event(self, event):
        if event.get("type", event.get("event_type")) == "close":
            self._end()
        elif self.live.is_open:
            self.live.event(event)

    def close(self, *arguments, **options):
        """Ends the view and removes it from the page. The world stays as it is."""
        self._end()
        super().close(*arguments, **options)

    # Driving

    def update(self):
        """Shows what a cell that is still running has changed: advances the world's clock and sends
        the newest picture, without waiting for one. While a cell runs, nothing else does this."""
        if not self.live.is_open:
            return
        self.live.step()
        if time.monotonic() - self._sent_at >= _SEND_GAP:
            picture = self.live.look()
            if picture is not None:
                self._sent_at = time.monotonic()
                self.send_frame(picture)

    def _show(self, visible):
        self.live.visible = bool(visible)

    def _wake(self):
        """Calls _run() soon on the kernel's event loop, from whichever thread this is called."""
        self._loop = self._loop or _loop()
        if self._loop is None or self._loop.is_closed():
            return
        if _loop() is self._loop:
            self._call_after(0)
        else:
            self._loop.call_soon_threadsafe(self._call_after, 0)

    def _call_after(self, seconds):
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._loop.call_later(seconds, self._run)

    def _run(self):
        self._timer = None
        delay = None
        with self._output_context:  # shows an exception below the cell that made the view
            try:
                delay = self.live.step()
            except BaseException:
                self.live.paused = True  # otherwise the same callback would fail at every step
                delay = 0.1
                raise
        if not self.live.is_open:
            return
        if self.live.look() is not None:
            self.request_draw()
        if not self._tell() and delay is None:
            delay = _TITLE_GAP
        if delay is not None and self._timer is None:
            self._call_after(delay)

    def _tell(self):
        """Says in the title what the picture is. Returns False if it is too early for that."""
        facts, now = self.live.facts, time.monotonic()
        if "size" not in facts or not self.has_trait("has_titlebar"):
            return True
        if facts["moving"]:
            text = f"preview, {facts['frame_rate']:.0f} frames/s"
        else:
            text = f"samples: {facts['samples']:.0f}"
        text += ", paused" if self.live.paused else ""
        if text == self.title:
            return True
        if now - self._titled_at < _TITLE_GAP:
            return False
        self.title, self._titled_at = text, now
        return True

    def _end(self):
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self.live.close()
