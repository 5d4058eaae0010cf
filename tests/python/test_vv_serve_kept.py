"""Tests that `vv serve --edit` keeps edits that are not saved, also while no page looks."""
from page_client import serve, wait_for  # noqa: F401
from test_vv_serve_edit import WORLD, drag, paint, text_of


def test_the_last_edit_of_a_page_that_leaves_is_kept_at_once(serve, vv):
    server = serve(WORLD, "--edit", "--spp", 1)
    page = server.join_editor()
    page.still()

    def kept(colour):
        texts = [path.read_text() for path in vv.folder.glob(".*.vv-edits")]
        return any(f"diffuseColor {colour}" in text for text in texts)

    number = paint(page)
    drag(page, number, "diffuseColor", [0, 1, 0])
    wait_for(lambda: kept("0 1 0"), "the first edit")
    page.edit("drag", node=number, field="diffuseColor", value=[0, 0, 1])
    page.close()
    wait_for(lambda: kept("0 0 1"), "the last edit")
    server.kill()
    assert kept("0 0 1") and text_of(vv) == WORLD
