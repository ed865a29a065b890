"""A simulation: a scene, the state it is in, and what steps it on."""

from __future__ import annotations

import contextlib
import math
import signal
import threading
import time as clock
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from trbdyn import _core, checkpoint
from trbdyn import fields as field_table
from trbdyn.checkpoint import Checkpoint
from trbdyn.errors import FileError, InputError, StepError
from trbdyn.flatten import diameter_deviation, face_rows, input_error_of_core, parameter_block, scene_entries
from trbdyn.hdf5_marks import mend, take_lock
from trbdyn.motion import MAX_TIME, History
from trbdyn.result_file import ResultWriter, reason
from trbdyn.results import Result, load
from trbdyn.run_options import Group, RunOptions
from trbdyn.scene import Scene
from trbdyn.sources import FileSource, open_run, segment_paths
from trbdyn.start import Equilibrium, StateView, ring_motion, start_state

if TYPE_CHECKING:
    from trbdyn.estimate import Estimate

Array = NDArray[np.float64]
Callback = Callable[["Simulation"], bool | None]

CHUNK_RECORDS = 256
"""Records between looks at signals, callbacks and the file."""
CHUNK_STEPS = 4000
"""Steps between looks at signals: about a tenth of a second."""


@dataclass(frozen=True)
class State:
    """A state of a simulation: what is needed to go on from it.

    Attributes
    ----------
    time : float
        Time (s).
    vector : ndarray, shape (n_state,)
        The core's state vector.
    """

    time: float
    vector: Array


def build_model(scene: Scene, instruction_set: str = "") -> _core.Model:
    """The core's model of a scene.

    Raises
    ------
    InputError
        If the scene's numbers do not fit together.
    """
    try:
        return _core.Model(parameter_block(scene), diameter_deviation(scene), face_rows(scene), instruction_set)
    except _core.CoreInputError as error:
        raise input_error_of_core(error, scene_entries(scene)) from None


