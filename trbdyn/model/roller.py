"""A tapered roller: sizes, profile of its generator, deviations of its diameter."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.extras import of_extras
from trbdyn.base.reading import read_input_text
from trbdyn.base.validation import Model, Number, Whole, unit
from trbdyn.errors import InputError
from trbdyn.model.assumed import ISO_SHORT, RIG
from trbdyn.model.core_table import parameter
from trbdyn.model.material import Material

MOST_ROWS, MOST_COLUMNS = 10_000, 50
"""Most lines and columns of a table of a profile."""


class Profile(Model):
    """Shape of a generator, of the roller or of a raceway; only the numbers of its kind are used.

    Parameters
    ----------
    kind : {'iso', 'logarithmic', 'crowned', 'straight', 'table'}
        ISO: the general form of ISO/TS 16281 (DIN 26281), drop a_p Dwe ln{1/[1 - ((2 abs(y) - d_p)/c_p)^k_p]} for 2 abs(y) >
        d_p. Logarithmic: drop A ln{1/[1 - (1 - exp(-zm/A)) ((abs(y) - a)/(k2 a) + 1)^2]} for abs(y) > a - k2 a with A = 2 k1
        Q/(pi L E'), a = L/2. Table: `drops` over `stations`.
    crown_radius : float
        Radius of the arc of a crowned generator (m).
    k1, k2 : float
        Constants of the logarithmic profile (1).
    zm : float
        Drop of the logarithmic profile at the end (m).
    load : float
        Design load Q of the logarithmic profile (N); by default the one of the 30310 rig times diameter and length of
        the roller over those of the rig, that is at the same pressure.
    a_p, k_p : float
        Factor of the roller's diameter, and exponent, of the ISO profile (1); by default those of the standard: 0.00045 for
        tapered rollers, 0.00035 for cylindrical ones up to 2.5 diameters long, 0.0005 for longer ones; 2.
    c_p, d_p : float
        Length over which the ISO profile drops, both ends together, and length of its straight middle (m); by default those of
        the standard: the effective length and 0, of longer cylindrical rollers 2.5 diameters and the rest.
    stations, drops : sequence of float
        Places from mid length towards the large end (m), rising, over the whole effective length, and the drop there (m), two or
        more. Between them a monotone cubic (SciPy's ``PchipInterpolator``).

    Notes
    -----
    0.00035 with the factor Dwe for rollers up to 2.5 Dwe is what the package `tribology` has as DIN 26281; the numbers of
    longer and of tapered rollers are quoted, without a printed copy of ISO 16281 (docs/theory/geometry.md#roller-profile).
    """

    _assumed: ClassVar[bool] = True

    kind: Literal["iso", "logarithmic", "crowned", "straight", "table"] = "iso"
    crown_radius: Annotated[Number, parameter("crown_radius")] = 100.0
    k1: Annotated[Number, parameter("profile_k1")] = 1.5
    k2: Annotated[Number, parameter("profile_k2")] = 0.4
    zm: Annotated[Number, parameter("profile_zm")] = 10e-6
    load: Annotated[Number, parameter("profile_load")] = RIG["load"]
    a_p: Annotated[Number, parameter("profile_a")] = ISO_SHORT
    c_p: Annotated[Number, parameter("profile_c")] = RIG["effective_length"]
    d_p: Annotated[Number, parameter("profile_d")] = 0.0
    k_p: Annotated[Number, parameter("profile_k")] = 2.0
    stations: tuple[Annotated[Number, unit("m", ge=-1, le=1)], ...] = ()
    drops: tuple[Annotated[Number, unit("m", ge=-1e-3, le=1e-3)], ...] = ()

    def _check(self) -> None:
        if self.kind != "table":
            return
        if len(self.stations) < 2 or np.any(np.diff(self.stations) <= 0.0):
            raise InputError.of("stations", self.stations, "must be two or more rising places (m)")
        if len(self.drops) != len(self.stations):
            raise InputError.of("drops", self.drops, f"must have one entry for each station, {len(self.stations)} (m)")

    @classmethod
    def straight(cls) -> Self:
        """A straight generator."""
        return cls(kind="straight")

    @classmethod
    def crowned(cls, radius: float) -> Self:
        """An arc of this radius (m)."""
        return cls(kind="crowned", crown_radius=radius)

    @classmethod
    def logarithmic(cls, load: float | None = None, *, k1: float = 1.5, k2: float = 0.4, zm: float = 10e-6) -> Self:
        """A logarithmic profile for a design load (N); without it the one that the roller's size gives."""
        given = {} if load is None else {"load": load}
        return cls(kind="logarithmic", k1=k1, k2=k2, zm=zm, **given)

    @classmethod
    def iso(
        cls,
        *,
        a_p: float | None = None,
        c_p: float | None = None,
        d_p: float | None = None,
        k_p: float | None = None,
    ) -> Self:
        """The profile of ISO/TS 16281, or its general form with these constants (1, m, m, 1)."""
        given = {"a_p": a_p, "c_p": c_p, "d_p": d_p, "k_p": k_p}
        return cls(kind="iso", **{name: value for name, value in given.items() if value is not None})

    @classmethod
    def table(cls, stations: Sequence[float], drops: Sequence[float]) -> Self:
        """Measured drops (m) at places from mid length (m)."""
        return cls(kind="table", stations=tuple(stations), drops=tuple(drops))

    @classmethod
    def from_csv(cls, path: str | PathLike[str]) -> Self:
        """Measured drops from a CSV file, whose first line names its columns: ``station_mm`` or ``station_m``, and
        ``drop_um`` or ``drop_m``.

        Raises
        ------
        InputError
            If the file cannot be read or lacks a column.
        """
        text = read_input_text(path, "CSV")
        lines = text.splitlines()
        if lines and (lines[0].count(",") > MOST_COLUMNS or len(lines) > MOST_ROWS):
            limit = f"must be a CSV file of at most {MOST_COLUMNS} columns and {MOST_ROWS} lines"
            raise InputError.of("path", str(path), limit)
        try:
            found = np.atleast_1d(np.genfromtxt(lines, delimiter=",", names=True, dtype=float))
        except ValueError as error:
            raise InputError.of("path", str(path), f"must be a CSV file of numbers: {error}") from None
        columns = []
        for names in ({"station_mm": 1e-3, "station_m": 1.0}, {"drop_um": 1e-6, "drop_m": 1.0}):
            name = next((one for one in names if one in (found.dtype.names or ())), None)
            if name is None:
                raise InputError.of("path", str(path), f"must have a column {' or '.join(names)}")
            columns.append((names[name] * found[name]).tolist())
        return cls.table(*columns)

    @classmethod
    def from_trace(cls, path: str | PathLike[str], effective_length: float, **how: Any) -> Self:
        """The profile of a measured trace (CSV) or of a drawn line (DXF), by `trbdyn.read_trace`, whose arguments it takes.

        Parameters
        ----------
        path : path-like
            CSV or DXF file.
        effective_length : float
            Effective length of the contact line (m).
        **how
            Units, levelling, filter and direction, as in `trbdyn.read_trace`.

        Raises
        ------
        InputError
            If an argument is not allowed, or does not fit to the file.
        FileError
            If the file cannot be read or used.
        """
        trace = of_extras("read_trace")(path, effective_length, **how)
        return cls.table(trace.stations.tolist(), trace.drops.tolist())


class Scatter(Model):
    """Random deviations of the rollers' diameters.

    Parameters
    ----------
    range : float
        Width of the range (m): each deviation is uniform over -range/2 to range/2.
    seed : int
        Seed of the random numbers.
    """

    range: Annotated[Number, unit("m", ge=0, le=1e-3)]
    seed: Annotated[Whole, unit("1", ge=0)]

    def draw(self, count: int) -> NDArray[np.float64]:
        """The deviations (m), shape (count,): the same ones for the same seed."""
        return np.random.default_rng(self.seed).uniform(-0.5 * self.range, 0.5 * self.range, count)


class Roller(Model):
    """A tapered roller; a cylindrical one where the half angle of the cup is zero.

    Parameters
    ----------
    diameter : float
        Dwe, diameter at mid length, perpendicular to the roller's axis (m).
    effective_length : float
        Lwe, effective length of the contact line (m).
    total_length : float
        Length over the ends, centred on the effective length (m); by default the effective length and a fourteenth of
        the diameter.
    density : float
        Density (kg/m3).
    profile : Profile
        Shape of the generator.
    diameter_deviation : sequence of float, optional
        Deviation of each roller's diameter (m), one a roller; not together with `diameter_scatter`.
    diameter_scatter : Scatter, optional
        Random deviations, one for each roller.
    sphere_ratio : float
        Radius of the large end's sphere over the distance from the apex to the large end (1); assumed.
    end_radius : float
        Radius of the sphere of the large end, of a cylindrical roller of both ends (m). By default 0 for a tapered one, whose
        radius follows from `sphere_ratio`; 50 times the diameter for a cylindrical one; assumed.
    end_stiffness : float
        k of roller end against a flat of the ring, force = k d^1.5 (N/m^1.5); against the cage's walls in the ratio of
        the composite moduli. By default 1e10 times the root of the diameter over that of the 30310 rig; assumed.
    material : Material, optional
        Elasticity of the rollers; that of the bearing by default.
    """

    _assumed: ClassVar[bool] = True

    diameter: Annotated[Number, parameter("roller_diameter")]
    effective_length: Annotated[Number, parameter("effective_length")]
    total_length: Annotated[Number, parameter("total_length")] = RIG["total_length"]
    density: Annotated[Number, parameter("roller_density")] = 7810.0
    profile: Profile = Profile()
    diameter_deviation: tuple[Annotated[Number, unit("m", ge=-1e-3, le=1e-3)], ...] | None = None
    diameter_scatter: Scatter | None = None
    sphere_ratio: Annotated[Number, parameter("sphere_ratio")] = 0.90
    end_radius: Annotated[Number, parameter("end_radius")] = 0.0
    end_stiffness: Annotated[Number, parameter("end_stiffness")] = RIG["end_stiffness"]
    material: Material | None = None

    def _check(self) -> None:
        if "total_length" in self.model_fields_set and self.total_length < self.effective_length:
            limit = f"must be >= effective_length, {self.effective_length:g} (m)"
            raise InputError.of("total_length", self.total_length, limit)
        if self.diameter_deviation is not None and self.diameter_scatter is not None:
            raise InputError.of(
                "diameter_scatter", self.diameter_scatter, "must not be given together with diameter_deviation"
            )
