"""The result of bearings on one shaft: a result of each, and the shaft's own motion and energy."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self, overload

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.display import plain, step_of
from trbdyn.base.shown import Displayed, Shown
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.assembly import Assembly
from trbdyn.results import numbers
from trbdyn.results.number import of_whole
from trbdyn.results.observables.energy import EnergyAudit, energy_audit
from trbdyn.results.result import Result, load_bearing
from trbdyn.results.summary import Summary
from trbdyn.results.to_xarray import dataset

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

TOGETHER: Final = "together"
"""Column of what is that of all bearings."""
"""Factors of units in the table of an assembly, and the units there."""
TURNED_OVER: Final = (
    "{} shown in axes of its own, turned by half a turn about x against those of the shaft, as its small ends point to the "
    "right: speeds, y and z have the opposite sign there, and a cage that hangs down is drawn above the axis."
)
"""What is said of a bearing that sits the other way round."""


class AssemblyResult(Mapping[str, Result], Displayed):
    """What a run of bearings on one shaft gives: a result of each bearing by its name, each in the bearing's own axes.

    Parameters
    ----------
    bearings : mapping of str to Result
        The results. The first bearing's energies are those of the shaft, too.
    assembly : Assembly, optional
        The assembly; without it the axes of the shaft are those of the first bearing.

    Examples
    --------
    >>> import trbdyn as trb
    >>> result = trb.Simulation(trb.load_assembly("pair_30310")).run(revolutions=0.1)
    >>> result["left"].cage_position.shape == result["right"].cage_position.shape
    True
    """

    def __init__(self, bearings: Mapping[str, Result], assembly: Assembly | None = None) -> None:
        self._bearings = dict(bearings)
        self.assembly = assembly

    def __getitem__(self, name: str) -> Result:
        """The result of a bearing.

        Raises
        ------
        InputError
            If no bearing has this name.
        """
        if name not in self._bearings:
            raise InputError.of("bearing", name, f"must be one of {', '.join(self._bearings)}")
        return self._bearings[name]

    def __iter__(self) -> Any:
        return iter(self._bearings)

    def __len__(self) -> int:
        return len(self._bearings)

    def __repr__(self) -> str:
        return f"<AssemblyResult: {', '.join(self._bearings)}: {self.message}>"

    def __str__(self) -> str:
        return self._shown().text()

    def _shown(self) -> Shown:
        found = self.summary()
        all_of_them = whole(found)
        rows: list[tuple[str, ...]] = [("", *self, TOGETHER)]
        for row in numbers.rows("shaft"):
            values = [one.get(row.name) for one in found.values()]
            if any(value is not None for value in values):
                values.append(all_of_them.get(row.name))
                factor, unit = step_of(row.unit, [value for value in values if isinstance(value, float)])
                words = f"{row.words}, {unit}" if unit else row.words
                rows.append((words, *("-" if value is None else plain(factor * value, 5) for value in values)))
        shaft = 1e6 * self.shaft_position
        mean = shaft.mean(axis=0)
        notes = (
            f"{self.message}; energy closure of the whole {self.energy.closure:.2g}; power loss of all bearings "
            f"{sum(one.get('power_loss') or 0.0 for one in found.values()):.5g} W.",
            f"The shaft's centre of mass is at ({mean[0]:.4g}, {mean[1]:.4g}, {mean[2]:.4g}) um in the mean, and moves by up "
            f"to {np.hypot(*(shaft - mean)[:, :2].T).max():.3g} um about that across the axis.",
            *(TURNED_OVER.format(f"{name} is") for name in self.turned_over),
            *self.warnings,
        )
        parts = tuple(one._shown() for one in found.values())
        title = f"Result: {'success' if self.success else 'failed'}"
        return Shown(title, tuple(rows), head=("", *self, TOGETHER), notes=notes, parts=parts)

    @property
    def subject(self) -> Assembly | None:
        """What was simulated; None where seats were given in place of an assembly."""
        return self.assembly

    def summary(self) -> dict[str, Summary]:
        """The summary of each bearing by its name."""
        return {name: result.summary() for name, result in self.items()}

    def numbers(self) -> dict[str, Any]:
        """The entries of the summaries, each with its bearing's name before it (``left_torque``), and those of the whole by their
        names alone: ``torque``, ``power_loss`` and ``torque_by_loss_...`` are sums, film parameters are the smallest
        (`Number.together`).
        """
        each = self.summary()
        found = numbers.of_table(whole(each))
        for name, values in each.items():
            own = numbers.of_table(values)
            same = {key for key in own if key in numbers.TABLE and numbers.TABLE[key].together == "same"}
            found |= {f"{name}_{key}": value for key, value in own.items() if key not in same}
        return found

    @property
    def overview(self) -> str:
        """The summaries of the bearings beside each other, as a table."""
        return str(self)

    @property
    def parts(self) -> tuple[Result, ...]:
        """The results of all bearings."""
        return tuple(self.values())

    @property
    def by_name(self) -> Mapping[str, Result]:
        """The results of all bearings by their names."""
        return self

    def moved(self, path: Path) -> Self:
        """The result, whose file has another name now; nothing is read again."""
        for result in self.values():
            result.moved(path)
        return self

    def export(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the records of all bearings for another program, as `Result.export` does for one.

        Parameters
        ----------
        path : path-like
            ``NAME.csv``: columns begin with the name of their bearing. ``NAME.mat``: a structure for each bearing.
            ``NAME.vtkhdf``: all bearings in the axes of the shaft.
        overwrite : bool
            Replace a file that is there; never the file of this result.
        """
        from trbdyn.results.export import export

        return export(self, path, assembly=self.assembly, overwrite=overwrite)

    def to_xarray(self) -> xarray.Dataset:
        """Every recorded field of all bearings in an xarray Dataset.

        Returns
        -------
        Dataset
            As `Result.to_xarray` gives it for one; names of variables, and of the dimensions roller, slot and mode, begin with
            the name of their bearing: ``left_cage_position``.
        """
        return dataset(self)

    def loads(self, name: str) -> dict[str, Array]:
        """Loads of the shaft on a bearing at each record (N), shape (T,).

        Parameters
        ----------
        name : str
            Name of the bearing.

        Returns
        -------
        dict
            ``axial_load``, towards the small ends of its rollers, and ``radial_load``.
        """
        return dict(zip(("axial_load", "radial_load"), self[name].ring_loads, strict=True))

    @property
    def _first(self) -> Result:
        return next(iter(self._bearings.values()))

    @property
    def success(self) -> bool:
        """Whether the run reached its end."""
        return self._first.success

    @property
    def message(self) -> str:
        """How it ended, in a sentence."""
        return self._first.message

    @property
    def stats(self) -> dict[str, Any]:
        """What the integrator did, for all bearings together."""
        return self._first.stats

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the watch found, with the bearing's name where it concerns one."""
        return tuple(dict.fromkeys(f"{name}: {text}" for name, result in self.items() for text in result.warnings))

    @property
    def time(self) -> Array:
        """Times of the records (s), shape (T,)."""
        return self._first.time

    @property
    def shaft_position(self) -> Array:
        """Displacement of the shaft's centre of mass along its axes x, y, z (m), shape (T, 3)."""
        seat, axis = self._first.meta["assembly"]["seat"], self._axis
        place = self._first.ring_position - [0.0, 0.0, seat["shift"]] + seat["mass_offset"] * (axis - [0.0, 0.0, 1.0])
        return place * self._signs

    @property
    def shaft_axis(self) -> Array:
        """Direction of the shaft's axis (1), shape (T, 3)."""
        return self._axis * self._signs * self._signs[2]

    def shaft_displacement(self, position: float) -> Array:
        """Displacement of a point of the shaft's axis along x, y and z (m), shape (T, 3).

        Parameters
        ----------
        position : float
            Position of the point along the shaft (m).

        Raises
        ------
        InputError
            If the assembly is not known.
        """
        if self.assembly is None:
            raise InputError.of("assembly", None, "must be known, to say where a point of the shaft is")
        arm = number_of("position", position) - self.assembly.shaft.mass_position
        return self.shaft_position + arm * (self.shaft_axis - [0.0, 0.0, 1.0])

    @property
    def turned_over(self) -> tuple[str, ...]:
        """Names of the bearings whose results are in axes turned over against those of the shaft; none if it is unknown."""
        return () if self.assembly is None else self.assembly.turned_over

    @property
    def _signs(self) -> Array:
        """Signs of the shaft's axes in those of the first bearing: it may sit the other way round."""
        turned = self.assembly is not None and self.assembly.bearings[0].side > 0.0
        return np.array([1.0, -1.0, -1.0]) if turned else np.ones(3)

    @property
    def _axis(self) -> Array:
        """Direction of the axis in the first bearing's axes, shape (T, 3)."""
        turn = self._first.ring_tilt
        across = np.column_stack([np.tan(turn[:, 1]), -np.tan(turn[:, 0]), np.ones(len(turn))])
        return across / np.linalg.norm(across, axis=1)[:, None]

    @property
    def energy(self) -> EnergyAudit:
        """The audit of all bearings and the shaft together; what passes between them is left out."""
        terms: dict[str, Array] = {}
        for result in self._bearings.values():
            for field in result.fields:
                if field.group == "energy" and result[field.name].ndim == 1:
                    terms[field.name] = terms.get(field.name, 0.0) + result[field.name]
        return energy_audit(terms)


