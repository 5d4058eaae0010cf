"""Tests that pages of `vv serve --edit` show what the world has, not what it has refused."""
from page_client import serve, wait_for  # noqa: F401
from test_vv_serve_edit import WORLD, field, newest, paint


def test_the_sheet_comes_again_when_a_value_is_refused(serve):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still()
    number = paint(page)
    before = len(page.of("sheet"))
    page.edit("drag", node=number, field="shininess", value=7)
    wait_for(lambda: len(page.of("sheet")) > before, lambda: page.of("said"))
    assert field(newest(page, "sheet"), "shininess")["value"] == 0.2
    assert page.of("said")[-1]["error"]
