#!/usr/bin/env python3
"""Measures how fast the editor on a page of `vv serve --edit` answers in worlds of many nodes.

    tools/edit_latency.py [NODES ...] [--times 20]

prints for each number of nodes (1,000, 100,000 and 1,000,000 if none is given) the seconds until vv shows
the world, from then until the editor shows its first rows, and until a search has found a name (a DEF name
of one node, and the type of half of them), with the seconds of processor time of the main thread in brackets;
then the median milliseconds from a message of the page to the sheet that
shows it: a selection, a value that is dragged, and undo; beside it the processor time of vv for each
message of a drag. The last number is that from a node of the outline that is opened or closed to its
rows. Half of the nodes are roots, each with a Group. Needs pytest and Pillow.
"""
import argparse
import pathlib
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/python"))
import page_client  # noqa: E402

PATIENCE = 600


def world_of(nodes):
    parts = ["#VRML V2.0 utf8\nViewpoint { position 0 0 5 }\nShape { geometry Box { } }\n"
             "DEF LAMP PointLight { }\nDEF OTHER PointLight { }\n"]  # yapf: disable
    parts += [f"DEF T{i} Transform {{ children Group {{ }} }}\n" for i in range(nodes // 2)]
    return "".join(parts)


class Editor:
    """A page with the editor open. Waits are for its sheet, but for rows() for the outline."""

    def __init__(self, folder):
        begin = time.monotonic()
        self.server = page_client.Served(folder, ["world.wrl", "--port", 0, "--edit", "--spp", 1])
        self.server.join().still()
        shown, cpu = time.monotonic(), self.server.cpu(True)
        self.page = self.server.join_editor()
        self.load_seconds, self.open_seconds = shown - begin, time.monotonic() - shown
        self.open_cpu = self.server.cpu(True) - cpu
        self.page.still()
        rows = self.page.of("rows")[-1]["rows"]
        self.nodes = {row["label"].split()[0]: row["node"] for row in rows}

    def until(self, test, kind):
        texts = self.page.texts
        page_client.wait_for(
            lambda: next((t for t in reversed(texts) if t["type"] == kind and test(t)), None),
            lambda: self.page.of("said"), PATIENCE)

    def time(self, test, command, kind="sheet", **members):
        """Returns the seconds from a command to a message for which `test` holds."""
        del self.page.texts[:]
        begin = time.monotonic()
        self.page.edit(command, **members)
        self.until(test, kind)
        return time.monotonic() - begin

    def rows(self, name, is_open):
        def shows(text):
            return any(r["label"].startswith(name + " ") and r.get("open") == is_open for r in text["rows"])

        return self.time(shows, "open", "rows", node=self.nodes[name], open=is_open)

    def search(self, text, part):
        """Returns the seconds until the first row of what is found has this part in its label, and those of the
        processor time of the main thread."""
        cpu = self.server.cpu(True)
        found = self.time(lambda t: t["rows"] and part in t["rows"][0]["label"], "search", "rows", text=text)
        cpu = self.server.cpu(True) - cpu
        self.time(lambda t: any(r["label"].startswith("LAMP ") for r in t["rows"]), "search", "rows", text="")
        return f"{found:.2f} s ({cpu:.2f})"

    def select(self, name):
        return self.time(lambda t: t["title"].startswith(name), "select", node=self.nodes[name])

    def drag(self, value):
        return self.time(lambda t: intensity(t) == value,
                         "drag",
                         node=self.nodes["LAMP"],
                         field="intensity",
                         value=value)


def intensity(sheet):
    return next((f.get("value") for f in sheet["fields"] if f["field"] == "intensity"), None)


def measure(nodes, times):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "world.wrl").write_text(world_of(nodes))
        editor = Editor(folder)
        last = f"T{nodes // 2 - 1}"
        searches = [editor.search(last, last), editor.search("Group", "Group")]
        editor.select("LAMP")  # the first one waits until the file has been read for edits
        editor.drag(0.25)
        editor.page.edit("end_drag")
        selects = [editor.select(("OTHER", "LAMP")[i % 2]) for i in range(times // 2 * 2)]
        cpu = editor.server.cpu()
        drags = [editor.drag((i % 60 + 1) / 64) for i in range(times)]
        cpu = (editor.server.cpu() - cpu) / times
        editor.page.edit("end_drag")
        undo = editor.time(lambda t: intensity(t) == 0.25, "undo")
        rows = [editor.rows(f"T{i // 2}", i % 2 == 0) for i in range(times // 2 * 2)]
        editor.server.kill()
    text = [f"{1000 * statistics.median(one):.0f}" for one in (selects, drags, [undo], rows)]
    print(f"{nodes} nodes: load {editor.load_seconds:.2f} s, open {editor.open_seconds:.2f} s ({editor.open_cpu:.2f}), search "
          f"{searches[0]} and {searches[1]}; select {text[0]} ms, drag {text[1]} ms "
          f"({1000 * cpu:.0f} ms of processor time), undo {text[2]} ms, open or close a node {text[3]} ms", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("nodes", type=int, nargs="*", default=[1000, 100_000, 1_000_000])
    parser.add_argument("--times", type=int, default=20, help="messages of each kind")
    arguments = parser.parse_args()
    page_client.PATIENCE = PATIENCE
    for nodes in arguments.nodes:
        measure(nodes, arguments.times)


if __name__ == "__main__":
    main()
