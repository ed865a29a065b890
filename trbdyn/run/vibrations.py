"""Vibrations of rollers on their raceways: what the integration takes from them, and what that does to losses and loads
(docs/theory/numerics.md#vibrations-that-steps-do-not-resolve).

Steps that do not resolve a vibration take energy from it, as damping does: it is then smaller than it is in the bearing, and
with it loads, rolling resistance and slip. The residual of the energy audit beside the energy that damping took tells how much.
Where that is more than `SHARE`, and large enough beside the elastic energy, a piece of the run is repeated with tighter
tolerances.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.motion import History
from trbdyn.run.energies import LEAST_ENERGY, LEAST_STORED_SHARE, Span, missing
from trbdyn.run.probe import SHORTEST, Probe, probe, reached
from trbdyn.statics.seat import Seating

if TYPE_CHECKING:
    from trbdyn.run.simulation import Simulation
    from trbdyn.statics.seat import SeatedBearing

Array = NDArray[np.float64]

SHARE: Final = 0.25
"""Share of the energy fed into vibrations that the integration may take in place of damping: so much of the vibrations, and of
what they do to losses and loads, is missing (N12)."""
GROWING: Final = 0.9
"""The same from which on vibrations would grow to more than ten times what is left of them, longer than a probe lasts (N12)."""
MEMORY: Final = 5e-3
"""Time over which vibrations add up before the damping of a lightly loaded contact takes them (s)."""
SIZE: Final = 0.01
"""Energy that is missing in `MEMORY`, over the elastic energy, below which it is too little to change a load."""
MOST: Final = 1.0
"""The same from which on vibrations are most of what the contacts hold, so that a probe of one piece scatters with them."""
SIZE_UNDAMPED: Final = 2e-4
"""The same where nothing damps: vibrations of rollers that carry hardly any load then change how long these roll in contact, and
with that the rolling resistance, while the elastic energy lies in others."""
LENGTH: Final = 20e-3
"""Bearing time of a probe at most (s)."""
LONGER: Final = 80e-3
"""The same of the one that repeats a difference."""
GROWTH: Final = 10e-3
"""Time at the beginning of a probe that is left to vibrations to grow to their size (s); half of a shorter one."""
STEPS: Final = 20_000
"""Steps of a probe with tighter tolerances at most, or `STEPS_SHARE` of the simulation's own steps if that is more."""
STEPS_LONGER: Final = 60_000
"""The same of the longer one."""
STEPS_IN_ALL: Final = 80_000
"""The same of all probes of a simulation."""
STEPS_SHARE: Final = 0.05
LEAST_STEPS: Final = 2000
"""Steps below which no further probe is begun."""
OPEN: Final = 0.1
"""Difference that a probe must exclude."""
OPEN_UNCLEAR: Final = 0.05
"""The same where vibrations grow or are most of the loads."""
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
    probed: Probe | None = None
    notable: bool = True
    probe_steps: int = 0
    probed_size: float = 0.0


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
        """What the integration takes from vibrations up to the end of a run, in words, if it does something to losses or loads:
        measured by a probe.
        """
        seen = self._seen
        self._suspect(run, now, time)
        if run.since > self._whole.since:
            self._suspect(self._whole, now, time)
        if seen.suspect is None:
            return None
        suspect = seen.suspect
        # with next to no damping large vibrations go on growing, and where they are most of the elastic energy a probe scatters
        # with them: a difference within the scatter is then no proof that there is none
        unclear = suspect.size > (SIZE if suspect.share > GROWING else MOST)
        most = OPEN_UNCLEAR if unclear else OPEN
        if suspect.size > seen.probed_size and self._probe(suspect, LENGTH, STEPS):
            seen.probed_size = suspect.size
            seen.notable = seen.probed is None or seen.probed.notable(certain=not unclear) or seen.probed.leaves(most)
            if seen.notable and seen.probed is not None:
                self._probe(suspect, LONGER, STEPS_LONGER)
                seen.notable = seen.probed.notable(certain=True) or seen.probed.leaves(most)
        if not seen.notable:
            return None
        damped = self._damped(now)
        took = f"takes {100.0 * suspect.share:.3g} % of the energy of these vibrations" + (
            " in place of damping" if damped else ""
        )
        measured = "what that does could not be measured" if seen.probed is None else seen.probed.said()
        advice = TIGHTER
        if not damped:
            advice = "give the contacts the damping that they have (effects.damping), or try smaller tolerances"
        where = f"near {suspect.span.since:.6g} s rollers vibrate on their raceways"
        return f"{where}, and the integration {took}: {measured}; {advice}"

    def small_losses(self, now: dict[str, float], time: float) -> str | None:
        """Measure losses that are smaller than what the tolerances leave open in the kinetic energy of rollers that turn fast; in
        words, if they are not right.
        """
        seen, whole = self._seen, self._whole
        _, _, lost = missing(whole.first, now)
        kinetic = abs(now["kinetic_energy"])
        least = max(LEAST_STORED_SHARE * kinetic, LEAST_ENERGY)
        most = min(STEPS, STEPS_IN_ALL - seen.probe_steps)
        if not least < lost < LEFT_OPEN * self._sim.options.tolerances.rtol * kinetic or whole.state is None:
            return None
        if time - whole.since < SHORTEST or most < LEAST_STEPS:
            return None
        length = min(time - whole.since, LENGTH)
        found = probe(self._sim, self._bearing, whole.since, whole.state, most, length, GROWTH)
        seen.probe_steps += most if found is None else found.steps
        if found is not None and not found.notable(certain=False):
            return None
        measured = "how right they are could not be measured" if found is None else found.said()
        return (
            f"from {whole.since:.6g} s to {time:.6g} s the bearing lost {lost:.2g} J, less than the tolerances leave open beside "
            f"a kinetic energy of {kinetic:.2g} J: {measured}; {TIGHTER}"
        )

    def _suspect(self, span: Span, now: dict[str, float], time: float) -> None:
        """Keep the span in which the integration takes most from vibrations."""
        seen = self._seen
        share, size = _taken(span, now, time)
        matters = share > SHARE and size > (SIZE if self._damped(now) else SIZE_UNDAMPED)
        if matters and time - span.since >= SHORTEST and (seen.suspect is None or size > seen.suspect.size):
            seen.suspect = Suspect(share, size, span, time, seen.jump)

    def _probe(self, suspect: Suspect, length: float, most: int) -> bool:
        """Repeat a piece with tighter tolerances, if there are steps left for it; what was measured before stays if it fails."""
        seen, own = self._seen, int(STEPS_SHARE * self._sim.statistics["steps"])
        most = min(max(most, own), max(STEPS_IN_ALL, own) - seen.probe_steps)
        place = self._piece(suspect, length, most)
        if most < LEAST_STEPS or place is None:
            return False
        since, state, length, growth = place
        before = seen.probed
        if before is not None and before.since == since and before.until >= since + (1.0 - 1e-9) * length:
            return False
        found = probe(self._sim, self._bearing, since, state, most, length, growth)
        seen.probe_steps += most if found is None else found.steps
        seen.probed = found or seen.probed
        return True

    def _piece(self, suspect: Suspect, length: float, most: int) -> tuple[float, Array, float, float] | None:
        """Where a probe begins (s), the state there, its length and what is left to vibrations to grow (s).

        A jump of a load or speed excites vibrations at once: the piece begins there, where the run has not lost them yet. What
        follows the jump is compared up to the next one, as other loads have other losses.
        """
        span = suspect.span
        if span.state is None:
            return None
        usual = span.since, span.state, length, GROWTH
        ends = np.concatenate([[-math.inf], self._jumps, [math.inf]])
        common = np.minimum(ends[1:], suspect.until) - np.maximum(ends[:-1], span.since)
        first, last = ends[(place := int(np.argmax(common))) : place + 2]
        begin = span if first >= span.since else suspect.jump
        rest = last - span.since
        if common[place] < SHORTEST:
            return usual
        if begin is None or begin.state is None or begin.since > first or span.since - first > LENGTH:
            return (*usual[:2], min(length, rest), usual[3]) if rest > 2.0 * SHORTEST else usual
        state = reached(self._sim, begin.since, begin.state, float(first), most)
        growth = float(self._jumped[place - 1] - first)
        return usual if state is None else (float(first), state, min(length, last - first), growth)

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
