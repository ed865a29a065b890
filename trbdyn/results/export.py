"""Results for other programs: CSV tables, MATLAB files, and VTK for ParaView."""

from __future__ import annotations

import io
import math
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import h5py
import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import output_path, write_whole
from trbdyn.errors import InputError
from trbdyn.results.sources import files_of

if TYPE_CHECKING:
    from trbdyn.results.records import Records

Array = NDArray[np.float64]

NOTHING: Final = np.array([1.0, 1.0, 1.0])
TURNED: Final = np.array([1.0, -1.0, -1.0])
"""Signs of the axes of a bearing in those of the shaft, as it sits and turned round."""


def export(
    result: Records | Mapping[str, Records],
    path: str | os.PathLike[str],
    *,
    assembly: Any = None,
    overwrite: bool = False,
) -> Path:
    """Write a result for another program; see `Result.export`."""
    how: dict[str, Any] = {"overwrite": overwrite, "endings": tuple(WRITERS), "reads": files_of(result)}
    target = output_path(path, field="path", **how)  # before the records are read, which takes a while
    bearings: Mapping[str, Records] = result if isinstance(result, Mapping) else {"": result}
    return write_whole(path, WRITERS[target.suffix.lower()](bearings, assembly), **how)


def _csv(bearings: Mapping[str, Records], assembly: Any) -> bytes:
    """A row for each record and a column for each number, its unit behind its name."""
    columns: dict[str, Array] = {}
    for bearing, result in bearings.items():
        before = f"{bearing}." if bearing else ""
        for field in result.fields:
            unit = "" if field.unit == "1" else f" [{field.unit}]"
            values = np.asarray(result[field.name])
            if field.name == "time":
                columns.setdefault(f"time{unit}", values)
                continue
            for place in np.ndindex(values.shape[1:]):
                index = "".join(
                    f"[{k}]" if dim in ("roller", "slot", "mode") else f".{dim[k]}"
                    for k, dim in zip(place, field.dims, strict=True)
                )
                columns[f"{before}{field.name}{index}{unit}"] = values[(slice(None), *place)]
    paper = io.StringIO()
    table = np.column_stack(list(columns.values()))
    np.savetxt(paper, table, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")
    return paper.getvalue().encode()


def _matlab(bearings: Mapping[str, Records], assembly: Any) -> bytes:
    """A structure for each bearing (``trbdyn`` of one alone) with a matrix for each field, time along its first dimension."""
    from scipy.io import savemat

    found = {}
    for bearing, result in bearings.items():
        fields = {field.name: np.asarray(result[field.name]) for field in result.fields}
        units = {field.name: field.unit for field in result.fields}
        if "time" in fields:
            fields["time"] = fields["time"][:, None]
        found[_matlab_name(bearing)] = {**fields, "units": units, "message": result.message}
    paper = io.BytesIO()
    savemat(paper, found, long_field_names=True, do_compression=True)
    return paper.getvalue()


def _matlab_name(name: str) -> str:
    """A name that MATLAB takes: letters, digits and underscores, a letter first."""
    plain = "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in name)
    return plain if plain[:1].isalpha() else f"trbdyn{'_' if plain else ''}{plain}"


def _vtk(bearings: Mapping[str, Records], assembly: Any) -> bytes:
    """Centres of rollers and cages as points that move in time, with their loads and forces: VTKHDF, PolyData with steps."""
    for bearing, result in bearings.items():
        for group in ("cage", "rollers", "contacts"):
            if group not in result.groups:
                where = f" of {bearing}" if bearing else ""
                raise InputError.of(
                    "result", f"groups {', '.join(result.groups)}", f"must have the group {group!r}{where} for VTK"
                )
    parts = [
        _points(result, number, _seat(assembly, bearing)) for number, (bearing, result) in enumerate(bearings.items())
    ]
    points = np.concatenate([part.pop("points") for part in parts], axis=1)
    names = dict.fromkeys(name for part in parts for name in part)
    data = {name: np.concatenate([_padded(part, name) for part in parts], axis=1) for name in names}
    return _vtkhdf(np.asarray(next(iter(bearings.values()))["time"]), points, data)


def _padded(part: Mapping[str, Array], name: str) -> Array:
    """Values of a part; zero where this bearing has no such contact."""
    return part.get(name, np.zeros_like(part["outer_load"]))


def _seat(assembly: Any, bearing: str) -> tuple[Array, float]:
    """Signs of a bearing's axes in those of the shaft, and where its roller-centre plane is on the shaft (m)."""
    if assembly is None:
        return NOTHING, math.nan
    at = next(one for one in assembly.bearings if one.name == bearing)
    return (TURNED if at.side > 0.0 else NOTHING), float(at.centre_plane)


def _points(result: Records, number: int, seat: tuple[Array, float]) -> dict[str, Array]:
    """Points, shape (T, Z + 1, 3), and what belongs to each, shape (T, Z + 1) or (T, Z + 1, 3); the last point is the cage."""
    geometry, records, rollers = result.scene.bearing.geometry, len(result), result.n_rollers
    signs, plane = seat
    centre = np.array([0.0, 0.0, geometry.centre_plane])
    shift = np.zeros(3) if math.isnan(plane) else np.array([0.0, 0.0, plane])

    def with_cage(of_rollers: Any, cage: Any = 0.0) -> Array:
        values = np.asarray(of_rollers, dtype=np.float64)
        shape = (records, 1, *values.shape[2:])
        last = np.broadcast_to(cage, shape) if np.ndim(cage) == 0 else np.asarray(cage).reshape(shape)
        return np.concatenate([values, last], axis=1)

    found = {"points": signs * (with_cage(result["roller_position"] - centre, result["cage_position"])) + shift}
    found["part"] = with_cage(np.zeros((records, rollers)), 1.0)
    found["bearing"] = np.full((records, rollers + 1), float(number))
    found["roller"] = with_cage(np.broadcast_to(np.arange(rollers), (records, rollers)), -1.0)
    for field in result.fields:
        if field.dims == ("roller",) and not field.name.startswith("roller_orbit"):
            found[field.name] = with_cage(result[field.name])
    if "pocket_force" in result:
        found["pocket_force"] = with_cage(result["pocket_force"].sum(axis=2))
    angle = result["roller_orbit_angle"]
    for side, slope, sign in (
        ("outer", math.radians(result.scene.bearing.cup_half_angle_deg), -1.0),
        ("inner", geometry.cone_half_angle, 1.0),
    ):
        normal = [
            math.cos(slope) * np.cos(angle),
            math.cos(slope) * np.sin(angle),
            np.full_like(angle, -math.sin(slope)),
        ]
        force = sign * result[f"{side}_load"][..., None] * np.stack(normal, axis=-1)
        found[f"{side}_force"] = signs * with_cage(force)
    found["velocity"] = signs * with_cage(result["roller_velocity"], result["cage_velocity"])
    if "cage_force" in result:
        found["cage_force"] = signs * with_cage(np.zeros((records, rollers, 3)), result["cage_force"])
    return found


def _vtkhdf(time: Array, points: Array, data: Mapping[str, Array]) -> bytes:
    """Points that move as a VTKHDF file, version 2.0: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html."""
    steps, count = points.shape[:2]
    at = np.arange(steps, dtype=np.int64)
    paper = io.BytesIO()
    with h5py.File(paper, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
        root["NumberOfPoints"] = np.full(steps, count, dtype=np.int64)
        root.create_dataset("Points", data=points.reshape(-1, 3).astype(np.float32), compression="gzip")
        of_points = root.create_group("PointData")
        for name, values in data.items():
            flat = values.reshape(-1, *values.shape[2:]).astype(np.float32)
            of_points.create_dataset(name, data=flat, compression="gzip")
        for kind in ("Vertices", "Lines", "Polygons", "Strips"):
            cells = count if kind == "Vertices" else 0
            group = root.create_group(kind)
            group["NumberOfCells"] = np.full(steps, cells, dtype=np.int64)
            group["NumberOfConnectivityIds"] = np.full(steps, cells, dtype=np.int64)
            group["Connectivity"] = np.tile(np.arange(cells, dtype=np.int64), steps)
            group["Offsets"] = np.tile(np.arange(cells + 1, dtype=np.int64), steps)
        of_steps = root.create_group("Steps")
        of_steps.attrs["NSteps"] = steps
        of_steps["Values"] = time
        of_steps["PartOffsets"] = at
        of_steps["NumberOfParts"] = np.ones(steps, dtype=np.int64)
        of_steps["PointOffsets"] = at * count
        of_cells = np.zeros((steps, 4), dtype=np.int64)
        of_cells[:, 0] = at * count
        of_steps["CellOffsets"] = of_cells
        of_steps["ConnectivityIdOffsets"] = of_cells
        offsets = of_steps.create_group("PointDataOffsets")
        for name in data:
            offsets[name] = at * count
    return paper.getvalue()


WRITERS: Final[dict[str, Callable[[Mapping[str, Records], Any], bytes]]] = {
    ".csv": _csv,
    ".mat": _matlab,
    ".vtkhdf": _vtk,
}
"""Who writes a file, by the ending of its name."""
