"""A scene: one bearing, what acts on it, and how it starts."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import model_validator

from trbdyn.bearing import Bearing
from trbdyn.effects import Effects
from trbdyn.errors import MISSING, InputError, Path
from trbdyn.lubricants import Lubricant, vg100
from trbdyn.motion import MAX_TIME, History, Quantity, is_constant, knot_times, value_at, values_of
from trbdyn.validation import Model, Number, Whole, unit

MAX_SPEED_RPM = 1e6
MAX_GRAVITY = 1e7
"""Largest part of gravity (m/s2), a million times the usual: no machine shakes harder, and nothing overflows."""


class Start(Model):
    """How a run starts; made by `equal`, `unequal`, `whirl` or `state`. Rollers and cage always start in pure rolling.

    Parameters
    ----------
    kind : {'equal', 'unequal', 'whirl', 'state'}
        Equal: rollers equally spaced. Unequal: seeded random spacing. Whirl: the cage off centre and whirling, rollers
        centred in their pockets. State: a saved state.
    seed : int
        Unequal: seed of the random numbers.
    spread : float
        Unequal: each roller is off its even place by up to this share of the circumferential play, either way (1).
    eccentricity : float
        Whirl: distance of the cage's centre from the bearing axis, in units of the radial play Cpr (1).
    direction_deg : float
        Whirl: where the cage's centre starts, from +x towards +y (deg).
    time : float
        State: the time it belongs to (s).
    state_vector : sequence of float
        State: the numbers of the core's state vector.
    """

    kind: Literal["equal", "unequal", "whirl", "state"] = "equal"
    seed: Annotated[Whole, unit("1", ge=0)] = 0
    spread: Annotated[Number, unit("1", ge=0, le=1)] = 0.8
    eccentricity: Annotated[Number, unit("1", ge=0, le=1)] = 0.9
    direction_deg: Annotated[Number, unit("deg")] = -90.0
    time: Annotated[Number, unit("s", ge=-MAX_TIME, le=MAX_TIME)] = 0.0
    state_vector: tuple[Number, ...] = ()

    @model_validator(mode="after")
    def _check(self) -> Self:
        if (self.kind == "state") != bool(self.state_vector):
            allowed = (
                "must be given for a start from a state"
                if self.kind == "state"
                else "belongs to a start from a state only"
            )
            raise InputError.of("state_vector", self.state_vector, allowed)
        return self

    @classmethod
    def equal(cls) -> Self:
        """Rollers equally spaced, the cage at rest on them."""
        return cls(kind="equal")

    @classmethod
    def unequal(cls, seed: int, *, spread: float = 0.8) -> Self:
        """Rollers at random places within their pockets, the cage at rest on them.

        Parameters
        ----------
        seed : int
            Seed of the random numbers.
        spread : float
            Largest share of the circumferential play that a roller is off its even place (1).
        """
        return cls(kind="unequal", seed=seed, spread=spread)

    @classmethod
    def whirl(cls, eccentricity: float = 0.9, *, direction_deg: float = -90.0) -> Self:
        """The cage whirling with its own rotation, rollers centred in their pockets.

        Parameters
        ----------
        eccentricity : float
            Distance of the cage's centre from the bearing axis, in units of Cpr (1).
        direction_deg : float
            Direction of the cage's centre from +x towards +y (deg).
        """
        return cls(kind="whirl", eccentricity=eccentricity, direction_deg=direction_deg)

    @classmethod
    def state(cls, vector: ArrayLike, *, time: float = 0.0) -> Self:
        """A saved state vector, shape (n_state,), and its time (s)."""
        try:
            numbers = np.asarray(vector, dtype=np.float64).ravel().tolist()
        except (TypeError, ValueError, OverflowError):
            raise InputError.of(("start", "state_vector"), vector, "must be a vector of numbers") from None
        return cls(kind="state", state_vector=tuple(numbers), time=time)


class Scene(Model):
    """One bearing, what acts on it, and how it starts. Every quantity is a number or a `History`.

    Frame: origin at the common apex of the cones; z along the bearing axis towards the rollers' large ends; positive
    speed about +z. Loads act on the inner ring.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    speed_rpm : float or History
        Speed of the inner ring (rpm).
    axial_load : float or History
        Axial load Fa (N), presses the inner ring towards -z; must be > 0 unless `displacement` is given.
    radial_load : float or History
        Magnitude of the radial load Fr (N).
    radial_direction_deg : float or History
        Direction of the radial load on the inner ring, from +x towards +y (deg); 90: loaded zone on top.
    misalignment_x, misalignment_y : float or History
        Rotation of the inner ring about x and y, through the roller-centre plane (rad).
    moment_x, moment_y : float or History, optional
        Moment on the inner ring about x or y (N m): the ring's rotation follows from it and must not be prescribed.
    displacement : tuple of float or History, shape (3,), optional
        Position of the inner ring along x, y, z (m), in place of loads.
    lubricant : Lubricant
        The oil.
    effects : Effects
        Switches and choices; `Effects.standard` by default.
    start : Start
        How a run starts.
    ring : {'held', 'follows'}
        Held: the ring stays at its equilibrium at the start, as in the paper. Follows: it moves through the equilibria
        of its load history.
    gravity : tuple of float or History, shape (3,)
        Acceleration of gravity (m/s2), each part from -1e7 to 1e7; acts if `effects.gravity`.

    Raises
    ------
    InputError
        If anything is wrong or does not fit together.
    """

    _root: ClassVar[str | None] = ""

    bearing: Bearing
    speed_rpm: Annotated[Quantity, unit("rpm")]
    axial_load: Annotated[Quantity, unit("N")] = 0.0
    radial_load: Annotated[Quantity, unit("N")] = 0.0
    radial_direction_deg: Annotated[Quantity, unit("deg")] = 90.0
    misalignment_x: Annotated[Quantity, unit("rad")] = 0.0
    misalignment_y: Annotated[Quantity, unit("rad")] = 0.0
    moment_x: Annotated[Quantity | None, unit("N m")] = None
    moment_y: Annotated[Quantity | None, unit("N m")] = None
    displacement: tuple[Quantity, Quantity, Quantity] | None = None
    lubricant: Lubricant = vg100()
    effects: Effects = Effects()
    start: Start = Start()
    ring: Literal["held", "follows"] = "held"
    gravity: tuple[Quantity, Quantity, Quantity] = (0.0, -9.80665, 0.0)

    def __init__(self, bearing: Any = MISSING, **fields: Any) -> None:
        super().__init__(**fields if bearing is MISSING else {"bearing": bearing, **fields})

    def __hash__(self) -> int:
        return hash(self.fingerprint)

    @property
    def moments(self) -> tuple[float | History | None, float | History | None]:
        """Moments about x and y (N m); None where the ring's rotation is prescribed."""
        return self.moment_x, self.moment_y

    def ring_quantities(self) -> list[float | History]:
        """Everything that the ring's equilibrium depends on."""
        moments = [moment for moment in self.moments if moment is not None]
        shift = list(self.displacement or ())
        turns = [self.misalignment_x, self.misalignment_y]
        load = [self.axial_load, self.radial_load, self.radial_direction_deg]
        return [*load, *moments, *turns, *shift, self.speed_rpm, *self.gravity]

    @model_validator(mode="after")
    def _check(self) -> Self:
        self._check_motion()
        self._check_load()
        self._check_start()
        if self.effects.films and self.effects.rolling_resistance and self.lubricant.pressure_coefficient <= 0.0:
            raise InputError.of(
                ("lubricant", "pressure_coefficient"),
                0.0,
                "must be > 0 for rolling resistance; or switch that off (1/Pa)",
            )
        from trbdyn.flatten import parameter_block

        parameter_block(self)
        return self

    def _check_motion(self) -> None:
        speed = max(values_of(self.speed_rpm), key=abs)
        if abs(speed) > MAX_SPEED_RPM:
            raise InputError.of("speed_rpm", speed, f"must be from {-MAX_SPEED_RPM:g} to {MAX_SPEED_RPM:g} (rpm)")
        for place, quantity in enumerate(self.gravity):
            pull = max(values_of(quantity), key=abs)
            if abs(pull) > MAX_GRAVITY:
                raise InputError.of(
                    ("gravity", place), pull, f"must be from {-MAX_GRAVITY:g} to {MAX_GRAVITY:g} (m/s2)"
                )
        largest = math.radians(5.0)
        for axis, moment, turn in (
            ("x", self.moment_x, self.misalignment_x),
            ("y", self.moment_y, self.misalignment_y),
        ):
            if moment is not None and turn != 0.0:
                raise InputError.of(
                    f"moment_{axis}", moment, f"must not be given together with misalignment_{axis} (N m)"
                )
            angle = max(values_of(turn), key=abs)
            if abs(angle) > largest:
                raise InputError.of(
                    f"misalignment_{axis}", angle, f"must be from {-largest:.4g} to {largest:.4g} (rad)"
                )
        if self.displacement is not None:
            limit = self.bearing.roller.diameter
            for place, quantity in enumerate(self.displacement):
                shift = max(values_of(quantity), key=abs)
                if abs(shift) > limit:
                    raise InputError.of(("displacement", place), shift, f"must be from {-limit:g} to {limit:g} (m)")

    def _check_load(self) -> None:
        loads: list[tuple[str, float | History]] = [("axial_load", self.axial_load), ("radial_load", self.radial_load)]
        for name, load in loads:
            _check_sign(name, load)
            if self.displacement is not None and any(values_of(load)):
                raise InputError.of(name, load, "must be 0 where displacement is given (N)")
        free = [
            ("moment_x", self.moment_x),
            ("moment_y", self.moment_y),
            ("radial_direction_deg", self.radial_direction_deg),
            *loads,
        ]
        for name, quantity in free:
            if quantity is not None and self.ring == "held" and not is_constant(quantity):
                raise InputError.of(name, quantity, "must be constant where the ring is held; set ring = 'follows'")
        if self.displacement is not None:
            return
        slope = math.tan(math.radians(self.bearing.cup_half_angle_deg))
        for time in knot_times([self.axial_load, self.radial_load]):
            axial, radial = value_at(self.axial_load, time), value_at(self.radial_load, time)
            when = "" if is_constant(self.axial_load) and is_constant(self.radial_load) else f" at {time:g} s"
            if axial <= 0.0:
                raise InputError.of(
                    "axial_load", axial, f"must be > 0{when}: nothing else holds rollers and rings together (N)"
                )
            if radial * slope >= axial:
                limit = f"must be < {axial / slope:.6g}{when}: axial_load / tan(cup half angle), all it can carry (N)"
                raise InputError.of("radial_load", radial, limit)

    def _check_start(self) -> None:
        if self.start.kind == "whirl" and self.effects.bodies == "rollers":
            path: Path = ("start", "kind")
            raise InputError.of(path, "whirl", "needs a cage: effects.bodies = 'rollers_and_cage'")


def _check_sign(name: str, load: float | History) -> None:
    for place, value in enumerate(values_of(load)):
        if value < 0.0:
            raise InputError.of(
                (name, "values", place) if isinstance(load, History) else name, value, "must be >= 0 (N)"
            )
