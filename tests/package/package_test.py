#!/usr/bin/env python3
"""Installs the build into a scratch prefix, moves it, and builds and runs a third-party project
that uses only this installation.

package_test.py SOURCE BUILD CMAKE CC"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source, build, cmake, cc = pathlib.Path(sys.argv[1]), pathlib.Path(
    sys.argv[2]), sys.argv[3], sys.argv[4]
env = {
    k: v
    for k, v in os.environ.items()
    if not k.startswith(("OPENRT_", "CMAKE_", "LD_", "PKG_", "PYTHONPATH", "DESTDIR"))
}


def run(*command, **more):
    done = subprocess.run([str(c) for c in command],
                          stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT,
                          text=True,
                          timeout=600,
                          env={
                              **env,
                              **more.pop("env", {})
                          },
                          **more)
    if done.returncode:
        sys.exit(f"failed ({done.returncode}): {' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


def foreign_libraries(program, prefix):
    """Returns our own libraries that `program` would load from outside the prefix."""
    ours = ("libopenrt", "libxvrml")
    return [
        line for line in run("ldd", program).splitlines()
        if any(o in line for o in ours) and str(prefix) not in line
    ]


def follow_tutorial(document, folder, prefix):
    """Follows a page of docs/ step by step with the installed tree: writes files, runs commands and
    Python."""
    folder.mkdir()
    libraries = next(prefix.rglob("libxvrml.so")).parent
    env = {"PREFIX": str(prefix), "PATH": f"{prefix}/bin:" + os.environ["PATH"], "PWD": str(folder)}
    packages = [p for p in libraries.rglob("python") if (p / "xvrml").is_dir()]
    python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
    steps = 0
    for kind, name, text in re.findall(r"^```(\w+)(?: file=(\S+))?\n(.*?)^```",
                                       document.read_text(), re.M | re.S):
        if name:
            (folder / name).write_text(text)
        elif kind == "sh":
            run("bash", "-euc", text, cwd=folder, env=env)
        elif kind == "python" and packages:
            run(python, "-c", text, cwd=folder, env={**env, "PYTHONPATH": str(packages[0])})
        else:
            continue
        steps += 1
    print(f"{document.name}: {steps} steps, as they must be")


def check_rings(folder, prefix):
    if wrong := foreign_libraries(folder / "build/lib/xvrml/nodes/rings.so", prefix):
        sys.exit(f"the node plug-in does not use the installed libraries: {wrong}")
    pictures = [(folder / f"ring-{i:04}.png").read_bytes() for i in (0, 15, 30)]
    if len(set(pictures)) != 3:
        sys.exit("the ring of the tutorial does not grow")


with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch).resolve()
    first, prefix, out = scratch / "first place", scratch / "prefix", scratch / "build"
    run(cmake, "--install", build, "--prefix", first)
    first.rename(prefix)  # an installed tree must be movable
    debug = "CMAKE_BUILD_TYPE:STRING=Debug" in (build / "CMakeCache.txt").read_text()
    hardening = [
        sys.executable, source / "tests/checks/hardening.py", *(["--plain"] if debug else [])
    ]
    print(run(*hardening, prefix, env={"CC": cc}), end="")
    project = scratch / "project"
    shutil.copytree(source / "tests/package", project)

    # CMake
    run(cmake, "-S", project, "-B", out, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_C_COMPILER={cc}")
    run(cmake, "--build", out)
    for program in ("triangle", "world", "graph"):
        if wrong := foreign_libraries(out / program, prefix):
            sys.exit(f"{program} does not use the installed libraries: {wrong}")
    # Our programs load a third-party plug-in. Its tables are read-only, too, and it names no
    # folder.
    print(run(*hardening, "--plain", "--partial", out / "lib/openrt/shaders"), end="")
    plugin = run("ldd", out / "lib/openrt/shaders/flat.so")
    if "openrt" in plugin:
        sys.exit(f"the plug-in links against the host: {plugin}")
    print(run(out / "triangle"),
          run(out / "triangle", out / "lib/openrt/shaders"),
          run(out / "graph"),
          run(out / "world"),
          sep="",
          end="")

    # pkg-config
    libs = next(p.parent for p in prefix.rglob("openrt.pc"))
    flags = run("pkg-config", "--cflags", "--libs", "openrt", env={
        "PKG_CONFIG_PATH": str(libs)
    }).split()
    rpath = f"-Wl,-rpath,{libs.parent}"
    run(cc, "-std=c99", "-Wall", "-Wextra", "-Werror", project / "triangle.c", "-o",
        scratch / "by_pkg_config", *flags, "-lm", rpath)
    print(run(scratch / "by_pkg_config"), end="")
    # The C examples, as described in their README
    examples = scratch / "examples"
    shutil.copytree(source / "examples/c", examples)
    run(cc, "-std=c99", "-shared", "-fPIC", examples / "stripes.c", "-o", examples / "stripes.so",
        *flags, "-lm")
    for example in sorted(examples.glob("*.c")):
        if example.stem == "stripes":
            continue
        run(cc, "-std=c99", example, "-o", examples / example.stem, *flags, "-lm", rpath)
        options = [examples /
                   "a.rec"] if example.stem == "recording" else [f"--rt-shaderpath={examples}"]
        run(examples / example.stem, *options, examples / "a.ppm")
    print("examples: as they must be")
    flags = run("pkg-config", "--cflags", "--libs", "xvrml", env={
        "PKG_CONFIG_PATH": str(libs)
    }).split()
    run(cc, "-x", "c++", project / "world.cpp", "-o", scratch / "world_by_pkg_config", *flags,
        "-lstdc++", "-lm", rpath)
    print(run(scratch / "world_by_pkg_config"), end="")

    # A renderer (docs/extend.md)
    renderer = source / "examples/renderer"
    run(cc, "-x", "c++", "-std=c++20", renderer / "areas.cpp", "-o", scratch / "areas", *flags,
        "-lstdc++", "-lm", rpath)
    if "32.000 m2  Plaster" not in (areas := run(scratch / "areas", renderer / "house.wrl")):
        sys.exit(f"the example of a renderer lists other areas: {areas}")

    # Node plug-ins
    follow_tutorial(source / "docs/node-plugins.md", scratch / "tutorial", prefix)
    check_rings(scratch / "tutorial", prefix)
    example = scratch / "example"
    shutil.copytree(source / "examples/nodes", example)
    (example / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(example LANGUAGES C CXX)\n"
        "find_package(xvrml 0.2 REQUIRED)\nxvrml_add_nodes(springs springs.node springs.cpp)\n")
    run(cmake, "-S", example, "-B", example / "build", "-G", "Ninja",
        f"-DCMAKE_PREFIX_PATH={prefix}")
    run(cmake, "--build", example / "build")
    run(prefix / "bin/vv", source / "examples/scenes/springs.wrl", "--check", "--node-path",
        example / "build/lib/xvrml/nodes")

    # Shader plug-ins
    follow_tutorial(source / "docs/shaders.md", scratch / "shaders", prefix)
    if wrong := foreign_libraries(scratch / "shaders/build/follow", prefix):
        sys.exit(f"the program of the tutorial does not use the installed libraries: {wrong}")
    pictures = {
        name: (scratch / f"shaders/{name}.png").read_bytes()
        for name in ("polished", "velvet", "jelly", "crevices")
    }
    if len(set(pictures.values())) != len(pictures):
        sys.exit("the shaders of the tutorial look the same")

    # Script engines: the tutorial's, and the template that it tells readers to copy
    follow_tutorial(source / "docs/script-engines.md", scratch / "engines", prefix)
    if "xvrml" in (needed := run("ldd", scratch / "engines/build/lib/xvrml/scripts/rpn.so")):
        sys.exit(f"the script engine links against the host: {needed}")
    formula = scratch / "formula"
    shutil.copytree(source / "examples/script_engine", formula)
    run(cmake, "-S", formula, "-B", formula / "build", "-G", "Ninja",
        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_C_COMPILER={cc}")
    run(cmake, "--build", formula / "build")
    for time in "01":
        run(prefix / "bin/vv", formula / "wave.wrl", "--script-path",
            formula / "build/lib/xvrml/scripts", "--time", time, "--strict", "-o",
            formula / f"{time}.png", "--size", "32x24", "--spp", "1")
    if (formula / "0.png").read_bytes() == (formula / "1.png").read_bytes():
        sys.exit("the ball of the template does not move")

    # Installed engines that need a trusted world
    engines = {
        e["name"] for e in json.loads(run(prefix / "bin/vv", "--list-engines", "--json"))["engines"]
    }
    if "python" in engines:
        (scratch / "python.wrl").write_text(
            "#VRML V2.0 utf8\nDEF T Transform { }\nScript { field SFNode t USE T\n"
            "url \"python:import xvrml\nprint(xvrml.__file__, script.t.node_type)\" }\n")
        said = run(prefix / "bin/vv", "python.wrl", "--trust", "--check", cwd=scratch)
        if str(prefix) not in said or "Transform" not in said:
            sys.exit(f"Scripts in Python do not use the installed package: {said}")
    if "ecmascript" in engines:  # in a process: the program is found next to the installed library
        (scratch / "js.wrl").write_text(
            "#VRML V2.0 utf8\nScript { url \"javascript:function initialize() { print('runs'); }\" }\n"
        )
        said = run(prefix / "bin/vv", "js.wrl", "--check", "--strict", cwd=scratch)
        if "runs" not in said or not (prefix / "libexec/xvrml/xvrml-script-host").exists():
            sys.exit(f"Scripts do not run in processes of the installed program: {said}")
    (scratch / "bmp.wrl").write_text(
        "#VRML V2.0 utf8\nShape { geometry Box { } appearance Appearance { texture ImageTexture { url\n"
        '"data:image/bmp;base64,Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAAAAD/AA=="'
        " } } }\n")
    run(prefix / "bin/vv", "bmp.wrl", "-o", "bmp.png", "--size", "16x12", "--strict", cwd=scratch)
    if not (prefix / "libexec/xvrml/xvrml-decoder").exists():
        sys.exit("the program that decodes pictures is not installed")
    if "native" in engines:
        native = next(prefix.rglob("scripts/native.so")).parent.parent / "native"
        native.mkdir()
        run(cc, "-shared", "-fPIC", source / "examples/native/encoder.c", "-o",
            native / "libencoder.so", "-lm")
        run(prefix / "bin/vv", source / "examples/native/gauge.wrl", "--trust", "--check", "--time",
            "0.5")

    # Manual pages
    for page in ("openrt.3", "openrt_frames.3", "rtRender.3"):
        if not list(prefix.rglob(f"man/man3/{page}")):
            sys.exit(f"{page} is not installed")

    # Files that a desktop and a shell look for, and the names of the libraries
    for file in ("man/man1/vv.1", "man/man1/openrt-replay.1", "man/man1/nodegen.1",
                 "bash-completion/completions/vv", "zsh/vendor-completions/_vv",
                 "fish/vendor_completions.d/vv.fish", "applications/vv.desktop",
                 "thumbnailers/vv.thumbnailer", "mime/packages/openrt-vv.xml",
                 "metainfo/org.openrt.vv.metainfo.xml", "icons/hicolor/128x128/apps/vv.png"):
        if not (prefix / "share" / file).exists():
            sys.exit(f"share/{file} is not installed")
    for library in ("openrt", "xvrml", "xvrml_openrt"):
        if not (libs.parent / f"lib{library}.so.0").is_symlink():
            sys.exit(f"lib{library}.so.0 is not installed")
    for file in ("graph", "triangle"):  # third-party programs must depend on symbol versions
        if "@XVRML_0" not in (needed := run("nm", "-D", "--with-symbol-versions",
                                            out / file)) and "@OPENRT_0" not in needed:
            sys.exit(f"{file} links symbols without versions:\n{needed}")

    # Programs
    (scratch / "box.wrl").write_text(
        "#VRML V2.0 utf8\nShape { appearance Appearance { material Material { } } geometry Box { } }\n"
    )
    run(prefix / "bin/vv", "box.wrl", "-o", "box.png", "--size", "32x24", "--spp", "1", cwd=scratch)
    if not (scratch / "box.png").read_bytes().startswith(b"\x89PNG"):
        sys.exit("vv wrote no PNG")
    for program in ("openrt-replay", "nodegen"):
        if not os.access(prefix / "bin" / program, os.X_OK):
            sys.exit(f"{program} is not installed")
    for folder in (init.parent.parent for init in prefix.rglob("xvrml/__init__.py")):
        code = "import xvrml; w = xvrml.load('box.wrl'); print('python: as it must be', w.render(size=(8, 6), spp=1).shape)"
        python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
        print(run(python, "-c", code, cwd=scratch, env={"PYTHONPATH": str(folder)}), end="")
        break
