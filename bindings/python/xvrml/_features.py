"""Tells what depends on libraries and packages that need not be installed."""
import importlib.util
from typing import Dict, NamedTuple

from . import _xvrml

# name, package, what it is for, how to get it
_PACKAGES = (("notebook", "jupyter_rfb", "World.view() in notebooks",
              "pip install 'xvrml[notebook]'"),
             ("dask", "distributed", "xvrml.dask: pictures on a Dask cluster",
              "pip install 'xvrml[dask]'"),
             ("ray", "ray", "xvrml.ray: pictures on a Ray cluster", "pip install 'xvrml[ray]'"))


class Feature(NamedTuple):
    """A row of features()."""
    name: str
    text: str  # what it is for
    available: bool
    detail: str  # what provides it, with its version, or why it is not available
    file: str  # the library's file; "" if it is part of the package
    how: str  # how to get it; "" if it is available


def _folders(package):
    """Returns the folders of a package that is installed, without importing it."""
    try:
        spec = importlib.util.find_spec(package)
    except (ImportError, ValueError):
        return []
    return list(spec.submodule_search_locations or ["."]) if spec else []


def look_for_pyoidn():
    """Tells the library where the package pyoidn is."""
    for folder in _folders("pyoidn"):
        _xvrml._look_in(folder)


def features() -> Dict[str, Feature]:
    """Returns what depends on libraries and packages that need not be there, by name: denoise, mp4,
    webm, gif, script engines, seccomp, step, notebook, dask, ray. A library for denoising is tried in a
    child process. `vv --list-features` also lists what only the program has."""
    rows = [Feature(*row) for row in _xvrml._features()]
    for name, package, text, how in _PACKAGES:
        there = bool(_folders(package))
        rows.append(Feature(name, text, there, package if there else "", "", "" if there else how))
    return {row.name: row for row in rows}
