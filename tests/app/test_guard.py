"""Nobody but a browser with the token is answered, and no page of a stranger in that browser."""

from __future__ import annotations

import http.client
import json
from pathlib import Path
from typing import Any

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.ioloop import IOLoop
from tornado.websocket import websocket_connect

from trbdyn.app.jobs import Bench

SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"


def ask(server: Any, path: str, method: str = "GET", **headers: str) -> tuple[int, dict[str, str], str]:
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.putrequest(method, path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    answer = connection.getresponse()
    body = answer.read().decode("utf-8", "replace")
    connection.close()
    return answer.status, {key.lower(): value for key, value in answer.getheaders()}, body


def shaken(server: Any, **headers: str) -> int:
    """Status of the answer to a WebSocket: 101 where it was opened."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}

    async def connect() -> int:
        request = HTTPRequest(f"ws://127.0.0.1:{server.port}{SOCKET}", headers=named)
        try:
            socket = await websocket_connect(request)
        except HTTPClientError as error:
            return int(error.code)
        await socket.read_message()
        socket.close()
        return 101

    loop = IOLoop(make_current=False)
    try:
        return int(loop.run_sync(connect, timeout=20))
    finally:
        loop.close()


def test_only_the_page_itself_is_answered(shared: Any) -> None:
    own, cookie = f"http://127.0.0.1:{shared.port}", f"trbdyn_{shared.port}={shared.token}"
    paths = (
        "/",
        SOCKET.replace("websocket", "polling"),
        "/files/0001-x/report.html",
        "/_nicegui/none",
        "/?token=wrong",
    )
    for path in paths:
        assert ask(shared, path)[0] == 403
        assert ask(shared, path, Cookie=f"trbdyn_{shared.port}=wrong")[0] == 403
        assert ask(shared, path, Cookie=cookie, Host="evil.example")[0] == 403  # a name that leads here
        assert ask(shared, path, Cookie=cookie, Host=f"evil.example:{shared.port}")[0] == 403
        assert ask(shared, path, "POST", Cookie=cookie, Origin="http://evil.example")[0] == 403
        assert ask(shared, path, Cookie=cookie, Origin="null")[0] == 403  # a report or a view, which is in a sandbox
        assert ask(shared, path, Cookie=cookie, Origin=f"http://127.0.0.1:{shared.port + 1}")[0] == 403
        for site in ("cross-site", "same-site"):
            assert ask(shared, path, Cookie=cookie, Sec_Fetch_Site=site)[0] == 403
    status, headers, body = ask(shared, f"/?token={shared.token}")
    assert status == 200
    assert "HttpOnly" in headers["set-cookie"]
    assert "SameSite=Strict" in headers["set-cookie"]
    assert "nicegui" not in body.lower()  # not yet the page: the browser comes again with its cookie
    status, headers, body = ask(shared, "/", Cookie=cookie)
    assert status == 200
    assert headers["x-frame-options"] == "SAMEORIGIN"
    assert shared.token not in body
    assert shaken(shared, Cookie=cookie, Origin=own) == 101
    assert shaken(shared, Cookie=cookie, Origin="http://evil.example") == 403
    assert shaken(shared, Cookie=cookie) == 403
    assert shaken(shared, Origin=own) == 403


def test_it_listens_on_this_machine_alone(shared: Any) -> None:
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    listening = [row[1] for row in rows if row[3] == "0A" and row[1].endswith(f":{shared.port:04X}")]
    assert listening == [f"0100007F:{shared.port:04X}"]
    rows = [line.split() for line in Path("/proc/net/tcp6").read_text().splitlines()[1:]]
    assert not [row for row in rows if row[3] == "0A" and row[1].endswith(f":{shared.port:04X}")]


def test_files_come_from_the_runs_alone_and_reach_nothing(shared: Any) -> None:
    cookie = f"trbdyn_{shared.port}={shared.token}"
    folder = shared.folder / "runs" / "0001-x"
    folder.mkdir()
    (folder / "report.html").write_text("<script>fetch('/')</script>")
    (shared.folder / "secret.txt").write_text("secret")
    (folder / "link").symlink_to(shared.folder / "secret.txt")
    status, headers, _ = ask(shared, "/files/0001-x/report.html", Cookie=cookie)
    assert status == 200
    assert headers["content-security-policy"].startswith("sandbox allow-scripts; default-src 'none'")
    for path in ("../secret.txt", "0001-x/../../secret.txt", "..%2fsecret.txt", "0001-x/..%2f..%2fsecret.txt",
                 "0001-x/link", "0001-x//etc/passwd", "0001-x/%2fetc%2fpasswd", "../runs", "0001-x/"):  # fmt: skip
        status, _, body = ask(shared, f"/files/{path}", Cookie=cookie)
        assert status in (404, 405), path
        assert "secret" not in body


@pytest.mark.parametrize("title", ["../../x", "<script>alert(1)</script>", "a\0b", "", "é" * 400])
def test_no_title_leads_out_of_the_folder(tmp_path: Path, title: str) -> None:
    bench = Bench.open(tmp_path)
    made = bench._new_folder(title)
    assert made.parent == tmp_path / "runs"
    (made / "about.json").write_text(json.dumps({"title": title, "kind": "run"}))
    assert [one.title for one in bench.kept()] == [title]
