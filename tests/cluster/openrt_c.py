"""Wraps the part of the C API that the cluster's tests need with ctypes. Also a scene that any of
them can render: a box of diffuse walls with a lamp and balls of glass and metal, thirty of them
moving. Calls release the GIL, so other threads continue."""
import array
import contextlib
import ctypes
import math
import os
import pathlib
import re
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RGBA, DEPTH, NORMAL, ALBEDO, POSITION, NAME, SAMPLES, VARIANCE, ERROR, TRUST = (
    1 << i for i in range(10))
COMPONENTS = {
    RGBA: 4,
    DEPTH: 1,
    NORMAL: 3,
    ALBEDO: 3,
    POSITION: 3,
    NAME: 1,
    SAMPLES: 1,
    VARIANCE: 3,
    ERROR: 3,
    TRUST: 1
}
SPP, MAX_DEPTH, SEED, TRANSPORT, PROGRESSIVE = 1, 2, 3, 5, 11
QUADS = 7


def build():
    """Returns the folder with bin/ and lib/."""
    if "OPENRT_BUILD" in os.environ:
        return pathlib.Path(os.environ["OPENRT_BUILD"])
    for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep):
        if folder and (pathlib.Path(folder).resolve().parent / "lib/libopenrt.so").exists():
            return pathlib.Path(folder).resolve().parent
    return ROOT / "build/release"


def structure(name, **groups):
    """Reads a structure from the headers of the C API. groups: structures that it consists of, by
    name."""
    kinds = {
        **groups,
        "size_t": ctypes.c_size_t,
        "uint64_t": ctypes.c_uint64,
        "uint32_t": ctypes.c_uint32,
        "RTenum": ctypes.c_uint32,
        "int": ctypes.c_int,
        "double": ctypes.c_double,
        "char": ctypes.c_char
    }
    text = re.sub(r"/\*.*?\*/",
                  "",
                  "".join(h.read_text() for h in (ROOT / "libopenrt/include/openrt").glob("*.h")),
                  flags=re.S)
    body = re.search(r"typedef struct %s \{(.*?)\}" % name, text, re.S)[1]
    fields = []
    for declaration in filter(str.strip, body.split(";")):
        kind, names = declaration.split(None, 1)
        for field in names.split(","):
            field, _, count = field.strip().rstrip("]").partition("[")
            fields.append((field, kinds[kind] * int(count) if count else kinds[kind]))
    return type(name, (ctypes.Structure,), {"_fields_": fields})


Stats = structure(
    "RTstats", **{
        name: structure(name)
        for name in ("RTsceneStats", "RTrejectedStats", "RTtimeStats", "RTrayStats", "RTbvhStats",
                     "RTmachineStats", "RTtransportStats", "RTerrorStats", "RTleftOutStats",
                     "RTclusterStats")
    })
Worker = structure("RTworker")


def values(record):
    """Returns the members of a structure by name, those of a group as a dict of their own."""
    members = {name: getattr(record, name) for name, _ in record._fields_}
    return {n: values(v) if isinstance(v, ctypes.Structure) else v for n, v in members.items()}


class RtError(RuntimeError):
    pass


