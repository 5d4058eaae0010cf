#!/usr/bin/env python3
"""Runs a window and a cluster for long times and fails if their memory grows (`make soak`).

One run is a window under Xvfb with random mouse motion, clicks and keys, while Scripts create and
remove nodes and the world's file is rewritten. The other is a master whose workers are killed and
restarted. Both run at once, independently. It fails if one of them ends by itself or makes a wrong
frame, or if its memory or number of descriptors grows.

soak.py [--minutes N] [--window] [--cluster] [--out FOLDER]
    default: both, for 60 minutes, into build/soak"""
import argparse
import json
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "cluster"), str(HERE.parent / "python")]

import openrt_c  # noqa: E402
from farm import cluster, descriptors, farm, resident  # noqa: E402

WORLD = """#VRML V2.0 utf8
Viewpoint { position 0 0 12 description "front" }
Viewpoint { position 12 0 0 orientation 0 1 0 1.57 description "side" }
NavigationInfo { type [ "EXAMINE" "ANY" ] }
DEF Clock TimeSensor { cycleInterval 3 loop TRUE }
DEF Turn OrientationInterpolator { key [0 .5 1] keyValue [0 1 0 0, 0 1 0 3.14, 0 1 0 6.28] }
DEF Place Transform { children [ DEF Touch TouchSensor { }
  Shape { appearance Appearance { material DEF Paint Material { diffuseColor .8 .2 .1 } } geometry Box { } } ] }
DEF Nursery Group { }
DEF Breeder Script {
  eventIn SFFloat set_fraction eventIn SFTime touched eventOut SFColor colour field SFNode nursery USE Nursery directOutput TRUE
  field SFInt32 step 0
  url "javascript:function set_fraction(f, t) {
      step = step + 1;
      if (step % 10 == 0) {
        var made = Browser.createVrmlFromString('Transform { translation ' + (f * 8 - 4) + ' 2 0 children Shape { appearance ' +
          'Appearance { material Material { } } geometry Sphere { radius .4 } } }');
        nursery.children = made;
      }
      if (step % 50 == 0) nursery.children = new MFNode();
    }
    function touched(t) { colour = new SFColor(Math.abs(Math.sin(t)), .5, .2); }"
}
ROUTE Clock.fraction_changed TO Turn.set_fraction
ROUTE Turn.value_changed TO Place.set_rotation
ROUTE Clock.fraction_changed TO Breeder.set_fraction
ROUTE Touch.touchTime TO Breeder.touched
ROUTE Breeder.colour TO Paint.diffuseColor
"""
KEYS = ["Next", "Prior", "Home", "Left", "Right", "Up", "Down", "h", "F1"]
EVERY = 5  # seconds between two samples
FRAME = {"width": 48, "height": 36, "spp": 4}


