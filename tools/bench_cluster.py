#!/usr/bin/env python3
"""What the cluster costs and gains, on this machine, over loopback.

bench_cluster.py BUILD [--world FILE] [--size 640x480] [--spp 16] [--runs 5] [--key] [--threads N] [--json FILE]

Measures, in turns so that all see the same load of the machine, and prints medians:
  local      vv --threads N
  one        one worker of N threads, the master with none of its own: its ratio to local is what the way costs
  one, CURVE the same, encrypted (--key)
  single     one worker of one thread
  two        two workers of one thread: how much faster than single
Times are RTstats.renderSeconds: from the start of the frame, scene sent and prepared, to its last pixel; and the same of a second
frame of the same scene (a sequence of two), which nothing has to be sent for.
"""
import argparse
import json
import os
import pathlib
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


class Workers:
    def __init__(self, build, count, threads, key=None):
        self.ports = [free_port() for _ in range(count)]
        options = ["--key", key] if key else []
        self.processes = [subprocess.Popen([build / "bin/openrt-worker", "--listen", f"127.0.0.1:{port}", "--threads", str(threads),
                                            "--quiet", *options], stdout=subprocess.DEVNULL) for port in self.ports]

    def __enter__(self):
        time.sleep(0.3)
        return ["--workers", ",".join(f"127.0.0.1:{port}" for port in self.ports)]

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()
            process.wait()


def picture(build, folder, args, options):
    """Seconds of the first and the second of two frames, and the bytes of the last picture."""
    width, _, height = args.size.partition("x")
    stats = folder / "stats.json"
    command = [build / "bin/vv", args.world, "-q", "--size", f"{width}x{height}", "--spp", str(args.spp), "--frames", "2", "--fps", "25",
               "--stats", stats, "-o", folder / "picture%d.pfm", *args.vv.split(), *options]
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
    told = json.loads(stats.read_text())
    seconds = [frame.get("renderSeconds", frame.get("seconds")) for frame in told["frames"]] if "frames" in told else [told["renderSeconds"]]
    pictures = sorted(folder.glob("picture*.pfm"))
    content = pictures[-1].read_bytes()
    for path in pictures:
        path.unlink()
    return seconds, content


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--world", default="build/demo/headlight.wrl")
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--key", action="store_true", help="measure CURVE, too")
    parser.add_argument("--vv", default="", help="more options of vv")
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    build = args.build.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        key = None
        if args.key:
            key = folder / "key"
            subprocess.run([build / "bin/openrt-worker", "--new-key", key], check=True, stdout=subprocess.DEVNULL)
        n = args.threads
        cases = {"local": (0, 0, None), "one": (1, n, None), "single": (1, 1, None), "two": (2, 1, None)}
        if args.key:
            cases["one, CURVE"] = (1, n, key)
        times = {case: [] for case in cases}
        first = None
        for run in range(args.runs):
            for case, (count, threads, secret) in cases.items():
                if count == 0:
                    seconds, content = picture(build, folder, args, ["--threads", str(n)])
                else:
                    with Workers(build, count, threads, secret) as options:
                        options += ["--local-threads", "0", "--require-workers", str(count), *(["--key", secret] if secret else [])]
                        seconds, content = picture(build, folder, args, options)
                times[case].append(seconds[-1])
                first = first or content
                if content != first:
                    sys.exit(f"{case}: the picture is another one")
            print(f"run {run + 1}: " + ", ".join(f"{case} {values[-1]:.3f} s" for case, values in times.items()), flush=True)
    middle = {case: statistics.median(values) for case, values in times.items()}
    result = {"world": args.world, "size": args.size, "spp": args.spp, "threads": n, "seconds": middle,
              "one / local": middle["local"] / middle["one"], "two / single": middle["single"] / middle["two"]}
    if args.key:
        result["one, CURVE / local"] = middle["local"] / middle["one, CURVE"]
    for name, value in result.items():
        print(f"{name}: {value if not isinstance(value, float) else format(value, '.3f')}")
    if args.json:
        args.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
