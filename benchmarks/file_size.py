"""What takes the room in a result file, and what would take less: a whirling 30310 with a record every 0.1 ms.

    python benchmarks/file_size.py [--quick] [--json FILE]

The file is read again and each of its chunks is packed again in other ways, with the same checksum and the same 512 records:
higher levels of zlib, numbers of one roller beside each other in time instead of all rollers of a record, fewer digits, float32.
"""

from __future__ import annotations

import tempfile
import zlib
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

import common
import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn import Simulation, Start
from trbdyn.model.cases import scene_30310
from trbdyn.results.file_format import BLOCK_ROWS

Array = NDArray[Any]

SAVE: Final = 1e-4
"""Time between records (s)."""
COLUMNS = {
    "what": "text: group of quantities, or another way to pack all of them",
    "kb_per_turn": "kB: packed size for a turn of the shaft",
    "file_kb_per_turn": "kB: size of the whole file for a turn of the shaft",
    "default_kb_per_turn": "kB: the same with the records that a run keeps by default",
    "records_per_turn": "1: records of a turn",
}
Packing = Callable[[Array], int]


def packed(values: Array, level: int = 1, *, by_column: bool = False) -> int:
    """Bytes of a quantity in chunks of 512 records: bytes sorted by their place in a number, then zlib."""
    total = 0
    for at in range(0, len(values), BLOCK_ROWS):
        chunk = values[at : at + BLOCK_ROWS]
        chunk = np.ascontiguousarray(np.moveaxis(chunk, 0, -1) if by_column else chunk)
        bytes_of = chunk.reshape(-1).view(np.uint8).reshape(-1, chunk.dtype.itemsize)
        total += len(zlib.compress(bytes_of.T.tobytes(), level))
    return total


WAYS: Final[dict[str, Packing]] = {
    "as it is": packed,
    "zlib at level 9": lambda values: packed(values, 9),
    "numbers of one roller beside each other in time": lambda values: packed(values, by_column=True),
    "everything as float32": lambda values: packed(values.astype(np.float32)),
    "all of these": lambda values: packed(values.astype(np.float32), 9, by_column=True),
}


def run(report: common.Report, turns: float) -> None:
    simulation = Simulation(scene_30310(3000.0, 4930.0, start=Start.whirl(0.9)), accuracy="fast")
    with tempfile.TemporaryDirectory() as folder:
        path, short = Path(folder) / "run.h5", Path(folder) / "default.h5"
        result = simulation.run(revolutions=turns, save_every=SAVE, output=path)
        Simulation(simulation.scene, accuracy="fast").run(revolutions=turns, output=short)
        with h5py.File(path) as file:
            kept = {entry.name: (entry.group, file[entry.name][:]) for entry in result.fields}
        sizes = [file.stat().st_size / turns / 1e3 for file in (path, short)]
    groups: Counter[str] = Counter()
    for group, values in kept.values():
        groups[group] += packed(values)
    for group, size in groups.most_common():
        report.add(what=group, kb_per_turn=size / turns / 1e3)
    for name, way in WAYS.items():
        report.add(what=name, kb_per_turn=sum(way(values) for _, values in kept.values()) / turns / 1e3)
    report.summary = {
        "file_kb_per_turn": sizes[0],
        "default_kb_per_turn": sizes[1],
        "records_per_turn": len(result) / turns,
    }


def main(arguments: Sequence[str] | None = None) -> common.Report:
    options = common.parser(__doc__).parse_args(arguments)
    report = common.Report("file_size", options, COLUMNS)
    report.inputs = {"save_every_s": SAVE}
    run(report, 5.0 if options.quick else 20.0)
    print(common.table(report.results, ("what", "kb_per_turn"), digits=3))
    print(report.summary)
    report.finish()
    return report


if __name__ == "__main__":
    main()
