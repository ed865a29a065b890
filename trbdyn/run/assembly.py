"""Simulation of bearings on one shaft by one integrator, with a result of each bearing.

docs/theory/motion.md#bearings-on-one-shaft has the equations.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.expected import expect
from trbdyn.base.own_files import output_path
from trbdyn.errors import InputError, StepError
from trbdyn.model.assembly import Assembly
from trbdyn.model.scene import Scene
from trbdyn.results.assembly import AssemblyResult
from trbdyn.run import keeping
from trbdyn.run.assembly_run import AssemblyRun
from trbdyn.run.options import RunOptions
from trbdyn.run.running import output_times
from trbdyn.run.simulation import merged
from trbdyn.run.watch import Account
from trbdyn.statics.plausible import UnusualInput
from trbdyn.statics.seat import Seated, Seating, seat_all
from trbdyn.statics.seating import seating_of
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]


class _Seen:
    """What the watch over a run asks of a simulation, for one bearing of several: its fields in the rows of all of them."""

    def __init__(self, sim: AssemblySimulation, number: int) -> None:
        models = sim._seated.models
        before = sum(model.record_length for model in models[:number])
        layout = [(name, at + before, shape) for name, at, shape in models[number].record_layout()]
        self.sim, self.options, self.scene = sim, sim.options, list(sim.seats.values())[number].scene
        self._account: Account | None = None
        self._number = number
        self._model = SimpleNamespace(record_layout=lambda: layout)
        self._motion = SimpleNamespace(open=lambda _, *given: sim._seated.open(*given))

    def view(self, vector: Array) -> StateView:
        return self.sim._seated.view(self._number, vector)

    @property
    def _core(self) -> _core.Simulation:
        return self.sim._core

    @property
    def statistics(self) -> dict[str, float]:
        return self.sim.statistics


class AssemblySimulation:
    """Bearings on one shaft, integrated together.

    Parameters
    ----------
    subject : Assembly or Seating
        An assembly begins in its equilibrium at speed; a seating says where the shaft stands.
    accuracy : str
        Preset of the tolerances.
    instruction_set : str
        Kernel variant; the fastest by default.
    **options : Any
        Other fields of `RunOptions`.

    Raises
    ------
    InputError
        If the numbers do not fit together.
    LoadError
        If the bearings of an assembly cannot carry its loads.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000)
    >>> result = trb.AssemblySimulation(pair).run(revolutions=0.05)
    >>> sorted(result), result.success
    (['left', 'right'], True)
    """

    def __init__(
        self,
        subject: Assembly | Seating,
        *,
        accuracy: str = "standard",
        instruction_set: str = "",
        **options: Any,
    ) -> None:
        if not isinstance(subject, Seating):
            expect("assembly", subject, Assembly)
        self.options = RunOptions(accuracy=accuracy, **options)
        self.assembly = subject if isinstance(subject, Assembly) else None
        seating = seating_of(subject) if isinstance(subject, Assembly) else subject
        self.seats = {name: seat.at(seating.shaft) for name, seat in seating.seats.items()}
        self._seated: Seated = seat_all(replace(seating, seats=self.seats), instruction_set)
        self._totals: dict[str, float] = {}
        self._counted: dict[str, int] = {}
        self._begin(self._first.start.time, self._seated.vector)
        self._reached = self._core.time
        self.warnings = tuple(
            f"{name}: {text}" for name, texts in zip(self.seats, self._seated.unusual, strict=True) for text in texts
        )
        for text in self.warnings:
            warnings.warn(text, UnusualInput, stacklevel=2)
        self._seen: list[Any] = [_Seen(self, number) for number in range(len(self.seats))]

    def __repr__(self) -> str:
        return f"<AssemblySimulation: {', '.join(self.seats)}; at {self.time:g} s, accuracy {self.options.accuracy!r}>"

    @property
    def _first(self) -> Scene:
        """The scene of the first bearing, whose axes and speed are the shaft's."""
        return next(iter(self.seats.values())).scene

    def _begin(self, time: float, vector: Array) -> None:
        """Make a new integrator, without any history: as in a new process."""
        self._core = self._seated.open(time, vector, self.options.settings())
        self._begun = time

    def _begin_again(self) -> None:
        """Start a new integrator at the place of the present one; what was counted is kept."""
        counted, totals = self.counters, self.statistics
        self._counted = counted
        if self._core.statistics()["steps"] > 0:
            self._totals = totals
        self._begin(self._core.time, self._core.state())

    @property
    def time(self) -> float:
        """Time that it has reached (s)."""
        return self._reached

    @property
    def statistics(self) -> dict[str, float]:
        """What the integrator did."""
        return merged(self._totals, self._core.statistics())

    @property
    def counters(self) -> dict[str, int]:
        """What was evaluated, in all bearings together."""
        return {name: value + self._counted.get(name, 0) for name, value in self._core.counters().items()}

    def step(self) -> float:
        """One step of the integrator; gives the new time (s).

        Raises
        ------
        StepError
            If the integrator cannot go on; the state stays the last good one.
        """
        try:
            self._reached = self._core.step()
        except _core.CoreStepError as error:
            raise StepError(str(error), time=self._core.time) from None
        return self._reached

    def state(self, bearing: str) -> dict[str, Array]:
        """Parts of a bearing's present state by name; those of ``inner_ring`` are the shaft's."""
        view = self._seated.view(list(self.seats).index(bearing), self._core.state())
        return {name: view[name] for name in view.names}

    def record(self) -> dict[str, dict[str, Array]]:
        """Every recorded quantity of each bearing at the end of the integrator's last step."""
        row, out, at = self._core.observe(self._core.time, self._core.state()), {}, 0
        for name, model in zip(self.seats, self._seated.models, strict=True):
            own = row[at : at + model.record_length]
            out[name] = {
                field: own[first : first + math.prod(shape)].reshape(shape)
                for field, first, shape in model.record_layout()
            }
            at += model.record_length
        return out

    def run(
        self,
        *,
        revolutions: float | None = None,
        duration: float | None = None,
        until: Mapping[str, float] | None = None,
        save_every: float | None = None,
        save_groups: Sequence[str] | None = None,
        output: str | Path | None = None,
        overwrite: bool = False,
        progress: bool = False,
        checkpoint_every: float | None = None,
    ) -> AssemblyResult:
        """Step on and keep records of every bearing; output times never change the steps.

        Parameters
        ----------
        revolutions, duration : float, optional
            How far to go: in turns of the shaft, or bearing time (s); one of both must be given.
        until : mapping of str to float, optional
            End earlier, when these averages are known well enough in every bearing, as in `trbdyn.Simulation.run`.
        save_every : float, optional
            Time between records (s); by default as `trbdyn.Simulation.run`.
        save_groups : sequence of str, optional
            Groups of quantities to keep; all by default.
        output : path-like, optional
            File to write; without it records stay in memory. While the run goes on, each bearing has a file of its own beside it,
            which is what is left of a run that is killed: ``pair.left.h5`` for ``pair.h5``.
        overwrite : bool
            Replace a file that is there.
        progress : bool
            Show a bar on the terminal.
        checkpoint_every : float, optional
            Bearing time between checkpoints (s), as in `trbdyn.Simulation.run`; by default that of this simulation's options.
            `trbdyn.resume` goes on from the last one. A run that ended before its end then leaves the files of its bearings
            as they are.

        Returns
        -------
        AssemblyResult
            Ended by Ctrl-C it has ``success`` False and says so in ``message``.

        Raises
        ------
        InputError
            If an argument cannot be used.
        StepError
            If a step failed; its ``result`` holds everything up to the last good time.
        FileError
            If a file cannot be written, or is there already.
        """
        speed = self._first.turning_rpm
        changes: dict[str, Any] = {"revolutions": revolutions, "duration": duration}
        changes |= {} if until is None else {"until": dict(until)}
        changes |= {} if checkpoint_every is None else {"checkpoint_every": checkpoint_every}
        options = self.options.replace(**changes)
        if options.checkpoint_every is not None and self.assembly is None:
            limit = (
                "must not be given where seats are given in place of an assembly: a checkpoint describes an assembly"
            )
            raise InputError.of(("run", "checkpoint_every"), options.checkpoint_every, limit)
        end = options.end_time(speed, self._reached)
        optional = keeping.groups_of(seat.scene for seat in self.seats.values())
        kept = keeping.kept_by_default(end - self._reached, speed, save_every, save_groups, optional=optional)  # type: ignore[arg-type]
        options = options.replace(**kept)
        assert options.save_every is not None
        times = output_times(self._reached, end, options.save_every)
        path = None if output is None else output_path(output, overwrite=overwrite)
        run = AssemblyRun(self, options, times)
        if path is not None:
            run.write_to(path, overwrite=overwrite)
        return run.go(progress=progress)
