#!/usr/bin/env python3
"""Measures the memory of `vv serve` with pages of 4,096 x 1,024 pixels that have views of their own.

    tools/serve_memory.py [--world WORLD] [--pages 1 8] [--seconds 60]

prints for each number of pages the resident megabytes of the process: before the first page, at
most, and after so many seconds. Options after -- are for vv serve (-- --spp 8). Needs pytest and Pillow.
"""
import argparse
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/python"))
from page_client import Served  # noqa: E402

WIDTH, HEIGHT = 4096, 1024
ROOM = pathlib.Path(__file__).resolve().parents[1] / "examples/optics/lit_room.wrl"


def memory(server, what):
    with open(f"/proc/{server.program.pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(what))


def measure(world, count, seconds, options):
    """Returns megabytes: before the first page, at most, at the end."""
    server = Served(".", [world, "--port", 0, *options])
    before = memory(server, "VmRSS")
    pages = []
    for _ in range(count):
        pages.append(server.join(WIDTH, HEIGHT))
        if len(pages) > 1:
            pages[-1].send(type="own")
    time.sleep(seconds)
    found = before, memory(server, "VmHWM"), memory(server, "VmRSS")
    shown = sum(p.pictures[-1].width * p.pictures[-1].height for p in pages if p.pictures)
    server.kill()
    return *found, shown


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--world", default=ROOM)
    parser.add_argument("--pages", type=int, nargs="+", default=[1, 8])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("options", nargs="*", help="for vv serve, after --")
    arguments = parser.parse_args()
    for count in arguments.pages:
        before, most, end, shown = measure(arguments.world, count, arguments.seconds, arguments.options)
        print(f"{count} pages: {before:.0f} MB before, at most {most:.0f} MB, {end:.0f} MB after "
              f"{arguments.seconds:g} s; {shown / 1e6:.1f} million pixels shown", flush=True)


if __name__ == "__main__":
    main()
