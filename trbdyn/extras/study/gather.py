"""Observables of a study in an xarray Dataset, and its file."""

from __future__ import annotations

import hashlib
import io
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import write_whole
from trbdyn.errors import FileError
from trbdyn.extras.study.definition import Study
from trbdyn.extras.study.index import Entry
from trbdyn.model.assembly import Assembly, Shaft, ShaftBearing, ShaftLoad
from trbdyn.model.scene import Scene
from trbdyn.results.numbers import find, listed
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray

    from trbdyn.results.number import Place

NOT_RUN = "not run"
_UNKNOWN = "0" * 64
"""Stands in the place of the file's SHA-256 while that is computed."""


def dataset(study: Study, entries: Sequence[Entry | None]) -> xarray.Dataset:
    """Gather the observables of all cases; an entry is None where its case was not run.

    Dimensions: the axes of a grid, or ``case``. Variables: ``status``, ``message``, ``file``, ``fingerprint``, ``wall_time``
    and every observable; nan (or empty text) where a case has none. An observable whose name a parameter has already gets
    ``_observed`` behind it.
    """
    import xarray

    shape = study.shape
    dims = tuple(axis.name for axis in study.axes) or ("case",)
    variables: dict[str, Any] = {
        "status": (dims, _texts([entry.status if entry else NOT_RUN for entry in entries]).reshape(shape)),
        "message": (dims, _texts([entry.message if entry else "" for entry in entries]).reshape(shape)),
        "file": (dims, _texts([entry.file if entry else "" for entry in entries]).reshape(shape)),
        "fingerprint": (dims, _texts([case.fingerprint for case in study.cases]).reshape(shape)),
        "wall_time": (dims, np.array([e.wall_s if e else np.nan for e in entries]).reshape(shape), {"units": "s"}),
    }
    tables: list[Mapping[str, Any]] = [entry.values if entry else {} for entry in entries]
    coordinates = _coordinates(study, dims)
    subjects = (case.scene for case in study.cases if case.scene is not None)
    bearings = dict.fromkeys(name for subject in subjects for name in subject.names if name)
    for key in dict.fromkeys(key for table in tables for key in table):
        column = _column([table.get(key) for table in tables])
        name = f"{key}_observed" if key in coordinates or key in variables else key
        extra = tuple(f"{name}_{k}" for k in range(column.ndim - 1))
        variables[name] = ((*dims, *extra), column.reshape(*shape, *column.shape[1:]), _attributes(key, bearings))
    return xarray.Dataset(variables, coords=coordinates, attrs={"study": study.name, "bearings": " ".join(bearings)})


def _texts(values: Sequence[str]) -> NDArray[Any]:
    return np.array(values, dtype=object)


def _coordinates(study: Study, dims: tuple[str, ...]) -> dict[str, Any]:
    if study.axes:
        return {axis.name: (axis.name, _column(list(axis.labels)), _about_path(axis.path)) for axis in study.axes}
    names = dict.fromkeys(key for case in study.cases for key in case.parameters)
    columns = {
        name: ("case", _column([case.parameters.get(name) for case in study.cases]), _about_path(name))
        for name in names
    }
    return {"case": np.arange(len(study)), **{n if n != "case" else "case_": c for n, c in columns.items()}}


def _about_path(path: str) -> dict[str, str]:
    """Attributes of the values at a dotted path of a case: the path, and the unit where the field has one."""
    unit = unit_of(path)
    return {"path": path} | ({"long_name": path, "units": unit} if unit else {})


_OWNERS = {
    "scene": Scene,
    "run": RunOptions,
    "assembly": Assembly,
    "shaft": Shaft,
    "bearings": ShaftBearing,
    "loads": ShaftLoad,
}


def unit_of(path: str) -> str:
    """Unit of the field at a dotted path, for instance "kg" for ``bearing.cage.mass``; empty where it is no field with a unit."""
    table, *parts = re.sub(r"\[\d+\]", "", path).split(".")
    owner: Any = _OWNERS.get(table, Scene)
    for name in parts if table in _OWNERS else [table, *parts]:
        fields = getattr(owner, "model_fields", {})
        if name not in fields:
            return ""
        found, owner = fields[name], fields[name].annotation
    extra = found.json_schema_extra if parts else None
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


