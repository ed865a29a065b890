"""The tables of work_precision.py: what the presets cost and give in each scene, first; then everything behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import common

from accuracy import measure

Row = dict[str, Any]


def _real_time(report: common.Report, row: Row) -> float:
    """Bearing time over processor time."""
    speed: float = report.summary["scenes"][row["case"]]["speed_rpm"]
    return 60.0 / speed / float(row["cpu_s_per_revolution"])


def preset_rows(report: common.Report) -> list[Row]:
    """A row for each scene and preset: cost and error of the path."""
    return [
        {
            "scene": row["case"],
            "preset": row["preset"],
            "time a turn (ms)": 1e3 * row["cpu_s_per_revolution"],
            "real time x": _real_time(report, row),
            "path, median (% of Cpr)": 100.0 * row["error_cage_over_cpr"],
            "worst (% of Cpr)": 100.0 * row["error_cage_over_cpr_worst"],
        }
        for row in report.results
        if row["sweep"] == "presets"
    ]


def user_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """A row for each preset: the steps alone, a user's run in memory, and with a file; empty without rows."""
    if not rows:
        return ""
    found: list[Row] = [
        {
            "preset": row["preset"],
            "steps alone (ms)": 1e3 * row["wall_s_bare"],
            "run in memory (ms)": 1e3 * row["wall_s_memory"],
            "run with file (ms)": 1e3 * row["wall_s_file"],
            "memory over steps": row["memory_over_bare"],
            "file over steps": row["file_over_bare"],
        }
        for row in rows
    ]
    text = "What a user's run takes: default records of all groups, 24 slices, wall time a turn; medians:"
    return "\n".join((text, "", common.table(found, found[0])))


def text_of(report: common.Report, *, everything: bool = False) -> str:
    """Markdown: the short table first; with `everything` the tables behind it as well."""
    rows = preset_rows(report)
    parts = [common.table(rows, rows[0]) if rows else "", ""]
    users = user_table([row for row in report.results if row["sweep"] == "user"])
    parts += [users, ""] if users else []
    parts += ["The scenes:", "", _scenes(report), ""]
    if not everything:
        return "\n".join(parts)
    cost = ("cpu_s_per_revolution", "real_time_factor", "steps_per_revolution")
    kinds = ("presets", "tolerances")
    points = [row for row in report.results if row["sweep"] in kinds]
    nodes = [row for row in report.results if row["sweep"] == "slices"]
    parts += [
        "Tolerances and methods:",
        "",
        common.table(points, ("case", "name", *cost, *measure.QUANTITIES, "warnings")),
        "",
    ]
    names = ("name", "us_per_evaluation", "error_displacement", *measure.QUANTITIES)
    parts += ["Nodes along a contact line:", "", common.table(nodes, names), ""]
    fronts = [{"scene": name, "on the front": ", ".join(found)} for name, found in report.summary["pareto"].items()]
    parts += ["Pareto front of time and error of the path:", "", common.table(fronts, ("scene", "on the front")), ""]
    checked = [{"scene": name, **found} for name, found in report.summary["reference_disagreement"].items()]
    if checked:
        parts += ["The two reference methods differ by:", "", common.table(checked, ("scene", *measure.QUANTITIES)), ""]
    return "\n".join(parts)


def _scenes(report: common.Report) -> str:
    rows = [
        {
            "scene": name,
            "what": found["text"],
            "speed (rpm)": found["speed_rpm"],
            "Fa (N)": found["axial_load"],
            "Fr (N)": found["radial_load"],
            "windows (ms)": _range([1e3 * one["window_s"] for one in report.summary["windows"][name]]),
            "impacts": _range([one["impacts"] for one in report.summary["windows"][name]]),
        }
        for name, found in report.summary["scenes"].items()
    ]
    return common.table(rows, rows[0], digits=6) if rows else ""


def _range(values: list[float]) -> str:
    low, high = (f"{value:.3g}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"
