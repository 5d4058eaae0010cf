"""Runs what the documents say for Slurm on a Slurm of two nodes in this machine: the array of
docs/farms.md, contrib/slurm/render.sbatch, and the jobs of docs/long-renders.md."""
import json
import os
import re
import subprocess

import pytest
from conftest import BOX, ISA, PATIENCE, ROOT
from slurm_machine import PROGRAMS, NotStarted, Slurm, program

FILM = ("--size", "32x24", "--spp", "2", *ISA, "-o", "f-{frame:3}.png")


@pytest.fixture(scope="module")
def slurm():
    absent = [name for name in PROGRAMS if not program(name)]
    if absent:
        pytest.skip("Slurm is not installed: " + ", ".join(absent))
    try:
        machine = Slurm(4 * PATIENCE)
    except NotStarted as problem:
        pytest.skip(f"Slurm does not start here: {problem}")
    yield machine
    machine.stop()


@pytest.fixture
def batch(vv, slurm):
    """A function that runs a script which calls sbatch, and waits for its jobs. It returns what the
    jobs have printed."""

    def run(script):
        path = f"{vv.program.parent}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", script],
                              cwd=vv.folder,
                              env={**slurm.environment, "PATH": path},
                              capture_output=True,
                              timeout=4 * PATIENCE)
        assert done.returncode == 0, done.stderr
        slurm.finish_jobs()
        logs = [*vv.folder.glob("slurm-*.out"), *vv.folder.glob("vv-*.log")]
        return "\n".join(log.read_text(errors="replace") for log in logs)

    return run


def documented(page, beginning):
    """Returns the block of commands of a page that begins so."""
    blocks = re.findall(r"^```sh\n(.*?)^```", (ROOT / "docs" / page).read_text(), re.M | re.S)
    (block, ) = [block for block in blocks if block.startswith(beginning)]
    return block


def pictures(vv):
    return {path.name: path.read_bytes() for path in vv.folder.glob("f-*.png")}


def test_an_array_makes_a_film(vv, batch):
    cut = vv("box.wrl", *FILM, "--frames", "0-9", "--jobs", 3)
    assert cut.returncode == 0, cut.talk
    vv.write("jobs.txt", cut.text)
    said = batch(documented("farms.md", "sbatch --array"))
    made = pictures(vv)
    assert len(made) == 10, said
    assert len(list(vv.folder.glob("slurm-*_*.out"))) == len(cut.text.splitlines())
    # Frames that a node has lost are cut and made again.
    (vv.folder / "f-003.png").unlink()
    (vv.folder / "f-007.png").write_bytes(made["f-007.png"][:40])
    again = vv("box.wrl", *FILM, "--frames", "0-9", "--missing", "--jobs", 2)
    vv.write("jobs.txt", again.text)
    assert len(again.text.splitlines()) > 0
    batch(documented("farms.md", "sbatch --array"))
    assert pictures(vv) == made
    assert vv("box.wrl", *FILM, "--frames", "0-9").returncode == 0
    assert pictures(vv) == made


def test_two_nodes_share_one_picture(vv, batch):
    options = ("--size", "96x72", "--spp", "16", *ISA)
    world = ROOT / "examples/scenes/still_life.wrl"
    alone = vv(world, *options, "-o", "alone.png")
    assert alone.returncode == 0, alone.talk
    said = batch("export OPENRT_ARRAYS=$PWD/arrays\n"
                 f"sbatch --nodes=2 {ROOT}/contrib/slurm/render.sbatch {world} {' '.join(options)} "
                 "-o shared.png --stats stats.json")
    assert (vv.folder / "shared.png").exists(), said
    assert (vv.folder / "shared.png").read_bytes() == (vv.folder / "alone.png").read_bytes()
    cluster = json.loads((vv.folder / "stats.json").read_text())["cluster"]
    assert cluster["workers"] == 2 and cluster["tiles"] > 0 and cluster["tiles_here"] == 0, cluster
    assert list((vv.folder / "arrays").iterdir())  # what the nodes pass on to each other
    assert not vv.leftovers()


def test_seeds_of_an_array_are_merged(vv, batch):
    vv.write("still_life.wrl", BOX)
    script = documented("long-renders.md", "array=$(sbatch")
    for old, new in (("0-31", "0-3"), ("1920x1080", "48x32"), ("--spp 256", "--spp 4"), ("--isa avx2", " ".join(ISA))):
        assert old in script
        script = script.replace(old, new)
    said = batch(script)
    assert (vv.folder / "all.exr").exists(), said
    parts = [f"part-{seed}.exr" for seed in range(4)]
    assert vv("merge", *parts, "-o", "again.exr").returncode == 0
    assert (vv.folder / "all.exr").read_bytes() == (vv.folder / "again.exr").read_bytes()
