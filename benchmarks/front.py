"""Time at equal error: what a turn of the shaft costs where the cage's path is right to 1e-3, 3e-4 and 1e-4 of Cpr.

    python benchmarks/front.py [--quick] [--json FILE] [--other OTHER/.venv/bin/python] [--cases NAME ...]

For each case (`accuracy.states`: colliding, combined, light, slow, unloaded) runs start from stored states with a row of
tolerances, all those of `standard` times a scale. The error is the largest deviation of the cage's centre from a reference
(BDF of order 5 with exact forces, or an explicit method, at 1e-4 of the tolerances) within each state's window, as the
geometric mean over the states. Time is that of the steps alone, without records and peaks, and on the whole: a process that
starts Python, runs five turns with everything that is kept by default, and ends. Both are interpolated on this run's front
(straight lines through the logarithms of error and time, the faster point of two where an error falls by chance).

A machine is not the same on two days, nor two machines. So a fixed program (yardstick.c, compiled with `cc -O2`) runs in
turns with every point, and times are given over its time, too: these ratios can be compared. Steps and evaluations stand
beside them; they do not scatter. With --other the same is measured in turns with another build, such as an earlier core.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import common
import numpy as np
from accuracy import measure, states

CASES: Final = ("collision", "combined", "light", "slow", "unloaded")
SCALES: Final = (10.0, 5.0, 2.5, 1.5, 1.0, 0.7, 0.4, 0.2, 0.1)
QUICK_SCALES: Final = (3.0, 1.0, 0.3)
LEVELS: Final = (1e-3, 3e-4, 1e-4)
WHOLE_TURNS: Final = 5.0

WORK: Final = """
import json, sys, time
import numpy as np
import trbdyn as trb

def scene_of(job, state):
    effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
    def at(start):
        return trb.cases.scene_30310(job["speed"], job["axial"], job["radial"], effects=effects, start=start)
    if len(lengths) == 0:
        lengths.append(len(trb.Simulation(at(trb.Start.equal())).state.vector))
    vector = np.zeros(lengths[0])
    vector[: job["main"]] = state["vector"][: job["main"]]
    return at(trb.Start.state(vector, time=state["time"]))

lengths = []
for line in sys.stdin:
    job = json.loads(line)
    lengths.clear()
    path, spent, steps, evaluations = [], 0.0, 0.0, 0.0
    for state in job["states"]:
        sim = trb.Simulation(scene_of(job, state), **job["settings"])
        found = sim.run(duration=state["window"], save_every=job["sample"], save_groups=("time", "cage"))
        path.append(np.asarray(found.cage_locus()).tolist())
    for state in job["states"][:2]:
        sim = trb.Simulation(scene_of(job, state), **job["settings"])
        end, before = sim.time + job["length"], sim.statistics
        sim.step()
        began = time.process_time()
        while sim.time < end:
            sim.step()
        spent += time.process_time() - began
        steps += sim.statistics["steps"]
        evaluations += sim.statistics["rhs_evaluations"]
    print(json.dumps({"path": path, "seconds": spent / 2, "steps": steps / 2, "evaluations": evaluations / 2}), flush=True)
