"""Tests that the table of docs/packages.md says what packages have."""
import json
import re
import subprocess

import pytest
from conftest import ROOT, find_vv

OPTIONAL = {"denoise", "step"}  # the packages that this project installs to build have neither
ROW = re.compile(r"^\| (\w*) ?\| ([^|]*) \| ([^|]*) \| ([^|]*)\| ([^|]*) \|$", re.M)


def rows():
    """Returns the rows of the table: feature, what it is, wheel, extra, Debian."""
    text = (ROOT / "docs/packages.md").read_text()
    table = text.split("## What each package has")[1].split("An extra is")[0]
    found = [tuple(cell.strip() for cell in row) for row in ROW.findall(table)]
    return [row for row in found if row[0] != "feature"]


def features():
    done = subprocess.run([find_vv(), "--list-features", "--json"],
                          capture_output=True,
                          text=True,
                          check=True,
                          timeout=120)
    return {row["name"]: row["available"] for row in json.loads(done.stdout)["features"]}


def test_each_feature_has_a_row():
    assert len(rows()) == 18
    names = [name for name, *_ in rows() if name]
    assert names == list(dict.fromkeys(names))
    assert set(names) == set(features())


def test_debian_packages_have_what_this_build_has():
    missing = [name for name, there in features().items() if not there and name not in OPTIONAL]
    if missing:
        pytest.skip(f"built without {', '.join(missing)}, which the Debian packages have")
    for name, _, _, _, debian in rows():
        if name:
            assert debian.startswith("no" if name == "denoise" else "yes"), name


def test_the_wheel_lacks_what_its_own_test_says():
    text = (ROOT / "tools/wheel/try_wheel.py").read_text()
    missing = set(re.findall(r'"(\w+)"', re.search(r"^MISSING = {(.*)}$", text, re.M)[1]))
    assert {name for name, _, wheel, _, _ in rows() if name and wheel.startswith("no")} == missing


def test_the_extras_exist():
    project = (ROOT / "pyproject.toml").read_text().split("[project.optional-dependencies]")[1]
    there = set(re.findall(r"^(\w+) = \[", project.split("\n[")[0], re.M))
    named = {extra for row in rows() for extra in re.findall(r"xvrml\[(\w+)\]", row[3])}
    assert named == there
