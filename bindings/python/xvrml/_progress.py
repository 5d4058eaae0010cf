"""The bar that progress=True shows, on standard error."""
import sys
import time


class Bar:
    def __init__(self, stream=None, width=30):
        self._stream = stream or sys.stderr
        self._width = width
        self._begin = time.monotonic()
        self._shown = False

    def __call__(self, done):
        seconds = time.monotonic() - self._begin
        full = int(self._width * min(max(done, 0), 1))
        left = f"{seconds / done - seconds:.0f} s left" if done > 0.02 else ""
        self._stream.write(f"\r[{'#' * full}{'.' * (self._width - full)}] {100 * done:3.0f} %  {left:<12}")
        self._stream.flush()
        self._shown = True

    def close(self):
        if self._shown:
            self._stream.write("\r" + " " * (self._width + 24) + "\r")
            self._stream.flush()
