"""A result file from elsewhere reads nothing but itself, and takes no more memory than it says."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cases import paper_30310

SHA = "0" * 64


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("foreign") / "run.h5"
    trb.Simulation(paper_30310()).run(duration=2e-4, save_every=1e-5, output=path)
    return path.read_bytes()


def replaced(path: Path, name: str, values: Any, **how: Any) -> None:
    with h5py.File(path, "r+") as file:
        del file[name]
        file.create_dataset(name, data=values, **how)


def with_scene(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    with h5py.File(path, "r") as file:
        head = json.loads(bytes(file["run/head"][0]))
    change(head["scene"])
    replaced(path, "run/head", np.array([json.dumps(head).encode()]), chunks=(1,))


@pytest.mark.parametrize("checksum", [None, SHA])
@pytest.mark.parametrize("kind", ["pipe", "device", "file"])
@pytest.mark.usefixtures("drawn_only")
def test_no_file_is_opened_whose_name_stands_in_a_result(
    good: bytes, tmp_path: Path, checksum: str | None, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = Path("/dev/zero") if kind == "device" else tmp_path / "other"
    if kind == "pipe":
        os.mkfifo(other)
    elif kind == "file":
        other.write_bytes(b"secret")
    path = tmp_path / "run.h5"
    path.write_bytes(good)

    def lead(scene: dict[str, Any]) -> None:
        scene["elastic_cage"] = {"n_modes": 4, "file": str(other), "file_sha256": checksum}
        scene["effects"] |= {"bodies": "rollers_and_cage", "guidance": "rollers", "planar": False}

    with_scene(path, lead)
    opened, plain = [], os.open
    monkeypatch.setattr(os, "open", lambda name, *rest, **how: opened.append(str(name)) or plain(name, *rest, **how))
    began = time.monotonic()
    if checksum is None:
        with pytest.raises(trb.FileError, match=r"elastic_cage\.file has no checksum"):
            trb.load(path)
    else:
        result = trb.load(path)
        assert result.summary()
        assert str(other) not in opened
        # ratings of a report compute contacts again, for which they read the file of modes if it has its checksum
        trb.report(result, tmp_path / "a.html", pictures=[])
    assert time.monotonic() - began < 20.0


@pytest.mark.parametrize("name", ["head", "ending", "final_state", "peaks", "committed"])
def test_what_unpacks_to_gigabytes_is_refused_at_once(good: bytes, tmp_path: Path, name: str) -> None:
    path = tmp_path / "run.h5"
    path.write_bytes(good)
    count = 80 << 20
    with h5py.File(path, "r+") as file:
        del file[f"run/{name}"]
        kind = {"head": "S1", "ending": "u1"}.get(name, "f8")
        size = count // np.dtype(kind).itemsize
        data = file.create_dataset(
            f"run/{name}", (size,), kind, chunks=(size // 4,), compression="gzip", compression_opts=1
        )
        data[:] = np.ones(size, dtype=kind)
        if name == "ending":
            file["run/committed"][1] = size
    assert path.stat().st_size < 0.02 * count
    began = time.monotonic()
    with pytest.raises(trb.FileError, match=r"more than a result holds there|damaged"):
        trb.load(path)
    assert time.monotonic() - began < 3.0


@pytest.mark.parametrize("notes", [7, None, "text", [1, "a"]])
@pytest.mark.usefixtures("drawn_only")
def test_notes_of_another_kind_do_not_break_a_report(good: bytes, tmp_path: Path, notes: Any) -> None:
    path = tmp_path / "run.h5"
    path.write_bytes(good)
    with h5py.File(path, "r") as file:
        head = json.loads(bytes(file["run/head"][0]))
    head["meta"]["notes"] = notes
    replaced(path, "run/head", np.array([json.dumps(head).encode()]), chunks=(1,))
    try:
        result = trb.load(path)
    except trb.FileError:
        return
    trb.report(result, tmp_path / "report.html", pictures=[])
