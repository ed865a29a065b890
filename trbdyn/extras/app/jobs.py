"""Tasks in processes of their own, seen from the page: progress, stop, end; and the folder that keeps what they made."""

from __future__ import annotations

import contextlib
import json
import os
import re
import time
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Final

from trbdyn.base.own_files import LONGEST_NAME, read_text, write_whole
from trbdyn.errors import FileError
from trbdyn.extras.app.design import Design
from trbdyn.extras.app.tasks import work

GRACE: Final = 20.0
"""Time that a task has to end when the page ends (s)."""
META: Final = "about.json"
DESIGN: Final = "design.json"


class Job:
    """A task under way."""

    def __init__(self, kind: str, folder: Path, arguments: dict[str, Any]) -> None:
        context = get_context("spawn")
        self._hears, says = context.Pipe(duplex=False)
        heard, self._tells = context.Pipe(duplex=False)
        self.kind, self.folder = kind, folder
        self.share: float | None = None
        self.text, self.state = "starting", "running"
        self.problems: dict[str, str] = {}
        self.answer: dict[str, Any] = {}
        self.stopping = False  # whether it was told to stop
        self._process = context.Process(target=work, args=(says, heard, kind, str(folder), arguments))
        self._process.start()
        says.close()
        heard.close()

    @property
    def running(self) -> bool:
        return self.state == "running"

    def look(self) -> bool:
        """Take in what the task has told; gives whether it has ended just now."""
        if not self.running:
            return False
        try:
            while self._hears.poll() and self._take(*self._hears.recv()):
                pass
        except (EOFError, OSError):
            self._process.join(5.0)
            self.state, self.text = "failed", f"its process ended, exit code {self._process.exitcode}"
        return not self.running

    def _take(self, word: str, *rest: Any) -> bool:
        """Take in a message; gives whether the task goes on."""
        if word == "progress":
            self.share, self.text = rest
            return True
        # a run that had reached its end was not stopped: what was told to stop was drawing, which goes on
        stopped = self.stopping and word == "done" and not rest[1].get("success")
        self.state, self.text = "stopped" if stopped else word, rest[0]
        if word == "failed":
            self.problems = rest[1]
        else:
            self.answer = rest[1]
        self._process.join(5.0)
        return False

    def stop(self) -> None:
        """Stop it as Ctrl-C does: a run keeps what it has recorded, and its pictures and report are made, however long that
        takes. Told a second time it is ended at once.
        """
        if not self.running:
            return
        if self.stopping:
            self._process.kill()
            self._process.join(5.0)
            self.state, self.text = "stopped", "ended at once: what it had not written is lost"
            return
        self.stopping = True
        with contextlib.suppress(OSError):
            self._tells.send("stop")

    def end(self) -> None:
        """End it now, as the page ends."""
        if not self.stopping:
            self.stop()
        self._process.join(GRACE if self.running else 1.0)
        if self._process.is_alive():
            self._process.kill()


@dataclass
class Kept:
    """What a task has made, in a folder of its own."""

    name: str  # name of the folder
    title: str  # what it is, for the page
    kind: str  # 'run', 'sweep' or 'compare'
    about: dict[str, Any]  # what the page shows of it


@dataclass
class Bench:
    """Everything that the page shows: the design, the task under way, what was made. All tabs of a browser show the same one."""

    root: Path  # the folder that keeps it
    design: Design = field(default_factory=Design)  # what was typed
    job: Job | None = None  # the last task
    version: int = 0  # rises whenever something has changed

    @classmethod
    def open(cls, root: Path) -> Bench:
        """The bench that a folder keeps."""
        try:
            (root / "runs").mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(f"{root}: the folder cannot be made: {error.strerror or error}") from None
        bench = cls(root, Design.first())
        with contextlib.suppress(OSError, ValueError):
            bench.design = Design.from_json(read_text(root / DESIGN))
        return bench

    def changed(self) -> int:
        """Keep the design, and tell all tabs; gives the new version."""
        write_whole(self.root / DESIGN, self.design.to_json(), overwrite=True)
        self.version += 1
        return self.version

    def start(self, kind: str, title: str, arguments: dict[str, Any], texts: dict[str, str]) -> Job | None:
        """Begin a task in a new folder, with files of texts; nothing if one is under way."""
        if self.job is not None and self.job.running:
            return None
        folder = self._new_folder(title)
        for name, text in texts.items():
            write_whole(folder / name, text, overwrite=True)
        about = {"title": title, "kind": kind, "when": time.strftime("%Y-%m-%d %H:%M"), "state": "not finished"}
        write_whole(folder / META, json.dumps(about), overwrite=True)
        self.job = Job(kind, folder, arguments)
        self.version += 1
        return self.job

    def again(self, kind: str, name: str, arguments: dict[str, Any]) -> None:
        """Begin a task in the folder of one that has ended."""
        if self.job is None or not self.job.running:
            self.job = Job(kind, self.root / "runs" / name, arguments)
            self.version += 1

    def _new_folder(self, title: str) -> Path:
        runs = self.root / "runs"
        numbers = [int(path.name[:4]) for path in runs.iterdir() if re.match(r"\d{4}", path.name)]
        words = re.sub(r"[^A-Za-z0-9]+", "-", title).strip("-")[:40] or "run"
        folder = runs / f"{max(numbers, default=0) + 1:04d}-{words}"
        folder.mkdir()
        return folder

    def look(self) -> None:
        """Take in what the task has told; keep how it ended."""
        if self.job is None or not self.job.look():
            return
        self.version += 1
        path = self.job.folder / META
        about = _table(path)
        if self.job.kind != "pdf":
            about |= {"state": self.job.state, "text": self.job.text} | self.job.answer
            write_whole(path, json.dumps(about), overwrite=True)

    def kept(self) -> list[Kept]:
        """What was made, the newest first."""
        found = []
        for folder in sorted((self.root / "runs").iterdir(), reverse=True):
            with contextlib.suppress(OSError, ValueError, KeyError):
                about = _table(folder / META)
                found.append(Kept(folder.name, str(about["title"]), str(about["kind"]), about))
        return found

    def file(self, name: str, inside: str) -> Path | None:
        """A file of a folder that was made here; None for anything else, such as a path that leads out of it."""
        if "\0" in name + inside or len(os.fsencode(name + inside)) > LONGEST_NAME:
            return None
        folder = self.root / "runs" / name
        path = (folder / inside).resolve()
        safe = path.is_relative_to(folder.resolve()) and folder.resolve().parent == (self.root / "runs").resolve()
        return path if safe and path.is_file() else None


def _table(path: Path) -> dict[str, Any]:
    """What a file of JSON says of a run; a ValueError if it is no table."""
    try:
        found = json.loads(read_text(path))
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    if not isinstance(found, dict):
        raise ValueError("it is no table of named values")
    return found
