"""Efficiency of parameter studies: the same cases on one worker and on more, in processes and in threads.

The speed-up is the wall time on one worker of the same kind over that on n; the efficiency is the speed-up over n. The time in
which worker processes start counts. Run it on a machine that does nothing else: cores shared with others show as inefficiency.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import common
import numpy as np

import trbdyn as trb
from trbdyn import study
from trbdyn.study.executors import cores

COLUMNS = {
    "executor": "1: kind of worker",
    "workers": "1: number of workers",
    "cases": "1: number of cases",
    "wall": "s: wall time of the study",
    "speed_up": "1: wall time on one worker over this one",
    "efficiency": "1: speed-up over the number of workers",
    "identical": "1: observables equal those of the first row bit by bit",
    "efficiency_processes": "1: efficiency of processes on the largest number of workers",
    "efficiency_threads": "1: efficiency of threads on the largest number of workers",
}


def main() -> None:
    """Run the benchmark."""
    options = common.parser(__doc__).parse_args()
    report = common.Report("study_efficiency", options, COLUMNS)
    count, revolutions, repeats = (8, 10.0, 1) if options.quick else (16, 40.0, 3)
    masses = np.linspace(0.1, 0.4, count).tolist()
    run = study.RunOptions(
        revolutions=revolutions, save_every=1e-3, save_groups=("cage", "rollers", "pocket", "torque")
    )
    cases = study.grid(trb.cases.paper_30310(), {"bearing.cage.mass": masses}, run)
    report.inputs = {
        "bearing": "30310",
        "speed_rpm": 3000,
        "axial_load": 4930,
        "cases": count,
        "revolutions": revolutions,
    }
    first = None
    for executor in ("processes", "threads"):
        alone = None
        for workers in sorted({1, 2, cores()} & set(range(1, cores() + 1))):
            walls = []
            for _ in range(repeats):
                with tempfile.TemporaryDirectory() as folder:
                    wall, data = common.timed(
                        lambda: study.run(cases, Path(folder), executor=executor, workers=workers)  # noqa: B023
                    )
                walls.append(wall)
            compared = data[["steps", "torque", "orbit_rms_over_cpr"]]
            first = compared if first is None else first
            wall = float(np.median(walls))
            alone = wall if alone is None else alone
            report.add(
                executor=executor,
                workers=workers,
                cases=count,
                wall=wall,
                speed_up=alone / wall,
                efficiency=alone / wall / workers,
                identical=compared.identical(first),
            )
            report.summary[f"efficiency_{executor}"] = alone / wall / workers
    names = ("executor", "workers", "cases", "wall", "speed_up", "efficiency", "identical")
    report.readme = common.table(report.results, names)
    print(report.readme)
    report.finish()


if __name__ == "__main__":
    main()
