"""Comparison of integrators at equal error, and the floor of a force evaluation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy_model import floor

from .bench import Bench, Point


def at_error(points: Sequence[tuple[float, float]], error: float) -> float:
    """Value at an error, from (error, value) by log-log interpolation between points that no other beats in both; that of the
    nearest point beyond the ends.
    """
    kept: list[tuple[float, float]] = []
    for point in sorted(points):
        if not kept or point[1] < kept[-1][1]:
            kept.append(point)
    errors, values = np.log(np.array(kept)).T
    return float(np.exp(np.interp(math.log(error), errors, values)))


def compared(points: list[Point], own: list[Point], target: float) -> dict[str, float]:
    """An integrator at the error at which it is compared with the core."""

    def curve(which: list[Point], name: str) -> list[tuple[float, float]]:
        return [(point.error, getattr(point, name)) for point in which]

    def within(error: float) -> float:
        low = max(min(p.error for p in points), min(p.error for p in own))
        high = min(max(p.error for p in points), max(p.error for p in own))
        return min(max(error, low), max(high, low))

    def ratio(error: float) -> float:
        return at_error(curve(points, "wall"), within(error)) / at_error(curve(own, "wall"), within(error))

    near = [ratio(target * part) for part in np.geomspace(1.0 / 3.0, 3.0, 9)]
    wall = at_error(curve(points, "wall"), within(target))
    # counts belong to the time: those of the points between which it lies
    order = sorted(points, key=lambda point: point.wall)

    def beside(name: str) -> float:
        return float(np.interp(math.log(wall), [math.log(p.wall) for p in order], [getattr(p, name) for p in order]))

    return {
        "ratio": ratio(target),
        "ratio_low": min(near),
        "ratio_high": max(near),
        "wall_s_per_revolution": wall,
        "error_cage_over_cpr": within(target),
        "steps": beside("steps"),
        "evaluations": beside("evaluations"),
        "jacobians": beside("jacobians"),
        "us_per_step": 1e6 * wall / beside("steps"),
    }


def least(bench: Bench, row: dict[str, Any], us: float) -> dict[str, Any]:
    """The floor of a force evaluation, and of a turn of the shaft with the steps of the core. An estimate."""
    rates, nodes = floor.measure(), 2 * bench.model.constants.n_rollers * bench.model.constants.n_nodes
    rollers = bench.model.constants.n_rollers
    evaluation = 1e-3 * (nodes * rates.of(floor.NODE) + rollers * rates.of(floor.ROLLER))
    turn = evaluation * row["evaluations"]
    return {
        "estimate": True,
        "rates": rates.how,
        "ns_per_operation": rates.nanoseconds,
        "operations_per_node": floor.totals(floor.NODE),
        "operations_per_roller": floor.totals(floor.ROLLER),
        "nodes": nodes,
        "ns_per_node": rates.of(floor.NODE),
        "us_per_evaluation": evaluation,
        "core_over_floor": us / evaluation,
        "wall_s_per_revolution": 1e-6 * turn,
        "text": "all nodes and rollers at the rates of long loops; a turn: as many evaluations as the core's standard integrator "
        "makes, without Jacobians and linear algebra",
    }
