"""Temperatures at which bearings on a shaft give off the heat that they make, where the heat changes their play and preload; and,
where there are none, why (docs/theory/fits.md#preload-over-temperature).

A balance is looked for from the losses of a neighbour and from cold parts. What ends the way from cold has one name of its own:
only where one watt of loss makes one watt more or more (feedback of 1) do heat and preload drive each other up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn.errors import InputError, LoadError
from trbdyn.extras.heat.heat_network import heat_of, network
from trbdyn.extras.heat.paths import HeatPaths
from trbdyn.model.mounting import Temperatures
from trbdyn.model.on_shaft import MAX_END_PLAY, MAX_PRELOAD
from trbdyn.model.ribs import Ribs

Array = NDArray[np.float64]
Nodes = list[dict[str, float]]
"""Temperatures of the parts of each bearing (C)."""
Losses = Callable[[Mapping[str, Temperatures]], Sequence[Mapping[str, float]]]
"""Power by mechanism (W) of each bearing at temperatures of its parts."""
Why = Literal["runs away", "too hot", "nothing holds the shaft", "play beyond the range", "oil not known", "not found"]

HOTTEST: Final = 180.0
"""Parts and films hotter than this are not looked for (C)."""
CLOSE: Final = 1e-3
"""Share of the largest loss of a bearing up to which losses and network agree."""
NUDGE: Final = 0.02
"""Share by which losses are changed to see what they do to themselves."""
STEPS: Final = 12
"""Most steps of Newton's method."""
WARMING: Final = 80
"""Most steps of the way from cold parts."""
NEAR: Final = 0.1
"""Change over the losses from which on Newton's method is tried on the way from cold parts."""
FURTHER: Final = 1.3
"""Factor by which the losses must grow before it is tried again."""
LONGEST: Final = 4.0
"""Longest step over the change that losses make, where these and cooling nearly meet."""
WORSE: Final = 2
"""Steps of Newton's method that bring losses and network no nearer, after which it ends."""
SMALLEST: Final = 1e-3
"""Smallest step over the losses."""
RUNS_AWAY: Final = 1.0
"""Watts that one watt of loss makes in addition, from which on losses grow without end."""


@dataclass(frozen=True, slots=True)
class Balanced:
    """Losses of each bearing (W) that are in balance, their temperatures (C), and the largest loss that one watt makes in
    addition (W/W).
    """

    power: Array
    nodes: Nodes
    feedback: float


@dataclass(frozen=True, slots=True)
class NoBalance:
    """Why losses and cooling have no balance at a temperature outside.

    Attributes
    ----------
    temperature_c : float
        Temperature outside (C).
    why : str
        'runs away': one watt of loss makes one watt or more in addition. 'too hot': parts become hotter than 180 C, and the
        feedback there is below 1. 'nothing holds the shaft': heat opens the play, and no load presses the bearings together, or
        the loads have no equilibrium. 'play beyond the range': play or preload of a bearing leaves the range that can be
        computed. 'oil not known': the oil's viscosity is not known at a temperature on the way. 'not found': the search ended
        without an answer.
    said : str
        The same in a sentence with its numbers.
    power : float
        Losses of all bearings up to which the way was followed (W).
    hottest_c : float
        Temperature of the hottest part there (C).
    feedback : float or None
        Largest loss that one watt of loss makes in addition there (W/W); None where it could not be found.
    """

    temperature_c: float
    why: Why
    said: str
    power: float
    hottest_c: float
    feedback: float | None


@dataclass(frozen=True, slots=True)
class _Limit:
    """What ends a step: its name and the reason in words."""

    why: Why
    said: str


