"""A watch over a run: whether its energy adds up, and whether it makes progress (docs/theory/numerics.md#watch-over-a-run).

The core integrates every work and every loss beside the motion, so an error of the integration shows as energy that nobody put
in or took out. The watch looks at it every few milliseconds of computing and sums it over windows of the run, over the whole
run, and over all runs of one simulation since it began, so that a run in short pieces is judged as a whole. The figures of a
run are averages over the whole of it, or over what follows its transient: the second half at least. So errors of windows are
summed up, without their signs, over each such part, and one above `WARN` of what was turned over there gives a warning. A
window of its own counts from `STOP` on. One in which more than that was made ends the run, as its losses, slip and forces would
be wrong by as much. So does one in which that much is missing, if losses or the work put in are a large share of what was
turned over. Over all runs it is looked at beside the losses as well: a bearing that loses little may turn over much more. What
the integration takes from vibrations is compared with what damping takes, and its effect is measured (`trbdyn.run.vibrations`).
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import RunWarning
from trbdyn.model.motion import History, value_at
from trbdyn.run import vibrations
from trbdyn.run.vibrations import Probe
from trbdyn.statics.seat import Seating

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

Array = NDArray[np.float64]

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
LEFT_OPEN: Final = 3.0
"""Losses over the kinetic energy and over the relative tolerance, below which the losses are measured again: steps may change the
kinetic energy of a roller by twice that tolerance."""
RING_LOOSE: Final = 0.1
"""Way of a free ring from its place, over the diameter of a roller, from which on nothing seems to hold it."""
RING_GONE: Final = 0.5
"""The same at which it has left its bearing: up to there bounds of contacts are proven."""
REPEATED_SHARE: Final = 0.5
"""Share of steps that had to be repeated above which a run warns."""
MOST_WARNINGS: Final = 8
TIGHTER: Final = "try accuracy='reference', or smaller tolerances"
SLIDING: Final = 3e-3
"""Slip of rollers that a spacer holds from which on a cage may matter (1)."""


@dataclass
class Span:
    """A time that is judged: its energies at its beginning, and what was turned over since then.

    Attributes
    ----------
    since : float
        Its beginning (s).
    first : dict of str to float
        Works, losses, kinetic and elastic energy there (J).
    turned_over : float
        Energy that changed hands (J).
    elastic, looks : float, int
        Sum of the elastic energy over the looks (J), and their number.
    state : ndarray, optional
        The state at its beginning.
    """

    since: float
    first: dict[str, float]
    turned_over: float = 0.0
    elastic: float = 0.0
    looks: int = 0
    state: Array | None = None

    def add(self, exchanged: float, elastic: float) -> None:
        self.turned_over += exchanged
        self.elastic += elastic
        self.looks += 1

    def vibrating(self, now: dict[str, float], time: float) -> tuple[float, float]:
        """What the integration takes from vibrations, see `vibrations.taken`."""
        missing, _, _ = _missing(self.first, now)
        damped = now.get("loss_damping", 0.0) - self.first.get("loss_damping", 0.0)
        return vibrations.taken(missing, damped, self.elastic / max(self.looks, 1), time - self.since)


@dataclass(frozen=True)
class Suspect:
    """A span in which the integration takes much from vibrations.

    Attributes
    ----------
    size, share : float
        What it took, see `vibrations.taken`.
    span : Span
        The span.
    until : float
        Its end (s).
    jump : Span, optional
        The latest span before it in which a jump of a load or a speed began.
    """

    size: float
    share: float
    span: Span
    until: float
    jump: Span | None


@dataclass
class Account:
    """What the watch has seen since a simulation began, and goes on with in the simulation's next run."""

    whole: Span
    said: set[str] = field(default_factory=set)
    small_steps: int = 0
    small_since: float = 0.0
    suspect: Suspect | None = None
    """The span in which the integration took most from vibrations."""
    jump: Span | None = None
    """The latest span in which a jump of a load or a speed began."""
    probed: Probe | None = None
    notable: bool = True
    probe_steps: int = 0
    probed_size: float = 0.0


