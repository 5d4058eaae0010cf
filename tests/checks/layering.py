#!/usr/bin/env python3
"""Reads every #include of the sources and fails on any arrow that docs/architecture.md section 1 does not draw.

layering.py ROOT      checks the tree
layering.py --self    feeds the checker includes that must be refused, and some that must pass
"""
import pathlib
import re
import sys

# Part of the project -> the parts whose headers it may include (itself always). A file belongs to the longest prefix.
PARTS = {
    "libopenrt/include/openrt/openrt.h": "api-h",
    "libopenrt/include/openrt/queries.h": "api-h",
    "libopenrt/include/openrt/": "shader-sdk",
    "libopenrt/api/": "openrt-api",
    "libopenrt/scene/": "openrt-scene",
    "libopenrt/shading/": "openrt-shading",
    "libopenrt/render/": "openrt-render",
    "libopenrt/backend/": "openrt-backend",
    "libopenrt/backend/local/": "backend-local",
    "libopenrt/backend/record/": "backend-record",
    "libopenrt/backend/null/": "backend-null",
    "libopenrt/backend/debug/": "backend-debug",
    "libopenrt/backend/cluster/": "backend-cluster",
    "libopenrt/tools/": "openrt-tools",
    "libxvrml/include/xvrml/openrt.h": "mapper-h",
    "libxvrml/include/xvrml/xscript.h": "script-sdk",
    "libxvrml/include/xvrml/xscript_types.h": "script-sdk",
    "libxvrml/include/xvrml/": "xvrml-h",
    "libxvrml/base/": "xvrml-base",
    "libxvrml/nodegen/": "nodegen",
    "libxvrml/nodes/": "xvrml-base",
    "libxvrml/parse/": "xvrml-parse",
    "libxvrml/event/": "xvrml-event",
    "libxvrml/behaviour/": "xvrml-behaviour",
    "libxvrml/script/": "xvrml-script",
    "libxvrml/script/remote/": "script-remote",
    "libxvrml/tools/script_host/": "script-host",
    "libxvrml/browser/": "xvrml-browser",
    "libxvrml/geometry/": "xvrml-geometry",
    "libxvrml/image/": "xvrml-image",
    "libxvrml/openrt/": "mapper",
    "plugins/shaders/": "shader-plugin",
    "plugins/script/": "script-plugin",
    "apps/": "app",
    "apps/vv/window/": "window",
    "apps/picture/": "picture",
    "bindings/": "binding",
    "examples/": "example",
    "common/": "common",
    "tests/": "test",
}
PUBLIC = {"api-h", "shader-sdk", "script-sdk", "xvrml-h", "mapper-h"}
ARROWS = {
    "api-h": set(),
    "shader-sdk": set(),
    "script-sdk": set(),
    "openrt-api": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "openrt-backend", "common"},
    "openrt-scene": {"api-h", "common"},
    "openrt-shading": {"shader-sdk", "openrt-scene", "common"},
    "openrt-render": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "common"},
    "openrt-backend": {"api-h", "openrt-scene", "common"},
    "backend-local": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "openrt-render", "openrt-backend", "common"},
    "backend-record": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "openrt-backend", "common"},  # its reader checks against class tables
    "backend-debug": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "openrt-backend", "common"},  # class tables and names for its messages
    "backend-null": {"api-h", "openrt-scene", "openrt-backend", "common"},
    "backend-cluster": {"api-h", "shader-sdk", "openrt-scene", "openrt-shading", "openrt-render", "openrt-backend", "backend-local", "backend-record", "common"},  # jobs; a worker is a local backend; what comes is checked
    "openrt-tools": {"api-h", "openrt-scene", "openrt-shading", "openrt-backend", "backend-record", "backend-cluster", "common"},
    "xvrml-h": set(),
    "xvrml-base": {"xvrml-h", "common"},
    "nodegen": {"xvrml-h", "xvrml-base", "common"},
    "xvrml-parse": {"xvrml-h", "xvrml-base", "common"},
    "xvrml-event": {"xvrml-h", "xvrml-base", "xvrml-parse", "xvrml-geometry", "xvrml-behaviour", "common"},
    "xvrml-behaviour": {"xvrml-h", "xvrml-base", "xvrml-parse", "xvrml-geometry", "xvrml-image", "xvrml-event", "common"},
    "xvrml-script": {"xvrml-h", "script-sdk", "script-remote", "xvrml-base", "xvrml-parse", "xvrml-event", "common"},
    "script-remote": {"script-sdk", "common"},
    "script-host": {"script-sdk", "xvrml-script", "script-remote", "common"},
    "xvrml-browser": {"xvrml-h", "xvrml-base", "xvrml-parse", "xvrml-geometry", "xvrml-image", "xvrml-event", "xvrml-behaviour", "xvrml-script", "common"},
    "xvrml-geometry": {"xvrml-h", "xvrml-base", "common"},
    "xvrml-image": {"xvrml-h", "xvrml-base", "common"},
    "mapper-h": {"xvrml-h"},
    "mapper": {"mapper-h", "xvrml-h", "xvrml-base", "xvrml-geometry", "xvrml-image", "api-h", "common"},
    "shader-plugin": {"shader-sdk"},
    "script-plugin": {"script-sdk", "common"},  # what common/ says of plug-in folders holds for native: libraries, too
    "picture": PUBLIC - {"shader-sdk", "script-sdk"},
    "app": PUBLIC - {"script-sdk"} | {"picture", "window", "common"},  # vv --list-shaders reads the tables of plug-ins
    "window": PUBLIC - {"shader-sdk", "script-sdk"} | {"app", "picture", "common"},
    "binding": PUBLIC - {"shader-sdk", "script-sdk"} | {"picture", "common"},
    "example": PUBLIC,
    "common": set(),
    "test": set(PARTS.values()),
}
# Headers of other people that only some parts may know.
FOREIGN = [
    (re.compile(r"embree\d/"), {"backend-local", "test"}, "Embree"),
    (re.compile(r"(sys/socket|netinet/|arpa/|netdb|zmq)"), {"backend-cluster", "script-remote", "test"}, "sockets"),
    (re.compile(r"(png|jpeglib|turbojpeg|gif_lib|ft2build|freetype|hb|hb-ft|fontconfig/.*|GL/glu)(\.h)?$"),
     {"xvrml-geometry", "xvrml-image", "picture", "window", "test"}, "picture and font libraries"),
    (re.compile(r"(SDL2/.*|SDL\w*\.h)$"), {"window"}, "SDL"),
    (re.compile(r"lib(av|sw)[a-z]+/"), {"xvrml-image", "picture", "test"}, "the ffmpeg libraries"),
    (re.compile(r"(OpenEXR/|Imf)"), {"picture", "test"}, "OpenEXR"),
    (re.compile(r"(CLI/|CLI11)"), {"app", "openrt-tools", "nodegen"}, "CLI11"),
    (re.compile(r"pybind11/"), {"binding", "script-plugin"}, "pybind11"),
]
# A public header includes the language's own headers and nothing else of others.
STANDARD = re.compile(r"[a-z_0-9]+(\.h)?$")
LANGUAGES = re.compile(r"(Python\.h|pybind11/\w+\.h)$")  # of the languages that script engines run
SEARCH = ["libopenrt/include", "libxvrml/include", "libopenrt", "libxvrml", "plugins/shaders", "apps", "apps/vv", "tests", "common"]
# Made at build time -> the part that they belong to.
GENERATED = [(re.compile(r"edits_generated\.h$"), "openrt-scene"), (re.compile(r"messages_generated\.h$"), "backend-cluster"), (re.compile(r"xvrml/nodes\.h$"), "xvrml-h")]
SUFFIXES = {".c", ".cpp", ".h", ".hpp"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)


