"""One run of a simulation: its records, callbacks, signals, checkpoints, and how it ends."""

from __future__ import annotations

import contextlib
import math
import os
import time as clock
import warnings
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.base.validation import Model
from trbdyn.errors import FileError, InputError, RunWarning, StepError
from trbdyn.model.assembly import assembly_of
from trbdyn.model.motion import is_constant
from trbdyn.model.shaft import turns
from trbdyn.results import fields as field_table
from trbdyn.results import peaks as peak_table
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.file_format import RunInfo, reason
from trbdyn.results.result import Result
from trbdyn.run import checkpoint, keeping
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.faults import check_apart, culprit
from trbdyn.run.keeping import absent, there
from trbdyn.run.memory import Kept
from trbdyn.run.options import RunOptions
from trbdyn.run.process import has_a_spare_core, interrupts
from trbdyn.run.until import Until, check_wanted
from trbdyn.run.watch import Watch
from trbdyn.statics.plausible import dented
from trbdyn.statics.seat import Layout, SeatedBearing

if TYPE_CHECKING:
    from trbdyn.results.file_source import FileSource
    from trbdyn.results.result_file import ResultWriter
    from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]
Callback = Callable[["Simulation"], bool | None]

CHUNK_RECORDS = 256
"""Records between looks at signals, callbacks and the file."""
MOST_RECORDS = 50_000_000
"""Most records of a run: their times alone take 400 MB."""
CHUNK_STEPS = 2000
"""Steps between looks at signals: about a twentieth of a second."""

WITHOUT_CONFIDENCE = (
    "the run has reached its end without the confidence that was asked for: {}. A longer run may reach it"
)

_BAR = "{percentage:3.0f}% |{bar}| {n:.4g}/{total:.4g} s of bearing time [{elapsed}<{remaining}]"

STOPPED: Final = "stopped by the user"
"""How the message of a run begins that Ctrl-C has ended."""


@dataclass
class RunningBearing:
    """A bearing while it runs: where its fields are in its part of a row, how well its averages are known, its records in memory,
    what is said of it with the result, and what the watch has found.
    """

    of: SeatedBearing
    layout: Layout
    part: slice
    until: Until
    kept: Kept
    notes: list[str]
    doubts: list[str]

    def doubt(self, text: str, stacklevel: int) -> None:
        """Keep a warning with the result, and show it."""
        self.doubts.append(text)
        warnings.warn(f"{self.of.said}{text}", RunWarning, stacklevel=stacklevel + 1)


