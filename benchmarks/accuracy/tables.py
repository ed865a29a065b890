"""The tables of work_precision.py: what the presets cost and give in each scene, first; then everything behind it."""

from __future__ import annotations

import math
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
    if value is None or not math.isfinite(value):
        return "-"
    band = "" if half is None or not math.isfinite(half) else f" ± {100.0 * half:.2g}"
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


def text_of(report: common.Report, *, everything: bool = False) -> str:
    """Markdown: the short table first; with `everything` the tables behind it as well."""
    rows = preset_rows(report)
    parts = [common.table(rows, rows[0]) if rows else "", "", _scenes(report), ""]
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
    parts += ["Tolerances and methods:", "", common.table(points, ("case", "name", *cost, *measure.QUANTITIES)), ""]
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


def _range(values: list[float]) -> str:
    low, high = min(values), max(values)
    return f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"


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
                band = f" ± {unit * half:.2g}" if math.isfinite(half) else ""
                shown[title] = f"{unit * row[name]:.4g}{band}"
            rows.append(shown)
    return common.table(rows, rows[0]) if rows else "none"
