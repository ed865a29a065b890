"""Who may talk to the page: a browser of this machine that has the token, and no page of a stranger in that browser.

The token stands in the address that opens the page, once; then it is a cookie that the browser sends for requests of this page
alone (SameSite=Strict) and shows to no script (HttpOnly). A request is answered if its host is this machine, the page that it
comes from, if it tells one, is this one, and it has the token; a WebSocket likewise. Where the browser tells whose page has asked
(Sec-Fetch-Site), this must be no other one: a program on another port of this machine is the same site for cookies.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any, Final
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]
Asgi = Callable[[Scope, Receive, Send], Awaitable[None]]

HOSTS: Final = ("127.0.0.1", "localhost")
SAFE: Final = [
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"x-frame-options", b"SAMEORIGIN"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
]
"""Headers of every answer."""
PLAIN: Final = (b"content-type", b"text/plain; charset=utf-8")
ENTER: Final = b"<!doctype html><meta http-equiv='refresh' content='0;url=/'><title>trbdyn</title>"
"""Goes on to the page without the token in its address; a redirect would lose the cookie where a link led here."""


class Guard:
    """Lets an ASGI application on a port answer only what comes from the page itself. The token is drawn where none is given."""

    def __init__(self, app: Asgi, port: int, token: str = "") -> None:
        self._app = app
        self.token = token or secrets.token_urlsafe(32)
        self._hosts = {f"{host}:{port}" for host in HOSTS}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._cookie = f"trbdyn_{port}"  # browsers share cookies between ports

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        if not self._from_here(headers, scope["type"] == "websocket"):
            await _refuse(scope, send, "this page answers only to the address that trbdyn app has printed")
        elif self._is_token(self._of_cookie(headers)) and headers.get("sec-fetch-site", "none") in (
            "none",
            "same-origin",
        ):
            await self._app(scope, receive, _with_headers(send))
        elif scope["type"] == "http" and scope["path"] == "/" and self._is_token(_of_query(scope)):
            cookie = f"{self._cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
            await _answer(send, 200, ENTER, [(b"content-type", b"text/html"), (b"set-cookie", cookie.encode())])
        else:
            await _refuse(
                scope, send, "open this page by the whole address that trbdyn app has printed, with its token"
            )

    def _from_here(self, headers: dict[str, str], is_socket: bool) -> bool:
        """Whether host and origin are those of this page: another name of this machine may be a stranger's."""
        origin = headers.get("origin")
        if headers.get("host") not in self._hosts or (is_socket and origin is None):
            return False
        return origin is None or origin in self._origins

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    def _of_cookie(self, headers: dict[str, str]) -> str:
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return ""
        return "" if found is None else found.value


def _of_query(scope: Scope) -> str:
    return (parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token") or [""])[0]


def _with_headers(send: Send) -> Send:
    async def sent(message: Any) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *SAFE]}
        await send(message)

    return sent


async def _answer(send: Send, status: int, body: bytes, headers: list[tuple[bytes, bytes]]) -> None:
    await send({"type": "http.response.start", "status": status, "headers": [*headers, *SAFE]})
    await send({"type": "http.response.body", "body": body})


async def _refuse(scope: Scope, send: Send, why: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
    else:
        await _answer(send, 403, why.encode(), [PLAIN])
