#!/usr/bin/env python3
"""Makes the pictures of the tutorial in docs/editor.md, by the keys and clicks of the tutorial.

    tools/editor_pictures.py [FOLDER]

writes editor-select.jpg and editor-change.jpg into docs/images, or into FOLDER, in about a minute. The
world is the block of the page that is called desk.wrl. Needs pytest, Pillow, Xvfb and xdotool; $OPENRT_VV
names another vv.
"""
import pathlib
import re
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/python"))
import window_driver  # noqa: E402
import xserver  # noqa: E402

WIDTH, HEIGHT = 960, 600
LAMP_ROW = 153  # where the outline has the lamp, in pixels from the top


class Session:
    """A window with the editor, and the picture that the X server shows."""

    def __init__(self, folder, display, screen):
        self.screen = screen
        self.window = window_driver.Window(
            folder, display, ["edit", "desk.wrl", "--size", f"{WIDTH}x{HEIGHT}", "--spp", 256])
        self.window.ready()

    def click(self, x, y, button=1):
        self.window.tool("mousemove", "--window", self.window.id, x, y)
        self.window.tool("click", button)

    def keep(self, path, seconds):
        """Writes the picture as it is after so many seconds."""
        time.sleep(seconds)
        rows = window_driver.framebuffer(self.screen)
        picture = window_driver.Image.new("RGB", (len(rows[0]), len(rows)))
        picture.putdata([pixel for row in rows for pixel in row])
        text = self.window.tool("getwindowgeometry", "--shell", self.window.id)
        left, top = (int(re.search(rf"{name}=(\d+)", text)[1]) for name in "XY")
        picture.crop((left, top, left + WIDTH, top + HEIGHT)).save(path, quality=85)


def main():
    images = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "docs/images")
    page = (ROOT / "docs/editor.md").read_text()
    world = re.search(r"```vrml file=desk\.wrl\n(.*?)```", page, re.S)[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "desk.wrl").write_text(world)
        with xserver.display(f"{WIDTH + 64}x{HEIGHT + 64}", "-noreset", "-fbdir", name) as display:
            session = Session(folder, display, folder / "Xvfb_screen0")
            window = session.window
            session.click(480, 310)  # the top of the desk
            session.keep(images / "editor-select.jpg", 12)
            window.tool("mousemove", "--window", window.id, 470, 312)
            window.key("u")
            time.sleep(12)
            window.key("b")
            time.sleep(8)
            session.click(100, LAMP_ROW)
            window.key("g", "y", "minus", "period", "3", "Return")
            session.keep(images / "editor-change.jpg", 25)
            window.program.kill()
            window.program.wait()


if __name__ == "__main__":
    main()
