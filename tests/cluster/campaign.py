#!/usr/bin/env python3
"""Runs the slow part of the cluster's acceptance tests (`make cluster-campaign`). Prints a table of
measurements; fails if bytes differ or memory grows.

campaign.py [--kills N] [--frames N] [--partition SECONDS]"""
import argparse
import random
import sys
import threading
import time

import openrt_c
from farm import cluster, descriptors, farm, resident

FRAME = {"width": 96, "height": 72, "spp": 32}
rows = []


def note(what, text, good=True):
    rows.append((what, text, good))
    print(f"{'ok ' if good else 'BAD'}  {what}: {text}", flush=True)


def frames_until(context, expected, over):
    """Renders until over() is true. Returns the number of frames, the number of wrong ones, and the
    longest time."""
    made = wrong = 0
    longest = 0.0
    while not over():
        begin = time.monotonic()
        wrong += context.render() != expected
        longest = max(longest, time.monotonic() - begin)
        made += 1
    return made, wrong, longest


def random_kills(expected, kills):
    """Kills workers at random moments and restarts them while frames are rendered."""
    rng = random.Random(11)
    with farm(4) as workers, openrt_c.context(cluster(workers), **FRAME) as c:
        begin = time.monotonic()
        c.render()
        calm = time.monotonic() - begin
        done = 0

        def killer():
            nonlocal done
            while done < kills:
                time.sleep(rng.uniform(0, 2 * calm))
                worker = rng.choice(workers)
                worker.kill()
                time.sleep(rng.uniform(0, calm))
                worker.start()
                done += 1

        thread = threading.Thread(target=killer)
        thread.start()
        made, wrong, longest = frames_until(c, expected, lambda: not thread.is_alive())
        thread.join()
        note(
            "random kills",
            f"{kills} kills, {made} frames, {wrong} wrong; a frame takes {calm:.2f} s, the longest {longest:.2f} s",
            wrong == 0)


def long_partition(expected, seconds):
    with farm(2, proxy=True) as workers, openrt_c.context(cluster(workers), **FRAME) as c:
        c.render()
        workers[0].proxy.partition()
        timer = threading.Timer(seconds, workers[0].proxy.heal)
        timer.start()
        made, wrong, longest = frames_until(c, expected, lambda: not timer.is_alive())
        begin = time.monotonic()
        returned = c.wait_for(2, 30)
        back = time.monotonic() - begin
        wrong += c.render() != expected
        note(f"partition of {seconds:g} s",
             f"{made} frames, {wrong} wrong, the longest {longest:.2f} s; back after {back:.2f} s",
             wrong == 0 and returned)


def stopped(expected):
    """One of two workers is stopped for three seconds. Compares the time of such a frame with that
    of one worker alone."""
    with farm(2) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        c.render()
        begin = time.monotonic()
        c.render()
        calm = time.monotonic() - begin
        workers[0].stop()
        timer = threading.Timer(3, workers[0].resume)
        timer.start()
        made, wrong, longest = frames_until(c, expected, lambda: not timer.is_alive())
        note(
            "one of two stopped",
            f"{calm:.2f} s a frame with both; {made} frames meanwhile, {wrong} wrong, the longest {longest:.2f} s",
            wrong == 0)


def latency(expected):
    with farm(2, proxy=True) as workers, openrt_c.context(cluster(workers, local=0), **FRAME) as c:
        c.render()
        for delay in (0.0, 0.005, 0.05, 0.2):
            for w in workers:
                w.proxy.delay = delay
            c.render()
            begin = time.monotonic()
            good = c.render() == expected
            note(f"links of {1000 * delay:g} ms each way",
                 f"{time.monotonic() - begin:.2f} s a frame", good)


def many_frames(frames):
    """Renders an animation while workers join and leave. Measures memory and descriptors of the
    master."""
    small = {"width": 32, "height": 24, "spp": 2}
    rng = random.Random(5)
    with openrt_c.context("threads=1", **small) as alone, farm(3) as workers, openrt_c.context(
            cluster(workers), **small) as c:
        sizes = []
        for i in range(frames):
            c.rt.rtMakeCurrent(c.handle)
            c.move(0.01 * i)
            out = c.render()
            if i % 50 == 0:
                alone.rt.rtMakeCurrent(alone.handle)
                alone.move(0.01 * i)
                if alone.render() != out:
                    note("animation", f"frame {i} differs", False)
            if i % 500 == 499:
                worker = rng.choice(workers)
                worker.kill()
                worker.start()
                sizes.append(
                    (resident(), descriptors(), max(resident(w.process.pid) for w in workers)))
        half = sizes[len(sizes) // 4:]  # skips the warm-up
        slope = (half[-1][0] - half[0][0]) / (500 * max(len(half) - 1, 1))
        note(
            "animation",
            f"{frames} frames; master {half[0][0] >> 20} to {half[-1][0] >> 20} MB ({slope:.0f} bytes a frame), "
            f"{half[0][1]} to {half[-1][1]} descriptors; workers up to {max(s[2] for s in sizes) >> 20} MB",
            slope < 1024 and half[-1][1] <= half[0][1] + 3)


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--kills", type=int, default=100)
    options.add_argument("--frames", type=int, default=10_000)
    options.add_argument("--partition", type=float, default=30)
    given = options.parse_args()
    expected = openrt_c.reference(**FRAME)
    random_kills(expected, given.kills)
    long_partition(expected, given.partition)
    stopped(expected)
    latency(expected)
    many_frames(given.frames)
    return 0 if all(good for _, _, good in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
