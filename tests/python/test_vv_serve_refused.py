"""Tests that pages of `vv serve --edit` show what the world has, not what it has refused, and edit
what they show."""
from page_client import serve, wait_for  # noqa: F401
from test_vv_serve_browser import browser, errors  # noqa: F401
from test_vv_serve_edit import WORLD, field, newest, paint, select
from test_vv_serve_edit_browser import ENTER, labels, open_editor, row, shown, until_title


def test_the_sheet_comes_again_when_a_value_is_refused(serve):
    page = serve(WORLD, "--edit", "--spp", 1).join_editor()
    page.still()
    number = paint(page)
    before = len(page.of("sheet"))
    page.edit("drag", node=number, field="shininess", value=7)
    wait_for(lambda: len(page.of("sheet")) > before, lambda: page.of("said"))
    assert field(newest(page, "sheet"), "shininess")["value"] == 0.2
    assert page.of("said")[-1]["error"]


def test_a_name_is_given_to_the_node_that_it_was_typed_for(browser, serve):
    server = serve(WORLD, "--edit", "--spp", 1)
    open_editor(browser, server)
    browser.click(row(browser, "LIGHTS") + " .label")
    until_title(browser, "LIGHTS  Group")
    browser.script("const i = document.getElementById('rename'); i.focus(); i.select();")
    browser.keys(*"HALL")
    other = server.join_editor()
    other.still()
    select(other, "THING  Shape")
    until_title(browser, "THING  Shape")
    assert shown(browser, "#rename") == "HALL"
    browser.keys(ENTER)
    browser.until(lambda: any(one == "HALL  Group" for one in labels(browser)), "the name")
    assert shown(browser, "#rename") == "THING" and errors(browser) == []
