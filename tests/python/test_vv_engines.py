"""Tests vv and its script engines: --list-engines, and messages about unknown protocols and
untrusted worlds."""
import json
import shutil

import pytest

from conftest import HEADER, ROOT, SMALL


def engines(vv, *options):
    done = vv("--list-engines", "--json", *options)
    assert done.returncode == 0, done.talk
    return {e["name"]: e for e in json.loads(done.text)["engines"]}


def test_list_engines(vv):
    found = engines(vv)
    if "native" not in found:
        pytest.skip("built without libffi")
    native = found["native"]
    assert native["schemes"] == [
        "native"
    ] and native["trust"] and not native["harmless"] and native["suffixes"] == []
    assert native["library"].endswith("/native.so") and native["text"]
    text = vv("--list-engines").text
    assert "native: " in text and "trusted ones only (--trust)" in text and native["library"] in text
    if "python" in found:
        assert found["python"]["suffixes"] == [".py"
                                              ] and "text/x-python" in found["python"]["mimeTypes"]


def test_a_library_that_is_no_engine_is_named(vv):
    folder = vv.folder / "engines"
    folder.mkdir(mode=0o755)
    (folder / "bad.so").write_text("no library")
    done = vv("--list-engines", "--script-path", folder)
    assert done.returncode == 0 and "bad.so" in done.talk
    folder.chmod(0o777)
    assert "others may write to it" in vv("--list-engines", "--script-path", folder).talk


def test_it_stands_alone(vv):
    done = vv("--list-engines", "--list-nodes")
    assert done.returncode == 2 and "--list-engines" in done.talk


def test_unknown_protocols_name_what_is_there(vv):
    vv.write("lisp.wrl", HEADER + 'Script { url "lisp:(+ 1 2)" }')
    talk = vv("lisp.wrl", "--check").talk
    assert "lisp.wrl:2" in talk and "no script engine for 'lisp:' is installed (looked in: " in talk
    for name in engines(vv):
        assert name in talk.split("found: ")[1]


@pytest.mark.parametrize("url, name", [("python:print(1)", "python"),
                                       ("native:libm.so.6#sinf", "native")])
def test_worlds_that_are_not_trusted(vv, url, name):
    if name not in engines(vv):
        pytest.skip(f"built without {name}")
    vv.write("bold.wrl", HEADER + f'Script {{ url "{url}" }}')
    talk = vv("bold.wrl", "--check").talk
    assert "only in worlds that are trusted (vv --trust)" in talk


def test_what_a_script_prints_is_a_message(vv):
    if "python" not in engines(vv):
        pytest.skip("built without python")
    vv.write(
        "says.wrl",
        HEADER + "Script { url \"python:import sys\nprint('hello')\nsys.stdout.write('aside')\" }")
    done = vv("says.wrl", "-o", "ppm:-", "--size", "8x6", "--spp", "1", "--trust")
    assert done.returncode == 0 and done.stdout.startswith(b"P6") and b"aside" not in done.stdout
    assert "hello" in done.talk


def test_python_leaves_the_signals_alone(vv):
    if "python" not in engines(vv):
        pytest.skip("built without python")
    vv.write(
        "signals.wrl",
        HEADER + 'Script { url "python:import signal\nprint(signal.getsignal(signal.SIGINT))" }')
    assert "None" in vv("signals.wrl", "--check", "--trust").talk  # not Python's


def test_python_is_the_same_in_every_run(vv):
    if "python" not in engines(vv):
        pytest.skip("built without python")
    vv.write(
        "same.wrl", HEADER +
        "Script { url \"python:import random\nprint(random.random(), set('abcdefgh'), hash('a'))\" }"
    )
    first = vv("same.wrl", "--check", "--trust").talk
    assert "Script: 0.84442185152504" in first and first == vv("same.wrl", "--check",
                                                               "--trust").talk


def test_an_interrupt_that_a_script_raises_is_its_own(vv):
    if "python" not in engines(vv):
        pytest.skip("built without python")
    vv.write("raises.wrl", HEADER + 'Script { url "python:\nraise KeyboardInterrupt" }')
    done = vv("raises.wrl", "--check", "--trust")
    assert done.returncode == 4 and "raises.wrl:3: error: Script: KeyboardInterrupt" in done.talk
    assert len(done.talk.splitlines()) == 2, done.talk


def pictures(vv, world, folder, variable, times):
    tree = vv.program.resolve().parents[1]
    if not (tree / folder).is_dir():
        pytest.skip(f"{folder} is not built")
    for time in times:
        done = vv(ROOT / world,
                  "-o",
                  "ppm:-",
                  *SMALL,
                  "--time",
                  time,
                  "--trust",
                  "--strict",
                  env={variable: str(tree / folder)})
        assert done.returncode == 0 and done.talk == "", done.talk
        yield done.stdout


def test_the_example_of_native_reads_its_sensor(vv):
    if "native" not in engines(vv):
        pytest.skip("built without native")
    at = list(
        pictures(vv, "examples/native/gauge.wrl", "examples/native", "XVRML_NATIVE_PATH",
                 ("0.5", "1", "1.5", "1")))
    assert len(set(at)) == 3 and at[1] == at[3]


def test_the_example_of_python_moves(vv):
    if "python" not in engines(vv):
        pytest.skip("built without python")
    at = list(
        pictures(vv, "examples/python/waves.wrl", "lib/xvrml/scripts", "XVRML_SCRIPT_PATH",
                 ("0.5", "1", "0.5")))
    assert at[0] == at[2] != at[1]


def test_the_template_of_an_engine(vv):
    at = list(
        pictures(vv, "examples/script_engine/wave.wrl", "examples/scripts", "XVRML_SCRIPT_PATH",
                 ("0", "1", "2")))
    assert at[0] != at[1] and len(set(at)) >= 2
    tree = vv.program.resolve().parents[1]

    def talk(program, fields="eventIn SFFloat x eventOut SFFloat y"):
        vv.write("f.wrl", HEADER + f'Script {{ {fields}\n url "formula:{program}" }}')
        return vv("f.wrl", "--check", "--script-path", tree / "examples/scripts").talk

    assert "f.wrl:3" in talk("y = sin(x") and "')' was expected" in talk("y = sin(x")
    assert "f.wrl:5" in talk("y = x\n\ny = wrong") and "no field or event wrong" in talk(
        "\ny = wrong")
    assert "there is no function sinn" in talk("y = sinn(x)")
    assert "too many parentheses" in talk("y = " + "(" * 300 + "x" + ")" * 300)
    assert "no field or eventOut of the Script: x" in talk("x = 1")
    assert "not of type" in talk("y = 1", "eventOut SFVec3f y")
    assert "0 errors" in talk("y = -(2 + x) * 3 / 4 - .5e-3")


def test_python_without_its_package_says_so(vv):
    found = engines(vv).get("python")
    if not found:
        pytest.skip("built without python")
    lonely = vv.folder / "lonely"
    lonely.mkdir(mode=0o755)
    shutil.copy(found["library"], lonely)
    vv.write("alone.wrl", HEADER + 'Script { url "python:print(1)" }')
    talk = vv("alone.wrl",
              "--check",
              "--trust",
              "--script-path",
              lonely,
              env={
                  "PYTHONPATH": "",
                  "PYTHONNOUSERSITE": "1"
              }).talk
    if "Script: 1" in talk:
        pytest.skip("the package is installed for all of Python")
    assert "alone.wrl:2" in talk and "the Python package xvrml, whose nodes Scripts in Python use, cannot be imported" in talk