class Context:
    """A context. All methods except cancel() are called on the thread that made it."""

    def __init__(self, config):
        self.rt = ctypes.CDLL(str(build() / "lib/libopenrt.so"))
        self.rt.rtNewContext.restype = ctypes.c_void_p
        self.rt.rtNewContext.argtypes = [ctypes.c_char_p]
        self.rt.rtDeleteContext.argtypes = self.rt.rtMakeCurrent.argtypes = self.rt.rtCancel.argtypes = [
            ctypes.c_void_p
        ]
        self.rt.rtGetErrorMessage.restype = ctypes.c_char_p
        self.rt.rtNewShaderClass.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
        self.rt.rtParameterHandle.argtypes = [ctypes.c_char_p]
        self.rt.rtReadPixels.argtypes = [ctypes.c_uint32, ctypes.c_void_p, ctypes.c_size_t]
        self.rt.rtInstanceMatrix.argtypes = [ctypes.c_uint32, ctypes.POINTER(ctypes.c_double)]
        self.rt.rtGetWorkers.restype = ctypes.c_size_t
        self.rt.rtGetWorkers.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t]
        self.messages = []
        log = ctypes.CFUNCTYPE(None, ctypes.c_int, ctypes.c_char_p, ctypes.c_void_p)
        self._log = log(lambda level, text, _: self.messages.append(
            (level, text.decode(errors="replace"))))
        self.handle = self.rt.rtNewContext(config.encode())
        if not self.handle:
            self.check()
            raise RtError("rtNewContext returned NULL and no error")
        self.rt.rtLogCallback(self._log, None)
        self.channels = RGBA
        self.size = (0, 0)

    def check(self):
        if self.rt.rtGetError():
            raise RtError(self.rt.rtGetErrorMessage().decode(errors="replace"))

    def __call__(self, name, *arguments):
        result = getattr(
            self.rt,
            "rt" + name)(*(ctypes.c_float(a) if isinstance(a, float) else a for a in arguments))
        self.check()
        return result

    def close(self):
        if self.handle:
            self.rt.rtDeleteContext(self.handle)
            self.handle = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def cancel(self):
        self.rt.rtCancel(self.handle)

    def stats(self):
        out = Stats(size=ctypes.sizeof(Stats))
        self("GetStats", ctypes.byref(out))
        return values(out)

    def workers(self):
        """Returns the records of rtGetWorkers."""
        out = (Worker * 64)()
        out[0].size = ctypes.sizeof(Worker)
        count = self("GetWorkers", self.handle, out, len(out))
        return [values(w) for w in out[:count]]

    def wait_for(self, count, seconds=20):
        """Returns whether this many workers joined before the time was up."""
        end = time.monotonic() + seconds
        while sum(w["alive"] for w in self.workers() if w["name"] != b"here") < count:
            if time.monotonic() > end:
                return False
            time.sleep(0.02)
        return True

    # The scene -----------------------------------------------------------------------------------

    def shader(self, kind, **parameters):
        shader = self("NewShader", self("NewShaderClass", kind.encode(), None))
        self("BindShader", shader)
        for name, value in parameters.items():
            handle = self("ParameterHandle", name.encode())
            value = value if isinstance(value, tuple) else (value,)
            self(f"Parameter{len(value)}f", handle, *map(float, value))
        return shader

    def quad(self, *corners):
        self("Begin", QUADS)
        for x, y, z in corners:
            self("Vertex3f", float(x), float(y), float(z))
        self("End")

    def scene(self, balls=30):
        """Draws walls, a lamp and balls. self.moving: the instances for move()."""
        room = self("BeginObject", 0)
        for color, corners in (((.7, .7, .7), ((-2, -1, 2), (2, -1, 2), (2, -1, -2), (-2, -1, -2))),
                               ((.7, .2, .2), ((-2, -1, 2), (-2, -1, -2), (-2, 2, -2), (-2, 2, 2))),
                               ((.2, .3, .7), ((-2, -1, -2), (2, -1, -2), (2, 2, -2), (-2, 2,
                                                                                       -2)))):
            self.shader("Diffuse", reflectance=color)
            self.quad(*corners)
        self.shader("Diffuse", reflectance=(0, 0, 0), emission=(12, 11, 9))
        self.quad((-.5, 1.9, -.5), (.5, 1.9, -.5), (.5, 1.9, .5), (-.5, 1.9, .5))
        self("EndObject")
        self("InstantiateObject", room)
        kinds = []
        for shader in (lambda: self.shader("Glass"), lambda: self.shader("Metal"),
                       lambda: self.shader("Diffuse", reflectance=(.3, .7, .4))):
            ball = self("BeginObject", 0)
            shader()
            self("Sphere", .18)
            self("EndObject")
            kinds.append(ball)
        self.moving = [self("InstantiateObject", kinds[i % 3]) for i in range(balls)]
        self.move(0)
        self.camera(0)

    def move(self, time):
        for i, instance in enumerate(self.moving):
            a = 2.4 * i + time
            at = (math.cos(a) * (.4 + .04 * i), -.8 + .07 * (i % 9) + .1 * math.sin(3 * time + i),
                  math.sin(a) * (.4 + .04 * i))
            self("InstanceMatrix", instance, (ctypes.c_double * 16)(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                                                    0, *at, 1))

    def camera(self, turn):
        self.rt.rtLoadIdentity()
        self.rt.rtLookAt(
            *map(ctypes.c_double, (4 * math.sin(turn), .6, 4 * math.cos(turn), 0, 0, 0, 0, 1, 0)))
        self.rt.rtPerspective(ctypes.c_double(45))
        self.rt.rtLoadIdentity()
        self.check()

    # Frames --------------------------------------------------------------------------------------

    def frame(self,
              width,
              height,
              spp,
              channels=RGBA | DEPTH | NORMAL | VARIANCE | ERROR,
              depth=8,
              progressive=False):
        self.size, self.channels = (width, height), channels
        self("FrameBuffer", width, height, channels)
        for name, value in ((SPP, spp), (MAX_DEPTH, depth), (PROGRESSIVE, int(progressive))):
            self("Quality", name, value)

    def read(self):
        """Returns the bytes of all channels."""
        out = b""
        for channel, components in COMPONENTS.items():
            if self.channels & channel:
                pixels = array.array("f", bytes(4 * components * self.size[0] * self.size[1]))
                address, count = pixels.buffer_info()
                self("ReadPixels", channel, address, count)
                out += pixels.tobytes()
        return out

    def render(self):
        self("Render")
        return self.read()


@contextlib.contextmanager
def context(config, **frame):
    with Context(config) as c:
        c.scene()
        c.frame(**frame)
        yield c


def reference(**frame):
    """Returns the picture of a single thread of this machine."""
    with context("threads=1", **frame) as c:
        return c.render()
