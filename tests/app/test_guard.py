"""Nobody but a browser with the token is answered, and no page of a stranger in that browser."""

from __future__ import annotations

import http.client
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.ioloop import IOLoop
from tornado.websocket import websocket_connect

from trbdyn.extras.app.jobs import Bench

SOCKET = "/_nicegui_ws/socket.io/?EIO=4&transport=websocket"


@pytest.fixture(scope="session")
def entered(shared: Any) -> tuple[str, str]:
    """The path of the page and the cookie, of a browser that has come in."""
    status, headers, body = ask(shared, shared.address_for("guard").removeprefix(shared.base))
    shared.opened[id("guard")] = "guard"
    assert status == 200
    assert "HttpOnly" in headers["set-cookie"]
    assert "SameSite=Strict" in headers["set-cookie"]
    assert "nicegui" not in body.lower()  # not yet the page: the browser comes again with its cookie
    path = body.partition("url=")[2].partition("/'")[0]
    cookie, _, rest = headers["set-cookie"].partition(";")
    assert f"Path={path}/;" in rest  # no other port of this machine gets it
    assert len(path) > 20
    return path, cookie


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


def shaken(server: Any, base: str, **headers: str) -> int:
    """Status of the answer to a WebSocket: 101 where it was opened."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}

    async def connect() -> int:
        request = HTTPRequest(f"ws://127.0.0.1:{server.port}{base}{SOCKET}", headers=named)
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


def test_only_the_page_itself_is_answered(shared: Any, entered: tuple[str, str]) -> None:
    base, cookie = entered
    own, name = f"http://127.0.0.1:{shared.port}", cookie.partition("=")[0]
    polling = SOCKET.replace("websocket", "polling")
    for path in (f"{base}/", f"{base}{polling}", f"{base}/files/0001-x/report.html", f"{base}/_nicegui/none"):
        assert ask(shared, path)[0] == 403
        assert ask(shared, path, Cookie=f"{name}=wrong")[0] == 403
        assert ask(shared, path.removeprefix(base), Cookie=cookie)[0] == 403  # beside the path of the page
        assert ask(shared, path, Cookie=cookie, Host="evil.example")[0] == 403  # a name that leads here
        assert ask(shared, path, Cookie=cookie, Host=f"evil.example:{shared.port}")[0] == 403
        assert ask(shared, path, "POST", Cookie=cookie, Origin="http://evil.example")[0] == 403
        assert ask(shared, path, Cookie=cookie, Origin="null")[0] == 403  # a report or a view, which is in a sandbox
        assert ask(shared, path, Cookie=cookie, Origin=f"http://127.0.0.1:{shared.port + 1}")[0] == 403
        for site in ("cross-site", "same-site"):
            assert ask(shared, path, Cookie=cookie, Sec_Fetch_Site=site)[0] == 403
    assert ask(shared, "/?token=wrong")[0] == 403
    for used in shared.addresses[: len(shared.opened)]:
        assert ask(shared, used.removeprefix(shared.base))[0] == 403  # a token opens the page once
    status, headers, body = ask(shared, f"{base}/", Cookie=cookie)
    assert status == 200
    assert headers["x-frame-options"] == "SAMEORIGIN"
    assert cookie.partition("=")[2] not in body
    assert not any(one.partition("token=")[2] in body for one in shared.addresses)
    assert shaken(shared, base, Cookie=cookie, Origin=own) == 101
    assert shaken(shared, base, Cookie=cookie, Origin="http://evil.example") == 403
    assert shaken(shared, base, Cookie=cookie) == 403
    assert shaken(shared, base, Origin=own) == 403


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root becomes another user")
def test_another_user_finds_nothing_that_opens_the_page(tmp_path: Path) -> None:
    """As `nobody`: command lines in /proc, and the files that are there."""
    seen = tmp_path / "seen"
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$@" > {seen}\nsleep 5\n')
    browser.chmod(0o755)
    os.chmod(tmp_path, 0o755)
    folder = tmp_path / "app"
    command = [sys.executable, "-m", "trbdyn", "app", "--folder", str(folder)]
    how = os.environ | {"BROWSER": f"{browser} %s"}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=how)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split()[-1]
        token = address.partition("token=")[2]
        deadline = time.monotonic() + 20.0
        while not seen.exists() or not seen.read_text():
            assert time.monotonic() < deadline
            time.sleep(0.05)
        assert seen.read_text().strip() == (folder / "open.html").as_uri()  # what the browser is told
        assert token in (folder / "open.html").read_text()
        look = (
            "import os, glob, sys\n"
            "os.setgroups([]); os.setgid(65534); os.setuid(65534)\n"
            "found = b''\n"
            "for path in [*glob.glob('/proc/[0-9]*/cmdline'), *glob.glob('/proc/[0-9]*/environ'),\n"
            f"             *glob.glob({str(folder)!r} + '/**', recursive=True)]:\n"
            "    try:\n"
            "        found += open(path, 'rb').read()\n"
            "    except OSError:\n"
            "        pass\n"
            "assert b'open.html' in found\n"
            "print(sys.stdin.read().strip().encode() in found)\n"
        )
        done = subprocess.run([sys.executable, "-c", look], input=token, capture_output=True, text=True, check=True)
        assert done.stdout.strip() == "False"
        assert os.stat(folder / "open.html").st_mode & 0o077 == 0
        server = type("Server", (), {"port": int(address.rsplit(":", 1)[1].partition("/")[0])})
        assert ask(server, f"/?token={token}")[0] == 200
        assert ask(server, f"/?token={token}")[0] == 403
        assert not (folder / "open.html").exists()
    finally:
        process.terminate()
        said = process.communicate(timeout=40)[1]
    assert "Traceback" not in said


def test_it_listens_on_this_machine_alone(shared: Any) -> None:
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    listening = [row[1] for row in rows if row[3] == "0A" and row[1].endswith(f":{shared.port:04X}")]
    assert listening == [f"0100007F:{shared.port:04X}"]
    rows = [line.split() for line in Path("/proc/net/tcp6").read_text().splitlines()[1:]]
    assert not [row for row in rows if row[3] == "0A" and row[1].endswith(f":{shared.port:04X}")]


def test_files_come_from_the_runs_alone_and_reach_nothing(shared: Any, entered: tuple[str, str]) -> None:
    base, cookie = entered
    folder = shared.folder / "runs" / "0001-x"
    folder.mkdir()
    (folder / "report.html").write_text("<script>fetch('/')</script>")
    (shared.folder / "secret.txt").write_text("secret")
    (folder / "link").symlink_to(shared.folder / "secret.txt")
    status, headers, _ = ask(shared, f"{base}/files/0001-x/report.html", Cookie=cookie)
    assert status == 200
    assert headers["content-security-policy"].startswith("sandbox allow-scripts; default-src 'none'")
    for path in ("../secret.txt", "0001-x/../../secret.txt", "..%2fsecret.txt", "0001-x/..%2f..%2fsecret.txt",
                 "0001-x/link", "0001-x//etc/passwd", "0001-x/%2fetc%2fpasswd", "../runs", "0001-x/",
                 "0001-x/%00", "%00/x", "0001-x/" + "a" * 5000, "a" * 300 + "/x"):  # fmt: skip
        status, _, body = ask(shared, f"{base}/files/{path}", Cookie=cookie)
        assert status in (404, 405), path
        assert "secret" not in body


@pytest.mark.parametrize("title", ["../../x", "<script>alert(1)</script>", "a\0b", "", "é" * 400])
def test_no_title_leads_out_of_the_folder(tmp_path: Path, title: str) -> None:
    bench = Bench.open(tmp_path)
    made = bench._new_folder(title)
    assert made.parent == tmp_path / "runs"
    (made / "about.json").write_text(json.dumps({"title": title, "kind": "run"}))
    assert [one.title for one in bench.kept()] == [title]