class Watch:
    """Watches one run.

    Parameters
    ----------
    sim : Simulation
        The simulation that runs; what was seen in its earlier runs is kept with it.
    bearing : SeatedBearing
        The bearing that is watched.
    end : float
        When the run ends (s).
    found : list of str
        Where it writes what it finds, in sentences.
    going_on : bool
        Whether a run that is found wrong goes on all the same.
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
        self._jumps, self._jumped = _jumps(sim)
        now, time = self._energies(), sim._core.time
        if bearing.name not in sim._accounts:
            sim._accounts[bearing.name] = Account(Span(time, now, state=sim._core.state()), small_since=time)
        self._account = sim._accounts[bearing.name]
        self._windows: list[tuple[float, float, float]] = []
        self._last, self._last_time = now, time
        self._run = Span(time, now, state=sim._core.state())
        self._window = Span(time, now, state=sim._core.state())
        self._vibrating = Span(time, now, state=sim._core.state())
        self._steps, self._repeated = self._counted(), self._repeats()

    def look(self, *, final: bool = False) -> str | None:
        """Look at the present state; gives the reason why the run should end, or None.

        Parameters
        ----------
        final : bool
            Whether the run has reached its end.
        """
        now, time = self._energies(), self._sim._core.time
        self._last_time = time
        reason = self._look_at_steps() or self._look_at_ring() or self._look_at_shaft()
        exchanged = sum(0.5 * abs(now[name] - self._last[name]) for name in now)
        for span in (self._window, self._vibrating, self._run, self._account.whole):
            span.add(exchanged, now["elastic_energy"])
        self._last = now
        if (final and time > self._window.since) or time - self._window.since >= self._length:
            reason = self._judge(self._window, now, time, STOP) or reason
            self._windows.append((self._window.since, _missing(self._window.first, now)[0], self._window.turned_over))
            self._window = Span(time, now, state=self._sim._core.state())
        # windows of a short run are too short to see a vibration in
        if time - self._vibrating.since >= max(self._length, vibrations.SHORTEST):
            self._suspect(self._vibrating, now, time)
            if np.any((self._jumps > self._vibrating.since) & (self._jumps <= time)):
                self._account.jump = self._vibrating
            self._vibrating = Span(time, now, state=self._sim._core.state())
        if final and time > self._run.since:
            reason = self._judge(self._run, now, time, STOP) or reason
            self.judge_averages()
            # what a short piece does not show may show in all of them
            if self._account.whole.since < self._run.since and "energy" not in self._noted:
                self._judge(self._account.whole, now, time, WARN)
            if "energy" not in self._noted:
                self._judge_losses(now, time)
            self._judge_vibrations(now, time)
            if not self._noted & {"energy", "losses", "vibrations"}:
                self._judge_small_losses(now, time)
            self._judge_slip(time)
        return None if self._going_on else reason

    def renew(self) -> None:
        """Note that the integrator was started again, so that its counts begin at zero."""
        self._steps, self._repeated = self._counted(), self._repeats()

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
            missing = [one for _, one, _ in self._windows[number:]]
            turned_over = sum(one for _, _, one in self._windows[number:])
            off = sum(map(abs, missing)) / _scale(turned_over, self._last)
            if off > WARN:
                return [f"{self._bearing.said if named else ''}{_said(since, end, off, sum(missing))}; {TIGHTER}"]
        return []

    def judge_averages(self) -> None:
        """Say it with the result, once."""
        for text in self.averages_doubts():
            self._say(text, "energy")

    def _judge(self, span: Span, now: dict[str, float], time: float, most: float) -> str | None:
        missing, put_in, lost = _missing(span.first, now)
        scale = _scale(span.turned_over, now)
        off = abs(missing) / scale
        if math.isfinite(off) and off <= most:
            return None
        text = _said(span.since, time, off, missing)
        # where little else takes energy, vibrations that the steps do not resolve lose theirs: the run warns and goes on
        wrong = not math.isfinite(off) or (off > STOP and (missing < 0.0 or max(lost, put_in) > DISSIPATING * scale))
        if not wrong:
            self._say(f"{text}; {TIGHTER}", "energy")
            return None
        self._say(text, "energy")
        advice = "Try accuracy='reference' or smaller tolerances, or when_wrong='go_on' to go on all the same"
        return f"ended at {time:.6g} s: {text}. {advice}"

    def _judge_losses(self, now: dict[str, float], time: float) -> None:
        whole = self._account.whole
        missing, _, lost = _missing(whole.first, now)
        stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
        if lost <= 0.0 or not abs(missing) > max(LOST_SHARE * lost, LEAST_STORED_SHARE * stored, LEAST_ENERGY):
            return
        self._say(
            f"from {whole.since:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, and the integration "
            f"{'took' if missing > 0.0 else 'made'} {abs(missing):.2g} J: where losses come from impacts or vibrations they "
            f"may be wrong by as much; {TIGHTER}",
            "losses",
        )

    def _judge_small_losses(self, now: dict[str, float], time: float) -> None:
        """Measure losses that are smaller than what the tolerances leave open in the kinetic energy of rollers that turn fast."""
        account, whole = self._account, self._account.whole
        _, _, lost = _missing(whole.first, now)
        kinetic = abs(now["kinetic_energy"])
        least = max(LEAST_STORED_SHARE * kinetic, LEAST_ENERGY)
        most = min(vibrations.STEPS, vibrations.STEPS_IN_ALL - account.probe_steps)
        if not least < lost < LEFT_OPEN * self._sim.options.tolerances.rtol * kinetic or whole.state is None:
            return
        if time - whole.since < vibrations.SHORTEST or most < vibrations.LEAST_STEPS:
            return
        length = min(time - whole.since, vibrations.LENGTH)
        probe = vibrations.probe(self._sim, self._bearing, whole.since, whole.state, most, length=length)
        account.probe_steps += most if probe is None else probe.steps
        if probe is not None and not probe.notable(certain=False):
            return
        measured = "how right they are could not be measured" if probe is None else probe.said()
        self._say(
            f"from {whole.since:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, less than the tolerances leave open beside "
            f"a kinetic energy of {kinetic:.2g} J: {measured}; {TIGHTER}",
            "small losses",
        )

    def _suspect(self, span: Span, now: dict[str, float], time: float) -> None:
        """Keep the span in which the integration takes most from vibrations."""
        share, size = span.vibrating(now, time)
        account = self._account
        if not (vibrations.matter(share, size, damped=self._damped(now)) and time - span.since >= vibrations.SHORTEST):
            return
        if account.suspect is None or size > account.suspect.size:
            account.suspect = Suspect(size, share, span, time, account.jump)

    def _judge_vibrations(self, now: dict[str, float], time: float) -> None:
        """Say what the integration takes from vibrations, if it does something to losses or loads: measured by a probe."""
        account = self._account
        self._suspect(self._run, now, time)
        if self._run.since > account.whole.since:
            self._suspect(account.whole, now, time)
        if account.suspect is None:
            return
        suspect = account.suspect
        size, share = suspect.size, suspect.share
        # with next to no damping large vibrations go on growing, and where they are most of the elastic energy a probe scatters
        # with them: a difference within the scatter is then no proof that there is none
        unclear = size > (vibrations.SIZE if share > vibrations.GROWING else vibrations.MOST)
        most = vibrations.OPEN_UNCLEAR if unclear else vibrations.OPEN
        if size > account.probed_size and self._probe(suspect, vibrations.LENGTH, vibrations.STEPS):
            account.probed_size = size
            account.notable = account.probed is None or (
                account.probed.notable(certain=not unclear) or account.probed.leaves(most)
            )
            if account.notable and account.probed is not None:
                self._probe(suspect, vibrations.LONGER, vibrations.STEPS_LONGER)
                account.notable = account.probed.notable(certain=True) or account.probed.leaves(most)
        if not account.notable:
            return
        damped = self._damped(now)
        took = f"takes {100.0 * share:.3g} % of the energy of these vibrations" + (
            " in place of damping" if damped else ""
        )
        measured = "what that does could not be measured" if account.probed is None else account.probed.said()
        advice = TIGHTER
        if not damped:
            advice = "give the contacts the damping that they have (effects.damping), or try smaller tolerances"
        self._say(
            f"near {suspect.span.since:.6g} s rollers vibrate on their raceways, and the integration {took}: {measured}; "
            f"{advice}",
            "vibrations",
        )

    def _probe(self, suspect: Suspect, length: float, most: int) -> bool:
        """Repeat a piece with tighter tolerances, if there are steps left for it; what was measured before stays if it fails."""
        account, own = self._account, int(vibrations.STEPS_SHARE * self._sim.statistics["steps"])
        most = min(max(most, own), max(vibrations.STEPS_IN_ALL, own) - account.probe_steps)
        place = self._piece(suspect, length, most)
        if most < vibrations.LEAST_STEPS or place is None:
            return False
        since, state, length, growth = place
        before = account.probed
        if before is not None and before.since == since and before.until >= since + (1.0 - 1e-9) * length:
            return False
        found = vibrations.probe(self._sim, self._bearing, since, state, most, length, growth)
        account.probe_steps += most if found is None else found.steps
        account.probed = found or account.probed
        return True

    def _piece(self, suspect: Suspect, length: float, most: int) -> tuple[float, Array, float, float] | None:
        """Where a probe begins (s), the state there, its length and what is left to vibrations to grow (s).

        A jump of a load or speed excites vibrations at once: the piece begins there, where the run has not lost them yet. What
        follows the jump is compared up to the next one, as other loads have other losses.
        """
        span = suspect.span
        if span.state is None:
            return None
        usual = span.since, span.state, length, vibrations.GROWTH
        ends = np.concatenate([[-math.inf], self._jumps, [math.inf]])
        common = np.minimum(ends[1:], suspect.until) - np.maximum(ends[:-1], span.since)
        first, last = ends[(place := int(np.argmax(common))) : place + 2]
        begin = span if first >= span.since else suspect.jump
        rest = last - span.since
        if common[place] < vibrations.SHORTEST:
            return usual
        if begin is None or begin.state is None or begin.since > first or span.since - first > vibrations.LENGTH:
            return (*usual[:2], min(length, rest), usual[3]) if rest > 2.0 * vibrations.SHORTEST else usual
        state = vibrations.reached(self._sim, begin.since, begin.state, float(first), most)
        growth = float(self._jumped[place - 1] - first)
        return usual if state is None else (float(first), state, min(length, last - first), growth)

    def _damped(self, now: dict[str, float]) -> bool:
        """Whether contacts have damped anything since the simulation began."""
        return now.get("loss_damping", 0.0) > self._account.whole.first.get("loss_damping", 0.0)

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
            f"at {sim._core.time:.6g} s the free {ring} ring stands {1e3 * moved:.3g} mm from its place, more than a tenth of a "
            "roller's diameter: nothing holds it there"
        )
        if "ring" not in self._noted:
            self._say(text, "ring")
        if moved <= RING_GONE * diameter:
            return None
        body = "ring_body" if ring == "inner" else "housing"
        return f"ended: {text}. Look for an axial load that holds it, a support of {body}, or effects.back_rib"

    def _judge_slip(self, time: float) -> None:
        """A spacer holds rollers that slide or float as gently as no cage does: what they lose by its pockets is left out."""
        scene = self._bearing.scene
        if scene.effects.bodies != "rollers_and_spacer":
            return
        row = self._sim._core.observe(time, self._sim._core.state())
        at = {name: offset for name, offset, _ in self._bearing.record_layout}
        outer = value_at(scene.outer_speed_rpm, time) * math.pi / 30.0
        rolling = scene.bearing.geometry.cage_speed_ratio * (row[at["shaft_speed"]] - outer) + outer
        slip = 1.0 - row[at["roller_orbit_speed"]] / rolling if rolling else 0.0
        if abs(slip) > SLIDING:
            sense = "slower" if slip > 0.0 else "faster"
            self._say(
                f"at {time:.6g} s the rollers orbit {100.0 * abs(slip):.2g} % {sense} than in pure rolling: they slide, and what "
                "a cage then does to them, which a spacer leaves out, may be most of the loss; compare with "
                "effects.bodies = 'rollers_and_cage'",
                "slip",
            )

    def _look_at_shaft(self) -> str | None:
        """The same of a ring on a shaft with other bearings."""
        if self._bearing.seat is None or not self._moved > RING_GONE * self._bearing.scene.bearing.roller.diameter:
            return None
        text = f"the ring stands {1e3 * self._moved:.3g} mm from its place: nothing holds the shaft there"
        if "ring" not in self._noted:
            self._say(text, "ring")
        return f"ended: {self._bearing.said}{text}"

    def _say(self, text: str, kind: str) -> None:
        """Keep a warning with the result, and show the first of its kind on the screen."""
        if len(self._found) < MOST_WARNINGS:
            self._found.append(text)
        else:
            self._suppressed += 1
            self._found[MOST_WARNINGS:] = [f"and {self._suppressed} more warnings"]
        self._noted.add(kind)
        if kind not in self._account.said:
            self._account.said.add(kind)
            warnings.warn(self._bearing.said + text, RunWarning, stacklevel=2)


def _jumps(sim: Simulation) -> tuple[Array, Array]:
    """Where jumps of loads and speeds that do not repeat begin and end (s): knots close together are one."""
    subject = sim.subject
    given = () if isinstance(subject, Seating) else subject.quantities().values()
    times = [q.times for q in given if isinstance(q, History) and not q.repeats]
    knots = np.unique(np.concatenate([[], *times]))
    apart = np.diff(knots, prepend=-math.inf, append=math.inf) > 2.0 * vibrations.SHORTEST
    return knots[apart[:-1]], knots[apart[1:]]


def _missing(then: dict[str, float], now: dict[str, float]) -> tuple[float, float, float]:
    """Energy that is missing, that was put in, and that was lost between two states (J)."""
    change = {name: now[name] - then[name] for name in now}
    put_in = sum(value for name, value in change.items() if name.startswith("work_"))
    lost = sum(value for name, value in change.items() if name.startswith("loss_"))
    return put_in - lost - change["kinetic_energy"] - change["elastic_energy"], put_in, lost


def _scale(turned_over: float, now: dict[str, float]) -> float:
    """Energy that an error of it is compared with (J)."""
    stored = abs(now["kinetic_energy"]) + abs(now["elastic_energy"])
    return max(turned_over, STORED_SHARE * stored, LEAST_ENERGY)


def _said(since: float, until: float, off: float, missing: float) -> str:
    what = "was made by the integration" if missing < 0.0 else "got lost in the integration"
    return (
        f"from {since:.6g} s to {until:.6g} s the energy does not add up: "
        f"{100.0 * off:.2g} % of what was turned over {what}; losses, slip and forces there may be wrong by as much"
    )
