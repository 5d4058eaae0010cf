"""Shows the progress on standard error, for progress=True: a bar on a terminal, otherwise a line
every five seconds."""
import os
import sys
import time

_SECONDS = 5  # seconds between two lines of a log
_TEXT = 24  # characters beside the bar


def _columns(stream):
    """Returns the width of a terminal; 80 if it is not known."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or 80
    except (AttributeError, OSError, ValueError):
        return 80


class Bar:

    def __init__(self, stream=None, width=30):
        self._stream = stream or sys.stderr
        self._width = max(0, min(width, _columns(self._stream) - _TEXT - 1))
        self._begin = time.monotonic()
        self._next = self._begin + _SECONDS
        self._terminal = self._stream.isatty() if hasattr(self._stream, "isatty") else False
        self._shown = False

    def __call__(self, done):
        now = time.monotonic()
        seconds = now - self._begin
        left = f"{seconds / done - seconds:.0f} s left" if done > 0.02 else ""
        if self._terminal:
            full = int(self._width * min(max(done, 0), 1))
            self._stream.write(
                f"\r[{'#' * full}{'.' * (self._width - full)}] {100 * done:3.0f} %  {left:<12}")
        elif now >= self._next:
            self._next = now + _SECONDS
            self._stream.write(
                f"xvrml: {100 * done:.0f} %, {seconds:.0f} s{', ' + left if left else ''}\n")
        else:
            return
        self._stream.flush()
        self._shown = True

    def close(self):
        if self._shown and self._terminal:
            self._stream.write("\r" + " " * (self._width + _TEXT) + "\r")
            self._stream.flush()
