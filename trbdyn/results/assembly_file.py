"""The file of an assembly: the results of its bearings, gathered from the files that were written while the run went on."""

from __future__ import annotations

import json
import os
import uuid
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from trbdyn.base.own_files import create_draft, file_path, put_in_place
from trbdyn.base.version import __version__
from trbdyn.errors import FileError
from trbdyn.results import hdf5_file
from trbdyn.results.file_format import ASSEMBLY, ASSEMBLY_SCHEMA, ASSEMBLY_VERSION, LIBVER, json_text, reason
from trbdyn.results.hdf5_checks import read_own
from trbdyn.results.sources import FileSource, opened


def part_path(path: Path, bearing: str) -> Path:
    """Where the records of a bearing are while the run goes on: ``pair.left.h5`` for ``pair.h5``."""
    return path.with_name(f"{path.stem}.{bearing}{path.suffix}")


def gather(path: Path, bearings: Mapping[str, Path], assembly: Mapping[str, Any] | None, *, overwrite: bool) -> None:
    """Put the files of some bearings together into one, and remove them.

    Parameters
    ----------
    path : Path
        File to write.
    bearings : mapping of str to Path
        The finished file of each bearing.
    assembly : mapping, optional
        Description of the assembly.
    overwrite : bool
        Replace a file that is there.

    Raises
    ------
    FileError
        If a file cannot be read or written; those of the bearings are then still there.
    """
    about = {"schema": ASSEMBLY_SCHEMA, "schema_version": ASSEMBLY_VERSION, "trbdyn_version": __version__}
    about |= {"created": datetime.now(UTC).isoformat()}
    text = json_text(about | {"bearings": list(bearings), "assembly": assembly}).encode()
    try:
        draft, lock = create_draft(path, uuid.uuid4().hex)
        with lock:
            with h5py.File(draft, "w", libver=LIBVER, locking=False) as file:
                file.attrs.update(about)
                file.create_dataset(ASSEMBLY, data=np.array([text]), chunks=(1,), fletcher32=True)
                for name, part in bearings.items():
                    with opened(part) as source:
                        _copy(FileSource(part), source, file.create_group(name))
            put_in_place(draft, path, replace=overwrite)
    except (OSError, RuntimeError) as error:
        if isinstance(error, FileError):
            raise
        parts = ", ".join(map(str, bearings.values()))
        raise FileError(
            f"{path}: the result file cannot be written: {reason(error)}; the bearings are in {parts}"
        ) from error
    for part in bearings.values():
        part.unlink()


def _copy(source: FileSource, file: h5py.Group, target: h5py.Group) -> None:
    shapes = {entry.name: file[entry.name].shape[1:] for entry in source.fields}
    hdf5_file.fill(target, source.head, source.fields, shapes, rows=file["time"].chunks[0])
    for name in (*shapes, "run/ending", "run/final_state", "run/peaks"):
        hdf5_file.copy_chunks(file[name], target[name])
    hdf5_file.commit(target, source.n_records, file["run/ending"].shape[0])


def description_in(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """What a file says of its assembly: ``bearings``, their names, and ``assembly``; None where it is the file of one bearing.

    Raises
    ------
    FileError
        If the file cannot be read, or is of a later version.
    """
    where = file_path(path, "path")
    with opened(where) as file:
        if ASSEMBLY not in file:
            return None
        table: dict[str, Any] = json.loads(bytes(read_own(file, ASSEMBLY)[0]))
    if table.get("schema") != ASSEMBLY_SCHEMA or table.get("schema_version") != ASSEMBLY_VERSION:
        raise FileError(
            f"{where}: written with schema version {table.get('schema_version')!r} of an assembly; this trbdyn reads version "
            f"{ASSEMBLY_VERSION}"
        )
    return table