class WarmBalance:
    """Losses of all bearings and the temperatures that they make, outside of which it has one temperature.

    Unknowns are the losses of each bearing; how they are split between mechanisms follows from the last look at them.
    """

    def __init__(self, names: Sequence[str], losses: Losses, paths: Sequence[HeatPaths], ribs: Sequence[Ribs]) -> None:
        self.names, self.losses, self.paths, self.ribs = list(names), losses, list(paths), list(ribs)
        self._shares: list[dict[str, float]] = []

    def find(self, outside: float, begin: Array | None = None) -> Balanced | NoBalance:
        """The balance at a temperature outside (C): from losses (W) that are given, and from cold parts where these do not lead
        to one.
        """
        if begin is not None and isinstance(found := self._from(begin, outside), Balanced):
            return found
        return self._from_cold(outside)

    def temperatures(self, nodes: Nodes) -> dict[str, Temperatures]:
        """Temperatures of the parts of each bearing by its name."""
        return {name: Temperatures.of_nodes(one) for name, one in zip(self.names, nodes, strict=True)}

    def _nodes(self, power: Array, outside: float) -> Nodes:
        """Temperatures of the parts of each bearing that has these losses (W)."""
        found = []
        for watts, share, paths, ribs in zip(power, self._shares, self.paths, self.ribs, strict=True):
            own = paths.replace(housing_air_c=outside, shaft_end_c=outside, oil_inlet_c=outside)
            found.append(network(own, heat_of({key: watts * s for key, s in share.items()}, own.oil_share, ribs)))
        return found

    def _lost(self, power: Array, outside: float, *, look: bool = True) -> Array | _Limit:
        """Losses of each bearing (W) at the temperatures that losses make, or what stands against them; `look`: how they are
        split is kept.
        """
        nodes = self._nodes(power, outside)
        hottest = max(max(one.values()) for one in nodes)
        if hottest > HOTTEST:
            return _Limit("too hot", f"parts become hotter than {HOTTEST:g} C")
        found = self._at(self.temperatures(nodes))
        if isinstance(found, _Limit):
            return found
        if look:
            self._shares = [_shares(one) for one in found]
        return np.array([sum(one.values()) for one in found])

    def _at(self, own: Mapping[str, Temperatures]) -> Sequence[Mapping[str, float]] | _Limit:
        """Power by mechanism at temperatures, or why there is none."""
        try:
            return self.losses(own)
        except LoadError as error:
            return _Limit("nothing holds the shaft", str(error).splitlines()[0])
        except InputError as error:
            limit = _limit_of(error)
            if limit is None:
                raise
            return limit

    def _from(self, begin: Array, outside: float) -> Balanced | None:
        """The balance by Newton's method from losses that are near it."""
        shares = self._shares
        found = self._newton(begin, outside)
        if found is None:
            self._shares = shares
        return found

    def _from_cold(self, outside: float) -> Balanced | NoBalance:
        """The way from no losses on: each step goes a part of the way, as a machine warms up, and a smaller one where it went too
        far.
        """
        cold = self._at({name: Temperatures.uniform(outside) for name in self.names})
        if isinstance(cold, _Limit):
            return NoBalance(outside, cold.why, f"{cold.said}, with cold parts", 0.0, outside, None)
        self._shares = [_shares(one) for one in cold]
        power, change = np.zeros(len(cold)), np.array([sum(one.values()) for one in cold])
        share, tried, before = 0.3, 0.0, np.inf
        limit = _Limit("not found", f"the search ended after {WARMING} steps")
        for _ in range(WARMING):
            now, size = float(np.max(np.abs(change))), float(np.max(power))
            if now < NEAR * size and now <= before and size > FURTHER * tried:
                if (found := self._newton(power, outside)) is not None:
                    return found
                tried = size
            if tried and now > 0.8 * before:  # past where losses and cooling nearly meet, or slow between them
                share = min(1.5 * share, LONGEST)
            before = now
            shares = self._shares
            lost = self._lost(power + share * change, outside)
            if isinstance(lost, _Limit):
                self._shares, limit, share = shares, lost, 0.3 * share
                if share * now < SMALLEST * max(size, now):
                    break
                continue
            further = lost - power - share * change
            if np.min(further * change) < -0.25 * np.max(change**2):
                self._shares, share = shares, 0.3 * share
                if share < SMALLEST:
                    break
                continue
            power, change = power + share * change, further
        return self._ended(power, outside, limit)

    def _ended(self, power: Array, outside: float, limit: _Limit) -> NoBalance:
        """What the end of the way from cold parts is called."""
        nodes = self._nodes(power, outside)
        hottest, watts = max(max(one.values()) for one in nodes), float(np.sum(power))
        now = self._lost(power, outside)
        slopes = None if isinstance(now, _Limit) else self._slopes(power, now, outside)
        feedback = None if slopes is None else _largest(slopes)
        at = f"at {watts:.4g} W in all, the hottest part at {hottest:.4g} C"
        if feedback is not None and feedback >= RUNS_AWAY and np.all(np.asarray(now) >= power):
            said = f"one watt of loss makes {feedback:.3g} W more {at}"
            return NoBalance(outside, "runs away", said, watts, hottest, feedback)
        makes = "" if feedback is None else f"; one watt of loss makes {feedback:+.2g} W more there"
        return NoBalance(outside, limit.why, f"{limit.said}, {at}{makes}", watts, hottest, feedback)

    def _newton(self, power: Array, outside: float) -> Balanced | None:
        if isinstance(now := self._lost(power, outside), _Limit):
            return None
        nearest, worse = np.inf, 0
        for _ in range(STEPS):
            off = float(np.max(np.abs(now - power)))
            nearest, worse = min(off, nearest), worse + (off >= nearest)
            if worse >= WORSE:
                return None
            if (slopes := self._slopes(power, now, outside)) is None:
                return None
            if off < CLOSE * np.max(np.abs(power)):
                feedback = _largest(slopes)
                stays = feedback < RUNS_AWAY
                return Balanced(power, self._nodes(power, outside), feedback) if stays else None
            step = np.asarray(np.linalg.solve(np.eye(power.size) - slopes, now - power), dtype=np.float64)
            step *= min(1.0, 0.5 / max(float(np.max(np.abs(step) / np.maximum(power, 1e-9))), 1e-9))
            while isinstance(further := self._lost(power + step, outside), _Limit):
                step = np.asarray(0.3 * step)
                if np.max(np.abs(step)) < SMALLEST * np.max(power):
                    return None
            power, now = power + step, further
        return None

    def _slopes(self, power: Array, now: Array, outside: float) -> Array | None:
        """Slopes of the losses at the temperatures that losses make, with these losses; None where nothing can be computed on
        either side.
        """
        columns = []
        for k, watts in enumerate(power):
            for way in (1.0, -1.0):
                nudged = power.copy()
                nudged[k] = watts + way * NUDGE * max(watts, 1e-6)
                if not isinstance(lost := self._lost(nudged, outside, look=False), _Limit):
                    columns.append((lost - now) / (nudged[k] - watts))
                    break
            else:
                return None
        return np.array(columns).T


def _limit_of(error: InputError) -> _Limit | None:
    """What an input that cannot be used stands for on the way to a balance; None where it is an input of the caller."""
    name, value, said = error.field.rpartition(".")[2], error.value, str(error).splitlines()[0]
    if name == "end_play" and isinstance(value, float):
        if -MAX_PRELOAD <= value <= MAX_END_PLAY:
            return _Limit("nothing holds the shaft", "heat opens the play, and no load presses the bearings together")
        known = f"{-1e6 * MAX_PRELOAD:g} to {1e6 * MAX_END_PLAY:g} um can be computed"
        return _Limit("play beyond the range", f"the end play of a bearing becomes {1e6 * value:.4g} um, and {known}")
    if name in ("radial_clearance", "force"):
        return _Limit("play beyond the range", said)
    return _Limit("oil not known", said) if name == "temperature_c" else None


def _largest(slopes: Array) -> float:
    return float(np.max(np.linalg.eigvals(slopes).real))


def _shares(losses: Mapping[str, float]) -> dict[str, float]:
    total = sum(losses.values())
    return {name: value / total for name, value in losses.items()} if total > 0.0 else dict.fromkeys(losses, 0.0)
