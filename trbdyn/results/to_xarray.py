"""A result as an xarray Dataset: fields of one bearing, or of several with the name of the bearing before each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    import xarray

    from trbdyn.results.records import Records

LABELS: Final = {dim: list(dim) for dim in ("xyz", "xy", "wxyz")}
"""Labels of the dimensions that have names."""


def dataset(result: Any) -> xarray.Dataset:
    """The recorded fields of a result, and the numbers of its summary as attributes."""
    import xarray

    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    for name, part in result.by_name.items():
        found, places = _fields(part, f"{name}_" if name else "")
        variables |= found
        coordinates |= places
    attributes = {"success": int(result.success), "message": result.message}
    attributes |= {name: _plain(value) for name, value in result.numbers().items() if value is not None}
    return xarray.Dataset(variables, coords=coordinates, attrs=attributes)


def _fields(part: Records, before: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Variables and coordinates of a bearing; dimensions that bearings have by themselves begin with its name."""

    def own(dims: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(dim if dim in LABELS else f"{before}{dim}" for dim in dims)

    with part._source.held_open():
        variables = {
            f"{before}{field.name}": (
                ("time", *own(field.dims)),
                part[field.name],
                {"units": field.unit, "long_name": field.text},
            )
            for field in part.fields
        }
    time = variables.pop(f"{before}time")
    used = {dim for dims, _, _ in variables.values() for dim in dims}
    coordinates: dict[str, Any] = {"time": time} | {dim: names for dim, names in LABELS.items() if dim in used}
    if f"{before}roller" in used:
        coordinates[f"{before}roller"] = np.arange(part.n_rollers)
    return variables, coordinates


def _plain(value: Any) -> Any:
    """What a netCDF file takes as an attribute."""
    if isinstance(value, Mapping):
        return str(dict(value))
    return int(value) if isinstance(value, bool) else value
