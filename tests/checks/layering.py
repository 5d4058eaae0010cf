#!/usr/bin/env python3
"""Reads every #include of the sources and fails on any dependency that docs/architecture.md section
1 does not show.

layering.py ROOT           checks the tree, and that the map in docs/architecture.md matches TABLE
layering.py ROOT --write   writes that map
layering.py --self         tests the check with includes that must be refused and some that must pass
"""
import dataclasses
import pathlib
import re
import sys
import textwrap


@dataclasses.dataclass(frozen=True)
class Part:
    """A part of the project: the files below `prefixes` (a file belongs to the longest prefix of
    all), and the other parts whose headers they may include."""
    name: str
    prefixes: tuple
    purpose: str
    includes: frozenset


def part(name, prefixes, purpose, includes=""):
    return Part(name, tuple(prefixes.split()), purpose, frozenset(includes.split()))


# From the bottom up: public headers, then each library, then the programs and bindings built on
# them.
TABLE = [
    part(
        "api-h",
        " ".join(f"libopenrt/include/openrt/{name}.h" for name in ("openrt", "context", "geometry",
                                                                   "shader", "frame", "query",
                                                                   "worker", "sums")),
        "the application API, C99"),
    part(
        "gl-h",
        " ".join(f"libopenrt/include/openrt/{name}.h"
                 for name in ("gl", "gl_types", "gl_values", "gl_functions", "gl_names")),
        "OpenGL 1.1 and GLU, C99", "api-h"),
    part("rtut-h", "libopenrt/include/openrt/rtut.h", "windows in GLUT's manner, C99",
         "api-h gl-h"),
    part("shader-sdk", "libopenrt/include/openrt/", "what a shader plug-in sees, C99 and C++"),
    part("xvrml-h", "libxvrml/include/xvrml/", "worlds, nodes, events: the public C++ headers"),
    part("script-sdk", "libxvrml/include/xvrml/xscript.h libxvrml/include/xvrml/xscript_types.h",
         "what a script engine sees, C99"),
    part("mapper-h", "libxvrml/include/xvrml/mapper.h",
         "draws a world through the C API", "xvrml-h"),
    part("system", "common/system/",
         "calls that not every operating system has, behind functions that each has"),
    part("common", "common/", "headers that several libraries share", "system"),
    part("openrt-scene", "libopenrt/scene/", "edits, commits, and the scene that they make",
         "api-h common"),
    part("openrt-shading", "libopenrt/shading/", "shader plug-ins, parameters, textures",
         "shader-sdk openrt-scene common system"),
    part("render-scene", "libopenrt/render/",
         "the snapshot of a scene that a frame renders: records, shaders, media; rays and their hits",
         "api-h shader-sdk openrt-scene openrt-shading"),
    part("render-lanes", "libopenrt/render/lanes/", "arithmetic on vector lanes",
         "render-scene common"),
    part("render-wave", "libopenrt/render/wave/",
         "many rays at once: their paths, samples and random numbers, what they hit, shading points",
         "api-h shader-sdk openrt-scene openrt-shading render-scene render-lanes"),
    part("render-film", "libopenrt/render/film/",
         "sums of samples, error bars, trust, the channels of a picture",
         "api-h openrt-scene render-wave common"),
    part("render-surface", "libopenrt/render/surface/",
         "calls shaders; lobes, and rays that are sampled from them",
         "shader-sdk openrt-scene openrt-shading render-scene render-lanes render-wave"),
    part("render-lights", "libopenrt/render/lights/",
         "light sampling of lamps, shapes and the sky; shadow rays",
         "shader-sdk openrt-scene openrt-shading render-scene render-lanes render-wave render-film render-surface"),
    part("render-medium", "libopenrt/render/medium/", "paths within media that scatter",
         "shader-sdk openrt-scene render-scene render-wave render-lights"),
    part("render-path", "libopenrt/render/path/",
         "paths from the camera and from lamps; the transports, and the functions that shaders call",
         "api-h openrt-scene openrt-shading render-scene render-lanes render-wave render-film render-surface render-lights render-medium"),
    part("render-frame", "libopenrt/render/frame/",
         "divides a frame into jobs, does them, and merges their results",
         "api-h openrt-scene render-scene render-wave render-film render-path common system"),
    part("openrt-backend", "libopenrt/backend/",
         "the interface between the API and whoever renders", "api-h openrt-scene common"),
    part("backend-local", "libopenrt/backend/local/",
         "renders in this process; the only part that knows Embree",
         "api-h openrt-scene openrt-shading render-scene render-lanes render-wave render-lights render-medium render-path render-frame openrt-backend common system"),
    part("backend-record", "libopenrt/backend/record/",
         "writes edits to a file, and reads it; checks them against class tables",
         "api-h shader-sdk openrt-scene openrt-shading openrt-backend common"),
    part("backend-debug", "libopenrt/backend/debug/",
         "tells misuse of the API; names things as the class tables do",
         "api-h shader-sdk openrt-scene openrt-shading openrt-backend common"),
    part("backend-null", "libopenrt/backend/null/", "takes edits and draws nothing",
         "api-h openrt-scene openrt-backend common"),
    part(
        "backend-cluster", "libopenrt/backend/cluster/",
        "renders with the help of other machines: net/ connects machines, messages/ says what they send each other, master/ gives jobs out, worker/ does them on a local backend",
        "api-h shader-sdk openrt-scene openrt-shading render-film render-frame openrt-backend backend-local backend-record common system"
    ),
    part("openrt-api", "libopenrt/api/",
         "the rt* functions: they make edits and hand them to a backend",
         "api-h shader-sdk openrt-scene openrt-shading openrt-backend common"),
    part("openrt-api-sums", "libopenrt/api/sums.cpp",
         "the rt* functions for kept sums, which are used without a context",
         "api-h openrt-scene render-frame openrt-api"),
    part("rtgl", "libopenrt/gl/",
         "OpenGL 1.1 on top of the public headers: records frames, and keeps their scene",
         "api-h gl-h"),
    part("rtut", "libopenrt/rtut/", "windows, events and pictures in files, in GLUT's manner",
         "api-h gl-h rtut-h"),
    part("openrt-tools", "libopenrt/tools/", "openrt-replay and openrt-worker",
         "api-h openrt-scene openrt-shading openrt-backend backend-record backend-cluster common"),
    part("xvrml-base", "libxvrml/base/ libxvrml/nodes/",
         "values, lexer, limits; shared with nodegen", "xvrml-h common system"),
    part("nodegen", "libxvrml/nodegen/", "writes the node classes and tables from .node files",
         "xvrml-h xvrml-base common"),
    part("xvrml-graph", "libxvrml/graph/",
         "the scene graph: access to fields, ranges, prototypes and their expansion, equality",
         "xvrml-h xvrml-base common"),
    part("xvrml-vrml1", "libxvrml/parse/vrml1/",
         "reads VRML 1.0: carries its traversal state, and builds the VRML97 graph",
         "xvrml-h xvrml-base xvrml-graph xvrml-geometry common"),
    part("xvrml-parse", "libxvrml/parse/", "reads worlds: parser, builder, loader",
         "xvrml-h xvrml-base xvrml-graph xvrml-vrml1 xvrml-decode common system"),
    part("xvrml-write", "libxvrml/write/",
         "writes worlds as VRML97 or as X3D (ClassicVRML and XML), and values as text",
         "xvrml-h xvrml-base xvrml-graph xvrml-geometry common"),
    part("xvrml-edit", "libxvrml/edit/",
         "edits of a world's file: steps, undo, and the text of the file with the edits in place",
         "xvrml-h xvrml-base xvrml-graph xvrml-parse xvrml-write common"),
    part("xvrml-geometry", "libxvrml/geometry/",
         "geometry nodes as triangles, lines and points: pure functions",
         "xvrml-h xvrml-base common"),
    part("xvrml-process", "libxvrml/process/",
         "processes that work for the library, and messages to and from them", "common system"),
    part("xvrml-decode", "libxvrml/decode/",
         "decodes files of formats that need large libraries, in a process",
         "xvrml-base xvrml-process common"),
    part("cage", "libxvrml/tools/cage/", "the sandbox of such processes", "system"),
    part("decoder", "libxvrml/tools/decoder/", "the program that decodes pictures and sounds",
         "cage xvrml-decode xvrml-process"),
    part("step-reader", "libxvrml/tools/step_reader/", "the program that reads STEP models",
         "decoder xvrml-decode common"),
    part("xvrml-image", "libxvrml/image/", "decodes pictures and films",
         "xvrml-h xvrml-base xvrml-decode common"),
    part("xvrml-event", "libxvrml/event/",
         "routes, cascades, and which nodes are part of the running world",
         "xvrml-h xvrml-base xvrml-graph xvrml-geometry common"),
    part(
        "xvrml-behaviour", "libxvrml/behaviour/",
        "what nodes do when events arrive and time passes; the viewer, the pointer, picking",
        "xvrml-h xvrml-base xvrml-graph xvrml-parse xvrml-geometry xvrml-decode xvrml-image xvrml-event common"),
    part("xvrml-render", "libxvrml/render/",
         "walks over what a viewer sees, for renderers; appearances, pictures and meshes for them",
         "xvrml-h xvrml-base xvrml-graph xvrml-geometry xvrml-image xvrml-event"),
    part("script-remote", "libxvrml/script/remote/", "Scripts in processes of their own",
         "script-sdk xvrml-process common"),
    part("xvrml-script", "libxvrml/script/", "finds script engines and runs Script nodes with them",
         "xvrml-h script-sdk script-remote xvrml-base xvrml-graph xvrml-parse xvrml-event common system"),
    part("script-host", "libxvrml/tools/script_host/", "the program of those processes",
         "script-sdk xvrml-script script-remote xvrml-process cage common system"),
    part(
        "xvrml-browser", "libxvrml/browser/",
        "a running world: one object that owns all of the above",
        "xvrml-h xvrml-base xvrml-graph xvrml-parse xvrml-geometry xvrml-image xvrml-event xvrml-behaviour xvrml-script common"
    ),
    part("mapper", "libxvrml/mapper/", "maps a scene graph to rt* calls (library xvrml_openrt)",
         "mapper-h xvrml-h xvrml-base xvrml-geometry xvrml-image api-h common"),
    part("photometry",
         " ".join(f"plugins/shaders/{name}.h" for name in ("photometry", "ies", "eulumdat")),
         "reads the light distributions of luminaires: IES and EULUMDAT files"),
    part("shader-plugin", "plugins/shaders/", "stock shaders", "shader-sdk photometry"),
    part("script-plugin", "plugins/script/",
         "script engines; common/ says where native: libraries are looked for",
         "script-sdk common system"),
    part("picture", "libpicture/",
         "renders worlds to pictures and writes files; reads the tables of shader plug-ins; shared by vv and the Python bindings",
         "api-h shader-sdk photometry xvrml-h mapper-h common system"),
    part("vv-process", "apps/vv/process/",
         "what stands between vv and the operating system: messages, signals, exit codes",
         "api-h common picture"),
    part("vv-options", "apps/vv/options/", "the command line, and the files that set options",
         "xvrml-h picture vv-process common"),
    part("vv-report", "apps/vv/report/",
         "what vv says of worlds and pictures, for people and as JSON",
         "api-h xvrml-h picture vv-process vv-options common system"),
    part("vv-start", "apps/vv/start/", "starts worlds as the options say, and runs their clock",
         "xvrml-h picture vv-process vv-options vv-report common system"),
    part("vv-input", "apps/vv/session/input/", "what a user does, as events, keys and scripts",
         "xvrml-h picture vv-options common"),
    part("vv-edit", "apps/vv/edit/",
         "the editor of a world: selection, outline and properties as rows that each face draws",
         "xvrml-h picture common"),
    part("vv-json", "apps/vv/as_json/",
         "values of fields and steps of edits as JSON, for programs and pages",
         "xvrml-h vv-edit common"),
    part("vv-session", "apps/vv/session/",
         "a world that is shown to somebody: input, time, the pace of its pictures",
         "xvrml-h picture vv-process vv-options vv-report vv-start vv-input vv-edit"),
    part("vv-run", "apps/vv/run/", "pictures and facts for files, without a window",
         "xvrml-h picture vv-process vv-options vv-report vv-start vv-edit vv-session common"),
    part("vv-control", "apps/vv/control/",
         "the control channel: commands of other programs, as lines of JSON over sockets",
         "xvrml-h picture vv-process vv-options vv-report vv-edit vv-json vv-session vv-run common system"),
    part("vv-window", "apps/vv/window/", "vv's window; the only part that knows SDL and Dear ImGui",
         "xvrml-h picture vv-process vv-options vv-report vv-start vv-input vv-edit vv-session vv-control common"),
    part("vv-server", "apps/vv/server/",
         "vv serve: a world on a page; the only part that knows libwebsockets",
         "xvrml-h picture vv-process vv-options vv-report vv-start vv-input vv-edit vv-json vv-session common system"),
    part("vv", "apps/vv/", "the program: chooses what runs",
         "picture vv-process vv-options vv-report vv-input vv-session vv-run vv-control vv-window vv-server common"),
    part("binding", "bindings/", "the Python package", "api-h xvrml-h mapper-h picture common"),
    part("example", "examples/", "programs for readers",
         "api-h gl-h rtut-h shader-sdk script-sdk xvrml-h mapper-h"),
    part("test", "tests/", "tests, benchmarks and audits"),
]
PARTS = {prefix: p.name for p in TABLE for prefix in p.prefixes}
ARROWS = {p.name: p.includes for p in TABLE}
ARROWS["test"] = frozenset(ARROWS)
PUBLIC = {"api-h", "gl-h", "rtut-h", "shader-sdk", "script-sdk", "xvrml-h", "mapper-h"}
# Third-party headers that only some parts may include.
FOREIGN = [
    (re.compile(r"embree\d/"), {"backend-local", "test"}, "Embree"),
    (re.compile(r"(sys/socket|netinet/|arpa/|netdb|zmq)"),
     {"backend-cluster", "xvrml-process", "vv-control", "vv-server", "system", "test"}, "sockets"),
    (re.compile(
        r"(png|jpeglib|turbojpeg|gif_lib|ft2build|freetype|hb|hb-ft|fontconfig/.*|GL/glu)(\.h)?$"),
     {"xvrml-geometry", "xvrml-image", "picture", "vv-window", "test"}, "picture and font libraries"),
    (re.compile(r"(SDL2/.*|SDL\w*\.h)$"), {"vv-window", "rtut"}, "SDL"),
    (re.compile(r"imgui"), {"vv-window"}, "Dear ImGui"),
    (re.compile(r"libwebsockets"), {"vv-server"}, "libwebsockets"),
    (re.compile(r"lib(av|sw)[a-z]+/"), {"xvrml-image", "picture", "test"}, "the ffmpeg libraries"),
    (re.compile(r"(OpenEXR/|Imf)"), {"picture", "decoder", "test"}, "OpenEXR"),
    (re.compile(r"(webp/|stb/|sndfile)"), {"decoder", "test"}, "libraries that are used in the cage only"),
    (re.compile(r"(BRep|Bnd_|Interface_|Message|Poly_|RWMesh|STEP|Standard_|TCollection|TD|Top|XCAF|gp_).*\.hxx$"),
     {"step-reader"}, "Open CASCADE"),
    (re.compile(r"(CLI/|CLI11)"), {"vv-options", "openrt-tools", "nodegen"}, "CLI11"),
    (re.compile(r"toml\+\+/"), {"vv-options", "binding"}, "toml++"),
    (re.compile(r"pybind11/"), {"binding", "script-plugin"}, "pybind11"),
    (re.compile(r"expat\.h$"), {"xvrml-parse", "test"}, "expat"),
]
# A public header includes only the language's own headers and no third-party ones.
STANDARD = re.compile(r"[a-z_0-9]+(\.h)?$")
# Headers of the languages that script engines run.
LANGUAGES = re.compile(r"(Python\.h|pybind11/\w+\.h|quickjs/quickjs\.h)$")
SEARCH = [
    "libopenrt/include", "libxvrml/include", "libopenrt", "libxvrml", "plugins/shaders", "apps/vv",
    "tests", "common", "."
]
# Generated at build time -> the part that they belong to.
GENERATED = [(re.compile(r"edits_generated\.h$"), "openrt-scene"),
             (re.compile(r"messages_generated\.h$"), "backend-cluster"),
             (re.compile(r"xvrml/(nodes|node_renderer)\.h$"), "xvrml-h")]
