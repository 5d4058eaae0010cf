"""PEP 517 backend of the distribution `xvrml`: scikit-build-core builds the wheel, then auditwheel
adds the libraries that it links. pip calls this for `pip install .` and `pip wheel .`, so that both
need no system package at run time. On other systems than Linux the libraries are left to
cibuildwheel, which has delocate for macOS.

auditwheel omits libraries that its manylinux policies expect of every desktop (X11, glib, zlib,
expat, ...). A bare system has only the C and C++ run time, so everything else is included.
"""
import json
import logging
import os
import pathlib
import subprocess
import sys
import tempfile

# noqa: F401,F403  scikit-build-core's other hooks are used unchanged
from scikit_build_core.build import *
from scikit_build_core import build as _build

# Libraries that exist wherever a Python for glibc runs.
_SYSTEM = ("libc.so", "libm.so", "libdl.so", "libpthread.so", "librt.so", "libutil.so",
           "libresolv.so", "libnsl.so", "ld-linux", "libgcc_s.so", "libstdc++.so")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    if sys.platform != "linux":
        return _build.build_wheel(wheel_directory, config_settings, metadata_directory)
    with tempfile.TemporaryDirectory() as plain:
        name = _build.build_wheel(plain, config_settings, metadata_directory)
        out = pathlib.Path(plain) / "bundled"
        # Runs in a process of its own: it changes auditwheel's policies, and auditwheel logs
        # through the root logger.
        subprocess.run([sys.executable, __file__,
                        str(pathlib.Path(plain) / name),
                        str(out)],
                       check=True,
                       env={
                           **os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)
                       })
        made, = out.glob("*.whl")
        target = pathlib.Path(wheel_directory) / made.name
        target.write_bytes(made.read_bytes())
        return made.name


def _bundle(wheel, out):
    import auditwheel.main
    import auditwheel.policy as policy
    logging.getLogger().setLevel(logging.INFO)
    with tempfile.NamedTemporaryFile("w", suffix=".json", delete=False) as changed:
        where = policy._POLICY_JSON_MAP
        libc = next(key for key in where if key.name == "GLIBC")
        policies = json.loads(where[libc].read_text())
        for one in policies:
            one["lib_whitelist"] = [lib for lib in one["lib_whitelist"] if lib.startswith(_SYSTEM)]
        json.dump(policies, changed)
    where[libc] = pathlib.Path(changed.name)
    sys.argv = ["auditwheel", "repair", "--wheel-dir", out, wheel]
    try:
        return auditwheel.main.main()
    finally:
        os.unlink(changed.name)


if __name__ == "__main__":
    sys.exit(_bundle(*sys.argv[1:3]))
