"""Who may talk to the page: a browser of this machine that has the token, and no page of a stranger in that browser.

The token stands in the address that opens the page, and opens it once. What opens it from then on is a cookie with a secret of
its own, which the browser sends for requests of this page alone (SameSite=Strict) and shows to no script (HttpOnly). Browsers
send cookies to every port of a machine, so that a program of another user on another port would get it, too: the whole page lies
below a path that nobody can guess, and the cookie belongs to this path. A request is answered if its host is this machine, the
page that it comes from, if it tells one, is this one, and it has the cookie; a WebSocket likewise. Where the browser tells whose
page has asked (Sec-Fetch-Site), this must be no other one: a program on another port of this machine is the same site for
cookies.
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
ENTER: Final = "<!doctype html><meta http-equiv='refresh' content='0;url={path}/'><title>trbdyn</title>"
"""Goes on to the page without the token in its address; a redirect would lose the cookie where a link led here."""


class Guard:
    """Lets an ASGI application on a port answer only what comes from the page itself.

    `used` is called whenever the token has opened the page; `token` is a new one then.
    """

    def __init__(self, app: Asgi, port: int, used: Callable[[], None] = lambda: None) -> None:
        self._app, self._used = app, used
        self.token = secrets.token_urlsafe(32)
        self.path = f"/{secrets.token_urlsafe(16)}"
        self._secret = secrets.token_urlsafe(32)
        self._cookie = f"trbdyn_{secrets.token_hex(8)}"
        self._hosts = {f"{host}:{port}" for host in HOSTS}
        self._origins = {f"http://{host}" for host in self._hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        if not self._from_here(headers, scope["type"] == "websocket"):
            await _refuse(scope, send, "this page answers only to the address that trbdyn app has printed")
        elif (
            _is_same(self._of_cookie(headers), self._secret)
            and scope["path"].startswith(f"{self.path}/")
            and headers.get("sec-fetch-site", "none") in ("none", "same-origin")
        ):
            await self._app({**scope, "root_path": self.path}, receive, _with_headers(send))
        elif scope["type"] == "http" and scope["path"] == "/" and _is_same(_of_query(scope), self.token):
            self.token = secrets.token_urlsafe(32)
            cookie = f"{self._cookie}={self._secret}; Path={self.path}/; HttpOnly; SameSite=Strict"
            body = ENTER.format(path=self.path).encode()
            await _answer(send, 200, body, [(b"content-type", b"text/html"), (b"set-cookie", cookie.encode())])
            self._used()
        else:
            why = "open this page by the whole newest address that trbdyn app has printed; each one opens it once"
            await _refuse(scope, send, why)

    def _from_here(self, headers: dict[str, str], is_socket: bool) -> bool:
        """Whether host and origin are those of this page: another name of this machine may be a stranger's."""
        origin = headers.get("origin")
        if headers.get("host") not in self._hosts or (is_socket and origin is None):
            return False
        return origin is None or origin in self._origins

    def _of_cookie(self, headers: dict[str, str]) -> str:
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return ""
        return "" if found is None else found.value


def _is_same(given: str, secret: str) -> bool:
    return hmac.compare_digest(given.encode(), secret.encode())


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
