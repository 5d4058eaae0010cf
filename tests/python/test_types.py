"""Runs mypy --strict on the stubs, the examples and a program that uses the API; also on one that
must be rejected."""
import ast
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

xvrml = pytest.importorskip("xvrml")
ROOT = pathlib.Path(__file__).resolve().parents[2]

GOOD = '''
from typing import Optional

import numpy as np
import xvrml
from xvrml import interop, notebook, rt

world = xvrml.load("car.wrl")
for problem in world.warnings:
    print(problem.file, problem.line)
world["Lamp"].intensity = 0.5
box = xvrml.Shape(geometry=xvrml.Box(size=(1, 2, 3)), appearance=xvrml.Appearance(material=xvrml.Material()))
crate: xvrml.Shape = world.add(box, name="Crate")
world.route("Clock.fraction_changed", (crate, "set_geometry"))

@world.on("Clock.fraction_changed")
def tick(value: float, time: float) -> None:
    print(value, time)

tick(1, 2)
world.time = 2.5
node = world["Hull"]
if isinstance(node, xvrml.Transform):
    x, y, z = node.translation
    node.translation = np.zeros(3)
    node.children = [crate]
with node.edit("point") as p:
    p[:] = 1
image = world.render(size=(640, 480), error=0.01, viewpoint="Front", progress=True)
total: float = float(image.array.sum() + image["z"].min() + image.error.max())
for frame in world.animate(0, 10, fps=25, size=(640, 480)):
    frame.save(f"{frame.time}.png")
hits = world.raycaster().cast_rays(np.zeros((5, 6)))
print(hits["t_hit"].min())
with rt.Context() as context:
    context.instance(context.mesh(np.zeros((3, 3)))).matrix = np.eye(4)
    print(context.render(size=(4, 3)).array.shape)
print(interop.to_pil(image))
print(image.denoised(threads=1).note, xvrml.denoise(image.array, threads=1).shape)
print([row.how for row in xvrml.features().values() if not row.available])
with xvrml.LiveView(world, size=(64, 48), spp=4) as live:
    live.event({"type": "wheel", "dy": 100})
    delay = live.step() or 0.1
    print(live.wait().shape, live.facts["samples"], delay)
widget: notebook.View = world.view(size=(640, 480), transport="path")
widget.update()
widget.live.paused = True
browser = xvrml.Browser("car.wrl", trust=True)
browser.tick(1.0)


class Count(xvrml.Renderer):
    faces = 0

    def render_transform(self, node: xvrml.Transform, state: xvrml.RenderState) -> Optional[str]:
        return "skip" if state.name or node.scale[0] == 0 else None

    def draw(self, shape: xvrml.DrawnShape) -> None:
        self.faces += len(shape.mesh.faces) * shape.uses
        print(shape.appearance.front.color, shape.reaches)


world.render_with(Count(), spheres=8)
'''
BAD = {
    "xvrml.Box(sise=(1, 2, 3))": "sise",
    "xvrml.Sphere(radius='big')": "radius",
    "xvrml.load('a.wrl').tiem": "tiem",
    "xvrml.load('a.wrl').render(sice=(1, 2))": "sice",
    "xvrml.Sphere().radius = 'big'": "assignment",
    "xvrml.LiveView(xvrml.load('a.wrl'), sice=(1, 2))": "sice",
}


def mypy(*arguments):
    program = shutil.which("mypy")
    if not program:
        pytest.skip("mypy is not installed")
    stubs = pathlib.Path(xvrml.__file__).resolve().parent.parent
    return subprocess.run([
        program, "--strict", "--no-error-summary", "--show-error-codes", "--python-executable",
        sys.executable, *map(str, arguments)
    ],
                          env={
                              **os.environ, "MYPYPATH": str(stubs)
                          },
                          capture_output=True,
                          text=True,
                          timeout=300)


def test_programs_and_examples_are_typed(tmp_path):
    (tmp_path / "good.py").write_text(GOOD)
    examples = sorted((ROOT / "examples").rglob("*.py"))
    assert examples
    stubs = sorted(pathlib.Path(xvrml.__file__).resolve().parent.glob("*.pyi"))
    done = mypy("--cache-dir", tmp_path / "cache", tmp_path / "good.py", *examples, *stubs)
    assert done.returncode == 0, done.stdout
    (tmp_path / "bad.py").write_text("import xvrml\n" + "\n".join(BAD))
    done = mypy("--cache-dir", tmp_path / "cache", tmp_path / "bad.py")
    lines = done.stdout.splitlines()
    for number, (code, word) in enumerate(BAD.items(), 2):
        assert any(
            line.startswith(f"{tmp_path}/bad.py:{number}:") and word in line for line in lines), (
                code, done.stdout)


def test_named_tuples_have_the_fields_of_their_stubs():
    stub = ast.parse(pathlib.Path(xvrml.__file__).with_name("__init__.pyi").read_text())
    tuples = {
        one.name: tuple(field.target.id for field in one.body if isinstance(field, ast.AnnAssign))
        for one in stub.body if isinstance(one, ast.ClassDef) and any(
            isinstance(base, ast.Name) and base.id == "NamedTuple" for base in one.bases)
    }
    assert "MaterialValues" in tuples
    for name, fields in tuples.items():
        assert getattr(xvrml, name)._fields == fields, name
