"""Tries an installed wheel of `xvrml`: pictures by vv and by Python, a ray query, Scripts of each
engine that the wheel brings. It warns of nothing and needs nothing but the wheel and numpy.

try_wheel.py FOLDER [--emulated]     writes its pictures into FOLDER

--emulated: qemu runs the programs. It has no filters of system calls, without which Scripts of
strangers must be refused.

tools/test-wheel.sh runs it in a bare Debian, cibuildwheel (pyproject.toml) after each build."""
import json
import pathlib
import subprocess
import sys

import numpy
import xvrml

WORLD = """#VRML V2.0 utf8
Viewpoint { position 0 .5 6 }
DirectionalLight { direction -1 -1 -1 }
Transform { translation -1 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor .8 .2 .1 } } geometry Sphere { } } }
Transform { translation 1.5 0 0 children Shape {
  appearance Appearance { material Material { } } geometry Text { string "wheel" } } }
"""
# a BMP picture of one pixel
BITMAP = """#VRML V2.0 utf8
Shape { geometry Box { } appearance Appearance { texture ImageTexture { url
  "data:image/bmp;base64,Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAAAAD/AA==" } } }
"""
HEADER = "#VRML V2.0 utf8\nDEF S Script { eventOut SFFloat x url "
PROGRAMS = {  # engine: trusted, program
    "JavaScript": (False, '"javascript:function initialize() { x = 42; }"'),
    "Tcl": (False, '"tcl:proc initialize {} { set ::x 42 }"'),
    "trusted Tcl":
        (True,
         '"tcl:package require msgcat; proc initialize {} { set ::x [clock format 42 -format %s] }"'
        ),
    "Python": (True, '"python:import math\ndef initialize(): script.x = math.floor(42.5)\n"'),
}
# Features of `vv --list-features` that the wheel lacks (docs/packages.md).
MISSING = {"denoise", "mp4", "webm", "python", "step", "window", "edit", "serve"}


def main():
    folder, emulated = pathlib.Path(sys.argv[1]).resolve(), "--emulated" in sys.argv
    folder.mkdir(parents=True, exist_ok=True)
    world_file = folder / "wheel.wrl"
    world_file.write_text(WORLD)
    print("package:", pathlib.Path(xvrml.__file__).parent, "numpy:", numpy.__version__)

    world = xvrml.load(world_file)
    picture = world.render(size=(64, 48), spp=8)
    pixels = numpy.asarray(picture)
    assert pixels.shape == (48, 64, 4) and pixels[..., :3].std() > 0.05, pixels.shape
    # The ball is left of the middle, and red.
    red, green, blue = pixels[20:30, 14:22, :3].mean(axis=(0, 1))
    assert red > 2 * green > blue, (red, green, blue)
    assert not world.warnings, world.warnings
    picture.save(folder / "python.png")

    vv = pathlib.Path(sys.executable).with_name("vv")
    by_vv = folder / "vv.png"
    done = subprocess.run(
        [vv, world_file, "-o", by_vv, "--size", "64x48", "--spp", "8", "--strict", "-q"],
        capture_output=True,
        text=True,
        check=False)
    assert done.returncode == 0 and not done.stderr, done
    assert by_vv.read_bytes().startswith(b"\x89PNG")

    if not emulated:  # a picture that another process of the wheel decodes
        textured = folder / "textured.wrl"
        textured.write_text(BITMAP)
        world = xvrml.load(textured)
        world.render(size=(16, 12), spp=1)
        assert not world.warnings, world.warnings

    listed = subprocess.run([vv, "--list-features", "--json"],
                            capture_output=True,
                            text=True,
                            check=True).stdout
    missing = {row["name"] for row in json.loads(listed)["features"] if not row["available"]}
    # A package of the environment may bring denoising, and only some kernels have filters.
    assert missing ^ MISSING <= {"denoise", "seccomp"}, missing

    for name, (trust, program) in PROGRAMS.items():
        script = folder / "script.wrl"
        script.write_text(HEADER + program + " }\n")
        browser = xvrml.Browser(script, trust=trust)
        browser.tick(0.1)
        print(name, "Script: x =", browser["S"].x)
        if emulated and not trust:
            assert "no filter of system calls" in str(browser.warnings), browser.warnings
            continue
        assert browser["S"].x == 42 and not browser.warnings, browser.warnings
    print("the wheel works; pictures in", folder)


if __name__ == "__main__":
    main()
