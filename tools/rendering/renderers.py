"""The programs that bench_render.py measures: vv, and Mitsuba 3 in a Python of its own.

A renderer has a name and two functions. render(spp, seed) returns a picture, as floats from the
bottom row up, and its CPU seconds; a renderer that measures in batches takes several seeds at once.
startup() returns the CPU seconds that a picture of any size costs before the first sample."""
import array
import json
import pathlib
import resource
import shlex
import subprocess

import export_mitsuba
from export_mitsuba import read_pfm


def cpu_seconds(command):
    """Runs a command to its end; returns the CPU seconds of all its threads."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    except OSError as error:
        raise SystemExit(f"bench_render.py: {command[0]} does not start: {error.strerror}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"bench_render.py: {command[0]} failed: {done.stderr.strip()}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Vv:
    """vv with a world and a transport. The program may be followed by options of its own, as in
    "build/dev/bin/vv --depth 8"."""

    def __init__(self, program, world, transport, size, threads, folder):
        self.program, *self.options = shlex.split(str(program))
        self.name, self.size, self.threads, self.folder = transport, size, threads, folder
        self.command = [self.program, *self.options, world, "--transport", transport, "--quiet"]

    def _run(self, size, spp, seed, threads):
        """Returns the CPU seconds of the whole program."""
        return cpu_seconds([
            *self.command, "-o", self.folder / "x.pfm", "--stats", self.folder / "x.json", "--size",
            f"{size[0]}x{size[1]}", "--spp", spp, "--seed", seed, "--threads", threads
        ])

    def startup(self):
        """Returns the CPU seconds of reading the world and preparing it: those of a picture of 4x3
        pixels and one sample, the least of three."""
        return min(self._run((4, 3), 1, 0, self.threads) for _ in range(3))

    def supported(self):
        """Returns whether this build has the transport; wishing for another is no error."""
        self._run((4, 3), 1, 0, self.threads)
        chosen = json.loads((self.folder / "x.json").read_text())["transport"]["chosen"]
        return self.name in ("auto", chosen)

    def render(self, spp, seed, threads=None):
        """Returns the picture and the CPU seconds of the whole program, start-up included."""
        seconds = self._run(self.size, spp, seed, self.threads if threads is None else threads)
        return read_pfm(self.folder / "x.pfm")[2], seconds


class Mitsuba:
    """A variant of Mitsuba 3 in the Python that has it."""

    def __init__(self, python, variant, threads):
        self.python, self.variant, self.threads = python, variant, threads
        self.name = f"Mitsuba {variant.split('_')[0]}"

    def works(self, folder):
        """Also renders a small picture: the just-in-time compiler may lack its library, or end the
        process."""
        test = (f"import mitsuba as mi; mi.set_variant({self.variant!r}); "
                "mi.render(mi.load_dict(mi.cornell_box()), spp=1).numpy()")
        try:
            return subprocess.run([self.python, "-c", test],
                                  capture_output=True,
                                  timeout=300,
                                  cwd=folder).returncode == 0
        except (OSError, subprocess.TimeoutExpired):
            return False

    def render(self, folder, jobs):
        """Renders the exported scene of a folder. Jobs are dictionaries (mitsuba_worker.py).
        Returns the CPU seconds of the start, and pairs of picture and CPU seconds for the jobs that
        were finished."""
        for number, job in enumerate(jobs):
            job["out"] = str(folder / f"mitsuba{number}.raw")
        request = {
            "variant": self.variant,
            "scene": str(folder / "scene.xml"),
            "threads": self.threads,
            "jobs": jobs
        }
        worker = pathlib.Path(__file__).with_name("mitsuba_worker.py")
        done = subprocess.run([self.python, worker],
                              input=json.dumps(request),
                              capture_output=True,
                              text=True)
        said = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        if done.returncode != 0:
            print(f"  {self.name} ended early: {done.stderr.strip()[-300:]}", flush=True)
        pictures = []
        for job, answer in zip(jobs, said[1:]):
            values = array.array("f")
            values.frombytes(pathlib.Path(job["out"]).read_bytes())
            pictures.append((values, answer["seconds"]))
        return said[0]["seconds"] if said else 0.0, pictures


def mitsubas(python, threads, folder):
    """Returns the variants that work, the vectorised one first."""
    variants = (Mitsuba(python, v, threads) for v in ("llvm_ad_rgb", "scalar_rgb"))
    return [m for m in variants if m.works(folder)]


def export(world, folder, size, vv, replay):
    """Writes the world for Mitsuba and says what its scene lacks."""
    for remark in export_mitsuba.export(world, folder, size, shlex.split(str(vv))[0], replay):
        print(f"  for Mitsuba: {remark}", flush=True)
