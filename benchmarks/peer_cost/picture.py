"""The picture of peers.py."""

from __future__ import annotations

from typing import Any

import common

from .bench import AXIAL_LOAD, SPEED_RPM


def draw(rows: list[dict[str, Any]], summary: dict[str, Any]) -> None:
    """Time against error, and times of a force evaluation."""
    plt = common.pyplot()
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(12.0, 6.0), width_ratios=[2.2, 1.0], constrained_layout=True
    )  # fmt: skip
    colours = plt.get_cmap("tab20").colors
    for index, row in enumerate(rows):
        own = row["model"] == "core"
        points = sorted(row["points"], key=lambda point: point["error"])
        if not points:
            continue
        text = row["name"] if row["ratio"] is None else f"{row['name']}: {row['ratio']:.3g}"
        left.loglog(
            [point["error"] for point in points],
            [point["wall"] for point in points],
            marker="o" if own else "s",
            linestyle="-" if own else "--",
            linewidth=2.2 if own else 1.2,
            markersize=6 if own else 4.5,
            color=colours[(2 * index) % 20 + index // 10],
            markerfacecolor="white" if row["jacobian"] == "ours" else None,
            label=text,
        )
    target = summary["target_error_over_cpr"]
    left.axvline(target, color="0.7", linewidth=1.0, zorder=0)
    left.plot(
        target,
        summary["floor"]["wall_s_per_revolution"],
        marker="v",
        color="0.3",
        linestyle="none",
        label="floor, estimate",
    )
    left.annotate(
        "error of accuracy='standard'",
        (target, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(3, -11),
        textcoords="offset points",
        fontsize=8,
        color="0.4",
    )
    left.set_xlabel("error of the cage's centre, in units of Cpr")
    left.set_ylabel("time per turn of the shaft, s")
    left.set_title(f"Whirling, colliding cage, {AXIAL_LOAD:g} N, {SPEED_RPM:g} rpm")
    left.grid(True, which="major", color="0.9")
    left.margins(y=0.12)
    handles, texts = left.get_legend_handles_labels()
    figure.legend(
        handles,
        texts,
        title="with the ratio of times at equal error",
        ncols=5,
        fontsize=8,
        title_fontsize=8,
        loc="outside lower center",
    )
    names = ["NumPy", "core", "floor,\nestimate"]
    values = [
        summary["us_per_evaluation_numpy"],
        summary["us_per_evaluation_core"],
        summary["floor"]["us_per_evaluation"],
    ]
    bars = right.bar(names, values, color=["tab:orange", "tab:blue", "0.6"])
    right.bar_label(bars, [f"{value:.3g}" for value in values])
    right.set_yscale("log")
    right.set_ylim(0.5 * min(values), 2.0 * max(values))
    right.set_ylabel("time of a force evaluation, us")
    right.set_title("One force evaluation")
    common.save_picture(figure, "peers")
    plt.close(figure)
