"""Ratings of several bearings on one shaft, and of all together."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from trbdyn.base.shown import Shown
from trbdyn.model.scene import Scene
from trbdyn.standards.loading import Loading, at_equilibrium, changes
from trbdyn.standards.sheet import LIVES, WHICH_LIFE, Fitted, Rating, life_text, sheet
from trbdyn.standards.spectrum import SpectrumRating
from trbdyn.statics.assembly import BearingOnShaft, ShaftEquilibrium

ROWS_OF_ISO_281: Final = 27.0 / 20.0
"""Exponent e with which rows of equal loads live i^(-1/e) times as long as one: that of C = i^(7/9) C1 and P = i P1 in
L = (C/P)^(10/3) (ISO 281:2007, 7.1)."""
WEIBULL_SLOPE: Final = 9.0 / 8.0
"""The same where life goes with the fourth power of load, as in ISO 16281: the slope of the distribution of lives of roller
bearings, ISO/TR 1281-1:2008, from which i^(7/9) comes."""
SLOPES: Final = {
    "life_hours": ROWS_OF_ISO_281,
    "modified_life_hours": ROWS_OF_ISO_281,
    "reference_life_hours": WEIBULL_SLOPE,
    "modified_reference_life_hours": WEIBULL_SLOPE,
}
"""Exponents of the lives of a sheet."""


@dataclass(frozen=True)
class SystemRating(Fitted):
    """Sheets of the bearings of an assembly, and the lives of the whole: none of its bearings has failed.

    Attributes
    ----------
    bearings : dict of str to Rating or SpectrumRating
        Sheet of each bearing, by its name.
    life_hours, modified_life_hours : float or None
        Basic and modified rating life of the whole (h); None where it is infinite or a bearing has none.
    reference_life_hours, modified_reference_life_hours : float or None
        The same with the reference lives of ISO 16281 (h).
    fits : Fit or None
        How the bearings sit on the shaft and in the housing, where the ratings are those of `trbdyn.fit`.
    """

    bearings: Mapping[str, Rating | SpectrumRating]
    life_hours: float | None
    modified_life_hours: float | None
    reference_life_hours: float | None
    modified_reference_life_hours: float | None

    def _shown(self) -> Shown:
        def row(name: str, one: Rating | SpectrumRating | SystemRating, *loads: str) -> tuple[str, ...]:
            lives = [getattr(one, life) for life in LIVES]
            return (name, *(loads or ("", "", "")), *map(life_text, lives))

        head = ("bearing", "Fa N", "Fr N", "P N", "L10h h", "Lnmh h", "L10rh h", "Lnmrh h")
        rows = [
            row(name, one, f"{one.axial_load:.5g}", f"{one.radial_load:.5g}", f"{one.equivalent_load:.5g}")
            for name, one in self.bearings.items()
        ]
        said = tuple(f"{name}: {text}" for name, one in self.bearings.items() for text in one.warnings)
        worst = (f"{name}: {one.worst}" for name, one in self.bearings.items() if isinstance(one, SpectrumRating))
        if cases := ", ".join(worst):
            said = (f"P is the steady load with the same life; Fa and Fr are those of the worst case, {cases}.", *said)
        return Shown(
            "ratings and lives",
            (head, *rows, row("all", self)),
            head=head,
            notes=(*said, WHICH_LIFE),
            parts=self.fit_tables,
        )


def system_life(lives: Sequence[float | None], slope: float) -> float | None:
    """Life that all of some bearings or rows reach with the same reliability: (sum L^-e)^(-1/e) with the slope e; None: infinite.

    Reliabilities multiply, and each is exp(-(L/L_c)^e). With the slope `ROWS_OF_ISO_281` equal rows have the life that ISO 281
    gives by i^(7/9).

    Examples
    --------
    >>> from trbdyn.standards.system import ROWS_OF_ISO_281, system_life
    >>> round(system_life([1000.0, 1000.0], ROWS_OF_ISO_281)), round(1000.0 * (2.0 ** (7.0 / 9.0) / 2.0) ** (10.0 / 3.0))
    (598, 598)
    """
    total = sum(life**-slope for life in lives if life is not None and life < math.inf)
    return float(total ** (-1.0 / slope)) if total > 0.0 else None


def system_sheet(found: ShaftEquilibrium, **options: Any) -> SystemRating:
    """Sheets of all bearings of a shaft in equilibrium; see `trbdyn.rating`."""
    return system_of({name: sheet(scene, one, **options) for name, (scene, one) in loadings_of(found).items()})


def loadings_of(found: ShaftEquilibrium) -> dict[str, tuple[Scene, Loading]]:
    """Scene and loads of each bearing of a shaft in equilibrium, by its name."""
    said = changes(found.assembly.quantities(), found.time)
    return {one.name: (one.scene, replace(_loading_of(one), said=said)) for one in found.bearings}


def system_of(sheets: Mapping[str, Rating | SpectrumRating]) -> SystemRating:
    """The sheets of all bearings of a shaft, and the lives of the whole."""
    lives: dict[str, Any] = {}
    for life in LIVES:
        found = [getattr(one, life) for one in sheets.values()]
        # a life that cannot be told, though the bearing is loaded and turns
        lacks = any(own is None and one.life_hours is not None for own, one in zip(found, sheets.values(), strict=True))
        lives[life] = None if lacks else system_life(found, SLOPES[life])
    return SystemRating(bearings=sheets, **lives)


def _loading_of(one: BearingOnShaft) -> Loading:
    """What a bearing's sheet stands on: the loads of the shaft on it, and the laminas where its ring stands."""
    laminas = at_equilibrium(one.scene)
    return Loading(
        axial_load=one.axial_load,
        radial_load=one.radial_load,
        speed_rpm=laminas.speed_rpm,
        lamina_loads=laminas.lamina_loads,
        largest_pressure=laminas.largest_pressure,
        source="equilibrium of the shaft on its bearings",
    )
