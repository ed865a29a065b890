"""A watch over a run: whether its energy adds up, and whether it makes progress (docs/theory/numerics.md#watch-over-a-run).

The core integrates every work and every loss beside the motion, so an error of the integration shows as energy that nobody put
in or took out. The watch looks at it every few milliseconds of computing and sums it over windows of the run, and over the
whole run. A window whose energy is off by more than `WARN` of what was turned over in it gives a warning. One in which more
than `STOP` was made ends the run, as its losses, slip and forces would be wrong by as much. So does one in which that much is
missing, if losses or the work put in are a large share of what was turned over. Over the whole run it is looked at beside the
losses as well: a bearing that loses little may turn over much more.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import RunWarning
from trbdyn.run.vibrations import Vibrations

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation

Array = NDArray[np.float64]

WARN: Final = 0.01
"""Residual of the energy over the energy turned over in a window, above which a run warns."""
STOP: Final = 0.1
"""The same, above which a run ends."""
DISSIPATING: Final = 0.3
"""Share of losses, or of the work put in, in the energy turned over above which missing energy ends a run, too."""
LOST_SHARE: Final = 0.01
"""The same over the losses of the whole run, above which it warns."""
LEAST_STORED_SHARE: Final = 5e-8
"""Share of the kinetic and elastic energy below which nothing is looked at beside the losses."""
WINDOWS: Final = 20
"""Windows of a run, at most."""
STORED_SHARE: Final = 1e-3
"""Share of the kinetic and elastic energy below which an exchange of energy counts as this share."""
LEAST_ENERGY: Final = 1e-9
"""Energy below which nothing is judged (J)."""
SMALLEST_STEP: Final = 2e-8
"""Mean step with which a run makes no progress (s): a thousandth of the period of a contact's vibration, 35 kHz."""
SMALL_STEPS_WARN: Final = 20_000
SMALL_STEPS_STOP: Final = 200_000
"""Steps in a row with a mean below `SMALLEST_STEP` after which a run warns, and ends."""
REPEATED_SHARE: Final = 0.5
"""Share of steps that had to be repeated above which a run warns."""
MOST_WARNINGS: Final = 8


