"""Tests pictures and sounds that worlds name and another process decodes: they give the same pictures
as PNG and PFM, a process that is missing or killed costs a message, and none stays behind."""
import gc
import io
import os
import pathlib
import random
import signal
import sys
import threading
import wave

import pytest
from conftest import HEADER

xvrml = pytest.importorskip("xvrml")
Image = pytest.importorskip("PIL.Image")

SHAPE = """Transform {{ translation {x} 0 0 children Shape {{
  appearance Appearance {{ texture ImageTexture {{ url "{url}" }} }}
  geometry IndexedFaceSet {{ solid FALSE coord Coordinate {{ point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }}
    texCoord TextureCoordinate {{ point [ 0 0, 1 0, 1 1, 0 1 ] }} coordIndex [ 0 1 2 3 ] }} }} }}
"""


def world(*urls):
    shapes = (SHAPE.format(x=2.2 * i, url=url) for i, url in enumerate(urls))
    return HEADER + f"Viewpoint {{ position {1.1 * (len(urls) - 1)} 0 4 }}\n" + "".join(shapes)


def pixels(mode, width=16, height=12):
    values = random.Random(7)
    image = Image.new(mode, (width, height))
    count = len(image.getbands())
    image.putdata([
        tuple(values.randrange(256) for _ in range(count)) if count > 1 else values.randrange(256)
        for _ in range(width * height)
    ])
    return image


def encoded(image, kind):
    out = io.BytesIO()
    image.save(out, kind, **({"lossless": True, "exact": True} if kind == "WEBP" else {}))
    return out.getvalue()


def shown(vv, name, url):
    """Returns the bytes of a picture of a world with this texture."""
    vv.write(name, world(url))
    done = vv(name, "-o", "ppm:-", "--size", "48x36", "--spp", "2", "--strict")
    assert done.returncode == 0, done.talk
    return done.stdout


@pytest.mark.parametrize("mode, kinds", [("RGB", "BMP TGA WEBP"), ("RGBA", "TGA WEBP"),
                                         ("L", "BMP TGA")])
def test_formats_show_what_png_shows(vv, mode, kinds):
    image = pixels(mode)
    vv.write("a.png", encoded(image, "PNG"))
    expected = shown(vv, "png.wrl", "a.png")
    assert len(set(expected)) > 50, "the texture is seen"
    for kind in kinds.split():
        vv.write("a.picture", encoded(image, kind))  # the content tells the format, not the name
        assert shown(vv, "other.wrl", "a.picture") == expected, kind


def test_openexr_shows_what_pfm_shows(vv):
    assert vv("box.wrl", "-o", "sky.exr", "-o", "sky.pfm", "--size", "32x24", "--spp",
              "1").returncode == 0
    assert shown(vv, "exr.wrl", "sky.exr") == shown(vv, "pfm.wrl", "sky.pfm")


def test_a_bad_file_costs_itself_only(vv):
    good = encoded(pixels("RGB"), "WEBP")
    for i in range(6):
        vv.write(f"{i}.webp", good if i % 2 == 0 else good[:len(good) // 2])
    vv.write("many.wrl", world(*(f"{i}.webp" for i in range(6))))
    done = vv("many.wrl", "-o", "a.png", "--size", "64x16", "--spp", "1", "-v")
    assert done.returncode == 0, done.talk
    assert done.talk.count("WebP picture: it is damaged, or ends too early") == 3


def test_without_the_program_a_warning_says_so(vv):
    vv.write("a.bmp", encoded(pixels("RGB"), "BMP"))
    with wave.open(str(vv.folder / "a.wav"), "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(8000)
        sound.writeframes(bytes(1000))
    vv.write("a.wrl", world("a.bmp") + 'Sound { source AudioClip { url "a.wav" } }')
    done = vv("a.wrl", "--check", "--strict")
    assert done.returncode == 0, done.talk
    done = vv("a.wrl", "-o", "a.png", "--size", "16x12", "--spp", "1",
              env={"XVRML_DECODER": "/nonexistent/xvrml-decoder"})
    assert done.returncode == 0
    assert done.talk.count("no program decodes it: /nonexistent/xvrml-decoder") == 2, done.talk


def children():
    """Returns the processes of xvrml-decoder that this process has started, zombies included."""
    found = []
    for task in pathlib.Path("/proc/self/task").iterdir():
        for number in (task / "children").read_text().split():
            name = pathlib.Path(f"/proc/{number}/comm").read_text().strip()
            if name == "xvrml-decoder":
                found.append(int(number))
    return found


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_no_process_stays_behind(tmp_path):
    (tmp_path / "a.webp").write_bytes(encoded(pixels("RGB"), "WEBP"))
    (tmp_path / "a.wrl").write_text(world("a.webp"))
    assert children() == []
    loaded = xvrml.load(str(tmp_path / "a.wrl"))
    first = loaded.render(size=(32, 24), spp=1).array.tobytes()
    assert len(children()) == 1
    os.kill(children()[0], signal.SIGKILL)
    again = xvrml.load(str(tmp_path / "a.wrl"))
    assert again.render(size=(32, 24), spp=1).array.tobytes() == first
    del loaded, again
    gc.collect()
    assert children() == []


def test_worlds_on_threads(tmp_path):
    (tmp_path / "a.webp").write_bytes(encoded(pixels("RGB"), "WEBP"))
    (tmp_path / "a.wrl").write_text(world("a.webp"))
    pictures = []

    def render():
        loaded = xvrml.load(str(tmp_path / "a.wrl"))
        pictures.append(loaded.render(size=(32, 24), spp=1).array.tobytes())

    threads = [threading.Thread(target=render) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(pictures) == 4 and len(set(pictures)) == 1