class Run:
    """One call of `Simulation.run`, or what is left of it when it is resumed after `done` records. `watched`: its energy is
    judged. `look_every`: records between two calls of the callback.
    """

    def __init__(
        self,
        sim: Simulation,
        options: RunOptions,
        times: Array,
        callback: Callback | None,
        done: int = 0,
        *,
        watched: bool = True,
        look_every: int = CHUNK_RECORDS,
    ) -> None:
        self.sim = sim
        self.watched, self.look_every = watched, look_every
        self.options = options
        self.times = times
        self.callback = callback
        self.done = done
        self.filling: Array | None = None
        self.writer: ResultWriter | None = None
        self.output: Path | None = None
        self.interrupted: list[int] = []
        self.watches: list[Watch] = []
        self.process = os.getpid()
        self.began = clock.perf_counter()
        self.spent = 0.0
        self.steps_before = 0.0 if done else sim.statistics["steps"]
        self.beside = has_a_spare_core()
        self.enough = ""
        self.with_peaks = peak_table.GROUP in options.save_groups
        self.bearings: list[RunningBearing] = []
        for bearing in sim.bearings:
            self._add(bearing)

    def _add(self, bearing: SeatedBearing) -> None:
        options, model, fields = self.options, bearing.model, field_table.table()
        layout, length = list(model.record_layout()), model.record_length
        has_cage = bearing.scene.effects.has_cage
        check_wanted(options.until, options.save_groups, {name for name, _, _ in layout}, has_cage)
        if self.with_peaks:
            fields += peak_table.table()
            layout += [(name, at + length, shape) for name, at, shape in model.peak_layout()]
            length += model.peak_length
        first = self.bearings[-1].part.stop if self.bearings else 0
        scene = bearing.scene
        moves = bearing.seat is not None or scene.ring_body is not None or scene.housing is not None
        chosen = there(field_table.select(fields, options.save_groups), absent(scene, moves=moves))
        kept = Kept(layout, chosen)
        until, said = Until(options.until, self.times.size), bearing.unusual
        self.bearings.append(
            RunningBearing(bearing, layout, slice(first, first + length), until, kept, list(said), list(said))
        )

    def _keep_peaks(self, since: float) -> None:
        """Start to keep peaks from a time of the last step on, if the run asks for them and does not keep them yet."""
        core = self.sim._core
        if self.with_peaks and core.row_length == sum(one.model.record_length for one in self.sim.bearings):
            core.begin_peaks(since)

    def write_to(
        self,
        output: Path,
        run_id: str | None = None,
        *,
        older: Sequence[FileSource] | None = None,
        overwrite: bool = False,
    ) -> None:
        """Write records to a file, and checkpoints beside it if there is a schedule.

        A run without a name is a new one. If it replaces the file of an older run, it removes that run's checkpoints. A run that
        goes on takes over the records that it has made from its older file.
        """
        from trbdyn.results.file_source import run_id_in
        from trbdyn.results.hdf5_file import Part
        from trbdyn.results.result_file import ResultWriter

        sim, done = self.sim, self.done
        replaced = run_id_in(output) if run_id is None and overwrite else None
        scheduled = self.options.checkpoint_every is not None
        if run_id is None and scheduled:
            checkpoint.check_free(output, replaced, overwrite=overwrite)
        first = done if older is None else older[0].first_record
        parts = []
        for one in self.bearings:
            scene, layout = one.of.scene, [(name, at + one.part.start, shape) for name, at, shape in one.layout]
            geometry = asdict(scene.bearing.geometry)
            parts.append(Part(scene, layout, one.kept.fields, self._meta(one), geometry, one.of.name))
        self.writer = ResultWriter(
            output,
            *parts,
            assembly=None if sim.assembly is None else sim.assembly.to_dict(),
            run_id=run_id,
            first_record=first,
            taken_over=None if older is None else (older, done - first),
            expected=self.times.size,
            overwrite=overwrite,
            beside=self.beside,
        )
        self.output = output
        if run_id is not None or replaced is not None or scheduled or self.callback is not None:
            self.writer.wait()
        if run_id is not None:
            return
        try:
            if replaced is not None:
                checkpoint.remove(output, replaced)
            if scheduled:
                checkpoint.clear(output)
                if sim._core.time == sim._begun:
                    self._keep_peaks(float(self.times[0]))
                    self._write_checkpoint()
        except OSError as error:
            sim._core.end_peaks()
            self.writer.close()
            raise error if isinstance(error, FileError) else FileError(f"{output}: {reason(error)}") from error

    def go(self, *, progress: bool) -> Result | AssemblyResult:
        sim = self.sim
        with progress_bar(self.times, shown=progress) as bar:
            try:
                with interrupts() as self.interrupted:
                    message = self._loop(bar)
            except _core.CoreStepError as error:
                result = self._finish(False, str(error))
                time, body, quantity = sim.time, *culprit(str(error))
                raise StepError(str(error), time=time, body=body, quantity=quantity, result=result) from None
            except StepError as error:
                error.result = self._finish(False, str(error))
                raise
            except KeyboardInterrupt:
                if self.process != os.getpid():
                    raise
                if self.filling is not None:
                    self._keep(self.filling[: int(np.count_nonzero(np.isfinite(self.filling[:, 0])))])
                return self._finish(False, f"{STOPPED} at {sim.time:.6g} s")
            except FileError:
                self._abandon()
                raise
            except BaseException as error:
                if self.process != os.getpid():
                    raise
                result = self._finish(False, f"ended by {type(error).__name__} at {sim.time:.6g} s: {error}")
                _hand_over(result, error)
                raise
        return self._finish(message is None, message or self.enough or f"reached {self.times[-1]:.6g} s")

    def _loop(self, bar: Any) -> str | None:
        """Step until all records are filled; gives the reason if the run ended before, else None."""
        sim, every = self.sim, self.options.checkpoint_every
        sim._end = None
        self._keep_peaks(float(self.times[0]))
        due = checkpoint.next_time(sim._begun, every)
        going_on = self.options.when_wrong == "go_on"
        end, watched = float(self.times[-1]), self.bearings if self.watched else ()
        watches = [Watch(sim, one.of, end, one.doubts, going_on=going_on) for one in watched]
        self.watches = watches
        while self.done < self.times.size:
            look = self.bearings[0].until.next_look(self.done)
            chunk = self.times[self.done : min(self.done + self.look_every, look or self.times.size)]
            # a signal may come before the core answers: rows that are filled are those with a finite time
            self.filling = records = np.empty((chunk.size, sim._core.row_length))
            records[:, 0] = np.nan
            before = clock.perf_counter()
            try:
                rows, _ = sim._core.run(chunk, records, CHUNK_STEPS, due, self.beside)
            except _core.CoreStepError as error:
                self._keep(records[: getattr(error, "rows", 0)])
                raise
            finally:
                self.spent += clock.perf_counter() - before
            self.filling = None
            self._keep(records[:rows])
            # records up to here need the history that the integrator is about to forget
            if sim.time >= due and self.done < self.times.size and self.times[self.done] > sim.time:
                peaks = sim._core.save_peaks()
                sim._begin_again()
                if peaks.size:
                    sim._core.restore_peaks(peaks)
                due = checkpoint.next_time(sim.time, every)
                for watch in watches:
                    watch.renew()
                self._write_checkpoint()
            doubt = look_at_all(watches, final=self.done >= self.times.size)
            bar.update(min(sim.time, float(self.times[-1])) - float(self.times[0]) - bar.n)
            for one in self.bearings if rows else ():
                if one.of.scene.effects.bodies == "rollers":
                    check_apart(sim, one.of, one.layout, records[:rows, one.part])
            ended = self._call_back()
            if self.interrupted:
                raise KeyboardInterrupt
            if doubt is not None:
                return doubt
            full = next((one.kept for one in self.bearings if one.kept.is_full()), None)
            if self.done < self.times.size and full is not None:
                return full.said(sim.time)
            if rows and self._is_enough():
                self.times = self.times[: self.done]
                said = "; ".join(f"{one.of.said}{one.until.said}" for one in self.bearings)
                self.enough = f"reached {sim._reached:.6g} s, as far as was needed: {said}"
                doubt = look_at_all(watches, final=True)
                if doubt is not None:
                    return doubt
            if ended:
                return f"ended by the callback at {sim.time:.6g} s"
        return None

    def _is_enough(self) -> bool:
        """Whether all bearings are known well enough; each is looked at, so that each says what is known."""
        reached = [one.until.reached(self.done, partial(self._so_far, one)) for one in self.bearings]
        return all(reached)

    def _so_far(self, bearing: RunningBearing) -> Result:
        """The records up to here."""
        if self.writer is None:
            return self._from_memory(bearing, final_time=self.sim._reached)
        self.writer.flush()
        return self._in_file(bearing)

    def _call_back(self) -> bool:
        """What the callback answers. It may look at the simulation, but not move it. A FileError in a process that it has
        forked, if it comes back from there: the result file is its parent's.
        """
        if self.callback is None:
            return False
        self.sim._running = True
        try:
            ended = bool(self.callback(self.sim))
        finally:
            self.sim._running = False
        if self.writer is not None and self.process != os.getpid():
            raise FileError(
                f"{self.output}: the result file belongs to the process that was forked; this one cannot go on"
            )
        return ended

    def _keep(self, records: Array) -> None:
        if not len(records):
            return
        self.done += len(records)
        self.sim._reached = float(self.times[self.done - 1])
        if self.writer is not None:
            self.writer.append(records)
            return
        for one in self.bearings:
            one.kept.append(np.ascontiguousarray(records[:, one.part]))

    def _write_checkpoint(self) -> None:
        """Write where the run is now; its records are written to the disk first."""
        if self.writer is None or self.output is None:
            return
        sim, subject = self.sim, self.sim.subject
        assert isinstance(subject, Model)
        self.writer.sync()
        found = Checkpoint(
            run_id=self.writer.run_id,
            scene=subject.to_dict(),
            model=subject.fingerprint,
            options=self.options.to_dict(),
            instruction_set=sim.instruction_set,
            build=checkpoint.build_digest(),
            motion=motions_digest(sim),
            start=float(self.times[0]),
            end=float(self.times[-1]),
            time=sim.time,
            done=self.done,
            statistics=sim._totals,
            counters=sim._counted,
            stepping_s=self.spent,
            state=sim._core.state(),
            peaks=sim._core.save_peaks(),
            warnings=[f"{one.of.said}{text}" for one in self.bearings for text in one.doubts]
            + [text for watch in self.watches for text in watch.averages_doubts(named=True)],
            control=self._control(),
        )
        checkpoint.write(checkpoint.checkpoint_path(self.output), found)

    def _control(self) -> dict[str, Any] | None:
        """What is kept of inputs that a callback gives; None where it gives none."""
        return None

    def _abandon(self) -> None:
        """Leave a result file that cannot be written as it is: the records in it can be read, a checkpoint goes on
        from there.
        """
        self.sim._core.end_peaks()
        if self.writer is not None:
            with contextlib.suppress(FileError):
                self.writer.close()

    def _meta(self, bearing: RunningBearing) -> dict[str, Any]:
        settings = {name: value for name, value in self.options.to_dict().items() if name not in ("save_groups",)}
        meta: dict[str, Any] = {
            "instruction_set": self.sim.instruction_set,
            "sundials_version": _core.sundials_version(),
            "core_version": _core.version(),
            "settings": settings,
            "integrator": self.sim.integrator,
            "kept": keeping.said(self.options.save_every or 0.0, self.options.save_groups),
            "notes": bearing.notes,
        }
        if bearing.of.seat is not None:
            names = [one.name for one in self.sim.bearings]
            whole = assembly_of(self.sim.subject)
            changes = whole is None or not all(is_constant(one) for one in whole.quantities().values())
            meta["assembly"] = {
                "bearing": bearing.of.name,
                "bearings": names,
                "seat": bearing.of.seat.numbers(),
                "changes": changes,
            }
        return meta

    def _in_file(self, bearing: RunningBearing) -> Result:
        """The result as it is in the file."""
        from trbdyn.results.file_source import FileSource

        assert self.output is not None
        assert self.writer is not None
        source = FileSource(self.output, bearing.of.name)
        if source.run_id != self.writer.run_id:
            raise FileError(f"{self.output}: the result file was replaced by another program")
        return Result(source, source.info)

    def _finish(self, success: bool, message: str) -> Result | AssemblyResult:
        sim = self.sim
        for watch in self.watches:
            watch.judge_averages()
        if success:
            sim._stand_at(float(self.times[-1]))
        else:
            # a run that stopped between two records goes on from there
            sim._reached, sim._end = sim._core.time, None
        ended = sim.state
        row, at = sim._core.whole_peaks(ended.time), 0
        sim._core.end_peaks()
        alone = len(self.bearings) == 1 and not self.bearings[0].of.name
        how: dict[str, Any] = {
            "success": success,
            "message": message,
            "stats": self._statistics(),
            "counters": sim.counters,
            "final_time": ended.time,
            "final_state": ended.vector if alone else None,
        }
        endings = []
        for one in self.bearings:
            model = one.of.model
            own = row[at : at + model.peak_length]
            names = set(peak_table.names(one.kept.fields))
            layout = [row for row in model.peak_layout() if row[0] in names]
            peaks = peak_table.from_row(own, layout) if own.size else {}
            at += model.peak_length
            if success and one.until.wanted and not self.enough:
                one.doubt(WITHOUT_CONFIDENCE.format(one.until.said or "it was too short for a look"), 4)
            if (text := dented(peaks)) and not any("(ISO 76)" in doubt for doubt in one.doubts):
                one.doubt(text, 4)
            endings.append({**how, "peaks": peaks, "warnings": one.doubts})
        if self.writer is not None:
            assert self.output is not None
            self.writer.finish(*endings)
            if success:
                checkpoint.remove(self.output, self.writer.run_id)
            results = [self._in_file(one) for one in self.bearings]
        else:
            results = [self._from_memory(one, **how) for one, how in zip(self.bearings, endings, strict=True)]
        if alone:
            return results[0]
        return AssemblyResult(
            {one.of.name: result for one, result in zip(self.bearings, results, strict=True)}, sim.assembly
        )

    def _statistics(self) -> dict[str, Any]:
        """Solver statistics of the simulation, and the times of this run (s): of its bearing, by the clock, and of stepping
        alone. Its turns are those of the subject's speed, NaN where a torque drives the shaft.
        """
        sim, start, end, spent = self.sim, float(self.times[0]), self.sim._reached, self.spent
        counted, subject, length = sim.statistics, sim.subject, end - start
        turned = abs(turns(subject.turning_rpm, start, end)) if subject.torque is None else math.nan
        stats: dict[str, Any] = {
            name: int(value) if float(value).is_integer() and abs(value) < 2**53 else value
            for name, value in counted.items()
        }
        return stats | {
            "wall_s": clock.perf_counter() - self.began,
            "stepping_s": spent,
            "bearing_time_s": length,
            "mean_step_s": length / steps if (steps := counted["steps"] - self.steps_before) > 0.0 else math.nan,
            "revolutions": turned,
            "wall_s_per_revolution": spent / turned if turned > 0.0 else math.nan,
            "real_time_factor": length / spent if spent > 0.0 else math.nan,
            "integrator": self.options.integrator,
            "instruction_set": sim.instruction_set,
        }

    def _from_memory(self, bearing: RunningBearing, **how: Any) -> Result:
        scene = bearing.of.scene
        how |= {"warnings": tuple(bearing.doubts), "geometry": asdict(scene.bearing.geometry)}
        how["meta"] = self._meta(bearing)
        return Result(bearing.kept.source(), RunInfo(scene=scene.to_dict(), **how), scene)


