"""The choice of a plan: the cheapest set by the errors of its parts, run as a whole; where the whole is worse, none of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from trbdyn.extras.design.planning.candidates import (
    TRUE_ACCURACY,
    TRUE_NODES,
    USUAL_ACCURACY,
    USUAL_NODES,
    Candidate,
    numerics,
)
from trbdyn.extras.design.planning.choice import Choice, Option, Task, choose
from trbdyn.extras.design.planning.looking import LEAST_AVERAGING, TRUTH_IN_PROBES, Looker, Seen
from trbdyn.extras.design.planning.probes import Array, Influence, Probe
from trbdyn.extras.design.planning.wishes import Wishes

MOST_AVERAGING: Final = 20_000.0
"""Turns of the shaft of the averaging at most."""
UNSEEN: Final = 0.001
UNSEEN_SHARE: Final = 0.5
"""What a short probe cannot see: an error of this size, and this share of the errors of model, numerics and settling that it
sees. Assumed. Plans with it kept 33 of 33 promises against long runs of twenty scenes (docs/howto/plan.md)."""
AND: Final = " and "
USUAL: Final = f"{USUAL_NODES} nodes, tolerances '{USUAL_ACCURACY}'"
EXACT: Final = f"{TRUE_NODES} nodes, tolerances '{TRUE_ACCURACY}'"


@dataclass(frozen=True)
class Decision:
    """What a plan takes: the choice, with errors and cost of the whole, and the simplifications that are made."""

    choice: Choice
    found: Probe  # the probe of the whole
    made: tuple[Candidate, ...]
    effects: Mapping[str, Any]  # fields of `Effects` that are changed
    accuracy: str  # preset of the tolerances
    rejected: frozenset[str]  # a choice whose error as a whole was too large: its simplifications and its numerics
    unseen: Array  # room for what the probes could not see, over the sizes; part of the bounds of the choice
    everything: float  # processor time of a run as exact with all effects and the most exact nodes and tolerances (s)


def decide(wishes: Wishes, seen: Seen, looker: Looker) -> Decision:
    """Choose, and run the choice as a whole. Where its error is larger than that of its parts, as simplifications act together,
    nothing is left out, and nodes and tolerances are the most exact ones.
    """
    ground, wish = seen.ground, wishes.size
    task = Task(
        want=wish,
        fixed=ground.drift + unseen_of(ground.drift),
        scatter=ground.scatter,
        window=ground.window,
        settle=looker.settle,
        least=LEAST_AVERAGING * wishes.period,
        most=MOST_AVERAGING * wishes.period,
        rate=seen.base.rate,
    )
    exact = Option(EXACT, np.zeros(wish.size), seen.truth.rate / seen.base.rate)
    effects, numbers = _options(wishes, seen)
    choice = choose(task, effects, [*numbers, exact], wishes.budget)
    made, changes, accuracy = _settings(choice, seen)
    exactly = choice.numerics == EXACT
    found = looker.probe(changes, accuracy, TRUTH_IN_PROBES if exactly else 1.0) if made or not exactly else seen.truth
    rejected = frozenset[str]()
    shown = errors_of(looker.influences(found, seen.truth), wishes) + ground.drift
    if found.failure or np.any(shown + unseen_of(shown) > np.maximum(choice.bounds, 0.8 * wish)):
        rejected = frozenset({*choice.left_out, *choice.numerics.split(AND)})
        choice, found, shown = choose(task, [], [exact], wishes.budget), seen.truth, ground.drift
        made, changes, accuracy = _settings(choice, seen)
    unseen = unseen_of(shown)
    bounds = shown + unseen
    errors = bounds + (choice.errors - choice.bounds)
    cost = found.rate * (looker.settle + choice.averaging)
    affordable = wishes.budget is None or cost <= 1.1 * wishes.budget
    within = bool(np.all(errors <= wish * (1.0 + 1e-9))) and affordable
    choice = replace(choice, bounds=bounds, errors=errors, cost=cost, within=within)
    everything = choose(task, [], [exact]).cost
    return Decision(choice, found, made, changes, accuracy, rejected, unseen, everything)


def unseen_of(seen: Array) -> Array:
    """Room for what probes cannot see beside the errors that they show, over the sizes of the averages."""
    return np.asarray(UNSEEN + UNSEEN_SHARE * seen)


def errors_of(found: Mapping[str, Influence], wishes: Wishes) -> Array:
    """Bounds of errors, in the order of the wishes."""
    return np.array([found[name].bound for name in wishes.names])


def _options(wishes: Wishes, seen: Seen) -> tuple[list[Option], list[Option]]:
    """Effects that may be left out, and choices of nodes and tolerances, with their share of the room for what probes cannot
    see.
    """

    def option(name: str, bounds: Array, time_ratio: float) -> Option:
        return Option(name, (1.0 + UNSEEN_SHARE) * bounds, time_ratio)

    tried: dict[str, list[tuple[str, Array, float]]] = {"effect": [], "nodes": [], "tolerances": [], "as given": []}
    for one in seen.tried:
        bounds = errors_of(one.change, wishes)
        if np.all(bounds <= wishes.size) and not one.probe.failure:
            tried[one.candidate.kind].append((one.candidate.name, bounds, one.time_ratio))
    error = errors_of(seen.usual_error, wishes)
    own = [(USUAL, error, 1.0)]
    own += [(name, bounds + error, ratio) for name, bounds, ratio in tried["nodes"] + tried["as given"]]
    own += [
        (f"{name}{AND}{other}", bounds + more, ratio * faster)
        for name, bounds, ratio in own
        for other, more, faster in tried["tolerances"]
    ]
    effects = [option(*one) for one in tried["effect"] if one[2] < 1.0 - seen.least_saving]
    return effects, [option(*one) for one in own]


def _settings(choice: Choice, seen: Seen) -> tuple[tuple[Candidate, ...], dict[str, Any], str]:
    """The candidates of a choice, fields of effects, and the preset of the tolerances."""
    names = {*choice.left_out, *choice.numerics.split(AND)}
    made = tuple(one.candidate for one in seen.tried if one.candidate.name in names)
    exact = choice.numerics == EXACT
    changes, accuracy = numerics(TRUE_NODES if exact else USUAL_NODES), TRUE_ACCURACY if exact else USUAL_ACCURACY
    for one in made:
        changes |= one.effects
        accuracy = one.accuracy if one.kind == "tolerances" else accuracy
    return made, changes, accuracy
