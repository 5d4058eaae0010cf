"""Tests the door by which code comes into vv: a library that somebody else could have written, or
that is not whole, is refused by all who load libraries, with its name."""
import shutil

import pytest

from conftest import HEADER, find_vv

SHADER = HEADER + ("Shape { appearance ORTAppearance { shader ORTShader { name \"Metal\" file \"%s\" } }"
                   " geometry Box { } }\n")
SCRIPT = HEADER + "Script { url \"tcl:\" }\nShape { geometry Box { } }\n"


def library(kind):
    """Returns a library of this project: a shader, a script engine."""
    folder = find_vv().parent.parent / "lib"
    found = sorted(folder.glob({"shader": "openrt/shaders/metal.so",
                                "engine": "xvrml/scripts/tcl.so"}[kind]))
    if not found:
        pytest.skip(f"there is no {kind} in {folder}")
    return found[0]


def uses(vv, kind, path):
    """Returns vv's talk when it uses a library, in each way that there is for its kind."""
    folder = path.parent
    if kind == "oidn":
        yield vv("box.wrl", "--denoise", "-o", "x.png", "--size", "8x6",
                 env={"OPENRT_OIDN_LIBRARY": str(path)}).talk
    elif kind == "node":
        yield vv("box.wrl", "--check", "--node-path", folder).talk
    elif kind == "engine":
        yield vv("--list-engines", "--script-path", folder).talk
    else:
        yield vv("--list-shaders", "--shader-path", folder).talk
        vv.write("s.wrl", SHADER % path.stem)
        yield vv("s.wrl", "-o", "x.png", "--size", "8x6", "--shader-path", folder).talk


@pytest.mark.parametrize("kind", ["shader", "engine", "node", "oidn"])
def test_a_library_that_others_may_write_to_is_refused(vv, kind):
    path = vv.folder / "open7.so"
    shutil.copy(library("engine" if kind == "engine" else "shader"), path)
    path.chmod(0o666)
    for talk in uses(vv, kind, path):
        assert "open7.so" in talk and "others may write to it" in talk, talk
        assert talk.count("open7.so is refused") == 1, talk


@pytest.mark.parametrize("kind", ["shader", "engine", "node", "oidn"])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_library_that_ends_early_is_refused_by_name(vv, kind, share):
    whole = library("engine" if kind == "engine" else "shader").read_bytes()
    path = vv.folder / "short7.so"
    path.write_bytes(whole[:4096 if share == 0.1 else int(len(whole) * share / 2)])
    path.chmod(0o755)
    for talk in uses(vv, kind, path):
        assert "short7.so" in talk and "damaged" in talk, talk


def test_a_virtual_environment_in_the_folder_of_a_stranger_is_not_used(vv):
    package = vv.folder / "venv/lib/python3.11/site-packages/pyoidn/oidn/lib"
    package.mkdir(parents=True)
    shutil.copy(library("shader"), package / "libOpenImageDenoise.so.2")
    for env in ({"VIRTUAL_ENV": "venv"}, {"VIRTUAL_ENV": "./venv", "HOME": "."}):
        done = vv("box.wrl", "--denoise", "-o", "x.png", "--size", "8x6",
                  env={**env, "OPENRT_OIDN_LIBRARY": ""})
        assert "venv" not in done.talk, done.talk