def _column(values: Sequence[Any]) -> NDArray[Any]:
    """Values of all cases as one array: truth values, whole numbers, numbers with nan, texts with '', or stacked arrays."""
    given = [value for value in values if value is not None]
    if any(isinstance(value, list) for value in given) and not all(isinstance(value, list) for value in given):
        values = [value if isinstance(value, list) else None for value in values]
        given = [value for value in values if value is not None]
    if given and all(isinstance(value, list) for value in given):
        return _stacked(values)
    if any(isinstance(value, str) for value in given):
        return _texts(["" if value is None else str(value) for value in values])
    whole = len(given) == len(values)
    for kind in (bool, int):
        if whole and given and all(type(value) is kind for value in given):
            return np.array(values, dtype=kind)
    return np.array([np.nan if value is None else float(value) for value in values])


def _stacked(values: Sequence[Any]) -> NDArray[Any]:
    arrays = [None if value is None else np.array(value, dtype=float) for value in values]
    size = next(array.shape for array in arrays if array is not None)
    arrays = [array if array is not None and array.ndim == len(size) else None for array in arrays]
    largest = tuple(max(array.shape[k] for array in arrays if array is not None) for k in range(len(size)))
    out = np.full((len(values), *largest), np.nan)
    for place, array in enumerate(arrays):
        if array is not None:
            out[place][tuple(slice(0, length) for length in array.shape)] = array
    return out


def _attributes(name: str, bearings: Iterable[str]) -> dict[str, str]:
    found = find(name, bearings)
    return {} if found is None else {"long_name": found.words, "units": found.unit or "1"}


def listed_in(data: xarray.Dataset, place: Place) -> list[str]:
    """Variables of a dataset that are numbers of a short list, of each bearing and of the whole."""
    return listed(place, data.data_vars, data.attrs.get("bearings", "").split())


def save(data: xarray.Dataset, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Write a dataset as netCDF (version 3, 64-bit offsets), with its SHA-256 as an attribute, which `load` checks.

    Parameters
    ----------
    data : xarray.Dataset
        What to write.
    path : path-like
        File to write.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    FileError
        If it cannot be written.
    """
    limit = np.iinfo(np.int32).max
    written = data.copy()
    for name, variable in data.variables.items():
        if variable.dtype.kind in "iu" and variable.size and np.abs(variable.values).max() > limit:
            written[name] = written[name].astype(float)
    try:
        written = _renamed(written, lambda text: text.encode().decode("latin-1"))
        written.attrs["sha256"] = _UNKNOWN
        content = bytes(written.to_netcdf(engine="scipy", format="NETCDF3_64BIT"))
        content = content.replace(_UNKNOWN.encode(), hashlib.sha256(content).hexdigest().encode(), 1)
    except (ValueError, TypeError) as error:
        raise FileError(f"{path}: the dataset cannot be written: {error}") from error
    return write_whole(path, content, overwrite=overwrite)


def _renamed(data: xarray.Dataset, change: Callable[[str], str]) -> xarray.Dataset:
    """The dataset with other names of variables and dimensions: netCDF keeps them as UTF-8, SciPy takes them for Latin-1."""
    names = {str(name): change(str(name)) for name in {*data.variables, *data.dims}}
    out = data.rename({name: new for name, new in names.items() if name != new})
    parts: list[Any] = [out, *out.variables.values()]
    for part in parts:
        part.attrs = {key: change(value) if isinstance(value, str) else value for key, value in part.attrs.items()}
    return out


def _from_utf8(text: str) -> str:
    try:
        return text.encode("latin-1").decode()
    except UnicodeError:
        return text


def load(path: str | os.PathLike[str]) -> xarray.Dataset:
    """Read a dataset that `save` wrote.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    import xarray

    try:
        content = Path(path).read_bytes()
        data = xarray.load_dataset(io.BytesIO(content), engine="scipy")
        digest = data.attrs.pop("sha256", "")
        if hashlib.sha256(content.replace(digest.encode(), _UNKNOWN.encode(), 1)).hexdigest() != digest:
            raise ValueError("the file is damaged: its checksum does not fit")
        return _renamed(data, _from_utf8)
    except FileError:
        raise
    except Exception as error:  # whatever xarray and SciPy make of a damaged file
        raise FileError(f"{path}: the dataset cannot be read: {error}") from error
