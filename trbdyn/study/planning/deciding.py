"""The choice of a plan: the cheapest set by the errors of its parts, run as a whole; chosen again where the whole is worse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from trbdyn.study.planning.candidates import TRUE_ACCURACY, TRUE_NODES, USUAL_ACCURACY, USUAL_NODES, Candidate, numerics
from trbdyn.study.planning.choice import Choice, Option, Task, choose
from trbdyn.study.planning.looking import LEAST_AVERAGING, TRUTH_IN_PROBES, Looker, Seen
from trbdyn.study.planning.probes import Array, Influence, Probe
from trbdyn.study.planning.wishes import TOLD_APART, Wishes

MOST_AVERAGING: Final = 20_000.0
"""Turns of the shaft of the averaging at most."""
UNSEEN: Final = 0.001
UNSEEN_SHARE: Final = 0.5
"""What a short probe cannot see: an error of this size, and this share of the errors of model, numerics and settling that it
sees. Assumed; held against long runs by benchmarks/plan_proof.py."""
TRIES: Final = 4
"""Choices that are run as a whole at most; where none is as exact as its parts, the most exact choice is taken."""
AND: Final = " and "
USUAL: Final = f"{USUAL_NODES} nodes, tolerances '{USUAL_ACCURACY}'"
EXACT: Final = f"{TRUE_NODES} nodes, tolerances '{TRUE_ACCURACY}'"
KEPT: Final = (USUAL, EXACT)
"""Choices that are never struck out."""


@dataclass(frozen=True)
class Decision:
    """What a plan takes: the choice, with errors and cost of the whole, and the simplifications that are made."""

    choice: Choice
    found: Probe  # the probe of the whole
    made: tuple[Candidate, ...]
    effects: Mapping[str, Any]  # fields of `Effects` that are changed
    accuracy: str  # preset of the tolerances
    struck: frozenset[str]  # simplifications that made the error of the whole too large
    task: Task  # what was chosen from
    unseen: Array  # room for what the probes could not see, over the sizes; part of the bounds of the choice


def decide(wishes: Wishes, seen: Seen, looker: Looker) -> Decision:
    """Choose, run the choice as a whole, and choose again where its error is larger than that of its parts."""
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
    struck = set[str]()
    for tries in range(TRIES + 1):
        effects, numbers = _options(wishes, seen, struck)
        if tries == TRIES or USUAL in struck:
            effects, numbers = [], [one for one in numbers if one.name == EXACT]
        choice = choose(task, effects, numbers, wishes.budget)
        made = _made(choice, seen)
        changes, accuracy = _settings(choice, made)
        exact = choice.numerics == EXACT
        found = seen.truth if exact and not made else looker.probe(changes, accuracy, TRUTH_IN_PROBES if exact else 1.0)
        whole = errors_of(looker.influences(found, seen.truth), wishes)
        seen_errors = whole + ground.drift
        if found.failure or np.any(seen_errors + unseen_of(seen_errors) > np.maximum(choice.bounds, 0.8 * wish)):
            struck.add(_worst(choice, [*effects, *numbers], wish) or USUAL)
            continue
        break
    unseen = unseen_of(whole + ground.drift)
    bounds = whole + ground.drift + unseen
    errors = bounds + (choice.errors - choice.bounds)
    cost = found.rate * (looker.settle + choice.averaging)
    affordable = wishes.budget is None or cost <= 1.1 * wishes.budget
    within = bool(np.all(errors <= wish * (1.0 + 1e-9))) and affordable
    choice = replace(choice, bounds=bounds, errors=errors, cost=cost, within=within)
    return Decision(choice, found, made, changes, accuracy, frozenset(struck), task, unseen)


def unseen_of(seen: Array) -> Array:
    """Room for what probes cannot see beside the errors that they show, over the sizes of the averages."""
    return np.asarray(UNSEEN + UNSEEN_SHARE * seen)


def is_hidden(found: Influence, wish: float) -> bool:
    """Whether chance hides an influence that may matter."""
    return found.half_width > TOLD_APART * wish and abs(found.change) <= found.half_width


def errors_of(found: Mapping[str, Influence], wishes: Wishes) -> Array:
    """Bounds of errors; where chance hides a small one, the difference that was seen counts alone, and that is said."""
    return np.array(
        [
            abs(found[name].change) if is_hidden(found[name], wish) else found[name].bound
            for name, wish in wishes.want.items()
        ]
    )


def _worst(choice: Choice, options: list[Option], wish: Array) -> str:
    """The simplification of a choice with the largest error over its wish; empty if there is none."""
    made = [one for one in options if one.name in (*choice.left_out, choice.numerics) and one.name not in KEPT]
    return max(made, key=lambda one: float(np.max(one.bounds / wish))).name if made else ""


def _options(wishes: Wishes, seen: Seen, struck: set[str]) -> tuple[list[Option], list[Option]]:
    """Effects that may be left out, and choices of nodes and tolerances."""

    def of(name: str) -> Option:
        bounds = np.array([seen.alone[name][wanted].bound for wanted in wishes.names])
        return Option(name, bounds, seen.probes[name].rate / seen.base.rate)

    def fine(name: str) -> bool:
        found, fits = seen.probes[name], all(seen.alone[name][w].bound <= wish for w, wish in wishes.want.items())
        return fits and name not in struck and not found.failure and not seen.new_warning(name)

    def of_kind(*kinds: str) -> list[Option]:
        return [of(one.name) for one in seen.candidates if one.kind in kinds and fine(one.name)]

    effects = [one for one in of_kind("effect") if one.time_ratio < 1.0 - seen.least_saving]
    error = errors_of(seen.usual_error, wishes)
    own = [
        Option(USUAL, error, 1.0),
        *(replace(one, bounds=one.bounds + error) for one in of_kind("nodes", "as given")),
    ]
    both = [
        Option(f"{one.name}{AND}{other.name}", one.bounds + other.bounds, one.time_ratio * other.time_ratio)
        for one in own
        for other in of_kind("tolerances")
    ]
    exact = Option(EXACT, np.zeros(wishes.size.size), seen.truth.rate / seen.base.rate)
    fitting = [one for one in [*own, *both] if one.name not in struck] + [exact]
    return [_with_room(one) for one in effects], [_with_room(one) for one in fitting]


def _with_room(one: Option) -> Option:
    """An option with its share of the room for what probes cannot see."""
    return replace(one, bounds=(1.0 + UNSEEN_SHARE) * one.bounds)


def _made(choice: Choice, seen: Seen) -> tuple[Candidate, ...]:
    names = {*choice.left_out, *choice.numerics.split(AND)}
    return tuple(one for one in seen.candidates if one.name in names)


def _settings(choice: Choice, made: tuple[Candidate, ...]) -> tuple[dict[str, Any], str]:
    """Fields of effects, and the preset of the tolerances."""
    if choice.numerics == EXACT:
        changes, accuracy = numerics(TRUE_NODES), TRUE_ACCURACY
    else:
        changes, accuracy = numerics(USUAL_NODES), USUAL_ACCURACY
    for one in made:
        changes |= one.effects
        accuracy = one.accuracy if one.kind == "tolerances" else accuracy
    return changes, accuracy
