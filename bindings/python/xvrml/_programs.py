"""Runs the commands of the wheel. Each one replaces this process with the program of the same name
in the package."""
import os
import pathlib
import sys


def _run(name: str) -> None:
    program = pathlib.Path(__file__).resolve().parent / "bin" / name
    try:
        os.execv(program, [name, *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"{name}: {program}: {error.strerror}")


def vv() -> None:
    _run("vv")


def openrt_worker() -> None:
    _run("openrt-worker")


def openrt_replay() -> None:
    _run("openrt-replay")
