"""One run of bearings on one shaft: the records of each, checkpoints, and how it ends."""

from __future__ import annotations

import contextlib
import time as clock
import uuid
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.errors import FileError, RunWarning, StepError
from trbdyn.results import fields as field_table
from trbdyn.results import peaks as peak_table
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.assembly_file import gather, part_path
from trbdyn.results.file_format import RunInfo, reason
from trbdyn.results.result import Result, load
from trbdyn.results.result_file import ResultWriter
from trbdyn.results.sources import FileSource
from trbdyn.run import checkpoint, keeping
from trbdyn.run.checkpoint import Checkpoint
from trbdyn.run.memory import Kept
from trbdyn.run.options import RunOptions
from trbdyn.run.process import has_a_spare_core, interrupts
from trbdyn.run.running import CHUNK_RECORDS, CHUNK_STEPS, progress_bar, statistics_of
from trbdyn.run.until import Until, check_wanted
from trbdyn.run.watch import RING_GONE, Watch
from trbdyn.statics.plausible import dented
from trbdyn.statics.seat import Seat

if TYPE_CHECKING:
    from trbdyn.run.assembly import AssemblySimulation

Array = NDArray[np.float64]
Layout = list[tuple[str, int, tuple[int, ...]]]

WITHOUT_BIAS: Final = (
    "The bias of the presets was measured with one bearing whose ring is held, not with bearings on a shaft."
)
SUBJECT: Final = "assembly"
"""Key of a checkpoint's scene under which the assembly is described."""


@dataclass
class RunningBearing:
    """A bearing while it runs.

    Attributes
    ----------
    name, seat : str, Seat
        Its name, and where it sits.
    layout : list
        Places of its fields in its part of a row.
    first : int
        Where its part of a row begins.
    fields : tuple
        What its records are.
    doubts : list of str
        What the watch has found.
    until : Until
        How well its averages are known.
    kept : Kept or ResultWriter
        Its records.
    """

    name: str
    seat: Seat
    layout: Layout
    first: int
    fields: tuple[field_table.Field, ...]
    doubts: list[str]
    until: Until
    kept: Kept | ResultWriter


def subject_of(found: Checkpoint) -> dict[str, Any] | None:
    """The assembly of a checkpoint, as plain data; None for a checkpoint of one bearing."""
    described = found.scene.get(SUBJECT)
    return described if isinstance(described, dict) else None


def motions_digest(sim: AssemblySimulation) -> str:
    """Digest of what is prescribed for the bearings."""
    return checkpoint.digest_of(np.concatenate([motion.table.ravel() for motion in sim._seated.motions]))


