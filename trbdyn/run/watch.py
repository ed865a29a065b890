"""A watch over a run: whether its energy adds up, and whether it makes progress (docs/theory/numerics.md#watch-over-a-run).

The core integrates every work and every loss beside the motion, so an error of the integration shows as energy that nobody put
in or took out. It is looked at every few milliseconds of computing and summed over windows of the run, over the run, and over
all runs of one simulation. What is wrong with averages warns; what was made in a window, or is missing there of much that is
lost or put in, ends the run. Vibrations have a judge of their own (`trbdyn.run.vibrations`).
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from trbdyn.errors import RunWarning
from trbdyn.model.motion import value_at
from trbdyn.run.energies import LEAST_ENERGY, LEAST_STORED_SHARE, Span, missing, scale
from trbdyn.run.stretch import SHORTEST
from trbdyn.run.vibrations import TIGHTER, Seen, Vibrations

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

WARN: Final = 0.01
"""Residual of the energy over the energy turned over in what averages are made of, above which a run warns."""
STOP: Final = 0.1
"""The same in a window, above which a run ends."""
TRANSIENT: Final = 0.5
"""Share of a run that averages leave out at most (`trbdyn.Result.settled`)."""
DISSIPATING: Final = 0.3
"""Share of losses, or of the work put in, in the energy turned over above which missing energy ends a run, too."""
LOST_SHARE: Final = 0.01
"""The same over the losses of the whole run, above which it warns."""
WINDOWS: Final = 20
"""Windows of a run, at most."""
SMALLEST_STEP: Final = 2e-8
"""Mean step with which a run makes no progress (s): a thousandth of the period of a contact's vibration, 35 kHz."""
SMALL_STEPS_WARN: Final = 20_000
SMALL_STEPS_STOP: Final = 200_000
"""Steps in a row with a mean below `SMALLEST_STEP` after which a run warns, and ends."""
RING_LOOSE: Final = 0.1
"""Way of a free ring from its place, over the diameter of a roller, from which on nothing seems to hold it."""
RING_GONE: Final = 0.5
"""The same at which it has left its bearing: up to there bounds of contacts are proven."""
REPEATED_SHARE: Final = 0.5
"""Share of steps that had to be repeated above which a run warns."""
MOST_WARNINGS: Final = 8
UNLOADED: Final = 1e-3
"""Load of a roller on the inner raceway, over the largest one, up to which nothing but a cage drives it."""
SLIDING: Final = 3e-3
"""Slip of rollers that a spacer holds from which on a cage may matter (1)."""


@dataclass
class Account:
    """What the watch has seen since a simulation began, and goes on with in the simulation's next run."""

    whole: Span
    said: set[str] = field(default_factory=set)
    small_steps: int = 0
    small_since: float = 0.0
    vibrations: Seen = field(default_factory=Seen)


