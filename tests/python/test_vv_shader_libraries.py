"""Tests vv and shader plug-ins: a crash names the shader; a changed library is reloaded under
--watch."""
import os
import shutil
import signal
import subprocess
import time

import pytest
from conftest import find_vv

VV = find_vv()
PLUGINS = VV.parent.parent / "tests/plugins"
pytestmark = pytest.mark.skipif(not (PLUGINS / "faulty.so").exists(),
                                reason="the test plug-ins were not built")

WORLD = """#VRML V2.0 utf8
Shape { appearance ORTAppearance { shader ORTShader { name "%s" file "%s" } } geometry Box { } }
"""


def test_a_crash_names_the_shader(tmp_path):
    (tmp_path / "crash.wrl").write_text(WORLD % ("Crash", "faulty"))
    done = subprocess.run(
        [VV, "crash.wrl", "-o", "a.png", "--size", "8x6", "--spp", "1", "--shader-path", PLUGINS],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        preexec_fn=no_core)
    assert done.returncode == -signal.SIGSEGV, done.stderr
    assert "vv: crash (SIGSEGV) in the shader Crash of faulty\n" in done.stderr
    assert not list(tmp_path.glob("a.png*"))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
@pytest.mark.timed
def test_one_signal_ends_a_render_that_hangs_in_a_shader(tmp_path, number):
    (tmp_path / "hang.wrl").write_text("#VRML V2.0 utf8\nViewpoint { position 0 0 5 }\n" +
                                       (WORLD % ("Hang", "faulty")).split("\n", 1)[1])
    with subprocess.Popen([
            VV, "hang.wrl", "-o", "a.png", "--size", "64x48", "--spp", "1", "--threads", "2",
            "--shader-path", PLUGINS
    ],
                          cwd=tmp_path,
                          stderr=subprocess.PIPE,
                          text=True) as vv:
        time.sleep(2)
        assert vv.poll() is None, vv.stderr.read()
        begin = time.monotonic()
        vv.send_signal(number)
        said = vv.communicate(timeout=60)[1]
    took = time.monotonic() - begin
    assert vv.returncode == 130, said
    assert took < 15, took
    assert "a shader did not stop" in said and "the picture so far is saved" in said, said
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert not [p for p in tmp_path.iterdir() if p.name.startswith(".vv-")]


def no_core():
    import resource
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def test_watch_sees_a_shader_library_change(tmp_path):
    shaders = tmp_path / "shaders"
    shaders.mkdir(mode=0o755)
    shutil.copy(PLUGINS / "versions/1/version.so", shaders / "version.so")
    (tmp_path / "a.wrl").write_text(WORLD % ("Versioned", "version"))
    command = [
        VV, "a.wrl", "-o", "a.png", "--size", "8x6", "--spp", "1", "--watch", "--shader-path",
        shaders
    ]
    watching = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    try:
        picture = tmp_path / "a.png"
        before = wait_for(picture, None)
        shutil.copy(PLUGINS / "versions/2/version.so", shaders / "fresh")
        os.rename(shaders / "fresh", shaders / "version.so")
        after = wait_for(picture, before)
        assert after != before
    finally:
        watching.send_signal(signal.SIGINT)
        watching.communicate(timeout=60)


def wait_for(path, former):
    for _ in range(300):
        if path.exists() and path.read_bytes() not in (b"", former):
            return path.read_bytes()
        time.sleep(0.1)
    pytest.fail(f"{path} does not change")