def look_at_all(watches: Sequence[Watch], *, final: bool) -> str | None:
    """Look at each bearing; gives the first reason why the run should end, or None."""
    return next((reason for reason in [watch.look(final=final) for watch in watches] if reason is not None), None)


def motions_digest(sim: Simulation) -> str:
    """Digest of what is prescribed for the bearings."""
    return checkpoint.digest_of(np.concatenate([one.motion.table.ravel() for one in sim.bearings]))


def _hand_over(result: Result | AssemblyResult, error: BaseException) -> None:
    """Give an error that ends a run the records so far, which nobody could get at otherwise."""
    if hasattr(error, "result"):
        return
    with contextlib.suppress(AttributeError, TypeError):
        vars(error)["result"] = result
        error.add_note(
            f"The run ended by this; its {result.time.size} records so far are in the error's attribute 'result'."
        )


def progress_bar(times: Array, *, shown: bool) -> Any:
    """A bar on the terminal over the bearing time of a run, for use as a context manager."""
    from tqdm import tqdm

    return tqdm(total=float(times[-1] - times[0]), disable=not shown, unit="s", bar_format=_BAR)


def output_times(start: float, end: float, every: float) -> Array:
    """Times of the records (s): every so often, and at the end. An InputError if there would be too many."""
    if (end - start) / every > MOST_RECORDS:
        allowed = (
            f"must be at least {(end - start) / MOST_RECORDS:.3g}, for at most {MOST_RECORDS} records in this run (s)"
        )
        raise InputError.of(("run", "save_every"), every, allowed)
    count = max(math.ceil((end - start) / every - 1e-9), 1)
    times: Array = np.asarray(start + every * np.arange(count + 1), dtype=np.float64)
    times[-1] = end
    return times