class Watch:
    """Watches one run.

    Parameters
    ----------
    sim : Simulation
        The simulation that runs.
    end : float
        When the run ends (s).
    found : list of str
        Where it writes what it finds, in sentences.
    going_on : bool
        Whether a run that is found wrong goes on all the same.
    """

    def __init__(self, sim: Simulation, end: float, found: list[str], *, going_on: bool = False) -> None:
        self._sim = sim
        self._found = found
        self._vibrations = (
            Vibrations(sim) if any(name == "outer_load" for name, *_ in sim._model.record_layout()) else None
        )
        self._length = max(end - sim._core.time, 0.0) / WINDOWS
        self._going_on = going_on
        self._suppressed = 0
        self._said: set[str] = set()
        self._first = self._last = self._window = self._energies()
        self._turned_over = self._turned_over_in_all = 0.0
        self._begin = self._since = sim._core.time
        self._steps, self._small_steps, self._small_since = self._counted(), 0, self._since
        self._repeated = self._repeats()

    def look(self, *, final: bool = False) -> str | None:
        """Look at the present state; gives the reason why the run should end, or None.

        Parameters
        ----------
        final : bool
            Whether the run has reached its end.
        """
        reason = self._look_at_steps()
        now = self._energies()
        for name in now:
            exchanged = 0.5 * abs(now[name] - self._last[name])
            self._turned_over += exchanged
            self._turned_over_in_all += exchanged
        self._last = now
        time = self._sim._core.time
        if (final and time > self._since) or time - self._since >= self._length:
            reason = self._judge(self._window, self._since, now, time, self._turned_over) or reason
            self._window, self._since, self._turned_over = now, time, 0.0
        if final and time > self._begin:
            reason = self._judge(self._first, self._begin, now, time, self._turned_over_in_all) or reason
            if "energy" not in self._said:
                self._judge_losses(now, time)
            text = self._vibrations and self._vibrations.judge(_missing(self._first, now)[0], self._begin, time)
            if text:
                self._say(text, "vibrations")
        return None if self._going_on else reason

    def renew(self) -> None:
        """Note that the integrator was started again, so that its counts begin at zero."""
        self._steps, self._repeated = self._counted(), self._repeats()

    def _energies(self) -> dict[str, float]:
        core = self._sim._core
        row = core.observe(core.time, core.state())
        if self._vibrations is not None:
            self._vibrations.look(np.asarray(row))
        out: dict[str, float] = {}
        for name, offset, shape in self._sim._model.record_layout():
            if shape == () and (name.startswith(("work_", "loss_")) or name in ("kinetic_energy", "elastic_energy")):
                out[name] = float(row[offset])
        return out

    def _counted(self) -> float:
        return float(self._sim._core.statistics()["steps"])

    def _repeats(self) -> float:
        statistics = self._sim._core.statistics()
        return float(statistics["error_failures"] + statistics["nonlinear_failures"])

    def _judge(
        self, then: dict[str, float], since: float, now: dict[str, float], time: float, turned_over: float
    ) -> str | None:
        missing, put_in, lost = _missing(then, now)
        stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
        scale = max(turned_over, STORED_SHARE * stored, LEAST_ENERGY)
        off = abs(missing) / scale
        if math.isfinite(off) and off <= WARN:
            return None
        what = "was made by the integration" if missing < 0.0 else "got lost in the integration"
        text = (
            f"from {since:.6g} s to {time:.6g} s the energy does not add up: "
            f"{100.0 * off:.2g} % of what was turned over {what}; losses, slip and forces there may be wrong by as much"
        )
        # where little else takes energy, vibrations that the steps do not resolve lose theirs: the run warns and goes on
        wrong = not math.isfinite(off) or (off > STOP and (missing < 0.0 or max(lost, put_in) > DISSIPATING * scale))
        if not wrong:
            self._say(text + "; try accuracy='reference', or smaller tolerances", "energy")
            return None
        self._say(text, "energy")
        advice = "Try accuracy='reference' or smaller tolerances, or when_wrong='go_on' to go on all the same"
        return f"ended at {time:.6g} s: {text}. {advice}"

    def _judge_losses(self, now: dict[str, float], time: float) -> None:
        missing, _, lost = _missing(self._first, now)
        stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
        if lost <= 0.0 or not abs(missing) > max(LOST_SHARE * lost, LEAST_STORED_SHARE * stored, LEAST_ENERGY):
            return
        self._say(
            f"from {self._begin:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, and the integration "
            f"{'took' if missing > 0.0 else 'made'} {abs(missing):.2g} J: where losses come from impacts or vibrations they "
            "may be wrong by as much; try accuracy='reference', or smaller tolerances",
            "losses",
        )

    def _look_at_steps(self) -> str | None:
        sim = self._sim
        steps, time = self._counted(), sim._core.time
        taken = steps - self._steps
        if taken < 1000:
            return None
        repeats = self._repeats()
        if repeats - self._repeated > REPEATED_SHARE * taken:
            self._say(
                f"near {time:.6g} s more than {100 * REPEATED_SHARE:.0f} % of the steps had to be repeated: "
                "the tolerances can hardly be held there",
                "repeated",
            )
        self._steps, self._repeated = steps, repeats
        mean = (time - self._small_since) / (self._small_steps + taken)
        if not mean < SMALLEST_STEP:
            self._small_steps, self._small_since = 0, time
            return None
        self._small_steps += int(taken)
        if self._small_steps < SMALL_STEPS_WARN:
            return None
        count = 1e-3 / max(mean, 1e-300)
        text = (
            f"near {time:.6g} s the steps are {mean:.1g} s long: a millisecond of bearing time takes {count:.1g} steps"
        )
        self._say(text, "steps")
        if self._small_steps < SMALL_STEPS_STOP:
            return None
        advice = (
            "Look for clearances, stiffnesses or friction that are far from usual there, try normal damping (effects.damping) "
            "or larger tolerances, or when_wrong='go_on' to go on all the same"
        )
        return f"ended at {time:.6g} s: {text}. {advice}"

    def _say(self, text: str, kind: str) -> None:
        """Keep a warning with the result, and show the first of its kind on the screen."""
        if len(self._found) < MOST_WARNINGS:
            self._found.append(text)
        else:
            self._suppressed += 1
            self._found[MOST_WARNINGS:] = [f"and {self._suppressed} more warnings"]
        if kind not in self._said:
            self._said.add(kind)
            warnings.warn(text, RunWarning, stacklevel=2)


def _missing(then: dict[str, float], now: dict[str, float]) -> tuple[float, float, float]:
    """Energy that is missing, that was put in, and that was lost between two states (J)."""
    change = {name: now[name] - then[name] for name in now}
    put_in = sum(value for name, value in change.items() if name.startswith("work_"))
    lost = sum(value for name, value in change.items() if name.startswith("loss_"))
    return put_in - lost - change["kinetic_energy"] - change["elastic_energy"], put_in, lost