class Watch:
    """Watches one bearing in a run that ends at a time (s), and adds what it finds to a list, in sentences; what was seen in
    earlier runs of the simulation is kept with it. `going_on`: a run that is found wrong goes on all the same.
    """

    def __init__(
        self, sim: Simulation, bearing: SeatedBearing, end: float, found: list[str], *, going_on: bool = False
    ) -> None:
        self._sim, self._bearing = sim, bearing
        self._found = found
        self._length = max(end - sim._core.time, 0.0) / WINDOWS
        self._going_on = going_on
        self._suppressed = 0
        self._noted: set[str] = set()
        now, time = self._energies(), sim._core.time
        if bearing.name not in sim._accounts:
            sim._accounts[bearing.name] = Account(self._span(time, now), small_since=time)
        self._account = sim._accounts[bearing.name]
        self._vibrations = Vibrations(sim, bearing, self._account.whole, self._account.vibrations)
        self._windows: list[tuple[float, float, float]] = []
        self._last, self._last_time = now, time
        self._run, self._window, self._vibrating = (self._span(time, now) for _ in range(3))
        self._steps, self._repeated = self._counted(), self._repeats()

    def look(self, *, final: bool = False) -> str | None:
        """Look at the present state, `final` at the end of the run; gives the reason why the run should end, or None."""
        now, time = self._energies(), self._sim._core.time
        self._last_time = time
        reason = self._look_at_steps() or self._look_at_ring() or self._look_at_shaft()
        exchanged = sum(0.5 * abs(now[name] - self._last[name]) for name in now)
        for span in (self._window, self._vibrating, self._run, self._account.whole):
            span.add(exchanged, now["elastic_energy"])
        self._last = now
        if (final and time > self._window.since) or time - self._window.since >= self._length:
            reason = self._judge(self._window, now, time, STOP) or reason
            self._windows.append((self._window.since, missing(self._window.first, now)[0], self._window.turned_over))
            self._judge_unloaded(time)
            self._window = self._span(time, now)
        # windows of a short run are too short to see a vibration in
        if time - self._vibrating.since >= max(self._length, SHORTEST):
            self._vibrations.look(self._vibrating, now, time)
            self._vibrating = self._span(time, now)
        if final and time > self._run.since:
            reason = self._judge(self._run, now, time, STOP) or reason
            self.judge_averages()
            # what a short piece does not show may show in all of them
            if self._account.whole.since < self._run.since and "energy" not in self._noted:
                self._judge(self._account.whole, now, time, WARN)
            if "energy" not in self._noted:
                self._judge_losses(now, time)
            self._say(self._vibrations.judge(self._run, now, time), "vibrations")
            if not self._noted & {"energy", "losses", "vibrations"}:
                self._say(self._vibrations.small_losses(now, time), "small losses")
            self._judge_slip(time)
            self._judge_unloaded(time)
        return None if self._going_on else reason

    def renew(self) -> None:
        """Note that the integrator was started again, so that its counts begin at zero."""
        self._steps, self._repeated = self._counted(), self._repeats()

    def _span(self, time: float, now: dict[str, float]) -> Span:
        return Span(time, now, self._sim._core.state())

    def _energies(self) -> dict[str, float]:
        core = self._sim._core
        row = core.observe(core.time, core.state())
        out: dict[str, float] = {}
        for name, offset, shape in self._bearing.record_layout:
            if name == "ring_position":
                self._moved = float(np.abs(row[offset : offset + 3]).max())
            if shape == () and (name.startswith(("work_", "loss_")) or name in ("kinetic_energy", "elastic_energy")):
                out[name] = float(row[offset])
        return out

    def _counted(self) -> float:
        return float(self._sim._core.statistics()["steps"])

    def _repeats(self) -> float:
        statistics = self._sim._core.statistics()
        return float(statistics["error_failures"] + statistics["nonlinear_failures"])

    def averages_doubts(self, *, named: bool = False) -> list[str]:
        """What is wrong with averages over the run so far, or over what follows its transient, if it was not said; with the
        bearing's name where several run.
        """
        if not self._windows or "energy" in self._noted:
            return []
        first, end = self._windows[0][0], self._last_time
        latest = first + TRANSIENT * (end - first) + self._length
        for number, (since, _, _) in enumerate(self._windows):
            if number and since > latest:
                break
            lacking = [one for _, one, _ in self._windows[number:]]
            turned_over = sum(one for _, _, one in self._windows[number:])
            off = sum(map(abs, lacking)) / scale(turned_over, self._last)
            if off > WARN:
                return [f"{self._bearing.said if named else ''}{_said(since, end, off, sum(lacking))}; {TIGHTER}"]
        return []

    def judge_averages(self) -> None:
        """Say it with the result, once."""
        for text in self.averages_doubts():
            self._say(text, "energy")

    def _judge(self, span: Span, now: dict[str, float], time: float, most: float) -> str | None:
        lacking, put_in, lost = missing(span.first, now)
        size = scale(span.turned_over, now)
        off = abs(lacking) / size
        if math.isfinite(off) and off <= most:
            return None
        text = _said(span.since, time, off, lacking)
        # where little else takes energy, vibrations that the steps do not resolve lose theirs: the run warns and goes on
        wrong = not math.isfinite(off) or (off > STOP and (lacking < 0.0 or max(lost, put_in) > DISSIPATING * size))
        if not wrong:
            self._say(f"{text}; {TIGHTER}", "energy")
            return None
        self._say(text, "energy")
        advice = "Try accuracy='reference' or smaller tolerances, or when_wrong='go_on' to go on all the same"
        return f"ended at {time:.6g} s: {text}. {advice}"

    def _judge_losses(self, now: dict[str, float], time: float) -> None:
        whole = self._account.whole
        lacking, _, lost = missing(whole.first, now)
        stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
        if lost <= 0.0 or not abs(lacking) > max(LOST_SHARE * lost, LEAST_STORED_SHARE * stored, LEAST_ENERGY):
            return
        self._say(
            f"from {whole.since:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, and the integration "
            f"{'took' if lacking > 0.0 else 'made'} {abs(lacking):.2g} J: where losses come from impacts or vibrations they "
            f"may be wrong by as much; {TIGHTER}",
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
        account = self._account
        mean = (time - account.small_since) / (account.small_steps + taken)
        if not mean < SMALLEST_STEP:
            account.small_steps, account.small_since = 0, time
            return None
        account.small_steps += int(taken)
        if account.small_steps < SMALL_STEPS_WARN:
            return None
        count = 1e-3 / max(mean, 1e-300)
        text = (
            f"near {time:.6g} s the steps are {mean:.1g} s long: a millisecond of bearing time takes {count:.1g} steps"
        )
        self._say(text, "steps")
        if account.small_steps < SMALL_STEPS_STOP:
            return None
        advice = (
            "Look for clearances, stiffnesses or friction that are far from usual there, try normal damping (effects.damping) "
            "or larger tolerances, or when_wrong='go_on' to go on all the same"
        )
        return f"ended at {time:.6g} s: {text}. {advice}"

    def _look_at_ring(self) -> str | None:
        """A free ring that nothing holds any more leaves its bearing: what follows means nothing."""
        sim, scene = self._sim, self._bearing.scene
        free = {"inner": scene.ring_body, "outer": scene.housing}
        rings = [ring for ring, body in free.items() if body is not None]
        if not rings:
            return None
        state, diameter = self._bearing.view(sim._core.state()), scene.bearing.roller.diameter
        moved, ring = max((abs(float(state[f"{ring}_ring_{name}"])), ring) for ring in rings for name in "xyz")
        if not moved > RING_LOOSE * diameter:
            return None
        text = (
            f"at {sim._core.time:.6g} s the free {ring} ring is {1e3 * moved:.3g} mm from its place, more than a tenth of a "
            "roller's diameter: nothing holds it there"
        )
        if "ring" not in self._noted:
            self._say(text, "ring")
        if moved <= RING_GONE * diameter:
            return None
        body = "ring_body" if ring == "inner" else "housing"
        return f"ended: {text}. Look for an axial load that holds it, a support of {body}, or effects.back_rib"

    def _observed(self, time: float) -> dict[str, Any]:
        """The record of the present state, by the names of its quantities."""
        row = np.asarray(self._sim._core.observe(time, self._sim._core.state()))
        return {name: row[offset : offset + math.prod(shape)] for name, offset, shape in self._bearing.record_layout}

    def _judge_slip(self, time: float) -> None:
        """A spacer holds rollers that slide or float as gently as no cage does: what they lose by its pockets is left out."""
        scene = self._bearing.scene
        if scene.effects.bodies != "rollers_and_spacer":
            return
        row = self._observed(time)
        outer = value_at(scene.outer_speed_rpm, time) * math.pi / 30.0
        rolling = scene.bearing.geometry.cage_speed_ratio * (float(row["shaft_speed"][0]) - outer) + outer
        slip = 1.0 - float(row["roller_orbit_speed"][0]) / rolling if rolling else 0.0
        if abs(slip) > SLIDING:
            sense = "slower" if slip > 0.0 else "faster"
            self._say(
                f"at {time:.6g} s the rollers orbit {100.0 * abs(slip):.2g} % {sense} than in pure rolling: they slide, and what "
                "a cage then does to them, which a spacer leaves out, may be most of the loss; compare with "
                "effects.bodies = 'rollers_and_cage'",
                "slip",
            )

    def _judge_unloaded(self, time: float) -> None:
        """Rollers that have left the load zone are driven by a cage alone: what they lose at its pockets a spacer leaves out."""
        if self._bearing.scene.effects.bodies != "rollers_and_spacer" or "unloaded" in self._noted:
            return
        loads = self._observed(time)["inner_load"]
        unloaded = int(np.sum(loads <= UNLOADED * loads.max()))
        if 0 < unloaded < loads.size:
            self._say(
                f"at {time:.6g} s {unloaded} of {loads.size} rollers carry no load at the inner raceway: a cage drives them, and "
                "they knock at its pockets, which a spacer leaves out; the loss is some per cent too low (4.5 % was measured); "
                "compare with effects.bodies = 'rollers_and_cage'",
                "unloaded",
            )

    def _look_at_shaft(self) -> str | None:
        """The same of a ring on a shaft with other bearings."""
        if self._bearing.seat is None or not self._moved > RING_GONE * self._bearing.scene.bearing.roller.diameter:
            return None
        text = f"the ring is {1e3 * self._moved:.3g} mm from its place: nothing holds the shaft there"
        if "ring" not in self._noted:
            self._say(text, "ring")
        return f"ended: {self._bearing.said}{text}"

    def _say(self, text: str | None, kind: str) -> None:
        """Keep a warning, if there is one, with the result, and show the first of its kind on the screen."""
        if text is None:
            return
        if len(self._found) < MOST_WARNINGS:
            self._found.append(text)
        else:
            self._suppressed += 1
            self._found[MOST_WARNINGS:] = [f"and {self._suppressed} more warnings"]
        self._noted.add(kind)
        if kind not in self._account.said:
            self._account.said.add(kind)
            warnings.warn(self._bearing.said + text, RunWarning, stacklevel=2)


def _said(since: float, until: float, off: float, lacking: float) -> str:
    what = "was made by the integration" if lacking < 0.0 else "got lost in the integration"
    return (
        f"from {since:.6g} s to {until:.6g} s the energy does not add up: "
        f"{100.0 * off:.2g} % of what was turned over {what}; losses, slip and forces there may be wrong by as much"
    )
