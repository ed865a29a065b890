"""How long to run, how accurately, and what to keep."""

from __future__ import annotations

from typing import Annotated, ClassVar, Final, Literal, Self

from pydantic import Field, model_validator

from trbdyn.base.validation import Length, Model, Number, Whole, unit
from trbdyn.errors import InputError
from trbdyn.model.motion import MAX_TIME, History

Group = Literal["time", "cage", "rollers", "contacts", "pocket", "ring", "torque", "power", "energy", "peaks"]
GROUPS: Final[tuple[Group, ...]] = (
    "time",
    "cage",
    "rollers",
    "contacts",
    "pocket",
    "ring",
    "torque",
    "power",
    "energy",
    "peaks",
)


class Tolerances(Model):
    """Error that the integrator allows in a step: relative, and absolute per kind of quantity.

    Parameters
    ----------
    rtol : float
        Relative tolerance (1).
    atol_position : float
        Positions (m).
    atol_angle : float
        Angles (rad).
    atol_velocity : float
        Velocities (m/s).
    atol_spin : float
        Angular velocities (rad/s).
    """

    rtol: Annotated[Number, unit("1", gt=0, le=0.1)]
    atol_position: Length
    atol_angle: Annotated[Number, unit("rad", gt=0)]
    atol_velocity: Annotated[Number, unit("m/s", gt=0)]
    atol_spin: Annotated[Number, unit("rad/s", gt=0)]


ACCURACY: Final = {
    "fast": Tolerances(rtol=3e-3, atol_position=3e-9, atol_angle=3e-7, atol_velocity=1e-3, atol_spin=0.1),
    "standard": Tolerances(rtol=1e-3, atol_position=9e-10, atol_angle=9e-8, atol_velocity=3e-4, atol_spin=3e-2),
    "reference": Tolerances(rtol=1e-4, atol_position=6e-11, atol_angle=6e-9, atol_velocity=2e-5, atol_spin=2e-3),
}
"""Presets, chosen on the front that benchmarks/work_precision.py draws."""

RINGS_SHARE: Final = {"fast": 0.1, "standard": 0.1, "reference": 0.03}
"""`RunOptions.rings_share` of the presets: so small that the loss of accuracy cannot be seen."""

IMPACT_SHARE: Final = {"fast": 0.1, "standard": 0.03, "reference": 0.01}
"""`RunOptions.impact_share` of the presets."""


