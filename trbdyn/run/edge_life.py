"""`trbdyn.edge_life`: the reference life with the pressures of half spaces, beside that with the standard's factor for edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.display import displayed
from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.model.scene import Scene
from trbdyn.results.result import Result
from trbdyn.run.contact_pressure import RACES, contacts_of, one_contact
from trbdyn.standards.lamina import LAMINAS, LaminaLoads
from trbdyn.standards.loading import lamina_loads, turning_against_load
from trbdyn.standards.sheet import contact_ratings

Array = NDArray[np.float64]

RECORDS: Final = 6
"""Records of a run, at most: each has the contacts of all rollers on both raceways."""


@dataclass(frozen=True, repr=False)
class EdgeLife(Tabled):
    """Basic reference rating lives L10r of ISO 16281, by three ways to count the ends of rollers. Prints as a table.

    Attributes
    ----------
    with_factor : float
        With the factor f_k of the standard on the loads of slices (million revolutions).
    without : float
        With the loads of slices alone (million revolutions).
    with_pressures : float
        With the pressures of half spaces (million revolutions).
    largest_pressure : float
        Largest pressure of half spaces (Pa).
    contacts, sharp, records : int
        Contacts that carry a load and were computed, how many of them press with a sharp edge, and moments.
    """

    with_factor: float
    without: float
    with_pressures: float
    largest_pressure: float
    contacts: int
    sharp: int
    records: int

    def _shown(self) -> Shown:
        turns = "million revolutions"
        rows = (
            ("L10r, factor f_k", f"{self.with_factor:.4g}", turns, "slices times f_k of ISO/TS 16281:2008, 4.3.2"),
            ("L10r, no factor", f"{self.without:.4g}", turns, "slices alone"),
            ("L10r, half spaces", f"{self.with_pressures:.4g}", turns, "pressures that feel each other and the ends"),
            ("largest pressure", *displayed(self.largest_pressure, "Pa"), "of half spaces"),
        )
        title = f"Reference life by {self.contacts} contacts at {self.records} moment{'s' if self.records > 1 else ''}"
        note = (
            f"{self.sharp} of the contacts press with a sharp edge: their pressures rise, and the life with them falls, the "
            "shorter the cells are."
        )
        return Shown(title=title, rows=rows, notes=(note,) if self.sharp else ())


def edge_life(subject: Scene | Result, **how: Any) -> EdgeLife:
    """L10r of ISO 16281 with the pressures of half spaces in place of the factor f_k for edges.

    A lamina counts with the load under which a line contact would have its pressure by Hertz, as the standard allows where the
    pressure is known.

    Parameters
    ----------
    subject : Scene or Result
        Of a scene the equilibrium at its start, of a result up to six records of its settled part.
    **how
        `free_ends`, `mirrored` and `cells` of `trbdyn.contact_pressure`.

    Raises
    ------
    InputError
        If an argument is not allowed or a group is missing.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.edge_life(trb.cases.scene_32216(), cells=(16, 64))
    >>> 0.5 < found.with_pressures / found.with_factor < 2.0
    True
    """
    expect("subject", subject, Scene, Result)
    scene = subject.scene if isinstance(subject, Result) else subject
    slices, pressed, largest, contacts, sharp = [], [], 0.0, 0, 0
    times = _moments(subject)
    for time in times:
        _, found, when = contacts_of(subject, time)
        slices.append(lamina_loads(scene, found))
        loads = np.zeros_like(slices[-1])
        for raceway, race in RACES.items():
            for roller in np.flatnonzero(found["raceway_load"][race].sum(axis=-1) > 0.0).tolist():
                one = one_contact(scene, found, raceway, roller, when, **how)
                loads[race, roller] = one.equivalent_loads(LAMINAS)
                largest, contacts = max(largest, one.largest), contacts + 1
                sharp += any(one.sharp_edges)
        pressed.append(loads)
    ratings, turning = contact_ratings(scene), turning_against_load(scene)

    def life(loads: list[Array], *, edges: bool) -> float:
        return LaminaLoads.of(np.concatenate(loads, axis=1), ratings, turning=turning, edges=edges).reference_life

    return EdgeLife(
        with_factor=life(slices, edges=True),
        without=life(slices, edges=False),
        with_pressures=life(pressed, edges=False),
        largest_pressure=largest,
        contacts=contacts,
        sharp=sharp,
        records=len(times),
    )


def _moments(subject: Scene | Result) -> list[float | None]:
    if isinstance(subject, Scene):
        return [None]
    times = np.asarray(subject["time"])
    first = int(np.searchsorted(times, subject.settling().time)) if times.size > 2 else 0
    chosen = np.linspace(min(first, times.size - 1), times.size - 1, RECORDS).round().astype(int)
    return [float(times[k]) for k in np.unique(chosen)]
