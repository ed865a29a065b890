"""A simulation: a scene, the state it is in, and what steps it on."""

from __future__ import annotations

import contextlib
import copy
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Generic, Literal, NoReturn, Self, TypeVar, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn import _core
from trbdyn.base.own_files import output_path
from trbdyn.base.shown import Displayed, Shown, field_rows
from trbdyn.base.validation import Model, number_of
from trbdyn.errors import MISSING, InputError, Problem, StepError
from trbdyn.model.assembly import Assembly, assembly_of
from trbdyn.model.motion import MAX_TIME
from trbdyn.model.scene import Scene
from trbdyn.model.start import State as State
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.run.controlled import Controlled
from trbdyn.run.estimate import Estimate, estimate
from trbdyn.run.inputs import Inputs, give, put_back
from trbdyn.run.keeping import groups_of, kept_by_default
from trbdyn.run.options import Group, RunOptions
from trbdyn.run.running import Callback, Run, output_times
from trbdyn.run.system import system_of
from trbdyn.run.watch import Account
from trbdyn.statics.equilibrium import Equilibrium
from trbdyn.statics.plausible import UnusualInput
from trbdyn.statics.seat import SeatedBearing, Seating
from trbdyn.statics.seating import seated

Array = NDArray[np.float64]
R = TypeVar("R", Result, AssemblyResult)