SUFFIXES = {".c", ".cpp", ".h", ".hpp"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)


def part_of(path):
    best = max((prefix for prefix in PARTS if path.startswith(prefix)), key=len, default=None)
    return PARTS[best] if best else None


def target(path, name, quoted, files):
    """Returns the part that the included header belongs to, or None for a third-party header."""
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
    """Returns the list of violations. files: path -> text."""
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
                complaints.append(
                    f'{where}: "{name}" names no header of the project; write <{name}> for one of others'
                )
            for pattern, who, what in FOREIGN:
                if pattern.match(name) and part not in who:
                    complaints.append(f"{where}: {part} may not know {what} ({name})")
            if part in PUBLIC | {"shader-plugin", "script-plugin"} and not STANDARD.match(name):
                if part == "script-plugin" and LANGUAGES.match(name):
                    continue
                complaints.append(
                    f"{where}: {part} may include the language's own headers only, not {name}")
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
        "common/system/sockets.h": "",
        "libopenrt/include/openrt/openrt.h": "",
        "libopenrt/include/openrt/openrts.h": "",
        "libopenrt/scene/commit.h": "",
        "libopenrt/render/film/film.h": "",
        "libopenrt/render/wave/wave.h": "",
        "libopenrt/backend/backend.h": "",
        "libopenrt/backend/local/accel/embree.h": "",
        "libxvrml/include/xvrml/world.h": "",
        "libxvrml/include/xvrml/xscript.h": "",
        "libxvrml/include/xvrml/mapper.h": "",
        "libxvrml/parse/builder.h": "",
        "libxvrml/geometry/mesh.h": "",
        "apps/vv/window/window.h": "",
        "apps/vv/options/options.h": "",
    }
    refused = [
        ("libopenrt/api/a.cpp", "<embree3/rtcore.h>"),
        ("libopenrt/render/a.cpp", '"backend/local/accel/embree.h"'),
        ("libopenrt/scene/a.cpp", '"render/film/film.h"'),
        ("libopenrt/scene/a.cpp", '"../render/film.h"'),
        ("libopenrt/render/wave/a.cpp", '"render/film/film.h"'),
        ("apps/vv/report/a.cpp", '"apps/vv/window/window.h"'),
        ("libopenrt/api/a.cpp", '"xvrml/world.h"'),
        ("libxvrml/parse/a.cpp", '"openrt/openrt.h"'),
        ("libxvrml/parse/a.cpp", "<openrt/openrt.h>"),
        ("libxvrml/geometry/a.cpp", '"parse/builder.h"'),
        ("libxvrml/mapper/a.cpp", '"scene/commit.h"'),
        ("libxvrml/parse/a.cpp", "<png.h>"),
        ("plugins/script/test/a.c", "<xvrml/world.h>"),
        ("libxvrml/event/a.cpp", '"xvrml/xscript.h"'),
        ("plugins/shaders/a.cpp", "<openrt/openrt.h>"),
        ("plugins/shaders/a.cpp", "<fmt/format.h>"),
        ("apps/vv/a.cpp", '"geometry/mesh.h"'),
        ("apps/vv/a.cpp", '"scene/commit.h"'),
        ("bindings/python/a.cpp", '"edits_generated.h"'),
        ("libopenrt/include/openrt/openrts.h", "<openrt/openrt.h>"),
        ("libxvrml/include/xvrml/world.h", "<fmt/format.h>"),
        ("libopenrt/backend/local/a.cpp", "<sys/socket.h>"),
        ("libopenrt/render/path/a.cpp", '"system/sockets.h"'),
        ("libopenrt/backend/null/a.cpp", '"backend/local/accel/embree.h"'),
        ("libxvrml/base/a.cpp", '"no/such.h"'),
        ("somewhere/a.cpp", "<vector>"),
    ]
    passing = [
        ("libopenrt/render/film/a.cpp", '"render/wave/wave.h"'),
        ("apps/vv/report/a.cpp", '"options/options.h"'),
        ("libopenrt/backend/local/a.cpp", "<embree3/rtcore.h>"),
        ("libopenrt/backend/local/a.cpp", '"render/wave/wave.h"'),
        ("libopenrt/api/a.cpp", '"scene/commit.h"'),
        ("libopenrt/api/a.cpp", '"edits_generated.h"'),
        ("libxvrml/mapper/a.cpp", "<openrt/openrt.h>"),
        ("libxvrml/mapper/a.cpp", '"geometry/mesh.h"'),
        ("libxvrml/geometry/a.cpp", "<xvrml/nodes.h>"),
        ("plugins/shaders/a.cpp", "<openrt/openrts.h>"),
        ("plugins/shaders/a.cpp", "<cmath>"),
        ("plugins/script/test/a.c", "<xvrml/xscript.h>"),
        ("apps/vv/run/a.cpp", '"xvrml/world.h"'),
        ("tests/unit/a.cpp", '"parse/builder.h"'),
    ]
    wrong = []
    for path, name in refused:
        if not check({**base, path: f"// a comment\n#include {name}\n"}):
            wrong.append(f"accepted: {path} includes {name}")
    for path, name in passing:
        for complaint in check({**base, path: f"#include {name}\n"}):
            wrong.append(f"refused: {complaint}")
    return wrong


