"""Simulation of bearings on one shaft by one integrator, with a result of each bearing.

docs/theory/motion.md#bearings-on-one-shaft has the equations.
"""

from __future__ import annotations

import contextlib
import math
import time as clock
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.own_files import output_path
from trbdyn.errors import FileError, InputError, RunWarning, StepError
from trbdyn.model.assembly import Assembly
from trbdyn.model.scene import Scene
from trbdyn.results import fields as field_table
from trbdyn.results import peaks as peak_table
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.assembly_file import gather, part_path
from trbdyn.results.file_format import RunInfo
from trbdyn.results.result import Result, load
from trbdyn.results.result_file import ResultWriter
from trbdyn.run import keeping
from trbdyn.run.memory import Kept
from trbdyn.run.options import RunOptions
from trbdyn.run.process import has_a_spare_core, interrupts
from trbdyn.run.running import CHUNK_RECORDS, CHUNK_STEPS, output_times, progress_bar, statistics_of
from trbdyn.run.watch import RING_GONE, Account, Watch
from trbdyn.statics.plausible import UnusualInput, dented
from trbdyn.statics.seat import Seat, Seated, Seating, seat_all
from trbdyn.statics.seating import seating_of
from trbdyn.statics.state_view import StateView

Array = NDArray[np.float64]
Layout = list[tuple[str, int, tuple[int, ...]]]

WITHOUT_BIAS: Final = (
    "The bias of the presets was measured with one bearing whose ring is held, not with bearings on a shaft."
)


