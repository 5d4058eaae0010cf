"""Tests who may see and steer the world of `vv serve`, and what visitors cannot do to it: hostile
messages, too many pages, pages of other sites, wrong tokens."""
import re
import socket
import time

import pytest

from page_client import PATIENCE, Refused, serve, wait_for  # noqa: F401
from window_driver import SENSORS

SIZE = (160, 120)

HOSTILE = [
    "{", "[]", "7", '{"type":"quit"}', '{"type":"size","width":0,"height":1}',
    '{"type":"leave","x":1}', '{"type":"leave","type":"leave"}', '{"type":"move","x":1e999,"y":0}',
    '{"type":"size","width":{"a":1},"height":1}', b"\xff\xfe", '{"type":"leave"}\0{', "[" * 4000,
    "x" * 5000
]


def test_hostile_messages_end_the_connection_with_a_reason(serve):
    server = serve(SENSORS, "--spp", 1)
    good = server.join(*SIZE)
    good.still()
    for text in HOSTILE:
        page = server.join(None)
        page.send_text(text)
        code, reason = page.until_closed()
        assert code == (1009 if len(text) > 4096 else 1008) and reason, text
        page.close()
    page = server.join(None)
    page.send_frame(2, b"binary")
    assert page.until_closed()[0] == 1003
    page.close()
    page = server.join(None)
    try:
        for _ in range(3000):
            page.send(type="leave")
    except OSError:
        pass
    # The reason is lost where the rest of the flood makes the system reset the connection.
    assert page.until_closed() in ((1008, "maxMessagesPerSecond"), (0, ""))
    page.close()
    page = server.join(None)
    page.socket.sendall(b"\xff" * 64)  # no frame at all
    page.until_closed()
    good.drag(0, -0.9, 0.3, -0.9)
    wait_for(lambda: good.camera()[0][0] < -1, "the others go on")
    assert server.stop() == 0


def test_the_number_of_pages_is_limited(serve):
    server = serve(SENSORS, "--spp", 1)
    pages = [server.join(32, 24) for _ in range(16)]
    for page in pages:
        page.still()
    code, reason = server.join(None).until_closed()
    assert code == 1013 and "maxViewers" in reason
    pages[3].close()
    wait_for(lambda: pages[0].state["pages"] == 15, "a place")
    server.join(32, 24).still()


def test_no_request_holds_a_connection(serve):
    """libwebsockets would keep connections that ask with CONNECT for ever, whoever asks."""
    server = serve("box.wrl")
    held = []
    for _ in range(100):
        one = socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE)
        one.sendall(b"CONNECT host:1 HTTP/1.1\r\nHost: localhost\r\n\r\n")
        held.append(one)
    for one in held:
        try:
            assert one.recv(100) == b""
        except ConnectionResetError:
            pass
    assert server.get("/").status == 200


@pytest.mark.timed
def test_silent_connections_keep_nobody_out(serve):
    server = serve(SENSORS, "--spp", 1)
    page = server.join(*SIZE)
    page.still()
    silent = [
        socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE) for _ in range(200)
    ]
    for i, one in enumerate(silent):
        try:
            one.sendall(b"GET / HTTP/1.1\r\n" if i % 2 else b"")  # half a request is none
        except OSError:
            pass  # it has been closed
    begin = time.monotonic()
    assert server.get("/").status == 200
    other = server.join(*SIZE)
    other.still()
    assert time.monotonic() - begin < 5  # libwebsockets would let them wait for 20 s
    count = len(page.pictures)  # a page that is there is not touched
    page.drag(0, -0.9, 0.3, -0.9)
    page.until(lambda p: len(page.pictures) > count)
    for one in silent:
        one.close()


def test_foreign_pages_cannot_steer(serve):
    server = serve("box.wrl")
    for headers in ({
            "Origin": "http://evil.example"
    }, {
            "Origin": "null"
    }, {
            "Origin": f"http://localhost:{server.port}"
    }, {
            "Origin": None
    }, {
            "Origin": ""
    }, {
            "Host": f"evil.example:{server.port}",
            "Origin": f"http://evil.example:{server.port}"
    }):
        with pytest.raises(Refused) as caught:
            server.join(headers=headers)
        assert caught.value.status == 403, headers
    assert server.get("/", {"Host": "evil.example"}).status == 403
    with pytest.raises(Refused) as caught:
        server.join(path="/other")
    assert caught.value.status == 404
    server.join(headers={"Upgrade": "WebSocket"}).still()  # letters may be large (RFC 6455)


def test_a_token_opens_the_page_once_and_the_cookie_after_that(serve):
    server = serve("box.wrl", "--token", "new")
    assert re.fullmatch("[0-9a-f]{32}", server.token)
    for path in ("/", "/page.js", "/?token=0123456789abcdef0123456789abcdef", "/?token="):
        answer = server.get(path)
        assert answer.status == 403 and b"page.js" not in answer.body
    first = server.get("/?token=" + server.token)
    assert first.status == 303 and first.headers["Location"] == "./"
    cookie = first.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Lax" in cookie and "Secure" not in cookie
    secure = server.get("/?token=" + server.token, {"X-Forwarded-Proto": "https"})
    assert "Secure" in secure.headers["Set-Cookie"]
    cookie = cookie.split(";")[0]
    assert server.get("/", {"Cookie": "a=b; " + cookie}).status == 200
    assert server.get("/", {"Cookie": cookie + "0"}).status == 403
    for headers in ({}, {
            "Cookie": cookie[:-1]
    }, {
            "Cookie": cookie,
            "Origin": "http://evil.example"
    }):
        with pytest.raises(Refused) as caught:
            server.join(headers=headers)
        assert caught.value.status == 403
    server.join(headers={"Cookie": cookie}).still()
    server.join(path="/live?token=" + server.token).still()
    with pytest.raises(Refused):
        server.join(path="/live?token=" + server.token, headers={"Origin": None})
    # Behind a proxy the page has another name.
    server.join(headers={
        "Cookie": cookie,
        "Host": "vv.example.org",
        "Origin": "https://vv.example.org"
    }).still()


def test_tokens_of_files_and_of_the_environment(serve, vv):
    token = "a-token_of_a_file"
    (vv.folder / "token").write_text(token + "\n")
    server = serve("box.wrl", "--token", "@token")
    assert server.token == "..." and server.get("/?token=" + token).status == 303
    server = serve("box.wrl", env={"VV_TOKEN": token})
    assert server.token == "..." and server.get("/").status == 403
    assert server.get("/?token=" + token).status == 303
    assert vv("serve", "box.wrl", "--token", "@missing").returncode == 3


def test_other_addresses_need_a_token_and_then_work(serve):
    server = serve("box.wrl", "--address", "0.0.0.0", "--token", "new")
    assert server.get("/").status == 403
    assert server.get("/?token=" + server.token).status == 303


def test_both_loopback_addresses(serve):
    server = serve("box.wrl")
    try:
        answer = server.get("/", host="::1")
    except OSError:
        pytest.skip("this machine has no IPv6")
    assert answer.status == 200