def part_of(path):
    best = max((prefix for prefix in PARTS if path.startswith(prefix)), key=len, default=None)
    return PARTS[best] if best else None


def target(path, name, quoted, files):
    """Part that the included header belongs to, or None for a header of others."""
    places = [str(pathlib.PurePosixPath(path).parent)] if quoted else []
    for place in places + SEARCH:
        candidate = normal(f"{place}/{name}")
        if candidate in files:
            return part_of(candidate)
    for pattern, part in GENERATED:
        if pattern.search(name):
            return part
    return None


def normal(path):
    parts = []
    for piece in path.split("/"):
        if piece == ".." and parts:
            parts.pop()
        elif piece not in ("", "."):
            parts.append(piece)
    return "/".join(parts)


def check(files):
    """files: path -> text. Returns the list of complaints."""
    complaints = []
    for path, text in sorted(files.items()):
        part = part_of(path)
        if part is None:
            complaints.append(f"{path}: belongs to no part that docs/architecture.md knows")
            continue
        for match in INCLUDE.finditer(text):
            quoted, name = match.group(1) == '"', match.group(2)
            where = f"{path}:{text.count(chr(10), 0, match.start()) + 1}"
            to = target(path, name, quoted, files)
            if to is not None:
                if to != part and to not in ARROWS[part]:
                    complaints.append(f"{where}: {part} may not include {name} ({to})")
                continue
            if quoted and part != "test":
                complaints.append(f'{where}: "{name}" names no header of the project; write <{name}> for one of others')
            for pattern, who, what in FOREIGN:
                if pattern.match(name) and part not in who:
                    complaints.append(f"{where}: {part} may not know {what} ({name})")
            if part in PUBLIC | {"shader-plugin", "script-plugin"} and not STANDARD.match(name):
                if part == "script-plugin" and LANGUAGES.match(name):
                    continue
                complaints.append(f"{where}: {part} may include the language's own headers only, not {name}")
    return complaints