class RunOptions(Model):
    """How long to run, how accurately, and what to keep.

    Parameters
    ----------
    revolutions : float, optional
        Length of the run in turns of the shaft; not together with `duration`.
    duration : float, optional
        Length of the run (s).
    save_every : float
        Time between saved records (s).
    save_groups : sequence of str
        Groups of quantities to save; 'time' is always among them. With 'peaks' the core looks at all loads at the end of every
        step and keeps their extremes, means and impacts over each record's interval and the whole run; without it that costs
        nothing.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances, `ACCURACY`.
    integrator : {'bdf', 'erk'}
        CVODE's BDF, or an explicit Runge-Kutta method of ARKODE for cross-checks.
    rtol, atol_position, atol_angle, atol_velocity, atol_spin : float, optional
        Take the place of the preset's tolerances (1, m, rad, m/s, rad/s).
    max_order : int
        Largest order of BDF; above 2 the lightly damped vibrations of contacts force it to small steps.
    max_step, first_step : float
        Largest and first step (s); 0: chosen by the integrator.
    rings_share : float, optional
        Share of a step's tolerance by which forces of raceways and ribs may be wrong (1): between exact evaluations BDF takes
        them from tangents, one for each roller, whose error is measured at the next exact evaluation. 0: forces are always
        exact; by default that of the preset, `RINGS_SHARE`.
    impact_share : float, optional
        Share of an impact's speed and interference that roller and cage may be off in a step: where they meet gently, their
        absolute tolerances are so much smaller (1). By default that of the preset, `IMPACT_SHARE`.
    checkpoint_every : float, optional
        Bearing time between checkpoints (s): at the first step that ends at or after each multiple of it the integrator is
        started again, so the schedule is a part of the run as the tolerances are. A run that writes a result file can be resumed
        from them.
    when_wrong : {'stop', 'go_on'}
        What to do with a run whose energy is wrong by more than a tenth, or which makes no progress (`trbdyn.run.watch`): end it
        with ``success=False``, or go on with a warning.
    """

    revolutions: Annotated[Number, unit("1", gt=0)] | None = None
    duration: Annotated[Number, unit("s", gt=0)] | None = None
    save_every: Annotated[Number, unit("s", gt=0)] = 1e-4
    save_groups: Annotated[tuple[Group, ...], Field(min_length=1)] = GROUPS
    accuracy: Literal["fast", "standard", "reference"] = "standard"
    integrator: Literal["bdf", "erk"] = "bdf"
    rtol: Annotated[Number, unit("1", gt=0, le=0.1)] | None = None
    atol_position: Length | None = None
    atol_angle: Annotated[Number, unit("rad", gt=0)] | None = None
    atol_velocity: Annotated[Number, unit("m/s", gt=0)] | None = None
    atol_spin: Annotated[Number, unit("rad/s", gt=0)] | None = None
    max_order: Annotated[Whole, unit("1", ge=1, le=5)] = 2
    max_step: Annotated[Number, unit("s", ge=0)] = 0.0
    first_step: Annotated[Number, unit("s", ge=0)] = 0.0
    rings_share: Annotated[Number, unit("1", ge=0, le=1)] | None = None
    impact_share: Annotated[Number, unit("1", ge=1e-4, le=1e3)] | None = None
    checkpoint_every: Annotated[Number, unit("s", ge=1e-9)] | None = None
    when_wrong: Literal["stop", "go_on"] = "stop"

    _root: ClassVar[str | None] = "run"

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.revolutions is not None and self.duration is not None:
            raise InputError.of("duration", self.duration, "must not be given together with revolutions (s)")
        return self

    @property
    def tolerances(self) -> Tolerances:
        """The preset's tolerances, with those that are given in their place."""
        given = {name: getattr(self, name) for name in Tolerances.model_fields}
        return ACCURACY[self.accuracy].replace(**{name: value for name, value in given.items() if value is not None})

    def settings(self) -> dict[str, float | str]:
        """Settings of the core's integrator."""
        chosen = {} if self.max_step == 0.0 else {"max_step": self.max_step}
        return {
            "integrator": self.integrator,
            **self.tolerances.model_dump(),
            "max_order": float(self.max_order),
            "first_step": self.first_step,
            "rings_share": RINGS_SHARE[self.accuracy] if self.rings_share is None else self.rings_share,
            "impact_share": IMPACT_SHARE[self.accuracy] if self.impact_share is None else self.impact_share,
            **chosen,
        }

    def end_time(self, speed_rpm: float | History, start: float = 0.0) -> float:
        """When the run ends (s).

        Parameters
        ----------
        speed_rpm : float or History
            Speed of the shaft.
        start : float
            When it starts (s).

        Raises
        ------
        InputError
            If neither revolutions nor duration is given, the shaft never turns that often, or the run would end too late.
        """
        if self.duration is not None:
            field, value, unit, length = "duration", self.duration, " (s)", self.duration
        elif self.revolutions is not None:
            field, value, unit = "revolutions", self.revolutions, ""
            length = _time_to_turn(self.revolutions, speed_rpm, start)
        else:
            raise InputError.of(("run", "revolutions"), None, "must be given, or duration (s)")
        if not start < start + length <= MAX_TIME:
            allowed = f"must end the run after its start at {start:g} s, and not later than at {MAX_TIME:g} s{unit}"
            raise InputError.of(("run", field), value, allowed)
        return start + length


def _time_to_turn(revolutions: float, speed_rpm: float | History, start: float) -> float:
    """How long the shaft takes for a number of turns, one way or the other (s)."""
    if not isinstance(speed_rpm, History):
        if speed_rpm == 0.0:
            raise InputError.of(("run", "revolutions"), revolutions, "the shaft stands still; give duration (s)")
        return 60.0 * revolutions / abs(speed_rpm)
    last = max(speed_rpm.times[-1], start)

    def turns(end: float) -> float:
        return abs(speed_rpm.integral(start, end)) / 60.0

    if turns(last) < revolutions:
        end = last + 1.0
        if turns(end) <= turns(last):
            raise InputError.of(
                ("run", "revolutions"), revolutions, "the shaft does not turn that often; give duration (s)"
            )
        return last - start + (revolutions - turns(last)) / (turns(end) - turns(last))
    low, high = start, last
    while high - low > 1e-15 * max(abs(high), 1e-9):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if turns(middle) < revolutions else (low, middle)
    return high - start
