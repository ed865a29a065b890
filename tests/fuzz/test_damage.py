"""Files that a disk or a transfer has damaged, in bits, in length: each is refused, or read as it was."""

from __future__ import annotations

import random
import shutil
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import study
from trbdyn.errors import FileError
from trbdyn.extras.study import gather
from trbdyn.model.cases import scene_30310
from trbdyn.run import checkpoint
from trbdyn.run.options import RunOptions

Reader = Callable[[Path], dict[str, Any]]


def read_result(path: Path) -> dict[str, Any]:
    result = trb.load(path)
    with result._source.held_open():
        values: dict[str, Any] = {field.name: result[field.name] for field in result.fields}
    values |= {f"whole run: {name}": result.peaks[name] for name in result.peaks}
    values |= {name: getattr(result, name) for name in ("success", "message", "stats", "counters", "geometry", "meta")}
    return values | {"final_state": result.final_state, "warnings": result.warnings, "scene": result._info.scene}


def read_checkpoint(path: Path) -> dict[str, Any]:
    return dict(vars(checkpoint.read(path)))


def read_dataset(path: Path) -> dict[str, Any]:
    data = gather.load(path)
    return {str(name): variable.values for name, variable in data.variables.items()}


def read_index(path: Path) -> dict[str, Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return {entry.fingerprint: entry for entry in study.index.read_lines(path)}
        except UserWarning as said:
            raise FileError(str(said)) from None


def damaged(data: bytes, count: int, draw: random.Random) -> Iterator[tuple[str, bytes]]:
    """Contents with one damage each; places of the first and last bytes, which hold most of the structure, come often."""
    size = len(data)
    for number in range(count):
        at = draw.choice((draw.randrange(size), draw.randrange(size), draw.randrange(min(size, 4096))))
        kind, changed = ("bit", "byte", "zeros", "more", "end")[number % 5], bytearray(data)
        if kind == "bit":
            changed[at] ^= 1 << draw.randrange(8)
        elif kind == "byte":
            changed[at] = draw.randrange(256)
        elif kind == "zeros":
            length = draw.choice((1, 16, 512, 4096))
            changed[at : at + length] = bytes(len(changed[at : at + length]))
        elif kind == "more":
            changed[at:at] = draw.randbytes(draw.randrange(1, 64))
        else:
            del changed[draw.choice((at, size - 1, size - draw.randrange(1, 100))) :]
        yield f"{kind} at {at} of {size}", bytes(changed)


def check(path: Path, read: Reader, count: int) -> int:
    """Damage a file at many places; says how often it was refused."""
    data, wanted, refused = path.read_bytes(), read(path), 0
    for what, content in damaged(data, count, random.Random(count)):
        path.write_bytes(content)
        try:
            found = read(path)
        except FileError:
            refused += 1
            continue
        if path.suffix == ".jsonl" and what.startswith("end"):
            # where just whole lines are cut off nothing tells that there were more: these cases are not there, the others are
            assert set(found) <= set(wanted), what
            wanted_here = {name: wanted[name] for name in found}
        else:
            wanted_here = wanted
            assert found.keys() == wanted.keys(), what
        for name, value in wanted_here.items():
            np.testing.assert_equal(found[name], value, err_msg=f"{what}: {name}")
    path.write_bytes(data)
    return refused


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A result, a checkpoint and the files of a study."""
    folder = tmp_path_factory.mktemp("files")
    shutil.rmtree(folder)
    made = study.grid(scene_30310(), {"scene.speed_rpm": [1000, 2000]}, RunOptions(duration=1e-4))
    study.run(made, folder, executor="serial")
    trb.Simulation(scene_30310()).run(duration=2e-3, save_every=2e-5, output=folder / "run.h5")

    def stop(sim: trb.Simulation) -> bool:
        return sim.time > 1e-3

    options = {"duration": 4e-3, "save_every": 1e-5, "checkpoint_every": 5e-4}
    trb.Simulation(scene_30310()).run(output=folder / "cut.h5", callback=stop, **options)
    return folder


@pytest.mark.parametrize(
    ("name", "read", "count"),
    [
        ("run.h5", read_result, 60),
        ("cut.h5", read_result, 40),
        ("cut.h5.checkpoint", read_checkpoint, 100),
        ("observables.nc", read_dataset, 60),
        ("index.jsonl", read_index, 60),
        *(
            pytest.param(name, read, 2003, marks=pytest.mark.slow)
            for name, read in (("run.h5", read_result), ("index.jsonl", read_index), ("observables.nc", read_dataset))
        ),
    ],
)
def test_a_damaged_file_is_refused_or_read_as_it_was(files: Path, name: str, read: Reader, count: int) -> None:
    refused = check(files / name, read, count)
    assert refused > 0.3 * count, "most damage must be noticed"
