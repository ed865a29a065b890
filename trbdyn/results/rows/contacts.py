"""Numbers of the contacts of the rollers with the rings: loads, pressures, films."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Final

import numpy as np

from trbdyn.results.fields import ALWAYS, contacts, table
from trbdyn.results.number import NOWHERE, Number, Place, Seen

GROUPS: Final = {field.name: field.group for field in table()}
"""Group of each field."""
RACEWAYS: Final = ("outer", "inner")
"""Contacts that always carry."""


def _extreme(peak: str, smallest: bool, seen: Seen) -> tuple[float, float] | None:
    """The extreme of the run at the ends of all its steps, not that of its records, and its time (s)."""
    peaks = seen.peaks
    if peak not in peaks:
        return None
    values = np.atleast_1d(peaks[peak])
    if np.isnan(values).all():
        return None
    at = int(np.nanargmin(values) if smallest else np.nanargmax(values))
    return float(values.flat[at]), float(np.atleast_1d(peaks[f"{peak}_time"]).flat[at])


def _part(place: int, peak: str, smallest: bool, seen: Seen) -> float | None:
    found = _extreme(peak, smallest, seen)
    return None if found is None else found[place]


def always(seen: Seen) -> bool:
    return True


def extreme(
    name: str,
    words: str,
    unit: str,
    meaning: str,
    *,
    peak: str = "",
    smallest: bool = False,
    exists: Callable[[Seen], bool] = always,
    least: float = 0.0,
    shown: frozenset[Place] = NOWHERE,
    pictures: tuple[str, ...] = (),
    together: Any = "",
    checked: bool = False,
) -> Iterator[Number]:
    """Two rows: an extreme of the run, and when it was."""
    value = partial(_part, 0, peak or name, smallest)
    time = partial(_part, 1, peak or name, smallest)
    common: dict[str, Any] = {"of": "run", "groups": ("peaks",), "exists": exists}
    kind: Any = "smallest" if smallest else "largest"
    yield Number(
        name,
        words,
        unit,
        meaning,
        value,
        kind,
        **common,
        least=least,
        shown=shown,
        pictures=pictures,
        together=together,
        checked=checked,
    )
    yield Number(f"{name}_time", "    at", "s", "When that was.", time, "time", **common)


def carries(side: str) -> Callable[[Seen], bool]:
    """Whether a bearing has a contact that carries a load at any time of a run; raceways and the back rib are always shown."""
    if side in ALWAYS:
        return always

    def found(seen: Seen) -> bool:
        if "peaks" in seen.run.groups:
            peak = f"{side}_load_peak"
            return peak in seen.peaks and bool(seen.peaks[peak].any())
        return f"{side}_load" in seen.run and bool(seen.run[f"{side}_load"].any())

    return found


def _load(side: str, seen: Seen) -> float | None:
    """Mean over time and rollers: of time integrals between the ends of steps, or of the records."""
    window, mean = seen.window, f"{side}_load_mean"
    if mean in window:
        return float(window.peak(mean).mean())
    return float(window[f"{side}_load"].mean()) if f"{side}_load" in window else None


def _film(side: str, seen: Seen) -> float | None:
    """Mean weighted by load; None: the thickness of a film that carries nothing has no meaning."""
    window = seen.window
    if f"{side}_film_parameter" not in window:
        return None
    values, load = window[f"{side}_film_parameter"], window[f"{side}_load"]
    total = float(load.sum())
    return float((values * load).sum() / total) if total > 0.0 else None


LOADS: Final = tuple(
    Number(
        f"{side}_load_mean",
        f"load a roller, {place}",
        "N",
        f"Mean load of a roller at the {place}.",
        partial(_load, side),
        groups=(f"{GROUPS[f'{side}_load']}|peaks",),
        exists=carries(side),
        interval="load",
        least=0.1,
        shown=frozenset({"page"}) if side == "outer" else NOWHERE,
        pictures=("contact_loads",) if side == "outer" else (),
        checked=side in ALWAYS,
    )
    for side, place in contacts().items()
)
"""Rows of the loads of each contact."""

PRESSURES: Final = tuple(
    row
    for side, place in contacts().items()
    for row in extreme(
        f"{side}_pressure_max",
        f"largest pressure in the run, {place}",
        "Pa",
        f"Largest Hertz pressure at the {place}.",
        peak=f"{side}_pressure_peak",
        exists=carries(side),
        checked=side in RACEWAYS,
        shown=frozenset(
            {"inner": {"report", "shaft"}, "outer": {"band"}}.get(side, set())  # type: ignore[arg-type]
        ),
    )
)
"""Rows of the largest pressures."""

FILMS: Final = tuple(
    Number(
        f"film_parameter_{side}",
        f"film parameter, {place}",
        "",
        f"Film thickness over roughness at the {place}; from effects.friction.lambda_full on, the film carries all.",
        partial(_film, side),
        groups=(GROUPS[f"{side}_load"],),
        exists=carries(side),
        interval="load",
        together="smallest",
        checked=side in RACEWAYS,
        shown=frozenset(
            {"inner": {"report", "band"}, "outer": {"page"}, "rib": {"band"}}.get(side, set())  # type: ignore[arg-type]
        ),
    )
    for side, place in contacts().items()
) + tuple(
    row
    for side, place in contacts().items()
    for row in extreme(
        f"film_parameter_{side}_min",
        f"smallest film parameter in the run, {place}",
        "",
        f"The thinnest film over roughness at the {place}, at any moment of the run.",
        peak=f"{side}_film_parameter_min",
        smallest=True,
        exists=carries(side),
        together="smallest",
        shown=frozenset({"result"}) if side == "outer" else NOWHERE,
    )
)
"""Rows of the films."""
