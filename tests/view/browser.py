"""A headless Chromium, driven over its DevTools port: pages are opened, clicked and looked at as a person would."""

from __future__ import annotations

import asyncio
import base64
import io
import itertools
import json
import os
import shutil
import subprocess
import time
import urllib.request
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
from numpy.typing import NDArray

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome", "chromium-headless-shell")


def executable() -> str | None:
    """The Chromium of this machine; the variable TRB_CHROMIUM names another one."""
    named = os.environ.get("TRB_CHROMIUM")
    return named or next((path for name in NAMES if (path := shutil.which(name))), None)


class Browser:
    """A browser with one page."""

    def __init__(self, folder: Path, size: tuple[int, int] = (1200, 760)) -> None:
        program = executable()
        assert program is not None
        self.size = size
        self._log = (folder / "chromium.log").open("w")
        self._process = subprocess.Popen(
            [
                program,
                "--headless=new",
                "--no-sandbox",
                "--use-gl=angle",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
                "--hide-scrollbars",
                "--disable-dev-shm-usage",
                "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                "--remote-debugging-port=0",
                f"--user-data-dir={folder / 'profile'}",
                f"--window-size={size[0]},{size[1]}",
                "about:blank",
            ],
            stdout=self._log,
            stderr=self._log,
        )
        self._loop = asyncio.new_event_loop()
        self._numbers = itertools.count(1)
        port_file = folder / "profile" / "DevToolsActivePort"
        deadline = time.monotonic() + 60.0
        while not (port_file.exists() and port_file.read_text().count("\n") >= 1):
            if time.monotonic() > deadline or self._process.poll() is not None:
                raise RuntimeError(f"Chromium did not start: {(folder / 'chromium.log').read_text()[-2000:]}")
            time.sleep(0.05)
        port = int(port_file.read_text().splitlines()[0])
        pages = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list"))
        address = next(page["webSocketDebuggerUrl"] for page in pages if page["type"] == "page")
        self._socket = self._loop.run_until_complete(self._connect(address))
        self.errors: list[str] = []
        self.requests: list[str] = []
        for domain in ("Runtime", "Page", "Network"):
            self.call(f"{domain}.enable")
        width, height = size
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    @staticmethod
    async def _connect(address: str) -> Any:
        from tornado.websocket import websocket_connect

        return await websocket_connect(address, max_message_size=1 << 28)

    def close(self) -> None:
        self._socket.close()
        self._process.terminate()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._loop.close()
        self._log.close()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        number = next(self._numbers)
        self._loop.run_until_complete(self._send(json.dumps({"id": number, "method": method, "params": parameters})))
        while True:
            text = self._loop.run_until_complete(asyncio.wait_for(self._next(), 120.0))
            answer = json.loads(text)
            self._note(answer)
            if answer.get("id") == number:
                assert "error" not in answer, answer["error"]
                return answer["result"]

    async def _send(self, text: str) -> None:
        await self._socket.write_message(text)

    async def _next(self) -> str:
        text = await self._socket.read_message()
        assert text is not None, "Chromium ended"
        return str(text)

    def _note(self, answer: dict[str, Any]) -> None:
        if answer.get("method") == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(answer["params"]["exceptionDetails"])[:800])
        if answer.get("method") == "Network.requestWillBeSent":
            self.requests.append(answer["params"]["request"]["url"])

    def js(self, text: str) -> Any:
        """The value of a JavaScript expression; promises are awaited."""
        out = self.call("Runtime.evaluate", expression=text, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in out, out["exceptionDetails"]
        return out["result"].get("value")

    def open(self, path: Path, ready: str = "document.readyState == 'complete'", place: str = "") -> None:
        self.go(path.resolve().as_uri() + place, ready)

    def go(self, address: str, ready: str = "document.readyState == 'complete'") -> None:
        self.errors.clear()
        self.requests.clear()
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=address)
        self.wait(ready)

    def wait(self, condition: str, seconds: float = 60.0) -> None:
        deadline = time.monotonic() + seconds
        while not self._holds(condition):
            assert time.monotonic() < deadline, f"never came true: {condition}; errors: {self.errors}"
            time.sleep(0.05)

    def _holds(self, condition: str) -> bool:
        """Whether a condition is true; not while one page goes on to another."""
        try:
            return bool(self.js(f"Boolean({condition})"))
        except AssertionError as error:
            if "navigated" not in str(error):
                raise
            return False

    def frame(self) -> None:
        """Wait until the page has drawn twice."""
        self.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")

    def click(self, x: float, y: float) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
        self.frame()

    def picture(self, path: Path | None = None) -> NDArray[np.float64]:
        """What is drawn, shape (height, width, 3), 0 to 1."""
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        if path is not None:
            path.write_bytes(data)
        return np.asarray(matplotlib.image.imread(io.BytesIO(data)))[..., :3]