def report(what, samples, talk):
    """Judges samples of (seconds, bytes, descriptors). Compares the second quarter with the last,
    so that caches may fill at first."""
    quarter = max(len(samples) // 4, 1)
    early, late = samples[quarter:2 * quarter] or samples, samples[-quarter:]
    before, after = (statistics.median(s[1] for s in part) for part in (early, late))
    hours = max(late[len(late) // 2][0] - early[len(early) // 2][0], 1) / 3600
    handles = statistics.median(s[2] for s in late) - statistics.median(s[2] for s in early)
    good = after - before <= max(1 << 20, 0.02 * before) and handles <= 3
    print(
        f"{'ok ' if good else 'BAD'}  {what}: {samples[-1][0] / 60:.1f} minutes, memory {before / 2**20:.1f} to {after / 2**20:.1f} MB "
        f"({(after - before) / hours / 2**20:+.2f} MB an hour), {handles:+.0f} descriptors; {talk}",
        flush=True)
    return good


def window(seconds, out):
    from xserver import display
    rng, folder = random.Random(7), pathlib.Path(tempfile.mkdtemp())
    world = folder / "world.wrl"
    world.write_text(WORLD)
    vv = openrt_c.build() / "bin/vv"
    samples, actions, good = [], 0, True
    with display("640x480") as name:
        # One arena for all threads. With one arena per thread the C library's heap grows for an
        # hour and hides a small leak.
        env = {
            **os.environ, "DISPLAY": name,
            "SDL_AUDIODRIVER": "dummy",
            "SDL_RENDER_DRIVER": "software",
            "MALLOC_ARENA_MAX": "1"
        }
        with open(out / "window.log", "w") as log:
            program = subprocess.Popen(
                [vv, "world.wrl", "--watch", "--size", "200x150", "--spp", "4", "--threads", "1"],
                cwd=folder,
                env=env,
                stdout=log,
                stderr=log)

            def tool(*arguments):
                subprocess.run(["xdotool", *map(str, arguments)],
                               env=env,
                               capture_output=True,
                               timeout=60)

            begin, sampled = time.monotonic(), 0.0
            time.sleep(3)
            while (now := time.monotonic() - begin) < seconds and program.poll() is None:
                choice = rng.random()
                if choice < 0.5:
                    tool("mousemove", rng.randrange(200), rng.randrange(150))
                elif choice < 0.7:
                    tool("click", 1)
                elif choice < 0.8:
                    tool("mousedown", 1, "mousemove", rng.randrange(200), rng.randrange(150),
                         "mouseup", 1)
                elif choice < 0.99:
                    tool("key", rng.choice(KEYS))
                else:
                    world.write_text(
                        WORLD.replace("cycleInterval 3", f"cycleInterval {rng.uniform(1, 5):.3f}"))
                actions += 1
                time.sleep(rng.uniform(0.05, 0.3))
                if now - sampled >= EVERY and program.poll() is None:
                    sampled = now
                    samples.append((now, resident(program.pid), descriptors(program.pid)))
            if program.poll() is not None:
                print(
                    f"BAD  window: it ended with {program.returncode} after {now / 60:.1f} minutes; {out / 'window.log'}",
                    flush=True)
                good = False
            program.kill()
            program.wait()
    shutil.rmtree(folder)
    (out / "window.json").write_text(json.dumps(samples))
    return bool(samples) and report("window", samples, f"{actions} things done") and good


def master(seconds, out):
    rng, samples, done, wrong, frames = random.Random(5), [], 0, 0, 0
    expected = openrt_c.reference(**FRAME)
    with farm(3) as workers, openrt_c.context(cluster(workers), **FRAME) as c:
        begin, sampled, over = time.monotonic(), 0.0, threading.Event()

        def trouble():
            nonlocal done
            while not over.wait(rng.uniform(0.2, 3)):
                worker = rng.choice(workers)
                if rng.random() < 0.5:
                    worker.kill()
                    worker.start()
                else:
                    worker.stop()
                    over.wait(rng.uniform(0.05, 1))
                    worker.resume()
                done += 1

        thread = threading.Thread(target=trouble)
        thread.start()
        try:
            while (now := time.monotonic() - begin) < seconds:
                wrong += c.render() != expected
                frames += 1
                if now - sampled >= EVERY:
                    sampled = now
                    samples.append((now, resident(), descriptors()))
                time.sleep(0.05)
        finally:
            over.set()
            thread.join()
    (out / "cluster.json").write_text(json.dumps(samples))
    if wrong:
        print(f"BAD  cluster: {wrong} of {frames} frames are wrong", flush=True)
    return bool(samples) and report(
        "cluster", samples, f"{frames} frames, {wrong} wrong, {done} times trouble") and not wrong


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--minutes", type=float, default=60)
    options.add_argument("--window", action="store_true")
    options.add_argument("--cluster", action="store_true")
    options.add_argument("--out", type=pathlib.Path, default=openrt_c.build().parent / "soak")
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    out, seconds = given.out.resolve(), 60 * given.minutes
    if given.window != given.cluster:
        return 0 if (window if given.window else master)(seconds, out) else 1
    # Each part runs in a process of its own, so that the memory of one is measured.
    parts = [
        subprocess.Popen(
            [sys.executable, __file__, "--minutes",
             str(given.minutes), "--out",
             str(out), part]) for part in ("--window", "--cluster")
    ]
    return max(part.wait() for part in parts)


if __name__ == "__main__":
    sys.exit(main())
