"""The page in a process of its own, and a browser of a newcomer."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

VIEW = Path(__file__).parent.parent / "view" / "browser.py"


def browser_module() -> Any:
    spec = importlib.util.spec_from_file_location("trb_test_browser_of_app", VIEW)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Server:
    """`trbdyn app` with a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        command = [sys.executable, "-m", "trbdyn", "app", "--no-browser", "--folder", str(folder)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self.addresses = [self.process.stdout.readline().split()[-1]]
        self.base = self.addresses[0].partition("/?token=")[0]
        self.port = int(self.base.rsplit(":", 1)[1])
        self.opened: dict[int, str] = {}
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        """Each address opens the page once; then the next one is printed."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            if "token=" in line:
                self.addresses.append(line.split()[-1])

    def address_for(self, browser: Any) -> str:
        """Where the page is for a browser: an address with a token the first time, then that of the page."""
        if id(browser) not in self.opened:
            used = len(self.opened)
            deadline = time.monotonic() + 20.0
            while len(self.addresses) <= used:
                assert time.monotonic() < deadline
                time.sleep(0.02)
            return self.addresses[used]
        return self.opened[id(browser)]

    def end(self) -> str:
        """End it; gives what it said of errors."""
        self.process.terminate()
        assert self.process.stderr is not None
        self.process.wait(40)
        return self.process.stderr.read()


class User:
    """Somebody who clicks and types; every action is counted."""

    def __init__(self, browser: Any) -> None:
        self.browser = browser
        self.actions = 0

    def _element(self, path: str) -> str:
        found = f"document.querySelector('[data-path=\"{path}\"]')"
        self.browser.wait(f"{found} && {found}.getBoundingClientRect().height > 0")
        return found

    def click(self, path: str) -> None:
        self.actions += 1
        self._press(self._element(path))

    def _press(self, element: str) -> None:
        """Press the mouse in the middle of an element."""
        self.browser.js(f"{element}.scrollIntoView({{block: 'center'}})")
        self.browser.frame()
        box = self.browser.js(
            f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])({element}.getBoundingClientRect())"
        )
        self.browser.click(*box)

    def choose(self, path: str, words: str) -> None:
        """An entry of a list. On a busy machine the list may still move when it is pressed: then it is opened again."""
        entry = f"[...document.querySelectorAll('.q-menu .q-item')].find((one) => one.textContent.includes({words!r}))"
        chosen = (
            f"document.querySelector('[data-path=\"{path}\"]')?.closest('.q-field')?.textContent.includes({words!r})"
        )
        for _ in range(4):
            self.click(path)
            self.browser.wait(f"{entry} && {entry}.getBoundingClientRect().height > 20")
            time.sleep(0.4)  # the list opens with a movement
            self._press(entry)
            self.browser.wait("!document.querySelector('.q-menu')")
            time.sleep(0.5)  # the page answers
            if self.browser.js(f"Boolean({chosen})"):
                return

    def type(self, path: str, text: str) -> None:
        self.actions += 1
        self.browser.js(f"(() => {{ const e = {self._element(path)}; e.focus(); e.select(); }})()")
        self.browser.call("Input.insertText", text=text)
        time.sleep(0.3)  # the page waits for the end of the word

    def says(self, text: str, seconds: float = 30.0) -> None:
        self.browser.wait(f"document.body.innerText.includes({text!r})", seconds)

    def text(self, path: str) -> str:
        return str(self.browser.js(f"{self._element(path)}.textContent"))


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    running = Server(tmp_path / "app")
    yield running
    running.end()


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One for tests that may find what others have typed."""
    running = Server(tmp_path_factory.mktemp("app") / "app")
    yield running
    running.end()


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    module = browser_module()
    if module.executable() is None:
        pytest.skip("no Chromium is installed: apt-get install chromium")
    opened = module.Browser(tmp_path_factory.mktemp("browser"), (1400, 1000))
    yield opened
    opened.close()


@pytest.fixture
def other_tab(chromium: Any, tmp_path: Path) -> Iterator[User]:
    opened = type(chromium)(tmp_path)
    yield User(opened)
    opened.close()


@pytest.fixture
def user(chromium: Any) -> User:
    return User(chromium)
