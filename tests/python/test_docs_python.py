"""Runs the code blocks of docs/python.md, figures.md, ray-queries.md, photometry.md,
daylight.md and editor.md in order.
Blocks marked needs=PACKAGE run if it is installed; worlds marked file=NAME are written before."""
import importlib.util
import os
import pathlib
import re
import shutil

import pytest
from conftest import find_vv

pytest.importorskip("numpy")
pytest.importorskip("xvrml")

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.parametrize("page", [
    "python.md", "figures.md", "ray-queries.md", "photometry.md", "daylight.md", "editor.md"])
def test_blocks_run(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{find_vv().parent}{os.pathsep}{os.environ['PATH']}")
    shutil.copytree(DOCS.parent / "examples", tmp_path / "examples")
    text = (DOCS / page).read_text()
    for name, world in re.findall(r"```vrml file=([\w.]+)\n(.*?)```", text, re.S):
        (tmp_path / name).write_text(world)
    blocks = re.findall(r"```python([^\n]*)\n(.*?)```", text, re.S)
    assert len(blocks) >= 2
    names = {"__name__": "docs"}
    for mark, block in blocks:
        needs = re.findall(r"needs=(\w+)", mark)
        if any(importlib.util.find_spec(package) is None for package in needs):
            continue
        if needs == ["pyoidn"]:  # test_denoise.py runs it, with a library of its own
            continue
        line = text[:text.index(block)].count("\n")
        exec(compile("\n" * line + block, str(DOCS / page), "exec"), names)
