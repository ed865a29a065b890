"""The fuzz target of files notices what it is there for."""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable
from pathlib import Path

import fuzz_files
import numpy as np
import pytest


def odd_error(path: Path) -> None:
    raise KeyError(path.name)


def crash(path: Path) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def hang(path: Path) -> None:
    while path:
        time.process_time()


def swell(path: Path) -> None:
    np.ones(fuzz_files.MEMORY // 4)


@pytest.mark.parametrize(
    ("reader", "said"),
    [(odd_error, "KeyError"), (crash, "ended by signal 9"), (hang, "took more than"), (swell, "MemoryError")],
)
def test_what_fails_is_noticed(
    reader: Callable[[Path], None], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(fuzz_files.READERS, ".toml", reader)
    monkeypatch.setattr(fuzz_files, "SECONDS", 0.2)
    path = tmp_path / "case.toml"
    path.write_text("[run]\n")
    assert said in fuzz_files.tried(path, tmp_path / "said")


def test_damaged_case_files_are_read_or_refused(tmp_path: Path) -> None:
    sound, draw = fuzz_files.CASES.find("rig_30310").read_bytes(), random.Random(1)
    path, changed = tmp_path / "case.toml", 0
    for _ in range(8):
        path.write_bytes(sound)
        fuzz_files.damage(path, draw)
        changed += path.read_bytes() != sound
        assert fuzz_files.tried(path, tmp_path / "said") == ""
    assert changed >= 5
