"""What a new result file holds before its first record; `trbdyn.results.file_format` lists it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

import h5py

from trbdyn.base.version import __version__
from trbdyn.results.fields import Field
from trbdyn.results.file_format import PEAKS, SCHEMA, SCHEMA_VERSION, chunk_rows, json_text, stored
from trbdyn.results.hdf5_quick import Column


def write_head(
    file: h5py.File, head: Mapping[str, Any], scene: Any, meta: Mapping[str, Any], geometry: Mapping[str, float]
) -> None:
    """Write what is known before the run, and the empty datasets of how it ends.

    Parameters
    ----------
    file : File
        A new file.
    head : mapping
        Name of the run, number of the segment, place of its first record.
    scene : Scene
        The scene.
    meta : mapping
        Versions, instruction set, settings; texts and numbers of it become attributes, too.
    geometry : mapping of str to float
        Derived geometry of the bearing, SI.
    """
    known = {"schema": SCHEMA, "schema_version": SCHEMA_VERSION, "trbdyn_version": __version__} | dict(head)
    known |= {"created": datetime.now(UTC).isoformat(), "geometry": json_text(geometry), "meta": json_text(meta)}
    known |= {name: value for name, value in meta.items() if isinstance(value, str | bool | int | float)}
    file.attrs.update({name: stored(value) for name, value in known.items()})
    file.create_dataset("scene", data=stored(json_text(scene.to_dict())))
    file.create_dataset("final_state", shape=(0,), maxshape=(None,), dtype="f8", chunks=(512,))
    file.create_dataset("ending", shape=(0,), maxshape=(None,), dtype="u1", chunks=(4096,))


def make_columns(
    file: h5py.File,
    fields: Sequence[Field],
    shapes: Mapping[str, tuple[int, ...]],
    *,
    rows: int | None,
    compression: str | None,
) -> tuple[dict[str, Column], dict[str, Column]]:
    """Make the empty datasets of the records, and those of the peaks of the whole run.

    Parameters
    ----------
    file : File
        A new file.
    fields : sequence of Field
        The fields that are kept.
    shapes : mapping of str to tuple of int
        Shape of each field in one record.
    rows : int or None
        Records of a chunk; None where nobody knows how many records will come.
    compression : {"gzip", "lzf"} or None
        How records are compressed.

    Returns
    -------
    tuple of dict of str to Column
        Those of the records, and those of the whole run.
    """
    group, peaks = file.create_group("fields"), file.create_group("peaks")
    columns: dict[str, Column] = {}
    whole_run: dict[str, Column] = {}
    for index, entry in enumerate(fields):
        shape = shapes[entry.name]
        columns[entry.name] = Column(group, entry.name, shape, rows or chunk_rows(shape), compression=compression)
        made = [columns[entry.name]]
        if entry.group == PEAKS:
            whole_run[entry.name] = Column(peaks, entry.name, shape, 1, most=1)
            made.append(whole_run[entry.name])
        attributes: dict[str, str | int] = {
            "unit": entry.unit,
            "description": entry.text,
            "group": entry.group,
            "kind": entry.kind,
            "dims": " ".join(("time", *entry.dims)),
            "index": index,
        }
        for column in made:
            column.describe(attributes)
    return columns, whole_run
