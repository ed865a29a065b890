"""Why the loss of the light scene depends on the preset: hardly loaded rollers vibrate on their raceways.

    python benchmarks/light_loss.py [--quick] [--json FILE]

The scene "light" of work_precision.py (30310, 3000 rpm, 1230 N, a cage that collides) from its first stored state, once with the
effects of the paper, which damp no contact, and once with the damping that contacts have by default; with tight tolerances and
with two presets. Given are the vibration of the rollers' loads, the mean loss, and the part that rolling resistance takes.
"""

from __future__ import annotations

from collections.abc import Sequence

import common
import numpy as np
from accuracy import measure, states

from trbdyn import Simulation
from trbdyn.model.effects import Effects
from trbdyn.model.scene import Scene
from trbdyn.results.result import Result

COLUMNS = {
    "damped": "1: contacts have the damping that they have by default",
    "accuracy": "text: preset, or tight: a hundredth of the base tolerances, every force exact",
    "vibration": "1: rms deviation of a roller's load on the outer raceway from its mean of 2 ms, over its mean",
    "loss": "W: mean loss",
    "rolling": "W: mean loss by rolling resistance on both raceways",
    "closure": "1: residual of the energy audit over the dissipated work",
}
SAVE = 1e-5
"""Time between records (s): several in a period of the contacts, 1/35 kHz."""
MEAN_OVER = 2e-3
"""Changes of the load that take longer than this are the cage's (s)."""


def vibration_of(result: Result) -> float:
    """Rms deviation of the rollers' loads from their running mean, over their mean."""
    loads = np.asarray(result["outer_load"], dtype=float)
    width = round(MEAN_OVER / SAVE)
    window = np.ones(width) / width
    mean = np.apply_along_axis(lambda column: np.convolve(column, window, mode="same"), 0, loads)
    inside = slice(width, -width)
    return float(np.sqrt(np.mean((loads - mean)[inside] ** 2)) / loads.mean())


def scenes(case: states.Case) -> dict[bool, Scene]:
    """The scene without and with the default damping, both from the first stored state."""
    base = Effects()
    damped = case.scene.effects.replace(damping=base.damping)
    return {
        False: states.at_state(case.scene, case.states[0]),
        True: states.at_state(case.scene.replace(effects=damped), case.states[0]),
    }


def run(report: common.Report, duration: float) -> None:
    case = states.load_case("light")
    tight = measure.scaled(0.01, max_order=case.definition.tight_order, rings_share=0.0)
    settings = {"tight": tight, "reference": {"accuracy": "reference"}, "standard": {"accuracy": "standard"}}
    report.inputs = {"duration_s": duration, "save_every_s": SAVE, "mean_over_s": MEAN_OVER}
    for damped, scene in scenes(case).items():
        for name, options in settings.items():
            result = Simulation(scene, **options).run(duration=duration, save_every=SAVE)
            span = float(result.time[-1] - result.time[0])
            rolling = float(result["loss_rolling"][-1] - result["loss_rolling"][0])
            report.add(
                damped=int(damped),
                accuracy=name,
                vibration=vibration_of(result),
                loss=measure.lost_of(result) / span,
                rolling=rolling / span,
                closure=result.energy_closure,
            )


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    options = parser.parse_args(arguments)
    report = common.Report("light_loss", options, COLUMNS)
    run(report, 20e-3 if options.quick else 60e-3)
    print("\n" + common.table(report.results, COLUMNS, digits=5))
    report.finish()
    return report


if __name__ == "__main__":
    main()