class AssemblyRun:
    """One call of `AssemblySimulation.run`, or what is left of it when it is resumed.

    Parameters
    ----------
    sim : AssemblySimulation
        Whose run it is.
    options : RunOptions
        Its options.
    times : ndarray
        Times of its records (s).
    done : int
        Records that it has made already.
    """

    def __init__(self, sim: AssemblySimulation, options: RunOptions, times: Array, done: int = 0) -> None:
        self.sim, self.options, self.times, self.done = sim, options, times, done
        self.path: Path | None = None
        self.overwrite = False
        self.run_id = uuid.uuid4().hex
        self.enough = ""
        self.spent, self.began = 0.0, clock.perf_counter()
        self.bearings = self._bearings()

    def _bearings(self) -> list[RunningBearing]:
        sim, out, at = self.sim, [], 0
        with_peaks = peak_table.GROUP in self.options.save_groups
        fields = field_table.table() + (peak_table.table() if with_peaks else ())
        kept_fields = field_table.select(fields, self.options.save_groups)
        for number, ((name, seat), model) in enumerate(zip(sim.seats.items(), sim._seated.models, strict=True)):
            layout, length = list(model.record_layout()), model.record_length
            if with_peaks:
                layout += [(field, first + length, shape) for field, first, shape in model.peak_layout()]
                length += model.peak_length
            has_cage = seat.scene.effects.bodies == "rollers_and_cage"
            check_wanted(self.options.until, self.options.save_groups, {field for field, _, _ in layout}, has_cage)
            until, doubts = Until(self.options.until, self.times.size), list(sim._seated.unusual[number])
            out.append(RunningBearing(name, seat, layout, at, fields, doubts, until, Kept(layout, kept_fields)))
            at += length
        return out

    def write_to(
        self, path: Path, *, overwrite: bool, older: Mapping[str, FileSource] | None = None, run_id: str | None = None
    ) -> None:
        """Write the records of each bearing to a file of its own, and checkpoints if there is a schedule.

        Parameters
        ----------
        path : Path
            File of the whole.
        overwrite : bool
            Replace files that are there.
        older : mapping of str to FileSource, optional
            What a run that goes on has written for each bearing.
        run_id : str, optional
            Name of a run that goes on.
        """
        scheduled = self.options.checkpoint_every is not None
        if run_id is None and scheduled:
            checkpoint.check_free(path, None, overwrite=overwrite)
        self.run_id = run_id or self.run_id
        for number, bearing in enumerate(self.bearings):
            before = None if older is None else older[bearing.name]
            try:
                bearing.kept = ResultWriter(
                    part_path(path, bearing.name),
                    scene=bearing.seat.scene,
                    layout=bearing.layout,
                    fields=bearing.fields,
                    groups=self.options.save_groups,
                    meta=self._meta(bearing),
                    geometry=asdict(bearing.seat.scene.bearing.geometry),
                    run_id=self.run_id,
                    first_record=0 if before is None else before.first_record,
                    taken_over=None if before is None else (before, self.done - before.first_record),
                    expected=self.times.size,
                    overwrite=overwrite or older is not None,
                )
            except FileError:
                self.close()
                for one in self.bearings[:number] if older is None else ():
                    part_path(path, one.name).unlink(missing_ok=True)
                raise
        self.path, self.overwrite = path, overwrite
        if run_id is None and scheduled:
            checkpoint.clear(path)

    def close(self) -> None:
        """Close what a run that does not end as it should has begun to write."""
        for bearing in self.bearings:
            if isinstance(bearing.kept, ResultWriter):
                with contextlib.suppress(FileError):
                    bearing.kept.close()

    def go(self, *, progress: bool) -> AssemblyResult:
        sim = self.sim
        self._keep_peaks(float(self.times[0]))
        try:
            if self.path is not None and self.options.checkpoint_every is not None and not self.done:
                self._write_checkpoint()
            with interrupts() as interrupted, progress_bar(self.times, shown=progress) as bar:
                message = self._loop(interrupted, bar)
        except _core.CoreStepError as error:
            raise StepError(str(error), time=sim._core.time, result=self._finish(False, str(error))) from None
        except BaseException:
            sim._core.end_peaks()
            self.close()
            raise
        return self._finish(message is None, message or self.enough or f"reached {self.times[-1]:.6g} s")

    def _keep_peaks(self, since: float) -> None:
        """Start to keep peaks, if the run asks for them and does not keep them yet."""
        core, plain = self.sim._core, sum(model.record_length for model in self.sim._seated.models)
        if peak_table.GROUP in self.options.save_groups and core.row_length == plain:
            core.begin_peaks(since)

    def _loop(self, interrupted: list[int], bar: Any) -> str | None:
        """Step until all records are filled; gives the reason if the run ended before, else None."""
        sim, beside, every = self.sim, has_a_spare_core(), self.options.checkpoint_every
        going_on = self.options.when_wrong == "go_on"
        watches = [
            Watch(seen, float(self.times[-1]), bearing.doubts, going_on=going_on, of=bearing.name)
            for seen, bearing in zip(sim._seen, self.bearings, strict=True)
        ]
        due = checkpoint.next_time(sim._begun, every)
        while self.done < self.times.size:
            look = self.bearings[0].until.next_look(self.done)
            chunk = self.times[self.done : min(self.done + CHUNK_RECORDS, look or self.times.size)]
            records = np.empty((chunk.size, sim._core.row_length))
            before = clock.perf_counter()
            try:
                rows, _ = sim._core.run(chunk, records, CHUNK_STEPS, due, beside)
            except _core.CoreStepError as error:
                self._keep(records[: getattr(error, "rows", 0)])
                raise
            finally:
                self.spent += clock.perf_counter() - before
            self._keep(records[:rows])
            # records up to here need the history that the integrator is about to forget
            if sim._core.time >= due and self.done < self.times.size and self.times[self.done] > sim._core.time:
                due = self._begin_again(watches)
            bar.update(sim.time - float(self.times[0]) - bar.n)
            final = self.done >= self.times.size or (rows > 0 and self._is_enough())
            doubts = [watch.look(final=final) for watch in watches]
            doubts += [self._gone(bearing, records[:rows]) for bearing in self.bearings]
            if interrupted:
                return f"stopped by the user at {sim._core.time:.6g} s"
            if (doubt := next((text for text in doubts if text is not None), None)) is not None:
                return doubt
        return None

    def _begin_again(self, watches: Sequence[Watch]) -> float:
        """Start the integrator again, as a run does that goes on from the checkpoint; gives when the next one is due (s)."""
        sim = self.sim
        peaks = sim._core.save_peaks()
        sim._begin_again()
        if peaks.size:
            sim._core.restore_peaks(peaks)
        for watch in watches:
            watch.renew()
        self._write_checkpoint()
        return checkpoint.next_time(sim._core.time, self.options.checkpoint_every)

    def _is_enough(self) -> bool:
        """Whether all bearings are known well enough; the run then ends at the last record."""
        # each is asked, so that each says what is known
        reached = [one.until.reached(self.done, lambda one=one: self._so_far(one)) for one in self.bearings]  # type: ignore[misc]
        if not (self.options.until and all(reached)):
            return False
        self.times = self.times[: self.done]
        said = "; ".join(f"{one.name}: {one.until.said}" for one in self.bearings)
        self.enough = f"reached {self.sim._reached:.6g} s, as far as was needed: {said}"
        return True

    def _so_far(self, bearing: RunningBearing) -> Result:
        if isinstance(bearing.kept, ResultWriter):
            bearing.kept.flush()
            return load(bearing.kept.path)
        return self._from_memory(bearing, {"final_time": self.sim._reached})

    def _gone(self, bearing: RunningBearing, rows: Array) -> str | None:
        """A ring that nothing holds any more leaves its bearing: what follows means nothing."""
        place = next(at for name, at, _ in bearing.layout if name == "ring_position") + bearing.first
        moved = float(np.abs(rows[:, place : place + 3]).max(initial=0.0))
        if not moved > RING_GONE * bearing.seat.scene.bearing.roller.diameter:
            return None
        text = f"the ring stands {1e3 * moved:.3g} mm from its place: nothing holds the shaft there"
        self._doubt(bearing, text)
        return f"ended: {bearing.name}: {text}"

    def _doubt(self, bearing: RunningBearing, text: str) -> None:
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

    def _write_checkpoint(self) -> None:
        """Write where the run is now; its records are written to the disk first."""
        sim = self.sim
        if self.path is None or sim.assembly is None:
            return
        for bearing in self.bearings:
            assert isinstance(bearing.kept, ResultWriter)
            bearing.kept.sync()
        found = Checkpoint(
            run_id=self.run_id,
            scene={SUBJECT: sim.assembly.to_dict()},
            model=sim.assembly.fingerprint,
            options=self.options.to_dict(),
            instruction_set=sim._seated.models[0].instruction_set,
            build=checkpoint.build_digest(),
            motion=motions_digest(sim),
            start=float(self.times[0]),
            end=float(self.times[-1]),
            time=sim._core.time,
            done=self.done,
            statistics=sim._totals,
            counters=sim._counted,
            stepping_s=self.spent,
            state=sim._core.state(),
            peaks=sim._core.save_peaks(),
            warnings=[f"{one.name}: {text}" for one in self.bearings for text in one.doubts],
        )
        checkpoint.write(checkpoint.checkpoint_path(self.path), found)

    def _say_what_is_missing(self, bearing: RunningBearing) -> None:
        said = bearing.until.said or "it was too short for a look"
        text = (
            f"the run has reached its end without the confidence that was asked for: {said}. A longer run may reach it"
        )
        self._doubt(bearing, text)

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
            if (text := dented(peaks)) and text not in bearing.doubts:
                self._doubt(bearing, text)
            if success and self.options.until and not self.enough:
                self._say_what_is_missing(bearing)
            how: dict[str, Any] = {
                "peaks": peaks,
                "success": success,
                "message": message,
                "stats": stats,
                "counters": sim.counters,
                "warnings": bearing.doubts,
                "final_time": sim._reached,
                "final_state": None,
            }
            results[bearing.name] = self._result(bearing, how)
        if self.path is None:
            return AssemblyResult(results, sim.assembly)
        if not success and self.options.checkpoint_every is not None:
            # the files of the bearings stay as they are, to go on from the last checkpoint
            return AssemblyResult(results, sim.assembly)
        parts = {name: part_path(self.path, name) for name in results}
        described = None if sim.assembly is None else sim.assembly.to_dict()
        gather(self.path, parts, described, overwrite=self.overwrite)
        checkpoint.remove(self.path, self.run_id)
        return AssemblyResult.load(self.path)

    def _result(self, bearing: RunningBearing, how: dict[str, Any]) -> Result:
        if isinstance(bearing.kept, ResultWriter):
            bearing.kept.finish(**how)
            return load(bearing.kept.path)
        return self._from_memory(bearing, how)

    def _from_memory(self, bearing: RunningBearing, how: dict[str, Any]) -> Result:
        assert isinstance(bearing.kept, Kept)
        scene = bearing.seat.scene
        how = {**how, "warnings": tuple(bearing.doubts), "geometry": asdict(scene.bearing.geometry)}
        return Result(bearing.kept.source(), RunInfo(scene=scene.to_dict(), meta=self._meta(bearing), **how), scene)

    def _meta(self, bearing: RunningBearing) -> dict[str, Any]:
        sim, options = self.sim, self.options
        settings = {key: value for key, value in options.to_dict().items() if key != "save_groups"}
        return {
            "instruction_set": sim._seated.models[0].instruction_set,
            "sundials_version": _core.sundials_version(),
            "core_version": _core.version(),
            "settings": settings,
            "kept": keeping.said(options.save_every or 0.0, options.save_groups),
            "notes": list(sim._seated.unusual[list(sim.seats).index(bearing.name)]),
            "accuracy": WITHOUT_BIAS,
            "assembly": {
                "bearing": bearing.name,
                "bearings": list(sim.seats),
                "seat": sim.seats[bearing.name].numbers(),
            },
        }


def older_parts(path: Path, names: Sequence[str], found: Checkpoint) -> dict[str, FileSource]:
    """What a run that was cut off has written for each bearing.

    Parameters
    ----------
    path : Path
        File of the whole.
    names : sequence of str
        The bearings.
    found : Checkpoint
        The checkpoint to go on from.

    Raises
    ------
    FileError
        If the file of a bearing is missing, damaged, of another run, or too short.
    """
    out: dict[str, FileSource] = {}
    for name in names:
        part = part_path(path, name)
        try:
            source = FileSource(part)
            source.check()
        except OSError as error:
            raise FileError(f"{part}: the records of bearing {name!r} cannot be read: {reason(error)}") from error
        if source.run_id != found.run_id:
            raise FileError(f"{part}: these records belong to another run than the checkpoint")
        if source.first_record + source.n_records < found.done:
            raise FileError(f"{part}: the file holds fewer records than its checkpoint says")
        out[name] = source
    return out
