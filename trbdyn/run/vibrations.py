"""Vibrations of rollers on their raceways: what the integration takes from them, and what that does to losses and loads
(docs/theory/numerics.md#vibrations-that-steps-do-not-resolve).

Steps that do not resolve a vibration take energy from it, as damping does: it is then smaller than it is in the bearing, and
with it loads, rolling resistance and slip. The residual of the energy audit beside the energy that damping took tells how much.
Where that is more than `SHARE`, and large enough beside the elastic energy, the run is checked: a piece of it, or all of it, is
repeated with tighter tolerances.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.motion import History
from trbdyn.run.energies import LEAST_ENERGY, LEAST_STORED_SHARE, Span, missing
from trbdyn.run.stretch import SHORTEST, Measured, Stretch
from trbdyn.statics.seat import Seating

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

Array = NDArray[np.float64]

SHARE: Final = 0.25
"""Share of the energy fed into vibrations that the integration may take in place of damping: so much of the vibrations, and of
what they do to losses and loads, is missing (N12)."""
MEMORY: Final = 5e-3
"""Time over which vibrations add up before the damping of a lightly loaded contact takes them (s)."""
SIZE: Final = 0.01
"""Energy that is missing in `MEMORY`, over the elastic energy, below which it is too little to change a load."""
SIZE_UNDAMPED: Final = 2e-4
"""The same where nothing damps: vibrations of rollers that carry hardly any load then change how long these roll in contact, and
with that the rolling resistance, while the elastic energy lies in others."""
LENGTH: Final = 20e-3
"""Bearing time of the piece that is repeated first, at most (s)."""
GROWTH: Final = 10e-3
"""Time at its beginning that is left to vibrations to grow to their size (s); half of a shorter one."""
STEPS: Final = 20_000
"""Steps of that piece with tighter tolerances at most, or `STEPS_SHARE` of the simulation's own steps if that is more."""
STEPS_OF_WHOLE: Final = 60_000
"""Expected steps up to which the whole simulation is repeated."""
STEPS_OF_STRETCH: Final = 20_000
"""Steps that a stretch of a longer one is expected to take, or a quarter of all that may be taken if that is more."""
STEPS_IN_ALL: Final = 80_000
"""Steps after which no further pair is begun."""
STEPS_OF_SIMULATION: Final = 160_000
"""The same of all that is repeated in a simulation of several runs."""
STEPS_SHARE: Final = 0.05
MUCH_LONGER: Final = 2.0
"""Factor of the length of a simulation from which on it is checked again, as vibrations may have grown slowly."""
LEAST_STEPS: Final = 2000
"""Steps below which nothing is repeated any more."""
LEFT_OPEN: Final = 3.0
"""Losses over the kinetic energy and over the relative tolerance, below which the losses are measured again: steps may change the
kinetic energy of a roller by twice that tolerance."""
TIGHTER: Final = "try accuracy='reference', or smaller tolerances"


@dataclass(frozen=True)
class Suspect:
    """A span up to a time (s) in which the integration takes much from vibrations: what it took, see `_taken`; and the latest
    span before it in which a jump of a load or a speed began.
    """

    share: float
    size: float
    span: Span
    until: float
    jump: Span | None


@dataclass
class Seen:
    """What was seen of the vibrations of a bearing since a simulation began, and what was measured of them."""

    suspect: Suspect | None = None
    """The span in which the integration took most from vibrations."""
    jump: Span | None = None
    """The latest span in which a jump of a load or a speed began."""
    measured: Measured | None = None
    """What it does to losses and loads; None where that could not be measured."""
    measured_size: float = 0.0
    """Size of the vibrations that were measured, see `Suspect`."""
    measured_until: float = -math.inf
    """Time up to which the simulation had come then (s)."""
    steps: int = 0
    """Steps with tighter tolerances that were taken for it."""