"""
WHOLE: Final = """
import json, sys
import trbdyn as trb
job = json.loads(sys.argv[1])
effects = trb.Effects.paper().replace(quadrature="gauss", n_slices=8)
scene = trb.cases.scene_30310(job["speed"], job["axial"], job["radial"], effects=effects, start=trb.Start.whirl(0.9))
trb.Simulation(scene, **job["settings"]).run(revolutions=job["turns"])
"""

COLUMNS: Final = {
    "build": "text: this or other",
    "case": "text: name of the case",
    "scale": "1: tolerances over those of standard",
    "error": "1: largest deviation of the cage's centre in a window over Cpr, geometric mean over the states",
    "ms": "ms: processor time of the steps of a turn",
    "units": "1: the same over the yardstick's time, run beside it",
    "steps": "1: steps a turn",
    "evaluations": "1: force evaluations a turn",
    "whole_s": "s: wall time of a process that runs five turns with standard tolerances and default output",
    "whole_units": "1: the same over the yardstick's time",
    "yardstick_ms": "ms: median of the yardstick's times",
    **{f"ms_at_{level:g}": f"ms: time of a turn at an error of {level:g} of Cpr" for level in LEVELS},
    **{f"units_at_{level:g}": "1: the same over the yardstick's time" for level in LEVELS},
    **{f"steps_at_{level:g}": "1: steps a turn there" for level in LEVELS},
    **{f"evaluations_at_{level:g}": "1: evaluations a turn there" for level in LEVELS},
    "at_errors": "object: by build and case, and the geometric mean over the cases, what a turn costs at each error",
}
QUANTITIES: Final = ("ms", "units", "steps", "evaluations")


class Asked:
    """A process that answers each line with a line."""

    def __init__(self, words: Sequence[str]) -> None:
        self.process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd="/"
        )

    def ask(self, line: str) -> str:
        """The answer to a line.

        Raises
        ------
        SystemExit
            If the process has ended.
        """
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"{self.process.args!r} ended")
        return answer

    def close(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.communicate()


def yardstick(folder: Path) -> Asked:
    """The fixed program, compiled.

    Raises
    ------
    SystemExit
        If there is no C compiler.
    """
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        raise SystemExit("front.py needs a C compiler for yardstick.c; set CC")
    program = folder / "yardstick"
    subprocess.run([compiler, "-O2", "-o", str(program), str(common.HERE / "yardstick.c"), "-lm"], check=True)
    return Asked([str(program)])


def references_of(case: states.Case) -> list[np.ndarray]:
    """Paths of the cage's centre over Cpr; kept in build/front between runs."""
    store = common.HERE.parent / "build" / "front" / f"{case.name}_{len(case.states)}.npz"
    if store.exists():
        with np.load(store) as data:
            if np.array_equal(data["windows"], case.windows) and np.array_equal(data["start"], case.states[0].vector):
                return [data[f"path_{i}"] for i in range(len(case.states))]
    paths = [one.cage for one in measure.References(case).trajectories]
    store.parent.mkdir(parents=True, exist_ok=True)
    kept = {f"path_{i}": path for i, path in enumerate(paths)}
    np.savez(store, windows=np.array(case.windows), start=case.states[0].vector, **kept)
    return paths


def job_of(case: states.Case, scale: float, turns: float) -> dict[str, Any]:
    """What a worker is asked for."""
    definition = case.definition
    standard = measure.ACCURACY["standard"].model_dump()
    n_rollers = case.scene.bearing.n_rollers
    return {
        "speed": definition.speed_rpm,
        "axial": definition.axial_load,
        "radial": definition.radial_load,
        "main": 11 * n_rollers + 12,
        "settings": {name: value * scale for name, value in standard.items()},
        "sample": measure.SAMPLE,
        "length": turns * 60.0 / definition.speed_rpm,
        "states": [
            {"vector": state.vector.tolist(), "time": state.time, "window": window}
            for state, window in zip(case.states, case.windows, strict=True)
        ],
    }


def error_of(paths: Sequence[Sequence[Sequence[float]]], references: Sequence[np.ndarray]) -> float:
    """Geometric mean over the states of the largest deviation."""
    worst = [
        float(np.linalg.norm(np.asarray(path) - reference, axis=1).max())
        for path, reference in zip(paths, references, strict=True)
    ]
    return float(np.exp(np.mean(np.log(np.maximum(worst, 1e-12)))))


def at_error(rows: Sequence[dict[str, Any]], level: float, quantity: str) -> float:
    """A quantity at an error, on the front of the rows; nan beyond its ends."""
    points: list[tuple[float, float]] = []
    for row in sorted(rows, key=lambda row: float(row["ms"])):
        if not points or row["error"] < points[-1][0]:
            points.append((float(row["error"]), float(row[quantity])))
    error, value = np.log(np.array(points[::-1])).T
    if not error[0] <= np.log(level):
        return float("nan")
    return float(np.exp(np.interp(np.log(level), error, value)))


