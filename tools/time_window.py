#!/usr/bin/env python3
"""Measures the seconds from the start of vv until its window shows a picture of a world.

time_window.py VV WORLD [RUNS]

Each run has an X server of its own (Xvfb), whose screen is read until its middle has more than one
colour: a message at the lower border is no picture. Needs Xvfb and Pillow. Prints the seconds of each
run, and their median."""
import pathlib
import statistics
import subprocess
import sys
import time

from PIL import ImageGrab

PATIENCE = 60  # seconds until a picture must have appeared
WIDTH, HEIGHT = 800, 600
MIDDLE = (0, HEIGHT // 4, WIDTH, 3 * HEIGHT // 4)


def begin_display():
    """Returns the process of a display, and its name."""
    server = subprocess.Popen(["Xvfb", "-noreset", "-displayfd", "1", "-screen", "0", f"{WIDTH}x{HEIGHT}x24"],
                              stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL,
                              text=True)
    return server, ":" + server.stdout.readline().strip()


def seconds_until_picture(vv, world):
    server, display = begin_display()
    shown = None
    try:
        begin = time.monotonic()
        environment = {"DISPLAY": display, "PATH": "/usr/bin:/bin"}
        with subprocess.Popen([vv, world], env=environment) as program:
            while shown is None and time.monotonic() < begin + PATIENCE:
                if program.poll() is not None:
                    raise SystemExit(f"time_window.py: vv has ended with the code {program.returncode}")
                screen = ImageGrab.grab(xdisplay=display).crop(MIDDLE)
                low, high = screen.convert("L").getextrema()
                if low != high:
                    shown = time.monotonic() - begin
            program.terminate()
    finally:
        server.terminate()
        server.wait()
    if shown is None:
        raise SystemExit(f"time_window.py: no picture within {PATIENCE} seconds")
    return shown


def main():
    if len(sys.argv) not in (3, 4):
        raise SystemExit(__doc__)
    vv, world = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:3])
    count = int(sys.argv[3]) if len(sys.argv) == 4 else 5
    runs = [seconds_until_picture(vv, world) for _ in range(count)]
    print(*(f"{seconds:.2f}" for seconds in runs), f"median {statistics.median(runs):.2f} s")


if __name__ == "__main__":
    main()
