"""How long to run, how accurately, and what to keep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Literal, get_args

from pydantic import BeforeValidator, Field

from trbdyn.base.validation import Model, Number, Whole, unit
from trbdyn.errors import InputError
from trbdyn.model.core_table import SETTINGS, setting
from trbdyn.model.motion import MAX_TIME
from trbdyn.model.shaft import time_to_turn
from trbdyn.results.observables.slow_motion import LIMITS
from trbdyn.results.observables.starts import COMPARED
from trbdyn.run.until import CAGE

if TYPE_CHECKING:
    from trbdyn.model.assembly import Assembly
    from trbdyn.model.scene import Scene
    from trbdyn.statics.seat import Seating

Group = Literal[
    "time",
    "cage",
    "rollers",
    "contacts",
    "pocket",
    "ring",
    "housing",
    "outer_ribs",
    "torque",
    "power",
    "energy",
    "peaks",
]
GROUPS: Final[tuple[Group, ...]] = get_args(Group)


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

    rtol: Annotated[Number, setting("rtol", "1")]
    atol_position: Annotated[Number, setting("atol_position", "m")]
    atol_angle: Annotated[Number, setting("atol_angle", "rad")]
    atol_velocity: Annotated[Number, setting("atol_velocity", "m/s")]
    atol_spin: Annotated[Number, setting("atol_spin", "rad/s")]


ACCURACY: Final = {
    "fast": Tolerances(rtol=3e-3, atol_position=3e-9, atol_angle=3e-7, atol_velocity=1e-3, atol_spin=0.1),
    "standard": Tolerances(**{name: SETTINGS[name].default for name in Tolerances.model_fields}),
    "reference": Tolerances(rtol=1e-4, atol_position=6e-11, atol_angle=6e-9, atol_velocity=2e-5, atol_spin=2e-3),
}
"""Presets, chosen on the front that benchmarks/work_precision.py draws; ``standard`` has the defaults of the core."""

RINGS_SHARE: Final = {"fast": 0.1, "standard": SETTINGS["rings_share"].default, "reference": 0.03}
"""`RunOptions.rings_share` of the presets: so small that the loss of accuracy cannot be seen."""

IMPACT_SHARE: Final = {"fast": 0.1, "standard": SETTINGS["impact_share"].default, "reference": 0.01}
"""`RunOptions.impact_share` of the presets."""

OF_ONE_RUN: Final = ("revolutions", "duration", "until", "save_every", "save_groups")
"""Fields of `RunOptions` that belong to one run: how long it is, and what it keeps."""


def _wanted(until: Any) -> Any:
    """The name of the cage's motion alone, with the limit of an orbit."""
    if isinstance(until, str) and until != CAGE:
        raise ValueError(f"must be '{CAGE}', or shares by the names of averages, such as {{'torque': 0.01}}")
    return {CAGE: LIMITS[COMPARED]} if until == CAGE else until