@dataclass
class _Bearing:
    """A bearing while it runs."""

    name: str
    seat: Seat
    layout: Layout
    """Places of its fields in its part of a row."""
    first: int
    """Where its part of a row begins."""
    doubts: list[str]
    kept: Kept | ResultWriter


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
        self.options = RunOptions(accuracy=accuracy, **options)
        if self.options.checkpoint_every is not None:
            raise InputError.of(
                ("run", "checkpoint_every"), self.options.checkpoint_every, "must not be given for an assembly yet"
            )
        self.assembly = subject if isinstance(subject, Assembly) else None
        seating = seating_of(subject) if isinstance(subject, Assembly) else subject
        self.seats = {name: seat.at(seating.shaft) for name, seat in seating.seats.items()}
        self._seated: Seated = seat_all(replace(seating, seats=self.seats), instruction_set)
        self._core = self._seated.open(self._first.start.time, self._seated.vector, self.options.settings())
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

    @property
    def time(self) -> float:
        """Time that it has reached (s)."""
        return self._reached

    @property
    def statistics(self) -> dict[str, float]:
        """What the integrator did."""
        return self._core.statistics()

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
        save_every: float | None = None,
        save_groups: Sequence[str] | None = None,
        output: str | Path | None = None,
        overwrite: bool = False,
        progress: bool = False,
    ) -> AssemblyResult:
        """Step on and keep records of every bearing; output times never change the steps.

        Parameters
        ----------
        revolutions, duration : float, optional
            How far to go: in turns of the shaft, or bearing time (s); one of both must be given.
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
        options = self.options.replace(revolutions=revolutions, duration=duration)
        end = options.end_time(speed, self._reached)
        housing = any(seat.scene.housing is not None for seat in self.seats.values())
        kept = keeping.kept_by_default(end - self._reached, speed, save_every, save_groups, housing=housing)  # type: ignore[arg-type]
        options = options.replace(**kept)
        assert options.save_every is not None
        times = output_times(self._reached, end, options.save_every)
        path = None if output is None else output_path(output, overwrite=overwrite)
        bearings = self._open_bearings(options, times, path, overwrite=overwrite)
        return _Run(self, options, times, bearings, path, overwrite=overwrite).go(progress=progress)

    def _open_bearings(
        self, options: RunOptions, times: Array, path: Path | None, *, overwrite: bool
    ) -> list[_Bearing]:
        out: list[_Bearing] = []
        at = 0
        with_peaks = peak_table.GROUP in options.save_groups
        fields = field_table.table() + (peak_table.table() if with_peaks else ())
        for (name, seat), model in zip(self.seats.items(), self._seated.models, strict=True):
            layout, length = list(model.record_layout()), model.record_length
            if with_peaks:
                layout += [(field, first + length, shape) for field, first, shape in model.peak_layout()]
                length += model.peak_length
            kept: Kept | ResultWriter
            if path is None:
                kept = Kept(layout, field_table.select(fields, options.save_groups))
            else:
                try:
                    kept = ResultWriter(
                        part_path(path, name),
                        scene=seat.scene,
                        layout=layout,
                        fields=fields,
                        groups=options.save_groups,
                        meta=_meta(self, options, name),
                        geometry=asdict(seat.scene.bearing.geometry),
                        expected=times.size,
                        overwrite=overwrite,
                    )
                except FileError:
                    close_files(out)
                    for one in out:
                        part_path(path, one.name).unlink(missing_ok=True)
                    raise
            doubts = list(self._seated.unusual[len(out)])
            out.append(_Bearing(name, seat, layout, at, doubts, kept))
            at += length
        return out


def close_files(bearings: Sequence[_Bearing]) -> None:
    """Close what a run that does not end as it should has begun to write."""
    for bearing in bearings:
        if isinstance(bearing.kept, ResultWriter):
            with contextlib.suppress(FileError):
                bearing.kept.close()


def _meta(sim: AssemblySimulation, options: RunOptions, name: str) -> dict[str, Any]:
    settings = {key: value for key, value in options.to_dict().items() if key != "save_groups"}
    return {
        "instruction_set": sim._seated.models[0].instruction_set,
        "sundials_version": _core.sundials_version(),
        "core_version": _core.version(),
        "settings": settings,
        "kept": keeping.said(options.save_every or 0.0, options.save_groups),
        "notes": list(sim._seated.unusual[list(sim.seats).index(name)]),
        "accuracy": WITHOUT_BIAS,
        "assembly": {"bearing": name, "bearings": list(sim.seats), "seat": sim.seats[name].numbers()},
    }


class _Run:
    """One call of `AssemblySimulation.run`."""

    def __init__(
        self,
        sim: AssemblySimulation,
        options: RunOptions,
        times: Array,
        bearings: list[_Bearing],
        path: Path | None,
        *,
        overwrite: bool,
    ) -> None:
        self.sim, self.options, self.times, self.bearings = sim, options, times, bearings
        self.path, self.overwrite = path, overwrite
        self.done, self.spent, self.began = 0, 0.0, clock.perf_counter()

    def go(self, *, progress: bool) -> AssemblyResult:
        core = self.sim._core
        if peak_table.GROUP in self.options.save_groups:
            core.begin_peaks(float(self.times[0]))
        try:
            with interrupts() as interrupted, progress_bar(self.times, shown=progress) as bar:
                message = self._loop(interrupted, bar)
        except _core.CoreStepError as error:
            raise StepError(str(error), time=core.time, result=self._finish(False, str(error))) from None
        except BaseException:
            core.end_peaks()
            close_files(self.bearings)
            raise
        return self._finish(message is None, message or f"reached {self.times[-1]:.6g} s")

    def _loop(self, interrupted: list[int], bar: Any) -> str | None:
        """Step until all records are filled; gives the reason if the run ended before, else None."""
        sim, core, beside = self.sim, self.sim._core, has_a_spare_core()
        going_on = self.options.when_wrong == "go_on"
        watches = [
            Watch(seen, float(self.times[-1]), bearing.doubts, going_on=going_on, of=bearing.name)
            for seen, bearing in zip(sim._seen, self.bearings, strict=True)
        ]
        while self.done < self.times.size:
            chunk = self.times[self.done : self.done + CHUNK_RECORDS]
            records = np.empty((chunk.size, core.row_length))
            before = clock.perf_counter()
            try:
                rows, _ = core.run(chunk, records, CHUNK_STEPS, math.inf, beside)
            except _core.CoreStepError as error:
                self._keep(records[: getattr(error, "rows", 0)])
                raise
            finally:
                self.spent += clock.perf_counter() - before
            self._keep(records[:rows])
            bar.update(sim.time - float(self.times[0]) - bar.n)
            doubts = [watch.look(final=self.done >= self.times.size) for watch in watches]
            doubts += [self._gone(bearing, records[:rows]) for bearing in self.bearings]
            if interrupted:
                return f"stopped by the user at {core.time:.6g} s"
            if (doubt := next((text for text in doubts if text is not None), None)) is not None:
                return doubt
        return None

    def _gone(self, bearing: _Bearing, rows: Array) -> str | None:
        """A ring that nothing holds any more leaves its bearing: what follows means nothing."""
        place = next(at for name, at, _ in bearing.layout if name == "ring_position") + bearing.first
        moved = float(np.abs(rows[:, place : place + 3]).max(initial=0.0))
        if not moved > RING_GONE * bearing.seat.scene.bearing.roller.diameter:
            return None
        text = f"the ring stands {1e3 * moved:.3g} mm from its place: nothing holds the shaft there"
        self._doubt(bearing, text)
        return f"ended: {bearing.name}: {text}"

    def _doubt(self, bearing: _Bearing, text: str) -> None:
        bearing.doubts.append(text)
        warnings.warn(f"{bearing.name}: {text}", RunWarning, stacklevel=6)

    def _keep(self, records: Array) -> None:
        if not len(records):
            return
        self.done += len(records)
        self.sim._reached = float(self.times[self.done - 1])
        for number, bearing in enumerate(self.bearings):
            following = self.bearings[number + 1 : number + 2]
            end = following[0].first if following else records.shape[1]
            bearing.kept.append(np.ascontiguousarray(records[:, bearing.first : end]))

    def _finish(self, success: bool, message: str) -> AssemblyResult:
        sim, core = self.sim, self.sim._core
        if not success:
            sim._reached = core.time
        whole, at, results = core.whole_peaks(sim._reached), 0, {}
        core.end_peaks()
        stats = statistics_of(
            sim.statistics,
            sim._first,
            start=float(self.times[0]),
            end=sim._reached,
            began=self.began,
            spent=self.spent,
            integrator=self.options.integrator,
            instruction_set=sim._seated.models[0].instruction_set,
        )
        for bearing, model in zip(self.bearings, sim._seated.models, strict=True):
            peaks = peak_table.from_row(whole[at : at + model.peak_length], model.peak_layout()) if whole.size else {}
            at += model.peak_length if whole.size else 0
            if text := dented(peaks):
                self._doubt(bearing, text)
            how: dict[str, Any] = {
                "peaks": peaks,
                "success": success,
                "message": message,
                "stats": stats,
                "counters": core.counters(),
                "warnings": bearing.doubts,
                "final_time": sim._reached,
                "final_state": None,
            }
            results[bearing.name] = self._result(bearing, how)
        if self.path is None:
            return AssemblyResult(results, sim.assembly)
        parts = {name: part_path(self.path, name) for name in results}
        described = None if sim.assembly is None else sim.assembly.to_dict()
        gather(self.path, parts, described, overwrite=self.overwrite)
        return AssemblyResult.load(self.path)

    def _result(self, bearing: _Bearing, how: dict[str, Any]) -> Result:
        if isinstance(bearing.kept, ResultWriter):
            bearing.kept.finish(**how)
            return load(bearing.kept.path)
        scene = bearing.seat.scene
        how |= {"warnings": tuple(bearing.doubts), "geometry": asdict(scene.bearing.geometry)}
        info = RunInfo(scene=scene.to_dict(), meta=_meta(self.sim, self.options, bearing.name), **how)
        return Result(bearing.kept.source(), info, scene)