class Simulation:
    """Steps a scene.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.
    instruction_set : str
        Kernel variant: 'scalar', 'base', 'avx2', 'avx512'; by default the fastest that this machine runs. Results of two
        variants differ in rounding.
    **options
        Fields of `RunOptions` that set the integrator: integrator, rtol, atol_position, atol_angle, atol_velocity,
        atol_spin, max_order, max_step, first_step, rings_share, checkpoint_every.

    Raises
    ------
    InputError
        If the scene or an option cannot be used.
    LoadError
        If the bearing cannot carry the load.
    """

    def __init__(self, scene: Scene, *, accuracy: str = "standard", instruction_set: str = "", **options: Any) -> None:
        self.scene = scene
        self.options = RunOptions(accuracy=accuracy, **options)
        self._model = build_model(scene, instruction_set)
        self._motion, self.equilibrium = ring_motion(self._model, scene)
        vector = start_state(self._model, scene, self._motion, self.equilibrium)
        self._totals: dict[str, float] = {}
        self._counted: dict[str, int] = {}
        self._begin(scene.start.time, vector)
        self._reached = scene.start.time

    equilibrium: Equilibrium

    def _open(self, time: float, vector: Array) -> _core.Simulation:
        if abs(time) > MAX_TIME:
            raise InputError.of("time", time, f"must be from {-MAX_TIME:g} to {MAX_TIME:g} (s)")
        try:
            return _core.Simulation(self._model, self._motion, time, vector, self.options.settings())
        except ValueError as error:
            raise InputError.of("state", "given", str(error)) from None

    def _begin(self, time: float, vector: Array) -> None:
        """A new integrator, which knows nothing of the past: as in a new process."""
        self._core = self._open(time, vector)
        self._begun = time

    def _begin_again(self) -> None:
        """A new integrator where the present one is; what was counted stays."""
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
        """End of the last step (s)."""
        return self._core.time

    @property
    def instruction_set(self) -> str:
        """Kernel variant in use."""
        return self._model.instruction_set

    @property
    def state(self) -> State:
        """A copy of the present state."""
        return State(self._core.time, self._core.state())

    def view(self, vector: Array | None = None) -> StateView:
        """Parts of a state vector by name; of a copy of the present one by default."""
        return StateView(self._model, self._core.state() if vector is None else vector)

    def set_state(self, vector: ArrayLike | State, time: float | None = None) -> None:
        """Go on from another state; the integrator starts anew.

        Parameters
        ----------
        vector : array_like of shape (n_state,), or State
            The state.
        time : float, optional
            Its time (s); the present one by default.

        Raises
        ------
        InputError
            If it is not finite, not possible, or of the wrong length.
        """
        if isinstance(vector, State):
            given, when = vector.vector, vector.time
        else:
            given, when = _numbers(vector), self._core.time
        when = when if time is None else float(time)
        core = self._open(when, given)
        self._count()
        self._core, self._begun, self._reached = core, when, when

    def copy(self) -> Self:
        """An independent simulation at the same state; its integrator starts there."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other._totals, other._counted = {}, {}
        other._begin(self._core.time, self._core.state())
        other._reached = self._core.time
        return other

    def restart(self) -> None:
        """Start the integrator anew at the present state, as a checkpoint does."""
        self._begin_again()
        self._reached = self._core.time

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

    def estimate(
        self, *, revolutions: float | None = None, duration: float | None = None, save_every: float = 1e-4
    ) -> Estimate:
        """Expected wall time and error of a run from here, by a short probe of a copy; see `trbdyn.estimate.estimate`."""
        from trbdyn.estimate import estimate

        return estimate(self, revolutions=revolutions, duration=duration, save_every=save_every)

    def derivative(self, vector: ArrayLike | None = None, time: float | None = None) -> Array:
        """Rates of the state, shape (n_state,); at the present state by default."""
        return self._core.derivative(*self._place(vector, time))

    def record(self, vector: ArrayLike | None = None, time: float | None = None) -> dict[str, Array]:
        """Every recorded quantity by name; at the present state by default."""
        row = self._core.observe(*self._place(vector, time))
        layout = self._model.record_layout()
        return {name: row[offset : offset + math.prod(shape)].reshape(shape) for name, offset, shape in layout}

    def contacts(self, vector: ArrayLike | None = None, time: float | None = None) -> dict[str, Array]:
        """Every intermediate quantity of every contact; at the present state by default.

        Returns
        -------
        dict of str to ndarray
            ``raceway_<quantity>``, shape (2, Z, n): outer and inner race, roller, node, for interference, load, pressure,
            films, film parameter, slide-roll ratio, friction coefficient and others; ``rib_<quantity>`` and
            ``front_rib_<quantity>``, shape (Z,); ``pocket_load``, ``pocket_friction``, ``pocket_interference`` (negative:
            gap), shape (Z, slots); ``force``, ``moment`` and other wrenches, shape (Z, 3); all SI.
        """
        return self._core.contacts(*self._place(vector, time))

    def _place(self, vector: ArrayLike | None, time: float | None) -> tuple[float, Array]:
        when = self._core.time if time is None else float(time)
        if vector is None:
            return when, self._core.state()
        given = _numbers(vector)
        if given.shape != (self._model.n_state,):
            raise InputError.of(
                "state", f"an array of shape {given.shape}", f"must have the shape ({self._model.n_state},)"
            )
        return when, given

    @property
    def counters(self) -> dict[str, int]:
        """How often each effect was evaluated; zero for effects that are off."""
        return {name: value + self._counted.get(name, 0) for name, value in self._core.counters().items()}

    @property
    def statistics(self) -> dict[str, float]:
        """What the integrator did."""
        return _merged(self._totals, self._core.statistics())

    def run(
        self,
        *,
        revolutions: float | None = None,
        duration: float | None = None,
        save_every: float = 1e-4,
        save_groups: Sequence[Group] | None = None,
        output: str | Path | None = None,
        progress: bool = False,
        callback: Callback | None = None,
        checkpoint_every: float | None = None,
    ) -> Result:
        """Step on and keep records; output times never change the steps.

        Parameters
        ----------
        revolutions : float, optional
            How far to go, in turns of the shaft.
        duration : float, optional
            How far to go (s); one of both must be given.
        save_every : float
            Time between records (s).
        save_groups : sequence of str, optional
            Groups of quantities to keep; all by default.
        output : path-like, optional
            HDF5 file to write while running; without it records stay in memory.
        progress : bool
            Show a progress bar.
        callback : callable, optional
            Called with this simulation about every tenth of a second; True ends the run. What it raises ends the run too,
            after the file is closed.
        checkpoint_every : float, optional
            Bearing time between checkpoints (s), see `RunOptions`; by default that of this simulation's options. Together
            with `output`, checkpoints are written beside it, and `resume` goes on from the last one.

        Returns
        -------
        Result
            Ended by Ctrl-C or the callback it has ``success`` False and says so in ``message``.

        Raises
        ------
        InputError
            If an argument cannot be used.
        StepError
            If a step failed; its ``result`` holds everything up to the last good time.
        FileError
            If the file cannot be written.
        """
        changes: dict[str, Any] = {"revolutions": revolutions, "duration": duration, "save_every": save_every}
        changes |= {} if save_groups is None else {"save_groups": tuple(save_groups)}
        changes |= {} if checkpoint_every is None else {"checkpoint_every": checkpoint_every}
        options = self.options.replace(**changes)
        times = _output_times(self._reached, options.end_time(self.scene.speed_rpm, self._reached), options.save_every)
        run = _Run(self, options, times, callback)
        if output is not None:
            run.write_to(Path(output))
        return run.go(progress=progress)


class _Run:
    """One call of `Simulation.run`, or what is left of it when it is resumed."""

    def __init__(
        self, sim: Simulation, options: RunOptions, times: Array, callback: Callback | None, done: int = 0
    ) -> None:
        self.sim = sim
        self.options = options
        self.times = times
        self.callback = callback
        self.done = done
        self.notes: list[str] = []
        self.kept: list[Array] = []
        self.filling: Array | None = None
        self.writer: ResultWriter | None = None
        self.output: Path | None = None
        self.interrupted: list[int] = []
        self.began = clock.perf_counter()
        self.spent = 0.0

    def write_to(self, output: Path, segment: int = 0, run_id: str | None = None) -> None:
        """Write records to a file, and checkpoints beside it if there is a schedule. A new run replaces an older one."""
        sim = self.sim
        path = output if segment == 0 else output.with_name(f"{output.stem}.part{segment}{output.suffix}")
        self.writer = ResultWriter(
            path,
            scene=sim.scene,
            layout=sim._model.record_layout(),
            fields=field_table.table(),
            groups=self.options.save_groups,
            meta=self._meta(),
            geometry=asdict(sim.scene.bearing.geometry),
            run_id=run_id,
            segment=segment,
            first_record=self.done,
        )
        self.output = output
        if run_id is None:
            try:
                checkpoint.remove(output)
                for older in segment_paths(output).values():
                    older.unlink(missing_ok=True)
                if self.options.checkpoint_every is not None and sim._core.time == sim._begun:
                    self._write_checkpoint()
            except OSError as error:
                self.writer.close()
                raise error if isinstance(error, FileError) else FileError(f"{output}: {reason(error)}") from error

    def go(self, *, progress: bool) -> Result:
        from tqdm import tqdm

        sim = self.sim
        span = float(self.times[-1] - self.times[0])
        with tqdm(total=span, disable=not progress, unit="s", bar_format=_BAR) as bar:
            try:
                with _interrupts() as self.interrupted:
                    message = self._loop(bar)
            except _core.CoreStepError as error:
                result = self._finish(False, str(error))
                time, body, quantity = sim.time, *_culprit(str(error))
                raise StepError(str(error), time=time, body=body, quantity=quantity, result=result) from None
            except StepError as error:
                error.result = self._finish(False, str(error))
                raise
            except KeyboardInterrupt:
                if self.filling is not None:
                    self._keep(self.filling[: int(np.count_nonzero(np.isfinite(self.filling[:, 0])))])
                return self._finish(False, f"stopped by the user at {sim.time:.6g} s")
            except FileError:
                self._abandon()
                raise
            except BaseException as error:
                self._finish(False, f"ended by {type(error).__name__} at {sim.time:.6g} s: {error}")
                raise
        return self._finish(message is None, message or f"reached {self.times[-1]:.6g} s")

    def _loop(self, bar: Any) -> str | None:
        """Until all records are filled; what ended the run before, or None."""
        sim, every = self.sim, self.options.checkpoint_every
        due = checkpoint.next_time(sim._begun, every)
        while self.done < self.times.size:
            chunk = self.times[self.done : self.done + CHUNK_RECORDS]
            # a signal may come before the core's answer does: what is filled is seen by its finite times
            self.filling = records = np.full((chunk.size, sim._model.record_length), np.nan)
            before = clock.perf_counter()
            try:
                rows, _ = sim._core.run(chunk, records, CHUNK_STEPS, due)
            except _core.CoreStepError as error:
                self._keep(records[: getattr(error, "rows", 0)])
                raise
            finally:
                self.spent += clock.perf_counter() - before
            self.filling = None
            self._keep(records[:rows])
            # the records up to here are made with the past that the integrator is about to forget
            if sim.time >= due and self.done < self.times.size and self.times[self.done] > sim.time:
                sim._begin_again()
                due = checkpoint.next_time(sim.time, every)
                self._write_checkpoint()
            bar.update(min(sim.time, float(self.times[-1])) - float(self.times[0]) - bar.n)
            if sim.scene.effects.bodies == "rollers" and rows:
                _check_apart(sim, records[:rows])
            ended = self.callback is not None and self.callback(sim)
            if self.interrupted:
                raise KeyboardInterrupt
            if ended:
                return f"ended by the callback at {sim.time:.6g} s"
        return None

    def _keep(self, records: Array) -> None:
        if not len(records):
            return
        self.done += len(records)
        self.sim._reached = float(self.times[self.done - 1])
        if self.writer is None:
            self.kept.append(records)
        else:
            self.writer.append(records)

    def _write_checkpoint(self) -> None:
        """Where the run is now; its records go to the disk first."""
        if self.writer is None or self.output is None:
            return
        sim = self.sim
        self.writer.sync()
        found = Checkpoint(
            run_id=self.writer.run_id,
            scene=sim.scene.to_dict(),
            model=sim.scene.fingerprint,
            options=self.options.to_dict(),
            instruction_set=sim.instruction_set,
            build=checkpoint.build_digest(),
            motion=checkpoint.digest_of(sim._motion),
            start=float(self.times[0]),
            end=float(self.times[-1]),
            time=sim.time,
            done=self.done,
            statistics=sim._totals,
            counters=sim._counted,
            stepping_s=self.spent,
            state=sim._core.state(),
        )
        checkpoint.write(checkpoint.checkpoint_path(self.output), found)

    def _abandon(self) -> None:
        """Leave a result file that cannot be written as it is: the records in it can be read, a checkpoint goes on from there."""
        if self.writer is not None:
            with contextlib.suppress(FileError):
                self.writer.close()

    def _meta(self) -> dict[str, Any]:
        settings = {name: value for name, value in self.options.to_dict().items() if name not in ("save_groups",)}
        return {
            "instruction_set": self.sim.instruction_set,
            "sundials_version": _core.sundials_version(),
            "core_version": _core.version(),
            "settings": settings,
            "notes": self.notes,
        }

    def _stats(self) -> dict[str, Any]:
        """Solver statistics of the whole simulation, and the wall time of this run."""
        sim = self.sim
        turned = abs(_turns(sim.scene.speed_rpm, float(self.times[0]), sim._reached))
        bearing = sim._reached - float(self.times[0])
        stats: dict[str, Any] = {
            name: int(value) if float(value).is_integer() and abs(value) < 2**53 else value
            for name, value in sim.statistics.items()
        }
        return stats | {
            "wall_s": clock.perf_counter() - self.began,
            "stepping_s": self.spent,
            "bearing_time_s": bearing,
            "revolutions": turned,
            "wall_s_per_revolution": self.spent / turned if turned > 0.0 else math.nan,
            "real_time_factor": bearing / self.spent if self.spent > 0.0 else math.nan,
            "integrator": self.options.integrator,
            "instruction_set": sim.instruction_set,
        }

    def _finish(self, success: bool, message: str) -> Result:
        sim, ended = self.sim, self.sim.state
        if not success:
            # what stopped between two records goes on from where it stands
            sim._reached = ended.time
        how: dict[str, Any] = {
            "success": success,
            "message": message,
            "stats": self._stats(),
            "counters": sim.counters,
            "final_time": ended.time,
            "final_state": ended.vector,
        }
        if self.writer is not None:
            assert self.output is not None
            self.writer.finish(**how)
            if success:
                checkpoint.remove(self.output)
            return load(self.output)
        records = np.concatenate(self.kept) if self.kept else np.empty((0, sim._model.record_length))
        return Result.from_records(
            records,
            sim._model.record_layout(),
            scene=sim.scene,
            geometry=asdict(sim.scene.bearing.geometry),
            meta=self._meta(),
            groups=self.options.save_groups,
            **how,
        )


def resume(
    path: str | Path,
    *,
    instruction_set: str | None = None,
    progress: bool = False,
    callback: Callback | None = None,
) -> Result:
    """Go on with a run that was cut off, from its last checkpoint.

    It takes the steps that the uninterrupted run would have taken: records and final state are bit-identical, on the same build
    and instruction set. Records go to a segment of their own, ``run.part1.h5``, which `load` joins to ``run.h5``.

    Parameters
    ----------
    path : path-like
        The run's result file; its checkpoints lie beside it.
    instruction_set : str, optional
        Kernel variant to go on with, where it shall not be that of the checkpoint.
    progress : bool
        Show a progress bar.
    callback : callable, optional
        As in `Simulation.run`.

    Returns
    -------
    Result
        The whole run. If it was complete already, nothing is done.

    Raises
    ------
    FileError
        If there is no checkpoint that can be used, or another process is writing the run.
    InputError
        If this machine does not run the instruction set.
    StepError
        As in `Simulation.run`.

    Warns
    -----
    UserWarning
        If an older checkpoint had to be used, or results will not be bit-identical; ``result.meta["notes"]`` says so too.
    """
    output = Path(path)
    notes: list[str] = []

    def tell(note: str) -> None:
        notes.append(note)
        warnings.warn(note, UserWarning, stacklevel=3)

    def run_on(first: FileSource | None) -> Result:
        found = checkpoint.read_last_good(output, tell)
        if first is not None and first.run_id != found.run_id:
            raise FileError(
                f"{checkpoint.checkpoint_path(output)}: the checkpoint belongs to another run than {output}"
            )
        sim, options = _revive(output, found, instruction_set, tell)
        times = _output_times(found.start, found.end, options.save_every)
        if found.done >= times.size:
            raise FileError(
                f"{checkpoint.checkpoint_path(output)}: the checkpoint cannot be used: it has too many records"
            )
        run = _Run(sim, options, times, callback, found.done)
        run.notes, run.spent = notes, found.stepping_s
        # where nothing is lost by it, the first segment is made anew
        anew = first is None and found.done == 0
        segment = 0 if anew else 1 + max(segment_paths(output), default=0)
        run.write_to(output, segment, found.run_id)
        return run.go(progress=progress)

    if not output.exists():
        return run_on(None)
    try:
        lock = take_lock(output)
    except OSError as error:
        raise FileError(f"{output}: cannot be resumed: {reason(error)}") from error
    with lock:
        for segment in (output, *segment_paths(output).values()):
            mend(segment)
        if _is_complete(output):
            return load(output)
        try:
            first = FileSource(output)
        except FileError as error:
            tell(f"{error}; its records are lost, those from the checkpoint on will be written")
            first = None
            lock.close()
        return run_on(first)


def _is_complete(output: Path) -> bool:
    try:
        return open_run(output)[1].success
    except FileError:
        return False


def _revive(
    output: Path, found: Checkpoint, instruction_set: str | None, tell: Callable[[str], None]
) -> tuple[Simulation, RunOptions]:
    """A simulation at a checkpoint."""
    where = checkpoint.checkpoint_path(output)
    variant = checkpoint.check_instruction_set(found, instruction_set, tell)
    try:
        scene, options = Scene.from_dict(found.scene), RunOptions.from_dict(found.options)
        if scene.fingerprint != found.model:
            raise FileError(
                f"{where}: the checkpoint cannot be used: its scene is not the one that its model hash belongs to"
            )
        settings = {name: getattr(options, name) for name in RunOptions.model_fields if name not in _OF_A_RUN}
        sim = Simulation(scene, instruction_set=variant, **settings)
        if found.build != checkpoint.build_digest():
            tell("going on with another build of the core: results may differ in rounding from the uninterrupted run")
        elif found.motion != checkpoint.digest_of(sim._motion):
            tell(
                "the ring's equilibrium differs in rounding on this machine: results may differ from the uninterrupted run"
            )
        sim._begin(found.time, found.state)
    except InputError as error:
        raise FileError(f"{where}: the checkpoint cannot be used: {error}") from error
    sim._totals, sim._counted = dict(found.statistics), dict(found.counters)
    return sim, options


_OF_A_RUN = ("revolutions", "duration", "save_every", "save_groups")
"""Fields of `RunOptions` that belong to one run of a simulation."""


def _output_times(start: float, end: float, every: float) -> Array:
    count = max(math.ceil((end - start) / every - 1e-9), 1)
    times: Array = np.asarray(start + every * np.arange(count + 1), dtype=np.float64)
    times[-1] = end
    return times


def _numbers(values: ArrayLike) -> Array:
    """A state vector as users give it.

    Raises
    ------
    InputError
        If it is no sequence of numbers.
    """
    try:
        return np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError.of("state", "given", f"must be a vector of numbers: {error}") from None


_COUNTED_ONCE = ("last_step", "last_order")


def _merged(before: dict[str, float], now: dict[str, float]) -> dict[str, float]:
    """Statistics of one integrator added to those of the ones before it."""
    if not before:
        return now
    merged = {name: value + before.get(name, 0.0) for name, value in now.items()}
    merged["smallest_step"] = min(before.get("smallest_step", math.inf), now["smallest_step"])
    stepped = now["steps"] > 0
    return merged | {name: now[name] if stepped else before.get(name, now[name]) for name in _COUNTED_ONCE}


@contextlib.contextmanager
def _interrupts() -> Iterator[list[int]]:
    """A list that Ctrl-C adds to, so that it comes between steps and records and never gets lost; a second one comes at once."""
    caught: list[int] = []
    before = signal.getsignal(signal.SIGINT)

    def catch(number: int, frame: FrameType | None) -> None:
        caught.append(number)
        signal.signal(signal.SIGINT, before)

    if threading.current_thread() is not threading.main_thread() or before is not signal.default_int_handler:
        yield caught
        return
    signal.signal(signal.SIGINT, catch)
    try:
        yield caught
    finally:
        signal.signal(signal.SIGINT, before)


_BAR = "{percentage:3.0f}% |{bar}| {n:.4g}/{total:.4g} s of bearing time [{elapsed}<{remaining}]"


def _turns(speed_rpm: float | History, start: float, end: float) -> float:
    if isinstance(speed_rpm, History):
        return speed_rpm.integral(start, end) / 60.0
    return speed_rpm * (end - start) / 60.0


def _culprit(text: str) -> tuple[str | None, str | None]:
    """Body and quantity named at the end of the core's message."""
    _, _, named = text.partition("largest error: ")
    body, _, quantity = named.partition(", ")
    return (body or None, quantity or None) if quantity else (None, None)


def _check_apart(sim: Simulation, records: Array) -> None:
    """Rollers without a cage must not touch each other, as nothing in the model keeps them apart."""
    places = {name: (offset, shape) for name, offset, shape in sim._model.record_layout()}
    offset, (count,) = places["roller_orbit_angle"]
    angles = np.sort(np.mod(records[:, offset : offset + count], 2.0 * math.pi), axis=1)
    gaps = np.diff(np.concatenate([angles, angles[:, :1] + 2.0 * math.pi], axis=1), axis=1)
    bearing = sim.scene.bearing
    nearest = bearing.pitch_diameter * np.sin(0.5 * gaps.min(axis=1))
    if float(nearest.min()) < bearing.roller.diameter:
        raise StepError(
            f"two rollers touch before {sim.time:.6g} s: without a cage nothing in the model keeps them apart; "
            "shorten the run or give effects.bodies = 'rollers_and_cage'",
            time=sim.time,
            body="rollers",
            quantity="spacing",
        )
