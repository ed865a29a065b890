"""The tables of work_precision.py: what the presets cost and give in each scene, first; then everything behind it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import common

from accuracy import measure

Row = dict[str, Any]

BIASES: Final = {
    "pocket_mean": "mean pocket force (%)",
    "pocket_p95": "p95 of pocket force (%)",
    "duty": "contact duty (%)",
    "loss": "loss (%)",
    "orbit": "orbit (% of Cpr)",
}
"""What users read of a run, and how its bias is headed."""


def _percent(value: float | None, half: float | None) -> str:
    """A bias with its half width, in per cent."""
    if value is None or not _known(value):
        return "-"
    band = "" if half is None or not _known(half) else f" ± {100.0 * half:.2g}"
    return f"{100.0 * value:+.2g}{band}"


def _real_time(report: common.Report, row: Row) -> float:
    """Bearing time over processor time."""
    speed: float = report.summary["scenes"][row["case"]]["speed_rpm"]
    return 60.0 / speed / float(row["cpu_s_per_revolution"])


def preset_rows(report: common.Report) -> list[Row]:
    """A row for each scene and preset: cost, error of the path, bias of what users read, closure."""
    statistics = {
        (row["case"], row["preset"]): row for row in report.results if row["sweep"] == "statistics" and row["preset"]
    }
    out = []
    for row in report.results:
        if row["sweep"] != "presets":
            continue
        far = statistics.get((row["case"], row["preset"]), {})
        out.append(
            {
                "scene": row["case"],
                "preset": row["preset"],
                "time a turn (ms)": 1e3 * row["cpu_s_per_revolution"],
                "real time x": _real_time(report, row),
                "path, median (% of Cpr)": 100.0 * row["error_cage_over_cpr"],
                "worst (% of Cpr)": 100.0 * row["error_cage_over_cpr_worst"],
                **{
                    title: _percent(far.get(f"bias_{name}"), far.get(f"bias_{name}_half_width"))
                    for name, title in BIASES.items()
                },
                "closure": far.get("energy_closure"),
            }
        )
    return out


def range_rows(report: common.Report) -> list[Row]:
    """A row for each preset: the range over the scenes."""
    out = []
    every = [row for row in report.results if row["sweep"] == "presets"]
    for preset in dict.fromkeys(row["preset"] for row in every):
        rows = [row for row in every if row["preset"] == preset]
        far = [
            row
            for row in report.results
            if row["sweep"] == "statistics" and row["preset"] == preset and not row.get("failure")
        ]
        biases = {name: [100.0 * row[f"bias_{name}"] for row in far if _known(row[f"bias_{name}"])] for name in BIASES}
        out.append(
            {
                "preset": preset,
                "real time x": _range([_real_time(report, row) for row in rows], 2),
                "path, median (% of Cpr)": _range([100.0 * row["error_cage_over_cpr"] for row in rows], 2),
                "worst (% of Cpr)": f"{100.0 * max(row['error_cage_over_cpr_worst'] for row in rows):.2g}",
                **{title: _range(biases[name], 2, sign="+") if biases[name] else "-" for name, title in BIASES.items()},
            }
        )
    return out


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


def _known(value: float | None) -> bool:
    return value is not None and math.isfinite(value)


def text_of(report: common.Report, *, everything: bool = False) -> str:
    """Markdown: the short table first; with `everything` the tables behind it as well."""
    ranges, rows = range_rows(report), preset_rows(report)
    parts = ["Range over the scenes:", "", common.table(ranges, ranges[0]) if ranges else "", ""]
    parts += ["Scene by scene:", "", common.table(rows, rows[0]) if rows else "", ""]
    users = user_table([row for row in report.results if row["sweep"] == "user"])
    parts += [users, ""] if users else []
    parts += ["The scenes:", "", _scenes(report), ""]
    failures = [row for row in report.results if row.get("failure")]
    if failures:
        parts += ["Runs without figures:", "", common.table(failures, ("case", "name", "failure")), ""]
    parts += ["Means of the tight runs:", "", _tight(report), ""]
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
    parts += [
        "Means within the windows:",
        "",
        common.table(points, ("case", "name", *measure.OBSERVABLES, *(f"{n}_worst" for n in measure.OBSERVABLES))),
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


def _range(values: list[float], digits: int = 3, sign: str = "") -> str:
    low, high = (f"{value:{sign}.{digits}g}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def _tight(report: common.Report) -> str:
    titles = {
        "pocket_mean": ("all pockets (N)", 1.0),
        "pocket_p95": ("p95 of a pocket (N)", 1.0),
        "duty": ("contact duty (%)", 100.0),
        "loss": ("loss (W)", 1.0),
        "orbit": ("orbit (% of Cpr)", 100.0),
    }
    rows = []
    for row in report.results:
        if row["sweep"] == "statistics" and row["name"] == "tight" and not row.get("failure"):
            shown = {"scene": row["case"]}
            for name, (title, unit) in titles.items():
                half = row[f"{name}_half_width"]
                band = f" ± {unit * half:.2g}" if _known(half) else ""
                shown[title] = f"{unit * row[name]:.4g}{band}"
            rows.append(shown)
    return common.table(rows, rows[0]) if rows else "none"