class Simulation(Displayed, Generic[R]):
    """Simulates a scene, or bearings on one shaft, in time.

    Parameters
    ----------
    subject : Scene, Assembly or Seating
        What is simulated. An assembly begins in its equilibrium at speed; a seating gives the place of the shaft.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.
    instruction_set : str
        Kernel variant: 'scalar', 'base', 'avx2', 'avx512'; by default the fastest that this machine runs. Results of
        two variants differ in rounding.
    **options
        Fields of `RunOptions` that set the integrator: integrator, rtol, atol_position, atol_angle, atol_velocity,
        atol_spin, max_order, max_step, first_step, rings_share, impact_share, checkpoint_every.

    Raises
    ------
    InputError
        If the subject or an option cannot be used.
    LoadError
        If a bearing cannot carry the load.

    Warns
    -----
    UnusualInput
        If numbers are allowed but unlikely to be intended; the texts are kept in `warnings` and in the result's notes.

    Notes
    -----
    docs/theory/motion.md#bearings-on-one-shaft has the equations of several bearings. Quantities of
    several bearings are given by the names of the bearings.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000)
    >>> result = trb.Simulation(pair).run(revolutions=0.05)
    >>> sorted(result), result.success
    (['left', 'right'], True)
    """

    @overload
    def __init__(
        self: Simulation[Result], subject: Scene, *, accuracy: str = ..., instruction_set: str = ..., **options: Any
    ) -> None: ...

    @overload
    def __init__(
        self: Simulation[AssemblyResult],
        subject: Assembly | Seating,
        *,
        accuracy: str = ...,
        instruction_set: str = ...,
        **options: Any,
    ) -> None: ...

    @overload
    def __init__(
        self, subject: Scene | Assembly, *, accuracy: str = ..., instruction_set: str = ..., **options: Any
    ) -> None: ...

    def __init__(
        self,
        subject: Scene | Assembly | Seating,
        *,
        accuracy: str = "standard",
        instruction_set: str = "",
        **options: Any,
    ) -> None:
        self.options = RunOptions(accuracy=accuracy, **options)
        self.subject = subject
        self._seated = seated(subject, instruction_set)
        self.bearings = self._seated.bearings
        self.warnings = tuple(f"{one.said}{text}" for one in self.bearings for text in one.unusual)
        for text in self.warnings:
            warnings.warn(text, UnusualInput, stacklevel=2)
        self._running = False
        self._totals: dict[str, float] = {}
        self._counted: dict[str, int] = {}
        self._accounts: dict[str, Account] = {}
        self._inputs: Inputs | None = None
        self.memory = {}
        self._begin(self._seated.time, self._seated.vector)
        self._reached = self._seated.time

    def __repr__(self) -> str:
        return f"<Simulation: {self._title}; at {self.time:g} s, accuracy {self.options.accuracy!r}>"

    def _shown(self) -> Shown:
        rows: list[tuple[str, ...]] = [("time", f"{self.time:g}", "s", "bearing time that it has reached")]
        rows += [row for row in field_rows(self.options) if row[0] in self.options.settings() or row[0] == "accuracy"]
        scenes = tuple(
            replace(one.scene._shown(), title=f"{one.name or 'scene'}: {one.scene.title}") for one in self.bearings
        )
        return Shown(f"Simulation: {self._title}", tuple(rows), notes=self.warnings, parts=scenes)

    @property
    def _title(self) -> str:
        return ", ".join(f"{one.said}{one.scene.title}" for one in self.bearings)

    @property
    def scene(self) -> Scene:
        """The scene; of several bearings that of the first one, which has the speed of the shaft."""
        return self.bearings[0].scene

    @property
    def assembly(self) -> Assembly | None:
        """What several bearings sit on; None for one bearing, and where seats were given in place of an assembly."""
        return assembly_of(self.subject)

    @property
    def equilibrium(self) -> Equilibrium:
        """Rollers and ring at the start; of several bearings those of the first one."""
        return self.bearings[0].equilibrium

    def _of_each(self, value: Callable[[SeatedBearing], Any]) -> Any:
        """A value of one bearing, or of several by their names."""
        alone = not self.bearings[0].name
        return value(self.bearings[0]) if alone else {one.name: value(one) for one in self.bearings}

    warnings: tuple[str, ...]
    memory: dict[str, Any]
    """Numbers that a callback keeps from call to call; states, copies and checkpoints have them, too."""
    _end: State | None
    """Where a run has ended, inside the integrator's last step; None where the present state is the end of that
    step.
    """
    _accounts: dict[str, Account]
    """What the watch over its runs has seen of each bearing since it began, or since a state was set."""

    def _open(self, time: float, vector: Array) -> _core.Simulation:
        if not abs(time) <= MAX_TIME:
            raise InputError.of("time", time, f"must be from {-MAX_TIME:g} to {MAX_TIME:g} (s)")
        first = self.scene.start.time
        if time < first and self._seated.moves:
            raise InputError.of("time", time, f"must be >= {first:g}, the start: histories are known from there on (s)")
        return self._seated.open(time, vector, self.options.settings())

    def _begin_with(self, bearings: tuple[SeatedBearing, ...], inputs: Inputs) -> None:
        """Go on from the present state with other inputs."""
        state = self.state
        before = self._seated
        self._seated = replace(before, bearings=bearings)
        try:
            core = self._open(state.time, state.vector)
        except BaseException:
            self._seated = before
            raise
        self._count()
        self._core, self._begun, self._end = core, state.time, None
        self._put(bearings, inputs)

    def _put(self, bearings: tuple[SeatedBearing, ...], inputs: Inputs) -> None:
        """Have other inputs in force in what is opened next."""
        self.bearings, self._inputs = bearings, inputs
        self._seated = replace(self._seated, bearings=bearings)

    def _begin(self, time: float, vector: Array) -> None:
        """Make a new integrator, without any history: as in a new process."""
        self._core = self._open(time, vector)
        # a run, its result and its checkpoints name the integrator that is used
        self.options = self.options.replace(integrator=self._core.integrator)
        self._begun = time
        self._end = None

    def _stand_at(self, time: float) -> None:
        """What a user reads is at an instant of the last step. The integrator stays at that step's end and goes on
        from there. Where a callback has gone on after that instant, or has set a state, the present state is that one.
        """
        self._end = None
        if time != self._core.time:
            with contextlib.suppress(_core.CoreInputError):
                self._end = State(time, self._core.state_at(time))

    def _begin_again(self) -> None:
        """Start a new integrator at the place of the present one; what was counted is kept."""
        self._count()
        self._begin(self._core.time, self._core.state())

    def _count(self) -> None:
        """Keep what was counted before a new integrator takes the place of the present one."""
        counted, totals = self.counters, self.statistics
        self._counted = counted
        if self._core.statistics()["steps"] > 0:
            self._totals = totals

    @property
    def time(self) -> float:
        """Time of the present state (s): the end of the last run, or of the last step within a run or after `step`.

        The integrator's last step may end later than the run. The present state is that step's solution at the
        run's end; the next run or step goes on from the step's own end, so that a run in pieces takes the steps of the
        whole run.
        """
        return self._core.time if self._end is None else self._end.time

    @property
    def integrator(self) -> str:
        """The integrator in use, and why it is 'bdf' where none was asked for."""
        reason = self._core.reason
        return f"{self._core.integrator}, as {reason}" if reason else self._core.integrator

    @property
    def instruction_set(self) -> str:
        """Kernel variant in use."""
        return self.bearings[0].model.instruction_set

    @property
    def state(self) -> State:
        """A copy of the present state, at `time`."""
        if self._end is not None:
            time, vector = self._end.time, self._end.vector.copy()
        else:
            time, vector = self._core.time, self._core.state()
        inputs, first = self._inputs, self.bearings[0]
        if inputs is None:
            angle = self.scene.start_shaft_angle + self.scene.shaft_turn(time)
        else:
            angle = inputs.angle(time)
        held = None if first.scene.housing is None else first.motion.housing_load
        return State(time, vector, angle, first.motion.displacement(time), held, inputs, copy.deepcopy(self.memory))

    def view(self, vector: Array | None = None) -> Any:
        """Parts of a state vector by name (`StateView`); of a copy of the present one by default. Those of the first bearing's
        inner ring are the shaft's.
        """
        given = self.state.vector if vector is None else vector
        return self._of_each(lambda one: one.view(given))

    @property
    def system(self) -> Any:
        """The `System`: the bodies and the pairs that are simulated, and those that the effects leave out; prints as a table."""
        return self._of_each(lambda one: system_of(one.model))

    def set_state(self, vector: ArrayLike | State, time: float | None = None) -> None:
        """Go on from another state; the integrator is started again.

        Parameters
        ----------
        vector : array_like of shape (n_state,), or State
            The state.
        time : float, optional
            Its time (s); the present one by default.

        Raises
        ------
        InputError
            If it is not finite, not possible, or of the wrong length, or if it is set from the callback of a run.
        """
        self._check_not_running("set_state")
        if isinstance(vector, State):
            given, when = vector.vector, vector.time
        else:
            given, when = _numbers(vector), self.time
        when = when if time is None else number_of("time", time)
        if isinstance(vector, State) and vector.inputs is not None:
            self._put(put_back(self, vector.inputs), vector.inputs)
        core = self._open(when, given)
        self._count()
        self._core, self._begun, self._reached, self._end = core, when, when, None
        self._accounts = {}
        if isinstance(vector, State):
            self.memory = copy.deepcopy(vector.memory)

    def copy(self) -> Self:
        """An independent simulation at the same state; its integrator starts there."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other._running = False
        other._totals, other._counted, other._accounts = {}, {}, {}
        present = self.state
        other.memory = present.memory
        other._begin(present.time, present.vector)
        other._reached = present.time
        return other

    def __copy__(self) -> Self:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.copy()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a simulation cannot be pickled; keep its scene and its state, or use checkpoints")

    def _check_not_running(self, what: str) -> None:
        if self._running:
            allowed = "must not be called while a run goes on; end the run first: let the callback give True"
            raise InputError([Problem((what,), MISSING, allowed)])

    def restart(self) -> None:
        """Start the integrator again at the present state, as a checkpoint does.

        Raises
        ------
        InputError
            If it is called from the callback of a run.
        """
        self._check_not_running("restart")
        accounts = self._accounts
        self.set_state(self.state)
        self._accounts = accounts

    def step(
        self,
        *,
        to: float | None = None,
        between: Literal["held", "linear"] = "held",
        rates: Mapping[str, Any] | None = None,
        **inputs: Any,
    ) -> float:
        """Make one step of the integrator, or steps until a time; return the new time (s).

        Inputs may be given with the time. They are in force until others are given. So another program can drive a bearing: a
        controller, or a model of a machine.

        Parameters
        ----------
        to : float, optional
            Time to go to (s); one step of the integrator without it.
        between : {'held', 'linear'}
            Loads and torques that are given begin at once, or change evenly until `to`. Speeds and places of a ring always change
            evenly until `to`, as nothing that moves can jump. The temperature of the oil is that of the whole step.
        rates : mapping of str to float or tuple, optional
            Rates of `displacement` (m/s), `misalignment_x` and `misalignment_y` (rad/s) at `to`: the ring then follows a cubic,
            with a velocity that does not jump from step to step, as its damping forces need. Those that are not named are 0.
        **inputs
            Of a scene its fields `axial_load`, `radial_load`, `radial_direction_deg`, `moment_x`, `moment_y`, `torque`,
            `displacement`, `misalignment_x`, `misalignment_y`, `speed_rpm`, `outer_speed_rpm`, and `temperature_c` of its oil; of
            an assembly its fields `loads`, `torque` and `speed_rpm`, and `temperature_c`. A ring that follows its load goes
            evenly to where it is in equilibrium at `to`.

        Raises
        ------
        StepError
            If the integrator cannot go on; the state stays the last good one.
        InputError
            If an input is not allowed, or the scene's own quantities still change; if it is called from the callback of a run.
        LoadError
            If a ring that follows its load cannot carry it.

        Examples
        --------
        >>> import trbdyn as trb
        >>> scene = trb.cases.scene_30310(1000.0, 5e3, ring="follows")
        >>> simulation = trb.Simulation(scene)
        >>> simulation.step(to=1e-4, axial_load=6e3, speed_rpm=1010.0)
        0.0001
        """
        self._check_not_running("step")
        if to is None:
            if inputs or rates is not None:
                raise InputError.of("to", None, "must be given together with inputs (s)")
            self._settle_inputs(self.time)
            self._one_step()
            return self._reached
        end = number_of("to", to)
        if not self.time < end <= MAX_TIME:
            raise InputError.of(
                "to", to, f"must be after the present time, {self.time:.9g}, and at most {MAX_TIME:g} (s)"
            )
        if inputs or rates is not None:
            give(self, end, between, inputs, rates)
        else:
            self._settle_inputs(end)
        while self._core.time < end:
            self._one_step()
        self._stand_at(end)
        self._reached = end
        return end

    def _settle_inputs(self, end: float) -> None:
        """Where inputs changed evenly until now, they keep their values from here on."""
        if self._inputs is not None and self._inputs.changes and self.time >= self._inputs.until:
            give(self, max(end, math.nextafter(self.time, math.inf)), "held", {})

    def _one_step(self) -> None:
        try:
            self._reached = self._core.step()
            self._end = None
        except _core.CoreStepError as error:
            raise StepError(str(error), time=self._core.time) from None

    def estimate(
        self, *, revolutions: float | None = None, duration: float | None = None, save_every: float | None = None
    ) -> Estimate:
        """Expected wall time and error of a run from here, by a short probe of a copy; see
        `trbdyn.run.estimate.estimate`.
        """
        return estimate(self, revolutions=revolutions, duration=duration, save_every=save_every)

    def derivative(self, vector: ArrayLike | None = None, time: float | None = None) -> Array:
        """Rates of the state, shape (n_state,); at the present state by default."""
        return self._core.derivative(*self._place(vector, time))

    def record(self, vector: ArrayLike | None = None, time: float | None = None) -> Any:
        """Every recorded quantity by name, a dict of arrays; at the present state by default."""
        row = self._core.observe(*self._place(vector, time))
        return self._of_each(
            lambda one: {
                name: row[offset : offset + math.prod(shape)].reshape(shape)
                for name, offset, shape in one.record_layout
            }
        )

    def contacts(self, vector: ArrayLike | None = None, time: float | None = None) -> Any:
        """Every intermediate quantity of every contact; at the present state by default.

        Returns
        -------
        dict of str to ndarray
            ``raceway_<quantity>``, shape (2, Z, n): outer and inner race, roller, node, for interference, load,
            pressure, films, film parameter, slide-roll ratio, friction coefficient and others; ``rib_<quantity>`` and
            ``front_rib_<quantity>``, shape (Z,); ``pocket_load``, ``pocket_friction``, ``pocket_interference``
            (negative: gap), shape (Z, slots); ``force``, ``moment`` and other wrenches, shape (Z, 3); ``land_<quantity>``,
            shape (), of the cage on a land; ``hub_cage_force`` and other wrenches on cage, inner and outer ring by pairs
            without a roller, shape (3,), in axes that turn with the kinematic cage angle; all SI.
        """
        when, given = self._place(vector, time)
        return self._of_each(lambda one: self._core.contacts(when, given, one.number))

    def _place(self, vector: ArrayLike | None, time: float | None) -> tuple[float, Array]:
        when = self.time if time is None else number_of("time", time)
        if vector is None:
            return when, self.state.vector
        given = _numbers(vector)
        if given.shape != self._seated.vector.shape:
            raise InputError.of(
                "state", f"an array of shape {given.shape}", f"must have the shape {self._seated.vector.shape}"
            )
        return when, given

    @property
    def counters(self) -> dict[str, int]:
        """How often each effect was evaluated; zero for effects that are off."""
        return {name: value + self._counted.get(name, 0) for name, value in self._core.counters().items()}

    @property
    def statistics(self) -> dict[str, float]:
        """What the integrator did."""
        return merged(self._totals, self._core.statistics())

    def run(
        self,
        *,
        revolutions: float | None = None,
        duration: float | None = None,
        until: Mapping[str, float] | Literal["cage"] | None = None,
        save_every: float | None = None,
        save_groups: Sequence[Group] | None = None,
        output: str | Path | None = None,
        progress: bool = False,
        callback: Callback | None = None,
        callback_every: float | None = None,
        checkpoint_every: float | None = None,
        overwrite: bool = False,
    ) -> R:
        """Simulate for a time and keep records; output times never change the steps.

        Parameters
        ----------
        revolutions : float, optional
            How far to go, in turns of the shaft; refused where a torque drives it, as its speed follows from the run.
        duration : float, optional
            How far to go (s); one of both must be given.
        until : mapping of str to float, or 'cage', optional
            End earlier, when the averages named here are known well enough: largest half width of the 95 % confidence interval
            over the average, for instance ``{"torque": 0.01, "orbit_rms_over_cpr": 0.05}``. 'cage': when the motion of the cage
            is known to have settled, with its orbit within 0.05 Cpr (``{"cage": 0.1}``: within 0.1 Cpr). `revolutions` or
            `duration` is then the longest run; a run that ends there first gives a warning.
        save_every : float, optional
            Time between records (s). By default a 32nd of a turn of the shaft, but at most 1e-2 s; in a run that would have
            fewer than 200 records a half, a quarter and so on of that, as far as 1e-4 s. ``result.meta["kept"]`` says
            what was kept.
        save_groups : sequence of str, optional
            Groups of quantities to keep; all by default, but contacts, outer_ribs and pocket in runs of more than 20 000 records.
        output : path-like, optional
            HDF5 file to write while running; without it records stay in memory.
        progress : bool
            Show a progress bar.
        callback : callable, optional
            Called with this simulation about every tenth of a second; True ends the run. What it raises ends the run
            too, after the file is closed; the result so far is the attribute ``result`` of the exception. It may read
            the simulation, but not step, restart or set it.
        callback_every : float, optional
            Bearing time between two calls of the callback (s). It then may give a dict of inputs, see `step`, which are in force
            until its next call: feedback. Records are made at these times, without peaks; the same callback gives the same bits.
            Numbers that it needs from call to call it keeps in `memory`, a dict of this simulation that states and checkpoints
            have, too.
        checkpoint_every : float, optional
            Bearing time between checkpoints (s), see `RunOptions`; by default that of this simulation's options.
            Together with `output`, checkpoints are written beside it, and `resume` goes on from the last one.
        overwrite : bool
            Replace the file `output` if it is there, together with the checkpoints of the run that it holds.

        Returns
        -------
        Result or AssemblyResult
            Of one bearing, or of several by their names. Ended by Ctrl-C or the callback it has ``success`` False and says so in
            ``message``.

        Raises
        ------
        InputError
            If an argument cannot be used.
        StepError
            If a step failed; its ``result`` holds everything up to the last good time.
        FileError
            If the file cannot be written, or is there already.
        """
        self._check_not_running("run")
        path = None if output is None else output_path(output, overwrite=overwrite)
        if path is not None:
            _check_output(path)
        if callback_every is not None:
            callback_every = number_of("callback_every", callback_every)
            if not callback_every > 0.0:
                raise InputError.of("callback_every", callback_every, "must be > 0 (s)")
            alone = {"save_every": save_every, "until": until}
            for name, value in alone.items():
                if value is not None:
                    raise InputError.of(name, value, "must not be given together with callback_every")
            save_every = callback_every
        elif self._inputs is not None:
            limit = "must be given: inputs were given between steps, which a run of the scene alone does not have"
            raise InputError.of("callback_every", None, limit)
        changes: dict[str, Any] = {"revolutions": revolutions, "duration": duration}
        changes |= {} if until is None else {"until": until if isinstance(until, str) else dict(until)}
        changes |= {} if checkpoint_every is None else {"checkpoint_every": checkpoint_every}
        options = self.options.replace(**changes)
        end = options.end_time(self.subject, self._reached)
        kept = kept_by_default(
            end - self._reached,
            self.scene.turning_rpm,
            save_every,
            save_groups,
            optional=groups_of(one.scene for one in self.bearings),
        )
        if callback_every is not None:
            kept["save_groups"] = tuple(name for name in kept["save_groups"] if name != "peaks")
        options = options.replace(**kept)
        if options.checkpoint_every is not None and not isinstance(self.subject, Model):
            limit = (
                "must not be given where seats are given in place of an assembly: a checkpoint describes an assembly"
            )
            raise InputError.of(("run", "checkpoint_every"), options.checkpoint_every, limit)
        times = output_times(self._reached, end, kept["save_every"])
        kind = Run if callback_every is None else Controlled
        run = kind(self, options, times, callback)
        if path is not None:
            run.write_to(path, overwrite=overwrite)
        return cast(R, run.go(progress=progress))


_OTHER_FORMATS = frozenset(
    (".csv", ".txt", ".json", ".toml", ".npy", ".npz", ".mat", ".xlsx", ".parquet", ".png", ".gif", ".nc")
)


def _check_output(path: Path) -> None:
    """Records are written as HDF5: a name that says something else would mislead."""
    if path.suffix.lower() in _OTHER_FORMATS:
        limit = f"must end in .h5 or .hdf5: records are written as HDF5, not as {path.suffix}"
        raise InputError.of("output", str(path), limit)


def _numbers(values: ArrayLike) -> Array:
    """A state vector as users give it; an InputError if it is no sequence of numbers."""
    try:
        return np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError.of("state", "given", f"must be a vector of numbers: {error}") from None


_COUNTED_ONCE = ("last_step", "last_order")


def merged(before: dict[str, float], now: dict[str, float]) -> dict[str, float]:
    """Statistics of one integrator added to those of the ones before it."""
    if not before:
        return now
    merged = {name: value + before.get(name, 0.0) for name, value in now.items()}
    merged["smallest_step"] = min(before.get("smallest_step", math.inf), now["smallest_step"])
    stepped = now["steps"] > 0
    return merged | {name: now[name] if stepped else before.get(name, now[name]) for name in _COUNTED_ONCE}
