"""Bias of what users read of a run, preset by preset: peaks of forces and loads, percentiles, contact duty, skew, loss.

    python benchmarks/preset_bias.py [--quick] [--json FILE] [--make-table [FILE]]

A tight run (of `bdf`, a tenth of the tolerances of 'reference', every force exact) goes on from the stored states of
work_precision.py, with the default effects and 8 Gauss nodes along a contact. Every 5 ms each preset starts from its state;
after 4 ms, in which
vibrations come to the size that the preset leaves them, both are read over the next 5 ms, which makes 6 pairs of windows a
state. The bias is the mean difference over the mean of the tight windows, with its 95 % confidence interval. --make-table
writes them into the package's table, from where `trbdyn.run.estimate` and the summaries of runs take them. Four minutes of
processor time.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import common
import numpy as np
from accuracy import measure, states
from numpy.typing import NDArray

from trbdyn import Simulation
from trbdyn.errors import RunWarning
from trbdyn.model.effects import Effects
from trbdyn.results.result import Result
from trbdyn.run.estimate import TABLE
from trbdyn.run.options import ACCURACY
from trbdyn.run.simulation import State

Array = NDArray[np.float64]

TIGHT: Final[dict[str, Any]] = {
    "integrator": "bdf",
    "accuracy": "reference",
    "rings_share": 0.0,
    **{name: 0.1 * value for name, value in ACCURACY["reference"].model_dump().items()},
}
EFFECTS: Final = Effects.standard().replace(quadrature="gauss", n_slices=8)
CASES: Final = ("collision", "light", "combined", "heavy", "fast", "scatter")
"""Stored scenes of work_precision.py in which rollers and cage hit each other."""
WINDOW: Final = 5e-3
"""Length of a window (s)."""
SETTLE: Final = 4e-3
"""Time before it (s)."""
WINDOWS: Final = 6
"""Windows from each stored state."""
SAVE: Final = 2e-5
"""Time between records (s); peaks are kept over all steps."""
READ: Final = {
    "pocket_peak": "largest force in each pocket, root mean square over the pockets",
    "pocket_p95": "95th percentile of the forces on touched faces",
    "duty": "share of time that a pocket is touched",
    "raceway_peak": "largest load of a roller on the outer raceway",
    "pressure_peak": "largest pressure on the outer raceway",
    "skew": "skew, root mean square",
    "loss": "mean loss",
}
COLUMNS = {
    "case": "text: scene",
    "preset": "text: preset",
    "integrator": "text: integrator that the preset runs the scene with",
    "pairs": "1: pairs of windows",
    **{f"bias_{name}": f"1: relative difference from the tight run: {text}" for name, text in READ.items()},
    **{f"bias_{name}_half_width": "1: half its 95 % confidence interval" for name in READ},
}


def read(parts: Sequence[Result]) -> dict[str, float]:
    """What users read of neighbouring results."""
    force = np.concatenate([part["pocket_force"] for part in parts])
    skew = np.concatenate([part["roller_skew"] for part in parts])
    touched = force[force > 0.0]

    def largest(name: str) -> Array:
        found: Array = np.maximum.reduce([part.peaks[name] for part in parts])
        return found

    span = sum(float(part.time[-1] - part.time[0]) for part in parts)
    return {
        "pocket_peak": float(np.sqrt(np.mean(largest("pocket_force_peak").max(axis=1) ** 2))),
        "pocket_p95": float(np.percentile(touched, 95.0)) if touched.size else 0.0,
        "duty": float((force > 0.0).any(axis=2).mean()),
        "raceway_peak": float(largest("outer_load_peak").max()),
        "pressure_peak": float(largest("outer_pressure_peak").max()),
        "skew": float(np.sqrt(np.mean(skew**2))),
        "loss": sum(measure.lost_of(part) for part in parts) / span,
    }


def tight_windows(case: states.Case, state: State, count: int) -> tuple[list[State], list[dict[str, float]]]:
    """States from which windows are run, and what is read of those windows, of a tight run that goes on."""
    sim = Simulation(states.at_state(case.scene, state), **TIGHT)
    begins, figures = [sim.state], []
    sim.run(duration=SETTLE, save_every=SAVE)
    for _ in range(count):
        first = sim.run(duration=WINDOW - SETTLE, save_every=SAVE)
        begins.append(sim.state)
        figures.append(read([first, sim.run(duration=SETTLE, save_every=SAVE)]))
    return begins[:-1], figures


def window(case: states.Case, begin: State, preset: str) -> dict[str, float]:
    """What is read of the window of a preset."""
    sim = Simulation(case.scene, accuracy=preset)
    sim.set_state(begin)
    sim.run(duration=SETTLE, save_every=SAVE)
    return read([sim.run(duration=WINDOW, save_every=SAVE)])


def run(report: common.Report, cases: Sequence[str], n_states: int, count: int) -> None:
    for name in cases:
        case = states.load_case(name).first(n_states)
        case = replace(case, scene=case.scene.replace(effects=EFFECTS))
        found: dict[str, list[dict[str, float]]] = {preset: [] for preset in ACCURACY}
        tight = []
        for state in case.states:
            begins, figures = tight_windows(case, state, count)
            tight += figures
            for preset, rows in found.items():
                rows += [window(case, begin, preset) for begin in begins]
        for preset, rows in found.items():
            used = Simulation(case.scene, accuracy=preset).options.integrator
            row: dict[str, Any] = {"case": name, "preset": preset, "integrator": used, "pairs": len(rows)}
            for key in READ:
                off = measure.bias(np.array([one[key] for one in rows]), np.array([one[key] for one in tight]))
                row |= {f"bias_{key}": off.value, f"bias_{key}_half_width": off.half_width}
            report.add(**row)
            print(name, preset, *(f"{key} {100.0 * row[f'bias_{key}']:+.2g} %" for key in READ), flush=True)


def write_table(report: common.Report, path: Path) -> None:
    """Put the biases into the package's table, beside those of work_precision.py; other scenes and numbers stay."""
    table = json.loads(path.read_text(encoding="utf-8"))
    for row in report.results:
        values = {name: float(f"{value:.4g}") for name, value in row.items() if name.startswith("bias_")}
        preset = table["presets_of_scenes"].setdefault(row["case"], {}).setdefault(row["preset"], {})
        tolerances = ACCURACY[row["preset"]].model_dump()
        said = {"effects": "standard", "integrator": row["integrator"], "quick": report.options.quick}
        preset["bias"] = values | {"tolerances": tolerances} | said
    path.write_text(json.dumps(common.plain(table), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    print(f"wrote {path}")


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES), help="scenes")
    parser.add_argument("--states", type=int, help="stored states of each scene; by default all, 1 with --quick")
    parser.add_argument(
        "--make-table", nargs="?", type=Path, const=TABLE, metavar="FILE", help="write the package's table"
    )
    parser.add_argument(
        "--from-json", type=Path, metavar="FILE", help="measure nothing, take the results of such a file"
    )
    options = parser.parse_args(arguments)
    report = common.Report("preset_bias", options, COLUMNS)
    report.inputs = {"window_s": WINDOW, "settle_s": SETTLE, "save_every_s": SAVE, "tight": TIGHT}
    if options.from_json is not None:
        report.take(options.from_json)
    else:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RunWarning)
            run(report, options.cases, options.states or (1 if options.quick else 99), 2 if options.quick else WINDOWS)
    print("\n" + common.table(report.results, COLUMNS, digits=3))
    if options.make_table is not None:
        write_table(report, options.make_table)
    report.finish()
    return report


if __name__ == "__main__":
    main()
