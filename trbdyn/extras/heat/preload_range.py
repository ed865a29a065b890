"""`trbdyn.preload_range`: life, stiffness, torque and temperature over the end play at which bearings are mounted, with the range
of the longest lives marked (docs/theory/fits.md#preload-over-temperature).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, TrbError
from trbdyn.extras.heat.paths import HeatPaths
from trbdyn.extras.heat.preload_over import AtTemperature, preload_over
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.mounting import Mounting
from trbdyn.model.on_shaft import ShaftBearing
from trbdyn.model.scene import Scene
from trbdyn.standards.sheet import life_text

GOOD: Final = 0.9
"""Life over the longest one from which on an end play is in the best range."""


@dataclass(frozen=True)
class AtPlay:
    """One row.

    Attributes
    ----------
    play : float
        End play or radial clearance as mounted, at the mountings' reference temperature (m); negative: preload.
    found : AtTemperature or None
        Play of operation, loads, lives, torque, stiffness and temperatures; None where there is no stable balance.
    said : str
        Why a number is missing.
    """

    play: float
    found: AtTemperature | None
    said: str = ""

    @property
    def life_hours(self) -> float | None:
        """The life that counts the most of what acts: Lnmrh, else L10h (h)."""
        if self.found is None:
            return None
        modified = self.found.modified_reference_life_hours
        return self.found.life_hours if modified is None else modified


@dataclass(frozen=True, repr=False)
class PreloadRange(Tabled):
    """Life, stiffness, torque and temperature over the end play; print it for a table, in which the best range is marked.

    Attributes
    ----------
    rows : tuple of AtPlay
        For each end play or clearance, ascending.
    best : tuple of float, or None
        From which to which play the life is at least nine tenths of the longest one (m), of those that were tried; None where no
        life is known.
    title : str
        What it is of.
    """

    rows: tuple[AtPlay, ...]
    best: tuple[float, float] | None
    title: str

    def _shown(self) -> Shown:
        rows: list[tuple[str, ...]] = []
        for row in self.rows:
            marked = "best" if self.best is not None and self.best[0] <= row.play <= self.best[1] else ""
            at = row.found
            if at is None:
                rows.append((f"{1e6 * row.play:.4g}", *("-",) * 8, marked))
                continue
            hottest = max(max(one.inner_ring_c, one.outer_ring_c) for one in at.temperatures.values())
            preload = [f"{sheet.axial_load:.4g}" for sheet in at.sheets.values()]
            stiff = [None if value is None else 1e-6 * value for value in (at.axial_stiffness, at.radial_stiffness)]
            rows.append(
                (
                    f"{1e6 * row.play:.4g}",
                    ", ".join(f"{1e6 * play:.4g}" for play in at.plays.values()),
                    " ".join(preload) or "-",
                    life_text(at.life_hours),
                    life_text(at.modified_reference_life_hours),
                    *("-" if value is None else f"{value:.4g}" for value in (*stiff, at.torque)),
                    f"{hottest:.4g}",
                    marked,
                )
            )
        head = (
            "mounted um",
            "in operation um",
            "Fa N",
            "L10h h",
            "Lnmrh h",
            "axial N/um",
            "radial N/um",
            "torque N m",
            "ring C",
            "",
        )
        notes = tuple(dict.fromkeys(f"{1e6 * row.play:.4g} um: {row.said}" for row in self.rows if row.said))
        if self.best is not None:
            low, high = (1e6 * play for play in self.best)
            ends = {self.rows[0].play, self.rows[-1].play} & set(self.best)
            edge = "; it may go on beyond what was tried" if ends else ""
            near = f"where the life is within {100.0 * (1.0 - GOOD):.0f} % of the longest"
            notes = (f"best: {low:.4g} to {high:.4g} um, {near}{edge}", *notes)
        return Shown(f"Life and stiffness over the mounted play: {self.title}", tuple(rows), head, (*notes, NOTE))


NOTE: Final = (
    "Negative play is preload. Plays are means over the tolerances; the torque is that of the contacts in ideal rolling. The "
    "range goes by life alone: stiffness and heat stand beside it."
)


def preload_range(
    subject: Subject,
    mounting: Mounting | Mapping[str, Mounting],
    plays: Sequence[float],
    *,
    temperature: float = 20.0,
    paths: HeatPaths | Mapping[str, HeatPaths] | None = None,
    **oil: Any,
) -> PreloadRange:
    """Life, stiffness, torque and temperature over the end play at which bearings are mounted, with the best range marked.

    Each row is one of `trbdyn.preload_over`: fits and temperatures make of the mounted play that of operation.

    Parameters
    ----------
    subject : Assembly or Scene
        Tapered bearings on a shaft, whose end play in sum is changed, in equal parts of all bearings without a spring; or one
        cylindrical bearing, whose radial clearance before mounting is, in place of `Mounting.clearance`.
    mounting : Mounting, or mapping of str to Mounting
        How each bearing is mounted.
    plays : sequence of float
        End plays or clearances at the mountings' reference temperature (m); negative: preload.
    temperature : float
        That of all parts (C); with `paths` that of everything outside.
    paths : HeatPaths, or mapping of str to HeatPaths, optional
        With them the parts' temperatures are those at which bearings give off the heat that they make.
    **oil
        Cleanliness and others of `trbdyn.rating`.

    Returns
    -------
    PreloadRange
        Prints as a table.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> gear = trb.ShaftLoad(position=0.15, force=(0.0, -9000.0, 2000.0))
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "face to face", spread=0.3, shaft=shaft, speed_rpm=1500,
    ...                          loads=[gear], lubricant="vg68")
    >>> seat = trb.Mounting(bore=0.050, outside=0.110, width=0.02925, shaft="m6", housing="H7")
    >>> found = trb.preload_range(pair, seat, [-40e-6, 0.0, 80e-6], temperature=60.0)
    >>> found.rows[0].found.axial_stiffness > found.rows[2].found.axial_stiffness
    True
    """
    expect("subject", subject, Scene, Assembly)
    given = sorted({number_of(f"plays[{k}]", one) for k, one in enumerate(plays)})
    if not given:
        raise InputError.of("plays", plays, "must be one play or more (m)")
    if not all(math.isfinite(one) for one in given):
        raise InputError.of("plays", plays, "must be finite (m)")
    rows = []
    for play in given:
        try:
            found = preload_over(*_mounted(subject, mounting, play), [temperature], paths=paths, **oil).rows[0]
        except TrbError as error:
            if not isinstance(error, InputError) or error.field.endswith(("end_play", "radial_clearance")):
                rows.append(AtPlay(play, None, str(error).splitlines()[0]))
                continue
            raise
        rows.append(AtPlay(play, found, found.said))
    return PreloadRange(tuple(rows), _best(rows), subject.title)


def _mounted(subject: Subject, mounting: Any, play: float) -> tuple[Subject, Any]:
    """The subject and how it is mounted, with another play."""
    free = [
        prefix
        for prefix, part in subject.parts.items()
        if isinstance(part, ShaftBearing) and part.spring is None and not part.bearing.is_cylindrical
    ]
    for prefix in free:
        subject = subject.with_part(prefix, end_play=play / len(free))
    if free:
        return subject, mounting
    if isinstance(subject, Scene) and subject.bearing.is_cylindrical:
        expect("mounting", mounting, Mounting)
        return subject, mounting.replace(clearance=(play, play))  # fits begin with that of the mounting
    limit = "must be an Assembly with a tapered bearing without a spring, or a Scene of a cylindrical bearing, which have a play"
    raise InputError.of("subject", subject.title, limit)


def _best(rows: Sequence[AtPlay]) -> tuple[float, float] | None:
    """The range of plays around that of the longest life in which the life is nearly as long."""
    lives = [row.life_hours or 0.0 for row in rows]
    longest = max(lives, default=0.0)
    if not longest > 0.0:
        return None
    low = high = lives.index(longest)
    while low > 0 and lives[low - 1] >= GOOD * longest:
        low -= 1
    while high < len(rows) - 1 and lives[high + 1] >= GOOD * longest:
        high += 1
    return rows[low].play, rows[high].play