BEGIN, END = "<!-- begin of the map: tests/checks/layering.py --write makes it -->", "<!-- end of the map -->"


def levels():
    """Lists the parts (except tests) by height: each includes only parts of lower rows. Raises
    ValueError if parts include each other."""
    height = {}

    def height_of(name, above=()):
        if name in above:
            raise ValueError("parts include each other: " + " > ".join((*above, name)))
        if name not in height:
            height[name] = 1 + max((height_of(lower, (*above, name)) for lower in ARROWS[name]),
                                   default=-1)
        return height[name]

    rows = {}
    for p in TABLE:
        if p.name != "test":
            rows.setdefault(height_of(p.name), []).append(p.name)
    return [rows[h] for h in sorted(rows, reverse=True)]


def wrapped(names, width):
    return textwrap.wrap("  ".join(names), width, break_long_words=False, break_on_hyphens=False)


def map_text():
    """Returns the diagram and the table of docs/architecture.md, section 1."""
    lines = [BEGIN, "<!-- unchecked: a drawing made from the table below -->", "```text"]
    columns = [("libopenrt", 36), ("libxvrml", 36), ("", 28)]
    lines.append("".join(
        f"{name or 'beside and above both':<{width}}" for name, width in columns).rstrip())
    library_of = {
        p.name:
            next((c
                  for c, (name, _) in enumerate(columns)
                  if name and p.prefixes[0].startswith(name)), 2) for p in TABLE
    }
    for row in levels():
        cells = [
            wrapped([name for name in row if library_of[name] == c],
                    width - 2) for c, (_, width) in enumerate(columns)
        ]
        lines.append("-" * 100)
        for k in range(max(len(cell) for cell in cells)):
            texts = [cell[k] if k < len(cell) else "" for cell in cells]
            lines.append("".join(
                f"{text:<{width}}" for text, (_, width) in zip(texts, columns)).rstrip())
    lines.append("```")
    lines += ["", "| part | files | what it is | may include |", "| --- | --- | --- | --- |"]
    for p in TABLE:
        allowed = "every part" if p.name == "test" else ", ".join(
            q.name for q in TABLE if q.name in p.includes) or "nothing"
        files = ", ".join(f"`{prefix}`" for prefix in p.prefixes)
        lines.append(f"| {p.name} | {files} | {p.purpose} | {allowed} |")
    return "\n".join(lines + [END])


def page_with_map(text):
    before, rest = text.split(BEGIN, 1)
    return before + map_text() + rest.split(END, 1)[1]


def main():
    if sys.argv[1:] == ["--self"]:
        complaints = self_test()
    else:
        root = pathlib.Path(sys.argv[1]).resolve()
        page = root / "docs/architecture.md"
        text = page.read_text(encoding="utf-8")
        if sys.argv[2:] == ["--write"]:
            page.write_text(page_with_map(text), encoding="utf-8")
            return 0
        complaints = check(tree(root))
        if page_with_map(text) != text:
            complaints.append(
                "docs/architecture.md: the map of section 1 is old; run tests/checks/layering.py . --write"
            )
    for complaint in complaints:
        print(complaint)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