def whole(each: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Numbers of a shaft of the summaries of its bearings: sums, the smallest, or what is the same for all."""
    found = {
        row.name: of_whole(row.together, (values.get(row.name) for values in each.values()))
        for row in numbers.rows()
        if row.together
    }
    return {name: value for name, value in found.items() if value is not None}


@overload
def load(path: str | os.PathLike[str], *, bearing: str) -> Result: ...


@overload
def load(path: str | os.PathLike[str]) -> Any: ...


def load(path: str | os.PathLike[str], *, bearing: str = "") -> Any:
    """Load a result file.

    Parameters
    ----------
    path : path-like
        A file written by a run.
    bearing : str
        Name of a bearing in the file of several; by default all of them are loaded.

    Returns
    -------
    Result or AssemblyResult
        Its fields are read when they are asked for. If the run was cut off, ``success`` is False and the records up to
        the last write are there.

    Raises
    ------
    FileError
        If the file is missing, damaged, of another kind or of a later version.
    """
    from trbdyn.results.file_source import assembly_in

    table = None if bearing else assembly_in(path)
    if table is None:
        return load_bearing(path, bearing)
    assembly = None if table["assembly"] is None else Assembly.from_dict(table["assembly"])
    return AssemblyResult({name: load_bearing(path, name) for name in table["bearings"]}, assembly)
