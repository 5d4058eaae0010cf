"""Shows the progress on standard error, for progress=True: a bar on a terminal, otherwise a line
every five seconds."""
import sys
import time

_SECONDS = 5  # seconds between two lines of a log


class Bar:

    def __init__(self, stream=None, width=30):
        self._stream = stream or sys.stderr
        self._width = width
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
            self._stream.write("\r" + " " * (self._width + 24) + "\r")
            self._stream.flush()
