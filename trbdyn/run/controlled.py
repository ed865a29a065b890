"""A run whose callback gives inputs: feedback, with checkpoints that keep what is in force."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from trbdyn.errors import InputError
from trbdyn.run import checkpoint
from trbdyn.run.inputs import Inputs, put_back
from trbdyn.run.running import Run

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation


class Controlled(Run):
    """A run whose callback is called at each record, and gives the inputs until the next one.

    Where a checkpoint is due, the integrator starts again at the record, whether or not anybody goes on from there. A run that
    goes on asks the callback again for what it gave after that record.
    """

    between: Literal["held", "linear"] = "held"

    def _loop(self, bar: Any) -> str | None:
        sim, every = self.sim, self.options.checkpoint_every
        for one in self.bearings:
            text = (
                "a callback gave inputs while it ran; the scene of this result has those of the beginning, and the records what "
                "followed"
            )
            if text not in one.notes:
                one.notes.append(text)
        due = checkpoint.next_time(sim.time, every)
        answer = self._answer() if self.done else None
        for time in self.times[self.done :]:
            if self.done:
                sim.step(to=float(time), between=self.between, **(answer or {}))
            state = sim.state
            self._keep(sim._core.observe(state.time, state.vector)[None, :])
            bar.update(sim.time - float(self.times[0]) - bar.n)
            if sim.time >= due and self.done < self.times.size:
                sim._count()
                sim._begin(state.time, state.vector)
                due = checkpoint.next_time(sim.time, every)
                self._write_checkpoint()
            answer = self._answer()
            if self.interrupted:
                raise KeyboardInterrupt
            if answer is True:
                return f"ended by the callback at {sim.time:.6g} s"
        return None

    def _answer(self) -> Any:
        """What the callback gives: inputs, True to end, or nothing."""
        if self.callback is None:
            return None
        self.sim._running = True
        try:
            found = self.callback(self.sim)
        finally:
            self.sim._running = False
        if found is None or isinstance(found, bool | Mapping):
            return found
        raise InputError.of(
            "callback", type(found).__name__, "must give a dict of inputs, True to end the run, or None"
        )

    def _control(self) -> dict[str, Any]:
        given, memory = self.sim._inputs, self.sim.memory
        limit = "must hold finite numbers, texts, and lists and dicts of them by names, to be kept by a checkpoint"
        try:
            same = json.loads(json.dumps(memory, allow_nan=False)) == memory
        except (TypeError, ValueError, RecursionError) as error:
            raise InputError.of("memory", type(memory).__name__, f"{limit}: {error}") from None
        if not same:
            raise InputError.of("memory", repr(memory)[:200], limit)
        return {"inputs": None if given is None else given.to_dict(), "memory": memory}


def control_again(sim: Simulation[Any], kept: Mapping[str, Any]) -> None:
    """Put in force what a checkpoint has kept of a run with a callback that gives inputs."""
    if kept["inputs"] is not None:
        try:
            given = Inputs.of_dict(kept["inputs"])
        except (KeyError, TypeError, ValueError) as error:
            raise InputError.of("inputs", "kept", f"must be complete: {type(error).__name__}: {error}") from None
        sim._put(put_back(sim, given), given)
    sim.memory = kept["memory"]