class RunOptions(Model):
    """How long to run, how accurately, and what to keep.

    Parameters
    ----------
    revolutions : float, optional
        Length of the run in turns of the shaft; not together with `duration`, and not where a torque drives the shaft: its
        speed then follows from the run.
    duration : float, optional
        Length of the run (s).
    until : dict of str to float
        The run ends earlier, when the 95 % confidence intervals of these averages of the summary are narrow enough: largest half
        width over the average, by name, for instance ``{"torque": 0.01}``. The name 'cage': when the cage's motion has settled
        and its orbit is known within this share of Cpr; ``"cage"`` alone stands for 0.05. Empty: it never does.
    save_every : float, optional
        Time between saved records (s); by default that of `trbdyn.run.keeping`, 32 records a turn of the shaft.
    save_groups : sequence of str
        Groups of quantities to save; 'time' is always among them. By default all of which there is something, but contacts and
        pocket in runs of more than 20 000 records. With 'peaks' the core looks at all loads at the end of every
        step and keeps their extremes, means and impacts over each record's interval and the whole run; without it that costs
        nothing.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances, `ACCURACY`.
    integrator : {'auto', 'multirate', 'bdf', 'erk'}
        'multirate': backward differentiation (BDF) of order 2 in which each roller that touches nothing takes steps of its own,
        for one bearing whose rings are held or follow. 'bdf': CVODE's BDF, which takes one step for all bodies and can run every
        scene. 'erk': an explicit Runge-Kutta method of ARKODE for cross-checks. 'auto': 'multirate' where it can run the scene,
        else 'bdf'; simulations and results name the one that was taken (docs/theory/multirate.md#which-scenes).
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
    until: Annotated[dict[str, Annotated[Number, unit("1", gt=0, lt=1)]], BeforeValidator(_wanted)] = Field(
        default_factory=dict
    )
    save_every: Annotated[Number | None, unit("s", gt=0)] = None
    save_groups: Annotated[tuple[Group, ...], Field(min_length=1)] = GROUPS
    accuracy: Literal["fast", "standard", "reference"] = "standard"
    integrator: Literal["auto", "multirate", "bdf", "erk"] = "auto"
    rtol: Annotated[Number, setting("rtol", "1")] | None = None
    atol_position: Annotated[Number, setting("atol_position", "m")] | None = None
    atol_angle: Annotated[Number, setting("atol_angle", "rad")] | None = None
    atol_velocity: Annotated[Number, setting("atol_velocity", "m/s")] | None = None
    atol_spin: Annotated[Number, setting("atol_spin", "rad/s")] | None = None
    max_order: Annotated[Whole, setting("max_order", "1")] = int(SETTINGS["max_order"].default)
    max_step: Annotated[Number, setting("max_step", "s", ge=0)] = 0.0
    first_step: Annotated[Number, setting("first_step", "s")] = SETTINGS["first_step"].default
    rings_share: Annotated[Number, setting("rings_share", "1")] | None = None
    impact_share: Annotated[Number, setting("impact_share", "1")] | None = None
    checkpoint_every: Annotated[Number, unit("s", ge=1e-9)] | None = None
    when_wrong: Literal["stop", "go_on"] = "stop"

    _root: ClassVar[str | None] = "run"

    def _check(self) -> None:
        if self.revolutions is not None and self.duration is not None:
            raise InputError.of("duration", self.duration, "must not be given together with revolutions (s)")

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

    def of_simulation(self) -> dict[str, Any]:
        """What belongs to the simulation and not to one of its runs: the other fields than `OF_ONE_RUN`, as `Simulation` takes
        them; without those that have their default.
        """
        default = type(self)()
        names = [name for name in type(self).model_fields if name not in OF_ONE_RUN]
        return {name: getattr(self, name) for name in names if getattr(self, name) != getattr(default, name)}

    def end_time(self, subject: Scene | Assembly | Seating, start: float = 0.0) -> float:
        """When the run ends (s).

        Parameters
        ----------
        subject : Scene, Assembly or Seating
            What is run: turns are counted by its speed.
        start : float
            When it starts (s).

        Raises
        ------
        InputError
            If neither revolutions nor duration is given, the shaft never turns that often or is driven by a torque, or the run
            would end too late.
        """
        if self.duration is not None:
            field, value, unit, length = "duration", self.duration, " (s)", self.duration
        elif self.revolutions is not None:
            if subject.torque is not None:
                allowed = "must not be given where a torque drives the shaft: its speed follows from the run; give duration (s)"
                raise InputError.of(("run", "revolutions"), self.revolutions, allowed)
            field, value, unit = "revolutions", self.revolutions, ""
            length = time_to_turn(self.revolutions, subject.turning_rpm, start)
        else:
            raise InputError.of(("run", "revolutions"), None, "must be given, or duration (s)")
        if not start < start + length <= MAX_TIME:
            allowed = f"must end the run after its start at {start:g} s, and not later than at {MAX_TIME:g} s{unit}"
            raise InputError.of(("run", field), value, allowed)
        return start + length
