"""How far the largest pocket force after a load that drops and comes back scatters: over starts and over accuracies.

    python benchmarks/load_drop.py [--quick] [--json FILE] [--make-table [FILE]]

A drop lets the rollers leave their order, and the load that comes back throws them against the cage. Which hit is the hardest
is decided by where each roller is then, so that starts with other gaps between the rollers, and other accuracies, give other
peaks. Each drop is run with every preset from several seeds of Start.unequal. The scatter is the standard deviation of the
logarithm of the largest force, of the drop where it is largest; a run's band holds the largest force of another run with 95 %
probability if the logarithms are normal, and `held` is the share of pairs for which it does, of the drop where it is
smallest. --make-table writes the scatter into the package's table, from where summaries take the band. Seven minutes of
processor time.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import common
import numpy as np

from trbdyn import History, Simulation, Start
from trbdyn.errors import RunWarning
from trbdyn.model.cases import scene_30310
from trbdyn.run.estimate import TABLE
from trbdyn.run.options import ACCURACY

DROPS: Final = {
    "3000 to 300 N at 3000 rpm": (3000.0, 3000.0, 300.0),
    "4930 to 500 N at 1500 rpm": (1500.0, 4930.0, 500.0),
    "3000 to 300 N at 4500 rpm": (4500.0, 3000.0, 300.0),
    "3000 to 300 N at 6000 rpm": (6000.0, 3000.0, 300.0),
}
"""Speed (rpm), load before and after (N), load between (N)."""
TIMES: Final = (0.02, 0.04)
"""When the load drops and when it is back (s); each step takes a millisecond."""
LENGTH: Final = 0.06
"""Length of a run (s)."""
COLUMNS = {
    "drop": "text: load that drops and comes back, and speed",
    "accuracy": "text: preset",
    "peaks": "N: largest pocket force of each run",
    "mean": "N: their geometric mean",
    "lowest": "N: the smallest of them",
    "highest": "N: the largest of them",
    "scatter": "1: standard deviation of the logarithm of the peak over starts and accuracies, of the drop where it is largest",
    "runs": "1: number of runs behind it",
    "held": "1: share of pairs of runs of a drop for which the band of one holds the peak of the other",
}


def peak(speed: float, load: float, dropped: float, accuracy: str, seed: int) -> float:
    """Largest pocket force of a run (N)."""
    axial = History.step(TIMES, (load, dropped, load))
    scene = scene_30310(speed, axial, ring="follows", start=Start.unequal(seed=seed))
    result = Simulation(scene, accuracy=accuracy).run(duration=LENGTH)
    return float(result.peaks["pocket_force_peak"].max())


def scatter(report: common.Report) -> dict[str, Any]:
    """Largest scatter of the logarithms of a drop, and the smallest share of pairs of a drop that its band holds."""
    groups = {drop: [row for row in report.results if row["drop"] == drop] for drop in DROPS}
    logs = [np.log(np.concatenate([row["peaks"] for row in rows])) for rows in groups.values() if rows]
    found = max(float(np.std(values, ddof=1)) for values in logs)
    apart = [np.abs(values[:, None] - values)[np.triu_indices(values.size, 1)] for values in logs]
    held = min(float(np.mean(values < 1.96 * math.sqrt(2.0) * found)) for values in apart)
    return {"scatter": found, "runs": sum(values.size for values in logs), "held": held}


def run(report: common.Report, seeds: int) -> None:
    smoke = report.options.smoke
    for drop, (speed, load, dropped) in list(DROPS.items())[: 1 if smoke else None]:
        for accuracy in list(ACCURACY)[: 1 if smoke else None]:
            peaks = [peak(speed, load, dropped, accuracy, seed) for seed in range(1, seeds + 1)]
            mean = float(np.exp(np.mean(np.log(peaks))))
            report.add(drop=drop, accuracy=accuracy, peaks=peaks, mean=mean, lowest=min(peaks), highest=max(peaks))
            print(drop, accuracy, [round(value) for value in peaks], flush=True)
    report.summary = scatter(report)


def write_table(report: common.Report, path: Path) -> None:
    """Put the scatter into the package's table; everything else stays."""
    table = json.loads(path.read_text(encoding="utf-8"))
    text = "30310 whose axial load drops for 20 ms and comes back, " + " and ".join(DROPS)
    table["load_drop"] = {
        "made_by": "python benchmarks/load_drop.py --make-table",
        "text": text,
        "quick": report.options.quick,
        **{name: float(f"{value:.3g}") for name, value in report.summary.items()},
    }
    path.write_text(json.dumps(common.plain(table), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    print(f"wrote {path}")


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--seeds", type=int, help="runs of each preset; by default 6, 2 with --quick")
    parser.add_argument(
        "--make-table", nargs="?", type=Path, const=TABLE, metavar="FILE", help="write the package's table"
    )
    parser.add_argument(
        "--from-json", type=Path, metavar="FILE", help="measure nothing, take the results of such a file"
    )
    options = parser.parse_args(arguments)
    report = common.Report("load_drop", options, COLUMNS)
    report.inputs = {"times_s": TIMES, "length_s": LENGTH}
    if options.from_json is not None:
        report.take(options.from_json)
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RunWarning)
            run(report, options.seeds or (2 if options.quick else 6))
    print(report.summary)
    if options.make_table is not None:
        write_table(report, options.make_table)
    report.finish()
    return report


if __name__ == "__main__":
    main()
