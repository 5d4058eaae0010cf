#!/usr/bin/env python3
"""Measures the cost and the speedup of the cluster on this machine, over loopback.

bench_cluster.py BUILD [--world FILE] [--size 640x480] [--spp 16] [--runs 5] [--threads N]
                 [--key] [--vv OPTIONS] [--json FILE]

Runs the configurations in turns, so that all see the same load of the machine, and prints medians:

  local       vv --threads N
  one         one worker of N threads, none in the master: its ratio to local is the overhead
  one, CURVE  the same, encrypted (--key)
  single      one worker of one thread
  two         two workers of one thread: its ratio to single is the speedup

Seconds are the rendering time from vv --stats: from the start of the frame, with the scene sent and
prepared, to its last pixel. Processor time is the total of all processes from start to end; on a
busy machine it is the more reliable number. All pictures must have the same bytes.
"""
import argparse
import json
import os
import pathlib
import resource
import socket
import statistics
import subprocess
import sys
import tempfile
import time


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def processor_seconds(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def picture(args, folder, options):
    """Returns the seconds of rendering, the processor time of vv, and the bytes of the picture."""
    stats, out = folder / "stats.json", folder / "picture.pfm"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([
        args.build / "bin/vv", args.world, "-q", "--size", args.size, "--spp",
        str(args.spp), "--stats", stats, "-o", out, *args.vv.split(), *options
    ],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (json.loads(stats.read_text())["time"]["render"],
            after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, out.read_bytes())


def with_workers(args, folder, count, threads, key):
    ports = [free_port() for _ in range(count)]
    secret = ["--key", key] if key else []
    workers = [
        subprocess.Popen([
            args.build / "bin/openrt-worker", "--listen", f"127.0.0.1:{port}", "--threads",
            str(threads), "-q", *secret
        ]) for port in ports
    ]
    try:
        time.sleep(1)
        before = sum(map(processor_seconds, workers))
        seconds, processor, content = picture(args, folder, [
            "--workers", ",".join(f"127.0.0.1:{port}" for port in ports), "--local-threads", "0",
            "--require-workers",
            str(count), *secret
        ])
        return seconds, processor + sum(map(processor_seconds, workers)) - before, content
    finally:
        for worker in workers:
            worker.kill()
            worker.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--world", default="examples/scenes/headlight.wrl")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--key", action="store_true", help="measure CURVE, too")
    parser.add_argument("--vv", default="", help="more options of vv")
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        key = folder / "key"
        if args.key:
            subprocess.run([args.build / "bin/openrt-worker", "--new-key", key],
                           check=True,
                           stdout=subprocess.DEVNULL)
        n = args.threads
        cases = {"local": None, "one": (1, n, None), "single": (1, 1, None), "two": (2, 1, None)}
        if args.key:
            cases["one, CURVE"] = (1, n, key)
        wall, processor, first = {case: [] for case in cases}, {case: [] for case in cases}, None
        for run in range(args.runs):
            for case, workers in cases.items():
                made = with_workers(args, folder, *workers) if workers else picture(
                    args, folder, ["--threads", str(n)])
                wall[case].append(made[0])
                processor[case].append(made[1])
                first = first or made[2]
                if made[2] != first:
                    sys.exit(f"{case}: the picture is another one")
            print(f"run {run + 1}: " + ", ".join(
                f"{case} {wall[case][-1]:.3f} s ({processor[case][-1]:.2f})" for case in cases),
                  flush=True)
    result = {"world": args.world, "size": args.size, "spp": args.spp, "threads": n}
    for what, times in (("seconds", wall), ("processor seconds", processor)):
        middle = {case: statistics.median(values) for case, values in times.items()}
        result[what] = middle
        result[f"one / local, {what}"] = middle["local"] / middle["one"]
        if args.key:
            result[f"one, CURVE / local, {what}"] = middle["local"] / middle["one, CURVE"]
    result["two / single, seconds"] = result["seconds"]["single"] / result["seconds"]["two"]
    for name, value in result.items():
        print(f"{name}: {value if not isinstance(value, float) else format(value, '.3f')}")
    if args.json:
        args.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
