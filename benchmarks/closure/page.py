"""The page and the picture of the grid of closures."""

from __future__ import annotations

from collections import Counter
from typing import Any, Final

import common
import numpy as np

from closure import grid

MEASURES: Final = ("closure", "closure_dissipated")
_PLACE: Final = ("preset", "effects", "speed_rpm", "load", "start")
Row = dict[str, Any]


def finished(rows: list[Row]) -> list[Row]:
    """Rows that were run to their end."""
    return [row for row in rows if row["status"] == "done"]


def silent(rows: list[Row]) -> list[Row]:
    """Finished rows about which nothing was said."""
    return [row for row in finished(rows) if not row["warnings"]]


def worst(rows: list[Row]) -> dict[str, dict[str, Any]]:
    """Largest closures of runs without a warning, by preset, and the counts behind them."""
    out = {}
    for preset in dict.fromkeys(row["preset"] for row in rows):
        here = [row for row in rows if row["preset"] == preset]
        quiet = silent(here)
        count = Counter(row["status"] for row in here)
        out[preset] = {
            "runs": len(here),
            "closure": max((row["closure"] for row in quiet), default=None),
            "closure_99": _quantile(quiet, "closure", 0.99),
            "closure_median": _quantile(quiet, "closure", 0.5),
            "above_promise": sum(row["closure"] > grid.PROMISE for row in quiet),
            "closure_dissipated": max((row["closure_dissipated"] or 0.0 for row in quiet), default=None),
            "dissipated_99": _quantile(quiet, "closure_dissipated", 0.99),
            "warned": len(finished(here)) - len(quiet),
            "ended": count["ended"],
            "errors": count["error"],
            "refused": count["refused"],
        }
    return out


def by_speed(rows: list[Row], name: str) -> list[Row]:
    """Largest closure of runs without a warning, a row for each preset and a column for each speed."""
    speeds = sorted({row["speed_rpm"] for row in rows})
    out = []
    for preset in dict.fromkeys(row["preset"] for row in rows):
        line: Row = {"preset": preset}
        for speed in speeds:
            here = [row for row in silent(rows) if row["preset"] == preset and row["speed_rpm"] == speed]
            line[f"{speed:g} rpm"] = max((row[name] for row in here if row[name] is not None), default=None)
        out.append(line)
    return out


def _quantile(rows: list[Row], name: str, share: float) -> float | None:
    values = [row[name] for row in rows if row[name] is not None]
    return float(np.quantile(values, share)) if values else None


def _sorted(rows: list[Row], name: str) -> list[Row]:
    return sorted((row for row in rows if row.get(name) is not None), key=lambda row: -row[name])


def results(report: common.Report) -> str:
    """The two tables that say what may be promised."""
    rows = report.results
    speeds = [name for name in by_speed(rows, "closure")[0] if name != "preset"]
    tables = []
    for measure in MEASURES:
        lines = by_speed(rows, measure)
        for line in lines:
            line[f"below {grid.PROMISE:g} from"] = _holds_from(line, speeds)
        tables.append(common.table(lines, lines[0], digits=2))
    return "\n".join(
        (
            "Largest closure of runs without a warning by speed, over the energy turned over:",
            "",
            tables[0],
            "",
            "Over the losses alone, as `energy_closure` of a result:",
            "",
            tables[1],
        )
    )


def _holds_from(line: Row, speeds: list[str]) -> str:
    """The speed from which on every closure of a preset is below the promise."""
    good = "never"
    for speed in reversed(speeds):
        if line[speed] is not None and line[speed] > grid.PROMISE:
            break
        good = speed
    return good


