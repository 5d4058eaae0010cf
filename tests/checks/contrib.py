#!/usr/bin/env python3
"""Checks that the templates of contrib/ work: contrib.py ROOT BUILD

* Every option that they pass to vv and openrt-worker exists.
* bash and systemd-analyze accept their files.
* The YAML files parse, and their objects agree with each other.
* The recipe, the formula and the jobs of a release name files, targets and versions that exist.

A tool that is not installed is named and skipped."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

root, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
contrib = root / "contrib"
complaints, skipped = [], []


def complain(path, text):
    complaints.append(f"{path.relative_to(root)}: {text}")


def run(*command, **how):
    return subprocess.run([str(word) for word in command],
                          capture_output=True,
                          text=True,
                          timeout=60,
                          **how)


def options_of(program):
    """Returns the options that --help lists; None if the program is not there."""
    if not (build / "bin" / program).exists():
        skipped.append(f"{program} is not built")
        return None
    topic = ["all"] if program == "vv" else []
    return set(re.findall(r"--[a-z][a-z-]+", run(build / "bin" / program, "--help", *topic).stdout))


known = {program: options_of(program) for program in ("vv", "openrt-worker")}


def check_command(path, words):
    """Checks the options after the first word that is one of our programs."""
    for program in known:
        if program in words and known[program] is not None:
            for word in words[words.index(program):]:
                if word.startswith("--") and word.split("=")[0] not in known[program]:
                    complain(path, f"{program} has no option {word}")


# Hosts ------------------------------------------------------------------------------------------

hosts = contrib / "hosts.txt"
lines = [line.split("#")[0].strip() for line in hosts.read_text().splitlines()]
for line in filter(None, lines):
    if not re.fullmatch(r"([\w.-]+|\[[0-9a-f:]+\])(:\d+)?(=\S{40})?", line):
        complain(hosts, f"no address: {line}")

# Slurm -------------------------------------------------------------------------------------------

script = contrib / "slurm/render.sbatch"
if (done := run("bash", "-n", script)).returncode:
    complain(script, done.stderr)
text = re.sub(r"\\\n", " ", script.read_text())
for line in text.splitlines():
    if re.match(r"\s*(vv|openrt-worker)\b", line):
        check_command(script, shlex.split(line.rstrip("& "), comments=True))
if shutil.which("shellcheck") and (done := run("shellcheck", "-s", "bash", script)).returncode:
    complain(script, done.stdout)
if not re.search(r"^#SBATCH --", text, re.M) or text.index("#SBATCH") > text.index("set -euo"):
    complain(script, "options of sbatch stand before the first command")

# Pictures of boards -------------------------------------------------------------------------------

action = contrib / "github-action/action.yml"
script = action.with_name("board-pictures.sh")
if (done := run("bash", "-n", script)).returncode:
    complain(script, done.stderr)
if shutil.which("shellcheck") and (done := run("shellcheck", "-s", "bash", script)).returncode:
    complain(script, done.stdout)
for line in re.sub(r"\\\n", " ", script.read_text()).splitlines():
    if re.match(r"vv\b", line):
        check_command(script, shlex.split(line))
# Exports a board as kicad-cli does: writes the file behind -o, and the models beside it.
STAND_IN = """#!/bin/sh
while [ $# -gt 1 ]; do
  if [ "$1" = -o ]; then out=$2; fi
  shift
done
cp %s "$out" && cp -r %s "$(dirname "$out")"
"""


def make_pictures(folder, board, **environment):
    """Returns the names of the pictures that the script makes of a board, and what it says."""
    target = folder / f"{board.suffix[1:]}/a.png"
    done = run(script,
               board,
               target,
               "--spp",
               1,
               env={
                   **os.environ, "PATH": f"{folder}:{build / 'bin'}:{os.environ['PATH']}",
                   "SIZE": "40x30",
                   **environment
               })
    return done.returncode, sorted(path.name for path in target.parent.glob("*")), done.stderr


if known["vv"]:
    with tempfile.TemporaryDirectory() as name:
        folder, example = pathlib.Path(name), root / "examples/kicad"
        code, made, said = make_pictures(folder, example / "blinker.wrl", TURNTABLE="2")
        if code or made != ["a-above.gif", "a-above.png", "a-bottom.png", "a-top.png"]:
            complain(script, f"it made {made}: {said}")
        stand_in = folder / "kicad-cli"
        stand_in.write_text(STAND_IN % (example / "blinker.wrl", example / "shapes3D"))
        stand_in.chmod(0o755)
        board = folder / "blinker.kicad_pcb"
        board.write_text("(kicad_pcb)\n")
        code, made, said = make_pictures(folder, board, VIEWS="top")
        if code or made != ["a.png"] or "missing" in said:
            complain(script, f"with kicad-cli it made {made}: {said}")

# systemd -----------------------------------------------------------------------------------------

unit = contrib / "systemd/openrt-worker@.service"
text = unit.read_text()
command = re.search(r"^ExecStart=(.*)$", text, re.M).group(1)
check_command(
    unit,
    [pathlib.Path(word).name if i == 0 else word for i, word in enumerate(shlex.split(command))])
for needed in ("DynamicUser", "ProtectSystem", "NoNewPrivileges", "SystemCallFilter", "MemoryMax",
               "LoadCredential"):
    if not re.search(rf"^{needed}=", text, re.M):
        complain(unit, f"no {needed}")
if shutil.which("systemd-analyze"):
    # Neither the program nor the manual page needs to be installed.
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "openrt-worker@7447.service"
        copy.write_text(
            re.sub(r"^Documentation=.*\n",
                   "",
                   re.sub(r"^ExecStart=\S+", "ExecStart=/bin/true", text, flags=re.M),
                   flags=re.M))
        done = run("systemd-analyze", "verify", "--man=no", copy)
        said = [line for line in done.stderr.splitlines() if "openrt-worker" in line]
        if done.returncode or said:
            complain(unit, done.stderr)
        done = run("systemd-analyze", "security", "--offline=true", "--threshold=20", copy)
        if "unrecognized option" in done.stderr:
            skipped.append("systemd-analyze knows no --offline")
        elif done.returncode:
            complain(unit, "exposure is above 2.0: " + (done.stdout or done.stderr)[-200:])
else:
    skipped.append("no systemd-analyze")

# YAML --------------------------------------------------------------------------------------------

try:
    import yaml
except ImportError:
    yaml = None
    skipped.append("no yaml for Python")


def containers(pod):
    return pod.get("initContainers", []) + pod["containers"]


def check_pod(path, pod, labels):
    volumes = {volume["name"] for volume in pod.get("volumes", [])}
    for container in containers(pod):
        check_command(path, container.get("command", []))
        if not container.get("securityContext", {}).get("readOnlyRootFilesystem"):
            complain(path, f"{container['name']} may write to its image")
        if "limits" not in container.get("resources", {}):
            complain(path, f"{container['name']} has no limits")
        for mount in container.get("volumeMounts", []):
            if mount["name"] not in volumes:
                complain(path, f"no volume {mount['name']}")
    if pod.get(
            "securityContext",
        {}).get("runAsNonRoot") is not True or pod.get("automountServiceAccountToken") is not False:
        complain(path, "the pod has rights that it does not need")
    return labels, {
        port["name"]: port["containerPort"] for c in containers(pod) for port in c.get("ports", [])
    }


if yaml:
    made = yaml.safe_load(action.read_text())
    if made["runs"]["using"] != "composite" or any("shell" not in s for s in made["runs"]["steps"]):
        complain(action, "no composite action, or a step without a shell")
    used = set(re.findall(r"inputs\.(\w+)", action.read_text()))
    if used != set(made["inputs"]):
        complain(action, f"inputs that are not declared, or not used: {used ^ set(made['inputs'])}")
    for step in made["runs"]["steps"]:
        if "${{" in step["run"]:
            complain(action, "an input is pasted into a script; pass it in the environment")
        if (done := run("bash", "-n", "-c", step["run"])).returncode:
            complain(action, done.stderr)
    template = contrib / "kibot/board.kibot.yaml"
    made = yaml.safe_load(template.read_text())
    if made["kibot"]["version"] != 1 or [one["type"] for one in made["outputs"]] != ["vrml"]:
        complain(template, "no KiBot configuration with a vrml output")
    objects = {}
    for path in sorted((contrib / "kubernetes").glob("*.yaml")):
        for one in yaml.safe_load_all(path.read_text()):
            for field in ("apiVersion", "kind", "metadata", "spec"):
                if field not in one:
                    complain(path, f"an object has no {field}")
            objects[one["kind"]] = path, one
    if set(objects) != {"Service", "Deployment", "Job"}:
        complaints.append(f"contrib/kubernetes has {sorted(objects)}")
    service_path, service = objects["Service"]
    pods = {}
    for kind in ("Deployment", "Job"):
        path, one = objects[kind]
        template = one["spec"]["template"]
        labels = template["metadata"]["labels"]
        pods[kind] = check_pod(path, template["spec"], labels)
        selector = one["spec"].get("selector", {}).get("matchLabels", {})
        if not selector.items() <= labels.items() or (kind == "Deployment") != bool(selector):
            complain(path, f"the selector of the {kind} does not find its pods")
        names = {v["secret"]["secretName"] for v in template["spec"]["volumes"] if "secret" in v}
        if names != {"openrt-cluster-key"} or "openrt-cluster-key" not in path.with_name(
                "workers.yaml").read_text().split("apiVersion")[0]:
            complain(path, f"the secret is {names}")
    labels, ports = pods["Job"]
    if not service["spec"]["selector"].items() <= labels.items(
    ) or service["spec"]["selector"].items() <= pods["Deployment"][0].items():
        complain(service_path, "the Service does not lead to vv alone")
    port = service["spec"]["ports"][0]
    if ports.get(port["targetPort"]) != port["port"]:
        complain(service_path, "the Service's port is not vv's")
    worker = objects["Deployment"][1]["spec"]["template"]["spec"]["containers"][0]["command"]
    if f"{service['metadata']['name']}:{port['port']}" not in worker:
        complain(service_path, "workers call somebody else")
    images = {
        c["image"]
        for kind in ("Deployment", "Job")
        for c in objects[kind][1]["spec"]["template"]["spec"]["containers"]
    }
    if len(images) != 1:
        complain(service_path, f"master and workers have different images: {images}")
    compose = contrib / "compose.yaml"
    for service in yaml.safe_load(compose.read_text())["services"].values():
        check_command(compose, service["entrypoint"])
        if service["image"] not in images or service.get("cap_drop") != [
                "ALL"
        ] or service.get("read_only") is not True:
            complain(compose, "another image than Kubernetes', or rights that are not needed")

# Indexes of packages ----------------------------------------------------------------------------

version = re.search(r"project\(openrt VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text()).group(1)
build_script = contrib / "conda/recipe/build.sh"
if (done := run("bash", "-n", build_script)).returncode:
    complain(build_script, done.stderr)
formula = contrib / "homebrew/openrt.rb"
text = formula.read_text()
if f"openrt-{version}.tar.gz" not in text:
    complain(formula, f"is not of version {version}")
if shutil.which("ruby"):
    if (done := run("ruby", "-c", formula)).returncode:
        complain(formula, done.stderr)
else:
    skipped.append("no ruby")
formulas = set(re.findall(r'(?:depends_on|uses_from_macos) "([^"]+)"', text))
libraries = contrib / "homebrew/libraries.txt"
for name in set(libraries.read_text().split()) - formulas:
    complain(libraries, f"the formula does not need {name}")
# Names of what the build needs in Debian, conda-forge and Homebrew; "" where a recipe leaves it out.
NAMES = {
    "libembree-dev": ("embree", "embree"),
    "libtbb-dev": ("tbb-devel", "tbb"),
    "libhwy-dev": ("libhwy", "highway"),
    "libimath-dev": ("imath", "imath"),
    "libopenexr-dev": ("openexr", "openexr"),
    "libpng-dev": ("libpng", "libpng"),
    "libjpeg-dev": ("libjpeg-turbo", "jpeg-turbo"),
    "libgif-dev": ("giflib", "giflib"),
    "libwebp-dev": ("libwebp", "webp"),
    "libstb-dev": ("", ""),
    "libsndfile1-dev": ("libsndfile", "libsndfile"),
    "zlib1g-dev": ("zlib", "zlib"),
    "libzstd-dev": ("zstd", "zstd"),
    "libxxhash-dev": ("xxhash", "xxhash"),
    "libexpat1-dev": ("libexpat", "expat"),
    "libflatbuffers-dev": ("flatbuffers", "flatbuffers"),
    "libzmq3-dev": ("zeromq", "zeromq"),
    "cppzmq-dev": ("cppzmq", "cppzmq"),
    "liblz4-dev": ("lz4-c", "lz4"),
    "libfast-float-dev": ("fast_float", "fast_float"),
    "libfmt-dev": ("fmt", "fmt"),
    "libcli11-dev": ("cli11", "cli11"),
    "nlohmann-json3-dev": ("nlohmann_json", "nlohmann-json"),
    "libtomlplusplus-dev": ("tomlplusplus", "tomlplusplus"),
    "libavcodec-dev": ("ffmpeg", "ffmpeg"),
    "libavformat-dev": ("ffmpeg", "ffmpeg"),
    "libswscale-dev": ("ffmpeg", "ffmpeg"),
    "libfreetype-dev": ("freetype", "freetype"),
    "libharfbuzz-dev": ("harfbuzz", "harfbuzz"),
    "libfontconfig-dev": ("fontconfig", "fontconfig"),
    "libglu1-mesa-dev": ("libglu", "mesa-glu"),
    "python3-dev": ("python", "python"),
    "pybind11-dev": ("pybind11", ""),
    "duktape-dev": ("", "duktape"),
    "tcl-dev": ("tk", ""),
    "tk-dev": ("tk", ""),
    "libffi-dev": ("libffi", ""),
    "libseccomp-dev": ("", "libseccomp"),
    "libsdl2-dev": ("sdl2", "sdl2"),
    "libimgui-dev": ("", ""),
    "libwebsockets-dev": ("libwebsockets", "libwebsockets"),
}
packages = run(root / "tools/install-packages.sh", "--list").stdout.split()
needed = {name for name in packages if name.endswith("-dev")}
for name in needed ^ set(NAMES):
    complain(root / "tools/install-packages.sh", f"its libraries differ from those of this check: {name}")
for name in {brew for _, brew in NAMES.values() if brew} - formulas:
    complain(formula, f"does not need {name}, which the build does")
components = set(re.findall(r"COMPONENT (\w+)", (root / "cmake/Install.cmake").read_text())) | {"dev"}
for path in (formula, build_script):
    parts = re.search(r"(?:%w\[|for part in )([\w ]+)", path.read_text()).group(1).split()
    for name in set(parts) - components:
        complain(path, f"no component {name}")
if yaml:
    recipe_path = contrib / "conda/recipe/recipe.yaml"
    recipe = yaml.safe_load(recipe_path.read_text())
    if recipe["context"]["version"] != version:
        complain(recipe_path, f"is not of version {version}")
    host = {word.split()[0] for word in recipe["requirements"]["host"]}
    for name in {conda for conda, _ in NAMES.values() if conda} - host:
        complain(recipe_path, f"does not need {name}, which the build does")
    for test in recipe["tests"]:
        for command in test.get("script", []):
            check_command(recipe_path, shlex.split(command))
        for name in test.get("files", {}).get("source", []):
            if not (root / name).is_file():
                complain(recipe_path, f"no file {name}")
    release_path = contrib / "github/release.yml"
    release = yaml.safe_load(release_path.read_text())
    targets = set(re.findall(r"^([\w-]+):", (root / "Makefile").read_text(), re.M))
    for name, job in release["jobs"].items():
        for needed in [job["needs"]] if isinstance(job.get("needs"), str) else job.get("needs", []):
            if needed not in release["jobs"]:
                complain(release_path, f"{name} needs {needed}, which is no job")
        for step in job["steps"]:
            script = step.get("run", "")
            if ("uses" in step) == bool(script):
                complain(release_path, f"a step of {name} neither runs nor uses something")
            if (done := run("bash", "-n", input=script)).returncode:
                complain(release_path, f"{name}: {done.stderr}")
            for target in re.findall(r"^make ([\w-]+)", script, re.M):
                if target not in targets:
                    complain(release_path, f"{name}: the Makefile has no {target}")
            for file in re.findall(r"\b(?:tools|contrib)/[\w./-]+", script):
                if not (root / file).exists():
                    complain(release_path, f"{name}: no file {file}")

listed = (contrib / "README.md").read_text()
for path in contrib.rglob("*"):
    if path.is_file(
    ) and path.parent.name != "container" and path.name != "README.md" and f"`{path.relative_to(root)}`" not in listed:
        complain(path, "contrib/README.md does not list it")

print(*complaints,
      f"{len(complaints)} complaints" + "".join(f"; skipped: {what}" for what in skipped),
      sep="\n")
sys.exit(1 if complaints else 0)