def tree(root):
    files = {}
    for top in sorted({prefix.split("/")[0] for prefix in PARTS}):
        for path in sorted((root / top).rglob("*")):
            relative = path.relative_to(root).as_posix()
            if path.suffix in SUFFIXES and not relative.startswith("tests/package/"):
                files[relative] = path.read_text(encoding="utf-8")
    return files


def self_test():
    base = {
        "libopenrt/include/openrt/openrt.h": "", "libopenrt/include/openrt/openrts.h": "", "libopenrt/scene/commit.h": "",
        "libopenrt/render/film.h": "", "libopenrt/backend/backend.h": "", "libopenrt/backend/local/embree.h": "",
        "libxvrml/include/xvrml/world.h": "", "libxvrml/include/xvrml/xscript.h": "", "libxvrml/include/xvrml/openrt.h": "", "libxvrml/parse/builder.h": "",
        "libxvrml/geometry/mesh.h": "",
    }
    refused = [
        ("libopenrt/api/a.cpp", "<embree3/rtcore.h>"), ("libopenrt/render/a.cpp", '"backend/local/embree.h"'),
        ("libopenrt/scene/a.cpp", '"render/film.h"'), ("libopenrt/scene/a.cpp", '"../render/film.h"'),
        ("libopenrt/api/a.cpp", '"xvrml/world.h"'), ("libxvrml/parse/a.cpp", '"openrt/openrt.h"'),
        ("libxvrml/parse/a.cpp", "<openrt/openrt.h>"), ("libxvrml/geometry/a.cpp", '"parse/builder.h"'),
        ("libxvrml/openrt/a.cpp", '"scene/commit.h"'), ("libxvrml/parse/a.cpp", "<png.h>"),
        ("plugins/script/test/a.c", "<xvrml/world.h>"), ("libxvrml/event/a.cpp", '"xvrml/xscript.h"'),
        ("plugins/shaders/a.cpp", "<openrt/openrt.h>"), ("plugins/shaders/a.cpp", "<fmt/format.h>"),
        ("apps/vv/a.cpp", '"geometry/mesh.h"'), ("apps/vv/a.cpp", '"scene/commit.h"'), ("bindings/python/a.cpp", '"edits_generated.h"'),
        ("libopenrt/include/openrt/openrts.h", "<openrt/openrt.h>"), ("libxvrml/include/xvrml/world.h", "<fmt/format.h>"),
        ("libopenrt/backend/local/a.cpp", "<sys/socket.h>"), ("libopenrt/backend/null/a.cpp", '"backend/local/embree.h"'),
        ("libxvrml/base/a.cpp", '"no/such.h"'), ("somewhere/a.cpp", "<vector>"),
    ]
    passing = [
        ("libopenrt/backend/local/a.cpp", "<embree3/rtcore.h>"), ("libopenrt/backend/local/a.cpp", '"render/film.h"'),
        ("libopenrt/api/a.cpp", '"scene/commit.h"'), ("libopenrt/api/a.cpp", '"edits_generated.h"'),
        ("libxvrml/openrt/a.cpp", "<openrt/openrt.h>"), ("libxvrml/openrt/a.cpp", '"geometry/mesh.h"'),
        ("libxvrml/geometry/a.cpp", "<xvrml/nodes.h>"), ("plugins/shaders/a.cpp", "<openrt/openrts.h>"),
        ("plugins/shaders/a.cpp", "<cmath>"), ("plugins/script/test/a.c", "<xvrml/xscript.h>"), ("apps/vv/a.cpp", '"xvrml/openrt.h"'), ("tests/unit/a.cpp", '"parse/builder.h"'),
    ]
    wrong = []
    for path, name in refused:
        if not check({**base, path: f"// a comment\n#include {name}\n"}):
            wrong.append(f"accepted: {path} includes {name}")
    for path, name in passing:
        for complaint in check({**base, path: f"#include {name}\n"}):
            wrong.append(f"refused: {complaint}")
    return wrong


def main():
    complaints = self_test() if sys.argv[1:] == ["--self"] else check(tree(pathlib.Path(sys.argv[1]).resolve()))
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
