"""Renders with Mitsuba 3; bench_render.py runs it in the Python of --mitsuba.

A request is one JSON object on standard input: variant, scene (a file), threads, jobs. A job has
spp, seed, out (a file of raw floats, rows from the bottom up) and perhaps `seconds`: it then
repeats itself until it has used that much CPU time. The answers are JSON lines: the CPU seconds of
all threads for the start, then of each job with its number of samples."""
import json
import sys
import time

import numpy as np

PASS = 64  # samples a pass: one kernel for all larger numbers, and arrays that fit into memory


def main():
    request = json.load(sys.stdin)
    import drjit
    import mitsuba
    mitsuba.set_variant(request["variant"])
    drjit.set_thread_count(request["threads"])
    scene = mitsuba.load_file(request["scene"])

    def render(spp, seed):
        return np.array(mitsuba.render(scene, spp=spp, seed=seed))[:, :, :3].astype(np.float64)

    # Each number of samples is a kernel of its own; compiling it belongs to the start.
    for spp in sorted({min(job["spp"], PASS) for job in request["jobs"]}):
        render(spp, 12345)
    print(json.dumps({"seconds": time.process_time()}), flush=True)
    for job in request["jobs"]:
        start, total, samples, passes = time.process_time(), 0.0, 0, 0
        while samples < job["spp"] or time.process_time() - start < job.get("seconds", 0):
            spp = min(job["spp"], PASS)
            total = total + spp * render(spp, job["seed"] + 7919 * passes)
            samples, passes = samples + spp, passes + 1
        seconds = time.process_time() - start
        (total / samples)[::-1].astype("<f4").tofile(job["out"])
        print(json.dumps({"seconds": seconds, "spp": samples}), flush=True)


if __name__ == "__main__":
    main()
