"""Surfaces off their true form: pits, measured depth maps and waviness of raceways and rollers."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, ClassVar, Final, Literal

from pydantic import Field

from trbdyn.base.validation import Length, Model, Number, Whole, unit
from trbdyn.errors import InputError

On = Literal["outer", "inner", "roller"]
"""The surface: the outer raceway, the inner one, or a roller's flank."""
MAX_DEPTH: Final = 1e-3
"""Largest depth or height (m): load and film are those of surfaces that are smooth but for it."""
MAX_ORDER: Final = 500
MOST_POINTS: Final = 2000


def _check_roller(on: str, roller: int | None) -> None:
    if roller and on != "roller":
        raise InputError.of("roller", roller, f"must not be given: on = {on!r}")


class Pit(Model):
    """A pit with steep walls and a flat ground, as a spall leaves it: on a raceway or a roller.

    A roller bridges it: it sinks in only as far as its curvature, and that of the race, allow
    (docs/theory/contacts.md#surfaces-off-their-true-form).

    Parameters
    ----------
    on : {'outer', 'inner', 'roller'}
        The surface that has it.
    length : float
        Length along the direction of rolling (m).
    width : float
        Width across it, along the roller (m).
    depth : float
        Depth (m).
    angle_deg : float
        Place of its middle (deg). On a ring: about the bearing's axis, from +x towards +y where the ring has not turned; a radial
        load acts at 90 by default, and a defect of a ring at rest where no roller is loaded is warned of. On a
        roller: about its axis, from the side that is away from the bearing's axis where the roller has not turned, in the sense
        of a positive rotation about the axis, which points to the large end.
    position : float
        Place of its middle along the roller, from mid length towards the large end (m).
    roller : int
        Number of the roller, from 0; only of a pit on a roller.

    Raises
    ------
    InputError
        If a number is not allowed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> pit = trb.Pit(on="outer", length=1.5e-3, width=6e-3, depth=30e-6, angle_deg=90.0)
    >>> scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0, defects=(pit,))
    >>> scene.defects[0].kind
    'pit'
    """

    _root: ClassVar[str | None] = "defects"

    kind: Literal["pit"] = "pit"
    on: On
    length: Length
    width: Length
    depth: Annotated[Number, unit("m", gt=0, le=MAX_DEPTH)]
    angle_deg: Annotated[Number, unit("deg")] = 0.0
    position: Annotated[Number, unit("m")] = 0.0
    roller: Annotated[Whole, unit("1", ge=0)] = 0

    def _check(self) -> None:
        _check_roller(self.on, self.roller)


class DepthMap(Model):
    """The depth of a surface on a grid, as measured: a pit of any shape, a dent with its raised edges, a scratch.

    Between points of the grid the depth is bilinear, beyond them zero.

    Parameters
    ----------
    on : {'outer', 'inner', 'roller'}
        The surface that has it.
    along : tuple of float, shape (n,)
        Places along the direction of rolling, from the middle given by `angle_deg`, ascending (m).
    across : tuple of float, shape (k,)
        Places along the roller, from mid length towards the large end, ascending (m).
    depth : tuple of tuple of float, shape (n, k)
        Depth at each of them, negative: height (m). It must be zero at the first and the last place along rolling, where the map
        ends.
    angle_deg, roller : float, int
        As of a `Pit`.

    Raises
    ------
    InputError
        If a number is not allowed, or the shapes do not fit together.

    Examples
    --------
    >>> import trbdyn as trb
    >>> dent = trb.DepthMap(
    ...     on="inner",
    ...     along=(-6e-4, -3e-4, 0.0, 3e-4, 6e-4),
    ...     across=(-3e-3, 3e-3),
    ...     depth=((0.0, 0.0), (-1e-6, -1e-6), (2e-5, 2e-5), (-1e-6, -1e-6), (0.0, 0.0)),
    ... )
    >>> dent.kind
    'map'
    """

    _root: ClassVar[str | None] = "defects"

    kind: Literal["map"] = "map"
    on: On
    along: Annotated[tuple[Number, ...], unit("m"), Field(min_length=3, max_length=MOST_POINTS)]
    across: Annotated[tuple[Number, ...], unit("m"), Field(min_length=2, max_length=MOST_POINTS)]
    depth: Annotated[tuple[tuple[Annotated[Number, unit("m", ge=-MAX_DEPTH, le=MAX_DEPTH)], ...], ...], unit("m")]
    angle_deg: Annotated[Number, unit("deg")] = 0.0
    roller: Annotated[Whole, unit("1", ge=0)] = 0

    def _check(self) -> None:
        _check_roller(self.on, self.roller)
        for name in ("along", "across"):
            places = getattr(self, name)
            for i, (before, after) in enumerate(pairwise(places)):
                if not after > before:
                    raise InputError.of((name, i + 1), after, f"must be > the place before it, {before:g} (m)")
        if len(self.depth) != len(self.along):
            limit = f"must have {len(self.along)} rows, one for each place along rolling"
            raise InputError.of("depth", len(self.depth), limit)
        for i, row in enumerate(self.depth):
            if len(row) != len(self.across):
                raise InputError.of(
                    ("depth", i), len(row), f"must have {len(self.across)} numbers, one for each place across"
                )
        for i in (0, len(self.along) - 1):
            if any(self.depth[i]):
                raise InputError.of(("depth", i), self.depth[i], "must be 0: the map ends there (m)")


class Waviness(Model):
    """Waves round a surface: its depth is the sum of ``amplitude cos(order (angle + phase))``.

    Parameters
    ----------
    on : {'outer', 'inner', 'roller'}
        The surface that has it.
    orders : tuple of int, shape (n,)
        Waves round the surface.
    amplitudes : tuple of float, shape (n,)
        Amplitude of each: half of the distance between crest and valley (m).
    seed : int
        Of the phases, which are drawn at random, for each roller on its own.
    phases_deg : tuple of float, shape (n,), optional
        Phases in place of those: angle by which the deepest place of each order lies before the angle zero of the surface (deg).
    roller : int, optional
        Number of the roller; by default all rollers have waves. Only of waves on rollers.

    Raises
    ------
    InputError
        If a number is not allowed, or the shapes do not fit together.

    Examples
    --------
    >>> import trbdyn as trb
    >>> waves = trb.Waviness(on="inner", orders=(15, 16, 17), amplitudes=(2e-7, 2e-7, 2e-7), seed=3)
    >>> scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=3000, axial_load=4930.0, defects=(waves,))
    >>> len(scene.defects)
    1
    """

    _root: ClassVar[str | None] = "defects"

    kind: Literal["waviness"] = "waviness"
    on: On
    orders: Annotated[
        tuple[Annotated[Whole, unit("1", ge=1, le=MAX_ORDER)], ...], Field(min_length=1, max_length=MAX_ORDER)
    ]
    amplitudes: tuple[Annotated[Number, unit("m", gt=0, le=MAX_DEPTH)], ...]
    seed: Annotated[Whole, unit("1", ge=0)] = 0
    phases_deg: tuple[Annotated[Number, unit("deg")], ...] | None = None
    roller: Annotated[Whole | None, unit("1", ge=0)] = None

    def _check(self) -> None:
        for name in ("amplitudes", "phases_deg"):
            given = getattr(self, name)
            if given is not None and len(given) != len(self.orders):
                raise InputError.of(name, len(given), f"must have {len(self.orders)} numbers, one for each order")
        if self.roller is not None and self.on != "roller":
            raise InputError.of("roller", self.roller, f"must not be given: on = {self.on!r}")


Defect = Annotated[Pit | DepthMap | Waviness, Field(discriminator="kind")]
