"""The picture of work_precision.py: fronts of error and wall time, slices."""

from __future__ import annotations

from typing import Any

import common

COLOURS = {
    "bdf1": "tab:brown",
    "bdf2": "tab:blue",
    "bdf2exact": "tab:cyan",
    "bdf3": "tab:purple",
    "bdf5": "tab:pink",
    "erk": "tab:orange",
}
TEXTS = {
    "bdf1": "BDF 1",
    "bdf2": "BDF to order 2",
    "bdf2exact": "BDF to order 2, every force exact",
    "bdf3": "BDF to order 3",
    "bdf5": "BDF to order 5",
    "erk": "explicit",
}
PRESETS = {"fast": "^", "standard": "*", "reference": "s"}
TITLES = {
    "smooth": "smooth rolling, 3000 rpm, 4930 N",
    "collision": "colliding cage, 3000 rpm, 4930 N",
    "combined": "combined load, 2000 rpm, 4930 / 5530 N",
    "light": "light load, 3000 rpm, 1230 N",
    "heavy": "heavy load, 3000 rpm, 20 kN",
    "slow": "slow, 100 rpm, 4930 N",
    "fast": "fast, 10 000 rpm, 4930 N",
    "scatter": "unequal rollers, 3000 rpm, 4930 N",
}
USER = (
    ("wall_s_file", "v-", "presets: a user's run, with file, default records, 24 slices (wall time)"),
    ("wall_s_bare", "v:", "presets: the steps of the same alone (wall time)"),
)
LEAST_ERROR = 1e-8


def _wall_error(rows: list[dict[str, Any]], key: str) -> tuple[list[float], list[float]]:
    ordered = sorted(rows, key=lambda row: row["scale"])
    return [1e3 * row["cpu_s_per_revolution"] for row in ordered], [
        100.0 * max(row[key], LEAST_ERROR) for row in ordered
    ]


def _front(axes: Any, rows: list[dict[str, Any]], case: str, speed_rpm: float) -> None:
    here = [row for row in rows if row["case"] == case and row["sweep"] in ("tolerances", "presets")]
    for method, colour in COLOURS.items():
        points = [row for row in here if row["method"] == method and not row["preset"]]
        if not points:
            continue
        wall, median = _wall_error(points, "error_cage_over_cpr")
        axes.loglog(wall, median, "o-", color=colour, ms=4, lw=1.2, label=TEXTS[method])
        if method == "bdf2":
            axes.loglog(*_wall_error(points, "error_cage_over_cpr_worst"), ":", color=colour, lw=1, label="worst state")
    for row in here:
        if row["preset"]:
            axes.loglog(
                1e3 * row["cpu_s_per_revolution"],
                100.0 * max(row["error_cage_over_cpr"], LEAST_ERROR),
                PRESETS[row["preset"]],
                color="black",
                ms=13 if row["preset"] == "standard" else 8,
                label=f"preset {row['preset']}",
                zorder=5,
            )
    for key, mark, text in USER:
        points = [row for row in rows if row["case"] == case and row["sweep"] == "user"]
        if points:
            times = [1e3 * row[key] for row in points]
            errors = [100.0 * max(row["error_cage_over_cpr"], LEAST_ERROR) for row in points]
            axes.loglog(times, errors, mark, color="tab:red", ms=5, lw=1.2, label=text)
    real_time = 6e4 / speed_rpm
    axes.axvline(real_time, color="0.5", lw=0.8, ls="--")
    axes.axhline(1.0, color="0.5", lw=0.8, ls="--")
    axes.text(real_time, 0.98, " real time", transform=axes.get_xaxis_transform(), va="top", color="0.4", fontsize=8)
    axes.text(0.0, 1.0, " 1 % of Cpr", transform=axes.get_yaxis_transform(), va="bottom", color="0.4", fontsize=8)
    _plain_ticks(axes)
    axes.set_xlabel("time of a revolution on one core (ms)")
    axes.set_ylabel("cage centre: error (% of Cpr)")
    axes.set_title(TITLES[case])


def _plain_ticks(axes: Any) -> None:
    """Times as plain numbers; errors as powers of ten, with one at least."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    low, high = axes.get_ylim()
    axes.set_ylim(0.7 * low, max(1.5 * high, 20.0 * low))


def _slices(axes: Any, rows: list[dict[str, Any]]) -> None:
    for quadrature, mark in (("uniform", "s-"), ("gauss", "o-")):
        points = sorted(
            (row for row in rows if row["sweep"] == "slices" and row["quadrature"] == quadrature),
            key=lambda row: row["n_slices"],
        )
        if not points:
            continue
        cost = [row["us_per_evaluation"] for row in points]
        line = axes.loglog(
            cost, [100.0 * row["error_cage_over_cpr"] for row in points], mark, ms=5, label=f"{quadrature}: cage centre"
        )
        axes.loglog(
            cost,
            [100.0 * row["error_displacement"] for row in points],
            mark.replace("-", ":"),
            ms=3,
            color=line[0].get_color(),
            label=f"{quadrature}: ring's place",
        )
        for row, x in zip(points, cost, strict=True):
            axes.annotate(
                str(row["n_slices"]),
                (x, 100.0 * row["error_cage_over_cpr"]),
                textcoords="offset points",
                xytext=(4, 4),
                fontsize=8,
            )
    axes.set_xlabel("one force evaluation (µs)")
    axes.set_ylabel("error (% of Cpr, % of displacement)")
    axes.set_title("nodes along a contact, colliding cage")
    _plain_ticks(axes)
    axes.legend(fontsize=8)


def draw_front(report: common.Report) -> Any:
    """Pareto fronts of each case, and the nodes along a contact."""
    cases = [name for name in TITLES if any(row["case"] == name for row in report.results)]
    plt = common.pyplot()
    panels = len(cases) + 1
    width = min(3, panels)
    height = -(-panels // width)
    figure, grid = plt.subplots(height, width, figsize=(5.2 * width, 4.2 * height), squeeze=False, layout="constrained")
    flat = grid.ravel()
    for axes in flat[panels:]:
        axes.set_axis_off()
    for axes, case in zip(flat, cases, strict=False):
        _front(axes, report.results, case, report.summary["scenes"][case]["speed_rpm"])
    handles: dict[str, Any] = {}
    for axes in flat[: len(cases)]:
        handles |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), fontsize=8, loc="outside lower center", ncols=5)
    _slices(flat[len(cases)], report.results)
    machine = common.processor()["name"]
    figure.suptitle(f"What accuracy costs: 30310, 12 rollers, every effect, one core ({machine})", fontsize=11)
    return figure
