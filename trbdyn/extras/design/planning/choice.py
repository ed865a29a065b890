"""The cheapest set of simplifications whose errors, together with the statistical error, stay within what is wanted.

Errors of the model, of the nodes and of the tolerances are bounds of relative errors of each wanted average; they add up, in the
worst case without cancelling. What room they leave is for the statistical error, which falls with the square root of the length
of the averaging. So each simplification makes a second of bearing time cheaper and may make more of them necessary; which set is
the cheapest is found by trying all of them.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST_ROOM = 0.2
"""Statistical error that is always allowed, over the wish or over the other errors, whichever is larger: no length of a run helps
against the others."""


@dataclass(frozen=True)
class Option:
    """A simplification, or a choice of nodes and tolerances."""

    name: str
    bounds: Array  # bound of the relative error of each wanted average, shape (W,)
    time_ratio: float  # computing time with it over that without it


@dataclass(frozen=True)
class Task:
    """What is to be chosen from, for W wanted averages."""

    want: Array  # wanted relative errors, shape (W,)
    fixed: Array  # errors that no choice changes, for instance of settling, shape (W,)
    scatter: Array  # half width of the confidence interval over the average, after averaging over `window`, shape (W,)
    window: float  # bearing time that the scatter belongs to (s)
    settle: float  # bearing time before the averaging (s)
    least: float  # shortest averaging (s)
    most: float  # longest averaging (s)
    rate: float  # computing time for a second of bearing time, with everything (s)


@dataclass(frozen=True)
class Choice:
    """A set of simplifications with its length and its errors."""

    left_out: tuple[str, ...]  # simplifications that are made
    numerics: str  # choice of nodes and tolerances
    averaging: float  # bearing time of the averaging (s)
    cost: float  # computing time (s)
    bounds: Array  # errors of model, nodes, tolerances and settling, shape (W,)
    errors: Array  # the same with the statistical error
    within: bool  # whether every error is within the wish, and the cost within the budget


def choose(
    task: Task, simplifications: Sequence[Option], numerics: Sequence[Option], budget: float | None = None
) -> Choice:
    """The cheapest choice within the wish, of any of the simplifications (at most 16) and one of the numerics. With a budget of
    computing time (s) it is the most exact one within the budget; where nothing is within the wish, the one with the smallest
    error over its wish.
    """
    found = [
        _priced(task, made, numbers, budget)
        for size in range(len(simplifications) + 1)
        for made in itertools.combinations(simplifications, size)
        for numbers in numerics
    ]
    fine = [choice for choice in found if choice.within]
    if fine and budget is None:
        return min(fine, key=lambda choice: choice.cost)
    affordable = [choice for choice in found if budget is None or choice.cost <= budget * (1.0 + 1e-9)]
    return min(affordable or found, key=lambda choice: (float(np.max(choice.errors / task.want)), choice.cost))


def _priced(task: Task, made: Sequence[Option], numbers: Option, budget: float | None) -> Choice:
    """Length, cost and errors of a set."""
    bounds = task.fixed + numbers.bounds + sum((one.bounds for one in made), np.zeros(task.want.size))
    rate = task.rate * numbers.time_ratio * float(np.prod([one.time_ratio for one in made]))
    if budget is None:
        room = np.maximum(task.want - bounds, LEAST_ROOM * np.maximum(task.want, bounds))
        averaging = float(np.max(task.window * (task.scatter / room) ** 2))
    else:
        averaging = budget / rate - task.settle
    averaging = min(max(averaging, task.least), task.most)
    errors = bounds + task.scatter * np.sqrt(task.window / averaging)
    cost = rate * (task.settle + averaging)
    within = bool(np.all(errors <= task.want * (1.0 + 1e-9))) and (budget is None or cost <= budget * (1.0 + 1e-9))
    return Choice(tuple(one.name for one in made), numbers.name, averaging, cost, bounds, errors, within)