class Vibrations:
    """Judges what the integration takes from the vibrations of a bearing; `whole` is the time since its simulation began."""

    def __init__(self, sim: Simulation, bearing: SeatedBearing, whole: Span, seen: Seen) -> None:
        self._sim, self._bearing, self._whole, self._seen = sim, bearing, whole, seen
        self._jumps, self._jumped = _jumps(sim)

    def look(self, span: Span, now: dict[str, float], time: float) -> None:
        """Look at a span that ends at a time (s) with these energies."""
        self._suspect(span, now, time)
        if np.any((self._jumps > span.since) & (self._jumps <= time)):
            self._seen.jump = span

    def judge(self, run: Span, now: dict[str, float], time: float) -> str | None:
        """What the integration takes from vibrations up to the end of a run, in words, if losses or loads are not known
        to be right with it.
        """
        seen = self._seen
        self._suspect(run, now, time)
        if run.since > self._whole.since:
            self._suspect(self._whole, now, time)
        if seen.suspect is None:
            return None
        suspect = seen.suspect
        longer = time - self._whole.since > MUCH_LONGER * (seen.measured_until - self._whole.since)
        if longer or suspect.size > seen.measured_size:
            if self._measure(self._piece(suspect, time), time):
                seen.measured_size, seen.measured_until = suspect.size, time
            elif seen.measured is not None and seen.measured.clear:
                seen.measured = None  # what was right before may not be so any more
        if seen.measured is not None and seen.measured.clear:
            return None
        damped = self._damped(now)
        took = f"takes {100.0 * suspect.share:.3g} % of the energy of these vibrations" + (
            " in place of damping" if damped else ""
        )
        advice = TIGHTER
        if not damped:
            advice = "give the contacts the damping that they have (effects.damping), or try smaller tolerances"
        where = f"near {suspect.span.since:.6g} s rollers vibrate on their raceways"
        return f"{where}, and the integration {took}: {self._said('what that does')}; {advice}"

    def small_losses(self, now: dict[str, float], time: float) -> str | None:
        """Measure losses that are smaller than what the tolerances leave open in the kinetic energy of rollers that turn fast; in
        words, if they are not known to be right.
        """
        seen, whole = self._seen, self._whole
        _, _, lost = missing(whole.first, now)
        kinetic = abs(now["kinetic_energy"])
        least = max(LEAST_STORED_SHARE * kinetic, LEAST_ENERGY)
        if not least < lost < LEFT_OPEN * self._sim.options.tolerances.rtol * kinetic or whole.state is None:
            return None
        length = min(time - whole.since, LENGTH)
        if length < SHORTEST:
            return None
        if not self._measure(self._stretch(whole.since, whole.state, length, GROWTH), time):
            seen.measured = None
        if seen.measured is not None and seen.measured.clear:
            return None
        return (
            f"from {whole.since:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, less than the tolerances leave open beside "
            f"a kinetic energy of {kinetic:.2g} J: {self._said('how right they are')}; {TIGHTER}"
        )

    def _said(self, what: str) -> str:
        return self._seen.measured.said() if self._seen.measured is not None else f"{what} could not be measured"

    def _suspect(self, span: Span, now: dict[str, float], time: float) -> None:
        """Keep the span in which the integration takes most from vibrations."""
        seen = self._seen
        share, size = _taken(span, now, time)
        matters = share > SHARE and size > (SIZE if self._damped(now) else SIZE_UNDAMPED)
        if matters and time - span.since >= SHORTEST and (seen.suspect is None or size > seen.suspect.size):
            seen.suspect = Suspect(share, size, span, time, seen.jump)

    def _measure(self, piece: Stretch | None, time: float) -> bool:
        """Measure what the tolerances do up to a time (s): by a piece, and where that does not show loss and load to be right, by
        pairs of all since the simulation began, or of a stretch of it. False if there are no steps left for it; what was measured
        before then stays.
        """
        seen, own = self._seen, int(STEPS_SHARE * self._sim.statistics["steps"])
        left = max(STEPS_OF_SIMULATION, own) - seen.steps
        if piece is None or left < LEAST_STEPS:
            return False
        most = min(max(STEPS, own), left)
        seen.measured = first = piece.in_parts(most)
        seen.steps += most if first is None else first.steps
        if first is None or not first.clear:
            dear = (most if first is None else max(first.steps, 1)) / piece.length
            in_all = min(max(STEPS_IN_ALL, own), left)
            seen.measured = found = self._longer(piece, time, dear, in_all).in_pairs(in_all)
            seen.steps += in_all if found is None else found.steps
        return True

    def _longer(self, piece: Stretch, time: float, dear: float, in_all: int) -> Stretch:
        """What is repeated in pairs: the whole simulation up to a time (s), if a pair takes so few steps, with `dear` of them in
        a second of the bearing; or what follows the beginning of a piece, as long as a few pairs allow.
        """
        whole = self._whole
        if whole.state is not None and dear * (time - whole.since) <= min(max(STEPS_OF_WHOLE, in_all // 2), in_all):
            return self._stretch(whole.since, whole.state, time - whole.since, 0.0)
        length = max(STEPS_OF_STRETCH, in_all // 4) / dear
        return replace(piece, length=max(piece.length, min(time - piece.begin, length)))

    def _stretch(self, begin: float, state: Array, length: float, growth: float) -> Stretch:
        return Stretch(self._sim, self._bearing, begin, state, length, growth)

    def _piece(self, suspect: Suspect, time: float) -> Stretch | None:
        """The piece that is repeated first, of a simulation that has come to a time (s).

        A jump of a load or speed excites vibrations at once: the piece begins there, where the run has not lost them yet. What
        follows the jump is compared up to the next one, as other loads have other losses.
        """
        span = suspect.span
        if span.state is None:
            return None
        ordinary = self._stretch(span.since, span.state, min(LENGTH, max(time - span.since, SHORTEST)), GROWTH)
        ends = np.concatenate([[-math.inf], self._jumps, [math.inf]])
        common = np.minimum(ends[1:], suspect.until) - np.maximum(ends[:-1], span.since)
        first, last = ends[(place := int(np.argmax(common))) : place + 2]
        begin = span if first >= span.since else suspect.jump
        rest = last - span.since
        if common[place] < SHORTEST:
            return ordinary
        if begin is None or begin.state is None or begin.since > first or span.since - first > LENGTH:
            return replace(ordinary, length=min(ordinary.length, rest)) if rest > 2.0 * SHORTEST else ordinary
        state = self._stretch(begin.since, begin.state, float(first) - begin.since, 0.0).state_at_end(STEPS)
        growth = float(self._jumped[place - 1] - first)
        length = float(min(LENGTH, last - first, max(time - first, SHORTEST)))
        return ordinary if state is None else self._stretch(float(first), state, length, growth)

    def _damped(self, now: dict[str, float]) -> bool:
        """Whether contacts have damped anything since the simulation began."""
        return now.get("loss_damping", 0.0) > self._whole.first.get("loss_damping", 0.0)


def _jumps(sim: Simulation) -> tuple[Array, Array]:
    """Where jumps of loads and speeds that do not repeat begin and end (s): knots close together are one."""
    subject = sim.subject
    given = () if isinstance(subject, Seating) else subject.quantities().values()
    times = [q.times for q in given if isinstance(q, History) and not q.repeats]
    knots = np.unique(np.concatenate([[], *times]))
    apart = np.diff(knots, prepend=-math.inf, append=math.inf) > 2.0 * SHORTEST
    return knots[apart[:-1]], knots[apart[1:]]


def _taken(span: Span, now: dict[str, float], time: float) -> tuple[float, float]:
    """Share of the vibrations' energy that the integration took in a span that ends at a time (s), and what it took within
    `MEMORY` over the mean elastic energy.
    """
    lacking = abs(missing(span.first, now)[0])
    damped = now.get("loss_damping", 0.0) - span.first.get("loss_damping", 0.0)
    share = lacking / max(lacking + max(damped, 0.0), 1e-300)
    elastic = span.elastic / max(span.looks, 1)
    return share, lacking / max(time - span.since, 1e-300) * MEMORY / max(elastic, 1e-300)
