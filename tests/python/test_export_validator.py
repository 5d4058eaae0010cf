"""Exports as the Khronos validator sees them. It needs Node.js and its package:

    npm install --prefix FOLDER gltf-validator
    GLTF_VALIDATOR=FOLDER pytest tests/python/test_export_validator.py
"""
import os
import pathlib
import shutil
import subprocess

import pytest
from test_export import SCENES, WORLD

# Prints a line for each error and warning.
PROGRAM = """
const [folder, ...files] = process.argv.slice(1);
const validator = require(folder + '/node_modules/gltf-validator'), fs = require('fs'), path = require('path');
(async () => {
  for (const file of files) {
    const beside = name => Promise.resolve(new Uint8Array(fs.readFileSync(path.join(path.dirname(file), decodeURIComponent(name)))));
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)),
                                                 {uri: file, maxIssues: 1000, externalResourceFunction: beside});
    for (const one of report.issues.messages)
      if (one.severity < 2) console.log(path.basename(file), one.code, one.pointer, one.message);
  }
})().catch(error => { console.error(error); process.exit(1); });
"""


def test_the_khronos_validator_finds_no_error(vv):
    folder = os.environ.get("GLTF_VALIDATOR")
    if not folder or not shutil.which("node"):
        pytest.skip("GLTF_VALIDATOR names no folder with the validator, or there is no node")
    vv.write("in.wrl", WORLD)
    worlds = [vv.folder / "in.wrl", *SCENES]
    files = []
    for number, world in enumerate(worlds):
        for suffix in ("glb", "gltf"):
            files.append(vv.folder / f"{number}.{suffix}")
            done = vv(world, "--write", files[-1], "-q")
            assert done.returncode == 0, done.talk
    done = subprocess.run(["node", "-e", PROGRAM, pathlib.Path(folder).resolve(), *files], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # Tangents of normal maps are those that viewers make.
    found = [line for line in done.stdout.splitlines() if "GENERATED_TANGENT_SPACE" not in line]
    assert found == []
