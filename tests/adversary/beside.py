"""One random scene with every preset, with ten times smaller tolerances and by the explicit method: what it loses, and how its
rollers vibrate.

python tests/adversary/beside.py guided 2100078              a scene of `adversary.py`, by its kind and seed
python tests/adversary/beside.py drop 99000025 --duration 15e-3 --moved 12     by how much moved runs of it are off in the mean
"""

from __future__ import annotations

import argparse
import sys
import warnings
from typing import Any

import numpy as np
from chance import mean_difference
from judge import TIGHT, bounded_run, losses
from numpy.typing import NDArray
from random_scenes import KINDS, ORDINARY, draw, make

import trbdyn as trb

WAYS: dict[str, dict[str, Any]] = {
    "fast": {"accuracy": "fast"},
    "standard": {"accuracy": "standard"},
    "reference": {"accuracy": "reference"},
    "reference, forces exact": {"accuracy": "reference", "rings_share": 0.0},
    "ten times tighter": TIGHT,
    "explicit, reference": {"accuracy": "reference", "integrator": "erk"},
    "explicit, tighter": {"accuracy": "reference", "integrator": "erk", "rtol": 1e-6},
}
MOST_STEPS = 300_000
"""Steps after which a run is cut short."""
PARTS = 12
"""Parts of the time, in each of which the vibrations are averaged."""


def vibrations(scene: trb.Scene, duration: float, options: dict[str, Any]) -> list[float]:
    """Mean energy of the rollers' motion across the raceways in each part of a time (J)."""
    sim = trb.Simulation(scene, **options)
    mass, steps = scene.bearing.geometry.roller_mass, 0
    means = []
    for end in np.linspace(0.0, duration, PARTS + 1)[1:]:
        sums, begin = 0.0, sim.time
        while sim.time < end and steps < MOST_STEPS:
            before = sim.time
            sim.step()
            steps += 1
            state = sim.view()
            energy = 0.5 * mass * float(np.sum(state["roller_v_r"] ** 2 + state["roller_v_z"] ** 2))
            sums += energy * (sim.time - before)
        means.append(sums / max(sim.time - begin, 1e-300))
    return means


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=sorted(KINDS))
    parser.add_argument("seed", type=int)
    parser.add_argument("--duration", type=float, required=True, help="bearing time (s)")
    parser.add_argument("--damping", type=float, help="normal damping of all contacts, the usual one is 0.1 (s/m)")
    parser.add_argument(
        "--vibrations", type=float, metavar="TIME", help="vibrations of the rollers up to this time (s), too"
    )
    parser.add_argument(
        "--moved",
        type=int,
        metavar="COUNT",
        help="losses of the scene, moved a little, beside moved tight runs, and no more",
    )
    args = parser.parse_args()
    if args.moved is not None:
        off, error = mean_difference(losses(ORDINARY | draw(args.kind, args.seed), args.duration), args.moved)
        print(f"{args.moved} moved runs: {100.0 * off:.2g} +/- {100.0 * error:.2g} % in the mean")
        return 0
    scene = make(draw(args.kind, args.seed) | ({} if args.damping is None else {"damping": args.damping}))
    print(f"{'':24} {'steps':>8} {'lost (J)':>10} {'energy':>9}  warnings")
    for name, options in WAYS.items():
        run = bounded_run(trb.Simulation(scene, **options), args.duration, MOST_STEPS)
        lost = f"{run.loss:10.4g}" if run.status == "done" else f"{run.status:>10}"
        print(f"{name:24} {run.steps:8d} {lost} {run.closure:9.2g}  {'; '.join(run.warnings)[:120]}", flush=True)
    if args.vibrations is not None:
        ends = np.linspace(0.0, args.vibrations, PARTS + 1)[1:]
        print(f"\nenergy of the rollers' motion across the raceways (uJ), up to (ms)\n{'':24} " + _row(1e3 * ends))
        for name in ("fast", "standard", "reference, forces exact"):
            print(f"{name:24} " + _row(1e6 * np.array(vibrations(scene, args.vibrations, WAYS[name]))), flush=True)
    return 0


def _row(values: NDArray[np.float64]) -> str:
    return " ".join(f"{value:8.3g}" for value in values)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