def costs_of(rows: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Every quantity at every error."""
    return {f"{name}_at_{level:g}": at_error(rows, level, name) for level in LEVELS for name in QUANTITIES}


def whole_of(python: str, job: dict[str, Any], turns: float) -> float:
    """Wall time of a whole process (s)."""
    words = {name: job[name] for name in ("speed", "axial", "radial", "settings")} | {"turns": turns}
    began = time.perf_counter()
    subprocess.run([python, "-P", "-W", "ignore", "-c", WHOLE, json.dumps(words)], check=True, cwd="/")
    return time.perf_counter() - began


def run_case(report: common.Report, name: str, builds: dict[str, tuple[str, Asked]], ruler: Asked) -> None:
    """All points of a case, builds in turns."""
    quick = report.options.quick
    case = states.load_case(name).first(1 if report.options.smoke else 2 if quick else 5)
    references = references_of(case)
    turns = 0.05 * case.definition.batch * (1.0 if quick else 4.0)
    for scale in QUICK_SCALES if quick else SCALES:
        job = job_of(case, scale, turns)
        for build, (_, worker) in builds.items():
            before = float(ruler.ask(""))
            found = json.loads(worker.ask(json.dumps(job)))
            unit = 0.5 * (before + float(ruler.ask("")))
            ms = 1e3 * found["seconds"] / turns
            report.add(
                build=build,
                case=name,
                scale=scale,
                error=error_of(found["path"], references),
                ms=ms,
                units=1e-3 * ms / unit,
                steps=found["steps"] / turns,
                evaluations=found["evaluations"] / turns,
                yardstick_ms=1e3 * unit,
            )
            print(
                common.table(
                    report.results[-1:], ("build", "case", "scale", "error", "ms", "units", "steps", "evaluations")
                ).splitlines()[-1],
                flush=True,
            )


def run_whole(report: common.Report, name: str, builds: dict[str, tuple[str, Asked]], ruler: Asked) -> None:
    """The whole process with standard tolerances, builds in turns."""
    case = states.load_case(name).first(1)
    job = job_of(case, 1.0, 1.0)
    turns = min(WHOLE_TURNS, 0.5 * case.definition.batch)
    for build, (python, _) in builds.items():
        before = float(ruler.ask(""))
        seconds = whole_of(python, job, turns)
        unit = 0.5 * (before + float(ruler.ask("")))
        report.add(build=build, case=name, whole_s=seconds, whole_units=seconds / unit, yardstick_ms=1e3 * unit)


def _geometric_mean(values: Sequence[float]) -> float:
    """nan unless all are known: two builds that reach different cases cannot be compared by it."""
    return float(np.exp(np.log(values).mean())) if len(values) else float("nan")


def summary_of(report: common.Report, builds: Sequence[str], cases: Sequence[str]) -> dict[str, Any]:
    """What a turn costs at each error, by build: of each case, and their geometric mean where all cases reach it."""
    out: dict[str, Any] = {}
    for build in builds:
        rows = [row for row in report.results if row["build"] == build and "error" in row]
        found = {name: costs_of([row for row in rows if row["case"] == name]) for name in cases}
        names = next(iter(found.values()))
        mean = {key: _geometric_mean([one[key] for one in found.values()]) for key in names}
        out[build] = found | {"geometric mean": mean}
    return out


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--other", type=Path, metavar="PYTHON", help="Python of another build's environment")
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    options = parser.parse_args(arguments)
    if options.smoke:
        options.cases = options.cases[:1]
    report = common.Report("front", options, COLUMNS)
    report.inputs = {"cases": options.cases, "levels": LEVELS, "yardstick": "yardstick.c, cc -O2"}
    pythons = {"this": sys.executable} | ({"other": str(options.other.absolute())} if options.other else {})
    builds = {name: (python, Asked([python, "-P", "-W", "ignore", "-c", WORK])) for name, python in pythons.items()}
    with tempfile.TemporaryDirectory() as folder:
        ruler = yardstick(Path(folder))
        try:
            for name in options.cases:
                run_case(report, name, builds, ruler)
                run_whole(report, name, builds, ruler)
        finally:
            for asked in (ruler, *(worker for _, worker in builds.values())):
                asked.close()
    found = summary_of(report, list(builds), options.cases)
    report.summary = {"at_errors": found}
    shown = [f"{name}_at_{level:g}" for level in LEVELS for name in ("ms", "units", "steps")]
    for build, cases in found.items():
        print(
            f"\n{build}\n" + common.table([{"case": name} | costs for name, costs in cases.items()], ("case", *shown))
        )
    whole = [row for row in report.results if "whole_s" in row]
    print("\n" + common.table(whole, ("build", "case", "whole_s", "whole_units")))
    report.finish()
    return report


if __name__ == "__main__":
    main()