def page(report: common.Report) -> str:
    """Markdown: results first, then the worst cases, then how it was made."""
    rows = report.results
    found = report.summary["largest"]
    by_preset = [{"preset": preset} | figures for preset, figures in found.items()]
    by_effects = [
        {"preset": preset, "effects": effects} | worst(here)[preset]
        for preset in found
        for effects in grid.EFFECTS
        if (here := [row for row in rows if row["preset"] == preset and row["effects"] == effects])
    ]
    names = ("runs", "closure_median", "closure_99", "closure", "above_promise")
    more = ("dissipated_99", "closure_dissipated", "warned", "ended", "errors", "refused")
    inputs = report.inputs
    loads = "; ".join(dict.fromkeys(row["load"] for row in rows))
    parts = [
        "# Closures of the energy audit over speed, load, preset and effects",
        "",
        f"{inputs['points']} runs of the 30310, each at most {inputs['steps']} steps or {inputs['turns']:g} turns of the shaft. "
        f"Loads: {loads} (Fr over that under which the first roller loses its load; axial load "
        f"{grid.COMBINED_AXIAL:g} N, above 10 000 rpm {grid.COMBINED_AXIAL_FAST:g} N). Starts: "
        f"{', '.join(dict.fromkeys(row['start'] for row in rows))}.",
        "",
        results(report),
        "",
        f"Over all speeds, of runs without a warning. `above_promise` counts closures above {grid.PROMISE:g}, columns with "
        "`dissipated` are over the losses alone, `refused` are loads that cannot hold the rollers on the inner ring at that "
        "speed:",
        "",
        common.table(by_preset, ("preset", *names, *more)),
        "",
    ]
    if len(by_effects) > len(by_preset):
        parts += [common.table(by_effects, ("preset", "effects", *names, *more)), ""]
    if any(row["status"] != "error" for row in rows):
        parts += ["The command draws the closure over speed and load.", ""]
    parts += ["## Findings", "", _findings(report), ""]
    worst_rows = _sorted(finished(rows), "closure")[:15]
    figures = ("closure", "closure_dissipated", "loss_w", "steps", "turns", "mean_step_s", "repeated_share")
    parts += [
        "## Largest closures",
        "",
        common.table([_short(row) for row in worst_rows], (*_PLACE, *figures, "said")),
        "",
    ]
    over = _sorted(finished(rows), "closure_dissipated")[:10]
    parts += [
        "## Largest over the losses alone",
        "",
        "Where little was lost within a short run, most energy goes to and fro between the motion and the springs.",
        "",
        common.table([_short(row) for row in over], (*_PLACE, *figures, "said")),
        "",
        "## Command",
        "",
        "Made by `python benchmarks/closures.py --write`; with `--json FILE` every run goes to a file.",
        "",
    ]
    return "\n".join(parts)


def _short(row: Row) -> Row:
    return row | {"said": "warned" if row["warnings"] else ""}


def _findings(report: common.Report) -> str:
    bad = report.summary["bad"]
    if not bad:
        return (
            f"No run ended with a closure above {grid.BAD:g} without a warning, had to be ended, failed, or has steps "
            f"below {grid.SMALLEST_STEP:g} s."
        )
    return common.table(bad, (*_PLACE, "why"))


def draw(report: common.Report) -> Any:
    """Closure over speed and load, a panel for each preset and effects; the largest over starts."""
    from matplotlib.colors import LogNorm

    plt = common.pyplot()
    rows = report.results
    presets = list(dict.fromkeys(row["preset"] for row in rows))
    effects = list(dict.fromkeys(row["effects"] for row in rows))
    speeds = sorted({row["speed_rpm"] for row in rows})
    loads = list(dict.fromkeys(row["load"] for row in rows))
    figure, axes = plt.subplots(
        len(effects),
        len(presets),
        figsize=(4.4 * len(presets) + 1.5, 3.6 * len(effects) + 0.6),
        squeeze=False,
        sharex=True,
        sharey=True,
        layout="constrained",
    )
    norm = LogNorm(1e-6, 1e-1)
    for i, effect in enumerate(effects):
        for j, preset in enumerate(presets):
            here = [row for row in rows if row["effects"] == effect and row["preset"] == preset]
            values = np.full((len(loads), len(speeds)), np.nan)
            for row in here:
                place = loads.index(row["load"]), speeds.index(row["speed_rpm"])
                if row["status"] == "done":
                    values[place] = np.nanmax([values[place], row["closure"]])
            image = axes[i, j].imshow(
                np.maximum(values, 1e-6), norm=norm, cmap="viridis", aspect="auto", origin="lower"
            )
            for row in here:
                if grid.is_bad(row) or row.get("warnings"):
                    axes[i, j].text(
                        speeds.index(row["speed_rpm"]),
                        loads.index(row["load"]),
                        "x" if grid.is_bad(row) else "w",
                        ha="center",
                        va="center",
                        color="red" if grid.is_bad(row) else "white",
                    )
            axes[i, j].set_title(f"accuracy '{preset}', effects '{effect}'")
            axes[i, j].set_xticks(range(len(speeds)), [f"{speed:g}" for speed in speeds], rotation=45)
            axes[i, j].set_yticks(range(len(loads)), loads)
            if i == len(effects) - 1:
                axes[i, j].set_xlabel("speed (rpm)")
    bar = figure.colorbar(image, ax=axes, shrink=0.8)
    bar.set_label("closure: residual over the energy turned over (1)")
    figure.suptitle(
        "Closure of the energy audit of the 30310; w: the run warned, x: a finding, white: no equilibrium; "
        "Fr over that of the first unloaded roller",
        fontsize=11,
    )
    return figure
